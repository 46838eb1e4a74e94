//! A run as a row: what of it a table of many runs wants.

use clap::ValueEnum;
use saltus_scene::Scene;
use saltus_scene::plan::{Moment, Outcome};

use super::args::RowFormat;
use crate::quantity::number;
use crate::vary::Value;

/// A result of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Column {
    /// How many impacts there were.
    #[value(name = "impacts")]
    Impacts,
    /// When the first began.
    #[value(name = "first_impact_s")]
    FirstImpact,
    /// And the last.
    #[value(name = "last_impact_s")]
    LastImpact,
    /// How high the first ball rose after its first impact.
    #[value(name = "first_apex_m")]
    FirstApex,
    /// From when on everything was at rest.
    #[value(name = "rest_s")]
    Rest,
    /// Why the run ended: "time", "jumps", "zeno", "evaluations", "cascade"; or "refused" or "failed", and there was no run.
    #[value(name = "end")]
    End,
    /// When it ended.
    #[value(name = "end_s")]
    EndTime,
    /// Where each ball was then.
    #[value(name = "position")]
    Position,
    /// How fast each ball was then.
    #[value(name = "velocity")]
    Velocity,
    /// How fast each ball turned then.
    #[value(name = "spin")]
    Spin,
    /// How many jumps there were.
    #[value(name = "jumps")]
    Jumps,
    /// How many steps were tried.
    #[value(name = "steps")]
    Steps,
    /// How often flows and guards were evaluated.
    #[value(name = "evaluations")]
    Evaluations,
    /// Why there was no run.
    #[value(name = "why")]
    Why,
}

/// What stands in a cell.
enum Cell {
    None,
    Number(f64),
    /// A number as text.
    Written(String),
    Count(u64),
    Word(String),
}

impl From<Option<f64>> for Cell {
    fn from(value: Option<f64>) -> Self {
        value.map_or(Self::None, Self::Number)
    }
}

/// The rows of a table.
pub(super) struct Rows {
    pub(super) format: RowFormat,
    columns: Vec<Column>,
    /// Names of all cells, the run's number first.
    headers: Vec<String>,
    dimensions: usize,
    balls: usize,
}

impl Rows {
    /// The table of `columns`, or of all that `scene` has.
    pub(super) fn new(format: RowFormat, varied: Vec<String>, columns: Option<&[Column]>, scene: &Scene) -> Self {
        let rubs = scene.floors.iter().any(|floor| floor.friction.coefficient() > 0.0);
        let spins = scene.dimensions > 1 && (rubs || scene.balls.iter().any(|ball| ball.spin.is_some()));
        let all = |column: &&Column| **column != Column::Spin || spins;
        let columns = columns.map_or_else(|| Column::value_variants().iter().filter(all).copied().collect(), Vec::from);
        let (dimensions, balls) = (scene.dimensions, scene.balls.len());
        let mut rows = Self { format, columns, headers: Vec::new(), dimensions, balls };
        rows.headers.push("run".to_owned());
        rows.headers.extend(varied);
        for column in rows.columns.clone() {
            rows.headers.extend(rows.names(column));
        }
        rows
    }

    pub(super) fn headers(&self) -> &[String] {
        &self.headers
    }

    /// The first line, if the format has one.
    pub(super) fn header(&self) -> String {
        match self.format {
            RowFormat::Csv => self.headers.join(",") + "\n",
            RowFormat::Jsonl => String::new(),
        }
    }

    /// What the row of a run begins with.
    pub(super) fn beginning(&self, run: u64) -> String {
        match self.format {
            RowFormat::Csv => format!("{run},"),
            RowFormat::Jsonl => format!("{{\"run\":{run},"),
        }
    }

    fn names(&self, column: Column) -> Vec<String> {
        let parts: &[&str] = match (column, self.dimensions) {
            (Column::Position, 1) => &["height_m"],
            (Column::Position, 2) => &["x_m", "height_m"],
            (Column::Position, _) => &["x_m", "y_m", "height_m"],
            (Column::Velocity, 1) => &["velocity_m_per_s"],
            (Column::Velocity, 2) => &["velocity_x_m_per_s", "velocity_m_per_s"],
            (Column::Velocity, _) => &["velocity_x_m_per_s", "velocity_y_m_per_s", "velocity_m_per_s"],
            (Column::Spin, 1 | 2) => &["spin_rad_per_s"],
            (Column::Spin, _) => &["spin_x_rad_per_s", "spin_y_rad_per_s", "spin_up_rad_per_s"],
            _ => return column.to_possible_value().map(|value| value.get_name().to_owned()).into_iter().collect(),
        };
        let of = |ball: usize| {
            let name =
                move |part: &&str| if self.balls == 1 { (*part).to_owned() } else { format!("ball.{ball}.{part}") };
            parts.iter().map(name)
        };
        (0..self.balls).flat_map(of).collect()
    }

    /// The row of a run, or of one that came to nothing: `end` says how, and `why`.
    pub(super) fn row(&self, run: u64, values: &[Value], came: &Result<Outcome, Nothing>) -> String {
        let mut row = String::with_capacity(200);
        let mut names = self.headers.iter();
        let mut put = |cell: Cell| self.put(&mut row, names.next().map_or("", String::as_str), &cell);
        put(Cell::Count(run));
        for value in values {
            put(if value.word { Cell::Word(value.cell.clone()) } else { Cell::Written(value.cell.clone()) });
        }
        for &column in &self.columns {
            let outcome = match came {
                Ok(outcome) => outcome,
                Err(nothing) => {
                    match column {
                        Column::End => put(Cell::Word(nothing.end.to_owned())),
                        Column::Why => put(Cell::Word(nothing.why.clone())),
                        _ => self.names(column).iter().for_each(|_| put(Cell::None)),
                    }
                    continue;
                }
            };
            let cost = outcome.cost;
            match column {
                Column::Impacts => put(Cell::Count(outcome.impacts as u64)),
                Column::FirstImpact => put(outcome.first_impact.into()),
                Column::LastImpact => put(outcome.last_impact.into()),
                Column::FirstApex => put(outcome.first_apex.map(|apex| apex.height).into()),
                Column::Rest => put(outcome.rest.into()),
                Column::End => put(Cell::Word(outcome.end.name().to_owned())),
                Column::EndTime => put(Cell::Number(outcome.until)),
                Column::Position | Column::Velocity | Column::Spin => {
                    for ball in &outcome.balls {
                        self.parts(column, ball).for_each(&mut put);
                    }
                }
                Column::Jumps => put(Cell::Count(cost.jumps as u64)),
                Column::Steps => put(Cell::Count(cost.steps)),
                Column::Evaluations => put(Cell::Count(cost.flows + cost.guards)),
                Column::Why => put(Cell::None),
            }
        }
        row.push_str(if self.format == RowFormat::Csv { "\n" } else { "}\n" });
        row
    }

    fn parts(&self, column: Column, moment: &Moment) -> impl Iterator<Item = Cell> {
        let spin = column == Column::Spin;
        let vector = match column {
            Column::Position => moment.position,
            Column::Velocity => moment.velocity,
            _ => moment.spin,
        };
        let parts: &[usize] = match (self.dimensions, spin) {
            // In a plane a ball turns about y, against it where the spin is positive.
            (1 | 2, true) => &[1],
            (1, false) => &[2],
            (2, false) => &[0, 2],
            _ => &[0, 1, 2],
        };
        let sign = if spin && self.dimensions < 3 { -1.0 } else { 1.0 };
        parts.iter().map(move |&part| Cell::Number(sign * vector[part]))
    }

    fn put(&self, row: &mut String, name: &str, cell: &Cell) {
        if self.format == RowFormat::Csv {
            if !row.is_empty() {
                row.push(',');
            }
            match cell {
                Cell::None => {}
                Cell::Number(value) => row.push_str(&number(*value)),
                Cell::Written(number) => row.push_str(number),
                Cell::Count(count) => row.push_str(&count.to_string()),
                Cell::Word(word) if word.contains([',', '"', '\n']) => {
                    row.extend(["\"", &word.replace('"', "\"\""), "\""]);
                }
                Cell::Word(word) => row.push_str(word),
            }
            return;
        }
        row.extend([if row.is_empty() { "{\"" } else { ",\"" }, name, "\":"]);
        match cell {
            Cell::None => row.push_str("null"),
            Cell::Number(value) if !value.is_finite() => row.push_str("null"),
            Cell::Number(value) => row.push_str(&number(*value)),
            Cell::Written(number) => row.push_str(number),
            Cell::Count(count) => row.push_str(&count.to_string()),
            Cell::Word(word) => row.push_str(&serde_json::Value::from(word.as_str()).to_string()),
        }
    }
}

/// Why there is no run.
pub(super) struct Nothing {
    /// "refused" for a scene that cannot be run, "failed" for a run that broke.
    pub(super) end: &'static str,
    /// In one line.
    pub(super) why: String,
}
