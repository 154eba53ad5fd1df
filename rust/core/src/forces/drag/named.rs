//! Laws of drag by the names of those who found them; C is the coefficient of D = ½ C ρ π a² v², and Re = 2R the Reynolds
//! number with the diameter, as they wrote it.
//!
//! - Schiller and Naumann: C = (24/Re)(1 + 0.15 Re^0.687), and the constant 0.44 from where it is the larger one, Re near
//!   1000. L. Schiller, A. Naumann, Z. Ver. Dtsch. Ing. 77 (1933) 318.
//! - Clift and Gauvin: C = (24/Re)(1 + 0.15 Re^0.687) + 0.42/(1 + 42500 Re^−1.16). R. Clift, W. H. Gauvin, Can. J. Chem.
//!   Eng. 49 (1971) 439.
//! - Turton and Levenspiel: C = (24/Re)(1 + 0.173 Re^0.657) + 0.413/(1 + 16300 Re^−1.09), fitted to 408 measurements.
//!   R. Turton, O. Levenspiel, Powder Technol. 47 (1986) 83.
//! - Stokes: C = 24/Re.

use super::{AT_REST, DENSITY_PARAMETER, Law, ONE_WAY, RADIUS_PARAMETER, VISCOSITY_PARAMETER, spheres};
use crate::error::Error;
use crate::forces::term::ForceDeclaration;
use crate::numerics::power::Power;
use crate::potentials::Analytic;
use crate::potentials::parameters::{Declaration, Kind, Parameter};

/// The words for them; the first is the default.
static NAMES: [&str; 4] = ["schiller_naumann", "clift_gauvin", "turton_levenspiel", "stokes"];
/// Where the flow at the surface of a sphere becomes turbulent, with the radius: drag falls to a third there.
const CRISIS: f64 = 1e5;

/// What it declares about itself.
pub static DECLARATION: ForceDeclaration = Declaration {
    name: "drag",
    class_name: "Drag",
    summary: "Drag of spheres in a fluid at rest, by a law that holds at every Reynolds number up to 1e5",
    formula: "F = −F(R) density radius² |v| v with R = density radius |v| / viscosity",
    notes: "F(R) is 6π/R at small R, where drag is linear, and nearly constant from 1e3 on, where it is quadratic. Beyond \
            R = 1e5, where the flow at the surface becomes turbulent, there is no value: bodies as fast as that are refused, \
            and a run that comes there ends with `Status.OUTSIDE_DOMAIN`; `stokes` is taken at any R. For laws of one's own \
            there are `visviva.drag.custom` and `visviva.drag.tabulated`. It has no potential energy and conserves nothing. \
            A body that feels it must have mass.",
    source: "L. Schiller, A. Naumann, Z. Ver. Dtsch. Ing. 77 (1933) 318, with 0.44 from where it is larger; R. Clift, W. H. \
             Gauvin, Can. J. Chem. Eng. 49 (1971) 439; R. Turton, O. Levenspiel, Powder Technol. 47 (1986) 83; Landau & \
             Lifshitz, Fluid Mechanics, 2nd ed., section 20",
    example: ">>> drop = vv.Particles([1.0], [[0.0, 0.0, 0.0]], [[0.0, 0.0, -20.0]])\n\
              >>> air = vv.Drag(density=1.0, viscosity=1.0, radius=0.5)\n\
              >>> vv.Scene(drop, air).acceleration()[0, 2].round(6)  # at R = 10\n\
              np.float64(409.906965)",
    at_rest: AT_REST,
    one_way: ONE_WAY,
    parameters: &[
        DENSITY_PARAMETER,
        VISCOSITY_PARAMETER,
        RADIUS_PARAMETER,
        Parameter::new("law", Kind::Choice(&NAMES), "The name of F(R)").or(0.0),
    ],
    make: |values| match values {
        [density, viscosity, radius, law] => {
            Ok(spheres(Named::of(law.word()), density.number(), viscosity.number(), radius.numbers()))
        }
        _ => Err(Error::Internal("Drag takes four parameters".to_owned())),
    },
};

/// A law with a name.
#[derive(Clone, Copy, Debug)]
enum Named {
    SchillerNaumann,
    /// (24/Re)(1 + factor Re^rise) + most/(1 + late Re^−fall).
    Sum {
        factor: f64,
        rise: f64,
        most: f64,
        late: f64,
        fall: f64,
    },
    Stokes,
}

impl Named {
    fn of(name: &str) -> Self {
        match name {
            "clift_gauvin" => Self::Sum { factor: 0.15, rise: 0.687, most: 0.42, late: 42_500.0, fall: 1.16 },
            "turton_levenspiel" => {
                Self::Sum { factor: 0.173, rise: 0.657, most: 0.413, late: 16_300.0, fall: 1.09 }
            }
            "stokes" => Self::Stokes,
            _ => Self::SchillerNaumann,
        }
    }
}

impl Law for Named {
    const DECLARATION: &'static ForceDeclaration = &DECLARATION;

    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(match *self {
            Self::SchillerNaumann => vec![0],
            Self::Sum { factor, rise, most, late, fall } => {
                [factor, rise, most, late, fall].map(f64::to_bits).to_vec()
            }
            Self::Stokes => vec![1],
        })
    }
    fn last(&self) -> f64 {
        if matches!(self, Self::Stokes) { f64::INFINITY } else { CRISIS }
    }

    /// Re C/24.
    #[inline(always)]
    fn factor<S: Analytic>(&self, reynolds: S) -> S {
        let of_diameter = reynolds + reynolds;
        match *self {
            Self::SchillerNaumann => {
                let rising = S::splat(0.15) * of_diameter.power(&Power::new(0.687));
                (S::one() + rising).max(S::splat(0.44 / 24.0) * of_diameter)
            }
            Self::Sum { factor, rise, most, late, fall } => {
                let rising = S::one() + S::splat(factor) * of_diameter.power(&Power::new(rise));
                let share = S::one() + S::splat(late) * of_diameter.power(&Power::new(-fall));
                rising + S::splat(most / 24.0) * of_diameter / share
            }
            Self::Stokes => S::one(),
        }
    }
}
