//! The contacts of bouncing balls among onsets, and why the other onsets are none.

use super::chain::{Chain, LIKELY, SURE, chains};
use super::onset::Onset;

/// What comes so soon after a contact, s, and is fainter, is its echo or its ringing.
const RINGS: f64 = 0.15;

/// Why a sound is not used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unused {
    /// It follows a contact as its echo or its ringing.
    Echo,
    /// It is a contact whose time no longer tells its flight.
    Close,
    /// It comes when no contact is due.
    Stray,
}

/// The contacts of bouncing balls among onsets.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bounced {
    /// Of each drop the onsets, at least three, and which contacts they are, from 1.
    pub(crate) drops: Vec<Vec<(usize, usize)>>,
    /// Of each drop, ln of one over how many as good ones come by chance.
    pub(crate) evidence: Vec<f64>,
    /// The other onsets, and why they are none.
    pub(crate) unused: Vec<(usize, Unused)>,
}

impl Bounced {
    /// The contacts among onsets; `None` where no ball bounces. One chain of all onsets is believed
    /// where they are `felt`, for little else is.
    pub(crate) fn among(onsets: &[Onset], felt: bool) -> Option<Self> {
        let mut chains = chains(onsets);
        let whole = |chain: &Chain| felt && chain.at.len() == onsets.len();
        chains.retain(|chain| chain.counts >= 3 && (whole(chain) || is_believed(onsets, chain)));
        let of = |chain: &Chain| {
            let numbers = chain.numbers.iter().map(|number| number + 1);
            chain.at.iter().copied().zip(numbers).take(chain.counts).collect()
        };
        let used = |n: &usize| chains.iter().any(|chain| chain.at[..chain.counts].contains(n));
        let why = |n: usize| {
            let mut contacts = chains.iter().flat_map(|chain| &chain.at).map(|&m| &onsets[m]);
            if chains.iter().any(|chain| chain.at.contains(&n)) {
                Unused::Close
            } else if contacts.any(|contact| follows(&onsets[n], contact) && onsets[n].power < contact.power) {
                Unused::Echo
            } else {
                Unused::Stray
            }
        };
        let unused = (0..onsets.len()).filter(|n| !used(n)).map(|n| (n, why(n))).collect();
        let evidence = chains.iter().map(|chain| chain.evidence).collect();
        (!chains.is_empty()).then(|| Self { drops: chains.iter().map(of).collect(), evidence, unused })
    }
}

/// Whether a sound begins with a contact, or so soon after it that it may be of it.
fn follows(onset: &Onset, contact: &Onset) -> bool {
    (0.0..RINGS).contains(&(onset.time - contact.time))
}

/// Whether the contacts of a chain may be those of a ball: for sure; if it is likely, where most
/// sounds as loud between them are contacts; else if chance would not make more than one such
/// chain, where most of all sounds are.
fn is_believed(onsets: &[Onset], chain: &Chain) -> bool {
    let contacts = || chain.at.iter().map(|&n| &onsets[n]);
    let least = contacts().map(|contact| contact.power).fold(f32::INFINITY, f32::min);
    let echoes = |onset: &Onset| contacts().any(|contact| follows(onset, contact) && onset.power <= contact.power);
    let most = |onsets: &[Onset]| {
        onsets.iter().filter(|onset| onset.power >= least && !echoes(onset)).count() < chain.at.len()
    };
    let between = &onsets[chain.at[0]..chain.at[chain.at.len() - 1]];
    match chain.evidence {
        SURE.. => true,
        LIKELY.. => most(between),
        0.0.. => most(onsets),
        _ => false,
    }
}
