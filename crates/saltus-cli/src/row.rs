//! A run in a report for programs: what was measured, or why there is nothing.

use serde::Serialize;

#[derive(Serialize)]
pub(crate) struct Row<T> {
    /// What was run: "as it is", "without wind", "Tsit5 1e-6".
    pub(crate) run: String,
    /// What came of it.
    #[serde(flatten)]
    pub(crate) came: Came<T>,
}

#[derive(Serialize)]
#[serde(untagged)]
pub(crate) enum Came<T> {
    Measured(T),
    /// Why there is no such run.
    Refused {
        refused: String,
    },
}

/// A refusal in one line: what is wrong and what to do, without the place in a scene that nobody
/// wrote.
pub(crate) fn plainly(refused: &str) -> String {
    let mut lines = refused.lines();
    let first = lines.next().unwrap_or_default();
    let help = lines.find_map(|line| line.trim().strip_prefix("help: ").map(|help| format!(": {help}")));
    // `scene.toml:22:2: what is wrong`, or `drag: what is wrong`.
    let said = match first.rsplit_once(": ") {
        Some((place, said)) if place.ends_with(|c: char| c.is_ascii_digit()) => said,
        _ => first,
    };
    let key = |c: char| c.is_ascii_lowercase() || c == '_';
    let said = said.split_once(": ").filter(|(place, _)| place.chars().all(key)).map_or(said, |(_, said)| said);
    format!("{said}{}", help.unwrap_or_default())
}

#[cfg(test)]
mod tests {
    use super::plainly;

    #[test]
    fn a_refusal_is_one_line_without_a_place() {
        let placed = "box.toml:22:2: several balls are smooth\n   22 | [floor]\n      |  ^^^^^\n  help: keep one ball";
        assert_eq!(plainly(placed), "several balls are smooth: keep one ball");
        assert_eq!(plainly("added_mass: it is for one ball: leave it out"), "it is for one ball: leave it out");
        assert_eq!(
            plainly("its speed is not known: give `wind` under [air]"),
            "its speed is not known: give `wind` under [air]"
        );
        assert_eq!(plainly(""), "");
    }
}
