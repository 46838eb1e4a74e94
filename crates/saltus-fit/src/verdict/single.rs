//! The COR of heights alone or of times alone, with what speaks against it.

use super::judgement::{Cor, Judgement, LEVEL, SAME};
use crate::compare::settings::{differ, differ_beside, drift};
use crate::evidence::{Evidence, TrialEvidence};
use crate::finding::{Finding, FindingKind, Widening};
use crate::model::{HARDEST, LOSSLESS};
use crate::quantity::{Readings, Source, Sourced};
use crate::read::Trial;
use crate::solve::kind::{Kind, one_kind};
use crate::solve::one::OneKind;
use crate::statistics::{REJECT, SURELY, rounding};

/// Readings whose scatter is more than this part of the largest of them hardly show a bounce.
const LOUD: f64 = 0.1;
/// A fit more probable than this has reading errors that were stated too large.
const TOO_GOOD: f64 = 0.999;

/// The scatter of the readings about the fit, as a part of the largest of them, where nobody stated
/// their error: the tallest height, the longest interval.
fn loudness<M: OneKind>(kind: &Kind<M>, trials: &[Trial]) -> f64 {
    let of_bounces = kind.scatter.unwrap_or(0.0);
    if kind.sigma.source != Source::Scatter {
        return of_bounces;
    }
    let between = |trial: &Trial| {
        let mut times: Vec<f64> = trial.readings().iter().filter_map(|reading| reading.time).collect();
        times.sort_unstable_by(f64::total_cmp);
        times.windows(2).map(|w| w[1] - w[0]).fold(0.0, f64::max)
    };
    let largest = if M::READINGS == Readings::Heights {
        trials.iter().flat_map(|trial| trial.readings()).filter_map(|reading| reading.height).fold(0.0, f64::max)
    } else {
        trials.iter().map(between).fold(0.0, f64::max)
    };
    of_bounces.max(kind.sigma.value / largest)
}

/// Whether rebounds stay where they are though the heights of release differ: they are nearer to
/// their mean than to any COR, though one COR would move them by more than chance can hide.
fn unmoved(evidence: &Evidence, cor: f64) -> Option<FindingKind> {
    let rebound = |trial: &TrialEvidence| match trial.heights[..] {
        [(0, release, _), (1, rebound, _), ..] => Some((release, rebound)),
        _ => None,
    };
    let pairs: Vec<(f64, f64)> = evidence.trials.iter().filter_map(rebound).collect();
    let count = pairs.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
    let (release, rebound_m) = (mean(|pair| pair.0), mean(|pair| pair.1));
    let sum = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(|pair| of(pair).powi(2)).sum::<f64>();
    let about_mean = sum(&|pair| pair.1 - rebound_m);
    let about_cor = sum(&|pair| pair.1 - cor * cor * pair.0);
    // If one COR were right, the two sums would differ by this, with a standard deviation of twice
    // its root times the error of a rebound.
    let moves = sum(&|pair| cor * cor * (pair.0 - release));
    // Rebounds that are rounded to the same number scatter less than they are read to.
    let read_to = rounding(&pairs.iter().map(|pair| pair.1).collect::<Vec<_>>());
    let error = (about_mean / (count - 1.0)).sqrt().max(read_to);
    let low_m = pairs.iter().map(|pair| pair.0).fold(f64::INFINITY, f64::min);
    let high_m = pairs.iter().map(|pair| pair.0).fold(0.0, f64::max);
    (pairs.len() > 2 && about_mean < about_cor && moves.sqrt() > 2.0 * SURELY * error).then_some(FindingKind::Unmoved {
        low_m,
        high_m,
        rebound_m,
    })
}

/// The COR of one kind of reading, with what speaks against it; `alone` where heights and times are
/// not fitted together.
pub(crate) fn single<M: OneKind>(
    judgement: &mut Judgement,
    kind: &Kind<M>,
    (trials, evidence): (&[Trial], &Evidence),
    alone: bool,
) -> Option<Cor> {
    let readings = M::READINGS;
    if let Some(free) = &kind.unbounded {
        judgement.doubt(FindingKind::Grows { readings, surely: free.low.is_some_and(|low| low > 1.0) });
        judgement.note(FindingKind::Unbounded { readings, cor: free.value.unwrap_or(1.0) });
        return Cor::of(free);
    }
    let mut cor = Cor::of(&kind.estimate)?;
    if kind.estimate.degrees_of_freedom == Some(0) && alone {
        judgement.doubt(FindingKind::JustEnough { readings });
    }
    scatter(judgement, kind, evidence, &mut cor);
    // Numbers that are level may be of drops that repeat each other.
    if cor.value > LOSSLESS || cor.value > HARDEST && cor.high >= 1.0 {
        judgement.doubt(FindingKind::Lossless { readings });
    }
    let differ = settings::<M>(judgement, kind, (trials, evidence), &mut cor);
    let beside = differ_beside(trials, kind.each(), cor.value).filter(|(_, d)| d.p < REJECT && !differ);
    if let Some((column, found)) = beside {
        cor = Cor::within(cor.value, cor.low.min(found.low.1), cor.high.max(found.high.1));
        judgement.widen(Widening::Settings);
        judgement.doubt(FindingKind::AsideDiffers { column, low: found.low, high: found.high, p: found.p });
    }
    if let Some(found) = unmoved(evidence, cor.value).filter(|_| readings == Readings::Heights) {
        judgement.doubt(found);
    }
    let part = loudness(kind, trials);
    if part > LOUD && !differ {
        judgement.doubt(FindingKind::Loud { readings, part });
    }
    if let Some(drift) = drift(trials, kind.each(), cor.value).filter(|d| d.p < REJECT && !differ) {
        let found = FindingKind::OrderDrift { first: drift.first, last: drift.last, p: drift.p };
        let apart = |end: f64| (end - cor.value).abs() > SAME;
        if drift.repeats && (apart(drift.first) || apart(drift.last)) {
            cor = Cor::within(
                cor.value,
                cor.low.min(drift.first).min(drift.last),
                cor.high.max(drift.first).max(drift.last),
            );
            judgement.widen(Widening::Settings);
        }
        let doubted = drift.repeats && (drift.last - drift.first).abs() > LEVEL;
        judgement.findings.push(if doubted { Finding::doubt(found) } else { Finding::note(found) });
    }
    if let Some(spread) = kind.spread.filter(|_| alone && !differ) {
        judgement.note(FindingKind::DropsDiffer { spread, drops: kind.estimate.trials });
    }
    if let Some(scatter) = kind.scatter {
        judgement.note(FindingKind::BouncesScatter { readings, scatter, sigma: kind.sigma });
    }
    if let Some(p) = kind.trend.filter(|p| *p < REJECT) {
        // Where the chi-square is tested and holds, or trials repeat each other, the trend is worth
        // a word, not a doubt.
        let held = kind.replicated || kind.estimate.p.is_some_and(|p| p >= REJECT);
        let trend = FindingKind::Trend { p };
        if held {
            judgement.note(trend);
        } else {
            judgement.doubt(trend);
        }
        judgement.note(FindingKind::TrendCauses);
    }
    Some(cor)
}

/// Whether the readings scatter as their errors say; where they scatter by more, the error of the
/// COR grows with it.
fn scatter<M: OneKind>(judgement: &mut Judgement, kind: &Kind<M>, evidence: &Evidence, cor: &mut Cor) {
    let (estimate, readings) = (&kind.estimate, M::READINGS);
    let (Some(p), Some(chi_square), Some(degrees_of_freedom)) =
        (estimate.p, estimate.chi_square, estimate.degrees_of_freedom)
    else {
        return;
    };
    let times = (chi_square / degrees_of_freedom as f64).sqrt();
    let misfit = FindingKind::Misfit { readings, chi_square, degrees_of_freedom };
    // Drops of one bounce each whose CORs differ by little have one COR.
    let single = |trial: &TrialEvidence| matches!(trial.heights[..], [(0, ..), (1, ..)]);
    let one = evidence.trials.iter().all(single) && kind.each().own.iter().all(|(_, shift)| shift.abs() <= LEVEL);
    match (p < REJECT, kind.replicated, kind.scatter) {
        // Drops that differ are named by themselves: reading errors explain every drop alone.
        (true, ..) if kind.spread.is_some() => {}
        (true, true, None) => judgement.note(FindingKind::SpreadDecides { readings, times }),
        (true, true, Some(_)) => {}
        // Bounces that scatter by little have one COR, whose error allows for it.
        (true, false, Some(scatter)) if scatter * cor.value <= LEVEL => {}
        (true, false, Some(_)) => judgement.doubt(misfit),
        (true, false, None) => {
            judgement.findings.push(if one { Finding::note(misfit) } else { Finding::doubt(misfit) });
            judgement.note(FindingKind::Widened { times });
            let centre = cor.value;
            (cor.low, cor.high) =
                ((centre - times * (centre - cor.low)).max(0.0), centre + times * (cor.high - centre));
            cor.standard_error = cor.standard_error.map(|s| s * times);
        }
        (false, ..) if p > TOO_GOOD && degrees_of_freedom > 2 => {
            judgement.note(FindingKind::ErrorsTooLarge { readings, times });
        }
        (false, ..) => {}
    }
}

/// Whether trials of different balls, floors or drop heights have different CORs; then the interval
/// takes in each of them.
fn settings<M: OneKind>(
    judgement: &mut Judgement,
    kind: &Kind<M>,
    (trials, evidence): (&[Trial], &Evidence),
    cor: &mut Cor,
) -> bool {
    let Some(mut differ) = differ(trials, kind.each(), cor.value).filter(|d| d.p < REJECT) else { return false };
    for (setting, cor) in [&mut differ.low, &mut differ.high] {
        *cor = of_setting::<M>(evidence, trials, setting, kind.sigma).unwrap_or(*cor);
    }
    let (low, high) = (cor.low.min(differ.low.1), cor.high.max(differ.high.1));
    *cor = Cor::within(cor.value, low, high);
    judgement.widen(Widening::Settings);
    let (low, high) = (differ.low, differ.high);
    judgement.doubt(FindingKind::SettingsDiffer { readings: M::READINGS, low, high, p: differ.p });
    judgement.note(FindingKind::MeanOfSettings);
    true
}

/// The COR of the trials of one setting by themselves; what all trials together say of it is linear
/// in how far it is from theirs.
fn of_setting<M: OneKind>(evidence: &Evidence, trials: &[Trial], setting: &str, sigma: Sourced) -> Option<f64> {
    let of = |t: &&TrialEvidence| trials.get(t.trial).is_some_and(|trial| trial.setting == setting);
    let own = Evidence::supposed(evidence.trials.iter().filter(of).cloned().collect());
    one_kind::<M>(&own, Some(sigma)).ok().flatten()?.estimate.value
}
