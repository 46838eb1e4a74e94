//! How fast, at equal error.

pub mod contest;
pub mod differential_equations;
pub mod diffsol;
pub mod fall;
pub mod floor;
pub mod ivp;
pub mod ode_solvers;
pub mod problems;
pub mod report;
pub mod russell_ode;
pub mod saltus;
pub mod swarm;
