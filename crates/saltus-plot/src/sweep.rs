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
use saltus_scene::vary::{Variation, Vary};

use crate::{Background, Chart, Map, Measure, PlotError, Stroke};

/// The most values of its second key with which a sweep is drawn as lines, and not as a map.
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
    let (what, measure) = measured(name);
    let vary = sweep.vary();
    let chart = match (&vary.variations[..], apart(vary)) {
        ([key], false) => drawn(start(sweep, key, (&what, measure))?, "", points(rows, 0, column)),
        ([key], true) => start(sweep, key, (&what, measure))?.marks(points(rows, 0, column).into_iter().flatten()),
        ([first, second], false) => {
            let counts = [first, second].map(|key| key.count().unwrap_or(0));
            // The key with words, or else with fewer values, makes the lines.
            let lines = usize::from(!first.is_words() && (second.is_words() || counts[1] <= counts[0]));
            let (key, across) = if lines == 0 { (first, second) } else { (second, first) };
            if counts[lines] > MOST_LINES && !key.is_words() {
                map(sweep, rows, column, (&what, measure))?
            } else {
                let mut chart = start(sweep, across, (&what, measure))?;
                for n in 0..counts[lines] {
                    let own = |run: u64| [run / counts[1], run % counts[1]][lines] == n;
                    let rows = (0_u64..).zip(rows).filter(|(run, _)| own(*run)).map(|(_, row)| row);
                    let unit = key.unit().map_or(String::new(), |unit| format!(" {unit}"));
                    let label = format!("{} = {}{unit}", key.key, key.value(n).cell);
                    chart = drawn(chart, &label, points(rows, 1 - lines, column));
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
    match (&vary.variations[..], apart(vary)) {
        ([key], _) => axis(key).map(drop),
        ([first, second], false) if first.is_words() => axis(second).map(drop),
        ([first, _], false) => axis(first).map(drop),
        _ => {
            Err(PlotError::Missing("a picture shows a sweep of one key, or a grid of two: draw others from the table"))
        }
    }
}

/// Whether runs do not follow each other along a key: draws, and the rows of a design.
const fn apart(vary: &Vary) -> bool {
    vary.random.is_some() || vary.rows
}

/// The place of the result among the headings.
fn column(sweep: &Sweep<'_>, rows: &[Row], show: Option<&str>) -> Result<usize, PlotError> {
    let keys = sweep.vary().variations.len();
    let results = || sweep.headers().iter().enumerate().skip(1 + keys);
    let has = |column: usize| rows.iter().any(|row| number(row, column).is_some());
    let found = match show {
        Some(show) => results().find(|(column, name)| *name == show && has(*column)),
        None => TELLING.iter().find_map(|telling| results().find(|(column, name)| name == telling && has(*column))),
    };
    found.map(|(column, _)| column).ok_or_else(|| PlotError::Column {
        asked: show.map(str::to_owned),
        names: results().filter(|(column, _)| has(*column)).map(|(_, name)| name.clone()).collect(),
    })
}

/// The name and the measure of a heading of the table.
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

/// The result of each run at the value of a key, in the order of the values; none where it came to
/// nothing.
fn points<'a>(rows: impl IntoIterator<Item = &'a Row>, key: usize, column: usize) -> Vec<Option<[f64; 2]>> {
    let at = |row: &Row| number(row, key + 1).map(|x| (x, number(row, column)));
    let mut points: Vec<_> = rows.into_iter().filter_map(at).collect();
    points.sort_by(|a, b| a.0.total_cmp(&b.0));
    points.into_iter().map(|(x, y)| Some([x, y?])).collect()
}

fn number(row: &Row, column: usize) -> Option<f64> {
    row.numbers.get(column).copied().flatten()
}

/// A line through points, broken where there is none, with dots where they can be distinguished: a
/// run without neighbours is a dot only.
fn drawn(chart: Chart, label: &str, points: Vec<Option<[f64; 2]>>) -> Chart {
    const DOTS: usize = 60;
    let line = chart.line(label, points.windows(2).filter_map(|pair| Some(Stroke::between(pair[0]?, pair[1]?))));
    let count = points.iter().flatten().count();
    line.dotted(points.into_iter().flatten().filter(|_| count <= DOTS))
}

/// The result in tones over both keys.
fn map(sweep: &Sweep<'_>, rows: &[Row], column: usize, (what, measure): (&str, Measure)) -> Result<Chart, PlotError> {
    let [across, up] = &sweep.vary().variations[..] else { return Err(PlotError::Empty) };
    let [columns, lines] = [across, up].map(|key| key.count().unwrap_or(0));
    let places = |key: &Variation, count: u64| -> Vec<(f64, u64)> {
        let mut places: Vec<_> = (0..count).filter_map(|n| Some((key.value(n).cell.parse().ok()?, n))).collect();
        places.sort_by(|a: &(f64, u64), b| a.0.total_cmp(&b.0));
        places.dedup_by(|a, b| a.0 == b.0);
        places
    };
    let (xs, ys) = (places(across, columns), places(up, lines));
    let of = |i: u64, j: u64| number(rows.get(usize::try_from(i * lines + j).ok()?)?, column);
    let values = ys.iter().flat_map(|(_, j)| xs.iter().map(move |(_, i)| of(*i, *j))).collect();
    let middles = |places: Vec<(f64, u64)>| places.into_iter().map(|(value, _)| value).collect::<Vec<_>>();
    let chart = Chart::new(&title(sweep, what), axis(across)?, axis(up)?).caption(&others(sweep));
    let chart = if across.is_logarithmic() { chart.logarithmic_across() } else { chart };
    let chart = if up.is_logarithmic() { chart.logarithmic() } else { chart };
    Ok(chart.map(Map::new(what, measure, middles(xs), middles(ys), values)))
}
