//! Flows that are given over jets, and solved by their Taylor series.

use proptest::prelude::*;
use saltus::{About, Automaton, Coords, Dop853, Edges, ErrorKind, Hybrid, Refusal, Series, Simulation, Solution, Stop};

/// A ball under quadratic drag, in the smooth modes rising and falling or, `whole`, in one with a
/// kink at rest.
struct Ball {
    gravity: f64,
    drag: f64,
    cor: f64,
    whole: bool,
}

const BALL: Ball = Ball { gravity: 9.8, drag: 0.1, cor: 0.9, whole: false };

impl Ball {
    fn series(&self, rising: bool, series: &mut Series<'_, [f64; 2]>) {
        let &Self { gravity, drag, whole, .. } = self;
        let drag = if rising { drag } else { -drag };
        if whole {
            series.flow(|_t, [_, v]| [v, -gravity - drag.abs() * v * v.abs()]);
        } else {
            series.flow(|_t, [_, v]| [v, -gravity - drag * (v * v)]);
        }
    }
}

impl Automaton for Ball {
    type Mode = bool; // rising?
    type State = [f64; 2];
    type Edge = bool;

    fn flow(&self, rising: bool, _t: f64, &[_, v]: &[f64; 2]) -> [f64; 2] {
        let along = if self.whole { v.abs() } else { [-v, v][usize::from(rising)] };
        [v, -self.gravity - self.drag * v * along]
    }
    fn solution(&self, _: bool, _t: f64, _x: &[f64; 2]) -> Solution<Self> {
        Solution::Series(Self::series)
    }
    fn edges(&self, rising: bool) -> Edges<'_, bool> {
        Edges::from([rising && !self.whole])
    }
    fn guard(&self, apex: bool, _t: f64, x: &[f64; 2]) -> f64 {
        x[usize::from(apex)]
    }
    #[inline]
    fn about(&self, _: bool) -> About {
        About::new().affine()
    }
    fn reset(&self, _: bool, apex: bool, _t: f64, &[y, v]: &[f64; 2]) -> Result<(bool, [f64; 2]), Refusal> {
        Ok(if apex { (false, [y, 0.0]) } else { (true, [0.0, -self.cor * v]) })
    }
}

impl Ball {
    /// When it strikes the floor, dropped from `height`, by formula.
    fn impacts(&self, height: f64) -> impl Iterator<Item = f64> {
        let (rate, cor) = ((self.gravity * self.drag).sqrt(), self.cor);
        let (drag, mut t, mut rise, mut h) = (self.drag, 0.0, 0.0, height);
        std::iter::from_fn(move || {
            let speed = (-(-2.0 * drag * h).exp_m1()).sqrt(); // as parts of the speed that drag allows
            t += rise + speed.atanh() / rate;
            rise = (cor * speed).atan() / rate;
            h = (cor * speed).powi(2).ln_1p() / (2.0 * drag);
            Some(t)
        })
    }

    /// The largest error among twenty impacts, and what the run cost.
    fn run(&self, tolerance: f64) -> (f64, saltus::Stats) {
        let jumps = if self.whole { 20 } else { 39 };
        let simulation = Simulation::of(self).tolerance(tolerance).absolute_tolerance(tolerance).most_jumps(jumps);
        let run = simulation.run(false, [10.0, 0.0], 0.0..100.0).unwrap();
        let times: Vec<f64> =
            run.trajectory.jumps().iter().filter(|jump| jump.edge() == Some(false)).map(saltus::Jump::t).collect();
        assert_eq!(times.len(), 20);
        let error = times.iter().zip(self.impacts(10.0)).map(|(t, exact)| (t - exact).abs()).fold(0.0, f64::max);
        (error, run.end.stats)
    }
}

#[test]
fn digits_cost_little() {
    let mut flows = Vec::new();
    for digits in 4..=13 {
        let tolerance = 0.1_f64.powi(digits);
        let (error, stats) = BALL.run(tolerance);
        assert!(error <= 10.0 * tolerance + 2e-15, "{error:e} at {tolerance:e}");
        flows.push(stats.flows);
    }
    // Six digits more, from 1e-6 to 1e-12, cost less than 10 % each.
    assert_eq!((flows[2], flows[8]), (648, 1120), "{flows:?}");
}

#[test]
fn a_step_ends_at_a_kink() {
    for digits in 4..=13 {
        let tolerance = 0.1_f64.powi(digits);
        let (error, stats) = Ball { whole: true, ..BALL }.run(tolerance);
        assert!(error <= 10.0 * tolerance + 2e-15, "{error:e} at {tolerance:e}");
        assert_eq!(stats.rejected, 0);
        // As many steps as in two smooth modes.
        assert!(stats.steps <= BALL.run(tolerance).1.steps + 1, "{stats:?}");
    }
}

#[test]
fn kinks_of_all_kinds() {
    // x'' = -x |x|: v²/2 + |x|³/3 stays. It starts on the kink, at rest there, or an eyelash before
    // it; the last two numbers see it twice, and a touch.
    let swing = |shift: f64| {
        Hybrid::new()
            .mode("swing", move |_t, &[x, v, y, z]: &[f64; 4]| {
                let x = x - shift;
                [v, -x * x.abs(), (x + y - y).abs(), (x * x - v * v).abs() + (x * x).abs() - z]
            })
            .series("swing", move |_t, [x, v, y, z]| {
                let x = x - shift;
                [v, -x * x.abs(), (x + y - y).abs(), (x * x - v * v).abs() + (x * x).abs() - z]
            })
    };
    for [x, v] in [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0], [1e-17, -1.0], [-1e-9, 1.0], [-1e-13, 1.0], [-1e-15, 1e-3]] {
        for shift in [0.0, 0.7] {
            let swing = swing(shift);
            let simulation = Simulation::of(&swing).tolerance(1e-11).absolute_tolerance(1e-13);
            let run = simulation.run("swing", [shift + x, v, 0.0, 0.0], 0.0..100.0).unwrap();
            let energy = |x: f64, v: f64| 0.5 * v * v + (x - shift).abs().powi(3) / 3.0;
            let off = energy(run.end.state[0], run.end.state[1]) - energy(shift + x, v);
            assert!(off.abs() <= 1e-9, "{x} {v} {shift}: {off:e}");
            assert!(run.end.stats.rejected <= 4, "{x} {v} {shift}: {:?}", run.end.stats);
        }
    }
}

#[test]
fn two_kinks_at_once() {
    // One number is about to change its sign, another starts at zero.
    let apart = Hybrid::new()
        .mode("part", |_t, &[x, y]: &[f64; 2]| [-1.0 - 0.1 * x.abs(), 1.0 + 0.1 * y.abs()])
        .series("part", |_t, [x, y]| [-1.0 - 0.1 * x.abs(), 1.0 + 0.1 * y.abs()]);
    let run = Simulation::of(&apart).tolerance(1e-12).run("part", [1e-17, 0.0], 0.0..1.0).unwrap();
    let end = 10.0 * 0.1_f64.exp_m1();
    assert!((run.end.state[0] + end).abs() < 1e-14 && (run.end.state[1] - end).abs() < 1e-14, "{:?}", run.end.state);
    assert_eq!((run.end.stats.steps, run.end.stats.rejected), (1, 0), "{:?}", run.end.stats);
}

#[test]
fn a_series_of_another_flow_is_refused() {
    let other = Hybrid::new().mode("decay", |_t, x: &f64| -x).series("decay", |_t, [x]| [-1.01 * x]);
    let error = Simulation::of(&other).run("decay", 1.0, 0.0..1.0).unwrap_err().error;
    assert_eq!(error.kind(), ErrorKind::Series);
    assert_eq!(
        error.to_string(),
        "the series or exact solution is not that of the flow, from the state and with its slope: write the same flow in Automaton::solution and Automaton::flow, or in series or exact and mode of a Hybrid (t = 0, mode \"decay\", state [1.0])"
    );
    let flat = Hybrid::new().mode("decay", |_t, x: &f64| -x).series("decay", |_t, [x, _]| [-x, x]);
    let error = Simulation::of(&flat).run("decay", 1.0, 0.0..1.0).unwrap_err().error;
    assert_eq!(error.kind(), ErrorKind::Dimension);
    // The flow itself, of a list that can be of any length.
    let short = Hybrid::new().mode("decay", |_t, _x: &Coords<3>| [1.0].into()).series("decay", |_t, [x, y]| [-x, y]);
    let error = Simulation::of(&short).run("decay", [1.0, 2.0].into(), 0.0..1.0).unwrap_err().error;
    assert_eq!(error.kind(), ErrorKind::Dimension);
    for nothing in [f64::INFINITY, f64::NAN] {
        let none = Hybrid::new().mode("decay", move |_t, x: &f64| x * nothing).series("decay", |_t, [x]| [-x]);
        let error = Simulation::of(&none).run("decay", 1.0, 0.0..1.0).unwrap_err().error;
        assert_eq!(error.kind(), ErrorKind::Flow);
    }
}

#[test]
fn where_there_is_no_series_steps_go_on() {
    // A tank that fills through a slit, x' = √x + 0.1: at x = 0 the root has no series.
    let tank = Hybrid::new()
        .mode("fill", |_t, x: &f64| x.max(0.0).sqrt() + 0.1)
        .series("fill", |_t, [x]| [x.sqrt() + 0.1])
        .edge("fill", "fill", |_t, x| 1.0 - x, |_t, _x| 0.25);
    let run = Simulation::of(&tank).tolerance(1e-10).run("fill", 0.0, 0.0..3.0).unwrap();
    // t = 2 (√x - 0.1 ln(√x + 0.1)) from 0 to 1
    let full = 2.0 * (1.0 - 0.1 * (1.1_f64 / 0.1).ln());
    assert!((run.trajectory.jumps()[0].t() - full).abs() < 1e-8);
    assert_eq!(run.end.stop, Stop::Time);
}

#[test]
fn any_unit_of_time_will_do() {
    for rate in [1e-14, 1e-3, 1.0, 1e3, 1e14] {
        let swing = Hybrid::new()
            .mode("swing", move |_t, x: &[f64; 2]| [rate * x[1], -rate * x[0]])
            .series("swing", move |_t, [x, v]| [rate * v, -rate * x]);
        let end = std::f64::consts::TAU / rate;
        let run = Simulation::of(&swing).tolerance(1e-12).run("swing", [1.0, 0.0], 0.0..end).unwrap();
        assert!(
            (run.end.state[0] - 1.0).abs() < 1e-11 && run.end.state[1].abs() < 1e-11,
            "{rate:e}: {:?}",
            run.end.state
        );
        assert!(run.end.stats.steps <= 5, "{rate:e}: {} steps", run.end.stats.steps);
    }
}

#[test]
fn a_run_goes_on_from_a_checkpoint_to_the_bit() {
    let simulation = Simulation::of(&BALL).most_jumps(30);
    let mut course = simulation.start(false, [2.0, 0.0], 0.0..50.0).unwrap();
    for _ in 0..11 {
        course.advance(&mut ()).unwrap();
    }
    let pause = course.checkpoint();
    let (one, other) = (course.finish(&mut ()).unwrap(), simulation.resume(pause).finish(&mut ()).unwrap());
    assert_eq!((one.state, one.time, one.stats), (other.state, other.time, other.stats));
}

#[test]
fn infinitely_many_impacts_have_their_limit() {
    let ball = Ball { cor: 0.5, ..BALL };
    let run = Simulation::of(&ball).tolerance(1e-12).run(false, [1.0, 0.0], 0.0..10.0).unwrap();
    let limit = ball.impacts(1.0).nth(60).unwrap();
    assert!(
        matches!(run.end.stop, Stop::Zeno { limit: t } if (t - limit).abs() < 1e-10),
        "{:?}, {limit}",
        run.end.stop
    );
}

proptest! {
    /// A flight that begins at rest on its floor, y = L (s² - s³) with s = t/T, lands at s = 1:
    /// what time is measured in does not matter.
    #[test]
    fn a_rise_from_rest_lands_in_any_unit(
        exponent in -9.0..7.0_f64, size in -3.0..3.0_f64, digits in 3.0..12.0_f64, affine in any::<bool>(),
    ) {
        let (unit, height) = (10.0_f64.powf(exponent), 10.0_f64.powf(size));
        let by = height / (unit * unit);
        let flight = Hybrid::new()
            .mode("fly", move |t, x: &[f64; 2]| [x[1], by * (2.0 - 6.0 * (t / unit))])
            .series("fly", move |t, [_, v]| [v, by * (2.0 - 6.0 * (t / unit))])
            .mode("landed", |_t, _x| [0.0, 0.0])
            .switch("fly", "landed", |_t, x| x[0]);
        let flight = if affine { flight.affine() } else { flight };
        let tolerance = 10.0_f64.powf(-digits);
        let run = Simulation::of(&flight).tolerance(tolerance).run("fly", [0.0, 0.0], 0.0..2.0 * unit).unwrap();
        let times: Vec<_> = run.trajectory.jumps().iter().map(|jump| jump.t() / unit).collect();
        prop_assert!(times.len() == 1 && (times[0] - 1.0).abs() < 10.0 * tolerance, "{times:?}");
    }

    /// A coordinate that stands still, and that nothing reads, changes no bounce.
    #[test]
    fn a_coordinate_that_stands_changes_nothing(e in 0.2..0.9_f64, size in -9.0..9.0_f64, affine in any::<bool>()) {
        let ball = Hybrid::new()
            .mode("fly", |_t, x: &[f64; 3]| [x[1], -9.8, 0.0])
            .series("fly", |_t, [_, v, stands]| [v, stands * 0.0 - 9.8, stands * 0.0])
            .edge("fly", "fly", |_t, x| x[0], move |_t, x| [x[0], -e * x[1], x[2]]);
        let ball = if affine { ball.affine() } else { ball };
        let ball = ball.mode("rest", |_t, _x| [0.0; 3]).beyond("fly", "rest", |_t, x| [0.0, 0.0, x[2]]);
        let stands = 10.0_f64.powf(size);
        let run = Simulation::of(&ball).run("fly", [4.9, 0.0, stands], 0.0..100.0).unwrap();
        let rest = 1.0 + 2.0 * e / (1.0 - e);
        let last = run.trajectory.jumps().last().unwrap();
        prop_assert!(run.end.mode == "rest" && (last.t() - rest).abs() < 1e-9 * rest, "{} {}", last.t(), rest);
    }

    /// Damped oscillators, their guards and their trajectories by two methods that share nothing
    /// but the search.
    #[test]
    fn series_and_steps_agree(
        rate in 0.3..8.0_f64, damping in 0.0..1.0_f64, force in -1.0..1.0_f64, level in -0.5..0.5_f64, kick in 0.5..2.0_f64,
    ) {
        let swing = Hybrid::new()
            .mode("swing", move |t, &[x, v]: &[f64; 2]| [v, force * t.cos() - rate * rate * x.sin() - damping * v])
            .series("swing", move |t, [x, v]| [v, force * t.cos() - rate * rate * x.sin() - damping * v])
            .edge("swing", "swing", move |_t, x| x[0] - level, move |_t, x| [x[0], kick])
            .affine();
        let simulation = Simulation::of(&swing).stepper(Dop853).tolerance(1e-11);
        let start = [level + 0.5, 0.0];
        let series = simulation.run("swing", start, 0.0..10.0).unwrap();
        let steps = simulation.stepped().run("swing", start, 0.0..10.0).unwrap();
        prop_assert_eq!(series.trajectory.jumps().len(), steps.trajectory.jumps().len());
        for (a, b) in series.trajectory.jumps().iter().zip(steps.trajectory.jumps()) {
            prop_assert!((a.t() - b.t()).abs() < 1e-7, "{} {}", a.t(), b.t());
        }
        for k in 0..100 {
            let t = 0.0995 * f64::from(k);
            let (Some(a), Some(b)) = (series.trajectory.at(t), steps.trajectory.at(t)) else { continue };
            let near = series.trajectory.jumps().iter().any(|jump| (jump.t() - t).abs() < 1e-6);
            prop_assert!(near || (a[0] - b[0]).abs() < 1e-6 && (a[1] - b[1]).abs() < 1e-5, "{t}: {a:?} {b:?}");
        }
    }
}
