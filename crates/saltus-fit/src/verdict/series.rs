//! What the recordings amount to, and what speaks against it.

use super::judgement::{Cor, Judgement, LEVEL, NAMED, SAME};
use crate::elementary::hypot;
use crate::finding::{Air, Basis, Finding, FindingKind, Severity, Widening};
use crate::model::{LOSSLESS, Law, ORDINARY_DRAG, PHYSICAL_DRAG};
use crate::quantity::{Measured, Method, Sourced};
use crate::solve::choice::{ModelChoice, of_recording};
use crate::solve::estimate::Estimate;
use crate::solve::series::{Choice, Pooled, Series, Track, Unseen, in_metres};
use crate::solve::spread::across;
use crate::statistics::{CLEAR, NORMAL, SURELY};

/// A single impact is taken to last up to this, in seconds, as that of a squash ball does.
const LASTS: f64 = 0.01;
/// A motion that leaves this many times the noise does not follow the samples.
const ROUGH: f64 = 6.0;
/// An impact that lasts this part of the fall is none: balls stay on the floor for 5 to 20 ms, and
/// fall for 100 ms from 5 cm.
const SOFT: f64 = 0.2;
/// Gravity that differs from film to film by this factor is that of another scale or clock: a
/// camera that stands still keeps it to a hundredth or two.
const MOVED: f64 = 1.05;

/// Judges the fit of all recordings; fills the estimates and the models of the report.
pub(crate) fn judge(
    judgement: &mut Judgement,
    series: &Series,
    (gravity, pixels): (Sourced, bool),
) -> (Vec<Estimate>, Vec<ModelChoice>) {
    judgement.findings.extend(series.repairs.iter().cloned());
    if let Some(down) = series.falls_upwards {
        judgement.doubt(FindingKind::FallsUpwards { down });
    }
    let Some(pooled) = &series.pooled else {
        judgement.findings.extend(series.refused.iter().cloned());
        if series.refused.is_empty() {
            judgement.refuse(FindingKind::NoSamples);
        }
        return (Vec::new(), Vec::new());
    };
    // What one recording does not show, others do.
    judgement.findings.extend(series.refused.iter().map(|f| Finding { severity: Severity::Note, ..f.clone() }));
    let estimates = estimates(judgement, series, pooled);
    judgement.cor = estimates.first().and_then(Cor::of);
    allow(judgement, &series.tracks, pooled);
    let models = rivals(judgement, pooled);
    let contact = contact_time(&series.tracks);
    if let Some((other, tracks, worse)) = &series.otherwise {
        impact_time(judgement, pooled, (other, tracks, *worse), contact);
    }
    single_impact(judgement, series, pooled);
    any_ball(judgement, &series.tracks, pooled);
    varying(judgement, pooled);
    roughness(judgement, series);
    dropped_again(judgement, &series.tracks);
    gravity_off(judgement, &series.tracks, (gravity.value, pixels));
    physical(judgement, &series.tracks, pooled);
    if series.falls_upwards.is_none() {
        determined(judgement, &series.tracks);
    }
    if series.tracks.len() == 1 {
        judgement.note(FindingKind::OneRecording);
    }
    let air = match (pooled.choice.1, cause_is_open(pooled)) {
        (_, true) => Air::DragOrSpeed,
        (true, false) => Air::Drag,
        (false, false) => Air::None,
    };
    let recordings = series.tracks.len();
    judgement.note(FindingKind::RestsOn { basis: Basis::Recordings { recordings, air, contact_s: contact } });
    (estimates, models)
}

/// The COR with drag and without, that of the chosen model first.
fn estimates(judgement: &mut Judgement, series: &Series, pooled: &Pooled) -> Vec<Estimate> {
    let drag = pooled.choice.1;
    let of = |drag: bool, cor: Measured| {
        let method = if drag { Method::SeriesDrag } else { Method::Series };
        let trials = series.tracks.len();
        Estimate { trials, ..Estimate::new(method, cor.value, cor.standard_error, pooled.quantile) }
    };
    let mut list = vec![of(drag, pooled.cor)];
    if let Some(&(_, cor, worse)) = pooled.rivals.iter().find(|r| r.0.1 != drag) {
        list.push(of(!drag, cor));
        if drag && worse >= CLEAR {
            judgement.note(FindingKind::DragNeeded { bic: worse, cor_without: cor.value });
        }
    }
    list
}

/// Whether a COR differs from another by more than both errors and by more than matters.
fn differs(a: Measured, b: Measured) -> bool {
    let apart = (a.value - b.value).abs();
    apart > 2.0 * hypot(a.standard_error, b.standard_error) && apart > SAME
}

/// What a rival that fits as well means: the interval takes it in, which is no answer where it is
/// far outside.
fn severity(judgement: &Judgement, rival: Measured, chosen: Measured) -> Severity {
    let apart = (rival.value - chosen.value).abs();
    if judgement.outside(rival.value) && apart > LEVEL { Severity::Doubt } else { Severity::Note }
}

/// The models beside the chosen one: where one fits as well with another COR, the interval takes in
/// both.
fn rivals(judgement: &mut Judgement, pooled: &Pooled) -> Vec<ModelChoice> {
    let name = |choice: Choice| of_recording(choice.0, choice.1);
    let mut models = Vec::new();
    for &(choice, cor, worse) in &pooled.rivals {
        let chosen = choice == pooled.choice;
        models.push(ModelChoice { chosen, ..ModelChoice::new(name(choice), cor, worse) });
        if worse < CLEAR && differs(cor, pooled.cor) {
            let kind = FindingKind::ModelsAlike {
                bic: worse,
                model: name(pooled.choice),
                cor: pooled.cor.value,
                other: name(choice),
                other_cor: cor.value,
            };
            judgement.findings.push(Finding::new(severity(judgement, cor, pooled.cor), kind));
            let reach = pooled.quantile * cor.standard_error;
            judgement.reach(cor.value - reach, cor.value + reach, Widening::BothModels);
        }
    }
    models
}

/// Impacts that take time beside such that take none.
fn impact_time(
    judgement: &mut Judgement,
    pooled: &Pooled,
    (other, tracks, worse): (&Pooled, &[Track], f64),
    contact: Option<Measured>,
) {
    let (was, is) = (other.cor, pooled.cor);
    if let Some(contact_s) = contact {
        judgement.note(FindingKind::ContactShows { contact_s, bic: worse, cor_without: was.value });
    }
    if worse >= CLEAR {
        return;
    }
    if differs(was, is) {
        let (instant, lasting) = if contact.is_some() { (was, is) } else { (is, was) };
        let (cor_instant, cor_lasting) = (instant.value, lasting.value);
        let kind = FindingKind::ContactOpen { bic: worse, cor_instant, cor_lasting };
        judgement.findings.push(Finding::new(severity(judgement, was, is), kind));
    }
    // Every impact takes some time.
    let allowed = Allowed::of(tracks, other);
    judgement.reach(allowed.low, allowed.high, Widening::ImpactTime);
}

/// One impact does not show how long it lasts, and a ball that stayed on the floor would look as if
/// its COR were higher.
fn single_impact(judgement: &mut Judgement, series: &Series, pooled: &Pooled) {
    let Some(cor) = judgement.cor.filter(|_| series.tracks.iter().all(|track| track.impacts.len() == 1)) else {
        return;
    };
    let higher =
        |track: &Track| (1.0 - pooled.cor.value).max(0.0) * track.gravity.value * LASTS / track.impacts[0].speed;
    let lower = series.tracks.iter().map(higher).fold(0.0, f64::max);
    if lower > 0.1 * pooled.cor.standard_error {
        judgement.reach(cor.low - lower, cor.high, Widening::SingleImpact { contact_s: LASTS, lower });
    }
}

/// One impact does not show drag and COR both: the interval reaches out to the COR with the most
/// drag that all samples allow.
fn any_ball(judgement: &mut Judgement, tracks: &[Track], pooled: &Pooled) {
    let light: Option<Vec<(f64, f64)>> = tracks.iter().map(|track| track.unseen?.light).collect();
    let Some((most_per_m, share)) = light.and_then(|all| all.into_iter().min_by(|a, b| a.0.total_cmp(&b.0))) else {
        return;
    };
    let high = pooled.cor.value + share + pooled.quantile * pooled.cor.standard_error;
    if let Some(cor) = judgement.cor.filter(|cor| high > cor.high) {
        // In place of what each film by itself allows.
        judgement.widened.retain(|why| !matches!(why, Widening::Air { ball: None, .. }));
        judgement.reach(cor.low, high, Widening::Air { most_per_m, share, ball: None });
    }
}

/// The time of a contact, over all recordings that show one.
fn contact_time(tracks: &[Track]) -> Option<Measured> {
    let times: Vec<Measured> = tracks.iter().filter_map(|track| track.contact).collect();
    across(&times).map(|across| across.mean)
}

/// Whether air drag, and no drag but a COR that depends on speed, fit alike.
fn cause_is_open(pooled: &Pooled) -> bool {
    let one_of_two = |(law, drag): Choice| drag == (law == Law::Constant);
    let other =
        |rival: &(Choice, Measured, f64)| rival.0.1 != pooled.choice.1 && one_of_two(rival.0) && rival.2 < CLEAR;
    one_of_two(pooled.choice) && pooled.rivals.iter().any(other)
}

/// The interval of recordings under one model: the error of the COR, what the samples do not show
/// of air and lens, and a pattern in what is left.
struct Allowed {
    low: f64,
    high: f64,
    air: f64,
    lens: f64,
    misfit: f64,
}

impl Allowed {
    fn of(tracks: &[Track], pooled: &Pooled) -> Self {
        let count = tracks.len().max(1) as f64;
        let unseen: Vec<Unseen> = tracks.iter().filter_map(|track| track.unseen).collect();
        // Ball and camera are the same in all.
        let mean = |of: fn(&Unseen) -> f64| {
            if unseen.len() < tracks.len() { 0.0 } else { unseen.iter().map(of).sum::<f64>() / count }
        };
        let (shift, spread) = (mean(|u| u.shift.value), mean(|u| u.shift.standard_error));
        let share = |of: Measured| of.value + NORMAL.copysign(of.value) * of.standard_error;
        let misfit = (tracks.iter().map(|track| track.reach.powi(2)).sum::<f64>() / count).sqrt();
        let reach = hypot(pooled.quantile * hypot(pooled.cor.standard_error, spread), NORMAL * misfit);
        let part = |of: fn(&Unseen) -> Measured| {
            let shares = unseen.iter().map(|unseen| share(of(unseen)));
            shares.max_by(|a, b| a.abs().total_cmp(&b.abs())).unwrap_or(0.0)
        };
        let (low, high) = (pooled.cor.value + shift - reach, pooled.cor.value + shift + reach);
        Self { low, high, air: part(|u| u.air), lens: part(|u| u.lens), misfit }
    }
}

/// Widens the interval by what the samples do not show, and names what takes part in it.
fn allow(judgement: &mut Judgement, tracks: &[Track], pooled: &Pooled) {
    let allowed = Allowed::of(tracks, pooled);
    let Some(cor) = judgement.cor else { return };
    let Some(worst) = tracks.iter().max_by(|a, b| a.reach.total_cmp(&b.reach)) else { return };
    judgement.cor = Some(Cor { low: cor.low.min(allowed.low).max(0.0), high: cor.high.max(allowed.high), ..cor });
    let (rms, noise) = (worst.rms, worst.noise);
    let named = NAMED * 0.5 * (allowed.high - allowed.low);
    for (share, why) in [
        (allowed.air, Widening::Air { most_per_m: ORDINARY_DRAG, share: allowed.air, ball: None }),
        (allowed.lens, Widening::Lens { share: allowed.lens.abs() }),
        (allowed.misfit, Widening::Misfit { rms, noise, share: allowed.misfit }),
    ] {
        if share.abs() > named {
            judgement.widen(why);
        }
    }
}

/// Where the COR differs from impact to impact, the interval takes in that of each; where any two
/// are surely apart by more than what may be called one COR, there is none.
fn varying(judgement: &mut Judgement, pooled: &Pooled) {
    if pooled.choice.0 == Law::Constant {
        return;
    }
    let surely = |(less, more): (&Measured, &Measured)| {
        more.value - less.value - SURELY * hypot(less.standard_error, more.standard_error)
    };
    let pairs = pooled.impacts.iter().flat_map(|less| pooled.impacts.iter().map(move |more| (less, more)));
    let Some(apart) = pairs.max_by(|a, b| surely(*a).total_cmp(&surely(*b))) else { return };
    if surely(apart) > LEVEL {
        judgement.doubt(FindingKind::ImpactsDiffer { low: apart.0.value, high: apart.1.value });
    }
    if surely(apart) > 0.0 {
        let (less, more) = apart;
        let (low, high) = (less.value - 2.0 * less.standard_error, more.value + 2.0 * more.standard_error);
        judgement.reach(low, high, Widening::EveryImpact);
    }
}

fn roughness(judgement: &mut Judgement, series: &Series) {
    let range = |t: &Track| t.course.apexes.iter().map(|a| a.1).fold(0.0, f64::max);
    let soft = series.tracks.iter().find_map(|track| {
        let (contact_s, fall_s) = (track.contact?.value, (2.0 * range(track) / track.gravity.value).sqrt());
        (contact_s > SOFT * fall_s).then_some(FindingKind::Soft { contact_s, fall_s })
    });
    if let Some(soft) = soft {
        judgement.doubt(soft);
    }
    // What is left bends the motion, or may move the COR by more than what may be called one.
    let follows = |t: &Track| t.rms <= ROUGH * t.noise && t.reach <= LEVEL;
    let rough = |t: &&Track| !follows(t) && t.rms > 0.01 * range(t);
    if let Some(track) = series.tracks.iter().find(rough) {
        judgement.doubt(FindingKind::Rough { rms: track.rms, noise: track.noise });
    }
    for (track, drift) in series.tracks.iter().filter_map(|t| Some((t, t.drift?))) {
        let drifts = Finding::note(FindingKind::FloorDrifts { part_per_second: drift.value / range(track) });
        judgement.findings.push(drifts.at(track.place()));
    }
    let wild: usize = series.tracks.iter().map(|t| t.left_out[2]).sum();
    let all: usize = series.tracks.iter().map(|t| t.samples).sum();
    if wild * 20 > all {
        judgement.note(FindingKind::ManyWild { wild, samples: wild + all });
    }
}

/// Several drops of one recording are of one ball where their CORs agree.
fn dropped_again(judgement: &mut Judgement, tracks: &[Track]) {
    let cor = |track: &Track| track.models.first().map(|model| model.cor);
    let of_one = |pair: &&[Track]| pair[0].trial == pair[1].trial;
    let again: Vec<&[Track]> = tracks.windows(2).filter(of_one).collect();
    let other = |pair: &&&[Track]| cor(&pair[0]).zip(cor(&pair[1])).is_none_or(|(a, b)| differs(a, b));
    if let Some(pair) = again.iter().find(other) {
        let time_s = pair[1].impacts.first().map_or(0.0, |impact| impact.time);
        judgement.doubt(FindingKind::DroppedAgain { time_s });
    } else if !again.is_empty() {
        judgement.note(FindingKind::Drops { drops: again.len() + 1 });
    }
}

/// A motion whose gravity may be anything is none. (Of a ball that falls upwards the way that
/// heights count is to blame.)
fn determined(judgement: &mut Judgement, tracks: &[Track]) {
    if tracks.iter().any(|t| NORMAL * t.gravity.standard_error > t.gravity.value) {
        judgement.refuse(FindingKind::GravityUndetermined);
    }
}

/// Whether all that the COR rests on is determined and within physics.
fn physical(judgement: &mut Judgement, tracks: &[Track], pooled: &Pooled) {
    let e = pooled.cor;
    if e.value > LOSSLESS {
        let gains = e.value - NORMAL * e.standard_error > 1.0;
        judgement.doubt(if gains { FindingKind::GainsSpeed } else { FindingKind::KeepsAll });
    }
    judgement.doubt_if_vague();
    let free = || tracks.iter().filter_map(|track| track.free_drag);
    if pooled.choice.1 {
        let drag_per_m = free().map(|drag| drag.value).fold(0.0, f64::max);
        if drag_per_m > PHYSICAL_DRAG {
            judgement.doubt(FindingKind::DragUnphysical { drag_per_m });
        }
    } else if tracks.iter().all(|track| track.impacts.len() == 1)
        && let Some(drag) = free().find(|drag| drag.value - SURELY * drag.standard_error > ORDINARY_DRAG)
        && let Some((_, cor, _)) = pooled.rivals.iter().find(|rival| rival.0.1)
    {
        judgement.doubt(FindingKind::DragUnheld { drag_per_m: drag.value, cor_with: cor.value });
        let reach = pooled.quantile * cor.standard_error;
        judgement.reach(cor.value - reach, cor.value + reach, Widening::BothModels);
    }
}

/// Gravity is fitted, so it tells whether scale and clock are right; the COR depends on neither.
fn gravity_off(judgement: &mut Judgement, tracks: &[Track], (expected, pixels): (f64, bool)) {
    let gravity = tracks.iter().map(|t| t.gravity.value).sum::<f64>() / tracks.len() as f64;
    if !in_metres(gravity, expected) {
        judgement.note(FindingKind::GravityOff { gravity, expected, pixels });
    }
    let by = |a: &&Track, b: &&Track| a.gravity.value.total_cmp(&b.gravity.value);
    if let Some((least, most)) = tracks.iter().min_by(by).zip(tracks.iter().max_by(by)).filter(|_| pixels) {
        let (low, high) = (least.gravity, most.gravity);
        let surely = high.value - low.value > SURELY * hypot(high.standard_error, low.standard_error);
        if surely && high.value > MOVED * low.value {
            judgement.doubt(FindingKind::GravitiesDiffer { low: low.value, high: high.value });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drag_and_a_cor_of_speed_may_be_alike() {
        let cor = Measured { value: 0.8, standard_error: 0.01 };
        let open = |choice: Choice, other: Choice, worse: f64| {
            let rivals = vec![(choice, cor, 0.0), (other, cor, worse)];
            cause_is_open(&Pooled { choice, cor, quantile: 2.0, rivals, impacts: Vec::new() })
        };
        let (drag, linear, plain) = ((Law::Constant, true), (Law::Linear, false), (Law::Constant, false));
        assert!(open(drag, linear, 2.4) && open(linear, drag, 2.4) && open(drag, (Law::Each, false), 5.9));
        // Another model is out of the question, or supposes both or neither of them.
        assert!(!open(drag, linear, 6.1) && !open(plain, drag, 1.0) && !open(drag, plain, 1.0));
        assert!(!open(drag, (Law::Linear, true), 1.0) && !open(linear, (Law::Linear, true), 1.0));
    }
}
