//! Heights and times: do they agree, and do their readings bear a COR at all?

use super::judgement::{Cor, Judgement, LEVEL};
use super::single::single;
use crate::compare::explain::Agreement;
use crate::elementary::{exp, hypot};
use crate::evidence::{at, has};
use crate::finding::{Basis, By, Finding, FindingKind, Severity, Widening};
use crate::quantity::{Measured, Method, Readings, Source, Sourced};
use crate::read::{Event, Reading};
use crate::solve::bounces::BounceCor;
use crate::solve::fits::Fits;
use crate::statistics::{FAR as OUT, Line, SURELY};

/// Times that do not follow from the others are a doubt if there is one for fewer than so many that
/// do.
const ADRIFT: usize = 3;
/// The COR of the first flight, which needs gravity and the height of release, is shown where it is
/// so many standard errors away.
const FAR: f64 = 3.0;
/// A trend of heights over which the COR changes by less than this is of no size, though readings
/// that were worked out scatter by so little that it shows.
const NOUGHT: f64 = 1e-3;

/// Judges the fits of heights and times: the COR, and what speaks against it.
pub(crate) fn judge(judgement: &mut Judgement, fits: &Fits<'_>, agreement: Option<&Agreement>) {
    let assumed = |readings, sigma: Sourced| has(fits.table, readings) && sigma.source == Source::Assumed;
    let heights = assumed(Readings::Heights, fits.sigma_height);
    let times = assumed(Readings::Times, fits.sigma_time);
    if heights || times {
        judgement.note(FindingKind::SigmaAssumed { heights, times });
    }
    if agreement.is_some_and(Agreement::rejected) {
        judgement.doubt(FindingKind::Disagree);
        judgement.cor = spanning(fits);
        return;
    }
    let chosen = methods(judgement, fits, agreement.is_none());
    if let Some(kind) = first_flight_differs(fits, chosen) {
        judgement.note(kind);
    }
    match (chosen, fits.mean(Method::FirstFlight)) {
        (Some(cor), _) => {
            judgement.cor = cor;
            match cor {
                Some(_) => judgement.note(FindingKind::RestsOn { basis: basis(fits) }),
                None => judgement.refuse(FindingKind::Undetermined),
            }
        }
        (None, Some(first)) => {
            judgement.cor = Cor::of(first);
            judgement.doubt(FindingKind::FirstFlightAlone);
        }
        (None, None) => none(judgement, fits),
    }
    small_trend(judgement, fits);
}

/// A COR that changes by little from flight to flight may be called one: the trend is worth a word,
/// and the interval takes in both ends of it. What a trend of heights comes of, the comparison of
/// models says, unless it is of no size.
fn small_trend(judgement: &mut Judgement, fits: &Fits<'_>) {
    let high = fits.heights.is_some();
    let cor = |bounce: &BounceCor| if high { bounce.heights } else { bounce.times };
    let cors: Vec<(f64, Measured)> =
        fits.bounces.iter().filter_map(|bounce| Some((bounce.bounce as f64, cor(bounce)?))).collect();
    let trend = |f: &&mut Finding| matches!(f.kind, FindingKind::Trend { .. }) && f.severity == Severity::Doubt;
    let (Some(first), Some(last)) = (cors.first(), cors.last()) else { return };
    let Some(found) = judgement.findings.iter_mut().find(trend) else { return };
    let line = Line::through(cors.iter().map(|(n, cor)| (cor.standard_error.powi(-2), *n, cor.value)));
    let (first, last) = (line.at(first.0), line.at(last.0));
    if (last - first).abs() <= if high { NOUGHT } else { LEVEL } {
        found.severity = Severity::Note;
        judgement.reach(first.min(last), first.max(last), Widening::EveryImpact);
    }
}

/// The COR by the sharpest of the methods that agree; none where no method applies, and none within
/// where one that applies has no range.
fn methods(judgement: &mut Judgement, fits: &Fits<'_>, alone: bool) -> Option<Option<Cor>> {
    let table = (fits.table.trials(), fits.evidence);
    let joint = fits.joint.as_ref();
    let both = joint.map_or(0, |joint| joint.trials.len());
    let mut chosen = None;
    // By heights alone and by times alone, from more trials than have both.
    let mut wider = Vec::new();
    if let Some(kind) = &fits.heights {
        let heights = single(judgement, kind, table, alone);
        wider.extend((kind.estimate.trials > both).then_some((Readings::Heights, kind.estimate.trials, heights)));
        chosen = Some(heights);
    }
    contradicted(judgement, fits);
    mostly_left_out(judgement, fits);
    if let Some(kind) = &fits.times {
        let times = single(judgement, kind, table, alone);
        wider.extend((kind.estimate.trials > both).then_some((Readings::Times, kind.estimate.trials, times)));
        let by = |readings| By { readings: Some(readings), trials: None };
        chosen = Some(match chosen {
            Some(heights) if joint.is_none() => {
                either(judgement, (by(Readings::Heights), heights), (by(Readings::Times), times))
            }
            _ => times,
        });
    }
    if let Some(joint) = joint {
        let by_both = By { readings: None, trials: Some(both) };
        let mut whole = Cor::of(&joint.estimate);
        for (readings, trials, cor) in wider {
            let by_one = By { readings: Some(readings), trials: Some(trials) };
            whole = either(judgement, (by_one, cor), (by_both, whole));
        }
        if let Some(spread) = joint.spread {
            judgement.note(FindingKind::DropsDiffer { spread, drops: both });
        }
        chosen = Some(whole);
    }
    chosen
}

/// The COR of the first flight and the release height, where it is not that of the other readings.
fn first_flight_differs(fits: &Fits<'_>, chosen: Option<Option<Cor>>) -> Option<FindingKind> {
    let cor = chosen.flatten()?;
    let first = fits.mean(Method::FirstFlight).filter(|_| fits.joint.is_none()).and_then(Cor::of)?;
    let error = hypot(first.standard_error.unwrap_or(0.0), cor.standard_error.unwrap_or(0.0));
    let differs = (first.value - cor.value).abs() > FAR * error;
    differs.then_some(FindingKind::FirstFlightDiffers { cor: first.value })
}

/// The range that covers what every method says, for a table whose columns contradict each other.
fn spanning(fits: &Fits<'_>) -> Option<Cor> {
    let all = fits.estimates();
    let unbounded = [Method::HeightsUnbounded, Method::TimesUnbounded];
    let bounded = || all.iter().filter(|e| !unbounded.contains(&e.method));
    let low = bounded().filter_map(|e| e.low).min_by(f64::total_cmp)?;
    let high = bounded().filter_map(|e| e.high).max_by(f64::total_cmp)?;
    let value = |method: Method, instead: Method| {
        let find = |of: Method| all.iter().find(|e| e.method == of).and_then(|e| e.value);
        find(method).or(find(instead))
    };
    let heights = value(Method::HeightsMean, Method::Heights);
    let middle = match (heights, value(Method::TimesMean, Method::Times)) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        (Some(a), None) | (None, Some(a)) => a,
        (None, None) => 0.5 * (low + high),
    };
    Some(Cor::within(middle.clamp(low, high), low, high))
}

/// Whether fewer than half of the times belong to the bounces that were found: among so many, some
/// agree by chance.
fn mostly_left_out(judgement: &mut Judgement, fits: &Fits<'_>) {
    if fits.times.is_none() {
        return;
    }
    let readings = fits.table.trials().iter().flat_map(|trial| trial.readings());
    let timed = |reading: &&Reading| matches!(reading.event, Event::Contact | Event::Apex) && reading.time.is_some();
    let read = readings.filter(timed).count();
    let used: usize = fits.evidence.trials.iter().map(|trial| trial.moments.len()).sum();
    let adrift = fits.evidence.adrift;
    if 2 * used < read {
        judgement.doubt(FindingKind::FewFollow { read, used });
    } else if ADRIFT * adrift >= used {
        judgement.doubt(FindingKind::Adrift { read, adrift });
    }
}

/// A rebound read as zero that the fitted heights do not allow.
fn contradicted(judgement: &mut Judgement, fits: &Fits<'_>) {
    let Some(kind) = &fits.heights else { return };
    let found = fits.evidence.trials.iter().zip(&kind.fitted.own).find_map(|(trial, own)| {
        // A trial with a single height has no level of its own.
        let level = own.first().filter(|_| trial.heights.len() > 1)?;
        let height = |n: usize| exp(level + 2.0 * n as f64 * kind.fitted.shared[0]);
        let too_high = |n: &&usize| height(**n) > OUT * fits.sigma_height.value;
        trial.zeros.iter().find(too_high).map(|&n| (trial.trial, height(n), n))
    });
    if let Some((trial, height_m, bounce)) = found {
        let place = at(fits.table, trial).bounce(bounce);
        judgement.findings.push(Finding::doubt(FindingKind::ZeroTooHigh { height_m }).at(place));
    }
}

/// Two methods on different trials: the sharper of the two, if they agree.
fn either(judgement: &mut Judgement, first: (By, Option<Cor>), second: (By, Option<Cor>)) -> Option<Cor> {
    let (Some(a), Some(b)) = (first.1, second.1) else { return first.1.or(second.1) };
    let (s, t) = (a.standard_error.unwrap_or(f64::INFINITY), b.standard_error.unwrap_or(f64::INFINITY));
    if (a.value - b.value).abs() > SURELY * hypot(s, t) {
        let (first, second) = (first.0, second.0);
        judgement.doubt(FindingKind::MethodsDiffer { first, first_cor: a.value, second, second_cor: b.value });
        return Some(Cor::within(0.5 * (a.value + b.value), a.low.min(b.low), a.high.max(b.high)));
    }
    if s <= t { Some(a) } else { Some(b) }
}

/// What a trusted COR rests on.
fn basis(fits: &Fits<'_>) -> Basis {
    let trials = fits.evidence.trials.len();
    if let Some(joint) = &fits.joint {
        return match (joint.spread, joint.trials.len()) {
            (Some(_), _) => Basis::BothInEach,
            (None, both) if both < trials => Basis::BothInSome { both, trials },
            (None, _) => Basis::Both,
        };
    }
    let spread = fits.times.as_ref().and_then(|k| k.spread).or(fits.heights.as_ref().and_then(|k| k.spread));
    match (spread, &fits.heights, &fits.times) {
        (Some(_), ..) => Basis::Mean,
        (None, Some(_), Some(_)) => Basis::Both,
        (None, Some(_), None) => Basis::One { readings: Readings::Heights },
        (None, None, _) => Basis::One { readings: Readings::Times },
    }
}

/// Why there is no COR, or at most a limit.
fn none(judgement: &mut Judgement, fits: &Fits<'_>) {
    if let Some(cor) = fits.ratio.as_ref().and_then(Cor::of) {
        judgement.cor = Some(cor);
        judgement.doubt(FindingKind::NoReboundRead { high: cor.high });
        return;
    }
    let contacts = fits.evidence.trials.iter().map(|t| t.moments.len()).max().unwrap_or(0);
    let heights = fits.evidence.trials.iter().map(|t| t.heights.len()).max().unwrap_or(0);
    judgement.refuse(match (heights, contacts) {
        (0 | 1, 0) => FindingKind::OneHeight,
        (0 | 1, 1) => FindingKind::OneContact,
        (0 | 1, 2) => FindingKind::OneFlight,
        _ => FindingKind::Undetermined,
    });
}
