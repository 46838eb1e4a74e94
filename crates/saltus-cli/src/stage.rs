//! A scene as the motion that is shown: cut, snapped and held as asked for, with its squash and stretch.

use std::path::Path;

use saltus::nalgebra::Vector3;
use saltus_motion::{Contact, Frames, Motion, Piece, Snap, Stretch, Track};
use saltus_scene::plan::{Impact, Record, Segment, Sides, With};
use saltus_scene::{Floor, Scene, Shape};

use crate::error::Error;
use crate::ground::{corners, name};
use crate::output::say;
use crate::simulate::{ended, ending, note, planned, scene};
use crate::staging::{SnapBy, Squash, Staging};

/// What is shown of a scene.
pub(crate) struct Stage {
    pub(crate) motion: Motion,
    pub(crate) frames: Frames,
    pub(crate) shape: saltus_motion::Shape,
    /// How it departs from the scene's motion, in words after semicolons.
    pub(crate) says: String,
    /// What had to be supposed.
    pub(crate) note: Option<String>,
}

impl Stage {
    /// Runs the scene of a file, and says what has to be said of it.
    pub(crate) fn of(path: &Path, staging: &Staging, first: i32, quiet: bool) -> Result<Self, Error> {
        let scene = scene(path, ending(staging.until, None))?;
        if let Some(note) = note(&scene) {
            say(quiet, &note);
        }
        let record = planned(&scene, Some(path))?.run().map_err(Error::new)?;
        ended(&record, quiet);
        let stage = Self::shown(&scene, &record, staging, first)?;
        if let Some(note) = &stage.note {
            say(quiet, note);
        }
        Ok(stage)
    }

    /// A run as it is to be shown.
    pub(crate) fn shown(scene: &Scene, record: &Record, staging: &Staging, first: i32) -> Result<Self, Error> {
        let frames = Frames { rate: staging.fps, first, on_twos: staging.on_twos };
        let (mut whole, note) = motion(scene, record)?;
        if staging.mirror {
            whole = whole.mirrored();
        }
        let mut free = whole.cut(frames.step());
        let mut says = String::new();
        if let Some(hop) = staging.looped {
            free = free.looped(hop as usize).map_err(Error::new)?;
            says += &format!("; hop {hop} alone, as a loop");
        } else {
            let high = hops_below(&whole, frames.step());
            if high > 0.0 && whole.tracks != free.tracks {
                says += &format!("; hops of up to {} left out", length(high));
            }
        }
        let by = |by: Snap| free.snapped(by, frames).map(|snapped| (by, snapped));
        let snapped = match staging.snap {
            Some(SnapBy::Gravity) => Some(by(Snap::Gravity)),
            Some(SnapBy::Heights) => Some(by(Snap::Heights)),
            // A loop has whole frames.
            None => staging.looped.map(|_| by(Snap::Gravity).or_else(|_| by(Snap::Heights))),
        };
        let snapped = match snapped.transpose().map_err(Error::new)? {
            None => free,
            Some((by, snapped)) => {
                says += &if by == Snap::Gravity {
                    format!("; snapped by gravity, tops moved by up to {}", length(snapped.tops_differ(&free)))
                } else {
                    format!("; snapped by heights, the end moved by {:.4} s", (snapped.end() - free.end()).abs())
                };
                snapped
            }
        };
        let (motion, shape, more) = shaped(staging, &snapped, frames)?;
        says += &more;
        if motion.loops {
            let count = (motion.end() / frames.rate.frame()).round();
            says += &format!("; frame {} is frame {} again", f64::from(first) + count, first);
        }
        Ok(Self { motion, frames, shape, says, note })
    }
}

/// Frames for which a squash is seen unless --hold says otherwise: the contact, the squash, and off again.
const HELD: u32 = 2;

/// What is asked for by squash, stretch and hold, and the words for how it departs from the motion.
fn shaped(args: &Staging, motion: &Motion, frames: Frames) -> Result<(Motion, saltus_motion::Shape, String), Error> {
    let own = motion.deformation();
    let squash = match args.squash {
        None => 0.0,
        Some(Squash::Part(part)) => part * args.exaggerate,
        Some(Squash::Law) if own > 0.0 => own * args.exaggerate,
        Some(Squash::Law) => {
            return Err(Error::new(
                "no law says how far the ball is pressed in, for the scene has no contact that takes time: give --squash a number, such as 0.3, or the scene a [contact]",
            ));
        }
    };
    let contacts = || motion.tracks.iter().flat_map(|track| &track.stretches);
    let instants = contacts().any(|stretch| stretch.flight && stretch.contact.is_some());
    let hold = args.hold.or((squash > 0.0 && instants).then_some(HELD));
    let mut shape = saltus_motion::Shape::default();
    (shape.squash, shape.stretch) = (squash, args.stretch.unwrap_or(0.0) * args.exaggerate);
    let mut says = String::new();
    if squash > 0.0 {
        says += &format!("; squashed to {:.2} of its height", 1.0 - squash);
        says += &match (args.squash, own) {
            (_, own) if own <= 0.0 => " by hand".to_owned(),
            (Some(Squash::Law), _) if args.exaggerate == 1.0 => " as the contact's law has it".to_owned(),
            (_, own) => format!(", {:.3} times as far as the contact's law has it", squash / own),
        };
    }
    if shape.stretch > 0.0 {
        says += &format!("; stretched to {:.2} of its length by hand", 1.0 + shape.stretch);
    }
    let short = contacts().filter(|stretch| stretch.contact.is_some_and(|contact| contact.pressed));
    let short = short.filter(|stretch| stretch.span() < frames.step()).count();
    if hold.is_none() && squash > 0.0 && short > 0 {
        says += &format!("; {short} contacts are shorter than a frame, and --hold makes them longer");
    }
    let motion = match hold {
        None => motion.clone(),
        Some(count) => {
            shape.hold = f64::from(count) * frames.step();
            let held = motion.held(shape.hold).map_err(Error::new)?;
            let later = held.end() - motion.end();
            let what = if frames.on_twos { "drawings" } else { "frames" };
            says += &format!("; contacts held for {count} {what}, the end {later:.4} s later");
            held
        }
    };
    Ok((motion, shape, says))
}

/// How high the flights are that take less than `span` in s, at most.
fn hops_below(motion: &Motion, span: f64) -> f64 {
    let flights = motion.tracks.iter().flat_map(|track| &track.stretches);
    let short = flights.filter(|stretch| stretch.flight && stretch.span() < span);
    let high = |stretch: &Stretch| stretch.top().0 - stretch.at(stretch.start())[2].max(stretch.at(stretch.end())[2]);
    short.map(high).fold(0.0, f64::max)
}

/// A length that a person can picture.
pub(crate) fn length(metres: f64) -> String {
    match metres {
        m if m < 1e-9 => "0 mm".to_owned(),
        m if m < 1e-5 => format!("{:.1e} mm", m * 1e3),
        m if m < 0.01 => format!("{:.2} mm", m * 1e3),
        m if m < 1.0 => format!("{:.1} cm", m * 1e2),
        m => format!("{m:.2} m"),
    }
}

/// The record as tracks, and what had to be supposed: a stretch ends where a velocity jumps, or where a flight begins or ends.
fn motion(scene: &Scene, record: &Record) -> Result<(Motion, Option<String>), Error> {
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
                    let begins = last.is_some_and(|last| last.flight && (jumped || !segment.flight));
                    let contact = begins.then(|| {
                        let sides = jumps.get(from).filter(|_| jumped).map(|(_, sides)| *sides);
                        let met =
                            impacts.iter().filter(|impact| impact.ball == ball || impact.with == With::Ball(ball));
                        contact(scene, met.filter(|impact| impact.t == segment.start), sides)
                    });
                    stretches.push(Stretch { contact, flight: segment.flight, pieces: vec![piece] });
                }
            }
        }
        let radius = scene.balls.get(ball).and_then(|ball| ball.radius);
        if radius.is_none() {
            sizeless.push(ball);
        }
        tracks.push(Track { name: name(scene, ball), radius: radius.unwrap_or(1.0), stretches });
    }
    let reach = |tracks: Vec<Track>| Motion::new("", tracks, Vec::new()).map(|motion| (motion.reach(), motion.tracks));
    let ([_, [low, top]], mut tracks) = reach(tracks).map_err(Error::new)?;
    let mut note = None;
    if !sizeless.is_empty() {
        let high = if sizeless.len() == tracks.len() { top - low - 2.0 } else { top - low };
        let drawn = if high > 0.0 { 0.02 * high } else { 0.02 };
        sizeless.iter().for_each(|&ball| tracks[ball].radius = drawn);
        note = Some(format!("the scene gives no radius: drawn with {}; set `radius` under [ball]", length(drawn)));
    }
    let (reach, tracks) = reach(tracks).map_err(Error::new)?;
    let title = scene.picture.title.clone().unwrap_or_else(|| "A bouncing ball".to_owned());
    let ground = scene.floors.iter().filter_map(|floor| outline(floor, reach)).collect();
    Ok((Motion::new(&title, tracks, ground).map_err(Error::new)?, note))
}

/// Whether a stretch is a contact that takes time.
fn pressed(stretch: &Stretch) -> bool {
    stretch.contact.is_some_and(|contact| contact.pressed)
}

/// A ball that a contact lets go of while it is still deformed is shown in contact until its lowest point is where it touched: the first part of its flight,
/// up to then, and the rest.
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

/// A contact that begins with impacts, the hardest of which counts, and with a jump, if it is one of an instant.
fn contact<'a>(scene: &Scene, impacts: impl Iterator<Item = &'a Impact>, jump: Option<&Sides>) -> Contact {
    let hardest = impacts.max_by(|a, b| a.approach.total_cmp(&b.approach));
    let change = jump.map_or(Vector3::z(), |sides| sides.after.velocity - sides.before.velocity);
    let at = jump.map_or(0.0, |sides| sides.before.position.x);
    let normal = match hardest.map(|impact| impact.with) {
        Some(With::Floor(floor)) => scene.floors.get(floor).map_or(Vector3::z(), |floor| normal(floor, change, at)),
        Some(With::Ball(_)) => change.normalize(),
        _ => Vector3::z(),
    };
    Contact {
        normal: normal.into(),
        speed: hardest.map_or(0.0, |impact| impact.approach),
        pressed: hardest.is_some_and(|impact| impact.press.is_some()),
    }
}

/// The normal of a floor or wall that changed a velocity by `change`; of a curve, below x.
fn normal(floor: &Floor, change: Vector3<f64>, x: f64) -> Vector3<f64> {
    let steep = |slope: f64| Vector3::new(-slope, 0.0, 1.0).normalize();
    let (across, along, up) = (Vector3::x(), Vector3::y(), Vector3::z());
    let sides = match floor.shape {
        Shape::Incline { angle, .. } => vec![steep(angle.tan())],
        Shape::Stairs { .. } => vec![up, across],
        Shape::Wall { across_y, .. } => {
            let axis = if across_y { along } else { across };
            vec![axis, -axis]
        }
        Shape::Box { .. } => vec![up, across, -across, along, -along, -up],
        Shape::Parabola { curvature, centre, .. } => vec![steep(curvature * (x - centre))],
        Shape::Sine { amplitude, wavelength, phase, .. } => {
            let k = std::f64::consts::TAU / wavelength;
            vec![steep(amplitude * k * (k * x + phase).cos())]
        }
        _ => vec![up],
    };
    sides.into_iter().reduce(|best, side| if side.dot(&change) > best.dot(&change) { side } else { best }).unwrap_or(up)
}

/// What a floor or a wall is in the plane of x and up, as far as the balls get; none for one across y.
fn outline(floor: &Floor, [[left, right], [low, high]]: [[f64; 2]; 2]) -> Option<Vec<[f64; 2]>> {
    let more = 0.1 * (right - left).max(high - low);
    let (left, right, high) = (left - more, right + more, high + more);
    let curve = |at: &dyn Fn(f64) -> f64| {
        /// Points of a curved floor.
        const POINTS: u32 = 400;
        let x = |k: u32| left + (right - left) * f64::from(k) / f64::from(POINTS);
        (0..=POINTS).map(|k| [x(k), at(x(k))]).collect()
    };
    let outline = match floor.shape {
        Shape::Parabola { curvature, centre, height } => {
            curve(&|x| height + 0.5 * curvature * (x - centre) * (x - centre))
        }
        Shape::Sine { amplitude, wavelength, phase, height } => {
            curve(&|x| height + amplitude * (std::f64::consts::TAU * x / wavelength + phase).sin())
        }
        _ => corners(floor, [[left, right], [low, high]]),
    };
    (!outline.is_empty()).then_some(outline)
}
