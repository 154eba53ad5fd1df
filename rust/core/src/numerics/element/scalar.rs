//! The loops over `f64`, compiled for every tier: there a fused multiply-add is an instruction, and several numbers of a
//! state go through it at a time.
#![expect(
    clippy::extra_unused_type_parameters,
    reason = "`tiered!` names the tier's vectors; these loops need none"
)]

use super::{PairTerm, Tolerances, Weighted, loops};
use crate::numerics::lanes::Vector8;
use crate::tiered;

#[inline(always)]
fn combine_body<V: Vector8>(
    out: &mut [f64],
    q: (&[f64], &[f64]),
    slope: (&[f64], &f64),
    stages: Weighted<'_, f64>,
) {
    loops::combine(out, q, slope, stages);
}
#[inline(always)]
fn combine_compensated_body<V: Vector8>(
    out: (&mut [f64], &mut [f64]),
    q: (&[f64], &[f64]),
    slope: (&[f64], &f64),
    stages: Weighted<'_, f64>,
) {
    loops::combine_compensated(out, q, slope, stages);
}
#[inline(always)]
fn combine_velocity_body<V: Vector8>(out: &mut [f64], v: (&[f64], &[f64]), stages: Weighted<'_, f64>) {
    loops::combine_velocity(out, v, stages);
}
#[inline(always)]
fn combine_velocity_compensated_body<V: Vector8>(
    out: (&mut [f64], &mut [f64]),
    v: (&[f64], &[f64]),
    stages: Weighted<'_, f64>,
) {
    loops::combine_velocity_compensated(out, v, stages);
}
#[inline(always)]
fn mean_errors_body<V: Vector8>(
    y: [&[f64]; 2],
    tolerances: Tolerances<'_, f64>,
    h: &f64,
    terms: &[PairTerm<f64>],
    k: (&[f64], usize),
) -> [f64; 2] {
    loops::mean_errors(y, tolerances, h, terms, k)
}

tiered! {
    pub(super) fn combine[][](out: &mut [f64], q: (&[f64], &[f64]), slope: (&[f64], &f64), stages: Weighted<'_, f64>) = combine_body;
    pub(super) fn combine_compensated[][](out: (&mut [f64], &mut [f64]), q: (&[f64], &[f64]), slope: (&[f64], &f64), stages: Weighted<'_, f64>) = combine_compensated_body;
    pub(super) fn combine_velocity[][](out: &mut [f64], v: (&[f64], &[f64]), stages: Weighted<'_, f64>) = combine_velocity_body;
    pub(super) fn combine_velocity_compensated[][](out: (&mut [f64], &mut [f64]), v: (&[f64], &[f64]), stages: Weighted<'_, f64>) = combine_velocity_compensated_body;
    pub(super) fn mean_errors[][](y: [&[f64]; 2], tolerances: Tolerances<'_, f64>, h: &f64, terms: &[PairTerm<f64>], k: (&[f64], usize)) -> [f64; 2] = mean_errors_body;
}
