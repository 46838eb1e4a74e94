//! What the columns are: their kind, their unit, and what to say about a name nobody knows.

use saltus_bounce::units::Quantity;

use super::ReadOptions;
use super::read::{Sheet, shown};
use crate::error::TableError;

/// What a column holds.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    /// `release`, `contact`, `apex`; or a count of contacts.
    Event,
    /// The number of the bounce.
    Bounce,
    /// The time of the event, times the unit.
    Time,
    /// The height of the event.
    Height,
    /// The time between this contact and the next.
    Interval,
    /// The standard error of a time.
    SigmaTime,
    /// The standard error of a height.
    SigmaHeight,
    /// The height of release, which also tells trials apart.
    DropHeight,
    /// A cell that tells repeated trials apart.
    Group,
    /// A cell that tells apart what was tried: ball, surface ...
    Setting,
    /// The readings of one trial, of heights or times.
    Trial(Quantity),
    /// The height of apex `n`, a row being a trial.
    HeightAt(usize),
    /// The time of contact `n`, a row being a trial.
    TimeAt(usize),
    /// Harmless text.
    Ignored,
}

/// A column: its kind, its name, and one unit in SI.
#[derive(Clone, Debug)]
pub(super) struct Column {
    pub(super) kind: Kind,
    pub(super) name: String,
    unit: Unit,
}

/// A unit as a factor, or, where that is exact, as a divisor: 30 cm is 30 / 100 m.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Unit {
    times: f64,
    over: f64,
}

impl Column {
    /// A number of this column in SI units.
    pub(super) fn si(&self, value: f64) -> f64 {
        value * self.unit.times / self.unit.over
    }
}

/// The columns of a sheet and what was noted about them.
#[derive(Debug)]
pub(super) struct Columns {
    pub(super) columns: Vec<Column>,
    pub(super) notes: Vec<String>,
    /// The sheet has no header: its one column starts in the first line.
    pub(super) headerless: bool,
}

const KNOWN: [&str; 11] = [
    "event",
    "bounce",
    "time_s",
    "height_cm",
    "interval_s",
    "time_error_s",
    "height_error_cm",
    "h0_cm",
    "trial",
    "ball",
    "note",
];

const ERROR: &[&str] = &["error", "err", "sigma", "uncertainty", "unc", "sd", "std", "stdev", "se"];
const INTERVAL: &[&str] = &["interval", "intervals", "dt", "delta", "duration", "gap", "period"];
const TIME: &[&str] = &["time", "times", "t", "timestamp", "clock"];
const HEIGHT: &[&str] = &["height", "heights", "h", "y", "z", "altitude", "rebound", "apex", "peak"];
const RELEASE: &[&str] = &["drop", "release", "initial", "start", "released", "dropped"];
const TRIAL: &[&str] =
    &["trial", "run", "drop", "launch", "throw", "series", "repeat", "repetition", "rep", "set", "experiment", "test"];
const BOUNCE: &[&str] = &["bounce", "bounces", "n", "number", "no", "contact", "impact", "index", "hit", "k", "i"];
const EVENT: &[&str] = &["event", "events", "what", "phase"];
const SETTING: &[&str] = &["ball", "surface", "material", "floor", "object", "temperature", "condition"];
const REPEAT: &[&str] = &["group", "person", "sample", "id"];
const IGNORED: &[&str] = &[
    "source",
    "file",
    "filename",
    "comment",
    "comments",
    "note",
    "notes",
    "remark",
    "remarks",
    "observer",
    "date",
    "x",
    "v",
    "vx",
    "vy",
    "a",
    "ax",
    "ay",
    "velocity",
    "speed",
    "acceleration",
];

impl Columns {
    /// Recognises the columns of a sheet.
    pub(super) fn of(sheet: &Sheet<'_>, options: &ReadOptions) -> Result<Self, TableError> {
        let mut found = Self { columns: Vec::new(), notes: Vec::new(), headerless: false };
        if sheet.header.iter().all(|cell| is_number(cell, sheet.decimal_comma()) || cell.is_empty()) {
            return headerless(sheet, options);
        }
        for (index, cell) in sheet.header.iter().enumerate() {
            found.columns.push(column(sheet, options, index, cell)?);
        }
        // With h1, h2 ... beside it, h0 is one of the apexes and a row is a trial.
        if found.columns.iter().any(|c| matches!(c.kind, Kind::HeightAt(_))) {
            for column in found.columns.iter_mut().filter(|c| c.kind == Kind::DropHeight) {
                column.kind = Kind::HeightAt(0);
            }
        }
        let ignored: Vec<&str> = found
            .columns
            .iter()
            .filter(|c| c.kind == Kind::Ignored && !c.name.is_empty())
            .map(|c| c.name.as_str())
            .collect();
        if !ignored.is_empty() {
            found.notes.push(format!("left aside: {}", ignored.join(", ")));
        }
        for kind in [Kind::Time, Kind::Height, Kind::Interval] {
            found.choose(sheet, options, &kind)?;
        }
        if let Some(name) = &options.column
            && !found.columns.iter().any(|c| c.name.eq_ignore_ascii_case(name))
        {
            return Err(TableError::new(sheet.name, format!("there is no column '{name}' to choose"))
                .help(format!("the table has {}", sheet.header.join(", "))));
        }
        for kind in [Kind::Event, Kind::Bounce, Kind::DropHeight, Kind::SigmaTime, Kind::SigmaHeight] {
            if let Some(second) = found.all(&kind).nth(1) {
                let name = &found.columns[second].name;
                return Err(sheet
                    .header_error(second, format!("'{name}' means the same as a column before it"))
                    .help("keep one of the two"));
            }
        }
        Ok(found)
    }

    /// The indices of all columns of a kind.
    pub(super) fn all<'a>(&'a self, kind: &'a Kind) -> impl Iterator<Item = usize> + 'a {
        self.columns.iter().enumerate().filter(move |(_, c)| c.kind == *kind).map(|(n, _)| n)
    }

    /// The index of the column of a kind.
    pub(super) fn one(&self, kind: &Kind) -> Option<usize> {
        self.all(kind).next()
    }

    /// Of several columns with readings of the same thing, keeps the one asked for, else the first, and says so.
    fn choose(&mut self, sheet: &Sheet<'_>, options: &ReadOptions, kind: &Kind) -> Result<(), TableError> {
        let same: Vec<usize> = self.all(kind).collect();
        let wanted = options
            .column
            .as_ref()
            .and_then(|name| same.iter().copied().find(|&n| self.columns[n].name.eq_ignore_ascii_case(name.trim())));
        let Some(&first) = same.first() else { return Ok(()) };
        let kept = wanted.unwrap_or(first);
        for &other in same.iter().filter(|&&n| n != kept) {
            if self.columns[other].name == self.columns[kept].name {
                return Err(sheet
                    .header_error(other, format!("two columns are named '{}'", self.columns[other].name))
                    .help("give each its own name"));
            }
            self.columns[other].kind = Kind::Ignored;
        }
        if same.len() > 1 && wanted.is_none() {
            let others: Vec<&str> =
                same.iter().filter(|&&n| n != kept).map(|&n| self.columns[n].name.as_str()).collect();
            self.notes.push(format!(
                "several columns hold the same readings: took '{}' and not '{}' (choose with --column)",
                self.columns[kept].name,
                others.join("', '")
            ));
        }
        Ok(())
    }
}

fn is_number(cell: &str, decimal_comma: bool) -> bool {
    let plain = if decimal_comma { cell.replace(',', ".") } else { cell.to_owned() };
    plain.parse::<f64>().is_ok()
}

/// A list of bare numbers: fit to read only if the options say what they are.
fn headerless(sheet: &Sheet<'_>, options: &ReadOptions) -> Result<Columns, TableError> {
    let error = |message: &str, help: &str| Err(sheet.header_error(0, message).help(help));
    if sheet.header.len() > 1 {
        return error(
            "the table has no header: its first line is numbers",
            "name the columns in the first line, such as 'bounce,height_cm' or 'time_s,height_m'",
        );
    }
    let (kind, quantity, unit) = match (&options.height_unit, &options.time_unit) {
        (Some(unit), None) => (Kind::Height, Quantity::Length, unit),
        (None, Some(unit)) => (Kind::Time, Quantity::Time, unit),
        _ => {
            return error(
                "the list has no header: are these heights or times, and in which unit?",
                "put a name above it, such as 'height_cm' or 'time_s', or give either --height-unit cm or --time-unit s",
            );
        }
    };
    let unit = option_unit(sheet, quantity, unit)?;
    let column = Column { kind, name: "the list".to_owned(), unit };
    Ok(Columns { columns: vec![column], notes: Vec::new(), headerless: true })
}

/// Splits a header cell into lower-case words and, if there is one, the text in brackets at its end.
fn words(cell: &str) -> (Vec<String>, Option<String>) {
    // Data loggers put the run before the name: 'Latest: Time (s)'.
    let cell = cell.rsplit_once(": ").map_or(cell, |(_, name)| name).to_lowercase();
    let (name, bracket) = match (cell.rfind(['(', '[']), cell.trim_end().ends_with([')', ']'])) {
        (Some(open), true) => {
            let inside = cell[open + 1..].trim_end().trim_end_matches([')', ']']).trim().to_owned();
            (&cell[..open], Some(inside))
        }
        _ => (cell.as_str(), None),
    };
    let words = name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_owned).collect();
    (words, bracket)
}

fn column(sheet: &Sheet<'_>, options: &ReadOptions, index: usize, cell: &str) -> Result<Column, TableError> {
    let (words, bracket) = words(cell);
    let unit_of = |quantity: Quantity| unit(sheet, options, index, cell, quantity, &words, bracket.as_deref());
    let one = Unit { times: 1.0, over: 1.0 };
    let make = |kind, unit| Ok(Column { kind, name: cell.to_owned(), unit });
    let has = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
    let is_unit = |quantity: Quantity| bracket.iter().chain(words.iter().skip(1)).any(|w| quantity.scale(w).is_some());
    let Some(first) = words.first().map(String::as_str) else {
        return if cell.is_empty() { make(Kind::Ignored, one) } else { Err(unknown(sheet, index, cell)) };
    };
    let numbered = words.get(1).and_then(|n| n.parse::<usize>().ok());
    let joined = first.get(1..).and_then(|n| n.parse::<usize>().ok());

    if IGNORED.contains(&first) {
        return make(Kind::Ignored, one);
    }
    if has(ERROR) {
        let length = has(HEIGHT) || (!has(TIME) && !has(INTERVAL) && is_unit(Quantity::Length));
        return if length {
            make(Kind::SigmaHeight, unit_of(Quantity::Length)?)
        } else {
            make(Kind::SigmaTime, unit_of(Quantity::Time)?)
        };
    }
    match (first.get(..1), joined) {
        (Some("h"), Some(0)) => return make(Kind::DropHeight, unit_of(Quantity::Length)?),
        (Some("h"), Some(n)) => return make(Kind::HeightAt(n), unit_of(Quantity::Length)?),
        (Some("t"), Some(n)) => return make(Kind::TimeAt(n), unit_of(Quantity::Time)?),
        _ => {}
    }
    if let (Some(n), true) = (numbered, BOUNCE.contains(&first) || first == "rebound" || first == "apex") {
        return if is_unit(Quantity::Time) {
            make(Kind::TimeAt(n), unit_of(Quantity::Time)?)
        } else {
            make(Kind::HeightAt(n), unit_of(Quantity::Length)?)
        };
    }
    if TRIAL.contains(&first) && words.len() > 1 && numbered.is_some() {
        let quantity = match (is_unit(Quantity::Length), is_unit(Quantity::Time), options) {
            (true, _, _) => Quantity::Length,
            (_, true, _) => Quantity::Time,
            (_, _, ReadOptions { height_unit: Some(_), time_unit: None, .. }) => Quantity::Length,
            (_, _, ReadOptions { height_unit: None, time_unit: Some(_), .. }) => Quantity::Time,
            _ => {
                return Err(sheet
                    .header_error(index, format!("does '{}' hold heights or times, and in which unit?", shown(cell)))
                    .help(format!("write '{cell} (cm)' or '{cell} (s)', or give --height-unit cm or --time-unit s")));
            }
        };
        return make(Kind::Trial(quantity), unit_of(quantity)?);
    }
    if has(RELEASE) && (has(HEIGHT) || is_unit(Quantity::Length)) && !has(&["rebound"]) {
        return make(Kind::DropHeight, unit_of(Quantity::Length)?);
    }
    if has(INTERVAL) {
        return make(Kind::Interval, unit_of(Quantity::Time)?);
    }
    if has(TIME) {
        return make(Kind::Time, unit_of(Quantity::Time)?);
    }
    if TRIAL.contains(&first) || REPEAT.contains(&first) {
        return make(Kind::Group, one);
    }
    if SETTING.contains(&first) {
        return make(Kind::Setting, one);
    }
    if has(HEIGHT) {
        return make(Kind::Height, unit_of(Quantity::Length)?);
    }
    if EVENT.contains(&first) {
        return make(Kind::Event, one);
    }
    if BOUNCE.contains(&first) {
        return make(Kind::Bounce, one);
    }
    Err(unknown(sheet, index, cell))
}

/// The unit of a column: that of its header, else that of the options, else an error.
fn unit(
    sheet: &Sheet<'_>,
    options: &ReadOptions,
    index: usize,
    cell: &str,
    quantity: Quantity,
    words: &[String],
    bracket: Option<&str>,
) -> Result<Unit, TableError> {
    let (given, option) = match quantity {
        Quantity::Time => (&options.time_unit, "--time-unit s"),
        _ => (&options.height_unit, "--height-unit cm"),
    };
    let in_words = || {
        let mut known = words.iter().skip(1).filter(|word| quantity.scale(word).is_some());
        let first = known.next();
        // In 'height in cm' the inch is a preposition.
        if first.is_some_and(|word| word == "in") { known.next().or(first) } else { first }
    };
    if let Some(scale) = bracket.and_then(|inside| quantity.scale(inside)) {
        return Ok(Unit::of(scale));
    }
    if let Some(scale) = in_words().and_then(|word| quantity.scale(word)) {
        return Ok(Unit::of(scale));
    }
    let names: Vec<&str> = quantity.units().iter().map(|(name, _)| *name).collect();
    let other = bracket.into_iter().chain(words.iter().skip(1).map(String::as_str)).find(|word| {
        [Quantity::Time, Quantity::Length, Quantity::Speed].iter().any(|q| q.scale(word).is_some()) || *word == "kg"
    });
    if let Some(wrong) = other.or(bracket.filter(|_| given.is_none())) {
        return Err(sheet
            .header_error(
                index,
                format!("'{}' in '{}' is not a unit of {}", shown(wrong), shown(cell), thing(quantity)),
            )
            .help(format!("use one of {}", names.join(", "))));
    }
    match given {
        Some(unit) => option_unit(sheet, quantity, unit),
        None => {
            let stem = words.first().map_or("height", String::as_str);
            let example = if quantity == Quantity::Time { format!("{stem}_s") } else { format!("{stem}_cm") };
            Err(sheet
                .header_error(index, format!("the column '{}' has no unit", shown(cell)))
                .help(format!("name it '{example}', or give {option}")))
        }
    }
}

fn thing(quantity: Quantity) -> &'static str {
    if quantity == Quantity::Time { "time" } else { "length" }
}

fn option_unit(sheet: &Sheet<'_>, quantity: Quantity, unit: &str) -> Result<Unit, TableError> {
    quantity.scale(unit.trim()).map(Unit::of).ok_or_else(|| {
        let names: Vec<&str> = quantity.units().iter().map(|(name, _)| *name).collect();
        TableError::new(sheet.name, format!("the unit given, '{unit}', is not a unit of {}", thing(quantity)))
            .help(format!("use one of {}", names.join(", ")))
    })
}

impl Unit {
    fn of(scale: f64) -> Self {
        let inverse = (1.0 / scale).round();
        if scale < 1.0 && (inverse * scale - 1.0).abs() < f64::EPSILON {
            Self { times: 1.0, over: inverse }
        } else {
            Self { times: scale, over: 1.0 }
        }
    }
}

fn unknown(sheet: &Sheet<'_>, index: usize, cell: &str) -> TableError {
    let (words, _) = words(cell);
    let lower: String = words.first().map(|w| w.chars().take(64).collect()).unwrap_or_default();
    let nearest = KNOWN
        .iter()
        .map(|known| {
            (distance(&lower, known.split('_').next().unwrap_or(known)).min(distance(&shown(cell), known)), known)
        })
        .min_by_key(|(distance, _)| *distance);
    let hint = match nearest {
        Some((distance, known)) if distance <= 2.max(lower.chars().count() / 3) => format!("did you mean '{known}'? "),
        _ => String::new(),
    };
    sheet
        .header_error(index, format!("the column '{}' is not known", shown(cell)))
        .help(format!("{hint}known are {} and the like; a column of remarks may be named 'note'", KNOWN.join(", ")))
}

/// The number of single-character edits between two words (Levenshtein's distance).
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, x) in a.chars().take(64).enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, &y) in b.iter().enumerate() {
            let next = (diagonal + usize::from(x != y)).min(row[j] + 1).min(row[j + 1] + 1);
            diagonal = std::mem::replace(&mut row[j + 1], next);
        }
    }
    row[b.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_counts_edits() {
        for (a, b, edits) in [("", "", 0), ("hight", "height", 1), ("time", "tiem", 2), ("abc", "", 3)] {
            assert_eq!(distance(a, b), edits, "{a} {b}");
        }
    }

    #[test]
    fn a_header_splits_into_words_and_a_bracket() {
        for (cell, expected, inside) in [
            ("height_cm", vec!["height", "cm"], None),
            ("Height (mm)", vec!["height"], Some("mm")),
            ("time [ms]", vec!["time"], Some("ms")),
            ("Latest: Time (s)", vec!["time"], Some("s")),
            ("time_s_read_by_authors", vec!["time", "s", "read", "by", "authors"], None),
            ("(", vec![], None),
        ] {
            let (words, bracket) = words(cell);
            assert_eq!(words, expected, "{cell}");
            assert_eq!(bracket.as_deref(), inside, "{cell}");
        }
    }
}
