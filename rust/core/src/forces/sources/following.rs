//! Sources that a massless body in each lane moves by, without a reaction.
//!
//! Canonical order: as for other bodies, one source after another as they are listed.

use super::series::recurrences;
use super::{Law, NUMBERS, OfSource, Relative, Told, WrittenLaw, difference, vector};
use crate::error::{Error, Result};
use crate::expressions::series::Expansion;
use crate::forces::ForceTerm;
use crate::forces::following::{Following, Leaders, Massive, MassiveSeries};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::{Bits, Lanes};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::units::Units;
use core::any::Any;

/// A source among the massive bodies.
struct Leader {
    /// Its place in the list, and among the massive bodies.
    index: usize,
    slot: usize,
    /// The coefficients of what it does, of a method that asks for them.
    pair: Option<Expansion<Lanes>>,
    /// What it is in each lane.
    of: Told,
}

/// The sources that massless bodies follow.
struct Leading<L> {
    law: L,
    leaders: Vec<Leader>,
}

/// Of the massive bodies those that are listed.
pub(in crate::forces) fn following<L: WrittenLaw>(
    law: L,
    listed: &[usize],
    massive: &Leaders<'_>,
) -> Box<dyn Following> {
    let slots = listed.iter().enumerate().filter_map(|(index, body)| {
        massive.bodies.iter().position(|other| other == body).map(|slot| (index, slot))
    });
    let nothing = [Lanes::zero(); 1 + NUMBERS];
    let leader = |(index, slot)| Leader {
        index,
        slot,
        of: nothing,
        pair: if massive.expands {
            recurrences(&law, index).map(|series| Expansion::new(series, &nothing))
        } else {
            None
        },
    };
    let leaders: Vec<Leader> = slots.map(leader).collect();
    Box::new(Leading { leaders, law })
}

impl<L: WrittenLaw> Following for Leading<L> {
    fn lead(&mut self, own: &dyn ForceTerm, units: Units, mass: &[f64], lanes: Bits) {
        let Some(own) = (own as &dyn Any).downcast_ref::<L::Term>() else { return };
        let constant = L::constant(own, units);
        for Leader { index, slot, pair, of } in &mut self.leaders {
            let strength = constant * mass[*slot];
            let own = [strength].into_iter().chain(L::numbers(own, *index, strength, units));
            for (before, number) in of.iter_mut().zip(own) {
                *before = Lanes::select(lanes, Lanes::splat(number), *before);
            }
            if let Some(pair) = pair {
                pair.set_parameters(of);
            }
        }
    }

    fn needs_velocity(&self) -> bool {
        L::VELOCITY
    }

    fn apply(&mut self, massive: Massive<'_>, (q, v): (&[Lanes], &[Lanes]), a: &mut [Lanes], first: bool) {
        Lanes::pass(Pull { of: self, massive, q, v, a, first });
    }

    fn coefficient(
        &mut self,
        massive: MassiveSeries<'_>,
        (n, jet): (usize, &Jet<Lanes>),
        a: &mut [Lanes],
        first: bool,
    ) -> Result<()> {
        if first {
            a.fill(Lanes::zero());
        }
        if self.leaders.iter().any(|leader| leader.pair.is_none()) {
            return Err(Error::Internal("sources without their series".to_owned()));
        }
        Lanes::pass(Coefficient { leaders: &mut self.leaders, massive, n, jet, a });
        Ok(())
    }
}

struct Coefficient<'a> {
    leaders: &'a mut [Leader],
    massive: MassiveSeries<'a>,
    n: usize,
    jet: &'a Jet<Lanes>,
    a: &'a mut [Lanes],
}

impl Pass<Lanes> for Coefficient<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let Self { leaders, massive, n, jet, a } = self;
        let (places, rests) = (V::view(massive.places), V::view(massive.rests));
        let (q, v, of_q) = (V::view(jet.position(n)), V::view(jet.velocity(n)), V::view(&jet.rests[0]));
        let (numbers, components, a) = (rests.len(), jet.len, V::view_mut(a));
        let bodies = numbers / components;
        let (unit, per_unit) = (V::load(jet.unit), V::load(jet.per_unit));
        let order = V::splat((n + 1) as f64);
        for leader in leaders {
            let Some(pair) = &mut leader.pair else { continue };
            for c in 0..3 {
                let (mut d, mut velocity) = (V::zero(), V::zero());
                if c < components {
                    let at = c * bodies + leader.slot;
                    d = q[c] - places[n * numbers + at];
                    if n == 0 {
                        d += of_q[c] - rests[at];
                    }
                    velocity = (v[c] - order * places[(n + 1) * numbers + at]) * per_unit;
                }
                pair.set(c, n, d.store());
                pair.set(3 + c, n, velocity.store());
            }
            pair.expand(n);
            for c in 0..components {
                a[c] += V::load(pair.output(c, n)) * (unit * unit);
            }
        }
    }
}

struct Pull<'a, L> {
    of: &'a Leading<L>,
    massive: Massive<'a>,
    q: &'a [Lanes],
    v: &'a [Lanes],
    a: &'a mut [Lanes],
    first: bool,
}

impl<L: Law> Pass<Lanes> for Pull<'_, L> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        if self.q.len() == 2 { pull::<V, L, 2>(self) } else { pull::<V, L, 3>(self) }
    }
}

#[inline(always)]
fn pull<V: View<Lanes>, L: Law, const COMPONENTS: usize>(pull: Pull<'_, L>) {
    let Massive { places, velocities } = pull.massive;
    let (places, velocities) = (V::view(places), V::view(velocities));
    let (q, v, a) = (V::view(pull.q), V::view(pull.v), V::view_mut(pull.a));
    let leaders = &pull.of.leaders[..];
    let stride = places.len() / COMPONENTS;
    let place = vector(q, 0, 1, COMPONENTS);
    let mut speed = [V::zero(); 3];
    let mut sum = [V::zero(); 3];
    if L::VELOCITY {
        speed = vector(v, 0, 1, COMPONENTS);
    }
    if !pull.first {
        sum = vector(a, 0, 1, COMPONENTS);
    }
    for i in 0..leaders.len() {
        let Leader { index, slot, ref of, .. } = leaders[i];
        let d = difference(place, vector(places, slot, stride, COMPONENTS));
        let mut velocity = [V::zero(); 3];
        if L::VELOCITY {
            velocity = difference(speed, vector(velocities, slot, stride, COMPONENTS));
        }
        let term =
            pull.of.law.pull(index, &OfSource::told(V::view(of)), &Relative::new(d, velocity)).acceleration();
        for c in 0..3 {
            sum[c] += term[c];
        }
    }
    a[..COMPONENTS].copy_from_slice(&sum[..COMPONENTS]);
}
