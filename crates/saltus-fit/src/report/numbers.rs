//! Numbers for people: as many digits as their error leaves them, and units of a handy size.

/// Decimals that show an error to two digits if it begins with a one, else to one; from three to
/// nine.
pub(super) fn digits(error: f64) -> usize {
    decimals(3, error)
}

/// The same from fewer decimals on.
fn decimals(least: i32, error: f64) -> usize {
    (least..9).find(|&n| error * 10f64.powi(n) >= 1.95).and_then(|n| usize::try_from(n).ok()).unwrap_or(9)
}

/// A number and its error with the same decimals, three at least, as a COR has them.
pub(super) fn pair(value: f64, error: f64) -> String {
    with_error(value, error, digits(error))
}

/// The same with no more decimals than the error asks for.
pub(super) fn measured(value: f64, error: f64) -> String {
    with_error(value, error, decimals(0, error))
}

/// The same with a plus before what is above zero.
pub(super) fn signed(value: f64, error: f64) -> String {
    format!("{}{}", if value > 0.0 { "+" } else { "" }, measured(value, error))
}

fn with_error(value: f64, error: f64, digits: usize) -> String {
    if error < 0.5e-9 {
        return format!("{value:.digits$} ± {error:.0e}");
    }
    format!("{value:.digits$} ± {error:.digits$}")
}

/// A number to three digits, without decimals from 100 on.
pub(super) fn number(x: f64) -> String {
    match x {
        x if x >= 20.0 => format!("{x:.0}"),
        x if x >= 0.05 => format!("{x:.1}"),
        x => format!("{x:.2}"),
    }
}

/// A length in mm or cm.
pub(super) fn length(metres: f64) -> String {
    if metres >= 0.001 { format!("{} cm", figures(100.0 * metres)) } else { format!("{} mm", figures(1000.0 * metres)) }
}

/// A duration in ms or s.
pub(super) fn duration(seconds: f64) -> String {
    if seconds < 1.0 { format!("{} ms", figures(1000.0 * seconds)) } else { format!("{} s", figures(seconds)) }
}

/// A number to two significant figures, without trailing zeros.
pub(super) fn figures(x: f64) -> String {
    let text = match x {
        x if x >= 9.95 => format!("{x:.0}"),
        x if x >= 0.995 => format!("{x:.1}"),
        x if x >= 0.0995 => format!("{x:.2}"),
        x => format!("{x:.1e}"),
    };
    if text.contains('.') && !text.contains('e') {
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        text
    }
}
