//! Rebounds so small that their flight is within the rounding of the time before.

use saltus::nalgebra::{Vector3, vector};
use saltus::{Hybrid, Polynomial, Simulation};

/// A kick follows the impact at once and drives the ball back to the floor; it meets it however
/// slow the rebound was.
#[test]
fn a_rebound_too_short_to_time_is_a_rebound() {
    for rebound in [1e-3, 1e-12, 3e-16] {
        let automaton = Hybrid::new()
            .mode("run", |_t, x: &Vector3<f64>| vector![x[1], -10.0, -1.0])
            .exact("run", |_t, x| Polynomial::from([*x, vector![x[1], -10.0, -1.0], vector![-5.0, 0.0, 0.0]]))
            .edge("run", "run", |_t, x| x[0], move |_t, x| vector![0.0, if x[1] < -2.0 { rebound } else { 3.0 }, x[2]])
            .edge("run", "run", |_t, x| x[2], |_t, x| vector![x[0], -1.0, 10.0]);
        let run = Simulation::of(&automaton).run("run", vector![5.0, 0.0, 1.0], 0.0..1.2).unwrap();
        let edges: Vec<_> = run.trajectory.jumps().iter().map(|jump| jump.edge().unwrap().place).collect();
        assert_eq!(edges, [0, 1, 0], "{rebound:e}");
        assert!(run.end.state[0] > 0.0, "{rebound:e}: {:?}", run.end.state);
    }
}
