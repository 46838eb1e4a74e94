//! What speaks against trusting the readings of a table, and rebounds that follow from a time only
//! with gravity.

use std::borrow::Cow;
use std::fmt;

use serde::{Deserialize, Serialize};

use super::{Event, Reading, Table};

/// What speaks against trusting the readings, as far as the file tells.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Doubt {
    /// A title speaks of numbers that were not measured.
    Title {
        /// The title.
        text: String,
        /// Its line.
        line: u64,
    },
    /// A line speaks of heights and states a length that no reading takes in.
    Length {
        /// The line, as it stands.
        text: String,
        /// Its number.
        line: u64,
    },
    /// Nothing in the table says that something bounces, and the readings may be of anything.
    Unsaid {
        /// A column of the readings.
        column: String,
    },
    /// A heading, a title or a remark speaks of another motion than a bounce.
    Motion {
        /// What it says.
        text: String,
    },
    /// Releases and rebounds are in different units, and their numbers are those of one.
    Units {
        /// The column of the releases.
        drop: String,
        /// The column of the rebounds.
        rebound: String,
    },
    /// The COR follows from the time until the ball rests, and the last contacts are not those of a
    /// ball in flight.
    UntilRest,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Title { text, line } => {
                write!(f, "line {line} says '{text}': were the readings below it measured?")
            }
            Self::Length { text, line } => write!(
                f,
                "line {line} says '{text}', a length that no reading takes in: if the scale does not begin at the floor, state what it reads there \
                 (--zero); if the ball was dropped from there, --drop; else take the line out"
            ),
            Self::Unsaid { column } => write!(
                f,
                "nothing in the table says that something bounces, and '{column}' may be of anything: say so in a heading or in a line above it \
                 ('Ball dropped on wood'), or give the names by --header"
            ),
            Self::Motion { text } => {
                write!(f, "'{text}' speaks of another motion than a bounce: are the readings those of a ball that bounces?")
            }
            Self::Units { drop, rebound } => write!(
                f,
                "'{drop}' and '{rebound}' are in different units, and their numbers are those of a ball if the units are the same: is one of \
                 them wrong?"
            ),
            Self::UntilRest => f.write_str(
                "the COR follows from the time until the ball rests, as if it bounced ever smaller; its last contacts are no bounces, and rolling \
                 or ringing lengthens the time",
            ),
        }
    }
}

impl Table {
    /// The balls, surfaces or sheets of the table, each with a COR of its own; a single one,
    /// without a name, where nothing tells any apart.
    #[must_use]
    pub fn groups(&self) -> Vec<&str> {
        let mut found: Vec<&str> = Vec::new();
        for trial in &self.trials {
            if !found.contains(&trial.group.as_str()) {
                found.push(&trial.group);
            }
        }
        found
    }

    /// The trials of one group.
    pub(crate) fn of_group(&self, group: &str) -> Self {
        let trials = self.trials.iter().filter(|trial| trial.group == group).cloned().collect();
        Self { trials, ..self.clone() }
    }

    /// The table with the rebounds that follow from times where gravity is `g`; `sigma` is the
    /// error of a time that states none.
    ///
    /// The rebound after the only flight, of time T, is g T²/8. From release at h to rest a ball
    /// takes T = t (1 + e)/(1 - e) with the time of fall t = √(2h/g), so that e = (T - t)/(T + t),
    /// and it rebounds to e² h.
    pub(crate) fn at_gravity(&self, g: f64, sigma: f64) -> Cow<'_, Self> {
        if self.trials.iter().all(|trial| trial.timed.is_none()) {
            return Cow::Borrowed(self);
        }
        let mut table = self.clone();
        for trial in &mut table.trials {
            let Some(timed) = trial.timed.take() else { continue };
            let Some(drop) = trial.readings.iter().find(|r| r.event == Event::Release).and_then(|r| r.height) else {
                continue;
            };
            let (time, error) = (timed.time, timed.sigma.unwrap_or(sigma));
            let (height, slope) = if timed.until_rest {
                let fall = (2.0 * drop / g).sqrt();
                let e = ((time - fall) / (time + fall)).max(0.0);
                (e * e * drop, 2.0 * e * drop * 2.0 * fall / (time + fall).powi(2))
            } else {
                (g * time * time / 8.0, g * time / 4.0)
            };
            if !height.is_finite() {
                continue;
            }
            let sigma_height = Some(slope * error).filter(|s| *s > 0.0 && s.is_finite());
            let apex = Reading { height: Some(height), sigma_height, ..Reading::new(Event::Apex, 1, timed.line) };
            trial.readings.push(apex);
            let doubt = Doubt::UntilRest;
            if timed.until_rest && !table.doubts.contains(&doubt) {
                table.doubts.push(doubt);
            }
        }
        table.notes.push(format!("rebounds follow from their times, with g = {g} m/s²"));
        Cow::Owned(table)
    }
}
