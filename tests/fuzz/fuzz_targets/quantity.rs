//! Any text as a quantity and as a frame rate: what is read is finite, and what is printed of it is
//! read back as itself.

#![no_main]

use libfuzzer_sys::fuzz_target;
use saltus_bounce::units::Quantity;
use saltus_motion::Rate;

fuzz_target!(|text: &str| {
    for quantity in Quantity::ALL {
        match quantity.parse(text) {
            Ok(value) => {
                assert!(value.is_finite(), "{quantity}: {value}");
                for printed in [format!("{value} {}", quantity.si()), format!("{value:?} {}", quantity.si())] {
                    assert_eq!(quantity.parse(&printed), Ok(value), "{quantity}: {printed}");
                }
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
    match text.parse::<Rate>() {
        Ok(rate) => {
            assert!((1.0..=1000.0).contains(&rate.per_second()), "{rate}");
            assert_eq!(rate.to_string().parse(), Ok(rate));
        }
        Err(error) => assert!(!error.to_string().is_empty()),
    }
});
