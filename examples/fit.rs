//! From a table to a COR and a picture, by the library instead of the command.
//!
//! `cargo run --example fit` reads `examples/data/squash-on-cement.csv` and writes `fit.svg`.

use std::error::Error;
use std::path::Path;

use saltus_fit::{Fit, ReadOptions, Table, Verdict};
use saltus_plot::{HeightTime, Measured, Stroke};

fn main() -> Result<(), Box<dyn Error>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("data/squash-on-cement.csv");
    let table = Table::read(&path, &ReadOptions::default())?;
    let report = Fit::new().run(&table)?;
    println!("{report}");

    let motion = report.motion().ok_or("the table shows no motion")?;
    let arcs = motion.flights.iter().map(|flight| Stroke::over_time(flight.start, flight.span, flight.height.to_vec()));
    let points = report.points().iter().map(|point| Measured::new(point.time, point.height));
    let picture = HeightTime::new("A squash ball on cement").motion("one COR for all readings", arcs).measured(points);
    std::fs::write("fit.svg", picture.svg()?)?;

    assert_eq!(report.verdict(), Verdict::Doubtful);
    Ok(())
}
