//! Contact that takes time: each run by steps or by its exact flow, and each law's own closed form.

use saltus::nalgebra::{Vector2, vector};
use saltus::{Auto, Dop853, Run, RunOf, Simulation, Stop};
use saltus_bounce::Compliant;
use saltus_bounce::compliant::{Contact, Moment, Stage};
use saltus_bounce::contact::{ContactLaw, Hertz, HuntCrossley, KelvinVoigt};

use crate::report::Report;

cases! {
    hertz_1e3 = "hertz-1e3";
    hertz_1e9 = "hertz-1e9";
    hertz_1e12 = "hertz-1e12";
    hertz_gravity = "hertz-gravity";
    kelvin_voigt_soft = "kv-soft";
    kelvin_voigt_hard = "kv-hard";
    kelvin_voigt_critical = "kv-critical";
    kelvin_voigt_settles = "kv-settle";
    hunt_crossley_light = "hunt-crossley";
    hunt_crossley_strong = "hunt-crossley-strong";
}

/// A run by steps that are as exact as they get.
fn tight<L: ContactLaw>(
    case: &mut Report,
    ball: &Compliant<L>,
    (stage, start): (Stage, Vector2<f64>),
    end: f64,
) -> RunOf<Compliant<L>> {
    let simulation = Simulation::of(ball).stepper(Auto::from(Dop853)).tolerance(1e-14).absolute_tolerance(1e-20);
    let run = simulation.run(stage, start, 0.0..end).unwrap();
    case.ran(&run.end.stats);
    run
}

/// A ball without gravity that touches the floor at t = 0, for a second.
fn hit<L: ContactLaw>(case: &mut Report, law: L) -> (RunOf<Compliant<L>>, Contact) {
    let [mass, speed] = case.params(["m", "v"]);
    let ball = Compliant::new(mass, 0.0, law).unwrap();
    let run = tight(case, &ball, (Stage::Compression, vector![0.0, -speed]), 1.0);
    let contact = ball.contacts(&run.trajectory)[0];
    (run, contact)
}

/// The height and speed at lift-off.
fn released(run: &Run<Stage, Moment, Vector2<f64>>) -> Vector2<f64> {
    run.trajectory.jumps().iter().find(|jump| jump.edge() == Some(Moment::LiftOff)).unwrap().before
}

fn hertz(case: &mut Report) {
    let [m, k, v] = case.params(["m", "k", "v"]);
    let law = Hertz::new(k).unwrap();
    let (run, contact) = hit(case, law);
    assert!(run.end.stats.steps < 500, "{:?}", run.end.stats);
    let closed = law.collision(m, v).unwrap();
    let duration = contact.duration.unwrap();
    case.check("separation(1)", run.end.state[0]);
    case.check("separation(1)", (1.0 - closed.duration) * closed.cor.rebound(v));
    case.check("u_out", -released(&run)[1]);
    case.check("u_out", -closed.cor.rebound(v));
    for (duration, compression, deformation, force) in [
        (duration, contact.compression.unwrap(), contact.deformation, contact.force),
        (closed.duration, closed.compression, closed.deformation, closed.force),
    ] {
        case.check("t_release", duration);
        case.check("t_max", compression);
        case.check("d_max", deformation);
        case.check("F_max", force);
        case.check("const_A", duration / (m * m / (k * k * v)).powf(0.2));
        case.check("const_2.94", duration * v / deformation);
    }
}

fn hertz_1e3(case: &mut Report) {
    hertz(case);
}

fn hertz_1e9(case: &mut Report) {
    hertz(case);
}

fn hertz_1e12(case: &mut Report) {
    hertz(case);
}

fn hertz_gravity(case: &mut Report) {
    let [g, m, k, h] = case.params(["g", "m", "k", "h"]);
    let ball = Compliant::new(m, g, Hertz::new(k).unwrap()).unwrap();
    let run = tight(case, &ball, ball.released(h, 0.0), 2.5);
    let contacts = ball.contacts(&run.trajectory);
    case.check("t_contact_1", contacts[0].touch);
    case.check("contact_duration", contacts[0].duration.unwrap());
    case.check("penetration_max", contacts[0].deformation);
    let jumps = run.trajectory.jumps();
    case.check("t_release_1", jumps.iter().find(|jump| jump.to == Stage::Rise).unwrap().t());
    case.check("t_contact_4", contacts[3].touch);
    let apexes: Vec<_> = jumps.iter().filter(|jump| jump.edge() == Some(Moment::Apex)).collect();
    case.check("apex_3", apexes[2].before[0]);
    assert!(run.end.stats.steps < 500 * contacts.len() as u64, "{:?}", run.end.stats);
}

/// (B) without tension and (A) with it.
fn kelvin_voigt(case: &mut Report) {
    let [m, k, c, v] = case.params(["m", "k", "c", "v"]);
    let law = KelvinVoigt::new(k, c).unwrap();
    case.check("zeta", law.damping_ratio(m));
    let (run, contact) = hit(case, law);
    assert_eq!((run.end.stats.steps, run.end.mode), (0, Stage::Rise));
    let closed = law.collision(m, v).unwrap();
    case.check("B_d_release", -released(&run)[0]);
    case.check("B_d_release", law.after(closed.duration, [0.0, v], m, 0.0)[0]);
    for (duration, compression, deformation, cor) in [
        (contact.duration.unwrap(), contact.compression.unwrap(), contact.deformation, contact.cor.unwrap()),
        (closed.duration, closed.compression, closed.deformation, closed.cor.value()),
    ] {
        case.check("t_max", compression);
        case.check("d_max", deformation);
        case.check("B_t_release", duration);
        case.check("B_cor", cor);
    }
    let (run, contact) = hit(case, law.with_tension());
    let closed = law.with_tension().collision(m, v);
    if case.case.id == "kv-critical" {
        assert_eq!(run.end.mode, Stage::Restitution);
        case.check("A_n_release", f64::from(u8::from(contact.duration.is_some())));
        case.check("A_n_release", f64::from(u8::from(closed.is_some())));
    } else {
        let closed = closed.unwrap();
        for (duration, cor) in
            [(contact.duration.unwrap(), contact.cor.unwrap()), (closed.duration, closed.cor.value())]
        {
            case.check("A_t_release", duration);
            case.check("A_cor", cor);
        }
    }
}

fn kelvin_voigt_soft(case: &mut Report) {
    kelvin_voigt(case);
}

fn kelvin_voigt_hard(case: &mut Report) {
    kelvin_voigt(case);
}

fn kelvin_voigt_critical(case: &mut Report) {
    kelvin_voigt(case);
}

fn kelvin_voigt_settles(case: &mut Report) {
    let [g, m, k, c, h] = case.params(["g", "m", "k", "c", "h"]);
    let ball = Compliant::new(m, g, KelvinVoigt::new(k, c).unwrap().with_tension()).unwrap();
    let (stage, start) = ball.released(h, 0.0);
    let run = Simulation::of(&ball).run(stage, start, 0.0..5.0).unwrap();
    case.ran(&run.end.stats);
    let contacts = ball.contacts(&run.trajectory);
    case.check("n_contacts", contacts.len() as f64);
    case.check("t_contact_1", contacts[0].touch);
    case.check("x_min_1", -contacts[0].deformation);
    case.check("v_contact_2", -contacts[1].speed);
    case.check("t_contact_2", contacts[1].touch);
    case.check("t_contact_5", contacts[4].touch);
    case.check("t_contact_last", contacts[6].touch);
    case.check("x(5)", run.end.state[0]);
    case.check("x_static", run.end.state[0]);
    assert_eq!((run.end.mode, run.end.stop, run.end.stats.steps), (Stage::Lying, Stop::Time, 0));
    assert_eq!((contacts[6].cor, contacts[6].duration), (None, None));
    // The first upswing of the last contact, within a period of a fifteenth of a second.
    let after = (100..700).filter_map(|n| run.trajectory.at(contacts[6].touch + 1e-4 * f64::from(n)));
    case.check("last_upswing", after.map(|x| x[0]).fold(f64::NEG_INFINITY, f64::max));
}

fn hunt_crossley(case: &mut Report) {
    let [m, k, chi, v] = case.params(["m", "k", "chi", "v"]);
    let law = HuntCrossley::new(k, chi).unwrap();
    let (run, contact) = hit(case, law);
    assert!(run.end.stats.steps < 500, "{:?}", run.end.stats);
    let closed = law.collision(m, v).unwrap();
    case.check("dim_less_damping", chi * v / k);
    case.check("u_out", -released(&run)[1]);
    case.check("u_out", -closed.cor.rebound(v));
    for (duration, compression, deformation, cor) in [
        (contact.duration.unwrap(), contact.compression.unwrap(), contact.deformation, contact.cor.unwrap()),
        (closed.duration, closed.compression, closed.deformation, closed.cor.value()),
    ] {
        case.check("cor", cor);
        case.check("d_max", deformation);
        case.check("t_max", compression);
        case.check("t_release", duration);
    }
}

fn hunt_crossley_light(case: &mut Report) {
    hunt_crossley(case);
}

fn hunt_crossley_strong(case: &mut Report) {
    hunt_crossley(case);
}
