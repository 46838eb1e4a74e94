//! A branch of fixed points as a parameter changes, by pseudo-arclength, and what happens to them
//! on the way.

use nalgebra::{Complex, DMatrix, DVector};

use super::newton::{Equation, newton};
use super::{FixedPoint, MapError, ReturnMap, Section};
use crate::analysis::linearize::{Linearize, Wrt};
use crate::state::State;
use crate::step::Stepper;

/// How the number or the stability of periodic runs changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Kind {
    /// Two fixed points meet: a multiplier is 1, and the branch turns back (saddle–node).
    Fold,
    /// A multiplier is -1: a run of twice the period branches off.
    PeriodDoubling,
    /// A pair of complex multipliers has modulus 1: an invariant circle branches off.
    NeimarkSacker,
}

/// A bifurcation on a branch, where its test function is zero.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Bifurcation<const K: usize> {
    /// What happens.
    pub kind: Kind,
    /// Where.
    pub point: Point<K>,
}

/// A point of a branch.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Point<const K: usize> {
    /// The parameter.
    pub parameter: f64,
    /// The periodic run.
    pub orbit: FixedPoint<K>,
}

/// How a branch ended.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum End<E> {
    /// At the end of the range of the parameter; past a fold this may be the end it started from.
    Reached,
    /// The periodic run grazes the guard of this edge: beyond the last point it takes other edges.
    Grazing {
        /// The edge that is touched.
        edge: E,
    },
    /// The next point could not be found, however short the step.
    Lost(MapError),
    /// The limit on points was reached.
    Points,
}

/// A branch of periodic runs.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Branch<E, const K: usize> {
    /// The points in order, from the start on.
    pub points: Vec<Point<K>>,
    /// The bifurcations in order.
    pub bifurcations: Vec<Bifurcation<K>>,
    /// How it ended.
    pub end: End<E>,
}

/// Follows a fixed point as one parameter of the automaton changes.
///
/// Unknown are the coordinates q and the parameter lambda together, `P(q; lambda) = q`. From a
/// point a step of length h is made along the branch's tangent, and from there Newton's method goes
/// back to the branch at a right angle (pseudo-arclength), so that folds are passed. h is chosen
/// from the number of Newton steps. lambda is measured in units of its range, each coordinate in
/// units of its value at the start.
///
/// Between two points, where a test function changes its sign, it is brought to zero:
///
/// | | test function |
/// |---|---|
/// | fold | lambda's component of the tangent |
/// | period doubling | det(∂P/∂q + I) |
/// | Neimark–Sacker | Π (μᵢ μⱼ - 1) over pairs i < j, where the pair is complex |
/// | grazing | the branch ends: no run with the same sequence of edges is found, and a guard that is not crossed is touched, or one is crossed without speed |
///
/// Sources: Kuznetsov, *Elements of Applied Bifurcation Theory*, 10.2 and 10.3; E. L. Allgower, K.
/// Georg, *Numerical Continuation Methods*, Springer 1990.
#[derive(Debug)]
pub struct Continuation<'a, 'm, A, X, F, const K: usize, M> {
    pub(super) map: &'m ReturnMap<'a, A, X, K, M>,
    pub(super) family: F,
    parameter: usize,
    longest_step: f64,
    most_points: usize,
}

/// A branch point with what the next step needs. Positions are scaled.
pub(super) struct Here<E, const K: usize> {
    pub(super) at: DVector<f64>,
    pub(super) tangent: DVector<f64>,
    pub(super) point: Point<K>,
    pub(super) edges: Vec<E>,
    newton_steps: u32,
}

impl<'a, 'm, A, X, F, const K: usize, M> Continuation<'a, 'm, A, X, F, K, M>
where
    A: Linearize,
    X: Section<A, K>,
    F: Fn(f64) -> A,
    M: Stepper,
{
    /// Follows the fixed points of `map` through the automata `family(lambda)`, lambda their
    /// parameter at this place of [`Linearize::parameters`].
    ///
    /// Of `map` the section and the simulation's options count.
    #[must_use]
    pub const fn of(map: &'m ReturnMap<'a, A, X, K, M>, family: F, parameter: usize) -> Self {
        Self { map, family, parameter, longest_step: 0.05, most_points: 2000 }
    }

    /// The longest step along the branch, in units of the range of the parameter; 0.05 without it.
    #[must_use]
    pub const fn longest_step(mut self, h: f64) -> Self {
        self.longest_step = h;
        self
    }

    /// The most points; 2000 without it.
    #[must_use]
    pub const fn most_points(mut self, count: usize) -> Self {
        self.most_points = count;
        self
    }

    /// The branch from the fixed point near `guess` at the parameter `from`, first towards `to`,
    /// until the parameter leaves the range between them.
    ///
    /// # Errors
    /// Those of [`ReturnMap::fixed_point`] at the start, and [`MapError::Question`] if the range is
    /// empty, or the parameter of `family(from)` is not `from`. Later failures end the branch
    /// ([`End`]).
    pub fn follow(&self, guess: [f64; K], from: f64, to: f64) -> Result<Branch<A::Edge, K>, MapError> {
        let scale = self.scale(guess, from, to)?;
        let toward = DVector::from_fn(K + 1, |i, _| if i == K { (to - from).signum() } else { 0.0 });
        let start = DVector::from_fn(K + 1, |i, _| if i == K { from } else { guess[i] }).component_div(&scale);
        let mut here = self.correct(&start, &toward, &scale)?;
        // The tangent that the first corrector used was a guess: lambda stood still there, as it
        // should.
        let mut branch = Branch { points: vec![here.point.clone()], bifurcations: Vec::new(), end: End::Points };
        let mut h = self.longest_step * 0.2;
        while branch.points.len() < self.most_points {
            let next = match self.correct(&(&here.at + &here.tangent * h), &here.tangent, &scale) {
                Ok(next) if next.edges == here.edges && next.tangent.dot(&here.tangent) > 0.9 => next,
                _ if h > SHORTEST => {
                    h *= 0.25;
                    continue;
                }
                Ok(next) => return Ok(self.ended(branch, &here, Some(&next), &scale, None)),
                Err(error) => return Ok(self.ended(branch, &here, None, &scale, Some(error))),
            };
            self.between(&here, &next, &scale, &mut branch.bifurcations);
            let inside = |lambda: f64| lambda >= from.min(to) && lambda <= from.max(to);
            if !inside(next.point.parameter) {
                // Exactly to the end of the range.
                let lambda =
                    if (next.point.parameter - to).abs() < (next.point.parameter - from).abs() { to } else { from };
                let last = self.bisect(&here, h, &scale, |point| point.point.parameter - lambda);
                branch.bifurcations.retain(|found| inside(found.point.parameter));
                branch.points.extend(last.map(|last| last.point));
                branch.end = End::Reached;
                return Ok(branch);
            }
            h *= match next.newton_steps {
                0..=3 => 1.5,
                4..=5 => 1.0,
                _ => 0.5,
            };
            h = h.min(self.longest_step);
            branch.points.push(next.point.clone());
            here = next;
        }
        Ok(branch)
    }

    /// The units of the coordinates and the parameter.
    fn scale(&self, guess: [f64; K], from: f64, to: f64) -> Result<DVector<f64>, MapError> {
        let range = (to - from).abs();
        if !(range.is_finite() && range > 0.0) {
            return Err(MapError::Question(format!(
                "the parameter cannot go from {from} to {to}: give two finite numbers that differ"
            )));
        }
        let parameters = (self.family)(from).parameters();
        if self.parameter >= parameters.len() || parameters.get(self.parameter) != from {
            return Err(MapError::Question(format!(
                "at {from} the family's automaton has parameters {parameters:?}, of which number {} (counted from 0) is not {from}: name the place of the parameter that the family sets",
                self.parameter
            )));
        }
        let largest = guess.iter().fold(0.0_f64, |most, q| most.max(q.abs()));
        let unit = if largest > 0.0 { largest } else { 1.0 };
        Ok(DVector::from_fn(K + 1, |i, _| if i == K { range } else { guess[i].abs().max(1e-3 * unit) }))
    }

    /// The point of the branch in the plane through `near` across `tangent`.
    pub(super) fn correct(
        &self,
        near: &DVector<f64>,
        tangent: &DVector<f64>,
        scale: &DVector<f64>,
    ) -> Result<Here<A::Edge, K>, MapError> {
        let root = newton(near.clone(), |at| {
            let (q, lambda) = (std::array::from_fn(|i| at[i] * scale[i]), at[K] * scale[K]);
            let automaton = (self.family)(lambda);
            let map = self.map.with(&automaton);
            let (linear, matrix) = map.dense(&q)?;
            let by_parameter = map.linear(&q, [Wrt::Parameter(self.parameter)])?.columns[0];
            let mut jacobian = DMatrix::zeros(K + 1, K + 1);
            for i in 0..K {
                for k in 0..K {
                    jacobian[(i, k)] = (matrix[(i, k)] - if i == k { 1.0 } else { 0.0 }) * scale[k];
                }
                jacobian[(i, K)] = by_parameter[i] * scale[K];
            }
            jacobian.row_mut(K).copy_from(&tangent.transpose());
            let mut residual = DVector::from_fn(K + 1, |i, _| if i == K { 0.0 } else { linear.image.q[i] - q[i] });
            residual[K] = tangent.dot(&(at - near));
            let mut allowed = map.allowed(&q, &linear.image.q).resize_vertically(K + 1, 1.0);
            allowed[K] = f64::EPSILON * (1.0 + at.amax());
            let orbit = map.orbit(q, &linear);
            Ok(Equation { residual, allowed, jacobian: jacobian.clone(), found: (orbit, linear.edges, jacobian) })
        })?;
        let (orbit, edges, jacobian) = root.found;
        let forward = DVector::from_fn(K + 1, |i, _| if i == K { 1.0 } else { 0.0 });
        let singular = || MapError::Singular { q: root.at.component_mul(scale).as_slice().to_vec() };
        let tangent = jacobian.lu().solve(&forward).ok_or_else(singular)?.normalize();
        let point = Point { parameter: root.at[K] * scale[K], orbit };
        Ok(Here { at: root.at, tangent, point, edges, newton_steps: root.steps })
    }

    /// The point at a step of at most `h` from `here` where a test function changes its sign, by
    /// bisection and regula falsi in turn.
    fn bisect(
        &self,
        here: &Here<A::Edge, K>,
        h: f64,
        scale: &DVector<f64>,
        test: impl Fn(&Here<A::Edge, K>) -> f64,
    ) -> Option<Here<A::Edge, K>> {
        let at = |h: f64| self.correct(&(&here.at + &here.tangent * h), &here.tangent, scale);
        let (mut low, mut high) = ((0.0, test(here)), (h, test(&at(h).ok()?)));
        let mut best = None;
        for turn in 0..80 {
            let weight = if turn % 3 == 2 { 0.5 } else { (low.1 / (low.1 - high.1)).clamp(1e-6, 1.0 - 1e-6) };
            let middle = low.0 + weight * (high.0 - low.0);
            let point = at(middle).ok()?;
            let value = test(&point);
            if (value > 0.0) == (low.1 > 0.0) {
                low = (middle, value);
            } else {
                high = (middle, value);
            }
            best = Some(point);
            if value == 0.0 || high.0 - low.0 <= 1e-14 {
                break;
            }
        }
        best
    }

    /// The bifurcations between two neighbouring points.
    fn between(
        &self,
        here: &Here<A::Edge, K>,
        next: &Here<A::Edge, K>,
        scale: &DVector<f64>,
        found: &mut Vec<Bifurcation<K>>,
    ) {
        let h = here.tangent.dot(&(&next.at - &here.at));
        for (kind, test) in [
            (Kind::Fold, fold as fn(&Here<A::Edge, K>) -> f64),
            (Kind::PeriodDoubling, period_doubling),
            (Kind::NeimarkSacker, neimark_sacker),
        ] {
            if (test(here) > 0.0) == (test(next) > 0.0) {
                continue;
            }
            let Some(at) = self.bisect(here, h, scale, test) else { continue };
            // A product of real multipliers may be one, too; that is a neutral saddle and no
            // bifurcation.
            let real = at.point.orbit.multipliers.iter().all(|multiplier| multiplier.im == 0.0);
            if kind != Kind::NeimarkSacker || !real {
                found.push(Bifurcation { kind, point: at.point });
            }
        }
        found.sort_by(|a, b| self.along(here, &a.point, scale).total_cmp(&self.along(here, &b.point, scale)));
    }

    /// How far along the branch from `here` a point is; what came before stays before.
    fn along(&self, here: &Here<A::Edge, K>, point: &Point<K>, scale: &DVector<f64>) -> f64 {
        let at = DVector::from_fn(K + 1, |i, _| if i == K { point.parameter } else { point.orbit.q[i] });
        here.tangent.dot(&(at.component_div(scale) - &here.at)).max(0.0)
    }

    /// The branch ends after `here`: its run grazes, or is lost.
    fn ended(
        &self,
        mut branch: Branch<A::Edge, K>,
        here: &Here<A::Edge, K>,
        beyond: Option<&Here<A::Edge, K>>,
        scale: &DVector<f64>,
        error: Option<MapError>,
    ) -> Branch<A::Edge, K> {
        let last = self.furthest(here, scale);
        let last = last.as_ref().unwrap_or(here);
        if branch.points.last() != Some(&last.point) {
            branch.points.push(last.point.clone());
        }
        let touched = self.touched(last);
        branch.end = match (touched, error) {
            (Some(edge), _) => End::Grazing { edge },
            (None, Some(error)) => End::Lost(error),
            (None, None) => End::Lost(MapError::Question(format!(
                "the run takes the edges {:?} before and {:?} after, without grazing: guards meet at one time there; go on from a run of the other kind",
                here.edges,
                beyond.map(|beyond| &beyond.edges)
            ))),
        };
        branch
    }

    /// The furthest point, close after `here`, that still takes the same edges.
    fn furthest(&self, here: &Here<A::Edge, K>, scale: &DVector<f64>) -> Option<Here<A::Edge, K>> {
        let (mut good, mut bad, mut last) = (0.0, 4.0 * SHORTEST, None);
        while bad - good > 1e-13 {
            let h = 0.5 * (good + bad);
            match self.correct(&(&here.at + &here.tangent * h), &here.tangent, scale) {
                Ok(point) if point.edges == here.edges => (good, last) = (h, Some(point)),
                _ => bad = h,
            }
        }
        last
    }
}

/// Steps shorter than this, in units of the parameter's range, find no next point.
const SHORTEST: f64 = 1e-7;

fn fold<E, const K: usize>(here: &Here<E, K>) -> f64 {
    here.tangent[K]
}

fn period_doubling<E, const K: usize>(here: &Here<E, K>) -> f64 {
    product(here.point.orbit.multipliers.iter().map(|multiplier| multiplier + 1.0))
}

fn neimark_sacker<E, const K: usize>(here: &Here<E, K>) -> f64 {
    let all = &here.point.orbit.multipliers;
    product((0..all.len()).flat_map(|i| (0..i).map(move |j| all[i] * all[j] - 1.0)))
}

fn product(factors: impl Iterator<Item = Complex<f64>>) -> f64 {
    factors.fold(Complex::new(1.0, 0.0), |product, factor| product * factor).re
}
