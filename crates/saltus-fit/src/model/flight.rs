//! Heights and times together under free flight with a given gravity.

use nalgebra::DMatrix;

use super::drag::{Air, Sloped};
use super::dual::Dual;
use super::law::CorLaw;
use super::problem::{Bounds, Model};
use crate::evidence::{Evidence, Height, Moment, TrialEvidence};

/// A table with more readings is left to the models of one COR.
pub(crate) const READINGS: usize = 5000;
/// More bounces than this in a trial are not followed one by one.
pub(crate) const FOLLOWED: usize = 1000;
/// No contact of a ball lasts longer, s.
pub(crate) const LONGEST_CONTACT: f64 = 0.02;

/// What one trial offers to the joint fit.
#[derive(Clone, Debug, Default)]
pub(crate) struct FlightTrial {
    /// The height of release as set, and its standard error if it was measured rather than set.
    pub(crate) release: Option<(f64, Option<f64>)>,
    /// When the ball was let go.
    pub(crate) release_time: Option<f64>,
    /// Apexes after at least one contact.
    pub(crate) heights: Vec<Height>,
    /// `flights` counts from the first contact: contact 1 is after 0 flights.
    pub(crate) moments: Vec<Moment>,
}

impl FlightTrial {
    /// Trials with at least one rebound height and times that fix a clock, with their places in the
    /// table; every error is filled in.
    pub(crate) fn of_both(evidence: &Evidence, sigma_height: f64, sigma_time: f64) -> Vec<(usize, Self)> {
        let rebounds = |t: &TrialEvidence| t.heights.iter().any(|h| h.0 > 0);
        let timed = |t: &TrialEvidence| t.moments.len() + usize::from(t.release_time.is_some()) >= 2;
        let of = |t: &TrialEvidence| {
            let heights = t.heights.iter().filter(|h| h.0 > 0);
            Self {
                release: t.release_height,
                release_time: t.release_time,
                heights: heights.map(|&(n, h, s)| (n, h, s.unwrap_or(sigma_height))).collect(),
                moments: t.moments(sigma_time),
            }
        };
        evidence.trials.iter().filter(|t| rebounds(t) && timed(t)).map(|t| (t.trial, of(t))).collect()
    }

    /// Trials by their heights alone, with a release height that is a reading like the others.
    pub(crate) fn of_heights(evidence: &Evidence, sigma: f64) -> Vec<Self> {
        let one = |heights: Vec<Height>| Self {
            release: heights.first().filter(|h| h.0 == 0).map(|h| (h.1, Some(h.2))),
            // No reading asks for the time; a known one keeps the clock from being an unknown.
            release_time: Some(0.0),
            heights: heights.into_iter().filter(|h| h.0 > 0).collect(),
            moments: Vec::new(),
        };
        evidence.heights(sigma).into_iter().filter(|h| h.len() > 1).map(one).collect()
    }

    /// Trials by their times alone: neither the height nor the time of release is used.
    pub(crate) fn of_times(evidence: &Evidence, sigma: f64) -> Vec<Self> {
        let one = |moments| Self { moments, ..Self::default() };
        evidence.moments(sigma).into_iter().filter(|m| m.len() > 2).map(one).collect()
    }
}

/// Flight between contacts: v₁ is the speed at the first contact, vₙ₊₁ that with which the ball
/// comes back after leaving at e vₙ; heights are read from a zero δ. In still air hₙ = δ + (e
/// v)²/2g and a flight lasts 2 e v/g; with drag both are those of [`Air::hop`].
///
/// Shared: the unknowns of the law of the COR, then on request the zero δ of the height scale (of
/// all heights, or of the rebounds only), a lag of the clock, drag k, and the time that a contact
/// takes: between two of them a flight and one contact pass. Own: v₁ unless the height of release
/// is set, a unless the time of release is known (then a is that time plus the fall, plus the lag).
#[derive(Clone, Debug, Default)]
pub(crate) struct Flight {
    pub(crate) trials: Vec<FlightTrial>,
    pub(crate) gravity: f64,
    pub(crate) law: CorLaw,
    /// The zero of the height scale is unknown within these bounds, m.
    pub(crate) offset: Option<Bounds>,
    /// The release was read from the true zero: δ is that of the rebounds.
    pub(crate) rebounds: bool,
    pub(crate) lag: bool,
    pub(crate) drag: bool,
    /// A contact lasts an unknown time, s, at most this.
    pub(crate) lasting: Option<f64>,
    /// The shared unknowns are known: only own ones are fitted.
    pub(crate) pinned: Option<Vec<f64>>,
    pub(crate) supposed: bool,
}

/// Where the shared unknowns beside those of the law stand.
struct Places {
    offset: Option<usize>,
    lag: Option<usize>,
    drag: Option<usize>,
    lasting: Option<usize>,
}

/// The least drag, in 1/m: less does not differ from none.
const LEAST_DRAG: f64 = 1e-7;

impl Flight {
    /// Whether the speed at the first contact follows from a release height that was set.
    fn speed_is_set(trial: &FlightTrial) -> bool {
        matches!(trial.release, Some((_, None)))
    }

    fn places(&self) -> Places {
        let mut next = self.law.unknowns();
        let mut place = |wanted: bool| {
            next += usize::from(wanted);
            wanted.then(|| next - 1)
        };
        Places {
            offset: place(self.offset.is_some()),
            lag: place(self.lag),
            drag: place(self.drag),
            lasting: place(self.lasting.is_some()),
        }
    }

    /// The own unknowns of a trial for a given COR: the speed from release or first height, the
    /// clock from the first moment.
    pub(crate) fn start(&self, e: f64) -> Vec<Vec<f64>> {
        let one = |trial: &FlightTrial| {
            let first = trial.heights.first();
            let height = match (trial.release, first) {
                (Some((height, _)), _) => height,
                (None, Some(&(n, h, _))) => h / e.max(0.05).powi(i32::try_from(2 * n).unwrap_or(i32::MAX)),
                (None, None) => match (trial.moments.first(), trial.moments.last()) {
                    (Some(a), Some(b)) if b.flights > a.flights => {
                        let sum: f64 =
                            (a.flights + 1..=b.flights).map(|j| e.powi(i32::try_from(j).unwrap_or(i32::MAX))).sum();
                        let v = (b.time - a.time) * self.gravity / (2.0 * sum.max(1e-6));
                        v * v / (2.0 * self.gravity)
                    }
                    _ => 1.0,
                },
            };
            let speed = (2.0 * self.gravity * height.clamp(1e-9, 1e9)).sqrt();
            let mut own = Vec::new();
            if !Self::speed_is_set(trial) {
                own.push(speed);
            }
            if trial.release_time.is_none() {
                own.push(trial.moments.first().map_or(0.0, |m| m.time));
            }
            own
        };
        self.trials.iter().map(one).collect()
    }

    /// The speed at the first contact and the time of it.
    pub(crate) fn first_contact(&self, block: usize, shared: &[f64], own: &[f64]) -> (f64, f64) {
        let start = self.beginning(block, shared, own);
        (start.speed.value, start.clock.value)
    }

    /// What the motion of a trial begins with.
    fn beginning(&self, block: usize, shared: &[f64], own: &[f64]) -> Beginning {
        let trial = &self.trials[block];
        let (q, all) = (own.len(), own.len() + shared.len());
        let places = self.places();
        let unknown = |place: Option<usize>| {
            place.map_or_else(|| Dual::constant(0.0, all), |j| Dual::unknown(shared[j], all, q + j))
        };
        let drag = places.drag.map(|j| q + j);
        let air = Air { gravity: self.gravity, drag: places.drag.map_or(0.0, |j| shared[j]) };
        let offset = unknown(places.offset);
        let zero = if self.rebounds { Dual::constant(0.0, all) } else { offset.clone() };
        let speed = match trial.release {
            Some((height, None)) => {
                let height = Dual::constant(height, all).minus(&zero);
                height.through(&air.speed(height.value.max(0.0)), None, drag)
            }
            _ => Dual::unknown(own[0], all, 0),
        };
        let (fall, height) = air.fallen(speed.value);
        let released = zero.plus(&speed.through(&height, None, drag));
        let clock = match trial.release_time {
            Some(time) => {
                let fall = speed.through(&fall, None, drag);
                Dual::constant(time, all).plus(&fall).plus(&unknown(places.lag))
            }
            None => Dual::unknown(own[q - 1], all, q - 1),
        };
        Beginning { air, drag, offset, speed, released, clock, lasting: unknown(places.lasting) }
    }

    /// The highest release, m.
    pub(crate) fn tallest(&self) -> f64 {
        self.trials.iter().filter_map(|t| t.release.map(|r| r.0)).fold(0.0, f64::max)
    }

    /// The unknown zero of the height scale, where it is one of the shared.
    pub(crate) fn offset_place(&self) -> Option<usize> {
        self.places().offset
    }

    /// The time that a contact takes, where it is one of the shared unknowns.
    pub(crate) fn lasting_place(&self) -> Option<usize> {
        self.places().lasting
    }

    /// The drag, where it is one of the shared unknowns.
    pub(crate) fn drag_place(&self) -> Option<usize> {
        self.places().drag
    }

    /// The largest number of contacts that any row looks back on.
    pub(crate) fn bounces(&self) -> usize {
        let heights = self.trials.iter().flat_map(|t| t.heights.iter().map(|h| h.0));
        heights.chain(self.trials.iter().flat_map(|t| t.moments.iter().map(|m| m.flights))).max().unwrap_or(0)
    }
}

/// What the motion of a trial begins with: the air, the zero of the scale, the first contact and
/// the height fallen from.
struct Beginning {
    air: Air,
    drag: Option<usize>,
    offset: Dual,
    speed: Dual,
    released: Dual,
    clock: Dual,
    lasting: Dual,
}

impl Model for Flight {
    fn supposed(&self) -> bool {
        self.supposed
    }

    fn ranges(&self) -> Vec<(Bounds, f64)> {
        let mut ranges = self.law.ranges();
        if let Some(bounds) = self.offset {
            ranges.push((bounds, 0.05 * self.tallest()));
        }
        if self.lag {
            ranges.push((Bounds { low: -10.0, high: 10.0 }, 0.1));
        }
        if self.drag {
            ranges.push((Bounds { low: LEAST_DRAG, high: 10.0 }, 0.05));
        }
        if let Some(high) = self.lasting {
            ranges.push((Bounds { low: 0.0, high }, high));
        }
        if let Some(values) = &self.pinned {
            ranges.iter_mut().zip(values).for_each(|(range, &v)| range.0 = Bounds { low: v, high: v });
        }
        ranges
    }

    fn size(&self, block: usize) -> (usize, usize) {
        let trial = &self.trials[block];
        let measured = matches!(trial.release, Some((_, Some(_))));
        let rows = trial.heights.len() + trial.moments.len() + usize::from(measured);
        let own = usize::from(!Self::speed_is_set(trial)) + usize::from(trial.release_time.is_none());
        (rows, own)
    }

    fn fill(&self, block: usize, shared: &[f64], own: &[f64], rows: &mut DMatrix<f64>) {
        let trial = &self.trials[block];
        let q = own.len();
        let start = self.beginning(block, shared, own);
        let mut i = 0;
        let mut row = |predicted: &Dual, measured: f64, sigma: f64| {
            for (j, slope) in predicted.by.iter().enumerate() {
                rows[(i, j)] = slope / sigma;
            }
            rows[(i, predicted.by.len())] = (measured - predicted.value) / sigma;
            i += 1;
        };
        if let Some((height, Some(sigma))) = trial.release {
            row(&start.released, height, sigma);
        }
        let through = |x: &Dual, outer: &Sloped| x.through(outer, None, start.drag);
        let (mut heights, mut moments) = (trial.heights.iter().peekable(), trial.moments.iter().peekable());
        let (mut speed, mut contact) = (start.speed.clone(), start.clock.clone());
        for n in 0.. {
            // Here the ball arrives at contact n + 1.
            while let Some(m) = moments.next_if(|m| m.flights == n && !m.apex) {
                row(&contact, m.time, m.sigma);
            }
            if heights.peek().is_none() && moments.peek().is_none() {
                break;
            }
            let cor = self.law.through(n, &speed, &shared[..self.law.unknowns()], q);
            let departure = cor.times(&speed);
            let hop = start.air.hop(departure.value);
            let top = contact.plus(&start.lasting).plus(&through(&departure, &hop.rise));
            while let Some(&(_, height, sigma)) = heights.next_if(|h| h.0 <= n + 1) {
                row(&start.offset.plus(&through(&departure, &hop.height)), height, sigma);
            }
            while let Some(m) = moments.next_if(|m| m.flights == n && m.apex) {
                row(&top, m.time, m.sigma);
            }
            // A reading before its turn has no place here; readings are in order.
            while moments.next_if(|m| m.flights < n).is_some() {}
            contact = top.plus(&through(&departure, &hop.fall));
            speed = through(&departure, &hop.arrival);
        }
    }
}
