//! What methods, losses, models and explanations are called.

use crate::compare::explain::Hypothesis;
use crate::finding::Missing;
use crate::quantity::{CorModel, Explanation, Loss, Method};

/// What was done, for people.
pub(in crate::report) fn method_about(method: Method) -> &'static str {
    match method {
        Method::Heights | Method::HeightsUnbounded => {
            "rebound heights, least squares with an unknown release height in every trial"
        }
        Method::HeightsMean => "geometric mean over the bounces, from the first and the last height",
        Method::HeightsRatio => {
            "neighbouring heights as they are, a rebound of zero among them; too low by about (reading error/height)\u{b2}"
        }
        Method::Times | Method::TimesUnbounded => {
            "contact times, least squares on the times themselves; needs neither gravity nor heights"
        }
        Method::TimesMean => "geometric mean over the bounces, from the fall and the last flight; needs gravity",
        Method::FirstFlight => "first flight over twice the fall from the release height; needs gravity",
        Method::Joint => "heights and times together under free flight with one COR, the release height taken as set",
        Method::Series => {
            "the whole motion through every sample, without air drag; gravity, scale and floor are fitted"
        }
        Method::SeriesDrag => {
            "the whole motion through every sample, with quadratic air drag; gravity, scale and floor are fitted"
        }
        Method::HeightsHuber | Method::TimesHuber => "Huber's loss: outliers count less",
        Method::HeightsAbsolute | Method::TimesAbsolute => "the least sum of absolute residuals",
        Method::HeightsLargest | Method::TimesLargest => "the least largest residual",
    }
}

/// The name of a method in a row of the report.
pub(in crate::report) fn method_short(method: Method) -> String {
    if let Some((readings, loss)) = method.loss() {
        return format!("{readings}, {}", loss_words(loss));
    }
    match method {
        Method::Joint => "heights and times",
        Method::FirstFlight => "drop height, first flight",
        Method::HeightsUnbounded => "heights, COR > 1 allowed",
        Method::TimesUnbounded => "times, COR > 1 allowed",
        other => other.name(),
    }
    .to_owned()
}

/// What a loss makes small.
pub(in crate::report) fn loss_words(loss: Loss) -> &'static str {
    match loss {
        Loss::Huber => "Huber's loss",
        Loss::Absolute => "the sum of |r|",
        Loss::Largest => "the largest |r|",
    }
}

/// What a model supposes.
pub(in crate::report) fn about(model: CorModel, missing: Option<Missing>) -> String {
    if let (CorModel::Missed, Some(place)) = (model, missing) {
        return format!("one COR, a rebound is missing {}", before(place));
    }
    match model {
        CorModel::Constant => "one COR",
        CorModel::Linear => "a COR linear in the speed of impact",
        CorModel::Viscoelastic => "the COR of a viscoelastic sphere",
        CorModel::Plastic => "a COR that falls as v^(-1/4), plastic",
        CorModel::Power => "a COR that falls as a power of speed",
        CorModel::Knots => "a COR that falls with speed, by knots",
        CorModel::Each => "a COR for every bounce",
        CorModel::Offset => "one COR and a wrong zero of the height scale",
        CorModel::Rebounds => "one COR, rebounds read higher than the release",
        CorModel::Drag => "one COR and air drag",
        CorModel::Contact => "one COR and contacts that take time",
        CorModel::Missed => "one COR, a rebound is missing",
        CorModel::ConstantDrag => "one COR, air drag",
        CorModel::LinearDrag => "a COR linear in the speed of impact, air drag",
        CorModel::EachDrag => "a COR for every bounce, air drag",
    }
    .to_owned()
}

/// The place of a rebound that is not in the table.
pub(super) fn before(place: Missing) -> String {
    let of = place.trial.map_or_else(String::new, |trial| format!(" in trial {}", trial + 1));
    format!("before number {}{of}", place.before)
}

/// What an explanation is called where it does not explain anything.
pub(in crate::report) fn short(name: Explanation) -> &'static str {
    match name {
        Explanation::HeightZero => "a wrong zero of the height scale",
        Explanation::CorPerBounce => "a COR of its own for every bounce",
        Explanation::ClockLag => "a late or early clock",
        Explanation::AirDrag => "air drag",
        Explanation::CorOfSpeed => "a COR that depends on speed",
        Explanation::MissedContact => "an overlooked contact",
    }
}

/// What an explanation supposes; `both` where heights and times disagree.
pub(in crate::report) fn supposes(hypothesis: &Hypothesis, both: bool) -> String {
    match hypothesis.name {
        Explanation::HeightZero if both => {
            "the zero of the height scale is off: heights were read at the wrong point of the ball, or from a line that is not the floor"
        }
        Explanation::HeightZero => {
            "the zero of the height scale is off; from heights alone a COR that changes with speed looks alike"
        }
        Explanation::CorPerBounce => "every bounce has a COR of its own",
        Explanation::ClockLag => "the clock was not at its noted time when the ball was let go",
        Explanation::AirDrag => "air drag slows the ball",
        Explanation::CorOfSpeed => "the COR depends on the speed of impact",
        Explanation::MissedContact => {
            return match hypothesis.overlooked_after {
                Some(after @ 1..) => format!("a contact was overlooked after contact {after}"),
                _ => "a contact was overlooked before the first one noted".to_owned(),
            };
        }
    }
    .to_owned()
}

/// What to measure to find out.
pub(in crate::report) fn settles(name: Explanation) -> &'static str {
    match name {
        Explanation::HeightZero => "lay the ball on the floor and read its height on the same scale, the same way",
        Explanation::CorPerBounce => {
            "repeat the drop from other heights: the COR must depend on the speed in the same way each time"
        }
        Explanation::ClockLag => "film the release itself and count the frames from it",
        Explanation::AirDrag => {
            "weigh the ball and measure its diameter: k = 0.28 kg/m\u{b3} x cross-section / mass, or drop a heavier one"
        }
        Explanation::CorOfSpeed => "repeat the drop from other heights: equal speeds must give equal CORs",
        Explanation::MissedContact => "listen to the recording, or step through the film, around that time",
    }
}
