//! A network of leaky neurons that lift each other as they spike: states of any length, and what a
//! spike costs as the network grows.
//!
//! `cargo run --example neurons` compares spikes with the exact solution;
//! `cargo run --profile dist --example neurons -- cost` times them, and draws `docs/trust/neurons.svg`.

use std::error::Error;
use std::ops::ControlFlow;
use std::time::Instant;

use saltus::{About, Automaton, Edges, Entry, JumpOf, Observer, Refusal, Simulation, Vector};
use saltus_examples::growth;

/// Leaky integrate-and-fire neurons, u' = I - u, each coupled to all others (R. Mirollo, S.
/// Strogatz, SIAM J. Appl. Math. 50 (1990) 1645): at u = 1 a neuron spikes, begins anew at 0, and
/// lifts each other one by a pulse; what is lifted to 1 spikes at once.
struct Network {
    /// I of each neuron.
    currents: Vec<f64>,
    pulse: f64,
    neurons: Vec<usize>,
}

impl Network {
    /// Currents and starts that no two of `n` neurons share: multiples of irrational numbers.
    fn of(n: usize) -> (Self, Vector) {
        let part = |i: usize, of: f64| (i as f64 * of).fract();
        let currents = (0..n).map(|i| 1.5 + 0.5 * part(i, 0.754_877_666_246_693)).collect();
        let start = Vector::from_fn(n, |i| part(i, 0.569_840_290_998_053));
        (Self { currents, pulse: 0.1 / n as f64, neurons: (0..n).collect() }, start)
    }

    /// The neurons that spike first and when, by u = I - (I - u₀) exp(-t) from spike to spike.
    fn exact(&self, mut u: Vector, spikes: usize) -> Vec<(usize, f64)> {
        let (mut t, mut found) = (0.0, Vec::new());
        while found.len() < spikes {
            let due = |i: usize| ((self.currents[i] - u[i]) / (self.currents[i] - 1.0)).ln().max(0.0);
            let (next, by) = (0..u.len()).map(|i| (i, due(i))).min_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((0, 0.0));
            let keeps = (-by).exp();
            for (i, u) in u.iter_mut().enumerate() {
                *u = self.currents[i] - (self.currents[i] - *u) * keeps + self.pulse;
            }
            u[next] = 0.0;
            t += by;
            found.push((next, t));
        }
        found
    }
}

impl Automaton for Network {
    type Mode = ();
    type State = Vector;
    type Edge = usize;

    fn flow(&self, (): (), _t: f64, u: &Vector) -> Vector {
        self.currents.iter().zip(u.iter()).map(|(current, u)| current - u).collect()
    }
    fn edges(&self, (): ()) -> Edges<'_, usize> {
        Edges::kept(&self.neurons)
    }
    fn guard(&self, neuron: usize, _t: f64, u: &Vector) -> f64 {
        1.0 - u[neuron]
    }
    fn about(&self, neuron: usize) -> About {
        About::new().affine().reads(neuron..neuron + 1).entry(Entry::Fire)
    }
    fn reset(&self, (): (), neuron: usize, _t: f64, u: &Vector) -> Result<((), Vector), Refusal> {
        let mut after: Vector = u.iter().map(|u| u + self.pulse).collect();
        after[neuron] = 0.0;
        Ok(((), after))
    }
}

/// Keeps who spikes, and when.
struct Spikes(Vec<(usize, f64)>);

impl Observer<Network> for Spikes {
    fn wants_pieces(&self) -> bool {
        false
    }
    fn jump(&mut self, jump: &JumpOf<Network>) -> ControlFlow<()> {
        self.0.extend(jump.edge().map(|neuron| (neuron, jump.t())));
        ControlFlow::Continue(())
    }
}

/// How far so many spikes of `n` neurons are off the exact ones, in time constants, and the seconds
/// that each took.
fn measured(n: usize, spikes: usize) -> Result<(f64, f64), Box<dyn Error>> {
    let (network, start) = Network::of(n);
    let mut found = Spikes(Vec::with_capacity(spikes));
    let began = Instant::now();
    Simulation::of(&network).most_jumps(spikes).drive((), start.clone(), 0.0..f64::INFINITY, &mut found)?;
    let each = began.elapsed().as_secs_f64() / spikes as f64;
    let exact = network.exact(start, spikes);
    let same = exact.iter().zip(&found.0).all(|(exact, found)| exact.0 == found.0);
    if exact.len() != found.0.len() || !same {
        return Err(format!("of {n} neurons others spike than by the exact solution").into());
    }
    let off = exact.iter().zip(&found.0).map(|(exact, found)| (exact.1 - found.1).abs());
    Ok((off.fold(0.0, f64::max), each))
}

fn main() -> Result<(), Box<dyn Error>> {
    if std::env::args().nth(1).as_deref() != Some("cost") {
        for n in [10, 100] {
            let (off, _) = measured(n, 3 * n)?;
            println!("{n} neurons: {} spikes, off by {off:.0e} time constants at most", 3 * n);
            assert!(off < 1e-6);
        }
        return Ok(());
    }
    let mut points = Vec::new();
    for n in [10, 32, 100, 316, 1000, 3162, 10_000] {
        let spikes = (200_000 / n).clamp(100, 5000);
        // The first run makes room.
        measured(n, 10)?;
        let (off, each) = measured(n, spikes)?;
        println!("{n:6} neurons: {:9.1} µs a spike, off by {off:.0e}", 1e6 * each);
        points.push([(n as f64).log10(), (1e6 * each).log10()]);
    }
    growth("neurons", "a spike of N coupled neurons", ["neurons (log₁₀ N)", "time of a spike (log₁₀ µs)"], points)?;
    Ok(())
}
