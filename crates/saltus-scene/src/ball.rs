//! The balls of a scene: what they are and how they start.

use nalgebra::Vector3;
#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::error::Fault;
use super::space::Space;
use super::value::{AngularSpeed, At, Length, Mass, Measure, Number, OneOrMany, Real, Speed};
use saltus_bounce::Sphere;

/// A ball and its start. Vectors are (x, y, up) in m, m/s and rad/s; what a scene does not name is
/// zero.
///
/// ```
/// use saltus_scene::Scene;
/// let scene = Scene::parse("drop.toml", b"restitution = 0.8\n[ball]\nheight = '1 m'\nradius = '2 cm'\n")?;
/// assert_eq!((scene.balls[0].lowest().z, scene.balls[0].centre().z), (1.0, 1.02));
/// # Ok::<(), saltus_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Ball {
    /// The name.
    pub name: Option<String>,
    /// The material, as the presets call it.
    pub material: Option<String>,
    /// The radius in m; `None` for a point.
    pub radius: Option<f64>,
    /// The mass in kg.
    pub mass: Option<f64>,
    /// The moment of inertia over m R²: 2/5 unless given.
    pub inertia: f64,
    /// The place of the start.
    pub start: Start,
    /// The velocity in m/s.
    pub velocity: Vector3<f64>,
    /// The spin in rad/s, by the right-hand rule; in a planar scene only -y turns. `None` where the
    /// scene names no spin.
    pub spin: Option<Vector3<f64>>,
}

/// The place where a ball starts, in m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// The place of its lowest point.
    Lowest(Vector3<f64>),
    /// The place of its centre.
    Centre(Vector3<f64>),
}

impl Ball {
    fn up(&self) -> Vector3<f64> {
        Vector3::new(0.0, 0.0, self.radius.unwrap_or(0.0))
    }

    /// The place where its lowest point starts, in m.
    #[must_use]
    pub fn lowest(&self) -> Vector3<f64> {
        match self.start {
            Start::Lowest(at) => at,
            Start::Centre(at) => at - self.up(),
        }
    }

    /// The place where its centre starts, in m.
    #[must_use]
    pub fn centre(&self) -> Vector3<f64> {
        match self.start {
            Start::Lowest(at) => at + self.up(),
            Start::Centre(at) => at,
        }
    }

    /// The ball as a body, if it has a radius and a mass.
    #[must_use]
    pub fn sphere(&self) -> Option<Sphere> {
        Sphere::with_inertia(self.radius?, self.mass?, self.inertia).ok()
    }

    /// The spin of a planar scene in rad/s, positive from x towards up.
    #[must_use]
    pub fn planar_spin(&self) -> Option<f64> {
        self.spin.map(|spin| 0.0 - spin.y)
    }
}

/// Where the mass of a ball sits.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[cfg_attr(test, schemars(inline))]
enum Kind {
    /// All through: I = 2/5 m R².
    Solid,
    /// In a thin shell: I = 2/3 m R².
    Hollow,
}

/// A ball: what it is and how it starts.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "ball"))]
pub(super) struct BallTable {
    /// What to call it.
    name: Option<String>,
    /// What it is, as the table of materials calls it, such as "tennis ball".
    pub(super) material: Option<At<String>>,
    /// Its radius; a point unless given.
    pub(super) radius: Option<At<Measure<Length>>>,
    /// Its diameter, instead of the radius.
    diameter: Option<At<Measure<Length>>>,
    /// Its mass; needed by buoyancy, lift, drag with a coefficient, contact that takes time, and
    /// several balls.
    mass: Option<At<Measure<Mass>>>,
    /// Where the mass sits: "solid" unless given.
    shape: Option<At<Kind>>,
    /// I/(m R²) instead of `shape`: above 0, up to 2/3.
    inertia: Option<At<Number>>,
    /// The height its lowest point starts at, above x = 0.
    height: Option<At<Measure<Length>>>,
    /// Where its centre starts, instead of `height`: [x, up] or [x, y, up].
    position: Option<At<OneOrMany<Measure<Length>>>>,
    /// The velocity it starts with: upwards, or [x, up] or [x, y, up]; at rest unless given.
    velocity: Option<At<OneOrMany<Measure<Speed>>>>,
    /// The spin it starts with: from x towards up (topspin of a ball that flies towards x is
    /// negative), or a vector [x, y, up].
    pub(super) spin: Option<At<OneOrMany<Measure<AngularSpeed>>>>,
}

impl BallTable {
    /// Notes the number of coordinates that the ball needs in the space.
    pub(super) fn look(&self, space: &mut Space) -> Result<(), Fault> {
        space.vector("position", self.position.as_ref())?;
        space.vector("velocity", self.velocity.as_ref())?;
        if let Some(spin) = &self.spin {
            match spin.get() {
                OneOrMany::One(_) => {}
                OneOrMany::Many(list) if list.len() == 3 => space.vector("spin", Some(spin))?,
                OneOrMany::Many(list) => {
                    let says = "components are no spin: write one number in a plane (from x towards up), or three in space, [x, y, up]";
                    return Err(spin.fault(format!("{} {says}", list.len())));
                }
            }
        }
        Ok(())
    }

    /// The place to point at when the ball as a whole is meant.
    pub(super) fn place(&self) -> Option<std::ops::Range<usize>> {
        let position = self.position.as_ref().map(At::span);
        self.height.as_ref().map(At::span).or(position).or(self.velocity.as_ref().map(At::span))
    }

    /// The place where the mass stands.
    pub(super) fn mass(&self) -> Option<&At<Measure<Mass>>> {
        self.mass.as_ref()
    }

    pub(super) fn read(&self, space: &Space, whole: &std::ops::Range<usize>) -> Result<Ball, Fault> {
        let radius = match (&self.radius, &self.diameter) {
            (Some(_), Some(at)) => return Err(at.fault("both `radius` and `diameter` are given: keep one")),
            (Some(at), None) => Some(at.positive("a radius in m")?),
            (None, Some(at)) => Some(0.5 * at.positive("a diameter in m")?),
            (None, None) => None,
        };
        let mass = self.mass.as_ref().map(|at| at.positive("a mass in kg")).transpose()?;
        let inertia = match (&self.shape, &self.inertia) {
            (Some(_), Some(at)) => return Err(at.fault("both `shape` and `inertia` are given: keep one")),
            (_, Some(at)) => at.with(|factor| Sphere::with_inertia(1.0, 1.0, factor))?.inertia_factor(),
            (Some(at), None) if matches!(at.get(), Kind::Hollow) => 2.0 / 3.0,
            _ => 2.0 / 5.0,
        };
        let start = match (&self.height, &self.position) {
            (Some(_), Some(at)) => {
                return Err(at.fault(
                    "both `height` and `position` are given: keep one (`height` of the lowest point, `position` of the centre)",
                ));
            }
            (Some(at), None) => Start::Lowest(Vector3::new(0.0, 0.0, at.real())),
            (None, Some(at)) => Start::Centre(space.read(at)),
            (None, None) => {
                return Err(Fault::new(
                    whole.clone(),
                    "a ball has no place to start from: give `height = \"1 m\"`, of its lowest point, or `position`, of its centre",
                ));
            }
        };
        let velocity = self.velocity.as_ref().map_or(Vector3::zeros(), |at| space.read(at));
        let spin = match &self.spin {
            None => None,
            Some(at) => {
                if radius.is_none() {
                    return Err(at.fault("a point cannot spin: give the ball a `radius`"));
                }
                Some(match (at.get(), space.dimensions()) {
                    (OneOrMany::One(_), 1) => {
                        return Err(at.fault(
                            "spin has no direction in a vertical scene: give the ball a sideways velocity, such as `velocity = [\"1 m/s\", \"0 m/s\"]`, or spin as [x, y, up]",
                        ));
                    }
                    (OneOrMany::One(_), 3) => {
                        return Err(at.fault("one number is no spin in space: write three components, [x, y, up]"));
                    }
                    // From x towards up is about -y.
                    (OneOrMany::One(spin), _) => Vector3::new(0.0, 0.0 - spin.real(), 0.0),
                    (OneOrMany::Many(_), _) => space.read(at),
                })
            }
        };
        Ok(Ball {
            name: self.name.clone(),
            material: self.material.as_ref().map(|at| at.get().clone()),
            radius,
            mass,
            inertia,
            start,
            velocity,
            spin,
        })
    }
}
