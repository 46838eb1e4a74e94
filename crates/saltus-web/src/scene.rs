//! Scenes: run and sampled for the screen, drawn, written for animators, compared with themselves.

use saltus_bounce::effects::Gravity;
use saltus_motion::{Format, Frames};
use saltus_plot::record as pictures;
use saltus_scene::accuracy::Difference;
use saltus_scene::plan::{Effect, Plan, Record, With};
use saltus_scene::{Kind, Scene, SceneError, Staging};
use serde::Deserialize;
use serde_json::{Map, Value, json};

use crate::answer::{Answer, failed};
use crate::knob::Knob;

/// The name of the scene in messages.
const NAME: &str = "scene";
/// The samples of a motion in a second: four to each frame of a screen, and no more in all than a
/// picture has columns.
const SAMPLES_PER_SECOND: f64 = 240.0;
const MOST_SAMPLES: u32 = 2000;
/// The most evaluations of flows and guards of a run: about a second.
const MOST_EVALUATIONS: u64 = 5_000_000;
/// The most impacts that are listed.
const LISTED: usize = 200;
/// The distance of keys of files from the motion, m.
const TOLERANCE: f64 = 1e-4;

/// A scene to run.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Run {
    toml: String,
    /// A slider and its value, written into the scene before it is run.
    #[serde(default)]
    set: Option<(Knob, f64)>,
    /// Whether to look which sliders the scene has.
    #[serde(default)]
    knobs: bool,
    /// The kinds of pictures wanted.
    #[serde(default)]
    pictures: Vec<String>,
}

/// The error of a scene: with its place, where it has one.
fn refused(error: &SceneError) -> Value {
    json!({
        "kind": "scene", "message": error.message(), "line": error.line(), "column": error.column(),
        "advice": error.help(), "says": error.to_string(),
    })
}

fn parsed(toml: &str) -> Result<Scene, Value> {
    Scene::parse(NAME, toml.as_bytes()).map_err(|error| refused(&error))
}

/// The plan of a scene, with an end to its patience.
fn planned(scene: &Scene) -> Result<Plan, Value> {
    let plan = scene.plan().map_err(|error| match error.in_text() {
        Some(error) => refused(error),
        None => failed("plan", error),
    })?;
    Ok(plan.most_evaluations(MOST_EVALUATIONS))
}

fn ran(scene: &Scene) -> Result<Record, Value> {
    planned(scene)?.run().map_err(|error| failed("run", error))
}

/// The motion: samples as numbers of eight bytes, sample by sample and ball by ball the centre's x
/// and height; the rest as JSON.
pub(crate) fn answer(run: Run) -> Answer {
    let (mut toml, mut scene) = (run.toml.clone(), parsed(&run.toml)?);
    if let Some((knob, value)) = run.set {
        toml = knob.set(&toml, &scene, value).ok_or_else(|| failed("knob", "the scene has no place for this"))?;
        scene = parsed(&toml)?;
    }
    let record = ran(&scene)?;
    let until = record.until();
    let intervals = (until * SAMPLES_PER_SECOND).ceil().clamp(1.0, f64::from(MOST_SAMPLES));
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
    let times: Vec<f64> = (0..=intervals as u32).map(|k| until * f64::from(k) / intervals).collect();
    let radius = |ball: usize| scene.balls.get(ball).and_then(|ball| ball.radius).unwrap_or(0.0);
    let mut places = Vec::with_capacity(2 * times.len() * record.balls());
    for &t in &times {
        for ball in 0..record.balls() {
            let place =
                record.at(ball, t).map_or([f64::NAN; 2], |moment| [moment.position.x, moment.height() + radius(ball)]);
            places.push(place);
        }
    }
    let (floors, bounds) = floors(&scene, &record, &places, &times);
    let answer = json!({
        "toml": toml,
        "until": until,
        "samples": times.len(),
        "balls": (0..record.balls()).map(|n| json!({ "name": scene.ball_name(n), "radius": radius(n) })).collect::<Vec<_>>(),
        "floors": floors,
        "bounds": bounds,
        "impacts": impacts(&record),
        "knobs": if run.knobs { knobs(&toml, &scene) } else { Value::Null },
        "pictures": drawn(&record, &run.pictures),
        "ended": (!record.end().is_in_time()).then(|| record.end().to_string()),
        "doubts": record.doubts(),
    });
    Ok((answer, places.as_flattened().iter().flat_map(|place| place.to_le_bytes()).collect()))
}

/// Outlines of the floors and how they move, and what has to be in sight: left, right, low, high.
fn floors(scene: &Scene, record: &Record, places: &[[f64; 2]], times: &[f64]) -> (Vec<Value>, [f64; 4]) {
    let mut bounds = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
    for ([x, height], ball) in places.iter().zip((0..record.balls()).cycle()) {
        let radius = scene.balls.get(ball).and_then(|ball| ball.radius).unwrap_or(0.0);
        bounds[0] = bounds[0].min(x - radius);
        bounds[1] = bounds[1].max(x + radius);
        bounds[2] = bounds[2].min(height - radius);
        bounds[3] = bounds[3].max(height + radius);
    }
    let [left, right, low, high] = bounds;
    // Floors go on to the sides of any screen.
    let aside = (right - left) + 4.0 * (high - low);
    let outline = |floor: &saltus_scene::Floor| {
        let points = floor.outline([[left - aside, right + aside], [low, high]]);
        let offsets = floor.motion.as_ref().map(|motion| times.iter().map(|&t| motion.offset(t)).collect::<Vec<_>>());
        json!({ "points": points, "offsets": offsets })
    };
    (scene.floors.iter().map(outline).collect(), bounds)
}

fn impacts(record: &Record) -> Vec<Value> {
    let impact = |impact: &saltus_scene::plan::Impact| {
        let with = match impact.with {
            With::Ball(other) => Some(other),
            _ => None,
        };
        json!({ "t": impact.t, "ball": impact.ball, "other": with, "approach": impact.approach, "rebound": impact.rebound })
    };
    record.impacts().iter().take(LISTED).map(impact).collect()
}

/// The gravity of other bodies, and the sliders that the scene has, with their values: those for
/// which it is a scene again when its own value is written into it.
fn knobs(toml: &str, scene: &Scene) -> Value {
    let known = Knob::ALL.into_iter().filter_map(|knob| {
        let value = knob.of(scene)?;
        parsed(&knob.set(toml, scene, value)?).ok()?.plan().ok()?;
        let name = serde_json::to_value(knob).ok()?.as_str()?.to_owned();
        Some((name, value.into()))
    });
    let planets: Vec<(&str, f64)> = Gravity::NAMED.iter().map(|(name, gravity)| (*name, gravity.value())).collect();
    json!({ "values": known.collect::<Map<_, _>>(), "planets": planets })
}

/// Pictures by kind, in the order wanted; a kind that the motion has no picture of is left out.
fn drawn(record: &Record, wanted: &[String]) -> Vec<(&'static str, String)> {
    let kinds = wanted.iter().filter_map(|name| Kind::ALL.into_iter().find(|kind| kind.name() == name));
    kinds.filter_map(|kind| Some((kind.name(), pictures::svg(record, kind).ok()?))).collect()
}

/// A file for animators and the line about its error.
pub(crate) fn export(toml: &str, format: &str, fps: &str) -> Answer {
    let found = Format::ALL.into_iter().find(|known| known.name() == format);
    let format = found.ok_or_else(|| failed("export", format!("'{format}' is no format of motion")))?;
    let rate = fps.parse().map_err(|error| failed("export", error))?;
    let record = ran(&parsed(toml)?)?;
    let stage = Staging::new(Frames::new(rate)).stage(&record).map_err(|error| failed("export", error))?;
    let file = stage.file(format, TOLERANCE).map_err(|error| failed("export", error))?;
    Ok((json!({ "says": stage.says(&file) }), file.bytes))
}

/// The change that each effect makes: the scene with it left out or put in, beside the scene as it
/// is.
pub(crate) fn effects(toml: &str) -> Answer {
    let scene = parsed(toml)?;
    let plan = planned(&scene)?;
    let base = plan.run().map_err(|error| failed("run", error))?;
    let row = |effect: Effect| {
        let toggled = scene.toggled(effect).map_err(str::to_owned);
        let other = toggled.and_then(|scene| {
            let plan = scene.plan().map_err(|error| error.to_string())?;
            plan.until(base.until()).most_evaluations(MOST_EVALUATIONS).run().map_err(|error| error.to_string())
        });
        let mut row = json!({ "effect": effect.name(), "without": scene.names(effect) });
        let came = match other {
            Ok(other) => {
                let by = Difference::between(&scene, &base, &other);
                json!({ "impacts": by.impacts, "apexes": by.apexes, "position": by.position, "energy": by.energy, "missed": by.missed })
            }
            Err(refused) => json!({ "refused": refused }),
        };
        if let (Value::Object(row), Value::Object(came)) = (&mut row, came) {
            row.extend(came);
        }
        row
    };
    let rows: Vec<Value> = Effect::ALL.into_iter().map(row).collect();
    Ok((json!({ "rows": rows, "text": plan.explain().to_string() }), Vec::new()))
}
