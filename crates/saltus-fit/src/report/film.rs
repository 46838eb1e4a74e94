//! The fitted motion of a recording for a picture: short parabolas along the flights, which with
//! drag are none.

use super::motion::{Arc, Motion};
use super::residual::{Mark, Measure, Point, Residual};
use crate::model::Air;
use crate::solve::series::{Course, Series};

/// A flight with drag is drawn as so many parabolas.
const PIECES: usize = 12;
/// More samples than this are thinned out for the picture.
const DRAWN: usize = 4000;

impl Course {
    fn air(&self) -> Air {
        Air { gravity: self.gravity, drag: self.drag }
    }

    /// The pieces of one flight from `start` to `end` about its apex.
    fn pieces(&self, (time, height): (f64, f64), start: f64, end: f64) -> Vec<Arc> {
        let pieces = if self.drag > 0.0 { PIECES } else { 1 };
        let span = (end - start) / pieces as f64;
        let at = |t: f64| {
            let drop = self.air().drop(t - time);
            (height - drop.value, -drop.by[0])
        };
        let piece = |n: usize| {
            let from = start + span * n as f64;
            let ((h0, v0), (h1, _)) = (at(from), at(from + span));
            Arc { start: from, span, height: [h0, v0, (h1 - h0 - v0 * span) / (span * span)] }
        };
        if span > 0.0 { (0..pieces).map(piece).collect() } else { Vec::new() }
    }

    /// A contact after the piece before it, drawn as a parabola that begins at the speed of
    /// arrival.
    fn contact(before: &Arc, lasts: f64) -> Arc {
        let [_, v, bend] = before.height;
        let arrival = -(v + 2.0 * bend * before.span);
        Arc { start: before.start + before.span, span: lasts, height: [0.0, -arrival, arrival / lasts] }
    }

    fn motion(&self, trial: usize, cor: f64) -> Motion {
        let (first, last) = (self.samples.first().map_or(0.0, |s| s.0), self.samples.last().map_or(0.0, |s| s.0));
        let mut flights = Vec::new();
        for (n, &apex) in self.apexes.iter().enumerate() {
            let impact = n.checked_sub(1).map(|last| (self.contacts[last], self.lasting[last]));
            let start = impact.map_or(first, |(time, lasts)| time + lasts);
            let lasts = impact.map(|(_, lasts)| lasts).filter(|&lasts| lasts > 0.0);
            let contact = flights.last().zip(lasts).map(|(before, lasts)| Self::contact(before, lasts));
            flights.extend(contact);
            let end = self.contacts.get(n).copied().unwrap_or(last);
            flights.extend(self.pieces(apex, start, end));
        }
        Motion {
            trial,
            gravity: self.gravity,
            cor,
            release_time: None,
            release_height: None,
            contacts: self.contacts.clone(),
            apexes: self.apexes.iter().skip(1).map(|a| a.1).collect(),
            flights,
        }
    }
}

impl Series {
    /// The motion of every recording, its samples and what is left of them.
    pub(crate) fn picture(&self) -> (Vec<Motion>, Vec<Point>, Vec<Residual>) {
        let (mut motions, mut points, mut residuals) = (Vec::new(), Vec::new(), Vec::new());
        let Some(pooled) = &self.pooled else { return (motions, points, residuals) };
        for track in &self.tracks {
            motions.push(track.course.motion(track.trial, pooled.cor.value));
            let sigma = track.rms.max(f64::MIN_POSITIVE);
            let every = track.course.samples.len().div_ceil(DRAWN);
            for (n, &(time, height, left)) in track.course.samples.iter().enumerate().step_by(every) {
                let which = (Mark::Sample, n + 1);
                let values = (height, height - left);
                residuals.push(Residual::new(track.trial, which, Measure::Height, time, values, sigma));
                points.push(Point::new(track.trial, which, time, height));
            }
        }
        (motions, points, residuals)
    }
}
