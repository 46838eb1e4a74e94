//! The verdict: what the fits amount to, and what speaks against them.

use crate::choice::ModelChoice;
use crate::error::FitError;
use crate::estimate::{Estimate, Kind, OneKind, Source, Sourced};
use crate::evidence::Evidence;
use crate::joint::Joint;
use crate::model::{Contacts, Heights};
use crate::report::{Cor, Report, Verdict};
use crate::rivals::{self, Readings};
use crate::settings::differ;
use crate::statistics::NORMAL;
use crate::table::{Table, Trial};

/// A fit less probable than this by chance is rejected.
pub(crate) const REJECT: f64 = 0.01;
/// A BIC this much less decides.
const CLEAR: f64 = 6.0;
/// A fit more probable than this has reading errors that were stated too large.
const TOO_GOOD: f64 = 0.999;

/// Everything the fits found.
pub(crate) struct Findings<'a> {
    pub(crate) heights: Option<Kind<Heights>>,
    pub(crate) times: Option<Kind<Contacts>>,
    pub(crate) means: Vec<Estimate>,
    pub(crate) joint: Option<Joint>,
    pub(crate) table: &'a Table,
    pub(crate) evidence: &'a Evidence,
    pub(crate) sigma_height: f64,
}

impl Findings<'_> {
    fn mean(&self, method: &str) -> Option<&Estimate> {
        self.means.iter().find(|e| e.method == method)
    }
}

/// Fills verdict, reason, COR, estimates and warnings.
pub(crate) fn judge(report: &mut Report, found: &Findings<'_>) {
    estimates(report, found);
    assumptions(report);
    let disagree = report.agreement.as_ref().is_some_and(|a| a.p.is_some_and(|p| p < REJECT));
    if disagree {
        report.verdict = Verdict::Doubtful;
        report.reason = "heights and times do not agree on one COR".to_owned();
        report.cor = spanning(report);
        return;
    }
    let joint = found.joint.as_ref().map(|j| &j.estimate);
    let mut doubts = Vec::new();
    let mut chosen = None;
    if let Some(kind) = &found.heights {
        chosen = Some(single(report, kind, found.table.trials(), &mut doubts));
    }
    if let Some(kind) = &found.times {
        let times = single(report, kind, found.table.trials(), &mut doubts);
        chosen = Some(match chosen {
            Some(heights) if joint.is_none() => either(&heights, &times, &mut doubts),
            _ => times,
        });
    }
    if let Some(joint) = joint {
        chosen = Some(of(joint));
    }
    if let (Some(Some(cor)), Some(first)) =
        (&chosen, found.mean("first-flight").filter(|_| joint.is_none()).and_then(of))
    {
        let error = first.standard_error.unwrap_or(0.0).hypot(cor.standard_error.unwrap_or(0.0));
        if (first.value - cor.value).abs() > 3.0 * error {
            report.warnings.push(format!(
                "the first flight and the release height give {:.3}: the release height, gravity or the first bounce is not what it \
                 is taken for (this value is shown, not used)",
                first.value
            ));
        }
    }
    match (chosen, found.mean("first-flight")) {
        (Some(cor), _) => {
            report.cor = cor;
            report.verdict = if doubts.is_empty() { Verdict::Trusted } else { Verdict::Doubtful };
            report.reason = doubts.first().cloned().unwrap_or_else(|| fits(found));
        }
        (None, Some(first)) => {
            report.cor = of(first);
            report.verdict = Verdict::Doubtful;
            report.reason = "one flight and the release height give a COR, but nothing checks it".to_owned();
        }
        (None, None) => none(report, found),
    }
    if report.cor.is_none() && report.verdict != Verdict::Refused {
        report.verdict = Verdict::Refused;
    }
}

/// Compares other models with that of one COR, where the readings can tell them apart, and says so where they matter.
pub(crate) fn models(
    report: &mut Report,
    found: &Findings<'_>,
    (sigma_height, sigma_time): (Sourced, Sourced),
) -> Result<Vec<ModelChoice>, FitError> {
    let agree = !report.agreement.as_ref().is_some_and(|a| a.p.is_some_and(|p| p < REJECT));
    let Some(cor) = report.cor.filter(|_| agree) else { return Ok(Vec::new()) };
    let scattering = found.times.as_ref().is_some_and(|k| k.scatter.is_some());
    let (trials, source) = match (&found.joint, &found.heights, &found.times) {
        (Some(joint), _, _) => (joint.model.trials.clone(), sigma_time.source),
        (None, Some(_), None) => (Readings::heights(found.evidence, sigma_height.value), sigma_height.source),
        // Where bounces scatter, times have errors that add up: ratios are compared instead.
        (None, None, Some(_)) if !scattering => (Readings::times(found.evidence, sigma_time.value), sigma_time.source),
        _ => return Ok(Vec::new()),
    };
    let readings = Readings { trials, gravity: report.gravity.value, scattered: source == Source::Scatter };
    let list = rivals::compare(&readings, cor.value)?;
    let Some(one) = list.iter().find(|m| m.chosen) else { return Ok(Vec::new()) };
    for model in list.iter().filter(|m| !m.chosen && m.bic < CLEAR) {
        let apart = (model.cor.value - one.cor.value).abs();
        let differ = apart > 2.0 * model.cor.standard_error.hypot(one.cor.standard_error) && apart > 0.002;
        if model.bic < -CLEAR || differ {
            let how = if model.bic < -CLEAR { "better than" } else { "about as well as" };
            report.warnings.push(format!(
                "{} fits {how} one COR (BIC {:+.1}), with {:.3} ± {:.3}",
                model.about, model.bic, model.cor.value, model.cor.standard_error
            ));
        }
        if differ && let Some(cor) = &mut report.cor {
            cor.low = cor.low.min(model.cor.value - NORMAL * model.cor.standard_error).max(0.0);
            cor.high = cor.high.max(model.cor.value + NORMAL * model.cor.standard_error);
        }
    }
    Ok(list)
}

fn estimates(report: &mut Report, found: &Findings<'_>) {
    let list = &mut report.estimates;
    if let Some(kind) = &found.heights {
        list.push(kind.estimate.clone());
        list.extend(kind.unbounded.clone());
    }
    list.extend(found.mean("heights-mean").cloned());
    if let Some(kind) = &found.times {
        list.push(kind.estimate.clone());
        list.extend(kind.unbounded.clone());
    }
    list.extend(found.mean("first-flight").cloned());
    list.extend(found.mean("times-mean").cloned());
    list.extend(found.joint.as_ref().map(|j| j.estimate.clone()));
}

/// Warns of reading errors that nobody stated.
fn assumptions(report: &mut Report) {
    let assumed = |s: Option<Sourced>| s.is_some_and(|s| s.source == Source::Assumed);
    let mut what = Vec::new();
    if assumed(report.sigma_height) {
        what.push("1 cm for heights (--sigma-height)");
    }
    if assumed(report.sigma_time) {
        what.push("10 ms for times (--sigma-time)");
    }
    if !what.is_empty() {
        report.warnings.push(format!("nobody stated the reading errors; assumed {}", what.join(" and ")));
    }
}

fn of(estimate: &Estimate) -> Option<Cor> {
    let (value, low, high) = (estimate.value?, estimate.low?, estimate.high?);
    Some(Cor { value, standard_error: estimate.standard_error, low, high })
}

/// The range that covers what every method says, for a table whose columns contradict each other.
fn spanning(report: &Report) -> Option<Cor> {
    let bounded = || report.estimates.iter().filter(|e| !e.method.ends_with("unbounded"));
    let low = bounded().filter_map(|e| e.low).min_by(f64::total_cmp)?;
    let high = bounded().filter_map(|e| e.high).max_by(f64::total_cmp)?;
    let value = |method: &str, instead: &str| {
        let find = |name: &str| report.estimates.iter().find(|e| e.method == name).and_then(|e| e.value);
        find(method).or(find(instead))
    };
    let middle = match (value("heights-mean", "heights"), value("times-mean", "times")) {
        (Some(a), Some(b)) => 0.5 * (a + b),
        (Some(a), None) | (None, Some(a)) => a,
        (None, None) => 0.5 * (low + high),
    };
    Some(Cor { value: middle.clamp(low, high), standard_error: Some((high - low) / (2.0 * NORMAL)), low, high })
}

/// The COR of one kind of reading, with what speaks against it.
fn single<M: OneKind>(report: &mut Report, kind: &Kind<M>, trials: &[Trial], doubts: &mut Vec<String>) -> Option<Cor> {
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
        report.warnings.push(format!(
            "without the bound COR <= 1 the {what} give {grown:.3}: are the readings in order, in the right column and unit, \
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
        if p < REJECT && kind.replicated && kind.scatter.is_none() {
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
    if let Some(differ) = differ(trials, &kind.separate, cor.value).filter(|d| d.p < REJECT) {
        doubts.push(format!(
            "the COR by {what} is not the same throughout: {:.3} for {}, {:.3} for {} (by chance: p {})",
            differ.low.1,
            differ.low.0,
            differ.high.1,
            differ.high.0,
            chance(differ.p)
        ));
        (cor.low, cor.high) = (cor.low.min(differ.low.1), cor.high.max(differ.high.1));
        cor.standard_error = Some((cor.high - cor.low) / (2.0 * NORMAL));
        report.warnings.push(
            "one COR for different balls, floors or drop heights is a mean of them: fit each by itself (--filter)"
                .to_owned(),
        );
    }
    if let Some(scatter) = kind.scatter {
        report.warnings.push(format!(
            "the bounces themselves scatter: the COR varies by {:.1} % from bounce to bounce, more than the reading of {what} \
             explains; the error of the COR allows for it",
            100.0 * scatter
        ));
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

/// A probability for people, with the sign before it.
pub(crate) fn chance(p: f64) -> String {
    match p {
        p if p >= 0.0095 => format!("= {p:.2}"),
        p if p >= 0.000_95 => format!("= {p:.3}"),
        p if p > 0.0 => format!("= {p:.0e}"),
        _ => "< 1e-300".to_owned(),
    }
}

/// Heights and times from different trials: the sharper of the two, if they agree.
fn either(heights: &Option<Cor>, times: &Option<Cor>, doubts: &mut Vec<String>) -> Option<Cor> {
    let (Some(a), Some(b)) = (heights, times) else { return heights.or(*times) };
    let (s, t) = (a.standard_error.unwrap_or(f64::INFINITY), b.standard_error.unwrap_or(f64::INFINITY));
    // 2.576 standard errors: one chance in a hundred.
    if (a.value - b.value).abs() > 2.576 * s.hypot(t) {
        doubts.push(format!("heights give {:.3} and times give {:.3}", a.value, b.value));
        let (low, high) = (a.low.min(b.low), a.high.max(b.high));
        let error = Some((high - low) / (2.0 * NORMAL));
        return Some(Cor { value: 0.5 * (a.value + b.value), standard_error: error, low, high });
    }
    if s <= t { Some(*a) } else { Some(*b) }
}

/// What speaks for a trusted COR.
fn fits(found: &Findings<'_>) -> String {
    if found.joint.is_some() {
        return "heights and times agree on one COR".to_owned();
    }
    let kinds = match (&found.heights, &found.times) {
        (Some(_), Some(_)) => "heights and times agree on one COR",
        (Some(_), None) => "one COR fits the heights",
        _ => "one COR fits the times",
    };
    kinds.to_owned()
}

/// Why there is no COR, or at most a limit.
fn none(report: &mut Report, found: &Findings<'_>) {
    let dropped = found.evidence.trials.iter().find_map(|t| t.release_height.map(|h| h.0));
    if let (true, Some(height)) = (found.table.zero_rebounds > 0, dropped) {
        let high = (found.sigma_height / height).sqrt().min(1.0);
        report.cor = Some(Cor { value: 0.0, standard_error: None, low: 0.0, high });
        report.verdict = Verdict::Doubtful;
        report.reason = format!("no rebound was high enough to be read: the COR is below {high:.2}");
        return;
    }
    report.verdict = Verdict::Refused;
    let contacts = found.evidence.trials.iter().map(|t| t.moments.len()).max().unwrap_or(0);
    let heights = found.evidence.trials.iter().map(|t| t.heights.len()).max().unwrap_or(0);
    report.reason = match (heights, contacts) {
        (0 | 1, 0) => "a COR needs the height before and after a bounce, and there is one height at most".to_owned(),
        (0 | 1, 1) => "a COR needs two flights to compare, and there is one contact only".to_owned(),
        (0 | 1, 2) => {
            "two contacts are one flight; a COR needs three contacts, or the release height beside the two".to_owned()
        }
        _ => "the readings do not determine a COR (are they all taken at the same bounce?)".to_owned(),
    };
}
