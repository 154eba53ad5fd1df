//! Runs code: one operation after another, each for all that lies in its registers.
//!
//! The one idea: the loop over words is the only thing that is interpreted. An operation does eight states at once, or `K`
//! times eight, so its dispatch is shared; it is the same sequence of correctly rounded operations for one number as in
//! every lane of every tier, so a trajectory has the bits that it has alone.

use super::code::{Code, word};
use super::function::Function;
use super::linear;
use crate::numerics::binary::Binary;
use crate::numerics::elementary::Exponential;
use crate::numerics::functions;
#[cfg(target_arch = "x86_64")]
use crate::numerics::lanes::{Avx2, Avx512};
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::real::Mask;
use crate::tiered;

/// The word of the square root.
const SQRT: u16 = word::CALL + Function::Sqrt as u16;

/// What registers hold. What is called seldom is compiled once for each tier, and not wherever code is run.
pub trait Scalar: Binary + Exponential + functions::Functions {
    /// A function by its word.
    #[must_use]
    fn called(self, word: u16) -> Self;
    /// A constant power.
    #[must_use]
    fn raised(self, exponent: f64) -> Self;
    /// The angle of the point whose y this is.
    #[must_use]
    fn angle(self, x: Self) -> Self;
    /// So many numbers are in it.
    const LANES: usize;
    /// One of its numbers.
    #[must_use]
    fn lane(self, lane: usize) -> f64;
    /// With another number in that place.
    #[must_use]
    fn with_lane(self, lane: usize, value: f64) -> Self;
}

impl Scalar for f64 {
    #[inline(always)]
    fn called(self, word: u16) -> Self {
        called(word, Lanes([self; WIDTH])).0[0]
    }
    #[inline(always)]
    fn raised(self, exponent: f64) -> Self {
        raised(exponent, Lanes([self; WIDTH])).0[0]
    }
    #[inline(always)]
    fn angle(self, x: Self) -> Self {
        angle(Lanes([self; WIDTH]), Lanes([x; WIDTH])).0[0]
    }
    const LANES: usize = 1;
    #[inline(always)]
    fn lane(self, _: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn with_lane(self, _: usize, value: f64) -> Self {
        value
    }
}

macro_rules! by_lanes {
    ($($(#[$meta:meta])* $type:ty),+) => {$(
        $(#[$meta])*
        impl Scalar for $type {
            #[inline(always)]
            fn called(self, word: u16) -> Self {
                Self::load(called(word, self.store()))
            }
            #[inline(always)]
            fn raised(self, exponent: f64) -> Self {
                Self::load(raised(exponent, self.store()))
            }
            #[inline(always)]
            fn angle(self, x: Self) -> Self {
                Self::load(angle(self.store(), x.store()))
            }
            const LANES: usize = WIDTH;
            #[inline(always)]
            fn lane(self, lane: usize) -> f64 {
                self.store().0[lane]
            }
            #[inline(always)]
            fn with_lane(self, lane: usize, value: f64) -> Self {
                let mut lanes = self.store();
                lanes.0[lane] = value;
                Self::load(lanes)
            }
        }
    )+};
}
by_lanes!(
    Lanes,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512
);

#[inline(always)]
fn called_body<V: Vector8 + functions::Functions>(word: u16, x: Lanes) -> Lanes {
    call(word, V::load(x)).store()
}

#[inline(always)]
fn raised_body<V: Vector8 + functions::Functions>(exponent: f64, x: Lanes) -> Lanes {
    functions::power(V::load(x), exponent).store()
}

#[inline(always)]
fn angle_body<V: Vector8 + functions::Functions>(y: Lanes, x: Lanes) -> Lanes {
    functions::atan2(V::load(y), V::load(x)).store()
}

/// Which part of a code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Part {
    /// What depends on parameters alone.
    Preamble,
    /// What is done for each state.
    Body,
}

/// Elements that registers of `K` blocks and linear systems take.
pub fn room<const K: usize>(code: &Code) -> usize {
    code.registers * K + code.scratch
}

/// Runs a part of the code on registers of `K` blocks each, register after register, and room for linear systems.
///
/// # Panics
/// If there is less room than [`room`] says.
#[inline(always)]
pub fn execute<S: Scalar, const K: usize>(code: &Code, part: Part, registers: &mut [S]) {
    assert!(registers.len() >= room::<K>(code), "too few registers");
    let words = match part {
        Part::Preamble => &code.preamble,
        Part::Body => &code.body,
    };
    let scratch = code.registers * K;
    Runner::<S, K> {
        at: words.as_ptr(),
        constants: code.constants.as_ptr(),
        registers: registers.as_mut_ptr(),
        scratch,
    }
    .run();
}

/// What runs. Made by [`execute`] alone, from words that were checked (a [`Code`] is made of no others) and registers of which
/// there are enough: every index that a word says is there, and the last word is `END`.
struct Runner<S, const K: usize> {
    at: *const u16,
    constants: *const f64,
    registers: *mut S,
    /// Where the room for linear systems begins.
    scratch: usize,
}

impl<S: Scalar, const K: usize> Runner<S, K> {
    /// The word so many after that of the operation.
    #[inline(always)]
    fn word(&self, index: usize) -> usize {
        // SAFETY: operations are whole.
        usize::from(unsafe { *self.at.add(index) })
    }

    /// The constant that a word says.
    #[inline(always)]
    fn constant(&self, index: usize) -> f64 {
        // SAFETY: constants are there.
        unsafe { *self.constants.add(self.word(index)) }
    }

    /// A block of the register that a word says.
    #[inline(always)]
    fn get(&self, index: usize, block: usize) -> S {
        // SAFETY: registers are there, with all their blocks.
        unsafe { *self.registers.add(self.word(index) * K + block) }
    }

    /// Writes a block of the register that a word says.
    #[inline(always)]
    fn put(&mut self, index: usize, block: usize, value: S) {
        // SAFETY: as above, and they are ours alone while this runs.
        unsafe { *self.registers.add(self.word(index) * K + block) = value }
    }

    /// The room for linear systems.
    #[inline(always)]
    fn room(&mut self, elements: usize) -> &mut [S] {
        // SAFETY: the largest system of the code has its room after the registers.
        unsafe { core::slice::from_raw_parts_mut(self.registers.add(self.scratch), elements) }
    }

    #[inline(always)]
    fn run(mut self) {
        /// An operation of so many words that writes a value for every block.
        macro_rules! each {
            ($words:expr, $k:ident => $value:expr) => {{
                for $k in 0..K {
                    let value = $value;
                    self.put(1, $k, value);
                }
                $words
            }};
        }
        loop {
            let length = match self.word(0) as u16 {
                word::ADD => each!(4, k => self.get(2, k) + self.get(3, k)),
                word::SUBTRACT => each!(4, k => self.get(2, k) - self.get(3, k)),
                word::MULTIPLY => each!(4, k => self.get(2, k) * self.get(3, k)),
                word::SQUARE => each!(3, k => self.get(2, k) * self.get(2, k)),
                word::FUSED => each!(5, k => self.get(2, k).multiply_add(self.get(3, k), self.get(4, k))),
                word::SCALE => each!(4, k => S::splat(self.constant(2)) * self.get(3, k)),
                word::DIVIDE => each!(4, k => self.get(2, k) / self.get(3, k)),
                word::RECIPROCAL => each!(4, k => S::splat(self.constant(2)) / self.get(3, k)),
                word::LINEAR => self.linear(),
                word::SINE_COSINE => {
                    for k in 0..K {
                        let (sine, cosine) = functions::sin_cos(self.get(3, k));
                        self.put(1, k, sine);
                        self.put(2, k, cosine);
                    }
                    4
                }
                word::SOLVE => self.solved(),
                word::ANGLE => each!(4, k => self.get(2, k).angle(self.get(3, k))),
                word::POWER => each!(4, k => self.get(2, k).raised(self.constant(3))),
                word::CONSTANT => {
                    let value = S::splat(self.constant(2));
                    for k in 0..K {
                        self.put(1, k, value);
                    }
                    3
                }
                word::END => return,
                SQRT => each!(3, k => self.get(2, k).sqrt()),
                other => each!(3, k => self.get(2, k).called(other)),
            };
            // SAFETY: the last word is `END`, at which this returns.
            self.at = unsafe { self.at.add(length) };
        }
    }

    /// A sum; the words it takes.
    #[inline(always)]
    fn linear(&mut self) -> usize {
        let counts = [self.word(3), self.word(4), self.word(5), self.word(6)];
        let mut sum = [S::splat(self.constant(2)); K];
        let mut place = 7;
        for _ in 0..counts[0] {
            let factor = S::splat(self.constant(place));
            for k in 0..K {
                sum[k] = factor.multiply_add(self.get(place + 1, k), sum[k]);
            }
            place += 2;
        }
        for _ in 0..counts[1] {
            for k in 0..K {
                sum[k] = self.get(place, k).multiply_add(self.get(place + 1, k), sum[k]);
            }
            place += 2;
        }
        for _ in 0..counts[2] {
            for k in 0..K {
                sum[k] = self.get(place, k).multiply_subtract_from(self.get(place + 1, k), sum[k]);
            }
            place += 2;
        }
        for _ in 0..counts[3] {
            let factor = S::splat(self.constant(place));
            for k in 0..K {
                sum[k] = (factor * self.get(place + 1, k)).multiply_add(self.get(place + 2, k), sum[k]);
            }
            place += 3;
        }
        for k in 0..K {
            self.put(1, k, sum[k]);
        }
        place
    }

    /// The solution of a linear system; the words it takes.
    #[inline(always)]
    fn solved(&mut self) -> usize {
        let (unknowns, inner) = (self.word(1), self.word(2));
        let triangle = unknowns * (unknowns + 1) / 2;
        for k in 0..K {
            self.read_system(triangle + unknowns, k);
            let (matrix, rest) = self.room(triangle + 2 * unknowns).split_at_mut(triangle);
            let (right, row) = rest.split_at_mut(unknowns);
            let sound = linear::factor(matrix, row, inner);
            linear::solve(matrix, right);
            if !sound.all() {
                self.solved_with_pivots(unknowns, k, sound);
            }
            for i in 0..unknowns {
                let value = self.room(triangle + i + 1)[triangle + i];
                self.put(3 + triangle + unknowns + i, k, value);
            }
        }
        3 + triangle + 2 * unknowns
    }

    /// Puts the numbers of a linear system in the room for it.
    #[inline(always)]
    fn read_system(&mut self, numbers: usize, k: usize) {
        for i in 0..numbers {
            let value = self.get(3 + i, k);
            self.room(i + 1)[i] = value;
        }
    }

    /// Solves again where the matrix was none that needs no pivots.
    #[cold]
    fn solved_with_pivots(&mut self, unknowns: usize, k: usize, sound: S::Mask) {
        let triangle = unknowns * (unknowns + 1) / 2;
        let found = self.room(triangle + unknowns)[triangle..].to_vec();
        self.read_system(triangle + unknowns, k);
        let (matrix, right) = self.room(triangle + unknowns).split_at_mut(triangle);
        linear::invert(matrix, unknowns, sound);
        linear::solve_either(matrix, right, S::zero());
        for (right, found) in right.iter_mut().zip(found) {
            *right = S::select(sound, found, *right);
        }
    }
}

/// A function by its word.
#[inline(always)]
fn call<S: functions::Functions>(word: u16, x: S) -> S {
    const TAN: u16 = word::CALL + Function::Tan as u16;
    const EXP: u16 = word::CALL + Function::Exp as u16;
    const LN: u16 = word::CALL + Function::Ln as u16;
    const SINH: u16 = word::CALL + Function::Sinh as u16;
    const COSH: u16 = word::CALL + Function::Cosh as u16;
    const TANH: u16 = word::CALL + Function::Tanh as u16;
    const ASIN: u16 = word::CALL + Function::Asin as u16;
    const ACOS: u16 = word::CALL + Function::Acos as u16;
    const ATAN: u16 = word::CALL + Function::Atan as u16;
    const ASINH: u16 = word::CALL + Function::Asinh as u16;
    const ACOSH: u16 = word::CALL + Function::Acosh as u16;
    const ATANH: u16 = word::CALL + Function::Atanh as u16;
    const SECH_SQUARED: u16 = word::CALL + Function::SechSquared as u16;
    match word {
        TAN => functions::tan(x),
        EXP => x.exp(),
        LN => functions::ln(x),
        SINH => functions::sinh_cosh(x).0,
        COSH => functions::sinh_cosh(x).1,
        TANH => functions::tanh(x),
        ASIN => functions::asin(x),
        ACOS => functions::acos(x),
        ATAN => functions::atan(x),
        ASINH => functions::asinh(x),
        ACOSH => functions::acosh(x),
        ATANH => functions::atanh(x),
        SECH_SQUARED => functions::sech_squared(x),
        // Sine and cosine come in pairs.
        _ => S::splat(f64::NAN),
    }
}

#[inline(always)]
fn lanes_body<V: Vector8 + Scalar>(code: &Code, part: Part, registers: &mut [Lanes]) {
    execute::<V, 1>(code, part, V::view_mut(registers));
}

#[inline(always)]
#[expect(clippy::extra_unused_type_parameters, reason = "the tier gives its instructions, not its lanes")]
fn one_body<V: Vector8>(code: &Code, part: Part, registers: &mut [f64]) {
    execute::<f64, 1>(code, part, registers);
}

#[inline(always)]
fn blocks_body<V: Vector8 + Scalar, const K: usize>(code: &Code, part: Part, registers: &mut [Lanes]) {
    execute::<V, K>(code, part, V::view_mut(registers));
}

tiered! {
    fn called[][](word: u16, x: Lanes) -> Lanes = called_body;
    fn raised[][](exponent: f64, x: Lanes) -> Lanes = raised_body;
    fn angle[][](y: Lanes, x: Lanes) -> Lanes = angle_body;
    /// Runs a part of the code for eight states.
    pub fn lanes[][](code: &Code, part: Part, registers: &mut [Lanes]) = lanes_body;
    /// Runs a part of the code for `K` times eight states.
    pub fn blocks[const K: usize][K](code: &Code, part: Part, registers: &mut [Lanes]) = blocks_body;
    /// Runs a part of the code for one state, with the processor's fused operations.
    pub fn one[][](code: &Code, part: Part, registers: &mut [f64]) = one_body;
}
