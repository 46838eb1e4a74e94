//! Words of cells and lines that are no parts of headings: `phrases.tsv`, one a line.

use std::sync::OnceLock;

/// A kind, a tab, a phrase.
const PHRASES: &str = include_str!("phrases.tsv");

/// What a phrase is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Phrase {
    /// Of a cell of which nothing was read.
    Missing,
    /// Beside a number that is not exact.
    About,
    /// A half of the day.
    Half,
    /// Turns what follows.
    Not,
    /// What lies between bounces lies between two.
    Two,
    /// The highest one is the top of a flight.
    Point,
    /// Its peak is a contact.
    Sound,
    /// Of a number that puts something in a place of an order.
    Ending,
    /// A rate of frames or samples that is a bare number.
    Rate,
    /// Joins readings, or units.
    And,
    /// Before a height of release.
    From,
    /// Before a unit.
    In,
    /// What a record calls its own numbers.
    Value,
    /// How many readings a mean is of, from two on.
    Count,
    /// The same in other languages, in any order.
    Several,
    /// Between a height and the next.
    Versus,
    /// The ball is let go.
    LetGo,
    /// It touches the floor.
    Contact,
    /// It is at the top of a flight.
    Apex,
    /// Counts the readings that a mean is of.
    Readings,
    /// When a clock began.
    Since,
    /// Where something is under an instrument.
    Below,
    /// A place on a scale follows.
    At,
    /// The size of a ball, across,
    Diameter,
    /// or half across.
    Radius,
    /// What a ball is called at the end of its name.
    Ball,
    /// The upper end of a ball.
    Top,
    /// The point between its ends.
    Middle,
    /// A ball came up again.
    Rose,
    /// Something runs into what follows,
    Against,
    /// and comes back from it.
    Wall,
    /// What follows is a rule that was kept.
    According,
    /// A sheet holds what is drawn from others.
    Chart,
    /// On the way to the floor, beside what is on the way up.
    Down,
    /// A contact begins,
    Begins,
    /// and ends.
    Ends,
    /// What a ball runs through and blocks.
    Gate,
    /// Before the height that a ball came up to.
    UpTo,
    /// Before what is let loose: the verb parts in two.
    Lets,
    /// How warm something is.
    Temperature,
    /// On the way to what a ball bounces from,
    Inwards,
    /// and back from it.
    Outwards,
    /// The contact that a flight ends at.
    Next,
    /// What a ball is called in a word by itself.
    Called,
    /// A cell repeats the one above it.
    Ditto,
    /// What was measured keeps a rule.
    Passed,
    /// What a sensor measures along its beam.
    Ranging,
    /// How much a sensor shows; with a unit of length, how high a ball is.
    Shown,
    /// What a sensor shows that does not feel the floor.
    Unfelt,
    /// Before what something is higher than.
    Above,
    /// What a unit of all lengths is stated of.
    Lengths,
    /// Which way something flies.
    Angle,
    /// There is none of what follows.
    Nothing,
    /// Before what is not one kind, but several.
    Differing,
    /// Begins what describes the word before it.
    Whose,
    /// A number is to be taken off readings.
    Subtract,
    /// What a scale shows follows.
    Reads,
    /// What an instrument was set to.
    Tuned,
    /// A heading that it ends, or begins before a height, is of where a ball was dropped from,
    Whence,
    /// and of where it came up to.
    Whither,
    /// Behind a number, how often something was done.
    Times,
    /// A sign of a rate of frames or samples, behind its number,
    Rated,
    /// what such a rate counts, in a form that is no heading,
    Frames,
    /// what stands before the second that it is of,
    Per,
    /// and that second.
    Second,
    /// What a list of what was used, where or by whom, is called.
    Used,
    /// Behind a Korean word, what it does in a sentence.
    Particle,
    /// A program that keeps what is typed.
    Program,
    /// What a floor is called at the end of its name.
    Flooring,
    /// Numbers were taken from one unit to another.
    Converted,
}

impl Phrase {
    const ALL: [(&'static str, Self); 70] = [
        ("missing", Self::Missing),
        ("about", Self::About),
        ("half", Self::Half),
        ("not", Self::Not),
        ("two", Self::Two),
        ("point", Self::Point),
        ("sound", Self::Sound),
        ("ending", Self::Ending),
        ("rate", Self::Rate),
        ("and", Self::And),
        ("from", Self::From),
        ("in", Self::In),
        ("value", Self::Value),
        ("count", Self::Count),
        ("several", Self::Several),
        ("versus", Self::Versus),
        ("let go", Self::LetGo),
        ("contact", Self::Contact),
        ("apex", Self::Apex),
        ("readings", Self::Readings),
        ("since", Self::Since),
        ("below", Self::Below),
        ("at", Self::At),
        ("diameter", Self::Diameter),
        ("radius", Self::Radius),
        ("ball", Self::Ball),
        ("top", Self::Top),
        ("middle", Self::Middle),
        ("rose", Self::Rose),
        ("against", Self::Against),
        ("wall", Self::Wall),
        ("according", Self::According),
        ("chart", Self::Chart),
        ("down", Self::Down),
        ("begins", Self::Begins),
        ("ends", Self::Ends),
        ("gate", Self::Gate),
        ("up to", Self::UpTo),
        ("lets", Self::Lets),
        ("temperature", Self::Temperature),
        ("inwards", Self::Inwards),
        ("outwards", Self::Outwards),
        ("next", Self::Next),
        ("called", Self::Called),
        ("ditto", Self::Ditto),
        ("passed", Self::Passed),
        ("ranging", Self::Ranging),
        ("shown", Self::Shown),
        ("unfelt", Self::Unfelt),
        ("above", Self::Above),
        ("lengths", Self::Lengths),
        ("angle", Self::Angle),
        ("nothing", Self::Nothing),
        ("differing", Self::Differing),
        ("whose", Self::Whose),
        ("subtract", Self::Subtract),
        ("reads", Self::Reads),
        ("tuned", Self::Tuned),
        ("whence", Self::Whence),
        ("whither", Self::Whither),
        ("times", Self::Times),
        ("rated", Self::Rated),
        ("frames", Self::Frames),
        ("per", Self::Per),
        ("second", Self::Second),
        ("used", Self::Used),
        ("particle", Self::Particle),
        ("program", Self::Program),
        ("flooring", Self::Flooring),
        ("converted", Self::Converted),
    ];

    /// The phrases of this kind, in the order of the file.
    pub(super) fn all(self) -> &'static [&'static str] {
        static ALL: OnceLock<Vec<Vec<&'static str>>> = OnceLock::new();
        let all = ALL.get_or_init(|| {
            let mut all = vec![Vec::new(); Self::ALL.len()];
            for (name, phrase) in entries() {
                let kinds = all.iter_mut().zip(Self::ALL);
                kinds.filter(|(_, (kind, _))| *kind == name).for_each(|(phrases, _)| phrases.push(phrase));
            }
            all
        });
        &all[self as usize]
    }

    /// Whether a text is one of this kind.
    pub(super) fn is(self, text: &str) -> bool {
        self.all().contains(&text)
    }
}

/// A word that denies is among so many before what it denies: `was not simply thrown`.
pub(super) const DENIED: usize = 3;

/// Whether a word denies what stands behind it.
pub(super) fn denies(word: &str) -> bool {
    Phrase::Not.is(word) || Phrase::Nothing.is(word)
}

fn entries() -> impl Iterator<Item = (&'static str, &'static str)> {
    PHRASES.lines().filter(|line| !line.starts_with('#')).filter_map(|line| line.split_once('\t'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_phrase_has_a_kind_and_none_hides_a_longer_one() {
        for (n, (name, kind)) in Phrase::ALL.iter().enumerate() {
            let phrases = kind.all();
            assert!(*kind as usize == n && !phrases.is_empty(), "{name}");
            for (at, phrase) in phrases.iter().enumerate() {
                assert!(!phrases[..at].contains(phrase) && phrase.to_lowercase() == **phrase, "{phrase}");
                assert!(
                    *kind != Phrase::About || !phrases[..at].iter().any(|before| phrase.starts_with(before)),
                    "{phrase}"
                );
            }
        }
        assert!(entries().all(|(name, _)| Phrase::ALL.iter().any(|(known, _)| *known == name)));
    }
}
