//! The conserved quantities of a state: energy, momenta, centre of mass, virial.
//!
//! All sums are exact to about twice double precision, whatever the number of bodies and the units, so that a drift
//! that is seen is the integrator's and not the sum's. What is recorded on the way and what is asked for afterwards
//! are the same functions; [`columns`] is the table of what there is.

pub mod columns;
pub mod side_by_side;

pub use crate::forces::bodies::{Of, PreciseBodies, Vector};

use crate::forces::bodies::{joined, mass, stored, vector_sum};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::fused_double::FusedDouble;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::scaled::Scaled;
use crate::tiered;

tiered! {
    fn square_sum[][](bodies: &PreciseBodies) -> FusedDouble<Lanes> = mass_times_square;
    fn moment_sum[][](bodies: &PreciseBodies, about: [f64; 3]) -> [FusedDouble<Lanes>; 3] = mass_times_moment;
    fn mass_sum[][](bodies: &PreciseBodies) -> FusedDouble<Lanes> = masses;
}

/// Σ m v².
#[inline(always)]
fn mass_times_square<V: Vector8>(bodies: &PreciseBodies) -> FusedDouble<Lanes> {
    let mut sum = FusedDouble::<V>::zero();
    for body in (0..bodies.massive()).step_by(WIDTH) {
        let mut v = [FusedDouble::<V>::zero(); 3];
        for c in 0..3 {
            v[c] = bodies.coordinates_from::<V>(Of::Velocity, c, body);
        }
        sum.gather(FusedDouble::sum_of_squares(v).times(mass::<V>(bodies, body)));
    }
    stored(sum)
}

/// Σ m (r − about) × v.
#[inline(always)]
fn mass_times_moment<V: Vector8>(bodies: &PreciseBodies, about: [f64; 3]) -> [FusedDouble<Lanes>; 3] {
    let mut sum = [FusedDouble::<V>::zero(); 3];
    for body in (0..bodies.massive()).step_by(WIDTH) {
        let mass = mass::<V>(bodies, body);
        let mut r = [FusedDouble::<V>::zero(); 3];
        let mut v = r;
        for c in 0..3 {
            let place = bodies.coordinates_from::<V>(Of::Position, c, body);
            r[c] = place.minus(FusedDouble { high: V::splat(about[c]), low: V::zero() });
            v[c] = bodies.coordinates_from::<V>(Of::Velocity, c, body);
        }
        for c in 0..3 {
            let (a, b) = ((c + 1) % 3, (c + 2) % 3);
            sum[c].gather(r[a].times(v[b]).minus(r[b].times(v[a])).times(mass));
        }
    }
    let [x, y, z] = sum;
    [stored(x), stored(y), stored(z)]
}

#[inline(always)]
fn masses<V: Vector8>(bodies: &PreciseBodies) -> FusedDouble<Lanes> {
    let mut sum = FusedDouble::<V>::zero();
    for body in (0..bodies.massive()).step_by(WIDTH) {
        sum.gather(mass::<V>(bodies, body));
    }
    stored(sum)
}

/// ½ Σ m v².
pub fn kinetic_energy(bodies: &PreciseBodies) -> Scaled {
    let units = bodies.units;
    Scaled::new(joined(square_sum(bodies)).scale(0.5), units.mass + 2 * units.speed)
}

/// Σ m v.
pub fn momentum(bodies: &PreciseBodies) -> [Scaled; 3] {
    let units = bodies.units;
    vector_sum(bodies, Of::Velocity, true).map(|sum| Scaled::new(joined(sum), units.mass + units.speed))
}

/// Σ m r / Σ m; of massless bodies alone, their mean.
pub fn center_of_mass(bodies: &PreciseBodies) -> [Scaled; 3] {
    let massive = bodies.massive() > 0;
    let total = if massive { joined(mass_sum(bodies)) } else { DoubleDouble::from(bodies.len() as f64) };
    vector_sum(bodies, Of::Position, massive)
        .map(|sum| Scaled::new(joined(sum), bodies.units.length).over(Scaled::new(total, 0)))
}

/// Σ m (r − about) × v.
pub fn angular_momentum(bodies: &PreciseBodies, about: [f64; 3]) -> [Scaled; 3] {
    let units = bodies.units;
    let exponent = units.mass + units.length + units.speed;
    moment_sum(bodies, about.map(|x| scale(x, -units.length))).map(|sum| Scaled::new(joined(sum), exponent))
}
