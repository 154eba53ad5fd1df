//! What steps in another time promise, without a scene: order, reversal, a symplectic map, a conic.

use super::*;
use crate::ode::system::Form;
use crate::ode::{Method, Scheme};
use crate::parallel::Control;
use crate::registry::METHODS;

/// One body of mass 1 about a fixed center with V = −1/r − 0.1/r³, the first term alone if it is Kepler's.
struct Orbit {
    kepler: bool,
}

impl<S: Controlled> System<S> for Orbit {
    fn form(&self) -> Form {
        Form::SecondOrder(2)
    }
    fn evaluations(&self) -> u64 {
        0
    }
    fn acceleration(&mut self, _: &S, q: &[S], _: &[S], a: &mut [S], _: &mut Ticker<'_>) -> Result<()> {
        let gradient = self.gradient(q);
        a.copy_from_slice(&gradient);
        Ok(())
    }
    fn monitor(&mut self) -> Option<&mut dyn Monitor<S>> {
        Some(self)
    }
}

impl Orbit {
    fn powers<S: Controlled>(q: &[S]) -> (S, S) {
        let r2 = q[0] * q[0] + q[1] * q[1];
        (S::one() / r2.sqrt(), S::one() / r2)
    }
    fn extra(&self) -> f64 {
        if self.kepler { 0.0 } else { 0.1 }
    }
    /// ∂(−V)/∂q.
    fn gradient<S: Controlled>(&self, q: &[S]) -> [S; 2] {
        let (u, u2) = Self::powers(q);
        let pull = u * u2 + S::splat(3.0 * self.extra()) * u * u2 * u2;
        [-(pull * q[0]), -(pull * q[1])]
    }
}

impl<S: Controlled> Monitor<S> for Orbit {
    fn at(&mut self, q: &[S], gradient: &mut [S]) -> S {
        if !gradient.is_empty() {
            gradient.copy_from_slice(&self.gradient(q));
        }
        let (u, u2) = Self::powers(q);
        u + S::splat(self.extra()) * u * u2
    }
    fn kinetic_energy(&self, v: &[S]) -> S {
        S::splat(0.5) * (v[0] * v[0] + v[1] * v[1])
    }
}

const BOTH: [Transformation; 2] = Transformation::ALL;

/// Coordinates, velocities, the number beside them (W, or the binding energy) and the time.
type Point<S> = [S; 6];

fn start<S: Controlled>(by: Transformation, kepler: bool) -> Point<S> {
    let [x, y, vx, vy] = [1.4, 0.2, 0.1, 0.5].map(S::splat);
    let mut orbit = Orbit { kepler };
    let (omega, kinetic) =
        (Monitor::<S>::at(&mut orbit, &[x, y], &mut []), Monitor::<S>::kinetic_energy(&orbit, &[vx, vy]));
    let beside = if by == Transformation::Distance { omega } else { omega - kinetic };
    [x, y, vx, vy, beside, S::zero()]
}

/// Steps of a method from a point on.
fn steps<S: Controlled>(
    method: &Method,
    by: Transformation,
    kepler: bool,
    (h, count): (f64, usize),
    from: Point<S>,
) -> Point<S> {
    let Scheme::Splitting(table) = &method.scheme else { panic!("{} is no splitting", method.name) };
    let control = Control::default();
    let mut ticker = Ticker::quiet(&control);
    let mut orbit = Orbit { kepler };
    let [x, y, vx, vy, weight, t] = from;
    let mut state = State::new(&[x, y], &[vx, vy]);
    let system: &mut dyn System<S> = &mut orbit;
    let trial = Transformed::new(table, by, S::one(), system, &state, false);
    let mut beside = Beside { weight: (weight, S::zero()), ..trial.beside.clone() };
    let [mut shares, _] = trial.shares.clone();
    let mut time = t;
    for _ in 0..count {
        let h = (S::splat(h), Time::Transformed);
        let (taken, rest) = trial
            .moves
            .advance(h, S::zero(), (&mut state, &mut beside, &mut shares), system, &mut ticker)
            .unwrap();
        time += taken + rest;
    }
    let (q, v) = (state.q(), state.v());
    let rest = state.all().1;
    let whole = beside.weight.0 + beside.weight.1;
    [q[0] + rest[0], q[1] + rest[1], v[0] + rest[2], v[1] + rest[3], whole, time]
}

fn transforming() -> impl Iterator<Item = &'static Method> {
    METHODS.iter().copied().filter(|method| method.transforms())
}

fn apart(a: &Point<DoubleDouble>, b: &Point<DoubleDouble>) -> f64 {
    a.iter().zip(b).map(|(&a, &b)| (a - b).to_f64().abs()).fold(0.0, f64::max)
}

#[test]
fn only_symmetric_compositions_of_any_two_flows_transform() {
    let names: Vec<&str> = transforming().map(|method| method.name).collect();
    assert!(names.contains(&"leapfrog") && names.contains(&"blanes_moan_s10") && names.len() >= 13);
    for other in ["symplectic_euler", "ruth3", "blanes_moan_rkn6_14", "boris4", "rk4", "dop853", "stormer13"]
    {
        assert!(!names.contains(&other), "{other}");
    }
}

#[test]
fn the_order_is_that_of_the_method() {
    for method in transforming() {
        for by in BOTH {
            let reference = METHODS.iter().find(|other| other.name == "sofroniou_spaletta10").unwrap();
            let from = start::<DoubleDouble>(by, false);
            let exact = steps(reference, by, false, (2.0 / 1024.0, 1024), from);
            // A power of two: the end is the same to the last of thirty digits.
            let count = 64;
            let error =
                |count: usize| apart(&steps(method, by, false, (2.0 / count as f64, count), from), &exact);
            let order = (error(count) / error(2 * count)).log2();
            let meant = f64::from(method.order);
            assert!((order - meant).abs() < 0.15, "{} by {}: order {order}", method.name, by.name());
        }
    }
}

#[test]
fn a_step_back_undoes_a_step() {
    for method in transforming() {
        for by in BOTH {
            let from = start::<f64>(by, false);
            let there = steps(method, by, false, (0.05, 50), from);
            let back = steps(method, by, false, (-0.05, 50), there);
            let error = back.iter().zip(from).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            // Some ulps of each of a hundred steps.
            assert!(error < 1e-13, "{} by {}: {error:e}", method.name, by.name());
        }
    }
}

#[test]
fn two_bodies_stay_on_their_conic() {
    for method in
        transforming().filter(|method| method.name.contains("leapfrog") || method.name == "kahan_li8")
    {
        for by in BOTH {
            let from = start::<DoubleDouble>(by, true);
            let to = steps(method, by, true, (0.3, 20), from);
            let energy = |p: &Point<DoubleDouble>| {
                DoubleDouble::splat(0.5) * (p[2] * p[2] + p[3] * p[3]) - Orbit::powers(&p[..2]).0
            };
            let error = (energy(&to) - energy(&from)).to_f64().abs();
            assert!(error < 1e-28, "{} by {}: {error:e}", method.name, by.name());
        }
    }
}

/// In the coordinates (x, y, t) and their momenta (vx, vy, B) the map of the logarithmic Hamiltonian has MᵀJM = J.
#[test]
fn the_logarithmic_hamiltonian_is_symplectic_in_extended_phase_space() {
    let by = Transformation::PotentialEnergy;
    // The time and the binding energy are a pair: dt/ds = ∂Γ/∂B.
    let pairs = [(0, 2), (1, 3), (5, 4)];
    for method in transforming() {
        let from = start::<DoubleDouble>(by, false);
        let step = 1e-8;
        let mut columns = Vec::new();
        for place in 0..6 {
            let shifted = |sign: f64| {
                let mut point = from;
                point[place] += DoubleDouble::from(sign * step);
                steps(method, by, false, (0.3, 1), point)
            };
            let (up, down) = (shifted(1.0), shifted(-1.0));
            let slope = |i: usize| ((up[i] - down[i]).to_f64()) / (2.0 * step);
            columns.push([0, 1, 2, 3, 4, 5].map(slope));
        }
        for a in 0..6 {
            for b in 0..6 {
                let product: f64 = pairs
                    .iter()
                    .map(|&(q, p)| columns[a][q] * columns[b][p] - columns[a][p] * columns[b][q])
                    .sum();
                let meant: f64 = pairs
                    .iter()
                    .map(|&(q, p)| f64::from(i8::from((a, b) == (q, p)) - i8::from((a, b) == (p, q))))
                    .sum();
                // Differences over 1e-8 leave the third derivative times 1e-16.
                assert!((product - meant).abs() < 1e-13, "{}: {a}, {b}: {product}", method.name);
            }
        }
    }
}
