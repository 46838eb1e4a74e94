//! Where the balls of a line are, by their gaps.

use saltus::State;

/// The state of N balls on a line: N gaps in m, N velocities in m/s.
///
/// Gap 0 is the position of the first ball (its distance from the floor, if there is one), gap i
/// the distance between the surfaces of the balls i - 1 and i. So a gap of 10⁻⁹ m at a height of 1
/// m has sixteen digits, and radii do not appear.
///
/// ```
/// use saltus_bounce::line::Row;
/// let row = Row::at([0.0, 1.0, 2.5], [1.0, 0.0, -1.0]);
/// assert_eq!(row.gaps, [0.0, 1.0, 1.5]);
/// assert_eq!(row.positions(), [0.0, 1.0, 2.5]);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row<const N: usize> {
    /// The position of the first ball, then the distances between neighbours.
    pub gaps: [f64; N],
    /// The velocities, upwards or to the right.
    pub velocities: [f64; N],
}

impl<const N: usize> Row<N> {
    /// The state of points at these positions, in rising order.
    #[must_use]
    pub fn at(positions: [f64; N], velocities: [f64; N]) -> Self {
        let gap = |i: usize| if i == 0 { positions[0] } else { positions[i] - positions[i - 1] };
        Self { gaps: std::array::from_fn(gap), velocities }
    }

    /// The positions, as if the balls were points.
    #[must_use]
    pub fn positions(&self) -> [f64; N] {
        let mut sum = 0.0;
        self.gaps.map(|gap| {
            sum += gap;
            sum
        })
    }
}

impl<const N: usize> State for Row<N> {
    #[inline]
    fn len(&self) -> usize {
        2 * N
    }
    #[inline]
    fn get(&self, i: usize) -> f64 {
        if i < N { self.gaps[i] } else { self.velocities[i - N] }
    }
    #[inline]
    fn with(&self, mut f: impl FnMut(usize) -> f64) -> Self {
        Self { gaps: self.gaps.with(&mut f), velocities: self.velocities.with(|i| f(N + i)) }
    }
}
