//! `saltus explain`: how a scene would be run, and why.

use std::process::ExitCode;

use saltus_scene::plan::{Explanation, ModePlan};
use serde::Serialize;

use crate::args;
use crate::cost::{self, Measured};
use crate::error::Error;
use crate::output::write;
use crate::row::Row;
use crate::simulate::{ending, planned, scene};

/// The number of the JSON contract.
const SCHEMA: u32 = 1;

#[derive(Serialize)]
struct Document<'a> {
    schema: u32,
    model: &'static str,
    effects: &'a [String],
    left_out: Vec<&'static str>,
    coordinates: &'a [String],
    modes: Vec<Mode<'a>>,
    tolerance: Option<f64>,
    notes: &'a [String],
    #[serde(skip_serializing_if = "Option::is_none")]
    cost: Option<Vec<Row<Measured>>>,
}

#[derive(Serialize)]
struct Mode<'a> {
    name: &'static str,
    advance: String,
    solved: bool,
    why: &'static str,
    edges: &'a [String],
}

pub(crate) fn run(args: &args::Explain) -> Result<ExitCode, Error> {
    let scene = scene(&args.scene, ending(args.until, None))?;
    let plan = planned(&scene, Some(&args.scene))?;
    let explanation = plan.explain();
    let cost = if args.cost { Some(cost::rows(&scene)?) } else { None };
    let text = match args.format {
        args::ReportFormat::Text => explanation.to_string() + &cost.map_or_else(String::new, |rows| cost::table(&rows)),
        args::ReportFormat::Json => json(explanation, cost)?,
    };
    write(None, text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

fn mode(mode: &ModePlan) -> Mode<'_> {
    let ModePlan { name, advance, why, ref edges, .. } = *mode;
    Mode { name, advance: advance.to_string(), solved: advance.is_solved(), why, edges }
}

fn json(explanation: &Explanation, cost: Option<Vec<Row<Measured>>>) -> Result<String, Error> {
    let document = Document {
        schema: SCHEMA,
        model: explanation.model.name(),
        effects: &explanation.named,
        left_out: explanation.left_out.iter().map(|effect| effect.name()).collect(),
        coordinates: &explanation.coordinates,
        modes: explanation.modes.iter().map(mode).collect(),
        tolerance: explanation.tolerance,
        notes: &explanation.notes,
        cost,
    };
    Ok(serde_json::to_string_pretty(&document).map_err(Error::new)? + "\n")
}
