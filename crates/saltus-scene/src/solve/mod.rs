//! The scene that does what is wished for: numbers of a scene file are found with which wishes come
//! true.

mod freedom;
mod search;
mod wish;

use freedom::Freedom;
use saltus_bounce::effects::Gravity;
use search::{Found, Problem, starts};
use toml_edit::DocumentMut;
pub use wish::{Clock, What, Wish};

use crate::number::digits;
use crate::plan::Record;
use crate::{Error, Run, Scene};

/// The scene to begin with where none is given.
const DROP: &str = "gravity = \"earth\"\nrestitution = 0.7\n\n[ball]\nheight = \"1 m\"\nvelocity = \"0 m/s\"\n";
/// The longest run, in s, and in units of the last time of a wish.
const LONG: f64 = 1e3;
const TIMES_AS_LONG: f64 = 20.0;
/// Jumps that are no contacts, such as apexes, for each that is one.
const OTHER_JUMPS: usize = 4;

/// A scene in which wishes come true, as nearly as they can.
#[derive(Debug)]
pub struct Solved {
    draft: Draft,
    wishes: Vec<Wish>,
    found: Found,
    begun: Scene,
    /// Whether no scene was given to begin with.
    dropped: bool,
}

/// Finds the numbers of a scene with which `wishes` come true.
///
/// `begin` is the name and the text of the scene to begin with: without one the ball falls from 1 m
/// by the Earth's gravity and keeps 0.7 of its speed at each contact. `free` are the numbers that
/// may change: `height`, `throw`, `forward`, `gravity`, `cor`, or a key of the scene such as
/// `drag.per_length`.
///
/// # Errors
/// [`Error`]: the scene is none, a freedom is no number of it, or the wishes contradict each other.
///
/// ```
/// use saltus_scene::Scene;
/// use saltus_scene::solve::{Clock, Wish, solve};
/// let wishes = [Wish::parse("touch 1 at frame 24", Clock { fps: 24.0, first: 0 })?];
/// let solved = solve(None, &["throw"], &wishes)?;
/// // v = gT/2 - h/T for T = 1 s and h = 1 m.
/// assert!((solved.numbers()[0].1 - (0.5 * 9.80665 - 1.0)).abs() < 1e-7);
/// assert!((Scene::parse("solved", solved.toml()?.as_bytes())?.plan()?.run()?.impacts()[0].t - 1.0).abs() < 1e-7);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn solve(begin: Option<(&str, &[u8])>, free: &[&str], wishes: &[Wish]) -> Result<Solved, Error> {
    let (name, text) = begin.unwrap_or(("a drop", DROP.as_bytes()));
    let begun = Scene::parse(name, text).map_err(Error::new)?;
    let text = std::str::from_utf8(text).map_err(Error::new)?;
    let mut file: DocumentMut = text.parse().map_err(Error::new)?;
    let mut freedoms: Vec<Freedom> = Vec::new();
    for name in free.iter().map(|name| name.trim()) {
        if freedoms.iter().any(|freedom| freedom.name == name) {
            return Err(Error::new(format!("`{name}` is free twice: name it once")));
        }
        freedoms.push(Freedom::named(name, &mut file, &begun).map_err(Error::new)?);
    }
    for (n, one) in wishes.iter().enumerate() {
        if let Some(other) = wishes[n + 1..].iter().find(|other| other.what == one.what && other.asked != one.asked) {
            let says = "they are of the same thing, which is one or the other: leave one out";
            return Err(Error::new(format!("'{}' and '{}' contradict each other: {says}", one.text, other.text)));
        }
    }
    let draft = Draft { file, freedoms, run: long_enough(wishes) };
    // An error of the scene to begin with is reported, not searched around.
    let start: Vec<f64> = draft.freedoms.iter().map(|freedom| freedom.start).collect();
    let first = draft.written(&start).map_err(Error::new)?;
    let first = Scene::parse_with(name, first.as_bytes(), draft.run).map_err(Error::new)?;
    first.plan().map_err(Error::new)?;

    let all: Vec<&Wish> = wishes.iter().collect();
    let Some(found) = draft.best(&all) else { return Err(Error::new(never(&draft, wishes))) };
    if !found.meets() && wishes.len() <= draft.freedoms.len() {
        return Err(Error::new(contradiction(&draft, wishes, &found)));
    }
    Ok(Solved { draft, wishes: wishes.to_vec(), found, begun, dropped: begin.is_none() })
}

impl Solved {
    /// The scene that was begun with.
    #[must_use]
    pub const fn begun(&self) -> &Scene {
        &self.begun
    }

    /// The scene file with the numbers that were found, and with an end where the motion has none
    /// of its own.
    ///
    /// # Errors
    /// [`Error`] where a number cannot be written into the file.
    pub fn toml(&self) -> Result<String, Error> {
        self.draft.whole(&self.found.numbers).map_err(Error::new)
    }

    /// The freedoms by name, and the number found for each, in the unit that the scene has for it.
    #[must_use]
    pub fn numbers(&self) -> Vec<(&str, f64)> {
        let names = self.draft.freedoms.iter().map(|freedom| freedom.name.as_str());
        names.zip(self.found.numbers.iter().copied()).collect()
    }

    /// The value that each wish came to, in s or m.
    #[must_use]
    pub fn came(&self) -> Vec<f64> {
        self.wishes.iter().zip(&self.found.off).map(|(wish, off)| wish.asked + off * wish.within).collect()
    }

    /// Whether every wish is met as well as numbers can.
    #[must_use]
    pub fn meets(&self) -> bool {
        self.found.meets()
    }

    /// The result in lines, for a person who counts frames by `clock`.
    #[must_use]
    pub fn says(&self, clock: Clock) -> Vec<String> {
        let Self { draft, wishes, found, .. } = self;
        let mut lines = vec![draft.says(&found.numbers)];
        for (wish, value) in wishes.iter().zip(self.came()) {
            lines.push(format!("  {}", came(wish, value, clock)));
        }
        if self.dropped {
            let held = [("height", "1 m"), ("throw", "0 m/s"), ("gravity", "the Earth's"), ("cor", "0.7")];
            let held: Vec<String> = held
                .iter()
                .filter(|(name, _)| draft.freedoms.iter().all(|freedom| freedom.name != *name))
                .map(|(name, value)| format!("{name} {value}"))
                .collect();
            if !held.is_empty() {
                lines.push(format!("not said, and so taken: {}; --scene begins with another", held.join(", ")));
            }
        }
        if let Some((_, &gravity)) =
            draft.freedoms.iter().zip(&found.numbers).find(|(freedom, _)| freedom.name == "gravity")
        {
            let times = gravity / Gravity::EARTH.value();
            lines.push(format!("gravity is {} times the Earth's", digits(times, 3)));
        }
        if !found.meets() {
            lines.push(format!(
            "{} wishes and {} to change: not all can be met, and how far off they are is as even as can be; 'within' behind a wish says how much it matters",
            wishes.len(),
            draft.freedoms.len()
        ));
        } else if wishes.len() < draft.freedoms.len() {
            lines.push(
                "many scenes do that, and this is one near where it began: wish for more, or free less".to_owned(),
            );
        }
        lines
    }
}

/// A scene file, and what of it may change.
#[derive(Debug)]
struct Draft {
    file: DocumentMut,
    freedoms: Vec<Freedom>,
    run: Run,
}

impl Draft {
    /// The file with these numbers.
    fn written(&self, numbers: &[f64]) -> Result<String, String> {
        let mut file = self.file.clone();
        for (freedom, &number) in self.freedoms.iter().zip(numbers) {
            freedom.set(&mut file, number)?;
        }
        Ok(file.to_string())
    }

    /// The file with these numbers, and with an end where the motion has none of its own.
    fn whole(&self, numbers: &[f64]) -> Result<String, String> {
        let text = self.written(numbers)?;
        let ends = self.file.get("run").is_some_and(|run| run.get("until").is_some());
        if ends || Scene::parse("solve", text.as_bytes()).is_ok() {
            return Ok(text);
        }
        let last = self.record(numbers).and_then(|record| Some(record.impacts().last()?.t));
        let mut file: DocumentMut = text.parse().map_err(|error: toml_edit::TomlError| error.to_string())?;
        file["run"]["until"] = toml_edit::value(format!("{} s", digits(last.unwrap_or(1.0), 3)));
        Ok(file.to_string())
    }

    fn record(&self, numbers: &[f64]) -> Option<Record> {
        let text = self.written(numbers).ok()?;
        let scene = Scene::parse_with("solve", text.as_bytes(), self.run).ok()?;
        scene.plan().ok()?.run().ok()
    }

    /// The numbers that come nearest to the wishes; `None` if nothing comes to all of them.
    fn best(&self, wishes: &[&Wish]) -> Option<Found> {
        let off = |numbers: &[f64]| {
            let record = self.record(numbers)?;
            wishes.iter().map(|wish| Some((wish.measured(&record)? - wish.asked) / wish.within)).collect()
        };
        let numbers: Vec<f64> = self.freedoms.iter().map(|freedom| freedom.start).collect();
        let limits: Vec<[f64; 2]> = self.freedoms.iter().map(|freedom| [freedom.least, freedom.most]).collect();
        let sizes: Vec<f64> = numbers.iter().map(|number| if *number == 0.0 { 1.0 } else { number.abs() }).collect();
        let starts = starts(&numbers, &limits, &sizes);
        Problem { limits, sizes, off: &off }.best(&starts)
    }

    fn names(&self) -> String {
        let names: Vec<&str> = self.freedoms.iter().map(|freedom| freedom.name.as_str()).collect();
        names.join(", ")
    }

    /// The numbers for a person.
    fn says(&self, numbers: &[f64]) -> String {
        let says: Vec<String> =
            self.freedoms.iter().zip(numbers).map(|(freedom, &number)| freedom.says(number)).collect();
        says.join(", ")
    }
}

/// Long enough to see what is wished for.
fn long_enough(wishes: &[Wish]) -> Run {
    let last = wishes.iter().filter(|wish| !wish.what.is_length()).map(|wish| wish.asked).fold(0.0, f64::max);
    let contacts: Option<Vec<usize>> = wishes.iter().map(Wish::contacts).collect();
    let most = contacts.and_then(|contacts| contacts.into_iter().max());
    let jumps = most.and_then(|most| u32::try_from((1 + OTHER_JUMPS) * (most + 2)).ok());
    let mut run = Run::default();
    (run.until, run.most_jumps) = (Some(LONG.max(TIMES_AS_LONG * last)), jumps);
    run
}

/// The value that a wish came to, in words.
fn came(wish: &Wish, value: f64, clock: Clock) -> String {
    let shown = match wish.what {
        What::Place(_) | What::Height(_) => format!("{} m", digits(value, 6)),
        What::Hop(_) => format!("{} s, {} frames", digits(value, 6), digits(value * clock.fps, 6)),
        _ => format!("{} s, frame {}", digits(value, 6), digits(value * clock.fps + f64::from(clock.first), 6)),
    };
    let missed = value - wish.asked;
    let unit = if wish.what.is_length() { "m" } else { "s" };
    if (missed / wish.within).abs() < 1e-6 {
        return format!("{}: {shown}", wish.text);
    }
    let way = match (wish.what.is_length(), wish.what, missed > 0.0) {
        (true, _, true) => "more",
        (true, _, false) => "less",
        (_, What::Hop(_), true) => "longer",
        (_, What::Hop(_), false) => "shorter",
        (_, _, true) => "later",
        (_, _, false) => "earlier",
    };
    format!("{}: {shown}, {} {unit} {way} than asked", wish.text, digits(missed.abs(), 3))
}

/// The error where no trial came to all wishes.
fn never(draft: &Draft, wishes: &[Wish]) -> String {
    let alone = wishes.iter().find(|wish| draft.best(&[wish]).is_none());
    match alone {
        Some(wish) => format!(
            "'{}' never comes, whatever {} is: ask for less, or free another of height, throw, forward, gravity and cor",
            wish.text,
            draft.names()
        ),
        None => format!("no {} was found with which all wishes come: wish for less", draft.names()),
    }
}

/// The error that names the wishes that cannot be met, alone or together.
fn contradiction(draft: &Draft, wishes: &[Wish], found: &Found) -> String {
    let others = "free another of height, throw, forward, gravity and cor";
    for wish in wishes {
        let Some(best) = draft.best(&[wish]) else { continue };
        if !best.meets() {
            let unit = if wish.what.is_length() { "m" } else { "s" };
            let nearest = digits(wish.asked + best.off[0] * wish.within, 3);
            return format!(
                "'{}' cannot be by {} alone: the nearest is {nearest} {unit}, with {}; {others}",
                wish.text,
                draft.names(),
                draft.says(&best.numbers)
            );
        }
    }
    for (k, one) in wishes.iter().enumerate() {
        for other in &wishes[k + 1..] {
            if !draft.best(&[one, other]).is_some_and(|best| best.meets()) {
                return format!(
                    "'{}' and '{}' contradict each other: either can be met by {}, both cannot; {others}",
                    one.text,
                    other.text,
                    draft.names()
                );
            }
        }
    }
    let worst = wishes.iter().zip(&found.off).max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let worst = worst.map_or("", |(wish, _)| wish.text.as_str());
    format!(
        "the wishes contradict each other, '{worst}' most: any two can be met by {}, all cannot; {others}",
        draft.names()
    )
}
