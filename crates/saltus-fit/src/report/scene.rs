//! The fitted motion as a scene file, from which it can be simulated, changed and exported.

use std::fmt::Write;

use super::contract::Report;
use super::motion::Motion;
use super::residual::{Mark, Point};
use crate::quantity::CorModel;
use crate::solve::choice::ModelChoice;
use crate::solve::series::in_metres;
use crate::verdict::Verdict;

/// A scene has so many points of a COR over speed at most.
const KNOTS: usize = 16;
/// A COR above this loses so little that only the clock ends the motion.
const LOSSLESS: f64 = 0.999;

impl Report {
    /// The fitted motion of the first trial as the text of a scene file (TOML): gravity, the COR or
    /// its law of speed, drag if the readings need it, and the height and velocity at the start.
    /// `None` if the verdict is refused.
    ///
    /// The motion is the one of [`Report::motion`]: it starts with the fall if there is one, else
    /// at the first contact. A recording whose gravity is off by more than a fifth was not in
    /// metres; its lengths are scaled so that gravity is [`Report::gravity`], and the scene says
    /// so. A law of speed is given by at most 16 points, straight between them and constant beyond.
    ///
    /// ```
    /// use saltus_fit::{Fit, Table};
    /// let report = Fit::new().run(&Table::from_heights(&[1.0, 0.64, 0.41, 0.26])?)?;
    /// let scene = report.scene().unwrap();
    /// assert!(scene.contains("restitution = 0.79") && scene.contains("[ball]\nheight = \"1.000"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn scene(&self) -> Option<String> {
        let motion = self.motions.first().filter(|_| self.verdict != Verdict::Refused)?;
        let metres = in_metres(motion.gravity, self.gravity.value);
        let scale = if metres { 1.0 } else { self.gravity.value / motion.gravity };
        let law = self.law(scale);
        let [height, velocity] = self.start(motion, !law.is_empty())?;

        let mut scene = format!("# Fitted to {}.\n", line(&self.table));
        let _ = match self.cor {
            Some(cor) if self.verdict == Verdict::Trusted => {
                writeln!(scene, "# COR {cor}, 95 %: {} to {}.", figures(cor.low, 4), figures(cor.high, 4))
            }
            Some(cor) => {
                let says = format!("a COR between {:.2} and {:.2}", cor.low, cor.high);
                writeln!(scene, "# Doubtful, {says}: {}.", line(&self.reason))
            }
            None => Ok(()),
        };
        if self.trials > 1 {
            let _ = writeln!(scene, "# The start is that of the first of {} trials.", self.trials);
        }
        if !metres {
            scene.push_str(
                "# The scale of the recording is not known: lengths are such that gravity is the one here.\n",
            );
        }
        let _ = writeln!(scene, "gravity = \"{} m/s^2\"", figures(motion.gravity * scale, 6));
        let _ = match &law[..] {
            [] => writeln!(scene, "restitution = {}", figures(motion.cor.clamp(0.0, 1.0), 6)),
            knots => {
                let knots: Vec<String> =
                    knots.iter().map(|[v, e]| format!("[\"{} m/s\", {}]", figures(*v, 6), figures(*e, 6))).collect();
                writeln!(scene, "restitution = {{ law = \"knots\", knots = [{}] }}", knots.join(", "))
            }
        };
        if let Some(drag) = self.drag() {
            let _ = writeln!(scene, "drag = {{ per_length = \"{} 1/m\" }}", figures(drag / scale, 6));
        }
        let _ = writeln!(scene, "\n[ball]\nheight = \"{} m\"", figures(height.max(0.0) * scale, 6));
        if velocity != 0.0 {
            let _ = writeln!(scene, "velocity = \"{} m/s\"", figures(velocity * scale, 6));
        }
        if let Some(diameter) = self.ball_m {
            let _ = writeln!(scene, "diameter = \"{} m\"", figures(diameter, 6));
        }
        if motion.cor.max(law.iter().fold(0.0, |most, [_, e]| most.max(*e))) > LOSSLESS {
            let _ = writeln!(scene, "\n[run]\nuntil = \"{} s\"", figures(span(motion), 6));
        }
        let title = line(&self.title()).replace('\\', "\\\\").replace('"', "\\\"");
        let _ = writeln!(scene, "\n[picture]\ntitle = \"{title}\"");
        Some(scene)
    }

    /// The height and the velocity at the start: of the motion, which has one COR; where the COR
    /// has a law and there is no film, as they were read.
    fn start(&self, motion: &Motion, law: bool) -> Option<[f64; 2]> {
        let [height, velocity, _] = motion.flights.first()?.height;
        let read = self.start.filter(|_| law && self.series.is_empty());
        Some(read.unwrap_or([height, velocity]))
    }

    fn chosen(&self) -> Option<&ModelChoice> {
        self.models.iter().find(|model| model.chosen)
    }

    /// k of v' = -g ∓ k v², in 1/m.
    fn drag(&self) -> Option<f64> {
        let series = || self.series.first()?.drag;
        self.chosen().and_then(|model| model.drag).or_else(series).map(|drag| drag.value).filter(|drag| *drag > 0.0)
    }

    /// Points (speed, COR) of the law, ascending, where the COR is not one number.
    fn law(&self, scale: f64) -> Vec<[f64; 2]> {
        let Some(chosen) = self.chosen() else { return Vec::new() };
        let mut points: Vec<[f64; 2]> = chosen.speeds.iter().map(|at| [at.speed, at.cor]).collect();
        if let Some(track) =
            self.series.first().filter(|_| !matches!(chosen.name, CorModel::Constant | CorModel::ConstantDrag))
        {
            points = track.impacts.iter().map(|impact| [impact.speed, impact.cor.value]).collect();
        }
        points.sort_by(|a, b| a[0].total_cmp(&b[0]));
        points.dedup_by(|b, a| figures(a[0] * scale, 6) == figures(b[0] * scale, 6));
        let (count, last) = (points.len().min(KNOTS), points.len().saturating_sub(1));
        let spread = (0..count).map(|k| points[if count > 1 { k * last / (count - 1) } else { 0 }]);
        spread.map(|[speed, cor]| [speed * scale, cor.clamp(0.0, 1.0)]).collect()
    }
}

/// Height and velocity at the start of the first motion, as they were read.
pub(super) fn as_read(motions: &[Motion], points: &[Point]) -> Option<[f64; 2]> {
    let motion = motions.first()?;
    let read = |which: (Mark, usize)| points.iter().find(|p| p.trial == 0 && (p.mark, p.number) == which);
    let flight = read((Mark::Contact, 1)).zip(read((Mark::Contact, 2))).map(|(a, b)| b.time - a.time);
    match (motion.release_height, read((Mark::Release, 0)), flight) {
        (Some(_), Some(release), _) => Some([release.height, 0.0]),
        (None, _, Some(flight)) => Some([0.0, 0.5 * motion.gravity * flight]),
        _ => None,
    }
}

/// How long the motion goes on, in s.
fn span(motion: &Motion) -> f64 {
    let ends = motion.flights.first().zip(motion.flights.last());
    ends.map_or(1.0, |(first, last)| last.start + last.span - first.start)
}

/// So many digits, without zeros behind.
fn figures(value: f64, count: usize) -> String {
    let rounded: f64 = format!("{value:.*e}", count - 1).parse().unwrap_or(value);
    rounded.to_string()
}

/// On one line, and nothing that a scene file cannot hold.
fn line(text: &str) -> String {
    text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect()
}
