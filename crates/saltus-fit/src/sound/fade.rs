//! How the sounds of a drop fade: those of a ball with the energy of its impacts, which the flights
//! between them tell.

use super::onset::Onset;
use crate::elementary::ln;

/// The power of sounds loses at least this part of what the energy of the impacts loses, in
/// decibels: that of a ball loses all and more, and half of it where a recorder turns itself up.
const PART: f64 = 0.25;
/// What a loss is surely more than: so many of its standard errors away.
const SURELY: f64 = 2.0;
/// The scatter about a line shows in so many points.
const FEWEST: usize = 4;
/// A unit of the natural logarithm of a power, in decibels.
const DECIBELS: f64 = 4.342_944_819_032_518;

/// How much fainter the contacts of a drop become from the first to the last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Fade {
    /// By how much their sounds do, decibels, and its standard error.
    pub(crate) lost: f64,
    error: f64,
    /// By how much the energy of the impacts does.
    pub(crate) due: f64,
}

impl Fade {
    /// That of contacts, as places among the onsets and their numbers.
    #[allow(clippy::cast_precision_loss)] // numbers of contacts
    pub(super) fn of(onsets: &[Onset], contacts: &[(usize, usize)]) -> Self {
        let level = |&(n, number): &(usize, usize)| (number as f64, onsets[n].level());
        let flight = |pair: &[(usize, usize)]| {
            let lasts = onsets[pair[1].0].time - onsets[pair[0].0].time;
            (pair[1].1 == pair[0].1 + 1).then_some((pair[0].1 as f64, 2.0 * ln(lasts)))
        };
        let levels: Vec<(f64, f64)> = contacts.iter().map(level).collect();
        let energies: Vec<(f64, f64)> = contacts.windows(2).filter_map(flight).collect();
        let count = contacts.first().zip(contacts.last()).map_or(0.0, |(a, b)| (b.1 - a.1) as f64);
        let ((lost, error), (due, _)) = (line(&levels), line(&energies));
        let all = -DECIBELS * count;
        Self { lost: all * lost, error: (all * error).abs(), due: all * due }
    }

    /// Whether the sounds surely fade by less than those of a ball.
    pub(crate) fn is_none(self) -> bool {
        self.lost + SURELY * self.error < PART * self.due
    }
}

/// The slope of a line through points, and its standard error; no end to that through fewer than
/// four.
fn line(points: &[(f64, f64)]) -> (f64, f64) {
    let count = points.len() as f64;
    if points.len() < FEWEST {
        return (0.0, f64::INFINITY);
    }
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / count;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let spread: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let slope = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum::<f64>() / spread;
    let left: f64 = points.iter().map(|p| (p.1 - y - slope * (p.0 - x)).powi(2)).sum();
    (slope, (left / (count - 2.0) / spread).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sounds of a ball of 0.9 whose power falls as so great a power of the energy, with a scatter.
    fn fade(count: usize, power: f64, scatter: f64) -> Fade {
        let mut time = 0.0;
        let mut onsets = Vec::new();
        for k in 0..count {
            let energy = 0.9_f64.powi(2 * k as i32);
            let off = scatter * if k % 2 == 0 { 1.0 } else { -1.0 };
            #[allow(clippy::cast_possible_truncation)] // a power
            onsets.push(Onset { time, sigma: 1e-4, power: (energy.powf(power) * off.exp()) as f32 });
            time += 0.6 * 0.9_f64.powi(k as i32);
        }
        let contacts: Vec<(usize, usize)> = (0..count).map(|k| (k, k + 1)).collect();
        Fade::of(&onsets, &contacts)
    }

    #[test]
    fn what_fades_as_energy_does_is_a_ball_and_what_grows_is_none() {
        let full = fade(12, 1.0, 0.0);
        assert!((full.lost - full.due).abs() < 0.02 * full.due && (full.due - 11.0 * 0.915).abs() < 0.05, "{full:?}");
        for count in 4..20 {
            for power in [0.5, 1.0, 1.5] {
                assert!(!fade(count, power, 0.5).is_none(), "{count} {power}");
            }
            let surely = count > 8;
            assert!(!surely || fade(count, -0.5, 0.3).is_none(), "{count}");
        }
        // Three contacts tell nothing.
        assert!(!fade(3, -1.0, 0.0).is_none());
    }
}
