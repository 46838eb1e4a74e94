//! Squash, stretch and spin, read back from glTF by its own crate, and from the other formats by
//! plain parsing.

use crate::drop::{G, drop};
use crate::glb::{channels, seen};
use gltf::animation::Property;
use proptest::prelude::*;
use saltus_cases::cases;
use saltus_motion::{Contact, Export, Format, Frames, Motion, Piece, Shape, Snap, Stretch, Track};
use serde_json::Value;

fn frames() -> Frames {
    Frames::new("24".parse().unwrap())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(48)))]

    #[test]
    fn the_volume_stays_and_the_floor_is_kept(
        height in 0.2..3.0_f64, cor in 0.3..0.9_f64, hops in 0..4_usize, sideways in -2.0..2.0_f64, radius in 0.01..0.2_f64,
        squash in 0.0..0.7_f64, stretch in 0.01..0.5_f64, hold in 1..4_u32, snap in any::<bool>(),
    ) {
        let mut motion = drop(height, cor, hops, sideways, [0.0; 3], radius).cut(1.0 / 24.0);
        if snap {
            motion = motion.snapped(Snap::Gravity, frames()).unwrap();
        }
        let contacts = motion.tracks[0].stretches.iter().filter(|s| s.flight && s.contact.is_some()).count();
        let hold = f64::from(hold) / 24.0;
        let held = motion.held(hold).unwrap();
        prop_assert!((held.end() - motion.end() - hold * contacts as f64).abs() < 1e-9);
        let shape = Shape { squash, stretch, hold };
        let file = Export { shape, ..Export::new(&held, frames()) }.file(Format::Glb).unwrap();
        let both = channels(&file.bytes);
        // On its keys a form is exact to single precision; between them cubics are within 0.1 %,
        // straight lines within the error of the file.
        for scale in both.iter().flatten().filter(|c| c.property == Property::Scale) {
            for t in &scale.times {
                prop_assert!((scale.at(*t).iter().product::<f64>() - 1.0).abs() < 2e-6);
            }
        }
        let shown = file.shown.unwrap();
        prop_assert!(shown.least >= 1.0 - squash - 1e-3 && shown.most <= 1.0 + stretch + 1e-3, "{shown:?}");
        for k in 0..=1000 {
            let t = held.end() * f64::from(k) / 1000.0;
            let (volume, lowest) = seen(&both[1], radius, t);
            prop_assert!((volume - 1.0).abs() < 1e-3, "volume {volume} at {t} s");
            // Next to a contact the axis turns to the normal within a hundredth of a frame, in the
            // air.
            let place = held.tracks[0].at(t)[2];
            prop_assert!((lowest - place).abs() < 0.01 * radius + 2e-6, "lowest {lowest} at {t} s, not {place}");
            prop_assert!(lowest > -1e-3 * radius - 2e-6, "lowest {lowest} at {t} s");
            let (volume, lowest) = seen(&both[0], radius, t);
            prop_assert!((volume - 1.0).abs() < 1.2 * shown.volume + 1e-5, "volume {volume} at {t} s");
            prop_assert!(lowest > -(1.2 * shown.sunk + 1e-6), "lowest {lowest} at {t} s, said {}", shown.sunk);
        }
        // Every whole frame, as an animator steps through it.
        for frame in 0..=(held.end() * 24.0) as u32 {
            prop_assert!(seen(&both[1], radius, f64::from(frame) / 24.0).1 > -1e-3 * radius - 2e-6);
        }
    }

    #[test]
    fn a_spin_is_kept_however_fast(rate in -400.0..400.0_f64, tilt in prop_oneof![Just(0.0), -1.0..1.0_f64]) {
        let axis = [tilt, -(1.0 - tilt * tilt).sqrt(), 0.0];
        let motion = drop(1.0, 0.6, 2, 0.5, axis.map(|c| c * rate), 0.03);
        let export = Export::new(&motion, frames());
        let file = export.file(Format::Glb).unwrap();
        for animation in channels(&file.bytes) {
            let spin = animation.iter().find(|c| c.property == Property::Rotation).unwrap();
            for pair in spin.rows.windows(2) {
                let dot: f64 = pair[0].iter().zip(&pair[1]).map(|(a, b)| a * b).sum();
                prop_assert!(dot > 0.0, "more than half a turn from key to key");
            }
            for k in 0..=500 {
                let t = motion.end() * f64::from(k) / 500.0;
                let half = 0.5 * rate * t;
                // (x, y, up) is (x, up, -y) there.
                let wanted = [axis[0] * half.sin(), axis[2] * half.sin(), -axis[1] * half.sin(), half.cos()];
                let dot: f64 = spin.at(t).iter().zip(wanted).map(|(a, b)| a * b).sum();
                prop_assert!(2.0 * dot.abs().min(1.0).acos() < 0.012, "at {t} s");
            }
        }
        // Programs that count angles count whole turns too.
        if tilt == 0.0 {
            let document: Value = serde_json::from_slice(&export.file(Format::Json).unwrap().bytes).unwrap();
            let last = document["balls"][0]["spin"].as_array().unwrap().last().unwrap();
            let turned = last["angle"].as_f64().unwrap();
            prop_assert!((turned - rate * last["t"].as_f64().unwrap()).abs() < 1e-6 * (1.0 + turned.abs()));
        }
    }
}

#[test]
fn a_spin_that_changes_its_axis_follows_its_equation() {
    // ω = (3, 10 t, 40 - 20 t): integrated here by Runge and Kutta in small steps.
    let coefficients = vec![[0.0, 0.0, 1.0], [0.0; 3], [0.0, 0.0, -0.5 * G]];
    let spin = vec![[3.0, 0.0, 40.0], [0.0, 10.0, -20.0]];
    let piece = Piece { start: 0.0, span: 0.4, coefficients, spin };
    let stretch = Stretch { contact: None, flight: true, pieces: vec![piece] };
    let track = Track { name: "ball".into(), radius: 0.1, stretches: vec![stretch] };
    let motion = Motion::new("spin", vec![track], Vec::new()).unwrap();
    let export = Export::new(&motion, frames());
    let document: Value = serde_json::from_slice(&export.file(Format::Json).unwrap().bytes).unwrap();
    let rate = |t: f64, [x, y, z, w]: [f64; 4]| {
        let [a, b, c] = [3.0, 10.0 * t, 40.0 - 20.0 * t];
        [
            0.5 * (a * w + b * z - c * y),
            0.5 * (b * w + c * x - a * z),
            0.5 * (c * w + a * y - b * x),
            -0.5 * (a * x + b * y + c * z),
        ]
    };
    let (mut q, steps) = ([0.0, 0.0, 0.0, 1.0], 4000);
    let mut turns = document["balls"][0]["spin"].as_array().unwrap().iter().peekable();
    let mut compared = 0;
    for k in 0..=steps {
        let (t, h) = (0.4 * f64::from(k) / f64::from(steps), 0.4 / f64::from(steps));
        while let Some(turn) = turns.next_if(|turn| turn["t"].as_f64().unwrap() < t + 0.5 * h) {
            let there: Vec<f64> = turn["quaternion"].as_array().unwrap().iter().map(|c| c.as_f64().unwrap()).collect();
            let dot: f64 = there.iter().zip(q).map(|(a, b)| a * b).sum();
            // Half a step of the comparison turns by 0.002.
            assert!(2.0 * dot.abs().min(1.0).acos() < 0.005, "{turn}");
            compared += 1;
        }
        let step = |q: [f64; 4], d: [f64; 4], h: f64| std::array::from_fn(|n| q[n] + h * d[n]);
        let a = rate(t, q);
        let b = rate(t + 0.5 * h, step(q, a, 0.5 * h));
        let c = rate(t + 0.5 * h, step(q, b, 0.5 * h));
        let d = rate(t + h, step(q, c, h));
        q = std::array::from_fn(|n| q[n] + h / 6.0 * (a[n] + 2.0 * b[n] + 2.0 * c[n] + d[n]));
    }
    assert!(compared > 6, "{compared}");
}

/// A ball that sinks 4 mm into the floor and comes out again, in half a sine's time, as a parabola.
fn soft() -> Motion {
    let mut motion = drop(1.0, 0.6, 1, 0.0, [0.0; 3], 0.02);
    let stretches = &mut motion.tracks[0].stretches;
    let (deep, span) = (0.004, 0.1);
    let start = stretches[1].start();
    let pieces = vec![Piece {
        start,
        span,
        coefficients: vec![[0.0; 3], [0.0, 0.0, -4.0 * deep / span], [0.0, 0.0, 4.0 * deep / (span * span)]],
        spin: Vec::new(),
    }];
    let contact = Some(Contact { pressed: true, ..stretches[1].contact.unwrap() });
    stretches.insert(1, Stretch { contact, flight: false, pieces });
    stretches[2].contact = None;
    for stretch in &mut stretches[2..] {
        stretch.pieces.iter_mut().for_each(|piece| piece.start += span);
    }
    motion
}

#[test]
fn a_contact_that_takes_time_squashes_as_its_law_has_it() {
    let motion = soft();
    assert!((motion.deformation() - 0.2).abs() < 1e-12);
    // With the law's own amount the middle of the ball goes where the motion has it; twice as much
    // puts it lower.
    for factor in [1.0, 2.0] {
        let shape = Shape { squash: factor * motion.deformation(), stretch: 0.0, hold: 0.0 };
        let file = Export { tolerance: 1e-6, shape, ..Export::new(&motion, frames()) }.file(Format::Glb).unwrap();
        let exact = &channels(&file.bytes)[1];
        let track = &motion.tracks[0];
        let contact = &track.stretches[1];
        for k in 0..=100 {
            let t = contact.start() + contact.span() * f64::from(k) / 100.0;
            let deep = -track.at(t)[2];
            let at =
                |node| exact.iter().find(|c| c.node == node && c.property == Property::Translation).unwrap().at(t)[1];
            let middle = at(0) + at(2);
            assert!((middle - (0.02 - factor * deep)).abs() < 3e-6, "{middle} at {t}");
            let (volume, lowest) = seen(exact, 0.02, t);
            assert!((volume - 1.0).abs() < 1e-3 && lowest.abs() < 4e-6, "{volume} {lowest} at {t}");
        }
        assert!((file.shown.unwrap().least - (1.0 - 0.2 * factor)).abs() < 1e-3);
    }
    // Held, it is as slow as that.
    let held = motion.held(0.25).unwrap();
    assert!((held.tracks[0].stretches[1].span() - 0.25).abs() < 1e-12);
    assert!((held.deformation() - 0.2).abs() < 1e-12);
}

#[test]
fn every_format_holds_the_squash() {
    let motion = drop(1.0, 0.6, 2, 0.3, [0.0, -5.0, 0.0], 0.05).snapped(Snap::Gravity, frames()).unwrap();
    let held = motion.held(2.0 / 24.0).unwrap();
    let shape = Shape { squash: 0.4, stretch: 0.0, hold: 2.0 / 24.0 };
    let text = |format| {
        let file = Export { shape, ..Export::new(&held, frames()) }.file(format).unwrap();
        String::from_utf8(file.bytes).unwrap()
    };
    // The middle of the first hold is frame 12, where the ball is shortest: 0.6 of its height, and
    // 1/√0.6 of its width.
    let (least, most) = (0.6, 1.0 / 0.6_f64.sqrt());
    let close = |a: f64, b: f64| assert!((a - b).abs() < 2e-4, "{a} is not {b}");

    let csv = text(Format::CsvFrames);
    let header: Vec<&str> = csv.lines().next().unwrap().split(',').collect();
    let column = |name: &str| header.iter().position(|cell| *cell == name).unwrap();
    let row: Vec<f64> = csv
        .lines()
        .map(|line| line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect::<Vec<_>>())
        .find(|row| row[1] == 12.0)
        .unwrap();
    close(row[column("along")], least);
    close(row[column("across")], most);
    close(row[column("centre_up_m")], 0.05 * least);
    let turn = row[column("turn_y")].atan2(row[column("turn_w")]);
    // Two frames of the twelve the ball was held, and did not turn.
    close(-2.0 * turn, 5.0 * 11.0 / 24.0 * (2.0_f64 / G).sqrt() / (11.0 / 24.0));

    let usd = text(Format::Usd);
    let samples = usd.split_once("xformOp:scale.timeSamples = {").unwrap().1.split('}').next().unwrap();
    let row = samples.lines().find_map(|line| line.trim().strip_prefix("12: (")).unwrap();
    let row: Vec<f64> = row.trim_end_matches("),").split(", ").map(|c| c.parse().unwrap()).collect();
    close(row[1], least);
    close(row[0], most);

    let splines = text(Format::UsdSplines);
    assert!(splines.contains("xformOp:scaleY.spline") && splines.contains("quatd xformOp:orient.timeSamples"));

    let lottie: Value = serde_json::from_str(&text(Format::Lottie)).unwrap();
    let mut found = 0;
    for layer in lottie["layers"].as_array().unwrap() {
        let Some(keys) = layer["ks"]["s"]["k"].as_array().filter(|_| layer["ks"]["s"]["a"] == 1) else { continue };
        let axis = usize::from(keys.iter().any(|key| key["s"][1].as_f64().unwrap() < 100.0));
        let values = keys.iter().map(|key| key["s"][axis].as_f64().unwrap());
        let extreme = if axis == 1 { values.fold(f64::INFINITY, f64::min) } else { values.fold(0.0, f64::max) };
        close(extreme / 100.0, if axis == 1 { least } else { most });
        found += 1;
    }
    assert_eq!(found, 2);

    let svg = text(Format::Svg);
    let values = |name: &str| -> Vec<f64> {
        svg.match_indices(name)
            .map(|(n, _)| svg[n + name.len()..].split(')').next().unwrap().parse().unwrap())
            .collect()
    };
    close(values("scaleY(").into_iter().fold(f64::INFINITY, f64::min), least);
    close(values("scaleX(").into_iter().fold(0.0, f64::max), most);

    for format in [Format::Blender, Format::Maya] {
        let script = text(format);
        let data: Value =
            serde_json::from_str(script.split_once("r'''").unwrap().1.split("'''").next().unwrap()).unwrap();
        let nodes = data["balls"][0]["nodes"].as_array().unwrap();
        assert_eq!(nodes.len(), 3);
        assert!(nodes[1]["scale"].is_object() && nodes[1]["place"].is_object() && nodes[2]["turns"].is_object());
    }
}

#[test]
fn what_cannot_be_squashed_is_refused() {
    let motion = drop(1.0, 0.6, 2, 0.3, [0.0; 3], 0.05);
    let refused = |shape| {
        let export = Export { shape, ..Export::new(&motion, frames()) };
        export.file(Format::Csv).unwrap_err().to_string()
    };
    assert!(refused(Shape { squash: 1.0, ..Shape::default() }).contains("squash it by 0 to 0.9"));
    assert!(refused(Shape { stretch: f64::NAN, ..Shape::default() }).contains("stretch it by 0 to 2"));
    let two = Motion::new("two", [&motion.tracks[..], &motion.tracks[..]].concat(), Vec::new()).unwrap();
    assert!(two.held(0.1).unwrap_err().to_string().contains("only one ball can be held"));
}

#[test]
fn a_timing_chart_has_a_tick_for_every_frame() {
    for (sideways, ends) in [(0.0, 3), (1.0, 0)] {
        let motion = drop(1.0, 0.6, 2, sideways, [0.0; 3], 0.05).snapped(Snap::Gravity, frames()).unwrap();
        let export = Export::new(&motion, frames());
        let bytes = export.file(Format::Chart).unwrap().bytes;
        let text = String::from_utf8(bytes).unwrap();
        let document = roxmltree::Document::parse(&text).unwrap();
        let count = |class: &str| document.descendants().filter(|n| n.attribute("class") == Some(class)).count() - 1;
        let contacts = motion.tracks[0].contacts().count();
        // In columns a contact stands at the end of one and at the start of the next; the last
        // leads nowhere.
        assert_eq!(count("contact"), contacts + ends - usize::from(ends > 0));
        assert!(count("top") >= 3);
        let frames = (motion.end() * 24.0).round() as usize + 1;
        if ends == 0 {
            assert!(count("frame") + count("contact") + count("top") >= frames, "{}", count("frame"));
        }
        let numbers = document.descendants().filter_map(|n| n.text()).filter(|t| t.parse::<f64>().is_ok()).count();
        assert!(numbers > contacts + 8, "{numbers}");
    }
}
