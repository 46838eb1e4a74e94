//! Runs the code in the project's pages as documentation tests; the other tests are in the files of this package's `tests` folder.

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

#[cfg(doctest)]
#[doc = include_str!("../../docs/model.md")]
pub struct Model;

#[cfg(doctest)]
#[doc = include_str!("../../docs/fitting.md")]
pub struct Fitting;

#[cfg(doctest)]
#[doc = include_str!("../../docs/sensitivities.md")]
pub struct Sensitivities;

#[cfg(doctest)]
#[doc = include_str!("../../docs/simulating.md")]
pub struct Simulating;

pub mod reference;

#[cfg(doctest)]
#[doc = include_str!("../../docs/physics.md")]
pub struct Physics;

#[cfg(doctest)]
#[doc = include_str!("../../docs/tutorial.md")]
pub struct Tutorial;

#[cfg(doctest)]
#[doc = include_str!("../../docs/study.md")]
pub struct Study;

#[cfg(doctest)]
#[doc = include_str!("../../docs/cookbook.md")]
pub struct Cookbook;

#[cfg(doctest)]
#[doc = include_str!("../../docs/accuracy.md")]
pub struct Accuracy;
