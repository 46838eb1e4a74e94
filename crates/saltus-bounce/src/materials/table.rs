//! The presets themselves: data, one row each.

use super::Preset;

/// The numbers of a source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Evidence {
    /// A height of drop in m and the least and greatest height of the rebound, all of the ball's
    /// lowest point: e = √(rebound/drop).
    Rebound { drop: f64, rebound: [f64; 2] },
    /// The least and greatest coefficient found, and the speeds in m/s at which.
    Measured { cor: [f64; 2], speeds: Option<[f64; 2]> },
}

const fn rule(
    ball: &'static str,
    floor: &'static str,
    drop: f64,
    rebound: [f64; 2],
    note: &'static str,
    source: &'static str,
) -> Preset {
    Preset { ball, floor, evidence: Evidence::Rebound { drop, rebound }, note, source }
}

const fn measured(
    ball: &'static str,
    floor: &'static str,
    cor: [f64; 2],
    speeds: Option<[f64; 2]>,
    note: &'static str,
    source: &'static str,
) -> Preset {
    Preset { ball, floor, evidence: Evidence::Measured { cor, speeds }, note, source }
}

pub(super) const PRESETS: [Preset; 15] = [
    rule(
        "tennis ball",
        "granite",
        2.54,
        [1.35, 1.47],
        "rule: 254 cm to 135-147 cm",
        "International Tennis Federation, ball approval, rebound test, itftennis.com",
    ),
    rule(
        "high-altitude tennis ball",
        "granite",
        2.54,
        [1.22, 1.35],
        "rule: 254 cm to 122-135 cm",
        "International Tennis Federation, ball approval, rebound test, itftennis.com",
    ),
    measured(
        "tennis ball",
        "stoneware tile",
        [0.73, 0.78],
        Some([2.2, 3.6]),
        "measured by sound, falling with the speed",
        "evaluation of recordings at github.com/giiulia/LabI-Dynamics-Thermodynamics",
    ),
    rule(
        "table-tennis ball",
        "steel",
        0.305,
        [0.24, 0.26],
        "rule for 40 mm balls: 30.5 cm to 24-26 cm",
        "International Table Tennis Federation, rule for balls, at second hand",
    ),
    rule(
        "table-tennis ball",
        "table",
        0.30,
        [0.23, 0.23],
        "rule for tables: 30 cm to about 23 cm",
        "International Table Tennis Federation, Technical Leaflet T1",
    ),
    rule(
        "football",
        "steel",
        2.0,
        [1.15, 1.65],
        "rule, FIFA Quality: 200 cm to 115-165 cm, ten drops within 10 cm of each other",
        "FIFA Quality Programme, quoted at adsport.sk",
    ),
    rule(
        "football pro",
        "steel",
        2.0,
        [1.20, 1.65],
        "rule, FIFA Quality Pro: 200 cm to 120-165 cm, ten drops within 10 cm of each other",
        "FIFA Quality Programme, quoted at adsport.sk",
    ),
    rule(
        "futsal ball",
        "hard floor",
        2.0,
        [0.50, 0.65],
        "rule: 200 cm to 50-65 cm; surface not stated",
        "futsal rules quoted at familysweeps.net",
    ),
    rule(
        "basketball",
        "court",
        1.80,
        [0.96, 1.16],
        "rule: 180 cm (bottom of the ball) to 120-140 cm (top of the ball), a diameter of 24 cm taken off",
        "basketball rules quoted at library.thinkquest.org/10615",
    ),
    measured(
        "leather basketball",
        "hard floor",
        [0.81, 0.85],
        None,
        "measured, 0.81 from 1.31 m; surface not stated",
        "University of Texas at Arlington, Department of Physics, uta.edu/physics/mavballs",
    ),
    measured(
        "synthetic basketball",
        "hard floor",
        [0.79, 0.84],
        None,
        "measured; surface not stated",
        "University of Texas at Arlington, Department of Physics, uta.edu/physics/mavballs",
    ),
    measured(
        "golf ball",
        "marble",
        [0.894, 0.900],
        Some([0.65, 4.15]),
        "measured by sound, twenty launches",
        "evaluation of recordings at github.com/giiulia/LabI-Dynamics-Thermodynamics",
    ),
    rule(
        "golf ball",
        "hard floor",
        0.92,
        [0.66, 0.70],
        "measured: 92 cm to 66-70 cm; surface not stated",
        "school experiment reported at socratic.org",
    ),
    rule(
        "steel ball",
        "hard floor",
        0.92,
        [0.32, 0.34],
        "measured: 92 cm to 32-34 cm; surface not stated",
        "school experiment reported at socratic.org",
    ),
    measured(
        "glass marble",
        "hard floor",
        [0.92, 0.93],
        None,
        "measured by sound, three marbles; surface not stated",
        "J. Pebralia, Int. J. Appl. Sci. Smart Technol. 4, 35 (2022)",
    ),
];
