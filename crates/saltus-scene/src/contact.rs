//! Contact: an instant, or a force while the ball is pressed in.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::error::Fault;
use super::kinds::kinds;
use super::value::{At, Loose, Measure, Number, Pressure, Speed, Time};
use saltus_bounce::ParameterError;
use saltus_bounce::contact::{ContactLaw, Elastic, Hertz, HuntCrossley, KelvinVoigt};
use saltus_bounce::restitution::Cor;
use saltus_bounce::units::Quantity;

/// The law of contact between ball and floor.
///
/// ```
/// use saltus_scene::{Contact, Scene};
/// let toml = b"contact = { law = 'hertz', stiffness = 1e9 }\n[ball]\nmass = '32.7 g'\nheight = '1 cm'\nvelocity = 0\n[run]\nuntil = 1\n";
/// let scene = Scene::parse("steel.toml", toml)?;
/// assert!(matches!(scene.contact, Contact::Hertz(law) if law.constant() == 1e9));
/// # Ok::<(), saltus_scene::SceneError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Contact {
    /// Impact in an instant, by the law of restitution.
    #[default]
    Rigid,
    /// A linear spring and damper.
    KelvinVoigt(KelvinVoigt),
    /// An elastic sphere.
    Hertz(Hertz),
    /// A Hertz contact with damping.
    HuntCrossley(HuntCrossley),
}

impl Contact {
    /// The energy in J that is stored in the spring of the contact at a `deformation` in m: the
    /// work of the elastic force.
    ///
    /// ```
    /// use saltus_scene::Scene;
    /// let toml = b"contact = { law = 'kelvin-voigt', stiffness = 1e4, damping = 1 }\n[ball]\nmass = 1\nheight = 1\n[run]\nuntil = 1\n";
    /// let scene = Scene::parse("soft.toml", toml)?;
    /// assert_eq!(scene.contact.stored(0.01), 0.5);
    /// # Ok::<(), saltus_scene::SceneError>(())
    /// ```
    #[must_use]
    pub fn stored(&self, deformation: f64) -> f64 {
        // The integral of a force that grows with a power of the deformation.
        let (force, power) = match self {
            Self::Rigid => (0.0, 1.0),
            Self::KelvinVoigt(law) => (law.force(deformation, 0.0), 1.0),
            Self::Hertz(law) => (law.force(deformation, 0.0), 1.5),
            Self::HuntCrossley(law) => (law.force(deformation, 0.0), 1.5),
        };
        force * deformation / (power + 1.0)
    }
}

kinds! {
    /// The laws.
    enum Kind of ContactTable by "law", none "a contact" {} {
        Rigid = "rigid", "In an instant, by the law of restitution." {}
        KelvinVoigt = "kelvin-voigt", "A linear spring and damper, by two of" { stiffness, damping, tension, cor, time }
        Hertz = "hertz", "An elastic sphere, by some of" { stiffness, ball, floor, speed, time }
        HuntCrossley = "hunt-crossley", "Hertz with damping, by some of" { stiffness, damping, cor, speed, time }
    }
}

/// The elasticity of a material.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "elastic"))]
struct ElasticTable {
    /// Young's modulus.
    young: At<Measure<Pressure>>,
    /// Poisson's ratio.
    poisson: At<Number>,
}

/// A force law: its constants, or what is to come of it.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "contact"))]
pub(super) struct ContactTable {
    /// Which law.
    law: At<Kind>,
    /// The stiffness: in N/m for `kelvin-voigt`, in N/m^1.5 for `hertz` and `hunt-crossley`.
    stiffness: Option<At<Loose>>,
    /// The damping: in N s/m for `kelvin-voigt`, in N s/m^2.5 for `hunt-crossley`.
    damping: Option<At<Loose>>,
    /// For `kelvin-voigt`: the contact pulls until the deformation is gone; false unless given.
    tension: Option<At<bool>>,
    /// The coefficient of restitution that is to come of it.
    cor: Option<At<Number>>,
    /// The speed of impact at which that is so.
    speed: Option<At<Measure<Speed>>>,
    /// How long the contact is to last.
    time: Option<At<Measure<Time>>>,
    /// For `hertz`: the elasticity of the ball.
    ball: Option<At<ElasticTable>>,
    /// For `hertz`: the elasticity of the floor.
    floor: Option<At<ElasticTable>>,
}

impl ElasticTable {
    fn read(&self) -> Result<Elastic, Fault> {
        self.young.positive("Young's modulus in Pa")?;
        self.poisson.with(|ratio| Elastic::new(self.young.real(), ratio))
    }
}

/// The mass and the radius of the ball, which a contact needs.
#[derive(Clone, Copy, Debug)]
pub(super) struct Body {
    pub(super) mass: Option<f64>,
    pub(super) radius: Option<f64>,
}

impl ContactTable {
    /// The law, of a body whose mass and radius are known if they are given.
    pub(super) fn read(&self, body: Body) -> Result<Contact, Fault> {
        let kind = *self.law.get();
        self.only(Some(kind))?;
        if kind == Kind::Rigid {
            return Ok(Contact::Rigid);
        }
        let missing = |says: &str| self.law.fault(says);
        let mass = body.mass.ok_or_else(|| {
            missing("a contact that takes time needs the mass of the ball: give `mass = \"45 g\"` under [ball]")
        })?;
        let cor = match &self.cor {
            Some(at) => Some(Cor::new(at.real()).map_err(|error| at.fault(error))?),
            None => None,
        };
        let speed = self.speed.as_ref().map(|at| at.positive("a speed in m/s")).transpose()?;
        let time = self.time.as_ref().map(|at| at.positive("a contact time in s")).transpose()?;
        let (of_stiffness, of_damping) = match kind {
            Kind::KelvinVoigt => (Quantity::Stiffness, Quantity::Damping),
            _ => (Quantity::HertzStiffness, Quantity::HertzDamping),
        };
        let stiffness = self.stiffness.as_ref().map(|at| at.read(of_stiffness)).transpose()?;
        let damping = self.damping.as_ref().map(|at| at.read(of_damping)).transpose()?;
        let at = |span: Option<std::ops::Range<usize>>| {
            let span = span.unwrap_or_else(|| self.law.span());
            move |error: ParameterError| Fault::new(span, error)
        };
        let constants = at(self
            .damping
            .as_ref()
            .filter(|_| stiffness.is_some_and(|k| k > 0.0))
            .map(At::span)
            .or(self.stiffness.as_ref().map(At::span)));
        let outcome = at(self.cor.as_ref().map(At::span));
        match kind {
            Kind::Rigid | Kind::KelvinVoigt => {
                let tension = self.tension.as_ref().is_some_and(|at| *at.get());
                let law = match (stiffness, damping, cor, time) {
                    (Some(k), c, None, None) => KelvinVoigt::new(k, c.unwrap_or(0.0)).map_err(constants)?,
                    (None, None, Some(e), Some(t)) if tension => {
                        KelvinVoigt::from_sticky_collision(mass, e, t).map_err(outcome)?
                    }
                    (None, None, Some(e), Some(t)) => KelvinVoigt::from_collision(mass, e, t).map_err(outcome)?,
                    _ => {
                        return Err(missing(
                            "the law `kelvin-voigt` is not determined: give either `stiffness` and `damping`, or `cor` and `time`",
                        ));
                    }
                };
                Ok(Contact::KelvinVoigt(if tension { law.with_tension() } else { law }))
            }
            Kind::Hertz => {
                let law = match (stiffness, &self.ball, &self.floor, speed, time) {
                    (Some(k), None, None, None, None) => Hertz::new(k).map_err(constants)?,
                    (None, Some(ball), Some(floor), None, None) => {
                        let radius = body.radius.ok_or_else(|| {
                            ball.fault(
                                "the elasticity of a sphere needs its radius: give `radius = \"1 cm\"` under [ball]",
                            )
                        })?;
                        Hertz::sphere(radius, ball.get().read()?, floor.get().read()?).map_err(at(Some(ball.span())))?
                    }
                    (None, None, None, Some(v), Some(t)) => Hertz::from_collision(mass, v, t).map_err(outcome)?,
                    _ => {
                        return Err(missing(
                            "the law `hertz` is not determined: give `stiffness`, or `ball` and `floor`, or `speed` and `time`",
                        ));
                    }
                };
                Ok(Contact::Hertz(law))
            }
            Kind::HuntCrossley => {
                let law = match (stiffness, damping, cor, speed, time) {
                    (Some(k), Some(c), None, None, None) => HuntCrossley::new(k, c).map_err(constants)?,
                    (Some(k), None, Some(e), Some(v), None) => HuntCrossley::with_cor(k, v, e).map_err(outcome)?,
                    (None, None, Some(e), Some(v), Some(t)) => {
                        HuntCrossley::from_collision(mass, v, e, t).map_err(outcome)?
                    }
                    _ => {
                        return Err(missing(
                            "the law `hunt-crossley` is not determined: give `stiffness` and `damping`; or `stiffness`, `cor` and `speed`; or `cor`, `speed` and `time`",
                        ));
                    }
                };
                Ok(Contact::HuntCrossley(law))
            }
        }
    }

    /// The place of the law's name if it takes time.
    pub(super) fn compliant(&self) -> Option<std::ops::Range<usize>> {
        (*self.law.get() != Kind::Rigid).then(|| self.law.span())
    }
}
