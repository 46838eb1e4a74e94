//! Numbers of a scene file that may be changed.

use toml_edit::{Array, DocumentMut, Item, Table, Value};

use crate::Scene;
use crate::number::{self, digits};

/// A number of the scene that may be changed.
#[derive(Clone, Debug)]
pub(super) struct Freedom {
    /// The name as it was given.
    pub(super) name: String,
    /// Its path in the file.
    path: Vec<String>,
    /// The unit it is written in; empty where it has none.
    pub(super) unit: String,
    /// The value in the scene to begin with.
    pub(super) start: f64,
    /// The least value.
    pub(super) least: f64,
    pub(super) most: f64,
}

impl Freedom {
    /// The freedom of a name, in a scene that begins as `file` and means `scene`.
    pub(super) fn named(name: &str, file: &mut DocumentMut, scene: &Scene) -> Result<Self, String> {
        let ball = scene.balls.first().ok_or("the scene has no ball")?;
        let path = |keys: &[&str]| keys.iter().map(|key| (*key).to_owned()).collect::<Vec<String>>();
        let of = |keys: &[&str], unit: &str, start: f64, least: f64, most: f64| Self {
            name: name.to_owned(),
            path: path(keys),
            unit: unit.to_owned(),
            start,
            least,
            most,
        };
        let infinite = f64::INFINITY;
        let upward = scene.dimensions - 1;
        let vector = |key: &str| file.get("ball").and_then(|ball| ball.get(key)).is_some_and(Item::is_array);
        let freedom = match name {
            "height" if vector("position") => {
                of(&["ball", "position", &upward.to_string()], "m", ball.centre().z, 0.0, infinite)
            }
            "height" => of(&["ball", "height"], "m", ball.lowest().z, 0.0, infinite),
            "throw" if vector("velocity") => {
                of(&["ball", "velocity", &upward.to_string()], "m/s", ball.velocity.z, -infinite, infinite)
            }
            "throw" => of(&["ball", "velocity"], "m/s", ball.velocity.z, -infinite, infinite),
            "forward" => {
                if !vector("velocity") {
                    sideways(file, ball.velocity.z);
                }
                of(&["ball", "velocity", "0"], "m/s", ball.velocity.x, -infinite, infinite)
            }
            "gravity" => of(&["gravity"], "m/s^2", scene.gravity.value(), 0.0, infinite),
            "cor" => of(
                &["restitution"],
                "",
                written(file, &path(&["restitution"])).map_or(0.7, |(value, _)| value),
                0.0,
                1.0,
            ),
            key => {
                let path: Vec<String> = key.split('.').map(str::to_owned).collect();
                let (start, unit) = written(file, &path).ok_or_else(|| {
                    format!("'{key}' is neither height, throw, forward, gravity or cor nor a number that the scene has: write it into the scene, to begin with")
                })?;
                let least = if start > 0.0 { 0.0 } else { -infinite };
                Self { name: key.to_owned(), path, unit, start, least, most: infinite }
            }
        };
        Ok(freedom)
    }

    /// Writes the number into the file.
    pub(super) fn set(&self, file: &mut DocumentMut, value: f64) -> Result<(), String> {
        let fail = || format!("`{}` cannot be set in this scene", self.path.join("."));
        let value: Value = if self.unit.is_empty() { value.into() } else { format!("{value} {}", self.unit).into() };
        let (last, way) = self.path.split_last().ok_or_else(fail)?;
        let mut item = file.as_item_mut();
        for (n, key) in way.iter().enumerate() {
            item = child(item, key, || Item::Table(Table::new())).ok_or_else(fail)?;
            let next = self.path.get(n + 1).filter(|next| next.parse::<usize>().is_err());
            if let (Item::ArrayOfTables(_) | Item::Value(Value::Array(_)), Some(_)) = (&*item, next) {
                let (list, rest) = (self.path[..=n].join("."), self.path[n + 1..].join("."));
                return Err(format!(
                    "'{}' is of one {list}, and the scene has a list: name one of it, such as `{list}.0.{rest}`, once that is in the scene",
                    self.name
                ));
            }
        }
        let slot = child(item, last, || Item::Value(0.into())).ok_or_else(fail)?;
        let decor = slot.as_value().map(|old| old.decor().clone());
        *slot = Item::Value(value);
        if let (Some(new), Some(decor)) = (slot.as_value_mut(), decor) {
            *new.decor_mut() = decor;
        }
        Ok(())
    }

    /// The number for a person.
    pub(super) fn says(&self, value: f64) -> String {
        format!("{} = {} {}", self.name, digits(value, 6), self.unit).trim_end().to_owned()
    }
}

/// The number at a path, and its unit.
fn written(file: &DocumentMut, path: &[String]) -> Option<(f64, String)> {
    let mut item = file.as_item();
    for key in path {
        item = match item {
            Item::ArrayOfTables(_) | Item::Value(Value::Array(_)) => item.get(key.parse::<usize>().ok()?)?,
            _ => item.get(key.as_str())?,
        };
    }
    let value = item.as_value()?;
    if let Some(number) = value.as_float().or_else(|| value.as_integer().map(|n| n as f64)) {
        return Some((number, String::new()));
    }
    let (number, unit) = number::split(value.as_str()?)?;
    Some((number, unit.to_owned()))
}

/// The item of a table, made where it is wanting, or of a list.
fn child<'a>(item: &'a mut Item, key: &str, made: impl FnOnce() -> Item) -> Option<&'a mut Item> {
    match item {
        Item::ArrayOfTables(_) | Item::Value(Value::Array(_)) => item.get_mut(key.parse::<usize>().ok()?),
        Item::Table(_) | Item::Value(Value::InlineTable(_)) => {
            let table = item.as_table_like_mut()?;
            if !table.contains_key(key) {
                table.insert(key, made());
            }
            table.get_mut(key)
        }
        _ => None,
    }
}

/// Gives the ball a velocity with a part sideways.
fn sideways(file: &mut DocumentMut, up: f64) {
    let mut velocity = Array::new();
    velocity.push("0 m/s");
    velocity.push(format!("{up} m/s"));
    if let Some(ball) = file.get_mut("ball").and_then(Item::as_table_like_mut) {
        ball.insert("velocity", Item::Value(velocity.into()));
    }
}
