//! What accuracy costs: the advice keeps its promise against solutions that the advice does not
//! know.

use proptest::prelude::*;
use saltus_bounce::flight::{LinearDragFlight, VerticalFlight};
use saltus_cases::cases;
use saltus_scene::Scene;
use saltus_scene::accuracy::{Accuracy, Outcome, Target, Way};

/// A ball thrown sideways through a wind, held back in proportion to its speed: no formula of the
/// planner solves it, yet there is one.
#[derive(Clone, Copy, Debug)]
struct Throw {
    height: f64,
    velocity: [f64; 2],
    drag: f64,
    wind: f64,
    cor: f64,
}

const GRAVITY: f64 = 9.81;
const UNTIL: f64 = 2.0;

impl Throw {
    fn toml(&self, run: &str) -> String {
        let Self { height, velocity: [vx, vz], drag, wind, cor } = self;
        format!(
            "gravity = {GRAVITY:?}\nrestitution = {cor:?}\n[ball]\nposition = [0.0, {height:?}]\nvelocity = [{vx:?}, {vz:?}]\n\
             [drag]\nrate = {drag:?}\n[air]\nwind = [{wind:?}, 0.0]\n[run]\nuntil = {UNTIL:?}\n{run}"
        )
    }

    /// The impacts, as times and speeds after them, up to the end.
    fn impacts(&self) -> Vec<(f64, f64)> {
        let flight = LinearDragFlight::new(GRAVITY, self.drag).unwrap();
        let (mut t, mut x) = (0.0, [self.height, self.velocity[1]]);
        let mut impacts = Vec::new();
        while impacts.len() < 1000 {
            let impact = flight.impact(&x.into()).unwrap();
            t += impact.time;
            if t > UNTIL || impact.time < 1e-9 {
                break;
            }
            x = [0.0, self.cor * impact.speed];
            impacts.push((t, x[1]));
        }
        impacts
    }

    fn at(&self, t: f64, impacts: &[(f64, f64)]) -> [f64; 2] {
        let flight = LinearDragFlight::new(GRAVITY, self.drag).unwrap();
        let last = impacts.iter().rev().find(|(at, _)| *at <= t);
        let (start, x) = last.map_or((0.0, [self.height, self.velocity[1]]), |&(at, v)| (at, [0.0, v]));
        let along = self.wind * t - (self.velocity[0] - self.wind) * (-self.drag * t).exp_m1() / self.drag;
        [along, flight.after(t - start, &x.into())[0]]
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(100)))]

    #[test]
    fn the_advice_keeps_its_promise(
        height in 0.5..3.0_f64, vx in -5.0..5.0_f64, vz in -2.0..6.0_f64, drag in 0.05..1.0_f64, wind in 0.5..6.0_f64, cor in 0.2..0.9_f64,
        length in -9.0..-2.0_f64, time in -9.0..-2.0_f64,
    ) {
        let throw = Throw { height, velocity: [vx, vz], drag, wind, cor };
        let target = Target { length: Some(10_f64.powf(length)), time: Some(10_f64.powf(time)) };
        let scene = Scene::parse("throw.toml", throw.toml("").as_bytes()).unwrap();
        let accuracy = Accuracy::counted(&scene).unwrap();
        let best = accuracy.cheapest(target).expect("nothing here is asked for that ten digits cannot give");
        let Way::Steps { stepper, tolerance } = best.way else { panic!("{}", best.way) };

        // The scene as the advice has it, by itself.
        let advised = throw.toml(&format!("stepper = \"{}\"\ntolerance = {tolerance:e}\n", stepper.name().to_lowercase()));
        let record = Scene::parse("advised.toml", advised.as_bytes()).unwrap().plan().unwrap().run().unwrap();
        let impacts = throw.impacts();
        let fastest = impacts.iter().map(|impact| impact.1).fold(0.0, f64::max);
        for (n, (exact, got)) in impacts.iter().zip(record.impacts()).enumerate().take_while(|(_, (exact, _))| exact.1 > 1e-2 * fastest) {
            prop_assert!((exact.0 - got.t).abs() <= target.time.unwrap(), "impact {}: {} and {}, asked for {target:?}", n + 1, got.t, exact.0);
        }
        // Beyond these impacts the formula's own chain is cut.
        let known = impacts.last().filter(|last| last.1 < 1e-6).map_or(UNTIL, |last| last.0);
        for k in 0..200 {
            let t = known * f64::from(k) / 200.0;
            let (exact, got) = (throw.at(t, &impacts), record.at(0, t).unwrap().position);
            let off = (exact[0] - got.x).hypot(exact[1] - got.z);
            prop_assert!(off <= target.length.unwrap(), "{off} m off at {t} s, asked for {target:?}");
        }
    }
}

fn example(name: &str) -> Scene {
    let path = format!("{}/../examples/scenes/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    Scene::read(path).unwrap()
}

/// Steppers agree with formulas to rounding where a parabola is all there is, and frames do not
/// come near.
#[test]
fn frames_are_a_foil() {
    let accuracy = Accuracy::counted(&example("squash")).unwrap();
    let (way, _) = accuracy.reference();
    assert_eq!(way, Way::Formulas);
    assert!(accuracy.doubt().position < 1e-14 && accuracy.doubt().missed == 0, "{:?}", accuracy.doubt());
    let position = |wanted: fn(&Way) -> bool| -> Vec<f64> {
        let of = accuracy.trials().iter().filter(|trial| wanted(&trial.way));
        of.map(|trial| trial.outcome.as_ref().unwrap().difference.position).collect()
    };
    let steps = position(|way| matches!(way, Way::Steps { .. }));
    assert!(steps.len() == 30 && steps.iter().all(|off| *off < 1e-13), "{steps:?}");
    let frames = position(|way| matches!(way, Way::Frames { .. }));
    assert!(frames.len() == 5 && frames.iter().all(|off| *off > 5e-3), "{frames:?}");
    assert!(matches!(accuracy.cheapest(Target::DEFAULT).unwrap().way, Way::Formulas));
}

/// No formula is more exact than the numbers it is given: three balls in a box lose a digit every
/// ten impacts, and nobody can promise a micrometre.
#[test]
fn formulas_promise_no_more_than_rounding_leaves() {
    let mut balls = example("box");
    balls.run.until = Some(5.0);
    let accuracy = Accuracy::counted(&balls).unwrap();
    assert!(accuracy.doubt().position > 1e-7, "{:?}", accuracy.doubt());
    assert!(accuracy.cheapest(Target { length: Some(1e-9), time: None }).is_none());
    let falling = Accuracy::counted(&example("squash")).unwrap();
    assert!(falling.cheapest(Target { length: Some(1e-9), time: None }).is_some());
    assert!(falling.cheapest(Target { length: Some(1e-20), time: None }).is_none());
}

/// What is shown costs more for being more exact, and the advice is among it.
#[test]
fn the_frontier_has_the_advice_on_it() {
    let accuracy = Accuracy::counted(&example("topspin")).unwrap();
    for length in [1e-3, 1e-6, 1e-9, 1e-12] {
        let target = Target { length: Some(length), time: None };
        let points: Vec<_> =
            accuracy.frontier(target).into_iter().map(|trial| trial.outcome.clone().unwrap()).collect();
        assert!(points.len() > 4 && points.len() < 15, "{}", points.len());
        for pair in points.windows(2) {
            assert!(pair[0].evaluations() < pair[1].evaluations());
            assert!(
                pair[0].difference.share(target, accuracy.doubt()) > pair[1].difference.share(target, accuracy.doubt())
            );
        }
        let best = accuracy.cheapest(target).unwrap();
        assert!(accuracy.frontier(target).contains(&best));
        let cost = best.outcome.as_ref().unwrap().evaluations();
        let meets = |outcome: &&Outcome| outcome.difference.meets(target, accuracy.doubt());
        let met = accuracy.trials().iter().filter_map(|trial| trial.outcome.as_ref().ok()).filter(meets);
        assert!(met.map(Outcome::evaluations).all(|evaluations| evaluations >= cost), "{length}");
    }
}

/// Steps that end on the apex, where v|v| has a kink, keep their order: impact times from six
/// digits to twelve.
#[test]
fn digits_are_cheap_where_modes_are_smooth() {
    let toml = b"restitution = 0.9\nball = { height = '10 m' }\ndrag = { per_length = 0.1, rate = 1e-9 }\nrun = { until = '10 s' }\n";
    let accuracy = Accuracy::counted(&Scene::parse("drop.toml", toml).unwrap()).unwrap();
    let evaluations = |time: f64| {
        let best = accuracy.cheapest(Target { length: None, time: Some(time) }).unwrap();
        best.outcome.as_ref().unwrap().evaluations() as f64
    };
    let per_digit = (evaluations(1e-12) / evaluations(1e-6)).powf(1.0 / 6.0);
    assert!(per_digit < 1.25, "{per_digit}");
}

/// Stiff contact, friction in space and several balls: there is an answer.
#[test]
fn every_example_has_an_answer() {
    let coarse = Target { length: Some(1e-2), time: Some(1e-2) };
    for (name, target) in [
        ("steel-hertz", Target::DEFAULT),
        ("topspin", Target::DEFAULT),
        ("wind", Target::DEFAULT),
        ("stacked", Target::DEFAULT),
        ("stairs", Target::DEFAULT),
        ("box", coarse),
    ] {
        let accuracy = Accuracy::counted(&example(name)).unwrap();
        let best = accuracy.cheapest(target).unwrap_or_else(|| panic!("{name}"));
        assert!(best.outcome.as_ref().unwrap().difference.missed == 0, "{name}");
    }
}
