//! Quantities as people write them: `100 cm`, `9.81 m/s^2`, `33ms`, turned into SI numbers.

use std::f64::consts::{PI, TAU};
use std::fmt;

/// The kind of a quantity; decides which units are understood and in which SI unit the number comes
/// back.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// A length, in metres.
    Length,
    /// A duration or a moment, in seconds.
    Time,
    /// A speed, in metres per second.
    Speed,
    /// An acceleration, in metres per second squared.
    Acceleration,
    /// A mass, in kilograms.
    Mass,
    /// An angle, in radians.
    Angle,
    /// A spin, in radians per second.
    AngularSpeed,
    /// A frequency, in hertz.
    Frequency,
    /// A rate of decay, per second.
    Rate,
    /// Something per length, in 1/m: a curvature, or drag per distance.
    PerLength,
    /// Something per speed, in s/m: a slope over the speed of impact.
    PerSpeed,
    /// A density, in kilograms per cubic metre.
    Density,
    /// A dynamic viscosity, in pascal seconds.
    Viscosity,
    /// A pressure or an elastic modulus, in pascals.
    Pressure,
    /// A force, in newtons.
    Force,
    /// A linear stiffness, in N/m.
    Stiffness,
    /// A linear damping, in N s/m.
    Damping,
    /// The stiffness of a Hertz contact, in N/m^(3/2).
    HertzStiffness,
    /// The damping of a Hunt-Crossley contact, in N s/m^(5/2).
    HertzDamping,
}

impl Quantity {
    /// Every quantity.
    pub const ALL: [Self; 19] = [
        Self::Length,
        Self::Time,
        Self::Speed,
        Self::Acceleration,
        Self::Mass,
        Self::Angle,
        Self::AngularSpeed,
        Self::Frequency,
        Self::Rate,
        Self::PerLength,
        Self::PerSpeed,
        Self::Density,
        Self::Viscosity,
        Self::Pressure,
        Self::Force,
        Self::Stiffness,
        Self::Damping,
        Self::HertzStiffness,
        Self::HertzDamping,
    ];

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
            Self::Mass => &[
                ("kg", 1.0),
                ("g", 1e-3),
                ("mg", 1e-6),
                ("ug", 1e-9),
                ("µg", 1e-9),
                ("t", 1e3),
                ("lb", 0.453_592_37),
                ("oz", 0.028_349_523_125),
            ],
            Self::Angle => &[("rad", 1.0), ("deg", PI / 180.0), ("°", PI / 180.0), ("rev", TAU)],
            Self::AngularSpeed => &[
                ("rad/s", 1.0),
                ("deg/s", PI / 180.0),
                ("°/s", PI / 180.0),
                ("rev/s", TAU),
                ("rev/min", TAU / 60.0),
                ("rpm", TAU / 60.0),
            ],
            Self::Frequency => {
                &[("Hz", 1.0), ("kHz", 1e3), ("mHz", 1e-3), ("1/s", 1.0), ("/s", 1.0), ("/min", 1.0 / 60.0)]
            }
            Self::Rate => &[("1/s", 1.0), ("/s", 1.0), ("1/min", 1.0 / 60.0), ("/min", 1.0 / 60.0)],
            Self::PerLength => &[("1/m", 1.0), ("/m", 1.0), ("1/cm", 1e2), ("/cm", 1e2), ("1/km", 1e-3), ("/km", 1e-3)],
            Self::PerSpeed => &[("s/m", 1.0), ("s/cm", 1e2)],
            Self::Density => {
                &[("kg/m^3", 1.0), ("kg/m3", 1.0), ("kg/m³", 1.0), ("g/cm^3", 1e3), ("g/cm³", 1e3), ("g/l", 1.0)]
            }
            Self::Viscosity => {
                &[("Pa s", 1.0), ("mPa s", 1e-3), ("uPa s", 1e-6), ("µPa s", 1e-6), ("P", 0.1), ("cP", 1e-3)]
            }
            Self::Pressure => &[("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9), ("bar", 1e5)],
            Self::Force => &[("N", 1.0), ("mN", 1e-3), ("kN", 1e3)],
            Self::Stiffness => &[("N/m", 1.0), ("kN/m", 1e3), ("MN/m", 1e6), ("N/mm", 1e3), ("N/cm", 1e2)],
            Self::Damping => &[("N s/m", 1.0), ("kg/s", 1.0), ("kN s/m", 1e3)],
            Self::HertzStiffness => {
                &[("N/m^1.5", 1.0), ("N/m^(3/2)", 1.0), ("kN/m^1.5", 1e3), ("MN/m^1.5", 1e6), ("GN/m^1.5", 1e9)]
            }
            Self::HertzDamping => &[("N s/m^2.5", 1.0), ("N s/m^(5/2)", 1.0), ("kN s/m^2.5", 1e3)],
        }
    }

    /// The largest number in the SI unit, positive or negative, with which a simulation can be
    /// right.
    ///
    /// Places up to 10¹² m and times up to 10¹² s are kept to a tenth of a millimetre and of a
    /// millisecond, for the rounding of a number is 1.1 × 10⁻¹⁶ of it; angles and what they change
    /// by in a second likewise. Speeds end where Newton's mechanics does, at that of light.
    /// Anything else may be as large as 10³⁰: the product of ten such numbers is still one.
    ///
    /// ```
    /// use saltus_bounce::units::Quantity;
    /// assert_eq!(Quantity::Speed.largest(), 299_792_458.0);
    /// let error = Quantity::Speed.parse("1e160 m/s").unwrap_err().to_string();
    /// assert_eq!(error, "'1e160 m/s' is beyond the numbers that can be right: a speed is at most 299792458 m/s either way");
    /// ```
    #[must_use]
    pub const fn largest(self) -> f64 {
        match self {
            Self::Length | Self::Time | Self::Angle | Self::AngularSpeed | Self::Frequency | Self::Rate => 1e12,
            Self::Speed => 299_792_458.0,
            _ => 1e30,
        }
    }

    /// `value` in the SI unit, if it is a number and not beyond [`largest`](Self::largest).
    ///
    /// # Errors
    /// [`UnitError`] that says the range.
    ///
    /// ```
    /// use saltus_bounce::units::Quantity;
    /// assert_eq!(Quantity::Length.check(-2.5), Ok(-2.5));
    /// assert!(Quantity::Time.check(1e300).unwrap_err().to_string().contains("at most 1e12 s "));
    /// ```
    pub fn check(self, value: f64) -> Result<f64, UnitError> {
        let problem = if !value.is_finite() {
            Problem::NotFinite
        } else if value.abs() > self.largest() {
            Problem::TooLarge
        } else {
            return Ok(value);
        };
        Err(UnitError { text: format!("{} {}", written(value), self.si()), quantity: self, problem })
    }

    /// The SI unit in which numbers come back, such as `m`.
    #[must_use]
    pub const fn si(self) -> &'static str {
        self.units()[0].0
    }

    /// The indefinite article that goes before its name.
    #[must_use]
    pub const fn article(self) -> &'static str {
        match self {
            Self::Acceleration | Self::Angle | Self::AngularSpeed | Self::PerLength | Self::PerSpeed => "an",
            _ => "a",
        }
    }

    /// The value of one `unit` in the SI unit of this quantity, or `None` if the unit does not
    /// measure it.
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
    /// The unit is required: a bare number is refused rather than guessed, except zero, which is
    /// the same in every unit.
    ///
    /// ```
    /// use saltus_bounce::units::Quantity;
    /// assert_eq!(Quantity::Length.parse("100 cm"), Ok(1.0));
    /// assert_eq!(Quantity::Time.parse("33ms"), Ok(0.033));
    /// assert!(Quantity::Length.parse("100").unwrap_err().to_string().contains("give a unit"));
    /// ```
    ///
    /// # Errors
    /// [`UnitError`] when the text is not a finite number followed by a unit of this quantity, or
    /// is beyond [`largest`](Self::largest).
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
        // Dividing by a whole number is exact where multiplying by its rounded inverse is not: 33
        // ms is 0.033 s.
        let inverse = (1.0 / scale).round();
        let si =
            if scale < 1.0 && (inverse * scale - 1.0).abs() < f64::EPSILON { value / inverse } else { value * scale };
        match self.check(si) {
            Err(error) => Err(fail(error.problem)),
            Ok(si) => Ok(si),
        }
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Length => "length",
            Self::Time => "time",
            Self::Speed => "speed",
            Self::Acceleration => "acceleration",
            Self::Mass => "mass",
            Self::Angle => "angle",
            Self::AngularSpeed => "angular speed",
            Self::Frequency => "frequency",
            Self::Rate => "rate",
            Self::PerLength => "inverse length",
            Self::PerSpeed => "inverse speed",
            Self::Density => "density",
            Self::Viscosity => "viscosity",
            Self::Pressure => "pressure",
            Self::Force => "force",
            Self::Stiffness => "stiffness",
            Self::Damping => "damping",
            Self::HertzStiffness => "Hertz stiffness",
            Self::HertzDamping => "Hunt-Crossley damping",
        })
    }
}

/// Up to nine digits before the point are read at a glance.
const PLAIN: f64 = 1e9;

/// A number as people write it.
fn written(value: f64) -> String {
    if value.abs() < PLAIN { value.to_string() } else { format!("{value:e}") }
}

/// The end of the number at the start of `text`: an `e` belongs to it only when digits follow.
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

/// A quantity that could not be read: what was written, what was expected, and what to write
/// instead.
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
    TooLarge,
    NoUnit,
    UnknownUnit(String),
}

impl fmt::Display for UnitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { text, quantity, problem } = self;
        let names: Vec<&str> = quantity.units().iter().map(|&(name, _)| name).collect();
        let (known, si, a) = (names.join(", "), quantity.si(), quantity.article());
        match problem {
            Problem::NotANumber => {
                write!(f, "'{text}' is not {a} {quantity}: write a number and a unit, such as '1 {si}'")
            }
            Problem::NotFinite => write!(f, "'{text}' is not a finite {quantity}"),
            Problem::TooLarge => write!(
                f,
                "'{text}' is beyond the numbers that can be right: {a} {quantity} is at most {} {si} either way",
                written(quantity.largest())
            ),
            Problem::NoUnit => {
                write!(f, "'{text}' has no unit: give a unit of {quantity} ({known}), such as '{text} {si}'")
            }
            Problem::UnknownUnit(unit) => {
                write!(f, "'{unit}' in '{text}' is not a unit of {quantity}")?;
                if let Some(other) = Quantity::ALL.iter().find(|other| other.scale(unit).is_some()) {
                    write!(f, " but of {other}")?;
                }
                write!(f, ": use one of {known}")
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
            (Quantity::Mass, "45 g", 0.045),
            (Quantity::Angle, "180 deg", PI),
            (Quantity::AngularSpeed, "2 rev/s", 2.0 * TAU),
            (Quantity::AngularSpeed, "-60rpm", -TAU),
            (Quantity::Rate, "0.5 1/s", 0.5),
            (Quantity::Rate, "1/s", 1.0),
            (Quantity::Viscosity, "18 µPa s", 18e-6),
            (Quantity::Pressure, "210 GPa", 210e9),
            (Quantity::HertzStiffness, "2.5e9 N/m^(3/2)", 2.5e9),
        ] {
            let got = quantity.parse(text).unwrap();
            assert!((got - si).abs() <= 1e-15 * si.abs(), "{text}: {got}");
        }
    }

    #[test]
    fn every_quantity_has_an_si_unit_and_every_unit_one_meaning() {
        for quantity in Quantity::ALL {
            assert_eq!(quantity.units()[0].1, 1.0, "{quantity}");
            for (n, &(unit, scale)) in quantity.units().iter().enumerate() {
                assert!(scale > 0.0 && quantity.units()[..n].iter().all(|other| other.0 != unit), "{quantity}: {unit}");
                assert_eq!(quantity.parse(&format!("1 {unit}")), Ok(scale), "{quantity}: {unit}");
            }
        }
    }

    #[test]
    fn refusals_say_what_to_write() {
        for (text, part) in [
            ("", "not a length"),
            ("tall", "not a length"),
            ("1.2.3 m", "not a length"),
            ("1", "give a unit"),
            ("1 parsec", "'parsec' in '1 parsec' is not a unit of length: use"),
            ("1 s", "'s' in '1 s' is not a unit of length but of time: use one of m, cm"),
            ("NaN m", "not a length"),
            ("1e999 m", "not a finite length"),
            ("1e308 km", "not a finite length"),
            ("2e9 km", "a length is at most 1e12 m "),
        ] {
            let message = Quantity::Length.parse(text).unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
    }
}
