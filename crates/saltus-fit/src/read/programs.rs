//! What programs write: Tracker, `ImageJ`, Vernier, Régressi, Audacity's labels, runs side by side,
//! bare numbers.

mod bare;
mod bodies;
pub(super) mod regressi;

use std::collections::HashSet;

use super::ReadOptions;
use super::aside::{LeftAside, Part, Why};
use super::cell::Cell;
use super::filed;
use super::grid::{Grid, View};
use super::heading::{At, Heading, Meaning, What};
use super::region::{self, Region};
use super::units::{Dimension, Unit};
use super::vocabulary::Atom;
use crate::error::TableError;
use crate::finding::Program;

/// The tables of a text, and what they are.
pub(super) struct Recognised<'a> {
    /// What wrote it, where that shows.
    pub(super) program: Option<Program>,
    pub(super) regions: Vec<Region<'a>>,
    /// The tables are tracks of one film: the ball is what moves.
    pub(super) tracks: bool,
}

impl<'a> From<Vec<Region<'a>>> for Recognised<'a> {
    fn from(regions: Vec<Region<'a>>) -> Self {
        Self { program: None, regions, tracks: false }
    }
}

/// A label of a contact spans no more than this, s.
const LABEL: f64 = 0.2;
/// Recognises the tables of a text; `fps` is the frame rate, by an option or a comment.
pub(super) fn tables<'a>(
    grid: &'a Grid<'a>,
    options: &ReadOptions,
    fps: Option<f64>,
) -> Result<Recognised<'a>, TableError> {
    let view = View { grid, across: false };
    let first = |column: usize| grid.cell(0, column);
    if let Some(names) = &options.header {
        return Ok(vec![given(view, names)].into());
    }
    if first(0).to_lowercase().starts_with("vernier format") {
        return vernier(view);
    }
    if let Some(found) = bodies::tables(view) {
        return Ok(found);
    }
    if first(0).eq_ignore_ascii_case("frame") && position(view, 0, "y1").is_some() {
        return imagej(view, options);
    }
    if let Some(found) = by_hand(view).or_else(|| bare::samples(view)) {
        return Ok(found);
    }
    if let Some(found) = results(view) {
        return Ok(found);
    }
    if let Some(found) = tracker(view, options) {
        return Ok(found);
    }
    if let Some(regions) = labels(view) {
        return Ok(Recognised { program: Some(Program::Labels), regions, tracks: false });
    }
    if numbers(view, 0) {
        let named = || filed::table(view).filter(|_| options.fps.is_none() && options.height_unit.is_none());
        return Ok(vec![named().map_or_else(|| bare::table(view, options, fps), Ok)?].into());
    }
    let found = region::tables(view);
    let found = if found.is_empty() { turned(grid).into_iter().collect() } else { found };
    if let [one] = found.as_slice()
        && let Some(recognised) = side_by_side(one)
    {
        return Ok(recognised);
    }
    Ok(found.into())
}

/// The table whose names stand in the first column, one below the other.
pub(super) fn turned<'a>(grid: &'a Grid<'a>) -> Option<Region<'a>> {
    let found = region::tables(View { grid, across: true });
    // A name says what it is of: numbered rows alone are no names.
    let says = |name: &String| {
        let heading = Heading::parse(name);
        let frames = heading.meaning == Meaning::Frame && heading.has(Atom::Impact);
        frames || heading.energy.is_some() || heading.value().is_some_and(|value| value.what != What::Unsaid)
    };
    // Or a number that bears a unit does.
    let measured = |region: &Region<'_>| {
        let numbered = |name: &String| Heading::parse(name).understood();
        let unit = |cell: Cell| matches!(cell, Cell::Number(m) if m.unit.is_some_and(|unit| unit.dimension != Dimension::Other));
        let cell = |column: usize| region.rows.first().is_some_and(|&row| unit(region.view.read(row, column)));
        region.header.iter().all(numbered) && (0..region.header.len()).all(cell)
    };
    found.into_iter().find(|region| !region.rows.is_empty() && (region.header.iter().any(says) || measured(region)))
}

/// Whether names in the first column bear the units, one of them that of a release or of a speed
/// before a bounce, where the names of columns bear none: those count trials.
pub(super) fn turned_by_units(grid: &Grid<'_>) -> bool {
    let bare = |name: &String| Heading::parse(name).unit.is_none();
    let upright = region::tables(View { grid, across: false });
    let names = turned(grid).filter(|_| upright.iter().all(|region| region.header.iter().all(bare)));
    let place = |name: &String| {
        let heading = Heading::parse(name);
        let read = |unit: Unit| matches!(unit.dimension, Dimension::Length | Dimension::Speed);
        let measured = heading.unit.is_some_and(read);
        heading.value().filter(|_| measured && heading.unknown.is_empty()).map(|value| value.at)
    };
    let begins = |at: &At| matches!(at, At::Release | At::Before);
    let places: Vec<At> = names.iter().flat_map(|region| &region.header).filter_map(place).collect();
    places.iter().any(begins) && !places.iter().all(begins)
}

/// The column of a row with this text.
fn position(view: View<'_>, row: usize, name: &str) -> Option<usize> {
    view.cells(row).position(|cell| cell.eq_ignore_ascii_case(name))
}

/// Whether every cell of a row that holds anything is a number.
fn numbers(view: View<'_>, row: usize) -> bool {
    let bare = |column: usize| {
        let measured = |cell: Cell| match cell {
            Cell::Number(m) => m.unit.is_none_or(|unit| unit.dimension != Dimension::Other),
            other => other == Cell::Lost,
        };
        view.cell(row, column).is_empty() || measured(view.read(row, column))
    };
    (0..view.width(row)).all(bare)
}

/// Names given beside the file, above all rows that hold numbers.
fn given<'a>(view: View<'a>, names: &[String]) -> Region<'a> {
    let header: Vec<String> = names.iter().map(|name| if name == "-" { String::new() } else { name.clone() }).collect();
    let any = |row: usize| (0..view.width(row)).any(|c| view.is_number(row, c));
    let start = usize::from(!any(0));
    Region { given: true, ..Region::new(view, header, 0, (start..view.rows()).collect()) }
}

/// A track of labels as Audacity writes it, `start, end, text` a line without a header: the labels
/// stand at the contacts, or those that say so where another lasts longer than one. What stands
/// before the contacts names several drops, `drop 2 hit 1`.
fn labels(view: View<'_>) -> Option<Vec<Region<'_>>> {
    let label = |row: usize| {
        let text = view.cell(row, 2);
        view.width(row) == 3
            // Labels may count the contacts.
            && (text.is_empty() || text.parse() == Ok(row + 1) || text.starts_with(char::is_alphabetic))
            && view
                .number(row, 0)
                .zip(view.number(row, 1))
                .is_some_and(|(start, end)| start <= end && end - start < LABEL)
    };
    let rows = view.rows();
    let contacts = |row: &usize| {
        let heading = Heading::parse(view.cell(*row, 2));
        heading.unknown.is_empty() && heading.has(Atom::Impact) && !heading.turns()
    };
    let spans = |row: usize| {
        view.width(row) == 3 && view.number(row, 0).zip(view.number(row, 1)).is_some_and(|(start, end)| start <= end)
    };
    let named: Vec<usize> = (0..rows).filter(contacts).collect();
    let some = named.len() > 2 && (0..rows).all(spans) && named.iter().all(|&row| label(row));
    let all = (0..rows).all(label);
    let used = if all { (0..rows).collect() } else { named };
    (view.grid.delimiter == b'\t' && rows > 2 && (some || all)).then(|| {
        let header = vec!["time_s".to_owned(), String::new(), String::new()];
        let mut region = Region { given: true, ..Region::new(view, header, 0, used.clone()) };
        let others = (0..rows).filter(|row| !used.contains(row));
        let aside = |row: usize| LeftAside::new(Part::Row, view.cell(row, 2), Why::Other).at(view.line(row, 0));
        region.aside.extend(others.map(aside));
        let drops = of_drops(view, &used);
        match drops.as_slice() {
            [] | [_] => vec![region],
            _ => drops.into_iter().map(|(label, rows)| Region { label, rows, ..region.clone() }).collect(),
        }
    })
}

/// The rows of each drop by its name, where every label is that and a contact, one drop behind the
/// other; none where they are not.
fn of_drops(view: View<'_>, rows: &[usize]) -> Vec<(String, Vec<usize>)> {
    let contact = |text: &str| {
        let heading = Heading::parse(text);
        heading.unknown.is_empty() && (heading.has(Atom::Impact) || heading.has(Atom::Rebound))
    };
    // `drop 2 hit 1`, `drop2 hit1`, `marble hit 3`, `marble 3`.
    let counted = |rest: &str| rest.trim().parse::<usize>().is_ok();
    let name = |row: &usize| {
        let text = view.cell(*row, 2);
        let mut ends = text.match_indices(' ').map(|(at, _)| text.split_at(at));
        let named = ends.find(|(name, rest)| (contact(rest) || counted(rest)) && !contact(name));
        named.map(|(name, _)| name.to_owned())
    };
    let Some(names) = rows.iter().map(name).collect::<Option<Vec<String>>>() else { return Vec::new() };
    let mut found: Vec<(String, Vec<usize>)> = Vec::new();
    for (name, &row) in names.into_iter().zip(rows) {
        match found.last_mut().filter(|(last, _)| *last == name) {
            Some((_, rows)) => rows.push(row),
            None => found.push((name, vec![row])),
        }
    }
    let apart = (0..found.len()).all(|n| found[..n].iter().all(|(name, _)| *name != found[n].0));
    if apart { found } else { Vec::new() }
}

/// `Frame X1 Y1 Flag1 X2 Y2 Flag2`, a line `Tracks 1 to 2`, frames, and a summary below them.
fn imagej<'a>(view: View<'a>, options: &ReadOptions) -> Result<Recognised<'a>, TableError> {
    let start = 1 + usize::from(view.cell(1, 0).to_lowercase().starts_with("tracks"));
    let frames = |row: &usize| matches!(view.read(*row, 0), Cell::Number(_));
    let rows: Vec<usize> = (start..view.rows()).take_while(frames).collect();
    let asked = |n: usize| options.column.as_ref().is_none_or(|name| name.eq_ignore_ascii_case(&format!("y{n}")));
    let (mut regions, mut aside) = (Vec::new(), Vec::new());
    for (n, column) in
        (1..).map_while(|n| position(view, 0, &format!("y{n}")).map(|column| (n, column))).filter(|(n, _)| asked(*n))
    {
        let label = format!("track {n}");
        if rows.iter().all(|&row| view.cell(row, column).is_empty()) {
            aside.push(LeftAside::new(Part::Track, label, Why::Empty));
            continue;
        }
        let header = picked(view.width(0), &[(0, "frame"), (column, "y")]);
        let units = (None, Some(Unit::PIXEL));
        regions.push(Region { label, units, chosen: true, ..Region::new(view, header, 0, rows.clone()) });
    }
    let Some(first) = regions.first_mut() else {
        let name = options.column.as_deref().unwrap_or_default();
        return Err(TableError::new(view.grid.name, format!("there is no track '{name}' with a place in it"))
            .help(format!("the file has {}", view.cells(0).collect::<Vec<_>>().join(", "))));
    };
    first.aside.append(&mut aside);
    Ok(Recognised { program: Some(Program::ImageJ), regions, tracks: true })
}

/// What `ImageJ` writes of points that were clicked at, one a frame: `Track n°`, `Slice n°`, `X`,
/// `Y` in pixels, and the brightness there, `Pixel Value`. `None` where it is none of it.
fn by_hand(view: View<'_>) -> Option<Recognised<'_>> {
    let begins = |name: &str| view.cells(0).position(|cell| cell.to_lowercase().starts_with(name));
    let (track, frame, y) = (begins("track n")?, begins("slice n")?, position(view, 0, "y")?);
    begins("pixel value")?;
    let rows: Vec<usize> = (1..view.rows()).filter(|&row| view.is_number(row, y)).collect();
    let mut tracks: Vec<&str> = rows.iter().map(|&row| view.cell(row, track)).collect();
    tracks.dedup();
    let region = |name: &&str| {
        let own = rows.iter().copied().filter(|&row| view.cell(row, track) == *name).collect();
        let header = picked(view.width(0), &[(frame, "frame"), (y, "y")]);
        let label = if tracks.len() > 1 { format!("track {name}") } else { String::new() };
        Region { label, units: (None, Some(Unit::PIXEL)), chosen: true, ..Region::new(view, header, 0, own) }
    };
    let regions = tracks.iter().map(region).collect();
    Some(Recognised { program: Some(Program::ImageJ), regions, tracks: true })
}

/// What `ImageJ` measures of lines that were drawn, each as long as the ball was high: `Length`
/// beside the brightness along them, `Mean`, `Min`, `Max`; or of particles, `XM` and `YM` beside
/// `X` and `Y`, a slice each. `None` where it is none of it.
fn results(view: View<'_>) -> Option<Recognised<'_>> {
    let at = |name: &str| position(view, 0, name);
    if let (Some(y), Some(slice), Some(_), Some(_)) = (at("y"), at("slice"), at("xm"), at("ym")) {
        let rows = (1..view.rows()).filter(|&row| view.is_number(row, y)).collect();
        let header = picked(view.width(0), &[(slice, "frame"), (y, "y")]);
        let units = (None, Some(Unit::PIXEL));
        let region = Region { units, chosen: true, ..Region::new(view, header, 0, rows) };
        return Some(Recognised { program: Some(Program::ImageJ), regions: vec![region], tracks: true });
    }
    let grey = ["mean", "min", "max"].iter().all(|name| at(name).is_some());
    let column = at("length").filter(|_| grey)?;
    let rows = (1..view.rows()).filter(|&row| view.is_number(row, column)).collect();
    let header = picked(view.width(0), &[(column, "height")]);
    let units = (None, Some(Unit::PIXEL));
    let region = Region { units, chosen: true, ..Region::new(view, header, 0, rows) };
    Some(Recognised { program: Some(Program::ImageJ), regions: vec![region], tracks: false })
}

/// Names for the columns `chosen`, and none for the others.
fn picked(width: usize, chosen: &[(usize, &str)]) -> Vec<String> {
    let name = |n| chosen.iter().find(|(index, _)| *index == n).map_or(String::new(), |(_, name)| (*name).to_owned());
    (0..width).map(name).collect()
}

/// A line of track names (not always), then `t x y ...` in any order, `x y ...` again for every
/// further track.
fn tracker<'a>(view: View<'a>, options: &ReadOptions) -> Option<Recognised<'a>> {
    let at =
        (0..view.rows().min(3)).find(|&row| view.cell(row, 0) == "t" && view.cells(row).any(|cell| cell == "y"))?;
    // By itself `t,x,y` may be anybody's; a tab or a line of names above it is Tracker's hand.
    if (0..at).any(|row| numbers(view, row)) || (at == 0 && view.grid.delimiter != b'\t') {
        return None;
    }
    let titles: Vec<&str> = if at > 0 { view.cells(at - 1).collect() } else { Vec::new() };
    let mut starts: Vec<(usize, String)> =
        titles.iter().enumerate().filter(|(_, t)| !t.is_empty()).map(|(n, t)| (n.max(1), (*t).to_owned())).collect();
    if starts.is_empty() {
        starts.push((1, String::new()));
    }
    let width = view.width(at);
    let wanted = options.column.as_deref().map(str::trim);
    let track = |(n, (start, label)): (usize, &(usize, String))| {
        let end = starts.get(n + 1).map_or(width, |(next, _)| *next).min(width);
        let find = |name: &str| (*start..end).find(|&n| view.cell(at, n).eq_ignore_ascii_case(name));
        let named = wanted.is_some_and(|name| name.eq_ignore_ascii_case(label));
        let index = if named { find("y") } else { wanted.map_or(find("y"), find) }?;
        let header = picked(width, &[(0, "t"), (index, "y")]);
        let units = (Some(Unit::SECOND), Unit::parse("m"));
        let rows = (at + 1..view.rows()).collect();
        let region = Region { label: label.clone(), units, chosen: true, ..Region::new(view, header, at, rows) };
        Some((named, region))
    };
    let found: Vec<(bool, Region<'a>)> = starts.iter().enumerate().filter_map(track).collect();
    let named = found.iter().any(|(named, _)| *named);
    let regions: Vec<Region<'a>> =
        found.into_iter().filter(|(own, _)| *own || !named).map(|(_, region)| region).collect();
    (!regions.is_empty()).then_some(Recognised { program: Some(Program::Tracker), regions, tracks: true })
}

/// Data sets below one another: a line of the format, one of the source, one of the name; then long
/// names, short names (not always), units; then rows up to one of zeros or the next data set.
fn vernier(view: View<'_>) -> Result<Recognised<'_>, TableError> {
    let begins = |row: usize| view.cell(row, 0).to_lowercase().starts_with("vernier format");
    let starts: Vec<usize> = (0..view.rows()).filter(|&row| begins(row)).collect();
    let mut regions: Vec<Region<'_>> = Vec::new();
    for (n, &start) in starts.iter().enumerate() {
        let end = starts.get(n + 1).copied().unwrap_or(view.rows());
        let Some(first) = (start..end).find(|&row| numbers(view, row)) else { continue };
        let head = first - start;
        if head < 4 {
            return Err(view.error(first, 0, "numbers before the names of their columns").help(VERNIER));
        }
        let names = start + 3;
        let unit = |column: usize| Some(view.cell(first - 1, column)).filter(|u| head > 4 && !u.is_empty());
        let header = (0..view.width(names)).map(|column| {
            let name = view.cell(names, column);
            unit(column).map_or(name.to_owned(), |unit| format!("{name} ({unit})"))
        });
        let zeros = |row: usize| view.width(row) > 1 && view.cells(row).all(|cell| cell.parse() == Ok(0.0));
        let rows = (first..end).take_while(|&row| row == first || !zeros(row)).collect();
        let label = view.cells(start + 2).collect::<Vec<_>>().join(" ").trim().to_owned();
        regions.push(Region { label, ..Region::new(view, header.collect(), names, rows) });
    }
    if regions.is_empty() {
        return Err(TableError::new(view.grid.name, "this Vernier file holds no readings").help(VERNIER));
    }
    if regions.len() > 1 {
        distinct(&mut regions);
    }
    Ok(Recognised { program: Some(Program::Vernier), regions, tracks: false })
}

const VERNIER: &str =
    "its lines are: Vernier Format 2, source, name, column names, short names, units, a blank line, rows";

/// Data sets of the same name are numbered.
fn distinct(regions: &mut [Region<'_>]) {
    let names: HashSet<&str> = regions.iter().map(|region| region.label.as_str()).collect();
    if names.len() < regions.len() {
        for (n, region) in regions.iter_mut().enumerate() {
            region.label = format!("run {}", n + 1);
        }
    }
}

/// A run, or a body, and what is measured of it: where blanks tell them apart a mark within is of
/// the name, `Room:Ball: X`.
fn of_run(cell: &str) -> Option<(&str, &str)> {
    cell.split_once(": ").or_else(|| cell.split_once(':'))
}

/// Runs side by side: `Run 1: Time (s)`, `Run 2: Time (s)`; or the same names again, after a blank
/// column or not.
fn side_by_side<'a>(region: &Region<'a>) -> Option<Recognised<'a>> {
    let header = &region.header;
    let run = |cell: &str| {
        let parts = of_run(cell).filter(|(_, name)| !name.trim().is_empty());
        parts.map_or(String::new(), |(run, _)| run.trim().to_owned())
    };
    let mut runs: Vec<String> = Vec::new();
    for name in header.iter().map(|cell| run(cell)) {
        if !name.is_empty() && !runs.contains(&name) {
            runs.push(name);
        }
    }
    let part = |label: String, mine: &dyn Fn(usize) -> bool| {
        let header = header.iter().enumerate().map(|(n, c)| if mine(n) { c.clone() } else { String::new() });
        Region { label, header: header.collect(), ..region.clone() }
    };
    // `A: drop`, `B: rebound` only count the columns: runs hold the same things.
    let things: Vec<(&str, &str)> = header.iter().filter_map(|cell| of_run(cell)).collect();
    let alike = things.iter().enumerate().any(|(n, (run, name))| {
        things[..n].iter().any(|(other, same)| other.trim() != run.trim() && same.trim() == name.trim())
    });
    if runs.len() > 1 && alike {
        let turned = |name: &String| Heading::parse(name).turns();
        let regions = runs.iter().filter(|name| !turned(name)).map(|name| {
            let mut region = part(name.clone(), &|n| {
                let own = run(&header[n]);
                own.is_empty() || own == *name
            });
            for cell in &mut region.header {
                if let Some((_, own)) = of_run(cell) {
                    *cell = own.trim().to_owned();
                }
            }
            region
        });
        // Bodies that are followed at once have one clock.
        let clock = |cell: &String| {
            let heading = Heading::parse(cell);
            run(cell).is_empty() && (heading.has(Atom::Frame) || heading.value().is_some_and(|v| v.what == What::Time))
        };
        // Before a mark stands whose they are, `Lab:Ball`.
        let trial = |run: &String| {
            let body = Heading::parse(run.rsplit(':').next().unwrap_or(run));
            [Atom::Trial, Atom::Repeat].iter().any(|atom| body.has(*atom))
        };
        let tracks = header.iter().any(clock) && !runs.iter().any(trial);
        return Some(Recognised { program: Some(Program::SideBySide), regions: regions.collect(), tracks });
    }
    let groups = region::repeated(header)?;
    let regions = groups.iter().enumerate().map(|(n, group)| part(format!("run {}", n + 1), &|c| group.contains(&c)));
    Some(Recognised { program: Some(Program::SideBySide), regions: regions.collect(), tracks: false })
}
