//! States of any length: the same run as that of an array, and what is refused.

use proptest::prelude::*;
use saltus::{
    Auto, Automaton, Dop853, Edges, ErrorKind, Hybrid, Op, Refusal, Rodas5P, Series, Simulation, Solution, State, Stop,
    Tsit5, Vector,
};
use saltus_cases::cases;

/// Oscillators in a row, each pulled by its neighbours, and a wall that turns the first one round.
struct Row<S> {
    pull: f64,
    promised: bool,
    like: S,
}

impl<S: State> Automaton for Row<S> {
    type Mode = ();
    type State = S;
    type Edge = ();

    fn flow(&self, (): (), t: f64, x: &S) -> S {
        let n = x.len() / 2;
        let place = |k: usize| if k < n { x.get(k) } else { 0.0 };
        x.with(|i| match i.checked_sub(n) {
            None => x.get(n + i),
            Some(k) => {
                let sides = place(k.wrapping_sub(1)) + place(k + 1) - 2.0 * place(k);
                (0.3 * t).sin() - place(k) + self.pull * sides
            }
        })
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn guard(&self, (): (), _t: f64, x: &S) -> f64 {
        x.get(0) + 0.4
    }
    fn reset(&self, (): (), (): (), _t: f64, x: &S) -> Result<((), S), Refusal> {
        let n = x.len() / 2;
        Ok(((), x.with(|i| if i == n { -0.9 * x.get(i) } else { x.get(i) })))
    }
    fn about(&self, (): ()) -> saltus::About {
        saltus::About::new().affine_if(self.promised)
    }
}

/// A run: its jumps, with both states of each as lists, its end, and what it cost.
#[allow(clippy::type_complexity)]
fn run<S: State>(row: &Row<S>, stepper: Auto, tolerance: f64) -> (Vec<(f64, Vec<f64>, Vec<f64>)>, Vec<f64>, String) {
    let list = |x: &S| (0..x.len()).map(|i| x.get(i)).collect::<Vec<_>>();
    let simulation = Simulation::of(row).stepper(stepper).tolerance(tolerance);
    let run = simulation.run((), row.like.clone(), 0.0..12.0).unwrap();
    let jumps = run.trajectory.jumps().iter().map(|jump| (jump.t(), list(&jump.before), list(&jump.after)));
    (jumps.collect(), list(&run.end.state), format!("{:?} {:?}", run.end.stop, run.end.stats))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(64)))]

    /// A vector is integrated as an array of its length is: bit for bit, by every method.
    #[test]
    fn a_vector_is_an_array(
        start in prop::array::uniform6(-1.0..1.0_f64),
        pull in 0.0..3.0_f64,
        promised in any::<bool>(),
        digits in 4.0..10.0_f64,
        method in 0..4_usize,
    ) {
        let mut start = start;
        start[0] = start[0].abs();
        let method = [Auto::new(), Tsit5.into(), Dop853.into(), Rodas5P.into()][method];
        let tolerance = 10.0_f64.powf(-digits);
        let array = run(&Row { pull, promised, like: start }, method, tolerance);
        let vector = run(&Row { pull, promised, like: Vector::from(start) }, method, tolerance);
        prop_assert_eq!(array, vector);
    }
}

/// Modes may have states of their own lengths.
#[test]
fn each_mode_has_its_own_length() {
    let growing = Hybrid::new()
        .mode("one", |_t, x: &Vector| x.with(|_| 1.0))
        .mode("three", |_t, x| x.with(|i| 1.0 + i as f64))
        .edge("one", "three", |_t, x| 1.0 - x[0], |_t, x| [x[0], 0.0, 0.0].into())
        .edge("three", "one", |_t, x| 6.0 - x[2], |_t, x| vec![x[0] - 3.0].into());
    let run = Simulation::of(&growing).run("one", [0.0].into(), 0.0..3.5).unwrap();
    assert_eq!(run.end.stop, Stop::Time);
    let lengths: Vec<_> = run.trajectory.jumps().iter().map(|jump| (jump.before.len(), jump.after.len())).collect();
    assert_eq!(lengths, [(1, 3), (3, 1)]);
    assert!((run.end.state[0] - 0.5).abs() < 1e-9, "{:?}", run.end.state);
}

/// Coordinates that flow at constant rates are known exactly, and a formula is expanded in series.
#[test]
fn solutions_are_by_formula_too() {
    let drifts = Hybrid::new()
        .exact("run", |_t, x: &Vector| [x.clone(), x.with(|i| -(i as f64))].into())
        .edge("run", "run", |_t, x| x[3], |_t, x| x.with(|_| 6.0))
        .affine();
    let run = Simulation::of(&drifts).run("run", [6.0; 5].into(), 0.0..5.0).unwrap();
    assert_eq!((run.end.jumps, run.end.stats.steps), (2, 0));
    assert_eq!(&run.end.state[..], [6.0, 5.0, 4.0, 3.0, 2.0]);

    struct Decays(saltus::Formula);
    impl Decays {
        fn series(&self, (): (), series: &mut Series<'_, Vector>) {
            series.formula(&self.0);
        }
    }
    impl Automaton for Decays {
        type Mode = ();
        type State = Vector;
        type Edge = ();
        fn flow(&self, (): (), _t: f64, x: &Vector) -> Vector {
            x.with(|i| -x[i])
        }
        fn edges(&self, (): ()) -> Edges<'_, ()> {
            Edges::none()
        }
        fn guard(&self, (): (), _t: f64, _x: &Vector) -> f64 {
            1.0
        }
        fn reset(&self, (): (), (): (), _t: f64, x: &Vector) -> Result<((), Vector), Refusal> {
            Ok(((), x.clone()))
        }
        fn solution(&self, (): (), _t: f64, _x: &Vector) -> Solution<Self> {
            Solution::Series(Self::series)
        }
    }
    let n = 20;
    let ops = (0..n).map(|i| Op::Neg(i + 1)).collect();
    let formula = saltus::Formula::new(n, ops, (n + 1..=2 * n).collect()).unwrap();
    let decays = Decays(formula);
    let end = Simulation::of(&decays).tolerance(1e-12).drive((), vec![1.0; n].into(), 0.0..2.0, &mut ()).unwrap();
    assert!(end.state.iter().all(|x| (x - (-2.0_f64).exp()).abs() < 1e-12), "{:?}", end.state);
}

/// A flow of another length than its state is refused where the arc starts, and where it changes
/// its length on the way: with the mode and the time, and without a panic.
#[test]
fn a_flow_of_another_length_is_refused() {
    for method in [Auto::new(), Tsit5.into(), Dop853.into(), Rodas5P.into()] {
        let short = Hybrid::new().mode("run", |_t, _x: &Vector| [1.0, 2.0].into());
        let error = Simulation::of(&short).stepper(method).run("run", [0.0; 3].into(), 0.0..1.0).unwrap_err().error;
        assert!(error.to_string().contains("run"), "{error}");
        let later =
            Hybrid::new().mode("run", |t, x: &Vector| x.iter().take(if t < 0.5 { 3 } else { 2 }).copied().collect());
        let failed = Simulation::of(&later).stepper(method).run("run", [1.0; 3].into(), 0.0..1.0).unwrap_err();
        assert_eq!(failed.error.kind(), ErrorKind::Flow, "{}", failed.error);
        assert!((failed.trajectory.end().seconds() - 0.5).abs() < 1e-9, "{}", failed.error);
    }
}

/// A vector is what was put into it, read and written as a slice.
#[test]
fn a_vector_is_a_list() {
    let mut x: Vector = [1.0, 2.0, 3.0].into();
    x[1] = 5.0;
    assert_eq!((&x[..], x.len(), State::get(&x, 1)), (&[1.0, 5.0, 3.0][..], 3, 5.0));
    assert_eq!(x, Vector::from(vec![1.0, 5.0, 3.0]));
    assert_eq!(format!("{x:?}"), "[1.0, 5.0, 3.0]");
    assert_eq!(x.iter().map(|x| 2.0 * x).collect::<Vector>(), Vector::from(&[2.0, 10.0, 6.0][..]));
    assert!(Vector::from_fn(0, |_| 1.0).is_empty() && State::get(&x, 3).is_nan());
}
