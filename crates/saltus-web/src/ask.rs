//! Questions and answers as messages.

use serde::Deserialize;
use serde_json::{Value, json};

use crate::answer::{Answer, failed};
use crate::{fit, scene};

/// The questions.
#[derive(Debug, Deserialize)]
#[serde(tag = "ask", rename_all = "kebab-case", deny_unknown_fields)]
enum Ask {
    /// The COR from files: their names and lengths, in the order of their bytes.
    Fit { files: Vec<(String, usize)>, options: Box<fit::Options> },
    /// The motion of a scene.
    Run(scene::Run),
    /// A file for animators.
    Export { toml: String, format: String, fps: String },
    /// The change that each effect makes.
    Effects { toml: String },
}

/// The answer to a question; whatever fails is an answer too: `error`, with its kind, its words and
/// its place.
#[must_use]
pub fn answered(question: &[u8]) -> Vec<u8> {
    let (json, bytes) = match parted(question).and_then(|(ask, bytes)| answer(ask, bytes)) {
        Ok(answer) => answer,
        Err(error) => (json!({ "error": error }), Vec::new()),
    };
    let json = json.to_string().into_bytes();
    let length = u32::try_from(json.len()).unwrap_or(u32::MAX).to_le_bytes();
    [&length[..], &json, &bytes].concat()
}

/// The JSON of a message, and what stands behind it.
fn parted(message: &[u8]) -> Result<(Ask, &[u8]), Value> {
    let parts = message.split_first_chunk::<4>().and_then(|(length, rest)| {
        let length = usize::try_from(u32::from_le_bytes(*length)).ok()?;
        rest.split_at_checked(length)
    });
    let (json, bytes) = parts.ok_or_else(|| failed("question", "the message is cut short"))?;
    let ask = serde_json::from_slice(json).map_err(|error| failed("question", error))?;
    Ok((ask, bytes))
}

fn answer(ask: Ask, bytes: &[u8]) -> Answer {
    match ask {
        Ask::Fit { files, options } => fit::answer(&named(&files, bytes)?, &options),
        Ask::Run(run) => scene::answer(run),
        Ask::Export { toml, format, fps } => scene::export(&toml, &format, &fps),
        Ask::Effects { toml } => scene::effects(&toml),
    }
}

/// The files by name.
fn named<'a>(files: &'a [(String, usize)], mut bytes: &'a [u8]) -> Result<Vec<(&'a str, &'a [u8])>, Value> {
    let mut found = Vec::with_capacity(files.len());
    for (name, length) in files {
        let (file, rest) = bytes.split_at_checked(*length).ok_or_else(|| failed("question", "a file is cut short"))?;
        found.push((name.as_str(), file));
        bytes = rest;
    }
    Ok(found)
}
