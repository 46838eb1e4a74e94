//! Each run ends, and its ending has a name: limits, endless spans, limits of jumps, what cannot go
//! on.

use std::time::Duration;

use proptest::prelude::*;
use saltus::step::Stepper;
use saltus::{
    Automaton, Clock, Edges, Entry, ErrorKind, Filippov, Hybrid, Passage, Polynomial, Refusal, Side, Sides, Simulation,
    Solution, Stats, Stop,
};
use saltus_cases::cases;

use crate::methods::methods;

/// Spans from a moment to for ever; at the end of none is a jump due, which rounding would decide.
const SPANS: [f64; 6] = [1.5, 1e6, 1e16, 1e100, f64::MAX, f64::INFINITY];

/// Something that would go on for ever, but for the limits of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Endless {
    /// x' = 1, taken back to 0 at 1.
    Tank,
    /// The same, solved.
    SolvedTank,
    /// x' = 0, and a guard of time that never falls.
    Still,
    /// The same, solved.
    SolvedStill,
    /// A formula, with a guard of the state that never falls.
    Swing,
    /// x'' = -x over jets.
    Series,
}

const KINDS: [Endless; 6] =
    [Endless::Tank, Endless::SolvedTank, Endless::Still, Endless::SolvedStill, Endless::Swing, Endless::Series];

impl Endless {
    fn swing(&self, (): (), _t: f64, x: &[f64; 2], s: f64) -> [f64; 2] {
        let (sin, cos) = s.sin_cos();
        [x[0] * cos + x[1] * sin, x[1] * cos - x[0] * sin]
    }
    fn series(&self, (): (), series: &mut saltus::Series<'_, [f64; 2]>) {
        series.flow(|_t, [x, v]| [v, -x]);
    }
    fn steps_itself(self) -> bool {
        matches!(self, Self::Tank | Self::Still | Self::Series)
    }
}

impl Automaton for Endless {
    type Mode = ();
    type State = [f64; 2];
    type Edge = ();

    fn flow(&self, (): (), _t: f64, x: &[f64; 2]) -> [f64; 2] {
        match self {
            Self::Tank | Self::SolvedTank => [1.0, 0.0],
            Self::Still | Self::SolvedStill => [0.0, 0.0],
            Self::Swing | Self::Series => [x[1], -x[0]],
        }
    }
    fn solution(&self, (): (), _t: f64, x: &[f64; 2]) -> Solution<Self> {
        match self {
            Self::Tank | Self::Still => Solution::Steps,
            Self::SolvedTank => Solution::Polynomial(Polynomial::from([*x, [1.0, 0.0]])),
            Self::SolvedStill => Solution::Polynomial(Polynomial::from([*x])),
            Self::Swing => Solution::Formula(Self::swing),
            Self::Series => Solution::Series(Self::series),
        }
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn guard(&self, (): (), t: f64, x: &[f64; 2]) -> f64 {
        match self {
            Self::Tank | Self::SolvedTank => 1.0 - x[0],
            Self::Still | Self::SolvedStill => 1.0 + (-t * t).exp(),
            Self::Swing | Self::Series => 3.0 + x[0],
        }
    }
    fn reset(&self, (): (), (): (), _t: f64, _x: &[f64; 2]) -> Result<((), [f64; 2]), Refusal> {
        Ok(((), [0.0, 0.0]))
    }
}

#[derive(Clone, Copy, Debug)]
enum Most {
    Jumps(usize),
    Steps(u64),
    Evaluations(u64),
}

fn limited<'a, A: Automaton, M: Stepper>(simulation: Simulation<'a, A, M>, most: Most) -> Simulation<'a, A, M> {
    match most {
        Most::Jumps(most) => simulation.most_jumps(most),
        Most::Steps(most) => simulation.most_steps(most),
        Most::Evaluations(most) => simulation.most_evaluations(most),
    }
}

fn ending(kind: Endless, method: usize, most: Most, longest: Option<f64>, end: f64) -> (Stop<()>, Stats) {
    let simulation = limited(Simulation::of(&kind).stepper(methods()[method]), most);
    let simulation = longest.map_or(simulation, |longest| simulation.longest_step(longest));
    let ending = simulation.drive((), [0.0, 0.5], 0.0..end, &mut ()).unwrap();
    (ending.stop, ending.stats)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(300)))]

    /// Every limit stops every run, whatever the span: it ends by the limit that was set, or before
    /// it.
    #[test]
    fn every_limit_stops_every_run(
        kind in 0..KINDS.len(),
        method in 0..4_usize,
        span in 0..SPANS.len(),
        exponent in 0.0..3.5_f64,
        longest in prop_oneof![Just(None), (-3.0..3.0_f64).prop_map(|power| Some(10_f64.powf(power)))],
    ) {
        let (kind, end) = (KINDS[kind], SPANS[span]);
        let count = 10_f64.powf(exponent) as u64;
        let steps = Most::Steps(count);
        let (stop, stats) = ending(kind, method, steps, longest, end);
        let natural = matches!(stop, Stop::Time | Stop::Forever | Stop::Jumps { .. });
        prop_assert!(natural || stop == Stop::Steps { most: count }, "{kind:?} {stop:?}");
        prop_assert!(stats.steps + stats.windows <= count, "{stats:?}");

        let (stop, stats) = ending(kind, method, Most::Evaluations(count), longest, end);
        prop_assert!(natural || stop == Stop::Evaluations { most: count } || stop == Stop::Forever, "{kind:?} {stop:?}");
        prop_assert!(stats.evaluations() <= count + 100_000, "{stats:?}");

        if kind == Endless::Tank || kind == Endless::SolvedTank {
            let most = 1 + count as usize;
            let (stop, stats) = ending(kind, method, Most::Jumps(most), longest, end);
            let expected = if most as f64 <= end { Stop::Jumps { most } } else { Stop::Time };
            prop_assert_eq!((stop, stats.jumps), (expected, most.min(end as usize)));
        }
    }
}

/// What stands still, or a formula that is searched to the end of numbers, ends an endless span by
/// name.
#[test]
fn what_lasts_for_ever() {
    for kind in [Endless::Still, Endless::SolvedStill] {
        for method in 0..4 {
            let (stop, stats) = ending(kind, method, Most::Jumps(9), None, f64::INFINITY);
            assert_eq!(stop, Stop::Forever, "{kind:?}");
            assert!(stats.evaluations() < 1_000_000, "{kind:?} {stats:?}");
            assert_eq!(stats.steps > 0, kind.steps_itself());
            // A span with an end has one.
            assert_eq!(ending(kind, method, Most::Jumps(9), None, 1e9).0, Stop::Time);
        }
    }
    // A mode without edges, moving.
    let drift = Hybrid::new().exact("drift", |_t, x: &f64| [*x, 2.0].into());
    let run = Simulation::of(&drift).run("drift", 1.0, 0.0..f64::INFINITY).unwrap();
    assert_eq!((run.end.stop, run.trajectory.end().seconds()), (Stop::Forever, f64::INFINITY));
    assert_eq!(run.trajectory.at(1e9), Some(1.0 + 2e9));
}

/// x' = r x, by a formula.
struct Growth(f64);

impl Growth {
    fn grown(&self, (): (), _t: f64, x: &f64, s: f64) -> f64 {
        x * (self.0 * s).exp()
    }
}

impl Automaton for Growth {
    type Mode = ();
    type State = f64;
    type Edge = ();

    fn flow(&self, (): (), _t: f64, x: &f64) -> f64 {
        self.0 * x
    }
    fn solution(&self, (): (), _t: f64, _x: &f64) -> Solution<Self> {
        Solution::Formula(Self::grown)
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::none()
    }
    fn guard(&self, (): (), _t: f64, _x: &f64) -> f64 {
        1.0
    }
    fn reset(&self, (): (), (): (), _t: f64, x: &f64) -> Result<((), f64), Refusal> {
        Ok(((), *x))
    }
}

/// A record of a formula is right however long the span.
#[test]
fn a_formula_recorded_over_long_spans() {
    for end in SPANS {
        let run = Simulation::of(&Growth(-1.0)).run((), 1.0, 0.0..end).unwrap();
        assert_eq!(run.end.stop, if end == f64::INFINITY { Stop::Forever } else { Stop::Time });
        for t in [0.0_f64, 1e-3, 0.5, 1.0, 7.0, 100.0, 700.0] {
            let exact = (-t).exp();
            let off = run.trajectory.at(t.min(end)).unwrap() - if t <= end { exact } else { (-end).exp() };
            assert!(off.abs() < 1e-11, "{off:e} at {t} of {end:e}");
        }
    }
}

/// A record grows no larger than it may, by pieces or by jumps.
#[test]
fn a_record_is_bounded() {
    for kind in KINDS.into_iter().filter(|kind| !matches!(kind, Endless::Still | Endless::SolvedStill)) {
        for most in [1, 1000, 100_000] {
            let run = Simulation::of(&kind).most_bytes(most).run((), [0.0, 0.5], 0.0..f64::INFINITY).unwrap();
            assert_eq!(run.end.stop, Stop::Bytes { most }, "{kind:?}");
            let pieces: usize = (0..run.trajectory.arcs().len()).map(|arc| run.trajectory.pieces(arc).count()).sum();
            assert!(pieces * 32 <= most + 2000, "{kind:?}: {pieces} pieces");
            assert_eq!(
                run.trajectory.end().seconds(),
                run.trajectory.jumps().last().map_or(0.0, |jump| jump.t()).max(run.trajectory.end().seconds())
            );
        }
    }
}

/// The limits that a run goes beyond are counted, and the last one is said: a ball that is thrown
/// up again and again.
#[test]
fn limits_are_reported() {
    let ball = Hybrid::new()
        .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.8])
        .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.5 * x[1]])
        .mode("rest", |_t, _x| [0.0, 0.0])
        .beyond("flight", "rest", |_t, _x| [0.0, 0.0])
        .clock("rest", "flight", Clock::every(10.0), |_t, _x| [1.0, 0.0]);
    for passes in 1..6 {
        let end = 10.0 * f64::from(passes) - 5.0;
        let run = Simulation::of(&ball).run("flight", [1.0, 0.0], 0.0..end).unwrap();
        let last = end - 5.0 + 3.0 * (2.0_f64 / 9.8).sqrt();
        assert_eq!((run.end.limits.count, run.end.stop), (passes as usize, Stop::Time));
        // One that comes less than a rounding early is at one instant.
        assert!(
            (run.end.limits.last.unwrap() - (last - 5.0)).abs() < 1e-9
                || (run.end.limits.last.unwrap() - last).abs() < 6.0
        );
    }
    let run = Simulation::of(&ball).run("flight", [1.0, 0.0], 0.0..1.0).unwrap();
    assert_eq!((run.end.limits.count, run.end.limits.last), (0, None));
}

fn decided<F: Fn(f64, &[f64; 2]) -> [f64; 2], G: Fn(f64, &[f64; 2]) -> [f64; 2]>(
    above: F,
    below: G,
    mode: Side,
    x: [f64; 2],
    end: f64,
) -> Result<(Stop<Passage>, f64, Stats), ErrorKind> {
    let sides = Filippov::of(Sides::new(above, below, |_, x: &[f64; 2]| x[1], |_, _| [0.0, 1.0]));
    let ending = Simulation::of(&sides).drive(mode, x, 0.0..end, &mut ()).map_err(|error| error.kind())?;
    Ok((ending.stop, ending.time.seconds(), ending.stats))
}

proptest! {
    /// Where neither flow pushes against the surface, a slide ends at once and by name: from the
    /// start, as the surface is met, and where a slide loses both pushes together.
    #[test]
    fn neither_side_wins(scale in -6.0..6.0_f64, lean in 0.1..10.0_f64, at in 0.1..10.0_f64) {
        let k = 10_f64.powf(scale);
        let undecided = Stop::Undetermined { edge: Passage::Undecided };
        // Along the surface on both sides.
        let along = decided(move |_, _| [k, 0.0], move |_, _| [-k, 0.0], Side::Sliding, [0.0, 0.0], f64::INFINITY).unwrap();
        prop_assert_eq!((along.0, along.1), (Stop::Undetermined { edge: Passage::Unpushed }, 0.0));
        // Pushed together until x = 0, from both sides, and apart beyond.
        let (stop, t, stats) = decided(
            move |_, x| [1.0, k * x[0]],
            move |_, x| [1.0, -k * lean * x[0]],
            Side::Sliding,
            [-at, 0.0],
            100.0,
        )
        .unwrap();
        prop_assert!(stop == undecided && !stop.is_asked());
        prop_assert!((t - at).abs() < 1e-9 * at && stats.evaluations() < 10_000, "{} {:?}", t, stats);
    }
}

/// Flows that both vanish towards the surface, and one that is met with both along it.
#[test]
fn neither_side_wins_where_the_surface_is_met() {
    // Met at x = 1 at the very place at which both pushes are lost.
    let met = decided(|_, x| [1.0, x[0] - 1.0], |_, x| [1.0, 1.0 - x[0]], Side::Above, [0.0, 0.5], 100.0).unwrap();
    assert!(
        matches!(met.0, Stop::Undetermined { edge: Passage::Undecided | Passage::Unpushed })
            && met.2.evaluations() < 10_000,
        "{met:?}"
    );
}

/// Two modes that push against each other without one that slides between: the advice is Filippov.
#[test]
fn chattering_is_advised() {
    let relay = Hybrid::new()
        .mode("up", |_t, _x: &f64| 1.0)
        .mode("down", |_t, _x| -1.0)
        .edge("up", "down", |_t, x| 1.0 - x, |_t, x| *x)
        .edge("down", "up", |_t, x| x - 1.0, |_t, x| *x);
    let run = Simulation::of(&relay).longest_cascade(100).run("up", 0.0, 0.0..3.0).unwrap();
    assert!(matches!(run.end.stop, Stop::Cascade { .. }), "{:?}", run.end.stop);
    assert!(run.end.stop.to_string().contains("Filippov"));
}

/// A ball that hardly bounces, on a table that shakes, late in a run: after one or two bounces
/// rounding hides the next. That is the end of what can be resolved, and called so, unless a
/// contraction certifies a limit.
#[test]
fn what_rounding_hides_is_no_limit() {
    let (mut hidden, mut certified) = (0, 0);
    for (k, restitution) in [1e-12, 1e-9, 1e-6, 1e-4, 0.3, 0.5].into_iter().cycle().take(120).enumerate() {
        let (start, rate) = (1e3 * k as f64, 10.0 + 0.1 * k as f64);
        let table = move |t: f64| [0.01 * (rate * t).sin(), 0.01 * rate * (rate * t).cos()];
        let ball = Hybrid::new().mode("flight", |_t, x: &[f64; 2]| [x[1], -9.8]).edge(
            "flight",
            "flight",
            move |t, x| x[0] - table(t)[0],
            move |t, x| {
                let [height, speed] = table(t);
                [height, speed - restitution * (x[1] - speed)]
            },
        );
        let run = |ball: &Hybrid<'_, [f64; 2]>| {
            Simulation::of(ball).run("flight", [0.1, 0.0], start..start + 3.0).unwrap().end
        };
        let stop = run(&ball).stop;
        // A run that goes on says how many of the limits that it passed were none, for all it
        // shows.
        let passed = run(&ball.mode("rest", |_t, _x| [0.0; 2]).beyond("flight", "rest", |_t, x| *x)).limits;
        match stop {
            Stop::Resolution { limit } => {
                hidden += 1;
                assert!(limit > start && limit < start + 3.0 && restitution < 0.3, "{restitution}: {limit}");
                assert_eq!((passed.count, passed.uncertified, passed.last), (1, 1, Some(limit)));
            }
            Stop::Zeno { limit } => {
                certified += 1;
                assert_eq!((passed.count, passed.uncertified, passed.last), (1, 0, Some(limit)));
            }
            stop => assert_eq!((stop, passed.count), (Stop::Time, 0)),
        }
    }
    assert!(hidden > 10 && certified > 10, "{hidden} {certified}");
}

/// A deadline stops steps, exact arcs and jumps alike, keeps what the run had, and a resumed run
/// has as much again.
#[test]
fn a_deadline_stops_every_run() {
    let after = Duration::from_millis(5);
    let exact = Hybrid::new().exact("run", |_t, x: &[f64; 2]| [*x, [x[1], -9.8], [-4.9, 0.0]].into()).edge(
        "run",
        "run",
        |_t, x| x[0],
        |_t, x| [x[0], -x[1]],
    );
    let stepped = Hybrid::new().mode("run", |_t, x: &[f64; 2]| [x[1], -x[0]]);
    for model in [exact, stepped] {
        let simulation = Simulation::of(&model).most_jumps(usize::MAX).deadline(after);
        let run = simulation.run("run", [1.0, 0.0], 0.0..1e300).unwrap();
        assert_eq!(run.end.stop, Stop::Deadline { after });
        assert!(run.complete().is_err());
        let mut course = simulation.start("run", [1.0, 0.0], 0.0..1e300).unwrap();
        let first = course.finish(&mut ()).unwrap();
        let second = simulation.resume(course.checkpoint()).finish(&mut ()).unwrap();
        assert!(second.time > first.time && second.stop == Stop::Deadline { after });
    }
}

/// The limit on jumps holds where jumps accumulate, too: the jump beyond them is one.
#[test]
fn no_run_jumps_more_often_than_it_may() {
    let ball = Hybrid::new()
        .exact("flight", |_t, x: &[f64; 2]| [*x, [x[1], -9.81], [-4.905, 0.0]].into())
        .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.5 * x[1]])
        .affine()
        .mode("rest", |_t, _x| [0.0, 0.0])
        .beyond("flight", "rest", |_t, _x| [0.0, 0.0])
        .clock("rest", "flight", Clock::every(10.0), |_t, _x| [0.0, 3.0]);
    let all = Simulation::of(&ball).run("flight", [1.0, 0.0], 0.0..35.0).unwrap().end.jumps;
    for most in 0..all {
        let end = Simulation::of(&ball).most_jumps(most).run("flight", [1.0, 0.0], 0.0..35.0).unwrap().end;
        assert_eq!((end.stop, end.jumps), (Stop::Jumps { most }, most));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1000)))]

    /// An exact solution that is no number at the end of the span is an error; any other run ends
    /// in a state that is one, an endless one in that at the last time.
    #[test]
    fn an_end_is_a_number_or_an_error(
        powers in prop::collection::vec((-1.0..1.0_f64, -5.0..5.0_f64), 1..5),
        late in prop::option::of(-3.0..300.0_f64),
        floor in prop::option::of(0.0..300.0_f64),
        affine: bool,
    ) {
        let mut c = [0.0; 4];
        c.iter_mut().zip(&powers).for_each(|(c, (sign, size))| *c = sign.signum() * 10_f64.powf(*size));
        let end = late.map_or(f64::INFINITY, |late| 10_f64.powf(late));
        let exact = |s: f64| c.iter().rev().fold(0.0, |sum, c| sum * s + c);
        let mut model = Hybrid::new()
            .mode("run", move |t, _x: &f64| c.iter().zip(0..).skip(1).map(|(c, k)| f64::from(k) * c * t.powi(k - 1)).sum())
            .exact("run", move |_t, x| [*x, c[1], c[2], c[3]].into());
        if let Some(depth) = floor {
            let depth = 10_f64.powf(depth);
            model = model.terminal("run", move |_t, x| x + depth).entry(Entry::Wait);
            if affine {
                model = model.affine();
            }
        }
        match Simulation::of(&model).run("run", c[0], 0.0..end) {
            Ok(run) => {
                let s = run.trajectory.end().seconds().min(1e300);
                prop_assert!(run.end.state.is_finite(), "{:?}", run.end);
                if !matches!(run.end.stop, Stop::Terminal { .. }) {
                    prop_assert_eq!(run.end.state, exact(s));
                }
            }
            Err(failed) => {
                prop_assert_eq!(failed.error.kind(), ErrorKind::Flow);
                prop_assert!(!exact(end.min(1e300)).is_finite());
            }
        }
    }

    /// The same of a formula.
    #[test]
    fn an_end_of_a_formula_is_a_number_or_an_error(rate in -1.0..1.0_f64, late in prop::option::of(-3.0..10.0_f64)) {
        let end = late.map_or(f64::INFINITY, |late| 10_f64.powf(late));
        match Simulation::of(&Growth(rate)).drive((), 1.0, 0.0..end, &mut ()) {
            Ok(run) => prop_assert_eq!(run.state, (rate * end.min(1e300)).exp()),
            Err(error) => {
                prop_assert_eq!(error.kind(), ErrorKind::Flow);
                prop_assert!((rate * end.min(1e300)).exp() == f64::INFINITY);
            }
        }
    }
}
