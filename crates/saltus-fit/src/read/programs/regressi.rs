//! What Régressi writes: pages of readings, the names and units of whose columns stand above them
//! one a line.

use crate::read::grid::View;
use crate::read::region::Region;

/// The tables of its text, `None` where it is none: sections such as `£3 NOM VAR`, each with so
/// many lines below it.
pub(super) fn tables(view: View<'_>) -> Option<Vec<Region<'_>>> {
    let line = |row: usize| view.cells(row).collect::<Vec<_>>().join(" ");
    if !line(0).to_uppercase().contains("REGRESSI") {
        return None;
    }
    let (mut names, mut units): (Vec<String>, Vec<String>) = (Vec::new(), Vec::new());
    let mut regions: Vec<Region<'_>> = Vec::new();
    let mut row = 1;
    while row < view.rows() {
        let (head, count) = (line(row), counted(&line(row)).unwrap_or(0));
        let below = row + 1..(row + 1).saturating_add(count).min(view.rows());
        match head.split_once(' ').map(|(_, section)| section) {
            Some("NOM VAR") => names = below.clone().map(line).collect(),
            Some("UNITE VAR") => units = below.clone().map(line).collect(),
            Some("VALEUR VAR") => {
                let header = names.iter().enumerate().map(|(n, name)| match units.get(n) {
                    Some(unit) if !unit.is_empty() => format!("{name} ({unit})"),
                    _ => name.clone(),
                });
                let label = format!("page {}", regions.len() + 1);
                let header = header.collect();
                regions.push(Region { label, ..Region::new(view, header, row, below.clone().collect()) });
            }
            _ => {}
        }
        row = below.end;
    }
    if let [only] = regions.as_mut_slice() {
        only.label.clear();
    }
    Some(regions).filter(|regions| !regions.is_empty())
}

/// How many lines a section has: its first word is a sign, `£` or `&`, and that number.
fn counted(head: &str) -> Option<usize> {
    let mut sign = head.split(' ').next()?.chars();
    sign.next().filter(|c| matches!(c, '£' | '&'))?;
    sign.as_str().parse().ok()
}
