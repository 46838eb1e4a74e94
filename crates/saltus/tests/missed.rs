//! A crossing that a false promise of the model hides is an error, or leaves a doubt: a guard is
//! below zero where an arc ends.

use proptest::prelude::*;
use saltus::cross::Doubt;
use saltus::{About, Automaton, Edges, Entry, Error, ErrorKind, Fall, Polynomial, Refusal, Simulation, Solution, Stop};
use saltus_cases::cases;

/// A point that moves at speed 1 towards a wall and, before it, through a line.
struct Runner {
    line: f64,
    wall: f64,
    entry: Entry,
    exact: bool,
    promise: Promise,
}

/// What the model says of the line's guard.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Promise {
    Nothing,
    /// That it is affine, though it is the square of the distance less 1.
    Affine,
    /// That the line is never crossed.
    Never,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum To {
    Line,
    Wall,
}

impl Automaton for Runner {
    type Mode = bool;
    type State = f64;
    type Edge = To;

    fn flow(&self, _: bool, _: f64, _: &f64) -> f64 {
        -1.0
    }

    fn edges(&self, behind: bool) -> Edges<'_, To> {
        if behind { Edges::from([]) } else { Edges::from([To::Line, To::Wall]) }
    }

    fn guard(&self, edge: To, _: f64, x: &f64) -> f64 {
        match edge {
            To::Line => (x / self.line) * (x / self.line) - 1.0,
            To::Wall => x - self.wall,
        }
    }

    fn reset(&self, _: bool, _: To, _: f64, x: &f64) -> Result<(bool, f64), Refusal> {
        Ok((true, *x))
    }

    fn about(&self, edge: To) -> About {
        About::new().affine_if(edge == To::Line && self.promise == Promise::Affine).entry(self.entry)
    }

    fn solution(&self, _: bool, _: f64, x: &f64) -> Solution<Self> {
        if self.exact { Solution::Polynomial(Polynomial::from([*x, -1.0])) } else { Solution::Steps }
    }

    fn falls(&self, _: bool, edge: To, _: f64, _: &f64) -> Fall<f64> {
        if edge == To::Line && self.promise == Promise::Never { Fall::Never } else { Fall::Unknown }
    }
}

/// A doubt of an edge, and from when to when.
type Doubted = (To, Doubt, f64, f64);

/// The edge taken, if any, and the doubts.
fn run(runner: &Runner, start: f64, span: f64) -> Result<(Option<To>, Vec<Doubted>), Error> {
    let run = Simulation::of(runner).run(false, start, 0.0..span)?;
    assert_eq!(run.end.stop, Stop::Time);
    let doubts = run.trajectory.doubts().iter();
    let doubts = doubts.filter_map(|it| Some((it.edge, it.evidence.doubt()?, it.doubt()?.start, it.doubt()?.end)));
    Ok((run.trajectory.jumps().first().and_then(saltus::Jump::edge), doubts.collect()))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(128)))]

    /// At a jump by another edge, and at the end of the span; by steps and exactly, whatever the
    /// entry.
    #[test]
    fn a_false_promise_is_doubted(
        power in -6..6_i32, line in 0.2..0.8_f64, ends in prop::sample::select(vec![true, false]), exact: bool,
        promise in prop::sample::select(vec![Promise::Affine, Promise::Never]),
        entry in prop::sample::select(vec![Entry::Refuse, Entry::Fire, Entry::Wait]),
    ) {
        let unit = 10.0_f64.powi(power);
        // Formulas are asked for on exact arcs only.
        let exact = exact || promise == Promise::Never;
        let wall = if ends { -10.0 } else { 0.5 * line } * unit;
        let runner = Runner { line: line * unit, wall, entry, exact, promise };
        let outcome = run(&runner, unit, (1.0 - 0.25 * line) * unit);
        if promise == Promise::Affine {
            prop_assert_eq!(outcome.unwrap_err().kind(), ErrorKind::Promise);
            return Ok(());
        }
        let (edge, doubts) = outcome.unwrap();
        prop_assert_eq!(edge, if ends { None } else { Some(To::Wall) });
        let missed: Vec<_> = doubts.iter().filter(|it| it.1 == Doubt::Missed).collect();
        prop_assert!(missed.len() == 1 && missed[0].0 == To::Line, "{:?}", doubts);
        let crossed = (1.0 - line) * unit;
        prop_assert!(missed[0].2 < crossed && crossed < missed[0].3);
    }

    /// Without such a promise it is found, and nothing is doubted.
    #[test]
    fn what_is_found_is_not_doubted(power in -6..6_i32, line in 0.2..0.8_f64, exact: bool) {
        let unit = 10.0_f64.powi(power);
        let (entry, promise) = (Entry::Refuse, Promise::Nothing);
        let runner = Runner { line: line * unit, wall: 0.1 * unit, entry, exact, promise };
        let (edge, doubts) = run(&runner, unit, unit).unwrap();
        prop_assert_eq!(edge, Some(To::Line));
        prop_assert!(doubts.iter().all(|doubt| doubt.1 != Doubt::Missed), "{:?}", doubts);
    }

    /// An edge that waits is outside until its guard rises: that is no crossing that was missed.
    #[test]
    fn what_waits_outside_is_not_doubted(power in -6..6_i32, line in 0.2..0.8_f64, exact: bool) {
        let unit = 10.0_f64.powi(power);
        let (entry, promise) = (Entry::Wait, Promise::Nothing);
        let runner = Runner { line: line * unit, wall: -10.0 * unit, entry, exact, promise };
        let (edge, doubts) = run(&runner, 0.9 * line * unit, line * unit).unwrap();
        prop_assert_eq!((edge, doubts.len()), (None, 0), "{:?}", doubts);
    }
}
