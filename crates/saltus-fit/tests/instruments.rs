//! What sensors, loggers, trackers and sound programs write, and how their lists are titled.

use crate::film;

use crate::film::{Ball, Contact, noisy};
use crate::noise::Noise;
use crate::typed::{fit, read, trusted};
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Fit, Method, ReadOptions, Report, Source, Table, Verdict};

/// Times of contacts of a ball that first hits at `at` and then flies for `flight`, s.
fn contacts(e: f64, (at, flight): (f64, f64), count: usize) -> Vec<f64> {
    let mut times = vec![at];
    for n in 0..count - 1 {
        times.push(times[n] + flight * e.powi(n as i32));
    }
    times
}

fn lines(rows: impl IntoIterator<Item = String>) -> String {
    rows.into_iter().map(|row| row + "\n").collect()
}

fn ball(cor: fn(f64) -> f64) -> Ball {
    Ball { drop: 1.1, release: 0.2, gravity: 9.81, drag: 0.0, cor, contact: Contact::Instant }
}

fn named(name: &str, text: &str) -> Report {
    Fit::new().run(&Table::parse(name, text.as_bytes(), &ReadOptions::default()).unwrap()).unwrap()
}

fn near(cor: f64, e: f64) -> bool {
    (cor - e).abs() < 0.015
}

/// A device that sends one distance a line, with the time before it, is a sensor above the ball.
#[test]
fn lines_of_a_serial_port_are_samples() {
    let rows = noisy(&ball(|_| 0.78).film(50.0, 2.4), &mut Noise(3), 2e-3);
    for (name, unit, per_metre) in [("Distance", "cm", 100.0), ("dist", "mm", 1000.0), ("Abstand", "cm", 100.0)] {
        let sent = |&(t, h): &(f64, f64)| {
            let (minutes, seconds) = (8.0 + ((50.0 + t) / 60.0).floor(), (50.0 + t) % 60.0);
            format!("09:{minutes:02}:{seconds:06.3} -> {name}: {:.1} {unit}", per_metre * (1.6 - h))
        };
        assert!(near(trusted(&lines(rows.iter().map(sent))), 0.78));
    }
}

/// A range, or an echo, beside a clock is a distance; beside other lengths it is a statistic.
#[test]
fn a_range_beside_a_clock_is_a_distance() {
    let rows = noisy(&ball(|_| 0.7).film(50.0, 2.4), &mut Noise(4), 2e-3);
    for name in ["range_mm", "echo (mm)", "ToF range [mm]", "Sonar (mm)"] {
        let samples = rows.iter().map(|(t, h)| format!("{:.0}\t{:.0}", 1e3 * t, 1e3 * (1.6 - h)));
        let text = format!("# rubber ball, sensor above it\nt_ms\t{name}\n{}", lines(samples));
        assert!(near(trusted(&text), 0.7), "{name}");
    }
    let text = "drop (cm),rebound (cm),range (cm)\n60,29.5,2\n90,44,1.5\n120,58.9,2\n";
    assert!(near(trusted(text), 0.7));
}

/// Columns of several bodies, each with a place of its own, have a COR each.
#[test]
fn bodies_side_by_side_have_a_cor_each() {
    let films = [ball(|_| 0.82), ball(|_| 0.6)].map(|b| noisy(&b.film(60.0, 2.4), &mut Noise(6), 1e-3));
    let rows = || films[0].iter().zip(&films[1]).map(|(a, b)| format!("{:.4},0.1,{:.4},0.5,{:.4}", a.0, a.1, b.1));
    for [one, other] in [["green", "white"], ["left ball", "right ball"], ["golf", "tennis"]] {
        let text = format!("t (s),{one} x (m),{one} y (m),{other} x (m),{other} y (m)\n{}", lines(rows()));
        let report = fit(&text);
        let cors: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
        assert!(cors.len() == 2 && near(cors[0], 0.82) && near(cors[1], 0.6), "{text:.80} {report}");
    }
    // One body is no group.
    let one = film::report(&film::csv(&films[0]));
    assert!(one.groups().is_empty() && near(one.cor().unwrap().value, 0.82));
}

/// A sound is sampled a thousand times more finely than its contacts are known, a film is not.
#[test]
fn fine_samples_are_no_fine_readings() {
    let source = |rate: &str| {
        let times = contacts(0.84, (0.31, 0.52), 8).into_iter().map(|t| format!("{t:.4}"));
        let report = fit(&format!("# ball on a plate, {rate}\ncontact time (s)\n{}", lines(times)));
        assert_eq!(report.verdict(), Verdict::Trusted, "{report}");
        report.sigma_time().unwrap().source
    };
    for rate in ["44.1 kHz", "sample rate: 2000 Hz", "48000 Hz"] {
        assert_ne!(source(rate), Source::FrameRate, "{rate}");
    }
    for rate in ["240 fps", "960 fps"] {
        assert_eq!(source(rate), Source::FrameRate, "{rate}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(32), failure_persistence: None, ..ProptestConfig::default() })]

    /// How long each contact lasts stands beside when it was, in any unit and either order.
    #[test]
    fn durations_of_contacts_are_no_times(e in 0.6f64..0.9, lasts in 1e-4f64..8e-3, form in 0usize..4) {
        let rows = |swapped: bool| contacts(e, (0.4, 0.6), 8).into_iter().enumerate().map(move |(n, t)| {
            let brief = 1e3 * lasts * (1.0 + 0.05 * (n % 3) as f64);
            if swapped { format!("{},{brief:.3},{t:.5}", n + 1) } else { format!("{},{t:.5},{brief:.3}", n + 1) }
        });
        let (header, swapped) = [
            ("bounce,time (s),contact time (ms)", false),
            ("bounce,contact time (ms),time (s)", true),
            ("impact,t (s),time in contact (ms)", false),
            ("bounce,impact time (s),contact time (ms)", false),
        ][form];
        let cor = trusted(&format!("{header}\n{}", lines(rows(swapped))));
        prop_assert!((cor - e).abs() < 5e-3, "{header}: {cor} for {e}");
    }

    /// A sentence above a list names it, in the one of its clauses that says what the numbers are.
    #[test]
    fn a_clause_names_the_list_below_it(e in 0.6f64..0.92, form in 0usize..4) {
        let title = [
            "golf ball on stone, contact times in s",
            "times of the bounces (s), a ball on the lab floor",
            "steel ball, glass plate, impact times (s)",
            "take 3, bounce times in seconds, old tennis ball",
        ][form];
        let text = format!("{title}\n{}", lines(contacts(e, (0.4, 0.7), 9).into_iter().map(|t| format!("{t:.4}"))));
        prop_assert!((trusted(&text) - e).abs() < 5e-3, "{text}");
    }

    /// Numbers of frames are times where the title says what they are and how many were filmed.
    #[test]
    fn a_title_says_that_frames_are_counted(e in 0.6f64..0.9, form in 0usize..4) {
        let title = [
            "Slow motion 240 fps - frame at each contact",
            "frame number of each bounce, 240 fps",
            "all frame numbers (240 fps)",
            "frame in which the ball touches the floor, filmed at 240 fps",
        ][form];
        let frame = |t: f64| (240.0 * t).round();
        let (one, other) = (contacts(e, (1.0, 0.6), 7), contacts(e, (1.4, 0.63), 7));
        let rows = one.iter().zip(&other).enumerate().map(|(n, (a, b))| format!("{},{},{}", n + 1, frame(*a), frame(*b)));
        let report = fit(&format!("{title}\nBounce,Trial 1,Trial 2\n{}", lines(rows)));
        prop_assert!(near(report.cor().unwrap().value, e), "{title}: {report}");
        prop_assert_eq!(report.estimates()[0].method, Method::Times);
    }

    /// The unit in the corner of a table turned over is that of all of its columns.
    #[test]
    fn the_corner_names_the_unit_of_the_columns(e in 0.5f64..0.85, form in 0usize..3) {
        let corner = ["Height (cm)", "heights / cm", "height [cm]"][form];
        let drop = |n: usize| {
            let heights = (0..5).map(|k| format!("{:.1}", 120.0 * e.powi(2 * k) * (1.0 + 0.004 * n as f64)));
            format!("Drop {},{}", n + 1, heights.collect::<Vec<_>>().join(","))
        };
        let text = format!("{corner},h0,h1,h2,h3,h4\n{}", lines((0..3).map(drop)));
        prop_assert!(near(trusted(&text), e), "{text}");
    }

    /// What is lost of the energy, at or in the bounce, is lost of the height.
    #[test]
    fn energy_is_lost_in_a_bounce(e in 0.5f64..0.9, form in 0usize..7) {
        let heading = [
            "energy lost (%)",
            "energy lost in bounce (%)",
            "energy lost at the impact (%)",
            "% energy lost",
            "percent energy lost in the bounce",
            "energy loss per bounce (%)",
            "kinetic energy lost in collision (%)",
        ][form];
        let lost = 100.0 * (1.0 - e * e);
        let rows = [80.0, 110.0, 140.0].map(|from| format!("{from},{:.1}", lost + 0.002 * (from - 110.0)));
        let text = format!("drop height (cm),{heading}\n{}", lines(rows));
        prop_assert!(near(trusted(&text), e), "{text}");
    }

    /// Columns that are named by surfaces alone hold what the title says.
    #[test]
    fn the_title_says_what_surfaces_hold(e in 0.45f64..0.6, step in 0.05f64..0.1) {
        let cors = [e, e + step, e + 2.0 * step];
        let row = |n: usize| {
            let heights = cors.map(|e| format!("{:.1}", 150.0 * e * e * (1.0 + 0.005 * (n as f64 - 1.0))));
            format!("{},{}", n + 1, heights.join(","))
        };
        let title = "Handball dropped from 150 cm; first rebound height in cm";
        let text = format!("{title}\nTrial,Concrete,Lino,Parquet\n{}", lines((0..4).map(row)));
        let report = fit(&text);
        let found: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
        prop_assert!(found.len() == 3 && found.iter().zip(cors).all(|(a, b)| near(*a, b)), "{text}{report}");
    }
}

/// A file named after a ball's sport is of a ball, where its numbers bounce as one.
#[test]
fn a_file_may_name_the_sport() {
    let text = |times: Vec<f64>| format!("\"Event time (s)\"\n{}", lines(times.into_iter().map(|t| format!("{t:.5}"))));
    let bounces = text(contacts(0.86, (0.5, 0.7), 9));
    for name in ["phyphox_golf_3.csv", "Stopwatch tennis 60cm.csv", "table-tennis.csv"] {
        assert_eq!(named(name, &bounces).verdict(), Verdict::Trusted, "{name}");
    }
    let others = text(vec![0.2, 0.9, 1.4, 2.1, 2.3, 3.0, 3.1]);
    for name in ["stopwatch.csv", "phyphox_golf_3.csv"] {
        assert_ne!(named(name, &others).verdict(), Verdict::Trusted, "{name}");
    }
}

/// Sounds by the times of their peaks, and how loud: contacts; samples of a wave are none.
#[test]
fn peaks_of_a_sound_are_contacts() {
    let rows = contacts(0.66, (1.2, 0.7), 8).into_iter().enumerate();
    let rows = rows.map(|(n, t)| format!("{n},{:.0},{:.2},{:.3}", 44_100.0 * t, 1e3 * t, 0.8 * 0.6f64.powi(n as i32)));
    let report = fit(&format!(",sample,time_ms,amplitude\n{}", lines(rows)));
    assert!(near(report.cor().unwrap().value, 0.66), "{report}");
    let wave = (0..60).map(|n| format!("{:.3},{:.3}", 0.02 * f64::from(n), (0.9 * f64::from(n)).sin()));
    assert!(read(&format!("time_ms,amplitude\n{}", lines(wave))).is_err_and(|e| e.is_question()));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: cases(24), failure_persistence: None, ..ProptestConfig::default() })]

    /// Flights named by the contacts that they lie between, in words or by a dash, are of the ball
    /// that the table names.
    #[test]
    fn flights_lie_between_two_contacts(e in 0.55f64..0.9, form in 0usize..6) {
        let name = ["Time A to B (s)", "time A-B (s)", "Zeit A bis B (s)", "bounce A to B (s)", "t A-B (s)", "interval A to B (s)"];
        let name = |n: usize| name[form].replace('A', &n.to_string()).replace('B', &(n + 1).to_string());
        let header: Vec<String> = (1..5).map(name).collect();
        let row = |drop: i32| {
            let flights = (0..4).map(|k| format!("{:.4}", 0.7 * e.powi(k) * (1.0 + 0.003 * f64::from(drop))));
            format!("{},{}", drop + 2, flights.collect::<Vec<_>>().join(","))
        };
        let text = format!("Lacrosse ball on the lab bench\ntrial,{}\n{}", header.join(","), lines((-1..2).map(row)));
        prop_assert!(near(trusted(&text), e), "{text}");
    }

    /// A comment states the height of release as well as a line of the table does.
    #[test]
    fn comments_state_the_height_of_release(e in 0.5f64..0.85, mark in 0usize..3) {
        let mark = ["# ", "", "// "][mark];
        let row = |n: usize| {
            let heights = [0.0, 0.006, -0.004].map(|off| format!("{:.3}", 1.5 * e * e * (1.0 + off + 0.001 * n as f64)));
            format!("{},{}", n + 1, heights.join(","))
        };
        let text = format!("{mark}Volleyball, all drops from 1.50 m onto the gym floor\nplace,Rebound 1 (m),Rebound 2 (m),Rebound 3 (m)\n{}", lines((0..4).map(row)));
        prop_assert!(near(fit(&text).cor().unwrap().value, e), "{text}");
    }

    /// Bare numbers behind names are in the unit of the line above them.
    #[test]
    fn lists_are_in_the_unit_above_them(e in 0.5f64..0.75, form in 0usize..3) {
        let title = [
            "Rebound heights in cm, dropped from 1.80 m",
            "Dropped from 1.80 m onto lino, rebound read off the chart (cm)",
            "Drop height 1.80 m\nall in cm",
        ][form];
        let list = |e: f64| [0.0, 0.01, -0.01, 0.005].map(|off| format!("{:.0}", 180.0 * e * e * (1.0 + off))).join(", ");
        let text = format!("{title}\n\nred ball: {}\nblue ball: {}\n", list(e), list(e + 0.1));
        let report = fit(&text);
        let found: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
        prop_assert!(found.len() == 2 && near(found[0], e) && near(found[1], e + 0.1), "{text}{report}");
    }
}

/// Times as far apart as one another are no contacts, whatever stands beside them.
#[test]
fn a_clock_of_samples_lists_no_contacts() {
    let rows = (0..60).map(|n| format!("{:.3},{:.2}", 0.001 * f64::from(n), (0.3 * f64::from(n)).sin()));
    for beside in ["Normal Force (N)", "acceleration (m/s²)", "voltage (V)"] {
        assert!(
            read(&format!("# basketball\ntime (s),{beside}\n{}", lines(rows.clone()))).is_err_and(|e| e.is_question())
        );
    }
    // A few contacts may be as far apart as they were read.
    assert!(read("steel ball\ncontact time (s)\n0.2\n0.6\n1.0\n1.4\n").is_ok());
    let text = format!(
        "steel ball\ncontact time (s)\n{}",
        lines(contacts(0.98, (0.2, 0.4), 12).into_iter().map(|t| format!("{t:.4}")))
    );
    assert!(near(trusted(&text), 0.98));
}

/// A gate that says in a sentence when it is blocked stands beside the heights of release.
#[test]
fn a_gate_stands_beside_the_heights_of_release() {
    for (down, up) in [
        ("gate blocked on the way down (ms)", "gate blocked on the way up (ms)"),
        ("Lichtschranke abwärts (ms)", "Lichtschranke aufwärts (ms)"),
        ("photogate time down (ms)", "photogate time up (ms)"),
    ] {
        let row = |n: usize| {
            let h = 0.5 + 0.2 * n as f64;
            let dark = 38.0 / (2.0 * 9.81 * h).sqrt();
            format!("{},{h:.2},{dark:.3},{:.3}", n + 1, dark / 0.76 * (1.0 + 0.004 * [1.0, -1.0, 0.5][n % 3]))
        };
        let text = format!("ball diameter 38 mm\nRun,drop height (m),{down},{up}\n{}", lines((0..6).map(row)));
        assert!(near(trusted(&text), 0.76), "{text}");
    }
}

/// When contacts begin and end, in the words of many languages.
#[test]
fn contacts_begin_and_end() {
    for (name, begins, ends) in [
        ("contact", "begins", "ends"),
        ("Kontakt", "beginnt", "endet"),
        ("contact", "commence", "finit"),
        ("contacto", "empieza", "termina"),
        ("contatto", "inizia", "finisce"),
        ("contato", "começa", "termina"),
        ("contact", "begint", "eindigt"),
        ("kontakt", "börjar", "slutar"),
        ("kontakt", "begynder", "slutter"),
        ("kontakt", "begynner", "slutter"),
        ("kontakt", "początek", "koniec"),
        ("kontakt", "začátek", "konec"),
        ("temas", "başlangıç", "bitiş"),
        ("контакт", "начало", "конец"),
    ] {
        let times = contacts(0.74, (312.0, 610.0), 7);
        let row =
            |(n, t): (usize, &f64)| format!("{};{:.1};{:.1}", n + 1, t + 7.0 * n as f64, t + 7.0 * (n + 1) as f64);
        let rows = lines(times.iter().enumerate().map(row));
        let text = format!("Ball dropped on the floor\nno;{name} {begins} (ms);{name} {ends} (ms)\n{rows}");
        let report = fit(&text);
        assert!(report.groups().is_empty() && near(report.cor().unwrap().value, 0.74), "{text}{report}");
    }
}

/// Labels that span flights, one close behind the other, tell how long these last.
#[test]
fn labels_may_span_the_flights() {
    for (name, count, gap) in [("hop", 5, 0.006), ("Flug", 7, 0.009), ("", 4, 0.004)] {
        let mut at = 0.83;
        let label = |n: usize| {
            let (from, lasts) = (at, 0.62 * 0.81_f64.powi(n as i32));
            at += lasts + gap;
            format!(
                "{from:.6}\t{:.6}\t{}",
                from + lasts,
                if name.is_empty() { String::new() } else { format!("{name} {}", n + 1) }
            )
        };
        let text = lines((0..count).map(label).collect::<Vec<_>>());
        assert!(near(trusted(&text), 0.81), "{text}");
    }
}

/// Times that shrink from column to column by one factor are those between contacts, whatever the
/// columns are called, and so are those of a list of peaks below the name of an instrument; laps
/// are none.
#[test]
fn times_that_shrink_are_those_between_contacts() {
    let row = |n: usize| {
        let cell =
            |k: i32| format!("{:.4}", (0.55 + 0.01 * n as f64) * 0.79_f64.powi(k) * (1.0 + 0.002 * f64::from(k % 2)));
        (0..5).map(cell).collect::<Vec<_>>().join(";")
    };
    let header = |name: &str| (1..6).map(|n| format!("{name} {n} (s)")).collect::<Vec<_>>().join(";");
    let table = |name: &str| format!("{}\n{}", header(name), lines((0..4).map(row)));
    assert!(near(trusted(&table("Time")), 0.79));
    assert_ne!(fit(&table("Lap time")).verdict(), Verdict::Trusted);
    for title in ["Tektronix TBS1052C CH2", "PicoScope 2204A trigger 50 mV", "Hantek DSO2D10, threshold 0.3 V"] {
        let times = contacts(0.9, (0.21, 0.47), 9).into_iter().enumerate();
        let rows = lines(times.map(|(n, t)| format!("{};{t:.5};{}", n + 1, 900 - 60 * n)));
        assert!(near(trusted(&format!("{title}\n\nPeak;Time (s);Amplitude (mV)\n{rows}")), 0.9), "{title}");
    }
}

/// Bodies that were clicked at in the same frames are balls of their own, by the numbers of their
/// tracks.
#[test]
fn tracks_of_one_time_are_balls_of_their_own() {
    let row = |(track, n, h): (usize, usize, f64)| {
        format!("{n}\t{track}\t{}\t{}\t{:.0}\t1.0\t1.0\t200\n", n + 1, 100 + 300 * track, 900.0 - 700.0 * h)
    };
    let films = [(1, ball(|_| 0.83).film(60.0, 2.4)), (2, ball(|_| 0.66).film(60.0, 2.4))];
    let rows = films.iter().flat_map(|(track, film)| film.iter().enumerate().map(|(n, s)| row((*track, n, s.1))));
    let text = format!("\tTrack n°\tSlice n°\tX\tY\tDistance\tVelocity\tPixel Value\n{}", rows.collect::<String>());
    let report = fit(&text);
    let cors: Vec<f64> = report.groups().iter().map(|g| g.report.cor().unwrap().value).collect();
    assert!(matches!(cors.as_slice(), [a, b] if near(*a, 0.83) && near(*b, 0.66)), "{report}");
}

/// Times of day to a part of a second beside places that come many a second are a clock, with a day
/// or not, and whatever else a device sends; what came one by one was written down then.
#[test]
fn stamps_of_samples_are_a_clock() {
    let rows = noisy(&ball(|_| 0.76).film(50.0, 2.4), &mut Noise(9), 2e-3);
    let stamp = |t: f64| format!("11:59:{:06.3}", 12.0 + t);
    let sent = rows.iter().map(|(t, h)| format!("{} -> {:.1} cm", stamp(*t), 100.0 * (1.5 - h)));
    assert!(near(trusted(&format!("# rubber ball below the sensor\n{}", lines(sent))), 0.76));
    let logged = rows.iter().map(|(t, h)| format!("2025-02-03T{};{:.0};ok;{}", stamp(*t), 1e3 * (1.5 - h), 400));
    let report = fit(&format!("# rubber ball\ntimestamp;distance_mm;quality;rssi\n{}", lines(logged)));
    assert!(near(report.cor().unwrap().value, 0.76), "{report}");
    let drops = (0..24).map(|n| format!("2025-02-03T11:{:02}:05.120;{};{}", n, 100, 58 + n % 2));
    let report = fit(&format!("timestamp;drop height (cm);rebound (cm)\n{}", lines(drops)));
    assert!(near(report.cor().unwrap().value, 0.764), "{report}");
}

/// A clock beside places needs no name but its unit, and the rate of frames none at all.
#[test]
fn a_clock_of_a_film_needs_no_name() {
    let rows = noisy(&ball(|_| 0.72).film(60.0, 2.4), &mut Noise(10), 1e-3);
    let frames = |n: usize, (t, h): &(f64, f64)| format!("{n},{:.3},310.5,{:.2}", 1e3 * t, 800.0 - 600.0 * h);
    let text = lines(rows.iter().enumerate().map(|(n, row)| frames(n, row).split_once(',').unwrap().1.to_owned()));
    assert!(near(trusted(&format!("zeit_pts_ms,cx,cy\n{text}")), 0.72));
    let bodies = "Trajectories\n60\n,,Lab:Ball1,,Lab:Corner,\nFrame,Sub Frame,X,Z,X,Z\n,,mm,mm,mm,mm\n";
    let text = lines(rows.iter().enumerate().map(|(n, (_, h))| {
        format!("{n},0,{:.2},{:.2},5.0,{:.2}", 3.0 + 0.01 * n as f64, 1e3 * h, 1.0 + 0.01 * (n % 3) as f64)
    }));
    let report = fit(&format!("{bodies}{text}"));
    assert!(near(report.cor().unwrap().value, 0.72), "{report}");
}

/// Bodies that a program follows in one film, a row for each in each frame or side by side: the
/// ball is the one that moves, in whatever order the rows are, and along whichever axis it falls.
#[test]
fn bodies_of_one_film() {
    for n in 0..cases(24) {
        let mut noise = Noise(u64::from(n) + 77);
        let e = 0.6 + 0.25 * noise.uniform();
        let (rate, scale) = (60.0, 500.0 + 400.0 * noise.uniform());
        // Heights in pixels above the floor, from a fall of 1 m on.
        let (mut heights, mut height, mut speed) = (Vec::new(), 1.0_f64, 0.0_f64);
        for step in 0..200 * 160 {
            speed -= 9.81 / (160.0 * rate);
            height += speed / (160.0 * rate);
            if height < 0.0 && speed < 0.0 {
                (speed, height) = (-e * speed, 0.0);
            }
            if step % 160 == 0 {
                heights.push(scale * height + noise.normal(0.6));
            }
        }
        let rows = || heights.iter().enumerate().map(|(frame, height)| (frame, 950.0 - height));
        let text = match n % 4 {
            0 => {
                let head = "LABEL,ID,TRACK_ID,QUALITY,POSITION_X,POSITION_Y,POSITION_T,FRAME,RADIUS\n\
                            Label,Spot ID,Track ID,Quality,X,Y,T,Frame,R\n,,,(quality),(pixel),(pixel),(sec),,(pixel)\n";
                let spot = |(frame, y): (usize, f64)| {
                    let t = frame as f64 / rate;
                    format!(
                        "ID{frame},{frame},0,40.1,{:.1},{y:.2},{t:.4},{frame},9\nID9{frame},9{frame},1,12,50,700.1,{t:.4},{frame},9\n",
                        200.0 + t
                    )
                };
                // In the order of their quality.
                let mut spots: Vec<String> = rows().map(spot).collect();
                spots
                    .sort_by_key(|spot| spot.bytes().fold(7_u64, |hash, byte| hash.wrapping_mul(31) + u64::from(byte)));
                format!("{head}{}", spots.concat())
            }
            1 => {
                let boxes = |(frame, y): (usize, f64)| {
                    let still = 900.0 + noise.normal(0.4);
                    format!(
                        "{frame},4,person,0.9,100,210,300,{still:.1}\n{frame},7,sports ball,0.8,400,{:.1},430,{y:.1}\n",
                        y - 30.0
                    )
                };
                format!("frame,track_id,class,conf,x1,y1,x2,y2\n{}", rows().map(boxes).collect::<String>())
            }
            2 => {
                let particle = |(frame, y): (usize, f64)| {
                    format!("{},27.1,201,127,255,12.1,{y:.3},12.2,{:.3},0.88,{}\n", frame + 1, y + 0.1, frame + 1)
                };
                format!(" ,Area,Mean,Min,Max,X,Y,XM,YM,Circ.,Slice\n{}", rows().map(particle).collect::<String>())
            }
            _ => {
                let (up, along) = if noise.uniform() < 0.5 { (1, 2) } else { (2, 1) };
                let marker = |(frame, height): (usize, &f64)| {
                    let mut place = [3.0 + noise.normal(0.3), 0.0, 0.0];
                    (place[up], place[along]) = (*height, 80.0 + 0.2 * frame as f64 + noise.normal(0.3));
                    format!(
                        "{}\t{:.3}\t{:.3}\t{:.3}\t{:.3}\n",
                        frame + 1,
                        frame as f64 / rate,
                        place[0],
                        place[1],
                        place[2]
                    )
                };
                let places: String = heights.iter().enumerate().map(marker).collect();
                format!(
                    "PathFileType\t4\t(X/Y/Z)\tdrop.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n60.00\t60.00\t200\t1\tmm\n\
                     Frame#\tTime\tBALL\t\t\n\t\tX1\tY1\tZ1\n\n{places}"
                )
            }
        };
        let report = fit(&text);
        let cor = report.cor().unwrap_or_else(|| panic!("{n} {report}"));
        assert!((cor.value - e).abs() < 0.01, "{n} {e} {report}");
        assert_eq!(report.verdict(), Verdict::Trusted, "{n} {e} {report}");
    }
}

/// A column that stands in a table twice, as the times before each curve, is read once.
#[test]
fn times_before_each_curve() {
    for n in 0..cases(16) {
        let mut noise = Noise(u64::from(n) + 5);
        let e = 0.6 + 0.25 * noise.uniform();
        let (mut t, mut lasts, mut text) = (0.45, 0.9 * e, "Temps (s);Temps (s);Rebond\n".to_owned());
        for bounce in 1..9 {
            text += &format!("{t:.3};{t:.3};{bounce}\n").replace('.', ",");
            (t, lasts) = (t + lasts, e * lasts);
        }
        let report = fit(&text);
        assert!(report.cor().is_some_and(|cor| (cor.value - e).abs() < 0.01), "{n} {e} {report}");
    }
}
