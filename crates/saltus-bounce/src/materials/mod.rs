//! Presets of real balls on real floors: coefficients of restitution with their spread, their
//! speeds and their sources.
//!
//! A preset is a range, never a single number: a rule of a sport bounds it, a measurement scatters.
//! A pair without a preset is refused, not guessed.

mod table;

use std::fmt;

use crate::restitution::{Cor, CorError};
use table::{Evidence, PRESETS};

/// The coefficient of restitution of one ball on one floor, measured or by a rule of a sport.
///
/// ```
/// use saltus_bounce::materials;
/// let tennis = materials::find("tennis ball", "granite")?;
/// let [lowest, highest] = tennis.cor();
/// assert!((lowest.value() - 0.729).abs() < 5e-4 && (highest.value() - 0.7608).abs() < 5e-4);
/// let [slowest, fastest] = tennis.speeds().unwrap();
/// assert!(slowest == fastest && (slowest - 7.06).abs() < 0.01); // one height of drop, 254 cm
/// let unknown = materials::find("tenis ball", "granit").unwrap_err();
/// assert!(unknown.to_string().contains("tennis ball on granite"));
/// # Ok::<(), materials::UnknownPair>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset {
    ball: &'static str,
    floor: &'static str,
    evidence: Evidence,
    note: &'static str,
    source: &'static str,
}

impl Preset {
    /// The ball, in small letters.
    #[must_use]
    pub const fn ball(&self) -> &'static str {
        self.ball
    }

    /// The floor, in small letters.
    #[must_use]
    pub const fn floor(&self) -> &'static str {
        self.floor
    }

    /// The lowest and the highest coefficient of restitution that the source allows or found.
    #[must_use]
    pub fn cor(&self) -> [Cor; 2] {
        match self.evidence {
            Evidence::Rebound { drop, rebound } => rebound.map(|height| Cor::within((height / drop).sqrt())),
            Evidence::Measured { cor, .. } => cor.map(Cor::within),
        }
    }

    /// The slowest and the fastest impact of the measurement in m/s; `None` if the source gives
    /// none. Of a rule with a drop of height h it is √(2gh), without air.
    #[must_use]
    pub fn speeds(&self) -> Option<[f64; 2]> {
        match self.evidence {
            Evidence::Rebound { drop, .. } => Some([(2.0 * crate::effects::STANDARD_GRAVITY * drop).sqrt(); 2]),
            Evidence::Measured { speeds, .. } => speeds,
        }
    }

    /// The conditions under which the range holds.
    #[must_use]
    pub const fn note(&self) -> &'static str {
        self.note
    }

    /// The source of the range.
    #[must_use]
    pub const fn source(&self) -> &'static str {
        self.source
    }

    /// The coefficient a fraction `part` of the way from the lowest to the highest, for a scene
    /// that has to have one number.
    ///
    /// # Errors
    /// [`CorError`] unless 0 ≤ `part` ≤ 1.
    pub fn pick(&self, part: f64) -> Result<Cor, CorError> {
        let [low, high] = self.cor().map(Cor::value);
        Cor::new(part).map(|part| Cor::within(low + part.value() * (high - low)))
    }
}

impl fmt::Display for Preset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = self.cor().map(Cor::value);
        let to = if low == high { String::new() } else { format!(" to {high:.3}") };
        write!(f, "{} on {}: e = {low:.3}{to} ({}; {})", self.ball, self.floor, self.note, self.source)
    }
}

/// All presets.
#[must_use]
pub const fn presets() -> &'static [Preset] {
    &PRESETS
}

/// The preset of `ball` on `floor`, named in letters of any case.
///
/// # Errors
/// [`UnknownPair`], with the nearest pairs that are known.
pub fn find(ball: &str, floor: &str) -> Result<&'static Preset, UnknownPair> {
    let is = |name: &str, asked: &str| name.eq_ignore_ascii_case(asked.trim());
    PRESETS.iter().find(|preset| is(preset.ball, ball) && is(preset.floor, floor)).ok_or_else(|| {
        let (ball, floor) = (ball.trim().to_owned(), floor.trim().to_owned());
        let likeness = |preset: &Preset| {
            2.0 * strsim::jaro_winkler(preset.ball, &ball.to_lowercase())
                + strsim::jaro_winkler(preset.floor, &floor.to_lowercase())
        };
        let mut near: Vec<_> = PRESETS.iter().collect();
        near.sort_by(|a, b| likeness(b).total_cmp(&likeness(a)));
        near.truncate(3);
        UnknownPair { ball, floor, near }
    })
}

/// A pair of ball and floor without a preset.
#[derive(Clone, Debug, PartialEq)]
pub struct UnknownPair {
    ball: String,
    floor: String,
    near: Vec<&'static Preset>,
}

impl UnknownPair {
    /// The pairs with presets that are most like the one asked for, the likest first.
    #[must_use]
    pub fn near(&self) -> &[&'static Preset] {
        &self.near
    }
}

impl fmt::Display for UnknownPair {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "no coefficient of restitution is known for '{}' on '{}': give one, or choose ",
            self.ball, self.floor
        )?;
        for (n, preset) in self.near.iter().enumerate() {
            let join = if n == 0 { "" } else { " or " };
            write!(f, "{join}'{} on {}'", preset.ball, preset.floor)?;
        }
        Ok(())
    }
}

impl std::error::Error for UnknownPair {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_a_range_with_a_source_and_is_found_by_its_names() {
        for preset in presets() {
            let [low, high] = preset.cor();
            assert!(low <= high && low.value() > 0.0, "{preset}");
            assert!(preset.speeds().is_none_or(|[slow, fast]| 0.0 < slow && slow <= fast && fast < 50.0), "{preset}");
            assert!(!preset.source().is_empty() && !preset.note().is_empty(), "{preset}");
            assert_eq!(find(&preset.ball().to_uppercase(), preset.floor()), Ok(preset));
            assert_eq!((preset.pick(0.0).unwrap(), preset.pick(1.0).unwrap()), (low, high));
        }
        let mut names: Vec<_> = presets().iter().map(|preset| (preset.ball(), preset.floor())).collect();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), presets().len());
    }

    #[test]
    fn an_unknown_pair_is_refused_with_the_nearest_known() {
        for (ball, floor, first) in [
            ("golfball", "marbel", ("golf ball", "marble")),
            ("tenis ball", "tiles", ("tennis ball", "stoneware tile")),
            ("squash ball", "concrete", ("", "")),
            ("", "", ("", "")),
        ] {
            let refused = find(ball, floor).unwrap_err();
            assert_eq!(refused.near().len(), 3);
            if !first.0.is_empty() {
                assert_eq!((refused.near()[0].ball(), refused.near()[0].floor()), first, "{refused}");
            }
        }
    }
}
