//! Numbers with their errors and their origins.

use serde::{Deserialize, Serialize};

use crate::word::words;

/// Gravity where nobody states it, m/s².
pub(crate) const STANDARD_GRAVITY: f64 = 9.81;

/// A value with its standard error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Measured {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
}

words! {
    /// Where a number came from.
    pub enum Source {
        /// The caller stated it.
        Stated = "stated",
        /// The table states it.
        Table = "table",
        /// One frame of the camera, 1/fps, over √12: the standard deviation of rounding to whole
        /// frames.
        FrameRate = "frame rate",
        /// The scatter of the readings about the fit.
        Scatter = "scatter",
        /// Nobody stated it: a usual value.
        Assumed = "assumed",
    }
}

/// A number with its origin.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Sourced {
    /// The value in SI units.
    pub value: f64,
    /// Where it came from.
    pub source: Source,
}

words! {
    /// One kind of reading.
    pub enum Readings {
        /// Heights of the release and of apexes.
        Heights = "heights",
        /// Times of contacts and of apexes.
        Times = "times",
    }
}

words! {
    /// What a fit makes small, of residuals divided by their standard errors.
    pub enum Loss {
        /// Squares up to 1.345 standard errors, in proportion beyond: outliers count less (P.
        /// Huber, Ann. Math. Statist. 35 (1964) 73).
        Huber = "huber",
        /// The sum of absolute residuals.
        Absolute = "absolute",
        /// The largest residual.
        Largest = "largest",
    }
}

impl Loss {
    /// Every one.
    pub const ALL: [Self; 3] = [Self::Huber, Self::Absolute, Self::Largest];
}

words! {
    /// How an estimate of the COR was made.
    pub enum Method {
        /// Rebound heights, least squares.
        Heights = "heights",
        /// The geometric mean over the bounces, from the first and the last height.
        HeightsMean = "heights-mean",
        /// Neighbouring heights, a rebound of zero among them.
        HeightsRatio = "heights-ratio",
        /// Heights without the bound e ≤ 1.
        HeightsUnbounded = "heights-unbounded",
        /// Heights under Huber's loss.
        HeightsHuber = "heights-huber",
        /// Heights under the sum of absolute residuals.
        HeightsAbsolute = "heights-absolute",
        /// Heights under the largest residual.
        HeightsLargest = "heights-largest",
        /// Contact times, least squares.
        Times = "times",
        /// The geometric mean over the bounces, from the fall and the last flight.
        TimesMean = "times-mean",
        /// Times without the bound e ≤ 1.
        TimesUnbounded = "times-unbounded",
        /// Times under Huber's loss.
        TimesHuber = "times-huber",
        /// Times under the sum of absolute residuals.
        TimesAbsolute = "times-absolute",
        /// Times under the largest residual.
        TimesLargest = "times-largest",
        /// The first flight over twice the fall from the release height.
        FirstFlight = "first-flight",
        /// Heights and times together.
        Joint = "joint",
        /// The whole motion through every sample, without air drag.
        Series = "series",
        /// The same with quadratic air drag.
        SeriesDrag = "series-drag",
    }
}

impl Method {
    /// The least squares of one kind of reading.
    pub(crate) const fn of(readings: Readings) -> Self {
        match readings {
            Readings::Heights => Self::Heights,
            Readings::Times => Self::Times,
        }
    }

    /// The same without the bound e ≤ 1.
    pub(crate) const fn unbounded(readings: Readings) -> Self {
        match readings {
            Readings::Heights => Self::HeightsUnbounded,
            Readings::Times => Self::TimesUnbounded,
        }
    }

    /// The same under another loss.
    pub(crate) const fn under(readings: Readings, loss: Loss) -> Self {
        match (readings, loss) {
            (Readings::Heights, Loss::Huber) => Self::HeightsHuber,
            (Readings::Heights, Loss::Absolute) => Self::HeightsAbsolute,
            (Readings::Heights, Loss::Largest) => Self::HeightsLargest,
            (Readings::Times, Loss::Huber) => Self::TimesHuber,
            (Readings::Times, Loss::Absolute) => Self::TimesAbsolute,
            (Readings::Times, Loss::Largest) => Self::TimesLargest,
        }
    }

    /// The readings and the loss of an estimate by another loss than least squares.
    pub(crate) fn loss(self) -> Option<(Readings, Loss)> {
        let all = [Readings::Heights, Readings::Times].into_iter().flat_map(|r| Loss::ALL.map(|loss| (r, loss)));
        all.into_iter().find(|&(readings, loss)| Self::under(readings, loss) == self)
    }
}

words! {
    /// What the COR is supposed to depend on, and what else there is beside it.
    pub enum CorModel {
        /// One COR.
        Constant = "constant",
        /// e = e₀ − k v.
        Linear = "linear",
        /// A viscoelastic sphere: e = 1 − γ v^(1/5) + (3/5) γ² v^(2/5) ∓ …, as the Padé approximant
        /// of Müller and Pöschel (2011).
        Viscoelastic = "viscoelastic",
        /// A plastic impact: e = C v^(−1/4).
        Plastic = "plastic",
        /// e = C v^(−p).
        Power = "power",
        /// Straight lines between three or four speeds, never rising.
        Knots = "knots",
        /// A COR for every bounce.
        Each = "each",
        /// A height scale that reads too high, by a ball at most.
        Offset = "offset",
        /// Rebounds that are read higher on the ball than the release, by a ball at most.
        Rebounds = "rebounds",
        /// Air drag, quadratic in speed.
        Drag = "drag",
        /// Contacts that take time, always the same.
        Contact = "contact",
        /// One COR, and a rebound that is not in the table.
        Missed = "missed",
        /// Of a recording: one COR and air drag.
        ConstantDrag = "constant-drag",
        /// Of a recording: a COR linear in speed and air drag.
        LinearDrag = "linear-drag",
        /// Of a recording: a COR for every impact and air drag.
        EachDrag = "each-drag",
    }
}

impl CorModel {
    /// Every model that can be asked for.
    pub const ALL: [Self; 11] = [
        Self::Constant,
        Self::Linear,
        Self::Viscoelastic,
        Self::Plastic,
        Self::Power,
        Self::Knots,
        Self::Each,
        Self::Offset,
        Self::Rebounds,
        Self::Drag,
        Self::Contact,
    ];
}

words! {
    /// What might explain heights and times that disagree.
    pub enum Explanation {
        /// The zero of the height scale is off.
        HeightZero = "height-zero",
        /// Every bounce has a COR of its own.
        CorPerBounce = "cor-per-bounce",
        /// The clock was not at its noted time at the release.
        ClockLag = "clock-lag",
        /// Air drag slows the ball.
        AirDrag = "air-drag",
        /// The COR depends on the speed of impact.
        CorOfSpeed = "cor-of-speed",
        /// A contact was overlooked.
        MissedContact = "missed-contact",
    }
}

impl Explanation {
    /// The readings that are at fault where it holds, and would be again; `None` where the ball is.
    #[must_use]
    pub const fn at_fault(self) -> Option<Readings> {
        match self {
            Self::HeightZero => Some(Readings::Heights),
            Self::ClockLag | Self::MissedContact => Some(Readings::Times),
            Self::CorPerBounce | Self::AirDrag | Self::CorOfSpeed => None,
        }
    }
}

words! {
    /// A ball of a sport, by its rules: what it weighs and measures tells its drag.
    pub enum Ball {
        /// 40 mm, 2.7 g.
        TableTennis = "table-tennis",
        /// 67 mm, 58 g.
        Tennis = "tennis",
        /// 40 mm, 24 g.
        Squash = "squash",
        /// 43 mm, 46 g.
        Golf = "golf",
        /// 240 mm, 620 g.
        Basketball = "basketball",
        /// 220 mm, 430 g: association football.
        Football = "football",
        /// 210 mm, 270 g.
        Volleyball = "volleyball",
        /// 73 mm, 145 g.
        Baseball = "baseball",
        /// 72 mm, 160 g.
        Cricket = "cricket",
        /// 63 mm, 145 g.
        Lacrosse = "lacrosse",
    }
}

/// The density of air, kg/m³, and the drag coefficient of a ball at 1 to 10 m/s.
const AIR: f64 = 1.2;
const DRAG_COEFFICIENT: f64 = 0.5;

impl Ball {
    /// All of them.
    pub const ALL: [Self; 10] = [
        Self::TableTennis,
        Self::Tennis,
        Self::Squash,
        Self::Golf,
        Self::Basketball,
        Self::Football,
        Self::Volleyball,
        Self::Baseball,
        Self::Cricket,
        Self::Lacrosse,
    ];

    /// The ball of a name such as `tennis`, `Golf ball` or `ping-pong`; `None` where a word of it
    /// is not understood.
    ///
    /// ```
    /// use saltus_fit::Ball;
    /// assert_eq!(Ball::named("Table tennis ball"), Some(Ball::TableTennis));
    /// assert_eq!((Ball::named("old tennis ball"), Ball::named("soccer")), (None, Some(Ball::Football)));
    /// ```
    #[must_use]
    pub fn named(text: &str) -> Option<Self> {
        let lower = text.trim().to_lowercase();
        let words: Vec<&str> = lower.split(|c: char| c.is_whitespace() || "_-".contains(c)).collect();
        let bare = match words.as_slice() {
            [name @ .., "ball" | "balls"] if !name.is_empty() => name.join("-"),
            name => name.join("-"),
        };
        let name = match bare.as_str() {
            "pingpong" | "ping-pong" => Self::TableTennis.name(),
            "soccer" => Self::Football.name(),
            name => name,
        };
        Self::ALL.into_iter().find(|ball| ball.name() == name || name.strip_suffix("ball") == Some(ball.name()))
    }

    /// Diameter, m, and mass, kg.
    const fn sizes(self) -> (f64, f64) {
        match self {
            Self::TableTennis => (0.040, 0.0027),
            Self::Tennis => (0.067, 0.058),
            Self::Squash => (0.040, 0.024),
            Self::Golf => (0.043, 0.046),
            Self::Basketball => (0.240, 0.620),
            Self::Football => (0.220, 0.430),
            Self::Volleyball => (0.210, 0.270),
            Self::Baseball => (0.073, 0.145),
            Self::Cricket => (0.072, 0.160),
            Self::Lacrosse => (0.063, 0.145),
        }
    }

    /// Its diameter, m.
    #[must_use]
    pub const fn diameter(self) -> f64 {
        self.sizes().0
    }

    /// The drag coefficient k = ρ `c_d` π d²/8m of v' = −g ∓ k v², 1/m.
    ///
    /// ```
    /// use saltus_fit::Ball;
    /// assert!((Ball::TableTennis.drag() - 0.14).abs() < 0.001 && (Ball::Squash.drag() - 0.016).abs() < 0.001);
    /// ```
    #[must_use]
    pub fn drag(self) -> f64 {
        let (diameter, mass) = self.sizes();
        AIR * DRAG_COEFFICIENT * std::f64::consts::PI * diameter * diameter / (8.0 * mass)
    }
}
