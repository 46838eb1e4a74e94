//! The squash picture as pixels: what is visible of the text of the SVG.

use crate::pictures;

use resvg::{tiny_skia, usvg};

struct Sheet {
    pixels: tiny_skia::Pixmap,
    scale: f64,
}

impl Sheet {
    fn of(svg: &str, scale: f32) -> Self {
        let tree = usvg::Tree::from_str(svg, &usvg::Options::default()).unwrap();
        let size = tree.size();
        let (w, h) = ((size.width() * scale) as u32, (size.height() * scale) as u32);
        let mut pixels = tiny_skia::Pixmap::new(w, h).unwrap();
        resvg::render(&tree, tiny_skia::Transform::from_scale(scale, scale), &mut pixels.as_mut());
        Self { pixels, scale: f64::from(scale) }
    }

    /// Red, green, blue, alpha at a point in px of the picture.
    fn at(&self, x: f64, y: f64) -> (u8, u8, u8, u8) {
        let (px, py) = ((x * self.scale) as u32, (y * self.scale) as u32);
        let color = self.pixels.pixel(px, py).unwrap().demultiply();
        (color.red(), color.green(), color.blue(), color.alpha())
    }
}

/// The places the solid curve passes, at the middle of each flight.
fn middles(svg: &str) -> Vec<(f64, f64)> {
    // The solid motion lies above the dashed one, so it comes last.
    let path = svg.split("<path d=\"").filter(|part| part.matches('Q').count() == 3).last().unwrap();
    let data = path.split('"').next().unwrap();
    let mut found = Vec::new();
    let numbers: Vec<f64> = data.replace(['M', 'Q'], " ").split_whitespace().map(|n| n.parse().unwrap()).collect();
    let points: Vec<_> = numbers.chunks(2).map(|p| (p[0], p[1])).collect();
    for flight in points.windows(3).step_by(2) {
        let mid = |a: f64, b: f64, c: f64| 0.25 * a + 0.5 * b + 0.25 * c;
        found.push((mid(flight[0].0, flight[1].0, flight[2].0), mid(flight[0].1, flight[1].1, flight[2].1)));
    }
    found
}

#[test]
fn the_fitted_curve_is_blue_ink_where_it_should_be() {
    let svg = pictures::squash().svg().unwrap();
    let sheet = Sheet::of(&svg, 2.0);
    let middles = middles(&svg);
    assert_eq!(middles.len(), 3);
    for (x, y) in middles {
        let (r, g, b, a) = sheet.at(x, y);
        assert!(a > 240 && b > 150 && r < 60 && g < 140, "({r}, {g}, {b}, {a}) at {x}, {y}");
    }
}

#[test]
fn the_page_shows_through_beside_the_ink() {
    let sheet = Sheet::of(&pictures::squash().svg().unwrap(), 1.0);
    assert_eq!(sheet.at(2.0, 2.0).3, 0);
    let paper = Sheet::of(&pictures::many_lines().svg().unwrap(), 1.0);
    assert_eq!(paper.at(2.0, 2.0), (255, 255, 255, 255));
}

#[test]
fn every_picture_has_ink_and_air() {
    for (name, picture) in pictures::all() {
        let sheet = Sheet::of(&picture.svg().unwrap(), 0.5);
        let inked = sheet.pixels.pixels().iter().filter(|p| p.alpha() > 40).count();
        let share = inked as f64 / sheet.pixels.pixels().len() as f64;
        let papered = name.contains("adaptive") || name == "lines";
        assert!(papered || (0.001..0.5).contains(&share), "{name}: {share}");
    }
}
