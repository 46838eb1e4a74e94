//! What the recordings amount to, and what speaks against it.

use super::track::Choice;
use super::{Pooled, Series, Track, in_metres};
use crate::bounces::Measured;
use crate::choice::ModelChoice;
use crate::estimate::Estimate;
use crate::model::Law;
use crate::report::{Cor, Report, Verdict, measured};
use crate::spread::across;
use crate::weigh::CLEAR;

/// A single impact is taken to last up to this, in seconds, as that of a squash ball does.
const LASTS: f64 = 0.01;
/// A motion that leaves this many times the noise does not follow the samples.
const ROUGH: f64 = 6.0;

/// Fills verdict, reason, COR, estimates and warnings from the series.
pub(crate) fn judge(report: &mut Report, series: &Series) {
    report.repairs.extend(series.repairs.iter().cloned());
    let Some(pooled) = &series.pooled else {
        report.verdict = Verdict::Refused;
        report.reason = series.refused.first().map_or_else(|| "the series is empty".to_owned(), |r| r.1.clone());
        if let Some(stated) = series.falls_upwards {
            report.warnings.push(std::mem::replace(&mut report.reason, stated.to_owned()));
        }
        report.warnings.extend(series.refused.iter().skip(1).map(|r| r.1.clone()));
        return;
    };
    report.warnings.extend(series.refused.iter().map(|r| r.1.clone()));
    let (law, drag) = pooled.choice;
    let name = |drag: bool| if drag { "series-drag" } else { "series" };
    let about = |drag: bool| {
        let air = if drag { "with quadratic air drag" } else { "without air drag" };
        format!("the whole motion through every sample, {air}; gravity, scale and floor are fitted")
    };
    let mut estimate =
        Estimate::new(name(drag), &about(drag), pooled.cor.value, pooled.cor.standard_error, pooled.quantile);
    estimate.trials = series.tracks.len();
    let mut doubts: Vec<String> = series.falls_upwards.iter().map(|&stated| stated.to_owned()).collect();
    let (mut low, mut high) = (estimate.low.unwrap_or(0.0), estimate.high.unwrap_or(1.0));
    report.estimates.push(estimate);
    let other = pooled.rivals.iter().find(|r| r.0.1 != drag);
    if let Some(&(_, cor, worse)) = other {
        let mut estimate = Estimate::new(name(!drag), &about(!drag), cor.value, cor.standard_error, pooled.quantile);
        estimate.trials = series.tracks.len();
        report.estimates.push(estimate);
        if drag && worse >= CLEAR {
            report.notes.push(format!(
                "air drag is needed: without it the BIC is {worse:.0} worse, and the COR would come out as {:.3}",
                cor.value
            ));
        }
    }
    for &(choice, cor, worse) in &pooled.rivals {
        report.models.push(ModelChoice::of_series(choice, cor, worse, choice == pooled.choice));
        let apart = (cor.value - pooled.cor.value).abs();
        if worse < CLEAR && apart > 2.0 * cor.standard_error.hypot(pooled.cor.standard_error) && apart > 0.005 {
            let about = |choice| ModelChoice::of_series(choice, cor, worse, false).about;
            doubts.push(format!(
                "two models fit the samples alike (BIC apart by {worse:.1}): {} gives a COR of {:.3}, {} one of {:.3}",
                about(pooled.choice),
                pooled.cor.value,
                about(choice),
                cor.value
            ));
            report.widen("it takes in both models");
            low = low.min(cor.value - pooled.quantile * cor.standard_error).max(0.0);
            high = high.max(cor.value + pooled.quantile * cor.standard_error);
        }
    }
    let contact = contact_time(&series.tracks);
    if let Some((other, worse)) = &series.otherwise {
        let (was, is) = (other.cor, pooled.cor);
        let apart = (was.value - is.value).abs();
        if let Some(lasts) = contact {
            report.notes.push(format!(
                "the ball stays {} on the floor at the first impact: with impacts that take no time the BIC is {worse:.1} worse, and the COR would come \
                 out as {:.3}",
                milliseconds(lasts),
                was.value
            ));
        }
        let undecided = *worse < CLEAR && apart > 2.0 * was.standard_error.hypot(is.standard_error) && apart > 0.005;
        if undecided {
            let (instant, lasting) = if contact.is_some() { (was, is) } else { (is, was) };
            doubts.push(format!(
                "two models fit the samples alike (BIC apart by {worse:.1}): the COR is {:.3} if impacts take no time, {:.3} if they do",
                instant.value, lasting.value
            ));
        }
        let reach = pooled.quantile * was.standard_error;
        let wider = was.value - reach < low || was.value + reach > high;
        // Every impact takes some time.
        if wider && *worse < CLEAR {
            report.widen("it takes in impacts that take time, and such that take none");
            low = low.min(was.value - reach).max(0.0);
            high = high.max(was.value + reach);
        }
    }
    if series.tracks.iter().all(|track| track.impacts.len() == 1) {
        let higher =
            |track: &Track| (1.0 - pooled.cor.value).max(0.0) * track.gravity.value * LASTS / track.impacts[0].speed;
        let higher = series.tracks.iter().map(higher).fold(0.0, f64::max);
        let lower = (low - higher).max(0.0);
        if lower < low && higher > 0.1 * pooled.cor.standard_error {
            report.widen(&format!(
                "one impact does not show how long it lasts, and a ball that stays {:.0} ms on the floor would have a COR lower by {higher:.3}",
                1e3 * LASTS
            ));
            low = lower;
        }
    }
    if varying(series, law, &mut doubts, (&mut low, &mut high)) {
        report.widen("it takes in the COR of every impact");
    }
    roughness(report, series, &mut doubts);
    gravity(report, &series.tracks);
    let e = pooled.cor;
    if e.value - 2.0 * e.standard_error > 1.0 {
        doubts.push("the ball gains speed at its impacts, as if each added energy".to_owned());
    }
    if series.tracks.len() == 1 {
        report.warnings.push(
            "one recording: its error is that of the fit; another drop of the same ball may differ by more".to_owned(),
        );
    }
    report.cor = Some(Cor { value: e.value, standard_error: Some(e.standard_error), low, high });
    report.verdict = if doubts.is_empty() { Verdict::Trusted } else { Verdict::Doubtful };
    let lasts = contact.map_or_else(String::new, |lasts| format!(", with impacts that last {}", milliseconds(lasts)));
    let air = match (drag, cause_is_open(pooled)) {
        (_, true) => ", with air drag or with a COR that depends on speed: the samples cannot tell which",
        (true, false) => ", with air drag",
        (false, false) => "",
    };
    report.reason = doubts.first().cloned().unwrap_or_else(|| match series.tracks.len() {
        1 => format!("one motion fits the series{air}{lasts}"),
        n => format!("one COR fits {n} series{air}{lasts}"),
    });
    report.warnings.extend(doubts.into_iter().skip(1));
}

/// The time of a contact, over all recordings that show one.
fn contact_time(tracks: &[Track]) -> Option<Measured> {
    let times: Vec<Measured> = tracks.iter().filter_map(|track| track.contact).collect();
    across(&times).map(|across| across.mean)
}

fn milliseconds(time: Measured) -> String {
    format!("{} ms", measured(1e3 * time.value, 1e3 * time.standard_error))
}

/// Whether air drag, and no drag but a COR that depends on speed, fit alike.
fn cause_is_open(pooled: &Pooled) -> bool {
    let one_of_two = |(law, drag): Choice| drag == (law == Law::Constant);
    let other =
        |rival: &(Choice, Measured, f64)| rival.0.1 != pooled.choice.1 && one_of_two(rival.0) && rival.2 < CLEAR;
    one_of_two(pooled.choice) && pooled.rivals.iter().any(other)
}

/// Whether the COR differs from impact to impact by more than errors and a hundredth; then the interval takes that in.
fn varying(series: &Series, law: Law, doubts: &mut Vec<String>, (low, high): (&mut f64, &mut f64)) -> bool {
    let Some(pooled) = series.pooled.as_ref().filter(|_| law != Law::Constant) else { return false };
    let by = |a: &&Measured, b: &&Measured| a.value.total_cmp(&b.value);
    let (Some(least), Some(most)) = (pooled.impacts.iter().min_by(by), pooled.impacts.iter().max_by(by)) else {
        return false;
    };
    let apart = most.value - least.value;
    let varies = apart > 0.01 && apart > 3.0 * most.standard_error.hypot(least.standard_error);
    if varies {
        doubts.push(format!(
            "the COR is not the same at every impact: from {:.3} to {:.3} (see the impacts)",
            least.value, most.value
        ));
        *low = low.min(least.value - 2.0 * least.standard_error).max(0.0);
        *high = high.max(most.value + 2.0 * most.standard_error);
    }
    varies
}

fn roughness(report: &mut Report, series: &Series, doubts: &mut Vec<String>) {
    let rough = |t: &&Track| {
        let range = t.course.apexes.iter().map(|a| a.1).fold(0.0, f64::max);
        t.rms > ROUGH * t.noise && t.rms > 0.01 * range
    };
    let worst: Vec<&Track> = series.tracks.iter().filter(rough).collect();
    if let Some(track) = worst.first() {
        doubts.push(format!(
            "the motion does not follow the samples: it leaves {:.2e} where they scatter by {:.2e}",
            track.rms, track.noise
        ));
    }
    for track in series.tracks.iter().filter(|t| t.drift.is_some()) {
        let drift = track.drift.map_or(0.0, |d| d.value);
        let range = track.course.apexes.iter().map(|a| a.1).fold(0.0, f64::max);
        report.warnings.push(format!(
            "trial {}: the floor drifts by {:.1} % of the drop a second, as if the camera turned; the fit allows for it",
            track.trial + 1,
            100.0 * drift / range
        ));
    }
    let wild: usize = series.tracks.iter().map(|t| t.left_out[2]).sum();
    let all: usize = series.tracks.iter().map(|t| t.samples).sum();
    if wild * 20 > all {
        report.warnings.push(format!("{wild} of {} samples are outliers: look at the tracking", wild + all));
    }
}

/// Gravity is fitted, so it tells whether scale and clock are right; the COR depends on neither.
fn gravity(report: &mut Report, tracks: &[Track]) {
    let found = tracks.iter().map(|t| t.gravity.value).sum::<f64>() / tracks.len() as f64;
    let expected = report.gravity.value;
    if !in_metres(found, expected) {
        report.warnings.push(format!(
            "the recording's gravity is {} {}/s², not {expected} m/s²: {}. The COR does not depend on it; speeds, drag and heights do",
            if found.abs() < 100.0 { format!("{found:.2}") } else { format!("{found:.0}") },
            if report.pixels { "px" } else { "units" },
            if report.pixels {
                "heights are in pixels (--scale says how large one is)"
            } else {
                "heights are in another unit, or the frame rate is another"
            }
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drag_and_a_cor_of_speed_may_be_alike() {
        let cor = Measured { value: 0.8, standard_error: 0.01 };
        let open = |choice: Choice, other: Choice, worse: f64| {
            let rivals = vec![(choice, cor, 0.0), (other, cor, worse)];
            cause_is_open(&Pooled { choice, cor, quantile: 2.0, rivals, impacts: Vec::new() })
        };
        let (drag, linear, plain) = ((Law::Constant, true), (Law::Linear, false), (Law::Constant, false));
        assert!(open(drag, linear, 2.4) && open(linear, drag, 2.4) && open(drag, (Law::Each, false), 5.9));
        // Another model is out of the question, or supposes both or neither of them.
        assert!(!open(drag, linear, 6.1) && !open(plain, drag, 1.0) && !open(drag, plain, 1.0));
        assert!(!open(drag, (Law::Linear, true), 1.0) && !open(linear, (Law::Linear, true), 1.0));
    }
}
