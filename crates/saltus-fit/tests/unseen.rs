//! What no reading shows: the interval holds the truth whatever it is within what is supposed of
//! it, and is short where it is stated.

use proptest::prelude::*;
use saltus_cases::cases;
use saltus_fit::{Ball, Cor, Fit, ReadOptions, Table, Verdict, Widening};

const G: f64 = 9.81;
/// A tennis ball, read anywhere on it.
const ZERO: f64 = 0.067 / 3.464_101_6;
/// The drag of a table-tennis ball, 1/m.
const DRAG: f64 = 0.135;

/// The apexes of a ball with a COR and drag k: v² = (g/k)(1 − e^(−2kh)) falling, h = ln(1 + k
/// v²/g)/2k rising.
fn apexes(e: f64, k: f64, count: usize) -> Vec<f64> {
    std::iter::successors(Some(1.0f64), |h| {
        let square = if k == 0.0 { 2.0 * G * h } else { G / k * -(-2.0 * k * h).exp_m1() };
        let up = e * e * square;
        Some(if k == 0.0 { up / (2.0 * G) } else { (k * up / G).ln_1p() / (2.0 * k) })
    })
    .take(count)
    .collect()
}

fn cor(heights: &[f64], fit: Fit) -> Cor {
    *fit.sigma_height(0.002).run(&Table::from_heights(heights).unwrap()).unwrap().cor().unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(200)))]

    /// Three heights, without any scatter: a zero off by up to 1.9 standard errors or drag up to
    /// the most, not seen, do not lead out of the interval.
    #[test]
    fn the_interval_allows_for_what_no_reading_shows(
        e in 0.5f64..0.9, zero in -1.9f64..1.9, drag in 0.0f64..1.0, both in any::<bool>(),
    ) {
        // A zero too low makes a rebound vanish long before it is off by so much.
        let zero = if both { 0.0 } else { zero.max(-1.0) * ZERO };
        let read: Vec<f64> = apexes(e, if both { drag * DRAG } else { 0.0 }, 3).iter().map(|h| h + zero).collect();
        let found = cor(&read, Fit::new());
        prop_assert!(found.low <= e && e <= found.high, "{e}: {found:?}");
    }

    /// What is stated is taken off, and leaves the errors of reading alone.
    #[test]
    fn what_is_stated_is_taken_off(e in 0.5f64..0.9, drag in 0.0f64..0.15) {
        let read = apexes(e, drag, 5);
        let stated = cor(&read, Fit::new().sigma_zero(0.0).drag(drag));
        prop_assert!((stated.value - e).abs() < 1e-7, "{e}: {stated:?}");
        prop_assert!(((stated.high - stated.value) / stated.standard_error.unwrap() - 1.96).abs() < 0.01);
        let unknown = cor(&read, Fit::new());
        prop_assert!(unknown.high - unknown.low > 1.5 * (stated.high - stated.low), "{unknown:?} {stated:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(200)))]

    /// Three heights with a rebound missing between: a trusted interval holds the COR, and without
    /// a gap nothing is added where the readings tell.
    #[test]
    fn a_rebound_may_be_missing(e in 0.3f64..0.9, place in 1usize..3) {
        let whole = apexes(e, 0.0, 4);
        let read: Vec<f64> = (0..4).filter(|n| *n != place).map(|n| whole[n]).collect();
        let fit = Fit::new().sigma_height(0.01).sigma_zero(0.0).drag(0.0);
        let report = fit.run(&Table::from_heights(&read).unwrap()).unwrap();
        let found = report.cor().unwrap();
        let holds = found.low <= e + 1e-4 && e - 1e-4 <= found.high;
        prop_assert!(report.verdict() != Verdict::Trusted || holds, "{e}: {report}");
        if e > 0.55 {
            let sound = *fit.run(&Table::from_heights(&whole).unwrap()).unwrap().cor().unwrap();
            prop_assert!(sound.high - sound.low < 4.1 * sound.standard_error.unwrap(), "{e}: {sound:?}");
        }
    }
}

/// A larger ball, a larger doubt of its zero, as far as the chi-square allows, which of two heights
/// sees nothing; and one that is nearly nothing is not named.
#[test]
fn the_size_of_the_ball_bounds_the_zero() {
    let read = apexes(0.7, 0.0, 4);
    let wide = |read: &[f64], ball: f64| {
        let found = cor(read, Fit::new().ball(ball).drag(0.0));
        found.high - found.low
    };
    let two = apexes(0.7, 0.0, 2);
    assert!(wide(&two, 0.24) > 3.0 * wide(&two, 0.04));
    // Four heights tell the zero to less than a ball of 4 cm, and a larger one adds nothing.
    assert!((wide(&read, 0.24) / wide(&read, 0.04) - 1.0).abs() < 0.1, "{}", wide(&read, 0.24) / wide(&read, 0.04));
    assert!(wide(&read, 0.04) > wide(&read, 0.002));
    let report =
        Fit::new().sigma_height(0.002).sigma_zero(1e-5).drag(0.0).run(&Table::from_heights(&read).unwrap()).unwrap();
    assert!(!report.to_string().contains("zero of the heights"), "{report}");
}

/// A ball that the table names is allowed for, group by group: the COR is that of the readings, and
/// the interval takes in that without the air; a name that is not understood is that of any ball.
#[test]
fn a_ball_that_the_table_names_is_that_ball() {
    let rows = |ball: &str, rebounds: [f64; 4]| -> String {
        rebounds.iter().map(|rebound| format!("{ball},100,{rebound}\n")).collect()
    };
    let read = |text: &str| {
        Table::parse("t.csv", format!("ball,drop_cm,rebound_cm\n{text}").as_bytes(), &ReadOptions::default()).unwrap()
    };
    let plain = read(&rows("", [55.0, 54.0, 56.0, 55.0]));
    for (name, kind) in [("tennis", Ball::Tennis), ("Golf ball", Ball::Golf), ("ping-pong", Ball::TableTennis)] {
        let named = Fit::new().run(&read(&rows(name, [55.0, 54.0, 56.0, 55.0]))).unwrap();
        let stated = Fit::new().kind(kind).run(&plain).unwrap();
        let (own, other, any) =
            (named.cor().unwrap(), stated.cor().unwrap(), *Fit::new().run(&plain).unwrap().cor().unwrap());
        assert!((own.value - any.value).abs() < 1e-9 && own.low < own.value && other.value < own.high, "{named}");
        assert!(own.high - own.low <= any.high - any.low, "{named}");
        assert!(named.to_string().contains("names the ball"), "{named}");
        // What is stated stands above what the table says.
        let bare = Fit::new().ball(0.01).drag(0.0);
        let table = read(&rows(name, [55.0, 54.0, 56.0, 55.0]));
        assert_eq!(bare.run(&table).unwrap().cor(), bare.run(&plain).unwrap().cor());
    }
    let both = rows("tennis", [55.0, 54.0, 56.0, 55.0]) + &rows("my ball", [26.0, 25.0, 25.0, 26.0]);
    let both = Fit::new().run(&read(&both)).unwrap();
    let says = |n: usize| both.groups()[n].report.to_string().contains("names the ball");
    assert!(both.groups().len() == 2 && says(0) && !says(1), "{both}");
}

/// A drop as a table of heights and contact times, the heights larger by a factor.
fn both(e: f64, factor: f64) -> Table {
    let heights = apexes(e, 0.0, 4);
    let mut time = (2.0 * heights[0] / G).sqrt();
    let mut text = format!("event,time_s,height_m\nrelease,0,{}\n", factor * heights[0]);
    for height in &heights[1..] {
        text += &format!("contact,{time},\napex,,{}\n", factor * height);
        time += 2.0 * (2.0 * height / G).sqrt();
    }
    Table::parse("both.csv", text.as_bytes(), &ReadOptions::default()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases(200)))]

    /// Lengths wrong by up to a tenth, beside times that are right, do not lead out of the
    /// interval; and no more than a tenth is allowed for.
    #[test]
    fn lengths_may_be_wrong_by_a_tenth(e in 0.5f64..0.9, factor in 0.91f64..1.09) {
        let fit = Fit::new().sigma_height(0.05).sigma_time(0.05).sigma_zero(0.0).drag(0.0);
        let report = fit.run(&both(e, factor)).unwrap();
        let found = *report.cor().unwrap();
        prop_assert!(found.low <= e && e <= found.high, "{e}: {found:?}");
        let parts = report.widened().iter().filter_map(|w| if let Widening::Scale { part, .. } = w { Some(*part) } else { None });
        let parts: Vec<f64> = parts.collect();
        prop_assert!(parts.iter().all(|part| (0.05..=0.1).contains(part)) && !parts.is_empty(), "{parts:?}");
        let stated = *fit.sigma_scale(0.0).run(&both(e, factor)).unwrap().cor().unwrap();
        prop_assert!(stated.high - stated.low < found.high - found.low, "{stated:?} {found:?}");
    }
}
