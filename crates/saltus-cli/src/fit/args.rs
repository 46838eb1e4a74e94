//! What can be asked of a fit.

use std::ops::Range;
use std::path::PathBuf;

use clap::Args as ClapArgs;
use saltus_bounce::units::Quantity;
use saltus_fit::{CorModel, Loss, Sound};

use crate::parse::{RATES, ReportFormat, number, positive};

/// Headers of tables that are understood.
const LAYOUTS: &str = "Layouts of tables, for example:
  event,time_s,height_cm     release, contact and apex rows
  bounce,height_cm           one height per bounce, 0 for the drop
  bounce,time (s)            one time per contact
  trial,bounce,time_ms       several trials
  time_s,height_m            a series from a film or a motion sensor

Read as they are: what Tracker, ImageJ, Vernier's and phyphox' programs write, workbooks (.xlsx, .xls), zipped CSV, tracks of bare pixels with --fps, and sounds (.wav). \
The report says what was recognised.

Reading errors come from --sigma-height and --sigma-time, from lines such as '# frame rate: 30' in the table, from the scatter, or are assumed (1 cm, \
10 ms); the report says which.";

/// Estimate the coefficient of restitution (COR) from a table or a sound of bounces.
///
/// A table holds rebound heights, contact times, both, or a series of heights in time: as CSV with
/// a header, a workbook, or what a tracking program or a telephone writes. Units stand in the
/// header. Of a sound (.wav) the contacts are read off.
#[derive(Debug, ClapArgs)]
#[command(after_help = LAYOUTS)]
pub(crate) struct Fit {
    /// The tables, whose trials are fitted together; `-` for standard input.
    #[arg(required_unless_present_any = ["values", "want"], value_name = "FILE")]
    pub(crate) tables: Vec<PathBuf>,
    /// Readings instead of a table, in order and with their unit: `"100 64 41 26 cm"`, heights from
    /// the release on, or times of contacts.
    #[arg(long, value_name = "NUMBERS UNIT", conflicts_with = "tables", allow_hyphen_values = true)]
    pub(crate) values: Option<String>,
    /// Plan the measurement that gives the COR to within this, 95 %, such as `0.005`: how many
    /// drops and bounces by ruler, film or sound; with a table for the ball of that table, without
    /// one before the first drop.
    #[arg(long, value_name = "NUMBER", value_parser = want, allow_hyphen_values = true)]
    pub(crate) want: Option<f64>,
    /// The COR to plan for where no table tells it.
    #[arg(long, value_name = "NUMBER", requires = "want", conflicts_with_all = ["tables", "values"], value_parser = expect, default_value = "0.75", allow_hyphen_values = true)]
    pub(crate) expect: f64,
    /// The height of the drops where no table tells it, such as `1m`; that to plan for is 1 m
    /// unless it is stated.
    #[arg(long, value_name = "LENGTH", conflicts_with = "values", value_parser = small(Quantity::Length, "m"), allow_hyphen_values = true)]
    pub(crate) drop: Option<f64>,
    /// Take every file as an experiment of its own: a line for each, as a table or as JSON.
    #[arg(long, requires = "tables", conflicts_with_all = ["values", "want", "plot", "plot_cor", "plot_ladder", "plot_profile", "scene"])]
    pub(crate) each: bool,
    /// Draw height against time, with the fitted motion and the residuals, as SVG.
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot: Option<PathBuf>,
    /// Draw the COR against the speed of impact, as SVG.
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot_cor: Option<PathBuf>,
    /// Draw the heights of apexes, bounce by bounce, as SVG: with one COR they are on a straight
    /// line.
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot_ladder: Option<PathBuf>,
    /// Draw how much worse the readings are explained by other CORs, as SVG.
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot_profile: Option<PathBuf>,
    /// Write the fitted motion as a scene, to simulate, to change and to export; a scene that
    /// exists is kept, unless --force is given.
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) scene: Option<PathBuf>,
    /// Write the scene anew where it exists.
    #[arg(long, requires = "scene")]
    pub(crate) force: bool,
    /// How to write the report, or why there is none; docs/use/fitting.md describes the JSON.
    #[arg(long, value_enum, default_value_t)]
    pub(crate) format: ReportFormat,
    /// Write the report to a file, anew where it exists; `-` for standard output.
    #[arg(long, short, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// The standard error of a height reading, such as `5mm`.
    #[arg(long, value_name = "LENGTH", value_parser = small(Quantity::Length, "mm"), allow_hyphen_values = true)]
    pub(crate) sigma_height: Option<f64>,
    /// The standard error of a time reading, such as `10ms`.
    #[arg(long, value_name = "TIME", value_parser = small(Quantity::Time, "ms"), allow_hyphen_values = true)]
    pub(crate) sigma_time: Option<f64>,
    /// Gravity, such as `9.81m/s^2`, m/s² where no unit is given; used only where heights meet
    /// times.
    #[arg(long, value_name = "ACCELERATION", value_parser = gravity)]
    pub(crate) gravity: Option<f64>,
    /// The drag coefficient k of v' = -g -+ k v² in 1/m: 0 for none, 0.016 of a squash ball, 0.13
    /// of a table-tennis ball; without it, the interval allows for that of ordinary balls.
    #[arg(long, value_name = "NUMBER", value_parser = drag, allow_hyphen_values = true)]
    pub(crate) drag: Option<f64>,
    /// By how far the zero of the heights may be off, such as `2mm` (a standard error), or 0 where
    /// the ball at rest on the floor reads 0; without it, the interval allows for a ball that was
    /// read anywhere on it.
    #[arg(long, value_name = "LENGTH", value_parser = at_least_zero(Quantity::Length, "mm"), allow_hyphen_values = true)]
    pub(crate) sigma_zero: Option<f64>,
    /// By which part lengths may be wrong, such as `1%` (a standard error), or 0 where the rule was
    /// checked; used only where heights meet times.
    #[arg(long, value_name = "PART", value_parser = part, allow_hyphen_values = true)]
    pub(crate) sigma_scale: Option<f64>,
    /// The unit of heights where the header names none, such as `cm`, or `px` for pixels; where
    /// every column names another, this one holds, with a warning.
    #[arg(long, value_name = "UNIT", value_parser = height_unit)]
    pub(crate) height_unit: Option<String>,
    /// The unit of times where the header names none, such as `ms`; where every column names
    /// another, this one holds, with a warning.
    #[arg(long, value_name = "UNIT", value_parser = unit(Quantity::Time))]
    pub(crate) time_unit: Option<String>,
    /// The column or the track to fit, where several hold readings of the same thing.
    #[arg(long, value_name = "NAME")]
    pub(crate) column: Option<String>,
    /// The columns that tell balls or surfaces apart, or hold the readings of one each: each then
    /// has a COR of its own; `-` for none.
    #[arg(long = "group", value_name = "NAMES", value_delimiter = ',', allow_hyphen_values = true)]
    pub(crate) groups: Vec<String>,
    /// The sheet of a workbook, or the file of a zip archive, to read; without it, every one that
    /// holds a table.
    #[arg(long, value_name = "NAME")]
    pub(crate) sheet: Option<String>,
    /// Names for the columns, in place of those in the file, such as `bounce,height_cm`; `-` leaves
    /// a column aside.
    #[arg(long, value_name = "NAMES", value_delimiter = ',', allow_hyphen_values = true)]
    pub(crate) header: Option<Vec<String>>,
    /// The part of a sound to listen to, such as `0.5s..4s`, `2s..` or `..4s`.
    #[arg(long, value_name = "TIME..TIME", value_parser = Sound::stretch)]
    pub(crate) listen: Option<Range<f64>>,
    /// How many frames were filmed in a second, where the table counts frames.
    #[arg(long, value_name = "NUMBER", value_parser = number(RATES), allow_hyphen_values = true)]
    pub(crate) fps: Option<f64>,
    /// How large one pixel is, such as `1.5mm`, or `1.371m/911` for a length that spans 911 pixels.
    #[arg(long, value_name = "LENGTH", value_parser = scale, allow_hyphen_values = true)]
    pub(crate) scale: Option<f64>,
    /// What the height scale reads at the floor, in its own unit.
    #[arg(long, value_name = "NUMBER", value_parser = finite, allow_hyphen_values = true)]
    pub(crate) zero: Option<f64>,
    /// The height scale counts downwards, as in pictures; without it, a series tells by the way it
    /// falls.
    #[arg(long)]
    pub(crate) y_down: bool,
    /// The height scale counts upwards, whichever way a series falls.
    #[arg(long, conflicts_with = "y_down")]
    pub(crate) y_up: bool,
    /// Keep only the rows in which this column has this value; may be repeated.
    #[arg(long = "filter", value_name = "COLUMN=VALUE", value_parser = filter)]
    pub(crate) filters: Vec<(String, String)>,
    /// Use every reading as it stands: look neither for missed, doubled and misread contacts nor
    /// for outliers.
    #[arg(long)]
    pub(crate) no_repair: bool,
    /// Let the COR be that of this model, if the readings can tell of it: `linear`, `viscoelastic`,
    /// `plastic`, `power` and `knots` depend on the speed of impact.
    #[arg(long, value_name = "MODEL", value_parser = clap::builder::PossibleValuesParser::new(CorModel::ALL.map(CorModel::name)))]
    pub(crate) model: Option<String>,
    /// The ball: its name, which tells its size and its drag, or its diameter, such as `4cm`.
    /// Without it the interval allows for a zero of the heights anywhere on a tennis ball, and for
    /// the drag of a table-tennis ball.
    #[arg(long, value_name = "NAME|LENGTH", value_parser = ball)]
    pub(crate) ball: Option<Ball>,
    /// Also give the COR by Huber's loss, the sum of absolute residuals and the largest residual,
    /// or by some of them, with '=': `--losses=huber`.
    #[arg(long, value_name = "LOSSES", num_args = 0.., require_equals = true, value_delimiter = ',', default_missing_values = Loss::ALL.map(Loss::name), value_parser = clap::builder::PossibleValuesParser::new(Loss::ALL.map(Loss::name)))]
    pub(crate) losses: Vec<String>,
    /// Trust every height to within this, such as `5mm`, and say which CORs that allows.
    #[arg(long, value_name = "LENGTH", value_parser = small(Quantity::Length, "mm"), allow_hyphen_values = true)]
    pub(crate) tolerance_height: Option<f64>,
    /// Trust every time to within this, such as `1ms`, and say which CORs that allows.
    #[arg(long, value_name = "TIME", value_parser = small(Quantity::Time, "ms"), allow_hyphen_values = true)]
    pub(crate) tolerance_time: Option<f64>,
    /// Also find the error by drawing whole trials anew so many times; needs five trials.
    #[arg(long, value_name = "ROUNDS", value_parser = clap::value_parser!(u32).range(2..))]
    pub(crate) bootstrap: Option<u32>,
    /// The seed of the draws: the same seed gives the same numbers.
    #[arg(long, value_name = "NUMBER", default_value_t = 1, requires = "bootstrap", allow_hyphen_values = true)]
    pub(crate) seed: u64,
    /// Exit with status 1 unless the verdict is `trusted`.
    #[arg(long)]
    pub(crate) strict: bool,
}

/// What is above zero and small: a bare number that is not is hardly in the SI unit, and the unit
/// that it may be in is offered.
fn small(
    quantity: Quantity,
    usual: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    let positive = positive(quantity);
    move |text| match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => {
            let unit = if value < 0.1 { quantity.si() } else { usual };
            let known: Vec<&str> = quantity.units().iter().map(|&(name, _)| name).collect();
            let (text, known) = (text.trim(), known.join(", "));
            Err(format!("'{text}' has no unit: give a unit of {quantity} ({known}), such as '{text} {unit}'"))
        }
        _ => positive(text),
    }
}

/// The same, or zero, which needs no unit.
fn at_least_zero(
    quantity: Quantity,
    usual: &'static str,
) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    let small = small(quantity, usual);
    move |text| if text.trim().parse() == Ok(0.0) { Ok(0.0) } else { small(text) }
}

/// What is stated of the ball.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Ball {
    Kind(saltus_fit::Ball),
    Diameter(f64),
}

fn ball(text: &str) -> Result<Ball, String> {
    if let Some(kind) = saltus_fit::Ball::named(text) {
        return Ok(Ball::Kind(kind));
    }
    if text.trim_start().starts_with(|c: char| c.is_ascii_alphabetic()) {
        let known = saltus_fit::Ball::ALL.map(saltus_fit::Ball::name).join(", ");
        return Err(format!(
            "'{text}' is no ball that is known: use one of {known}, or give a diameter, such as '4 cm', and --drag"
        ));
    }
    small(Quantity::Length, "cm")(text).map(Ball::Diameter)
}

/// An acceleration; a bare number is in m/s².
fn gravity(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(_) => positive(Quantity::Acceleration)(&format!("{} {}", text.trim(), Quantity::Acceleration.si())),
        Err(_) => positive(Quantity::Acceleration)(text),
    }
}

/// A drag coefficient in 1/m, with or without that unit.
fn drag(text: &str) -> Result<f64, String> {
    let number = text.trim();
    let bare = number.strip_suffix(" 1/m").or(number.strip_suffix("/m")).unwrap_or(number).trim_end();
    match bare.parse::<f64>() {
        Ok(value) if value.is_finite() && value >= 0.0 => Ok(value),
        _ => {
            Err(format!("'{text}' is no drag coefficient: write a number in 1/m, such as 0.016 of a squash ball, or 0"))
        }
    }
}

/// A part of one, as a number or in percent.
fn part(text: &str) -> Result<f64, String> {
    let (number, of) = text.trim().strip_suffix('%').map_or((text.trim(), 1.0), |number| (number.trim_end(), 100.0));
    match number.parse::<f64>() {
        Ok(value) if (0.0..of).contains(&value) => Ok(value / of),
        _ => Err(format!("'{text}' is no part of one: write 0.01, 1% or 0")),
    }
}

fn unit(quantity: Quantity) -> impl Fn(&str) -> Result<String, String> + Clone + Send + Sync + 'static {
    move |text| match quantity.scale(text) {
        Some(_) => Ok(text.to_owned()),
        None => {
            let known: Vec<&str> = quantity.units().iter().map(|&(name, _)| name).collect();
            Err(format!("'{text}' is not a unit of {quantity}: use one of {}", known.join(", ")))
        }
    }
}

fn height_unit(text: &str) -> Result<String, String> {
    if text == "px" { Ok(text.to_owned()) } else { unit(Quantity::Length)(text) }
}

/// A length per pixel: `1.5mm`, or a length and the pixels it spans, `1.371m/911` or
/// `1.371 m = 911 px`.
fn scale(text: &str) -> Result<f64, String> {
    let (length, pixels) = text.split_once(['/', '=']).unwrap_or((text, "1"));
    let pixels = pixels.trim().trim_end_matches("px").trim_end();
    let pixels = if pixels.is_empty() { Ok(1.0) } else { pixels.parse::<f64>() };
    match (positive(Quantity::Length)(length.trim())?, pixels) {
        (length, Ok(pixels)) if pixels > 0.0 && (length / pixels).is_normal() => Ok(length / pixels),
        _ => Err(format!(
            "'{text}' is not a scale: write 1.5mm for one pixel, or 1.371m/911 for a length and its pixels"
        )),
    }
}

fn finite(text: &str) -> Result<f64, String> {
    text.parse().ok().filter(|value: &f64| value.is_finite()).ok_or_else(|| format!("'{text}' is not a number"))
}

fn want(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value < 0.5 => Ok(value),
        _ => Err(format!(
            "'{text}' is no half-width of an interval of CORs: give a number between 0 and 0.5, such as 0.005"
        )),
    }
}

fn expect(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if saltus_fit::Expected::new(value, 1.0).is_some() => Ok(value),
        _ => Err(format!("'{text}' is no COR to plan for: give a number between 0.05 and 0.99")),
    }
}

fn filter(text: &str) -> Result<(String, String), String> {
    match text.split_once('=') {
        Some((column, value)) if !column.trim().is_empty() => Ok((column.trim().to_owned(), value.trim().to_owned())),
        _ => Err(format!("'{text}' is not of the form column=value")),
    }
}
