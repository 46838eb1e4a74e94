//! Ground that goes straight from point to point, as the lowest point of a ball of some radius
//! meets it.

use nalgebra::{SVector, Vector2};
use saltus_bounce::walls::{Face, Plane, Round, Walls};

use crate::error::short;

/// A stretch of x with one kind of ground for the lowest point of the ball.
#[derive(Clone, Debug)]
enum Piece {
    /// Straight sides with inward corners between them, each a radius away from the centre: what is
    /// above all of them is above the ground.
    Sides(Vec<Plane<2>>),
    /// An outward corner, which the ball rolls around.
    Corner(Round<2>),
}

/// A polyline, and the radius of the ball on it.
///
/// The centre keeps a radius R away from the ground: over a side with the unit normal n it is on
/// the side moved by R n, over an outward corner on a circle about it, from R n of one side to R n'
/// of the next; what the lowest point meets is a radius below. Outward corners cut space along x
/// into cells, between which everything passes. Within a cell the ground is hollow, and its sides
/// are walls that all hold: a ball that slides into an inward corner meets the next side there, and
/// may come to rest between two.
#[derive(Clone, Debug)]
pub(super) struct Polyline {
    /// The ends of the cells, rising.
    edges: Vec<f64>,
    /// One more than edges.
    pieces: Vec<Piece>,
}

impl Polyline {
    /// The ground through two points or more, by increasing x.
    pub(super) fn new(points: &[[f64; 2]], radius: f64) -> Result<Self, String> {
        let points: Vec<Vector2<f64>> = points.iter().map(|&point| point.into()).collect();
        let normal = |pair: &[Vector2<f64>]| {
            let along = (pair[1] - pair[0]).normalize();
            Vector2::new(-along.y, along.x)
        };
        let normals: Vec<Vector2<f64>> = points.windows(2).map(normal).collect();
        let up = Vector2::new(0.0, radius);
        let side = |k: usize| {
            Plane::through(points[k] + normals[k] * radius - up, normals[k]).map_err(|error| error.to_string())
        };
        let (mut edges, mut pieces, mut sides) = (Vec::new(), Vec::new(), vec![side(0)?]);
        // Where the last corner is met, which has to be before the next: else the ball is too large
        // for what lies between.
        let mut last = f64::NEG_INFINITY;
        for k in 1..normals.len() {
            let (corner, n, next) = (points[k], normals[k - 1], normals[k]);
            // The ground falls away: the normal turns towards positive x.
            let outward = next.x > n.x;
            let ends = if outward {
                [corner.x + radius * n.x, corner.x + radius * next.x]
            } else {
                // The two moved sides meet there.
                [corner.x + radius * (n.x + next.x) / (1.0 + n.dot(&next)); 2]
            };
            if ends[0] <= last {
                return Err(format!(
                    "the ball's radius of {radius} m does not fit between two corners near x = {} m: make it smaller or them farther apart",
                    short(points[k].x)
                ));
            }
            last = ends[1];
            if outward {
                pieces.push(Piece::Sides(std::mem::take(&mut sides)));
                edges.push(ends[0]);
                if radius > 0.0 {
                    let round = Round::obstacle(corner - up, radius).map_err(|error| error.to_string())?;
                    pieces.push(Piece::Corner(round));
                    edges.push(ends[1]);
                }
            }
            sides.push(side(k)?);
        }
        pieces.push(Piece::Sides(sides));
        Ok(Self { edges, pieces })
    }

    /// The cell over which x lies.
    pub(super) fn cell(&self, x: f64) -> usize {
        self.edges.partition_point(|&edge| edge <= x)
    }

    /// The number of faces of a cell that are ground.
    fn grounds(&self, cell: usize) -> usize {
        match &self.pieces[cell] {
            Piece::Sides(sides) => sides.len(),
            Piece::Corner(_) => 1,
        }
    }

    /// The end of a cell that a face is: the left one is behind the ground, and the right one
    /// behind that.
    fn end(&self, Face { cell, index }: Face) -> Option<bool> {
        index.checked_sub(self.grounds(cell)).map(|end| end > 0)
    }
}

/// A cell's faces: its ground, its left end, its right end.
impl Walls<2> for Polyline {
    fn cells(&self) -> usize {
        self.pieces.len()
    }
    fn faces(&self, cell: usize) -> usize {
        self.grounds(cell) + 2
    }
    #[inline]
    fn margin(&self, face: Face, t: f64, p: &Vector2<f64>) -> f64 {
        match (self.end(face), &self.pieces[face.cell]) {
            (None, Piece::Sides(sides)) => sides[face.index].margin(Face::default(), t, p),
            (None, Piece::Corner(round)) => round.margin(Face::default(), t, p),
            (Some(false), _) if face.cell > 0 => p[0] - self.edges[face.cell - 1],
            (Some(true), _) if face.cell < self.edges.len() => self.edges[face.cell] - p[0],
            _ => 1.0, // the outer sides go on for ever
        }
    }
    #[inline]
    fn gradient(&self, face: Face, t: f64, p: &Vector2<f64>) -> SVector<f64, 2> {
        match (self.end(face), &self.pieces[face.cell]) {
            (None, Piece::Sides(sides)) => sides[face.index].gradient(Face::default(), t, p),
            (None, Piece::Corner(round)) => round.gradient(Face::default(), t, p),
            (Some(right), _) => Vector2::new(if right { -1.0 } else { 1.0 }, 0.0),
        }
    }
    #[inline]
    fn bend(&self, face: Face, t: f64, p: &Vector2<f64>, v: &Vector2<f64>) -> f64 {
        match (self.end(face), &self.pieces[face.cell]) {
            (None, Piece::Corner(round)) => round.bend(Face::default(), t, p, v),
            _ => 0.0,
        }
    }
    #[inline]
    fn straight(&self, face: Face) -> bool {
        self.end(face).is_some() || matches!(self.pieces[face.cell], Piece::Sides(_))
    }
    fn leads(&self, face: Face, _: f64, _: &Vector2<f64>) -> Option<usize> {
        match self.end(face)? {
            false => face.cell.checked_sub(1),
            true => Some(face.cell + 1).filter(|&next| next < self.pieces.len()),
        }
    }
}
