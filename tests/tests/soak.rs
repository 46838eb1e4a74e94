//! Random scenes, of everything a scene file may say: each is refused with a reason or runs to a named end, and keeps the laws it has to keep.
//!
//! A few thousand run with the tests; a soak is `SOAK=1000000 cargo test --release -p saltus-tests --test soak -- --nocapture`, which ends in a
//! summary and takes about an hour and a half on two cores. `SOAK_FROM` is the number of the first scene: any that fails is run again by
//! `SOAK=1 SOAK_FROM=<its number>`.

#![allow(clippy::unwrap_used, clippy::panic, clippy::print_stdout)] // a test that cannot go on has failed; a soak is watched

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::ops::ControlFlow;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use saltus_bounce::scene::Scene;
use saltus_bounce::scene::plan::{End, Moment, Record};

/// What is drawn from the stream of one scene.
struct Dice(ChaCha8Rng);

impl Dice {
    fn new(scene: u64) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(20_261_121);
        random.set_stream(scene);
        Self(random)
    }

    fn unit(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * 2.0_f64.powi(-53)
    }

    fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// By equal factors.
    fn about(&mut self, low: f64, high: f64) -> f64 {
        (self.between(low.ln(), high.ln())).exp()
    }

    fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[(self.0.next_u64() % of.len() as u64) as usize]
    }
}

/// A scene, and what holds in it.
struct Made {
    toml: String,
    gravity: f64,
    /// The floor that nothing sinks through.
    floor: Option<f64>,
    /// Whether energy can only be lost.
    loses: bool,
    /// By how much steps may be off, relatively.
    tolerance: f64,
    masses: Vec<f64>,
    /// I/m of the ball that may spin.
    inertia: f64,
}

/// The scene of a number.
fn made(number: u64) -> Made {
    let dice = &mut Dice::new(number);
    let dimensions = dice.pick(&[1, 1, 1, 2, 2, 3]);
    let gravity = if dice.chance(0.02) { 0.0 } else { dice.pick(&[9.80665, 9.81, 1.62, 24.8]) };
    let mut toml = format!("gravity = {gravity:?}\n");
    let compliant = dimensions == 1 && dice.chance(0.1);
    let balls = if !compliant && dice.chance(0.15) { dice.pick(&[2, 3, 4]) } else { 1 };
    let mut loses = true;
    if !compliant {
        writeln!(toml, "restitution = {}", restitution(dice)).unwrap();
    }
    if !compliant && balls == 1 && dimensions > 1 && dice.chance(0.4) {
        let coefficient = dice.pick(&[0.0, 0.1, 0.5, 2.0]);
        writeln!(toml, "friction = {{ coefficient = {coefficient:?}, gripping = {:?} }}", dice.pick(&[0.0, 0.3, 1.0]))
            .unwrap();
    }
    let buoyant = dice.chance(0.1);
    if buoyant {
        loses = false;
        writeln!(toml, "buoyancy = true\nadded_mass = {}", dice.chance(0.5)).unwrap();
    }
    let radius = dice.about(1e-3, 0.2);
    let spins = dimensions > 1 && balls == 1 && !compliant && dice.chance(0.4);
    let mut masses = Vec::new();
    let mut ball_tables = String::new();
    for ball in 0..balls {
        let mass = dice.about(1e-4, 10.0);
        masses.push(mass);
        let head = if balls == 1 { "[ball]" } else { "[[ball]]" };
        write!(
            ball_tables,
            "{head}\nradius = {radius:?}\nmass = {mass:?}\nshape = \"{}\"\n",
            dice.pick(&["solid", "hollow"])
        )
        .unwrap();
        let height =
            dice.pick(&[0.0, 0.01, 1.0]) * dice.about(0.5, 2.0) + ball as f64 * dice.between(2.0, 2.5) * radius;
        let mut speed = || if dice.chance(0.3) { 0.0 } else { dice.between(-5.0, 5.0) };
        let velocity = [speed(), speed(), speed()];
        match dimensions {
            1 => writeln!(ball_tables, "height = {height:?}\nvelocity = {:?}", velocity[0]).unwrap(),
            2 => writeln!(
                ball_tables,
                "position = [{:?}, {:?}]\nvelocity = {:?}",
                0.1 * ball as f64,
                height + radius,
                &velocity[..2]
            )
            .unwrap(),
            _ => writeln!(
                ball_tables,
                "position = [{:?}, 0.0, {:?}]\nvelocity = {velocity:?}",
                0.1 * ball as f64,
                height + radius
            )
            .unwrap(),
        }
        if spins {
            let spin = dice.between(-100.0, 100.0);
            if dimensions == 2 {
                writeln!(ball_tables, "spin = {spin:?}")
            } else {
                writeln!(ball_tables, "spin = [{spin:?}, 1.0, 0.0]")
            }
            .unwrap();
        }
    }
    let (floors, floor, still) = floors(dice, dimensions, radius);
    loses &= still;
    let mut more = if balls > 1 || compliant { String::new() } else { air(dice, dimensions, spins, &mut loses) };
    // What is pressed in is below the floor.
    let floor = floor.filter(|_| !compliant);
    if compliant {
        more += &contact(dice);
        loses = false;
    }
    let mut tolerance = 1e-9;
    let until = dice.between(0.1, 4.0);
    writeln!(more, "[run]\nuntil = {until:?}\nmost_jumps = {}", dice.pick(&[3, 200])).unwrap();
    if dice.chance(0.3) {
        tolerance = dice.about(1e-12, 1e-4);
        writeln!(more, "tolerance = {tolerance:e}\nstepper = \"{}\"", dice.pick(&["tsit5", "dop853", "rodas5p"]))
            .unwrap();
    }
    let inertia = if ball_tables.contains("hollow") { 2.0 / 3.0 } else { 0.4 } * radius * radius;
    Made { toml: toml + &ball_tables + &floors + &more, gravity, floor, loses, tolerance, masses, inertia }
}

fn restitution(dice: &mut Dice) -> String {
    match dice.pick(&[0, 0, 0, 1, 2, 3, 4, 5]) {
        0 => format!("{:?}", dice.between(0.0, 1.0)),
        1 => dice.pick(&["0.0", "1.0", "0.5", "1e-9", "0.999999"]).to_owned(),
        2 => format!("{{ law = \"linear\", cor = {:?}, slope = -0.05, fastest = 8.0 }}", dice.between(0.5, 1.0)),
        3 => format!("{{ law = \"knots\", knots = [[1.0, 0.9], [{:?}, 0.4]] }}", dice.between(2.0, 9.0)),
        4 => format!("{{ law = \"viscoelastic\", cor = {:?}, speed = 2.0 }}", dice.between(0.5, 0.95)),
        _ => format!("{{ law = \"plastic\", cor = {:?}, speed = 2.0 }}", dice.between(0.3, 0.9)),
    }
}

/// Floors, the height nothing falls below if there is one, and whether all stand still.
fn floors(dice: &mut Dice, dimensions: usize, radius: f64) -> (String, Option<f64>, bool) {
    if dimensions == 1 {
        return match dice.pick(&[0, 0, 0, 1, 2, 3]) {
            0 => (String::new(), Some(0.0), true),
            1 => ("floor = { height = -0.5 }\n".to_owned(), Some(-0.5), true),
            2 => {
                let (amplitude, frequency) = (dice.about(1e-5, 0.05), dice.about(0.5, 60.0));
                (
                    format!("[floor]\nmotion = {{ amplitude = {amplitude:?}, frequency = {frequency:?} }}\n"),
                    Some(-amplitude),
                    false,
                )
            }
            _ => (
                format!("[floor]\nmotion = {{ schedule = [[0.0, 0.0], [{:?}, 0.1]] }}\n", dice.between(0.2, 2.0)),
                Some(0.0),
                false,
            ),
        };
    }
    let wall = format!("[[floor]]\nkind = \"wall\"\nat = {:?}\n", dice.between(1.5, 4.0));
    let (text, floor) = match dice.pick(&[0, 1, 2, 3, 4, 5, 6]) {
        0 => (String::new(), Some(0.0)),
        1 => (format!("[[floor]]\n{wall}"), Some(0.0)),
        2 => (format!("[[floor]]\nkind = \"incline\"\nangle = {:?}\n", dice.between(-0.6, 0.6)), None),
        3 => {
            let (tread, rise) = (dice.between(0.1, 1.0), dice.between(0.01, 0.3));
            (format!("[[floor]]\nkind = \"stairs\"\nfrom = 0.3\ntread = {tread:?}\nrise = {rise:?}\n"), None)
        }
        4 => (format!("[[floor]]\nkind = \"box\"\nsize = {:?}\n", &[12.0, 8.0, 8.0][3 - dimensions..]), Some(0.0)),
        5 => (
            format!("[[floor]]\nkind = \"parabola\"\ncurvature = {:?}\n", dice.between(-0.5, 0.5 / (1.0 + radius))),
            None,
        ),
        _ => {
            (format!("[[floor]]\nkind = \"sine\"\namplitude = 0.05\nwavelength = {:?}\n", dice.between(1.5, 4.0)), None)
        }
    };
    (text, floor, true)
}

fn air(dice: &mut Dice, dimensions: usize, spins: bool, loses: &mut bool) -> String {
    let mut air = String::new();
    if dice.chance(0.5) {
        return air;
    }
    let drag = match dice.pick(&[0, 1, 2, 3]) {
        0 => format!("rate = {:?}", dice.about(1e-3, 5.0)),
        1 => format!("per_length = {:?}", dice.about(1e-3, 5.0)),
        2 => format!("rate = {:?}\nper_length = {:?}", dice.about(1e-3, 5.0), dice.about(1e-3, 5.0)),
        _ => format!("coefficient = {:?}", dice.between(0.1, 1.0)),
    };
    writeln!(air, "[drag]\n{drag}").unwrap();
    if dimensions > 1 && dice.chance(0.3) {
        *loses = false;
        writeln!(air, "[air]\nwind = {:?}", dice.between(-8.0, 8.0)).unwrap();
    }
    if spins && dice.chance(0.4) {
        writeln!(air, "[magnus]\nslope = {:?}", dice.between(0.2, 1.5)).unwrap();
    }
    if spins && dice.chance(0.3) {
        writeln!(air, "[spin_decay]\ntime = {:?}", dice.between(1.0, 20.0)).unwrap();
    }
    air
}

fn contact(dice: &mut Dice) -> String {
    let stiffness = dice.about(1e3, 1e9);
    match dice.pick(&[0, 1, 2, 3]) {
        0 => format!(
            "[contact]\nlaw = \"kelvin-voigt\"\nstiffness = {stiffness:?}\ndamping = {:?}\n",
            dice.about(0.01, 10.0)
        ),
        1 => format!("[contact]\nlaw = \"kelvin-voigt\"\ncor = {:?}\ntime = 0.004\n", dice.between(0.3, 0.95)),
        2 => format!("[contact]\nlaw = \"hertz\"\nstiffness = {stiffness:?}\n"),
        _ => format!(
            "[contact]\nlaw = \"hunt-crossley\"\nstiffness = {stiffness:?}\ncor = {:?}\nspeed = 2.0\n",
            dice.between(0.3, 0.95)
        ),
    }
}

/// How a scene ended, for the summary; or the law it breaks.
fn lived(made: &Made) -> Result<String, String> {
    let scene = match Scene::parse("soak.toml", made.toml.as_bytes()) {
        Ok(scene) => scene,
        Err(error) => return Ok(format!("refused: {}", kind(error.message()))),
    };
    let plan = match scene.plan() {
        Ok(plan) => plan,
        Err(error) => return Ok(format!("refused: {}", kind(&error.to_string()))),
    };
    let record = plan.run().map_err(|error| format!("failed: {error}"))?;
    sound(made, &record)?;
    let doubts = if record.doubts().is_empty() { "" } else { ", in doubt" };
    Ok(format!("{}: {}{doubts}", plan.explain().model, ending(record.end())))
}

/// A message without its numbers and names.
fn kind(message: &str) -> String {
    let message = message.lines().next().unwrap_or_default();
    let plain: String = message.chars().map(|c| if c.is_ascii_digit() { '#' } else { c }).collect();
    plain.split([',', ':', '`', '\'']).next().unwrap_or_default().trim().to_owned()
}

const fn ending(end: End) -> &'static str {
    match end {
        End::Time => "to its end",
        End::Jumps { .. } => "most jumps",
        End::Zeno { .. } => "at rest among others",
        _ => "given up",
    }
}

/// Whether the run keeps to what has to hold.
fn sound(made: &Made, record: &Record) -> Result<(), String> {
    let until = record.until();
    let slack = 1e-9 + 1e3 * made.tolerance;
    let mut last = 0.0;
    for event in record.events() {
        if !(last..=until).contains(&event.t) {
            return Err(format!("an event at {} after one at {last}, in a run until {until}", event.t));
        }
        last = event.t;
        if made.loses {
            let energy = |of: &dyn Fn(&saltus_bounce::scene::plan::Sides) -> Moment| -> f64 {
                event.sides.iter().map(|side| made.masses[side.ball] * kinetic(made, &of(side))).sum()
            };
            let (before, after) = (energy(&|side| side.before), energy(&|side| side.after));
            if after > before * (1.0 + 1e-9) + 1e-12 {
                return Err(format!("energy rises from {before} to {after} at {} ({})", event.t, event.edge));
            }
        }
    }
    for impact in record.impacts() {
        if !(0.0..=until).contains(&impact.t) || impact.approach < 0.0 {
            return Err(format!("an impact at {} in a run until {until}", impact.t));
        }
    }
    let mut most = vec![f64::INFINITY; record.balls()];
    for step in 0..=64 {
        let t = until * f64::from(step) / 64.0;
        let mut total = 0.0;
        for ball in 0..record.balls() {
            let Some(moment) = record.at(ball, t) else {
                return Err(format!("nothing is known of ball {ball} at {t}"));
            };
            if !(moment.position.iter().chain(moment.velocity.iter()).all(|x| x.is_finite())) {
                return Err(format!("ball {ball} is nowhere at {t}"));
            }
            if made.floor.is_some_and(|floor| moment.height() < floor - slack * (1.0 + moment.velocity.norm())) {
                return Err(format!("ball {ball} is at {} at {t}, below the floor", moment.height()));
            }
            total += made.masses[ball] * (kinetic(made, &moment) + made.gravity * moment.height());
        }
        if made.loses {
            let size = made.masses.iter().sum::<f64>() * (1.0 + made.gravity);
            if total > most[0] + slack * (size + most[0].abs()) {
                return Err(format!("energy rises from {} to {total} at {t}", most[0]));
            }
            most[0] = most[0].min(total);
        }
    }
    Ok(())
}

/// Kinetic energy for each kilogram.
fn kinetic(made: &Made, moment: &Moment) -> f64 {
    0.5 * (moment.velocity.norm_squared() + made.inertia * moment.spin.norm_squared())
}

#[test]
fn random_scenes_keep_the_laws() {
    let number = |name: &str| std::env::var(name).ok().and_then(|text| text.parse::<usize>().ok());
    let (count, from) = (number("SOAK").unwrap_or(2000), number("SOAK_FROM").unwrap_or(0));
    let mut summary: BTreeMap<String, usize> = BTreeMap::new();
    let mut broken: Vec<(usize, String)> = Vec::new();
    let run = |k: usize| {
        let made = made(k as u64);
        lived(&made).map_err(|says| format!("{says}\n{}", made.toml))
    };
    let _: ControlFlow<()> = saltus::ensemble(from..from + count, run, |k, lived| {
        match lived {
            Ok(way) => *summary.entry(way).or_default() += 1,
            Err(says) => broken.push((k, says)),
        }
        if k % 100_000 == 99_999 {
            println!("{} scenes, {} broken", k + 1 - from, broken.len());
        }
        ControlFlow::Continue(())
    });
    let mut ways: Vec<_> = summary.iter().collect();
    ways.sort_by_key(|(_, count)| std::cmp::Reverse(**count));
    for (way, count) in &ways {
        println!("{count:9}  {way}");
    }
    for (k, says) in broken.iter().take(20) {
        println!("scene {k}: {says}");
    }
    assert!(
        broken.is_empty(),
        "{} of {count} scenes break a law; the first is {}: {}",
        broken.len(),
        broken[0].0,
        broken[0].1
    );
    let ran: usize = summary.iter().filter(|(way, _)| !way.starts_with("refused")).map(|(_, count)| count).sum();
    assert!(2 * ran > count, "{ran} of {count} scenes ran");
}
