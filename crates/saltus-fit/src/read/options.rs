//! What is stated beside the file.

use std::ops::Range;

/// How to read a table where the table itself does not say.
///
/// ```
/// use saltus_fit::{ReadOptions, Table};
///
/// let options = ReadOptions::default().height_unit("cm");
/// let table = Table::parse("drop.csv", b"bounce,height\n0,100\n1,64\n2,41\n", &options)?;
/// assert_eq!(table.trials()[0].readings()[1].height, Some(0.64));
/// # Ok::<(), saltus_fit::TableError>(())
/// ```
#[derive(Clone, Debug, Default)]
pub struct ReadOptions {
    pub(crate) height_unit: Option<String>,
    pub(crate) time_unit: Option<String>,
    pub(crate) column: Option<String>,
    pub(crate) filters: Vec<(String, String)>,
    pub(crate) header: Option<Vec<String>>,
    pub(crate) sheet: Option<String>,
    pub(crate) groups: Vec<String>,
    pub(crate) fps: Option<f64>,
    pub(crate) scale: Option<f64>,
    pub(crate) zero: Option<f64>,
    pub(crate) drop: Option<f64>,
    pub(crate) down: Option<bool>,
    pub(crate) listen: Option<Range<f64>>,
}

impl ReadOptions {
    /// The unit of heights (`m`, `cm`, `mm`, `in`, `px`, ...), used for columns whose header names
    /// none.
    #[must_use]
    pub fn height_unit(mut self, unit: &str) -> Self {
        self.height_unit = Some(unit.to_owned());
        self
    }

    /// The unit of times (`s`, `ms`, ...), used for columns whose header names none.
    #[must_use]
    pub fn time_unit(mut self, unit: &str) -> Self {
        self.time_unit = Some(unit.to_owned());
        self
    }

    /// The column, or the track, to take where several hold readings of the same thing; without it
    /// the first column, and of several tracks those that move.
    #[must_use]
    pub fn column(mut self, name: &str) -> Self {
        self.column = Some(name.to_owned());
        self
    }

    /// Keeps only the rows whose cell in the column `name` reads `value`; may be given several
    /// times.
    #[must_use]
    pub fn filter(mut self, name: &str, value: &str) -> Self {
        self.filters.push((name.to_owned(), value.to_owned()));
        self
    }

    /// Names for the columns, in place of those in the file, or where it has none; a column named
    /// `-` is left aside.
    ///
    /// ```
    /// use saltus_fit::{ReadOptions, Table};
    ///
    /// let options = ReadOptions::default().header(&["bounce", "-", "height_cm"]);
    /// let table = Table::parse("drop.csv", b"0,?,100\n1,?,64\n", &options)?;
    /// assert_eq!(table.trials()[0].readings()[1].height, Some(0.64));
    /// # Ok::<(), saltus_fit::TableError>(())
    /// ```
    #[must_use]
    pub fn header(mut self, names: &[&str]) -> Self {
        self.header = Some(names.iter().map(|name| name.trim().to_owned()).collect());
        self
    }

    /// A column whose cells tell balls or surfaces apart, or a column of readings of one of them;
    /// each then has a COR of its own. `-` for none, where a column's words are not understood.
    ///
    /// ```
    /// use saltus_fit::{ReadOptions, Table};
    ///
    /// let options = ReadOptions::default().group("wilson (cm)").group("penn (cm)");
    /// let table = Table::parse("drop.csv", b"drop (cm),wilson (cm),penn (cm)\n100,55,53\n100,56,54\n", &options)?;
    /// assert_eq!(table.groups(), ["wilson", "penn"]);
    /// # Ok::<(), saltus_fit::TableError>(())
    /// ```
    #[must_use]
    pub fn group(mut self, column: &str) -> Self {
        self.groups.push(column.to_owned());
        self
    }

    /// The sheet of a workbook, or the file of an archive, to read; without it every one that holds
    /// a table.
    #[must_use]
    pub fn sheet(mut self, name: &str) -> Self {
        self.sheet = Some(name.to_owned());
        self
    }

    /// How many frames were filmed in a second, for tables that count frames.
    #[must_use]
    pub fn fps(mut self, frames_per_second: f64) -> Self {
        self.fps = Some(frames_per_second);
        self
    }

    /// How many metres one pixel is. The COR of a track needs no scale; its heights do.
    #[must_use]
    pub fn scale(mut self, metres_per_pixel: f64) -> Self {
        self.scale = Some(metres_per_pixel);
        self
    }

    /// The height of release, m, of every drop of which the table does not tell it.
    ///
    /// ```
    /// use saltus_fit::{ReadOptions, Table};
    ///
    /// let options = ReadOptions::default().drop_height(1.0);
    /// let table = Table::parse("drop.csv", b"trial,rebound_cm\n1,64\n2,65\n", &options)?;
    /// assert_eq!(table.trials()[1].readings()[0].height, Some(1.0));
    /// # Ok::<(), saltus_fit::TableError>(())
    /// ```
    #[must_use]
    pub fn drop_height(mut self, metres: f64) -> Self {
        self.drop = Some(metres);
        self
    }

    /// What the height scale reads at the floor, in its own unit; heights are then counted from
    /// there.
    #[must_use]
    pub fn zero(mut self, reading: f64) -> Self {
        self.zero = Some(reading);
        self
    }

    /// The part of a sound to listen to, s.
    #[must_use]
    pub fn listen(mut self, part: Range<f64>) -> Self {
        self.listen = Some(part);
        self
    }

    /// The part to listen to: all, if none was named.
    pub(crate) fn listened(&self) -> Range<f64> {
        self.listen.clone().unwrap_or(0.0..f64::INFINITY)
    }

    /// Whether the height scale counts downwards, as pictures do. Without it a series of heights
    /// tells by the way it falls.
    #[must_use]
    pub fn y_down(mut self, down: bool) -> Self {
        self.down = Some(down);
        self
    }
}
