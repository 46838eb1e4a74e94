//! Which coordinates of a flow read which of the state: the pattern of its Jacobian.

use std::borrow::Cow;
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use crate::state::State;

/// The entries of the Jacobian ∂f/∂x of a flow that may be other than zero: coordinate i of x' =
/// f(t, x) reads coordinate j of x.
///
/// [`Rodas5P`](crate::Rodas5P) then takes the Jacobian from two evaluations of the flow for each
/// *colour* in place of each coordinate (columns that share no row have one colour), and solves a
/// band. Of n coordinates of which each reads those up to b places before and behind, a step takes
///
/// | | with the pattern | without |
/// |---|---|---|
/// | evaluations of the flow | 4 b + 12 | 2 n + 10 |
/// | operations | (4 b² + 80 b) n | ⅔ n³ + 20 n² |
/// | numbers kept | 3 b n | n² |
///
/// A wide band is solved as a sparse system with the feature `sparse`. Explicit methods have no use
/// for the pattern.
///
/// Given by [`Solution::Sparse`](crate::Solution::Sparse), or by
/// [`Hybrid::sparse`](crate::Hybrid::sparse).
///
/// ```
/// use saltus::{Hybrid, Simulation, Sparsity, Vector};
/// // A rod of a hundred cells, at 0 and 1 at its ends: u' = u'' on a grid.
/// let n = 100;
/// let flow = move |_t: f64, u: &Vector| Vector::from_fn(n, |i| {
///     let left = if i == 0 { 0.0 } else { u[i - 1] };
///     let right = if i + 1 == n { 1.0 } else { u[i + 1] };
///     (left - 2.0 * u[i] + right) * ((n + 1) * (n + 1)) as f64
/// });
/// let rod = Hybrid::new().mode("heat", flow).sparse("heat", Sparsity::banded(n, 1, 1));
/// let run = Simulation::of(&rod).tolerance(1e-6).run("heat", vec![0.0; n].into(), 0.0..3.0)?;
/// assert!((run.end.state[49] - 50.0 / 101.0).abs() < 1e-5);
/// let stats = run.end.stats;
/// assert!(stats.flows < 20 * (stats.steps + stats.rejected)); // without the pattern, above 200
///
/// // Found where it is not given, from two hundred evaluations or fewer.
/// let start = Vector::from_fn(n, |i| i as f64);
/// assert_eq!(Sparsity::found(&start, |u| flow(0.0, u)), Sparsity::banded(n, 1, 1));
/// # Ok::<(), saltus::Error>(())
/// ```
///
/// Source: A. Curtis, M. Powell, J. Reid, *On the estimation of sparse Jacobian matrices*, J. Inst.
/// Maths Applics 13 (1974) 117–119, doi:10.1093/imamat/13.1.117.
///
/// # Limits
/// A pattern that leaves out an entry is an error
/// ([`ErrorKind::Sparsity`](crate::ErrorKind::Sparsity)) that names it, where the flow near the
/// start of an arc shows it; arcs are looked at as promises are, see
/// [`About::affine`](crate::About::affine). Entries that are zero only make a step dearer.
///
/// A coordinate that reads all the others leaves each column a colour of its own: the Jacobian then
/// takes as many evaluations as without a pattern. Up to 16 coordinates are solved as if there were
/// none.
#[derive(Clone)]
pub struct Sparsity(Arc<Pattern>);

struct Pattern {
    /// The rows of each column, in rising order.
    columns: Lists,
    /// The columns of each colour: no two of them share a row.
    colours: Lists,
    /// How far entries are below and above the diagonal at most.
    below: usize,
    above: usize,
    /// The order of elimination, once a step has asked for it.
    #[cfg(feature = "sparse")]
    order: std::sync::OnceLock<Option<Elimination>>,
}

/// In which order the columns of a pattern are eliminated, and what is filled in by that.
#[cfg(feature = "sparse")]
pub(crate) type Elimination = faer::sparse::linalg::solvers::SymbolicLu<usize>;

impl Sparsity {
    /// Of `n` coordinates each reads itself, those up to `below` places before it, and those up to
    /// `above` places behind it: a band of so many diagonals below and above the main one.
    ///
    /// ```
    /// use saltus::Sparsity;
    /// assert_eq!(Sparsity::banded(3, 1, 0), Sparsity::rows([vec![0], vec![0, 1], vec![1, 2]]));
    /// ```
    #[must_use]
    pub fn banded(n: usize, below: usize, above: usize) -> Self {
        Self::rows((0..n).map(|i| i.saturating_sub(below)..(i.saturating_add(above).saturating_add(1)).min(n)))
    }

    /// The pattern by rows: for each coordinate of the flow, in turn, the coordinates of the state
    /// that it reads, in any order; itself it may read in any case.
    ///
    /// ```
    /// use saltus::Sparsity;
    /// // Masses in a ring, each coupled to its neighbours.
    /// let n = 50;
    /// let ring = Sparsity::rows((0..n).map(|i| [(i + n - 1) % n, i, (i + 1) % n]));
    /// assert_eq!(ring.len(), n);
    /// ```
    ///
    /// Coordinates beyond the number of rows do not exist, and are an error as a run starts.
    #[must_use]
    pub fn rows(rows: impl IntoIterator<Item = impl IntoIterator<Item = usize>>) -> Self {
        let mut entries = Vec::new();
        let mut n = 0;
        for (i, row) in rows.into_iter().enumerate() {
            n = i + 1;
            entries.extend(row.into_iter().chain([i]).map(|j| (j, i)));
        }
        let columns = Lists::of(n.max(entries.iter().map(|&(j, _)| j + 1).max().unwrap_or(0)), entries);
        let rows = columns.turned(columns.len());
        let colours = coloured(&columns, &rows);
        let spread = |far: fn(usize, usize) -> usize| {
            columns.iter().enumerate().flat_map(|(j, rows)| rows.iter().map(move |&i| far(i, j))).max().unwrap_or(0)
        };
        let (below, above) = (spread(|i, j| i.saturating_sub(j)), spread(|i, j| j.saturating_sub(i)));
        Self(Arc::new(Pattern {
            columns,
            colours,
            below,
            above,
            #[cfg(feature = "sparse")]
            order: std::sync::OnceLock::new(),
        }))
    }

    /// The pattern of a flow, from what it answers near `x`: which coordinates change with which.
    ///
    /// Groups of coordinates are moved together, and halved: the evaluations grow with how many
    /// coordinates one reads, and with the logarithm of how many there are. What the flow does not
    /// read near `x`, behind a switch that is off there, is not found.
    #[must_use]
    pub fn found<S: State>(x: &S, mut flow: impl FnMut(&S) -> S) -> Self {
        Self::of_flow(&listed(x), &mut |list| listed(&flow(&x.with(|i| list[i]))))
    }

    fn of_flow(x: &[f64], flow: Flow<'_>) -> Self {
        let n = x.len();
        let [here, there] = two_near(x);
        let base = flow(&here);
        // Of each row the blocks of columns that it may read: of one, of two, of four, …
        let (mut blocks, mut reads) = (vec![(0, n)], vec![vec![0_usize]; n]);
        loop {
            let rows = Lists::of(n, reads.iter().enumerate().flat_map(|(i, row)| row.iter().map(move |&b| (i, b))));
            let colours = coloured(&rows.turned(blocks.len()), &rows);
            let mut kept = vec![Vec::new(); n];
            for of_colour in colours.iter() {
                let mut moves = vec![None; n];
                for &b in of_colour {
                    moves[blocks[b].0..blocks[b].1].fill(Some(b));
                }
                let changed = flow(&mixed(&here, &there, |j| moves[j].is_some()));
                for (i, kept) in kept.iter_mut().enumerate() {
                    if changed[i].to_bits() != base[i].to_bits() {
                        kept.extend(reads[i].iter().filter(|&&b| moves.get(blocks[b].0) == Some(&Some(b))));
                    }
                }
            }
            if blocks.iter().all(|&(from, to)| to <= from + 1) {
                return Self::rows(kept.iter().map(|row: &Vec<usize>| row.iter().map(|&b| blocks[b].0)));
            }
            // The larger half first: a block of one is followed by one of none.
            let halves =
                |&(from, to): &(usize, usize)| [(from, (from + to).div_ceil(2)), ((from + to).div_ceil(2), to)];
            blocks = blocks.iter().flat_map(halves).collect();
            reads = kept.iter().map(|row| row.iter().flat_map(|&b| [2 * b, 2 * b + 1]).collect()).collect();
        }
    }

    /// How many coordinates the state has.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.columns.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// How far entries are below and above the diagonal at most.
    pub(crate) fn band(&self) -> (usize, usize) {
        (self.0.below, self.0.above)
    }

    /// How many entries there are.
    #[cfg(feature = "sparse")]
    pub(crate) fn entries(&self) -> usize {
        self.0.columns.items.len()
    }

    /// Its entries, column by column, with these `values`.
    #[cfg(feature = "sparse")]
    pub(crate) fn with<'a>(&'a self, values: &'a [f64]) -> faer::sparse::SparseColMatRef<'a, usize, f64> {
        faer::sparse::SparseColMatRef::new(self.shape(), values)
    }

    #[cfg(feature = "sparse")]
    fn shape(&self) -> faer::sparse::SymbolicSparseColMatRef<'_, usize> {
        let Lists { starts, items } = &self.0.columns;
        faer::sparse::SymbolicSparseColMatRef::new_checked(self.len(), self.len(), starts, None, items)
    }

    /// In which order its columns are eliminated; none where memory does not suffice.
    #[cfg(feature = "sparse")]
    pub(crate) fn order(&self) -> Option<&Elimination> {
        self.0.order.get_or_init(|| Elimination::try_new(self.shape()).ok()).as_ref()
    }

    /// The columns of each colour.
    pub(crate) fn colours(&self) -> impl Iterator<Item = &[usize]> {
        self.0.colours.iter()
    }

    /// The rows of a column, and which entry of all the first of them is.
    pub(crate) fn column(&self, j: usize) -> (&[usize], usize) {
        (self.0.columns.get(j), self.0.columns.starts[j])
    }

    /// What is wrong with it as the pattern of a flow at `x`, whose coordinates have names: of
    /// another length or, where the flow is to be asked, without an entry that it has.
    pub(crate) fn flaw(
        &self,
        x: &[f64],
        flow: Option<Flow<'_>>,
        name: &dyn Fn(usize) -> Cow<'static, str>,
    ) -> Option<String> {
        if self.len() != x.len() {
            return Some(format!("has {} coordinates where the state has {}", self.len(), x.len()));
        }
        let (i, j) = self.left_out(x, flow?)?;
        Some(format!("leaves out that {}' reads {}", name(i), name(j)))
    }

    /// An entry (i, j) that the pattern leaves out: near `x` coordinate i of the flow changes as
    /// coordinate j does, and those of a group with it of which i reads none.
    ///
    /// Of columns j and k of one colour the places differ in a binary digit: of the columns with
    /// the digit of j one group is without k. So each entry is looked for by the two groups of
    /// each digit of each colour.
    fn left_out(&self, x: &[f64], flow: Flow<'_>) -> Option<(usize, usize)> {
        let n = self.len();
        let [here, there] = two_near(x);
        let base = flow(&here);
        let (mut moves, mut read) = (vec![false; n], vec![false; n]);
        // The first of these rows that reads none of a group of columns, and changes with it.
        let mut hidden = |group: &[usize], mut rows: Range<usize>| {
            moves.fill(false);
            read.fill(false);
            for &j in group {
                moves[j] = true;
                self.column(j).0.iter().for_each(|&i| read[i] = true);
            }
            let changed = flow(&mixed(&here, &there, |j| moves[j]));
            let differs = |i: usize| changed[i].is_finite() && changed[i] != base[i];
            rows.find(|&i| !read[i] && base[i].is_finite() && differs(i))
        };
        for columns in self.colours() {
            let digits = usize::BITS - (columns.len() - 1).leading_zeros();
            for (digit, bit) in (0..digits.max(1)).flat_map(|digit| [(digit, 0), (digit, 1)]) {
                let places = (0..columns.len()).filter(|place| place >> digit & 1 == bit);
                let mut group: Vec<_> = places.map(|place| columns[place]).collect();
                if let Some(i) = hidden(&group, 0..n) {
                    while group.len() > 1 {
                        let half = group.split_off(group.len() / 2);
                        if hidden(&group, i..i + 1).is_none() {
                            group = half;
                        }
                    }
                    return group.first().map(|&j| (i, j));
                }
            }
        }
        None
    }
}

impl PartialEq for Sparsity {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0.columns == other.0.columns
    }
}

impl Eq for Sparsity {}

/// How many coordinates, entries and colours it has, and how wide its band is.
impl fmt::Debug for Sparsity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Pattern { columns, colours, below, above, .. } = &*self.0;
        let (n, entries, colours) = (columns.len(), columns.items.len(), colours.len());
        write!(
            f,
            "Sparsity({entries} entries of {n} × {n} in {colours} colours, {below} below and {above} above the diagonal)"
        )
    }
}

/// How far beside a state a flow is looked at: far enough for each of its digits to change, near
/// enough to stay on one side of most switches. Ten times more or less finds the same patterns.
const NEARBY: f64 = 1e-3;
/// How far the coordinates are moved whose effect is looked for.
const AWAY: f64 = 2e-3;

/// A part of 1 that no two coordinates share: multiples of the golden ratio.
fn part(i: usize) -> f64 {
    (i as f64 * 0.618_033_988_749_894_9).fract()
}

/// A flow over lists of coordinates: one code for the states of all models.
pub(crate) type Flow<'a> = &'a mut dyn FnMut(&[f64]) -> Vec<f64>;

/// The coordinates of a state.
pub(crate) fn listed(x: &impl State) -> Vec<f64> {
    (0..x.len()).map(|i| x.get(i)).collect()
}

/// The one state with those coordinates of the other one that move.
fn mixed(here: &[f64], there: &[f64], moves: impl Fn(usize) -> bool) -> Vec<f64> {
    (0..here.len()).map(|j| if moves(j) { there[j] } else { here[j] }).collect()
}

/// Two states near `x` that share no coordinate, and in which none is zero: nothing of a flow there
/// is lost to a factor.
fn two_near(x: &[f64]) -> [Vec<f64>; 2] {
    let largest = x.iter().map(|x| x.abs()).fold(0.0, f64::max);
    let of_none = if largest > 0.0 { largest } else { 1.0 };
    let size = |x: f64| if x == 0.0 { of_none } else { x };
    [NEARBY, AWAY].map(|by| x.iter().enumerate().map(|(i, &x)| x + by * (1.0 + part(i)) * size(x)).collect())
}

/// The columns of each colour, such that no two of one colour share a row: each column in turn gets
/// the first colour that none of its rows has.
fn coloured(columns: &Lists, rows: &Lists) -> Lists {
    let mut colour = vec![usize::MAX; columns.len()];
    let (mut taken, mut count) = (Vec::new(), 0); // by column, the last one for which a colour was taken
    for (j, of_column) in columns.iter().enumerate() {
        for &i in of_column {
            for &k in rows.get(i) {
                if let Some(by) = taken.get_mut(colour[k]) {
                    *by = j;
                }
            }
        }
        colour[j] = taken.iter().position(|&by| by != j).unwrap_or(count);
        if colour[j] == count {
            (count, _) = (count + 1, taken.push(usize::MAX));
        }
    }
    Lists::of(count, colour.into_iter().enumerate().map(|(j, colour)| (colour, j)))
}

/// Lists of numbers, one behind the other.
#[derive(Debug, PartialEq, Eq)]
struct Lists {
    /// Where each begins, and the last one ends.
    starts: Vec<usize>,
    items: Vec<usize>,
}

impl Lists {
    /// So many lists, of pairs of a list and an item of it: each in rising order, and each item
    /// once.
    fn of(count: usize, pairs: impl IntoIterator<Item = (usize, usize)>) -> Self {
        let mut pairs: Vec<_> = pairs.into_iter().collect();
        pairs.sort_unstable();
        pairs.dedup();
        let mut starts = vec![0; count + 1];
        for &(list, _) in &pairs {
            starts[list + 1] += 1;
        }
        for list in 0..count {
            starts[list + 1] += starts[list];
        }
        Self { starts, items: pairs.into_iter().map(|(_, item)| item).collect() }
    }

    fn len(&self) -> usize {
        self.starts.len() - 1
    }

    fn get(&self, list: usize) -> &[usize] {
        &self.items[self.starts[list]..self.starts[list + 1]]
    }

    fn iter(&self) -> impl Iterator<Item = &[usize]> {
        (0..self.len()).map(|list| self.get(list))
    }

    /// By item, of so many, the lists that have it.
    fn turned(&self, count: usize) -> Self {
        Self::of(count, self.iter().enumerate().flat_map(|(list, items)| items.iter().map(move |&item| (item, list))))
    }
}
