//! `saltus solve`: wishes in, a scene out.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args as ClapArgs;
use saltus_motion::Rate;
use saltus_scene::solve::{Clock, Wish, solve};

use crate::error::Error;
use crate::output::{check_new, say, write};
use crate::parse::{FIRST_FRAME, number};
use crate::scenes::{note, read};

/// What wishes look like.
const WISHES: &str = "Wishes, for example:
  'touch 1 at frame 24'       the first contact, on a frame or at a time such as 1.2s
  'touch 3 at 2m'             where the third contact is, sideways
  'apex 2 at 60cm'            the second apex: apex 1 is the top before the first contact
  'apex 2 at frame 30'        and when
  'hop 1 for 12 frames'       from the first contact to the second
  'rest at 3s'                when the ball has come to rest
With 'within 2cm' or 'within 1 frame' behind it a wish says how much it matters where not all can be met;
1 cm and half a frame unless it does.

Freedoms:
  height    where the ball starts          throw     how fast it starts upwards
  forward   how fast it starts sideways    gravity   how fast it falls
  cor       the coefficient of restitution
and any other number of the scene by its key, such as drag.per_length or floor.angle.";

/// Find the scene that does what is wished for, and write it.
///
/// Each freedom is a number of the scene that may be changed; all others stay. Without a scene the
/// ball falls from 1 m by the Earth's gravity and keeps 0.7 of its speed at each contact. See
/// docs/use/directing.md.
#[derive(Debug, ClapArgs)]
#[command(after_help = WISHES)]
pub(crate) struct Solve {
    /// What is to happen.
    #[arg(required = true, value_name = "WISH")]
    pub(crate) wishes: Vec<String>,
    /// Which numbers of the scene may change: height, throw, forward, gravity, cor, or keys.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', required = true)]
    pub(crate) free: Vec<String>,
    /// The scene to begin with; `-` for standard input.
    #[arg(long, value_name = "FILE")]
    pub(crate) scene: Option<PathBuf>,
    /// Frames per second, such as `24`, `29.97` or `24000/1001`.
    #[arg(long, value_name = "RATE", default_value = "24", allow_hyphen_values = true)]
    pub(crate) fps: Rate,
    /// The number of the frame at which the motion starts.
    #[arg(long, value_name = "NUMBER", default_value_t = 0, allow_hyphen_values = true, value_parser = number(FIRST_FRAME))]
    pub(crate) first_frame: i32,
    /// Where to write the scene; `-` for standard output, as without it.
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Write the scene anew where the file exists.
    #[arg(long)]
    pub(crate) force: bool,
}

pub(crate) fn run(args: &Solve, quiet: bool) -> Result<ExitCode, Error> {
    let clock = Clock { fps: args.fps.per_second(), first: args.first_frame };
    let wishes = args.wishes.iter().map(|text| Wish::parse(text, clock));
    let wishes = wishes.collect::<Result<Vec<_>, _>>().map_err(Error::new)?;
    check_new(args.output.as_deref(), args.force)?;
    let begin = args.scene.as_deref().map(read).transpose()?;
    let begin = begin.as_ref().map(|(name, text)| (name.as_str(), text.as_slice()));
    let free: Vec<&str> = args.free.iter().map(String::as_str).collect();
    let solved = solve(begin, &free, &wishes).map_err(Error::new)?;
    if let Some(note) = note(solved.begun()) {
        say(quiet, &note);
    }
    write(args.output.as_deref(), solved.toml().map_err(Error::new)?.as_bytes())?;
    for line in solved.says(clock) {
        say(quiet, &line);
    }
    Ok(ExitCode::SUCCESS)
}
