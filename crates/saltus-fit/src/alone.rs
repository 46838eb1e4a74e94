//! The COR of heights alone or of times alone, with what speaks against it.

use crate::diagnose::{REJECT, of};
use crate::estimate::{Kind, OneKind, Source, Sourced, one_kind};
use crate::evidence::{Evidence, TrialEvidence};
use crate::model::{Contacts, Heights};
use crate::report::{Cor, Report, duration};
use crate::settings::{differ, drift};
use crate::statistics::NORMAL;
use crate::table::Trial;

/// Readings whose scatter is more than this part of the largest of them hardly show a bounce.
const LOUD: f64 = 0.1;
/// A fit more probable than this has reading errors that were stated too large.
const TOO_GOOD: f64 = 0.999;
/// No ball is known to keep more of its speed.
const LOSSLESS: f64 = 0.995;

/// The scatter of the readings about the fit, as a part of the largest of them, where nobody stated their error: the tallest height, the longest interval.
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
    let largest = if M::METHOD == Heights::METHOD {
        trials.iter().flat_map(|trial| trial.readings()).filter_map(|reading| reading.height).fold(0.0, f64::max)
    } else {
        trials.iter().map(between).fold(0.0, f64::max)
    };
    of_bounces.max(kind.sigma.value / largest)
}

/// The COR of one kind of reading, with what speaks against it.
pub(crate) fn single<M: OneKind>(
    report: &mut Report,
    kind: &Kind<M>,
    (trials, evidence): (&[Trial], &Evidence),
    doubts: &mut Vec<String>,
) -> Option<Cor> {
    let estimate = &kind.estimate;
    let what = M::METHOD;
    if let Some(free) = &kind.unbounded {
        let grown = free.value.unwrap_or(1.0);
        let grows = free.low.is_some_and(|low| low > 1.0);
        doubts.push(if grows {
            format!("the {what} grow from bounce to bounce, as if each bounce added energy")
        } else {
            format!("within its error the COR of the {what} is not below 1: they do not shrink from bounce to bounce")
        });
        let between = if what == Contacts::METHOD { " (times between contacts are 'interval_s')" } else { "" };
        report.warnings.push(format!(
            "without the bound COR <= 1 the {what} give {grown:.3}: are the readings in order, in the right column{between} and unit, \
             or was energy put in?"
        ));
        return of(free);
    }
    let mut cor = of(estimate)?;
    if estimate.degrees_of_freedom == Some(0) && report.agreement.is_none() {
        doubts.push(format!("the {what} are just enough for a COR: nothing is left to check it by"));
    }
    if let (Some(p), Some(chi_square), Some(freedom)) = (estimate.p, estimate.chi_square, estimate.degrees_of_freedom) {
        #[allow(clippy::cast_precision_loss)]
        let birge = (chi_square / freedom as f64).sqrt();
        if p < REJECT && kind.spread.is_some() {
            // Said below: reading errors explain every drop by itself.
        } else if p < REJECT && kind.replicated && kind.scatter.is_none() {
            report.warnings.push(format!(
                "the {what} scatter {birge:.1} times more than their reading errors; the error of the COR is taken from the \
                 spread between trials"
            ));
        } else if p < REJECT && kind.scatter.is_some() {
            if !kind.replicated {
                doubts.push(format!("one COR does not fit the {what} (chi-square {chi_square:.0} on {freedom})"));
            }
        } else if p < REJECT {
            doubts.push(format!("one COR does not fit the {what} (chi-square {chi_square:.0} on {freedom})"));
            report
                .warnings
                .push(format!("the error of the COR was widened {birge:.1} times, the excess of the scatter"));
            let centre = cor.value;
            (cor.low, cor.high) =
                ((centre - birge * (centre - cor.low)).max(0.0), centre + birge * (cor.high - centre));
            cor.standard_error = cor.standard_error.map(|s| s * birge);
        } else if p > TOO_GOOD && freedom > 2 {
            report.warnings.push(format!(
                "the {what} scatter {birge:.2} times as much as their reading errors say: those are probably too large"
            ));
        }
    }
    if cor.value > LOSSLESS {
        doubts.push(format!(
            "the {what} hardly shrink, as if no bounce lost anything: they are those of something else, or in another unit"
        ));
    }
    let mut settings_differ = false;
    if let Some(mut differ) = differ(trials, &kind.separate, cor.value).filter(|d| d.p < REJECT) {
        for (setting, cor) in [&mut differ.low, &mut differ.high] {
            *cor = of_setting::<M>(evidence, trials, setting, kind.sigma).unwrap_or(*cor);
        }
        doubts.push(format!(
            "the COR by {what} is not the same throughout: {:.3} for {}, {:.3} for {} (by chance: p {})",
            differ.low.1,
            differ.low.0,
            differ.high.1,
            differ.high.0,
            chance(differ.p)
        ));
        settings_differ = true;
        report.widen("it takes in each of the balls, floors or drop heights");
        (cor.low, cor.high) = (cor.low.min(differ.low.1), cor.high.max(differ.high.1));
        cor.standard_error = Some((cor.high - cor.low) / (2.0 * NORMAL));
        report.warnings.push(
            "one COR for different balls, floors or drop heights is a mean of them: fit each by itself (--filter)"
                .to_owned(),
        );
    }
    let part = loudness(kind, trials);
    if part > LOUD && !settings_differ {
        doubts.push(format!(
            "the {what} scatter about the bounces of any one COR by {:.0} % of the largest: hardly a bounce can be made out",
            100.0 * part
        ));
    }
    if let Some(drift) = drift(&kind.separate, cor.value).filter(|d| d.p < REJECT && !settings_differ) {
        report.warnings.push(format!(
            "the COR changes from trial to trial in the order of the table, from {:.3} to {:.3} (by chance: p {}): one COR is a mean of that; \
             did the ball warm up, lose air or wear out?",
            drift.first,
            drift.last,
            chance(drift.p)
        ));
    }
    if let Some(spread) = kind.spread.filter(|_| report.agreement.is_none() && !settings_differ) {
        report.warnings.push(differing(spread, estimate.trials));
    }
    if let Some(scatter) = kind.scatter {
        let varies = format!(
            "the bounces themselves scatter: the COR varies by {:.1} % from bounce to bounce, and the error of the COR allows for it",
            100.0 * scatter
        );
        let error = duration(kind.sigma.value);
        report.warnings.push(match kind.sigma.source {
            Source::Scatter | Source::Assumed => format!(
                "{varies}; nobody stated how well the {what} were read: if to {error} only, say so (--sigma-time {}), and it is the readings \
                 that are taken to scatter",
                error.replace(' ', "")
            ),
            _ => format!("{varies}; readings good to {error} do not explain it"),
        });
    }
    if let Some(p) = kind.trend.filter(|p| *p < REJECT) {
        let trend = format!("the COR changes from bounce to bounce (a trend as strong by chance: p {})", chance(p));
        // Where the chi-square is tested and holds, or trials repeat each other, the trend is worth a word, not a doubt.
        let held = kind.replicated || estimate.p.is_some_and(|p| p >= REJECT);
        let cause =
            "it may come from a COR that depends on speed, from air drag, or from a wrong zero of the height scale";
        report.warnings.push(if held { format!("{trend}; {cause}") } else { format!("about the trend: {cause}") });
        if !held {
            doubts.push(trend);
        }
    }
    Some(cor)
}

/// The COR of the trials of one setting by themselves; what all trials together say of it is linear in how far it is from theirs.
fn of_setting<M: OneKind>(evidence: &Evidence, trials: &[Trial], setting: &str, sigma: Sourced) -> Option<f64> {
    let of = |t: &&TrialEvidence| trials.get(t.trial).is_some_and(|trial| trial.setting == setting);
    let own = Evidence { trials: evidence.trials.iter().filter(of).cloned().collect(), ..Evidence::default() };
    one_kind::<M>(&own, Some(sigma)).ok().flatten()?.estimate.value
}

/// That drops differ, and by how much.
pub(crate) fn differing(spread: f64, drops: usize) -> String {
    format!(
        "the COR differs from drop to drop by {spread:.3} (standard deviation of {drops} drops), more than the reading errors explain: \
         this spread sets the error; it belongs to the ball, the floor or the way of dropping"
    )
}

/// A probability for people, with the sign before it.
pub(crate) fn chance(p: f64) -> String {
    match p {
        p if p >= 0.0095 => format!("= {p:.2}"),
        p if p >= 0.000_95 => format!("= {p:.3}"),
        p if p > 0.0 => format!("= {p:.0e}"),
        _ => "< 1e-300".to_owned(),
    }
}
