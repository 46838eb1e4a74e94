//! The samples of one recording in order: each time once, frames at their own times, heights
//! upwards.

use super::frames;
use crate::finding::FindingKind;
use crate::orientation::falls_upwards;
use crate::read::{Event, Trial};

/// More samples of one recording than this are thinned.
const SAMPLES: usize = 50_000;

/// Times and heights of a series, ascending in time and each time once; heights upwards.
#[derive(Clone, Debug)]
pub(crate) struct Samples {
    pub(crate) times: Vec<f64>,
    pub(crate) heights: Vec<f64>,
    /// Whether the heights were counted downwards, and turned over.
    pub(crate) turned: bool,
}

impl Samples {
    /// How far apart the heights are.
    pub(super) fn range(&self) -> f64 {
        let ends = |(low, high): (f64, f64), h: &f64| (low.min(*h), high.max(*h));
        let (low, high) = self.heights.iter().fold((f64::INFINITY, f64::NEG_INFINITY), ends);
        high - low
    }

    /// The samples before a time.
    pub(super) fn before(&self, time: f64) -> Self {
        let to = self.times.partition_point(|t| *t < time);
        Self { times: self.times[..to].to_vec(), heights: self.heights[..to].to_vec(), turned: self.turned }
    }

    /// The samples after a time.
    pub(super) fn after(&self, time: f64) -> Self {
        let from = self.times.partition_point(|t| *t <= time);
        Self { times: self.times[from..].to_vec(), heights: self.heights[from..].to_vec(), turned: self.turned }
    }
}

/// The series of a trial, put in order and the right way up unless that was stated, with the times
/// of its frames if `repair`, and what had to be done for it; `None` if it has none.
pub(super) fn samples(trial: &Trial, oriented: bool, repair: bool) -> Option<(Samples, Vec<FindingKind>)> {
    let mut rows: Vec<(f64, f64, u64)> = trial
        .readings()
        .iter()
        .filter(|r| r.event == Event::Sample)
        .filter_map(|r| Some((r.time?, r.height?, r.line)))
        .collect();
    if rows.is_empty() {
        return None;
    }
    let mut repairs = Vec::new();
    rows.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.2.cmp(&b.2)));
    let before = rows.len();
    rows.dedup_by(|b, a| a.0 == b.0);
    if rows.len() < before {
        repairs.push(FindingKind::SameTime { samples: before - rows.len() });
    }
    let times: Vec<f64> = rows.iter().map(|row| row.0).collect();
    if let Some(frames) = frames::of(&times).filter(|_| repair) {
        rows.iter_mut().zip(frames.times).for_each(|(row, time)| row.0 = time);
        repairs.push(FindingKind::FramesRestored { rate: frames.rate, rounded_s: frames.rounded });
    }
    let every = rows.len().div_ceil(SAMPLES);
    if every > 1 {
        repairs.push(FindingKind::Thinned { samples: rows.len(), every });
        rows = rows.into_iter().step_by(every).collect();
    }
    let times: Vec<f64> = rows.iter().map(|r| r.0).collect();
    let heights: Vec<f64> = rows.iter().map(|r| r.1).collect();
    let recording = [(times, heights)];
    let turned = !oriented && falls_upwards(&recording) == Some(true);
    let [(times, mut heights)] = recording;
    if turned {
        heights.iter_mut().for_each(|h| *h = -*h);
        repairs.push(FindingKind::TurnedOver);
    }
    Some((Samples { times, heights, turned }, repairs))
}
