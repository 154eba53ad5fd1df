//! Massless bodies in the field of massive ones: no third law, no pairs among themselves.

use super::newton::CONSTANT;
use super::pair::squared_distance;
use super::series::passive::{self, PullSeries};
use crate::error::{Error, Result};
use crate::forces::ForceTerm;
use crate::forces::following::{FewMassless, Following, Leaders, Massive, MassiveSeries};
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, Vector8};
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use crate::units::Units;

/// The acceleration at `position` from massive bodies at `places`, in their order; `strengths` are their `G·m`.
///
/// No closures here or in the callers' loops: they would be compiled without the tier's instructions.
#[inline(always)]
pub(super) fn attraction<S: InverseCube, const PLANAR: bool, const SOFT: bool>(
    position: [S; 3],
    places: &[[S; 3]],
    strengths: &[S],
    softening2: S,
) -> [S; 3] {
    let mut a = [S::zero(); 3];
    for j in 0..places.len() {
        a = attract::<S, PLANAR, SOFT>(a, position, places[j], strengths[j], softening2);
    }
    a
}

/// Adds to `a` the pull at `position` of one body.
#[inline(always)]
pub(super) fn attract<S: InverseCube, const PLANAR: bool, const SOFT: bool>(
    mut a: [S; 3],
    position: [S; 3],
    place: [S; 3],
    strength: S,
    softening2: S,
) -> [S; 3] {
    let dx = place[0] - position[0];
    let dy = place[1] - position[1];
    let dz = place[2] - position[2];
    let w = strength * squared_distance::<S, PLANAR, SOFT>([dx, dy, dz], softening2).inverse_cube();
    a[0] = w.multiply_add(dx, a[0]);
    a[1] = w.multiply_add(dy, a[1]);
    if !PLANAR {
        a[2] = w.multiply_add(dz, a[2]);
    }
    a
}

/// As [`attraction`], of bodies packed in lanes: `numbers` holds their coordinates, component after
/// component at `stride`, and `strengths` their `G·m`.
#[inline(always)]
pub(super) fn packed_attraction<V: Vector8 + InverseCube, const PLANAR: bool, const SOFT: bool>(
    position: [V; 3],
    numbers: &[f64],
    stride: usize,
    strengths: &[f64],
    softening2: V,
) -> [V; 3] {
    let mut a = [V::zero(); 3];
    for (j, &strength) in strengths.iter().enumerate() {
        let z = if PLANAR { 0.0 } else { numbers[2 * stride + j] };
        let place = [V::splat(numbers[j]), V::splat(numbers[stride + j]), V::splat(z)];
        a = attract::<V, PLANAR, SOFT>(a, position, place, V::splat(strength), softening2);
    }
    a
}

/// Massive bodies that massless ones follow.
pub(super) struct Leading {
    /// Their `G·m`.
    strength: Vec<Lanes>,
    /// The softening length, squared, and whether it is more than nothing.
    softening2: Lanes,
    soft: bool,
    /// Much room, of a method that asks for it.
    series: Option<PullSeries>,
}

impl Leading {
    /// With this softening length, in the scene's units.
    pub(super) fn new(softening: f64, leaders: &Leaders<'_>) -> Self {
        let softening = leaders.units.take(softening, [1, 0, 0]);
        let (massive, softening2) = (leaders.bodies.len(), softening * softening);
        Self {
            strength: vec![Lanes::zero(); massive],
            softening2: Lanes::splat(softening2),
            soft: softening > 0.0,
            series: leaders.expands.then(|| PullSeries::new(massive, leaders.components, softening2)),
        }
    }
}

impl Following for Leading {
    fn lead(&mut self, own: &dyn ForceTerm, units: Units, mass: &[f64], lanes: Bits) {
        let (constant, softening) = own.as_newtonian().unwrap_or_default();
        let (constant, softening) = (units.take(constant, CONSTANT), units.take(softening, [1, 0, 0]));
        self.softening2 = Lanes::select(lanes, Lanes::splat(softening * softening), self.softening2);
        for (strength, mass) in self.strength.iter_mut().zip(mass) {
            *strength = Lanes::select(lanes, Lanes::splat(constant * mass), *strength);
        }
    }

    fn apply(&mut self, massive: Massive<'_>, (q, _): (&[Lanes], &[Lanes]), a: &mut [Lanes], first: bool) {
        let Self { strength, softening2, soft, .. } = self;
        let softening2 = soft.then_some(*softening2);
        Lanes::pass(Pull { places: massive.places, strength, softening2, q, a, first });
    }

    fn coefficient(
        &mut self,
        MassiveSeries { places, rests }: MassiveSeries<'_>,
        of: (usize, &Jet<Lanes>),
        a: &mut [Lanes],
        first: bool,
    ) -> Result<()> {
        let massive = passive::Massive { strength: &self.strength, places, rests };
        self.series.as_mut().ok_or_else(without_series)?.coefficient(massive, of, a, first);
        Ok(())
    }

    fn few(&mut self) -> Option<FewMassless<'_>> {
        let Self { strength, series, .. } = self;
        series.as_mut().map(|series| FewMassless { strength, series: series.few() })
    }

    fn expand(
        &mut self,
        MassiveSeries { places, rests }: MassiveSeries<'_>,
        jet: &mut Jet<Lanes>,
        a: &mut [Lanes],
    ) -> Result<()> {
        let massive = passive::Massive { strength: &self.strength, places, rests };
        self.series.as_mut().ok_or_else(without_series)?.expand(massive, jet, a);
        Ok(())
    }
}

fn without_series() -> Error {
    Error::Internal("gravity without its series".to_owned())
}

/// The pull on one massless body in each lane of massive ones at given places: written into `a` if `first`, else added.
struct Pull<'a> {
    /// Where the massive bodies are, component after component.
    places: &'a [Lanes],
    /// Their `G·m`.
    strength: &'a [Lanes],
    /// The softening length, squared, if there is one.
    softening2: Option<Lanes>,
    /// Where the massless bodies are, one number for each component.
    q: &'a [Lanes],
    /// Their accelerations.
    a: &'a mut [Lanes],
    /// Whether these are the first.
    first: bool,
}

impl Pass<Lanes> for Pull<'_> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        match (self.q.len() == 2, self.softening2.is_some()) {
            (false, false) => pull::<V, false, false>(self),
            (false, true) => pull::<V, false, true>(self),
            (true, false) => pull::<V, true, false>(self),
            (true, true) => pull::<V, true, true>(self),
        }
    }
}

#[inline(always)]
fn pull<V: View<Lanes>, const PLANAR: bool, const SOFT: bool>(pull: Pull<'_>) {
    let components = if PLANAR { 2 } else { 3 };
    let (places, strength, q, a) =
        (V::view(pull.places), V::view(pull.strength), V::view(pull.q), V::view_mut(pull.a));
    let softening2 = match pull.softening2 {
        Some(softening2) => V::load(softening2),
        None => V::zero(),
    };
    let massive = strength.len();
    let mut position = [V::zero(); 3];
    position[..components].copy_from_slice(&q[..components]);
    let mut sum = [V::zero(); 3];
    for j in 0..massive {
        let z = if PLANAR { V::zero() } else { places[2 * massive + j] };
        let place = [places[j], places[massive + j], z];
        sum = attract::<V, PLANAR, SOFT>(sum, position, place, strength[j], softening2);
    }
    for c in 0..components {
        a[c] = if pull.first { sum[c] } else { a[c] + sum[c] };
    }
}
