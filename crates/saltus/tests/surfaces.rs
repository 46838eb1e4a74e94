//! A model of a surface gives its derivatives: one that is not the surface's own is refused, and
//! none that is.

use proptest::prelude::*;
use saltus::nalgebra::{self, Vector2, vector};
use saltus::{Auto, Entry, ErrorKind, Filippov, Hybrid, Jet, Rodas5P, Side, Sides, Simulation, Stop, Tsit5};
use saltus_cases::cases;

/// h = s (v - w(t)) with a belt of speed w(t) = A sin(ω t + φ) + c: scale, amplitude, frequency,
/// offset.
#[derive(Clone, Copy, Debug)]
struct Belt {
    scale: f64,
    amplitude: f64,
    frequency: f64,
    offset: f64,
}

impl Belt {
    fn speed(self, t: f64) -> f64 {
        self.amplitude * (self.frequency * t).sin() + self.offset
    }
    fn acceleration(self, t: f64) -> f64 {
        self.amplitude * self.frequency * (self.frequency * t).cos()
    }

    /// The refusal of a slide that starts at `t`, where the rate is so many times the right one and
    /// the normal too.
    fn refusal(self, t: f64, rate: f64, normal: f64) -> Option<String> {
        let push = 2.0 * self.amplitude * self.frequency;
        let sides = Sides::new(
            move |_, x: &Vector2<f64>| vector![x[1], -push],
            move |_, x| vector![x[1], push],
            move |t, x| self.scale * (x[1] - self.speed(t)),
            move |_, _| vector![0.0, normal * self.scale],
        )
        .moving(move |t, _| -rate * self.scale * self.acceleration(t));
        let model = Filippov::of(sides);
        let start = vector![0.0, self.speed(t)];
        let run = Simulation::of(&model).run(Side::Sliding, start, t..t + 1e-3 / self.frequency);
        run.err().map(|failed| {
            assert_eq!(failed.error.kind(), ErrorKind::Model);
            failed.error.to_string()
        })
    }
}

fn belt() -> impl Strategy<Value = Belt> {
    let power = |range: std::ops::Range<f64>| range.prop_map(|power| 10_f64.powf(power));
    (power(-6.0..6.0), power(-4.0..4.0), power(-4.0..6.0), prop_oneof![Just(0.0), -3.0..3.0_f64]).prop_map(
        |(scale, amplitude, frequency, offset)| Belt { scale, amplitude, frequency, offset: offset * amplitude },
    )
}

proptest! {
    /// Turns of the belt until the slide starts, away from where it stands for a moment.
    #[test]
    fn a_rate_is_believed_where_differences_show_no_other(belt in belt(), turns in 0_u32..1000, phase in -1.2..1.2_f64) {
        let t = (f64::from(turns) * std::f64::consts::TAU + phase) / belt.frequency;
        prop_assert_eq!(belt.refusal(t, 1.0, 1.0), None);
        for rate in [0.0, -1.0, 0.9, 2.0] {
            let refusal = belt.refusal(t, rate, 1.0);
            prop_assert!(refusal.as_ref().is_some_and(|why| why.contains("∂h/∂t")), "{rate} {refusal:?}");
        }
        for normal in [-1.0, 0.5, 1.1] {
            let refusal = belt.refusal(t, 1.0, normal);
            prop_assert!(refusal.as_ref().is_some_and(|why| why.contains("∂h/∂x1")), "{normal} {refusal:?}");
        }
    }

    /// A circle of any size, met from outside; its gradient is 2 x, and x alone is refused.
    #[test]
    fn a_gradient_is_that_of_the_surface_itself(power in -9.0..9.0_f64, angle in 0.0..std::f64::consts::TAU, right in any::<bool>()) {
        let radius = 10_f64.powf(power);
        let by = if right { 2.0 } else { 1.0 };
        let rim = Filippov::of(Sides::new(
            |_, x: &Vector2<f64>| vector![-x[1] - x[0], x[0] - x[1]],
            |_, x| vector![-x[1] + x[0], x[0] + x[1]],
            move |_, x| x.norm_squared() - radius * radius,
            move |_, x| by * x,
        ));
        let start = vector![angle.cos(), angle.sin()] * (1.5 * radius);
        let run = Simulation::of(&rim).run(Side::Above, start, 0.0..2.0);
        prop_assert_eq!(run.is_ok(), right, "{:?}", run.err());
    }

    /// The circle met beside an axis, where one part of its gradient is so small that the rounding
    /// of the other hides it: it is believed, and the large one is not where it is half of it.
    #[test]
    fn what_rounding_hides_of_a_gradient_is_believed(power in -9.0..9.0_f64, small in 0.0..14.0_f64, swap in any::<bool>(), right in any::<bool>()) {
        let radius = 10_f64.powf(power);
        let by = if right { 2.0 } else { 1.0 };
        let rim = Filippov::of(Sides::new(
            |_, x: &Vector2<f64>| -x,
            |_, x| *x,
            move |_, x| x.norm_squared() - radius * radius,
            move |_, x| by * x,
        ));
        let angle = 10_f64.powf(-small);
        let beside = vector![angle.cos(), angle.sin()] * (1.5 * radius);
        let start = if swap { vector![beside[1], beside[0]] } else { beside };
        let run = Simulation::of(&rim).run(Side::Above, start, 0.0..2.0);
        prop_assert_eq!(run.is_ok(), right, "{:?}", run.err());
    }

    /// What a kink, a leap or a table hides is believed: a floor whose speed changes at the very
    /// start, with either of its speeds.
    #[test]
    fn either_slope_of_a_kink_is_believed(before in -3.0..3.0_f64, behind in -3.0..3.0_f64, late in any::<bool>(), t in prop_oneof![Just(0.0), -1e3..1e3_f64]) {
        let floor = move |at: f64| if at < t { before * (at - t) } else { behind * (at - t) };
        let rate = if late { behind } else { before };
        let sides = Sides::new(|_, _: &f64| -9.0, |_, _| 9.0, move |at, x| x - floor(at), |_, _| 1.0)
            .moving(move |at, _| if at == t { -rate } else if at < t { -before } else { -behind });
        let run = Simulation::of(&Filippov::of(sides)).run(Side::Sliding, 0.0, t..t + 1.0).map(|run| run.end.state);
        prop_assert!(run.as_ref().is_ok_and(|x| (x - behind).abs() < 1e-6), "{run:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(1000)))]

    /// A reset onto a plane along which the flow runs, q·f = 0: the plane's guard is rounding from
    /// there on, and nothing more is due.
    #[test]
    fn a_flow_along_a_plane_stays_on_it(
        f in prop::array::uniform3(-3_i32..4), w in prop::array::uniform3(-3_i32..4), to in prop::array::uniform3(-4_i32..5),
        affine in any::<bool>(), method in 0..5_usize, began in -5.0..5.0_f64,
    ) {
        let [f, w, to] = [f, w, to].map(|list| list.map(f64::from));
        let q = [f[1] * w[2] - f[2] * w[1], f[2] * w[0] - f[0] * w[2], f[0] * w[1] - f[1] * w[0]];
        prop_assume!(q != [0.0; 3]);
        let dot = |a: [f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let (size, away) = (dot(q, &q), dot(q, &to));
        let from = [0, 1, 2].map(|i| to[i] - q[i] / size);
        let mut flow = Hybrid::new().mode("run", move |_t, _x: &[f64; 3]| f);
        if method == 0 {
            flow = flow.series("run", move |t, _x: [Jet<'_>; 3]| f.map(|f| t * 0.0 + f));
        } else if method == 4 {
            flow = flow.exact("run", move |_t, x| [*x, f].into());
        }
        flow = flow.edge("run", "run", move |_t, x| dot(q, x) - away, move |_t, _x| to).entry(Entry::Fire);
        if affine {
            flow = flow.affine();
        }
        let stepper = [Auto::new(), Auto::new(), Auto::from(Tsit5), Auto::from(Rodas5P), Auto::new()][method];
        let run = Simulation::of(&flow).stepper(stepper).most_jumps(9).run("run", from, began..began + 3.0).unwrap();
        prop_assert_eq!((run.end.jumps, run.end.stop), (1, Stop::Time));
    }
}
