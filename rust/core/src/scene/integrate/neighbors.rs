//! What becomes of neighbors of motions, and how far they get: beside each unit runs a small difference of it ([`variation`]).
//!
//! The one idea: the motion and the difference are one state, so that both take the same steps. Before the difference leaves the range of numbers it is set back to a length of about 1, and the logarithm of what
//! it has grown is kept.

mod choosing;
mod equal;
mod measures;
mod slopes;
mod variation;

use super::super::frame::Units;
use super::super::layout::Layout;
use super::super::unit::{Prepared, Unit};
use super::fixed::lay;
use super::report::Ending;
use super::{Job, Result};
use crate::forces::term::Coupling;
use crate::numerics::lanes::{Bits, Lanes, WIDTH};
use crate::numerics::power_of_two::{exponent, power_of_two, scale};
use crate::numerics::real::{Mask, Real};
use crate::ode::state::State;
use crate::parallel::{Ticker, for_chunks};
use core::f64::consts::LN_2;
use measures::Size;
use variation::Variation;

/// Between which powers of two the length of a difference may be.
const WIDEST: i32 = 128;
/// What a step may be off in a difference, as a part of it: more than rounding of a derivative in a deep encounter, …
const OF_DIFFERENCES: f64 = 1e-5;
/// … and no less than this, which is rounding of differences of forces elsewhere, where it is asked what becomes of it.
const ROUNDED: f64 = 1e-9;

/// What became of a unit and its neighbor.
pub struct Followed {
    /// Which copy it is.
    pub copy: usize,
    /// The logarithm of what the difference has grown, at each output time; NaN after an end.
    pub growth: Vec<f64>,
    /// What has become of it, of the place and the velocity of each body at each output time; nothing where that is not asked.
    pub differences: Vec<[[f64; 3]; 2]>,
    /// How it ended.
    pub ending: Ending,
}

/// From where neighbors begin, and how far they may be.
pub struct Toward<'a> {
    /// Differences of the place and the velocity of each body.
    pub directions: Directions<'a>,
    /// How far each copy goes about its middle, and how fast. Bodies on which nothing but fields act have no other size.
    pub sizes: &'a [[f64; 2]],
}

/// Which differences neighbors begin with.
#[derive(Clone, Copy)]
pub enum Directions<'a> {
    /// Those of all copies, in sizes of the motion, of which is asked how far they get.
    OfAll(&'a [[[f64; 3]; 2]]),
    /// Those of each copy, one after another, in the units of the scene, of which is asked what becomes of them.
    OfEach(&'a [[[f64; 3]; 2]]),
}

impl Directions<'_> {
    /// Whether it is asked what becomes of them.
    fn are_followed(&self) -> bool {
        matches!(self, Self::OfEach(_))
    }

    /// That of a body of a copy, in the units of a plan, in which the motion has a size.
    fn of(&self, (copy, body): (usize, usize), bodies: usize, size: &Size, units: Units) -> [[f64; 3]; 2] {
        match self {
            Self::OfAll(directions) => {
                let [place, velocity] = directions[body];
                [place.map(|x| x * size.place), velocity.map(|v| v * size.velocity)]
            }
            Self::OfEach(directions) => {
                let [place, velocity] = directions[copy * bodies + body];
                [place.map(|x| scale(x, -units.length)), velocity.map(|v| scale(v, units.velocity()))]
            }
        }
    }
}

/// Follows all units of a plan.
///
/// # Errors
/// Those of the library itself, and [`Error::Interrupted`](crate::Error::Interrupted).
pub fn run(job: &Job<'_>, toward: &Toward<'_>, ticker: &mut Ticker<'_>) -> Result<Vec<Followed>> {
    let units = job.plan.unit_list();
    let groups: Vec<&[Unit]> = units.chunks(job.plan.layout.units()).collect();
    let (over, inside) = job.plan.threads;
    let followed = for_chunks(over, groups.len(), ticker, |group, ticker| {
        Group::new(job, groups[group], toward, inside, ticker)?.follow(ticker)
    })?;
    Ok(followed.into_iter().flatten().collect())
}

/// Units in lanes, beside their neighbors.
struct Group<'a> {
    job: &'a Job<'a>,
    units: Vec<Prepared>,
    layout: Layout,
    variation: Variation,
    state: State<Lanes>,
    /// What is to be added to the logarithm of a length.
    gained: [f64; WIDTH],
    /// The powers of two that differences are to be multiplied with.
    raised: [i32; WIDTH],
    /// What a step may be off in a difference, as a part of it.
    accuracy: f64,
    followed: Vec<Followed>,
    /// The lanes whose units go on.
    running: Bits,
}

impl<'a> Group<'a> {
    fn new(
        job: &'a Job<'a>,
        units: &[Unit],
        toward: &Toward<'_>,
        threads: usize,
        ticker: &mut Ticker<'_>,
    ) -> Result<Self> {
        let layout = job.plan.layout;
        let units: Vec<Prepared> =
            units.iter().map(|unit| job.prepare(unit, ticker)).collect::<Result<_>>()?;
        let alone = job.plan.forces.iter().all(|force| force.coupling() == Coupling::None);
        let size = |unit: &Prepared| {
            let [place, velocity] = toward.sizes[unit.unit.copy];
            let of = job.plan.units;
            let size = Size {
                place: scale(place, -of.length),
                velocity: scale(velocity, of.velocity()),
                of_motion: true,
            };
            let known = alone && size.place > 0.0 && size.velocity > 0.0;
            if known { size } else { Size { place: unit.size.0, velocity: unit.size.1, of_motion: false } }
        };
        let sizes: Vec<Size> = units.iter().map(size).collect();
        let variation = Variation::new(job.plan, &units, &sizes, threads);
        let mut motion = units[0].blank_state(1);
        lay(job.plan, &units, &mut motion);
        let mut apart = [motion.q().to_vec(), motion.v().to_vec()];
        apart.iter_mut().for_each(|apart| apart.fill(Lanes::zero()));
        let bodies = job.scene.particles;
        for lane in 0..layout.units() {
            let at = lane.min(units.len() - 1);
            let unit = &units[at];
            for (slot, &body) in unit.unit.bodies.iter().enumerate() {
                let of = (unit.unit.copy, body);
                let begin = toward.directions.of(of, bodies, &sizes[at], job.plan.units);
                for (apart, begin) in apart.iter_mut().zip(begin) {
                    unit.lay(slot, apart, lane, begin);
                }
            }
        }
        let [places, velocities] = apart;
        let nothing = vec![Lanes::zero(); places.len()];
        let both = |numbers: &[Lanes], apart: &[Lanes]| [numbers, apart].concat();
        let numbers = [both(motion.q(), &places), both(motion.v(), &velocities)];
        let mut state = State::new(&numbers[0], &numbers[1]);
        let rests = [both(motion.q_compensation(), &nothing), both(motion.v_compensation(), &nothing)];
        let ((_, q_rest), (_, v_rest)) = state.halves_mut();
        q_rest.copy_from_slice(&rests[0]);
        v_rest.copy_from_slice(&rests[1]);
        let (times, is_followed) = (job.times.len(), toward.directions.are_followed());
        let followed = units.iter().map(|unit| Followed {
            copy: unit.unit.copy,
            growth: vec![f64::NAN; times],
            differences: if is_followed { vec![[[f64::NAN; 3]; 2]; times * bodies] } else { Vec::new() },
            ending: Ending::Finished,
        });
        let running = (0..units.len()).fold(Bits(0), |lanes, lane| lanes.or(layout.mask(lane)));
        let followed = followed.collect();
        let accuracy = match (is_followed, variation.is_exact()) {
            (true, true) => job.rtol,
            (true, false) => Real::max(job.rtol, ROUNDED),
            (false, _) => OF_DIFFERENCES,
        };
        let (gained, raised) = ([0.0; WIDTH], [0; WIDTH]);
        let mut group =
            Self { job, units, layout, variation, state, gained, raised, accuracy, followed, running };
        group.gained = group.length(&group.state).0.map(|length| -length.ln());
        Ok(group)
    }

    fn follow(mut self, ticker: &mut Ticker<'_>) -> Result<Vec<Followed>> {
        if self.job.plan.method.adaptive() {
            self.choosing(ticker)?
        } else {
            self.in_equal_steps(ticker)?
        }
        Ok(self.followed)
    }

    /// The lengths of the differences in a state.
    fn length(&self, state: &State<Lanes>) -> Lanes {
        let half = self.variation.half();
        self.variation.measures.length(&state.q()[half..], &state.v()[half..])
    }

    /// Takes down what differences have become at an output time, in some lanes: in the present state, or in another one.
    fn record(&mut self, output: usize, other: Option<&State<Lanes>>, length: &Lanes, lanes: Bits) {
        let (half, state) = (self.variation.half(), other.unwrap_or(&self.state));
        let (places, velocities) = (&state.q()[half..], &state.v()[half..]);
        let (bodies, of) = (self.job.scene.particles, self.job.plan.units);
        for (lane, followed) in self.followed.iter_mut().enumerate().filter(|(lane, _)| lanes.lane(*lane)) {
            followed.growth[output] = length.0[lane].ln() + self.gained[lane];
            if followed.differences.is_empty() {
                continue;
            }
            let (unit, raised) = (&self.units[lane], self.raised[lane]);
            for (slot, &body) in unit.unit.bodies.iter().enumerate() {
                let picked = |block: &[Lanes], exponent: i32| {
                    unit.pick(slot, block, lane).map(|number| scale(number, exponent + raised))
                };
                followed.differences[output * bodies + body] =
                    [picked(places, of.length), picked(velocities, -of.velocity())];
            }
        }
    }

    /// Brings differences of the present state back to a length of about 1 where they leave the range of numbers; in which lanes.
    fn set_back(&mut self) -> Bits {
        let length = self.length(&self.state);
        let mut changed = Bits(0);
        let mut factors = Lanes::one();
        for lane in 0..WIDTH {
            let power = exponent(length.0[lane]);
            if power.abs() > WIDEST {
                factors.0[lane] = power_of_two(-power);
                self.gained[lane] += f64::from(power) * LN_2;
                self.raised[lane] += power;
                changed = changed.or(Bits(1 << lane));
            }
        }
        if changed.any() {
            let half = self.variation.half();
            let ((q, q_rest), (v, v_rest)) = self.state.halves_mut();
            for numbers in [q, q_rest, v, v_rest] {
                numbers[half..].iter_mut().for_each(|number| *number = *number * factors);
            }
        }
        changed
    }

    /// Ends the unit in a lane.
    fn end(&mut self, lane: usize, ending: Ending) {
        self.running = self.running.and(self.layout.mask(lane).not());
        self.followed[lane].ending = ending;
    }
}
