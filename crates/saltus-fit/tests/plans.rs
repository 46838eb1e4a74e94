//! A plan holds what it promises: the planned experiment is made, many times, with the errors of
//! its way, and fitted.

use crate::noise::Noise;
use saltus_fit::{Ball, Expected, Fit, Planned, ReadOptions, Readings, Table, Verdict, Way};

const G: f64 = 9.81;

/// One planned experiment as a table: heights with an error, contacts at the frame in which they
/// fall or with an error.
fn made(planned: &Planned, cor: f64, noise: &mut Noise) -> String {
    let heights = planned.way.readings() == Readings::Heights;
    let mut text = if heights { "trial,bounce,height_m\n" } else { "trial,bounce,time_s\n" }.to_owned();
    let frame = match planned.way {
        Way::Film30 => Some(1.0 / 30.0),
        Way::Film60 => Some(1.0 / 60.0),
        Way::Film120 => Some(1.0 / 120.0),
        Way::Film240 => Some(1.0 / 240.0),
        _ => None,
    };
    for trial in 0..planned.drops {
        let (mut height, mut at) = (1.0, noise.uniform());
        for n in 0..=planned.bounces {
            if heights {
                text += &format!("{trial},{n},{:.5}\n", height + noise.normal(planned.way.sigma()));
            } else {
                let read = frame.map_or_else(|| at + noise.normal(0.001), |frame| (at / frame).round() * frame);
                text += &format!("{trial},{},{read:.6}\n", n + 1);
            }
            height *= cor * cor;
            at += (8.0 * height / G).sqrt();
        }
    }
    text
}

#[test]
fn the_planned_experiment_brings_what_was_wanted() {
    let mut noise = Noise(77);
    for (want, cor) in [(0.005, 0.75), (0.01, 0.6), (0.003, 0.88)] {
        let fit = Fit::new().kind(Ball::Golf).drag(0.0).sigma_zero(0.0);
        let plan = fit.plan(want, Expected::new(cor, 1.0).unwrap()).unwrap();
        assert!(plan.ways.len() >= 5 && plan.ways.iter().filter(|planned| planned.enough).count() >= 4, "{plan}");
        for planned in plan.ways.iter().filter(|planned| planned.enough) {
            let sigma = planned.way.sigma();
            let fit = match planned.way.readings() {
                Readings::Heights => fit.sigma_height(sigma),
                _ => fit.sigma_time(sigma),
            };
            let (mut held, mut trusted, mut halves) = (0, 0, Vec::new());
            for _ in 0..40 {
                let text = made(planned, cor, &mut noise);
                let table = Table::parse("planned.csv", text.as_bytes(), &ReadOptions::default()).unwrap();
                let report = fit.run(&table).unwrap();
                let found = report.cor().unwrap_or_else(|| panic!("{report}"));
                halves.push(0.5 * (found.high - found.low));
                held += i32::from((found.low..=found.high).contains(&cor));
                trusted += i32::from(report.verdict() == Verdict::Trusted);
            }
            halves.sort_by(f64::total_cmp);
            assert!(halves[20] <= 1.1 * want, "{planned}: {} wanted {want}", halves[20]);
            // Not ten times as much as was needed either.
            assert!(planned.drops == 1 || halves[20] > 0.5 * want, "{planned}: {} wanted {want}", halves[20]);
            assert!(held >= 35 && trusted >= 33, "{planned}: {held} hold, {trusted} are trusted");
        }
    }
}

#[test]
fn better_ways_need_fewer_readings() {
    let fit = Fit::new().drag(0.0).sigma_zero(0.0);
    let plan = fit.plan(0.004, Expected::default()).unwrap();
    let of = |way: Way| plan.ways.iter().find(|planned| planned.way == way).unwrap().readings;
    assert!(of(Way::FilmedRuler) <= of(Way::Ruler), "{plan}");
    let films = [Way::Film30, Way::Film60, Way::Film120, Way::Film240, Way::Sound].map(of);
    assert!(films.is_sorted_by(|a, b| a >= b), "{films:?}");
    let sharper = fit.plan(0.002, Expected::default()).unwrap();
    assert!(sharper.ways.iter().zip(&plan.ways).all(|(a, b)| a.readings >= b.readings), "{sharper}\n{plan}");
}

/// What no number of drops removes is named, and is gone where it is stated.
#[test]
fn what_stands_in_the_way_is_named() {
    let open = Fit::new().plan(0.002, Expected::default()).unwrap();
    let heights = open.ways.iter().find(|planned| planned.way == Way::Ruler).unwrap();
    assert!(!heights.enough && open.to_string().contains("--sigma-zero"), "{open}");
    assert!(open.to_string().contains("--ball tennis"), "{open}");
    assert!(
        Fit::new().plan(0.0, Expected::default()).is_err() && Fit::new().plan(f64::NAN, Expected::default()).is_err()
    );
    assert!(Expected::new(1.0, 1.0).is_none() && Expected::new(0.7, 0.0).is_none());
}

/// A doubt comes with the next measurement, and one that is made so settles it.
#[test]
fn a_doubt_is_settled_by_what_comes_next() {
    let text = "# frame rate: 30\nevent,time_s,height_cm\nrelease,0,100\ncontact,0.45,\napex,,30\ncontact,0.85,\napex,,10\ncontact,1.11,\n";
    let table = Table::parse("study.csv", text.as_bytes(), &ReadOptions::default()).unwrap();
    let fit = Fit::new().gravity(9.8);
    let report = fit.run(&table).unwrap();
    let next = fit.next(&table, &report).unwrap().expect("a next measurement");
    // A zero of the heights that is off explains the table, and more heights would share it.
    assert_eq!(report.hypotheses()[0].name.at_fault(), Some(Readings::Heights), "{report}");
    assert_eq!(next.way.readings(), Readings::Times, "{next}");
    let (cor, mut noise) = (*report.cor().unwrap(), Noise(5));
    assert!(next.enough && next.drops == 5 && next.half_width < 0.25 * (cor.high - cor.low), "{next}");
    let text = made(&next, cor.value, &mut noise);
    let settled = fit.run(&Table::parse("next.csv", text.as_bytes(), &ReadOptions::default()).unwrap()).unwrap();
    let found = settled.cor().unwrap();
    assert_eq!(settled.verdict(), Verdict::Trusted, "{settled}");
    assert!(found.high - found.low < 0.6 * (cor.high - cor.low), "{settled}");
    assert!(fit.next(&table, &settled).unwrap().is_none());
}
