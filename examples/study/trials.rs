//! Ten drops that never were: the film of each is simulated, since the study gives means only.
//!
//! The COR differs from drop to drop, the shutter opens when it likes, heights are read to the
//! centimetre and times to the frame.

use std::error::Error;
use std::fmt::Write as _;

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};
use saltus::Simulation;
use saltus_bounce::{Ball, Cor, Mode};
use saltus_fit::{Fit, ReadOptions, Report, Table};

use super::film::{Camera, read};

/// What the drops have in common.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// The height of release in m.
    pub drop: f64,
    /// In m/s².
    pub gravity: f64,
    /// The mean COR.
    pub cor: f64,
    /// How far the COR of a drop is from the mean at most; all within are equally likely.
    pub spread: f64,
    /// What films it.
    pub camera: Camera,
}

/// One drop as it was read: heights in m, times in s from the last frame in which the ball had not
/// moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Trial {
    /// The COR it was made with.
    pub cor: f64,
    /// Three contacts.
    pub contacts: [f64; 3],
    /// Two rebounds.
    pub rebounds: [f64; 2],
}

impl Plan {
    /// `count` drops; the same seed gives the same drops.
    ///
    /// # Errors
    /// If a film shows fewer than three contacts.
    pub fn drops(&self, count: usize, seed: u64) -> Result<Vec<Trial>, Box<dyn Error>> {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let mut share = || random.next_u64() as f64 / 2.0_f64.powi(64);
        (0..count).map(|_| self.drop(self.cor + self.spread * (2.0 * share() - 1.0), share())).collect()
    }

    /// One drop with the COR `cor`, whose first frame after the release comes a share `shutter` of
    /// a frame after it, 0 ≤ `shutter` < 1.
    ///
    /// # Errors
    /// If the film shows fewer than three contacts.
    pub fn drop(&self, cor: f64, shutter: f64) -> Result<Trial, Box<dyn Error>> {
        let ball = Ball::new(self.gravity, Cor::new(cor)?)?;
        let end = 4.0 * (2.0 * self.drop / self.gravity).sqrt();
        let path = Simulation::of(&ball).run(Mode::Flight, Ball::dropped_from(self.drop), 0.0..end)?.trajectory;
        let first = shutter * self.camera.frame();
        let frames: Vec<_> = self.camera.film(first, end, |t| path.at(t)).collect();
        let seen = read(&frames);
        let ([first_contact, second, third, ..], [one, two, ..]) = (&seen.contacts[..], &seen.apexes[..]) else {
            return Err("the film shows fewer than three contacts".into());
        };
        let still = first - self.camera.frame();
        let centimetre = |apex: &[f64; 2]| (100.0 * apex[1]).round() / 100.0;
        let contacts = [first_contact, second, third].map(|contact| contact[0] - still);
        Ok(Trial { cor, contacts, rebounds: [centimetre(one), centimetre(two)] })
    }

    /// All drops as one table, each a trial of its own. When a ball was let go its film does not
    /// tell: that cell is empty.
    ///
    /// # Errors
    /// If the table cannot be fitted.
    pub fn pooled(&self, trials: &[Trial]) -> Result<Report, Box<dyn Error>> {
        let mut rows = String::from("trial,event,time_s,height_cm\n");
        for (number, trial) in (1..).zip(trials) {
            self.rows(&mut rows, &format!("{number},"), "", trial);
        }
        self.fitted("ten drops", &rows)
    }

    /// One table of means, as the study has it; time zero is the last frame in which the ball has
    /// not moved. That this is the moment of release may be believed (`timed`) or not.
    ///
    /// # Errors
    /// If the table cannot be fitted.
    pub fn averaged(&self, trials: &[Trial], timed: bool) -> Result<Report, Box<dyn Error>> {
        let mut rows = String::from("event,time_s,height_cm\n");
        self.rows(&mut rows, "", if timed { "0" } else { "" }, &mean(trials));
        self.fitted("means of ten drops", &rows)
    }

    fn rows(&self, rows: &mut String, trial: &str, release: &str, Trial { contacts: [a, b, c], rebounds, .. }: &Trial) {
        let [one, two] = rebounds.map(|h| 100.0 * h);
        _ = write!(
            rows,
            "{trial}release,{release},{}\n{trial}contact,{a},\n{trial}apex,,{one}\n\
             {trial}contact,{b},\n{trial}apex,,{two}\n{trial}contact,{c},\n",
            100.0 * self.drop,
        );
    }

    fn fitted(&self, name: &str, rows: &str) -> Result<Report, Box<dyn Error>> {
        let table = format!("# frame rate: {}\n# gravity: {} m/s^2\n{rows}", self.camera.rate, self.gravity);
        Ok(Fit::new().run(&Table::parse(name, table.as_bytes(), &ReadOptions::default())?)?)
    }
}

/// The mean of each reading.
#[must_use]
pub fn mean(trials: &[Trial]) -> Trial {
    let mean = |of: &dyn Fn(&Trial) -> f64| trials.iter().map(of).sum::<f64>() / trials.len().max(1) as f64;
    Trial {
        cor: mean(&|trial| trial.cor),
        contacts: [0, 1, 2].map(|k| mean(&|trial| trial.contacts[k])),
        rebounds: [0, 1].map(|k| mean(&|trial| trial.rebounds[k])),
    }
}

/// The two CORs that the means of exact heights show, √⟨e²⟩ and √(⟨e⁴⟩/⟨e²⟩), for drops with the
/// CORs `cors`, all above zero.
///
/// Never less than the mean of the CORs, and the second never less than the first: averaging makes
/// a COR seem to grow from bounce to bounce.
#[must_use]
pub fn of_mean_heights(cors: &[f64]) -> [f64; 2] {
    let mean = |power: i32| cors.iter().map(|e| e.powi(power)).sum::<f64>() / cors.len() as f64;
    [mean(2).sqrt(), (mean(4) / mean(2)).sqrt()]
}
