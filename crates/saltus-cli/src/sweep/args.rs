//! The options of a sweep.

use std::path::PathBuf;

use clap::Args as ClapArgs;
use saltus_bounce::units::Quantity;
use saltus_scene::sweep::{Column, RowFormat};

use crate::parse::{JUMPS, number, one_of, positive};
use crate::varying::{VARIATIONS, Varying};

/// One of several shares of the work.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Share {
    /// Counted from 1.
    pub(crate) k: usize,
    pub(crate) of: usize,
}

fn share(text: &str) -> Result<Share, String> {
    let read = text.split_once('/').and_then(|(k, of)| Some(Share { k: k.parse().ok()?, of: of.parse().ok()? }));
    read.filter(|share| (1..=share.of).contains(&share.k))
        .ok_or_else(|| format!("'{text}' is no share: write 2/4 for the second of four"))
}

/// Run a scene many times with other values, and write a table with a row for each run.
///
/// A key is the path of a value in the scene file, as in `ball.height`, whether the file says it or
/// not. Runs go on all cores; the table is the same to the byte on any number of them. A sweep that
/// was broken off is gone on with by --resume. See docs/use/sweeping.md.
#[derive(Debug, ClapArgs)]
#[command(after_help = VARIATIONS)]
pub(crate) struct Sweep {
    /// The scene; `-` for standard input.
    pub(crate) scene: PathBuf,
    #[command(flatten)]
    pub(crate) vary: Varying,
    /// The results to write, behind the values; without it, all that the scene has.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', value_parser = one_of(&Column::ALL, Column::name, Column::about))]
    pub(crate) columns: Option<Vec<Column>>,
    /// Write to a file; `-` for standard output.
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// How to write it; without it, after the extension of the output file, or else as CSV.
    #[arg(long, value_parser = one_of(&RowFormat::ALL, RowFormat::name, RowFormat::about))]
    pub(crate) format: Option<RowFormat>,
    /// Write parts of Parquet to a folder instead, each whole or absent; several may write to one,
    /// and the same command goes on with what is there.
    #[arg(long, value_name = "DIR", conflicts_with_all = ["output", "format", "plot", "resume", "force"])]
    pub(crate) into: Option<PathBuf>,
    /// Make the K-th of N shares of the parts, for N machines.
    #[arg(long, value_name = "K/N", requires = "into", value_parser = share)]
    pub(crate) part: Option<Share>,
    /// How many rows a part has; as many as one core makes in half a second unless given.
    #[arg(long, value_name = "COUNT", requires = "into", value_parser = number(1_u64..=u64::MAX), allow_hyphen_values = true)]
    pub(crate) chunk: Option<u64>,
    /// Draw a result of the runs against the one or two keys that vary, as SVG.
    #[arg(long, value_name = "FILE")]
    pub(crate) plot: Option<PathBuf>,
    /// The result to draw, a heading of the table; when all was at rest unless given.
    #[arg(long, value_name = "NAME", requires = "plot")]
    pub(crate) show: Option<String>,
    /// Go on with a file that the same sweep has begun.
    #[arg(long, requires = "output", conflicts_with = "force")]
    pub(crate) resume: bool,
    /// Start anew, also where the file exists.
    #[arg(long)]
    pub(crate) force: bool,
    /// On how many threads to run; as many as there are cores unless given.
    #[arg(long, visible_alias = "jobs", value_name = "COUNT", value_parser = number(1_u16..=1024), allow_hyphen_values = true)]
    pub(crate) threads: Option<u16>,
    /// When to stop each run, such as `4s`; otherwise when the scene says.
    #[arg(long, value_name = "TIME", value_parser = positive(Quantity::Time), allow_hyphen_values = true)]
    pub(crate) until: Option<f64>,
    /// After how many jumps to stop each run; 10000 unless given here or in the scene.
    #[arg(long, value_name = "COUNT", value_parser = number(JUMPS), allow_hyphen_values = true)]
    pub(crate) most_jumps: Option<u32>,
}
