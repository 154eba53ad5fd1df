//! Which boxes meet: sorted along the axis on which they are spread most, each is compared with those that begin within it.

/// So few boxes are compared each with each other: to sort them would take longer.
const FEW: usize = 12;

/// A body's box, low and high along three axes, and its index.
type Boxed = ([[f64; 2]; 3], usize);

/// Calls for each pair of boxes (low and high along three axes) that meet, one of which is a sphere's.
pub fn swept(boxes: &[[[f64; 2]; 3]], is_sphere: impl Fn(usize) -> bool, mut each: impl FnMut(usize, usize)) {
    let meet =
        |a: &[[f64; 2]; 3], b: &[[f64; 2]; 3]| (0..3).all(|c| a[c][0] <= b[c][1] && b[c][0] <= a[c][1]);
    if boxes.len() <= FEW {
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
    let sorted = |sphere: bool| {
        let own = |(index, own): (usize, &[[f64; 2]; 3])| {
            // What is no number meets nobody.
            (is_sphere(index) == sphere && !own[axis][0].is_nan()).then_some((*own, index))
        };
        let mut sorted: Vec<Boxed> = boxes.iter().enumerate().filter_map(own).collect();
        sorted.sort_by(|(a, _), (b, _)| a[axis][0].total_cmp(&b[axis][0]));
        sorted
    };
    // Points never meet points: millions of them beside a few spheres cost next to nothing.
    let (spheres, points) = (sorted(true), sorted(false));
    let mut those_that_begin_in = |one: &Boxed, others: &[Boxed]| {
        let (own, index) = one;
        for (other, to) in others.iter().take_while(|(other, _)| other[axis][0] <= own[axis][1]) {
            if meet(own, other) {
                each(*index, *to);
            }
        }
    };
    for (place, sphere) in spheres.iter().enumerate() {
        those_that_begin_in(sphere, &spheres[place + 1..]);
    }
    // Of a sphere and a point the one that begins later begins within the other.
    let mut first = 0;
    for sphere in &spheres {
        first += points[first..].iter().take_while(|(point, _)| point[axis][0] < sphere.0[axis][0]).count();
        those_that_begin_in(sphere, &points[first..]);
    }
    first = 0;
    for point in &points {
        first +=
            spheres[first..].iter().take_while(|(sphere, _)| sphere[axis][0] <= point.0[axis][0]).count();
        those_that_begin_in(point, &spheres[first..]);
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
