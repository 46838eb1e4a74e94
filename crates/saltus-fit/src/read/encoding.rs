//! From bytes to characters.

use std::borrow::Cow;

use super::limits::MANY;
use super::vocabulary::{folded, meanings};

/// What the upper half of the bytes stands for in the encodings of one byte a character that
/// spreadsheets write in central and in eastern Europe; `?` for none.
const UPPER: [(&str, &str); 2] = [
    (
        "Windows-1250",
        "€?‚?„…†‡?‰Š‹ŚŤŽŹ?‘’“”•–—?™š›śťžź\u{a0}ˇ˘Ł¤Ą¦§¨©Ş«¬\u{ad}®Ż°±˛ł´µ¶·¸ąş»Ľ˝ľżŔÁÂĂÄĹĆÇČÉĘËĚÍÎĎĐŃŇÓÔŐÖ×ŘŮÚŰÜÝŢßŕáâăäĺćçčéęëěíîďđńňóôőö÷řůúűüýţ˙",
    ),
    (
        "Windows-1251",
        "ЂЃ‚ѓ„…†‡€‰Љ‹ЊЌЋЏђ‘’“”•–—?™љ›њќћџ\u{a0}ЎўЈ¤Ґ¦§Ё©Є«¬\u{ad}®Ї°±Ііґµ¶·ё№є»јЅѕїАБВГДЕЖЗИЙКЛМНОПРСТУФХЦЧШЩЪЫЬЭЮЯабвгдежзийклмнопрстуфхцчшщъыьэюя",
    ),
];

/// How many words with other letters than those of English are understood.
fn understood(text: &str) -> usize {
    let words = text.split(|c: char| !c.is_alphabetic()).filter(|word| !word.is_ascii());
    words.filter(|word| meanings(&folded(word)).is_some()).count()
}

pub(super) fn decoded(bytes: &[u8]) -> (Cow<'_, str>, Option<&'static str>) {
    if let Some(little) = utf16(bytes) {
        let bytes = bytes.strip_prefix(&[0xFF, 0xFE]).or(bytes.strip_prefix(&[0xFE, 0xFF])).unwrap_or(bytes);
        let unit = |pair: &[u8]| match *pair {
            [a, b] if little => u16::from_le_bytes([a, b]),
            [a, b] => u16::from_be_bytes([a, b]),
            // Half a character at the end.
            _ => 0xFFFD,
        };
        let characters = char::decode_utf16(bytes.chunks(2).map(unit));
        let text = characters.map(|c| c.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
        return (Cow::Owned(text), Some("UTF-16"));
    }
    let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    match std::str::from_utf8(bytes) {
        Ok(text) => (Cow::Borrowed(text), None),
        // What is no UTF-8 was written by a program that knew one byte a character: Latin-1, near
        // enough, unless more words of the beginning are understood by another.
        Err(_) => {
            let by = |bytes: &[u8], upper: &[char]| -> String {
                let high = |b: u8| b.checked_sub(0x80).and_then(|at| upper.get(usize::from(at)).copied());
                bytes.iter().map(|&b| high(b).unwrap_or(char::from(b))).collect()
            };
            let beginning = &bytes[..bytes.len().min(MANY)];
            let known = |upper: &[char]| understood(&by(beginning, upper));
            let least = known(&[]);
            let others = UPPER.iter().map(|(name, upper)| (*name, upper.chars().collect::<Vec<_>>()));
            let others = others.map(|(name, upper)| (known(&upper), name, upper));
            let best = others.filter(|(count, _, _)| *count > least).max_by_key(|(count, _, _)| *count);
            let (name, upper) = best.map_or(("Latin-1", Vec::new()), |(_, name, upper)| (name, upper));
            (Cow::Owned(by(bytes, &upper)), Some(name))
        }
    }
}

/// Whether this is UTF-16, and then whether its low byte comes first: by its mark, or by the zeros
/// between Latin letters.
fn utf16(bytes: &[u8]) -> Option<bool> {
    match bytes {
        [0xFF, 0xFE, ..] => Some(true),
        [0xFE, 0xFF, ..] => Some(false),
        [a, 0, b, 0, ..] if *a != 0 && *b != 0 => Some(true),
        [0, a, 0, b, ..] if *a != 0 && *b != 0 => Some(false),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_encoding_is_that_in_which_words_are_understood() {
        let bytes = |text: &str, upper: &str| -> Vec<u8> {
            let byte = |c: char| upper.chars().position(|u| u == c).map_or(c as u8, |at| at as u8 + 0x80);
            text.chars().map(byte).collect()
        };
        for (name, upper, text) in [
            (UPPER[0].0, UPPER[0].1, "Výška (cm);průměr\n"),
            (UPPER[0].0, UPPER[0].1, "wysokość (cm)\n"),
            (UPPER[1].0, UPPER[1].1, "высота (см)\n"),
        ] {
            assert_eq!(decoded(&bytes(text, upper)), (Cow::Borrowed(text), Some(name)));
        }
        let latin: Vec<u8> = "Höhe (cm)\n".chars().map(|c| c as u8).collect();
        assert_eq!(decoded(&latin), (Cow::Borrowed("Höhe (cm)\n"), Some("Latin-1")));
    }
}
