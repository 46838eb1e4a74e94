//! Quantities as people write them: `100 cm`, `9.81 m/s^2`, `33ms`, turned into SI numbers.

use std::fmt;

/// What a quantity measures; decides which units are understood and which SI unit the number comes back in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// A length, in metres.
    Length,
    /// A duration or a moment, in seconds.
    Time,
    /// A speed, in metres per second.
    Speed,
    /// An acceleration, in metres per second squared.
    Acceleration,
}

impl Quantity {
    /// The units understood, each with its value in the SI unit; the SI unit comes first.
    #[must_use]
    pub const fn units(self) -> &'static [(&'static str, f64)] {
        match self {
            Self::Length => &[
                ("m", 1.0),
                ("cm", 1e-2),
                ("mm", 1e-3),
                ("um", 1e-6),
                ("µm", 1e-6),
                ("km", 1e3),
                ("in", 0.0254),
                ("ft", 0.3048),
            ],
            Self::Time => &[("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("µs", 1e-6), ("min", 60.0), ("sec", 1.0)],
            Self::Speed => &[("m/s", 1.0), ("cm/s", 1e-2), ("mm/s", 1e-3), ("km/h", 1.0 / 3.6), ("ft/s", 0.3048)],
            Self::Acceleration => {
                &[("m/s^2", 1.0), ("m/s2", 1.0), ("m/s²", 1.0), ("cm/s^2", 1e-2), ("cm/s²", 1e-2), ("ft/s^2", 0.3048)]
            }
        }
    }

    /// The value of one `unit` in the SI unit of this quantity, or `None` if the unit does not measure it.
    ///
    /// ```
    /// use saltus_bounce::units::Quantity;
    /// assert_eq!(Quantity::Length.scale("cm"), Some(0.01));
    /// assert_eq!(Quantity::Length.scale("ms"), None);
    /// ```
    #[must_use]
    pub fn scale(self, unit: &str) -> Option<f64> {
        self.units().iter().find(|(name, _)| *name == unit).map(|&(_, scale)| scale)
    }

    /// Reads a number with a unit, such as `1m`, `100 cm` or `9.81 m/s^2`, into the SI unit.
    ///
    /// The unit is required: a bare number is refused rather than guessed, except zero, which is the same in every unit.
    ///
    /// ```
    /// use saltus_bounce::units::Quantity;
    /// assert_eq!(Quantity::Length.parse("100 cm"), Ok(1.0));
    /// assert_eq!(Quantity::Time.parse("33ms"), Ok(0.033));
    /// assert!(Quantity::Length.parse("100").unwrap_err().to_string().contains("give a unit"));
    /// ```
    ///
    /// # Errors
    /// [`UnitError`] when the text is not a finite number followed by a unit of this quantity.
    pub fn parse(self, text: &str) -> Result<f64, UnitError> {
        let fail = |problem| UnitError { text: text.trim().to_owned(), quantity: self, problem };
        let trimmed = text.trim();
        let split = number_end(trimmed);
        let (number, unit) = (&trimmed[..split], trimmed[split..].trim());
        let value: f64 = number.parse().map_err(|_| fail(Problem::NotANumber))?;
        if !value.is_finite() {
            return Err(fail(Problem::NotFinite));
        }
        if unit.is_empty() {
            return if value == 0.0 { Ok(0.0) } else { Err(fail(Problem::NoUnit)) };
        }
        let scale = self.scale(unit).ok_or_else(|| fail(Problem::UnknownUnit(unit.to_owned())))?;
        // Dividing by a whole number is exact where multiplying by its rounded inverse is not: 33 ms is 0.033 s.
        let inverse = (1.0 / scale).round();
        let si =
            if scale < 1.0 && (inverse * scale - 1.0).abs() < f64::EPSILON { value / inverse } else { value * scale };
        if si.is_finite() { Ok(si) } else { Err(fail(Problem::NotFinite)) }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Length => "length",
            Self::Time => "time",
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
        })
    }
}

/// Where the number at the start of `text` ends: an `e` belongs to it only when digits follow.
fn number_end(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = 0;
    while let Some(&byte) = bytes.get(end) {
        let exponent = matches!(byte, b'e' | b'E')
            && end > 0
            && match bytes.get(end + 1) {
                Some(b'+' | b'-') => bytes.get(end + 2).is_some_and(u8::is_ascii_digit),
                Some(next) => next.is_ascii_digit(),
                None => false,
            };
        let sign = matches!(byte, b'+' | b'-') && (end == 0 || matches!(bytes[end - 1], b'e' | b'E'));
        if byte.is_ascii_digit() || byte == b'.' || exponent || sign {
            end += 1;
        } else {
            break;
        }
    }
    end
}

/// A quantity that could not be read: what was written, what was expected, and what to write instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct UnitError {
    text: String,
    quantity: Quantity,
    problem: Problem,
}

#[derive(Clone, Debug, PartialEq, Eq)]
enum Problem {
    NotANumber,
    NotFinite,
    NoUnit,
    UnknownUnit(String),
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { text, quantity, problem } = self;
        let names: Vec<&str> = quantity.units().iter().map(|&(name, _)| name).collect();
        let (known, si) = (names.join(", "), names[0]);
        match problem {
            Problem::NotANumber => {
                write!(f, "'{text}' is not a {quantity}: write a number and a unit, such as '1 {si}'")
            }
            Problem::NotFinite => write!(f, "'{text}' is not a finite {quantity}"),
            Problem::NoUnit => {
                write!(f, "'{text}' has no unit: give a unit of {quantity} ({known}), such as '{text} {si}'")
            }
            Problem::UnknownUnit(unit) => {
                write!(f, "'{unit}' in '{text}' is not a unit of {quantity}: use one of {known}")
            }
        }
    }
}

impl std::error::Error for UnitError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_people_type() {
        for (quantity, text, si) in [
            (Quantity::Length, "1m", 1.0),
            (Quantity::Length, "1e2cm", 1.0),
            (Quantity::Length, " 39.5 mm ", 0.0395),
            (Quantity::Length, "-2 cm", -0.02),
            (Quantity::Length, "0", 0.0),
            (Quantity::Length, "1ft", 0.3048),
            (Quantity::Time, "9.6 ms", 0.0096),
            (Quantity::Time, "2min", 120.0),
            (Quantity::Acceleration, "9.81 m/s²", 9.81),
            (Quantity::Acceleration, "981cm/s^2", 9.81),
            (Quantity::Speed, "36 km/h", 10.0),
        ] {
            let got = quantity.parse(text).unwrap();
            assert!((got - si).abs() <= 1e-15 * si.abs(), "{text}: {got}");
        }
    }

    #[test]
    fn refusals_say_what_to_write() {
        for (text, part) in [
            ("", "not a length"),
            ("tall", "not a length"),
            ("1.2.3 m", "not a length"),
            ("1", "give a unit"),
            ("1 parsec", "'parsec' in '1 parsec' is not a unit of length"),
            ("NaN m", "not a length"),
            ("1e999 m", "not a finite length"),
            ("1e308 km", "not a finite length"),
        ] {
            let message = Quantity::Length.parse(text).unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
