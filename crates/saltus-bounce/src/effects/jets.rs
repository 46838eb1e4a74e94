//! A flight over numbers that carry their Taylor series.

use saltus::Jet;

/// A moment of a flight as a series of time: what [`Effect::series`](super::Effect::series) is
/// given.
#[derive(Clone, Copy, Debug)]
pub struct JetMotion<'j, const N: usize> {
    /// In m/s; inside a [`Wind`](super::Wind) relative to the air.
    pub velocity: [Jet<'j>; N],
    /// |velocity| in m/s; its series ends where the ball stands still.
    pub speed: Jet<'j>,
    /// In rad/s, as many coordinates as the spin has, and zeros.
    pub spin: [Jet<'j>; 3],
}

impl<'j, const N: usize> JetMotion<'j, N> {
    /// A ball at a velocity in m/s that spins.
    #[must_use]
    pub fn new(velocity: [Jet<'j>; N], spin: [Jet<'j>; 3]) -> Self {
        let square = velocity.iter().skip(1).fold(velocity[0].powi(2), |sum, v| sum + v.powi(2));
        Self { velocity, speed: square.sqrt(), spin }
    }
}

/// Accelerations and rates of the spin, added up effect by effect.
#[derive(Clone, Copy, Debug)]
pub struct JetSum<'j, const N: usize> {
    acceleration: [Option<Jet<'j>>; N],
    /// What is constant, upwards in m/s².
    constant: f64,
    spin: [Option<Jet<'j>>; 3],
}

impl<const N: usize> Default for JetSum<'_, N> {
    fn default() -> Self {
        Self { acceleration: [None; N], constant: 0.0, spin: [None; 3] }
    }
}

/// Adds to what may be nothing yet: a sum with zero would be one number more on the way.
#[inline]
fn add<'j, const M: usize>(sums: &mut [Option<Jet<'j>>; M], by: [Jet<'j>; M]) {
    for (sum, by) in sums.iter_mut().zip(by) {
        *sum = Some(sum.map_or(by, |sum| sum + by));
    }
}

impl<'j, const N: usize> JetSum<'j, N> {
    /// Adds an acceleration in m/s².
    #[inline]
    pub fn accelerate(&mut self, by: [Jet<'j>; N]) {
        add(&mut self.acceleration, by);
    }

    /// Adds a constant acceleration upwards in m/s².
    #[inline]
    pub fn lift(&mut self, by: f64) {
        self.constant += by;
    }

    /// Adds a rate of change of the spin in rad/s².
    #[inline]
    pub fn turn(&mut self, by: [Jet<'j>; 3]) {
        add(&mut self.spin, by);
    }

    /// The acceleration in m/s².
    #[must_use]
    pub fn acceleration(&self) -> [Jet<'j>; N] {
        let mut sum = self.acceleration.map(|sum| sum.unwrap_or(0.0.into()));
        if let Some(up) = sum.last_mut().filter(|_| self.constant != 0.0) {
            *up += self.constant;
        }
        sum
    }

    /// The rate of change of the spin in rad/s².
    #[must_use]
    pub fn spin_rate(&self) -> [Jet<'j>; 3] {
        self.spin.map(|sum| sum.unwrap_or(0.0.into()))
    }
}
