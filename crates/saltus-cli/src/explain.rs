//! `saltus explain`: how a scene would be run, and why.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args as ClapArgs;
use saltus_bounce::units::Quantity;
use saltus_scene::plan::{Explanation, ModePlan};
use serde::Serialize;

use crate::cost::{self, Measured};
use crate::error::Error;
use crate::output::write;
use crate::parse::{ReportFormat, positive};
use crate::row::Row;
use crate::scenes::{ending, planned, scene};

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

/// Say how a scene would be run, and why.
///
/// Which effects act and which are left out, how many coordinates are carried, how each mode is
/// advanced (an exact arc, a closed form, an explicit or a stiff stepper), and which edges are
/// watched.
#[derive(Debug, ClapArgs)]
pub(crate) struct Explain {
    /// The scene; `-` for standard input.
    pub(crate) scene: PathBuf,
    /// Run the scene with each effect toggled: what that changes in the first impacts and apexes,
    /// and what it costs.
    #[arg(long)]
    pub(crate) cost: bool,
    /// When to stop these runs, such as `4s`; otherwise when the scene says.
    #[arg(long, value_name = "TIME", value_parser = positive(Quantity::Time), allow_hyphen_values = true)]
    pub(crate) until: Option<f64>,
    /// How to write it; docs/use/simulating.md describes its JSON.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: ReportFormat,
}

pub(crate) fn run(args: &Explain) -> Result<ExitCode, Error> {
    let scene = scene(&args.scene, ending(args.until, None))?;
    let plan = planned(&scene, Some(&args.scene))?;
    let explanation = plan.explain();
    let cost = if args.cost { Some(cost::rows(&scene)?) } else { None };
    let text = match args.format {
        ReportFormat::Text => explanation.to_string() + &cost.map_or_else(String::new, |rows| cost::table(&rows)),
        ReportFormat::Json => json(explanation, cost)?,
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
