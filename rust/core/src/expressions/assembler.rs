//! From operations to words: registers by linear scan, sums in their cheapest form.

use super::code::{Code, Parts, word};
use super::graph::Graph;
use super::program::{self, LinearSystem, Operation, Output, Program, Value};
use crate::error::{Error, Result};
use rustc_hash::FxHashMap;

/// Values that live to the end.
const FOREVER: usize = usize::MAX;

/// The code that gives these outputs, as functions of so many numbers of a state, the time, and so many parameters.
///
/// # Errors
/// Expressions too large for one program; a variable that is not there.
pub fn compile(
    graph: &Graph,
    inputs: (usize, usize),
    systems: &[LinearSystem],
    outputs: &[Output],
) -> Result<Code> {
    let program = program::write(graph, inputs, systems, outputs)?;
    Assembler::new(&program).assembled(&program)
}

struct Assembler {
    /// The last operation of the body that reads a value.
    last_read: Vec<usize>,
    registers: Vec<Option<u16>>,
    free: Vec<u16>,
    count: usize,
    constants: Vec<f64>,
    constant_places: FxHashMap<u64, u16>,
}

impl Assembler {
    fn new(program: &Program) -> Self {
        let inputs = (program.variables + 1 + program.parameters) as usize;
        let mut last_read = vec![0; program.values as usize];
        for (index, operation) in program.body.iter().enumerate() {
            for value in operation.read() {
                last_read[value as usize] = index;
            }
        }
        // Inputs, and what is found once, are there for every state.
        let kept =
            program.preamble.iter().flat_map(Operation::written).chain(program.outputs.iter().copied());
        kept.chain(0..inputs as Value).for_each(|value| last_read[value as usize] = FOREVER);
        let mut registers = vec![None; program.values as usize];
        for (index, register) in registers.iter_mut().enumerate().take(inputs) {
            *register = Some(index as u16);
        }
        Self {
            last_read,
            registers,
            free: vec![],
            count: inputs,
            constants: vec![],
            constant_places: FxHashMap::default(),
        }
    }

    fn assembled(mut self, program: &Program) -> Result<Code> {
        let preamble = self.words(&program.preamble, true)?;
        let body = self.words(&program.body, false)?;
        let outputs = program.outputs.iter().map(|&value| self.register(value)).collect::<Result<_>>()?;
        if self.count > usize::from(u16::MAX) || self.constants.len() > usize::from(u16::MAX) {
            return Err(Error::invalid(
                "expression",
                format!("too large for one program: {} numbers at a time", self.count),
            ));
        }
        Code::new(Parts {
            variables: program.variables as usize,
            parameters: program.parameters as usize,
            registers: self.count,
            constants: self.constants,
            preamble,
            body,
            outputs,
        })
    }

    fn words(&mut self, operations: &[Operation], forever: bool) -> Result<Vec<u16>> {
        let mut words = Vec::new();
        for (index, operation) in operations.iter().enumerate() {
            let read = operation.read();
            let mut dying: Vec<Value> = read
                .iter()
                .copied()
                .filter(|&value| !forever && self.last_read[value as usize] == index)
                .collect();
            dying.sort_unstable();
            dying.dedup();
            let dying: Vec<u16> =
                dying.into_iter().map(|value| self.register(value)).collect::<Result<_>>()?;
            // Element by element, what an operation reads is read before it writes; a solution is not.
            let in_place = !matches!(operation, Operation::Solve { .. } | Operation::SineCosine { .. });
            if in_place {
                self.free.extend(&dying);
            }
            for value in operation.written() {
                let register = self.free.pop().unwrap_or_else(|| {
                    self.count += 1;
                    (self.count - 1) as u16
                });
                self.registers[value as usize] = Some(register);
            }
            if !in_place {
                self.free.extend(&dying);
            }
            self.encode(operation, &mut words)?;
        }
        words.push(word::END);
        Ok(words)
    }

    fn register(&self, value: Value) -> Result<u16> {
        self.registers[value as usize].ok_or_else(|| Error::Internal(format!("value {value} is not there")))
    }

    fn constant(&mut self, value: f64) -> u16 {
        *self.constant_places.entry(value.to_bits()).or_insert_with(|| {
            self.constants.push(value);
            (self.constants.len() - 1) as u16
        })
    }

    fn encode(&mut self, operation: &Operation, words: &mut Vec<u16>) -> Result<()> {
        let r = |value: &Value| self.register(*value);
        match operation {
            Operation::Constant(to, value) => {
                let to = r(to)?;
                words.extend([word::CONSTANT, to, self.constant(*value)]);
            }
            Operation::Linear { to, constant, terms, products } => {
                let to = r(to)?;
                self.encode_sum(to, *constant, terms, products, words)?;
            }
            Operation::Product(to, a, b) if a == b => words.extend([word::SQUARE, r(to)?, r(a)?]),
            Operation::Product(to, a, b) => words.extend([word::MULTIPLY, r(to)?, r(a)?, r(b)?]),
            Operation::Quotient(to, a, b) => words.extend([word::DIVIDE, r(to)?, r(a)?, r(b)?]),
            Operation::Angle(to, y, x) => words.extend([word::ANGLE, r(to)?, r(y)?, r(x)?]),
            Operation::Reciprocal(to, value, a) => {
                let (to, a) = (r(to)?, r(a)?);
                words.extend([word::RECIPROCAL, to, self.constant(*value), a]);
            }
            Operation::SineCosine { sine, cosine, of } => {
                words.extend([word::SINE_COSINE, r(sine)?, r(cosine)?, r(of)?]);
            }
            Operation::Call(function, to, a) => words.extend([word::CALL + *function as u16, r(to)?, r(a)?]),
            Operation::Power(to, a, exponent) => {
                let (to, a) = (r(to)?, r(a)?);
                words.extend([word::POWER, to, a, self.constant(*exponent)]);
            }
            Operation::Solve { matrix, right, to, inner } => {
                let registers: Vec<u16> =
                    matrix.iter().chain(right).chain(to).map(r).collect::<Result<_>>()?;
                words.extend([word::SOLVE, right.len() as u16, *inner as u16]);
                words.extend(registers);
            }
        }
        Ok(())
    }

    /// A sum in its cheapest form.
    fn encode_sum(
        &mut self,
        to: u16,
        constant: f64,
        terms: &[(f64, Value)],
        products: &[(f64, Value, Value)],
        words: &mut Vec<u16>,
    ) -> Result<()> {
        match (constant, terms, products) {
            (0.0, &[(factor, a)], []) => {
                let a = self.register(a)?;
                words.extend([word::SCALE, to, self.constant(factor), a]);
            }
            (0.0, &[(1.0, a), (1.0, b)], []) => {
                words.extend([word::ADD, to, self.register(a)?, self.register(b)?]);
            }
            (0.0, &[(1.0, a), (-1.0, b)] | &[(-1.0, b), (1.0, a)], []) => {
                words.extend([word::SUBTRACT, to, self.register(a)?, self.register(b)?]);
            }
            (0.0, &[(1.0, c)], &[(1.0, a, b)]) => {
                words.extend([word::FUSED, to, self.register(a)?, self.register(b)?, self.register(c)?]);
            }
            _ => {
                let group = |is: fn(f64) -> bool| products.iter().filter(move |product| is(product.0));
                let (plus, minus) = (group(|c| c == 1.0), group(|c| c == -1.0));
                let others = group(|c| c != 1.0 && c != -1.0);
                let counts = [plus.clone().count(), minus.clone().count(), others.clone().count()];
                words.extend([word::LINEAR, to, self.constant(constant), terms.len() as u16]);
                words.extend(counts.map(|count| count as u16));
                for &(factor, a) in terms {
                    words.extend([self.constant(factor), self.register(a)?]);
                }
                for &(_, a, b) in plus.chain(minus) {
                    words.extend([self.register(a)?, self.register(b)?]);
                }
                for &(factor, a, b) in others {
                    words.extend([self.constant(factor), self.register(a)?, self.register(b)?]);
                }
            }
        }
        Ok(())
    }
}
