//! A planted ball is read back in every unit and with either axis upwards.

use crate::drop::{G, drop};
use saltus_motion::{Export, File, Format, Frames, Motion, Shape, Space, Unit, Up};
use serde_json::Value;

/// Where the ball is aside, in m, and how fast it turns about that axis, in rad/s.
const ASIDE: f64 = 0.25;
const SPIN: f64 = 3.0;

/// A drop of a metre, a quarter of one behind the plane of the picture, on a floor.
fn planted() -> Motion {
    let mut motion = drop(1.0, 0.7, 3, 0.8, [0.0, SPIN, 0.0], 0.05);
    for stretch in &mut motion.tracks[0].stretches {
        stretch.pieces.iter_mut().for_each(|piece| piece.coefficients[0][1] = ASIDE);
    }
    motion.ground = vec![vec![[-0.5, 0.0], [1.5, 0.0]]];
    motion
}

const SQUASHED: Shape = Shape { squash: 0.3, stretch: 0.1, hold: 2.0 / 24.0 };

fn export(motion: &Motion, shape: Shape, space: Space) -> Export<'_> {
    let frames = Frames::new("24".parse().unwrap());
    Export { shape, space, ..Export::new(motion, frames) }
}

fn written(motion: &Motion, format: Format, space: Space) -> String {
    String::from_utf8(export(motion, Shape::default(), space).file(format).unwrap().bytes).unwrap()
}

/// How many of a unit a metre has, not by the code under test.
fn per_metre(unit: Unit) -> f64 {
    match unit {
        Unit::Metre => 1.0,
        Unit::Centimetre => 100.0,
        Unit::Millimetre => 1000.0,
        Unit::Inch => 1.0 / 0.0254,
        Unit::Foot => 1.0 / 0.3048,
    }
}

fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-13 * b.abs().max(1.0)
}

/// The numbers between the brackets of a line.
fn row(line: &str) -> Vec<f64> {
    let inside = line.split_once('(').unwrap().1.split(')').next().unwrap();
    inside.split(',').map(|cell| cell.trim().parse().unwrap()).collect()
}

/// The rows of one attribute of a stage.
fn rows(usd: &str, attribute: &str) -> Vec<Vec<f64>> {
    let (_, rest) = usd.split_once(&format!("{attribute}.timeSamples = {{\n")).unwrap();
    rest.split('}').next().unwrap().lines().filter(|line| line.contains('(')).map(row).collect()
}

fn spaces() -> impl Iterator<Item = (Space, f64)> {
    let with = |unit| [None, Some(Up::Y), Some(Up::Z)].map(|up| (Space { unit, up }, per_metre(unit)));
    Unit::ALL.into_iter().flat_map(with)
}

#[test]
fn usd_says_its_unit_and_its_axis() {
    let motion = planted();
    let metres = rows(&written(&motion, Format::Usd, Space::default()), "xformOp:translate");
    assert_eq!(metres[0], [0.0, 1.0, -ASIDE]);
    for (space, per) in spaces() {
        let upwards = space.up == Some(Up::Z);
        let turned = |[x, y, up]: [f64; 3]| if upwards { [x, y, up] } else { [x, up, -y] };
        let usd = written(&motion, Format::Usd, space);
        assert!(usd.contains(&format!("upAxis = \"{}\"", if upwards { "Z" } else { "Y" })));
        let said: f64 = usd.split_once("metersPerUnit = ").unwrap().1.lines().next().unwrap().parse().unwrap();
        assert!(near(said * per, 1.0), "{space:?}: {said}");
        let places = rows(&usd, "xformOp:translate");
        assert_eq!(places.len(), metres.len());
        for (place, metre) in places.iter().zip(&metres) {
            let expected = turned([metre[0], -metre[2], metre[1]]).map(|c| per * c);
            assert!(place.iter().zip(expected).all(|(a, b)| near(*a, b)), "{space:?}: {place:?}, {expected:?}");
        }
        // The axis of the spin is that of aside, whatever its name.
        let turn = rows(&usd, "xformOp:orient").swap_remove(1);
        let axis = turned([0.0, (1.0 - turn[0] * turn[0]).sqrt(), 0.0]);
        assert!(turn[1..].iter().zip(axis).all(|(a, b)| (a - b).abs() < 1e-12), "{space:?}: {turn:?}, {axis:?}");
        let number = |name: &str| -> f64 { usd.split_once(name).unwrap().1.lines().next().unwrap().parse().unwrap() };
        assert!(near(number("double radius = "), 0.05 * per));
        let corner = row(usd.split_once("points = [").unwrap().1);
        let depth = corner[if upwards { 1 } else { 2 }].abs();
        let expected = turned([-0.5 * per, -depth, 0.0]);
        assert!(corner.iter().zip(expected).all(|(a, b)| near(*a, b)) && depth > 0.05 * per, "{space:?}: {corner:?}");

        // Splines: the first knot of the axis that is up, and of the one that is not.
        let splines = written(&motion, Format::UsdSplines, space);
        let first = |axis: &str| -> f64 {
            let (_, rest) = splines.split_once(&format!("xformOp:translate{axis}.spline = {{")).unwrap();
            let knot = rest.lines().find(|line| line.contains(": ")).unwrap();
            knot.split_once(": ").unwrap().1.split(';').next().unwrap().parse().unwrap()
        };
        let [_, y, z] = turned([0.0, ASIDE * per, per]);
        assert!(near(first("Y"), y) && near(first("Z"), z), "{space:?}");
    }
}

/// What a format does by itself is what it does when that is asked for.
#[test]
fn the_own_axis_changes_no_bit() {
    let motion = planted();
    for (format, own) in
        [(Format::Usd, Up::Y), (Format::UsdSplines, Up::Y), (Format::Blender, Up::Z), (Format::Maya, Up::Y)]
    {
        let with = |up| written(&motion, format, Space { unit: Unit::Metre, up });
        assert_eq!(with(None), with(Some(own)), "{format:?}");
    }
}

#[test]
fn tables_have_the_unit_in_their_headings() {
    let motion = planted();
    for unit in Unit::ALL {
        let (space, per, symbol) = (Space { unit, up: None }, per_metre(unit), unit.symbol());
        for format in [Format::Csv, Format::CsvFrames] {
            let csv = written(&motion, format, space);
            let mut lines = csv.lines().map(|line| line.split(',').collect::<Vec<_>>());
            let head = lines.next().unwrap();
            let column = |name: &str| head.iter().position(|cell| *cell == name).unwrap_or_else(|| panic!("{name}"));
            let (aside, height) = (column(&format!("y_{symbol}")), column(&format!("height_{symbol}")));
            let (time, speed) = (column("time_s"), column(&format!("out_up_{symbol}_per_s")));
            for line in lines {
                let number = |n: usize| line[n].parse::<f64>().unwrap();
                // A frame next to a contact shows the contact.
                let contact = motion.tracks[0].contacts().find(|t| (t - number(time)).abs() < 0.1 / 24.0);
                let t = contact.filter(|_| line[column("contact")] == "1").unwrap_or(number(time));
                let (place, slope) = (motion.tracks[0].at(t), motion.tracks[0].stretch(t).slope(t));
                assert!(
                    near(number(aside) / per, ASIDE) && near(number(height) / per, place[2]),
                    "{format:?} {unit:?}: {line:?} {place:?}"
                );
                if format == Format::Csv {
                    assert!((number(speed) / per - slope[2]).abs() < 1e-9, "{unit:?}");
                }
            }
        }
        let contacts = written(&motion, Format::Contacts, space);
        let (head, rows) = contacts.split_once('\n').unwrap();
        assert!(head.ends_with(&format!(",speed_{symbol}_per_s")) && head.contains(&format!(",height_{symbol},")));
        let speed: f64 = rows.lines().next().unwrap().rsplit(',').next().unwrap().parse().unwrap();
        assert!((speed / per - (2.0 * G).sqrt()).abs() < 1e-12);
    }
}

#[test]
fn scripts_set_the_unit_of_the_scene() {
    let motion = planted();
    let data = |format, unit| -> Value {
        let script = written(&motion, format, Space { unit, up: None });
        serde_json::from_str(script.split_once("r'''").unwrap().1.split("'''").next().unwrap()).unwrap()
    };
    for unit in Unit::ALL {
        let per = per_metre(unit);
        let blender = data(Format::Blender, unit);
        let ball = &blender["balls"][0];
        assert!(near(ball["radius"].as_f64().unwrap(), 0.05 * per));
        assert!(near(ball["nodes"][0]["place"]["keys"][2][0][1].as_f64().unwrap(), per));
        match unit {
            Unit::Metre => assert_eq!(blender["unit"], Value::Null, "the scene's own setting stays"),
            _ => assert!(near(blender["unit"]["metres"].as_f64().unwrap() * per, 1.0)),
        }
        let maya = data(Format::Maya, unit);
        assert_eq!(maya["linear"], unit.symbol());
        assert!(near(maya["centimetres"].as_f64().unwrap() * per, 100.0));
        assert!(near(maya["balls"][0]["nodes"][0]["place"]["keys"][0]["value"][1].as_f64().unwrap(), per));
    }
}

/// The errors of a file are in metres whatever its unit; a form has none.
#[test]
fn what_is_said_stays_in_metres() {
    let motion = planted().held(SQUASHED.hold).unwrap();
    let file = |unit| -> File { export(&motion, SQUASHED, Space { unit, up: None }).file(Format::Usd).unwrap() };
    let scales = |file: &File| rows(std::str::from_utf8(&file.bytes).unwrap(), "xformOp:scale");
    let metres = file(Unit::Metre);
    let shown = metres.shown.unwrap();
    for unit in Unit::ALL {
        let other = file(unit);
        assert_eq!(other.keys, metres.keys, "{unit:?}");
        assert!((other.miss.height - metres.miss.height).abs() < 1e-12);
        assert!((other.miss.place - metres.miss.place).abs() < 1e-12);
        let seen = other.shown.unwrap();
        assert!((seen.moved - shown.moved).abs() < 1e-12 && (seen.sunk - shown.sunk).abs() < 1e-12);
        assert!((seen.least - shown.least).abs() < 1e-12 && (seen.volume - shown.volume).abs() < 1e-12);
        let far = scales(&other).concat().iter().zip(scales(&metres).concat()).any(|(a, b)| (a - b).abs() > 1e-9);
        assert!(!far && scales(&other).len() == scales(&metres).len(), "{unit:?}");
    }
}

/// Every format takes its own space, and each other one is taken or refused with a reason.
#[test]
fn every_format_takes_or_refuses() {
    let motion = planted();
    for format in Format::ALL {
        let file = |space| export(&motion, Shape::default(), space).file(format);
        assert!(file(Space::default()).is_ok());
        let taken = Unit::ALL.into_iter().filter(|&unit| file(Space { unit, up: None }).is_ok()).count();
        assert!(taken == 1 || taken == Unit::ALL.len(), "{format:?} takes all units or its own");
        for space in [Space { unit: Unit::Inch, up: None }, Space { unit: Unit::Metre, up: Some(Up::Z) }] {
            if let Err(error) = file(space) {
                let says = error.to_string();
                let starts = says.starts_with(&format!("{} cannot ", format.name()));
                assert!(starts && says.contains(": ") && says.contains("; leave out the "), "{says}");
            }
        }
    }
}
