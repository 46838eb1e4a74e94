//! Cases on which integrators in use were seen to fail: each with the right answer and the test
//! that has it here.

/// What was seen, the right answer, the file of the test and its name.
pub(crate) struct Seen(
    pub(crate) &'static str,
    pub(crate) &'static str,
    pub(crate) &'static str,
    pub(crate) &'static str,
);

/// The sources of the tests, by which a name that is no longer there is noticed.
pub(crate) const SOURCES: [(&str, &str); 6] = [
    ("failures/floor.rs", include_str!("../tests/failures/floor.rs")),
    ("failures/missed.rs", include_str!("../tests/failures/missed.rs")),
    ("failures/twice.rs", include_str!("../tests/failures/twice.rs")),
    ("failures/order.rs", include_str!("../tests/failures/order.rs")),
    ("failures/other.rs", include_str!("../tests/failures/other.rs")),
    ("sensitivity.rs", include_str!("../tests/sensitivity.rs")),
];

const FLOOR: &str = "failures/floor.rs";
const MISSED: &str = "failures/missed.rs";
const TWICE: &str = "failures/twice.rs";
const ORDER: &str = "failures/order.rs";
const OTHER: &str = "failures/other.rs";
const SENSITIVITY: &str = "sensitivity.rs";

#[rustfmt::skip] // a table
pub(crate) const SURVEY: [(&str, &[Seen]); 5] = [
    ("Falls through the floor, accumulation, rest", &[
        Seen("ball from 1 m, e = 0.5 to 0.9, far beyond the accumulation", "rest at 1.3552618543578769 s (e = 0.5), once, never below the floor", FLOOR, "a_ball_comes_to_rest_on_every_path"),
        Seen("the same at e = 0.99", "3163 impacts, rest at 89.899036339072498 s", FLOOR, "a_lively_ball_comes_to_rest"),
        Seen("plastic impact, e = 0", "one impact at 0.45175395145262562 s, then contact for ever", FLOOR, "a_plastic_impact_happens_once"),
        Seen("a horizon past the accumulation, what is stored", "as much as there are impacts", FLOOR, "the_record_grows_with_the_impacts_only"),
        Seen("stop below 0.1 m/s, e = 0.7", "11 impacts, rest at 2.4991133142246207 s", FLOOR, "a_ball_stopped_below_a_least_speed"),
        Seen("rimless wheel that slows down between two spokes", "stands still, no endless swap of guards", FLOOR, "a_wheel_that_rocks_comes_to_stand"),
        Seen("ball at rest, pulled by m g t", "leaves at 1 s, never penetrates", FLOOR, "a_resting_ball_is_pulled_off"),
        Seen("last bounces drawn at 60 frames a second", "each e² as high as the one before, down to one frame", FLOOR, "bounces_shrink_evenly_below_one_frame"),
        Seen("e = 1, 10 m, 1000 impacts", "10 m, but for rounding", FLOOR, "an_elastic_ball_keeps_its_height"),
        Seen("rebound height for e = 0.3, 0.5, 0.8, 0.95", "0.09, 0.25, 0.64, 0.9025 of the drop", FLOOR, "rebounds_are_as_high_as_the_cor_says"),
    ]),
    ("Missed crossings", &[
        Seen("a cubic with three roots in the span", "-6, -2 and 2", MISSED, "three_roots_of_a_cubic"),
        Seen("a line through a guard of degree three, long steps", "2.5 and 5, both", MISSED, "a_line_through_a_guard_of_degree_three"),
        Seen("two crossings near an apex, 9 ms to 1 µs apart", "both", MISSED, "two_crossings_nine_milliseconds_apart"),
        Seen("a touch in representable numbers", "no crossing", MISSED, "a_touch_at_the_apex_is_no_crossing"),
        Seen("launch from exactly y = 0 at 5 m/s", "one impact, at 1.0204081632653061 s", MISSED, "a_launch_from_exactly_the_floor"),
        Seen("roots on dyadic fractions of the step", "each once, up then down", MISSED, "crossings_at_dyadic_fractions"),
        Seen("a step that spans a whole flight", "the impact inside it", MISSED, "a_flight_inside_one_step"),
        Seen("guard (t - 0.5)(t - 0.6), fixed step 0.1", "0.5 and 0.6, once each", MISSED, "crossings_on_the_ends_of_fixed_steps"),
        Seen("one scene with every method", "one list of events", MISSED, "every_method_finds_the_same_crossings"),
        Seen("a condition that holds for 25 ms between outputs", "fires; its delay ends at 0.55 s", MISSED, "a_short_condition_between_outputs"),
        Seen("the condition \"time is 10\"", "met, whatever the steps", MISSED, "a_moment_is_met_whatever_the_steps"),
        Seen("output grids from 1e-4 to 1 s", "the same events to the bit", MISSED, "the_events_do_not_depend_on_the_output"),
        Seen("the cube of a guard", "the crossings of the guard", MISSED, "a_guard_cubed"),
        Seen("the square of a guard", "no crossing", MISSED, "a_guard_squared_makes_no_jump"),
    ]),
    ("Fires twice, gets stuck, hangs", &[
        Seen("a guard that is not a number in part of a step", "an error that names guard, time and state", TWICE, "a_guard_that_is_not_a_number"),
        Seen("y' = 1/(t - 1) from just after 1", "an error: the step is too short", TWICE, "steps_below_the_spacing_of_time"),
        Seen("guard values of 1e-300", "found", TWICE, "tiny_guard_values"),
        Seen("y' = t mod 1, a root at each integer and at the end", "y(10) = 5", TWICE, "a_sawtooth_with_a_crossing_at_the_output"),
        Seen("two identical guards", "one instant, both, one pass", TWICE, "two_identical_guards"),
        Seen("a reset that makes two other guards negative", "both taken, in their order, and it ends", TWICE, "a_reset_that_trips_two_other_guards"),
        Seen("a reset that flips its own guard before another root", "no broken bracket", TWICE, "a_reset_that_flips_its_own_guard"),
        Seen("an event less than a spacing of time from a step's end", "once", TWICE, "a_crossing_one_spacing_from_a_step_end"),
        Seen("a driver that reports an event each step", "as many events as impacts", TWICE, "as_many_events_as_impacts"),
        Seen("a reset that leaves the guard one unit off zero", "not taken again", TWICE, "a_reset_one_unit_off_the_wall"),
        Seen("a thermostat with a hysteresis of 1e-9", "it finishes", TWICE, "a_thermostat_with_a_hair_of_hysteresis"),
    ]),
    ("At the start, order, both limits", &[
        Seen("a crossing at absolute time 0, from -10", "at 0 exactly", ORDER, "a_crossing_at_time_zero"),
        Seen("a guard that is zero at the start and crosses later", "the later crossing fires", ORDER, "a_guard_that_is_zero_at_the_start"),
        Seen("guards at 0 and 0.9 in this order, drop from 1", "0.9 first, at 0.14285714285714285 s", ORDER, "the_earlier_crossing_is_first"),
        Seen("backwards through guards at 2e-8, 1e-8 and 0", "in this order", ORDER, "backwards_through_three_guards_close_together"),
        Seen("equal balls that land together", "each once, at one time", ORDER, "eight_balls_land_together"),
        Seen("two groups of balls", "each group at its own time", ORDER, "two_groups_land_in_turn"),
        Seen("the bracket of a root", "neighbouring numbers, the right signs", ORDER, "the_bracket_is_two_neighbours"),
        Seen("both walls of a corner at once", "one instant, either order of declaration", ORDER, "both_walls_of_a_corner"),
        Seen("the state exactly at the third impact", "-30 m/s before it, 30 m/s after it", ORDER, "both_limits_at_an_impact"),
        Seen("a root between the output asked for and the step's end", "found by the next run, in its direction", ORDER, "a_root_after_the_time_asked_for"),
        Seen("a state changed between runs so that a guard is negative", "refused, waited for or taken, as the model says", ORDER, "a_state_changed_to_violate_a_guard"),
    ]),
    ("Derivatives, batches, dense output, cost", &[
        Seen("a state after an event, by the time of the event", "dx(2)/dt = 1; dt/dh = 0.22587697572631281", SENSITIVITY, "by_the_time_of_an_event_and_of_it"),
        Seen("two events at one instant, derivatives of both", "the second from the state after the first", SENSITIVITY, "two_events_at_one_instant"),
        Seen("runs side by side", "the same to the bit as alone", OTHER, "runs_side_by_side_are_the_runs_alone"),
        Seen("dense output at the ends of steps", "the steps' own values", OTHER, "the_dense_output_meets_the_steps"),
        Seen("a stiff run with 100 jumps that change nothing", "at most one step more for each", OTHER, "a_stiff_run_restarts_cheaply"),
    ]),
];
