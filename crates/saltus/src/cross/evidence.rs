//! How a search came to its result.

/// How a search came to its result.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Evidence {
    /// Bounds on the guard over the whole interval leave no room for a fall.
    Excluded,
    /// The interval was halved until bounds left no room for a fall in any part, or a single fall
    /// in the first part that has one.
    Isolated,
    /// Between two times a crossing may have been missed, or one may be none.
    Doubtful {
        /// Why.
        why: Doubt,
        /// Where that begins.
        from: f64,
        /// Where it ends.
        to: f64,
    },
}

/// Why a crossing may have been missed, or one may be none: the stronger, the later in this list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[non_exhaustive]
pub enum Doubt {
    /// The guard comes so close to zero, and turns, that the error of the step decides whether it
    /// falls: it did not, or it fell and would have risen again.
    Grazing,
    /// The guard is nothing but rounding: a touch, or two crossings so close that its values do not
    /// show them. It was taken for zero.
    Rounding,
    /// The guard varies too fast to be resolved within the limit on evaluations: only the signs at
    /// both ends were used.
    Unresolved,
    /// The guard changes its sign without coming near zero, the times being some thousand roundings
    /// apart. At a pole, where it is larger the nearer it is looked at, that is no crossing; a leap
    /// is taken for one.
    Discontinuous,
    /// Jumps were taken to accumulate though rounding hides whether they do: what lies beyond the
    /// limit may come later, or never.
    Accumulated,
    /// The guard is below zero at the end of the arc by more than its noise, and no crossing of it
    /// was found on the arc.
    Missed,
}

impl Evidence {
    /// A doubt between two times.
    pub(crate) const fn doubtful(why: Doubt, from: f64, to: f64) -> Self {
        Self::Doubtful { why, from, to }
    }

    /// Why a crossing may have been missed, if one may.
    #[must_use]
    pub const fn doubt(&self) -> Option<Doubt> {
        match self {
            Self::Doubtful { why, .. } => Some(*why),
            Self::Excluded | Self::Isolated => None,
        }
    }

    /// The weaker of two; of two doubts of one kind all from the first to the second.
    pub(crate) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Doubtful { why, from, .. }, Self::Doubtful { why: second, to, .. }) if why == second => {
                Self::Doubtful { why, from, to }
            }
            _ if other.weakness() > self.weakness() => other,
            _ => self,
        }
    }

    fn weakness(self) -> (bool, Option<Doubt>) {
        (self != Self::Excluded, self.doubt())
    }

    /// The same with its times counted from a moment `s` earlier.
    pub(crate) fn later(self, s: f64) -> Self {
        match self {
            Self::Doubtful { why, from, to } => Self::Doubtful { why, from: from + s, to: to + s },
            sure => sure,
        }
    }
}
