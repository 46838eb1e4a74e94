//! Points that were measured in single pictures of a film, as `ImageJ` lists them: `Label`, `X` and
//! `Y` in pixels beside how bright it is there, `Mean`; the label ends in what the point is.

use super::super::named::{event, names_floor};
use super::super::vocabulary::folded;

/// The events and the places of such a list, in pixels; `None` where a label ends in no event.
pub(super) fn table(text: &str) -> Option<String> {
    let cells = |line: &'_ str| -> Vec<String> { line.split(['\t', ',']).map(|cell| cell.trim().to_owned()).collect() };
    let mut lines = text.lines();
    let names = cells(lines.next()?);
    let at = |name: &str| names.iter().position(|cell| folded(cell) == name);
    let (label, y, _, _) = (at("label")?, at("y")?, at("x")?, at("mean")?);
    let mut found = "event\ty (px)\n".to_owned();
    for line in lines {
        let row = cells(line);
        if row.iter().all(String::is_empty) {
            found.push('\n');
            continue;
        }
        let (name, place) = (row.get(label)?, row.get(y)?);
        // What brackets hold is a remark.
        let name = name.rsplit(':').next()?.split('(').next()?.trim();
        match (names_floor(name), event(name)) {
            (true, _) => found.push_str(&format!("#floor at y = {place} px\n")),
            (false, Some(_)) => found.push_str(&format!("{name}\t{place}\n")),
            (false, None) => return None,
        }
    }
    Some(found)
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn labels_end_in_events() {
        let text = " \tLabel\tArea\tMean\tX\tY\n1\tf.avi:7:release (by hand)\t0\t75\t41\t136\n2\tf.avi:90:floor\t0\t79\t42\t958\n";
        assert_eq!(table(text).as_deref(), Some("event\ty (px)\nrelease\t136\n#floor at y = 958 px\n"));
        assert_eq!(table(&text.replace("floor", "zorb")), None);
        assert_eq!(table(&text.replace("Mean", "Angle")), None);
    }
}
