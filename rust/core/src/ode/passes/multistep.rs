//! The loops of a multistep method over the differences of its past.

use crate::numerics::element::{Element, PairMut, Pass, Scaled, View};
use crate::numerics::real::{Real, each};

/// The accelerations of nodes gone by, as their backward differences; blocks like that of an acceleration.
///
/// Differences because they are small: `Σ weight·∇²a` rounds what is some thousandths of `a`, where weights of the
/// accelerations themselves, up to a hundred, would round hundredfold. And the first of them are exact.
#[derive(Debug)]
pub struct Differences<'a, S> {
    /// The accelerations at the node before; after a step, here.
    pub last: &'a mut [S],
    /// Their first differences there, too.
    pub first: &'a mut [S],
    /// Second differences, a block for each node, in a ring.
    pub second: &'a mut [S],
    /// The place of the present node in the ring.
    pub newest: usize,
}

impl<'a, S> Differences<'a, S> {
    /// As the tier's vectors.
    #[inline(always)]
    fn view<V: View<S>>(self) -> Differences<'a, V> {
        Differences {
            last: V::view_mut(self.last),
            first: V::view_mut(self.first),
            second: V::view_mut(self.second),
            newest: self.newest,
        }
    }
}

/// What a multistep method holds at its present node; as a pass, a step of it: `d += h²·a + Σ weight·∇²a`, the oldest first,
/// then `q += d`, both compensated. The present accelerations join the past.
#[derive(Debug)]
pub struct Nodes<'a, S> {
    /// The coordinates, and what they leave out.
    pub q: PairMut<'a, S>,
    /// Their difference from the node before, and what it leaves out.
    pub d: PairMut<'a, S>,
    /// The nodes gone by.
    pub past: Differences<'a, S>,
    /// The accelerations at the present node.
    pub a: &'a mut [S],
    /// The step, squared.
    pub h2: &'a S,
    /// h² times the weights of the second differences, the oldest first.
    pub weights: &'a [S],
}

impl<'a, S> Nodes<'a, S> {
    /// As the tier's vectors.
    #[inline(always)]
    pub(crate) fn view<V: View<S>>(self) -> Nodes<'a, V> {
        Nodes {
            q: V::pair_mut(self.q),
            d: V::pair_mut(self.d),
            past: self.past.view(),
            a: V::view_mut(self.a),
            h2: V::view_one(self.h2),
            weights: V::view(self.weights),
        }
    }
}

/// Calls `$group` for the elements from `$start` on, six at a time while there are six.
macro_rules! in_groups {
    ($n:expr, |$start:ident| $group:ident($($argument:expr),*)) => {{
        let mut $start = 0;
        in_groups!(@of 6, $n, $start, $group($($argument),*));
        in_groups!(@of 3, $n, $start, $group($($argument),*));
        in_groups!(@of 1, $n, $start, $group($($argument),*));
    }};
    (@of $size:literal, $n:expr, $start:ident, $group:ident($($argument:expr),*)) => {
        while $n - $start >= $size {
            $group::<V, $size>($($argument),*);
            $start += $size;
        }
    };
}

/// `Σ weight·∇²a` over the nodes in the ring but the one at `newest`, the oldest first.
#[inline(always)]
fn older<S: Real, const G: usize>(
    second: &[S],
    n: usize,
    newest: usize,
    weights: &[S],
    start: usize,
) -> [S; G] {
    let mut sums = [S::zero(); G];
    let (early, late) = weights.split_at(weights.len() - newest);
    for (first, weights) in [(newest + 1, early), (0, late)] {
        for (block, &weight) in second[first * n..].chunks(n).zip(weights) {
            let block = &block[start..][..G];
            sums = each!(g < G => weight.multiply_add(block[g], sums[g]));
        }
    }
    sums
}

impl<S: Element> Pass<S> for Nodes<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let mut nodes = self.view::<V>();
        in_groups!(nodes.a.len(), |start| step_loaded(&mut nodes, start));
    }
}

#[inline(always)]
fn step_loaded<S: Real, const G: usize>(nodes: &mut Nodes<'_, S>, start: usize) {
    let (a, q) = (&nodes.a[start..][..G], &nodes.q.0[start..][..G]);
    step_group(nodes, start, each!(g < G => a[g]), each!(g < G => q[g]));
}

/// The step of `G` coordinates from `start` on: `place`, whose accelerations are `a`.
#[inline(always)]
pub(crate) fn step_group<S: Real, const G: usize>(
    nodes: &mut Nodes<'_, S>,
    start: usize,
    a: [S; G],
    place: [S; G],
) {
    let Nodes { q, d, past: Differences { last, first, second, newest }, h2, weights, .. } = nodes;
    let n = last.len();
    let [weights @ .., weight] = weights else { return };
    let older: [S; G] = older(second, n, *newest, weights, start);
    let ((q, q_error), (d, d_error)) = (q, d);
    let (q, q_error) = (&mut q[start..][..G], &mut q_error[start..][..G]);
    let (d, d_error) = (&mut d[start..][..G], &mut d_error[start..][..G]);
    let (last, first) = (&mut last[start..][..G], &mut first[start..][..G]);
    let second = &mut second[*newest * n + start..][..G];
    let change = each!(g < G => a[g] - last[g]);
    let bend = each!(g < G => change[g] - first[g]);
    last.copy_from_slice(&a);
    first.copy_from_slice(&change);
    second.copy_from_slice(&bend);
    let sum = each!(g < G => h2.multiply_add(a[g], weight.multiply_add(bend[g], older[g])));
    // As `add_compensated`.
    let speed = each!(g < G => d[g]);
    let change = each!(g < G => sum[g] + d_error[g]);
    let difference = each!(g < G => speed[g] + change[g]);
    let rest = each!(g < G => change[g] - (difference[g] - speed[g]));
    let moved = each!(g < G => difference[g] + (rest[g] + q_error[g]));
    let reached = each!(g < G => place[g] + moved[g]);
    q.copy_from_slice(&reached);
    d.copy_from_slice(&difference);
    d_error.copy_from_slice(&rest);
    q_error.copy_from_slice(&each!(g < G => moved[g] - (reached[g] - place[g])));
}

/// `v = d/h + h (weight·a + weight·∇a + weight·∇²a + Σ weight·∇²a)`, in the sum the oldest first: the velocities at a node.
/// The step comes with its reciprocal, as divisions take long.
#[derive(Debug)]
pub struct BackwardVelocity<'a, S> {
    /// Where they go.
    pub v: &'a mut [S],
    /// The last difference of the coordinates.
    pub d: &'a [S],
    /// The nodes gone by.
    pub past: Differences<'a, S>,
    /// The accelerations at the present node.
    pub a: &'a [S],
    /// The step and its reciprocal.
    pub h: (&'a S, &'a Scaled<S>),
    /// The weights.
    pub weights: &'a [S],
}

impl<S: Element> Pass<S> for BackwardVelocity<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let (v, d, a) = (V::view_mut(self.v), V::view(self.d), V::view(self.a));
        let Differences { last, first, second, newest } = self.past.view::<V>();
        let (h, h_inverse) = (V::load(*self.h.0), V::scaled(self.h.1));
        let n = a.len();
        let [present, changed, bent, weights @ ..] = V::view(self.weights) else { return };
        in_groups!(n, |start| backward_velocity_group(
            &mut v[start..],
            &d[start..],
            (&last[start..], &first[start..]),
            &a[start..],
            (h, h_inverse),
            older(second, n, newest, weights, start),
            [*present, *changed, *bent]
        ));
    }
}

#[inline(always)]
fn backward_velocity_group<S: Real, const G: usize>(
    v: &mut [S],
    d: &[S],
    (last, first): (&[S], &[S]),
    a: &[S],
    (h, h_inverse): (S, Scaled<S>),
    older: [S; G],
    [present, changed, bent]: [S; 3],
) {
    for g in 0..G {
        let change = a[g] - last[g];
        let sum = bent.multiply_add(change - first[g], older[g]);
        let sum = present.multiply_add(a[g], changed.multiply_add(change, sum));
        let mean = d[g].multiply_add(h_inverse.0, d[g] * h_inverse.1);
        v[g] = h.multiply_add(sum, mean);
    }
}
