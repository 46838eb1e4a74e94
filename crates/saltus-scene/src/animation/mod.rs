//! The motion that is shown of a run: cut, snapped and held as asked for, with squash and stretch.

mod departure;

pub use departure::{Departure, at_most, length, rounded_up};

use nalgebra::Vector3;
use saltus_motion::{Contact, Export, File, Format, Frames, Motion, Piece, Snap, Space, Stretch, Track};

use crate::plan::{Impact, Record, Segment, Sides, With};
use crate::{Error, Scene};

/// The number of frames for which a squash is shown where a contact is an instant and no hold is
/// asked for: the contact, the squash, and off again.
const HELD: u32 = 2;

/// The amount of squash.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Squash {
    /// The squash by the law of a contact that takes time.
    Law,
    /// A part of the ball's height, from 0 to 1, in the fastest contact.
    Part(f64),
}

/// Settings by which a run is shown.
///
/// ```
/// use saltus_motion::{Format, Frames, Snap};
/// use saltus_scene::{Scene, Squash, Staging};
/// let scene = Scene::parse("drop.toml", b"restitution = 0.5\nball = { height = '1 m', radius = '2 cm' }\n")?;
/// let record = scene.plan()?.run()?;
/// let mut staging = Staging::new(Frames::new("24".parse()?));
/// let file = staging.stage(&record)?.file(Format::Glb, 1e-4)?;
/// assert!(file.bytes.starts_with(b"glTF"));
///
/// // Every contact on a whole frame, held for two, 30 % shorter in the fastest one.
/// staging.snap = Some(Snap::Gravity);
/// staging.squash = Some(Squash::Part(0.3));
/// let stage = staging.stage(&record)?;
/// let says = stage.says(&stage.file(Format::Glb, 1e-4)?);
/// assert!(says.contains("farthest contact from a frame: 0.00 frames") && says.contains("0.70 of its height"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Staging {
    /// The count of frames.
    pub frames: Frames,
    /// Whether contacts move to whole frames, and what stays then.
    pub snap: Option<Snap>,
    /// The squash of the ball in contacts; `None` for a round ball.
    pub squash: Option<Squash>,
    /// The part by which the ball is longer at the greatest speed, along its velocity; 0 for no
    /// stretch.
    pub stretch: f64,
    /// The factor of squash and stretch.
    pub exaggerate: f64,
    /// The number of frames for which each contact is held at least; what comes after is later.
    pub hold: Option<u32>,
    /// The hop that is shown alone, as a loop, counted from 1; `None` for the whole run.
    pub looped: Option<u32>,
    /// Whether left and right are turned around.
    pub mirror: bool,
    /// Whether there is a key at the top of every flight.
    pub apexes: bool,
}

/// The motion that is shown of a run, and how it departs from the run.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Stage {
    /// The motion, cut, snapped and held.
    pub motion: Motion,
    /// The count of frames.
    pub frames: Frames,
    /// Squash and stretch.
    pub shape: saltus_motion::Shape,
    /// The departures from the run.
    pub departures: Vec<Departure>,
    /// The radius in m that balls without one are drawn with, where there are any.
    pub drawn: Option<f64>,
    /// Whether there is a key at the top of every flight.
    pub apexes: bool,
    /// The unit and the axis of files: metres and the format's own, unless it is set.
    pub space: Space,
}

impl Stage {
    /// The file of a format; where more than gravity acts, keys are within `tolerance` in m of the
    /// motion.
    ///
    /// # Errors
    /// [`Error`] where the format cannot hold it.
    pub fn file(&self, format: Format, tolerance: f64) -> Result<File, Error> {
        let Self { motion, frames, shape, apexes, space, .. } = self;
        Export { tolerance, shape: *shape, apexes: *apexes, space: *space, ..Export::new(motion, *frames) }
            .file(format)
            .map_err(Error::new)
    }

    /// The greatest difference of the heights of a file from those of the run, in m: the error of
    /// the file, and that of the hops left out. Where contacts are moved in time, by snapping, by
    /// holding or to a loop, it is the difference from the motion as it is shown.
    #[must_use]
    pub fn height_error(&self, file: &File) -> f64 {
        let moved = |departure: &Departure| {
            use Departure::{Held, Loop, SnappedByGravity, SnappedByHeights};
            matches!(departure, Loop { .. } | SnappedByGravity { .. } | SnappedByHeights { .. } | Held { .. })
        };
        let cut = self.departures.iter().map(|departure| match departure {
            Departure::Cut { off, .. } => *off,
            _ => 0.0,
        });
        let moved = self.departures.iter().any(moved);
        file.miss.height + if moved { 0.0 } else { cut.fold(0.0, f64::max) }
    }

    /// A line about a file: its error and its departures from the run, as bounds, rounded upwards.
    #[must_use]
    pub fn says(&self, file: &File) -> String {
        let Self { motion, frames, shape, departures, .. } = self;
        let mut says: String = departures.iter().map(|departure| format!("; {departure}")).collect();
        if let Some(seen) = file.shown {
            if shape.squash > 0.0 || shape.stretch > 0.0 {
                let volume = rounded_up(100.0 * seen.volume, 2);
                says += &format!("; outline moved by up to {}, volume kept within {volume} %", at_most(seen.moved));
            }
            if seen.sunk > SUNK {
                says += &format!("; the ball is in what it touches by up to {}", at_most(seen.sunk));
            }
            if seen.added > 0 {
                says +=
                    &format!("; {} keys added to its turning, so that none is half a turn from the next", seen.added);
            }
        }
        if frames.on_twos {
            says += "; each drawing stands for two frames, and is exact at the first";
        }
        let (off, miss) = (rounded_up(motion.off_frame(*frames), 2), at_most(self.height_error(file)));
        format!("{} keys; farthest contact from a frame: {off} frames; worst height error: {miss}{says}", file.keys)
    }
}

/// The depth of a ball in what it touches that needs no mention, in m: a hundredth of a millimetre.
const SUNK: f64 = 1e-5;

impl Staging {
    /// Settings that change nothing: no snapping, a round ball, every contact as long as it lasts.
    #[must_use]
    pub const fn new(frames: Frames) -> Self {
        Self {
            frames,
            snap: None,
            squash: None,
            stretch: 0.0,
            exaggerate: 1.0,
            hold: None,
            looped: None,
            mirror: false,
            apexes: false,
        }
    }

    /// Refuses a scene whose own end is later than frames can show, before it is run;
    /// [`Staging::stage`] refuses it too.
    ///
    /// # Errors
    /// [`Error`], with the longest time that there may be.
    pub fn holds(&self, scene: &Scene) -> Result<(), Error> {
        scene.run.until.map_or(Ok(()), |until| self.frames.holds(until)).map_err(Error::new)
    }

    /// The motion that is shown of a run.
    ///
    /// # Errors
    /// [`Error`] where there is no such hop, contacts cannot move to frames, or no law says how far
    /// the ball is squashed.
    pub fn stage(&self, record: &Record) -> Result<Stage, Error> {
        let frames = self.frames;
        frames.holds(record.until()).map_err(Error::new)?;
        let (mut whole, drawn) = motion(record.scene(), record)?;
        if self.mirror {
            whole = whole.mirrored();
        }
        let mut free = whole.cut(frames.step());
        let mut departures = Vec::new();
        if let Some(hop) = self.looped {
            free = free.looped(hop as usize).map_err(Error::new)?;
            departures.push(Departure::Loop { hop });
        } else {
            let height = hops_below(&whole, frames.step());
            let off = if whole.tracks == free.tracks { 0.0 } else { whole.apart(&free).height };
            // What is left out on a floor that moves need not rise above where it starts and ends.
            if whole.tracks != free.tracks && height.max(off) > 0.0 {
                departures.push(Departure::Cut { height, off });
            }
        }
        let by = |by: Snap| free.snapped(by, frames).map(|snapped| (by, snapped));
        let snapped = match self.snap {
            Some(snap) => Some(by(snap)),
            // A loop has whole frames.
            None => self.looped.map(|_| by(Snap::Gravity).or_else(|_| by(Snap::Heights))),
        };
        let snapped = match snapped.transpose().map_err(Error::new)? {
            None => free,
            Some((by, snapped)) => {
                departures.push(match by {
                    Snap::Gravity => Departure::SnappedByGravity { tops: snapped.tops_differ(&free) },
                    Snap::Heights => Departure::SnappedByHeights { end: (snapped.end() - free.end()).abs() },
                });
                snapped
            }
        };
        let (motion, shape) = self.shaped(&snapped, &mut departures)?;
        if record.scene().floors.iter().any(|floor| floor.motion.is_some()) {
            departures.push(Departure::StillFloor);
        }
        if motion.loops {
            let count = (motion.end() / frames.rate.frame()).round();
            departures.push(Departure::Again { last: f64::from(frames.first) + count, first: frames.first });
        }
        Ok(Stage { motion, frames, shape, departures, drawn, apexes: self.apexes, space: Space::default() })
    }

    /// The shape by squash, stretch and hold, and its departures from the motion.
    fn shaped(
        &self,
        motion: &Motion,
        departures: &mut Vec<Departure>,
    ) -> Result<(Motion, saltus_motion::Shape), Error> {
        let own = motion.deformation();
        let squash = match self.squash {
            None => 0.0,
            Some(Squash::Part(part)) => part * self.exaggerate,
            Some(Squash::Law) if own > 0.0 => own * self.exaggerate,
            Some(Squash::Law) => {
                return Err(Error::new(
                    "no law says how far the ball is pressed in, for the scene has no contact that takes time: give --squash a number, such as 0.3, or the scene a [contact]",
                ));
            }
        };
        let contacts = || motion.tracks.iter().flat_map(|track| &track.stretches);
        let instants = contacts().any(|stretch| stretch.flight && stretch.contact.is_some());
        let hold = self.hold.or((squash > 0.0 && instants).then_some(HELD));
        let mut shape = saltus_motion::Shape::default();
        (shape.squash, shape.stretch) = (squash, self.stretch * self.exaggerate);
        if squash > 0.0 {
            let by_law = self.squash == Some(Squash::Law) && self.exaggerate == 1.0;
            let of_law = (own > 0.0).then_some(if by_law { 1.0 } else { squash / own });
            departures.push(Departure::Squashed { to: 1.0 - squash, of_law });
        }
        if shape.stretch > 0.0 {
            departures.push(Departure::Stretched { to: 1.0 + shape.stretch });
        }
        let frames = self.frames;
        let short = contacts().filter(|stretch| stretch.contact.is_some_and(|contact| contact.pressed));
        let short = short.filter(|stretch| stretch.span() < frames.step()).count();
        if hold.is_none() && squash > 0.0 && short > 0 {
            departures.push(Departure::Short { contacts: short });
        }
        let Some(count) = hold else { return Ok((motion.clone(), shape)) };
        shape.hold = f64::from(count) * frames.step();
        let held = motion.held(shape.hold).map_err(Error::new)?;
        departures.push(Departure::Held { count, drawings: frames.on_twos, later: held.end() - motion.end() });
        Ok((held, shape))
    }
}

impl Record {
    /// The motion as tracks of polynomials from contact to contact, for animators: all of it, on
    /// its own times. A ball without a radius is drawn with a fiftieth of the height that all balls
    /// go through.
    ///
    /// # Errors
    /// [`Error`] where the run has no length.
    pub fn motion(&self) -> Result<Motion, Error> {
        motion(self.scene(), self).map(|(motion, _)| motion)
    }
}

/// The greatest height of flights that take less than `span` in s.
fn hops_below(motion: &Motion, span: f64) -> f64 {
    let flights = motion.tracks.iter().flat_map(|track| &track.stretches);
    let short = flights.filter(|stretch| stretch.flight && stretch.span() < span);
    let high = |stretch: &Stretch| stretch.top().0 - stretch.at(stretch.start())[2].max(stretch.at(stretch.end())[2]);
    short.map(high).fold(0.0, f64::max)
}

/// The record as tracks, and the radius that balls without one are drawn with: a stretch ends where
/// a velocity jumps, or where a flight begins or ends.
fn motion(scene: &Scene, record: &Record) -> Result<(Motion, Option<f64>), Error> {
    let (events, impacts) = (record.events(), record.impacts());
    let mut tracks = Vec::new();
    let mut sizeless = Vec::new();
    for ball in 0..record.balls() {
        let mut jumps: Vec<(f64, &Sides)> = Vec::new();
        for event in &events {
            let sides = event.sides.iter().filter(|sides| sides.ball == ball);
            let broken = |sides: &&Sides| sides.before.velocity != sides.after.velocity;
            jumps.extend(sides.filter(broken).map(|sides| (event.t, sides)));
        }
        let mut stretches: Vec<Stretch> = Vec::new();
        let turns = |segment: &Segment| segment.coefficients.iter().any(|c| c.spin != Vector3::zeros());
        let spins = record.segments(ball).iter().any(turns);
        for segment in record.segments(ball).into_iter().filter(|segment| segment.span > 0.0) {
            let coefficients = segment.coefficients.iter().map(|c| c.position.into()).collect();
            let turning = spins.then(|| segment.coefficients.iter().map(|c| c.spin.into()).collect());
            let spin = turning.unwrap_or_default();
            let piece = Piece { start: segment.start, span: segment.span, coefficients, spin };
            let from = jumps.partition_point(|(t, _)| *t < segment.start);
            let jumped = jumps.get(from).is_some_and(|(t, _)| *t == segment.start);
            match stretches.last_mut() {
                Some(last) if last.flight == segment.flight && (!jumped || pressed(last)) => last.pieces.push(piece),
                Some(last) if pressed(last) && segment.flight => {
                    let (within, free) = parted(last, piece);
                    last.pieces.extend(within);
                    if let Some(free) = free {
                        stretches.push(Stretch { contact: None, flight: true, pieces: vec![free] });
                    }
                }
                last => {
                    let met = |impact: &&Impact| {
                        impact.t == segment.start && (impact.ball == ball || impact.with == With::Ball(ball))
                    };
                    // What lies or rolls is struck too, by another ball or at a wall.
                    let begins = last.is_some_and(|last| {
                        jumped && impacts.iter().any(|impact| met(&impact))
                            || last.flight && (jumped || !segment.flight)
                    });
                    let contact = begins.then(|| {
                        let sides = jumps.get(from).filter(|_| jumped).map(|(_, sides)| *sides);
                        contact(scene, impacts.iter().filter(met), sides)
                    });
                    stretches.push(Stretch { contact, flight: segment.flight, pieces: vec![piece] });
                }
            }
        }
        let radius = scene.balls.get(ball).and_then(|ball| ball.radius);
        if radius.is_none() {
            sizeless.push(ball);
        }
        tracks.push(Track { name: scene.ball_name(ball), radius: radius.unwrap_or(1.0), stretches });
    }
    let reach = |tracks: Vec<Track>| Motion::new("", tracks, Vec::new()).map(|motion| (motion.reach(), motion.tracks));
    let ([_, [low, top]], mut tracks) = reach(tracks).map_err(Error::new)?;
    let mut size = None;
    if !sizeless.is_empty() {
        let high = if sizeless.len() == tracks.len() { top - low - 2.0 } else { top - low };
        let drawn = if high > 0.0 { 0.02 * high } else { 0.02 };
        sizeless.iter().for_each(|&ball| tracks[ball].radius = drawn);
        size = Some(drawn);
    }
    let (reach, tracks) = reach(tracks).map_err(Error::new)?;
    let title = scene.picture.title.clone().unwrap_or_else(|| "A bouncing ball".to_owned());
    let ground = outlines(scene, reach);
    Ok((Motion::new(&title, tracks, ground).map_err(Error::new)?, size))
}

/// Whether a stretch is a contact that takes time.
fn pressed(stretch: &Stretch) -> bool {
    stretch.contact.is_some_and(|contact| contact.pressed)
}

/// A ball that a contact lets go of while it is still deformed is shown in contact until its lowest
/// point is where it touched: the first part of its flight, up to then, and the rest.
fn parted(contact: &Stretch, flight: Piece) -> (Option<Piece>, Option<Piece>) {
    let (normal, touch) =
        (contact.contact.map_or([0.0, 0.0, 1.0], |contact| contact.normal), contact.at(contact.start()));
    let out = |s: f64| {
        let place = flight.at(s);
        (0..3).map(|axis| normal[axis] * (place[axis] - touch[axis])).sum::<f64>()
    };
    if out(0.0) >= 0.0 {
        return (None, Some(flight));
    }
    // It rises within this piece, or stays for all of it.
    let (mut low, mut high) = (0.0, flight.span);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if out(middle) < 0.0 { low = middle } else { high = middle }
    }
    if out(high) < 0.0 {
        return (Some(flight), None);
    }
    let rest = flight.part(high, flight.span - high);
    (Some(flight.part(0.0, high)), (rest.span > 0.0).then_some(rest))
}

/// A contact that begins with impacts, the hardest of which counts, and with a jump, if it is one
/// of an instant.
fn contact<'a>(scene: &Scene, impacts: impl Iterator<Item = &'a Impact>, jump: Option<&Sides>) -> Contact {
    let hardest = impacts.max_by(|a, b| a.approach.total_cmp(&b.approach));
    let change = jump.map_or(Vector3::z(), |sides| sides.after.velocity - sides.before.velocity);
    let at = jump.map_or(0.0, |sides| sides.before.position.x);
    let normal = match hardest.map(|impact| impact.with) {
        Some(With::Floor(floor)) => scene.floors.get(floor).map_or(Vector3::z(), |floor| floor.normal(change, at)),
        Some(With::Ball(_)) => change.normalize(),
        _ => Vector3::z(),
    };
    Contact {
        normal: normal.into(),
        speed: hardest.map_or(0.0, |impact| impact.approach),
        pressed: hardest.is_some_and(|impact| impact.press.is_some()),
    }
}

/// Floors and walls in the plane of x and up, as far as the balls get and a little beyond.
fn outlines(scene: &Scene, [[left, right], [low, high]]: [[f64; 2]; 2]) -> Vec<Vec<[f64; 2]>> {
    /// The length beyond, as a part of the size of the motion.
    const BEYOND: f64 = 0.1;
    let more = BEYOND * (right - left).max(high - low);
    let reach = [[left - more, right + more], [low, high + more]];
    scene.floors.iter().map(|floor| floor.outline(reach)).filter(|outline| !outline.is_empty()).collect()
}
