//! A DC–DC buck converter under voltage control, chaotic above 32 V (J. Deane, D. Hamill, IEEE
//! Trans. Power Electronics 5 (1990) 260).
//!
//! `cargo run --release --example converter`: a ramp starts afresh each period; the switch is
//! closed while the ramp is above the amplified error.

use std::error::Error;

use rayon::prelude::*;
use saltus::nalgebra::Vector3;
use saltus::return_map::{Continuation, Kind, MapError, ReturnMap, Selection};
use saltus::{About, Automaton, Edges, Entry, Linearize, Number, Refusal, Simulation};
use saltus_examples::{Figure, gallery};

const INDUCTANCE: f64 = 20e-3; // H
const CAPACITY: f64 = 47e-6; // F
const LOAD: f64 = 22.0; // Ω
const PERIOD: f64 = 400e-6; // s
const RAMP: (f64, f64) = (3.8, 8.2); // V, from its foot to its top
const WANTED: f64 = 11.3; // V
const GAIN: f64 = 8.4;

#[derive(Clone, Copy, Debug)]
struct Buck(f64); // the voltage that comes in

#[derive(Clone, Copy, Debug, PartialEq)]
enum Switch {
    Open,
    Closed,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Event {
    Close,
    Open,
    Period, // the ramp falls back to its foot, and the switch opens
}

impl Linearize for Buck {
    type Parameters = [f64; 1];

    fn parameters(&self) -> [f64; 1] {
        [self.0]
    }
    /// The state is the voltage, the current, and the time since the ramp's start.
    fn flow_over<D: Number>(&self, switch: Switch, _t: D, [v, i, _]: [D; 3], [supply]: [D; 1]) -> [D; 3] {
        let driven = if switch == Switch::Closed { supply - v } else { -v };
        [(i - v / LOAD) / CAPACITY, driven / INDUCTANCE, D::one()]
    }
    fn guard_over<D: Number>(&self, event: Event, _t: D, [v, _, s]: [D; 3], _: [D; 1]) -> D {
        let excess = (v - WANTED) * GAIN - s * ((RAMP.1 - RAMP.0) / PERIOD) - RAMP.0;
        match event {
            Event::Close => excess,
            Event::Open => -excess,
            Event::Period => -s + PERIOD,
        }
    }
    fn reset_over<D: Number>(&self, event: Event, _t: D, [v, i, s]: [D; 3], _: [D; 1]) -> [D; 3] {
        [v, i, if event == Event::Period { D::zero() } else { s }]
    }
}

impl Automaton for Buck {
    type Mode = Switch;
    type State = Vector3<f64>;
    type Edge = Event;

    fn flow(&self, switch: Switch, t: f64, x: &Vector3<f64>) -> Vector3<f64> {
        self.flow_at(switch, t, x)
    }
    fn edges(&self, switch: Switch) -> Edges<'_, Event> {
        Edges::from([if switch == Switch::Open { Event::Close } else { Event::Open }, Event::Period])
    }
    fn guard(&self, event: Event, t: f64, x: &Vector3<f64>) -> f64 {
        self.guard_at(event, t, x)
    }
    #[inline]
    fn about(&self, _: Event) -> About {
        // If the ramp starts above the error, the switch closes again at once.
        About::new().entry(Entry::Fire).affine()
    }
    fn reset(&self, _: Switch, event: Event, t: f64, x: &Vector3<f64>) -> Result<(Switch, Vector3<f64>), Refusal> {
        let to = if event == Event::Close { Switch::Closed } else { Switch::Open };
        Ok((to, self.reset_at(event, t, x)))
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    // Voltage and current at the start of a period.
    let start = Selection::of(Event::Period, (Switch::Open, Vector3::zeros()), [0, 1])?;
    let attractor = |supply: f64| -> Result<Vec<[f64; 2]>, MapError> {
        let buck = Buck(supply);
        let map = ReturnMap::of(Simulation::of(&buck), start);
        let mut q = [12.0, 0.55];
        let mut period = || -> Result<[f64; 2], MapError> {
            q = map.apply(q)?.q;
            Ok([supply, q[0]])
        };
        (0..300).try_for_each(|_| period().map(drop))?;
        (0..100).map(|_| period()).collect()
    };
    let supplies = (0..500).into_par_iter().map(|k| 20.0 + 0.03 * f64::from(k));
    let points = supplies.map(attractor).collect::<Result<Vec<_>, _>>()?.concat();

    let buck = Buck(20.0);
    let map = ReturnMap::of(Simulation::of(&buck).tolerance(1e-12), start);
    let branch = Continuation::of(&map, Buck, 0).follow([12.0, 0.55], 20.0, 35.0)?;
    let doubling = branch.bifurcations.iter().find(|b| b.kind == Kind::PeriodDoubling).ok_or("no period doubling")?;
    let picture = Figure::new("A buck converter", "voltage in (V)", "voltage out, once a period (V)")
        .cloud("attractor", points)
        .line("once a period, stable or not", branch.points.iter().map(|point| [point.parameter, point.orbit.q[0]]))
        .dots("period doubling", [[doubling.point.parameter, doubling.point.orbit.q[0]]])
        .across(20.0, 35.0);
    gallery("converter", &picture.svg())?;

    // Published (E. Fossas, G. Olivar, IEEE Trans. Circuits and Systems I 43 (1996) 13): 24.516 V.
    println!("the period doubles at {:.6} V: see docs/program/gallery/converter.svg", doubling.point.parameter);
    assert!((doubling.point.parameter - 24.516).abs() < 1e-3);
    Ok(())
}
