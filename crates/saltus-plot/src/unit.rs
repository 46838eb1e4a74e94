//! Units on the axes: metres and seconds go in, whatever reads best comes out.

/// The unit of the height axis. Data are always given in metres.
///
/// # Example
///
/// ```
/// use saltus_plot::{HeightTime, HeightUnit, Stroke};
///
/// let drop = Stroke::over_time(0.0, 0.45, vec![1.0, 0.0, -4.9]);
/// let picture = HeightTime::new("A drop").motion("free fall", [drop]);
/// assert!(picture.clone().svg()?.contains("Height (cm)"));
/// assert!(picture.height_unit(HeightUnit::Metres).svg()?.contains("Height (m)"));
/// # Ok::<(), saltus_plot::PlotError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum HeightUnit {
    /// km
    Kilometres,
    /// m
    Metres,
    /// cm
    Centimetres,
    /// mm
    Millimetres,
    /// µm
    Micrometres,
    /// nm
    Nanometres,
    /// Pixels of a picture: heights are given in them, not in metres.
    Pixels,
}

impl HeightUnit {
    /// The symbol, for example `"cm"`.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Kilometres => "km",
            Self::Metres => "m",
            Self::Centimetres => "cm",
            Self::Millimetres => "mm",
            Self::Micrometres => "µm",
            Self::Nanometres => "nm",
            Self::Pixels => "px",
        }
    }

    /// The length of the unit in m; of pixels, one.
    #[must_use]
    pub fn metres(self) -> f64 {
        match self {
            Self::Kilometres => 1e3,
            Self::Metres | Self::Pixels => 1.0,
            Self::Centimetres => 1e-2,
            Self::Millimetres => 1e-3,
            Self::Micrometres => 1e-6,
            Self::Nanometres => 1e-9,
        }
    }

    /// The unit in which heights up to `largest` metres read best: centimetres up to 2.5 m, as in a
    /// school laboratory.
    fn fitting(largest: f64) -> Self {
        match largest {
            l if l >= 5e3 => Self::Kilometres,
            l if l > 2.5 => Self::Metres,
            l if l >= 1e-2 || l == 0.0 => Self::Centimetres,
            l if l >= 1e-3 => Self::Millimetres,
            l if l >= 1e-6 => Self::Micrometres,
            _ => Self::Nanometres,
        }
    }
}

/// Units that prefixes go with.
const PLAIN: [&str; 16] = ["m", "A", "V", "W", "J", "N", "Pa", "Hz", "C", "F", "H", "S", "T", "Wb", "Ω", "J/kg"];
/// Numbers that need no prefix: 0.3 A and 1500 V are read as they are.
const READABLE: std::ops::Range<f64> = 0.1..1e4;

/// A unit as an axis shows it: how large it is in metres or seconds, and what is written in the
/// brackets.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Unit {
    pub(crate) size: f64,
    pub(crate) label: String,
}

impl Unit {
    pub(crate) fn of_height(chosen: Option<HeightUnit>, largest: f64, span: f64) -> Self {
        let unit = chosen.unwrap_or_else(|| HeightUnit::fitting(largest));
        Self::scaled(unit.symbol(), unit.metres(), largest, span)
    }

    pub(crate) fn of_time(largest: f64, span: f64) -> Self {
        match largest {
            l if l >= 0.2 || l == 0.0 => Self::scaled("s", 1.0, largest, span),
            l if l >= 2e-4 => Self::scaled("ms", 1e-3, largest, span),
            l if l >= 2e-7 => Self::scaled("µs", 1e-6, largest, span),
            _ => Self::scaled("ns", 1e-9, largest, span),
        }
    }

    /// A unit by name: one of the SI gets a prefix where its numbers would be long; any other stays
    /// as it is.
    pub(crate) fn named(name: &str, largest: f64, span: f64) -> Self {
        if name == "s" {
            Self::of_time(largest, span)
        } else if PLAIN.contains(&name) && !READABLE.contains(&largest) {
            Self::prefixed(name, largest, span)
        } else {
            Self::scaled(name, 1.0, largest, span)
        }
    }

    /// The unit with the prefix that reads best.
    pub(crate) fn prefixed(symbol: &str, largest: f64, span: f64) -> Self {
        let prefixes =
            [("G", 1e9), ("M", 1e6), ("k", 1e3), ("", 1.0), ("m", 1e-3), ("µ", 1e-6), ("n", 1e-9), ("p", 1e-12)];
        let fits = |&(_, size): &(&str, f64)| largest == 0.0 || largest >= 2.0 * size;
        let (prefix, size) =
            prefixes.into_iter().filter(|p| largest != 0.0 || p.1 == 1.0).find(fits).unwrap_or(("p", 1e-12));
        Self::scaled(&format!("{prefix}{symbol}"), size, largest, span)
    }

    /// Values beyond 10⁵ or below 10⁻² of the unit are written as so many powers of ten of it,
    /// unless the axis shows only a short stretch far from zero: there the whole number says more.
    pub(crate) fn scaled(symbol: &str, size: f64, largest: f64, span: f64) -> Self {
        let ratio = largest / size;
        let most = if span < 0.1 * largest { 1e9 } else { 1e5 };
        if ratio == 0.0 || !ratio.is_finite() || (1e-2..most).contains(&ratio) {
            return Self { size, label: symbol.to_owned() };
        }
        let power = (ratio.log10() / 3.0).floor() as i32 * 3;
        let label = format!("10{} {symbol}", superscript(power)).trim_end().to_owned();
        Self { size: size * 10f64.powi(power), label }
    }
}

/// A whole number as an exponent.
pub(crate) fn superscript(power: i32) -> String {
    power
        .to_string()
        .chars()
        .map(|c| match c {
            '-' => '⁻',
            '0' => '⁰',
            '1' => '¹',
            '2' => '²',
            '3' => '³',
            '4' => '⁴',
            '5' => '⁵',
            '6' => '⁶',
            '7' => '⁷',
            '8' => '⁸',
            _ => '⁹',
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_study_reads_in_centimetres_and_seconds() {
        assert_eq!(Unit::of_height(None, 1.0, 1.0).label, "cm");
        assert_eq!(Unit::of_time(1.11, 1.11).label, "s");
    }

    #[test]
    fn units_by_name_take_prefixes_where_numbers_would_be_long() {
        let label = |name: &str, largest: f64| Unit::named(name, largest, largest).label;
        for (name, largest, expected) in [
            ("V", 12.0, "V"),
            ("V", 0.3, "V"),
            ("V", 0.03, "mV"),
            ("Pa", 101_325.0, "kPa"),
            ("F", 3e-12, "pF"),
            ("mA", 0.03, "mA"),
            ("bar", 200.0, "bar"),
            ("1/min", 3000.0, "1/min"),
            ("rad", 0.05, "rad"),
            ("N", 0.0, "N"),
            ("widgets", 3e6, "10⁶ widgets"),
        ] {
            assert_eq!(label(name, largest), expected, "{largest} {name}");
        }
    }

    #[test]
    fn far_scales_are_written_as_powers_of_ten() {
        assert_eq!(Unit::of_time(1.0e6 + 1.0, 1.0).label, "s");
        assert_eq!(Unit::of_time(3.0e8, 3.0e8).label, "10⁶ s");
        assert_eq!(Unit::of_height(None, 5.0e-9, 5.0e-9).label, "nm");
        assert_eq!(Unit::of_height(None, 5.0e-13, 5.0e-13).label, "10⁻⁶ nm");
        assert_eq!(Unit::of_height(Some(HeightUnit::Metres), 2.0e-9, 2.0e-9).label, "10⁻⁹ m");
    }
}
