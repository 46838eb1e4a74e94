//! What speaks for and against the COR.

use super::chance;
use super::models::gives;
use super::names::about;
use crate::finding::{Air, Basis, By, Finding, FindingKind};
use crate::quantity::{Readings, Source};
use crate::report::numbers::{duration, length, measured};

pub(super) fn words(finding: &Finding) -> Option<String> {
    one_kind(&finding.kind)
        .or_else(|| changing(&finding.kind))
        .or_else(|| whole(finding))
        .or_else(|| recordings(&finding.kind))
}

/// Of one kind of reading.
fn one_kind(kind: &FindingKind) -> Option<String> {
    Some(match kind {
        FindingKind::Grows { readings, surely: true } => {
            format!("the {readings} grow from bounce to bounce, as if each bounce added energy")
        }
        FindingKind::Grows { readings, surely: false } => {
            format!(
                "within its error the COR of the {readings} is not below 1: they do not shrink from bounce to bounce"
            )
        }
        FindingKind::Unbounded { readings, cor } => {
            let between = if *readings == Readings::Times { " (times between contacts are 'interval_s')" } else { "" };
            format!(
                "without the bound COR <= 1 the {readings} give {cor:.3}: are the readings in order, in the right column{between} and unit, \
                 or was energy put in?"
            )
        }
        FindingKind::JustEnough { readings } => {
            format!("the {readings} are just enough for a COR: nothing is left to check it by")
        }
        FindingKind::SpreadDecides { readings, times } => format!(
            "the {readings} scatter {times:.1} times more than their reading errors; the error of the COR is taken from the spread between trials"
        ),
        FindingKind::Misfit { readings, chi_square, degrees_of_freedom } => {
            format!("one COR does not fit the {readings} (chi-square {chi_square:.0} on {degrees_of_freedom})")
        }
        FindingKind::Widened { times } => {
            format!("the error of the COR was widened {times:.1} times, the excess of the scatter")
        }
        FindingKind::ErrorsTooLarge { readings, times } => format!(
            "the {readings} scatter {times:.2} times as much as their reading errors say: those are probably too large"
        ),
        FindingKind::BallNamed { ball, air: true } => format!(
            "the table names the ball, {ball}, and its air shows: its drag ({:.3} /m) and its size ({}) by the rules of its sport are taken, as --ball does",
            ball.drag(),
            length(ball.diameter())
        ),
        FindingKind::BallNamed { ball, air: false } => format!(
            "the table names the ball, {ball}: the interval allows for its size ({}) and its drag ({:.3} /m) by the rules of its sport; --ball {ball} takes \
             the air out of the COR",
            length(ball.diameter()),
            ball.drag()
        ),
        FindingKind::ReadOtherwise { cor, flights, instead_of } => format!(
            "the contacts can be read in another way about as well: as {flights} flights instead of {instead_of}, or other ones, which gives {cor:.3}; count \
             the bounces again, or leave out what is none"
        ),
        FindingKind::Lossless { readings } => format!(
            "the {readings} hardly shrink, as if no bounce lost anything: they are those of something else, or in another unit"
        ),
        FindingKind::Loud { readings, part } => format!(
            "the {readings} scatter about the bounces of any one COR by {:.0} % of the largest: hardly a bounce can be made out",
            100.0 * part
        ),
        FindingKind::Unmoved { low_m, high_m, rebound_m } => format!(
            "the rebounds do not follow the heights of release: from {} as from {} they are about {}, as where a sensor is stuck or the column is of \
             something else",
            length(*low_m),
            length(*high_m),
            length(*rebound_m)
        ),
        _ => return None,
    })
}

/// Of a COR that is not the same throughout.
fn changing(kind: &FindingKind) -> Option<String> {
    Some(match kind {
        FindingKind::SettingsDiffer { readings, low, high, p } => format!(
            "the COR by {readings} is not the same throughout: {:.3} for {}, {:.3} for {} (by chance: p {})",
            low.1,
            low.0,
            high.1,
            high.0,
            chance(*p)
        ),
        FindingKind::MeanOfSettings => {
            "one COR for different balls, floors or drop heights is a mean of them: fit each by itself (--filter)"
                .to_owned()
        }
        FindingKind::AsideDiffers { column, low, high, p } => format!(
            "the COR differs by '{column}', which tells no groups apart here: {:.3} for {}, {:.3} for {} (by chance: p {}); give --group '{column}' if it tells \
             balls or surfaces apart, --group - if not",
            low.1,
            low.0,
            high.1,
            high.0,
            chance(*p)
        ),
        FindingKind::OrderDrift { first, last, p } => format!(
            "the COR changes from trial to trial in the order of the table, from {first:.3} to {last:.3} (by chance: p {}): one COR is a mean \
             of that; did the ball warm up, lose air or wear out?",
            chance(*p)
        ),
        FindingKind::DropsDiffer { spread, drops } => format!(
            "the COR differs from drop to drop by {spread:.3} (standard deviation of {drops} drops), more than the reading errors explain: \
             this spread sets the error; it belongs to the ball, the floor or the way of dropping"
        ),
        FindingKind::BouncesScatter { readings, scatter, sigma } => {
            let varies = format!(
                "the bounces themselves scatter: the COR varies by {:.1} % from bounce to bounce, and the error of the COR allows for it",
                100.0 * scatter
            );
            let error = duration(sigma.value);
            match sigma.source {
                Source::Scatter | Source::Assumed => format!(
                    "{varies}; nobody stated how well the {readings} were read: if to {error} only, say so (--sigma-time {}), and it is the \
                     readings that are taken to scatter",
                    error.replace(' ', "")
                ),
                _ => format!("{varies}; readings good to {error} do not explain it"),
            }
        }
        FindingKind::Trend { p } => {
            format!("the COR changes from bounce to bounce (a trend as strong by chance: p {})", chance(*p))
        }
        FindingKind::TrendCauses => {
            "about the trend: it may come from a COR that depends on speed, from air drag, or from a wrong \
             zero of the height scale"
                .to_owned()
        }
        _ => return None,
    })
}

/// Of the table as a whole.
fn whole(finding: &Finding) -> Option<String> {
    Some(match &finding.kind {
        FindingKind::SigmaAssumed { heights, times } => {
            let heights = heights.then_some("1 cm for heights (--sigma-height)");
            let times = times.then_some("10 ms for times (--sigma-time)");
            let what: Vec<&str> = heights.into_iter().chain(times).collect();
            format!("nobody stated the reading errors; assumed {}", what.join(" and "))
        }
        FindingKind::Disagree => "heights and times do not agree on one COR".to_owned(),
        FindingKind::Adrift { read, adrift } => format!(
            "of {read} times {adrift} do not follow from the others, which then may do so by chance: cut the table to the bounces, or measure again"
        ),
        FindingKind::FewFollow { read, used } => format!(
            "of {read} times only {used} follow from each other, which may be chance: cut the table to the bounces, or measure again"
        ),
        FindingKind::ZeroTooHigh { height_m } => format!(
            "a rebound was read as zero (bounce {}) that should be {:.1} cm high: leave its cell empty if it was not read",
            finding.at.bounce.unwrap_or(0),
            100.0 * height_m
        ),
        FindingKind::MethodsDiffer { first, first_cor, second, second_cor } => {
            format!("{} give {first_cor:.3} and {} give {second_cor:.3}", by(*first), by(*second))
        }
        FindingKind::FirstFlightDiffers { cor } => format!(
            "the first flight and the release height give {cor:.3}: the release height, gravity or the first bounce is not what it is taken \
             for (this value is shown, not used)"
        ),
        FindingKind::StatedDiffers { stated, cor } => format!(
            "the table itself works out a COR of {stated:.3}, and its readings give {cor:.3}: were they read as they are meant? (the notes say how)"
        ),
        FindingKind::Vague { low, high } => {
            format!("the COR is hardly known: from {low:.2} to {high:.2}; are the units and the reading errors right?")
        }
        FindingKind::FirstFlightAlone => {
            "one flight and the release height give a COR, but nothing checks it".to_owned()
        }
        FindingKind::NoReboundRead { high } => {
            format!("no rebound was high enough to be read: the COR is at most {high:.2} (95 %)")
        }
        FindingKind::OneHeight => {
            "a COR needs the height before and after a bounce, and there is one height at most (from which height was the ball dropped? --drop 1m)"
                .to_owned()
        }
        FindingKind::OneContact => "a COR needs two flights to compare, and there is one contact only".to_owned(),
        FindingKind::OneFlight => {
            "two contacts are one flight; a COR needs three contacts, or the release height beside the two".to_owned()
        }
        FindingKind::Undetermined => {
            "the readings do not determine a COR (are they all taken at the same bounce?)".to_owned()
        }
        FindingKind::ExplanationsThinned { every } => {
            format!("what could explain it was tried on one trial in {every}")
        }
        FindingKind::NoBootstrap { trials } => {
            format!("no bootstrap: it draws whole trials, and needs at least five (here {trials})")
        }
        FindingKind::RestsOn { basis } => rests_on(basis),
        _ => return None,
    })
}

fn by(by: By) -> String {
    match (by.readings, by.trials) {
        (Some(readings), None) => readings.to_string(),
        (Some(readings), Some(trials)) => format!("{readings} of {trials} trials"),
        (None, Some(trials)) => format!("heights with times, read of {trials},"),
        (None, None) => "heights with times".to_owned(),
    }
}

fn rests_on(basis: &Basis) -> String {
    match basis {
        Basis::One { readings } => format!("one COR fits the {readings}"),
        Basis::Both => "heights and times agree on one COR".to_owned(),
        Basis::BothInSome { both, trials } => {
            format!("heights and times agree on one COR, in {both} of {trials} trials")
        }
        Basis::BothInEach => {
            "heights and times agree in every drop; the COR is the mean over drops that differ".to_owned()
        }
        Basis::Mean => "the COR is the mean over drops that differ by more than their readings".to_owned(),
        Basis::Recordings { recordings, air, contact_s } => {
            let air = match air {
                Air::None => "",
                Air::Drag => ", with air drag",
                Air::DragOrSpeed => {
                    ", with air drag or with a COR that depends on speed: the samples cannot tell which"
                }
            };
            let lasts = contact_s.map_or_else(String::new, |lasts| {
                let lasts = measured(1e3 * lasts.value, 1e3 * lasts.standard_error);
                format!(", with impacts that last {lasts} ms")
            });
            match recordings {
                1 => format!("one motion fits the series{air}{lasts}"),
                n => format!("one COR fits {n} series{air}{lasts}"),
            }
        }
        Basis::Model { model, gives: found } => {
            let middle = match found {
                crate::finding::Gives::Range(_) => {
                    format!(": {}; the COR here is that at the middle speed", gives(found))
                }
                crate::finding::Gives::One(_) => String::new(),
            };
            format!("{} fits{middle}", about(*model, None))
        }
    }
}

/// Of recordings.
fn recordings(kind: &FindingKind) -> Option<String> {
    Some(match kind {
        FindingKind::ImpactsDiffer { low, high } => {
            format!("the COR is not the same at every impact: from {low:.3} to {high:.3} (see the impacts)")
        }
        FindingKind::DroppedAgain { time_s } => format!(
            "after the last bounce the ball is dropped again, and meets the floor at {time_s:.2} s, with another COR, or for too short a time to tell: \
             give each drop a file, or a column that numbers them"
        ),
        FindingKind::Drops { drops } => format!("{drops} drops of one recording are fitted, each by itself"),
        FindingKind::Rough { rms, noise } => {
            format!("the motion does not follow the samples: it leaves {rms:.2e} where they scatter by {noise:.2e}")
        }
        FindingKind::Soft { contact_s, fall_s } => format!(
            "the motion turns at the floor within {contact_s:.2} s, where the fall takes {fall_s:.2} s: that is no impact, but what a swing or a spring does"
        ),
        FindingKind::FloorDrifts { part_per_second } => format!(
            "the floor drifts by {:.1} % of the drop a second, as if the camera turned; the fit allows for it",
            100.0 * part_per_second
        ),
        FindingKind::AnotherBody { samples } => format!(
            "{samples} samples that are no part of the motion are of flights themselves: two bodies were tracked in turn; track one of them alone"
        ),
        FindingKind::OtherMotion { from_s, to_s } => format!(
            "from t = {from_s:.2} to {to_s:.2} s the ball bounces too, but not in the motion that is fitted: it was hit, or two films are joined; \
             give one motion alone"
        ),
        FindingKind::ManyWild { wild, samples } => {
            format!("{wild} of {samples} samples are outliers: look at the tracking")
        }
        FindingKind::GravityOff { gravity, expected, pixels } => {
            let (unit, why) = if *pixels {
                ("px", "heights are in pixels (--scale says how large one is)")
            } else {
                ("units", "heights are in another unit, or the frame rate is another")
            };
            let gravity = if gravity.abs() < 100.0 { format!("{gravity:.2}") } else { format!("{gravity:.0}") };
            format!(
                "the recording's gravity is {gravity} {unit}/s\u{b2}, not {expected} m/s\u{b2}: {why}. The COR does not depend on it; speeds, drag \
                 and heights do"
            )
        }
        FindingKind::AirShows { drag } => format!(
            "the air shows in the times: flights that shrink less and less, as with a drag of {:.3} ± {:.3} /m; the COR is that of the contacts alone",
            drag.value, drag.standard_error
        ),
        FindingKind::DragHeld { drag_per_m } => format!("the readings are taken without the air, whose drag is stated: k = {drag_per_m:.3} /m"),
        FindingKind::KeepsAll => {
            "the ball keeps more of its speed than any ball does: what was tracked is no free flight, or the picture is bent".to_owned()
        }
        FindingKind::DragUnheld { drag_per_m, cor_with } => format!(
            "the flights ask for more drag than an ordinary ball has (k = {drag_per_m:.2} /m, and then a COR of {cor_with:.3}), but one bounce does not \
             tell air drag from a bent picture: state the drag of the ball, or film a second bounce"
        ),
        FindingKind::DragUnphysical { drag_per_m } => format!(
            "the drag that fits, k = {drag_per_m:.2} /m, is that of no ball: the picture is bent, or the ball did not fall freely"
        ),
        FindingKind::GravitiesDiffer { low, high } => format!(
            "gravity is {low:.0} px/s\u{b2} in one film and {high:.0} in another: the camera was moved, or frames are missing; fit each by itself, \
             or film a rule beside the ball (--scale)"
        ),
        FindingKind::GravityUndetermined => {
            "the samples do not determine the motion: its gravity may be anything up to twice as large or nothing".to_owned()
        }
        FindingKind::GainsSpeed => "the ball gains speed at its impacts, as if each added energy".to_owned(),
        FindingKind::OneRecording => {
            "one recording: its error is that of the fit; another drop of the same ball may differ by more".to_owned()
        }
        _ => return None,
    })
}
