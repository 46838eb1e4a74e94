//! Digits of other scripts, and the marks that stand in numbers of theirs, as those of Latin ones.

/// The zeros of scripts whose ten digits stand one behind the other: Arabic, Persian, Devanagari,
/// Bengali, Gurmukhi, Gujarati, Oriya, Tamil, Telugu, Kannada, Malayalam, Thai, Lao, Myanmar,
/// Khmer, and those of full width that East Asian keyboards write.
const ZEROS: [char; 16] = [
    '\u{660}', '\u{6f0}', '\u{966}', '\u{9e6}', '\u{a66}', '\u{ae6}', '\u{b66}', '\u{be6}', '\u{c66}', '\u{ce6}',
    '\u{d66}', '\u{e50}', '\u{ed0}', '\u{1040}', '\u{17e0}', '\u{ff10}',
];

/// The digit that a character stands for.
fn digit(c: char) -> Option<char> {
    let of = |zero: &char| u32::from(c).checked_sub(u32::from(*zero)).filter(|value| *value < 10);
    ZEROS.iter().find_map(of).and_then(|value| char::from_digit(value, 10))
}

/// A text with the digits of other scripts as plain ones, and the marks between them; `None` where
/// it has none.
pub(super) fn plain(text: &str) -> Option<String> {
    if text.is_ascii() || !text.contains(|c| digit(c).is_some()) {
        return None;
    }
    let mut found = String::with_capacity(text.len());
    let mut letters = text.chars().peekable();
    while let Some(c) = letters.next() {
        let within =
            found.ends_with(|c: char| c.is_ascii_digit()) && letters.peek().is_some_and(|c| digit(*c).is_some());
        match (c, digit(c)) {
            (_, Some(plain)) => found.push(plain),
            ('\u{66b}' | '．', _) if within => found.push('.'),
            ('\u{60c}', _) if within => found.push(','),
            // Arabic parts thousands by a mark of its own.
            ('\u{66c}', _) if within => {}
            ('\u{66a}' | '％', _) => found.push('%'),
            _ => found.push(c),
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn digits_of_other_scripts_are_plain_ones() {
        for (text, same) in [
            ("١٢٫٥ سم", "12.5 سم"),
            ("۱۰۰", "100"),
            ("९६.२", "96.2"),
            ("１５０．５", "150.5"),
            ("١٬٢٠٠", "1200"),
            ("٦٤٪", "64%"),
            ("๙๖", "96"),
        ] {
            assert_eq!(plain(text).as_deref(), Some(same), "{text}");
        }
        assert_eq!([plain("Höhe 12"), plain("12.5")], [None, None]);
    }
}
