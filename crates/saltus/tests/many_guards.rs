//! Many guards on one step: what they are asked at is made once, and none changes what another
//! shows.

use std::cell::Cell;

use proptest::prelude::*;
use saltus::{About, Auto, Automaton, Edges, Entry, Refusal, Simulation, State, Stats, Stop};
use saltus_cases::cases;

use crate::methods::methods;

thread_local! {
    /// How many states were made of another one.
    static MADE: Cell<u64> = const { Cell::new(0) };
}

/// Ten coordinates, beyond what the steps of promised guards are probed in.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Counted([f64; 10]);

impl State for Counted {
    fn len(&self) -> usize {
        self.0.len()
    }
    fn get(&self, i: usize) -> f64 {
        self.0[i]
    }
    fn with(&self, f: impl FnMut(usize) -> f64) -> Self {
        MADE.with(|made| made.set(made.get() + 1));
        Self(std::array::from_fn(f))
    }
}

/// What a guard of an oscillator looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Margin {
    /// a - x/2 - v²/10.
    Bent(f64),
    /// a - x/2, promised affine.
    Promised(f64),
    /// a + sin(20 t) - x.
    Timed(f64),
}

/// Five oscillators of different speed, and guards of the first.
struct Watched<'a>(&'a [Margin]);

impl Automaton for Watched<'_> {
    type Mode = ();
    type State = Counted;
    type Edge = usize;

    fn flow(&self, (): (), _t: f64, Counted(x): &Counted) -> Counted {
        Counted(std::array::from_fn(|i| if i % 2 == 0 { x[i + 1] } else { -(1.0 + i as f64) * x[i - 1] }))
    }
    fn edges(&self, (): ()) -> Edges<'_, usize> {
        Edges::indexed(self.0.len(), |k| k)
    }
    fn guard(&self, edge: usize, t: f64, Counted(x): &Counted) -> f64 {
        match self.0[edge] {
            Margin::Bent(a) => a - 0.5 * x[0] - 0.1 * x[1] * x[1],
            Margin::Promised(a) => a - 0.5 * x[0],
            Margin::Timed(a) => a + (20.0 * t).sin() - x[0],
        }
    }
    fn about(&self, edge: usize) -> About {
        About::new().entry(Entry::Wait).affine_if(matches!(self.0[edge], Margin::Promised(_)))
    }
    fn reset(&self, (): (), _: usize, _t: f64, x: &Counted) -> Result<((), Counted), Refusal> {
        Ok(((), *x))
    }
}

fn began() -> Counted {
    Counted([1.0, 0.0, 0.5, 0.0, 0.2, 0.1, 0.0, 1.0, -0.3, 0.0])
}

/// How many states a run by these guards makes, and its counts.
fn cost(guards: &[Margin]) -> (u64, Stats) {
    MADE.with(|made| made.set(0));
    let end = Simulation::of(&Watched(guards)).stepper(methods()[0]).drive((), began(), 0.0..5.0, &mut ()).unwrap();
    assert_eq!((end.stop, end.stats.jumps), (Stop::Time, 0));
    (MADE.with(Cell::get), end.stats)
}

#[test]
fn states_are_made_once_for_all_guards_of_a_kind() {
    for margin in [Margin::Bent, Margin::Promised] {
        let far: Vec<_> = (0..200).map(|k| margin(3.0 + f64::from(k))).collect();
        let ((one, few), (all, many)) = (cost(&far[..1]), cost(&far));
        assert_eq!(few.steps, many.steps);
        // The arcs on which promises are looked at move each coordinate for each guard.
        assert!(all - one <= 200 * 40, "{margin:?}: {one} states for one guard, {all} for 200");
        let each = many.guards as f64 / (200 * many.steps) as f64;
        assert!(each < 12.0, "{margin:?}: {each} evaluations of a guard a step");
    }
}

/// The times of all jumps by the guard `of` a model.
fn crossings(guards: &[Margin], of: usize, stepper: Auto) -> Vec<f64> {
    let run = Simulation::of(&Watched(guards)).stepper(stepper).run((), began(), 0.0..5.0).unwrap();
    run.trajectory.jumps().iter().filter(|jump| jump.edge() == Some(of)).map(saltus::Jump::t).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(64), ..ProptestConfig::default() })]

    /// A guard crosses where it does alone, to the bit, whatever others stand before and after it
    /// that do not fall.
    #[test]
    fn others_change_nothing(
        kind in 0_usize..3,
        a in 0.05..0.45_f64,
        others in prop::collection::vec((0_usize..3, 2.1..50.0_f64), 1..12),
        before in 0_usize..12,
    ) {
        let margin = |kind: usize, a: f64| [Margin::Bent(a), Margin::Promised(a), Margin::Timed(a)][kind];
        let mut guards: Vec<_> = others.iter().map(|&(kind, a)| margin(kind, a)).collect();
        let before = before.min(guards.len());
        guards.insert(before, margin(kind, a));
        for method in methods() {
            let alone = crossings(&guards[before..=before], 0, method);
            prop_assert!(!alone.is_empty());
            prop_assert_eq!(crossings(&guards, before, method), alone);
        }
    }
}
