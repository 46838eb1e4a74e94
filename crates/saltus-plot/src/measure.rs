//! What an axis measures, and the unit in which it is shown.

use std::borrow::Cow;

use crate::unit::Unit;

/// The quantity on an axis; data are given in SI units.
///
/// A unit by name, `"V".into()`, gets a prefix where its numbers would be long, if it is one of the
/// SI that takes prefixes; `bar`, `1/min` and any other stay as they are.
///
/// ```
/// use saltus_plot::{Chart, Measure, Stroke};
/// let loading = Stroke::between([0.0, 0.0], [1e-3, 230e3]);
/// let chart = Chart::new("Charging", ("Time", Measure::Time), ("Pressure", "Pa".into())).line("", [loading]);
/// assert!(chart.svg()?.contains("Pressure (kPa)"));
/// # Ok::<(), saltus_plot::PlotError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Measure {
    /// A time in s.
    Time,
    /// A length in m.
    Length,
    /// A speed in m/s.
    Speed,
    /// An energy in J.
    Energy,
    /// An energy per mass in J/kg.
    SpecificEnergy,
    /// A force in N.
    Force,
    /// A count, in whole numbers.
    Count,
    /// A number without a unit.
    Number,
    /// A quantity in the unit of this name, in which data are given.
    Unit(Cow<'static, str>),
}

impl From<&'static str> for Measure {
    fn from(unit: &'static str) -> Self {
        Self::Unit(unit.into())
    }
}

impl From<String> for Measure {
    fn from(unit: String) -> Self {
        Self::Unit(unit.into())
    }
}

impl Measure {
    /// The unit in which values from `low` to `high` are shown.
    pub(crate) fn unit(&self, (low, high): (f64, f64)) -> Unit {
        let (largest, span) = (low.abs().max(high.abs()), high - low);
        match self {
            Self::Time => Unit::of_time(largest, span),
            Self::Length => Unit::of_height(None, largest, span),
            Self::Speed => Unit::scaled("m/s", 1.0, largest, span),
            Self::Energy => Unit::prefixed("J", largest, span),
            Self::SpecificEnergy => Unit::prefixed("J/kg", largest, span),
            Self::Force => Unit::prefixed("N", largest, span),
            Self::Count | Self::Number => Unit { size: 1.0, label: String::new() },
            Self::Unit(name) => Unit::named(name, largest, span),
        }
    }
}
