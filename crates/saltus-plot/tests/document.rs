//! What every picture must be, whatever is in it.

use crate::pictures;

use std::path::Path;

use roxmltree::{Document, Node};
use saltus_plot::{Background, HeightTime, HeightUnit, Mark, Measured, Residual, Stroke};

/// The elements with this tag, in order.
fn tagged<'a, 'b>(document: &'a Document<'b>, tag: &'static str) -> impl Iterator<Item = Node<'a, 'b>> {
    document.descendants().filter(move |node| node.tag_name().name() == tag)
}

fn words(document: &Document<'_>) -> Vec<String> {
    tagged(document, "text").filter_map(|node| node.text().map(str::to_owned)).collect()
}

#[test]
fn every_picture_is_a_whole_document() {
    for (name, picture) in pictures::all() {
        let svg = picture.svg().unwrap();
        // Kept for the eye, in the target directory's tmp.
        std::fs::write(Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}.svg")), &svg).unwrap();
        let document = Document::parse(&svg).unwrap();
        let root = document.root_element();
        assert!(root.has_tag_name(("http://www.w3.org/2000/svg", "svg")), "{name}");
        assert_eq!(root.attribute("role"), Some("img"), "{name}");
        assert!(root.attribute("viewBox").unwrap().starts_with("0 0 "), "{name}");
        let named: Vec<_> = root.attribute("aria-labelledby").unwrap().split(' ').collect();
        for (tag, id) in ["title", "desc"].into_iter().zip(named) {
            let node = tagged(&document, tag).next().unwrap();
            assert_eq!(node.attribute("id"), Some(id), "{name}");
            assert!(!node.text().unwrap().trim().is_empty(), "{name}");
        }
        for strange in ["NaN", "inf", "\"-0\""] {
            assert!(!svg.contains(strange), "{name} contains {strange}");
        }
        assert!(svg.len() < 60_000, "{name} has {} bytes", svg.len());
        assert_eq!(svg, picture.svg().unwrap(), "{name} differs from run to run");
    }
}

#[test]
fn nothing_stands_outside_the_page() {
    for (name, picture) in pictures::all() {
        let svg = picture.svg().unwrap();
        let document = Document::parse(&svg).unwrap();
        let page: Vec<f64> = document.root_element().attribute("viewBox").unwrap().split(' ').map(number).collect();
        for node in tagged(&document, "text") {
            let size = number(node.parent().unwrap().attribute("font-size").unwrap());
            // Half the type size is about the width of a letter.
            let length = 0.5 * size * node.text().unwrap().chars().count() as f64;
            let x = number(node.attribute("x").unwrap());
            let (left, right) = match node.attribute("text-anchor") {
                Some("end") => (x - length, x),
                Some("middle") => (x - 0.5 * length, x + 0.5 * length),
                _ => (x, x + length),
            };
            let y = number(node.attribute("y").unwrap());
            let inside =
                left > -0.5 * size && right < page[2] + 0.5 * size && y > size * 0.7 && y < page[3] - 0.2 * size;
            assert!(inside, "{name}: {:?} from {left} to {right} at {y}", node.text());
        }
    }
}

fn number(text: &str) -> f64 {
    text.parse().unwrap()
}

#[test]
fn the_flights_of_the_squash_ball_are_exact_parabolas() {
    let svg = pictures::squash().svg().unwrap();
    let document = Document::parse(&svg).unwrap();
    // The map from data to page, read off two numbers of each axis.
    let label = |text: &str, attribute: &str| {
        let node = tagged(&document, "text").find(|node| node.text() == Some(text)).unwrap();
        number(node.attribute(attribute).unwrap())
    };
    let (x0, x1) = (label("0.0", "x"), label("1.0", "x"));
    let (y0, y80) = (label("20", "y"), label("100", "y"));
    let scale = (y80 - y0) / 0.8;
    // The dashed motion lies below the solid one, so it comes first.
    let solid = tagged(&document, "path")
        .filter_map(|node| node.attribute("d"))
        .filter(|data| data.matches('Q').count() == 3)
        .last()
        .unwrap();
    let points: Vec<f64> = solid.replace(['M', 'Q'], " ").split_whitespace().map(number).collect();
    let points: Vec<(f64, f64)> = points.chunks(2).map(|p| (p[0], p[1])).collect();
    assert_eq!(points.len(), 7, "{solid}");
    // Numbers stand a little below their line; the release at 1 m tells by how much.
    let top = points[0].1;
    let truth = {
        let fall = (2.0_f64 / 9.8).sqrt();
        let speed = 0.496 * 9.8 * fall;
        let second = fall + 2.0 * speed / 9.8;
        move |t: f64| match t {
            t if t <= fall => 1.0 - 4.9 * t * t,
            t if t <= second => speed * (t - fall) - 4.9 * (t - fall).powi(2),
            t => 0.496 * speed * (t - second) - 4.9 * (t - second).powi(2),
        }
    };
    for flight in 0..3 {
        let [a, b, c] = [points[2 * flight], points[2 * flight + 1], points[2 * flight + 2]];
        for i in 0..=50 {
            let u = f64::from(i) / 50.0;
            let mix = |a: f64, b: f64, c: f64| a * (1.0 - u).powi(2) + 2.0 * b * u * (1.0 - u) + c * u * u;
            let t = (mix(a.0, b.0, c.0) - x0) / (x1 - x0);
            let expected = top + scale * (truth(t) - 1.0);
            let found = mix(a.1, b.1, c.1);
            // The labels are placed to hundredths of a px, and up to 10 times that is lost on a
            // steep flight.
            assert!((found - expected).abs() < 0.08, "flight {flight}, t = {t}: {found} against {expected}");
        }
    }
}

#[test]
fn words_are_escaped() {
    let hostile = "a < b & \"c\" </svg><script>alert(1)</script> \u{1b}\u{0}";
    let arc = Stroke::over_time(0.0, 1.0, vec![1.0, 0.0, -1.0]);
    let svg = HeightTime::new(hostile).caption(hostile).description(hostile).motion(hostile, [arc]).svg().unwrap();
    let document = Document::parse(&svg).unwrap();
    assert!(tagged(&document, "script").next().is_none());
    let title = tagged(&document, "title").next().unwrap();
    assert!(title.text().unwrap().starts_with("a < b & \"c\" </svg>"));
}

#[test]
fn units_and_series_are_named() {
    let svg = pictures::squash().svg().unwrap();
    let document = Document::parse(&svg).unwrap();
    let words = words(&document);
    for word in ["Height (cm)", "Time (s)", "Residual (σ)", "fitted, e = 0.496", "model contact", "apex"] {
        assert!(words.iter().any(|w| w == word), "{word} is missing from {words:?}");
    }
    assert!(words.iter().any(|w| w == "\u{2212}5"), "a true minus sign: {words:?}");
    assert!(words.iter().any(|w| w.starts_with("6 residuals, rms 3.4 σ, 3 beyond")), "{words:?}");
}

#[test]
fn every_motion_has_a_dash_pattern_of_its_own() {
    let svg = pictures::many_lines().svg().unwrap();
    let document = Document::parse(&svg).unwrap();
    let mut dashes: Vec<_> = tagged(&document, "g")
        .filter(|g| g.children().any(|p| p.attribute("d").is_some_and(|d| d.contains('Q'))))
        .map(|g| (g.attribute("stroke-dasharray"), g.attribute("stroke")))
        .collect();
    assert_eq!(dashes.len(), 4);
    dashes.sort_unstable();
    dashes.dedup_by_key(|d| d.0);
    assert_eq!(dashes.len(), 4, "{dashes:?}");
}

#[test]
fn the_page_shows_through_unless_paper_is_asked_for() {
    let none = pictures::zeno().svg().unwrap();
    assert!(!none.contains("paper") && none.contains("prefers-color-scheme:dark"));
    let white = pictures::zeno().background(Background::White).svg().unwrap();
    assert!(white.contains("class=\"paper f\" fill=\"#ffffff\"") && !white.contains("prefers-color-scheme"));
    let adaptive = pictures::zeno().background(Background::Adaptive).svg().unwrap();
    assert!(adaptive.contains(".paper.f{fill:#12161c}"));
}

#[test]
fn thousands_of_bounces_stay_small() {
    let (mut arcs, contacts) = pictures::bouncing(1.0, |_| 0.999, 20_000);
    let end = contacts[contacts.len() - 1];
    arcs.push(Stroke::over_time(end, 100.0, vec![0.0]));
    let svg = HeightTime::new("Zeno").motion("e = 0.999", arcs).contacts(contacts).svg().unwrap();
    assert!(svg.len() < 150_000, "{} bytes", svg.len());
    Document::parse(&svg).unwrap();
}

#[test]
fn a_hundred_thousand_readings_stay_bounded() {
    let points = (0..100_000).map(|i| {
        let t = f64::from(i) * 1e-5;
        Measured::new(t, (1.0 - t * t).max(0.0)).height_error(0.01)
    });
    let residuals = (0..100_000).map(|i| Residual::new(f64::from(i) * 1e-5, f64::from(i % 7) - 3.0));
    let svg = HeightTime::new("Film").measured(points).residuals(residuals).svg().unwrap();
    assert!(svg.len() < 1_500_000, "{} bytes", svg.len());
}

#[test]
fn words_without_end_make_the_page_taller_not_the_plot_vanish() {
    let long = "every good plot says what it shows and what it does not ".repeat(30);
    let svg = pictures::squash().size(320.0, 320.0).caption(&long).svg().unwrap();
    let document = Document::parse(&svg).unwrap();
    let view: Vec<f64> = document.root_element().attribute("viewBox").unwrap().split(' ').map(number).collect();
    assert!((view[2] - 320.0).abs() < 1e-9 && view[3] > 600.0, "{view:?}");
    let all = words(&document).join(" ");
    assert!(all.contains("every good plot"));
}

#[test]
fn a_chosen_unit_is_kept() {
    let svg = pictures::squash().height_unit(HeightUnit::Metres).svg().unwrap();
    assert!(svg.contains(">Height (m)<") && svg.contains(">0.8<"));
}

#[test]
fn a_mark_of_every_kind_is_named() {
    let points = [Mark::Release, Mark::Apex, Mark::Contact, Mark::Sample];
    let svg = HeightTime::new("Marks")
        .measured(points.iter().zip(0i32..).map(|(&mark, i)| Measured::new(f64::from(i), 1.0).mark(mark)))
        .svg()
        .unwrap();
    for mark in points {
        assert!(svg.contains(&format!(">{}<", mark.word())), "{}", mark.word());
    }
}
