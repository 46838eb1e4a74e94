//! `saltus.fit`: a table in, a report out.

use std::path::PathBuf;

use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use saltus_bounce::units::Quantity;
use saltus_fit::{Ball, CorModel, Fit, Loss, ReadOptions, Sound, Table};
use saltus_plot::fit as pictures;

use crate::fail::{self, named};
use crate::signal::patiently;

/// A number in SI units, or text with a unit.
#[derive(FromPyObject)]
pub(crate) enum Amount {
    Number(f64),
    Text(String),
}

impl Amount {
    pub(crate) fn of(&self, quantity: Quantity) -> PyResult<f64> {
        match self {
            Self::Number(value) => Ok(*value),
            Self::Text(text) => quantity.parse(text).map_err(fail::value),
        }
    }
}

/// What may be stated of the table and of the fit; all in SI units.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Options {
    #[pyo3(default)]
    height_unit: Option<String>,
    #[pyo3(default)]
    time_unit: Option<String>,
    #[pyo3(default)]
    column: Option<String>,
    #[pyo3(default)]
    sheet: Option<String>,
    #[pyo3(default)]
    header: Option<Vec<String>>,
    #[pyo3(default)]
    fps: Option<f64>,
    #[pyo3(default)]
    listen: Option<(f64, f64)>,
    #[pyo3(default)]
    scale: Option<Amount>,
    #[pyo3(default)]
    drop: Option<Amount>,
    #[pyo3(default)]
    zero: Option<f64>,
    #[pyo3(default)]
    y_down: Option<bool>,
    #[pyo3(default)]
    group: Option<Vec<String>>,
    #[pyo3(default)]
    filter: Option<Vec<(String, String)>>,
    #[pyo3(default)]
    sigma_height: Option<Amount>,
    #[pyo3(default)]
    sigma_time: Option<Amount>,
    #[pyo3(default)]
    sigma_zero: Option<Amount>,
    #[pyo3(default)]
    sigma_scale: Option<f64>,
    #[pyo3(default)]
    gravity: Option<Amount>,
    #[pyo3(default)]
    drag: Option<f64>,
    #[pyo3(default)]
    ball: Option<Amount>,
    #[pyo3(default)]
    model: Option<String>,
    #[pyo3(default)]
    losses: Option<Vec<String>>,
    #[pyo3(default)]
    repair: Option<bool>,
    #[pyo3(default)]
    profiles: Option<bool>,
    #[pyo3(default)]
    tolerance_height: Option<Amount>,
    #[pyo3(default)]
    tolerance_time: Option<Amount>,
    #[pyo3(default)]
    bootstrap: Option<usize>,
    #[pyo3(default)]
    seed: Option<u64>,
    /// Always there: a dict of nothing at all is no set of options.
    want: Option<f64>,
}

impl Options {
    fn read(&self) -> PyResult<ReadOptions> {
        let mut options = ReadOptions::default();
        for (unit, quantity) in [(&self.height_unit, Quantity::Length), (&self.time_unit, Quantity::Time)] {
            let Some(unit) = unit else { continue };
            let pixels = quantity == Quantity::Length && unit == "px";
            if !pixels && quantity.scale(unit).is_none() {
                let known: Vec<_> = quantity.units().iter().map(|&(name, _)| name).collect();
                return Err(fail::value(format!(
                    "'{unit}' is not a unit of {quantity}: use one of {}",
                    known.join(", ")
                )));
            }
            let length = quantity == Quantity::Length;
            options = if length { options.height_unit(unit) } else { options.time_unit(unit) };
        }
        let with = |options: ReadOptions, text: &Option<String>, set: fn(ReadOptions, &str) -> ReadOptions| match text {
            Some(text) => set(options, text),
            None => options,
        };
        options = with(options, &self.column, |options, name| options.column(name));
        options = with(options, &self.sheet, |options, name| options.sheet(name));
        if let Some(header) = &self.header {
            options = options.header(&header.iter().map(String::as_str).collect::<Vec<_>>());
        }
        if let Some((from, to)) = self.listen {
            if !(from >= 0.0 && from < to) {
                return Err(fail::value(format!(
                    "no part of a sound lasts from {from} s to {to} s: give listen=(0.5, 4)"
                )));
            }
            options = options.listen(from..to);
        }
        if let Some(fps) = self.fps {
            options = options.fps(fps);
        }
        if let Some(scale) = &self.scale {
            options = options.scale(scale.of(Quantity::Length)?);
        }
        if let Some(drop) = &self.drop {
            options = options.drop_height(drop.of(Quantity::Length)?);
        }
        if let Some(zero) = self.zero {
            options = options.zero(zero);
        }
        if let Some(down) = self.y_down {
            options = options.y_down(down);
        }
        for column in self.group.iter().flatten() {
            options = options.group(column);
        }
        for (column, value) in self.filter.iter().flatten() {
            options = options.filter(column, value);
        }
        Ok(options)
    }

    fn fit(&self) -> PyResult<Fit> {
        let losses = self.losses.iter().flatten().map(|name| named(name, "loss", &Loss::ALL, Loss::name));
        let losses = losses.collect::<PyResult<Vec<_>>>()?;
        let mut fit = Fit::new().losses(&losses).repair(self.repair.unwrap_or(true));
        fit = fit.profiles(self.profiles.unwrap_or(false));
        if let Some(model) = &self.model {
            fit = fit.model(named(model, "model of the COR", &CorModel::ALL, CorModel::name)?);
        }
        fit = match &self.ball {
            None => fit,
            Some(Amount::Text(text)) if Ball::named(text).is_some() => Ball::named(text).map_or(fit, |b| fit.kind(b)),
            Some(Amount::Text(text)) if text.trim_start().starts_with(char::is_alphabetic) => {
                return named(text, "ball", &Ball::ALL, Ball::name).map(|ball| fit.kind(ball));
            }
            Some(diameter) => fit.ball(diameter.of(Quantity::Length)?),
        };
        type Set = fn(Fit, f64) -> Fit;
        let amounts: [(&Option<Amount>, Quantity, Set); 6] = [
            (&self.sigma_height, Quantity::Length, Fit::sigma_height),
            (&self.sigma_time, Quantity::Time, Fit::sigma_time),
            (&self.sigma_zero, Quantity::Length, Fit::sigma_zero),
            (&self.gravity, Quantity::Acceleration, Fit::gravity),
            (&self.tolerance_height, Quantity::Length, Fit::tolerance_height),
            (&self.tolerance_time, Quantity::Time, Fit::tolerance_time),
        ];
        for (amount, quantity, set) in amounts {
            if let Some(amount) = amount {
                fit = set(fit, amount.of(quantity)?);
            }
        }
        if let Some(drag) = self.drag {
            fit = fit.drag(drag);
        }
        if let Some(part) = self.sigma_scale {
            fit = fit.sigma_scale(part);
        }
        if let Some(rounds) = self.bootstrap {
            fit = fit.bootstrap(rounds, self.seed.unwrap_or(1));
        }
        Ok(fit)
    }
}

/// Fits the tables at `paths`, the one whose text is `bytes`, or the sound of so many samples a
/// second.
#[pyfunction]
#[pyo3(signature = (options, *, name="table".to_owned(), bytes=None, paths=Vec::new(), sound=None))]
pub(crate) fn fit(
    py: Python<'_>,
    options: Options,
    name: String,
    bytes: Option<Vec<u8>>,
    paths: Vec<PathBuf>,
    sound: Option<(u32, PyReadonlyArray1<'_, f32>)>,
) -> PyResult<Report> {
    let (read, fit, want) = (options.read()?, options.fit()?, options.want);
    let sound = sound.map(|(rate, samples)| (rate, samples.as_array().to_vec()));
    let report = patiently(py, move |wanted| {
        let table = match (bytes, sound) {
            (Some(bytes), _) => Table::parse(&name, &bytes, &read),
            (None, Some((rate, samples))) => Sound::of(&name, rate, &samples).map(Table::from_sound),
            (None, None) => Table::read_all(&paths, &read),
        };
        table.map(|table| {
            let report = fit.run_with(&table, &mut |_| wanted.ask());
            let report = report.and_then(|report| fit.advised(&table, report, want));
            report.map(|report| Report { report, sounds: table.sounds().to_vec() })
        })
    })?;
    report.map_err(|error| fail::table(py, &error))?.map_err(fail::saltus)
}

/// What a unit is of: "length", "time"; `None` for any other.
#[pyfunction]
pub(crate) fn quantity(unit: &str) -> Option<&'static str> {
    let known = [("length", Quantity::Length), ("time", Quantity::Time)];
    known.into_iter().find(|(_, quantity)| quantity.scale(unit).is_some()).map(|(name, _)| name)
}

/// What a fit found.
#[pyclass(frozen, module = "saltus._core")]
pub(crate) struct Report {
    report: saltus_fit::Report,
    /// What its times were read off; not in its JSON.
    sounds: Vec<Sound>,
}

impl From<saltus_fit::Report> for Report {
    fn from(report: saltus_fit::Report) -> Self {
        Self { report, sounds: Vec::new() }
    }
}

#[pymethods]
impl Report {
    /// Read back from JSON.
    #[staticmethod]
    fn from_json(text: &str) -> PyResult<Self> {
        let report: Result<saltus_fit::Report, _> = serde_json::from_str(text);
        report.map(Self::from).map_err(|error| fail::value(format!("this is no report: {error}")))
    }

    fn json(&self) -> PyResult<String> {
        serde_json::to_string_pretty(&self.report).map_err(fail::value)
    }

    /// For people.
    fn text(&self) -> String {
        self.report.to_string()
    }

    /// One of the pictures, as SVG; none where the report has nothing to draw.
    fn picture(&self, kind: &str) -> PyResult<Option<String>> {
        type Draw<'a> = &'a dyn Fn(&saltus_fit::Report) -> Option<Result<String, saltus_plot::PlotError>>;
        let motion = |report: &saltus_fit::Report| pictures::heard(report, &self.sounds);
        let pictures: [(&'static str, Draw<'_>); 4] = [
            ("motion", &motion),
            ("cor", &pictures::cor),
            ("ladder", &pictures::ladder),
            ("profile", &pictures::profile),
        ];
        let (_, draw) = named(kind, "picture of a fit", &pictures, |(name, _)| name)?;
        draw(&self.report).transpose().map_err(fail::saltus)
    }

    /// The fitted motion as a scene.
    fn scene(&self) -> Option<String> {
        self.report.scene()
    }

    /// The groups of the table by name, each with its own report.
    fn groups(&self) -> Vec<(String, Self)> {
        self.report.groups().iter().map(|group| (group.name.clone(), group.report.clone().into())).collect()
    }
}
