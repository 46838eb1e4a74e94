//! The words of a heading, its letters and digits apart, and the numbers among them.

mod numbers;
mod pieces;

use super::kept::{Kept, kept};
use super::limits::MANY;
use super::phrases::Phrase;
use super::vocabulary::{Atom, accented, folded, meanings, spelt_out, unparted};
pub(super) use numbers::{Numbers, numbers};
pub(super) use pieces::{has_word, marks, pieces, unaddressed, without_brackets};

/// Words that say nothing and have so many letters name something; shorter ones are articles.
pub(super) const ARTICLE: usize = 4;

/// A word of a heading.
#[derive(Clone)]
pub(super) struct Word {
    /// As it stands.
    pub(super) text: String,
    pub(super) kind: Kind,
}

#[derive(Clone, Copy)]
pub(super) enum Kind {
    Known(&'static [Atom]),
    Number(usize),
    Ordinal(usize),
    Letter,
    Unknown,
}

impl Word {
    pub(super) fn is(&self, atom: Atom) -> bool {
        matches!(self.kind, Kind::Known(atoms) if atoms.contains(&atom))
    }
}

/// The words of a heading, letters and digits apart.
pub(super) fn split(text: &str) -> Vec<Word> {
    static KEPT: Kept<Vec<Word>> = Kept::new(Default::default);
    kept(&KEPT, text, apart)
}

fn apart(text: &str) -> Vec<Word> {
    let mut words: Vec<Word> = Vec::new();
    let pieces = pieces(text);
    let count = pieces.len();
    for (n, piece) in pieces.into_iter().enumerate() {
        let folded = folded(&piece);
        if let Some(last) = words.last_mut()
            && let Some(atoms) = meanings(&format!("{} {folded}", self::folded(&last.text)))
        {
            // Two words that mean something else together: `a doua`, `take off`.
            last.kind = Kind::Known(atoms);
            last.text = format!("{} {piece}", last.text);
            continue;
        }
        let kind = if folded == "dos" && words.last().is_some_and(|w| w.is(Atom::After) || w.text == "de") {
            // Two in Spanish, and not `of the` in Portuguese: `después de dos rebotes`.
            Kind::Unknown
        } else if let Some(atoms) = accented(&piece.to_lowercase()) {
            Kind::Known(atoms)
        } else if folded == "av" && n > 0 && n + 1 < count {
            // Of, in Swedish and in Norwegian; at either end it is short for the average.
            Kind::Known(&[Atom::Filler])
        } else if Phrase::Point.is(&folded) && words.last().is_some_and(|w| w.is(Atom::Max)) {
            // `highest point`.
            Kind::Known(&[Atom::Rebound, Atom::Top])
        } else if let Some(sound) = words.last_mut().filter(|w| {
            meanings(&folded).is_some_and(|a| a.contains(&Atom::Top)) && Phrase::Sound.is(&w.text.to_lowercase())
        }) {
            // A sound peaks when the ball hits the floor.
            sound.kind = Kind::Known(&[Atom::Filler]);
            Kind::Known(&[Atom::Impact])
        } else if Phrase::Since.is(&folded) {
            // Of a clock, when it began; of a height, where: `tiempo desde el inicio`.
            let timed = words.iter().any(|w| w.is(Atom::Time));
            Kind::Known(if timed { &[Atom::After] } else { &[Atom::Filler] })
        } else if piece == "TID" {
            // The number of a track, where `tid` is the time in Swedish.
            Kind::Unknown
        } else if let Some(atoms) = meanings(&folded) {
            Kind::Known(atoms)
        } else if let Some(atoms) = spelt_out(&folded) {
            Kind::Known(atoms)
        } else if let Some(n) = ordinal(&folded) {
            Kind::Ordinal(n)
        } else if Phrase::Two.is(&folded) && words.last().is_some_and(|w| w.is(Atom::Between)) {
            // `between two bounces`.
            continue;
        } else if words.last().is_some_and(counts) && folded.len() > 1 && Phrase::Ending.is(&folded) {
            // `n-th`, `n-ten`: the end of a letter that counts.
            continue;
        } else if let Some(Word { kind: kind @ Kind::Number(_), .. }) = words.last_mut()
            && let Kind::Number(place) = *kind
            && !folded.is_ascii()
            && Phrase::Ending.is(&folded)
        {
            // `1-й`.
            *kind = Kind::Ordinal(place);
            continue;
        } else if let Ok(n) = folded.parse::<usize>() {
            if n <= MANY { Kind::Number(n) } else { Kind::Unknown }
        } else if folded.chars().count() == 1 {
            Kind::Letter
        } else if let Some((letters, digits)) = joined(&folded) {
            let n = digits.parse().ok().filter(|n| *n <= MANY);
            match (meanings(letters), n) {
                (Some(atoms), Some(n)) => {
                    let at = piece.find(|c: char| c.is_ascii_digit()).unwrap_or(piece.len());
                    words.push(Word { text: piece[..at].to_owned(), kind: Kind::Known(atoms) });
                    words.push(Word { text: digits.to_owned(), kind: Kind::Number(n) });
                    continue;
                }
                _ => Kind::Unknown,
            }
        } else if of_a_ball(&folded) {
            Kind::Known(&[Atom::Label])
        } else if of_a_floor(&folded) {
            Kind::Known(&[Atom::Label, Atom::Floor])
        } else if let Some(parts) = symbol(&folded).or_else(|| compound(&folded)) {
            words.extend(parts.map(|(text, atoms)| Word { text: text.to_owned(), kind: Kind::Known(atoms) }));
            continue;
        } else {
            Kind::Unknown
        };
        let text = if matches!(kind, Kind::Known(_)) && folded == "in" { folded } else { piece };
        words.push(Word { text, kind });
    }
    counted_and(&mut words);
    // What a ball is, and no estimate: `la balle est lâchée`.
    for n in 1..words.len() {
        if words[n].text == "est" && Phrase::Called.is(&folded(&words[n - 1].text)) {
            words[n].kind = Kind::Known(&[Atom::Filler]);
        }
    }
    highest(&mut words);
    fallen(&mut words);
    let_loose(&mut words);
    under_a_tool(&mut words);
    lettered(&mut words);
    // A number before a word is its place in an order, if none follows: '1. Rebound'; where words
    // are not parted it stands before what it counts: `2回目`.
    let counter = |w: &Word| (w.is(Atom::Trial) || w.is(Atom::Repeat)) && w.text.contains(unparted);
    for n in 1..words.len() {
        let alone = words.get(n + 1).is_none_or(|w| !matches!(w.kind, Kind::Number(_) | Kind::Letter));
        if let Kind::Number(place) = words[n - 1].kind
            && (n == 1 && matches!(words[n].kind, Kind::Known(_)) || counter(&words[n]))
            && alone
        {
            words[n - 1].kind = Kind::Ordinal(place);
        }
    }
    words
}

/// Whether a word ends in what balls are called, behind a part that says which: `hockeybal`,
/// `Wasserball`; shorter words end so by chance, as `global` does.
fn of_a_ball(word: &str) -> bool {
    let which = Phrase::Ball.all().iter().find_map(|ball| word.strip_suffix(ball));
    which.is_some_and(|which| which.chars().count() >= PART && which.chars().all(char::is_alphabetic))
}

/// Whether a word ends in what floors are called, behind a part that says which: `Sportboden`,
/// `gummimatta`.
fn of_a_floor(word: &str) -> bool {
    let which = Phrase::Flooring.all().iter().find_map(|floor| word.strip_suffix(floor));
    which.is_some_and(|which| which.chars().count() >= PART && which.chars().all(char::is_alphabetic))
}

/// A sign of a quantity and the event that it was read at, `hdrop`, `vout`.
fn symbol(word: &str) -> Option<[(&str, &'static [Atom]); 2]> {
    let (sign, event) = word.split_at_checked(1).filter(|(sign, _)| matches!(*sign, "h" | "v" | "t"))?;
    let atoms = meanings(event)?;
    let of_event = [Atom::Release, Atom::Rebound, Atom::Impact, Atom::Before, Atom::After];
    let named = event.len() > 2 && atoms.iter().any(|atom| of_event.contains(atom));
    Some([(sign, meanings(sign)?), (event, atoms)]).filter(|_| named)
}

/// A part of a compound has so many letters at least: shorter words are the ends of others.
const PART: usize = 4;

/// The two words that one is put together from, as in German, Dutch or Swedish: each is known, and
/// has to do with what is measured. An `s` may join them.
fn compound(word: &str) -> Option<[(&str, &'static [Atom]); 2]> {
    let part = |text: &'_ str| {
        let atoms = meanings(text)?;
        (text.chars().count() >= PART && atoms.iter().all(|atom| atom.measures())).then_some(atoms)
    };
    let cuts = word.char_indices().map(|(at, _)| word.split_at(at)).skip(PART);
    let mut found = cuts.filter_map(|(head, tail)| {
        let joined = || head.strip_suffix('s').and_then(|head| Some((head, part(head)?)));
        let head = part(head).map(|atoms| (head, atoms)).or_else(joined)?;
        Some([head, (tail, part(tail)?)])
    });
    found.next()
}

/// `e` between two that are counted joins them, `entre o 1º e o 2º`: it is no COR.
fn counted_and(words: &mut [Word]) {
    let counts = |w: &Word| matches!(w.kind, Kind::Number(_) | Kind::Ordinal(_));
    for n in 1..words.len() {
        let after = words[n + 1..].iter().find(|w| !matches!(w.kind, Kind::Known([Atom::Filler]) | Kind::Letter));
        if words[n].text == "e" && counts(&words[n - 1]) && after.is_some_and(counts) {
            words[n].kind = Kind::Known(&[Atom::Filler]);
        }
    }
}

/// The point that is the highest is the top of a flight, also where it stands first: `punto más
/// alto`.
fn highest(words: &mut [Word]) {
    for n in 1..words.len() {
        if words[n].is(Atom::Max) && Phrase::Point.is(&folded(&words[n - 1].text)) {
            words[n - 1].kind = Kind::Known(&[Atom::Filler]);
            words[n].kind = Kind::Known(&[Atom::Rebound, Atom::Top]);
        }
    }
}

/// What falls in height, or in speed, is not dropped but lost: `drop in height`.
fn fallen(words: &mut [Word]) {
    let of = |w: &Word| w.is(Atom::Height) || w.is(Atom::Speed) || w.is(Atom::Energy);
    for n in 2..words.len() {
        let falls = words[n - 2].is(Atom::Release) && Phrase::In.is(&words[n - 1].text) && of(&words[n]);
        if falls {
            words[n - 2].kind = Kind::Known(&[Atom::Lost]);
        }
    }
}

/// Whether something is let loose in a text.
pub(super) fn lets_loose(text: &str) -> bool {
    let spelt = folded(text);
    LOOSE.iter().any(|loose| spelt.contains(loose)) && split(text).iter().any(|word| word.is(Atom::Release))
}

/// The part of a verb that stands behind what is let loose.
const LOOSE: [&str; 2] = ["los", "go"];

/// What is let loose is released, though other words stand between: `we laten een bal los`.
fn let_loose(words: &mut [Word]) {
    let Some(at) = words.iter().position(|word| Phrase::Lets.is(&folded(&word.text))) else { return };
    if let Some(loose) = words[at + 1..].iter_mut().find(|word| LOOSE.contains(&&*folded(&word.text))) {
        loose.kind = Kind::Known(&[Atom::Release]);
    }
}

/// What lies below an instrument is a place, and nothing that was lost: `distance below detector`.
fn under_a_tool(words: &mut [Word]) {
    for n in 0..words.len() {
        let mut after = words[n + 1..].iter().skip_while(|w| matches!(w.kind, Kind::Known([Atom::Filler])));
        if Phrase::Below.is(&folded(&words[n].text)) && after.next().is_some_and(|w| w.is(Atom::Tool)) {
            words[n].kind = Kind::Known(&[Atom::Filler]);
        }
    }
}

/// The number that a Roman one of several letters, or the first, stands for.
fn roman(text: &str) -> Option<usize> {
    const COUNT: [&str; 12] = ["I", "II", "III", "IV", "V", "VI", "VII", "VIII", "IX", "X", "XI", "XII"];
    // `V` and `X` by themselves are signs of something else.
    COUNT.iter().position(|n| *n == text && !matches!(*n, "V" | "X")).map(|n| n + 1)
}

/// A single letter behind a trial or a ball is its name, whatever else it means: `run A`, `ball x`;
/// another one is not understood.
pub(super) fn lettered(words: &mut [Word]) {
    let measured = |w: &Word| w.is(Atom::Height) || w.is(Atom::Rebound) || w.is(Atom::Interval);
    for n in 1..words.len().saturating_sub(1) {
        let counted = matches!(words[n + 1].kind, Kind::Number(_));
        // `height V1`, `height T2`: of a trial, since what is measured is stated.
        if counted && matches!(words[n].text.as_str(), "V" | "v" | "T") && words[..n].iter().any(measured) {
            words[n].kind = Kind::Known(&[Atom::Trial]);
        }
    }
    // `R1`, `R2`: rebounds.
    if let [first, second] = words
        && first.text == "R"
        && matches!(second.kind, Kind::Number(_))
    {
        first.kind = Kind::Known(&[Atom::Rebound]);
    }
    // An article stands before a word: at the end the letter is a name.
    let rebounds = words.iter().any(measured);
    if let Some(last) = words.last_mut().filter(|last| matches!(&*last.text, "A" | "a") && rebounds) {
        last.kind = Kind::Letter;
    }
    for n in 0..words.len() {
        // A sign that is a word of its script is no letter.
        let sign = words[n].text.contains(unparted)
            && matches!(words[n].kind, Kind::Known(_))
            && !(n > 0 && words[n - 1].is(Atom::Trial));
        let one = words[n].text.chars().count() == 1 && !words[n].text.starts_with(|c: char| c.is_ascii_digit());
        let one = one && !sign;
        let named =
            n > 0 && [Atom::Trial, Atom::Repeat, Atom::Group, Atom::Label].iter().any(|atom| words[n - 1].is(*atom));
        let counted = roman(&words[n].text);
        let of_bounce = n > 0 && (words[n - 1].is(Atom::Rebound) || words[n - 1].is(Atom::Impact));
        if (one || counted.is_some()) && named {
            words[n].kind = Kind::Letter;
        } else if let Some(count) = counted.filter(|_| of_bounce) {
            words[n].kind = Kind::Number(count);
        } else if matches!(words[n].kind, Kind::Letter) {
            words[n].kind = Kind::Unknown;
        }
    }
}

/// `h1` as `h` and `1`.
pub(super) fn joined(word: &str) -> Option<(&str, &str)> {
    let at = word.find(|c: char| c.is_ascii_digit())?;
    let (letters, digits) = word.split_at(at);
    (!letters.is_empty() && digits.chars().all(|c| c.is_ascii_digit())).then_some((letters, digits))
}

/// Whether a word is a letter that stands for any number.
fn counts(word: &Word) -> bool {
    word.is(Atom::Number) && word.text.chars().count() == 1
}

/// The number that a word such as `2nd` or `1er` puts a bounce or a trial in.
pub(super) fn ordinal(word: &str) -> Option<usize> {
    let at = word.find(|c: char| !c.is_ascii_digit()).filter(|at| *at > 0)?;
    let (digits, end) = word.split_at(at);
    Phrase::Ending.is(end).then(|| digits.parse().ok()).flatten().filter(|n| *n <= MANY)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn atoms(text: &str) -> Option<Vec<Atom>> {
        let known = |word: &Word| match word.kind {
            Kind::Known(atoms) => Some(atoms.to_vec()),
            _ => None,
        };
        split(text).iter().map(known).collect::<Option<Vec<_>>>().map(|all| all.concat())
    }

    /// A word put together from two is read as those two, and a word of which a part is not known
    /// is not understood.
    #[test]
    fn compounds_are_their_parts() {
        for (one, two) in [("hoogteverlies", "hoogte verlies"), ("Aufprallszeit", "Aufprall Zeit")] {
            assert!(atoms(one).is_some() && atoms(one) == atoms(two), "{one}");
        }
        for (one, two) in [("hdrop", "h drop"), ("vimpact", "v impact"), ("hreb", "h rebound")] {
            assert!(atoms(one).is_some() && atoms(one) == atoms(two), "{one}");
        }
        for word in ["tape", "vball", "hand"] {
            assert!(symbol(word).is_none(), "{word}");
        }
        for word in ["hoogteboom", "timeball", "heightxyz", "weight", "verlies"] {
            assert!(compound(word).is_none(), "{word}");
        }
    }

    /// What drops in height is lost, and a slash between names is of no ratio.
    #[test]
    fn words_beside_others_turn_their_meaning() {
        let lost = |text: &str| split(text).iter().any(|word| word.is(Atom::Lost));
        assert!(lost("Drop in height (cm)") && lost("fall in speed") && !lost("drop in cm") && !lost("drop height"));
        let ratio = |text: &str| split(text).iter().any(|word| word.is(Atom::Ratio));
        assert!(ratio("h1/h0") && ratio("rebound / drop") && !ratio("Names: Anna / Tom") && !ratio("Wobble/Zorb"));
    }

    #[test]
    fn a_sound_peaks_at_a_contact() {
        assert!(split("time of sound peak").iter().any(|word| word.is(Atom::Impact)));
        assert!(!split("time of peak").iter().any(|word| word.is(Atom::Impact)));
    }
}
