//! One hop that is played for ever, and a motion turned around.

use std::f64::consts::TAU;

use crate::motion::{Motion, MotionError, Piece, Point, Stretch, Track};

/// Ends that differ by less than this part of the motion's size are the same.
const SAME: f64 = 1e-6;

impl Motion {
    /// Hop `number`, from contact `number` to the next, counted from 1, to be played for ever: it
    /// ends in the place, and as far turned, as it starts.
    ///
    /// A ball that travels stays where it is: its way sideways is taken out, evenly. One that turns
    /// makes the nearest number of whole turns. The loop starts at 0 s; it has whole frames once it
    /// is [snapped](Self::snapped).
    ///
    /// # Errors
    /// [`MotionError`] with several balls, where there is no such hop, and where it ends higher or
    /// lower than it starts.
    pub fn looped(&self, number: usize) -> Result<Self, MotionError> {
        let fail = |says: String| Err(MotionError(says));
        let [track] = &self.tracks[..] else {
            return fail("several balls have no hop in common: only the motion of one ball can be a loop".to_owned());
        };
        let touched: Vec<usize> =
            (0..track.stretches.len()).filter(|&n| track.stretches[n].contact.is_some()).collect();
        let (Some(&from), Some(&to)) = (number.checked_sub(1).and_then(|n| touched.get(n)), touched.get(number)) else {
            let hops = touched.len().saturating_sub(1);
            return fail(format!("there is no hop {number}: the motion has {hops} from one contact to the next"));
        };
        let hop = &track.stretches[from..to];
        let (start, end) = (hop[0].start(), hop[hop.len() - 1].end());
        let (a, b) = (hop[0].at(start), track.stretches[to].at(end));
        let [_, [low, top]] = self.reach();
        if (b[2] - a[2]).abs() > SAME * (top - low) {
            let by = b[2] - a[2];
            return fail(format!(
                "hop {number} ends {:.4} m {} than it starts: it cannot be a loop",
                by.abs(),
                if by > 0.0 { "higher" } else { "lower" }
            ));
        }
        let drift: Point = std::array::from_fn(|axis| if axis < 2 { (b[axis] - a[axis]) / (end - start) } else { 0.0 });
        let turn = whole(hop);
        let stretches = hop.iter().map(|stretch| {
            let pieces = stretch.pieces.iter().map(|piece| still(piece, start, drift, turn)).collect();
            Stretch { pieces, ..*stretch }
        });
        let track = Track { stretches: stretches.collect(), ..track.clone() };
        Ok(Self { tracks: vec![track], loops: true, ..self.clone() })
    }

    /// Left and right exchanged: x becomes -x.
    #[must_use]
    pub fn mirrored(&self) -> Self {
        let place = |[x, y, up]: Point| [-x, y, up];
        // What turns about x turns as before, what turns about the others the other way round.
        let spin = |[x, y, up]: Point| [x, -y, -up];
        let mut mirrored = self.clone();
        for stretch in mirrored.tracks.iter_mut().flat_map(|track| &mut track.stretches) {
            if let Some(contact) = &mut stretch.contact {
                contact.normal = place(contact.normal);
            }
            for piece in &mut stretch.pieces {
                piece.coefficients.iter_mut().for_each(|c| *c = place(*c));
                piece.spin.iter_mut().for_each(|c| *c = spin(*c));
            }
        }
        mirrored.ground.iter_mut().flatten().for_each(|point| point[0] = -point[0]);
        mirrored
    }
}

/// A piece from another zero of time, without its drift, turning `turn` times as fast.
fn still(piece: &Piece, start: f64, drift: Point, turn: f64) -> Piece {
    let mut piece = Piece { start: piece.start - start, ..piece.clone() };
    piece.coefficients.resize(piece.coefficients.len().max(2), [0.0; 3]);
    let (gone, c) = (piece.start, &mut piece.coefficients);
    c[0] = std::array::from_fn(|axis| c[0][axis] - drift[axis] * gone);
    c[1] = std::array::from_fn(|axis| c[1][axis] - drift[axis]);
    piece.spin.iter_mut().flatten().for_each(|c| *c *= turn);
    piece
}

/// The factor of the spin by which it comes around whole times.
fn whole(hop: &[Stretch]) -> f64 {
    let pieces = hop.iter().flat_map(|stretch| &stretch.pieces);
    let turned: Point = pieces.fold([0.0; 3], |sum, piece| {
        let by = |axis: usize| {
            let terms = piece.spin.iter().enumerate().rev();
            piece.span * terms.fold(0.0, |sum, (k, c)| sum * piece.span + c[axis] / (k as f64 + 1.0))
        };
        std::array::from_fn(|axis| sum[axis] + by(axis))
    });
    let turns = turned.iter().map(|c| c * c).sum::<f64>().sqrt() / TAU;
    if turns > 0.0 { turns.round() / turns } else { 1.0 }
}
