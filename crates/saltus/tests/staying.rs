//! A flow that runs along a guard's surface: an edge whose guard stays zero has not fallen, however
//! the steps drift, and falls where the flow carries it down.

use proptest::prelude::*;
use saltus::nalgebra::{self, Vector2, Vector3, vector};
use saltus::{FailedOf, Hybrid, RunOf, Simulation, State, Stop};
use saltus_cases::cases;

use crate::methods::methods;

/// Runs by one of three methods.
fn run<'a, X: State>(
    model: &'a Hybrid<'a, X>,
    method: usize,
    tolerance: f64,
    start: (&'static str, X),
    end: f64,
) -> Result<RunOf<Hybrid<'a, X>>, Box<FailedOf<Hybrid<'a, X>>>> {
    let simulation = Simulation::of(model).stepper(methods()[method]).tolerance(tolerance).most_steps(100_000);
    let (mode, x) = start;
    simulation.run(mode, x, 0.0..end)
}

/// How late a fall as (t - t₀)ᵐ⁺¹ may be found at most, where its rate (t - t₀)ᵐ is beyond the
/// error of a step and the rounding of differences over a thousandth of one that a kink has made
/// short.
fn lateness(tolerance: f64, power: i32) -> f64 {
    (1e3 * tolerance + 3e-7).powf(1.0 / f64::from(power.max(1)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(std::env::var("PROPTEST_CASES").map_or(60, |n| n.parse().unwrap())))]

    /// An ellipse is reached from outside or inside, and followed for some turns: one jump. With
    /// [`Hybrid::beyond`] too, for there is no limit.
    #[test]
    fn an_ellipse_is_followed(
        method in 0..3_usize,
        digits in 2.0..12.5_f64,
        (a, b) in (-2.0..3.0_f64, -1.5..1.5_f64),
        rate in -1.0..1.5_f64,
        angle in 0.0..std::f64::consts::TAU,
        (outside, beyond) in any::<(bool, bool)>(),
    ) {
        let (a, w) = (10_f64.powf(a), 10_f64.powf(rate));
        let b = a * 10_f64.powf(b);
        let side = if outside { 1.0 } else { -1.0 };
        let level = move |x: &Vector2<f64>| side * ((x[0] / a).powi(2) + (x[1] / b).powi(2) - 1.0);
        let mut model = Hybrid::new()
            .mode("in", move |_t, x: &Vector2<f64>| -*x * (side * w))
            .edge("in", "orbit", move |_t, x| level(x), |_t, x| *x)
            .mode("orbit", move |_t, x| vector![-x[1] * a / b, x[0] * b / a] * w)
            .edge("orbit", "in", move |_t, x| -level(x), |_t, x| *x);
        if beyond {
            model = model.mode("rest", |_t, _x| vector![0.0, 0.0]).beyond("orbit", "rest", |_t, x| *x);
        }
        let far = if outside { 1.8 } else { 0.4 };
        let start = vector![far * a * angle.cos(), far * b * angle.sin()];
        let run = run(&model, method, 10_f64.powf(-digits), ("in", start), 30.0 / w).unwrap();
        prop_assert_eq!((run.trajectory.jumps().len(), run.end.mode), (1, "orbit"), "{:?}", run.end.stop);
    }

    /// On a sphere, about an axis, until the flow leaves it at t₀ as (t - t₀)ᵐ⁺¹: one jump, or two.
    #[test]
    fn a_sphere_is_left_where_the_flow_leaves_it(
        method in 0..3_usize,
        digits in 3.0..11.0_f64,
        axis in [-1.0..1.0_f64, -1.0..1.0, 0.2..1.0],
        (leaving, power) in (1.0..9.0_f64, 0..=2_i32),
        leaves in any::<bool>(),
    ) {
        let axis = Vector3::from(axis).normalize();
        let model = Hybrid::new()
            .mode("in", move |_t, x: &Vector3<f64>| -*x)
            .edge("in", "on", |_t, x| x.norm() - 2.0, |_t, x| *x)
            .mode("on", move |t, x| {
                axis.cross(x) - if leaves && t > leaving { *x * (t - leaving).powi(power) } else { Vector3::zeros() }
            })
            .edge("on", "off", |_t, x| x.norm() - 2.0, |_t, x| *x)
            .mode("off", |_t, x| -*x);
        let tolerance = 10_f64.powf(-digits);
        let run = run(&model, method, tolerance, ("in", vector![3.0, 2.0, -1.0]), 12.0).unwrap();
        let jumps = run.trajectory.jumps();
        prop_assert_eq!(jumps.len(), if leaves { 2 } else { 1 }, "{:?}", run.end.stop);
        if leaves {
            let late = jumps[1].time.seconds() - leaving;
            prop_assert!(late.abs() < lateness(tolerance, power), "late by {late:e}");
        }
    }

    /// An edge of a mode to itself, just taken, stays like any other: a bead that comes from the
    /// centre and turns at a radius.
    #[test]
    fn an_edge_just_taken_stays(method in 0..3_usize, digits in 2.0..12.5_f64, radius in -2.0..3.0_f64) {
        let radius = 10_f64.powf(radius);
        let model = Hybrid::new()
            .mode("bead", |_t, x: &Vector3<f64>| {
                vector![-x[1], x[0], 0.0] * x[2] + vector![x[0], x[1], 0.0] * (1.0 - x[2])
            })
            .edge("bead", "bead", move |_t, x| radius - x[0].hypot(x[1]), |_t, x| vector![x[0], x[1], 1.0]);
        let start = vector![0.1 * radius, 0.2 * radius, 0.0];
        let run = run(&model, method, 10_f64.powf(-digits), ("bead", start), 40.0).unwrap();
        prop_assert_eq!((run.end.stop, run.trajectory.jumps().len()), (Stop::Time, 1));
    }

    /// A ball that lies on a lift, until its floor falls away faster: exact zeros for long, then a
    /// fall as a power of time.
    #[test]
    fn what_lies_falls_when_it_is_pulled(method in 0..3_usize, digits in 2.0..12.0_f64, pulled in 2.0..6.0_f64) {
        let model = Hybrid::new()
            .mode("flight", |_t, x: &Vector2<f64>| vector![x[1], -1.0])
            .edge("flight", "lies", |_t, x| x[0], |_t, _x| vector![0.0, 0.0])
            .mode("lies", move |t, x| vector![x[1], -(t - pulled).max(0.0)])
            .edge("lies", "under", |_t, x| x[0], |_t, x| *x)
            .mode("under", |_t, _x| vector![0.0, 0.0]);
        let tolerance = 10_f64.powf(-digits);
        let run = run(&model, method, tolerance, ("flight", vector![1.0, 0.0]), 12.0).unwrap();
        let jumps = run.trajectory.jumps();
        prop_assert_eq!((jumps.len(), run.end.mode), (2, "under"), "{:?}", run.end.stop);
        let late = jumps[1].time.seconds() - pulled;
        prop_assert!(late.abs() < lateness(tolerance, 2), "late by {late:e}");
    }
}

/// When an edge is taken, and whether in doubt, whose guard is zero from t = 1, as a fall ends on a
/// hold at `place`, up to `until`, and then falls as a power of time.
#[allow(clippy::unwrap_used)] // a test that cannot go on has failed
fn held(place: f64, until: f64, (amplitude, power): (f64, i32), tolerance: f64) -> (Vec<f64>, bool) {
    let fades = move |t: f64| if t < until { 0.0 } else { -amplitude * (t - until).powi(power) };
    let hold = Hybrid::new()
        .mode("fall", |_t, x: &Vector2<f64>| vector![x[1], 0.0])
        .mode("hold", move |t, x| vector![x[1] + fades(t), 0.0])
        .mode("gone", |_t, _| Vector2::zeros())
        .edge("fall", "hold", move |_t, x| x[0] - place, |_t, x| vector![x[0], 0.0])
        .switch("hold", "gone", move |_t, x| x[0] - place);
    let start = vector![place + 1.0, -1.0];
    let run = Simulation::of(&hold).tolerance(tolerance).run("fall", start, 0.0..until + 3.0).unwrap();
    (run.trajectory.jumps().iter().map(|jump| jump.t()).collect(), !run.trajectory.doubts().is_empty())
}

/// Of edges that stay for a time that a step may leap over, 95 of 100 are taken as that time ends,
/// or in doubt: no error estimate shows that the others are not.
#[test]
fn a_hold_that_a_step_leaps_over_is_doubted() {
    for (place, tolerance, power) in [(0.0, 1e-3, 1), (0.0, 1e-4, 3), (5.0, 1e-4, 3), (5.0, 1e-5, 3), (100.0, 1e-6, 3)]
    {
        let silent = |i: i32| {
            let (until, amplitude) = (1.2 + 0.028 * f64::from(i), 10.0_f64.powf(f64::from(i * 37 % 100) / 50.0 - 1.0));
            let (jumps, doubted) = held(place, until, (amplitude, power), tolerance);
            !doubted && (jumps.len() != 2 || jumps[1] < until - 1e-3)
        };
        let wrong = (0..100).filter(|&i| silent(i)).count();
        assert!(wrong <= 5, "{wrong} of 100 at {place}, {tolerance}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(128)))]

    /// A guard that is exactly zero from the start of the run, and falls as it may where its
    /// plateau ends: there it is left.
    #[test]
    fn a_plateau_from_the_start_is_left_where_it_ends(
        method in 0..4_usize, digits in 3.0..12.0_f64, scale in -1.0..6.0_f64, ends in 0.05..0.95_f64, way in 0..4_usize,
        turns in 1..4_i32,
    ) {
        let (end, leaves) = (10_f64.powf(scale), ends * 10_f64.powf(scale));
        let beyond = move |t: f64, x: f64| match way {
            0 => -(x - leaves).max(0.0),
            1 => leaves - x.max(leaves),
            2 => -(t - leaves).max(0.0),
            _ => if x > leaves { -1.0 } else { 0.0 },
        };
        let model = Hybrid::new().mode("run", |_t, _x: &f64| 1.0).terminal("run", move |t, x| beyond(t, *x));
        let simulation = Simulation::of(&model).stepper(methods()[method]).tolerance(10_f64.powf(-digits));
        let run = simulation.run("run", 0.0, 0.0..f64::from(turns) * end).unwrap();
        let time = run.end.time.seconds();
        // A leap shows by its values, whatever the tolerance.
        let room = if way == 3 { 1e-12 } else { 16.0 * 10_f64.powf(-digits) };
        prop_assert!((time - leaves).abs() <= room * end, "{time} for {leaves}: {:?}", run.end.stop);
    }
}
