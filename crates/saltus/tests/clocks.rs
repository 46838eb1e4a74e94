//! Clocks against integers: every tick once, in order, also where several coincide.

use std::ops::ControlFlow;

use proptest::prelude::*;
use saltus::{About, Automaton, Clock, Clocks, Edges, Entry, ErrorKind, Hybrid, JumpOf, Observer, Refusal, Simulation};
use saltus_cases::cases;

/// Clocks that count, and one guard of time.
struct Clocked {
    clocks: Vec<(Clock, usize)>,
    /// The guard falls at this time, by the edge `CROSSING`.
    crossing: f64,
    /// Whether modes alternate at each jump, the second listing the clocks backwards.
    modes: bool,
    backwards: Vec<(Clock, usize)>,
}

const CROSSING: usize = usize::MAX;

impl Clocked {
    fn new(clocks: Vec<Clock>) -> Self {
        let clocks: Vec<_> = clocks.into_iter().enumerate().map(|(place, clock)| (clock, place)).collect();
        let backwards = clocks.iter().rev().cloned().collect();
        Self { clocks, crossing: f64::INFINITY, modes: false, backwards }
    }
}

impl Automaton for Clocked {
    type Mode = bool;
    type State = f64;
    type Edge = usize;

    fn flow(&self, _: bool, _t: f64, _x: &f64) -> f64 {
        0.0
    }
    fn solution(&self, _: bool, _t: f64, x: &f64) -> saltus::Solution<Self> {
        saltus::Solution::Polynomial([*x].into())
    }
    fn edges(&self, _: bool) -> Edges<'_, usize> {
        if self.crossing.is_finite() { Edges::from([CROSSING]) } else { Edges::none() }
    }
    fn guard(&self, _: usize, t: f64, _x: &f64) -> f64 {
        self.crossing - t
    }
    fn about(&self, _: usize) -> About {
        About::new().entry(Entry::Wait)
    }
    fn clocks(&self, second: bool) -> Clocks<'_, usize> {
        Clocks::kept(if second { &self.backwards } else { &self.clocks })
    }
    fn reset(&self, second: bool, _: usize, _t: f64, x: &f64) -> Result<(bool, f64), Refusal> {
        Ok((second ^ self.modes, x + 1.0))
    }
}

/// The edges taken, and when.
#[derive(Default)]
struct Taken(Vec<(usize, f64)>);

impl Observer<Clocked> for Taken {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &JumpOf<Clocked>) -> ControlFlow<()> {
        self.0.extend(jump.edge().map(|edge| (edge, jump.t())));
        ControlFlow::Continue(())
    }
}

fn taken(model: &Clocked, from: f64, to: f64) -> Vec<(usize, f64)> {
    let mut taken = Taken::default();
    Simulation::of(model).drive(false, 0.0, from..to, &mut taken).unwrap();
    taken.0
}

/// A clock in integers of a unit of time: its period, and its phase if it has one.
type Integer = (i64, Option<i64>);

/// All ticks after `from` and up to `to`: (clock, time), at one time in the order of the clocks.
fn by_integers(clocks: &[Integer], from: i64, to: i64) -> Vec<(usize, i64)> {
    let mut ticks = Vec::new();
    for (place, &(period, phase)) in clocks.iter().enumerate() {
        let offset = phase.unwrap_or(0);
        let next = offset + ((from - offset).div_euclid(period) + 1) * period;
        let first = phase.map_or(next, |phase| next.max(phase));
        ticks.extend((first..=to).step_by(period as usize).map(|time| (time, place)));
    }
    ticks.sort_unstable();
    ticks.into_iter().map(|(time, place)| (place, time)).collect()
}

fn clocks(list: &[Integer], unit: f64) -> Vec<Clock> {
    let clock = |&(period, phase): &Integer| {
        let every = Clock::every(period as f64 * unit);
        phase.map_or(every.clone(), |phase| every.after(phase as f64 * unit))
    };
    list.iter().map(clock).collect()
}

/// What a run takes, its times as the integers that they round to.
fn counted(list: &[Integer], unit: f64, from: i64, to: i64) -> Vec<(usize, i64)> {
    let model = Clocked::new(clocks(list, unit));
    let ticks = taken(&model, from as f64 * unit, to as f64 * unit);
    let mut last = f64::NEG_INFINITY;
    let integer = |(place, t): (usize, f64)| {
        assert!(t >= last, "{t} after {last}");
        last = t;
        let k = (t / unit).round();
        let largest =
            list.iter().filter_map(|clock| clock.1).fold(t.abs(), |most, phase| most.max((phase as f64 * unit).abs()));
        assert!((t - k * unit).abs() <= 4.0 * f64::EPSILON * largest, "{t} is no multiple of {unit}");
        (place, k as i64)
    };
    ticks.into_iter().map(integer).collect()
}

/// Units of time: decimal ones, whose multiples are rounded, and binary ones, whose are not.
fn units() -> impl Strategy<Value = f64> {
    prop_oneof![Just(1e-3), Just(0.1), Just(1e-6), Just(1.0 / 3.0), Just(0.125), Just(1.0), Just(7e-9)]
}

fn periods() -> impl Strategy<Value = Vec<Integer>> {
    prop::collection::vec((1_i64..40, prop::option::of(-60_i64..60)), 1..6)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(400)))]

    #[test]
    fn ticks_against_integers(list in periods(), unit in units(), from in -200_i64..200, length in 0_i64..400) {
        let to = from + length;
        prop_assert_eq!(counted(&list, unit, from, to), by_integers(&list, from, to));
    }

    /// Of runs that follow each other each tick is in one.
    #[test]
    fn spans_that_follow_each_other(list in periods(), unit in units(), cuts in prop::collection::vec(-300_i64..300, 2..5)) {
        let mut cuts = cuts;
        cuts.sort_unstable();
        let parts: Vec<_> = cuts.windows(2).flat_map(|cut| counted(&list, unit, cut[0], cut[1])).collect();
        prop_assert_eq!(parts, by_integers(&list, cuts[0], cuts[cuts.len() - 1]));
    }

    /// A crossing at the time of a tick comes first, and costs no tick. A phase far beyond it is
    /// rounded more coarsely than the time is.
    #[test]
    fn crossings_that_coincide(list in periods(), unit in units(), at in 1_i64..300) {
        prop_assume!(list.iter().all(|&(_, phase)| phase.is_none_or(|phase| phase.abs() <= 8 * at)));
        let mut model = Clocked::new(clocks(&list, unit));
        model.crossing = at as f64 * unit;
        let ticks = taken(&model, 0.0, 300.0 * unit);
        let place = ticks.iter().position(|tick| tick.0 == CROSSING).unwrap();
        let before = by_integers(&list, 0, 300).iter().filter(|tick| tick.1 < at).count();
        prop_assert_eq!(place, before);
        let rest: Vec<_> = ticks.iter().map(|tick| tick.0).filter(|&edge| edge != CROSSING).collect();
        let integers: Vec<_> = by_integers(&list, 0, 300).into_iter().map(|tick| tick.0).collect();
        prop_assert_eq!(rest, integers);
    }

    /// Clocks that are listed by two modes in different order tick once, whichever mode the run is
    /// in.
    #[test]
    fn modes_that_share_clocks(list in periods(), unit in units(), to in 1_i64..200) {
        let mut model = Clocked::new(clocks(&list, unit));
        model.modes = true;
        let mut ticks: Vec<_> = taken(&model, 0.0, to as f64 * unit)
            .into_iter()
            .map(|(place, t)| ((t / unit).round() as i64, list[place]))
            .collect();
        ticks.sort_unstable();
        let mut integers: Vec<_> =
            by_integers(&list, 0, to).into_iter().map(|(place, time)| (time, list[place])).collect();
        integers.sort_unstable();
        prop_assert_eq!(ticks, integers);
    }

    /// Paused after any jump, also between two at one instant, a run goes on to the bit.
    #[test]
    fn pauses(list in periods(), unit in units(), pause in 1_usize..50) {
        let model = Clocked::new(clocks(&list, unit));
        let simulation = Simulation::of(&model);
        let span = 0.0..100.0 * unit;
        let mut course = simulation.start(false, 0.0, span.clone()).unwrap();
        let mut before = Taken::default();
        for _ in 0..pause {
            course.advance(&mut before).unwrap();
        }
        let mut resumed = simulation.resume(course.checkpoint());
        resumed.finish(&mut before).unwrap();
        prop_assert_eq!(before.0, taken(&model, span.start, span.end));
    }

    /// Lists of times and functions tick as the periods that they stand for.
    #[test]
    fn lists_and_functions(period in 1_i64..30, other in 1_i64..30, unit in units(), to in 1_i64..300) {
        let times: Vec<f64> = (1..=to / period).map(|k| (k * period) as f64 * unit).collect();
        let step = other as f64 * unit;
        let next = move |t: f64| {
            let k = (t / step).floor();
            [k, k + 1.0, k + 2.0].into_iter().map(|k| k * step).find(|&time| time > t)
        };
        let model = Clocked::new(vec![Clock::at(times), Clock::from_fn(next)]);
        let ticks = taken(&model, 0.0, to as f64 * unit);
        let places: Vec<_> = ticks.iter().map(|tick| (tick.0, (tick.1 / unit).round() as i64)).collect();
        prop_assert_eq!(places, by_integers(&[(period, None), (other, None)], 0, to));
    }
}

/// A hundred thousand ticks of two clocks, as many as `CLOCKS=1000000` asks for: counted, and each
/// at k times its period.
#[test]
fn many_ticks() {
    let count: u64 = std::env::var("CLOCKS").ok().and_then(|count| count.parse().ok()).unwrap_or(100_000);
    let model = Clocked::new(vec![Clock::every(1e-3), Clock::every(1e-2)]);
    let ticks = taken(&model, 0.0, count as f64 * 1e-3);
    let of = |place: usize| ticks.iter().filter(move |tick| tick.0 == place);
    assert_eq!((of(0).count() as u64, of(1).count() as u64), (count, count / 10));
    for (k, tick) in of(0).enumerate() {
        assert_eq!(tick.1, (k + 1) as f64 * 1e-3);
    }
}

#[test]
fn a_span_that_ends_just_before_or_after_a_tick() {
    let count = |end: f64| taken(&Clocked::new(vec![Clock::every(0.1)]), 0.0, end).len();
    let tick = 7.0 * 0.1;
    assert_eq!([count(tick - 1e-9), count(tick), count(tick + 1e-9)], [6, 7, 7]);
    // A rounding short of it is at it, as for a crossing.
    assert_eq!(count(tick.next_down()), 7);
}

#[test]
fn clocks_that_cannot_tick() {
    let said = |clock: Clock| {
        let model = Clocked::new(vec![clock.clone()]);
        let error = Simulation::of(&model).run(false, 0.0, 0.0..1.0).unwrap_err().error;
        assert_eq!((error.kind(), error.edge()), (ErrorKind::Clock, Some("0")), "{error}");
        let hybrid = Hybrid::new().mode("here", |_t, _x: &f64| 0.0).mode("there", |_t, _x| 0.0).clock(
            "there",
            "here",
            clock,
            |_t, x| *x,
        );
        (error.to_string(), Simulation::of(&hybrid).run("here", 0.0, 0.0..1.0))
    };
    for clock in [
        Clock::every(0.0),
        Clock::every(-1.0),
        Clock::every(f64::NAN),
        Clock::every(f64::INFINITY),
        Clock::every(1.0).after(f64::NAN),
        Clock::at([1.0, 0.5]),
        Clock::at([0.5, 0.5]),
        Clock::at([f64::NAN]),
    ] {
        let (text, hybrid) = said(clock);
        assert!(text.contains("give "), "{text}");
        // In a mode that the run may never enter it is found before it starts.
        assert_eq!(hybrid.unwrap_err().error.kind(), ErrorKind::Model);
    }
    // A function is known by what it answers.
    let (text, hybrid) = said(Clock::from_fn(|t| Some(t - 1.0)));
    assert!(text.contains("when asked for its first tick after t = "), "{text}");
    assert!(hybrid.is_ok());
    let (text, _) = said(Clock::from_fn(|_| Some(f64::NAN)));
    assert!(text.contains("answers NaN"), "{text}");
}

/// Rounding makes an answer that is worked out from the time itself no later than the time.
#[test]
fn a_function_that_stands_still() {
    let model = Clocked::new(vec![Clock::from_fn(|t| Some(((t / 0.1).floor() + 1.0) * 0.1))]);
    let failed = Simulation::of(&model).run(false, 0.0, 0.0..100.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Clock);
    assert!(failed.trajectory.jumps().len() < 1000);
}

#[test]
fn a_period_below_the_spacing_of_time() {
    for clock in [Clock::every(1e-9), Clock::at([0.0, 0.5e-9]).repeated(1e-9)] {
        let model = Clocked::new(vec![clock]);
        let error = Simulation::of(&model).run(false, 0.0, 1e9..1e9 + 1.0).unwrap_err().error;
        assert_eq!(error.kind(), ErrorKind::Clock);
        assert!(error.to_string().contains("too short beside the spacing of time"), "{error}");
    }
}
