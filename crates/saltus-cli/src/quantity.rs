//! Numbers as people and tables write them.

/// `1.5 m` is 1.5 and `m`; the longest number that the text begins with. `None` unless it begins with a finite one.
pub(crate) fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    if !text.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.')) {
        return None;
    }
    let ends = (1..=text.len()).rev().filter(|&end| text.is_char_boundary(end));
    let mut split = ends.filter_map(|end| Some((text[..end].trim_end().parse::<f64>().ok()?, text[end..].trim())));
    split.next().filter(|(value, _)| value.is_finite())
}

/// The shortest text of the same number, without an exponent where that is short.
pub(crate) fn number(value: f64) -> String {
    match value.abs() {
        0.0 => "0".to_owned(),
        1e-4..1e15 => value.to_string(),
        _ if value.is_finite() => format!("{value:e}"),
        _ => String::new(),
    }
}
