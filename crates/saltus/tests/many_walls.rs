//! Any number of guards that are zero, but for rounding, as a mode is entered: none is forgotten.

use proptest::prelude::*;
use saltus::{About, Auto, Automaton, Edges, Refusal, Simulation};
use saltus_cases::cases;

use crate::methods::methods;

/// The most balls side by side.
const MOST: usize = 24;

/// Height and velocity of each, all falling with one metre per second squared.
type Balls = [f64; 2 * MOST];

/// Balls that are thrown up at one instant, each from a floor of its own.
struct Court {
    floors: Vec<f64>,
    promised: bool,
}

impl Automaton for Court {
    type Mode = ();
    type State = Balls;
    type Edge = usize;

    fn flow(&self, (): (), _t: f64, x: &Balls) -> Balls {
        std::array::from_fn(|i| if i % 2 == 0 { x[i + 1] } else { -1.0 })
    }
    fn edges(&self, (): ()) -> Edges<'_, usize> {
        Edges::indexed(self.floors.len(), |ball| ball)
    }
    fn guard(&self, ball: usize, _t: f64, x: &Balls) -> f64 {
        x[2 * ball] - self.floors[ball]
    }
    fn about(&self, _: usize) -> About {
        if self.promised { About::new().affine() } else { About::new() }
    }
    fn reset(&self, (): (), ball: usize, _t: f64, x: &Balls) -> Result<((), Balls), Refusal> {
        let mut x = *x;
        (x[2 * ball], x[2 * ball + 1]) = (self.floors[ball], 100.0); // away for good
        Ok(((), x))
    }
}

/// The times at which the balls come down, by one method.
fn landings(court: &Court, start: Balls, stepper: Auto) -> Vec<(usize, f64)> {
    let run = Simulation::of(court).stepper(stepper).tolerance(1e-9).run((), start, 0.0..9.0).unwrap();
    run.trajectory.jumps().iter().map(|jump| (jump.edge().unwrap(), jump.t())).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(40)))]

    /// Each lands after twice the speed of its throw, though rounding has left its height on either
    /// side of its floor as the run starts.
    #[test]
    fn balls_thrown_up_at_once_land_once_each(
        balls in prop::collection::vec((0.1..10.0_f64, -1..=1_i32, 0.5..4.0_f64), 2..=MOST),
        promised: bool,
        method in 0..4_usize,
    ) {
        let court = Court { floors: balls.iter().map(|(floor, ..)| *floor).collect(), promised };
        let mut start = [0.0; 2 * MOST];
        for (place, (floor, off, speed)) in start.chunks_mut(2).zip(&balls) {
            place.copy_from_slice(&[floor * (1.0 + f64::from(*off) * f64::EPSILON), *speed]);
        }
        let mut found = landings(&court, start, methods()[method]);
        found.sort_by_key(|(ball, _)| *ball);
        prop_assert_eq!(found.len(), balls.len());
        for ((ball, t), (k, (.., speed))) in found.iter().zip(balls.iter().enumerate()) {
            prop_assert!(*ball == k && (t - 2.0 * speed).abs() < 1e-7, "{ball} at {t}, thrown at {speed}");
        }
    }
}
