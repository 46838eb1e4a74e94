//! What is said of a file bounds what its readers measure, for every example scene.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use std::fs;
use std::path::Path;

use saltus_motion::{Format, Frames};
use saltus_scene::{Scene, Staging};

/// At so many times a reader looks.
const LOOKS: u32 = 4001;

#[test]
fn the_height_error_bounds_what_readers_measure() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    let mut cut = 0;
    for entry in fs::read_dir(scenes).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        let record = Scene::read(&entry).unwrap().plan().unwrap().run().unwrap();
        for rate in ["24", "60"] {
            let frames = Frames::new(rate.parse().unwrap());
            let stage = Staging::new(frames).stage(&record).unwrap();
            for format in [Format::Csv, Format::Glb] {
                let file = stage.file(format, 1e-4).unwrap();
                let said = stage.height_error(&file);
                let mut worst = 0.0_f64;
                for (ball, track) in stage.motion.tracks.iter().enumerate() {
                    let path = if format.sampled() { track.samples(frames, true) } else { track.keys(1e-4, frames) };
                    for k in 0..LOOKS {
                        let t = track.end().min(record.until()) * f64::from(k) / f64::from(LOOKS);
                        worst = worst.max((path.at(t)[2] - record.at(ball, t).unwrap().height()).abs());
                    }
                }
                assert!(worst <= said + 1e-9, "{}, {rate}, {format:?}: {worst} of {said}", entry.display());
                cut += usize::from(said > file.miss.height);
            }
        }
    }
    assert!(cut >= 4, "some scenes end in hops that are left out");
}
