//! Changes of a state in place: kicks, drifts, and lanes taken over.
//!
//! Updates are compensated (Kahan, Comm. ACM 8 (1965) 40): `y + e` carries the state
//! with about twice the digits, so that round-off grows like a random walk of the *increments*.

use crate::numerics::element::{Element, PairMut, Pass, Scaled, View};
use crate::numerics::real::{Mask, Real};

/// `y + e + increment`, again as a sum and what it leaves out. What the step's coefficient leaves out joins the increment before `e` does: so a step
/// stays the symplectic map of its rounded coefficients. Added to `e` first it is kept or lost depending on the
/// state, which is no symplectic map: over 1.5e6 steps of kahan_li8 the mean energy error of 32 outer Solar
/// Systems then drifts to 1.8e-14, three times its scatter, instead of 1e-15.
///
/// Kahan's three operations instead of Knuth's six: they differ only where a coordinate is smaller than its own
/// increment, by no more than the rounding that every increment brings along.
#[inline(always)]
pub(crate) fn add_compensated<S: Real>(y: S, e: S, increment: S) -> (S, S) {
    let increment = increment + e;
    let sum = y + increment;
    (sum, increment - (sum - y))
}

/// `v += kick·a`, then `q += drift·v`, both compensated.
#[derive(Debug)]
pub struct KickDrift<'a, S> {
    /// Coordinates.
    pub q: PairMut<'a, S>,
    /// Velocities.
    pub v: PairMut<'a, S>,
    /// Accelerations.
    pub a: &'a [S],
    /// The first coefficient times the step.
    pub kick: &'a Scaled<S>,
    /// The second.
    pub drift: &'a Scaled<S>,
}

impl<S: Element> Pass<S> for KickDrift<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let (kick, drift) = (V::scaled(self.kick), V::scaled(self.drift));
        let a = V::view(self.a);
        let n = a.len();
        let ((q, q_error), (v, v_error)) = (V::pair_mut(self.q), V::pair_mut(self.v));
        let (q, q_error, v, v_error) = (&mut q[..n], &mut q_error[..n], &mut v[..n], &mut v_error[..n]);
        for i in 0..n {
            let change = kick.0.multiply_add(a[i], kick.1 * a[i]);
            let (speed, speed_error) = add_compensated(v[i], v_error[i], change);
            let change = drift.0.multiply_add(speed, drift.1.multiply_add(speed, drift.0 * speed_error));
            (q[i], q_error[i]) = add_compensated(q[i], q_error[i], change);
            (v[i], v_error[i]) = (speed, speed_error);
        }
    }
}

/// `y += step·k`, compensated.
#[derive(Debug)]
pub struct Advance<'a, S> {
    /// What is changed.
    pub y: PairMut<'a, S>,
    /// Derivatives.
    pub k: &'a [S],
    /// The coefficient times the step.
    pub step: &'a Scaled<S>,
}

impl<S: Element> Pass<S> for Advance<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let (k, step) = (V::view(self.k), V::scaled(self.step));
        let n = k.len();
        let (y, e) = V::pair_mut(self.y);
        let (y, e) = (&mut y[..n], &mut e[..n]);
        for i in 0..n {
            (y[i], e[i]) = add_compensated(y[i], e[i], step.0.multiply_add(k[i], step.1 * k[i]));
        }
    }
}

/// `Σ a·b`, lane by lane.
#[derive(Debug)]
pub struct Product<'a, S> {
    /// Some numbers.
    pub a: &'a [S],
    /// As many.
    pub b: &'a [S],
}

impl<S: Element> Pass<S> for Product<'_, S> {
    type Output = S;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S {
        let (a, b) = (V::view(self.a), V::view(self.b));
        let mut sum = V::zero();
        for (&a, &b) in a.iter().zip(b) {
            sum = a.multiply_add(b, sum);
        }
        sum.store()
    }
}

/// Zero, or not a number where some number is not finite, lane by lane.
#[derive(Debug)]
pub struct Finite<'a, S> {
    /// The numbers.
    pub y: &'a [S],
}

impl<S: Element> Pass<S> for Finite<'_, S> {
    type Output = S;
    #[inline(always)]
    fn run<V: View<S>>(self) -> S {
        let mut sum = V::zero();
        for &y in V::view(self.y) {
            sum += y * V::zero();
        }
        sum.store()
    }
}

/// `if mask { from } else { into }`, element by element.
pub fn replace<S: Element>(into: &mut [S], from: &[S], mask: S::Mask) {
    if mask.all() {
        into.copy_from_slice(from);
    } else {
        S::pass(Replace { into, from, mask });
    }
}

/// [`replace`] where the lanes differ.
#[derive(Debug)]
struct Replace<'a, S: Real> {
    into: &'a mut [S],
    from: &'a [S],
    mask: S::Mask,
}

impl<S: Element> Pass<S> for Replace<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        let mask = V::mask(self.mask);
        for (into, from) in V::view_mut(self.into).iter_mut().zip(V::view(self.from)) {
            *into = V::select(mask, *from, *into);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_drift_takes_the_compensation_of_the_velocity_along() {
        // Nine tenths of what rounds 1 up: three times 1 and that is nearer to the number above 3.
        let left_out = 0.45 * f64::EPSILON;
        let (mut q, mut q_left, mut v, mut v_left) = ([0.0], [0.0], [1.0], [left_out]);
        f64::pass(KickDrift {
            q: (&mut q, &mut q_left),
            v: (&mut v, &mut v_left),
            a: &[0.0],
            kick: &(0.0, 0.0),
            drift: &(3.0, 0.0),
        });
        assert_eq!((v[0], v_left[0]), (1.0, left_out));
        assert_eq!(q[0], 3.0_f64.next_up());
    }
}
