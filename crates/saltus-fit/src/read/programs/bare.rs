//! Numbers without names: a list, a track of pixels, samples of a sensor.

use super::Recognised;
use crate::error::TableError;
use crate::read::ReadOptions;
use crate::read::aside::{LeftAside, Part, Why};
use crate::read::cell::Cell;
use crate::read::clause;
use crate::read::grid::{View, shown};
use crate::read::region::Region;
use crate::read::units::{Dimension, Unit};
use crate::statistics::median;

/// So many numbers without a name are those of a film, a second or less of it,
const FRAMES: usize = 20;
/// where half of the steps from one to the next are shorter than this part of the way.
const NEAR: f64 = 0.1;

/// Samples of a sensor without names stand below so many lines,
const HEAD: usize = 20;
/// and are so many: at the slowest rate that shows contacts, one second.
const SAMPLES: usize = 100;
/// What they are called.
const SAMPLE: &str = "amplitude";

/// Samples one below the other without a name, as programs for sound export them, below lines that
/// state their rate. `None` where it is none of it.
pub(super) fn samples(view: View<'_>) -> Option<Recognised<'_>> {
    let bare = |row: usize| view.width(row) == 1 && view.is_number(row, 0);
    let first = (0..view.rows().min(HEAD)).find(|&row| bare(row))?;
    let text = |row: usize| view.cells(row).filter(|cell| !cell.is_empty()).collect::<Vec<_>>().join(" ");
    let stated = (0..first).any(|row| clause::frame_rate(&text(row)).is_some());
    let long = view.rows() - first >= SAMPLES;
    (stated && long && (first..view.rows()).all(bare)).then(|| {
        let aside = |row: usize| LeftAside::new(Part::Text, shown(&text(row)), Why::Note).at(view.line(row, 0));
        let region = Region::new(view, vec![SAMPLE.to_owned()], first, (first..view.rows()).collect());
        vec![Region { aside: (0..first).map(aside).collect(), ..region }].into()
    })
}

/// Numbers without names: a list, if the options say of what; a track of pixels, if they say how
/// many frames a second.
pub(super) fn table<'a>(view: View<'a>, options: &ReadOptions, fps: Option<f64>) -> Result<Region<'a>, TableError> {
    let filled = |row: usize| view.cells(row).collect::<Vec<_>>().iter().rposition(|cell| !cell.is_empty());
    // Numbers by themselves above rows of several, as programs write what else they keep.
    let several = filled(view.rows() - 1) > Some(0);
    let first = (0..view.rows()).find(|&row| !several || filled(row) > Some(0)).unwrap_or(0);
    let rows = || (first..view.rows()).collect::<Vec<usize>>();
    let width = filled(first).map_or(1, |last| last + 1);
    let listed = options.height_unit.as_deref().is_some_and(|unit| unit != "px") || options.time_unit.is_some();
    let name = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<String>>();
    if width == 1 && (options.fps.is_none() || listed) {
        let of = |row: usize| match view.read(row, 0) {
            Cell::Number(measured) => measured.unit.map(|unit| unit.dimension),
            _ => None,
        };
        let own = (0..view.rows()).find_map(of);
        let kind = match (&options.height_unit, &options.time_unit, own) {
            (Some(_), None, _) | (_, _, Some(Dimension::Length)) => "height",
            (None, Some(_), _) | (_, _, Some(Dimension::Time)) => "time",
            _ => {
                return Err(view
                    .error(0, 0, "the list has no header: are these heights or times, and in which unit?")
                    .question()
                    .help("put a name above it, such as 'height_cm' or 'time_s', or give either --height-unit cm or --time-unit s"));
            }
        };
        return Ok(Region { given: true, ..Region::new(view, name(&[kind]), 0, rows()) });
    }
    // A first column that ascends counts frames, or seconds.
    let (mut ascends, mut whole, mut last) = (width > 1, true, f64::NEG_INFINITY);
    for row in rows() {
        let value = match view.read(row, 0) {
            Cell::Number(measured) => measured.value,
            _ => f64::NAN,
        };
        ascends &= value > last;
        whole &= value.fract() == 0.0;
        last = value;
    }
    if fps.is_none() && !(ascends && (!whole && width == 3 || width < 4 && a_path(view, first, width - 1))) {
        return Err(view.error(0, 0, "the table has no header: its first line is numbers").nothing().help(
            "name the columns, such as --header bounce,height_cm or --header time_s,height_m; \
                 for a track of pixels give the frames a second, such as --fps 100",
        ));
    }
    let clock = if whole { "frame" } else { "time" };
    let (names, frames): (&[&str], bool) = match (width, ascends) {
        (1, _) => (&["y"], true),
        (2, true) => (&[clock, "y"], false),
        (_, true) => (&[clock, "x", "y"], false),
        (_, false) => (&["x", "y"], true),
    };
    let mut header: Vec<String> = name(names);
    header.resize(view.width(first).max(header.len()), String::new());
    let units = (Some(Unit::SECOND), Some(Unit::PIXEL));
    let alone = |row: usize| LeftAside::new(Part::Row, shown(view.cell(row, 0)), Why::Note).at(view.line(row, 0));
    let aside = (0..first).map(alone).collect();
    Ok(Region { frames, units, given: true, aside, ..Region::new(view, header, first, rows()) })
}

/// Whether numbers one below the other are places of what moves: many, each near the one before.
fn a_path(view: View<'_>, first: usize, column: usize) -> bool {
    let places: Vec<f64> = (first..view.rows()).filter_map(|row| view.number(row, column)).collect();
    let (low, high) = places.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(*y), h.max(*y)));
    let mut steps: Vec<f64> = places.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    places.len() >= FRAMES && median(&mut steps).is_some_and(|step| step < NEAR * (high - low))
}
