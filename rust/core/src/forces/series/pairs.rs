//! Forces along the lines between pairs as recurrences of Taylor coefficients.
//!
//! The one idea: of each pair, with `d = x_j - x_i`, `s = |d|²` (and a softening length squared) and `p = s^α`, the
//! coefficients of order n follow from sums of products of those before: `s_n = Σ d_k·d_(n-k)`, `n s_0 p_n =
//! Σ (αn - (α+1)k) s_(n-k) p_k` (from `s p' = α s' p`; Jorba & Zou 2005), and the pull is `Σ d_k p_(n-k)`; of
//! order 0 it may have another factor than the power alone. What goes with `p = s'/s` has `s' / s` in the place of the power:
//! `s_0 p_n = (n+1) s_(n+1) - Σ s_(n-k) p_k`. Every sum over k is
//! of the same two chains, whether the lanes are pairs or systems: the same bits alone and in a batch.
//!
//! What is newest comes last in each sum, so that a processor can be ahead with the rest.

use crate::numerics::element::{Element, Shape, View};
use crate::numerics::integrals::raise;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::real::Real;
use crate::ode::series::Jet;

/// Room for so many orders.
pub(in crate::forces) const ORDERS: usize = 24;

/// How pairs of bodies lie in registers.
pub(in crate::forces) trait Pairs<V> {
    /// The exponent α of the power of the squared distance.
    const EXPONENT: f64 = -1.5;
    /// Whether a multiple of the rate of the squared distance is divided by it instead; α is then -1.
    const BY_RATE: bool = false;
    /// Whether each order is compiled as it stands: no loop then ends where a processor does not expect it. That pays where
    /// there are few registers.
    const IN_FULL: bool = false;
    /// How many registers hold all pairs.
    fn registers(&self) -> usize;
    /// The softening length, squared, of those in a register; where there is no pair, it is no zero.
    fn softening2(&self, register: usize) -> V;
    /// From the first to the second of each pair: differences in the coefficients of an order and component, of which these
    /// are the rows.
    fn difference(&self, register: usize, order_and_component: (usize, usize), component: &[V]) -> V;
    /// Likewise in what those of order 0 leave out.
    #[inline(always)]
    fn rest(&self, register: usize, component: usize, rows: &[V]) -> V {
        self.difference(register, (0, component), rows)
    }
    /// Of order 0 the power of the squared distance, from that and its inverse, and what the difference is multiplied with;
    /// in the unit of time, whose square is told.
    #[inline(always)]
    fn begin(&self, _register: usize, [square, _]: [V; 2], unit2: V) -> [V; 2]
    where
        V: InverseCube,
    {
        let power = unit2 * square.inverse_cube();
        [power, power]
    }
    /// What that rate, in the unit of time, is multiplied with.
    #[inline(always)]
    fn of_rate(&self, _register: usize, unit: V) -> V {
        unit
    }
    /// Writes into `a` what the pulls, register by register, do to each body, if `first`, else adds it.
    fn sum<const C: usize>(&self, pulls: &[[V; C]], a: &mut [V], first: bool);
    /// Adds to `a` what else acts, where all coefficients are found at once: of an order, from those of coordinates and
    /// velocities.
    #[inline(always)]
    fn beside(&self, _n: usize, _coefficients: [&[V]; 2], _a: &mut [V]) {}
}

/// What is kept of the pairs from order to order.
pub(in crate::forces) struct Kept<S> {
    shape: Shape,
    /// For each register the coefficients of `d`, order by order, then those of `s`, of `p` (in whose
    /// place of order 0 is what the difference is multiplied with), and of `k p_k`, after `p_0`.
    work: Vec<S>,
    /// For each register the inverse of `s_0`.
    inverse: Vec<S>,
    /// For each register its pull.
    pulls: Vec<S>,
}

impl<S: Real> Kept<S> {
    pub(in crate::forces) fn new(shape: Shape, registers: usize) -> Self {
        let zeros = |numbers: usize| vec![S::zero(); registers * numbers];
        Self {
            shape,
            work: zeros((shape.components + 3) * ORDERS),
            inverse: zeros(1),
            pulls: zeros(shape.components),
        }
    }

    /// The same room for bodies in so many rows.
    pub(in crate::forces) fn lay_out(&mut self, rows: usize) {
        self.shape.rows = rows;
    }

    /// How many registers there are.
    pub(in crate::forces) fn registers(&self) -> usize {
        self.inverse.len()
    }

    /// Dimensions.
    pub(in crate::forces) fn components(&self) -> usize {
        self.shape.components
    }

    /// The coefficients of `d` and of `s` of a register.
    #[inline(always)]
    pub(super) fn distances<V: View<S>, const C: usize>(&self, register: usize) -> (&[[V; C]], &[V]) {
        let of_register = &V::view(&self.work)[register * (C + 3) * ORDERS..];
        let (d, own) = of_register.split_at(C * ORDERS);
        (d.as_chunks::<C>().0, &own[..ORDERS])
    }
}

/// What a coefficient is computed from.
pub(in crate::forces) struct Orders<'a, S> {
    pub(in crate::forces) kept: &'a mut Kept<S>,
    pub(in crate::forces) jet: &'a Jet<S>,
    pub(in crate::forces) n: usize,
    pub(in crate::forces) a: &'a mut [S],
    pub(in crate::forces) first: bool,
}

/// All coefficients, under nothing but these pulls and what they bring along.
pub(in crate::forces) struct Whole<'a, S> {
    pub(in crate::forces) kept: &'a mut Kept<S>,
    pub(in crate::forces) jet: &'a mut Jet<S>,
    pub(in crate::forces) a: &'a mut [S],
}

impl<S: Element> Orders<'_, S> {
    #[inline(always)]
    pub(in crate::forces) fn run<V: View<S> + InverseCube, P: Pairs<V>>(self, pairs: &P) {
        let Self { kept, jet, n, a, first } = self;
        let of_order = OfOrder {
            n,
            q: [V::view(jet.position(n)), V::view(jet.position(n + 1))],
            rest: V::view(&jet.rests[0]),
            unit: V::load(jet.unit),
            inverse_order: V::load(jet.inverse[n].0),
        };
        let kept_views =
            (V::view_mut(&mut kept.work), V::view_mut(&mut kept.inverse), V::view_mut(&mut kept.pulls));
        match kept.shape.components {
            2 => of_order.coefficient::<P, 2>(pairs, kept.shape.rows, kept_views, V::view_mut(a), first),
            _ => of_order.coefficient::<P, 3>(pairs, kept.shape.rows, kept_views, V::view_mut(a), first),
        }
    }
}

impl<S: Element> Whole<'_, S> {
    #[inline(always)]
    pub(in crate::forces) fn run<V: View<S> + InverseCube, P: Pairs<V>>(self, pairs: &P) {
        match self.kept.shape.components {
            2 => self.run_in::<V, P, 2>(pairs),
            _ => self.run_in::<V, P, 3>(pairs),
        }
    }
    #[inline(always)]
    fn run_in<V: View<S> + InverseCube, P: Pairs<V>, const C: usize>(self, pairs: &P) {
        let Self { kept, jet, a } = self;
        let (len, rows, unit) = (jet.len, kept.shape.rows, V::load(jet.unit));
        let (work, inverse, pulls) =
            (V::view_mut(&mut kept.work), V::view_mut(&mut kept.inverse), V::view_mut(&mut kept.pulls));
        let (q, v, rest, a) =
            (V::view_mut(&mut jet.q), V::view_mut(&mut jet.v), V::view(&jet.rests[0]), V::view_mut(a));
        macro_rules! order {
            ($n:expr) => {{
                let n = $n;
                let inverse_order = V::load(jet.inverse[n].0);
                let (own, next) = q[n * len..][..2 * len].split_at(len);
                let of_order = OfOrder { n, q: [own, next], rest, unit, inverse_order };
                of_order.coefficient::<P, C>(pairs, rows, (&mut *work, &mut *inverse, &mut *pulls), a, true);
                pairs.beside(n, [&q[n * len..][..len], &v[n * len..][..len]], a);
                let (of_v, of_q) = (V::scaled(&jet.inverse[n + 1]), V::scaled(&jet.inverse[n + 2]));
                raise(a, of_v, of_q, &mut v[(n + 1) * len..][..len], &mut q[(n + 2) * len..][..len]);
            }};
        }
        if !P::IN_FULL {
            for n in 0..jet.order {
                order!(n);
            }
            return;
        }
        debug_assert!(jet.order <= 22, "the orders below are all that there are");
        macro_rules! orders {
            ($($n:literal)+) => {$(
                if $n == jet.order {
                    return;
                }
                order!($n);
            )+};
        }
        orders!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21);
    }
}

/// What one order is computed from.
struct OfOrder<'a, V> {
    n: usize,
    /// The coefficients of the coordinates, and those of the next order.
    q: [&'a [V]; 2],
    /// What those of order 0 leave out.
    rest: &'a [V],
    unit: V,
    /// 1/n.
    inverse_order: V,
}

impl<V: InverseCube> OfOrder<'_, V> {
    #[inline(always)]
    fn coefficient<P: Pairs<V>, const C: usize>(
        self,
        pairs: &P,
        rows: usize,
        (work, inverse, pulls): (&mut [V], &mut [V], &mut [V]),
        a: &mut [V],
        first: bool,
    ) {
        let Self { n, q, rest, unit, inverse_order } = self;
        let of_weighted = inverse_order * V::splat(-1.0 - P::EXPONENT);
        let (pulls, _) = pulls.as_chunks_mut::<C>();
        let registers = pairs.registers();
        let pulls = &mut pulls[..registers];
        for register in 0..registers {
            let (d, own) = work[register * (C + 3) * ORDERS..][..(C + 3) * ORDERS].split_at_mut(C * ORDERS);
            let (d, _) = d.as_chunks_mut::<C>();
            let (s, own) = own.split_at_mut(ORDERS);
            let (p, multiples) = own.split_at_mut(ORDERS);
            if n == 0 {
                for c in 0..C {
                    d[0][c] = pairs.difference(register, (0, c), &q[0][c * rows..][..rows])
                        + pairs.rest(register, c, &rest[c * rows..][..rows]);
                }
                let mut square = pairs.softening2(register);
                for c in 0..C {
                    square = d[0][c].multiply_add(d[0][c], square);
                }
                s[0] = square;
                inverse[register] = V::one() / square;
            }
            let known = n + usize::from(P::BY_RATE);
            if known > 0 {
                for c in 0..C {
                    d[known][c] = pairs.difference(register, (known, c), &q[known - n][c * rows..][..rows]);
                }
                s[known] = squares::<V, C>(&d[..=known]);
            }
            if n == 0 {
                [multiples[0], p[0]] = if P::BY_RATE {
                    [V::splat(0.5) * pairs.of_rate(register, unit) * s[1] * inverse[register]; 2]
                } else {
                    pairs.begin(register, [s[0], inverse[register]], unit * unit)
                };
            } else {
                let factors = [V::splat(-P::EXPONENT), of_weighted];
                let mut power = powers::<V>(&s[1..=n], &p[..n], &multiples[..n], factors);
                if P::BY_RATE {
                    let of_rate = V::splat(0.5 * known as f64) * pairs.of_rate(register, unit);
                    power = of_rate.multiply_add(s[known], power);
                }
                let power = power * inverse[register];
                p[n] = power;
                multiples[n] = V::splat(n as f64) * power;
            }
            pulls[register] = products::<V, C>(&d[..=n], &p[..=n]);
        }
        pairs.sum::<C>(pulls, a, first);
    }
}

/// `Σ d_k·d_(n-k)`, each pair of orders once.
#[inline(always)]
fn squares<V: Real, const C: usize>(d: &[[V; C]]) -> V {
    let mut sums = [V::zero(); C];
    let half = d.len() / 2;
    let (low, high) = (&d[..half], &d[d.len() - half..]);
    for (low, high) in low.iter().rev().zip(high) {
        for c in 0..C {
            sums[c] = low[c].multiply_add(high[c], sums[c]);
        }
    }
    let mut sum = sums[0];
    for c in 1..C {
        sum += sums[c];
    }
    sum = sum + sum;
    if d.len() % 2 == 1 {
        let middle = d[half];
        for c in 0..C {
            sum = middle[c].multiply_add(middle[c], sum);
        }
    }
    sum
}

/// `s_0 p_n`, from `s` of orders 1 to n, `p` and `k p_k` of orders 1 to n - 1, before which stands `p_0`, and what the sums of
/// both are multiplied with: -α, and -(α+1)/n.
#[inline(always)]
fn powers<V: Real>(s: &[V], p: &[V], multiples: &[V], [of_plain, of_weighted]: [V; 2]) -> V {
    let last = s.len() - 1;
    let (mut plain, mut weighted) = ([V::zero(); 2], [V::zero(); 2]);
    let (rest, s_pairs) = s[..last].as_rchunks::<2>();
    let (p_pairs, p_rest) = p[1..].as_chunks::<2>();
    let (m_pairs, m_rest) = multiples[1..].as_chunks::<2>();
    for ((s, p), m) in s_pairs.iter().rev().zip(p_pairs).zip(m_pairs) {
        plain[0] = s[1].multiply_add(p[0], plain[0]);
        weighted[0] = s[1].multiply_add(m[0], weighted[0]);
        plain[1] = s[0].multiply_add(p[1], plain[1]);
        weighted[1] = s[0].multiply_add(m[1], weighted[1]);
    }
    if let ([s], [p], [m]) = (rest, p_rest, m_rest) {
        plain[0] = s.multiply_add(*p, plain[0]);
        weighted[0] = s.multiply_add(*m, weighted[0]);
    }
    let plain = s[last].multiply_add(multiples[0], plain[0] + plain[1]);
    let weighted = (weighted[0] + weighted[1]) * of_weighted;
    plain.multiply_subtract_from(of_plain, weighted)
}

/// `Σ d_k p_(n-k)`.
#[inline(always)]
fn products<V: Real, const C: usize>(d: &[[V; C]], p: &[V]) -> [V; C] {
    let last = p.len() - 1;
    let mut sums = [[V::zero(); C]; 2];
    let (d_pairs, d_rest) = d[1..].as_chunks::<2>();
    let (p_rest, p_pairs) = p[..last].as_rchunks::<2>();
    for (d, p) in d_pairs.iter().zip(p_pairs.iter().rev()) {
        for c in 0..C {
            sums[0][c] = d[0][c].multiply_add(p[1], sums[0][c]);
            sums[1][c] = d[1][c].multiply_add(p[0], sums[1][c]);
        }
    }
    if let ([d], [p]) = (d_rest, p_rest) {
        for c in 0..C {
            sums[0][c] = d[c].multiply_add(*p, sums[0][c]);
        }
    }
    let mut pull = [V::zero(); C];
    for c in 0..C {
        pull[c] = d[0][c].multiply_add(p[last], sums[0][c] + sums[1][c]);
    }
    pull
}
