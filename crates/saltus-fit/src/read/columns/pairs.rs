//! Columns that are what they are beside others: drops with their own rebounds, counts of rows,
//! measured cells under the name of a key.

use super::{Column, Columns, Kind};
use crate::error::TableError;
use crate::finding::Note;
use crate::read::aside::Why;
use crate::read::cell::{Cell, clock, respelt};
use crate::read::grid::shown;
use crate::read::heading::{At, Role, Value, What};
use crate::read::named::{OFF, between, bounce};
use crate::read::phrases::Phrase;
use crate::read::region::Region;
use crate::read::units::{Dimension, Scale, Unit};
use crate::read::vocabulary::{Atom, folded};
use crate::read::words::split;

/// Whether times and speeds of the same rows are those of one way, to within [`WORKED_OUT`].
fn one_way(region: &Region<'_>, time: usize, speed: usize) -> bool {
    let way = |&row: &usize| Some(region.view.number(row, time)? * region.view.number(row, speed)?);
    let ways: Vec<f64> = region.rows.iter().filter_map(way).collect();
    let (low, high) = ways.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), w| (low.min(*w), high.max(*w)));
    ways.len() > 1 && low > 0.0 && high - low < WORKED_OUT * high
}

/// Speeds that are worked out are rounded to a per cent at most.
const WORKED_OUT: f64 = 0.01;

impl Columns {
    /// Beside the speeds before and after each bounce the heights of release say nothing more, and
    /// neither do the times that a gate was dark, by which speeds are worked out.
    pub(super) fn sided(&mut self, region: &Region<'_>) {
        let read = |what: What, at: At| {
            let of = |v: &Value| v.role == Role::Reading && v.what == what && v.at == at;
            let read = self.values().filter(|(_, c, v)| of(v) && c.heading.unknown.is_empty());
            read.map(|(n, _, _)| n).collect::<Vec<_>>()
        };
        let sided = [At::Before, At::After].iter().all(|&at| !read(What::Speed, at).is_empty());
        if !sided || !read(What::Height, At::Row).is_empty() {
            return;
        }
        // So do the greatest heights that it came to.
        let highest = self
            .values()
            .filter(|(_, c, v)| v.what == What::Height && v.role == Role::Max && c.heading.unknown.is_empty());
        let highest: Vec<usize> = highest.map(|(n, _, _)| n).collect();
        let speeds: Vec<usize> = [At::Before, At::After].iter().flat_map(|&at| read(What::Speed, at)).collect();
        let times = self.values().filter(|(_, _, v)| v.what == What::Time && v.role == Role::Reading);
        let dark = |n: &usize| speeds.iter().any(|&speed| one_way(region, *n, speed));
        let dark: Vec<usize> = times.map(|(n, _, _)| n).filter(dark).collect();
        for index in read(What::Height, At::Release).into_iter().chain(highest).chain(dark) {
            self.leave(index, Why::Elsewhere);
        }
    }

    /// Whether all readings are speeds before and after a bounce.
    pub(in crate::read) fn of_speeds(&self) -> bool {
        let sided = |at: At| self.values().any(|(_, _, v)| v.what == What::Speed && v.at == at);
        let read = |v: &Value| v.role != Role::Error;
        sided(At::Before) && sided(At::After) && self.values().all(|(_, _, v)| !read(v) || v.what == What::Speed)
    }

    /// `T1`, `T2` beside heights are trials, and no times, where no unit of time is stated.
    pub(super) fn capitals(&mut self, region: &Region<'_>) {
        let dimension = |c: &Column, of: Dimension| c.unit.is_some_and(|unit| unit.dimension == of);
        let timed = region.units.0.is_some() || self.columns.iter().any(|c| dimension(c, Dimension::Time));
        let lengths = region.units.1.is_some() || self.columns.iter().any(|c| dimension(c, Dimension::Length));
        if timed || !lengths {
            return;
        }
        let bare = |index: usize| {
            region.rows.iter().all(|&row| match region.view.read(row, index) {
                Cell::Number(m) => m.unit.is_none(),
                _ => clock(region.cell(row, index)).is_none(),
            })
        };
        for (index, column) in self.columns.iter_mut().enumerate() {
            let name = column.heading.text.rsplit([' ', ':']).next().unwrap_or_default();
            let number = name.strip_prefix('T').filter(|n| n.parse::<u32>().is_ok());
            if let (Some(number), Kind::Value(value)) = (number, &mut column.kind)
                && value.what == What::Time
                && bare(index)
            {
                (value.what, value.at) = (What::Unsaid, At::Row);
                value.trial = format!("trial {number}");
            }
        }
    }

    /// The coarser of two columns that say the same in every row to their last digits, as in
    /// centimetres and in inches; the other one where they are written alike.
    pub(super) fn alike(&self, region: &Region<'_>, one: usize, other: usize) -> Option<usize> {
        let si = |row: usize, column: usize| self.written(region, row, column);
        let pairs: Vec<_> = region.rows.iter().filter_map(|&row| Some((si(row, one)?, si(row, other)?))).collect();
        let rounded = |((a, half), (b, other)): &((f64, f64), (f64, f64))| (a - b).abs() <= 1.001 * (half + other);
        let twice = || region.rows.iter().all(|&row| region.cell(row, one) == region.cell(row, other));
        let units = self.columns[one].unit != self.columns[other].unit;
        let alike = pairs.len() > 1 && (units && pairs.iter().all(rounded) || twice());
        let coarser = pairs.iter().map(|(a, b)| a.1 - b.1).sum::<f64>() > 0.0;
        alike.then_some(if coarser { one } else { other })
    }

    /// Whether two columns add up to the same in every row, to their last digits.
    pub(super) fn add_up_to_one(&self, region: &Region<'_>, one: usize, other: usize) -> bool {
        let sum = |&row: &usize| {
            let ((a, half), (b, rest)) = (self.written(region, row, one)?, self.written(region, row, other)?);
            Some((a + b, 2.0 * (half + rest)))
        };
        let sums: Vec<(f64, f64)> = region.rows.iter().filter_map(sum).collect();
        sums.len() > 1 && sums.iter().all(|(sum, off)| (sum - sums[0].0).abs() <= *off)
    }

    /// The number of a cell in SI units, and half a unit in its last place.
    pub(in crate::read) fn written(&self, region: &Region<'_>, row: usize, column: usize) -> Option<(f64, f64)> {
        let Cell::Number(m) = region.view.read(row, column) else { return None };
        let unit = m.unit.or(self.columns[column].unit)?;
        let text = region.cell(row, column);
        let digits =
            text.find(['.', ',']).map_or(0, |at| text[at + 1..].chars().take_while(char::is_ascii_digit).count());
        Some((unit.si(m.value), unit.si(0.5 * 0.1f64.powf(digits as f64))))
    }

    /// `Drop 1,Rebound 1,Drop 2,Rebound 2`: each drop with its own rebound; a single numbered drop
    /// is that of all bounces.
    pub(super) fn paired(&mut self, region: &Region<'_>) -> Result<(), TableError> {
        let number = |trial: &str| trial.rsplit(' ').next().and_then(|n| n.parse::<usize>().ok());
        let mut drops: Vec<(usize, usize)> = Vec::new();
        let mut rebounds: Vec<(usize, usize)> = Vec::new();
        for (index, column, value) in self.values().filter(|(_, _, v)| matches!(v.what, What::Height | What::Unsaid)) {
            match value.at {
                At::Nth(n) if value.trial.is_empty() => rebounds.push((n, index)),
                At::Row if column.heading.has(Atom::Release) && !column.heading.has(Atom::Rebound) => {
                    drops.extend(number(&value.trial).filter(|_| value.drop.is_none()).map(|n| (n, index)));
                }
                _ => {}
            }
        }
        drops.sort_unstable();
        rebounds.sort_unstable();
        if drops.is_empty() || rebounds.is_empty() {
            return Ok(());
        }
        let same = drops.iter().map(|(n, _)| n).eq(rebounds.iter().map(|(n, _)| n));
        if let ([(_, drop)], false) = (drops.as_slice(), same && rebounds.len() > 1) {
            self.place(*drop, At::Release, String::new());
            return Ok(());
        }
        if !same {
            let (first, second) = (drops[0].1, rebounds[0].1);
            let name = |n: usize| shown(&self.columns[n].heading.text);
            let message = format!("which of the drops such as '{}' does '{}' belong to?", name(first), name(second));
            return Err(region
                .header_error(second, message)
                .question()
                .help("give each drop a row of its own, or one rebound of the same number"));
        }
        for ((n, drop), (_, rebound)) in drops.into_iter().zip(rebounds) {
            self.place(drop, At::Release, format!("drop {n}"));
            self.place(rebound, At::Row, format!("drop {n}"));
        }
        Ok(())
    }

    pub(super) fn place(&mut self, index: usize, at: At, trial: String) {
        if let Kind::Value(value) = &mut self.columns[index].kind {
            (value.at, value.trial, value.or_trial) = (at, trial, false);
        }
    }

    /// `H` beside `h`, a plain `Height` beside rebounds: where the ball was dropped, if it is above
    /// all others of its row.
    pub(super) fn capital(&mut self, region: &Region<'_>) {
        let letter = |c: &Column| c.heading.text.split([' ', '(', '[', ',', '_']).next().unwrap_or_default().to_owned();
        let has = |c: &Column, atoms: &[Atom]| atoms.iter().any(|atom| c.heading.has(*atom));
        // Columns that are only counted, `1,2,3`, hold what stands beside them.
        let high = |v: &Value| v.what == What::Height || v.what == What::Unsaid && !v.trial.is_empty();
        let plain = |c: &Column, v: &Value| {
            let other = [Atom::Release, Atom::Before, Atom::After, Atom::Top, Atom::Rebound, Atom::Impact];
            let named = c.heading.has(Atom::Height) && c.heading.unknown.is_empty() && !has(c, &other);
            let own = v.role == Role::Reading && v.at == At::Row && v.trial.is_empty() && v.group.is_empty();
            high(v) && own && (named || letter(c) == "H")
        };
        let rebound = |c: &Column, v: &Value| {
            let sprung = has(c, &[Atom::Rebound, Atom::Impact, Atom::After]) || !c.heading.has(Atom::Height);
            let of_row = v.at == At::Row && (sprung || !v.trial.is_empty() || !v.group.is_empty());
            high(v) && c.heading.unknown.is_empty() && (of_row || matches!(v.at, At::Nth(n) if n > 0))
        };
        let of = |name: Option<&str>| {
            let mut found = self.values().filter(|(_, c, v)| plain(c, v) && name.is_none_or(|name| letter(c) == name));
            found.next().map(|(n, _, _)| n).filter(|_| found.next().is_none())
        };
        let counted = self.number().is_some_and(|(_, sure)| sure);
        let Some(release) = of(Some("H")).or_else(|| of(None).filter(|_| !counted)) else { return };
        let lower = |(_, c, v): &(usize, &Column, &Value)| rebound(c, v) || high(v) && letter(c) == "h";
        // A mean beside them says nothing more, but by itself it stands for them.
        let of = |role: Role| {
            let read = |(_, c, v): &(usize, &Column, &Value)| {
                v.role == role && c.heading.unknown.is_empty() && !c.of_hundredths()
            };
            self.values().filter(read).filter(|(n, _, _)| *n != release).collect::<Vec<_>>()
        };
        let read = Some(of(Role::Reading)).filter(|read| !read.is_empty()).unwrap_or_else(|| of(Role::Mean));
        let others: Vec<usize> = read.iter().map(|(n, _, _)| *n).collect();
        let number = |row: usize, column: usize| match region.view.read(row, column) {
            Cell::Number(m) => Some((m.unit.or(self.columns[column].unit), m.value)),
            _ => None,
        };
        let above = |release: (Option<Unit>, f64), below: (Option<Unit>, f64)| match (release.0, below.0) {
            (Some(one), Some(other)) => one.si(release.1) > other.si(below.1),
            (None, None) => release.1 > below.1,
            _ => false,
        };
        let pairs = region.rows.iter().flat_map(|&row| others.iter().map(move |&n| (row, n)));
        let mut pairs = pairs.filter_map(|(row, n)| Some((number(row, release)?, number(row, n)?))).peekable();
        if read.iter().all(lower) && pairs.peek().is_some() && pairs.all(|(release, below)| above(release, below)) {
            self.place(release, At::Release, String::new());
        }
    }

    /// `dh` beside `h`, the same number in every row: its error, as differences of a ball's heights
    /// cannot be.
    pub(super) fn deltas(&mut self, region: &Region<'_>) {
        let bare = |text: &str| text.split(['(', '[', ',', '/']).next().unwrap_or_default().replace([' ', '_'], "");
        let names: Vec<String> = self.columns.iter().map(|c| bare(&c.heading.text)).collect();
        for index in 0..names.len() {
            let of = ["d", "Δ", "∆", "δ", "u"].iter().find_map(|mark| names[index].strip_prefix(mark));
            let reading = |n: &usize| {
                let column = &self.columns[*n];
                of == Some(names[*n].as_str()) && column.holds(What::Height) && column.heading.unknown.is_empty()
            };
            let one_unit = |n: &usize| self.columns[*n].heading.unit == self.columns[index].heading.unit;
            let Some(of) = (0..names.len()).find(reading).filter(one_unit).filter(|_| region.constant(index)) else {
                continue;
            };
            let name = shown(&self.columns[index].heading.text);
            self.aside.retain(|aside| aside.name != name);
            self.columns[index].heading.unknown.clear();
            self.columns[index].kind = Kind::Error(of);
        }
    }

    /// `h_n` beside `h_n+1`: of a bounce what was before it, and what comes after it.
    pub(super) fn placed(&mut self) {
        let places: Vec<(usize, i8, What)> =
            self.values().filter_map(|(n, c, v)| Some((n, c.heading.place?, v.what))).collect();
        for &(index, place, what) in &places {
            let later = places.iter().any(|p| p.2 == what && p.1 > place);
            let earlier = places.iter().any(|p| p.2 == what && p.1 < place);
            if let Kind::Value(value) = &mut self.columns[index].kind
                && later != earlier
            {
                value.at = match (what, later) {
                    (What::Height, true) => At::Release,
                    (_, true) => At::Before,
                    (What::Speed, false) => At::After,
                    (_, false) => At::Row,
                };
            }
        }
    }

    /// Flights after the first bounce, and no others, beside a height of release are those of the
    /// drop of their row.
    pub(super) fn flown(&mut self) {
        let read = |v: &Value| v.role == Role::Reading;
        let nth: Vec<_> = self.values().filter(|(_, _, v)| read(v) && matches!(v.at, At::Nth(_))).collect();
        let first =
            |c: &Column, v: &Value| v.what == What::Interval && v.at == At::Nth(1) && c.heading.unknown.is_empty();
        let of_rows = self
            .values()
            .any(|(_, c, v)| read(v) && v.at == At::Row && v.what != What::Unsaid && c.heading.unknown.is_empty());
        let released = self
            .values()
            .any(|(_, c, v)| read(v) && (v.what, v.at) == (What::Height, At::Release) && c.heading.unknown.is_empty());
        if !nth.iter().all(|(_, c, v)| first(c, v)) || !released || of_rows {
            return;
        }
        let flights: Vec<(usize, String)> = nth.into_iter().map(|(n, _, v)| (n, v.trial.clone())).collect();
        flights.into_iter().for_each(|(index, trial)| self.place(index, At::Row, trial));
    }

    /// `u` beside `v`, `v` beside `v'`, or `v down` beside `v up`: the speeds before and after, as
    /// schools write them.
    pub(super) fn letters(&mut self) {
        let speed = |c: &Column, name: &str| {
            let unit = c.heading.unit.is_some_and(|unit| unit.dimension == Dimension::Speed);
            unit && c.heading.text.split([' ', '(', '[', '/']).next() == Some(name) && c.heading.only()
        };
        let one = |name: &str| self.only(|c| speed(c, name));
        let after = |&n: &usize| self.columns[n].value().is_some_and(|v| (v.what, v.at) == (What::Speed, At::After));
        let primed = (0..self.columns.len()).filter(after).find(|&n| self.columns[n].heading.text.starts_with('v'));
        let rising = (0..self.columns.len()).find(after);
        let falling = (0..self.columns.len()).find(|&n| {
            let [word] = self.columns[n].heading.unknown.as_slice() else { return false };
            self.columns[n].holds(What::Speed) && Phrase::Down.is(&folded(word))
        });
        let lettered = one("u").zip(one("v")).or(one("v").zip(primed));
        let Some((before, after)) = lettered.or(falling.zip(rising)) else { return };
        self.becomes(before, What::Speed, At::Before);
        self.place(after, At::After, String::new());
    }

    /// `A: drop (cm)` beside `B: rebound (cm)`: what stands before a colon counts columns, and
    /// tells no runs apart, where no two of them are of the same quantity and event.
    pub(super) fn enumerated(&mut self) {
        let runs: Vec<(usize, String, (What, At))> = self
            .values()
            .filter(|(_, c, v)| c.heading.text.contains(':') && !v.trial.is_empty())
            .map(|(n, _, v)| (n, v.trial.clone(), (v.what, v.at)))
            .collect();
        let apart = |(n, (_, run, of)): (usize, &(usize, String, (What, At)))| {
            runs[..n].iter().all(|(_, other, same)| other != run && same != of)
        };
        if runs.len() > 1 && runs.iter().enumerate().all(apart) {
            for (index, _, _) in &runs {
                if let Kind::Value(value) = &mut self.columns[*index].kind {
                    value.trial.clear();
                }
            }
        }
    }

    /// What names flights by the two bounces that each lies between counts bounces, whatever stands
    /// above it.
    pub(super) fn spans(&mut self, region: &Region<'_>) {
        for index in 0..self.columns.len() {
            let mut cells = region.rows.iter().map(|&row| region.cell(row, index)).filter(|cell| !cell.is_empty());
            let open = self.columns[index].unit.is_none() && !self.columns[index].heading.turns();
            let first = cells.next().and_then(between);
            if open && first.is_some() && cells.clone().count() > 1 && cells.all(|cell| between(cell).is_some()) {
                self.columns[index].heading.unknown.clear();
                self.columns[index].kind = Kind::Number { sure: true };
            }
        }
    }

    /// Events that are only counted; and a letter that may count, `k`, above what counts nothing.
    pub(super) fn counted(&mut self, region: &Region<'_>) {
        let parts = |n: usize| {
            let mut cells = region.rows.iter().map(|&row| region.view.read(row, n));
            cells.any(
                |cell| matches!(cell, Cell::Number(m) if m.unit.is_none() && (m.value - m.value.round()).abs() > OFF),
            )
        };
        for index in 0..self.columns.len() {
            if self.columns[index].kind == (Kind::Number { sure: false }) && parts(index) {
                self.leave(index, Why::Other);
            }
        }
        self.uncounted(region, parts);
        let Some(event) = self.one(&Kind::Event) else { return };
        let numbers = || region.rows.iter().filter(|&&row| region.view.is_number(row, event)).count();
        let words = || region.rows.iter().filter(|&&row| region.view.read(row, event) == Cell::Words).count();
        if numbers() > words() {
            self.columns[event].kind = Kind::Number { sure: true };
        }
    }

    /// `bounce` beside heights of release, and nothing else: above numbers of which none follows the
    /// one before it counts nothing, and is what each drop came back to; so is `rebound` above
    /// numbers that are not whole, `parts`.
    fn uncounted(&mut self, region: &Region<'_>, parts: impl Fn(usize) -> bool) {
        let Some((index, true)) = self.number() else { return };
        let cells = region.rows.iter().map(|&row| bounce(region.cell(row, index)));
        let numbers: Option<Vec<usize>> = cells.collect();
        let follows = |n: &[usize]| n.windows(2).any(|pair| pair[1].abs_diff(pair[0]) < 2);
        let apart = numbers.is_some_and(|n| n.len() > 1 && n.iter().all(|n| *n > 1) && !follows(&n));
        let read: Vec<At> = self.values().filter(|(_, _, v)| v.role != Role::Error).map(|(_, _, v)| v.at).collect();
        let of_drops = read == [At::Release];
        let rebounds = self.columns[index].heading.has(Atom::Rebound) && parts(index);
        if (apart || rebounds) && of_drops && self.columns[index].heading.unit.is_none() {
            self.columns[index].kind = Kind::Value(Value::of(What::Height));
        }
    }

    /// What was read for letters in place of digits, the first of each column.
    pub(super) fn respelt(&mut self, region: &Region<'_>) {
        let first = |(n, _, _): (usize, &Column, &Value)| {
            let mut cells = region.rows.iter().map(|&row| region.cell(row, n));
            cells.find_map(|cell| Some((n, cell.to_owned(), respelt(cell)?)))
        };
        let found: Vec<(usize, String, String)> = self.values().filter_map(first).collect();
        for (n, written, meant) in found {
            let heading = shown(&self.columns[n].heading.text);
            self.notes.push(Note::Misspelt { written, heading, meant });
        }
    }

    /// A column without a unit that counts its rows, beside others that are measured: `Peak,Peak
    /// height (m)`.
    pub(super) fn counting(&mut self, region: &Region<'_>) {
        if self.number().is_some() {
            return;
        }
        let measured = |n: usize| {
            let beside = |c: &Column| c.unit.is_some() || region.units != (None, None);
            self.one(&Kind::Frame).is_some() || self.values().any(|(other, c, _)| other != n && beside(c))
        };
        let found = self.values().find(|(n, c, v)| {
            // A time is none, in whatever unit it counts.
            let named = !c.heading.has(Atom::Height) || c.heading.has(Atom::Rebound);
            let counted = matches!(v.what, What::Height | What::Interval | What::Unsaid) && named;
            let bare = counted && c.unit.is_none() && v.at == At::Row && v.trial.is_empty() && v.group.is_empty();
            // Words below the table are remarks.
            let rows =
                region.rows.iter().filter(|&&row| !matches!(region.view.read(row, *n), Cell::Empty | Cell::Words));
            let first =
                rows.clone().next().and_then(|&row| region.cell(row, *n).parse::<usize>().ok()).filter(|n| *n < 2);
            let count = rows.clone().count();
            let counts = first
                .is_some_and(|first| rows.enumerate().all(|(k, &row)| region.cell(row, *n).parse() == Ok(first + k)));
            bare && counts && count > 1 && measured(*n)
        });
        if let Some(index) = found.map(|(n, _, _)| n) {
            self.columns[index].kind = Kind::Number { sure: self.columns[index].heading.has(Atom::Rebound) };
        }
    }

    /// A column without a unit whose cells all name bounces, some of them in words: `bounce 1 to
    /// bounce 2`. Below the name of drops a sign and a number, `#1`, count these.
    pub(super) fn naming(&mut self, region: &Region<'_>) {
        if self.number().is_some() {
            return;
        }
        let found = self.values().find(|(n, c, _)| {
            let cells = || region.rows.iter().map(|&row| region.cell(row, *n)).filter(|cell| !cell.is_empty());
            let words =
                cells().any(|cell| cell.contains(char::is_alphabetic) && cell.contains(|c: char| c.is_ascii_digit()));
            c.unit.is_none() && words && cells().count() > 1 && cells().all(|cell| bounce(cell).is_some())
        });
        let met = |cell: &str| split(cell).iter().any(|word| word.is(Atom::Impact) || word.is(Atom::Rebound));
        if let Some((index, column, _)) = found {
            let drops =
                column.heading.has(Atom::Release) && !region.rows.iter().any(|&row| met(region.cell(row, index)));
            self.columns[index].kind = Kind::Number { sure: !drops };
        }
    }

    /// `Impact time (s),Drop 1,Drop 2` above 1, 2, 3: the first column counts the bounces, and its
    /// name is that of what stands in the others.
    pub(super) fn spanning(&mut self, region: &Region<'_>) {
        let Some((index, first, value)) = self.values().next() else { return };
        let of_bounces = first.heading.has(Atom::Impact) || first.heading.has(Atom::Rebound);
        let (what, unit, sure) = (value.what, first.unit, first.heading.has(Atom::Impact));
        let silent: Vec<usize> = self
            .values()
            .filter(|(_, c, v)| v.what == What::Unsaid && c.unit.is_none() && v.role == Role::Reading)
            .map(|(n, _, _)| n)
            .collect();
        let alone = silent.len() + 1 == self.values().count() && !silent.is_empty() && !silent.contains(&index);
        let cells = region.rows.iter().map(|&row| bounce(region.cell(row, index)));
        let counts = cells.clone().enumerate().all(|(n, cell)| cell == Some(n) || cell == Some(n + 1));
        if !of_bounces || unit.is_none() || !alone || !counts || cells.count() < 2 || value.at != At::Row {
            return;
        }
        self.columns[index].kind = Kind::Number { sure };
        self.columns[index].unit = None;
        for column in silent {
            self.columns[column].unit = unit;
            if let Kind::Value(value) = &mut self.columns[column].kind {
                value.what = what;
            }
        }
    }

    /// Under the name of a key, such as `Bounce` or `Experiment`, cells that all bear units are
    /// readings.
    pub(super) fn measured(&mut self, region: &Region<'_>) {
        for column in 0..self.columns.len() {
            let heading = &self.columns[column].heading;
            let met = || heading.has(Atom::Impact) || heading.has(Atom::Rebound);
            let key = match self.columns[column].kind {
                Kind::Number { .. } | Kind::Trial | Kind::Event => true,
                // `Ball hits the floor at`.
                Kind::Setting => met(),
                _ => false,
            };
            let cells: Vec<Cell> = region.rows.iter().map(|&row| region.view.read(row, column)).collect();
            let unit = |cell: &Cell| match cell {
                Cell::Number(m) => m.unit.filter(|unit| unit.scale != Scale::Percent).map(|unit| unit.dimension),
                _ => None,
            };
            let first = cells.iter().find_map(unit).filter(|_| key);
            let of_one = cells.iter().all(|cell| matches!(cell, Cell::Empty | Cell::Words) || unit(cell) == first);
            let what = match first {
                Some(Dimension::Length) => What::Height,
                Some(Dimension::Speed) => What::Speed,
                Some(Dimension::Time) if self.columns[column].kind != Kind::Trial => What::Time,
                _ => continue,
            };
            if of_one && cells.iter().filter(|cell| unit(cell).is_some()).count() > 1 {
                // Of cells that held several readings each column is a trial.
                let run = self.columns[column].heading.text.split_once(':').map(|(run, _)| run.to_owned());
                self.columns[column].kind = Kind::Value(Value { trial: run.unwrap_or_default(), ..Value::of(what) });
            }
        }
    }
}
