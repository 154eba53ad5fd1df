//! Which boxes meet: sorted along the axis on which they are spread most, each is compared with those that it meets there.

/// Calls for each pair of boxes (low and high along three axes) that meet, one of which is a sphere's.
pub fn swept(boxes: &[[[f64; 2]; 3]], is_sphere: impl Fn(usize) -> bool, mut each: impl FnMut(usize, usize)) {
    let spread = |axis: usize| {
        let low = boxes.iter().fold(f64::MAX, |low, own| low.min(own[axis][0]));
        boxes.iter().fold(f64::MIN, |high, own| high.max(own[axis][0])) - low
    };
    let axis = (1..3).fold(0, |best, axis| if spread(axis) > spread(best) { axis } else { best });
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&i, &j| boxes[i][axis][0].total_cmp(&boxes[j][axis][0]));
    let meet = |i: usize, j: usize| boxes[i].iter().zip(&boxes[j]).all(|(a, b)| a[0] <= b[1] && b[0] <= a[1]);
    // Points never meet points: millions of them beside a few spheres cost next to nothing.
    let mut open: [Vec<usize>; 2] = [Vec::new(), Vec::new()];
    for &next in &order {
        let from = boxes[next][axis][0];
        let sphere = is_sphere(next);
        for others in &mut open[usize::from(!sphere)..] {
            others.retain(|&other| boxes[other][axis][1] >= from);
            for &other in others.iter().filter(|&&other| meet(other, next)) {
                each(other, next);
            }
        }
        open[usize::from(sphere)].push(next);
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
