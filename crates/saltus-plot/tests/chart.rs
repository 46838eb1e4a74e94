//! Charts: dots in the colour of their line, limits, points that are called out, and what is too
//! small for an axis by powers of ten.

use roxmltree::{Document, Node};
use saltus_plot::{Background, Chart, Measure, Stroke};

fn costs() -> Chart {
    Chart::new("Costs", ("Error", Measure::Length), ("Time", Measure::Time))
        .both_logarithmic()
        .background(Background::Adaptive)
}

const POINTS: [[f64; 2]; 3] = [[1e-9, 1e-3], [1e-6, 1e-4], [1e-3, 1e-5]];

fn attribute(node: Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name).unwrap().parse().unwrap()
}

#[test]
fn dots_have_the_colour_of_their_line() {
    let one = costs().line("one", Stroke::polygon(&POINTS)).dotted(POINTS);
    let svg = one.line("two", []).dotted([[1e-5, 1e-2]]).svg().unwrap();
    let document = Document::parse(&svg).unwrap();
    let dots = |class: &str| -> usize {
        let groups = document.descendants().filter(|node| node.attribute("class") == Some(class));
        let paths = groups.flat_map(|group| group.children()).filter_map(|path| path.attribute("d"));
        paths.map(|data| data.matches("h0").count()).sum()
    };
    // And one in the legend.
    assert_eq!((dots("one s"), dots("two s"), dots("text s")), (4, 2, 0), "{svg}");
}

#[test]
fn words_of_a_callout_are_in_the_panel_wherever_its_point_is() {
    for at in POINTS.into_iter().chain([[1e-9, 1e-5], [1e-3, 1e-3]]) {
        let chart = costs().line("a line", Stroke::polygon(&POINTS)).dotted(POINTS).limit("as much as may be", 1e-4);
        let svg = chart.callout("the one to take", at).svg().unwrap();
        let document = Document::parse(&svg).unwrap();
        let word = |text: &str| {
            document
                .descendants()
                .find(|node| node.text() == Some(text) && node.has_tag_name(("http://www.w3.org/2000/svg", "text")))
        };
        assert!(word("as much as may be").is_some(), "{svg}");
        let words = word("the one to take").unwrap();
        let (x, y) = (attribute(words, "x"), attribute(words, "y"));
        assert!(x > 60.0 && x + 110.0 < 780.0 && y > 110.0 && y < 500.0, "{at:?}: {x} {y}");
    }
}

#[test]
fn zero_is_refused_unless_the_axis_says_what_it_stands_for() {
    let zero = costs().marks([[0.0, 1e-3], [1e-3, 1e-5]]);
    assert!(zero.clone().svg().unwrap_err().to_string().contains("logarithmic"));
    assert!(zero.at_least(1e-15).svg().unwrap().contains(">≤ 10⁻¹⁵<"));
    let none = costs().marks(POINTS).at_least(1e-15).svg().unwrap();
    assert!(!none.contains('≤'), "{none}");
    assert!(costs().marks(POINTS).limit("nothing", 0.0).svg().is_err());
}
