//! How large the numbers of a state are in a motion: what errors are measured by where numbers vanish.
//!
//! The one idea: units are the user's, so nothing is measured against 1. On the way q + v t + a t²/2 there is a time in which
//! the pull changes by what it is, or turns the velocity by what it is; so fast and so far as that leads is the size of
//! velocities and of places. Of several coordinates √M q̇ are of one kind, M being what a coordinate has for its mass: what
//! rests at first, and is moved by the rounding of others alone, has the size that they give it.

use super::model::Model;
use crate::expressions::Machine;
use crate::ode::system::Form;

/// The times that are looked at: the span of the run and so many halves of it.
const HALVES: i32 = 60;
/// A coordinate whose mass vanishes, as at the pole of a chart, has at least this part of the largest √M.
const LIGHTEST: f64 = 1e-4;

/// The sizes, all positive, of the numbers of a state from which a run goes over a span; 1 where nothing at all is told.
pub(super) fn sizes(model: &Model, parameters: &[f64], (t0, end): (f64, f64), y0: &[f64]) -> Vec<f64> {
    let mut motion = Beginning::new(model, parameters, t0, y0);
    let span = (end - t0).abs();
    let (speed, pull) = (motion.weighed(&motion.velocity), motion.weighed(&motion.pull));
    let moves = speed.max(pull) > 0.0;
    let (mut time, mut pushed) = (span, 0.0_f64);
    for halves in (0..=HALVES).rev() {
        let part = span * 2.0_f64.powi(-halves);
        let pull_there = motion.pull_after(part.copysign(end - t0));
        let change: Vec<f64> =
            pull_there.iter().zip(&motion.pull).map(|(there, here)| there - here).collect();
        let push = part * motion.weighed(&change);
        let known = pull_there.iter().all(|pull| pull.is_finite());
        if !known || (moves && 2.0 * push >= speed.max(part * pull)) {
            time = part;
            break;
        }
        pushed = pushed.max(push);
    }
    // What rests until a force begins goes as fast as that makes it.
    let fast = if moves { speed.max(time * pull) } else { pushed };
    let told = |size: f64| if size > 0.0 && size.is_finite() { size } else { 1.0 };
    let places = motion.roots.iter().map(|root| told(fast * time / root));
    let second =
        motion.roots.iter().map(|root| told(if motion.of_momenta { fast * root } else { fast / root }));
    places.chain(second).collect()
}

/// A motion at its beginning.
struct Beginning<'a> {
    equations: Machine<f64>,
    columns: Machine<f64>,
    t0: f64,
    y0: &'a [f64],
    /// Whether the second half of a state is momenta, whose velocities are others.
    of_momenta: bool,
    velocity: Vec<f64>,
    /// The rates of the second half.
    rates: Vec<f64>,
    /// √M of each coordinate.
    roots: Vec<f64>,
    /// Accelerations.
    pull: Vec<f64>,
}

impl<'a> Beginning<'a> {
    fn new(model: &Model, parameters: &[f64], t0: f64, y0: &'a [f64]) -> Self {
        let n = model.source.coordinates;
        let mut motion = Self {
            equations: Machine::new(model.code.clone(), parameters),
            columns: Machine::new(model.columns.clone(), parameters),
            t0,
            y0,
            of_momenta: matches!(model.form, Form::FirstOrder(_)),
            velocity: y0[n..].to_vec(),
            rates: Vec::new(),
            roots: vec![1.0; n],
            pull: Vec::new(),
        };
        if motion.of_momenta {
            motion.velocity = motion.conjugates(y0);
        }
        motion.roots = motion.roots_of_masses();
        motion.rates = motion.rates_at(y0, 0.0);
        motion.pull = motion.accelerations(&motion.rates);
        motion
    }

    /// The largest of a vector of velocities or accelerations, weighed by √M.
    fn weighed(&self, vector: &[f64]) -> f64 {
        let weighed = vector.iter().zip(&self.roots).map(|(x, root)| (x * root).abs());
        weighed.filter(|x| x.is_finite()).fold(0.0, f64::max)
    }

    /// Momenta of velocities, or velocities of momenta.
    fn conjugates(&mut self, y: &[f64]) -> Vec<f64> {
        let mut found = vec![0.0; y.len() / 2];
        self.columns.evaluate(self.t0, y, &mut found);
        found
    }

    /// √M, from how a conjugate number grows with its own.
    fn roots_of_masses(&mut self) -> Vec<f64> {
        let n = self.y0.len() / 2;
        let here = self.conjugates(self.y0);
        let mut roots = Vec::with_capacity(n);
        for i in 0..n {
            let mut y = self.y0.to_vec();
            let own = y[n + i].abs();
            let more = if own > 0.0 { own } else { 1.0 };
            y[n + i] += more;
            let root = ((self.conjugates(&y)[i] - here[i]) / more).abs().sqrt();
            roots.push(if self.of_momenta { 1.0 / root } else { root });
        }
        let known = |root: f64| root.is_finite() && root > 0.0;
        let largest = roots.iter().copied().filter(|&root| known(root)).fold(0.0, f64::max);
        let least = if largest > 0.0 { LIGHTEST * largest } else { 1.0 };
        roots.iter().map(|&root| if known(root) { root.max(least) } else { least }).collect()
    }

    /// The rates of the second half of a state.
    fn rates_at(&mut self, y: &[f64], after: f64) -> Vec<f64> {
        let n = y.len() / 2;
        let mut rates = vec![0.0; if self.of_momenta { 2 * n } else { n }];
        self.equations.evaluate(self.t0 + after, y, &mut rates);
        rates.split_off(rates.len() - n)
    }

    fn accelerations(&self, rates: &[f64]) -> Vec<f64> {
        let of = |(rate, root): (&f64, &f64)| if self.of_momenta { rate / (root * root) } else { *rate };
        rates.iter().zip(&self.roots).map(of).collect()
    }

    /// Accelerations on the way.
    fn pull_after(&mut self, time: f64) -> Vec<f64> {
        let n = self.y0.len() / 2;
        let mut y = self.y0.to_vec();
        for i in 0..n {
            y[i] += time * (self.velocity[i] + 0.5 * time * self.pull[i]);
            y[n + i] += time * self.rates[i];
        }
        let rates = self.rates_at(&y, time);
        self.accelerations(&rates)
    }
}
