//! Where the balls of a cloud are.

use saltus::State;

/// The state of N balls in D dimensions: centres in m, velocities in m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Swarm<const D: usize, const N: usize> {
    /// The centres.
    pub centres: [[f64; D]; N],
    /// The velocities.
    pub velocities: [[f64; D]; N],
}

impl<const D: usize, const N: usize> State for Swarm<D, N> {
    #[inline]
    fn len(&self) -> usize {
        2 * D * N
    }
    #[inline]
    fn get(&self, i: usize) -> f64 {
        let (centres, velocities) = (self.centres.as_flattened(), self.velocities.as_flattened());
        if i < D * N { centres[i] } else { velocities[i - D * N] }
    }
    #[inline]
    fn with(&self, mut f: impl FnMut(usize) -> f64) -> Self {
        let mut state = *self;
        for (i, x) in state.centres.as_flattened_mut().iter_mut().enumerate() {
            *x = f(i);
        }
        for (i, v) in state.velocities.as_flattened_mut().iter_mut().enumerate() {
            *v = f(D * N + i);
        }
        state
    }
}
