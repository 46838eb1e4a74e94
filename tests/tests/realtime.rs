//! Frame by frame: the same impacts for every frame rate, without allocation, with bounded work.

use allocation_counter::measure;
use saltus::nalgebra::vector;
use saltus::step::Stepper;
use saltus::{Automaton, Dop853, JumpOf, Simulation};
use saltus_bounce::effects::{Gravity, QuadraticDrag};
use saltus_bounce::flight::QuadraticDragFlight;
use saltus_bounce::walls::{Cuboid, Plane, Table};
use saltus_bounce::{Ball, Cor, Flyer, Live, Mode, Moving, Phase, Stance};

fn cor(e: f64) -> Cor {
    Cor::new(e).unwrap()
}

/// Frame times to `end`: at a rate in 1/s, or irregular for 0.
fn frames(rate: f64, end: f64) -> Vec<f64> {
    let mut times = Vec::new();
    let (mut t, mut k) = (0.0, 1_u32);
    while t < end {
        let random = f64::from(k.wrapping_mul(2_654_435_761) >> 8) / f64::from(1 << 24);
        t = if rate > 0.0 { f64::from(k) / rate } else { t + 1e-4 + 0.3 * random * random * random };
        times.push(t.min(end));
        k += 1;
    }
    times
}

/// Every frame rate meets the jumps of a whole run, to the bit, and shows its states.
fn check<A: Automaton, M: Stepper>(
    automaton: &A,
    simulation: Simulation<'_, A, M>,
    mode: A::Mode,
    x: A::State,
    end: f64,
) where
    A::State: PartialEq,
{
    use saltus::State;
    let run = simulation.run(mode, x.clone(), 0.0..end).unwrap();
    for rate in [24.0, 30.0, 60.0, 240.0, 1.0, 0.0] {
        let times = frames(rate, end);
        let mut live = Live::start(automaton, simulation, mode, x.clone(), 0.0..end).unwrap();
        let mut met: Vec<JumpOf<A>> = Vec::new();
        for &t in &times {
            let before = met.len();
            let frame = live.advance_to(t, |jump| met.push(jump.clone())).unwrap();
            assert!(!frame.late && frame.t == t);
            assert!(met[before..].iter().all(|jump| jump.t() <= t));
            let shown = run.trajectory.at(t).unwrap();
            for i in 0..shown.len() {
                let (a, b) = (frame.state.get(i), shown.get(i));
                assert!((a - b).abs() <= 1e-9 * (1.0 + b.abs()), "rate {rate}, t = {t}: {a} instead of {b}, {frame:?}");
            }
        }
        assert_eq!(met.len(), run.trajectory.jumps().len(), "rate {rate}");
        for (a, b) in met.iter().zip(run.trajectory.jumps()) {
            assert!(a.time == b.time && a.before == b.before && a.after == b.after && a.j == b.j && a.to == b.to);
        }
    }
}

#[test]
fn every_frame_rate_meets_the_same_impacts() {
    let ball = Ball::new(9.81, cor(0.8)).unwrap();
    check(&ball, Simulation::of(&ball), Mode::Flight, vector![2.0, 0.0], 8.0);
    let ball = Ball::of(QuadraticDragFlight::new(9.81, 0.1).unwrap(), cor(0.7));
    check(&ball, Simulation::of(&ball), Phase::Falling, vector![2.0, 0.0], 8.0);
    let table = Flyer::new(Gravity::EARTH, Table::new(0.005, 50.0).unwrap(), cor(0.5)).unwrap();
    check(&table, Simulation::of(&table), Stance::FLIGHT, Moving::new(vector![0.3], vector![0.0]), 3.0);
    let room = Cuboid::between(vector![0.0, 0.0], vector![3.0, 2.0]).unwrap();
    let thrown = Flyer::new((Gravity::EARTH, QuadraticDrag::new(0.05).unwrap()), room, cor(0.8)).unwrap();
    let start = Moving::new(vector![1.0, 1.0], vector![5.0, 3.0]);
    check(&thrown, Simulation::of(&thrown), Stance::FLIGHT, start, 6.0);
    // An arc of more steps than are kept at a time.
    let fine = Simulation::of(&thrown).stepper(Dop853).longest_step(2e-3);
    check(&thrown, fine, Stance::FLIGHT, start, 3.0);
}

#[test]
fn frames_do_not_allocate() {
    let ball = Ball::new(9.81, cor(0.9)).unwrap();
    let mut live = Live::start(&ball, Simulation::of(&ball), Mode::Flight, vector![1.0, 0.0], 0.0..60.0).unwrap();
    let effects = (Gravity::EARTH, QuadraticDrag::new(0.05).unwrap());
    let thrown = Flyer::new(effects, Plane::floor(0.0).unwrap(), cor(0.8)).unwrap();
    let start = Moving::new(vector![0.0, 1.0], vector![5.0, 3.0]);
    let mut other = Live::start(&thrown, Simulation::of(&thrown), Stance::FLIGHT, start, 0.0..60.0).unwrap();
    let mut impacts = 0_usize;
    let counted = measure(|| {
        for _ in 0..1200 {
            live.advance(1.0 / 60.0, |_| impacts += 1).unwrap();
            other.advance(1.0 / 60.0, |_| impacts += 1).unwrap();
        }
    });
    assert_eq!(counted.count_total, 0);
    assert!(impacts > 300);
}

/// Work per frame is bounded: what does not fit comes later, in order.
#[test]
fn a_frame_with_too_many_impacts_is_late() {
    let ball = Ball::new(9.81, cor(0.9)).unwrap();
    let simulation = Simulation::of(&ball);
    let mut live = Live::start(&ball, simulation, Mode::Flight, vector![1.0, 0.0], 0.0..60.0).unwrap().most_jumps(10);
    let mut met = Vec::new();
    let frame = live.advance(30.0, |jump| met.push(jump.j)).unwrap();
    assert!(frame.late && met.len() == 10 && frame.t < 30.0);
    while live.advance(0.0, |jump| met.push(jump.j)).unwrap().late {}
    let frame = live.advance(0.0, |_| {}).unwrap();
    assert_eq!((frame.mode, frame.t), (Mode::Rest, 30.0));
    assert!(met.iter().enumerate().all(|(k, &j)| j == k + 1));
}

/// Beyond the end of the span and of the jumps allowed, the state stands.
#[test]
fn after_the_end() {
    let ball = Ball::new(9.81, cor(0.9)).unwrap();
    let mut live = Live::start(&ball, Simulation::of(&ball), Mode::Flight, vector![1.0, 0.0], 0.0..1.0).unwrap();
    let frame = live.advance(9.0, |_| {}).unwrap();
    assert!(frame.t == 1.0 && frame.state[0] > 0.0);
    let simulation = Simulation::of(&ball).most_jumps(2);
    let mut live = Live::start(&ball, simulation, Mode::Flight, vector![1.0, 0.0], 0.0..9.0).unwrap();
    let frame = live.advance(8.0, |_| {}).unwrap();
    assert_eq!(frame.state[0], 0.0);
}
