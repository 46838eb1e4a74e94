//! Every number that stands behind an option, from zero to beyond what can be right: a result, or
//! an error that says the range.

use std::process::Command;

use crate::tool::{root, saltus, text};

const VALUES: [&str; 12] =
    ["0", "-1", "0.5", "1e-300", "1e-30", "1e-9", "1e6", "299792458", "1e12", "1e300", "nan", "inf"];
/// Words of libraries, and digits that nobody reads.
const JARGON: [&str; 4] = ["invalid digit", "in string", "..=", "0000000000000000000000000000000000"];

/// Runs the command with each value behind the option.
fn each(option: &str, unit: &str, command: impl Fn() -> Command) {
    for value in VALUES {
        let output = command().arg(format!("{option}={value}{unit}")).output().unwrap();
        let says = text(&output.stderr);
        let here = format!("{option}={value}{unit}: {says}");
        match output.status.code() {
            Some(0) => assert!(!output.stdout.is_empty(), "{here}"),
            Some(2) => {
                let whole = says.contains("whole number from") || says.contains("number from");
                let range = [
                    "at most",
                    "above zero",
                    "more than",
                    "or more",
                    "such as",
                    "within",
                    "longer",
                    "from",
                    "the motion has",
                ];
                assert!(whole || range.iter().any(|word| says.contains(word)), "{here}");
            }
            _ => panic!("{here}"),
        }
        assert!(JARGON.iter().all(|word| !says.contains(word)), "{here}");
    }
    // Behind a space a minus is the value's, and not another option; only a hop wants its `=`.
    if option != "--loop" {
        let value = format!("-1{unit}");
        let says = text(&command().args([option, &value]).output().unwrap().stderr);
        assert!(!says.contains("unexpected argument"), "{option} {value}: {says}");
    }
}

#[test]
fn simulate() {
    let drop = |own: &'static str| {
        move || {
            let mut command = saltus();
            command.args(["simulate", "--format", "json"]);
            for other in ["--drop=1m", "--cor=0.7", "--until=2s"] {
                if !other.starts_with(own) {
                    command.arg(other);
                }
            }
            command
        }
    };
    for (option, unit) in [
        ("--drop", "m"),
        ("--cor", ""),
        ("--velocity", "m/s"),
        ("--gravity", "m/s^2"),
        ("--until", "s"),
        ("--most-jumps", ""),
        ("--every", "s"),
        ("--fps", ""),
    ] {
        if option != "--fps" {
            each(option, unit, drop(option));
        }
    }
    // A million samples of a second are a hundred megabytes: fewer here.
    each("--fps", "", || {
        let mut command = saltus();
        command.args(["simulate", "--format", "csv", "--drop=1m", "--cor=0.7", "--until=1ms"]);
        command
    });
}

#[test]
fn export() {
    for (option, unit) in [
        ("--fps", ""),
        ("--squash", ""),
        ("--stretch", ""),
        ("--exaggerate", ""),
        ("--hold", ""),
        ("--loop", ""),
        ("--until", "s"),
        ("--first-frame", ""),
        ("--tolerance", "m"),
    ] {
        for (scene, format) in [("squash", "html"), ("topspin", "glb")] {
            each(option, unit, || {
                let mut command = saltus();
                command.args(["export", "--to", format]).arg(root().join(format!("examples/scenes/{scene}.toml")));
                command
            });
        }
    }
}
