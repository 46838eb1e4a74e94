//! Departures of what is shown from the motion of the scene.

use std::fmt;

/// A departure of what is shown from the motion of the scene; lengths in m.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Departure {
    /// A single hop is shown, as a loop.
    Loop {
        /// The number of the hop, counted from 1.
        hop: u32,
    },
    /// Hops shorter than a frame are left out.
    Cut {
        /// The greatest height of such a hop, in m.
        height: f64,
        /// The greatest difference of heights from the run, in m: the ball lies where it would hop,
        /// or a floor would carry it.
        off: f64,
    },
    /// Contacts are moved to whole frames and gravity is kept: tops move.
    SnappedByGravity {
        /// The largest change of a top, in m.
        tops: f64,
    },
    /// Contacts are moved to whole frames and heights are kept: the end moves.
    SnappedByHeights {
        /// The change of the end, in s.
        end: f64,
    },
    /// The ball is squashed.
    Squashed {
        /// The least height of the ball, as a part of its own.
        to: f64,
        /// The squash as a multiple of that by the contact's law; `None` where no law gives one.
        of_law: Option<f64>,
    },
    /// The ball is stretched by hand.
    Stretched {
        /// The greatest length of the ball, as a multiple of its own.
        to: f64,
    },
    /// Contacts are shorter than a frame, so that their squash may fall between frames.
    Short {
        /// The number of such contacts.
        contacts: usize,
    },
    /// Contacts are held.
    Held {
        /// The number of frames, or of drawings.
        count: u32,
        /// Whether `count` counts drawings, each of two frames.
        drawings: bool,
        /// The delay of the end, in s.
        later: f64,
    },
    /// A floor moves, and is drawn where it is at the start.
    StillFloor,
    /// A loop begins anew.
    Again {
        /// The frame after the last of the loop.
        last: f64,
        /// The first frame of the loop, which it equals.
        first: i32,
    },
}

impl fmt::Display for Departure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Loop { hop } => write!(f, "hop {hop} alone, as a loop"),
            Self::Cut { height, off } if height < off && *height < NOTHING => {
                write!(f, "contacts shorter than a frame left out")
            }
            Self::Cut { height, .. } => write!(f, "hops of up to {} left out", at_most(*height)),
            Self::SnappedByGravity { tops } => {
                write!(f, "snapped by gravity, tops moved by up to {}", at_most(*tops))?;
                // A top that was asked for is lost, and there is a way to keep it.
                if *tops >= 1e-4 { write!(f, " (--snap heights keeps them)") } else { Ok(()) }
            }
            Self::SnappedByHeights { end } => write!(f, "snapped by heights, the end moved by {end:.4} s"),
            Self::Squashed { to, of_law: None } => write!(f, "squashed to {to:.2} of its height by hand"),
            Self::Squashed { to, of_law: Some(1.0) } => {
                write!(f, "squashed to {to:.2} of its height as the contact's law has it")
            }
            Self::Squashed { to, of_law: Some(times) } => {
                write!(f, "squashed to {to:.2} of its height, {times:.3} times as far as the contact's law has it")
            }
            Self::Stretched { to } => write!(f, "stretched to {to:.2} of its length by hand"),
            Self::Short { contacts } => {
                write!(f, "{contacts} contacts are shorter than a frame, and --hold makes them longer")
            }
            Self::Held { count, drawings, later } => {
                let what = if *drawings { "drawings" } else { "frames" };
                write!(f, "contacts held for {count} {what}, the end {later:.4} s later")
            }
            Self::StillFloor => write!(f, "the floor moves, and is drawn where it is at the start"),
            Self::Again { last, first } => write!(f, "frame {last} is frame {first} again"),
        }
    }
}

/// The greatest length that is shown as none, in m: a millionth of a millimetre.
const NOTHING: f64 = 1e-9;
/// The rounding of a number with few digits, as a part of it: 2.1 mm may be computed as slightly
/// more, and is not 2.11 mm for that.
const HAIR: f64 = 1e-9;

/// A number from above, with so many digits behind the point.
#[must_use]
pub fn rounded_up(number: f64, digits: usize) -> String {
    #[allow(clippy::cast_possible_truncation, clippy::cast_possible_wrap)] // a few digits
    let unit = 10_f64.powi(digits as i32);
    format!("{:.digits$}", (number * unit * (1.0 - HAIR)).ceil() / unit)
}

/// A length as [`length`] shows it, from above: what is bounded by one is bounded by the other.
///
/// ```
/// assert_eq!(saltus_scene::at_most(2.1213e-3), "2.13 mm");
/// assert_eq!(saltus_scene::length(2.1213e-3), "2.12 mm");
/// ```
#[must_use]
pub fn at_most(metres: f64) -> String {
    let tiny = |mm: f64| {
        let unit = 10_f64.powf(mm.log10().floor() - 1.0);
        format!("{:.1e}", (mm / unit * (1.0 - HAIR)).ceil() * unit)
    };
    in_units(metres, tiny, rounded_up)
}

/// A length in a unit of its size, such as "2.12 mm".
#[must_use]
pub fn length(metres: f64) -> String {
    in_units(metres, |mm| format!("{mm:.1e}"), |number, digits| format!("{number:.digits$}"))
}

/// A length in a unit of its size: so many digits of a number, or a `tiny` one with its power of
/// ten.
fn in_units(metres: f64, tiny: impl Fn(f64) -> String, number: impl Fn(f64, usize) -> String) -> String {
    match metres {
        m if m < NOTHING => "0 mm".to_owned(),
        m if m < 1e-5 => format!("{} mm", tiny(m * 1e3)),
        m if m < 0.01 => format!("{} mm", number(m * 1e3, 2)),
        m if m < 1.0 => format!("{} cm", number(m * 1e2, 1)),
        m => format!("{} m", number(m, 2)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A figure of the line is a bound, and hardly above what it stands for.
    #[test]
    fn what_is_rounded_up_is_no_less() {
        assert_eq!(at_most(0.0), "0 mm");
        assert_eq!(
            (at_most(1e-4), at_most(2.13e-3), at_most(0.21)),
            ("0.10 mm".into(), "2.13 mm".into(), "21.0 cm".into())
        );
        assert_eq!(
            (at_most(1.0001e-4), at_most(1.2301), at_most(2.11e-7)),
            ("0.11 mm".into(), "1.24 m".into(), "2.2e-4 mm".into())
        );
        for k in 0..4000 {
            let m = 1e-9 * 1.0077_f64.powi(k);
            let text = at_most(m);
            let (number, unit) = text.split_once(' ').unwrap();
            let unit = match unit {
                "mm" => 1e-3,
                "cm" => 1e-2,
                _ => 1.0,
            };
            let said = number.parse::<f64>().unwrap() * unit;
            assert!(said >= m * (1.0 - 2.0 * HAIR) && said <= 1.11 * m + 1e-5, "{text} for {m}");
        }
    }
}
