//! A step of a system of the first order in one kernel: every stage, the end, and what its error is.
//!
//! The one idea: a stage of a few numbers costs less than the way into a kernel, so the kernel is entered once a step and
//! asks the system from within; how many numbers there are is known when compiled if they are few.

use super::errors::{MeanErrors, PairTerm};
use super::stages::{CompensatedRates, Rates, Term, Weighted};
use super::updates::add_compensated;
use crate::error::Result;
use crate::numerics::element::{Element, Pair, PairMut, Pass, View};
use crate::ode::nystrom::Row;
use crate::ode::system::System;
use crate::parallel::Ticker;

/// `k[i] = f(t + c h, y + h Σ a·k)` from the second stage on, the end of the step, and the mean of its squared scaled errors
/// (0 unless they are asked for).
pub struct RateStep<'a, 'b, S> {
    /// The stages of the method, and the end of the step.
    pub rows: (&'a [Row<S>], &'a Row<S>),
    /// The time before the step, and whether the system looks at it.
    pub time: (S, bool),
    /// The step.
    pub h: &'a S,
    /// The state before it.
    pub y: Pair<'a, S>,
    /// The derivatives, of which the first is there.
    pub k: &'a mut [S],
    /// Room for a state.
    pub position: &'a mut [S],
    /// The state after it.
    pub next: PairMut<'a, S>,
    /// How its error is measured.
    pub errors: Option<RateErrors<'a, S>>,
    /// What is asked.
    pub system: &'a mut dyn System<S>,
    /// What it may tick.
    pub ticker: &'a mut Ticker<'b>,
}

/// As many numbers have steps of their own ([`few`]).
pub(crate) const FEW: usize = 8;

/// How the error of a step is measured.
#[derive(Clone, Copy, Debug)]
pub struct RateErrors<'a, S> {
    /// The weights of both estimates.
    pub terms: &'a [PairTerm<S>],
    /// Whether they weigh the derivative at the end of the step.
    pub end: bool,
    /// Absolute tolerance of each number.
    pub atol: &'a [S],
    /// Relative tolerance of each.
    pub rtol: &'a [S],
}

impl<S: Element> Pass<S> for RateStep<'_, '_, S> {
    type Output = Result<[S; 2]>;
    #[inline(always)]
    fn run<V: View<S>>(self) -> Result<[S; 2]> {
        // Eight numbers in lanes are work enough without.
        match self.position.len() {
            1 if size_of::<S>() == size_of::<f64>() => few::<S, V, 1>(self),
            2 if size_of::<S>() == size_of::<f64>() => few::<S, V, 2>(self),
            3 if size_of::<S>() == size_of::<f64>() => few::<S, V, 3>(self),
            4 if size_of::<S>() == size_of::<f64>() => few::<S, V, 4>(self),
            5 if size_of::<S>() == size_of::<f64>() => few::<S, V, 5>(self),
            6 if size_of::<S>() == size_of::<f64>() => few::<S, V, 6>(self),
            7 if size_of::<S>() == size_of::<f64>() => few::<S, V, 7>(self),
            8 if size_of::<S>() == size_of::<f64>() => few::<S, V, 8>(self),
            _ => many::<S, V>(self),
        }
    }
}

/// A step of any number of numbers.
#[inline(always)]
fn many<S: Element, V: View<S>>(pass: RateStep<'_, '_, S>) -> Result<[S; 2]> {
    let n = pass.position.len();
    let RateStep { rows: (rows, end), time: (from, timed), h, y: (y, e), k, system, ticker, .. } = pass;
    let (y, position) = ((&y[..n], &e[..n]), &mut pass.position[..n]);
    for (stage, row) in rows.iter().enumerate().skip(1) {
        let (before, rest) = k.split_at_mut(stage * n);
        let stages = Weighted { h, terms: &row.velocity, k: before };
        Rates { out: &mut *position, y, stages }.run::<V>();
        let t = if timed { from + *h * row.fraction } else { from };
        system.rate(&t, position, &mut rest[..n], ticker)?;
    }
    let (next, left_out) = (&mut pass.next.0[..n], &mut pass.next.1[..n]);
    let stages = Weighted { h, terms: &end.velocity, k: &*k };
    CompensatedRates { out: (&mut *next, left_out), y, stages }.run::<V>();
    let Some(RateErrors { terms, end, atol, rtol }) = pass.errors else {
        return Ok([S::zero(); 2]);
    };
    if end {
        system.rate(&(from + *h), next, &mut k[rows.len() * n..][..n], ticker)?;
    }
    Ok(MeanErrors { y: y.0, next, atol, rtol, h, terms, k, stride: n }.run::<V>())
}

/// A step of `N` numbers, the same operations as of many.
#[inline(always)]
fn few<S: Element, V: View<S>, const N: usize>(pass: RateStep<'_, '_, S>) -> Result<[S; 2]> {
    let RateStep { rows: (rows, end), time: (from, timed), h, y, k, system, ticker, .. } = pass;
    let (y, e) = V::pair((&y.0[..N], &y.1[..N]));
    let (k, step) = (k.as_chunks_mut::<N>().0, V::load(*h));
    let mut position = [S::zero(); N];
    for (stage, row) in rows.iter().enumerate().skip(1) {
        let sums = weighted::<S, V, N>(&row.velocity, k);
        for i in 0..N {
            alone(&mut position[i], (y[i] + step.multiply_add(sums[i], e[i])).store());
        }
        let t = if timed { from + *h * row.fraction } else { from };
        system.rate(&t, &position, &mut k[stage], ticker)?;
    }
    let sums = weighted::<S, V, N>(&end.velocity, k);
    let (next, left_out) = (&mut pass.next.0[..N], &mut pass.next.1[..N]);
    let (next_view, left_out) = V::pair_mut((&mut *next, left_out));
    for i in 0..N {
        (next_view[i], left_out[i]) = add_compensated(y[i], e[i], step * sums[i]);
    }
    let Some(RateErrors { terms, end, atol, rtol }) = pass.errors else {
        return Ok([S::zero(); 2]);
    };
    if end {
        system.rate(&(from + *h), next, &mut k[rows.len()], ticker)?;
    }
    let (y, k) = (&pass.y.0[..N], k.as_flattened());
    Ok(MeanErrors { y, next, atol, rtol, h, terms, k, stride: N }.run::<V>())
}

/// `Σ weight·k[stage]` of `N` numbers, in the order of the terms.
#[inline(always)]
fn weighted<S: Element, V: View<S>, const N: usize>(terms: &[Term<S>], k: &[[S; N]]) -> [V; N] {
    let mut sums = [V::zero(); N];
    let Some((last, terms)) = terms.split_last() else { return sums };
    for &Term { stage, weight } in terms {
        let (weight, column) = (V::load(weight), V::view(&k[stage]));
        for i in 0..N {
            sums[i] = weight.multiply_add(column[i], sums[i]);
        }
    }
    let (weight, column) = (V::load(last.weight), &k[last.stage]);
    for i in 0..N {
        sums[i] = weight.multiply_add(V::load(fresh(&column[i])), sums[i]);
    }
    sums
}

/// Writes a number by itself: together with others it would wait for the last of them, though what is asked next may begin
/// with it.
#[inline(always)]
fn alone<S: Copy>(place: &mut S, value: S) {
    // SAFETY: what is borrowed to be changed can be written.
    unsafe { core::ptr::from_mut(place).write_volatile(value) }
}

/// A number that was written a moment ago. A processor that reads several such numbers at once, each of which was written by
/// itself, waits until all of them have reached the cache; so this one is read by itself too.
#[inline(always)]
pub(crate) fn fresh<S: Copy>(value: &S) -> S {
    // SAFETY: what is borrowed can be read.
    unsafe { core::ptr::from_ref(value).read_volatile() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ode::Scheme;
    use crate::ode::runge_kutta::Stages;
    use crate::ode::state::State;
    use crate::ode::system::Form;
    use crate::parallel::Control;
    use crate::registry::METHODS;

    /// Numbers that do not know each other: `y' = t - y²`.
    struct Alone(usize);
    impl System<f64> for Alone {
        fn form(&self) -> Form {
            Form::FirstOrder(self.0)
        }
        fn evaluations(&self) -> u64 {
            0
        }
        fn rate(&mut self, t: &f64, y: &[f64], rate: &mut [f64], _: &mut Ticker<'_>) -> Result<()> {
            assert_eq!((y.len(), rate.len()), (self.0, self.0));
            rate.iter_mut().zip(y).for_each(|(rate, y)| *rate = t - y * y);
            Ok(())
        }
    }

    #[test]
    fn a_number_among_others_takes_the_step_that_it_takes_alone() -> Result<()> {
        let control = Control::default();
        for method in METHODS {
            let Scheme::Embedded(table) = &method.scheme else { continue };
            let errors: Vec<_> = (0..table.error.len())
                .map(|stage| PairTerm { stage, weights: [table.error[stage].to_f64(), 1.0] })
                .collect();
            let step = |y: &[f64]| {
                let mut system = Alone(y.len());
                let mut stages = Stages::new(&table.tableau, 1, &system);
                let (state, mut next) = (State::first_order(y.to_vec()), State::first_order(y.to_vec()));
                let tolerance = vec![1e-6; y.len()];
                let errors = RateErrors { terms: &errors, end: true, atol: &tolerance, rtol: &tolerance };
                let ticker = &mut Ticker::quiet(&control);
                stages.evaluate(0, &0.5, &state, &mut system, ticker)?;
                let states = (&state, &mut next);
                let sizes =
                    f64::pass(stages.rate_pass((&0.5, &0.125), states, Some(errors), &mut system, ticker))?;
                Ok((next, sizes))
            };
            let numbers: Vec<f64> = (0..9).map(|i| f64::from(i) / 8.0 - 0.3).collect();
            let alone = numbers.iter().map(|&y| step(&[y])).collect::<Result<Vec<_>>>()?;
            for n in 1..=numbers.len() {
                let (next, sizes) = step(&numbers[..n])?;
                for (i, (one, _)) in alone[..n].iter().enumerate() {
                    let (y, left_out) = next.all();
                    assert_eq!((&y[i..=i], &left_out[i..=i]), one.all(), "{} of {n}: {}", i, method.name);
                }
                for estimate in 0..2 {
                    let mean = alone[..n].iter().map(|(_, sizes)| sizes[estimate]).sum::<f64>() / n as f64;
                    assert!((sizes[estimate] / mean - 1.0).abs() < 1e-15 * n as f64, "{n}: {}", method.name);
                }
            }
        }
        Ok(())
    }
}
