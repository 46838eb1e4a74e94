//! From bytes to characters.

use std::borrow::Cow;

use encoding_rs::{
    BIG5, EUC_JP, EUC_KR, Encoding, GB18030, IBM866, ISO_8859_7, KOI8_R, MACINTOSH, SHIFT_JIS, WINDOWS_1250,
    WINDOWS_1251, WINDOWS_1253, WINDOWS_1254, WINDOWS_1255, WINDOWS_1256, WINDOWS_1257, WINDOWS_1258,
};

use super::limits::MANY;
use super::vocabulary::{folded, meanings, unparted};
use super::words::pieces;

/// Encodings that spreadsheets and older programs write, of which one is taken where more of a text
/// is understood by it than by Latin-1.
const OTHERS: [(&str, &Encoding); 18] = [
    ("Windows-1250", WINDOWS_1250),
    ("Windows-1251", WINDOWS_1251),
    ("Shift-JIS", SHIFT_JIS),
    ("GB18030", GB18030),
    ("Big5", BIG5),
    ("EUC-JP", EUC_JP),
    ("EUC-KR", EUC_KR),
    ("Windows-1253", WINDOWS_1253),
    ("ISO-8859-7", ISO_8859_7),
    ("Windows-1254", WINDOWS_1254),
    ("Windows-1257", WINDOWS_1257),
    ("Windows-1255", WINDOWS_1255),
    ("Windows-1256", WINDOWS_1256),
    ("Windows-1258", WINDOWS_1258),
    ("Mac OS Roman", MACINTOSH),
    ("KOI8-R", KOI8_R),
    ("IBM 866", IBM866),
    ("ISO-8859-2", encoding_rs::ISO_8859_2),
];

/// How many letters of words with other letters than those of English are understood; a character
/// by itself, of a script that parts no words by blanks, says little.
fn understood(text: &str) -> usize {
    let words = pieces(text).into_iter().filter(|word| !word.is_ascii() && meanings(&folded(word)).is_some());
    let letters = words.map(|word| (word.chars().count(), word.contains(unparted)));
    letters.filter(|(count, unparted)| *count > 1 || !unparted).map(|(count, _)| count).sum()
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
            let latin = |bytes: &[u8]| -> String { bytes.iter().copied().map(char::from).collect() };
            // Whole lines: none ends within a character.
            let beginning = &bytes[..bytes.len().min(MANY)];
            let lines = beginning.iter().rposition(|b| *b == b'\n').map_or(beginning, |end| &beginning[..end]);
            let least = understood(&latin(lines));
            let known = |of: &'static Encoding| {
                let text = of.decode_without_bom_handling_and_without_replacement(lines)?;
                Some(understood(&text)).filter(|known| *known > least)
            };
            let others = OTHERS.iter().rev().filter_map(|(name, of)| Some((known(of)?, *name, *of)));
            if let Some((_, name, of)) = others.max_by_key(|(known, _, _)| *known) {
                return (Cow::Owned(of.decode_without_bom_handling(bytes).0.into_owned()), Some(name));
            }
            (Cow::Owned(latin(bytes)), Some("Latin-1"))
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
        for (name, text) in [
            ("Windows-1250", "Výška (cm);průměr\n"),
            ("Windows-1250", "wysokość (cm)\n"),
            ("Windows-1251", "высота (см)\n"),
            ("KOI8-R", "высота отскока (см)\n"),
            ("IBM 866", "высота отскока (см)\n"),
            ("Shift-JIS", "落下高さ(cm),1回目(cm)\n"),
            ("EUC-JP", "落下高さ(cm),反発高さ(cm)\n"),
            ("GB18030", "下落高度(cm),反弹高度(cm)\n"),
            ("Big5", "落下高度(cm),反彈高度(cm)\n"),
            ("EUC-KR", "낙하 높이(cm),반발 높이(cm)\n"),
            ("Windows-1253", "ύψος (cm)\n"),
            ("Windows-1254", "yükseklik (cm);sıçrama\n"),
        ] {
            let (_, of) = OTHERS.iter().find(|(own, _)| *own == name).unwrap();
            let (bytes, _, _) = of.encode(text);
            assert_eq!(decoded(&bytes), (Cow::Borrowed(text), Some(name)));
        }
        let latin: Vec<u8> = "Höhe (cm)\n".chars().map(|c| c as u8).collect();
        assert_eq!(decoded(&latin), (Cow::Borrowed("Höhe (cm)\n"), Some("Latin-1")));
    }
}
