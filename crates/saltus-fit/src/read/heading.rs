//! What a heading means: a quantity, its unit, a statistic, the number of a bounce, a trial, a
//! ball, and the words that are not understood.

mod flights;
mod inside;
mod meaning;
mod rates;
mod repeats;
mod signs;

use super::aside::Why;
use super::end::names_end;
use super::kept::{Kept, kept};
use super::units::{Dimension, Scale, Unit};
use super::vocabulary::{Atom, folded, misspelt, narrow, short_for};
use super::words::{Kind, Word, numbers, split, unaddressed};
pub(super) use inside::{DropHeight, Of, is_sign, release, released};
pub(super) use rates::rate;

/// What the numbers of a column measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum What {
    Height,
    /// When a contact was.
    Time,
    /// The time between contacts.
    Interval,
    /// A running clock, or the time from release to rest.
    Total,
    Speed,
    /// The heading does not say; its unit, or its neighbours, may.
    Unsaid,
}

impl What {
    /// The dimension that its unit has; `None` if any.
    pub(super) fn dimension(self) -> Option<Dimension> {
        match self {
            Self::Height => Some(Dimension::Length),
            Self::Time | Self::Interval | Self::Total => Some(Dimension::Time),
            Self::Speed => Some(Dimension::Speed),
            Self::Unsaid => None,
        }
    }
}

/// At which event a number was read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum At {
    Release,
    /// After, or at, this contact.
    Nth(usize),
    /// Before, or after, the only contact there is.
    Before,
    After,
    /// The row tells.
    Row,
}

/// What part the numbers of a column play.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) enum Role {
    Reading,
    Mean,
    Error,
    Max,
    Min,
    Lost,
}

/// A column of numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Value {
    pub(super) what: What,
    pub(super) at: At,
    pub(super) role: Role,
    pub(super) trial: String,
    pub(super) group: String,
    /// A place on a scale, whose zero may be anywhere, rather than a height above the floor.
    pub(super) position: bool,
    /// Also the name of a number of trials: `drop`.
    pub(super) or_trial: bool,
    /// The height that the heading says the ball was dropped from.
    pub(super) drop: Option<DropHeight>,
}

impl Value {
    /// Readings of which the row tells the event.
    pub(super) fn of(what: What) -> Self {
        Self {
            what,
            at: At::Row,
            role: Role::Reading,
            trial: String::new(),
            group: String::new(),
            position: false,
            or_trial: false,
            drop: None,
        }
    }
}

/// What a heading says of its column.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) enum Meaning {
    /// Nothing stands there.
    #[default]
    Empty,
    /// The number of the bounce; `sure` if it says so, and not only that it is a number.
    Number {
        sure: bool,
    },
    /// What happened.
    Event,
    /// A count of frames.
    Frame,
    /// Tells trials apart.
    Trial,
    /// Tells balls, surfaces, conditions apart.
    Setting,
    Value(Value),
    /// No reading, and why.
    Aside(Why),
}

/// A heading, taken apart.
#[derive(Clone, Debug, Default)]
pub(super) struct Heading {
    pub(super) text: String,
    pub(super) unit: Option<Unit>,
    /// The error of every reading below it, in its unit: `height (± 0.5 cm)`.
    pub(super) spread: Option<f64>,
    /// What it means as far as it is understood.
    pub(super) meaning: Meaning,
    /// The words that are not understood; with any, the column is not used unless it is asked for.
    pub(super) unknown: Vec<String>,
    /// Words that are spelt wrong by one letter, and what they were read as.
    pub(super) misspelt: Vec<(String, &'static str)>,
    /// The place of its readings beside the bounce of their row: `h_n` is 0, `h_n+1` is 1.
    pub(super) place: Option<i8>,
    /// It names the COR, worked out from other columns.
    pub(super) cor: bool,
    /// What its numbers are parts of, if it names a ratio of heights and nothing else.
    pub(super) share: Option<Of>,
    /// What its numbers are if they stand for heights, where it names an energy and nothing else.
    pub(super) energy: Option<Value>,
    /// How many frames, or samples, it states to be in a second.
    pub(super) rate: Option<f64>,
    /// A height of release that it states.
    drop: Option<DropHeight>,
    /// The meanings of its words.
    atoms: Vec<Atom>,
    /// Those that name a ball or a surface.
    labels: Vec<String>,
}

impl Heading {
    /// What a heading says.
    pub(super) fn parse(text: &str) -> Self {
        static KEPT: Kept<Heading> = Kept::new(Default::default);
        kept(&KEPT, text, Self::apart)
    }

    /// Takes a heading apart.
    fn apart(text: &str) -> Self {
        let (name, plain) = (text.trim(), narrow(&unaddressed(text)));
        let text = plain.trim();
        let mut heading = Self { text: name.to_owned(), ..Self::default() };
        // The format of a clock, such as `mm:ss.ms`.
        if inside::of_a_clock(text) {
            return Self::parse("time (s)").called(text);
        }
        if let Some(sign) = inside::computed(text) {
            return Self::parse(&format!("calculated {sign}")).called(name);
        }
        // A condition by itself tells its column from the others: `21 °C`.
        if inside::of_a_condition(text) {
            let value = Value { group: text.to_owned(), ..Value::of(What::Unsaid) };
            return Self { meaning: Meaning::Value(value), ..heading };
        }
        // Programs put the run before the name: 'Latest: Time (s)'.
        let spelt = inside::swedish(text);
        let sized = repeats::without_size(&spelt);
        let text = sized.as_ref();
        let (run, name) = match text.split_once(':') {
            Some((run, name)) if !name.trim().is_empty() && !run.contains(['(', '[']) => (run.trim(), name),
            _ => ("", text),
        };
        let mut name = name.to_owned();
        heading.drop = inside::taken(&mut name, release);
        heading.rate = inside::taken(&mut name, rate);
        let condition = inside::taken(&mut name, inside::condition);
        let name = heading.take_spread(&name);
        let bare = heading.take_brackets(&name);
        let bare = heading.take_unit(&bare);
        let (place, bare) = inside::place(&bare);
        heading.place = place;
        let mut words = split(&bare);
        let before = inside::hundredths(&mut words);
        if before.is_some() {
            heading.unit = Unit::parse("%");
        }
        heading.respell(&mut words);
        inside::ranges(&mut words);
        repeats::take(&mut words, &bare, false);
        heading.take_unit_word(&mut words);
        heading.of_trials(&mut words);
        heading.unknown = words.iter().filter(|w| matches!(w.kind, Kind::Unknown)).map(|w| w.text.clone()).collect();
        heading.labels = words.iter().filter(|w| w.is(Atom::Label)).map(|w| w.text.clone()).collect();
        // Hundredths of the height before are ratios.
        heading.atoms.extend(before.filter(|before| *before).map(|_| Atom::Derived));
        let turned = split(run);
        for word in words.iter().chain(&turned) {
            if let Kind::Known(atoms) = word.kind {
                heading.atoms.extend(atoms);
            }
        }
        // `rebound_percent`.
        if heading.unit.is_none() && heading.has(Atom::Percent) && heading.has(Atom::Rebound) {
            heading.unit = Unit::parse("%");
        }
        let whole = heading.unit.is_none_or(|unit| unit.scale == Scale::Percent) && heading.unknown.is_empty();
        let percent = heading.unit.is_some();
        heading.share = inside::share(&bare, &words, before, percent).filter(|_| whole);
        let joules = heading.unit.and_then(Unit::of_height).is_some();
        heading.cor = inside::is_cor(&words) && !heading.turned() && !joules;
        // `v_in` beside `v_out`.
        if (heading.has(Atom::Speed) || heading.has(Atom::Energy)) && words.last().is_some_and(|w| w.text == "in") {
            heading.atoms.push(Atom::Before);
        }
        let placed = matches!(words.as_slice(), [Word { kind: Kind::Ordinal(_), .. }]);
        if !heading.atoms.is_empty() || heading.unit.is_some() || placed {
            heading.meaning = heading.interpret(&words, run);
        }
        heading.energy = heading.of_energy(&words, run);
        if let (Some(condition), Meaning::Value(value)) = (condition, &mut heading.meaning) {
            value.group = [value.group.as_str(), &condition].join(" ").trim_start().to_owned();
        }
        heading
    }

    /// Words that are not known and differ from one that is by a letter are that one, and those
    /// that only words of one meaning begin with are short for it.
    fn respell(&mut self, words: &mut [Word]) {
        // A word by itself is a name.
        let several = words.len() > 1;
        for word in words.iter_mut().filter(|word| matches!(word.kind, Kind::Unknown)) {
            let spelt = folded(&word.text);
            if let Some((meant, atoms)) = misspelt(&spelt).or_else(|| short_for(&spelt).filter(|_| several)) {
                self.misspelt.push((word.text.clone(), meant));
                word.kind = Kind::Known(atoms);
            }
        }
    }

    /// `T1 (cm)`: a length is of a trial and no time.
    fn of_trials(&self, words: &mut [Word]) {
        if let [first, second] = words
            && first.text == "T"
            && matches!(second.kind, Kind::Number(_))
            && self.unit.is_some_and(|unit| unit.dimension == Dimension::Length)
        {
            first.kind = Kind::Known(&[Atom::Trial]);
        }
    }

    /// Whether it is of a single word.
    pub(super) fn only(&self) -> bool {
        self.unknown.is_empty() && self.atoms.len() == 1
    }

    /// Whether it may count the samples of a sound: it names them, and no quantity.
    pub(super) fn counts_samples(&self) -> bool {
        let plain = self.unit.is_none_or(|unit| unit.dimension == Dimension::Other);
        self.has(Atom::Sample) && self.unknown.is_empty() && plain
    }

    /// Whether the time of its row is that of a highest point.
    pub(super) fn of_tops(&self) -> bool {
        let time = self.value().is_some_and(|value| value.what == What::Time);
        self.has(Atom::Top) || self.has(Atom::Max) && (self.has(Atom::Height) || !time)
    }

    /// The heading of a column whose cells are written as hundredths.
    pub(super) fn hundredths(self) -> Self {
        Self::parse(&format!("{} (%)", self.text)).called(&self.text)
    }

    fn called(self, text: &str) -> Self {
        Self { text: text.to_owned(), ..self }
    }

    /// Whether the heading says what its column holds, every word of it being understood.
    pub(super) fn understood(&self) -> bool {
        self.unknown.is_empty() && !matches!(self.meaning, Meaning::Empty | Meaning::Aside(_))
    }

    /// The numbers of the column, if it holds any that are understood.
    pub(super) fn value(&self) -> Option<&Value> {
        match &self.meaning {
            Meaning::Value(value) => Some(value),
            _ => None,
        }
    }

    /// What its numbers are if they are times: `hit 1 (frame)` is what `hit 1 (s)` is.
    pub(super) fn of_times(&self) -> Option<Value> {
        let words = split(&self.text).into_iter().filter(|word| !word.is(Atom::Frame)).map(|word| word.text);
        let heading = Self::parse(&format!("{} (s)", words.collect::<Vec<_>>().join(" ")));
        heading.value().filter(|v| matches!(v.what, What::Time | What::Interval) && heading.unknown.is_empty()).cloned()
    }

    /// The words that name a ball or a surface, without what counts them.
    pub(super) fn labels(&self) -> String {
        self.labels.join(" ")
    }

    /// Whether it says of which trial its readings are, or that they are a mean, and nothing else
    /// but their unit.
    pub(super) fn trial_only(&self) -> bool {
        use Atom::{Filler, Mean, Number, Repeat, Trial};
        let key = |atom: &Atom| matches!(atom, Trial | Repeat | Number | Mean | Filler);
        self.unknown.is_empty() && !self.atoms.is_empty() && self.atoms.iter().all(key)
    }

    /// The trial that its words name.
    pub(super) fn trial(&self) -> String {
        numbers(&split(&self.text)).trial
    }

    pub(super) fn has(&self, atom: Atom) -> bool {
        self.atoms.contains(&atom)
    }

    /// A word that says that a COR is not that of the readings beside it.
    fn turned(&self) -> bool {
        [Atom::Predicted, Atom::Goal, Atom::Lost, Atom::Error].iter().any(|atom| self.has(*atom))
    }

    /// Whether it speaks of what was predicted, or is a goal, and of nothing that is not
    /// understood.
    pub(super) fn is_predicted(&self) -> bool {
        self.unknown.is_empty() && (self.has(Atom::Predicted) || self.has(Atom::Goal))
    }

    /// What says that numbers are no readings.
    pub(super) fn turned_by(&self) -> Vec<Atom> {
        let turned = [Atom::Predicted, Atom::Goal, Atom::Lost, Atom::Derived];
        turned.into_iter().filter(|atom| self.has(*atom)).collect()
    }

    /// A word that says that numbers are no readings.
    pub(super) fn turns(&self) -> bool {
        !self.turned_by().is_empty()
    }

    /// Whether it says that what stands below it was not read; the COR is what all is measured for.
    pub(super) fn turns_readings(&self) -> bool {
        self.turns() && !(self.has(Atom::Cor) && self.turned_by().iter().all(|atom| *atom == Atom::Derived))
    }

    /// Whether the text names a statistic of the rows around it: `Mean`, `Std dev`, `COR`.
    pub(super) fn sums_up(&self) -> bool {
        use Atom::{Derived, Error, Goal, Lost, Max, Mean, Median, Min, Predicted, Total};
        [Mean, Median, Error, Max, Min, Total, Derived, Predicted, Goal, Lost].iter().any(|atom| self.has(*atom))
    }

    /// Takes an error at the end out, `height (cm) ± 0.5`.
    fn take_spread(&mut self, text: &str) -> String {
        let Some((name, error)) = text.rsplit_once('±').filter(|(name, _)| !name.trim_end().ends_with(['(', '[']))
        else {
            return text.to_owned();
        };
        let error = error.trim();
        // `mean ± SD of 5 (cm)`: what each cell holds, and no number.
        let of_cells = |w: &Word| w.is(Atom::Error) || w.is(Atom::Filler) || matches!(w.kind, Kind::Number(_));
        let (said, unit) = error.split_at(error.find(['(', '[']).unwrap_or(error.len()));
        let words = split(said.trim_end_matches([')', ']']));
        if words.first().is_some_and(|w| w.is(Atom::Error)) && words.iter().all(of_cells) {
            return format!("{} {unit}", name.trim_end()).trim_end().to_owned();
        }
        let digits = error.find(|c: char| !(c.is_ascii_digit() || matches!(c, '.' | ','))).unwrap_or(error.len());
        let spread: Option<f64> = error[..digits].replace(',', ".").parse().ok();
        let closes = error[digits..].ends_with([')', ']']);
        let unit = error[digits..].trim_end_matches([')', ']']).trim_start_matches([' ', '/', ',']).trim();
        let Some(spread) = spread.filter(|spread| *spread > 0.0 && (unit.is_empty() || Unit::parse(unit).is_some()))
        else {
            return text.to_owned();
        };
        self.spread = Some(spread);
        self.unit = Unit::parse(unit);
        // `height (cm ± 0.5)`.
        format!("{}{}", name.trim_end(), if closes { ")" } else { "" })
    }

    /// Takes the text in brackets out: a unit, an error, or words like any others.
    fn take_brackets(&mut self, text: &str) -> String {
        let (mut rest, mut left) = (text, String::new());
        while let Some(open) = rest.find(['(', '[']) {
            let Some(close) = rest[open..].find([')', ']']) else { break };
            left.push_str(&rest[..open]);
            left.push(' ');
            let inside = rest[open + 1..open + close].trim();
            // `h(n)`, `y(t)`: of what it is a function, and no unit.
            let argument =
                matches!(inside, "n" | "i" | "k" | "t" | "x") && rest[..open].ends_with(char::is_alphanumeric);
            rest = &rest[open + close + 1..];
            let error = inside.strip_prefix('±');
            let timed = || split(&left).iter().any(|w| w.is(Atom::Time) || w.is(Atom::Interval));
            // A letter behind a condition is its unit, and names no ball: `Temp (C)`.
            let of_condition = || {
                let words = split(&left);
                words.iter().any(|w| w.is(Atom::Group)) && !words.iter().any(|w| w.is(Atom::Label) || w.is(Atom::Trial))
            };
            // The end of the ball that its height is read at: `drop height (top)`.
            let of_height = || {
                let words = split(&left);
                let placed = |w: &Word| w.is(Atom::Release) || w.is(Atom::Rebound);
                words.iter().any(|w| w.is(Atom::Height)) && words.iter().any(placed)
            };
            if names_end(inside) && of_height() {
                continue;
            }
            let letter = inside.chars().count() == 1 && inside.chars().all(char::is_alphabetic);
            if letter && Unit::parse(inside).is_none() && of_condition() {
                self.unit = self.unit.or(Some(Unit::OTHER));
            } else if inside == "h" && timed() {
                self.unit = self.unit.or(Some(Unit::HOUR));
            } else if inside::of_a_clock(inside) {
                left.push_str("time ");
            } else if let Some(error) = error.map(str::trim) {
                let digits = error.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == ',')).unwrap_or(error.len());
                self.spread = error[..digits].replace(',', ".").parse().ok().filter(|e: &f64| *e > 0.0);
                self.unit = self.unit.or(Unit::parse(&error[digits..]));
            } else if let Some(unit) = Unit::parse(inside.strip_prefix("in ").unwrap_or(inside)).filter(|_| !argument) {
                self.unit = self.unit.or(Some(unit));
            } else if !(argument && matches!(inside, "t" | "x")
                || inside::of_units(inside)
                || inside::asks_for_unit(inside))
            {
                if inside::of_two_parts(inside) {
                    left.push_str(&inside.replace('.', ""));
                    continue;
                }
                // A symbol behind a name is what the name is, and names nothing itself: `drop [H]`.
                match inside {
                    "h" | "H" if !left.trim().is_empty() => left.push_str("height"),
                    "v" | "V" if !left.trim().is_empty() => left.push_str("speed"),
                    inside => left.push_str(&repeats::without(inside)),
                }
                left.push(' ');
            }
        }
        left + rest
    }

    /// A unit at the end, behind a slash or a comma, or one that a blank does not part: `height /
    /// cm`, `v, m/s`.
    fn take_unit(&mut self, text: &str) -> String {
        // What stands last by itself comes first: `v in m/s` is not in seconds.
        for mark in [" ", " / ", "/", ", "] {
            if let Some((name, unit)) = text.trim().rsplit_once(mark)
                && !name.trim().is_empty()
                && (mark != " " || unit.contains(['/', '%']) && !unit.starts_with('/'))
                && let Some(unit) = Unit::parse(unit)
                && self.unit.is_none_or(|known| known == unit)
            {
                self.unit = Some(unit);
                return name.trim_end().strip_suffix(" in").unwrap_or(name).to_owned();
            }
        }
        text.to_owned()
    }
}

#[cfg(test)]
mod tests;
