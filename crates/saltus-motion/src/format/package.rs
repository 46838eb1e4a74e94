//! Files in one file: the zip archives that USD and Lottie define.
//!
//! The same motion gives the same bytes on every system: no clock, no name of a system goes in.

use std::io::{Cursor, Write};

use serde_json::json;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, System, ZipWriter};

use super::ExportError;

/// The data of each file in a USDZ begins at a multiple of this, in bytes: its specification wants
/// it, so that a reader can map a file where it lies.
const ALIGNED: u16 = 64;
/// The layer of a USDZ; the first file is the one that is opened.
const LAYER: &str = "scene.usda";
/// The only animation of a dotLottie.
const ANIMATION: &str = "motion";
/// The version of dotLottie in which animations are under `a/`.
const DOTLOTTIE: &str = "2";

/// A layer of USD as a package: one file, as it is, in its place.
pub(super) fn usdz(layer: &str) -> Result<Vec<u8>, ExportError> {
    let stored = options().compression_method(CompressionMethod::Stored).with_alignment(ALIGNED);
    archive(&[(LAYER, layer)], stored)
}

/// A Lottie with the manifest that names it.
pub(super) fn dotlottie(animation: &str) -> Result<Vec<u8>, ExportError> {
    let manifest = json!({
        "version": DOTLOTTIE, "generator": concat!("saltus ", env!("CARGO_PKG_VERSION")),
        "initial": { "animation": ANIMATION }, "animations": [{ "id": ANIMATION }],
    });
    let deflated = options().compression_method(CompressionMethod::Deflated);
    archive(&[("manifest.json", &manifest.to_string()), (&format!("a/{ANIMATION}.json"), animation)], deflated)
}

fn options() -> SimpleFileOptions {
    SimpleFileOptions::DEFAULT.system(System::Unix)
}

/// Files by name, in order.
fn archive(files: &[(&str, &str)], options: SimpleFileOptions) -> Result<Vec<u8>, ExportError> {
    let wrong = |why: &dyn std::fmt::Display| ExportError(format!("the motion cannot be packed: {why}"));
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, content) in files {
        zip.start_file(*name, options).map_err(|error| wrong(&error))?;
        zip.write_all(content.as_bytes()).map_err(|error| wrong(&error))?;
    }
    Ok(zip.finish().map_err(|error| wrong(&error))?.into_inner())
}
