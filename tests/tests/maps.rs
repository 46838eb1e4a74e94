//! Return maps: questions without an answer, branches that end, fates of starts.

#[allow(dead_code, unreachable_pub)]
#[path = "../../examples/wheel.rs"]
mod wheel;

use std::f64::consts::TAU;

use saltus::nalgebra::{Vector2, Vector3};
use saltus::return_map::{Continuation, End, Fate, Kind, MapError, ReturnMap, Selection};
use saltus::{About, Automaton, Edges, Entry, Linearize, Number, Refusal, Simulation};

#[test]
fn questions_without_an_answer() {
    let wheel = wheel::Wheel { g: 9.81, spoke: 1.0, half: 0.4, slope: 0.001 };
    let map = ReturnMap::of(Simulation::of(&wheel), wheel::Impact(wheel));
    // Too slow for the slope: it falls back and never comes to the next spoke.
    assert!(matches!(map.fixed_point([0.1]), Err(MapError::NoReturn { .. })));
    let family = |slope| wheel::Wheel { slope, ..wheel };
    for (parameter, to) in [(1, 0.1), (0, 0.001), (0, f64::NAN)] {
        let error = Continuation::of(&map, family, parameter).follow([1.0], 0.001, to).unwrap_err();
        assert!(matches!(error, MapError::Question(_)), "{error}");
    }
}

/// The oscillator of van der Pol, whose velocity falls through zero at its tops: a section that is
/// only passed. Length and time have units of their own.
struct Relaxing {
    time: f64,
    length: f64,
}

impl Linearize for Relaxing {
    type Parameters = [f64; 0];
    fn parameters(&self) -> [f64; 0] {
        []
    }
    fn flow_over<D: Number>(&self, (): (), _t: D, [x, v]: [D; 2], _: [D; 0]) -> [D; 2] {
        let (y, u) = (x / self.length, v * (self.time / self.length));
        [v, ((D::one() - y * y) * u - y) * (self.length / (self.time * self.time))]
    }
    fn guard_over<D: Number>(&self, (): (), _t: D, [_, v]: [D; 2], _: [D; 0]) -> D {
        v
    }
    fn reset_over<D: Number>(&self, (): (), _t: D, x: [D; 2], _: [D; 0]) -> [D; 2] {
        x
    }
}

impl Automaton for Relaxing {
    type Mode = ();
    type State = Vector2<f64>;
    type Edge = ();

    fn flow(&self, (): (), t: f64, x: &Vector2<f64>) -> Vector2<f64> {
        self.flow_at((), t, x)
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn guard(&self, (): (), t: f64, x: &Vector2<f64>) -> f64 {
        self.guard_at((), t, x)
    }
    fn reset(&self, (): (), (): (), t: f64, x: &Vector2<f64>) -> Result<((), Vector2<f64>), Refusal> {
        Ok(((), self.reset_at((), t, x)))
    }
    fn about(&self, (): ()) -> About {
        About::new().entry(Entry::Wait)
    }
}

/// A return to a section that is only passed takes a whole period, in whatever units: its amplitude
/// and period are those of the literature, its multiplier is that of the flow once around.
#[test]
fn a_section_that_is_only_passed() {
    for (time, length) in [(1.0, 1.0), (1e-9, 1.0), (1.0, 1e-6), (1e9, 1e12), (1e-9, 1e-9)] {
        let relaxing = Relaxing { time, length };
        let section = Selection::of((), ((), Vector2::new(2.0 * length, 0.0)), [0]).unwrap();
        let orbit = ReturnMap::of(Simulation::of(&relaxing), section).fixed_point([1.9 * length]).unwrap();
        assert!((orbit.q[0] / length - 2.008_619_86).abs() < 1e-7, "{time} {length}: {:?}", orbit.q);
        assert!((orbit.period / time - 6.663_286_859_3).abs() < 1e-8, "{time} {length}: {}", orbit.period);
        assert!((orbit.multipliers[0].re - 8.597e-4).abs() < 1e-6, "{time} {length}: {:?}", orbit.multipliers);
    }
}

/// A coordinate that is held and does not come back is refused, whatever is beside it: a lift at
/// z that sinks by a hundredth a turn, beside a pressure in pascals.
#[test]
fn a_held_coordinate_has_a_unit_of_its_own() {
    #[derive(Clone, Copy)]
    struct Lift;
    impl Linearize for Lift {
        type Parameters = [f64; 0];
        fn parameters(&self) -> [f64; 0] {
            []
        }
        fn flow_over<D: Number>(&self, (): (), _t: D, [_, _, v]: [D; 3], _: [D; 0]) -> [D; 3] {
            [D::zero(), v, D::from(-10.0)]
        }
        fn guard_over<D: Number>(&self, (): (), _t: D, [_, y, _]: [D; 3], _: [D; 0]) -> D {
            y - 0.5
        }
        fn reset_over<D: Number>(&self, (): (), _t: D, [p, y, v]: [D; 3], _: [D; 0]) -> [D; 3] {
            [p, y + 0.01, -v * 0.5 + 2.0]
        }
    }
    impl Automaton for Lift {
        type Mode = ();
        type State = Vector3<f64>;
        type Edge = ();
        fn flow(&self, (): (), t: f64, x: &Vector3<f64>) -> Vector3<f64> {
            self.flow_at((), t, x)
        }
        fn edges(&self, (): ()) -> Edges<'_, ()> {
            Edges::from([()])
        }
        fn guard(&self, (): (), t: f64, x: &Vector3<f64>) -> f64 {
            self.guard_at((), t, x)
        }
        fn reset(&self, (): (), (): (), t: f64, x: &Vector3<f64>) -> Result<((), Vector3<f64>), Refusal> {
            Ok(((), self.reset_at((), t, x)))
        }
    }
    for pressure in [0.0, 1.0, 101_325.0] {
        let section = Selection::of((), ((), Vector3::new(pressure, 0.5, 3.0)), [2]).unwrap();
        let error = ReturnMap::of(Simulation::of(&Lift), section).fixed_point([3.5]).unwrap_err();
        assert!(error.to_string().contains("coordinate 1 is 0.51"), "{pressure}: {error}");
    }
}

/// x'' = cos ωt - x - 2ζx', a wall at `wall`; beside place and velocity the time since the period
/// began.
#[derive(Clone, Copy, Debug)]
struct Oscillator {
    wall: f64,
    omega: f64,
    damping: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Meets {
    Wall,
    Period,
}

impl Linearize for Oscillator {
    type Parameters = [f64; 1];

    fn parameters(&self) -> [f64; 1] {
        [self.wall]
    }
    fn flow_over<D: Number>(&self, (): (), _: D, [x, v, s]: [D; 3], _: [D; 1]) -> [D; 3] {
        [v, (s * self.omega).cos() - x - v * (2.0 * self.damping), D::one()]
    }
    fn guard_over<D: Number>(&self, meets: Meets, _: D, [x, _, s]: [D; 3], [wall]: [D; 1]) -> D {
        if meets == Meets::Wall { wall - x } else { -s + TAU / self.omega }
    }
    fn reset_over<D: Number>(&self, meets: Meets, _: D, [x, v, s]: [D; 3], _: [D; 1]) -> [D; 3] {
        if meets == Meets::Wall { [x, v * -0.8, s] } else { [x, v, D::zero()] }
    }
}

impl Automaton for Oscillator {
    type Mode = ();
    type State = Vector3<f64>;
    type Edge = Meets;

    fn flow(&self, mode: (), t: f64, x: &Vector3<f64>) -> Vector3<f64> {
        self.flow_at(mode, t, x)
    }
    fn edges(&self, (): ()) -> Edges<'_, Meets> {
        Edges::from([Meets::Wall, Meets::Period])
    }
    fn guard(&self, meets: Meets, t: f64, x: &Vector3<f64>) -> f64 {
        self.guard_at(meets, t, x)
    }
    #[inline]
    fn about(&self, _: Meets) -> About {
        About::new().affine()
    }
    fn reset(&self, (): (), meets: Meets, t: f64, x: &Vector3<f64>) -> Result<((), Vector3<f64>), Refusal> {
        Ok(((), self.reset_at(meets, t, x)))
    }
}

/// The wall comes nearer until the free swing touches it: at the swing's amplitude.
#[test]
fn a_wall_that_is_grazed() {
    let oscillator = Oscillator { wall: 3.0, omega: 0.8, damping: 0.1 };
    let Oscillator { omega, damping, .. } = oscillator;
    let strobe = Selection::of(Meets::Period, ((), Vector3::zeros()), [0, 1]).unwrap();
    let map = ReturnMap::of(Simulation::of(&oscillator).tolerance(1e-12), strobe);
    let family = |wall| Oscillator { wall, ..oscillator };
    let branch = Continuation::of(&map, family, 0).follow([1.0, 1.0], 3.0, 1.0).unwrap();
    assert_eq!(branch.end, End::Grazing { edge: Meets::Wall });
    let amplitude = 1.0 / (1.0 - omega * omega).hypot(2.0 * damping * omega);
    let last = branch.points.last().unwrap();
    assert!((last.parameter - amplitude).abs() < 1e-9, "{} {amplitude}", last.parameter);
    // Damping alone shrinks areas.
    let product = last.orbit.jacobian.determinant();
    assert!((product - (-2.0 * damping * TAU / omega).exp()).abs() < 1e-10);
}

#[test]
fn fates_of_starts() {
    let wheel = wheel::Wheel { g: 9.81, spoke: 1.0, half: std::f64::consts::FRAC_PI_8, slope: 0.08 };
    let map = ReturnMap::of(Simulation::of(&wheel).most_steps(2000), wheel::Impact(wheel));
    let gait = map.fixed_point([1.2]).unwrap();
    let fates = map.fates(&[[gait.q[0]], [2.0], [0.3]], &[gait], [1e-3], 40);
    let fates: Vec<Fate> = fates.into_iter().map(Result::unwrap).collect();
    assert_eq!((fates[0], fates[2]), (Fate::Attracted { to: 0, returns: 0 }, Fate::Lost { returns: 0 }));
    // Half of the excess of ω² is left after each step: 2.8 of it becomes less than 2e-3 ω.
    assert_eq!(fates[1], Fate::Attracted { to: 0, returns: 11 });
}

/// A population counted once a year, which grows by a factor `a` and is held back by that of the
/// year before (the delayed logistic map of J. Maynard Smith, Mathematical Ideas in Biology, 1968):
/// (x, y) becomes (a x (1 - y), x).
#[derive(Clone, Copy, Debug)]
struct Yearly {
    a: f64,
}

impl Linearize for Yearly {
    type Parameters = [f64; 1];

    fn parameters(&self) -> [f64; 1] {
        [self.a]
    }
    fn flow_over<D: Number>(&self, (): (), _: D, _: [D; 3], _: [D; 1]) -> [D; 3] {
        [D::zero(), D::zero(), D::one()]
    }
    fn guard_over<D: Number>(&self, (): (), _: D, [_, _, s]: [D; 3], _: [D; 1]) -> D {
        -s + 1.0
    }
    fn reset_over<D: Number>(&self, (): (), _: D, [x, y, _]: [D; 3], [a]: [D; 1]) -> [D; 3] {
        [a * x * (-y + 1.0), x, D::zero()]
    }
}

impl Automaton for Yearly {
    type Mode = ();
    type State = Vector3<f64>;
    type Edge = ();

    fn flow(&self, mode: (), t: f64, x: &Vector3<f64>) -> Vector3<f64> {
        self.flow_at(mode, t, x)
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn guard(&self, edge: (), t: f64, x: &Vector3<f64>) -> f64 {
        self.guard_at(edge, t, x)
    }
    fn about(&self, (): ()) -> About {
        About::new().affine()
    }
    fn reset(&self, (): (), edge: (), t: f64, x: &Vector3<f64>) -> Result<((), Vector3<f64>), Refusal> {
        Ok(((), self.reset_at(edge, t, x)))
    }
}

/// At a = 2 the multipliers of x = y = 1 - 1/a are exp(±iπ/3).
#[test]
fn a_circle_branches_off() {
    let yearly = Yearly { a: 1.5 };
    let count = Selection::of((), ((), Vector3::zeros()), [0, 1]).unwrap();
    let map = ReturnMap::of(Simulation::of(&yearly), count);
    let branch = Continuation::of(&map, |a| Yearly { a }, 0).follow([0.3, 0.3], 1.5, 2.2).unwrap();
    let [found] = &branch.bifurcations[..] else { panic!("{:?}", branch.bifurcations) };
    assert_eq!(found.kind, Kind::NeimarkSacker);
    assert!((found.point.parameter - 2.0).abs() < 1e-9, "{:?}", found.point);
    assert!(found.point.orbit.q.iter().all(|x| (x - 0.5).abs() < 1e-9));
    for multiplier in &found.point.orbit.multipliers {
        assert!((multiplier.re - 0.5).abs() < 1e-9 && (multiplier.im.abs() - 0.75_f64.sqrt()).abs() < 1e-9);
    }
    assert!(branch.points.iter().all(|point| (point.orbit.q[0] - (1.0 - 1.0 / point.parameter)).abs() < 1e-10));
}
