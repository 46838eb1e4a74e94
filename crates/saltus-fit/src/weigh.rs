//! What other models of the same readings mean for the COR and the verdict.

use crate::choice::{CorModel, Misfit, ModelChoice};
use crate::diagnose::REJECT;
use crate::estimate::{Source, Sourced};
use crate::report::{Cor, Report, Verdict, duration, length, pair};
use crate::statistics::NORMAL;

/// A BIC this much less decides.
pub(crate) const CLEAR: f64 = 6.0;
/// One this much less speaks for the model, weakly.
const BETTER: f64 = 2.0;
/// CORs that differ by less are the same for any purpose.
const SAME: f64 = 0.002;
/// A COR that changes by less over all speeds may be called one.
const LEVEL: f64 = 0.02;

/// An error of reading so many times the scatter about the best model is out of the question.
const WORSE: f64 = 5.0;

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
    match model.name.as_str() {
        "linear" | "viscoelastic" | "plastic" | "power" | "knots" => Some(Kind::Speed),
        "drag" => Some(Kind::Drag),
        "offset" => Some(Kind::Offset),
        "rebounds" => Some(Kind::Rebounds),
        "contact" => Some(Kind::Contact),
        "missed" => Some(Kind::Missed),
        "each" => Some(Kind::Each),
        _ => None,
    }
}

/// Warns of models that fit better than one COR, or as well with another COR; doubts one COR where the first is so and it matters.
///
/// The models come with the best first. Answers whether one COR is doubted.
pub(crate) fn models(report: &mut Report, list: &[ModelChoice]) -> bool {
    let Some(one) = list.iter().find(|m| m.chosen) else { return false };
    let least = list.first().map_or(0.0, |m| m.bic);
    let mut seen = Vec::new();
    // What matters, beside one COR: if one of these is better, whatever comes close to the best may be the cause.
    let mut close: Vec<(Kind, &ModelChoice)> = Vec::new();
    // A model that another beats clearly is out of the question.
    for model in list.iter().filter(|m| !m.chosen && m.bic < least + CLEAR) {
        let Some(kind) = kind(model).filter(|k| !seen.contains(k)) else { continue };
        seen.push(kind);
        let apart = (model.cor.value - one.cor.value).abs();
        let differ = apart > 2.0 * model.cor.standard_error.hypot(one.cor.standard_error) && apart > SAME;
        let last_resort = kind == Kind::Each && !close.is_empty();
        if !last_resort && (model.bic < -CLEAR || differ) {
            let how = if model.bic < -CLEAR { "better than" } else { "about as well as" };
            let text = format!("{} fits {how} one COR (BIC {:+.1}), with {}", model.about, model.bic, gives(model));
            report.warnings.push(text);
        }
        if differ || changes(model) > LEVEL || matches!(kind, Kind::Each | Kind::Missed) {
            close.push((kind, model));
        }
        // One that fits better counts even where its own error is as large as the difference; one that hardly does, with its COR alone.
        let reach = match (differ || model.bic < -BETTER && apart > SAME, model.bic < 0.0) {
            (true, _) => Some(NORMAL * model.cor.standard_error),
            (false, better) => better.then_some(0.0),
        };
        if let (Some(reach), Some(cor)) = (reach, &mut report.cor)
            && (model.cor.value - reach < cor.low || model.cor.value + reach > cor.high)
        {
            cor.low = cor.low.min(model.cor.value - reach).max(0.0);
            cor.high = cor.high.max(model.cor.value + reach);
            report.widen("it reaches out to models that fit as well, with another COR");
        }
    }
    let decided = close.iter().any(|(_, model)| model.bic < -CLEAR);
    let mut better = if decided { close } else { Vec::new() };
    // What is no one number is given as the range that it takes.
    for (_, model) in &better {
        if let Some(cor) = &mut report.cor {
            cor.low = model.speeds.iter().map(|s| s.cor).fold(cor.low, f64::min);
            cor.high = model.speeds.iter().map(|s| s.cor).fold(cor.high, f64::max);
            report.widen("it takes in all that the COR may be under the models that fit");
        }
    }
    // A COR of its own for every bounce explains nothing where something else does.
    if better.len() > 1 {
        better.retain(|(kind, _)| *kind != Kind::Each);
    }
    if better.is_empty() {
        return false;
    }
    let mut causes: Vec<String> = better.iter().map(|&(kind, model)| cause(kind, model)).collect();
    if !list.iter().any(|m| kind(m) == Some(Kind::Speed)) {
        causes.push("it depends on the speed of impact (not tried: see the notes)".to_owned());
    }
    let open = if causes.len() > 1 { "; the readings cannot tell which" } else { "" };
    let reason = format!("one COR does not do: {}{open}", causes.join(", or "));
    if better.iter().any(|(kind, _)| *kind == Kind::Offset) {
        report.warnings.push(
            "to tell a wrong zero from a dependence on speed, lay the ball on the floor and read its height on the same scale".to_owned(),
        );
    }
    // The cause says more than the symptom.
    let before = std::mem::replace(&mut report.reason, reason);
    if report.verdict == Verdict::Doubtful {
        report.warnings.insert(0, before);
    }
    report.verdict = Verdict::Doubtful;
    true
}

/// Says where it is the error of reading that decides for or against one COR: one that is stated may be larger than the readings show, and one that is
/// not stated is no larger than what the best model leaves.
pub(crate) fn error_decides(report: &mut Report, list: &[ModelChoice], what: &str, sigma: Sourced, doubted: bool) {
    let Some((one, left)) = list.iter().find(|m| m.chosen).and_then(|m| Some((m, m.misfit?))) else { return };
    // Where a rebound is missing, no error of reading is to blame.
    if list.first().is_some_and(|m| kind(m) == Some(Kind::Missed)) {
        return;
    }
    let gain = |m: &ModelChoice, bic: &dyn Fn(Misfit) -> f64| m.misfit.map_or(0.0, |misfit| bic(misfit) - bic(left));
    let by_scatter = |m: &ModelChoice| gain(m, &Misfit::by_scatter);
    let by_errors = |m: &ModelChoice| gain(m, &|misfit| misfit.by_errors(left.scatter().max(1.0)));
    // As far as it would matter if the errors were what the model leaves.
    let matters = |m: &&ModelChoice| {
        let apart = (m.cor.value - one.cor.value).abs();
        let errors =
            m.cor.standard_error.hypot(one.cor.standard_error) * m.misfit.map_or(1.0, |m| m.scatter().min(1.0));
        !m.chosen && (changes(m) > LEVEL || apart > SAME && apart > 2.0 * errors)
    };
    let best = list.iter().filter(matters).min_by(|a, b| by_scatter(a).total_cmp(&by_scatter(b)));
    let Some((best, misfit)) = best.and_then(|m| Some((m, m.misfit?))).filter(|(m, _)| by_scatter(m) < -CLEAR) else {
        return;
    };
    let scattered = sigma.source == Source::Scatter;
    // Nobody reads so much worse than it seems.
    if scattered && left.scatter() > WORSE * misfit.scatter() {
        return;
    }
    // With an error as large as the scatter about one COR, no other model is to be better by so much.
    if scattered != doubted || list.iter().any(|m| by_errors(m) < -CLEAR) {
        return;
    }
    let (option, size): (_, fn(f64) -> String) =
        if what == "heights" { ("--sigma-height", length) } else { ("--sigma-time", duration) };
    let (about_best, about_one) = (size(misfit.scatter() * sigma.value), size(left.scatter() * sigma.value));
    let (name, stated) = (&best.about, |error: &str| format!("{option} {}", error.replace(' ', "")));
    report.warnings.push(if scattered {
        format!(
            "nobody stated how well the {what} were read, and that decides it: about {name} they scatter by {about_best}, about one COR by \
             {about_one}; if they are no better than that, say so ({}), and one COR is not ruled out",
            stated(&about_one)
        )
    } else {
        format!(
            "the error of reading decides it: with {what} ± {} one COR is not ruled out; but about {name} they scatter by {about_best} \
             only, and if they are as good as that ({}), one COR does not do",
            size(sigma.value),
            stated(&about_best)
        )
    });
}

/// Lets the report rest on the model that was asked for; says so where it could not be fitted.
pub(crate) fn rest_on(report: &mut Report, wanted: CorModel, untried: Option<&str>) {
    let best = report.models.first().map_or(0.0, |m| m.bic);
    let Some(model) = report.models.iter_mut().find(|m| m.name == wanted.name()) else {
        if wanted == CorModel::Constant && report.cor.is_some() {
            return;
        }
        report.verdict = if report.cor.is_some() { Verdict::Doubtful } else { Verdict::Refused };
        let why = untried.map_or_else(String::new, |why| format!(": {why}"));
        let (name, instead) = (wanted.name(), if report.cor.is_some() { "; the COR is that of one COR" } else { "" });
        report.reason = format!("the model '{name}' cannot be fitted to these readings{why}{instead}");
        return;
    };
    let (about, holds, as_good) = (gives(model), model.p.is_none_or(|p| p >= REJECT), model.bic < best + CLEAR);
    let (e, error, of_speed) = (model.cor.value, model.cor.standard_error, !model.speeds.is_empty());
    model.chosen = true;
    report.widened.clear();
    report.cor = Some(Cor {
        value: e,
        standard_error: Some(error),
        low: (e - NORMAL * error).max(0.0),
        high: e + NORMAL * error,
    });
    report.models.iter_mut().for_each(|m| m.chosen = m.name == wanted.name());
    let model = report.models.iter().find(|m| m.chosen).map_or("", |m| &m.about);
    (report.verdict, report.reason) = match (holds, as_good) {
        (true, true) if of_speed => {
            (Verdict::Trusted, format!("{model} fits: {about}; the COR here is that at the middle speed"))
        }
        (true, true) => (Verdict::Trusted, format!("{model} fits")),
        (false, _) => (Verdict::Doubtful, format!("{model} was asked for, but does not fit ({about})")),
        (_, false) => (Verdict::Doubtful, format!("{model} was asked for, but another model fits better ({about})")),
    };
}

/// By how much the COR changes from the slowest impact to the fastest.
fn changes(model: &ModelChoice) -> f64 {
    model.speeds.first().zip(model.speeds.last()).map_or(0.0, |(a, b)| (a.cor - b.cor).abs())
}

/// The COR or CORs that a model gives, for people.
fn gives(model: &ModelChoice) -> String {
    match (model.speeds.first(), model.speeds.last()) {
        (Some(slow), Some(fast)) => {
            format!("{:.3} at {:.2} m/s and {:.3} at {:.2} m/s", slow.cor, slow.speed, fast.cor, fast.speed)
        }
        _ => pair(model.cor.value, model.cor.standard_error),
    }
}

fn cause(kind: Kind, model: &ModelChoice) -> String {
    match kind {
        Kind::Speed => format!("it depends on the speed of impact ({})", gives(model)),
        Kind::Drag => format!("air drag slows the ball (COR {})", gives(model)),
        Kind::Offset => {
            let offset = model.offset_m.map_or(0.0, |o| 100.0 * o.value);
            format!("the height scale reads {offset:.1} cm too high (COR {})", gives(model))
        }
        Kind::Rebounds => {
            let offset = model.offset_m.map_or(0.0, |o| 100.0 * o.value);
            format!("rebounds are read {offset:.1} cm higher on the ball than the release (COR {})", gives(model))
        }
        Kind::Contact => {
            let lasting = model.contact_s.map_or(0.0, |c| 1000.0 * c.value);
            format!("every contact takes {lasting:.0} ms (COR {})", gives(model))
        }
        Kind::Missed => {
            let place = model.about.split_once("is missing ").map_or("", |(_, place)| place);
            format!("a rebound is missing {place} (COR {})", gives(model))
        }
        Kind::Each => "it differs from bounce to bounce".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bounces::Measured;
    use crate::choice::SpeedCor;

    fn model(name: &str, cor: f64, bic: f64, speeds: &[(f64, f64)]) -> ModelChoice {
        let mut model = ModelChoice::new(name, name, Measured { value: cor, standard_error: 0.002 }, bic);
        model.speeds = speeds.iter().map(|&(speed, cor)| SpeedCor { speed, cor, standard_error: 0.002 }).collect();
        model.chosen = name == "constant";
        model
    }

    /// Drag is clearly better than one COR, and a COR of speed within 2.4 of drag.
    #[test]
    fn what_comes_close_to_the_best_is_named_beside_it() {
        let speeds = [(1.0, 0.85), (5.0, 0.75)];
        let mut report = Report::new("t", Sourced { value: 9.81, source: Source::Assumed });
        report.cor = Some(Cor { value: 0.8, standard_error: Some(0.002), low: 0.796, high: 0.804 });
        let list = |speed: f64| {
            [model("drag", 0.83, -7.0, &[]), model("linear", 0.8, speed, &speeds), model("constant", 0.8, 0.0, &[])]
        };
        let mut alone = report.clone();
        models(&mut report, &list(-4.6));
        assert!(report.reason.contains("air drag slows the ball"), "{}", report.reason);
        assert!(report.reason.contains("or it depends on the speed of impact"), "{}", report.reason);
        assert!(report.reason.ends_with("the readings cannot tell which"), "{}", report.reason);
        let cor = report.cor.expect("a COR");
        assert!(cor.low <= 0.75 && cor.high >= 0.85 && !report.widened.is_empty());
        models(&mut alone, &list(-0.6));
        assert!(!alone.reason.contains("cannot tell"), "{}", alone.reason);
    }
}
