//! Pictures of sweeps: a result against the keys that vary. Needs the feature `scene`.
//!
//! ```
//! use saltus_plot::sweep;
//! use saltus_scene::sweep::{RowFormat, Sweep};
//! use saltus_scene::{Run, vary::Vary};
//! let vary = Vary::new(&["restitution=0.5:0.9:5"])?;
//! let toml = b"restitution = 0.8\nball = { height = '1 m' }\n";
//! let runs = Sweep::new("drop.toml", toml, &vary, Run::default(), RowFormat::Csv, None)?;
//! let rows: Vec<_> = (0..runs.runs()).map(|run| runs.row(run)).collect();
//! assert!(sweep::svg(&runs, &rows, Some("rest_s"))?.contains("rest (s)"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use saltus_scene::sweep::{Row, Sweep};
use saltus_scene::vary::Variation;

use crate::{Background, Chart, Map, Measure, PlotError, Stroke};

/// With more values than this of its second key a sweep is drawn as a map, and not as so many
/// lines.
const MOST_LINES: u64 = 6;

/// The results that are drawn unless one is chosen: the first that any run has.
const TELLING: [&str; 3] = ["rest_s", "impacts", "end_s"];

/// The result `show`, a heading of the table, against the one or two keys that vary: as a line, as
/// lines of the values of the second key, or as a map of tones. Without `show` it is when all came
/// to rest, or how many impacts there were.
///
/// # Errors
/// [`PlotError::Column`] for a result that the sweep does not have or that is no number,
/// [`PlotError::Missing`] for more than two keys, or for words in place of numbers.
pub fn svg(sweep: &Sweep<'_>, rows: &[Row], show: Option<&str>) -> Result<String, PlotError> {
    check(sweep, show)?;
    let column = column(sweep, rows, show)?;
    let name = &sweep.headers()[column];
    let value = |row: &Row| row.numbers.get(column).copied().flatten();
    let (what, measure) = measured(name);
    let vary = sweep.vary();
    let number = |row: &Row, key: usize| row.numbers.get(key + 1).copied().flatten();
    let chart = match (&vary.variations[..], vary.random) {
        ([key], None) => {
            let points = rows.iter().filter_map(|row| Some([number(row, 0)?, value(row)?])).collect();
            start(sweep, key, (&what, measure))?.line("", joined(rows, &value, 0)?).dotted(few(points))
        }
        ([key], Some(_)) => {
            let points: Vec<_> = rows.iter().filter_map(|row| Some([number(row, 0)?, value(row)?])).collect();
            start(sweep, key, (&what, measure))?.marks(points)
        }
        ([first, second], None) => {
            let counts = [first, second].map(|key| key.count().unwrap_or(0));
            // The key with fewer values, or with words, makes the lines.
            let lines = usize::from(counts[1] <= counts[0] || second.is_words());
            let lines = if first.is_words() { 0 } else { lines };
            let across = [first, second][1 - lines];
            if counts[lines] > MOST_LINES && ![first, second][lines].is_words() {
                map(sweep, rows, &value, (&what, measure))?
            } else {
                let mut chart = start(sweep, across, (&what, measure))?;
                for n in 0..counts[lines] {
                    let own = |run: u64| [run / counts[1], run % counts[1]][lines] == n;
                    let rows: Vec<Row> =
                        (0_u64..).zip(rows).filter(|(run, _)| own(*run)).map(|(_, row)| row.clone()).collect();
                    let key = [first, second][lines];
                    let unit = key.unit().map_or(String::new(), |unit| format!(" {unit}"));
                    let label = format!("{} = {}{unit}", key.key, key.value(n).cell);
                    let points = rows.iter().filter_map(|row| Some([number(row, 1 - lines)?, value(row)?])).collect();
                    chart = chart.line(&label, joined(&rows, &value, 1 - lines)?).dotted(few(points));
                }
                chart
            }
        }
        _ => return Err(PlotError::Empty), // refused by the check
    };
    chart.background(Background::Adaptive).svg()
}

/// Whether a sweep can be drawn, as far as shows before its runs are made.
///
/// # Errors
/// As [`svg`].
pub fn check(sweep: &Sweep<'_>, show: Option<&str>) -> Result<(), PlotError> {
    let vary = sweep.vary();
    let results = || sweep.headers().iter().skip(1 + vary.variations.len());
    if let Some(show) = show.filter(|show| !results().any(|name| name == show)) {
        return Err(PlotError::Column { asked: Some(show.to_owned()), names: results().cloned().collect() });
    }
    match (&vary.variations[..], vary.random) {
        ([key], _) => axis(key).map(drop),
        ([first, second], None) if first.is_words() => axis(second).map(drop),
        ([first, _], None) => axis(first).map(drop),
        _ => {
            Err(PlotError::Missing("a picture shows a sweep of one key, or a grid of two: draw others from the table"))
        }
    }
}

/// The place of the result among the headings.
fn column(sweep: &Sweep<'_>, rows: &[Row], show: Option<&str>) -> Result<usize, PlotError> {
    let keys = sweep.vary().variations.len();
    let results = || sweep.headers().iter().enumerate().skip(1 + keys);
    let has = |column: usize| rows.iter().any(|row| row.numbers.get(column).is_some_and(Option::is_some));
    let found = match show {
        Some(show) => results().find(|(column, name)| *name == show && has(*column)),
        None => TELLING.iter().find_map(|telling| results().find(|(column, name)| name == telling && has(*column))),
    };
    found.map(|(column, _)| column).ok_or_else(|| PlotError::Column {
        asked: show.map(str::to_owned),
        names: results().filter(|(column, _)| has(*column)).map(|(_, name)| name.clone()).collect(),
    })
}

/// What a heading of the table names, and in what.
fn measured(heading: &str) -> (String, Measure) {
    let units = [
        ("_rad_per_s", Measure::Unit("rad/s".into())),
        ("_m_per_s", Measure::Speed),
        ("_s", Measure::Time),
        ("_m", Measure::Length),
    ];
    let unit = units.into_iter().find_map(|(end, measure)| Some((heading.strip_suffix(end)?, measure)));
    let (name, measure) = unit.unwrap_or((heading, Measure::Count));
    (name.replace('_', " "), measure)
}

/// A chart with the axes of a key and of the result.
fn start(sweep: &Sweep<'_>, key: &Variation, (what, measure): (&str, Measure)) -> Result<Chart, PlotError> {
    let chart = Chart::new(&title(sweep, what), axis(key)?, (what, measure)).caption(&others(sweep));
    Ok(if key.is_logarithmic() { chart.logarithmic_across() } else { chart })
}

fn axis(key: &Variation) -> Result<(&str, Measure), PlotError> {
    if key.is_words() {
        return Err(PlotError::Missing(
            "an axis is made of numbers: of words draw a table, or a line each beside numbers",
        ));
    }
    let measure = key.unit().map_or(Measure::Number, |unit| Measure::Unit(unit.to_owned().into()));
    Ok((&key.key, measure))
}

fn title(sweep: &Sweep<'_>, what: &str) -> String {
    let capital = what.chars().next().map_or(String::new(), |c| c.to_uppercase().chain(what.chars().skip(1)).collect());
    let keys: Vec<_> = sweep.vary().variations.iter().map(|key| key.key.as_str()).collect();
    format!("{capital} by {}", keys.join(" and "))
}

fn others(sweep: &Sweep<'_>) -> String {
    let scene = sweep.first();
    let name = scene.picture.title.as_deref().unwrap_or("");
    let runs = sweep.runs();
    if name.is_empty() { format!("{runs} runs") } else { format!("{name}: {runs} runs") }
}

/// Dots where they can be told apart; a run without neighbours is a dot only.
fn few(points: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    const DOTS: usize = 60;
    if points.len() > DOTS { Vec::new() } else { points }
}

/// A line through the results, broken where there is none.
fn joined(rows: &[Row], value: &impl Fn(&Row) -> Option<f64>, key: usize) -> Result<Vec<Stroke>, PlotError> {
    let at = |row: &Row| Some([row.numbers.get(key + 1).copied().flatten()?, value(row)?]);
    let mut rows: Vec<_> = rows.iter().collect();
    let place = |row: &Row| row.numbers.get(key + 1).copied().flatten().unwrap_or(f64::NAN);
    rows.sort_by(|a, b| place(a).total_cmp(&place(b)));
    Ok(rows.windows(2).filter_map(|pair| Some(Stroke::between(at(pair[0])?, at(pair[1])?))).collect())
}

/// The result in tones over both keys.
fn map(
    sweep: &Sweep<'_>,
    rows: &[Row],
    value: &impl Fn(&Row) -> Option<f64>,
    (what, measure): (&str, Measure),
) -> Result<Chart, PlotError> {
    let [across, up] = &sweep.vary().variations[..] else { return Err(PlotError::Empty) };
    let [columns, lines] = [across, up].map(|key| key.count().unwrap_or(0));
    let places = |key: &Variation, count: u64| -> Vec<(f64, u64)> {
        let mut places: Vec<_> = (0..count).filter_map(|n| Some((key.value(n).cell.parse().ok()?, n))).collect();
        places.sort_by(|a: &(f64, u64), b| a.0.total_cmp(&b.0));
        places.dedup_by(|a, b| a.0 == b.0);
        places
    };
    let (xs, ys) = (places(across, columns), places(up, lines));
    let of = |i: u64, j: u64| rows.get(usize::try_from(i * lines + j).ok()?).and_then(value);
    let values = ys.iter().flat_map(|(_, j)| xs.iter().map(move |(_, i)| of(*i, *j))).collect();
    let middles = |places: Vec<(f64, u64)>| places.into_iter().map(|(value, _)| value).collect::<Vec<_>>();
    let chart = Chart::new(&title(sweep, what), axis(across)?, axis(up)?).caption(&others(sweep));
    let chart = if across.is_logarithmic() { chart.logarithmic_across() } else { chart };
    let chart = if up.is_logarithmic() { chart.logarithmic() } else { chart };
    Ok(chart.map(Map::new(what, measure, middles(xs), middles(ys), values)))
}
