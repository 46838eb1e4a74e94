//! Times at which a flow is not smooth: each is met exactly, and nothing else happens there.

use proptest::prelude::*;
use saltus::{Clock, Edge, Entry, ErrorKind, Filippov, Hybrid, Reversed, RunOf, Side, Sides, Signal, Simulation};

use crate::methods::methods;

/// An input that is constant between its knots.
#[derive(Clone, Debug)]
struct Held {
    knots: Vec<f64>,
    rates: Vec<f64>,
    /// Whether a knot has the value of after it.
    from_right: bool,
}

impl Held {
    fn at(&self, t: f64) -> f64 {
        let place = self.knots.partition_point(|&knot| if self.from_right { knot <= t } else { knot < t });
        self.rates[place]
    }

    /// Its integral from 0 to t.
    fn integral(&self, t: f64) -> f64 {
        let ends = || self.knots.iter().copied().chain([f64::INFINITY]);
        let starts = [0.0].into_iter().chain(self.knots.iter().copied());
        starts.zip(ends()).zip(&self.rates).map(|((a, b), rate)| rate * (b.min(t) - a).max(0.0)).sum()
    }
}

/// Up to a dozen knots, some a hair apart, and what the input is between them.
fn held() -> impl Strategy<Value = Held> {
    let knots = prop::collection::btree_set(1..10_000_u32, 1..12);
    (knots, prop::num::u64::ANY, any::<bool>()).prop_map(|(knots, seed, from_right)| {
        let knots: Vec<f64> = knots.into_iter().map(|k| f64::from(k) * 1e-3).collect();
        let rates = (0..=knots.len() as u64).map(|k| ((seed ^ (k * 0x9e37_79b9)) % 2001) as f64 - 1000.0).collect();
        Held { knots, rates, from_right }
    })
}

type Integrator<'a> = Hybrid<'a, [f64; 2]>;

/// x' = input(t), y' = 1.
fn integrator(input: &Held) -> Integrator<'_> {
    Hybrid::new().mode("run", |t, _x: &[f64; 2]| [input.at(t), 1.0]).stops("run", Clock::at(input.knots.clone()))
}

fn run<'a>(model: &Integrator<'a>, stepper: usize, end: f64) -> RunOf<Integrator<'a>> {
    Simulation::of(model).stepper(methods()[stepper]).run("run", [0.0; 2], 0.0..end).unwrap()
}

proptest! {
    /// The integral is exact to rounding by every stepper, whichever side a knot belongs to; steps
    /// are not tried in vain, and no knot is a jump.
    #[test]
    fn an_input_that_switches(input in held(), stepper in 0..4_usize, end in 1e-3..12.0_f64) {
        let model = integrator(&input);
        let run = run(&model, stepper, end);
        let size = 1000.0 * 12.0;
        prop_assert!((run.end.state[0] - input.integral(end)).abs() < 64.0 * f64::EPSILON * size);
        prop_assert!((run.end.state[1] - end).abs() < 1e-11);
        prop_assert_eq!((run.end.stats.jumps, run.end.stats.rejected), (0, 0));
        for &knot in input.knots.iter().filter(|&&knot| knot < end) {
            let off = run.trajectory.at(knot).unwrap()[0] - input.integral(knot);
            prop_assert!(off.abs() < 64.0 * f64::EPSILON * size, "{} at {}", off, knot);
        }
    }

    /// Each crossing of a level is found once, also one at a knot, and none is made up.
    #[test]
    fn crossings_among_stops(input in held(), level in -2000..2000_i32, stepper in 0..4_usize) {
        let level = f64::from(level) + 0.5;
        let crossed = |_t: f64, x: &[f64; 2]| if level > 0.0 { level - x[0] } else { x[0] - level };
        let model = integrator(&input).edge("run", "run", crossed, |_t, x| *x).entry(Entry::Wait);
        let mut expected = 0;
        let inside = |t: f64| crossed(t, &[input.integral(t), t]) >= 0.0;
        for pair in [0.0].iter().chain(&input.knots).chain(&[10.0]).collect::<Vec<_>>().windows(2) {
            expected += usize::from(inside(*pair[0]) && !inside(*pair[1]));
        }
        let run = run(&model, stepper, 10.0);
        prop_assert_eq!(run.trajectory.jumps().len(), expected);
        prop_assert!(run.trajectory.doubts().is_empty());
    }

    /// A clock that ticks at the knots loses none, and a run that is paused at a tick goes on to
    /// the bit.
    #[test]
    fn clocks_at_stops(input in held()) {
        let model = integrator(&input).clock("run", "run", Clock::at(input.knots.clone()), |_t, x| *x);
        let simulation = Simulation::of(&model);
        let whole = simulation.run("run", [0.0; 2], 0.0..10.0).unwrap();
        prop_assert_eq!(whole.trajectory.jumps().len(), input.knots.len());
        prop_assert!((whole.end.state[0] - input.integral(10.0)).abs() < 1e-9);
        let mut course = simulation.start("run", [0.0; 2], 0.0..10.0).unwrap();
        course.advance(&mut ()).unwrap();
        let resumed = simulation.resume(course.checkpoint()).finish(&mut ()).unwrap();
        prop_assert_eq!(resumed.state, whole.end.state);
    }
}

/// A kink every half second, from before the run to after it, on Taylor series and by steps.
#[test]
fn a_periodic_kink() {
    let triangle = |t: f64| (t - t.round()).abs();
    let model = Hybrid::new()
        .mode("run", move |t, _x: &[f64; 1]| [triangle(t)])
        .series("run", |t, [_]| [(t - t.value().round()).abs()])
        .stops("run", Clock::every(0.5));
    for simulation in [Simulation::of(&model), Simulation::of(&model).stepped()] {
        let run = simulation.run("run", [0.0], -3.25..20.5).unwrap();
        assert!((run.end.state[0] - 5.90625).abs() < 1e-12, "{:?}", run.end.state);
        assert!(run.end.stats.steps <= 110 && run.end.stats.rejected == 0, "{:?}", run.end.stats);
    }
}

/// Only in the mode that has it does a stop end a step.
#[test]
fn a_stop_is_of_its_mode() {
    let model = Hybrid::new()
        .mode("wait", |_t, _x: &f64| 1.0)
        .mode("work", |t, _x| if t > 2.0 { -1.0 } else { 1.0 })
        .edge("wait", "work", |_t, x| 1.0 - x, |_t, x| *x)
        .stops("work", Clock::at([0.5, 2.0]));
    let run = Simulation::of(&model).run("wait", 0.0, 0.0..3.0).unwrap();
    assert!((run.end.state - 1.0).abs() < 1e-13);
    assert_eq!(run.end.stats.rejected, 0);
}

#[test]
fn stops_that_cannot_be() {
    let error = |clock| {
        let model = Hybrid::new().mode("run", |_t, _x: &f64| 1.0).stops("run", clock);
        Simulation::of(&model).run("run", 0.0, 0.0..1.0).unwrap_err().error
    };
    let wrong = error(Clock::at([0.5, 0.25]));
    assert_eq!(wrong.kind(), ErrorKind::Model);
    assert!(wrong.to_string().contains("the stops in \"run\" has a tick at 0.5"), "{wrong}");
    let late = error(Clock::from_fn(|t| Some(t.min(0.5))));
    assert_eq!(late.kind(), ErrorKind::Clock);
    assert!(late.to_string().contains("first stop after"), "{late}");
}

/// A clock of stops, and its ticks in a span, by arithmetic of its own.
fn any_stops() -> impl Strategy<Value = (Clock, Vec<f64>)> {
    let within = |ticks: Vec<f64>| ticks.into_iter().filter(|tick| tick.abs() < SPAN - 1e-9).collect::<Vec<_>>();
    let period = || (1..400_u32).prop_map(|hundredths| f64::from(hundredths) * 0.01);
    let phase = || (-500..500_i32).prop_map(|hundredths| f64::from(hundredths) * 0.01);
    let lots = || (-2000..2000).map(f64::from);
    prop_oneof![
        period().prop_map(move |every| (Clock::every(every), within(lots().map(|k| k * every).collect()))),
        (period(), phase()).prop_map(move |(every, phase)| {
            let ticks = lots().filter(|&k| k >= 0.0).map(|k| k.mul_add(every, phase));
            (Clock::every(every).after(phase), within(ticks.collect()))
        }),
        prop::collection::btree_set(-900..900_i32, 1..9).prop_map(move |ticks| {
            let ticks: Vec<_> = ticks.into_iter().map(|tick| f64::from(tick) * 0.01).collect();
            (Clock::at(ticks.clone()), within(ticks))
        }),
        (prop::collection::btree_set(-900..900_i32, 1..9), period()).prop_map(move |(ticks, longer)| {
            let ticks: Vec<_> = ticks.into_iter().map(|tick| f64::from(tick) * 0.01).collect();
            let period = ticks[ticks.len() - 1] - ticks[0] + longer;
            let all = lots().flat_map(|k| ticks.iter().map(move |&tick| k.mul_add(period, tick)));
            let all = within(all.collect());
            (Clock::at(ticks).repeated(period), all)
        }),
    ]
}

const SPAN: f64 = 10.0;

proptest! {
    /// Each stop is the end of a step, forwards and backwards, whatever makes it tick.
    #[test]
    fn steps_end_at_stops_both_ways((clock, ticks) in any_stops()) {
        let model = Hybrid::new().mode("run", |_t, _x: &f64| 1.0).stops("run", clock);
        let there = Simulation::of(&model).run("run", 0.0, -SPAN..SPAN).unwrap();
        let reversed = Reversed::of(&model);
        let back = Simulation::of(&reversed).run("run", there.end.state, Reversed::span(SPAN, -SPAN)).unwrap();
        prop_assert!(back.end.state.abs() < 1e-12);
        let forwards: Vec<_> = there.trajectory.pieces(0).map(|piece| piece.start().seconds()).collect();
        let backwards: Vec<_> = back.trajectory.pieces(0).map(|piece| -piece.start().seconds()).collect();
        for tick in ticks {
            prop_assert!(forwards.contains(&tick) && backwards.contains(&tick), "{}", tick);
        }
    }

    /// An input that switches is undone exactly, and no step backwards is tried in vain.
    #[test]
    fn an_input_is_undone(input in held(), period in 0.0..3.0_f64, whole in any::<bool>()) {
        let samples = input.knots.iter().zip(&input.rates[1..]).map(|(&knot, &rate)| (knot, rate));
        let signal = Signal::held(samples).unwrap();
        let period = input.knots[input.knots.len() - 1] - input.knots[0] + 0.01 + period;
        let signal = if whole { signal } else { signal.repeated(period).unwrap() };
        let stops = signal.stops();
        let model = Hybrid::new().mode("run", |t, _x: &[f64; 2]| [signal.at(t), 1.0]).stops("run", stops);
        let there = Simulation::of(&model).run("run", [0.0; 2], 0.0..SPAN).unwrap();
        let reversed = Reversed::of(&model);
        let back = Simulation::of(&reversed).run("run", there.end.state, Reversed::span(SPAN, 0.0)).unwrap();
        prop_assert!(back.end.state[0].abs() < 256.0 * f64::EPSILON * 1000.0 * SPAN, "{:?}", back.end.state);
        prop_assert_eq!(back.end.stats.rejected, 0);
    }
}

/// A function of time gives the next tick only: backwards it is an error that says what to use.
#[test]
fn a_function_has_no_way_back() {
    let clock = Clock::from_fn(|t| Some(t.floor() + 1.0));
    let model = Hybrid::new().mode("run", |_t, _x: &f64| 1.0).stops("run", clock);
    let reversed = Reversed::of(&model);
    let error = Simulation::of(&reversed).run("run", 0.0, 0.0..1.0).unwrap_err().error;
    assert!(error.to_string().contains("cannot run backwards: use Clock::every"), "{error}");
}

#[test]
fn what_cannot_be_repeated() {
    let wrong = |clock: Clock| {
        let model = Hybrid::new().mode("run", |_t, _x: &f64| 1.0).stops("run", clock);
        Simulation::of(&model).run("run", 0.0, 0.0..1.0).unwrap_err().error.to_string()
    };
    assert!(wrong(Clock::at([0.0, 2.0]).repeated(2.0)).contains("repeats ticks over 2 s each 2 s"));
    assert!(wrong(Clock::at([]).repeated(2.0)).contains("has no tick to repeat"));
    assert!(wrong(Clock::every(1.0).repeated(2.0)).contains("repeats what is no list of times"));
    assert!(wrong(Clock::at([0.0]).repeated(f64::NAN)).contains("give Clock::repeated a longer period"));
}

/// Dry friction under a force that is given by samples: each knot is met, also while it slides.
#[test]
fn friction_under_a_switched_force() {
    // Held by 2 N; pushed by 5 N in each tenth second, for 10 ms, and pulled by 5 N half a period
    // later.
    let knots = [0.0, 0.01, 0.05, 0.06];
    let push = |t: f64| match t.rem_euclid(0.1) {
        u if u < 0.01 => 5.0,
        u if (0.05..0.06).contains(&u) => -5.0,
        _ => 0.0,
    };
    let block = Sides::new(
        move |t, x: &[f64; 2]| [x[1], push(t) - 2.0],
        move |t, x| [x[1], push(t) + 2.0],
        |_, x| x[1],
        |_, _| [0.0, 1.0],
    );
    let block = Filippov::of(block.affine().stops(Clock::at(knots).repeated(0.1)));
    let run = Simulation::of(&block).run(Side::Sliding, [0.0; 2], -0.02..9.98).unwrap();
    // It gains 3 m/s² for 10 ms, loses 2 m/s² for 15 ms, and is pulled back.
    let push = 1.5 * 0.01 * 0.01 + 0.03 * 0.03 / 4.0;
    let (first, jumps) = (run.trajectory.jumps()[0], run.trajectory.jumps().len());
    assert!(first.to == Side::Above && first.t() == 0.0, "{first:?}");
    assert_eq!((jumps, run.end.stats.rejected), (4 * 100, 0));
    for (t, place) in [(0.04, push), (0.09, 0.0), (9.94, push), (9.978, 0.0)] {
        let off = run.trajectory.at(t).unwrap()[0] - place;
        assert!(off.abs() < 1e-13, "{off} at {t}");
    }
}

/// Comparators of an input with levels, each an edge that counts, beside a clock at the knots.
fn comparators<'a>(input: &'a Held, levels: &[f64], clocked: bool) -> Integrator<'a> {
    let mut model = integrator(input).series("run", |t, [_, _]| {
        let zero = t * 0.0;
        [zero + input.at(t.value()), zero + 1.0]
    });
    for &level in levels {
        let edge = Edge::new(move |t, _x: &[f64; 2]| margin(level, input.at(t)), |_t, x: &[f64; 2]| *x);
        model = model.edge_with("run", "run", edge.entry(Entry::Wait));
    }
    let ticks = if clocked { input.knots.clone() } else { Vec::new() };
    model.clock("run", "run", Clock::at(ticks), |_t, x| *x)
}

/// Positive on one side of a level, and negative on the other.
fn margin(level: f64, u: f64) -> f64 {
    if level > 0.0 { level - u } else { u - level }
}

proptest! {
    /// Which comparator falls at which knot, each once and in the order declared, follows from the
    /// input on both sides of the knot, whichever side it belongs to; also at both ends of the
    /// span, and before the clock of the same instant.
    #[test]
    fn guards_that_switch_at_stops(
        input in held(),
        levels in prop::collection::vec(-1000..1000_i32, 1..4),
        stepper in 0..5_usize,
        ends in prop::array::uniform2(prop::option::of(0..12_usize)),
        clocked in any::<bool>(),
    ) {
        let levels: Vec<_> = levels.into_iter().map(|level| f64::from(level) + 0.5).collect();
        let knot = |place: Option<usize>, other| place.and_then(|place| input.knots.get(place)).map_or(other, |&knot| knot);
        let (start, end) = (knot(ends[0], 0.0), knot(ends[1], 11.0));
        prop_assume!(start < end);
        let model = comparators(&input, &levels, clocked);
        let simulation = Simulation::of(&model);
        let simulation = match methods().get(stepper) {
            Some(method) => simulation.stepper(*method).stepped(),
            None => simulation,
        };
        let run = simulation.run("run", [0.0; 2], start..end).unwrap();
        let mut expected = Vec::new();
        for (place, &knot) in input.knots.iter().enumerate().filter(|(_, knot)| start < **knot && **knot <= end) {
            let falls = |&(_, &level): &(usize, &f64)| {
                margin(level, input.rates[place]) >= 0.0 && margin(level, input.rates[place + 1]) < 0.0
            };
            expected.extend(levels.iter().enumerate().filter(falls).map(|(edge, _)| (knot, edge)));
            if clocked {
                expected.push((knot, levels.len()));
            }
        }
        let found: Vec<_> =
            run.trajectory.jumps().iter().map(|jump| (jump.t(), jump.edge().unwrap().place)).collect();
        prop_assert_eq!(found, expected);
        prop_assert!(run.trajectory.doubts().is_empty());
        prop_assert!((run.end.state[0] - input.integral(end) + input.integral(start)).abs() < 1e-9);
    }

    /// A switch that follows the sign of an input goes over and back at its knots, by the edge that
    /// falls there.
    #[test]
    fn modes_that_switch_at_stops(input in held(), stepper in 0..4_usize) {
        let high = input.at(0.0) >= 0.0;
        let model: Hybrid<'_, f64> = Hybrid::new()
            .mode("high", |_t, _x: &f64| 1.0)
            .mode("low", |_t, _x| -1.0)
            .edge("high", "low", |t, _x| input.at(t) + 0.5, |_t, x| *x)
            .edge("low", "high", |t, _x| -0.5 - input.at(t), |_t, x| *x)
            .stops("high", Clock::at(input.knots.clone()))
            .stops("low", Clock::at(input.knots.clone()));
        let start = if high { "high" } else { "low" };
        let run = Simulation::of(&model).stepper(methods()[stepper]).run(start, 0.0, 0.0..12.0).unwrap();
        let changes = (0..input.knots.len()).filter(|&k| (input.rates[k] >= 0.0) != (input.rates[k + 1] >= 0.0));
        let expected: Vec<_> = changes.map(|k| input.knots[k]).collect();
        let found: Vec<_> = run.trajectory.jumps().iter().map(saltus::Jump::t).collect();
        prop_assert_eq!(found, expected);
        prop_assert!(run.trajectory.doubts().is_empty());
    }
}

/// A short pulse of a guard is met on exact arcs as well.
#[test]
fn pulses_of_a_guard_on_exact_arcs() {
    let pulse = |t: f64| t.rem_euclid(1.0) < 1e-6;
    let pulses = Clock::at([0.0, 1e-6]).repeated(1.0);
    let counter = Hybrid::new()
        .exact("run", |_t, x: &f64| [*x, 1.0].into())
        .edge("run", "run", move |t, _x| if pulse(t) { -1.0 } else { 1.0 }, |_t, x| *x)
        .stops("run", pulses);
    let run = Simulation::of(&counter).run("run", 0.0, 0.5..100.5).unwrap();
    assert_eq!(run.trajectory.jumps().len(), 100);
    assert!((run.end.state - 100.0).abs() < 1e-12 && run.trajectory.doubts().is_empty());
}

proptest! {
    /// What a tick reads of an input that switches at the same instant is the value behind the
    /// switch, however both times are rounded.
    #[test]
    fn ticks_read_what_is_behind_a_knot(tenths in 1..23_i32, phase in 0..5_i32, knot in 1..60_i32) {
        let decimal = |tenths: i32| format!("{}.{}", tenths / 10, tenths % 10).parse::<f64>().unwrap();
        let set = Signal::held([(0.0, 0.0), (decimal(knot), 1.0)]).unwrap();
        let clock = Clock::every(decimal(tenths)).after(decimal(phase));
        let model = Hybrid::new()
            .stops_everywhere(set.stops())
            .mode("run", |_t, _x: &[f64; 2]| [0.0; 2])
            .clock("run", "run", clock, |t, x| [x[0] + set.at(t), x[1] + 1.0]);
        let run = Simulation::of(&model).run("run", [0.0; 2], 0.0..6.5).unwrap();
        let ticks = |k: &i32| phase + k * tenths;
        let all = (0..100).filter(|k| (1..=65).contains(&ticks(k)));
        let behind = all.clone().filter(|k| ticks(k) >= knot).count();
        prop_assert_eq!(run.end.state, [behind as f64, all.count() as f64]);
    }

    /// A block on a belt whose speed leaps: it slips until it has the new speed, and sticks.
    #[test]
    fn a_surface_that_leaps(input in held(), grip in 50.0..5000.0_f64, stepper in 0..4_usize) {
        let belt = Sides::new(|_, _: &f64| -grip, |_, _| grip, |t, v| v - input.at(t), |_, _| 1.0);
        let belt = Filippov::of(belt.stops(Clock::at(input.knots.clone())));
        let start = input.at(0.0);
        let run = Simulation::of(&belt).stepper(methods()[stepper]).run(Side::Sliding, start, 0.0..11.0);
        let run = run.unwrap().complete().unwrap();
        // Towards the speed of each stretch, and no further.
        let (mut v, mut t) = (start, 0.0);
        for (place, until) in (0..).zip(input.knots.iter().copied().chain([11.0])) {
            let (speed, way) = (input.rates[place], grip * (until - t));
            v += (speed - v).clamp(-way, way);
            t = until;
            let off = run.trajectory.before(t).or_else(|| run.trajectory.at(t)).unwrap() - v;
            prop_assert!(off.abs() < 1e-8, "{} at {}", off, t);
        }
    }
}

/// Released by both sides alike, a slide goes on as both flows do.
#[test]
fn a_brake_that_is_released() {
    let grip = |t: f64| if t < 1.0 { 4.0 } else { 0.0 };
    for kick in [0.0, 1.0] {
        let flow = move |sign: f64| move |t: f64, _: &[f64; 2]| [1.0, if t < 2.0 { sign * grip(t) } else { kick }];
        let brake = Sides::new(flow(-1.0), flow(1.0), |_, x: &[f64; 2]| x[1], |_, _| [0.0, 1.0]);
        let brake = Filippov::of(brake.affine().stops(Clock::at([1.0, 2.0])));
        let run = Simulation::of(&brake).run(Side::Sliding, [0.0; 2], 0.0..4.0).unwrap().complete().unwrap();
        assert!((run.end.state[0] - 4.0).abs() < 1e-12 && (run.end.state[1] - 2.0 * kick).abs() < 1e-9, "{run:?}");
    }
}

/// A slide that does not start on its surface is refused, with where it is.
#[test]
fn a_slide_off_its_surface() {
    let block = Filippov::of(Sides::new(|_, _: &f64| -2.0, |_, _| 2.0, |_, v| *v, |_, _| 1.0).affine());
    let error = Simulation::of(&block).run(Side::Sliding, 0.5, 0.0..3.0).unwrap_err().error;
    assert_eq!(error.kind(), ErrorKind::Model);
    assert!(error.to_string().contains("h = 0.5 here: start in Above"), "{error}");
}

/// Of several inputs that switch at the instant of a tick it reads each behind its knot, in any
/// order of theirs.
#[test]
fn a_tick_beside_several_knots() {
    let tick = 3.0 * 0.3; // less than 0.9
    let knots = [0.9, 0.9_f64.next_up()];
    assert!(tick < knots[0]);
    for [first, second] in [knots, [knots[1], knots[0]]] {
        let [a, b] = [first, second].map(|knot| Signal::held([(0.0, 0.0), (knot, 1.0)]).unwrap());
        let model = Hybrid::new()
            .stops_everywhere(a.stops())
            .stops_everywhere(b.stops())
            .mode("run", |_t, _x: &[f64; 2]| [0.0; 2])
            .clock("run", "run", Clock::at([tick]), |t, _x| [a.at(t), b.at(t)]);
        let run = Simulation::of(&model).run("run", [0.0; 2], 0.0..1.0).unwrap();
        assert_eq!(run.end.state, [1.0, 1.0]);
    }
}
