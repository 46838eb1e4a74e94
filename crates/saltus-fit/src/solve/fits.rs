//! Everything that was fitted to heights and times.

use super::bounces::{self, BounceCor, Setting};
use super::estimate::Estimate;
use super::joint::{self, Joint};
use super::kind::{self, Kind, one_kind};
use super::one::OneKind;
use super::profile::Profile;
use super::ratio;
use super::tolerance::losses;
use crate::elementary::{exp, ln};
use crate::error::FitError;
use crate::evidence::Evidence;
use crate::model::{Contacts, Heights};
use crate::quantity::{Loss, Measured, Method, Source, Sourced};
use crate::read::Table;

/// What is known before anything is fitted.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Known {
    pub(crate) gravity: Sourced,
    /// The errors of reading, where somebody states them.
    pub(crate) sigma_height: Option<Sourced>,
    pub(crate) sigma_time: Option<Sourced>,
    /// The time between two frames, s.
    pub(crate) frame: Option<f64>,
}

/// The fits of a table, and what they were made of.
pub(crate) struct Fits<'a> {
    pub(crate) table: &'a Table,
    pub(crate) evidence: &'a Evidence,
    pub(crate) gravity: Sourced,
    pub(crate) sigma_height: Sourced,
    pub(crate) sigma_time: Sourced,
    pub(crate) heights: Option<Kind<Heights>>,
    pub(crate) times: Option<Kind<Contacts>>,
    pub(crate) means: Vec<Estimate>,
    pub(crate) joint: Option<Joint>,
    /// The COR by neighbouring heights, where a rebound of zero is one of them.
    pub(crate) ratio: Option<Estimate>,
    /// The COR bounce by bounce.
    pub(crate) bounces: Vec<BounceCor>,
    /// The time between two frames, s.
    pub(crate) frame: Option<f64>,
}

impl<'a> Fits<'a> {
    /// Fits one COR to heights, to times and to both; by neighbouring heights too where a rebound
    /// was read as zero, or if `ratio` is wanted.
    pub(crate) fn of(table: &'a Table, evidence: &'a Evidence, known: &Known, ratio: bool) -> Result<Self, FitError> {
        let heights: Option<Kind<Heights>> = one_kind(evidence, known.sigma_height)?;
        let times: Option<Kind<Contacts>> = kind::times(evidence, known.sigma_time)?;
        let sigma_height = heights.as_ref().map(|k| k.sigma).or(known.sigma_height).unwrap_or(assumed::<Heights>());
        let sigma_time = times.as_ref().map(|k| k.sigma).or(known.sigma_time).unwrap_or(assumed::<Contacts>());
        let gravity = known.gravity;
        let setting =
            Setting { gravity: gravity.value, sigma_height: sigma_height.value, sigma_time: sigma_time.value };
        let bounces = bounces::list(evidence, &setting);
        let fits = Self {
            table,
            evidence,
            gravity,
            sigma_height,
            sigma_time,
            heights,
            times,
            means: bounces::means(evidence, &setting),
            joint: None,
            ratio: None,
            bounces,
            frame: known.frame,
        };
        if !fits.any() && evidence.trials.iter().all(|t| t.heights.is_empty() && t.moments.is_empty()) {
            return Ok(fits);
        }
        let joint = joint::joint(evidence, gravity.value, sigma_height.value, sigma_time.value)?;
        let zeros = evidence.trials.iter().any(|t| !t.zeros.is_empty());
        let ratio = if zeros || ratio { ratio::estimate(evidence, sigma_height.value) } else { None };
        Ok(Self { joint, ratio, ..fits })
    }

    /// Whether heights or times give a COR.
    pub(crate) fn any(&self) -> bool {
        self.heights.is_some() || self.times.is_some()
    }

    /// The COR that other models are compared with: that of both together, or of the one kind of
    /// reading there is.
    pub(crate) fn cor(&self) -> Option<f64> {
        fn of<M>(kind: &Kind<M>) -> Option<f64> {
            let estimate = kind.unbounded.as_ref().unwrap_or(&kind.estimate);
            estimate.value.filter(|_| estimate.low.is_some() && estimate.high.is_some())
        }
        match (&self.joint, &self.heights, &self.times) {
            (Some(joint), _, _) => joint.estimate.value,
            (None, _, Some(times)) => of(times),
            (None, Some(heights), None) => of(heights),
            (None, None, None) => None,
        }
    }

    /// The cost of each method over the COR.
    pub(crate) fn profiles(&self) -> Vec<Profile> {
        let heights = self.heights.as_ref().map(|kind| {
            let model = Heights::with_sigma(self.evidence, kind.sigma.value);
            // Heights are fitted in the logarithm of the COR.
            let Measured { value: log, standard_error } = kind.fitted.measured(0);
            let best = Measured { value: exp(log), standard_error: exp(log) * standard_error };
            Profile::of(Method::Heights, &model, &kind.fitted, best, ln)
        });
        let times = self.times.as_ref().map(|kind| {
            let model = Contacts::with_sigma(self.evidence, kind.sigma.value);
            Profile::of(Method::Times, &model, &kind.fitted, kind.fitted.measured(0), |cor| cor)
        });
        let joint = self
            .joint
            .as_ref()
            .map(|joint| Profile::of(Method::Joint, &joint.model, &joint.fitted, joint.fitted.measured(0), |cor| cor));
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

    /// The mean that weighs every bounce alike, by one method.
    pub(crate) fn mean(&self, method: Method) -> Option<&Estimate> {
        self.means.iter().find(|e| e.method == method)
    }

    /// The COR by each method that applies.
    pub(crate) fn estimates(&self) -> Vec<Estimate> {
        let mut list = Vec::new();
        if let Some(kind) = &self.heights {
            list.push(kind.estimate.clone());
            list.extend(kind.unbounded.clone());
        }
        list.extend(self.ratio.clone());
        list.extend(self.mean(Method::HeightsMean).cloned());
        if let Some(kind) = &self.times {
            list.push(kind.estimate.clone());
            list.extend(kind.unbounded.clone());
        }
        list.extend(self.mean(Method::FirstFlight).cloned());
        list.extend(self.mean(Method::TimesMean).cloned());
        list.extend(self.joint.as_ref().map(|j| j.estimate.clone()));
        list
    }
}

fn assumed<M: OneKind>() -> Sourced {
    Sourced { value: M::ASSUMED, source: Source::Assumed }
}
