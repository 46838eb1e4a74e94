//! A squash ball on cement: the study that this project grows from, its formulas one after another,
//! and what its film can tell.
//!
//! `cargo run --example study` compares each with the recorded motion, draws
//! `docs/program/gallery/study-*.svg` and checks every number of `docs/trust/study.md`.

use std::error::Error;

use saltus::Simulation;
use saltus_bounce::{Ball, Cor, Drop, Mode};
use saltus_examples::gallery;
use saltus_examples::study::equations::{Total, early_by_radius, height_of, impact_speed, turns_at};
use saltus_examples::study::film::{Camera, read};
use saltus_examples::study::stages::{Curve, Start, mark, measured};
use saltus_examples::study::trials::{Plan, Trial, mean, of_mean_heights};
use saltus_examples::study::{CONTACTS, DROP, EARLY, GRAVITY, MODELLED, RADIUS, REBOUNDS, keys, report};
use saltus_fit::{Report, Verdict};
use saltus_motion::{Export, Format, Frames, Rate, Snap};
use saltus_plot::{Background, HeightTime, Mark, Measured, Residual, Stroke};

type Done = Result<(), Box<dyn Error>>;

const START: Start = Start { drop: DROP, gravity: GRAVITY, early: EARLY };
const CAMERA: Camera = Camera { rate: 30.0 };

fn main() -> Done {
    let report = report()?;
    tables(&report)?;
    stages(&report)?;
    a_hundredth_of_a_second();
    totals();
    reconciled(&report)?;
    film()?;
    ten_drops()?;
    keyframes()
}

/// Whether `found` is `expected` to half a unit of the last digit that is given.
fn check(found: f64, expected: f64, digit: f64) {
    assert!((found - expected).abs() <= 0.5 * digit + 1e-12, "{found} is not {expected} to {digit}");
}

/// What was recorded, and the CORs in it.
fn tables(report: &Report) -> Done {
    println!("The recorded motion\n  event       time     height");
    for point in report.points() {
        println!("  {:<10} {:5.2} s  {:4.0} cm", point.label, point.time, 100.0 * point.height);
    }
    let times: Vec<f64> = report.points().iter().filter(|p| p.label.starts_with("contact")).map(|p| p.time).collect();
    let heights: Vec<f64> = report.points().iter().filter(|p| p.label.starts_with("apex")).map(|p| p.height).collect();
    assert_eq!((&times[..], &heights[..]), (&CONTACTS[..], &REBOUNDS[..]), "the constants are those of the table");

    println!("\nThe COR\n  bounce      (8) from heights    from times");
    let mut cors = Vec::new();
    for bounce in report.bounces() {
        let (by_height, by_time) = (bounce.heights.ok_or("no heights")?, bounce.times.ok_or("no times")?);
        println!("  {}           {:.3}               {:.3}", bounce.bounce, by_height.value, by_time.value);
        cors.push([by_height.value, by_time.value]);
    }
    let agreement = report.agreement().ok_or("no agreement")?;
    for (flight, [_, _]) in agreement.flights.iter().skip(1).zip(&cors) {
        let k = flight.flight;
        let lasted = CONTACTS[k] - CONTACTS[k - 1];
        println!(
            "  flight {k}: {:.0} cm in {lasted:.2} s needs g = {:.1} m/s²; with 9.8 it is {:.1} cm high",
            100.0 * REBOUNDS[k - 1],
            flight.gravity,
            100.0 * height_of(lasted, GRAVITY),
        );
    }
    for (found, expected) in cors.concat().into_iter().zip([0.548, 0.443, 0.577, 0.650]) {
        check(found, expected, 1e-3);
    }
    check(agreement.flights[1].gravity, 15.0, 0.1);
    check(agreement.flights[2].gravity, 11.8, 0.1);
    check(height_of(0.40, GRAVITY), 0.196, 1e-3);
    check(height_of(0.26, GRAVITY), 0.083, 1e-3);
    assert_eq!(report.verdict(), Verdict::Doubtful);
    Ok(())
}

/// The four formulas, each with its picture.
fn stages(report: &Report) -> Done {
    let fall = START.fall();
    let one = START.free_fall(0.65);
    let two = START.half_bounces();
    let three = START.measured_rebound(REBOUNDS[0]);
    let by_heights = Cor::from_heights(DROP, REBOUNDS[0])?;
    let four = START.bounces(by_heights, 3);
    let equal = Cor::new(Total::ThirdContact.cor(CONTACTS[2], fall))?;

    println!("\nThe formulas: height in m at the time in s\n  stage     0.20     0.45     0.60     0.85     1.11");
    let times = [0.20, 0.45, 0.60, 0.85, 1.11];
    let curves = [&one, &two, &three, &four];
    for (stage, (curve, expected)) in (1..).zip(curves.into_iter().zip([33.0, 53.5, 15.9, 5.9])) {
        let row: String = times.iter().map(|&t| format!("{:9.3}", curve.at(t)[0])).collect();
        let rms = rms(&curve.residuals(report));
        println!("  {stage} {row}   rms of the residuals {rms:.1} σ");
        check(rms, expected, 0.1);
    }
    for (found, expected) in times.iter().zip([0.804, 0.008, -0.764, -2.54, -5.04]) {
        check(one.at(*found)[0], expected, if expected < -1.0 { 0.01 } else { 0.001 });
    }
    for (found, expected) in [0.60, 0.85, 1.11].iter().zip([0.578, 0.991, 0.770]) {
        check(two.at(*found)[0], expected, 0.001);
    }
    for (found, expected) in [0.60, 0.85, 1.11].iter().zip([-0.122, 0.291, 0.070]) {
        check(three.at(*found)[0], expected, 0.001);
    }
    let printed = START.measured_rebound(DROP / REBOUNDS[0]);
    check(printed.at(0.85)[0], 3.32, 0.01);

    let contacts = four.turns();
    println!(
        "  stage 4 with e = {:.3}: contacts at {:.3}, {:.3}, {:.3} s",
        by_heights, contacts[0], contacts[1], contacts[2]
    );
    check(contacts[1], 0.937, 0.001);
    check(contacts[2], 1.198, 0.001);
    check(START.bounces(equal, 3).turns()[2], CONTACTS[2] - 2.0 * EARLY, 1e-9);

    let caption = "h₀ − ½ g t². Right until 0.452 s; then on through the floor, −2.5 m at 0.85 s and −5.0 m at 1.11 s";
    save("study-fall", &one.picture("Stage 1: a fall, and no floor", "free fall", caption, report).contacts([fall]))?;
    let caption =
        format!("h₀ − ½ g (T − t)², T = 2 t₀ − 0.01 s = {:.3} s. The ball comes back to 1 m", START.next_apex());
    save("study-half-bounces", &picture(&two, "Stage 2: two half bounces", "nothing lost", &caption, report))?;
    let caption = "h₁ − ½ g (T − t)². The height of the apex is measured, its time still that of stage 2: too late";
    save("study-ratio", &picture(&three, "Stage 3: the height ratio", "rebound of 30 cm", caption, report))?;
    let caption = format!(
        "V = −e V at each contact. The height ratio gives e = {by_heights:.3}; a COR of {:.3} ends at 1.11 s and misses the heights. \
         Residuals are those of {by_heights:.3}",
        equal.value()
    );
    let exact = Start { early: 0.0, ..START }.bounces(equal, 2);
    let pictured = picture(&four, "Stage 4: a COR", &format!("e = {by_heights:.3}"), &caption, report);
    save("study-cor", &pictured.motion(&format!("e = {equal:.3}"), exact.arcs()))
}

fn picture(curve: &Curve, title: &str, label: &str, caption: &str, report: &Report) -> HeightTime {
    curve.picture(title, label, caption, report).contacts(curve.turns())
}

fn save(name: &str, picture: &HeightTime) -> Done {
    Ok(gallery(name, &picture.svg()?)?)
}

fn rms(z: &[f64]) -> f64 {
    (z.iter().map(|z| z * z).sum::<f64>() / z.len().max(1) as f64).sqrt()
}

/// What 0.01 s off each flight does: it lets the ball turn above the floor, by one radius after 1 m
/// and by less after less.
fn a_hundredth_of_a_second() {
    println!("\n0.01 s off each flight\n  height     turns above the floor    a radius of 2 cm takes off");
    let mut rows = Vec::new();
    for height in [DROP, REBOUNDS[0], REBOUNDS[1]] {
        let (above, right) = (turns_at(height, GRAVITY, EARLY), early_by_radius(height, RADIUS, GRAVITY));
        println!("  {:3.0} cm     {:.1} cm                   {:.1} ms", 100.0 * height, 100.0 * above, 1e3 * right);
        rows.extend([above, right]);
    }
    for (found, (expected, digit)) in rows.into_iter().zip([
        (0.022, 0.001),
        (0.0091, 0.0001),
        (0.012, 0.001),
        (0.0168, 0.0001),
        (0.007, 0.001),
        (0.0302, 0.0001),
    ]) {
        check(found, expected, digit);
    }
}

/// Which COR, and which reading of "total time", gives 1.10 s.
fn totals() {
    let fall = START.fall();
    println!("\nWhich COR gives a total time of\n  until              1.10 s     1.11 s     rebounds for 1.10 s");
    let mut found = Vec::new();
    for (total, name) in Total::ALL.into_iter().zip(["third contact", "second rebound", "rest"]) {
        let [e, other] = [MODELLED, CONTACTS[2]].map(|time| total.cor(time, fall));
        let heights = [2, 4].map(|power| 100.0 * DROP * e.powi(power));
        println!("  {name:<16}   {e:.4}     {other:.4}     {:.1} and {:.1} cm", heights[0], heights[1]);
        found.extend([e, other]);
    }
    let pooled = (REBOUNDS[1] / DROP).powf(0.25);
    let apex = Total::SecondRebound.time(pooled, fall);
    println!(
        "  e = (10/100)^¼ = {pooled:.4} reaches its second rebound at {apex:.4} s, and 1.10 s is frame {:.0}",
        30.0 * MODELLED
    );
    for (found, expected) in found.into_iter().zip([0.4836, 0.4892, 0.5604, 0.5675, 0.4178, 0.4215]) {
        check(found, expected, 1e-4);
    }
    check(apex, 1.1027, 1e-4);
}

/// One COR holds both columns if every height was read a few centimetres too high.
fn reconciled(report: &Report) -> Done {
    let zero = report.hypotheses().iter().find(|h| h.name == "height-zero").ok_or("no hypothesis")?;
    let (cor, offset) = (zero.cor.ok_or("no COR")?.value, zero.offset_m.ok_or("no offset")?.value);
    let drop = Drop::new(DROP - offset, GRAVITY, Cor::new(cor)?);
    let (sigma_height, sigma_time) =
        (report.sigma_height().ok_or("no heights")?.value, report.sigma_time().ok_or("no times")?.value);
    println!("\nOne COR of {cor:.3}, and every height read {:.1} cm too high", 100.0 * offset);
    let (mut residuals, mut squares) = (Vec::new(), 0.0);
    for point in report.points().iter().filter(|point| point.label != "release") {
        let number: u32 = point.label.rsplit(' ').next().unwrap_or_default().parse()?;
        let mark = mark(&point.label);
        let (time, z) = if mark == Mark::Contact {
            let time = drop.impact_time(number);
            println!("  {:<10} {time:.3} s for {:.2} s", point.label, point.time);
            (point.time, (point.time - time) / sigma_time)
        } else {
            let height = drop.apex_height(number) + offset;
            println!("  {:<10} {:.1} cm for {:.0} cm", point.label, 100.0 * height, 100.0 * point.height);
            (point.time, (point.height - height) / sigma_height)
        };
        residuals.push(Residual::new(time, z).mark(mark));
        squares += z * z;
    }
    check(squares, 14.2, 0.1);
    check(zero.chi_square, squares, 1e-6);
    check(cor, 0.4995, 0.0001);
    check(offset, 0.0536, 0.0001);
    let flights = Start { drop: DROP - offset, gravity: GRAVITY, early: 0.0 }.bounces(Cor::new(cor)?, 2);
    let caption = format!(
        "χ² = {:.1} on {} degrees of freedom, instead of 73 on 4. A guess until a ball at rest is measured on the same scale",
        zero.chi_square, zero.degrees_of_freedom
    );
    let picture = HeightTime::new("What would reconcile heights and times")
        .caption(&caption)
        .motion(&format!("e = {cor:.2}, heights {:.1} cm lower than read", 100.0 * offset), flights.arcs())
        .measured(measured(report, offset))
        .contacts(flights.turns())
        .residuals(residuals)
        .background(Background::Adaptive);
    save("study-reconciled", &picture)
}

/// What 30 frames a second do to heights and contacts: by formula, and from a thousand films of one
/// motion.
fn film() -> Done {
    const FILMS: u32 = 1000;
    let cor = Cor::new(0.5)?;
    let speed = impact_speed(DROP, GRAVITY);
    let by_formula = [CAMERA.apex(GRAVITY), CAMERA.contact(0.5), CAMERA.gap(speed, 0.5)];
    println!("\nRead off {FILMS} films of 30 frames per second, e = 0.5   mean, spread, worst; in brackets by formula");
    let names = ["first rebound, mm", "first contact, ms", "lowest frame, mm"];
    let found = CAMERA.measure(DROP, GRAVITY, cor, 1, FILMS)?;
    for (seen, expected) in found.iter().zip([[-0.45, 0.41, 1.36], [5.85, 9.62, 22.50], [23.98, 13.67, 47.32]]) {
        for (seen, expected) in [seen.mean, seen.spread, seen.worst].into_iter().zip(expected) {
            check(1e3 * seen, expected, 0.01);
        }
    }
    for ((seen, formula), name) in found.iter().zip(by_formula).zip(names) {
        let show = |found: f64, formula: f64| format!("{:7.2} ({:6.2})", 1e3 * found, 1e3 * formula);
        println!(
            "  {name}  {} {} {}",
            show(seen.mean, formula.mean),
            show(seen.spread, formula.spread),
            show(seen.worst, formula.worst)
        );
        let scale = formula.worst;
        // The worst of a thousand films is short of the worst; of contacts the formulas leave out
        // gravity from frame to frame, 7 % of the speed.
        let left_out = if name.contains("rebound") { 2.5e-3 } else { 0.05 };
        for (a, b) in [(seen.mean, formula.mean), (seen.spread, formula.spread), (seen.worst, formula.worst)] {
            assert!((a - b).abs() <= left_out * scale, "{name}: {a} is not {b}");
        }
    }

    let exact = Drop::new(DROP, GRAVITY, cor);
    let path =
        Simulation::of(&Ball::new(GRAVITY, cor)?).run(Mode::Flight, Ball::dropped_from(DROP), 0.0..1.5)?.trajectory;
    let shutter = 0.22 * CAMERA.frame();
    let frames: Vec<_> = CAMERA.film(shutter, 1.25, |t| path.at(t)).collect();
    let seen = read(&frames);
    let dots =
        |points: &[[f64; 2]], mark| points.iter().map(|p| Measured::new(p[0], p[1]).mark(mark)).collect::<Vec<_>>();
    let others: Vec<_> =
        frames.iter().filter(|frame| !seen.contacts.contains(frame) && !seen.apexes.contains(frame)).copied().collect();
    let caption = format!(
        "In the lowest frame of the first contact the ball is {:.1} cm up; in another film it may be anywhere between that and the floor",
        100.0 * seen.contacts[0][1]
    );
    let arcs: Vec<Stroke> = Start { early: 0.0, ..START }.bounces(cor, 3).arcs();
    let picture = HeightTime::new("What 30 frames a second show")
        .caption(&caption)
        .motion("e = 0.50", arcs)
        .measured(dots(&others, Mark::Sample))
        .measured(dots(&seen.contacts, Mark::Contact))
        .measured(dots(&seen.apexes, Mark::Apex))
        .contacts((1..=3).map(|n| exact.impact_time(n)))
        .background(Background::Adaptive);
    save("study-film", &picture)
}

/// The mean of ten, as the study has it, against ten trials that are pooled. The drops are
/// synthetic: those of the study are not published.
fn ten_drops() -> Done {
    const EXPERIMENTS: u64 = 200;
    let plan = Plan { drop: DROP, gravity: GRAVITY, cor: 0.55, spread: 0.05, camera: CAMERA };
    let trials = plan.drops(10, 1)?;
    println!("\nTen synthetic drops, COR 0.50 to 0.60 (seed 1)\n  contacts in s            rebounds in cm");
    let show = |trial: &Trial| {
        let [a, b, c] = trial.contacts;
        format!("{a:.3}  {b:.3}  {c:.3}      {:4.1}  {:4.1}", 100.0 * trial.rebounds[0], 100.0 * trial.rebounds[1])
    };
    for trial in &trials {
        println!("  {}", show(trial));
    }
    println!("  {}   their means", show(&mean(&trials)));
    for (found, expected) in mean(&trials).contacts.into_iter().zip([0.4767, 0.9767, 1.2533]) {
        check(found, expected, 1e-4);
    }
    let ways = |trials: &[Trial]| -> Result<[Report; 3], Box<dyn Error>> {
        Ok([plan.averaged(trials, true)?, plan.averaged(trials, false)?, plan.pooled(trials)?])
    };
    let names = ["means, timed from the release", "means, on any clock          ", "ten trials                   "];
    let expected = [[0.566, 0.534, 0.661], [0.555, 0.532, 0.581], [0.553, 0.526, 0.583]];
    for ((name, report), expected) in names.iter().zip(ways(&trials)?).zip(expected) {
        let cor = report.cor().ok_or("no COR")?;
        let bounces: Vec<String> =
            report.bounces().iter().filter_map(|b| b.heights).map(|b| format!("{:.3}", b.value)).collect();
        println!(
            "  {name}  COR {:.3}, 95 % {:.3} to {:.3}, {}: {}; bounce by bounce {}",
            cor.value,
            cor.low,
            cor.high,
            report.verdict(),
            report.reason(),
            bounces.join(", ")
        );
        for (found, expected) in [cor.value, cor.low, cor.high].into_iter().zip(expected) {
            check(found, expected, 1e-3);
        }
    }
    let exact: Vec<f64> = trials.iter().map(|trial| trial.cor).collect();
    println!(
        "  mean of the true CORs {:.4}; means of exact heights would show {:.4?}",
        mean(&trials).cor,
        of_mean_heights(&exact)
    );

    let mut held = [0_u32; 3];
    for seed in 1..=EXPERIMENTS {
        for (held, report) in held.iter_mut().zip(ways(&plan.drops(10, seed)?)?) {
            *held += u32::from(report.cor().is_some_and(|cor| cor.low <= plan.cor && plan.cor <= cor.high));
        }
    }
    println!("  of {EXPERIMENTS} such experiments the 95 % interval holds the COR of 0.55 in {held:?}");
    assert!(held.iter().all(|&held| held >= 190), "{held:?}");
    Ok(())
}

/// What the study's script would set in the animation program: a key for each contact.
fn keyframes() -> Done {
    let frames = Frames::new(Rate::new(30, 1)?);
    let motion = keys::motion(START, Cor::new((REBOUNDS[1] / DROP).powf(0.25))?, frames)?;
    let snapped = motion.snapped(Snap::Gravity, frames)?;
    println!("\nKeys at 30 frames per second, e = 0.562\n  frame     height    in m/s    out m/s   on whole frames");
    let [keys, whole] = [&motion, &snapped].map(|motion| motion.tracks[0].keys(1e-4, frames).keys);
    for (key, whole) in keys.iter().zip(&whole) {
        println!(
            "  {:6.2}   {:5.1} cm    {:6.2}    {:6.2}    {:3.0}, leaving at {:.2}",
            frames.number(key.t),
            100.0 * key.place[2],
            key.enter[2],
            key.leave[2],
            frames.number(whole.t),
            whole.leave[2]
        );
    }
    for (key, frame) in keys.iter().zip([0.0, 13.55, 28.80, 37.37, 42.19, 44.90, 46.42, 48.38]) {
        check(frames.number(key.t), frame, 0.01);
    }
    let numbers: Vec<f64> = whole.iter().map(|key| frames.number(key.t)).collect();
    assert_eq!(numbers, [0.0, 14.0, 29.0, 38.0, 43.0, 46.0, 48.0, 50.0]);
    check(whole[0].place[2], 1.067, 1e-3);
    let export = |motion, format| Export::new(motion, frames).file(format);
    let (script, baked) = (export(&motion, Format::Maya)?, export(&motion, Format::CsvFrames)?);
    println!(
        "  {} keys are within {:.0e} m of the motion, {} frames within {:.1} mm; on whole frames the drop is from {:.1} cm",
        script.keys,
        script.miss.height,
        baked.keys,
        1e3 * baked.miss.height,
        100.0 * whole[0].place[2]
    );
    assert!(script.miss.height < 1e-12 && baked.miss.height <= GRAVITY / (8.0 * 900.0) + 1e-12);
    assert_eq!((keys.len(), snapped.off_frame(frames)), (8, 0.0));
    Ok(())
}
