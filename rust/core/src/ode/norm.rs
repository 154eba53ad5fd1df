//! What the error of a step is measured by.
//!
//! The one idea: an error is a number per vector (a place, a velocity, an angle), scaled by its own tolerance; the state
//! is cut into blocks of such vectors, and the largest of all decides. Sizes are distances from a reference that moves
//! uniformly, so that a system that is far away, or drifts, is held to the same error.

use super::state::State;
use super::step_control::Controlled;
use super::system::Form;
use crate::numerics::element::{PairTerm, Shape};

/// Vectors of one kind in a state, held to one tolerance.
#[derive(Clone, Debug)]
pub struct Block<S> {
    /// Where they begin among the coordinates, or among the velocities (of a system of the first order: in the state).
    pub start: usize,
    /// Whether they are velocities of a system of the second order.
    pub velocity: bool,
    /// How they lie: component after component, 1 to 4 of them.
    pub shape: Shape,
    /// Absolute tolerance.
    pub atol: S,
    /// What sizes are measured from at the start of the run, component by component.
    pub reference: [S; 4],
    /// How that moves.
    pub drift: [S; 4],
}

/// How the errors of a state make one number per lane.
#[derive(Clone, Debug)]
pub struct Norm<S> {
    /// Tolerance relative to the distance from the reference.
    pub rtol: S,
    /// The vectors of the state.
    pub blocks: Vec<Block<S>>,
    /// Whether the lanes are parts of one trajectory, and share a step.
    pub together: bool,
}

/// A weighted sum of derivatives to be measured, and what it is multiplied with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Change<'a, S> {
    /// Derivatives, stage after stage, of `stride` numbers.
    pub k: &'a [S],
    pub stride: usize,
    pub terms: &'a [PairTerm<S>],
    pub factor: S,
}

impl<S: Controlled> Norm<S> {
    /// Of vectors that lie like those of `shape`, one block for a system of the first order, else one for the coordinates
    /// and one for the velocities, with no absolute tolerance and measured from zero.
    pub fn new(shape: Shape, form: Form, rtol: S, together: bool) -> Self {
        let block = |velocity| Block {
            start: 0,
            velocity,
            shape,
            atol: S::zero(),
            reference: [S::zero(); 4],
            drift: [S::zero(); 4],
        };
        let blocks = match form {
            Form::FirstOrder(_) => vec![block(false)],
            Form::SecondOrder(_) => vec![block(false), block(true)],
        };
        Self { rtol, blocks, together }
    }

    /// The larger squared scaled size of the changes, for each of the two sets of weights: of the coordinates (or of all
    /// numbers of a system of the first order), and of the velocities.
    pub(super) fn sizes(&self, state: &State<S>, elapsed: S, changes: &[Change<'_, S>; 2]) -> [S; 2] {
        let second_order = matches!(state.form(), Form::SecondOrder(_));
        let mut largest = [S::zero(); 2];
        for block in &self.blocks {
            let y = match (second_order, block.velocity) {
                (false, _) => state.all().0,
                (true, false) => state.q(),
                (true, true) => state.v(),
            };
            let change = changes[usize::from(block.velocity)];
            let place: [S; 4] = core::array::from_fn(|c| block.reference[c] + block.drift[c] * elapsed);
            let sizes = S::largest_errors(
                block.shape,
                &y[block.start..],
                &place,
                (&block.atol, &self.rtol),
                &change.factor,
                change.terms,
                (&change.k[block.start..], change.stride),
            );
            largest = [largest[0].max(sizes[0]), largest[1].max(sizes[1])];
        }
        if self.together { largest.map(S::largest_lane) } else { largest }
    }
}
