//! A motion as exact polynomials: pieces, the smooth stretches they make, and one track of
//! stretches for each ball.

use std::fmt;

/// A place in m: (x, y, up).
pub type Point = [f64; 3];

pub(crate) fn dot<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(crate) fn norm(a: &Point) -> f64 {
    dot(a, a).sqrt()
}

/// A stretch of time in which the place is one polynomial, Σ cₖ (t - start)ᵏ; of a flight under
/// gravity alone, a quadratic.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The start in s.
    pub start: f64,
    /// The duration in s.
    pub span: f64,
    /// cₖ in m/sᵏ.
    pub coefficients: Vec<Point>,
    /// The spin in rad/s, a polynomial likewise, right-handed about (x, y, up); empty for a ball
    /// that does not turn.
    pub spin: Vec<Point>,
}

impl Piece {
    /// The place `s` seconds after the start.
    #[must_use]
    pub fn at(&self, s: f64) -> Point {
        value(&self.coefficients, s)
    }

    /// The spin in rad/s `s` seconds after the start.
    #[must_use]
    pub fn spin_at(&self, s: f64) -> Point {
        value(&self.spin, s)
    }

    /// The velocity in m/s `s` seconds after the start.
    #[must_use]
    pub fn slope(&self, s: f64) -> Point {
        let rows = self.coefficients.iter().enumerate().skip(1).rev();
        rows.fold([0.0; 3], |sum, (k, c)| std::array::from_fn(|axis| sum[axis] * s + k as f64 * c[axis]))
    }

    /// This path `factor` times as slowly, from another start.
    pub(crate) fn slowed(&self, factor: f64, start: f64) -> Self {
        let scaled = |(c, k): (&Point, i32)| c.map(|c| c / factor.powi(k));
        let coefficients = self.coefficients.iter().zip(0..).map(scaled).collect();
        Self { start, span: self.span * factor, coefficients, spin: self.spin.iter().zip(1..).map(scaled).collect() }
    }

    /// The part of it that lasts `span` in s from `s` seconds after its start.
    #[must_use]
    pub fn part(&self, s: f64, span: f64) -> Self {
        Self { start: self.start + s, span, coefficients: shifted(&self.coefficients, s), spin: shifted(&self.spin, s) }
    }
}

fn value(coefficients: &[Point], s: f64) -> Point {
    coefficients.iter().rev().fold([0.0; 3], |sum, c| std::array::from_fn(|axis| sum[axis] * s + c[axis]))
}

/// Taylor's shift, by repeated synthetic division.
fn shifted(coefficients: &[Point], s: f64) -> Vec<Point> {
    let mut c = coefficients.to_vec();
    for low in 0..c.len() {
        for k in (low..c.len() - 1).rev() {
            c[k] = std::array::from_fn(|axis| c[k][axis] + s * c[k + 1][axis]);
        }
    }
    c
}

/// A contact of a ball with a floor, a wall or another ball.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The normal, towards the ball, of length 1.
    pub normal: Point,
    /// The speed of approach along it, in m/s.
    pub speed: f64,
    /// Whether it takes time: what begins with it are the places of a ball pressed in by as much as
    /// it is deformed.
    pub pressed: bool,
}

impl Contact {
    /// A contact of an instant with a level floor, at `speed` in m/s.
    #[must_use]
    pub const fn level(speed: f64) -> Self {
        Self { normal: UP, speed, pressed: false }
    }
}

/// Upwards.
pub(crate) const UP: Point = [0.0, 0.0, 1.0];

/// Pieces that join smoothly, from one impact to the next.
#[derive(Clone, Debug, PartialEq)]
pub struct Stretch {
    /// The contact it begins with, if it does.
    pub contact: Option<Contact>,
    /// Whether the ball is in the air.
    pub flight: bool,
    /// The pieces, at least one.
    pub pieces: Vec<Piece>,
}

impl Stretch {
    /// The start in s.
    #[must_use]
    pub fn start(&self) -> f64 {
        self.pieces.first().map_or(0.0, |piece| piece.start)
    }

    /// The end in s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.pieces.last().map_or(0.0, |piece| piece.start + piece.span)
    }

    /// The duration in s.
    #[must_use]
    pub fn span(&self) -> f64 {
        self.end() - self.start()
    }

    fn piece(&self, t: f64) -> (&Piece, f64) {
        let next = self.pieces.partition_point(|piece| piece.start <= t).max(1);
        let piece = &self.pieces[next - 1];
        (piece, (t - piece.start).clamp(0.0, piece.span))
    }

    /// The place at `t` in s; at its ends the limits from within.
    #[must_use]
    pub fn at(&self, t: f64) -> Point {
        let (piece, s) = self.piece(t);
        piece.at(s)
    }

    /// The velocity in m/s at `t` in s; at its ends the limits from within.
    #[must_use]
    pub fn slope(&self, t: f64) -> Point {
        let (piece, s) = self.piece(t);
        piece.slope(s)
    }

    /// The one quadratic it is, if it is.
    #[must_use]
    pub fn parabola(&self) -> Option<[Point; 3]> {
        let quadratic = |piece: &Piece| {
            let c = |k: usize| piece.coefficients.get(k).copied().unwrap_or_default();
            piece.coefficients.iter().skip(3).flatten().all(|&c| c == 0.0).then(|| [c(0), c(1), c(2)])
        };
        let first = quadratic(self.pieces.first()?)?;
        let same = |piece: &Piece| quadratic(piece).is_some_and(|[_, _, c]| c == first[2]);
        self.pieces.iter().all(same).then_some(first)
    }

    /// The greatest height in it, in m, and when.
    #[must_use]
    pub fn top(&self) -> (f64, f64) {
        let ends = [self.start(), self.end()].map(|t| (self.at(t)[2], t));
        let inside = self.pieces.iter().filter_map(|piece| {
            let up = |s: f64| piece.slope(s)[2];
            let s = fall(up, piece.span)?;
            Some((piece.at(s)[2], piece.start + s))
        });
        inside.chain(ends).fold((f64::NEG_INFINITY, 0.0), |best, top| if top.0 > best.0 { top } else { best })
    }
}

/// The time at which `rate` falls through zero within `span`.
fn fall(rate: impl Fn(f64) -> f64, span: f64) -> Option<f64> {
    let (a, b) = (rate(0.0), rate(span));
    if a <= 0.0 || b >= 0.0 {
        return None;
    }
    let (mut low, mut high) = (0.0, span);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if rate(middle) > 0.0 { low = middle } else { high = middle }
    }
    Some(0.5 * (low + high))
}

/// The motion of one ball: where its lowest point is.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// The name.
    pub name: String,
    /// The radius of the ball in m.
    pub radius: f64,
    /// The stretches in order, each from the end of the one before.
    pub stretches: Vec<Stretch>,
}

impl Track {
    /// The stretch at `t` in s: the later one, where two meet.
    #[must_use]
    pub fn stretch(&self, t: f64) -> &Stretch {
        let next = self.stretches.partition_point(|stretch| stretch.start() <= t).max(1);
        &self.stretches[next - 1]
    }

    /// The place at `t` in s.
    #[must_use]
    pub fn at(&self, t: f64) -> Point {
        self.stretch(t).at(t)
    }

    /// The pieces in order.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = &Piece> {
        self.stretches.iter().flat_map(|stretch| &stretch.pieces)
    }

    /// The times at which contacts begin, in s.
    pub fn contacts(&self) -> impl Iterator<Item = f64> + '_ {
        self.stretches.iter().filter(|stretch| stretch.contact.is_some()).map(Stretch::start)
    }

    /// The end in s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.stretches.last().map_or(0.0, Stretch::end)
    }
}

/// A motion to be shown: one track for each ball, and the outline of what they bounce on.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// The title.
    pub title: String,
    /// The tracks, at least one, all from 0 s on.
    pub tracks: Vec<Track>,
    /// Floors and walls as lines from point to point, (x, up) in m.
    pub ground: Vec<Vec<[f64; 2]>>,
    /// Whether its end is its start, and it is played for ever.
    pub loops: bool,
}

impl Motion {
    /// Checks that every track is whole: from 0 s on, each piece from where the last one ends.
    ///
    /// # Errors
    /// [`MotionError`] if there is no track, an empty one, a gap, or a number that is not finite.
    ///
    /// ```
    /// use saltus_motion::{Motion, Piece, Stretch, Track};
    /// let fall = Piece { start: 0.0, span: 0.4, coefficients: vec![[0.0, 0.0, 1.0], [0.0; 3], [0.0, 0.0, -4.905]], spin: Vec::new() };
    /// let stretch = Stretch { contact: None, flight: true, pieces: vec![fall] };
    /// let track = Track { name: "ball".into(), radius: 0.02, stretches: vec![stretch] };
    /// let motion = Motion::new("fall", vec![track], Vec::new())?;
    /// assert!((motion.tracks[0].at(0.2)[2] - 0.8038).abs() < 1e-12);
    /// assert!(Motion::new("nothing", Vec::new(), Vec::new()).is_err());
    /// # Ok::<(), saltus_motion::MotionError>(())
    /// ```
    pub fn new(title: &str, tracks: Vec<Track>, ground: Vec<Vec<[f64; 2]>>) -> Result<Self, MotionError> {
        if tracks.is_empty() {
            return Err(MotionError("there is no ball to export".to_owned()));
        }
        for Track { name, radius, stretches } in &tracks {
            let bad = |says: &str| Err(MotionError(format!("{name}: {says}")));
            if !(radius.is_finite() && *radius > 0.0) {
                return bad("its radius is not above zero");
            }
            if stretches.is_empty() || stretches.iter().any(|stretch| stretch.pieces.is_empty()) {
                return bad("its motion is empty");
            }
            let mut t = 0.0;
            for piece in stretches.iter().flat_map(|stretch| &stretch.pieces) {
                let finite = piece.coefficients.iter().chain(&piece.spin).flatten().all(|c| c.is_finite());
                if !finite || !piece.span.is_finite() || piece.span < 0.0 || piece.coefficients.is_empty() {
                    return bad(&format!("its motion from {} s on is not finite", piece.start));
                }
                if (piece.start - t).abs() > 1e-9 * t.max(1.0) {
                    return bad(&format!("its motion has a gap between {t} s and {} s", piece.start));
                }
                t = piece.start + piece.span;
            }
        }
        Ok(Self { title: title.to_owned(), tracks, ground, loops: false })
    }

    /// This motion with all lengths times a factor, and the same times.
    ///
    /// ```
    /// use saltus_motion::{Motion, Piece, Stretch, Track};
    /// let piece = Piece { start: 0.0, span: 1.0, coefficients: vec![[0.0, 0.0, 2.0]], spin: Vec::new() };
    /// let stretch = Stretch { contact: None, flight: true, pieces: vec![piece] };
    /// let track = Track { name: "ball".into(), radius: 0.02, stretches: vec![stretch] };
    /// let motion = Motion::new("still", vec![track], Vec::new())?.scaled(100.0);
    /// assert_eq!((motion.tracks[0].at(0.5)[2], motion.tracks[0].radius), (200.0, 2.0));
    /// # Ok::<(), saltus_motion::MotionError>(())
    /// ```
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        for track in &mut scaled.tracks {
            track.radius *= factor;
            for stretch in &mut track.stretches {
                if let Some(contact) = &mut stretch.contact {
                    contact.speed *= factor;
                }
                let coefficients = stretch.pieces.iter_mut().flat_map(|piece| &mut piece.coefficients);
                coefficients.flatten().for_each(|c| *c *= factor);
            }
        }
        scaled.ground.iter_mut().flatten().flatten().for_each(|c| *c *= factor);
        scaled
    }

    /// The end in s.
    #[must_use]
    pub fn end(&self) -> f64 {
        self.tracks.iter().map(Track::end).fold(0.0, f64::max)
    }

    /// The farthest that a contact is from a whole frame, in frames: at most ½.
    #[must_use]
    pub fn off_frame(&self, frames: crate::Frames) -> f64 {
        let off = |t: f64| {
            let n = t / frames.step();
            (n - n.round()).abs()
        };
        let end = self.loops.then(|| self.end());
        let off = self.tracks.iter().flat_map(Track::contacts).chain(end).map(off).fold(0.0, f64::max);
        if off < 1e-9 { 0.0 } else { off * frames.step() / frames.rate.frame() }
    }

    /// The least and the greatest x, and the least and the greatest height, of all balls and of the
    /// ground, in m.
    #[must_use]
    pub fn reach(&self) -> [[f64; 2]; 2] {
        let mut reach = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
        let mut take = |x: [f64; 2], up: [f64; 2]| {
            for (range, [low, high]) in reach.iter_mut().zip([x, up]) {
                *range = [range[0].min(low), range[1].max(high)];
            }
        };
        for track in &self.tracks {
            for stretch in &track.stretches {
                let (top, at) = stretch.top();
                for t in [stretch.start(), at, stretch.end()] {
                    let [x, _, up] = stretch.at(t);
                    take([x - track.radius, x + track.radius], [up, top + 2.0 * track.radius]);
                }
            }
        }
        self.ground.iter().flatten().for_each(|&[x, up]| take([x; 2], [up; 2]));
        reach
    }
}

/// A motion that is none.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MotionError(pub(crate) String);

impl fmt::Display for MotionError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for MotionError {}
