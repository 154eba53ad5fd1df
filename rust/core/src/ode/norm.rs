//! What the error of a step is measured by.
//!
//! The one idea: an error is a number per vector (a place, a velocity, an angle), scaled by its own tolerance; the state
//! is cut into blocks of such vectors, and the largest of all decides. Sizes are distances from a reference that moves
//! uniformly, so that a system that is far away, or drifts, is held to the same error.
//!
//! Equations of no known geometry are held to the root mean square of all numbers instead, each by its own tolerances.

use super::passes::errors::{LargestErrors, MeanErrors, PairTerm};
use super::passes::series_errors::InverseTolerances;
use super::state::State;
use super::step_control::Controlled;
use super::system::Form;
use crate::numerics::element::Shape;

/// Vectors of one kind in a state, held to one tolerance.
#[derive(Clone, Debug)]
pub struct Block<S> {
    /// Where they begin among the coordinates, or among the velocities (of a system of the first order: in the state).
    pub start: usize,
    /// Whether they are velocities of a system of the second order.
    pub velocity: bool,
    /// How they lie: component after component, 1 to 4 of them.
    pub shape: Shape,
    /// Absolute tolerance of all vectors, or of each.
    pub atol: Vec<S>,
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
    /// If there, sizes are measured from the mean of the vectors with these weights, row by row, wherever that may be, and
    /// not from the references: what moves all alike is no size.
    pub weights: Option<Vec<S>>,
    /// If there, the root mean square of all numbers of a system of the first order counts, and no vectors.
    pub mean: Option<RootMeanSquare<S>>,
}

/// Tolerances of single numbers: `atol + rtol·|y|`, the larger `|y|` of both ends of a step.
#[derive(Clone, Debug)]
pub struct RootMeanSquare<S> {
    /// Absolute tolerance of each number.
    pub atol: Vec<S>,
    /// Relative tolerance of each number.
    pub rtol: Vec<S>,
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
            atol: vec![S::zero()],
            reference: [S::zero(); 4],
            drift: [S::zero(); 4],
        };
        let blocks = match form {
            Form::FirstOrder(_) => vec![block(false)],
            Form::SecondOrder(_) => vec![block(false), block(true)],
        };
        Self { rtol, blocks, together, weights: None, mean: None }
    }

    /// Each number by itself, against how far it goes: of methods that know that without a norm (series do).
    pub fn of_numbers(rtol: S) -> Self {
        Self { rtol, blocks: vec![], together: false, weights: None, mean: None }
    }

    /// The root mean square of all numbers of a system of the first order, each scaled by its own tolerances.
    pub fn root_mean_square(mean: RootMeanSquare<S>) -> Self {
        Self { rtol: S::zero(), blocks: vec![], together: false, weights: None, mean: Some(mean) }
    }

    /// The larger squared scaled size of the changes, for each of the two sets of weights: of the coordinates (or of all
    /// numbers of a system of the first order), and of the velocities. `next` is the state that they lead to.
    pub(super) fn sizes(
        &self,
        state: &State<S>,
        next: &State<S>,
        elapsed: &S,
        changes: &[Change<'_, S>; 2],
    ) -> [S; 2] {
        if let Some(RootMeanSquare { atol, rtol }) = &self.mean {
            let &[Change { k, stride, terms, ref factor }, _] = changes;
            let (y, next) = (state.all().0, next.all().0);
            return S::pass(MeanErrors { y, next, atol, rtol, h: factor, terms, k, stride });
        }
        let second_order = matches!(state.form(), Form::SecondOrder(_));
        let mut largest = [S::zero(); 2];
        let still = [S::zero(); 4];
        for block in &self.blocks {
            let y = match (second_order, block.velocity) {
                (false, _) => state.all().0,
                (true, false) => state.q(),
                (true, true) => state.v(),
            };
            let change = &changes[usize::from(block.velocity)];
            let mean = self.weights.as_ref().map(|weights| self.center(weights, block, y));
            let (reference, drift) =
                mean.as_ref().map_or((&block.reference, &block.drift), |mean| (mean, &still));
            S::pass(LargestErrors {
                largest: &mut largest,
                shape: block.shape,
                y: &y[block.start..],
                reference,
                drift,
                elapsed,
                atol: &block.atol,
                rtol: &self.rtol,
                h: &change.factor,
                terms: change.terms,
                k: &change.k[block.start..],
                stride: change.stride,
            });
        }
        let [first, second] = largest;
        if self.together { [first.largest_lane(), second.largest_lane()] } else { largest }
    }

    /// Finds one over what each vector of a state may be off, block after block.
    pub(super) fn inverse_tolerances(&self, state: &State<S>, elapsed: &S, into: &mut Vec<S>) {
        let halves = if matches!(state.form(), Form::SecondOrder(_)) {
            [state.q(), state.v()]
        } else {
            [state.all().0; 2]
        };
        let center =
            |weights, block: &Block<S>| self.center(weights, block, halves[usize::from(block.velocity)]);
        let centers: Vec<[S; 4]> = match &self.weights {
            Some(weights) => self.blocks.iter().map(|block| center(weights, block)).collect(),
            None => Vec::new(),
        };
        into.resize(self.blocks.iter().map(|block| block.shape.rows).sum(), S::zero());
        let (blocks, rtol, centers) = (&self.blocks[..], &self.rtol, &centers[..]);
        S::pass(InverseTolerances { blocks, halves, centers, elapsed, rtol, into });
    }

    /// The weighted mean of the vectors of a block.
    fn center(&self, weights: &[S], block: &Block<S>, y: &[S]) -> [S; 4] {
        let Shape { rows, components } = block.shape;
        let mut mean = [S::zero(); 4];
        for (c, mean) in mean.iter_mut().enumerate().take(components) {
            for (&weight, &y) in weights.iter().zip(&y[block.start + c * rows..]) {
                *mean += weight * y;
            }
            if self.together {
                *mean = mean.sum_of_lanes();
            }
        }
        mean
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The squared sizes of `h Σ weight·k` beside a state, for weights 1 and 10.
    fn sizes(norm: &Norm<f64>, y: &[f64], next: &[f64], k: &[f64], h: f64) -> [f64; 2] {
        let [state, next] = [y, next].map(|y| State::first_order(y.to_vec()));
        let terms = [PairTerm { stage: 0, weights: [1.0, 10.0] }];
        let change = Change { k, stride: k.len(), terms: &terms, factor: h };
        norm.sizes(&state, &next, &0.0, &[change, change])
    }

    #[test]
    fn the_largest_vector_counts_by_its_tolerances() {
        let shape = Shape { rows: 2, components: 2 };
        let mut norm = Norm::new(shape, Form::FirstOrder(4), 0.25, false);
        norm.blocks[0].atol = vec![0.5];
        norm.blocks[0].reference[0] = 1.0;
        // Vectors (1+3, 4) and (1, 0): sizes 5 and 0, tolerances 0.5 + 0.25·5 and 0.5; errors |(3, 4)|/2 and |(0, 1)|/2.
        let y = [4.0, 1.0, 4.0, 0.0];
        let [first, second] = sizes(&norm, &y, &y, &[3.0, 0.0, 4.0, 1.0], 0.5);
        // Roots are rough, to four digits.
        assert!((first - (2.5_f64 / 1.75).powi(2)).abs() < 1e-3, "{first}");
        assert!((second - (25.0_f64 / 1.75).powi(2)).abs() < 1e-1, "{second}");
    }

    #[test]
    fn vectors_may_have_tolerances_of_their_own() {
        let shape = Shape { rows: 2, components: 2 };
        let mut norm = Norm::new(shape, Form::FirstOrder(4), 0.25, false);
        let y = [4.0, 1.0, 4.0, 0.0];
        let mut size = |atol: &[f64]| {
            norm.blocks[0].atol = atol.to_vec();
            sizes(&norm, &y, &y, &[3.0, 0.0, 4.0, 1.0], 0.5)[0]
        };
        assert_eq!(size(&[0.5, 0.5]).to_bits(), size(&[0.5]).to_bits());
        // The errors 2.5 and 0.5, of vectors of the lengths √32 and 1.
        let alone = |error: f64, atol: f64, length: f64| (error / (atol + 0.25 * length)).powi(2);
        for (atol, largest) in
            [([10.0, 0.125], alone(0.5, 0.125, 1.0)), ([0.125, 10.0], alone(2.5, 0.125, 32f64.sqrt()))]
        {
            assert!((size(&atol) / largest - 1.0).abs() < 1e-3, "{atol:?}");
        }
    }

    #[test]
    fn what_moves_all_alike_is_no_size() {
        let shape = Shape { rows: 2, components: 1 };
        let mut norm = Norm::new(shape, Form::FirstOrder(2), 0.25, false);
        norm.weights = Some(vec![0.75, 0.25]);
        // Four apart: 1 and 3 from their mean, wherever that is.
        for far in [0.0, 1e6] {
            let y = [far - 1.0, far + 3.0];
            let [size, _] = sizes(&norm, &y, &y, &[1.0, 1.0], 0.5);
            assert!((size - 4.0).abs() < 1e-3, "{size}");
        }
    }

    #[test]
    fn the_root_mean_square_counts_each_number_by_its_own_tolerances() {
        let mean = RootMeanSquare { atol: vec![0.5, 0.0, 0.0], rtol: vec![0.0, 0.25, 0.0] };
        let norm = Norm::root_mean_square(mean);
        let (y, next) = ([1.0, -2.0, 0.0], [7.0, -8.0, 0.0]);
        // Errors 1, 1 and none, tolerances 0.5, 0.25·8 and none.
        let [first, second] = sizes(&norm, &y, &next, &[2.0, 2.0, 0.0], 0.5);
        assert!((first - (4.0 + 0.25) / 3.0).abs() < 1e-15, "{first}");
        assert!((second - 100.0 * (4.0 + 0.25) / 3.0).abs() < 1e-12, "{second}");
        // An error without a tolerance is infinite, and so is one that is no number.
        assert!(sizes(&norm, &y, &next, &[0.0, 0.0, 1.0], 0.5)[0] >= 1e299);
        assert!(sizes(&norm, &y, &next, &[f64::NAN, 0.0, 0.0], 0.5)[0] >= 1e299);
    }
}
