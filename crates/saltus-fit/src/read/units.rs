//! Units as people write them in headings and cells.

use saltus_bounce::units::Quantity;

use super::phrases::Phrase;
use super::vocabulary::{Atom, folded, meanings, narrow};
use super::words::{Kind, Word, split};

/// What a unit measures, as far as a table of bounces asks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Dimension {
    Length,
    Time,
    Speed,
    /// Anything else: a mass, an angle.
    Other,
}

impl Dimension {
    /// The noun of a message.
    pub(super) fn noun(self) -> &'static str {
        match self {
            Self::Length => "length",
            Self::Time => "time",
            Self::Speed => "speed",
            Self::Other => "anything here",
        }
    }

    /// The units that are offered.
    pub(super) fn known(self) -> String {
        let list = |quantity: Quantity| quantity.units().iter().map(|(name, _)| *name).collect::<Vec<_>>().join(", ");
        match self {
            Self::Time => list(Quantity::Time),
            Self::Speed => list(Quantity::Speed),
            _ => format!("{}, px", list(Quantity::Length)),
        }
    }
}

/// What one of a unit is: a number of SI units, or something that only ratios have a meaning for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Scale {
    /// A factor, or, where that is exact, a divisor: 30 cm is 30 / 100 m.
    Si { times: f64, over: f64 },
    /// A pixel of unknown size.
    Pixels,
    /// A hundredth of the height of release.
    Percent,
    /// The height of release, of which its numbers are parts.
    Whole,
    /// A number of joules, as much as a ball has at a height: a mass that nobody knows away from
    /// it.
    Energy { times: f64, over: f64 },
    /// A degree, or a pressure: what state a ball or a floor was in.
    State,
}

/// Units of temperature and of pressure that ball, floor and air are kept at.
const STATES: [&str; 8] = ["°c", "°f", "degc", "degf", "psi", "bar", "kpa", "atm"];

/// Units of energy, and how many of them make a joule.
const JOULES: [(&str, f64); 8] = [
    ("j", 1.0),
    ("joule", 1.0),
    ("joules", 1.0),
    ("kj", 1e-3),
    ("mj", 1e3),
    ("millijoule", 1e3),
    ("millijoules", 1e3),
    ("µj", 1e6),
];
/// By the international mile, m/s.
const MILE_AN_HOUR: f64 = 0.447_04;

/// Whether a name is that of a unit: `unit`, `height_unit`.
pub(super) fn names_unit(name: &str) -> bool {
    split(name).iter().any(|word| word.is(Atom::Measure))
}

/// A unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Unit {
    pub(super) dimension: Dimension,
    pub(super) scale: Scale,
}

impl Unit {
    pub(super) const OTHER: Self = Self { dimension: Dimension::Other, scale: Scale::Si { times: 1.0, over: 1.0 } };
    pub(super) const SECOND: Self = Self { dimension: Dimension::Time, scale: Scale::Si { times: 1.0, over: 1.0 } };
    pub(super) const HOUR: Self = Self { dimension: Dimension::Time, scale: Scale::Si { times: 3600.0, over: 1.0 } };
    pub(super) const WHOLE: Self = Self { dimension: Dimension::Length, scale: Scale::Whole };
    /// A joule, as a measure of the height it stands for.
    pub(super) const JOULE: Self =
        Self { dimension: Dimension::Length, scale: Scale::Energy { times: 1.0, over: 1.0 } };
    /// A speed in a unit that nobody names.
    pub(super) const SPEED: Self = Self { dimension: Dimension::Speed, scale: Scale::Pixels };
    pub(super) const PIXEL: Self = Self { dimension: Dimension::Length, scale: Scale::Pixels };

    /// One frame, in seconds.
    pub(super) fn frame(fps: f64) -> Self {
        Self { dimension: Dimension::Time, scale: Scale::Si { times: 1.0, over: fps } }
    }

    /// A pixel whose size is known, in metres.
    pub(super) fn pixel_of(metres: f64) -> Self {
        Self { dimension: Dimension::Length, scale: Scale::Si { times: metres, over: 1.0 } }
    }

    fn of(dimension: Dimension, scale: f64) -> Self {
        let inverse = (1.0 / scale).round();
        let exact = scale < 1.0 && (inverse * scale - 1.0).abs() < f64::EPSILON;
        let scale = if exact { Scale::Si { times: 1.0, over: inverse } } else { Scale::Si { times: scale, over: 1.0 } };
        Self { dimension, scale }
    }

    /// A number of this unit in SI units; pixels and hundredths stay what they are.
    pub(super) fn si(self, value: f64) -> f64 {
        match self.scale {
            Scale::Si { times, over } | Scale::Energy { times, over } => value * times / over,
            Scale::Pixels | Scale::Whole | Scale::State => value,
            Scale::Percent => value / 100.0,
        }
    }

    /// A unit of energy as a measure of the height at which a ball has it.
    pub(super) fn of_height(self) -> Option<Self> {
        matches!(self.scale, Scale::Energy { .. }).then_some(Self { dimension: Dimension::Length, ..self })
    }

    /// Whether only ratios of its numbers have a meaning.
    pub(super) fn unscaled(self) -> bool {
        !matches!(self.scale, Scale::Si { .. } | Scale::State)
    }

    /// The units that a line states of all numbers, `Unit: cm`, `Units = cm, s`; none if it states
    /// none. Every word before them has to be understood, or stands before the bracket that they
    /// stand in: `Times of flight (unit: s)`.
    pub(super) fn listed(line: &str) -> Option<Vec<Self>> {
        let plain = narrow(line);
        let inside = plain.split_once('(').and_then(|(_, rest)| rest.split_once(')')).map(|(inside, _)| inside);
        let line = inside.filter(|inside| names_unit(inside)).unwrap_or(&plain);
        let (name, units) = line.split_once([':', '=']).filter(|(name, _)| names_unit(name))?;
        let said = |word: &Word| !matches!(word.kind, Kind::Unknown) || names_unit(&word.text);
        let units = units.split([',', ';', '/', ' ']).filter(|word| !word.is_empty() && !Phrase::And.is(word));
        let found: Vec<Self> = units.map(Self::parse).collect::<Option<_>>()?;
        (!found.is_empty() && split(name).iter().all(said)).then_some(found)
    }

    /// The unit that a text is and nothing else: `cm`, `m/s`, `inches`, `%`.
    pub(super) fn parse(text: &str) -> Option<Self> {
        let text = text.trim().trim_end_matches('.');
        let lower = folded(text);
        // `m s^-1`, `m·s⁻¹`, `ms-1`.
        let inverse = ["^-1", "^{-1}", "⁻¹", "^−1", "-1"].iter().find_map(|power| lower.strip_suffix(power));
        if let Some((one, other)) =
            inverse.and_then(|units| units.char_indices().last().map(|(at, _)| units.split_at(at)))
        {
            return Self::parse(&format!("{}/{other}", one.trim_end_matches([' ', '.', '·', '*', '⋅'])));
        }
        let symbol = match meanings(&lower) {
            Some([Atom::Unit(symbol)]) => symbol,
            _ => lower.as_str(),
        };
        match symbol {
            "%" | "percent" | "pct" => return Some(Self { dimension: Dimension::Length, scale: Scale::Percent }),
            "px" => return Some(Self::PIXEL),
            "\"" | "″" | "''" | "”" => return Self::parse("in"),
            "'" | "′" | "’" => return Self::parse("ft"),
            "second" | "secs" => return Some(Self::SECOND),
            "mph" | "mi/h" => return Some(Self::of(Dimension::Speed, MILE_AN_HOUR)),
            _ => {}
        }
        // Words of two units, `metre/second`, are their symbols.
        let spelt = |word: &str| match meanings(word.trim()) {
            Some([Atom::Unit(symbol)]) => (*symbol).to_owned(),
            Some([Atom::Ordinal(2)]) if word.trim() == "second" => "s".to_owned(),
            _ => word.trim().to_owned(),
        };
        if let Some((one, other)) = symbol.split_once('/') {
            let both = format!("{}/{}", spelt(one), spelt(other));
            if both != symbol {
                return Self::parse(&both);
            }
        }
        if let Some((_, over)) = JOULES.iter().find(|(name, _)| *name == symbol) {
            return Some(Self { dimension: Dimension::Other, scale: Scale::Energy { times: 1.0, over: *over } });
        }
        for (quantity, dimension) in [
            (Quantity::Length, Dimension::Length),
            (Quantity::Time, Dimension::Time),
            (Quantity::Speed, Dimension::Speed),
        ] {
            if let Some(scale) = quantity.scale(symbol) {
                return Some(Self::of(dimension, scale));
            }
        }
        if STATES.contains(&symbol) {
            return Some(Self { dimension: Dimension::Other, scale: Scale::State });
        }
        let other = Quantity::ALL.iter().any(|quantity| quantity.scale(text).or(quantity.scale(symbol)).is_some())
            || ["n", "w", "k", "db", "hpa", "fps", "cm^2", "cm2", "m^2", "mm^2"].contains(&symbol);
        other.then_some(Self::OTHER)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_as_people_write_them() {
        let length = |text: &str| Unit::parse(text).filter(|u| u.dimension == Dimension::Length).map(|u| u.si(1.0));
        assert_eq!(
            ["m", "cm", "CM", "cm.", "inches", "\"", "Meter", "mètres", "%"].map(length),
            [1.0, 0.01, 0.01, 0.01, 0.0254, 0.0254, 1.0, 1.0, 0.01].map(Some)
        );
        let dimension = |text: &str| Unit::parse(text).map(|u| u.dimension);
        assert_eq!(dimension("ms"), Some(Dimension::Time));
        let speeds = ["m/s", "metre/second", "Meter / s", "m s^-1", "ms⁻¹", "m·s^{-1}", "cm s-1"];
        assert_eq!(speeds.map(dimension), [Some(Dimension::Speed); 7]);
        assert_eq!(["metre/wobble", "trial/second", "wobble^-1", "-1"].map(dimension), [None; 4]);
        assert_eq!(dimension("kg"), Some(Dimension::Other));
        assert_eq!(["", "furlong", "trial"].map(dimension), [None; 3]);
    }
}
