//! Any bytes as a table, in several ways to read it: a table of finite numbers, or an error that
//! says something.
//!
//! Bytes that begin with `<` are the rows of a sheet in a workbook: chance alone does not come past
//! its checksums.

#![no_main]

#[path = "../../../crates/saltus-fit/tests/written/mod.rs"]
#[allow(dead_code)]
mod written;

use std::panic;

use libfuzzer_sys::fuzz_target;
use saltus_fit::{ReadOptions, Table};

/// A panic in the reader of old workbooks is caught by design, so that it alone does not end the
/// run.
fn quiet() {
    let ends = panic::take_hook();
    panic::set_hook(Box::new(move |info| {
        if !info.location().is_some_and(|at| at.file().contains("calamine")) {
            ends(info);
        }
    }));
}

fuzz_target!(init: quiet(), |bytes: &[u8]| {
    let file = match bytes {
        [b'<', ..] => written::workbook(&[("All", String::from_utf8_lossy(bytes).into_owned())]),
        _ => bytes.to_vec(),
    };
    let all = ReadOptions::default().fps(30.0).scale(0.01).height_unit("px").time_unit("ms").zero(3.0).y_down(true);
    for options in [
        ReadOptions::default(),
        ReadOptions::default().header(&["time_s", "-", "height_m"]),
        ReadOptions::default().sheet("All").column("y"),
        all,
    ] {
        match Table::parse("any", &file, &options) {
            Ok(table) => {
                let finite = |number: Option<f64>| number.is_none_or(f64::is_finite);
                let readings = || table.trials().iter().flat_map(|trial| trial.readings());
                assert!(readings().all(|reading| finite(reading.time) && finite(reading.height)));
            }
            Err(error) => {
                assert!(!error.to_string().is_empty() && error.to_string().len() < 4000);
                assert!(error.line() != Some(0) && error.column() != Some(0), "{error}");
            }
        }
    }
});
