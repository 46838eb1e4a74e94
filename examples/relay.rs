//! A relay under a swing that sometimes beats it: x' = -sign(x) + 1.2 sin t slides on x = 0 and
//! leaves it again (A. F. Filippov, 1988).
//!
//! `cargo run --example relay`

use std::error::Error;
use std::f64::consts::PI;

use saltus::{Filippov, Side, Sides, Simulation};
use saltus_examples::{Figure, gallery};

fn main() -> Result<(), Box<dyn Error>> {
    let strength = 1.2;
    let relay = Filippov::of(Sides::new(
        move |t: f64, _: &f64| strength * t.sin() - 1.0,
        move |t, _| strength * t.sin() + 1.0,
        |_, x| *x,
        |_, _| 1.0,
    ));
    let run = Simulation::of(&relay).tolerance(1e-13).run(Side::Above, 1.0, 0.0..20.0)?;

    let trajectory = &run.trajectory;
    let path = |slides: bool| {
        (0..=2000).map(move |k| f64::from(k) * 1e-2).filter_map(move |t| {
            let there = (trajectory.mode_at(t)? == Side::Sliding) == slides;
            Some([t, if there { trajectory.at(t)? } else { f64::NAN }])
        })
    };
    let picture =
        Figure::new("A relay that slides", "time (s)", "x").line("free", path(false)).line("sliding", path(true));
    gallery("relay", &picture.svg())?;

    // It slides while 1.2 |sin t| ≤ 1: it leaves where the sine is 1/1.2 in size.
    let jumps = trajectory.jumps();
    let (enters, exits): (Vec<f64>, Vec<f64>) = (
        jumps.iter().filter(|jump| jump.to == Side::Sliding).map(|jump| jump.t()).collect(),
        jumps.iter().filter(|jump| jump.from == Side::Sliding).map(|jump| jump.t()).collect(),
    );
    println!("slides from {enters:.6?} to {exits:.6?}: see docs/program/gallery/relay.svg");
    let tangent = (1.0_f64 / strength).asin();
    assert!(exits.iter().zip(1_i32..).all(|(exit, k)| (exit - (f64::from(k) * PI + tangent)).abs() < 1e-11));
    assert!((enters[0] - 3.369_082_659_477_437).abs() < 2e-11 && (enters[1] - 5.905_416_136_003_556).abs() < 3e-11);
    Ok(())
}
