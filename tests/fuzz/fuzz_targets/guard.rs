//! Polynomial guards that nearly touch zero: as many crossings are found as Sturm's theorem counts.

#![no_main]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use saltus_tests::sturm::found_and_counted;

/// 2ᵏ q(s)² + r(s), the coefficients as in `tests/sturm.rs`.
#[derive(Arbitrary, Debug)]
struct Guard {
    q: [i8; 4],
    r: [i8; 3],
    k: u8,
}

fuzz_target!(|guard: Guard| {
    let small = |c: &i8| i64::from(c % 10);
    let (q, r): (Vec<i64>, Vec<i64>) = (guard.q.iter().map(small).collect(), guard.r.iter().map(small).collect());
    if let Some((found, counted)) = found_and_counted(&q, &r, usize::from(guard.k % 81)) {
        assert_eq!(found, counted, "q = {q:?}, r = {r:?}, k = {}", guard.k % 81);
    }
});
