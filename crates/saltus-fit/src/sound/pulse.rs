//! Pulses of a signal that is quiet while a ball flies: what a force plate, a load cell or a piezo
//! shows of its contacts.
//!
//! The level of the quiet is followed along the signal, so that an offset, a drift and a ball that
//! lies on the plate are none of a pulse. A pulse is what rises out of the noise, from where it has
//! risen to where it has fallen to one part of its peak; what rings close behind it belongs to it.

use std::f64::consts::PI;

use crate::elementary::{atan, hypot, powf};
use crate::statistics::median;

/// The level is the median of so long, s: a contact lasts for less than half of that.
const LEVEL: f64 = 0.1;
/// A pulse rises so many times the noise: noise alone does once in a thousand million samples.
const RISES: f64 = 6.0;
/// A pulse begins and ends at this part of its peak: a sensor rings by less after it.
const EDGE: f64 = 0.1;
/// A force is as a power of half a sine: the first on a linear spring, three halves of a solid ball
/// (Hertz). Which one shows in how wide a pulse is at this part of its peak, which rises out of the
/// noise, for else its begin is not known;
const HALF: f64 = 0.5;
/// it is one of these, and this one where no pulse has samples enough.
const POWERS: std::ops::Range<f64> = 0.8..2.5;
const POWER: f64 = 1.25;
/// The foot below the edges is known to within this part of it.
const FOOT: f64 = 0.2;
/// Where the level after it is another than before by this part of its peak a load came or went.
const LOAD: f64 = 0.5;
/// What is parted by less, s, is one pulse: the floor rings while the ball is on it.
const JOINED: f64 = 0.002;
/// What comes so soon after a pulse, s, and is less than twice as large, is its ringing.
const RINGS: f64 = 0.02;
const LARGER: f64 = 2.0;
/// A signal swings both ways where the lesser side holds this part of the greater.
const SWINGS: f64 = 0.5;
/// The middle of a pulse, in parts of it, where it rises and falls alike: what rises at once and
/// dies away has it in the first third.
const MIDDLE: std::ops::Range<f64> = 0.4..0.6;
/// A pulse of fewer samples shows no form.
const FORM: usize = 5;
/// The power is found by halving its range so often: to a thousandth.
const HALVED: usize = 11;

/// A pulse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Pulse {
    /// When it begins and ends, s.
    pub(crate) begin: f64,
    pub(crate) end: f64,
    /// The standard error of either, s.
    pub(crate) sigma: f64,
    /// How far it rises.
    pub(crate) peak: f64,
    /// Whether it dies away other than it rose,
    dies: bool,
    /// or swings: it falls and rises again before its end, as no contact does.
    swings: bool,
    /// The part of its peak that it has at its edges,
    part: f64,
    /// and how wide it is at half of its peak, in parts of how wide it is at that of all.
    width: Option<f64>,
}

/// The pulses of a signal.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Pulses {
    pub(crate) pulses: Vec<Pulse>,
    /// The standard deviation of the noise.
    pub(crate) noise: f64,
    /// Whether it swings both ways.
    pub(crate) swings: bool,
}

impl Pulses {
    /// The pulses of samples, one every `step` s.
    pub(crate) fn of(step: f64, samples: &[f64]) -> Self {
        let levels = levels(step, samples);
        let mut signal = levelled(step, samples, &levels);
        let mut sizes: Vec<f64> = signal.iter().map(|x| x.abs()).collect();
        let finest = samples.windows(2).map(|pair| (pair[1] - pair[0]).abs()).filter(|x| *x > 0.0);
        let finest = finest.fold(f64::INFINITY, f64::min);
        // Of normal noise half lies within 0.6745 standard deviations.
        let noise = (median(&mut sizes).unwrap_or(0.0) / 0.6745).max(finest / 12f64.sqrt());
        let least = RISES * noise;
        let side = |sign: f64| signal.iter().map(|x| sign * x).filter(|x| *x > least).sum::<f64>();
        let (up, down) = (side(1.0), side(-1.0));
        let swings = up.min(down) > SWINGS * up.max(down);
        for x in &mut signal {
            *x = if swings {
                x.abs()
            } else if down > up {
                -*x
            } else {
                *x
            };
        }
        let mut pulses: Vec<Pulse> = Vec::new();
        let mut rung: Option<(f64, f64)> = None;
        for (from, to) in risen(step, &signal, least) {
            let pulse = edges(step, &signal, (from, to), (noise, least));
            let rings = |(until, peak): (f64, f64)| seconds(step, from) - until < RINGS && pulse.peak < LARGER * peak;
            let block = from / count(step, LEVEL);
            let level = |block: usize| levels.get(block).or(levels.last()).copied().unwrap_or(0.0);
            let loads = (level(block + 1) - level(block.saturating_sub(1))).abs() > LOAD * pulse.peak;
            if !loads && pulse.part <= HALF && !rung.is_some_and(rings) {
                pulses.push(pulse);
            }
            rung = Some((seconds(step, to), pulse.peak));
        }
        let mut widths: Vec<f64> = pulses.iter().filter_map(|pulse| pulse.width).collect();
        let power = median(&mut widths).map_or(POWER, power);
        for pulse in &mut pulses {
            let below = below(pulse.part, power);
            let foot = (pulse.end - pulse.begin) * below / (1.0 - 2.0 * below);
            (pulse.begin, pulse.end) = (pulse.begin - foot, pulse.end + foot);
            pulse.sigma = hypot(pulse.sigma, FOOT * foot);
        }
        Self { pulses, noise, swings }
    }

    /// Whether the pulses end as they begin, so that their ends tell how long they lasted: what
    /// rings, as a table does that bears a phone, goes on when the ball has left.
    pub(crate) fn end(&self) -> bool {
        let ringing = self.pulses.iter().filter(|pulse| pulse.dies || pulse.swings).count();
        !self.swings && 2 * ringing < self.pulses.len()
    }
}

/// The time of a sample, s.
#[allow(clippy::cast_precision_loss)] // fewer than a table has cells
fn seconds(step: f64, sample: usize) -> f64 {
    step * sample as f64
}

/// So many samples last so long, and one at least.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a part of a second
fn count(step: f64, time: f64) -> usize {
    (time / step).round().max(1.0) as usize
}

/// The level of each block of samples.
fn levels(step: f64, samples: &[f64]) -> Vec<f64> {
    samples.chunks(count(step, LEVEL)).filter_map(|part| median(&mut part.to_vec())).collect()
}

/// Samples above their level, which changes evenly from the middle of a block to that of the next.
#[allow(clippy::cast_precision_loss)] // fewer than a table has cells
fn levelled(step: f64, samples: &[f64], levels: &[f64]) -> Vec<f64> {
    let block = count(step, LEVEL);
    let above = |(n, x): (usize, &f64)| {
        let place = ((n as f64 + 0.5) / block as f64 - 0.5).max(0.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // no more than there are blocks
        let at = place as usize;
        let level = |at: usize| levels.get(at).or(levels.last()).copied().unwrap_or(0.0);
        x - (level(at) + place.fract() * (level(at + 1) - level(at)))
    };
    samples.iter().enumerate().map(above).collect()
}

/// From which sample to which a signal is above the noise, with little in between.
fn risen(step: f64, signal: &[f64], least: f64) -> Vec<(usize, usize)> {
    let mut found: Vec<(usize, usize)> = Vec::new();
    for (n, _) in signal.iter().enumerate().filter(|(_, x)| **x > least) {
        match found.last_mut().filter(|(_, to)| n == *to + 1 || seconds(step, n - *to) < JOINED) {
            Some((_, to)) => *to = n,
            None => found.push((n, n)),
        }
    }
    found
}

/// The pulse between two samples, from edge to edge.
#[allow(clippy::cast_precision_loss)] // fewer than a table has cells
fn edges(step: f64, signal: &[f64], (from, to): (usize, usize), (noise, least): (f64, f64)) -> Pulse {
    let top = (from..=to).max_by(|&a, &b| signal[a].total_cmp(&signal[b])).unwrap_or(from);
    let peak = signal[top];
    let edge = least.max(EDGE * peak);
    // Where it comes above a height and falls below it, by a straight line between samples.
    let crossed = |height: f64| {
        let first = (from..=top).find(|&n| signal[n] >= height).unwrap_or(top);
        let last = (top..=to).take_while(|&n| signal[n] >= height).last().unwrap_or(top);
        let below = |n: Option<usize>| n.and_then(|n| signal.get(n)).copied().unwrap_or(0.0).min(height);
        let (rise, fall) = (signal[first] - below(first.checked_sub(1)), signal[last] - below(Some(last + 1)));
        let part = |above: f64, slope: f64| (above - height) / slope.max(f64::MIN_POSITIVE);
        let (begin, end) = (first as f64 - part(signal[first], rise), last as f64 + part(signal[last], fall));
        (first..=last, step * begin, step * end, rise.min(fall))
    };
    let (within, begin, end, slope) = crossed(edge);
    let inside = || within.clone().map(|n| (seconds(step, n) - begin, signal[n]));
    let middle = inside().map(|(t, x)| t * x).sum::<f64>() / inside().map(|(_, x)| x).sum::<f64>() / (end - begin);
    let formed = within.clone().count() >= FORM;
    // A sample of less than half of what is on either side of it.
    let most = |samples: std::ops::RangeInclusive<usize>| samples.map(|n| signal[n]).fold(0.0, f64::max);
    let dips = |n: usize| signal[n] < HALF * most(*within.start()..=n).min(most(n..=*within.end()));
    let swings = formed && within.clone().any(dips);
    let (_, rose, fell, _) = crossed(HALF * peak);
    let width = (formed && edge <= EDGE * peak).then_some((fell - rose) / (end - begin));
    let sigma = hypot(step / 12f64.sqrt(), step * noise / slope.max(noise));
    Pulse { begin, end, sigma, peak, dies: formed && !MIDDLE.contains(&middle), swings, part: edge / peak, width }
}

/// The part of half a sine, raised to a power, that lies below a part of its peak at either side.
fn below(part: f64, power: f64) -> f64 {
    let sine = powf(part, power.recip());
    atan(sine / (1.0 - sine * sine).max(f64::MIN_POSITIVE).sqrt()) / PI
}

/// The power of half a sine that is so wide at half of its peak: it is the narrower the higher.
fn power(width: f64) -> f64 {
    let of = |power: f64| (1.0 - 2.0 * below(HALF, power)) / (1.0 - 2.0 * below(EDGE, power));
    let halved = |(low, high): (f64, f64), _| {
        let middle = 0.5 * (low + high);
        if of(middle) > width { (middle, high) } else { (low, middle) }
    };
    (0..HALVED).fold((POWERS.start, POWERS.end), halved).0
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What a sensor shows: contacts as (begin, duration, peak), and what else there is.
    struct Made {
        step: f64,
        seconds: f64,
        contacts: Vec<(f64, f64, f64)>,
        /// The form of a contact, from its begin to its end, and what follows, in its duration.
        form: fn(f64) -> f64,
        noise: f64,
        beside: fn(f64) -> f64,
    }

    fn sine(x: f64) -> f64 {
        if (0.0..1.0).contains(&x) { (PI * x).sin() } else { 0.0 }
    }

    impl Made {
        fn of(form: fn(f64) -> f64) -> Self {
            let (mut at, mut contacts) = (0.4, Vec::new());
            for n in 0..8 {
                let lasts = 0.014 * 1.02f64.powi(n);
                contacts.push((at, lasts, 500.0 * 0.75f64.powi(n)));
                at += lasts + 0.6 * 0.75f64.powi(n);
            }
            Self { step: 5e-4, seconds: 4.0, contacts, form, noise: 0.5, beside: |_| 0.0 }
        }

        fn samples(&self) -> Vec<f64> {
            let mut state = 7_u64;
            let mut uniform = || {
                state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
                (state >> 11) as f64 / (1_u64 << 53) as f64
            };
            let count = (self.seconds / self.step) as usize;
            let sample = |n: usize| {
                let t = n as f64 * self.step;
                let felt = self.contacts.iter().map(|&(at, lasts, peak)| peak * (self.form)((t - at) / lasts));
                // Of twelve uniform numbers the sum is all but normal.
                let noise = (0..12).map(|_| uniform()).sum::<f64>() - 6.0;
                felt.sum::<f64>() + self.noise * noise + (self.beside)(t)
            };
            (0..count).map(sample).collect()
        }

        fn found(&self) -> Pulses {
            Pulses::of(self.step, &self.samples())
        }

        /// One pulse for each contact, which begins and ends where it does, within its error and
        /// this, s.
        fn each(&self, within: f64) -> Pulses {
            let found = self.found();
            let begins: Vec<f64> = found.pulses.iter().map(|pulse| pulse.begin).collect();
            assert_eq!(begins.len(), self.contacts.len(), "{begins:?} {:?}", self.contacts);
            for (pulse, (at, lasts, _)) in found.pulses.iter().zip(&self.contacts) {
                for off in [pulse.begin - at, pulse.end - at - lasts] {
                    assert!(off.abs() < within.min(4.0 * pulse.sigma), "{off} {pulse:?}");
                }
            }
            found
        }
    }

    #[test]
    fn pulses_begin_and_end_where_contacts_do() {
        let forms: [fn(f64) -> f64; 4] =
            [sine, |x| sine(x).powf(1.5), |x| sine(x).powi(2), |x| sine(x) * (0.4 - 0.8 * x).exp()];
        for form in forms {
            let found = Made::of(form).each(2.5e-4);
            assert!(found.end() && found.pulses[0].sigma < 4e-4, "{found:?}");
        }
        // Of few samples no form shows.
        let few = Made { step: 4e-3, ..Made::of(sine) }.each(2.5e-3);
        assert!(few.end() && few.pulses.iter().all(|pulse| pulse.width.is_none()));
    }

    #[test]
    fn what_stays_is_none_of_a_pulse() {
        let made = |beside: fn(f64) -> f64| Made { beside, ..Made::of(sine) };
        made(|t| 8000.0 - 40.0 * t).each(3e-4);
        made(|t| if (0.2..3.2).contains(&t) { 0.0 } else { 6.0 }).each(3e-4);
        let down = made(|_| 3.0);
        let turned: Vec<f64> = down.samples().iter().map(|x| -x).collect();
        assert_eq!(Pulses::of(down.step, &turned), down.found());
    }

    #[test]
    fn noise_has_no_pulses() {
        for noise in [0.1, 1.0, 30.0] {
            let made = Made { contacts: Vec::new(), noise, seconds: 40.0, ..Made::of(sine) };
            assert_eq!(made.found().pulses, []);
        }
        // Where samples are rounded more coarsely than they scatter, their steps are the noise.
        let made = Made { noise: 0.1, ..Made::of(sine) };
        let rounded: Vec<f64> = made.samples().iter().map(|x| x.round()).collect();
        assert_eq!(Pulses::of(made.step, &rounded).pulses.len(), 8);
        let faint = Made { noise: 1.5, ..Made::of(sine) };
        assert_eq!(faint.found().pulses.len(), 8);
    }

    #[test]
    fn what_rings_belongs_to_its_contact() {
        let mut made = Made::of(|x| sine(x) + ringing(x));
        // Its last contacts come before the ringing has died away.
        for (at, lasts, peak) in [(2.75, 0.014, 60.0), (2.81, 0.014, 52.0)] {
            made.contacts.push((at, lasts, peak));
        }
        let found = made.each(1e-3);
        assert!(found.end() && !found.swings);
        // One that comes in two parts, the lesser first, is one.
        let parts = Made::of(|x| if x < 0.1 { 1.6 * sine(10.0 * x) * 0.1 } else { sine((x - 0.15) / 0.85) });
        assert_eq!(parts.found().pulses.len(), 8);
        // Contacts with flights of three hundredths of a second are contacts.
        let mut close = Made::of(sine);
        close.contacts = (0..4).map(|n| (0.4 + 0.043 * f64::from(n), 0.013, 500.0 * 0.9f64.powi(n))).collect();
        close.each(3e-3);
    }

    fn ringing(x: f64) -> f64 {
        if x > 1.0 { 0.25 * (-0.25 * (x - 1.0)).exp() * (PI * 3.4 * (x - 1.0)).sin() } else { 0.0 }
    }

    #[test]
    fn what_dies_away_tells_no_end() {
        let dies = Made::of(|x| if x > 0.0 { (-2.0 * x).exp() } else { 0.0 }).found();
        assert!(dies.pulses.len() == 8 && !dies.end() && !dies.swings);
        let clicks = Made::of(|x| if x > 0.0 { (-2.0 * x).exp() * (60.0 * x).sin() } else { 0.0 });
        let clicks = Made { step: 2e-4, ..clicks }.found();
        assert!(clicks.pulses.len() == 8 && clicks.swings && !clicks.end());
    }

    /// The size of what swings is on one side, and rises and falls alike where it grows first.
    #[test]
    fn what_swings_tells_no_end() {
        let rings =
            |x: f64| if x > 0.0 { (x * (1.0 - x)).max(0.0).sqrt() * ((9.0 * x).sin().abs() + 0.1) } else { 0.0 };
        let found = Made::of(rings).found();
        assert!(found.pulses.len() == 8 && !found.swings && !found.end(), "{found:?}");
        assert!(found.pulses.iter().all(|pulse| !pulse.dies), "{found:?}");
    }
}
