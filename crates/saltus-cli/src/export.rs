//! `saltus export`: a scene in, a file for animators out.

use std::path::Path;
use std::process::ExitCode;

use saltus_bounce::scene::plan::Record;
use saltus_bounce::scene::{Floor, Scene, Shape};
use saltus_motion::{Export, Format, Frames, Motion, Piece, Snap, Stretch, Track};

use crate::args::{self, ExportFormat, SnapBy};
use crate::error::Error;
use crate::ground::{corners, name};
use crate::output::{say, write};
use crate::simulate::{ended, ending, note, planned, scene};

pub(crate) fn run(args: &args::Export, quiet: bool) -> Result<ExitCode, Error> {
    let format = format(args)?;
    let frames = Frames { rate: args.fps, first: args.first_frame, on_twos: args.on_twos };
    let scene = scene(&args.scene, ending(args.until, None))?;
    if let Some(note) = note(&scene) {
        say(quiet, &note);
    }
    let plan = planned(&scene, Some(&args.scene))?;
    let record = plan.run().map_err(Error::new)?;
    ended(&record, quiet);
    let whole = motion(&scene, &record, quiet)?;
    let free = whole.cut(frames.step());
    let by = args.snap.map(|snap| match snap {
        SnapBy::Gravity => Snap::Gravity,
        SnapBy::Heights => Snap::Heights,
    });
    let shown = match by {
        Some(by) => free.snapped(by, frames).map_err(Error::new)?,
        None => free.clone(),
    };
    let export = Export { motion: &shown, frames, tolerance: args.tolerance };
    let file = export.file(format).map_err(Error::new)?;
    write(args.output.as_deref(), &file.bytes)?;
    let moved = match by {
        Some(Snap::Gravity) => {
            format!("; snapped by gravity, tops moved by up to {}", length(shown.tops_differ(&free)))
        }
        Some(_) => format!("; snapped by heights, the end moved by {:.4} s", (shown.end() - free.end()).abs()),
        None => String::new(),
    };
    let left_out = match hops_below(&whole, frames.step()) {
        high if high > 0.0 && whole.tracks != free.tracks => format!("; hops of up to {} left out", length(high)),
        _ => String::new(),
    };
    let off = shown.off_frame(frames);
    say(
        quiet,
        &format!(
            "{} keys; farthest contact from a frame: {off:.2} frames; worst height error: {}{left_out}{moved}",
            file.keys,
            length(file.miss.height)
        ),
    );
    Ok(ExitCode::SUCCESS)
}

/// The format by name, or by the extension of the file.
fn format(args: &args::Export) -> Result<Format, Error> {
    let extension = args.output.as_deref().and_then(Path::extension).map(|e| e.to_string_lossy().to_lowercase());
    let format = match (args.to, extension.as_deref()) {
        (Some(format), _) => format,
        (None, Some("csv")) => ExportFormat::Csv,
        (None, Some("glb")) => ExportFormat::Glb,
        (None, Some("usda")) => ExportFormat::Usd,
        (None, Some("svg")) => ExportFormat::Svg,
        (None, Some("json" | "py")) => {
            return Err(Error::new("several formats go by that extension: say --to json, lottie, blender or maya"));
        }
        (None, Some(other)) => {
            let says = "use .glb, .usda, .svg or .csv, or say --to";
            return Err(Error::new(format!("no format goes by the extension '.{other}': {says}")));
        }
        (None, None) => {
            return Err(Error::new("say which format, such as --to glb, or name a file, such as -o ball.glb"));
        }
    };
    Ok(match format {
        ExportFormat::Csv => Format::Csv,
        ExportFormat::CsvFrames => Format::CsvFrames,
        ExportFormat::Json => Format::Json,
        ExportFormat::Blender => Format::Blender,
        ExportFormat::Maya => Format::Maya,
        ExportFormat::Glb => Format::Glb,
        ExportFormat::Usd => Format::Usd,
        ExportFormat::UsdSplines => Format::UsdSplines,
        ExportFormat::Lottie => Format::Lottie,
        ExportFormat::Svg => Format::Svg,
    })
}

/// How high the flights are that take less than `span` in s, at most.
fn hops_below(motion: &Motion, span: f64) -> f64 {
    let flights = motion.tracks.iter().flat_map(|track| &track.stretches);
    let short = flights.filter(|stretch| stretch.flight && stretch.span() < span);
    let high = |stretch: &Stretch| stretch.top().0 - stretch.at(stretch.start())[2].max(stretch.at(stretch.end())[2]);
    short.map(high).fold(0.0, f64::max)
}

/// A length that a person can picture.
fn length(metres: f64) -> String {
    match metres {
        m if m < 1e-9 => "0 mm".to_owned(),
        m if m < 1e-5 => format!("{:.1e} mm", m * 1e3),
        m if m < 0.01 => format!("{:.2} mm", m * 1e3),
        m if m < 1.0 => format!("{:.1} cm", m * 1e2),
        m => format!("{m:.2} m"),
    }
}

/// The record as tracks: a stretch ends where a velocity jumps, or where a flight begins or ends.
fn motion(scene: &Scene, record: &Record, quiet: bool) -> Result<Motion, Error> {
    let events = record.events();
    let mut tracks = Vec::new();
    let mut sizeless = Vec::new();
    for ball in 0..record.balls() {
        let mut jumps: Vec<f64> = Vec::new();
        for event in &events {
            let sides = event.sides.iter().filter(|sides| sides.ball == ball);
            let broken = |sides: &&saltus_bounce::scene::plan::Sides| sides.before.velocity != sides.after.velocity;
            jumps.extend(sides.filter(broken).map(|_| event.t));
        }
        let mut stretches: Vec<Stretch> = Vec::new();
        for segment in record.segments(ball).into_iter().filter(|segment| segment.span > 0.0) {
            let coefficients = segment.coefficients.iter().map(|c| c.position.into()).collect();
            let piece = Piece { start: segment.start, span: segment.span, coefficients };
            let jumped = jumps.binary_search_by(|t| t.total_cmp(&segment.start)).is_ok();
            match stretches.last_mut() {
                Some(last) if !jumped && last.flight == segment.flight => last.pieces.push(piece),
                last => {
                    let contact = last.is_some_and(|last| last.flight && (jumped || !segment.flight));
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
    if !sizeless.is_empty() {
        let high = if sizeless.len() == tracks.len() { top - low - 2.0 } else { top - low };
        let drawn = if high > 0.0 { 0.02 * high } else { 0.02 };
        sizeless.iter().for_each(|&ball| tracks[ball].radius = drawn);
        say(quiet, &format!("the scene gives no radius: drawn with {}; set `radius` under [ball]", length(drawn)));
    }
    let (reach, tracks) = reach(tracks).map_err(Error::new)?;
    let title = scene.picture.title.clone().unwrap_or_else(|| "A bouncing ball".to_owned());
    let ground = scene.floors.iter().filter_map(|floor| outline(floor, reach)).collect();
    Motion::new(&title, tracks, ground).map_err(Error::new)
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
