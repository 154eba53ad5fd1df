//! What electrons take of a fast ion on its way: energy per length, in eV/Å.
//!
//! Slow ions lose as their speed (Lindhard & Scharff), fast ones as Bethe found; between, 1/S is the sum of both
//! inverses, with the logarithm of Bethe's formula continued so that it stays positive (Biersack & Haggmark). Of several
//! elements the losses add (Bragg).
//! Sources: J. Lindhard, M. Scharff, Phys. Rev. 124 (1961) 128; H. Bethe, Ann. Phys. 397 (1930) 325, with ln γ² − β² of
//! Fano, Annu. Rev. Nucl. Sci. 13 (1963) 1, eq. 17; J. P. Biersack, L. G. Haggmark, Nucl. Instrum. Methods 174 (1980)
//! 257, eqs. 12–14. Constants: CODATA 2018.

use crate::numerics::elementary::{Exponential, cbrt, ln};
use crate::words::{number, unknown};
use crate::{Error, Result};
use core::f64::consts::{E, PI};

/// e²/4πε₀ in eV Å.
const CHARGE_SQUARED: f64 = 14.399_645_478;
/// The electron's rest energy in eV.
const ELECTRON: f64 = 510_998.95;
/// That of the atomic mass unit.
const MASS_UNIT: f64 = 931_494_102.42;
/// Bohr's radius in Å.
const BOHR_RADIUS: f64 = 0.529_177_210_903;
/// Bohr's speed over that of light.
const FINE_STRUCTURE: f64 = 7.297_352_569_3e-3;

/// Which formula.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Model {
    /// No loss.
    Nothing,
    /// In proportion to the speed, for ions slower than the electrons that they strip.
    LindhardScharff,
    /// For ions faster than the electrons; below its greatest value, at 2mv² = e·I, in proportion to the speed.
    Bethe,
    /// 1/S as the sum of both, Bethe's logarithm continued.
    Joined,
}

impl Model {
    /// All of them, with their names.
    pub const ALL: [(&'static str, Self); 4] = [
        ("none", Self::Nothing),
        ("lindhard_scharff", Self::LindhardScharff),
        ("bethe", Self::Bethe),
        ("joined", Self::Joined),
    ];
    /// By name.
    ///
    /// # Errors
    /// `InvalidInput` naming `stopping`.
    pub fn named(name: &str) -> Result<Self> {
        Self::ALL
            .iter()
            .find(|(known, _)| *known == name)
            .map(|(_, model)| *model)
            .ok_or_else(|| unknown("stopping", name, Self::ALL.iter().map(|(known, _)| *known)))
    }
    /// Whether it asks for mean excitation energies.
    pub fn needs_excitation(self) -> bool {
        matches!(self, Self::Bethe | Self::Joined)
    }
}

/// What loses energy.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projectile {
    /// Its atomic number.
    pub atomic_number: f64,
    /// Its mass in u.
    pub mass: f64,
}

impl Projectile {
    /// In eV.
    pub(super) fn rest_energy(self) -> f64 {
        self.mass * MASS_UNIT
    }
}

/// The atoms of one element whose electrons take it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Atoms {
    /// Their atomic number.
    pub atomic_number: f64,
    /// How many in an Å³.
    pub density: f64,
    /// Their mean excitation energy in eV; NaN if it is not known.
    pub excitation: f64,
}

/// What electrons take: a formula, or what was measured.
#[derive(Clone, Debug, PartialEq)]
pub enum Stopping {
    /// Of a model.
    Formula(Model),
    /// Energies in eV, increasing, and the losses there in eV/Å: between them straight lines of the logarithms, below the
    /// first in proportion to the speed.
    Table(Vec<[f64; 2]>),
}

impl Stopping {
    /// Whether nothing is taken.
    pub(super) fn is_nothing(&self) -> bool {
        *self == Self::Formula(Model::Nothing)
    }
    /// Refuses what is no table.
    ///
    /// # Errors
    /// `InvalidInput` naming `stopping`.
    pub(super) fn check(&self) -> Result<()> {
        let Self::Table(rows) = self else { return Ok(()) };
        let positive = |row: &[f64; 2]| row.iter().all(|x| *x > 0.0 && x.is_finite());
        if rows.len() >= 2 && rows.iter().all(positive) && rows.windows(2).all(|two| two[0][0] < two[1][0]) {
            return Ok(());
        }
        Err(Error::invalid(
            "stopping",
            "expected two or more increasing energies, and a positive loss at each",
        ))
    }
    /// Refuses what it lacks: mean excitation energies, or a table as far as that energy.
    ///
    /// # Errors
    /// `InvalidInput` naming `mean_excitation_energy` or `stopping`.
    pub(super) fn reaches(&self, atoms: &[Atoms], energy: f64) -> Result<()> {
        match self {
            Self::Table(rows) => match rows.last() {
                Some([last, _]) if *last < energy => Err(Error::invalid(
                    "stopping",
                    format!(
                        "expected losses up to {}, got a table that ends at {}",
                        number(energy),
                        number(*last)
                    ),
                )),
                _ => Ok(()),
            },
            Self::Formula(model) => match atoms.iter().find(|atoms| atoms.excitation.is_nan()) {
                Some(atoms) if model.needs_excitation() => Err(Error::invalid(
                    "mean_excitation_energy",
                    format!(
                        "expected that of atomic number {}, which the stopping 'bethe' and 'joined' need, got None; \
                         give it in eV, or choose 'lindhard_scharff' or 'none'",
                        atoms.atomic_number
                    ),
                )),
                _ => Ok(()),
            },
        }
    }
    /// The loss in eV/Å at an energy in eV.
    pub(super) fn loss(&self, ion: Projectile, atoms: &[Atoms], energy: f64) -> f64 {
        match self {
            Self::Formula(model) => loss(*model, ion, atoms, energy),
            Self::Table(rows) => tabulated(rows, energy),
        }
    }
}

fn tabulated(rows: &[[f64; 2]], energy: f64) -> f64 {
    let after = rows.partition_point(|row| row[0] <= energy).min(rows.len() - 1);
    let Some(before) = after.checked_sub(1) else { return rows[0][1] * (energy / rows[0][0]).sqrt() };
    let ([from, low], [to, high]) = (rows[before], rows[after]);
    let part = ln(energy / from) / ln(to / from);
    low * Exponential::exp(part * ln(high / low))
}

/// The loss in eV/Å at an energy in eV.
fn loss(model: Model, ion: Projectile, atoms: &[Atoms], energy: f64) -> f64 {
    let part = energy / ion.rest_energy();
    // β²γ² is kept apart from β²: neither cancels for slow ions.
    let impulse = part * (part + 2.0);
    let beta2 = impulse / ((1.0 + part) * (1.0 + part));
    let of_one = |atoms: &Atoms| {
        let cross_section = match model {
            Model::Nothing => 0.0,
            Model::LindhardScharff => lindhard_scharff(ion, atoms, beta2),
            Model::Bethe => bethe(ion, atoms, beta2, impulse),
            Model::Joined => {
                let (slow, fast) =
                    (lindhard_scharff(ion, atoms, beta2), continued(ion, atoms, beta2, 1.0 + part));
                // What is fast alone may overflow where nothing else does.
                slow / (1.0 + slow / fast)
            }
        };
        atoms.density * cross_section
    };
    atoms.iter().map(of_one).sum()
}

/// 8π e² a₀ Z₁^(1/6) Z₁ Z₂/(Z₁^⅔ + Z₂^⅔)^{3/2} · v/v₀.
fn lindhard_scharff(ion: Projectile, atoms: &Atoms, beta2: f64) -> f64 {
    let (z1, z2) = (ion.atomic_number, atoms.atomic_number);
    let (root1, root2) = (cbrt(z1), cbrt(z2));
    let sum = root1 * root1 + root2 * root2;
    let strength = root1.sqrt() * z1 * z2 / (sum * sum.sqrt());
    8.0 * PI * CHARGE_SQUARED * BOHR_RADIUS * strength * beta2.sqrt() / FINE_STRUCTURE
}

/// 4π e⁴ Z₁² Z₂/(m v²), to be multiplied by a logarithm.
fn before_logarithm(ion: Projectile, atoms: &Atoms, beta2: f64) -> f64 {
    let strength = CHARGE_SQUARED * ion.atomic_number;
    4.0 * PI * strength * strength * atoms.atomic_number / (ELECTRON * beta2)
}

/// With ln(2mv²γ²/I) − β².
fn bethe(ion: Projectile, atoms: &Atoms, beta2: f64, impulse: f64) -> f64 {
    let with = |beta2: f64, impulse: f64| {
        before_logarithm(ion, atoms, beta2) * (ln(2.0 * ELECTRON * impulse / atoms.excitation) - beta2)
    };
    let peak = E * atoms.excitation / (2.0 * ELECTRON);
    if beta2 >= peak { with(beta2, impulse) } else { with(peak, peak / (1.0 - peak)) * (beta2 / peak).sqrt() }
}

/// With ln(ε + 1 + C/ε) + ln γ² − β², ε = 2mv²/I, C = 100 Z₁/Z₂ for Z₁ < 3, else 5.
fn continued(ion: Projectile, atoms: &Atoms, beta2: f64, gamma: f64) -> f64 {
    let constant =
        if ion.atomic_number < 3.0 { 100.0 * ion.atomic_number / atoms.atomic_number } else { 5.0 };
    let ratio = 2.0 * ELECTRON * beta2 / atoms.excitation;
    let logarithm = ln(ratio + 1.0 + constant / ratio) + 2.0 * ln(gamma) - beta2;
    before_logarithm(ion, atoms, beta2) * logarithm
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_are_straight_in_logarithms() {
        let table = Stopping::Table(vec![[1e3, 2.0], [1e5, 8.0], [1e6, 4.0]]);
        let at = |energy| table.loss(ALPHA, &[], energy);
        assert!((at(1e4) - 4.0).abs() < 1e-14 && at(1e3) == 2.0 && (at(1e6) - 4.0).abs() < 1e-14);
        assert!((at(250.0) - 1.0).abs() < 1e-15 && table.check().is_ok());
        assert!(table.reaches(&[], 1e6).is_ok() && table.reaches(&[], 1.01e6).is_err());
        assert!(Stopping::Table(vec![[1.0, 1.0], [1.0, 2.0]]).check().is_err());
        assert!(Stopping::Table(vec![[1.0, 1.0], [2.0, 0.0]]).check().is_err());
    }

    const ALPHA: Projectile = Projectile { atomic_number: 2.0, mass: 4.001_506_179 };
    const GOLD: Atoms = Atoms { atomic_number: 79.0, density: 0.059_07, excitation: 790.0 };

    /// 1.212 Z₁^(7/6) Z₂ (Z₁^⅔ + Z₂^⅔)^(−3/2) √(E/M) as Biersack and Haggmark print it: their number
    /// takes a nucleon of 1.007 u for the unit, which is 0.33 %.
    #[test]
    fn slow_ions_as_printed() {
        let found = loss(Model::LindhardScharff, ALPHA, &[GOLD], 1e4) / GOLD.density;
        let (z1, z2) = (2.0_f64, 79.0_f64);
        let printed = 1.212 * z1.powf(7.0 / 6.0) * z2 / (z1.powf(2.0 / 3.0) + z2.powf(2.0 / 3.0)).powf(1.5)
            * (1e4 / ALPHA.mass).sqrt();
        assert!((found / printed - 1.0).abs() < 4e-3, "{found} {printed}");
    }
    #[test]
    fn bethe_is_continued_without_a_step() {
        let peak = E * 790.0 / (2.0 * ELECTRON);
        let energy = |beta2: f64| (1.0 / (1.0 - beta2).sqrt() - 1.0) * ALPHA.mass * MASS_UNIT;
        let [below, above] =
            [1.0 - 1e-9, 1.0 + 1e-9].map(|part| loss(Model::Bethe, ALPHA, &[GOLD], energy(peak * part)));
        assert!((below / above - 1.0).abs() < 1e-8, "{below} {above}");
    }
    #[test]
    fn joined_tends_to_both() {
        let both = |energy| {
            [Model::Joined, Model::LindhardScharff, Model::Bethe].map(|m| loss(m, ALPHA, &[GOLD], energy))
        };
        let slow = both(10.0);
        assert!((slow[0] / slow[1] - 1.0).abs() < 1e-3, "{slow:?}");
        let slowest = both(1e-300);
        assert_eq!(slowest[0].to_bits(), slowest[1].to_bits(), "{slowest:?}");
        assert!(both(5e-324).iter().all(|loss| *loss >= 0.0));
        let fast = both(1e9);
        assert!((fast[0] / fast[2] - 1.0).abs() < 0.01, "{fast:?}");
    }
}
