//! `saltus fit`: a table in, a report and pictures out.

mod args;
mod each;
mod values;

use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Once;

use saltus_fit::{CorModel, Expected, Fit, Loss, ReadOptions, Report, Table, Verdict};
use saltus_plot::{PlotError, fit as pictures};

use crate::error::Error;
use crate::output::{check_apart, check_new, check_picture, say, write};
use crate::parse::ReportFormat;
use crate::progress::Progress;

pub(crate) use args::Fit as FitArgs;

/// A picture of a report, where it has one.
type Draw<'a> = &'a dyn Fn(&Report) -> Option<Result<String, PlotError>>;

pub(crate) fn run(args: &args::Fit, quiet: bool) -> Result<ExitCode, Error> {
    for picture in [&args.plot, &args.plot_cor, &args.plot_ladder, &args.plot_profile] {
        check_picture(picture.as_deref())?;
    }
    for (to, from) in
        [&args.output, &args.scene].into_iter().flat_map(|to| args.tables.iter().map(move |from| (to, from)))
    {
        check_apart(to.as_deref(), from)?;
    }
    check_new(args.scene.as_deref(), args.force)?;
    one_to_standard_output(args)?;
    if let Some(want) = args.want.filter(|_| args.tables.is_empty() && args.values.is_none()) {
        return plan(args, want);
    }
    if args.each {
        silence_workbooks();
        return each::run(args, &options(args), &fit(args), quiet);
    }
    let table = read(args)?;
    let notes: Vec<String> = table.notes().iter().map(ToString::to_string).collect();
    say(quiet, &format!("{}: {}", table.name(), notes.join("; ")));
    // What takes long is a bootstrap.
    let mut progress = Progress::new(args.bootstrap.unwrap_or(0).into(), quiet);
    let report = fit(args).run_with(&table, &mut |done| {
        progress.reached(done as u64);
        ControlFlow::Continue(())
    });
    progress.clear();
    let report = report.and_then(|report| fit(args).advised(&table, report, args.want)).map_err(Error::data)?;
    let text = match args.format {
        ReportFormat::Text => format!("{}\n", report.to_string().trim_end()),
        ReportFormat::Json => format!("{}\n", serde_json::to_string_pretty(&report).map_err(Error::new)?),
    };
    let motion = |report: &Report| pictures::heard(report, table.sounds());
    let pictures: [(_, Draw<'_>, _); 4] = [
        (&args.plot, &motion, "no picture: the table has no motion to draw"),
        (
            &args.plot_cor,
            &pictures::cor,
            "no picture of the COR: the table does not give it at several speeds, which takes two bounces; --plot draws one",
        ),
        (&args.plot_ladder, &pictures::ladder, "no ladder: the table gives no two heights of apexes"),
        (&args.plot_profile, &pictures::profile, "no profile: no COR was fitted to heights or times of bounces"),
    ];
    for (path, draw, none) in pictures {
        let Some(path) = path else { continue };
        match draw(&report).transpose().map_err(Error::new)? {
            Some(picture) => {
                write(Some(path), picture.as_bytes())?;
                if path != Path::new("-") {
                    say(quiet, &format!("picture: {}", path.display()));
                }
            }
            None => say(quiet, none),
        }
    }
    write(args.output.as_deref(), text.as_bytes())?;
    if let Some(path) = &args.scene {
        let scene = report.scene().ok_or_else(|| Error::new(format!("no scene was written: {}", report.reason())))?;
        write(Some(path), scene.as_bytes())?;
        if path != Path::new("-") {
            let (scene, moving) = (path.display(), path.with_extension("svg"));
            say(quiet, &format!("scene: {scene}; to see it move: saltus export {scene} -o {}", moving.display()));
        }
    }
    let passed = !args.strict || report.verdict() == Verdict::Trusted;
    Ok(if passed { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

/// What a measurement takes, before the first drop.
fn plan(args: &args::Fit, want: f64) -> Result<ExitCode, Error> {
    let expected = Expected::new(args.expect, args.drop.unwrap_or(1.0))
        .ok_or_else(|| Error::new("a drop to plan for is between 1 cm and 100 m: give it by --drop, such as 1m"))?;
    let plan = fit(args).plan(want, expected).map_err(Error::data)?;
    let text = match args.format {
        ReportFormat::Text => plan.to_string(),
        ReportFormat::Json => format!("{}\n", serde_json::to_string_pretty(&plan).map_err(Error::new)?),
    };
    write(args.output.as_deref(), text.as_bytes())?;
    Ok(ExitCode::SUCCESS)
}

/// Refuses a report and a picture, or two pictures, in one stream, where neither could be used.
fn one_to_standard_output(args: &args::Fit) -> Result<(), Error> {
    let files = [&args.plot, &args.plot_cor, &args.plot_ladder, &args.plot_profile, &args.scene];
    let pictures = files.into_iter().flatten().filter(|path| *path == Path::new("-")).count();
    let report = args.output.as_ref().is_none_or(|path| path == Path::new("-"));
    if pictures + usize::from(report) < 2 {
        return Ok(());
    }
    Err(Error::new(
        "only one of them can go to standard output: name a file for the report by -o, or one for the picture or scene instead of '-'",
    ))
}

fn read(args: &args::Fit) -> Result<Table, Error> {
    let options = options(args);
    silence_workbooks();
    if let Some(line) = &args.values {
        let text = values::table(line).map_err(Error::new)?;
        Table::parse("values", text.as_bytes(), &options).map_err(Error::data)
    } else if args.tables == [Path::new("-")] {
        let mut bytes = Vec::new();
        std::io::stdin().lock().read_to_end(&mut bytes).map_err(Error::new)?;
        Table::parse("standard input", &bytes, &options).map_err(Error::data)
    } else if args.tables.iter().any(|table| table == Path::new("-")) {
        Err(Error::new("standard input, '-', cannot be read together with other tables"))
    } else {
        tables(&args.tables, &options)
    }
}

/// The trials of files, together.
pub(crate) fn tables(paths: &[PathBuf], options: &ReadOptions) -> Result<Table, Error> {
    silence_workbooks();
    Table::read_all(paths, options).map_err(Error::data)
}

/// The reader of old workbooks may panic over a damaged file, which becomes an error; its own
/// message would only confuse.
fn silence_workbooks() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        let usual = std::panic::take_hook();
        std::panic::set_hook(Box::new(move |info| {
            if !info.location().is_some_and(|place| place.file().contains("calamine")) {
                usual(info);
            }
        }));
    });
}

fn options(args: &args::Fit) -> ReadOptions {
    let mut options = ReadOptions::default();
    if let Some(unit) = &args.height_unit {
        options = options.height_unit(unit);
    }
    if let Some(unit) = &args.time_unit {
        options = options.time_unit(unit);
    }
    if let Some(column) = &args.column {
        options = options.column(column);
    }
    if let Some(sheet) = &args.sheet {
        options = options.sheet(sheet);
    }
    if let Some(header) = &args.header {
        options = options.header(&header.iter().map(String::as_str).collect::<Vec<_>>());
    }
    if let Some(part) = &args.listen {
        options = options.listen(part.clone());
    }
    if let Some(fps) = args.fps {
        options = options.fps(fps);
    }
    if let Some(scale) = args.scale {
        options = options.scale(scale);
    }
    if let Some(drop) = args.drop {
        options = options.drop_height(drop);
    }
    if let Some(zero) = args.zero {
        options = options.zero(zero);
    }
    if args.y_down || args.y_up {
        options = options.y_down(args.y_down);
    }
    for column in &args.groups {
        options = options.group(column);
    }
    for (column, value) in &args.filters {
        options = options.filter(column, value);
    }
    options
}

fn fit(args: &args::Fit) -> Fit {
    let losses: Vec<Loss> =
        Loss::ALL.into_iter().filter(|loss| args.losses.iter().any(|wanted| wanted == loss.name())).collect();
    let mut fit = Fit::new().repair(!args.no_repair).losses(&losses).profiles(args.plot_profile.is_some());
    if let Some(within) = args.tolerance_height {
        fit = fit.tolerance_height(within);
    }
    if let Some(within) = args.tolerance_time {
        fit = fit.tolerance_time(within);
    }
    if let Some(model) = CorModel::ALL.into_iter().find(|m| args.model.as_deref() == Some(m.name())) {
        fit = fit.model(model);
    }
    fit = match args.ball {
        Some(args::Ball::Kind(kind)) => fit.kind(kind),
        Some(args::Ball::Diameter(metres)) => fit.ball(metres),
        None => fit,
    };
    if let Some(rounds) = args.bootstrap {
        fit = fit.bootstrap(rounds as usize, args.seed);
    }
    if let Some(sigma) = args.sigma_height {
        fit = fit.sigma_height(sigma);
    }
    if let Some(sigma) = args.sigma_time {
        fit = fit.sigma_time(sigma);
    }
    if let Some(gravity) = args.gravity {
        fit = fit.gravity(gravity);
    }
    if let Some(drag) = args.drag {
        fit = fit.drag(drag);
    }
    if let Some(sigma) = args.sigma_zero {
        fit = fit.sigma_zero(sigma);
    }
    if let Some(part) = args.sigma_scale {
        fit = fit.sigma_scale(part);
    }
    fit
}
