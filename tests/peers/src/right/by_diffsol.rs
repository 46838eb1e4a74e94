//! diffsol: roots that are written down, or moved back to and reset.

use std::cell::Cell;
use std::rc::Rc;

use diffsol::{NalgebraMat, OdeBuilder, OdeSolverMethod, OdeSolverStopReason, VectorCommon};

use super::{Answer, Jumps, LIFT, State, System, TOLERANCE};

fn state(y: &[f64]) -> State {
    [y[0], y[1], y[2], y[3]]
}

pub fn run(system: &System) -> Answer {
    let mut answer = Answer { end: (system.span[0], system.start), ..Answer::default() };
    if let Err(error) = roots(system, &mut answer) {
        answer.error = Some(error.to_string());
    }
    answer
}

fn roots(system: &System, answer: &mut Answer) -> Result<(), diffsol::error::DiffsolError> {
    let taken = Rc::new(Cell::new(0));
    let which = Rc::clone(&taken);
    let [from, to] = system.span;
    let mut builder = OdeBuilder::<NalgebraMat<f64>>::new().t0(from).rtol(TOLERANCE).atol([TOLERANCE; 4]);
    if let Some(every) = system.every {
        builder = builder.h0(every);
    }
    let mut problem = builder
        .rhs(|x: &[f64], _p: &[f64], t: f64, y: &mut [f64]| y.copy_from_slice(&(system.flow)(t, &state(x))))
        .init(|_p: &[f64], _t: f64, y: &mut [f64]| y.copy_from_slice(&system.start), 4)
        .root(
            |x: &[f64], _p: &[f64], t: f64, g: &mut [f64]| {
                for (g, guard) in g.iter_mut().zip(&system.guards) {
                    *g = guard(t, &state(x));
                }
            },
            system.guards.len(),
        )
        .reset(|x: &[f64], _p: &[f64], _t: f64, y: &mut [f64]| {
            let x = state(x);
            y.copy_from_slice(&match &system.jumps {
                Jumps::Reset { reset, .. } => reset(which.get(), &x, LIFT),
                Jumps::None(_) => x,
            });
        })
        .build()?;
    if system.every.is_some() {
        problem.ode_options.max_timestep_growth = Some(1.0);
    }
    let mut solver = problem.tsit45()?;
    solver.set_stop_time(to)?;
    loop {
        let reason = solver.step()?;
        if let OdeSolverStopReason::RootFound(t, guard) = reason {
            answer.events.push((guard, t));
            if let Jumps::Reset { .. } = system.jumps {
                taken.set(guard);
                solver.state_mut_back(t)?;
                solver.apply_reset()?;
            }
        }
        answer.end = (solver.state().t, state(solver.state().y.inner().as_slice()));
        // Its own `solve` ends at a root on the end of the span too.
        let done = reason == OdeSolverStopReason::TstopReached || answer.end.0 >= to;
        if done || answer.endless() {
            return Ok(());
        }
        if let (OdeSolverStopReason::RootFound(..), Jumps::Reset { .. }) = (reason, &system.jumps) {
            solver.set_stop_time(to)?;
        }
    }
}
