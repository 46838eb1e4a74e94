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

/// Draws how the time of `what` grows, with points of logarithms below names of the axes, to
/// `docs/trust/NAME.svg`, and prints the power of N that they follow.
///
/// # Errors
/// If it cannot be written.
pub fn growth(name: &str, what: &str, [x, y]: [&str; 2], points: Vec<[f64; 2]>) -> std::io::Result<()> {
    let power = slope(&points);
    println!("the time of {what} grows as N^{power:.2}");
    let title = format!("The time of {what} grows as N^{power:.2}");
    let picture = Figure::new(&title, x, y).line("", points.clone()).dots("", points);
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/trust");
    std::fs::write(folder.join(format!("{name}.svg")), picture.svg())
}

/// The slope of the straight line nearest to points.
fn slope(points: &[[f64; 2]]) -> f64 {
    let mean = |axis: usize| points.iter().map(|p| p[axis]).sum::<f64>() / points.len() as f64;
    let [x, y] = [mean(0), mean(1)];
    points.iter().map(|p| (p[0] - x) * (p[1] - y)).sum::<f64>() / points.iter().map(|p| (p[0] - x).powi(2)).sum::<f64>()
}
