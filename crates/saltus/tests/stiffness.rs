//! The default notices that a flow is stiff, and that it is so no more.

use saltus::{Hybrid, RunOf, Simulation, State, Stop};

use crate::methods::methods;

/// A model, its start and its end.
struct Case<S> {
    name: String,
    model: Hybrid<'static, S>,
    start: S,
    end: f64,
}

/// By a stepper chosen by hand, which gives up after so many evaluations.
fn by_hand<S: State>(case: &Case<S>, method: usize, tolerance: f64, most: u64) -> Option<RunOf<Hybrid<'static, S>>> {
    let simulation = Simulation::of(&case.model).stepper(methods()[method]).tolerance(tolerance).most_evaluations(most);
    let run = simulation.run("run", case.start.clone(), 0.0..case.end).ok()?;
    (run.end.stop == Stop::Time).then_some(run)
}

/// What it takes at most to notice that a flow is stiff: some forty steps accepted and ten
/// rejected, of twelve evaluations, and five looks.
const NOTICED: f64 = 750.0;

/// How many times as many evaluations of the flow the default takes as the best of three methods
/// chosen by hand, beyond what it takes to notice.
fn ratio<S: State>(case: &Case<S>, tolerance: f64) -> f64 {
    let auto = Simulation::of(&case.model).tolerance(tolerance).most_evaluations(3_000_000);
    let auto = auto.run("run", case.start.clone(), 0.0..case.end).unwrap().end;
    assert_eq!(auto.stop, Stop::Time, "{}: {:?}", case.name, auto.stats);
    let most = 20 * auto.stats.flows;
    let runs = [0, 1, 2].map(|method| by_hand(case, method, tolerance, most));
    let best = runs.iter().flatten().map(|run| run.end.stats.flows).min().unwrap();
    let flows = auto.stats.flows as f64 - if auto.stats.stiff > 0 { NOTICED } else { 0.0 };
    println!("{:<28} {tolerance:e}: {:.2}, {:?}", case.name, auto.stats.flows as f64 / best as f64, auto.stats);
    flows / best as f64
}

/// x'' = μ (1 - x²) x' - x over about a period and a half.
fn van_der_pol(mu: f64) -> Case<[f64; 2]> {
    let model = Hybrid::new().mode("run", move |_t, x: &[f64; 2]| [x[1], mu * (1.0 - x[0] * x[0]) * x[1] - x[0]]);
    Case { name: format!("van der Pol, mu = {mu:e}"), model, start: [2.0, 0.0], end: 2.4 * mu.max(5.0) }
}

fn robertson() -> Case<[f64; 3]> {
    let model = Hybrid::new().mode("run", |_t, x: &[f64; 3]| {
        let [slow, fast, square] = [0.04 * x[0], 1e4 * x[1] * x[2], 3e7 * x[1] * x[1]];
        [fast - slow, slow - fast - square, square]
    });
    Case { name: "Robertson".into(), model, start: [1.0, 0.0, 0.0], end: 1e6 }
}

/// A rod of ten parts that loses heat all along and is heated at one end, on and off.
fn rod(conduction: f64) -> Case<[f64; 10]> {
    let flow = move |heat: f64| {
        move |_t: f64, x: &[f64; 10]| {
            let at = |i: usize| x[i.min(9)];
            let mut slope: [f64; 10] =
                std::array::from_fn(|i| conduction * (at(i.saturating_sub(1)) - 2.0 * x[i] + at(i + 1)) - 0.5 * x[i]);
            slope[0] += heat;
            slope
        }
    };
    let model = Hybrid::new()
        .mode("run", flow(10.0))
        .mode("off", flow(0.0))
        .edge("run", "off", |_t, x: &[f64; 10]| 1.0 - x[9], |_t, x| *x)
        .edge("off", "run", |_t, x| x[9] - 0.8, |_t, x| *x);
    Case { name: format!("rod, {conduction:e}"), model, start: [0.0; 10], end: 10.0 }
}

/// A mass that falls on a spring with a damper, as stiff as it may be.
fn contact(stiffness: f64) -> Case<[f64; 2]> {
    let model = Hybrid::new()
        .mode("run", |_t, x: &[f64; 2]| [x[1], -9.81])
        .mode("touch", move |_t, x| [x[1], -9.81 - stiffness * x[0] - 3.0 * stiffness.sqrt() * x[1]])
        .edge("run", "touch", |_t, x: &[f64; 2]| x[0], |_t, x| *x);
    Case { name: format!("contact, {stiffness:e}"), model, start: [1.0, 0.0], end: 3.0 }
}

#[test]
fn no_more_than_twice_the_best_choice() {
    let mut worst: f64 = 0.0;
    for tolerance in [1e-4, 1e-6, 1e-9] {
        for power in 0..=6 {
            worst = worst.max(ratio(&van_der_pol(10_f64.powi(power)), tolerance));
        }
        worst = worst.max(ratio(&robertson(), tolerance));
        for power in [0, 2, 4, 6] {
            worst = worst.max(ratio(&rod(10_f64.powi(power)), tolerance));
            worst = worst.max(ratio(&contact(10_f64.powi(2 * power)), tolerance));
        }
    }
    assert!(worst <= 2.0, "{worst}");
}

/// The place, the speed and the pull of two masses of a restricted problem of three bodies
/// (Arenstorf).
fn arenstorf() -> Case<[f64; 4]> {
    let moon = 0.012_277_471;
    let model = Hybrid::new().mode("run", move |_t, x: &[f64; 4]| {
        let cube = |a: f64| ((x[0] - a).powi(2) + x[1] * x[1]).powf(1.5);
        let (earth, near) = (cube(-moon), cube(1.0 - moon));
        let pull = |a: f64, b: f64| (1.0 - moon) * a / earth + moon * b / near;
        [x[2], x[3], x[0] + 2.0 * x[3] - pull(x[0] + moon, x[0] - 1.0 + moon), x[1] - 2.0 * x[2] - pull(x[1], x[1])]
    });
    let start = [0.994, 0.0, 0.0, -2.001_585_106_379_082_5];
    Case { name: "Arenstorf".into(), model, start, end: 17.065_216_560_157_964 }
}

fn lorenz() -> Case<[f64; 3]> {
    let flow =
        |_t: f64, x: &[f64; 3]| [10.0 * (x[1] - x[0]), x[0] * (28.0 - x[2]) - x[1], x[0] * x[1] - 8.0 / 3.0 * x[2]];
    Case { name: "Lorenz".into(), model: Hybrid::new().mode("run", flow), start: [1.0, 1.0, 1.0], end: 20.0 }
}

fn pendulum() -> Case<[f64; 2]> {
    let model = Hybrid::new().mode("run", |_t, x: &[f64; 2]| [x[1], -x[0].sin()]);
    Case { name: "pendulum".into(), model, start: [3.0, 0.0], end: 200.0 }
}

/// The evaluations that the default takes beyond those of the method that it uses, in parts of
/// them; it changes no method.
fn overhead<S: State>(case: &Case<S>, tolerance: f64) -> f64 {
    let auto = Simulation::of(&case.model).tolerance(tolerance).run("run", case.start.clone(), 0.0..case.end).unwrap();
    assert_eq!(auto.end.stats.stiff, 0, "{} at {tolerance:e}: {:?}", case.name, auto.end.stats);
    let same = by_hand(case, usize::from(tolerance < saltus::Auto::TIGHT), tolerance, u64::MAX).unwrap();
    assert_eq!(auto.end.state.len(), same.end.state.len());
    assert!((0..auto.end.state.len()).all(|i| auto.end.state.get(i) == same.end.state.get(i)), "{}", case.name);
    auto.end.stats.flows as f64 / same.end.stats.flows as f64 - 1.0
}

/// Where nothing is stiff the default gives the numbers of the method that it uses, to the bit, for
/// hardly more evaluations.
#[test]
fn what_is_not_stiff_loses_little() {
    for tolerance in [1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12] {
        let all = [overhead(&arenstorf(), tolerance), overhead(&lorenz(), tolerance), overhead(&pendulum(), tolerance)];
        println!("{tolerance:e}: {all:?}");
        assert!(all.iter().all(|&more| more <= 0.016), "{tolerance:e}: {all:?}");
        assert!(all.iter().sum::<f64>() <= 0.035, "{tolerance:e}: {all:?}");
    }
}

/// A flow that is stiff for a while: the default goes back to explicit steps, and a run that is
/// paused anywhere goes on to the bit.
#[test]
fn there_and_back() {
    let model = Hybrid::new()
        .mode("run", |t, x: &[f64; 2]| {
            let rate = if (1.0..2.0).contains(&t) { 1e5 } else { 1.0 };
            [rate * ((20.0 * t).sin() - x[0]), x[0]]
        })
        .stops("run", saltus::Clock::at([1.0, 2.0]))
        .clock("run", "run", saltus::Clock::every(0.37), |_t, x| *x);
    for tolerance in [1e-5, 1e-9] {
        let simulation = Simulation::of(&model).tolerance(tolerance);
        let whole = simulation.drive("run", [0.0; 2], 0.0..12.0, &mut ()).unwrap();
        let stats = whole.stats;
        assert!(stats.stiff > 10 && 3 * stats.stiff < 2 * stats.steps, "{stats:?}");
        assert!(stats.flows < 20_000, "{stats:?}");
        let exact =
            Simulation::of(&model).stepper(methods()[2]).tolerance(1e-11).run("run", [0.0; 2], 0.0..12.0).unwrap().end;
        assert!((whole.state[0] - exact.state[0]).abs() < 100.0 * tolerance, "{:?} {:?}", whole.state, exact.state);
        let mut course = simulation.start("run", [0.0; 2], 0.0..12.0).unwrap();
        while course.advance(&mut ()).unwrap().is_none() {
            let resumed = simulation.resume(course.checkpoint()).finish(&mut ()).unwrap();
            assert_eq!((resumed.state, resumed.stats), (whole.state, whole.stats));
        }
    }
}
