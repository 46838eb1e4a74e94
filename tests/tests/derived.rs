//! Structs of numbers as states: by name in flows, tables and errors.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use proptest::prelude::*;
use saltus::nalgebra::{Vector3, vector};
use saltus::{ErrorKind, Hybrid, Simulation, State};

/// A buck converter: coil and capacitor, and the time since its switch was closed.
#[derive(Clone, Copy, Debug, PartialEq, State, serde::Serialize, serde::Deserialize)]
struct Buck {
    #[unit("A")]
    current: f64,
    #[unit("V")]
    voltage: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, State)]
struct Pair(f64, [f64; 2]);

#[derive(Clone, Copy, Debug, PartialEq, State)]
struct Robot<L> {
    #[unit("m")]
    place: Vector3<f64>,
    r#type: f64,
    load: L,
    bucks: Pair,
}

fn robot(values: [f64; 9]) -> Robot<Buck> {
    let [a, b, c, d, e, f, g, h, i] = values;
    Robot { place: vector![a, b, c], r#type: d, load: Buck { current: e, voltage: f }, bucks: Pair(g, [h, i]) }
}

#[test]
fn coordinates_are_named_by_their_fields() {
    let x = robot([0.0; 9]);
    let names: Vec<_> = (0..x.len()).map(|i| x.name(i)).collect();
    let fields = [
        "place[0]",
        "place[1]",
        "place[2]",
        "type",
        "load.current",
        "load.voltage",
        "bucks.0",
        "bucks.1[0]",
        "bucks.1[1]",
    ];
    assert_eq!(names, fields);
    let units: Vec<_> = (0..x.len()).map(|i| x.unit(i)).collect();
    assert_eq!(units, ["m", "m", "m", "", "A", "V", "", "", ""]);
    assert_eq!(x.unit(9), "");
    assert!(x.get(9).is_nan());
}

proptest! {
    /// What is read is what was put there, coordinate by coordinate, and nothing else changes.
    #[test]
    fn a_struct_is_its_coordinates(values in prop::array::uniform9(-1e3..1e3_f64), place in 0..9_usize, other in -1e3..1e3_f64) {
        let x = robot(values);
        let read: Vec<f64> = (0..x.len()).map(|i| x.get(i)).collect();
        prop_assert_eq!(&read[..], &values[..]);
        let mut asked = Vec::new();
        let y = x.with(|i| { asked.push(i); if i == place { other } else { x.get(i) } });
        prop_assert_eq!(asked, (0..9).collect::<Vec<_>>());
        let mut expected = values;
        expected[place] = other;
        prop_assert_eq!(y, robot(expected));
    }
}

/// A named state runs as the array of its numbers does, to the bit.
#[test]
fn a_named_state_runs_like_an_array() {
    let (inductance, capacity, load) = (1e-3, 1e-4, 10.0);
    let named = Hybrid::new()
        .mode("on", |_t, x: &Buck| Buck {
            current: (12.0 - x.voltage) / inductance,
            voltage: (x.current - x.voltage / load) / capacity,
        })
        .mode("off", |_t, x| Buck {
            current: -x.voltage / inductance,
            voltage: (x.current - x.voltage / load) / capacity,
        })
        .edge("on", "off", |_t, x| 1.0 - x.current, |_t, x| *x)
        .edge("off", "on", |_t, x| x.current - 0.2, |_t, x| *x);
    let plain = Hybrid::new()
        .mode("on", |_t, x: &[f64; 2]| [(12.0 - x[1]) / inductance, (x[0] - x[1] / load) / capacity])
        .mode("off", |_t, x| [-x[1] / inductance, (x[0] - x[1] / load) / capacity])
        .edge("on", "off", |_t, x| 1.0 - x[0], |_t, x| *x)
        .edge("off", "on", |_t, x| x[0] - 0.2, |_t, x| *x);
    let run = Simulation::of(&named).run("on", Buck { current: 0.0, voltage: 0.0 }, 0.0..0.01).unwrap();
    let same = Simulation::of(&plain).run("on", [0.0; 2], 0.0..0.01).unwrap();
    assert!(run.trajectory.jumps().len() > 10);
    assert_eq!([run.end.state.current, run.end.state.voltage], same.end.state);
    assert_eq!(run.end.stats, same.end.stats);
    let table = run.trajectory.sampled(1e-3).to_string();
    assert!(table.starts_with("t (s),j,mode,current (A),voltage (V)\n0.0,0,on,0.0,0.0\n"), "{table}");
    let mut course = Simulation::of(&named).start("on", Buck { current: 0.0, voltage: 0.0 }, 0.0..0.01).unwrap();
    course.advance(&mut ()).unwrap();
    assert!(format!("{:?}", course.checkpoint()).contains("voltage"));
}

/// An error says which coordinate is no number, and the state by its names.
#[test]
fn errors_name_coordinates() {
    let model = Hybrid::new().mode("on", |t, x: &Buck| Buck { current: (0.5 - t).sqrt(), voltage: x.voltage });
    let failed = Simulation::of(&model).run("on", Buck { current: 1.0, voltage: 2.0 }, 0.0..1.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Flow);
    let text = failed.to_string();
    assert!(text.contains("(current' = NaN)") && text.contains("state (current = "), "{text}");
}
