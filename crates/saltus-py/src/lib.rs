//! The compiled part of the Python package `saltus`: what `python/saltus` wraps for people.

mod fail;
mod fit;
mod hybrid;
mod scene;
mod signal;
mod sweep;

use pyo3::prelude::*;

/// What `python/saltus` is made of; its functions are documented there.
#[pymodule(name = "_core", gil_used = false)]
mod core {
    #[pymodule_export]
    use super::fail::{RunError, SaltusError, SceneError, TableError};
    #[pymodule_export]
    use super::fit::{Report, fit, quantity};
    #[pymodule_export]
    use super::hybrid::{Hybrid, Run, Tape};
    #[pymodule_export]
    use super::scene::{Motion, accuracy, explain, simulate, solve};
    #[pymodule_export]
    use super::sweep::{sweep_difference, sweep_identity, sweep_pace, sweep_part, sweep_parts, sweep_rows};

    use pyo3::prelude::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("SWEEP_PLAN", saltus_scene::sweep::PLAN)?;
        module.add("SWEEP_KEY", saltus_scene::sweep::KEY)?;
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
