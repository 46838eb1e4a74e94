//! What the columns are: their kind, their unit, and what to say about a name nobody knows.

use saltus_bounce::units::Quantity;

use super::ReadOptions;
use super::sheet::{Sheet, shown};
use super::units::{self, Unit, is_unit};
use super::vocabulary::{
    AVERAGE, BETWEEN, BOUNCE, ERROR, EVENT, FRAME, HEIGHT, IGNORED, INTERVAL, KNOWN, RELEASE, REPEAT, SETTING, TIME,
    TRIAL, number, of_trial, ordinal,
};
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
    /// A count of frames; it becomes a time, or is ignored.
    Frame,
    /// Harmless text.
    Ignored,
}

/// A column: its kind, its name, its unit, and which way from where it counts.
#[derive(Clone, Debug)]
pub(super) struct Column {
    pub(super) kind: Kind,
    pub(super) name: String,
    pub(super) unit: Unit,
    zero: f64,
    sign: f64,
}

impl Column {
    /// A number of this column in SI units, heights counted upwards from the zero that was given.
    pub(super) fn si(&self, value: f64) -> f64 {
        self.sign * self.unit.si(value - self.zero)
    }

    /// Whether the column holds times, or the heights of something.
    pub(super) fn is_time(&self) -> bool {
        matches!(self.kind, Kind::Time | Kind::Interval | Kind::TimeAt(_) | Kind::Trial(Quantity::Time))
    }

    pub(super) fn is_height(&self) -> bool {
        matches!(self.kind, Kind::Height | Kind::HeightAt(_) | Kind::DropHeight | Kind::Trial(Quantity::Length))
    }

    /// Whether it holds this quantity or its errors.
    fn holds(&self, quantity: Quantity) -> bool {
        match quantity {
            Quantity::Time => self.is_time() || self.kind == Kind::SigmaTime,
            _ => self.is_height() || self.kind == Kind::SigmaHeight,
        }
    }
}

/// The columns of a sheet and what was noted about them.
#[derive(Debug)]
pub(super) struct Columns {
    pub(super) columns: Vec<Column>,
    pub(super) notes: Vec<String>,
    pub(super) warnings: Vec<String>,
    /// Heights are in pixels that nobody has given a scale for.
    pub(super) pixels: bool,
}

impl Columns {
    /// Recognises the columns of a sheet; `fps` is the frame rate, where one is known.
    pub(super) fn of(sheet: &Sheet<'_>, options: &ReadOptions, fps: Option<f64>) -> Result<Self, TableError> {
        let mut found = Self { columns: Vec::new(), notes: Vec::new(), warnings: Vec::new(), pixels: false };
        for (index, cell) in sheet.block.header.iter().enumerate() {
            found.columns.push(column(sheet, options, index, cell)?);
        }
        found.repeats();
        found.drop_trials();
        found.frames(sheet, fps)?;
        // With h1, h2 ... beside it, h0 is one of the apexes and a row is a trial.
        if found.columns.iter().any(|c| matches!(c.kind, Kind::HeightAt(_))) {
            for column in found.columns.iter_mut().filter(|c| c.kind == Kind::DropHeight) {
                column.kind = Kind::HeightAt(0);
            }
        }
        found.stopwatches();
        for column in found.columns.iter_mut().filter(|c| c.is_height()) {
            column.zero = options.zero.unwrap_or(0.0);
            column.sign = if options.down == Some(true) { -1.0 } else { 1.0 };
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
        for quantity in [Quantity::Length, Quantity::Time] {
            found.overrule(sheet, options, quantity)?;
        }
        found.pixels = found.columns.iter().any(|c| c.is_height() && c.unit.pixels);
        if let Some(name) = options.column.as_ref().filter(|_| !sheet.block.chosen)
            && !found.columns.iter().any(|c| c.name.eq_ignore_ascii_case(name))
        {
            return Err(sheet
                .error(format!("there is no column '{name}' to choose"))
                .help(format!("the table has {}", sheet.block.header.join(", "))));
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

    /// A unit that is stated is for columns that name none. Where all of them name one, and another, it can only mean that they are wrong: what
    /// is stated holds, with a warning.
    fn overrule(&mut self, sheet: &Sheet<'_>, options: &ReadOptions, quantity: Quantity) -> Result<(), TableError> {
        let Some((name, unit)) = units::stated(sheet, options, quantity)? else { return Ok(()) };
        let unit = unit.by_name();
        let all: Vec<&mut Column> = self.columns.iter_mut().filter(|c| c.holds(quantity)).collect();
        if !all.iter().all(|c| c.unit.named) {
            return Ok(());
        }
        for column in all.into_iter().filter(|c| c.unit != unit) {
            column.unit = unit;
            self.warnings.push(format!(
                "the numbers of '{}' are taken to be in {name}, as stated, against its name",
                column.name
            ));
        }
        Ok(())
    }

    /// A count of frames is a time, if nothing else is and the frame rate is known.
    fn frames(&mut self, sheet: &Sheet<'_>, fps: Option<f64>) -> Result<(), TableError> {
        let Some(index) = self.one(&Kind::Frame) else { return Ok(()) };
        self.columns[index].kind = Kind::Ignored;
        if self.columns.iter().any(Column::is_time) {
            return Ok(());
        }
        let fps = fps.ok_or_else(|| {
            let name = &sheet.block.header[index];
            sheet
                .header_error(index, format!("the column '{name}' counts frames: how many were filmed in a second?"))
                .help("give the frame rate of the camera, such as --fps 100")
        })?;
        (self.columns[index].kind, self.columns[index].unit) = (Kind::Time, Unit::frame(fps));
        Ok(())
    }

    /// Nobody averages a bounce and the next: in `drop,height 1,height 2,average` they are repeats.
    fn repeats(&mut self) {
        let averaged = |c: &Column| words(&c.name).0.first().is_some_and(|word| AVERAGE.contains(&word.as_str()));
        if self.columns.iter().any(averaged) && self.columns.iter().any(|c| c.kind == Kind::DropHeight) {
            for column in self.columns.iter_mut().filter(|c| matches!(c.kind, Kind::HeightAt(_))) {
                column.kind = Kind::Trial(Quantity::Length);
            }
        }
    }

    /// In `drop,trial 1 (cm),trial 2 (cm)` the drop is a height as the trials are, not their number.
    fn drop_trials(&mut self) {
        let trial = self.columns.iter().find(|c| c.kind == Kind::Trial(Quantity::Length));
        let Some(unit) = trial.map(|trial| trial.unit) else { return };
        let is_drop = |c: &Column| c.kind == Kind::Group && words(&c.name).0 == ["drop"];
        if let Some(drop) = self.columns.iter_mut().find(|c| is_drop(c)) {
            (drop.kind, drop.unit) = (Kind::DropHeight, unit);
        }
    }

    /// What belongs to stopwatches: `H,T0,T1,T2`, and the heights that phyphox computes from the times.
    fn stopwatches(&mut self) {
        if !self.columns.iter().any(|c| matches!(c.kind, Kind::TimeAt(_))) {
            return;
        }
        let computed = self.columns.iter().any(|c| c.name.to_lowercase().starts_with("energy"));
        let heights = self.columns.iter().any(|c| matches!(c.kind, Kind::HeightAt(_)));
        for column in &mut self.columns {
            match column.kind {
                Kind::HeightAt(_) if computed => column.kind = Kind::Ignored,
                Kind::Height if !heights => column.kind = Kind::DropHeight,
                _ => {}
            }
        }
        if computed && heights {
            self.notes.push("heights were left aside: phyphox computes them from the times".to_owned());
        }
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

/// Splits a header cell into lower-case words and, if there is one, the text in brackets at its end.
fn words(cell: &str) -> (Vec<String>, Option<String>) {
    // Data loggers put the run before the name: 'Latest: Time (s)'.
    let name = cell.split(['(', '[']).next().unwrap_or_default();
    let cell = cell[name.rfind(':').map_or(0, |colon| colon + 1)..].to_lowercase();
    let (name, bracket) = match (cell.rfind(['(', '[']), cell.trim_end().ends_with([')', ']'])) {
        (Some(open), true) => {
            let inside = cell[open + 1..].trim_end().trim_end_matches([')', ']']).trim();
            // The unit of `(± 0.5 cm)`.
            let bare = inside.strip_prefix('±').or(inside.strip_prefix("+/-"));
            let inside =
                bare.map_or(inside, |b| b.trim_start_matches(|c: char| c.is_ascii_digit() || " .,".contains(c)));
            (&cell[..open], Some(inside.to_owned()).filter(|inside| bare.is_none() || !inside.is_empty()))
        }
        _ => (cell.as_str(), None),
    };
    let mut words: Vec<String> =
        name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).map(str::to_owned).collect();
    // `2nd bounce` is `bounce 2`.
    if let Some(n) = words.first().and_then(|word| ordinal(word)).filter(|_| words.len() > 1) {
        words[0] = n.to_string();
        words.swap(0, 1);
    }
    (words, bracket)
}

/// Whether a name is that of one of several trials, such as `trial 2 (cm)`.
fn is_trial(cell: &str) -> bool {
    let (words, _) = words(cell);
    words.first().is_some_and(|word| TRIAL.contains(&word.as_str()))
        && words.get(1).is_some_and(|n| of_trial(n).is_some())
}

/// The number of the bounce that a longer name ends in: `height after 2nd bounce`, `height after bounce 2`.
fn bounce_named(words: &[String]) -> Option<usize> {
    let of = |word: &String| BOUNCE.contains(&word.as_str());
    let pair = words.get(1..)?.windows(2).find_map(|pair| match (of(&pair[0]), of(&pair[1])) {
        (true, _) => number(&pair[1]),
        (_, true) => ordinal(&pair[0]),
        _ => None,
    });
    pair.filter(|n| *n > 0)
}

/// Whether a name is that of one of several bounces or repeats, such as `height 2 (cm)`.
fn is_numbered(cell: &str) -> bool {
    let (words, _) = words(cell);
    let of = |word: &String| HEIGHT.contains(&word.as_str()) || BOUNCE.contains(&word.as_str());
    words.first().is_some_and(of) && words.get(1).is_some_and(|n| number(n).is_some())
}

fn column(sheet: &Sheet<'_>, options: &ReadOptions, index: usize, cell: &str) -> Result<Column, TableError> {
    let (words, bracket) = words(cell);
    let unit_of = |quantity: Quantity| units::unit(sheet, options, index, quantity, &words, bracket.as_deref());
    let one = Unit::ONE;
    let make = |kind, unit| Ok(Column { kind, name: cell.to_owned(), unit, zero: 0.0, sign: 1.0 });
    let has = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
    let is_unit = |quantity: Quantity| bracket.iter().chain(words.iter().skip(1)).any(|w| is_unit(quantity, w));
    let Some(first) = words.first().map(String::as_str) else {
        return if cell.is_empty() { make(Kind::Ignored, one) } else { Err(unknown(sheet, index, cell)) };
    };
    let numbered = words.get(1).and_then(|n| number(n));
    let joined = first.get(1..).and_then(number);

    let beside_trials = || sheet.block.header.iter().any(|cell| is_trial(cell) || is_numbered(cell));
    if AVERAGE.contains(&first) && beside_trials() {
        return make(Kind::Ignored, one);
    }
    if FRAME.contains(&first) && words.len() < 3 {
        return make(Kind::Frame, one);
    }
    if IGNORED.contains(&first) || words.iter().any(|word| word == "x") {
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
    let of_bounce = || bounce_named(&words).filter(|_| !has(RELEASE) && !has(TRIAL) && !has(INTERVAL));
    if let Some(n) = numbered.filter(|_| BOUNCE.contains(&first) || HEIGHT.contains(&first)).or_else(of_bounce) {
        return if is_unit(Quantity::Time) {
            make(Kind::TimeAt(n), unit_of(Quantity::Time)?)
        } else {
            make(Kind::HeightAt(n), unit_of(Quantity::Length)?)
        };
    }
    if is_trial(&words[..2.min(words.len())].join(" ")) {
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
    if has(INTERVAL) || has(TIME) && has(BETWEEN) {
        return make(Kind::Interval, unit_of(Quantity::Time)?);
    }
    if has(TIME) {
        return make(Kind::Time, unit_of(Quantity::Time)?);
    }
    if TRIAL.contains(&first) || REPEAT.contains(&first) {
        return make(Kind::Group, one);
    }
    if SETTING.contains(&first) && !(has(HEIGHT) && is_unit(Quantity::Length)) {
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

fn unknown(sheet: &Sheet<'_>, index: usize, cell: &str) -> TableError {
    let (words, _) = words(cell);
    let lower: String = words.first().map(|w| w.chars().take(64).collect()).unwrap_or_default();
    let nearest = KNOWN
        .iter()
        .map(|known| {
            (distance(&lower, known.split('_').next().unwrap_or(known)).min(distance(&shown(cell), known)), known)
        })
        .min_by_key(|(distance, _)| *distance);
    if cell.trim().parse::<f64>().is_ok() {
        return sheet
            .header_error(index, format!("'{}' is no name of a column: the first line has to name them", shown(cell)))
            .help("write such as 'bounce,height_cm' above the numbers, or give it by --header; readings stand below one another");
    }
    let hint = match nearest {
        Some((distance, known)) if distance <= 2.max(lower.chars().count() / 3) => format!("did you mean '{known}'? "),
        _ => String::new(),
    };
    sheet.header_error(index, format!("the column '{}' is not known", shown(cell))).help(format!(
        "{hint}known are {} and the like; other names may be given by --header, '-' for a column to leave aside",
        KNOWN.join(", ")
    ))
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
            ("height (±0.5 cm)", vec!["height"], Some("cm")),
            ("2nd bounce height", vec!["bounce", "2", "height"], None),
            ("(", vec![], None),
        ] {
            let (words, bracket) = words(cell);
            assert_eq!(words, expected, "{cell}");
            assert_eq!(bracket.as_deref(), inside, "{cell}");
        }
    }
}
