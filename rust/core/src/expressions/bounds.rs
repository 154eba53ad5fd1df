//! Between which numbers functions stay while the state is anywhere in a box: of one box, or of eight side by side.
//!
//! The one idea: written once, over the scalar, so that eight boxes cost little more than one. Bounds are those of ordinary
//! arithmetic, rounded to nearest: they are for decisions that rounding may make either way.

use super::code::word;
use super::execute::Scalar;
use super::function::Function;
use super::graph::{Graph, Id, Node, number};
use crate::numerics::functions;
use crate::numerics::real::{Mask, Real};
use core::f64::consts::PI;
use rustc_hash::FxHashMap;

/// All numbers between two.
pub type Between<S> = [S; 2];

/// What bounds are made of, each by the places of its arguments.
#[derive(Clone, Debug)]
enum Operation {
    Constant(f64),
    Sum(f64, Box<[(f64, usize)]>),
    Square(usize),
    Product(usize, usize),
    Quotient(usize, usize),
    Angle(usize, usize),
    /// Sine and cosine, one after the other: a rate has the one where the value has the other.
    Waves(usize),
    Call(Function, usize),
    Power(usize, f64),
}

/// Functions of a state and the time.
#[derive(Clone, Debug)]
pub struct Bounds {
    variables: usize,
    operations: Box<[Operation]>,
    /// Places of all that is found.
    places: usize,
    roots: Box<[usize]>,
}

impl Bounds {
    /// Of these nodes, without parameters, of so many variables.
    pub fn new(graph: &Graph, roots: &[Id], variables: usize) -> Self {
        let mut places: FxHashMap<Id, usize> = FxHashMap::default();
        let (mut operations, mut next) = (Vec::new(), variables + 1);
        let mut waves: FxHashMap<Id, usize> = FxHashMap::default();
        for id in graph.reachable(roots) {
            let of = |id: Id| places[&id];
            let operation = match *graph.node(id) {
                Node::Variable(index) => {
                    let _ = places.insert(id, index as usize);
                    continue;
                }
                Node::Time => {
                    let _ = places.insert(id, variables);
                    continue;
                }
                Node::Constant(bits) => Operation::Constant(number(bits)),
                // There are none: it may be anything.
                Node::Parameter(_) => Operation::Constant(f64::NAN),
                Node::Sum(constant, ref terms) => {
                    let terms = terms.iter().map(|&(factor, term)| (number(factor), of(term)));
                    Operation::Sum(number(constant), terms.collect())
                }
                Node::Product(a, b) if a == b => Operation::Square(of(a)),
                Node::Product(a, b) => Operation::Product(of(a), of(b)),
                Node::Quotient(a, b) => Operation::Quotient(of(a), of(b)),
                Node::Angle(y, x) => Operation::Angle(of(y), of(x)),
                Node::Call(function @ (Function::Sin | Function::Cos), a) => {
                    let first = *waves.entry(a).or_insert_with(|| {
                        operations.push(Operation::Waves(of(a)));
                        next += 2;
                        next - 2
                    });
                    let _ = places.insert(id, first + usize::from(function == Function::Cos));
                    continue;
                }
                Node::Call(function, a) => Operation::Call(function, of(a)),
                Node::Power(a, exponent) => Operation::Power(of(a), number(exponent)),
            };
            let _ = places.insert(id, next);
            operations.push(operation);
            next += 1;
        }
        Self {
            variables,
            operations: operations.into(),
            places: next,
            roots: roots.iter().map(|root| places[root]).collect(),
        }
    }

    /// The numbers that [`find`](Self::find) works with: two of each variable, of the time, and of what is made of them.
    pub fn room(&self) -> usize {
        2 * self.places
    }

    /// Finds the bounds of all, those of variables and time being there.
    #[inline(always)]
    pub fn find<S: Scalar>(&self, numbers: &mut [S]) {
        let mut place = 2 * (self.variables + 1);
        for operation in &self.operations {
            let found = match *operation {
                Operation::Constant(value) => settled([S::splat(value); 2]),
                Operation::Sum(constant, ref terms) => {
                    let [mut low, mut high] = [S::splat(constant); 2];
                    for &(factor, place) in terms {
                        let ([a, b], size) = (at(numbers, place), S::splat(factor));
                        let [a, b] = if factor < 0.0 { [b, a] } else { [a, b] };
                        (low, high) = (low + size * a, high + size * b);
                    }
                    settled([low, high])
                }
                Operation::Square(a) => {
                    let [least, greatest] = sizes(at(numbers, a));
                    [least * least, greatest * greatest]
                }
                Operation::Product(a, b) => product(at(numbers, a), at(numbers, b)),
                Operation::Quotient(a, b) => quotient(at(numbers, a), at(numbers, b)),
                Operation::Angle(y, x) => angle(at(numbers, y), at(numbers, x)),
                Operation::Waves(a) => {
                    let [sine, cosine] = waves(at(numbers, a));
                    numbers[place..place + 2].copy_from_slice(&sine);
                    place += 2;
                    cosine
                }
                Operation::Call(function, a) => call(function, at(numbers, a)),
                Operation::Power(a, exponent) => {
                    let [low, high] = at(numbers, a);
                    hull(low.raised(exponent), high.raised(exponent))
                }
            };
            numbers[place..place + 2].copy_from_slice(&found);
            place += 2;
        }
    }

    /// What was found of a function.
    #[inline(always)]
    pub fn root<S: Real>(&self, index: usize, numbers: &[S]) -> Between<S> {
        at(numbers, self.roots[index])
    }
}

#[inline(always)]
fn at<S: Real>(numbers: &[S], place: usize) -> Between<S> {
    [numbers[2 * place], numbers[2 * place + 1]]
}

/// All numbers where a mask does not hold.
#[inline(always)]
fn or_any<S: Real>(mask: S::Mask, [low, high]: Between<S>) -> Between<S> {
    [S::select(mask, low, S::splat(f64::NEG_INFINITY)), S::select(mask, high, S::splat(f64::INFINITY))]
}

/// These, or all where they are no numbers.
#[inline(always)]
fn settled<S: Real>([low, high]: Between<S>) -> Between<S> {
    or_any::<S>(low.less_equal(high), [low, high])
}

/// All between two numbers, whichever is the lower, if they are numbers.
#[inline(always)]
fn hull<S: Real>(a: S, b: S) -> Between<S> {
    let both = a + b;
    or_any::<S>(both.less_equal(both), [a.min(b), a.max(b)])
}

#[inline(always)]
fn has_zero<S: Real>([low, high]: Between<S>) -> S::Mask {
    low.less_equal(S::zero()).and(S::zero().less_equal(high))
}

/// The smallest and the greatest size.
#[inline(always)]
fn sizes<S: Real>([low, high]: Between<S>) -> Between<S> {
    let (a, b) = (low.abs(), high.abs());
    [S::select(has_zero([low, high]), S::zero(), a.min(b)), a.max(b)]
}

#[inline(always)]
fn of_four<S: Real>([a, b, c, d]: [S; 4]) -> Between<S> {
    let all = (a + b) + (c + d);
    or_any::<S>(all.less_equal(all), [a.min(b).min(c.min(d)), a.max(b).max(c.max(d))])
}

#[inline(always)]
fn product<S: Real>([a, b]: Between<S>, [c, d]: Between<S>) -> Between<S> {
    of_four([a * c, a * d, b * c, b * d])
}

#[inline(always)]
fn quotient<S: Real>(dividend: Between<S>, [low, high]: Between<S>) -> Between<S> {
    let one = S::one();
    or_any::<S>(has_zero([low, high]).not(), product(dividend, [one / high, one / low]))
}

/// Of a wave with this value and this slope in the middle of an interval, which reaches so far to both sides.
#[inline(always)]
fn wave<S: Real>(value: S, slope: S, reach: S) -> Between<S> {
    let one = S::one();
    // 1 - cos x ≤ x²/2 and 2, |sin x| ≤ x and 1.
    let turned = value - value * (S::splat(0.5) * reach * reach).min(S::splat(2.0));
    let aside = slope.abs() * reach.min(one);
    // No number gives way to the ends.
    [(value.min(turned) - aside).max(-one), (value.max(turned) + aside).min(one)]
}

/// Sine and cosine.
#[inline(always)]
fn waves<S: Scalar>([low, high]: Between<S>) -> [Between<S>; 2] {
    let half = S::splat(0.5);
    let (sine, cosine) = functions::sin_cos(half * (low + high));
    let reach = half * (high - low);
    [wave(sine, cosine, reach), wave(cosine, sine, reach)]
}

/// The angle of the points of a rectangle.
#[inline(always)]
fn angle<S: Scalar>(y: Between<S>, x: Between<S>) -> Between<S> {
    let corners = of_four([y[0].angle(x[0]), y[0].angle(x[1]), y[1].angle(x[0]), y[1].angle(x[1])]);
    let around = x[0].less_equal(S::zero()).and(has_zero(y));
    [S::select(around, S::splat(-PI), corners[0]), S::select(around, S::splat(PI), corners[1])]
}

#[inline(always)]
fn call<S: Scalar>(function: Function, x: Between<S>) -> Between<S> {
    let word = word::CALL + function as u16;
    match function {
        Function::Tan => {
            let has_pole = has_zero(waves(x)[1]);
            or_any::<S>(has_pole.not(), hull(x[0].called(word), x[1].called(word)))
        }
        Function::Sqrt => settled([x[0].max(S::zero()).sqrt(), x[1].sqrt()]),
        // Growing, or falling, with the size of what they are taken of.
        Function::Cosh | Function::SechSquared => {
            let [least, greatest] = sizes(x);
            hull(least.called(word), greatest.called(word))
        }
        _ => hull(x[0].called(word), x[1].called(word)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::lanes::{Lanes, WIDTH};
    use proptest::prelude::*;

    /// All functions, quotients, powers and angles of two numbers.
    fn functions() -> (Graph, Vec<Id>) {
        let mut graph = Graph::default();
        let (x, y) = (graph.variable(0), graph.variable(1));
        let mut roots: Vec<Id> = Function::ALL.into_iter().map(|function| graph.call(function, x)).collect();
        let quotient = graph.divide(x, y);
        let product = graph.multiply(x, y);
        let square = graph.multiply(x, x);
        let power = graph.power(x, 1.3);
        let high = graph.power(y, 60.0);
        let angle = graph.angle(y, x);
        let sum = graph.sum(0.7, &[(2.0, square), (-3.0, y), (0.5, quotient)]);
        roots.extend([quotient, product, square, power, high, angle, sum]);
        (graph, roots)
    }

    fn found<S: Scalar>(bounds: &Bounds, boxes: [Between<S>; 2]) -> Vec<Between<S>> {
        let mut numbers = vec![S::zero(); bounds.room()];
        numbers[..4].copy_from_slice(boxes.as_flattened());
        bounds.find(&mut numbers);
        (0..bounds.roots.len()).map(|root| bounds.root(root, &numbers)).collect()
    }

    proptest! {
        #[test]
        fn values_are_in_their_bounds(
            x in -8.0..8.0_f64, y in -3.0..3.0_f64, width in 0.0..1.0_f64, part in 0.0..1.0_f64,
        ) {
            let (graph, roots) = functions();
            let bounds = Bounds::new(&graph, &roots, 2);
            let width = 4.0 * width * width;
            let wide = found(&bounds, [[x, x + width], [y, y + width]]);
            let values = found(&bounds, [[x + part * width; 2], [y + (1.0 - part) * width; 2]]);
            for (index, (bound, value)) in wide.iter().zip(values).enumerate() {
                // What is no number there may be anything.
                if value[0].is_finite() {
                    let rounding = 1e-14 * value[0].abs().max(1e-2);
                    prop_assert!(bound[0] <= value[0] + rounding && value[1] <= bound[1] + rounding,
                        "{index} {bound:?} {value:?}");
                }
            }
            let in_lanes = [[x, x + width], [y, y + width]].map(|of| of.map(|x| Lanes([x; WIDTH])));
            let in_lanes = found(&bounds, in_lanes);
            for (one, eight) in wide.iter().zip(in_lanes) {
                prop_assert_eq!(one.map(f64::to_bits), eight.map(|lanes| lanes.0[3].to_bits()));
            }
        }
    }
}
