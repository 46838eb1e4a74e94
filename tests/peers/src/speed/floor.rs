//! The floor: what a loop costs that knows the formulas of this one problem.

use std::hint::black_box;

use super::contest::{Entry, Log};
use super::problems::{DRAG, VACUUM};

/// One square root an impact.
pub fn vacuum() -> Entry {
    Entry::exact("floor", "one square root an impact", |log: &mut Log| {
        let (g, e) = (black_box(VACUUM.gravity), black_box(VACUUM.cor));
        let (mut t, mut rise, mut height) = (0.0, 0.0, black_box(VACUUM.height));
        for _ in 0..VACUUM.impacts {
            let fall = (2.0 * height / g).sqrt();
            t += rise + fall;
            log.marks.push(t);
            let speed = e * g * fall;
            height = speed * speed / (2.0 * g);
            rise = speed / g;
        }
    })
}

/// Four elementary functions an impact, as the textbook has them.
pub fn drag() -> Entry {
    Entry::exact("floor", "the textbook's formulas", |log: &mut Log| {
        let ball = black_box(DRAG);
        textbook(ball.gravity, ball.drag, ball.height, ball.cor, |t, _| {
            log.marks.push(t);
            log.marks.len() < ball.impacts
        });
    })
}

/// v² = (g/k)(1 - exp(-2kh)), t = acosh(exp(kh))/ω; h = ln(1 + k v²/g)/(2k), t = atan(v √(k/g))/ω.
#[inline(always)]
pub fn textbook(g: f64, k: f64, height: f64, e: f64, mut impact: impl FnMut(f64, f64) -> bool) {
    let (rate, per) = ((g * k).sqrt(), (k / g).sqrt());
    let (mut t, mut h) = (0.0, height);
    loop {
        let fall = (k * h).exp().acosh() / rate;
        let speed = (1.0 - (-2.0 * k * h).exp()).sqrt() / per;
        t += fall;
        if !impact(t, speed) {
            return;
        }
        let v = e * speed;
        h = (1.0 + k * v * v / g).ln() / (2.0 * k);
        t += (v * per).atan() / rate;
    }
}
