//! The one text that is wanted of an archive.

use std::io::{Cursor, Read};

use serde_json::Value;
use zip::ZipArchive;

use super::ReadError;

/// The most bytes that are unpacked: a million frames of ten balls have half of it.
const MOST: u64 = 1 << 30;

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

fn opened(bytes: &[u8]) -> Result<Archive<'_>, ReadError> {
    ZipArchive::new(Cursor::new(bytes)).map_err(|error| ReadError::new(format!("it is no zip archive: {error}")))
}

/// A file of an archive by its number.
fn text(archive: &mut Archive<'_>, index: usize) -> Result<String, ReadError> {
    let mut text = String::new();
    let file = archive.by_index(index).map_err(ReadError::new)?;
    file.take(MOST + 1).read_to_string(&mut text).map_err(ReadError::new)?;
    if text.len() as u64 > MOST {
        return Err(ReadError::new(format!("what is in it has more than {MOST} bytes")));
    }
    Ok(text)
}

/// The layer of a USDZ: its first file.
pub(super) fn layer(bytes: &[u8]) -> Result<String, ReadError> {
    let mut archive = opened(bytes)?;
    let Some(name) = archive.name_for_index(0) else { return Err(ReadError::new("there is nothing in it")) };
    let name = name.map_err(ReadError::new)?.into_owned();
    if name.ends_with(".usda") {
        text(&mut archive, 0)
    } else {
        Err(ReadError::new(format!("its first file, '{name}', is no USD as text")))
    }
}

/// The first animation of a dotLottie, by its manifest.
pub(super) fn animation(bytes: &[u8]) -> Result<String, ReadError> {
    let mut archive = opened(bytes)?;
    let mut file = |name: &str| match archive.index_for_name(name) {
        Some(index) => text(&mut archive, index),
        None => Err(ReadError::new(format!("there is no '{name}' in it"))),
    };
    let manifest: Value = serde_json::from_str(&file("manifest.json")?).map_err(ReadError::new)?;
    let id = manifest["animations"][0]["id"].as_str();
    let id = id.ok_or_else(|| ReadError::new("its manifest names no animation"))?;
    file(&format!("a/{id}.json"))
}
