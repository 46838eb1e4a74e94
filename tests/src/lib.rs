//! Runs the code in the project's pages as documentation tests, and keeps what several tests share;
//! those are in this package's `tests` folder, fuzz targets in `fuzz`.

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
#[doc = include_str!("../../docs/coming-from.md")]
pub struct ComingFrom;

#[cfg(doctest)]
#[doc = include_str!("../../docs/sensitivities.md")]
pub struct Sensitivities;

#[cfg(doctest)]
#[doc = include_str!("../../docs/simulating.md")]
pub struct Simulating;

pub mod any_scene;
pub mod random_scene;
pub mod reference;
pub mod scene_laws;
pub mod sturm;
pub mod watched;

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
