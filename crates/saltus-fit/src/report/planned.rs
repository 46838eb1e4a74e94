//! Plans for people: a line for each way, then what stands in the way.

use std::fmt::{self, Display, Formatter};

use super::lines::{paragraph, sentence};
use super::plan::{Plan, Planned};
use super::words::{brings, every_bounce, way, widening};

impl Display for Plan {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let Self { want, cor, drop_m, ways } = self;
        writeln!(f, "A COR of about {cor:.2}, dropped from {drop_m:.2} m, to ± {want} (95 %)\n")?;
        writeln!(f, "  {:<44}{:>6}{:>9}{:>10}   brings", "", "drops", "bounces", "readings")?;
        for planned in ways {
            let Planned { drops, bounces, readings, half_width, enough, .. } = planned;
            let short = if *enough { "" } else { "   not enough" };
            writeln!(f, "  {:<44}{drops:>6}{bounces:>9}{readings:>10}   ± {half_width:.4}{short}", way(planned.way))?;
        }
        let mut named: Vec<String> = Vec::new();
        for why in ways.iter().filter(|planned| !planned.enough).flat_map(|planned| &planned.takes_in) {
            let words = widening(why);
            let start = |text: &str| text.split(' ').take(4).collect::<Vec<_>>().join(" ");
            if named.iter().all(|known| start(known) != start(&words)) {
                named.push(words);
            }
        }
        if !named.is_empty() {
            writeln!(f, "\nWhat more drops do not remove")?;
            for why in named {
                paragraph(f, 2, 4, &format!("- {}", sentence(&why)))?;
            }
        }
        writeln!(f)?;
        paragraph(f, 0, 0, every_bounce())
    }
}

impl Display for Planned {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        f.write_str(&brings(self))
    }
}
