//! What can go wrong in a run: what, where, and what to do.

use std::borrow::Cow;
use std::fmt;

use crate::state::State;

/// Why a run failed, with the time, mode, edge and state where it did. Written with `{}` or `{:?}`,
/// it is a sentence that says what to do.
///
/// ```
/// use saltus::{ErrorKind, Hybrid, Simulation};
/// let ball = Hybrid::new()
///     .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.81])
///     .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -x[1]]);
/// let error = Simulation::of(&ball).run("flight", [-0.1, 0.0], 0.0..1.0).unwrap_err().error;
/// assert_eq!((error.kind(), error.t(), error.state()), (ErrorKind::Entry, 0.0, &[-0.1, 0.0][..]));
/// assert!(error.to_string().starts_with("the guard of edge flight -> flight (edge 0) is already negative"));
/// ```
#[derive(Clone, PartialEq)]
pub struct Error(Box<Failure>);

/// Boxed, so that what goes well is not moved about in the room that a failure would need.
#[derive(Clone, Debug, PartialEq)]
struct Failure {
    kind: ErrorKind,
    place: Place,
    note: Option<Box<str>>,
}

/// Where a run failed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Place {
    pub(crate) t: f64,
    pub(crate) mode: String,
    pub(crate) edge: Option<String>,
    pub(crate) state: Vec<f64>,
    /// The names of the coordinates, where the state gives them.
    names: Vec<Cow<'static, str>>,
}

impl Place {
    pub(crate) fn new(t: f64, mode: impl fmt::Debug, edge: Option<impl fmt::Debug>, state: &impl State) -> Self {
        Self {
            t,
            mode: format!("{mode:?}"),
            edge: edge.map(|edge| format!("{edge:?}")),
            state: (0..state.len()).map(|i| state.get(i)).collect(),
            names: (0..state.len()).map(|i| state.name(i)).filter(|name| is_given(name)).collect(),
        }
    }
}

/// Whether a coordinate has a name of its own, and not that of its place.
fn is_given(name: &str) -> bool {
    !name.strip_prefix('x').is_some_and(|place| place.bytes().all(|digit| digit.is_ascii_digit()))
}

/// A state as a list of its coordinates, with the names that it gives them.
#[cold]
pub(crate) fn listed(state: &impl State) -> String {
    let Place { state, names, .. } = Place::new(0.0, (), None::<()>, state);
    written(&state, &names)
}

/// So many coordinates of a state are written, and of more how many there are.
const WRITTEN: usize = 12;

fn written(state: &[f64], names: &[Cow<'static, str>]) -> String {
    let named = !names.is_empty() && names.len() == state.len();
    let each = state.iter().enumerate();
    let item =
        |(i, value): (usize, &f64)| if named { format!("{} = {value:?}", names[i]) } else { format!("{value:?}") };
    let list = first_of(state.len(), &mut each.map(item));
    if named { format!("({list})") } else { format!("[{list}]") }
}

/// Which coordinates of a flow are not finite.
#[cold]
pub(crate) fn not_finite(state: &impl State) -> String {
    let wrong = || (0..state.len()).filter(|&i| !state.get(i).is_finite());
    first_of(wrong().count(), &mut wrong().map(|i| format!("{}' = {}", state.name(i), state.get(i))))
}

/// The first of so many coordinates, and of more how many there are.
fn first_of(count: usize, each: &mut dyn Iterator<Item = String>) -> String {
    let all = (count > WRITTEN).then(|| format!("… {count} coordinates"));
    each.take(WRITTEN).chain(all).collect::<Vec<_>>().join(", ")
}

/// The kinds of failure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// The span runs backwards or is not a number.
    Span,
    /// The tolerances are not positive finite numbers.
    Tolerance,
    /// The first or the longest step asked for is not above zero.
    StepLimit,
    /// The initial state is not finite.
    InitialState,
    /// The automaton contradicts itself, or has no such mode: see
    /// [`Automaton::validate`](crate::Automaton::validate).
    Model,
    /// A clock cannot tick: see [`Clock`](crate::Clock).
    Clock,
    /// A tick whose time may depend on a parameter, where a derivative by it was asked for and that
    /// of the time is not given: see `Linearize::tick_over`.
    ClockDerivative,
    /// The flow has not as many coordinates as the state.
    Dimension,
    /// The series or exact solution is that of another flow: it does not start from the state with
    /// the flow's slope.
    Series,
    /// The pattern of the flow's Jacobian leaves out an entry, or is of another number of
    /// coordinates: see [`Sparsity`](crate::Sparsity).
    Sparsity,
    /// The flow is not finite, however short the step.
    Flow,
    /// The guard is not a number.
    Guard,
    /// A guard is promised affine, and is not: see [`About::affine`](crate::About::affine).
    Promise,
    /// The reset gave a state that is not finite.
    Reset,
    /// The flow, a guard or a reset refused, with a reason: see [`Refusal`].
    Refused,
    /// A guard is already negative as its mode is entered, and its edge refuses that.
    Entry,
    /// A crossing without speed, where derivatives were asked for: they do not exist there.
    Grazing,
    /// The step size fell below the spacing of time.
    StepSize,
    /// The run ended before it was to, and completeness was asked for: see
    /// [`Run::complete`](crate::Run::complete).
    Unfinished,
}

impl Error {
    #[cold]
    pub(crate) fn new(kind: ErrorKind, place: Place) -> Self {
        Self(Box::new(Failure { kind, place, note: None }))
    }

    /// With what its kind and place do not say.
    pub(crate) fn noting(mut self, note: Option<String>) -> Self {
        self.0.note = note.map(String::into_boxed_str);
        self
    }

    /// What kind of failure it is.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// When it happened, in seconds.
    #[must_use]
    pub fn t(&self) -> f64 {
        self.0.place.t
    }

    /// The mode it happened in, as its `Debug` writes it.
    #[must_use]
    pub fn mode(&self) -> &str {
        &self.0.place.mode
    }

    /// The edge concerned, if any, as its `Debug` writes it.
    #[must_use]
    pub fn edge(&self) -> Option<&str> {
        self.0.place.edge.as_deref()
    }

    /// The state it happened at, coordinate by coordinate; of a jump, the state just before.
    #[must_use]
    pub fn state(&self) -> &[f64] {
        &self.0.place.state
    }
}

impl fmt::Display for Error {
    /// What is wrong and what to do; of a run that had begun, with time, mode and state.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Failure { kind, place, note } = &*self.0;
        let note = note.as_deref();
        match kind {
            ErrorKind::Span | ErrorKind::Tolerance | ErrorKind::StepLimit => {
                return asked(f, *kind, note.unwrap_or("?"));
            }
            ErrorKind::Model if place.edge.is_none() => return f.write_str(note.unwrap_or("?")),
            ErrorKind::Refused => f.write_str(note.unwrap_or("?"))?,
            ErrorKind::InitialState
            | ErrorKind::Dimension
            | ErrorKind::Series
            | ErrorKind::Sparsity
            | ErrorKind::Flow
            | ErrorKind::StepSize
            | ErrorKind::Unfinished => on_the_way(f, *kind, note, place.state.len())?,
            _ => of_edge(f, *kind, note, place.edge.as_deref())?,
        }
        let Place { t, mode, state, names, .. } = place;
        write!(f, " (t = {t}, mode {mode}, state {})", written(state, names))
    }
}

/// What is wrong with what a run was asked for.
fn asked(f: &mut fmt::Formatter<'_>, kind: ErrorKind, given: &str) -> fmt::Result {
    match kind {
        ErrorKind::Span => write!(
            f,
            "the span {given} does not run forwards from a finite time: give start..end with start <= end and a start within 1e300 s; to run backwards, implement Invertible and run Reversed"
        ),
        ErrorKind::Tolerance => write!(
            f,
            "the tolerances ({given}) cannot be kept: relative must be at least 1e-15 and below 1, absolute finite and above zero"
        ),
        _ => write!(
            f,
            "a step cannot have this size ({given}): give Simulation::first_step and Simulation::longest_step durations above zero, or leave them out"
        ),
    }
}

/// What is wrong with a state or a flow, of so many coordinates.
fn on_the_way(f: &mut fmt::Formatter<'_>, kind: ErrorKind, note: Option<&str>, coordinates: usize) -> fmt::Result {
    match kind {
        ErrorKind::InitialState => f.write_str("the initial state is not finite: give finite coordinates"),
        ErrorKind::Dimension => write!(
            f,
            "the flow gives {} and the state has {coordinates} coordinates: give both as many in this mode, here and in the resets that lead to it",
            note.unwrap_or("?")
        ),
        ErrorKind::Series => f.write_str(
            "the series or exact solution is not that of the flow, from the state and with its slope: write the same flow in Automaton::solution and Automaton::flow, or in series or exact and mode of a Hybrid",
        ),
        ErrorKind::Sparsity => write!(
            f,
            "the sparsity of the mode {}: give all that the flow reads, in Automaton::solution or Hybrid::sparse, or let Sparsity::found look for it",
            note.unwrap_or("?")
        ),
        ErrorKind::Flow => {
            let which = note.map_or(String::new(), |which| format!(" ({which})"));
            write!(
                f,
                "the flow is not finite{which}, however short the step: the solution may grow without bound, or the flow divide by zero or take a root of a negative number near this state"
            )
        }
        ErrorKind::Unfinished => write!(f, "the run ended before it was to: {}", note.unwrap_or("?")),
        _ => f.write_str(
            "the step size fell below the spacing of time: the solution may blow up, or the flow jump: let it jump in time at a stop (Hybrid::stops), in the state between two modes; or time is too coarse for the tolerance: loosen it, or count time from nearer by",
        ),
    }
}

/// What is wrong with an edge: its clock, its guard or its reset.
fn of_edge(f: &mut fmt::Formatter<'_>, kind: ErrorKind, note: Option<&str>, edge: Option<&str>) -> fmt::Result {
    let (given, by) = (note.unwrap_or("?"), edge.unwrap_or("?"));
    match kind {
        ErrorKind::Clock => match edge {
            Some(edge) => write!(f, "the clock of edge {edge} {given}"),
            None => write!(f, "the clock of the stops {given}"),
        },
        ErrorKind::ClockDerivative => write!(
            f,
            "edge {by} is taken by a clock, and how its time depends on the parameters is not given: say it in Linearize::tick_over, also that it does not"
        ),
        ErrorKind::Guard => {
            write!(f, "the guard of edge {by} is not a number: define it on the whole domain, or end the mode before")
        }
        ErrorKind::Promise => {
            write!(f, "the guard of edge {by} is promised {given}; leave the promise out (About::affine, About::reads)")
        }
        ErrorKind::Reset => {
            let by = edge.map_or("Automaton::beyond".to_owned(), |edge| format!("the reset of edge {edge}"));
            write!(
                f,
                "{by} gave {given}, which is not finite: check it for division by zero or roots of negative numbers at this state"
            )
        }
        ErrorKind::Entry if note.is_some() => write!(
            f,
            "the guard of edge {by} {given}: let the reset turn the motion round or lead to another mode, or let About::entry or Hybrid::entry say Wait, for an edge that counts passages"
        ),
        ErrorKind::Entry => write!(
            f,
            "the guard of edge {by} is already negative as the mode is entered: correct the state or the reset that led to it, or the guard's sign (it is positive while the edge is not due), or let About::entry or Hybrid::entry say Wait or Fire"
        ),
        ErrorKind::Grazing => write!(
            f,
            "edge {by} is crossed without speed (its guard's rate is zero to rounding), where the jump has no derivative: change the initial state or a parameter a little, or run without sensitivities"
        ),
        _ => write!(f, "the reset of edge {by} {given}"),
    }
}

/// The sentence, which is what a `main` shows that returns the error; `{:#?}` shows the parts.
impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() { self.0.fmt(f) } else { write!(f, "{self}") }
    }
}

impl std::error::Error for Error {}

/// Why a reset gives no state, or a flow or a guard no number: what
/// [`Automaton::reset`](crate::Automaton::reset) answers in place of a state,
/// [`Automaton::refusal`](crate::Automaton::refusal) where it is asked, and the closures of
/// [`Hybrid::fallible`](crate::Hybrid::fallible) and [`Edge::fallible`](crate::Edge::fallible). The
/// run fails with an [`Error`] that says it, with time, mode, edge and state.
///
/// Any error becomes one by `?`.
///
/// ```
/// use saltus::{Automaton, Edges, ErrorKind, Refusal, Simulation};
///
/// /// A tank of 2 L whose valve is stuck.
/// struct Tank;
///
/// impl Automaton for Tank {
///     type Mode = ();
///     type State = f64;
///     type Edge = ();
///     fn flow(&self, (): (), _t: f64, _x: &f64) -> f64 {
///         0.5
///     }
///     fn edges(&self, (): ()) -> Edges<'_, ()> {
///         Edges::from([()])
///     }
///     fn guard(&self, (): (), _t: f64, x: &f64) -> f64 {
///         2.0 - x
///     }
///     fn reset(&self, (): (), (): (), _t: f64, _x: &f64) -> Result<((), f64), Refusal> {
///         Err(Refusal::new("the valve is stuck"))
///     }
/// }
///
/// let error = Simulation::of(&Tank).run((), 0.0, 0.0..9.0).unwrap_err().error;
/// assert_eq!(error.kind(), ErrorKind::Refused);
/// assert!((error.t() - 4.0).abs() < 1e-12);
/// assert!(error.to_string().starts_with("the reset of edge () refused: the valve is stuck"));
/// ```
pub struct Refusal(Box<(ErrorKind, String)>);

impl Refusal {
    /// With what keeps it from an answer, as the end of a sentence.
    #[cold]
    #[must_use]
    pub fn new(why: impl fmt::Display) -> Self {
        Self(Box::new((ErrorKind::Refused, why.to_string())))
    }

    /// Of a kind of its own.
    #[cold]
    #[cfg(feature = "num-dual")]
    pub(crate) fn of(kind: ErrorKind) -> Self {
        Self(Box::new((kind, String::new())))
    }

    /// The failure of a run whose flow, guard or reset (`what`) refused at this place.
    #[cold]
    pub(crate) fn at(self, what: &str, place: Place) -> Error {
        let (kind, why) = *self.0;
        let by = place.edge.as_ref().map_or(String::new(), |edge| format!(" of edge {edge}"));
        Error::new(kind, place).noting(Some(format!("the {what}{by} refused: {why}")))
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.1)
    }
}

impl fmt::Debug for Refusal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}: {}", self.0.0, self.0.1)
    }
}

impl<E: std::error::Error> From<E> for Refusal {
    fn from(error: E) -> Self {
        Self::new(error)
    }
}
