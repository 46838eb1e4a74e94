//! `docs/trust/hard-cases.md`: written from the cases and their reports, and compared with them.

use std::fmt::Write as _;
use std::sync::{Mutex, PoisonError};

use saltus_tests::reference::{Case, Kind};

use crate::FAMILIES;
use crate::cases::Entry;
use crate::report::{Ours, Report, Tally};
use crate::survey::{SOURCES, SURVEY, Seen};

const PATH: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/trust/hard-cases.md");

/// The two tests below may both write.
static PAGE: Mutex<()> = Mutex::new(());

#[test]
fn page_and_run_agree() {
    agree(false);
}

#[test]
#[ignore = "runs the long cases: run it with --release -- --include-ignored"]
fn page_and_long_runs_agree() {
    agree(true);
}

/// Every case of the file is in the catalogue, once, in the file's order.
#[test]
fn nothing_is_left_out() {
    let here: Vec<_> =
        FAMILIES.iter().flat_map(|(family, cases)| cases.iter().map(move |entry| (*family, entry.id))).collect();
    let file: Vec<_> = Case::all().iter().map(|case| (case.family.as_str(), case.id.as_str())).collect();
    assert_eq!(here, file);
}

/// Every test that the survey names is there.
#[test]
fn the_survey_names_tests() {
    for Seen(_, _, file, name) in SURVEY.iter().flat_map(|section| section.1) {
        let source = SOURCES.iter().find(|source| source.0 == *file).unwrap().1;
        assert!(source.contains(&format!("fn {name}()")), "{file} has no test {name}");
    }
}

fn agree(long: bool) {
    let _alone = PAGE.lock().unwrap_or_else(PoisonError::into_inner);
    let kept = std::fs::read_to_string(PATH).unwrap_or_default();
    let page = page(&kept, long);
    if std::env::var_os("SALTUS_BLESS").is_some() {
        std::fs::write(PATH, page).unwrap();
        return;
    }
    let rows = page.lines().filter_map(Row::read).count();
    assert_eq!(rows, Case::all().len(), "{PATH} lacks the rows of long cases: run them once, with SALTUS_BLESS=1");
    let advice = "look at both; SALTUS_BLESS=1 rewrites the page";
    for (kept, new) in kept.lines().zip(page.lines()) {
        match (Row::read(kept), Row::read(new)) {
            (Some(kept), Some(new)) => kept.compare(&new),
            _ => assert_eq!(kept, new, "{PATH} is not what the run says: {advice}"),
        }
    }
    assert_eq!(kept.lines().count(), page.lines().count(), "{PATH}: {advice}");
}

/// The line of a case in its family's table.
#[derive(Clone, Debug)]
struct Row {
    id: String,
    worst: String,
    reference: String,
    ours: String,
    off: f64,
    /// Jumps, steps, flows and guards.
    cost: String,
    tally: Tally,
}

impl Row {
    fn of(report: &Report) -> Self {
        let worst = report.worst();
        let stats = &report.stats;
        Self {
            id: report.case.id.clone(),
            worst: worst.observable.name.clone(),
            reference: short(&worst.observable.value),
            ours: shown(&worst.ours),
            off: worst.off,
            cost: format!("{} | {} | {} + {}", stats.jumps, stats.steps, stats.flows, stats.guards),
            tally: report.tally(),
        }
    }

    fn write(&self) -> String {
        let Self { id, worst, reference, ours, off, cost, tally } = self;
        let off = match *off {
            off if off == 0.0 || !off.is_finite() => off.to_string(),
            off if off < 0.01 => format!("{off:.0e}"),
            off if off < 10.0 => format!("{off:.2}"),
            off => format!("{off:.0}"),
        };
        format!("| `{id}` | `{worst}` | {reference} | {ours} | {off} | {cost} | {tally} |")
    }

    /// The row that this line is, if it is one.
    fn read(line: &str) -> Option<Self> {
        let cells: Vec<_> = line.strip_prefix("| `")?.strip_suffix(" |")?.split(" | ").collect();
        let [id, worst, reference, ours, off, jumps, steps, evaluations, tally] = cells[..] else { return None };
        let count = |word: &str| {
            let after = tally.split(word).nth(1)?;
            after.chars().take_while(char::is_ascii_digit).collect::<String>().parse().ok()
        };
        let id = id.trim_end_matches('`').to_owned();
        let unasked = Case::named(&id).observables.len();
        let (met, marked) = (count("met ")?, count("marked ").unwrap_or(0));
        Some(Self {
            id,
            worst: worst.trim_matches('`').to_owned(),
            reference: reference.to_owned(),
            ours: ours.to_owned(),
            off: off.parse().ok()?,
            cost: format!("{jumps} | {steps} | {evaluations}"),
            tally: Tally { met, marked, unasked: unasked - met - marked },
        })
    }

    /// Another machine's libm may round otherwise, make another observable the worst, and a search
    /// take another turn: what must agree is the verdict, that each reference is the file's, and
    /// the cost to a tenth.
    fn compare(&self, new: &Self) {
        let id = &self.id;
        assert_eq!(self.id, new.id);
        let near = |(a, b): (f64, f64)| (a - b).abs() <= 0.1 * a + 20.0;
        let same = counts(&self.cost).zip(counts(&new.cost)).all(near);
        assert!(same, "{id}: jumps, steps, flows + guards: {} and {}", self.cost, new.cost);
        assert_eq!(self.tally, new.tally, "{id}");
        assert_eq!(self.reference, short(&Case::named(id).observable(&self.worst).value), "{id}: {}", self.worst);
        assert_eq!(self.off <= 1.0, new.off <= 1.0, "{id}: {} against {}", self.off, new.off);
    }
}

/// The numbers in a text.
fn counts(text: &str) -> impl Iterator<Item = f64> {
    text.split(|c: char| !c.is_ascii_digit()).filter_map(|number| number.parse().ok())
}

/// The whole page. The rows of long cases that are not run are those it has.
fn page(kept: &str, long: bool) -> String {
    let mut out = String::new();
    let row = |entry: &Entry| {
        if long || !entry.long {
            return Some(Row::of((entry.report)()));
        }
        kept.lines().filter_map(Row::read).find(|row| row.id == entry.id)
    };
    let rows: Vec<Vec<_>> = FAMILIES.iter().map(|(_, cases)| cases.iter().map(row).collect()).collect();
    let known: Vec<_> = rows.iter().flatten().flatten().collect();
    let sum = |count: fn(&Tally) -> usize| known.iter().map(|row| count(&row.tally)).sum::<usize>();
    let marked = known.iter().filter(|row| row.tally.marked > 0).count();
    let _ = write!(
        out,
        include_str!("intro.md"),
        cases = rows.iter().flatten().count(),
        families = FAMILIES.len(),
        observables = Case::all().iter().map(|case| case.observables.len()).sum::<usize>(),
        met = sum(|tally| tally.met),
        marked = sum(|tally| tally.marked),
        marked_cases = marked,
        unasked = sum(|tally| tally.unasked),
    );
    for ((family, cases), rows) in FAMILIES.iter().zip(&rows) {
        section(&mut out, family, cases, rows, long);
    }
    survey(&mut out);
    out.push_str(include_str!("limits.md"));
    out
}

fn section(out: &mut String, family: &str, cases: &[Entry], rows: &[Option<Row>], long: bool) {
    let (title, about) = heading(family);
    let _ = write!(
        out,
        "\n## {title}\n\n{about}\n\n| case | worst | reference | ours | error | jumps | steps | flows + guards | verdict |\n\
         |---|---|---|---|---|---|---|---|---|\n"
    );
    for row in rows.iter().flatten() {
        let _ = writeln!(out, "{}", row.write());
    }
    out.push('\n');
    for (place, entry) in cases.iter().enumerate() {
        let earlier: Vec<_> = cases[..place].iter().map(|entry| Case::named(entry.id)).collect();
        let ran = (long || !entry.long).then(|| (entry.report)());
        describe(out, Case::named(entry.id), &earlier, entry.long, ran);
    }
}

/// What a case is and what goes wrong with it elsewhere; what an earlier case has said is not said
/// again.
fn describe(out: &mut String, case: &Case, earlier: &[&Case], long: bool, ran: Option<&Report>) {
    let _ = write!(out, "- **`{}`** {}.", case.id, text(&case.title));
    let same = earlier.iter().find(|other| case.system.starts_with(&other.system));
    let system = match same {
        Some(other) if case.system == other.system => format!("as `{}`", other.id),
        Some(other) => {
            let rest = case.system[other.system.len()..].trim_start_matches([' ', '-', ';', ',']);
            format!("as `{}`, {}", other.id, text(rest))
        }
        None => text(&case.system),
    };
    let params: Vec<_> = case.params().map(|(name, value)| format!("{name} = {value}")).collect();
    let params = if params.is_empty() { String::new() } else { format!(" ({})", params.join(", ")) };
    let end = case.t_end.as_ref().map_or(String::new(), |end| format!(", until t = {end}"));
    let _ = write!(out, " *System:* {system}{params}{end}.");
    let elsewhere = brief(&case.naive_failures);
    if earlier.iter().all(|other| brief(&other.naive_failures) != elsewhere) {
        let _ = write!(out, " *Elsewhere:* {}.", text(elsewhere));
    }
    if long {
        out.push_str(" *Long:* its test is run only if asked for.");
    }
    let facts = case.observables.iter().filter(|observable| observable.kind == Kind::Info);
    let facts: Vec<_> = facts.map(|fact| format!("`{}` = {}", fact.name, short(&fact.value))).collect();
    if !facts.is_empty() {
        let _ = write!(out, " *For orientation:* {}.", facts.join(", "));
    }
    // Which of a long case's observables are marked or left out is said in its row only, unless it
    // is run.
    if let Some(report) = ran.filter(|_| !long) {
        remarks(out, report);
    }
    out.push('\n');
}

/// The first clauses of a text: as many as fit on a line or two, at least one.
fn brief(text: &str) -> &str {
    let ends = text.match_indices("; ").map(|(end, _)| end).chain([text.len()]);
    ends.clone().filter(|&end| end <= 200).last().or(ends.min()).map_or(text, |end| &text[..end])
}

fn remarks(out: &mut String, report: &Report) {
    let mut reasons: Vec<&str> = report.marks.iter().map(|mark| mark.reason).collect();
    reasons.dedup();
    for reason in reasons {
        let names = report.marks.iter().filter(|mark| mark.reason == reason).map(|mark| mark.name);
        let _ = write!(out, " **Marked** {}: {reason}.", list(names));
    }
    let mut reasons: Vec<&str> = report.absent.iter().map(|absent| absent.1).collect();
    reasons.dedup();
    for why in reasons {
        let names = report.absent.iter().filter(|absent| absent.1 == why).map(|absent| absent.0.name.as_str());
        let _ = write!(out, " *Not observed* {}: {why}.", list(names));
    }
}

fn survey(out: &mut String) {
    out.push_str(include_str!("survey.md"));
    for (title, cases) in &SURVEY {
        let _ = write!(out, "\n### {title}\n\n| case | right answer | test |\n|---|---|---|\n");
        for Seen(case, answer, file, name) in *cases {
            let _ = writeln!(out, "| {case} | {answer} | [`{name}`](../../tests/tests/{file}) |");
        }
    }
}

/// The title of a family's section, and what it is about.
fn heading(family: &str) -> (&'static str, &'static str) {
    match family {
        "zeno" => (
            "Impacts that accumulate",
            "Infinitely many impacts before a limit, the rest beyond it, and what only looks like it.",
        ),
        "drag" => ("Drag", "By the closed forms of the flights, and by steps where the table counts some."),
        "root" => ("Crossings", "Hard to find, hard to tell apart, or not there."),
        "simultaneous" => (
            "Several at once",
            "Corners, cradles, cascades, collapse, and the billiard whose collisions count the digits of π.\n\n![The collisions of two blocks and a wall](../program/gallery/pi.svg)",
        ),
        "table" => (
            "A table that shakes",
            "![A ball on a vibrating table: its periodic bounces](../program/gallery/table.svg)",
        ),
        "filippov" => {
            ("Sliding and switching", "![A relay driven by a sine: slides and exits](../program/gallery/relay.svg)")
        }
        "contact" => {
            ("Contact that takes time", "Force laws, from soft to 10¹² N/m, by steps and by their closed forms.")
        }
        "locomotion" => {
            ("Walking, hopping, juggling", "![The gaits of the simplest walker](../program/gallery/walker.svg)")
        }
        "sensitivity" => (
            "Derivatives through jumps",
            "No differences are taken; see [sensitivities.md](../program/sensitivities.md).",
        ),
        "chaos" => ("Chaos", "What doubles can follow, and for how long."),
        "classics" => ("Classics", "Orbits, special functions, limits, stiff oscillators, chemistry."),
        "timescale" => ("Time scales", "Very short after very long, and late."),
        _ => ("Forcing", "Edges that the clock takes."),
    }
}

fn list<'a>(names: impl Iterator<Item = &'a str>) -> String {
    names.map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

fn shown(ours: &Ours) -> String {
    match ours {
        Ours::Number(number) => short(&number.to_string()),
        Ours::Outcome(text) => text.clone(),
    }
}

/// A number to nine digits, as it is if it has fewer; anything else as it is.
fn short(number: &str) -> String {
    let Ok(x) = number.parse::<f64>() else { return number.to_owned() };
    let rounded: f64 = format!("{x:.8e}").parse().unwrap_or(x);
    if rounded == 0.0 {
        "0".into()
    } else if (1e-4..1e9).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        format!("{rounded:e}")
    }
}

/// Prose that no mark of the page's language is in.
fn text(prose: &str) -> String {
    prose.chars().fold(String::new(), |mut out, c| {
        if "*_<|~[]`\\".contains(c) {
            out.push('\\');
        }
        out.push(c);
        out
    })
}
