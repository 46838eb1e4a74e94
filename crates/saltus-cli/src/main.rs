//! The command `saltus`: fit a coefficient of restitution to a table, simulate a bounce, draw it.
//!
//! A file for each command, with what can be asked of it; below them those that several need:
//! `staging` and `varying` (options), `scenes` (reading and running), `parse` (values of options),
//! `output`, `progress`, `row`, `error`. No file names one above it.

mod accuracy;
mod check;
mod cost;
mod error;
mod explain;
mod export;
mod fit;
mod library;
mod output;
mod parse;
mod progress;
mod row;
mod scenes;
mod simulate;
mod solve;
mod staging;
mod sweep;
mod varying;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{CommandFactory, Parser, Subcommand};

use error::Error;

/// Bouncing balls: from a table to a coefficient of restitution, from a coefficient to a motion.
///
/// Data goes to standard output, talk to standard error. Exit status: 0 done; 1 with --strict, when
/// a verdict is doubtful or refused; 2 bad input or failure.
#[derive(Debug, Parser)]
#[command(name = "saltus", version, propagate_version = true, arg_required_else_help = true)]
struct Args {
    /// Say nothing on standard error but errors.
    #[arg(long, short, global = true, display_order = 900)]
    quiet: bool,
    #[command(subcommand)]
    command: Command,
}

/// The options of a command are put together only when it is asked for, with what it says of
/// itself: the list of commands has a line of its own for each.
#[derive(Debug, Subcommand)]
#[command(defer = true)]
enum Command {
    /// Estimate the coefficient of restitution (COR) from a table or a sound of bounces.
    Fit(Box<fit::FitArgs>),
    /// Simulate a scene, or a ball that bounces on a level floor.
    Simulate(simulate::Simulate),
    /// Say how a scene would be run, and why.
    Explain(explain::Explain),
    /// Show what accuracy costs in a scene.
    Accuracy(accuracy::Accuracy),
    /// Write the motion of a scene for animators: keys, scripts, models, moving pictures.
    Export(export::Export),
    /// Write many motions like one for animators: a file for each, and an index of them.
    Library(library::Library),
    /// Read a file that `saltus export` wrote, and say how far its heights are from the scene's
    /// motion.
    Check(check::Check),
    /// Find the scene that does what is wished for, and write it.
    Solve(solve::Solve),
    /// Run a scene many times with other values, and write a table with a row for each run.
    Sweep(sweep::SweepArgs),
    /// Write a shell's completions to standard output.
    ///
    /// For bash: saltus completions bash > ~/.local/share/bash-completion/completions/saltus
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Write the manual page to standard output, as roff.
    Man,
    /// Write the JSON Schema of scene files to standard output.
    ///
    /// Editors complete and check scenes by it: saltus schema > scene.schema.json, and
    /// `#:schema scene.schema.json` as the first line of the scene.
    Schema,
}

fn main() -> ExitCode {
    let args = Args::parse_from(asked());
    let json = matches!(&args.command, Command::Fit(fit) if fit.format == parse::ReportFormat::Json);
    run(&args).unwrap_or_else(|error| error.report(json))
}

/// The arguments; `saltus help --help`, which looks for a command of that name, is `saltus help`.
fn asked() -> Vec<OsString> {
    let mut asked: Vec<OsString> = std::env::args_os().collect();
    if asked.get(1).is_some_and(|first| first == "help") {
        asked.retain(|argument| argument != "--help" && argument != "-h");
    }
    asked
}

fn run(args: &Args) -> Result<ExitCode, Error> {
    match &args.command {
        Command::Fit(fit) => fit::run(fit, args.quiet),
        Command::Simulate(simulate) => simulate::run(simulate, args.quiet),
        Command::Explain(explain) => explain::run(explain),
        Command::Accuracy(accuracy) => accuracy::run(accuracy, args.quiet),
        Command::Export(export) => export::run(export, args.quiet),
        Command::Library(library) => library::run(library, args.quiet),
        Command::Check(check) => check::run(check, args.quiet),
        Command::Solve(solve) => solve::run(solve, args.quiet),
        Command::Sweep(sweep) => sweep::run(sweep, args.quiet),
        Command::Completions { shell } => output::stdout(&completions(*shell)),
        Command::Schema => output::stdout(saltus_scene::schema().as_bytes()),
        Command::Man => output::stdout(&man()?),
    }
}

/// The completions of a shell.
fn completions(shell: clap_complete::Shell) -> Vec<u8> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Args::command(), "saltus", &mut script);
    script
}

/// The manual page, the commands' own pages after the first.
fn man() -> Result<Vec<u8>, Error> {
    let mut page = Vec::new();
    let mut command = Args::command();
    command.build();
    let render = |command: clap::Command, page: &mut Vec<u8>| clap_mangen::Man::new(command).render(page);
    render(command.clone(), &mut page).map_err(Error::stdout)?;
    for sub in command.get_subcommands().filter(|sub| !sub.is_hide_set() && sub.get_name() != "help") {
        render(sub.clone(), &mut page).map_err(Error::stdout)?;
    }
    Ok(page)
}
