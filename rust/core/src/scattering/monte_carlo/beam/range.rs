//! Which values a quantity can have, and which of them no impact parameter beyond the disc leads to.

use super::{Beam, Target};
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
            Quantity::RecoilAngle if self.profile.divergence.is_some() => Limits::angles("π", PI),
            Quantity::RecoilAngle => Limits::angles("π/2", FRAC_PI_2),
            Quantity::Energy | Quantity::RecoilEnergy => Limits::upto("beam_energy", self.highest()),
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
    /// The greatest value that a quantity can have, and what is to blame if it is none.
    fn greatest(&self, quantity: Quantity) -> (&'static str, f64) {
        match quantity {
            Quantity::CmAngle | Quantity::LabAngle => ("bins", PI),
            Quantity::RecoilAngle if self.profile.divergence.is_some() => ("bins", PI),
            Quantity::RecoilAngle => ("bins", FRAC_PI_2),
            Quantity::Energy => ("beam_energy", self.highest()),
            Quantity::RecoilEnergy => {
                ("masses", self.highest() * self.collision.transferred(HalfAngle::from_cotangent(0.0)))
            }
            Quantity::ImpactParameter => ("b_max", self.b_max),
        }
    }
    /// Half of an angle that no impact parameter beyond the disc exceeds, at any energy of the spread.
    pub(in crate::scattering::monte_carlo) fn edge(&self) -> HalfAngle {
        let [least, _] = self.profile.energies(self.energy);
        match &self.target {
            Target::Coulomb { reach, .. } => HalfAngle::from_cotangent(reach * (least / self.energy)),
            Target::Table(_, beyond) | Target::Tables(_, beyond) => HalfAngle::of(*beyond),
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
        let [least, highest] = self.profile.energies(self.energy);
        let half = self.edge();
        match quantity {
            Quantity::CmAngle => (self.value_of(quantity, least, half), PI),
            // Of a heavy projectile the angle first grows with b: a disc that ends before its greatest covers nothing
            // below that.
            Quantity::LabAngle => {
                let reach = half.cotangent();
                let greatest = self.collision.turning_point().filter(|turning| *turning > reach);
                let from = |t| self.collision.lab_angle(HalfAngle::from_cotangent(t));
                (greatest.map_or_else(|| self.collision.lab_angle(half), from), PI)
            }
            Quantity::RecoilAngle | Quantity::Energy => (0.0, self.value_of(quantity, least, half)),
            // The most that is lost beyond the disc, at any energy.
            Quantity::RecoilEnergy => (self.value_of(quantity, highest, half), highest),
            Quantity::ImpactParameter => (0.0, self.b_max),
        }
    }
}
