//! The floors, walls and boxes of a scene as the walls of one ball, whose position is that of its
//! lowest point.

use nalgebra::{SVector, Vector2, Vector3};

use super::PlanError;
use super::curve::Curve;
use super::polyline::Polyline;
use crate::{Ball, Floor, Motion, Scene, Shape};
use saltus_bounce::walls::{Face, Lift, Plane, Stairs, Table, Walls};

/// A wall of a ball, in N coordinates.
#[derive(Clone, Debug)]
enum Wall<const N: usize> {
    Plane(Plane<N>),
    Curve(Curve),
    Table(Table),
    Schedule(Schedule),
}

/// The cells of space along x, with a piece of ground below each.
#[derive(Clone, Debug)]
enum Cells {
    Stairs(Stairs),
    Polyline(Polyline),
}

impl Cells {
    /// The cell over which x lies.
    fn cell(&self, x: f64) -> usize {
        match self {
            Self::Stairs(stairs) => stairs.cell(x),
            Self::Polyline(polyline) => polyline.cell(x),
        }
    }
}

/// Runs `$do` with what the cells are made by.
macro_rules! of_cells {
    ($self:ident, $ground:ident, $do:expr) => {
        match $self {
            Self::Stairs($ground) => $do,
            Self::Polyline($ground) => $do,
        }
    };
}

impl Walls<2> for Cells {
    fn cells(&self) -> usize {
        of_cells!(self, ground, ground.cells())
    }
    fn faces(&self, cell: usize) -> usize {
        of_cells!(self, ground, ground.faces(cell))
    }
    #[inline]
    fn margin(&self, face: Face, t: f64, p: &Vector2<f64>) -> f64 {
        of_cells!(self, ground, ground.margin(face, t, p))
    }
    #[inline]
    fn gradient(&self, face: Face, t: f64, p: &Vector2<f64>) -> Vector2<f64> {
        of_cells!(self, ground, ground.gradient(face, t, p))
    }
    #[inline]
    fn bend(&self, face: Face, t: f64, p: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        of_cells!(self, ground, ground.bend(face, t, p, v))
    }
    #[inline]
    fn straight(&self, face: Face) -> bool {
        of_cells!(self, ground, ground.straight(face))
    }
    fn leads(&self, face: Face, t: f64, p: &Vector2<f64>) -> Option<usize> {
        of_cells!(self, ground, ground.leads(face, t, p))
    }
}

/// All that bounds where a ball is: walls of one face each, and at most one ground that cuts space
/// into cells.
#[derive(Clone, Debug)]
pub(super) struct Surroundings<const N: usize> {
    walls: Vec<Wall<N>>,
    cells: Option<Cells>,
    /// The floor of the scene that `cells` are of.
    cut: usize,
    /// The floor of the scene that a face belongs to, counted from 0.
    owners: Vec<usize>,
}

/// The walls of `ball` in `scene`.
pub(super) fn surroundings<const N: usize>(scene: &Scene, ball: &Ball) -> Result<Surroundings<N>, PlanError> {
    let mut all = Surroundings { walls: Vec::new(), cells: None, cut: 0, owners: Vec::new() };
    for (owner, floor) in scene.floors.iter().enumerate() {
        all.add(owner, floor, ball, scene)?;
    }
    if all.cells.is_some() {
        all.owners.push(all.cut);
    }
    Ok(all)
}

/// x and up.
fn upright<const N: usize>(p: &SVector<f64, N>) -> Vector2<f64> {
    Vector2::new(if N > 1 { p[0] } else { 0.0 }, p[N - 1])
}

fn lifted<const N: usize>(v: &Vector2<f64>) -> SVector<f64, N> {
    let mut lifted = SVector::zeros();
    lifted[0] = v[0];
    lifted[N - 1] = v[1];
    lifted
}

/// The surroundings of a ball in any number of coordinates, in terms of (x, y, up).
pub(super) trait Around: Send + Sync {
    fn coordinates(&self) -> usize;
    /// Every face of the first cell.
    fn first(&self) -> Vec<Face>;
    /// The floor of the scene that a face belongs to.
    fn owner(&self, face: Face) -> usize;
    /// The unit normal of a face where the ball is, and how fast the face moves along it; `None`
    /// where it is the passage into the next cell.
    fn met(&self, face: Face, t: f64, p: &[f64]) -> Option<(Vector3<f64>, f64)>;
}

impl<const N: usize> Around for Surroundings<N> {
    fn coordinates(&self) -> usize {
        N
    }
    fn first(&self) -> Vec<Face> {
        self.all(0).collect()
    }
    fn owner(&self, face: Face) -> usize {
        self.owner(face)
    }
    fn met(&self, face: Face, t: f64, p: &[f64]) -> Option<(Vector3<f64>, f64)> {
        let p = SVector::from_column_slice(&p[..N]);
        if self.leads(face, t, &p).is_some() {
            return None;
        }
        let gradient = self.gradient(face, t, &p);
        let length = gradient.norm();
        Some((spread((gradient / length).as_slice()), -self.rate(face, t, &p) / length))
    }
}

/// Coordinates, the last of which points up, as (x, y, up).
#[inline]
pub(super) fn spread(v: &[f64]) -> Vector3<f64> {
    match *v {
        [x, y, up] => Vector3::new(x, y, up),
        [x, up] => Vector3::new(x, 0.0, up),
        [up] => Vector3::new(0.0, 0.0, up),
        _ => Vector3::zeros(),
    }
}

impl<const N: usize> Surroundings<N> {
    /// The floor of the scene that a face belongs to.
    pub(super) fn owner(&self, face: Face) -> usize {
        self.owners.get(face.index.min(self.walls.len())).copied().unwrap_or(0)
    }

    /// The cell in which a ball at `p` starts.
    pub(super) fn cell(&self, p: &SVector<f64, N>) -> usize {
        self.cells.as_ref().map_or(0, |cells| cells.cell(p[0]))
    }

    /// The floor of the scene that each face belongs to, by index, as many as any cell has.
    pub(super) fn owners(&self) -> Vec<usize> {
        let most = (0..Walls::cells(self)).map(|cell| self.faces(cell)).max().unwrap_or(0);
        (0..most).map(|index| self.owner(Face { cell: 0, index })).collect()
    }

    /// Every face of a cell.
    pub(super) fn all(&self, cell: usize) -> impl Iterator<Item = Face> {
        (0..self.faces(cell)).map(move |index| Face { cell, index })
    }

    /// Adds the ground that cuts space into cells.
    fn cut(&mut self, owner: usize, cells: Cells) -> Result<(), PlanError> {
        if let Some(cut) = &self.cells {
            let says = match (cut, cells) {
                (Cells::Stairs(_), Cells::Stairs(_)) => "there are stairs already: keep one flight of them",
                _ => "there are stairs or a polyline already: keep one of them",
            };
            return Err(PlanError::floor(owner, says));
        }
        (self.cells, self.cut) = (Some(cells), owner);
        Ok(())
    }

    fn add(&mut self, owner: usize, floor: &Floor, ball: &Ball, scene: &Scene) -> Result<(), PlanError> {
        let radius = ball.radius.unwrap_or(0.0);
        let refused = |error: saltus_bounce::ParameterError| PlanError::floor(owner, &error.to_string());
        // A plane that the centre keeps a radius away from, in terms of the lowest point.
        let plane = |normal: [f64; 3], offset: f64| {
            let mut n = SVector::<f64, N>::zeros();
            n[N - 1] = normal[2];
            if N > 1 {
                n[0] = normal[0];
            }
            if N > 2 {
                n[1] = normal[1];
            }
            Plane::wall(n, offset - radius * (1.0 - normal[2])).map(Wall::Plane).map_err(refused)
        };
        let mut push = |wall: Wall<N>| {
            self.walls.push(wall);
            self.owners.push(owner);
        };
        match floor.shape {
            Shape::Level { height } => match &floor.motion {
                None => push(plane([0.0, 0.0, 1.0], -height)?),
                Some(Motion::Sine { amplitude, frequency, phase }) => {
                    let table = Table::new(*amplitude, std::f64::consts::TAU * frequency);
                    push(Wall::Table(table.and_then(|table| table.shifted(*phase, height)).map_err(refused)?));
                }
                Some(Motion::Schedule(points)) => push(Wall::Schedule(Schedule::new(height, points).map_err(refused)?)),
            },
            Shape::Incline { angle, height } => push(plane([-angle.sin(), 0.0, angle.cos()], -height * angle.cos())?),
            Shape::Wall { across_y, at, faces_up } => {
                let side = if faces_up { 1.0 } else { -1.0 };
                let normal = if across_y { [0.0, side, 0.0] } else { [side, 0.0, 0.0] };
                push(plane(normal, -side * at)?);
            }
            Shape::Box { size, height, open } => {
                push(plane([0.0, 0.0, 1.0], -height)?);
                if !open {
                    push(plane([0.0, 0.0, -1.0], height + size.z)?);
                }
                for side in [1.0, -1.0] {
                    push(plane([side, 0.0, 0.0], 0.5 * size.x)?);
                    // A box in the plane has no depth.
                    if N > 2 && size.y > 0.0 {
                        push(plane([0.0, side, 0.0], 0.5 * size.y)?);
                    }
                }
            }
            Shape::Parabola { .. } | Shape::Sine { .. } => {
                let curve = Curve::of(floor.shape.clone(), radius);
                push(Wall::Curve(curve.map_err(|says| PlanError::floor(owner, &says))?));
            }
            Shape::Stairs { top, from, tread, rise, count } => {
                self.cut(owner, Cells::Stairs(stairs([top, from, tread, rise], count, ball, scene, owner)?))?;
            }
            Shape::Polyline { ref points } => {
                let polyline = Polyline::new(points, radius).map_err(|says| PlanError::floor(owner, &says))?;
                self.cut(owner, Cells::Polyline(polyline))?;
            }
        }
        Ok(())
    }
}

/// The steps of stairs: all of them, or, where they do not end, as many as a run can reach: each
/// takes a jump.
fn stairs(
    [top, from, tread, rise]: [f64; 4],
    count: Option<u32>,
    ball: &Ball,
    scene: &Scene,
    owner: usize,
) -> Result<Stairs, PlanError> {
    const MOST: u32 = 1_000_000;
    let first = ((ball.lowest().x - from) / tread).max(0.0);
    let jumps = scene.run.most_jumps.unwrap_or(super::MOST_JUMPS);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // saturates, and is refused below
    let reached = (first as u32).saturating_add(jumps).saturating_add(2);
    let count = count.unwrap_or(u32::MAX).min(reached);
    if count > MOST {
        let says = format!(
            "the ball could go down {count} steps, which is more than {MOST}: give the stairs fewer, by `count`"
        );
        return Err(PlanError::floor(owner, &says));
    }
    let edges = (0..count).map(|k| from + f64::from(k) * tread).collect();
    let treads = (0..=count).map(|k| top - f64::from(k) * rise).collect();
    Stairs::new(edges, treads).map_err(|error| PlanError::floor(owner, &error.to_string()))
}

/// Runs `$do` with the wall a face is of.
macro_rules! of_wall {
    ($self:ident, $face:ident, $none:expr, $wall:ident, $at:ident, $flat:expr, $curved:expr) => {
        match $self.walls.get($face.index) {
            Some(Wall::Plane($wall)) => {
                let $at = Face::default();
                $flat
            }
            Some(Wall::Table($wall)) => {
                let $at = Face::default();
                $flat
            }
            Some(Wall::Schedule($wall)) => {
                let $at = Face::default();
                $flat
            }
            Some(Wall::Curve($wall)) => {
                let $at = Face::default();
                $curved
            }
            None => {
                let Some($wall) = &$self.cells else { return $none };
                let $at = Face { cell: $face.cell, index: $face.index - $self.walls.len() };
                $curved
            }
        }
    };
}

impl<const N: usize> Walls<N> for Surroundings<N> {
    fn cells(&self) -> usize {
        self.cells.as_ref().map_or(1, Walls::cells)
    }
    #[inline]
    fn faces(&self, cell: usize) -> usize {
        self.walls.len() + self.cells.as_ref().map_or(0, |cells| cells.faces(cell))
    }
    #[inline]
    fn margin(&self, face: Face, t: f64, p: &SVector<f64, N>) -> f64 {
        of_wall!(self, face, 1.0, wall, at, wall.margin(at, t, p), wall.margin(at, t, &upright(p)))
    }
    #[inline]
    fn gradient(&self, face: Face, t: f64, p: &SVector<f64, N>) -> SVector<f64, N> {
        of_wall!(
            self,
            face,
            SVector::zeros(),
            wall,
            at,
            wall.gradient(at, t, p),
            lifted(&wall.gradient(at, t, &upright(p)))
        )
    }
    #[inline]
    fn rate(&self, face: Face, t: f64, p: &SVector<f64, N>) -> f64 {
        of_wall!(self, face, 0.0, wall, at, wall.rate(at, t, p), wall.rate(at, t, &upright(p)))
    }
    #[inline]
    fn bend(&self, face: Face, t: f64, p: &SVector<f64, N>, v: &SVector<f64, N>) -> f64 {
        of_wall!(self, face, 0.0, wall, at, wall.bend(at, t, p, v), wall.bend(at, t, &upright(p), &upright(v)))
    }
    #[inline]
    fn straight(&self, face: Face) -> bool {
        of_wall!(self, face, true, wall, at, Walls::<N>::straight(wall, at), Walls::<2>::straight(wall, at))
    }
    fn carried(&self, face: Face, from: f64, t: f64) -> Option<(f64, f64)> {
        of_wall!(
            self,
            face,
            None,
            wall,
            at,
            Walls::<N>::carried(wall, at, from, t),
            Walls::<2>::carried(wall, at, from, t)
        )
    }
    fn leads(&self, face: Face, t: f64, p: &SVector<f64, N>) -> Option<usize> {
        of_wall!(self, face, None, wall, at, wall.leads(at, t, p), wall.leads(at, t, &upright(p)))
    }
    fn changes(&self, t: f64) -> Option<f64> {
        let changes = self.walls.iter().filter_map(|wall| match wall {
            Wall::Schedule(wall) => Walls::<N>::changes(wall, t),
            _ => None,
        });
        changes.min_by(f64::total_cmp)
    }
}

/// A level floor that moves at a constant velocity from each point of a schedule to the next, and
/// stands before and after them.
#[derive(Clone, Debug)]
struct Schedule {
    /// One stretch of constant velocity each.
    stretches: Vec<(f64, Lift)>,
}

impl Schedule {
    fn new(mean: f64, points: &[[f64; 2]]) -> Result<Self, saltus_bounce::ParameterError> {
        let first = points.first().map_or(0.0, |point| point[1]);
        let mut stretches = vec![(f64::NEG_INFINITY, Lift::new(mean + first, 0.0, &[])?)];
        for (n, [t, height]) in points.iter().enumerate() {
            let speed = points.get(n + 1).map_or(0.0, |next| (next[1] - height) / (next[0] - t));
            stretches.push((*t, Lift::new(mean + height, speed, &[(*t, 0.0)])?));
        }
        Ok(Self { stretches })
    }

    fn at(&self, t: f64) -> &Lift {
        let n = self.stretches.partition_point(|stretch| stretch.0 <= t).max(1);
        &self.stretches[n - 1].1
    }
}

impl<const N: usize> Walls<N> for Schedule {
    fn margin(&self, face: Face, t: f64, p: &SVector<f64, N>) -> f64 {
        self.at(t).margin(face, t, p)
    }
    fn gradient(&self, face: Face, t: f64, p: &SVector<f64, N>) -> SVector<f64, N> {
        self.at(t).gradient(face, t, p)
    }
    fn rate(&self, face: Face, t: f64, p: &SVector<f64, N>) -> f64 {
        self.at(t).rate(face, t, p)
    }
    /// The ride on the stretch that holds at `from`: it ends where the schedule changes.
    fn carried(&self, face: Face, from: f64, t: f64) -> Option<(f64, f64)> {
        Walls::<N>::carried(self.at(from), face, from, t)
    }
    fn changes(&self, t: f64) -> Option<f64> {
        self.stretches.iter().map(|stretch| stretch.0).find(|&from| from > t)
    }
}
