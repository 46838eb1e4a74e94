//! `--values "100 64 41 26 cm"`: a table as a line of numbers and a unit.

use saltus_bounce::units::Quantity;

/// The line as a table: heights from the release on, contact times where they ascend, times between
/// contacts where they do not.
pub(super) fn table(line: &str) -> Result<String, String> {
    let line = line.trim();
    let end = line.rfind(|c: char| c.is_ascii_digit() || c == '.').map_or(0, |last| last + 1);
    let (numbers, unit) = (&line[..end], line[end..].trim());
    let known = |quantity: Quantity| quantity.scale(unit).is_some();
    let numbers = numbers_of(numbers)?;
    let name = match (known(Quantity::Length), known(Quantity::Time)) {
        (true, _) => "height",
        (_, true) if numbers.is_sorted() => "time",
        (_, true) => "interval",
        _ => {
            return Err(format!(
                "'{line}' ends in no unit of length or time: write it behind the numbers, such as '100 64 41 cm'"
            ));
        }
    };
    let rows: String = numbers.iter().map(|number| format!("{number}\n")).collect();
    Ok(format!("{name}_{unit}\n{rows}"))
}

/// Numbers between spaces, semicolons or commas; beside spaces a comma within a number is its
/// decimal point.
fn numbers_of(text: &str) -> Result<Vec<f64>, String> {
    let spaced: Vec<&str> =
        text.split([' ', '\t', ';']).map(|part| part.trim_matches(',')).filter(|p| !p.is_empty()).collect();
    let number = |part: &str| match part.replace(',', ".").parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("'{part}' is not a number: write heights or times in order, such as '100 64 41 cm'")),
    };
    match spaced[..] {
        [] => Err("there are no numbers: write heights or times in order, such as '100 64 41 cm'".to_owned()),
        [one] => one.split(',').map(number).collect(),
        _ => spaced.into_iter().map(number).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::table;

    #[test]
    fn lines_are_tables() {
        for (line, text) in [
            ("100 64 41 26 cm", "height_cm\n100\n64\n41\n26\n"),
            ("1, 0.64, 0.41m", "height_m\n1\n0.64\n0.41\n"),
            ("100,64,41 cm", "height_cm\n100\n64\n41\n"),
            ("100 64,5 41,2 cm", "height_cm\n100\n64.5\n41.2\n"),
            ("0.45;0.85;1.11 s", "time_s\n0.45\n0.85\n1.11\n"),
            ("722 578 463 ms", "interval_ms\n722\n578\n463\n"),
        ] {
            assert_eq!(table(line).as_deref(), Ok(text), "{line}");
        }
        for (line, says) in [
            ("100 64 41", "no unit"),
            ("100 x4 41 cm", "'x4' is not a number"),
            ("", "no numbers"),
            ("cm", "no numbers"),
        ] {
            let error = table(line).unwrap_err();
            assert!(error.contains(says), "{line}: {error}");
        }
    }
}
