//! The stated error of a file bounds what its readers measure, for every example scene.

use std::fs;
use std::path::Path;

use saltus_motion::{Format, Frames, Snap};
use saltus_scene::plan::With;
use saltus_scene::solve::{Clock, Wish, solve};
use saltus_scene::{Departure, Scene, Staging};

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

/// Every impact is a contact of the balls that it stops or turns back, whether they fly, lie or
/// roll.
#[test]
fn every_impact_is_a_contact_of_its_balls() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    let slides = "restitution = 0.5\nfriction = 0.2\n[ball]\nposition = [0, 0.03]\nvelocity = [3, 0]\nradius = 0.03\n\
        [[floor]]\nkind = 'level'\n[[floor]]\nkind = 'wall'\nat = 0.5\n[run]\nuntil = 1\n";
    let examples = fs::read_dir(scenes).unwrap().map(|entry| entry.unwrap().path());
    let examples = examples.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    let mut all: Vec<_> = examples.map(|path| Scene::read(&path).unwrap()).collect();
    all.push(Scene::parse("slides", slides.as_bytes()).unwrap());
    for scene in all {
        let record = scene.plan().unwrap().run().unwrap();
        let motion = record.motion().unwrap();
        for impact in record.impacts() {
            let other = if let With::Ball(ball) = impact.with { Some(ball) } else { None };
            for ball in [Some(impact.ball), other].into_iter().flatten() {
                let shown = motion.tracks[ball].contacts().any(|t| t == impact.t);
                assert!(shown, "{}: {impact:?}, ball {ball}", motion.title);
            }
        }
    }
}

/// A top that was asked for is moved by snapping to frames with gravity kept: the closing line says
/// by how much at most, and how it is kept.
#[test]
fn a_top_that_snapping_moves_is_said() {
    let clock = Clock { fps: 24.0, first: 0 };
    let solved = solve(None, &["height"], &[Wish::parse("apex 2 at 60cm", clock).unwrap()]).unwrap();
    let record = Scene::parse("solved", solved.toml().unwrap().as_bytes()).unwrap().plan().unwrap().run().unwrap();
    let frames = Frames::new("24".parse().unwrap());
    for (snap, kept) in [(Snap::Gravity, false), (Snap::Heights, true)] {
        let mut staging = Staging::new(frames);
        staging.snap = Some(snap);
        let stage = staging.stage(&record).unwrap();
        let off = (stage.motion.tracks[0].stretches[1].top().0 - 0.6).abs();
        let says = stage.says(&stage.file(Format::Csv, 1e-4).unwrap());
        assert_eq!(off < 1e-6, kept, "{off}: {says}");
        assert_eq!(says.contains("(--snap heights keeps them)"), !kept, "{says}");
        let said = stage.departures.iter().find_map(|departure| match departure {
            Departure::SnappedByGravity { tops } => Some(*tops),
            _ => None,
        });
        assert!(kept || said.is_some_and(|tops| off <= tops), "{off} of {said:?}");
    }
}
