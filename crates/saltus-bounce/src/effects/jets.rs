//! A flight over numbers that carry their Taylor series.

use saltus::Jet;

/// A moment of a flight as a series of time: what [`Effect::series`](super::Effect::series) is
/// given.
#[derive(Clone, Copy, Debug)]
pub struct JetMotion<'j, const N: usize> {
    /// The velocity in m/s; inside a [`Wind`](super::Wind) relative to the air.
    pub velocity: [Jet<'j>; N],
    /// |velocity| in m/s; its series ends where the ball stands still.
    pub speed: Jet<'j>,
    /// The spin in rad/s: as many coordinates as the ball's spin has, then zeros.
    pub spin: [Jet<'j>; 3],
}

impl<'j, const N: usize> JetMotion<'j, N> {
    /// A ball at a velocity in m/s that spins.
    #[inline(always)]
    #[must_use]
    pub fn new(velocity: [Jet<'j>; N], spin: [Jet<'j>; 3]) -> Self {
        let mut square = velocity[0] * velocity[0];
        for v in &velocity[1..] {
            square += *v * *v;
        }
        Self { velocity, speed: square.sqrt(), spin }
    }
}

/// Accelerations and rates of the spin, added up effect by effect.
#[derive(Clone, Copy, Debug)]
pub struct JetSum<'j, const N: usize> {
    acceleration: [Option<Jet<'j>>; N],
    /// The constant part, upwards in m/s².
    constant: f64,
    spin: [Option<Jet<'j>>; 3],
}

impl<const N: usize> Default for JetSum<'_, N> {
    fn default() -> Self {
        Self { acceleration: [None; N], constant: 0.0, spin: [None; 3] }
    }
}

/// Adds to what may be nothing yet: a sum with zero would be one number more on the way.
///
/// perf: arrays of jets are gone through by index. What `map`, `zip` and `from_fn` make of them is
/// not compiled into one piece, and took a quarter of a step's time.
#[inline(always)]
fn add<'j, const M: usize>(sums: &mut [Option<Jet<'j>>; M], by: &[Jet<'j>; M]) {
    for i in 0..M {
        sums[i] = Some(match sums[i] {
            Some(sum) => sum + by[i],
            None => by[i],
        });
    }
}

/// Each of these numbers times a factor.
#[inline(always)]
pub(crate) fn times<'j, const M: usize>(of: &[Jet<'j>; M], factor: Jet<'j>) -> [Jet<'j>; M] {
    let mut product = *of;
    for number in &mut product {
        *number *= factor;
    }
    product
}

/// The sum, or zero where there is none.
#[inline(always)]
fn total<'j, const M: usize>(sums: &[Option<Jet<'j>>; M]) -> [Jet<'j>; M] {
    let mut total = [Jet::from(0.0); M];
    for i in 0..M {
        if let Some(sum) = sums[i] {
            total[i] = sum;
        }
    }
    total
}

impl<'j, const N: usize> JetSum<'j, N> {
    /// Adds an acceleration in m/s².
    #[inline(always)]
    pub fn accelerate(&mut self, by: [Jet<'j>; N]) {
        add(&mut self.acceleration, &by);
    }

    /// Adds a constant acceleration upwards in m/s².
    #[inline]
    pub fn lift(&mut self, by: f64) {
        self.constant += by;
    }

    /// Adds a rate of change of the spin in rad/s².
    #[inline(always)]
    pub fn turn(&mut self, by: [Jet<'j>; 3]) {
        add(&mut self.spin, &by);
    }

    /// The acceleration in m/s².
    #[inline(always)]
    #[must_use]
    pub fn acceleration(&self) -> [Jet<'j>; N] {
        let mut sum = total(&self.acceleration);
        if let Some(up) = sum.last_mut().filter(|_| self.constant != 0.0) {
            *up += self.constant;
        }
        sum
    }

    /// The rate of change of the spin in rad/s².
    #[inline(always)]
    #[must_use]
    pub fn spin_rate(&self) -> [Jet<'j>; 3] {
        total(&self.spin)
    }
}
