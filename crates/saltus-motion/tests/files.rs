//! Every format is read back by a reader that is not ours, and compared with the closed form.

use saltus_motion::{Contact, Export, File, Format, Frames, Motion, Piece, Snap, Stretch, Track};
use serde_json::Value;

const G: f64 = 9.81;
/// Rebounds to 30 % of the height.
const COR: f64 = 0.547_722_557_505_166_1;
const SIDEWAYS: f64 = 0.4;

/// One metre, three hops, then rest: with the times at which each flight starts.
fn drop(hops: usize, sideways: f64) -> (Motion, Vec<f64>) {
    let (mut t, mut speed, mut height) = (0.0, 0.0, 1.0);
    let mut span = (2.0 / G).sqrt();
    let (mut stretches, mut starts) = (Vec::new(), Vec::new());
    let mut arc = |t: f64, span: f64, height: f64, speed: f64, flight: bool| {
        let pull = if flight { -0.5 * G } else { 0.0 };
        let coefficients = vec![[sideways * t, 0.0, height], [sideways, 0.0, speed], [0.0, 0.0, pull]];
        let contact = (t > 0.0).then(|| Contact::level(speed / COR));
        stretches.push(Stretch {
            contact,
            flight,
            pieces: vec![Piece { start: t, span, coefficients, spin: Vec::new() }],
        });
    };
    for _ in 0..=hops {
        arc(t, span, height, speed, true);
        starts.push(t);
        t += span;
        speed = COR * (G * span - speed);
        span = 2.0 * speed / G;
        height = 0.0;
    }
    arc(t, 0.2, 0.0, 0.0, false);
    starts.push(t);
    let ball = Track { name: "squash & \"ball\"".into(), radius: 0.02, stretches };
    (Motion::new("drop <1 m>", vec![ball], vec![vec![[-0.5, 0.0], [1.5, 0.0]]]).unwrap(), starts)
}

/// The closed form.
fn height(starts: &[f64], t: f64) -> f64 {
    let n = starts.partition_point(|&start| start <= t) - 1;
    if n + 1 == starts.len() {
        0.0
    } else if n == 0 {
        1.0 - 0.5 * G * t * t
    } else {
        let s = t - starts[n];
        0.5 * G * s * (starts[n + 1] - starts[n] - s)
    }
}

fn frames(text: &str) -> Frames {
    Frames::new(text.parse().unwrap())
}

fn file(motion: &Motion, format: Format) -> File {
    Export::new(motion, frames("24")).file(format).unwrap()
}

fn text(file: &File) -> &str {
    std::str::from_utf8(&file.bytes).unwrap()
}

/// The worst distance in height between a reader and the closed form.
fn worst(starts: &[f64], end: f64, read: impl Fn(f64) -> f64) -> f64 {
    let at = |k: u32| f64::from(k) / 1000.0 * end;
    (0..1000).map(|k| (read(at(k)) - height(starts, at(k))).abs()).fold(0.0, f64::max)
}

/// The chord error of frames, g/(8 fps²).
const CHORD: f64 = G / (8.0 * 24.0 * 24.0);

#[test]
fn gltf_holds_frames_first_and_the_exact_motion_second() {
    use gltf::animation::Interpolation;
    use gltf::animation::util::ReadOutputs;
    let (motion, starts) = drop(3, SIDEWAYS);
    let file = file(&motion, Format::Glb);
    let glb = gltf::Gltf::from_slice(&file.bytes).unwrap();
    let blob = glb.blob.clone().unwrap();
    let animations: Vec<_> = glb.animations().collect();
    assert_eq!(animations.iter().filter_map(gltf::Animation::name).collect::<Vec<_>>(), ["frames", "exact"]);
    for (animation, promised) in animations.iter().zip([1.001 * CHORD, 1e-6]) {
        let channel = animation.channels().next().unwrap();
        let reader = channel.reader(|_| Some(&blob));
        let times: Vec<f64> = reader.read_inputs().unwrap().map(f64::from).collect();
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
        let Some(ReadOutputs::Translations(rows)) = reader.read_outputs() else { panic!("no translations") };
        let rows: Vec<f64> = rows.map(|[_, up, _]| f64::from(up)).collect();
        let cubic = channel.sampler().interpolation() == Interpolation::CubicSpline;
        let read = |t: f64| {
            let n = times.partition_point(|&key| key <= t).clamp(1, times.len() - 1);
            let h = times[n] - times[n - 1];
            let u = (t - times[n - 1]) / h;
            if !cubic {
                return rows[n - 1] + (rows[n] - rows[n - 1]) * u;
            }
            // As the specification has it, with tangents per second.
            let (p, m, q, w) = (rows[3 * n - 2], h * rows[3 * n - 1], rows[3 * n + 1], h * rows[3 * n]);
            let (uu, uuu) = (u * u, u * u * u);
            (2.0 * uuu - 3.0 * uu + 1.0) * p + (uuu - 2.0 * uu + u) * m + (3.0 * uu - 2.0 * uuu) * q + (uuu - uu) * w
        };
        let missed = worst(&starts, motion.end(), read);
        assert!(missed < promised, "{:?}: {missed}", animation.name());
        let touches = if cubic { rows.iter().skip(1).step_by(3).copied().collect::<Vec<_>>() } else { rows.clone() };
        assert!(touches.iter().all(|&up| up >= 0.0));
        assert_eq!(starts[1..].iter().filter(|&&t| read(f64::from(t as f32)).abs() < 1e-6).count(), 4);
    }
    assert!((file.miss.height - CHORD).abs() < 1e-5);
    // True scale: the sphere is as large as the ball, the ground at 0.
    let sphere = glb.meshes().next().unwrap().primitives().next().unwrap().bounding_box();
    assert!((sphere.max[1] - 0.02).abs() < 1e-8 && (sphere.min[1] + 0.02).abs() < 1e-8);
    let ground = glb.meshes().nth(1).unwrap().primitives().next().unwrap().bounding_box();
    assert_eq!((ground.min[1], ground.max[1], ground.min[0], ground.max[0]), (0.0, 0.0, -0.5, 1.5));
}

/// A cubic Bézier ease, as CSS and Lottie define it.
fn eased([x1, y1, x2, y2]: [f64; 4], x: f64) -> f64 {
    let bezier = |a: f64, b: f64, u: f64| 3.0 * a * u * (1.0 - u).powi(2) + 3.0 * b * u * u * (1.0 - u) + u.powi(3);
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if bezier(x1, x2, middle) < x { low = middle } else { high = middle }
    }
    bezier(y1, y2, low)
}

#[test]
fn lottie_gives_the_closed_form() {
    let (motion, starts) = drop(3, SIDEWAYS);
    let document: Value = serde_json::from_slice(&file(&motion, Format::Lottie).bytes).unwrap();
    let ball = &document["layers"][1];
    assert_eq!((ball["ty"].as_u64(), ball["parent"].as_u64()), (Some(4), Some(1)));
    let keys = ball["ks"]["p"]["k"].as_array().unwrap();
    let size = ball["shapes"][0]["it"][0]["s"]["k"][0].as_f64().unwrap();
    let scale = size / 0.04;
    let ground = &document["layers"][2]["shapes"][0]["it"][0]["ks"]["k"]["v"][0];
    let floor = ground[1].as_f64().unwrap() - 0.5 * size;
    let number = |value: &Value| value.as_f64().unwrap();
    let read = |t: f64| {
        let frame = t * 24.0;
        let n = keys.iter().position(|key| number(&key["t"]) > frame).unwrap_or(keys.len() - 1);
        let (a, b) = (&keys[n - 1], &keys[n]);
        let u = (frame - number(&a["t"])) / (number(&b["t"]) - number(&a["t"]));
        let handles = |key: &str, axis: &str| number(&a[key][axis][0]);
        let progress = if a["h"] == 1 {
            0.0
        } else {
            eased([handles("o", "x"), handles("o", "y"), handles("i", "x"), handles("i", "y")], u)
        };
        let (p, q) = (number(&a["s"][1]), number(&b["s"][1]));
        (floor - (p + (q - p) * progress)) / scale
    };
    let missed = worst(&starts, motion.end(), read);
    assert!(missed < 1e-6, "{missed}");
    assert_eq!(document["fr"], 24.0);
}

#[test]
fn svg_gives_the_closed_form_and_respects_less_motion() {
    let (motion, starts) = drop(3, SIDEWAYS);
    let file = file(&motion, Format::Svg);
    let document = roxmltree::Document::parse(text(&file)).unwrap();
    let find = |name: &str| document.descendants().find(|node| node.has_tag_name(name)).unwrap();
    let style = find("style").text().unwrap();
    assert!(style.contains("prefers-reduced-motion"));
    let radius: f64 = find("circle").attribute("r").unwrap().parse().unwrap();
    let scale = radius / 0.02;
    let after = |text: &str, start: &str, end: char| -> Option<f64> {
        text.split_once(start)?.1.split(end).next()?.parse().ok()
    };
    let duration = after(style, "animation-duration:", 's').unwrap();
    let rules = style.split_once("b0y{").unwrap().1.split("}\n}").next().unwrap();
    let keys: Vec<(f64, f64, Option<[f64; 4]>)> = rules
        .trim()
        .lines()
        .map(|line| {
            let t = duration * line.split('%').next().unwrap().parse::<f64>().unwrap() / 100.0;
            let handles = line.split_once("cubic-bezier(").map(|(_, rest)| {
                let numbers: Vec<f64> =
                    rest.split(')').next().unwrap().split(',').map(|n| n.parse().unwrap()).collect();
                numbers.try_into().unwrap()
            });
            (t, after(line, "translateY(", 'p').unwrap(), handles)
        })
        .collect();
    let read = |t: f64| {
        let n = keys.iter().position(|key| key.0 > t).unwrap();
        let (a, b) = (keys[n - 1], keys[n]);
        let progress = a.2.map_or(0.0, |handles| eased(handles, (t - a.0) / (b.0 - a.0)));
        1.0 - (a.1 + (b.1 - a.1) * progress) / scale
    };
    let missed = worst(&starts, motion.end() * 0.999, read);
    assert!(missed < 1e-6, "{missed}");
}

#[test]
fn json_and_csv_say_the_same_and_are_exact() {
    let (motion, starts) = drop(3, 0.0);
    let csv = file(&motion, Format::Csv);
    assert_eq!(csv.keys, 6);
    assert!(csv.miss.height < 1e-14, "{:?}", csv.miss);
    let document: Value = serde_json::from_slice(&file(&motion, Format::Json).bytes).unwrap();
    let keys = document["balls"][0]["keys"].as_array().unwrap();
    // The name has quotes, doubled in the table.
    let rows = text(&csv).lines().skip(1).map(|line| line.strip_prefix("squash & ").unwrap_or(line));
    for ((row, key), start) in rows.zip(keys).zip(&starts) {
        let cells: Vec<&str> = row.rsplit(',').collect();
        assert_eq!(cells[7].parse::<f64>().unwrap(), key["place"][2].as_f64().unwrap());
        assert!((key["t"].as_f64().unwrap() - start).abs() < 1e-12);
        assert_eq!(cells[0] == "1", key["contact"] == true);
    }
    for sample in document["balls"][0]["frames"].as_array().unwrap() {
        let (frame, up) = (sample[0].as_f64().unwrap(), sample[3].as_f64().unwrap());
        assert!((up - height(&starts, (frame / 24.0).min(motion.end()))).abs() < 1e-12 && up >= 0.0);
    }
}

#[test]
fn usd_samples_have_the_chord_error_and_splines_none() {
    let (motion, starts) = drop(3, SIDEWAYS);
    let samples = file(&motion, Format::Usd);
    let rows: Vec<(f64, f64)> = text(&samples)
        .lines()
        .filter_map(|line| {
            let (frame, place) = line.trim().strip_suffix("),")?.split_once(": (")?;
            Some((frame.parse().ok()?, place.split(", ").nth(1)?.parse().ok()?))
        })
        .collect();
    let read = |t: f64| {
        let n = rows.iter().position(|row| row.0 > 24.0 * t).unwrap();
        let (a, b) = (rows[n - 1], rows[n]);
        a.1 + (b.1 - a.1) * (24.0 * t - a.0) / (b.0 - a.0)
    };
    let missed = worst(&starts, motion.end(), read);
    assert!(missed < 1.001 * CHORD && missed > 0.9 * CHORD, "{missed}");
    assert!(rows.iter().all(|row| row.1 >= 0.0));

    // A spline: knots with tangents that reach a third of the way, slopes per frame.
    let splines = file(&motion, Format::UsdSplines);
    let rules = text(&splines).split_once("translateY.spline = {").unwrap().1.split('}').next().unwrap();
    let pair = |line: &str, start: &str| -> Option<[f64; 2]> {
        let (w, s) = line.split_once(start)?.1.split(')').next()?.split_once(", ")?;
        Some([w.parse().ok()?, s.parse().ok()?])
    };
    let knots: Vec<_> = rules
        .lines()
        .filter(|line| line.contains(": "))
        .map(|line| {
            let (frame, rest) = line.trim().trim_end_matches(',').split_once(": ").unwrap();
            let value: f64 = rest.split(';').next().unwrap().parse().unwrap();
            (frame.parse::<f64>().unwrap(), value, pair(line, "pre ("), pair(line, "post curve ("))
        })
        .collect();
    assert_eq!(knots.len(), 6);
    let read = |t: f64| {
        let n = knots.iter().position(|knot| knot.0 > 24.0 * t).unwrap();
        let (a, b) = (knots[n - 1], knots[n]);
        let u = (24.0 * t - a.0) / (b.0 - a.0);
        let ([v, s], [w, z]) = (a.3.unwrap(), b.2.unwrap());
        assert!((3.0 * v - (b.0 - a.0)).abs() < 1e-9 && v == w);
        let (p, q) = (a.1 + v * s, b.1 - w * z);
        a.1 * (1.0 - u).powi(3) + 3.0 * p * u * (1.0 - u).powi(2) + 3.0 * q * u * u * (1.0 - u) + b.1 * u.powi(3)
    };
    let missed = worst(&starts, motion.end(), read);
    assert!(missed < 1e-12, "{missed}");
}

/// The data of a script, between its raw quotes.
fn data(script: &str) -> Value {
    serde_json::from_str(script.split_once("r'''").unwrap().1.split("'''").next().unwrap()).unwrap()
}

#[test]
fn blender_handles_are_at_a_third_and_touch_at_zero() {
    let (motion, starts) = drop(3, SIDEWAYS);
    let rate = "23.976".parse().unwrap();
    let frames = Frames { rate, first: 1, on_twos: false };
    let file = Export::new(&motion, frames).file(Format::Blender).unwrap();
    let data = data(text(&file));
    assert_eq!(data["fps"], 24);
    assert!((data["fps_base"].as_f64().unwrap() - 1.001).abs() < 1e-12);
    let keys = data["balls"][0]["nodes"][0]["place"]["keys"][2].as_array().unwrap();
    let number = |value: &Value| value.as_f64().unwrap();
    for (key, start) in keys.iter().zip(&starts) {
        assert!((number(&key[0]) - 1.0 - start * 24.0 / 1.001).abs() < 1e-9);
    }
    for pair in keys.windows(2).take(4) {
        // The middle of a Bézier curve is the mean of its ends and its handles, once and three
        // times.
        let [a, b] = [&pair[0], &pair[1]];
        let middle = (number(&a[1]) + 3.0 * number(&a[3][1]) + 3.0 * number(&b[2][1]) + number(&b[1])) / 8.0;
        let t = (0.5 * (number(&a[0]) + number(&b[0])) - 1.0) * 1.001 / 24.0;
        assert!((middle - height(&starts, t)).abs() < 1e-12);
    }
    assert!(keys[1..].iter().all(|key| number(&key[1]) == 0.0));
}

#[test]
fn maya_knows_its_rates_and_refuses_others() {
    let (motion, _) = drop(3, SIDEWAYS);
    let with = |rate: &str| Export::new(&motion, frames(rate)).file(Format::Maya);
    let data = data(text(&with("29.97").unwrap()));
    assert_eq!(
        (data["time"].as_str(), data["balls"][0]["nodes"][0]["place"]["keys"].as_array().unwrap().len()),
        (Some("29.97fps"), 6)
    );
    assert!(with("13").unwrap_err().to_string().contains("Maya has no rate of 13"));
}

#[test]
fn snapping_by_gravity_gives_the_table_of_hops() {
    let (motion, _) = drop(3, SIDEWAYS);
    let snapped = motion.snapped(Snap::Gravity, frames("24")).unwrap();
    assert_eq!(snapped.off_frame(frames("24")), 0.0);
    let track = &snapped.tracks[0];
    let contacts: Vec<f64> = track.contacts().map(|t| (t * 24.0).round()).collect();
    assert_eq!(contacts, [11.0, 23.0, 30.0, 34.0]);
    let tops: Vec<f64> = track.stretches[..4].iter().map(|stretch| stretch.top().0).collect();
    for (top, n) in tops.iter().zip([22.0, 12.0, 7.0, 4.0]) {
        assert!((top - G * n * n / (8.0 * 576.0)).abs() < 1e-12, "{tops:?}");
    }
    assert!(track.contacts().all(|t| track.at(t)[2] == 0.0));
    assert!(file(&snapped, Format::Usd).miss.height < 1.001 * CHORD);
}

#[test]
fn snapping_by_heights_keeps_every_place() {
    let (motion, _) = drop(3, SIDEWAYS);
    for rate in ["24", "25", "30000/1001"] {
        let snapped = motion.snapped(Snap::Heights, frames(rate)).unwrap();
        assert_eq!(snapped.off_frame(frames(rate)), 0.0);
        assert!(snapped.tops_differ(&motion) < 1e-12);
        assert_eq!(snapped.tracks[0].contacts().count(), 4);
    }
}

#[test]
fn hops_below_a_frame_end_in_rest() {
    let (motion, _) = drop(60, 0.0);
    let cut = motion.cut(1.0 / 24.0);
    assert!(cut.tracks[0].stretches.len() < 10);
    assert!(
        cut.tracks[0].stretches.iter().filter(|stretch| stretch.flight).all(|stretch| stretch.span() >= 1.0 / 24.0)
    );
    assert!((cut.end() - motion.end()).abs() < 1e-12);
    assert!(!cut.tracks[0].stretches.last().unwrap().flight);
}

#[test]
fn on_twos_every_drawing_stands_for_two_frames() {
    let (motion, starts) = drop(3, 0.0);
    let frames = Frames { on_twos: true, ..frames("24") };
    for format in
        [Format::Csv, Format::Glb, Format::Svg, Format::Lottie, Format::Blender, Format::Maya, Format::UsdSplines]
    {
        Export::new(&motion, frames).file(format).unwrap();
    }
    let file = Export::new(&motion, frames).file(Format::Json).unwrap();
    let document: Value = serde_json::from_slice(&file.bytes).unwrap();
    assert_eq!(document["balls"][0]["between"], "hold");
    for (k, key) in document["balls"][0]["keys"].as_array().unwrap().iter().enumerate() {
        let frame = 2.0 * k as f64;
        assert_eq!(key["frame"].as_f64(), Some(frame));
        assert!((key["place"][2].as_f64().unwrap() - height(&starts, (frame / 24.0).min(motion.end()))).abs() < 1e-12);
    }
    // Each is exact when it is drawn, which is what the file promises.
    assert!(file.miss.height < 1e-12);
}

#[test]
fn a_motion_that_is_no_parabola_takes_few_keys_within_the_tolerance() {
    // Degree 9: 1 - s² + s⁵ - s⁹/2.
    let mut coefficients = vec![[0.0; 3]; 10];
    for (k, c) in [(0, 1.0), (2, -1.0), (5, 1.0), (9, -0.5)] {
        coefficients[k][2] = c;
    }
    let stretch = Stretch {
        contact: None,
        flight: true,
        pieces: vec![Piece { start: 0.0, span: 1.0, coefficients, spin: Vec::new() }],
    };
    let track = Track { name: "ball".into(), radius: 0.1, stretches: vec![stretch] };
    let motion = Motion::new("curve", vec![track], Vec::new()).unwrap();
    for (tolerance, most) in [(1e-2, 4), (1e-4, 9), (1e-6, 25)] {
        let file = Export { tolerance, ..Export::new(&motion, frames("24")) }.file(Format::Csv).unwrap();
        assert!(file.miss.height <= tolerance && file.keys <= most, "{tolerance}: {} {:?}", file.keys, file.miss);
    }
    let refused = motion.snapped(Snap::Gravity, frames("24")).unwrap_err().to_string();
    assert!(refused.ends_with("more than gravity acts: snap by heights"), "{refused}");
}
