//! Single heights in another unit than the others: a metre among centimetres makes a ball that
//! rises again, or one fall unlike all others.

use std::collections::HashMap;

use super::cell::Cell;
use super::columns::Columns;
use super::heading::What;
use super::region::Region;
use super::{Event, Trial};
use crate::finding::{Lines, Remark, Warning};
use crate::statistics::median;

/// What mixed units differ by, cm and m, mm and m, and mm and cm; and a decimal point that has
/// slipped.
const FACTORS: [f64; 6] = [100.0, 0.01, 1000.0, 0.001, 10.0, 0.1];
/// Falls from bounce to bounce that differ by so much ask for a reason,
const UNLIKE: f64 = 30.0;
/// which a factor is if with it they differ by no more than this,
const ALIKE: f64 = 3.0;
/// and no height is greater than the one before by more than this.
const RISE: f64 = 1.1;
/// Falls of so many trials of a setting show how far they scatter,
const SCATTERED: usize = 4;
/// and one that is off by more than half a decade beside that is nearer to a slipped point than to
/// the others.
const HALF_DECADE: f64 = std::f64::consts::LN_10 / 2.0;
/// Lower heights are mostly reading error, whose falls mean nothing, m.
const LOW: f64 = 0.01;

/// A reading that fits the others once it is multiplied.
struct Stray {
    trial: usize,
    reading: usize,
    factor: f64,
}

/// Warns of single heights that are ten, a hundred or a thousand times too small or too large
/// beside the others of their trial.
pub(super) fn warn(region: &Region<'_>, columns: &Columns, trials: &[Trial], warnings: &mut Vec<Remark<Warning>>) {
    let found = strays(trials);
    for stray in found.iter().take(Lines::NAMED) {
        let reading = &trials[stray.trial].readings[stray.reading];
        let holds = |row: usize, column: usize| match region.view.read(row, column) {
            Cell::Number(m) => m
                .unit
                .or(columns.columns[column].unit)
                .filter(|u| Some(u.si(m.value)) == reading.height)
                .map(|_| m.value),
            _ => None,
        };
        let heights: Vec<usize> =
            columns.values().filter(|(_, _, v)| v.what == What::Height).map(|(n, _, _)| n).collect();
        let rows = || region.rows.iter().copied();
        let place =
            rows().flat_map(|row| heights.iter().map(move |&column| (row, column))).find_map(|(row, column)| {
                let here = region.view.line(row, column) == reading.line;
                holds(row, column).filter(|_| here).map(|number| (row, column, number))
            });
        let Some((row, column, number)) = place else { continue };
        let reading = region.cell(row, column).to_owned();
        let (at, instead) = (region.view.error(row, column, "").spot(), written(number * stray.factor));
        warnings.push(Warning::Stray { at, reading, factor: stray.factor, instead }.into());
    }
    if found.len() > Lines::NAMED {
        warnings.push(Warning::MoreStrays { heights: found.len() - Lines::NAMED }.into());
    }
}

/// A number without what the last bits of a product add to it.
fn written(number: f64) -> f64 {
    format!("{number:.9e}").parse().unwrap_or(number)
}

fn strays(trials: &[Trial]) -> Vec<Stray> {
    let heights: Vec<Vec<(usize, usize, f64)>> = trials.iter().map(of_bounces).collect();
    // What trials of the same setting have in common: the usual fall, where there are a few others,
    // and the usual height.
    let mut alike: HashMap<&str, (Vec<f64>, Vec<f64>)> = HashMap::new();
    for (trial, own) in trials.iter().zip(&heights) {
        let (all, sizes) = alike.entry(&trial.setting).or_default();
        all.extend(falls(own));
        sizes.extend(own.iter().map(|h| h.2));
    }
    // A ball that rises above where it fell from asks for a reason too: the falls of all others
    // tell.
    let mut falling: Vec<f64> = heights.iter().flat_map(|own| falls(own)).filter(|fall| *fall < RISE.ln()).collect();
    let others = heights.len() > 1 && falling.len() > 1;
    let of_all = median(&mut falling);
    let usual: HashMap<&str, (usize, Option<f64>, f64, f64)> = alike
        .into_iter()
        .map(|(setting, (mut all, mut sizes))| {
            let fall = median(&mut all);
            (setting, (all.len(), fall, scatter(&all), median(&mut sizes).unwrap_or(0.0)))
        })
        .collect();
    let one = |(trial, own): (usize, &Vec<(usize, usize, f64)>)| {
        let (count, fall, scatter, size) = *usual.get(trials[trial].setting.as_str())?;
        let rises = falls(own).any(|fall| fall > RISE.ln());
        let fall = fall.filter(|_| count > own.len() && !rises);
        let (unlike, alike) = match fall {
            Some(_) if scatter + HALF_DECADE < UNLIKE.ln() => (scatter + HALF_DECADE, scatter + RISE.ln()),
            _ => (UNLIKE.ln(), ALIKE.ln()),
        };
        let fall = fall.or(of_all.filter(|_| rises && others));
        in_trial(own, (fall, size), (unlike, alike)).map(|(reading, factor)| Stray { trial, reading, factor })
    };
    heights.iter().enumerate().filter_map(one).collect()
}

/// How far falls, from the least to the greatest, scatter as logarithms: twice their middle half,
/// in which no single one counts; no end where they are few.
fn scatter(falls: &[f64]) -> f64 {
    let n = falls.len();
    if n < SCATTERED { f64::INFINITY } else { 2.0 * (falls[3 * n / 4] - falls[n / 4]) }
}

/// The heights of a trial that have a logarithm: the place of the reading, the number of the
/// bounce, the logarithm.
fn of_bounces(trial: &Trial) -> Vec<(usize, usize, f64)> {
    let all = trial.readings.iter().enumerate();
    let heights = all.filter(|(_, r)| r.event != Event::Sample);
    heights.filter_map(|(n, r)| r.height.filter(|h| *h > 0.0).map(|h| (n, r.bounce, h.ln()))).collect()
}

/// The logarithm of what a height is of the one before, for each bounce between them.
fn falls(heights: &[(usize, usize, f64)]) -> impl Iterator<Item = f64> + '_ {
    let forward = heights.windows(2).filter(|w| w[1].1 > w[0].1);
    #[allow(clippy::cast_precision_loss)] // counts of bounces
    forward.map(|w| (w[1].2 - w[0].2) / (w[1].1 - w[0].1) as f64)
}

/// The least and the greatest fall of a trial and of what is usual.
fn range(heights: &[(usize, usize, f64)], usual: Option<f64>) -> (f64, f64) {
    falls(heights).chain(usual).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), fall| (l.min(fall), h.max(fall)))
}

/// The reading of a trial that is in another unit, as its place, and the factor that is missing; of
/// two the one that comes to the usual size. Falls that differ by `unlike` ask for a reason, which
/// a factor is if with it they differ by less than `alike`.
fn in_trial(
    heights: &[(usize, usize, f64)],
    (usual, size): (Option<f64>, f64),
    (unlike, alike): (f64, f64),
) -> Option<(usize, f64)> {
    let (least, most) = range(heights, usual);
    if most - least < unlike && (most < RISE.ln() || usual.is_none()) {
        return None;
    }
    // It stands at one of the falls that are unlike the others.
    let extreme = |w: &[(usize, usize, f64)]| falls(w).any(|fall| fall <= least || fall >= most);
    let at = heights.windows(2).position(extreme)?;
    let mut best: Option<((f64, f64), usize, f64)> = None;
    for place in at..heights.len().min(at + 3) {
        for factor in FACTORS {
            let mut changed = heights.to_vec();
            changed[place].2 += factor.ln();
            let (least, most) = range(&changed, usual);
            // Differences that are rounding alone must not decide.
            let how = (((most - least) * 1e6).round(), (changed[place].2 - size).abs());
            let read = changed.iter().all(|h| h.2 >= LOW.ln());
            if read && most - least < alike && most < RISE.ln() && best.is_none_or(|b| how < b.0) {
                best = Some((how, heights[place].0, factor));
            }
        }
    }
    best.map(|(_, reading, factor)| (reading, factor))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::Table;

    fn found(heights: &[f64]) -> Option<(usize, f64)> {
        strays(&Table::from_heights(heights).unwrap().trials).first().map(|s| (s.reading, s.factor))
    }

    #[test]
    fn a_single_height_in_another_unit() {
        assert_eq!(found(&[100.0, 0.64, 41.0]), Some((1, 100.0)));
        assert_eq!(found(&[100.0, 64.0, 0.41]), Some((2, 100.0)));
        assert_eq!(found(&[1.0, 64.0, 41.0]), Some((0, 100.0)));
        assert_eq!(found(&[1.0, 0.64, 410.0, 0.26, 0.17]), Some((2, 0.001)));
    }

    #[test]
    fn balls_that_hardly_bounce_and_noise_are_none() {
        for heights in [
            [1.0, 0.01, 1e-4, 1e-6].as_slice(),
            &[1.0, 0.01],
            &[1.0, 0.1, 0.01, 0.003, 0.001, 0.002],
            &[1.0, 0.3, 0.05, 0.01],
            // A ball that hardly bounces, read to a centimetre.
            &[1.0, 0.009, 0.008],
            &[1.0, 0.0, 0.0],
            &[0.5, 1.0, 0.2, 0.9],
        ] {
            assert_eq!(found(heights), None, "{heights:?}");
        }
    }
}
