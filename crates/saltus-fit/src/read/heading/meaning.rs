//! What the words of a heading say together: a quantity, what it tells apart, or why its numbers
//! are no readings.

use super::super::aside::Why;
use super::super::phrases::Phrase;
use super::super::units::{Dimension, Scale, Unit};
use super::super::vocabulary::{Atom, folded};
use super::super::words::{Kind, Numbers, Word, numbers, split};
use super::{At, Heading, Meaning, Role, Value, What};

impl Heading {
    /// Whether any word of it is of a quantity, an event or a trial, or counts.
    pub(in crate::read) fn names_anything(&self) -> bool {
        self.unit.is_some() || self.atoms.iter().any(|atom| atom.measures() || *atom == Atom::Number)
    }

    /// What the words say together.
    pub(super) fn interpret(&self, words: &[Word], run: &str) -> Meaning {
        use Atom::{
            Air, Between, Derived, Distance, Goal, Group, Height, Label, Note, Other, Position, Predicted, Total,
        };
        let has = |atom| self.has(atom);
        let numbers = numbers(words);
        let named = !numbers.trial.is_empty() || !numbers.group.is_empty() || !numbers.bounce.is_empty();
        let judges = |w: &Word| w.is(Atom::Counts) && !w.is(Label);
        // The time of day of an impact is its time.
        let remark = has(Note) && !(has(Atom::Time) && has(Atom::Impact));
        if (remark || has(Atom::Measure) || !words.is_empty() && words.iter().all(judges)) && self.unit.is_none() {
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
        // What is lost adds up: `cumulative loss`.
        let summed = has(Atom::Lost) && words.iter().all(|w| !w.is(Derived) || folded(&w.text).starts_with("cumul"));
        if has(Derived) && !intervals && !relative && !summed {
            return Meaning::Aside(Why::Derived);
        }
        // What is measured in degrees, or as a pressure, is a condition, whatever it is called.
        let state = self.unit.is_some_and(|unit| unit.scale == Scale::State) && numbers.bounce.is_empty();
        let state = state && numbers.trial.is_empty() && !has(Atom::Error) && !has(Goal);
        if state {
            return Meaning::Setting;
        }
        let placed = has(Atom::Release) && placed(words);
        let setting = has(Group)
            && !named
            && !placed
            && !has(Atom::Error)
            && !has(Height)
            && !has(Position)
            && !((has(Atom::Frame) || has(Atom::Time)) && has(Atom::Impact))
            && !self.counts_hits()
            && self.unit.is_none_or(|u| u.dimension == Dimension::Other);
        if setting && !has(Label) {
            return Meaning::Setting;
        }
        let flown = has(Distance) && has(Between) || has(Height) && has(Total) && !has(Atom::Lost);
        if has(Other) || has(Atom::Motion) || flown || self.unit.is_some_and(|u| u.dimension == Dimension::Other) {
            return Meaning::Aside(Why::Other);
        }
        // A time that names a bounce and the one after it lies between them, whatever stands there.
        let next = matches!(numbers.bounce.as_slice(), [one, other] if *one > 0 && *other == one + 1);
        let what = match self.what(placed) {
            What::Time if next => What::Interval,
            _ if intervals => What::Interval,
            what => what,
        };
        let what = if what == What::Unsaid && self.drop.is_some() { What::Height } else { what };
        if what == What::Unsaid
            && self.unit.is_none()
            && let Some(key) = self.key(&numbers)
        {
            return key;
        }
        // Until the second contact, or a later one, lies a rebound.
        let until = has(Atom::Impact) && numbers.bounce.first().is_some_and(|&contact| contact > 1);
        // A contact that starts releases nothing.
        let starts = |w: &Word| w.is(Atom::Release) && Phrase::Begins.is(&folded(&w.text));
        let released = has(Atom::Release) && !(has(Atom::Impact) && words.iter().any(starts));
        if what == What::Time && released && !has(Atom::After) && !has(Air) && !until {
            return Meaning::Aside(Why::Other);
        }
        self.reading(what, numbers, run)
    }

    /// Whether it counts the times that a ball hits the floor, `hit on the floor no.`, and tells no
    /// floors apart.
    fn counts_hits(&self) -> bool {
        [Atom::Number, Atom::Impact, Atom::Floor].iter().all(|atom| self.has(*atom)) && !self.has(Atom::Label)
    }

    /// The quantity that words and unit name; `placed` if they say where a release is.
    fn what(&self, placed: bool) -> What {
        use Atom::{
            Air, Between, Distance, Height, Impact, Interval, Number, Percent, Position, Rebound, Release, Rest, Speed,
            Time, Total,
        };
        let has = |atom| self.has(atom);
        let of = |dimension| self.unit.is_some_and(|unit: Unit| unit.dimension == dimension);
        let timed = has(Time) || of(Dimension::Time);
        // How long all lasted, or until the ball was at rest: `durée jusqu'à l'arrêt`.
        let rests = self.atoms.iter().filter(|atom| **atom == Rest).count() > 1;
        // The top after an impact is that of a flight.
        let tops = has(Atom::Top) && has(Atom::After);
        let whole = has(Interval) && (has(Total) && !has(Air) || rests && !has(Impact)) && !has(Between);
        if has(Speed) || of(Dimension::Speed) {
            What::Speed
        } else if (has(Interval) || timed && (has(Between) || has(Air))) && !whole {
            What::Interval
        } else if whole || timed && has(Rest) || has(Total) && !has(Height) && !of(Dimension::Length) {
            What::Total
        } else if timed && (!has(Height) || has(Time) && of(Dimension::Time)) {
            What::Time
        } else if has(Height)
            || has(Position)
            || has(Distance)
            || of(Dimension::Length)
            || has(Percent)
            || has(Rebound) && (!has(Impact) || tops) && !(has(Number) && self.unit.is_none())
            || has(Release) && (placed || !has(Atom::Trial))
        {
            What::Height
        } else {
            What::Unsaid
        }
    }

    /// What a heading without a quantity tells apart.
    fn key(&self, numbers: &Numbers) -> Option<Meaning> {
        use Atom::{Error, Event, Frame, Group, Impact, Mean, Number, Rebound, Release, Repeat, Trial};
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
        if has(Group) && !self.counts_hits() {
            return Some(Meaning::Setting);
        }
        if has(Number) || has(Impact) {
            return Some(Meaning::Number { sure: has(Impact) || has(Rebound) });
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
            // The time of the greatest height.
            () if has(Max) && (has(Height) && (what == What::Time || has(Atom::Energy)) || has(Atom::Top)) => {
                Role::Reading
            }
            () if has(Max) => Role::Max,
            () if has(Min) => Role::Min,
            () => Role::Reading,
        };
        let from = self.drop.as_ref();
        let released = has(Release) && !has(Rebound) && !has(After) && numbers.trial.is_empty() && from.is_none();
        // `ordinate y1`: the sign of the place of the first point, and of no bounce.
        let signed = self.atoms.iter().filter(|atom| **atom == Position).count() > 1;
        let at = match (numbers.bounce.first(), what) {
            (Some(_), What::Height) if signed => At::Row,
            (Some(0), What::Height) => At::Release,
            (Some(&n), _) => At::Nth(n),
            (None, What::Height | What::Unsaid)
                if released || has(Before) && !has(After) && (!has(Rebound) || ahead(&split(&self.text))) =>
            {
                At::Release
            }
            (None, What::Speed) if has(After) || has(Rebound) && !has(Before) => At::After,
            (None, What::Speed) if has(Before) || has(Impact) => At::Before,
            _ => At::Row,
        };
        // A body that was followed is of a kind of its own: `mass A: y`.
        let body = split(run).iter().any(|w| w.is(Atom::Label) || folded(&w.text).starts_with("mass"));
        let (mut label, group) = match run {
            "" => (numbers.trial, numbers.group),
            run if body => (String::new(), run.to_owned()),
            run => (run.to_owned(), numbers.group),
        };
        if let Some(drop) = from {
            let apart = if label.is_empty() { "" } else { ", " };
            label = format!("{label}{apart}from {}", drop.text);
        }
        Meaning::Value(Value {
            what,
            at,
            role,
            trial: label,
            group,
            position: (has(Position) || has(Distance)) && !has(Height) && !has(Rebound) && !has(Release),
            or_trial: has(Release) && has(Trial) && !has(Height) && at == At::Release,
            drop: self.drop.clone(),
        })
    }

    /// What its numbers are as heights, if every word is of an energy: m g h of a height, and of a
    /// speed what it was, or will be, at the top.
    pub(super) fn of_energy(&self, words: &[Word], run: &str) -> Option<Value> {
        let joules = self.unit.is_some_and(|unit| unit.of_height().is_some());
        let lost = self.has(Atom::Lost) && self.unit.is_none_or(|unit| unit.scale == Scale::Percent);
        let named = words.iter().any(|w| w.is(Atom::Energy));
        let other = |w: &Word| {
            let letter = joules && folded(&w.text) == "e";
            w.is(Atom::Derived) && !w.is(Atom::Energy) && !letter || w.is(Atom::Other)
        };
        let turned = [Atom::Predicted, Atom::Goal].iter().any(|atom| self.has(*atom)) || words.iter().any(other);
        let fits = joules || named && (self.unit.is_none() || lost);
        if !fits || turned || !self.unknown.is_empty() {
            return None;
        }
        let Meaning::Value(value) = self.reading(What::Height, numbers(words), run) else { return None };
        let has = |atom| self.has(atom);
        let at = match value.at {
            At::Nth(_) => value.at,
            // What is lost at an impact, or in a bounce.
            _ if value.role == Role::Lost => At::Row,
            _ if !ahead(words) && (has(Atom::After) || has(Atom::Rebound)) => At::Row,
            _ if has(Atom::Before) || has(Atom::Release) || has(Atom::Impact) => At::Release,
            at => at,
        };
        Some(Value { at, position: false, or_trial: false, ..value })
    }

    /// A unit among the words, but not as the first: `height_cm`, `height in cm`, where the inch is
    /// a preposition.
    pub(super) fn take_unit_word(&mut self, words: &mut Vec<Word>) {
        // `temp_C`, `air_temperature_c`: a letter behind a temperature is its unit.
        let snake = self.text.contains('_');
        if let [.., of, last] = words.as_slice()
            && (matches!(last.text.as_str(), "C" | "F" | "K") || snake && matches!(last.text.as_str(), "c" | "f" | "k"))
            && Phrase::Temperature.is(&folded(&of.text))
        {
            self.unit = Unit::parse("°C");
            words.pop();
            return;
        }
        // Before a word that is known the inch is a preposition: `height in cm`, `time in air`.
        let named = |n: usize| matches!(words.get(n), Some(Word { kind: Kind::Known(_), .. }));
        let is_unit = |n: usize| match words[n].kind {
            Kind::Known([Atom::Unit(_)]) => true,
            // `t_us`: behind a time no pronoun.
            Kind::Known(_) if words[n].text == "us" => n + 1 == words.len() && words[n - 1].is(Atom::Time),
            // `v_in` beside `v_out`.
            Kind::Known(_) => words[n].text == "in" && !named(n + 1) && !words[n - 1].is(Atom::Speed),
            _ => Unit::parse(&words[n].text).is_some(),
        };
        // A letter behind what counts is short for what is counted: `č. m.`.
        let counted = |n: usize| words[n].text.chars().count() == 1 && words[..n].iter().all(|w| w.is(Atom::Number));
        let mut found: Vec<usize> = (1..words.len()).filter(|&n| is_unit(n) && !counted(n)).collect();
        if found.len() > 1 && Phrase::In.is(&words[found[0]].text) {
            found.remove(0);
        }
        // The same unit may stand behind an error as well: `height / m ± 0.01 m`.
        let stated = |n: &&usize| self.unit.is_none() || self.unit == Unit::parse(&words[**n].text);
        if let Some(&n) = found.first().filter(stated) {
            self.unit = Unit::parse(&words[n].text);
            words.remove(n);
            // `výška v cm`, `wysokość w cm`: what stands before the unit leads to it.
            if n > 1 && words[n - 1].text.chars().count() == 1 && Phrase::In.is(&words[n - 1].text) {
                words.remove(n - 1);
            }
        } else if let [word] = words.as_slice()
            && (matches!(word.kind, Kind::Known([Atom::Unit(_)]))
                || matches!(word.kind, Kind::Unknown) && Unit::parse(&word.text).is_some())
        {
            self.unit = self.unit.or(Unit::parse(&words[0].text));
            words.clear();
        }
    }
}

/// Whether words say where a height is measured: at an end of the ball, or above what floor.
fn placed(words: &[Word]) -> bool {
    let spoken = || words.iter().filter(|w| !w.is(Atom::Filler) || leads(w));
    let leads_to = |(lead, floor): (&Word, &Word)| leads(lead) && floor.is(Atom::Floor);
    words.iter().any(|w| w.is(Atom::Bottom)) || spoken().zip(spoken().skip(1)).any(leads_to)
}

/// Whether a word leads to what something is above: `from`, `over`.
fn leads(word: &Word) -> bool {
    let word = folded(&word.text);
    Phrase::From.is(&word) || Phrase::Above.is(&word)
}

/// Whether what words speak of was ahead of a rebound: `before the rebound`.
fn ahead(words: &[Word]) -> bool {
    let mut told = words.iter().filter(|w| !matches!(w.kind, Kind::Known([Atom::Filler])));
    let before = |w: &Word| w.is(Atom::Before) && !w.is(Atom::Impact);
    let after = words.iter().any(|w| w.is(Atom::After));
    !after && told.any(before) && told.next().is_some_and(|w| w.is(Atom::Rebound))
}
