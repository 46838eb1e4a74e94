//! Tracks of one film: those that stand still, and those that were followed at once.

use super::Table;

/// A track that moves less than this part of what the liveliest does is not the ball.
const MOVES: f64 = 0.5;

/// Whether some tracks were followed at the same time: they are of several bodies.
pub(super) fn at_once(parts: &[(String, Table)]) -> bool {
    let span = |(_, table): &(String, Table)| {
        let times = || table.trials.iter().flat_map(|t| &t.readings).filter_map(|r| r.time);
        (times().fold(f64::INFINITY, f64::min), times().fold(f64::NEG_INFINITY, f64::max))
    };
    let mut spans: Vec<(f64, f64)> = parts.iter().map(span).collect();
    spans.sort_by(|a, b| a.0.total_cmp(&b.0));
    spans.windows(2).any(|pair| pair[1].0 < pair[0].1)
}

/// Takes out the tracks of things that stand still while the ball moves.
pub(super) fn leave_still(parts: &mut Vec<(String, Table)>) -> Vec<String> {
    let travel = |table: &Table| {
        let heights = || table.trials.iter().flat_map(|t| &t.readings).filter_map(|r| r.height);
        heights().fold(f64::NEG_INFINITY, f64::max) - heights().fold(f64::INFINITY, f64::min)
    };
    let most = parts.iter().map(|(_, table)| travel(table)).fold(0.0, f64::max);
    let mut still = Vec::new();
    parts.retain(|(label, table)| {
        let moves = travel(table) >= MOVES * most;
        if !moves {
            still.push(label.clone());
        }
        moves
    });
    still
}
