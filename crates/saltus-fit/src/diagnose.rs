//! The verdict: what the fits amount to, and what speaks against them.

use crate::alone::{differing, single};
use crate::bounces::Measured;
use crate::choice::CorModel;
use crate::error::FitError;
use crate::estimate::{Estimate, Kind, OneKind, Source, Sourced};
use crate::evidence::Evidence;
use crate::joint::Joint;
use crate::model::{Contacts, Heights};
use crate::profile::Profile;
use crate::report::{Cor, Report, Verdict};
use crate::rivals::{self, Compared, Readings};
use crate::robust::Loss;
use crate::settings::differ;
use crate::statistics::NORMAL;
use crate::table::{Event, Table};
use crate::tolerance::losses;
use crate::weigh;

/// A fit less probable than this by chance is rejected.
pub(crate) const REJECT: f64 = 0.01;
/// A rebound so many standard errors high is not read as zero.
const TOO_HIGH: f64 = 5.0;
/// Times that do not follow from the others are a doubt if there is one for fewer than so many that do.
const ADRIFT: usize = 3;
/// A 95 % interval wider than this says hardly anything.
const VAGUE: f64 = 0.5;

/// Everything the fits found.
pub(crate) struct Findings<'a> {
    pub(crate) heights: Option<Kind<Heights>>,
    pub(crate) times: Option<Kind<Contacts>>,
    pub(crate) means: Vec<Estimate>,
    pub(crate) joint: Option<Joint>,
    pub(crate) table: &'a Table,
    pub(crate) evidence: &'a Evidence,
    pub(crate) sigma_height: f64,
    /// The size of the ball, m, if it is stated.
    pub(crate) ball: Option<f64>,
    /// The COR by neighbouring heights, where a rebound of zero is one of them.
    pub(crate) ratio: Option<Estimate>,
}

impl Findings<'_> {
    /// The cost of each method over the COR.
    pub(crate) fn profiles(&self) -> Vec<Profile> {
        let heights = self.heights.as_ref().map(|kind| {
            let model = Heights::with_sigma(self.evidence, kind.sigma.value);
            // Heights are fitted in the logarithm of the COR.
            let Measured { value: ln, standard_error } = kind.fitted.measured(0);
            let best = Measured { value: ln.exp(), standard_error: ln.exp() * standard_error };
            Profile::of("heights", &model, &kind.fitted, best, f64::ln)
        });
        let times = self.times.as_ref().map(|kind| {
            let model = Contacts::with_sigma(self.evidence, kind.sigma.value);
            Profile::of("times", &model, &kind.fitted, kind.fitted.measured(0), |cor| cor)
        });
        let joint = self
            .joint
            .as_ref()
            .map(|joint| Profile::of("joint", &joint.model, &joint.fitted, joint.fitted.measured(0), |cor| cor));
        [heights, times, joint].into_iter().flatten().collect()
    }

    /// The estimates of heights and times by other losses.
    pub(crate) fn losses(&self, wanted: &[Loss]) -> Result<Vec<Estimate>, FitError> {
        let mut list = Vec::new();
        if let Some(kind) = &self.heights {
            list.extend(losses(self.evidence, kind, wanted)?);
        }
        if let Some(kind) = &self.times {
            list.extend(losses(self.evidence, kind, wanted)?);
        }
        Ok(list)
    }

    fn mean(&self, method: &str) -> Option<&Estimate> {
        self.means.iter().find(|e| e.method == method)
    }

    /// Whether drops differ for another cause than the height they fall from: then no model of the speed can be told from that cause.
    fn drops_differ(&self, cor: f64) -> bool {
        let of = |spread: Option<f64>, separate: &[(f64, f64)]| {
            let settings = differ(self.table.trials(), separate, cor).is_some_and(|d| d.p < REJECT);
            if settings { !self.set_by_height() } else { spread.is_some() }
        };
        self.heights.as_ref().is_some_and(|k| of(k.spread, &k.separate))
            || self.times.as_ref().is_some_and(|k| of(k.spread, &k.separate))
            || self.joint.as_ref().is_some_and(|j| j.spread.is_some())
    }

    /// Whether the settings are three heights of release or more, and nothing else.
    fn set_by_height(&self) -> bool {
        let mut heights: Vec<(f64, &str)> = Vec::new();
        for (trial, found) in self.table.trials().iter().zip(&self.evidence.trials) {
            let Some((height, _)) = found.release_height else { return false };
            match heights.iter().find(|h| h.1 == trial.setting) {
                Some(known) if (known.0 / height - 1.0).abs() < 0.05 => {}
                Some(_) => return false,
                None => heights.push((height, &trial.setting)),
            }
        }
        heights.sort_by(|a, b| a.0.total_cmp(&b.0));
        heights.len() > 2 && heights.windows(2).all(|w| w[1].0 > 1.05 * w[0].0)
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
    // By heights alone and by times alone, from more trials than have both.
    let mut wider = Vec::new();
    let both = found.joint.as_ref().map_or(0, |joint| joint.trials.len());
    if let Some(kind) = &found.heights {
        let heights = single(report, kind, (found.table.trials(), found.evidence), &mut doubts);
        wider.extend((kind.estimate.trials > both).then_some(("heights", kind.estimate.trials, heights)));
        chosen = Some(heights);
    }
    doubts.extend(contradicted(found));
    doubts.extend(mostly_left_out(found));
    if let Some(kind) = &found.times {
        let times = single(report, kind, (found.table.trials(), found.evidence), &mut doubts);
        wider.extend((kind.estimate.trials > both).then_some(("times", kind.estimate.trials, times)));
        chosen = Some(match chosen {
            Some(heights) if joint.is_none() => either(("heights", &heights), ("times", &times), &mut doubts),
            _ => times,
        });
    }
    if let Some(joint) = &found.joint {
        let whole = of(&joint.estimate);
        chosen = Some(wider.iter().fold(whole, |whole, (what, trials, alone)| {
            let (what, both) = (format!("{what} of {trials} trials"), format!("heights with times, read of {both},"));
            either((&what, alone), (&both, &whole), &mut doubts)
        }));
        if let Some(spread) = joint.spread {
            report.warnings.push(differing(spread, joint.trials.len()));
        }
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
            if let Some(cor) = cor.filter(|cor| cor.high - cor.low > VAGUE) {
                doubts.push(format!(
                    "the COR is hardly known: from {:.2} to {:.2}; are the units and the reading errors right?",
                    cor.low, cor.high
                ));
            }
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
    (losses, wanted): (&[Loss], Option<CorModel>),
) -> Result<Compared, FitError> {
    // Why there is nothing to compare.
    let none = |why: &str| Ok(Compared { untried: Some(why.to_owned()), ..Compared::default() });
    let agree = !report.agreement.as_ref().is_some_and(|a| a.p.is_some_and(|p| p < REJECT));
    let Some(cor) = report.cor.filter(|_| agree) else { return none("they do not settle on one COR to begin with") };
    let scattering = found.times.as_ref().is_some_and(|k| k.scatter.is_some());
    let (trials, source) = match (&found.joint, &found.heights, &found.times) {
        (Some(joint), _, _) => (joint.model.trials.clone(), sigma_time.source),
        (None, Some(_), None) => (Readings::heights(found.evidence, sigma_height.value), sigma_height.source),
        // Where bounces scatter, times have errors that add up: ratios are compared instead.
        (None, None, Some(_)) if !scattering && found.evidence.added_up() => {
            return none("the errors of times between contacts add up");
        }
        (None, None, Some(_)) if !scattering => (Readings::times(found.evidence, sigma_time.value), sigma_time.source),
        (None, None, Some(times)) => {
            if !found.drops_differ(cor.value) {
                weigh::models(report, &times.models);
                let untried = Some(
                    "the bounces scatter: of their ratios, only 'linear', 'drag' and 'contact' are fitted".to_owned(),
                );
                return Ok(Compared { models: times.models.clone(), untried, ..Compared::default() });
            }
            return none("the bounces scatter, and drops differ");
        }
        _ => return none("heights and times are of different trials, or there is one flight only"),
    };
    if found.drops_differ(cor.value) {
        let why = "where drops differ, other models would take that for their own";
        report.notes.push(format!("other models are not compared: {why}"));
        return none(why);
    }
    let scattered = source == Source::Scatter;
    let readings = Readings {
        trials,
        gravity: report.gravity.value,
        scattered,
        ball: found.ball,
        joint: found.joint.is_some(),
        losses: losses.to_vec(),
        wanted,
    };
    let mut compared = rivals::compare(&readings, cor.value)?;
    report.notes.append(&mut compared.notes);
    let doubted = weigh::models(report, &compared.models);
    match (&found.joint, &found.heights) {
        (Some(_), _) => {}
        (None, Some(_)) => weigh::error_decides(report, &compared.models, "heights", sigma_height, doubted),
        (None, None) => weigh::error_decides(report, &compared.models, "times", sigma_time, doubted),
    }
    Ok(compared)
}

fn estimates(report: &mut Report, found: &Findings<'_>) {
    let list = &mut report.estimates;
    if let Some(kind) = &found.heights {
        list.push(kind.estimate.clone());
        list.extend(kind.unbounded.clone());
    }
    list.extend(found.ratio.clone());
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

/// The COR of an estimate, where it has one with a range.
pub(crate) fn of(estimate: &Estimate) -> Option<Cor> {
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

/// Whether fewer than half of the times belong to the bounces that were found: among so many, some agree by chance.
fn mostly_left_out(found: &Findings<'_>) -> Option<String> {
    let readings = found.table.trials().iter().flat_map(|trial| trial.readings());
    let read = readings.filter(|reading| reading.event == Event::Contact && reading.time.is_some()).count();
    let used: usize = found.evidence.trials.iter().map(|trial| trial.moments.iter().filter(|m| !m.1).count()).sum();
    let adrift = found.evidence.adrift;
    if found.times.is_some() && 2 * used >= read && ADRIFT * adrift >= used {
        return Some(format!(
            "of {read} times {adrift} do not follow from the others, which then may do so by chance: cut the table to the bounces, or measure again"
        ));
    }
    let few = found.times.is_some() && 2 * used < read;
    few.then(|| format!("of {read} times only {used} follow from each other, which may be chance: cut the table to the bounces, or measure again"))
}

/// A rebound read as zero that the fitted heights do not allow.
fn contradicted(found: &Findings<'_>) -> Option<String> {
    let kind = found.heights.as_ref()?;
    let (height, bounce) = found.evidence.trials.iter().zip(&kind.fitted.own).find_map(|(trial, own)| {
        // A trial with a single height has no level of its own.
        let level = own.first().filter(|_| trial.heights.len() > 1)?;
        #[allow(clippy::cast_precision_loss)]
        let height = |n: usize| (level + 2.0 * n as f64 * kind.fitted.shared[0]).exp();
        let too_high = |n: &&usize| height(**n) > TOO_HIGH * found.sigma_height;
        trial.zeros.iter().find(too_high).map(|&n| (height(n), n))
    })?;
    Some(format!(
        "a rebound was read as zero (bounce {bounce}) that should be {:.1} cm high: leave its cell empty if it was not read",
        100.0 * height
    ))
}

/// Heights and times from different trials: the sharper of the two, if they agree.
fn either(first: (&str, &Option<Cor>), second: (&str, &Option<Cor>), doubts: &mut Vec<String>) -> Option<Cor> {
    let (Some(a), Some(b)) = (first.1, second.1) else { return first.1.or(*second.1) };
    let (s, t) = (a.standard_error.unwrap_or(f64::INFINITY), b.standard_error.unwrap_or(f64::INFINITY));
    // 2.576 standard errors: one chance in a hundred.
    if (a.value - b.value).abs() > 2.576 * s.hypot(t) {
        doubts.push(format!("{} give {:.3} and {} give {:.3}", first.0, a.value, second.0, b.value));
        let (low, high) = (a.low.min(b.low), a.high.max(b.high));
        let error = Some((high - low) / (2.0 * NORMAL));
        return Some(Cor { value: 0.5 * (a.value + b.value), standard_error: error, low, high });
    }
    if s <= t { Some(*a) } else { Some(*b) }
}

/// What speaks for a trusted COR.
fn fits(found: &Findings<'_>) -> String {
    let spread = found.times.as_ref().and_then(|k| k.spread).or(found.heights.as_ref().and_then(|k| k.spread));
    if let Some(joint) = &found.joint {
        return match joint.spread {
            Some(_) => "heights and times agree in every drop; the COR is the mean over drops that differ".to_owned(),
            None if joint.trials.len() < found.evidence.trials.len() => {
                format!(
                    "heights and times agree on one COR, in {} of {} trials",
                    joint.trials.len(),
                    found.evidence.trials.len()
                )
            }
            None => "heights and times agree on one COR".to_owned(),
        };
    }
    if spread.is_some() {
        return "the COR is the mean over drops that differ by more than their readings".to_owned();
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
    if let Some(cor) = found.ratio.as_ref().and_then(of) {
        report.cor = Some(cor);
        report.verdict = Verdict::Doubtful;
        report.reason = format!("no rebound was high enough to be read: the COR is at most {:.2} (95 %)", cor.high);
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
