//! When a run ends, how it is stepped, and what is drawn of it.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::error::Fault;
use super::value::{At, Measure, Number, Time};

/// The end of a run, and the accuracy of its steps.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Run {
    /// The time of the end, in s; `None`: as soon as everything is at rest.
    pub until: Option<f64>,
    /// The relative tolerance of steps, where any are taken.
    pub tolerance: Option<f64>,
    /// The number of jumps after which a run ends.
    pub most_jumps: Option<u32>,
    /// The stepper to use instead of the one the plan would choose.
    pub stepper: Option<Stepper>,
}

impl Run {
    /// Whether these settings have what a scene file has under this key.
    pub(super) fn gives(&self, key: &str) -> bool {
        match key {
            "run.until" => self.until.is_some(),
            "run.tolerance" => self.tolerance.is_some(),
            "run.most_jumps" => self.most_jumps.is_some(),
            "run.stepper" => self.stepper.is_some(),
            _ => false,
        }
    }

    /// These settings, and those of `other` where these say nothing.
    pub(super) fn or(self, other: Self) -> Self {
        Self {
            until: self.until.or(other.until),
            tolerance: self.tolerance.or(other.tolerance),
            most_jumps: self.most_jumps.or(other.most_jumps),
            stepper: self.stepper.or(other.stepper),
        }
    }
}

/// A way to step through a flow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(test, schemars(inline))]
pub enum Stepper {
    /// Tsitouras 5(4).
    Tsit5,
    /// Dormand and Prince 8(5,3).
    Dop853,
    /// Rosenbrock, for stiff contact.
    Rodas5p,
    /// Taylor series in flights sideways, of an order that the tolerance asks for; else what the
    /// plan would choose.
    Series,
}

impl Stepper {
    /// The name of the method in the literature.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tsit5 => "Tsit5",
            Self::Dop853 => "Dop853",
            Self::Rodas5p => "Rodas5P",
            Self::Series => "series",
        }
    }

    /// The one for the tightest tolerances where this one would do.
    pub(super) const fn exact(self) -> Self {
        match self {
            Self::Tsit5 | Self::Dop853 | Self::Series => Self::Dop853,
            Self::Rodas5p => Self::Rodas5p,
        }
    }
}

/// The pictures of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Picture {
    /// The title; `None` for one made from the scene.
    pub title: Option<String>,
    /// The kind of picture.
    pub kind: Kind,
}

/// The kinds of pictures.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(test, schemars(inline))]
pub enum Kind {
    /// Height against time.
    #[default]
    Height,
    /// Velocity against time.
    Velocity,
    /// Energies against time.
    Energy,
    /// Velocity against height.
    Phase,
    /// The path in space.
    Path,
    /// Apex heights, bounce by bounce.
    Ladder,
    /// Force against deformation.
    Hysteresis,
    /// The ball at equal times.
    Ghost,
}

impl Kind {
    /// Every one.
    pub const ALL: [Self; 8] = [
        Self::Height,
        Self::Velocity,
        Self::Energy,
        Self::Phase,
        Self::Path,
        Self::Ladder,
        Self::Hysteresis,
        Self::Ghost,
    ];

    /// The name of the kind of picture.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Height => "height",
            Self::Velocity => "velocity",
            Self::Energy => "energy",
            Self::Phase => "phase",
            Self::Path => "path",
            Self::Ladder => "ladder",
            Self::Hysteresis => "hysteresis",
            Self::Ghost => "ghost",
        }
    }

    /// A sentence about the picture.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Height => "Height against time",
            Self::Velocity => "Velocity against time",
            Self::Energy => "Energies against time",
            Self::Phase => "Velocity against height",
            Self::Path => "The path in space",
            Self::Ladder => "Apex heights, bounce by bounce",
            Self::Hysteresis => "Force against deformation, of a contact that takes time",
            Self::Ghost => "The ball at equal times",
        }
    }
}

/// How long and how precisely to run.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "run"))]
pub(super) struct RunTable {
    /// When to stop; when everything has come to rest unless given.
    until: Option<At<Measure<Time>>>,
    /// The relative tolerance of steps, where any are taken; what the plan chooses unless given.
    tolerance: Option<At<Number>>,
    /// After how many jumps to stop; 10000 unless given.
    most_jumps: Option<At<u32>>,
    /// The stepper; what the plan chooses unless given.
    stepper: Option<Stepper>,
}

/// What is drawn.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "picture"))]
pub(super) struct PictureTable {
    /// The title; made from the scene unless given.
    title: Option<String>,
    /// What is drawn: "height" against time unless given.
    kind: Option<Kind>,
}

impl RunTable {
    pub(super) fn read(&self) -> Result<Run, Fault> {
        let until = self.until.as_ref().map(|at| at.positive("a time to stop at in s")).transpose()?;
        let tolerance = match &self.tolerance {
            Some(at) if !(1e-15..=0.1).contains(&super::value::Real::real(at.get())) => {
                let says = "is not a relative tolerance: give a number from 1e-15 to 0.1";
                return Err(at.fault(format!("{} {says}", super::value::Real::real(at.get()))));
            }
            Some(at) => Some(at.real()),
            None => None,
        };
        let most_jumps = match &self.most_jumps {
            Some(at) if *at.get() == 0 => return Err(at.fault("no jump is allowed: give a number of jumps above zero")),
            Some(at) => Some(*at.get()),
            None => None,
        };
        Ok(Run { until, tolerance, most_jumps, stepper: self.stepper })
    }
}

impl PictureTable {
    pub(super) fn read(&self) -> Picture {
        Picture { title: self.title.clone(), kind: self.kind.unwrap_or_default() }
    }
}
