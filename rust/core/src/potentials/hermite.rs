//! A quintic in each interval of a table, twice continuously differentiable, that rises where the table does.
//!
//! Slopes and curvatures at the points are those of the quartic through five neighbours, then limited. The derivative of
//! the quintic in Bernstein's form has the coefficients s₀, s₀ + h c₀/4, b, s₁ − h c₁/4, s₁ with
//! b = 5Δ − (2s₀ + h c₀/4) − (2s₁ − h c₁/4), Δ the secant; if none of them has the wrong sign, it is monotone.
//! Source: R. L. Dougherty, A. Edelman, J. M. Hyman, Math. Comp. 52 (1989) 471. What is ours: slope and curvature of
//! a point shrink by one factor, which spoils none of the conditions, so one pass does.
//!
//! Beside an extremum of the table the curve may have its own between two points, as a smooth one does; without that
//! the extremum would sit on a point, off by half an interval.

/// The most passes in which intervals are found to be wild; after them every one is monotone.
const PASSES: usize = 8;
/// How far the curve may leave the two values of an interval beside an extremum, as a share of what the values differ by
/// there: a parabola needs 1/8.
const BEYOND: f64 = 0.5;
/// Neighbours whose polynomial is taken.
const STENCIL: usize = 5;

/// Slope and curvature at a point.
type Bend = [f64; 2];

/// The slopes and the curvatures of the curve at the points of the table.
pub(super) fn bends(r: &[f64], v: &[f64]) -> Vec<Bend> {
    let count = r.len();
    let secant: Vec<f64> = (0..count - 1).map(|i| (v[i + 1] - v[i]) / (r[i + 1] - r[i])).collect();
    let free: Vec<Bend> = (0..count).map(|i| estimate(r, v, i)).collect();
    let mut monotone: Vec<bool> = (0..count - 1).map(|i| runs_on(&secant, i)).collect();
    for pass in 0..=PASSES {
        let bends = limited(r, &secant, &free, &monotone);
        let wild: Vec<usize> = (0..count - 1)
            .filter(|&i| !monotone[i] && (pass == PASSES || is_wild(r, v, &bends, i)))
            .collect();
        if wild.is_empty() {
            return bends;
        }
        for i in wild {
            monotone[i] = true;
        }
    }
    limited(r, &secant, &free, &monotone)
}

/// Whether the table rises, or falls, about an interval: before it, in it and after it.
fn runs_on(secant: &[f64], i: usize) -> bool {
    let about = &secant[i.saturating_sub(1)..(i + 2).min(secant.len())];
    about.iter().all(|s| *s >= 0.0) || about.iter().all(|s| *s <= 0.0)
}

/// First and second derivative at a point of the polynomial through its neighbours.
fn estimate(r: &[f64], v: &[f64], i: usize) -> Bend {
    let size = STENCIL.min(r.len());
    let from = i.saturating_sub(size / 2).min(r.len() - size);
    // Newton's divided differences, and Horner's rule for the value and two derivatives.
    let x = &r[from..from + size];
    let mut difference = v[from..from + size].to_vec();
    for order in 1..size {
        for k in (order..size).rev() {
            difference[k] = (difference[k] - difference[k - 1]) / (x[k] - x[k - order]);
        }
    }
    let (mut value, mut slope, mut half_curvature) = (difference[size - 1], 0.0, 0.0);
    for k in (0..size - 1).rev() {
        let d = r[i] - x[k];
        half_curvature = half_curvature * d + slope;
        slope = slope * d + value;
        value = value * d + difference[k];
    }
    [slope, 2.0 * half_curvature]
}

/// The bends, limited so that the curve is monotone in those intervals.
fn limited(r: &[f64], secant: &[f64], free: &[Bend], monotone: &[bool]) -> Vec<Bend> {
    let mut bends = free.to_vec();
    for (i, [slope, curvature]) in bends.iter_mut().enumerate() {
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        // First the signs of the slope, …
        let sides = [i.checked_sub(1), Some(i)];
        let bound = || sides.into_iter().flatten().filter(|&at| at < secant.len() && monotone[at]);
        for at in bound() {
            if *slope * secant[at] <= 0.0 {
                *slope = 0.0;
            }
        }
        // … then how much it may change within the interval: s + h c/4 after the point, s − h c/4 before it.
        for at in bound() {
            let most = 4.0 * *slope / (r[at + 1] - r[at]);
            let (after, rises) = (at == i, secant[at] > 0.0);
            match (after, rises || secant[at] == 0.0, secant[at] == 0.0) {
                (_, _, true) => (low, high) = (0.0, 0.0),
                (true, true, _) => low = low.max(-most),
                (true, false, _) => high = high.min(-most),
                (false, true, _) => high = high.min(most),
                (false, false, _) => low = low.max(most),
            }
        }
        *curvature = curvature.min(high).max(low);
    }
    let mut share = vec![1.0_f64; bends.len()];
    for i in (0..secant.len()).filter(|&i| monotone[i]) {
        let h = r[i + 1] - r[i];
        let taken = 2.0 * (bends[i][0] + bends[i + 1][0]) + 0.25 * h * (bends[i][1] - bends[i + 1][1]);
        if taken.abs() > 5.0 * secant[i].abs() {
            let most = 5.0 * secant[i] / taken;
            (share[i], share[i + 1]) = (share[i].min(most), share[i + 1].min(most));
        }
    }
    bends.iter().zip(share).map(|(bend, share)| bend.map(|x| x * share)).collect()
}

/// Whether the curve turns more than once in an interval, or far beyond the two values.
fn is_wild(r: &[f64], v: &[f64], bends: &[Bend], i: usize) -> bool {
    let h = r[i + 1] - r[i];
    let ([s0, c0], [s1, c1]) = (bends[i], bends[i + 1]);
    let near = [s0, s0 + 0.25 * h * c0];
    let far = [s1 - 0.25 * h * c1, s1];
    let middle = 5.0 * (v[i + 1] - v[i]) / h - (near[0] + near[1] + far[0] + far[1]);
    let signs: Vec<bool> = [near[0], near[1], middle, far[0], far[1]]
        .into_iter()
        .filter(|s| *s != 0.0)
        .map(|s| s > 0.0)
        .collect();
    let turns = signs.windows(2).filter(|pair| pair[0] != pair[1]).count();
    // The values as Bernstein has them bound the curve.
    let hull = [
        v[i] + 0.2 * h * s0,
        v[i] + 0.4 * h * s0 + 0.05 * h * h * c0,
        v[i + 1] - 0.4 * h * s1 + 0.05 * h * h * c1,
        v[i + 1] - 0.2 * h * s1,
    ];
    let (low, high) = (v[i].min(v[i + 1]), v[i].max(v[i + 1]));
    let excess = hull.iter().fold(0.0_f64, |m, x| m.max(low - x).max(x - high));
    let step = |at: usize| (v[at + 1] - v[at]).abs();
    let outer = match (i.checked_sub(1), i + 2 < v.len()) {
        (Some(before), true) => step(before).min(step(i + 1)),
        (Some(before), false) => step(before),
        (None, true) => step(i + 1),
        (None, false) => 0.0,
    };
    turns > 1 || excess > BEYOND * step(i).max(outer)
}

/// The quintic of an interval in t = (r − r₀)/h, from both of its ends.
pub(super) fn quintic(h: f64, [v0, v1]: [f64; 2], [s0, c0]: Bend, [s1, c1]: Bend) -> [f64; 6] {
    let (s0, s1, c0, c1) = (h * s0, h * s1, 0.5 * h * h * c0, 0.5 * h * h * c1);
    let d = v1 - v0;
    [
        v0,
        s0,
        c0,
        10.0 * d - 6.0 * s0 - 4.0 * s1 - 3.0 * c0 + c1,
        -15.0 * d + 8.0 * s0 + 7.0 * s1 + 3.0 * c0 - 2.0 * c1,
        6.0 * d - 3.0 * (s0 + s1) - c0 + c1,
    ]
}
