//! Names of edges.

use std::fmt;

/// Names an edge of a [`Hybrid`](crate::Hybrid): the modes it joins, and which of the edges out of
/// the first it is.
///
/// ```
/// use saltus::Link;
/// let link = Link { from: "flight", to: "rest", place: 1 };
/// assert_eq!(format!("{link:?}"), "flight -> rest (edge 1)");
/// ```
///
/// With the feature `serde` it is read from text that lasts as long as the program: see
/// [`Checkpoint`](crate::Checkpoint).
#[derive(Clone, Copy, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Link {
    /// The mode it leaves.
    pub from: &'static str,
    /// The mode it leads to.
    pub to: &'static str,
    /// Its place among the edges out of `from`, in the order in which they were declared.
    pub place: usize,
}

impl PartialEq for Link {
    #[inline]
    fn eq(&self, other: &Self) -> bool {
        self.place == other.place && same(self.from, other.from) && same(self.to, other.to)
    }
}

/// Whether two names are one; mostly they lie in one place, and to compare letters takes longer
/// than many a guard.
#[inline]
fn same(name: &str, other: &str) -> bool {
    std::ptr::eq(name, other) || name == other
}

impl fmt::Debug for Link {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} -> {} (edge {})", self.from, self.to, self.place)
    }
}
