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
