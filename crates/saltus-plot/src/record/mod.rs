//! Pictures of the runs of scenes: a record in, SVG out. Needs the feature `scene`.
//!
//! ```
//! use saltus_plot::record;
//! use saltus_scene::{Kind, Scene};
//! let scene = Scene::parse("drop.toml", b"restitution = 0.5\nball = { height = '1 m', name = 'marble' }\n")?;
//! let run = scene.plan()?.run()?;
//! assert!(record::svg(&run, Kind::Height)?.contains("A marble dropped from 1 m"));
//! assert!(record::svg(&run, Kind::Path).unwrap_err().to_string().contains("only moves up and down"));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod chart;
mod height;
mod space;

use crate::{Background, PlotError};
use saltus_scene::plan::Record;
use saltus_scene::{Kind, Scene};

/// The picture of a run as SVG.
///
/// # Errors
/// [`PlotError::Missing`] where the run has nothing that the kind shows, or another where it cannot
/// be drawn.
pub fn svg(record: &Record, kind: Kind) -> Result<String, PlotError> {
    let chart = match kind {
        Kind::Height => return height::picture(record).svg(),
        Kind::Velocity => chart::velocity(record),
        Kind::Energy => chart::energy(record),
        Kind::Phase => chart::phase(record)?,
        Kind::Ladder => chart::ladder(record)?,
        Kind::Hysteresis => chart::hysteresis(record)?,
        Kind::Path => space::path(record)?,
        Kind::Ghost => space::ghost(record),
    };
    chart.caption(&caption(record)).background(Background::Adaptive).svg()
}

/// The title that the scene gives, or one made from it.
fn title(scene: &Scene) -> String {
    if let Some(title) = &scene.picture.title {
        return title.clone();
    }
    let ball = &scene.balls[0];
    let what = match (scene.balls.len(), ball.name.as_ref().or(ball.material.as_ref())) {
        (1, Some(name)) => article(name),
        (1, None) => "A ball".to_owned(),
        (n, _) => format!("{n} balls"),
    };
    if scene.balls.len() > 1 {
        return what;
    }
    let (height, velocity) = (rounded(ball.lowest().z), ball.velocity);
    let speed = if scene.dimensions == 1 { velocity.z } else { velocity.norm() };
    if speed == 0.0 {
        format!("{what} dropped from {height} m")
    } else {
        format!("{what} thrown from {height} m at {} m/s", rounded(speed))
    }
}

fn article(name: &str) -> String {
    let vowel = name.starts_with(['a', 'e', 'i', 'o', 'u', 'A', 'E', 'I', 'O', 'U']);
    format!("{} {name}", if vowel { "An" } else { "A" })
}

/// The number with at most four significant digits.
fn rounded(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // clamped
    let decimals = (3.0 - value.abs().log10().floor()).clamp(0.0, 12.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

/// A coefficient that is given is written as it was, one chosen of a range by four digits.
fn said(cor: f64) -> String {
    let text = cor.to_string();
    if text.len() > 6 { format!("{cor:.4}") } else { text }
}

/// The line under the title.
fn caption(record: &Record) -> String {
    let scene = record.scene();
    let mut parts = Vec::new();
    let cor = scene.law(0, 0).and_then(saltus_scene::Law::constant);
    if let Some(cor) = cor {
        parts.push(format!("COR {}", said(cor.value())));
    }
    let between = scene.collision.as_ref().and_then(saltus_scene::Law::constant);
    if let Some(between) = between.filter(|_| between != cor) {
        parts.push(format!("COR {} between balls", said(between.value())));
    }
    parts.push(format!("gravity {} m/s²", scene.gravity.value()));
    let caption = parts.join(", ");
    match record.rest() {
        Some(t) => format!("{caption}; at rest from {t:.3} s"),
        None => caption,
    }
}
