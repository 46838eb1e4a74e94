//! The motion of a dropped ball with quadratic drag, from textbook formulas, with nothing of the
//! crate's own.

/// Standard gravity of the bench, m/s².
pub(crate) const G: f64 = 9.81;

/// A ball, the floor and the air: what is true.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ball {
    /// Height of release above the floor, m.
    pub(crate) drop: f64,
    /// COR at rest, and by how much it falls for every m/s of the speed of impact.
    pub(crate) cor: (f64, f64),
    /// Drag k of v' = -g ∓ k v², 1/m.
    pub(crate) drag: f64,
}

/// A flight: when it starts, at which speed upwards (0 and a height for the fall), when and how
/// high its apex is, when it ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Flight {
    pub(crate) start: f64,
    up: f64,
    pub(crate) apex: (f64, f64),
    pub(crate) end: f64,
}

/// The fall from a height: how long it takes and how fast it ends.
fn fall(height: f64, drag: f64) -> (f64, f64) {
    if drag < 1e-9 {
        return ((2.0 * height / G).sqrt(), (2.0 * height * G).sqrt());
    }
    let tau = 1.0 / (G * drag).sqrt();
    (tau * (drag * height).exp().acosh(), (G / drag * (1.0 - (-2.0 * drag * height).exp())).sqrt())
}

impl Ball {
    fn rise(&self, speed: f64) -> (f64, f64) {
        if self.drag < 1e-9 {
            return (speed / G, speed * speed / (2.0 * G));
        }
        let u = speed * (self.drag / G).sqrt();
        (u.atan() / (G * self.drag).sqrt(), (u * u).ln_1p() / (2.0 * self.drag))
    }

    /// The fall and `bounces` flights after it.
    pub(crate) fn flights(&self, release: f64, bounces: usize) -> Vec<Flight> {
        let (lasts, mut arrival) = fall(self.drop, self.drag);
        let mut at = release + lasts;
        let mut flights = vec![Flight { start: release, up: 0.0, apex: (release, self.drop), end: at }];
        for _ in 0..bounces {
            let up = (self.cor.0 - self.cor.1 * arrival) * arrival;
            let (rises, apex) = self.rise(up);
            let (falls, next) = fall(apex, self.drag);
            flights.push(Flight { start: at, up, apex: (at + rises, apex), end: at + rises + falls });
            (at, arrival) = (at + rises + falls, next);
        }
        flights
    }

    /// The CORs of the first `bounces` impacts: the least and the greatest.
    pub(crate) fn cors(&self, bounces: usize) -> [f64; 2] {
        let mut arrival = fall(self.drop, self.drag).1;
        let mut ends = [f64::INFINITY, 0.0f64];
        for _ in 0..bounces {
            let e = self.cor.0 - self.cor.1 * arrival;
            ends = [ends[0].min(e), ends[1].max(e)];
            arrival = fall(self.rise(e * arrival).1, self.drag).1;
        }
        ends
    }

    /// The height at `t` during these flights; at rest on the floor after them.
    pub(crate) fn height(&self, flights: &[Flight], t: f64) -> f64 {
        let Some(flight) = flights.iter().find(|f| t < f.end) else { return 0.0 };
        let (top, apex) = flight.apex;
        if t <= top && flight.up == 0.0 {
            return self.drop;
        }
        let s = t - top;
        if self.drag < 1e-9 {
            return apex - 0.5 * G * s * s;
        }
        let w = (G * self.drag).sqrt() * s;
        apex - if s > 0.0 { w.cosh().ln() } else { -w.cos().ln() } / self.drag
    }
}
