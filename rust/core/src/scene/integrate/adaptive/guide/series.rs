//! The way of massive bodies as Taylor series about any time of their step, and what massless ones make of it.
//!
//! The one idea: a step of the massive bodies is a polynomial of time; shifted to the time of a massless body, its
//! coefficients are those of the places that pull.

use super::super::super::super::unit::Prepared;
use super::{Guided, Term, apart};
use crate::error::{Error, Result};
use crate::forces::following::MassiveSeries;
use crate::numerics::double_double::two_sum;
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;

/// Coefficients of the places of massive bodies in powers of the time since their step began.
#[derive(Debug, Default)]
pub(super) struct Coefficients {
    /// Blocks of as many numbers as a path has, from order 0 on.
    blocks: Vec<Lanes>,
    /// What those of order 0 leave out.
    rests: Vec<Lanes>,
    /// The unit of time.
    unit: Lanes,
}

impl Coefficients {
    /// Takes up those of a step of massive bodies; packed, each of them goes to all lanes.
    pub(super) fn take_up(&mut self, unit: &Prepared, jet: &Jet<Lanes>, packed: bool) {
        let (blocks, rests) = (&jet.q[..(jet.order + 2) * jet.len], &jet.rests[0]);
        self.unit = jet.unit;
        if packed {
            apart(unit, blocks, jet.len, &mut self.blocks);
            apart(unit, rests, jet.len, &mut self.rests);
        } else {
            self.blocks.clear();
            self.blocks.extend_from_slice(blocks);
            self.rests.clear();
            self.rests.extend_from_slice(rests);
        }
    }
}

/// Room for coefficients about the time of a massless body.
#[derive(Default)]
pub(super) struct Shifted {
    blocks: Vec<Lanes>,
    rests: Vec<Lanes>,
    a: Vec<Lanes>,
}

/// Shifts coefficients to the time `t`, and to another unit of time.
struct Shift<'a> {
    from: &'a Coefficients,
    t: &'a Lanes,
    unit: &'a Lanes,
    into: &'a mut Shifted,
}

impl Pass<Lanes> for Shift<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let (rests, unit) = (V::view(&self.from.rests), V::load(self.from.unit));
        let numbers = rests.len();
        let (x, ratio) = (V::load(*self.t) / unit, V::load(*self.unit) / unit);
        let (blocks, into) = (V::view_mut(&mut self.into.blocks), V::view_mut(&mut self.into.rests));
        let highest = blocks.len() / numbers - 1;
        let mut division = Division { blocks: &mut *blocks, numbers, highest, x, rests, into };
        // One by itself would wait for its products.
        let mut start = 0;
        while numbers - start >= 3 && numbers - start != 4 {
            division.all::<3>(start);
            start += 3;
        }
        while numbers - start >= 2 {
            division.all::<2>(start);
            start += 2;
        }
        if numbers > start {
            division.all::<1>(start);
        }
        let mut power = V::one();
        for block in blocks.chunks_exact_mut(numbers) {
            for coefficient in block {
                *coefficient = *coefficient * power;
            }
            power = power * ratio;
        }
    }
}

/// Passes of a division that go through the coefficients together, each an order behind the one before: alone, each would wait
/// for its last product.
const PASSES: usize = 4;

/// Repeated synthetic division by a time.
struct Division<'a, V> {
    blocks: &'a mut [V],
    numbers: usize,
    highest: usize,
    x: V,
    /// What those of order 0 leave out, before and after.
    rests: &'a [V],
    into: &'a mut [V],
}

impl<V: Real> Division<'_, V> {
    /// Of `G` numbers from `start` on.
    #[inline(always)]
    fn all<const G: usize>(&mut self, start: usize) {
        let mut order = 0;
        while self.highest - order >= PASSES {
            self.passes::<PASSES, G>(order, start);
            order += PASSES;
        }
        while self.highest > order {
            self.passes::<1, G>(order, start);
            order += 1;
        }
    }

    #[inline(always)]
    fn passes<const K: usize, const G: usize>(&mut self, order: usize, start: usize) {
        let Self { numbers, highest, x, .. } = *self;
        let mut found = [[V::zero(); G]; K];
        for pass in &mut found {
            pass.copy_from_slice(&self.blocks[highest * numbers + start..][..G]);
        }
        for power in (order + K..highest).rev() {
            let block = &mut self.blocks[power * numbers + start..][..G];
            for k in 0..K {
                for g in 0..G {
                    found[k][g] = found[k][g].multiply_add(x, block[g]);
                    block[g] = found[k][g];
                }
            }
        }
        for last in (0..K).rev() {
            let block = &mut self.blocks[(order + last) * numbers + start..][..G];
            for k in 0..=last {
                for g in 0..G {
                    if order + last == 0 {
                        let (place, rest) = two_sum(block[g], found[k][g] * x);
                        (block[g], self.into[start + g]) = (place, rest + self.rests[start + g]);
                    } else {
                        found[k][g] = found[k][g].multiply_add(x, block[g]);
                        block[g] = found[k][g];
                    }
                }
            }
        }
    }
}

impl Guided {
    /// As [`System::expand`](crate::ode::system::System::expand).
    pub(super) fn expand_series(&mut self, jet: &mut Jet<Lanes>, ticker: &mut Ticker<'_>) -> Result<()> {
        let Some(coefficients) = &self.path.coefficients else {
            return Err(Error::Internal("a path without its series".to_owned()));
        };
        let Shifted { blocks, rests, a } = &mut self.shifted;
        blocks.clone_from(&coefficients.blocks);
        rests.clone_from(&coefficients.rests);
        a.clear();
        a.resize(jet.len, Lanes::zero());
        Lanes::pass(Shift { from: coefficients, t: &jet.t, unit: &jet.unit, into: &mut self.shifted });
        // Forces of time count it from the start of the run.
        let Shifted { blocks, rests, a } = &mut self.shifted;
        let since = jet.t;
        jet.t = self.base + since;
        if let [Term::Following(only)] = &mut self.terms[..] {
            only.expand(MassiveSeries { places: blocks, rests }, jet, a)?;
            jet.t = since;
            return Ok(());
        }
        for n in 0..jet.order {
            for (index, term) in self.terms.iter_mut().enumerate() {
                match term {
                    Term::Following(force) => {
                        let massive = MassiveSeries { places: blocks, rests };
                        force.coefficient(massive, (n, jet), a, index == 0)?;
                    }
                    Term::Other(_, Some(series)) => series.coefficient(n, jet, a, index == 0, ticker)?,
                    Term::Other(_, None) => {
                        return Err(Error::Internal("a force without its series".to_owned()));
                    }
                }
            }
            jet.raise(n, a);
        }
        jet.t = since;
        Ok(())
    }
}
