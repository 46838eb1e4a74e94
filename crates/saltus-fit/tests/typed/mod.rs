//! Tables typed as text, read and fitted.

use saltus_fit::{Fit, ReadOptions, Report, Table, TableError, Verdict};

pub(crate) fn read(text: &str) -> Result<Table, TableError> {
    Table::parse("t.txt", text.as_bytes(), &ReadOptions::default())
}

pub(crate) fn fit(text: &str) -> Report {
    Fit::new().run(&read(text).unwrap_or_else(|e| panic!("{e}\n{text}"))).unwrap()
}

/// The COR of a table, which is trusted.
pub(crate) fn trusted(text: &str) -> f64 {
    let report = fit(text);
    assert_eq!(report.verdict(), Verdict::Trusted, "{text}{report}");
    report.cor().unwrap().value
}
