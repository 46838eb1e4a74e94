//! The numbers of every example scene, to the last digit: when it jumps, and how it ends.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use saltus_scene::Scene;

/// How far numbers may be apart, as a part of themselves, where the sines of another system round
/// in another way.
const ELSEWHERE: f64 = 1e-9;

/// Every jump's time, and the balls' places, velocities and spins at the end.
fn numbers() -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../examples/scenes");
    let mut paths: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    paths.sort();
    let mut text = String::new();
    for path in paths {
        let record = Scene::read(&path).unwrap().plan().unwrap().run().unwrap();
        // What these scenes show is decided.
        assert!(record.doubts().is_empty(), "{}: {:?}", path.display(), record.doubts());
        let row = |numbers: Vec<f64>| numbers.iter().map(|x| format!(" {x:.16e}")).collect::<String>();
        let times: Vec<f64> = record.events().iter().map(|event| event.t).collect();
        let _ = writeln!(
            text,
            "{}: {} jumps, {:.16e} s",
            path.file_stem().unwrap().to_str().unwrap(),
            times.len(),
            record.until()
        );
        for times in times.chunks(4) {
            let _ = writeln!(text, "  t{}", row(times.to_vec()));
        }
        for ball in 0..record.balls() {
            let end = record.at(ball, record.until()).unwrap();
            for (what, vector) in [("place", end.position), ("velocity", end.velocity), ("spin", end.spin)] {
                let _ = writeln!(text, "  {what}{}", row(vec![vector.x, vector.y, vector.z]));
            }
        }
    }
    text
}

/// `SALTUS_BLESS=1` writes them anew: who does so says in the commit which differ, how far, and why.
#[test]
fn every_scene_has_the_numbers_that_it_had() {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/numbers.txt");
    let now = numbers();
    if std::env::var_os("SALTUS_BLESS").is_some() {
        return fs::write(path, now).unwrap();
    }
    let before = fs::read_to_string(path).unwrap().replace("\r\n", "\n");
    let exact = cfg!(all(target_os = "linux", target_arch = "x86_64"));
    let alike = |a: &str, b: &str| match (a.parse::<f64>(), b.parse::<f64>()) {
        (Ok(a), Ok(b)) if !exact => (a - b).abs() <= ELSEWHERE * (1.0 + b.abs()),
        _ => a == b,
    };
    let mut scene = "";
    for (n, (now, before)) in now.lines().zip(before.lines()).enumerate() {
        scene = if before.starts_with(' ') { scene } else { before };
        let same = now.split(' ').count() == before.split(' ').count();
        let same = same && now.split(' ').zip(before.split(' ')).all(|(a, b)| alike(a, b));
        assert!(same, "line {} of tests/numbers.txt, of {scene}\nnow    {now}\nbefore {before}", n + 1);
    }
    assert_eq!(now.lines().count(), before.lines().count());
}
