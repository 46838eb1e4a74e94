//! The pictures the tests look at.

use saltus_plot::{Background, HeightTime, HeightUnit, Mark, Measured, Residual, Stroke};

const G: f64 = 9.8;

/// A ball dropped from `h` metres: the fall, `bounces` flights, and the times of contact.
pub(crate) fn bouncing(h: f64, restitution: impl Fn(usize) -> f64, bounces: usize) -> (Vec<Stroke>, Vec<f64>) {
    let mut t = (2.0 * h / G).sqrt();
    let mut speed = G * t;
    let mut arcs = vec![Stroke::over_time(0.0, t, vec![h, 0.0, -0.5 * G])];
    let mut contacts = vec![t];
    for n in 0..bounces {
        speed *= restitution(n);
        let span = 2.0 * speed / G;
        arcs.push(Stroke::over_time(t, span, vec![0.0, speed, -0.5 * G]));
        t += span;
        contacts.push(t);
    }
    (arcs, contacts)
}

/// A small generator of scatter, the same in every run.
pub(crate) struct Scatter(u64);

impl Scatter {
    fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Nearly normal, mean 0, standard deviation 1.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.uniform()).sum::<f64>() - 6.0
    }
}

/// The table of the squash ball on cement, its best constant COR, and the COR of its heights alone.
pub(crate) fn squash() -> HeightTime {
    let (fitted, contacts) = bouncing(1.0, |_| 0.496, 2);
    let (heights, _) = bouncing(1.0, |_| 0.562, 2);
    let sigma_t = 1.0 / 30.0 / 12f64.sqrt();
    let apex = |t: f64, h: f64| Measured::new(t, h).height_error(0.01).mark(Mark::Apex);
    let contact = |t: f64| Measured::new(t, 0.0).time_error(sigma_t).mark(Mark::Contact);
    HeightTime::new("A squash ball dropped on cement")
        .caption("COR 0.54 (0.43 to 0.65): heights and times disagree")
        .caption("χ² = 73 on 4 degrees of freedom, p = 5 × 10⁻¹⁵")
        .motion("fitted, e = 0.496", fitted)
        .motion("from the heights, e = 0.562", heights)
        .measured([
            Measured::new(0.0, 1.0).height_error(0.01).mark(Mark::Release),
            apex(0.65, 0.30),
            apex(0.98, 0.10),
            contact(0.45),
            contact(0.85),
            contact(1.11),
        ])
        .contacts(contacts)
        .residuals([
            Residual::new(0.0, 0.1).mark(Mark::Release),
            Residual::new(0.65, 5.2).mark(Mark::Apex),
            Residual::new(0.98, 3.9).mark(Mark::Apex),
            Residual::new(0.45, -0.2).mark(Mark::Contact),
            Residual::new(0.85, -5.1).mark(Mark::Contact),
            Residual::new(1.11, -1.2).mark(Mark::Contact),
        ])
}

/// Ten drops in one picture.
pub(crate) fn pooled() -> HeightTime {
    let (arcs, contacts) = bouncing(1.5, |_| 0.82, 6);
    let mut scatter = Scatter(7);
    let mut measured = Vec::new();
    let mut residuals = Vec::new();
    for _ in 0..10 {
        measured.push(Measured::new(0.0, 1.5 + 0.01 * scatter.normal()).height_error(0.01).mark(Mark::Release));
        for (n, pair) in contacts.windows(2).enumerate() {
            let h = 1.5 * 0.82f64.powi(2 * (n as i32 + 1));
            let t = 0.5 * (pair[0] + pair[1]);
            let z = scatter.normal();
            measured.push(Measured::new(t, h + 0.01 * z).height_error(0.01).mark(Mark::Apex));
            residuals.push(Residual::new(t, z).mark(Mark::Apex));
        }
        for &t in &contacts {
            let z = scatter.normal();
            measured.push(Measured::new(t + 0.01 * z, 0.0).time_error(0.01).mark(Mark::Contact));
            residuals.push(Residual::new(t, z).mark(Mark::Contact));
        }
    }
    HeightTime::new("Ten drops of a tennis ball")
        .caption("COR 0.820 ± 0.002, ten trials pooled")
        .motion("constant COR", arcs)
        .measured(measured)
        .contacts(contacts)
        .residuals(residuals)
}

/// Sixty bounces, then rest.
pub(crate) fn zeno() -> HeightTime {
    let (mut arcs, contacts) = bouncing(1.0, |_| 0.9, 60);
    let t = arcs.last().map_or(0.0, |_| contacts[contacts.len() - 1]);
    arcs.push(Stroke::over_time(t, 10.0 - t, vec![0.0]));
    HeightTime::new("Let go from 1 m with COR 0.9")
        .caption("Infinitely many bounces end at t = 8.58 s; then rest")
        .motion("simulated", arcs)
        .contacts(contacts)
}

/// Times of contact from a sound recording: no height was measured.
pub(crate) fn audio() -> HeightTime {
    let (mut arcs, contacts) = bouncing(0.32, |_| 0.896, 9);
    arcs.remove(0);
    let mut scatter = Scatter(3);
    let zs: Vec<_> = contacts.iter().map(|_| scatter.normal()).collect();
    HeightTime::new("A golf ball heard ten times")
        .caption("COR 0.8960 ± 0.0004 from times alone; heights follow from g = 9.81 m/s²")
        .motion("", arcs)
        .measured(
            contacts
                .iter()
                .zip(&zs)
                .map(|(t, z)| Measured::new(t + 1e-3 * z, 0.0).time_error(1e-3).mark(Mark::Contact)),
        )
        .contacts(contacts.clone())
        .residuals(contacts.iter().zip(&zs).map(|(t, z)| Residual::new(*t, *z).mark(Mark::Contact)))
}

/// A scale of nanometres and microseconds.
pub(crate) fn tiny() -> HeightTime {
    let (arcs, contacts) = bouncing(3e-9, |_| 0.7, 4);
    HeightTime::new("A grain").motion("e = 0.7", arcs).contacts(contacts)
}

/// A scale of months and thousands of kilometres.
pub(crate) fn huge() -> HeightTime {
    let (arcs, contacts) = bouncing(5e12, |_| 0.7, 4);
    HeightTime::new("A very long way down").motion("e = 0.7", arcs).contacts(contacts)
}

/// Height read with its own clock, late and below the floor line.
pub(crate) fn late_and_negative() -> HeightTime {
    let points = (0..40).map(|i| {
        let s = f64::from(i) / 40.0;
        Measured::new(1e6 + s, 0.5 * (6.0 * s).cos() - 0.1).height_error(0.02).time_error(0.005)
    });
    HeightTime::new("A pendulum read against a late clock").measured(points)
}

/// More words than room.
pub(crate) fn wordy() -> HeightTime {
    squash().size(360.0, 420.0).caption(
        "The zero of the height scale may be off by about 5 cm: with e = 0.50 every number would then fit. Measure it with the ball at rest on the floor.",
    )
}

/// Four motions and every setting.
pub(crate) fn many_lines() -> HeightTime {
    let mut picture = HeightTime::new("What the coefficient of restitution does to a metre of height")
        .background(Background::White)
        .height_unit(HeightUnit::Metres);
    for e in [0.9, 0.8, 0.65, 0.4] {
        let (arcs, _) = bouncing(1.0, |_| e, 4);
        picture = picture.motion(&format!("e = {e}"), arcs);
    }
    picture
}

pub(crate) fn all() -> Vec<(&'static str, HeightTime)> {
    vec![
        ("squash", squash()),
        ("squash-phone", squash().size(360.0, 480.0)),
        ("squash-adaptive", squash().background(Background::Adaptive)),
        ("squash-wide", squash().size(1600.0, 900.0)),
        ("pooled", pooled()),
        ("zeno", zeno()),
        ("audio", audio()),
        ("tiny", tiny()),
        ("huge", huge()),
        ("late", late_and_negative()),
        ("wordy", wordy()),
        ("lines", many_lines()),
        ("point", HeightTime::new("One point").measured([Measured::new(0.7, 0.3).height_error(0.01)])),
        ("zeros", HeightTime::new("Nothing moved").measured([Measured::new(0.0, 0.0)])),
        ("residual", HeightTime::new("Residuals only").residuals([Residual::new(0.7, 0.3), Residual::new(0.9, -40.0)])),
    ]
}
