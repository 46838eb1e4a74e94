//! Which edges were taken last: those that take part when jumps accumulate.

/// How many jumps are remembered: two rounds of the longest cycle.
const MEMORY: usize = 2 * LONGEST;
/// The longest cycle of jumps that is distinguished from jumps in no order: two balls that come to
/// rest in a corner each meet floor and wall, there and back.
const LONGEST: usize = 8;

/// The edges of the last jumps.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct Recent<E> {
    edges: [Option<E>; MEMORY],
    count: usize,
}

impl<E: Copy + PartialEq> Recent<E> {
    pub(crate) const fn new() -> Self {
        Self { edges: [None; MEMORY], count: 0 }
    }

    #[inline]
    pub(crate) fn push(&mut self, edge: E) {
        self.edges[self.count % MEMORY] = Some(edge);
        self.count += 1;
    }

    /// The last edges: of the shortest cycle in which all that are remembered, but at most two
    /// rounds and four jumps, repeat; else each edge that is remembered.
    #[cold]
    pub(crate) fn cycle(&self) -> Cycle<E> {
        let known = self.count.min(MEMORY);
        let last = |back: usize| self.edges[(self.count - 1 - back) % MEMORY];
        let repeats = |cycle: usize| {
            let seen = known.min(2 * cycle.max(4));
            (0..seen.saturating_sub(cycle)).all(|back| last(back) == last(back + cycle))
        };
        let mut found = Cycle { edges: [None; MEMORY], len: 0 };
        match (1..=LONGEST.min(known)).find(|&cycle| repeats(cycle)) {
            Some(cycle) => (0..cycle).rev().for_each(|back| found.push(last(back))),
            None => (0..known).rev().for_each(|back| found.push_new(last(back))),
        }
        found
    }
}

/// Edges in the order in which they were taken.
pub(crate) struct Cycle<E> {
    edges: [Option<E>; MEMORY],
    len: usize,
}

impl<E: Copy + PartialEq> Cycle<E> {
    fn push(&mut self, edge: Option<E>) {
        self.edges[self.len] = edge;
        self.len += 1;
    }

    fn push_new(&mut self, edge: Option<E>) {
        if !self.edges[..self.len].contains(&edge) {
            self.push(edge);
        }
    }

    /// Hands the edges to `to`, as a slice.
    pub(crate) fn with<T>(&self, to: impl FnOnce(&[E]) -> T) -> T {
        match self.edges[0] {
            Some(first) => to(&self.edges.map(|edge| edge.unwrap_or(first))[..self.len]),
            None => to(&[]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cycle(edges: &str) -> String {
        let mut recent = Recent::new();
        edges.chars().for_each(|edge| recent.push(edge));
        recent.cycle().with(|edges| edges.iter().collect())
    }

    #[test]
    fn the_shortest_cycle_that_all_follow() {
        assert_eq!(cycle(""), "");
        assert_eq!(cycle("a"), "a");
        assert_eq!(cycle("babaaaaaaaa"), "a");
        assert_eq!(cycle("abababababab"), "ab");
        assert_eq!(cycle("abaabaabaabaaba"), "aba");
        assert_eq!(cycle("xabcdefghabcdefghabcdefgh"), "abcdefgh");
        assert_eq!(cycle("abcaacbbacaabcba"), "abc");
    }
}
