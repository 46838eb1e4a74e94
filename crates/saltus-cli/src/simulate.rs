//! `saltus simulate`: a scene or a drop in, a motion out.

use std::io::Read;
use std::ops::ControlFlow;
use std::path::Path;
use std::process::ExitCode;

use saltus::{Jump, Observer, Run, Simulation, Stop};
use saltus_bounce::scene::Scene;
use saltus_bounce::{Ball, Floor, Mode};
use saltus_plot::{Arc, Background, HeightTime};

use crate::args::{self, MotionFormat};
use crate::error::Error;
use crate::motion::Motion;
use crate::output::{check_picture, say, write};
use crate::plan::{Plan, plan};

/// The most arcs that are worth drawing one by one beyond the end of a picture's resolution.
const SHOWN_AFTER_REST: f64 = 0.05;
/// After how many jumps a run stops that says nothing of it.
const MOST_JUMPS: u32 = 10_000;

pub(crate) fn run(args: &args::Simulate, quiet: bool) -> Result<ExitCode, Error> {
    check_picture(args.plot.as_deref())?;
    let format = format(args)?;
    let plan = made(args)?;
    if let Some(note) = &plan.note {
        say(quiet, note);
    }
    let ball = Ball::new(plan.gravity, plan.cor).map_err(Error::new)?;
    let start = Ball::launched_from(plan.height, plan.velocity);
    let most = args.most_jumps.or(plan.most_jumps).unwrap_or(MOST_JUMPS);
    let simulation = Simulation::of(&ball).most_jumps(most as usize);
    let end = match args.until.or(plan.until) {
        Some(end) => end,
        None => rest(&simulation, start)? * (1.0 + SHOWN_AFTER_REST),
    };
    let run = simulation.run(Mode::Flight, start, 0.0..end).map_err(Error::new)?;
    if let Stop::Jumps { most } = run.stop {
        let t = run.trajectory.end().seconds();
        say(quiet, &format!("stopped after {most} jumps, at {t:.6} s: --most-jumps allows more, --until ends by time"));
    }
    let motion = Motion { plan: &plan, every: args.every, fps: args.fps, run: &run };
    let text = match format {
        MotionFormat::Text => motion.text(),
        MotionFormat::Csv => motion.csv(),
        MotionFormat::Json => motion.json()?,
    };
    if let Some(path) = &args.plot {
        write(Some(path), picture(&plan, &run).svg().map_err(Error::new)?.as_bytes())?;
    }
    write(args.output.as_deref(), text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// What is asked for, by a scene or by options.
fn made(args: &args::Simulate) -> Result<Plan, Error> {
    match (&args.scene, args.drop, args.cor) {
        (Some(path), _, _) => plan(&scene(path)?),
        (None, Some(height), Some(cor)) if height >= 0.0 => Ok(Plan {
            gravity: args.gravity,
            cor,
            height,
            velocity: args.velocity,
            until: None,
            most_jumps: None,
            title: None,
            note: None,
        }),
        (None, Some(_), Some(_)) => {
            Err(Error::new("the ball would start below the floor: give --drop a height of zero or more"))
        }
        _ => Err(Error::new(
            "there is nothing to simulate: give a scene file, or both --drop and --cor, such as --drop 1m --cor 0.8",
        )),
    }
}

fn scene(path: &Path) -> Result<Scene, Error> {
    if path == Path::new("-") {
        let mut toml = Vec::new();
        let most = Scene::LARGEST as u64 + 1;
        std::io::stdin().lock().take(most).read_to_end(&mut toml).map_err(Error::new)?;
        Scene::parse("standard input", &toml).map_err(Error::new)
    } else {
        Scene::read(path).map_err(Error::new)
    }
}

fn format(args: &args::Simulate) -> Result<MotionFormat, Error> {
    let extension = args.output.as_ref().and_then(|path| path.extension()).map(|e| e.to_string_lossy().to_lowercase());
    match (args.format, extension.as_deref()) {
        (Some(format), _) => Ok(format),
        (None, None | Some("txt")) => Ok(MotionFormat::Text),
        (None, Some("csv")) => Ok(MotionFormat::Csv),
        (None, Some("json")) => Ok(MotionFormat::Json),
        (None, Some(other)) => Err(Error::new(format!(
            "no format goes by the extension '.{other}': use .csv, .json or .txt, or say --format"
        ))),
    }
}

/// When the ball comes to rest, or makes its last jump that is allowed.
fn rest(simulation: &Simulation<'_, Ball>, start: saltus::nalgebra::Vector2<f64>) -> Result<f64, Error> {
    /// Ends the run at rest.
    struct AtRest;
    impl Observer<Ball> for AtRest {
        fn jump(&mut self, jump: &Jump<Ball>) -> ControlFlow<()> {
            if jump.to == Mode::Rest { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        }
    }
    let ending = simulation.drive(Mode::Flight, start, 0.0..f64::INFINITY, &mut AtRest).map_err(Error::new)?;
    let t = ending.time.seconds();
    if t.is_finite() {
        Ok(t)
    } else {
        Err(Error::new("without gravity the ball may never land: say --until when to stop"))
    }
}

fn picture(plan: &Plan, run: &Run<Ball>) -> HeightTime {
    let trajectory = &run.trajectory;
    let arcs = (0..trajectory.arcs().len()).flat_map(|index| {
        trajectory.pieces(index).map(|piece| {
            let heights = piece.coefficients().iter().map(|c| c[0]).collect();
            Arc::new(piece.start().seconds(), piece.span(), heights)
        })
    });
    let contacts = trajectory.jumps().iter().filter(|jump| jump.edge() == Some(Floor)).map(Jump::t);
    let rest = trajectory.jumps().iter().find(|jump| jump.to == Mode::Rest).map(Jump::t);
    let caption = match rest {
        Some(t) => format!("COR {}, gravity {} m/s²; at rest from {t:.3} s", plan.cor, plan.gravity),
        None => format!("COR {}, gravity {} m/s²", plan.cor, plan.gravity),
    };
    let title = plan.title.clone().unwrap_or_else(|| {
        if plan.velocity == 0.0 {
            format!("A ball dropped from {} m", plan.height)
        } else {
            format!("A ball thrown from {} m at {} m/s", plan.height, plan.velocity)
        }
    });
    HeightTime::new(&title).caption(&caption).motion("", arcs).contacts(contacts).background(Background::Adaptive)
}
