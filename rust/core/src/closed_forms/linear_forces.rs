//! Any mixture of forces that are linear in the place and the velocity of each particle, but for a constant: harmonic ones,
//! uniform, electric and magnetic fields, linear drag, rotating frames.
//!
//! The one idea: the place, the velocity and a 1 after them are a vector y with y′ = M y, which a [`Propagator`] moves: one of
//! all particles and copies with the same rates.
//! Source: V. I. Arnold, *Ordinary Differential Equations*, chapter 3.

use super::{ClosedForm, ExactState, Member, Path, Paths};
use crate::forces::linear::{LinearAcceleration, NUMBERS};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::matrix_exponential::propagator::Propagator;
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use core::cell::RefCell;
use std::rc::Rc;

/// Linear flows.
pub static FORM: ClosedForm = ClosedForm {
    name: "linear flow",
    reason: "all forces are linear in the place and the velocity of each body, but for a constant",
    applies: |member| {
        !member.forces.is_empty()
            && member.forces.iter().all(|force| force.as_linear().is_some())
            && !drifts_along_a_slant(member)
            && (0..member.mass.len()).all(|particle| in_range(member, particle))
    },
    motion: |member, shared, ticker| {
        let flows: Rc<Flows> = shared.of_form();
        Paths::motion(member, ticker, |particle| Ok(Flow::new(member, particle, &flows)))
    },
};

/// The largest exponent of a rate, or of a number of a state: units of numbers and of time are made of them.
const LARGEST: i32 = 300;

/// Whether a frame turns about an axis that is none of the coordinates', or beside a magnetic field: what drifts or falls along
/// such an axis grows with t and t², goes into all components, and its rounding into velocities that do not grow.
fn drifts_along_a_slant(member: &Member<'_>) -> bool {
    let slanted = |omega: [f64; 3]| omega.iter().filter(|&&part| part != 0.0).count() > 1;
    let any_magnetic = member.forces.iter().any(|force| force.as_magnetic().is_some());
    let mut turning = member.forces.iter().filter_map(|force| force.as_rotating());
    turning.any(|(omega, _)| any_magnetic || slanted(omega))
}

/// The acceleration of a particle.
fn acceleration(member: &Member<'_>, particle: usize) -> LinearAcceleration {
    let mut sum = LinearAcceleration::default();
    for force in member.forces.iter().filter_map(|force| force.as_linear()) {
        force.add_to(&mut sum, particle, Scaled::from(member.mass[particle]));
    }
    sum
}

/// Whether all numbers are such that none made of them leaves the range.
fn in_range(member: &Member<'_>, particle: usize) -> bool {
    let sound = |of: Scaled| {
        let number = of.to_double_double().to_f64();
        of.is_zero() || (number.is_finite() && exponent_of(number).abs() <= LARGEST)
    };
    let numbers = member.position[particle].into_iter().chain(member.velocity[particle]);
    acceleration(member, particle).rows().as_flattened().iter().all(|&entry| sound(entry))
        && numbers.map(Scaled::from).all(sound)
}

/// The binary exponent of a number; far out for one that is none, or no normal one.
fn exponent_of(number: f64) -> i32 {
    if number.is_normal() { crate::numerics::power_of_two::exponent(number) } else { i32::MAX }
}

/// How many flows are kept ready: so many kinds of particles may be in a scene whose copies share them.
const READY: usize = 16;

/// A matrix by rows, of which the last is nothing: y′ of y.
type Rates = [DoubleDouble; NUMBERS * NUMBERS];

/// Those in use of late, the last one first.
#[derive(Default)]
struct Flows(RefCell<Vec<Ready>>);

/// The flow of some rates, forwards or backwards in time.
struct Ready {
    rates: Rc<Rates>,
    backwards: bool,
    propagator: Propagator,
}

/// The matrix of some rates, forwards or backwards in time, and about the shortest of its periods and decays.
fn matrix_of(rates: &Rates, backwards: bool) -> (Vec<DoubleDouble>, f64) {
    let mut fastest = 0.0_f64;
    for row in rates[3 * NUMBERS..6 * NUMBERS].chunks(NUMBERS) {
        let size = |of: &[DoubleDouble]| of.iter().fold(0.0_f64, |most, rate| most.max(rate.to_f64().abs()));
        fastest = fastest.max(size(&row[..3]).sqrt()).max(size(&row[3..6]));
    }
    let shortest = if fastest > 0.0 { 1.0 / fastest } else { 1.0 };
    let signed = |&rate: &DoubleDouble| if backwards { -rate } else { rate };
    (rates.iter().map(signed).collect(), shortest)
}

impl Flows {
    /// These rates, as those of one that is ready if there is one.
    fn known(&self, rates: Rates) -> Rc<Rates> {
        let ready = self.0.borrow();
        let same = ready.iter().find(|ready| *ready.rates == rates);
        same.map_or_else(|| Rc::new(rates), |ready| Rc::clone(&ready.rates))
    }

    /// Does something with the flow of these rates.
    fn with<T>(&self, rates: &Rc<Rates>, backwards: bool, act: impl FnOnce(&mut Propagator) -> T) -> T {
        let mut ready = self.0.borrow_mut();
        let is_it = |one: &Ready| {
            one.backwards == backwards && (Rc::ptr_eq(&one.rates, rates) || one.rates == *rates)
        };
        match ready.iter().position(is_it) {
            Some(at) => ready[..=at].rotate_right(1),
            None => {
                let (matrix, shortest) = matrix_of(rates, backwards);
                let rates = Rc::clone(rates);
                if ready.len() < READY {
                    let propagator = Propagator::new(matrix, NUMBERS, shortest);
                    ready.push(Ready { rates, backwards, propagator });
                } else if let Some(oldest) = ready.last_mut() {
                    oldest.propagator.take(matrix, shortest);
                    (oldest.rates, oldest.backwards) = (rates, backwards);
                }
                ready.rotate_right(1);
            }
        }
        act(&mut ready[0].propagator)
    }
}

/// A particle in a flow.
struct Flow {
    rates: Rc<Rates>,
    flows: Rc<Flows>,
    start: [f64; NUMBERS],
}

impl Flow {
    fn new(member: &Member<'_>, particle: usize, flows: &Rc<Flows>) -> Self {
        let mut rates = [DoubleDouble::zero(); NUMBERS * NUMBERS];
        for c in 0..3 {
            rates[c * NUMBERS + 3 + c] = DoubleDouble::one();
        }
        for (c, row) in acceleration(member, particle).rows().iter().enumerate() {
            for (column, entry) in row.iter().enumerate() {
                rates[(3 + c) * NUMBERS + column] = entry.to_double_double();
            }
        }
        let ([x, y, z], [u, v, w]) = (member.position[particle], member.velocity[particle]);
        Self { rates: flows.known(rates), flows: Rc::clone(flows), start: [x, y, z, u, v, w, 1.0] }
    }
}

impl Path for Flow {
    fn states(&self, elapsed: &[DoubleDouble], mut put: impl FnMut(usize, ExactState)) {
        let backwards = elapsed.iter().any(|elapsed| elapsed.to_f64() < 0.0);
        let after: Vec<_> = elapsed.iter().map(|&t| if backwards { -t } else { t }).collect();
        self.flows.with(&self.rates, backwards, |flow| {
            flow.set_times(&after);
            for time in 0..after.len() {
                let state = flow.moved(time, &self.start);
                // Beyond the range of numbers there is no sign.
                let number = |number: DoubleDouble| {
                    if number.is_finite() { number } else { DoubleDouble::from(f64::INFINITY) }
                };
                let part = |from: usize| core::array::from_fn(|c| number(state[from + c]));
                put(time, (part(0), part(3)));
            }
        });
    }

    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        let mut found = ExactState::default();
        self.states(&[elapsed], |_, state| found = state);
        found
    }
}
