//! Signs of flights by the contacts that they lie between: `t12` beside `t23`.

use super::Heading;

impl Heading {
    /// The flight between two contacts, `t12 (s)`, `t_23_s`, where the first two stand in the row.
    pub(super) fn flight(text: &str, header: &[String]) -> Option<Self> {
        let (first, unit) = between(text)?;
        let stands = |n: u32| header.iter().filter_map(|name| between(name)).any(|(first, _)| first == n);
        (stands(1) && stands(2)).then(|| Self::parse(&format!("flight time {first}{unit}")).called(text))
    }
}

/// The contact that a flight begins at, by a sign that counts it and the next, and the text behind.
fn between(text: &str) -> Option<(u32, &str)> {
    let (sign, rest) = text.split_at(text.find(|c: char| c.is_ascii_digit())?);
    let (pair, unit) = rest.split_at(rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len()));
    let mut digits = pair.chars().filter_map(|c| c.to_digit(10));
    let (first, next) = (digits.next()?, digits.next()?);
    let of_time = matches!(sign.trim_end_matches('_'), "t" | "T" | "dt" | "Δt");
    (of_time && next == first + 1 && digits.next().is_none()).then_some((first, unit))
}

#[cfg(test)]
mod tests {
    use super::super::{At, What};
    use super::*;

    #[test]
    fn signs_count_the_contacts_of_a_flight() {
        let header = |names: &[&str]| names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
        let flights = header(&["h (m)", "t12 (s)", "t23 (s)", "t34 (s)"]);
        for (n, text) in [(1, "t12 (s)"), (2, "t23 (s)"), (3, "t34 (s)")] {
            let heading = Heading::flight(text, &flights).unwrap();
            let value = heading.value().unwrap();
            assert_eq!((value.what, value.at), (What::Interval, At::Nth(n)), "{text}");
            assert!(heading.unit.is_some() && heading.text == text);
        }
        assert!(Heading::flight("t12_s", &header(&["t12_s", "t23_s"])).is_some());
        // Of trials, or of no first flight.
        for names in [&["t12 (s)", "t13 (s)"][..], &["t34 (s)", "t45 (s)"], &["h12", "h23"], &["t1", "t2"]] {
            assert!(Heading::flight(names[0], &header(names)).is_none(), "{names:?}");
        }
    }
}
