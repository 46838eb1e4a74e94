//! The file as it is written: its tables and how they become a [`Scene`].

use std::fmt;
use std::ops::Range;

#[cfg(test)]
use schemars::JsonSchema;
use serde::Deserialize;
use serde::de::{Deserializer, Error, Visitor};

use super::air::{AirTable, DragTable, MagnusTable, SpinDecayTable, Tables};
use super::ball::BallTable;
use super::check;
use super::contact::{Body, Contact, ContactTable};
use super::error::{Fault, nearest};
use super::floor::FloorTable;
use super::restitution::{self, FrictionTable, Law, RestitutionTable, Said};
use super::run::{PictureTable, RunTable};
use super::scene::Scene;
use super::source::Source;
use super::space::Space;
use super::value::{Acceleration, At, Dimension, OneOrMany, Short};

use saltus_bounce::effects::Gravity;
use saltus_bounce::friction::Friction;
use saltus_bounce::materials;

/// A scene: balls, what acts on them, what they bounce on.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(title = "saltus scene", rename = "scene"))]
pub(super) struct File {
    /// Gravity, downwards, or the name of a body ("moon"); 9.80665 m/s^2 unless given.
    gravity: Option<At<GravityValue>>,
    /// Restitution on every floor that has none of its own: a coefficient, a range [low, high], or
    /// a table.
    restitution: Option<At<Short<RestitutionTable>>>,
    /// Friction on every floor that has none of its own: a coefficient, or a table; none unless
    /// given.
    friction: Option<At<Short<FrictionTable>>>,
    /// The ball, or several.
    ball: Option<At<OneOrMany<BallTable>>>,
    /// The floor, or several; one level floor at height 0 unless given, none with `floor = []`.
    floor: Option<At<OneOrMany<FloorTable>>>,
    /// The air, or whatever the ball flies in.
    air: Option<At<AirTable>>,
    /// Drag; none unless given.
    drag: Option<At<DragTable>>,
    /// Whether the air lifts the ball; false unless given.
    buoyancy: Option<At<bool>>,
    /// Whether the ball drags half its volume of air along; false unless given.
    added_mass: Option<At<bool>>,
    /// Lift by spin; none unless given.
    magnus: Option<At<MagnusTable>>,
    /// Decay of spin; none unless given.
    spin_decay: Option<At<SpinDecayTable>>,
    /// How ball and floor touch; rigid, in an instant, unless given.
    contact: Option<At<ContactTable>>,
    /// Impacts between balls.
    collisions: Option<At<CollisionTable>>,
    /// How long and how precisely to run.
    run: Option<At<RunTable>>,
    /// What is drawn.
    picture: Option<PictureTable>,
}

/// Impacts between balls.
#[derive(Clone, Debug, Deserialize)]
#[cfg_attr(test, derive(JsonSchema))]
#[serde(deny_unknown_fields)]
#[cfg_attr(test, schemars(rename = "collisions"))]
struct CollisionTable {
    /// Restitution between balls; the scene's unless given.
    restitution: Option<At<Short<RestitutionTable>>>,
    /// Friction between balls; none unless given.
    friction: Option<At<Short<FrictionTable>>>,
}

/// Gravity as a number or a name.
#[derive(Clone, Copy, Debug)]
struct GravityValue(f64);

impl<'de> Deserialize<'de> for GravityValue {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Read;
        impl Visitor<'_> for Read {
            type Value = GravityValue;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an acceleration, such as \"9.81 m/s^2\", a bare number in m/s^2, or the name of a body, such as \"moon\"")
            }
            fn visit_str<E: Error>(self, text: &str) -> Result<GravityValue, E> {
                if let Some(gravity) = Gravity::named(text) {
                    return Ok(GravityValue(gravity.value()));
                }
                let named = text.trim().starts_with(char::is_alphabetic);
                if !named || text.trim().eq_ignore_ascii_case("nan") || text.trim().eq_ignore_ascii_case("inf") {
                    return Acceleration::QUANTITY.parse(text).map(GravityValue).map_err(E::custom);
                }
                let known: Vec<&str> = Gravity::NAMED.iter().map(|&(name, _)| name).collect();
                let help = nearest(text, &known).map_or_else(
                    || format!("write one of {}, or a number", known.join(", ")),
                    |near| format!("did you mean '{near}'?"),
                );
                Err(E::custom(format!("no body named '{text}' is known: {help}")))
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<GravityValue, E> {
                // What is no number is refused with its place when gravity is made.
                let number =
                    if value.is_finite() { Acceleration::QUANTITY.check(value).map_err(E::custom)? } else { value };
                Ok(GravityValue(number))
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<GravityValue, E> {
                i32::try_from(value)
                    .map(|value| GravityValue(f64::from(value)))
                    .map_err(|_| E::custom(format!("{value} m/s^2 is too much")))
            }
        }
        deserializer.deserialize_any(Read)
    }
}

#[cfg(test)]
impl JsonSchema for GravityValue {
    fn inline_schema() -> bool {
        true
    }
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "gravity".into()
    }
    fn json_schema(_: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let names: Vec<&str> = Gravity::NAMED.iter().map(|&(name, _)| name).collect();
        schemars::json_schema!({ "anyOf": [{ "enum": names }, { "type": ["string", "number"] }], "examples": ["9.81 m/s^2", "moon"] })
    }
}

impl File {
    /// The scene of the file, checked; the settings in `run` go before those of the file.
    pub(super) fn scene(&self, run: super::Run) -> Result<Scene, Fault> {
        let gravity = match &self.gravity {
            Some(at) if at.get().0 < 0.0 => {
                let says = "is not a gravity in m/s^2: it acts downwards, leave the minus out";
                return Err(at.fault(format!("{} {says}", at.get().0)));
            }
            Some(at) => Gravity::new(at.get().0).map_err(|error| at.fault(error))?,
            None => Gravity::EARTH,
        };
        let Some(ball) = &self.ball else {
            return Err(Fault::new(0..0, "the scene has no ball: write [ball], and under it `height = \"1 m\"`"));
        };
        let tables = ball.get().as_slice();
        if tables.is_empty() {
            return Err(ball.fault("the scene has no ball: write [ball], and under it `height = \"1 m\"`"));
        }
        let floors = self.floor.as_ref().map_or(&[][..], |at| at.get().as_slice());
        let space = self.space(tables, floors)?;
        let place = |table: &BallTable| table.place().unwrap_or_else(|| ball.span());
        let balls = tables.iter().map(|table| table.read(&space, &place(table))).collect::<Result<Vec<_>, _>>()?;

        let friction = self.friction.as_ref().map_or(Ok(Friction::NONE), restitution::friction)?;
        let said = self.restitution.as_ref().map(restitution::said).transpose()?;
        let rubs = self.friction.as_ref().map(At::span);
        if let (Some(span), true, Some(_)) =
            (rubs, space.dimensions() > 1, balls.iter().find(|ball| ball.radius.is_none()))
        {
            return Err(Fault::new(
                span,
                "friction turns the ball, which needs its radius: give `radius = \"3 cm\"` under [ball]",
            ));
        }
        let contact = self.contact(tables, &balls)?;
        let mut scene = Scene {
            dimensions: space.dimensions(),
            gravity,
            floors: Vec::new(),
            laws: Vec::new(),
            source: Source::default(),
            effects: self.effects().read(&space, &balls)?,
            contact,
            collision: None,
            collision_friction: Friction::NONE,
            run: run.or(self.run.as_ref().map_or(Ok(super::Run::default()), |at| at.get().read())?),
            picture: self.picture.as_ref().map(PictureTable::read).unwrap_or_default(),
            balls,
        };
        self.read_floors(&mut scene, &space, friction, said)?;
        self.collisions(&mut scene, said, tables)?;
        let ends = self.run.as_ref().map_or_else(|| ball.span(), At::span);
        check::scene(&scene, |n| place(&tables[n]), &ends)?;
        Ok(scene)
    }

    fn effects(&self) -> Tables<'_> {
        Tables {
            air: self.air.as_ref(),
            drag: self.drag.as_ref(),
            buoyancy: self.buoyancy.as_ref(),
            added_mass: self.added_mass.as_ref(),
            magnus: self.magnus.as_ref(),
            spin_decay: self.spin_decay.as_ref(),
        }
    }

    /// How many coordinates the scene has.
    fn space(&self, balls: &[BallTable], floors: &[FloorTable]) -> Result<Space, Fault> {
        let mut space = Space::default();
        for ball in balls {
            ball.look(&mut space)?;
        }
        if let Some(wind) = self.air.as_ref().and_then(|air| air.get().wind.as_ref()) {
            space.vector("wind", Some(wind))?;
            space.sideways();
        }
        for floor in floors {
            floor.look(&mut space)?;
        }
        Ok(space)
    }

    fn contact(&self, tables: &[BallTable], balls: &[super::Ball]) -> Result<Contact, Fault> {
        let Some(at) = &self.contact else { return Ok(Contact::Rigid) };
        if let (Some(span), Some(restitution)) = (at.get().compliant(), &self.restitution) {
            let _ = span;
            return Err(restitution.fault(
                "restitution comes of the contact's force in this scene: leave `restitution` out, or give `cor` under [contact]",
            ));
        }
        let body = Body { mass: balls[0].mass, radius: balls[0].radius };
        for (table, ball) in tables.iter().zip(balls) {
            if at.get().compliant().is_some() && (ball.mass, ball.radius) != (body.mass, body.radius) {
                let span = table.mass().map_or_else(|| at.span(), At::span);
                return Err(Fault::new(
                    span,
                    "contact that takes time is one law for all balls: give them all the same mass and radius",
                ));
            }
        }
        at.get().read(body)
    }

    fn read_floors(
        &self,
        scene: &mut Scene,
        space: &Space,
        friction: Friction,
        said: Option<Said>,
    ) -> Result<(), Fault> {
        let level = OneOrMany::One(FloorTable::default());
        let (floors, whole) = match (&self.floor, &self.ball) {
            (Some(at), _) => (at.get().as_slice(), at.span()),
            (None, Some(ball)) => (level.as_slice(), ball.span()),
            (None, None) => (level.as_slice(), 0..0),
        };
        let first = scene.balls[0].centre();
        for table in floors {
            let (floor, own) = table.read(space, first, friction, &whole)?;
            let place = table.place().unwrap_or_else(|| whole.clone());
            let mut laws = Vec::with_capacity(scene.balls.len());
            if scene.contact == Contact::Rigid {
                for ball in &scene.balls {
                    let at = self.material_place(table, &place);
                    laws.push(law(own.or(said), ball.material.as_deref(), floor.material.as_deref(), &at)?);
                }
            } else if own.is_some() {
                let says =
                    "restitution comes of the contact's force in this scene: leave the floor's `restitution` out";
                return Err(Fault::new(place, says));
            }
            scene.laws.push(laws);
            scene.floors.push(floor);
        }
        Ok(())
    }

    /// Where an unknown pair of materials is to be shown.
    fn material_place(&self, floor: &FloorTable, place: &Range<usize>) -> Range<usize> {
        let first = self.ball.as_ref().and_then(|ball| ball.get().as_slice().first());
        let material = first.and_then(|ball| ball.material.as_ref()).or(floor.material.as_ref());
        material.map_or_else(|| place.clone(), At::span)
    }

    fn collisions(&self, scene: &mut Scene, said: Option<Said>, tables: &[BallTable]) -> Result<(), Fault> {
        let own = match &self.collisions {
            Some(at) if scene.balls.len() < 2 => {
                return Err(at.fault("one ball collides with no other: write several balls, each under [[ball]]"));
            }
            Some(at) => at.get().restitution.as_ref().map(restitution::said).transpose()?,
            None => None,
        };
        if scene.balls.len() < 2 {
            return Ok(());
        }
        for (n, table) in tables.iter().enumerate() {
            if scene.balls[n].mass.is_none() {
                let span = table.place().or(self.ball.as_ref().map(At::span)).unwrap_or_default();
                return Err(Fault::new(
                    span,
                    "several balls push each other by their masses: give each a `mass = \"45 g\"`",
                ));
            }
        }
        scene.collision = match own.or(said) {
            Some(Said::Law(law)) => Some(law),
            Some(Said::Materials(_)) | None => {
                let span = self.collisions.as_ref().or(None).map(At::span);
                let span = span.or(self.ball.as_ref().map(At::span)).unwrap_or_default();
                return Err(Fault::new(
                    span,
                    "no restitution is given between the balls: write `collisions = { restitution = 0.9 }`",
                ));
            }
        };
        if let Some(at) = self.collisions.as_ref().and_then(|at| at.get().friction.as_ref()) {
            scene.collision_friction = restitution::friction(at)?;
        }
        Ok(())
    }
}

/// The law of a ball on a floor: that of the floor, else that of the scene, else the preset of the
/// materials.
fn law(said: Option<Said>, ball: Option<&str>, floor: Option<&str>, at: &Range<usize>) -> Result<Law, Fault> {
    let pick = match said {
        Some(Said::Law(law)) => return Ok(law),
        Some(Said::Materials(pick)) => pick,
        None => 0.5,
    };
    match (ball, floor) {
        (Some(ball), Some(floor)) => {
            let preset = materials::find(ball, floor).map_err(|error| Fault::new(at.clone(), error))?;
            Ok(Law::Preset { preset, pick })
        }
        (Some(ball), None) => Err(Fault::new(
            at.clone(),
            format!(
                "nothing is said of the floor that the {ball} bounces on: give `material` under [floor], or `restitution = 0.8`"
            ),
        )),
        _ => Err(Fault::new(
            at.clone(),
            "no restitution is given: write `restitution = 0.8` at the top, or `material` under [ball] and under [floor]",
        )),
    }
}
