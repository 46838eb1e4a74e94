//! The air of a scene and what it does to a ball.

use nalgebra::Vector3;
#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::ball::Ball;
use super::error::Fault;
use super::space::Space;
use super::value::{At, Density, Measure, Number, OneOrMany, PerLength, Rate, Speed, Time, Viscosity};
use saltus_bounce::effects::{
    AIR_DENSITY, AIR_VISCOSITY, Buoyancy, Gravity, LinearDrag, Magnus, QuadraticDrag, SpinDecay,
};

/// The effects on the balls of a scene in flight, beside gravity: each only if the scene names it.
///
/// ```
/// use saltus_scene::Scene;
/// let toml = b"restitution = 0.9\ndrag = { coefficient = 0.47 }\n[ball]\nradius = '2 cm'\nmass = '2.7 g'\nheight = '1 m'\n";
/// let scene = Scene::parse("table-tennis.toml", toml)?;
/// let drag = scene.effects.quadratic_drag(&scene.balls[0]).unwrap();
/// assert!((drag.per_length() - 0.134).abs() < 1e-3);
/// assert!(scene.effects.magnus(&scene.balls[0]).is_none());
/// # Ok::<(), saltus_scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Effects {
    /// The density of the air, or whatever the ball flies in, in kg/m³.
    pub density: f64,
    /// The viscosity of the air in Pa s.
    pub viscosity: f64,
    /// The velocity of the air (x, y, up) in m/s; `None` where the scene names no wind.
    pub wind: Option<Vector3<f64>>,
    /// Drag in proportion to the speed.
    pub linear: Option<Linear>,
    /// Drag in proportion to the square of the speed.
    pub quadratic: Option<Quadratic>,
    /// Whether the air lifts the ball.
    pub buoyancy: bool,
    /// Whether the ball drags air along.
    pub added_mass: bool,
    /// Lift by spin: slope κ and saturation σ.
    pub lift: Option<[f64; 2]>,
    /// The decay of spin.
    pub spin_decay: Option<Decay>,
}

/// The drag rate of linear drag, given or computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Linear {
    /// A rate in 1/s.
    Rate(f64),
    /// The rate by Stokes's law, from the viscosity of the air.
    Viscous,
}

/// The coefficient of quadratic drag, given or computed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Quadratic {
    /// The coefficient per length, in 1/m.
    PerLength(f64),
    /// The drag coefficient of the ball in its air.
    Coefficient(f64),
}

/// The law by which spin decays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Decay {
    /// A decay to 1/e within a time in s.
    Within(f64),
    /// A decay in proportion to the speed, with a coefficient.
    InFlight(f64),
}

impl Effects {
    /// The linear drag on `ball`, if the scene names it.
    #[must_use]
    pub fn linear_drag(&self, ball: &Ball) -> Option<LinearDrag> {
        match self.linear? {
            Linear::Rate(rate) => LinearDrag::new(rate).ok(),
            Linear::Viscous => LinearDrag::stokes(&ball.sphere()?, self.viscosity).ok(),
        }
    }

    /// The quadratic drag on `ball`, if the scene names it.
    #[must_use]
    pub fn quadratic_drag(&self, ball: &Ball) -> Option<QuadraticDrag> {
        match self.quadratic? {
            Quadratic::PerLength(k) => QuadraticDrag::new(k).ok(),
            Quadratic::Coefficient(c) => QuadraticDrag::sphere(&ball.sphere()?, self.density, c).ok(),
        }
    }

    /// The buoyancy of `ball`, if the scene names it.
    #[must_use]
    pub fn buoyancy(&self, ball: &Ball, gravity: Gravity) -> Option<Buoyancy> {
        if self.buoyancy { Buoyancy::new(&ball.sphere()?, self.density, gravity).ok() } else { None }
    }

    /// The lift of `ball`, if the scene names it.
    #[must_use]
    pub fn magnus(&self, ball: &Ball) -> Option<Magnus> {
        let [slope, saturation] = self.lift?;
        Magnus::new(&ball.sphere()?, self.density, slope, saturation).ok()
    }

    /// The decay of the spin of `ball`, if the scene names it.
    #[must_use]
    pub fn spin_decay(&self, ball: &Ball) -> Option<SpinDecay> {
        match self.spin_decay? {
            Decay::Within(time) => SpinDecay::within(time).ok(),
            Decay::InFlight(c) => SpinDecay::in_flight(&ball.sphere()?, c).ok(),
        }
    }
}

/// The air, or whatever the ball flies in. It acts only through the effects that are named.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "air"))]
pub(super) struct AirTable {
    /// Its density; 1.225 kg/m^3, dry air at 15 °C at sea level, unless given.
    density: Option<At<Measure<Density>>>,
    /// Its viscosity; 17.894 µPa s, the same air, unless given.
    viscosity: Option<At<Measure<Viscosity>>>,
    /// The velocity of the air: along x, or [x, up] or [x, y, up]; still unless given. Felt by drag
    /// and lift.
    pub(super) wind: Option<At<OneOrMany<Measure<Speed>>>>,
}

/// Drag: linear by `rate` or `viscous`, quadratic by `per_length` or `coefficient`; one of each
/// kind may act together.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "drag"))]
pub(super) struct DragTable {
    /// Linear, a = -rate × v.
    rate: Option<At<Measure<Rate>>>,
    /// Linear, by Stokes's law from the viscosity of the air and the ball's radius and mass.
    viscous: Option<At<bool>>,
    /// Quadratic, a = -k |v| v: k.
    per_length: Option<At<Measure<PerLength>>>,
    /// Quadratic: the drag coefficient, with the density of the air and the ball's radius and mass;
    /// 0.47 for a smooth sphere.
    coefficient: Option<At<Number>>,
}

/// Lift by spin (the Magnus effect): C = slope × S/(1 + saturation × S), S the surface's speed over
/// the ball's.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "magnus"))]
pub(super) struct MagnusTable {
    /// The lift coefficient per spin parameter; 1 unless given.
    slope: Option<At<Number>>,
    /// 0 unless given; 2 for tennis balls.
    saturation: Option<At<Number>>,
}

/// Decay of spin in the air: by `time` or by `coefficient`.
#[derive(Clone, Debug, Default, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "spin-decay"))]
pub(super) struct SpinDecayTable {
    /// The time within which spin falls to 1/e.
    time: Option<At<Measure<Time>>>,
    /// C of ω' = -C (|v|/R) ω; 2e-5 for golf balls.
    coefficient: Option<At<Number>>,
}

/// The tables that speak of the air, as they stand in a file.
pub(super) struct Tables<'a> {
    pub(super) air: Option<&'a At<AirTable>>,
    pub(super) drag: Option<&'a At<DragTable>>,
    pub(super) buoyancy: Option<&'a At<bool>>,
    pub(super) added_mass: Option<&'a At<bool>>,
    pub(super) magnus: Option<&'a At<MagnusTable>>,
    pub(super) spin_decay: Option<&'a At<SpinDecayTable>>,
}

impl Tables<'_> {
    /// Reads the effects; `balls` are those they act on.
    pub(super) fn read(&self, space: &Space, balls: &[Ball]) -> Result<Effects, Fault> {
        let still = AirTable::default();
        let air = self.air.map_or(&still, At::get);
        let density = air.density.as_ref().map_or(Ok(AIR_DENSITY), |at| at.not_negative("a density in kg/m^3"))?;
        let viscosity = air.viscosity.as_ref().map_or(Ok(AIR_VISCOSITY), |at| at.positive("a viscosity in Pa s"))?;
        let (linear, quadratic) = self.drag(balls)?;
        let flag = |at: Option<&At<bool>>, what| match at {
            Some(at) if *at.get() => whole(balls, at, what).map(|()| true),
            _ => Ok(false),
        };
        let buoyancy = flag(self.buoyancy, "buoyancy")?;
        let added_mass = flag(self.added_mass, "added mass")?;
        let lift = self.lift(balls)?;
        let spin_decay = self.decay(balls)?;
        let wind = match &air.wind {
            Some(at) if linear.is_none() && quadratic.is_none() && lift.is_none() => {
                return Err(
                    at.fault("the wind acts on nothing: name drag as well, such as `drag = { coefficient = 0.47 }`")
                );
            }
            Some(at) => Some(match at.get() {
                OneOrMany::One(along) => Vector3::new(super::value::Real::real(along), 0.0, 0.0),
                OneOrMany::Many(_) => space.read(at),
            }),
            None => None,
        };
        Ok(Effects { density, viscosity, wind, linear, quadratic, buoyancy, added_mass, lift, spin_decay })
    }

    fn drag(&self, balls: &[Ball]) -> Result<(Option<Linear>, Option<Quadratic>), Fault> {
        let Some(at) = self.drag else { return Ok((None, None)) };
        let drag = at.get();
        let viscous = drag.viscous.as_ref().filter(|at| *at.get());
        let linear = match (&drag.rate, viscous) {
            (Some(_), Some(at)) => {
                return Err(at.fault("linear drag is given twice, by `rate` and by `viscous`: keep one"));
            }
            (Some(at), None) => Some(Linear::Rate(at.with(LinearDrag::new)?.rate())),
            (None, Some(at)) => whole(balls, at, "viscous drag").map(|()| Some(Linear::Viscous))?,
            (None, None) => None,
        };
        let quadratic = match (&drag.per_length, &drag.coefficient) {
            (Some(_), Some(at)) => {
                return Err(at.fault("quadratic drag is given twice, by `per_length` and by `coefficient`: keep one"));
            }
            (Some(at), None) => Some(Quadratic::PerLength(at.with(QuadraticDrag::new)?.per_length())),
            (None, Some(at)) => {
                whole(balls, at, "a drag coefficient")?;
                Some(Quadratic::Coefficient(at.not_negative("a drag coefficient")?))
            }
            (None, None) => None,
        };
        if linear.is_none() && quadratic.is_none() {
            let says = "drag is named but not given: give `rate` (linear), `per_length` or `coefficient` (quadratic), such as `coefficient = 0.47`";
            return Err(at.fault(says));
        }
        Ok((linear, quadratic))
    }

    fn lift(&self, balls: &[Ball]) -> Result<Option<[f64; 2]>, Fault> {
        let Some(at) = self.magnus else { return Ok(None) };
        whole(balls, at, "lift")?;
        if balls.iter().all(|ball| ball.spin.is_none()) {
            return Err(at.fault("lift comes of spin, and no ball spins: give `spin = \"30 rev/s\"` under [ball]"));
        }
        let number =
            |at: &Option<At<Number>>, default, what| at.as_ref().map_or(Ok(default), |at| at.not_negative(what));
        let slope = number(&at.get().slope, 1.0, "a lift coefficient per spin parameter")?;
        Ok(Some([slope, number(&at.get().saturation, 0.0, "a saturation of lift")?]))
    }

    fn decay(&self, balls: &[Ball]) -> Result<Option<Decay>, Fault> {
        let Some(at) = self.spin_decay else { return Ok(None) };
        if balls.iter().all(|ball| ball.spin.is_none()) {
            return Err(at.fault("no ball spins, so no spin decays: give `spin = \"30 rev/s\"` under [ball]"));
        }
        match (&at.get().time, &at.get().coefficient) {
            (Some(_), Some(at)) => {
                Err(at.fault("the decay of spin is given twice, by `time` and by `coefficient`: keep one"))
            }
            (Some(at), None) => Ok(Some(Decay::Within(at.positive("a time constant in s")?))),
            (None, Some(at)) => Ok(Some(Decay::InFlight(at.not_negative("a coefficient of spin decay")?))),
            (None, None) => {
                Err(at
                    .fault("the decay of spin is named but not given: give `time = \"20 s\"` or `coefficient = 2e-5`"))
            }
        }
    }
}

/// Refuses an effect that needs bodies where a ball has no radius or no mass.
fn whole<T>(balls: &[Ball], at: &At<T>, what: &str) -> Result<(), Fault> {
    let needs = |has: bool, key: &str| {
        let says =
            format!("{what} needs the {} of the ball: give `{key}` under [ball]", key.split(' ').next().unwrap_or(key));
        if has { Ok(()) } else { Err(at.fault(says)) }
    };
    for ball in balls {
        needs(ball.radius.is_some(), "radius = \"2 cm\"")?;
        needs(ball.mass.is_some(), "mass = \"45 g\"")?;
    }
    Ok(())
}
