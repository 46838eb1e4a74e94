//! Several balls or surfaces in one table: the report of each, how far their CORs are apart, and
//! what holds of all.

use std::fmt::{self, Formatter};

use super::contract::{Difference, Group, Report};
use super::lines::{paragraph, section, sentence};
use super::numbers::{digits, pair};
use crate::elementary::hypot;
use crate::finding::{Finding, FindingKind};
use crate::read::Table;
use crate::verdict::Verdict;

impl Group {
    pub(crate) fn new(name: &str, report: Report) -> Self {
        let name = if name.is_empty() { "the others" } else { name };
        Self { name: name.to_owned(), report }
    }
}

impl Difference {
    /// The difference of two CORs; `None` if one of them is missing.
    ///
    /// The interval adds the distances from each value to the ends of its interval in squares (Zou
    /// and Donner 2008), and so keeps their lopsidedness and their few degrees of freedom.
    fn between(a: &Group, b: &Group) -> Option<Self> {
        let (mut one, mut other) = ((a, *a.report.cor()?), (b, *b.report.cor()?));
        if one.1.value < other.1.value {
            std::mem::swap(&mut one, &mut other);
        }
        let ((greater, x), (less, y)) = (one, other);
        let value = x.value - y.value;
        Some(Self {
            greater: greater.name.clone(),
            less: less.name.clone(),
            value,
            standard_error: x.standard_error.zip(y.standard_error).map(|(s, t)| hypot(s, t)),
            low: value - hypot(x.value - x.low, y.high - y.value),
            high: value + hypot(x.high - x.value, y.value - y.low),
        })
    }
}

/// Up to so many groups every one is compared with every other; more with the one that has the
/// least COR.
const PAIRWISE: usize = 6;

fn differences(groups: &[Group]) -> Vec<Difference> {
    if groups.len() <= PAIRWISE {
        let pairs = groups.iter().enumerate().flat_map(|(n, a)| groups[n + 1..].iter().map(move |b| (a, b)));
        return pairs.filter_map(|(a, b)| Difference::between(a, b)).collect();
    }
    let known = groups.iter().filter_map(|group| Some((group, group.report.cor()?.value)));
    let Some((least, _)) = known.min_by(|a, b| a.1.total_cmp(&b.1)) else { return Vec::new() };
    groups.iter().filter(|g| g.name != least.name).filter_map(|g| Difference::between(g, least)).collect()
}

impl Report {
    /// The report of several groups: `like` is that of one of them, whose gravity and rates hold
    /// for all.
    pub(crate) fn of_groups(table: &Table, groups: Vec<Group>, like: &Self) -> Self {
        let of = |verdict: Verdict| groups.iter().filter(|g| g.report.verdict() == verdict).count();
        let (count, trusted, refused) = (groups.len(), of(Verdict::Trusted), of(Verdict::Refused));
        let kind = FindingKind::Groups { groups: count, trusted, refused };
        let (verdict, finding) = match () {
            () if trusted == count => (Verdict::Trusted, Finding::note(kind)),
            () if refused == count => (Verdict::Refused, Finding::refusal(kind)),
            () => (Verdict::Doubtful, Finding::doubt(kind)),
        };
        let notes = table.notes.iter().map(|note| Finding::note(FindingKind::ReadNote { note: note.clone() }));
        let notes: Vec<Finding> = notes.collect();
        Self {
            verdict,
            reason: finding.to_string(),
            trials: table.trials().len(),
            notes: notes.iter().map(Finding::to_string).collect(),
            findings: std::iter::once(finding).chain(notes).collect(),
            differences: differences(&groups),
            groups,
            next: None,
            plan: None,
            files: table.files.clone(),
            left_aside: table.left_aside().to_vec(),
            ..Self::empty(table.name(), like.gravity())
        }
    }

    /// The groups of the table, where it has several: each has a COR of its own, and the report as
    /// a whole has none.
    #[must_use]
    pub fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// How far the CORs of groups are apart, pair by pair.
    #[must_use]
    pub fn differences(&self) -> &[Difference] {
        &self.differences
    }
}

/// Writes the part of the report that is of several groups.
pub(super) fn write(report: &Report, f: &mut Formatter<'_>) -> fmt::Result {
    let width = report.groups.iter().map(|g| g.name.chars().count()).max().unwrap_or(0).max(8);
    writeln!(f, "\n  {:width$}  COR", "")?;
    for group in &report.groups {
        let cor = match group.report.cor() {
            Some(cor) => {
                let digits = cor.standard_error.map_or(3, digits);
                format!("{cor}   (95 % interval {:.digits$} to {:.digits$})", cor.low, cor.high)
            }
            None => "-".to_owned(),
        };
        writeln!(f, "  {:width$}  {cor}   {}", group.name, group.report.verdict().to_string().to_uppercase())?;
    }
    if !report.differences.is_empty() {
        writeln!(f, "\nDifferences")?;
    }
    for difference in &report.differences {
        let spread = difference.standard_error.unwrap_or(difference.high - difference.low);
        let decimals = digits(spread);
        let value = match difference.standard_error {
            Some(error) => pair(difference.value, error),
            None => format!("{:.decimals$}", difference.value),
        };
        let apart = if difference.low > 0.0 { "they differ" } else { "they may be the same" };
        let (greater, less) = (&difference.greater, &difference.less);
        let range = format!("95 % interval {:.decimals$} to {:.decimals$}", difference.low, difference.high);
        writeln!(f, "  {greater} - {less}: {value}   ({range}): {apart}")?;
    }
    for group in &report.groups {
        writeln!(f, "\n{}", group.name)?;
        paragraph(f, 2, 2, &sentence(group.report.reason()))?;
        section(f, "  Left out or mended", group.report.repairs())?;
        section(f, "  Keep in mind", group.report.warnings())?;
    }
    let aside: Vec<String> = report.left_aside.iter().map(ToString::to_string).collect();
    section(f, "Left aside", &aside)
}
