//! Samples of sensors that feel a ball hit: force plates, load cells, piezos. Contacts whose begin,
//! end and force are known are found in what such a sensor would show, and nothing else is taken
//! for them.

use std::f64::consts::PI;

use crate::noise::Noise;
use crate::typed::{fit, read, trusted};
use saltus_fit::{Note, Part, Report, Source, Verdict, Why};

/// What a ball shows a sensor: the rate and the number of its samples, the COR and how far it
/// scatters, how long the first contact lasts and its peak, the noise.
#[derive(Clone, Copy)]
struct Ball {
    rate: f64,
    count: usize,
    cor: f64,
    scatter: f64,
    lasts: f64,
    peak: f64,
    noise: f64,
    /// The force of a contact from its begin to its end, and what the plate does after it.
    form: fn(f64) -> f64,
    /// What there is beside the ball, at a time.
    beside: fn(f64) -> f64,
    /// How much the ball that lies on the plate weighs; none where it rolls off.
    rests: f64,
}

const BALL: Ball = Ball {
    rate: 1000.0,
    count: 4000,
    cor: 0.75,
    scatter: 0.0,
    lasts: 0.014,
    peak: 480.0,
    noise: 0.6,
    form: sine,
    beside: |_| 0.0,
    rests: 6.0,
};

fn sine(x: f64) -> f64 {
    if (0.0..1.0).contains(&x) { (PI * x).sin() } else { 0.0 }
}

impl Ball {
    /// Contacts as begin, duration, and the part of the first speed.
    fn contacts(&self) -> Vec<(f64, f64, f64)> {
        let mut noise = Noise(11);
        let (mut at, mut speed, mut found) = (0.347, 1.0, Vec::new());
        while speed * 0.9 > 2.0 * self.lasts {
            let lasts = self.lasts * f64::powf(speed, -0.1);
            found.push((at, lasts, speed));
            speed *= self.cor * (1.0 + noise.normal(self.scatter));
            at += lasts + 0.9 * speed;
        }
        found
    }

    fn samples(&self) -> Vec<(f64, f64)> {
        let (contacts, mut noise) = (self.contacts(), Noise(5));
        let end = contacts.last().map_or(f64::INFINITY, |(at, lasts, _)| at + lasts);
        let shown = |n: usize| {
            let t = n as f64 / self.rate;
            let felt = contacts.iter().map(|(at, lasts, speed)| self.peak * speed * (self.form)((t - at) / lasts));
            let rests = if t > end { self.rests } else { 0.0 };
            (t, felt.sum::<f64>() + rests + (self.beside)(t) + noise.normal(self.noise))
        };
        (0..self.count).map(shown).collect()
    }

    fn text(&self, header: &str) -> String {
        table(header, &self.samples())
    }
}

/// A table below its names, as these are parted: with decimal commas between semicolons, and in ms
/// where a name says so.
fn table(header: &str, samples: &[(f64, f64)]) -> String {
    let mark = [';', '\t', ','].into_iter().find(|&mark| header.contains(mark)).unwrap();
    let times = if header.contains("ms") { 1e3 } else { 1.0 };
    let row = |&(t, x): &(f64, f64)| {
        let row = format!("{:.4}{mark}{x:.3}\n", times * t);
        if mark == ';' { row.replace('.', ",") } else { row }
    };
    format!("{header}\n{}", samples.iter().map(row).collect::<String>())
}

fn cor(report: &Report) -> f64 {
    report.cor().unwrap_or_else(|| panic!("{report}")).value
}

/// Whether a table is asked about, or has no COR.
fn refused(text: &str) -> bool {
    read(text).is_err_and(|error| error.is_question())
}

/// Contacts are the pulses of a sensor, whatever it is called, in any unit, at any rate.
#[test]
fn pulses_of_a_sensor_are_contacts() {
    let cases: [(&str, Ball); 16] = [
        ("Time (s),Fz (N)", BALL),
        ("\"Time (s) Run #1\",\"Normal Force (N) Run #1\"", Ball { noise: 0.2, ..BALL }),
        ("Zeit in s;Kraft in N", Ball { rate: 500.0, cor: 0.8, beside: |_| 11.7, ..BALL }),
        ("temps (s);Force verticale (N)", Ball { rate: 2000.0, count: 8000, beside: |t| 3.0 * t, ..BALL }),
        ("Tiempo (s),Fuerza (kN)", Ball { cor: 0.6, peak: 1.2, noise: 0.002, rests: 0.01, ..BALL }),
        ("Tempo (s)\tForza (N)", Ball { lasts: 0.004, rate: 10_000.0, count: 40_000, cor: 0.7, ..BALL }),
        ("Время (с),Сила (Н)", Ball { lasts: 0.03, cor: 0.65, ..BALL }),
        ("時間 (s),力 (N)", Ball { rate: 250.0, count: 1000, ..BALL }),
        ("Time (s),Force (lbf)", Ball { rate: 200.0, count: 700, cor: 0.7, lasts: 0.02, ..BALL }),
        (
            "Time (ms),Voltage (V)",
            Ball { lasts: 0.005, rate: 5000.0, count: 30_000, cor: 0.88, peak: 2.5, noise: 0.004, rests: 0.0, ..BALL },
        ),
        ("time_ms,adc", Ball { beside: |_| 21.0, ..BALL }),
        ("time_ms,level", Ball { beside: |_| 512.0, ..BALL }),
        ("Time,Load cell (counts)", Ball { beside: |_| 8312.0, peak: 9000.0, noise: 12.0, rests: 90.0, ..BALL }),
        ("Time (s),Fz (N)", Ball { peak: -480.0, rests: -6.0, ..BALL }),
        ("Time (s),Fz (N)", Ball { form: |x| sine(x).powf(1.5), cor: 0.55, ..BALL }),
        ("Time (s),Fz (N)", Ball { beside: |t| if t < 0.2 { 6.0 } else { 0.0 }, cor: 0.85, count: 6000, ..BALL }),
    ];
    for (header, ball) in cases {
        let found = trusted(&ball.text(header));
        assert!((found - ball.cor).abs() < 0.004, "{header}: {found} for {}", ball.cor);
    }
}

/// A plate that rings, and what swings both ways: they begin where the contacts do.
#[test]
fn what_rings_begins_with_the_contact() {
    let plate: fn(f64) -> f64 = |x| sine(x) + if x > 0.0 { 0.1 * (-0.5 * x).exp() * (14.0 * x).sin() } else { 0.0 };
    let piezo: fn(f64) -> f64 = |x| if x > 0.0 { (-0.25 * x).exp() * (2.5 * x).sin() } else { 0.0 };
    for (header, ball) in [
        ("Time (s),Fz (N)", Ball { form: plate, ..BALL }),
        ("Time (s),Piezo (V)", Ball { form: piezo, lasts: 0.001, peak: 3.0, noise: 0.01, rests: 0.0, ..BALL }),
        (
            "Second,Volt",
            Ball { form: piezo, lasts: 0.001, rate: 8000.0, count: 28_000, peak: 3.0, noise: 0.01, rests: 0.0, ..BALL },
        ),
    ] {
        let report = fit(&ball.text(header));
        assert!((cor(&report) - ball.cor).abs() < 0.006, "{header}: {}\n{report}", cor(&report));
    }
}

/// Of several components that with the largest pulses is read; what is left, and pulses that are no
/// contacts, are named.
#[test]
fn what_is_felt_and_not_used_is_named() {
    let knocked = Ball { beside: |t| 150.0 * sine((t - 0.65) / 0.012), ..BALL };
    let (up, mut noise) = (knocked.samples(), Noise(8));
    let row = |&(t, z): &(f64, f64)| {
        format!("{t:.3},{:.3},{:.3},{z:.3},21.5\n", 0.02 * z + noise.normal(0.5), noise.normal(0.4))
    };
    let rows: String = up.iter().map(row).collect();
    let text = format!("Plate export\nTime (s),Fx (N),Fy (N),Fz (N),Temperature (°C)\n{rows}");
    let table = read(&text).unwrap();
    let left = |what: Part, name: &str, why: Why| {
        table.left_aside().iter().any(|aside| aside.what == what && aside.name.starts_with(name) && aside.why == why)
    };
    assert!(
        left(Part::Column, "Fx", Why::Fainter) && left(Part::Column, "Fy", Why::Fainter),
        "{:?}",
        table.left_aside()
    );
    assert!(
        left(Part::Column, "Temp", Why::Other) && left(Part::Pulse, "0.65", Why::NoBounce),
        "{:?}",
        table.left_aside()
    );
    let felt = |note: &Note| matches!(note, Note::Felt { column, .. } if column.starts_with("Fz"));
    let aloft = |note: &Note| matches!(note, Note::Aloft { contact_s } if (contact_s - 0.016).abs() < 0.003);
    assert!(table.notes().iter().any(|n| felt(&n.kind)) && table.notes().iter().any(|n| aloft(&n.kind)));
    assert!((cor(&fit(&text)) - 0.75).abs() < 0.004);
}

/// Bounces that scatter show by how much, if they are many; of few the samples tell the error.
#[test]
fn few_pulses_are_known_as_well_as_they_are_sampled() {
    let many = fit(&Ball { scatter: 0.01, cor: 0.8, ..BALL }.text("Time (s),Fz (N)"));
    assert_eq!((many.verdict(), many.sigma_time().unwrap().source), (Verdict::Trusted, Source::Scatter), "{many}");
    let few = fit(&Ball { cor: 0.5, ..BALL }.text("Time (s),Fz (N)"));
    let smooth = fit(&BALL.text("Time (s),Fz (N)"));
    assert!(smooth.sigma_time().is_some_and(|s| s.source == Source::Table), "{smooth}");
    assert!(few.sigma_time().is_some_and(|s| s.source == Source::Table && s.value < 1e-3), "{few}");
    assert!((cor(&few) - 0.5).abs() < 0.004, "{few}");
}

/// What has no pulses, or fewer than three, or such as come at any time, or longer ones the slower
/// the ball is, is asked about as samples are.
#[test]
fn what_a_sensor_shows_is_no_ball_by_itself() {
    let knocks = |times: &[f64], lasts: f64| {
        let mut noise = Noise(3);
        let at = |t: f64| times.iter().map(|at| 300.0 * sine((t - at) / lasts)).sum::<f64>();
        let samples: Vec<(f64, f64)> =
            (0..4000).map(|n| 1e-3 * f64::from(n)).map(|t| (t, at(t) + noise.normal(1.0))).collect();
        table("time (s),force (N)", &samples)
    };
    assert!(refused(&knocks(&[], 0.01)) && refused(&knocks(&[0.5, 1.1], 0.01)));
    assert!(!refused(&knocks(&[0.5, 1.1, 1.5], 0.01)));
    let beats: Vec<f64> = (0..8).map(|n| 0.3 + 0.5 * f64::from(n)).collect();
    assert!(refused(&knocks(&beats, 0.02)));
    assert!(refused(&knocks(&[0.31, 0.37, 0.9, 1.34, 1.41, 1.99, 2.6, 2.71, 3.3, 3.62], 0.03)));
    // The third pulse hardly stands out.
    assert!(refused(&Ball { cor: 0.6, noise: 20.0, ..BALL }.text("time (s),force (N)")));
    let load = Ball { peak: 0.0, ..BALL };
    assert!(refused(&Ball { beside: |t| if t > 1.0 { 800.0 } else { 0.0 }, ..load }.text("time (s),force (N)")));
    assert!(refused(&Ball { beside: |t| 700.0 * (5.0 * t).sin(), ..load }.text("time (s),Fz (N)")));
    // Samples too far apart to see contacts.
    assert!(refused(&Ball { rate: 60.0, count: 240, lasts: 0.05, ..BALL }.text("time (s),Fz (N)")));
    // A beam that the ball blocks, on the way down and up, and light and heat.
    let beam: fn(f64) -> f64 = |t| {
        let (mut at, mut speed) = (0.4, 4.0);
        let blocks = |from: f64, speed: f64| (from..from + 0.04 / speed).contains(&t);
        for _ in 0..7 {
            if blocks(at - 0.05 / speed, speed) || blocks(at + 0.05 / (0.8 * speed), 0.8 * speed) {
                return -4.8;
            }
            (at, speed) = (at + 0.16 * speed, 0.8 * speed);
        }
        0.0
    };
    assert!(refused(&Ball { beside: beam, noise: 0.01, ..load }.text("time (s),signal (V)")));
    for header in ["time (s),light (lux)", "time (s),photogate (V)"] {
        assert!(refused(&BALL.text(header)), "{header}");
    }
    // A film is one, whatever its places look like.
    let film = read(&BALL.text("time (s),y (mm)")).map(|table| saltus_fit::Fit::new().run(&table));
    assert!(!matches!(film, Ok(Ok(report)) if report.verdict() == Verdict::Trusted));
}
