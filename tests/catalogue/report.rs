//! What became of a case: its observations, what they cost, and what is marked.

use std::fmt;
use std::ops::Range;

use saltus::Stats;
use saltus_tests::reference::{Case, Kind, Observable};

/// A case that is being run, or was.
#[derive(Debug)]
pub(crate) struct Report {
    pub(crate) case: &'static Case,
    pub(crate) seen: Vec<Observation>,
    /// What is not observed, and why not.
    pub(crate) absent: Vec<(&'static Observable, &'static str)>,
    pub(crate) marks: Vec<Mark>,
    pub(crate) stats: Stats,
}

/// An observable and what was observed; the worst, if it was more than once.
#[derive(Clone, Debug)]
pub(crate) struct Observation {
    pub(crate) observable: &'static Observable,
    pub(crate) ours: Ours,
    /// How far from the reference, in tolerances; at most one is met.
    pub(crate) off: f64,
}

#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Ours {
    Number(f64),
    Outcome(String),
}

/// An observable that is known to be missed, by how much in its own unit, and why.
#[derive(Debug)]
pub(crate) struct Mark {
    pub(crate) name: &'static str,
    by: Range<f64>,
    pub(crate) reason: &'static str,
}

impl Report {
    /// Runs the case.
    pub(crate) fn of(id: &str, run: fn(&mut Self)) -> Self {
        let case = Case::named(id);
        let mut report =
            Self { case, seen: Vec::new(), absent: Vec::new(), marks: Vec::new(), stats: Stats::default() };
        run(&mut report);
        report
    }

    /// The binary64 number nearest to the parameter's literal.
    pub(crate) fn param(&self, name: &str) -> f64 {
        self.case.param(name)
    }

    /// The parameters of these names.
    pub(crate) fn params<const N: usize>(&self, names: [&str; N]) -> [f64; N] {
        names.map(|name| self.param(name))
    }

    /// Observes a number.
    pub(crate) fn check(&mut self, name: &str, ours: f64) {
        let observable = self.case.observable(name);
        assert!(observable.kind != Kind::Policy, "{name} is a policy");
        let error = (ours - observable.reference()).abs();
        let off = match observable.kind {
            Kind::Info => 0.0,
            _ if error == 0.0 => 0.0,
            _ => error / observable.allowed(),
        };
        self.record(Observation { observable, ours: Ours::Number(ours), off });
    }

    /// Observes which of several outcomes it was.
    pub(crate) fn outcome(&mut self, name: &str, ours: impl fmt::Display) {
        let observable = self.case.observable(name);
        assert!(observable.kind == Kind::Policy, "{name} is a number");
        let ours = ours.to_string();
        let off = if observable.accept.contains(&ours) { 0.0 } else { f64::INFINITY };
        self.record(Observation { observable, ours: Ours::Outcome(ours), off });
    }

    fn record(&mut self, new: Observation) {
        match self.seen.iter_mut().find(|old| old.observable.name == new.observable.name) {
            Some(old) if new.off > old.off || new.off.is_nan() => *old = new,
            Some(_) => {}
            None => self.seen.push(new),
        }
    }

    /// Says why an observable is not observed.
    pub(crate) fn absent(&mut self, name: &str, why: &'static str) {
        let observable = self.case.observable(name);
        if self.absent.iter().all(|(other, _)| other.name != observable.name) {
            self.absent.push((observable, why));
        }
    }

    /// Says that an observable is missed, by how much in its own unit, and why.
    pub(crate) fn mark(&mut self, name: &'static str, by: Range<f64>, reason: &'static str) {
        self.marks.push(Mark { name, by, reason });
    }

    /// Counts what a run cost.
    pub(crate) fn ran(&mut self, stats: &Stats) {
        let all = &mut self.stats;
        all.jumps += stats.jumps;
        all.steps += stats.steps;
        all.rejected += stats.rejected;
        all.exact += stats.exact;
        all.flows += stats.flows;
        all.guards += stats.guards;
        all.jacobians += stats.jacobians;
    }

    pub(crate) fn is_marked(&self, observation: &Observation) -> bool {
        self.marks.iter().any(|mark| mark.name == observation.observable.name)
    }

    /// The judged observation furthest from its reference, in tolerances.
    pub(crate) fn worst(&self) -> &Observation {
        let judged = || self.seen.iter().filter(|seen| seen.observable.kind != Kind::Info);
        let numbers = judged().filter(|seen| matches!(seen.ours, Ours::Number(_)));
        // Where all are exact a number says more than a policy.
        let list: Vec<_> = numbers.chain(judged()).collect();
        list.iter().fold(list[0], |worst, seen| if seen.off > worst.off { seen } else { worst })
    }

    /// How many observables are met, marked, and neither.
    pub(crate) fn tally(&self) -> Tally {
        let judged = self.seen.iter().filter(|seen| seen.observable.kind != Kind::Info);
        let (marked, met): (Vec<_>, Vec<_>) = judged.partition(|seen| self.is_marked(seen));
        let (met, marked) = (met.len(), marked.len());
        Tally { met, marked, unasked: self.case.observables.len() - met - marked }
    }

    /// What is wrong, one sentence each: an observable not observed, missed, or marked and yet met.
    pub(crate) fn faults(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for observable in &self.case.observables {
            let name = &observable.name;
            let absent = self.absent.iter().any(|(absent, _)| absent.name == *name);
            let seen = self.seen.iter().find(|seen| seen.observable.name == *name);
            let mark = self.marks.iter().find(|mark| mark.name == *name);
            match (seen, mark) {
                (None, _) if absent || observable.kind == Kind::Info => {}
                (None, _) => faults.push(format!("{name} is not observed")),
                (Some(_), _) if absent => faults.push(format!("{name} is observed and called absent")),
                (Some(seen), None) if seen.off > 1.0 || seen.off.is_nan() => faults.push(seen.to_string()),
                (Some(_), None) => {}
                (Some(seen), Some(mark)) => {
                    let error = match seen.ours {
                        Ours::Number(ours) => (ours - observable.reference()).abs(),
                        Ours::Outcome(_) => f64::NAN,
                    };
                    if seen.off <= 1.0 || !mark.by.contains(&error) {
                        faults.push(format!("{seen}; it is marked as {:?} off", mark.by));
                    }
                }
            }
        }
        faults
    }
}

/// How many observables of a case are met, missed and marked as such, and not asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Tally {
    pub(crate) met: usize,
    pub(crate) marked: usize,
    pub(crate) unasked: usize,
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "met {}", self.met)?;
        if self.marked > 0 {
            write!(f, ", **marked {}**", self.marked)?;
        }
        Ok(())
    }
}

impl fmt::Display for Observation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Observable { name, value, .. } = self.observable;
        match &self.ours {
            Ours::Number(ours) => {
                let error = (ours - self.observable.reference()).abs();
                let allowed = self.observable.allowed();
                write!(f, "{name}: {ours:e} instead of {value}, off by {error:e}, allowed {allowed:e}")
            }
            Ours::Outcome(ours) => write!(f, "{name}: {ours:?} is none of {:?}", self.observable.accept),
        }
    }
}
