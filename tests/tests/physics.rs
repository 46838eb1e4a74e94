//! The laws of flight and contact in closed form against reference values.

#![allow(clippy::unwrap_used)] // a test that cannot go on has failed

use nalgebra::{Vector2, vector};
use saltus_bounce::Cor;
use saltus_bounce::contact::{ContactLaw, Hertz, HuntCrossley, KelvinVoigt};
use saltus_bounce::flight::{LinearDragFlight, QuadraticDragFlight, VerticalFlight};
use saltus_tests::reference::Case;

/// A ball that bounces in the air: impacts, speeds at impact, the height of the first rebound and when the bounces end.
struct Bounces {
    times: Vec<f64>,
    speeds: Vec<f64>,
    rise: f64,
    end: f64,
}

/// Each flight from its own closed form, their durations added with compensation until they no longer count.
fn bounces(flight: &impl VerticalFlight, e: Cor, start: Vector2<f64>) -> Bounces {
    let (mut times, mut speeds, mut rise) = (Vec::new(), Vec::new(), 0.0);
    let (mut sum, mut carry, mut x) = (0.0, 0.0, start);
    while x[1] > 1e-20 || times.is_empty() {
        let impact = flight.impact(&x).unwrap();
        let next: f64 = sum + (impact.time + carry);
        carry += impact.time - (next - sum);
        sum = next;
        times.push(sum);
        speeds.push(impact.speed);
        x = vector![0.0, e.rebound(impact.speed)];
        if times.len() == 1 {
            rise = flight.apex(x[1]).unwrap().rise;
        }
    }
    Bounces { times, speeds, rise, end: sum }
}

fn with_quadratic_drag(name: &str, last: usize) {
    let case = Case::named(name);
    let flight = QuadraticDragFlight::new(case.param("g"), case.param("k")).unwrap();
    let run = bounces(&flight, Cor::new(case.param("e")).unwrap(), vector![case.param("h"), 0.0]);
    case.check("t_1", run.times[0]);
    case.check("v_pre_1", -run.speeds[0]);
    case.check("apex_1", run.rise);
    case.check(&format!("t_{last}"), run.times[last - 1]);
    case.check(&format!("v_pre_{last}"), -run.speeds[last - 1]);
    case.check("t_zeno", run.end);
}

#[test]
fn quadratic_drag() {
    with_quadratic_drag("qdrag-moderate", 6);
    with_quadratic_drag("qdrag-strong", 4);
}

#[test]
fn linear_drag() {
    for name in ["ldrag-moderate", "ldrag-weak"] {
        let case = Case::named(name);
        let flight = LinearDragFlight::new(case.param("g"), case.param("c")).unwrap();
        let run = bounces(&flight, Cor::new(case.param("e")).unwrap(), vector![case.param("h"), 0.0]);
        case.check("t_1", run.times[0]);
        case.check("v_pre_1", -run.speeds[0]);
        case.check("t_2", run.times[1]);
        case.check("t_6", run.times[5]);
        case.check("v_pre_6", -run.speeds[5]);
        case.check("t_zeno", run.end);
    }
}

#[test]
fn hertz_contact() {
    for name in ["hertz-1e3", "hertz-1e9", "hertz-1e12"] {
        let case = Case::named(name);
        let (m, v, k) = (case.param("m"), case.param("v"), case.param("k"));
        let hit = Hertz::new(k).unwrap().collision(m, v).unwrap();
        case.check("t_release", hit.duration);
        case.check("t_max", hit.compression);
        case.check("d_max", hit.deformation);
        case.check("F_max", hit.force);
        case.check("u_out", -hit.cor.rebound(v));
        case.check("separation(1)", (1.0 - hit.duration) * hit.cor.rebound(v));
        case.check("const_A", hit.duration / (m * m / (k * k * v)).powf(0.2));
        case.check("const_2.94", hit.duration * v / hit.deformation);
    }
}

#[test]
fn kelvin_voigt_contact() {
    for name in ["kv-soft", "kv-hard", "kv-critical"] {
        let case = Case::named(name);
        let (m, k, c, v) = (case.param("m"), case.param("k"), case.param("c"), case.param("v"));
        let law = KelvinVoigt::new(k, c).unwrap();
        let hit = law.collision(m, v).unwrap();
        case.check("zeta", law.damping_ratio(m));
        case.check("B_t_release", hit.duration);
        case.check("B_cor", hit.cor.value());
        case.check("B_d_release", law.after(hit.duration, [0.0, v], m, 0.0)[0]);
        case.check("t_max", hit.compression);
        case.check("d_max", hit.deformation);
        let sticky = law.with_tension().collision(m, v);
        if name == "kv-critical" {
            case.check("A_n_release", f64::from(u8::from(sticky.is_some())));
        } else {
            let sticky = sticky.unwrap();
            case.check("A_t_release", sticky.duration);
            case.check("A_cor", sticky.cor.value());
        }
    }
}

/// Flights and contacts in turn, each from its closed form: the ball hops seven times and then stays on the floor.
#[test]
fn a_ball_settles_on_a_spring() {
    let case = Case::named("kv-settle");
    let (g, m, k, h) = (case.param("g"), case.param("m"), case.param("k"), case.param("h"));
    let law = KelvinVoigt::new(k, case.param("c")).unwrap();
    let after = |s: f64, v: f64| law.after(s, [0.0, v], m, m * g);
    // The last s at which the sign of f is that at the start, by halving.
    let halve = |f: &dyn Fn(f64) -> f64, mut low: f64, mut high: f64| {
        while low < 0.5 * (low + high) && 0.5 * (low + high) < high {
            let middle = 0.5 * (low + high);
            if (f(middle) > 0.0) == (f(low) > 0.0) { low = middle } else { high = middle }
        }
        low
    };
    let (mut t, mut v, mut contacts) = ((2.0 * h / g).sqrt(), (2.0 * g * h).sqrt(), 0);
    let stays = loop {
        contacts += 1;
        match contacts {
            1 => {
                case.check("t_contact_1", t);
                let deepest = halve(&|s| after(s, v)[1], 1e-9, 0.02);
                case.check("x_min_1", -after(deepest, v)[0]);
            }
            2 => {
                case.check("t_contact_2", t);
                case.check("v_contact_2", -v);
            }
            5 => case.check("t_contact_5", t),
            _ => {}
        }
        // The greatest height of the contact, where the velocity turns from upwards to downwards.
        let deepest = halve(&|s| after(s, v)[1], 1e-9, 0.03);
        let highest = halve(&|s| after(s, v)[1], deepest + 1e-9, deepest + 0.03);
        if after(highest, v)[0] > 0.0 {
            break v;
        }
        let release = halve(&|s| after(s, v)[0], deepest, highest);
        v = -after(release, v)[1];
        t += release + 2.0 * v / g;
    };
    case.check("n_contacts", f64::from(contacts));
    case.check("t_contact_last", t);
    case.check("x(5)", -after(5.0 - t, stays)[0]);
    case.check("x_static", -m * g / k);
}

#[test]
fn hunt_crossley_contact() {
    for name in ["hunt-crossley", "hunt-crossley-strong"] {
        let case = Case::named(name);
        let (m, k, chi, v) = (case.param("m"), case.param("k"), case.param("chi"), case.param("v"));
        let hit = HuntCrossley::new(k, chi).unwrap().collision(m, v).unwrap();
        case.check("dim_less_damping", chi * v / k);
        case.check("cor", hit.cor.value());
        case.check("u_out", -hit.cor.rebound(v));
        case.check("d_max", hit.deformation);
        case.check("t_max", hit.compression);
        case.check("t_release", hit.duration);
    }
}
