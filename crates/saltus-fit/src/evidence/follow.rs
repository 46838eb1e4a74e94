//! Contacts that were missed, heard twice or misread: all ways to read runs of contacts, and what
//! each costs.
//!
//! Under one COR every flight lasts e times the one before it. A way to read a run keeps some of
//! its contacts and says how many flights lie between neighbours. It costs the chi-square of each
//! interval beside the one before, and as much as strong evidence is worth for every contact that
//! it supposes missed, extra or misread. The cheapest way under a COR is found contact by contact
//! (Viterbi, IEEE Trans. Inf. Theory 13 (1967) 260), for CORs from one end of the possible to the
//! other; those that cost about as little as the best are its rivals.

use crate::elementary::{exp, ln, powf};
use crate::statistics::{CLEAR, NORMAL, SCATTER, TELLING, WEAK, median};

/// Between two contacts that are kept lie up to so many flights, and up to one less that are left
/// out.
const APART: usize = 3;
/// The COR of one ball on one floor scatters from bounce to bounce by this part of it, as a
/// standard deviation: of rough marbles the most.
pub(crate) const BOUNCES: f64 = 0.05;
/// The CORs that are tried, and how many: neighbours are nearer than [`BOUNCES`].
const CORS: (f64, f64, u32) = (0.05, 1.25, 70);

/// A contact that is kept: its place in the run, and the flights since the one before it.
pub(super) type Step = (usize, usize);

/// The contacts of one trial.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub(super) times: Vec<f64>,
    /// The first may be the release: the flight after it is a fall, half as long.
    pub(super) from_rest: bool,
}

/// A way to read the runs.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Way {
    pub(super) cost: f64,
    /// What may be a release is one.
    pub(super) released: bool,
    /// What is kept of each run.
    pub(super) runs: Vec<Vec<Step>>,
}

/// What was done to a trial.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Repair {
    /// A contact was missed after this one: later ones count one more.
    Missed { after: f64 },
    /// This contact is a second trigger.
    Double { at: f64 },
    /// This contact was misread.
    Misread { at: f64 },
    /// Nothing before, or nothing after, follows from the rest.
    Ended { last: f64, left_out: usize, before: bool },
}

/// What a way is priced by: the COR, the error of a time, whether a first contact is a release.
#[derive(Clone, Copy, Debug)]
struct Prices {
    e: f64,
    sigma: f64,
    released: bool,
}

/// An interval between kept contacts: how long it is, and its last flight.
#[derive(Clone, Copy, Debug)]
struct Interval {
    whole: f64,
    last: f64,
}

impl Prices {
    /// e + e² + … of so many flights.
    fn flights(&self, count: usize) -> f64 {
        (1..=count).fold((0.0, 1.0), |(sum, power), _| (sum + power * self.e, power * self.e)).0
    }

    fn interval(&self, whole: f64, flights: usize) -> Interval {
        let last = self.e.powi(flights as i32) / self.flights(flights);
        Interval { whole, last: whole * last }
    }

    /// The deviation of an interval from what the one before it says, and its variances by the
    /// error of a time and by the bounces.
    fn deviation(&self, before: Interval, gap: f64, flights: usize) -> (f64, f64, f64) {
        let due = before.last * self.flights(flights);
        let part = due / before.whole;
        (gap - due, 1.0 + (1.0 + part).powi(2) + part * part, (BOUNCES * due).powi(2))
    }

    fn misfit(&self, before: Interval, gap: f64, flights: usize) -> f64 {
        let (off, by_time, by_bounces) = self.deviation(before, gap, flights);
        off * off / (self.sigma * self.sigma * by_time + by_bounces)
    }

    /// What it costs to go from contact `j` to contact `k`, so many flights later.
    fn events(&self, times: &[f64], j: usize, k: usize, flights: usize) -> f64 {
        let nearer = |i: &usize| times[k] - times[*i] < times[*i] - times[j];
        let early = if flights == 1 { (j + 1..k).filter(nearer).count() } else { 0 };
        // Where two ways fit about alike, one that leaves out the earlier of two, or an end without
        // a cause, is the less likely.
        CLEAR * (k - j - 1 + flights - 1) as f64 + WEAK * early as f64
    }

    /// The first interval of a run.
    fn first(&self, run: &Run, (i, j): (usize, usize), flights: usize) -> Interval {
        let whole = run.times[j] - run.times[i];
        let released = self.released && run.from_rest && i == 0;
        if released { Interval { whole, last: 2.0 * whole } } else { self.interval(whole, flights) }
    }

    /// What is left out before and after what is kept, and the release.
    fn ends(&self, run: &Run, first: usize, last: usize) -> f64 {
        let release = usize::from(self.released && run.from_rest);
        (CLEAR + WEAK) * (first + run.times.len() - 1 - last) as f64 + CLEAR * release as f64
    }

    /// The price of keeping these contacts.
    fn price(&self, run: &Run, steps: &[Step]) -> f64 {
        let (Some(first), Some(last)) = (steps.first(), steps.last()) else { return 0.0 };
        let mut price = self.ends(run, first.0, last.0);
        let mut before = None;
        for pair in steps.windows(2) {
            let ((j, _), (k, flights)) = (pair[0], pair[1]);
            let gap = run.times[k] - run.times[j];
            price += self.events(&run.times, j, k, flights);
            price += before.map_or(0.0, |before| self.misfit(before, gap, flights));
            let next = if before.is_none() { self.first(run, (j, k), flights) } else { self.interval(gap, flights) };
            before = Some(next);
        }
        price
    }

    /// The cheapest way to read one run.
    fn cheapest(&self, run: &Run) -> Vec<Step> {
        let count = run.times.len();
        let whole = || (0..count).map(|n| (n, usize::from(n > 0))).collect();
        if count < 3 {
            return whole();
        }
        // One node for each pair of contacts kept one after the other, and the flights between:
        // what it costs so far, and the node before it.
        let place = |j: usize, back: usize, flights: usize| (j * APART + back - 1) * APART + flights - 1;
        let mut nodes: Vec<(f64, Option<usize>)> = vec![(f64::INFINITY, None); count * APART * APART];
        let mut best = (f64::INFINITY, None);
        for j in 1..count {
            for back in 1..=APART.min(j) {
                let (i, gap) = (j - back, run.times[j] - run.times[j - back]);
                if gap <= 0.0 || self.released && run.from_rest && i == 0 && back > 1 {
                    continue;
                }
                for flights in 1..=APART {
                    let here = place(j, back, flights);
                    let begins = self.ends(run, i, count - 1) + self.events(&run.times, i, j, flights);
                    let may_begin = !(self.released && run.from_rest) || i == 0 && flights == 1;
                    let begun = may_begin && begins <= nodes[here].0;
                    if begun {
                        nodes[here] = (begins, None);
                    }
                    let cost = nodes[here].0;
                    if !cost.is_finite() {
                        continue;
                    }
                    let before = if begun { self.first(run, (i, j), flights) } else { self.interval(gap, flights) };
                    let ended = cost + (CLEAR + WEAK) * (count - 1 - j) as f64;
                    if ended < best.0 {
                        best = (ended, Some(here));
                    }
                    for k in j + 1..count.min(j + APART + 1) {
                        let next = run.times[k] - run.times[j];
                        for flights in (1..=APART).filter(|_| next > 0.0) {
                            let cost =
                                cost + self.events(&run.times, j, k, flights) + self.misfit(before, next, flights);
                            let there = &mut nodes[place(k, k - j, flights)];
                            if cost < there.0 {
                                *there = (cost, Some(here));
                            }
                        }
                    }
                }
            }
        }
        let mut steps = Vec::new();
        let mut at = best.1;
        while let Some(node) = at {
            let (pair, flights) = (node / APART, node % APART + 1);
            let (j, back) = (pair / APART, pair % APART + 1);
            steps.push((j, flights));
            at = nodes[node].1;
            if at.is_none() {
                steps.push((j - back, 0));
            }
        }
        steps.reverse();
        if steps.is_empty() { whole() } else { steps }
    }
}

impl Way {
    fn price(&self, runs: &[Run], e: f64, sigma: f64) -> f64 {
        let prices = Prices { e, sigma, released: self.released };
        runs.iter().zip(&self.runs).map(|(run, steps)| prices.price(run, steps)).sum()
    }

    /// The least that it costs near a COR, and where.
    fn at_its_best(&self, runs: &[Run], near: f64, sigma: f64) -> (f64, f64) {
        let golden = 0.5 * (5f64.sqrt() - 1.0);
        let step = ln(CORS.1 / CORS.0) / f64::from(CORS.2);
        let (mut low, mut high) = (ln(near) - step, ln(near) + step);
        let price = |log: f64| self.price(runs, exp(log), sigma);
        // The least of a function of doubles shows to the root of their spacing.
        while high - low > f64::EPSILON.sqrt() {
            let apart = golden * (high - low);
            let (a, b) = (high - apart, low + apart);
            if price(a) < price(b) { high = b } else { low = a }
        }
        let middle = 0.5 * (low + high);
        (price(middle), exp(middle))
    }

    /// The scatter of a time by what the way leaves; `None` of too few.
    fn scatter(&self, runs: &[Run], e: f64) -> Option<f64> {
        let prices = Prices { e, sigma: 1.0, released: self.released };
        let mut sizes = Vec::new();
        for (run, steps) in runs.iter().zip(&self.runs) {
            for three in steps.windows(3) {
                let gap = |n: usize| run.times[three[n].0] - run.times[three[n - 1].0];
                let (off, by_time, _) = prices.deviation(prices.interval(gap(1), three[1].1), gap(2), three[2].1);
                sizes.push(off.abs() / by_time.sqrt());
            }
        }
        let enough = sizes.len() > SCATTER;
        median(&mut sizes).filter(|_| enough).map(|middle| 1.4826 * middle)
    }
}

fn tried() -> impl Iterator<Item = f64> {
    let (low, high, count) = CORS;
    (0..=count).map(move |n| low * powf(high / low, f64::from(n) / f64::from(count)))
}

/// All ways that are the cheapest under some COR, each once, at its best COR and with the best
/// first.
fn found(runs: &[Run], sigma: f64) -> Vec<(Way, f64)> {
    let mut ways: Vec<(Way, f64)> = Vec::new();
    for released in [false, true].into_iter().filter(|r| !r || runs.iter().any(|run| run.from_rest)) {
        for e in tried() {
            let prices = Prices { e, sigma, released };
            let mut way = Way { cost: 0.0, released, runs: runs.iter().map(|run| prices.cheapest(run)).collect() };
            way.cost = way.price(runs, e, sigma);
            match ways.iter_mut().find(|w| w.0.released == released && w.0.runs == way.runs) {
                Some(known) if known.0.cost <= way.cost => {}
                Some(known) => (known.0.cost, known.1) = (way.cost, e),
                None => ways.push((way, e)),
            }
        }
    }
    for (way, e) in &mut ways {
        (way.cost, *e) = way.at_its_best(runs, *e, sigma);
    }
    ways.sort_by(|a, b| a.0.cost.total_cmp(&b.0.cost));
    ways
}

/// The best way to read the runs, and those that cost less than two standard deviations more; empty
/// where too little is there to compare.
///
/// `sigma` is the error of a time, and whether it is stated; else it is no more than what the
/// readings scatter, and no less than `rounding`.
pub(super) fn ways(runs: &[Run], (sigma, stated): (f64, bool), rounding: f64) -> Vec<Way> {
    let few: Vec<Run> = runs
        .iter()
        .map(|run| Run { times: run.times[..run.times.len().min(TELLING)].to_vec(), ..*run })
        .scan(0, |count, run| {
            *count += run.times.len();
            (*count <= TELLING || *count == run.times.len()).then_some(run)
        })
        .collect();
    if few.iter().all(|run| run.times.len() < 4) {
        return Vec::new();
    }
    let mut sigma = sigma;
    let mut all = found(&few, sigma);
    if !stated
        && let Some(scatter) = all.first().and_then(|(way, e)| way.scatter(&few, *e))
        && scatter.max(rounding) < sigma
    {
        sigma = scatter.max(rounding);
        all = found(&few, sigma);
    }
    let Some(least) = all.first().map(|(way, _)| way.cost) else { return Vec::new() };
    let near = all.into_iter().filter(|(way, _)| way.cost <= least + NORMAL * NORMAL);
    let of_all = |(way, e): (Way, f64)| {
        let prices = Prices { e, sigma, released: way.released };
        let whole = |n: usize| few.get(n).is_some_and(|few| few.times.len() == runs[n].times.len());
        let read = |n: usize| if whole(n) { way.runs[n].clone() } else { prices.cheapest(&runs[n]) };
        Way { runs: (0..runs.len()).map(read).collect(), ..way }
    };
    near.map(of_all).collect()
}

/// What was done to a run.
pub(super) fn repairs(times: &[f64], steps: &[Step]) -> Vec<Repair> {
    let (Some(&(first, _)), Some(&(last, _))) = (steps.first(), steps.last()) else { return Vec::new() };
    let mut repairs = Vec::new();
    if first > 0 {
        repairs.push(Repair::Ended { last: times[first], left_out: first, before: true });
    }
    for pair in steps.windows(2) {
        let ((j, _), (k, flights)) = (pair[0], pair[1]);
        let misread = (k - j - 1).min(flights - 1);
        let left_out = |n: usize| times[j + 1 + n];
        repairs.extend((0..misread).map(|n| Repair::Misread { at: left_out(n) }));
        repairs.extend((misread..k - j - 1).map(|n| Repair::Double { at: left_out(n) }));
        repairs.extend((misread..flights - 1).map(|_| Repair::Missed { after: times[j] }));
    }
    if last + 1 < times.len() {
        repairs.push(Repair::Ended { last: times[last], left_out: times.len() - 1 - last, before: false });
    }
    repairs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ideal(count: i32) -> Vec<f64> {
        (0..count).map(|n| (1.0 - 0.8f64.powi(n)) / 0.2).collect()
    }

    /// The steps and repairs of one run, read to 1 ms.
    fn read(times: &[f64]) -> (Vec<Step>, Vec<Repair>) {
        let run = Run { times: times.to_vec(), from_rest: false };
        let steps = ways(&[run], (0.001, true), 0.0)[0].runs[0].clone();
        let repairs = repairs(times, &steps);
        (steps, repairs)
    }

    /// Every kept contact has the number it truly has, but for that of the first.
    fn right(times: &[f64], steps: &[Step]) -> bool {
        let truth = ideal(20);
        let first = truth.iter().position(|t| (t - times[steps[0].0]).abs() < 1e-9).unwrap();
        let numbers = steps.iter().scan(first, |number, step| {
            *number += step.1;
            Some(*number)
        });
        steps.iter().zip(numbers).all(|(step, number)| (truth[number] - times[step.0]).abs() < 1e-9)
    }

    #[test]
    fn a_contact_missed_anywhere_is_counted() {
        for gone in 1..9 {
            let mut times = ideal(10);
            times.remove(gone);
            let (steps, repairs) = read(&times);
            assert!(right(&times, &steps) && steps.len() == 9, "{gone}: {steps:?} {repairs:?}");
            assert!(matches!(repairs[..], [Repair::Missed { .. }]), "{gone}: {repairs:?}");
        }
    }

    #[test]
    fn a_second_trigger_is_taken_out() {
        for twice in 0..9 {
            let mut times = ideal(10);
            times.insert(twice + 1, times[twice] + 0.04);
            let (steps, repairs) = read(&times);
            assert!(right(&times, &steps) && steps.len() == 10, "{twice}: {steps:?}");
            assert!(matches!(repairs[..], [Repair::Double { .. }]), "{twice}: {repairs:?}");
        }
    }

    #[test]
    fn several_faults_in_one_run_are_told_apart() {
        for (twice, gone) in [(0, 5), (1, 4), (4, 1), (6, 2)] {
            let mut times = ideal(10);
            let echo = times[twice] + 0.04;
            times.remove(gone);
            times.push(echo);
            times.sort_by(f64::total_cmp);
            let (steps, repairs) = read(&times);
            assert!(right(&times, &steps) && steps.len() == 9 && repairs.len() == 2, "{steps:?} {repairs:?}");
        }
    }

    #[test]
    fn a_misread_contact_is_left_out_and_the_others_keep_their_numbers() {
        for bad in 1..8 {
            let mut times = ideal(10);
            times[bad] += 0.3 * (times[bad + 1] - times[bad]);
            let (steps, repairs) = read(&times);
            assert!(right(&times, &steps) && steps.len() == 9, "{bad}: {steps:?} {repairs:?}");
        }
    }

    #[test]
    fn whole_runs_are_left_alone() {
        let (steps, repairs) = read(&ideal(12));
        assert!(steps.len() == 12 && repairs.is_empty(), "{steps:?}");
        assert!(ways(&[], (0.01, false), 0.0).is_empty());
    }

    /// Three intervals of which the last is two flights, or all are flights with errors: neither is
    /// out of reach.
    #[test]
    fn readings_that_fit_alike_are_all_found() {
        let run = Run { times: vec![1.3704, 1.9513, 2.2589, 2.4919], from_rest: false };
        let ways = ways(&[run], (0.01, false), 0.0);
        let any = |steps: &[Step]| ways.iter().any(|way| way.runs[0] == steps);
        assert!(any(&[(0, 0), (1, 1), (2, 1), (3, 1)]) && any(&[(0, 0), (1, 1), (2, 1), (3, 2)]), "{ways:?}");
    }

    /// The fall before the first contact is half a flight: a run that begins with a release is
    /// known by that, and no other.
    #[test]
    fn a_release_is_told_from_a_contact() {
        let times: Vec<f64> = [0.0].into_iter().chain(ideal(6).iter().map(|t| t + 0.625)).collect();
        let run = |times: &[f64]| Run { times: times.to_vec(), from_rest: true };
        assert!(ways(&[run(&times)], (0.001, true), 0.0)[0].released);
        assert!(!ways(&[run(&ideal(7))], (0.001, true), 0.0)[0].released);
    }
}
