//! What a picture needs of a trajectory: the polynomials of some coordinates in a window of time,
//! mode by mode, and the jumps.

use std::fmt::Debug;
use std::ops::Range;

use saltus::{Cause, State, Trajectory};

use crate::coordinate::Label;
use crate::error::{PlotError, finite};
use crate::polynomial::shifted;

/// The time shown after the last jump of a run that does not end, as a part of the time before it.
const AFTER: f64 = 0.15;
/// A run that goes on beyond this does not end.
const ENDLESS: f64 = 1e299;

/// Part of a trajectory as data.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Traced {
    pub(crate) window: (f64, f64),
    /// The modes in the order in which they first come.
    pub(crate) modes: Vec<String>,
    pub(crate) stays: Vec<Stay>,
    pub(crate) leaps: Vec<Leap>,
}

/// The stay in a mode between two jumps.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stay {
    /// The number of the mode.
    pub(crate) mode: usize,
    pub(crate) from: f64,
    pub(crate) to: f64,
    pub(crate) parts: Vec<Part>,
}

/// A piece: each coordinate as the coefficients of the powers of (t - start)/scale; empty where the
/// state has it not.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Part {
    pub(crate) start: f64,
    pub(crate) span: f64,
    pub(crate) scale: f64,
    pub(crate) coefficients: Vec<Vec<f64>>,
}

/// A jump with both limits of each coordinate that the state has.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Leap {
    pub(crate) t: f64,
    /// Whether jumps accumulate here.
    pub(crate) limit: bool,
    pub(crate) before: Vec<Option<f64>>,
    pub(crate) after: Vec<Option<f64>>,
}

/// The names and units of the coordinates, of the mode that has most of them; `named` go before
/// those of the state.
pub(crate) fn labels<M: Copy, E, S: State>(
    trajectory: &Trajectory<M, E, S>,
    named: &[String],
) -> Result<Vec<Label>, PlotError> {
    let Some(widest) = trajectory.arcs().iter().map(saltus::Arc::state).max_by_key(|state| state.len()) else {
        return Ok(Vec::new());
    };
    if let Some(name) = named.get(widest.len()) {
        return Err(PlotError::Names { name: name.clone(), coordinates: widest.len() });
    }
    let own = |i: usize| Label { name: widest.name(i).into_owned(), unit: widest.unit(i).to_owned() };
    Ok((0..widest.len()).map(|i| named.get(i).map_or_else(|| own(i), |words| Label::read(words))).collect())
}

impl Traced {
    /// The coordinates at `places` over a part of the trajectory, or all of it; if that has no end,
    /// until a little after its last jump.
    pub(crate) fn of<M: Copy + Debug, E, S: State>(
        trajectory: &Trajectory<M, E, S>,
        over: Option<&Range<f64>>,
        places: &[usize],
    ) -> Result<Self, PlotError> {
        let window = window(trajectory, over)?;
        let mut traced = Self { window, modes: Vec::new(), stays: Vec::new(), leaps: Vec::new() };
        let (start, last) = (trajectory.start().seconds(), trajectory.end().seconds());
        // A jump on the edge of a part belongs to what lies beyond; at the ends of the run nothing
        // does.
        let inside = |t: f64| (t > window.0 || window.0 == start) && (t < window.1 || window.1 == last);
        for (index, arc) in trajectory.arcs().iter().enumerate() {
            let next = trajectory.jumps().get(index);
            let (from, to) = (arc.start().seconds(), next.map_or(last, saltus::Jump::t));
            if from > window.1 {
                break;
            }
            let words = mode_name(&arc.mode());
            let mode = traced.modes.iter().position(|mode| *mode == words).unwrap_or_else(|| {
                traced.modes.push(words);
                traced.modes.len() - 1
            });
            let (from, to) = (from.max(window.0), to.min(window.1));
            if from < to {
                let parts = trajectory.pieces(index).filter_map(|piece| part(&piece, window, places)).collect();
                traced.stays.push(Stay { mode, from, to, parts });
            }
            if let Some(jump) = next.filter(|jump| inside(jump.t())) {
                let [before, after] = [&jump.before, &jump.after].map(|state| side(state, places));
                traced.leaps.push(Leap { t: jump.t(), limit: matches!(jump.cause, Cause::Zeno), before, after });
            }
        }
        traced.keep_modes();
        Ok(traced)
    }

    /// Leaves out the modes that the run is not in for any time.
    fn keep_modes(&mut self) {
        let mut kept: Vec<usize> = self.stays.iter().map(|stay| stay.mode).collect();
        kept.sort_unstable();
        kept.dedup();
        for stay in &mut self.stays {
            stay.mode = kept.binary_search(&stay.mode).unwrap_or_default();
        }
        self.modes = kept.iter().map(|&mode| self.modes[mode].clone()).collect();
    }

    /// The breaks of a coordinate: the time, and the limits before the first and after the last
    /// jump at that time.
    pub(crate) fn breaks(&self, line: usize) -> impl Iterator<Item = (f64, f64, f64)> {
        let instants = self.leaps.chunk_by(|a, b| a.t == b.t);
        instants.filter_map(move |leaps| {
            let [first, last] = [leaps.first()?, leaps.last()?];
            Some((first.t, first.before[line]?, last.after[line]?))
        })
    }

    /// Every piece in order.
    pub(crate) fn parts(&self) -> impl Iterator<Item = &Part> {
        self.stays.iter().flat_map(|stay| &stay.parts)
    }
}

fn window<M: Copy, E, S: State>(
    trajectory: &Trajectory<M, E, S>,
    over: Option<&Range<f64>>,
) -> Result<(f64, f64), PlotError> {
    let (start, end) = (trajectory.start().seconds(), trajectory.end().seconds());
    let (from, to) = match over {
        Some(over) => {
            let from = finite(over.start, || "the start of the part to draw".to_owned())?;
            let to = finite(over.end, || "the end of the part to draw".to_owned())?;
            (from.max(start), to.min(end))
        }
        None if end < ENDLESS => (start, end),
        None => {
            let last = trajectory.jumps().last().map_or(start, saltus::Jump::t);
            if last <= start {
                return Err(PlotError::Missing(
                    "the run has no end and no jump: say from when to when to draw it, by `over`",
                ));
            }
            (start, last + AFTER * (last - start))
        }
    };
    if from < to {
        Ok((from, to))
    } else {
        let [from, to] = over.map_or([start, end], |over| [over.start, over.end]);
        Err(PlotError::Window { part: (from, to), run: (start, end) })
    }
}

/// The part of a piece in the window.
fn part<S: State>(piece: &saltus::Piece<'_, S>, (low, high): (f64, f64), places: &[usize]) -> Option<Part> {
    let (start, scale) = (piece.start().seconds(), piece.scale());
    let end = start + piece.span();
    let (from, to) = (start.max(low), end.min(high));
    // Not one that only touches the window, unless it is that short.
    if to < from || (to == from && end > start) {
        return None;
    }
    let coefficients = |&place: &usize| {
        let known = piece.coefficients().iter().filter(|c| place < c.len()).map(|c| c.get(place)).collect::<Vec<_>>();
        if from > start { shifted(&known, (from - start) / scale) } else { known }
    };
    Some(Part { start: from, span: to - from, scale, coefficients: places.iter().map(coefficients).collect() })
}

fn side(state: &impl State, places: &[usize]) -> Vec<Option<f64>> {
    places.iter().map(|&place| (place < state.len()).then(|| state.get(place))).collect()
}

/// A mode in words: a name that is text as it is, of any other the first word, so that a mode that
/// carries numbers is one mode.
fn mode_name(mode: &impl Debug) -> String {
    let text = format!("{mode:?}");
    match text.strip_prefix('"').and_then(|text| text.strip_suffix('"')) {
        Some(name) => name.replace("\\\"", "\""),
        None => text.split([' ', '(', '{']).next().unwrap_or_default().to_owned(),
    }
}
