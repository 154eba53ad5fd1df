//! Code: a program in words of sixteen bits, ready to run.
//!
//! The one idea: whoever runs it trusts its indices, so a [`Code`] can be made in no other way than by a check of all of
//! them ([`verify`](super::verify)).

use super::verify;
use crate::error::Result;

/// What a word at the beginning of an operation means, and what follows it. `r` are registers, `c` constants.
pub(super) mod word {
    /// r, c: a constant.
    pub(in super::super) const CONSTANT: u16 = 0;
    /// r, r, r.
    pub(in super::super) const ADD: u16 = 1;
    /// r, r, r.
    pub(in super::super) const SUBTRACT: u16 = 2;
    /// r, r, r.
    pub(in super::super) const MULTIPLY: u16 = 3;
    /// r, r: a square.
    pub(in super::super) const SQUARE: u16 = 4;
    /// r, r, r, r: a · b + c.
    pub(in super::super) const FUSED: u16 = 5;
    /// r, c, r.
    pub(in super::super) const SCALE: u16 = 6;
    /// r, c, and how many terms, products, products to be taken away, and products with coefficients there are; then
    /// (c, r) …, (r, r) …, (r, r) …, (c, r, r) …
    pub(in super::super) const LINEAR: u16 = 7;
    /// r, r, r.
    pub(in super::super) const DIVIDE: u16 = 8;
    /// r, c, r: a constant over a number.
    pub(in super::super) const RECIPROCAL: u16 = 9;
    /// r, r, r: sine, cosine, of.
    pub(in super::super) const SINE_COSINE: u16 = 10;
    /// n, the lower triangle of a symmetric matrix, the right side, the unknowns.
    pub(in super::super) const SOLVE: u16 = 11;
    /// r, r, c: a power.
    pub(in super::super) const POWER: u16 = 12;
    /// The end.
    pub(in super::super) const END: u16 = 13;
    /// r, r, r: the angle of a point, of its y and x.
    pub(in super::super) const ANGLE: u16 = 14;
    /// r, r: a function; the words from here on are the functions by their numbers.
    pub(in super::super) const CALL: u16 = 32;
}

/// A checked program. Registers 0 … are the state, then the time, then the parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Code {
    pub(super) variables: usize,
    pub(super) parameters: usize,
    pub(super) registers: usize,
    /// Room that the largest linear system takes.
    pub(super) scratch: usize,
    pub(super) constants: Vec<f64>,
    /// What is done once per run.
    pub(super) preamble: Vec<u16>,
    /// What is done for each state.
    pub(super) body: Vec<u16>,
    /// The registers of the results.
    pub(super) outputs: Vec<u16>,
    pub(super) operations: usize,
}

/// The parts of a code, as a file has them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parts {
    /// Numbers of the state.
    pub variables: usize,
    /// Parameters.
    pub parameters: usize,
    /// Registers.
    pub registers: usize,
    /// Constants.
    pub constants: Vec<f64>,
    /// What is done once per run.
    pub preamble: Vec<u16>,
    /// What is done for each state.
    pub body: Vec<u16>,
    /// The registers of the results.
    pub outputs: Vec<u16>,
}

impl Code {
    /// From its parts, all of which are checked.
    ///
    /// # Errors
    /// Parts that make no program.
    pub fn new(parts: Parts) -> Result<Self> {
        let checked = verify::checked(&parts)?;
        let Parts { variables, parameters, registers, constants, preamble, body, outputs } = parts;
        Ok(Self {
            variables,
            parameters,
            registers,
            scratch: checked.scratch,
            constants,
            preamble,
            body,
            outputs,
            operations: checked.operations,
        })
    }

    /// Its parts.
    pub fn parts(&self) -> Parts {
        Parts {
            variables: self.variables,
            parameters: self.parameters,
            registers: self.registers,
            constants: self.constants.clone(),
            preamble: self.preamble.clone(),
            body: self.body.clone(),
            outputs: self.outputs.clone(),
        }
    }

    /// Numbers of the state that it is a function of.
    pub fn variables(&self) -> usize {
        self.variables
    }

    /// Parameters.
    pub fn parameters(&self) -> usize {
        self.parameters
    }

    /// How many numbers it gives.
    pub fn outputs(&self) -> usize {
        self.outputs.len()
    }

    /// Operations for each state.
    pub fn operations(&self) -> usize {
        self.operations
    }

    /// The registers of the results.
    pub fn output_registers(&self) -> &[u16] {
        &self.outputs
    }

    /// Registers in all.
    pub fn registers(&self) -> usize {
        self.registers
    }
}

/// Elements of room that a linear system of so many unknowns takes: its triangle, its right side, and a row.
pub(super) const fn scratch(unknowns: usize) -> usize {
    unknowns * (unknowns + 1) / 2 + 2 * unknowns
}
