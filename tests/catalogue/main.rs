//! The catalogue of hard cases: each case of `hardcases.json` is run here, each of its observables
//! is judged at the case's own tolerance, and `docs/trust/hard-cases.md` shows what came out.
//!
//! A case that is missed stays, marked with its reason; its test asserts that it is missed as it is
//! known to be, so that a cure is noticed. The page is rewritten by
//! `SALTUS_BLESS=1 cargo test --release -p saltus-tests --test catalogue -- --include-ignored`;
//! without the last two words the long cases keep the rows they have.

#![allow(clippy::panic, clippy::unwrap_used)] // a test that cannot go on has failed

#[macro_use]
mod cases;
mod page;
mod report;
mod samples;
mod survey;

mod chaos;
mod classics;
mod contact;
mod drag;
mod filippov;
mod forcing;
mod locomotion;
mod root;
mod sensitivity;
mod simultaneous;
mod table;
mod timescale;
mod zeno;

use cases::Entry;

/// The families in the order of the page.
const FAMILIES: [(&str, &[Entry]); 13] = [
    ("zeno", zeno::CASES),
    ("drag", drag::CASES),
    ("root", root::CASES),
    ("simultaneous", simultaneous::CASES),
    ("table", table::CASES),
    ("filippov", filippov::CASES),
    ("contact", contact::CASES),
    ("locomotion", locomotion::CASES),
    ("sensitivity", sensitivity::CASES),
    ("chaos", chaos::CASES),
    ("classics", classics::CASES),
    ("timescale", timescale::CASES),
    ("forcing", forcing::CASES),
];
