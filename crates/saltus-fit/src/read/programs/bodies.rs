//! Bodies that programs follow in a film, a row for each of them in each frame, or side by side:
//! spots of `TrackMate`, boxes of a detector, markers of a motion capture (`.trc`).

use super::{Recognised, picked, position};
use crate::finding::Program;
use crate::read::aside::{LeftAside, Part, Why};
use crate::read::grid::View;
use crate::read::region::Region;
use crate::read::units::Unit;

/// The bodies of such a file; `None` where it is none.
pub(super) fn tables(view: View<'_>) -> Option<Recognised<'_>> {
    let found = spots(view).or_else(|| boxes(view)).or_else(|| sized(view)).or_else(|| tracked(view));
    let found = found.or_else(|| markers(view));
    found.filter(|found| !found.regions.is_empty())
}

/// `TRACK_ID`, `POSITION_Y` and `FRAME` of spots in any order, below names in plain words and in
/// brackets their units.
fn spots(view: View<'_>) -> Option<Recognised<'_>> {
    let [track, y, frame] = ["track_id", "position_y", "frame"].map(|name| position(view, 0, name));
    Some(of_bodies(view, 1, Some(track?), [frame?, y?], Some(Program::ImageJ)))
}

/// The corners `x1`, `y1`, `x2`, `y2` of a box about each body that a detector found, beside its
/// number, `track_id`: the ball is as high as its lower edge.
fn boxes(view: View<'_>) -> Option<Recognised<'_>> {
    let corners = ["x1", "y1", "x2"].iter().all(|name| position(view, 0, name).is_some());
    let [track, y, frame] = ["track_id", "y2", "frame"].map(|name| position(view, 0, name));
    corners.then_some(of_bodies(view, 1, Some(track?), [frame?, y?], None))
}

/// A box about the body in each frame by its place and its size, `frame, x, y, w, h`, beside how
/// sure the detector is: `h` is no height above the floor. Several bodies have a number or a class.
fn sized(view: View<'_>) -> Option<Recognised<'_>> {
    let any = |names: &[&str]| names.iter().find_map(|name| position(view, 0, name));
    let frame = any(&["frame", "frame_id", "frame_no", "frame_number", "image_id"])?;
    let y = any(&["y", "cy", "yc", "y_center", "center_y", "ycenter", "bb_top", "top"])?;
    any(&["w", "width", "bb_width"]).and(any(&["h", "height", "bb_height"]))?;
    any(&["conf", "confidence", "score", "prob"])?;
    let body = any(&["track_id", "id", "track", "object_id", "class", "cls", "label", "name"]);
    Some(of_bodies(view, 1, body, [frame, y], None))
}

/// Boxes about bodies as trackers write them, without names: the frame, the number of the body, the
/// left and the upper edge, width and height, how sure it is, and three numbers that are not used.
fn tracked(view: View<'_>) -> Option<Recognised<'_>> {
    let number = |row: usize, n: usize| view.number(row, n).filter(|_| view.is_number(row, n));
    let counts = |row: usize, n: usize| number(row, n).is_some_and(|count| count >= 0.0 && count.fract() == 0.0);
    let unused = |row: usize| (7..BOX).all(|n| number(row, n) == Some(-1.0));
    let sized = |row: usize| [4, 5].iter().all(|&n| number(row, n).is_some_and(|size| size > 0.0));
    let of_box = |row: usize| view.width(row) == BOX && counts(row, 0) && counts(row, 1) && sized(row) && unused(row);
    let all = view.rows() > 0 && (0..view.rows()).all(of_box);
    all.then(|| of_bodies(view, 0, Some(1), [0, 3], None))
}

/// A line of a tracker has so many numbers.
const BOX: usize = 10;

/// A table for each number of a body, in the rows from `first` on: its frames in order, and its
/// places in pixels.
fn of_bodies(
    view: View<'_>,
    first: usize,
    body: Option<usize>,
    [frame, y]: [usize; 2],
    program: Option<Program>,
) -> Recognised<'_> {
    let number = |row: usize| view.number(row, frame).filter(|_| view.is_number(row, y));
    let mut rows: Vec<(f64, usize)> = (first..view.rows()).filter_map(|row| Some((number(row)?, row))).collect();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut bodies: Vec<(&str, Vec<usize>)> = Vec::new();
    for (_, row) in rows {
        let name = body.map_or("", |body| view.cell(row, body));
        match bodies.iter_mut().find(|(other, _)| *other == name) {
            Some((_, rows)) => rows.push(row),
            None => bodies.push((name, vec![row])),
        }
    }
    // What stays in its place to the last digit shows no ball.
    let stays = |(_, rows): &(&str, Vec<usize>)| rows.iter().all(|&row| view.cell(row, y) == view.cell(rows[0], y));
    let (still, bodies): (Vec<_>, Vec<_>) = bodies.into_iter().partition(stays);
    let several = still.len() + bodies.len() > 1;
    let aside =
        still.iter().map(|(name, _)| LeftAside::new(Part::Track, format!("track {name}"), Why::Still)).collect();
    let region = |(name, rows): (&str, Vec<usize>)| {
        let header = picked(view.width(0), &[(frame, "frame"), (y, "y")]);
        let label = if several { format!("track {name}") } else { String::new() };
        Region { label, units: (None, Some(Unit::PIXEL)), chosen: true, ..Region::new(view, header, 0, rows) }
    };
    let mut regions: Vec<Region<'_>> = bodies.into_iter().map(region).collect();
    if let Some(first) = regions.first_mut() {
        first.aside = aside;
    }
    Recognised { program, regions, tracks: true }
}

/// `PathFileType`, lines of rates and units, `Frame#`, `Time` and the names of markers, and below
/// each name its axes, `X1`, `Y1`, `Z1`.
fn markers(view: View<'_>) -> Option<Recognised<'_>> {
    if !view.cell(0, 0).eq_ignore_ascii_case("pathfiletype") {
        return None;
    }
    let names = (1..view.rows()).find(|&row| view.cell(row, 0).eq_ignore_ascii_case("frame#"))?;
    let unit = position(view, 1, "units").map_or("m", |column| view.cell(2, column));
    let rows: Vec<usize> = (names + 1..view.rows()).filter(|&row| view.is_number(row, 0)).collect();
    let place = |number: usize, axis: &str| position(view, names + 1, &format!("{axis}{number}"));
    let columns = (1..).map_while(|n| Some([place(n, "x")?, place(n, "y")?, place(n, "z")?]));
    let width = view.width(names).max(view.width(names + 1));
    let region = |axes: [usize; 3]| {
        let mut header = picked(width, &[(1, "time (s)")]);
        axes.into_iter().zip(["x", "y", "z"]).for_each(|(n, axis)| header[n] = format!("{axis} ({unit})"));
        let label = view.cell(names, axes[0]).to_owned();
        Region { label, ..Region::new(view, header, names, rows.clone()) }
    };
    let regions: Vec<Region<'_>> = columns.map(region).collect();
    (!regions.is_empty()).then_some(Recognised { program: None, regions, tracks: true })
}
