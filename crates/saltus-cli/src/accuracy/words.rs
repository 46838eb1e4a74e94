//! Errors, costs and targets in words.

use saltus_scene::accuracy::{Accuracy, Difference, Outcome, Target, Way};

/// Two digits; a dash where there is nothing to compare.
pub(super) fn short(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        value if value.is_finite() => format!("{value:.1e}"),
        _ => "-".to_owned(),
    }
}

/// The worst impact time; infinite where no impact is where it should be, so that there is no time
/// to compare.
pub(super) fn impacts(off: &Difference) -> f64 {
    if off.impacts == 0.0 && off.missed > 0 { f64::INFINITY } else { off.impacts }
}

/// A length or a time in a unit that fits, to two digits.
pub(super) fn sized(value: f64, unit: &str) -> String {
    let scales = [(1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n")];
    let fits = scales.iter().find(|(scale, _)| value >= 0.9999 * scale);
    match fits {
        _ if value == 0.0 => format!("0 {unit}"),
        Some((scale, prefix)) => {
            let number = value / scale;
            let digits = if number < 9.95 && (number - number.round()).abs() > 1e-9 { 1 } else { 0 };
            format!("{number:.digits$} {prefix}{unit}")
        }
        None => format!("{value:.0e} {unit}"),
    }
}

/// A length and a time.
pub(super) fn off(length: f64, time: f64) -> String {
    format!("{} and {}", sized(length, "m"), sized(time, "s"))
}

pub(super) fn aim(target: Target) -> String {
    let parts = [target.length.map(|m| sized(m, "m")), target.time.map(|s| sized(s, "s"))];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    parts.join(" and ")
}

/// What runs are measured against.
pub(super) fn reference(accuracy: &Accuracy) -> String {
    match accuracy.reference().0 {
        Way::Formulas => "the solution by formulas".to_owned(),
        way => format!("a run by {way}"),
    }
}

/// The median, the least and the greatest time of a run; nothing if it was not timed.
pub(super) fn took(outcome: &Outcome) -> Option<String> {
    let timing = outcome.timing?;
    let (scale, unit, digits) = clock(timing.median);
    let [least, greatest] = [timing.least, timing.greatest].map(|s| format!("{:.digits$}", scale * s));
    Some(format!("{:.digits$} {unit} ({least} to {greatest})", scale * timing.median))
}

/// The time of a run alone.
pub(super) fn median(seconds: f64) -> String {
    let (scale, unit, digits) = clock(seconds);
    format!("{:.digits$} {unit}", scale * seconds)
}

/// A unit for the time of a run, how many of it a second has, and how many decimals it is given.
fn clock(median: f64) -> (f64, &'static str, usize) {
    let (scale, unit) = if median < 9.995e-4 { (1e6, "µs") } else { (1e3, "ms") };
    (scale, unit, if scale * median < 9.95 { 1 } else { 0 })
}
