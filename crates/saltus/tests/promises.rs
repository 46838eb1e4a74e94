//! Guards that are promised affine: what is so is believed, what is not is an error or does no
//! harm.

use proptest::prelude::*;
use saltus::{Automaton, Edge, Edges, Entry, ErrorKind, Hybrid, Refusal, Signal, Simulation, Solution};
use saltus_cases::cases;

use crate::methods::methods;

/// A guard that is promised affine and reads the time, or bends, is an error that names it; one
/// whose constants are of any size is believed.
#[test]
fn a_promise_that_does_not_hold() {
    let keep = |_t: f64, x: &[f64; 2]| *x;
    let room = |flow: f64| move |_t: f64, x: &[f64; 2]| [flow - 0.1 * x[0], 0.0];
    let thermostat = Hybrid::new()
        .mode("off", room(0.0))
        .mode("on", room(5.0))
        .edge("off", "on", |t, x| x[0] - 19.0 - (0.5 * t).sin(), keep)
        .affine()
        .edge("on", "off", |_t, x| 21.0 - x[0], keep)
        .affine();
    let error = Simulation::of(&thermostat).run("off", [21.0, 0.0], 0.0..48.0).unwrap_err().error;
    assert_eq!(error.kind(), ErrorKind::Promise);
    assert!(error.to_string().starts_with(
        "the guard of edge off -> on (edge 0) is promised affine and changes with time while the state stands still"
    ));
    for guard in [|x: f64| 0.9 - (20.0 * x).sin(), |x: f64| 5.0 - x * x, |x: f64| 4.0 - x.abs().sqrt()] {
        let model = Hybrid::new()
            .mode("on", |_t, _x: &[f64; 2]| [1.0, 0.0])
            .edge("on", "on", move |_t, x| guard(x[0]), keep)
            .affine()
            .entry(Entry::Wait);
        let error = Simulation::of(&model).run("on", [0.0, 0.0], 0.0..1.0).unwrap_err().error;
        assert_eq!(error.kind(), ErrorKind::Promise);
    }
    // Held between stops, a threshold is a constant there.
    let limit = Signal::held([(0.0, 2.0), (1.0, 1.5), (2.0, 0.75)]).unwrap();
    let held = Hybrid::new()
        .stops_everywhere(limit.stops())
        .mode("on", |_t, _x: &[f64; 2]| [0.4, 0.0])
        .mode("off", |_t, _x| [0.0, 0.0])
        .edge("on", "off", |t, x| limit.at(t) - x[0], keep)
        .affine();
    let run = Simulation::of(&held).run("on", [0.0, 0.0], 0.0..3.0).unwrap();
    assert_eq!(run.trajectory.jumps()[0].t(), 2.0);
}

proptest! {
    #[test]
    fn an_affine_guard_is_believed(
        (a, b) in ([-1e6..1e6_f64, -1e3..1e3], -1e9..1e9_f64),
        x in [-1e4..1e4_f64, -1e4..1e4],
        v in [-1e3..1e3_f64, -1e3..1e3],
        powers in [-9..9_i32, -9..9],
    ) {
        let scale = powers.map(|power| 10_f64.powi(power));
        let model = Hybrid::new()
            .mode("on", move |_t, _x: &[f64; 2]| [v[0] * scale[0], v[1] * scale[1]])
            .edge("on", "on", move |_t, x| a[0] / scale[0] * x[0] + a[1] / scale[1] * x[1] + b, |_t, x| *x)
            .affine()
            .entry(Entry::Wait);
        let run = Simulation::of(&model).run("on", [x[0] * scale[0], x[1] * scale[1]], 0.0..10.0);
        prop_assert!(run.is_ok(), "{:?}", run.err());
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1000)))]

    /// A guard that is affine where the run is, and cut off or bent outside, is taken where it
    /// falls or refused: it is asked out there as well.
    #[test]
    fn a_guard_that_is_affine_nearby_alone_is_refused_or_right(
        (place, rate) in (-0.8..0.8_f64, 0.5..3.0_f64),
        (far, bend) in (0.5..100.0_f64, -40.0..-3.0_f64),
        kind in 0..5_usize,
        method in 0..5_usize,
        sums: bool,
    ) {
        let (far, bend) = (10_f64.powf(far), 10_f64.powf(bend));
        let guard = move |_t: f64, x: &[f64; 2]| {
            let sum = if sums { x[0] + 1e-3 * x[1] } else { x[0] };
            match kind {
                0 => sum.clamp(-far, far) - place,
                1 => sum.min(far) - place,
                2 => sum.max(-far) - place,
                3 => sum - place + bend * x[0] * x[0],
                _ => sum - place + bend * sum * sum.abs(),
            }
        };
        let taken = |promised: bool| {
            let mut model = Hybrid::new().mode("swing", move |_t, x: &[f64; 2]| [rate * x[1], -rate * x[0]]);
            if method == 4 {
                model = model.series("swing", move |_t, [x, v]| [v * rate, x * -rate]);
            }
            let edge = Edge::new(guard, |_t, x: &[f64; 2]| [x[0], -x[1]]).entry(Entry::Fire);
            let model = model.edge_with("swing", "swing", if promised { edge.affine() } else { edge });
            let run = Simulation::of(&model).stepper(methods()[method.min(3)]).most_jumps(20).run("swing", [1.0, 0.0], 0.0..20.0);
            run.map(|run| run.trajectory.jumps().iter().map(saltus::Jump::t).collect::<Vec<_>>()).map_err(|failed| failed.error.kind())
        };
        match (taken(true), taken(false)) {
            (Err(kind), _) => prop_assert_eq!(kind, ErrorKind::Promise),
            (promised, Err(kind)) => prop_assert!(false, "{:?} and {:?}", promised, kind),
            (Ok(promised), Ok(plain)) => {
                prop_assert_eq!(promised.len(), plain.len());
                prop_assert!(promised.iter().zip(&plain).all(|(a, b)| (a - b).abs() < 1e-5), "{:?} {:?}", promised, plain);
            }
        }
    }
}

/// A weight on a spring that swings at a `rate`, and a formula of one that swings at another.
struct Swing {
    rate: f64,
    formula: f64,
}

impl Swing {
    fn at(&self, (): (), _t: f64, x: &[f64; 2], s: f64) -> [f64; 2] {
        let (sin, cos) = (self.formula * s).sin_cos();
        [x[0] * cos + x[1] / self.formula * sin, x[1] * cos - x[0] * self.formula * sin]
    }
}

impl Automaton for Swing {
    type Mode = ();
    type State = [f64; 2];
    type Edge = ();

    fn flow(&self, (): (), _t: f64, x: &[f64; 2]) -> [f64; 2] {
        [x[1], -self.rate * self.rate * x[0]]
    }
    fn solution(&self, (): (), _t: f64, _x: &[f64; 2]) -> Solution<Self> {
        Solution::Formula(Self::at)
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn guard(&self, (): (), _t: f64, x: &[f64; 2]) -> f64 {
        x[0]
    }
    fn reset(&self, (): (), (): (), _t: f64, x: &[f64; 2]) -> Result<((), [f64; 2]), Refusal> {
        Ok(((), [0.0, -x[1]]))
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(300)))]

    /// An exact solution that starts as the flow does, and goes on otherwise, is an error; that of
    /// the flow is none, in whatever units, however long its arcs.
    #[test]
    fn an_exact_solution_of_another_flow_is_an_error(
        (power, size, span) in (-6.0..6.0_f64, -6.0..6.0_f64, 0.0..4.0_f64),
        (place, speed) in (0.1..2.0_f64, -1.0..1.0_f64),
        of in prop::sample::select(vec![1.0, 0.0, 0.5, 0.9, 1.1, 2.0]),
    ) {
        let (rate, size) = (10_f64.powf(power), 10_f64.powf(size));
        let (start, end) = ([size * place, size * speed * rate], 10_f64.powf(span) / rate);
        let error = if of == 1.0 { None } else { Some(ErrorKind::Series) };
        let swing = Swing { rate, formula: if of == 0.0 { 1.01 * rate } else { of * rate } };
        let found = Simulation::of(&swing).run((), start, 0.0..end).map_err(|failed| failed.error.kind());
        prop_assert_eq!(found.err(), error, "a formula");

        let fall = -size * rate * rate;
        let ball = Hybrid::new()
            .mode("flight", move |_t, x: &[f64; 2]| [x[1], fall])
            .exact("flight", move |_t, x| [*x, [x[1], fall], [0.5 * of * fall, 0.0]].into())
            .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.9 * x[1]]);
        let found = Simulation::of(&ball).run("flight", start, 0.0..end.min(3.0 / rate)).map_err(|failed| failed.error.kind());
        prop_assert_eq!(found.err(), error, "a polynomial");
    }
}
