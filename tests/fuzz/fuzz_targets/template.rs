//! A key, a value and a scene, a line each and the rest: the value is set under the key, or refused
//! with a place.

#![no_main]

use libfuzzer_sys::fuzz_target;
use saltus_scene::{Run, Template};

fuzz_target!(|text: &str| {
    let mut lines = text.splitn(3, '\n');
    let (Some(key), Some(value), Some(toml)) = (lines.next(), lines.next(), lines.next()) else { return };
    let made =
        Template::parse("fuzz", toml.as_bytes(), &[key]).and_then(|template| template.scene(&[value], Run::default()));
    if let Err(error) = made {
        assert!(error.line() >= 1 && error.column() >= 1 && !error.message().is_empty());
        assert!(error.to_string().len() < 4000, "{error}");
    }
});
