//! russell_ode with its own linear algebra; it has no events.

use russell_lab::Vector;
use russell_ode::{Method, NoArgs, OdeSolver, Params, System};
use russell_sparse::{CooMatrix, Sym};

use super::contest::{Entry, Events, Log, Solve};
use super::problems::{arenstorf, van_der_pol};

fn entry(
    name: &'static str,
    method: Method,
    system: fn() -> System<'static, NoArgs>,
    start: &'static [f64],
    end: f64,
) -> Entry {
    Entry::new("russell_ode", name, Events::None, move |tolerance| -> Solve {
        let mut params = Params::new(method);
        let taken = params.set_tolerances(tolerance, tolerance, None);
        let solver = taken.and_then(|()| OdeSolver::new(params, system()));
        let Ok(mut solver) = solver else { return Box::new(|_: &mut Log| {}) };
        Box::new(move |log| {
            let mut y = Vector::from(&start);
            if solver.solve(&mut y, 0.0, end, None, &mut 0, None).is_ok() {
                log.marks.extend([end, y[0], y[1]]);
                log.flows = solver.stats().n_function as u64;
            }
        })
    })
}

fn orbiting() -> System<'static, NoArgs> {
    System::new(4, |f: &mut Vector, _t: f64, y: &Vector, _: &mut NoArgs| {
        f.as_mut_data().copy_from_slice(&arenstorf::flow([y[0], y[1], y[2], y[3]]));
        Ok(())
    })
}

fn oscillating() -> System<'static, NoArgs> {
    let mut system = System::new(2, |f: &mut Vector, _t: f64, y: &Vector, _: &mut NoArgs| {
        f.as_mut_data().copy_from_slice(&van_der_pol::flow([y[0], y[1]]));
        Ok(())
    });
    let jacobian = |j: &mut CooMatrix, alpha: f64, _t: f64, y: &Vector, _: &mut NoArgs| {
        let [a, b] = van_der_pol::slopes([y[0], y[1]]);
        j.reset();
        j.put(0, 1, alpha)?;
        j.put(1, 0, alpha * a)?;
        j.put(1, 1, alpha * b)
    };
    let _ = system.set_jacobian(Some(3), Sym::No, jacobian);
    system
}

pub fn orbit() -> Entry {
    entry("DoPri8", Method::DoPri8, orbiting, &arenstorf::START, arenstorf::PERIOD)
}

pub fn stiff() -> Entry {
    entry("Radau5", Method::Radau5, oscillating, &van_der_pol::START, van_der_pol::END)
}
