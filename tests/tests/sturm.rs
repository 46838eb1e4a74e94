//! Guards that nearly touch zero: the crossings found are as many as Sturm's theorem counts in
//! exact rational arithmetic.

use proptest::prelude::*;
use saltus_cases::cases;
use saltus_tests::sturm::found_and_counted;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(400)))]

    #[test]
    fn as_many_crossings_as_sturm_counts(
        q in prop::collection::vec(-9_i64..=9, 2..=4),
        r in prop::collection::vec(-9_i64..=9, 1..=3),
        k in 0_usize..=80,
    ) {
        prop_assume!(q.iter().skip(1).any(|c| *c != 0));
        if let Some((found, counted)) = found_and_counted(&q, &r, k) {
            prop_assert_eq!(found, counted);
        }
    }
}
