//! The fitting crate against tables: the study's own, and measurements made by other people, which
//! lie outside the project.
//!
//! The latter carry no licence and are read where they lie, in a folder `shared` beside the
//! project; without it those tests say so and pass. References are an analyst's, by numpy and
//! scipy: match them within three standard errors or 0.005, and their standard errors within a
//! factor of two.

use std::path::{Path, PathBuf};

use saltus_fit::{Fit, ReadOptions, Report, Table, Verdict};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The table of other people's, or `None` where it is not to be had.
fn borrowed(name: &str, options: &ReadOptions) -> Option<Table> {
    pooled(&[name], options)
}

/// Several tables of other people's as one.
fn pooled(names: &[&str], options: &ReadOptions) -> Option<Table> {
    let paths: Vec<PathBuf> = names.iter().map(|name| root().join("../shared/data").join(name)).collect();
    if let Some(path) = paths.iter().find(|path| !path.exists()) {
        eprintln!("skipped: {} is not here", path.display());
        return None;
    }
    match Table::read_all(&paths, options) {
        Ok(table) => Some(table),
        Err(error) => panic!("{error}"),
    }
}

/// The COR and its standard error.
fn cor(report: &Report) -> (f64, f64) {
    let cor = report.cor().expect("a COR");
    (cor.value, cor.standard_error.expect("its error"))
}

fn matches(report: &Report, reference: f64, error: f64) {
    let (value, found) = cor(report);
    assert!((value - reference).abs() <= (3.0 * error).max(0.005), "{value} is not {reference} ± {error}\n{report}");
    assert!(found <= 2.0 * error && found >= 0.5 * error, "an error of {found}, not of {error}\n{report}");
}

#[test]
fn the_study_s_table_contradicts_itself_and_the_report_says_so() {
    let path = root().join("examples/data/squash-on-cement.csv");
    let table = Table::read(&path, &ReadOptions::default()).expect("the study's table");
    let report = Fit::new().run(&table).expect("a report");
    assert_eq!(report.verdict(), Verdict::Doubtful);
    assert_eq!(report.table(), "squash-on-cement.csv");
    let agreement = report.agreement().expect("heights and times");
    assert!((agreement.chi_square - 73.24).abs() < 0.01 && agreement.degrees_of_freedom == 4);
    assert_eq!(report.hypotheses()[0].name, "height-zero");
}

#[test]
fn a_golf_ball_s_sounds_as_read_off_by_eye() {
    let Some(table) = borrowed("audio_ball/impact_times.csv", &ReadOptions::default()) else { return };
    let report = Fit::new().sigma_time(0.005).run(&table).expect("a report");
    matches(&report, 0.8960, 0.0004);
    let times = &report.estimates()[0];
    assert!((times.chi_square.expect("chi-square") - 10.1).abs() < 0.05 && times.degrees_of_freedom == Some(9));
    assert_eq!(report.verdict(), Verdict::Trusted);
}

#[test]
fn the_same_sounds_by_their_onset() {
    let options = ReadOptions::default().column("time_s_onset_25pct");
    let Some(table) = borrowed("audio_ball/impact_times.csv", &options) else { return };
    matches(&Fit::new().sigma_time(0.005).run(&table).expect("a report"), 0.8953, 0.0004);
}

#[test]
fn the_sounds_of_an_earlier_ball() {
    let Some(table) = borrowed("audio_ball/impact_times_earlier_ball.csv", &ReadOptions::default()) else { return };
    let report = Fit::new().sigma_time(0.010).run(&table).expect("a report");
    matches(&report, 0.7916, 0.0023);
    let times = &report.estimates()[0];
    assert!((times.chi_square.expect("chi-square") - 9.6).abs() < 0.05 && times.degrees_of_freedom == Some(6));
}

#[test]
fn twenty_launches_of_a_golf_ball() {
    let options = ReadOptions::default().filter("ball", "golf");
    let Some(table) = borrowed("phyphox_golf_tennis/events_long.csv", &options) else { return };
    assert_eq!(table.trials().len(), 20);
    let report = Fit::new().run(&table).expect("a report");
    matches(&report, 0.8960, 0.0010);
    assert_eq!(report.verdict(), Verdict::Trusted);
    // With a stated reading error the bounces scatter far more than that; the COR and its error
    // stay.
    matches(&Fit::new().sigma_time(0.002).run(&table).expect("a report"), 0.8960, 0.0010);
}

#[test]
fn five_launches_of_a_tennis_ball() {
    let options = ReadOptions::default().filter("ball", "tennis");
    let Some(table) = borrowed("phyphox_golf_tennis/events_long.csv", &options) else { return };
    matches(&Fit::new().run(&table).expect("a report"), 0.7610, 0.0012);
}

#[test]
fn a_tennis_ball_s_intervals_from_five_heights() {
    for (height, reference) in [("65", 0.763), ("55", 0.771), ("45", 0.764), ("35", 0.762), ("25", 0.756)] {
        let options = ReadOptions::default().filter("h0_cm", height);
        let Some(table) = borrowed("phyphox_golf_tennis/tennis_intervals_typed.csv", &options) else { return };
        let report = Fit::new().run(&table).expect("a report");
        let (value, error) = cor(&report);
        assert!((value - reference).abs() <= (3.0 * error).max(0.005), "{height} cm: {value} is not {reference}");
        assert!(error < 0.005, "{height} cm: {error}");
    }
}

#[test]
fn a_drop_without_a_bounce_is_refused() {
    let Some(table) = borrowed("tracker_drop/black_ball.txt", &ReadOptions::default()) else { return };
    let report = Fit::new().run(&table).expect("a report");
    assert_eq!(report.verdict(), Verdict::Refused);
    assert!(report.reason().contains("no bounce"), "{}", report.reason());
}

#[test]
fn a_telephone_s_workbooks_as_they_are() {
    let names = [1, 2, 3, 4, 5].map(|n| format!("phyphox_golf_tennis/tennis/Lancio {n}, tennis, 65.xls"));
    let Some(table) = pooled(&names.each_ref().map(String::as_str), &ReadOptions::default()) else { return };
    assert_eq!(table.trials().len(), 5);
    matches(&Fit::new().run(&table).expect("a report"), 0.7610, 0.0012);
}

#[test]
fn launches_side_by_side_in_sheets_named_by_their_height() {
    let names = ["phyphox_golf_tennis/CR_method2.xlsx", "phyphox_golf_tennis/data_golfball.xlsx"];
    let Some(table) = pooled(&names, &ReadOptions::default()) else { return };
    assert_eq!(table.trials().len(), 20);
    matches(&Fit::new().run(&table).expect("a report"), 0.8960, 0.0010);
    // The same launches as somebody copied them into one table.
    let long = borrowed("phyphox_golf_tennis/events_long.csv", &ReadOptions::default().filter("ball", "golf"));
    let contacts = |table: &Table| table.trials().iter().map(|t| t.readings().len()).sum::<usize>();
    assert_eq!(Some(contacts(&table)), long.as_ref().map(contacts));
}

/// The lowest and the highest sample of a series, in metres, and how long it lasts.
fn extent(table: &Table, trial: usize) -> (f64, f64, f64) {
    let readings = table.trials()[trial].readings();
    let heights = || readings.iter().filter_map(|r| r.height);
    let (low, high) = (heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max));
    (low, high, readings.last().and_then(|r| r.time).expect("a time"))
}

#[test]
fn tracks_of_pixels_are_turned_the_right_way_up() {
    let options = ReadOptions::default().fps(200.0);
    let Some(marble) = borrowed("marble_200fps/HT-2-M.csv", &options) else { return };
    assert_eq!((marble.trials().len(), marble.trials()[0].readings().len()), (1, 198));
    let (low, high, end) = extent(&marble, 0);
    assert!(low == 0.0 && (203.0..206.0).contains(&high) && (end - 0.99).abs() < 1e-9, "{low} {high} {end}");
    assert!(
        marble.notes().iter().any(|note| note.to_string().contains("hardly moves: track 2")),
        "{:?}",
        marble.notes()
    );

    let options = ReadOptions::default().fps(100.0).scale(1.371 / 911.0);
    let names = [5, 6, 7, 8, 9].map(|n| format!("tabletennis_100fps/tracked-{n}.txt"));
    let Some(table) = pooled(&names.each_ref().map(String::as_str), &options) else { return };
    assert_eq!(table.trials().len(), 5);
    for trial in 0..5 {
        let (low, high, _) = extent(&table, trial);
        assert!(low == 0.0 && (0.3..3.0).contains(&high), "{trial}: {low} {high}");
    }
}
