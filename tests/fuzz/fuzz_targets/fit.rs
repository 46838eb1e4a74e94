//! A small table in text, read and fitted: a report without a number that is none, be it a refusal.

#![no_main]

use libfuzzer_sys::fuzz_target;
use saltus_fit::{Fit, ReadOptions, Table};

fuzz_target!(|text: &str| {
    let options = ReadOptions::default().height_unit("cm").time_unit("s");
    // Only small tables: how long a fit takes grows with the readings.
    let Ok(table) = Table::parse("any", text.as_bytes(), &options) else { return };
    if table.trials().iter().map(|trial| trial.readings().len()).sum::<usize>() > 60 {
        return;
    }
    let report = Fit::new().run(&table).unwrap_or_else(|error| panic!("{error}"));
    let json = serde_json::to_string(&report).unwrap_or_else(|error| panic!("{error}"));
    assert!(!report.to_string().is_empty() && !json.contains("NaN"));
    if let Some(cor) = report.cor() {
        assert!(cor.low <= cor.value && cor.value <= cor.high, "{cor:?}");
        assert!(cor.low >= 0.0 && cor.high.is_finite(), "{cor:?}");
    }
});
