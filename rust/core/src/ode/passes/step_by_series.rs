//! A step by Taylor series: its choice, and what is found at its end.
//!
//! The one idea: what is done once for a step, number by number of time, is one loop's worth of registers; as operations on lanes
//! in memory, each would cost as much as a coefficient.

use super::errors::HUGE;
use super::series::{Both, Numbers};
use super::series_errors::Vectors;
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::real::{Mask, Real};
use crate::ode::step_control::{Clock, Controlled};

/// Of a step of so many units of time the last coefficients may be too small for all their digits, and for a step that other
/// units of the scene leave as it is: the motion is expanded once more, in a unit longer by this.
pub(in crate::ode) const FAR: f64 = 4_294_967_296.0; // 2^32

/// One over the step that the coefficients of two orders allow, in their unit of time.
pub(in crate::ode) enum Allowed<'a, S> {
    /// By vectors.
    Vectors(Vectors<'a, S>),
    /// By numbers.
    Numbers(Numbers<'a, S>),
}

impl<S: Controlled> Allowed<'_, S> {
    /// The last two orders tell; where they vanish, those before them, down to an order.
    #[inline(always)]
    fn inverse<V: View<S>>(self, (mut highest, last): (usize, usize), running: V::Mask, per_unit: V) -> V {
        let (mut told, mut untold) = (V::zero(), V::Mask::splat(true));
        loop {
            let orders = [highest, highest - 1];
            let inverse = match &self {
                Self::Vectors(vectors) => vectors.inverse_step(orders, per_unit),
                Self::Numbers(numbers) => numbers.inverse_step(orders),
            };
            told = V::select(untold, inverse, told);
            if highest - 2 <= last {
                return told;
            }
            highest -= 2;
            untold = told.less_equal(V::zero());
            if !untold.and(running).any() {
                return told;
            }
        }
    }
}

/// The choice of a step.
#[derive(Debug)]
pub(in crate::ode) struct Choice<'a, S: Real> {
    /// The unit of time.
    pub(in crate::ode) unit: &'a S,
    /// The share of the longest step that is taken.
    pub(in crate::ode) margin: f64,
    /// What the step is not to be longer than.
    pub(in crate::ode) longest: [&'a S; 3],
    /// The step there is set in those that run.
    pub(in crate::ode) clock: &'a mut Clock<S>,
    /// Those that do.
    pub(in crate::ode) running: S::Mask,
    /// The shortest unit that was too long for this step.
    pub(in crate::ode) too_long: &'a mut S,
    /// The step without its sign, the one that is tried, the time at its end, and, where it is taken, the next unit.
    pub(in crate::ode) into: [&'a mut S; 4],
}

/// What is told of a step that was chosen.
#[derive(Clone, Copy, Debug)]
pub(in crate::ode) struct Chosen<M> {
    /// The coefficients are numbers.
    pub(in crate::ode) sound: M,
    /// They are to be found once more, in a longer unit.
    pub(in crate::ode) again: M,
}

impl<S: Element> Choice<'_, S> {
    /// From one over the step that the coefficients allow, which is infinite if they are no numbers; and the step.
    #[inline(always)]
    fn choose<V: View<S>>(self, inverse: V) -> (Chosen<S::Mask>, V) {
        let unit = V::load(*self.unit);
        let mut clock = self.clock.load::<V>();
        let running = V::mask(self.running);
        let zero = V::zero();
        let sound = inverse.less(V::splat(HUGE));
        // The unit of time may be to blame; of the shortest there is, it is not.
        let shorter = V::select(zero.power_below().less(unit), unit, zero);
        let step = V::select(sound, V::splat(self.margin) * unit / inverse, shorter);
        // What nothing limits goes to the end.
        let span = (clock.end - clock.elapsed).abs();
        let [smooth, bound, longest] = self.longest;
        let longest = V::load(*smooth).min(V::load(*longest).min(V::load(*bound)));
        let step = step.min(longest).min(span + span);
        let signed = V::select(clock.end.less(clock.elapsed), -step, step);
        clock.h = V::select(running, signed, clock.h);
        let (h, _) = clock.next_step(running);
        let too_long = V::select(sound.or(running.not()), V::load(*self.too_long), unit);
        let again = (V::splat(FAR) * unit).less(step.min(too_long)).and(sound);
        self.clock.h = clock.h.store();
        *self.too_long = too_long.store();
        let [of_step, of_h, of_end, of_next] = self.into;
        (*of_step, *of_h, *of_end) = (step.store(), h.store(), (clock.elapsed + h).store());
        *of_next = V::select(running, step.power_below(), V::load(*of_next)).store();
        (Chosen { sound: V::mask_in_memory(sound), again: V::mask_in_memory(again) }, h)
    }
}

/// A step as the coefficients tell it: how long it is, and where it leads.
pub(in crate::ode) struct Step<'a, S: Real> {
    pub(in crate::ode) allowed: Allowed<'a, S>,
    /// The highest order of the coefficients, and that down to which is looked.
    pub(in crate::ode) orders: (usize, usize),
    /// One over the unit of time.
    pub(in crate::ode) per_unit: &'a S,
    /// What it allows, for another choice.
    pub(in crate::ode) inverse: &'a mut S,
    pub(in crate::ode) choice: Choice<'a, S>,
    /// Where it leads.
    pub(in crate::ode) sums: Both<'a, S>,
}

impl<S: Controlled> Pass<S> for Step<'_, S> {
    type Output = Chosen<S::Mask>;
    #[inline(always)]
    fn run<V: View<S>>(self) -> Chosen<S::Mask> {
        let (running, per_unit) = (V::mask(self.choice.running), V::load(*self.per_unit));
        let inverse = self.allowed.inverse(self.orders, running, per_unit);
        *self.inverse = inverse.store();
        let (chosen, h) = self.choice.choose(inverse);
        self.sums.write(h, per_unit);
        chosen
    }
}

/// The same step with another bound.
pub(in crate::ode) struct Shorter<'a, S: Real> {
    pub(in crate::ode) per_unit: &'a S,
    pub(in crate::ode) inverse: &'a S,
    pub(in crate::ode) choice: Choice<'a, S>,
    pub(in crate::ode) sums: Both<'a, S>,
}

impl<S: Element> Pass<S> for Shorter<'_, S> {
    type Output = Chosen<S::Mask>;
    #[inline(always)]
    fn run<V: View<S>>(self) -> Chosen<S::Mask> {
        let (chosen, h) = self.choice.choose(V::load(*self.inverse));
        self.sums.write(h, V::load(*self.per_unit));
        chosen
    }
}

/// By how much the rates at the end of a step are not those of the polynomial that led there.
#[derive(Debug)]
pub(in crate::ode) struct Missed<'a, S> {
    /// The rates that were found; afterwards what they differ by, in the unit of time of the coefficients.
    pub(in crate::ode) rates: &'a mut [S],
    /// Blocks of coefficients of what they are the rates of, from order 0 on.
    pub(in crate::ode) blocks: &'a [S],
    /// The highest order.
    pub(in crate::ode) highest: usize,
    /// The step, and that unit.
    pub(in crate::ode) times: [&'a S; 2],
    /// Whether they are accelerations.
    pub(in crate::ode) second_order: bool,
}

/// Of `G` numbers from one on, Σ n bₙ xⁿ⁻¹ of their coefficients up to an order, and the largest |cₙ xⁿ| of others.
#[inline(always)]
pub(super) fn slopes_and_reaches<V: Real, const G: usize>(
    [b, c]: [&[V]; 2],
    (len, start): (usize, usize),
    highest: usize,
    x: V,
) -> ([V; G], [V; G]) {
    let (mut slopes, mut reaches) = ([V::zero(); G], [V::zero(); G]);
    let (mut n, mut power) = (V::zero(), V::one());
    let mut place = len + start;
    for _ in 0..highest {
        n += V::one();
        let weight = n * power;
        power = power * x;
        let (b, c) = (&b[place..][..G], &c[place..][..G]);
        for g in 0..G {
            slopes[g] = b[g].multiply_add(weight, slopes[g]);
            reaches[g] = (c[g] * power).abs().max(reaches[g]);
        }
        place += len;
    }
    (slopes, reaches)
}

/// Where numbers that miss by more than so many tolerances of how far they go in a step lead astray in it.
#[derive(Debug)]
pub(in crate::ode) struct OwnMissed<'a, S> {
    /// What they miss.
    pub(in crate::ode) missed: Missed<'a, S>,
    /// Blocks of coefficients, from order 0 on.
    pub(in crate::ode) blocks: &'a [S],
    /// What is rounding of each rate, if that is looked at.
    pub(in crate::ode) rounding: Option<&'a [S]>,
    /// The tolerance, the least that it is taken for, and how many there may be.
    pub(in crate::ode) tolerance: &'a S,
    pub(in crate::ode) least: f64,
    pub(in crate::ode) most: f64,
}

impl<S: Element> Pass<S> for OwnMissed<'_, S> {
    type Output = S::Mask;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S::Mask {
        let Missed { rates, blocks, highest, times, second_order } = self.missed;
        let (rates, of_rates, blocks) = (V::view(rates), V::view(blocks), V::view(self.blocks));
        let rounding = V::view(self.rounding.unwrap_or_default());
        let (unit, len) = (V::load(*times[1]), rates.len());
        let x = V::load(*times[0]) / unit;
        let moves = if second_order { unit * unit } else { unit };
        let tolerance = V::load(*self.tolerance).max(V::splat(self.least));
        let in_a_step = (x * x).max(V::one());
        let mut most = V::zero();
        for (number, &rate) in rates.iter().enumerate() {
            let ([slope], [goes]) = slopes_and_reaches([of_rates, blocks], (len, number), highest, x);
            let mut missed = (rate * moves - slope).abs();
            if let Some(&rounding) = rounding.get(number) {
                missed -= rounding * moves;
            }
            // What is no number stays none.
            let missed = V::select(missed.less(V::zero()), V::zero(), missed) * in_a_step;
            let nothing = missed.less_equal(V::zero());
            let ratio = V::select(nothing, V::zero(), missed / (tolerance * goes));
            let square = ratio * ratio;
            let sound = square.less(V::splat(HUGE));
            most = V::select(sound, square, V::splat(f64::INFINITY)).max(most);
        }
        V::mask_in_memory(most.less_equal(V::splat(self.most * self.most)).not())
    }
}
