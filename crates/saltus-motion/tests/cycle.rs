//! Loops and mirrors: what is played for ever closes, and what is turned around twice is what it
//! was.

use std::f64::consts::TAU;

use proptest::prelude::*;
use saltus_motion::{Export, Format, Frames, Motion, Shape, Snap};
use serde_json::Value;

use crate::drop;
use crate::drop::drop;

fn frames() -> Frames {
    Frames::new("24".parse().unwrap())
}

/// How much it turns altogether, in turns about y.
fn turns(motion: &Motion) -> f64 {
    let pieces = motion.tracks[0].stretches.iter().flat_map(|stretch| &stretch.pieces);
    pieces.map(|piece| piece.spin_at(0.0)[1] * piece.span / TAU).sum()
}

proptest! {
    #[test]
    fn a_hop_of_a_travelling_turning_ball_closes(
        height in 0.3..3.0_f64,
        cor in 0.4..0.95_f64,
        number in 1..4_usize,
        sideways in -2.0..2.0_f64,
        spin in -30.0..30.0_f64,
        hold in 0..4_u32,
        by_gravity: bool,
    ) {
        let motion = drop(height, cor, 4, sideways, [0.0, spin, 0.0], 0.02);
        let hop = motion.looped(number).unwrap();
        let (track, end) = (&hop.tracks[0], hop.end());
        let whole = &motion.tracks[0].stretches[number];
        prop_assert!((end - whole.span()).abs() < 1e-12);
        // In place, and as high as before.
        for k in 0..=20 {
            let t = end * f64::from(k) / 20.0;
            let (at, was) = (track.at(t), whole.at(whole.start() + t));
            prop_assert!((at[0] - whole.at(whole.start())[0]).abs() < 1e-9 && (at[2] - was[2]).abs() < 1e-9);
        }
        prop_assert!((turns(&hop) - turns(&hop).round()).abs() < 1e-9);
        let lone = spin * whole.span() / TAU;
        prop_assert!((turns(&hop) - lone).abs() <= 0.5 + 1e-9);

        let snapped = hop.snapped(if by_gravity { Snap::Gravity } else { Snap::Heights }, frames()).unwrap();
        let held = if hold > 0 { snapped.held(f64::from(hold) / 24.0).unwrap() } else { snapped };
        let last = 24.0 * held.end();
        prop_assert!((last - last.round()).abs() < 1e-9 && held.off_frame(frames()) < 1e-9);
        let ends = [0.0, held.end()].map(|t| held.tracks[0].at(t));
        prop_assert!((0..3).all(|axis| (ends[0][axis] - ends[1][axis]).abs() < 1e-9), "{ends:?}");
        if by_gravity {
            let pull = held.tracks[0].stretches.last().unwrap().parabola().unwrap()[2][2];
            prop_assert!((pull + 0.5 * drop::G).abs() < 1e-9);
        }
    }

    #[test]
    fn a_mirror_twice_is_none(height in 0.3..3.0_f64, sideways in -2.0..2.0_f64, spin in prop::array::uniform3(-9.0..9.0_f64)) {
        let mut motion = drop(height, 0.7, 3, sideways, spin, 0.02);
        motion.ground = vec![vec![[-1.0, 0.0], [2.0, 0.5]]];
        let mirrored = motion.mirrored();
        for k in 0..=30 {
            let t = motion.end() * f64::from(k) / 30.0;
            let (a, b) = (motion.tracks[0].at(t), mirrored.tracks[0].at(t));
            prop_assert_eq!([-a[0], a[1], a[2]], b);
        }
        // A ball that rolls rightwards turns one way, leftwards the other.
        prop_assert_eq!(mirrored.tracks[0].stretches[0].pieces[0].spin[0], [spin[0], -spin[1], -spin[2]]);
        prop_assert_eq!(&mirrored.ground[0][1], &[-2.0, 0.5]);
        prop_assert_eq!(mirrored.mirrored(), motion);
    }
}

#[test]
fn a_stretched_ball_is_round_where_its_loop_begins_and_ends() {
    let hop = drop(1.0, 0.8, 3, 0.0, [0.0; 3], 0.05).looped(1).unwrap().snapped(Snap::Gravity, frames()).unwrap();
    let form = hop.form(Shape { squash: 0.0, stretch: 0.4, hold: 0.0 }, frames());
    let last = hop.tracks[0].stretches.len() - 1;
    for (index, t) in [(0, 0.0), (last, hop.end())] {
        assert!((form.pose(&hop.tracks[0], index, t).along - 1.0).abs() < 1e-12);
    }
    assert!(form.pose(&hop.tracks[0], 0, 1.5 / 24.0).along > 1.05);
}

#[test]
fn files_of_a_loop_say_so_and_leave_out_the_frame_that_comes_again() {
    let hop = drop(1.0, 0.8, 3, 0.0, [0.0; 3], 0.05).looped(1).unwrap().snapped(Snap::Gravity, frames()).unwrap();
    let count = (24.0 * hop.end()).round();
    let file = |format| {
        let export = Export::new(&hop, frames());
        String::from_utf8_lossy(&export.file(format).unwrap().bytes).into_owned()
    };
    let lottie: Value = serde_json::from_str(&file(Format::Lottie)).unwrap();
    assert_eq!((lottie["ip"].as_f64(), lottie["op"].as_f64()), (Some(0.0), Some(count)));
    let json: Value = serde_json::from_str(&file(Format::Json)).unwrap();
    assert_eq!(json["loops"], true);
    assert!(file(Format::Svg).contains(&format!("animation-duration:{}s", hop.end())));
    assert!(file(Format::Usd).contains(&format!("endTimeCode = {}\n", count - 1.0)));
    for script in [Format::Blender, Format::Maya] {
        assert!(file(script).contains("\"loops\":true"));
    }
}

#[test]
fn what_cannot_be_a_loop() {
    let motion = drop(1.0, 0.8, 2, 0.0, [0.0; 3], 0.05);
    let says = |motion: &Motion, number| motion.looped(number).unwrap_err().to_string();
    assert_eq!(says(&motion, 0), "there is no hop 0: the motion has 2 from one contact to the next");
    assert_eq!(says(&motion, 9), "there is no hop 9: the motion has 2 from one contact to the next");
    let mut falling = motion.clone();
    for piece in falling.tracks[0].stretches.iter_mut().skip(2).flat_map(|stretch| &mut stretch.pieces) {
        piece.coefficients[0][2] -= 0.1;
    }
    assert_eq!(says(&falling, 1), "hop 1 ends 0.1000 m lower than it starts: it cannot be a loop");
    let mut several = motion.clone();
    several.tracks.push(motion.tracks[0].clone());
    assert_eq!(says(&several, 1), "several balls have no hop in common: only the motion of one ball can be a loop");
}
