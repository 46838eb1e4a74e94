//! How much is read of one file: what is more is refused, or not looked at, whatever it says.

/// A table of more cells is refused: at sixteen bytes each, and with their text, they would fill a
/// hundred megabytes.
pub(super) const CELLS: usize = 1 << 22;
/// Nobody hands in so many columns, sheets, tables or files of an archive, counts bounces or drops
/// so far, types so many lines, or writes so many characters into a cell.
pub(super) const MANY: usize = 1000;

/// The text of a table that has as many cells as are read, of numbers of sixteen digits with a sign
/// and an exponent; so much a file may hold, and what is packed in it, bytes.
pub(super) const fn bytes() -> usize {
    32 * CELLS
}

#[cfg(test)]
mod tests {
    use super::super::foreign;
    use super::super::sheet::Content;
    use super::super::words::{Kind, split};

    /// A row of three hundred cells is read to its end, and of three thousand only the beginning;
    /// a bounce is counted as far.
    #[test]
    fn columns_and_bounces_are_counted_to_a_thousand() {
        let cells = |count: usize| {
            let page = format!("<table><tr>{}</tr></table>", "<td>1</td>".repeat(count));
            let parts = foreign::html(&page).unwrap();
            match &parts[0].content {
                Content::Cells(text) => text.split('\t').count(),
                Content::Bytes(_) => 0,
            }
        };
        assert_eq!((cells(300), cells(3000)), (300, 1000));
        let counted = |text: &str| matches!(split(text)[1].kind, Kind::Number(_));
        assert!(counted("bounce 300") && !counted("bounce 3000"));
    }
}
