//! How fast, at equal error: the tables of `docs/trust/comparison.md`.

use saltus::{Auto, Dop853, Tsit5};
use saltus_peers::machine;
use saltus_peers::speed::contest::{Problem, fastest, race, sweep};
use saltus_peers::speed::{
    differential_equations, diffsol, floor, ivp, ode_solvers, problems, report, russell_ode, saltus as ours, swarm,
};
use serde_json::{Value, json};

const USAGE: &str = "speed [--json] [--rounds N] [--balls N] [--sweep] [p1 p2 p3 p4 p5 p7 p8 ...]
  --json      print JSON instead of tables
  --rounds N  time each solver N times, in turn (default 25)
  --balls N   balls of p8 (default 100000)
  --sweep     print the error and time of every tolerance tried";

fn problems() -> Vec<Problem> {
    use ivp::Explicit;
    let mut p1 = vec![floor::vacuum(), ours::vacuum_ball(), ours::vacuum_stepped("Tsit5", Tsit5)];
    p1.push(ours::vacuum_stepped("Dop853", Dop853));
    p1.extend(diffsol::vacuum());
    p1.extend(differential_equations::vacuum());
    p1.extend(ivp::vacuum());

    let mut p2 = vec![floor::drag(), ours::drag_ball(), ours::drag_stepped("Auto", Auto::default())];
    p2.push(ours::drag_stepped("Tsit5", Tsit5));
    p2.push(ours::drag_stepped("Dop853", Dop853));
    p2.push(ours::drag_stepped(ours::SERIES, Auto::default()));
    p2.extend(diffsol::drag());
    p2.extend(differential_equations::drag());
    p2.extend(ivp::drag());

    let mut p3 = vec![ours::orbit("Dop853", Dop853), ours::orbit("Tsit5", Tsit5), diffsol::orbit()];
    p3.push(ours::orbit(ours::SERIES, Auto::default()));
    p3.extend(differential_equations::orbit());
    p3.extend([ivp::orbit(Explicit::Dop853), ivp::orbit(Explicit::Dopri5)]);
    p3.extend(ode_solvers::orbit());
    p3.push(russell_ode::orbit());

    let mut p4 = vec![ours::stiff()];
    p4.extend(diffsol::stiff());
    p4.extend(differential_equations::stiff());
    p4.extend(ivp::stiff());
    p4.push(russell_ode::stiff());

    let mut p5 = vec![ours::crossings("Tsit5", Tsit5), ours::crossings("Dop853", Dop853), diffsol::crossings()];
    p5.push(ours::crossings(ours::SERIES, Auto::default()));
    p5.extend(differential_equations::crossings());
    p5.extend(ivp::crossings(Explicit::Dopri5));
    p5.extend(ivp::crossings(Explicit::Dop853));

    let problem = |name, title, error, entries, per| Problem { name, title, error, entries, per };
    vec![
        problem("p1", "P1, ten bounces under gravity", problems::vacuum_error, p1, 1.0),
        problem("p2", "P2, twenty bounces under quadratic drag", problems::drag_error, p2, 1.0),
        problem("p3", "P3, Arenstorf orbit", problems::arenstorf_error, p3, 1.0),
        problem("p4", "P4, Van der Pol, stiff", problems::van_der_pol_error, p4, 1.0),
        problem(
            "p5",
            "P5, a thousand crossings of an oscillator, per crossing",
            problems::crossings_error,
            p5,
            problems::CROSSINGS as f64,
        ),
    ]
}

/// What to do.
struct Options {
    json: bool,
    sweep: bool,
    rounds: usize,
    balls: usize,
    only: Vec<String>,
}

impl Options {
    fn wants(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|only| only == name)
    }
}

fn options() -> Result<Options, String> {
    let mut options = Options { json: false, sweep: false, rounds: 25, balls: 100_000, only: Vec::new() };
    let mut args = std::env::args().skip(1);
    while let Some(arg) = args.next() {
        let mut number = || args.next().and_then(|n| n.parse().ok()).ok_or(format!("{arg} wants a number"));
        match arg.as_str() {
            "--json" => options.json = true,
            "--sweep" => options.sweep = true,
            "--rounds" => options.rounds = number()?,
            "--balls" => options.balls = number()?,
            p if p.starts_with('p') => options.only.push(arg),
            _ => return Err(format!("{arg} is not known\n\n{USAGE}")),
        }
    }
    Ok(options)
}

fn main() {
    let options = match options() {
        Ok(options) => options,
        Err(message) => {
            eprintln!("{message}");
            std::process::exit(2);
        }
    };
    let versions: Vec<_> = machine::versions().iter().map(|(name, version)| format!("{name} {version}")).collect();
    let mut output = vec![json!({ "processor": machine::processor(), "versions": versions })];
    if !options.json {
        println!("{}; {}", machine::processor(), versions.join(", "));
    }
    for problem in problems().iter().filter(|problem| options.wants(problem.name)) {
        contest(problem, &options, &mut output);
    }
    if options.wants("p7") {
        between_steps(&options, &mut output);
    }
    if options.wants("p8") {
        swarm(&options, &mut output);
    }
    if options.json {
        println!("{}", Value::Array(output));
    }
}

fn contest(problem: &Problem, options: &Options, output: &mut Vec<Value>) {
    let sweeps: Vec<_> = problem
        .entries
        .iter()
        .map(|entry| {
            eprintln!("{} {} {} {}", problem.name, entry.solver, entry.method, entry.events.name());
            sweep(problem, entry)
        })
        .collect();
    if options.sweep {
        for (entry, trials) in problem.entries.iter().zip(&sweeps) {
            println!("\n{} {} {} {}", problem.name, entry.solver, entry.method, entry.events.name());
            for trial in trials {
                println!(
                    "{:8.0e} {:9.1e} {:>9} {:>8}",
                    trial.tolerance,
                    trial.error,
                    report::time(trial.seconds),
                    trial.flows
                );
            }
        }
    }
    for bound in [1e-6, 1e-10] {
        let chosen: Vec<_> = sweeps.iter().map(|trials| fastest(trials, bound)).collect();
        let results = race(problem, &chosen, options.rounds);
        if !options.json {
            print!("{}", report::table(problem, bound, &results));
        }
        output.push(report::json(problem, bound, &results));
    }
}

/// P7: two crossings between the ends of a step, and a guard that swings ever faster.
fn between_steps(options: &Options, output: &mut Vec<Value>) {
    const PLACES: usize = 200;
    const APART: f64 = 2e-3;
    const TOLERANCE: f64 = 1e-8;
    let pair = |i: usize| 0.049 * (i as f64 + 0.5);
    let chirp: Vec<f64> = (1..=636).map(|k| (f64::from(k) * std::f64::consts::PI / 20.0).sqrt()).collect();
    type Watch = fn(Box<dyn Fn(f64) -> f64>, f64) -> Vec<f64>;
    let solvers: [(&str, Watch); 4] = [
        ("saltus", |g, tolerance| ours::watched(g, tolerance)),
        ("diffsol", |g, tolerance| diffsol::watched(g, tolerance)),
        ("differential-equations", |g, tolerance| differential_equations::watched(g, tolerance)),
        ("ivp", |g, tolerance| ivp::watched(g, tolerance)),
    ];
    if !options.json {
        println!("\n### P7, crossings between the ends of a step, no limit on the step\n");
        println!(
            "| solver | both of a pair, of {PLACES} | worst error | crossings of the chirp, of {} | worst error | CPU time of the chirp |",
            chirp.len()
        );
        println!("|---|---|---|---|---|---|");
    }
    let found = |times: &[f64], exact: &[f64]| -> Option<f64> {
        (times.len() == exact.len()).then(|| times.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max))
    };
    // Some panic: that is no crossing found.
    std::panic::set_hook(Box::new(|_| {}));
    for (name, watch) in solvers {
        let watch = |g: Box<dyn Fn(f64) -> f64>| {
            std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| watch(g, TOLERANCE))).unwrap_or_default()
        };
        let pairs: Vec<f64> = (0..PLACES)
            .filter_map(|i| {
                let a = pair(i);
                let times = watch(Box::new(move |t| (t - a) * (t - (a + APART))));
                found(&times, &[a, a + APART]).filter(|error| *error < 1e-6)
            })
            .collect();
        let start = cpu_time::ThreadTime::now();
        let times = watch(Box::new(|t| (20.0 * t * t).sin()));
        let seconds = start.elapsed().as_secs_f64();
        // A crossing counts if one was reported within a microsecond; the root at the start is
        // nobody's.
        let hits = chirp.iter().filter(|&&t| times.iter().any(|s| (s - t).abs() < 1e-6)).count();
        let worst = pairs.iter().copied().fold(0.0, f64::max);
        let chirped = found(&times, &chirp);
        let shown = |error: Option<f64>| error.map_or(String::new(), |error| format!("{error:.1e}"));
        if !options.json {
            println!(
                "| {name} | {} | {} | {hits} | {} | {} |",
                pairs.len(),
                shown((!pairs.is_empty()).then_some(worst)),
                shown(chirped),
                report::time(seconds),
            );
        }
        output.push(json!({
            "problem": "p7", "solver": name, "pairs": pairs.len(), "chirp": hits, "error": chirped, "seconds": seconds,
        }));
    }
    let _ = std::panic::take_hook();
}

/// P8: each way at the loosest tolerance that gets every count right.
fn swarm(options: &Options, output: &mut Vec<Value>) {
    let truth = swarm::truth(options.balls);
    let impacts: usize = truth.iter().sum();
    let mut rows = Vec::new();
    for way in swarm::ways() {
        let tolerances: &[f64] = if way.tolerant { &[1e-8, 1e-9, 1e-10, 1e-11] } else { &[0.0] };
        let mut best: Option<swarm::Swarm> = None;
        for &tolerance in tolerances {
            let run = swarm::run(&way, &truth, tolerance);
            eprintln!("p8 {} {} {tolerance:e}: {} wrong, {:.2} s", way.solver, way.method, run.wrong, run.cpu);
            if best.is_none_or(|best| run.wrong < best.wrong) {
                best = Some(run);
            }
            if run.wrong == 0 {
                break;
            }
        }
        rows.extend(best.map(|best| (way, best)));
    }
    // Again, in turn: the least of three.
    for _ in 0..2 {
        for (way, best) in &mut rows {
            let run = swarm::run(way, &truth, best.tolerance);
            best.cpu = best.cpu.min(run.cpu);
            best.wall = best.wall.min(run.wall);
        }
    }
    rows.sort_by(|a, b| a.1.cpu.total_cmp(&b.1.cpu));
    let peer = rows.iter().filter(|(way, run)| !["saltus", "floor"].contains(&way.solver) && run.wrong == 0);
    let peer = peer.map(|(_, run)| run.cpu).min_by(f64::total_cmp);
    let floor = rows.iter().find(|(way, _)| way.solver == "floor").map(|(_, run)| run.cpu);
    if !options.json {
        println!("\n### P8, {} balls, {impacts} impacts\n", options.balls);
        println!(
            "| solver | method | rtol = atol | wrong counts | CPU time, all cores | wall | to best peer | to floor |"
        );
        println!("|---|---|---|---|---|---|---|---|");
    }
    for (way, run) in rows {
        let against = |other: Option<f64>| other.map_or(String::new(), |other| report::ratio(run.cpu, other));
        if !options.json {
            println!(
                "| {} | {} | {} | {} | {} | {} | {} | {} |",
                way.solver,
                way.method,
                if way.tolerant { format!("{:.0e}", run.tolerance) } else { String::new() },
                run.wrong,
                report::time(run.cpu),
                report::time(run.wall),
                against(peer),
                against(floor),
            );
        }
        output.push(json!({
            "problem": "p8", "solver": way.solver, "method": way.method, "tolerance": run.tolerance,
            "impacts": run.impacts, "wrong": run.wrong, "cpu": run.cpu, "wall": run.wall,
        }));
    }
}
