//! What other models of the same readings mean for the COR and the verdict.

use super::judgement::{Cor, Judgement, LEVEL};
use crate::compare::rivals::Compared;
use crate::elementary::hypot;
use crate::finding::{Basis, Cause, Finding, FindingKind, Severity, Untried, Widening};
use crate::model::LIGHT_DRAG;
use crate::quantity::{CorModel, Measured, Readings, Source, Sourced};
use crate::solve::choice::{Misfit, ModelChoice};
use crate::solve::fits::Fits;
use crate::statistics::{CLEAR, NORMAL, REJECT, WEAK};

/// CORs that differ by less are the same for any purpose.
const SAME: f64 = 0.002;

/// Models that suppose the same kind of thing: the best of them speaks for all.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Speed,
    Drag,
    Offset,
    Rebounds,
    Contact,
    Missed,
    Each,
}

fn kind(model: &ModelChoice) -> Option<Kind> {
    match model.name {
        CorModel::Linear | CorModel::Viscoelastic | CorModel::Plastic | CorModel::Power | CorModel::Knots => {
            Some(Kind::Speed)
        }
        CorModel::Drag => Some(Kind::Drag),
        CorModel::Offset => Some(Kind::Offset),
        CorModel::Rebounds => Some(Kind::Rebounds),
        CorModel::Contact => Some(Kind::Contact),
        CorModel::Missed => Some(Kind::Missed),
        CorModel::Each => Some(Kind::Each),
        CorModel::Constant | CorModel::ConstantDrag | CorModel::LinearDrag | CorModel::EachDrag => None,
    }
}

/// The drag, per metre, that times of contacts show: that of a ball, and a clearly better
/// explanation than every other, so that the COR is the one beside it.
///
/// Flights in air shrink less and less, as no law of the COR makes them. By how much does not
/// depend on the clock: k h is a number, and a clock that is slow only makes k another.
pub(crate) fn air(fits: &Fits<'_>, list: &[ModelChoice]) -> Option<Measured> {
    fits.times.as_ref().filter(|_| fits.heights.is_none())?;
    let drag = list.iter().find(|model| model.name == CorModel::Drag && model.limit.is_none())?;
    let one = list.iter().find(|model| model.chosen)?;
    let clear = list.iter().filter(|model| model.name != CorModel::Drag).all(|model| drag.bic < model.bic - CLEAR);
    let found = drag.drag.filter(|found| found.value - NORMAL * found.standard_error <= LIGHT_DRAG)?;
    (clear && Open { one, allowed: None }.surely(drag)).then_some(found)
}

/// Notes models that fit better than one COR, or as well with another COR; doubts one COR where the
/// first is so and it matters.
///
/// The models come with the best first. Answers whether one COR is doubted.
pub(crate) fn models(judgement: &mut Judgement, list: &[ModelChoice]) -> bool {
    let Some(one) = list.iter().find(|m| m.chosen) else { return false };
    let least = list.first().map_or(0.0, |m| m.bic);
    let fits = !judgement.findings.iter().any(|f| matches!(f.kind, FindingKind::Misfit { .. }));
    let (mut seen, allowed) = (Vec::new(), judgement.cor.filter(|_| fits));
    // What matters, beside one COR: if one of these is better, whatever comes close to the best may
    // be the cause.
    let mut close: Vec<(Kind, &ModelChoice)> = Vec::new();
    // A model that another beats clearly is out of the question.
    for model in list.iter().filter(|m| !m.chosen && m.bic < least + CLEAR) {
        let Some(kind) = kind(model).filter(|k| !seen.contains(k)) else { continue };
        seen.push(kind);
        let apart = (model.cor.value - one.cor.value).abs();
        let differ = apart > 2.0 * hypot(model.cor.standard_error, one.cor.standard_error) && apart > SAME;
        let (better, last_resort) = (model.bic < -CLEAR, kind == Kind::Each && !close.is_empty());
        if !last_resort && (better || differ) {
            let (bic, gives) = (model.bic, model.gives());
            judgement.note(FindingKind::ModelFits { model: model.name, missing: model.missing, bic, better, gives });
        }
        if differ || changes(model) > LEVEL || matches!(kind, Kind::Each | Kind::Missed) {
            close.push((kind, model));
        }
        // One that fits better counts even where its own error is as large as the difference; one
        // that hardly does, with its COR alone.
        let reach = match (differ || model.bic < -WEAK && apart > SAME, model.bic < 0.0) {
            (true, _) => Some(NORMAL * model.cor.standard_error),
            (false, better) => better.then_some(0.0),
        };
        if let Some(reach) = reach {
            judgement.reach(model.cor.value - reach, model.cor.value + reach, Widening::Models);
        }
    }
    let open = Open { one, allowed };
    let within = list.iter().filter(|model| !open.elsewhere(model)).min_by(|a, b| a.bic.total_cmp(&b.bic));
    let least = within.map_or(0.0, |model| model.bic.min(0.0));
    let decided = close.iter().any(|(_, m)| m.bic < least - CLEAR && open.surely(m) && open.elsewhere(m));
    if !decided && within.is_some_and(|model| open.surely(model) && model.p.is_none_or(|p| p >= REJECT)) {
        explained(judgement);
    }
    decided && one_cor_fails(judgement, close, list)
}

/// One COR, and the interval that is allowed for whatever other models say; none where one COR does
/// not fit, and its interval is as long as the misfit.
struct Open<'a> {
    one: &'a ModelChoice,
    allowed: Option<Cor>,
}

impl Open<'_> {
    /// Whether a model is better than one COR by more than chance: of few readings a BIC is less by
    /// as much more often than it says.
    fn surely(&self, model: &ModelChoice) -> bool {
        let chance = model.misfit.zip(self.one.misfit).and_then(|(misfit, one)| misfit.by_chance(one));
        chance.is_none_or(|p| p < REJECT) && model.bic < 0.0
    }

    /// Whether a model answers outside the interval: one within it, or the same for any purpose, is
    /// no other answer.
    fn elsewhere(&self, model: &ModelChoice) -> bool {
        let own = model.speeds.is_empty().then_some(model.cor.value);
        let mut answers = own.into_iter().chain(model.speeds.iter().map(|s| s.cor));
        matches!(model.name, CorModel::Each | CorModel::Missed)
            || self.allowed.is_none_or(|cor| answers.any(|e| e < cor.low - SAME || e > cor.high + SAME))
    }
}

/// A trend that comes of what is allowed for is worth a word, and no doubt.
fn explained(judgement: &mut Judgement) {
    let trends = judgement.findings.iter_mut().filter(|f| matches!(f.kind, FindingKind::Trend { .. }));
    trends.for_each(|finding| finding.severity = Severity::Note);
}

/// Doubts one COR: the models that are close to the best may each be the cause.
fn one_cor_fails(judgement: &mut Judgement, mut close: Vec<(Kind, &ModelChoice)>, list: &[ModelChoice]) -> bool {
    // What is no one number is given as the range that it takes.
    for (_, model) in &close {
        let cors = || model.speeds.iter().map(|s| s.cor);
        judgement.reach(cors().fold(f64::INFINITY, f64::min), cors().fold(0.0, f64::max), Widening::Speeds);
    }
    // A COR of its own for every bounce explains nothing where something else does.
    if close.len() > 1 {
        close.retain(|(kind, _)| *kind != Kind::Each);
    }
    let mut causes: Vec<Cause> = close.iter().map(|&(kind, model)| cause(kind, model)).collect();
    if !list.iter().any(|m| kind(m) == Some(Kind::Speed)) {
        causes.push(Cause::Speed { gives: None });
    }
    if close.iter().any(|(kind, _)| *kind == Kind::Offset) {
        judgement.note(FindingKind::MeasureZero);
    }
    // The cause says more than the symptom: it leads.
    judgement.findings.insert(0, Finding::doubt(FindingKind::OneCorFails { causes }));
    true
}

/// Says where it is the error of reading that decides for or against one COR: one that is stated
/// may be larger than the readings show, and one that is not stated is no larger than what the best
/// model leaves.
pub(crate) fn error_decides(
    judgement: &mut Judgement,
    list: &[ModelChoice],
    (readings, sigma): (Readings, Sourced),
    doubted: bool,
) {
    let Some((one, left)) = list.iter().find(|m| m.chosen).and_then(|m| Some((m, m.misfit?))) else { return };
    // Where a rebound is missing, no error of reading is to blame.
    if list.first().is_some_and(|m| m.name == CorModel::Missed) {
        return;
    }
    let gain = |m: &ModelChoice, bic: &dyn Fn(Misfit) -> f64| m.misfit.map_or(0.0, |misfit| bic(misfit) - bic(left));
    let by_scatter = |m: &ModelChoice| gain(m, &Misfit::by_scatter);
    let by_errors = |m: &ModelChoice| gain(m, &|misfit| misfit.by_errors(left.scatter().max(1.0)));
    // As far as it would matter if the errors were what the model leaves.
    let matters = |m: &&ModelChoice| {
        let apart = (m.cor.value - one.cor.value).abs();
        let errors =
            hypot(m.cor.standard_error, one.cor.standard_error) * m.misfit.map_or(1.0, |m| m.scatter().min(1.0));
        !m.chosen && (changes(m) > LEVEL || apart > SAME && apart > 2.0 * errors)
    };
    let best = list.iter().filter(matters).min_by(|a, b| by_scatter(a).total_cmp(&by_scatter(b)));
    let Some((best, misfit)) = best.and_then(|m| Some((m, m.misfit?))).filter(|(m, _)| by_scatter(m) < -CLEAR) else {
        return;
    };
    let scattered = sigma.source == Source::Scatter;
    // With an error as large as the scatter about one COR, no other model that matters is to be
    // better by so much.
    if scattered != doubted || list.iter().filter(matters).any(|m| by_errors(m) < -CLEAR) {
        return;
    }
    let (about_best, about_one) = (misfit.scatter() * sigma.value, left.scatter() * sigma.value);
    let model = best.name;
    judgement.note(FindingKind::ErrorDecides { readings, sigma, model, about_best, about_one, doubted });
}

/// Lets the report rest on the model that was asked for; says so where it could not be fitted.
pub(crate) fn rest_on(judgement: &mut Judgement, wanted: CorModel, compared: &mut Compared) {
    let best = compared.models.first().map_or(0.0, |m| m.bic);
    let Some(place) = compared.models.iter().position(|m| m.name == wanted) else {
        if wanted == CorModel::Constant && judgement.cor.is_some() {
            return;
        }
        let kind = not_fitted(wanted, compared.untried, judgement.cor.is_some());
        let severity = if judgement.cor.is_some() { Severity::Doubt } else { Severity::Refusal };
        judgement.findings.insert(0, Finding::new(severity, kind));
        return;
    };
    compared.models.iter_mut().for_each(|m| m.chosen = m.name == wanted);
    let model = &compared.models[place];
    let (e, error, gives) = (model.cor.value, model.cor.standard_error, model.gives());
    let (holds, as_good) = (model.p.is_none_or(|p| p >= REJECT), model.bic < best + CLEAR);
    judgement.widened.clear();
    let (low, high) = ((e - NORMAL * error).max(0.0), e + NORMAL * error);
    judgement.cor = Some(Cor { value: e, standard_error: Some(error), low, high });
    // What speaks against one COR does not speak against another model.
    for finding in judgement.findings.iter_mut().filter(|f| f.severity == Severity::Doubt && of_one_cor(&f.kind)) {
        finding.severity = Severity::Note;
    }
    judgement.findings.retain(|f| !matches!(f.kind, FindingKind::RestsOn { .. }));
    judgement.findings.insert(
        0,
        match (holds, as_good) {
            (true, true) => Finding::note(FindingKind::RestsOn { basis: Basis::Model { model: wanted, gives } }),
            (false, _) => Finding::doubt(FindingKind::ModelMisfit { model: wanted, gives }),
            (true, false) => Finding::doubt(FindingKind::ModelBeaten { model: wanted, gives }),
        },
    );
}

fn not_fitted(model: CorModel, untried: Option<Untried>, instead: bool) -> FindingKind {
    FindingKind::ModelNotFitted { model, untried, instead }
}

/// Whether a finding says that one COR does not describe the readings, which another model may.
fn of_one_cor(kind: &FindingKind) -> bool {
    matches!(
        kind,
        FindingKind::OneCorFails { .. }
            | FindingKind::Misfit { .. }
            | FindingKind::Trend { .. }
            | FindingKind::SettingsDiffer { .. }
            | FindingKind::AsideDiffers { .. }
    )
}

/// By how much the COR changes from the slowest impact to the fastest.
fn changes(model: &ModelChoice) -> f64 {
    model.speeds.first().zip(model.speeds.last()).map_or(0.0, |(a, b)| (a.cor - b.cor).abs())
}

fn cause(kind: Kind, model: &ModelChoice) -> Cause {
    let gives = model.gives();
    let offset_m = model.offset_m.map_or(0.0, |o| o.value);
    match kind {
        Kind::Speed => Cause::Speed { gives: Some(gives) },
        Kind::Drag => Cause::Drag { gives },
        Kind::Offset => Cause::Offset { offset_m, gives },
        Kind::Rebounds => Cause::Rebounds { offset_m, gives },
        Kind::Contact => Cause::Contact { contact_s: model.contact_s.map_or(0.0, |c| c.value), gives },
        Kind::Missed => model.missing.map_or(Cause::Each, |place| Cause::Missed { place, gives }),
        Kind::Each => Cause::Each,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::solve::choice::SpeedCor;

    fn model(name: CorModel, cor: f64, bic: f64, speeds: &[(f64, f64)]) -> ModelChoice {
        let mut model = ModelChoice::new(name, Measured { value: cor, standard_error: 0.002 }, bic);
        model.speeds = speeds.iter().map(|&(speed, cor)| SpeedCor { speed, cor, standard_error: 0.002 }).collect();
        model.chosen = name == CorModel::Constant;
        model
    }

    /// Of a model whose COR is within the errors the interval takes in that error only if it is
    /// better by more than [`WEAK`], and its COR another by more than [`SAME`].
    #[test]
    fn what_is_hardly_better_adds_its_cor_alone() {
        let cor = Cor { value: 0.8, standard_error: Some(0.002), low: 0.796, high: 0.804 };
        let high = |e: f64, bic: f64| {
            let list = [model(CorModel::Drag, e, bic, &[]), model(CorModel::Constant, 0.8, 0.0, &[])];
            let mut judgement = Judgement { cor: Some(cor), ..Judgement::default() };
            models(&mut judgement, &list);
            judgement.cor.map_or(0.0, |cor| cor.high)
        };
        assert!(high(0.8045, -1.5) < 0.805 && high(0.8045, -3.0) > 0.807);
        assert!(high(0.8012, -3.0) < 0.805);
    }

    /// Drag is clearly better than one COR, and a COR of speed within 2.4 of drag.
    #[test]
    fn what_comes_close_to_the_best_is_named_beside_it() {
        let speeds = [(1.0, 0.85), (5.0, 0.75)];
        let cor = Cor { value: 0.8, standard_error: Some(0.002), low: 0.796, high: 0.804 };
        let judged = |speed: f64| {
            let list = [
                model(CorModel::Drag, 0.83, -7.0, &[]),
                model(CorModel::Linear, 0.8, speed, &speeds),
                model(CorModel::Constant, 0.8, 0.0, &[]),
            ];
            let mut judgement = Judgement { cor: Some(cor), ..Judgement::default() };
            assert!(models(&mut judgement, &list));
            judgement
        };
        let causes = |judgement: &Judgement| match &judgement.findings[judgement.leading().expect("a doubt")].kind {
            FindingKind::OneCorFails { causes } => causes.clone(),
            other => panic!("{other:?}"),
        };
        let both = judged(-4.6);
        assert!(matches!(causes(&both)[..], [Cause::Drag { .. }, Cause::Speed { gives: Some(_) }]), "{both:?}");
        let cor = both.cor.expect("a COR");
        assert!(cor.low <= 0.75 && cor.high >= 0.85 && !both.widened.is_empty());
        assert!(matches!(causes(&judged(-0.6))[..], [Cause::Drag { .. }]));
    }
}
