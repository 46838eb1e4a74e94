//! Scenes of the soak, drawn from bytes instead of a stream: each keeps the laws it has to keep.

#![no_main]

use std::fmt;

use arbitrary::{Arbitrary, Unstructured};
use libfuzzer_sys::fuzz_target;
use saltus_tests::random_scene::{Made, drawn};
use saltus_tests::scene_laws::lived;

/// After so many evaluations of flows and guards a run is given up.
const EVALUATIONS: u64 = 100_000;

struct Drawn(Made);

impl<'a> Arbitrary<'a> for Drawn {
    fn arbitrary(bytes: &mut Unstructured<'a>) -> arbitrary::Result<Self> {
        // Four bytes are both halves of a number: the upper one decides a size, the lower one a
        // choice. Where they end, zeros follow.
        Ok(Self(drawn(&mut || bytes.arbitrary::<u32>().map_or(0, |n| u64::from(n) << 32 | u64::from(n)))))
    }
}

impl fmt::Debug for Drawn {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0.toml)
    }
}

fuzz_target!(|drawn: Drawn| {
    let Drawn(made) = drawn;
    if let Err(says) = lived(&made, EVALUATIONS) {
        panic!("{says}\n{}", made.toml);
    }
});
