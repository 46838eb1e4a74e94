//! Right or wrong: the second table of `docs/trust/comparison.md`.
//!
//! Each case runs for each solver in a process of its own, which is ended after a while: some never
//! come back.

use std::io::Read;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use saltus_peers::machine;
use saltus_peers::right::cases::{CASES, Case};
use saltus_peers::right::{SOLVERS, Solver, TOLERANCE, split_in_two};
use serde_json::json;

const USAGE: &str = "right [--json]";
/// How long a solver may take for one case, in seconds.
const PATIENCE: u64 = 20;

/// What became of a case.
struct Verdict {
    right: bool,
    text: String,
}

impl Verdict {
    fn wrong(text: impl Into<String>) -> Self {
        Self { right: false, text: text.into() }
    }

    fn cell(&self) -> String {
        match (self.right, self.text.is_empty()) {
            (true, true) => "right".into(),
            (true, false) => format!("right: {}", self.text),
            (false, _) => self.text.clone(),
        }
    }
}

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let args: Vec<&str> = args.iter().map(String::as_str).collect();
    match args[..] {
        ["--child", case, solver] => child(case, solver),
        [] => all(false),
        ["--json"] => all(true),
        _ => {
            eprintln!("{USAGE}");
            std::process::exit(2);
        }
    }
}

fn all(as_json: bool) {
    let versions: Vec<_> = machine::versions();
    let version = |name: &str| versions.iter().find(|(other, _)| *other == name).map_or("?", |(_, version)| version);
    if !as_json {
        let heads: Vec<_> = SOLVERS.iter().map(|s| format!("{} {}, {}", s.name, version(s.name), s.method)).collect();
        println!("{}; rtol = atol = {TOLERANCE:e}\n", machine::processor());
        println!("| | right | {} |", heads.join(" | "));
        println!("|---|---|{}", "---|".repeat(SOLVERS.len()));
    }
    let mut rows = Vec::new();
    for case in &CASES {
        let verdicts = SOLVERS.each_ref().map(|solver| verdict(case, solver));
        if !as_json {
            let cells = verdicts.each_ref().map(Verdict::cell);
            println!("| {} | {} | {} |", case.title, case.right, cells.join(" | "));
        }
        rows.extend(SOLVERS.iter().zip(&verdicts).map(|(solver, verdict)| {
            json!({ "case": case.name, "solver": solver.name, "right": verdict.right, "text": verdict.text })
        }));
    }
    let split = match split_in_two() {
        Ok((2, sum)) if (sum - std::f64::consts::E).abs() < 1e-9 => "right".into(),
        other => format!("{other:?}"),
    };
    if as_json {
        rows.push(json!({ "case": "dimension", "solver": "saltus", "right": split == "right", "text": split }));
        println!("{}", serde_json::Value::Array(rows));
    } else {
        println!(
            "| one coordinate becomes two at a jump | sum e after 1 s | {split} | cannot be said | cannot be said | cannot be said |"
        );
    }
}

/// Runs a case in a child process, and waits for it with patience.
fn verdict(case: &Case, solver: &Solver) -> Verdict {
    let spawned = std::env::current_exe().and_then(|path| {
        let mut command = Command::new(path);
        command.args(["--child", case.name, solver.name]).stdout(Stdio::piped()).stderr(Stdio::null()).spawn()
    });
    let mut child = match spawned {
        Ok(child) => child,
        Err(error) => return Verdict::wrong(error.to_string()),
    };
    let start = Instant::now();
    while child.try_wait().is_ok_and(|status| status.is_none()) {
        if start.elapsed() > Duration::from_secs(PATIENCE) {
            let _ = child.kill();
            let _ = child.wait();
            return Verdict::wrong(format!("no answer in {PATIENCE} s"));
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    let mut said = String::new();
    let read = child.stdout.take().map(|mut out| out.read_to_string(&mut said));
    match (read, said.trim().split_once('\t').or_else(|| said.trim().eq("right").then_some(("right", "")))) {
        (Some(Ok(_)), Some((word, text))) => Verdict { right: word == "right", text: text.into() },
        _ => Verdict::wrong("ends without a word"),
    }
}

/// Runs a case here and says what became of it: "right" or "wrong", a tab, and a text.
fn child(case: &str, solver: &str) {
    let case = CASES.iter().find(|other| other.name == case);
    let solver = SOLVERS.iter().find(|other| other.name == solver);
    let (Some(case), Some(solver)) = (case, solver) else { std::process::exit(2) };
    std::panic::set_hook(Box::new(|_| {}));
    let mut wrong: Vec<String> = Vec::new();
    let mut panics = 0;
    let mut said = String::new();
    for run in 0..case.runs {
        let Ok(answer) = std::panic::catch_unwind(|| (solver.run)(&(case.system)(run))) else {
            panics += 1;
            wrong.push("panics".into());
            continue;
        };
        match &answer.error {
            Some(error) if case.refusal => said = short(error),
            Some(error) => wrong.push(match answer.events.len() {
                0 => format!("error: {}", short(error)),
                n => format!("error after {n} events: {}", short(error)),
            }),
            None => {}
        }
        if case.refusal || answer.error.is_none() {
            wrong.extend((case.wrong)(run, &answer));
        }
    }
    let panicked = if panics > 0 { format!(", {panics} panics") } else { String::new() };
    match (&wrong[..], case.runs) {
        ([], _) => println!("right\t{said}"),
        ([first, ..], 1) => println!("wrong\t{first}"),
        (some, runs) => println!("wrong\t{} of {runs} right{panicked}", runs - some.len()),
    }
}

/// The first sentence of a message.
fn short(message: &str) -> String {
    let end = message.find([':', '\n']).unwrap_or(message.len());
    message[..end].chars().take(90).collect()
}
