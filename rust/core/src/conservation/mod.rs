//! The conserved quantities of a state: energy, momenta, centre of mass, virial.
//!
//! All sums are exact to about twice double precision, whatever the number of bodies and the units, so that a drift
//! that is seen is the integrator's and not the sum's. What is recorded on the way and what is asked for afterwards
//! are the same functions; [`columns`] is the table of what there is.

pub mod columns;

pub use crate::forces::bodies::{Bodies, Of, Vector};

use crate::error::Result;
use crate::forces::bodies::joined;
use crate::forces::gravity::energy;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::fused_double::FusedDouble;
use crate::numerics::lanes::{Lanes, Vector8, WIDTH};
use crate::numerics::power_of_two::scale;
use crate::numerics::real::Real;
use crate::numerics::scaled::Scaled;
use crate::parallel::Ticker;
use crate::scene::ForceSpec;
use crate::tiered;

tiered! {
    fn square_sum[][](bodies: &Bodies) -> FusedDouble<Lanes> = mass_times_square;
    fn vector_sum[][](bodies: &Bodies, of: Of, weighted: bool) -> [FusedDouble<Lanes>; 3] = mass_times_vector;
    fn moment_sum[][](bodies: &Bodies, about: [f64; 3]) -> [FusedDouble<Lanes>; 3] = mass_times_moment;
    fn mass_sum[][](bodies: &Bodies) -> FusedDouble<Lanes> = masses;
}

/// Σ m v².
#[inline(always)]
fn mass_times_square<V: Vector8>(bodies: &Bodies) -> FusedDouble<Lanes> {
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

/// Σ m q, or Σ q.
#[inline(always)]
fn mass_times_vector<V: Vector8>(bodies: &Bodies, of: Of, weighted: bool) -> [FusedDouble<Lanes>; 3] {
    let mut sum = [FusedDouble::<V>::zero(); 3];
    for body in (0..if weighted { bodies.massive() } else { bodies.len() }).step_by(WIDTH) {
        let mass = mass::<V>(bodies, body);
        for c in 0..3 {
            let value = bodies.coordinates_from::<V>(of, c, body);
            sum[c].gather(if weighted { mass.times(value) } else { value });
        }
    }
    let [x, y, z] = sum;
    [stored(x), stored(y), stored(z)]
}

/// Σ m (r − about) × v.
#[inline(always)]
fn mass_times_moment<V: Vector8>(bodies: &Bodies, about: [f64; 3]) -> [FusedDouble<Lanes>; 3] {
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
fn masses<V: Vector8>(bodies: &Bodies) -> FusedDouble<Lanes> {
    let mut sum = FusedDouble::<V>::zero();
    for body in (0..bodies.massive()).step_by(WIDTH) {
        sum.gather(mass::<V>(bodies, body));
    }
    stored(sum)
}

#[inline(always)]
fn mass<V: Vector8>(bodies: &Bodies, body: usize) -> FusedDouble<V> {
    FusedDouble { high: bodies.masses_from(body), low: V::zero() }
}

#[inline(always)]
fn stored<V: Vector8>(sum: FusedDouble<V>) -> FusedDouble<Lanes> {
    FusedDouble { high: sum.high.store(), low: sum.low.store() }
}

/// ½ Σ m v².
pub fn kinetic_energy(bodies: &Bodies) -> Scaled {
    let units = bodies.units;
    Scaled::new(joined(square_sum(bodies)).scale(0.5), units.mass + 2 * units.speed)
}

/// Σ m v.
pub fn momentum(bodies: &Bodies) -> [Scaled; 3] {
    let units = bodies.units;
    vector_sum(bodies, Of::Velocity, true).map(|sum| Scaled::new(joined(sum), units.mass + units.speed))
}

/// Σ m r / Σ m; of massless bodies alone, their mean.
pub fn center_of_mass(bodies: &Bodies) -> [Scaled; 3] {
    let massive = bodies.massive() > 0;
    let total = if massive { joined(mass_sum(bodies)) } else { DoubleDouble::from(bodies.len() as f64) };
    vector_sum(bodies, Of::Position, massive)
        .map(|sum| Scaled::new(joined(sum), bodies.units.length).over(Scaled::new(total, 0)))
}

/// Σ m (r − about) × v.
pub fn angular_momentum(bodies: &Bodies, about: [f64; 3]) -> [Scaled; 3] {
    let units = bodies.units;
    let exponent = units.mass + units.length + units.speed;
    moment_sum(bodies, about.map(|x| scale(x, -units.length))).map(|sum| Scaled::new(joined(sum), exponent))
}

/// Potential energy and virial Σ r·F of all forces of a scene.
///
/// # Errors
/// [`Error::Interrupted`](crate::Error::Interrupted).
pub fn potential_and_virial(
    forces: &[ForceSpec],
    bodies: &Bodies,
    threads: usize,
    ticker: &mut Ticker<'_>,
) -> Result<(Scaled, Scaled)> {
    let (mut potential, mut virial) = (Scaled::ZERO, Scaled::ZERO);
    let units = bodies.units;
    for force in forces {
        let (energy, work) = match force {
            ForceSpec::Gravity { constant, softening } => {
                energy::potential_and_virial(bodies, *constant, *softening, threads, ticker)?
            }
            ForceSpec::UniformField { g } => {
                let moments = vector_sum(bodies, Of::Position, true);
                let mut work = Scaled::ZERO;
                for c in 0..3 {
                    work = work.plus(Scaled::new(joined(moments[c]), units.mass + units.length).times(g[c]));
                }
                (work.times(-1.0), work)
            }
            ForceSpec::CentralField { potential: shape, center } => {
                let (mut energy, mut work) = (Scaled::ZERO, Scaled::ZERO);
                for body in 0..bodies.len() {
                    let place = bodies.vector(Of::Position, body);
                    let d: Vector = core::array::from_fn(|c| {
                        place[c] - DoubleDouble::from(scale(center[c], -units.length))
                    });
                    let r = (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt();
                    if r.to_f64() == 0.0 {
                        // At the centre of what is not singular: no pull.
                        energy = energy.plus(Scaled::new(shape.precise_value(r), 0));
                        continue;
                    }
                    let distance = Scaled::new(r, units.length).to_double_double();
                    energy = energy.plus(Scaled::new(shape.precise_value(distance), 0));
                    // The pull along d, and what of it the place sees.
                    let along = d[0] * place[0] + d[1] * place[1] + d[2] * place[2];
                    let pull = Scaled::new(shape.precise_force(distance), units.length);
                    work = work.plus(pull.by(Scaled::new(along, 0).over(Scaled::new(r, 0))));
                    ticker.tick()?;
                }
                (energy, work)
            }
        };
        potential = potential.plus(energy);
        virial = virial.plus(work);
    }
    Ok((potential, virial))
}
