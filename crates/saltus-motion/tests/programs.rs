//! What programs that load the files have stumbled over, each on the content of the file; and the
//! formats for the browser, for text and for sound.

use crate::drop::{G, drop};
use saltus_motion::{Contact, Export, File, Format, Frames, Motion, Piece, Shape, Stretch, Track};
use serde_json::Value;

const SQUASHED: Shape = Shape { squash: 0.3, stretch: 0.2, hold: 2.0 / 24.0 };

fn frames() -> Frames {
    Frames::new("24".parse().unwrap())
}

fn written(motion: &Motion, format: Format, shape: Shape) -> File {
    Export { shape, ..Export::new(motion, frames()) }.file(format).unwrap()
}

fn text(file: File) -> String {
    String::from_utf8(file.bytes).unwrap()
}

/// A drop that travels, with contacts held for two frames.
fn travels() -> Motion {
    drop(1.0, 0.7, 3, 0.8, [0.0; 3], 0.05).held(SQUASHED.hold).unwrap()
}

/// What a script reads as data.
fn data(script: &str) -> Value {
    let (_, rest) = script.split_once("json.loads(r'''").unwrap();
    serde_json::from_str(rest.split_once("'''").unwrap().0).unwrap()
}

/// Blender merges keys that are a hundredth of a frame apart: then an axis that leaps turns through
/// the leap for a whole frame, the ball leans and sinks.
#[test]
fn a_leap_of_the_axis_has_keys_that_blender_keeps_apart() {
    let data = data(&text(written(&travels(), Format::Blender, SQUASHED)));
    let mut close = 0;
    for node in data["balls"][0]["nodes"].as_array().unwrap() {
        let Some(times) = node["turns"]["frames"].as_array() else { continue };
        for pair in times.windows(2) {
            let apart = pair[1].as_f64().unwrap() - pair[0].as_f64().unwrap();
            assert!(apart > 0.0199, "{pair:?}");
            close += usize::from(apart < 0.03);
        }
    }
    assert!(close > 2, "the axis leaps at contacts");
}

/// Names of styles hold for a whole page: those of two pictures in one page have nothing in common.
#[test]
fn two_moving_pictures_share_no_names() {
    let names = |motion: &Motion| -> Vec<String> {
        let svg = text(written(motion, Format::Svg, Shape::default()));
        let class = svg.split_once("class=\"").unwrap().1.split_once('"').unwrap().0.to_owned();
        let style = svg.split_once("<style>").unwrap().1.split_once("</style>").unwrap().0;
        for rule in style.lines().filter(|line| line.starts_with('.')) {
            assert!(rule.starts_with(&format!(".{class} .")), "{rule}");
        }
        let names: Vec<String> =
            style.split("@keyframes ").skip(1).map(|rest| rest.split_once('{').unwrap().0.to_owned()).collect();
        assert!(!names.is_empty() && names.iter().all(|name| name.starts_with(&class)), "{names:?}");
        names
    };
    let (one, other) = (names(&travels()), names(&drop(1.0, 0.5, 3, 0.8, [0.0; 3], 0.05)));
    assert!(one.iter().all(|name| !other.contains(name)));
    assert_eq!(one, names(&travels()));
}

/// rlottie takes whole sides only, and reads the type of a shape before what it has.
#[test]
fn lottie_has_whole_sides_and_types_first() {
    let json = text(written(&drop(1.0, 0.7, 3, 0.8, [0.0, 9.0, 0.0], 0.05), Format::Lottie, Shape::default()));
    let read: Value = serde_json::from_str(&json).unwrap();
    assert!(read["w"].is_u64() && read["h"].is_u64());
    let types = json.matches("\"ty\":").count();
    assert!(types > 8);
    assert_eq!(json.matches("{\"ty\":").count(), types);
}

/// A ball in space whose axis leaves the plane of the picture, in contact with a wall across y: the
/// plane sees a spheroid end on.
#[test]
fn a_squash_out_of_the_plane_is_seen_from_the_side() {
    let wall = Contact { normal: [0.0, 1.0, 0.0], speed: 2.0, pressed: false };
    let piece = |start: f64, speed: f64, y: f64| Piece {
        start,
        span: 0.5,
        coefficients: vec![[0.0, y, 1.0], [0.0, speed, 0.0], [0.0; 3]],
        spin: Vec::new(),
    };
    let stretches = vec![
        Stretch { contact: None, flight: true, pieces: vec![piece(0.0, -2.0, 1.0)] },
        Stretch { contact: Some(wall), flight: true, pieces: vec![piece(0.5, 2.0, 0.0)] },
    ];
    let ball = Track { name: "ball".into(), radius: 0.1, stretches };
    let motion = Motion::new("wall", vec![ball], Vec::new()).unwrap().held(SQUASHED.hold).unwrap();
    let page = text(written(&motion, Format::Html, SQUASHED));
    let json = page.split_once("type=\"application/json\" id=\"data\">").unwrap().1.split_once("</script>").unwrap().0;
    let data: Value = serde_json::from_str(json).unwrap();
    let moves = data["balls"][0]["moves"].as_array().unwrap();
    let values = |how: &str| -> Vec<f64> {
        let of = moves
            .iter()
            .filter(|channel| channel["how"] == how)
            .flat_map(|channel| channel["eases"].as_array().unwrap());
        of.flat_map(|ease| [ease[2].as_f64().unwrap(), ease[3].as_f64().unwrap()]).collect()
    };
    // Shorter along y by 0.7 it is wider by √(1/0.7) both ways in the picture, and leans no way.
    let wide = (1.0_f64 / 0.7).sqrt();
    let (x, y) = (values("scaleX"), values("scaleY"));
    let most = |values: &[f64]| values.iter().copied().fold(0.0, f64::max);
    assert!((most(&x) - wide).abs() < 0.01 && (most(&y) - wide).abs() < 0.01, "{} {}", most(&x), most(&y));
    assert!(x.iter().zip(&y).all(|(x, y)| (x - y).abs() < 1e-9));
    assert!(values("rotate").iter().all(|angle| angle.abs() < 1e-9));
}

/// A contact is one row, and two that rounding alone tells apart are one sample.
#[test]
fn each_contact_is_written_once() {
    let mut motion = drop(1.0, 0.7, 2, 0.8, [0.0; 3], 0.05);
    let again = motion.tracks[0].stretches[1].clone();
    // A stretch of one spacing of time, as a run may leave it.
    let next = again.start().next_up();
    let mut first = again.clone();
    first.pieces[0].span = next - again.start();
    motion.tracks[0].stretches[1].pieces[0].start = next;
    motion.tracks[0].stretches.insert(1, first);
    for format in [Format::Csv, Format::CsvFrames] {
        let csv = text(written(&motion, format, Shape::default()));
        let mut rows: Vec<f64> = Vec::new();
        for line in csv.lines().skip(1) {
            let cells: Vec<&str> = line.split(',').collect();
            if cells[12] == "1" {
                rows.push(cells[2].parse().unwrap());
            }
        }
        assert_eq!(rows.len(), 3, "{format:?}: {rows:?}");
    }
    // Where form and orientation have keys too, times rise all the same.
    let csv = text(written(&travels(), Format::Csv, SQUASHED));
    let times: Vec<f64> = csv.lines().skip(1).map(|line| line.split(',').nth(2).unwrap().parse().unwrap()).collect();
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
}

/// Maya's fallback bakes a key at every contact too, and sets corners in the units of the scene.
#[test]
fn maya_bakes_contacts_and_sets_corners() {
    let motion = drop(1.0, 0.7, 2, 0.8, [0.0; 3], 0.05);
    let script = text(written(&motion, Format::Maya, Shape::default()));
    let data = data(&script);
    let baked = data["balls"][0]["nodes"][0]["place"]["frames"].as_array().unwrap();
    for contact in motion.tracks[0].contacts() {
        let near = |key: &&Value| (key["t"].as_f64().unwrap() - contact).abs() < 0.01 / 24.0;
        let key = baked.iter().find(near).unwrap_or_else(|| panic!("no key at {contact}"));
        assert!(key["value"][1].as_f64().unwrap().abs() < 1e-12, "{key}");
    }
    assert!(script.contains("cmds.xform(\"%s.vtx[%d]\" % (item, number), worldSpace=True, translation=corner)"));
}

/// Materials have a colour in what is rendered; all objects are in one collection that is replaced;
/// there are a camera and a light.
#[test]
fn a_blender_script_keeps_house() {
    let script = text(written(&travels(), Format::Blender, SQUASHED));
    assert!(script.contains("node.inputs[\"Base Color\"].default_value = colour"));
    assert!(
        !script.contains("bpy.context.scene.collection.objects.link"),
        "nothing goes into the scene's own collection"
    );
    assert!(script.contains("bpy.data.collections.get(DATA[\"collection\"])") && script.contains("camera_and_light()"));
    assert_eq!(data(&script)["collection"], "saltus: drop");
}

/// A motion shorter than any frame is refused in every format, and no file is made that readers
/// refuse.
#[test]
fn a_motion_without_a_frame_is_refused() {
    let piece = Piece { start: 0.0, span: 1e-9, coefficients: vec![[0.0, 0.0, 1.0]], spin: Vec::new() };
    let stretch = Stretch { contact: None, flight: true, pieces: vec![piece] };
    let ball = Track { name: "ball".into(), radius: 0.05, stretches: vec![stretch] };
    let motion = Motion::new("short", vec![ball], Vec::new()).unwrap();
    for format in Format::ALL {
        let export = Export::new(&motion, frames());
        let error = export.file(format).unwrap_err().to_string();
        assert!(error.contains("less than a hundredth of a frame"), "{format:?}: {error}");
    }
}

/// A ball smaller than a dot of the picture is drawn as a dot.
#[test]
fn a_small_ball_is_seen() {
    let svg = text(written(&drop(30.0, 0.7, 3, 10.0, [0.0; 3], 0.001), Format::Svg, Shape::default()));
    let radius: f64 = svg.split_once("class=\"ball\" r=\"").unwrap().1.split_once('"').unwrap().0.parse().unwrap();
    assert_eq!(radius, 3.0);
}

/// Keys at the tops of flights change nothing but that they are there.
#[test]
fn keys_at_apexes_leave_the_motion() {
    let motion = drop(1.0, 0.7, 3, 0.8, [0.0; 3], 0.05);
    let export = |apexes| Export { apexes, ..Export::new(&motion, frames()) };
    let (plain, with) = (export(false).file(Format::Csv).unwrap(), export(true).file(Format::Csv).unwrap());
    assert_eq!(with.keys, plain.keys + 3, "the drop starts at its top");
    assert!(with.miss.place < 1e-12, "{:?}", with.miss);
    let csv = text(with);
    let level =
        |line: &&str| line.split(',').nth(8).is_some_and(|up| up.parse::<f64>().is_ok_and(|up| up.abs() < 1e-9));
    assert!(csv.lines().skip(2).filter(level).count() >= 3, "{csv}");
}

/// Tops that are keys are in every file, exact in height: also frame by frame, and in drawings that
/// stand for two frames.
#[test]
fn keys_at_apexes_are_in_frames_and_drawings_too() {
    for height in [0.31, 1.0, 1.7] {
        let motion = drop(height, 0.7, 3, 0.8, [0.0; 3], 0.05);
        for frames in [frames(), Frames { on_twos: true, ..frames() }] {
            let export = Export { apexes: true, ..Export::new(&motion, frames) };
            let csv = text(export.file(Format::CsvFrames).unwrap());
            let row =
                |line: &str| -> Vec<f64> { line.split(',').map(|cell| cell.parse().unwrap_or(f64::NAN)).collect() };
            let rows: Vec<Vec<f64>> = csv.lines().skip(1).map(row).collect();
            for stretch in motion.tracks[0].stretches.iter().filter(|stretch| stretch.flight) {
                let (top, t) = stretch.top();
                let shown = rows.iter().find(|row| (row[5] - top).abs() < 1e-9);
                let shown = shown.unwrap_or_else(|| panic!("no {top} at {t} in {csv}"));
                assert!((shown[2] - t).abs() <= 0.5 / 24.0 + 1e-9, "{top} at {} instead of {t}", shown[2]);
            }
        }
    }
}

/// A ball that turns about one axis has keys as few as its spin asks for where angles are counted,
/// however many turns it makes.
#[test]
fn an_angle_has_as_few_keys_as_its_spin() {
    let rolling = |spin: Vec<[f64; 3]>| {
        let coefficients = vec![[0.0; 3], [0.1, 0.0, 0.0]];
        let pieces = vec![Piece { start: 0.0, span: 8.0, coefficients, spin }];
        let stretches = vec![Stretch { contact: None, flight: false, pieces }];
        Motion::new("rolls", vec![Track { name: "ball".into(), radius: 0.05, stretches }], Vec::new()).unwrap()
    };
    for spin in [
        vec![[0.0, 50.0, 0.0]],
        vec![[0.0, 1.0, 0.0], [0.0, 20.0, 0.0]],
        vec![[0.0, 40.0, 0.0], [0.0, -8.0, 0.0], [0.0, 0.3, 0.0]],
    ] {
        let motion = rolling(spin.clone());
        let script = text(written(&motion, Format::Blender, Shape::default()));
        let data = script.split("json.loads(r'''").nth(1).unwrap().split("''')").next().unwrap();
        let read: Value = serde_json::from_str(data).unwrap();
        let about = &read["balls"][0]["nodes"][1]["about"];
        let keys = about["keys"][0].as_array().unwrap();
        assert_eq!((about["axes"][0].as_u64(), keys.len()), (Some(1), 2), "{spin:?}");
        let turned: f64 = spin.iter().zip(1..).map(|(c, k)| c[1] * 8.0_f64.powi(k) / f64::from(k)).sum();
        assert!((keys[1][1].as_f64().unwrap() - turned).abs() < 1e-9 * turned.abs());
        // glTF has orientations, of which the shortest way is gone.
        let file = written(&motion, Format::Glb, Shape::default());
        assert!(file.shown.unwrap().added > 30);
        let svg = text(written(&motion, Format::Svg, Shape::default()));
        assert!(svg.matches("deg").count() < 12, "{svg}");
    }
}

/// The same glTF as text: its buffer in base64 is the binary one.
#[test]
fn gltf_as_text_has_the_same_numbers() {
    let motion = travels();
    let glb = gltf::Gltf::from_slice(&written(&motion, Format::Glb, SQUASHED).bytes).unwrap();
    let json = text(written(&motion, Format::Gltf, SQUASHED));
    let read: Value = serde_json::from_str(&json).unwrap();
    let document = gltf::Gltf::from_slice(json.as_bytes()).unwrap();
    assert_eq!(document.animations().count(), 2);
    let uri = read["buffers"][0]["uri"].as_str().unwrap();
    let digits = uri.strip_prefix("data:application/octet-stream;base64,").unwrap();
    assert_eq!(digits.len() % 4, 0);
    let value = |digit: u8| match digit {
        b'A'..=b'Z' => digit - b'A',
        b'a'..=b'z' => digit - b'a' + 26,
        b'0'..=b'9' => digit - b'0' + 52,
        b'+' => 62,
        _ => 63,
    };
    let bits: Vec<u8> = digits
        .trim_end_matches('=')
        .bytes()
        .flat_map(|digit| (0..6).rev().map(move |bit| value(digit) >> bit & 1))
        .collect();
    let bytes: Vec<u8> = bits.chunks_exact(8).map(|bits| bits.iter().fold(0, |byte, bit| byte << 1 | bit)).collect();
    assert_eq!(&bytes, glb.blob.as_ref().unwrap());
}

/// Every tick starts at the first sample not before its contact, and is as loud as the contact is
/// fast.
#[test]
fn a_tick_at_every_contact() {
    let motion = drop(1.0, 0.7, 4, 0.0, [0.0; 3], 0.05);
    let wav = written(&motion, Format::Wav, Shape::default()).bytes;
    assert_eq!((&wav[..4], &wav[8..16], &wav[36..40]), (&b"RIFF"[..], &b"WAVEfmt "[..], &b"data"[..]));
    let number = |at: usize| u32::from_le_bytes(wav[at..at + 4].try_into().unwrap()) as usize;
    assert_eq!((number(4), number(40), number(24)), (wav.len() - 8, wav.len() - 44, 48_000));
    let samples: Vec<f64> =
        wav[44..].chunks(2).map(|two| f64::from(i16::from_le_bytes([two[0], two[1]])) / 32767.0).collect();
    let mut speed = (2.0 * G).sqrt();
    let fastest = speed;
    let mut silent = 0;
    // The last contact is where it comes to rest, without a sound.
    for t in motion.tracks[0].contacts().take(4) {
        let first = (t * 48_000.0 - 1e-6).ceil() as usize;
        assert!(samples[silent..first].iter().rev().take(40).all(|sample| *sample == 0.0), "silence before {t}");
        assert!((samples[first] - 0.8 * speed / fastest).abs() < 1e-4, "{t}: {}", samples[first]);
        (speed, silent) = (speed * 0.7, first + 1920);
    }
}

/// A file without the form of the ball has neither keys of its turning nor a squash.
#[test]
fn ticks_do_not_turn() {
    let motion = drop(1.0, 0.7, 3, 0.8, [0.0, 40.0, 0.0], 0.05).held(SQUASHED.hold).unwrap();
    for format in Format::ALL {
        let formless = matches!(format, Format::Chart | Format::Contacts | Format::Wav);
        assert_eq!(written(&motion, format, SQUASHED).shown.is_none(), formless, "{format:?}");
    }
}

/// A spreadsheet takes a cell that begins so for a formula.
#[test]
fn names_are_no_formulas() {
    for name in ["=1+1", "@SUM(1)", "+1", "-1", "\t=1", "=a,\"b\"\n=c"] {
        let mut motion = drop(1.0, 0.7, 2, 0.0, [0.0; 3], 0.05);
        motion.tracks[0].name = name.into();
        for format in [Format::Csv, Format::CsvFrames, Format::Contacts] {
            let csv = text(written(&motion, format, Shape::default()));
            let cell = format!("'{}", name.replace('"', "\"\""));
            let cell = if name.contains(',') { format!("\"{cell}\"") } else { cell };
            assert!(csv.split_once('\n').unwrap().1.starts_with(&format!("{cell},")), "{csv}");
        }
    }
}

#[test]
fn contacts_are_a_table() {
    let motion = drop(1.0, 0.7, 2, 0.8, [0.0; 3], 0.05);
    let csv = text(written(&motion, Format::Contacts, Shape::default()));
    let rows: Vec<Vec<f64>> =
        csv.lines().skip(1).map(|line| line.split(',').skip(1).map(|cell| cell.parse().unwrap()).collect()).collect();
    let fall = (2.0 / G).sqrt();
    assert_eq!(rows.len(), 3);
    assert!((rows[0][1] - fall).abs() < 1e-12 && (rows[0][0] - 24.0 * fall).abs() < 1e-9);
    assert!((rows[0][8] - (2.0 * G).sqrt()).abs() < 1e-9 && rows[0][5..8] == [0.0, 0.0, 1.0]);
    assert!((rows[1][1] - fall * 2.4).abs() < 1e-12);
}

/// One page, whole: nothing is loaded from anywhere, names of the scene stay text, and the numbers
/// are those of the motion.
#[test]
fn a_page_that_plays() {
    let mut motion = travels();
    motion.title = "</script><script>alert(1)</script> @DATA@ @PICTURE@".into();
    motion.tracks[0].name = "</script><b>".into();
    let page = text(written(&motion, Format::Html, SQUASHED));
    assert_eq!(page.matches("<script").count(), 2, "the data and the program");
    assert_eq!(page.matches("</script>").count(), 2);
    assert!(page.contains("default-src 'none'") && !page.contains("http://") | page.contains("w3.org"));
    for outside in ["src=", "href=", "url(", "@import", "fetch(", "https:"] {
        assert!(!page.contains(outside), "{outside}");
    }
    for part in ["prefers-color-scheme:dark", "prefers-reduced-motion", "aria-valuetext", "ArrowRight", "lang=\"en\""] {
        assert!(page.contains(part), "{part}");
    }
    let json = page.split_once("type=\"application/json\" id=\"data\">").unwrap().1.split_once("</script>").unwrap().0;
    let data: Value = serde_json::from_str(json).unwrap();
    assert_eq!(data["balls"][0]["name"], "</script><b>");
    assert_eq!(data["balls"][0]["contacts"].as_array().unwrap().len(), motion.tracks[0].contacts().count());
    // Heights by the page's own rule: an ease is a cubic whose handles stand at thirds of its time.
    let moves = data["balls"][0]["moves"].as_array().unwrap();
    let eases = moves[1]["eases"].as_array().unwrap();
    let at = |t: f64| {
        let ease = eases.iter().rev().find(|ease| ease[0].as_f64().unwrap() <= t).unwrap();
        let [from, to, p, q, a, b] = std::array::from_fn(|k| ease[k].as_f64().unwrap());
        let u = ((t - from) / (to - from)).min(1.0);
        let w = 1.0 - u;
        if ease[6] == true { p } else { p + (q - p) * (3.0 * a * u * w * w + 3.0 * b * u * u * w + u * u * u) }
    };
    let scale = (at(0.0) - at(motion.end())).abs() / motion.tracks[0].at(0.0)[2];
    for k in 0..=300 {
        let t = motion.end() * f64::from(k) / 300.0;
        let height = (at(motion.end()) - at(t)) / scale;
        assert!((height - motion.tracks[0].at(t)[2]).abs() < 1e-9, "{t}: {height}");
    }
    assert_eq!(moves.len(), page.matches("<g class=\"moves\">").count());
}

/// Each ball of several has a colour of its own, in every format that has colours, and a file has
/// no material that nothing is made of.
#[test]
fn balls_differ_in_colour() {
    let mut motion = travels();
    let one = |motion: &Motion, format| text(written(motion, format, Shape::default()));
    let alone =
        [Format::Html, Format::Svg, Format::Lottie, Format::Usd, Format::Blender].map(|format| one(&motion, format));
    for n in 1..3 {
        let mut other = motion.tracks[0].clone();
        other.name = format!("ball {n}");
        motion.tracks.push(other);
    }
    let (second, third) = ("0.04", "0.49");
    assert!(
        !alone[0].contains("style=\"fill:var(--ball2)\"")
            && one(&motion, Format::Html).contains("style=\"fill:var(--ball3)\"")
    );
    assert!(!alone[1].contains("rgb(") && one(&motion, Format::Svg).contains("style=\"fill:rgb(0,125,92)\""));
    for (format, alone) in [(Format::Lottie, &alone[2]), (Format::Usd, &alone[3]), (Format::Blender, &alone[4])] {
        let several = one(&motion, format);
        assert!(several.contains(second) && several.contains(third) && !alone.contains(third), "{format:?}");
    }
    for (motion, shape, most) in [(travels(), Shape::default(), 2), (motion, SQUASHED, 4)] {
        let file: Value = serde_json::from_str(&text(written(&motion, Format::Gltf, shape))).unwrap();
        let materials = file["materials"].as_array().unwrap().len();
        let primitives =
            file["meshes"].as_array().unwrap().iter().flat_map(|mesh| mesh["primitives"].as_array().unwrap());
        let used: std::collections::BTreeSet<_> = primitives.map(|part| part["material"].as_u64().unwrap()).collect();
        assert!(used.len() == materials && materials <= most, "{used:?} of {materials}");
    }
    // Without ground there is no material for it.
    let free = Motion::new("free", travels().tracks, Vec::new()).unwrap();
    let file: Value = serde_json::from_str(&one(&free, Format::Gltf)).unwrap();
    assert_eq!(file["materials"].as_array().unwrap().len(), 1);
}
