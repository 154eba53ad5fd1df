//! V = k (1 − r/radius)ⁿ where spheres overlap.

use super::parameters::{Declaration, Parameter, Value};
use super::{Analytic, Formula, Numbers, PotentialDeclaration, held};
use crate::error::{Error, Result};
use crate::numerics::power::Power;
use crate::numerics::real::Mask;
use crate::words::number;

/// V = k (1 − r/radius)ⁿ up to the radius, and nothing beyond.
#[derive(Clone, Copy, Debug)]
pub struct SoftSphere {
    k: f64,
    radius: f64,
    n: f64,
    /// The powers n, n − 1 and n − 2 of the overlap.
    powers: [Power; 3],
}

/// What it declares about itself.
pub static DECLARATION: PotentialDeclaration = Declaration {
    name: "soft_sphere",
    class_name: "SoftSphere",
    summary: "The potential energy of elastic spheres in contact",
    formula: "V(r) = k (1 - r / radius)^n where r < radius, else 0",
    notes: "n = 2 is a linear spring, n = 5/2 the contact of Hertz. Derivatives above the n-th jump at r = radius, by \
            which methods of high order lose some of it. At r = 0 the force has no direction and is taken as none.",
    source: "C. S. O'Hern, L. E. Silbert, A. J. Liu, S. R. Nagel, Phys. Rev. E 68 (2003) 011306; H. Hertz, J. reine \
             angew. Math. 92 (1882) 156",
    example: ">>> vv.potentials.SoftSphere(k=8.0, radius=2.0, n=2.5).value([0.0, 1.5, 3.0])\narray([8.  , 0.25, 0.  ])",
    at_rest: "",
    one_way: "",
    parameters: &[
        Parameter::positive("k", [2, 1, -2], "Energy at r = 0"),
        Parameter::positive("radius", [1, 0, 0], "Distance of the centers at contact"),
        Parameter::positive("n", [0, 0, 0], "Exponent, at least 2"),
    ],
    make: |values| {
        check(values[2].number())?;
        held::<SoftSphere>(values)
    },
};

fn check(n: f64) -> Result<()> {
    if n >= 2.0 {
        return Ok(());
    }
    let message = format!(
        "expected at least 2, as a force whose slope is infinite cannot be followed, got {}",
        number(n)
    );
    Err(Error::invalid("n", message))
}

impl SoftSphere {
    /// 1 − r/radius, nothing beyond.
    #[inline(always)]
    fn overlap<S: Analytic>(own: &Numbers<S>, r: S) -> S {
        let radius = own[1];
        let overlap = (radius - r) / radius;
        // What is no number stays none.
        S::select(overlap.less(S::zero()), S::zero(), overlap)
    }
}

impl Formula for SoftSphere {
    const DECLARATION: &'static PotentialDeclaration = &DECLARATION;
    const SINGULAR: bool = false;

    fn new(values: &[Value]) -> Self {
        let n = values[2].number();
        let powers = [Power::new(n), Power::new(n - 1.0), Power::new(n - 2.0)];
        Self { k: values[0].number(), radius: values[1].number(), n, powers }
    }

    fn numbers(&self) -> Numbers<f64> {
        [self.k, self.radius, 0.0, 0.0, 0.0]
    }
    fn in_every_lane(&self) -> Option<Vec<u64>> {
        Some(vec![self.n.to_bits()])
    }

    fn breaks(&self) -> Vec<f64> {
        vec![self.radius]
    }

    #[inline(always)]
    fn value<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        own[0] * Self::overlap(own, r).part_power(&self.powers[0])
    }
    #[inline(always)]
    fn force<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let radius = own[1];
        own[0] * (S::splat(self.n) * Self::overlap(own, r).part_power(&self.powers[1])) / radius
    }
    #[inline(always)]
    fn curvature<S: Analytic>(&self, own: &Numbers<S>, r: S) -> S {
        let (radius, overlap) = (own[1], Self::overlap(own, r));
        let power = S::splat(self.n * (self.n - 1.0)) * overlap.part_power(&self.powers[2]);
        // The zeroth power is one in contact only.
        let power = S::select(overlap.less_equal(S::zero()), S::zero(), power);
        own[0] * power / radius / radius
    }
    /// Nothing, without a root, where no two of the lanes touch, as nearly always.
    #[inline(always)]
    fn over_distance<S: Analytic>(&self, own: &Numbers<S>, r2: S) -> S {
        let apart = (own[1] * own[1]).less_equal(r2);
        if apart.all() {
            return S::zero();
        }
        let r = r2.sqrt();
        let middle = r2.less_equal(S::zero());
        let pull = self.force(own, r) / r;
        let pull = if middle.any() { S::select(middle, -self.curvature(own, r), pull) } else { pull };
        S::select(apart, S::zero(), pull)
    }
}
