//! What a ball among walls is doing, and what may happen to it.

use nalgebra::SVector;

use crate::walls::Face;

/// The mode of the ball: flight, or a kind of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stance<const N: usize> {
    /// Flight.
    Flight {
        /// The cell in which the ball flies.
        cell: usize,
    },
    /// Contact with a face, with slip or free to slip.
    Slide {
        /// The face.
        face: Face,
        /// The slip when it began, in m/s: in the plane its first entry, along the tangent (n₁,
        /// -n₀). Zero where there is no friction.
        along: SVector<f64, N>,
    },
    /// Contact with a face, in space, on which friction has just given way: the slip is along the
    /// push, for it has no direction of its own yet.
    Yield {
        /// The face.
        face: Face,
        /// The push when friction gave way, the change of slip without friction, in m/s².
        push: SVector<f64, N>,
        /// The time when friction gave way, in s.
        since: f64,
    },
    /// Contact with a face without slip: the ball lies, is carried, or rolls.
    Hold {
        /// The face.
        face: Face,
    },
    /// Contact with several planes at rest.
    Corner {
        /// The cell.
        cell: usize,
        /// Bit i stands for face i.
        faces: u16,
    },
}

impl<const N: usize> Stance<N> {
    /// Flight in a space that is not cut into cells.
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

/// The event that ends a stance.
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
        /// The direction of [`Stance::Slide`], or the push of [`Stance::Yield`].
        along: SVector<f64, N>,
    },
    /// Friction no longer holds it.
    Slip(Face),
    /// A slip that began along the push is large enough for a direction of its own.
    Veer {
        /// The face.
        face: Face,
        /// The push of [`Stance::Yield`].
        push: SVector<f64, N>,
        /// The time of [`Stance::Yield`].
        since: f64,
    },
    /// A wall changes its motion, at a time of its schedule.
    Change,
    /// A flight turns where its acceleration has a kink
    /// ([`Effect::kink`](crate::effects::Effect::kink)): nothing jumps, a step ends here.
    Turn,
}
