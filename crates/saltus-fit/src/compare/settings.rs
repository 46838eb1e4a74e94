//! Whether trials of different balls, floors or drop heights may share one COR, and whether it
//! changes in their order.

use std::collections::{BTreeMap, BTreeSet};

use crate::read::Trial;
use crate::statistics::{Line, SPARE, TREND, chi_square_p, variance_ratio_p};

/// How settings differ: the probability of that by chance, and the settings with the lowest and the
/// highest COR.
pub(crate) struct Differ {
    pub(crate) p: f64,
    /// How many more trials there are than settings.
    pub(crate) spare: usize,
    pub(crate) low: (String, f64),
    pub(crate) high: (String, f64),
}

/// Analysis of variance of the trials' own CORs by setting, each weighing by its information;
/// `None` for a single setting.
///
/// `separate` holds, trial by trial, the information on the COR and the trial's own COR less `cor`.
#[allow(clippy::cast_precision_loss)]
pub(crate) fn differ(trials: &[Trial], separate: &[(f64, f64)], cor: f64) -> Option<Differ> {
    differ_by(trials, separate, cor, |trial| Some(&trial.setting))
}

/// A column that was left aside, and how the CORs differ by what stands in it: that with the least
/// probability by chance. Its values have to repeat, so that the trials of one value tell their own
/// scatter.
pub(crate) fn differ_beside(trials: &[Trial], separate: &[(f64, f64)], cor: f64) -> Option<(String, Differ)> {
    let names: BTreeSet<&str> = trials.iter().flat_map(|trial| trial.beside.iter().map(|(name, _)| &**name)).collect();
    let cell = |trial: &'_ Trial, name: &str| trial.beside.iter().position(|(other, _)| other == name);
    let found = names.into_iter().filter_map(|name| {
        let differ = differ_by(trials, separate, cor, |trial| cell(trial, name).map(|n| trial.beside[n].1.as_str()))?;
        (differ.spare > 0).then(|| (name.to_owned(), differ))
    });
    found.min_by(|a, b| a.1.p.total_cmp(&b.1.p))
}

fn differ_by<'a>(
    trials: &'a [Trial],
    separate: &[(f64, f64)],
    cor: f64,
    key: impl Fn(&'a Trial) -> Option<&'a str>,
) -> Option<Differ> {
    let mut settings: BTreeMap<&str, (f64, f64, f64, usize)> = BTreeMap::new();
    for (trial, &(weight, shift)) in trials.iter().zip(separate).filter(|(_, s)| s.0 > 0.0) {
        let sums = settings.entry(key(trial)?).or_default();
        *sums = (sums.0 + weight, sums.1 + weight * shift, sums.2 + weight * shift * shift, sums.3 + 1);
    }
    let above = settings.len().checked_sub(1).filter(|n| *n > 0)?;
    let all = settings.values().fold((0.0, 0.0), |a, s| (a.0 + s.0, a.1 + s.1));
    let mean = all.1 / all.0;
    let between: f64 = settings.values().map(|s| s.0 * (s.1 / s.0 - mean).powi(2)).sum();
    let within: f64 = settings.values().map(|s| s.2 - s.1 * s.1 / s.0).sum();
    let below = settings.values().map(|s| s.3 - 1).sum::<usize>();
    let p = if below >= SPARE {
        variance_ratio_p((between / above as f64) / (within.max(0.0) / below as f64), above, below)?
    } else {
        chi_square_p(between, above)?
    };
    let spare = below;
    let own = || settings.iter().map(|(name, s)| ((*name).to_owned(), cor + s.1 / s.0));
    let by_cor = |a: &(String, f64), b: &(String, f64)| a.1.total_cmp(&b.1);
    Some(Differ { p, spare, low: own().min_by(by_cor)?, high: own().max_by(by_cor)? })
}

/// A COR that changes from trial to trial in their order: the probability of that by chance, and
/// what it is at the first and at the last.
pub(crate) struct Drift {
    pub(crate) p: f64,
    pub(crate) first: f64,
    pub(crate) last: f64,
}

/// The straight line through the trials' own CORs, each weighing by its information; arguments as
/// for [`differ`].
#[allow(clippy::cast_precision_loss)]
pub(crate) fn drift(separate: &[(f64, f64)], cor: f64) -> Option<Drift> {
    let trials = || separate.iter().enumerate().filter(|(_, s)| s.0 > 0.0).map(|(n, s)| (s.0, n as f64, s.1));
    let count = trials().count();
    let line = Line::through(trials());
    let freedom = count.checked_sub(2).filter(|_| count >= TREND)?;
    let p = variance_ratio_p(line.explained / ((line.all - line.explained).max(1e-300) / freedom as f64), 1, freedom)?;
    Some(Drift { p, first: cor + line.at(0.0), last: cor + line.at(separate.len() as f64 - 1.0) })
}
