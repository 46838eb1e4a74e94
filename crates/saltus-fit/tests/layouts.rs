//! The same readings, whatever the layout, the unit, the delimiter, the decimal mark, the encoding
//! and the order of rows.

use crate::written::{xlsx, zip};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Event, ReadOptions, Table};

/// Event, number, time, height of every reading, trial by trial.
type Observed = Vec<Vec<(Event, usize, Option<f64>, Option<f64>)>>;

fn observed(table: &Table) -> Observed {
    let of =
        |trial: &saltus_fit::Trial| trial.readings().iter().map(|r| (r.event, r.bounce, r.time, r.height)).collect();
    table.trials().iter().map(of).collect()
}

fn same(a: &Observed, b: &Observed) -> bool {
    let near = |x: Option<f64>, y: Option<f64>| match (x, y) {
        (Some(x), Some(y)) => (x - y).abs() <= 1e-9 * x.abs().max(1.0),
        (x, y) => x == y,
    };
    a.len() == b.len()
        && a.iter().zip(b).all(|(a, b)| {
            a.len() == b.len()
                && a.iter().zip(b).all(|(x, y)| (x.0, x.1) == (y.0, y.1) && near(x.2, y.2) && near(x.3, y.3))
        })
}

/// How a table is written down.
#[derive(Clone, Debug)]
struct Hand {
    delimiter: char,
    comma: bool,
    crlf: bool,
    encoding: usize,
    container: usize,
    /// The unit of heights or times, and how many of it are one in SI.
    unit: usize,
}

const LENGTHS: [(&str, f64); 4] = [("m", 1.0), ("cm", 1e2), ("mm", 1e3), ("in", 1.0 / 0.0254)];
const TIMES: [(&str, f64); 3] = [("s", 1.0), ("ms", 1e3), ("min", 1.0 / 60.0)];

fn hands() -> impl Strategy<Value = Hand> {
    (0usize..3, any::<bool>(), any::<bool>(), 0usize..4, 0usize..4, 0usize..12).prop_map(
        |(delimiter, comma, crlf, encoding, container, unit)| {
            let delimiter = [',', ';', '\t'][delimiter];
            Hand { delimiter, comma: comma && delimiter != ',', crlf, encoding, container, unit }
        },
    )
}

impl Hand {
    fn length(&self) -> (&'static str, f64) {
        LENGTHS[self.unit % 4]
    }

    fn time(&self) -> (&'static str, f64) {
        TIMES[self.unit % 3]
    }

    fn number(&self, value: f64) -> String {
        let text = format!("{value}");
        if self.comma && self.container < 2 { text.replace('.', ",") } else { text }
    }

    /// The bytes of a table of cells.
    fn write(&self, rows: &[Vec<String>]) -> Vec<u8> {
        let end = if self.crlf { "\r\n" } else { "\n" };
        let text: String = rows.iter().map(|row| row.join(&self.delimiter.to_string()) + end).collect();
        match (self.container, self.encoding) {
            (2, _) => xlsx(&[("table", rows.to_vec())]),
            (3, _) => zip(&[("table.csv", &text)]),
            (_, 0) => [b"\xEF\xBB\xBF", text.as_bytes()].concat(),
            (_, 1) => text.encode_utf16().flat_map(u16::to_le_bytes).collect(),
            (_, 2) => format!("\u{feff}{text}").encode_utf16().flat_map(u16::to_be_bytes).collect(),
            _ => text.into_bytes(),
        }
    }
}

fn read(bytes: &[u8], options: &ReadOptions) -> Observed {
    observed(&Table::parse("table", bytes, options).unwrap_or_else(|error| panic!("{error}")))
}

fn words(line: &[&str]) -> Vec<String> {
    line.iter().map(|&word| word.to_owned()).collect()
}

/// A shuffle that a test can repeat.
fn shuffle<T>(rows: &mut [T], seed: u64) {
    let mut state = seed;
    for n in (1..rows.len()).rev() {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        rows.swap(n, (state >> 33) as usize % (n + 1));
    }
}

/// Words of titles: of them many are names of columns elsewhere.
const TITLE: [&str; 16] = [
    "Hi",
    "heights",
    "rebound",
    "the times",
    "my golf ball",
    "bounce",
    "on tile",
    "dropped",
    "trial",
    "measured",
    "from",
    "here are",
    "values",
    "and",
    "results",
    "first drop",
];

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(300), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn heights_of_trials(
        heights in proptest::collection::vec(proptest::collection::vec(0.01..3.0f64, 4), 1..5),
        hand in hands(), layout in 0usize..4, seed in any::<u64>(),
    ) {
        let expected: Observed = heights.iter().map(|trial| trial.iter().enumerate().map(|(n, &h)| {
            (if n == 0 { Event::Release } else { Event::Apex }, n, None, Some(h))
        }).collect()).collect();
        let (unit, per) = hand.length();
        let cell = |h: f64| hand.number(h * per);
        let name = format!("height ({unit})");
        let mut rows: Vec<Vec<String>> = Vec::new();
        let header = match layout {
            // Numbered rows of numbered trials, in any order within a trial.
            0 => {
                for (t, trial) in heights.iter().enumerate() {
                    let mut mine: Vec<Vec<String>> =
                        trial.iter().enumerate().map(|(n, &h)| vec![t.to_string(), n.to_string(), cell(h)]).collect();
                    shuffle(&mut mine, seed);
                    rows.extend(mine);
                }
                words(&["trial", "bounce", &name])
            }
            // Trials side by side.
            1 => {
                for n in 0..4 {
                    rows.push(std::iter::once(n.to_string()).chain(heights.iter().map(|t| cell(t[n]))).collect());
                }
                shuffle(&mut rows, seed);
                std::iter::once("bounce".to_owned())
                    .chain((1..=heights.len()).map(|t| format!("trial {t} ({unit})")))
                    .collect()
            }
            // Bounces side by side.
            2 => {
                for (t, trial) in heights.iter().enumerate() {
                    rows.push(std::iter::once(t.to_string()).chain(trial.iter().map(|&h| cell(h))).collect());
                }
                std::iter::once("trial".to_owned()).chain((0..4).map(|n| format!("h{n} ({unit})"))).collect()
            }
            // Events.
            _ => {
                for (t, trial) in heights.iter().enumerate() {
                    for (n, &h) in trial.iter().enumerate() {
                        rows.push(vec![t.to_string(), if n == 0 { "release" } else { "apex" }.to_owned(), cell(h)]);
                    }
                }
                words(&["trial", "event", &name])
            }
        };
        rows.insert(0, header);
        let found = read(&hand.write(&rows), &ReadOptions::default());
        prop_assert!(same(&found, &expected), "{rows:?}\n{found:?}\n{expected:?}");
    }

    /// A line of words above the names of the columns is a title, however many of its words are
    /// names of columns, and wherever its commas stand.
    #[test]
    fn titles_name_no_columns(
        said in proptest::collection::vec(0..TITLE.len(), 1..9), commas in any::<u16>(), blank in any::<bool>(), notes in any::<bool>(),
    ) {
        let title = said.iter().enumerate().fold(String::new(), |title, (n, &word)| {
            let mark = match n {
                0 => "",
                _ if commas >> n & 1 == 1 => ", ",
                _ => " ",
            };
            title + mark + TITLE[word]
        });
        let gap = if blank { "\n" } else { "" };
        let (name, cells) = if notes { (",notes", ",\n") } else { ("", "\n") };
        let table = format!("bounce,height (cm){name}\n0,100{cells}1,64{cells}2,41{cells}3,26{cells}");
        let titled = read(format!("{title}\n{gap}{table}").as_bytes(), &ReadOptions::default());
        let plain = read(table.as_bytes(), &ReadOptions::default());
        prop_assert!(same(&titled, &plain), "{title}: {titled:?}");
    }

    #[test]
    fn contacts_of_a_trial(gaps in proptest::collection::vec(0.05..1.0f64, 2..8), hand in hands(), layout in 0usize..5, seed in any::<u64>()) {
        let times: Vec<f64> = gaps.iter().scan(0.0, |t, gap| { *t += gap; Some(*t) }).collect();
        let expected: Observed =
            vec![times.iter().enumerate().map(|(n, &t)| (Event::Contact, n + 1, Some(t), None)).collect()];
        let (unit, per) = hand.time();
        let cell = |t: f64| hand.number(t * per);
        let name = format!("time ({unit})");
        let mut rows: Vec<Vec<String>> = times.iter().enumerate().map(|(n, &t)| match layout {
            0 => vec![cell(t)],
            1 => vec![n.to_string(), cell(t)],
            2 => vec![(n + 1).to_string(), cell(t)],
            _ => vec!["contact".to_owned(), cell(t)],
        }).collect();
        // Times in a list are those of contacts if they rise, and of flights if they fall.
        if matches!(layout, 1 | 2) {
            shuffle(&mut rows, seed);
        }
        let header = match layout {
            0 => words(&[&name]),
            1 | 2 => words(&["bounce", &name]),
            3 => words(&["event", &name]),
            _ => {
                rows = vec![times.iter().map(|&t| cell(t)).collect()];
                (1..=times.len()).map(|n| format!("t{n} ({unit})")).collect()
            }
        };
        rows.insert(0, header);
        let found = read(&hand.write(&rows), &ReadOptions::default());
        prop_assert!(same(&found, &expected), "{rows:?}\n{found:?}\n{expected:?}");
    }

    #[test]
    fn a_series(
        heights in proptest::collection::vec(0.5..3.0f64, 8..40), hand in hands(), program in 0usize..6, seed in any::<u64>(),
    ) {
        const FPS: f64 = 50.0;
        let lowest = heights.iter().copied().fold(f64::INFINITY, f64::min);
        let in_pixels = matches!(program, 2 | 3);
        // Pictures do not say where the floor is: their heights count from the lowest.
        let zero = if in_pixels { lowest } else { 0.0 };
        let expected: Observed = vec![heights.iter().enumerate().map(|(n, &h)| {
            (Event::Sample, n, Some(n as f64 / FPS), Some(h - zero))
        }).collect()];
        let (unit, per) = hand.length();
        let (clock, tick) = hand.time();
        let time = |n: usize| n as f64 / FPS;
        // 100 pixels to the metre, counted from the top of the picture.
        let pixel = |h: f64| hand.number(400.0 - 100.0 * h);
        let mut rows: Vec<Vec<String>> = heights.iter().enumerate().map(|(n, &h)| match program {
            0 => vec![hand.number(time(n) * tick), hand.number(h * per)],
            1 => vec![hand.number(time(n)), "0".to_owned(), hand.number(h)],
            2 => vec![n.to_string(), "3".to_owned(), pixel(h), String::new()],
            3 => vec![["7", "5", "6"][n % 3].to_owned(), pixel(h)],
            4 => vec![hand.number(time(n) * tick), hand.number(h * per)],
            _ => vec![n.to_string(), hand.number(h * per)],
        }).collect();
        // Of bare pixels nothing but their order tells the time.
        if program != 3 {
            shuffle(&mut rows, seed);
        }
        let head: Vec<Vec<String>> = match program {
            0 => vec![words(&[&format!("t [{clock}]"), &format!("y [{unit}]")])],
            1 => vec![words(&["ball", "", ""]), words(&["t", "x", "y"])],
            2 => vec![words(&["Frame", "X1", "Y1", "Flag1"]), words(&["Tracks 1 to 1", "", "", ""])],
            3 => Vec::new(),
            4 => vec![
                words(&["Vernier Format 2", ""]), words(&["lab", ""]), words(&["run", ""]),
                words(&["Time", "Position"]), words(&["t", "y"]), words(&[clock, unit]),
            ],
            _ => vec![words(&["frame", &format!("height_{unit}")])],
        };
        rows.splice(0..0, head);
        let mut options = ReadOptions::default();
        if matches!(program, 2 | 3 | 5) {
            options = options.fps(FPS);
        }
        options = if in_pixels { options.scale(0.01).y_down(true) } else { options.y_down(false) };
        let found = read(&hand.write(&rows), &options);
        prop_assert!(same(&found, &expected), "{rows:?}\n{found:?}\n{expected:?}");
    }
}
