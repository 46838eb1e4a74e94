//! Whether heights were computed: a factor that is the same to more digits than a ball keeps to,
//! and a formula that fills a column from the cell above.

use std::collections::BTreeMap;

use super::said::ALIKE;
use super::units::Unit;
use super::vocabulary::{Atom, folded};
use super::words::split;
use super::written::step;
use super::{Event, Reading, Table};
use crate::finding::Doubt;

/// Heights that a ball comes up to are off those of one factor by this part at the least, however
/// well they are read: no floor and no spin is the same again.
const KEEPS: f64 = 0.005;
/// Heights are computed where a ball would keep to one factor as well by chance less often than
/// once in so many powers of ten.
const CHANCE: f64 = 8.0;

/// Only heights that are written finer by so many powers of ten than a ball keeps to a factor tell:
/// a rule shows no more.
const FINER: f64 = 1.0;

/// Of a factor that the text states heights are computed where a ball would keep to it as well by
/// chance less often than once in so many powers of ten.
const CHANCE_STATED: f64 = 2.0;

/// So many words lie between the name of a COR and its number at most, with the name: `COR of
/// about 0.8`.
const NAMED: usize = 3;

/// The factors that two heights may have been computed by, and how much it tells that they are of
/// one: in powers of ten, how much finer the heights are written than a ball keeps to a factor.
struct Link {
    low: f64,
    high: f64,
    fine: f64,
}

impl Link {
    /// `None` where one of the heights is so low that its factor may be any.
    fn of(before: f64, after: f64, step: f64) -> Option<Self> {
        let half = 0.5 * step;
        let fine = (KEEPS * after / step).log10();
        (before > step && after > step).then(|| Self {
            low: (after - half) / (before + half),
            high: (after + half) / (before - half),
            fine,
        })
    }

    fn told(&self) -> f64 {
        if self.fine >= FINER { self.fine } else { 0.0 }
    }
}

/// The doubt about heights of a ball, or of a floor, each of which is the one before it times one
/// factor, as far as the digits tell; a COR, or its square, that a text states is such a factor.
pub(super) fn doubt<'a>(table: &Table, texts: impl Iterator<Item = &'a str>) -> Option<Doubt> {
    let metadata = &table.metadata;
    if metadata.pixels || metadata.ratios || metadata.speeds {
        return None;
    }
    let height = |r: &Reading| r.height.filter(|_| matches!(r.event, Event::Release | Event::Apex));
    let all = table.trials.iter().flat_map(|trial| &trial.readings).filter_map(height);
    let step = written(all);
    let mut links: BTreeMap<&str, Vec<Link>> = BTreeMap::new();
    // Beside times the motion itself tells.
    let timed = |r: &Reading| r.time.is_some();
    for trial in table.trials.iter().filter(|trial| !trial.readings.iter().any(timed)) {
        let read = |r: &Reading| Some((r.bounce, height(r)?));
        let heights: Vec<(usize, f64)> = trial.readings.iter().filter_map(read).collect();
        let next = heights.windows(2).filter(|pair| pair[1].0 == pair[0].0 + 1);
        let found = next.filter_map(|pair| Link::of(pair[0].1, pair[1].1, step));
        links.entry(&trial.group).or_default().extend(found);
    }
    let stated: Vec<f64> = texts.flat_map(factors).collect();
    links.into_values().find_map(|links| of_one_factor(&links).or_else(|| of_stated(&links, &stated)))
}

/// What heights fall to by the CORs, or the ratios of heights, that a text states right behind
/// their names: `assume e = 0.81`, `a COR of 0.81`.
fn factors(text: &str) -> Vec<f64> {
    let parts = |c: char| c.is_whitespace() || matches!(c, '=' | '(' | ')' | ';' | ':' | '~' | '≈');
    let tokens: Vec<&str> = text.split(parts).filter(|token| !token.is_empty()).collect();
    let named =
        |token: &&str| split(token).iter().any(|w| w.is(Atom::Cor) || w.is(Atom::Ratio) || folded(&w.text) == "e");
    let number = |token: &str| token.trim_end_matches(['.', ',']).replace(',', ".").parse::<f64>().ok();
    let stated = tokens.iter().enumerate().filter_map(|(at, token)| {
        let number = number(token).filter(|n| *n > 0.0 && *n < 1.0)?;
        tokens[at.saturating_sub(NAMED)..at].iter().any(named).then_some(number)
    });
    stated.flat_map(|n| [n * n, n]).collect()
}

/// The doubt where links are of a factor that is stated.
fn of_stated(links: &[Link], stated: &[f64]) -> Option<Doubt> {
    let told: f64 = links.iter().map(|link| link.fine.max(0.0)).sum();
    let of = |factor: &&f64| links.iter().all(|link| link.low <= **factor && **factor <= link.high);
    let factor = stated.iter().find(of).filter(|_| links.len() >= ALIKE && told >= CHANCE_STATED)?;
    Some(Doubt::Computed { factor: digits(*factor, KEEPS * factor), heights: links.len() })
}

/// To how much heights were written, in a unit of either system, m.
fn written(heights: impl Iterator<Item = f64> + Clone) -> f64 {
    let inch = Unit::parse("in").map_or(1.0, |unit| unit.si(1.0));
    step(heights.clone()).max(inch * step(heights.map(|height| height / inch)))
}

/// The doubt where links of a factor that is not stated, which takes what one of them tells, are
/// too much alike for a ball.
fn of_one_factor(links: &[Link]) -> Option<Doubt> {
    let low = links.iter().map(|link| link.low).fold(0.0, f64::max);
    let high = links.iter().map(|link| link.high).fold(f64::INFINITY, f64::min);
    let most = links.iter().map(Link::told).fold(0.0, f64::max);
    let told = links.iter().map(Link::told).sum::<f64>() - most;
    let alike = links.len() >= ALIKE && low <= high && told >= CHANCE;
    alike.then(|| Doubt::Computed { factor: digits(f64::midpoint(low, high), high - low), heights: links.len() })
}

/// A factor with as many digits as its bounds share.
fn digits(factor: f64, width: f64) -> String {
    let places = (1..9usize).find(|&n| 10f64.powi(-i32::try_from(n).unwrap_or(0)) < width).unwrap_or(9);
    let text = format!("{factor:.places$}");
    text.trim_end_matches('0').to_owned()
}

/// Whether a text states that a cell is a number times the one above it: `B6 = B5*0.8`.
pub(super) fn recurs(text: &str) -> bool {
    let bare: String = text.chars().filter(|c| !c.is_whitespace() && *c != '$').collect();
    bare.match_indices('=').any(|(at, _)| {
        let (before, after) = (&bare[..at], &bare[at + 1..]);
        let other = before.char_indices().rfind(|(_, c)| !c.is_ascii_alphanumeric());
        let start = other.map_or(0, |(at, c)| at + c.len_utf8());
        let start = (start..before.len()).find(|&n| reference(&before[n..]).is_some_and(|(.., rest)| rest.is_empty()));
        let filled = start.and_then(|start| reference(&before[start..]));
        let times = |c: char| matches!(c, '*' | '·' | '×' | '/');
        let led = after.trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | ','));
        let behind = led.strip_prefix(times).filter(|_| led.len() < after.len());
        let by =
            |rest: &str| rest.strip_prefix(times).is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
        let from = behind.and_then(reference).or_else(|| reference(after).filter(|(.., rest)| by(rest)));
        let above = |((column, row, _), (of, above, _)): ((&str, u32, &str), (&str, u32, &str))| {
            column == of && row == above + 1
        };
        filled.zip(from).is_some_and(above)
    })
}

/// The column, and the row, of a cell that a text begins with, and what stands behind it.
fn reference(text: &str) -> Option<(&str, u32, &str)> {
    let letters = text.find(|c: char| !c.is_ascii_uppercase())?;
    let rest = &text[letters..];
    let digits = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    let row = rest[..digits].parse().ok()?;
    (letters > 0 && digits > 0).then(|| (&text[..letters], row, &rest[digits..]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_formula_that_fills_from_the_cell_above_is_found() {
        for text in [
            "B6 = B5*0,64 nach unten gezogen",
            "=> C3=C2*0.8",
            "formule : $D$4=0,7*$D$3",
            "A10=A9/1.25",
            "列Bは B4=B3*0.7 です",
        ] {
            assert!(recurs(text), "{text}");
        }
        for text in
            ["A6 = A5 + 1", "D2 = C2*100", "e = sqrt(C2/B2)", "B6 = B4*0.8", "x = 5", "C3=B2*0.8", "h1 = h0*0.8", "="]
        {
            assert!(!recurs(text), "{text}");
        }
    }

    /// A ball that keeps one factor to half a part in a hundred does so twice in a row, to all
    /// digits, once in so many drops; a factor that was filled in is kept to the last digit.
    #[test]
    fn only_a_factor_beyond_chance_was_filled_in() {
        let told = |e: f64, step: f64, count: i32, off: f64| {
            let height = |n: i32| {
                let height = 1.8 * e.powi(n) * (1.0 + off * f64::from(n % 3));
                (height / step).round() * step
            };
            let links: Vec<Link> = (1..count).filter_map(|n| Link::of(height(n - 1), height(n), step)).collect();
            of_one_factor(&links).is_some()
        };
        assert!(told(0.64, 1e-6, 7, 0.0) && told(0.64, 1e-5, 6, 0.0));
        assert!(!told(0.64, 1e-3, 9, 0.0) && !told(0.64, 1e-6, 3, 0.0) && !told(0.64, 1e-6, 7, 1e-4));
    }
}
