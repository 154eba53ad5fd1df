//! What acts beside a force between bodies, and is linear in the place and the velocity of each.
//!
//! The one idea: of such forces but for a constant the coefficients of an order are rates times those of places and velocities,
//! so whoever finds all coefficients of a motion adds them on the way, as long as they are in registers.

use super::Series;
use crate::error::Result;
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::parallel::Ticker;

/// What acts besides.
#[derive(Default)]
pub(in crate::forces) struct Beside {
    forces: Vec<Box<dyn Series<Lanes>>>,
    /// Of order 0.
    first: Vec<Lanes>,
    /// None before they were asked for.
    rates: Option<Vec<Rate>>,
}

/// The acceleration along an axis by one of the places, or velocities, along an axis: of each row, and the same in the unit of
/// time.
struct Rate {
    axis: usize,
    of: usize,
    velocity: bool,
    rows: Vec<Lanes>,
    scaled: Vec<Lanes>,
}

/// Brings rates to the unit of time.
struct InUnits<'a>(&'a mut [Rate], &'a Lanes);

impl Pass<Lanes> for InUnits<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let unit = V::load(*self.1);
        for Rate { velocity, rows, scaled, .. } in self.0 {
            let factor = if *velocity { unit } else { unit * unit };
            for (scaled, row) in V::view_mut(scaled).iter_mut().zip(V::view(rows)) {
                *scaled = *row * factor;
            }
        }
    }
}

impl Beside {
    /// Of forces that are [linear](Series::is_linear).
    pub(in crate::forces) fn new(forces: Vec<Box<dyn Series<Lanes>>>) -> Self {
        Self { forces, ..Self::default() }
    }

    /// Adds the coefficient of an order as the forces tell it.
    ///
    /// # Errors
    /// As [`Series::coefficient`].
    pub(in crate::forces) fn coefficient(
        &mut self,
        n: usize,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        self.forces.iter_mut().try_for_each(|force| force.coefficient(n, jet, a, false, ticker))
    }

    /// Asks the forces, at the start of a series; `a` is room for a coefficient.
    ///
    /// # Errors
    /// As [`Series::coefficient`].
    pub(in crate::forces) fn look(
        &mut self,
        jet: &Jet<Lanes>,
        a: &mut [Lanes],
        rows: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<()> {
        let Self { forces, first, rates } = self;
        if forces.is_empty() {
            return Ok(());
        }
        for (index, force) in forces.iter_mut().enumerate() {
            force.coefficient(0, jet, a, index == 0, ticker)?;
        }
        first.clear();
        first.extend_from_slice(a);
        if rates.is_none() {
            *rates = Some(of_all(forces, a, rows, ticker)?);
        }
        Lanes::pass(InUnits(rates.as_deref_mut().unwrap_or_default(), &jet.unit));
        Ok(())
    }

    /// Adds the coefficient of an order, from those of places and velocities.
    #[inline(always)]
    pub(in crate::forces) fn add<V: View<Lanes>>(&self, n: usize, coefficients: [&[V]; 2], a: &mut [V]) {
        if n == 0 {
            for (a, first) in a.iter_mut().zip(V::view(&self.first)) {
                *a += *first;
            }
            return;
        }
        for Rate { axis, of, velocity, scaled, .. } in self.rates.iter().flatten() {
            let rows = scaled.len();
            let from = &coefficients[usize::from(*velocity)][of * rows..][..rows];
            let into = &mut a[axis * rows..][..rows];
            for ((a, from), rate) in into.iter_mut().zip(from).zip(V::view(scaled)) {
                *a = rate.multiply_add(*from, *a);
            }
        }
    }
}

/// The rates of all forces together that are not zero.
fn of_all(
    forces: &mut [Box<dyn Series<Lanes>>],
    a: &mut [Lanes],
    rows: usize,
    ticker: &mut Ticker<'_>,
) -> Result<Vec<Rate>> {
    let mut rates = Vec::new();
    for (of, velocity) in (0..a.len() / rows).flat_map(|of| [(of, false), (of, true)]) {
        let mut sum = vec![Lanes::zero(); a.len()];
        for force in &mut *forces {
            force.column(of, velocity, a, (rows, &mut *ticker))?;
            sum.iter_mut().zip(&*a).for_each(|(sum, part)| *sum += *part);
        }
        for (axis, own) in sum.chunks(rows).enumerate() {
            if own.iter().any(|rate| rate.0 != [0.0; WIDTH]) {
                rates.push(Rate { axis, of, velocity, rows: own.to_vec(), scaled: own.to_vec() });
            }
        }
    }
    Ok(rates)
}
