//! PLACEHOLDER
use super::binary::Binary;
use super::cosine::cosine;
use super::real::Real;
pub trait Functions: Real {}
impl<S: Real> Functions for S {}
#[inline(always)]
pub fn sin_cos<S: Real>(x: S) -> (S, S) {
    (
        cosine(x - S::splat(core::f64::consts::FRAC_PI_2), S::splat(-6.123_233_995_736_766e-17)),
        cosine(x, S::zero()),
    )
}
macro_rules! none { ($($n:ident),*) => { $(#[inline(always)] pub fn $n<S: Real>(_x: S) -> S { S::splat(f64::NAN) })* } }
none!(tan, ln, tanh, asin, acos, atan, asinh, acosh, atanh);
#[inline(always)]
pub fn sinh_cosh<S: Real>(x: S) -> (S, S) {
    (x, x)
}
#[inline(always)]
pub fn power<S: Binary>(x: S, _e: f64) -> S {
    x
}
