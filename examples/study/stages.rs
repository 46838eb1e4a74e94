//! The four stages of the study: the curve that each formula draws, beside what was recorded.

use saltus_bounce::{Cor, Drop};
use saltus_fit::{Point, Report};
use saltus_plot::{Background, HeightTime, Mark, Measured, Residual, Stroke};

use super::equations::{Apex, flights, whole_bounce};

/// What every stage starts from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    /// The height of release in m, above zero.
    pub drop: f64,
    /// In m/s², above zero.
    pub gravity: f64,
    /// What is taken off the duration of each flight, in s; the study takes 0.01.
    pub early: f64,
}

/// A formula as a curve: flights one after another, each with its own apex.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    gravity: f64,
    /// From when each is drawn, until when, and its apex.
    parts: Vec<(f64, f64, Apex)>,
}

impl Start {
    /// The fall: the apex is where the ball is let go.
    #[must_use]
    pub const fn apex(self) -> Apex {
        Apex { time: 0.0, height: self.drop }
    }

    /// When the ball meets the floor: √(2h₀/g).
    #[must_use]
    pub fn fall(self) -> f64 {
        (2.0 * self.drop / self.gravity).sqrt()
    }

    /// When stages 2 and 3 have the ball at its next apex, T = 2 √(2h₀/g) - c.
    #[must_use]
    pub fn next_apex(self) -> f64 {
        whole_bounce(self.drop, self.gravity, self.early)
    }

    /// Stage 1, h₀ - ½ g t²: the fall, and no floor. Drawn until `until` in s.
    #[must_use]
    pub fn free_fall(self, until: f64) -> Curve {
        Curve { gravity: self.gravity, parts: vec![(0.0, until, self.apex())] }
    }

    /// Stage 2, h₀ - ½ g (T - t)²: the fall mirrored at T/2, so that nothing is lost.
    #[must_use]
    pub fn half_bounces(self) -> Curve {
        let next = Apex { time: self.next_apex(), height: self.drop };
        let [_, landing] = next.floor(self.gravity);
        let turn = 0.5 * next.time;
        Curve { gravity: self.gravity, parts: vec![(0.0, turn, self.apex()), (turn, landing, next)] }
    }

    /// Stage 3, h₁ - ½ g (T - t)²: a measured `rebound` in m, its apex still at the time of
    /// stage 2.
    ///
    /// (22) is printed with the ratio h₀/h₁ in the place of h₁. That is a pure number: taken as
    /// metres it is 3.33 m here.
    #[must_use]
    pub fn measured_rebound(self, rebound: f64) -> Curve {
        let next = Apex { time: self.next_apex(), height: rebound };
        let [_, landing] = next.floor(self.gravity);
        let turn = 0.5 * next.time;
        Curve { gravity: self.gravity, parts: vec![(0.0, turn, self.apex()), (turn, landing, next)] }
    }

    /// Stage 4: speed lost by the COR at every contact, `count` flights after the fall.
    ///
    /// (25) is read with its apex midway through the flight. As printed, h - ½ g (T - t)² in the
    /// flight's own clock, the apex would be at its end.
    #[must_use]
    pub fn bounces(self, cor: Cor, count: usize) -> Curve {
        let mut parts = vec![(0.0, self.fall(), self.apex())];
        let each = flights(self.drop, self.gravity, cor.value(), self.early).take(count);
        parts.extend(each.map(|flight| (flight.start, flight.start + flight.span, flight.apex)));
        Curve { gravity: self.gravity, parts }
    }

    /// The bouncing ball itself in closed form, for comparison: this start without anything taken
    /// off.
    #[must_use]
    pub const fn exact(self, cor: Cor) -> Drop {
        Drop::new(self.drop, self.gravity, cor)
    }
}

impl Curve {
    /// The height in m and upward velocity in m/s at `t` in s. The last flight goes on, below the
    /// floor if need be.
    #[must_use]
    pub fn at(&self, t: f64) -> [f64; 2] {
        let part = self.parts.iter().rfind(|part| part.0 <= t).or(self.parts.first());
        part.map_or([f64::NAN; 2], |&(_, _, apex)| [apex.at(self.gravity, t), apex.velocity(self.gravity, t)])
    }

    /// Where the curve passes from one flight to the next, and where it ends, in s.
    #[must_use]
    pub fn turns(&self) -> Vec<f64> {
        self.parts.iter().map(|part| part.1).collect()
    }

    /// For a picture.
    #[must_use]
    pub fn arcs(&self) -> Vec<Stroke> {
        let arc = |&(from, until, apex): &(f64, f64, Apex)| {
            let coefficients =
                vec![apex.at(self.gravity, from), apex.velocity(self.gravity, from), -0.5 * self.gravity];
            Stroke::over_time(from, until - from, coefficients)
        };
        self.parts.iter().map(arc).collect()
    }

    /// How far the recorded points are above the curve, in standard errors: the height's, and what
    /// the time's moves the curve by in the meantime.
    #[must_use]
    pub fn residuals(&self, report: &Report) -> Vec<f64> {
        let sigma = |s: Option<saltus_fit::Sourced>| s.map_or(0.0, |s| s.value);
        let (height, time) = (sigma(report.sigma_height()), sigma(report.sigma_time()));
        let z = |point: &Point| {
            let [h, v] = self.at(point.time);
            (point.height - h) / height.hypot(v * time)
        };
        recorded(report).map(z).collect()
    }

    /// The picture of a stage: the curve, what was recorded, and what lies between.
    #[must_use]
    pub fn picture(&self, title: &str, label: &str, caption: &str, report: &Report) -> HeightTime {
        let residuals = recorded(report).zip(self.residuals(report));
        let residuals = residuals.map(|(point, z)| Residual::new(point.time, z).mark(mark(&point.label)));
        HeightTime::new(title)
            .caption(caption)
            .motion(label, self.arcs())
            .measured(measured(report, 0.0))
            .residuals(residuals)
            .background(Background::Adaptive)
    }
}

/// What was read of the motion after the release.
fn recorded(report: &Report) -> impl Iterator<Item = &Point> {
    report.points().iter().filter(|point| point.label != "release")
}

/// The recorded points, heights less `offset` in m where they are not those of a contact.
pub fn measured(report: &Report, offset: f64) -> impl Iterator<Item = Measured> + '_ {
    report.points().iter().map(move |point| {
        let mark = mark(&point.label);
        let height = if mark == Mark::Contact { point.height } else { point.height - offset };
        let measured = Measured::new(point.time, height).mark(mark).time_error(point.sigma_time.unwrap_or(0.0));
        measured.height_error(point.sigma_height.unwrap_or(0.0))
    })
}

/// The mark for a label such as `apex 1`.
#[must_use]
pub fn mark(label: &str) -> Mark {
    match label.split(' ').next() {
        Some("release") => Mark::Release,
        Some("contact") => Mark::Contact,
        Some("apex") => Mark::Apex,
        _ => Mark::Sample,
    }
}
