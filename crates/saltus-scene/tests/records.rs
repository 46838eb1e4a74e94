//! What a run of a scene leaves: its record, and the outcome that is watched for without one.

use saltus_scene::plan::{self, Outcome};
use saltus_scene::{Record, Run, Scene};

/// The middle ball of three hands the impact on to the one that touches it: its event has both
/// sides of all three.
#[test]
fn an_impact_that_is_handed_on_has_a_side_of_each_ball() {
    let ball = |height: f64, mass: f64| format!("[[ball]]\nradius = 0.0625\nmass = {mass:?}\nheight = {height:?}\n");
    let balls = [ball(0.0, 2.0), ball(0.25, 1.0), ball(0.375, 1.0)].concat();
    let toml = format!("restitution = 0.9375\n{balls}[run]\nmost_jumps = 3\n");
    let record = Scene::parse("s.toml", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap();
    let events = record.events();
    let event = events.iter().find(|event| event.edge == "ball").unwrap();
    let mut balls: Vec<usize> = event.sides.iter().map(|side| side.ball).collect();
    balls.sort_unstable();
    assert_eq!(balls, [0, 1, 2]);
    assert!(event.sides.iter().all(|side| side.before.velocity != side.after.velocity));
}

/// A motion that swings on below what a picture shows is not kept as finely as the rounding of its
/// time.
#[test]
fn what_lies_on_a_soft_floor_is_kept_in_few_pieces() {
    let toml = "ball = { height = '5 mm', mass = '3 g' }\ncontact = { law = 'kelvin-voigt', stiffness = 3.5e5, damping = 2.6 }\nrun = { until = 4 }\n";
    let record = Scene::parse("s.toml", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap();
    let pieces = record.segments(0).len();
    assert!(pieces < 40_000, "{pieces} pieces");
}

#[test]
fn what_rests_from_the_start_is_shown_at_rest() {
    for more in ["", "drag = { per_length = 0.1 }\n", "drag = { per_length = 0.1, rate = 0.1 }\n"] {
        let toml = format!(
            "restitution = 0.5\nball = {{ height = '1 m', radius = '2 cm' }}\nfloor = {{ height = '1 m' }}\n{more}"
        );
        let record = Scene::parse("s.toml", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap();
        assert_eq!((record.rest(), record.until(), record.impacts().len()), (Some(0.0), 1.0, 0), "{more}");
        assert_eq!(record.at(0, 1.0).map(|moment| moment.height()), Some(1.0), "{more}");
    }
}

/// What is watched for is what a record would show, times and apexes to the bit, in every example
/// and where nothing says when to stop.
#[test]
fn an_outcome_is_what_the_record_shows() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/scenes");
    let mut seen = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|extension| extension != "toml") {
            continue;
        }
        for until in [None, Some(0.7)] {
            let mut run = Run::default();
            run.until = until;
            let plan = Scene::parse_with("s.toml", &std::fs::read(&path).unwrap(), run).unwrap().plan().unwrap();
            let (record, outcome) = (plan.run().unwrap(), plan.outcome().unwrap());
            let shown = Outcome::of(&record);
            // The state at the end is the engine's own, not read off the last piece.
            for (ball, shown) in outcome.balls.iter().zip(&shown.balls) {
                let difference =
                    [ball.position - shown.position, ball.velocity - shown.velocity, ball.spin - shown.spin];
                assert!(difference.iter().all(|d| d.norm() < 1e-12), "{ball:?} {shown:?}");
            }
            // And so is the state at an apex that is a jump.
            let apexes = outcome.first_apex.zip(shown.first_apex);
            let apart = apexes.map_or(0.0, |(a, b)| (a.t - b.t).abs().max((a.height - b.height).abs()));
            assert!(apart < 1e-12 && outcome.first_apex.is_some() == shown.first_apex.is_some(), "{apexes:?}");
            let (balls, first_apex) = (outcome.balls.clone(), outcome.first_apex);
            let shown = Outcome { cost: outcome.cost, balls, first_apex, ..shown };
            assert_eq!(outcome, shown, "{} until {until:?}", path.display());
            assert_eq!(outcome.cost.jumps, record.cost().jumps, "{}", path.display());
            seen += usize::from(outcome.impacts > 0 && outcome.first_apex.is_some());
        }
    }
    assert!(seen >= 15, "{seen}");
}

/// Workers take runs from each other, and a record is data.
#[test]
fn a_record_is_sent_shared_and_serialised() {
    fn shared<T: Send + Sync + serde::Serialize>(value: &T) -> String {
        serde_json::to_string_pretty(value).unwrap()
    }
    let scenes = [
        "restitution = 0.5\nball = { height = 1 }\n",
        "restitution = 0.5\nfriction = 0.2\nrun = { until = 2 }\nball = { radius = 0.1, position = [0, 1], velocity = [1, 0] }\n",
    ];
    for scene in scenes {
        let record = Scene::parse("a", scene.as_bytes()).unwrap().plan().unwrap().run().unwrap();
        let here = shared(&record);
        assert_eq!(here.clone() + "\n", record.json(None).unwrap());
        assert_eq!(std::thread::spawn(move || shared(&record)).join().unwrap(), here);
    }
}

/// Flights by Taylor series are the flights that are stepped, as near as the tolerance asks, in
/// fewer steps.
#[test]
fn flights_by_series_are_those_by_steps() {
    let scene = |run: &str| {
        let toml = format!(
            "restitution = 0.7\nfriction = 0.4\n\
             ball = {{ radius = 0.033, mass = 0.058, height = 1, velocity = [12, -3, 4], spin = [5, -90, 30] }}\n\
             drag = {{ coefficient = 0.5 }}\nmagnus = {{ slope = 1, saturation = 2 }}\nspin_decay = {{ time = 20 }}\n\
             air = {{ wind = [1, -2, 0.5] }}\nrun = {{ until = 2{run} }}\n"
        );
        Scene::parse("s.toml", toml.as_bytes()).unwrap().plan().unwrap()
    };
    let exact = scene(", tolerance = 1e-13, stepper = 'dop853'").run().unwrap();
    for tolerance in [1e-6, 1e-9, 1e-11] {
        let by = |stepper: &str| scene(&format!(", tolerance = {tolerance:e}{stepper}"));
        let plan = by(", stepper = 'series'");
        assert_eq!(plan.explain().modes[0].advance, plan::Advance::Series);
        let (series, stepped) = (plan.run().unwrap(), by("").run().unwrap());
        assert!(series.cost().steps < stepped.cost().steps);
        let off = |record: &Record| {
            let place = |record: &Record, k: u32| record.at(0, f64::from(k) * 0.02).unwrap().position;
            (0..=100).map(|k| (place(record, k) - place(&exact, k)).norm()).fold(0.0, f64::max)
        };
        assert!(off(&series) <= 1e3 * tolerance, "{tolerance}: {} {}", off(&series), off(&stepped));
    }
}

/// Balls above each other in air fall as each would alone until they meet, and end where one would
/// rest upon another.
#[test]
fn balls_above_each_other_fall_in_air() {
    let head = "restitution = 0.7\ndrag = { coefficient = 0.47 }\n";
    let lower = "{ radius = '3 cm', mass = '50 g', height = 1 }";
    let run = |balls: &str, until: &str| {
        let toml = format!("{head}ball = [{balls}]\nrun = {{ until = {until} }}\n");
        Scene::parse("s.toml", toml.as_bytes()).unwrap().plan().unwrap().run().unwrap()
    };
    let both = run(&format!("{lower}, {{ radius = '2 cm', mass = '3 g', height = 1.2 }}"), "'5 s'");
    let alone = run(lower, "'0.4 s'");
    for k in 0..=40 {
        let t = f64::from(k) * 0.01;
        let [a, b] = [&both, &alone].map(|record| record.at(0, t).unwrap());
        assert!((a.height() - b.height()).abs() < 1e-9, "{} {} at {t}", a.height(), b.height());
        assert_eq!((a.position.x, a.position.y), (0.0, 0.0));
    }
    assert!(both.impacts().len() > 5);
    // Each has a drag of its own: 3/8 × density × coefficient/(radius × density of the ball).
    let says = both.scene().plan().unwrap().explain().to_string();
    assert!(says.contains("a = -(0.0162789, 0.120585) /m × |v| v"), "{says}");
    assert!(matches!(both.end(), plan::End::Zeno { .. }), "{:?}", both.end());
    for k in 0..=200 {
        let t = both.until() * (f64::from(k) / 200.0); // the last one is the end itself
        let [low, high] = [0, 1].map(|ball| both.at(ball, t).unwrap().height());
        assert!(high - low > 0.06 - 1e-8, "{low} {high} at {t}");
    }
}
