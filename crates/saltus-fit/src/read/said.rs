//! Whether a table says that something bounces: before and after, speeds, energies and durations
//! are of many things.

use saltus_bounce::units::Quantity;

use super::ReadOptions;
use super::cell::Cell;
use super::clause;
use super::columns::{Column, Columns, Kind as Of};
use super::grid::shown;
use super::heading::{At, DropHeight, Heading, Role, Value, What, is_sign};
use super::phrases::{DENIED, Phrase, denies};
use super::region::Region;
use super::units::{Dimension, Scale};
use super::vocabulary::{Atom, ROWS, folded, misspelt};
use super::words::{ARTICLE, Kind, Word, has_word, split};
use crate::error::TableError;
use crate::finding::Doubt;
use crate::quantity::Ball;
use crate::statistics::median;

/// Whether a text names a wall, or a bumper.
fn names_wall(text: &str) -> bool {
    split(text).iter().any(|word| Phrase::Wall.is(&folded(&word.text)))
}

/// Whether a text says that a ball runs against a wall.
fn hits_wall(text: &str) -> bool {
    let words = split(text);
    let is = |word: &Word, phrase: Phrase| phrase.is(&folded(&word.text));
    let against = words.iter().position(|word| is(word, Phrase::Against));
    let wall = against.is_some_and(|at| words[at..].iter().any(|word| is(word, Phrase::Wall)));
    wall && words.iter().any(|word| word.is(Atom::Label))
}

/// Whether a text names a ball and a wall: of speeds before and after, it is what the ball meets.
fn ball_and_wall(text: &str) -> bool {
    names_wall(text) && names_ball(text)
}

/// Whether a text names a ball.
fn names_ball(text: &str) -> bool {
    split(text).iter().any(clause::names_ball)
}

/// Whether a text is of a ball: behind its name stands no word that is not understood, as in
/// `basketball players`.
fn is_of_a_ball(text: &str) -> bool {
    let words = split(text);
    let known = |n: usize| words.get(n).is_none_or(|word| !matches!(word.kind, Kind::Unknown));
    words.iter().enumerate().any(|(n, word)| clause::names_ball(word) && known(n + 1))
}

/// Whether a text says that something bounces, or is dropped.
fn says(text: &str) -> bool {
    if Heading::parse(text).cor {
        return true;
    }
    let words = split(text);
    let hits = words.iter().any(|word| word.is(Atom::Impact) && word.is(Atom::Loose));
    // So does what is let go and then hits.
    let lower = folded(text);
    let spelt = |phrase: &&&str| phrase.contains(' ') && lower.contains(**phrase);
    if hits && Phrase::LetGo.all().iter().any(|phrase| spelt(&phrase)) {
        return true;
    }
    words.iter().any(|word| {
        let spelt = folded(&word.text);
        let (plain, atoms) = match word.kind {
            Kind::Known(atoms) => (spelt.as_str(), atoms),
            Kind::Unknown => misspelt(&spelt).unwrap_or((&spelt, &[])),
            _ => return false,
        };
        let bounces = [Atom::Impact, Atom::Rebound, Atom::Release].iter().any(|atom| atoms.contains(atom));
        let loose = atoms.contains(&Atom::Loose) || atoms.contains(&Atom::Top) && plain != "apex";
        bounces && !loose
    })
}

/// Whether a text says that something hits a floor: a ball bounces from it, though much else hits,
/// and floors are of much else.
fn hits_floor(text: &str) -> bool {
    let words = split(text);
    let hits = words.iter().any(|word| word.is(Atom::Impact) && word.is(Atom::Loose));
    hits && words.iter().any(|word| word.is(Atom::Floor))
}

/// The name of a file without its folder and ending.
pub(super) fn stem(name: &str) -> &str {
    let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
    file.split('.').next().unwrap_or(file)
}

/// The words of a table: in headings, titles, remarks, comments, names of rows, of its sheet and of
/// its file.
pub(super) fn texts<'a>(region: &'a Region<'_>) -> impl Iterator<Item = &'a str> {
    let grid = region.view.grid;
    let numbers = |cell: &str| cell.parse::<f64>().is_ok();
    let cells = (0..grid.rows().min(ROWS)).flat_map(move |row| (0..grid.width(row)).map(move |n| grid.cell(row, n)));
    let cells = cells.filter(move |cell| !cell.is_empty() && !numbers(cell));
    cells
        .chain(grid.comments().take(ROWS).map(|(_, text)| text))
        .chain(grid.tab)
        .chain([region.label.as_str(), stem(grid.name)])
}

/// The doubt whether a table is of a bounce that speaks of another motion in which heights, or
/// speeds, fall alike: a pendulum, a ramp, a jump on a rope. Speeds that turn round at a wall that
/// it names, or a bumper, are of an impact, whatever moves.
pub(super) fn of_another_motion(region: &Region<'_>, columns: &Columns) -> Option<Doubt> {
    if turned_round(region, columns) && texts(region).any(names_wall) {
        return None;
    }
    let other = |text: &&str| {
        let words = split(text);
        let denied = |at: usize| words[at.saturating_sub(DENIED)..at].iter().any(|word| denies(&folded(&word.text)));
        // What a ball does after its last bounce is none of it: `after contact 8 it rolls`.
        let bounced = |word: &Word| word.is(Atom::Impact) || word.is(Atom::Rebound);
        let after = words.iter().position(|word| word.is(Atom::After));
        let later = |at: usize| after.is_some_and(|after| after < at && words[after..at].iter().any(bounced));
        (0..words.len()).any(|at| words[at].is(Atom::Motion) && !denied(at) && !later(at))
    };
    texts(region).find(other).map(|text| Doubt::Motion { text: shown(text) })
}

/// Whether speeds before and after turn round in every row, of which there are several: what meets
/// nothing keeps its sign.
fn turned_round(region: &Region<'_>, columns: &Columns) -> bool {
    let speeds = columns.values().filter(|(_, _, v)| v.what == What::Speed && v.role == Role::Reading);
    let speeds: Vec<usize> = speeds.map(|(n, _, _)| n).collect();
    let [before, after] = speeds.as_slice() else { return false };
    let number = |row: usize, n: usize| match region.view.read(row, n) {
        Cell::Number(m) => Some(m.value),
        _ => None,
    };
    let turns = |&row: &usize| Some(number(row, *before)? * number(row, *after)? < 0.0);
    let turns: Vec<bool> = region.rows.iter().filter_map(turns).collect();
    turns.len() >= ALIKE && turns.iter().all(|turns| *turns)
}

/// Whether speeds on the way to something stand beside those on the way back, or those of a ball
/// going down beside those going up, which are lower in every row, of which there are several.
fn in_and_out(region: &Region<'_>, columns: &Columns) -> bool {
    let named = |phrase: Phrase, at: At| {
        let names = |c: &Column| has_word(&c.heading.text, phrase);
        columns.values().find(|(_, c, v)| v.what == What::Speed && v.at == at && names(c)).map(|(n, _, _)| n)
    };
    let met = named(Phrase::Inwards, At::Before).zip(named(Phrase::Outwards, At::After));
    let falls_and_rises = || named(Phrase::Down, At::Before).zip(named(Phrase::UpTo, At::After));
    let of_ball = || falls_and_rises().filter(|_| texts(region).any(names_ball));
    let Some((to, back)) = met.or_else(of_ball) else { return false };
    let number = |row: usize, n: usize| region.view.number(row, n).map(f64::abs);
    let falls = |&row: &usize| Some(number(row, back)? < number(row, to)?);
    let falls: Vec<bool> = region.rows.iter().filter_map(falls).collect();
    falls.len() >= ALIKE && falls.iter().all(|falls| *falls)
}

/// The doubt whether readings are of a bounce at all, where nothing in the table says so: heights,
/// speeds, energies and times may be of anything, but heights beside times of contacts, which fall
/// as a ball does or do not fit, and speeds that turn round. Answered for is what was chosen by an
/// option, and a name that is spelt as the documentation spells it, `height_cm`; `h0` beside `h1`
/// are signs of a bounce.
pub(super) fn unsaid(region: &Region<'_>, columns: &Columns, options: &ReadOptions) -> Option<Doubt> {
    let answered = options.column.is_some() || options.drop.is_some() || options.sheet.is_some();
    // A ball that blocks a gate on its way down and up has turned round below it.
    let gated = || columns.columns.iter().any(|c| c.turned) && texts(region).any(names_ball);
    let comes_back = || in_and_out(region, columns);
    if answered || region.given || region.chosen || turned_round(region, columns) || gated() || comes_back() {
        return None;
    }
    let length = |c: &Column| {
        c.unit.is_none_or(|unit| unit.dimension == Dimension::Length && !matches!(unit.scale, Scale::Energy { .. }))
    };
    let read = || columns.values().filter(|(_, _, v)| v.role != Role::Error);
    // A sheet may name the height of release.
    let named = region.view.grid.tab.is_some_and(|tab| Quantity::Length.parse(tab).is_ok());
    let high = named || read().any(|(_, c, v)| v.what == What::Height && length(c));
    let from = |c: &Column| c.of_words(Phrase::From) && !c.heading.has(Atom::Height);
    let pair = |c: &Column, at: At| {
        at == At::Release && (c.heading.has(Atom::Before) || c.heading.has(Atom::Release) || from(c))
    };
    // A flight lasts as long as its height says, whatever flies.
    let timed = read().any(|(_, _, v)| v.what == What::Time && v.at == At::Row);
    let spelt = |c: &Column| c.heading.text.contains('_');
    let released = read().any(|(_, _, v)| v.at == At::Release);
    let list = |c: &Column, v: &Value| v.what == What::Height && v.at == At::Row && !(timed || released || spelt(c));
    let open = read().find(|(_, c, v)| pair(c, v.at) || if high { list(c, v) } else { v.at != At::Release });
    let parts = || columns.columns.iter().find(|c| c.kind == Of::Share && c.heading.has(Atom::Energy));
    // A ball that has one speed before a wall and another after it bounces from it.
    let fast = read().any(|(_, _, v)| v.what == What::Speed);
    let turned = [At::Before, At::After].map(|at| read().any(|(_, _, v)| v.what == What::Speed && v.at == at));
    let met = |text: &str| hits_wall(text) || turned == [true, true] && ball_and_wall(text);
    let ball = texts(region).any(names_ball);
    let told = |text: &str| says(text) || ball && hits_floor(text) || fast && met(text);
    let column = open.map(|(_, column, _)| column).or_else(parts).filter(|_| !texts(region).any(told))?;
    let ball = || texts(region).any(|text| is_of_a_ball(text) || Ball::named(text).is_some()) || filed(region);
    let bounces =
        ball() && repeats(region, columns, KEPT) || (ball() || understood(region)) && shrinks(region, columns);
    (!bounces).then(|| Doubt::Unsaid { column: shown(&column.heading.text) })
}

/// Whether all that is read are times between which less and less passes, by one factor, or such
/// times themselves side by side: nothing else happens so than contacts of a ball, but what is
/// called otherwise, laps and jumps.
pub(super) fn shrinks(region: &Region<'_>, columns: &Columns) -> bool {
    let read = columns.values().filter(|(_, _, v)| v.role != Role::Error).map(|(n, _, v)| (n, v));
    let read: Vec<(usize, &Value)> = read.collect();
    let number = |row: usize, n: usize| columns.written(region, row, n).map(|(number, _)| number);
    let rises = |n: usize| region.rows.windows(2).all(|pair| number(pair[0], n) < number(pair[1], n));
    let clock = read.iter().all(|(n, v)| v.what == What::Time && v.at == At::Row && rises(*n));
    let beside = |v: &Value| matches!(v.what, What::Time | What::Interval) && matches!(v.at, At::Nth(_));
    // One row may fall so by chance.
    let beside = read.iter().all(|(_, v)| beside(v)) && read.len() > ALIKE && region.rows.len() >= ALIKE;
    let other = |w: &Word| w.is(Atom::Motion) || w.is(Atom::Loose) && (w.is(Atom::Impact) || w.is(Atom::Rebound));
    let mut names = columns.columns.iter().filter(|c| c.kind != Of::Aside).flat_map(|c| split(&c.heading.text));
    let shrink = || repeats(region, columns, LASTING) || beside && repeats_across(region, columns, &read, LASTING);
    (clock || beside) && !names.any(|word| other(&word)) && shrink()
}

/// Whether every word that stands beside the columns is understood, but for what an instrument is
/// called, letters with digits and who made it before them, and set to.
fn understood(region: &Region<'_>) -> bool {
    let model = |word: &Word| word.text.contains(|c: char| c.is_ascii_digit());
    let known = |words: Vec<Word>| {
        (0..words.len()).all(|n| {
            let made = words[n].text.starts_with(char::is_uppercase) && words.get(n + 1).is_some_and(model);
            let tuned = || Phrase::Tuned.is(&folded(&words[n].text));
            !matches!(words[n].kind, Kind::Unknown) || model(&words[n]) || made || tuned()
        })
    };
    let grid = region.view.grid;
    let whole = |line: u64| {
        let row = grid.row_of(line);
        (0..grid.width(row)).map(|n| grid.cell(row, n)).collect::<Vec<_>>().join(" ")
    };
    let titles = region.aside.iter().map(|aside| aside.line.map_or_else(|| aside.name.clone(), whole));
    titles.chain(grid.comments().map(|(_, text)| text.to_owned())).take(ROWS).all(|text| known(split(&text)))
}

/// Whether the file is named after a ball, or its sport: `phyphox_golf_3.csv`.
fn filed(region: &Region<'_>) -> bool {
    let words: Vec<&str> =
        stem(region.view.grid.name).split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
    (1..=3).any(|count| words.windows(count).any(|words| Ball::named(&words.join(" ")).is_some()))
}

/// Whether the numbers of a table that names a ball bounce themselves: every row keeps the same
/// part of what was before it, of a height or an energy or, one below the other, of a duration, or
/// of what lies between two times.
/// Of speeds, and of bodies that collide, the part may be of another law.
fn repeats(region: &Region<'_>, columns: &Columns, within: f64) -> bool {
    let collide = |text: &str| split(text).iter().any(|word| word.is(Atom::Impact) && word.is(Atom::Loose));
    let read: Vec<(usize, &Value)> =
        columns.values().filter(|(_, _, v)| v.role == Role::Reading).map(|(n, _, v)| (n, v)).collect();
    let of_row = |v: &Value| matches!(v.what, What::Height | What::Unsaid | What::Interval | What::Time);
    let (first, others): (Vec<_>, Vec<_>) = read.into_iter().partition(|(_, v)| v.at == At::Release);
    if texts(region).any(collide) {
        return false;
    }
    if first.is_empty() && others.iter().all(|(_, v)| v.what == What::Interval && matches!(v.at, At::Nth(_))) {
        return repeats_across(region, columns, &others, within);
    }
    if others.iter().any(|(_, v)| v.at != At::Row || !of_row(v)) {
        return false;
    }
    let number = |row: usize, n: usize| columns.written(region, row, n).map(|(number, _)| number);
    // The balls and surfaces of a row, each of which keeps a part of its own.
    let settings: Vec<usize> = (0..columns.columns.len()).filter(|&n| columns.columns[n].kind == Of::Setting).collect();
    let key = |row: usize| settings.iter().map(|&n| region.cell(row, n)).collect::<Vec<_>>().join("\t");
    let part = |n: usize, row: usize, before: Option<f64>, after: Option<f64>| {
        let part = after? / before?;
        Some((key(row), if columns.columns[n].holds(What::Height) { part.sqrt() } else { part }))
    };
    let rows = &region.rows;
    let mut parts: Vec<(String, f64)> = match first.as_slice() {
        [(drop, _)] => {
            let heights = others.iter().flat_map(|(n, _)| rows.iter().map(move |&row| (*n, row)));
            heights.filter_map(|(n, row)| part(n, row, number(row, *drop), number(row, n))).collect()
        }
        // Lines of their own may name where they were dropped from.
        [] if others.iter().all(|(_, v)| v.drop.is_some()) => {
            let heights = others.iter().flat_map(|(n, v)| rows.iter().map(move |&row| (*n, *v, row)));
            let from = |v: &Value| v.drop.as_ref().map(DropHeight::metres);
            heights.filter_map(|(n, v, row)| part(n, row, from(v), number(row, n))).collect()
        }
        [] => {
            let rises = |n: usize| rows.windows(2).all(|pair| number(pair[0], n) < number(pair[1], n));
            let (clocks, steps): (Vec<_>, Vec<_>) = others.iter().partition(|(n, v)| v.what == What::Time && rises(*n));
            let steps = steps.iter().flat_map(|(n, _)| rows.windows(2).map(move |pair| (*n, pair)));
            let steps = steps.filter_map(|(n, pair)| part(n, pair[0], number(pair[0], n), number(pair[1], n)));
            let flight = |n: usize, from: usize, to: usize| Some(number(to, n)? - number(from, n)?);
            let flights = clocks.iter().flat_map(|(n, _)| rows.windows(3).map(move |three| (*n, three)));
            let flights = flights.filter_map(|(n, r)| part(n, r[0], flight(n, r[0], r[1]), flight(n, r[1], r[2])));
            steps.chain(flights).collect()
        }
        _ => return false,
    };
    parts.sort_by(|a, b| a.0.cmp(&b.0));
    let alike = |group: &[(String, f64)]| keeps(group.iter().map(|(_, part)| *part).collect(), within);
    parts.len() >= ALIKE && parts.chunk_by(|a, b| a.0 == b.0).all(alike)
}

/// The same of flights that stand side by side, one after the other, a drop a row.
fn repeats_across(region: &Region<'_>, columns: &Columns, flights: &[(usize, &Value)], within: f64) -> bool {
    let number = |row: usize, n: usize| columns.written(region, row, n).map(|(number, _)| number);
    let of_row =
        |row: usize| flights.windows(2).filter_map(move |pair| Some(number(row, pair[1].0)? / number(row, pair[0].0)?));
    let parts: Vec<f64> = region.rows.iter().flat_map(|&row| of_row(row)).collect();
    parts.len() >= ALIKE && keeps(parts, within)
}

/// Whether all parts are nearly one that a ball keeps.
fn keeps(mut parts: Vec<f64>, within: f64) -> bool {
    let usual = median(&mut parts).unwrap_or_default();
    BOUNCES.contains(&usual) && parts.iter().all(|part| (part / usual - 1.0).abs() < within)
}

/// CORs of balls on floors: where all rows agree on one of these, the ball bounces.
const BOUNCES: std::ops::Range<f64> = 0.3..0.98;

/// They agree where each is off by less than this part: drops scatter by a hundredth or two, and
/// the air takes a few more of a light ball.
const KEPT: f64 = 0.04;

/// Where no ball is named, times that a program took agree to this part; what grows rarer by chance
/// does not.
const LASTING: f64 = 0.03;

/// Fewer rows than these fall alike by chance.
pub(super) const ALIKE: usize = 3;

/// Whether a heading says that its heights are those of a bounce, or no more than that they are
/// heights: it names nothing else, `height (cm)`, `rebound`, but not `door height`.
fn plain(heading: &Heading) -> bool {
    let of_bounces = [Atom::Rebound, Atom::Impact, Atom::After, Atom::Between].iter().any(|atom| heading.has(*atom));
    let words = split(&heading.text);
    let bare = |word: &Word| match word.kind {
        // An article, or what stands between names.
        Kind::Known([Atom::Filler]) => word.text.chars().count() < ARTICLE,
        Kind::Known(atoms) => atoms.iter().all(|a| matches!(a, Atom::Height | Atom::Max | Atom::Mean | Atom::Unit(_))),
        _ => true,
    };
    of_bounces || heading.has(Atom::Read) || words.iter().all(bare)
}

/// The doubt whether the readings are those that were read, where a column that is not understood
/// names what they do, a rebound or a speed; or where they are not plainly heights, and one is
/// called so too, or rises and falls with them from row to row and says something else; `--column`
/// answers it. So may a coordinate beside another, where no clock makes a track of them: signs
/// alone do not tell which is the height.
pub(super) fn rival(region: &Region<'_>, columns: &Columns, options: &ReadOptions) -> Option<Doubt> {
    if options.column.is_some() || region.given || region.chosen {
        return None;
    }
    let number = |row: usize, n: usize| match region.view.read(row, n) {
        Cell::Number(m) => Some(m.unit.or(columns.columns[n].unit).map_or(m.value, |unit| unit.si(m.value))),
        _ => None,
    };
    let dimension = |c: &Column| c.unit.map(|unit| unit.dimension);
    let sign = |c: &Column| is_sign(c.heading.text.split(['(', '[']).next().unwrap_or_default().trim());
    let tracked = columns.any(What::Time, Some(At::Row)) || columns.columns.iter().any(|c| c.kind == Of::Frame);
    let unknown = |c: &Column| {
        let named = !c.heading.unknown.is_empty() && c.heading.value().is_some();
        c.kind == Of::Aside && !c.heading.turns() && (named || !tracked && sign(c))
    };
    let aside = columns.columns.iter().enumerate().filter(|(_, c)| unknown(c));
    let high = |v: &Value| v.what == What::Height && v.at != At::Release && !(v.position && tracked);
    let read = |v: &Value| v.role == Role::Reading && (high(v) || v.what == What::Speed);
    // What is a small part of the readings is their error.
    let kin = |n: usize, of: usize| {
        let pairs = region.rows.iter().filter_map(|&row| Some(number(row, n)? / number(row, of)?));
        median(&mut pairs.collect::<Vec<f64>>()).is_some_and(|part| part > USUAL.start * USUAL.start)
    };
    let with = |(n, column): &(usize, &Column)| {
        let one = |c: &Column| dimension(column).is_none_or(|own| dimension(c).is_none_or(|other| own == other));
        columns.values().filter(|(_, c, v)| read(v) && one(c)).find(|(of, c, v)| {
            let named = [Atom::Rebound, Atom::Speed].iter().any(|a| column.heading.has(*a) && c.heading.has(*a));
            if named || plain(&c.heading) || v.what != What::Height {
                return named && kin(*n, *of);
            }
            // `Ceiling height` beside `Light height`: named alike.
            if column.heading.has(Atom::Height) {
                return true;
            }
            let pairs = region.rows.iter().filter_map(|&row| Some((number(row, *n)?, number(row, *of)?)));
            let pairs: Vec<(f64, f64)> = pairs.collect();
            let alike = |w: &[(f64, f64)]| (w[1].0 - w[0].0) * (w[1].1 - w[0].1) > 0.0;
            let other = pairs.iter().any(|(a, b)| (a / b - 1.0).abs() > SAME);
            pairs.len() >= ALIKE && pairs.windows(2).all(alike) && other
        })
    };
    let ((_, column), (_, of, _)) = aside.into_iter().find_map(|aside| Some((aside, with(&aside)?)))?;
    Some(Doubt::Rival { column: shown(&column.heading.text), of: shown(&of.heading.text) })
}

/// Heights that differ by less are the same in another unit, and rounded.
const SAME: f64 = 0.05;

/// CORs of balls that people drop to see them bounce.
const USUAL: std::ops::Range<f64> = 0.3..0.95;

/// The doubt whether releases and rebounds, in different units, are: where their numbers say a COR
/// that is usual if the units were the same, and one that is not as they are stated.
pub(super) fn mixed_units(region: &Region<'_>, columns: &Columns) -> Option<Doubt> {
    let column = |release: bool| {
        columns.values().find(|(_, c, v)| {
            let fits = v.what == What::Height && v.role == Role::Reading && (v.at == At::Release) == release;
            fits && c.unit.is_some_and(|unit| matches!(unit.scale, Scale::Si { .. }))
        })
    };
    let ((drop, of_drop, _), (rebound, of_rebound, _)) = (column(true)?, column(false)?);
    let (Some(one), Some(other)) = (of_drop.unit.filter(|_| of_drop.unit != of_rebound.unit), of_rebound.unit) else {
        return None;
    };
    let number = |row: usize, n: usize| match region.view.read(row, n) {
        Cell::Number(m) if m.unit.is_none() => Some(m.value),
        _ => None,
    };
    let pairs = region.rows.iter().filter_map(|&row| Some(number(row, rebound)? / number(row, drop)?));
    let bare = median(&mut pairs.collect::<Vec<f64>>())?.sqrt();
    let stated = bare * (other.si(1.0) / one.si(1.0)).sqrt();
    (USUAL.contains(&bare) && !USUAL.contains(&stated))
        .then(|| Doubt::Units { drop: shown(&of_drop.heading.text), rebound: shown(&of_rebound.heading.text) })
}

/// The doubt about speeds beside the angles of their paths.
pub(super) fn oblique(columns: &Columns) -> Option<Doubt> {
    let fast = columns.values().any(|(_, _, v)| v.what == What::Speed);
    let angle = |c: &&Column| split(&c.heading.text).iter().any(|word| Phrase::Angle.is(&folded(&word.text)));
    let column = columns.columns.iter().find(angle).filter(|_| fast)?;
    Some(Doubt::Oblique { column: shown(&column.heading.text) })
}

/// Nobody calls fewer readings than these a mean.
const AVERAGED: f64 = 2.0;

/// Of how many readings each is the mean, where a line above the table, its name or the name of a
/// column says that they are, and no column states how far they scatter; at least two where nothing
/// says how many.
pub(super) fn averaged(region: &Region<'_>, columns: &Columns) -> Option<f64> {
    let stated = columns.columns.iter().any(|c| matches!(c.kind, Of::Error(_)));
    let of_column = columns.values().filter(|(_, c, v)| v.role == Role::Reading && c.heading.has(Atom::Mean));
    let names = of_column.map(|(_, c, _)| c.heading.text.as_str());
    let above = region.aside.iter().map(|aside| aside.name.as_str()).chain([region.view.grid.name]);
    let other = |text: &str| {
        [Atom::Group, Atom::Other, Atom::Derived, Atom::Speed].iter().any(|a| split(text).iter().any(|w| w.is(*a)))
    };
    let says = |text: &str| split(text).iter().any(|word| word.is(Atom::Mean)) && !other(text);
    let text = above.filter(|text| says(text)).chain(names).next().filter(|_| !stated)?;
    let count = |word: &str| {
        let named = Phrase::Count.all().iter().zip(2u32..).find(|(name, _)| **name == word).map(|(_, n)| f64::from(n));
        named.or(word.parse().ok().filter(|n: &f64| n.fract() == 0.0 && *n >= AVERAGED))
    };
    let lower = folded(text);
    Some(lower.split(|c: char| !c.is_alphanumeric()).find_map(count).unwrap_or(AVERAGED))
}

/// Hundredths are of the release, so that releases are no hundredths of each other.
pub(super) fn released(region: &Region<'_>, columns: &Columns) -> Result<(), TableError> {
    let percent = |c: &Column| c.unit.is_some_and(|unit| unit.scale == Scale::Percent);
    let Some((index, column, _)) = columns
        .values()
        .find(|(_, c, v)| v.what == What::Height && v.at == At::Release && v.role == Role::Reading && percent(c))
    else {
        return Ok(());
    };
    let mut cells = region.rows.iter().map(|&row| region.cell(row, index)).filter(|cell| !cell.is_empty());
    let first = cells.next();
    if cells.all(|cell| Some(cell) == first) {
        return Ok(());
    }
    let name = shown(&column.heading.text);
    Err(region
        .header_error(index, format!("'{name}' holds hundredths: of what, where a ball was dropped from?"))
        .question()
        .help("give the heights of release in a unit of length; the rebounds may be hundredths of them"))
}
