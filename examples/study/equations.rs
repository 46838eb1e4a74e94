//! The study's equations as functions, each with its domain. All in m, s, m/s, m/s².
//!
//! The fall time √(2h/g), contact times and apex heights are [`saltus_bounce::Drop`]'s, the COR
//! from two heights, (8), is [`Cor::from_heights`](saltus_bounce::Cor::from_heights), v⁺ = e v⁻ is
//! [`Cor::rebound`](saltus_bounce::Cor::rebound): they are not repeated here.

/// The apex of a flight: when and how high. Every formula of the study is one flight, and differs
/// by where it has its apex.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Apex {
    /// When, in s.
    pub time: f64,
    /// How high, in m.
    pub height: f64,
}

impl Apex {
    /// The height at `t`: h - ½ g (T - t)². As printed this is (22) with h = h₀/h₁, and (25).
    ///
    /// Right only between one contact and the next; outside it goes on below the floor.
    #[must_use]
    pub fn at(self, gravity: f64, t: f64) -> f64 {
        self.height - 0.5 * gravity * (self.time - t).powi(2)
    }

    /// The upward velocity at `t`: g (T - t).
    #[must_use]
    pub fn velocity(self, gravity: f64, t: f64) -> f64 {
        gravity * (self.time - t)
    }

    /// When the flight leaves the floor and when it meets it: T ∓ √(2h/g); not numbers for h < 0.
    #[must_use]
    pub fn floor(self, gravity: f64) -> [f64; 2] {
        let half = (2.0 * self.height / gravity).sqrt();
        [self.time - half, self.time + half]
    }
}

/// The speed at the floor after a fall from `height` ≥ 0: √(2 g h).
#[must_use]
pub fn impact_speed(height: f64, gravity: f64) -> f64 {
    (2.0 * gravity * height).sqrt()
}

/// How high a ball rises that leaves the floor at `speed`: v²/(2g).
#[must_use]
pub fn rise(speed: f64, gravity: f64) -> f64 {
    speed * speed / (2.0 * gravity)
}

/// A whole bounce, T = 2 √(2h/g) - c: two half bounces of equal height `height` ≥ 0. The study
/// takes c = `early` = 0.01 s.
///
/// It is the time from contact to contact of a flight h high; and from a drop to the next apex only
/// if nothing is lost (e = 1).
#[must_use]
pub fn whole_bounce(height: f64, gravity: f64, early: f64) -> f64 {
    2.0 * (2.0 * height / gravity).sqrt() - early
}

/// The height of a flight that lasts `duration` ≥ 0 from contact to contact: g Δ²/8, the inverse of
/// [`whole_bounce`] with `early` = 0.
#[must_use]
pub fn height_of(duration: f64, gravity: f64) -> f64 {
    gravity * duration * duration / 8.0
}

/// How much sooner a ball turns at its own radius than at the floor, there and back: 2 (√(2h/g) -
/// √(2(h - r)/g)), for 0 ≤ r ≤ h.
///
/// Heights count to the ball's centre here. Written without cancellation, as 4 r / (g (√(2h/g) +
/// √(2(h - r)/g))).
#[must_use]
pub fn early_by_radius(height: f64, radius: f64, gravity: f64) -> f64 {
    let fall = |h: f64| (2.0 * h / gravity).sqrt();
    if radius == 0.0 { 0.0 } else { 4.0 * radius / (gravity * (fall(height) + fall(height - radius))) }
}

/// How high above the floor a ball turns whose [`whole_bounce`] is cut short by `early` ≤ 2
/// √(2h/g): h - ½ g (T/2)².
#[must_use]
pub fn turns_at(height: f64, gravity: f64, early: f64) -> f64 {
    let half = 0.5 * whole_bounce(height, gravity, early);
    height - 0.5 * gravity * half * half
}

/// The flights of the study's last formula, without end: at each contact V = e V, then h = V²/(2g)
/// and T = 2 √(2h/g) - c.
///
/// The first contact is at √(2h₀/g), each next one T later, each apex midway. With c = 0 this is
/// the bouncing ball itself.
pub fn flights(drop: f64, gravity: f64, cor: f64, early: f64) -> impl Iterator<Item = Flight> {
    let (mut speed, mut contact) = (impact_speed(drop, gravity), (2.0 * drop / gravity).sqrt());
    std::iter::repeat_with(move || {
        speed *= cor;
        let height = rise(speed, gravity);
        let span = whole_bounce(height, gravity, early);
        let start = contact;
        contact += span;
        Flight { start, span, apex: Apex { time: start + 0.5 * span, height } }
    })
}

/// One flight from contact to contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flight {
    /// The contact it begins with, in s.
    pub start: f64,
    /// How long it lasts, in s.
    pub span: f64,
    /// Its apex.
    pub apex: Apex,
}

/// What a "total time" may mean; the study says when the ball "comes to rest".
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Total {
    /// Until the third contact: t₀ (1 + 2e + 2e²).
    ThirdContact,
    /// Until the apex of the second rebound: t₀ (1 + e)².
    SecondRebound,
    /// Until rest: t₀ (1 + e)/(1 - e).
    Rest,
}

impl Total {
    /// The three readings.
    pub const ALL: [Self; 3] = [Self::ThirdContact, Self::SecondRebound, Self::Rest];

    /// The total time for the COR `e`, 0 ≤ e ≤ 1, and the fall time t₀ = `fall`.
    #[must_use]
    pub fn time(self, e: f64, fall: f64) -> f64 {
        fall * match self {
            Self::ThirdContact => 1.0 + 2.0 * e * (1.0 + e),
            Self::SecondRebound => (1.0 + e).powi(2),
            Self::Rest => (1.0 + e) / (1.0 - e),
        }
    }

    /// The COR that gives `total`, for `total` ≥ `fall`: each reading has exactly one. It may be
    /// above 1; the time to rest has none above 1.
    #[must_use]
    pub fn cor(self, total: f64, fall: f64) -> f64 {
        let x = total / fall;
        match self {
            Self::ThirdContact => 0.5 * ((2.0 * x - 1.0).sqrt() - 1.0),
            Self::SecondRebound => x.sqrt() - 1.0,
            Self::Rest => (x - 1.0) / (x + 1.0),
        }
    }
}
