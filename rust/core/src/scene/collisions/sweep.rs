//! Which boxes meet: sorted along the axis on which they are spread most, each is compared with those that begin within it.

/// So few boxes are compared each with each other: to sort them would take longer.
const FEW: usize = 12;

/// Boxes that are compared with one at a time, without a look at each that a processor would have to foresee.
const AT_ONCE: usize = 8;

/// A box, low and high along three axes.
type Box3 = [[f64; 2]; 3];

/// Boxes in the order in which they begin along an axis.
struct Sorted {
    boxes: Vec<Box3>,
    indices: Vec<usize>,
    /// Where they begin along that axis, and low and high along the two others.
    begins: Vec<f64>,
    across: [[Vec<f64>; 2]; 2],
}

impl Sorted {
    fn new(boxes: &[Box3], axis: usize, takes: impl Fn(usize) -> bool) -> Self {
        // What is no number meets nobody.
        let told = |own: &Box3| !(own[axis][0].is_nan() || own[axis][1].is_nan());
        let mut indices: Vec<usize> = (0..boxes.len()).filter(|&i| takes(i) && told(&boxes[i])).collect();
        indices.sort_by(|&a, &b| boxes[a][axis][0].total_cmp(&boxes[b][axis][0]));
        let along = |axis: usize, end: usize| -> Vec<f64> {
            indices.iter().map(|&index| boxes[index][axis][end]).collect()
        };
        let across = [(axis + 1) % 3, (axis + 2) % 3].map(|axis| [along(axis, 0), along(axis, 1)]);
        let begins = along(axis, 0);
        Self { boxes: indices.iter().map(|&index| boxes[index]).collect(), indices, begins, across }
    }

    /// Of those from the place `from` on that begin within a box along the axis, those that meet it.
    fn within(&self, own: &Box3, axis: usize, from: usize, mut each: impl FnMut(usize)) {
        let end = from + self.begins[from..].partition_point(|begin| *begin <= own[axis][1]);
        let ([y, z], [low, high]) = ([(axis + 1) % 3, (axis + 2) % 3].map(|axis| own[axis]), &self.across);
        let mut start = from;
        while start < end {
            let count = (end - start).min(AT_ONCE);
            let part = |of: &Vec<f64>| -> [f64; AT_ONCE] {
                // What is no number meets nobody.
                let mut part = [f64::NAN; AT_ONCE];
                part[..count].copy_from_slice(&of[start..start + count]);
                part
            };
            let [[y_low, y_high], [z_low, z_high]] = [low, high].map(|ends| [part(&ends[0]), part(&ends[1])]);
            let mut met = 0_u32;
            for k in 0..AT_ONCE {
                let meets =
                    (y_low[k] <= y[1]) & (y[0] <= y_high[k]) & (z_low[k] <= z[1]) & (z[0] <= z_high[k]);
                met |= u32::from(meets) << k;
            }
            while met != 0 {
                each(self.indices[start + met.trailing_zeros() as usize]);
                met &= met - 1;
            }
            start += count;
        }
    }
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
    for (place, (own, &index)) in spheres.boxes.iter().zip(&spheres.indices).enumerate() {
        spheres.within(own, axis, place + 1, |other| each(index, other));
    }
    // Of a sphere and a point the one that begins later begins within the other.
    let mut first = 0;
    for (own, &index) in spheres.boxes.iter().zip(&spheres.indices) {
        first += points.begins[first..].iter().take_while(|begin| **begin < own[axis][0]).count();
        points.within(own, axis, first, |other| each(index, other));
    }
    first = 0;
    for (own, &index) in points.boxes.iter().zip(&points.indices) {
        first += spheres.begins[first..].iter().take_while(|begin| **begin <= own[axis][0]).count();
        spheres.within(own, axis, first, |other| each(index, other));
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
