//! Rates of frames or samples: a number, a word for what is counted, and one for a second, in the
//! order of any language.

use std::ops::Range;

use super::super::phrases::Phrase;
use super::super::vocabulary::{Atom, first_word, folded, meanings, unparted};

/// The rate of frames or samples that a text states, `Frame (240 fps)`, `44.1 kHz`, `60 frames per
/// second`, in 1/s, and the text without it.
pub(in crate::read) fn rate(text: &str) -> Option<(f64, String)> {
    behind(text).or_else(|| spelt_out(text))
}

/// The rate behind which a sign of one stands, `240 fps`, `44.1 kHz`.
fn behind(text: &str) -> Option<(f64, String)> {
    let lower = text.to_ascii_lowercase();
    Phrase::Rated.all().iter().find_map(|unit| {
        let (at, _) = lower.match_indices(unit).next()?;
        let after = &text[at + unit.len()..];
        if after.starts_with(char::is_alphanumeric) {
            return None;
        }
        let head = text[..at].trim_end();
        let thousands = lower[..at].ends_with('k') && *unit == "hz";
        let (head, factor) = if thousands { (head[..at - 1].trim_end(), 1000.0) } else { (head, 1.0) };
        let before = head.trim_end_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | ','));
        let value = counted(&head[before.len()..])? * factor;
        Some((value, without(before, after)))
    })
}

/// The rate whose words stand around its number: `60 frames per second`, `60 Bilder/s`, `毎秒 60
/// コマ`.
fn spelt_out(text: &str) -> Option<(f64, String)> {
    let runs = runs(text);
    let is = |n: usize, kind: fn(&str) -> bool| runs.get(n).is_some_and(|run| kind(&text[run.clone()]));
    // So little stands between two of its words: a blank, a slash, the point of an abbreviation.
    let near = |n: usize| {
        let gap = runs.get(n).zip(runs.get(n + 1)).map(|(one, other)| &text[one.end..other.start]);
        gap.is_some_and(|gap| gap.chars().count() <= GAP && gap.chars().all(|c| matches!(c, ' ' | '/' | '.' | '-')))
    };
    let per = |n: usize| if is(n, leads) && near(n) { n + 1 } else { n };
    (0..runs.len()).find_map(|n| {
        let value = counted(&text[runs[n].clone()])?;
        let close = |from: usize, to: usize| (from..to).all(near);
        // `khung hình`: what is counted may be of two words.
        let last = (n + 1..n + 3).find(|&last| {
            let joined = runs.get(last).map(|run| &text[runs[n + 1].start..run.end]);
            close(n, last) && joined.is_some_and(counts)
        })?;
        let second = per(per(last + 1));
        if is(second, second_of) && close(last, second) {
            return Some((value, without(&text[..runs[n].start], &text[runs[second].end..])));
        }
        let begins = (n.saturating_sub(GAP)..n).find(|&from| is(from, second_of) && per(per(from + 1)) == n)?;
        close(begins, n).then(|| (value, without(&text[..runs[begins].start], &text[runs[last].end..])))
    })
}

/// So many signs stand between two words of a rate at most, and so many words in a row lead to one.
const GAP: usize = 3;

/// The numbers and words of a text, where they stand.
fn runs(text: &str) -> Vec<Range<usize>> {
    let kind = |c: char| match c {
        c if c.is_ascii_digit() || matches!(c, '.' | ',') => Some(true),
        c if c.is_alphabetic() || !c.is_ascii() && !c.is_whitespace() && !c.is_ascii_punctuation() => Some(false),
        _ => None,
    };
    let mut found: Vec<Range<usize>> = Vec::new();
    let mut last = None;
    for (at, c) in text.char_indices() {
        let own = kind(c);
        match found.last_mut().filter(|_| own.is_some() && own == last) {
            Some(run) => run.end = at + c.len_utf8(),
            None if own.is_some() => found.push(at..at + c.len_utf8()),
            None => {}
        }
        last = own;
    }
    // A mark by itself is no number.
    found.retain(|run| text[run.clone()].chars().any(char::is_alphanumeric));
    found
}

/// Whether a word counts frames, or samples; no blank parts it from the next in some scripts.
fn counts(word: &str) -> bool {
    let word = folded(word);
    let first = first_word(&word).filter(|_| word.contains(unparted)).unwrap_or(&word);
    let sampled = |atoms: &[Atom]| atoms.contains(&Atom::Frame) || atoms.contains(&Atom::Sample);
    Phrase::Frames.is(&word) || meanings(first).is_some_and(sampled)
}

/// Whether a word is of a second.
fn second_of(word: &str) -> bool {
    let word = folded(word);
    let begins = |second: &&&str| second.contains(unparted) && word.starts_with(**second);
    Phrase::Second.is(&word) || Phrase::Second.all().iter().any(|second| begins(&second))
}

/// Whether a word leads to what a rate is of: `per`, `in a`.
fn leads(word: &str) -> bool {
    Phrase::Per.is(&folded(word))
}

/// A number above zero, whose comma may part thousands, `44,100`.
fn counted(text: &str) -> Option<f64> {
    let thousands = text.split_once(',').is_some_and(|(_, rest)| rest.len() == 3);
    let plain = if thousands { text.replace(',', "") } else { text.replace(',', ".") };
    plain.parse().ok().filter(|value: &f64| value.is_finite() && *value > 0.0)
}

/// A text without what stood between two parts of it, and without the brackets around that.
fn without(before: &str, after: &str) -> String {
    // In brackets what the rate is called: `(fs = 44100 Hz)`, `(filmed at 120 fps)`.
    let open = before.rfind(['(', '[']).filter(|open| !before[*open..].contains([')', ']']));
    let before = open.map_or(before, |open| &before[..open]).trim_end_matches([' ', '@', '=', ':', '~']);
    let before = before.strip_suffix(" at").unwrap_or(before);
    format!("{before} {}", after.trim_start_matches([')', ']']))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rates_are_spelt_in_any_order() {
        for text in [
            "filmed at 240 fps",
            "240 frames per second",
            "240 frames/s",
            "240 frames in a second",
            "240 Bilder pro Sekunde",
            "240 Bilder/Sek.",
            "240 images par seconde",
            "240 im/s",
            "240 cuadros por segundo",
            "240 fotogrammi al secondo",
            "240 billeder pr. sekund",
            "240 kuvaa sekunnissa",
            "240 klatek na sekundę",
            "240 snímků za sekundu",
            "240 képkocka/másodperc",
            "másodpercenként 240 képkocka",
            "saniyede 240 kare",
            "240 kare/sn",
            "240 кадров в секунду",
            "240 кадрів за секунду",
            "240 καρέ ανά δευτερόλεπτο",
            "240 khung hình/giây",
            "240 khung hình trên giây",
            "240 frame per detik",
            "毎秒240コマ",
            "240コマ/秒で撮影",
            "每秒 240 帧",
            "240帧/秒",
            "초당 240프레임",
            "240 फ्रेम प्रति सेकंड",
            "240 إطار في الثانية",
            "240 samples per second",
            "240 cadre pe secundă",
        ] {
            assert_eq!(rate(text).map(|(rate, _)| rate), Some(240.0), "{text}");
        }
        for text in ["3 frames in 0.1 s", "Bild 3, 2 Sekunden", "240 cm", "frame 12", "2 s, 240 frames", "per second 3"]
        {
            assert_eq!(rate(text), None, "{text}");
        }
        assert_eq!(rate("Frame (240 kare/s)"), Some((240.0, "Frame ".to_owned())));
        assert_eq!(rate("44.1 kHz mono").map(|(rate, _)| rate), Some(44100.0));
    }
}
