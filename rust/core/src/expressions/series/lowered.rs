//! From a program to recurrences: which values are series, where they lie, and of what functions are the integrals.

use super::super::code::{scratch, word};
use super::super::function::Function;
use super::super::program::{Operation, Program, Value};
use super::expansion::inverse;
use super::recurrence::{Entry, Place, Recurrence, Recurrences};
use super::{ORDERS, Series};
use rustc_hash::FxHashMap;

/// The recurrences of a program.
pub(super) fn lowered(program: &Program) -> Series {
    let (variables, parameters) = (program.variables as usize, program.parameters as usize);
    let constants = program.values as usize;
    let mut lowering = Lowering {
        values: vec![Entry { place: 0, varies: false }; constants],
        constants: 0,
        series: constants,
        slopes: FxHashMap::default(),
        radicands: vec![],
        made: vec![],
        lines: FxHashMap::default(),
        scratch: 0,
    };
    // Parameters are the first constants, the state and the time the first series.
    for input in 0..=variables + parameters {
        let _ = lowering.declare(input as Value, input <= variables);
    }
    let mut made = |operations: &[Operation], vary: bool| {
        operations.iter().for_each(|operation| lowering.lower(operation, vary));
        core::mem::take(&mut lowering.made)
    };
    let (preamble, body) = (made(&program.preamble, false), made(&program.body, true));
    let place = |value: Value| lowering.at(value).place;
    let numbers = lowering.series;
    let inputs: Vec<Place> = (0..=variables as Value).map(place).collect();
    let outputs: Vec<Place> = program.outputs.iter().copied().map(place).collect();
    // What is not below the first input is a series.
    let is_there = |place: &Place| place + if *place < inputs[0] { 1 } else { ORDERS } <= numbers;
    assert!(inputs.iter().chain(&outputs).all(is_there), "a place beyond all numbers");
    Series {
        variables,
        parameters,
        preamble: Recurrences::new(preamble, numbers, false),
        body: Recurrences::new(body, numbers, true),
        inputs,
        outputs,
        radicands: lowering.radicands,
        numbers,
        scratch: lowering.scratch,
        inverses: core::array::from_fn(inverse),
    }
}

/// Values as they get their places: there are no more constants than values, and series come after them.
struct Lowering {
    values: Vec<Entry>,
    constants: usize,
    series: usize,
    /// The slopes of the series that have them.
    slopes: FxHashMap<Place, Place>,
    /// What stands below roots and broken powers.
    radicands: Vec<Place>,
    made: Vec<Recurrence>,
    /// Of the series that are c₀ + c x: c and x.
    lines: FxHashMap<Place, (f64, Place)>,
    scratch: usize,
}

impl Lowering {
    fn at(&self, value: Value) -> Entry {
        self.values[value as usize]
    }

    /// A place for a series.
    fn room(&mut self) -> Place {
        self.series += ORDERS;
        self.series - ORDERS
    }

    fn declare(&mut self, value: Value, varies: bool) -> Place {
        let place = if varies {
            self.room()
        } else {
            self.constants += 1;
            self.constants - 1
        };
        self.values[value as usize] = Entry { place, varies };
        place
    }

    fn push(&mut self, recurrence: Recurrence) {
        self.made.push(recurrence);
    }

    /// The slopes of a series.
    fn slopes_of(&mut self, of: Place) -> Place {
        if let Some(&slopes) = self.slopes.get(&of) {
            return slopes;
        }
        let to = self.room();
        let _ = self.slopes.insert(of, to);
        self.push(Recurrence::Slopes { to, of });
        to
    }

    /// c₀ + Σ c x + Σ c a b, of terms and products by what varies in them.
    fn sum(
        &mut self,
        to: Place,
        constant: f64,
        terms: [Vec<(f64, Place)>; 2],
        products: [Vec<(f64, Place, Place)>; 3],
    ) {
        if let ([(factor, x)], true, true) = (&*terms[0], products[0].is_empty(), products[1].is_empty()) {
            let (further, x) = self.lines.get(x).copied().unwrap_or((1.0, *x));
            let _ = self.lines.insert(to, (factor * further, x));
        }
        let inner = self.alike(&products[0]);
        self.push(Recurrence::Sum { to, constant, terms, products, inner });
    }

    /// What products come to but for their outermost coefficients. There c₀ + c x is c x, so y (1 + y) and y² are alike.
    fn alike(&self, products: &[(f64, Place, Place)]) -> Vec<(f64, Place, Place)> {
        let mut like: Vec<(f64, Place, Place)> = Vec::new();
        for &(factor, a, b) in products {
            let line = |x: Place| self.lines.get(&x).copied().unwrap_or((1.0, x));
            let ((of_a, a), (of_b, b)) = (line(a), line(b));
            let (factor, a, b) = (factor * of_a * of_b, a.min(b), a.max(b));
            match like.iter_mut().find(|(_, x, y)| (*x, *y) == (a, b)) {
                Some((sum, ..)) => *sum += factor,
                None => like.push((factor, a, b)),
            }
        }
        like.retain(|&(factor, ..)| factor != 0.0);
        // A square has half the products.
        let cost =
            |of: &[(f64, Place, Place)]| of.iter().map(|&(_, a, b)| 1 + usize::from(a != b)).sum::<usize>();
        if cost(&like) < cost(products) { like } else { products.to_vec() }
    }

    /// c₀ + c x.
    fn shifted(&mut self, constant: f64, factor: f64, x: Place) -> Place {
        let to = self.room();
        self.sum(to, constant, [vec![(factor, x)], vec![]], Default::default());
        to
    }

    /// c₀ + c x².
    fn square(&mut self, constant: f64, factor: f64, x: Place) -> Place {
        let (to, products) = (self.room(), [vec![(factor, x, x)], vec![], vec![]]);
        self.sum(to, constant, Default::default(), products);
        to
    }

    fn product(&mut self, a: Place, b: Place) -> Place {
        let to = self.room();
        self.push(Recurrence::Product { to, a, b });
        to
    }

    fn root(&mut self, a: Place) -> Place {
        let to = self.room();
        self.root_into(to, a);
        to
    }

    fn root_into(&mut self, to: Place, a: Place) {
        self.below_root(a);
        self.push(Recurrence::Root { to, a });
    }

    fn below_root(&mut self, a: Place) {
        if !self.radicands.contains(&a) {
            self.radicands.push(a);
        }
    }

    fn reciprocal(&mut self, value: f64, b: Place) -> Place {
        let to = self.room();
        self.push(Recurrence::Reciprocal { to, value, b });
        to
    }

    fn integral(&mut self, function: Function, of: Place, to: Place, rate: Place) {
        let slopes = self.slopes_of(of);
        self.push(Recurrence::Integral { to, word: word::CALL + function as u16, of, slopes, rate });
    }

    /// A function of a series.
    fn function(&mut self, function: Function, to: Place, of: Place) {
        match function {
            Function::Sqrt => self.root_into(to, of),
            Function::Exp => self.integral(function, of, to, to),
            // Their rates hang on themselves, and come after them.
            Function::Tan => {
                let rate = self.room();
                self.integral(function, of, to, rate);
                let products = [vec![(1.0, to, to)], vec![], vec![]];
                self.sum(rate, 1.0, Default::default(), products);
            }
            // (sech²)' = −2 tanh · sech², and tanh' = sech².
            Function::Tanh | Function::SechSquared => {
                let (other, rate) = (self.room(), self.room());
                let (tangent, slope) = if function == Function::Tanh { (to, other) } else { (other, to) };
                self.integral(Function::Tanh, of, tangent, slope);
                self.integral(Function::SechSquared, of, slope, rate);
                let products = [vec![(-2.0, tangent, slope)], vec![], vec![]];
                self.sum(rate, 0.0, Default::default(), products);
            }
            Function::Sinh | Function::Cosh => {
                let (other, rate) = (self.room(), [Function::Cosh, Function::Sinh]);
                self.integral(function, of, to, other);
                self.integral(rate[usize::from(function == Function::Cosh)], of, other, to);
            }
            // Pairs, which come by themselves.
            Function::Sin | Function::Cos => {
                let other = self.room();
                let (sine, cosine) = if function == Function::Sin { (to, other) } else { (other, to) };
                self.sine_and_cosine(sine, cosine, of);
            }
            _ => {
                let rate = self.inverse_rate(function, of);
                self.integral(function, of, to, rate);
            }
        }
    }

    fn sine_and_cosine(&mut self, sine: Place, cosine: Place, of: Place) {
        let slopes = self.slopes_of(of);
        self.push(Recurrence::SineCosine { sine, cosine, of, slopes });
    }

    /// The derivative of the logarithm, or of an inverse function.
    fn inverse_rate(&mut self, function: Function, of: Place) -> Place {
        let sign = if function == Function::Acos { -1.0 } else { 1.0 };
        let below = match function {
            Function::Ln => of,
            Function::Atan => self.square(1.0, 1.0, of),
            Function::Asinh => {
                let inside = self.square(1.0, 1.0, of);
                self.root(inside)
            }
            Function::Atanh | Function::Asin | Function::Acos => {
                let (less, more) = (self.shifted(1.0, -1.0, of), self.shifted(1.0, 1.0, of));
                let inside = self.product(less, more);
                if function == Function::Atanh { inside } else { self.root(inside) }
            }
            _ => {
                let (less, more) = (self.shifted(-1.0, 1.0, of), self.shifted(1.0, 1.0, of));
                let inside = self.product(less, more);
                self.root(inside)
            }
        };
        self.reciprocal(sign, below)
    }

    /// The recurrences of an operation; what it writes are series, or constants.
    fn lower(&mut self, operation: &Operation, vary: bool) {
        for value in operation.written() {
            let _ = self.declare(value, vary);
        }
        let at = |value: &Value| self.values[*value as usize];
        let recurrence = match operation {
            Operation::Constant(to, value) => Recurrence::Constant { to: at(to).place, value: *value },
            Operation::Linear { to, constant, terms, products } => {
                let mut split = ([vec![], vec![]], [vec![], vec![], vec![]]);
                for (factor, x) in terms {
                    split.0[usize::from(!at(x).varies)].push((*factor, at(x).place));
                }
                for (factor, a, b) in products {
                    let (a, b) = (at(a), at(b));
                    let (a, b) = if a.varies && !b.varies { (b, a) } else { (a, b) };
                    let kind = usize::from(!a.varies) + usize::from(!b.varies);
                    split.1[kind].push((*factor, a.place, b.place));
                }
                let (terms, products) = split;
                let to = at(to).place;
                return self.sum(to, *constant, terms, products);
            }
            Operation::Product(to, a, b) => {
                let (to, Entry { place: a, varies }, b) = (at(to).place, at(a), at(b));
                match (varies, b.varies) {
                    (true, true) => Recurrence::Product { to, a, b: b.place },
                    (true, false) => Recurrence::Multiple { to, constant: b.place, of: a },
                    (false, true) => Recurrence::Multiple { to, constant: a, of: b.place },
                    (false, false) => Recurrence::Times { to, a, b: b.place },
                }
            }
            Operation::Quotient(to, a, b) => {
                let (to, Entry { place: a, varies }, b) = (at(to).place, at(a), at(b));
                match (varies, b.varies) {
                    (true, true) => Recurrence::Quotient { to, a, b: b.place },
                    (true, false) => Recurrence::Part { to, a, constant: b.place },
                    (false, true) => Recurrence::Over { to, constant: a, b: b.place },
                    (false, false) => Recurrence::Divided { to, a, b: b.place },
                }
            }
            Operation::Reciprocal(to, value, b) => {
                let (to, value, constant) = (at(to).place, *value, at(b).place);
                if at(b).varies {
                    Recurrence::Reciprocal { to, value, b: constant }
                } else {
                    Recurrence::Inverse { to, value, constant }
                }
            }
            Operation::Angle(to, y, x) => {
                let (to, y, x) = (at(to).place, at(y), at(x));
                return self.angle(to, y, x);
            }
            Operation::SineCosine { sine, cosine, of } => {
                let (sine, cosine, of) = (at(sine).place, at(cosine).place, at(of));
                if of.varies {
                    return self.sine_and_cosine(sine, cosine, of.place);
                }
                Recurrence::Turn { sine, cosine, of: of.place }
            }
            Operation::Call(function, to, a) => {
                let (to, a) = (at(to).place, at(a));
                if a.varies {
                    return self.function(*function, to, a.place);
                }
                Recurrence::Call { to, word: word::CALL + *function as u16, of: a.place }
            }
            Operation::Power(to, a, exponent) => {
                let (to, a, exponent) = (at(to).place, at(a), *exponent);
                if a.varies {
                    self.below_root(a.place);
                    let slopes = [self.slopes_of(a.place), self.room()];
                    Recurrence::Power { to, a: a.place, exponent, slopes }
                } else {
                    Recurrence::Raised { to, a: a.place, exponent }
                }
            }
            Operation::Solve { matrix, right, to, inner } => {
                let triangle = self.scratch;
                let solve = Recurrence::Solve {
                    matrix: matrix.iter().map(at).collect(),
                    right: right.iter().map(at).collect(),
                    to: to.iter().map(|value| at(value).place).collect(),
                    triangle,
                    inner: *inner,
                };
                self.scratch += scratch(right.len());
                solve
            }
        };
        self.push(recurrence);
    }

    /// The angle of a point: y′ x/(x² + y²) − x′ y/(x² + y²), of what varies.
    fn angle(&mut self, to: Place, y: Entry, x: Entry) {
        if !y.varies && !x.varies {
            return self.push(Recurrence::Direction { to, y: y.place, x: x.place });
        }
        let squares = self.room();
        let mut products = [vec![], vec![], vec![]];
        for entry in [y, x] {
            products[if entry.varies { 0 } else { 2 }].push((1.0, entry.place, entry.place));
        }
        self.sum(squares, 0.0, Default::default(), products);
        let mut part = |of: Entry, by: Entry| {
            of.varies.then(|| {
                let rate = self.room();
                self.push(if by.varies {
                    Recurrence::Quotient { to: rate, a: by.place, b: squares }
                } else {
                    Recurrence::Over { to: rate, constant: by.place, b: squares }
                });
                (self.slopes_of(of.place), rate)
            })
        };
        let parts = [part(y, x), part(x, y)];
        self.push(Recurrence::Angle { to, y: y.place, x: x.place, parts });
    }
}
