//! Words of planned measurements.

use crate::report::plan::{Planned, Way};

/// How a measurement is made.
pub(in crate::report) fn way(way: Way) -> &'static str {
    match way {
        Way::Ruler => "heights by eye beside a ruler, to 1 cm",
        Way::FilmedRuler => "heights off a film beside a ruler, to 3 mm",
        Way::Film30 => "contacts off a film, 30 frames/s",
        Way::Film60 => "contacts off a film, 60 frames/s",
        Way::Film120 => "contacts off a film, 120 frames/s",
        Way::Film240 => "contacts off a film, 240 frames/s",
        Way::Sound => "contacts off a sound recording, to 1 ms",
    }
}

/// What a measurement brings.
pub(in crate::report) fn brings(planned: &Planned) -> String {
    let Planned { drops, bounces, half_width, .. } = planned;
    let drops = if *drops == 1 { "one drop".to_owned() } else { format!("{drops} drops") };
    let each = if *bounces == 1 { "one bounce".to_owned() } else { format!("{bounces} bounces") };
    format!("{drops} of {each}, {}: ± {half_width:.4}", way(planned.way))
}

/// What a plan supposes.
pub(in crate::report) fn every_bounce() -> &'static str {
    "By the errors of reading alone: drops that differ, or a COR that depends on speed, need more, and show in the table that you measure."
}
