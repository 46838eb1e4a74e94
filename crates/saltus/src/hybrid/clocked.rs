//! Edges that clocks take, and the times at which a flow is not smooth.

use std::borrow::Cow;
use std::sync::OnceLock;

use super::names::kept;
use super::{Edge, Hybrid, Link};
use crate::automaton::clocks::Clock;
use crate::error::Refusal;
use crate::state::State;

impl<'a, S: State> Hybrid<'a, S> {
    /// Declares an edge that a clock takes; see [`Clock`].
    ///
    /// ```
    /// use saltus::{Clock, Hybrid, Simulation};
    /// let kicked = Hybrid::new()
    ///     .mode("drift", |_t, _x: &f64| 0.0)
    ///     .clock("drift", "drift", Clock::every(0.1), |_t, x| x + 1.0);
    /// let run = Simulation::of(&kicked).run("drift", 0.0, 0.0..1.05)?;
    /// assert_eq!(run.end.state, 10.0);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn clock(
        self,
        from: impl Into<Cow<'static, str>>,
        to: impl Into<Cow<'static, str>>,
        clock: Clock,
        reset: impl Fn(f64, &S) -> S + Send + Sync + 'a,
    ) -> Self {
        self.fallible_clock(from, to, clock, move |t, x| Ok(reset(t, x)))
    }

    /// Declares an edge that a clock takes and whose reset may fail: the run then fails with the
    /// [`Refusal`], with time, mode and state.
    ///
    /// ```
    /// use saltus::{Clock, ErrorKind, Hybrid, Refusal, Simulation};
    /// let read = |_t: f64, x: &f64| if *x < 2.0 { Ok(*x) } else { Err(Refusal::new("the sensor is full")) };
    /// let tank = Hybrid::new()
    ///     .mode("fill", |_t, _x: &f64| 1.0)
    ///     .fallible_clock("fill", "fill", Clock::every(0.5), read);
    /// let error = Simulation::of(&tank).run("fill", 0.0, 0.0..9.0).unwrap_err().error;
    /// assert_eq!((error.kind(), error.t()), (ErrorKind::Refused, 2.0));
    /// ```
    #[must_use]
    pub fn fallible_clock(
        mut self,
        from: impl Into<Cow<'static, str>>,
        to: impl Into<Cow<'static, str>>,
        clock: Clock,
        reset: impl Fn(f64, &S) -> Result<S, Refusal> + Send + Sync + 'a,
    ) -> Self {
        let (from, to) = (kept(from), kept(to));
        let mode = self.entry_of(from);
        let place = mode.edges.len();
        mode.edges.push((to, Edge::clocked(reset)));
        mode.clocks.push((clock, Link { from, to, place }));
        self.clocked = true;
        self.last = Some(from);
        self
    }

    /// Declares an edge that a [`clock`](Self::clock) takes and that keeps the state: only the mode
    /// changes. Clocks that tick together all take their edges: two modes that each leave for the
    /// other at one instant are left and entered again.
    ///
    /// ```
    /// use saltus::{Clock, Hybrid, Simulation};
    /// // On for 0.3 of each second.
    /// let lamp = Hybrid::new()
    ///     .mode("on", |_t, _x: &f64| 1.0)
    ///     .mode("off", |_t, _x| 0.0)
    ///     .switch_at("off", "on", Clock::every(1.0))
    ///     .switch_at("on", "off", Clock::every(1.0).after(0.3));
    /// let run = Simulation::of(&lamp).run("on", 0.0, 0.0..10.0)?;
    /// assert!((run.end.state - 3.0).abs() < 1e-12);
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn switch_at(self, from: impl Into<Cow<'static, str>>, to: impl Into<Cow<'static, str>>, clock: Clock) -> Self {
        self.clock(from, to, clock, |_t, x| x.clone())
    }

    /// Says when the flow of a mode is not smooth in time: a step ends at each of these times, and
    /// nothing else happens. See [`Automaton::stops`](crate::Automaton::stops).
    ///
    /// ```
    /// use saltus::{Clock, Hybrid, Simulation};
    /// // A pulse of one microsecond in a minute is not stepped over.
    /// let kicked = Hybrid::new()
    ///     .mode("drift", |t, _x: &f64| if (30.0..30.000_001).contains(&t) { 1e6 } else { 0.0 })
    ///     .stops("drift", Clock::at([30.0, 30.000_001]));
    /// let run = Simulation::of(&kicked).run("drift", 0.0, 0.0..60.0)?;
    /// assert!((run.end.state - 1.0).abs() < 1e-8 && run.trajectory.jumps().is_empty());
    /// # Ok::<(), saltus::Error>(())
    /// ```
    #[must_use]
    pub fn stops(mut self, name: impl Into<Cow<'static, str>>, stops: Clock) -> Self {
        self.entry_of(kept(name)).stops.push(stops);
        self.stopped = true;
        self
    }

    /// [`stops`](Self::stops) of every mode, those that are declared later as well: for an input
    /// that all of them read. Those of several inputs add up.
    ///
    /// ```
    /// use saltus::{Hybrid, Signal, Simulation};
    /// let outside = Signal::linear([(0.0, 0.0), (12.0, 12.0)])?.repeated(24.0)?;
    /// let house = Hybrid::new()
    ///     .stops_everywhere(outside.stops())
    ///     .mode("off", |t, x: &f64| 0.1 * (outside.at(t) - x))
    ///     .mode("on", |t, x| 0.1 * (outside.at(t) - x) + 2.0)
    ///     .edge("off", "on", |_t, x| x - 19.0, |_t, x| x.clone())
    ///     .edge("on", "off", |_t, x| 21.0 - x, |_t, x| x.clone());
    /// let run = Simulation::of(&house).run("off", 20.0, 0.0..48.0)?;
    /// assert!(run.end.stats.jumps > 10);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn stops_everywhere(mut self, stops: Clock) -> Self {
        self.modes.iter_mut().for_each(|mode| mode.stops.push(stops.clone()));
        self.everywhere.push(stops);
        self.stopped = true;
        self.flaw = OnceLock::new();
        self
    }
}
