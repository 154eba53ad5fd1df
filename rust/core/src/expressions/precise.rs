//! Values of nodes to about thirty digits.
//!
//! The one idea: in double-double nothing is lost that a difference of near values would need later: that of two large terms
//! beside a small one, or what is left of an energy at a turning point. What has no such digits (functions at the ends of their
//! range) is rounded once, as a program gives it.

use super::code::word;
use super::execute::Scalar;
use super::function::Function;
use super::graph::{Graph, Id, Node, number};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::Exponential;
use crate::numerics::functions::precise as functions;
use crate::numerics::real::Real;
use core::ops::{Add, Div, Mul};

mod rounding;

/// Nodes that are functions of a state and of parameters.
#[derive(Clone, Debug, Default)]
pub struct Precise {
    /// What the roots are made of, arguments first, by places in this list.
    steps: Vec<Step>,
    roots: Vec<usize>,
}

/// A node, and the places of what it is made of.
#[derive(Clone, Debug)]
enum Step {
    Constant(f64),
    Variable(usize),
    Parameter(usize),
    Time,
    Sum(f64, Vec<(f64, usize)>),
    Product(usize, usize),
    Quotient(usize, usize),
    Angle(usize, usize),
    Call(Function, usize),
    Power(usize, f64),
}

impl Precise {
    /// Of nodes.
    pub fn new(graph: &Graph, roots: &[Id]) -> Self {
        let nodes = graph.reachable(roots);
        let place = |id: &Id| nodes.partition_point(|node| node < id);
        let step = |id: &Id| match graph.node(*id) {
            Node::Constant(bits) => Step::Constant(number(*bits)),
            Node::Variable(index) => Step::Variable(*index as usize),
            Node::Parameter(index) => Step::Parameter(*index as usize),
            Node::Time => Step::Time,
            Node::Sum(constant, terms) => {
                let terms = terms.iter().map(|(factor, term)| (number(*factor), place(term))).collect();
                Step::Sum(number(*constant), terms)
            }
            Node::Product(a, b) => Step::Product(place(a), place(b)),
            Node::Quotient(a, b) => Step::Quotient(place(a), place(b)),
            Node::Angle(y, x) => Step::Angle(place(y), place(x)),
            Node::Call(function, a) => Step::Call(*function, place(a)),
            Node::Power(a, exponent) => Step::Power(place(a), number(*exponent)),
        };
        Self { steps: nodes.iter().map(step).collect(), roots: roots.iter().map(place).collect() }
    }

    /// Their values.
    pub fn at(&self, t: f64, state: &[DoubleDouble], parameters: &[f64]) -> Vec<DoubleDouble> {
        let mut values: Vec<DoubleDouble> = Vec::with_capacity(self.steps.len());
        for step in &self.steps {
            values.push(step.value(&values, t, state, parameters).0);
        }
        self.roots.iter().map(|root| values[*root]).collect()
    }
}

/// Numbers as which steps are taken.
trait Digits: Copy + Add<Output = Self> + Mul<Output = Self> + Div<Output = Self> + From<f64> {
    /// What an operation may be off by, against its result.
    const ROUNDING: f64;
    /// The number nearest to it.
    fn rounded(self) -> f64;
    /// The angle of the point whose y this is, a function, and a power; and whether they have all digits.
    fn angle(self, x: Self) -> (Self, bool);
    fn call(self, function: Function) -> (Self, bool);
    fn raised(self, exponent: f64) -> (Self, bool);
}

impl Digits for f64 {
    const ROUNDING: Self = 1e-15;
    fn rounded(self) -> f64 {
        self
    }
    fn angle(self, x: Self) -> (Self, bool) {
        (Scalar::angle(self, x), true)
    }
    fn call(self, function: Function) -> (Self, bool) {
        let program = || self.called(word::CALL + function as u16);
        (function.of_constant(self).unwrap_or_else(program), true)
    }
    fn raised(self, exponent: f64) -> (Self, bool) {
        (Scalar::raised(self, exponent), true)
    }
}

impl Digits for DoubleDouble {
    const ROUNDING: f64 = 1e-30;
    fn rounded(self) -> f64 {
        self.high()
    }
    fn angle(self, x: Self) -> (Self, bool) {
        or_rounded(functions::atan2(self, x), || Digits::angle(self.high(), x.high()))
    }
    fn call(self, function: Function) -> (Self, bool) {
        or_rounded(called(function, self), || self.high().call(function))
    }
    fn raised(self, exponent: f64) -> (Self, bool) {
        or_rounded(functions::power(self, exponent), || Digits::raised(self.high(), exponent))
    }
}

fn or_rounded(value: DoubleDouble, rounded: impl Fn() -> (f64, bool)) -> (DoubleDouble, bool) {
    if value.is_finite() { (value, true) } else { (DoubleDouble::from(rounded().0), false) }
}

impl Step {
    /// Its value, of those of the steps before it, and whether it has all digits of such numbers.
    fn value<S: Digits>(&self, values: &[S], t: f64, state: &[S], parameters: &[f64]) -> (S, bool) {
        let value = match self {
            Self::Constant(value) => S::from(*value),
            Self::Variable(index) => state[*index],
            Self::Parameter(index) => S::from(parameters[*index]),
            Self::Time => S::from(t),
            Self::Sum(constant, terms) => terms
                .iter()
                .fold(S::from(*constant), |sum, (factor, term)| sum + S::from(*factor) * values[*term]),
            Self::Product(a, b) => values[*a] * values[*b],
            Self::Quotient(a, b) => values[*a] / values[*b],
            Self::Angle(y, x) => return values[*y].angle(values[*x]),
            Self::Call(function, a) => return values[*a].call(*function),
            Self::Power(a, exponent) => return values[*a].raised(*exponent),
        };
        (value, true)
    }
}

fn called(function: Function, x: DoubleDouble) -> DoubleDouble {
    match function {
        Function::Sin => functions::sin_cos(x).0,
        Function::Cos => functions::sin_cos(x).1,
        Function::Tan => {
            let (sine, cosine) = functions::sin_cos(x);
            sine / cosine
        }
        Function::Exp => Exponential::exp(x),
        Function::Ln => functions::ln(x),
        Function::Sqrt => x.sqrt(),
        Function::Sinh => functions::sinh_cosh(x).0,
        Function::Cosh => functions::sinh_cosh(x).1,
        Function::Tanh => functions::tanh(x),
        Function::Asin => functions::asin_acos(x).0,
        Function::Acos => functions::asin_acos(x).1,
        Function::Atan => functions::atan2(x, DoubleDouble::one()),
        Function::Asinh => functions::asinh(x),
        Function::Acosh => functions::acosh(x),
        Function::Atanh => functions::atanh(x),
        Function::SechSquared => functions::sech_squared(x),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_soft_mode_beside_a_stiff_one_is_not_lost() {
        // The force on x of A (x - y)²/2 + B (x + y)²/2: at (1, 0) A + B, at (0, 1) B - A, and B/A is beneath the rounding.
        let (a, b) = (1e8, 1e-9);
        let mut graph = Graph::default();
        let (x, y) = (graph.variable(0), graph.variable(1));
        let (stiff, soft) = (graph.parameter(0), graph.parameter(1));
        let difference = graph.subtract(x, y);
        let sum = graph.add(x, y);
        let (first, second) = (graph.multiply(stiff, difference), graph.multiply(soft, sum));
        let force = graph.add(first, second);
        let precise = Precise::new(&graph, &[force]);
        let of = |state: [f64; 2]| precise.at(0.0, &state.map(DoubleDouble::from), &[a, b])[0];
        assert_eq!(of([1.0, 0.0]) + of([0.0, 1.0]), DoubleDouble::from(b) + DoubleDouble::from(b));
    }

    /// Functions, arguments, and values of mpmath in two parts.
    #[rustfmt::skip]
    const VALUES: [(&str, f64, f64, f64); 49] = [
        ("sin", 1e-9, 1e-9, -1.666_666_666_666_666_9e-28),
        ("sin", 0.7, 0.644_217_687_237_691, 2.874_056_792_733_875_5e-18),
        ("sin", -2.5, -0.598_472_144_103_956_5, 5.521_403_334_082_375e-17),
        ("sin", 33.0, 0.999_911_860_107_267_2, -3.508_023_705_061_323_4e-17),
        ("sin", 10_000_000.0, 0.420_547_793_190_782_5, -1.269_293_621_916_956e-17),
        ("cos", 1e-9, 1.0, -5e-19),
        ("cos", 0.7, 0.764_842_187_284_488_5, -4.013_780_434_022_238e-17),
        ("cos", 1.562_5, 0.008_296_231_623_858_378, -7.115_691_148_963_826e-20),
        ("cos", -33.0, -0.013_276_747_223_059_479, 1.597_491_155_790_178_3e-19),
        ("cos", 10_000_000.0, -0.907_270_386_181_739_6, 4.643_889_206_242_053_7e-17),
        ("tan", 0.3, 0.309_336_249_609_623_25, -2.747_596_618_381_192_7e-17),
        ("tan", 2.0, -2.185_039_863_261_519, -1.028_948_369_218_861_9e-16),
        ("exp", -30.0, 9.357_622_968_840_175e-14, -2.117_014_627_264_640_6e-30),
        ("exp", 0.3, 1.349_858_807_576_003_2, -9.447_314_673_432_387e-17),
        ("exp", 20.0, 485_165_195.409_790_3, 4.880_277_289_790_406e-10),
        ("log", 1e-200, -460.517_018_598_809_16, 2.208_094_265_724_106_6e-14),
        ("log", 0.6, -0.510_825_623_765_990_7, 1.523_381_509_985_101_4e-18),
        ("log", 1.000_976_562_5, 0.000_976_085_973_055_458_9, -2.879_115_653_409_671_4e-20),
        ("log", 7.0, 1.945_910_149_055_313_2, 7.323_586_207_904_907e-17),
        ("sqrt", 3.0, 1.732_050_807_568_877_2, 1.003_508_422_180_690_3e-16),
        ("sinh", 1e-9, 1e-9, 1.666_666_666_666_666_9e-28),
        ("sinh", 0.3, 0.304_520_293_447_142_6, 9.177_343_117_072_388e-18),
        ("sinh", -4.0, -27.289_917_197_127_753, 7.633_630_011_960_991e-16),
        ("cosh", 0.3, 1.045_338_514_128_860_5, 7.371_812_611_119_388e-18),
        ("cosh", -4.0, 27.308_232_836_016_487, 8.480_712_398_000_987e-17),
        ("tanh", -1e-9, -1e-9, 3.333_333_333_333_333_8e-28),
        ("tanh", 0.3, 0.291_312_612_451_590_9, -6.460_265_658_646_958_6e-18),
        ("tanh", -0.7, -0.604_367_777_117_163_5, 2.791_618_001_542_534_6e-17),
        ("tanh", 5.0, 0.999_909_204_262_595_1, 2.298_523_750_966_507e-17),
        ("asin", 1e-9, 1e-9, 1.666_666_666_666_666_9e-28),
        ("asin", 0.437_5, 0.452_816_594_744_925_6, -1.073_268_797_284_839_6e-17),
        ("asin", -0.999_023_437_5, -1.526_598_555_649_181_2, -6.880_835_197_693_321e-17),
        ("acos", 1e-9, 1.570_796_325_794_896_7, -7.807_189_403_102_154e-17),
        ("acos", -0.5, 2.094_395_102_393_195_7, -2.144_163_532_902_182e-16),
        ("acos", 0.999_023_437_5, 0.044_197_771_145_715_32, -6.371_181_156_583_169e-19),
        ("atan", 1e-9, 1e-9, -3.333_333_333_333_333_8e-28),
        ("atan", -0.7, -0.610_725_964_389_208_6, -2.241_891_446_296_745_8e-17),
        ("atan", 100_000.0, 1.570_786_326_794_897, 1.598_850_365_771_961_2e-17),
        ("asinh", 1e-9, 1e-9, -1.666_666_666_666_666_9e-28),
        ("asinh", -0.7, -0.652_666_566_082_355_7, -1.353_889_350_085_817_5e-17),
        ("asinh", 100_000.0, 12.206_072_645_555_174, -7.311_901_829_400_92e-16),
        ("acosh", 1.000_976_562_5, 0.044_190_578_083_110_096, -1.955_724_573_266_483_8e-18),
        ("acosh", 3.0, 1.762_747_174_039_086, -4.501_091_785_651_732e-17),
        ("atanh", 1e-9, 1e-9, 3.333_333_333_333_333_8e-28),
        ("atanh", -0.7, -0.867_300_527_694_053_1, -2.679_898_980_371_665_8e-17),
        ("atanh", 0.999_023_437_5, 3.812_065_292_830_644_7, 1.062_671_702_727_579_7e-16),
        ("sech_squared", 0.3, 0.915_136_961_826_629_2, 2.850_713_922_057_346e-17),
        ("sech_squared", -5.0, 0.000_181_583_230_943_806_7, -9.677_411_680_154_446e-21),
        ("sech_squared", 40.0, 7.219_405_551_381_661e-35, -5.054_641_449_505_631e-51),
    ];

    #[test]
    fn functions_have_thirty_digits() {
        for (name, x, high, low) in VALUES {
            let mut graph = Graph::default();
            let variable = graph.variable(0);
            let root = Function::named(name).map(|function| graph.call(function, variable));
            let found = Precise::new(&graph, root.as_slice()).at(0.0, &[DoubleDouble::from(x)], &[])[0];
            let off = (found - DoubleDouble::new(high, low)).high() / high;
            // A few roundings of 2^-104; an exponential's error is relative to 1 + |x|.
            assert!(off.abs() < 1e-30 * (1.0 + x.abs().min(40.0)), "{name} of {x:e}: {off:e}");
        }
    }

    #[test]
    fn what_has_no_more_digits_is_rounded_once() {
        let mut graph = Graph::default();
        let x = graph.variable(0);
        let roots = [Function::Sin, Function::Exp, Function::Ln].map(|function| graph.call(function, x));
        let of = |x: f64| Precise::new(&graph, &roots).at(0.0, &[DoubleDouble::from(x)], &[]);
        assert_eq!(of(1e12)[0].parts(), (crate::numerics::angles::sin(1e12), 0.0));
        assert_eq!(of(800.0)[1].high(), f64::INFINITY);
        assert!(of(-1.0)[2].high().is_nan() && of(0.0)[2].high() == f64::NEG_INFINITY);
    }

    #[test]
    fn angles_and_powers_have_thirty_digits() {
        // tan(π/3) = √3, and (9^(3/4))⁴ = 9³: each to a few roundings of 2^-104.
        let mut graph = Graph::default();
        let (x, y) = (graph.variable(0), graph.variable(1));
        let roots = [graph.angle(y, x), graph.power(x, 0.3)];
        let three = DoubleDouble::from(3.0).sqrt();
        let found = Precise::new(&graph, &roots).at(0.0, &[DoubleDouble::from(-1.0), three], &[]);
        let third = DoubleDouble::PI.scale(2.0) / DoubleDouble::from(3.0);
        assert!((found[0] - third).high().abs() < 1e-30);
        let of = |x: f64| Precise::new(&graph, &roots).at(0.0, &[DoubleDouble::from(x), three], &[])[1];
        // 0.3 is not 3/10: (8·8)^0.3 is the product of the two all the same.
        assert!((of(8.0) * of(8.0) - of(64.0)).high().abs() < 1e-29);
    }
}
