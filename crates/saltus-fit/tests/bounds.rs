//! Numbers that bound how tables are read, met from both sides.

use crate::typed::{fit, read, trusted};

fn near(found: f64, e: f64) -> bool {
    (found - e).abs() < 4e-3
}

/// Numbers without a unit are in that of their neighbours where a ball may bounce so, down to a
/// fiftieth of the release.
#[test]
fn a_unit_is_adopted_where_a_ball_may_bounce_so() {
    let text = |part: f64| {
        let row = |h: f64| format!("{h},{:.4}\n", h * part);
        format!("Drop height (cm),Rebound height\n{}", [100.0, 80.0, 60.0, 50.0].map(row).concat())
    };
    for part in [0.64, 0.09] {
        assert!(near(fit(&text(part)).cor().unwrap().value, part.sqrt()), "{part}");
    }
    assert!(read(&text(0.0064)).unwrap_err().is_question());
}

/// A label of a sound that is marked from its beginning to its end is of one contact, where it is
/// short; a longer one is of something else.
#[test]
fn labels_of_contacts_are_short() {
    let text = |lasts: f64| -> String {
        let starts = [3.2, 3.9225, 4.5005, 4.9629, 5.3328];
        starts.map(|start| format!("{start:.4}\t{:.4}\tbounce\n", start + lasts)).concat()
    };
    for lasts in [0.0, 0.1] {
        assert!(near(trusted(&text(lasts)), 0.8), "{lasts}");
    }
    assert!(read(&text(0.35)).is_err_and(|error| !error.to_string().is_empty()));
}

/// Lines of text may stand above a table, some fifty of them.
#[test]
fn many_lines_may_stand_above_a_table() {
    let above = "We dropped the ball again and again, and wrote down what we read.\n".repeat(50);
    assert!(near(trusted(&format!("{above}bounce,height (cm)\n0,100\n1,64\n2,41\n3,26.2\n")), 0.8));
}
