//! What has to hold of any bytes that are given as a scene.

use saltus_scene::plan::Plan;
use saltus_scene::{Scene, SceneError};

/// How many evaluations of flows and guards a run may make.
const BUDGET: u64 = 20_000;
/// By how much it may go beyond that: a step that has begun is ended, and its crossings are
/// searched.
const ONE_STEP: u64 = 20_000;

/// A reader that is given anything answers with a scene or with a place inside the file; a scene is
/// planned and run within a budget, or refused with a sentence.
///
/// # Errors
/// What does not hold, in words.
pub fn answered(bytes: &[u8]) -> Result<(), String> {
    match Scene::parse("fuzz", bytes) {
        Err(error) => refused(bytes, &error),
        Ok(scene) => match scene.plan() {
            Ok(plan) => lives(&plan.most_jumps(200).most_evaluations(BUDGET)),
            Err(error) => hold(!error.to_string().is_empty(), "a plan is refused without a word"),
        },
    }
}

fn hold(holds: bool, says: impl ToString) -> Result<(), String> {
    if holds { Ok(()) } else { Err(says.to_string()) }
}

fn refused(bytes: &[u8], error: &SceneError) -> Result<(), String> {
    // A byte-order mark is passed over.
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let line = text.split(|&byte| byte == b'\n').nth(error.line().wrapping_sub(1));
    let line = line.ok_or_else(|| format!("there is no such line: {error}"))?;
    let line = String::from_utf8_lossy(line);
    hold((1..=line.chars().count() + 1).contains(&error.column()), format!("{error}\n{line:?}"))?;
    hold(!error.message().is_empty(), "it is refused without a word")?;
    let shown = error.to_string();
    hold(shown.starts_with(&format!("fuzz:{}:{}: ", error.line(), error.column())), &shown)?;
    hold(shown.len() < 4000 && !shown.contains(['\r', '\0']), shown)
}

fn lives(plan: &Plan) -> Result<(), String> {
    hold(!plan.explain().to_string().is_empty(), "there is no explanation")?;
    match plan.run() {
        Err(error) => hold(!error.to_string().is_empty(), "a run fails without a word")?,
        Ok(record) => {
            let (until, cost) = (record.until(), record.cost());
            hold(until.is_finite() && until >= 0.0, format!("it ends at {until}"))?;
            hold(cost.flows + cost.guards <= BUDGET + ONE_STEP, format!("{cost:?}"))?;
            for ball in 0..record.balls() {
                let end =
                    record.at(ball, until).ok_or_else(|| format!("nothing is known of ball {ball} at {until}"))?;
                let finite = end.position.iter().chain(end.velocity.iter()).all(|x| x.is_finite());
                hold(finite, format!("ball {ball} is nowhere at {until}: {end:?}"))?;
            }
            for impact in record.impacts() {
                hold((0.0..=until).contains(&impact.t) && impact.approach >= 0.0, format!("{impact:?} until {until}"))?;
            }
        }
    }
    // What comes of a run is found in another way than what is kept of it.
    match plan.outcome() {
        Err(error) => hold(!error.to_string().is_empty(), "a run fails without a word"),
        Ok(outcome) => hold(outcome.until.is_finite(), format!("it ends at {}", outcome.until)),
    }
}
