//! Kinds of files that readings are handed in: what consoles, databases, scripts, typesetting and
//! other programs hold, and letters that tell of bounces. Of each kind one that is read and those
//! that look alike and are not.

use std::fmt::Write as _;

use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

fn report(name: &str, text: &str) -> Report {
    let table = Table::parse(name, text.as_bytes(), &ReadOptions::default());
    Fit::new().run(&table.unwrap_or_else(|error| panic!("{text}\n{error}"))).unwrap()
}

/// The COR that is trusted.
fn trusted(name: &str, text: &str) -> f64 {
    let report = report(name, text);
    assert_eq!(report.verdict(), Verdict::Trusted, "{text}\n{report}");
    report.cor().unwrap().value
}

fn refused(name: &str, text: &str) -> String {
    Table::parse(name, text.as_bytes(), &ReadOptions::default()).expect_err(text).to_string()
}

fn near(a: f64, b: f64) {
    assert!((a - b).abs() < 0.01, "{a} {b}");
}

/// Speeds before and after in rows, of which `back` have turned round.
fn speeds(title: &str, back: [f64; 4]) -> String {
    let mut text = format!("{title}\nrun,v before (m/s),v after (m/s)\n");
    for (n, (speed, back)) in [3.0, 4.0, 5.0, 6.0].into_iter().zip(back).enumerate() {
        writeln!(text, "{},{speed},{:.3}", n + 1, back * speed * (0.8 + 0.002 * n as f64)).unwrap();
    }
    text
}

#[test]
fn speeds_that_turn_round_are_of_a_rebound() {
    let back = [-1.0; 4];
    near(trusted("a.csv", &speeds("Lab 3", back)), 0.803);
    near(trusted("a.csv", &speeds("Cart against a bumper", back)), 0.803);
    for (title, back) in [
        // Nothing turns round, or not always.
        ("Lab 3", [1.0; 4]),
        ("Lab 3", [-1.0, -1.0, 1.0, -1.0]),
        // So does what swings, and what rolls up a ramp.
        ("Pendulum", back),
        ("Cart up a ramp", back),
        ("Cart against a bumper", [1.0; 4]),
    ] {
        let report = report("a.csv", &speeds(title, back));
        assert_ne!(report.verdict(), Verdict::Trusted, "{title}\n{report}");
    }
    let two: String = speeds("Lab 3", back).lines().take(4).fold(String::new(), |text, line| text + line + "\n");
    assert_ne!(report("a.csv", &two).verdict(), Verdict::Trusted, "{two}");
}

#[test]
fn a_ball_against_a_wall_bounces() {
    for title in ["Tennis ball against the wall", "Pallina da tennis contro un muro", "Tennisball gegen eine Wand"] {
        near(trusted("a.csv", &speeds(title, [1.0; 4])), 0.803);
    }
    for title in ["Sled against the wind", "Sled and wall", "Tennis ball, speed against time"] {
        let report = report("a.csv", &speeds(title, [1.0; 4]));
        assert_ne!(report.verdict(), Verdict::Trusted, "{title}\n{report}");
    }
}

/// What is struck out was withdrawn, a row or a number; the unit may be spelt out.
#[test]
fn latex_without_what_is_struck_out() {
    let table = |row: &str, unit: &str| {
        format!(
            "Ball drops.\n\\begin{{tabular}}{{c S S}}\nn & {{$v_\\text{{before}}$ / {unit}}} & {{$v_\\text{{after}}$ / {unit}}} \\\\\n\
             1 & \\num{{1.20}} & \\num{{0.84}} \\\\\n2 & \\num{{1.60}} & \\num{{1.12}} \\\\ % by hand\n{row}4 & \\num{{2.40}} & \\num{{1.69}} \\\\\n\\end{{tabular}}\n"
        )
    };
    for unit in ["\\si{\\metre\\per\\second}", "\\si{m/s}"] {
        near(trusted("a.tex", &table("", unit)), 0.702);
        near(trusted("a.tex", &table("\\sout{3} & \\sout{2.00} & \\sout{0.31} \\\\ % seam\n", unit)), 0.702);
        near(trusted("a.tex", &table("3 & \\num{2.00} & \\sout{0.31} 1.40 \\\\\n", unit)), 0.702);
    }
    let kept = report("a.tex", &table("3 & \\num{2.00} & \\num{0.31} \\\\\n", "\\si{m/s}"));
    assert!(kept.verdict() != Verdict::Trusted || kept.left_aside().iter().any(|a| a.name.contains("0.31")), "{kept}");
}

/// The rows of a frame of data are counted; two blanks need not part its cells.
#[test]
fn frames_of_data_of_a_console() {
    let mut text = ">>> df\n   ball  drop_m  rebound_m floor\n".to_owned();
    for (n, (drop, rebound)) in [(1.0, "0.642"), (1.5, "NaN"), (1.5, "0.958"), (2.0, "1.283")].iter().enumerate() {
        writeln!(text, "{n}  golf     {drop:.1}      {rebound} stone").unwrap();
    }
    text += "\n[4 rows x 4 columns]\n>>> df.dtypes\nball  object\n";
    near(trusted("df.txt", &text), 0.80);
}

/// Rows of a database that are voided do not count; a dump of several tables is none.
#[test]
fn dumps_of_a_database() {
    let dump = |void: &str, table: &str| {
        format!(
            "-- golf ball\nCREATE TABLE drops (id INT, drop_mm INT, rebound_mm INT, voided BOOLEAN, note TEXT);\n\
             INSERT INTO drops VALUES (1, 1000, 640, FALSE, NULL), (2, 1000, 644, FALSE, 'fine, (yes)');\n\
             INSERT INTO {table} VALUES (3, 1000, 310, {void}, 'hit the edge');\n\
             INSERT INTO drops VALUES (4, 1500, 957, FALSE, NULL);\nINSERT INTO drops VALUES (5, 1500, 963, FALSE, NULL);\n"
        )
    };
    near(trusted("a.sql", &dump("TRUE", "drops")), 0.80);
    let counts = report("a.sql", &dump("FALSE", "drops"));
    assert!(counts.cor().is_none_or(|cor| (cor.value - 0.8).abs() > 0.01) || counts.verdict() != Verdict::Trusted);
    assert!(refused("a.sql", &dump("TRUE", "old")).contains("SQL"));
    assert!(refused("a.sql", "CREATE TABLE drops (id INT, drop_mm INT);\n").contains("SQL"));
}

#[test]
fn lists_of_a_script() {
    let script = |remark: &str| {
        format!(
            "%% Golf ball, bounces\nn = 0:5;  % number of the bounce\nh = [2.000 1.282 0.818 ...\n    0.526 0.335 0.215];  % {remark}\ndh = 0.005*ones(6);\n% p = polyfit(n, h);\nfigure; plot(n, h)\n"
        )
    };
    near(trusted("a.m", &script("m")), 0.80);
    // Nobody says in which unit, or they were not measured.
    let asked = refused("a.m", &script("by eye"));
    assert!(asked.contains("unit"), "{asked}");
    let simulated =
        Table::parse("a.m", script("m").replace("Golf ball", "Simulated").as_bytes(), &ReadOptions::default());
    let simulated = simulated.map(|table| Fit::new().run(&table).unwrap().verdict());
    assert!(simulated.is_ok_and(|verdict| verdict != Verdict::Trusted));
}

/// Records within a file of settings: what stands further left is of the whole.
#[test]
fn records_of_a_file_of_settings() {
    let mut text = "# ball on stone\nruns:\n".to_owned();
    for (drop, rebound) in [(60, 38.6), (80, 51.0), (100, 64.2), (120, 76.6)] {
        writeln!(text, "  - drop_cm: {drop}\n    rebound_cm: {rebound}   # first bounce").unwrap();
    }
    near(trusted("a.yaml", &(text.clone() + "by: Ann\ng: 9.81\n")), 0.80);
    near(trusted("a.yaml", &text), 0.80);
}

/// Members of one name in records and in their lists are told apart by what holds them.
#[test]
fn lists_within_records() {
    let mut text = "<lab ball=\"rubber\">\n".to_owned();
    for (n, drop) in [1.0_f64, 1.4, 1.8].into_iter().enumerate() {
        writeln!(text, "<drop nr=\"{}\" height=\"{}\" unit=\"m\">", n + 1, format!("{drop:.2}").replace('.', ","))
            .unwrap();
        for bounce in 1..4 {
            let height = drop * 0.64_f64.powi(bounce) + 0.003 * ((n + 2 * bounce as usize) % 3) as f64 - 0.003;
            let height = format!("{height:.3}").replace('.', ",");
            writeln!(text, "<bounce nr=\"{bounce}\"><height unit=\"m\">{height}</height></bounce>").unwrap();
        }
        text += "</drop>\n";
    }
    near(trusted("a.xml", &(text + "</lab>\n")), 0.80);
}

/// A film of a ball that falls 1 m, a row each sixtieth of a second: the time as it is written, and
/// the height.
fn film(row: impl Fn(usize, f64) -> String) -> String {
    let (g, e, mut text) = (9.81_f64, 0.8_f64, String::new());
    let fall = (2.0 / g).sqrt();
    for n in 0..150 {
        let time = n as f64 / 60.0;
        let (mut start, mut speed, mut height) = (fall, e * (2.0 * g).sqrt(), 1.0 - 0.5 * g * time * time);
        if time >= fall {
            while time > start + 2.0 * speed / g {
                (start, speed) = (start + 2.0 * speed / g, e * speed);
            }
            height = speed * (time - start) - 0.5 * g * (time - start).powi(2);
        }
        // What is clicked at is off by a pixel.
        writeln!(text, "{}", row(n, height + 0.001 * (((n * 7919) % 13) as f64 / 6.0 - 1.0))).unwrap();
    }
    text
}

/// Hundredths of a time of four parts are read where they are these; a fourth part that may count
/// frames is asked about.
#[test]
fn times_of_four_parts() {
    let row = |per: usize| {
        move |n: usize, height: f64| {
            let last = n * per / 60;
            format!("0:00:{:02}:{:02};0,1;{:.2}", last / per, last % per, 100.0 * height - 100.0).replace('.', ",")
        }
    };
    let kinovea = format!("#Kinovea Trajectory data export\n#T;X;Y\n\n{}", film(row(100)));
    near(trusted("a.txt", &kinovea), 0.80);
    let frames = format!("T;X;Y (cm)\n{}", film(row(25)));
    let read = Table::parse("a.txt", frames.as_bytes(), &ReadOptions::default());
    let verdict = read.map(|table| Fit::new().run(&table).unwrap().verdict());
    assert!(verdict.is_err() || verdict.is_ok_and(|verdict| verdict != Verdict::Trusted));
}

/// Points that were clicked at, in pixels that count downwards; and places that bear a number.
#[test]
fn tracks_by_hand() {
    let down = |n: usize, height: f64| {
        let y = 700.0 - 500.0 * height;
        format!("1\t1\t{}\t{}\t{y:.1}\t-1.0\t-1.0\t{}", n + 7, 310 + n / 9, 170 + n % 40)
    };
    let header = " \tTrack n°\tSlice n°\tX\tY\tDistance\tVelocity\tPixel Value\n";
    near(trusted("Results.xls", &format!("{header}{}", film(down))), 0.80);
    let numbered = film(|n, height| format!("{:.4}\t0.1{}\t{height:.4}", n as f64 / 60.0, n % 10));
    near(trusted("a.txt", &format!("#pymecavideo\n#t\tX1\tY1\n{numbered}")), 0.80);
}

/// Of labels that say what was heard those of impacts count.
#[test]
fn labels_that_say_what_they_are() {
    let labels = |names: [&str; 6]| {
        let times = [0.9, 1.35, 2.07, 2.646, 3.107, 3.475];
        let row = |(time, name): (f64, &str)| format!("{time:.6}\t{:.6}\t{name}\n", time + 0.01);
        times.into_iter().zip(names).map(row).collect::<String>() + "5.1\t5.9\tchair\n"
    };
    let report = report("a.txt", &labels(["let go", "impact 1", "impact 2", "impact 3", "impact 4", "impact 5"]));
    assert_eq!(report.verdict(), Verdict::Trusted, "{report}");
    near(report.cor().unwrap().value, 0.80);
    assert!(report.left_aside().iter().any(|aside| aside.name == "chair"), "{report}");
    refused("a.txt", &labels(["a door", "wobble", "la", "la", "la", "la"]));
}

/// Bounces that a letter counts; counted trials, and anything else that is measured, are none.
#[test]
fn letters_that_count_bounces() {
    for text in [
        "Hej Ida,\nvi lod bolden falde fra 150 cm. Første gang hoppede den 96 cm op,\nanden gang 61 cm, så 39 cm og fjerde gang 25 cm.\nVi ses kl. 10\n",
        "Ahoj,\ndoby mezi dopady: první 0,72 s, druhá 0,576 s, třetí 0,461 s a čtvrtá 0,369 s.\n",
        "On lâche la balle depuis 1,50 m (bas de la balle).\n 1er rebond : 0,96 m\n 2e rebond : 0,61 m\n 3e rebond : 0,39 m\nMasse : 57 g\n",
    ] {
        near(trusted("a.txt", text), 0.80);
    }
    for text in [
        "We dropped it from 1 m. The first time it bounced 64 cm, the second time 65 cm, the third 64 cm.\n",
        "Dropped from 1 m. First bounce 64 cm, second 41 cm. The ball is 4 cm wide, of 58 g.\n",
        "The first plank is 64 cm, the second 41 cm, the third 26 cm.\n",
    ] {
        let read = Table::parse("a.txt", text.as_bytes(), &ReadOptions::default());
        let verdict = read.map(|table| Fit::new().run(&table).unwrap().verdict());
        assert!(verdict.is_err() || verdict.is_ok_and(|verdict| verdict != Verdict::Trusted), "{text}");
    }
}

/// Rows that stand apart below the others and count and sum them up are no drops, whatever the sum
/// is called; names of other balls are.
#[test]
fn what_sums_rows_up_below_them() {
    let rows = "sample,drop height (cm),rebound height (cm)\nS-1,100,64\nS-2,100,66\nS-3,100,62\nS-4,100,64\n";
    let text = format!("{rows}\nn,,4\nmean,,64\nmax,,66\nmin,,62\n");
    let report = report("a.csv", &text);
    assert_eq!(
        report.left_aside().iter().filter(|aside| aside.line.is_some_and(|line| line > 6)).count(),
        4,
        "{report}"
    );
    near(report.cor().unwrap().value, 0.80);
    let more = format!("{rows}\nS-5,100,64\nS-6,100,65\n");
    let table = Table::parse("a.csv", more.as_bytes(), &ReadOptions::default()).unwrap();
    assert_eq!(table.trials().len(), 6, "{table:?}");
}

/// A count of bounces goes on where one was not read; a release stands before it, whatever it is
/// called.
#[test]
fn a_count_with_gaps() {
    near(trusted("a.csv", "bounce;height (cm)\nlet fall;200\n1;128\n2;82\n3;?\n4;33.5\n5;21.5\n"), 0.80);
}

/// Product and lot are what they are called; what was predicted is no reading wherever that stands.
#[test]
fn a_title_of_a_name_and_what_it_is() {
    let rows = "drop height (cm),rebound height (cm)\n100,64\n80,51\n60,38.5\n";
    near(trusted("a.csv", &format!("Product,range ball\nSpecimen,3/4 inch ball\n{rows}")), 0.80);
    for title in ["Data,predicted values", "Calculated,from the ball's COR"] {
        assert_ne!(report("a.csv", &format!("{title}\n{rows}")).verdict(), Verdict::Trusted, "{title}");
    }
}
