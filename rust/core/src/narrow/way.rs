//! The way of one trajectory through a step: the polynomial through states that are known on it.

use crate::expressions::Machine;
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::ode::looks::Looks;
use crate::ode::step_control::Controlled;
use crate::ode::system::{Form, Taken, Visited};

/// So many parts of a step have a state of the polynomial through its ends.
const PARTS: usize = 8;
/// The most places of which states are known: of a series.
const MOST_PLACES: usize = 16;

/// A way.
pub(super) struct Way {
    places: Vec<f64>,
    weights: Vec<f64>,
    states: Vec<Vec<f64>>,
    /// The time before the step, and its length.
    pub(super) t: f64,
    pub(super) h: f64,
    /// Where the method looks.
    pub(super) looks: Looks,
}

impl Way {
    /// Of a lane of a step, in a run that begins at `t0`.
    pub(super) fn of<S: Controlled>(form: Form, step: &Taken<'_, S>, lane: usize, t0: f64) -> Self {
        let visited = match step.visited {
            Some(visited) => visited(lane),
            None => between_ends(form, step, lane),
        };
        let places: Vec<f64> = visited.iter().map(|(place, _)| *place).collect();
        let others = |j: usize| places.iter().enumerate().filter(move |(i, _)| *i != j);
        let weight = |(j, x): (usize, &f64)| 1.0 / others(j).map(|(_, y)| x - y).product::<f64>();
        let weights = places.iter().enumerate().map(weight).collect();
        let looks = step.looks.clone();
        let states = visited.into_iter().map(|(_, state)| state).collect();
        Self { places, weights, states, t: t0 + step.from.lane(lane), h: step.h.lane(lane), looks }
    }

    /// The straight way through two places of it, which are those from 0 to 1.
    pub(super) fn straight(&self, [from, to]: [f64; 2]) -> Self {
        let states = [from, to].map(|theta| {
            let basis = self.basis(&[theta; WIDTH]);
            let number = |index: usize| {
                let terms = basis.iter().zip(&self.states).map(|(row, state)| row[0] * state[index]);
                terms.sum()
            };
            (0..self.states[0].len()).map(number).collect::<Vec<f64>>()
        });
        Self {
            places: vec![0.0, 1.0],
            weights: vec![-1.0, 1.0],
            states: states.to_vec(),
            t: self.t + from * self.h,
            h: (to - from) * self.h,
            looks: Looks::AT_ENDS,
        }
    }

    /// The numbers at the ends.
    pub(super) fn ends(&self) -> [&[f64]; 2] {
        [&self.states[0], &self.states[self.states.len() - 1]]
    }

    /// Enters the states at eight places, and runs the code.
    pub(super) fn run(&self, thetas: &[f64; WIDTH], machine: &mut Machine<Lanes>) {
        self.enter(thetas, machine);
        machine.run(Lanes(thetas.map(|theta| self.t + theta * self.h)));
    }

    /// The same, as if nothing had moved since a place.
    pub(super) fn run_at_rest(&self, since: f64, thetas: &[f64; WIDTH], machine: &mut Machine<Lanes>) {
        self.enter(&[since; WIDTH], machine);
        machine.run(Lanes(thetas.map(|theta| self.t + theta * self.h)));
    }

    /// The polynomials that are 1 in one of the places and 0 in the others, at eight places.
    fn basis(&self, thetas: &[f64; WIDTH]) -> [[f64; WIDTH]; MOST_PLACES] {
        let mut basis = [[0.0; WIDTH]; MOST_PLACES];
        for (lane, &theta) in thetas.iter().enumerate() {
            let mut before = 1.0;
            for (j, place) in self.places.iter().enumerate() {
                basis[j][lane] = before * self.weights[j];
                before *= theta - place;
            }
            let mut after = 1.0;
            for (j, place) in self.places.iter().enumerate().rev() {
                basis[j][lane] *= after;
                after *= theta - place;
            }
        }
        basis
    }

    /// Enters the states at eight places.
    fn enter(&self, thetas: &[f64; WIDTH], machine: &mut Machine<Lanes>) {
        let basis = self.basis(thetas);
        for (index, number) in machine.state().iter_mut().enumerate().take(self.states[0].len()) {
            let mut sum = [0.0; WIDTH];
            for (row, state) in basis.iter().zip(&self.states) {
                for (sum, weight) in sum.iter_mut().zip(row) {
                    *sum += weight * state[index];
                }
            }
            *number = Lanes(sum);
        }
    }
}

/// States of the polynomial that has the numbers and rates at the ends of a step: of coordinates of the second order with their
/// accelerations, of others without, and a straight line of what has no rates.
fn between_ends<S: Controlled>(form: Form, step: &Taken<'_, S>, lane: usize) -> Visited {
    let of = |values: &[S], index: usize| values[index].lane(lane);
    let (h, numbers) = (step.h.lane(lane), step.ends[0].len());
    let second_order = matches!(form, Form::SecondOrder(_));
    let n = numbers / 2;
    let known = step.rates.as_ref();
    let rate =
        |end: usize, index: usize| known.map(|known| of(known[end], known[end].len() + index - numbers));
    let polynomial = |index: usize| -> [f64; 6] {
        let [p, q] = step.ends.map(|end| of(end, index));
        let change = q - p;
        let slopes = if second_order && index < n {
            Some([0, 1].map(|end| h * of(step.ends[end], n + index)))
        } else {
            rate(0, index).zip(rate(1, index)).map(|(a, b)| [h * a, h * b])
        };
        let Some([v, w]) = slopes else { return [p, change, 0.0, 0.0, 0.0, 0.0] };
        let curved =
            if second_order && index < n { rate(0, n + index).zip(rate(1, n + index)) } else { None };
        let Some((a, b)) = curved else {
            return [p, v, 3.0 * change - 2.0 * v - w, v + w - 2.0 * change, 0.0, 0.0];
        };
        let (a, b) = (h * h * a, h * h * b);
        let (rest, turn, bend) = (change - v - 0.5 * a, w - v - a, b - a);
        [
            p,
            v,
            0.5 * a,
            10.0 * rest - 4.0 * turn + 0.5 * bend,
            7.0 * turn - 15.0 * rest - bend,
            6.0 * rest - 3.0 * turn + 0.5 * bend,
        ]
    };
    let polynomials: Vec<[f64; 6]> = (0..numbers).map(polynomial).collect();
    let at = |part: usize| {
        let theta = part as f64 / PARTS as f64;
        let value = |(index, terms): (usize, &[f64; 6])| {
            if part == PARTS {
                return of(step.ends[1], index);
            }
            terms.iter().rev().fold(0.0, |sum, term| sum * theta + term)
        };
        (theta, polynomials.iter().enumerate().map(value).collect())
    };
    (0..=PARTS).map(at).collect()
}
