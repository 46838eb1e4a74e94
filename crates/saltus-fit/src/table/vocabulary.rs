//! The words that names of columns are made of.

/// Names that are offered where one is not known.
pub(super) const KNOWN: [&str; 11] = [
    "event",
    "bounce",
    "time_s",
    "height_cm",
    "interval_s",
    "time_error_s",
    "height_error_cm",
    "h0_cm",
    "trial",
    "ball",
    "note",
];

pub(super) const ERROR: &[&str] = &["error", "err", "sigma", "uncertainty", "unc", "sd", "std", "stdev", "se"];
pub(super) const INTERVAL: &[&str] = &["interval", "intervals", "dt", "delta", "duration", "gap", "period"];
pub(super) const TIME: &[&str] = &["time", "times", "t", "timestamp", "clock", "zeit", "temps", "tiempo", "tempo"];
pub(super) const HEIGHT: &[&str] = &[
    "height",
    "heights",
    "h",
    "y",
    "z",
    "altitude",
    "rebound",
    "apex",
    "peak",
    "position",
    "distance",
    "displacement",
    "elevation",
    "höhe",
    "hauteur",
    "altura",
    "altezza",
];
pub(super) const AVERAGE: &[&str] = &["average", "mean", "avg", "moyenne", "mittelwert", "media"];
pub(super) const FRAME: &[&str] = &["frame", "frames", "slice"];
pub(super) const RELEASE: &[&str] = &["drop", "release", "initial", "start", "released", "dropped", "before"];
pub(super) const TRIAL: &[&str] = &[
    "trial",
    "run",
    "drop",
    "launch",
    "throw",
    "series",
    "track",
    "repeat",
    "repetition",
    "rep",
    "set",
    "experiment",
    "test",
];
pub(super) const BOUNCE: &[&str] =
    &["bounce", "bounces", "n", "number", "no", "contact", "impact", "index", "hit", "k", "i"];
pub(super) const EVENT: &[&str] = &["event", "events", "what", "phase"];
pub(super) const SETTING: &[&str] = &["ball", "surface", "material", "floor", "object", "temperature", "condition"];
pub(super) const REPEAT: &[&str] = &["group", "person", "sample", "id"];
pub(super) const IGNORED: &[&str] = &[
    "source",
    "file",
    "filename",
    "comment",
    "comments",
    "note",
    "notes",
    "remark",
    "remarks",
    "observer",
    "date",
    "x",
    "v",
    "vx",
    "vy",
    "a",
    "ax",
    "ay",
    "velocity",
    "speed",
    "acceleration",
    "energy",
    "force",
    "step",
    "flag",
    "jumps",
    "mode",
    // What is to be found, worked out by somebody already.
    "cor",
    "e",
    "cr",
    "coefficient",
    "restitution",
    "pixelx",
    "pixely",
];

/// Whether a word of a name says what a column holds, or counts.
pub(super) fn is_vocabulary(word: &str) -> bool {
    [ERROR, INTERVAL, TIME, HEIGHT, AVERAGE, FRAME, RELEASE, TRIAL, BOUNCE, EVENT, SETTING]
        .iter()
        .any(|list| list.contains(&word))
        || number(word).is_some()
}

/// The number of a bounce or a trial in a name; nobody counts further.
pub(super) fn number(word: &str) -> Option<usize> {
    word.parse().ok().filter(|n| *n <= 1_000_000)
}
