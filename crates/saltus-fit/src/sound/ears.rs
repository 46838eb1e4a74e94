//! A sound heard twice: all of it, and what is bright, which the noise of halls, traffic and voices
//! leaves free.

use super::bounced::Bounced;
use super::onset::{Ear, Onset};
use super::wav::Spec;
use crate::elementary::ln;

/// What counts is the sound above this frequency, Hz: hum of the mains and its first overtones, and
/// steps, are below;
const ALL: f64 = 200.0;
/// where no ball is heard in that, the sound above this one, Hz: the click of a contact
/// goes to some thousand, and most noise is below.
const BRIGHT: f64 = 2000.0;
/// What is bright is listened to where the samples have room for two octaves of it.
const ROOM: f64 = 8.0;

/// What listens to a sound.
pub(super) struct Ears(Vec<Ear>);

/// What ears have heard: the onsets, and the contacts among them.
pub(super) struct Heard {
    pub(super) onsets: Vec<Onset>,
    pub(super) bounced: Option<Bounced>,
}

impl Ears {
    pub(super) fn new(spec: Spec, start: f64) -> Self {
        let bright = f64::from(spec.rate) >= ROOM * BRIGHT;
        let lowest = if bright { &[ALL, BRIGHT][..] } else { &[ALL] };
        Self(lowest.iter().map(|&lowest| Ear::new(spec, start, lowest)).collect())
    }

    /// Listens to a frame.
    pub(super) fn push(&mut self, frame: &[f32]) {
        self.0.iter_mut().for_each(|ear| ear.push(frame));
    }

    /// How long the sound is, s.
    pub(super) fn seconds(&self) -> f64 {
        self.0.first().map_or(0.0, Ear::seconds)
    }

    /// The part of all frames that have a sample as large as can be.
    #[allow(clippy::cast_precision_loss)] // far below 2^52 frames
    pub(super) fn clipped(&self) -> f64 {
        self.0.first().map_or(0.0, |ear| ear.clipped as f64 / ear.frames.max(1) as f64)
    }

    /// What is heard: the first sound in which a ball is heard.
    pub(super) fn heard(self) -> Heard {
        #[allow(clippy::cast_precision_loss)] // two
        let tries = self.0.len() as f64;
        let mut best: Option<Heard> = None;
        for (n, mut ear) in self.0.into_iter().enumerate() {
            ear.end();
            let onsets = std::mem::take(&mut ear.onsets);
            let mut bounced = Bounced::among(&onsets, false);
            if n > 0
                && let Some(bounced) = &mut bounced
            {
                // Who listens twice hears chance twice as often.
                bounced.evidence.iter_mut().for_each(|evidence| *evidence -= ln(tries));
            }
            let heard = Heard { onsets, bounced };
            let better = best.as_ref().is_none_or(|best| heard.evidence() > best.evidence());
            if better {
                best = Some(heard);
            }
            if best.as_ref().is_some_and(|best| best.bounced.is_some()) {
                break;
            }
        }
        best.unwrap_or(Heard { onsets: Vec::new(), bounced: None })
    }
}

impl Heard {
    /// ln of one over how many drops as good as the surest come by chance.
    fn evidence(&self) -> f64 {
        let evidence = self.bounced.iter().flat_map(|bounced| &bounced.evidence);
        evidence.copied().fold(f64::NEG_INFINITY, f64::max)
    }
}
