//! The way of massive bodies as Taylor series about any time of their step, and what massless ones make of it.
//!
//! The one idea: a step of the massive bodies is a polynomial of time; shifted to the time of a massless body, its
//! coefficients are those of the places that pull.

use super::path::{Packed, one_time};
use super::{Guided, Term};
use crate::error::{Error, Result};
use crate::forces::following::{FewMassless, MassiveRows, MassiveSeries};
use crate::numerics::double_double::two_sum;
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Bits, Lanes, WIDTH, as_numbers};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;

/// Coefficients of the places of massive bodies in powers of the time since their step began.
#[derive(Debug, Default)]
pub(super) struct Coefficients {
    /// Blocks of as many numbers as a path has (packed, as they lie in rows), from order 0 on.
    blocks: Vec<Lanes>,
    /// What those of order 0 leave out.
    rests: Vec<Lanes>,
    /// The unit of time.
    unit: Lanes,
    packed: Option<Packed>,
}

impl Coefficients {
    /// Takes up those of a step of massive bodies.
    pub(super) fn take_up(&mut self, jet: &Jet<Lanes>, packed: Option<Packed>) {
        (self.unit, self.packed) = (jet.unit, packed);
        self.blocks.clear();
        self.blocks.extend_from_slice(&jet.q[..(jet.order + 2) * jet.len]);
        self.rests.clear();
        self.rests.extend_from_slice(&jet.rests[0]);
    }
}

/// Room for coefficients about the time of a massless body.
#[derive(Default)]
pub(super) struct Shifted {
    blocks: Vec<Lanes>,
    rests: Vec<Lanes>,
    /// Rows of packed bodies.
    rows: Vec<Lanes>,
    rests_of_rows: Vec<Lanes>,
    a: Vec<Lanes>,
}

/// Shifts coefficients to the time `t`, and to another unit of time.
struct Shift<'a> {
    from: &'a Coefficients,
    t: &'a Lanes,
    unit: &'a Lanes,
    /// How many numbers a block is to have.
    numbers: usize,
    into: &'a mut Shifted,
}

impl Shift<'_> {
    /// For massless bodies in these lanes.
    fn in_lanes(self, lanes: Bits) {
        let Self { from, t, numbers, .. } = self;
        let len = from.rests.len();
        let orders = from.blocks.len() / len;
        self.into.blocks.resize(orders * numbers, Lanes::zero());
        self.into.rests.resize(numbers, Lanes::zero());
        match (from.packed.filter(|packed| packed.are_several()), one_time(t, lanes)) {
            (Some(packed), Some(time)) => {
                self.into.rows.clone_from(&from.blocks);
                self.into.rests_of_rows.resize(len, Lanes::zero());
                Lanes::pass(ShiftOnce { packed, t: &Lanes::splat(time), shift: self });
            }
            _ => Lanes::pass(self),
        }
    }
}

impl Pass<Lanes> for Shift<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let Self { from, t, numbers, .. } = self;
        let unit = V::load(from.unit);
        let (x, ratio) = (V::load(*t) / unit, V::load(*self.unit) / unit);
        let (blocks, into) = (V::view_mut(&mut self.into.blocks), V::view_mut(&mut self.into.rests));
        if let Some(packed) = from.packed {
            let len = from.rests.len() * WIDTH;
            let rows = as_numbers(&from.blocks).chunks_exact(len);
            for (into, block) in blocks.chunks_exact_mut(numbers).zip(rows) {
                to_all_lanes(packed, block, into, V::one());
            }
            // What is left out is added at last: it begins as it is.
            to_all_lanes(packed, as_numbers(&from.rests), into, V::one());
        } else {
            blocks.copy_from_slice(V::view(&from.blocks));
            into.copy_from_slice(V::view(&from.rests));
        }
        divide(blocks, into, x);
        let mut power = V::one();
        for block in blocks.chunks_exact_mut(numbers) {
            for coefficient in block {
                *coefficient = *coefficient * power;
            }
            power = power * ratio;
        }
    }
}

/// Of packed bodies to one time: as they lie, before each goes to all lanes.
struct ShiftOnce<'a> {
    packed: Packed,
    t: &'a Lanes,
    shift: Shift<'a>,
}

impl Pass<Lanes> for ShiftOnce<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let Self { packed, t, shift: Shift { from, unit, numbers, into, .. } } = self;
        let of_path = V::load(from.unit);
        let (x, ratio) = (V::load(*t) / of_path, V::load(*unit) / of_path);
        into.rests_of_rows.copy_from_slice(&from.rests);
        divide(V::view_mut(&mut into.rows), V::view_mut(&mut into.rests_of_rows), x);
        let rows = as_numbers(&into.rows).chunks_exact(from.rests.len() * WIDTH);
        let mut power = V::one();
        for (into, block) in V::view_mut(&mut into.blocks).chunks_exact_mut(numbers).zip(rows) {
            to_all_lanes(packed, block, into, power);
            power = power * ratio;
        }
        to_all_lanes(packed, as_numbers(&into.rests_of_rows), V::view_mut(&mut into.rests), V::one());
    }
}

/// Packed numbers of a block, each in all lanes, times a factor.
#[inline(always)]
fn to_all_lanes<V: Real>(Packed { bodies, rows }: Packed, block: &[f64], into: &mut [V], factor: V) {
    for (into, component) in into.chunks_exact_mut(bodies).zip(block.chunks_exact(rows * WIDTH)) {
        for (into, &number) in into.iter_mut().zip(component) {
            *into = V::splat(number) * factor;
        }
    }
}

/// Shifts rows of packed bodies to the times of a few massless ones, for each of them.
struct ShiftEach<'a> {
    from: &'a Coefficients,
    lanes: &'a [usize],
    t: &'a Lanes,
    unit: &'a Lanes,
    into: &'a mut Shifted,
}

impl Pass<Lanes> for ShiftEach<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let Self { from, lanes, t, unit, into } = self;
        let (of_path, len) = (V::load(from.unit), from.rests.len());
        let all = V::view_mut(&mut into.rows).chunks_exact_mut(from.blocks.len());
        let rests = V::view_mut(&mut into.rests_of_rows).chunks_exact_mut(len);
        for ((&lane, blocks), rests) in lanes.iter().zip(all).zip(rests) {
            blocks.copy_from_slice(V::view(&from.blocks));
            rests.copy_from_slice(V::view(&from.rests));
            divide(blocks, rests, V::splat(t.0[lane]) / of_path);
            let ratio = V::splat(unit.0[lane]) / of_path;
            let mut power = V::one();
            for block in blocks.chunks_exact_mut(len) {
                for coefficient in block {
                    *coefficient = *coefficient * power;
                }
                power = power * ratio;
            }
        }
    }
}

/// Shifts the coefficients of so many numbers as leave something out by a time `x`.
#[inline(always)]
fn divide<V: Real>(blocks: &mut [V], rests: &mut [V], x: V) {
    let numbers = rests.len();
    let highest = blocks.len() / numbers - 1;
    let mut division = Division { blocks, numbers, highest, x, rests };
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
    /// What those of order 0 leave out.
    rests: &'a mut [V],
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
                        (block[g], self.rests[start + g]) = (place, rest + self.rests[start + g]);
                    } else {
                        found[k][g] = found[k][g].multiply_add(x, block[g]);
                        block[g] = found[k][g];
                    }
                }
            }
        }
    }
}

/// Whether massive bodies in lanes, for one massless body after another, are quicker than massless ones in lanes for one massive
/// body after another.
fn is_quicker(massless: usize, packed: Packed) -> bool {
    let Packed { bodies, rows } = packed;
    packed.are_several() && (1..=FewMassless::MOST).contains(&massless) && 2 * massless * rows <= bodies + 1
}

impl Guided {
    /// As [`System::expand`](crate::ode::system::System::expand).
    pub(super) fn expand_series(&mut self, jet: &mut Jet<Lanes>, ticker: &mut Ticker<'_>) -> Result<()> {
        let Some(coefficients) = &self.path.coefficients else {
            return Err(Error::Internal("a path without its series".to_owned()));
        };
        if let ([Term::Following(only)], Some(packed)) = (&mut self.terms[..], coefficients.packed)
            && let Some(few) = only.few()
        {
            let mut lanes = [0; WIDTH];
            let mut massless = 0;
            for lane in (0..WIDTH).filter(|&lane| self.running.lane(lane)) {
                lanes[massless] = lane;
                massless += 1;
            }
            if is_quicker(massless, packed) {
                let (lanes, into) = (&lanes[..massless], &mut self.shifted);
                into.rows.resize(massless * coefficients.blocks.len(), Lanes::zero());
                into.rests_of_rows.resize(massless * coefficients.rests.len(), Lanes::zero());
                Lanes::pass(ShiftEach { from: coefficients, lanes, t: &jet.t, unit: &jet.unit, into });
                let (places, rests) = (&self.shifted.rows[..], &self.shifted.rests_of_rows[..]);
                few.expand(MassiveRows { lanes, rows: packed.rows, places, rests }, jet);
                return Ok(());
            }
        }
        self.shifted.a.clear();
        self.shifted.a.resize(jet.len, Lanes::zero());
        let (t, unit, numbers) = (&jet.t, &jet.unit, self.path.numbers);
        Shift { from: coefficients, t, unit, numbers, into: &mut self.shifted }.in_lanes(self.running);
        // Forces of time count it from the start of the run.
        let Shifted { blocks, rests, a, .. } = &mut self.shifted;
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
