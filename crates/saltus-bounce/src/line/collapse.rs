//! What lies beyond infinitely many impacts.

use super::{Contact, Line, Lying, Row};
use crate::restitution::Restitution;

/// The number of impacts that are followed on the way to a limit, for each ball.
const FOLLOWED: usize = 16;

impl<const N: usize, R: Restitution + Copy> Line<N, R> {
    /// The contacts that go on colliding from `x` on: the next impacts are followed in a time of
    /// their own, whose digits do not run out.
    pub(super) fn collapsing(&self, lying: Lying, x: &Row<N>) -> [bool; N] {
        let (mut lying, mut x) = (lying, *x);
        let mut closing = [false; N];
        for _ in 0..FOLLOWED * N {
            let Some((contact, s)) = self.next(lying.balls, &x) else { break };
            x = self.after(lying.balls, s, &x);
            (lying, x) = self.struck(Contact(contact), lying, &x);
            closing[contact] = true;
            // What stands below it took part.
            let standing = self.gravity > 0.0 && x.gaps[..=contact].iter().all(|&gap| gap == 0.0);
            closing[..contact].iter_mut().for_each(|closing| *closing |= standing && self.floor);
        }
        closing
    }

    /// The next impact among floor and balls, and when.
    fn next(&self, lying: usize, x: &Row<N>) -> Option<(usize, f64)> {
        let first = usize::from(!self.floor).max(lying);
        (first..N)
            .filter_map(|i| {
                let (below, a) =
                    if i == 0 { (0.0, 0.0) } else { (x.velocities[i - 1], self.acceleration(i - 1, lying)) };
                let rate = x.velocities[i] - below;
                let bend = 0.5 * (self.acceleration(i, lying) - a);
                fall([x.gaps[i].max(0.0), rate, bend]).map(|s| (i, s))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// The state after a free flight of `s` seconds.
    fn after(&self, lying: usize, s: f64, x: &Row<N>) -> Row<N> {
        let mut after = *x;
        for i in 0..N {
            let (below, a) = if i == 0 { (0.0, 0.0) } else { (x.velocities[i - 1], self.acceleration(i - 1, lying)) };
            let bend = 0.5 * (self.acceleration(i, lying) - a);
            after.gaps[i] = (x.gaps[i] + s * (x.velocities[i] - below + s * bend)).max(0.0);
            after.velocities[i] += s * self.acceleration(i, lying);
        }
        after
    }

    /// The balls on both sides of `closed` contacts move as one; what then stands on the floor lies
    /// there.
    pub(super) fn merged(&self, lying: Lying, closed: &[bool; N], x: &Row<N>) -> (Lying, Row<N>) {
        let mut after = *x;
        let mut first = 0;
        let Lying { balls: lying, fastest } = lying;
        let mut still = lying;
        while first < N {
            let end = (first + 1..N).find(|&i| !(closed[i] || i < lying)).unwrap_or(N);
            let grounded = first == 0 && (closed[0] || lying > 0);
            let masses = &self.masses[first..end];
            let momentum: f64 = masses.iter().zip(&x.velocities[first..end]).map(|(m, v)| m * v).sum();
            let common = if grounded { 0.0 } else { momentum / masses.iter().sum::<f64>() };
            if end > first + 1 || grounded {
                after.velocities[first..end].fill(common);
            }
            for i in first + usize::from(!grounded)..end {
                // What a closed gap gives up goes to the next one, so that the balls beyond stay
                // where they are.
                let spare = std::mem::replace(&mut after.gaps[i], 0.0);
                if let Some(gap) = after.gaps.get_mut(i + 1) {
                    *gap += spare;
                }
            }
            if grounded && self.gravity > 0.0 {
                still = end;
            }
            first = end;
        }
        (Lying { balls: still, fastest }, after)
    }
}

/// The first fall through zero of c₀ + c₁ s + c₂ s² at s ≥ 0, for c₀ ≥ 0 and c₂ ≤ 0.
fn fall([c0, c1, c2]: [f64; 3]) -> Option<f64> {
    if c2 == 0.0 {
        return (c1 < 0.0).then(|| c0 / -c1);
    }
    let root = (c1 * c1 - 4.0 * c0 * c2).sqrt();
    Some(if c1 > 0.0 {
        (c1 + root) / (-2.0 * c2)
    } else if root == c1 {
        0.0
    } else {
        2.0 * c0 / (root - c1)
    })
}
