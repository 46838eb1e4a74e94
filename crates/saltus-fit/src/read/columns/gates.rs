//! Pairs of columns that say together what neither says alone: how long a gate is blocked on the
//! way down and up, when a contact begins and ends, from where and up to where a ball came.

use super::{Column, Columns, Kind};
use crate::read::aside::{LeftAside, Why};
use crate::read::grid::shown;
use crate::read::heading::{At, Role, Value, What};
use crate::read::phrases::Phrase;
use crate::read::region::Region;
use crate::read::units::{Dimension, Unit};
use crate::read::vocabulary::{Atom, folded, meanings};
use crate::read::words::{has_word, pieces};
use crate::statistics::median;

/// The words of a heading in plain letters.
fn words(column: &Column) -> Vec<String> {
    pieces(&column.heading.text).iter().map(|word| folded(word)).collect()
}

/// Whether a heading is one of two words for a way, and nothing else.
fn of_way(column: &Column, one: Phrase, other: Phrase) -> bool {
    column.of_words(one) || column.of_words(other)
}

impl Column {
    /// Whether its unit is one of time.
    fn timed(&self) -> bool {
        self.unit.is_some_and(|unit| unit.dimension == Dimension::Time)
    }

    /// Whether a word of its heading is of this kind.
    fn says(&self, phrase: Phrase) -> bool {
        words(self).iter().any(|word| phrase.is(word))
    }

    /// Whether its heading is words of this kind and nothing else, beside its unit.
    pub(in crate::read) fn of_words(&self, phrase: Phrase) -> bool {
        let name = folded(self.heading.text.split(['(', '[']).next().unwrap_or_default());
        phrase.is(name.trim())
    }

    /// Whether a phrase of this kind ends its heading, `let go from (cm)`, or begins it before a
    /// height, `из высоты`, and it is of no time and of no speed.
    fn leads(&self, phrase: Phrase) -> bool {
        let all = words(self);
        let unit = self.heading.unit.is_some() && all.last().is_some_and(|word| Unit::parse(word).is_some());
        let bare = &all[..all.len() - usize::from(unit && all.len() > 1)];
        let is = |words: &[String]| !words.is_empty() && phrase.is(&words.join(" "));
        // `s` is a unit, and leads in Croatian.
        let end = |words: &[String]| (1..=words.len().min(LEADS)).any(|n| is(&words[words.len() - n..]));
        let ends = end(bare) || end(&all);
        let height = |word: &String| meanings(word).is_some_and(|atoms| atoms.contains(&Atom::Height));
        let before = |words: &[String]| {
            (1..=words.len().min(LEADS)).any(|n| is(&words[..n]) && words.get(n).is_some_and(height))
        };
        let last = |words: &[String]| words.split_last().is_some_and(|(last, rest)| height(last) && end(rest));
        let begins = before(bare) || last(bare);
        let other = [Atom::Time, Atom::Interval, Atom::Total, Atom::Speed, Atom::Frame];
        // `no.` counts, and leads in Latvian.
        let length = self.unit.map_or(bare.len() > 1, |unit| unit.dimension == Dimension::Length);
        (ends || begins) && length && !other.iter().any(|atom| self.heading.has(*atom))
    }
}

/// What leads to a height is of no more words: `back up to`.
const LEADS: usize = 3;

impl Columns {
    /// `before` beside `after`, `down` beside `up`, where a line states the unit of speeds and no
    /// other: the columns that say no more than that are speeds.
    pub(super) fn sped(&mut self, region: &Region<'_>) {
        let Some(unit) = region.speed else { return };
        let sided = |c: &Column, own: Atom, other: Atom| {
            let silent = c.value().is_some_and(|v| v.what == What::Unsaid && v.role == Role::Reading);
            silent && c.heading.has(own) && !c.heading.has(other)
        };
        let before = |c: &Column| sided(c, Atom::Before, Atom::After) || of_way(c, Phrase::Down, Phrase::Inwards);
        let after = |c: &Column| sided(c, Atom::After, Atom::Before) || of_way(c, Phrase::UpTo, Phrase::Outwards);
        let bare = |c: &Column| c.unit.is_none();
        let Some((before, after)) = self.pair(|c| bare(c) && before(c), |c| bare(c) && after(c)) else { return };
        for (index, at) in [(before, At::Before), (after, At::After)] {
            self.becomes(index, What::Speed, at);
            self.columns[index].unit = Some(unit);
        }
    }

    /// What pairs of columns say together.
    pub(super) fn coupled(&mut self, region: &Region<'_>) {
        self.gates(region);
        self.in_and_out();
        self.contacts(region);
        self.durations(region);
        self.ranged(region);
        self.flights(region);
        self.up_to_from(region);
        self.released_from();
        self.led_from_and_to(region);
        self.until_hit(region);
        self.until_rest(region);
    }

    /// `number of hits` of which every row has as many, beside the height of release and a time:
    /// that until the ball hits for the last of them.
    fn until_hit(&mut self, region: &Region<'_>) {
        let Some((number, _)) = self.number() else { return };
        let counts: Vec<&str> = region.rows.iter().map(|&row| region.cell(row, number)).collect();
        let alike = counts.len() > 1 && counts.iter().all(|count| *count == counts[0]);
        let Some(hits) = counts.first().filter(|_| alike).and_then(|count| count.parse().ok()) else { return };
        let timed = |v: &Value| matches!(v.what, What::Total | What::Time) && v.at == At::Row;
        let total = self.only(|c| c.value().is_some_and(timed));
        if let Some(total) = total.filter(|_| hits > 1 && self.any(What::Height, Some(At::Release))) {
            self.becomes(total, What::Total, At::Nth(hits));
            self.leave(number, Why::Other);
        }
    }

    /// The only height beside the time until all is quiet, or that of the first flight, of several
    /// rows: from there each drop was let go.
    fn until_rest(&mut self, region: &Region<'_>) {
        let read = |what: What| {
            let mut found = self.values().filter(move |(_, c, v)| v.what == what && c.heading.unknown.is_empty());
            found.next().filter(|(_, _, v)| v.at == At::Row && v.trial.is_empty()).filter(|_| found.next().is_none())
        };
        let flight = |v: &Value| v.what == What::Interval && v.at == At::Nth(1) && v.role == Role::Reading;
        let total = read(What::Total).filter(|(_, c, _)| c.heading.has(Atom::Rest)).is_some()
            || self.number().is_none() && self.values().any(|(_, c, v)| flight(v) && c.heading.unknown.is_empty());
        let height = read(What::Height).map(|(n, _, _)| n);
        let alone = total && self.values().count() == 2 && region.drop.is_none() && region.rows.len() > 1;
        if let Some(index) = height.filter(|_| alone) {
            let first = self.values().find(|(_, _, v)| flight(v)).map(|(n, _, _)| n);
            self.becomes(index, What::Height, At::Release);
            if let Some(first) = first {
                self.becomes(first, What::Interval, At::Row);
            }
        }
    }

    /// The only column that fits.
    pub(super) fn only(&self, fits: impl Fn(&Column) -> bool) -> Option<usize> {
        let mut found = (0..self.columns.len()).filter(|&n| fits(&self.columns[n]));
        found.next().filter(|_| found.next().is_none())
    }

    /// The only two columns that fit, the first as `one` and the other as `other`.
    fn pair(&self, one: impl Fn(&Column) -> bool, other: impl Fn(&Column) -> bool) -> Option<(usize, usize)> {
        self.only(one).zip(self.only(other)).filter(|(one, other)| one != other)
    }

    /// Whether two columns have one unit, and names that differ in words of these kinds alone.
    fn alike_but(&self, columns: [usize; 2], phrases: [Phrase; 2]) -> bool {
        let [one, other] = columns.map(|n| &self.columns[n]);
        let others = |c: &Column| -> Vec<String> {
            words(c).into_iter().filter(|word| !phrases.iter().any(|phrase| phrase.is(word))).collect()
        };
        one.unit == other.unit && others(one) == others(other)
    }

    /// A column is what it is called beside another one, whatever else its words say.
    pub(super) fn becomes(&mut self, index: usize, what: What, at: At) {
        let name = shown(&self.columns[index].heading.text);
        self.aside.retain(|aside| aside.name != name);
        self.columns[index].heading.unknown.clear();
        self.columns[index].kind = Kind::Value(Value { at, ..Value::of(what) });
    }

    /// `Gate time down (ms)` beside `Gate time up (ms)`: a ball of one size blocks a gate for as
    /// long as it is slow, so that the speeds are to each other as the times turned over.
    fn gates(&mut self, region: &Region<'_>) {
        let named = region.aside.iter().any(|aside| names_gate(&aside.name)) || names_gate(region.view.grid.name);
        let gate = |c: &Column| c.timed() && (named || names_gate(&c.heading.text));
        let down = |c: &Column| c.heading.has(Atom::Before) || c.says(Phrase::Down) || c.says(Phrase::Inwards);
        let up =
            |c: &Column| (c.heading.has(Atom::After) || c.says(Phrase::UpTo) || c.says(Phrase::Outwards)) && !down(c);
        let Some((before, after)) = self.pair(|c| gate(c) && down(c), |c| gate(c) && up(c)) else { return };
        // Where each drop began says nothing more.
        let drop = |v: &Value| (v.what, v.at) == (What::Height, At::Release);
        let read = self.values().filter(|(n, _, v)| !drop(v) && (!v.or_trial || !region.counts(*n))).count();
        if self.columns[before].unit != self.columns[after].unit || read > 2 {
            return;
        }
        for (index, at) in [(before, At::Before), (after, At::After)] {
            self.becomes(index, What::Speed, at);
            self.columns[index].unit = Some(Unit::SPEED);
            self.columns[index].turned = true;
        }
    }

    /// `v_in` beside `v_out`, `v hin` beside `v zurück`, whose names differ in that word alone: the
    /// speeds on the way to what a ball bounces from, and back.
    fn in_and_out(&mut self) {
        let speed =
            |c: &Column| c.heading.has(Atom::Speed) || c.unit.is_some_and(|unit| unit.dimension == Dimension::Speed);
        let way = |phrase: Phrase| move |c: &Column| speed(c) && c.says(phrase);
        let Some((to, back)) = self.pair(way(Phrase::Inwards), way(Phrase::Outwards)) else { return };
        let known = |n: usize| {
            let heading = &self.columns[n].heading;
            heading.unknown.iter().all(|word| Phrase::Inwards.is(&folded(word)) || Phrase::Outwards.is(&folded(word)))
        };
        let turns = self.columns[to].heading.turns() || self.columns[back].heading.turns();
        let alike = self.alike_but([to, back], [Phrase::Inwards, Phrase::Outwards]);
        if alike && known(to) && known(back) && !turns {
            self.becomes(to, What::Speed, At::Before);
            self.becomes(back, What::Speed, At::After);
        }
    }

    /// `t_on (ms)` beside `t_off (ms)`, whose names differ in that word alone: each contact begins
    /// after the one before has ended, and is far shorter than what lies between.
    fn contacts(&mut self, region: &Region<'_>) {
        let begins = |c: &Column| c.timed() && c.says(Phrase::Begins) && !c.says(Phrase::Ends);
        let ends = |c: &Column| c.timed() && c.says(Phrase::Ends) && !c.says(Phrase::Begins);
        let Some((on, off)) = self.pair(begins, ends) else { return };
        if !self.alike_but([on, off], [Phrase::Begins, Phrase::Ends]) {
            return;
        }
        let times = |n: usize| region.rows.iter().map(|&row| region.view.number(row, n)).collect::<Option<Vec<f64>>>();
        let Some((begun, ended)) = times(on).zip(times(off)) else { return };
        let mut lasted: Vec<f64> = ended.iter().zip(&begun).map(|(end, begin)| end - begin).collect();
        let mut flown: Vec<f64> = begun.iter().skip(1).zip(&ended).map(|(begin, end)| begin - end).collect();
        let ordered = lasted.iter().chain(&flown).all(|time| *time > 0.0);
        let (Some(contact), Some(flight)) = (median(&mut lasted), median(&mut flown)) else { return };
        if ordered && contact < SHORT * flight {
            self.becomes(on, What::Time, At::Row);
            self.columns[off].heading.unknown.clear();
            // What blocks a gate or makes a sound is not the floor all that time.
            let named = |text: &str| names_gate(text) || names_sound(text);
            let other = |text: &LeftAside| named(&text.name);
            if region.aside.iter().any(other)
                || named(region.view.grid.name)
                || region.header.iter().any(|name| named(name))
            {
                self.leave(off, Why::Elsewhere);
            } else {
                self.columns[off].kind = Kind::Ends(on);
            }
        }
    }

    /// `contact time (ms)` beside a clock: a time shorter than what lies between those of the clock is
    /// how long each contact lasts.
    fn durations(&mut self, region: &Region<'_>) {
        let read = |v: &Value| v.what == What::Time && v.at == At::Row && v.role == Role::Reading && v.trial.is_empty();
        let times: Vec<usize> = self.values().filter(|(_, _, v)| read(v)).map(|(n, _, _)| n).collect();
        let &[one, other] = times.as_slice() else { return };
        let brief = match (self.within(region, one, other), self.within(region, other, one)) {
            (true, false) => one,
            (false, true) => other,
            _ => return,
        };
        self.columns[brief].heading.unknown.clear();
        self.leave(brief, Why::Other);
    }

    /// Whether the times of a column are all far shorter than what lies between the one of a clock
    /// beside it and the next.
    fn within(&self, region: &Region<'_>, brief: usize, clock: usize) -> bool {
        let seconds = |row: usize, n: usize| Some(self.columns[n].unit?.si(region.view.number(row, n)?));
        let short = |pair: &[usize]| {
            let between = seconds(pair[1], clock)? - seconds(pair[0], clock)?;
            Some(seconds(pair[0], brief)? < SHORT * between)
        };
        region.rows.len() > 2 && region.rows.windows(2).all(|pair| short(pair) == Some(true))
    }

    /// `range_mm` beside a clock and no other length: the distance that a sensor measures, and no
    /// range of readings.
    fn ranged(&mut self, region: &Region<'_>) {
        let long = |c: &Column| c.unit.is_some_and(|unit| unit.dimension == Dimension::Length);
        let Some(index) = self.only(long).filter(|&n| self.columns[n].says(Phrase::Ranging)) else { return };
        let clock = self.any(What::Time, Some(At::Row)) || self.one(&Kind::Frame).is_some();
        let unread = self.columns[index].value().is_none() || !self.columns[index].heading.unknown.is_empty();
        if clock && unread && region.rows.len() > 2 {
            self.becomes(index, What::Height, At::Row);
            self.columns[index].kind = Kind::Value(Value { position: true, ..Value::of(What::Height) });
        }
    }

    /// Flights beside the times of contacts that they lie between: they leave out how long each
    /// contact lasts, and so are what the COR is of.
    fn flights(&mut self, region: &Region<'_>) {
        let of = |what: What| {
            let read = |c: &Column| c.value().is_some_and(|v| v.what == what && v.at == At::Row && v.trial.is_empty());
            let known = |c: &Column| c.heading.unknown.iter().all(|word| Phrase::Next.is(&folded(word)));
            self.only(|c| read(c) && known(c))
        };
        let Some((time, flight)) = of(What::Time).zip(of(What::Interval)) else { return };
        // What is shorter than all that lies between is how long each contact lasts.
        if self.columns[flight].heading.has(Atom::Impact) && self.within(region, flight, time) {
            self.columns[flight].heading.unknown.clear();
            self.leave(flight, Why::Other);
            return;
        }
        if !self.columns[flight].heading.has(Atom::Air) || self.columns[time].unit != self.columns[flight].unit {
            return;
        }
        let number = |row: usize, n: usize| region.view.number(row, n);
        let lasted = |pair: &[usize]| {
            let between = number(pair[1], time)? - number(pair[0], time)?;
            number(pair[0], flight).map(|flown| (between - flown) / flown)
        };
        let parts: Vec<f64> = region.rows.windows(2).filter_map(lasted).collect();
        if parts.len() > 1
            && parts.len() + 1 == region.rows.len()
            && parts.iter().all(|part| (0.0..SHORT).contains(part))
        {
            self.leave(time, Why::Elsewhere);
            self.becomes(flight, What::Interval, At::Row);
        }
    }

    /// `from what height` beside the height of a rebound, and no other: where each drop began.
    fn released_from(&mut self) {
        let height = |c: &Column| c.holds(What::Height) && c.heading.unknown.is_empty();
        let leads = |c: &Column| words(c).first().is_some_and(|word| Phrase::From.is(word));
        let from = |c: &Column| height(c) && leads(c) && c.heading.has(Atom::Height) && !c.heading.has(Atom::Floor);
        let up = |c: &Column| height(c) && c.heading.has(Atom::Rebound) && !leads(c);
        let Some((from, _)) = self.pair(from, up) else { return };
        if self.values().filter(|(_, _, v)| v.what == What::Height).count() == 2 {
            self.becomes(from, What::Height, At::Release);
        }
    }

    /// `paleista iš` beside `atšoko iki`, `let go from` beside `got to`, whatever the verbs: what
    /// begins and ends so is where a ball was dropped from and where it came up to, if that is
    /// lower in every row. What a ball was dropped from may stand beside names of balls as well.
    fn led_from_and_to(&mut self, region: &Region<'_>) {
        let numbers = |n: usize| region.rows.iter().any(|&row| region.view.is_number(row, n));
        let given = |c: &Column| c.value().is_some_and(|v| v.at == At::Release && v.what == What::Height);
        let from = |c: &Column| c.leads(Phrase::Whence) && !c.heading.has(Atom::Rebound);
        let to = |c: &Column| c.leads(Phrase::Whither) && !c.leads(Phrase::Whence) && !c.heading.has(Atom::Release);
        let Some(from) = self.only(from).filter(|n| numbers(*n)) else { return };
        if let Some(to) = self.only(to).filter(|n| numbers(*n)) {
            let si = |row: usize, n: usize| {
                let number = region.view.number(row, n)?;
                Some(self.columns[n].unit.map_or(number, |unit| unit.si(number)))
            };
            let lower = |&row: &usize| Some(si(row, to)? < si(row, from)?);
            if region.rows.iter().filter_map(lower).all(|lower| lower) {
                self.becomes(from, What::Height, At::Release);
                self.becomes(to, What::Height, At::Row);
            }
            return;
        }
        let sized = |n: usize| self.columns[n].unit.is_some_and(|unit| unit.dimension == Dimension::Length);
        let others: Vec<usize> = (0..self.columns.len()).filter(|n| *n != from && numbers(*n)).collect();
        let column = |n: &usize| &self.columns[*n];
        let alone = !others.iter().any(|n| given(column(n)) || column(n).unit.is_some());
        let rose =
            |n: &usize| column(n).holds(What::Height) && column(n).heading.has(Atom::Rebound) && !given(column(n));
        let beside = self.columns[from].heading.has(Atom::Release) || others.iter().filter(|n| rose(n)).count() == 1;
        if sized(from) && !others.is_empty() && (alone || beside && !others.iter().any(|n| given(column(n)))) {
            self.becomes(from, What::Height, At::Release);
        }
    }

    /// `from` beside `up to`: the heights of a drop and of its rebound.
    fn up_to_from(&mut self, region: &Region<'_>) {
        let height = |c: &Column| c.unit.is_none_or(|unit| unit.dimension == Dimension::Length);
        let from = |c: &Column| height(c) && c.of_words(Phrase::From);
        // `back up to`, `terug tot`.
        let back = |word: &str| Phrase::Outwards.is(word) || Phrase::Rose.is(word) || word == "back";
        let to = |c: &Column| {
            let words = words(c);
            let rest = words.iter().position(|word| !back(word)).map_or(&[][..], |at| &words[at..]);
            height(c) && (c.of_words(Phrase::UpTo) || rest.len() < words.len() && Phrase::UpTo.is(&rest.join(" ")))
        };
        let Some((from, to)) = self.pair(from, to) else { return };
        let number = |n: usize| region.rows.iter().any(|&row| region.view.is_number(row, n));
        if number(from) && number(to) {
            self.becomes(from, What::Height, At::Release);
            self.becomes(to, What::Height, At::Row);
        }
    }
}

/// A contact lasts less than this part of the flight after it.
const SHORT: f64 = 0.5;

/// Whether a text names a gate that a ball runs through.
fn names_gate(text: &str) -> bool {
    has_word(text, Phrase::Gate)
}

/// Whether a text names a sound.
fn names_sound(text: &str) -> bool {
    has_word(text, Phrase::Sound)
}
