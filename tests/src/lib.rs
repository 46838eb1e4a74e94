//! Runs the code in the project's pages as documentation tests, and keeps what several tests share;
//! those are in this package's `tests` folder, fuzz targets in `fuzz`.

// Automata of functions are compiled there, once for all test programs.
use saltus_instances as _;

pub mod any_scene;
pub mod random_scene;
pub mod reference;
pub mod scene_laws;
pub mod sturm;
pub mod watched;

#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
pub struct Readme;

#[cfg(doctest)]
#[doc = include_str!("../../crates/saltus/README.md")]
pub struct Engine;

#[cfg(doctest)]
#[doc = include_str!("../../crates/saltus-derive/README.md")]
pub struct Derive;

#[cfg(doctest)]
#[doc = include_str!("../../crates/saltus-bounce/README.md")]
pub struct Bounce;

#[cfg(doctest)]
#[doc = include_str!("../../crates/saltus-scene/README.md")]
pub struct Scene;

#[cfg(doctest)]
#[doc = include_str!("../../crates/saltus-fit/README.md")]
pub struct Fit;

#[cfg(doctest)]
#[doc = include_str!("../../crates/saltus-plot/README.md")]
pub struct Plot;

#[cfg(doctest)]
#[doc = include_str!("../../crates/saltus-motion/README.md")]
pub struct KeyFrames;

#[cfg(doctest)]
#[doc = include_str!("../../docs/program/model.md")]
pub struct Model;

#[cfg(doctest)]
#[doc = include_str!("../../docs/use/fitting.md")]
pub struct Fitting;

#[cfg(doctest)]
#[doc = include_str!("../../docs/program/coming-from.md")]
pub struct ComingFrom;

#[cfg(doctest)]
#[doc = include_str!("../../docs/program/sensitivities.md")]
pub struct Sensitivities;

#[cfg(doctest)]
#[doc = include_str!("../../docs/use/simulating.md")]
pub struct Simulating;

#[cfg(doctest)]
#[doc = include_str!("../../docs/trust/physics.md")]
pub struct Physics;

#[cfg(doctest)]
#[doc = include_str!("../../docs/program/tutorial.md")]
pub struct Tutorial;

#[cfg(doctest)]
#[doc = include_str!("../../docs/trust/study.md")]
pub struct Study;

#[cfg(doctest)]
#[doc = include_str!("../../docs/program/cookbook.md")]
pub struct Cookbook;

#[cfg(doctest)]
#[doc = include_str!("../../docs/trust/numerics.md")]
pub struct Numerics;

#[cfg(doctest)]
#[doc = include_str!("../../docs/trust/accuracy.md")]
pub struct Accuracy;
