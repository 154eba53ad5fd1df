//! V = k φ(r/length)/r: two nuclei and the electrons between them.

use super::parameters::{Declaration, Kind, Parameter, Value};
use super::screening::{NAMES, Screening};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};

/// V = k φ(r/length)/r.
#[derive(Clone, Debug)]
pub struct ScreenedCoulomb {
    k: f64,
    inverse_length: f64,
    screening: Screening,
    /// Of its name among all.
    place: u64,
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "screened_coulomb",
    class_name: "ScreenedCoulomb",
    summary: "Two nuclei, screened by their electrons",
    formula: "V(r) = k phi(r / length) / r",
    notes: "phi is the universal function of Ziegler, Biersack and Littmark (zbl), that of Moliere, the average krypton-\
            carbon one of Wilson, Haggmark and Biersack (kr_c), that of Lenz and Jensen as they wrote it, or the solution \
            of the equation of Thomas and Fermi, to the precision of numbers. phi(0) = 1 but for rounding of the published \
            digits. `ScreenedCoulomb.between` makes one of two atomic numbers.",
    source: "J. F. Ziegler, J. P. Biersack, U. Littmark, The Stopping and Range of Ions in Solids (1985); W. D. Wilson, \
             L. G. Haggmark, J. P. Biersack, Phys. Rev. B 15 (1977) 2458; G. Moliere, Z. Naturforsch. A 2 (1947) 133; \
             H. Jensen, Z. Phys. 77 (1932) 722; S. Esposito, Am. J. Phys. 70 (2002) 852",
    example: ">>> vv.potentials.ScreenedCoulomb.between(18, 29).value(0.5).round(3)\n\
              np.float64(1015.636)",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::number("k", [3, 1, -2], "Product of the charges, energy times length"),
        Parameter::positive("length", [1, 0, 0], "Screening length"),
        Parameter::new("screening", Kind::Choice(&NAMES), "Name of phi").or(0.0),
    ],
    make: held::<ScreenedCoulomb>,
};

impl ScreenedCoulomb {
    #[inline(always)]
    fn lengths<S: Analytic>(own: &Numbers<S>, r: S) -> S {
        r * own[1]
    }
}

impl Formula for ScreenedCoulomb {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = true;

    fn new(values: &[Value]) -> Self {
        let word = values[2].word();
        let place = NAMES.iter().position(|name| *name == word).unwrap_or(0) as u64;
        let inverse_length = (1.0 / values[1].number()).min(f64::MAX);
        Self { k: values[0].number(), inverse_length, place, screening: Screening::of(word) }
    }

    fn numbers(&self) -> Numbers<f64> {
        [self.k, self.inverse_length, 0.0, 0.0, 0.0]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(vec![self.place])
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[0] * self.screening.value(Self::lengths(own, r)) / r
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[0] * self.screening.with_slope(Self::lengths(own, r)) / r / r
    }
    #[inline(always)]
    fn over_distance<S: Analytic>(&self, own: &Numbers<S>, r2: S) -> S {
        let r = r2.sqrt();
        own[0] * self.screening.with_slope(Self::lengths(own, r)) / (r2 * r)
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[0] * self.screening.with_bend(Self::lengths(own, r)) / r / r / r
    }
    #[inline(always)]
    fn all<S: Analytic>(&self, own: &Numbers<S>, r: S) -> [S; 3] {
        let [value, slope, bend] = self.screening.all(Self::lengths(own, r));
        [own[0] * value / r, own[0] * slope / r / r, own[0] * bend / r / r / r]
    }
}
