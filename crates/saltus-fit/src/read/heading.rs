//! What a heading means: a quantity, its unit, a statistic, the number of a bounce, a trial, a
//! ball, and the words that are not understood.

mod inside;

use super::aside::Why;
use super::units::{Dimension, Unit};
use super::vocabulary::{Atom, folded, narrow};
use super::words::{Kind, Numbers, Word, numbers, split};
pub(super) use inside::{DropHeight, Of, release, released};

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

/// What a heading says of its column.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Meaning {
    /// Nothing stands there.
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
#[derive(Clone, Debug)]
pub(super) struct Heading {
    pub(super) text: String,
    pub(super) unit: Option<Unit>,
    /// The error of every reading below it, in its unit: `height (± 0.5 cm)`.
    pub(super) spread: Option<f64>,
    /// What it means as far as it is understood.
    pub(super) meaning: Meaning,
    /// The words that are not understood; with any, the column is not used unless it is asked for.
    pub(super) unknown: Vec<String>,
    /// The place of its readings beside the bounce of their row: `h_n` is 0, `h_n+1` is 1.
    pub(super) place: Option<i8>,
    /// It names the COR, worked out from other columns.
    pub(super) cor: bool,
    /// What its numbers are parts of, if it names a ratio of heights and nothing else.
    pub(super) share: Option<Of>,
    /// A height of release that it states.
    drop: Option<DropHeight>,
    /// The meanings of its words.
    atoms: Vec<Atom>,
    /// Those that name a ball or a surface.
    labels: Vec<String>,
}

impl Heading {
    /// Takes a heading apart.
    pub(super) fn parse(text: &str) -> Self {
        let (name, plain) = (text.trim(), narrow(text));
        let text = plain.trim();
        let mut heading = Self {
            text: name.to_owned(),
            unit: None,
            spread: None,
            meaning: Meaning::Empty,
            unknown: Vec::new(),
            place: None,
            cor: false,
            share: None,
            drop: None,
            atoms: Vec::new(),
            labels: Vec::new(),
        };
        // The format of a clock, such as `mm:ss.ms`.
        if text.contains(':') && text.chars().all(|c| "hmsHMS:.,".contains(c)) {
            return Self::parse("time (s)").called(text);
        }
        // Programs put the run before the name: 'Latest: Time (s)'.
        let (run, name) = match text.split_once(':') {
            Some((run, name)) if !name.trim().is_empty() => (run.trim(), name),
            _ => ("", text),
        };
        let (drop, name) = release(name).map_or((None, name.to_owned()), |(drop, rest)| (Some(drop), rest));
        heading.drop = drop;
        let bare = heading.take_brackets(&name);
        let bare = heading.take_unit(&bare);
        let (place, bare) = inside::place(&bare);
        heading.place = place;
        let mut words = split(&bare);
        let before = inside::hundredths(&mut words);
        if before.is_some() {
            heading.unit = Unit::parse("%");
        }
        heading.take_unit_word(&mut words);
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
        heading.share = inside::share(&bare, &words, before).filter(|_| heading.unknown.is_empty());
        heading.cor = inside::is_cor(&words) && !heading.turned();
        // `v_in` beside `v_out`.
        if heading.has(Atom::Speed) && words.last().is_some_and(|w| w.text == "in") {
            heading.atoms.push(Atom::Before);
        }
        let placed = matches!(words.as_slice(), [Word { kind: Kind::Ordinal(_), .. }]);
        if !heading.atoms.is_empty() || heading.unit.is_some() || placed {
            heading.meaning = heading.interpret(&words, run);
        }
        heading
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

    /// The words that name a ball or a surface, without what counts them.
    pub(super) fn labels(&self) -> String {
        self.labels.join(" ")
    }

    pub(super) fn has(&self, atom: Atom) -> bool {
        self.atoms.contains(&atom)
    }

    /// A word that says that a COR is not that of the readings beside it.
    fn turned(&self) -> bool {
        [Atom::Predicted, Atom::Goal, Atom::Lost, Atom::Error].iter().any(|atom| self.has(*atom))
    }

    /// A word that says that numbers are no readings.
    pub(super) fn turns(&self) -> bool {
        [Atom::Predicted, Atom::Goal, Atom::Lost, Atom::Derived].iter().any(|atom| self.has(*atom))
    }

    /// Whether the text names a statistic of the rows around it: `Mean`, `Std dev`, `COR`.
    pub(super) fn sums_up(&self) -> bool {
        use Atom::{Derived, Error, Goal, Lost, Max, Mean, Median, Min, Predicted, Total};
        [Mean, Median, Error, Max, Min, Total, Derived, Predicted, Goal, Lost].iter().any(|atom| self.has(*atom))
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
            let error = inside.strip_prefix('±').or(inside.strip_prefix("+/-")).or(inside.strip_prefix("+-"));
            if let Some(error) = error.map(str::trim) {
                let digits = error.find(|c: char| !(c.is_ascii_digit() || c == '.' || c == ',')).unwrap_or(error.len());
                self.spread = error[..digits].replace(',', ".").parse().ok().filter(|e: &f64| *e > 0.0);
                self.unit = self.unit.or(Unit::parse(&error[digits..]));
            } else if let Some(unit) = Unit::parse(inside.strip_prefix("in ").unwrap_or(inside)).filter(|_| !argument) {
                self.unit = self.unit.or(Some(unit));
            } else if !(argument && matches!(inside, "t" | "x")) {
                // A symbol behind a name is what the name is, and names nothing itself: `drop [H]`.
                left.push_str(match inside {
                    "h" | "H" if !left.trim().is_empty() => "height",
                    "v" | "V" if !left.trim().is_empty() => "speed",
                    inside => inside,
                });
                left.push(' ');
            }
        }
        left + rest
    }

    /// A unit at the end, behind a slash or a comma, or one that a blank does not part: `height /
    /// cm`, `v, m/s`.
    fn take_unit(&mut self, text: &str) -> String {
        if self.unit.is_some() {
            return text.to_owned();
        }
        for mark in [" / ", "/", ", ", " "] {
            if let Some((name, unit)) = text.trim().rsplit_once(mark)
                && !name.trim().is_empty()
                && (mark != " " || unit.contains(['/', '%']))
                && let Some(unit) = Unit::parse(unit)
            {
                self.unit = Some(unit);
                return name.to_owned();
            }
        }
        text.to_owned()
    }

    /// A unit among the words, but not as the first: `height_cm`, `height in cm`, where the inch is
    /// a preposition.
    fn take_unit_word(&mut self, words: &mut Vec<Word>) {
        let is_unit = |w: &Word| match w.kind {
            Kind::Known([Atom::Unit(_)]) => true,
            Kind::Known(_) => w.text == "in",
            _ => Unit::parse(&w.text).is_some(),
        };
        let mut found: Vec<usize> = (1..words.len()).filter(|&n| is_unit(&words[n])).collect();
        if found.len() > 1 && words[found[0]].text == "in" {
            found.remove(0);
        }
        if let Some(&n) = found.first().filter(|_| self.unit.is_none()) {
            self.unit = Unit::parse(&words[n].text);
            words.remove(n);
        } else if words.len() == 1 && matches!(words[0].kind, Kind::Known([Atom::Unit(_)])) {
            self.unit = self.unit.or(Unit::parse(&words[0].text));
            words.clear();
        }
    }

    /// What the words say together.
    fn interpret(&self, words: &[Word], run: &str) -> Meaning {
        use Atom::{
            Air, Between, Derived, Distance, Goal, Group, Height, Label, Note, Other, Position, Predicted, Total,
        };
        let has = |atom| self.has(atom);
        let numbers = numbers(words);
        let named = !numbers.trial.is_empty() || !numbers.group.is_empty() || !numbers.bounce.is_empty();
        if has(Note) && self.unit.is_none() {
            return Meaning::Aside(Why::Note);
        }
        if has(Predicted) {
            return Meaning::Aside(Why::Predicted);
        }
        if has(Goal) {
            return Meaning::Aside(Why::Goal);
        }
        let intervals = has(Derived) && words.iter().any(|w| w.text == "delta") && has(Atom::Time);
        // Of two bodies that meet: the speed of one as the other sees it, and no ratio.
        let met = (has(Atom::Before) || has(Atom::After)) && has(Atom::Speed);
        let relative = met && words.iter().all(|w| !w.is(Derived) || folded(&w.text).starts_with("relativ"));
        if has(Derived) && !intervals && !relative {
            return Meaning::Aside(Why::Derived);
        }
        let setting = has(Group)
            && !named
            && !has(Height)
            && !has(Position)
            && self.unit.is_none_or(|u| u.dimension == Dimension::Other);
        if setting && !has(Label) {
            return Meaning::Setting;
        }
        let flown = has(Distance) && has(Between) || has(Height) && has(Total);
        if has(Other) || flown || self.unit.is_some_and(|u| u.dimension == Dimension::Other) {
            return Meaning::Aside(Why::Other);
        }
        let what = if intervals { What::Interval } else { self.what() };
        let what = if what == What::Unsaid && self.drop.is_some() { What::Height } else { what };
        if what == What::Unsaid
            && self.unit.is_none()
            && let Some(key) = self.key(&numbers)
        {
            return key;
        }
        if what == What::Time && has(Atom::Release) && !has(Atom::After) && !has(Air) {
            return Meaning::Aside(Why::Other);
        }
        self.reading(what, numbers, run)
    }

    /// The quantity that words and unit name.
    fn what(&self) -> What {
        use Atom::{
            Air, Between, Distance, Height, Impact, Interval, Percent, Position, Rebound, Release, Rest, Speed, Time,
            Total,
        };
        let has = |atom| self.has(atom);
        let of = |dimension| self.unit.is_some_and(|unit: Unit| unit.dimension == dimension);
        let timed = has(Time) || of(Dimension::Time);
        if has(Speed) || of(Dimension::Speed) {
            What::Speed
        } else if has(Interval) || timed && (has(Between) || has(Air)) {
            What::Interval
        } else if timed && has(Rest) || has(Total) && !has(Height) && !of(Dimension::Length) {
            What::Total
        } else if timed && !has(Height) {
            What::Time
        } else if has(Height)
            || has(Position)
            || has(Distance)
            || of(Dimension::Length)
            || has(Percent)
            || has(Rebound) && !has(Impact)
            || has(Release) && !has(Atom::Trial)
        {
            What::Height
        } else {
            What::Unsaid
        }
    }

    /// What a heading without a quantity tells apart.
    fn key(&self, numbers: &Numbers) -> Option<Meaning> {
        use Atom::{Error, Event, Frame, Group, Impact, Mean, Number, Release, Repeat, Trial};
        let has = |atom| self.has(atom);
        let named = !numbers.trial.is_empty() || !numbers.group.is_empty() || !numbers.bounce.is_empty();
        if has(Frame) {
            return Some(Meaning::Frame);
        }
        if named || has(Mean) || has(Error) {
            return None;
        }
        if has(Event) && !has(Repeat) {
            return Some(Meaning::Event);
        }
        if has(Repeat) || has(Trial) && (has(Number) || !has(Release)) {
            return Some(Meaning::Trial);
        }
        if has(Group) {
            return Some(Meaning::Setting);
        }
        if has(Number) || has(Impact) {
            return Some(Meaning::Number { sure: has(Impact) });
        }
        None
    }

    fn reading(&self, what: What, numbers: Numbers, run: &str) -> Meaning {
        use Atom::{
            After, Before, Distance, Error, Height, Impact, Lost, Max, Mean, Median, Min, Percent, Position, Rebound,
            Release, Speed, Trial,
        };
        let has = |atom| self.has(atom);
        if has(Percent) && what != What::Height {
            return Meaning::Aside(Why::Derived);
        }
        // Components of a vector, the rise of something, a change of a change.
        // At an impact it is the vertical one that turns round.
        let at_impact = has(Before) || has(After);
        if has(Speed) && (has(Position) && !at_impact || has(Release))
            || numbers.bounce.len() > 1 && what != What::Interval
        {
            return Meaning::Aside(Why::Other);
        }
        let role = match () {
            () if has(Error) => Role::Error,
            () if has(Lost) => Role::Lost,
            () if has(Mean) || has(Median) => Role::Mean,
            () if has(Max) => Role::Max,
            () if has(Min) => Role::Min,
            () => Role::Reading,
        };
        let from = self.drop.as_ref();
        let released = has(Release) && !has(Rebound) && !has(After) && numbers.trial.is_empty() && from.is_none();
        let at = match (numbers.bounce.first(), what) {
            (Some(0), What::Height) => At::Release,
            (Some(&n), _) => At::Nth(n),
            (None, What::Height | What::Unsaid) if released || has(Before) && !has(After) && !has(Rebound) => {
                At::Release
            }
            (None, What::Speed) if has(After) || has(Rebound) => At::After,
            (None, What::Speed) if has(Before) || has(Impact) => At::Before,
            _ => At::Row,
        };
        let mut label = if run.is_empty() { numbers.trial } else { run.to_owned() };
        if let Some(drop) = from {
            let apart = if label.is_empty() { "" } else { ", " };
            label = format!("{label}{apart}from {}", drop.text);
        }
        Meaning::Value(Value {
            what,
            at,
            role,
            trial: label,
            group: numbers.group,
            position: (has(Position) || has(Distance)) && !has(Height) && !has(Rebound) && !has(Release),
            or_trial: has(Release) && has(Trial) && !has(Height) && at == At::Release,
            drop: self.drop.clone(),
        })
    }
}
#[cfg(test)]
mod tests;
