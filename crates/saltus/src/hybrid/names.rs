//! Whether the names of an automaton of closures are those of its modes and edges, and which was
//! meant.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::sync::{Mutex, OnceLock, PoisonError};

use super::{Hybrid, Mode};
use crate::state::State;

impl<'a, S: State> Hybrid<'a, S> {
    /// The mode of this name, declared by it if it was not before.
    pub(super) fn entry_of(&mut self, name: &'static str) -> &mut Mode<'a, S> {
        self.flaw = OnceLock::new();
        let index = self.modes.iter().position(|mode| mode.name == name).unwrap_or_else(|| {
            let (edges, guarded, clocks, stops) = (Vec::new(), Vec::new(), Vec::new(), self.everywhere.clone());
            let (flow, refusal, series, sparsity, exact, beyond) = (None, None, None, None, None, None);
            self.modes.push(Mode {
                name,
                flow,
                refusal,
                series,
                sparsity,
                exact,
                beyond,
                edges,
                guarded,
                clocks,
                stops,
            });
            self.modes.len() - 1
        });
        &mut self.modes[index]
    }

    pub(super) fn declares(&self, name: &str) -> bool {
        self.find(name).is_some_and(|mode| mode.flow.is_some() || mode.exact.is_some())
    }

    /// What to do about a mode that is not declared.
    pub(super) fn declare(&self, name: &str) -> String {
        let declared = self.modes.iter().map(|mode| mode.name).filter(|name| self.declares(name));
        let near = declared.map(|other| (distance(name, other), other)).min_by_key(|near| near.0);
        let letters = name.chars().count();
        // Of a name of one letter nothing would be left that is alike.
        let most = (letters / 3).max(1).min(letters.saturating_sub(1));
        match near.filter(|near| near.0 <= most) {
            Some((_, other)) => format!("did you mean {other:?}? If not, declare it with Hybrid::mode"),
            None => "declare it with Hybrid::mode".into(),
        }
    }

    /// What keeps every run from starting.
    pub(super) fn find_flaw(&self) -> Option<String> {
        if let Some((method, name)) = self.twice {
            return Some(format!(
                "Hybrid::{method} says twice what holds in mode {name:?}: say it once, or give one of them its own name"
            ));
        }
        for mode in &self.modes {
            let name = mode.name;
            if !self.declares(name) {
                let what = if mode.edges.is_empty() { "is named" } else { "has an edge" };
                return Some(format!("mode {name:?} {what} but is not declared: {}", self.declare(name)));
            }
            if let Some((link, _)) = Self::links(mode).find(|(link, _)| !self.declares(link.to)) {
                let to = self.declare(link.to);
                return Some(format!("edge {link:?} leads to mode {:?}, which is not declared: {to}", link.to));
            }
            if let Some((to, _)) = mode.beyond.as_ref().filter(|(to, _)| !self.declares(to)) {
                let declare = self.declare(to);
                return Some(format!("beyond a limit in {name:?} lies mode {to:?}, which is not declared: {declare}"));
            }
            for (clock, link) in &mode.clocks {
                if let Err(flaw) = clock.validate() {
                    return Some(format!("the clock of edge {link:?} {flaw}"));
                }
            }
            if let Some(flaw) = mode.stops.iter().find_map(|clock| clock.validate().err()) {
                return Some(format!("the clock of the stops in {name:?} {flaw}"));
            }
        }
        let method = self.misplaced?;
        Some(format!(
            "Hybrid::{method} is about the edge declared last, and there is none with a guard: write it at once after its edge"
        ))
    }
}

/// How many characters must be changed, added, left out or exchanged with their neighbour to make
/// one name of another (optimal string alignment).
fn distance(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut rows = [Vec::new(), (0..=other.len()).collect::<Vec<_>>()];
    let mut last = None;
    for (i, c) in one.chars().enumerate() {
        let mut row = vec![i + 1];
        for (j, &d) in other.iter().enumerate() {
            let [before, above] = &rows;
            let mut least = (above[j] + usize::from(c != d)).min(above[j + 1] + 1).min(row[j] + 1);
            if j > 0 && i > 0 && Some(d) == last && other[j - 1] == c {
                least = least.min(before[j - 1] + 1);
            }
            row.push(least);
        }
        let [_, above] = rows;
        rows = [above, row];
        last = Some(c);
    }
    rows[1][other.len()]
}

/// A name for as long as the program runs: of owned ones each is kept once.
pub(super) fn kept(name: impl Into<Cow<'static, str>>) -> &'static str {
    static OWNED: Mutex<BTreeSet<&'static str>> = Mutex::new(BTreeSet::new());
    match name.into() {
        Cow::Borrowed(name) => name,
        Cow::Owned(name) => {
            let mut names = OWNED.lock().unwrap_or_else(PoisonError::into_inner);
            if let Some(name) = names.get(name.as_str()) {
                return name;
            }
            let name: &'static str = name.leak();
            names.insert(name);
            name
        }
    }
}
