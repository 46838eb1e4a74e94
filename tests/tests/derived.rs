//! Structs of numbers as states: by name in flows, tables and errors.

use proptest::prelude::*;
use saltus::nalgebra::{Vector3, vector};
use saltus::{
    Automaton, Clock, Clocks, Edges, ErrorKind, Hybrid, Lift, Linearize, Number, Over, Refusal, Sensitive, Simulation,
    State, Wrt,
};

/// A buck converter: coil and capacitor, and the time since its switch was closed.
#[derive(Clone, Copy, Debug, PartialEq, State, serde::Serialize, serde::Deserialize)]
struct Buck {
    #[unit("A")]
    current: f64,
    #[unit("V")]
    voltage: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, State)]
struct Pair(f64, [f64; 2]);

#[derive(Clone, Copy, Debug, PartialEq, State)]
struct Robot<L> {
    #[unit("m")]
    place: Vector3<f64>,
    r#type: f64,
    load: L,
    bucks: Pair,
}

fn robot(values: [f64; 9]) -> Robot<Buck> {
    let [a, b, c, d, e, f, g, h, i] = values;
    Robot { place: vector![a, b, c], r#type: d, load: Buck { current: e, voltage: f }, bucks: Pair(g, [h, i]) }
}

#[test]
fn coordinates_are_named_by_their_fields() {
    let x = robot([0.0; 9]);
    let names: Vec<_> = (0..x.len()).map(|i| x.name(i)).collect();
    let fields = [
        "place[0]",
        "place[1]",
        "place[2]",
        "type",
        "load.current",
        "load.voltage",
        "bucks.0",
        "bucks.1[0]",
        "bucks.1[1]",
    ];
    assert_eq!(names, fields);
    let units: Vec<_> = (0..x.len()).map(|i| x.unit(i)).collect();
    assert_eq!(units, ["m", "m", "m", "", "A", "V", "", "", ""]);
    assert_eq!(x.unit(9), "");
    assert!(x.get(9).is_nan());
}

proptest! {
    /// What is read is what was put there, coordinate by coordinate, and nothing else changes.
    #[test]
    fn a_struct_is_its_coordinates(values in prop::array::uniform9(-1e3..1e3_f64), place in 0..9_usize, other in -1e3..1e3_f64) {
        let x = robot(values);
        let read: Vec<f64> = (0..x.len()).map(|i| x.get(i)).collect();
        prop_assert_eq!(&read[..], &values[..]);
        let mut asked = Vec::new();
        let y = x.with(|i| { asked.push(i); if i == place { other } else { x.get(i) } });
        prop_assert_eq!(asked, (0..9).collect::<Vec<_>>());
        let mut expected = values;
        expected[place] = other;
        prop_assert_eq!(y, robot(expected));
    }
}

/// A named state runs as the array of its numbers does, to the bit.
#[test]
fn a_named_state_runs_like_an_array() {
    let (inductance, capacity, load) = (1e-3, 1e-4, 10.0);
    let named = Hybrid::new()
        .mode("on", |_t, x: &Buck| Buck {
            current: (12.0 - x.voltage) / inductance,
            voltage: (x.current - x.voltage / load) / capacity,
        })
        .mode("off", |_t, x| Buck {
            current: -x.voltage / inductance,
            voltage: (x.current - x.voltage / load) / capacity,
        })
        .edge("on", "off", |_t, x| 1.0 - x.current, |_t, x| *x)
        .edge("off", "on", |_t, x| x.current - 0.2, |_t, x| *x);
    let plain = Hybrid::new()
        .mode("on", |_t, x: &[f64; 2]| [(12.0 - x[1]) / inductance, (x[0] - x[1] / load) / capacity])
        .mode("off", |_t, x| [-x[1] / inductance, (x[0] - x[1] / load) / capacity])
        .edge("on", "off", |_t, x| 1.0 - x[0], |_t, x| *x)
        .edge("off", "on", |_t, x| x[0] - 0.2, |_t, x| *x);
    let run = Simulation::of(&named).run("on", Buck { current: 0.0, voltage: 0.0 }, 0.0..0.01).unwrap();
    let same = Simulation::of(&plain).run("on", [0.0; 2], 0.0..0.01).unwrap();
    assert!(run.trajectory.jumps().len() > 10);
    assert_eq!([run.end.state.current, run.end.state.voltage], same.end.state);
    assert_eq!(run.end.stats, same.end.stats);
    let table = run.trajectory.sampled(1e-3).unwrap().to_string();
    assert!(table.starts_with("t (s),j,mode,current (A),voltage (V)\n0.0,0,on,0.0,0.0\n"), "{table}");
    let mut course = Simulation::of(&named).start("on", Buck { current: 0.0, voltage: 0.0 }, 0.0..0.01).unwrap();
    course.advance(&mut ()).unwrap();
    assert!(format!("{:?}", course.checkpoint()).contains("voltage"));
}

/// An error says which coordinate is no number, and the state by its names.
#[test]
fn errors_name_coordinates() {
    let model = Hybrid::new().mode("on", |t, x: &Buck| Buck { current: (0.5 - t).sqrt(), voltage: x.voltage });
    let failed = Simulation::of(&model).run("on", Buck { current: 1.0, voltage: 2.0 }, 0.0..1.0).unwrap_err();
    assert_eq!(failed.error.kind(), ErrorKind::Flow);
    let text = failed.to_string();
    assert!(text.contains("(current' = NaN)") && text.contains("state (current = "), "{text}");
}

/// Numbers, lists and a struct in a struct, over any number.
#[derive(Clone, Copy, Debug, PartialEq, State, Lift)]
struct Arm<const N: usize, D = f64> {
    #[unit("rad")]
    angles: [D; N],
    load: Load<D>,
    heat: D,
}

#[derive(Clone, Copy, Debug, PartialEq, State, Lift)]
struct Load<D = f64>(D, [D; 2]);

proptest! {
    /// Lifted and picked again, each coordinate is where it was.
    #[test]
    fn a_struct_is_lifted(values in prop::array::uniform7(-1e3..1e3_f64)) {
        let [a, b, c, d, e, f, g] = values;
        let x = Arm { angles: [a, b, c], load: Load(d, [e, f]), heat: g };
        let over: Arm<3, f64> = x.over();
        prop_assert_eq!(over, x);
        let doubled: Over<Arm<3>, f64> = x.lift(|i| 2.0 * x.get(i));
        for (i, value) in values.into_iter().enumerate() {
            prop_assert_eq!(x.pick(&doubled, i), 2.0 * value);
        }
        prop_assert!(x.pick(&doubled, 7).is_nan());
    }
}

/// A converter whose switch closes each period and opens after a part of it, the duty.
struct Converter {
    duty: f64,
    clocks: [(Clock, Switch); 2],
    /// A load that changes, and whether it is promised that no parameter moves when it does.
    stops: Vec<Clock>,
    stand: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Switch {
    Close,
    Open,
}

#[derive(Clone, Copy, Debug, PartialEq, State, Lift)]
struct Filter<D = f64> {
    #[unit("A")]
    current: D,
    #[unit("V")]
    voltage: D,
    closed: D,
}

const PERIOD: f64 = 1e-4;

impl Converter {
    fn of(duty: f64) -> Self {
        let clocks = [(Clock::every(PERIOD), Switch::Close), (Clock::every(PERIOD).after(duty * PERIOD), Switch::Open)];
        Self { duty, clocks, stops: vec![Clock::at([0.5e-3])], stand: true }
    }
}

impl Linearize for Converter {
    type Parameters = [f64; 1];
    fn parameters(&self) -> [f64; 1] {
        [self.duty]
    }
    fn flow_over<D: Number>(&self, (): (), t: D, x: Filter<D>, _: [D; 1]) -> Filter<D> {
        let load = if t.re() < 0.5e-3 { 4.0 } else { 8.0 };
        Filter {
            current: (x.closed * 12.0 - x.voltage) / 200e-6,
            voltage: (x.current - x.voltage / load) / 100e-6,
            closed: D::zero(),
        }
    }
    fn guard_over<D: Number>(&self, _: Switch, _t: D, _: Filter<D>, _: [D; 1]) -> D {
        D::one()
    }
    fn reset_over<D: Number>(&self, edge: Switch, _t: D, x: Filter<D>, _: [D; 1]) -> Filter<D> {
        Filter { closed: D::from(f64::from(u8::from(edge == Switch::Close))), ..x }
    }
    fn tick_over<D: Number>(&self, (): (), edge: Switch, t: f64, [duty]: [D; 1]) -> Option<D> {
        Some(if edge == Switch::Close { D::from(t) } else { D::from(t) + (duty - self.duty) * PERIOD })
    }
    fn stops_stand(&self, (): ()) -> bool {
        self.stand
    }
}

impl Automaton for Converter {
    type Mode = ();
    type State = Filter;
    type Edge = Switch;
    fn flow(&self, (): (), t: f64, x: &Filter) -> Filter {
        self.flow_at((), t, x)
    }
    fn edges(&self, (): ()) -> Edges<'_, Switch> {
        Edges::none()
    }
    fn guard(&self, edge: Switch, t: f64, x: &Filter) -> f64 {
        self.guard_at(edge, t, x)
    }
    fn clocks(&self, (): ()) -> Clocks<'_, Switch> {
        Clocks::kept(&self.clocks)
    }
    fn stops(&self, (): ()) -> std::borrow::Cow<'_, [Clock]> {
        (&self.stops).into()
    }
    fn reset(&self, (): (), edge: Switch, t: f64, x: &Filter) -> Result<((), Filter), Refusal> {
        Ok(((), self.reset_at(edge, t, x)))
    }
}

/// A named state is differentiated by a duty through clocks and stops as differences say, and its
/// columns have names.
#[test]
fn a_named_state_has_derivatives() {
    let start = Filter { current: 0.0, voltage: 0.0, closed: 1.0 };
    let voltage = |duty| {
        let converter = Converter::of(duty);
        Simulation::of(&converter).tolerance(1e-12).run((), start, 0.0..1.03e-3).unwrap().end.state.voltage
    };
    let converter = Converter::of(0.4);
    let by_duty = Sensitive::of(&converter, [Wrt::Parameter(0)]);
    let run = Simulation::of(&by_duty).tolerance(1e-12).run((), by_duty.start(0.0, start), 0.0..1.03e-3).unwrap();
    let difference = (voltage(0.4 + 1e-4) - voltage(0.4 - 1e-4)) / 2e-4;
    let by = run.end.state.columns[0].voltage;
    assert!((by / difference - 1.0).abs() < 1e-6, "{by}, {difference}");
    let headings = run.trajectory.sampled(1e-3).unwrap().to_string();
    assert!(
        headings.starts_with("t (s),j,mode,current (A),voltage (V),closed,current by q1,voltage by q1,closed by q1\n"),
        "{headings}"
    );
}

/// Whether a parameter moves a stop is not guessed: a derivative by a parameter wants the promise,
/// others do not.
#[test]
fn stops_without_a_promise() {
    let converter = Converter { stand: false, ..Converter::of(0.4) };
    let start = Filter { current: 0.0, voltage: 0.0, closed: 1.0 };
    let by_duty = Sensitive::of(&converter, [Wrt::Parameter(0)]);
    let error = Simulation::of(&by_duty).run((), by_duty.start(0.0, start), 0.0..1e-3).unwrap_err().error;
    assert_eq!(error.kind(), ErrorKind::Model);
    assert!(error.to_string().contains("has stops, and whether a parameter moves them is not given"), "{error}");
    let by_start = Sensitive::of(&converter, [Wrt::Initial(1)]);
    assert!(Simulation::of(&by_start).run((), by_start.start(0.0, start), 0.0..1e-3).is_ok());
}

/// Runs at night, when power is cheap: by a guard that switches in stops, beside one of the state.
struct Heater {
    power: f64,
    stops: [Clock; 1],
}

impl Linearize for Heater {
    type Parameters = [f64; 1];
    fn parameters(&self) -> [f64; 1] {
        [self.power]
    }
    fn flow_over<D: Number>(&self, on: bool, _t: D, x: D, [power]: [D; 1]) -> D {
        -x * 0.1 + if on { power } else { D::zero() }
    }
    fn guard_over<D: Number>(&self, on: bool, t: D, x: D, _: [D; 1]) -> D {
        let cheap = (t.re() / 6.0).floor() % 2.0 == 0.0;
        match (on, cheap) {
            (true, true) => -x + 20.0,
            (true, false) | (false, true) => D::from(-1.0),
            (false, false) => D::one(),
        }
    }
    fn reset_over<D: Number>(&self, _: bool, _t: D, x: D, _: [D; 1]) -> D {
        x
    }
    fn stops_stand(&self, _: bool) -> bool {
        true
    }
}

impl Automaton for Heater {
    type Mode = bool;
    type State = f64;
    type Edge = bool;
    fn flow(&self, on: bool, t: f64, x: &f64) -> f64 {
        self.flow_at(on, t, x)
    }
    fn edges(&self, on: bool) -> Edges<'_, bool> {
        Edges::from([on])
    }
    fn guard(&self, edge: bool, t: f64, x: &f64) -> f64 {
        self.guard_at(edge, t, x)
    }
    fn stops(&self, _: bool) -> std::borrow::Cow<'_, [Clock]> {
        (&self.stops).into()
    }
    fn reset(&self, on: bool, edge: bool, t: f64, x: &f64) -> Result<(bool, f64), Refusal> {
        Ok((!on, self.reset_at(edge, t, x)))
    }
}

/// A jump in a stop has a time that nothing moves, and is no graze; as differences say.
#[test]
fn derivatives_through_guards_that_switch() {
    let heater = |power| Heater { power, stops: [Clock::every(6.0)] };
    for end in [5.0, 11.0, 17.5, 47.0] {
        let at = |power: f64, start: f64| {
            let run = Simulation::of(&heater(power)).tolerance(1e-12).run(true, start, 0.5..end).unwrap();
            (run.end.state, run.trajectory.jumps().len())
        };
        let model = heater(3.0);
        let both = Sensitive::of(&model, [Wrt::Parameter(0), Wrt::Initial(0)]);
        let run = Simulation::of(&both).tolerance(1e-12).run(true, both.start(0.5, 10.0), 0.5..end).unwrap();
        assert_eq!(run.trajectory.jumps().len(), at(3.0, 10.0).1);
        let step = 1e-4;
        let by_power = (at(3.0 + step, 10.0).0 - at(3.0 - step, 10.0).0) / (2.0 * step);
        let by_start = (at(3.0, 10.0 + step).0 - at(3.0, 10.0 - step).0) / (2.0 * step);
        let [power, start] = run.end.state.columns;
        assert!(
            (power - by_power).abs() < 1e-6 && (start - by_start).abs() < 1e-6,
            "{power} {by_power}, {start} {by_start}"
        );
    }
}

/// Fills at a rate, and is emptied above a mark given by a table.
struct Marked {
    rate: f64,
    mark: saltus::Signal,
    stops: [Clock; 1],
}

impl Linearize for Marked {
    type Parameters = [f64; 1];
    fn parameters(&self) -> [f64; 1] {
        [self.rate]
    }
    fn flow_over<D: Number>(&self, (): (), _t: D, _x: D, [rate]: [D; 1]) -> D {
        rate
    }
    fn guard_over<D: Number>(&self, (): (), t: D, x: D, _: [D; 1]) -> D {
        self.mark.over(t) - x
    }
    fn reset_over<D: Number>(&self, (): (), _t: D, _x: D, _: [D; 1]) -> D {
        D::zero()
    }
    fn stops_stand(&self, (): ()) -> bool {
        true
    }
}

impl Automaton for Marked {
    type Mode = ();
    type State = f64;
    type Edge = ();
    fn flow(&self, (): (), t: f64, x: &f64) -> f64 {
        self.flow_at((), t, x)
    }
    fn edges(&self, (): ()) -> Edges<'_, ()> {
        Edges::from([()])
    }
    fn guard(&self, edge: (), t: f64, x: &f64) -> f64 {
        self.guard_at(edge, t, x)
    }
    fn stops(&self, (): ()) -> std::borrow::Cow<'_, [Clock]> {
        (&self.stops).into()
    }
    fn reset(&self, (): (), edge: (), t: f64, x: &f64) -> Result<((), f64), Refusal> {
        Ok(((), self.reset_at(edge, t, x)))
    }
}

/// A mark that falls is met earlier by its own rate; one that leaps is met when it leaps.
#[test]
fn derivatives_through_marks_by_a_table() {
    let linear = saltus::Signal::linear([(0.0, 4.0), (4.0, 0.0)]).unwrap();
    let held = saltus::Signal::held([(0.0, 9.0), (2.0, 1.5)]).unwrap();
    for (mark, later, by_rate) in [(linear, -1.0, 1.5), (held, 0.0, 0.5)] {
        let tank = Marked { rate: 1.0, stops: [mark.stops()], mark };
        let by = Sensitive::of(&tank, [Wrt::Parameter(0)]);
        let run = Simulation::of(&by).run((), by.start(0.0, 0.0), 0.0..2.5).unwrap();
        let jump = run.trajectory.jumps()[0];
        assert!((jump.t() - 2.0).abs() < 1e-9 && (jump.after.dt[0] - later).abs() < 1e-9, "{jump:?}");
        assert!((run.end.state.columns[0] - by_rate).abs() < 1e-9, "{}", run.end.state.columns[0]);
    }
}

/// A format whose numbers lose their last digit neither takes a tick twice nor loses one.
#[test]
fn a_checkpoint_through_rounded_numbers() {
    let clocks = || Clock::every(0.3).after(0.1);
    let model = Hybrid::new().mode("run", |_t, _x: &f64| 0.0).clock("run", "run", clocks(), |_t, x| x + 1.0).clock(
        "run",
        "run",
        Clock::every(0.1),
        |_t, x| x + 1000.0,
    );
    let simulation = Simulation::of(&model);
    let whole = simulation.run("run", 0.0, 0.0..30.0).unwrap().end.state;
    let mut course = simulation.start("run", 0.0, 0.0..30.0).unwrap();
    let mut pauses = 0;
    while course.advance(&mut ()).unwrap().is_none() {
        let text = serde_json::to_string(&course.checkpoint()).unwrap();
        let read: saltus::CheckpointOf<Hybrid<f64>> = serde_json::from_str(text.leak()).unwrap();
        assert_eq!(simulation.resume(read).finish(&mut ()).unwrap().state, whole);
        pauses += 1;
    }
    assert!(pauses > 300);
}
