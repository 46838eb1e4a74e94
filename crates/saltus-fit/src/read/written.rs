//! To how much numbers were written: the resolution that a table shows itself.

/// The largest power of ten, a whole at most, of which all numbers are multiples.
pub(super) fn step(numbers: impl Iterator<Item = f64> + Clone) -> f64 {
    // What is left of a multiple by rounding in binary is less than a millionth of it.
    let multiple = |step: f64| numbers.clone().all(|x| ((x / step).round() * step - x).abs() < 1e-6 * step);
    (0..9).map(|n| 10f64.powi(-n)).find(|&step| multiple(step)).unwrap_or(1e-9)
}

/// Whether `exact`, rounded to `step`, is written as `number`: half a step off, and a millionth for
/// the sums of `exact`.
pub(super) fn rounds_to(exact: f64, number: f64, step: f64) -> bool {
    (exact - number).abs() <= (0.5 + 1e-6) * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn means_are_written_to_the_last_digit_of_their_column() {
        let numbers = |all: &[f64]| step(all.iter().copied());
        for (all, to) in [(&[64.0, 410.0][..], 1.0), (&[0.64, 0.4], 0.01), (&[64.3, 64.25, 64.125], 0.001)] {
            assert!((numbers(all) / to - 1.0).abs() < 1e-9, "{all:?} {}", numbers(all));
        }
        assert!(numbers(&[1.0 / 3.0]) <= 1e-9 && numbers(&[]) == 1.0);
        for (exact, number, step, is) in [
            (64.25, 64.3, 0.1, true),
            (64.25, 64.2, 0.1, true),
            (64.24, 64.3, 0.1, false),
            (64.25, 64.3, 0.01, false),
            (64.333_333, 64.33, 0.01, true),
        ] {
            assert_eq!(rounds_to(exact, number, step), is, "{exact} {number}");
        }
    }
}
