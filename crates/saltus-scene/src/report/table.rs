//! A run as a table: a row for the start, both sides of every jump, each sample and the end.

use std::fmt::Write;

use super::{Sample, Sampling, Side, View};
use crate::Error;
use crate::plan::{Moment, Record};

/// A table by columns, each with a name.
///
/// [`Record::table`] makes it; [`Table::csv`] writes it.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The names, with units: `time_s`, `jumps`, `ball` where there are several, `mode`, places,
    /// velocities and spins.
    pub headers: Vec<&'static str>,
    /// The columns, one for each name, all of one length.
    pub columns: Vec<Values>,
}

/// The values of one name, from row to row.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Numbers in SI units.
    Numbers(Vec<f64>),
    /// Counts from 0.
    Counts(Vec<usize>),
    /// Names of modes.
    Words(Vec<&'static str>),
}

impl Table {
    /// The number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        match self.columns.first() {
            Some(Values::Numbers(values)) => values.len(),
            Some(Values::Counts(values)) => values.len(),
            Some(Values::Words(values)) => values.len(),
            None => 0,
        }
    }

    /// The table as CSV, the names first. Each number has the shortest text that reads back as the
    /// same number.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut csv = self.headers.join(",") + "\n";
        for row in 0..self.rows() {
            for (n, column) in self.columns.iter().enumerate() {
                let between = if n > 0 { "," } else { "" };
                let _ = match column {
                    Values::Numbers(values) => write!(csv, "{between}{}", values[row]),
                    Values::Counts(values) => write!(csv, "{between}{}", values[row]),
                    Values::Words(values) => write!(csv, "{between}{}", values[row]),
                };
            }
            csv.push('\n');
        }
        csv
    }
}

impl Record {
    /// The start, both sides of every jump, the samples if asked for and the end, in order of (t,
    /// j).
    ///
    /// # Errors
    /// [`Error`] for more than ten million samples.
    ///
    /// ```
    /// use saltus_scene::{Values, Scene};
    /// let scene = Scene::parse("drop.toml", b"gravity = 9.8\nrestitution = 0.5\nball = { height = '4.9 m' }\n")?;
    /// let table = scene.plan()?.until(1.5).run()?.table(None)?;
    /// assert_eq!(table.headers, ["time_s", "jumps", "mode", "height_m", "velocity_m_per_s"]);
    /// let Values::Numbers(times) = &table.columns[0] else { unreachable!() };
    /// assert!((times[1] - 1.0).abs() < 1e-15 && (times[0], times[3]) == (0.0, 1.5));
    /// assert!(table.csv().starts_with("time_s,jumps,mode,height_m,velocity_m_per_s\n0,0,flight,4.9,0\n"));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn table(&self, sampling: Option<Sampling>) -> Result<Table, Error> {
        let (view, scene, events) = (View::of(self), self.scene(), self.events());
        let mut rows = Vec::new();
        for (n, ball) in scene.balls.iter().enumerate() {
            let (position, velocity) = (ball.lowest(), ball.velocity);
            let start = Moment { position, velocity, spin: ball.spin.unwrap_or_default() };
            let mode = events.iter().flat_map(|event| &event.sides).find(|sides| sides.ball == n);
            let mode = mode.map_or_else(|| self.mode(n, 0.0).unwrap_or("flight"), |sides| sides.from);
            rows.push(Sample { t: 0.0, j: 0, side: view.side(n, mode, &start) });
        }
        for event in &events {
            for sides in &event.sides {
                let before = view.side(sides.ball, sides.from, &sides.before);
                rows.push(Sample { t: event.t, j: event.j - 1, side: before });
                rows.push(Sample { t: event.t, j: event.j, side: view.side(sides.ball, sides.to, &sides.after) });
            }
        }
        let end = self.until();
        for ball in 0..self.balls() {
            rows.extend(view.at(ball, end).map(|side| Sample { t: end, j: events.len(), side }));
        }
        rows.extend(view.samples(&events, sampling)?);
        rows.sort_by(|a, b| a.t.total_cmp(&b.t).then(a.j.cmp(&b.j)).then(a.side.ball.cmp(&b.side.ball)));
        rows.dedup_by(|b, a| (a.t, a.j, a.side.ball) == (b.t, b.j, b.side.ball));
        Ok(by_columns(&view, &rows))
    }
}

/// The rows by columns: those that the scene has coordinates for.
fn by_columns(view: &View<'_>, rows: &[Sample]) -> Table {
    let (mut headers, mut columns) = (Vec::new(), Vec::new());
    let mut put = |header: &'static str, column: Values| {
        headers.push(header);
        columns.push(column);
    };
    let of = |get: &dyn Fn(&Side) -> f64| Values::Numbers(rows.iter().map(|row| get(&row.side)).collect());
    let (places, speeds, spins): (&[_], &[_], &[_]) = match view.record.scene().dimensions {
        1 => (&[], &[], &[]),
        2 => (&["x_m"], &["velocity_x_m_per_s"], &["spin_rad_per_s"]),
        _ => (
            &["x_m", "y_m"],
            &["velocity_x_m_per_s", "velocity_y_m_per_s"],
            &["spin_x_rad_per_s", "spin_y_rad_per_s", "spin_up_rad_per_s"],
        ),
    };
    put("time_s", Values::Numbers(rows.iter().map(|row| row.t).collect()));
    put("jumps", Values::Counts(rows.iter().map(|row| row.j).collect()));
    if view.record.balls() > 1 {
        put("ball", Values::Counts(rows.iter().map(|row| row.side.ball.unwrap_or(0)).collect()));
    }
    put("mode", Values::Words(rows.iter().map(|row| row.side.mode).collect()));
    for (k, &name) in places.iter().enumerate() {
        put(name, of(&|side| side.position[k]));
    }
    put("height_m", of(&|side| side.height));
    for (k, &name) in speeds.iter().enumerate() {
        put(name, of(&|side| side.velocities[k]));
    }
    put("velocity_m_per_s", of(&|side| side.velocity));
    for (k, &name) in spins.iter().enumerate().filter(|_| view.spins) {
        put(name, of(&|side| side.spin[k]));
    }
    Table { headers, columns }
}
