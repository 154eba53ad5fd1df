//! What a Monte Carlo counts of an event.

use crate::Result;
use crate::words::unknown;

/// What is tallied.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The scattering angle in the centre-of-mass frame, |ψ| in [0, π].
    CmAngle,
    /// The laboratory angle of the projectile, in [0, π].
    LabAngle,
    /// The laboratory angle of the target, in [0, π/2].
    RecoilAngle,
    /// The energy of the projectile afterwards.
    Energy,
    /// The energy of the target afterwards.
    RecoilEnergy,
    /// The impact parameter.
    ImpactParameter,
}

impl Quantity {
    /// All of them, with their names.
    pub const ALL: [(&'static str, Self); 6] = [
        ("cm_angle", Self::CmAngle),
        ("lab_angle", Self::LabAngle),
        ("recoil_angle", Self::RecoilAngle),
        ("energy", Self::Energy),
        ("recoil_energy", Self::RecoilEnergy),
        ("impact_parameter", Self::ImpactParameter),
    ];
    /// By name.
    ///
    /// # Errors
    /// `InvalidInput` naming `tally`.
    pub fn named(name: &str) -> Result<Self> {
        Self::ALL
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, quantity)| *quantity)
            .ok_or_else(|| unknown("tally", name, Self::ALL.iter().map(|(known, _)| *known)))
    }
    /// Whether it tells how a body's direction lies to the axis of the beam.
    pub(super) fn is_of_directions(self) -> bool {
        matches!(self, Self::LabAngle | Self::RecoilAngle)
    }
    /// Its name.
    pub fn name(self) -> &'static str {
        Self::ALL.iter().find(|(_, quantity)| *quantity == self).map_or("", |(name, _)| name)
    }
}
