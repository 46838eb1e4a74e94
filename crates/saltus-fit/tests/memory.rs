//! What a table of very many drops takes of memory.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used)]

#[path = "noise/mod.rs"]
mod noise;

use std::fmt::Write as _;

use noise::Noise;
use saltus_fit::{Fit, ReadOptions, Table};

/// The most memory that this process has had, bytes; none where the system does not tell.
fn most() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024.0 * line.split_whitespace().next()?.parse::<f64>().ok()?)
}

/// The most memory is counted from here on.
fn forget() {
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// The text of so many drops.
fn drops(count: usize) -> String {
    let mut noise = Noise(3);
    let mut text = "drop_cm,rebound_cm\n".to_owned();
    for _ in 0..count {
        writeln!(text, "{:.2},{:.2}", 100.0 + noise.normal(0.3), 64.0 + noise.normal(0.5)).unwrap();
    }
    text
}

/// Rows beyond four million cells are not read: the refusal takes a fixed memory beside the text.
fn more_than_are_read() {
    let text = drops(2_100_000);
    forget();
    let before = most();
    let error = Table::parse("drops.csv", text.as_bytes(), &ReadOptions::default()).unwrap_err().to_string();
    assert!(error.contains("more than 4194304 cells; it is read no further than line 2097153"), "{error}");
    if let (Some(before), Some(after)) = (before, most()) {
        assert!(after - before < 2e8, "{} bytes", after - before);
    }
}

/// A drop of two heights takes 176 bytes as readings, as much as evidence, and the fit its own
/// copies: a kilobyte and a half in all, and the report no more for more drops.
#[test]
fn a_drop_takes_a_kilobyte_and_a_half() {
    const DROPS: usize = 300_000;
    more_than_are_read();
    let text = drops(DROPS);
    forget();
    let Some(before) = most() else {
        eprintln!("skipped: this system does not tell how much memory a process has had");
        return;
    };
    let table = Table::parse("drops.csv", text.as_bytes(), &ReadOptions::default()).unwrap();
    let report = Fit::new().run(&table).unwrap();
    let each = (most().unwrap() - before) / DROPS as f64;
    assert!(each < 1536.0, "{each} bytes a drop");
    assert!(table.trials().len() == DROPS && report.residuals().len() <= 100_000 && report.points().len() > 1000);
}
