//! What the engine asks of an automaton of closures.

use std::borrow::Cow;

use super::{Edge, Hybrid, Link, Mode};
use crate::analysis::reverse::Invertible;
use crate::automaton::clocks::{Clock, Clocks};
use crate::automaton::edges::Edges;
use crate::automaton::solution::Solution;
use crate::automaton::{About, Automaton, Limit};
use crate::error::Refusal;
use crate::series::Series;
use crate::state::State;

impl<'a, S: State> Hybrid<'a, S> {
    /// Every edge of `mode`, also those of clocks.
    pub(super) fn links<'m>(mode: &'m Mode<'a, S>) -> impl Iterator<Item = (Link, &'m Edge<'a, S>)> {
        let from = mode.name;
        mode.edges.iter().enumerate().map(move |(place, (to, edge))| (Link { from, to, place }, edge))
    }

    /// Looks for the very name first, which is what a run mostly has, as a link's names do.
    #[inline]
    pub(super) fn find(&self, name: &str) -> Option<&Mode<'a, S>> {
        let same = self.modes.iter().find(|mode| std::ptr::eq(mode.name, name));
        same.or_else(|| self.modes.iter().find(|mode| mode.name == name))
    }

    pub(super) fn edge_of(&self, link: Link) -> Option<&Edge<'a, S>> {
        self.find(link.from)?.edges.get(link.place).map(|(_, edge)| edge)
    }
}

impl<S: State> Automaton for Hybrid<'_, S> {
    type Mode = &'static str;
    type State = S;
    type Edge = Link;

    fn flow(&self, mode: &'static str, t: f64, x: &S) -> S {
        let mode = self.find(mode);
        if let Some(flow) = mode.and_then(|mode| mode.flow.as_ref()) {
            return flow(t, x);
        }
        match mode.and_then(|mode| mode.exact.as_ref()) {
            // The solution's slope where it starts.
            Some(solution) => solution(t, x).coefficients().get(1).cloned().unwrap_or_else(|| x.with(|_| 0.0)),
            None => x.with(|_| f64::NAN),
        }
    }

    fn edges(&self, mode: &'static str) -> Edges<'_, Link> {
        self.find(mode).map_or(Edges::none(), |mode| Edges::kept(&mode.guarded))
    }

    fn guard(&self, edge: Link, t: f64, x: &S) -> f64 {
        self.edge_of(edge).and_then(|edge| edge.guard.as_ref()).map_or(f64::NAN, |guard| guard(t, x))
    }

    fn clocks(&self, mode: &'static str) -> Clocks<'_, Link> {
        let mode = if self.clocked { self.find(mode) } else { None };
        mode.map_or(Clocks::none(), |mode| Clocks::kept(&mode.clocks))
    }

    fn stops(&self, mode: &'static str) -> Cow<'_, [Clock]> {
        let mode = if self.stopped { self.find(mode) } else { None };
        mode.map_or(Cow::Borrowed(&[]), |mode| Cow::Borrowed(&mode.stops))
    }

    fn reset(&self, _: &'static str, link: Link, t: f64, x: &S) -> Result<(&'static str, S), Refusal> {
        let edge = self.edge_of(link).ok_or_else(|| Refusal::new("there is no such edge"))?;
        Ok((link.to, (edge.reset)(t, x)?))
    }

    fn about(&self, edge: Link) -> About {
        self.edge_of(edge).map_or(About::new(), |edge| edge.about)
    }

    fn solution(&self, mode: &'static str, t: f64, x: &S) -> Solution<Self> {
        match self.find(mode) {
            Some(Mode { exact: Some(solution), .. }) => Solution::Polynomial(solution(t, x)),
            Some(Mode { series: Some(_), .. }) => Solution::Series(Self::expand),
            Some(Mode { sparsity: Some(sparsity), .. }) => Solution::Sparse(sparsity.clone()),
            _ => Solution::Steps,
        }
    }

    fn beyond(&self, limit: &Limit<'_, Self>) -> Option<(&'static str, S)> {
        let (to, reset) = self.find(limit.mode)?.beyond.as_ref()?;
        Some((to, reset(limit.t, limit.x)))
    }

    fn refusal(&self, mode: &'static str, edge: Option<Link>, t: f64, x: &S) -> Option<Refusal> {
        let refusal = match edge {
            Some(edge) => &self.edge_of(edge)?.refusal,
            None => &self.find(mode)?.refusal,
        };
        refusal.as_ref().and_then(|refusal| refusal(t, x))
    }

    fn validate(&self, mode: &'static str, _t: f64, _x: &S) -> Result<(), String> {
        if !self.declares(mode) {
            return Err(format!("the automaton has no mode {mode:?}: {}", self.declare(mode)));
        }
        self.flaw.get_or_init(|| self.find_flaw()).as_ref().map_or(Ok(()), |flaw| Err(flaw.clone()))
    }
}

impl<S: State> Hybrid<'_, S> {
    fn expand(&self, mode: &'static str, series: &mut Series<'_, S>) {
        if let Some(flow) = self.find(mode).and_then(|mode| mode.series.as_ref()) {
            flow(series);
        }
    }
}

impl<S: State> Invertible for Hybrid<'_, S> {
    fn edges_into(&self, mode: &'static str) -> Edges<'_, Link> {
        let links = self.modes.iter().flat_map(Self::links);
        links.filter(|(link, edge)| link.to == mode && !edge.about.terminal).map(|(link, _)| link).collect()
    }

    fn image(&self, edge: Link, t: f64, x: &S) -> f64 {
        let inverse = self.edge_of(edge).and_then(|edge| edge.inverse.as_ref());
        inverse.map_or(f64::NAN, |(image, _)| image(t, x))
    }

    fn undo(&self, edge: Link, t: f64, x: &S) -> (&'static str, S) {
        let inverse = self.edge_of(edge).and_then(|edge| edge.inverse.as_ref());
        (edge.from, inverse.map_or_else(|| x.with(|_| f64::NAN), |(_, undo)| undo(t, x)))
    }

    /// Looks at every edge that a run backwards from `mode` could meet.
    fn validate_backwards(&self, mode: &'static str) -> Result<(), String> {
        let mut met = vec![mode];
        let mut next = 0;
        while let Some(&mode) = met.get(next) {
            next += 1;
            let into = || self.modes.iter().flat_map(Self::links).filter(move |(link, _)| link.to == mode);
            for (link, edge) in into().filter(|(_, edge)| !edge.about.terminal) {
                if edge.inverse.is_none() {
                    return Err(format!(
                        "edge {link:?} has no inverse, so that a run cannot go backwards into mode {:?}: give one with Hybrid::inverse",
                        link.from
                    ));
                }
                if !met.contains(&link.from) {
                    met.push(link.from);
                }
            }
        }
        Ok(())
    }
}
