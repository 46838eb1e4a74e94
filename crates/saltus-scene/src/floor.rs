//! The floors, walls and boxes of a scene.

use std::sync::Arc;

use nalgebra::Vector3;
#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::error::Fault;
use super::kinds::kinds;
use super::motion::{Motion, MotionTable};
use super::restitution::{self, FrictionTable, RestitutionTable, Said};
use super::space::Space;
use super::value::{Angle, At, Length, Measure, OneOrMany, Pairs, PerLength, Real, Short};
use saltus_bounce::friction::Friction;

/// A floor, a wall or a box. Lengths in m, angles in rad.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Floor {
    /// The name.
    pub name: Option<String>,
    /// The material, as the presets call it.
    pub material: Option<String>,
    /// The shape.
    pub shape: Shape,
    /// The motion of a level floor; `None` if it stands.
    pub motion: Option<Motion>,
    /// The friction, or that of the scene.
    pub friction: Friction,
}

/// The shape of a floor, and its place.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Shape {
    /// A level floor.
    Level {
        /// The height in m.
        height: f64,
    },
    /// A plane that rises towards x.
    Incline {
        /// The angle above the horizontal, in rad.
        angle: f64,
        /// The height at x = 0, in m.
        height: f64,
    },
    /// Stairs down towards x.
    Stairs {
        /// The height of the top step in m.
        top: f64,
        /// The place of the first edge, in m along x.
        from: f64,
        /// The depth of a step in m.
        tread: f64,
        /// The height of a step in m.
        rise: f64,
        /// The number of steps down; `None` for no end of them.
        count: Option<u32>,
    },
    /// An upright wall.
    Wall {
        /// Whether it stands across y instead of x.
        across_y: bool,
        /// The place along its axis, in m.
        at: f64,
        /// Whether the balls are on the side where the coordinate is greater.
        faces_up: bool,
    },
    /// The inside of a box, its middle at x = y = 0, its bottom at `height`.
    Box {
        /// The size (x, y, up) in m; y is 0 in a planar scene.
        size: Vector3<f64>,
        /// The height of its bottom in m.
        height: f64,
        /// Whether it has no lid.
        open: bool,
    },
    /// A parabola, height + (curvature/2) (x - centre)².
    Parabola {
        /// The curvature in 1/m: hollow above zero, a hill below.
        curvature: f64,
        /// The place of the vertex along x, in m.
        centre: f64,
        /// The height of the vertex in m.
        height: f64,
    },
    /// A sine, height + amplitude sin(2πx/wavelength + phase).
    Sine {
        /// The amplitude in m.
        amplitude: f64,
        /// The wavelength in m.
        wavelength: f64,
        /// The phase at x = 0, in rad.
        phase: f64,
        /// The mean height in m.
        height: f64,
    },
    /// A polyline, which goes straight on beyond the first and the last point.
    Polyline {
        /// The points (x, height) in m, two or more, by increasing x.
        points: Arc<[[f64; 2]]>,
    },
}

kinds! {
    /// The shapes.
    enum Kind of FloorTable by "kind", none "a level floor" { height, motion } {
        Level = "level", "Level:" { height, motion }
        Incline = "incline", "A plane that rises towards x:" { angle, height }
        Stairs = "stairs", "Stairs down towards x:" { height, from, tread, rise, count }
        Wall = "wall", "An upright wall:" { at, axis }
        Box = "box", "The inside of a box about x = y = 0:" { size, height, open }
        Parabola = "parabola", "height + (curvature/2) (x - centre)²:" { curvature, centre, height }
        Sine = "sine", "height + amplitude sin(2πx/wavelength + phase):" { amplitude, wavelength, phase, height }
        Polyline = "polyline", "Straight from point to point, and on beyond the first and the last:" { points }
    }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(test, schemars(inline))]
enum Axis {
    /// Across x.
    X,
    /// Across y.
    Y,
}

/// A floor, a wall or a box.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "floor"))]
pub(super) struct FloorTable {
    /// What to call it.
    name: Option<String>,
    /// What it is made of, as the table of materials calls it, such as "granite".
    pub(super) material: Option<At<String>>,
    /// The shape: "level" unless given.
    kind: Option<At<Kind>>,
    /// Its height: of a level floor, of an incline at x = 0, of the top step, of a box's bottom, of
    /// a curve's middle; 0 unless given.
    height: Option<At<Measure<Length>>>,
    /// Of an incline: above the horizontal, rising towards x.
    angle: Option<At<Measure<Angle>>>,
    /// Of stairs: where the first edge is along x; 0 unless given.
    from: Option<At<Measure<Length>>>,
    /// Of stairs: the depth of a step.
    tread: Option<At<Measure<Length>>>,
    /// Of stairs: the height of a step.
    rise: Option<At<Measure<Length>>>,
    /// Of stairs: how many steps go down; no end of them unless given.
    count: Option<At<u32>>,
    /// Of a wall: where it stands; it faces the first ball.
    at: Option<At<Measure<Length>>>,
    /// Of a wall: the axis it stands across, "x" unless given.
    axis: Option<At<Axis>>,
    /// Of a box: its inside, [x, up] or [x, y, up].
    size: Option<At<OneOrMany<Measure<Length>>>>,
    /// Of a box: without a lid; false unless given.
    open: Option<At<bool>>,
    /// Of a parabola: hollow above zero, a hill below.
    curvature: Option<At<Measure<PerLength>>>,
    /// Of a parabola: where its lowest or highest point is along x; 0 unless given.
    centre: Option<At<Measure<Length>>>,
    /// Of a sine: the height of its waves above the middle.
    amplitude: Option<At<Measure<Length>>>,
    /// Of a sine: from wave to wave.
    wavelength: Option<At<Measure<Length>>>,
    /// Of a sine: its phase at x = 0; 0 unless given.
    phase: Option<At<Measure<Angle>>>,
    /// Of a polyline: pairs of a place along x and the height there, by increasing x.
    points: Option<At<Pairs<Measure<Length>, Measure<Length>>>>,
    /// Of a level floor: how it moves; it stands unless given.
    motion: Option<At<MotionTable>>,
    /// Restitution on this floor, instead of the scene's.
    restitution: Option<At<Short<RestitutionTable>>>,
    /// Friction on this floor, instead of the scene's.
    friction: Option<At<Short<FrictionTable>>>,
}

impl FloorTable {
    fn kind(&self) -> Kind {
        self.kind.as_ref().map_or(Kind::Level, |at| *at.get())
    }

    /// Notes the number of coordinates that the floor needs in the space.
    pub(super) fn look(&self, space: &mut Space) -> Result<(), Fault> {
        if let Some(at) = self.axis.as_ref().filter(|axis| *axis.get() == Axis::Y && space.dimensions() < 3) {
            let says = "a scene in a plane has no y: write the vectors of the scene with three components, [x, y, up]";
            return Err(at.fault(says));
        }
        if self.kind() != Kind::Level {
            space.sideways();
        }
        space.vector("size", self.size.as_ref())
    }

    /// The place of the kind, or of something else of the floor.
    pub(super) fn place(&self) -> Option<std::ops::Range<usize>> {
        let keys = [
            self.kind.as_ref().map(At::span),
            self.height.as_ref().map(At::span),
            self.material.as_ref().map(At::span),
        ];
        keys.into_iter().flatten().next()
    }

    /// The floor and its restitution; `first` is where the first ball starts.
    pub(super) fn read(
        &self,
        space: &Space,
        first: Vector3<f64>,
        friction: Friction,
        whole: &std::ops::Range<usize>,
    ) -> Result<(Floor, Option<Said>), Fault> {
        let kind = self.kind();
        let height = self.height.as_ref().map_or(0.0, At::real);
        let place = self.place().unwrap_or_else(|| whole.clone());
        self.only(self.kind.as_ref().map(|at| *at.get()))?;
        let missing = |says: &str| Fault::new(place.clone(), says);
        let shape = match kind {
            Kind::Level => Shape::Level { height },
            Kind::Incline => {
                let at = self
                    .angle
                    .as_ref()
                    .ok_or_else(|| missing("the incline has no angle: give `angle = \"30 deg\"`"))?;
                let angle = at.real();
                if angle.abs() >= std::f64::consts::FRAC_PI_2 {
                    return Err(at.fault("the incline is upright or beyond: give an angle between -90 deg and 90 deg, or `kind = \"wall\"`"));
                }
                Shape::Incline { angle, height }
            }
            Kind::Stairs => {
                let (Some(tread), Some(rise)) = (&self.tread, &self.rise) else {
                    return Err(missing("the stairs have no measure: give `tread = \"30 cm\"` and `rise = \"17 cm\"`"));
                };
                Shape::Stairs {
                    top: height,
                    from: self.from.as_ref().map_or(0.0, At::real),
                    tread: tread.positive("the depth of a step in m")?,
                    rise: rise.positive("the height of a step in m")?,
                    count: self.count.as_ref().map(|at| *at.get()),
                }
            }
            Kind::Wall => {
                let at = self.at.as_ref().ok_or_else(|| missing("the wall has no place: give `at = \"2 m\"`"))?;
                let across_y = self.axis.as_ref().is_some_and(|axis| *axis.get() == Axis::Y);
                let ball = if across_y { first.y } else { first.x };
                if ball == at.real() {
                    return Err(at.fault("the ball starts in the wall: move one of them"));
                }
                Shape::Wall { across_y, at: at.real(), faces_up: ball > at.real() }
            }
            Kind::Box => {
                let at = self.size.as_ref().ok_or_else(|| {
                    missing("the box has no size: give `size = [\"1 m\", \"1 m\"]`, or three lengths in space")
                })?;
                if at.get().as_slice().len() != space.dimensions() {
                    return Err(at.fault(format!(
                        "the box needs {} lengths: write one for each coordinate, such as `size = [{}]`",
                        space.dimensions(),
                        vec!["\"1 m\""; space.dimensions()].join(", ")
                    )));
                }
                if let Some(bad) = at.get().as_slice().iter().find(|side| side.real() <= 0.0) {
                    return Err(
                        at.fault(format!("{} is no length of a side in m: give numbers above zero", bad.real()))
                    );
                }
                Shape::Box { size: space.read(at), height, open: self.open.as_ref().is_some_and(|open| *open.get()) }
            }
            Kind::Parabola => {
                let at = self
                    .curvature
                    .as_ref()
                    .ok_or_else(|| missing("the parabola has no curvature: give `curvature = \"0.5 /m\"`"))?;
                Shape::Parabola { curvature: at.real(), centre: self.centre.as_ref().map_or(0.0, At::real), height }
            }
            Kind::Sine => {
                let (Some(amplitude), Some(wavelength)) = (&self.amplitude, &self.wavelength) else {
                    return Err(missing(
                        "the waves have no measure: give `amplitude = \"10 cm\"` and `wavelength = \"1 m\"`",
                    ));
                };
                Shape::Sine {
                    amplitude: amplitude.not_negative("an amplitude in m")?,
                    wavelength: wavelength.positive("a wavelength in m")?,
                    phase: self.phase.as_ref().map_or(0.0, At::real),
                    height,
                }
            }
            Kind::Polyline => {
                let at = self.points.as_ref().ok_or_else(|| {
                    missing("the polyline has no points: give `points = [[\"0 m\", \"0 m\"], [\"1 m\", \"20 cm\"]]`")
                })?;
                Shape::Polyline { points: polyline(at)? }
            }
        };
        let motion = self.motion.as_ref().map(|at| at.get().read(at)).transpose()?;
        let friction = self.friction.as_ref().map_or(Ok(friction), restitution::friction)?;
        let said = self.restitution.as_ref().map(restitution::said).transpose()?;
        let material = self.material.as_ref().map(|at| at.get().clone());
        Ok((Floor { name: self.name.clone(), material, shape, motion, friction }, said))
    }
}

/// The points of a polyline, which go on along x.
fn polyline(at: &At<Pairs<Measure<Length>, Measure<Length>>>) -> Result<Arc<[[f64; 2]]>, Fault> {
    let points: Vec<[f64; 2]> = at.get().iter().map(|(x, height)| [x.real(), height.real()]).collect();
    if points.len() < 2 {
        return Err(at.fault("a polyline has two points or more: give [[x, height], ...], such as [[\"0 m\", \"0 m\"], [\"1 m\", \"20 cm\"]]"));
    }
    match points.windows(2).find(|pair| pair[1][0] <= pair[0][0]) {
        Some(pair) => Err(at.fault(format!(
            "the polyline has x = {} m after {} m: sort its points by x, each place once",
            pair[1][0], pair[0][0]
        ))),
        None => Ok(points.into()),
    }
}
