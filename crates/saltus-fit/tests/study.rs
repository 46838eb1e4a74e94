//! The study's table of a squash ball on cement, number by number.

use saltus_fit::{Estimate, Fit, ReadOptions, Report, Source, Table, Verdict};

const STUDY: &str = "# frame rate: 30\n# gravity: 9.8 m/s^2\nevent,time_s,height_cm\nrelease,0,100\ncontact,0.45,\n\
                     apex,,30\ncontact,0.85,\napex,,10\ncontact,1.11,\n";

fn report(fit: Fit) -> Report {
    let table = Table::parse("squash.csv", STUDY.as_bytes(), &ReadOptions::default()).unwrap();
    fit.run(&table).unwrap()
}

fn by<'a>(report: &'a Report, method: &str) -> &'a Estimate {
    report.estimates().iter().find(|e| e.method == method).unwrap()
}

fn close(found: f64, expected: f64, tolerance: f64) {
    assert!((found - expected).abs() <= tolerance, "{found} is not {expected} ± {tolerance}");
}

#[test]
fn bounce_by_bounce_heights_and_times_contradict_each_other() {
    let report = report(Fit::new());
    let [first, second] = report.bounces() else { panic!("two bounces") };
    close(first.heights.unwrap().value, 0.548, 0.0005);
    close(first.heights.unwrap().standard_error, 0.010, 0.001);
    close(second.heights.unwrap().value, 0.577, 0.0005);
    close(second.heights.unwrap().standard_error, 0.031, 0.002);
    close(first.times.unwrap().value, 0.443, 0.0005);
    close(first.times.unwrap().standard_error, 0.015, 0.001);
    close(second.times.unwrap().value, 0.650, 0.0005);
    close(by(&report, "heights-mean").value.unwrap(), 0.1f64.powf(0.25), 1e-12);
    close(by(&report, "times-mean").value.unwrap(), 0.536, 0.0005);
    close(by(&report, "first-flight").value.unwrap(), 0.443, 0.0005);
    close(by(&report, "times").value.unwrap(), 0.65, 1e-9);
    assert_eq!((by(&report, "times").degrees_of_freedom, by(&report, "times").p), (Some(0), None));
}

#[test]
fn one_cor_for_everything_is_ruled_out() {
    let report = report(Fit::new());
    let joint = by(&report, "joint");
    close(joint.value.unwrap(), 0.496, 0.0005);
    let agreement = report.agreement().unwrap();
    close(agreement.chi_square, 73.24, 0.01);
    assert_eq!(agreement.degrees_of_freedom, 4);
    close(agreement.p.unwrap(), 4.7e-15, 0.5e-15);
    let predicted: Vec<f64> = agreement.conflicts.iter().map(|c| c.predicted_s).collect();
    for (found, expected) in predicted.iter().zip([0.4518, 0.9466, 1.2323]) {
        close(*found, expected, 0.000_06);
    }
    close(agreement.conflicts[1].frames.unwrap(), -2.9, 0.05);
    close(agreement.conflicts[2].frames.unwrap(), -3.7, 0.05);
    close(agreement.largest_conflict_frames.unwrap(), 3.7, 0.05);
    close(agreement.largest_conflict_s.unwrap(), 0.1223, 0.0001);
    for (flight, expected) in agreement.flights.iter().zip([9.88, 15.0, 11.83]) {
        close(flight.gravity, expected, 0.01);
    }
}

#[test]
fn the_verdict_is_doubtful_and_the_range_covers_every_method() {
    let report = report(Fit::new());
    assert_eq!(report.verdict(), Verdict::Doubtful);
    let cor = report.cor().unwrap();
    for (method, value) in [("heights", 0.55), ("heights-mean", 0.562), ("times-mean", 0.536), ("joint", 0.496)] {
        assert!(cor.low < value && value < cor.high, "{method}");
    }
    assert!(cor.low < 0.443 && cor.high > 0.650 && cor.standard_error.unwrap() > 0.05, "{cor:?}");
    assert_eq!(report.sigma_height().unwrap().source, Source::Assumed);
    assert_eq!(report.sigma_time().unwrap().source, Source::FrameRate);
    close(report.sigma_time().unwrap().value, 0.009_623, 1e-6);
    assert_eq!((report.gravity().value, report.gravity().source), (9.8, Source::Table));
}

#[test]
fn a_height_zero_that_is_off_is_offered_with_its_test() {
    let report = report(Fit::new());
    let best = &report.hypotheses()[0];
    assert_eq!(best.name, "height-zero");
    close(best.cor.unwrap().value, 0.4995, 0.0005);
    close(best.cor.unwrap().standard_error, 0.004, 0.0005);
    close(best.offset_m.unwrap().value, 0.0536, 0.0005);
    close(best.offset_m.unwrap().standard_error, 0.007, 0.0007);
    close(best.chi_square, 14.2, 0.01);
    assert_eq!(best.degrees_of_freedom, 3);
    close(best.p.unwrap(), 0.003, 0.0005);
    let generous = best.generous.as_ref().unwrap();
    assert_eq!((generous.sigma_height, generous.degrees_of_freedom), (0.02, 3));
    close(generous.sigma_time, 1.0 / 30.0, 1e-12);
    close(generous.chi_square, 1.6, 0.01);
    close(generous.p.unwrap(), 0.66, 0.005);
    assert!(best.settle.contains("lay the ball on the floor"));
    let own = report.hypotheses().iter().find(|h| h.name == "cor-per-bounce").unwrap();
    close(own.chi_square, 72.0, 0.5);
    assert_eq!(own.degrees_of_freedom, 3);
    let lag = report.hypotheses().iter().find(|h| h.name == "clock-lag").unwrap();
    assert!(lag.p.unwrap() < 1e-8);
}

#[test]
fn a_generous_reading_still_does_not_trust_it_blindly() {
    let report = report(Fit::new().sigma_height(0.02).sigma_time(1.0 / 30.0));
    let agreement = report.agreement().unwrap();
    close(agreement.chi_square, 11.23, 0.01);
    close(agreement.p.unwrap(), 0.024, 0.001);
}

#[test]
fn a_total_time_validates_nothing() {
    let report = report(Fit::new());
    let total = report.agreement().unwrap().total_time.clone().unwrap();
    close(total.cor, 0.4892, 0.0001);
    close(total.heights_m[0], 0.239, 0.0005);
    close(total.heights_m[1], 0.0573, 0.0005);
}

#[test]
fn the_text_tells_it_in_a_few_lines() {
    let text = report(Fit::new()).to_string();
    for part in [
        "squash.csv: DOUBTFUL\n",
        "Heights and times do not agree on one COR.",
        "0.548 ± 0.010",
        "0.577 ± 0.030",
        "0.443 ± 0.015",
        "0.650 ± 0.049",
        "0.562 ± 0.014",
        "0.536 ± 0.014",
        "chi-square 73 on 4",
        "p = 5e-15",
        "-2.9 frames",
        "-3.7 frames",
        "5.4 ± 0.7 cm",
        "14.2 on 3",
        "1.6 on 3 (p = 0.66)",
        "lay the ball on the floor",
        "validates nothing",
        "Do not extrapolate to rest",
        "heights ± 1 cm (assumed)",
        "times ± 9.6 ms",
    ] {
        assert!(text.split_whitespace().collect::<Vec<_>>().join(" ").contains(part.trim()), "{part}\n{text}");
    }
    assert!(text.lines().all(|line| line.chars().count() <= 100), "{text}");
    assert!(text.lines().count() < 45, "{text}");
}

#[test]
fn the_motion_is_that_of_the_joint_fit() {
    let report = report(Fit::new());
    let motion = report.motion().unwrap();
    close(motion.cor, 0.496, 0.0005);
    assert_eq!((motion.release_height, motion.contacts.len(), motion.flights.len()), (Some(1.0), 3, 3));
    close(motion.contacts[1], 0.900, 0.0005);
    close(motion.contacts[2], 1.122, 0.0005);
    close(motion.apexes[0], 0.246, 0.0005);
    for pair in motion.flights.windows(2) {
        close(pair[0].start + pair[0].span, pair[1].start, 1e-12);
    }
    for flight in &motion.flights {
        let [a, b, c] = flight.height;
        close(a + flight.span * (b + flight.span * c), 0.0, 1e-12);
    }
    let labels: Vec<&str> = report.points().iter().map(|p| p.label.as_str()).collect();
    assert_eq!(labels, ["release", "contact 1", "apex 1", "contact 2", "apex 2", "contact 3"]);
    close(report.points()[2].time, 0.65, 1e-12);
    // The release height was taken as set: five readings remain, and their squares are the
    // chi-square.
    assert_eq!(report.residuals().len(), 5);
    let squares: f64 = report.residuals().iter().map(|r| r.z * r.z).sum();
    close(squares, 73.24, 0.01);
}
