//! Which values a quantity can have, and which of them no impact parameter beyond the disc leads to.

use super::{Beam, Exit, Target};
use crate::scattering::bins::Bins;
use crate::scattering::histogram::Edges;
use crate::scattering::kinematics::HalfAngle;
use crate::scattering::monte_carlo::quantity::Quantity;
use crate::scattering::reach::Limits;
use crate::words::number;
use crate::{Error, Result};
use core::f64::consts::{FRAC_PI_2, PI};

impl Beam {
    /// The numbers that edges of a quantity may be, and what they are called.
    pub(in crate::scattering) fn limits(&self, quantity: Quantity) -> Limits {
        match quantity {
            Quantity::CmAngle | Quantity::LabAngle => Limits::angles("π", PI),
            Quantity::RecoilAngle if self.recoils_back() => Limits::angles("π", PI),
            Quantity::RecoilAngle => Limits::angles("π/2", FRAC_PI_2),
            Quantity::Energy | Quantity::RecoilEnergy => {
                let (beam, greatest) = (self.highest(), self.greatest(quantity).1);
                // What is released is added.
                if greatest > beam {
                    Limits::upto("the greatest energy", greatest)
                } else {
                    Limits::upto("beam_energy", beam)
                }
            }
            // Beyond the disc no bin could count anything.
            Quantity::ImpactParameter => Limits::upto("b_max", self.b_max),
        }
    }
    /// Bins of a quantity.
    ///
    /// # Errors
    /// `InvalidInput` naming the quantity, for what are no bins and for edges that it can never reach; or what makes the
    /// greatest value too small to divide.
    pub fn edges(&self, quantity: Quantity, bins: &Bins) -> Result<Edges> {
        let (blamed, high) = self.greatest(quantity);
        if let Bins::Count(bins) = bins
            && high / (*bins as f64) < f64::MIN_POSITIVE
        {
            return Err(Error::invalid(
                blamed,
                format!(
                    "expected a greatest {} that can be divided into bins, got {}; choose larger units, or \
                     leave this tally out",
                    quantity.name(),
                    number(high)
                ),
            ));
        }
        let edges = bins.edges(quantity.name(), quantity.is_angle(), high)?;
        self.limits(quantity).check(quantity.name(), edges.values())?;
        Ok(edges)
    }
    /// Whether anything that was hit may go back.
    fn recoils_back(&self) -> bool {
        let energies = self.profile.energies(self.energy);
        self.profile.divergence.is_some()
            || self.exits.iter().any(|exit| energies.iter().any(|energy| exit.recoils_back(*energy)))
    }
    /// The greatest value that a quantity can have, and what is to blame if it is none.
    pub(in crate::scattering::monte_carlo) fn greatest(&self, quantity: Quantity) -> (&'static str, f64) {
        let most = |half: HalfAngle| {
            let of = |exit: &Exit| exit.value(quantity, self.highest(), half);
            self.exits.iter().map(of).fold(0.0, f64::max)
        };
        match quantity {
            Quantity::CmAngle | Quantity::LabAngle => ("bins", PI),
            Quantity::RecoilAngle if self.recoils_back() => ("bins", PI),
            Quantity::RecoilAngle => ("bins", FRAC_PI_2),
            Quantity::Energy => ("beam_energy", most(HalfAngle::of(0.0))),
            Quantity::RecoilEnergy => ("masses", most(HalfAngle::from_cotangent(0.0))),
            Quantity::ImpactParameter => ("b_max", self.b_max),
        }
    }
    /// Half of an angle that no impact parameter beyond the disc exceeds, at any energy of the spread.
    pub(in crate::scattering::monte_carlo) fn edge(&self) -> HalfAngle {
        let [least, _] = self.profile.energies(self.energy);
        match &self.target {
            Target::Coulomb { reach, .. } => HalfAngle::from_cotangent(reach * (least / self.energy)),
            Target::Table(_, beyond) | Target::Tables(_, beyond) | Target::Direct(_, beyond) => {
                HalfAngle::of(*beyond)
            }
        }
    }
    /// The deflection at the edge of the disc, or the greatest beyond: of V = k/r no event is scattered by less.
    pub fn smallest_angle(&self) -> f64 {
        if let (Target::Coulomb { reach, .. }, [_, highest]) =
            (&self.target, self.profile.energies(self.energy))
        {
            return HalfAngle::from_cotangent(reach * (highest / self.energy)).cm_angle();
        }
        self.edge().cm_angle()
    }
    /// The values of a quantity that no impact parameter beyond the disc leads to: what this beam counts there
    /// is all that there is. None of an angle that the directions of a beam smear, and none where the disc is not filled
    /// evenly.
    pub fn covered(&self, quantity: Quantity) -> (f64, f64) {
        let smeared = self.profile.divergence.is_some()
            && matches!(quantity, Quantity::LabAngle | Quantity::RecoilAngle);
        if smeared || self.profile.spot.is_some() {
            return (0.0, 0.0);
        }
        let energies = self.profile.energies(self.energy);
        let (mut low, mut high) = (0.0_f64, self.limits(quantity).high);
        for exit in self.exits.iter() {
            let other = exit.covered(quantity, energies, self.edge());
            (low, high) = (low.max(other.0), high.min(other.1));
        }
        if low < high { (low, high) } else { (0.0, 0.0) }
    }
    /// Whether a bin holds what is not deflected at all, in some channel. A disc that ends where V does has none of those,
    /// and leaves none out that is deflected.
    pub(in crate::scattering) fn ends_forward(&self, quantity: Quantity, from: f64, to: f64) -> bool {
        quantity != Quantity::ImpactParameter
            && !self.whole
            && self.exits.iter().any(|exit| {
                let ends = self.profile.energies(self.energy).map(|energy| exit.forward(quantity, energy));
                from <= ends[0].max(ends[1]) && to >= ends[0].min(ends[1])
            })
    }
    /// Whether every bin below the covered values is one of impact parameters next to the edge of the disc: where angles
    /// fall with b, and all events have one energy and one channel.
    pub(in crate::scattering) fn falls(&self) -> bool {
        let elastic = matches!(*self.exits, [Exit::Elastic(_)]);
        self.is_coulomb() && self.profile.energy_spread.is_none() && elastic
    }
}
