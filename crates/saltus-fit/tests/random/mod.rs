//! Numbers for what is made at random.

/// A generator of numbers that look random and are the same in every run (S. Vigna's `splitmix64`).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    /// One of 0 to n - 1.
    pub(crate) fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % n.max(1) as u64) as usize
    }
}
