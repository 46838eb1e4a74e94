//! Many runs of one scene with other values, each as a row of results.

use std::borrow::Cow;
use std::ops::ControlFlow;

pub use crate::cell::{Cell, Cells};
pub use crate::column::{Column, RowFormat};
pub use crate::parts::{Identity, KEY, PLAN, difference, pace, part, parts};
use crate::plan::{Moment, Outcome};
use crate::vary::{Value, Variation, Vary, refused};
use crate::{Error, Run, Scene, Template};

/// The runs of a scene with other values. A row depends on the number of its run alone, so runs may
/// be made in any order and anywhere.
///
/// ```
/// use saltus_scene::sweep::{Cells, RowFormat, Sweep};
/// use saltus_scene::{Run, vary::Vary};
/// let vary = Vary::new(&["restitution=0.5:0.9:5"])?;
/// let toml = b"restitution = 0.8\nball = { height = '1 m' }\n";
/// let sweep = Sweep::new("drop.toml", toml, &vary, Run::default(), RowFormat::Csv, None)?;
/// assert!(sweep.header().starts_with("run,restitution,impacts,first_impact_s,"));
/// let rows: Vec<_> = (0..sweep.runs()).map(|run| sweep.row(run)).collect();
/// assert_eq!(sweep.text(), sweep.header() + &rows.iter().map(|row| row.text.as_str()).collect::<String>());
/// assert!(rows.iter().all(|row| sweep.read(&row.text).as_ref() == Some(row)));
/// assert!(rows.len() == 5 && rows[4].text.starts_with("4,0.9,") && rows[4].why.is_none());
///
/// // By columns.
/// let mut columns = sweep.columns();
/// for run in 0..sweep.runs() {
///     columns.iter_mut().zip(sweep.cells(run)).for_each(|(column, cell)| column.push(cell));
/// }
/// assert_eq!(columns[1], Cells::Numbers(vec![Some(0.5), Some(0.6), Some(0.7), Some(0.8), Some(0.9)]));
/// # Ok::<(), saltus_scene::Error>(())
/// ```
#[derive(Debug)]
pub struct Sweep<'a> {
    template: Template<'a>,
    vary: &'a Vary,
    end: Run,
    runs: u64,
    first: Scene,
    rows: Rows,
}

/// A run as a row.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The line, its end included.
    pub text: String,
    /// The cells that are numbers, in the order of [`Sweep::headers`].
    pub numbers: Vec<Option<f64>>,
    /// The reason why there is no result, if there is none.
    pub why: Option<String>,
}

/// The reason why a run has no outcome.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Nothing {
    /// "refused" for a scene that cannot be run, "failed" for a run that broke.
    pub end: &'static str,
    /// The reason, in one line.
    pub why: String,
}

/// The usual length of a row, in bytes.
const ROW: usize = 200;

impl<'a> Sweep<'a> {
    /// A sweep of the scene `toml`, whose name in messages is `name`; the settings in `run` go
    /// before those of the scene. The rows have `columns`, or all that the scene has.
    ///
    /// # Errors
    /// [`Error`] if a key varies twice, a range has no count, or the first run cannot be planned.
    pub fn new(
        name: &str,
        toml: &'a [u8],
        vary: &'a Vary,
        run: Run,
        format: RowFormat,
        columns: Option<&[Column]>,
    ) -> Result<Self, Error> {
        let (keys, runs) = (vary.keys()?, vary.runs()?);
        let template = Template::parse(name, toml, &keys).map_err(Error::new)?;
        // What is wrong with the first run is wrong with the sweep.
        let values = vary.values(0);
        let refused = |error: &dyn std::fmt::Display| Error::new(format!("run 0, {}: {error}", vary.says(0)));
        let first = made(&template, &values, run).map_err(|error| refused(&error))?;
        first.plan().map_err(|error| refused(&error))?;
        let varied = vary.variations.iter().map(Variation::header).collect();
        let rows = Rows::new(format, varied, columns, &first);
        Ok(Self { template, vary, end: run, runs, first, rows })
    }

    /// The number of runs.
    #[must_use]
    pub const fn runs(&self) -> u64 {
        self.runs
    }

    /// The keys that vary.
    #[must_use]
    pub const fn vary(&self) -> &Vary {
        self.vary
    }

    /// The settings that go before those of the scene.
    pub(crate) const fn end(&self) -> Run {
        self.end
    }

    /// The text of the scene.
    pub(crate) const fn scene(&self) -> &str {
        self.template.text()
    }

    /// The scene of the first run.
    #[must_use]
    pub const fn first(&self) -> &Scene {
        &self.first
    }

    /// The names of all cells, the run's number first.
    #[must_use]
    pub fn headers(&self) -> &[String] {
        &self.rows.headers
    }

    /// The first line, if the format has one.
    #[must_use]
    pub fn header(&self) -> String {
        self.rows.header()
    }

    /// The beginning of the row of a run: its number and its values.
    #[must_use]
    pub fn beginning(&self, run: u64) -> String {
        self.rows.beginning(run)
    }

    /// The outcome of a run, counted from 0.
    ///
    /// # Errors
    /// [`Nothing`]: the scene is refused with these values, or its run failed.
    pub fn outcome(&self, run: u64) -> Result<Outcome, Nothing> {
        self.came(&self.vary.values(run))
    }

    fn came(&self, values: &[Value]) -> Result<Outcome, Nothing> {
        let nothing = |end: &'static str, why: String| Nothing { end, why: why.replace('\n', " ") };
        made(&self.template, values, self.end)
            .map_err(|error| nothing("refused", refused(&error)))
            .and_then(|scene| scene.plan().map_err(|error| nothing("refused", error.to_string())))
            .and_then(|plan| plan.outcome().map_err(|error| nothing("failed", error.to_string())))
    }

    /// The row of a run, counted from 0.
    #[must_use]
    pub fn row(&self, run: u64) -> Row {
        let values = self.vary.values(run);
        let came = self.came(&values);
        let cells = self.rows.row(run, &values, &came);
        let numbers = cells.iter().map(Cell::number).collect();
        Row { text: self.rows.line(&cells), numbers, why: came.err().map(|nothing| nothing.why) }
    }

    /// The cells of a run, counted from 0, in the order of [`Sweep::headers`].
    #[must_use]
    pub fn cells(&self, run: u64) -> Vec<Cell> {
        let values = self.vary.values(run);
        self.rows.row(run, &values, &self.came(&values))
    }

    /// A column without cells for each of [`Sweep::headers`], to be filled from [`Sweep::cells`].
    #[must_use]
    pub fn columns(&self) -> Vec<Cells> {
        let varied = |of: &Variation| if of.is_words() { Cells::WORDS } else { Cells::NUMBERS };
        let mut columns = vec![Cells::COUNTS];
        columns.extend(self.vary.variations.iter().map(varied));
        for &column in &self.rows.columns {
            columns.extend(self.rows.names(column).iter().map(|_| column.cells()));
        }
        columns
    }

    /// A row read back from its line; `None` if the line has other cells than the table.
    #[must_use]
    pub fn read(&self, line: &str) -> Option<Row> {
        let cells = self.rows.cells(line.trim_end())?;
        let number = |cell: &String| cell.parse().ok().filter(|value: &f64| value.is_finite());
        let why = self.headers().iter().position(|name| name == Column::Why.name());
        let why = why.and_then(|why| cells.get(why)).filter(|why| !why.is_empty());
        Some(Row { text: line.to_owned(), numbers: cells.iter().map(number).collect(), why: why.cloned() })
    }

    /// The whole table in memory, its runs made on all cores where `saltus` has its feature
    /// `rayon`.
    #[must_use]
    pub fn text(&self) -> String {
        let mut text = self.header();
        let runs = usize::try_from(self.runs).unwrap_or(usize::MAX);
        let _: ControlFlow<()> = saltus::ensemble(
            0..runs,
            |run| self.row(run as u64).text,
            |_, row| {
                text.push_str(&row);
                ControlFlow::Continue(())
            },
        );
        text
    }
}

/// The scene of a run.
fn made(template: &Template<'_>, values: &[Value], end: Run) -> Result<Scene, crate::SceneError> {
    let values: Vec<&str> = values.iter().map(|value| value.toml.as_str()).collect();
    template.scene(&values, end)
}

/// The rows of a table.
#[derive(Debug)]
struct Rows {
    format: RowFormat,
    columns: Vec<Column>,
    /// Names of all cells, the run's number first.
    headers: Vec<String>,
    dimensions: usize,
    balls: usize,
}

impl Rows {
    /// The table of `columns`, or of all that `scene` has.
    fn new(format: RowFormat, varied: Vec<String>, columns: Option<&[Column]>, scene: &Scene) -> Self {
        let rubs = scene.floors.iter().any(|floor| floor.friction.coefficient() > 0.0);
        let spins = scene.dimensions > 1 && (rubs || scene.balls.iter().any(|ball| ball.spin.is_some()));
        let all = |column: &&Column| **column != Column::Spin || spins;
        let columns = columns.map_or_else(|| Column::ALL.iter().filter(all).copied().collect(), Vec::from);
        let (dimensions, balls) = (scene.dimensions, scene.balls.len());
        let mut rows = Self { format, columns, headers: Vec::new(), dimensions, balls };
        rows.headers.push("run".to_owned());
        rows.headers.extend(varied);
        for column in rows.columns.clone() {
            rows.headers.extend(rows.names(column));
        }
        rows
    }

    /// The first line, if the format has one.
    fn header(&self) -> String {
        match self.format {
            RowFormat::Csv => csv_line(&self.headers),
            RowFormat::Jsonl => String::new(),
        }
    }

    /// The beginning of the row of a run.
    fn beginning(&self, run: u64) -> String {
        match self.format {
            RowFormat::Csv => format!("{run},"),
            RowFormat::Jsonl => format!("{{\"run\":{run},"),
        }
    }

    /// The cells of a line, as many as there are headings.
    fn cells(&self, line: &str) -> Option<Vec<String>> {
        let cells = match self.format {
            RowFormat::Csv => {
                let mut record = csv::StringRecord::new();
                let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(line.as_bytes());
                reader.read_record(&mut record).ok()?;
                record.iter().map(str::to_owned).collect::<Vec<_>>()
            }
            RowFormat::Jsonl => {
                let row: serde_json::Map<String, serde_json::Value> = serde_json::from_str(line).ok()?;
                let text = |value: &serde_json::Value| match value {
                    serde_json::Value::Null => String::new(),
                    serde_json::Value::String(word) => word.clone(),
                    other => other.to_string(),
                };
                self.headers.iter().map(|name| row.get(name).map(text)).collect::<Option<Vec<_>>>()?
            }
        };
        (cells.len() == self.headers.len()).then_some(cells)
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
            _ => return vec![column.name().to_owned()],
        };
        let of = |ball: usize| {
            let name =
                move |part: &&str| if self.balls == 1 { (*part).to_owned() } else { format!("ball.{ball}.{part}") };
            parts.iter().map(name)
        };
        (0..self.balls).flat_map(of).collect()
    }

    /// The row of a run, with `end` and `why` of one that has no outcome.
    fn row(&self, run: u64, values: &[Value], came: &Result<Outcome, Nothing>) -> Vec<Cell> {
        let mut cells = Vec::with_capacity(self.headers.len());
        cells.push(Cell::Count(run));
        let varied = |value: &Value| if value.word { Cell::Word } else { Cell::Written }(value.cell.clone());
        cells.extend(values.iter().map(varied));
        for &column in &self.columns {
            let outcome = match came {
                Ok(outcome) => outcome,
                Err(nothing) => {
                    match column {
                        Column::End => cells.push(Cell::Word(nothing.end.to_owned())),
                        Column::Why => cells.push(Cell::Word(nothing.why.clone())),
                        _ => cells.extend(self.names(column).iter().map(|_| Cell::None)),
                    }
                    continue;
                }
            };
            let cost = outcome.cost;
            cells.push(match column {
                Column::Impacts => Cell::Count(outcome.impacts as u64),
                Column::FirstImpact => outcome.first_impact.into(),
                Column::LastImpact => outcome.last_impact.into(),
                Column::FirstApex => outcome.first_apex.map(|apex| apex.height).into(),
                Column::Rest => outcome.rest.into(),
                Column::End => Cell::Word(outcome.end.name().to_owned()),
                Column::EndTime => Cell::Number(outcome.until),
                Column::Position | Column::Velocity | Column::Spin => {
                    cells.extend(outcome.balls.iter().flat_map(|ball| self.parts(column, ball)));
                    continue;
                }
                Column::Jumps => Cell::Count(cost.jumps as u64),
                Column::Steps => Cell::Count(cost.steps),
                Column::Evaluations => Cell::Count(cost.flows + cost.guards),
                Column::Why => Cell::None,
            });
        }
        cells
    }

    fn parts(&self, column: Column, moment: &Moment) -> impl Iterator<Item = Cell> + use<> {
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

    /// Cells as a line, its end included.
    fn line(&self, cells: &[Cell]) -> String {
        match self.format {
            RowFormat::Csv => csv_line(cells.iter().map(Cell::text)),
            RowFormat::Jsonl => {
                let pairs = self.headers.iter().zip(cells).map(|(name, cell)| {
                    let value = match cell {
                        Cell::Word(word) => Cow::Owned(serde_json::Value::from(word.as_str()).to_string()),
                        number => Some(number.text()).filter(|text| !text.is_empty()).unwrap_or("null".into()),
                    };
                    format!("{}:{value}", serde_json::Value::from(name.as_str()))
                });
                format!("{{{}}}\n", pairs.collect::<Vec<_>>().join(","))
            }
        }
    }
}

/// Cells as a line of CSV.
fn csv_line(cells: impl IntoIterator<Item = impl AsRef<str>>) -> String {
    let mut writer = csv::WriterBuilder::new().buffer_capacity(ROW).from_writer(Vec::with_capacity(ROW));
    let record: csv::StringRecord = cells.into_iter().collect();
    // Memory takes all there is, and text stays text.
    let written = writer.write_record(&record).ok().and_then(|()| writer.into_inner().ok());
    written.and_then(|line| String::from_utf8(line).ok()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Cell, Column, RowFormat, Rows};

    proptest! {
        /// A row is read back as it was written, whatever its names and words are.
        #[test]
        fn rows_are_read_back(
            words in prop::collection::vec("[ -~\"',\r\n\u{0}éß🎾]{0,6}", 2..5),
            name in "[a-z\",\\\\]{1,4}",
        ) {
            for format in [RowFormat::Csv, RowFormat::Jsonl] {
                let headers = (0..words.len()).map(|n| format!("{name}{n}")).collect();
                let rows = Rows { format, columns: Vec::<Column>::new(), headers, dimensions: 1, balls: 1 };
                let cells: Vec<_> = words.iter().cloned().map(Cell::Word).collect();
                prop_assert_eq!(rows.cells(rows.line(&cells).trim_end_matches('\n')), Some(words.clone()));
            }
        }
    }
}
