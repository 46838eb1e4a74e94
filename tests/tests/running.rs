//! Ways of running: recorded, observed, pulled, paused and resumed, sampled; and what the loop does
//! not do.

use std::ops::ControlFlow;

use saltus::nalgebra::{Vector2, vector};
use saltus::{
    About, Automaton, CheckpointOf, Clock, Coords, Edges, Hybrid, Jump, JumpOf, Observer, Piece, Refusal, Simulation,
    State, Stop, TrajectoryOf,
};
use serde::{Deserialize, Serialize};

/// A ball with quadratic drag, risen and fallen in two smooth modes, that keeps 0.9 of its speed.
struct Drag;

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Mode {
    Rising,
    Falling,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
enum Edge {
    Apex,
    Floor,
}

impl Automaton for Drag {
    type Mode = Mode;
    type State = Vector2<f64>;
    type Edge = Edge;

    fn flow(&self, mode: Mode, _t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        let drag = 0.1 * x[1] * x[1];
        match mode {
            Mode::Rising => vector![x[1], -9.8 - drag],
            Mode::Falling => vector![x[1], -9.8 + drag],
        }
    }
    fn edges(&self, mode: Mode) -> Edges<'_, Edge> {
        match mode {
            Mode::Rising => Edges::from([Edge::Apex]),
            Mode::Falling => Edges::from([Edge::Floor]),
        }
    }
    fn guard(&self, edge: Edge, _t: f64, x: &Vector2<f64>) -> f64 {
        match edge {
            Edge::Apex => x[1],
            Edge::Floor => x[0],
        }
    }
    #[inline]
    fn about(&self, _: Edge) -> About {
        About::new().affine()
    }
    fn reset(&self, _: Mode, edge: Edge, _t: f64, x: &Vector2<f64>) -> Result<(Mode, Vector2<f64>), Refusal> {
        Ok(match edge {
            Edge::Apex => (Mode::Falling, *x),
            Edge::Floor => (Mode::Rising, vector![0.0, -0.9 * x[1]]),
        })
    }
}

const START: Vector2<f64> = vector![10.0, 0.0];

/// The closed form: fall from h in acosh(exp(kh))/sqrt(gk) to v² = g/k (1 - exp(-2kh)); rise from v
/// in atan(v sqrt(k/g))/sqrt(gk) to ln(1 + kv²/g)/2k.
fn impact_times(count: usize) -> Vec<f64> {
    let (g, k, e) = (9.8_f64, 0.1_f64, 0.9_f64);
    let (mut t, mut h) = (0.0, START[0]);
    (0..count)
        .map(|_| {
            t += (k * h).exp().acosh() / (g * k).sqrt();
            let v = e * (g / k * -(-2.0 * k * h).exp_m1()).sqrt();
            let impact = t;
            t += (v * (k / g).sqrt()).atan() / (g * k).sqrt();
            h = (k * v * v / g).ln_1p() / (2.0 * k);
            impact
        })
        .collect()
}

/// Twenty impacts to 1e-12 s by steps alone: the crossings have the stepper's own order.
#[test]
fn quadratic_drag_to_the_last_digits() {
    let simulation = Simulation::of(&Drag).stepper(saltus::Dop853).tolerance(1e-14).absolute_tolerance(1e-15);
    let run = simulation.most_jumps(39).run(Mode::Falling, START, 0.0..100.0).unwrap();
    let impacts: Vec<f64> =
        run.trajectory.jumps().iter().filter(|j| j.edge() == Some(Edge::Floor)).map(Jump::t).collect();
    assert_eq!(impacts.len(), 20);
    for (n, (got, exact)) in impacts.iter().zip(impact_times(20)).enumerate() {
        assert!((got - exact).abs() < 1e-12, "impact {}: {got} instead of {exact}", n + 1);
    }
}

/// Keeps the bits of every jump.
#[derive(Default, PartialEq, Debug)]
struct Bits(Vec<[u64; 3]>);

impl Observer<Drag> for Bits {
    fn jump(&mut self, jump: &JumpOf<Drag>) -> ControlFlow<()> {
        self.0.push([jump.t().to_bits(), jump.after[0].to_bits(), jump.after[1].to_bits()]);
        ControlFlow::Continue(())
    }
}

/// A run that is paused at any jump, written down, read back and resumed gives the same bits.
#[test]
fn resumed_to_the_bit() {
    let simulation = Simulation::of(&Drag);
    let mut whole = Bits::default();
    let end = simulation.drive(Mode::Falling, START, 0.0..10.0, &mut whole).unwrap();
    for pause in [0, 1, 2, 7, 12] {
        let mut pieced = Bits::default();
        let mut course = simulation.start(Mode::Falling, START, 0.0..10.0).unwrap();
        for _ in 0..pause {
            course.advance(&mut pieced).unwrap();
        }
        let written = serde_json::to_string(&course.checkpoint()).unwrap();
        let checkpoint: CheckpointOf<Drag> = serde_json::from_str(&written).unwrap();
        let resumed = simulation.resume(checkpoint).finish(&mut pieced).unwrap();
        assert_eq!(whole, pieced, "paused after {pause}");
        assert_eq!((end.stats, end.stop), (resumed.stats, resumed.stop));
        assert_eq!(end.state, resumed.state);
    }
}

/// A checkpoint of another format, or of none, is refused by name: it would be gone on from
/// otherwise.
#[test]
fn another_format_is_refused() {
    let course = Simulation::of(&Drag).start(Mode::Falling, START, 0.0..10.0).unwrap();
    let mut written = serde_json::to_value(course.checkpoint()).unwrap();
    let format = written["format"].as_u64().unwrap();
    for other in [format - 1, format + 1, u64::from(u32::MAX)] {
        written["format"] = other.into();
        let refused = serde_json::from_value::<CheckpointOf<Drag>>(written.clone()).unwrap_err().to_string();
        assert!(
            refused.contains(&format!("of format {other}, and this version of saltus reads format {format}")),
            "{refused}"
        );
    }
    written.as_object_mut().unwrap().remove("format");
    let refused = serde_json::from_value::<CheckpointOf<Drag>>(written).unwrap_err().to_string();
    assert!(refused.contains("missing field `format`"), "{refused}");
}

#[test]
fn a_trajectory_written_and_read_back() {
    let run = Simulation::of(&Drag).run(Mode::Falling, START, 0.0..5.0).unwrap();
    let written = serde_json::to_string(&run.trajectory).unwrap();
    let read: TrajectoryOf<Drag> = serde_json::from_str(&written).unwrap();
    for k in 0..=500_u32 {
        let t = f64::from(k) / 100.0;
        assert_eq!(run.trajectory.at(t), read.at(t));
    }
    assert_eq!(read.jumps().len(), run.trajectory.jumps().len());
}

/// A limit ends a run; raised, it lets the run go on: at a jump to the bit, within an arc but for a
/// rounding.
#[test]
fn limits_raised() {
    let simulation = Simulation::of(&Drag);
    let whole = simulation.drive(Mode::Falling, START, 0.0..10.0, &mut ()).unwrap();
    let go_on = |limited: Simulation<'_, Drag>| {
        let mut course = limited.start(Mode::Falling, START, 0.0..10.0).unwrap();
        assert_ne!(course.finish(&mut ()).unwrap().stop, Stop::Time);
        assert_ne!(
            limited.resume(course.checkpoint()).finish(&mut ()).unwrap().stop,
            Stop::Time,
            "no limit was raised"
        );
        simulation.resume(course.checkpoint()).finish(&mut ()).unwrap()
    };
    let end = go_on(simulation.most_jumps(5));
    assert_eq!((end.state, end.jumps, end.stats), (whole.state, whole.jumps, whole.stats));
    for limited in [simulation.most_steps(17), simulation.most_evaluations(321)] {
        let end = go_on(limited);
        assert_eq!((end.jumps, end.mode, end.stop), (whole.jumps, whole.mode, Stop::Time));
        assert!((end.state - whole.state).norm() < 1e-12, "{} {}", end.state, whole.state);
    }
}

/// A state whose dimension differs by mode is a list of the coordinates there are.
#[test]
fn coordinates_written_and_read_back() {
    let stance: Coords<4> = [1.0, -0.5].into();
    assert_eq!(serde_json::to_string(&stance).unwrap(), "[1.0,-0.5]");
    assert_eq!(serde_json::from_str::<Coords<4>>("[1.0,-0.5]").unwrap(), stance);
    assert_eq!(serde_json::from_str::<Coords<2>>("[]").unwrap().len(), 0);
    let error = serde_json::from_str::<Coords<2>>("[1.0,2.0,3.0,4.0]").unwrap_err().to_string();
    assert!(error.starts_with("invalid length 3, expected a list of at most 2 coordinates"), "{error}");
    let error = serde_json::from_str::<Coords<2>>("{}").unwrap_err().to_string();
    assert!(error.starts_with("invalid type: map, expected a list of at most 2 coordinates"), "{error}");
}

/// Exact arcs cost guards and no steps; their limit is looked at between jumps.
#[test]
fn evaluations_of_exact_arcs_have_a_limit() {
    let ball = saltus_bounce::Ball::new(9.8, saltus_bounce::Cor::new(0.99).unwrap()).unwrap();
    let simulation = Simulation::of(&ball).most_evaluations(100);
    let end = simulation.drive(saltus_bounce::Mode::Flight, vector![1.0, 0.0], 0.0..100.0, &mut ()).unwrap();
    assert_eq!(end.stop, Stop::Evaluations { most: 100 });
    assert!(end.stats.evaluations() < 120 && end.stats.flows == 0, "{:?}", end.stats);
}

/// Recording, observing and pulling are one run; so is looking at it on any grid.
#[test]
fn one_list_of_jumps_however_it_is_run() {
    let simulation = Simulation::of(&Drag);
    let run = simulation.run(Mode::Falling, START, 0.0..10.0).unwrap();
    let mut observed = Bits::default();
    simulation.drive(Mode::Falling, START, 0.0..10.0, &mut observed).unwrap();
    let recorded: Vec<u64> = run.trajectory.jumps().iter().map(|jump| jump.t().to_bits()).collect();
    assert_eq!(recorded, observed.0.iter().map(|bits| bits[0]).collect::<Vec<_>>());
    let mut course = simulation.start(Mode::Falling, START, 0.0..10.0).unwrap();
    let mut pulled = Vec::new();
    while course.advance(&mut ()).unwrap().is_none() {
        pulled.push(course.time().seconds().to_bits());
    }
    assert_eq!(recorded, pulled);
    assert_eq!(course.advance(&mut ()).unwrap(), Some(Stop::Time), "an ended course stays ended");
}

/// The left and right limits at a jump are its two states; between jumps the two are one.
#[test]
fn both_limits() {
    let run = Simulation::of(&Drag).run(Mode::Falling, START, 0.0..10.0).unwrap();
    for jump in run.trajectory.jumps() {
        assert_eq!(run.trajectory.before(jump.t()), Some(jump.before));
        assert_eq!(run.trajectory.at(jump.t()), Some(jump.after));
        assert_eq!(run.trajectory.mode_at(jump.t()), Some(jump.to));
    }
    assert_eq!(run.trajectory.before(3.0), run.trajectory.at(3.0));
    assert_eq!(run.trajectory.at(-0.1), None);
    assert_eq!(run.trajectory.at(10.1), None);
}

#[test]
fn limits_are_endings() {
    let simulation = Simulation::of(&Drag);
    let jumps = simulation.most_jumps(5).run(Mode::Falling, START, 0.0..10.0).unwrap();
    assert_eq!((jumps.end.stop, jumps.trajectory.jumps().len()), (Stop::Jumps { most: 5 }, 5));
    let steps = simulation.most_steps(20).run(Mode::Falling, START, 0.0..10.0).unwrap();
    assert_eq!((steps.end.stop, steps.end.stats.steps), (Stop::Steps { most: 20 }, 20));
    let evaluations = simulation.most_evaluations(200).run(Mode::Falling, START, 0.0..10.0).unwrap();
    assert_eq!(evaluations.end.stop, Stop::Evaluations { most: 200 });
    assert!((200..300).contains(&evaluations.end.stats.evaluations()), "{:?}", evaluations.end.stats);
    struct Enough;
    impl Observer<Drag> for Enough {
        fn piece(&mut self, _: Mode, piece: &Piece<'_, Vector2<f64>>) -> ControlFlow<()> {
            if piece.start().seconds() > 2.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        }
    }
    let ended = simulation.drive(Mode::Falling, START, 0.0..10.0, &mut Enough).unwrap();
    assert_eq!(ended.stop, Stop::Observer);
}

#[test]
fn runs_can_be_shared_between_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<Simulation<'_, Drag>>();
    shared::<TrajectoryOf<Drag>>();
    shared::<CheckpointOf<Drag>>();
    shared::<saltus::CertificateOf<Drag>>();
    shared::<Hybrid<'_, Vector2<f64>>>();
}

/// A checkpoint of closures goes through a file, with jumps that rounding may take again, clocks
/// and a Zeno run under way.
#[test]
fn a_hybrid_goes_on_from_a_file() {
    let model = Hybrid::new()
        .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.81])
        .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.9 * x[1]])
        .clock("flight", "flight", Clock::every(0.25), |_t, x| [x[0], 0.99 * x[1]])
        .mode("rest", |_t, _x| [0.0; 2])
        .beyond("flight", "rest", |_t, _x| [0.0; 2]);
    let simulation = Simulation::of(&model).most_jumps(50_000);
    let whole = simulation.run("flight", [1.0, 0.0], 0.0..20.0).unwrap();
    let unobserved = simulation.drive("flight", [1.0, 0.0], 0.0..20.0, &mut ()).unwrap();
    assert!(whole.end.mode == "rest");
    for jumps in [0, 1, 2, 7, 40] {
        let mut course = simulation.start("flight", [1.0, 0.0], 0.0..20.0).unwrap();
        (0..jumps).for_each(|_| assert!(course.advance(&mut ()).unwrap().is_none()));
        let written = serde_json::to_string(&course.checkpoint()).unwrap();
        let read: CheckpointOf<Hybrid<'_, [f64; 2]>> = serde_json::from_str(written.leak()).unwrap();
        let end = simulation.resume(read).finish(&mut ()).unwrap();
        assert_eq!((end.state, end.time, end.stats), (unobserved.state, unobserved.time, unobserved.stats));
    }
    let written = serde_json::to_string(&whole.trajectory).unwrap();
    let read: TrajectoryOf<Hybrid<'_, [f64; 2]>> = serde_json::from_str(written.leak()).unwrap();
    assert_eq!(read.at(1.2345), whole.trajectory.at(1.2345));
}
