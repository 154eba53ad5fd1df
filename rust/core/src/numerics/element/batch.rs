//! The loops over [`Lanes`], compiled for every tier.

use super::{
    Differences, Element, Nodes, PairTerm, Relative, Scaled, Shape, Term, Weighted, loops, multistep,
    relative,
};
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::{Bits, Lanes, Vector8};
use crate::tiered;

#[inline(always)]
fn load<V: Vector8>(&(high, low): &Scaled<Lanes>) -> Scaled<V> {
    (V::load(high), V::load(low))
}

/// Terms as the tier's vectors: same layout, so a view and not a copy.
#[inline(always)]
fn view_terms<V: Vector8>(terms: &[Term<Lanes>]) -> &[Term<V>] {
    const { assert!(size_of::<Term<V>>() == size_of::<Term<Lanes>>()) }
    // SAFETY: `V` has the size, alignment and validity of `Lanes` (see `Vector8::view`), and `Term` is
    // `repr(C)`, so the two have the same layout.
    unsafe { core::slice::from_raw_parts(terms.as_ptr().cast(), terms.len()) }
}

/// As [`view_terms`].
#[inline(always)]
fn view_pair_terms<V: Vector8>(terms: &[PairTerm<Lanes>]) -> &[PairTerm<V>] {
    const { assert!(size_of::<PairTerm<V>>() == size_of::<PairTerm<Lanes>>()) }
    // SAFETY: as there; `PairTerm` is `repr(C)`, too.
    unsafe { core::slice::from_raw_parts(terms.as_ptr().cast(), terms.len()) }
}

#[inline(always)]
fn kick_drift_lanes<V: Vector8>(
    q: (&mut [Lanes], &mut [Lanes]),
    v: (&mut [Lanes], &mut [Lanes]),
    a: &[Lanes],
    kick: &Scaled<Lanes>,
    drift: &Scaled<Lanes>,
) {
    loops::kick_drift::<V>(
        (V::view_mut(q.0), V::view_mut(q.1)),
        (V::view_mut(v.0), V::view_mut(v.1)),
        V::view(a),
        &load(kick),
        &load(drift),
    );
}
#[inline(always)]
fn advance_lanes<V: Vector8>(y: (&mut [Lanes], &mut [Lanes]), k: &[Lanes], step: &Scaled<Lanes>) {
    loops::advance::<V>((V::view_mut(y.0), V::view_mut(y.1)), V::view(k), &load(step));
}
/// Weighted stages as the tier's vectors; `h` is their step.
#[inline(always)]
fn view_stages<'a, V: Vector8>(h: &'a V, stages: Weighted<'a, Lanes>) -> Weighted<'a, V> {
    Weighted { h, terms: view_terms(stages.terms), a: V::view(stages.a) }
}

#[inline(always)]
fn combine_lanes<V: Vector8>(
    out: &mut [Lanes],
    q: (&[Lanes], &[Lanes]),
    slope: (&[Lanes], &Lanes),
    stages: Weighted<'_, Lanes>,
) {
    let h = V::load(*stages.h);
    let y = (V::view(q.0), V::view(q.1));
    loops::combine::<V>(V::view_mut(out), y, (V::view(slope.0), &V::load(*slope.1)), view_stages(&h, stages));
}
#[inline(always)]
fn combine_compensated_lanes<V: Vector8>(
    out: (&mut [Lanes], &mut [Lanes]),
    q: (&[Lanes], &[Lanes]),
    slope: (&[Lanes], &Lanes),
    stages: Weighted<'_, Lanes>,
) {
    let h = V::load(*stages.h);
    let y = (V::view(q.0), V::view(q.1));
    loops::combine_compensated::<V>(
        (V::view_mut(out.0), V::view_mut(out.1)),
        y,
        (V::view(slope.0), &V::load(*slope.1)),
        view_stages(&h, stages),
    );
}
#[inline(always)]
fn combine_velocity_lanes<V: Vector8>(
    out: &mut [Lanes],
    v: (&[Lanes], &[Lanes]),
    stages: Weighted<'_, Lanes>,
) {
    let h = V::load(*stages.h);
    let y = (V::view(v.0), V::view(v.1));
    loops::combine_velocity::<V>(V::view_mut(out), y, view_stages(&h, stages));
}
#[inline(always)]
fn combine_velocity_compensated_lanes<V: Vector8>(
    out: (&mut [Lanes], &mut [Lanes]),
    v: (&[Lanes], &[Lanes]),
    stages: Weighted<'_, Lanes>,
) {
    let h = V::load(*stages.h);
    let y = (V::view(v.0), V::view(v.1));
    loops::combine_velocity_compensated::<V>(
        (V::view_mut(out.0), V::view_mut(out.1)),
        y,
        view_stages(&h, stages),
    );
}
#[inline(always)]
fn largest_errors_lanes<V: Vector8 + InverseCube>(
    shape: Shape,
    y: &[Lanes],
    reference: &[Lanes; 4],
    tolerance: (&Lanes, &Lanes),
    h: &Lanes,
    terms: &[PairTerm<Lanes>],
    k: (&[Lanes], usize),
) -> [Lanes; 2] {
    let [first, second] = loops::largest_errors::<V>(
        shape,
        V::view(y),
        &reference.map(V::load),
        (V::load(*tolerance.0), V::load(*tolerance.1)),
        V::load(*h),
        view_pair_terms(terms),
        (V::view(k.0), k.1),
    );
    [first.store(), second.store()]
}

/// The past as the tier's vectors.
#[inline(always)]
fn view_past<'a, V: Vector8>(past: Differences<'a, Lanes>) -> Differences<'a, V> {
    Differences {
        last: V::view_mut(past.last),
        first: V::view_mut(past.first),
        second: V::view_mut(past.second),
        newest: past.newest,
    }
}
/// What a multistep method holds, as the tier's vectors; `h2` is the square of the step.
#[inline(always)]
pub(crate) fn view_nodes<'a, V: Vector8>(h2: &'a V, nodes: Nodes<'a, Lanes>) -> Nodes<'a, V> {
    Nodes {
        q: (V::view_mut(nodes.q.0), V::view_mut(nodes.q.1)),
        d: (V::view_mut(nodes.d.0), V::view_mut(nodes.d.1)),
        past: view_past(nodes.past),
        a: V::view_mut(nodes.a),
        h2,
        weights: V::view(nodes.weights),
    }
}
#[inline(always)]
fn multistep_lanes<V: Vector8>(nodes: Nodes<'_, Lanes>) {
    let h2 = V::load(*nodes.h2);
    multistep::step::<V>(view_nodes(&h2, nodes));
}
#[inline(always)]
fn backward_velocity_lanes<V: Vector8>(
    v: &mut [Lanes],
    d: &[Lanes],
    past: Differences<'_, Lanes>,
    a: &[Lanes],
    h: (&Lanes, &Scaled<Lanes>),
    weights: &[Lanes],
) {
    let (v, d) = (V::view_mut(v), V::view(d));
    multistep::backward_velocity::<V>(
        v,
        d,
        view_past(past),
        V::view(a),
        (V::load(*h.0), load(h.1)),
        V::view(weights),
    );
}

#[inline(always)]
fn absolute_lanes<V: Vector8>(q: (&mut [Lanes], &mut [Lanes]), v: &mut [Lanes], from: &Relative<'_, Lanes>) {
    let from = Relative {
        shape: from.shape,
        systems: from.systems,
        q: view_pair(from.q),
        v: V::view(from.v),
        shares: view_pair(from.shares),
        center: view_pair(from.center),
        drift: view_pair(from.drift),
        h: V::load(from.h),
        node: V::load(from.node),
    };
    relative::absolute::<V>((V::view_mut(q.0), V::view_mut(q.1)), V::view_mut(v), &from);
}

#[inline(always)]
fn view_pair<'a, V: Vector8>(pair: (&'a [Lanes], &'a [Lanes])) -> (&'a [V], &'a [V]) {
    (V::view(pair.0), V::view(pair.1))
}

#[inline(always)]
fn replace_lanes<V: Vector8>(into: &mut [Lanes], from: &[Lanes], mask: Bits) {
    loops::replace::<V>(V::view_mut(into), V::view(from), mask);
}

tiered! {
    fn multistep_tier[][](nodes: Nodes<'_, Lanes>) = multistep_lanes;
    fn backward_velocity_tier[][](v: &mut [Lanes], d: &[Lanes], past: Differences<'_, Lanes>, a: &[Lanes], h: (&Lanes, &Scaled<Lanes>), weights: &[Lanes]) = backward_velocity_lanes;
    fn absolute_tier[][](q: (&mut [Lanes], &mut [Lanes]), v: &mut [Lanes], from: &Relative<'_, Lanes>) = absolute_lanes;
    fn replace_tier[][](into: &mut [Lanes], from: &[Lanes], mask: Bits) = replace_lanes;
    fn kick_drift_tier[][](q: (&mut [Lanes], &mut [Lanes]), v: (&mut [Lanes], &mut [Lanes]), a: &[Lanes], kick: &Scaled<Lanes>, drift: &Scaled<Lanes>) = kick_drift_lanes;
    fn advance_tier[][](y: (&mut [Lanes], &mut [Lanes]), k: &[Lanes], step: &Scaled<Lanes>) = advance_lanes;
    fn combine_tier[][](out: &mut [Lanes], q: (&[Lanes], &[Lanes]), slope: (&[Lanes], &Lanes), stages: Weighted<'_, Lanes>) = combine_lanes;
    fn combine_compensated_tier[][](out: (&mut [Lanes], &mut [Lanes]), q: (&[Lanes], &[Lanes]), slope: (&[Lanes], &Lanes), stages: Weighted<'_, Lanes>) = combine_compensated_lanes;
    fn combine_velocity_tier[][](out: &mut [Lanes], v: (&[Lanes], &[Lanes]), stages: Weighted<'_, Lanes>) = combine_velocity_lanes;
    fn combine_velocity_compensated_tier[][](out: (&mut [Lanes], &mut [Lanes]), v: (&[Lanes], &[Lanes]), stages: Weighted<'_, Lanes>) = combine_velocity_compensated_lanes;
    fn largest_errors_tier[][](shape: Shape, y: &[Lanes], reference: &[Lanes; 4], tolerance: (&Lanes, &Lanes), h: &Lanes, terms: &[PairTerm<Lanes>], k: (&[Lanes], usize)) -> [Lanes; 2] = largest_errors_lanes;
}

impl Element for Lanes {
    fn kick_drift(
        q: (&mut [Self], &mut [Self]),
        v: (&mut [Self], &mut [Self]),
        a: &[Self],
        kick: &Scaled<Self>,
        drift: &Scaled<Self>,
    ) {
        kick_drift_tier(q, v, a, kick, drift);
    }
    fn advance(y: (&mut [Self], &mut [Self]), k: &[Self], step: &Scaled<Self>) {
        advance_tier(y, k, step);
    }
    fn combine(out: &mut [Self], q: (&[Self], &[Self]), slope: (&[Self], &Self), stages: Weighted<'_, Self>) {
        combine_tier(out, q, slope, stages);
    }
    fn combine_compensated(
        out: (&mut [Self], &mut [Self]),
        q: (&[Self], &[Self]),
        slope: (&[Self], &Self),
        stages: Weighted<'_, Self>,
    ) {
        combine_compensated_tier(out, q, slope, stages);
    }
    fn combine_velocity(out: &mut [Self], v: (&[Self], &[Self]), stages: Weighted<'_, Self>) {
        combine_velocity_tier(out, v, stages);
    }
    fn combine_velocity_compensated(
        out: (&mut [Self], &mut [Self]),
        v: (&[Self], &[Self]),
        stages: Weighted<'_, Self>,
    ) {
        combine_velocity_compensated_tier(out, v, stages);
    }
    fn largest_errors(
        shape: Shape,
        y: &[Self],
        reference: &[Self; 4],
        tolerance: (&Self, &Self),
        h: &Self,
        terms: &[PairTerm<Self>],
        k: (&[Self], usize),
    ) -> [Self; 2] {
        largest_errors_tier(shape, y, reference, tolerance, h, terms, k)
    }
    fn multistep(nodes: Nodes<'_, Self>) {
        multistep_tier(nodes);
    }
    fn backward_velocity(
        v: &mut [Self],
        d: &[Self],
        past: Differences<'_, Self>,
        a: &[Self],
        h: (&Self, &Scaled<Self>),
        weights: &[Self],
    ) {
        backward_velocity_tier(v, d, past, a, h, weights);
    }
    fn absolute(q: (&mut [Self], &mut [Self]), v: &mut [Self], from: &Relative<'_, Self>) {
        absolute_tier(q, v, from);
    }
    fn replace(into: &mut [Self], from: &[Self], mask: Self::Mask) {
        replace_tier(into, from, mask);
    }
}
