//! Sheets as people bring them, each with a ball of 0.8: read as they are.

use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

fn read(text: &str) -> Table {
    Table::parse("sheet.csv", text.as_bytes(), &ReadOptions::default()).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

fn fit(text: &str) -> Report {
    Fit::new().run(&read(text)).unwrap()
}

#[test]
fn sheets_are_read_as_they_are() {
    for text in [
        // A telephone's stopwatch.
        "Bouncing ball\nLap,Lap time,Total time\n1,00:00:03.200,00:00:03.200\n2,00:00:00.723,00:00:03.923\n3,00:00:00.578,00:00:04.501\n\
         4,00:00:00.462,00:00:04.963\n5,00:00:00.370,00:00:05.333\n",
        // Labels of a sound program, and places of a film.
        "3.2000\t3.2000\tbounce 1\n3.9225\t3.9225\tbounce 2\n4.5005\t4.5005\t\n4.9629\t4.9629\tx\n5.3328\t5.3328\t\n",
        "Start height (m),Height after 1st bounce (m),Height after 2nd bounce (m)\n1.2,0.769,0.492\n1,0.641,0.410\n0.8,0.511,0.328\n",
        "n,Rebound height (±0.5 cm)\n0,100\n1,64.1\n2,41.0\n3,26.2\n",
        // A name that looks like the beginning of a comment.
        "#,time between bounces (ms)\n1,722\n2,578\n3,463\n4,370\n5,296\n",
        "# Ana\n\nBounce,Air time (s)\n1,0.722\n2,0.578\n3,0.463\n4,0.370\n5,0.296\n",
        // Columns made by spaces.
        "bounce  time(s)\n  1     3.200\n  2     3.923\n  3     4.501\n  4     4.963\n  5     5.333\n",
        "Bounce no.   Height (cm)\n0   100\n1    64.1\n2    41.0\n3    26.2\n",
        "Drop height,1st bounce height,2nd bounce height\n(cm),(cm),(cm)\n120,76.9,49.2\n100,64.1,41.0\n80,51.1,32.8\n",
        "Drop (cm),Second bounce (cm),First bounce (cm)\n120,49.2,76.9\n100,41.0,64.1\n80,32.8,51.1\n",
        // An average tells repeats from bounces.
        "Trial,Drop (cm),Height 1 (cm),Height 2 (cm),Average (cm)\n1,100,64.1,63.8,63.95\n2,100,64.3,63.9,64.1\n3,80,51.0,51.4,51.2\n",
        "bounce,run A (cm),run B (cm)\n0,100,100\n1,64.2,n/a\n2,,41.1\n3,26.1,26.3\n4,16.7,-\n",
        // Remarks behind a number and below the table.
        "bounce,height (cm)\n0,100\n1,64.1 # at its top\n2,41.0\n3,26.2\n\nMean ratio: 0.64\nMeasured on 3 May, by Ana\n",
    ] {
        let report = fit(text);
        let cor = report.cor().unwrap_or_else(|| panic!("{text}{report}"));
        assert!((cor.value - 0.8).abs() < 0.003, "{text}{report}");
        assert_eq!(report.verdict(), Verdict::Trusted, "{text}{report}");
    }
    let left = fit("bounce,height (cm)\n0,100\n1,64.1\n2,41.0\n\nMean ratio: 0.64\n");
    let aside = &left.left_aside()[0];
    assert_eq!((aside.name.as_str(), aside.line, left.left_aside().len()), ("Mean ratio: 0.64", Some(6), 1), "{left}");
    assert!(left.to_string().contains("Left aside\n  - text 'Mean ratio: 0.64' in line 6"), "{left}");
}

/// A place in a text whose columns are made by spaces is that of the file.
#[test]
fn what_is_no_number_is_shown_where_it_stands() {
    for (text, place) in [
        ("bounce  height_cm\n  0     100\n  1     sixty\n  2     41\n", "sheet.csv:3:9"),
        ("bounce,height_cm\n0,100\nten,64\nMean of all\n3,26\n", "sheet.csv:3:1"),
        ("bounce,height_cm\n0,100\nten,64\n3,26\n", "sheet.csv:3:1"),
    ] {
        let error = Table::parse("sheet.csv", text.as_bytes(), &ReadOptions::default()).unwrap_err().to_string();
        assert!(error.contains(place), "{error}");
    }
}

/// What cannot be guessed is said, with what to do.
#[test]
fn what_is_ambiguous_is_named() {
    let twice = read("bounce,height_cm\n0,100\n1,64\n2,41\nbounce,height_cm\n0,100\n1,64\n");
    assert_eq!(twice.trials().len(), 2, "tables below one another are two");
    // Times of contacts rise: what falls is the times between them.
    let intervals = fit("bounce,time (s)\n1,0.722\n2,0.578\n3,0.463\n");
    assert!((intervals.cor().unwrap().value - 0.8).abs() < 0.003, "{intervals}");
    assert!(intervals.notes().iter().any(|note| note.contains("taken as times between contacts")), "{intervals}");
    let across = fit("Bounce,0,1,2\nHeight (cm),100,64,41\n");
    assert!((across.cor().unwrap().value - 0.8).abs() < 0.003, "{across}");
    // As high as one another, and well below the drop: no ball bounces so.
    let repeats = fit(
        "drop (cm),bounce 1 (cm),bounce 2 (cm),bounce 3 (cm)\n120,76.5,77.2,76.9\n100,64.2,63.7,64.1\n80,51,51.5,51.1\n",
    );
    assert!((repeats.cor().unwrap().value - 0.8).abs() < 0.003, "{repeats}");
    assert!(repeats.notes().iter().any(|line| line.contains("taken for repeats")), "{repeats}");
    let bounces = fit("drop (cm),bounce 1 (cm),bounce 2 (cm),bounce 3 (cm)\n120,76.5,49.2,31.5\n100,64.2,41,26.2\n");
    assert!(bounces.notes().iter().all(|line| !line.contains("taken for repeats")), "{bounces}");
    // Two balls in one film have a COR each.
    let rows: String = (0..90)
        .map(|n| {
            let (t, fall) = (f64::from(n) / 60.0, (2.0f64 / 9.81).sqrt());
            let s = t - fall;
            let h = |e: f64| if s < 0.0 { 1.0 - 4.905 * t * t } else { (4.905 * s * (2.0 * e * fall - s)).max(0.0) };
            format!("{t:.5},{:.4},{:.4}\n", h(0.8), h(0.7))
        })
        .collect();
    let film = fit(&format!("t (s),Ball A y (m),Ball B y (m)\n{rows}"));
    let cors: Vec<(&str, f64)> =
        film.groups().iter().map(|g| (g.name.as_str(), g.report.cor().unwrap().value)).collect();
    assert!(
        matches!(cors[..], [("Ball A", a), ("Ball B", b)] if (a - 0.8).abs() < 0.01 && (b - 0.7).abs() < 0.01),
        "{film}"
    );
}

#[test]
fn two_balls_in_one_sheet_have_a_cor_each() {
    let mut text = "ball,trial,bounce,height_cm\n".to_owned();
    for (ball, e) in [("superball", 0.85f64), ("old ball", 0.7)] {
        for trial in 0..3 {
            for bounce in 0..5 {
                let wobble = 0.1 * f64::from((7 * bounce + 3 * trial) % 5 - 2);
                text += &format!("{ball},{trial},{bounce},{:.1}\n", 100.0 * e.powi(2 * bounce) + wobble);
            }
        }
    }
    // One ruler, read at the bottom of the ball; without that, where on the ball it was read may
    // differ from group to group.
    let table = Table::parse("sheet.csv", text.as_bytes(), &ReadOptions::default()).unwrap();
    let report = Fit::new().sigma_zero(0.0).drag(0.0).run(&table).unwrap();
    let wide = &fit(&text).differences()[0].clone();
    assert!(wide.low < 0.142 && wide.high > 0.16, "{wide:?}");
    let cors: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
    assert!((cors[0] - 0.85).abs() < 0.002 && (cors[1] - 0.7).abs() < 0.002 && report.cor().is_none(), "{report}");
    let difference = &report.differences()[0];
    assert!((difference.value - 0.15).abs() < 0.002 && difference.low > 0.14 && difference.high < 0.16, "{report}");
}

/// A line of one cell below the names of several columns is a remark, however it is worded; units
/// may stand below it, and it is named.
#[test]
fn remarks_between_names_and_rows_are_none_of_them() {
    for remark in ["ball dropped on tile", "height of the bottom of the ball", "from the first bounce to the second"] {
        for text in [
            format!("Height before (cm),Height after (cm)\n{remark}\n150,96.0\n100,64.1\n80,51.2\n60,38.4\n"),
            format!("Height before,Height after\n{remark}\n(cm),(cm)\n150,96.0\n100,64.1\n80,51.2\n60,38.4\n"),
            format!(
                "Height before,Height after\n{remark}\nseen from the side\ncm,cm\n150,96.0\n100,64.1\n80,51.2\n60,38.4\n"
            ),
        ] {
            let report = fit(&text);
            let cor = report.cor().unwrap_or_else(|| panic!("{text}{report}"));
            assert!((cor.value - 0.8).abs() < 0.003 && read(&text).trials().len() == 4, "{text}{report}");
            assert!(report.left_aside().iter().any(|aside| aside.name == remark), "{text}{report}");
        }
    }
}
