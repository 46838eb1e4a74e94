//! Ways in which classes write down what they measured: each is a law that holds for every ball.

use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, ReadOptions, Report, Table, TableError, Verdict};

fn read(text: &str) -> Result<Table, TableError> {
    Table::parse("t.txt", text.as_bytes(), &ReadOptions::default())
}

fn fit(text: &str) -> Report {
    Fit::new().run(&read(text).unwrap_or_else(|e| panic!("{e}\n{text}"))).unwrap()
}

/// A COR that is trusted lies near the planted one.
fn right(report: &Report, e: f64, within: f64) -> Result<(), TestCaseError> {
    let cor = report.cor().map(|cor| cor.value);
    prop_assert!(report.verdict() != Verdict::Refused, "{report}");
    prop_assert!(cor.is_some_and(|cor| (cor - e).abs() < within), "{e} {report}");
    Ok(())
}

/// The heights of a ball that is dropped once, in `unit` to a whole number.
fn heights(e: f64, drop: f64, count: usize) -> Vec<f64> {
    (0..count).map(|n| (drop * e.powi(2 * n as i32)).round()).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(100)))]

    /// Numbered heights that do not fall, below one stated release, are repeats.
    #[test]
    fn level_heights_below_a_stated_release_repeat_it(
        cors in prop::collection::vec(0.35..0.85_f64, 2..5),
        noise in prop::collection::vec(-0.01..0.01_f64, 16),
        columns in 2..5_usize,
        same in any::<bool>(),
    ) {
        let name = |n: usize| if same { ",Bounce height (cm)".to_owned() } else { format!(",Bounce height {} (cm)", n + 1) };
        let mut text = format!("Squash ball dropped from 200 cm\nTemperature (°C){}\n", (0..columns).map(name).collect::<String>());
        for (row, e) in cors.iter().enumerate() {
            let cells = (0..columns).map(|n| format!(",{:.1}", 200.0 * e * e * (1.0 + noise[4 * row + n])));
            text += &format!("{}{}\n", 5 + 15 * row, cells.collect::<String>());
        }
        let report = fit(&text);
        prop_assert_eq!(report.groups().len(), cors.len(), "{}\n{}", text, report);
        for (group, e) in report.groups().iter().zip(&cors) {
            right(&group.report, *e, 0.01)?;
        }
    }

    /// Heights that fall beside counted tops need no clock, whatever frames stand beside them.
    #[test]
    fn counted_tops_need_no_frame_rate(e in 0.6..0.9_f64, drop in 400.0..900.0_f64, every in 3..20_usize) {
        let rows = heights(e, drop, 6).into_iter().enumerate().map(|(n, h)| format!("{n};{};{h}\n", 7 + every * n));
        let text = format!("# floor at y = 0 px\nbounce;frame;y (px)\n{}", rows.collect::<String>());
        let report = fit(&text);
        right(&report, e, 0.01)?;
        prop_assert!(report.to_string().contains("frames of unknown rate"), "{}", report);
    }

    /// A word before the first bounce is the release, whatever it says; where it is lower it is
    /// none.
    #[test]
    fn a_word_before_the_first_bounce_is_the_release(word in "[a-z]{4,9}", e in 0.5..0.9_f64, drop in 120.0..300.0_f64, ordinal in any::<bool>()) {
        let heights = heights(e, drop, 6);
        let rows = (1..6).map(|n| format!("{n}{};{}\n", if ordinal { "°" } else { "" }, heights[n]));
        let rows = rows.collect::<String>();
        let table = |first: f64| format!("Rimbalzi di una pallina - altezze in cm\nrimbalzo;altezza\n{word};{first}\n{rows}");
        // A word may have a meaning of its own.
        if let Ok(read) = read(&table(heights[0])) {
            let report = Fit::new().run(&read).unwrap();
            if report.verdict() == Verdict::Trusted {
                right(&report, e, 0.01)?;
            }
        }
        prop_assert!(read(&table(heights[1] - 1.0)).is_err());
    }

    /// Where a column holds numbers on both sides of a thousand, a mark before three digits parts
    /// them; where it holds no others, or small ones, it is a decimal one.
    #[test]
    fn points_part_thousands_beside_whole_numbers(e in 0.5..0.9_f64, factor in 0.95..1.05_f64) {
        let parted = |h: f64| if h < 1000.0 { format!("{h}") } else { format!("{}.{:03}", (h / 1000.0).floor(), h % 1000.0) };
        let pairs = [500.0, 750.0, 1000.0, 1250.0, 1500.0, 2000.0].map(|h| ((h * factor).round(), (h * factor * e * e).round()));
        let rows = |write: &dyn Fn(f64) -> String| pairs.iter().map(|(h, r)| format!("{};{}\n", write(*h), write(*r))).collect::<String>();
        let table = |rows: String| format!("Fallhöhe [mm];Rücksprunghöhe [mm]\n{rows}");
        let (plain, marked) = (fit(&table(rows(&|h| h.to_string()))), fit(&table(rows(&parted))));
        prop_assert_eq!(plain.cor().map(|cor| cor.value), marked.cor().map(|cor| cor.value));
        let metres = fit(&table(rows(&|h| format!("{:.3}", h / 1000.0))).replace("mm", "m"));
        right(&metres, e, 0.01)?;
    }

    /// Times of day of contacts, below lines that tell something.
    #[test]
    fn clocks_before_each_hit_are_its_times(e in 0.7..0.92_f64, from in 0.0..86_000.0_f64, title in 0..3_usize, mark in 0..4_usize) {
        let (mut time, mut flight) = (from, 0.9);
        let mut text = ["", "Arduino KY-038 sound sensor\n", "Piezo on a desk\nball 2, run 3\n\n"][title].to_owned();
        for _ in 0..7 {
            let (hours, minutes, seconds) = ((time / 3600.0).floor(), (time / 60.0).floor() % 60.0, time % 60.0);
            text += &format!("{hours:02}:{minutes:02}:{seconds:06.3}{}HIT\n", [" ", "  ", "\t", " - "][mark]);
            (time, flight) = (time + flight, flight * e);
        }
        prop_assume!(!text.contains(":60.000"));
        right(&fit(&text), e, 0.01)?;
    }

    /// The height after n bounces is e to the 2 n of the release.
    #[test]
    fn heights_after_so_many_bounces(e in 0.7..0.95_f64, counts in prop::collection::vec(2..6_usize, 3..6)) {
        let enumerates = counts[0] == 1 && counts.windows(2).all(|pair| pair[1] == pair[0] + 1);
        prop_assume!(!enumerates);
        let rows = counts.iter().enumerate().map(|(n, count)| {
            let drop = 150.0 + 25.0 * n as f64;
            format!("{drop},{count},{:.1}\n", drop * e.powi(2 * *count as i32))
        });
        let rows = rows.collect::<String>();
        right(&fit(&format!("drop height (cm),number of bounces,height reached after that many bounces (cm)\n{rows}")), e, 0.01)?;
        let unsaid = read(&format!("drop height (cm),number of bounces,height (cm)\n{rows}"));
        prop_assert!(unsaid.is_err_and(|error| error.is_question()));
    }

    /// Heights of the top of a ball are too high by its diameter, and those of its middle by half.
    #[test]
    fn heights_of_another_point_of_the_ball(e in 0.5..0.9_f64, size in 4..30_u32, middle in any::<bool>(), words in 0..3_usize) {
        let high = f64::from(size) * if middle { 0.5 } else { 1.0 };
        let rows = [80.0, 120.0, 160.0, 200.0].map(|h| format!("{:.1},{:.1}\n", h + high, h * e * e + high)).concat();
        let point = if middle { "centre" } else { "TOP" };
        let said = [
            format!("# basketball, diameter {size} cm. All heights are measured to the {point} of the ball!"),
            format!("Heights are to the {point} of the ball (diameter {size} cm)"),
            format!("# ball: radius {} mm; heights measured at the {point} of the ball", 5 * size),
        ];
        right(&fit(&format!("{}\ndrop (cm),rebound (cm)\n{rows}", said[words])), e, 0.01)?;
        let listed = (0..5).map(|n| format!("{n},{:.1}\n", 200.0 * e.powi(2 * n) + high));
        let named = format!("Ball, diameter {size} cm\nbounce,{point} of ball (cm)\n{}", listed.collect::<String>());
        if !middle {
            right(&fit(&named), e, 0.01)?;
        }
        // Nobody knows by how much.
        let open = fit(&format!("# heights measured to the {point} of the ball\ndrop (cm),rebound (cm)\n{rows}"));
        prop_assert!(open.verdict() != Verdict::Trusted);
    }

    /// Arrows lead from a release to what followed it: to repeats, or to bounces.
    #[test]
    fn arrows_lead_to_repeats_or_bounces(cors in prop::collection::vec(0.5..0.9_f64, 2..4), noise in prop::collection::vec(-0.01..0.01_f64, 12), arrow in 0..3_usize, chained in any::<bool>()) {
        let arrow = ["→", "->", "=>"][arrow];
        let mut text = "bounce test garage floor, all in cm 📏\n".to_owned();
        for (n, e) in cors.iter().enumerate() {
            let heights: Vec<String> = if chained {
                heights(*e, 200.0, 4)[1..].iter().map(f64::to_string).collect()
            } else {
                (0..3).map(|k| format!("{:.0}", 200.0 * e * e * (1.0 + noise[3 * n + k]))).collect()
            };
            let list = heights.join(if chained { " -> " } else { ", " });
            text += &format!("- ball {}: 200 {arrow} {list}\n", ["red", "blue", "green"][n]);
        }
        let report = fit(&text);
        prop_assert_eq!(report.groups().len(), cors.len(), "{}\n{}", text, report);
        for (group, e) in report.groups().iter().zip(&cors) {
            right(&group.report, *e, 0.012)?;
        }
    }

    /// A recording tells where its floor is, whatever lengths stand above it.
    #[test]
    fn a_recording_needs_no_place_of_the_floor(e in 0.65..0.85_f64, sensor in 1.3..2.5_f64) {
        let (mut height, mut from, mut speed) = (1.0, 0.0, 0.0);
        let mut text = format!("Motion Sensor {sensor:.2} m above the floor, facing down\nTime (s),Position (m)\n");
        for n in 0..150 {
            let time = 0.02 * f64::from(n);
            let fallen = |speed: f64, t: f64| speed * t - 0.5 * 9.81 * t * t;
            // The ball bounces until the flight of this time.
            loop {
                let lasts = (speed + (speed * speed + 2.0_f64 * 9.81 * height).sqrt()) / 9.81;
                if time <= from + lasts || lasts < 0.05 {
                    break;
                }
                let impact: f64 = 9.81 * lasts - speed;
                (from, height, speed) = (from + lasts, 0.0, e * impact);
            }
            let y = (height + fallen(speed, time - from)).max(0.0);
            text += &format!("{time:.2},{:.4}\n", sensor - y);
        }
        let report = fit(&text);
        right(&report, e, 0.01)?;
        prop_assert_eq!(report.verdict(), Verdict::Trusted, "{}", report);
    }
}

/// Titles speak of much, and only a few words of them say that numbers were not measured.
#[test]
fn titles_are_sentences() {
    let table = |title: &str| fit(&format!("{title}\ndrop (cm),rebound (cm)\n100,64\n150,97\n200,127\n"));
    for title in
        ["Basketball bounce on different surfaces", "Rebound test acc. to the teacher", "Station 4711 / order 23"]
    {
        assert_eq!(table(title).verdict(), Verdict::Trusted, "{title}");
    }
    for title in ["Simulated bounces", "Theoretical heights of a ball", "Simulted bounces of balls", "Loss of height"] {
        assert_ne!(table(title).verdict(), Verdict::Trusted, "{title}");
    }
}
