//! Wild samples of a series: those that no flight through their neighbours passes by.
//!
//! All flights bend alike, so two samples of one give its whole parabola. A sample belongs to the
//! motion if a parabola through it and another one nearby passes most samples around them, on
//! either side of it or on both. What passes so few is wild, wherever it lies, and also where
//! neighbours are wild too. What was tracked for a while in another place passes this, but cannot
//! be reached from the ball and back.

use crate::statistics::median;

/// Fewer samples than this do not show what is wild.
const DENSE: usize = 60;
/// In how many neighbouring samples a parabola is looked for, and how many of them it has to pass:
/// flights may be short.
const WINDOWS: [(usize, usize); 3] = [(13, 8), (9, 6), (6, 5)];
/// Samples that together tell how flights bend and scatter.
const BENT: usize = 11;
/// More such windows tell nothing new.
const WINDOWS_BENT: usize = 1000;
/// A parabola passes a sample within this part of the range, or within so many times the scatter.
const NEAR: f64 = 0.01;
const SCATTERS: f64 = 5.0;
/// A sample this many times further from the one before than usual is of something else.
const JUMP: f64 = 4.0;
/// More runs than this are no recording with a few lapses.
const MOST_RUNS: usize = 1000;
/// With more wild samples than this part of all, the series is of something else.
const MOST: f64 = 0.45;

/// So many wild samples in one flight are those of another body: of samples at random no three are,
const BODY: usize = 6;
/// if the flight passes so many times what counts as near: what was tracked beside the ball and
/// stands still passes nothing.
const PASSES: f64 = 4.0;

/// A ball that stays within this part of the range lies, or is held.
const STILL: f64 = 0.02;
/// So many samples at an end tell where that is.
const ENDS: usize = 9;

/// Which samples are wild, how flights bend, and what is near to one.
#[derive(Clone, Debug, Default)]
pub(super) struct Wild {
    pub(super) samples: Vec<bool>,
    bend: f64,
    near: f64,
}

impl Wild {
    /// None of so many.
    pub(super) fn none(count: usize) -> Self {
        Self { samples: vec![false; count], ..Self::default() }
    }
}

/// The wild samples; heights upwards, times ascending. None is where the ball is held before it
/// falls, or lies when all is over.
pub(super) fn wild(times: &[f64], heights: &[f64]) -> Wild {
    let mut samples = vec![false; times.len()];
    let moving = moving(heights);
    let wild = of_moving(&times[moving.clone()], &heights[moving.clone()]);
    samples[moving].copy_from_slice(&wild.samples);
    Wild { samples, ..wild }
}

/// The samples between those at either end that stay where they are, and some of these.
fn moving(heights: &[f64]) -> std::ops::Range<usize> {
    let count = heights.len();
    if count < DENSE {
        return 0..count;
    }
    let mut sorted = heights.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let still = STILL * (sorted[count - 1 - count / 100] - sorted[count / 100]);
    // The median of five passes by wild samples.
    let smooth: Vec<f64> = heights.windows(5).filter_map(|near| median(&mut near.to_vec())).collect();
    let stays = |end: &[f64]| {
        let level = median(&mut end.to_vec()).unwrap_or(0.0);
        move |h: &&f64| (**h - level).abs() <= still
    };
    let (first, last) = (stays(&smooth[..ENDS]), stays(&smooth[smooth.len() - ENDS..]));
    let held = smooth.iter().take_while(first).count().saturating_sub(BENT);
    let lies = smooth.iter().rev().take_while(last).count().saturating_sub(BENT);
    if held + lies < count { held..count - lies } else { 0..count }
}

fn of_moving(times: &[f64], heights: &[f64]) -> Wild {
    let none = Wild::none(times.len());
    if times.len() < DENSE {
        return none;
    }
    let (curvature, scatter) = bend(times, heights);
    let mut sorted = heights.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    // Wild samples may lie far beyond the motion.
    let range = sorted[sorted.len() * 9 / 10] - sorted[sorted.len() / 10];
    let near = (NEAR * range).max(SCATTERS * scatter);
    let mut wild: Vec<bool> = (0..times.len()).map(|i| !belongs(times, heights, i, curvature, near)).collect();
    elsewhere(times, heights, near, &mut wild);
    #[allow(clippy::cast_precision_loss)] // a count
    let part = wild.iter().filter(|wild| **wild).count() as f64 / wild.len() as f64;
    let samples = if part > MOST { none.samples } else { wild };
    Wild { samples, bend: curvature, near }
}

/// How many wild samples between two times lie in one flight, of as many neighbours as show one, if
/// they are those of a body that flies.
pub(super) fn another(times: &[f64], heights: &[f64], wild: &Wild, (from, to): (f64, f64)) -> Option<usize> {
    let (curvature, near) = (wild.bend, wild.near);
    let wide = WINDOWS[0].0;
    let left: Vec<usize> = (0..times.len()).filter(|&i| wild.samples[i] && (from..to).contains(&times[i])).collect();
    let of_pair = |window: &[usize], i: usize, j: usize| {
        let slope = (heights[j] - heights[i]) / (times[j] - times[i]);
        let passes = |k: &&usize| {
            let (s, back) = (times[**k] - times[i], times[**k] - times[j]);
            (heights[**k] - heights[i] - s * (slope + 0.5 * curvature * back)).abs() <= near
        };
        let passed: Vec<f64> = window.iter().filter(passes).map(|&k| heights[k]).collect();
        let ends = passed.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), h| (low.min(*h), high.max(*h)));
        (ends.1 - ends.0 > PASSES * near).then_some(passed.len())
    };
    let of_window = |window: &[usize]| {
        let ends = window.iter().flat_map(|&j| window.iter().map(move |&i| (i, j))).filter(|(i, j)| i < j);
        ends.filter_map(|(i, j)| of_pair(window, i, j)).max()
    };
    let windows = (0..left.len()).map(|n| {
        let near = left[n..].iter().take_while(|&&k| k < left[n] + 2 * wide).count();
        &left[n..n + near]
    });
    windows.filter_map(of_window).max().filter(|samples| *samples >= BODY)
}

/// Whether a parabola of this curvature through sample `i` passes most samples of a window around
/// it.
fn belongs(times: &[f64], heights: &[f64], i: usize, curvature: f64, near: f64) -> bool {
    WINDOWS.iter().any(|&(wide, most)| {
        [0, wide / 2, wide - 1].into_iter().any(|before| {
            let from = i.saturating_sub(before).min(times.len() - wide);
            let window = from..from + wide;
            window.clone().filter(|&j| j != i).any(|j| {
                let slope = (heights[j] - heights[i]) / (times[j] - times[i]);
                let passes = |k: &usize| {
                    let (s, back) = (times[*k] - times[i], times[*k] - times[j]);
                    (heights[*k] - heights[i] - s * (slope + 0.5 * curvature * back)).abs() <= near
                };
                window.clone().filter(passes).count() >= most
            })
        })
    })
}

/// Marks the samples of something else that was tracked for a while: all but the longest chain of
/// runs from each of which the next can be reached.
fn elsewhere(times: &[f64], heights: &[f64], near: f64, wild: &mut [bool]) {
    let kept: Vec<usize> = (0..times.len()).filter(|&i| !wild[i]).collect();
    let mut speeds: Vec<f64> =
        kept.windows(2).map(|w| (heights[w[1]] - heights[w[0]]).abs() / (times[w[1]] - times[w[0]])).collect();
    speeds.sort_unstable_by(f64::total_cmp);
    let Some(usual) = speeds.get(speeds.len() * 9 / 10) else { return };
    let reached =
        |&i: &usize, &j: &usize| (heights[j] - heights[i]).abs() <= JUMP * (near + usual * (times[j] - times[i]));
    let runs: Vec<&[usize]> = kept.chunk_by(reached).collect();
    if runs.len() > MOST_RUNS {
        return;
    }
    // For each run how many samples the best chain that ends with it has, and the run before it
    // there.
    let mut chains: Vec<(usize, Option<usize>)> = Vec::with_capacity(runs.len());
    for (n, run) in runs.iter().enumerate() {
        let before = (0..n).filter(|&m| reached(&runs[m][runs[m].len() - 1], &run[0])).max_by_key(|&m| chains[m].0);
        chains.push((run.len() + before.map_or(0, |m| chains[m].0), before));
    }
    let mut at = (0..runs.len()).max_by_key(|&n| chains[n].0);
    let mut lost = vec![true; runs.len()];
    while let Some(n) = at {
        lost[n] = false;
        at = chains[n].1;
    }
    for (run, _) in runs.iter().zip(lost).filter(|(_, lost)| *lost) {
        run.iter().for_each(|&i| wild[i] = true);
    }
}

/// The curvature of flights, and how far samples scatter about them: by the parabola through three
/// samples of each window that leaves the least median, and the median over windows (P. Rousseeuw,
/// J. Am. Stat. Assoc. 79 (1984) 871).
fn bend(times: &[f64], heights: &[f64]) -> (f64, f64) {
    let (mut curvatures, mut scatters) = (Vec::new(), Vec::new());
    let apart = (times.len() / WINDOWS_BENT).max(3);
    for (t, h) in times.windows(BENT).zip(heights.windows(BENT)).step_by(apart) {
        let mut best = (0.0, f64::INFINITY);
        for a in 0..BENT {
            for b in a + 1..BENT {
                for c in b + 1..BENT {
                    let first = (h[b] - h[a]) / (t[b] - t[a]);
                    let half = ((h[c] - h[b]) / (t[c] - t[b]) - first) / (t[c] - t[a]);
                    let mut left: [f64; BENT] =
                        std::array::from_fn(|k| (h[k] - h[a] - (t[k] - t[a]) * (first + half * (t[k] - t[b]))).abs());
                    let (_, middle, _) = left.select_nth_unstable_by(BENT / 2, f64::total_cmp);
                    if *middle < best.1 {
                        best = (2.0 * half, *middle);
                    }
                }
            }
        }
        curvatures.push(best.0);
        scatters.push(best.1);
    }
    (median(&mut curvatures).unwrap_or(0.0), median(&mut scatters).unwrap_or(0.0))
}
