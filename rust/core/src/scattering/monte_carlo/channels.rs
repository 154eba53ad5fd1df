//! Channels: what becomes of projectile and target, and the energy that is released or taken up between.
//!
//! The one idea: bodies go off by the angle ψ of the potential, with the speeds that the Q of a channel leaves them. Which
//! channel an event goes through is a draw of its own, divided at the running sums of the probabilities; what is left
//! above the last of them is elastic. So a channel more, asked for at the end, changes no event of those before, and an
//! event stays a step function of the draw of its place, one for each channel.

use super::beam::UNIT;
use super::probability::{Factor, Probability};
use super::quantity::Quantity;
use crate::numerics::philox::DRAW_BITS;
use crate::scattering::histogram::Lookup;
use crate::scattering::kinematics::{Circle, Collision, Encounter, HalfAngle, Product, Reaction};
use crate::words::number;
use crate::{Error, Result};
use core::f64::consts::PI;
use std::sync::Arc;

/// Channels besides the elastic one, at most.
const MOST: usize = 64;
/// How far the sum of probabilities may be above 1 by rounding.
const ROUNDED: f64 = 1e-12;
/// Thresholds that differ by a smaller part of them are one: users find them by other roundings.
const SAME_ENERGY: f64 = 4.0 * f64::EPSILON;
/// Pairs of an energy and an impact parameter at which sums of probabilities are looked at, at most: a second's work.
const MOST_PAIRS: usize = 1 << 21;
/// All draws.
const DRAWS: u64 = 1 << DRAW_BITS;

/// What a reaction is asked to be.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// The part of all events.
    pub probability: Probability,
    /// Released (positive) or taken up (negative).
    pub q_value: f64,
    /// Masses of what projectile and target become; the same if none.
    pub products: Option<(f64, f64)>,
}

/// The channels of a beam, each with its part of the draws.
#[derive(Clone, Debug, PartialEq)]
pub struct Channels {
    /// The first draw of each that has any, and its number: 0 is elastic, others count from 1 as given.
    open: Vec<(u64, usize)>,
    /// Of each reaction.
    probabilities: Vec<Probability>,
    /// Whether one of them hangs on what an event is; then all are open, and elastic is the last.
    varies: bool,
    reactions: Vec<Reaction>,
}

/// A channel of a beam of one middle energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Exit {
    Elastic(Collision),
    /// The reaction, and what becomes of it at that energy.
    Reaction(Reaction, f64, Encounter),
}

/// The first draw above that sum of probabilities.
fn end_of(sum: f64) -> u64 {
    if sum >= 1.0 - ROUNDED { DRAWS } else { (sum / UNIT) as u64 }
}

impl Channels {
    /// Of a projectile and a target of those masses.
    ///
    /// # Errors
    /// `InvalidInput` naming `channels`, too many of them or probabilities that are none or more than 1 together, and as
    /// [`Reaction::new`].
    pub fn new(channels: &[Channel], masses: (f64, f64)) -> Result<Self> {
        let refused = |message: String| Err(Error::invalid("channels", message));
        if channels.len() > MOST {
            return refused(format!("expected at most {MOST}, got {}", channels.len()));
        }
        for (index, channel) in channels.iter().enumerate() {
            if let Some(defect) = channel.probability.defect() {
                return refused(format!("{defect} of channel {index}"));
            }
        }
        let probabilities: Vec<Probability> =
            channels.iter().map(|channel| channel.probability.clone()).collect();
        // Products of what is piecewise linear are together greatest where they bend.
        let bends = |factor: fn(&Probability) -> &Factor| -> Vec<f64> {
            [0.0].into_iter().chain(probabilities.iter().flat_map(|p| factor(p).bends()).copied()).collect()
        };
        let energies = bends(|probability| &probability.of_energy);
        let places = bends(|probability| &probability.of_place);
        if places.len().saturating_mul(energies.len()) > MOST_PAIRS {
            return refused(format!(
                "expected tables of at most 2**21 pairs of an impact parameter and an energy, got {} and {}",
                places.len() - 1,
                energies.len() - 1
            ));
        }
        for b in places {
            for energy in &energies {
                let sum: f64 = probabilities.iter().map(|probability| probability.at(b, *energy)).sum();
                if sum > 1.0 + ROUNDED {
                    let place = if energies.len() > 1 {
                        format!("impact parameter {} and the energy {}", number(b), number(*energy))
                    } else {
                        format!("impact parameter {}", number(b))
                    };
                    return refused(format!(
                        "expected probabilities that are together at most 1, what is left being elastic, but at the {place} they are {}",
                        number(sum)
                    ));
                }
            }
        }
        let reaction =
            |channel: &Channel| Reaction::new(masses, channel.products.unwrap_or(masses), channel.q_value);
        let reactions = channels.iter().map(reaction).collect::<Result<_>>()?;
        Ok(Self::opened(probabilities, reactions))
    }
    /// Those of them that have draws.
    fn opened(probabilities: Vec<Probability>, reactions: Vec<Reaction>) -> Self {
        let of_event = |p: &Probability| !(p.of_place.bends().is_empty() && p.of_energy.bends().is_empty());
        let varies = probabilities.iter().any(of_event);
        let (mut sum, mut start, mut open) = (0.0, 0, Vec::new());
        for (index, probability) in probabilities.iter().enumerate() {
            sum += probability.at(0.0, 0.0);
            let end = end_of(sum);
            if end > start || varies {
                open.push((start, index + 1));
            }
            start = end;
        }
        if start < DRAWS || varies {
            open.push((start, 0));
        }
        Self { open, probabilities, varies, reactions }
    }
    /// The same where all events have one energy.
    pub(super) fn at_energy(&self, energy: f64) -> Self {
        let told = self.probabilities.iter().map(|probability| probability.at_energy(energy)).collect();
        Self::opened(told, self.reactions.clone())
    }
    /// Only elastic.
    pub fn elastic() -> Self {
        Self { open: vec![(0, 0)], probabilities: Vec::new(), varies: false, reactions: Vec::new() }
    }
    /// The exits of a beam: of a middle energy, and the least and the greatest of its spread.
    ///
    /// # Errors
    /// `InvalidInput` naming `channels` of which one is closed at the least energy and yet has a probability there.
    pub(super) fn exits(
        &self,
        collision: Collision,
        middle: f64,
        [least, greatest]: [f64; 2],
    ) -> Result<Arc<[Exit]>> {
        let mut made = Vec::with_capacity(self.reactions.len());
        for (index, (reaction, probability)) in self.reactions.iter().zip(&self.probabilities).enumerate() {
            let threshold = reaction.threshold();
            if least < threshold
                && !probability.vanishes(least, (threshold * (1.0 - SAME_ENERGY)).min(greatest))
            {
                let (threshold, q, least) = (number(threshold), number(reaction.q_value()), number(least));
                return Err(Error::invalid(
                    "channels",
                    format!(
                        "expected beam energies of at least the threshold, {threshold}, that q_value = {q} of channel {index} sets, or an excitation_function that is 0 below it, got {least}"
                    ),
                ));
            }
            let [least, middle, greatest] = [least, middle, greatest].map(|energy| energy.max(threshold));
            let _checked = (reaction.at(least)?, reaction.at(greatest)?);
            made.push(if reaction.is_elastic() {
                Exit::Elastic(collision)
            } else {
                Exit::Reaction(*reaction, middle, reaction.at(middle)?)
            });
        }
        let exit = |(_, channel): &(u64, usize)| {
            channel
                .checked_sub(1)
                .and_then(|index| made.get(index).copied())
                .unwrap_or(Exit::Elastic(collision))
        };
        Ok(self.open.iter().map(exit).collect())
    }
    /// How many have events.
    pub(super) fn count(&self) -> usize {
        self.open.len()
    }
    /// Whether which one an event goes through hangs on its impact parameter or its energy.
    pub(super) fn vary(&self) -> bool {
        self.varies
    }
    /// Which of them a draw is at an impact parameter and an energy, in the order of [`exits`](Self::exits).
    pub(super) fn find(&self, draw: u64, b: f64, energy: f64) -> usize {
        if self.varies {
            let mut sum = 0.0;
            let below = |probability: &Probability| {
                sum += probability.at(b, energy);
                draw < end_of(sum)
            };
            return self.probabilities.iter().position(below).unwrap_or(self.probabilities.len());
        }
        self.open.partition_point(|(start, _)| *start <= draw).saturating_sub(1)
    }
    /// The number of one of them: 0 is elastic, others count from 1 as given.
    pub(super) fn label(&self, exit: usize) -> usize {
        self.open.get(exit).map_or(0, |(_, label)| *label)
    }
    /// Which of them a draw is, if there are several.
    pub(super) fn lookup(&self) -> Option<Lookup> {
        let starts: Vec<u64> = self.open.iter().map(|(start, _)| *start).collect();
        (starts.len() > 1).then(|| Lookup::new(starts, 16))
    }
    /// The part of all draws that is each one's.
    pub(super) fn parts(&self) -> impl Iterator<Item = f64> {
        let ends = self.open.iter().skip(1).map(|(start, _)| *start).chain([DRAWS]);
        self.open.iter().zip(ends).map(|((start, _), end)| (end - start) as f64 * UNIT)
    }
}

impl Exit {
    /// Whether projectile and target stay what they are, with all of their energy.
    pub(super) fn is_elastic(&self) -> bool {
        matches!(self, Self::Elastic(_))
    }
    /// That energy, or the threshold, below which there are no events.
    fn open_at(&self, energy: f64) -> f64 {
        match self {
            Self::Elastic(_) => energy,
            Self::Reaction(reaction, ..) => energy.max(reaction.threshold()),
        }
    }
    fn encounter(&self, energy: f64) -> Encounter {
        match self {
            Self::Elastic(collision) => Encounter::elastic(*collision),
            Self::Reaction(_, middle, encounter) if *middle == energy => *encounter,
            Self::Reaction(reaction, ..) => reaction.encounter(self.open_at(energy)),
        }
    }
    /// The value of a quantity of half an angle at a beam energy, directions from that of the projectile before.
    pub(super) fn value(&self, quantity: Quantity, energy: f64, half: HalfAngle) -> f64 {
        if let Self::Elastic(collision) = self {
            return match quantity {
                Quantity::CmAngle => half.cm_angle(),
                Quantity::LabAngle => collision.lab_angle(half),
                Quantity::RecoilAngle => half.recoil_angle(),
                Quantity::Energy => energy * collision.kept(half),
                Quantity::RecoilEnergy => energy * collision.transferred(half),
                Quantity::ImpactParameter => f64::NAN,
            };
        }
        let energy = self.open_at(energy);
        // No rounding takes an energy above its greatest, which may be an edge.
        let part = |body: &Product, half| body.energy(half).min(body.energy(HalfAngle::of(0.0)));
        match quantity {
            Quantity::CmAngle => half.cm_angle(),
            Quantity::LabAngle => self.encounter(energy).projectile().circle().lab_angle(half),
            Quantity::RecoilAngle => self.encounter(energy).target().circle().lab_angle(half.mirrored()),
            Quantity::Energy => energy * part(self.encounter(energy).projectile(), half),
            Quantity::RecoilEnergy => energy * part(self.encounter(energy).target(), half.mirrored()),
            Quantity::ImpactParameter => f64::NAN,
        }
    }
    /// The value where nothing is deflected.
    pub(super) fn forward(&self, quantity: Quantity, energy: f64) -> f64 {
        self.value(quantity, energy, HalfAngle::of(0.0))
    }
    /// Whether the target may go back at a beam energy.
    pub(super) fn recoils_back(&self, energy: f64) -> bool {
        self.encounter(energy).target().circle().slow < 0.0
    }
    /// cot(ψ/2) where a laboratory angle is greatest, if it is that neither ahead nor head-on.
    pub(super) fn turning_point(&self, quantity: Quantity, energy: f64) -> Option<f64> {
        let of = |circle: Circle| (circle.slow > 0.0).then(|| (circle.slow / circle.fast).sqrt());
        match quantity {
            Quantity::LabAngle => of(self.encounter(energy).projectile().circle()),
            Quantity::RecoilAngle => of(self.encounter(energy).target().circle()).map(f64::recip),
            _ => None,
        }
    }
    /// The values of a quantity that no smaller deflection than that leads to, at any energy between two; none, (0, 0),
    /// where that is not told by the ends.
    pub(super) fn covered(&self, quantity: Quantity, energies: [f64; 2], half: HalfAngle) -> (f64, f64) {
        let values = energies.map(|energy| self.value(quantity, energy, half));
        let [least, greatest] = [values[0].min(values[1]), values[0].max(values[1])];
        // Of an angle that first grows from 0 with the deflection: a disc that ends before its greatest covers nothing
        // below that. At one deflection angles rise or fall with the energy: the ends tell.
        let growing = || {
            let reach = half.cotangent();
            let at = |energy: f64| {
                let turning = self.turning_point(quantity, energy).filter(|turning| *turning > reach);
                turning.map_or(0.0, |t| self.value(quantity, energy, HalfAngle::from_cotangent(t)))
            };
            (energies.map(at).into_iter().fold(greatest, f64::max), PI)
        };
        match quantity {
            Quantity::CmAngle => (least, PI),
            Quantity::LabAngle => growing(),
            Quantity::RecoilAngle => match energies.map(|energy| self.forward(quantity, energy)) {
                [0.0, 0.0] => growing(),
                [from, to] if from == to => (0.0, least),
                _ => (0.0, 0.0),
            },
            // V² + w² + 2Vw cos ψ: below π/2 it grows with the energy.
            Quantity::Energy
                if energies[0] == energies[1] || self.is_elastic() || half.cotangent() >= 1.0 =>
            {
                (0.0, least)
            }
            Quantity::Energy => (0.0, 0.0),
            // V² + w² - 2Vw cos ψ is convex in the energy, or grows: greatest at an end.
            Quantity::RecoilEnergy => (greatest, f64::INFINITY),
            Quantity::ImpactParameter => (0.0, f64::INFINITY),
        }
    }
}

impl Quantity {
    /// Whether it depends on what a channel does with the bodies.
    pub(super) fn is_of_channel(self) -> bool {
        !matches!(self, Self::CmAngle | Self::ImpactParameter)
    }
}
