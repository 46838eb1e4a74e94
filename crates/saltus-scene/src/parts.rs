//! The folder of a sweep: whose its parts are, what they are called and how long they are, the same
//! for whoever writes them.

use std::ops::Range;
use std::time::{Duration, Instant};

use serde::Serialize;
use serde_json::Value as Json;
use sha2::{Digest, Sha256};

use crate::Error;
use crate::number::hex;
use crate::sweep::Sweep;
use crate::vary::Said;

/// The name of the file that says whose the parts of a folder are. Readers of Parquet pass over
/// names that begin so.
pub const PLAN: &str = "_sweep.json";

/// The key of a part's metadata under which it bears its [`Identity`].
pub const KEY: &str = "saltus";

/// The work of one core in a part: what a disk or a cluster takes for one is a hundredth of it, and
/// no more is lost where a sweep is killed.
const SPELL: Duration = Duration::from_millis(500);

/// The part of that work from which the time of a row is estimated.
const LOOK: Duration = Duration::from_millis(50);

/// Multiples of (√5 - 1)/2, less whole numbers, come near every place soon.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// The most rows of a part: a few megabytes.
const LONGEST: f64 = 50_000.0;

/// All that the rows of a sweep depend on, as JSON with a hash of itself, so that parts are of one
/// sweep if and only if their hashes are one.
///
/// Values count as they are and not as they are written: `0.5:0.7:3` and a list of the same
/// numbers are one, and so are a grid and a design of one key. The scene counts as text. The
/// settings of the runs are `until` and `most_jumps`: a sweep has no others that are not the
/// scene's.
///
/// ```
/// use saltus_scene::sweep::{Identity, RowFormat, Sweep, difference, part, parts};
/// use saltus_scene::{Run, vary::{Variation, Vary}};
///
/// let toml = b"restitution = 0.8\nball = { height = '1 m' }\n";
/// let of = |vary: &Vary| -> Result<Identity, saltus_scene::Error> {
///     Identity::of(&Sweep::new("drop.toml", toml, vary, Run::default(), RowFormat::Csv, None)?)
/// };
/// let range = of(&Vary::new(&["restitution=0.5:0.7:3"])?)?;
/// assert_eq!(range, of(&Vary::new(&["restitution=0.5,0.60,0.7"])?)?);
///
/// let other = of(&Vary::new(&["restitution=0.5,0.6"])?)?;
/// let how = difference(other.said(), range.said()).unwrap();
/// assert!(how.starts_with("its `vary` is [{\"key\":\"restitution\",\"values\":[0.5,0.6,0.7]}], here it is"), "{how}");
/// assert_eq!(difference(range.said(), range.said()), None);
///
/// let names: Vec<_> = parts(120, 50).map(|rows| part(rows.start, 120)).collect();
/// assert_eq!(names, ["part-000.parquet", "part-050.parquet", "part-100.parquet"]);
/// # Ok::<(), saltus_scene::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Identity {
    said: String,
    hash: String,
}

/// In the order in which it is written, and so hashed.
#[derive(Serialize)]
struct Rows<'a> {
    saltus: &'static str,
    scene: &'a str,
    vary: Vec<Said<'a>>,
    rows: bool,
    random: Option<u64>,
    seed: Option<u64>,
    until_s: Option<f64>,
    most_jumps: Option<u32>,
    columns: &'a [String],
    runs: u64,
}

#[derive(Serialize)]
struct Hashed<'a> {
    #[serde(flatten)]
    rows: Rows<'a>,
    hash: &'a str,
}

impl Identity {
    /// That of a sweep.
    ///
    /// # Errors
    /// [`Error`] if it cannot be written as JSON.
    pub fn of(sweep: &Sweep<'_>) -> Result<Self, Error> {
        let (vary, end) = (sweep.vary(), sweep.end());
        let rows = Rows {
            saltus: env!("CARGO_PKG_VERSION"),
            scene: sweep.scene(),
            vary: vary.variations.iter().map(|variation| variation.said(vary.random.is_some())).collect(),
            rows: vary.rows && vary.variations.len() > 1,
            random: vary.random,
            seed: vary.random.map(|_| vary.seed),
            until_s: end.until,
            most_jumps: end.most_jumps,
            columns: sweep.headers(),
            runs: sweep.runs(),
        };
        let hash = hex(&Sha256::digest(serde_json::to_string(&rows).map_err(Error::new)?));
        let said = serde_json::to_string(&Hashed { rows, hash: &hash }).map_err(Error::new)?;
        Ok(Self { said, hash })
    }

    /// What each part bears: an object of JSON, with the hash under `hash`.
    #[must_use]
    pub fn said(&self) -> &str {
        &self.said
    }

    /// Whether a part, or a plan, that bears this text is of this sweep.
    #[must_use]
    pub fn is_of(&self, said: &str) -> bool {
        serde_json::from_str(said).is_ok_and(|said: Json| said["hash"] == self.hash.as_str())
    }
}

/// What is compared, what says most first.
const ORDER: [&str; 11] =
    ["saltus", "scene", "vary", "rows", "random", "seed", "until_s", "most_jumps", "format", "columns", "runs"];

/// What first tells two sweeps apart, in words: the one here from the one that was `found`, both as
/// JSON; `None` where they are one.
#[must_use]
pub fn difference(here: &str, found: &str) -> Option<String> {
    let [here, found] = [here, found].map(|text| serde_json::from_str(text).unwrap_or(Json::Null));
    // Numbers that were read and written again may look another way: the hash is what counts.
    let one = found.is_object() && here.get("hash") == found.get("hash");
    if one && here.get("hash").is_some() {
        return None;
    }
    let Some(key) = ORDER.into_iter().find(|key| here.get(key) != found.get(key)) else {
        return (!one).then(|| "it is not written as this version writes it".to_owned());
    };
    let [here, there] = [&here, &found].map(|sweep| sweep.get(key).unwrap_or(&Json::Null));
    Some(match key {
        "scene" => "the scene is not the same".to_owned(),
        key => format!("its `{key}` is {there}, here it is {here}"),
    })
}

/// The runs of each part, all of one length but the last.
pub fn parts(runs: u64, chunk: u64) -> impl Iterator<Item = Range<u64>> {
    let starts = (0..runs.div_ceil(chunk.max(1))).map(move |n| n * chunk);
    starts.map(move |start| start..start.saturating_add(chunk).min(runs))
}

/// The name of the part that begins with run `start`, of so many: in order of their names parts are
/// in order.
#[must_use]
pub fn part(start: u64, runs: u64) -> String {
    let width = runs.to_string().len();
    format!("part-{start:0width$}.parquet")
}

/// The number of rows in a part, as long as rows take here, at places all over the sweep: half a
/// second's work of one core.
#[must_use]
#[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at most 10^8
pub fn pace(sweep: &Sweep<'_>) -> u64 {
    let (runs, mut count, mut place) = (sweep.runs(), 1, 0.0_f64);
    loop {
        place = (place + GOLDEN).fract();
        let start = (place * (runs - count + 1) as f64) as u64;
        let begin = Instant::now();
        (start..start + count).for_each(|run| drop(sweep.cells(run)));
        let took = begin.elapsed();
        if took > LOOK || 2 * count > runs {
            return (count as f64 * SPELL.as_secs_f64() / took.as_secs_f64()).clamp(1.0, LONGEST) as u64;
        }
        count *= 2;
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::{Identity, difference, parts};
    use crate::Run;
    use crate::sweep::{Column, RowFormat, Sweep};
    use crate::vary::{Variation, Vary};

    const DROP: &[u8] = b"restitution = 0.8\nball = { height = '1 m' }\n";

    fn of(toml: &[u8], vary: &Vary, run: Run, columns: Option<&[Column]>) -> Identity {
        let sweep = Sweep::new("drop.toml", toml, vary, run, RowFormat::Csv, columns).expect("a sweep");
        Identity::of(&sweep).expect("an identity")
    }

    fn text(texts: &[&str]) -> Vary {
        Vary::new(texts).expect("values")
    }

    fn made(variations: Vec<Variation>, rows: bool) -> Vary {
        Vary { variations, random: None, seed: 1, rows }
    }

    #[test]
    fn values_count_as_they_are() {
        let plain = |vary: &Vary| of(DROP, vary, Run::default(), None);
        let tool = plain(&text(&["restitution=0.5:0.7:3", "ball.height=0.5,1,2"]));
        let numbers = |key: &str, values: &[f64]| Variation::numbers(key, values.to_vec()).expect("numbers");
        let listed = [numbers("restitution", &[0.5, 0.6, 0.7]), numbers("ball.height", &[0.5, 1.0, 2.0])];
        assert_eq!(tool, plain(&made(listed.to_vec(), false)));
        assert_ne!(tool, plain(&made(listed.to_vec(), true)), "rows of a design are no grid");
        let [first, second] = listed;
        assert_ne!(tool, plain(&made(vec![second, first.clone()], false)), "another order of the rows");
        assert_eq!(plain(&text(&["restitution=0.5:0.7:3"])), plain(&made(vec![first], true)));
        // Amounts of several units are words, and of one are numbers in it.
        let words = Variation::words("ball.height", &["20 cm".to_owned(), "1 m".to_owned()]).expect("words");
        assert_eq!(plain(&text(&["ball.height=20 cm,1 m"])), plain(&made(vec![words], false)));
        assert_ne!(plain(&text(&["ball.height=1m,2m"])), plain(&text(&["ball.height=1,2"])));
        assert_eq!(plain(&text(&["ball.height=1m,2m"])), plain(&text(&["ball.height = 1 m, 2.0 m"])));
        // A word is not the number that it looks like.
        let word = Variation::words("gravity", &["moon".to_owned()]).expect("words");
        assert_eq!(plain(&text(&["gravity=moon"])), plain(&made(vec![word], false)));
        // A mark of the encoding is no text.
        let marked = [b"\xef\xbb\xbf", DROP].concat();
        assert_eq!(of(&marked, &text(&["gravity=moon"]), Run::default(), None), plain(&text(&["gravity=moon"])));
    }

    #[test]
    fn what_rows_depend_on_is_told_apart() {
        let grid = text(&["restitution=0.5:0.7:3"]);
        let here = of(DROP, &grid, Run::default(), None);
        let until = Run { until: Some(2.0), ..Run::default() };
        let jumps = Run { most_jumps: Some(9), ..Run::default() };
        let drawn = |count, seed| Vary { random: Some(count), seed, ..text(&["restitution=0.5:0.7"]) };
        for (other, says) in [
            (
                of(b"restitution = 0.8\nball = { height = '2 m' }\n", &grid, Run::default(), None),
                "the scene is not the same",
            ),
            (of(DROP, &grid, until, None), "its `until_s` is null, here it is 2.0"),
            (of(DROP, &grid, jumps, None), "its `most_jumps` is null, here it is 9"),
            (of(DROP, &grid, Run::default(), Some(&[Column::Impacts])), "its `columns` is [\"run\",\"restitution\","),
            (of(DROP, &drawn(3, 1), Run::default(), None), "its `vary` is ["),
        ] {
            let how = difference(other.said(), here.said()).expect("they differ");
            assert!(how.starts_with(says) && !here.is_of(other.said()), "{how}");
        }
        assert!(here.is_of(here.said()) && !here.is_of("torn"));
        let [one, other] = [1, 2].map(|seed| of(DROP, &drawn(3, seed), Run::default(), None));
        assert_eq!(difference(other.said(), one.said()).as_deref(), Some("its `seed` is 1, here it is 2"));
        // The seed of a grid draws nothing.
        assert_eq!(here, of(DROP, &Vary { seed: 7, ..grid }, Run::default(), None));
        assert!(difference(here.said(), "{}").is_some() && difference(here.said(), "torn").is_some());
    }

    /// Of a long list the plan has a hash: one value changed is another sweep.
    #[test]
    fn long_lists_are_hashed() {
        let list = |last: f64| {
            let values = (0..5000).map(|n| f64::from(n) * 1e-4).chain([last]).collect();
            made(vec![Variation::numbers("restitution", values).expect("numbers")], false)
        };
        let [one, same, other] = [0.7, 0.7, 0.71].map(|last| of(DROP, &list(last), Run::default(), None));
        assert_eq!(one, same);
        assert!(one != other && one.said().len() < 1000);
    }

    proptest! {
        /// Every run is in one part.
        #[test]
        fn parts_are_a_partition(runs in 1..10_000_u64, chunk in 1..3000_u64) {
            let all: Vec<u64> = parts(runs, chunk).flatten().collect();
            prop_assert_eq!(all, (0..runs).collect::<Vec<_>>());
        }
    }
}
