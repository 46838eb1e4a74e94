//! What reading a table brought up, in words.

use std::fmt::{self, Display, Formatter};

use crate::finding::{Lines, Named, Note, Pace, Parts, Program, Remark, Repair, Shape, Warning};

impl<K: Display> Display for Remark<K> {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for Parts { first, last, count } in &self.parts {
            match count {
                1 => write!(f, "{first}: ")?,
                _ => write!(f, "{first} to {last} ({count} of them): ")?,
            }
        }
        write!(f, "{}", self.kind)
    }
}

impl Display for Note {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { rows, trials } => write!(f, "{}, {}", plural(*rows, "row"), plural(*trials, "trial")),
            Self::ReadAs { shape, side_by_side, speeds } => {
                write!(f, "read as {shape}")?;
                if *side_by_side > 1 {
                    write!(f, ", in {side_by_side} columns side by side")?;
                }
                f.write_str(if *speeds { "; a speed v stands for the height v²/2g" } else { "" })
            }
            Self::Recognised { program } => write!(f, "recognised as {}", described(*program)),
            Self::Encoded { encoding } => write!(f, "the text is encoded as {encoding}"),
            Self::Rate { rate, line: Some(line) } => {
                write!(f, "{rate} frames, or samples, a second, as line {line} states")
            }
            Self::Rate { rate, line: None } => {
                write!(f, "{rate} frames, or samples, a second, as the name of the file states")
            }
            Self::Heard { sounds, contacts, from, to } => {
                let sounds = plural(*sounds, "sound");
                write!(f, "{sounds} in {:.2} s (from {from:.2} s), {contacts} of them contacts", to - from)
            }
            Self::Felt { column, pulses, contacts } => {
                write!(f, "{} of a sensor in '{column}', {contacts} of them contacts", plural(*pulses, "pulse"))
            }
            Self::Flown { column, flights } => {
                write!(
                    f,
                    "'{column}' is the speed of a ball in {}, whose tops are where it is none",
                    plural(*flights, "flight")
                )
            }
            Self::Overdriven { part } => {
                write!(f, "{:.1} % of the samples are as large as can be: record less loud", 100.0 * part)
            }
            Self::Vertical { column } => {
                write!(f, "'{column}' is the height: along the others the ball flies straight (choose with --column)")
            }
            Self::Still { tracks } => {
                write!(f, "left aside, as it hardly moves: {} (choose with --column)", tracks.join(", "))
            }
            Self::Sheets { sheets, drops } => {
                let what = if *drops { " (each name the height of release)" } else { "" };
                write!(f, "sheets read: {}{what}", sheets.join(", "))
            }
            Self::SheetsAside { sheets } => {
                write!(f, "sheets left aside, for they hold no table of bounces: {}", sheets.join(", "))
            }
            Self::Filtered { kept, left_out } => write!(f, "{kept} rows kept and {left_out} left out by the filter"),
            Self::Apart { column } => {
                write!(f, "the COR differs by '{column}': each of its words has a COR of its own (--group - if not)")
            }
            Self::Dropped { height_m } => write!(f, "dropped from {height_m} m, as stated"),
            Self::Floor { reading, down } => {
                let way = if *down { "downwards" } else { "upwards" };
                write!(f, "the scale reads {reading} at the floor and counts {way}")
            }
            Self::Aloft { contact_s } => {
                let lasts = 1000.0 * contact_s;
                write!(f, "the ball is on the floor for {lasts:.1} ms at each contact: flights begin at its end")
            }
            Self::FallingTimes => f.write_str("the times fall from bounce to bounce: taken as times between contacts"),
            Self::RisingTimes { column } => {
                write!(f, "the times of '{column}' rise from row to row: taken as those of a running clock")
            }
            Self::Thousands { cell } => write!(f, "the mark in '{cell}' parts thousands, by the numbers beside it"),
            Self::Start { name } => write!(f, "'{name}' stands before the first bounce: taken for the release"),
            Self::Losses { column } => {
                write!(f, "'{column}' adds up from bounce to bounce: heights are what it leaves of the release")
            }
            Self::Repeats { columns } => {
                write!(f, "'{}' are taken for repeats and not for bounces one after another", columns.join("', '"))
            }
            Self::Namesakes { column } => write!(f, "the columns '{column}' are taken for repeats"),
            Self::Computed => f.write_str("heights were left aside: phyphox computes them from the times"),
            Self::Share { column, of_release } => {
                let of = if *of_release { "of the height of release" } else { "of the rebound to its drop" };
                write!(f, "'{column}' is taken as a ratio of heights, {of}")
            }
            Self::Energy { column } => write!(f, "'{column}' is taken as an energy, which is as the height"),
            Self::SameUnit { column, of } => write!(f, "'{column}' is taken to be in the unit of '{of}'"),
            Self::UnitBySize { column, unit } => {
                write!(f, "'{column}' has no unit: taken as {unit}, since it lasts as long as a ball bounces")
            }
            Self::Pixels { column } => {
                write!(f, "'{column}' has no unit: taken as pixels of unknown size, which a COR does not need")
            }
            Self::AnyRate { column, rate } => {
                write!(
                    f,
                    "'{column}' counts frames of unknown rate, which a COR does not need: {rate} a second stand in"
                )
            }
            Self::ByFlights { metres } => {
                write!(f, "heights are in pixels of {:.3} mm, by which their flights last as they do", 1000.0 * metres)
            }
            Self::Misspelt { written, heading, meant } => write!(f, "'{written}' in '{heading}' was read as '{meant}'"),
            Self::Restarts { times } => {
                write!(f, "the clock starts again {times} times: read as {} recordings", times + 1)
            }
            Self::Downwards { shown } => {
                let why = if *shown { "the ball falls that way" } else { "as in pictures" };
                write!(f, "heights count downwards: {why} (--y-up if not)")
            }
            Self::ByTime { gravity } => write!(f, "rebounds follow from their times, with g = {gravity} m/s²"),
        }
    }
}

impl Display for Shape {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Events => f.write_str("events (release, contact, apex)"),
            Self::Tops { times, heights } => write!(f, "tops: their times '{times}' and their heights '{heights}'"),
            Self::ContactsAndHeights { times, heights } => {
                write!(f, "contact times '{times}' and the heights reached after them '{heights}'")
            }
            Self::Contacts { times } => write!(f, "contact times '{times}'"),
            Self::Intervals { intervals } => write!(f, "times between contacts '{intervals}'"),
            Self::IntervalsAndHeights { intervals, heights } => {
                write!(f, "heights '{heights}' and times between contacts '{intervals}'")
            }
            Self::Heights { heights, numbered: true } => {
                write!(f, "heights '{heights}' by number of bounces, 0 being the release")
            }
            Self::Heights { heights, numbered: false } => {
                write!(f, "heights '{heights}' in order, the first being the release")
            }
            Self::Drops { release: Some(release), rebound: Some(rebound) } => {
                write!(f, "drops, one a row: '{release}' and '{rebound}'")
            }
            Self::Drops { .. } => f.write_str("drops, one a row"),
            Self::Wide => f.write_str("one trial a row, one bounce a column"),
            Self::Series { heights, times: Some(times) } => {
                write!(f, "a series of heights '{heights}' in time '{times}'")
            }
            Self::Series { heights, times: None } => write!(f, "a series of heights '{heights}', a frame apart"),
        }
    }
}

fn described(program: Program) -> &'static str {
    match program {
        Program::Labels => "a track of labels (s)",
        Program::ImageJ => "ImageJ tracks",
        Program::Tracker => "a Tracker export (s, m)",
        Program::Vernier => "a Vernier text",
        Program::SideBySide => "runs side by side",
    }
}

impl Display for Repair {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::SameFile { file, as_file } => write!(f, "{file} is the same file as {as_file}: counted once"),
            Self::SameLine { line } => write!(f, "line {line}: the same as the line before, counted once"),
            Self::SameSamples { samples } => {
                let are = if *samples == 1 { "sample is" } else { "samples are" };
                write!(f, "{samples} {are} given twice alike, counted once")
            }
            Self::SameTrial { trial, as_trial } => {
                write!(f, "{trial} repeats {as_trial} reading by reading: counted once")
            }
            Self::RoundedNumbers => {
                f.write_str("numbers of bounces, as if read off a diagram, are rounded to whole ones")
            }
            Self::NoPosition { lines } => write!(f, "{lines}: no position here, left out"),
        }
    }
}

impl Display for Warning {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Size { height_m, line } => {
                write!(f, "the highest reading is {height_m} m, in line {line}: is that the right unit?")
            }
            Self::Zeros { lines } => {
                write!(f, "{lines}: a rebound of zero height is below what can be read; only 'heights-ratio' counts it")
            }
            Self::Gravity { found, due, pace } => write!(
                f,
                "the ball falls with {found:.2} m/s² where {due:.2} are due: is the unit of heights, the scale or the frame rate wrong? \
                 ({pace})"
            ),
            Self::UnitAgainstName { column, unit } => {
                write!(f, "the numbers of '{column}' are taken to be in {unit}, as stated, against its name")
            }
            Self::Stray { at, reading, factor, instead } => {
                let (size, times) = if *factor > 1.0 { ("small", *factor) } else { ("large", 1.0 / factor) };
                write!(
                    f,
                    "a height out of line, {at}: '{reading}' is about {times:.0} times too {size} beside the other heights; if it is in \
                     another unit, or its decimal point has slipped, write {instead} for it, in the unit of the column"
                )
            }
            Self::MoreStrays { heights } => write!(f, "{heights} more heights look as if they were in another unit"),
        }
    }
}

impl Display for Pace {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self {
            Self::Frames { rate } => write!(f, "{rate:.0} frames a second would be right"),
            Self::Clock { factor, played } => {
                let (by, how) = if *factor > 1.0 { (*factor, "slower") } else { (1.0 / factor, "faster") };
                write!(
                    f,
                    "if it is the clock, the recording runs {by:.1} times {how} than life, as a film shot at {:.0} frames a second and \
                     played at {played:.0}; the COR does not depend on it",
                    played * factor
                )
            }
        }
    }
}

/// The lines by their numbers; of many the first, and how many there are.
impl Display for Lines {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        match self.first.as_slice() {
            [] => f.write_str("no line"),
            [one] => write!(f, "line {one}"),
            [most @ .., last] if self.count == self.first.len() => {
                let most: Vec<String> = most.iter().map(u64::to_string).collect();
                write!(f, "lines {} and {last}", most.join(", "))
            }
            [first, ..] => write!(f, "{} lines, the first of them {first}", self.count),
        }
    }
}

impl Display for Named {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.name.is_empty() { write!(f, "trial {}", self.trial) } else { write!(f, "'{}'", self.name) }
    }
}

fn plural(n: usize, word: &str) -> String {
    format!("{n} {word}{}", if n == 1 { "" } else { "s" })
}
