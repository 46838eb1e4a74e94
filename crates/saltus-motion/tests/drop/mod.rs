//! A bouncing ball with a formula for every place.

use saltus_motion::{Contact, Motion, Piece, Stretch, Track};

pub(crate) const G: f64 = 9.81;

/// A drop from `height`, `hops` bounces, then rest; with a sideways speed and a spin.
pub(crate) fn drop(height: f64, cor: f64, hops: usize, sideways: f64, spin: [f64; 3], radius: f64) -> Motion {
    let (mut t, mut speed, mut start) = (0.0, 0.0, height);
    let mut span = (2.0 * height / G).sqrt();
    let mut stretches = Vec::new();
    let mut arc = |t: f64, span: f64, height: f64, speed: f64, flight: bool| {
        let pull = if flight { -0.5 * G } else { 0.0 };
        let coefficients = vec![[sideways * t, 0.0, height], [sideways, 0.0, speed], [0.0, 0.0, pull]];
        let piece = Piece { start: t, span, coefficients, spin: vec![spin] };
        stretches.push(Stretch {
            contact: (t > 0.0).then(|| Contact::level(speed / cor)),
            flight,
            pieces: vec![piece],
        });
    };
    for _ in 0..=hops {
        arc(t, span, start, speed, true);
        t += span;
        speed = cor * (G * span - speed);
        span = 2.0 * speed / G;
        start = 0.0;
    }
    arc(t, 0.2, 0.0, 0.0, false);
    let ball = Track { name: "ball".into(), radius, stretches };
    Motion::new("drop", vec![ball], Vec::new()).unwrap()
}
