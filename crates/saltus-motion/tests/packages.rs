//! What is in an archive is the plain export, bit for bit, and lies where it should.

use std::io::{Cursor, Read};

use crate::drop::drop;
use saltus_motion::{Export, Format, Frames, Motion};
use serde_json::Value;
use zip::{CompressionMethod, ZipArchive};

fn written(motion: &Motion, format: Format) -> Vec<u8> {
    let frames = Frames::new("24".parse().unwrap());
    Export::new(motion, frames).file(format).unwrap().bytes
}

struct Entry {
    name: String,
    method: CompressionMethod,
    start: usize,
    content: Vec<u8>,
}

fn entries(bytes: &[u8]) -> Vec<Entry> {
    let mut archive = ZipArchive::new(Cursor::new(bytes)).unwrap();
    (0..archive.len())
        .map(|index| {
            let mut file = archive.by_index(index).unwrap();
            let start = usize::try_from(file.data_start().unwrap()).unwrap();
            let (name, method, mut content) = (file.name().unwrap().to_string(), file.compression(), Vec::new());
            file.read_to_end(&mut content).unwrap();
            Entry { name, method, start, content }
        })
        .collect()
}

#[test]
fn a_usdz_is_the_layer_in_its_place() {
    // Titles of many lengths: the place does not depend on what stands before.
    for length in [0, 1, 7, 63, 64, 300] {
        let mut motion = drop(1.0, 0.7, 3, 0.8, [0.0; 3], 0.05);
        motion.title = "t".repeat(length);
        let (package, plain) = (written(&motion, Format::Usdz), written(&motion, Format::Usd));
        let files = entries(&package);
        let [layer] = files.as_slice() else { panic!("{} files", files.len()) };
        assert!(layer.name.ends_with(".usda"));
        assert_eq!(layer.method, CompressionMethod::Stored);
        assert_eq!((layer.start % 64, &layer.content), (0, &plain));
        // Not compressed: it stands there as it is.
        assert_eq!(package[layer.start..layer.start + plain.len()], plain);
        assert_eq!(package, written(&motion, Format::Usdz), "no clock goes in");
    }
}

#[test]
fn a_dotlottie_is_the_lottie_with_its_manifest() {
    let motion = drop(1.0, 0.7, 3, 0.8, [0.0; 3], 0.05);
    let (package, plain) = (written(&motion, Format::DotLottie), written(&motion, Format::Lottie));
    let files = entries(&package);
    assert_eq!(files.iter().map(|file| file.name.as_str()).collect::<Vec<_>>(), ["manifest.json", "a/motion.json"]);
    assert!(files.iter().all(|file| file.method == CompressionMethod::Deflated));
    let manifest: Value = serde_json::from_slice(&files[0].content).unwrap();
    assert_eq!((&manifest["version"], &manifest["animations"][0]["id"]), (&Value::from("2"), &Value::from("motion")));
    assert_eq!(manifest["initial"]["animation"], "motion");
    assert_eq!(files[1].content, plain);
    assert!(package.len() < plain.len() / 2, "{} of {}", package.len(), plain.len());
}

/// A package says of itself what the plain file says.
#[test]
fn a_package_is_as_exact_as_what_is_in_it() {
    let motion = drop(1.0, 0.7, 3, 0.8, [0.0; 3], 0.05);
    let frames = Frames::new("24".parse().unwrap());
    let file = |format| Export::new(&motion, frames).file(format).unwrap();
    for (package, plain) in [(Format::Usdz, Format::Usd), (Format::DotLottie, Format::Lottie)] {
        let (package, plain) = (file(package), file(plain));
        assert_eq!((package.keys, package.miss, package.shown), (plain.keys, plain.miss, plain.shown));
    }
}
