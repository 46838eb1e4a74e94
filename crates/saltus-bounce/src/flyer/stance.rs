//! What a ball among walls is doing, and what may happen to it.

use nalgebra::SVector;

use crate::walls::Face;

/// What the ball is doing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stance<const N: usize> {
    /// In the air.
    Flight {
        /// In which cell.
        cell: usize,
    },
    /// In contact with a face, and slipping on it or free to.
    Slide {
        /// The face.
        face: Face,
        /// The slip when it began, in m/s: in the plane its first entry, along the tangent (n₁,
        /// -n₀). Zero where there is no friction.
        along: SVector<f64, N>,
    },
    /// In space, in contact with a face on which friction has just given way: the slip is along the
    /// push, for it has no direction of its own yet.
    Yield {
        /// The face.
        face: Face,
        /// The push when friction gave way, the change of slip without friction, in m/s².
        push: SVector<f64, N>,
        /// When it gave way, in s.
        since: f64,
    },
    /// In contact with a face without slip: it lies, is carried, or rolls.
    Hold {
        /// The face.
        face: Face,
    },
    /// In contact with several planes at rest.
    Corner {
        /// The cell.
        cell: usize,
        /// Bit i stands for face i.
        faces: u16,
    },
}

impl<const N: usize> Stance<N> {
    /// In the air of a space that is not cut into cells.
    pub const FLIGHT: Self = Self::Flight { cell: 0 };

    /// The cell.
    #[must_use]
    pub const fn cell(&self) -> usize {
        match self {
            Self::Flight { cell } | Self::Corner { cell, .. } => *cell,
            Self::Slide { face, .. } | Self::Yield { face, .. } | Self::Hold { face } => face.cell,
        }
    }

    /// Whether it is in contact with the face of this index in its cell.
    #[must_use]
    pub const fn touches(&self, index: usize) -> bool {
        match self {
            Self::Flight { .. } => false,
            Self::Slide { face, .. } | Self::Yield { face, .. } | Self::Hold { face } => face.index == index,
            Self::Corner { faces, .. } => *faces >> index & 1 == 1,
        }
    }
}

/// What ends a stance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Event<const N: usize> {
    /// The ball meets a face: an impact, or the passage into the next cell.
    Meet(Face),
    /// The normal force falls to zero: it leaves the face.
    Leave(Face),
    /// The slip that was along `along` has come to an end.
    Stop {
        /// The face.
        face: Face,
        /// As in [`Stance::Slide`], or the push of [`Stance::Yield`].
        along: SVector<f64, N>,
    },
    /// Friction no longer holds it.
    Slip(Face),
    /// A slip that began along the push is large enough for a direction of its own.
    Veer {
        /// The face.
        face: Face,
        /// As in [`Stance::Yield`].
        push: SVector<f64, N>,
        /// As in [`Stance::Yield`].
        since: f64,
    },
    /// A wall changes its motion, at a time of its schedule.
    Change,
    /// A flight turns where its acceleration has a kink
    /// ([`Effect::kink`](crate::effects::Effect::kink)): nothing jumps, a step ends here.
    Turn,
}
