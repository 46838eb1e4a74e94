//! The steppers by number, as one type: each model of a test is compiled once for all of them.

// Models of functions are compiled there, once for all test programs.
use saltus_instances as _;

use saltus::{Auto, Dop853, Rodas5P, Tsit5};

/// Tsit5, Dop853 and Rodas5P alone, and the choice among them.
pub(crate) fn methods() -> [Auto; 4] {
    [Tsit5.into(), Dop853.into(), Rodas5P.into(), Auto::new()]
}
