//! The study's equations against its own numbers, and against the hybrid automaton of the ball.

use proptest::prelude::*;

use saltus::{Simulation, TrajectoryOf};
use saltus_bounce::{Ball, Cor, Drop, Mode};
use saltus_examples::study::equations::{
    Apex, Total, early_by_radius, flights, height_of, impact_speed, rise, turns_at, whole_bounce,
};
use saltus_examples::study::film::Camera;
use saltus_examples::study::stages::Start;
use saltus_examples::study::trials::{Plan, of_mean_heights};
use saltus_examples::study::{CONTACTS, DROP, EARLY, GRAVITY, MODELLED, RADIUS, REBOUNDS, report};

type Path = TrajectoryOf<Ball>;

const STUDY: Start = Start { drop: DROP, gravity: GRAVITY, early: EARLY };

/// The ball let go from `drop`, until `end`.
fn path(drop: f64, gravity: f64, cor: f64, end: f64) -> Path {
    let ball = Ball::new(gravity, Cor::new(cor).unwrap()).unwrap();
    Simulation::of(&ball).run(Mode::Flight, Ball::dropped_from(drop), 0.0..end).unwrap().trajectory
}

fn close(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found} is not {expected} ± {within}");
}

#[test]
fn a_flight_by_its_apex() {
    // Stage 1 and stage 2 at the study's times.
    let (let_go, next) = (STUDY.apex(), Apex { time: STUDY.next_apex(), height: DROP });
    for (t, one, two) in [(0.20, 0.804, -1.357), (0.45, 0.008, 0.036), (0.60, -0.764, 0.578)] {
        close(let_go.at(GRAVITY, t), one, 6e-4);
        close(next.at(GRAVITY, t), two, 6e-4);
    }
    close(let_go.floor(GRAVITY)[1], 0.4518, 5e-5);
    close(next.floor(GRAVITY)[0], 0.4418, 5e-5);
    close(next.floor(GRAVITY)[1], 1.3453, 5e-5);
    assert!(Apex { time: 0.0, height: -1.0 }.floor(GRAVITY)[0].is_nan());
}

#[test]
fn the_ratio_of_heights_is_no_height() {
    let printed = STUDY.measured_rebound(DROP / REBOUNDS[0]);
    let meant = STUDY.measured_rebound(REBOUNDS[0]);
    for (t, as_printed, as_meant) in [(0.60, 2.91, -0.122), (0.85, 3.32, 0.291), (1.11, 3.10, 0.070)] {
        close(printed.at(t)[0], as_printed, 6e-3);
        close(meant.at(t)[0], as_meant, 6e-4);
    }
    // Its apex is at the time of one that comes back to 1 m, so the ball leaves the floor a fifth
    // of a second after it met it.
    let [leaves, lands] = Apex { time: STUDY.next_apex(), height: REBOUNDS[0] }.floor(GRAVITY);
    close(leaves - STUDY.fall(), 0.194, 6e-4);
    close(lands, 1.141, 6e-4);
}

#[test]
fn speeds_and_cors_of_the_study() {
    close(impact_speed(DROP, GRAVITY), 4.427, 6e-4);
    let (first, second) =
        (Cor::from_heights(DROP, REBOUNDS[0]).unwrap(), Cor::from_heights(REBOUNDS[0], REBOUNDS[1]).unwrap());
    close(first.value(), 0.548, 6e-4);
    close(second.value(), 0.577, 6e-4);
    close(rise(first.rebound(impact_speed(DROP, GRAVITY)), GRAVITY), REBOUNDS[0], 1e-12);
    close(height_of(CONTACTS[1] - CONTACTS[0], GRAVITY), 0.196, 1e-12);
    close(height_of(CONTACTS[2] - CONTACTS[1], GRAVITY), 0.0828, 6e-5);
}

#[test]
fn the_last_formula_by_its_cor() {
    for (e, second, third) in [
        (0.3_f64.sqrt(), 0.937, 1.198),
        (0.1_f64.powf(0.25), 0.950, 1.226),
        ((1.0_f64 / 3.0).sqrt(), 0.963, 1.255),
        (0.500, 0.893, 1.109),
        (0.4835, 0.879, 1.080),
    ] {
        let turns = STUDY.bounces(Cor::new(e).unwrap(), 2).turns();
        close(turns[1], second, 6e-4);
        close(turns[2], third, 6e-4);
    }
    // As printed the flight has its apex at its end: it would begin 0.85 m under the floor.
    let span = whole_bounce(REBOUNDS[0], GRAVITY, EARLY);
    close(Apex { time: span, height: REBOUNDS[0] }.at(GRAVITY, 0.0), -0.85, 5e-3);
}

#[test]
fn a_hundredth_of_a_second_is_a_radius_at_one_metre_only() {
    for (height, above, right) in [(DROP, 0.022, 0.0091), (REBOUNDS[0], 0.012, 0.0168), (REBOUNDS[1], 0.007, 0.0302)] {
        close(turns_at(height, GRAVITY, EARLY), above, 6e-4);
        close(early_by_radius(height, RADIUS, GRAVITY), right, 6e-5);
    }
    assert_eq!(early_by_radius(0.0, 0.0, GRAVITY), 0.0);
}

#[test]
fn which_cor_gives_which_total_time() {
    let fall = STUDY.fall();
    for (total, modelled, recorded) in
        [(Total::ThirdContact, 0.4836, 0.4892), (Total::SecondRebound, 0.5604, 0.5675), (Total::Rest, 0.4178, 0.4215)]
    {
        close(total.cor(MODELLED, fall), modelled, 5.1e-5);
        close(total.cor(CONTACTS[2], fall), recorded, 5.1e-5);
    }
    // The same with 0.01 s off both flights.
    close(Total::ThirdContact.cor(MODELLED + 2.0 * EARLY, fall), 0.4948, 5.1e-5);
    close(Total::ThirdContact.cor(CONTACTS[2] + 2.0 * EARLY, fall), 0.5003, 5.1e-5);
}

#[test]
fn residuals_get_better_only_where_the_formula_does() {
    let report = report().unwrap();
    let rms = |z: Vec<f64>| (z.iter().map(|z| z * z).sum::<f64>() / 5.0).sqrt();
    let by_heights = Cor::from_heights(DROP, REBOUNDS[0]).unwrap();
    let curves = [
        STUDY.free_fall(0.65),
        STUDY.half_bounces(),
        STUDY.measured_rebound(REBOUNDS[0]),
        STUDY.bounces(by_heights, 3),
    ];
    let [one, two, three, four] = curves.map(|curve| rms(curve.residuals(&report)));
    assert!(
        one > 30.0 && two > 20.0 && four > 4.0 && four < three && four < two && four < one,
        "{one} {two} {three} {four}"
    );
}

#[test]
fn films_are_read_as_the_formulas_say() {
    // The formulas leave out gravity between frames, g τ/v of the speed.
    let (gravity, e) = (9.8, 0.5);
    let camera = Camera { rate: 240.0 };
    let impact = e * impact_speed(1.0, gravity);
    let left_out = gravity * camera.frame() / impact;
    assert!(left_out < 0.02);
    let measured = camera.measure(1.0, gravity, Cor::new(e).unwrap(), 2, 500).unwrap();
    for (found, formula) in measured.into_iter().zip([camera.apex(gravity), camera.contact(e), camera.gap(impact, e)]) {
        for (a, b) in [(found.mean, formula.mean), (found.spread, formula.spread), (found.worst, formula.worst)] {
            close(a, b, left_out * formula.worst);
        }
    }
}

#[test]
fn the_same_seed_gives_the_same_drops_and_pooling_finds_their_cor() {
    let plan = Plan { drop: 1.0, gravity: GRAVITY, cor: 0.55, spread: 0.05, camera: Camera { rate: 30.0 } };
    let drops = plan.drops(10, 1).unwrap();
    assert_eq!(drops, plan.drops(10, 1).unwrap());
    assert_ne!(drops, plan.drops(10, 2).unwrap());
    assert!(drops.iter().all(|drop| (0.5..=0.6).contains(&drop.cor)));
    let truth = drops.iter().map(|drop| drop.cor).sum::<f64>() / 10.0;
    let pooled = plan.pooled(&drops).unwrap();
    let cor = pooled.cor().unwrap();
    assert!(cor.low < truth && truth < cor.high, "{cor:?} {truth}");
}

proptest! {
    #[test]
    fn every_flight_of_the_automaton_is_known_by_its_apex(h in 0.05..20.0_f64, g in 1.0..25.0_f64, e in 0.2..1.0_f64, share in 0.0..1.0_f64) {
        let (drop, fall) = (Drop::new(h, g, Cor::new(e).unwrap()), (2.0 * h / g).sqrt());
        let path = path(h, g, e, drop.impact_time(5));
        let at = |t: f64| path.at(t).unwrap();
        let t = share * fall;
        let let_go = Apex { time: 0.0, height: h };
        prop_assert!((let_go.at(g, t) - at(t)[0]).abs() <= 1e-12 * h);
        prop_assert!((let_go.velocity(g, t) - at(t)[1]).abs() <= 1e-12 * g * fall);
        prop_assert!((impact_speed(h, g) + path.jumps()[0].before[1]).abs() <= 1e-12 * g * fall);
        for (n, flight) in (1_u32..).zip(flights(h, g, e, 0.0)).take(4) {
            let t = flight.start + share * flight.span;
            prop_assert!((flight.apex.at(g, t) - at(t)[0]).abs() <= 1e-11 * h, "flight {}", n);
            prop_assert!((flight.start - path.jumps()[n as usize - 1].t()).abs() <= 1e-12 * t);
            prop_assert!((flight.apex.height - drop.apex_height(n)).abs() <= 1e-12 * h);
            prop_assert!((height_of(flight.span, g) - flight.apex.height).abs() <= 1e-12 * h);
            prop_assert!((whole_bounce(flight.apex.height, g, 0.0) - flight.span).abs() <= 1e-12 * fall);
            let [leaves, lands] = flight.apex.floor(g);
            prop_assert!((leaves - flight.start).abs() <= 1e-11 * t && (lands - leaves - flight.span).abs() <= 1e-11 * t);
        }
    }

    #[test]
    fn stages_two_and_four_with_nothing_taken_off_are_the_automaton(h in 0.05..20.0_f64, g in 1.0..25.0_f64, e in 0.2..1.0_f64, share in 0.0..1.0_f64) {
        let start = Start { drop: h, gravity: g, early: 0.0 };
        let lossless = path(h, g, 1.0, 3.0 * start.fall());
        let t = share * 2.9 * start.fall();
        prop_assert!((start.half_bounces().at(t)[0] - lossless.at(t).unwrap()[0]).abs() <= 1e-11 * h);
        let cor = Cor::new(e).unwrap();
        let end = start.exact(cor).impact_time(4);
        let t = share * end;
        prop_assert!((start.bounces(cor, 3).at(t)[0] - path(h, g, e, end).at(t).unwrap()[0]).abs() <= 1e-11 * h);
    }

    #[test]
    fn total_times_are_those_of_the_automaton_and_have_one_cor(h in 0.05..20.0_f64, g in 1.0..25.0_f64, e in 0.0..0.95_f64) {
        let (drop, fall) = (Drop::new(h, g, Cor::new(e).unwrap()), (2.0 * h / g).sqrt());
        let apex = drop.impact_time(2) + 0.5 * (drop.impact_time(3) - drop.impact_time(2));
        let times = [drop.impact_time(3), apex, drop.rest_time().unwrap()];
        for (total, time) in Total::ALL.into_iter().zip(times) {
            prop_assert!((total.time(e, fall) - time).abs() <= 1e-12 * time, "{:?}", total);
            prop_assert!((total.cor(time, fall) - e).abs() <= 1e-12, "{:?}", total);
        }
        if e > 0.2 {
            let path = path(h, g, e, times[2] + fall);
            prop_assert!((path.jumps()[2].t() - times[0]).abs() <= 1e-12 * times[0]);
            prop_assert!((path.jumps().last().unwrap().t() - times[2]).abs() <= 1e-11 * times[2]);
        }
    }

    #[test]
    fn a_floor_one_radius_up_is_met_sooner_by_as_much(h in 0.1..20.0_f64, share in 0.0..0.95_f64, g in 1.0..25.0_f64) {
        let radius = share * h;
        let met = |height: f64| path(height, g, 1.0, 2.0 * (2.0 * height / g).sqrt()).jumps()[0].t();
        let sooner = 2.0 * (met(h) - met(h - radius));
        prop_assert!((early_by_radius(h, radius, g) - sooner).abs() <= 1e-12 * met(h));
        // And cut short by so much, a bounce turns exactly there.
        prop_assert!((turns_at(h, g, early_by_radius(h, radius, g)) - radius).abs() <= 1e-12 * h);
    }

    #[test]
    fn averaging_makes_a_cor_seem_to_grow(cors in prop::collection::vec(0.05..1.0_f64, 2..20)) {
        let mean = cors.iter().sum::<f64>() / cors.len() as f64;
        let [first, second] = of_mean_heights(&cors);
        prop_assert!(first >= mean - 1e-12 && second >= first - 1e-12);
    }
}
