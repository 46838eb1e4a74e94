//! What the ball does before and after the flights that are fitted: it is dropped again, or it
//! bounces as no ball does by itself.

use super::{Candidates, Recording};
use crate::solve::series::recording::in_metres;
use crate::solve::series::samples::Samples;

/// By so much of what its COR leaves a top may be higher, for a COR that is a tenth larger at a
/// slower impact.
const HIGHER: f64 = 1.25;
/// Between two tops the ball comes as near to the floor as this part of the lower one.
const DOWN: f64 = 0.2;
/// So many tops that no bounce gives are of a ball that is driven, or of another film: one alone is
/// that of a hand that takes it away.
const TOPS: usize = 2;

impl Recording {
    /// When the ball is dropped again after the last flight, and the samples from there on: a hand
    /// alone brings it higher than that flight did, and then it falls by the same gravity, and
    /// bounces.
    pub(crate) fn dropped_again(
        &self,
        series: &Samples,
        (repair, drag): (bool, Option<f64>),
    ) -> Option<(f64, Samples)> {
        let (end, apex) = self.instant.end();
        let later = series.after(end);
        if !later.heights.iter().any(|h| *h > apex) {
            return None;
        }
        let mut other = Candidates::cut(self.instant.trial, &later, repair).ok()?;
        if !in_metres(other.gravity(), self.instant.gravity()) {
            return None;
        }
        other.hold(drag);
        Some((other.fitted(repair).ok()?.scale.origin.0, later))
    }

    /// From when to when the ball bounces otherwise than in the motion that is fitted: before it or
    /// after it in flights by another gravity, or after it time and again from the floor by more
    /// than a bounce leaves. It was driven, or films are joined.
    pub(crate) fn elsewhere(&self, series: &Samples, repair: bool) -> Option<(f64, f64)> {
        let (begin, (end, apex)) = (self.instant.begin(), self.instant.end());
        let (floor, cor) = (self.instant.scale.origin.1, self.instant.last_cor());
        let due = HIGHER * cor * cor * (apex - floor);
        let bounces = |samples: &Samples| {
            let other = |cut: Candidates| cut.impacts() >= TOPS && !in_metres(cut.gravity(), self.instant.gravity());
            samples.range() > DOWN * due && Candidates::cut(self.instant.trial, samples, repair).is_ok_and(other)
        };
        let (earlier, later) = (series.before(begin), series.after(end));
        if bounces(&earlier) {
            return Some((earlier.times[0], begin));
        }
        let (mut tops, mut down) = (0, true);
        // One sample by itself may be wild.
        for pair in later.heights.windows(2) {
            let low = pair[0].min(pair[1]) - floor;
            if down && low > due {
                (tops, down) = (tops + 1, false);
            }
            down |= low < DOWN * due;
        }
        let last = later.times.last().copied()?;
        (tops >= TOPS || bounces(&later)).then_some((end, last))
    }
}

impl Candidates {
    /// The time of the last sample that is fitted, and the highest of its flight, in the table's
    /// units.
    fn end(&self) -> (f64, f64) {
        let contact = self.sketch.contacts.last().copied().unwrap_or(0.0);
        let flight = self.samples.iter().filter(|s| s.time >= contact);
        let top = flight.map(|s| s.height).fold(0.0, f64::max);
        let last = self.samples.last().map_or(0.0, |s| s.time);
        (self.scale.origin.0 + self.scale.unit * last, self.scale.origin.1 + self.scale.range * top)
    }

    /// The time of the first sample that is fitted, in the table's units.
    fn begin(&self) -> f64 {
        self.scale.origin.0 + self.scale.unit * self.samples.first().map_or(0.0, |s| s.time)
    }

    /// The COR of the last impact, as the parabolas have it.
    fn last_cor(&self) -> f64 {
        self.sketch.cors.last().copied().unwrap_or(1.0)
    }
}
