//! A scene file in which values are set before it is made into a scene.

use std::borrow::Cow;
use std::fmt;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::error::{Fault, SceneError};
use super::{Run, Scene, read};

/// A scene file, read once, that is made into many scenes: each with its own values under the same
/// keys.
///
/// A key is the path of a value in the file, such as `restitution`, `ball.height` or, in lists,
/// `floor.0.friction`, counted from 0; what the file does not say may be set as well. A value is
/// written as TOML writes it: a number, text in quotes, `true` or `false`. Every check of
/// [`Scene::parse`] is made of every scene.
///
/// ```
/// use saltus_scene::{Run, Template};
/// let template = Template::parse("drop.toml", b"restitution = 0.8\nball = { height = '1 m' }\n", &["ball.height"])?;
/// for (height, metres) in [("'20 cm'", 0.2), ("'3 m'", 3.0)] {
///     assert_eq!(template.scene(&[height], Run::default())?.balls[0].lowest().z, metres);
/// }
/// let error = template.scene(&["'3 s'"], Run::default()).unwrap_err();
/// assert!(error.to_string().starts_with("drop.toml as varied:1:15: 's' in '3 s' is not a unit of length but of time"));
/// # Ok::<(), saltus_scene::SceneError>(())
/// ```
pub struct Template<'a> {
    name: String,
    bytes: &'a [u8],
    text: &'a str,
    table: Spanned<DeTable<'a>>,
    keys: Vec<&'a str>,
}

impl fmt::Debug for Template<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Template").field("name", &self.name).field("keys", &self.keys).finish_non_exhaustive()
    }
}

impl<'a> Template<'a> {
    /// Reads a file in which `keys` are to be set; `name` stands for it in messages.
    ///
    /// # Errors
    /// [`SceneError`] when the text is no TOML; whether it is a scene is checked when it is made
    /// into one.
    pub fn parse(name: &str, toml: &'a [u8], keys: &[&'a str]) -> Result<Self, SceneError> {
        let bytes = read::unmarked(toml);
        let parsed = read::text(bytes).and_then(|text| Ok((text, read::table(text)?)));
        let (text, table) = parsed.map_err(|fault| SceneError::new(name, bytes, fault))?;
        Ok(Self { name: name.to_owned(), bytes, text, table, keys: keys.to_vec() })
    }

    /// The text of the file.
    pub(crate) const fn text(&self) -> &str {
        self.text
    }

    /// The scene with `values`, one for each key, in the order of the keys; a key without a value
    /// is as in the file. The settings in `run` go before those of the file.
    ///
    /// # Errors
    /// As [`Scene::parse`], and where `run` has what is set under a key; a message about a value
    /// that was set shows that value.
    pub fn scene(&self, values: &[&str], run: Run) -> Result<Scene, SceneError> {
        self.made(values, run).map_err(|fault| self.explained(values, fault))
    }

    fn made(&self, values: &[&str], run: Run) -> Result<Scene, Fault> {
        let mut table: Spanned<DeTable<'_>> = self.table.clone();
        for (n, (key, value)) in self.keys.iter().zip(values).enumerate() {
            let mark = self.mark(n);
            if run.gives(key) {
                let says = format!("`{key}` is set, and given for every run as well: leave one of them out");
                return Err(Fault::new(mark..mark + 1, says));
            }
            let at = mark + 1..mark + 2;
            let value = DeValue::parse(value).map_err(|_| {
                Fault::new(at.clone(), "this is no value: write a number, text in quotes, or true or false")
            })?;
            if matches!(value.get_ref(), DeValue::Array(_) | DeValue::Table(_)) {
                return Err(Fault::new(at, "lists and tables cannot be set: set each value in them by its own key"));
            }
            *slot(table.get_mut(), key, mark)? = Spanned::new(at, value.into_inner());
        }
        read::made(self.text, table, run)
    }

    /// The place of key `n` in messages: behind the end of the file, its value behind it.
    const fn mark(&self, n: usize) -> usize {
        self.bytes.len() + 1 + 2 * n
    }

    /// The fault with its line: of the file, or, where a value was set, that key and value.
    fn explained(&self, values: &[&str], mut fault: Fault) -> SceneError {
        let mark = fault.span.start.checked_sub(self.mark(0));
        let set = mark.and_then(|mark| Some((mark % 2 == 1, self.keys.get(mark / 2)?, values.get(mark / 2)?)));
        let Some((of_value, key, value)) = set else { return SceneError::new(&self.name, self.bytes, fault) };
        let line = format!("{key} = {value}");
        fault.span = if of_value { key.len() + 3..line.len() } else { 0..key.len() };
        SceneError::new(&format!("{} as varied", self.name), line.as_bytes(), fault)
    }
}

/// The place of a key; tables on its way are made where they are wanting.
fn slot<'t, 'v>(root: &'t mut DeTable<'v>, key: &'v str, mark: usize) -> Result<&'t mut Spanned<DeValue<'v>>, Fault> {
    let fault = |says: String| Fault::new(mark..mark + 1, says);
    let (first, rest) = key.split_once('.').map_or((key, None), |(first, rest)| (first, Some(rest)));
    let mut slot = child(root, first, mark);
    let mut way = first.len();
    for step in rest.into_iter().flat_map(|rest| rest.split('.')) {
        let done = &key[..way];
        way += 1 + step.len();
        slot = match slot.get_mut() {
            DeValue::Table(table) => child(table, step, mark),
            DeValue::Array(list) => {
                let count = list.len();
                let one = step.parse::<usize>().ok().and_then(|n| list.get_mut(n));
                one.ok_or_else(|| match count {
                    0 => fault(format!("`{done}` is an empty list: there is nothing in it to set")),
                    1 => fault(format!("`{done}` is a list of one: write `{done}.0`")),
                    _ => fault(format!("`{done}` is a list of {count}: write `{done}.0` to `{done}.{}`", count - 1)),
                })?
            }
            _ => return Err(fault(format!("`{done}` is one value and has no keys: set `{done}` itself"))),
        };
    }
    Ok(slot)
}

fn child<'t, 'v>(table: &'t mut DeTable<'v>, key: &'v str, mark: usize) -> &'t mut Spanned<DeValue<'v>> {
    let empty = || Spanned::new(mark + 1..mark + 2, DeValue::Table(DeTable::new()));
    table.entry(Spanned::new(mark..mark + 1, Cow::Borrowed(key))).or_insert_with(empty)
}
