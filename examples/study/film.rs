//! What a camera sees of a bouncing ball, and how far readings off its frames are from the truth.
//!
//! A frame is a moment every 1/f s; where the first lies is a matter of chance. An apex is read in
//! the highest frame, a contact in the lowest.

use std::error::Error;

use saltus::Simulation;
use saltus::nalgebra::Vector2;
use saltus_bounce::{Ball, Cor, Drop, Mode};

/// How a reading is off, over all moments at which the shutter may open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Off {
    /// On average: read less true.
    pub mean: f64,
    /// The standard deviation.
    pub spread: f64,
    /// The largest, without sign.
    pub worst: f64,
}

impl Off {
    /// That of a list of errors, as many as you like of equal weight.
    #[must_use]
    pub fn of(errors: &[f64]) -> Self {
        let count = errors.len().max(1) as f64;
        let mean = errors.iter().sum::<f64>() / count;
        let variance = errors.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / count;
        Self { mean, spread: variance.sqrt(), worst: errors.iter().fold(0.0, |worst: f64, e| worst.max(e.abs())) }
    }
}

/// A camera of so many frames per second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// In 1/s, above zero.
    pub rate: f64,
}

impl Camera {
    /// The time from frame to frame, τ, in s.
    #[must_use]
    pub fn frame(self) -> f64 {
        1.0 / self.rate
    }

    /// The height of an apex, in m: too low by up to g τ²/8, by g τ²/24 on average. Exact for
    /// flights longer than two frames.
    #[must_use]
    pub fn apex(self, gravity: f64) -> Off {
        let drop = gravity * self.frame().powi(2);
        Off { mean: -drop / 24.0, spread: drop / (12.0 * 5.0_f64.sqrt()), worst: drop / 8.0 }
    }

    /// The time of a contact, in s: too late by τ (1 - e)/(2 (1 + e)) on average, since a ball that
    /// leaves more slowly is low for longer.
    ///
    /// To first order in g τ/v, the share of its speed v that the ball gains from frame to frame; 0
    /// ≤ `cor` ≤ 1.
    #[must_use]
    pub fn contact(self, cor: f64) -> Off {
        let frame = self.frame();
        Off {
            mean: 0.5 * frame * (1.0 - cor) / (1.0 + cor),
            spread: frame / 12.0_f64.sqrt(),
            worst: frame / (1.0 + cor),
        }
    }

    /// How high the ball is in its lowest frame, in m: up to v τ e/(1 + e) after an impact at the
    /// speed v = `impact`, half of that on average.
    ///
    /// To first order in g τ/v, as [`contact`](Self::contact).
    #[must_use]
    pub fn gap(self, impact: f64, cor: f64) -> Off {
        let worst = impact * self.frame() * cor / (1.0 + cor);
        Off { mean: 0.5 * worst, spread: worst / 12.0_f64.sqrt(), worst }
    }

    /// What readings of one motion are off by in fact, from `films` films whose shutters open one
    /// after another within a frame: of the height of the apex after contact `number`, from 1, of
    /// the time of that contact, and how high the ball is in its lowest frame. A ball is dropped
    /// from `height` in m.
    ///
    /// # Errors
    /// If `gravity` is negative, or a film shows fewer contacts.
    pub fn measure(
        self,
        height: f64,
        gravity: f64,
        cor: Cor,
        number: u32,
        films: u32,
    ) -> Result<[Off; 3], Box<dyn Error>> {
        let drop = Drop::new(height, gravity, cor);
        let end = drop.impact_time(number + 2);
        let ball = Ball::new(gravity, cor)?;
        let path = Simulation::of(&ball).run(Mode::Flight, Ball::dropped_from(height), 0.0..end)?.trajectory;
        let mut off = [const { Vec::new() }; 3];
        for n in 0..films {
            let shutter = self.frame() * (f64::from(n) + 0.5) / f64::from(films);
            let seen = read(&self.film(shutter, end, |t| path.at(t)).collect::<Vec<_>>());
            let nth = number.saturating_sub(1) as usize;
            let (Some(contact), Some(apex)) = (seen.contacts.get(nth), seen.apexes.get(nth)) else {
                return Err(format!("a film shows fewer than {number} contacts").into());
            };
            off[0].push(apex[1] - drop.apex_height(number));
            off[1].push(contact[0] - drop.impact_time(number));
            off[2].push(contact[1]);
        }
        Ok(off.map(|off| Off::of(&off)))
    }

    /// Frames until `end` in s, the first at `shutter`, 0 ≤ `shutter` < τ: (time, height), from the
    /// height at any time.
    pub fn film(
        self,
        shutter: f64,
        end: f64,
        height: impl Fn(f64) -> Option<Vector2<f64>>,
    ) -> impl Iterator<Item = [f64; 2]> {
        let times = (0_u32..).map(move |k| shutter + f64::from(k) * self.frame()).take_while(move |&t| t <= end);
        times.filter_map(move |t| height(t).map(|state| [t, state[0]]))
    }
}

/// What is read off a film: a time and a height for each contact and each apex after the first
/// contact.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Seen {
    /// The lowest frames, in s and m.
    pub contacts: Vec<[f64; 2]>,
    /// The highest frames, in s and m.
    pub apexes: Vec<[f64; 2]>,
}

/// Reads a film: contacts are frames that are lower than both neighbours, apexes are higher.
#[must_use]
pub fn read(frames: &[[f64; 2]]) -> Seen {
    let mut seen = Seen::default();
    for three in frames.windows(3) {
        let [before, at, after] = [three[0][1], three[1][1], three[2][1]];
        if at < before && at <= after {
            seen.contacts.push(three[1]);
        } else if at > before && at >= after && !seen.contacts.is_empty() {
            seen.apexes.push(three[1]);
        }
    }
    seen
}
