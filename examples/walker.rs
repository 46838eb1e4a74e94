//! The simplest walker: two stiff legs, a hip, a slope, and no motor (M. Garcia, A. Chatterjee, A.
//! Ruina, M. Coleman, J. Biomech. Eng. 120 (1998) 281).
//!
//! `cargo run --release --example walker` finds its gaits for every slope, and where they lose
//! their stability.

use std::error::Error;

use saltus::nalgebra::Vector4;
use saltus::return_map::{Continuation, Kind, Point, ReturnMap, Section};
use saltus::{About, Automaton, Edges, Entry, Linearize, Number, Refusal, Simulation};
use saltus_examples::{Figure, gallery};

/// The slope γ; lengths in legs, times in √(leg/g).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Walker {
    pub(crate) slope: f64,
}

/// The swing leg is behind the stance leg, then before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Swing {
    Behind,
    Before,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Event {
    MidStance, // until then the swing foot may scuff the ground, as a walker without knees does
    HeelStrike,
}

impl Linearize for Walker {
    type Parameters = [f64; 1];

    fn parameters(&self) -> [f64; 1] {
        [self.slope]
    }
    /// θ, the stance leg's angle; φ, the angle between the legs; their rates.
    fn flow_over<D: Number>(&self, _: Swing, _t: D, [th, ph, th1, ph1]: [D; 4], [slope]: [D; 1]) -> [D; 4] {
        let fall = (th - slope).sin();
        [th1, ph1, fall, fall + th1 * th1 * ph.sin() - (th - slope).cos() * ph.sin()]
    }
    fn guard_over<D: Number>(&self, event: Event, _t: D, [th, ph, ..]: [D; 4], _: [D; 1]) -> D {
        if event == Event::MidStance { th } else { th * 2.0 - ph }
    }
    fn reset_over<D: Number>(&self, event: Event, _t: D, x: [D; 4], _: [D; 1]) -> [D; 4] {
        let [th, _, th1, _] = x;
        if event == Event::MidStance { x } else { HeelStrike.place([-th, (th * 2.0).cos() * th1], [th]) }
    }
}

impl Automaton for Walker {
    type Mode = Swing;
    type State = Vector4<f64>;
    type Edge = Event;

    fn flow(&self, mode: Swing, t: f64, x: &Vector4<f64>) -> Vector4<f64> {
        self.flow_at(mode, t, x)
    }
    fn edges(&self, mode: Swing) -> Edges<'_, Event> {
        Edges::from([if mode == Swing::Behind { Event::MidStance } else { Event::HeelStrike }])
    }
    fn guard(&self, event: Event, t: f64, x: &Vector4<f64>) -> f64 {
        self.guard_at(event, t, x)
    }
    /// At mid-stance the swing foot has not passed the other yet.
    #[inline]
    fn about(&self, _: Event) -> About {
        About::new().entry(Entry::Wait).affine()
    }
    fn reset(&self, _: Swing, event: Event, t: f64, x: &Vector4<f64>) -> Result<(Swing, Vector4<f64>), Refusal> {
        let to = if event == Event::MidStance { Swing::Before } else { Swing::Behind };
        Ok((to, self.reset_at(event, t, x)))
    }
}

/// Just after a heel strike both feet are on the ground and the legs exchanged: the stance leg's
/// angle and its rate say everything.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeelStrike;

impl Section<Walker, 2> for HeelStrike {
    fn edge(&self) -> Event {
        Event::HeelStrike
    }
    fn start(&self) -> (Swing, Vector4<f64>) {
        (Swing::Behind, Vector4::zeros())
    }
    fn place<D: Number>(&self, [th, th1]: [D; 2], _: [D; 1]) -> [D; 4] {
        [th, th * 2.0, th1, th1 * (D::one() - (th * 2.0).cos())]
    }
    fn read<D: Number>(&self, _t: D, [th, _, th1, _]: [D; 4], _: [D; 1]) -> [D; 2] {
        [th, th1]
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let walker = Walker { slope: 0.003 };
    let map = ReturnMap::of(Simulation::of(&walker).tolerance(1e-12), HeelStrike);
    let follow = |guess, from| Continuation::of(&map, |slope| Walker { slope }, 0).follow(guess, from, 0.03);
    let (long, short) = (follow([0.140, -0.1386], 0.003)?, follow([0.194, -0.2038], 0.009)?);

    let doubling =
        long.bifurcations.iter().find(|found| found.kind == Kind::PeriodDoubling).ok_or("no period doubling")?;
    let at = &doubling.point;
    let angle = |point: &Point<2>| [point.parameter, point.orbit.q[0]];
    let (stable, unstable): (Vec<_>, Vec<_>) = long.points.iter().partition(|point| point.parameter < at.parameter);
    let doubled = [angle(at)];
    let picture = Figure::new("The gaits of the simplest walker", "slope (rad)", "leg angle after heel strike (rad)")
        .line("stable", stable.into_iter().map(angle).chain(doubled))
        .line("unstable", doubled.into_iter().chain(unstable.into_iter().map(angle)))
        .line("unstable, short steps", short.points.iter().map(angle))
        .dots("period doubling", doubled);
    gallery("walker", &picture.svg())?;

    println!("stable up to a slope of {:.10} (published: 0.0151): see docs/program/gallery/walker.svg", at.parameter);
    assert!((at.parameter - 0.0151).abs() < 5e-5 && (at.orbit.multipliers[0].re + 1.0).abs() < 1e-8);
    Ok(())
}
