//! Scenes that say nothing of when to stop: what ends by itself, and what is refused.

use saltus_scene::Scene;
use saltus_scene::plan::{End, Record};

fn run(toml: &str) -> Record {
    Scene::parse("s.toml", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap()
}

const BALL: &str = "ball = { radius = '3 cm', mass = '60 g', position = [0, 1], velocity = [2, 1], spin = -30 }\n";

/// A ball that moves sideways ends when nothing happens any more: it lies, slides or rolls on. It
/// has the jumps of a run with ten times the end, and a twentieth more than the time of the last
/// jump is kept.
#[test]
fn what_moves_sideways_may_end_by_itself() {
    let scenes = [
        "restitution = 0.6\nball = { height = 1, velocity = [2, 0] }\n".to_owned(),
        format!("restitution = 0.6\nfriction = 0.4\n{BALL}"),
        format!("restitution = 0.6\nfriction = 0.4\ndrag = {{ coefficient = 0.5 }}\nmagnus = {{}}\n{BALL}"),
        format!("restitution = 0.6\ndrag = {{ rate = 0.5 }}\n{BALL}"),
        format!(
            "restitution = 0.6\nfriction = 0.3\nfloor = {{ kind = 'stairs', from = 0.5, tread = 0.3, rise = 0.1, count = 4 }}\n{BALL}"
        ),
        format!(
            "restitution = 0.5\nfriction = 0.5\n{BALL}[[floor]]\nkind = 'incline'\nangle = '-20 deg'\n[[floor]]\nkind = 'wall'\nat = 2\n"
        ),
        format!(
            "restitution = 0.5\nfriction = 0.5\nfloor = {{ kind = 'polyline', points = [[-1, 0.2], [0, 0], [1, -0.3], [2, 0.1]] }}\n{BALL}"
        ),
        "restitution = 0.5\nball = { height = 1 }\nfloor = { motion = { schedule = [[4, 0], [5, 0.5]] } }\n".to_owned(),
        format!(
            "restitution = 0.5\nfriction = 0.5\ndrag = {{ per_length = 0.1 }}\n{BALL}floor = {{ motion = {{ schedule = [[9, 0], [10, 0.5]] }} }}\n"
        ),
    ];
    for scene in &scenes {
        let record = run(scene);
        assert_eq!(record.end(), End::Time, "{scene}");
        let events = record.events();
        let last = events.last().unwrap().t;
        assert!((record.until() - 1.05 * last).abs() < 1e-9 * last, "{} {last}: {scene}", record.until());
        let long = run(&format!("{scene}[run]\nuntil = {}\n", 10.0 * last));
        let count = long.events().len();
        assert_eq!(count, events.len(), "{scene}");
        for (one, other) in events.iter().zip(long.events()) {
            assert!((one.t - other.t).abs() < 1e-9 * last && one.edge == other.edge, "{scene}");
        }
    }
    // The wall at the foot of the incline stops it, where it may spin on.
    let record = run(&scenes[5]);
    assert_eq!(record.at(0, record.until()).unwrap().velocity.norm(), 0.0);
}

/// Balls above each other come to rest on one another; in air the limit of their impacts is the
/// end.
#[test]
fn what_is_stacked_ends_by_itself() {
    let stack =
        "[[ball]]\nmass = 0.05\nradius = 0.02\nheight = 1\n[[ball]]\nmass = 0.003\nradius = 0.02\nheight = 1.05\n";
    for (more, collision, rests) in [("", 0.85, true), ("", 1.0, true), ("drag = { coefficient = 0.5 }\n", 0.85, false)]
    {
        let scene = format!("restitution = 0.9\ncollisions = {{ restitution = {collision} }}\n{more}{stack}");
        let record = run(&scene);
        assert_eq!(record.end() == End::Time, rests, "{scene}");
        assert_eq!(matches!(record.end(), End::Zeno { .. }), !rests, "{scene}");
        assert_eq!(record.rest().is_some_and(|rest| rest < record.until()), rests, "{scene}");
        let [low, high] = [0, 1].map(|ball| record.at(ball, record.until()).unwrap().height());
        assert!(low.abs() < 1e-9 && (high - 0.04).abs() < 1e-9, "{low} {high}: {scene}");
    }
}

/// What may go on for ever is refused with what makes it so.
#[test]
fn what_has_no_end_says_so() {
    let scenes = [
        (format!("restitution = 1\n{BALL}"), "the ball loses nothing"),
        (
            format!("restitution = 0.5\n{BALL}floor = {{ motion = {{ amplitude = 0.01, frequency = 5 }} }}\n"),
            "the floor moves for ever",
        ),
        (
            format!("restitution = 0.5\n{BALL}floor = {{ kind = 'parabola', curvature = 0.5 }}\n"),
            "may swing on a curve for ever",
        ),
        (
            format!("restitution = 0.5\n{BALL}floor = {{ kind = 'box', size = [4, 2] }}\n"),
            "to and fro between walls for ever",
        ),
        (
            format!("restitution = 0.5\n{BALL}floor = {{ kind = 'stairs', tread = 0.3, rise = 0.1 }}\n"),
            "the stairs have no end",
        ),
        (format!("restitution = 0.5\n{BALL}floor = {{ kind = 'wall', at = 1 }}\n"), "there is no floor"),
        (
            "restitution = 0.5\nbuoyancy = true\nball = { height = 1, radius = 1, mass = '1 g', velocity = [1, 0] }\n"
                .to_owned(),
            "not heavier than the air",
        ),
    ];
    for (scene, why) in scenes {
        let refused = Scene::parse("s.toml", scene.as_bytes()).unwrap_err().to_string();
        assert!(refused.contains("nothing ends this run") && refused.contains(why), "{refused}");
        // With an end it runs.
        Scene::parse("s.toml", format!("{scene}[run]\nuntil = 1\n").as_bytes()).unwrap();
    }
}
