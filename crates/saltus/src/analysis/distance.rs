//! How far apart two runs are, as curves in hybrid time, where the difference at one time means
//! nothing.

use crate::piece::Piece;
use crate::state::State;
use crate::time::Time;
use crate::trajectory::{Arc, Trajectory};

/// How closeness of two hybrid arcs is measured: the scales of time and state, and up to when.
///
/// Two bouncing balls whose impacts differ by a hair differ by twice their speed between the one
/// impact and the other, however small the hair. As curves they are a hair apart. The **distance**
/// is the smallest ε such that for each (t, j) of one arc, up to the horizon, there is an (s, j) of
/// the other with
///
/// |t - s| ≤ ε · time scale and |xᵢ(t, j) - yᵢ(s, j)| ≤ ε · state scaleᵢ for each coordinate i,
///
/// and the other way round: graphical closeness in the sense of R. Goebel, R. Sanfelice, A. Teel,
/// *Hybrid Dynamical Systems* (Princeton, 2012), def. 5.23, in units. The number ε has none: 1e-3
/// with scales of 1 s and 1 m is a millisecond or a millimetre, whichever is needed.
///
/// - Equal arcs have the distance 0, and it is symmetric.
/// - The j must match: if one arc has made a jump by the horizon that the other never makes, or if
///   the dimensions of the state differ at some j, the distance is infinite. To compare up to t
///   where an impact is near, run both beyond t and give t as the horizon: the counterpart of a
///   point may lie beyond it.
/// - States are compared, not the names of modes, so that runs of two descriptions of one system
///   can be compared.
///
/// **Accuracy.** The nearest (s, j) is found to one part in 10⁶ of its distance, but for the
/// rounding of the states. The farthest (t, j) is looked for at 17 points of every piece of the
/// trajectory and then between the points next to the farthest; so the result is never too large by
/// more than that part in 10⁶, and too small only if the distance has a peak narrower than a
/// sixteenth of a step elsewhere.
///
/// ```
/// use saltus::nalgebra::{self, Vector2, vector};
/// use saltus::{Closeness, Hybrid, Run, Simulation};
///
/// let ball = |e: f64| Hybrid::new()
///     .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -9.81])
///     .edge("flight", "flight", |_t, x| x[0], move |_t, x| vector![0.0, -e * x[1]]);
/// let (one, other) = (ball(0.8), ball(0.8 + 1e-6));
/// let run = |ball| Simulation::of(ball).run("flight", vector![1.0, 0.0], 0.0..2.0);
/// let (one, other) = (run(&one)?.trajectory, run(&other)?.trajectory);
///
/// // Between the impacts of the one and the other their speeds differ by twice an impact's,
/// let between = one.jumps()[1].t();
/// assert!((one.at(between).unwrap() - other.at(between).unwrap()).norm() > 5.0);
/// // but the curves are micrometres and microseconds apart.
/// let distance = Closeness::new(1.0, [1.0, 10.0]).distance(&one, &other);
/// assert!(1e-7 < distance && distance < 1e-5);
/// # Ok::<(), saltus::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct Closeness {
    time: f64,
    state: Vec<f64>,
    horizon: f64,
}

/// Where the nearest state is looked for, it is found to this part of its distance.
const RESOLUTION: f64 = 1e-6;
/// Intervals per piece between the states that look for their nearest.
const INTERVALS: u32 = 16;
/// Cells after which the search for a nearest state gives what it has.
const MOST_CELLS: usize = 20_000;

impl Closeness {
    /// With these scales of time, in seconds, and of each coordinate, in its unit; the last one
    /// serves for any further coordinates.
    ///
    /// A scale that is not above zero makes any difference in what it measures infinite.
    #[must_use]
    pub fn new(time: f64, state: impl Into<Vec<f64>>) -> Self {
        Self { time, state: state.into(), horizon: f64::INFINITY }
    }

    /// Compares up to the time `t`, in seconds.
    #[must_use]
    pub fn until(mut self, t: f64) -> Self {
        self.horizon = t;
        self
    }

    /// The distance of two trajectories: the smallest ε for which they are ε-close; infinite where
    /// their jumps do not match.
    #[must_use]
    pub fn distance<M, E, N, F, S>(&self, one: &Trajectory<M, E, S>, other: &Trajectory<N, F, S>) -> f64
    where
        M: Copy,
        N: Copy,
        S: State,
    {
        let (one, other) = (curves(one), curves(other));
        let there = self.from(&one, &other, 0.0);
        self.from(&other, &one, there)
    }

    /// How far the farthest state of `one` is from the curves of `other`, or `least` if that is
    /// more.
    fn from<S: State>(&self, one: &[Curve<'_, S>], other: &[Curve<'_, S>], least: f64) -> f64 {
        let mut farthest = least;
        let mut peaks = Vec::new();
        for (j, curve) in one.iter().enumerate().take_while(|(_, curve)| curve.start.seconds() <= self.horizon) {
            let Some(counterpart) = other.get(j).filter(|other| other.state.len() == curve.state.len()) else {
                return f64::INFINITY;
            };
            if let Some(peak) = self.farthest(curve, counterpart, farthest) {
                farthest = farthest.max(peak.distance);
                peaks.push((curve, counterpart, peak));
            }
        }
        let high = |peak: &Peak| peak.distance > 0.8 * farthest && farthest.is_finite();
        let top = peaks.iter().filter(|(_, _, peak)| high(peak));
        top.map(|(curve, counterpart, peak)| self.summit(curve, counterpart, peak)).fold(farthest, f64::max)
    }

    /// The farthest of a few states on each piece of a curve, if it is farther than `least`.
    fn farthest<S: State>(&self, one: &Curve<'_, S>, other: &Curve<'_, S>, least: f64) -> Option<Peak> {
        let shift = one.start.since(other.start);
        let last = one.duration.min(self.horizon - one.start.seconds());
        let mut peak = Peak { distance: least, from: 0.0, to: 0.0 };
        let mut look = |from: f64, u: f64, to: f64| {
            let distance = self.nearest(u + shift, &one.at(u), other, peak.distance);
            if distance > peak.distance {
                peak = Peak { distance, from, to };
            }
        };
        look(0.0, 0.0, 0.0);
        for piece in one.pieces.iter().take_while(|piece| piece.from <= last) {
            let (from, to) = (piece.from, (piece.from + piece.piece.span()).min(last));
            let step = (to - from) / f64::from(INTERVALS);
            for k in 0..=INTERVALS {
                let u = if k == INTERVALS { to } else { from + f64::from(k) * step };
                look((u - step).max(from), u, (u + step).min(to));
            }
        }
        (peak.distance > least).then_some(peak)
    }

    /// The farthest state between the two next to a peak, by golden sections.
    fn summit<S: State>(&self, one: &Curve<'_, S>, other: &Curve<'_, S>, peak: &Peak) -> f64 {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let shift = one.start.since(other.start);
        let Peak { distance, from: mut a, to: mut b } = *peak;
        let mut most = distance;
        for _ in 0..30 {
            let (left, right) = (b - GOLDEN * (b - a), a + GOLDEN * (b - a));
            let [on_left, on_right] = [left, right].map(|u| self.nearest(u + shift, &one.at(u), other, 0.0));
            most = most.max(on_left).max(on_right);
            (a, b) = if on_left > on_right { (a, right) } else { (left, b) };
        }
        most
    }

    /// How far a state `x` at `u` is from the nearest one of a curve; `u` counts from the start of
    /// that curve.
    ///
    /// Cells of the curve are halved and those that cannot hold anything nearer are left out. Once
    /// it is no farther than `enough`, nearer need not be looked for (A. A. Taha, A. Hanbury, IEEE
    /// TPAMI 37 (2015) 2153, doi:10.1109/TPAMI.2015.2408351).
    fn nearest<S: State>(&self, u: f64, x: &S, curve: &Curve<'_, S>, enough: f64) -> f64 {
        let start = u.clamp(0.0, curve.duration);
        let mut best = self.apart(u - start, x, &curve.at(start));
        let mut cells: Vec<Cell> = Vec::new();
        if best <= enough {
            return best;
        }
        // Only pieces near enough in time can hold anything nearer.
        let reach = best * self.time;
        let first = curve.pieces.partition_point(|piece| piece.from + piece.piece.span() < u - reach);
        let near = curve.pieces.iter().enumerate().skip(first).take_while(|(_, piece)| piece.from <= u + reach);
        for (index, piece) in near {
            let cell = Cell { index, from: piece.from, to: piece.from + piece.piece.span(), bound: 0.0 };
            cells.extend(self.bounded(cell, u, x, curve, &mut best));
        }
        let mut count = cells.len();
        // The most promising cell last, so that it comes first.
        cells.sort_by(|a, b| b.bound.total_cmp(&a.bound));
        while let Some(cell) = cells.pop().filter(|_| best > enough) {
            let middle = 0.5 * (cell.from + cell.to);
            if cell.bound >= best * (1.0 - RESOLUTION)
                || !(cell.from < middle && middle < cell.to)
                || count > MOST_CELLS
            {
                continue;
            }
            count += 2;
            let left = self.bounded(Cell { to: middle, ..cell }, u, x, curve, &mut best);
            let right = self.bounded(Cell { from: middle, ..cell }, u, x, curve, &mut best);
            let (mut near, mut far) = (left, right);
            if let (Some(a), Some(b)) = (&left, &right)
                && b.bound < a.bound
            {
                (near, far) = (right, left);
            }
            cells.extend(far.into_iter().chain(near));
        }
        best
    }

    /// The cell with a lower bound of the distance of its states, unless that excludes it; its
    /// middle is looked at.
    fn bounded<S: State>(&self, mut cell: Cell, u: f64, x: &S, curve: &Curve<'_, S>, best: &mut f64) -> Option<Cell> {
        let in_time = ((cell.from - u).max(u - cell.to).max(0.0)) / self.time;
        if in_time >= *best {
            return None;
        }
        let piece = &curve.pieces[cell.index];
        // Only the part near enough in time can hold anything better.
        let reach = *best * self.time;
        let (from, to) = (cell.from.max(u - reach), cell.to.min(u + reach));
        if from > to {
            return None;
        }
        (cell.from, cell.to) = (from, to);
        let middle = 0.5 * (from + to);
        let y = piece.at(middle);
        *best = best.min(self.apart(u - middle, x, &y));
        let half = 0.5 * (to - from);
        let mut bound = in_time;
        for i in 0..x.len() {
            let gap = ((x.get(i) - y.get(i)).abs() - half * piece.speed(i, from, to)).max(0.0);
            bound = bound.max(self.scaled(gap, i));
        }
        cell.bound = bound;
        (bound < *best * (1.0 - RESOLUTION)).then_some(cell)
    }

    /// The larger of the scaled differences in time and state.
    fn apart<S: State>(&self, time: f64, x: &S, y: &S) -> f64 {
        let in_time = if time == 0.0 { 0.0 } else { positive(time.abs() / self.time) };
        (0..x.len()).map(|i| self.scaled((x.get(i) - y.get(i)).abs(), i)).fold(in_time, f64::max)
    }

    fn scaled(&self, gap: f64, i: usize) -> f64 {
        let scale = self.state.get(i).or(self.state.last()).copied().unwrap_or(1.0);
        if gap == 0.0 { 0.0 } else { positive(gap / scale) }
    }
}

/// A ratio with a scale that makes sense, or infinity.
fn positive(ratio: f64) -> f64 {
    if ratio >= 0.0 { ratio } else { f64::INFINITY }
}

/// The farthest of the states looked at, and the times of those next to it.
struct Peak {
    distance: f64,
    from: f64,
    to: f64,
}

/// A part of a piece in which the nearest state may lie.
#[derive(Clone, Copy)]
struct Cell {
    index: usize,
    from: f64,
    to: f64,
    bound: f64,
}

/// The arc between two jumps, its pieces by the time since its start.
struct Curve<'a, S> {
    start: Time,
    state: S,
    duration: f64,
    pieces: Vec<Placed<'a, S>>,
}

struct Placed<'a, S> {
    from: f64,
    piece: Piece<'a, S>,
}

impl<S: State> Curve<'_, S> {
    fn at(&self, u: f64) -> S {
        let next = self.pieces.partition_point(|piece| piece.from <= u);
        next.checked_sub(1).and_then(|i| self.pieces.get(i)).map_or_else(|| self.state.clone(), |piece| piece.at(u))
    }
}

impl<S: State> Placed<'_, S> {
    fn at(&self, u: f64) -> S {
        self.piece.at((u - self.from).clamp(0.0, self.piece.span()))
    }

    /// A bound of the speed of coordinate `i` from `from` to `to`: that in the middle, and how much
    /// the higher derivatives change it.
    fn speed(&self, i: usize, from: f64, to: f64) -> f64 {
        let scale = self.piece.scale();
        let c = self.piece.coefficients();
        let (centre, radius) = ((0.5 * (from + to) - self.from) / scale, 0.5 * (to - from) / scale);
        // p' about the centre: Σ k cₖ (centre + r)ᵏ⁻¹ with |r| ≤ radius.
        let (mut middle, mut spread) = (0.0, 0.0);
        let (mut size, mut reach) = (1.0, 1.0);
        for (k, c) in c.iter().enumerate().skip(1) {
            #[allow(clippy::cast_precision_loss)] // a degree
            let d = k as f64 * c.get(i);
            middle += d * size;
            spread += d.abs() * (reach - size.abs());
            size *= centre;
            reach *= centre.abs() + radius;
        }
        (middle.abs() + spread) / scale
    }
}

fn curves<M, E, S>(trajectory: &Trajectory<M, E, S>) -> Vec<Curve<'_, S>>
where
    M: Copy,
    S: State,
{
    let arcs = trajectory.arcs();
    let ends = arcs.iter().skip(1).map(Arc::start).chain([trajectory.end()]);
    let curve = |(index, (arc, end)): (usize, (&Arc<M, S>, Time))| {
        let mut pieces = Vec::new();
        for piece in trajectory.pieces(index) {
            pieces.push(Placed { from: piece.start().since(arc.start()), piece });
        }
        Curve { start: arc.start(), state: arc.state().clone(), duration: end.since(arc.start()).max(0.0), pieces }
    };
    arcs.iter().zip(ends).enumerate().map(curve).collect()
}
