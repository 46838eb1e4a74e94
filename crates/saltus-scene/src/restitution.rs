//! Laws of restitution of a scene: a number, a range, a function of the speed, or the preset of two
//! materials.

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;

use super::error::Fault;
use super::kinds::kinds;
use super::value::{At, HertzStiffness, Mass, Measure, Number, Pairs, PerSpeed, Real, Short, Speed, Time};
use saltus_bounce::friction::Friction;
use saltus_bounce::materials::Preset;
use saltus_bounce::restitution::{Cor, Knots, Linear, Plastic, Restitution, Viscoelastic};

/// The law of restitution of a scene.
///
/// ```
/// use saltus_bounce::Restitution;
/// use saltus_scene::Scene;
/// let scene = Scene::parse("drop.toml", b"restitution = [0.5, 0.6]\n[ball]\nheight = '1 m'\n")?;
/// let [low, high] = scene.law(0, 0).unwrap().range(2.0).map(|cor| cor.value());
/// assert_eq!((low, high, scene.law(0, 0).unwrap().rebound(2.0)), (0.5, 0.6, 1.1));
/// # Ok::<(), saltus_scene::SceneError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
#[allow(clippy::large_enum_variant)] // a scene has few of them, and copies none while it runs
pub enum Law {
    /// A constant coefficient.
    Cor(Cor),
    /// A coefficient between two bounds; a run takes the one at the part `pick` of the way up.
    Range {
        /// The lowest and the highest coefficient.
        cor: [Cor; 2],
        /// The part of the way up, from 0, the lowest, to 1, the highest.
        pick: f64,
    },
    /// The coefficients measured of a pair of materials; a run takes the one at the part `pick` of
    /// the way up.
    Preset {
        /// The pair of materials, with its source.
        preset: &'static Preset,
        /// The part of the way up, from 0, the lowest, to 1, the highest.
        pick: f64,
    },
    /// A line over the speed.
    Linear(Linear),
    /// Lines between points.
    Knots(Knots),
    /// A viscoelastic sphere.
    Viscoelastic(Viscoelastic),
    /// Fully plastic impacts.
    Plastic(Plastic),
}

impl Law {
    /// The coefficient a run takes at the speed `impact` in m/s.
    #[must_use]
    pub fn cor(&self, impact: f64) -> Cor {
        let between = |[low, high]: [Cor; 2], pick: f64| Cor::within(low.value() + pick * (high.value() - low.value()));
        match self {
            Self::Cor(cor) => *cor,
            Self::Range { cor, pick } => between(*cor, *pick),
            Self::Preset { preset, pick } => between(preset.cor(), *pick),
            Self::Linear(law) => law.cor(impact),
            Self::Knots(law) => law.cor(impact),
            Self::Viscoelastic(law) => law.cor(impact),
            Self::Plastic(law) => law.cor(impact),
        }
    }

    /// The coefficient if it is the same at every speed.
    #[must_use]
    pub fn constant(&self) -> Option<Cor> {
        matches!(self, Self::Cor(_) | Self::Range { .. } | Self::Preset { .. }).then(|| self.cor(0.0))
    }

    /// The lowest and the highest coefficient that the scene allows at the speed `impact` in m/s.
    #[must_use]
    pub fn range(&self, impact: f64) -> [Cor; 2] {
        match self {
            Self::Range { cor, .. } => *cor,
            Self::Preset { preset, .. } => preset.cor(),
            _ => [self.cor(impact); 2],
        }
    }
}

impl Restitution for Law {
    #[inline]
    fn rebound(&self, impact: f64) -> f64 {
        self.cor(impact).rebound(impact)
    }
}

kinds! {
    /// How restitution depends on the speed.
    enum Kind of RestitutionTable by "law", none "a table without `law`" { range, pick, cor } {
        Linear = "linear", "e = cor + slope × speed, constant below `slowest` and above `fastest`:" { cor, slope, slowest, fastest }
        Knots = "knots", "Straight lines between measured points:" { knots }
        Viscoelastic = "viscoelastic", "A viscoelastic sphere, e falls slowly from 1 as the impact quickens:" { cor, speed, dissipation, stiffness, mass }
        Plastic = "plastic", "Fully plastic impacts, e falls with the fourth root of the speed:" { cor, speed, yield_speed }
    }
}

/// Restitution as a table: a range, or a law over the speed of impact.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "restitution"))]
pub(super) struct RestitutionTable {
    /// Which law.
    law: Option<At<Kind>>,
    /// The lowest and the highest coefficient known.
    range: Option<At<[Number; 2]>>,
    /// Where in the range, or between the bounds of the materials, a run is made: 0 the lowest, 1
    /// the highest, 0.5 unless given.
    pick: Option<At<Number>>,
    /// The coefficient: at speed zero for `linear`; at `speed` for `viscoelastic` and `plastic`.
    cor: Option<At<Number>>,
    /// The speed of impact at which `cor` holds.
    speed: Option<At<Measure<Speed>>>,
    /// For `linear`: how much e changes per speed; negative where faster impacts lose more.
    slope: Option<At<Measure<PerSpeed>>>,
    /// For `linear`: below this speed e is constant; 0 unless given.
    slowest: Option<At<Measure<Speed>>>,
    /// For `linear`: above this speed e is constant.
    fastest: Option<At<Measure<Speed>>>,
    /// For `knots`: pairs of a speed and the coefficient there, by increasing speed.
    knots: Option<At<Pairs<Measure<Speed>, Number>>>,
    /// For `viscoelastic`: the dissipation time A.
    dissipation: Option<At<Measure<Time>>>,
    /// For `viscoelastic`: the Hertz stiffness k.
    stiffness: Option<At<Measure<HertzStiffness>>>,
    /// For `viscoelastic`: the effective mass.
    mass: Option<At<Measure<Mass>>>,
    /// For `plastic`: the speed up to which nothing is lost.
    yield_speed: Option<At<Measure<Speed>>>,
}

/// The restitution of a scene, or the part of the range of a preset that is to be taken.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant)] // lives while a file is read
pub(super) enum Said {
    /// This law.
    Law(Law),
    /// The preset of the materials, at this part of its range.
    Materials(f64),
}

fn cor(at: &At<Number>) -> Result<Cor, Fault> {
    Cor::new(at.real()).map_err(|error| at.fault(error))
}

fn range<T>(at: &At<T>, ends: [f64; 2], pick: f64) -> Result<Law, Fault> {
    let [low, high] = ends.map(|e| Cor::new(e).map_err(|error| at.fault(error)));
    let cor = [low?, high?];
    if cor[0] > cor[1] {
        return Err(at.fault("the range of the coefficient is upside down: write the lower end first"));
    }
    Ok(Law::Range { cor, pick })
}

/// The value of `restitution = ...`.
pub(super) fn said(at: &At<Short<RestitutionTable>>) -> Result<Said, Fault> {
    match at.get() {
        Short::Number(e) => Ok(Said::Law(Law::Cor(Cor::new(*e).map_err(|error| at.fault(error))?))),
        Short::Range(ends) => range(at, *ends, 0.5).map(Said::Law),
        Short::Table(table) => table.said(at),
    }
}

impl RestitutionTable {
    fn said(&self, at: &At<Short<Self>>) -> Result<Said, Fault> {
        let pick = match &self.pick {
            Some(pick) if (0.0..=1.0).contains(&pick.real()) => Some(pick.real()),
            Some(pick) => {
                let says = "is no part of a range: give a number from 0 (the lowest) to 1 (the highest)";
                return Err(pick.fault(format!("{} {says}", pick.real())));
            }
            None => None,
        };
        let Some(kind) = &self.law else {
            self.only(None)?;
            return match (&self.range, &self.cor, pick) {
                (Some(ends), None, _) => {
                    let [Number(low), Number(high)] = *ends.get();
                    range(ends, [low, high], pick.unwrap_or(0.5)).map(Said::Law)
                }
                (None, Some(e), None) => Ok(Said::Law(Law::Cor(cor(e)?))),
                (None, None, Some(pick)) => Ok(Said::Materials(pick)),
                (None, None, None) => {
                    Err(at.fault("restitution says nothing: give `cor = 0.8`, `range = [0.7, 0.8]` or a `law`"))
                }
                (Some(_), Some(e), _) => Err(e.fault("both `cor` and `range` are given: keep one")),
                (None, Some(e), Some(_)) => {
                    Err(e.fault("`pick` chooses within a range, and `cor` is one number: leave one out"))
                }
            };
        };
        self.law(kind.get(), &kind.span()).map(Said::Law)
    }

    fn law(&self, kind: &Kind, whole: &std::ops::Range<usize>) -> Result<Law, Fault> {
        self.only(Some(*kind))?;
        let missing = |says: &str| Fault::new(whole.clone(), says);
        Ok(match kind {
            Kind::Linear => {
                let (Some(e), Some(slope), Some(fastest)) = (&self.cor, &self.slope, &self.fastest) else {
                    return Err(missing(
                        "the law `linear` is incomplete: give `cor` (at speed zero), `slope` and `fastest`",
                    ));
                };
                let slowest = self.slowest.as_ref().map_or(0.0, At::real);
                let law = Linear::new(cor(e)?, slope.real(), slowest, fastest.real());
                Law::Linear(law.map_err(|error| slope.fault(error))?)
            }
            Kind::Knots => {
                let Some(at) = &self.knots else {
                    return Err(missing(
                        "the law `knots` has no points: give `knots = [[\"1 m/s\", 0.8], [\"5 m/s\", 0.7]]`",
                    ));
                };
                let knots: Result<Vec<_>, _> =
                    at.get().iter().map(|(v, e)| Ok((v.real(), Cor::new(e.real())?))).collect();
                let knots = knots.map_err(|error: saltus_bounce::CorError| at.fault(error))?;
                Law::Knots(Knots::new(&knots).map_err(|error| {
                    at.fault(error.to_string().replacen(
                        ": ",
                        ", ",
                        usize::from(error.to_string().matches(": ").count() > 1),
                    ))
                })?)
            }
            Kind::Viscoelastic => match (&self.cor, &self.speed, &self.dissipation, &self.stiffness, &self.mass) {
                (Some(e), Some(v), None, None, None) => {
                    v.positive("a speed of impact in m/s")?;
                    Law::Viscoelastic(Viscoelastic::through(cor(e)?, v.real()).map_err(|error| e.fault(error))?)
                }
                (None, None, Some(a), Some(k), Some(m)) => {
                    k.positive("a Hertz stiffness in N/m^1.5")?;
                    m.positive("a mass in kg")?;
                    Law::Viscoelastic(a.with(|a| Viscoelastic::new(a, k.real(), m.real()))?)
                }
                _ => {
                    return Err(missing(
                        "the law `viscoelastic` is not determined: give either `cor` and `speed`, or `dissipation`, `stiffness` and `mass`",
                    ));
                }
            },
            Kind::Plastic => match (&self.cor, &self.speed, &self.yield_speed) {
                (Some(e), Some(v), None) => {
                    v.positive("a speed of impact in m/s")?;
                    Law::Plastic(Plastic::through(cor(e)?, v.real()).map_err(|error| e.fault(error))?)
                }
                (None, None, Some(v)) => Law::Plastic(v.with(Plastic::new)?),
                _ => {
                    return Err(missing(
                        "the law `plastic` is not determined: give either `cor` and `speed`, or `yield_speed`",
                    ));
                }
            },
        })
    }
}

/// Friction along a surface as a table.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "friction"))]
pub(super) struct FrictionTable {
    /// The coefficient of sliding friction μ.
    coefficient: At<Number>,
    /// How much of the slip of a gripping ball comes back: 0, the ball leaves rolling, to 1; 0
    /// unless given.
    gripping: Option<At<Number>>,
}

/// The value of `friction = ...`.
pub(super) fn friction(at: &At<Short<FrictionTable>>) -> Result<Friction, Fault> {
    match at.get() {
        Short::Number(mu) => Friction::rigid(*mu).map_err(|error| at.fault(error)),
        Short::Range(_) => Err(at.fault("friction is one number: give a coefficient such as 0.3")),
        Short::Table(table) => {
            table.coefficient.with(Friction::rigid)?;
            let mu = table.coefficient.real();
            match &table.gripping {
                Some(gripping) => gripping.with(|beta| Friction::walton(mu, beta)),
                None => table.coefficient.with(Friction::rigid),
            }
        }
    }
}
