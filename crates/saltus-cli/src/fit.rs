//! `saltus fit`: a table in, a report and a picture out.

use std::io::Read;
use std::path::Path;
use std::process::ExitCode;

use saltus_fit::{CorModel, Fit, Measure, Motion, ReadOptions, Report, Table, Verdict};
use saltus_plot::{Arc, Background, Chart, HeightTime, Mark, Measure as Scale, Measured, Residual, Stroke};

use crate::args::{self, ReportFormat};
use crate::error::Error;
use crate::output::{check_new, check_picture, say, write};
use crate::progress::Progress;

pub(crate) fn run(args: &args::Fit, quiet: bool) -> Result<ExitCode, Error> {
    check_picture(args.plot.as_deref())?;
    check_picture(args.plot_cor.as_deref())?;
    check_new(args.scene.as_deref(), args.force)?;
    let table = read(args)?;
    say(quiet, &format!("{}: {}", table.name(), table.notes().join("; ")));
    // What takes long is a bootstrap.
    let mut progress = Progress::new(args.bootstrap.unwrap_or(0).into(), quiet);
    let report = fit(args).run_with(&table, &mut |done| progress.reached(done as u64));
    progress.clear();
    let report = report.map_err(Error::new)?;
    let text = match args.format {
        ReportFormat::Text => format!("{}\n", report.to_string().trim_end()),
        ReportFormat::Json => format!("{}\n", serde_json::to_string_pretty(&report).map_err(Error::new)?),
    };
    if let Some(path) = &args.plot {
        match picture(&report) {
            Some(picture) => write(Some(path), picture.svg().map_err(Error::new)?.as_bytes())?,
            None => say(quiet, "no picture: the table has no motion to draw"),
        }
    }
    if let Some(path) = &args.plot_cor {
        match cor_picture(&report) {
            Some(picture) => write(Some(path), picture.svg().map_err(Error::new)?.as_bytes())?,
            None => say(quiet, "no picture of the COR: the table does not give it at several speeds"),
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
    if let Some(path) = args.plot.as_ref().filter(|path| path.exists() && *path != Path::new("-")) {
        say(quiet, &format!("picture: {}", path.display()));
    }
    let passed = !args.strict || report.verdict() == Verdict::Trusted;
    Ok(if passed { ExitCode::SUCCESS } else { ExitCode::from(1) })
}

fn read(args: &args::Fit) -> Result<Table, Error> {
    // The reader of old workbooks may panic over a damaged file, which becomes an error; its own message would only confuse.
    let usual = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |info| {
        if !info.location().is_some_and(|place| place.file().contains("calamine")) {
            usual(info);
        }
    }));
    let options = options(args);
    if args.tables == [Path::new("-")] {
        let mut bytes = Vec::new();
        std::io::stdin().lock().read_to_end(&mut bytes).map_err(Error::new)?;
        Table::parse("standard input", &bytes, &options).map_err(Error::new)
    } else if args.tables.iter().any(|table| table == Path::new("-")) {
        Err(Error::new("standard input, '-', cannot be read together with other tables"))
    } else {
        Table::read_all(&args.tables, &options).map_err(Error::new)
    }
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
    if let Some(fps) = args.fps {
        options = options.fps(fps);
    }
    if let Some(scale) = args.scale {
        options = options.scale(scale);
    }
    if let Some(zero) = args.zero {
        options = options.zero(zero);
    }
    if args.y_down || args.y_up {
        options = options.y_down(args.y_down);
    }
    for (column, value) in &args.filters {
        options = options.filter(column, value);
    }
    options
}

fn fit(args: &args::Fit) -> Fit {
    let mut fit = Fit::new().repair(!args.no_repair).losses(args.losses);
    if let Some(within) = args.tolerance_height {
        fit = fit.tolerance_height(within);
    }
    if let Some(within) = args.tolerance_time {
        fit = fit.tolerance_time(within);
    }
    if let Some(model) = CorModel::ALL.into_iter().find(|m| args.model.as_deref() == Some(m.name())) {
        fit = fit.model(model);
    }
    if let Some(ball) = args.ball {
        fit = fit.ball(ball);
    }
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
    fit
}

/// The measured points, the fitted motion, and what is left between them.
fn picture(report: &Report) -> Option<HeightTime> {
    let motion = report.motion()?;
    let points = report.points().iter().map(|point| {
        let mut measured = Measured::new(point.time, point.height).mark(mark(&point.label));
        if let Some(sigma) = point.sigma_time {
            measured = measured.time_error(sigma);
        }
        if let Some(sigma) = point.sigma_height {
            measured = measured.height_error(sigma);
        }
        measured
    });
    let residuals = report.residuals().iter().map(|r| Residual::new(r.time, r.z).mark(mark(&r.label)));
    let mut picture = HeightTime::new(&report.title())
        .motion(&label(report, motion), arcs(motion))
        .measured(points)
        .contacts(motion.contacts.iter().copied())
        .residuals(residuals)
        .background(Background::Adaptive)
        .caption(&caption(report));
    if let Some(agreement) = disagreement(report) {
        picture = picture.caption(&agreement);
    }
    Some(picture)
}

/// The COR against the speed of impact: that of each bounce, one COR, and the best law of speed with its 95 % band.
fn cor_picture(report: &Report) -> Option<Chart> {
    let bounces: Vec<(f64, saltus_fit::Measured)> =
        report.bounces().iter().filter_map(|b| Some((speed(report, b.bounce)?, b.heights.or(b.times)?))).collect();
    let law = report.models().iter().find(|m| !m.speeds.is_empty());
    let mut speeds: Vec<f64> = bounces.iter().map(|b| b.0).collect();
    speeds.extend(law.iter().flat_map(|m| &m.speeds).map(|s| s.speed));
    let (slowest, fastest) = (speeds.iter().copied().reduce(f64::min)?, speeds.iter().copied().reduce(f64::max)?);
    if fastest <= slowest {
        return None;
    }
    let mut picture = Chart::new(&report.title(), ("Speed of impact", Scale::Speed), ("COR", Scale::Count))
        .marks(bounces.iter().map(|(v, e)| [*v, e.value]))
        .jumps(bounces.iter().map(|(v, e)| [-1.0, 1.0].map(|side| [*v, e.value + side * e.standard_error])))
        .background(Background::Adaptive)
        .caption("Marks: each bounce by itself, ± one standard error");
    if let Some(law) = law {
        let bent = |points: Vec<[f64; 2]>| {
            points
                .windows(2)
                .map(|w| Stroke::new(1.0, vec![w[0][0], w[1][0] - w[0][0]], vec![w[0][1], w[1][1] - w[0][1]]))
                .collect::<Vec<_>>()
        };
        let at =
            |side: f64| bent(law.speeds.iter().map(|s| [s.speed, s.cor + side * 1.96 * s.standard_error]).collect());
        picture = picture.line(&law.about, at(0.0)).line("95 % band", at(-1.0).into_iter().chain(at(1.0)));
    }
    if let Some(one) =
        report.models().iter().find(|m| m.name == "constant").map(|m| m.cor.value).or(report.cor().map(|c| c.value))
    {
        picture = picture.line("one COR", [Stroke::new(1.0, vec![slowest, fastest - slowest], vec![one])]);
    }
    Some(picture.caption(&caption(report)))
}

/// The speed at a contact as it was read: from the height before it, else from the flight before it, the mean over trials.
fn speed(report: &Report, bounce: usize) -> Option<f64> {
    let g = report.gravity().value;
    let apex = if bounce == 1 { "release".to_owned() } else { format!("apex {}", bounce - 1) };
    let contact = |n: usize| format!("contact {n}");
    let points = report.points();
    let heights = points.iter().filter(|p| p.label == apex).map(|p| (2.0 * g * p.height.max(0.0)).sqrt());
    let mut speeds: Vec<f64> = heights.collect();
    if speeds.is_empty() {
        let ends = points.iter().filter(|p| p.label == contact(bounce));
        let flight = |end: &saltus_fit::Point| {
            let before = |p: &&saltus_fit::Point| p.trial == end.trial && p.label == contact(bounce - 1);
            points.iter().find(before).map(|start| 0.5 * g * (end.time - start.time))
        };
        speeds.extend(ends.filter_map(flight));
    }
    #[allow(clippy::cast_precision_loss)]
    let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
    mean.is_finite().then_some(mean)
}

fn label(report: &Report, motion: &Motion) -> String {
    let trials = report.points().iter().map(|point| point.trial + 1).max().unwrap_or(1);
    let whose = if trials > 1 { format!("first of {trials} trials: ") } else { String::new() };
    format!("{whose}free flight with one COR of {:.3}", motion.cor)
}

fn arcs(motion: &Motion) -> impl Iterator<Item = Arc> {
    motion.flights.iter().map(|flight| Arc::new(flight.start, flight.span, flight.height.to_vec()))
}

fn mark(label: &str) -> Mark {
    match label.split(' ').next() {
        Some("release") => Mark::Release,
        Some("contact") => Mark::Contact,
        Some("apex") => Mark::Apex,
        _ => Mark::Sample,
    }
}

fn caption(report: &Report) -> String {
    match report.cor() {
        None => format!("No COR: {}", report.reason()),
        Some(cor) => match (report.verdict(), cor.standard_error) {
            (Verdict::Trusted, Some(error)) => format!("COR {:.4} ± {error:.4}", cor.value),
            (verdict, _) => format!("COR between {:.2} and {:.2}, {verdict}: {}", cor.low, cor.high, report.reason()),
        },
    }
}

/// How badly one motion holds both heights and times, if it does.
fn disagreement(report: &Report) -> Option<String> {
    let both = report.residuals().iter().any(|r| r.kind == Measure::Height)
        && report.residuals().iter().any(|r| r.kind == Measure::Time);
    let agreement = report.agreement().filter(|_| both && report.verdict() != Verdict::Trusted)?;
    Some(format!(
        "One COR for heights and times together: χ² = {:.0} on {} degrees of freedom",
        agreement.chi_square, agreement.degrees_of_freedom
    ))
}
