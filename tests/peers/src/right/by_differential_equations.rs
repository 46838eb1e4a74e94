//! differential-equations: one event watched after the other, each ending the run, which is then
//! begun again after the reset.

use differential_equations::ode::ODE;
use differential_equations::prelude::{
    CrossingDirection, Event, EventConfig, ExplicitRungeKutta, IVP, Solution, Status,
};
use differential_equations::solout::EventSolout;

use super::{Answer, Jumps, LIFT, State, System, TOLERANCE};

impl ODE<f64, State> for System {
    fn diff(&self, t: f64, y: &State, dydt: &mut State) {
        *dydt = (self.flow)(t, y);
    }
}

/// One guard, whose fall ends the run.
struct Watch<'a>(&'a System, usize);

impl Event<f64, State> for Watch<'_> {
    fn config(&self) -> EventConfig {
        match self.0.jumps {
            Jumps::None(_) => EventConfig::default(),
            Jumps::Reset { .. } => EventConfig::default().direction(CrossingDirection::Negative).terminal(),
        }
    }
    fn event(&self, t: f64, y: &State) -> f64 {
        (self.0.guards[self.1])(t, y)
    }
}

pub fn run(system: &System) -> Answer {
    let mut answer = Answer { end: (system.span[0], system.start), ..Answer::default() };
    loop {
        let (t, y) = answer.end;
        let arc = match arc(system, t, y) {
            Ok(arc) => arc,
            Err(error) => {
                answer.error = Some(error);
                return answer;
            }
        };
        if let (Some(&t), Some(&y)) = (arc.t.last(), arc.y.last()) {
            answer.end = (t, y);
        }
        let Jumps::Reset { reset, .. } = &system.jumps else {
            // Nothing but events is in the solution.
            answer.events = arc.t.iter().map(|&t| (0, t)).collect();
            answer.end.0 = if arc.status == Status::Complete { system.span[1] } else { t };
            return answer;
        };
        if arc.status != Status::Interrupted {
            return answer;
        }
        let (t, y) = answer.end;
        // The solver does not name it: the one nearest to zero.
        let value = |&i: &usize| (system.guards[i])(t, &y).abs();
        let guard = (0..system.guards.len()).min_by(|a, b| value(a).total_cmp(&value(b))).unwrap_or(0);
        answer.events.push((guard, t));
        answer.end.1 = reset(guard, &y, LIFT);
        if answer.endless() || t >= system.span[1] {
            return answer;
        }
    }
}

fn arc(system: &System, t: f64, y: State) -> Result<Solution<f64, State>, String> {
    let mut method = ExplicitRungeKutta::dopri5().rtol(TOLERANCE).atol(TOLERANCE).max_steps(1_000_000);
    if let Some(every) = system.every {
        method = method.h0(every).h_max(every);
    }
    let end = system.span[1];
    let (first, second) = (Watch(system, 0), Watch(system, 1));
    let problem = IVP::ode(system, t, end, y);
    let run = match (&system.jumps, system.guards.len()) {
        (Jumps::None(_), _) => problem.solout(EventSolout::new(&first, t, end)).method(method).solve(),
        (_, 1) => problem.event(&first).method(method).solve(),
        _ => problem.event(&first).event(&second).method(method).solve(),
    };
    run.map_err(|error| format!("{error:?}"))
}
