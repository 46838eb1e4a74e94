//! `saltus simulate`: a scene or a drop in, a motion out.

use std::fs::File;
use std::io::Read;
use std::path::Path;
use std::process::ExitCode;

use saltus_bounce::effects::Gravity;
use saltus_scene::plan::{End, Plan, Record};
use saltus_scene::{Law, ReadError, Run, Scene};

use crate::accuracy;
use crate::args::{self, MotionFormat};
use crate::error::Error;
use crate::motion::Motion;
use crate::output::{check_picture, extension, say, write};
use crate::picture;

pub(crate) fn run(args: &args::Simulate, quiet: bool) -> Result<ExitCode, Error> {
    let (format, drawn) = outputs(args)?;
    check_picture(drawn)?;
    let mut scene = made(args)?;
    if let Some(note) = note(&scene) {
        say(quiet, &note);
    }
    if let Some(target) = args.target {
        let (aimed, chosen) = accuracy::aimed(scene, target)?;
        say(quiet, &chosen);
        scene = aimed;
    }
    let plan = planned(&scene, args.scene.as_deref())?;
    let model = plan.explain().model;
    let record = plan.run().map_err(Error::new)?;
    ended(&record, quiet);
    if drawn.is_some() {
        let kind = args.kind.map_or(scene.picture.kind, args::PictureKind::kind);
        write(drawn, picture::svg(&scene, &record, kind)?.as_bytes())?;
    }
    let motion = Motion { scene: &scene, model, every: args.every, fps: args.fps, record: &record };
    let text = match format {
        None => return Ok(ExitCode::SUCCESS),
        Some(MotionFormat::Text) => motion.text(),
        Some(MotionFormat::Csv) => motion.csv()?,
        Some(MotionFormat::Json) => motion.json()?,
    };
    let to = args.output.as_deref().filter(|path| !is_svg(path));
    write(to, text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// The plan of a scene; what cannot be run is said with the file's name.
pub(crate) fn planned(scene: &Scene, path: Option<&Path>) -> Result<Plan, Error> {
    scene.plan().map_err(|error| match path {
        Some(path) if path != Path::new("-") && error.in_text().is_none() => {
            Error::new(format!("{}: {error}", path.display()))
        }
        _ => Error::new(error),
    })
}

/// Says why a run ended, if that is not what was asked for.
pub(crate) fn ended(record: &Record, quiet: bool) {
    let t = record.until();
    let doubts = record.doubts();
    if let Some(first) = doubts.first() {
        let more = match doubts.len() - 1 {
            0 => String::new(),
            more => format!(" (and {more} more like it)"),
        };
        say(quiet, &format!("a jump may have been missed: {first}{more}"));
    }
    match record.end() {
        End::Time => {}
        End::Jumps { most } => {
            say(
                quiet,
                &format!("stopped after {most} jumps, at {t:.6} s: --most-jumps allows more, --until ends by time"),
            );
        }
        end => say(quiet, &format!("stopped at {t:.6} s: {end}")),
    }
}

/// What is asked for, by a scene or by options.
fn made(args: &args::Simulate) -> Result<Scene, Error> {
    match (&args.scene, args.drop, args.cor) {
        (Some(path), _, _) => scene(path, ending(args.until, args.most_jumps)),
        (None, Some(height), Some(cor)) if height >= 0.0 => {
            Gravity::new(args.gravity).map_err(Error::new)?;
            // The options are a small scene; a limit on jumps ends it where nothing else does.
            let end = ending(args.until, args.most_jumps.or(Some(10_000)));
            let toml = format!(
                "gravity = {:?}\nrestitution = {:?}\nball = {{ height = {height:?}, velocity = {:?} }}\n",
                args.gravity,
                cor.value(),
                args.velocity
            );
            Scene::parse_with("options", toml.as_bytes(), end).map_err(Error::new)
        }
        (None, Some(_), Some(_)) => {
            Err(Error::new("the ball would start below the floor: give --drop a height of zero or more"))
        }
        _ => Err(Error::new(
            "there is nothing to simulate: give a scene file, or both --drop and --cor, such as --drop 1m --cor 0.8",
        )),
    }
}

/// What the command line says of the run's end.
pub(crate) fn ending(until: Option<f64>, most_jumps: Option<u32>) -> Run {
    let mut run = Run::default();
    (run.until, run.most_jumps) = (until, most_jumps);
    run
}

/// The scene of a file or of standard input; what the command line says in `run` goes before what the scene says.
pub(crate) fn scene(path: &Path, run: Run) -> Result<Scene, Error> {
    let (name, toml) = read(path)?;
    Scene::parse_with(&name, &toml, run).map_err(Error::new)
}

/// The text of a scene, from a file or from standard input, and its name.
pub(crate) fn read(path: &Path) -> Result<(String, Vec<u8>), Error> {
    let most = Scene::LARGEST as u64 + 1;
    let mut toml = Vec::new();
    if path == Path::new("-") {
        std::io::stdin().lock().take(most).read_to_end(&mut toml).map_err(Error::new)?;
        return Ok(("standard input".to_owned(), toml));
    }
    let error = |error| Error::new(ReadError::File { path: path.to_owned(), error });
    File::open(path).and_then(|file| file.take(most).read_to_end(&mut toml)).map_err(error)?;
    Ok((path.to_string_lossy().into_owned(), toml))
}

fn is_svg(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg"))
}

/// The format of the motion, if it is to be written, and where the picture goes.
fn outputs(args: &args::Simulate) -> Result<(Option<MotionFormat>, Option<&Path>), Error> {
    let output = args.output.as_deref();
    if args.plot.as_deref() == Some(Path::new("-")) && output.is_none_or(|path| path == Path::new("-")) {
        if output.is_none() && args.format.is_none() {
            return Ok((None, args.plot.as_deref()));
        }
        return Err(Error::new(
            "the picture and the motion cannot both go to standard output: name a file for one, by --plot or by -o",
        ));
    }
    if let Some(path) = output.filter(|path| is_svg(path)) {
        if args.plot.is_some() {
            return Err(Error::new("the picture is to go to two files: give either --plot or -o with a name in .svg"));
        }
        return Ok((args.format, Some(path)));
    }
    let extension = output.and_then(extension);
    let format = match (args.format, extension.as_deref()) {
        (Some(format), _) => format,
        (None, None | Some("txt")) => MotionFormat::Text,
        (None, Some("csv")) => MotionFormat::Csv,
        (None, Some("json")) => MotionFormat::Json,
        (None, Some(other)) => {
            return Err(Error::new(format!(
                "no format goes by the extension '.{other}': use .csv, .json, .txt or .svg, or say --format"
            )));
        }
    };
    Ok((Some(format), args.plot.as_deref()))
}

/// A range is said to be one, with its source, where a run takes one number of it.
pub(crate) fn note(scene: &Scene) -> Option<String> {
    let law = scene.law(0, 0)?;
    let [low, high] = law.range(0.0);
    let cor = law.constant()?;
    let taken = format!("this run takes {:.4}; `restitution = {{ pick = 0 }}` to `1` takes another", cor.value());
    match law {
        Law::Preset { preset, .. } => Some(format!("{preset}: {taken}")),
        Law::Range { .. } => Some(format!("COR between {low} and {high}: {taken}")),
        _ => None,
    }
}
