//! saltus.

use std::ops::ControlFlow;

use saltus::{About, Automaton, Coords, Edges, Entry, JumpOf, Limit, Observer, Refusal, Simulation, Solution, State as _, Stop};

use super::{Answer, Jumps, MOST_EVENTS, State, System, TOLERANCE};

/// Which guards are taken for positive, or rest.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Flow([bool; 2]),
    Rest,
}

struct Model<'a>(&'a System);

#[derive(Clone, Copy, PartialEq)]
struct Edge {
    guard: usize,
    above: [bool; 2],
}

impl std::fmt::Debug for Edge {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}", self.guard)
    }
}

impl Automaton for Model<'_> {
    type Mode = Mode;
    type State = State;
    type Edge = Edge;

    fn flow(&self, _: Mode, t: f64, x: &State) -> State {
        (self.0.flow)(t, x)
    }
    fn edges(&self, mode: Mode) -> Edges<'_, Edge> {
        match mode {
            Mode::Flow(above) => (0..self.0.guards.len()).map(|guard| Edge { guard, above }).collect(),
            Mode::Rest => Edges::none(),
        }
    }
    fn guard(&self, Edge { guard, above }: Edge, t: f64, x: &State) -> f64 {
        let g = (self.0.guards[guard])(t, x);
        if above[guard] { g } else { -g }
    }
    fn reset(&self, _: Mode, Edge { guard, mut above }: Edge, _t: f64, x: &State) -> Result<(Mode, State), Refusal> {
        Ok(match &self.0.jumps {
            Jumps::None(_) => {
                above[guard] = !above[guard];
                (Mode::Flow(above), *x)
            }
            Jumps::Reset { reset, .. } => (Mode::Flow(above), reset(guard, x, 0.0)),
        })
    }
    /// A ball on the floor is below a line above it, and that is no mistake.
    #[inline]
    fn about(&self, _: Edge) -> About {
        About::new().entry(Entry::Wait)
    }
    fn solution(&self, mode: Mode, _t: f64, x: &State) -> Solution<Self> {
        if mode == Mode::Rest { Solution::Polynomial([*x].into()) } else { Solution::Steps }
    }
    fn beyond(&self, _: &Limit<'_, Self>) -> Option<(Mode, State)> {
        match self.0.jumps {
            Jumps::Reset { rest: Some(rest), .. } => Some((Mode::Rest, rest)),
            _ => None,
        }
    }
}

impl Observer<Model<'_>> for Answer {
    fn jump(&mut self, jump: &JumpOf<Model<'_>>) -> ControlFlow<()> {
        self.events.extend(jump.edge().map(|edge| (edge.guard, jump.t())));
        ControlFlow::Continue(())
    }
}

pub fn run(system: &System) -> Answer {
    let mut answer = Answer::default();
    let model = Model(system);
    let [from, to] = system.span;
    let simulation = Simulation::of(&model)
        .tolerance(TOLERANCE)
        .absolute_tolerance(TOLERANCE)
        .longest_step(system.every.unwrap_or(f64::INFINITY))
        .most_jumps(MOST_EVENTS);
    let above = matches!(system.jumps, Jumps::None(true) | Jumps::Reset { .. });
    match simulation.drive(Mode::Flow([above; 2]), system.start, from..to, &mut answer) {
        Ok(end) => {
            answer.end = (end.time.seconds(), end.state);
            answer.error = (end.stop != Stop::Time).then(|| end.stop.to_string());
        }
        Err(error) => answer.error = Some(error.to_string()),
    }
    answer
}

/// One coordinate grows and is cut in two at x = 2: the number of coordinates at the end, and their
/// sum.
pub fn split_in_two() -> Result<(usize, f64), String> {
    struct Cell;
    impl Automaton for Cell {
        type Mode = usize;
        type State = Coords<2>;
        type Edge = ();
        fn flow(&self, _: usize, _t: f64, x: &Coords<2>) -> Coords<2> {
            *x
        }
        fn edges(&self, cells: usize) -> Edges<'_, ()> {
            if cells == 1 { Edges::from([()]) } else { Edges::none() }
        }
        fn guard(&self, (): (), _t: f64, x: &Coords<2>) -> f64 {
            2.0 - x[0]
        }
        fn reset(&self, _: usize, (): (), _t: f64, x: &Coords<2>) -> Result<(usize, Coords<2>), Refusal> {
            Ok((2, Coords::from([0.25 * x[0], 0.75 * x[0]])))
        }
    }
    let simulation = Simulation::of(&Cell).tolerance(TOLERANCE).absolute_tolerance(TOLERANCE);
    let end = simulation.drive(1, Coords::from([1.0]), 0.0..1.0, &mut ()).map_err(|error| error.to_string())?;
    Ok((end.mode, (0..end.state.len()).map(|i| end.state[i]).sum()))
}
