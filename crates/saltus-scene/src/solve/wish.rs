//! A wish: what is to happen in a scene, and how a run is measured against it.

use saltus_bounce::units::Quantity;

use crate::Error;
use crate::plan::Record;

/// The relation of frames to times.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Frames per second.
    pub fps: f64,
    /// The number of the frame at which the motion starts.
    pub first: i32,
}

/// The quantity that a wish is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum What {
    /// The time of contact `n`, counted from 1.
    Touch(usize),
    /// The place of contact `n`, sideways.
    Place(usize),
    /// The height of apex `n`; 1 is the top before the first contact.
    Height(usize),
    /// The time of apex `n`.
    Top(usize),
    /// The time from contact `n` to the next.
    Hop(usize),
    /// The time from which everything is at rest.
    Rest,
}

impl What {
    /// Whether it is a length; else it is a time.
    #[must_use]
    pub const fn is_length(self) -> bool {
        matches!(self, Self::Place(_) | Self::Height(_))
    }
}

/// A wish, and how far off matters.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Wish {
    /// The text of the wish.
    pub text: String,
    /// The quantity.
    pub what: What,
    /// The wanted value, in s or m.
    pub asked: f64,
    /// The error that is allowed, in s or m.
    pub within: f64,
}

/// The most contacts that can be asked for.
const MOST: usize = 1000;

impl Wish {
    /// Reads a wish such as `touch 1 at frame 24`, `apex 2 at 60cm within 1cm`,
    /// `hop 1 for 12 frames` or `rest at 3s`.
    ///
    /// # Errors
    /// [`Error`] that says what a wish looks like.
    pub fn parse(text: &str, clock: Clock) -> Result<Self, Error> {
        Self::read(text, clock).map_err(Error::new)
    }

    fn read(text: &str, clock: Clock) -> Result<Self, String> {
        let fail = |says: &str| Err(format!("'{text}': {says}"));
        let words: Vec<&str> = text.split_whitespace().collect();
        let Some((&kind, mut rest)) = words.split_first() else {
            return fail("say what is to happen, such as 'touch 1 at frame 24'");
        };
        let mut number = 1;
        if matches!(kind, "touch" | "apex" | "hop") {
            match rest.split_first().map(|(word, rest)| (word.parse::<usize>(), rest)) {
                Some((Ok(n @ 1..=MOST), after)) => (number, rest) = (n, after),
                Some((Ok(_), _)) => return fail(&format!("they are counted from 1 to {MOST}")),
                _ => return fail(&format!("say which, such as '{kind} 1'")),
            }
        } else if kind != "rest" {
            return fail("a wish begins with touch, apex, hop or rest");
        }
        if let Some((&("at" | "for" | "is" | "takes" | "lasts" | "="), after)) = rest.split_first() {
            rest = after;
        }
        let (value, within) = match rest.iter().position(|word| *word == "within") {
            Some(at) => (&rest[..at], Some(&rest[at + 1..])),
            None => (rest, None),
        };
        let is_span = kind == "hop";
        let asked = Amount::parse(value, clock, is_span).map_err(|says| format!("'{text}': {says}"))?;
        let what = match (kind, asked) {
            ("touch", Amount::Time(_)) => What::Touch(number),
            ("touch", Amount::Length(_)) => What::Place(number),
            ("apex", Amount::Length(_)) => What::Height(number),
            ("apex", Amount::Time(_)) => What::Top(number),
            ("hop", Amount::Time(_)) => What::Hop(number),
            ("rest", Amount::Time(_)) => What::Rest,
            ("hop", _) => return fail("a hop takes a time, such as '12 frames' or '0.5s'"),
            _ => return fail("the ball comes to rest at a time, such as 'frame 60' or '3s'"),
        };
        let within = match within.map(|words| Amount::parse(words, clock, true)).transpose() {
            Err(says) => return fail(&says),
            Ok(None) => {
                if what.is_length() {
                    0.01
                } else {
                    0.5 / clock.fps
                }
            }
            Ok(Some(Amount::Length(within))) if what.is_length() && within > 0.0 => within,
            Ok(Some(Amount::Time(within))) if !what.is_length() && within > 0.0 => within,
            Ok(Some(_)) => {
                return fail("'within' wants an amount above zero of what is asked for, such as 'within 1cm'");
            }
        };
        let (Amount::Time(asked) | Amount::Length(asked)) = asked;
        if !what.is_length() && asked < 0.0 {
            return fail("that is before the motion starts");
        }
        Ok(Self { text: text.trim().to_owned(), what, asked, within })
    }

    /// The value of the quantity in a run; `None` where it does not come to that.
    pub(super) fn measured(&self, record: &Record) -> Option<f64> {
        let impacts = record.impacts();
        let touch = |n: usize| impacts.iter().filter(|impact| impact.ball == 0).nth(n - 1).map(|impact| impact.t);
        let apex = |n: usize| -> Option<(f64, f64)> {
            let first = touch(1).unwrap_or(f64::INFINITY);
            let tops = record.apexes(0);
            // A drop, and a throw downwards, have their top where they start.
            let starts = usize::from(tops.first().is_none_or(|top| top.t > first));
            if starts == 1 && n == 1 {
                return Some((0.0, record.at(0, 0.0)?.height()));
            }
            tops.get(n - 1 - starts).map(|top| (top.t, top.height))
        };
        match self.what {
            What::Touch(n) => touch(n),
            What::Place(n) => Some(record.at(0, touch(n)?)?.position.x),
            What::Height(n) => apex(n).map(|(_, height)| height),
            What::Top(n) => apex(n).map(|(t, _)| t),
            What::Hop(n) => Some(touch(n + 1)? - touch(n)?),
            What::Rest => record.rest(),
        }
    }

    /// The number of contacts that a run must have to show it; `None` if it must go on to its end.
    pub(super) const fn contacts(&self) -> Option<usize> {
        match self.what {
            What::Touch(n) | What::Place(n) | What::Height(n) | What::Top(n) => Some(n),
            What::Hop(n) => Some(n + 1),
            What::Rest => None,
        }
    }
}

/// A value of a wish, in s or m.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Amount {
    Time(f64),
    Length(f64),
}

impl Amount {
    /// `frame 24`, or, of a span, `24 frames`; or a number with a unit.
    fn parse(words: &[&str], clock: Clock, is_span: bool) -> Result<Self, String> {
        let count = |text: &str| {
            let count: Option<f64> = text.parse().ok();
            count.filter(|count| count.is_finite()).ok_or_else(|| format!("'{text}' is no number of frames"))
        };
        match words {
            [] => Err("say when or where, such as 'at frame 24' or 'at 60cm'".to_owned()),
            ["frame", number] if !is_span => Ok(Self::Time((count(number)? - f64::from(clock.first)) / clock.fps)),
            [number, "frame" | "frames"] if is_span => Ok(Self::Time(count(number)? / clock.fps)),
            ["frame", _] => Err("say how many frames, such as '12 frames'".to_owned()),
            [_, "frame" | "frames"] => Err("say which frame, such as 'at frame 24'".to_owned()),
            words => {
                let text = words.concat();
                // A zero is read without a unit, and would be both.
                let has_unit = text.ends_with(char::is_alphabetic);
                match (Quantity::Time.parse(&text), Quantity::Length.parse(&text)) {
                    (Ok(time), _) if has_unit => Ok(Self::Time(time)),
                    (_, Ok(length)) if has_unit => Ok(Self::Length(length)),
                    _ => Err(format!("'{text}' is no frame, time or height: write 'frame 24', '1.2s' or '60cm'")),
                }
            }
        }
    }
}
