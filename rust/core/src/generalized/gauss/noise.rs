//! How noisy rates are: what the rounding of a state makes of them.
//!
//! The one idea: the code itself tells. States that differ in their last digits have rates that differ by the noise that no
//! iteration gets below and no polynomial follows; of a stiff spring that is far more than the last digits of a rate. It is asked
//! for where a step is in trouble, and from there on if that was why.

use super::changes::ROUND_OFF;
use super::columns::AT_ONCE;
use super::step::{Iterated, Work, found};
use crate::expressions::Machine;
use crate::expressions::machine::Blocks;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::real::Real;
use crate::ode::system::Form;

/// Stages that change no more than this, as parts of sizes, may be held up by noise.
pub(super) const HELD_UP: f64 = 1e-2;
/// Forces turn no motion faster than so many times the inverse square of a step (of the first order, as the inverse of one) whose
/// stages converge, …
const FASTEST: f64 = 100.0;
/// … so what rounding makes of rates is no more than that of the largest number.
pub(super) fn most(largest: f64, (form, h): (Form, f64)) -> f64 {
    let time = if matches!(form, Form::SecondOrder(_)) { h * h } else { h.abs() };
    FASTEST * f64::EPSILON * largest / time
}

/// What noise is measured as at most: changes that stand still eight times above it are rounding.
const AS_ROUNDING: f64 = ROUND_OFF / 8.0;

/// What a change is measured by at most, inverted: noise is then as rounding is.
#[inline(always)]
pub(super) fn cap<V: Real>(noise: V, h: V) -> V {
    let cap = V::splat(AS_ROUNDING) / (noise * h.abs());
    V::select(V::zero().less(noise), cap, V::splat(f64::INFINITY))
}

/// A number with its last digit off: to which side, of eight samples, no two of seven numbers have alike.
#[inline]
fn off(number: f64, index: usize, sample: usize) -> f64 {
    let down = (sample & (index % (WIDTH - 1) + 1)).count_ones() % 2 == 1;
    number * if down { 1.0 - f64::EPSILON } else { 1.0 + f64::EPSILON }
}

/// By what a rate is rounded, of samples that are apart by twice as much to either side, as they are off by a whole digit and not
/// by half of one; nothing where one is no number.
#[inline]
fn noise_of(samples: &[f64; WIDTH]) -> f64 {
    let most = samples.iter().fold(f64::NEG_INFINITY, |most, &x| if x > most { x } else { most });
    let least = samples.iter().fold(f64::INFINITY, |least, &x| if x < least { x } else { least });
    let noise = 0.25 * (most - least);
    if noise < f64::INFINITY { noise } else { 0.0 }
}

/// The noise of each rate of one trajectory; also by what the rounding of the time makes of them, if that is asked.
pub(super) fn of_one(machine: &mut Machine<Lanes>, (t, timed): (f64, bool), y: &[f64], noise: &mut [f64]) {
    for (index, (register, &y)) in machine.state().iter_mut().zip(y).enumerate() {
        *register = Lanes(core::array::from_fn(|sample| off(y, index, sample)));
    }
    // Times that are too far apart are told of as such.
    let time = |sample| if timed { off(t, y.len(), sample) } else { t };
    machine.run(Lanes(core::array::from_fn(time)));
    for (index, noise) in noise.iter_mut().enumerate() {
        *noise = noise_of(&machine.output(index).0);
    }
}

/// The same of the trajectories in these lanes.
pub(super) fn of_eight(
    machine: &mut Blocks<AT_ONCE>,
    (t, timed): (Lanes, bool),
    y: &[Lanes],
    lanes: Bits,
    noise: &mut [Lanes],
) {
    let mut samples = vec![[[0.0; WIDTH]; WIDTH]; noise.len()];
    for first in (0..WIDTH).step_by(AT_ONCE) {
        machine.run_apart(|register, block| {
            let sample = |number: &Lanes| Lanes(number.0.map(|number| off(number, register, first + block)));
            y.get(register).map_or_else(|| if timed { sample(&t) } else { t }, sample)
        });
        for (index, samples) in samples.iter_mut().enumerate() {
            for block in 0..AT_ONCE {
                let rates = machine.output_of(index, block);
                for lane in 0..WIDTH {
                    samples[lane][first + block] = rates.0[lane];
                }
            }
        }
    }
    for (noise, samples) in noise.iter_mut().zip(&samples) {
        for lane in (0..WIDTH).filter(|&lane| lanes.lane(lane)) {
            noise.0[lane] = noise_of(&samples[lane]);
        }
    }
}

/// Finds the stages of a step from where they began, and if noise, unless that is known, holds them up, again beside that;
/// whether it is known then.
pub(super) fn found_beside_noise(work: &mut Work<'_>, known: bool) -> (Iterated, bool) {
    let begun = found(work);
    if known || begun.converged || begun.change > HELD_UP {
        return (begun, known);
    }
    let Work { machine, state, stages, t, .. } = &mut *work;
    of_one(machine, (*t, false), state.all().0, &mut stages.noise);
    stages.rates.copy_from_slice(&stages.guess);
    let beside = found(work);
    (Iterated { evaluations: begun.evaluations + 1 + beside.evaluations, ..beside }, true)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seven numbers are off to sides of their own, and each to both.
    #[test]
    fn samples_are_off_in_ways_of_their_own() {
        let ways: Vec<Vec<bool>> =
            (0..WIDTH - 1).map(|index| (0..WIDTH).map(|k| off(1.0, index, k) > 1.0).collect()).collect();
        for (index, way) in ways.iter().enumerate() {
            assert!(way.iter().any(|up| *up) && way.iter().any(|up| !*up));
            assert!(!ways[..index].contains(way));
        }
    }

    #[test]
    fn what_is_no_number_is_no_noise() {
        let mut samples = [1.0; WIDTH];
        samples[3] = 1.5;
        assert_eq!(noise_of(&samples), 0.125);
        samples[5] = f64::INFINITY;
        assert_eq!(noise_of(&samples), 0.0);
    }
}
