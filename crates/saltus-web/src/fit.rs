//! The COR from files.

use saltus_bounce::units::Quantity;
use saltus_fit::{Ball, Fit, ReadOptions, Report, Sound, Table};
use saltus_plot::{PlotError, fit as pictures};
use serde::Deserialize;
use serde_json::{Value, json};

use crate::answer::{Answer, failed};

/// The statements beside the files, as a person writes them: numbers with units.
#[derive(Debug, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub(crate) struct Options {
    height_unit: String,
    time_unit: String,
    drop: String,
    sigma_height: String,
    sigma_time: String,
    sigma_zero: String,
    gravity: String,
    ball: String,
    drag: String,
    column: String,
    sheet: String,
    header: String,
    group: String,
    filter: String,
    fps: String,
    scale: String,
    zero: String,
    direction: String,
    listen: String,
}

/// A picture of a report, where it has one.
type Draw = fn(&Report) -> Option<Result<String, PlotError>>;

/// Those beside that of the motion.
const PICTURES: [(&str, Draw); 2] = [("cor", pictures::cor), ("ladder", pictures::ladder)];

/// The report as JSON, as text, in pictures, and as a scene.
pub(crate) fn answer(files: &[(&str, &[u8])], options: &Options) -> Answer {
    let (read, fit) = (options.read()?, options.fit()?);
    let table = Table::parse_all(files, &read).map_err(|error| {
        let mut data = json!(error);
        data["says"] = error.to_string().into();
        data
    })?;
    let report = fit.run(&table).map_err(|error| failed("fit", error))?;
    let report = fit.advised(&table, report, None).map_err(|error| failed("fit", error))?;
    let motion = pictures::heard(&report, table.sounds());
    let mut drawn = Vec::new();
    for (name, picture) in [("motion", motion)].into_iter().chain(PICTURES.map(|(name, draw)| (name, draw(&report)))) {
        if let Some(picture) = picture.transpose().map_err(|error| failed("picture", error))? {
            drawn.push((name, picture));
        }
    }
    let document = serde_json::to_string_pretty(&report).map_err(|error| failed("report", error))?;
    let answer = json!({
        "report": document + "\n",
        "text": report.to_string(),
        "headline": report.headline(),
        "groups": report.groups().iter().map(group).collect::<Vec<_>>(),
        "points": report.points(),
        "aside": report.left_aside().iter().map(ToString::to_string).collect::<Vec<_>>(),
        "pictures": drawn,
        "scene": report.scene(),
    });
    Ok((answer, Vec::new()))
}

/// A group in a line.
fn group(group: &saltus_fit::Group) -> Value {
    let report = &group.report;
    json!({ "name": group.name, "verdict": report.verdict(), "headline": report.headline(), "reason": report.reason() })
}

/// A value that an option cannot have.
fn wrong(option: &str, says: impl ToString) -> Value {
    json!({ "kind": "option", "option": option, "message": says.to_string() })
}

/// The value of an option, if it is given.
fn given(text: &str) -> Option<&str> {
    Some(text.trim()).filter(|text| !text.is_empty())
}

/// A number above zero with a unit.
fn amount(option: &str, text: &str, quantity: Quantity) -> Result<Option<f64>, Value> {
    let Some(text) = given(text) else { return Ok(None) };
    let value = quantity.parse(text).map_err(|error| wrong(option, error))?;
    if value > 0.0 { Ok(Some(value)) } else { Err(wrong(option, format!("'{text}' is not above zero"))) }
}

/// A bare number.
fn number(option: &str, text: &str) -> Result<Option<f64>, Value> {
    let Some(text) = given(text) else { return Ok(None) };
    let value = text.parse().ok().filter(|value: &f64| value.is_finite());
    value.map(Some).ok_or_else(|| wrong(option, format!("'{text}' is not a number")))
}

/// A unit by name.
fn unit<'a>(option: &str, text: &'a str, quantity: Quantity) -> Result<Option<&'a str>, Value> {
    let Some(name) = given(text) else { return Ok(None) };
    if quantity.scale(name).is_some() || quantity == Quantity::Length && name == "px" {
        return Ok(Some(name));
    }
    let known: Vec<_> = quantity.units().iter().map(|&(name, _)| name).collect();
    Err(wrong(option, format!("'{name}' is not a unit of {quantity}: use one of {}", known.join(", "))))
}

impl Options {
    fn read(&self) -> Result<ReadOptions, Value> {
        let mut options = ReadOptions::default();
        if let Some(name) = unit("height_unit", &self.height_unit, Quantity::Length)? {
            options = options.height_unit(name);
        }
        if let Some(name) = unit("time_unit", &self.time_unit, Quantity::Time)? {
            options = options.time_unit(name);
        }
        if let Some(name) = given(&self.column) {
            options = options.column(name);
        }
        if let Some(name) = given(&self.sheet) {
            options = options.sheet(name);
        }
        if let Some(names) = given(&self.header) {
            options = options.header(&names.split(',').map(str::trim).collect::<Vec<_>>());
        }
        for name in given(&self.group).into_iter().flat_map(|names| names.split(',')) {
            options = options.group(name.trim());
        }
        if let Some(text) = given(&self.filter) {
            let parts = text.split_once('=').filter(|(column, _)| !column.trim().is_empty());
            let (column, value) =
                parts.ok_or_else(|| wrong("filter", format!("'{text}' is not of the form column=value")))?;
            options = options.filter(column.trim(), value.trim());
        }
        if let Some(text) = given(&self.scale) {
            let (length, pixels) = text.split_once('/').unwrap_or((text, "1"));
            let length = amount("scale", length, Quantity::Length)?;
            let pixels = number("scale", pixels)?.filter(|pixels| *pixels > 0.0);
            let scale = length.zip(pixels).map(|(length, pixels)| length / pixels).filter(|scale| scale.is_normal());
            options = options.scale(scale.ok_or_else(|| wrong("scale", format!("'{text}' is not a scale")))?);
        }
        if let Some(zero) = number("zero", &self.zero)? {
            options = options.zero(zero);
        }
        match given(&self.direction) {
            None => {}
            Some("up") => options = options.y_down(false),
            Some("down") => options = options.y_down(true),
            Some(other) => return Err(wrong("direction", format!("'{other}' is neither up nor down"))),
        }
        if let Some(text) = given(&self.listen) {
            options = options.listen(Sound::stretch(text).map_err(|error| wrong("listen", error))?);
        }
        if let Some(drop) = amount("drop", &self.drop, Quantity::Length)? {
            options = options.drop_height(drop);
        }
        if let Some(rate) = number("fps", &self.fps)? {
            let rate = Some(rate).filter(|rate| *rate > 0.0);
            options = options.fps(rate.ok_or_else(|| wrong("fps", "a film has frames in a second"))?);
        }
        Ok(options)
    }

    fn fit(&self) -> Result<Fit, Value> {
        let mut fit = Fit::new();
        if let Some(sigma) = amount("sigma_height", &self.sigma_height, Quantity::Length)? {
            fit = fit.sigma_height(sigma);
        }
        if let Some(sigma) = amount("sigma_time", &self.sigma_time, Quantity::Time)? {
            fit = fit.sigma_time(sigma);
        }
        match given(&self.sigma_zero) {
            Some("0") => fit = fit.sigma_zero(0.0),
            _ => fit = amount("sigma_zero", &self.sigma_zero, Quantity::Length)?.map_or(fit, |s| fit.sigma_zero(s)),
        }
        if let Some(gravity) = amount("gravity", &self.gravity, Quantity::Acceleration)? {
            fit = fit.gravity(gravity);
        }
        if let Some(text) = given(&self.ball) {
            fit = match Ball::named(text) {
                Some(kind) => fit.kind(kind),
                None => amount("ball", text, Quantity::Length)?.map_or(fit, |diameter| fit.ball(diameter)),
            };
        }
        if let Some(drag) = number("drag", &self.drag)? {
            let drag = Some(drag).filter(|drag| *drag >= 0.0);
            fit = fit.drag(drag.ok_or_else(|| wrong("drag", "drag is not below zero"))?);
        }
        Ok(fit)
    }
}
