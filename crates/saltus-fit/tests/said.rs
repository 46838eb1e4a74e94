//! What people are told: what they state is obeyed, what looks wrong is named with its place, and
//! what cannot be told apart is not told apart.

use crate::written;

use crate::noise::Noise;
use saltus_fit::{CorModel, Fit, Loss, ReadOptions, Report, Table, Verdict};

fn read(text: &str, options: &ReadOptions) -> Table {
    Table::parse("film.csv", text.as_bytes(), options).unwrap()
}

fn fitted(text: &str, options: &ReadOptions) -> Report {
    Fit::new().run(&read(text, options)).unwrap()
}

fn refuse(text: &str) -> String {
    Table::parse("film.csv", text.as_bytes(), &ReadOptions::default()).unwrap_err().to_string()
}

/// A ball with a COR of 0.8, dropped from 1 m and filmed for 2.2 s, each height turned into what is
/// written.
fn film(column: &str, rate: u32, written: impl Fn(f64) -> f64) -> String {
    let (g, mut noise) = (9.81f64, Noise(5));
    let (fall, first) = ((2.0 / g).sqrt(), (2.0 * g).sqrt());
    let height = |t: f64| {
        if t < fall {
            return 1.0 - 0.5 * g * t * t;
        }
        let (mut start, mut speed) = (fall, 0.8 * first);
        while t > start + 2.0 * speed / g {
            (start, speed) = (start + 2.0 * speed / g, 0.8 * speed);
        }
        speed * (t - start) - 0.5 * g * (t - start).powi(2)
    };
    let rows = (0..rate * 11 / 5).map(|n| f64::from(n) / f64::from(rate));
    rows.fold(format!("time_s,{column}\n"), |text, t| {
        text + &format!("{t:.6},{:.6}\n", written(height(t) + noise.normal(0.0005)))
    })
}

fn has(list: &[String], part: &str) -> usize {
    list.iter().filter(|line| line.contains(part)).count()
}

#[test]
fn which_way_is_up_is_obeyed_where_it_is_stated() {
    let (up, down) = (film("height_m", 240, |h| h), film("height_m", 240, |h| 1.5 - h));
    for (text, right, way) in [(&up, false, "it should be --y-up"), (&down, true, "it should be --y-down")] {
        for options in [ReadOptions::default(), ReadOptions::default().y_down(right)] {
            let report = fitted(text, &options);
            assert_eq!((report.verdict(), report.warnings().len()), (Verdict::Trusted, 1), "{report}");
        }
        let wrong = fitted(text, &ReadOptions::default().y_down(!right));
        assert_ne!(wrong.verdict(), Verdict::Trusted, "{wrong}");
        assert!(wrong.reason().contains(way) && has(wrong.repairs(), "turned over") == 0, "{wrong}");
    }
}

/// From sample to sample a fast film shows its noise only.
#[test]
fn noise_does_not_turn_a_fast_film_over() {
    for text in [film("height_m", 9000, |h| h), film("height_m", 9000, |h| 1.5 - h)] {
        let report = fitted(&text, &ReadOptions::default());
        assert_eq!(report.verdict(), Verdict::Trusted, "{report}");
        assert!((report.cor().unwrap().value - 0.8).abs() < 1e-4, "{report}");
    }
}

#[test]
fn more_samples_than_are_of_use_are_thinned() {
    let report = fitted(&film("height_m", 30_000, |h| h), &ReadOptions::default());
    assert_eq!(has(report.repairs(), "of 66000 samples one in 2 is used"), 1, "{report}");
    assert!(report.series()[0].samples <= 33_000 && (report.cor().unwrap().value - 0.8).abs() < 1e-4, "{report}");
}

#[test]
fn a_stated_unit_is_for_columns_without_one_or_against_all() {
    let height = |table: &Table, n: usize| table.trials()[0].readings()[n].height.unwrap();
    let against = read("bounce,height_cm\n0,1000\n1,640\n", &ReadOptions::default().height_unit("mm"));
    assert_eq!((height(&against, 0), height(&against, 1)), (1.0, 0.64));
    let report = Fit::new().run(&against).unwrap();
    assert_eq!(has(report.warnings(), "'height_cm' are taken to be in mm, as stated"), 1, "{report}");
    let beside = read("h0_m,height\n1,64\n", &ReadOptions::default().height_unit("cm"));
    assert_eq!((height(&beside, 0), height(&beside, 1)), (1.0, 0.64));
    for (table, said) in [(&beside, 0), (&read("height_cm\n100\n64\n", &ReadOptions::default().height_unit("cm")), 0)] {
        assert_eq!(Fit::new().run(table).unwrap().warnings().iter().filter(|w| w.contains("as stated")).count(), said);
    }
    let times = read("bounce,time_ms\n1,0.5\n2,0.9\n", &ReadOptions::default().time_unit("s"));
    assert_eq!(times.trials()[0].readings()[1].time, Some(0.9));
}

#[test]
fn a_height_in_another_unit_is_named_with_its_place() {
    for (text, place, instead) in [
        ("height_cm\n100\n0.64\n41\n", "film.csv:3:1: '0.64' is about 100 times too small", "write 64 for it"),
        (
            "bounce,height_m\n0,1\n1,0.64\n2,410\n3,0.262\n",
            "film.csv:4:3: '410' is about 1000 times too large",
            "write 0.41",
        ),
        (
            "bounce,trial 1 (cm),trial 2 (cm)\n0,100,100\n1,64,65\n2,41,0.42\n",
            "film.csv:4:6: '0.42'",
            "write 42 for it",
        ),
        ("drop_cm,rebound_cm\n100,64\n100,0.65\n100,63\n", "film.csv:3:5: '0.65'", "write 65 for it"),
    ] {
        let report = fitted(text, &ReadOptions::default());
        assert_eq!(has(report.warnings(), place) * has(report.warnings(), instead), 1, "{report}");
    }
    for dull in [
        "height_mm\n1000\n10\n0.1\n",
        "height_mm\n1000\n300\n20\n3\n1\n",
        "ball,drop_cm,rebound_cm\nrubber,100,64\nrubber,100,65\nrubber,100,63\nclay,100,0.6\n",
        "drop_cm,rebound_cm\n100,0.64\n",
    ] {
        let report = fitted(dull, &ReadOptions::default());
        assert_eq!(has(report.warnings(), "times too"), 0, "{report}");
    }
}

#[test]
fn cells_lines_and_units_are_called_what_they_are() {
    let book = written::xlsx(&[(
        "drops",
        [["drop_cm", "rebound_cm"], ["100", "64"], ["n/a", "65"]].map(|r| r.map(str::to_owned).to_vec()).to_vec(),
    )]);
    let error = Table::parse("book.xlsx", &book, &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.starts_with("book.xlsx, sheet 'drops', cell A3: 'n/a' is no reading"), "{error}");
    assert!(refuse("drop_cm,rebound_cm\n,64\n").contains("the cell is empty"));
    let furlong = refuse("bounce,height_furlong\n0,100\n1,64\n");
    assert!(
        furlong.contains("'furlong' in 'height_furlong' is not a unit of length") && furlong.contains("m, cm, mm"),
        "{furlong}"
    );
    assert!(refuse("bounce,rebound height\n0,100\n1,64\n").contains("'rebound height' has no unit"));
    let zeros = |text: &str| fitted(text, &ReadOptions::default()).warnings().concat();
    assert!(zeros("height_cm\n100\n64\n0\n0\n").contains("lines 4 and 5: a rebound of zero height"));
    assert!(zeros("height_cm\n100\n64\n0\n0\n0\n").contains("lines 4, 5 and 6: "));
    assert!(zeros(&format!("height_cm\n100\n64\n{}", "0\n".repeat(9))).contains("9 lines, the first of them 4: "));
}

#[test]
fn a_model_that_cannot_be_fitted_says_what_it_needs() {
    let table = Table::from_heights(&[1.0, 0.64, 0.41, 0.262]).unwrap();
    for (model, needs) in [
        (CorModel::Viscoelastic, "needs 6 bounces at speeds that differ by a factor of 2; here are 3"),
        (CorModel::Drag, "needs bounces at speeds that differ by a factor of 1.6; here are 3"),
        (CorModel::Offset, "needs 4 bounces"),
        (CorModel::Each, "needs 3 readings more than it has unknowns"),
    ] {
        let report = Fit::new().model(model).run(&table).unwrap();
        assert!(report.verdict() == Verdict::Doubtful && report.reason().contains(needs), "{report}");
    }
    // One COR is what the report rests on anyway.
    assert_eq!(Fit::new().model(CorModel::Constant).run(&table).unwrap().verdict(), Verdict::Trusted);
    let series =
        Fit::new().model(CorModel::Drag).run(&read(&film("height_m", 120, |h| h), &ReadOptions::default())).unwrap();
    assert_eq!(has(series.warnings(), "chooses its model by itself"), 1, "{series}");
}

/// The decimals of a number at the end, or at the beginning, of a text.
fn decimals(number: &str) -> usize {
    assert!(number.parse::<f64>().is_ok(), "{number}");
    number.split('.').nth(1).map_or(0, str::len)
}

/// Every number of a report has the decimals of its error.
fn as_exact_as_their_errors(report: &Report) {
    let text = report.to_string();
    let words: Vec<&str> = text.split_whitespace().collect();
    let pairs: Vec<_> = words.windows(3).filter(|w| w[1] == "±" && w[0].parse::<f64>().is_ok()).collect();
    assert!(pairs.len() > 2, "{report}");
    for pair in pairs {
        assert_eq!(decimals(pair[0]), decimals(pair[2]), "{pair:?} in {report}");
    }
}

#[test]
fn recordings_tell_gravity_in_their_unit() {
    let table = |name: &str, text: &str| Table::parse(name, text.as_bytes(), &ReadOptions::default()).unwrap();
    let films = film("height_m", 100, |h| h).replace("time_s", "trial,time_s");
    let mut rows = films.lines();
    let header = rows.next().unwrap();
    let of = |trial: u32| rows.clone().fold(String::new(), |all, row| all + &format!("{trial},{row}\n"));
    let two =
        Fit::new().run(&table("two.csv", &format!("{header}\n{}{}", of(1), of(2).replace(",0.9", ",0.90")))).unwrap();
    as_exact_as_their_errors(&two);
    let text = two.to_string();
    assert!(
        text.contains("Trial 1: 219 samples; gravity 9.8") && text.contains("Trial 2: ") && text.contains(" m/s²;"),
        "{text}"
    );
    let pixels = fitted(&film("y_px", 240, |h| 800.0 - 600.0 * h), &ReadOptions::default()).to_string();
    assert!(pixels.contains(" px/s ") && pixels.contains(" px/s²; rms 0.") && !pixels.contains(" /s"), "{pixels}");
}

#[test]
fn errors_that_differ_and_losses_have_their_words() {
    // Drops that differ by more than their readings: the error of the COR is that of the spread.
    let mut text = "trial,bounce,height_cm\n".to_owned();
    for (trial, e) in [0.78f64, 0.82, 0.79, 0.81, 0.80, 0.795, 0.805].into_iter().enumerate() {
        for n in 0..4 {
            text += &format!("{trial},{n},{:.3}\n", 100.0 * e.powi(2 * n));
        }
    }
    let table = read(&text, &ReadOptions::default());
    let report = Fit::new().losses(&Loss::ALL).run(&table).unwrap();
    let said = report.to_string();
    for words in ["heights, Huber's loss", "heights, the sum of |r|", "heights, the largest |r|"] {
        assert!(said.contains(words), "{said}");
    }
    let chosen = report.models().iter().find(|m| m.chosen).expect("models");
    let (row, whole) = (chosen.cor.standard_error, report.cor().unwrap().standard_error.unwrap());
    assert_eq!(
        (row / whole - 1.0).abs() > 0.1,
        said.contains("The ± of a model follows from the reading errors alone"),
        "{said}"
    );
    assert!((row / whole - 1.0).abs() > 0.1, "{row} {whole}");
}

#[test]
fn several_files_have_a_title_of_their_own() {
    let folder = std::env::temp_dir().join(format!("saltus-titles-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let files: Vec<_> = ["first-drop.csv", "b.csv", "c.csv", "d.csv"].iter().map(|name| folder.join(name)).collect();
    for (n, file) in files.iter().enumerate() {
        std::fs::write(file, format!("height_cm\n10{n}\n6{n}\n4{n}\n")).unwrap();
    }
    let title = |count: usize| {
        let table = Table::read_all(&files[..count], &ReadOptions::default()).unwrap();
        Fit::new().run(&table).unwrap().title()
    };
    assert_eq!([1, 2, 3, 4].map(title), ["First drop", "First drop and b", "First drop, b and c", "4 files"]);
}
