//! Scenes as they are planned and run.

use std::fs;
use std::path::Path;

use proptest::prelude::*;
use saltus_cases::cases;
use saltus_scene::Scene;
use saltus_scene::plan::{Advance, Effect, End, Model, Record};

fn scene(toml: &str) -> Scene {
    Scene::parse("test.toml", toml.as_bytes()).unwrap_or_else(|error| panic!("{error}"))
}

fn run(scene: &Scene) -> Record {
    scene.plan().unwrap_or_else(|error| panic!("{error}")).run().unwrap_or_else(|error| panic!("{error}"))
}

/// Every example and every scene of the page runs to its end, and everything asked of its record is
/// a number.
#[test]
fn every_scene_runs() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut texts: Vec<String> = fs::read_dir(root.join("examples/scenes"))
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|e| e == "toml"))
        .map(|path| fs::read_to_string(path).unwrap())
        .collect();
    let page = fs::read_to_string(root.join("docs/use/scenes.md")).unwrap();
    texts.extend(page.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap().to_owned()));
    assert!(texts.len() >= 24);
    for text in texts {
        let record = run(&scene(&text));
        assert!(matches!(record.end(), End::Time | End::Jumps { .. }), "{:?} of\n{text}", record.end());
        for ball in 0..record.balls() {
            let segments = record.segments(ball);
            assert!(!segments.is_empty() && segments.windows(2).all(|pair| pair[0].start <= pair[1].start));
            for k in 0..=20 {
                let t = (record.until() * f64::from(k) / 20.0).min(record.until());
                let moment = record.at(ball, t).unwrap_or_else(|| panic!("no ball {ball} at {t} of\n{text}"));
                assert!(moment.position.iter().chain(&moment.velocity).all(|x| x.is_finite()), "{text}");
            }
            assert!(record.apexes(ball).iter().all(|apex| apex.height.is_finite() && apex.t <= record.until()));
        }
        let cor = |cor: Option<f64>| cor.is_none_or(|cor| (0.0..=1.0 + 1e-9).contains(&cor));
        let impacts = record.impacts();
        assert!(impacts.iter().all(|impact| impact.approach >= 0.0), "{text}");
        assert!(impacts.iter().filter(|impact| impact.approach > 1e-6).all(|impact| cor(impact.cor())), "{text}");
    }
}

#[test]
fn gravity_alone_takes_two_coordinates_and_no_step() {
    let plan = scene("restitution = 0.8\nball = { height = '1 m' }\n").plan().unwrap();
    let explanation = plan.explain();
    assert_eq!((explanation.model, explanation.coordinates.len()), (Model::Ball, 2));
    assert!(explanation.modes.iter().all(|mode| mode.advance == Advance::Exact));
    assert_eq!(explanation.left_out.len(), Effect::ALL.len() - 1);
    let cost = plan.run().unwrap().cost();
    assert_eq!((cost.steps, cost.flows), (0, 0));
}

#[test]
fn each_scene_has_its_model() {
    let model = |toml: &str| scene(toml).plan().unwrap().explain().model;
    let ball = "ball = { radius = '2 cm', mass = '3 g', height = '1 m' }\n";
    for (more, expected) in [
        ("restitution = 0.8\ndrag = { coefficient = 0.47 }\n", Model::Ball),
        ("restitution = 0.8\ndrag = { rate = 1 }\n", Model::Ball),
        ("restitution = 0.8\ndrag = { coefficient = 0.47, viscous = true }\n", Model::Flyer),
        ("contact = { law = 'hertz', stiffness = 1e6 }\nrun = { until = 1 }\n", Model::Compliant),
    ] {
        assert_eq!(model(&format!("{more}{ball}")), expected, "{more}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: cases(200), ..ProptestConfig::default() })]

    /// Random scenes are planned and run within a budget, or refused with a sentence.
    #[test]
    fn random_scenes_end(
        e in 0.0..=1.0_f64, mu in prop::option::of(0.0..1.0_f64), drag in prop::option::of(0.0..2.0_f64), lifted in any::<bool>(),
        v in (-20.0..20.0_f64, -20.0..20.0_f64), spin in prop::option::of(-300.0..300.0_f64), floor in 0..6_usize, height in 0.5..3.0_f64,
    ) {
        let floors = [
            "", "kind = 'incline'\nangle = '-20 deg'", "kind = 'stairs'\ntread = 0.3\nrise = 0.17", "kind = 'parabola'\ncurvature = 0.5",
            "kind = 'sine'\namplitude = 0.1\nwavelength = 1", "kind = 'box'\nsize = [4, 8]",
        ];
        let mut toml = format!("restitution = {e:?}\nbuoyancy = {lifted}\n");
        if let Some(mu) = mu {
            toml += &format!("friction = {mu:?}\n");
        }
        toml += &format!("[ball]\nradius = 0.03\nmass = 0.05\nposition = [0, {height:?}]\nvelocity = [{:?}, {:?}]\n", v.0, v.1);
        if let Some(spin) = spin {
            toml += &format!("spin = {spin:?}\n");
        }
        if let Some(drag) = drag {
            toml += &format!("[drag]\ncoefficient = {drag:?}\n");
        }
        toml += &format!("[floor]\n{}\n[run]\nuntil = 2\nmost_jumps = 500\n", floors[floor]);
        let record = scene(&toml).plan().unwrap().most_evaluations(2_000_000).run();
        match record {
            Ok(record) => {
                prop_assert!(record.until() <= 2.0 && record.at(0, record.until()).is_some());
                let doubts = record.doubts();
                prop_assert!(doubts.iter().all(|doubt| !doubt.contains(['{', '(', '\n'])), "in the scene's words: {doubts:?}");
            }
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }

    /// Several balls, contacts that take time, floors that move, scenes in space: read, planned and
    /// run within a budget, or refused with a sentence.
    #[test]
    fn random_scenes_of_every_kind_end(
        e in 0.0..=1.0_f64, kind in 0..6_usize, count in 1..=5_usize, gravity in prop::option::of(0.0..30.0_f64),
        places in prop::collection::vec((-1.0..1.0_f64, -1.0..1.0_f64, 0.1..2.0_f64), 5), speeds in prop::collection::vec(-5.0..5.0_f64, 15),
        masses in prop::collection::vec(-6.0..3.0_f64, 5), size in -3.0..-0.9_f64, wind in prop::option::of(-10.0..10.0_f64), steps in any::<bool>(),
    ) {
        let dimensions = [1, 1, 1, 2, 3, 3][kind];
        let mut toml = String::new();
        if kind == 1 {
            toml += &format!("contact = {{ law = '{}', stiffness = {:?}, damping = {e:?} }}\n", ["kelvin-voigt", "hunt-crossley"][count % 2], 10_f64.powf(5.0 - 2.0 * size));
        } else {
            toml += &format!("restitution = {e:?}\n");
        }
        if let Some(gravity) = gravity {
            toml += &format!("gravity = {gravity:?}\n");
        }
        if let Some(wind) = wind.filter(|_| dimensions == 3) {
            toml += &format!("air = {{ wind = [{wind:?}, 0.0, 1.0] }}\ndrag = {{ rate = 0.5 }}\n");
        }
        toml += "run = { until = 2, most_jumps = 500";
        toml += if steps { ", stepper = 'tsit5', tolerance = 1e-6 }\n" } else { " }\n" };
        for n in 0..if kind == 1 { 1 } else { count } {
            let ((x, y, up), v) = (places[n], &speeds[3 * n..3 * n + 3]);
            toml += &format!("[[ball]]\nradius = {:?}\nmass = {:?}\n", 10_f64.powf(size), 10_f64.powf(masses[n]));
            toml += &match dimensions {
                1 => format!("height = {:?}\nvelocity = {:?}\n", up + 2.5 * f64::from(u32::try_from(n).unwrap()), v[0]),
                2 => format!("position = [{x:?}, {up:?}]\nvelocity = [{:?}, {:?}]\n", v[0], v[1]),
                _ => format!("position = [{x:?}, {y:?}, {up:?}]\nvelocity = [{:?}, {:?}, {:?}]\n", v[0], v[1], v[2]),
            };
        }
        toml += ["", "", "[floor]\nmotion = { amplitude = 0.01, frequency = 20 }\n", "[floor]\nkind = 'box'\nsize = [3, 3]\n", "[floor]\nkind = 'box'\nsize = [3, 3, 3]\n", ""][kind];
        let planned = match Scene::parse("random", toml.as_bytes()) {
            Ok(scene) => scene.plan().map_err(|error| error.to_string()),
            Err(error) => Err(error.to_string()),
        };
        let record = planned.and_then(|plan| plan.most_evaluations(200_000).run().map_err(|error| error.to_string()));
        match record {
            Ok(record) => {
                prop_assert!(record.until() <= 2.0, "{toml}");
                for ball in 0..record.balls() {
                    prop_assert!(record.at(ball, record.until()).is_some_and(|moment| moment.height().is_finite()), "{toml}");
                }
                prop_assert!(record.doubts().iter().all(|doubt| !doubt.contains(['{', '(', '\n'])), "{:?}", record.doubts());
            }
            Err(error) => prop_assert!(!error.is_empty(), "{toml}"),
        }
    }
}
