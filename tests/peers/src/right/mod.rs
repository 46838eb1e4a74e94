//! Right or wrong: the same hybrid system for each solver that finds events itself, and what each
//! makes of it.

mod by_differential_equations;
mod by_diffsol;
mod by_ivp;
mod by_saltus;
pub mod cases;

/// A state; what a system does not need stays zero.
pub type State = [f64; 4];

type Flow = Box<dyn Fn(f64, &State) -> State>;
type Guard = Box<dyn Fn(f64, &State) -> f64>;
type Reset = Box<dyn Fn(usize, &State, f64) -> State>;

/// A hybrid system with one flow.
pub struct System {
    pub start: State,
    pub span: [f64; 2],
    pub flow: Flow,
    pub guards: Vec<Guard>,
    pub jumps: Jumps,
    /// The length of every step.
    pub every: Option<f64>,
}

/// What happens at an event.
pub enum Jumps {
    /// It is written down, whether its guard falls or rises. True if the guard is to be taken for
    /// positive at the start.
    None(bool),
    /// Where guard `i` falls the state becomes reset(i, state, lift). The lift is for solvers that
    /// need a hair's distance from the guard just met: 1e-12 for the others, 0 for saltus. `rest`
    /// is what lies beyond infinitely many jumps, for solvers that take it.
    Reset { reset: Reset, rest: Option<State> },
}

/// What a solver says.
#[derive(Debug, Default)]
pub struct Answer {
    /// Which guard, and when.
    pub events: Vec<(usize, f64)>,
    /// The time reached, and the state there.
    pub end: (f64, State),
    /// Its error, if it ended with one.
    pub error: Option<String>,
}

impl Answer {
    /// Whether so many events that nobody will ask for more.
    fn endless(&self) -> bool {
        self.events.len() >= MOST_EVENTS
    }
}

/// Who looks for more events than this has lost its way.
pub const MOST_EVENTS: usize = 200_000;
/// The relative and absolute tolerance of every run.
pub const TOLERANCE: f64 = 1e-10;
/// The hair's distance.
const LIFT: f64 = 1e-12;

/// A solver, by its adapter.
pub struct Solver {
    pub name: &'static str,
    pub method: &'static str,
    pub run: fn(&System) -> Answer,
}

pub const SOLVERS: [Solver; 4] = [
    Solver { name: "saltus", method: "Auto", run: by_saltus::run },
    Solver { name: "diffsol", method: "tsit45", run: by_diffsol::run },
    Solver { name: "differential-equations", method: "dopri5", run: by_differential_equations::run },
    Solver { name: "ivp", method: "DOP853", run: by_ivp::run },
];

pub use by_saltus::split_in_two;
