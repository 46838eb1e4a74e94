//! What is shown and is not the motion of the scene.

use std::fmt;

/// How what is shown departs from the motion of the scene; lengths in m.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Departure {
    /// One hop alone, as a loop.
    Loop {
        /// Counted from 1.
        hop: u32,
    },
    /// Hops shorter than a frame are left out.
    Cut {
        /// How high they are in m, at most.
        height: f64,
        /// How far heights are from the run for it, in m, at most: the ball lies where it would
        /// hop, or a floor would carry it.
        off: f64,
    },
    /// Contacts are on whole frames and gravity is kept: tops move.
    SnappedByGravity {
        /// By this much in m, at most.
        tops: f64,
    },
    /// Contacts are on whole frames and heights are kept: the end moves.
    SnappedByHeights {
        /// By this much in s.
        end: f64,
    },
    /// The ball is squashed.
    Squashed {
        /// To this part of its height.
        to: f64,
        /// How many times as far as the contact's law has it; `None` where no law says how far.
        of_law: Option<f64>,
    },
    /// The ball is stretched by hand.
    Stretched {
        /// To this part of its length.
        to: f64,
    },
    /// Contacts are shorter than a frame, so that their squash may not be seen.
    Short {
        /// How many.
        contacts: usize,
    },
    /// Contacts are held.
    Held {
        /// For so many.
        count: u32,
        /// Drawings, each of two frames, instead of frames.
        drawings: bool,
        /// By how much the end is later, in s.
        later: f64,
    },
    /// A loop begins anew.
    Again {
        /// At this frame.
        last: f64,
        /// Which is this one.
        first: i32,
    },
}

impl fmt::Display for Departure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Loop { hop } => write!(f, "hop {hop} alone, as a loop"),
            Self::Cut { height, off } if height < off && length(*height) == length(0.0) => {
                write!(f, "contacts shorter than a frame left out")
            }
            Self::Cut { height, .. } => write!(f, "hops of up to {} left out", length(*height)),
            Self::SnappedByGravity { tops } => {
                write!(f, "snapped by gravity, tops moved by up to {}", length(*tops))?;
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
            Self::Again { last, first } => write!(f, "frame {last} is frame {first} again"),
        }
    }
}

/// A length that a person can picture.
#[must_use]
pub fn length(metres: f64) -> String {
    match metres {
        m if m < 1e-9 => "0 mm".to_owned(),
        m if m < 1e-5 => format!("{:.1e} mm", m * 1e3),
        m if m < 0.01 => format!("{:.2} mm", m * 1e3),
        m if m < 1.0 => format!("{:.1} cm", m * 1e2),
        m => format!("{m:.2} m"),
    }
}
