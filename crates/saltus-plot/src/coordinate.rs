//! Which coordinate of a state is meant, by its name or its place.

use crate::error::PlotError;

/// A coordinate of the state of a run: by its place, or by its name ([`saltus::State::name`], or as
/// a picture names it).
///
/// ```
/// use saltus_plot::Coordinate;
/// let (place, name): (Coordinate, Coordinate) = (1.into(), "load.speed".into());
/// assert_eq!((place, name), (Coordinate::Place(1), Coordinate::Name("load.speed".to_owned())));
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// The place, counted from 0.
    Place(usize),
    /// The name. That of a list or of a struct of coordinates is the name of all of them, where
    /// several may be.
    Name(String),
}

impl From<usize> for Coordinate {
    fn from(place: usize) -> Self {
        Self::Place(place)
    }
}

impl From<&str> for Coordinate {
    fn from(name: &str) -> Self {
        Self::Name(name.to_owned())
    }
}

impl From<String> for Coordinate {
    fn from(name: String) -> Self {
        Self::Name(name)
    }
}

/// A coordinate as a picture names it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Label {
    pub(crate) name: String,
    pub(crate) unit: String,
}

impl Label {
    /// The name and the unit in words with a unit in brackets at the end, if there is one.
    pub(crate) fn read(words: &str) -> Self {
        let words = words.trim();
        let parts = words.strip_suffix(')').and_then(|rest| rest.rsplit_once('('));
        let (name, unit) = parts.map_or((words, ""), |(name, unit)| (name.trim_end(), unit));
        Self { name: name.to_owned(), unit: unit.to_owned() }
    }

    /// The list of which it is one, if it is: `arm` of `arm[2]`.
    pub(crate) fn list(&self) -> Option<&str> {
        self.name.strip_suffix(']').and_then(|name| name.rsplit_once('[')).map(|(list, _)| list)
    }
}

/// The places of all coordinates that are meant.
pub(crate) fn places(meant: &Coordinate, labels: &[Label]) -> Result<Vec<usize>, PlotError> {
    let within = |label: &Label, name: &str| {
        label.name == name || label.name.strip_prefix(name).is_some_and(|rest| rest.starts_with(['[', '.']))
    };
    let (asked, places) = match meant {
        Coordinate::Place(place) => (place.to_string(), (*place..labels.len()).take(1).collect::<Vec<_>>()),
        Coordinate::Name(name) => {
            (format!("\"{name}\""), (0..labels.len()).filter(|&i| within(&labels[i], name)).collect())
        }
    };
    if places.is_empty() {
        let names = labels.iter().map(|label| label.name.clone()).collect();
        return Err(PlotError::Coordinate { asked, names });
    }
    Ok(places)
}

/// The one place that is meant.
pub(crate) fn place(meant: &Coordinate, labels: &[Label]) -> Result<usize, PlotError> {
    match places(meant, labels)?[..] {
        [place] => Ok(place),
        ref several => {
            let asked = match meant {
                Coordinate::Name(name) => format!("\"{name}\" alone"),
                Coordinate::Place(place) => place.to_string(),
            };
            Err(PlotError::Coordinate { asked, names: several.iter().map(|&i| labels[i].name.clone()).collect() })
        }
    }
}
