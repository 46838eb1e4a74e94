//! The reference values of the hard cases, computed with sixty digits, each with the tolerance that
//! double precision must meet.

use std::sync::OnceLock;

use serde::Deserialize;
use serde_json::{Map, Value};

/// A case of `hardcases.json`: what it is, its parameters, and what is to be observed.
#[derive(Debug, Deserialize)]
#[non_exhaustive]
pub struct Case {
    /// Its name, in small letters and digits.
    pub id: String,
    /// The family it belongs to.
    pub family: String,
    /// What it is, in a few words.
    pub title: String,
    /// The equations, guards and resets.
    pub system: String,
    /// Until when, as written; none where that is no matter.
    #[serde(default)]
    pub t_end: Option<String>,
    /// What goes wrong in codes that are not made for it.
    pub naive_failures: String,
    /// What is to be observed.
    pub observables: Vec<Observable>,
    params: Map<String, Value>,
}

/// How an observation is judged.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// Within a tolerance.
    Real,
    /// Exactly.
    Count,
    /// One of several outcomes.
    Policy,
    /// Not at all.
    Info,
}

/// Something to observe in a case, and the right answer.
#[derive(Debug, Deserialize)]
#[non_exhaustive]
pub struct Observable {
    /// Its name, unique within the case.
    pub name: String,
    /// How it is judged.
    pub kind: Kind,
    /// The right answer, with all its digits.
    pub value: String,
    /// The outcomes that are right where there are several.
    #[serde(default)]
    pub accept: Vec<String>,
    #[serde(default)]
    tol_rel: Option<f64>,
    #[serde(default)]
    tol_abs: Option<f64>,
}

impl Case {
    /// All cases, in the order of the file.
    ///
    /// # Panics
    /// If the file is not what it should be.
    #[must_use]
    #[allow(clippy::expect_used)] // a test's own data
    pub fn all() -> &'static [Self] {
        static ALL: OnceLock<Vec<Case>> = OnceLock::new();
        ALL.get_or_init(|| serde_json::from_str(include_str!("../hardcases.json")).expect("the file of cases is JSON"))
    }

    /// The case of this name.
    ///
    /// # Panics
    /// If there is none.
    #[must_use]
    #[allow(clippy::panic)]
    pub fn named(id: &str) -> &'static Self {
        Self::all().iter().find(|case| case.id == id).unwrap_or_else(|| panic!("no case named {id}"))
    }

    /// The parameters as written, in order of their names.
    pub fn params(&self) -> impl Iterator<Item = (&str, String)> {
        self.params.iter().map(|(name, value)| {
            let text = value.as_str().map_or_else(|| value.to_string(), ToOwned::to_owned);
            (name.as_str(), text)
        })
    }

    /// The binary64 number nearest to the parameter's literal.
    ///
    /// # Panics
    /// If there is none of this name.
    #[must_use]
    #[allow(clippy::panic)]
    pub fn param(&self, name: &str) -> f64 {
        let value = self.params().find(|param| param.0 == name);
        value.and_then(|(_, text)| text.parse().ok()).unwrap_or_else(|| panic!("{}: no parameter {name}", self.id))
    }

    /// What is observed under this name.
    ///
    /// # Panics
    /// If there is nothing of this name.
    #[must_use]
    #[allow(clippy::panic)]
    pub fn observable(&self, name: &str) -> &Observable {
        let found = self.observables.iter().find(|observable| observable.name == name);
        found.unwrap_or_else(|| panic!("{}: nothing to observe named {name}", self.id))
    }
}

impl Observable {
    /// The reference as a number.
    ///
    /// # Panics
    /// If it is a word.
    #[must_use]
    #[allow(clippy::panic)]
    pub fn reference(&self) -> f64 {
        self.value.parse().unwrap_or_else(|_| panic!("{}: '{}' is not a number", self.name, self.value))
    }

    /// How far from the reference an observation may be, in its unit.
    #[must_use]
    pub fn allowed(&self) -> f64 {
        if self.kind == Kind::Count {
            return 0.0;
        }
        self.tol_abs.unwrap_or(0.0) + self.tol_rel.map_or(0.0, |relative| relative * self.reference().abs())
    }
}
