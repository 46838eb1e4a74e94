//! One recording: scaled, cut, fitted by every model, and given in its own units again.

mod after;
mod air;
mod described;
pub(super) mod weigh;

use super::flights::{self, Flights, NoFlights};
use super::parabolas::{Sketch, sketch};
use super::samples::Samples;
use super::wild::{Wild, another, wild};
use crate::elementary::{asinh, atan, hypot};
use crate::model::{BEFORE, FLOOR, GRAVITY, LASTING, LEAST_DRAG, Law, Model, SPEED, Sample, TIME, Trajectory};
use crate::quantity::Measured;
use crate::solve::least_squares::Failure;
use crate::solve::robust::HUBER;
use crate::solve::successive::{Fitted, fit};
use crate::statistics::median;

/// A sample this many standard deviations away is no sample of the ball.
const WILD: f64 = 6.0;
/// Huber's weights are found so often at most; half as often for very many samples, where only a
/// model that does not fit has need of more.
const ROUNDS: usize = 12;
/// Weights are settled where an unknown moves by less than this part of its error.
const STAYS: f64 = 1e-3;
/// Starts are tried on so many samples at most.
const COARSE: usize = 1500;
/// Candidates of k times the range of heights to start from.
const DRAGS: [f64; 3] = [0.01, 0.1, 0.4];
/// Samples whose scatter is less than this part of the range have this much.
const LEAST_NOISE: f64 = 1e-9;
/// The time of a contact to start from, in units in which G and the range of heights are one.
const LASTS: f64 = 0.03;

/// Why a series gives no motion.
#[derive(Clone, Debug)]
pub(crate) enum Refusal {
    Flights(NoFlights),
    Fit(Failure),
}

/// How a model is named among its rivals: the law of its COR and whether it has drag.
pub(crate) type Choice = (Law, bool);

pub(super) const CHOICES: [Choice; 6] = [
    (Law::Constant, false),
    (Law::Linear, false),
    (Law::Each, false),
    (Law::Constant, true),
    (Law::Linear, true),
    (Law::Each, true),
];

/// How the recording was scaled: height = floor + range · y, time = first contact + unit · t, so
/// that G is about one.
#[derive(Clone, Copy, Debug)]
struct Scale {
    origin: (f64, f64),
    unit: f64,
    range: f64,
}

/// A model fitted to a recording, in scaled units.
#[derive(Clone, Debug)]
struct Found {
    choice: Choice,
    fitted: Fitted,
    /// The robust standard deviation of what is left.
    sigma: f64,
    bic: f64,
    cor: Measured,
}

/// A recording with contacts that take no time, and with such that do, where that shows.
#[derive(Clone, Debug)]
pub(crate) struct Recording {
    instant: Candidates,
    /// The other, and by how much its BIC is better.
    lasting: Option<(Candidates, f64)>,
}

impl Recording {
    /// Fits every model to one series.
    pub(crate) fn of(trial: usize, series: &Samples, (repair, drag): (bool, Option<f64>)) -> Result<Self, Refusal> {
        let mut rough = Candidates::cut(trial, series, repair)?;
        rough.hold(drag);
        let instant = rough.clone().fitted(repair)?;
        // After a single impact the height of the floor does the same; where one COR has no use for
        // such a time, it would only follow noise.
        let lasting = (instant.impacts() > 1).then(|| Candidates { contact: true, ..rough }.fitted(repair).ok());
        let usable = |all: &Candidates| {
            all.found.iter().any(|found| found.choice == (Law::Constant, false))
                && 10 * all.samples.len() > 9 * instant.samples.len()
        };
        let lasting = lasting.flatten().filter(usable).map(|lasting| {
            let gain = lasting.gain(&instant);
            (lasting, gain)
        });
        Ok(Self { instant, lasting })
    }

    /// How many wild samples are in one flight of another body.
    pub(crate) fn another_body(&self) -> Option<usize> {
        self.instant.body
    }

    /// By how much the BIC of contacts that take time is better; `None` where that does not show.
    pub(crate) fn gain(&self) -> Option<f64> {
        self.lasting.as_ref().map(|lasting| lasting.1)
    }

    /// All models with contacts that take time if `lasting` (and that shows), or such that
    /// take none.
    pub(crate) fn under(&self, lasting: bool) -> &Candidates {
        self.lasting.as_ref().filter(|_| lasting).map_or(&self.instant, |lasting| &lasting.0)
    }
}

/// All models of a recording.
#[derive(Clone, Debug)]
pub(crate) struct Candidates {
    trial: usize,
    turned: bool,
    scale: Scale,
    samples: Vec<Sample>,
    wild: usize,
    /// How many of these are in one flight of another body.
    body: Option<usize>,
    left_out: (usize, usize),
    /// Among those after the last flight are some that no flight passes.
    brief: bool,
    noise: f64,
    sketch: Sketch,
    found: Vec<Found>,
    /// The floor drifts, as where a camera turns.
    drift: bool,
    /// Contacts take time.
    contact: bool,
    /// The drag of models that leave it no unknown, in scaled units; and whether it was stated, so
    /// that no model leaves it unknown.
    held: f64,
    stated: bool,
    /// By how much the errors grow because neighbouring residuals are alike.
    dependence: f64,
}

impl Candidates {
    /// One series cut into flights, with a sketch of its motion.
    fn cut(trial: usize, series: &Samples, repair: bool) -> Result<Self, Refusal> {
        let found = if repair { wild(&series.times, &series.heights) } else { Wild::none(series.times.len()) };
        let wild = &found.samples;
        let kept = |values: &[f64]| -> Vec<f64> {
            values.iter().zip(wild).filter(|(_, wild)| !**wild).map(|(value, _)| *value).collect()
        };
        let (kept_times, heights) = (kept(&series.times), kept(&series.heights));
        let span = kept_times.last().copied().unwrap_or(0.0) - kept_times.first().copied().unwrap_or(0.0);
        let top = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let range = top - heights.iter().copied().fold(f64::INFINITY, f64::min);
        if !(span > 0.0 && range > 0.0 && span.is_finite() && range.is_finite()) {
            return Err(Refusal::Flights(NoFlights::NoBounce));
        }
        let start = kept_times[0];
        let times: Vec<f64> = kept_times.iter().map(|t| (t - start) / span).collect();
        let heights: Vec<f64> = heights.iter().map(|h| (h - top) / range).collect();
        let flights = flights::cut(&times, &heights).map_err(Refusal::Flights)?;
        let rough = sketch(&flights)?;
        // A unit of time in which G is one.
        let unit = (1.0 / rough.gravity).sqrt();
        let scale =
            Scale { origin: (start + span * rough.contacts[0], top + range * rough.floor), unit: span * unit, range };
        let sketch = Sketch {
            gravity: 1.0,
            contacts: rough.contacts.iter().map(|t| (t - rough.contacts[0]) / unit).collect(),
            floor: 0.0,
            speed: rough.speed * unit,
            cors: rough.cors,
        };
        let (from, to) = (flights.starts[0], flights.starts[flights.starts.len() - 1]);
        let samples: Vec<Sample> = (from..to)
            .map(|i| Sample {
                time: (flights.times[i] - rough.contacts[0]) / unit,
                height: flights.heights[i] - rough.floor,
                weight: 1.0,
            })
            .collect();
        let Flights { noise, left_out, .. } = flights;
        // What no flight passes before the fall or after the last flight is not wild: the last
        // bounces have too few samples each.
        let (begin, end) = (kept_times[from], kept_times[to - 1]);
        let misfits = || series.times.iter().zip(wild).filter(|(_, wild)| **wild).map(|(time, _)| *time);
        let (early, late) = (misfits().filter(|t| *t < begin).count(), misfits().filter(|t| *t > end).count());
        let left_out = (left_out.0 + early, left_out.1 + late);
        Ok(Self {
            trial,
            turned: series.turned,
            scale,
            samples,
            wild: misfits().count() - early - late,
            body: another(&series.times, &series.heights, &found, (begin, end)),
            brief: late > 0,
            left_out,
            noise,
            sketch,
            found: Vec::new(),
            drift: false,
            contact: false,
            held: 0.0,
            stated: false,
            dependence: 1.0,
        })
    }

    /// Fits every model, with a floor that drifts where that is clearly better.
    fn fitted(mut self, repair: bool) -> Result<Self, Failure> {
        let mut drifting = Self { drift: true, ..self.clone() };
        self.fit_and_trim(repair)?;
        let drifts = self.leaves_more_than_noise()
            && self.impacts() > 1
            && drifting.fit_and_trim(repair).is_ok()
            && drifting.is_clearly_better_than(&self);
        Ok(if drifts { drifting } else { self })
    }

    fn impacts(&self) -> usize {
        self.sketch.contacts.len()
    }

    /// Gravity as the flights of the sketch have it, in the table's units.
    fn gravity(&self) -> f64 {
        self.scale.range / (self.scale.unit * self.scale.unit)
    }

    fn fit_and_trim(&mut self, repair: bool) -> Result<(), Failure> {
        self.fit_all()?;
        for _ in 0..3 {
            if !self.trim(repair) {
                break;
            }
            self.fit_all()?;
        }
        self.weigh();
        Ok(())
    }

    fn model<'a>(&self, samples: &'a [Sample], (law, drag): Choice) -> Trajectory<'a> {
        let step = (samples[samples.len() - 1].time - samples[0].time) / samples.len() as f64;
        Trajectory {
            samples,
            impacts: self.impacts(),
            drag,
            held: self.held,
            drift: self.drift,
            contact: self.contact.then_some(self.noise.max(LEAST_NOISE)),
            law,
            speed: self.sketch.speed,
            first: (0.0, 5.0 * step + 0.05),
            high: 1.5,
        }
    }

    /// Fits all models, each COR for itself first: the others start from there, or from the sketch
    /// where so many are not determined.
    fn fit_all(&mut self) -> Result<(), Failure> {
        self.found.clear();
        for drag in [false, true].into_iter().filter(|drag| !(*drag && self.stated)) {
            let own = self.starts(drag);
            let each = self.best((Law::Each, drag), &own)?;
            let near: Vec<&[f64]> = match &each {
                Some(each) => vec![&each.fitted.shared],
                None => own.iter().map(Vec::as_slice).collect(),
            };
            let alike = |near: &&[f64]| {
                let (head, cors) = near.split_at(near.len() - self.impacts());
                [cors.iter().sum::<f64>() / cors.len() as f64, cors[0]].map(|e| [head, &[e]].concat())
            };
            let starts: Vec<Vec<f64>> = near.iter().flat_map(alike).collect();
            if self.impacts() > 1 {
                let constant = self.best((Law::Constant, drag), &starts)?;
                self.found.extend(constant);
            }
            if self.impacts() > 2 {
                let starts: Vec<Vec<f64>> =
                    starts.iter().step_by(2).map(|start| [start.as_slice(), &[0.0]].concat()).collect();
                let linear = self.best((Law::Linear, drag), &starts)?;
                self.found.extend(linear);
            }
            let law = if self.impacts() > 1 { Law::Each } else { Law::Constant };
            self.found.extend(each.map(|each| Found { choice: (law, drag), ..each }));
        }
        if self.found.is_empty() { Err(Failure::NotIdentified) } else { Ok(()) }
    }

    /// Where the fit with a COR for every impact starts: from the parabolas' sketch.
    fn starts(&self, drag: bool) -> Vec<Vec<f64>> {
        let Sketch { speed, cors, .. } = &self.sketch;
        let drift: &[f64] = if self.drift { &[0.0] } else { &[] };
        let lasts: &[f64] = if self.contact { &[LASTS, BEFORE[0].0, BEFORE[1].0] } else { &[] };
        let start = |air: &[f64], cors: &[f64]| [&[0.0, *speed, 0.0, 1.0], air, drift, lasts, cors].concat();
        if drag { DRAGS.iter().map(|&k| start(&[k], &self.cors_with(k))).collect() } else { vec![start(&[], cors)] }
    }

    /// The CORs that the durations of the flights mean under drag, with G = 1.
    fn cors_with(&self, k: f64) -> Vec<f64> {
        let mut arrival = self.sketch.speed.min(0.9 / k.sqrt());
        let mut cors: Vec<f64> = Vec::new();
        for (n, w) in self.sketch.contacts.windows(2).enumerate() {
            let lasts = k.sqrt() * (w[1] - w[0]);
            let (mut low, mut high) = (0.0f64, 20.0f64);
            for _ in 0..60 {
                let u = 0.5 * (low + high);
                if atan(u) + asinh(u) < lasts { low = u } else { high = u }
            }
            let departure = low / k.sqrt();
            cors.push((departure / arrival).clamp(0.01, 1.4));
            arrival = departure / (1.0 + low * low).sqrt();
            debug_assert_eq!(cors.len(), n + 1);
        }
        cors.push(cors.last().copied().or(self.sketch.cors.last().copied()).unwrap_or(0.7));
        cors
    }

    /// The best fit of a model from several starts; `None` where it is not determined, or has a
    /// drag or a time of contact that is none.
    fn best(&self, choice: Choice, starts: &[Vec<f64>]) -> Result<Option<Found>, Failure> {
        let place = self.model(&self.samples, choice).contact_place();
        let some = |found: &Found| {
            let values = &found.fitted.shared;
            let drag = !choice.1 || values[GRAVITY + 1] > 2.0 * LEAST_DRAG;
            drag && place.is_none_or(|j| values[j] > 2.0 * LASTING.low)
        };
        Ok(self.least_of(choice, starts)?.filter(some))
    }

    /// The best fit of a model from several starts, robust against wild samples; `None` where it is
    /// not determined.
    fn least_of(&self, choice: Choice, starts: &[Vec<f64>]) -> Result<Option<Found>, Failure> {
        let every = self.samples.len().div_ceil(COARSE);
        let coarse: Vec<Sample> = self.samples.iter().step_by(every).copied().collect();
        let mut best: Option<Fitted> = None;
        for start in starts {
            match fit(&self.model(&coarse, choice), start, vec![Vec::new()]) {
                Ok(found) if best.as_ref().is_none_or(|b| found.chi_square < b.chi_square) => best = Some(found),
                Ok(_) | Err(Failure::NotIdentified | Failure::Malformed) => {}
                Err(failure) => return Err(failure),
            }
        }
        let Some(best) = best else { return Ok(None) };
        let mut values = best.shared;
        let mut samples = self.samples.clone();
        let mut last = None;
        for _ in 0..if self.samples.len() > COARSE { ROUNDS / 2 } else { ROUNDS } {
            let fitted = match fit(&self.model(&samples, choice), &values, vec![Vec::new()]) {
                Ok(fitted) => fitted,
                Err(Failure::NotIdentified | Failure::Malformed) => return Ok(None),
                Err(failure) => return Err(failure),
            };
            let before = std::mem::replace(&mut values, fitted.shared.clone());
            let left = self.left(&values, choice);
            let sigma = self.spread(&left);
            for ((sample, r), trust) in samples.iter_mut().zip(&left).zip(self.trust(&values, choice)) {
                sample.weight = trust * huber_weight(r / sigma).sqrt();
            }
            let stays = |j: usize| {
                let moved = (values[j] - before[j]).abs();
                moved < 1e-7 || moved < STAYS * sigma * fitted.covariance[(j, j)].sqrt()
            };
            let settled = (0..values.len()).all(stays);
            last = Some((fitted, sigma));
            if settled {
                break;
            }
        }
        let Some((fitted, sigma)) = last else { return Ok(None) };
        let cor = Measured { value: 0.0, standard_error: 0.0 };
        Ok(Some(Found { choice, fitted, sigma, bic: 0.0, cor }))
    }

    /// Sample less motion, as far as it is trusted.
    fn left(&self, values: &[f64], choice: Choice) -> Vec<f64> {
        let model = self.model(&self.samples, choice);
        let mut rows = nalgebra::DMatrix::zeros(model.size(0).0, values.len() + 1);
        model.fill(0, values, &[], &mut rows);
        let trust = self.trust(values, choice);
        rows.column(values.len()).iter().zip(trust).map(|(r, trust)| r * trust).collect()
    }

    /// What each sample weighs beside one in flight, since where a ball is within a contact is
    /// hardly known.
    fn trust(&self, values: &[f64], choice: Choice) -> Vec<f64> {
        let noise = self.noise.max(LEAST_NOISE);
        let depths = self.model(&self.samples, choice).depths(values);
        depths.into_iter().map(|depth| 1.0 / hypot(depth / noise, 1.0)).collect()
    }

    /// The robust standard deviation of residuals, not below what rounding leaves.
    fn spread(&self, left: &[f64]) -> f64 {
        let mut sizes: Vec<f64> = left.iter().map(|r| r.abs()).collect();
        (1.4826 * median(&mut sizes).unwrap_or(0.0)).max(1e-9)
    }

    /// Takes out samples that are not of the ball in flight: at both ends where it was held or
    /// caught, and, if `repair`, wild ones between.
    fn trim(&mut self, repair: bool) -> bool {
        let Some(best) = self.found.iter().min_by(|a, b| a.sigma.total_cmp(&b.sigma)) else { return false };
        let left = self.left(&best.fitted.shared, best.choice);
        let sigma = best.sigma.max(self.noise);
        let out = |r: &f64| r.abs() > 4.0 * sigma;
        let first = best.fitted.shared[TIME];
        let before = self.samples.iter().take_while(|s| s.time < first).count();
        let after = self.samples.len() - before;
        // Never more than a third of the fall, or of all that follows.
        let head = left.iter().take_while(|r| out(r)).count().max(self.held(best, &left)).min(before / 3);
        let tail = left.iter().rev().take_while(|r| out(r)).count().min(after / 3);
        let kept = head..self.samples.len() - tail;
        let was = self.samples.len();
        let wild = |i: &usize| left[*i].abs() > WILD * sigma;
        let wild_count = kept.clone().filter(wild).count();
        // So many cannot be outliers: the model is wrong there.
        let drop_wild = repair && wild_count <= kept.len() / 3;
        self.samples =
            kept.filter(|i| !(drop_wild && wild(i))).map(|i| Sample { weight: 1.0, ..self.samples[i] }).collect();
        self.left_out = (self.left_out.0 + head, self.left_out.1 + tail);
        self.wild += if drop_wild { wild_count } else { 0 };
        self.samples.len() < was
    }

    /// How many samples before the top of the fall follow a ball that is held there better than one
    /// that was thrown up.
    fn held(&self, best: &Found, left: &[f64]) -> usize {
        let model = self.model(&self.samples, best.choice);
        let (air, apexes) = (model.air(&best.fitted.shared), model.apexes(&best.fitted.shared));
        let rising = self.samples.iter().zip(left).take_while(|(sample, _)| sample.time < apexes[0].0);
        let (thrown, at_rest) = rising.clone().fold((0.0, 0.0), |(thrown, at_rest), (sample, r)| {
            let drop = air.drop(sample.time - apexes[0].0).value;
            (thrown + r * r, at_rest + (r - drop).powi(2))
        });
        if at_rest < thrown { rising.count() } else { 0 }
    }
}

fn huber_weight(z: f64) -> f64 {
    if z.abs() <= HUBER { 1.0 } else { HUBER / z.abs() }
}

/// The unknowns' places are used by name; this one is implied by the order of the starts above.
const _: () = assert!(TIME == 0 && SPEED == 1 && FLOOR == 2 && GRAVITY == 3);

impl From<Failure> for Refusal {
    fn from(failure: Failure) -> Self {
        Self::Fit(failure)
    }
}
