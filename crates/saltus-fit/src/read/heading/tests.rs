use super::*;

fn value(text: &str) -> Value {
    let heading = Heading::parse(text);
    assert!(heading.unknown.is_empty(), "{text}: {heading:?}");
    heading.value().unwrap_or_else(|| panic!("{text}: {heading:?}")).clone()
}

#[test]
fn heights_and_times_and_at_which_event() {
    use At::{After, Before, Nth, Release, Row};
    use What::{Height, Interval, Speed, Time, Total};
    for (text, what, at) in [
        ("Drop height (cm)", Height, Release),
        ("Rebound height (cm)", Height, Row),
        ("h0 (cm)", Height, Release),
        ("h_1 [m]", Height, Nth(1)),
        ("h₂ / cm", Height, Nth(2)),
        ("height after 2nd bounce (cm)", Height, Nth(2)),
        ("Height of the first bounce in cm", Height, Nth(1)),
        ("1. Rückprall", Height, Nth(1)),
        ("Fallhöhe (cm)", Height, Release),
        ("hauteur du rebond (cm)", Height, Row),
        ("Bounce 1 (cm)", Height, Nth(1)),
        ("Bounce 1 (s)", Time, Nth(1)),
        ("t1 (s)", Time, Nth(1)),
        ("Ordonnée y1 (m)", Height, Row),
        ("time between bounces (s)", Interval, Row),
        ("Air time (s)", Interval, Row),
        ("Lap Time", Interval, Row),
        ("time until it stops (s)", Total, Row),
        ("Total", Total, Row),
        ("v before (m/s)", Speed, Before),
        ("speed after impact (m/s)", Speed, After),
        ("Impact velocity (m/s)", Speed, Before),
        ("Rebound speed (m/s)", Speed, After),
        ("the ball's height above the floor (cm)", Height, Row),
        ("time since release (s)", Time, Row),
        ("1:a studsen (cm)", Height, Nth(1)),
        ("2.º ressalto (cm)", Height, Nth(2)),
        ("1-й отскок (см)", Height, Nth(1)),
        ("a doua săritură (cm)", Height, Nth(2)),
        ("durée totale (s)", Total, Row),
        ("Dauer bis zum Stillstand (s)", Total, Row),
        ("hastighed før (m/s)", Speed, Before),
        ("höjd av studs (cm)", Height, Row),
    ] {
        let found = value(text);
        if text == "1. Rückprall" {
            assert_eq!(found.at, at, "{text}");
            continue;
        }
        assert_eq!((found.what, found.at, found.role), (what, at, Role::Reading), "{text}: {found:?}");
    }
}

/// Up to twenty drops are counted, and no height.
#[test]
fn few_drops_are_counted() {
    assert!(["drop 2 cm", "drop 15 cm"].iter().all(|text| release(text).is_none()));
    assert!(["drop 50 cm", "drop 150 cm", "dropped from 15 cm"].iter().all(|text| release(text).is_some()));
}

/// Of a pair `h_i`, `h_f` one is before and one after; by themselves both are something else.
#[test]
fn what_is_initial_stands_beside_what_is_final() {
    for (initial, last) in [("h_i (m)", "h_f (m)"), ("v_i (m/s)", "v_f (m/s)"), ("u_i (m/s)", "u_f (m/s)")] {
        let header = [initial.to_owned(), last.to_owned()];
        let at = |text: &str| Heading::initial(text, &header).and_then(|h| h.value().map(|v| v.at));
        assert!(matches!(at(initial), Some(At::Release | At::Before)), "{initial}");
        assert!(matches!(at(last), Some(At::Row | At::After)), "{last}");
        assert!(Heading::initial(last, &header[1..]).is_none());
    }
}

#[test]
fn words_that_turn_the_meaning() {
    for (text, why) in [
        ("theoretical height (cm)", Why::Predicted),
        ("Expected rebound (cm)", Why::Predicted),
        ("target height (cm)", Why::Goal),
        ("h1/h0", Why::Derived),
        ("height ratio", Why::Derived),
        ("Δh (cm)", Why::Derived),
        ("e", Why::Derived),
        ("v_{y}", Why::Other),
        ("vᵧ (m/s)", Why::Other),
        ("x (m)", Why::Other),
        ("Mass (g)", Why::Other),
        ("Comment", Why::Note),
    ] {
        assert_eq!(Heading::parse(text).meaning, Meaning::Aside(why), "{text}");
    }
    for (text, role) in [
        ("height lost (cm)", Role::Lost),
        ("mean (cm)", Role::Mean),
        ("sd (cm)", Role::Error),
        ("Incertitude (cm)", Role::Error),
        ("max rebound (cm)", Role::Max),
        ("height_error_cm", Role::Error),
        ("SD", Role::Error),
    ] {
        assert_eq!(value(text).role, role, "{text}");
    }
}

#[test]
fn keys_trials_and_balls() {
    for (text, meaning) in [
        ("bounce", Meaning::Number { sure: true }),
        ("Bounce no.", Meaning::Number { sure: true }),
        ("Peak no.", Meaning::Number { sure: true }),
        ("Rebound number", Meaning::Number { sure: true }),
        ("n", Meaning::Number { sure: false }),
        ("#", Meaning::Number { sure: false }),
        ("Trial", Meaning::Trial),
        ("Run no.", Meaning::Trial),
        ("Ball", Meaning::Setting),
        ("Type of ball", Meaning::Setting),
        ("Surface", Meaning::Setting),
        ("event", Meaning::Event),
        ("Frame", Meaning::Frame),
        ("", Meaning::Empty),
    ] {
        assert_eq!(Heading::parse(text).meaning, meaning, "{text}");
    }
    for (text, trial, group) in [
        ("Trial 2 (cm)", "Trial 2", ""),
        ("run A (cm)", "run A", ""),
        ("Ball A y (m)", "", "Ball A"),
        ("Golf ball (cm)", "", "Golf ball"),
        ("Wood (cm)", "", "Wood"),
        ("Trial 1 bounce 2 (cm)", "Trial 1", ""),
        ("Run 2: Position (m)", "Run 2", ""),
    ] {
        let found = value(text);
        assert_eq!((found.trial.as_str(), found.group.as_str()), (trial, group), "{text}: {found:?}");
    }
    let unknown = |text: &str| Heading::parse(text).unknown;
    assert_eq!(unknown("Zorb (cm)"), ["Zorb"]);
    assert_eq!(value("Anna (cm)").trial, "Anna");
    assert!(unknown("hight_cm").is_empty() && Heading::parse("hight_cm").misspelt.len() == 1);
    let misspelt = Heading::parse("hieght_cm");
    assert!(misspelt.understood() && misspelt.misspelt == [("hieght".to_owned(), "height")]);
    assert_eq!(Heading::parse("height (± 0.5 cm)").spread, Some(0.5));
}

/// A whole number behind a word of trials counts them, up to twenty; a larger one is a height.
#[test]
fn drops_are_counted_and_heights_are_not() {
    let height = |text: &str| release(text).map(|(drop, _)| drop.metres());
    assert_eq!(height("Drop 150 cm"), Some(1.5));
    assert_eq!(height("Drop 30 cm"), Some(0.3));
    assert_eq!((height("Drop 12 cm"), height("Drop 3 m")), (None, None));
    assert_eq!(height("Drop 2.5 m"), Some(2.5));
}

/// What a formula of other columns gives was worked out; what is stated behind a sign, or has its
/// unit there, is none.
#[test]
fn formulas_of_other_columns_are_no_readings() {
    for text in ["e = √(h1/h0)", "e = racine(h rebond / h chute)", "v = g*t (m/s)"] {
        assert!(Heading::parse(text).turns(), "{text}");
    }
    for text in ["h = 64/2", "h (cm) = height", "v = speed (m/s)", "rebound height (cm)"] {
        assert!(!Heading::parse(text).turns(), "{text}");
    }
}

/// A name that ends as those of balls do is one, and vowels may be spelt out.
#[test]
fn names_of_balls_and_vowels_that_are_spelt_out() {
    for text in ["hockeybal", "Wasserball", "skumboll"] {
        let heading = Heading::parse(text);
        assert!(heading.unknown.is_empty() && heading.has(Atom::Label), "{text}");
    }
    for text in ["global", "verbal", "xball"] {
        assert!(!Heading::parse(text).has(Atom::Label), "{text}");
    }
    let (spelt, marked) = (Heading::parse("Ruecksprunghoehe (cm)"), Heading::parse("Rücksprunghöhe (cm)"));
    assert!(spelt.understood() && spelt.has(Atom::Rebound) && marked.has(Atom::Rebound));
}
