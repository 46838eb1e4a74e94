//! Files as programs write them are read as they are, and say what they were taken for.

use std::path::PathBuf;

use crate::written::{cells, workbook, xlsx, zip};
use allocation_counter::measure;
use saltus_fit::{Event, ReadOptions, Table, TableError};

fn read(bytes: &[u8], options: &ReadOptions) -> Table {
    Table::parse("file", bytes, options).unwrap_or_else(|error| panic!("{error}"))
}

fn refuse(bytes: &[u8], options: &ReadOptions) -> TableError {
    Table::parse("file", bytes, options).expect_err("a refusal")
}

fn plain() -> ReadOptions {
    ReadOptions::default()
}

/// Times and heights of the samples of a trial.
fn samples(table: &Table, trial: usize) -> Vec<(f64, f64)> {
    let of = |r: &saltus_fit::Reading| (r.event == Event::Sample).then_some((r.time?, r.height?));
    table.trials()[trial].readings().iter().map(|r| of(r).expect("a sample")).collect()
}

fn times(table: &Table, trial: usize) -> Vec<f64> {
    table.trials()[trial].readings().iter().filter(|r| r.event == Event::Contact).filter_map(|r| r.time).collect()
}

fn says(table: &Table, part: &str) {
    assert!(table.notes().iter().any(|note| note.to_string().contains(part)), "no '{part}' in {:?}", table.notes());
}

#[test]
fn tracker_writes_one_track_or_several() {
    let expected = [(0.0, 1.0), (0.04, 0.9), (0.08, 0.7)];
    for text in [
        "t\ty\tx\n0.0\t1.0\t0\n0.04\t9.0E-1\t0\n0.08\t0.7\t0\n",
        "cm_A\nt\tx\ty\n0.0\t0\t1.0\n0.04\t0\t0.9\n0.08\t0\t0.7\n",
        "mass A\t\t\t\nt\tx\ty\tv_{y}\n0\t0\t1\t\n0.04\t0\t0.9\t-5\n0.08\t0\t0.7\t\n",
        ",mass A,,,\nt,frame,x,y,\n0,10,0,1,\n0.04,11,0,0.9,\n0.08,12,0,0.7,\n",
        "mass A;;\nt;x;y\n0;0;1\n0,04;0;0,9\n0,08;0;0,7\n",
    ] {
        let table = read(text.as_bytes(), &plain());
        assert_eq!(samples(&table, 0), expected, "{text:?}");
        says(&table, "Tracker");
    }
    let multi = "#multi:\n\tball\t\t\tedge\t\nt\tframe\tx\ty\tx\ty\n0\t1\t0\t1\t5\t5\n0.04\t2\t0\t0.9\t5\t5.001\n0.08\t3\t0\t0.7\t\t\n";
    let moving = read(multi.as_bytes(), &plain());
    assert_eq!((moving.trials().len(), samples(&moving, 0)), (1, expected.to_vec()));
    says(&moving, "left aside, as it hardly moves: edge");
    let edge = read(multi.as_bytes(), &plain().column("edge"));
    assert_eq!(samples(&edge, 0)[0], (0.0, 5.0));
    // By themselves these names may be anybody's, and the unit anything.
    let anybody = refuse(b"t,x,y\n0,0,1\n0.04,0,0.9\n", &plain());
    assert_eq!((anybody.line(), anybody.column()), (Some(1), Some(1)), "{anybody}");
}

#[test]
fn imagej_counts_frames_and_has_more_tracks_than_balls() {
    let text = "Frame\tX1\tY1\tFlag1\tX2\tY2\tFlag2\nTracks 1 to 2\n1\t5\t100\t \t9\t50\t \n2\t5\t104\t*\t9\t50.5\t \n\
                3\t5\t112\t \t \t \t \n\nTrack \tLength\tDistance traveled\tNr of Frames\n1\t9\t9\t3\n2\t1\t1\t2\n";
    let table = read(text.as_bytes(), &plain().fps(100.0));
    assert_eq!(samples(&table, 0), [(0.01, 12.0), (0.02, 8.0), (0.03, 0.0)]);
    says(&table, "ImageJ");
    says(&table, "hardly moves: track 2");
    says(&table, "count downwards");
    let scaled = read(text.as_bytes(), &plain().fps(100.0).scale(0.002).zero(112.0).y_down(true));
    assert!((samples(&scaled, 0)[0].1 - 0.024).abs() < 1e-12);
    assert_eq!(samples(&read(text.as_bytes(), &plain().fps(100.0).column("Y2")), 0).len(), 2);
    let rate = refuse(text.as_bytes(), &plain());
    assert!(rate.to_string().contains("--fps") && rate.line() == Some(1), "{rate}");
    assert!(refuse(text.as_bytes(), &plain().fps(100.0).column("Y7")).to_string().contains("no track 'Y7'"));
}

#[test]
fn bare_pixels_need_a_frame_rate_and_no_more() {
    let down: Vec<f64> = (0..12).map(|n| 300.0 + 0.5 * f64::from(n * n)).collect();
    let expected: Vec<(f64, f64)> = down.iter().enumerate().map(|(n, y)| (n as f64 / 50.0, 360.5 - y)).collect();
    let rows =
        |row: &dyn Fn(usize, f64) -> String| down.iter().enumerate().map(|(n, &y)| row(n, y)).collect::<String>();
    for text in [
        rows(&|_, y| format!("{y}\n")),
        rows(&|n, y| format!("{};{y};\n", [7, 5, 6][n % 3])),
        rows(&|n, y| format!("{n},{y}\n")),
        rows(&|n, y| format!("{n},17.5,{y}\n")),
        rows(&|n, y| format!("{},17.5,{y}\n", n as f64 / 50.0)),
    ] {
        let table = read(text.as_bytes(), &plain().fps(50.0));
        let found = samples(&table, 0);
        let near = |(a, b): (&(f64, f64), &(f64, f64))| (a.0 - b.0).abs() < 1e-12 && (a.1 - b.1).abs() < 1e-9;
        assert!(found.len() == 12 && found.iter().zip(&expected).all(near), "{text}\n{found:?}");
        says(&table, "count downwards");
    }
    let pixels = rows(&|_, y| format!("7;{y};\n"));
    let rate = refuse(pixels.as_bytes(), &plain());
    assert!(rate.to_string().contains("--fps 100") && rate.line() == Some(1), "{rate}");
    let scaled = read(pixels.as_bytes(), &plain().fps(50.0).scale(0.001));
    assert!((samples(&scaled, 0)[0].1 - 0.0605).abs() < 1e-12);
}

#[test]
fn vernier_writes_csv_and_text() {
    let expected = [(0.0, 1.0), (0.1, 0.9), (0.2, 0.6)];
    for text in [
        "Latest: Time (s),Latest: Position (m)\n0,1\n0.1,0.9\n0.2,0.6\n",
        "Latest: Time (s);Latest: Position (m);Latest: Velocity (m/s)\n0;1;\n0,1;0,9;-2\n0,2;0,6;-3\n",
        "Vernier Format 2\nlab 1/22/2002 12:51:07\nRun one\nTime\tPosition\nt\ty\ns\tcm\n\n0\t100\n0.1\t90\n0.2\t60\n0\t0\n",
        "Vernier Format 2\nby hand\nData Set\nTime\tDistance\nseconds\tcentimeters\n0\t100\n0.1\t90\n0.2\t60\n",
    ] {
        assert_eq!(samples(&read(text.as_bytes(), &plain()), 0), expected, "{text}");
    }
    let runs = "Run 1: Time (s),Run 1: Position (m),Run 2: Time (s),Run 2: Position (m)\n0,1,0,2\n0.1,0.9,0.1,1.9\n0.2,0.6,,\n";
    let table = read(runs.as_bytes(), &plain());
    assert_eq!((table.trials().len(), table.trials()[1].label()), (2, "Run 2"));
    assert_eq!((samples(&table, 0), samples(&table, 1)), (expected.to_vec(), vec![(0.0, 2.0), (0.1, 1.9)]));
    let sets = "Vernier Format 3\nx\nA\nTime\tPoz\nt\ty\ns\tm\n\n0\t1\n0.1\t0.9\n0\t0\nVernier Format 3\nx\nB\nTime\tPosition\nt\ty\ns\tm\n\n0\t2\n";
    let broken = refuse(sets.as_bytes(), &plain());
    assert_eq!((broken.line(), broken.column()), (Some(4), Some(1)), "{broken}");
    let two = read(sets.replace("Poz\n", "Position\n").as_bytes(), &plain());
    assert_eq!((two.trials().len(), samples(&two, 1)), (2, vec![(0.0, 2.0)]));
}

#[test]
fn phyphox_writes_its_events_three_times() {
    let all = "Event time (s),Interval (s)\n0.5,0.4\n0.9,0.3\n1.2,0\n";
    let less = "Event time (s),Interval (s)\n0.5,0.4\n0.9,0\n";
    let about = "property,value\nversion,1.1.16\n";
    let book = xlsx(&[
        ("Simple", cells(less)),
        ("Multiple", cells(less)),
        ("All", cells(all)),
        ("Metadata Device", cells(about)),
    ]);
    let archive = zip(&[("Simple.csv", less), ("Multiple.csv", less), ("All.csv", all), ("meta/device.csv", about)]);
    for bytes in [book, archive] {
        let table = read(&bytes, &plain());
        assert_eq!((table.trials().len(), times(&table, 0)), (1, vec![0.5, 0.9, 1.2]));
        says(&table, "sheets read: All");
        assert_eq!(times(&read(&bytes, &plain().sheet("Simple")), 0).len(), 2);
        let none = refuse(&bytes, &plain().sheet("Energy"));
        assert!(none.to_string().contains("no such sheet") && none.to_string().contains("Multiple"), "{none}");
    }
    // The heights of this experiment are computed from its times, and tell nothing more.
    let energy = "Bounce 0 (s),Height 0 (m),Bounce 1 (s),Height 1 (m),Energy 1,Bounce 2 (s),Height 2 (m),Energy 2\n\
                  0.5,0.3,0.9,0.196,1,1.2,0.11,0.56\n";
    let table = read(energy.as_bytes(), &plain());
    assert_eq!((times(&table, 0), table.trials()[0].readings().len()), (vec![0.5, 0.9, 1.2], 3));
    says(&table, "computes them from the times");
}

#[test]
fn launches_side_by_side_and_sheets_named_by_their_height() {
    let sheet = "Event time (s),Interval (s),,Event time (s),Interval (s)\n0.5,0.4,,0.6,0.5\n0.9,0,,1.1,0\n";
    let book = xlsx(&[("80 cm ", cells(sheet)), ("1.1 m", cells(sheet))]);
    let table = read(&book, &plain());
    let trials: Vec<(&str, Option<f64>)> = table.trials().iter().map(|t| (t.label(), t.readings()[0].height)).collect();
    let (low, high) = (Some(0.8), Some(1.1));
    let expected = [("80 cm, run 1", low), ("80 cm, run 2", low), ("1.1 m, run 1", high), ("1.1 m, run 2", high)];
    assert_eq!(trials, expected);
    assert_eq!(times(&table, 3), [0.6, 1.1]);
}

#[test]
fn an_error_in_a_workbook_names_sheet_and_cell() {
    let book = xlsx(&[("drops", cells("bounce,height (cm)\n0,100\n1,thirty\n"))]);
    let error = refuse(&book, &plain());
    assert_eq!((error.line(), error.column()), (Some(3), Some(2)));
    let shown = error.to_string();
    assert!(shown.starts_with("file, sheet 'drops', cell B3: 'thirty' is not a number"), "{shown}");
}

#[test]
fn stopwatches_write_minutes_and_seconds() {
    let table = read(b"H (cm),T0,T1,T2\n100,0:01.25,0:01.85,1:02.30\n", &plain());
    assert_eq!(times(&table, 0), [1.25, 1.85, 62.3]);
    assert_eq!(table.trials()[0].readings()[0].height, Some(1.0));
    assert_eq!(times(&read(b"time (s)\n00:00:01.5\n00:01:01.5\n", &plain()), 0), [1.5, 61.5]);
}

#[test]
fn text_in_every_encoding() {
    let text = "# Höhe\nbounce;height (cm)\n0;100\n1;64,5\n";
    let utf16 = |to: fn(u16) -> [u8; 2], mark: bool| -> Vec<u8> {
        let mark = mark.then_some(0xFEFF).into_iter();
        mark.chain(text.encode_utf16()).flat_map(to).collect()
    };
    let latin: Vec<u8> = text.chars().map(|c| c as u8).collect();
    let read = |bytes: &[u8]| read(bytes, &plain()).trials()[0].readings()[1].height;
    for bytes in [
        text.as_bytes().to_vec(),
        utf16(u16::to_le_bytes, true),
        utf16(u16::to_be_bytes, true),
        utf16(u16::to_le_bytes, false),
        latin,
        text.replace('\n', "\r").into_bytes(),
    ] {
        assert_eq!(read(&bytes), Some(0.645), "{bytes:?}");
    }
}

#[test]
fn a_header_from_outside_replaces_the_one_inside() {
    let expected = Some(0.64);
    for (text, header) in [
        ("Sprung;Höhe\n0;100\n1;64\n", &["bounce", "height_cm"][..]),
        ("0,x,100\n1,y,64\n", &["bounce", "-", "height_cm"]),
        ("100\n64\n", &["height_cm"]),
    ] {
        let table = read(text.as_bytes(), &plain().header(header));
        assert_eq!(table.trials()[0].readings()[1].height, expected, "{text}");
    }
}

#[test]
fn a_series_may_be_shuffled_repeated_stacked_and_gappy() {
    let fall = |t: f64| 1.0 - 5.0 * t * t;
    let row = |n: i32| format!("{},{}\n", f64::from(n) / 100.0, fall(f64::from(n) / 100.0));
    let table = |rows: &[String]| read(format!("time_s,y_m\n{}", rows.concat()).as_bytes(), &plain());
    let straight = table(&(0..20).map(row).collect::<Vec<_>>());
    assert_eq!(samples(&straight, 0).len(), 20);
    for order in [|n: i32| 19 - n, |n: i32| (7 * n) % 20] {
        let other = table(&(0..20).map(|n| row(order(n))).collect::<Vec<_>>());
        assert_eq!(samples(&other, 0), samples(&straight, 0));
    }
    let twice = table(&(0..20).flat_map(|n| [row(n), row(n)]).collect::<Vec<_>>());
    assert_eq!(samples(&twice, 0), samples(&straight, 0));
    let stacked = table(
        &(0..40).map(|n| row(n % 20).replace(",1\n", if n < 20 { ",1\n" } else { ",1.01\n" })).collect::<Vec<_>>(),
    );
    assert_eq!(stacked.trials().len(), 2);
    says(&stacked, "2 recordings");
    let lost = table(&["0,1\n", "0.1,NaN\n", "0.2,\n", "0.3,inf\n", "0.4,0.2\n", "0.5,0.1\n"].map(str::to_owned));
    assert_eq!(samples(&lost, 0).len(), 3);
}

#[test]
fn upside_down_is_noticed_or_asked_for() {
    let rows = |sign: f64| -> String {
        (0..30)
            .map(|n| format!("{},{}\n", 0.01 * f64::from(n), 2.0 + sign * 5.0 * (0.01 * f64::from(n)).powi(2)))
            .collect()
    };
    let (up, down) = (format!("time_s,y_m\n{}", rows(-1.0)), format!("time_s,y_m\n{}", rows(1.0)));
    let heights = |table: &Table| samples(table, 0).into_iter().map(|(_, h)| h).collect::<Vec<_>>();
    let (straight, turned) = (read(up.as_bytes(), &plain()), read(down.as_bytes(), &plain()));
    assert_eq!(heights(&straight)[0], 2.0);
    assert!(heights(&turned)[0] > 0.4 && heights(&turned)[29] == 0.0);
    says(&turned, "count downwards");
    let told = read(down.as_bytes(), &plain().y_down(false));
    assert_eq!(heights(&told)[0], 2.0);
    let floor = read(b"bounce,height_cm\n0,10\n1,46\n", &plain().y_down(true).zero(110.0));
    assert_eq!(floor.trials()[0].readings()[1].height, Some(0.64));
    let zero = read(b"bounce,height_cm\n0,102\n1,66\n", &plain().zero(2.0));
    assert_eq!(zero.trials()[0].readings()[1].height, Some(0.64));
}

#[test]
fn several_files_are_one_experiment() {
    let folder = std::env::temp_dir().join(format!("saltus-files-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let write = |name: &str, text: &str| -> PathBuf {
        std::fs::write(folder.join(name), text).unwrap();
        folder.join(name)
    };
    let a = write("a.csv", "# gravity: 9.81 m/s^2\nbounce,height_cm\n0,100\n1,64\n2,41\n");
    let b = write("b.csv", "bounce;height_mm\n0;1000\n1;650\n2;420\n");
    let copy = write("copy.csv", "bounce;height_mm\n0;1000\n1;650\n2;420\n");
    let moon = write("moon.csv", "# gravity: 1.62 m/s^2\nbounce,height_cm\n0,100\n1,64\n");
    let table = Table::read_all(&[&a, &b, &copy], &plain()).unwrap();
    assert_eq!((table.trials().len(), table.trials()[1].label(), table.gravity()), (2, "b.csv", Some(9.81)));
    assert_eq!(table.name(), "a.csv and 2 more");
    assert!(Table::read_all(&[&a, &moon], &plain()).unwrap_err().to_string().contains("different gravity"));
    let missing = Table::read_all(&[a, folder.join("none.csv")], &plain()).unwrap_err();
    assert!(missing.to_string().contains("none.csv: there is no such file"), "{missing}");
    assert!(Table::read_all(&[] as &[&str], &plain()).is_err());
    std::fs::remove_dir_all(&folder).unwrap();
}

/// The most that a few bytes may make of themselves, in bytes: the 128 MB that are unpacked, and
/// as much again for a buffer that grows.
const MOST_UNPACKED: u64 = 256 << 20;

#[test]
fn a_small_archive_that_unpacks_to_much_is_refused() {
    let zeros = "0".repeat(130 << 20);
    let bomb = zip(&[("all.csv", &zeros)]);
    assert!(bomb.len() < 1 << 20);
    assert!(refuse(&bomb, &plain()).to_string().contains("unpacks to more than 128 MB"));
    // Two cells as far apart as a sheet allows are two cells, not seventeen thousand million.
    let far = "<row r=\"1\"><c r=\"A1\"><v>1</v></c></row><row r=\"1048576\"><c r=\"XFD1048576\"><v>2</v></c></row>";
    let two = workbook(&[("far", far.to_owned())]);
    let used = measure(|| drop(refuse(&two, &plain())));
    assert!(used.bytes_max < MOST_UNPACKED, "{used:?}");
    let wide: String = (1..9000).map(|n| format!("<row r=\"{n}\"><c r=\"XFD{n}\"><v>2</v></c></row>")).collect();
    assert!(refuse(&workbook(&[("wide", wide)]), &plain()).to_string().contains("hold more than 128 MB"));
}

#[test]
fn reading_twice_the_rows_takes_twice_the_allocations() {
    let allocations = |count: u32| {
        let row = |n: u32| format!("{},{}\n", f64::from(n) / 240.0, 1.0 + f64::from(n % 100) / 100.0);
        let text = format!("time_s,y_m\n{}", (0..count).map(row).collect::<String>());
        let mut table = None;
        let used = measure(|| table = Some(read(text.as_bytes(), &plain())));
        assert_eq!(samples(&table.expect("a table"), 0).len(), count as usize);
        used.count_total
    };
    assert!(allocations(20_000) <= 20 * allocations(1000));
}

#[test]
fn tables_of_a_school_lab() {
    let pairs = |text: &str, options: &ReadOptions| -> Vec<(f64, f64)> {
        let table = read(text.as_bytes(), options);
        let of = |t: &saltus_fit::Trial| (t.readings()[0].height.unwrap(), t.readings()[1].height.unwrap());
        table.trials().iter().map(of).collect()
    };
    // Trials beside a drop height are its rebounds, not the bounces of one ball.
    let expected = [(1.0, 0.64), (1.0, 0.65), (0.8, 0.51)];
    let text = "Drop,Trial 1,Trial 2,Average\n100,64,65,64.5\n80,51,,51\n";
    assert_eq!(pairs(text, &plain().height_unit("cm")), expected);
    let text = "Drop height (cm),Trial 1 (cm),Trial 2 (cm),Mean (cm)\n100,64,65,64.5\n80,51,,51\n";
    assert_eq!(pairs(text, &plain()), expected);
    let text = "Ball drop\n3 May, by hand\n\nBounce,Height (cm)\n0,100\n1,64\n".replace(", by", " by");
    assert_eq!(pairs(&text, &plain()), [(1.0, 0.64)]);
    assert_eq!(
        samples(&read(b"t y\n0.00 1.00\n0.04 0.99\n", &plain().height_unit("m").time_unit("s")), 0)[1],
        (0.04, 0.99)
    );
    assert_eq!(samples(&read("Zeit (s);Höhe (cm)\n0,0;100\n0,1;95,1\n".as_bytes(), &plain()), 0)[1], (0.1, 0.951));
}

#[test]
fn wrong_units_and_frame_rates_are_suspected() {
    let warned = |bytes: &[u8], options: &ReadOptions, part: &str| {
        let report = saltus_fit::Fit::new().run(&read(bytes, options)).unwrap();
        assert!(report.warnings().iter().any(|w| w.contains(part)), "no '{part}' in {:?}", report.warnings());
    };
    warned(b"bounce,height_cm\n0,1\n1,0.64\n2,0.41\n", &plain(), "0.01 m, in line 2: is that the right unit?");
    let fall: String = (0..40).map(|n| format!("{n},{}\n", 1.0 - 4.905 * (f64::from(n) / 120.0).powi(2))).collect();
    let text = format!("frame,y_m\n{fall}");
    warned(text.as_bytes(), &plain().fps(30.0), "120 frames a second would be right");
    let slow: String = (0..40)
        .map(|n| format!("{:.4},{}\n", f64::from(n) / 30.0, 1.0 - 4.905 * (f64::from(n) / 120.0).powi(2)))
        .collect();
    let told = "runs 4.0 times slower than life, as a film shot at 120 frames a second and played at 30;";
    warned(format!("time_s,y_m\n{slow}").as_bytes(), &plain(), told);
    assert!(saltus_fit::Fit::new().run(&read(text.as_bytes(), &plain().fps(120.0))).unwrap().warnings().is_empty());
}

/// A workbook of `OpenDocument`: rows of cells, numbers as numbers, the rest as text.
fn open_workbook(rows: &str) -> Vec<u8> {
    let cell = |cell: &str| match cell.parse::<f64>() {
        Ok(number) => format!(
            "<table:table-cell office:value-type=\"float\" office:value=\"{number}\"><text:p>{number:.0}</text:p></table:table-cell>"
        ),
        Err(_) if cell.is_empty() => "<table:table-cell table:number-columns-repeated=\"1\"/>".to_owned(),
        Err(_) => format!(
            "<table:table-cell office:value-type=\"string\"><office:annotation><text:p>a remark</text:p></office:annotation><text:p>{cell}</text:p></table:table-cell>"
        ),
    };
    let row =
        |line: &str| format!("<table:table-row>{}</table:table-row>", line.split(',').map(cell).collect::<String>());
    let rows = rows.lines().map(row).collect::<String>();
    content(&format!(
        "<table:table table:name=\"Drops\">{rows}<table:table-row table:number-rows-repeated=\"1048000\"><table:table-cell table:number-columns-repeated=\"16000\"/></table:table-row></table:table>"
    ))
}

fn content(tables: &str) -> Vec<u8> {
    let hidden = "<style:style style:name=\"h\"><style:table-properties table:display=\"false\"/></style:style>";
    zip(&[("content.xml", &format!("<office:document-content>{hidden}{tables}</office:document-content>"))])
}

fn of(bytes: &[u8]) -> Result<Table, TableError> {
    Table::parse("drops.ods", bytes, &ReadOptions::default())
}

#[test]
fn open_workbooks_are_read() {
    let rows = "drop height (cm),,rebound height (cm)\n200,,128.4\n150,,95.6\n100,,64.1\n";
    let heights = |table: &Table| -> Vec<Option<f64>> {
        table.trials().iter().flat_map(|t| t.readings()).map(|r| r.height).collect()
    };
    let plain = read(rows.as_bytes(), &plain());
    assert_eq!(heights(&of(&open_workbook(rows)).unwrap()), heights(&plain));
    let hidden = "<table:table table:name=\"x\" table:style-name=\"h\"><table:table-row><table:table-cell office:value-type=\"string\"><text:p>height (cm)</text:p></table:table-cell></table:table-row><table:table-row><table:table-cell office:value-type=\"float\" office:value=\"3\"/></table:table-row></table:table>";
    assert!(of(&content(hidden)).is_err());
}

/// What a few bytes claim to repeat takes neither the memory nor the time that it would.
#[test]
fn what_an_open_workbook_repeats_is_bounded() {
    for (rows, columns, text) in
        [(1, 16_000_000, "1"), (4_000_000_000_u32, 1, "1"), (4_000_000_000, 4_000_000_000_u32, "word")]
    {
        let cell = format!(
            "<table:table-cell table:number-columns-repeated=\"{columns}\" office:value-type=\"string\"><text:p>{text}</text:p></table:table-cell>"
        );
        let table = format!(
            "<table:table table:name=\"x\"><table:table-row table:number-rows-repeated=\"{rows}\">{cell}</table:table-row></table:table>"
        );
        let used = measure(|| assert!(of(&content(&table)).is_err(), "{rows} {columns}"));
        assert!(used.bytes_max < MOST_UNPACKED, "{rows} {columns} {used:?}");
    }
}
