//! Which boxes meet: sorted along the axis on which they are spread most, each is compared with those that begin within it.

use crate::numerics::lanes::{Bits, Lanes, Vector8, WIDTH, as_numbers_mut};
use crate::numerics::real::Mask;
use crate::tiered;

/// So few boxes are compared each with each other: to sort them would take longer.
const FEW: usize = 12;

/// A box, low and high along three axes.
type Box3 = [[f64; 2]; 3];

/// Boxes in the order in which they begin along an axis.
struct Sorted {
    boxes: Vec<Box3>,
    indices: Vec<usize>,
    /// Where they begin along that axis.
    begins: Vec<f64>,
    /// Low and high along one of the others, then along the third, eight boxes to each.
    across: [Vec<Lanes>; 4],
}

impl Sorted {
    fn new(boxes: &[Box3], axis: usize, takes: impl Fn(usize) -> bool) -> Self {
        // What is no number meets nobody.
        let told = |own: &Box3| !(own[axis][0].is_nan() || own[axis][1].is_nan());
        let mut indices: Vec<usize> = (0..boxes.len()).filter(|&i| takes(i) && told(&boxes[i])).collect();
        indices.sort_by(|&a, &b| boxes[a][axis][0].total_cmp(&boxes[b][axis][0]));
        let across = [(1, 0), (1, 1), (2, 0), (2, 1)].map(|(further, end)| {
            let mut along = vec![Lanes([f64::NAN; WIDTH]); indices.len().div_ceil(WIDTH)];
            for (number, &index) in as_numbers_mut(&mut along).iter_mut().zip(&indices) {
                *number = boxes[index][(axis + further) % 3][end];
            }
            along
        });
        Self {
            boxes: indices.iter().map(|&index| boxes[index]).collect(),
            begins: indices.iter().map(|&index| boxes[index][axis][0]).collect(),
            indices,
            across,
        }
    }

    /// Of those from the place `from` on that begin within a box along the axis, those that meet it; `met` is room.
    fn within(
        &self,
        (own, axis): (&Box3, usize),
        from: usize,
        met: &mut Vec<Bits>,
        mut each: impl FnMut(usize),
    ) {
        let Self { indices, begins, across, .. } = self;
        let end = from + begins[from..].partition_point(|begin| *begin <= own[axis][1]);
        if from == end {
            return;
        }
        let rows = from / WIDTH..end.div_ceil(WIDTH);
        met.clear();
        met.resize(rows.len(), Bits(0));
        let [y, z] = [(axis + 1) % 3, (axis + 2) % 3].map(|axis| own[axis]);
        let across = [0, 1, 2, 3].map(|of| &across[of][rows.clone()]);
        meeting_tier(across, [y[0], y[1], z[0], z[1]], met);
        for (row, Bits(mut bits)) in rows.zip(met.iter().copied()) {
            while bits != 0 {
                let place = row * WIDTH + bits.trailing_zeros() as usize;
                if (from..end).contains(&place) {
                    each(indices[place]);
                }
                bits &= bits - 1;
            }
        }
    }
}

/// Which boxes, eight at a time, meet one along two axes: low and high along the first, then along the second.
#[inline(always)]
fn meeting<V: Vector8>(across: [&[Lanes]; 4], own: [f64; 4], met: &mut [Bits]) {
    let rows = met.len();
    let (y_low, y_high) = (&V::view(across[0])[..rows], &V::view(across[1])[..rows]);
    let (z_low, z_high) = (&V::view(across[2])[..rows], &V::view(across[3])[..rows]);
    let (y, z) = ([V::splat(own[0]), V::splat(own[1])], [V::splat(own[2]), V::splat(own[3])]);
    for row in 0..rows {
        let along_y = y_low[row].less_equal(y[1]).and(y[0].less_equal(y_high[row]));
        let along_z = z_low[row].less_equal(z[1]).and(z[0].less_equal(z_high[row]));
        met[row] = along_y.and(along_z);
    }
}

tiered! {
    fn meeting_tier[][](across: [&[Lanes]; 4], own: [f64; 4], met: &mut [Bits]) = meeting;
}

/// Calls for each pair of boxes (low and high along three axes) that meet, one of which is a sphere's.
pub fn swept(boxes: &[Box3], is_sphere: impl Fn(usize) -> bool, mut each: impl FnMut(usize, usize)) {
    if boxes.len() <= FEW {
        let meet = |a: &Box3, b: &Box3| (0..3).all(|c| a[c][0] <= b[c][1] && b[c][0] <= a[c][1]);
        for (i, own) in boxes.iter().enumerate() {
            for (j, other) in boxes.iter().enumerate().take(i) {
                if meet(own, other) && (is_sphere(i) || is_sphere(j)) {
                    each(j, i);
                }
            }
        }
        return;
    }
    let spread = |axis: usize| {
        let low = boxes.iter().fold(f64::MAX, |low, own| low.min(own[axis][0]));
        boxes.iter().fold(f64::MIN, |high, own| high.max(own[axis][0])) - low
    };
    let axis = (1..3).fold(0, |best, axis| if spread(axis) > spread(best) { axis } else { best });
    // Points never meet points: millions of them beside a few spheres cost next to nothing.
    let spheres = Sorted::new(boxes, axis, &is_sphere);
    let points = Sorted::new(boxes, axis, |index| !is_sphere(index));
    let mut met = Vec::new();
    for (place, (own, &index)) in spheres.boxes.iter().zip(&spheres.indices).enumerate() {
        spheres.within((own, axis), place + 1, &mut met, |other| each(index, other));
    }
    // Of a sphere and a point the one that begins later begins within the other.
    let mut first = 0;
    for (own, &index) in spheres.boxes.iter().zip(&spheres.indices) {
        first += points.begins[first..].iter().take_while(|begin| **begin < own[axis][0]).count();
        points.within((own, axis), first, &mut met, |other| each(index, other));
    }
    first = 0;
    for (own, &index) in points.boxes.iter().zip(&points.indices) {
        first += spheres.begins[first..].iter().take_while(|begin| **begin <= own[axis][0]).count();
        spheres.within((own, axis), first, &mut met, |other| each(index, other));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn every_pair_that_meets_is_found_once(
            bodies in proptest::collection::vec((-1.0..1.0f64, -1.0..1.0f64, -1.0..1.0f64, 0.0..0.5f64), 0..40),
        ) {
            let boxes: Vec<_> = bodies.iter().map(|b| [b.0, b.1, b.2].map(|x| [x - b.3, x + b.3])).collect();
            let sphere = |i: usize| bodies[i].3 > 0.25;
            let mut found = Vec::new();
            swept(&boxes, sphere, |i, j| found.push((i.min(j), i.max(j))));
            found.sort_unstable();
            let mut all = Vec::new();
            for i in 0..boxes.len() {
                for j in i + 1..boxes.len() {
                    let meet = (0..3).all(|c| boxes[i][c][0] <= boxes[j][c][1] && boxes[j][c][0] <= boxes[i][c][1]);
                    if meet && (sphere(i) || sphere(j)) {
                        all.push((i, j));
                    }
                }
            }
            prop_assert_eq!(found, all);
        }
    }
}
