//! Lines that begin with a height of release and list what the ball came back to, `dropped from
//! 1 m: 64, 63 and 65 cm`: a row for each rebound; where it falls as bounces do, a row for each
//! line.

use super::super::cell::length;
use super::super::heading::Heading;
use super::super::units::Unit;
use super::super::words::without_brackets;
use super::{Part, parts};

/// A height of release and the heights behind it, as they are written.
struct Line {
    release: String,
    heights: Vec<String>,
}

impl Line {
    /// By how much the logarithms of the ratios of heights are off those of bounces, each the ratio
    /// of the first to the release, and off those of repeats, zero; as sums of squares.
    fn off(&self) -> [f64; 2] {
        let all: Vec<f64> = std::iter::once(&self.release).chain(&self.heights).filter_map(|h| length(h)).collect();
        let ratios: Vec<f64> = all.windows(2).map(|pair| (pair[1] / pair[0]).ln()).collect();
        let (first, later) = ratios.split_first().unwrap_or((&0.0, &[]));
        [*first, 0.0].map(|usual| later.iter().map(|ratio| (ratio - usual).powi(2)).sum())
    }
}

/// The text with a row for each rebound, or for the bounces of each line, and its other lines as
/// remarks; `None` where fewer than two lines are such, or where numbers of one are no rebounds.
pub(super) fn table(text: &str) -> Option<String> {
    if text.contains(['\t', '|', '=']) {
        return None;
    }
    let lines: Vec<Option<Line>> = text.lines().map(of_line).collect();
    let all = || lines.iter().flatten();
    let most = all().map(|line| line.heights.len()).max()?;
    // A list of one is a name and a number.
    if most < 2 || all().count() < 2 {
        return None;
    }
    let [of_bounces, of_repeats] = all().map(Line::off).fold([0.0; 2], |[a, b], [c, d]| [a + c, b + d]);
    let bounces = of_bounces < of_repeats;
    let names: String = match bounces {
        true => (1..=most).map(|n| format!("\tbounce {n}")).collect(),
        false => "\trebound height".to_owned(),
    };
    let first = lines.iter().position(Option::is_some)?;
    let spelt = |(n, line): (usize, &str)| match &lines[n] {
        Some(Line { release, heights }) => {
            let header = (n == first).then(|| format!("drop height{names}"));
            let rows = match bounces {
                true => vec![format!("{release}\t{}", heights.join("\t"))],
                false => heights.iter().map(|height| format!("{release}\t{height}")).collect(),
            };
            // A lone carriage return ends a row, and no line.
            header.into_iter().chain(rows).collect::<Vec<_>>().join("\r")
        }
        None if line.trim().is_empty() => String::new(),
        None => format!("#{line}"),
    };
    Some(text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

/// The heights of a line; the unit of the last number is that of those before it that have none,
/// and that of the release where it has none itself.
fn of_line(line: &str) -> Option<Line> {
    let (name, list) = line.trim().trim_start_matches(['-', '*', '•', ' ']).split_once(": ")?;
    let name = without_brackets(name);
    let [Part { words, number: release }] = *parts(&name).0.as_slice() else { return None };
    let (found, behind) = parts(list);
    let (first, others) = found.split_first()?;
    let joins = |part: &Part<'_>| part.joins(&[' ', ',', ';', '/']);
    let turned = |words: &str| Heading::parse(words).turns_readings();
    if turned(words) || turned(first.words) || !behind.trim_matches(['.', ' ']).is_empty() || !others.iter().all(joins)
    {
        return None;
    }
    let unit = |number: &str| {
        let bare = number.trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, '.' | ',')).trim();
        Unit::parse(bare).map(|_| bare.to_owned())
    };
    let of_all = unit(found.last()?.number).or_else(|| unit(release))?;
    let rebound = |part: &Part<'_>| {
        let spelt = unit(part.number).map_or_else(|| format!("{} {of_all}", part.number), |_| part.number.to_owned());
        (length(&spelt)? < length(release)?).then_some(spelt)
    };
    Some(Line { release: release.to_owned(), heights: found.iter().map(rebound).collect::<Option<_>>()? })
}
