//! diffsol: roots and resets of its own, on nalgebra's matrices.

use std::cell::Cell;
use std::rc::Rc;

use diffsol::{
    NalgebraLU, NalgebraMat, NalgebraVec, OdeBuilder, OdeEquations, OdeSolverMethod, OdeSolverStopReason, VectorCommon,
};

use super::contest::{Entry, Events, Log, Solve};
use super::problems::{Ball, CROSSINGS, DRAG, VACUUM, arenstorf, van_der_pol};

const SOLVER: &str = "diffsol";
type Mat = NalgebraMat<f64>;
type Vect = NalgebraVec<f64>;

/// Builds and keeps a problem, and lets `$solve` solve it.
macro_rules! solving {
    ($problem:expr, |$p:ident, $log:ident| $solve:expr) => {{
        let built = $problem;
        Box::new(move |$log: &mut Log| {
            if let Ok($p) = &built {
                let _: Option<()> = (|| $solve)();
            }
        })
    }};
}

/// A ball by tsit45: falling and rising are two modes if `split`, and then its resets are exact; if
/// not, a bounce starts 1e-14 m above the floor, or the next arc would begin with a root.
macro_rules! ball_problem {
    ($ball:expr, $split:expr, $rising:expr, $tolerance:expr) => {{
        let (ball, split): (Ball, bool) = ($ball, $split);
        let rising: &Rc<Cell<bool>> = $rising;
        let [r, w, c] = [(); 3].map(|()| Rc::clone(rising));
        OdeBuilder::<Mat>::new()
            .rtol($tolerance)
            .atol([$tolerance, $tolerance])
            .rhs(move |x, _p, _t, y| {
                y[0] = x[1];
                y[1] = if split { ball.smooth(r.get(), x[1]) } else { ball.acceleration(x[1]) };
            })
            .init(move |_p, _t, y| (y[0], y[1]) = (ball.height, 0.0), 2)
            .root(move |x, _p, _t, g| g[0] = x[usize::from(w.get())], 1)
            .reset(move |x, _p, _t, y| {
                if c.get() {
                    (y[0], y[1]) = (x[0], 0.0);
                } else {
                    (y[0], y[1]) = (if split { 0.0 } else { 1e-14 }, -ball.cor * x[1]);
                }
                c.set(split && !c.get());
            })
            .build()
    }};
}

/// Steps from root to root, resetting at each; tells `impact` of the time and speed before each
/// impact, until it says stop.
fn bouncing<'a, E: OdeEquations<T = f64, V = Vect> + 'a>(
    mut solver: impl OdeSolverMethod<'a, E>,
    rising: &Cell<bool>,
    mut impact: impl FnMut(f64, f64) -> bool,
) -> Option<()> {
    loop {
        if let OdeSolverStopReason::RootFound(t, _) = solver.step().ok()? {
            solver.state_mut_back(t).ok()?;
            if !rising.get() && !impact(t, -solver.state().y.inner()[1]) {
                return Some(());
            }
            solver.apply_reset().ok()?;
        }
    }
}

fn ball(name: &'static str, ball: Ball, split: bool) -> Entry {
    Entry::new(SOLVER, name, Events::Own, move |tolerance| -> Solve {
        let rising = Rc::new(Cell::new(false));
        solving!(ball_problem!(ball, split, &rising, tolerance), |problem, log| {
            rising.set(false);
            bouncing(problem.tsit45().ok()?, &rising, |t, _| {
                log.marks.push(t);
                log.marks.len() < ball.impacts
            })
        })
    })
}

/// Tells `impact` of the impacts of one ball.
pub fn bounce(ball: Ball, tolerance: f64, impact: impl FnMut(f64, f64) -> bool) -> Option<()> {
    let rising = Rc::new(Cell::new(false));
    let problem = ball_problem!(ball, true, &rising, tolerance).ok()?;
    bouncing(problem.tsit45().ok()?, &rising, impact)
}

pub fn vacuum() -> Vec<Entry> {
    vec![ball("tsit45", VACUUM, false)]
}

pub fn drag() -> Vec<Entry> {
    vec![ball("tsit45", DRAG, false), ball("tsit45, apex split", DRAG, true)]
}

/// Steps to the end; the marks are the time reached and two coordinates.
fn to_the_end<'a, E: OdeEquations<T = f64, V = Vect> + 'a>(
    mut solver: impl OdeSolverMethod<'a, E>,
    end: f64,
    log: &mut Log,
) -> Option<()> {
    solver.set_stop_time(end).ok()?;
    while solver.step().ok()? != OdeSolverStopReason::TstopReached {}
    let y = solver.state().y.inner();
    log.marks.extend([solver.state().t, y[0], y[1]]);
    Some(())
}

pub fn orbit() -> Entry {
    Entry::new(SOLVER, "tsit45", Events::None, |tolerance| -> Solve {
        let problem = OdeBuilder::<Mat>::new()
            .rtol(tolerance)
            .atol([tolerance; 4])
            .rhs(|x, _p, _t, y| y.copy_from_slice(&arenstorf::flow([x[0], x[1], x[2], x[3]])))
            .init(|_p, _t, y| y.copy_from_slice(&arenstorf::START), 4)
            .build();
        solving!(problem, |problem, log| to_the_end(problem.tsit45().ok()?, arenstorf::PERIOD, log))
    })
}

pub fn stiff() -> Vec<Entry> {
    macro_rules! stiff {
        ($name:literal, $method:ident) => {
            Entry::new(SOLVER, $name, Events::None, |tolerance| -> Solve {
                let problem = OdeBuilder::<Mat>::new()
                    .rtol(tolerance)
                    .atol([tolerance; 2])
                    .rhs_implicit(
                        |x, _p, _t, y| y.copy_from_slice(&van_der_pol::flow([x[0], x[1]])),
                        |x, _p, _t, v, y| {
                            let [a, b] = van_der_pol::slopes([x[0], x[1]]);
                            (y[0], y[1]) = (v[1], a * v[0] + b * v[1]);
                        },
                    )
                    .init(|_p, _t, y| y.copy_from_slice(&van_der_pol::START), 2)
                    .build();
                solving!(problem, |problem, log| {
                    to_the_end(problem.$method::<NalgebraLU<f64>>().ok()?, van_der_pol::END, log)
                })
            })
        };
    }
    vec![stiff!("BDF", bdf), stiff!("ESDIRK34", esdirk34), stiff!("TR-BDF2", tr_bdf2)]
}

/// An oscillator watched by a guard, without resets; tells `crossing` of the crossings until it
/// says stop, or the end.
macro_rules! watching {
    ($guard:expr, $tolerance:expr) => {
        OdeBuilder::<Mat>::new()
            .rtol($tolerance)
            .atol([$tolerance, $tolerance])
            .rhs(|x, _p, _t, y| (y[0], y[1]) = (x[1], -x[0]))
            .init(|_p, _t, y| (y[0], y[1]) = (1.0, 0.0), 2)
            .root($guard, 1)
            .build()
    };
}

pub fn crossings() -> Entry {
    Entry::new(SOLVER, "tsit45", Events::Own, |tolerance| -> Solve {
        solving!(watching!(|x, _p, _t, g| g[0] = x[0], tolerance), |problem, log| {
            let mut solver = problem.tsit45().ok()?;
            while log.marks.len() < CROSSINGS {
                if let OdeSolverStopReason::RootFound(t, _) = solver.step().ok()? {
                    log.marks.push(t);
                }
            }
            Some(())
        })
    })
}

/// The crossings of zero of `g` along an oscillator's ten seconds.
pub fn watched(g: impl Fn(f64) -> f64, tolerance: f64) -> Vec<f64> {
    let mut times = Vec::new();
    let Ok(problem) = watching!(|_x: &[f64], _p: &[f64], t: f64, y: &mut [f64]| y[0] = g(t), tolerance) else {
        return times;
    };
    let Ok(mut solver) = problem.tsit45() else { return times };
    if solver.set_stop_time(10.0).is_ok() {
        loop {
            match solver.step() {
                Ok(OdeSolverStopReason::RootFound(t, _)) => times.push(t),
                Ok(OdeSolverStopReason::InternalTimestep) => {}
                _ => break,
            }
        }
    }
    times
}
