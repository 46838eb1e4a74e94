//! Small programs that end in a picture: see the files beside this one, and run them with
//! `cargo run --example NAME`.
//!
//! What they share is here: a [`Figure`] with axes, and the place where the pictures of
//! `docs/program/gallery.md` lie; and the [`study`] of a squash ball.

mod figure;
#[path = "study/mod.rs"] // beside the program of the same name
pub mod study;

pub use figure::Figure;

/// Writes a picture to `docs/program/gallery/NAME.svg`.
///
/// # Errors
/// If it cannot be written.
pub fn gallery(name: &str, svg: &str) -> std::io::Result<()> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/program/gallery");
    std::fs::create_dir_all(&folder)?;
    std::fs::write(folder.join(format!("{name}.svg")), svg)
}

/// The slope of the straight line nearest to points.
#[must_use]
pub fn slope(points: &[[f64; 2]]) -> f64 {
    let mean = |axis: usize| points.iter().map(|p| p[axis]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>() / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>()
}
