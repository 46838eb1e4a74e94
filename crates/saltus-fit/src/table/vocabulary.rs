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
pub(super) const INTERVAL: &[&str] = &[
    "interval",
    "intervals",
    "dt",
    "delta",
    "duration",
    "gap",
    "period",
    "durée",
    "intervalle",
    "intervalles",
    "dauer",
    "intervall",
    "intervalle",
    "zeitabstand",
    "zeitintervall",
    "flugzeit",
    "flugdauer",
    "airtime",
    "hangtime",
    "durata",
    "intervallo",
    "intervalli",
    "duración",
    "intervalo",
    "intervalos",
];
/// With these a time is one between contacts: `air time`, `time between bounces`, `lap time`.
pub(super) const BETWEEN: &[&str] = &["between", "air", "flight", "hang", "lap", "entre", "zwischen", "tra"];
pub(super) const TIME: &[&str] = &[
    "time",
    "times",
    "t",
    "timestamp",
    "clock",
    "zeit",
    "temps",
    "tiempo",
    "tempo",
    "aufprallzeit",
    "zeitpunkt",
    "aufprallzeitpunkt",
    "kontaktzeit",
    "instant",
    "istante",
    "instante",
];
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
    "höhen",
    "hoehe",
    "fallhöhe",
    "starthöhe",
    "anfangshöhe",
    "abwurfhöhe",
    "sprunghöhe",
    "rücksprunghöhe",
    "rückprallhöhe",
    "hauteurs",
    "alturas",
    "altezze",
    "ort",
    "weg",
    "lage",
    "posición",
    "posizione",
];
pub(super) const AVERAGE: &[&str] =
    &["average", "mean", "avg", "moyenne", "mittelwert", "media", "moyennes", "durchschnitt", "mittel", "promedio"];
pub(super) const FRAME: &[&str] = &["frame", "frames", "slice", "bild", "bildnummer", "fotogramma", "fotograma"];
pub(super) const RELEASE: &[&str] = &[
    "drop",
    "release",
    "initial",
    "start",
    "released",
    "dropped",
    "before",
    "fallhöhe",
    "starthöhe",
    "anfangshöhe",
    "abwurfhöhe",
    "initiale",
    "chute",
    "départ",
    "lâcher",
    "iniziale",
    "caduta",
    "inicial",
    "caída",
];
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
    "versuch",
    "messung",
    "durchgang",
    "wurf",
    "essai",
    "mesure",
    "lancer",
    "prova",
    "lancio",
    "misura",
    "ensayo",
    "intento",
    "lanzamiento",
];
pub(super) const BOUNCE: &[&str] = &[
    "bounce",
    "bounces",
    "n",
    "number",
    "no",
    "contact",
    "impact",
    "index",
    "hit",
    "k",
    "i",
    "contacts",
    "impacts",
    "hits",
    "lap",
    "laps",
    "aufprall",
    "aufpralle",
    "kontakt",
    "stoß",
    "stoss",
    "nr",
    "nummer",
    "rebond",
    "rebonds",
    "choc",
    "numéro",
    "rimbalzo",
    "rimbalzi",
    "urto",
    "numero",
    "rebote",
    "rebotes",
    "bote",
    "número",
];
pub(super) const EVENT: &[&str] = &["event", "events", "what", "phase"];
pub(super) const SETTING: &[&str] = &[
    "ball",
    "surface",
    "material",
    "floor",
    "object",
    "temperature",
    "condition",
    "boden",
    "untergrund",
    "balle",
    "ballon",
    "sol",
    "palla",
    "pallina",
    "suelo",
    "pelota",
];
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
    "bemerkung",
    "datum",
    "geschwindigkeit",
    "remarque",
    "vitesse",
    "énergie",
    "velocità",
    "velocidad",
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

/// The number that a word such as `2nd` puts a bounce or a trial in.
pub(super) fn ordinal(word: &str) -> Option<usize> {
    let words = ["first", "second", "third", "fourth", "fifth", "sixth"];
    let digits = ["st", "nd", "rd", "th"].iter().find_map(|end| word.strip_suffix(end)).and_then(number);
    digits.or_else(|| words.iter().position(|w| *w == word).map(|n| n + 1))
}

/// The number of a trial: it may be a letter, as in `run B`.
pub(super) fn of_trial(word: &str) -> Option<usize> {
    number(word).or_else(|| ["a", "b", "c", "d", "e", "f"].iter().position(|letter| *letter == word).map(|n| n + 1))
}
