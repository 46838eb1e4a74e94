//! Numbers of a scene file that the page has sliders for: read from the scene, written into its
//! text.

use saltus_scene::{Scene, Shape};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use toml_edit::{DocumentMut, Item, Table, TableLike, Value};

/// The quantity of the first ball, or of the scene, that a slider sets.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum Knob {
    /// The height of the lowest point at the start, m.
    Drop,
    /// The coefficient of restitution.
    Cor,
    /// m/s².
    Gravity,
    /// The drag coefficient.
    Drag,
    /// The spin from x towards up, turns a second.
    Spin,
    /// The slope of the floor, upwards along x, degrees.
    Slope,
}

impl Knob {
    /// Every one.
    pub(crate) const ALL: [Self; 6] = [Self::Drop, Self::Cor, Self::Gravity, Self::Drag, Self::Spin, Self::Slope];

    /// Its value in a scene; none where the scene has no one number of it.
    pub(crate) fn of(self, scene: &Scene) -> Option<f64> {
        let ball = scene.balls.first()?;
        match self {
            Self::Drop => Some(ball.lowest().z),
            Self::Cor => scene.law(0, 0)?.constant().map(|cor| cor.value()),
            Self::Gravity => Some(scene.gravity.value()),
            Self::Drag => match scene.effects.quadratic {
                None => Some(0.0),
                Some(saltus_scene::Quadratic::Coefficient(c)) => Some(c),
                Some(_) => None,
            },
            Self::Spin if ball.spin.is_some_and(|spin| spin.x != 0.0 || spin.z != 0.0) => None,
            Self::Spin => Some(ball.planar_spin().unwrap_or(0.0) / TAU),
            Self::Slope => match scene.floors.as_slice() {
                [floor] => match floor.shape {
                    Shape::Level { .. } => Some(0.0),
                    Shape::Incline { angle, .. } => Some(angle.to_degrees()),
                    _ => None,
                },
                _ => None,
            },
        }
    }

    /// The text of the scene with another value; none where there is no place for it. Comments and
    /// all else stay as they are.
    pub(crate) fn set(self, toml: &str, scene: &Scene, value: f64) -> Option<String> {
        let mut file: DocumentMut = toml.parse().ok()?;
        let radius = scene.balls.first()?.radius.unwrap_or(0.0);
        match self {
            Self::Drop => {
                let ball = first(&mut file, "ball")?;
                match ball.get_mut("position").and_then(Item::as_array_mut) {
                    Some(place) => {
                        let up = place.len().checked_sub(1)?;
                        place.replace(up, format!("{} m", plain(value + radius)));
                    }
                    None => put(ball, "height", format!("{} m", plain(value))),
                }
            }
            Self::Cor => {
                let of = |table: &dyn TableLike| table.contains_key("cor");
                let home = ["restitution", "contact"]
                    .into_iter()
                    .find(|key| file.get(key).and_then(Item::as_table_like).is_some_and(of));
                match home.and_then(|key| file.get_mut(key)).and_then(Item::as_table_like_mut) {
                    Some(table) => put(table, "cor", plain(value)),
                    None => put(file.as_table_mut(), "restitution", plain(value)),
                }
            }
            Self::Gravity => put(file.as_table_mut(), "gravity", format!("{} m/s^2", plain(value))),
            Self::Drag => put(first(&mut file, "drag")?, "coefficient", plain(value)),
            Self::Spin => put(first(&mut file, "ball")?, "spin", format!("{} rev/s", plain(value))),
            Self::Slope => {
                let floor = first(&mut file, "floor")?;
                put(floor, "kind", "incline");
                put(floor, "angle", format!("{} deg", plain(value)));
            }
        }
        Some(file.to_string())
    }
}

/// A slider's number without the digits of its binary form.
fn plain(value: f64) -> f64 {
    const STEPS: f64 = 1e6;
    (value * STEPS).round() / STEPS
}

/// The table of this name, or the first of its list; made where it is wanting.
fn first<'a>(file: &'a mut DocumentMut, key: &str) -> Option<&'a mut dyn TableLike> {
    match file.entry(key).or_insert_with(|| Item::Table(Table::new())) {
        Item::ArrayOfTables(list) => list.get_mut(0).map(|table| table as &mut dyn TableLike),
        item => item.as_table_like_mut(),
    }
}

/// Writes a value; comments about it stay.
fn put(table: &mut dyn TableLike, key: &str, value: impl Into<Value>) {
    match table.get_mut(key).and_then(Item::as_value_mut) {
        Some(old) => {
            let decor = old.decor().clone();
            *old = value.into();
            *old.decor_mut() = decor;
        }
        None => drop(table.insert(key, Item::Value(value.into()))),
    }
}
