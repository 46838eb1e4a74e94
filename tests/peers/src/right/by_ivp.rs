//! ivp: events that are written down, or end the run, which is then begun again after the reset.

use ivp::prelude::{Direction, EventConfig, FirstOrderSystem, Ivp, Method};

use super::{Answer, Jumps, LIFT, State, System, TOLERANCE};

impl FirstOrderSystem for System {
    fn derivative(&self, t: f64, y: &[f64], dydt: &mut [f64]) {
        dydt.copy_from_slice(&(self.flow)(t, &state(y)));
    }
    fn events(&self, t: f64, y: &[f64], out: &mut [f64]) {
        for (out, guard) in out.iter_mut().zip(&self.guards) {
            *out = guard(t, &state(y));
        }
    }
    fn n_events(&self) -> usize {
        self.guards.len()
    }
    fn event_config(&self, _: usize) -> EventConfig {
        match self.jumps {
            Jumps::None(_) => EventConfig { direction: Direction::All, terminal_count: None },
            Jumps::Reset { .. } => EventConfig { direction: Direction::Negative, terminal_count: Some(1) },
        }
    }
}

fn state(y: &[f64]) -> State {
    [y[0], y[1], y[2], y[3]]
}

pub fn run(system: &System) -> Answer {
    let mut answer = Answer { end: (system.span[0], system.start), ..Answer::default() };
    loop {
        let (t, y) = answer.end;
        let mut arc = Ivp::first_order(system, t, system.span[1], &y)
            .method(Method::DOP853)
            .rtol(TOLERANCE)
            .atol(TOLERANCE)
            .max_steps(1_000_000);
        if let Some(every) = system.every {
            arc = arc.max_step(every).first_step(every);
        }
        let arc = match arc.solve() {
            Ok(arc) => arc,
            Err(error) => {
                answer.error = Some(format!("{error:?}"));
                return answer;
            }
        };
        if let (Some(&t), Some(y)) = (arc.t.last(), arc.y.last()) {
            answer.end = (t, state(y));
        }
        let mut events: Vec<_> =
            arc.t_events.iter().enumerate().flat_map(|(i, times)| times.iter().map(move |&t| (i, t))).collect();
        events.sort_by(|a, b| a.1.total_cmp(&b.1));
        answer.events.extend(&events);
        if !arc.status.is_success() {
            answer.error = Some(format!("{:?}", arc.status));
            return answer;
        }
        let Jumps::Reset { reset, .. } = &system.jumps else { return answer };
        let Some((guard, _)) = events.last() else { return answer };
        answer.end.1 = reset(*guard, &answer.end.1, LIFT);
        if answer.endless() || answer.end.0 >= system.span[1] {
            return answer;
        }
    }
}
