//! A frame loop: balls that a game advances sixty times a second, with what they hit.
//!
//! `cargo run --example realtime`

use saltus::Simulation;
use saltus::nalgebra::vector;
use saltus_bounce::effects::{Gravity, QuadraticDrag};
use saltus_bounce::walls::Stairs;
use saltus_bounce::{Cor, Event, Flyer, Live, Moving, Stance};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let stairs = Stairs::down(4, 0.8, 0.3, 0.2)?;
    let ball = Flyer::new((Gravity::EARTH, QuadraticDrag::new(0.02)?), stairs, Cor::new(0.6)?)?;
    let start = Moving::new(vector![0.1, 1.3], vector![0.9, 0.0]);
    let mut live = Live::start(&ball, Simulation::of(&ball), Stance::FLIGHT, start, 0.0..60.0)?;

    for k in 1..=60_u32 {
        // Times that are given, not added up, are the same on every machine.
        let frame = live.advance_to(f64::from(k) / 60.0, |jump| {
            let passes = jump.from.cell() != jump.to.cell();
            if let Some(Event::Meet(face)) = jump.edge().filter(|_| !passes) {
                let speed = (jump.after.velocity - jump.before.velocity).norm();
                println!("    {:.6} s: tread {} changes its velocity by {speed:.3} m/s", jump.t(), face.cell);
            }
        })?;
        if k % 6 == 0 {
            let p = frame.state.position;
            println!("{:.3} s: x = {:.4} m, y = {:.4} m", frame.t, p[0], p[1]);
        }
    }
    Ok(())
}
