//! The check that nothing runs without: every operation is whole, and every register and constant is there.
//!
//! What it does not ask is whether a register was written before it is read: then it holds the number that was there
//! before, and no harm is done.

use super::code::{Parts, scratch, word};
use super::function::Function;
use crate::error::{Error, Result};

/// What the check finds out.
pub(super) struct Checked {
    /// Room for linear systems.
    pub(super) scratch: usize,
    /// Operations for each state.
    pub(super) operations: usize,
}

/// One stretch of words on its way.
struct Reader<'a> {
    words: &'a [u16],
    place: usize,
    registers: usize,
    constants: usize,
    unknowns: usize,
}

fn refused(why: &str) -> Error {
    Error::invalid("program", format!("these are not the words of a program: {why}"))
}

/// Checks all parts of a program.
///
/// # Errors
/// Parts that make none.
pub(super) fn checked(parts: &Parts) -> Result<Checked> {
    let inputs = parts.variables.checked_add(1).and_then(|n| n.checked_add(parts.parameters));
    if inputs.is_none_or(|inputs| inputs > parts.registers) || parts.registers > usize::from(u16::MAX) {
        return Err(refused("the registers are too few or too many"));
    }
    if parts.outputs.iter().any(|&output| usize::from(output) >= parts.registers) {
        return Err(refused("a result is in no register"));
    }
    let mut unknowns = 0;
    let mut operations = 0;
    for words in [&parts.preamble, &parts.body] {
        let (registers, constants) = (parts.registers, parts.constants.len());
        let mut reader = Reader { words, place: 0, registers, constants, unknowns: 0 };
        operations = reader.all()?;
        unknowns = unknowns.max(reader.unknowns);
    }
    Ok(Checked { scratch: scratch(unknowns), operations })
}

impl Reader<'_> {
    fn word(&mut self) -> Result<u16> {
        let word = self.words.get(self.place).copied().ok_or_else(|| refused("an operation is cut off"))?;
        self.place += 1;
        Ok(word)
    }

    fn registers(&mut self, count: usize) -> Result<()> {
        for _ in 0..count {
            if usize::from(self.word()?) >= self.registers {
                return Err(refused("a register is not there"));
            }
        }
        Ok(())
    }

    fn constant(&mut self) -> Result<()> {
        if usize::from(self.word()?) >= self.constants {
            return Err(refused("a constant is not there"));
        }
        Ok(())
    }

    /// Reads to the end; the operations on the way.
    fn all(&mut self) -> Result<usize> {
        for operations in 0.. {
            if self.operation()? {
                return Ok(operations);
            }
        }
        Err(refused("there is no end"))
    }

    /// Reads an operation; whether it is the end.
    fn operation(&mut self) -> Result<bool> {
        match self.word()? {
            word::END if self.place == self.words.len() => return Ok(true),
            word::CONSTANT => {
                self.registers(1)?;
                self.constant()?;
            }
            word::ADD | word::SUBTRACT | word::MULTIPLY | word::DIVIDE | word::ANGLE | word::SINE_COSINE => {
                self.registers(3)?
            }
            word::SQUARE => self.registers(2)?,
            word::FUSED => self.registers(4)?,
            word::SCALE | word::RECIPROCAL => {
                self.registers(1)?;
                self.constant()?;
                self.registers(1)?;
            }
            word::POWER => {
                self.registers(2)?;
                self.constant()?;
            }
            word::LINEAR => {
                self.registers(1)?;
                self.constant()?;
                let [terms, plus, minus, others] =
                    [self.word()?, self.word()?, self.word()?, self.word()?].map(usize::from);
                for _ in 0..terms {
                    self.constant()?;
                    self.registers(1)?;
                }
                self.registers(2 * (plus + minus))?;
                for _ in 0..others {
                    self.constant()?;
                    self.registers(2)?;
                }
            }
            word::SOLVE => {
                let unknowns = usize::from(self.word()?);
                if usize::from(self.word()?) > unknowns {
                    return Err(refused("a linear system has more rows than unknowns"));
                }
                self.unknowns = self.unknowns.max(unknowns);
                self.registers(unknowns * (unknowns + 1) / 2 + 2 * unknowns)?;
            }
            call if usize::from(call).wrapping_sub(usize::from(word::CALL)) < Function::ALL.len() => {
                self.registers(2)?;
            }
            _ => return Err(refused("an operation is not known")),
        }
        Ok(false)
    }
}
