//! What a run can show for itself: how each guard was searched, and where a crossing may have been
//! missed.

use std::fmt;
use std::ops::ControlFlow;

use crate::automaton::Automaton;
use crate::cross::Evidence;
use crate::inspection::{Doubts, Inspection, InspectionOf};
use crate::jump::JumpOf;
use crate::observe::Observer;
use crate::piece::Piece;

/// An observer that keeps, for each edge, how the searches of its guard came out, and every doubt.
///
/// A search is **excluded** (bounds leave no room for a crossing), **isolated** (no crossing in any
/// part, or a first one that is the only one in its part) or **doubtful** (see
/// [`Inspection::doubt`]). There is one search per step and edge, or per exact arc and edge. Doubts
/// at times after the crossing that ended the arc are none, and those of neighbouring steps are
/// one.
///
/// Of edges that carry data (`Liftoff { foot: f64 }`) the first 64 have rows of their own, the rest
/// share one.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Certificate, Hybrid, Simulation};
///
/// let ball = Hybrid::new()
///     .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.81])
///     .edge("flight", "flight", |_t, x| x[0], |_t, x| vector![0.0, -0.8 * x[1]]);
/// let mut certificate = Certificate::new();
/// Simulation::of(&ball).drive("flight", vector![1.0, 0.0], 0.0..2.0, &mut certificate)?;
///
/// assert!(certificate.doubts().is_empty());
/// let (edge, tally) = certificate.edges().next().unwrap();
/// assert_eq!((edge.from, edge.to), ("flight", "flight"));
/// assert_eq!((tally.taken, tally.doubtful), (3, 0));
/// println!("{certificate}"); // a table
/// # Ok::<(), saltus::Error>(())
/// ```
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[derive(Clone, Debug)]
pub struct Certificate<M, E> {
    rows: Vec<(E, Tally)>,
    others: Tally,
    doubts: Doubts<M, E>,
}

/// A certificate of the automaton `A`.
pub type CertificateOf<A> = Certificate<<A as Automaton>::Mode, <A as Automaton>::Edge>;

/// How the searches for an edge came out.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub struct Tally {
    /// Searches in which bounds left no room for a crossing.
    pub excluded: u64,
    /// Searches that halved their interval until every part was decided.
    pub isolated: u64,
    /// Searches that left a doubt.
    pub doubtful: u64,
    /// How often the edge was taken.
    pub taken: u64,
}

/// More edges than this share one row.
const MOST_ROWS: usize = 64;
/// The doubts that a table lists.
const LISTED: usize = 10;

impl<M: Copy + PartialEq, E: Copy + PartialEq> Certificate<M, E> {
    /// Without searches yet.
    #[must_use]
    pub const fn new() -> Self {
        let others = Tally { excluded: 0, isolated: 0, doubtful: 0, taken: 0 };
        Self { rows: Vec::new(), others, doubts: Doubts::new() }
    }

    /// The edges searched for or taken, in the order in which they were met, and what came out.
    pub fn edges(&self) -> impl Iterator<Item = (E, Tally)> {
        self.rows.iter().copied()
    }

    /// The sums over all edges.
    #[must_use]
    pub fn total(&self) -> Tally {
        self.rows.iter().fold(self.others, |sum, (_, row)| Tally {
            excluded: sum.excluded + row.excluded,
            isolated: sum.isolated + row.isolated,
            doubtful: sum.doubtful + row.doubtful,
            taken: sum.taken + row.taken,
        })
    }

    /// Where a crossing may have been missed, in the order of the run; empty where none was.
    #[must_use]
    pub fn doubts(&self) -> &[Inspection<M, E>] {
        self.doubts.list()
    }
}

impl<M, E: PartialEq> Certificate<M, E> {
    fn row(&mut self, edge: E) -> &mut Tally {
        row(&mut self.rows, &mut self.others, edge)
    }
}

fn row<'a, E: PartialEq>(rows: &'a mut Vec<(E, Tally)>, others: &'a mut Tally, edge: E) -> &'a mut Tally {
    let found = rows.iter().position(|row| row.0 == edge);
    let place = found.unwrap_or_else(|| {
        if rows.len() < MOST_ROWS {
            rows.push((edge, Tally::default()));
            rows.len() - 1
        } else {
            MOST_ROWS
        }
    });
    rows.get_mut(place).map_or(others, |row| &mut row.1)
}

impl<M: Copy + PartialEq, E: Copy + PartialEq> Default for Certificate<M, E> {
    fn default() -> Self {
        Self::new()
    }
}

impl<A: Automaton> Observer<A> for Certificate<A::Mode, A::Edge> {
    fn piece(&mut self, _: A::Mode, piece: &Piece<'_, A::State>) -> ControlFlow<()> {
        let Self { rows, others, doubts } = self;
        doubts.settle(piece.start().after(piece.span()), |edge| row(rows, others, edge).doubtful += 1);
        ControlFlow::Continue(())
    }

    fn jump(&mut self, jump: &JumpOf<A>) -> ControlFlow<()> {
        let Self { rows, others, doubts } = self;
        doubts.end_arc(jump.time, jump.edge(), |edge, stands| {
            let row = row(rows, others, edge);
            *(if stands { &mut row.doubtful } else { &mut row.isolated }) += 1;
        });
        if let Some(edge) = jump.edge() {
            self.row(edge).taken += 1;
        }
        ControlFlow::Continue(())
    }

    fn inspection(&mut self, inspection: &InspectionOf<A>) {
        match inspection.evidence {
            Evidence::Excluded => self.row(inspection.edge).excluded += 1,
            Evidence::Isolated => self.row(inspection.edge).isolated += 1,
            Evidence::Doubtful { .. } => self.doubts.add(inspection),
        }
    }
}

impl<M: Copy + PartialEq + fmt::Debug, E: Copy + PartialEq + fmt::Debug> fmt::Display for Certificate<M, E> {
    /// A row per edge, then the doubts.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut rows: Vec<_> = self.rows.iter().map(|(edge, tally)| (format!("{edge:?}"), *tally)).collect();
        if self.others != Tally::default() {
            rows.push(("other edges".into(), self.others));
        }
        let width = rows.iter().map(|row| row.0.chars().count()).max().unwrap_or(0).max("edge".len());
        writeln!(f, "{:width$}  excluded  isolated  doubtful     taken", "edge")?;
        for (edge, Tally { excluded, isolated, doubtful, taken }) in rows {
            writeln!(f, "{edge:width$}  {excluded:8}  {isolated:8}  {doubtful:8}  {taken:8}")?;
        }
        let doubts = self.doubts();
        if doubts.is_empty() {
            return f.write_str("No doubts: every search was decided.");
        }
        f.write_str("Doubts:")?;
        for doubt in doubts.iter().take(LISTED) {
            write!(f, "\n- {doubt}")?;
        }
        match doubts.len() - LISTED.min(doubts.len()) {
            0 => Ok(()),
            more => write!(f, "\n- and {more} more"),
        }
    }
}
