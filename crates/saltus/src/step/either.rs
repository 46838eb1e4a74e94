//! One of two steppers, chosen as a program runs.

use super::{Stepper, Trial};
use crate::sparsity::Sparsity;
use crate::state::State;

/// One of two methods, or what one of them keeps: a choice that is made at run time, where a model
/// is to be compiled once.
///
/// A step pays a branch and some copies for it. The built-in methods are chosen from by
/// [`Auto::from`](super::Auto).
///
/// ```
/// use saltus::step::{Either, Stepper};
/// use saltus::{Dop853, Rodas5P, Tsit5};
/// let stiff = true;
/// let stepper: Either<Tsit5, Rodas5P> = if stiff { Either::Tight(Rodas5P) } else { Either::Loose(Tsit5) };
/// assert_eq!(stepper.error_order(), Rodas5P.error_order());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Either<L, T> {
    /// The first, for loose tolerances.
    Loose(L),
    /// The second, for tight ones.
    Tight(T),
}

impl<L: Default, T> Default for Either<L, T> {
    fn default() -> Self {
        Self::Loose(L::default())
    }
}

impl<S, L: AsRef<[S]>, T: AsRef<[S]>> AsRef<[S]> for Either<L, T> {
    #[inline]
    fn as_ref(&self) -> &[S] {
        match self {
            Self::Loose(dense) => dense.as_ref(),
            Self::Tight(dense) => dense.as_ref(),
        }
    }
}

impl<L: Stepper, T: Stepper> Stepper for Either<L, T> {
    type Stages<S: State> = Either<L::Stages<S>, T::Stages<S>>;
    type Dense<S: State> = Either<L::Dense<S>, T::Dense<S>>;

    fn jacobians(&self) -> u64 {
        match self {
            Self::Loose(method) => method.jacobians(),
            Self::Tight(method) => method.jacobians(),
        }
    }

    fn for_tolerance(self, relative: f64) -> Self {
        match self {
            Self::Loose(method) => Self::Loose(method.for_tolerance(relative)),
            Self::Tight(method) => Self::Tight(method.for_tolerance(relative)),
        }
    }

    fn predictive(&self) -> bool {
        match self {
            Self::Loose(method) => method.predictive(),
            Self::Tight(method) => method.predictive(),
        }
    }

    fn stable_to(&self) -> Option<f64> {
        match self {
            Self::Loose(method) => method.stable_to(),
            Self::Tight(method) => method.stable_to(),
        }
    }

    fn adapted(self, stiff: bool) -> Self {
        match self {
            Self::Loose(method) => Self::Loose(method.adapted(stiff)),
            Self::Tight(method) => Self::Tight(method.adapted(stiff)),
        }
    }

    #[inline]
    fn error_order(&self) -> f64 {
        match self {
            Self::Loose(method) => method.error_order(),
            Self::Tight(method) => method.error_order(),
        }
    }

    #[inline]
    fn trial<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        h: f64,
    ) -> Trial<S, Self::Stages<S>> {
        self.sparse(flow, t, x, slope, (h, None))
    }

    #[inline]
    fn sparse<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        slope: &S,
        step: (f64, Option<&Sparsity>),
    ) -> Trial<S, Self::Stages<S>> {
        match self {
            Self::Loose(method) => method.sparse(flow, t, x, slope, step).with_stages(Either::Loose),
            Self::Tight(method) => method.sparse(flow, t, x, slope, step).with_stages(Either::Tight),
        }
    }

    #[inline]
    fn error<S: State>(&self, h: f64, trial: Trial<&S, &Self::Stages<S>>, square: impl Fn(&S) -> f64) -> f64 {
        let Trial { end, slope, stages } = trial;
        match (self, stages) {
            (Self::Loose(method), Either::Loose(stages)) => method.error(h, Trial { end, slope, stages }, square),
            (Self::Tight(method), Either::Tight(stages)) => method.error(h, Trial { end, slope, stages }, square),
            _ => f64::INFINITY, // a trial of the other method's: never accepted
        }
    }

    #[inline]
    fn reach<S: State>(&self, h: f64, trial: Trial<&S, &Self::Stages<S>>) -> Option<S> {
        let Trial { end, slope, stages } = trial;
        match (self, stages) {
            (Self::Loose(method), Either::Loose(stages)) => method.reach(h, Trial { end, slope, stages }),
            (Self::Tight(method), Either::Tight(stages)) => method.reach(h, Trial { end, slope, stages }),
            _ => None,
        }
    }

    #[inline]
    fn dense<S: State>(
        &self,
        flow: &mut impl FnMut(f64, &S) -> S,
        t: f64,
        x: &S,
        h: f64,
        trial: Trial<&S, &Self::Stages<S>>,
    ) -> Self::Dense<S> {
        let Trial { end, slope, stages } = trial;
        match (self, stages) {
            (Self::Loose(method), Either::Loose(stages)) => {
                Either::Loose(method.dense(flow, t, x, h, Trial { end, slope, stages }))
            }
            (Self::Tight(method), Either::Tight(stages)) => {
                Either::Tight(method.dense(flow, t, x, h, Trial { end, slope, stages }))
            }
            _ => {
                // By this one. It never comes to that, so no method is compiled for each flow.
                let mut flow: &mut dyn FnMut(f64, &S) -> S = flow;
                let slope = flow(t, x);
                let trial = self.trial(&mut flow, t, x, &slope, h);
                self.dense(&mut flow, t, x, h, trial.as_ref())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Euler's method with an error that is trusted more or less: a method with a parameter.
    #[derive(Clone, Copy, Debug, Default, PartialEq)]
    struct Euler {
        trust: f64,
    }

    impl Stepper for Euler {
        type Stages<S: State> = S;
        type Dense<S: State> = [S; 2];

        fn error_order(&self) -> f64 {
            2.0
        }
        fn for_tolerance(self, relative: f64) -> Self {
            Self { trust: self.trust * relative }
        }
        fn trial<S: State>(
            &self,
            flow: &mut impl FnMut(f64, &S) -> S,
            t: f64,
            x: &S,
            slope: &S,
            h: f64,
        ) -> Trial<S, S> {
            let end = x.with(|i| x.get(i) + h * slope.get(i));
            Trial { slope: flow(t + h, &end), end, stages: slope.clone() }
        }
        fn error<S: State>(&self, h: f64, trial: Trial<&S, &S>, square: impl Fn(&S) -> f64) -> f64 {
            self.trust * square(&trial.end.with(|i| 0.5 * h * (trial.slope.get(i) - trial.stages.get(i))))
        }
        fn reach<S: State>(&self, h: f64, trial: Trial<&S, &S>) -> Option<S> {
            Some(trial.end.with(|i| self.trust * h * trial.stages.get(i).abs()))
        }
        fn dense<S: State>(
            &self,
            _: &mut impl FnMut(f64, &S) -> S,
            _: f64,
            x: &S,
            h: f64,
            trial: Trial<&S, &S>,
        ) -> [S; 2] {
            [x.clone(), x.with(|i| self.trust * h * trial.stages.get(i))]
        }
    }

    /// The very method is asked that is held, not another of its type.
    #[test]
    fn a_method_keeps_its_parameter() {
        let mut flow = |_: f64, x: &f64| -x;
        for method in [Euler { trust: 7.0 }, Euler { trust: 0.25 }] {
            for either in [Either::<Euler, Euler>::Loose(method), Either::Tight(method)] {
                let (own, trial) =
                    (method.trial(&mut flow, 0.0, &2.0, &-2.0, 0.5), either.trial(&mut flow, 0.0, &2.0, &-2.0, 0.5));
                let square = |e: &f64| e * e;
                assert_eq!(either.error(0.5, trial.as_ref(), square), method.error(0.5, own.as_ref(), square));
                assert_eq!(either.reach(0.5, trial.as_ref()), method.reach(0.5, own.as_ref()));
                let dense = either.dense(&mut flow, 0.0, &2.0, 0.5, trial.as_ref());
                assert_eq!(dense.as_ref(), method.dense(&mut flow, 0.0, &2.0, 0.5, own.as_ref()));
                assert!(matches!(
                    either.for_tolerance(0.5),
                    Either::Loose(Euler { trust }) | Either::Tight(Euler { trust }) if trust == 0.5 * method.trust
                ));
            }
        }
    }

    /// A trial of the other method is never accepted, and its dense output is made anew.
    #[test]
    fn a_trial_of_the_other_method() {
        let mut flow = |_: f64, x: &f64| -x;
        let [one, other] = [Either::<Euler, Euler>::Loose(Euler { trust: 1.0 }), Either::Tight(Euler { trust: 2.0 })];
        let trial = one.trial(&mut flow, 0.0, &2.0, &-2.0, 0.5);
        assert_eq!(other.error(0.5, trial.as_ref(), |e| e * e), f64::INFINITY);
        assert_eq!(other.reach(0.5, trial.as_ref()), None);
        assert_eq!(other.dense(&mut flow, 0.0, &2.0, 0.5, trial.as_ref()).as_ref(), [2.0, -2.0]);
    }
}
