//! Whether the lengths in a text are of heights or of the size of a ball.

use super::clause::{clauses, lengths, measures, names_ball};
use super::named::names_floor;
use super::phrases::Phrase;
use super::vocabulary::{Atom, folded};
use super::words::split;
use crate::quantity::Ball;

/// Whether a text states a length and speaks of heights, places or the floor: `the floor is at the
/// 12 cm mark`.
pub(super) fn states_length(text: &str) -> bool {
    let of_heights = |text: &str| {
        let of = [Atom::Height, Atom::Position, Atom::Distance, Atom::Release];
        split(text).iter().any(|w| of.iter().any(|atom| w.is(*atom)))
    };
    // What a floor is, beside how large the ball is, places neither: `ball 27 mm, floor: granite`.
    clauses(text).any(|part| measures(part) && !of_size(part))
        && (of_heights(text) || clauses(text).any(|part| measures(part) && names_floor(part)))
}

/// Whether a clause is of the size of a ball: it begins with it, `d = 63 mm`, `diameter 6.7 cm`, or
/// names a ball and a length that balls have, and speaks of no height: `marble 16 mm`.
fn of_size(clause: &str) -> bool {
    let first = clause.trim_start().split([' ', '=', ':']).next().map(folded).unwrap_or_default();
    let words = split(clause);
    let of = [Atom::Height, Atom::Position, Atom::Distance, Atom::Release, Atom::Rebound, Atom::Floor];
    let small = |length: &f64| Ball::ALL.iter().any(|ball| *length <= ball.diameter());
    Phrase::Diameter.is(&first)
        || Phrase::Radius.is(&first)
        || matches!(&*first, "d" | "ø")
        || words.iter().any(|w| w.is(Atom::Label) || names_ball(w))
            && !words.iter().any(|w| of.iter().any(|atom| w.is(*atom)))
            && lengths(clause).iter().all(small)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_length_that_is_said_of_heights_is_not_passed_over() {
        for (text, states) in [
            ("Heights measured to the top of the ball (diameter 6.7 cm)", true),
            ("The floor is at the 12 cm mark of the tape", true),
            ("Distance from the ceiling; floor is at 240cm", true),
            ("Tennis ball, diameter 6.7 cm, mass 58 g", false),
            ("Lacrosse ball, d = 63 mm, heights to the bottom of the ball", false),
            ("Table 3: bounce heights of 2 balls", false),
            ("Bounce heights, class 7b", false),
            ("Rebound height (cm) on three floors. Marble 16 mm.", false),
            ("Ball: 27 mm bouncy ball, 5 drops from each height", false),
            ("Rebound of a ball held 27 mm above the floor", true),
            ("The heights of the ball are those on a 90 cm shelf", true),
        ] {
            assert_eq!(states_length(text), states, "{text}");
        }
    }
}
