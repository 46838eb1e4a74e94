//! How many cases tests try: a part of them where somebody waits, all of them where `THOROUGH` is
//! set, as before a change lands.

/// Without `THOROUGH` one of so many cases is tried.
const PART: u32 = 8;
/// But so many are: laws that are broken in one case of ten are found by most of their tests.
const LEAST: u32 = 8;

/// Whether all cases are tried, and tests that take a minute are run.
#[must_use]
pub fn thorough() -> bool {
    std::env::var_os("THOROUGH").is_some()
}

/// Of `all` cases those that are tried: the first ones.
#[must_use]
pub fn cases(all: u32) -> u32 {
    if thorough() { all } else { (all / PART).max(LEAST).min(all) }
}
