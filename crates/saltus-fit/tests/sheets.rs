//! Sheets made at random, as people dress them: what is read is what was planted, or a question;
//! never something else.
//!
//! `SHEETS=100000 cargo test -p saltus-fit sheets::` is the long run.

use crate::random::Random;
use crate::written::xlsx;
use saltus_fit::{Event, ReadOptions, Table, TableError};

impl Random {
    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// True once in so many times.
    fn once(&mut self, times: usize) -> bool {
        self.below(times) == 0
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.below(1_000_000) as f64 / 1e6
    }
}

type Rows = Vec<Vec<String>>;

/// What was measured: heights of trials, the release first, as they are written, and the unit.
struct Plant {
    trials: Vec<Vec<f64>>,
    unit: &'static str,
    /// How many of it are a metre.
    per: f64,
}

impl Plant {
    fn new(random: &mut Random) -> Self {
        let (unit, per) = random.one(&[("cm", 100.0), ("m", 1.0), ("mm", 1000.0), ("in", 1.0 / 0.0254)]);
        let (count, bounces) = (1 + random.below(4), 2 + random.below(4));
        let drop = random.between(0.6, 2.5);
        let trial = |random: &mut Random| {
            let e = random.between(0.55, 0.88);
            let written = |h: f64| (h * per * 1000.0 / per.max(1.0) * 10.0).round() / (1000.0 / per.max(1.0) * 10.0);
            (0..=bounces as i32)
                .map(|n| written(drop * e.powi(2 * n) * if n == 0 { 1.0 } else { random.between(0.99, 1.01) }))
                .collect()
        };
        Self { trials: (0..count).map(|_| trial(random)).collect(), unit, per }
    }

    /// What has to be read: per trial the number of the bounce and the height in metres.
    fn expected(&self, pairs: bool) -> Vec<Vec<(usize, f64)>> {
        let of = |trial: &Vec<f64>| -> Vec<(usize, f64)> {
            trial.iter().enumerate().map(|(n, h)| (n, h / self.per)).collect()
        };
        self.trials
            .iter()
            .map(|trial| of(trial).into_iter().take(if pairs { 2 } else { usize::MAX }).collect())
            .collect()
    }
}

/// How the cells are written.
struct Hand {
    /// The unit stands behind every number, and not in the heading.
    in_cells: bool,
    error: bool,
    comma: bool,
}

impl Hand {
    fn cell(&self, random: &mut Random, plant: &Plant, value: f64) -> String {
        let mut text = format!("{value}");
        if self.comma {
            text = text.replace('.', ",");
        }
        if self.error {
            text += random.one(&[" ± 1", " +/- 1", "±1"]);
        }
        if self.in_cells {
            text += random.one(&[" ", ""]);
            text += plant.unit;
        }
        text
    }

    fn name(&self, random: &mut Random, plant: &Plant, name: &str) -> String {
        if self.in_cells {
            return name.to_owned();
        }
        match random.below(3) {
            0 => format!("{name} ({})", plant.unit),
            1 => format!("{name} [{}]", plant.unit),
            _ => format!("{name} / {}", plant.unit),
        }
    }
}

/// The layouts: which is which the test does not say.
fn layout(random: &mut Random, plant: &Plant, hand: &Hand) -> (Rows, bool) {
    let count = plant.trials[0].len();
    let mut rows: Rows = Vec::new();
    let kind = random.below(5);
    let words = |list: &[&str]| list.iter().map(|&w| w.to_owned()).collect::<Vec<String>>();
    match kind {
        // Numbered rows, of numbered trials.
        0 => {
            let number = random.one(&["Bounce", "bounce no.", "Bounce number", "Rebond", "Aufprall"]);
            let height = random.one(&["Height", "height", "Rebound height", "Höhe", "Hauteur", "h"]);
            let mut head = words(&[number]);
            head.push(hand.name(random, plant, height));
            if plant.trials.len() > 1 {
                head.insert(0, random.one(&["Trial", "Run", "Versuch", "essai"]).to_owned());
            }
            rows.push(head);
            for (t, trial) in plant.trials.iter().enumerate() {
                for (n, &h) in trial.iter().enumerate() {
                    let mut row = vec![n.to_string(), hand.cell(random, plant, h)];
                    if plant.trials.len() > 1 {
                        row.insert(0, (t + 1).to_string());
                    }
                    rows.push(row);
                }
            }
        }
        // Trials side by side.
        1 => {
            let name = random.one(&["Trial", "Run", "Versuch", "Drop no."]);
            let mut head = words(&[random.one(&["Bounce", "bounce", "Rimbalzo"])]);
            head.extend(
                (1..=plant.trials.len())
                    .map(|t| format!("{name} {t}"))
                    .collect::<Vec<_>>()
                    .iter()
                    .map(|n| hand.name(random, plant, n)),
            );
            rows.push(head);
            for n in 0..count {
                let mut row = vec![n.to_string()];
                for trial in &plant.trials {
                    row.push(hand.cell(random, plant, trial[n]));
                }
                rows.push(row);
            }
        }
        // Bounces side by side.
        2 => {
            let mut head = words(&["Trial"]);
            let style = random.below(3);
            for n in 0..count {
                let name = match (style, n) {
                    (0, n) => format!("h{n}"),
                    (1, 0) => "Drop height".to_owned(),
                    (1, n) => format!("Bounce {n}"),
                    (_, 0) => "Start height".to_owned(),
                    (_, n) => format!("Height after bounce {n}"),
                };
                head.push(hand.name(random, plant, &name));
            }
            rows.push(head);
            for (t, trial) in plant.trials.iter().enumerate() {
                let mut row = vec![(t + 1).to_string()];
                for &h in trial {
                    row.push(hand.cell(random, plant, h));
                }
                rows.push(row);
            }
        }
        // Drops and their rebounds.
        3 => {
            let (drop, rebound) = random.one(&[
                ("Drop height", "Rebound height"),
                ("Initial height", "Height after bounce"),
                ("Fallhöhe", "Rücksprunghöhe"),
                ("drop", "rebound"),
            ]);
            rows.push(vec![hand.name(random, plant, drop), hand.name(random, plant, rebound)]);
            for trial in &plant.trials {
                rows.push(vec![hand.cell(random, plant, trial[0]), hand.cell(random, plant, trial[1])]);
            }
        }
        // Events.
        _ => {
            rows.push(vec!["Event".to_owned(), hand.name(random, plant, "Height")]);
            if plant.trials.len() > 1 {
                rows[0].insert(0, "Trial".to_owned());
            }
            for (t, trial) in plant.trials.iter().enumerate() {
                for (n, &h) in trial.iter().enumerate() {
                    let what = if n == 0 { random.one(&["release", "drop"]) } else { random.one(&["apex", "peak"]) };
                    let mut row = vec![what.to_owned(), hand.cell(random, plant, h)];
                    if plant.trials.len() > 1 {
                        row.insert(0, (t + 1).to_string());
                    }
                    rows.push(row);
                }
            }
        }
    }
    (rows, kind == 3)
}

/// Columns that are no readings, put behind the others or between them.
fn decoys(random: &mut Random, plant: &Plant, rows: &mut Rows) {
    let decoy = |random: &mut Random, rows: &mut Rows, name: String, cell: &mut dyn FnMut(&mut Random) -> String| {
        let at = if random.once(2) { rows[0].len() } else { 1 + random.below(rows[0].len()) };
        for (n, row) in rows.iter_mut().enumerate() {
            let text = if n == 0 { name.clone() } else { cell(random) };
            row.insert(at.min(row.len()), text);
        }
    };
    let unit = plant.unit;
    let number = |random: &mut Random| format!("{}", random.below(900) + 10);
    for _ in 0..random.below(3) {
        let name = match random.below(9) {
            0 => format!("Predicted height ({unit})"),
            1 => format!("theoretical ({unit})"),
            2 => format!("Height lost ({unit})"),
            3 => format!("Target ({unit})"),
            4 => "COR".to_owned(),
            5 => "x (m)".to_owned(),
            6 => "Mass (g)".to_owned(),
            7 => format!("wibble ({unit})"),
            _ => "ratio".to_owned(),
        };
        decoy(random, rows, name, &mut |random| number(random));
    }
    if random.once(4) {
        decoy(random, rows, "Comment".to_owned(), &mut |random| {
            random.one(&["", "good", "hard to see", "ok?"]).to_owned()
        });
    }
    if random.once(6) {
        decoy(random, rows, String::new(), &mut |_| String::new());
    }
}

/// Lines above the table and below it, and rows that sum up.
fn dressed(random: &mut Random, plant: &Plant, rows: &mut Rows) {
    let width = rows[0].len();
    let wide = |mut row: Vec<String>| {
        row.resize(width, String::new());
        row
    };
    if random.once(3) {
        let title = random.one(&["Lab 3: bouncing ball", "Tennis ball on concrete", "Name: Ana", "Messung vom Montag"]);
        rows.insert(0, wide(vec![title.to_owned()]));
    }
    if random.once(3) {
        let name = random.one(&["Average", "Mean", "SD", "Std. dev.", "Mittelwert"]);
        let mean = plant.trials[0].iter().sum::<f64>() / plant.trials[0].len() as f64;
        let row = std::iter::once(name.to_owned()).chain((1..width).map(|_| format!("{mean:.1}"))).collect();
        rows.push(row);
    }
    if random.once(4) {
        rows.push(wide(vec![
            random.one(&["COR", "The ball keeps most of its energy", "Mean ratio"]).to_owned(),
            "0.81".to_owned(),
        ]));
    }
}

/// The bytes of the rows, in some kind of file.
fn written(random: &mut Random, rows: &Rows, comma: bool) -> Vec<u8> {
    let across = random.once(6);
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    let cell = |r: usize, c: usize| rows.get(r).and_then(|row| row.get(c)).cloned().unwrap_or_default();
    let rows: Rows =
        if across { (0..width).map(|c| (0..rows.len()).map(|r| cell(r, c)).collect()).collect() } else { rows.clone() };
    match random.below(6) {
        0 if !comma => xlsx(&[("Sheet1", rows)]),
        1 => {
            let line = |row: &Vec<String>| format!("| {} |\n", row.join(" | "));
            let rule = format!("|{}\n", ":---:|".repeat(rows[0].len()));
            let text = rows.iter().enumerate().map(|(n, row)| if n == 0 { line(row) + &rule } else { line(row) });
            text.collect::<String>().into_bytes()
        }
        2 => {
            let line = |row: &Vec<String>| format!("<tr><td>{}</td></tr>\n", row.join("</td><td>"));
            let text: String = rows.iter().map(line).collect();
            format!("<html><body><table border=1>{}</table></body></html>", text.replace('±', "&plusmn;")).into_bytes()
        }
        kind => {
            let mark = if comma { random.one(&[";", "\t"]) } else { random.one(&[",", ";", "\t"]) };
            let end = random.one(&["\n", "\r\n"]);
            let quoted = |c: &String| if c.contains(mark) { format!("\"{c}\"") } else { c.clone() };
            let line = |row: &Vec<String>| row.iter().map(quoted).collect::<Vec<_>>().join(mark) + end;
            let text: String = rows.iter().map(line).collect();
            let text = if kind == 3 { format!("# a remark\n{text}") } else { text };
            if kind == 4 { [b"\xEF\xBB\xBF", text.as_bytes()].concat() } else { text.into_bytes() }
        }
    }
}

fn found(table: &Table) -> Vec<Vec<(usize, f64)>> {
    let of = |trial: &saltus_fit::Trial| -> Vec<(usize, f64)> {
        let heights = trial.readings().iter().filter(|r| r.event != Event::Sample);
        heights.map(|r| (r.bounce, r.height.unwrap_or(f64::NAN))).collect()
    };
    table.trials().iter().map(of).collect()
}

fn same(found: &[Vec<(usize, f64)>], planted: &[Vec<(usize, f64)>]) -> bool {
    let near = |(a, b): (&(usize, f64), &(usize, f64))| a.0 == b.0 && (a.1 - b.1).abs() <= 1e-9;
    let alike = |a: &Vec<(usize, f64)>, b: &Vec<(usize, f64)>| a.len() == b.len() && a.iter().zip(b).all(near);
    found.len() == planted.len() && found.iter().zip(planted).all(|(a, b)| alike(a, b))
}

/// A workbook is no text.
fn shown(text: &str) -> &str {
    if text.starts_with("PK") { "a workbook" } else { text }
}

#[test]
fn what_is_read_is_what_was_planted() {
    let rounds = std::env::var("SHEETS").ok().and_then(|n| n.parse().ok()).unwrap_or(3000);
    let (mut read, mut asked) = (0, Vec::<(String, TableError)>::new());
    for seed in 0..rounds {
        let mut random = Random(seed);
        let plant = Plant::new(&mut random);
        let hand = Hand { in_cells: random.once(4), error: random.once(6), comma: random.once(4) };
        let (mut rows, pairs) = layout(&mut random, &plant, &hand);
        decoys(&mut random, &plant, &mut rows);
        dressed(&mut random, &plant, &mut rows);
        let bytes = written(&mut random, &rows, hand.comma);
        let text = String::from_utf8_lossy(&bytes).into_owned();
        match Table::parse("sheet", &bytes, &ReadOptions::default()) {
            Ok(table) => {
                let (found, planted) = (found(&table), plant.expected(pairs));
                assert!(
                    same(&found, &planted),
                    "seed {seed}\n{}\n{rows:?}\n{found:?}\n{planted:?}\n{:?}",
                    shown(&text),
                    table.notes()
                );
                read += 1;
            }
            Err(error) => asked.push((text, error)),
        }
    }
    for (text, error) in asked.iter().take(if std::env::var("SHOWN").is_ok() { 40 } else { 0 }) {
        eprintln!("{error}\n{}\n", shown(text));
    }
    eprintln!("{read} read, {} asked", asked.len());
    assert!(read as f64 >= 0.9 * rounds as f64, "{read} of {rounds} are read");
}
