//! Every number of a scene file, from zero to beyond what can be right: what comes of it is a run,
//! or an error that says the range.

use std::collections::BTreeSet;

use saltus_scene::{Run, Template};
use serde_json::Value;
use toml::de::{DeTable, DeValue};

/// What is tried in the place of each number.
const VALUES: [&str; 17] = [
    "0",
    "-1",
    "0.5",
    "1e-300",
    "1e-30",
    "1e-12",
    "1e-6",
    "1e6",
    "299792458.0",
    "1e12",
    "-1e12",
    "1e30",
    "1e99",
    "1e300",
    "nan",
    "inf",
    "-inf",
];

/// Scenes that have every number of the schema between them.
const SCENES: [&str; 22] = [
    "gravity = 9.8\nrestitution = 0.7\nball = { height = 1, velocity = 0.5 }",
    "gravity = 9.8\nrestitution = 0.7\nfriction = 0.3\nball = { height = 1, radius = 0.03, mass = 0.06, velocity = 0.5 }
    run = { until = 2, most_jumps = 50, tolerance = 1e-8 }",
    "restitution = 0.7\nball = { height = 1 }\ndrag = { rate = 0.1, per_length = 0.1 }",
    "restitution = 0.7\nfriction = { coefficient = 0.3, gripping = 0.2 }\nbuoyancy = true
    ball = { diameter = 0.06, mass = 0.06, inertia = 0.4, position = [0, 1], velocity = [3, 1], spin = -10 }
    air = { density = 1.2, viscosity = 1.8e-5, wind = [1, 0.1] }\ndrag = { coefficient = 0.4, viscous = true }
    magnus = { slope = 1, saturation = 2 }\nspin_decay = { time = 5 }\nrun = { until = 2 }",
    "restitution = 0.7\nball = { radius = 0.03, mass = 0.06, position = [0, 0, 1], velocity = [1, 1, 0], spin = [1, 2, 3] }
    drag = { per_length = 0.1 }\nspin_decay = { coefficient = 0.1 }\nrun = { until = 2 }",
    "restitution = 0.7\nball = { radius = 0.03, position = [0, 1], velocity = [1, 0] }\nrun = { until = 2 }
    floor = [{ kind = 'incline', angle = 0.3, height = 0, friction = 0.1, restitution = 0.6 }, { kind = 'wall', at = 2 }]",
    "restitution = 0.7\nball = { radius = 0.03, position = [0, 1], velocity = [1, 0] }\nrun = { until = 2 }
    floor = { kind = 'stairs', height = 0, from = 0.5, tread = 0.3, rise = 0.2, count = 5 }",
    "restitution = 0.7\nball = { radius = 0.03, position = [0, 1], velocity = [1, 0] }\nrun = { until = 2 }
    floor = { kind = 'box', size = [2, 2], height = 0 }",
    "restitution = 0.7\nball = { radius = 0.03, position = [0, 1], velocity = [1, 0] }\nrun = { until = 2 }
    floor = { kind = 'parabola', curvature = 0.5, centre = 0.2, height = 0 }",
    "restitution = 0.7\nball = { radius = 0.03, position = [0, 1], velocity = [1, 0] }\nrun = { until = 2 }
    floor = { kind = 'sine', amplitude = 0.05, wavelength = 1, phase = 0.2, height = 0 }",
    "restitution = 0.7\nball = { radius = 0.03, position = [0, 1], velocity = [1, 0] }\nrun = { until = 2 }
    floor = { kind = 'polyline', points = [[-2, 0.5], [0, 0], [2, 0.5]] }",
    "restitution = 0.5\nball = { height = 0.1 }\nrun = { until = 2 }
    floor = { height = -0.1, motion = { amplitude = 0.01, frequency = 20, phase = 0.3 } }",
    "restitution = 0.5\nball = { height = 0.1 }\nrun = { until = 2 }
    floor = { motion = { schedule = [[0.1, 0], [0.5, 0.1]] } }",
    "restitution = { law = 'linear', cor = 0.8, slope = -0.01, slowest = 0.1, fastest = 5 }\nball = { height = 1 }",
    "restitution = { law = 'knots', knots = [[1, 0.8], [3, 0.7]] }\nball = { height = 1 }",
    "restitution = { law = 'viscoelastic', cor = 0.8, speed = 2 }\nball = { height = 1 }",
    "restitution = { law = 'viscoelastic', dissipation = 1e-4, stiffness = 1e6, mass = 0.05 }\nball = { height = 1 }",
    "restitution = { law = 'plastic', yield_speed = 0.1 }\nball = { height = 1 }",
    "restitution = { range = [0.6, 0.8], pick = 0.5 }\nball = { height = 1 }",
    "contact = { law = 'kelvin-voigt', stiffness = 1e4, damping = 1 }
    ball = { radius = 0.03, mass = 0.06, height = 0.5 }\nrun = { until = 1, most_jumps = 50 }",
    "contact = { law = 'hunt-crossley', cor = 0.7, speed = 2, time = 0.005 }
    ball = { radius = 0.03, mass = 0.06, height = 0.5 }\nrun = { until = 1, most_jumps = 50 }",
    "contact = { law = 'hertz', ball = { young = 1e9, poisson = 0.3 }, floor = { young = 1e9, poisson = 0.3 } }
    ball = { radius = 0.03, mass = 0.06, height = 0.5 }\nrun = { until = 1, most_jumps = 50 }",
];

/// Words of libraries and of who writes models, which a scene's author cannot act upon.
const JARGON: [&str; 10] = [
    "floating point",
    "recurs",
    "About::",
    "Hybrid",
    "reset",
    "guard",
    "state [",
    "serde",
    "i128",
    "0000000000000000000000000000000",
];

/// The latest time that can be right, in s.
const LATEST: f64 = 1e12;

/// The most evaluations of a run here: what it may cost, whatever the number is.
const EVALUATIONS: u64 = 20_000;

/// The path of every number in a scene.
fn numbers(value: &DeValue<'_>, path: &str, found: &mut Vec<String>) {
    let deeper = |step: &str| if path.is_empty() { step.to_owned() } else { format!("{path}.{step}") };
    match value {
        DeValue::Integer(_) | DeValue::Float(_) => found.push(path.to_owned()),
        DeValue::Array(list) => {
            list.iter().enumerate().for_each(|(n, item)| numbers(item.get_ref(), &deeper(&n.to_string()), found));
        }
        DeValue::Table(table) => {
            table.iter().for_each(|(key, item)| numbers(item.get_ref(), &deeper(key.get_ref()), found));
        }
        _ => {}
    }
}

#[test]
fn every_number_is_run_or_its_range_is_said() {
    let mut keys = BTreeSet::new();
    let (mut runs, mut refused) = (0, 0);
    for toml in SCENES {
        let mut found = Vec::new();
        let table = DeTable::parse(toml).unwrap().into_inner();
        numbers(&DeValue::Table(table), "", &mut found);
        for path in &found {
            keys.extend(path.rsplit('.').find(|step| step.parse::<u32>().is_err()).map(str::to_owned));
            let template = Template::parse("scene", toml.as_bytes(), &[path]).unwrap();
            for value in VALUES {
                let here = format!("{path} = {value} in\n{toml}");
                let says = match template.scene(&[value], Run::default()) {
                    Err(error) => {
                        assert!(error.help().is_some(), "{here}\n{error}");
                        Some(error.to_string())
                    }
                    Ok(scene) => match scene.plan().map(|plan| plan.most_evaluations(EVALUATIONS).outcome()) {
                        Err(error) => Some(error.to_string()),
                        Ok(Err(error)) => Some(error.to_string()),
                        Ok(Ok(outcome)) => {
                            assert!(outcome.until <= LATEST, "{here}");
                            let finite = |moment: &saltus_scene::plan::Moment| {
                                moment.position.iter().chain(&moment.velocity).all(|x| x.is_finite())
                            };
                            assert!(outcome.balls.iter().all(finite), "{here}");
                            runs += 1;
                            None
                        }
                    },
                };
                if let Some(says) = says {
                    refused += 1;
                    let jargon = JARGON.iter().find(|word| says.contains(**word));
                    assert!(jargon.is_none(), "{here}\n{says}");
                }
            }
        }
    }
    assert!(runs > 1000 && refused > 1000, "{runs} {refused}");
    // No number of the schema is left out.
    let schema: Value = serde_json::from_str(saltus_scene::schema()).unwrap();
    let mut tables = vec![&schema];
    tables.extend(schema["definitions"].as_object().unwrap().values());
    for (key, value) in tables.iter().filter_map(|table| table["properties"].as_object()).flatten() {
        let text = value.to_string();
        let quantity = ["#/definitions/", "\"number\"", "\"integer\""].iter().any(|word| text.contains(word));
        let table = [
            "ball",
            "floor",
            "air",
            "drag",
            "magnus",
            "spin_decay",
            "contact",
            "collisions",
            "run",
            "picture",
            "motion",
        ];
        assert!(!quantity || keys.contains(key) || table.contains(&key.as_str()), "no scene has `{key}`: {text}");
    }
}

/// A flow that steps hardly get on with ends all the same, and says so.
#[test]
fn a_run_that_gets_nowhere_ends() {
    let toml = b"restitution = 0.7\nball = { height = 1 }\ndrag = { rate = 3e8, per_length = 0.1 }\nrun = { until = 1, most_jumps = 100 }";
    let scene = saltus_scene::Scene::parse("stiff", toml).unwrap();
    let outcome = scene.plan().unwrap().most_evaluations(1_000_000).outcome().unwrap();
    assert!(outcome.end.to_string().contains("allow more by `most_jumps` under [run]"), "{}", outcome.end);
}
