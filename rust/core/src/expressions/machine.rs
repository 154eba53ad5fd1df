//! A code with its registers: what a run holds for one trajectory, for eight, or for several stages of eight.

use super::code::Code;
use super::execute::{self, Part, room};
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use std::sync::Arc;

/// What registers hold: a number, or eight.
pub trait Width: Real {
    /// Runs a part of a code.
    fn execute(code: &Code, part: Part, registers: &mut [Self]);
}

impl Width for f64 {
    fn execute(code: &Code, part: Part, registers: &mut [Self]) {
        execute::one(code, part, registers);
    }
}

impl Width for Lanes {
    fn execute(code: &Code, part: Part, registers: &mut [Self]) {
        execute::lanes(code, part, registers);
    }
}

/// A code with its registers, whose preamble is done.
#[derive(Clone, Debug)]
pub struct Machine<S> {
    code: Arc<Code>,
    registers: Vec<S>,
}

impl<S: Width> Machine<S> {
    /// For these parameters.
    pub fn new(code: Arc<Code>, parameters: &[S]) -> Self {
        let registers = vec![S::zero(); room::<1>(&code)];
        let mut machine = Self { code, registers };
        machine.set_parameters(parameters);
        machine
    }

    /// For other parameters from now on.
    pub fn set_parameters(&mut self, parameters: &[S]) {
        let Self { code, registers } = self;
        let first = code.variables() + 1;
        registers[first..first + code.parameters()].copy_from_slice(parameters);
        S::execute(code, Part::Preamble, registers);
    }

    /// The code.
    pub fn code(&self) -> &Code {
        &self.code
    }

    /// The code and all registers, for those who run it themselves.
    pub fn parts(&mut self) -> (&Code, &mut [S]) {
        (&self.code, &mut self.registers)
    }

    /// The numbers of the state, to be written.
    #[inline]
    pub fn state(&mut self) -> &mut [S] {
        let count = self.code.variables;
        &mut self.registers[..count]
    }

    /// Runs the body at the state that was written and the time.
    #[inline]
    pub fn run(&mut self, t: S) {
        self.registers[self.code.variables] = t;
        S::execute(&self.code, Part::Body, &mut self.registers);
    }

    /// A result of the last run.
    #[inline]
    pub fn output(&self, index: usize) -> S {
        self.registers[usize::from(self.code.outputs[index])]
    }

    /// Runs the body at a state and writes all results.
    pub fn evaluate(&mut self, t: S, state: &[S], results: &mut [S]) {
        self.state().copy_from_slice(state);
        self.run(t);
        for (index, result) in results.iter_mut().enumerate() {
            *result = self.output(index);
        }
    }
}

/// A code with `K` times eight of each register, whose preamble is done.
#[derive(Clone, Debug)]
pub struct Blocks<const K: usize> {
    code: Arc<Code>,
    registers: Vec<Lanes>,
}

impl<const K: usize> Blocks<K> {
    /// For these parameters.
    pub fn new(code: Arc<Code>, parameters: &[Lanes]) -> Self {
        let registers = vec![Lanes::zero(); room::<K>(&code)];
        let mut blocks = Self { code, registers };
        blocks.set_parameters(parameters);
        blocks
    }

    /// For other parameters from now on.
    pub fn set_parameters(&mut self, parameters: &[Lanes]) {
        let Self { code, registers } = self;
        let first = code.variables() + 1;
        for (register, &value) in registers[first * K..].chunks_mut(K).zip(parameters) {
            register.fill(value);
        }
        execute::blocks::<K>(code, Part::Preamble, registers);
    }

    /// The code and all registers, `K` times eight numbers each, for those who run it themselves.
    pub fn parts(&mut self) -> (&Code, &mut [Lanes]) {
        (&self.code, &mut self.registers)
    }

    /// Runs the body at the same states and times in all blocks.
    pub fn run(&mut self, t: Lanes, state: &[Lanes]) {
        let numbers = state.iter().chain(core::iter::once(&t));
        for (register, &value) in self.registers.chunks_mut(K).zip(numbers) {
            register.fill(value);
        }
        execute::blocks::<K>(&self.code, Part::Body, &mut self.registers);
    }

    /// Runs the body at states and times of each block, by register (the last is the time) and block.
    pub fn run_apart(&mut self, number: impl Fn(usize, usize) -> Lanes) {
        let count = self.code.variables() + 1;
        for (register, blocks) in self.registers.chunks_mut(K).take(count).enumerate() {
            for (block, room) in blocks.iter_mut().enumerate() {
                *room = number(register, block);
            }
        }
        execute::blocks::<K>(&self.code, Part::Body, &mut self.registers);
    }

    /// A result of the first block.
    pub fn output(&self, index: usize) -> Lanes {
        self.output_of(index, 0)
    }

    /// A result of a block.
    pub fn output_of(&self, index: usize, block: usize) -> Lanes {
        self.registers[usize::from(self.code.outputs[index]) * K + block]
    }
}
