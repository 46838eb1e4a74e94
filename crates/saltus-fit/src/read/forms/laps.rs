//! Laps as a telephone's stopwatch lists them.

use super::super::cell::clock;

/// A clock shows hundredths: two of them differ by this at most where they say the same, s.
const HUNDREDTHS: f64 = 0.015;

/// A lap: its number, how long it took, and when it ended, as it is written and in s.
struct Lap<'a> {
    number: usize,
    took: f64,
    at: &'a str,
    ended: f64,
}

/// `Lap 2  00:00.96  00:01.51`: a word, a number, the time that the lap took and the time at its
/// end.
fn lap(line: &str) -> Option<(&str, Lap<'_>)> {
    let [word, number, took, at] = line.split_whitespace().collect::<Vec<_>>().try_into().ok()?;
    let named = word.chars().all(char::is_alphabetic);
    let number = number.trim_end_matches(['.', ':']).parse().ok()?;
    named.then_some(()).and_then(|()| Some((word, Lap { number, took: clock(took)?, at, ended: clock(at)? })))
}

/// The text with the ends of laps as times of impacts, in their order, and its other lines as
/// remarks. `None` unless there are three or more of one name, and each ends as much later than the
/// one before as it took.
pub(super) fn table(text: &str) -> Option<String> {
    let first = text.lines().position(|line| lap(line).is_some())?;
    let (names, mut laps): (Vec<&str>, Vec<Lap<'_>>) = text.lines().filter_map(lap).unzip();
    laps.sort_by_key(|lap| lap.number);
    let follows = |pair: &[Lap<'_>]| {
        let [before, after] = pair else { return false };
        after.number == before.number + 1 && (after.ended - before.ended - after.took).abs() < HUNDREDTHS
    };
    let adds_up = laps.len() > 2 && laps.windows(2).all(follows) && names.iter().all(|name| *name == names[0]);
    if !adds_up {
        return None;
    }
    let rows: String = laps.iter().map(|lap| format!("\r{}\t{}", lap.number, lap.at)).collect();
    let spelt = |(n, line): (usize, &str)| match lap(line) {
        // A lone carriage return ends a row, and no line.
        Some(_) if n == first => format!("impact\ttime{rows}"),
        None if !line.trim().is_empty() => format!("#{line}"),
        _ => String::new(),
    };
    Some(text.lines().enumerate().map(spelt).collect::<Vec<_>>().join("\n") + "\n")
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn laps_are_impacts_at_their_ends() {
        let text =
            "Stopwatch, by Ann\n\nLap 3  00:00.50  00:01.75\nLap 2  00:00.65  00:01.25\nLap 1  00:00.60  00:00.60\n";
        let expected = "#Stopwatch, by Ann\n\nimpact\ttime\r1\t00:00.60\r2\t00:01.25\r3\t00:01.75\n\n\n";
        assert_eq!(table(text).as_deref(), Some(expected));
        for text in [
            // They do not add up, or are too few.
            "Lap 3  00:00.50  00:01.75\nLap 2  00:00.65  00:01.35\nLap 1  00:00.60  00:00.60\n",
            "Lap 2  00:00.65  00:01.25\nLap 1  00:00.60  00:00.60\n",
        ] {
            assert_eq!(table(text), None, "{text}");
        }
    }
}
