//! One description of a case is both its test and its row on the page.

use crate::FAMILIES;
use crate::report::Report;

/// A case and the function that runs it; the report is made once, for its test and for the page.
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    pub(crate) id: &'static str,
    /// Whether its test is ignored unless asked for.
    pub(crate) long: bool,
    pub(crate) report: fn() -> &'static Report,
}

/// The cases of a family: the function that runs each, its name in the file of cases, and, of a
/// long one, what it takes.
macro_rules! cases {
    ($($run:ident = $id:literal $(, long: $long:literal)?;)+) => {
        pub(crate) const CASES: &[$crate::cases::Entry] = &[$($crate::cases::Entry {
            id: $id,
            long: ![$($long,)? ""][0].is_empty(),
            report: || {
                static REPORT: std::sync::OnceLock<$crate::report::Report> = std::sync::OnceLock::new();
                REPORT.get_or_init(|| $crate::report::Report::of($id, $run))
            },
        },)+];

        mod case {
            $(
                #[test]
                $(#[ignore = $long])?
                fn $run() {
                    $crate::cases::verify($id);
                }
            )+
        }
    };
}

/// Asserts that the case came out as it should.
pub(crate) fn verify(id: &str) {
    let entry = FAMILIES.iter().flat_map(|family| family.1).find(|entry| entry.id == id).unwrap();
    let report = (entry.report)();
    for seen in &report.seen {
        println!("{} ({:.2} of what is allowed)", seen, seen.off);
    }
    let faults = report.faults();
    assert!(faults.is_empty(), "{id}:\n{}", faults.join("\n"));
}
