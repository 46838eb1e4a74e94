//! What speaks against trusting the readings of a table.

use crate::finding::{Change, Doubt};

pub(super) fn words(doubt: &Doubt) -> String {
    match doubt {
        Doubt::Title { text, line } => format!("line {line} says '{text}': were the readings below it measured?"),
        Doubt::Length { text, line } => format!(
            "line {line} says '{text}', a length that no reading takes in: if the scale does not begin at the floor, state what it reads there \
             (--zero); if the ball was dropped from there, --drop; else take the line out"
        ),
        Doubt::End { text, line } => format!(
            "line {line} says '{text}': heights of a bounce are those of the lowest point of the ball. State its diameter beside that, and the \
             release in a column; or what the scale reads with the ball at rest on the floor (--zero)"
        ),
        Doubt::Unsaid { column } => format!(
            "nothing in the table says that something bounces, and '{column}' may be of anything: say so in a heading or in a line above it \
             ('Ball dropped on wood'), or give the names by --header"
        ),
        Doubt::Motion { text } => {
            format!("'{text}' speaks of another motion than a bounce: are the readings those of a ball that bounces?")
        }
        Doubt::Rival { column, of } => format!(
            "'{column}' is not understood and was left aside, and its numbers fall as those of '{of}' do: which of the two were measured? Choose \
             by --column '{of}' or --column '{column}'"
        ),
        Doubt::Datum { drop, rebound } => format!(
            "'{drop}' and '{rebound}' are read at different ends of the ball: take its diameter off those of its top, so that all are of its bottom"
        ),
        Doubt::Repeated { column, of } => format!(
            "'{column}' is '{of}' of the row before, times one factor other than 1, to the last digit: it was not measured. Which of the two has \
             the right unit? Leave the other out by --header"
        ),
        Doubt::Word { column, word } => format!(
            "the word '{word}' in '{column}' is not understood, and no other column holds what it does: was it measured? Choose it by --column \
             '{column}'"
        ),
        Doubt::Units { drop, rebound } => format!(
            "'{drop}' and '{rebound}' are in different units, and their numbers are those of a ball if the units are the same: is one of \
             them wrong?"
        ),
        Doubt::Fall { drop, speed } => format!(
            "'{speed}' is no speed that a fall from '{drop}' gives: is the unit of one of the two another, or was the ball thrown?"
        ),
        Doubt::Copied { one, other } => format!(
            "the readings of '{one}' are those of '{other}' to the last digit, as those of no two balls, floors or heights are: which of them \
             were measured? Take the others out"
        ),
        Doubt::Computed { factor, heights } => format!(
            "{heights} heights are those before them times {factor}, to more digits than a ball keeps to: were they measured, or computed?"
        ),
        Doubt::Order { trial } => format!(
            "the rows are taken for bounces one after the other, and the heights of '{trial}' rise along them: if they are, number them in a \
             column 'bounce'"
        ),
        Doubt::Chance { contacts, once_in: 0 | 1 } => format!(
            "what was taken for {contacts} contacts comes ever sooner, as those of a ball do, and so does something else by chance"
        ),
        Doubt::Chance { contacts, once_in } => format!(
            "what was taken for {contacts} contacts comes ever sooner, as those of a ball do; in one of {once_in} recordings like this \
             something else does so by chance"
        ),
        Doubt::Undying { lost_db, due_db } => {
            let change =
                if *lost_db < 0 { format!("louder by {} dB", -lost_db) } else { format!("fainter by {lost_db} dB") };
            format!(
                "the sounds come ever sooner, as the contacts of a ball do, but become {change}, where its impacts lose {due_db} dB: are they \
                 those of a ball?"
            )
        }
        Doubt::Remark { text, line, change } => {
            let place = line.map_or_else(String::new, |line| format!("line {line}: "));
            format!("{place}'{text}': {}", remark(*change))
        }
        Doubt::Oblique { column } => format!(
            "beside the speeds stand angles, '{column}': give the components across the floor, a speed times the sine of its angle from it"
        ),
        Doubt::UntilRest => "the COR follows from the time until the ball rests, as if it bounced ever smaller; its last contacts are no \
                             bounces, and rolling or ringing lengthens the time"
            .to_owned(),
    }
}

/// What to do about a remark that changes the readings.
const fn remark(change: Change) -> &'static str {
    match change {
        Change::Thrown => {
            "a ball that is not simply let go has a speed of its own: is the height of release that of a drop?"
        }
        Change::Medium => "a COR is of a ball in air and of a level floor at rest: do the readings show one?",
        Change::Counted => "are all bounces there? Number those that are, and leave out no row",
        Change::Shifted => {
            "are the readings right as they stand? If they are, take the remark out; a zero can be stated (--zero)"
        }
        Change::Void => "are the readings to be used? Take those out that are not",
        Change::Unread => "were the readings measured?",
        Change::Clock => "do the times run as the clock does? If they do, take the remark out",
        Change::Order => "are the rows bounces one after the other? Say in a column what tells them apart",
        Change::Unclear => {
            "most of this is not understood, and it may change what the numbers mean; if it does not, take it out"
        }
        Change::Unsure => "are the readings sure? If they are, take the remark out",
        Change::Changed => "is it one ball on one floor? Name each in a column",
    }
}
