//! `saltus simulate`: a scene or a drop in, a motion out.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use clap::{Args as ClapArgs, ValueEnum};
use saltus_bounce::effects::Gravity;
use saltus_bounce::units::Quantity;
use saltus_plot::record;
use saltus_scene::accuracy::Target;
use saltus_scene::{Kind, Sampling, Scene};

use crate::accuracy;
use crate::error::Error;
use crate::output::{check_apart, check_extension, check_picture, extension, say, write};
use crate::parse::{JUMPS, RATES, number, one_of, positive, quantity, target};
use crate::scenes::{ended, ending, note, planned, scene};

/// Simulate a scene, or a ball that bounces on a level floor.
///
/// A scene is a TOML file; see docs/use/scenes.md. Without one, --drop and --cor say all there is:
/// gravity and a constant coefficient of restitution, every flight an exact parabola. Without
/// --until the run ends when nothing happens any more.
#[derive(Debug, ClapArgs)]
pub(crate) struct Simulate {
    /// The scene; `-` for standard input.
    #[arg(conflicts_with_all = ["drop", "cor", "velocity", "gravity"])]
    pub(crate) scene: Option<PathBuf>,
    /// The height it starts from, such as `1m` or `100cm`.
    #[arg(long, value_name = "LENGTH", value_parser = quantity(Quantity::Length), allow_hyphen_values = true)]
    pub(crate) drop: Option<f64>,
    /// The coefficient of restitution, from 0 to 1.
    #[arg(long, value_name = "NUMBER", value_parser = number(0.0..=1.0), allow_hyphen_values = true)]
    pub(crate) cor: Option<f64>,
    /// The upward velocity it starts with, such as `-2m/s`.
    #[arg(long, value_name = "SPEED", value_parser = quantity(Quantity::Speed), default_value = "0m/s", allow_hyphen_values = true)]
    pub(crate) velocity: f64,
    /// Gravity, which acts downwards.
    #[arg(long, value_name = "ACCELERATION", value_parser = quantity(Quantity::Acceleration), default_value = "9.81m/s^2", allow_hyphen_values = true)]
    pub(crate) gravity: f64,
    /// When to stop, such as `4s`.
    #[arg(long, value_name = "TIME", value_parser = positive(Quantity::Time), allow_hyphen_values = true)]
    pub(crate) until: Option<f64>,
    /// After how many jumps to stop; 10000 unless given here or in the scene.
    #[arg(long, value_name = "COUNT", value_parser = number(JUMPS), allow_hyphen_values = true)]
    pub(crate) most_jumps: Option<u32>,
    /// Sample the motion at this interval, such as `10ms`, for the formats `csv` and `json`.
    #[arg(long, value_name = "TIME", value_parser = positive(Quantity::Time), conflicts_with = "fps", allow_hyphen_values = true)]
    pub(crate) every: Option<f64>,
    /// Sample the motion at this many frames per second.
    #[arg(long, value_name = "NUMBER", value_parser = number(RATES), allow_hyphen_values = true)]
    pub(crate) fps: Option<f64>,
    /// How to write the motion; without it, after the extension of the output file, or else as
    /// text.
    #[arg(long, value_enum)]
    pub(crate) format: Option<MotionFormat>,
    /// Write the motion to a file, anew where it exists; `-` for standard output.
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Draw the motion as SVG; `-o FILE.svg` does so too and writes nothing else; `-` draws to
    /// standard output, and nothing else goes there.
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot: Option<PathBuf>,
    /// Choose the cheapest stepper and tolerance that keep every place and every impact this exact,
    /// such as `1mm`, `0.1ms`, or `1mm,1ms`.
    #[arg(long, value_name = "LENGTH,TIME", value_parser = target, allow_hyphen_values = true)]
    pub(crate) target: Option<Target>,
    /// What is drawn; without it what the scene says, or else height.
    #[arg(long, value_parser = one_of(&Kind::ALL, Kind::name, Kind::about))]
    pub(crate) kind: Option<Kind>,
}

/// How a motion is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MotionFormat {
    /// The jumps, for people.
    Text,
    /// The motion, for a spreadsheet: both sides of each jump, and samples if asked for.
    Csv,
    /// The jumps with both sides, for programs.
    Json,
}

pub(crate) fn run(args: &Simulate, quiet: bool) -> Result<ExitCode, Error> {
    let (format, drawn) = outputs(args)?;
    check_picture(drawn)?;
    if let Some(from) = &args.scene {
        check_apart(args.output.as_deref(), from)?;
    }
    let mut scene = made(args)?;
    if let Some(note) = note(&scene) {
        say(quiet, &note);
    }
    if let Some(target) = args.target {
        let (aimed, chosen) = accuracy::aimed(scene, target)?;
        say(quiet, &chosen);
        scene = aimed;
    }
    let sampling = args.every.map(Sampling::Every).or(args.fps.map(Sampling::Rate));
    let sampled = matches!(format, Some(MotionFormat::Csv | MotionFormat::Json));
    if let (true, Some(sampling), Some(until)) = (sampled, sampling, scene.run.until) {
        sampling.holds(until).map_err(Error::new)?;
    }
    let plan = planned(&scene, args.scene.as_deref())?;
    let record = plan.run().map_err(Error::new)?;
    ended(&record, quiet);
    if drawn.is_some() {
        let picture = record::svg(&record, args.kind.unwrap_or(scene.picture.kind)).map_err(Error::new)?;
        write(drawn, picture.as_bytes())?;
    }
    let text = match format {
        None => return Ok(ExitCode::SUCCESS),
        Some(MotionFormat::Text) => record.to_string(),
        Some(MotionFormat::Csv) => record.table(sampling).map_err(Error::new)?.csv(),
        Some(MotionFormat::Json) => record.json(sampling).map_err(Error::new)?,
    };
    let to = args.output.as_deref().filter(|path| !is_svg(path));
    write(to, text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// What is asked for, by a scene or by options.
fn made(args: &Simulate) -> Result<Scene, Error> {
    match (&args.scene, args.drop, args.cor) {
        (Some(path), _, _) => scene(path, ending(args.until, args.most_jumps)),
        (None, Some(height), Some(cor)) if height >= 0.0 => {
            Gravity::new(args.gravity).map_err(Error::new)?;
            // The options are a small scene; a limit on jumps ends it where nothing else does.
            let end = ending(args.until, args.most_jumps.or(Some(10_000)));
            let toml = format!(
                "gravity = {:?}\nrestitution = {:?}\nball = {{ height = {height:?}, velocity = {:?} }}\n",
                args.gravity, cor, args.velocity
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

fn is_svg(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("svg"))
}

/// The format of the motion, if it is to be written, and where the picture goes.
fn outputs(args: &Simulate) -> Result<(Option<MotionFormat>, Option<&Path>), Error> {
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
        (Some(format), _) => {
            let (name, own) = match format {
                MotionFormat::Text => ("text", "txt"),
                MotionFormat::Csv => ("csv", "csv"),
                MotionFormat::Json => ("json", "json"),
            };
            check_extension(output, name, own, &["csv", "json"])?;
            format
        }
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
