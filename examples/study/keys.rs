//! The keyframes that the study's script would set: one for each contact, with the velocity on both
//! sides of it.

use saltus_bounce::Cor;
use saltus_motion::{Contact, Frames, Motion, MotionError, Piece, Stretch, Track};

use super::RADIUS;
use super::equations::flights;
use super::stages::Start;

/// Hops after which no frame rate shows any more.
const HOPS: usize = 60;

/// The bouncing ball as a motion; it lies from where its hops are shorter than a frame.
///
/// # Errors
/// [`MotionError`] if a number is not finite.
pub fn motion(start: Start, cor: Cor, frames: Frames) -> Result<Motion, MotionError> {
    let stretch = |contact: Option<Contact>, from: f64, span: f64, height: f64, velocity: f64| Stretch {
        contact,
        flight: true,
        pieces: vec![Piece {
            start: from,
            span,
            coefficients: vec![[0.0, 0.0, height], [0.0, 0.0, velocity], [0.0, 0.0, -0.5 * start.gravity]],
            spin: Vec::new(),
        }],
    };
    let each = flights(start.drop, start.gravity, cor.value(), 0.0);
    let hops = each.take(HOPS).map(|hop| {
        let rebound = hop.apex.velocity(start.gravity, hop.start);
        stretch(Some(Contact::level(rebound / cor.value())), hop.start, hop.span, 0.0, rebound)
    });
    let stretches = std::iter::once(stretch(None, 0.0, start.fall(), start.drop, 0.0)).chain(hops).collect();
    let ball = Track { name: "squash ball".to_owned(), radius: RADIUS, stretches };
    Ok(Motion::new("A squash ball on cement", vec![ball], Vec::new())?.cut(frames.rate.frame()))
}
