//! From infinitely many hops to finitely many, and from contacts anywhere to contacts on whole
//! frames.

use crate::motion::{Motion, MotionError, Piece, Point, Stretch, Track};
use crate::rate::Frames;

/// The quantity that is kept when contacts move to whole frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Snap {
    /// Gravity: every flight lasts the nearest whole number n of frames, so a hop on a level floor
    /// is g n²/(8 fps²) high.
    Gravity,
    /// The places that the ball goes through: each contact moves to the nearest frame, and each
    /// flight is as much slower or faster.
    Heights,
}

impl Motion {
    /// Ends runs of hops that are each shorter than `span` in s: there the ball lies, or moves
    /// straight along what it bounces on.
    ///
    /// Bounces that lose a part of their speed are infinitely many; no file can hold them. The last
    /// height that is left out is below g `span`²/8.
    #[must_use]
    pub fn cut(&self, span: f64) -> Self {
        let tracks = self.tracks.iter().map(|track| Track { stretches: cut(&track.stretches, span), ..track.clone() });
        Self { tracks: tracks.collect(), ..self.clone() }
    }

    /// Moves every contact to a whole frame; on twos to every second one.
    ///
    /// By [`Snap::Gravity`] the places of contacts stay, and so does what pulls: a ball let go from
    /// rest starts higher or lower, one that is thrown is thrown faster or slower. By
    /// [`Snap::Heights`] every place stays.
    ///
    /// # Errors
    /// [`MotionError`] by [`Snap::Gravity`] with several balls, or where something besides gravity
    /// acts in flight.
    pub fn snapped(&self, snap: Snap, frames: Frames) -> Result<Self, MotionError> {
        match (snap, &self.tracks[..]) {
            (Snap::Heights, _) => Ok(self.paced(frames)),
            (Snap::Gravity, [track]) => Ok(Self { tracks: vec![thrown(track, frames, self.loops)?], ..self.clone() }),
            (Snap::Gravity, _) => {
                let says = "balls that meet cannot all keep gravity and meet on whole frames: snap by heights";
                Err(MotionError(says.to_owned()))
            }
        }
    }

    /// The motion with time stretched between contacts so that each is on a frame.
    fn paced(&self, frames: Frames) -> Self {
        let step = frames.step();
        let mut times: Vec<f64> = self.tracks.iter().flat_map(Track::contacts).filter(|&t| t > 0.0).collect();
        times.push(self.end());
        times.sort_by(f64::total_cmp);
        times.dedup_by(|b, a| *b - *a < 1e-9 * a.max(1.0));
        let mut knots = vec![[0.0, 0.0]];
        let mut last = 0.0;
        for t in times {
            last = (t / step).round().max(last + 1.0);
            knots.push([t, last * step]);
        }
        let tracks = self.tracks.iter().map(|track| {
            let stretches = track.stretches.iter().flat_map(|stretch| pace(stretch, &knots)).collect();
            Track { stretches, ..track.clone() }
        });
        Self { tracks: tracks.collect(), ..self.clone() }
    }

    /// The largest difference of the tops of flights from those of another version of the same
    /// motion, in m.
    #[must_use]
    pub fn tops_differ(&self, other: &Self) -> f64 {
        let pairs = self.tracks.iter().zip(&other.tracks).flat_map(|(a, b)| a.stretches.iter().zip(&b.stretches));
        pairs.map(|(a, b)| (a.top().0 - b.top().0).abs()).fold(0.0, f64::max)
    }
}

fn cut(stretches: &[Stretch], span: f64) -> Vec<Stretch> {
    let mut kept: Vec<Stretch> = Vec::new();
    let (mut from, mut ended_in_cut) = (0, false);
    while let Some(first) = stretches.get(from) {
        let short = stretches[from..].iter().take_while(|stretch| stretch.span() < span).count();
        let run = &stretches[from..from + short];
        let last = from + short == stretches.len();
        // One short flight between long ones is a hop like any other, unless the motion ends in it.
        if run.iter().filter(|stretch| stretch.flight).count() > usize::from(!last) && (from > 0 || !last) {
            let (start, end) = (first.start(), run[run.len() - 1].end());
            let (a, b) = (first.at(start), run[run.len() - 1].at(end));
            let slope = std::array::from_fn(|axis| (b[axis] - a[axis]) / (end - start));
            let spin = evenly(run, end - start);
            let line = Piece { start, span: end - start, coefficients: vec![a, slope], spin };
            kept.push(Stretch { contact: first.contact, flight: false, pieces: vec![line] });
            from += short;
            ended_in_cut = true;
        } else {
            let whole = short.max(1);
            for (k, stretch) in stretches[from..from + whole].iter().enumerate() {
                // What goes on along the ground has touched it before.
                let contact = stretch.contact.filter(|_| !(ended_in_cut && k == 0 && !stretch.flight));
                kept.push(Stretch { contact, ..stretch.clone() });
            }
            from += whole;
            ended_in_cut = false;
        }
    }
    kept.retain(|stretch| stretch.span() > 0.0);
    join_still(kept)
}

/// A spin that goes evenly from that at the start of a run of stretches to that at its end, over
/// `span` in s.
fn evenly(run: &[Stretch], span: f64) -> Vec<Point> {
    let mut pieces = run.iter().flat_map(|stretch| &stretch.pieces);
    let (Some(first), Some(last)) = (pieces.next(), run.last().and_then(|stretch| stretch.pieces.last())) else {
        return Vec::new();
    };
    if run.iter().flat_map(|stretch| &stretch.pieces).all(|piece| piece.spin.is_empty()) {
        return Vec::new();
    }
    let (a, b) = (first.spin_at(0.0), last.spin_at(last.span));
    vec![a, std::array::from_fn(|axis| (b[axis] - a[axis]) / span)]
}

/// Lying still after lying still is one stretch.
fn join_still(stretches: Vec<Stretch>) -> Vec<Stretch> {
    let still = |stretch: &Stretch| {
        !stretch.flight
            && stretch
                .pieces
                .iter()
                .all(|piece| piece.coefficients.iter().skip(1).chain(&piece.spin).flatten().all(|&c| c == 0.0))
    };
    let mut joined: Vec<Stretch> = Vec::with_capacity(stretches.len());
    for stretch in stretches {
        match joined.last_mut() {
            Some(last) if still(last) && still(&stretch) => last.pieces.extend(stretch.pieces),
            _ => joined.push(stretch),
        }
    }
    joined
}

/// One stretch under a map of time that is straight between knots; where it bends the stretch is
/// parted.
fn pace(stretch: &Stretch, knots: &[[f64; 2]]) -> Vec<Stretch> {
    let mut parts: Vec<Stretch> = Vec::new();
    for piece in &stretch.pieces {
        let end = piece.start + piece.span;
        let spans = knots.windows(2).filter_map(|pair| {
            let (a, b) = (pair[0], pair[1]);
            let (from, to) = (piece.start.max(a[0]), end.min(b[0]));
            (to - from > 1e-12 * end.max(1.0)).then_some((a, b, from, to))
        });
        for (a, b, from, to) in spans {
            let factor = (b[1] - a[1]) / (b[0] - a[0]);
            let moved = piece.part(from - piece.start, to - from).slowed(factor, a[1] + (from - a[0]) * factor);
            match parts.last_mut() {
                Some(last) if from > a[0] + 1e-12 * a[0].max(1.0) => last.pieces.push(moved),
                _ => {
                    let contact = stretch.contact.filter(|_| parts.is_empty());
                    parts.push(Stretch { contact, flight: stretch.flight, pieces: vec![moved] });
                }
            }
        }
    }
    parts
}

/// A track whose every stretch lasts whole frames, under the same gravity, through the same places
/// of contact.
fn thrown(track: &Track, frames: Frames, loops: bool) -> Result<Track, MotionError> {
    let step = frames.step();
    let mut stretches = Vec::with_capacity(track.stretches.len());
    let mut drawn = 0.0;
    for (index, stretch) in track.stretches.iter().enumerate() {
        let count = (stretch.span() / step).round().max(1.0);
        let (start, span) = (drawn * step, (drawn + count) * step - drawn * step);
        drawn += count;
        let pieces = if stretch.flight {
            let [place, slope, pull] = stretch.parabola().ok_or_else(|| {
                let at = stretch.start();
                MotionError(format!("in the flight from {at:.4} s on more than gravity acts: snap by heights"))
            })?;
            let next = track.stretches.get(index + 1).or_else(|| track.stretches.first().filter(|_| loops));
            let lands = next.is_some_and(|next| next.contact.is_some());
            let end = next.map_or_else(|| stretch.at(stretch.end()), |next| next.at(next.start()));
            let mut c = [place, slope, pull];
            for axis in 0..3 {
                if !lands {
                    continue;
                }
                if index == 0 && axis == 2 && slope[axis] == 0.0 && !loops {
                    c[0][axis] = end[axis] - pull[axis] * span * span;
                } else {
                    c[1][axis] = (end[axis] - place[axis]) / span - pull[axis] * span;
                }
            }
            // As many turns as before.
            let slower = |c: Point| c.map(|c| c * stretch.span() / span);
            let spin = evenly(std::slice::from_ref(stretch), span).into_iter().map(slower).collect();
            vec![Piece { start, span, coefficients: c.to_vec(), spin }]
        } else {
            let factor = span / stretch.span();
            let moved = |piece: &Piece| piece.slowed(factor, start + (piece.start - stretch.start()) * factor);
            stretch.pieces.iter().map(moved).collect()
        };
        stretches.push(Stretch { pieces, ..*stretch });
    }
    Ok(Track { stretches, ..track.clone() })
}
