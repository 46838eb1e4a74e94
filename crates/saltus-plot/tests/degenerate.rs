//! Data at the edge: each gives a picture or one clear error, never a panic and never a strange
//! number.

use saltus_plot::{HeightTime, Mark, Measured, PlotError, Residual, Stroke};

fn drop() -> Stroke {
    Stroke::over_time(0.0, 0.4, vec![1.0, 0.0, -4.9])
}

fn fault(picture: &HeightTime) -> String {
    picture.svg().unwrap_err().to_string()
}

#[test]
fn nothing_at_all_says_what_to_give() {
    let empty = HeightTime::new("Empty");
    assert_eq!(empty.svg(), Err(PlotError::Empty));
    assert!(fault(&empty).contains("give the picture something to show"));
    assert_eq!(empty.motion("nothing", []).svg(), Err(PlotError::Empty));
}

#[test]
fn a_number_at_fault_is_named() {
    let new = || HeightTime::new("Faulty");
    let cases = [
        (new().motion("m", [drop(), Stroke::over_time(f64::NAN, 1.0, vec![])]), "start of stroke 2 of motion 1 is NaN"),
        (new().motion("m", [Stroke::over_time(0.0, f64::INFINITY, vec![])]), "span of stroke 1 of motion 1 is inf"),
        (
            new().motion("m", [Stroke::over_time(0.0, -1.0, vec![])]),
            "span of stroke 1 of motion 1 is -1, but must not be negative",
        ),
        (
            new().motion("m", [Stroke::over_time(0.0, 1e200, vec![0.0, 0.0, 1.0])]),
            "a point of stroke 1 of motion 1 is inf",
        ),
        (new().measured([Measured::new(0.0, f64::NAN)]), "height of measurement 1 is NaN"),
        (new().measured([Measured::new(0.0, 1.0).height_error(-0.1)]), "height error of measurement 1 is -0.1"),
        (new().measured([Measured::new(0.0, 1.0).time_error(f64::NAN)]), "time error of measurement 1 is NaN"),
        (new().motion("m", [drop()]).contacts([0.4, f64::NEG_INFINITY]), "model contact 2 is -inf"),
        (new().residuals([Residual::new(0.0, f64::NAN)]), "value of residual 1 is NaN"),
    ];
    for (picture, expected) in cases {
        let message = fault(&picture);
        assert!(message.contains(expected), "{message} lacks {expected}");
    }
}

#[test]
fn sizes_out_of_reach_are_refused() {
    for (w, h) in [(0.0, 600.0), (900.0, f64::NAN), (1e9, 600.0), (-5.0, -5.0)] {
        let result = HeightTime::new("Size").motion("m", [drop()]).size(w, h).svg();
        assert!(matches!(result, Err(PlotError::Size { .. })), "{w} by {h}: {result:?}");
    }
}

#[test]
fn the_smallest_and_the_largest_page_can_be_drawn() {
    for side in [160.0, 20_000.0] {
        let svg = HeightTime::new("Square")
            .motion("m", [drop()])
            .measured([Measured::new(0.1, 0.9).height_error(0.1).mark(Mark::Apex)])
            .residuals([Residual::new(0.1, 1.0)])
            .size(side, side)
            .svg()
            .unwrap();
        roxmltree::Document::parse(&svg).unwrap();
    }
}

#[test]
fn no_scale_is_too_large_or_too_small() {
    let scales = [1e-320, 1e-300, 1e-100, 1e-12, 1e-3, 1.0, 1e3, 1e12, 1e100, 1e299];
    for t in scales {
        for h in scales {
            for sign in [1.0, -1.0] {
                let picture = HeightTime::new("Scales")
                    .measured([
                        Measured::new(0.0, sign * h).height_error(0.1 * h),
                        Measured::new(sign * t, 0.0).time_error(0.1 * t).mark(Mark::Contact),
                    ])
                    .motion(
                        "m",
                        [Stroke::over_time(0.0, t, vec![h]), Stroke::over_time(t, t, vec![h, h / t.max(1e-290)])],
                    )
                    .contacts([t])
                    .residuals([Residual::new(t, sign * h)]);
                match picture.svg() {
                    Ok(svg) => {
                        roxmltree::Document::parse(&svg).unwrap();
                        assert!(!svg.contains("NaN") && !svg.contains("inf"), "t {t}, h {h}: {svg}");
                        assert!(svg.len() < 60_000, "t {t}, h {h}: {} bytes", svg.len());
                    }
                    Err(error) => assert!(matches!(error, PlotError::NotFinite { .. }), "t {t}, h {h}: {error}"),
                }
            }
        }
    }
}

#[test]
fn a_late_clock_is_drawn_to_scale() {
    let points = (0..5).map(|i| Measured::new(1e9 + 1e-3 * f64::from(i), f64::from(i)));
    let svg = HeightTime::new("Late").measured(points).svg().unwrap();
    // Five dots in five places, evenly spaced across the page.
    let dots = svg.split("<path d=\"").find(|part| part.matches('Z').count() == 5).unwrap();
    let places: Vec<f64> = dots.split('M').skip(1).map(|dot| dot.split(' ').next().unwrap().parse().unwrap()).collect();
    let gaps: Vec<f64> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert!(gaps.iter().all(|gap| (gap - gaps[0]).abs() < 0.1 && *gap > 100.0), "{gaps:?}");
}
