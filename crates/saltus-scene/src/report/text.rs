//! A run as a table of impacts for people.

use std::fmt::{self, Write};

use crate::plan::{Impact, Record, With};

/// The numbers of first and of last impacts that the text lists where there are many.
const LISTED: (usize, usize) = (20, 3);

/// The impacts as a table for people, and how the run ends.
impl fmt::Display for Record {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&text(self))
    }
}

fn text(record: &Record) -> String {
    let impacts = record.impacts();
    let named = record.balls() > 1 || record.scene().floors.len() > 1;
    let timed = impacts.iter().any(|impact| impact.press.is_some());
    let width = impacts.iter().map(|impact| what(record, impact).chars().count()).max().unwrap_or(0).max(22);
    let mut text = format!("{:>6} {:>14}", "impact", "time (s)");
    if named {
        let _ = write!(text, "  {:<width$}", "what");
    }
    let _ = write!(text, " {:>16} {:>17}", "before (m/s)", "after (m/s)");
    let _ = if timed {
        writeln!(text, " {:>10} {:>13} {:>13}", "COR", "time (s)", "force (N)")
    } else {
        writeln!(text, " {:>13}", "apex (m)")
    };
    let hidden = if impacts.len() > LISTED.0 + LISTED.1 + 1 { LISTED.0..impacts.len() - LISTED.1 } else { 0..0 };
    let apexes: Vec<_> = (0..record.balls()).map(|ball| record.apexes(ball)).collect();
    for (index, impact) in impacts.iter().enumerate() {
        if hidden.contains(&index) {
            if index == hidden.start {
                let _ = writeln!(text, "{:>6} ({} more)", "...", hidden.len());
            }
            continue;
        }
        let _ = write!(text, "{:>6} {:>14.9}", index + 1, impact.t);
        if named {
            let _ = write!(text, "  {:<width$}", what(record, impact));
        }
        let rebound = impact.rebound.map_or_else(|| "-".to_owned(), figure);
        let _ = write!(text, " {:>16} {rebound:>17}", figure(-impact.approach));
        let _ = match impact.press {
            Some(press) => writeln!(
                text,
                " {:>10} {:>13} {:>13}",
                impact.cor().map_or_else(|| "-".to_owned(), |cor| format!("{cor:.6}")),
                press.duration.map_or_else(|| "-".to_owned(), figure),
                figure(press.force)
            ),
            None => {
                let next = impacts[index + 1..].iter().find(|next| next.ball == impact.ball);
                let until = next.map_or(f64::INFINITY, |next| next.t);
                let apex = apexes[impact.ball].iter().find(|apex| apex.t >= impact.t && apex.t <= until);
                writeln!(text, " {:>13}", apex.map_or_else(|| "-".to_owned(), |apex| figure(apex.height)))
            }
        };
    }
    text += &ending(record);
    text
}

/// The end of the run, and each ball then.
fn ending(record: &Record) -> String {
    let end = record.until();
    let mut text = String::new();
    match record.rest() {
        Some(rest) => {
            let _ = writeln!(text, "\nAt rest from {rest:.9} s; the run ends at {end:.9} s.");
        }
        None => {
            let _ = write!(text, "\nThe run ends at {end:.9} s");
            for ball in 0..record.balls() {
                let which =
                    if record.balls() > 1 { format!(", {}", record.scene().ball_name(ball)) } else { String::new() };
                if let (Some(mode), Some(moment)) = (record.mode(ball, end), record.at(ball, end)) {
                    let _ = write!(text, "{which}, {} at {} m", doing(mode), figure(moment.height()));
                }
            }
            text.push_str(".\n");
        }
    }
    text
}

/// The two sides of an impact.
fn what(record: &Record, impact: &Impact) -> String {
    let on = match impact.with {
        With::Ball(other) => record.scene().ball_name(other),
        With::Floor(floor) => {
            let name = record.scene().floors.get(floor).and_then(|floor| floor.name.clone());
            name.unwrap_or_else(|| format!("floor {}", floor + 1))
        }
    };
    if record.balls() > 1 { format!("{} on {on}", record.scene().ball_name(impact.ball)) } else { on }
}

fn doing(mode: &str) -> &str {
    match mode {
        "flight" | "rising" | "falling" | "fall" | "rise" => "in flight",
        "rest" | "lying" => "resting",
        "slide" => "sliding",
        "hold" => "lying or rolling",
        "compression" => "being pressed in",
        "restitution" => "springing back",
        other => other,
    }
}

/// Six decimals where the number has its digits there, else powers of ten.
fn figure(value: f64) -> String {
    if value == 0.0 || (1e-4..1e6).contains(&value.abs()) {
        format!("{:.6}", value + 0.0)
    } else {
        format!("{value:.5e}")
    }
}
