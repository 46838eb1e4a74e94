//! ivp: its low-level solvers with a callback after each step ("hand"), and its events with a
//! restart at each ("own").

use std::cell::Cell;

use ivp::dense::StepInterpolant;
use ivp::methods::{DOP853, DOPRI5, IntegrationResult, RADAU};
use ivp::prelude::{ControlFlag, Direction, EventConfig, FirstOrderSystem, Ivp, Matrix, MatrixStorage, Method};
use ivp::solout::SolOut;

use super::contest::{Entry, Events, Log, Solve};
use super::fall::fall;
use super::problems::{Ball, CROSSINGS, DRAG, VACUUM, arenstorf, van_der_pol};

const SOLVER: &str = "ivp";

/// The two explicit methods.
#[derive(Clone, Copy, Debug)]
pub enum Explicit {
    Dopri5,
    Dop853,
}

impl Explicit {
    fn method(self) -> Method {
        match self {
            Self::Dopri5 => Method::DOPRI5,
            Self::Dop853 => Method::DOP853,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Dopri5 => "DOPRI5",
            Self::Dop853 => "DOP853",
        }
    }

    fn solve<F: FirstOrderSystem, S: SolOut>(
        self,
        system: &F,
        start: &[f64],
        end: f64,
        tolerance: f64,
        dense: bool,
        out: &mut S,
    ) -> Option<IntegrationResult> {
        let (r, a) = (tolerance.into(), tolerance.into());
        match self {
            Self::Dopri5 => DOPRI5::builder().max_steps(10_000_000).dense_output(dense).build().solve(
                system,
                0.0,
                start,
                end,
                r,
                a,
                Some(out),
            ),
            Self::Dop853 => DOP853::builder().max_steps(10_000_000).dense_output(dense).build().solve(
                system,
                0.0,
                start,
                end,
                r,
                a,
                Some(out),
            ),
        }
        .ok()
    }
}

/// A flying ball; in two smooth modes if `split`.
struct Flying {
    ball: Ball,
    split: bool,
    rising: Cell<bool>,
}

impl FirstOrderSystem for Flying {
    #[inline]
    fn derivative(&self, _t: f64, y: &[f64], dydt: &mut [f64]) {
        dydt[0] = y[1];
        dydt[1] = if self.split { self.ball.smooth(self.rising.get(), y[1]) } else { self.ball.acceleration(y[1]) };
    }
}

/// Looks for the floor, and for the apex if the ball's modes are split, after each step; puts the
/// ball there and goes on.
struct Bouncing<'a, F> {
    system: &'a Flying,
    impact: F,
}

impl<F: FnMut(f64, f64) -> bool> SolOut for Bouncing<'_, F> {
    fn solout(
        &mut self,
        before: f64,
        t: &mut f64,
        y: &mut [f64],
        interpolant: Option<&StepInterpolant<'_>>,
    ) -> ControlFlag {
        let Some(step) = interpolant else { return ControlFlag::Continue };
        let Flying { ball, split, rising } = self.system;
        let watched = usize::from(*split && rising.get());
        if y[watched] >= 0.0 {
            return ControlFlag::Continue;
        }
        let mut state = [0.0; 2];
        let g = |s: f64| {
            let mut state = [0.0; 2];
            step.interpolate(s, &mut state);
            state[watched]
        };
        *t = fall(g, before, *t, y[watched]);
        step.interpolate(*t, &mut state);
        if watched == 1 {
            rising.set(false);
            y.copy_from_slice(&[state[0], 0.0]);
            return ControlFlag::ModifiedSolution;
        }
        rising.set(true);
        y.copy_from_slice(&[0.0, -ball.cor * state[1]]);
        if (self.impact)(*t, -state[1]) { ControlFlag::ModifiedSolution } else { ControlFlag::Interrupt }
    }
}

/// Tells `impact` of the time and speed before each impact, until it says stop.
pub fn bounce(
    ball: Ball,
    split: bool,
    method: Explicit,
    tolerance: f64,
    impact: impl FnMut(f64, f64) -> bool,
) -> usize {
    let system = Flying { ball, split, rising: Cell::new(false) };
    let mut out = Bouncing { system: &system, impact };
    let result = method.solve(&system, &[ball.height, 0.0], 1e6, tolerance, true, &mut out);
    result.map_or(0, |result| result.evals.ode)
}

fn by_hand(ball: Ball, split: bool, method: Explicit) -> Entry {
    let name = match (method, split) {
        (Explicit::Dopri5, false) => "DOPRI5",
        (Explicit::Dopri5, true) => "DOPRI5, apex split",
        (Explicit::Dop853, false) => "DOP853",
        (Explicit::Dop853, true) => "DOP853, apex split",
    };
    Entry::new(SOLVER, name, Events::Hand, move |tolerance| -> Solve {
        Box::new(move |log| {
            let Log { marks, flows } = log;
            let evaluated = bounce(ball, split, method, tolerance, |t, _| {
                marks.push(t);
                marks.len() < ball.impacts
            });
            *flows = evaluated as u64;
        })
    })
}

/// A ball whose impact is a terminal event.
struct Landing(Ball);

impl FirstOrderSystem for Landing {
    #[inline]
    fn derivative(&self, _t: f64, y: &[f64], dydt: &mut [f64]) {
        dydt[0] = y[1];
        dydt[1] = self.0.acceleration(y[1]);
    }
    fn events(&self, _t: f64, y: &[f64], out: &mut [f64]) {
        out[0] = y[0];
    }
    fn n_events(&self) -> usize {
        1
    }
    fn event_config(&self, _: usize) -> EventConfig {
        EventConfig { direction: Direction::Negative, terminal_count: Some(1) }
    }
}

fn by_events(ball: Ball, method: Explicit) -> Entry {
    Entry::new(SOLVER, method.name(), Events::Own, move |tolerance| -> Solve {
        Box::new(move |log| {
            let system = Landing(ball);
            let (mut t, mut y) = (0.0, [ball.height, 0.0]);
            while log.marks.len() < ball.impacts {
                let arc = Ivp::first_order(&system, t, t + 100.0, &y)
                    .method(method.method())
                    .rtol(tolerance)
                    .atol(tolerance)
                    .solve();
                let Ok(arc) = arc else { return };
                let (Some(&landed), Some(state)) = (arc.t_events[0].first(), arc.y_events[0].first()) else { return };
                log.flows += arc.nfev as u64;
                log.marks.push(landed);
                // A hair above the floor, or the next arc may begin below it.
                (t, y) = (landed, [1e-14, -ball.cor * state[1]]);
            }
        })
    })
}

pub fn vacuum() -> Vec<Entry> {
    let methods = [Explicit::Dopri5, Explicit::Dop853];
    methods.into_iter().flat_map(|method| [by_hand(VACUUM, false, method), by_events(VACUUM, method)]).collect()
}

pub fn drag() -> Vec<Entry> {
    let methods = [Explicit::Dopri5, Explicit::Dop853];
    let entries = |method| [by_hand(DRAG, false, method), by_hand(DRAG, true, method), by_events(DRAG, method)];
    methods.into_iter().flat_map(entries).collect()
}

/// Van der Pol's oscillator with its Jacobian.
struct Stiff;

impl FirstOrderSystem for Stiff {
    #[inline]
    fn derivative(&self, _t: f64, y: &[f64], dydt: &mut [f64]) {
        dydt.copy_from_slice(&van_der_pol::flow([y[0], y[1]]));
    }
    fn jac(&self, _t: f64, y: &[f64], j: &mut Matrix) {
        let [a, b] = van_der_pol::slopes([y[0], y[1]]);
        j[(0, 0)] = 0.0;
        j[(0, 1)] = 1.0;
        j[(1, 0)] = a;
        j[(1, 1)] = b;
    }
}

/// Keeps the last time and state.
struct Last([f64; 3]);

impl SolOut for Last {
    fn solout(&mut self, _: f64, t: &mut f64, y: &mut [f64], _: Option<&StepInterpolant<'_>>) -> ControlFlag {
        self.0 = [*t, y[0], y[1]];
        ControlFlag::Continue
    }
}

fn ended(log: &mut Log, last: &Last, result: Option<IntegrationResult>) {
    if let Some(result) = result.filter(|result| result.is_ok()) {
        log.marks.extend(last.0);
        log.flows = result.evals.ode as u64;
    }
}

struct Orbit;

impl FirstOrderSystem for Orbit {
    #[inline]
    fn derivative(&self, _t: f64, y: &[f64], dydt: &mut [f64]) {
        dydt.copy_from_slice(&arenstorf::flow([y[0], y[1], y[2], y[3]]));
    }
}

pub fn orbit(method: Explicit) -> Entry {
    Entry::new(SOLVER, method.name(), Events::None, move |tolerance| -> Solve {
        Box::new(move |log| {
            let mut last = Last([0.0; 3]);
            let result = method.solve(&Orbit, &arenstorf::START, arenstorf::PERIOD, tolerance, false, &mut last);
            ended(log, &last, result);
        })
    })
}

pub fn stiff() -> Vec<Entry> {
    let radau = Entry::new(SOLVER, "RADAU", Events::None, |tolerance| -> Solve {
        Box::new(move |log| {
            let mut last = Last([0.0; 3]);
            let solver = RADAU::builder().max_steps(100_000).mass_storage(MatrixStorage::Identity).build();
            let (r, a) = (tolerance.into(), tolerance.into());
            let result = solver.solve(&Stiff, 0.0, &van_der_pol::START, van_der_pol::END, r, a, Some(&mut last)).ok();
            ended(log, &last, result);
        })
    });
    let others = [("BDF", Method::BDF), ("LSODA", Method::LSODA)].map(|(name, method)| {
        Entry::new(SOLVER, name, Events::None, move |tolerance| -> Solve {
            Box::new(move |log| {
                let run = Ivp::first_order(&Stiff, 0.0, van_der_pol::END, &van_der_pol::START).method(method);
                if let Ok(run) = run.rtol(tolerance).atol(tolerance).max_steps(100_000).solve()
                    && let (true, Some(&t), Some(y)) = (run.status.is_success(), run.t.last(), run.y.last())
                {
                    log.marks.extend([t, y[0], y[1]]);
                    log.flows = run.nfev as u64;
                }
            })
        })
    });
    std::iter::once(radau).chain(others).collect()
}

/// x'' = -x; its crossings of zero are events that do not end the run.
struct Oscillator;

impl FirstOrderSystem for Oscillator {
    #[inline]
    fn derivative(&self, _t: f64, y: &[f64], dydt: &mut [f64]) {
        dydt[0] = y[1];
        dydt[1] = -y[0];
    }
}

struct Watched<G>(G);

impl<G: Fn(f64, &[f64]) -> f64> FirstOrderSystem for Watched<G> {
    #[inline]
    fn derivative(&self, t: f64, y: &[f64], dydt: &mut [f64]) {
        Oscillator.derivative(t, y, dydt);
    }
    fn events(&self, t: f64, y: &[f64], out: &mut [f64]) {
        out[0] = (self.0)(t, y);
    }
    fn n_events(&self) -> usize {
        1
    }
}

/// Keeps the crossings of zero, found by hand.
struct Crossings<'a> {
    times: &'a mut Vec<f64>,
    last: f64,
}

impl SolOut for Crossings<'_> {
    fn solout(
        &mut self,
        before: f64,
        t: &mut f64,
        y: &mut [f64],
        interpolant: Option<&StepInterpolant<'_>>,
    ) -> ControlFlag {
        let sign = self.last.signum();
        if let Some(step) = interpolant
            && sign * y[0] < 0.0
        {
            let g = |s: f64| {
                let mut state = [0.0; 2];
                step.interpolate(s, &mut state);
                sign * state[0]
            };
            self.times.push(fall(g, before, *t, sign * y[0]));
        }
        self.last = y[0];
        if self.times.len() < CROSSINGS { ControlFlag::Continue } else { ControlFlag::Interrupt }
    }
}

pub fn crossings(method: Explicit) -> [Entry; 2] {
    let end = (CROSSINGS as f64) * std::f64::consts::PI;
    let own = Entry::new(SOLVER, method.name(), Events::Own, move |tolerance| -> Solve {
        Box::new(move |log| {
            let system = Watched(|_: f64, y: &[f64]| y[0]);
            let run = Ivp::first_order(&system, 0.0, end, &[1.0, 0.0]).method(method.method());
            if let Ok(run) = run.rtol(tolerance).atol(tolerance).solve() {
                log.marks.extend(&run.t_events[0]);
                log.flows = run.nfev as u64;
            }
        })
    });
    let hand = Entry::new(SOLVER, method.name(), Events::Hand, move |tolerance| -> Solve {
        Box::new(move |log| {
            let mut out = Crossings { times: &mut log.marks, last: 1.0 };
            let result = method.solve(&Oscillator, &[1.0, 0.0], 2.0 * end, tolerance, true, &mut out);
            log.flows = result.map_or(0, |result| result.evals.ode as u64);
        })
    });
    [own, hand]
}

/// The crossings of zero of `g` along an oscillator's ten seconds.
pub fn watched(g: impl Fn(f64) -> f64, tolerance: f64) -> Vec<f64> {
    let system = Watched(|t: f64, _: &[f64]| g(t));
    let run = Ivp::first_order(&system, 0.0, 10.0, &[1.0, 0.0]).method(Method::DOP853);
    run.rtol(tolerance).atol(tolerance).solve().map_or(Vec::new(), |mut run| run.t_events.swap_remove(0))
}
