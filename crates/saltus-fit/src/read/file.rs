//! From the bytes of a file to a table: what kind of file, which tables in it, their trials
//! together.

use std::borrow::Cow;

use super::alarms;
use super::aside::{LeftAside, Part as Kind, Why};
use super::clause;
use super::columns::{Column, Columns, Kind as Of};
use super::datum::Datum;
use super::digits;
use super::foreign;
use super::grid::{Grid, View};
use super::heading::{Heading, What};
use super::heard;
use super::json;
use super::phrases::Phrase;
use super::programs::{self, Recognised};
use super::region::{self, Region};
use super::rows::sifted;
use super::sensed;
use super::sheet::{Content, Part};
use super::text::{self, text};
use super::title::{self, Stated};
use super::tracks;
use super::vocabulary::{Atom, folded};
use super::workbook;
use super::{Event, Metadata, ReadOptions, Reading, Table, against, assemble, check, computed, pool, said, sports};
use crate::error::TableError;
use crate::finding::{Doubt, Note};
use crate::statistics::FILMED;

/// Reads `bytes` into a table that is not yet checked.
pub(super) fn table(name: &str, bytes: &[u8], options: &ReadOptions) -> Result<Table, TableError> {
    if let Some(heard) = heard::of_bytes(name, bytes, options) {
        return heard;
    }
    if options.listen.is_some() {
        return Err(
            TableError::new(name, "this file is no sound: there is nothing to listen to").help("leave out --listen")
        );
    }
    if let Some(parts) = json::parts(bytes).filter(|_| foreign::of_records(name, bytes)) {
        return sheets(name, parts, options).map(|table| Table { name: name.to_owned(), ..table });
    }
    if let Some(error) = foreign::refused(name, bytes) {
        return Err(error);
    }
    let mut table = match workbook::parts(name, bytes) {
        Some(parts) => sheets(name, parts?, options)?,
        None => {
            let found = text(name, bytes)?;
            if let Some(parts) = foreign::html(&found.text) {
                return sheets(name, parts, options).map(|table| Table { name: name.to_owned(), ..table });
            }
            if options.sheet.is_some() {
                return Err(TableError::new(name, "this file has no sheets: it is a text").help("leave out --sheet"));
            }
            let mut table = read(&Grid::open(name, None, &found.text)?, options, None)?;
            table.notes.extend(found.encoding.map(|encoding| Note::Encoded { encoding: encoding.to_owned() }.into()));
            table
        }
    };
    table.name = name.to_owned();
    Ok(table)
}

/// Reads all tables of a grid together; `noted` is the height of release that another sheet states.
fn read(grid: &Grid<'_>, options: &ReadOptions, noted: Option<f64>) -> Result<Table, TableError> {
    let mut metadata = Metadata { noted, ..grid.metadata()? };
    metadata.frame_rate = options.fps.or(metadata.frame_rate);
    metadata.drop = options.drop.or(metadata.drop);
    metadata.oriented = options.down.is_some();
    let Recognised { program, regions, tracks } = programs::tables(grid, options, metadata.frame_rate)?;
    // Names that stand in the first column, one below the other.
    let turnable = program.is_none() && options.header.is_none();
    let turned = || joined_up(grid, vec![programs::turned(grid)?], false, options, metadata).ok();
    let first = if turnable && programs::turned_by_units(grid) { turned() } else { None };
    let found = match first {
        Some(table) => Ok(table),
        None if regions.is_empty() => lacking(grid, options, metadata),
        None => joined_up(grid, regions, tracks, options, metadata),
    };
    let found = match found {
        Err(error) if turnable => turned().ok_or(error),
        found => found,
    };
    let mut table = found?;
    table.notes.extend(grid.grouped.clone().map(|cell| Note::Thousands { cell }.into()));
    if let Some(program) = program {
        table.notes.insert(0, Note::Recognised { program }.into());
    }
    Ok(table)
}

/// The tables of a grid, one by one and then together.
fn joined_up<'a>(
    grid: &'a Grid<'a>,
    mut regions: Vec<Region<'a>>,
    tracks: bool,
    options: &ReadOptions,
    mut metadata: Metadata,
) -> Result<Table, TableError> {
    let mut titles: Vec<Stated> = regions.iter().map(title::stated).collect();
    // Of tables of the same names the first may state what holds for all.
    for n in 1..regions.len() {
        if regions[n].header == regions[0].header {
            titles[n] = std::mem::take(&mut titles[n]).below(&titles[0]);
        }
    }
    // A film is of one rate; above each table its own height of release may stand.
    let mut stated = Vec::new();
    let name = grid.called();
    let units = title::named(&name);
    let called = || Some((clause::frame_rate(&name)?, None));
    let said = || titles.iter().find_map(|title| title.fps).map(|(fps, line)| (fps, Some(line)));
    if metadata.frame_rate.is_none()
        && let Some((fps, line)) = said().or_else(called)
    {
        metadata.frame_rate = Some(fps);
        stated.push(Note::Rate { rate: fps, line }.into());
    }
    filmed(&mut regions, metadata.frame_rate);
    let remarks = alarms::remarks(grid, &regions);
    let (mut parts, mut failed, mut nothing, mut aside) = (Vec::new(), None, None, Vec::new());
    for n in 0..regions.len() {
        let (region, title) = (&mut regions[n], &titles[n]);
        let own = Metadata {
            drop: metadata.drop.or(title.drop.as_ref().map(|(drop, _)| drop.metres())).or(metadata.noted),
            sigma_height: metadata.sigma_height.or(title.sigma.0),
            sigma_time: metadata.sigma_time.or(title.sigma.1),
            ..metadata
        };
        let said = (title.units.0.or(units.0), title.units.1.or(units.1));
        region.units = (region.units.0.or(said.0), region.units.1.or(said.1));
        region.speed = title.speed.filter(|_| region.units == (None, None));
        region.drop = title.drop.as_ref().map(|(drop, _)| drop.clone());
        // Whoever states the zero or the height of release answers it.
        let answered = options.zero.or(options.drop).is_some();
        let datum = title.datum.clone().filter(|_| options.zero.is_none()).map(|datum| datum.beside(own.drop));
        region.zero = datum.as_ref().and_then(Datum::zero);
        match one(region, options, own) {
            Ok(mut table) => {
                title::doubted(region, &mut table);
                // A recording tells where its floor is, and times need none.
                let placed = |r: &Reading| r.height.is_some() && r.event != Event::Sample;
                let placed = !table.metadata.speeds && table.trials.iter().any(|t| t.readings.iter().any(placed));
                table.doubts.extend(datum.filter(|_| placed).and_then(Datum::doubt));
                table.doubts.extend(title::unmet(title, &table).filter(|_| !answered && placed));
                table.doubts.extend(alarms::doubt((n, &regions[n]), &table, &remarks));
                parts.push((regions[n].label.clone(), table));
            }
            // A table beside another, of something else.
            Err(error) if n > 0 && error.is_of_nothing() || !measures(&regions[n]) => {
                let text = regions[n].header.join(" ");
                let left = LeftAside::new(Kind::Text, super::grid::shown(&text), Why::NoTable);
                aside.push(left.at(grid.line(regions[n].header_row)));
                nothing = nothing.or(Some(error));
            }
            Err(error) => failed = failed.or(Some(error)),
        }
    }
    if let Some(error) = failed.or(nothing.filter(|_| parts.is_empty())) {
        return Err(error);
    }
    // Means of the drops of another table of the text, and ratios of its heights, follow from it.
    let derived = pool::measured(&mut parts, |(_, table)| table);
    let lines = derived.iter().filter_map(|(_, table)| Some(table.trials.first()?.readings.first()?.line));
    for line in lines {
        let of = regions.iter().find(|region| region.rows.iter().any(|&row| region.view.line(row, 0) == line));
        let name = of.map_or_else(String::new, |region| super::grid::shown(&region.header.join(" ")));
        aside.push(LeftAside::new(Kind::Text, name, Why::Derived).at(line));
    }
    named(&regions, &titles, &mut parts);
    let still = if tracks { tracks::leave_still(&mut parts) } else { Vec::new() };
    if tracks && tracks::at_once(&parts) {
        pool::told_apart(&mut parts, true);
    }
    let mut table = pool::join(grid.name, parts)?;
    table.left_aside.extend(aside);
    table.notes.extend(stated);
    if !still.is_empty() {
        let named = |name: &String| LeftAside::new(Kind::Track, name.as_str(), Why::Still);
        table.left_aside.extend(still.iter().map(named));
        table.notes.push(Note::Still { tracks: still }.into());
    }
    alarms::leave(&mut table);
    Ok(table)
}

/// Whether a heading of a table names a quantity or a unit: `Item, Quantity` are of anything.
fn measures(region: &Region<'_>) -> bool {
    let named = |h: &Heading| h.unit.is_some() || h.value().is_some_and(|v| v.what != What::Unsaid);
    region.header.iter().any(|name| named(&Heading::parse(name)))
}

/// What tables of one text are called: by themselves, by the lines above them, or by their number;
/// balls and surfaces are groups.
fn named(regions: &[Region<'_>], titles: &[Stated], parts: &mut [(String, Table)]) {
    if parts.len() < 2 {
        return;
    }
    let unnamed = parts.iter().all(|(label, _)| label.is_empty());
    if unnamed && parts.len() == regions.len() {
        let own: Vec<&str> = titles.iter().map(|title| title.name.as_str()).collect();
        let apart = own.iter().all(|name| !name.is_empty() && own.iter().filter(|other| *other == name).count() == 1);
        for ((label, _), name) in parts.iter_mut().zip(own).filter(|_| apart) {
            name.clone_into(label);
        }
    }
    // Tracks of one film are named by what moves.
    if regions.iter().all(|region| !region.chosen) {
        pool::told_apart(parts, false);
    }
    for (n, (label, _)) in parts.iter_mut().enumerate().filter(|(_, (label, _))| label.is_empty()) {
        *label = format!("run {}", n + 1);
    }
}

/// The table of a region: its bounces, or what a sensor felt of them, where nothing says that its
/// readings are of bounces.
fn one(region: &mut Region<'_>, options: &ReadOptions, metadata: Metadata) -> Result<Table, TableError> {
    let felt = |region: &Region<'_>| sensed::table(region, options, metadata);
    if let Some(table) = sensed::shows(region).then(|| felt(region)).flatten() {
        return Ok(table);
    }
    let rows = region.rows.clone();
    let said = |table: &Table| !table.doubts.iter().any(|doubt| matches!(doubt, Doubt::Unsaid { .. }));
    match bounces(region, options, metadata) {
        Ok(table) if said(&table) => Ok(table),
        other => felt(&Region { rows, ..region.clone() }).map_or(other, Ok),
    }
}

/// The table of a region of bounces: its columns by their names, the rows that hold readings, the
/// quantities, and then the trials.
fn bounces(region: &mut Region<'_>, options: &ReadOptions, metadata: Metadata) -> Result<Table, TableError> {
    let mut columns = Columns::named(region, options, metadata.drop.is_some())?;
    let rows = sifted(region, &columns)?;
    region.rows = rows.rows.iter().map(|row| row.at).collect();
    let any = columns.any_rate(region, options).filter(|_| metadata.frame_rate.is_none());
    columns.measure(region, options, (metadata.frame_rate, any))?;
    columns.losses(metadata.drop);
    said::released(region, &columns)?;
    let averaged = said::averaged(region, &columns);
    let doubts = [
        said::unsaid(region, &columns, options),
        said::mixed_units(region, &columns),
        against::no_fall(region, &columns),
        said::of_another_motion(region, &columns),
        said::rival(region, &columns, options),
        against::of_two_ends(region, &columns),
        said::oblique(&columns),
        against::repeated(region, &columns),
    ];
    let frame_rate = metadata.frame_rate.or(any).filter(|rate| *rate <= FILMED);
    let mut table = assemble::table(region, &mut columns, rows, options, Metadata { frame_rate, ..metadata })?;
    sports::of_one_ball(region, &mut table);
    table.metadata.averaged = averaged;
    table.metadata.ratios = columns.of_ratios();
    table.metadata.speeds = columns.of_speeds();
    table.doubts.extend(doubts.into_iter().flatten().chain(columns.doubts).chain(check::copied(&table.trials)));
    // What stands for a height, a part or an energy, has a factor of its own.
    let stands = |c: &Column| matches!(c.kind, Of::Share | Of::Lost) || c.heading.energy.is_some();
    if !columns.columns.iter().any(stands) {
        table.doubts.extend(computed::doubt(&table, said::texts(region)));
    }
    Ok(table)
}

/// Places without a clock are a film, a row a frame, if the frame rate is known.
fn filmed(regions: &mut [Region<'_>], fps: Option<f64>) {
    let Some(fps) = fps else { return };
    for region in regions {
        let headings: Vec<Heading> = region.header.iter().map(|text| Heading::parse(text)).collect();
        let place = headings.iter().any(|h| h.value().is_some_and(|v| v.position));
        let keyed = headings.iter().any(|h| {
            h.has(Atom::Time)
                || h.has(Atom::Frame)
                || h.has(Atom::Number)
                || h.has(Atom::Impact)
                || h.has(Atom::Event)
                || h.has(Atom::Release)
        });
        region.frames |= place && !keyed;
        region.frame = Some(1.0 / fps);
    }
}

/// No table was found whose names are understood: the header that comes nearest is read where a
/// word alone is not, or tells why.
fn lacking(grid: &Grid<'_>, options: &ReadOptions, metadata: Metadata) -> Result<Table, TableError> {
    let region = region::nearest(View { grid, across: false });
    if Columns::named(&region, options, false)?.values().next().is_some() {
        return joined_up(grid, vec![region], false, options, metadata);
    }
    Err(region.error("no column holds heights or times").help("name one, such as 'height_cm' or 'time_s'"))
}

/// The sheets of a workbook or the files of an archive that hold tables.
fn sheets(name: &str, parts: Vec<Part>, options: &ReadOptions) -> Result<Table, TableError> {
    let known: Vec<String> = parts.iter().map(|part| part.name.trim().to_owned()).collect();
    // phyphox' stopwatches write the same events three times; only in one sheet are they all.
    let all = known.iter().any(|n| stem(n) == "All");
    // What is drawn stands elsewhere, if it does.
    let of_chart = |label: &str| folded(label).split(|c: char| !c.is_alphanumeric()).any(|word| Phrase::Chart.is(word));
    let (drawn, mut parts): (Vec<Part>, Vec<Part>) = parts.into_iter().partition(|part| of_chart(&part.name));
    parts.extend(drawn);
    let (mut found, mut aside, mut first): (Vec<(String, Table)>, Vec<_>, _) = (Vec::new(), Vec::new(), None);
    let mut used = Vec::new();
    for part in parts {
        let label = part.name.trim().to_owned();
        let why = match &options.sheet {
            Some(sheet) if label.eq_ignore_ascii_case(sheet.trim()) || stem(&label) == sheet.trim() => None,
            Some(_) => Some(Why::NotChosen),
            None if part.aside.is_some() => part.aside,
            None if title::names_no_readings(&label) => Some(Why::Predicted),
            None if alarms::named(&label).is_some() => alarms::named(&label),
            None if all && stem(&label) != "All" => Some(Why::Elsewhere),
            // What phyphox tells of the telephone, and of its clock.
            None if matches!(stem(&label), "Metadata Device" | "Metadata Time") => Some(Why::NoTable),
            None => None,
        };
        if let Some(why) = why {
            aside.push((label, why));
            continue;
        }
        let table = sheet(name, &part, options, None);
        used.push((label, part, table));
    }
    // What a sheet of notes states holds for the others.
    if let Some(drop) = stated_in_notes(&used) {
        let tables = used.iter_mut().filter(|(_, _, table)| !matches!(table, Ok(Err(_))));
        tables.for_each(|(_, part, table)| *table = sheet(name, part, options, Some(drop)));
    }
    for (label, part, table) in used {
        let drawn = options.sheet.is_none() && of_chart(&label) && found.iter().any(|(other, _)| !of_chart(other));
        match table {
            Ok(Ok(_)) | Err(_) if drawn => aside.push((label, Why::Elsewhere)),
            Err(error) => return Err(error),
            Ok(Ok(mut table)) => {
                pool::within(&part.within, &mut table.trials);
                found.push((label, table));
            }
            Ok(Err(problem)) => {
                aside.push((label, Why::NoTable));
                first = first.or(Some(problem));
            }
        }
    }
    if found.is_empty() {
        let unread = aside.iter().find(|(_, why)| matches!(why, Why::Predicted | Why::Void));
        let none = || match unread {
            Some((label, _)) => {
                TableError::new(name, format!("the sheet '{label}' is of what was not measured, or not to be used"))
                    .question()
                    .help(format!("give --sheet '{label}' if its heights or times were read"))
            }
            None => TableError::new(name, "there is no such sheet, or none at all")
                .help(format!("the file has {}", known.join(", "))),
        };
        return Err(first.unwrap_or_else(none));
    }
    pool::copied(name, &found)?;
    let computed = pool::computed(&mut found);
    aside.extend(computed.into_iter().map(|(label, _)| (label, Why::Computed)));
    let ratios = pool::measured(&mut found, |(_, table)| table);
    aside.extend(ratios.into_iter().map(|(label, _)| (label, Why::Derived)));
    let drops = pool::told_apart(&mut found, false);
    let read = found.iter().map(|(label, _)| label.clone()).collect();
    let mut table = pool::join(name, found)?;
    table.notes.insert(0, Note::Sheets { sheets: read, drops }.into());
    let empty = aside.iter().filter(|(_, why)| *why == Why::NoTable);
    let sheets: Vec<String> = empty.map(|(label, _)| label.clone()).collect();
    if !sheets.is_empty() {
        table.notes.insert(1, Note::SheetsAside { sheets }.into());
    }
    table.left_aside.extend(aside.into_iter().map(|(label, why)| LeftAside::new(Kind::Sheet, label, why)));
    alarms::leave(&mut table);
    Ok(table)
}

/// The height of release, m, that one line of the sheets without a table states, and no other does.
fn stated_in_notes(sheets: &[(String, Part, Sheet)]) -> Option<f64> {
    let notes = sheets.iter().filter(|(_, _, table)| matches!(table, Ok(Err(_))));
    let texts = notes.filter_map(|(label, part, _)| match &part.content {
        Content::Cells(cells) => Grid::open(label, Some(label), cells).ok().map(|grid| title::drops(&grid)),
        Content::Bytes(_) => None,
    });
    match texts.flatten().collect::<Vec<f64>>().as_slice() {
        [one] => Some(*one),
        _ => None,
    }
}

/// What was read of one sheet: a table; the reason why it is none; or an error in one that is.
type Sheet = Result<Result<Table, TableError>, TableError>;

/// One sheet: a table; the reason why it is none; or an error in a table that is one.
fn sheet(name: &str, part: &Part, options: &ReadOptions, noted: Option<f64>) -> Sheet {
    let inner = format!("{name}/{}", part.name);
    let (decoded, plain);
    let (name, tab, content) = match &part.content {
        Content::Cells(cells) => {
            let spelt = digits::plain(cells).map_or(Cow::Borrowed(cells.as_str()), Cow::Owned);
            plain = text::counted(&spelt).map_or(spelt, Cow::Owned);
            (name, Some(part.name.as_str()), &*plain)
        }
        Content::Bytes(bytes) => match text(&inner, bytes) {
            Ok(found) => {
                decoded = found;
                (inner.as_str(), None, &*decoded.text)
            }
            Err(problem) => return Ok(Err(problem)),
        },
    };
    let grid = match Grid::open(name, tab, content) {
        Ok(grid) => grid,
        Err(problem) => return Ok(Err(problem)),
    };
    let view = View { grid: &grid, across: false };
    if !(0..grid.rows()).any(|row| (0..grid.width(row)).any(|column| view.is_number(row, column))) {
        return Ok(Err(TableError::new(name, "there is no number in it").nothing()));
    }
    // A sheet of notes names nothing that is measured, down or across.
    let measured = |region: &Region<'_>| {
        let numbers = |n: usize| region.rows.iter().any(|&row| region.view.is_number(row, n));
        Columns::named(region, options, false).is_ok_and(|columns| columns.values().any(|(n, _, _)| numbers(n)))
    };
    let notes =
        || !region::tables(view).iter().any(measures) && !programs::turned(&grid).as_ref().is_some_and(measured);
    match read(&grid, options, noted) {
        Ok(table) => Ok(Ok(table)),
        // What is no table of bounces is left aside; a table that cannot be read is an error.
        Err(problem) if problem.is_of_nothing() || notes() => Ok(Err(problem)),
        Err(problem) => Err(problem),
    }
}

/// `All.csv` without folder and ending.
fn stem(name: &str) -> &str {
    let file = name.trim().rsplit('/').next().unwrap_or_default();
    file.rsplit_once('.').map_or(file, |(stem, _)| stem)
}
