//! The ball that a table names beside its readings, in a title, a comment or its file's name.

use super::heading::Heading;
use super::region::Region;
use super::said::texts;
use super::vocabulary::Atom;
use super::words::{Kind, Word, split};
use super::{Table, Trial};
use crate::quantity::Ball;

/// The ball that a text names: `Basketball dropped in the gym`, `old tennis balls`, but not `tennis
/// court`, `basketball court` or `mini basketball`.
fn named(text: &str) -> Vec<Ball> {
    let words = split(text);
    // What stands before a ball may say how large it is; what follows it, whether it is one.
    let usual = |w: &Word| !matches!(w.kind, Kind::Unknown);
    let alone = |from: usize, to: usize| {
        let place = |w: &Word| w.is(Atom::Floor) || w.is(Atom::Group) && !w.is(Atom::Label);
        (from == 0 || usual(&words[from - 1])) && words.get(to).is_none_or(|w| usual(w) && !place(w))
    };
    let spelt = |from: usize, to: usize| {
        let name = words[from..to].iter().map(|w| w.text.as_str()).collect::<Vec<_>>().join(" ");
        let lower = name.to_lowercase();
        let ball = lower.ends_with("ball") || lower.ends_with("balls");
        Ball::named(lower.strip_suffix('s').unwrap_or(&lower)).filter(|_| ball)
    };
    // The longest name, from each word on: `table tennis ball`.
    let found = |from: usize| {
        let ends = (from + 1..=words.len().min(from + 3)).rev();
        ends.filter(|&to| alone(from, to)).find_map(|to| Some((spelt(from, to)?, to)))
    };
    let (mut balls, mut from) = (Vec::new(), 0);
    while from < words.len() {
        let named = found(from);
        from = named.map_or(from + 1, |(_, to)| to);
        balls.extend(named.map(|(ball, _)| ball));
    }
    balls
}

/// Trials that tell no balls apart are of the one ball that the table names, where it names one.
pub(super) fn of_one_ball(region: &Region<'_>, table: &mut Table) {
    let untold = |trial: &Trial| trial.ball.is_none() && Heading::parse(&trial.group).labels().is_empty();
    if !table.trials.iter().all(untold) {
        return;
    }
    let mut balls = texts(region).flat_map(named);
    let Some(ball) = balls.next() else { return };
    if balls.all(|other| other == ball) {
        table.trials.iter_mut().for_each(|trial| trial.ball = Some(ball));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_names_a_ball() {
        for (text, ball) in [
            ("Basketball dropped in the gym", Ball::Basketball),
            ("mass: basketball (0.62 kg)", Ball::Basketball),
            ("Table tennis ball on glass", Ball::TableTennis),
            ("used tennis balls", Ball::Tennis),
            ("Golfball auf Stein", Ball::Golf),
            ("2 squash balls", Ball::Squash),
        ] {
            assert_eq!(named(text), [ball], "{text}");
        }
        for text in ["tennis court", "basketball court", "mini basketball", "golf club", "rubber ball"] {
            assert!(named(text).is_empty(), "{text}");
        }
    }
}
