//! Where the unknowns of a recording stand: time and speed of the first impact, the floor, gravity,
//! then drag if there is any.

pub(crate) const TIME: usize = 0;
pub(crate) const SPEED: usize = 1;
pub(crate) const FLOOR: usize = 2;
pub(crate) const GRAVITY: usize = 3;
pub(super) const DRAG: usize = 4;
