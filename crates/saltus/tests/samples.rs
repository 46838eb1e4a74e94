//! A run as a table: regular times, and both limits at each jump.

use proptest::prelude::*;
use saltus::{Clock, Coords, Hybrid, JumpTable, Sample, Sampler, SamplingError, Simulation};
use saltus_cases::cases;

type Rows = Vec<Sample<&'static str, f64>>;

/// A saw: x' = 1, back to zero at `top`, and 1 added by a clock.
fn saw(top: f64, kick: f64) -> Hybrid<'static, f64> {
    Hybrid::new()
        .mode("rise", |_t, _x: &f64| 1.0)
        .edge("rise", "rise", move |_t, x| top - x, |_t, _x| 0.0)
        .entry(saltus::Entry::Fire)
        .clock("rise", "rise", Clock::every(kick), |_t, x| x + 1.0)
}

proptest! {
    /// The rows of an observer are those of the recorded run; each is the state there; ticks and
    /// ends of arcs are there, each once, in the order of hybrid time.
    #[test]
    fn rows_are_the_run(top in 0.3..3.0_f64, kick in 0.1..2.0_f64, ticks in 1..60_u32, from in -3.0..3.0_f64) {
        let dt = f64::from(ticks) / 32.0;
        let (model, end) = (saw(top, kick), from + 5.0);
        let run = Simulation::of(&model).run("rise", 0.0, from..end).unwrap();
        let mut sampler = Sampler::every(dt);
        Simulation::of(&model).drive("rise", 0.0, from..end, &mut sampler).unwrap();
        let rows: Rows = sampler.rows().collect();
        prop_assert_eq!(&rows, &run.trajectory.sampled(dt).unwrap().rows().collect::<Rows>());
        prop_assert!(rows.windows(2).all(|pair| (pair[0].t, pair[0].j) < (pair[1].t, pair[1].j)));
        for row in &rows {
            let limits = [run.trajectory.at(row.t).unwrap(), run.trajectory.before(row.t).unwrap()];
            let among = run.trajectory.jumps().iter().filter(|jump| jump.t() == row.t).flat_map(|jump| [jump.before, jump.after]);
            prop_assert!(limits.into_iter().chain(among).any(|x| (x - row.state).abs() < 1e-12), "{:?}", row);
        }
        let regular: Vec<f64> = run.trajectory.sampled(dt).unwrap().without_jumps().rows().map(|row| row.t).collect();
        let ticks = (0..).map(|k| f64::from(k).mul_add(dt, from)).take_while(|&t| t <= end);
        prop_assert!(regular.iter().copied().eq(ticks), "{:?}", regular);
        for k in 0.. {
            let t = f64::from(k).mul_add(dt, from);
            if t > end {
                break;
            }
            let mut times: Vec<f64> = rows.iter().map(|row| row.t).filter(|time| (time - t).abs() < 1e-13).collect();
            times.dedup();
            prop_assert_eq!(times.len(), 1, "at {}", t);
        }
        for jump in run.trajectory.jumps() {
            let at = rows.iter().filter(|row| row.t == jump.t() && (row.j == jump.j || row.j + 1 == jump.j));
            prop_assert_eq!(at.map(|row| row.state).collect::<Vec<_>>(), [jump.before, jump.after]);
        }
    }
}

/// The cells of a line of CSV.
fn cells(line: &str) -> Vec<String> {
    let (mut cells, mut quoted) = (vec![String::new()], false);
    for c in line.chars() {
        match c {
            '"' => quoted = !quoted,
            ',' if !quoted => cells.push(String::new()),
            c => cells.last_mut().unwrap().push(c),
        }
    }
    cells
}

proptest! {
    /// A table of jumps has each of them, to the bit, also as an observer that keeps nothing else.
    #[test]
    fn jumps_are_rows(top in 0.3..3.0_f64, kick in 0.1..2.0_f64, from in -3.0..3.0_f64) {
        let model = saw(top, kick);
        let run = Simulation::of(&model).run("rise", 0.0, from..from + 5.0).unwrap();
        let mut observed = JumpTable::new();
        Simulation::of(&model).drive("rise", 0.0, from..from + 5.0, &mut observed).unwrap();
        let text = run.trajectory.jump_table().to_string();
        prop_assert_eq!(&observed.to_string(), &text);
        let mut lines = text.lines();
        let head = "t (s),j,edge,from,to".to_owned() + if run.trajectory.jumps().is_empty() { "" } else { ",x0 before,x0 after" };
        prop_assert_eq!(lines.next(), Some(&*head));
        for jump in run.trajectory.jumps() {
            let row = cells(lines.next().unwrap());
            let numbers = [&row[0], &row[5], &row[6]].map(|cell| cell.parse::<f64>().unwrap());
            prop_assert_eq!(numbers, [jump.t(), jump.before, jump.after]);
            let edge = format!("{:?}", jump.edge().unwrap());
            prop_assert_eq!(&row[1..5], [jump.j.to_string(), edge, "rise".to_owned(), "rise".to_owned()]);
        }
        prop_assert_eq!(lines.next(), None);
    }
}

/// Rows of modes that differ in dimension are as long as the heading; a limit of jumps is named.
#[test]
fn jumps_of_modes_that_differ() {
    let model = Hybrid::new()
        .mode("fly, \"high\"", |_t, x: &Coords<2>| [x[1], -9.8].into())
        .edge("fly, \"high\"", "fly, \"high\"", |_t, x| x[0], |_t, x| [0.0, -0.5 * x[1]].into())
        .mode("rest", |_t, _x| [0.0].into())
        .beyond("fly, \"high\"", "rest", |_t, _x| [0.0].into());
    let run = Simulation::of(&model).run("fly, \"high\"", [1.0, 0.0].into(), 0.0..4.0).unwrap();
    let text = run.trajectory.jump_table().named(["height (m)", "speed"]).to_string();
    let rows: Vec<_> = text.lines().map(cells).collect();
    assert!(rows.iter().all(|row| row.len() == rows[0].len()));
    assert_eq!(rows[0][5..], ["height before (m)", "speed before", "height after (m)", "speed after"]);
    let last = rows.last().unwrap();
    assert_eq!([&*last[2], &*last[3], &*last[4], &*last[7], &*last[8]], ["limit", "fly, high", "rest", "0.0", ""]);
}

/// Runs without duration, without end, and with a step that is none.
#[test]
fn tables_of_odd_runs() {
    let model = saw(1.0, 0.75);
    let rows = |dt: f64, span: std::ops::Range<f64>| -> usize {
        Simulation::of(&model)
            .most_jumps(10)
            .run("rise", 0.0, span)
            .unwrap()
            .trajectory
            .sampled(dt)
            .unwrap()
            .rows()
            .count()
    };
    assert_eq!(rows(0.1, 2.0..2.0), 1);
    assert_eq!(rows(1e300, 0.1..0.7), 2);
    let run = Simulation::of(&model).run("rise", 0.0, 0.1..0.7).unwrap();
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(matches!(run.trajectory.sampled(dt), Err(SamplingError::Interval { .. })));
    }
    // More rows than a table keeps are not cut off.
    assert_eq!(run.trajectory.sampled(1e-8).unwrap_err(), SamplingError::Rows { dt: 1e-8 });
    let rest = Hybrid::new().mode("rest", |_t, _x: &f64| 0.0);
    let run = Simulation::of(&rest).run("rest", 1.0, 0.0..f64::INFINITY).unwrap();
    assert_eq!(run.trajectory.sampled(0.5).unwrap_err(), SamplingError::Rows { dt: 0.5 });
}

/// Headings and cells with commas and quotes are quoted.
#[test]
fn a_table_is_csv() {
    let model = Hybrid::new().mode("a, \"b\"", |_t, _x: &[f64; 2]| [1.0, 0.0]);
    let run = Simulation::of(&model).run("a, \"b\"", [0.0, 1e-300], 0.0..1.0).unwrap();
    let text = run.trajectory.sampled(1.0).unwrap().to_string();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "t (s),j,mode,x0,x1");
    assert_eq!(lines[1], "0.0,0,\"a, \"\"b\"\"\",0.0,1e-300");
    let named = run.trajectory.sampled(1.0).unwrap().named(["a, b (m)"]).to_string();
    assert!(named.starts_with("t (s),j,mode,\"a, b (m)\",x1\n"), "{named}");
}

proptest! {
    /// Where steps and stops end within an arc no row is lost.
    #[test]
    fn rows_at_the_ends_of_steps(
        ticks in 1..40_u32, stops in 1..40_u32, step in prop::option::of(1..40_u32), unit in prop::sample::select(vec![0.1, 0.25, 1.0, 1e-3]),
    ) {
        let (dt, end) = (f64::from(ticks) * unit, 40.0 * unit);
        let model = Hybrid::new()
            .mode("decay", move |_t, x: &f64| -x / unit)
            .stops("decay", Clock::every(f64::from(stops) * unit));
        let simulation = Simulation::of(&model);
        let simulation = step.map_or(simulation, |step| {
            let step = f64::from(step) * unit;
            simulation.longest_step(step).first_step(step)
        });
        let run = simulation.run("decay", 1.0, 0.0..end).unwrap();
        let rows: Rows = run.trajectory.sampled(dt).unwrap().without_jumps().rows().collect();
        let expected = (0..=40 / ticks).map(|k| f64::from(k) * dt);
        prop_assert!(rows.iter().map(|row| row.t).eq(expected), "{:?}", rows);
        prop_assert!(rows.iter().all(|row| (row.state - (-row.t / unit).exp()).abs() < 1e-6));
        let mut sampler = Sampler::every(dt);
        simulation.drive("decay", 1.0, 0.0..end, &mut sampler).unwrap();
        prop_assert!(sampler.without_jumps().rows().eq(rows));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(32)))]

    /// Whatever the time from row to row, be it far below the spacing of times, a table is made or
    /// refused at once: its rows are those ticks that are on no end by rounding.
    #[test]
    fn rows_of_any_interval(
        (sign, start, length, interval) in (-1..=1_i32, -20.0..300.0_f64, -18.0..2.0_f64, -30.0..2.0_f64),
    ) {
        let from = f64::from(sign) * 10_f64.powf(start);
        let to = from + 10_f64.powf(start + length);
        let dt = 10_f64.powf(start + interval);
        let model = Hybrid::new().mode("stand", |_t, _x: &f64| 0.0).exact("stand", |_t, x| [*x].into());
        let run = Simulation::of(&model).run("stand", 1.0, from..to).unwrap();
        let ulp = |t: f64| t.abs().next_up() - t.abs();
        // Four spacings of the later end are an instant; of the start alone the table starts.
        let instant = 4.0 * ulp(from.abs().max(to.abs()));
        let inner = |k: f64| (k.mul_add(dt, from) > from + instant) && (k.mul_add(dt, from) < to - instant);
        let about = (to - from) / dt;
        match run.trajectory.sampled(dt) {
            Err(flaw) => {
                prop_assert_eq!(flaw, SamplingError::Rows { dt });
                prop_assert!(about > 0.99e7, "{about} rows");
            }
            Ok(table) => {
                let skipped = instant / dt;
                prop_assert!(about - 2.0 * skipped < 1.01e7);
                let times: Vec<f64> = table.rows().map(|row| row.t).collect();
                prop_assert_eq!((times[0], times[times.len() - 1]), (from, to));
                prop_assert!(times.windows(2).all(|pair| pair[0] <= pair[1]));
                if about < 1e4 {
                    let between = (1..=about as u64 + 2).map(|k| k as f64).filter(|&k| inner(k)).count();
                    prop_assert_eq!(times.len(), between + 1 + usize::from(to > from));
                } else {
                    let many = (about - 2.0 * skipped).max(0.0);
                    prop_assert!((times.len() as f64 - many).abs() <= 3.0 + ulp(to.abs().max(from.abs())) / dt, "{} and {many}", times.len());
                }
            }
        }
    }
}
