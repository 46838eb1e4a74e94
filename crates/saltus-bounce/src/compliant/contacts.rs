//! The contacts of a recorded run: their times, deformations, forces and CORs.

use saltus::{Piece, TrajectoryOf};

use super::{Compliant, Moment, Stage};
use crate::contact::ContactLaw;
use nalgebra::Vector2;

/// A contact of a recorded run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// The time of touch, in s.
    pub touch: f64,
    /// The speed of approach then, in m/s.
    pub speed: f64,
    /// The time from touch to the greatest deformation, in s; `None` if the run ends before.
    pub compression: Option<f64>,
    /// The time from touch to lift-off, in s; `None` if the ball does not leave.
    pub duration: Option<f64>,
    /// The greatest deformation, in m, as far as the run goes.
    pub deformation: f64,
    /// The greatest force, in N.
    pub force: f64,
    /// The speed at lift-off over that at touch; `None` if the ball does not leave.
    pub cor: Option<f64>,
    arcs: [usize; 2],
}

impl<L: ContactLaw> Compliant<L> {
    /// The contacts of a recorded run, in order; the last may be cut off by its end, or last for
    /// ever.
    ///
    /// The greatest force is searched for on the recorded pieces: to their twelve digits, or to the
    /// tolerance of the steps.
    #[must_use]
    pub fn contacts(&self, run: &TrajectoryOf<Self>) -> Vec<Contact> {
        let mut contacts: Vec<Contact> = Vec::new();
        let mut open = false;
        for (index, arc) in run.arcs().iter().enumerate() {
            let (x, t) = (arc.state(), arc.start());
            if !arc.mode().is_contact() {
                if let Some(last) = contacts.last_mut().filter(|_| open) {
                    let since = run.arcs()[last.arcs[0]].start();
                    last.duration = Some(t.since(since));
                    last.cor = Some(x[1] / last.speed);
                }
                open = false;
                continue;
            }
            if !open {
                let touch = Contact {
                    touch: t.seconds(),
                    speed: -x[1],
                    compression: None,
                    duration: None,
                    deformation: 0.0,
                    force: self.force(x),
                    cor: None,
                    arcs: [index; 2],
                };
                contacts.push(touch);
                open = true;
            }
            if let Some(last) = contacts.last_mut() {
                last.arcs[1] = index;
                last.deformation = last.deformation.max(-x[0]);
                last.force = run.pieces(index).fold(last.force.max(self.force(x)), |most, piece| {
                    last.deformation = last.deformation.max(-piece.at(piece.span())[0]);
                    most.max(self.hardest(&piece))
                });
                if arc.mode() == Stage::Restitution && last.compression.is_none() {
                    last.compression = Some(t.since(run.arcs()[last.arcs[0]].start()));
                }
            }
        }
        contacts
    }

    /// The force over the deformation through one contact of `run`: `count` points [d, F] in m and
    /// N for each stage in contact, evenly spaced in time, besides those at its ends.
    ///
    /// The area of the loop, ∮ F dd, is the energy lost.
    #[must_use]
    pub fn hysteresis(&self, run: &TrajectoryOf<Self>, contact: &Contact, count: usize) -> Vec<[f64; 2]> {
        let point = |x: &Vector2<f64>| [-x[0], self.force(x)];
        let mut points = Vec::new();
        for index in contact.arcs[0]..=contact.arcs[1] {
            let Some(arc) = run.arcs().get(index) else { break };
            points.push(point(arc.state()));
            let span = run.pieces(index).map(|piece| piece.span()).sum::<f64>();
            let mut before = 0.0;
            let mut n = 1;
            for piece in run.pieces(index) {
                #[allow(clippy::cast_precision_loss)] // counts of points
                while n <= count && span * n as f64 / (count + 1) as f64 <= before + piece.span() {
                    let s = span * n as f64 / (count + 1) as f64 - before;
                    points.push(point(&piece.at(s)));
                    n += 1;
                }
                before += piece.span();
            }
        }
        let end = run.jumps().get(contact.arcs[1]).filter(|jump| jump.edge() == Some(Moment::LiftOff));
        points.extend(end.map(|jump| point(&jump.before)));
        points
    }

    /// The greatest force on a piece: sampled, then by golden section.
    fn hardest(&self, piece: &Piece<'_, Vector2<f64>>) -> f64 {
        const SAMPLES: u32 = 16;
        const GOLDEN: f64 = 0.618_033_988_749_894_8;
        let h = piece.span() / f64::from(SAMPLES);
        let force = |s: f64| self.force(&piece.at(s));
        let (best, most) = (0..=SAMPLES)
            .map(|n| (f64::from(n) * h, force(f64::from(n) * h)))
            .fold((0.0, f64::NEG_INFINITY), |a, b| if b.1 > a.1 { b } else { a });
        let (mut low, mut high) = ((best - h).max(0.0), (best + h).min(piece.span()));
        let (mut a, mut b) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let (mut at_a, mut at_b) = (force(a), force(b));
        for _ in 0..48 {
            if at_a > at_b {
                (high, b, at_b) = (b, a, at_a);
                a = high - GOLDEN * (high - low);
                at_a = force(a);
            } else {
                (low, a, at_a) = (a, b, at_b);
                b = low + GOLDEN * (high - low);
                at_b = force(b);
            }
        }
        most.max(at_a).max(at_b)
    }
}
