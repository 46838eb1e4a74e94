//! Pictures of runs: the curve is the run, both limits of a jump are shown, names and units are
//! there, and no words overlap.

use proptest::prelude::*;
use roxmltree::{Document, Node};
use saltus::{Clock, Coords, Hybrid, RunOf, Simulation, State};
use saltus_cases::cases;
use saltus_plot::{Background, Panels, Phase, PlotError};

type Point = (f64, f64);

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

/// The path data in groups of this class, one for each group.
fn paths(document: &Document<'_>, class: &str) -> Vec<(f64, String)> {
    let groups = document.descendants().filter(|node| node.attribute("class") == Some(class));
    let data = |group: Node<'_, '_>| group.children().filter_map(|path| path.attribute("d")).collect::<String>();
    groups.map(|group| (number(group.attribute("stroke-width").unwrap_or("0")), data(group))).collect()
}

/// The commands of path data with their numbers.
fn commands(data: &str) -> Vec<(char, Vec<f64>)> {
    let mut found: Vec<(char, String)> = Vec::new();
    for c in data.chars() {
        match found.last_mut() {
            Some(last) if !c.is_ascii_alphabetic() => last.1.push(c),
            _ => found.push((c, String::new())),
        }
    }
    let numbers = |text: &str| text.split_whitespace().map(number).collect();
    found.iter().map(|(c, text)| (*c, numbers(&text.replace(',', " ")))).collect()
}

/// Points along a path, so close that they are the path.
fn drawn(data: &str) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    for (command, numbers) in commands(data) {
        let ends: Vec<Point> = numbers.chunks(2).map(|p| (p[0], p[1])).collect();
        if command == 'M' {
            points.extend(ends);
            continue;
        }
        assert!(matches!(command, 'L' | 'Q' | 'C'), "{command}");
        let control: Vec<Point> = points.last().copied().into_iter().chain(ends).collect();
        for i in 1..=200 {
            let u = f64::from(i) / 200.0;
            let mut left = control.clone();
            while left.len() > 1 {
                left =
                    left.windows(2).map(|p| (p[0].0 + u * (p[1].0 - p[0].0), p[0].1 + u * (p[1].1 - p[0].1))).collect();
            }
            points.push(left[0]);
        }
    }
    points
}

/// The map from numbers on an axis to px, read off its first and its last label; of several panels
/// that of the first.
fn axis(document: &Document<'_>, way: &str) -> impl Fn(f64) -> f64 + use<> {
    let anchor = if way == "x" { "middle" } else { "end" };
    let label = |node: Node<'_, '_>| {
        let value = node.text()?.replace('\u{2212}', "-").parse::<f64>().ok()?;
        // Numbers on the axis up stand half a capital letter below their line.
        let size = number(node.parent()?.attribute("font-size")?);
        let drop = if way == "y" { 0.5 * 0.717 * size } else { 0.0 };
        Some((value, number(node.attribute(way)?) - drop))
    };
    let labels: Vec<_> =
        document.descendants().filter(|node| node.attribute("text-anchor") == Some(anchor)).filter_map(label).collect();
    let ((a, pa), (b, pb)) = (labels[0], labels[labels.len() - 1]);
    move |value| pa + (value - a) * (pb - pa) / (b - a)
}

/// How far the nearest of these points, which follow each other across, is up or down, at most a
/// third of a px aside.
fn off(points: &[Point], (x, y): Point) -> f64 {
    let first = points.partition_point(|p| p.0 < x - 0.34);
    let near = points[first..].iter().take_while(|p| p.0 < x + 0.34).map(|p| p.1);
    let (low, high) = near.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
    (low - y).max(y - high).max(0.0)
}

#[derive(Clone, Copy, Debug, State)]
struct Kicked {
    #[unit("V")]
    pulse: f64,
    #[unit("A")]
    ramp: f64,
}

/// Narrow pulses, and a saw that a clock sets back: both limits and every peak have formulas.
fn kicked(peaks: &[(f64, f64, f64)], period: f64) -> RunOf<Hybrid<'_, Kicked>> {
    let rate = |t: f64, (at, high, wide): (f64, f64, f64)| {
        let u = (t - at) / wide;
        -2.0 * u / wide * high * (-u * u).exp()
    };
    let model = Hybrid::new()
        .mode("go", move |t, _x: &Kicked| Kicked { pulse: peaks.iter().map(|&p| rate(t, p)).sum(), ramp: 1.0 })
        .clock("go", "go", Clock::every(period), |_t, x| Kicked { ramp: 0.0, ..*x });
    let start = Kicked { pulse: peaks.iter().map(|p| pulse(0.0, p)).sum(), ramp: 0.0 };
    Simulation::of(&model).longest_step(2e-3).run("go", start, 0.0..4.0).unwrap()
}

fn pulse(t: f64, &(at, high, wide): &(f64, f64, f64)) -> f64 {
    high * (-((t - at) / wide).powi(2)).exp()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(24)))]

    /// Wherever the run is, the curve is within a third of a px, on peaks that are narrower than
    /// that as well.
    #[test]
    fn the_curve_is_the_run(
        peaks in prop::collection::vec((0.2..3.8_f64, 2.0..8.0_f64, -3.0..-0.5_f64), 1..4),
        period in 0.3..1.5_f64,
    ) {
        // Widths from a millisecond, a fifth of a px, to a third of a second.
        let peaks: Vec<_> = peaks.into_iter().map(|(at, high, power)| (at, high, 10_f64.powf(power))).collect();
        let run = kicked(&peaks, period);
        let svg = Panels::of(&run.trajectory).panel(["pulse"]).svg().unwrap();
        let document = Document::parse(&svg).unwrap();
        let (x, y) = (axis(&document, "x"), axis(&document, "y"));
        let (_, data) = paths(&document, "one s").into_iter().find(|(wide, data)| *wide > 2.0 && data.len() > 100).unwrap();
        let mut points = drawn(&data);
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        for k in 0..=4000 {
            let t = f64::from(k) * 1e-3;
            let truth: f64 = peaks.iter().map(|p| pulse(t, p)).sum();
            prop_assert!(off(&points, (x(t), y(truth))) < 0.1, "at {t}: {}", off(&points, (x(t), y(truth))));
        }
        let top = points.iter().map(|p| p.1).fold(f64::INFINITY, f64::min);
        let most = (0..200_000).map(|k| peaks.iter().map(|p| pulse(f64::from(k) * 2e-5, p)).sum()).fold(0.0, f64::max);
        prop_assert!((top - y(most)).abs() < 0.1, "{top} is not {}", y(most));
    }

    /// A ring before and a dot after each jump, at its limits; between two jumps one unbroken
    /// curve.
    #[test]
    fn jumps_have_both_limits(period in 0.3..1.5_f64) {
        let run = kicked(&[], period);
        let svg = Panels::of(&run.trajectory).panel(["ramp"]).svg().unwrap();
        let document = Document::parse(&svg).unwrap();
        let (x, y) = (axis(&document, "x"), axis(&document, "y"));
        let all = paths(&document, "one s");
        let curve = all.iter().find(|(wide, _)| (*wide - 2.3).abs() < 0.01).unwrap();
        let count = run.trajectory.jumps().len();
        prop_assert_eq!(curve.1.matches('M').count(), count + 1);
        let starts = |data: &str, command: char| -> Vec<Point> {
            commands(data).into_iter().filter(|c| c.0 == command).map(|c| (c.1[0], c.1[1])).collect()
        };
        let rings = &all.iter().find(|(_, data)| data.contains('a')).unwrap().1;
        let dots = &all.iter().find(|(_, data)| data.contains("h0")).unwrap().1;
        let (rings, dots) = (starts(rings, 'M'), starts(dots, 'M'));
        prop_assert_eq!((rings.len(), dots.len()), (count, count));
        for (jump, (ring, dot)) in run.trajectory.jumps().iter().zip(rings.iter().zip(&dots)) {
            prop_assert!((dot.0 - x(jump.t())).abs() < 0.05 && (dot.1 - y(0.0)).abs() < 0.05);
            prop_assert!((ring.1 - y(jump.before.ramp)).abs() < 0.05 && ring.0 < dot.0 && dot.0 - ring.0 < 4.0);
        }
    }

    /// A phase portrait is the run: a damped swing in closed form.
    #[test]
    fn a_phase_portrait_is_the_run(damping in 0.0..0.3_f64, end in 3.0..20.0_f64) {
        let swing = Hybrid::new().mode("swing", |_t, x: &[f64; 2]| [-damping * x[0] + x[1], -x[0] - damping * x[1]]);
        let run = Simulation::of(&swing).run("swing", [0.0, 1.0], 0.0..end).unwrap();
        let svg = Phase::of(&run.trajectory, 0, 1).svg().unwrap();
        let document = Document::parse(&svg).unwrap();
        let (x, y) = (axis(&document, "x"), axis(&document, "y"));
        let (_, data) = paths(&document, "one s").remove(0);
        let points = drawn(&data);
        for k in 0..=1000 {
            let t = end * f64::from(k) / 1000.0;
            let r = (-damping * t).exp();
            let (px, py) = (x(r * t.sin()), y(r * t.cos()));
            let near = points.iter().map(|p| (p.0 - px).hypot(p.1 - py)).fold(f64::INFINITY, f64::min);
            // The points that stand for the path are up to three px apart.
            prop_assert!(near < 1.6, "{near} at {t}");
        }
    }
}

fn ball() -> RunOf<Hybrid<'static, [f64; 2]>> {
    let ball = Hybrid::new()
        .mode("flight", |_t, x: &[f64; 2]| [x[1], -9.81])
        .edge("flight", "flight", |_t, x| x[0], |_t, x| [0.0, -0.8 * x[1]])
        .mode("rest", |_t, _x| [0.0, 0.0])
        .beyond("flight", "rest", |_t, _x| [0.0, 0.0]);
    Simulation::of(&ball).run("flight", [1.0, 0.0], 0.0..f64::INFINITY).unwrap()
}

/// A converter with pulses, so many periods long.
fn converter(periods: u32) -> RunOf<Hybrid<'static, Kicked>> {
    let flow = |source: f64| {
        move |_t: f64, x: &Kicked| Kicked { pulse: 1e4 * (source - x.ramp), ramp: 1e4 * (x.pulse - x.ramp) }
    };
    let period = 20e-6;
    let model = Hybrid::new()
        .mode("on", flow(12.0))
        .mode("off", flow(0.0))
        .clock("on", "off", Clock::every(period).after(0.4 * period), |_t, x| *x)
        .clock("off", "on", Clock::every(period), |_t, x| *x);
    let start = Kicked { pulse: 0.0, ramp: 0.0 };
    Simulation::of(&model).tolerance(1e-5).run("on", start, 0.0..f64::from(periods) * period).unwrap()
}

/// The picture of a run of very many jumps has only what is visible of it.
#[test]
fn long_runs_stay_small() {
    for (svg, most) in [
        (Panels::of(&converter(50_000).trajectory).svg().unwrap(), 400_000),
        (Panels::of(&ball().trajectory).svg().unwrap(), 20_000),
    ] {
        assert!(svg.len() < most, "{} bytes", svg.len());
        for strange in ["NaN", "inf", "\"-0\""] {
            assert!(!svg.contains(strange), "{strange}");
        }
    }
}

#[test]
fn a_run_without_end_is_drawn_until_after_its_last_jump() {
    let run = ball();
    let svg = Panels::of(&run.trajectory).named(["height (m)", "velocity (m/s)"]).svg().unwrap();
    for word in [">height (m)<", ">velocity (m/s)<", ">flight<", ">rest<", ">jump<", ">jumps accumulate<", ">4.5<"] {
        assert!(svg.contains(word), "{word} is missing");
    }
    assert!(!svg.contains(">5.0<"));
    assert_eq!(svg, Panels::of(&run.trajectory).named(["height (m)", "velocity (m/s)"]).svg().unwrap());
    let rest = Hybrid::new().mode("rest", |_t, _x: &f64| 0.0);
    let run = Simulation::of(&rest).run("rest", 1.0, 0.0..f64::INFINITY).unwrap();
    assert!(Panels::of(&run.trajectory).svg().unwrap_err().to_string().contains("by `over`"));
    assert!(Panels::of(&run.trajectory).over(0.0..5.0).svg().unwrap().contains(">5.0<"));
}

#[test]
fn what_cannot_be_drawn_is_named() {
    let run = ball();
    let fails = |svg: Result<String, PlotError>| svg.unwrap_err().to_string();
    let message = fails(Panels::of(&run.trajectory).named(["height", "speed"]).panel(["hight"]).svg());
    assert!(message.contains("no coordinate \"hight\", only height, speed"), "{message}");
    assert!(fails(Phase::of(&run.trajectory, 0, 2).svg()).contains("no coordinate 2, only x0, x1"));
    for part in [5.0..5.0, 9.0..8.0, -3.0..-2.0] {
        assert!(fails(Panels::of(&run.trajectory).over(part).svg()).contains("has no length within the run"));
    }
    assert!(fails(Panels::of(&run.trajectory).over(0.0..f64::NAN).svg()).contains("NaN"));
    let message = fails(Phase::of(&run.trajectory, 0, 1).named(["a", "b", "c"]).svg());
    assert!(message.contains("no coordinate for the name \"c\": the state has 2"), "{message}");
    let nothing: [usize; 0] = [];
    assert_eq!(Panels::of(&run.trajectory).panel(nothing).svg(), Err(PlotError::Empty));
    let run =
        Simulation::of(&Hybrid::new().mode("go", |_t, _x: &[f64; 3]| [1.0; 3])).run("go", [0.0; 3], 0.0..1.0).unwrap();
    let lists = Phase::of(&run.trajectory, "arm", "leg").named(["arm[0]", "arm[1]", "leg"]).svg();
    assert!(fails(lists).contains("\"arm\" alone, only arm[0], arm[1]"));
}

#[test]
fn units_get_prefixes_and_any_other_stays() {
    let run = converter(20);
    let svg = Panels::of(&run.trajectory).named(["pressure (Pa)", "speed (1/min)"]).title("Units").svg().unwrap();
    assert!(svg.contains(">pressure (Pa)<") && svg.contains(">speed (1/min)<"));
    let hours = Panels::of(&run.trajectory).time("h").svg().unwrap();
    assert!(hours.contains("h)") && !hours.contains("(ms)"), "{hours}");
}

/// Coordinates of one list share a panel; a mode without a coordinate leaves a gap.
#[test]
fn lists_share_a_panel_and_gaps_are_gaps() {
    let model = Hybrid::new()
        .mode("two", |_t, _x: &Coords<2>| [1.0, -1.0].into())
        .mode("one", |_t, _x| [0.5].into())
        .clock("two", "one", Clock::every(1.0), |_t, x| [x[0]].into())
        .clock("one", "two", Clock::every(1.0), |_t, x| [x[0], 0.0].into());
    let run = Simulation::of(&model).run("two", [0.0, 1.0].into(), 0.0..3.5).unwrap();
    let svg = Panels::of(&run.trajectory).named(["arm[0] (rad)", "arm[1] (rad)"]).svg().unwrap();
    let document = Document::parse(&svg).unwrap();
    assert!(svg.contains(">arm[0]<") && svg.contains(">arm[1]<") && svg.contains(">(rad)<"));
    let second = paths(&document, "two s");
    let curves: Vec<_> = second.iter().filter(|(wide, _)| (*wide - 2.3).abs() < 0.01).collect();
    // One of them is in the legend.
    assert_eq!(curves.iter().map(|(_, data)| data.matches('M').count()).max(), Some(2), "{svg}");
    assert!(Phase::of(&run.trajectory, 0, 1).svg().is_ok());
}

/// No words run into each other, whatever a picture shows.
#[test]
fn words_do_not_overlap() {
    let (ball, converter) = (ball(), converter(20));
    let pictures = [
        Panels::of(&ball.trajectory).title("A ball").caption("let go from 1 m").svg(),
        Panels::of(&ball.trajectory).panel([0, 1]).named(["a rather long name of a height (m)", "v (m/s)"]).svg(),
        Phase::of(&ball.trajectory, 0, 1).title("A ball").background(Background::Adaptive).svg(),
        Panels::of(&converter.trajectory).title("A converter").svg(),
        Panels::of(&converter.trajectory).over(1e-4..1.1e-4).svg(),
        Phase::of(&converter.trajectory, "ramp", "pulse").svg(),
    ];
    for (n, svg) in pictures.into_iter().enumerate() {
        let svg = svg.unwrap();
        let document = Document::parse(&svg).unwrap();
        let boxes: Vec<(f64, f64, f64, f64, String)> = document
            .descendants()
            .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "text")))
            .map(|node| {
                let size = number(node.parent().unwrap().attribute("font-size").unwrap());
                let text = node.text().unwrap().to_owned();
                // Letters are about half as wide as they are high.
                let length = 0.52 * size * text.chars().count() as f64;
                let (x, y) = (number(node.attribute("x").unwrap()), number(node.attribute("y").unwrap()));
                let left = match node.attribute("text-anchor") {
                    Some("end") => x - length,
                    Some("middle") => x - 0.5 * length,
                    _ => x,
                };
                (left, left + length, y - 0.717 * size, y, text)
            })
            .collect();
        for (i, a) in boxes.iter().enumerate() {
            for b in &boxes[i + 1..] {
                let apart = a.1 <= b.0 || b.1 <= a.0 || a.3 <= b.2 || b.3 <= a.2;
                assert!(apart, "picture {n}: {:?} and {:?}", a.4, b.4);
            }
        }
    }
}
