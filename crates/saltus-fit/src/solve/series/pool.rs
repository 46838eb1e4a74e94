//! One COR from several recordings: each counts as a whole, since one drop differs from the next by
//! more than its own fit's error.

use super::recording::{Track, Variant};
use super::track::{CHOICES, Choice};
use crate::model::Law;
use crate::quantity::Measured;
use crate::solve::choice::of_recording;
use crate::solve::spread::across;

/// The COR over all recordings, and its rivals.
#[derive(Clone, Debug)]
pub(crate) struct Pooled {
    pub(crate) choice: Choice,
    pub(crate) cor: Measured,
    /// The factor from standard error to 95 % interval.
    pub(crate) quantile: f64,
    /// Every model that could be fitted to all recordings: the COR it gives, and by how much its
    /// BIC is worse.
    pub(crate) rivals: Vec<(Choice, Measured, f64)>,
    /// The COR of each impact over all recordings.
    pub(crate) impacts: Vec<Measured>,
}

/// Pools the recordings under the chosen model.
pub(crate) fn pool(tracks: &[Track], choice: Choice) -> Option<Pooled> {
    let under = |choice: Choice| {
        let own: Option<Vec<&Variant>> = tracks.iter().map(|t| variant(t, choice)).collect();
        let own = own?;
        let cors: Vec<Measured> = own.iter().map(|v| v.cor).collect();
        let found = across(&cors)?;
        Some((found.mean, found.quantile, own.iter().map(|v| v.bic).sum::<f64>()))
    };
    let drag = tracks.iter().any(|t| t.models.iter().any(|m| m.drag));
    let (cor, quantile, bic) = under(choice)?;
    let most = tracks.iter().map(|t| t.impacts.len()).max().unwrap_or(0);
    let impacts = (0..most).filter_map(|n| {
        let cors: Vec<Measured> = tracks.iter().filter_map(|t| t.impacts.get(n)).map(|i| i.cor).collect();
        across(&cors).map(|m| m.mean)
    });
    let several = |c: &Choice| tracks.iter().any(|t| t.impacts.len() > usize::from(c.0 == Law::Linear) + 1);
    let rivals = CHOICES
        .iter()
        .filter(|c| (c.0 == Law::Constant || several(c)) && (drag || !c.1))
        .filter_map(|&c| under(c).map(|(cor, _, other)| (c, cor, other - bic)));
    let mut rivals: Vec<(Choice, Measured, f64)> = rivals.collect();
    rivals.sort_by(|a, b| a.2.total_cmp(&b.2));
    Some(Pooled { choice, cor, quantile, rivals, impacts: impacts.collect() })
}

/// The model as a recording has it: one with few impacts has one law only, and drag that was not
/// found is none.
fn variant(track: &Track, (law, drag): Choice) -> Option<&Variant> {
    let of = |law: Law, drag: bool| track.models.iter().find(|m| m.law == of_recording(law, false) && m.drag == drag);
    of(law, drag).or_else(|| of(Law::Constant, drag)).or_else(|| of(law, false)).or_else(|| of(Law::Constant, false))
}
