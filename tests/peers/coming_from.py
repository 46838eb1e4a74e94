#!/usr/bin/env python3
"""Runs the programs of docs/program/coming-from.md, those in Rust and those in Python, and prints lines, times and relative errors.

Wants SciPy. The program in Rust is built under target/coming-from, with optimization.
"""

import pathlib
import re
import subprocess
import time

import numpy
from scipy.linalg import expm

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs/program/coming-from.md").read_text()


def converter():
    """Its voltage at 10 ms: each stretch of the switch is linear, and its solution a matrix exponential."""
    flow = numpy.array([[0.0, -1.0 / 200e-6, 0.0], [1.0 / 100e-6, -1.0 / (4.0 * 100e-6), 0.0], [0.0, 0.0, 0.0]])
    source = numpy.array([[0.0, 0.0, 12.0 / 200e-6], [0.0, 0.0, 0.0], [0.0, 0.0, 0.0]])
    period, duty, x = 50e-6, 0.3, numpy.array([0.0, 0.0, 1.0])
    for _ in range(200):
        x = expm((flow + source) * duty * period) @ x
        x = expm(flow * (1.0 - duty) * period) @ x
        duty = min(max(duty + 55.0 * period * (5.0 - x[1]), 0.0), 0.95)
    return x[1]


# What is right: two closed forms, matrix exponentials, and the reference of the test set of CWI and Bari.
RIGHT = {
    "ball": (2.0 / 9.81) ** 0.5 * 1.8 / 0.2,
    "buck": converter(),
    "robertson": 0.2083340149701255e-07,
    "stick_slip": 324.41831942525834,
}
RUNS = 7


def listings(language):
    found = re.findall(rf"```{language}\n(.*?)```", PAGE, re.S)
    found = [re.sub(r"^# .*\n", "", text, flags=re.M) if language == "rust" else text for text in found]
    named = {name: text for text in found for name in RIGHT if f"{name}()" in text}
    assert set(named) == set(RIGHT), named.keys()
    return named


def lines(text):
    return sum(1 for line in text.splitlines() if line.strip())


def in_rust(programs):
    """(value, least time in s) of each, in one program."""
    at = ROOT / "target/coming-from"
    (at / "src").mkdir(parents=True, exist_ok=True)
    saltus = ROOT / "crates/saltus"
    (at / "Cargo.toml").write_text(
        '[package]\nname = "coming-from"\nedition = "2024"\n\n[workspace]\n\n[dependencies]\n'
        f'saltus = {{ path = "{saltus}", features = ["derive"] }}\n'
    )
    modules = "".join(f"mod {name} {{\n{text.replace('fn ' + name, 'pub fn ' + name)}}}\n" for name, text in programs.items())
    timed = (
        "fn timed(name: &str, run: fn() -> Result<f64, saltus::Error>) {\n"
        "    let (mut times, mut value) = (Vec::new(), 0.0);\n"
        f"    for _ in 0..{RUNS} {{\n"
        "        let (mut count, begun) = (0, std::time::Instant::now());\n"
        "        while count == 0 || begun.elapsed().as_secs_f64() < 0.1 {\n"
        "            value = std::hint::black_box(run().unwrap());\n            count += 1;\n        }\n"
        "        times.push(begun.elapsed().as_secs_f64() / f64::from(count));\n    }\n"
        '    println!("{name} {value:e} {:e}", times.iter().copied().fold(f64::INFINITY, f64::min));\n}\n'
    )
    calls = "".join(f'    timed("{name}", {name}::{name});\n' for name in programs)
    (at / "src/main.rs").write_text(f"{modules}{timed}fn main() {{\n{calls}}}\n")
    said = subprocess.run(["cargo", "run", "--release", "--quiet"], cwd=at, check=True, capture_output=True, text=True)
    rows = (line.split() for line in said.stdout.splitlines())
    return {name: (float(value), float(least)) for name, value, least in rows}


def in_python(programs):
    found = {}
    for name, text in programs.items():
        names = {}
        exec(text, names)  # the programs of our own page
        times = []
        for _ in range(RUNS):
            begun = time.perf_counter()
            value = names[name]()
            times.append(time.perf_counter() - begun)
        found[name] = (float(value), min(times))
    return found


def short(seconds):
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("µs", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds * 1e9:.3g} ns"


def main():
    rust, python = listings("rust"), listings("python")
    here, there = in_rust(rust), in_python(python)
    julia = listings("julia")
    print("| | saltus: lines | time | error | SciPy: lines | time | error | times as long | Julia: lines |")
    print("|---|---|---|---|---|---|---|---|---|")
    for name, right in RIGHT.items():
        (a, mine), (b, theirs) = here[name], there[name]
        off = [f"{abs(value / right - 1.0):.0e}" for value in (a, b)]
        print(
            f"| {name} | {lines(rust[name])} | {short(mine)} | {off[0]} | {lines(python[name])} | {short(theirs)} "
            f"| {off[1]} | {theirs / mine:.0f} | {lines(julia[name])} |"
        )


if __name__ == "__main__":
    main()
