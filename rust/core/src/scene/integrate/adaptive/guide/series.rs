//! The way of massive bodies as Taylor series about any time of their step, and what massless ones make of it.
//!
//! The one idea: a step of the massive bodies is a polynomial of time; shifted to the time of a massless body, its
//! coefficients are those of the places that pull.

use super::super::super::super::unit::Prepared;
use super::{Guided, Path, Term};
use crate::error::{Error, Result};
use crate::forces::following::MassiveSeries;
use crate::numerics::double_double::two_sum;
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;

/// Coefficients of the places of massive bodies in powers of the time since their step began.
#[derive(Clone, Debug)]
pub(super) struct Coefficients {
    /// Blocks of as many numbers as a path has, from order 0 on.
    blocks: Vec<Lanes>,
    /// What those of order 0 leave out.
    rests: Vec<Lanes>,
    /// The unit of time.
    unit: Lanes,
}

impl Coefficients {
    /// Of a step of massive bodies; packed, each of them goes to all lanes.
    pub(super) fn new(unit: &Prepared, jet: &Jet<Lanes>, packed: bool) -> Self {
        let blocks = jet.q[..(jet.order + 2) * jet.len].to_vec();
        let rests = jet.rests[0].clone();
        if packed {
            let apart = |blocks: &[Lanes]| Path::apart(unit, blocks, jet.len);
            return Self { blocks: apart(&blocks), rests: apart(&rests), unit: jet.unit };
        }
        Self { blocks, rests, unit: jet.unit }
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
        // Repeated synthetic division.
        for order in 0..highest {
            for power in (order + 1..highest).rev() {
                let (lower, higher) = blocks[power * numbers..].split_at_mut(numbers);
                let higher = &higher[..numbers];
                for number in 0..numbers {
                    lower[number] = higher[number].multiply_add(x, lower[number]);
                }
            }
            let (lower, higher) = blocks[order * numbers..].split_at_mut(numbers);
            for number in 0..numbers {
                if order == 0 {
                    let (place, rest) = two_sum(lower[number], higher[number] * x);
                    (lower[number], into[number]) = (place, rest + rests[number]);
                } else {
                    lower[number] = higher[number].multiply_add(x, lower[number]);
                }
            }
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
