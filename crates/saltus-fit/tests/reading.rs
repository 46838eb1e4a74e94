//! Every layout that is understood, and every refusal with its place.

use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Event, Fit, ReadOptions, Table, TableError, Why};

fn read(text: &str) -> Table {
    read_with(text, &ReadOptions::default())
}

fn read_with(text: &str, options: &ReadOptions) -> Table {
    match Table::parse("table.csv", text.as_bytes(), options) {
        Ok(table) => table,
        Err(error) => panic!("{error}"),
    }
}

fn refuse(text: &str) -> TableError {
    refuse_with(text.as_bytes(), &ReadOptions::default())
}

fn refuse_with(bytes: &[u8], options: &ReadOptions) -> TableError {
    Table::parse("table.csv", bytes, options).expect_err("a refusal")
}

fn heights(table: &Table, trial: usize) -> Vec<(usize, f64)> {
    table.trials()[trial].readings().iter().filter_map(|r| r.height.map(|h| (r.bounce, h))).collect()
}

fn times(table: &Table, trial: usize) -> Vec<(usize, f64)> {
    table.trials()[trial].readings().iter().filter_map(|r| r.time.map(|t| (r.bounce, t))).collect()
}

#[test]
fn headers_as_people_write_them() {
    for header in
        ["height_cm", "height (cm)", "Height [cm]", "h [cm]", "h_cm", "HEIGHT_CM", "y (cm)", "rebound height / cm"]
    {
        assert_eq!(heights(&read(&format!("bounce,{header}\n0,100\n1,30\n")), 0), [(0, 1.0), (1, 0.3)], "{header}");
    }
    for header in
        ["time_s", "t (s)", "time [s]", "Time (s)", "t_s", "Latest: Time (s)", "time_s_read_by_us", "time in s"]
    {
        assert_eq!(times(&read(&format!("{header}\n0.5\n0.9\n")), 0), [(1, 0.5), (2, 0.9)], "{header}");
    }
    assert_eq!(heights(&read("height_mm\n1000\n300\n"), 0)[1].1, 0.3);
    assert_eq!(heights(&read("height_m\n1\n0.3\n"), 0)[1].1, 0.3);
    assert_eq!(heights(&read("height in inches (in)\n100\n10\n"), 0)[0].1, 2.54);
    assert_eq!(times(&read("time (ms)\n450\n850\n"), 0)[1].1, 0.85);
}

#[test]
fn events_with_their_synonyms() {
    let table = read("event,time_s,height_cm\ndrop,0,100\nimpact,0.45,\npeak,,30\nBounce,0.85,0\napex,1.0,10\n");
    let events: Vec<(Event, usize)> = table.trials()[0].readings().iter().map(|r| (r.event, r.bounce)).collect();
    use Event::{Apex, Contact, Release};
    assert_eq!(events, [(Release, 0), (Contact, 1), (Apex, 1), (Contact, 2), (Apex, 2)]);
    let table = read("event,height_cm\nrelease,100\napex,30\napex,10\n");
    assert_eq!(heights(&table, 0), [(0, 1.0), (1, 0.3), (2, 0.1)]);
}

#[test]
fn bytes_as_programs_write_them() {
    let expected = [(0, 1.0), (1, 0.305), (2, 0.1)];
    for text in [
        "\u{feff}bounce,height_cm\r\n0,100\r\n1,30.5\r\n2,10\r\n",
        "bounce;height_cm\n0;100,0\n1;30,5\n2;10,0\n",
        "bounce\theight_cm\n0\t100\n1\t30,5\n2\t10\n",
        "bounce,height_cm\r0,100\r1,30.5\r2,10\r",
        "# a remark\n\n\"bounce\",\"height_cm\"\n# another\n\"0\",\"100\"\n\n\n1,30.5\n2,10",
        "bounce , height_cm \n 0 , 100 \n 1 , 3.05e1 \n 2 , +10 \n",
        "bounce,height_cm,\n0,100,\n1,30.5,\n2,10,\n,,\n",
        "bounce,height_cm,note\n0,100,\"said \"\"go\"\"\"\n1,30.5,\n2,10,\"two\nlines\"\n",
    ] {
        assert_eq!(heights(&read(text), 0), expected, "{text:?}");
    }
}

#[test]
fn lists_and_units_from_options() {
    let cm = ReadOptions::default().height_unit("cm");
    assert_eq!(heights(&read_with("100\n30\n10\n", &cm), 0), [(0, 1.0), (1, 0.3), (2, 0.1)]);
    assert_eq!(heights(&read_with("bounce,height\n0,100\n1,30\n", &cm), 0), [(0, 1.0), (1, 0.3)]);
    let ms = ReadOptions::default().time_unit("ms");
    assert_eq!(times(&read_with("450\n850\n", &ms), 0), [(1, 0.45), (2, 0.85)]);
    let table = read_with("bounce,run 1,run 2\n0,100,99\n1,30,\n2,10,11\n", &cm);
    assert_eq!((heights(&table, 0).len(), heights(&table, 1)), (3, vec![(0, 0.99), (2, 0.11)]));
}

#[test]
fn trials_by_columns_rows_and_restarts() {
    let wide = read("bounce,trial 1 (cm),trial 2 (cm)\n0,100,100\n1,64,65\n");
    assert_eq!((wide.trials().len(), wide.trials()[1].label()), (2, "trial 2 (cm)"));
    let timed = read("bounce,trial 1 (s),trial 2 (s)\n0,0.1,0.2\n1,0.9,1.0\n2,1.5,1.6\n");
    assert_eq!(times(&timed, 1), [(1, 0.2), (2, 1.0), (3, 1.6)]);
    let rows = read("trial,h0 (cm),h1 (cm),h2 (cm)\n1,100,64,41\n2,100,65,\n");
    assert_eq!(heights(&rows, 1), [(0, 1.0), (1, 0.65)]);
    let pairs = read("drop_cm,rebound_cm\n100,64\n100,65\n80,51\n");
    assert_eq!((pairs.trials().len(), heights(&pairs, 2)), (3, vec![(0, 0.8), (1, 0.51)]));
    let restarts = read("bounce,height_cm\n0,100\n1,64\n0,90\n1,57\n");
    assert_eq!((restarts.trials().len(), heights(&restarts, 1)), (2, vec![(0, 0.9), (1, 0.57)]));
    let both = read("bounce,time_s,height_cm\n0,0,100\n1,0.45,64\n2,1.17,41\n");
    assert_eq!(both.trials()[0].readings().len(), 5);
}

#[test]
fn long_tables_are_grouped_and_filtered() {
    let text = "ball,h0_cm,trial,event,time_s,source_file\ngolf,80,1,0,0.8,a\ngolf,80,1,1,1.4,a\ngolf,80,1,2,2.0,a\n\
                tennis,80,1,0,0.1,b\ntennis,80,1,1,0.6,b\ngolf,80,2,0,0.3,a\ngolf,80,2,1,1.0,a\n";
    let table = read(text);
    assert_eq!(table.trials().len(), 3);
    assert_eq!(table.trials()[0].label(), "ball golf, h0_cm 80, trial 1");
    assert_eq!(heights(&table, 0), [(0, 0.8)]);
    assert_eq!(times(&table, 0), [(1, 0.8), (2, 1.4), (3, 2.0)]);
    let golf = read_with(text, &ReadOptions::default().filter("ball", "golf").filter("h0_cm", "80.0"));
    assert_eq!(golf.trials().len(), 2);
    assert!(golf.notes().iter().any(|n| n.to_string().contains("5 rows kept and 2 left out")), "{:?}", golf.notes());
    let none = refuse_with(text.as_bytes(), &ReadOptions::default().filter("ball", "squash"));
    assert!(none.to_string().contains("no row has ball = squash"), "{none}");
    let unknown = refuse_with(text.as_bytes(), &ReadOptions::default().filter("colour", "red"));
    assert!(unknown.to_string().contains("there is no column 'colour'"), "{unknown}");
}

#[test]
fn intervals_become_contacts() {
    let table = read("h0_cm,bounce,trial,interval_s\n65,1,1,0.5\n65,1,2,0.6\n65,2,1,0.4\n65,2,2,0.45\n65,3,1,0\n");
    assert_eq!(times(&table, 0), [(1, 0.0), (2, 0.5), (3, 0.9)]);
    assert_eq!(times(&table, 1), [(1, 0.0), (2, 0.6), (3, 1.05)]);
    let gap = refuse("bounce,interval_s\n1,0.5\n3,0.3\n");
    assert_eq!(gap.line(), Some(3));
}

#[test]
fn several_columns_of_one_quantity_are_a_question() {
    let text = "bounce,time_s_by_ear,time_s_by_eye\n0,0.1,0.2\n1,0.9,1.0\n";
    let question = refuse(text);
    assert!(question.is_question() && question.to_string().contains("--column 'time_s_by_ear'"), "{question}");
    let chosen = read_with(text, &ReadOptions::default().column("time_s_by_eye"));
    assert_eq!(times(&chosen, 0)[0].1, 0.2);
    assert_eq!(chosen.left_aside()[0].name, "time_s_by_ear");
    // A word that is not understood makes a column one that is not used.
    let unknown = read("bounce,time_s,time_s_by_threshold\n0,0.1,0.2\n1,0.9,1.0\n");
    assert_eq!(times(&unknown, 0)[0].1, 0.1);
    assert_eq!(
        (unknown.left_aside()[0].name.as_str(), unknown.left_aside()[0].why),
        ("time_s_by_threshold", Why::NotUnderstood)
    );
    let wrong = refuse_with(text.as_bytes(), &ReadOptions::default().column("time"));
    assert!(wrong.to_string().contains("there is no column 'time' to choose"), "{wrong}");
}

#[test]
fn comments_may_state_what_is_known() {
    let table = read(
        "# Frame rate: 30 fps\n#gravity: 980 cm/s^2\n# sigma height: 5 mm\nheight_cm\n100\n64\n41\n# sigma_time: 2 ms\n",
    );
    assert_eq!((table.frame_rate(), table.gravity()), (Some(30.0), Some(9.8)));
    let report = Fit::new().run(&table).unwrap();
    assert_eq!(report.sigma_height().unwrap().value, 0.005);
    for (text, column) in [
        ("# gravity: 9.8\nheight_cm\n1\n", 12),
        ("# frame rate: fast\nheight_cm\n1\n", 15),
        ("# sigma height: 0 cm\nheight_cm\n1\n", 17),
        ("# sigma time: 5 cm\nheight_cm\n1\n", 15),
    ] {
        let error = refuse(text);
        assert_eq!((error.line(), error.column()), (Some(1), Some(column)), "{error}");
    }
}

#[test]
fn an_error_column_is_the_error_of_its_row() {
    let table = read("bounce,height_cm,height_error_cm\n0,100,1\n1,64,0.5\n2,41,\n");
    let errors: Vec<Option<f64>> = table.trials()[0].readings().iter().map(|r| r.sigma_height).collect();
    assert_eq!(errors, [Some(0.01), Some(0.005), None]);
    assert_eq!(refuse("height_cm,height_error_cm\n100,0\n").column(), Some(5));
}

#[test]
fn copies_are_counted_once_and_said() {
    let rows = read("bounce,height_cm\n0,100\n1,30\n1,30\n2,10\n");
    assert_eq!(heights(&rows, 0).len(), 3);
    // Read to the millisecond, twelve times alike: by chance that never happens.
    let times: String = ["a", "b"]
        .map(|t| (1..13).map(|n| format!("{t},{n},{:.3}\n", 3.7 * (1.0 - 0.8f64.powi(n)))).collect::<String>())
        .concat();
    let trials = read(&format!("trial,bounce,time_s\n{times}"));
    assert_eq!(trials.trials().len(), 1);
    // To whole centimetres it does.
    let repeats = read("trial,bounce,height_cm\na,0,100\na,1,30\na,2,10\nb,0,100\nb,1,30\nb,2,10\n");
    assert_eq!(repeats.trials().len(), 2);
    for (table, part) in [(rows, "line 4"), (trials, "'trial b' repeats 'trial a'")] {
        let report = Fit::new().run(&table).unwrap();
        assert!(report.repairs()[0].contains(part), "{:?}", report.repairs());
    }
    let pairs = read("drop_cm,rebound_cm\n100,64\n100,64\n");
    assert_eq!(pairs.trials().len(), 2, "two rebounds to the same centimetre are two");
}

#[test]
fn zero_rebounds_are_kept_and_said() {
    let table = read("bounce,height_cm\n0,100\n1,30\n2,10\n3,0\n");
    // It has no logarithm, but neighbouring heights may count it.
    assert_eq!(heights(&table, 0).len(), 4);
    assert!(Fit::new().run(&table).unwrap().warnings()[0].contains("line 5"));
}

/// Text, line and column of the error, and a part of its message or help.
const REFUSALS: &[(&str, u64, usize, &str)] = &[
    ("bounce,height_cm\n0,100\n1,NaN\n", 3, 3, "'NaN' is not a finite number"),
    ("bounce,height_cm\n0,100\n1,inf\n", 3, 3, "not a finite number"),
    ("bounce,height_cm\n0,100\n1,1e999\n", 3, 3, "not a finite number"),
    ("bounce,height_cm\n0,100\n1,-30\n", 3, 3, "a height below the floor"),
    ("bounce,height_cm\n0,100\n1,30 s\n", 3, 3, "the unit of '30 s' is not one of length"),
    ("bounce,height\n0,100\n1,30 cm\n", 2, 3, "this number has no unit"),
    ("bounce,height_cm\n0,100\n1,64 (predicted)\n", 3, 3, "no reading"),
    ("bounce,height_cm\n0,100\n1,> 60\n", 3, 3, "a bound and no reading"),
    ("bounce,height_cm\n0,100\n1,30,5\n", 3, 6, "3 cells, but the header names 2"),
    ("bounce,height_mm\n0,2000\n1,\"1,305\"\n", 3, 3, "has a comma in a table separated by commas"),
    ("bounce;height_cm\n0;1.000.5\n", 2, 3, "write a plain number"),
    ("bounce,height_cm\n0,100\n1.5,30\n", 3, 1, "whole numbers"),
    ("bounce,height_cm\n0,100\n-1,30\n", 3, 1, "whole numbers"),
    ("bounce,height_cm\n0,100\n1,30\n1,31\n2,10\n", 4, 1, "given twice"),
    ("bounce,height\n0,100\n", 1, 8, "give --height-unit cm"),
    ("time\n1\n2\n", 1, 1, "give --time-unit s"),
    ("bounce,height_kg\n0,100\n", 1, 8, "'kg' in 'height_kg' is not a unit of length"),
    ("bounce,height (s)\n0,100\n", 1, 8, "'s' in 'height (s)' is not a unit of length"),
    ("bounce,time_cm\n0,100\n", 1, 8, "is not a unit of time"),
    ("bounce,hoighte_cm\n0,100\n", 1, 8, "did you mean 'height_cm'?"),
    ("bounce,wobble\n0,100\n", 1, 8, "'wobble' is not known"),
    ("bounce,height_cm,wobble\n0,100,big\n1,64,small\n", 1, 18, "--group 'wobble'"),
    ("height_cm,wobble\n100,3\n64,4\n", 1, 11, "The word 'wobble' is not understood"),
    ("event,time_s\ncontact,0.1\nboing,0.4\n", 3, 1, "'boing' is not known"),
    ("event,time_s\ncontact,0.1\n,0.4\n", 3, 1, "the event is empty"),
    ("event,time_s,height_cm\ncontact,,\n", 2, 9, "a contact needs a time"),
    ("event,time_s,height_cm\ncontact,0.1,20\n", 2, 13, "height of the floor"),
    ("event,time_s,height_cm\napex,,\n", 2, 7, "neither a time nor a height"),
    ("event,time_s,height_cm\nrelease,0,100\ncontact,0.45,\ncontact,0.40,\n", 4, 9, "earlier than"),
    ("bounce,time_s\n1,0.5\n2,0.5\n", 3, 3, "the same as"),
    ("interval_s\n0.5\n-0.4\n", 3, 1, "cannot be negative"),
    ("100\n30\n10\n", 1, 1, "heights or times"),
    ("0,100\n1,30\n", 1, 1, "no header"),
    ("bounce,trial 1,trial 2\n0,100,100\n", 1, 8, "in which unit?"),
    ("# c\n\nbounce,height_cm\n\n# d\n0,100\n\n1,oops\n", 8, 3, "'oops' is not a number"),
    ("\"bounce\",\"note, long\",\"height_cm\"\n\"0\",\"a, b\",\"oops\"\n", 2, 12, "'oops' is not a number"),
    ("bounce,note,height_cm\n0,\"two\nlines\",oops\n", 3, 8, "'oops' is not a number"),
    ("bounce,bounce_number,height_cm\n", 1, 8, "means the same as a column before it"),
    ("frame,y_px\n0,1\n", 1, 1, "--fps"),
    ("time_s,y_m\n0,1\n0.1,0.9\n0.1,0.8\n", 4, 1, "stands in line 3 too"),
    ("time_s,y_m\n0,1\n0.1,up\n", 3, 5, "'up' is not a number"),
    ("time_s,y_m,y_m\n0,1,1\n", 1, 12, "two columns are named"),
    ("t,x,y\n0,1,1\n", 1, 1, "--time-unit"),
    ("bounce,height_cm\n0,100\n1,-30\n", 3, 3, "--zero"),
    ("bounce,time\n1,0:01.25\n2,0:0x\n", 3, 3, "'0:0x' is not a number"),
];

#[test]
fn a_refusal_names_line_and_column() {
    for &(text, line, column, part) in REFUSALS {
        let error = refuse(text);
        let shown = error.to_string();
        assert_eq!((error.line(), error.column()), (Some(line), Some(column)), "{text:?}\n{shown}");
        assert!(shown.contains(part), "{text:?}\n{shown}");
        assert!(shown.starts_with(&format!("table.csv:{line}:{column}: ")) && shown.contains('^'), "{shown}");
        assert!(shown.contains("\n  help: ") || shown.contains("write") || shown.contains("unit"), "{shown}");
    }
}

#[test]
fn a_refusal_of_the_whole_file_says_what_to_do() {
    for (bytes, part) in [
        (&b""[..], "the file is empty"),
        (b"\n \n\n", "the file is empty"),
        (b"# only\n# comments\n", "comments only"),
        (b"bounce,height_cm\n", "a header and no rows"),
        (b"bounce,height_cm\n\n,\n", "a header and no rows"),
        (b"bounce,note\n1,a\n", "no column holds heights or times"),
        (b"PK\x03\x04anything", "this archive cannot be read"),
        (b"\xD0\xCF\x11\xE0anything", "this workbook cannot be read"),
        (b"\x00\x01\x02\x03", "not a text file"),
    ] {
        let error = refuse_with(bytes, &ReadOptions::default());
        assert!(error.to_string().contains(part) && error.to_string().contains("help: "), "{error}");
        assert_eq!(error.line(), None);
    }
}

#[test]
fn files_that_are_not_there_or_no_files() {
    let here = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let directory = Table::read(here, &ReadOptions::default()).unwrap_err();
    assert!(directory.to_string().contains("this is a directory"), "{directory}");
    let missing = Table::read(&here.join("no-such-table.csv"), &ReadOptions::default()).unwrap_err();
    assert!(missing.to_string().contains("there is no such file"), "{missing}");
}

#[test]
fn lists_in_code_are_checked_too() {
    for list in [&[][..], &[1.0, f64::NAN], &[1.0, f64::INFINITY], &[1.0, -0.5]] {
        assert!(Table::from_heights(list).is_err(), "{list:?}");
        assert!(Table::from_contacts(list).is_err(), "{list:?}");
    }
    assert!(Table::from_contacts(&[1.0, 1.0]).is_err());
}

#[test]
fn a_long_line_is_cut_around_the_caret() {
    let text = format!("bounce,note,height_cm\n0,{},oops\n", "é".repeat(500));
    let error = refuse(&text).to_string();
    assert!(error.lines().all(|line| line.chars().count() < 120), "{error}");
    let lines: Vec<&str> = error.lines().collect();
    let caret = lines[2].chars().position(|c| c == '^').unwrap();
    assert_eq!(lines[1].chars().skip(caret).take(4).collect::<String>(), "oops", "{error}");
}

/// Reads and fits whatever it is; only that it ends matters.
fn swallow(bytes: &[u8]) {
    for options in
        [ReadOptions::default(), ReadOptions::default().height_unit("cm"), ReadOptions::default().time_unit("s")]
    {
        match Table::parse("any", bytes, &options) {
            Ok(table) => {
                let report = Fit::new().run(&table).expect("a report, be it a refusal");
                let json = serde_json::to_string(&report).unwrap();
                assert!(!report.to_string().is_empty() && !json.contains("NaN"));
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
}

#[test]
fn no_number_of_a_bounce_is_too_large() {
    swallow(b"h18446744073709551615_cm\n65\n67\n");
}

const SEEDS: [&str; 6] = [
    include_str!("tables/frames.csv"),
    include_str!("tables/semicolons.csv"),
    include_str!("tables/trials.csv"),
    include_str!("tables/wide.csv"),
    include_str!("tables/intervals.csv"),
    include_str!("tables/rebounds.csv"),
];

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(400), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_bytes_are_too_much(bytes in proptest::collection::vec(any::<u8>(), 0..300)) {
        swallow(&bytes);
    }

    #[test]
    fn no_text_is_too_much(text in "[a-z0-9,;\t\n\"#().:_ -]{0,200}") {
        swallow(text.as_bytes());
    }

    #[test]
    fn no_change_to_a_good_table_is_too_much(
        seed in 0usize..6,
        changes in proptest::collection::vec((0usize..250, prop_oneof![
            Just(b','), Just(b'\n'), Just(b'"'), Just(b'-'), Just(b'.'), Just(b'e'), Just(b'9'), Just(b'0'), Just(b';'), any::<u8>()
        ], 0u8..3), 1..6),
    ) {
        let mut bytes = SEEDS[seed].as_bytes().to_vec();
        for (at, byte, what) in changes {
            let at = at % bytes.len().max(1);
            match what {
                0 if !bytes.is_empty() => bytes[at] = byte,
                1 => bytes.insert(at, byte),
                _ if !bytes.is_empty() => { bytes.remove(at); }
                _ => {}
            }
        }
        swallow(&bytes);
    }

    #[test]
    fn no_numbers_are_too_much(cells in proptest::collection::vec(prop_oneof![
        any::<f64>(), Just(0.0), Just(1e-300), Just(1e300), 0.0..2.0f64
    ], 1..12)) {
        let rows: String = cells.iter().enumerate().map(|(n, x)| format!("{n},{x:e}\n")).collect();
        swallow(format!("bounce,height_m\n{rows}").as_bytes());
        swallow(format!("bounce,time_s\n{rows}").as_bytes());
        let rows: String = cells.iter().enumerate().map(|(n, x)| format!("{n},{x:e},{:e}\n", x / 2.0)).collect();
        swallow(format!("bounce,time_s,height_m\n{rows}").as_bytes());
    }
}
