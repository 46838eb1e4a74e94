//! The reference values of the hard cases, computed with sixty digits, each with the tolerance that double precision must meet.

use serde::Deserialize;

/// A case of `hardcases.json`: its parameters and what is to be observed.
#[derive(Debug, Deserialize)]
pub struct Case {
    id: String,
    params: serde_json::Map<String, serde_json::Value>,
    observables: Vec<Observable>,
}

#[derive(Debug, Deserialize)]
struct Observable {
    name: String,
    kind: String,
    #[serde(default)]
    value: Option<String>,
    #[serde(default)]
    tol_rel: Option<f64>,
    #[serde(default)]
    tol_abs: Option<f64>,
}

impl Case {
    /// The case of this name.
    ///
    /// # Panics
    /// If there is none.
    #[must_use]
    #[allow(clippy::panic, clippy::expect_used)] // a test's own data
    pub fn named(id: &str) -> Self {
        let all: Vec<Self> =
            serde_json::from_str(include_str!("../hardcases.json")).expect("the file of cases is JSON");
        all.into_iter().find(|case| case.id == id).unwrap_or_else(|| panic!("no case named {id}"))
    }

    /// The binary64 number nearest to the parameter's literal.
    ///
    /// # Panics
    /// If there is none of this name.
    #[must_use]
    #[allow(clippy::panic)]
    pub fn param(&self, name: &str) -> f64 {
        let text = self.params.get(name).and_then(serde_json::Value::as_str);
        text.and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("{}: no parameter {name}", self.id))
    }

    /// Checks an observation against the reference, at the case's own tolerance.
    ///
    /// # Panics
    /// If it is off by more, or if the case has no such observable.
    #[allow(clippy::panic, clippy::expect_used)]
    pub fn check(&self, name: &str, got: f64) {
        let Some(observable) = self.observables.iter().find(|o| o.name == name) else {
            panic!("{}: nothing to observe named {name}", self.id)
        };
        let text = observable.value.as_deref().unwrap_or_default();
        let reference: f64 = text.parse().unwrap_or_else(|_| panic!("{} {name}: '{text}' is not a number", self.id));
        let allowed = match (observable.kind.as_str(), observable.tol_abs, observable.tol_rel) {
            ("count", ..) => 0.0,
            (_, absolute, relative) => absolute.unwrap_or(0.0) + relative.unwrap_or(0.0) * reference.abs(),
        };
        let error = (got - reference).abs();
        assert!(
            error <= allowed,
            "{} {name}: got {got:e}, reference {text}, off by {error:e}, allowed {allowed:e}",
            self.id
        );
    }
}
