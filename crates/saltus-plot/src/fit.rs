//! Pictures of a fit: the motion with its residuals, the COR over speed, the apex ladder, the
//! profile of the cost. Needs the feature `fit`.
//!
//! Each is `None` where the report has nothing that it would show.
//!
//! ```
//! use saltus_fit::{Fit, ReadOptions, Table};
//! let text = b"bounce,height_cm\n0,100\n1,36\n2,13\n3,4.7\n";
//! let report = Fit::new().run(&Table::parse("drop.csv", text, &ReadOptions::default())?)?;
//! let picture = saltus_plot::fit::motion(&report).ok_or("nothing to draw")??;
//! assert!(picture.starts_with("<svg"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

use saltus_fit::{Measure, Method, Motion, Report, Sound, Verdict, Wave};

use crate::{Background, Chart, HeightTime, HeightUnit, Mark, Measure as Scale, Measured, PlotError, Residual, Stroke};

/// The measured points, the fitted motion, and what is left between them.
///
/// # Errors
/// [`PlotError`] where the picture cannot be drawn.
#[must_use]
pub fn motion(report: &Report) -> Option<Result<String, PlotError>> {
    heard(report, &[])
}

/// The picture of [`motion`] below the sound that the times were read off, if there is one alone.
///
/// # Errors
/// [`PlotError`] where the picture cannot be drawn.
#[must_use]
pub fn heard(report: &Report, sounds: &[Sound]) -> Option<Result<String, PlotError>> {
    if !report.groups().is_empty() {
        return compared(report);
    }
    let mut picture = heights(report)?;
    if let [sound] = sounds {
        let Wave { start, step, stretches, .. } = sound.wave();
        picture = picture.wave(*start, *step, stretches.iter().copied());
    }
    Some(picture.svg())
}

/// The measured points, the fitted motion and the residuals.
fn heights(report: &Report) -> Option<HeightTime> {
    let motion = report.motion()?;
    let points = report.points().iter().map(|point| {
        let mut measured = Measured::new(point.time, point.height).mark(mark(point.mark));
        if let Some(sigma) = point.sigma_time {
            measured = measured.time_error(sigma);
        }
        if let Some(sigma) = point.sigma_height {
            measured = measured.height_error(sigma);
        }
        measured
    });
    // All first contacts coincide, as those of the readings do.
    let first = motion.contacts.first().copied().unwrap_or(0.0);
    let shifted = |m: &Motion| (first - m.contacts.first().copied().unwrap_or(first), m.clone());
    let all: Vec<(f64, Motion)> = if report.series().is_empty() {
        report.motions().iter().map(shifted).collect()
    } else {
        vec![(0.0, motion.clone())]
    };
    let residuals = report.residuals().iter().map(|r| Residual::new(r.time, r.z).mark(mark(r.mark)));
    let mut picture = HeightTime::new(&report.title())
        .motion(&label(report, motion), all.iter().flat_map(|(shift, motion)| flights(motion, *shift)))
        .measured(points)
        .contacts(all.iter().flat_map(|(shift, motion)| motion.contacts.iter().map(move |t| t + shift)))
        .residuals(residuals)
        .background(Background::Adaptive)
        .caption(&caption(report));
    if report.in_pixels() {
        picture = picture.height_unit(HeightUnit::Pixels);
    }
    if let Some(agreement) = disagreement(report) {
        picture = picture.caption(&agreement);
    }
    Some(picture)
}

/// The COR against the speed of impact: that of each bounce, one COR, and the best law of speed
/// with its 95 % band.
///
/// # Errors
/// [`PlotError`] where the picture cannot be drawn.
#[must_use]
pub fn cor(report: &Report) -> Option<Result<String, PlotError>> {
    if !report.series().is_empty() {
        return impacts(report);
    }
    let bounces: Vec<(f64, saltus_fit::Measured)> =
        report.bounces().iter().filter_map(|b| Some((speed(report, b.bounce)?, b.heights.or(b.times)?))).collect();
    let law = report.models().iter().find(|m| !m.speeds.is_empty());
    let mut speeds: Vec<f64> = bounces.iter().map(|b| b.0).collect();
    speeds.extend(law.iter().flat_map(|m| &m.speeds).map(|s| s.speed));
    let (slowest, fastest) = (speeds.iter().copied().reduce(f64::min)?, speeds.iter().copied().reduce(f64::max)?);
    if fastest <= slowest {
        return None;
    }
    let mut picture = Chart::new(&report.title(), ("Speed of impact", Scale::Speed), ("COR", Scale::Number))
        .marks(bounces.iter().map(|(v, e)| [*v, e.value]))
        .jumps(bounces.iter().map(|(v, e)| [-1.0, 1.0].map(|side| [*v, e.value + side * e.standard_error])))
        .background(Background::Adaptive)
        .caption(if report.bounces().iter().any(|b| b.heights.is_some()) {
            "Marks: each bounce by itself, from heights where it has them, ± one standard error"
        } else {
            "Marks: each bounce by itself, from times, ± one standard error"
        });
    if let Some(law) = law {
        let at = |side: f64| {
            let shifted = law.speeds.iter().map(|s| [s.speed, s.cor + side * 1.96 * s.standard_error]);
            Stroke::polygon(&shifted.collect::<Vec<_>>())
        };
        picture = picture.line(&law.about, at(0.0)).line("95 % band", at(-1.0).into_iter().chain(at(1.0)));
    }
    // Where heights contradict times there is none.
    let settled = report.verdict() == Verdict::Trusted || !report.models().is_empty();
    if let Some(one) = report.cor().map(|cor| cor.value).filter(|_| settled) {
        picture = picture.line(&format!("one COR of {one:.3}"), Stroke::polygon(&[[slowest, one], [fastest, one]]));
    }
    Some(picture.caption(&caption(report)).svg())
}

/// The COR of every impact of the recordings against its speed, and one COR where one does.
fn impacts(report: &Report) -> Option<Result<String, PlotError>> {
    let metres = report.series().iter().all(|track| track.in_metres(report.gravity().value));
    let impacts = || report.series().iter().flat_map(|track| &track.impacts);
    let speeds = || impacts().map(|impact| impact.speed);
    let (slowest, fastest) = (speeds().reduce(f64::min)?, speeds().reduce(f64::max)?);
    if fastest <= slowest {
        return None;
    }
    let speed = match (metres, report.in_pixels()) {
        (true, _) => ("Speed of impact", Scale::Speed),
        (false, true) => ("Speed of impact (px/s)", Scale::Number),
        (false, false) => ("Speed of impact, in the unit of heights per second", Scale::Number),
    };
    let bar =
        |side: f64, impact: &saltus_fit::Impact| [impact.speed, impact.cor.value + side * impact.cor.standard_error];
    let mut picture = Chart::new(&report.title(), speed, ("COR", Scale::Number))
        .marks(impacts().map(|impact| bar(0.0, impact)))
        .jumps(impacts().map(|impact| [-1.0, 1.0].map(|side| bar(side, impact))))
        .background(Background::Adaptive)
        .caption("Marks: each impact by itself, \u{b1} one standard error");
    if let Some(one) = report.cor().map(|cor| cor.value).filter(|_| report.verdict() == Verdict::Trusted) {
        picture = picture.line(&format!("one COR of {one:.3}"), Stroke::polygon(&[[slowest, one], [fastest, one]]));
    }
    Some(picture.caption(&caption(report)).svg())
}

/// The height of release and of each apex of a fitted motion, by the number of the bounce.
fn rungs(motion: &Motion) -> Vec<[f64; 2]> {
    let release = motion.release_height.map(|height| [0.0, height]);
    let apexes = (1_u32..).map(f64::from).zip(&motion.apexes).map(|(n, height)| [n, *height]);
    release.into_iter().chain(apexes).collect()
}

/// The COR of each group with its 95 % interval, side by side.
fn compared(report: &Report) -> Option<Result<String, PlotError>> {
    let groups: Vec<(f64, &saltus_fit::Group, saltus_fit::Cor)> = (1_u32..)
        .map(f64::from)
        .zip(report.groups())
        .filter_map(|(n, group)| Some((n, group, *group.report.cor()?)))
        .collect();
    let interval = |(n, _, cor): &(f64, _, saltus_fit::Cor)| Stroke::polygon(&[[*n, cor.low], [*n, cor.high]]);
    if groups.len() < 2 {
        return None;
    }
    let mut chart = Chart::new(&report.title(), ("Group", Scale::Count), ("COR", Scale::Number))
        .line("", groups.iter().flat_map(interval))
        .marks(groups.iter().map(|(n, _, cor)| [*n, cor.value]))
        .background(Background::Adaptive)
        .caption("Marks: the COR of each group, with its 95 % interval");
    for (n, group, cor) in &groups {
        chart = chart.callout(&group.name, [*n, cor.value]);
    }
    Some(chart.svg())
}

/// Apex heights bounce by bounce, on an axis where one COR is a straight line: those of every
/// trial, and of the fitted motion.
///
/// # Errors
/// [`PlotError`] where the picture cannot be drawn.
#[must_use]
pub fn ladder(report: &Report) -> Option<Result<String, PlotError>> {
    let motion = report.motion()?;
    let apexes = [saltus_fit::Mark::Release, saltus_fit::Mark::Apex];
    let read = report.points().iter().filter(|point| point.height > 0.0 && apexes.contains(&point.mark));
    let read: Vec<_> = read.map(|point| (count(point.number), point)).collect();
    let fitted = rungs(motion);
    if fitted.len() < 2 {
        return None;
    }
    let bars = read.iter().filter_map(|(n, point)| {
        let sigma = point.sigma_height.filter(|sigma| *sigma < point.height)?;
        Some([[*n, point.height - sigma], [*n, point.height + sigma]])
    });
    // A release says nothing of the bounces after it.
    let released = read.iter().all(|(n, _)| *n == 0.0);
    let intervals = if released { intervals(report) } else { Vec::new() };
    let marked = match (read.is_empty(), intervals.is_empty()) {
        (false, true) => "Marks: heights as they were read, ± one standard error",
        (false, false) => "Marks: the height of release, and g Δ²/8 of the intervals Δ between contacts",
        (true, false) => "Marks: g Δ²/8 of the intervals Δ between contacts",
        (true, true) => "",
    };
    let apex = if report.in_pixels() { ("Apex (px)", Scale::Number) } else { ("Apex", Scale::Length) };
    let chart = Chart::new(&report.title(), ("Bounce", Scale::Count), apex)
        .logarithmic()
        .line(&course(report, motion), Stroke::polygon(&fitted))
        .marks(read.iter().map(|(n, point)| [*n, point.height]).chain(intervals))
        .jumps(bars)
        .background(Background::Adaptive)
        .caption(marked)
        .caption(&caption(report));
    let others = report.motions().iter().skip(1).filter(|_| report.series().is_empty());
    let chart = if others.clone().next().is_some() { chart.caption("A line for each trial") } else { chart };
    let chart = others.fold(chart, |chart, motion| chart.line("", Stroke::polygon(&rungs(motion))));
    Some(chart.svg())
}

#[allow(clippy::cast_precision_loss)] // a number of bounces
fn count(number: usize) -> f64 {
    number as f64
}

/// The number of each flight between two contacts that were read, and the height that its duration
/// means without air.
fn intervals(report: &Report) -> Vec<[f64; 2]> {
    let contact = |point: &saltus_fit::Point| (point.mark == saltus_fit::Mark::Contact).then(|| count(point.number));
    let pairs = report.points().windows(2).filter(|w| w[0].trial == w[1].trial);
    let next = pairs.filter_map(|w| {
        let (n, m) = (contact(&w[0])?, contact(&w[1])?);
        (m == n + 1.0).then(|| [n, report.gravity().value * (w[1].time - w[0].time).powi(2) / 8.0])
    });
    next.collect()
}

/// A cost above its least by this is outside the 95 % interval: the chi-square distribution of one
/// degree of freedom.
const LIMIT: f64 = 3.84;
/// Costs are drawn up to this above the least.
const DRAWN: f64 = 30.0;

/// The cost of each method as the COR is held at other values.
///
/// # Errors
/// [`PlotError`] where the picture cannot be drawn.
#[must_use]
pub fn profile(report: &Report) -> Option<Result<String, PlotError>> {
    let mut chart = Chart::new(&report.title(), ("COR", Scale::Number), ("Chi-square above its least", Scale::Number));
    let mut reach = [f64::INFINITY, f64::NEG_INFINITY];
    for profile in report.profiles() {
        let least = profile.points.iter().map(|point| point.chi_square).fold(f64::INFINITY, f64::min);
        let above = profile.points.iter().map(|point| [point.cor, point.chi_square - least]);
        let shown: Vec<[f64; 2]> = above.filter(|[_, cost]| *cost <= DRAWN).collect();
        let name = match profile.method {
            Method::Joint => "heights and times together",
            method => method.name(),
        };
        reach = shown.iter().fold(reach, |[low, high], [cor, _]| [low.min(*cor), high.max(*cor)]);
        chart = chart.line(name, Stroke::polygon(&shown));
    }
    if reach[0] >= reach[1] {
        return None;
    }
    let chart = chart
        .jumps([[[reach[0], LIMIT], [reach[1], LIMIT]]])
        .background(Background::Adaptive)
        .caption("Below the dashed line: the 95 % interval of each method, by the reading errors alone")
        .caption(&caption(report));
    Some(chart.svg())
}

/// The speed at a contact as it was read: from the height before it, else from the flight before
/// it, the mean over trials.
fn speed(report: &Report, bounce: usize) -> Option<f64> {
    let g = report.gravity().value;
    let apex = (if bounce == 1 { saltus_fit::Mark::Release } else { saltus_fit::Mark::Apex }, bounce - 1);
    let contact = |n: usize| (saltus_fit::Mark::Contact, n);
    let which = |p: &saltus_fit::Point| (p.mark, p.number);
    let points = report.points();
    let heights = points.iter().filter(|p| which(p) == apex).map(|p| (2.0 * g * p.height.max(0.0)).sqrt());
    let mut speeds: Vec<f64> = heights.collect();
    if speeds.is_empty() {
        let ends = points.iter().filter(|p| which(p) == contact(bounce));
        let flight = |end: &saltus_fit::Point| {
            let before = |p: &&saltus_fit::Point| p.trial == end.trial && which(p) == contact(bounce - 1);
            points.iter().find(before).map(|start| 0.5 * g * (end.time - start.time))
        };
        speeds.extend(ends.filter_map(flight));
    }
    #[allow(clippy::cast_precision_loss)]
    let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
    mean.is_finite().then_some(mean)
}

fn label(report: &Report, motion: &Motion) -> String {
    let read = report.points().iter().map(|point| point.trial + 1).max().unwrap_or(1);
    let films = report.series().len();
    let whose = match (films, read) {
        (2.., _) => format!("first of {films} trials: "),
        (0, 2..) => format!("{read} trials: "),
        _ => String::new(),
    };
    let free = if report.series().is_empty() { "free flight with " } else { "" };
    format!("{whose}{free}{}", course(report, motion))
}

/// The assumption of the fitted motion: one COR, or that of a series.
fn course(report: &Report, motion: &Motion) -> String {
    if report.series().is_empty() { format!("one COR of {:.3}", motion.cor) } else { "the fitted motion".to_owned() }
}

fn flights(motion: &Motion, shift: f64) -> impl Iterator<Item = Stroke> {
    motion
        .flights
        .iter()
        .map(move |flight| Stroke::over_time(flight.start + shift, flight.span, flight.height.to_vec()))
}

fn mark(of: saltus_fit::Mark) -> Mark {
    match of {
        saltus_fit::Mark::Release => Mark::Release,
        saltus_fit::Mark::Contact => Mark::Contact,
        saltus_fit::Mark::Apex => Mark::Apex,
        _ => Mark::Sample,
    }
}

fn caption(report: &Report) -> String {
    match report.cor() {
        None => format!("No COR: {}", report.reason()),
        Some(cor) => match (report.verdict(), cor.standard_error) {
            (Verdict::Trusted, Some(_)) => format!("COR {cor}"),
            (verdict, _) => format!("COR between {:.2} and {:.2}, {verdict}: {}", cor.low, cor.high, report.reason()),
        },
    }
}

/// The disagreement of heights and times about one motion, if there is one.
fn disagreement(report: &Report) -> Option<String> {
    let both = report.residuals().iter().any(|r| r.kind == Measure::Height)
        && report.residuals().iter().any(|r| r.kind == Measure::Time);
    let agreement = report.agreement().filter(|_| both && report.verdict() != Verdict::Trusted)?;
    Some(format!(
        "One COR for heights and times together: χ² = {:.0} on {} degrees of freedom",
        agreement.chi_square, agreement.degrees_of_freedom
    ))
}
