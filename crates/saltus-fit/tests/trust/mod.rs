//! How often *trusted* is wrong, and how often what is sound is not trusted: planted experiments of
//! every kind with every known fault.
//!
//! `cargo test -p saltus-fit trust::` runs a few of each; with `RUNS=200` and `-- --nocapture`
//! it prints the table of docs/change/fitting-inside.md; `SEED=1000` begins at another number,
//! `KIND=Film` runs one kind.

mod ball;
mod plant;

use std::collections::BTreeMap;

use plant::{Fault, Kind, Planted, plant};
use rayon::iter::{IntoParallelIterator, ParallelIterator};
use saltus_fit::{Report, Table, Verdict};

/// What became of the experiments of one kind with one fault.
#[derive(Clone, Debug, Default)]
struct Tally {
    runs: u32,
    trusted: u32,
    refused: u32,
    /// Trusted, and the truth lies outside an interval twice as wide.
    wrong: u32,
    /// Trusted or doubtful, and the interval holds the truth; of how many that have one.
    held: u32,
    ranged: u32,
    /// The same of the trusted ones.
    held_trusted: u32,
    /// How long the intervals of the trusted ones are.
    lengths: Vec<f64>,
}

/// Whether an interval holds a COR of the impacts, and whether one twice as wide does.
fn holds(report: &Report, [least, most]: [f64; 2]) -> Option<(bool, bool)> {
    let cor = report.cor()?;
    let wide = (2.0 * cor.low - cor.value, 2.0 * cor.high - cor.value);
    // Readings to four digits: the truth and an end may agree to their rounding.
    let within = |low: f64, high: f64| low <= most && least <= high;
    Some((within(cor.low, cor.high), within(wide.0, wide.1)))
}

fn report(planted: &Planted) -> Option<Report> {
    let table = Table::parse("planted", planted.text.as_bytes(), &planted.options).ok()?;
    planted.fit.run(&table).ok()
}

impl Tally {
    fn add(mut self, planted: &Planted, shown: &str) -> Self {
        self.runs += 1;
        let Some(report) = report(planted) else {
            self.refused += 1;
            return self;
        };
        let trusted = report.verdict() == Verdict::Trusted;
        self.trusted += u32::from(trusted);
        self.refused += u32::from(report.verdict() == Verdict::Refused);
        if let Some((held, wide)) = holds(&report, planted.truth) {
            self.ranged += 1;
            self.held += u32::from(held);
            self.held_trusted += u32::from(held && trusted);
            self.lengths.extend(report.cor().filter(|_| trusted).map(|cor| cor.high - cor.low));
            if trusted && !wide {
                self.wrong += 1;
                if std::env::var_os("SHOW").is_some() {
                    println!("WRONG {shown}: truth {:?}\n{}\n{report}", planted.truth, planted.text);
                }
            }
        }
        if !trusted && std::env::var_os("SHOW_DOUBTS").is_some() {
            println!("DOUBT {shown}: truth {:?} {:?}: {}", planted.truth, report.verdict(), report.reason());
        }
        self
    }

    fn plus(mut self, other: Self) -> Self {
        self.lengths.extend(other.lengths);
        Self {
            runs: self.runs + other.runs,
            trusted: self.trusted + other.trusted,
            refused: self.refused + other.refused,
            wrong: self.wrong + other.wrong,
            held: self.held + other.held,
            ranged: self.ranged + other.ranged,
            held_trusted: self.held_trusted + other.held_trusted,
            lengths: self.lengths,
        }
    }

    /// The length that half of the intervals of trusted ones do not exceed.
    fn length(&mut self) -> f64 {
        self.lengths.sort_by(f64::total_cmp);
        self.lengths.get(self.lengths.len() / 2).copied().unwrap_or(f64::NAN)
    }
}

fn all(runs: u64) -> BTreeMap<(usize, usize), (Kind, Fault, Tally)> {
    let first: u64 = std::env::var("SEED").map_or(0, |n| n.parse().expect("SEED is a number"));
    let wanted = std::env::var("KIND").ok();
    let kinds = Kind::ALL.into_iter().filter(|k| wanted.as_ref().is_none_or(|w| format!("{k:?}") == *w));
    let cells: Vec<(Kind, Fault)> = kinds.flat_map(|k| k.faults().iter().map(move |f| (k, *f))).collect();
    let tallied = cells.into_par_iter().map(|(kind, fault)| {
        let one = |n: u64| Tally::default().add(&plant(kind, fault, n), &format!("{kind:?} {fault:?} {n}"));
        let tally = (first..first + runs).into_par_iter().map(one).reduce(Tally::default, Tally::plus);
        ((kind as usize, fault as usize), (kind, fault, tally))
    });
    tallied.collect()
}

fn part(of: u32, all: u32) -> f64 {
    100.0 * f64::from(of) / f64::from(all.max(1))
}

#[test]
fn what_is_trusted_is_right() {
    let runs: u64 = std::env::var("RUNS").map_or(6, |n| n.parse().expect("RUNS is a number"));
    println!(
        "| kind | fault | trusted % | trusted, outside twice its interval % | intervals that hold, trusted % | all % | their length | refused % |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let (mut sound, mut every) = (Tally::default(), Tally::default());
    for (kind, fault, mut t) in all(runs).into_values() {
        println!(
            "| {kind:?} | {fault:?} | {:.0} | {:.1} | {:.1} | {:.1} | {:.3} | {:.0} |",
            part(t.trusted, t.runs),
            part(t.wrong, t.trusted),
            part(t.held_trusted, t.trusted),
            part(t.held, t.ranged),
            t.length(),
            part(t.refused, t.runs)
        );
        every = every.plus(t.clone());
        if matches!(fault, Fault::Sound | Fault::Stated) {
            sound = sound.plus(t);
        }
    }
    println!(
        "all: {} runs, {} trusted, {} of them outside twice their interval; of {} sound ones {} trusted, {:.1} % hold",
        every.runs,
        every.trusted,
        every.wrong,
        sound.runs,
        sound.trusted,
        part(sound.held_trusted, sound.trusted)
    );
    assert!(10 * sound.trusted >= 9 * sound.runs, "{} of {} sound ones are trusted", sound.trusted, sound.runs);
    assert!(100 * every.wrong <= every.trusted, "{} of {} trusted ones are wrong", every.wrong, every.trusted);
    assert_eq!(sound.wrong, 0, "of sound ones");
}
