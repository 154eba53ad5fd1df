//! Any mixture of forces that are linear in the place and the velocity of each particle, but for a constant: harmonic ones,
//! uniform, electric and magnetic fields, linear drag, rotating frames.
//!
//! The one idea: the place, the velocity and a 1 after them are a vector y with y′ = M y, which [`MatrixExponential`] moves.
//! Source: V. I. Arnold, *Ordinary Differential Equations*, chapter 3.

use super::{ClosedForm, ExactState, Member, Path, Paths};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::matrix_exponential::MatrixExponential;
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
            && member.forces.iter().all(|force| force.is_linear())
            && !drifts_along_a_slant(member)
            && (0..member.mass.len()).all(|particle| in_range(member, particle))
    },
    motion: |member, ticker| {
        let mut last = None;
        Paths::motion(member, ticker, |particle| {
            let flow = Flow::new(member, particle, last.as_ref());
            last = Some(Rc::clone(&flow.flows));
            Ok(flow)
        })
    },
};

/// The place, the velocity, and a 1.
const NUMBERS: usize = 7;
/// The largest exponent of a rate, or of a number of a state: units of numbers and of time are made of them.
const LARGEST: i32 = 300;

/// An acceleration by the numbers of a state.
type Rows = [[Scaled; NUMBERS]; 3];

/// Whether a frame turns about an axis that is none of the coordinates', or beside a magnetic field: what drifts or falls along
/// such an axis grows with t and t², goes into all components, and its rounding into velocities that do not grow.
fn drifts_along_a_slant(member: &Member<'_>) -> bool {
    let slanted = |omega: [f64; 3]| omega.iter().filter(|&&part| part != 0.0).count() > 1;
    let any_magnetic = member.forces.iter().any(|force| force.as_magnetic().is_some());
    let mut turning = member.forces.iter().filter_map(|force| force.as_rotating());
    turning.any(|(omega, _)| any_magnetic || slanted(omega))
}

/// What each component of the acceleration of a particle is made of.
fn acceleration(member: &Member<'_>, particle: usize) -> Rows {
    let mut rows = [[Scaled::ZERO; NUMBERS]; 3];
    let mass = Scaled::from(member.mass[particle]);
    let mut add = |row: usize, column: usize, value: Scaled| {
        rows[row][column] = rows[row][column].plus(value);
    };
    for force in &member.forces {
        if let Some(g) = force.as_uniform() {
            (0..3).for_each(|c| add(c, 6, Scaled::from(g[c])));
        }
        // A body without mass may be there, if it has no charge.
        if let Some((field, charge)) = force.as_electric(particle).filter(|&(_, charge)| charge != 0.0) {
            (0..3).for_each(|c| add(c, 6, Scaled::from(charge).times(field[c]).over(mass)));
        }
        if let Some((k, center)) = force.as_harmonic().filter(|&(k, _)| k != 0.0) {
            let rate = Scaled::from(-k).over(mass);
            for c in 0..3 {
                add(c, c, rate);
                add(c, 6, rate.times(-center[c]));
            }
        }
        if let Some(tau) = force.as_linear_drag() {
            (0..3).for_each(|c| add(c, 3 + c, Scaled::from(-1.0).over(Scaled::from(tau))));
        }
        if let Some(magnetic) = force.as_magnetic() {
            let charge = magnetic.charge_of(particle);
            if charge != 0.0 {
                let field = magnetic.field.map(|b| Scaled::from(charge).times(b).over(mass));
                for c in 0..3 {
                    let (next, last) = ((c + 1) % 3, (c + 2) % 3);
                    add(c, 3 + next, field[last]);
                    add(c, 3 + last, field[next].negative());
                }
            }
        }
        if let Some((omega, center)) = force.as_rotating() {
            let omega = omega.map(Scaled::from);
            let square = omega.iter().fold(Scaled::ZERO, |sum, part| sum.plus(part.by(*part)));
            for c in 0..3 {
                let (next, last) = ((c + 1) % 3, (c + 2) % 3);
                // −2 ω × v and ω² d − (ω·d) ω, with d from the axis.
                add(c, 3 + next, omega[last].times(2.0));
                add(c, 3 + last, omega[next].times(-2.0));
                for column in 0..3 {
                    let outward = if column == c { square } else { Scaled::ZERO };
                    let entry = outward.minus(omega[c].by(omega[column]));
                    add(c, column, entry);
                    add(c, 6, entry.times(-center[column]));
                }
            }
        }
    }
    rows
}

/// Whether all numbers are such that none made of them leaves the range.
fn in_range(member: &Member<'_>, particle: usize) -> bool {
    let sound = |of: Scaled| {
        let number = of.to_double_double().to_f64();
        of.is_zero() || (number.is_finite() && exponent_of(number).abs() <= LARGEST)
    };
    let numbers = member.position[particle].into_iter().chain(member.velocity[particle]);
    acceleration(member, particle).as_flattened().iter().all(|&entry| sound(entry))
        && numbers.map(Scaled::from).all(sound)
}

/// The binary exponent of a number; far out for one that is none, or no normal one.
fn exponent_of(number: f64) -> i32 {
    if number.is_normal() { crate::numerics::power_of_two::exponent(number) } else { i32::MAX }
}

/// Rates, and what they make of states.
struct Flows {
    rates: Vec<DoubleDouble>,
    /// About the shortest of periods and decays.
    time: f64,
    /// Forwards and backwards in time, once somebody has asked for such a time.
    of: [RefCell<Option<MatrixExponential>>; 2],
}

impl Flows {
    fn new(rates: Vec<DoubleDouble>) -> Self {
        let mut fastest = 0.0_f64;
        for row in rates[3 * NUMBERS..6 * NUMBERS].chunks(NUMBERS) {
            let size =
                |of: &[DoubleDouble]| of.iter().fold(0.0_f64, |most, rate| most.max(rate.to_f64().abs()));
            fastest = fastest.max(size(&row[..3]).sqrt()).max(size(&row[3..6]));
        }
        let time = if fastest > 0.0 { 1.0 / fastest } else { 1.0 };
        Self { rates, time, of: Default::default() }
    }

    fn moved(&self, start: &[f64; NUMBERS], elapsed: DoubleDouble) -> Vec<DoubleDouble> {
        let backwards = elapsed.to_f64() < 0.0;
        let elapsed = if backwards { -elapsed } else { elapsed };
        let mut flow = self.of[usize::from(backwards)].borrow_mut();
        let flow = flow.get_or_insert_with(|| {
            let signed = |&rate: &DoubleDouble| if backwards { -rate } else { rate };
            MatrixExponential::new(self.rates.iter().map(signed).collect(), NUMBERS, self.time)
        });
        flow.unrounded((elapsed.high(), elapsed.low()), start)
    }
}

/// A particle in a flow, which it shares with those before it that have the same rates.
struct Flow {
    flows: Rc<Flows>,
    start: [f64; NUMBERS],
}

impl Flow {
    fn new(member: &Member<'_>, particle: usize, last: Option<&Rc<Flows>>) -> Self {
        let mut rates = vec![DoubleDouble::zero(); NUMBERS * NUMBERS];
        for c in 0..3 {
            rates[c * NUMBERS + 3 + c] = DoubleDouble::one();
        }
        for (c, row) in acceleration(member, particle).iter().enumerate() {
            for (column, entry) in row.iter().enumerate() {
                rates[(3 + c) * NUMBERS + column] = entry.to_double_double();
            }
        }
        let flows = match last {
            Some(last) if last.rates == rates => Rc::clone(last),
            _ => Rc::new(Flows::new(rates)),
        };
        let ([x, y, z], [u, v, w]) = (member.position[particle], member.velocity[particle]);
        Self { flows, start: [x, y, z, u, v, w, 1.0] }
    }
}

impl Path for Flow {
    fn state(&self, elapsed: DoubleDouble) -> ExactState {
        let state = self.flows.moved(&self.start, elapsed);
        // Beyond the range of numbers there is no sign.
        let number = |number: DoubleDouble| {
            if number.is_finite() { number } else { DoubleDouble::from(f64::INFINITY) }
        };
        let part = |from: usize| core::array::from_fn(|c| number(state[from + c]));
        (part(0), part(3))
    }
}
