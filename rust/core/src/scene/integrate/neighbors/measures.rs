//! The sizes of units, by which small differences of them are measured.

use crate::numerics::element::{Element, Pass, View};
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::scene::layout::Layout;

/// The size of places and velocities of a unit, by which differences of them are measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Size {
    pub(super) place: f64,
    pub(super) velocity: f64,
    /// Whether they are those of the whole motion, and not of its start.
    pub(super) of_motion: bool,
}

/// Those of the units in lanes.
#[derive(Clone, Copy)]
pub(super) struct Measures {
    /// One over the size of a distance and of a velocity.
    of: [Lanes; 2],
    /// Whether the lanes are bodies of one unit.
    together: bool,
}

impl Measures {
    pub(super) fn new(layout: Layout, sizes: &[Size]) -> Self {
        let mut of = [Lanes::one(); 2];
        for (lane, size) in sizes.iter().enumerate() {
            let lanes = layout.mask(lane);
            for (measure, size) in of.iter_mut().zip([size.place, size.velocity]) {
                *measure = Lanes::select(lanes, Lanes::splat(1.0 / size), *measure);
            }
        }
        Self { of, together: layout == Layout::Packed }
    }

    /// The sizes of a place and of a velocity.
    pub(super) fn sizes(&self) -> [Lanes; 2] {
        self.of.map(|measure| Lanes::one() / measure)
    }

    /// The lengths of differences, of places and, where they are known, velocities.
    pub(super) fn length(&self, places: &[Lanes], velocities: &[Lanes]) -> Lanes {
        let [of_places, of_velocities] = &self.of;
        self.root(
            Lanes::pass(Square { of: places, measure: of_places })
                + Lanes::pass(Square { of: velocities, measure: of_velocities }),
        )
    }

    /// How large numbers of a unit are together.
    pub(super) fn size(&self, of: &[Lanes]) -> Lanes {
        self.root(Lanes::pass(Square { of, measure: &Lanes::one() }))
    }

    /// The root of a sum of squares over a unit.
    pub(super) fn root(&self, squares: Lanes) -> Lanes {
        if self.together { Lanes::splat(squares.0.iter().sum::<f64>().sqrt()) } else { squares.sqrt() }
    }
}

/// The sum of squares of numbers, each times the measure.
struct Square<'a, S> {
    of: &'a [S],
    measure: &'a S,
}

impl<S: Element> Pass<S> for Square<'_, S> {
    type Output = S;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S {
        let measure = *V::view_one(self.measure);
        let mut sum = V::zero();
        for &number in V::view(self.of) {
            let number = number * measure;
            sum = number.multiply_add(number, sum);
        }
        sum.store()
    }
}
