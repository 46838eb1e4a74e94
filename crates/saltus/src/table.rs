//! The jumps of a run as rows of a table, and how tables are written.

use std::borrow::Cow;
use std::fmt;
use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::jump::{Cause, Jump, JumpOf};
use crate::observe::Observer;
use crate::state::State;
use crate::trajectory::Trajectory;

/// How many rows a table keeps at most: a gigabyte or so.
pub(crate) const MOST_ROWS: usize = 10_000_000;

/// Keeps the jumps of a run, and writes them as a table.
///
/// As an observer it keeps nothing else, so that a long run takes the memory of its table; more
/// than 10⁷ jumps end the run, with [`Stop::Observer`](crate::Stop::Observer). Written with `{}` it
/// is CSV, one row for each jump: when, the number of jumps with it, the edge, the modes, and the
/// state before and after, with the names and units of its coordinates ([`State::name`],
/// [`State::unit`]). A jump beyond an accumulation of jumps is by `limit`.
///
/// ```
/// use saltus::{Hybrid, JumpTable, Simulation};
/// let tank = Hybrid::new()
///     .exact("fill", |_t, x: &f64| [*x, 1.0].into())
///     .edge("fill", "fill", |_t, x| 1.25 - x, |_t, _x| 0.0)
///     .affine();
/// let mut table = JumpTable::new().named(["level (m)"]);
/// Simulation::of(&tank).drive("fill", 0.0, 0.0..3.0, &mut table)?;
/// assert_eq!(table.to_string(), "\
/// t (s),j,edge,from,to,level before (m),level after (m)
/// 1.25,1,fill -> fill (edge 0),fill,fill,1.25,0.0
/// 2.5,2,fill -> fill (edge 0),fill,fill,1.25,0.0
/// ");
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone)]
pub struct JumpTable<M, E, S> {
    jumps: Vec<Jump<M, E, S>>,
    names: Vec<String>,
    time: Cow<'static, str>,
}

/// The jumps of the automaton `A`.
pub type JumpTableOf<A> = JumpTable<<A as Automaton>::Mode, <A as Automaton>::Edge, <A as Automaton>::State>;

impl<M, E, S> Default for JumpTable<M, E, S> {
    fn default() -> Self {
        Self::new()
    }
}

impl<M, E, S> JumpTable<M, E, S> {
    /// Without a row yet.
    #[must_use]
    pub const fn new() -> Self {
        Self { jumps: Vec::new(), names: Vec::new(), time: Cow::Borrowed("s") }
    }

    /// Names the coordinates in the table, units in brackets at the end; those left over keep the
    /// names of the state.
    #[must_use]
    pub fn named<N: Into<String>>(mut self, names: impl IntoIterator<Item = N>) -> Self {
        self.names = names.into_iter().map(Into::into).collect();
        self
    }

    /// Names the unit of time, for a model whose rates are not per second: `h` heads its times
    /// `t (h)`.
    ///
    /// ```
    /// use saltus::JumpTable;
    /// let table = JumpTable::<(), (), f64>::new().time("h");
    /// assert_eq!(table.to_string(), "t (h),j,edge,from,to\n");
    /// ```
    #[must_use]
    pub fn time(mut self, unit: impl Into<Cow<'static, str>>) -> Self {
        self.time = unit.into();
        self
    }

    /// The rows in order.
    #[must_use]
    pub fn rows(&self) -> &[Jump<M, E, S>] {
        &self.jumps
    }
}

impl<A: Automaton> Observer<A> for JumpTableOf<A> {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        self.jumps.push(jump.clone());
        if self.jumps.len() < MOST_ROWS { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    }
}

impl<M: fmt::Debug, E: fmt::Debug, S: State> fmt::Debug for JumpTable<M, E, S> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(&self.jumps).finish()
    }
}

impl<M: fmt::Debug, E: fmt::Debug, S: State> fmt::Display for JumpTable<M, E, S> {
    /// As CSV. Where modes differ in dimension, the cells of coordinates that a state has not are
    /// empty.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let widest = [0, 1].map(|side| self.jumps.iter().map(|jump| limits(jump)[side]).max_by_key(|x| x.len()));
        write!(f, "{},j,edge,from,to", clock_heading(&self.time))?;
        for (state, side) in widest.iter().zip(["before", "after"]) {
            let Some(state) = state else { continue };
            for i in 0..state.len() {
                write!(f, ",{}", cell(&heading(&self.names, *state, i, side)))?;
            }
        }
        writeln!(f)?;
        for jump in &self.jumps {
            let edge = match &jump.cause {
                Cause::Edge(edge) => named(edge),
                Cause::Zeno => "limit".to_owned(),
            };
            let [from, to] = [&jump.from, &jump.to].map(|mode| cell(&named(mode)));
            write!(f, "{:?},{},{},{from},{to}", jump.t(), jump.j, cell(&edge))?;
            for (widest, state) in widest.iter().zip(limits(jump)) {
                numbers(f, state)?;
                let missing = widest.map_or(0, |widest| widest.len() - state.len());
                f.write_str(&",".repeat(missing))?;
            }
            writeln!(f)?;
        }
        Ok(())
    }
}

/// The state before and after.
fn limits<M, E, S>(jump: &Jump<M, E, S>) -> [&S; 2] {
    [&jump.before, &jump.after]
}

impl<M: Copy, E: Copy, S: State> Trajectory<M, E, S> {
    /// The jumps as a table: see [`JumpTable`].
    ///
    /// ```
    /// use saltus::{Hybrid, Simulation};
    /// let lamp = Hybrid::new()
    ///     .mode("dark", |_t, _x: &f64| 1.0)
    ///     .mode("lit", |_t, _x| 0.0)
    ///     .edge("dark", "lit", |_t, x| 1.0 - x, |_t, x| *x);
    /// let run = Simulation::of(&lamp).run("dark", 0.0, 0.0..3.0)?;
    /// let table = run.trajectory.jump_table().to_string();
    /// let rows: Vec<_> = table.lines().collect();
    /// assert_eq!(rows[0], "t (s),j,edge,from,to,x0 before,x0 after");
    /// assert!(rows.len() == 2 && rows[1].contains(",1,dark -> lit (edge 0),dark,lit,"));
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn jump_table(&self) -> JumpTable<M, E, S> {
        JumpTable { jumps: self.jumps().to_vec(), ..JumpTable::new() }
    }
}

/// The heading of times in this unit, which may be none.
pub(crate) fn clock_heading(unit: &str) -> String {
    if unit.is_empty() { "t".to_owned() } else { cell(&format!("t ({unit})")) }
}

/// The heading of coordinate `i`: as it is named, else by the state, with its unit in brackets;
/// `side` stands before the brackets.
pub(crate) fn heading(names: &[String], state: &impl State, i: usize, side: &str) -> String {
    let (name, unit) = match names.get(i) {
        Some(name) => match name.strip_suffix(')').and_then(|rest| rest.rsplit_once(" (")) {
            Some((name, unit)) => (name.to_owned(), unit),
            None => (name.clone(), ""),
        },
        None => (state.name(i).into_owned(), state.unit(i)),
    };
    let side = if side.is_empty() { String::new() } else { format!(" {side}") };
    if unit.is_empty() { format!("{name}{side}") } else { format!("{name}{side} ({unit})") }
}

/// The coordinates of a state, each after a comma, to the last digit.
pub(crate) fn numbers(f: &mut fmt::Formatter<'_>, state: &impl State) -> fmt::Result {
    (0..state.len()).try_for_each(|i| write!(f, ",{:?}", state.get(i)))
}

/// A mode or an edge in words: its `Debug`, without the quotes of a name that is text.
pub(crate) fn named(value: &impl fmt::Debug) -> String {
    let text = format!("{value:?}");
    match text.strip_prefix('"').and_then(|text| text.strip_suffix('"')) {
        Some(inner) => inner.replace("\\\"", "\"").replace("\\\\", "\\"),
        None => text,
    }
}

/// Text as a cell: in quotes where it needs them.
pub(crate) fn cell(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}
