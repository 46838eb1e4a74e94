//! ode_solvers, which has no events.

use ode_solvers::dop_shared::{OutputType, System};
use ode_solvers::{Dop853, Dopri5, Vector4};

use super::contest::{Entry, Events, Solve};
use super::problems::arenstorf;

#[derive(Clone, Copy)]
struct Orbit;

impl System<f64, Vector4<f64>> for Orbit {
    #[inline]
    fn system(&self, _t: f64, y: &Vector4<f64>, dy: &mut Vector4<f64>) {
        *dy = Vector4::from(arenstorf::flow([y[0], y[1], y[2], y[3]]));
    }
}

pub fn orbit() -> [Entry; 2] {
    macro_rules! entry {
        ($solver:ident) => {
            Entry::new("ode_solvers", stringify!($solver), Events::None, |tolerance| -> Solve {
                Box::new(move |log| {
                    let start = Vector4::from(arenstorf::START);
                    let end = arenstorf::PERIOD;
                    let mut solver = $solver::new(Orbit, 0.0, end, end, start, tolerance, tolerance);
                    solver.set_output(OutputType::Sparse);
                    if let Ok(stats) = solver.integrate()
                        && let (Some(t), Some(y)) = (solver.x_out().last(), solver.y_out().last())
                    {
                        log.marks.extend([*t, y[0], y[1]]);
                        log.flows = u64::from(stats.num_eval);
                    }
                })
            })
        };
    }
    [entry!(Dop853), entry!(Dopri5)]
}
