//! What no ball does is doubted, and what some balls do is not: each limit of the model is met from
//! both sides.

use crate::film::{Ball, Contact, csv, noisy, report};
use crate::noise::Noise;
use saltus_fit::{FindingKind, Fit, ReadOptions, Report, Severity, Table};

fn ball(cor: fn(f64) -> f64, drag: f64) -> Ball {
    Ball { drop: 1.0, release: 0.05, gravity: 9.81, drag, cor, contact: Contact::Instant }
}

fn filmed(ball: &Ball, seconds: f64) -> Report {
    report(&csv(&noisy(&ball.film(120.0, seconds), &mut Noise(41), 1e-3)))
}

fn doubted(report: &Report, kind: fn(&FindingKind) -> bool) -> bool {
    report.findings().iter().any(|finding| finding.severity == Severity::Doubt && kind(&finding.kind))
}

/// The limit is 0.995.
#[test]
fn a_film_that_keeps_all_of_its_speed_is_doubted() {
    let keeps = |cor: fn(f64) -> f64| {
        doubted(&filmed(&ball(cor, 0.0), 2.5), |k| matches!(k, FindingKind::KeepsAll | FindingKind::GainsSpeed))
    };
    assert!(keeps(|_| 0.999) && !keeps(|_| 0.97));
}

/// The limit is 0.5 /m.
#[test]
fn the_drag_of_no_ball_is_doubted() {
    let unphysical = |drag: f64| {
        let report = filmed(&ball(|_| 0.8, drag), 2.0);
        (doubted(&report, |k| matches!(k, FindingKind::DragUnphysical { .. })), report)
    };
    for (drag, expected) in [(0.13, false), (0.3, false), (1.5, true)] {
        let (found, report) = unphysical(drag);
        assert_eq!(found, expected, "{drag}: {report}");
    }
}

/// The limit is 5 %.
#[test]
fn films_in_pixels_share_their_gravity() {
    let differ = |scale: f64| {
        let mut noise = Noise(43);
        let mut text = "trial,time_s,y_px\n".to_owned();
        for (trial, scale) in [600.0, 600.0 * scale].into_iter().enumerate() {
            for (t, h) in noisy(&ball(|_| 0.8, 0.0).film(120.0, 2.0), &mut noise, 1e-3) {
                text += &format!("{trial},{t:.5},{:.3}\n", 900.0 - scale * h);
            }
        }
        let table = Table::parse("films.csv", text.as_bytes(), &ReadOptions::default()).unwrap();
        let report = Fit::new().run(&table).unwrap();
        doubted(&report, |k| matches!(k, FindingKind::GravitiesDiffer { .. }))
    };
    assert!(differ(1.12) && !differ(1.02));
}

/// The limit is an interval of 0.25.
#[test]
fn an_interval_of_a_quarter_of_all_balls_is_doubted() {
    let vague = |sigma: f64| {
        let table = Table::from_heights(&[1.0, 0.49, 0.24]).unwrap();
        let report = Fit::new().sigma_height(sigma).sigma_zero(0.0).drag(0.0).run(&table).unwrap();
        let cor = *report.cor().unwrap();
        (doubted(&report, |k| matches!(k, FindingKind::Vague { .. })), cor.high - cor.low)
    };
    let (few, many) = (vague(0.05), vague(0.12));
    assert!(!few.0 && few.1 > 0.1 && many.0 && many.1 < 0.5, "{few:?} {many:?}");
}
