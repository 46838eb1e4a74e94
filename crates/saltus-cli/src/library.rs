//! `saltus library`: one motion in, a folder of many like it out, and an index of them.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{fs, io};

use clap::Args as ClapArgs;
use saltus_fit::{Fit, ReadOptions};
use saltus_motion::Format;
use saltus_scene::vary::{Value, Vary, refused};
use saltus_scene::{Stage, Template, at_most, rounded_up};
use serde_json::{Map, Value as Json, json};

use crate::error::{Error, system};
use crate::export::Shown;
use crate::fit::tables;
use crate::output::{extension, say, write};
use crate::parse::one_of;
use crate::progress::Progress;
use crate::scenes::{ending, read};
use crate::staging::{Staging, drawn};
use crate::varying::{VARIATIONS, Varying};

/// The number of the contract of `index.json`.
const SCHEMA: u32 = 1;
/// More motions than a folder should hold.
const MOST: u64 = 10_000;
/// File names end after so many letters.
const NAME: usize = 100;

/// Write many motions like one for animators: a file for each, and an index of them.
///
/// The one is a scene, or a table of bounces, whose fitted motion is varied. A key is the path of a
/// value in the scene file, as in `ball.height`, or says how the motion is shown: fps, snap,
/// on-twos, squash, stretch, exaggerate, hold, loop, mirror. `index.json` has the values, frames
/// and contacts of every motion. See docs/use/motion.md.
#[derive(Debug, ClapArgs)]
#[command(after_help = VARIATIONS)]
pub(crate) struct Library {
    /// The scene, `-` for standard input; or a table of bounces (.csv, .tsv, .txt, .xlsx, .xls,
    /// .zip).
    pub(crate) source: PathBuf,
    #[command(flatten)]
    pub(crate) vary: Varying,
    /// What is written of each motion; several with commas between.
    #[arg(long, value_name = "FORMATS", value_delimiter = ',', required = true, value_parser = one_of(&Format::ALL, Format::name, Format::about))]
    pub(crate) to: Vec<Format>,
    /// The folder, made if there is none.
    #[arg(long, short, value_name = "FOLDER", required = true)]
    pub(crate) output: PathBuf,
    /// Write into the folder also where it is not empty.
    #[arg(long)]
    pub(crate) force: bool,
    #[command(flatten)]
    pub(crate) shown: Shown,
}

pub(crate) fn run(args: &Library, quiet: bool) -> Result<ExitCode, Error> {
    args.to.iter().try_for_each(|format| format.takes(args.shown.space())).map_err(Error::new)?;
    let vary = args.vary.vary()?;
    let keys = vary.keys().map_err(Error::new)?;
    let runs = vary.runs().map_err(Error::new)?;
    if runs > MOST {
        return Err(Error::new(format!(
            "{runs} motions are more than {MOST}: vary less, or draw some of them by --random 100"
        )));
    }
    if let Some(key) = keys.iter().find(|key| args.shown.staging.gives(key)) {
        return Err(Error::new(format!(
            "`{key}` varies, and --{key} gives it for every motion: leave one of them out"
        )));
    }
    let (name, toml) = source(&args.source, quiet)?;
    check_folder(&args.output, args.force)?;
    let of_scene: Vec<&str> = keys.into_iter().filter(|key| !Staging::VARIED.contains(key)).collect();
    let template = Template::parse(&name, &toml, &of_scene).map_err(Error::new)?;
    let maker = Maker { args, vary: &vary, template: &template, digits: (runs - 1).to_string().len() };

    // An error in the first motion is one of the library, and ends it before anything is written.
    let first = maker.made(0).map_err(|error| Error::new(format!("motion 0, {}: {error}", vary.says(0))))?;
    if let Some(drawn) = &first.drawn {
        say(quiet, drawn);
    }
    let folder = |error: io::Error| {
        Error::new(format!("cannot make the folder '{}': {}", args.output.display(), system(&error)))
    };
    fs::create_dir_all(&args.output).map_err(folder)?;

    let mut progress = Progress::new(runs, quiet);
    let (mut motions, mut nothing) = (Vec::new(), Vec::new());
    let (mut off, mut miss) = (0.0_f64, 0.0_f64);
    let mut put = |run: usize, made: Result<Made, String>| {
        progress.reached(run as u64 + 1);
        match made {
            Ok(made) => {
                (off, miss) = (off.max(made.off), miss.max(made.miss));
                for (file, bytes) in &made.files {
                    if let Err(error) = write(Some(&args.output.join(file)), bytes) {
                        return ControlFlow::Break(error);
                    }
                }
                motions.push(made.says);
            }
            Err(why) => {
                let values = named(&vary, &vary.values(run as u64));
                nothing.push(json!({ "run": run, "values": values, "why": why }));
            }
        }
        ControlFlow::Continue(())
    };
    #[allow(clippy::cast_possible_truncation)] // at most ten thousand
    let rest = 1..runs as usize;
    let ended = match put(0, Ok(first)) {
        ControlFlow::Continue(()) => saltus::ensemble(rest, |run| maker.made(run as u64), put),
        stopped => stopped,
    };
    progress.clear();
    if let ControlFlow::Break(error) = ended {
        return Err(Error::new(format!(
            "{error}; '{}' has {} whole motions and no index: --force writes all anew",
            args.output.display(),
            motions.len()
        )));
    }
    let index = json!({
        "schema": SCHEMA, "saltus": env!("CARGO_PKG_VERSION"), "source": name, "vary": vary.texts(),
        "random": vary.random, "seed": vary.random.map(|_| vary.seed),
        "motions": motions, "nothing": nothing,
    });
    let index = serde_json::to_string_pretty(&index).map_err(Error::new)? + "\n";
    write(Some(&args.output.join("index.json")), index.as_bytes())?;
    let (made, folder) = (motions.len(), args.output.display());
    say(
        quiet,
        &format!(
            "{made} motions and index.json in '{folder}'; farthest contact from a frame: {} frames; worst height error: {}",
            rounded_up(off, 2),
            at_most(miss)
        ),
    );
    if let Some(first) = nothing.first() {
        let run = first["run"].as_u64().unwrap_or(0);
        let why = first["why"].as_str().unwrap_or_default();
        say(
            quiet,
            &format!(
                "{} of {runs} came to nothing; the first is motion {run}, {}: {why}",
                nothing.len(),
                vary.says(run)
            ),
        );
    }
    Ok(ExitCode::SUCCESS)
}

/// The text of the scene, and its name: of a table the scene that is fitted to it.
fn source(path: &Path, quiet: bool) -> Result<(String, Vec<u8>), Error> {
    match extension(path).as_deref() {
        Some("csv" | "tsv" | "txt" | "xlsx" | "xls" | "zip") => {
            let table = tables(&[path.to_owned()], &ReadOptions::default())?;
            let report = Fit::new().run(&table).map_err(Error::new)?;
            let scene = report
                .scene()
                .ok_or_else(|| Error::new(format!("'{}' gives no motion: {}", path.display(), report.reason())))?;
            say(quiet, &format!("{}: {}; {}", table.name(), report.verdict(), report.reason()));
            Ok((path.to_string_lossy().into_owned(), scene.into_bytes()))
        }
        _ => read(path),
    }
}

/// Refuses to mix the library with what is in the folder, unless it is asked for.
fn check_folder(path: &Path, force: bool) -> Result<(), Error> {
    if path == Path::new("-") {
        return Err(Error::new("a library is many files, and standard output is one: name a folder"));
    }
    match fs::read_dir(path) {
        Ok(files) => {
            if files.count() > 0 && !force {
                let says = "is not empty: name a new one, or say --force to write into it";
                return Err(Error::new(format!("the folder '{}' {says}", path.display())));
            }
            Ok(())
        }
        Err(error) if error.kind() == io::ErrorKind::NotADirectory => {
            Err(Error::new(format!("'{}' is a file: name a folder", path.display())))
        }
        // The error comes when it is made.
        Err(_) => Ok(()),
    }
}

/// Makes motions by their numbers.
struct Maker<'a> {
    args: &'a Library,
    vary: &'a Vary,
    template: &'a Template<'a>,
    /// Of the greatest number.
    digits: usize,
}

/// One motion of the library.
struct Made {
    files: Vec<(String, Vec<u8>)>,
    /// Its entry in the index.
    says: Json,
    /// What had to be supposed of sizes.
    drawn: Option<String>,
    /// Farthest contact from a frame, in frames, and worst error of a height, in m.
    off: f64,
    miss: f64,
}

impl Maker<'_> {
    /// The motion of a run, or why there is none.
    fn made(&self, run: u64) -> Result<Made, String> {
        let args = self.args;
        let values = self.vary.values(run);
        let mut staging = args.shown.staging.clone();
        let mut of_scene: Vec<&str> = Vec::new();
        for (variation, value) in self.vary.variations.iter().zip(&values) {
            if Staging::VARIED.contains(&variation.key.as_str()) {
                staging.set(&variation.key, value.bare())?;
            } else {
                of_scene.push(&value.toml);
            }
        }
        let end = ending(staging.until, None);
        let scene = self.template.scene(&of_scene, end).map_err(|error| refused(&error))?;
        let staging = staging.staging(args.shown.first_frame);
        staging.holds(&scene).map_err(|error| error.to_string())?;
        let record = scene.plan().map_err(|error| error.to_string())?.run().map_err(|error| error.to_string())?;
        let mut stage = staging.stage(&record).map_err(|error| error.to_string())?;
        stage.space = args.shown.space();
        let name = self.name(run, &values);
        let (mut files, mut written, mut miss) = (Vec::new(), Map::new(), 0.0_f64);
        for &format in &args.to {
            let file = stage.file(format, args.shown.tolerance).map_err(|error| error.to_string())?;
            let path = format!("{name}.{}", format.ending());
            let error = stage.height_error(&file);
            miss = miss.max(error);
            let says = stage.says(&file);
            let of = json!({ "name": path, "keys": file.keys, "height_error_m": error, "says": says });
            written.insert(format.name().to_owned(), of);
            files.push((path, file.bytes));
        }
        let drawn = drawn(&stage);
        let Stage { motion, frames, .. } = stage;
        let contacts = motion.tracks.iter().enumerate().flat_map(|(ball, track)| {
            track.stretches.iter().filter_map(move |stretch| {
                let contact = stretch.contact?;
                let t = stretch.start();
                Some(json!({ "ball": ball, "t": t, "frame": frames.number(t), "speed": contact.speed }))
            })
        });
        let off = motion.off_frame(frames);
        let says = json!({
            "run": run, "values": named(self.vary, &values), "files": written, "fps": frames.rate.to_string(),
            "first_frame": frames.first, "last_frame": frames.number(motion.end()), "end_s": motion.end(), "loops": motion.loops,
            "contacts": contacts.collect::<Vec<_>>(), "frames_off": off,
        });
        Ok(Made { files, says, drawn, off, miss })
    }

    /// `07-restitution=0.7-ball.height=1m`: for people to tell files apart; the number alone does
    /// for programs.
    fn name(&self, run: u64, values: &[Value]) -> String {
        let mut name = format!("{run:0width$}", width = self.digits);
        for (variation, value) in self.vary.variations.iter().zip(values) {
            name += &format!("-{}={}", variation.key, value.short());
        }
        let plain = |c: char| c.is_alphanumeric() || matches!(c, '.' | '-' | '=' | '_' | '+');
        name.chars().map(|c| if plain(c) { c } else { '_' }).take(NAME).collect()
    }
}

/// Values by the names of their columns.
fn named(vary: &Vary, values: &[Value]) -> Map<String, Json> {
    let pairs = vary.variations.iter().zip(values).map(|(variation, value)| {
        let number = value.cell.parse::<f64>().ok().filter(|_| !value.word);
        (variation.header(), number.map_or_else(|| json!(value.cell), Json::from))
    });
    pairs.collect()
}
