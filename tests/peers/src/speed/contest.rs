//! A contest: each solver at its fastest setting whose measured error is below a bound, all timed
//! in turn.

use std::hint::black_box;

use cpu_time::ThreadTime;

/// What a solve leaves: its answer, to be compared with the exact one, and how often it evaluated
/// the flow.
#[derive(Debug, Default)]
pub struct Log {
    pub marks: Vec<f64>,
    pub flows: u64,
}

/// One solve of the whole problem.
pub type Solve = Box<dyn FnMut(&mut Log)>;

/// A way to solve a problem: a solver, its method, who finds the events, and how to make it ready
/// for a tolerance.
pub struct Entry {
    pub solver: &'static str,
    pub method: &'static str,
    pub events: Events,
    pub prepare: Box<dyn Fn(f64) -> Solve>,
    /// Whether the tolerance changes anything.
    pub tolerant: bool,
}

/// Who finds the crossings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Events {
    /// There are none to find.
    None,
    /// The solver.
    Own,
    /// Its user: a sign change between the ends of a step, a root of the dense output, a restart.
    Hand,
    /// A formula.
    Formula,
}

impl Events {
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "",
            Self::Own => "own",
            Self::Hand => "hand",
            Self::Formula => "formula",
        }
    }
}

impl Entry {
    pub fn new(
        solver: &'static str,
        method: &'static str,
        events: Events,
        prepare: impl Fn(f64) -> Solve + 'static,
    ) -> Self {
        Self { solver, method, events, prepare: Box::new(prepare), tolerant: true }
    }

    /// One that has no tolerance.
    pub fn exact(solver: &'static str, method: &'static str, solve: impl Fn(&mut Log) + Clone + 'static) -> Self {
        let prepare = move |_: f64| -> Solve { Box::new(solve.clone()) };
        Self { tolerant: false, ..Self::new(solver, method, Events::Formula, prepare) }
    }
}

/// What is to be solved, and how far an answer is from the truth.
pub struct Problem {
    pub name: &'static str,
    pub title: &'static str,
    pub error: fn(&[f64]) -> f64,
    pub entries: Vec<Entry>,
    /// By how many solves or crossings a time is divided.
    pub per: f64,
}

/// A tolerance tried.
#[derive(Clone, Copy, Debug)]
pub struct Trial {
    pub tolerance: f64,
    pub error: f64,
    pub seconds: f64,
    pub flows: u64,
}

/// The result of one entry at one bound.
#[derive(Clone, Copy, Debug)]
pub struct Result {
    pub trial: Trial,
    /// Quartiles of the CPU time of one solve in seconds: lower, median, upper.
    pub quartiles: [f64; 3],
}

/// Half decades from 1e-3 down to 1e-15.
fn tolerances() -> impl Iterator<Item = f64> {
    (6..=30).map(|k| 10.0_f64.powf(-0.5 * f64::from(k)))
}

/// The CPU time of one solve in seconds, over `count` of them.
fn timed(solve: &mut Solve, log: &mut Log, count: u32) -> f64 {
    let start = ThreadTime::now();
    for _ in 0..count {
        log.marks.clear();
        log.flows = 0;
        solve(black_box(log));
    }
    start.elapsed().as_secs_f64() / f64::from(count)
}

/// How many solves take about `seconds`.
fn batch(once: f64, seconds: f64) -> u32 {
    (seconds / once.max(1e-9)).ceil().clamp(1.0, 1e6) as u32
}

/// A solve that takes longer than this, in seconds, is out of the running, and so are all at
/// tighter tolerances.
const PATIENCE: f64 = 0.1;

/// Runs an entry at every tolerance: error, and a rough time.
pub fn sweep(problem: &Problem, entry: &Entry) -> Vec<Trial> {
    let some: Vec<f64> = if entry.tolerant { tolerances().collect() } else { vec![1e-9] };
    let mut trials = Vec::new();
    for tolerance in some {
        let mut log = Log::default();
        let mut solve = (entry.prepare)(tolerance);
        let once = timed(&mut solve, &mut log, 1);
        if once > PATIENCE {
            break;
        }
        let error = (problem.error)(&log.marks);
        let flows = log.flows;
        let count = batch(once, 3e-4);
        let seconds = (0..5).map(|_| timed(&mut solve, &mut log, count)).fold(f64::INFINITY, f64::min);
        trials.push(Trial { tolerance, error, seconds, flows });
    }
    trials
}

/// The fastest trial with an error of at most `bound`.
pub fn fastest(trials: &[Trial], bound: f64) -> Option<Trial> {
    let good = trials.iter().filter(|trial| trial.error <= bound);
    good.min_by(|a, b| a.seconds.total_cmp(&b.seconds)).copied()
}

/// Times all entries in turn, `rounds` times over, each at its own tolerance.
pub fn race(problem: &Problem, chosen: &[Option<Trial>], rounds: usize) -> Vec<Option<Result>> {
    let mut runners: Vec<_> = problem
        .entries
        .iter()
        .zip(chosen)
        .map(|(entry, trial)| trial.map(|trial| ((entry.prepare)(trial.tolerance), batch(trial.seconds, 1e-3))))
        .collect();
    let mut samples = vec![Vec::with_capacity(rounds); runners.len()];
    let mut log = Log::default();
    for _ in 0..rounds {
        for (runner, samples) in runners.iter_mut().zip(&mut samples) {
            if let Some((solve, count)) = runner {
                timed(solve, &mut log, 1); // what another solver has left in the cache is not its fault
                samples.push(timed(solve, &mut log, *count));
            }
        }
    }
    let results = samples.iter_mut().zip(chosen).map(|(samples, trial)| {
        samples.sort_by(f64::total_cmp);
        let at = |q: usize| samples[(samples.len() - 1) * q / 4];
        trial.map(|trial| Result { trial, quartiles: [at(1), at(2), at(3)] })
    });
    results.collect()
}
