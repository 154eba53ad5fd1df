//! Shared by the property tests: problems, and a plain way of running a method on them.
#![allow(dead_code, missing_docs, unreachable_pub, reason = "every test binary takes what it needs")]

use visviva_core::Result;
use visviva_core::forces::gravity::closed::ClosedKernel;
use visviva_core::forces::gravity::series::{EachPair, RingPairs};
use visviva_core::forces::gravity::{FewBodies, Ring};
use visviva_core::forces::series::Series;
use visviva_core::forces::{Dynamics, Force, Phase};
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::numerics::element::{Element, Shape};
use visviva_core::numerics::lanes::Lanes;
use visviva_core::ode::fixed::Recorder;
use visviva_core::ode::norm::Norm;
use visviva_core::ode::runge_kutta::RungeKuttaStep;
use visviva_core::ode::series::Jet;
use visviva_core::ode::state::State;
use visviva_core::ode::step_control::{Clock, Controlled};
use visviva_core::ode::stepper::{Stepper, stepper};
use visviva_core::ode::system::System;
use visviva_core::ode::trial::{Trial, trial};
use visviva_core::ode::{Method, Scheme};
use visviva_core::parallel::{Control, Ticker};

/// Hénon and Heiles's potential: the textbook nonlinear oscillator, polynomial and so the same for any scalar.
pub struct HenonHeiles;

impl<S: Element> Force<S> for HenonHeiles {
    fn apply(&mut self, phase: &Phase<'_, S>, a: &mut [S], first: bool, _: &mut Ticker<'_>) -> Result<()> {
        let (x, y) = (phase.q[0], phase.q[1]);
        let terms = [-x - S::splat(2.0) * x * y, y * y - x * x - y];
        for (a, term) in a.iter_mut().zip(terms) {
            *a = if first { term } else { *a + term };
        }
        Ok(())
    }
}

impl<S: Element> Series<S> for HenonHeiles {
    fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<S>,
        a: &mut [S],
        first: bool,
        _: &mut Ticker<'_>,
    ) -> Result<()> {
        let product = |i: usize, j: usize| {
            (0..=n).fold(S::zero(), |sum, k| sum + jet.position(k)[i] * jet.position(n - k)[j])
        };
        let (x, y) = (jet.position(n)[0], jet.position(n)[1]);
        let terms = [-x - S::splat(2.0) * product(0, 1), product(1, 1) - product(0, 0) - y];
        for (a, term) in a.iter_mut().zip(terms) {
            let term = term * jet.unit * jet.unit;
            *a = if first { term } else { *a + term };
        }
        Ok(())
    }
}

/// `a = -q`: linear, so good for closed forms and round-off, and no good for measuring an order.
pub struct Harmonic;

impl<S: Element> Force<S> for Harmonic {
    fn apply(&mut self, phase: &Phase<'_, S>, a: &mut [S], first: bool, _: &mut Ticker<'_>) -> Result<()> {
        for (a, &q) in a.iter_mut().zip(phase.q) {
            *a = if first { -q } else { *a - q };
        }
        Ok(())
    }
}

/// A problem: its forces and where it starts.
pub struct Problem<S: Element> {
    pub dynamics: Dynamics<S>,
    pub state: State<S>,
    /// One mass per coordinate, in the layout of the state.
    pub mass: Vec<f64>,
}

fn splat<S: Element>(values: &[f64]) -> Vec<S> {
    values.iter().map(|&x| S::splat(x)).collect()
}

pub fn henon_heiles<S: Element>() -> Problem<S> {
    let shape = Shape { rows: 1, components: 2 };
    Problem {
        dynamics: Dynamics::new(shape, vec![Box::new(HenonHeiles)]).with_series(vec![Box::new(HenonHeiles)]),
        state: State::new(&splat(&[0.12, 0.3]), &splat(&[0.35, -0.2])),
        mass: vec![1.0; 2],
    }
}

pub fn harmonic<S: Element>() -> Problem<S> {
    let shape = Shape { rows: 1, components: 1 };
    Problem {
        dynamics: Dynamics::new(shape, vec![Box::new(Harmonic)]),
        state: State::new(&splat(&[1.0]), &splat(&[0.0])),
        mass: vec![1.0],
    }
}

/// Three unequal bodies in space, bound, with no symmetry and no close encounter for some time units.
pub fn three_bodies<S: ClosedKernel>() -> Problem<S>
where
    FewBodies<S>: Force<S>,
{
    let mass = [1.0, 0.5, 0.25];
    // Component after component.
    let q = [0.0, 1.0, -1.5, 0.0, 0.25, 0.5, 0.0, -0.125, 0.375];
    let v = [-0.125, 0.0, 0.5, -0.25, 0.75, -0.5, 0.0, 0.125, -0.25];
    bodies(&mass, &q, &v, 0.0)
}

/// Bodies under their mutual gravity, G = 1.
pub fn bodies<S: ClosedKernel>(mass: &[f64], q: &[f64], v: &[f64], softening: f64) -> Problem<S>
where
    FewBodies<S>: Force<S>,
{
    let shape = Shape { rows: mass.len(), components: 3 };
    let strength: Vec<S> = splat(mass);
    let series = EachPair::new(shape, strength.clone(), softening);
    Problem {
        dynamics: Dynamics::closed(FewBodies::new(shape, strength, vec![S::splat(softening)]))
            .with_series(vec![Box::new(series)]),
        state: State::new(&splat(q), &splat(v)),
        mass: mass.iter().copied().cycle().take(shape.len()).collect(),
    }
}

/// A method at a fixed step; of a method with step control, its tableau.
pub fn fixed_stepper<S: Element>(
    method: &'static Method,
    h: f64,
    system: &dyn System<S>,
    state: &State<S>,
) -> Box<dyn Stepper<S>> {
    match &method.scheme {
        Scheme::Embedded(embedded) => Box::new(RungeKuttaStep::new(&embedded.tableau, h, system, state)),
        _ => stepper(method, h, system, state).unwrap(),
    }
}

/// A method with step control and its clock, for a run from `state` to `end`; errors are measured from zero,
/// against `rtol` both relative and absolute.
pub fn adaptive<S: Controlled>(
    method: &'static Method,
    system: &dyn System<S>,
    shape: Shape,
    state: &State<S>,
    rtol: f64,
    end: f64,
) -> (Box<dyn Trial<S>>, Clock<S>, Norm<S>) {
    let mut norm = Norm::new(shape, system.form(), S::splat(rtol), false);
    for block in &mut norm.blocks {
        block.atol = vec![S::splat(rtol)];
    }
    let unlimited = S::splat(f64::INFINITY);
    (trial(method, system, state, unlimited).unwrap(), Clock::new(S::splat(end)), norm)
}

/// Takes `steps` steps of `h`.
pub fn advance<S: Element>(
    method: &'static Method,
    h: f64,
    steps: usize,
    state: &mut State<S>,
    system: &mut dyn System<S>,
) {
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    let mut stepper = fixed_stepper(method, h, system, state);
    for node in 0..steps as u64 {
        assert_eq!(stepper.step(node, 1, state, system, &mut ticker), Ok(1));
    }
    stepper.settle(state);
}

/// Largest difference of any coordinate or velocity, compensations included.
pub fn distance(a: &State<DoubleDouble>, b: &State<DoubleDouble>) -> f64 {
    let ((a, a_rest), (b, b_rest)) = (a.all(), b.all());
    (0..a.len()).map(|i| ((a[i] - b[i]) + (a_rest[i] - b_rest[i])).to_f64().abs()).fold(0.0, f64::max)
}

/// A state of doubles with its compensations, as double-doubles.
pub fn exactly(state: &State<f64>) -> State<DoubleDouble> {
    let pair = |x: &[f64], rest: &[f64]| -> Vec<DoubleDouble> {
        x.iter().zip(rest).map(|(&x, &rest)| DoubleDouble::sum(x, rest)).collect()
    };
    State::new(&pair(state.q(), state.q_compensation()), &pair(state.v(), state.v_compensation()))
}

/// `Σ m v` and `Σ m x × v` of bodies in component-major layout, summed in double-double.
pub fn momenta(state: &State<DoubleDouble>, mass: &[f64]) -> [DoubleDouble; 6] {
    let rows = mass.len() / 3;
    let zero = DoubleDouble::default();
    let mut sums = [zero; 6];
    let get = |values: &[DoubleDouble], rest: &[DoubleDouble], c: usize, i: usize| {
        values[c * rows + i] + rest[c * rows + i]
    };
    for i in 0..rows {
        let m = DoubleDouble::from(mass[i]);
        let x: [DoubleDouble; 3] = core::array::from_fn(|c| get(state.q(), state.q_compensation(), c, i));
        let v: [DoubleDouble; 3] = core::array::from_fn(|c| get(state.v(), state.v_compensation(), c, i));
        for c in 0..3 {
            let (d, e) = ((c + 1) % 3, (c + 2) % 3);
            sums[c] += m * v[c];
            sums[3 + c] += m * (x[d] * v[e] - x[e] * v[d]);
        }
    }
    sums
}

/// Five bodies on a ring of lanes, as a scene packs them.
pub fn five_lanes() -> Problem<Lanes> {
    let shape = Shape { rows: 1, components: 3 };
    let lanes = |values: [f64; 5]| {
        Lanes(core::array::from_fn(|lane| values.get(lane).copied().unwrap_or(1e3 * lane as f64)))
    };
    let q = [[0.0, 2.0, -3.0, 5.0, -6.5], [0.0, 0.5, 1.0, -4.0, 4.0], [0.0, -0.25, 0.5, 1.0, -1.0]];
    let v = [[0.1, 0.2, -0.3, 0.3, -0.2], [-0.2, 0.6, -0.5, 0.4, -0.4], [0.0, 0.1, -0.1, 0.1, 0.2]];
    let still = v.map(|v| Lanes(core::array::from_fn(|lane| v.get(lane).copied().unwrap_or_default())));
    let strength = vec![1.0, 0.7, 0.4, 0.01, 1e-6];
    let series = RingPairs::new(shape, &strength, 0.0);
    Problem {
        dynamics: Dynamics::new(shape, vec![Box::new(Ring::new(shape, strength, 0.0))])
            .with_series(vec![Box::new(series)]),
        state: State::new(&q.map(lanes), &still),
        mass: vec![],
    }
}

/// Keeps every state that is recorded.
pub struct Keep<S>(pub Vec<(usize, State<S>)>);

impl<S: Element> Recorder<S> for Keep<S> {
    fn record(&mut self, index: usize, state: &State<S>, _: &mut Ticker<'_>) -> Result<()> {
        self.0.push((index, state.clone()));
        Ok(())
    }
    fn goes_on(&mut self, _: &State<S>) -> bool {
        true
    }
}
