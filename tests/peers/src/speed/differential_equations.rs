//! differential-equations: its steppers driven by hand, and its event detectors ("own").

use differential_equations::interpolate::Interpolation;
use differential_equations::linalg::Matrix;
use differential_equations::ode::{ODE, OrdinaryNumericalMethod};
use differential_equations::prelude::{
    BackwardDifferentiationFormula, CrossingDirection, DiagonallyImplicitRungeKutta, Event, EventConfig,
    ExplicitRungeKutta, IVP, ImplicitRungeKutta, Status,
};

use super::contest::{Entry, Events, Log, Solve};
use super::fall::fall;
use super::problems::{Ball, CROSSINGS, DRAG, VACUUM, arenstorf, van_der_pol};

const SOLVER: &str = "differential-equations";

/// A method for states of N numbers.
pub trait Method<const N: usize>: OrdinaryNumericalMethod<f64, [f64; N]> + Interpolation<f64, [f64; N]> {}
impl<const N: usize, M: OrdinaryNumericalMethod<f64, [f64; N]> + Interpolation<f64, [f64; N]>> Method<N> for M {}

/// A method, made for a tolerance.
macro_rules! method {
    ($family:ident :: $name:ident) => {
        |tolerance: f64| $family::$name().rtol(tolerance).atol(tolerance).max_steps(10_000_000)
    };
}

/// A flying ball.
#[derive(Clone, Copy)]
struct Flying {
    ball: Ball,
    split: bool,
    rising: bool,
}

impl ODE<f64, [f64; 2]> for Flying {
    #[inline]
    fn diff(&self, _t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        let a = if self.split { self.ball.smooth(self.rising, y[1]) } else { self.ball.acceleration(y[1]) };
        *dydt = [y[1], a];
    }
}

/// Tells `impact` of the time and speed before each impact, until it says stop. The step size
/// survives a restart.
pub fn bounce(
    ball: Ball,
    split: bool,
    mut method: impl Method<2>,
    mut impact: impl FnMut(f64, f64) -> bool,
) -> Option<usize> {
    const END: f64 = 1e6;
    let mut system = Flying { ball, split, rising: false };
    let mut flows = method.init(&system, 0.0, END, &[ball.height, 0.0]).ok()?.function;
    loop {
        flows += method.step(&system).ok()?.function;
        if *method.status() == Status::RejectedStep {
            continue;
        }
        let watched = usize::from(split && system.rising);
        let (end, value) = (method.t(), method.y()[watched]);
        if value >= 0.0 {
            continue;
        }
        let (start, h) = (method.t_prev(), method.h());
        let t = fall(|s| method.interpolate(s).map_or(f64::NAN, |y| y[watched]), start, end, value);
        let y = method.interpolate(t).ok()?;
        let start = if watched == 1 {
            system.rising = false;
            [y[0], 0.0]
        } else {
            system.rising = true;
            if !impact(t, -y[1]) {
                return Some(flows);
            }
            [0.0, -ball.cor * y[1]]
        };
        flows += method.init(&system, t, END, &start).ok()?.function;
        method.set_h(h);
    }
}

fn by_hand<M: Method<2> + 'static>(
    name: &'static str,
    ball: Ball,
    split: bool,
    method: impl Fn(f64) -> M + Copy + 'static,
) -> Entry {
    Entry::new(SOLVER, name, Events::Hand, move |tolerance| -> Solve {
        Box::new(move |log| {
            let Log { marks, flows } = log;
            let evaluated = bounce(ball, split, method(tolerance), |t, _| {
                marks.push(t);
                marks.len() < ball.impacts
            });
            *flows = evaluated.unwrap_or(0) as u64;
        })
    })
}

/// The height as an event that ends a run.
struct Floor;

impl Event<f64, [f64; 2]> for Floor {
    fn config(&self) -> EventConfig {
        EventConfig::default().direction(CrossingDirection::Negative).terminal()
    }
    fn event(&self, _t: f64, y: &[f64; 2]) -> f64 {
        y[0]
    }
}

fn by_events<M: Method<2> + 'static>(
    name: &'static str,
    ball: Ball,
    method: impl Fn(f64) -> M + Copy + 'static,
) -> Entry {
    Entry::new(SOLVER, name, Events::Own, move |tolerance| -> Solve {
        Box::new(move |log| {
            let system = Flying { ball, split: false, rising: false };
            let (mut t, mut y) = (0.0, [ball.height, 0.0]);
            while log.marks.len() < ball.impacts {
                let arc = IVP::ode(&system, t, t + 100.0, y).event(&Floor).method(method(tolerance)).solve();
                let Ok(arc) = arc else { return };
                let (Status::Interrupted, Some(&landed), Some(state)) = (&arc.status, arc.t.last(), arc.y.last())
                else {
                    return;
                };
                log.flows += arc.evals.function as u64;
                log.marks.push(landed);
                (t, y) = (landed, [1e-14, -ball.cor * state[1]]);
            }
        })
    })
}

pub fn vacuum() -> Vec<Entry> {
    vec![
        by_hand("dopri5", VACUUM, false, method!(ExplicitRungeKutta::dopri5)),
        by_hand("dop853", VACUUM, false, method!(ExplicitRungeKutta::dop853)),
        by_events("dopri5", VACUUM, method!(ExplicitRungeKutta::dopri5)),
    ]
}

pub fn drag() -> Vec<Entry> {
    vec![
        by_hand("dopri5", DRAG, false, method!(ExplicitRungeKutta::dopri5)),
        by_hand("dopri5, apex split", DRAG, true, method!(ExplicitRungeKutta::dopri5)),
        by_hand("dop853, apex split", DRAG, true, method!(ExplicitRungeKutta::dop853)),
        by_hand("rkv655e, apex split", DRAG, true, method!(ExplicitRungeKutta::rkv655e)),
        by_hand("rkv877e, apex split", DRAG, true, method!(ExplicitRungeKutta::rkv877e)),
        by_events("dopri5", DRAG, method!(ExplicitRungeKutta::dopri5)),
    ]
}

/// Tells `impact` of the impacts of a ball by dopri5 with its apex split, the best of this crate on
/// that problem.
pub fn bounce_dopri5(ball: Ball, tolerance: f64, impact: impl FnMut(f64, f64) -> bool) {
    bounce(ball, true, method!(ExplicitRungeKutta::dopri5)(tolerance), impact);
}

/// Runs to the end by single steps, which stores nothing.
fn to_the_end<const N: usize>(
    system: &impl ODE<f64, [f64; N]>,
    mut method: impl Method<N>,
    start: [f64; N],
    end: f64,
    log: &mut Log,
) -> Option<()> {
    let mut flows = method.init(system, 0.0, end, &start).ok()?.function;
    while method.t() < end {
        if method.t() + method.h() > end {
            method.set_h(end - method.t());
        }
        flows += method.step(system).ok()?.function;
    }
    let y = method.y();
    log.marks.extend([method.t(), y[0], y[1]]);
    log.flows = flows as u64;
    Some(())
}

struct Orbit;

impl ODE<f64, [f64; 4]> for Orbit {
    #[inline]
    fn diff(&self, _t: f64, y: &[f64; 4], dydt: &mut [f64; 4]) {
        *dydt = arenstorf::flow(*y);
    }
}

fn orbit_by<M: Method<4> + 'static>(name: &'static str, method: impl Fn(f64) -> M + Copy + 'static) -> Entry {
    Entry::new(SOLVER, name, Events::None, move |tolerance| -> Solve {
        Box::new(move |log| {
            to_the_end(&Orbit, method(tolerance), arenstorf::START, arenstorf::PERIOD, log);
        })
    })
}

pub fn orbit() -> Vec<Entry> {
    vec![
        orbit_by("dopri5", method!(ExplicitRungeKutta::dopri5)),
        orbit_by("dop853", method!(ExplicitRungeKutta::dop853)),
        orbit_by("rkv766e", method!(ExplicitRungeKutta::rkv766e)),
        orbit_by("rkv877e", method!(ExplicitRungeKutta::rkv877e)),
        orbit_by("rkv988e", method!(ExplicitRungeKutta::rkv988e)),
    ]
}

struct Stiff;

impl ODE<f64, [f64; 2]> for Stiff {
    #[inline]
    fn diff(&self, _t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        *dydt = van_der_pol::flow(*y);
    }
    fn jacobian(&self, _t: f64, y: &[f64; 2], j: &mut Matrix<f64>) {
        let [a, b] = van_der_pol::slopes(*y);
        j[(0, 0)] = 0.0;
        j[(0, 1)] = 1.0;
        j[(1, 0)] = a;
        j[(1, 1)] = b;
    }
}

fn stiff_by<M: Method<2> + 'static>(name: &'static str, method: impl Fn(f64) -> M + Copy + 'static) -> Entry {
    Entry::new(SOLVER, name, Events::None, move |tolerance| -> Solve {
        Box::new(move |log| {
            to_the_end(&Stiff, method(tolerance), van_der_pol::START, van_der_pol::END, log);
        })
    })
}

pub fn stiff() -> Vec<Entry> {
    vec![
        stiff_by("radau5", method!(ImplicitRungeKutta::radau5)),
        stiff_by("BDF", method!(BackwardDifferentiationFormula::adaptive)),
        stiff_by("kvaerno745", method!(DiagonallyImplicitRungeKutta::kvaerno745)),
    ]
}

struct Oscillator;

impl ODE<f64, [f64; 2]> for Oscillator {
    #[inline]
    fn diff(&self, _t: f64, y: &[f64; 2], dydt: &mut [f64; 2]) {
        *dydt = [y[1], -y[0]];
    }
}

const END: f64 = CROSSINGS as f64 * std::f64::consts::PI;

fn crossings_by<M: Method<2> + 'static>(name: &'static str, method: impl Fn(f64) -> M + Copy + 'static) -> [Entry; 2] {
    let own = Entry::new(SOLVER, name, Events::Own, move |tolerance| -> Solve {
        Box::new(move |log| {
            let run = IVP::ode(&Oscillator, 0.0, END, [1.0, 0.0]).crossing(0, 0.0, CrossingDirection::Both);
            if let Ok(run) = run.method(method(tolerance)).solve() {
                log.marks.extend(&run.t);
                log.flows = run.evals.function as u64;
            }
        })
    });
    let hand = Entry::new(SOLVER, name, Events::Hand, move |tolerance| -> Solve {
        Box::new(move |log| {
            let mut method = method(tolerance);
            let Ok(evals) = method.init(&Oscillator, 0.0, 2.0 * END, &[1.0, 0.0]) else { return };
            let mut last = 1.0_f64;
            log.flows = evals.function as u64;
            while log.marks.len() < CROSSINGS {
                let Ok(evals) = method.step(&Oscillator) else { return };
                log.flows += evals.function as u64;
                let (sign, value) = (last.signum(), method.y()[0]);
                if sign * value < 0.0 {
                    let (start, end) = (method.t_prev(), method.t());
                    let g = |s| method.interpolate(s).map_or(f64::NAN, |y| sign * y[0]);
                    log.marks.push(fall(g, start, end, sign * value));
                }
                last = value;
            }
        })
    });
    [own, hand]
}

pub fn crossings() -> Vec<Entry> {
    let mut entries = Vec::new();
    entries.extend(crossings_by("dopri5", method!(ExplicitRungeKutta::dopri5)));
    entries.extend(crossings_by("dop853", method!(ExplicitRungeKutta::dop853)));
    entries.extend(crossings_by("rkv655e", method!(ExplicitRungeKutta::rkv655e)));
    entries.extend(crossings_by("rkv877e", method!(ExplicitRungeKutta::rkv877e)));
    entries
}

/// A guard of time alone.
struct Watch<G>(G);

impl<G: Fn(f64) -> f64> Event<f64, [f64; 2]> for Watch<G> {
    fn event(&self, t: f64, _y: &[f64; 2]) -> f64 {
        (self.0)(t)
    }
}

/// The crossings of zero of `g` along an oscillator's ten seconds: those points of the solution
/// that are no ends of steps.
pub fn watched(g: impl Fn(f64) -> f64, tolerance: f64) -> Vec<f64> {
    let watch = Watch(g);
    let run = IVP::ode(&Oscillator, 0.0, 10.0, [1.0, 0.0])
        .solout(differential_equations::solout::EventSolout::new(&watch, 0.0, 10.0))
        .method(ExplicitRungeKutta::dop853().rtol(tolerance).atol(tolerance));
    run.solve().map_or(Vec::new(), |run| run.t)
}
