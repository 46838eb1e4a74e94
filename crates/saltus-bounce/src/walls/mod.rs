//! Floors, walls, boxes, stairs, curved ground, floors that move: surfaces that a ball may not
//! pass.
//!
//! A surface is a **margin** φ(t, p), positive where the ball may be and zero on the surface, with
//! its derivatives. A tuple, an array or a `Vec` of walls is a wall. Where a surface ends, space is
//! cut into **cells**: in each the margins are smooth, and some of its faces are no walls but lead
//! into the next cell; so a corner is where two plain faces meet, and no margin has a kink.
//!
//! Positions are those of the ball's centre or of its lowest point, as the scene has it: for a ball
//! of radius R move the walls by R.

mod cuboid;
mod curved;
mod moving;
mod plane;
mod stairs;

use nalgebra::SVector;

pub use cuboid::Cuboid;
pub use curved::{Ground, Round};
pub use moving::{Lift, Shaken, Table};
pub use plane::Plane;
pub use stairs::Stairs;

/// A face of a cell.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Face {
    /// The cell, below [`Walls::cells`].
    pub cell: usize,
    /// The face within it, below [`Walls::faces`].
    pub index: usize,
}

/// Surfaces that bound where a ball may be, in N coordinates, the last of which points up.
///
/// One smooth surface of one cell needs `margin`, `gradient`, and `bend` if it is curved or moves,
/// `rate` if it moves. A face moves along its normal.
///
/// ```
/// use nalgebra::{Vector2, vector};
/// use saltus_bounce::walls::{Face, Plane, Table, Walls};
/// let scene = (Plane::incline(0.1)?, Plane::wall(vector![-1.0, 0.0], 5.0)?);
/// assert_eq!(Walls::<2>::faces(&scene, 0), 2);
/// let to_the_wall = scene.margin(Face { cell: 0, index: 1 }, 0.0, &vector![3.0, 2.0]);
/// assert_eq!(to_the_wall, 2.0);
/// # Ok::<(), saltus_bounce::ParameterError>(())
/// ```
pub trait Walls<const N: usize> {
    /// The number of cells into which space is cut.
    fn cells(&self) -> usize {
        1
    }

    /// The number of faces of `cell`, at most [`MOST_FACES`].
    fn faces(&self, cell: usize) -> usize {
        let _ = cell;
        1
    }

    /// φ in m or any other unit: positive in the cell, zero on the face.
    fn margin(&self, face: Face, t: f64, p: &SVector<f64, N>) -> f64;

    /// ∂φ/∂p: along the normal into the cell; not zero on the face.
    fn gradient(&self, face: Face, t: f64, p: &SVector<f64, N>) -> SVector<f64, N>;

    /// ∂φ/∂t in 1/s times the unit of φ.
    fn rate(&self, face: Face, t: f64, p: &SVector<f64, N>) -> f64 {
        let _ = (face, t, p);
        0.0
    }

    /// d²φ/dt² of a point that passes p at the constant velocity `v`: vᵀ ∂²φ/∂p² v + 2 v·∂²φ/∂t∂p +
    /// ∂²φ/∂t².
    fn bend(&self, face: Face, t: f64, p: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        let _ = (face, t, p, v);
        0.0
    }

    /// Whether the face is a plane that stands still: φ = a·p + b.
    fn straight(&self, face: Face) -> bool {
        let _ = face;
        false
    }

    /// Whether the face as a whole moves with time only, φ = a·p - h(t): what lies on it is carried
    /// along.
    ///
    /// Answers h(t) - h(`from`), h'(t).
    fn carried(&self, face: Face, from: f64, t: f64) -> Option<(f64, f64)> {
        self.straight(face).then_some((0.0, 0.0)).filter(|_| from <= t)
    }

    /// The cell beyond the face at p, if the face is no wall there.
    fn leads(&self, face: Face, t: f64, p: &SVector<f64, N>) -> Option<usize> {
        let _ = (face, t, p);
        None
    }

    /// The first time after `t` at which a face changes its motion: where its derivatives jump.
    fn changes(&self, t: f64) -> Option<f64> {
        let _ = t;
        None
    }
}

/// The number of edges beside the faces that a contact may have: leave, stop and veer of
/// [`Stance::Yield`](crate::Stance::Yield).
const MOST_ENDS: usize = 3;

/// The most faces of a cell: with what may end a contact by itself, as many as a mode may have
/// edges that are collected; a [`Corner`](crate::Stance::Corner) has bits for more.
pub const MOST_FACES: usize = saltus::Edges::<()>::INLINE - MOST_ENDS;

/// The earlier of two times that may be none.
fn earlier(a: Option<f64>, b: Option<f64>) -> Option<f64> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        (a, b) => a.or(b),
    }
}

/// Nothing: a ball in free space.
impl<const N: usize> Walls<N> for () {
    fn faces(&self, _cell: usize) -> usize {
        0
    }
    fn margin(&self, _: Face, _: f64, _: &SVector<f64, N>) -> f64 {
        1.0
    }
    fn gradient(&self, _: Face, _: f64, _: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }
}

/// Runs `$do` with the member to which a face of a pair belongs, and that face there.
macro_rules! of_pair {
    ($pair:ident, $face:ident, $n:ident, $wall:ident, $at:ident, $do:expr) => {{
        let (first, second) = (&$pair.0, &$pair.1);
        let inner = Walls::<$n>::cells(second);
        let (a, b) = ($face.cell / inner, $face.cell % inner);
        let count = Walls::<$n>::faces(first, a);
        if $face.index < count {
            let ($wall, $at) = (first, Face { cell: a, index: $face.index });
            $do
        } else {
            let ($wall, $at) = (second, Face { cell: b, index: $face.index - count });
            $do
        }
    }};
}

/// Both walls. Cells are pairs of cells.
impl<const N: usize, A: Walls<N>, B: Walls<N>> Walls<N> for (A, B) {
    fn cells(&self) -> usize {
        self.0.cells() * self.1.cells()
    }
    fn faces(&self, cell: usize) -> usize {
        self.0.faces(cell / self.1.cells()) + self.1.faces(cell % self.1.cells())
    }
    #[inline]
    fn margin(&self, face: Face, t: f64, p: &SVector<f64, N>) -> f64 {
        of_pair!(self, face, N, wall, at, wall.margin(at, t, p))
    }
    #[inline]
    fn gradient(&self, face: Face, t: f64, p: &SVector<f64, N>) -> SVector<f64, N> {
        of_pair!(self, face, N, wall, at, wall.gradient(at, t, p))
    }
    #[inline]
    fn rate(&self, face: Face, t: f64, p: &SVector<f64, N>) -> f64 {
        of_pair!(self, face, N, wall, at, wall.rate(at, t, p))
    }
    #[inline]
    fn bend(&self, face: Face, t: f64, p: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        of_pair!(self, face, N, wall, at, wall.bend(at, t, p, v))
    }
    #[inline]
    fn straight(&self, face: Face) -> bool {
        of_pair!(self, face, N, wall, at, wall.straight(at))
    }
    fn carried(&self, face: Face, from: f64, t: f64) -> Option<(f64, f64)> {
        of_pair!(self, face, N, wall, at, wall.carried(at, from, t))
    }
    fn leads(&self, face: Face, t: f64, p: &SVector<f64, N>) -> Option<usize> {
        let inner = self.1.cells();
        let (a, b) = (face.cell / inner, face.cell % inner);
        let count = self.0.faces(a);
        if face.index < count {
            self.0.leads(Face { cell: a, index: face.index }, t, p).map(|cell| cell * inner + b)
        } else {
            self.1.leads(Face { cell: b, index: face.index - count }, t, p).map(|cell| a * inner + cell)
        }
    }
    fn changes(&self, t: f64) -> Option<f64> {
        earlier(self.0.changes(t), self.1.changes(t))
    }
}

macro_rules! list_of_walls {
    ($($list:tt)*) => {
        /// All of them: walls of one cell and one face each.
        impl<const N: usize, W: Walls<N>, $($list)* {
            fn faces(&self, _cell: usize) -> usize {
                self.len()
            }
            #[inline]
            fn margin(&self, face: Face, t: f64, p: &SVector<f64, N>) -> f64 {
                self[face.index].margin(Face::default(), t, p)
            }
            #[inline]
            fn gradient(&self, face: Face, t: f64, p: &SVector<f64, N>) -> SVector<f64, N> {
                self[face.index].gradient(Face::default(), t, p)
            }
            #[inline]
            fn rate(&self, face: Face, t: f64, p: &SVector<f64, N>) -> f64 {
                self[face.index].rate(Face::default(), t, p)
            }
            #[inline]
            fn bend(&self, face: Face, t: f64, p: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
                self[face.index].bend(Face::default(), t, p, v)
            }
            #[inline]
            fn straight(&self, face: Face) -> bool {
                self[face.index].straight(Face::default())
            }
            fn carried(&self, face: Face, from: f64, t: f64) -> Option<(f64, f64)> {
                self[face.index].carried(Face::default(), from, t)
            }
            fn changes(&self, t: f64) -> Option<f64> {
                self.iter().fold(None, |first, wall| earlier(first, wall.changes(t)))
            }
        }
    };
}

list_of_walls!(const M: usize> Walls<N> for [W; M]);
list_of_walls!(> Walls<N> for Vec<W>);
