//! How large the error of a step is, against what is allowed.

use crate::numerics::element::{Element, Pass, Shape, View};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::real::{Mask, Real};

/// One term of two weighted sums of stages.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct PairTerm<S> {
    /// Which stage.
    pub stage: usize,
    /// Its weights.
    pub weights: [S; 2],
}

/// Terms seen as those of the tier's vectors.
#[inline(always)]
fn view_terms<S, V: View<S>>(terms: &[PairTerm<S>]) -> &[PairTerm<V>] {
    const { assert!(size_of::<PairTerm<V>>() == size_of::<PairTerm<S>>() && align_of::<V>() <= align_of::<S>()) }
    // SAFETY: a `V` is a view of an `S`, of its size and validity; `PairTerm` is `repr(C)`, so the two have the same layout
    // (the sizes are checked above).
    unsafe { core::slice::from_raw_parts(terms.as_ptr().cast(), terms.len()) }
}

/// An error that is allowed to be this large, or infinite, is no error: its square still is a number.
const UNLIMITED: f64 = 1e150;

/// Beyond this a squared error is as good as infinite; NaN counts as infinite too.
pub const HUGE: f64 = 1e300;

/// The largest of the squared scaled errors `|h Σ weight·k|² / (atol + rtol·|y - reference|)²` of the rows, for two sets of
/// weights at once; each row is a vector of one to four components.
#[derive(Debug)]
pub struct LargestErrors<'a, S> {
    /// The largest so far, for each set of weights.
    pub largest: &'a mut [S; 2],
    /// How the vectors lie.
    pub shape: Shape,
    /// The state.
    pub y: &'a [S],
    /// What sizes are measured from, at the start.
    pub reference: &'a [S; 4],
    /// How it moves.
    pub drift: &'a [S; 4],
    /// The time since the start.
    pub elapsed: &'a S,
    /// Absolute tolerance of all vectors, or of each.
    pub atol: &'a [S],
    /// Tolerance relative to the distance from the reference.
    pub rtol: &'a S,
    /// What the sum is multiplied with.
    pub h: &'a S,
    /// The weights.
    pub terms: &'a [PairTerm<S>],
    /// The derivatives, stage after stage.
    pub k: &'a [S],
    /// Numbers from one stage to the next.
    pub stride: usize,
}

impl<S: Element> Pass<S> for LargestErrors<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let Self { largest, shape, reference, drift, .. } = self;
        let y = V::view(self.y);
        let elapsed = V::load(*self.elapsed);
        let mut place = [V::zero(); 4];
        for c in 0..shape.components.min(4) {
            place[c] = V::load(reference[c]) + V::load(drift[c]) * elapsed;
        }
        let tolerance = (V::view(self.atol), V::load(*self.rtol));
        let (h, terms, k) =
            (V::load(*self.h), view_terms::<S, V>(self.terms), (V::view(self.k), self.stride));
        let sizes = match shape.components {
            1 => largest_vector_errors::<V, 1>(shape.rows, y, &place, tolerance, h, terms, k),
            2 => largest_vector_errors::<V, 2>(shape.rows, y, &place, tolerance, h, terms, k),
            3 => largest_vector_errors::<V, 3>(shape.rows, y, &place, tolerance, h, terms, k),
            _ => largest_vector_errors::<V, 4>(shape.rows, y, &place, tolerance, h, terms, k),
        };
        for (largest, size) in V::view_mut(largest).iter_mut().zip(sizes) {
            *largest = largest.max(size);
        }
    }
}

/// One over what is allowed of a vector whose size has this square. Rough roots will do: a step is no better for a tolerance
/// kept to more than four digits.
#[inline(always)]
pub(super) fn inverse_tolerance<S: InverseCube>(distance2: S, atol: S, rtol: S) -> S {
    let distance = distance2 * distance2.rough_inverse_root();
    let tolerance = rtol.multiply_add(distance, atol).min(S::splat(UNLIMITED));
    (tolerance * tolerance).rough_inverse_root()
}

/// [`LargestErrors`], the number of components known when compiled.
#[inline(always)]
fn largest_vector_errors<S: InverseCube, const C: usize>(
    rows: usize,
    y: &[S],
    reference: &[S; 4],
    (atol, rtol): (&[S], S),
    h: S,
    terms: &[PairTerm<S>],
    (k, stride): (&[S], usize),
) -> [S; 2] {
    let mut largest = [S::zero(); 2];
    let of_each = usize::from(atol.len() > 1);
    for row in 0..rows {
        let atol = atol[row * of_each];
        let mut distance2 = S::zero();
        for c in 0..C {
            let distance = y[c * rows + row] - reference[c];
            distance2 = distance.multiply_add(distance, distance2);
        }
        let inverse_scale = inverse_tolerance(distance2, atol, rtol);
        let mut sums = [[S::zero(); C]; 2];
        for &PairTerm { stage, weights } in terms {
            let column = &k[stage * stride + row..][..(C - 1) * rows + 1];
            for c in 0..C {
                let k = column[c * rows];
                sums[0][c] = weights[0].multiply_add(k, sums[0][c]);
                sums[1][c] = weights[1].multiply_add(k, sums[1][c]);
            }
        }
        for estimate in 0..2 {
            let mut error2 = S::zero();
            for c in 0..C {
                let error = h * sums[estimate][c] * inverse_scale;
                error2 = error.multiply_add(error, error2);
            }
            let ratio = S::select(error2.less_equal(S::splat(HUGE)), error2, S::splat(HUGE));
            largest[estimate] = largest[estimate].max(ratio);
        }
    }
    largest
}

/// The mean of the squared scaled errors `(h Σ weight·k)² / (atol + rtol·|y|)²` of all numbers, `|y|` being the larger of two
/// states, for two sets of weights at once.
#[derive(Debug)]
pub struct MeanErrors<'a, S> {
    /// The state.
    pub y: &'a [S],
    /// The other.
    pub next: &'a [S],
    /// Absolute tolerance of each number.
    pub atol: &'a [S],
    /// Relative tolerance of each.
    pub rtol: &'a [S],
    /// What the sum is multiplied with.
    pub h: &'a S,
    /// The weights.
    pub terms: &'a [PairTerm<S>],
    /// The derivatives, stage after stage.
    pub k: &'a [S],
    /// Numbers from one stage to the next.
    pub stride: usize,
}

impl<S: Element> Pass<S> for MeanErrors<'_, S> {
    type Output = [S; 2];
    #[inline(always)]
    fn run<V: View<S>>(self) -> [S; 2] {
        let (y, k, h) = (V::view(self.y), V::view(self.k), V::load(*self.h));
        let n = y.len();
        let (next, atol, rtol) =
            (&V::view(self.next)[..n], &V::view(self.atol)[..n], &V::view(self.rtol)[..n]);
        let terms = view_terms::<S, V>(self.terms);
        let (mut sums, mut start) = ([V::zero(); 2], 0);
        // Several numbers at a time, because one sum alone waits for each of its additions.
        macro_rules! groups {
            ($($size:literal)+) => {$(
                while n - start >= $size {
                    let errors = pair_weighted::<V, $size>(terms, k, self.stride, start);
                    for i in start..start + $size {
                        let scale = rtol[i].multiply_add(y[i].abs().max(next[i].abs()), atol[i]);
                        for estimate in 0..2 {
                            let error = h * errors[i - start][estimate];
                            let ratio = error / scale;
                            // Without an error any tolerance is kept, one of zero too.
                            let none = error.less_equal(V::zero()).and(V::zero().less_equal(error));
                            sums[estimate] += V::select(none, V::zero(), ratio * ratio);
                        }
                    }
                    start += $size;
                }
            )+};
        }
        groups!(4 3 2 1);
        let inverse = V::one() / V::splat(n as f64);
        for sum in &mut sums {
            *sum = *sum * inverse;
            *sum = V::select(sum.less_equal(V::splat(HUGE)), *sum, V::splat(HUGE));
        }
        let [first, second] = sums;
        [first.store(), second.store()]
    }
}

/// `Σ weight·k[stage]` for both weights at `G` numbers from `i` on.
#[inline(always)]
fn pair_weighted<S: Real, const G: usize>(
    terms: &[PairTerm<S>],
    k: &[S],
    stride: usize,
    i: usize,
) -> [[S; 2]; G] {
    let mut sums = [[S::zero(); 2]; G];
    for &PairTerm { stage, weights } in terms {
        let column = &k[stage * stride + i..][..G];
        for g in 0..G {
            for estimate in 0..2 {
                sums[g][estimate] = weights[estimate].multiply_add(column[g], sums[g][estimate]);
            }
        }
    }
    sums
}
