//! Any bytes as a scene: refused with a place in the file, or read, planned and run within a
//! budget.

#![no_main]

use libfuzzer_sys::fuzz_target;
use saltus_tests::any_scene::answered;

fuzz_target!(|bytes: &[u8]| {
    if let Err(says) = answered(bytes) {
        panic!("{says}");
    }
});
