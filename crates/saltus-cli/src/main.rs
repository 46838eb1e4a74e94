//! The command `saltus`: fit a coefficient of restitution to a table, simulate a bounce, draw it.

mod accuracy;
mod args;
mod check;
mod cost;
mod error;
mod explain;
mod export;
mod fit;
mod ground;
mod library;
mod motion;
mod output;
mod picture;
mod progress;
mod quantity;
mod row;
mod simulate;
mod solve;
mod stage;
mod staging;
mod sweep;
mod vary;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;

fn main() -> ExitCode {
    let args = args::Args::parse_from(asked());
    let json = matches!(&args.command, args::Command::Fit(fit) if fit.format == args::ReportFormat::Json);
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

fn run(args: &args::Args) -> Result<ExitCode, error::Error> {
    match &args.command {
        args::Command::Fit(fit) => fit::run(fit, args.quiet),
        args::Command::Simulate(simulate) => simulate::run(simulate, args.quiet),
        args::Command::Explain(explain) => explain::run(explain),
        args::Command::Accuracy(accuracy) => accuracy::run(accuracy, args.quiet),
        args::Command::Export(export) => export::run(export, args.quiet),
        args::Command::Library(library) => library::run(library, args.quiet),
        args::Command::Check(check) => check::run(check, args.quiet),
        args::Command::Solve(solve) => solve::run(solve, args.quiet),
        args::Command::Sweep(sweep) => sweep::run(sweep, args.quiet),
        args::Command::Completions { shell } => output::stdout(&args::completions(*shell)),
        args::Command::Schema => output::stdout(saltus_scene::schema().as_bytes()),
        args::Command::Man => output::stdout(&args::man()?),
    }
}
