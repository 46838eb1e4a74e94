//! Impacts on balls that stand on the floor.

use super::{Contact, Line, Lying, Row};
use crate::restitution::Restitution;

/// Speeds that are rounding, as a part of the greatest.
const ROUNDING: f64 = 64.0 * f64::EPSILON;
/// The number of impacts, for each ball, after which the rest of the speeds is taken to be lost.
const MOST: usize = 1 << 20;

impl<const N: usize, R: Restitution + Copy> Line<N, R> {
    /// The jump at `contact` if `lying` balls lie before it.
    ///
    /// Balls that touch each other from the floor up hand the impact on at the same time, lowest
    /// approach first. With enough loss infinitely many impacts happen at that time, and their
    /// speeds shrink geometrically to nothing: they are followed down to rounding.
    pub(super) fn struck(&self, Contact(contact): Contact, lying: Lying, x: &Row<N>) -> (Lying, Row<N>) {
        let mut after = self.closed(contact, x);
        let greatest = self.greatest(x);
        let rounding = ROUNDING * greatest;
        if !(self.floor && self.gravity > 0.0) {
            return self.in_touch(lying, 1, rounding, after);
        }
        let lying = Lying { fastest: lying.fastest.max(greatest), ..lying };
        let still = self.still(f64::EPSILON * lying.fastest, &after);
        if still > lying.balls {
            return self.merged(lying, &std::array::from_fn(|i| i < still), &after);
        }
        let standing = after.gaps.iter().take_while(|&&gap| gap == 0.0).count();
        if contact >= standing {
            return self.in_touch(lying, standing.max(1), rounding, after);
        }
        let mut lying = Lying { balls: 0, ..lying };
        for _ in 0..MOST * N {
            if let Some(next) = (0..standing).find(|&i| approach(i, &after) > rounding) {
                after = self.closed(next, &after);
                continue;
            }
            // Balls that are made one may be approached by the next one, now faster than that.
            (lying, after) = self.in_touch(lying, 0, rounding, after);
            if (0..standing).all(|i| approach(i, &after) <= 0.0) {
                return (lying, after);
            }
        }
        self.merged(lying, &std::array::from_fn(|i| i < standing), &after)
    }

    /// Balls that touch, from contact `first` on, and whose relative speed is rounding move as one:
    /// left alone they would exchange that rounding without end, before a neighbour's impact is
    /// found.
    fn in_touch(&self, lying: Lying, first: usize, rounding: f64, x: Row<N>) -> (Lying, Row<N>) {
        let slow = |i: usize| i >= first && x.gaps[i] == 0.0 && approach(i, &x).abs() <= rounding;
        self.merged(lying, &std::array::from_fn(slow), &x)
    }

    /// The number of balls from the floor up that would not arrive at it faster than at the `speed`
    /// that is rounding, if nothing were in their way.
    fn still(&self, speed: f64, x: &Row<N>) -> usize {
        let fast = |(v, y): (f64, f64)| v * v + 2.0 * self.gravity * y > speed * speed;
        x.velocities.into_iter().zip(x.positions()).position(fast).unwrap_or(N)
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
