//! Random scenes, of everything a scene file may say, and what holds in each.

#![allow(clippy::unwrap_used)] // text can always be written to

use std::fmt::Write as _;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// What a scene is drawn from: any source of numbers of 64 bits.
struct Dice<'a>(&'a mut dyn FnMut() -> u64);

impl Dice<'_> {
    fn unit(&mut self) -> f64 {
        ((self.0)() >> 11) as f64 * 2.0_f64.powi(-53)
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
        of[((self.0)() % of.len() as u64) as usize]
    }
}

/// A scene, and what holds in it.
#[derive(Debug)]
#[non_exhaustive]
pub struct Made {
    /// The scene, as its file would say it.
    pub toml: String,
    /// In m/s².
    pub gravity: f64,
    /// The floor that nothing sinks through.
    pub floor: Option<f64>,
    /// Whether energy can only be lost.
    pub loses: bool,
    /// By how much steps may be off, relatively.
    pub tolerance: f64,
    /// Of each ball, in kg.
    pub masses: Vec<f64>,
    /// I/m of each ball, in m².
    pub inertia: Vec<f64>,
}

/// The scene of a number.
#[must_use]
pub fn numbered(number: u64) -> Made {
    let mut random = ChaCha8Rng::seed_from_u64(20_261_121);
    random.set_stream(number);
    drawn(&mut || random.next_u64())
}

/// The scene that these numbers make.
pub fn drawn(numbers: &mut dyn FnMut() -> u64) -> Made {
    let dice = &mut Dice(numbers);
    let dimensions = dice.pick(&[1, 1, 1, 2, 2, 3]);
    let gravity = if dice.chance(0.02) { 0.0 } else { dice.pick(&[9.80665, 9.81, 1.62, 24.8]) };
    let mut toml = format!("gravity = {gravity:?}\n");
    let compliant = dimensions == 1 && dice.chance(0.1);
    let balls = if !compliant && dice.chance(0.15) { dice.pick(&[2, 3, 4]) } else { 1 };
    let mut loses = true;
    if !compliant {
        writeln!(toml, "restitution = {}", restitution(dice)).unwrap();
    }
    if !compliant && dimensions > 1 && dice.chance(0.4) {
        let coefficient = dice.pick(&[0.0, 0.1, 0.5, 2.0]);
        writeln!(toml, "friction = {{ coefficient = {coefficient:?}, gripping = {:?} }}", dice.pick(&[0.0, 0.3, 1.0]))
            .unwrap();
    }
    if balls > 1 && dice.chance(0.3) {
        let coefficient = dice.pick(&[0.1, 0.5]);
        writeln!(toml, "collisions = {{ friction = {coefficient:?} }}").unwrap();
    }
    let buoyant = dice.chance(0.1);
    if buoyant {
        loses = false;
        writeln!(toml, "buoyancy = true\nadded_mass = {}", dice.chance(0.5)).unwrap();
    }
    let radius = dice.about(1e-3, 0.2);
    let spins = dimensions > 1 && !compliant && dice.chance(0.4);
    let (mut masses, mut inertia) = (Vec::new(), Vec::new());
    let mut ball_tables = String::new();
    for ball in 0..balls {
        let mass = dice.about(1e-4, 10.0);
        masses.push(mass);
        let head = if balls == 1 { "[ball]" } else { "[[ball]]" };
        let (shape, factor) = dice.pick(&[("solid", 0.4), ("hollow", 2.0 / 3.0)]);
        inertia.push(factor * radius * radius);
        write!(ball_tables, "{head}\nradius = {radius:?}\nmass = {mass:?}\nshape = \"{shape}\"\n").unwrap();
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
    let mut more = if compliant { String::new() } else { air(dice, dimensions, spins, &mut loses) };
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
    Made { toml: toml + &ball_tables + &floors + &more, gravity, floor, loses, tolerance, masses, inertia }
}

fn restitution(dice: &mut Dice<'_>) -> String {
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
fn floors(dice: &mut Dice<'_>, dimensions: usize, radius: f64) -> (String, Option<f64>, bool) {
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

fn air(dice: &mut Dice<'_>, dimensions: usize, spins: bool, loses: &mut bool) -> String {
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

fn contact(dice: &mut Dice<'_>) -> String {
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
