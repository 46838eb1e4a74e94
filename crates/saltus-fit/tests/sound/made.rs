//! Made sounds, whose contacts are known: clicks of a bouncing ball under noise, echo, ringing and
//! voices; and sounds without a ball.

use std::f64::consts::{PI, TAU};

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// What a sound is of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Clean,
    Noise,
    Rumble,
    Echo,
    Ringing,
    VoiceBefore,
    VoiceFaint,
    Overdriven,
    Lively,
    Dull,
    Talk,
    Music,
    Knocks,
    Roll,
}

impl Kind {
    pub(crate) const ALL: [Self; 14] = [
        Self::Clean,
        Self::Noise,
        Self::Rumble,
        Self::Echo,
        Self::Ringing,
        Self::VoiceBefore,
        Self::VoiceFaint,
        Self::Overdriven,
        Self::Lively,
        Self::Dull,
        Self::Talk,
        Self::Music,
        Self::Knocks,
        Self::Roll,
    ];

    pub(crate) fn about(self) -> &'static str {
        match self {
            Self::Clean => "clean",
            Self::Noise => "noise as loud as the later contacts",
            Self::Rumble => "the rumble of a hall or a road, as loud as the contacts",
            Self::Echo => "two echoes, 20 to 200 ms later, of 0.05 to 0.4",
            Self::Ringing => "a ball that rings for 20 to 50 ms",
            Self::VoiceBefore => "a voice before the drop",
            Self::VoiceFaint => "a faint voice all along",
            Self::Overdriven => "overdriven three- to tenfold",
            Self::Lively => "COR 0.95 to 0.99",
            Self::Dull => "COR 0.3 to 0.5",
            Self::Talk => "talk, and no ball",
            Self::Music => "music with a beat, and no ball",
            Self::Knocks => "knocks, and no ball",
            Self::Roll => "a roll that grows faster and louder, and no ball",
        }
    }

    /// Of how many the ball is heard for sure at least, how many are refused at most (without a
    /// ball, at least), and which part of the contacts is found.
    pub(crate) fn expected(self) -> [f64; 3] {
        match self {
            Self::Clean => [0.76, 0.0, 0.90],
            Self::Noise => [0.28, 0.08, 0.38],
            Self::Rumble => [0.30, 0.20, 0.40],
            Self::Echo => [0.52, 0.12, 0.70],
            Self::Ringing => [0.56, 0.0, 0.78],
            Self::VoiceBefore => [0.56, 0.08, 0.80],
            Self::VoiceFaint => [0.48, 0.36, 0.60],
            Self::Overdriven => [0.64, 0.04, 0.80],
            Self::Lively => [1.0, 0.0, 0.92],
            Self::Dull => [0.0, 0.08, 0.80],
            Self::Talk => [0.0, 1.0, 0.0],
            Self::Music => [0.0, 0.84, 0.0],
            Self::Knocks => [0.0, 0.92, 0.0],
            Self::Roll => [0.0, 0.0, 0.0],
        }
    }

    pub(crate) fn has_ball(self) -> bool {
        !matches!(self, Self::Talk | Self::Music | Self::Knocks | Self::Roll)
    }
}

pub(crate) struct Made {
    pub(crate) rate: u32,
    pub(crate) samples: Vec<f32>,
    /// When the ball touches the floor, s; none without a ball.
    pub(crate) contacts: Vec<f64>,
    pub(crate) cor: f64,
}

struct Dice(ChaCha8Rng);

impl Dice {
    fn from(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn normal(&mut self) -> f64 {
        (-2.0 * self.from(1e-300, 1.0).ln()).sqrt() * (TAU * self.from(0.0, 1.0)).cos()
    }
}

/// The click of a contact: two tones that die out within milliseconds, and for a ball that rings a
/// third that lasts.
struct Click {
    tones: [f64; 2],
    lasts: f64,
    rings: Option<(f64, f64, f64)>,
}

impl Click {
    fn add(&self, samples: &mut [f64], rate: f64, (at, size): (f64, f64), dice: &mut Dice) {
        let phases = [dice.from(-PI, PI), dice.from(-PI, PI)];
        for k in (at * rate).ceil() as usize..((at + 0.25) * rate) as usize {
            let Some(sample) = samples.get_mut(k) else { break };
            let s = k as f64 / rate - at;
            let [first, second] = [0, 1].map(|n| (TAU * self.tones[n] * s + phases[n]).sin());
            let mut sound = (-s / self.lasts).exp() * (first + 0.7 * second);
            if let Some((tone, lasts, part)) = self.rings {
                sound += part * (-s / lasts).exp() * (TAU * tone * s + phases[0]).sin();
            }
            *sample += size * (1.0 - (-s / 0.00015).exp()) * sound;
        }
    }
}

/// Syllables: harmonics of 90 to 220 Hz that set in within 2 to 30 ms, some after a burst of noise.
fn talk(samples: &mut [f64], rate: f64, until: f64, size: f64, dice: &mut Dice) {
    let mut t = 0.05;
    while t < until {
        let (lasts, pitch, loud, sets_in) =
            (dice.from(0.08, 0.3), dice.from(90.0, 220.0), size * dice.from(0.05, 0.4), dice.from(0.002, 0.03));
        let burst = dice.from(0.0, 1.0) < 0.4;
        let glide = dice.from(-0.3, 0.3);
        for k in (t * rate) as usize..((t + lasts).min(until) * rate) as usize {
            let s = k as f64 / rate - t;
            let turn = TAU * pitch * (s + 0.5 * glide * s * s / lasts);
            let voice: f64 = (1..20).map(|m| (turn * f64::from(m)).sin() / f64::from(m)).sum();
            let noise = if burst && s < 0.01 { 0.5 * dice.normal() } else { 0.0 };
            let Some(sample) = samples.get_mut(k) else { break };
            *sample += loud * (0.4 * (1.0 - (-s / sets_in).exp()) * (1.0 - s / lasts) * voice + noise);
        }
        t += lasts + dice.from(0.02, 0.25);
    }
}

fn music(samples: &mut [f64], rate: f64, click: &Click, dice: &mut Dice) {
    let (beat, end) = (dice.from(0.2, 0.6), samples.len() as f64 / rate);
    let mut t = 0.1;
    while t < end {
        let size = dice.from(0.1, 0.5);
        for (after, chance, part) in [(0.0, 1.0, 1.0), (0.5, 0.4, 0.5), (0.75, 0.2, 0.5)] {
            if dice.from(0.0, 1.0) < chance {
                let at = t + after * beat + 0.003 * dice.normal();
                click.add(samples, rate, (at.max(0.0), part * size), dice);
            }
        }
        let tone = 220.0 * (dice.from(0.0, 24.0).floor() / 12.0).exp2();
        for k in (t * rate) as usize..((t + 2.0 * beat) * rate) as usize {
            let Some(sample) = samples.get_mut(k) else { break };
            let s = k as f64 / rate - t;
            let both = (TAU * tone * s).sin() + 0.5 * (2.0 * TAU * tone * s).sin();
            *sample += 0.15 * (-s / 0.3).exp() * (1.0 - (-s / 0.005).exp()) * both;
        }
        t += beat;
    }
}

/// The times and speeds of the contacts of a ball dropped from 0.15 to 1.5 m, whose bounces scatter
/// by 0.4 % and which keeps up to 2 % less when it is fast.
fn bounces(cor: f64, dice: &mut Dice) -> Vec<(f64, f64)> {
    let gravity = 9.81;
    let first = (2.0 * gravity * dice.from(0.15, 1.5)).sqrt();
    let falls = dice.from(0.0, 0.02);
    let (mut t, mut v) = (dice.from(0.3, 1.2), first);
    let mut found = vec![(t, 1.0)];
    while found.len() < 60 {
        v *= (cor * (1.0 - falls * v / first) * (1.0 + 0.004 * dice.normal())).min(0.995);
        if 2.0 * v / gravity < 0.02 || v < 0.02 * first {
            break;
        }
        t += 2.0 * v / gravity;
        found.push((t, v / first));
    }
    found
}

/// A sound of a kind.
pub(crate) fn make(kind: Kind, seed: u64) -> Made {
    let mut dice = Dice(ChaCha8Rng::seed_from_u64(seed));
    let rate = [22_050, 44_100, 48_000][dice.from(0.0, 3.0) as usize];
    let per_second = f64::from(rate);
    let cor = match kind {
        Kind::Lively => dice.from(0.95, 0.99),
        Kind::Dull => dice.from(0.3, 0.5),
        _ => dice.from(0.5, 0.95),
    };
    let contacts = bounces(cor, &mut dice);
    let end = contacts[contacts.len() - 1].0 + dice.from(0.5, 1.5);
    let mut samples = vec![0.0; (end * per_second) as usize];
    let tones = [dice.from(400.0, 4000.0), dice.from(1000.0, 9000.0)];
    let rings = (kind == Kind::Ringing).then(|| (dice.from(1e3, 3e3), dice.from(0.02, 0.05), dice.from(0.1, 0.3)));
    let click = Click { tones, lasts: dice.from(0.0015, 0.006), rings };
    let echoes = if kind == Kind::Echo {
        vec![(dice.from(0.02, 0.12), dice.from(0.1, 0.4)), (dice.from(0.05, 0.2), dice.from(0.05, 0.2))]
    } else {
        vec![(dice.from(0.002, 0.012), dice.from(0.1, 0.4))]
    };
    match kind {
        Kind::Talk => talk(&mut samples, per_second, end, 1.0, &mut dice),
        Kind::Music => music(&mut samples, per_second, &click, &mut dice),
        Kind::Knocks => {
            let mut t = 0.2;
            while t < end {
                let size = dice.from(0.05, 0.5);
                click.add(&mut samples, per_second, (t, size), &mut dice);
                t += dice.from(0.05, 0.6);
            }
        }
        Kind::Roll => {
            let grows = dice.from(0.05, 0.15);
            for (k, &(t, _)) in contacts.iter().enumerate() {
                let size = 0.1 * (grows * k as f64).exp().min(8.0) * (0.2 * dice.normal()).exp();
                click.add(&mut samples, per_second, (t, size), &mut dice);
            }
        }
        _ => {
            for &(t, v) in &contacts {
                let size = 0.5 * v.powf(1.3) * (0.2 * dice.normal()).exp();
                click.add(&mut samples, per_second, (t, size), &mut dice);
                for &(late, part) in &echoes {
                    click.add(&mut samples, per_second, (t + late, part * size), &mut dice);
                }
            }
            match kind {
                Kind::VoiceBefore => talk(&mut samples, per_second, contacts[0].0 - 0.15, 1.0, &mut dice),
                Kind::VoiceFaint => talk(&mut samples, per_second, end, 0.1, &mut dice),
                _ => {}
            }
        }
    }
    let noise = match kind {
        Kind::Noise => dice.from(0.01, 0.04),
        Kind::Clean => 1e-4,
        _ => dice.from(1e-4, 4e-3),
    };
    let (hum, gain) =
        (dice.from(0.0, 0.02), if kind == Kind::Overdriven { dice.from(3.0, 10.0) } else { dice.from(0.2, 1.2) });
    let (mut low, mut lowest) = (0.0, [0.0; 3]);
    let rumble = if kind == Kind::Rumble { dice.from(0.5, 2.0) } else { 0.0 };
    let follows = 1.0 - (-TAU * 400.0 / per_second).exp();
    let recorded = samples.iter().enumerate().map(|(k, x)| {
        low = 0.98 * low + 0.2 * dice.normal();
        let rest = 0.7 * noise * (dice.normal() + low) + hum * (TAU * 50.0 * k as f64 / per_second).sin();
        let mut next = if rumble > 0.0 { dice.normal() } else { 0.0 };
        for stage in &mut lowest {
            *stage += follows * (next - *stage);
            next = *stage;
        }
        let rest = rest + rumble * next;
        ((gain * (x + rest)).clamp(-1.0, 1.0) * 32767.0).round() as f32 / 32768.0
    });
    let samples = recorded.collect();
    let contacts = if kind.has_ball() { contacts.into_iter().map(|(t, _)| t).collect() } else { Vec::new() };
    Made { rate, samples, contacts, cor }
}
