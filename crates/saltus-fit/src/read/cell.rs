//! What a cell holds: a number, with a unit, an error and a remark if they stand there; nothing; or
//! words.

use super::phrases::Phrase;
use super::units::{Dimension, Scale, Unit};
use super::vocabulary::{Atom, SPREAD, folded, meanings};

/// A number in a cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    pub(super) value: f64,
    /// The unit, if the cell names one.
    pub(super) unit: Option<Unit>,
    /// The error, in the same unit.
    pub(super) error: Option<f64>,
}

/// What a cell holds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cell {
    Empty,
    Number(Measured),
    /// A word for "not a number", as programs write it.
    Lost,
    /// No number.
    Words,
    /// Meant as a number, and not one, and why.
    Wrong(Fault),
}

/// Why a cell that is meant as a number is none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Fault {
    /// A comma in a table separated by commas.
    Comma,
    /// A separator of thousands, or two decimal marks.
    Thousands,
    NotFinite,
    /// A word beside the number turns its meaning: `64 (predicted)`.
    Turned,
    /// A bound, and no reading: `> 60`.
    Bound,
}

/// The length that a text is and nothing else, m.
pub(super) fn length(text: &str) -> Option<f64> {
    match read(text, false) {
        Cell::Number(m) => m.unit.filter(|u| u.dimension == Dimension::Length && !u.unscaled()).map(|u| u.si(m.value)),
        _ => None,
    }
}

/// Reads a cell; `comma` says whether commas separate the cells.
pub(super) fn read(cell: &str, comma: bool) -> Cell {
    // A remark behind a number.
    let text = cell.split('#').next().unwrap_or_default().trim();
    if matches!(text, "" | "-" | "--" | "–" | "—" | "?" | "NA" | "n/a" | "N/A" | "na" | "#N/A" | ".") {
        return Cell::Empty;
    }
    // In Turkish the sign stands before the number.
    if let Some(number) = text.strip_prefix('%').filter(|number| number.starts_with(|c: char| c.is_ascii_digit())) {
        return read(&format!("{number}%"), comma);
    }
    if let Ok(value) = text.parse::<f64>() {
        let spelt = text.trim_start_matches(['+', '-']).starts_with(char::is_alphabetic);
        return match (value.is_finite(), spelt) {
            (true, _) => Cell::Number(Measured { value, unit: None, error: None }),
            (false, true) => Cell::Lost,
            (false, false) => Cell::Wrong(Fault::NotFinite),
        };
    }
    if bare(text) {
        return lengths(text, comma).map_or_else(Cell::Wrong, |found| found.map_or(Cell::Words, Cell::Number));
    }
    if let Some(value) = respelt(text).and_then(|spelt| spelt.parse().ok()) {
        return Cell::Number(Measured { value, unit: None, error: None });
    }
    let spelt = folded(text);
    // `missed it`, `no reading (too dark)`.
    let told = |word: &&str| spelt.strip_prefix(*word).is_some_and(|rest| rest.starts_with([' ', ',', ':', '(', '!']));
    let letters = |word: &&&str| word.len() > 2 && word.chars().all(|c| c.is_alphabetic() || c == ' ');
    let words = !spelt.contains(|c: char| c.is_ascii_digit());
    if Phrase::Missing.is(&spelt) || words && Phrase::Missing.all().iter().filter(letters).any(told) {
        return Cell::Empty;
    }
    if !text.contains(|c: char| c.is_ascii_digit() || FRACTIONS.iter().any(|f| f.0 == c)) {
        return Cell::Words;
    }
    if text.starts_with(['<', '>', '≤', '≥']) {
        return Cell::Wrong(Fault::Bound);
    }
    // Blanks may part thousands.
    let closed = spaced(text);
    let text = closed.as_deref().unwrap_or(text);
    // A reading in brackets is one that is not sure.
    let bare = text.strip_prefix('(').and_then(|t| t.strip_suffix(')')).filter(|t| !t.contains(['(', ')']));
    let asks = text.ends_with('?');
    let (text, turned) = without_remark(bare.unwrap_or(text));
    let text = without_about(text);
    if let Some(range) = range(text, comma) {
        // Whether a reading lies in a range that bears a unit is asked of it: `53-58 in?`.
        if asks && range.unit.is_some() {
            return Cell::Words;
        }
        return Cell::Number(range);
    }
    let (number, error) = match split_error(text) {
        Some((number, error)) => (number, Some(error)),
        None => (text, None),
    };
    let measured = match lengths(number, comma) {
        Ok(Some(measured)) => measured,
        Ok(None) => return Cell::Words,
        Err(fault) => return Cell::Wrong(fault),
    };
    if turned {
        return Cell::Wrong(Fault::Turned);
    }
    let Some(error) = error else { return Cell::Number(measured) };
    match lengths(error.trim(), comma) {
        Ok(Some(error)) => match error_of(measured, error) {
            Some(measured) => Cell::Number(measured),
            None => Cell::Words,
        },
        Ok(None) => Cell::Words,
        Err(fault) => Cell::Wrong(fault),
    }
}

/// A number of which letters stand for the digits that they look like, `1OO.0`, `l2,5`, with the
/// digits; `None` of anything else.
pub(super) fn respelt(cell: &str) -> Option<String> {
    let text = cell.trim();
    let digit = |c: char| match c {
        'O' | 'o' => '0',
        'l' | 'I' => '1',
        ',' => '.',
        c => c,
    };
    // `O2`, `l1` are names.
    let number = text.starts_with(|c: char| c.is_ascii_digit()) || text.chars().count() > 2;
    let mixed = text.contains(['O', 'o', 'l', 'I']) && text.contains(|c: char| c.is_ascii_digit());
    let spelt: String = if number && mixed { text.chars().map(digit).collect() } else { return None };
    spelt.parse::<f64>().is_ok_and(f64::is_finite).then_some(spelt)
}

/// Whether a text is a number and nothing else, however its marks are meant: it has no words.
fn bare(text: &str) -> bool {
    let part = |(at, c): (usize, char)| match c {
        '+' | '-' => at == 0 || text[..at].ends_with(['e', 'E']),
        c => c.is_ascii_digit() || matches!(c, '.' | ',' | 'e' | 'E'),
    };
    !text.starts_with(['e', 'E']) && !text.contains("..") && text.char_indices().all(part)
}

/// Readings of one event agree to this factor: `63-65` is a range of them, `5-11` is not.
pub(super) const RANGE: f64 = 1.5;

/// The ends of a range in words, `between 63 and 65 cm`.
fn between(text: &str) -> Option<(&str, &str)> {
    let (first, rest) = text.split_once(' ')?;
    let range = meanings(&folded(first)).is_some_and(|atoms| atoms.contains(&Atom::Between));
    let and = rest.split(' ').filter(|_| range).find(|word| Phrase::And.is(&folded(word)))?;
    let at = and.as_ptr() as usize - rest.as_ptr() as usize;
    Some((&rest[..at], &rest[at + and.len()..]))
}

/// The middle of a range, `63-65 cm` or `63 to 65`, and half its width for its error.
fn range(text: &str, comma: bool) -> Option<Measured> {
    let marked = || ["–", "—", " to ", " bis ", "..", "-"].iter().find_map(|mark| text.split_once(mark));
    let (low, high) = between(text).or_else(marked)?;
    let plain = |text: &str| lengths(text.trim(), comma).ok().flatten();
    let (low, high) = (plain(low)?, plain(high)?);
    let unit = high.unit.or(low.unit);
    let alike = low.unit.is_none() || low.unit == unit;
    let wide = low.value > 0.0 && high.value > low.value && high.value <= RANGE * low.value;
    let half = 0.5 * (high.value - low.value);
    (alike && wide).then_some(Measured { value: low.value + half, unit, error: Some(half) })
}

/// A number with its error, both in the unit of the number.
fn error_of(number: Measured, error: Measured) -> Option<Measured> {
    let size = match (number.unit, error.unit) {
        // The unit behind the error is for both: `150 ± 0.5 cm`.
        (None, Some(unit)) if unit.scale != Scale::Percent => {
            return Some(Measured { unit: Some(unit), error: Some(error.value).filter(|e| *e > 0.0), ..number });
        }
        (_, Some(unit)) if unit.scale == Scale::Percent => number.value.abs() * error.value / 100.0,
        (Some(own), Some(unit)) if own.dimension == unit.dimension => error.value * unit.si(1.0) / own.si(1.0),
        (_, None) => error.value,
        _ => return None,
    };
    Some(Measured { error: Some(size).filter(|e| *e > 0.0 && e.is_finite()), ..number })
}

/// The text without a remark in brackets or a mark behind it, and whether the remark turns the
/// meaning.
fn without_remark(text: &str) -> (&str, bool) {
    let text = text.trim_end_matches(['*', '?', '!', '†', '‡', ' ']);
    let Some((number, remark)) = text.strip_suffix([')', ']']).and_then(|t| t.split_once(['(', '['])) else {
        return (text, false);
    };
    // How many readings a mean is of, `64 ± 1 (n = 5)`.
    let count = |(word, number): (&str, &str)| {
        Phrase::Readings.is(&folded(word.trim())) && number.trim().parse::<usize>().is_ok()
    };
    let counts = remark.split_once('=').is_some_and(count);
    if number.trim().is_empty() || !counts && number.contains('±') && remark.contains(|c: char| c.is_ascii_digit()) {
        return (text, false);
    }
    let turns = |word: &str| {
        let turning =
            [Atom::Predicted, Atom::Goal, Atom::Lost, Atom::Derived, Atom::Mean, Atom::Max, Atom::Min, Atom::Error];
        meanings(&folded(word)).is_some_and(|atoms| atoms.iter().any(|atom| turning.contains(atom)))
    };
    (number.trim_end(), remark.split(|c: char| !c.is_alphabetic()).any(turns))
}

/// The text without what says that it is not exact: `~62`, `ca. 62`.
fn without_about(text: &str) -> &str {
    let words = Phrase::About.all();
    let text = text.trim_start_matches(['~', '≈', '∼', '≃', ' ']);
    let before = words.iter().find_map(|word| text.get(..word.len()).filter(|t| t.eq_ignore_ascii_case(word)));
    let text = before.map_or(text, |word| text[word.len()..].trim_start());
    let lower = text.to_lowercase();
    let after = words.iter().find(|word| lower.ends_with(*word)).filter(|_| lower.len() == text.len());
    after.map_or(text, |word| text[..text.len() - word.len()].trim_end())
}

fn split_error(text: &str) -> Option<(&str, &str)> {
    SPREAD.iter().find_map(|mark| text.split_once(mark)).map(|(a, b)| (a.trim(), b))
}

/// One number, or several with falling units that add up: `5' 3"`, `1 m 20 cm`; `None` if it is
/// something else.
fn lengths(text: &str, comma: bool) -> Result<Option<Measured>, Fault> {
    let mut sum: Option<Measured> = None;
    let mut rest = text.trim();
    while !rest.is_empty() {
        let Some((value, after)) = leading(rest, comma)? else { return Ok(None) };
        // The unit goes to the next digit, which may not be part of it.
        let end = after
            .find(|c: char| c.is_ascii_digit())
            .filter(|_| sum.is_none() || !after.is_empty())
            .unwrap_or(after.len());
        let (spelt, next) = after.split_at(end);
        // Its parts may be joined by a word: `5 feet and 3 inches`.
        let spelt = spelt.trim().trim_end_matches("and").trim_end_matches(',').trim();
        let unit = match spelt {
            "" => None,
            spelt => match Unit::parse(spelt) {
                Some(unit) => Some(unit),
                None => return Ok(None),
            },
        };
        rest = next.trim();
        sum = match sum {
            None if rest.is_empty() => Some(Measured { value, unit, error: None }),
            None if unit.is_some() => Some(Measured { value, unit, error: None }),
            Some(whole) => {
                let Some(own) = whole.unit else { return Ok(None) };
                // Feet and then inches; a metre and then centimetres.
                let unit = unit.or(Unit::parse(if Unit::parse("ft") == Some(own) { "in" } else { "cm" }));
                let Some(unit) = unit.filter(|u| u.dimension == own.dimension && u.si(1.0) < own.si(1.0)) else {
                    return Ok(None);
                };
                Some(Measured { value: whole.value + unit.si(value) / own.si(1.0), ..whole })
            }
            None => return Ok(None),
        };
    }
    Ok(sum)
}

const FRACTIONS: [(char, f64); 5] = [('½', 0.5), ('¼', 0.25), ('¾', 0.75), ('⅛', 0.125), ('⅜', 0.375)];

/// The number at the start of a text, and what follows it.
fn leading(text: &str, comma: bool) -> Result<Option<(f64, &str)>, Fault> {
    let mut end = 0;
    let mut digits = false;
    for (at, c) in text.char_indices() {
        let exponent = matches!(c, 'e' | 'E') && digits && {
            let after = text[at + 1..].trim_start_matches(['+', '-', '−']);
            after.starts_with(|c: char| c.is_ascii_digit()) && !text[..at].contains(['e', 'E'])
        };
        let sign = matches!(c, '+' | '-' | '−') && (at == 0 || text[..at].ends_with(['e', 'E']));
        if !(c.is_ascii_digit() || matches!(c, '.' | ',') || exponent || sign) {
            break;
        }
        digits |= c.is_ascii_digit();
        end = at + c.len_utf8();
    }
    let (number, mut rest) = text.split_at(end);
    let mut value = if digits {
        match decimal(number, comma)? {
            Some(value) => value,
            None => return Ok(None),
        }
    } else {
        0.0
    };
    // A mixed number: `40 1/2`, `40½`.
    let tail = rest.trim_start();
    if let Some(&(sign, part)) = FRACTIONS.iter().find(|(sign, _)| tail.starts_with(*sign)) {
        value += part;
        rest = &tail[sign.len_utf8()..];
    } else if let Some((over, under, after)) = fraction(tail).filter(|_| digits) {
        value += over / under;
        rest = after;
    } else if !digits {
        return Ok(None);
    }
    Ok(Some((value, rest)))
}

/// `1/2` and what follows it.
pub(super) fn fraction(text: &str) -> Option<(f64, f64, &str)> {
    let (over, rest) = text.split_once('/')?;
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let (over, under): (f64, f64) = (over.trim().parse().ok()?, rest[..end].parse().ok()?);
    (over < under && over > 0.0).then_some((over, under, &rest[end..]))
}

/// A number with a decimal point or, where commas do not separate the cells, a decimal comma.
fn decimal(number: &str, comma: bool) -> Result<Option<f64>, Fault> {
    let plain = number.replace('−', "-");
    if let Some(value) = thousands(&plain) {
        return Ok(Some(value));
    }
    let value = if let Some((whole, parts)) = plain.split_once(',') {
        if parts.contains(',') || plain.contains('.') {
            return Err(Fault::Thousands);
        }
        // Thousands have three digits behind the comma, and no zero alone before it.
        if comma && parts.len() == 3 && whole.trim_start_matches('-') != "0" {
            return Err(Fault::Comma);
        }
        plain.replace(',', ".").parse::<f64>()
    } else {
        plain.parse::<f64>()
    };
    match value {
        Ok(value) if value.is_finite() => Ok(Some(value)),
        Ok(_) => Err(Fault::NotFinite),
        Err(_) => Ok(None),
    }
}

/// A number whose thousands are parted by blanks or by apostrophes, `1 500`, `1'500`, without them.
pub(super) fn spaced(text: &str) -> Option<String> {
    const PARTS: [char; 5] = [' ', '\u{a0}', '\u{202f}', '\'', '’'];
    let end = text.find(|c: char| !(c.is_ascii_digit() || PARTS.contains(&c))).unwrap_or(text.len());
    let number = text[..end].trim_end_matches(PARTS);
    let parts: Vec<&str> = number.split(PARTS).collect();
    let grouped =
        parts.len() > 1 && (1..=3).contains(&parts[0].len()) && parts.iter().skip(1).all(|part| part.len() == 3);
    grouped.then(|| parts.concat() + &text[number.len()..])
}

/// A number with separators of thousands beside a decimal mark of the other kind: `1.000,5`,
/// `1,234.5`.
fn thousands(number: &str) -> Option<f64> {
    let (first, last) = (number.find(['.', ','])?, number.rfind(['.', ','])?);
    let (mark, point) = (number[first..].chars().next()?, number[last..].chars().next()?);
    let whole: Vec<&str> = number[..last].split(mark).collect();
    let grouped =
        whole.iter().skip(1).all(|part| part.len() == 3) && (1..=3).contains(&whole[0].trim_start_matches('-').len());
    (mark != point && grouped).then(|| format!("{}.{}", whole.concat(), &number[last + 1..]).parse().ok())?
}

/// Whether a text is a date, `2024-05-12`, `12.05.24`.
pub(super) fn date(text: &str) -> bool {
    let parts = text.split(['-', '.', '/']);
    let digits = |part: &str| !part.is_empty() && part.len() <= 4 && part.chars().all(|c| c.is_ascii_digit());
    parts.clone().count() == 3 && parts.clone().all(digits)
}

/// A date and the time of day behind it, `2024-05-12T10:15:30.120Z`, `12.05.2024 10:15:30`.
pub(super) fn dated(cell: &str) -> Option<(&str, &str)> {
    let (day, time) = cell.trim().split_once(['T', ' '])?;
    // Behind it the half of the day and the zone.
    let time = time
        .trim()
        .split_once(' ')
        .filter(|(_, zone)| zone.starts_with(char::is_alphabetic))
        .map_or(time, |(time, _)| time);
    date(day).then_some((day, time.trim().trim_end_matches('Z')))
}

/// The seconds in a cell that reads like a stopwatch, `0:01.25` or `1:02:03,4`; `None` if it does
/// not, as where a fourth part counts what nobody states, frames or hundredths.
pub(super) fn clock(cell: &str) -> Option<f64> {
    let mut seconds = 0.0;
    if !cell.contains(':') {
        return None;
    }
    let time = dated(cell).map_or(cell.trim(), |(_, time)| time);
    if time.matches(':').count() > 2 {
        return None;
    }
    for part in time.split(':') {
        let digits = part.starts_with(|c: char| c.is_ascii_digit());
        seconds = 60.0 * seconds + part.replace(',', ".").parse::<f64>().ok().filter(|_| digits)?;
    }
    Some(seconds).filter(|s: &f64| s.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn number(cell: &str) -> (f64, Option<f64>, bool) {
        match read(cell, false) {
            Cell::Number(m) => (m.unit.map_or(m.value, |u| u.si(m.value)), m.error, m.unit.is_some()),
            other => panic!("{cell}: {other:?}"),
        }
    }

    #[test]
    fn numbers_as_people_write_them() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-9;
        for (cell, value, error, unit) in [
            ("64", 64.0, None, false),
            ("1.50 m", 1.5, None, true),
            ("25.5cm", 0.255, None, true),
            ("30,5", 30.5, None, false),
            ("−3", -3.0, None, false),
            ("1.000,5", 1000.5, None, false),
            ("1,234.5 mm", 1.2345, None, true),
            ("1 500", 1500.0, None, false),
            ("1'500 mm", 1.5, None, true),
            ("5' 3\"", 1.6002, None, true),
            ("~62", 62.0, None, false),
            ("ca. 62 cm", 0.62, None, true),
            ("62 (approx.)", 62.0, None, false),
            ("62*", 62.0, None, false),
            ("(62)", 62.0, None, false),
            ("96 ± 1", 96.0, Some(1.0), false),
            ("96 +/- 1 cm", 0.96, Some(1.0), true),
            ("96 cm ± 10 mm", 0.96, Some(1.0), true),
            ("96 ± 1 (n=5)", 96.0, Some(1.0), false),
            ("96 ± 1 cm (N = 12)", 0.96, Some(1.0), true),
            ("100 ± 2 %", 100.0, Some(2.0), false),
            ("64 %", 0.64, None, true),
            ("63-65", 64.0, Some(1.0), false),
            ("63 – 65 cm", 0.64, Some(1.0), true),
            ("63 to 65", 64.0, Some(1.0), false),
            ("5' 3\"", 1.6002, None, true),
            ("5'3", 1.6002, None, true),
            ("5 ft 3 in", 1.6002, None, true),
            ("5 feet and 3 inches", 1.6002, None, true),
            ("1 m 20 cm", 1.2, None, true),
            ("1m20", 1.2, None, true),
            ("40 1/2 in", 1.0287, None, true),
            ("40½ in", 1.0287, None, true),
            ("1.5e-1 m", 0.15, None, true),
            ("64 # a remark", 64.0, None, false),
            ("1OO.0", 100.0, None, false),
            ("l2,5", 12.5, None, false),
            ("6O", 60.0, None, false),
        ] {
            let found = number(cell);
            assert!(near(found.0, value) && found.1 == error && found.2 == unit, "{cell}: {found:?}");
        }
    }

    #[test]
    fn what_is_no_number() {
        for (cell, expected) in [
            ("", Cell::Empty),
            ("-", Cell::Empty),
            ("n/a", Cell::Empty),
            ("Missed", Cell::Empty),
            ("missed it", Cell::Empty),
            ("lost 3 cm", Cell::Words),
            ("NaN", Cell::Lost),
            ("drop", Cell::Words),
            ("62 wobbles", Cell::Words),
            ("O2", Cell::Words),
            ("l1", Cell::Words),
            ("12.3.2026", Cell::Words),
            ("5-11", Cell::Words),
            ("2024/03/12 10:21", Cell::Words),
            ("2026-05-03", Cell::Words),
            ("64 (predicted)", Cell::Wrong(Fault::Turned)),
            ("64 ± 1 (2)", Cell::Words),
            ("64 ± 1 (k = 2)", Cell::Words),
            ("1.000.5", Cell::Words),
            ("1,000,5", Cell::Wrong(Fault::Thousands)),
            ("1e999", Cell::Wrong(Fault::NotFinite)),
            ("> 60", Cell::Wrong(Fault::Bound)),
        ] {
            assert_eq!(read(cell, false), expected, "{cell}");
        }
        assert_eq!(read("1,234", true), Cell::Wrong(Fault::Comma));
        assert!(matches!(read("30,5", true), Cell::Number(m) if m.value == 30.5));
        assert_eq!([clock("0:01.25"), clock("1:02:03,5"), clock("12.5")], [Some(1.25), Some(3723.5), None]);
        assert_eq!(clock("0:00:01:25"), None);
    }
}
