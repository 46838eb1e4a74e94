//! Impacts on balls that stand on the floor.

use super::{Contact, Line, Lying, Row};
use crate::restitution::Restitution;

/// Speeds that are rounding, as a part of the greatest.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// After how many impacts the rest of the speeds is taken to be lost, for each ball.
const MOST: usize = 1 << 20;

impl<const N: usize, R: Restitution + Copy> Line<N, R> {
    /// The jump at `contact` if `lying` balls lie before it.
    ///
    /// Balls that touch each other from the floor up hand the impact on at the same time, lowest approach first. With enough loss infinitely many
    /// impacts happen at that time, and their speeds shrink geometrically to nothing: they are followed down to rounding.
    pub(super) fn struck(&self, Contact(contact): Contact, lying: Lying, x: &Row<N>) -> (Lying, Row<N>) {
        let mut after = self.closed(contact, x);
        if !(self.floor && self.gravity > 0.0) {
            return (lying, after);
        }
        let greatest = self.greatest(x);
        let lying = Lying { fastest: lying.fastest.max(greatest), ..lying };
        if greatest <= f64::EPSILON * lying.fastest {
            // What is left of the motion is too short for time to tell.
            return self.merged(lying, &[true; N], &after);
        }
        let standing = after.gaps.iter().take_while(|&&gap| gap == 0.0).count();
        if contact >= standing {
            return (lying, after);
        }
        let rounding = ROUNDING * greatest;
        let mut lost = true;
        for _ in 0..MOST * N {
            let Some(next) = (0..standing).find(|&i| approach(i, &after) > rounding) else {
                lost = false;
                break;
            };
            after = self.closed(next, &after);
        }
        let closed = std::array::from_fn(|i| i < standing && (lost || -approach(i, &after) <= rounding));
        self.merged(Lying { balls: 0, ..lying }, &closed, &after)
    }

    /// The greatest speed at which a ball would arrive at the floor if nothing were in its way.
    fn greatest(&self, x: &Row<N>) -> f64 {
        let squares = x.velocities.iter().zip(x.positions()).map(|(v, y)| v * v + 2.0 * self.gravity * y);
        squares.fold(0.0, f64::max).sqrt()
    }
}

/// The speed at which the bodies at `contact` approach; negative if they part.
fn approach<const N: usize>(contact: usize, x: &Row<N>) -> f64 {
    let below = if contact == 0 { 0.0 } else { x.velocities[contact - 1] };
    below - x.velocities[contact]
}
