//! What a step costs, what a guard adds to it that never fires, and what a crossing costs.
//!
//! `cargo bench -p saltus`; quote ratios of one run on one machine, not times. Times are per step,
//! or per crossing where there are some.

#![allow(clippy::unwrap_used)] // a benchmark of a run that fails should stop

use std::hint::black_box;

use divan::Bencher;
use divan::counter::ItemsCount;
use saltus::step::{Auto, Dop853, Rodas5P, Stepper, Tsit5};
use saltus::{About, Automaton, Edges, Refusal, Series, Simulation, Solution};

const STEPS: u64 = 1000;

fn main() {
    divan::main();
}

/// How the guard of [`Turning`] is seen.
#[derive(Clone, Copy, PartialEq)]
enum Watch {
    Nothing,
    Promised,
    Unpromised,
}

/// N coordinates that turn into each other in pairs, and a wall that none ever reaches (`wall` = 2)
/// or that each half turn crosses (0).
struct Turning<const N: usize> {
    watch: Watch,
    wall: f64,
}

impl<const N: usize> Turning<N> {
    fn series(&self, _: bool, series: &mut Series<'_, [f64; N]>) {
        series.flow(|_t, x: [_; N]| std::array::from_fn(|i| if i % 2 == 0 { x[i + 1] } else { -x[i - 1] }));
    }
}

impl<const N: usize> Automaton for Turning<N> {
    type Mode = bool;
    type State = [f64; N];
    type Edge = bool;

    #[inline]
    fn flow(&self, _: bool, _t: f64, x: &[f64; N]) -> [f64; N] {
        std::array::from_fn(|i| if i % 2 == 0 { x[i + 1] } else { -x[i - 1] })
    }
    #[inline]
    fn solution(&self, _: bool, _t: f64, _x: &[f64; N]) -> Solution<Self> {
        Solution::Series(Self::series)
    }
    #[inline]
    fn edges(&self, mode: bool) -> Edges<'_, bool> {
        if self.watch == Watch::Nothing { Edges::none() } else { Edges::from([mode]) }
    }
    #[inline]
    fn guard(&self, up: bool, _t: f64, x: &[f64; N]) -> f64 {
        self.wall + if up { x[0] } else { -x[0] }
    }
    #[inline]
    fn about(&self, _: bool) -> About {
        About::new().affine_if(self.watch == Watch::Promised)
    }
    #[inline]
    fn reset(&self, _: bool, up: bool, _t: f64, x: &[f64; N]) -> Result<(bool, [f64; N]), Refusal> {
        Ok((!up, *x))
    }
}

fn steps<const N: usize>(bencher: Bencher, stepper: impl Stepper + Sync, watch: Watch) {
    let system = Turning::<N> { watch, wall: 2.0 };
    let simulation = Simulation::of(&system).stepper(stepper).stepped().tolerance(1e-6).most_steps(STEPS);
    let start = std::array::from_fn(|i| if i % 2 == 0 { 1.0 } else { 0.0 });
    bencher
        .counter(ItemsCount::new(STEPS))
        .bench(|| simulation.drive(true, black_box(start), 0.0..1e9, &mut ()).unwrap());
}

#[divan::bench(consts = [2, 4, 8])]
fn step_of_tsit5<const N: usize>(bencher: Bencher) {
    steps::<N>(bencher, Tsit5, Watch::Nothing);
}

/// The default, which at this tolerance takes the steps of Tsit5.
#[divan::bench(consts = [2, 4, 8])]
fn step_of_auto<const N: usize>(bencher: Bencher) {
    steps::<N>(bencher, Auto::default(), Watch::Nothing);
}

#[divan::bench(consts = [2, 4, 8])]
fn step_of_dop853<const N: usize>(bencher: Bencher) {
    steps::<N>(bencher, Dop853, Watch::Nothing);
}

#[divan::bench(consts = [2, 4, 8])]
fn step_of_rodas5p<const N: usize>(bencher: Bencher) {
    steps::<N>(bencher, Rodas5P, Watch::Nothing);
}

/// Against `step_of_tsit5`: what a guard costs that never fires, with the dense output that it
/// looks at.
#[divan::bench(consts = [2, 4, 8])]
fn step_with_a_promised_guard<const N: usize>(bencher: Bencher) {
    steps::<N>(bencher, Tsit5, Watch::Promised);
}

/// The same by the default stepper, against `step_of_auto`.
#[divan::bench(consts = [2, 4, 8])]
fn step_of_auto_with_a_promised_guard<const N: usize>(bencher: Bencher) {
    steps::<N>(bencher, Auto::default(), Watch::Promised);
}

#[divan::bench(consts = [2, 4, 8])]
fn step_with_an_unpromised_guard<const N: usize>(bencher: Bencher) {
    steps::<N>(bencher, Tsit5, Watch::Unpromised);
}

fn crossings(bencher: Bencher, series: bool, tolerance: f64, watch: Watch) {
    const CROSSINGS: usize = 1000;
    let system = Turning::<2> { watch, wall: 0.0 };
    let simulation = Simulation::of(&system).tolerance(tolerance).most_jumps(CROSSINGS);
    let simulation = if series { simulation } else { simulation.stepped() };
    bencher
        .counter(ItemsCount::new(CROSSINGS))
        .bench(|| simulation.drive(true, black_box([1.0, 0.0]), 0.0..1e9, &mut ()).unwrap());
}

#[divan::bench(args = [1e-6, 1e-9, 1e-12])]
fn crossing_of_a_promised_guard(bencher: Bencher, tolerance: f64) {
    crossings(bencher, false, tolerance, Watch::Promised);
}

#[divan::bench(args = [1e-6, 1e-9, 1e-12])]
fn crossing_of_an_unpromised_guard(bencher: Bencher, tolerance: f64) {
    crossings(bencher, false, tolerance, Watch::Unpromised);
}

#[divan::bench(args = [1e-6, 1e-9, 1e-12])]
fn crossing_of_a_promised_guard_by_series(bencher: Bencher, tolerance: f64) {
    crossings(bencher, true, tolerance, Watch::Promised);
}

#[divan::bench(args = [1e-6, 1e-9, 1e-12])]
fn crossing_of_an_unpromised_guard_by_series(bencher: Bencher, tolerance: f64) {
    crossings(bencher, true, tolerance, Watch::Unpromised);
}
