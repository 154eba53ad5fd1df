//! Two bodies under nothing but their gravity.
//!
//! The one idea: what is between them, `d = x_1 - x_0`, has `d'' = -(m_0 + m_1) p d`, so its coefficients follow from those
//! of the pull `p d` without the bodies, and those of the bodies from the pulls when all are known. From order to
//! order a processor then waits for five operations; the sums over older orders are of two chains each and of nothing that is new.

use super::ORDERS;
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::element::{Element, Pass, View};
use crate::numerics::integrals::raise;
use crate::numerics::inverse_cube::InverseCube;
use crate::numerics::lanes::Lanes;
use crate::numerics::real::Real;
use crate::ode::series::Jet;
use std::sync::LazyLock;

/// The numbers of an order.
#[derive(Clone, Copy, Debug)]
struct Numbers {
    /// -1/(2n).
    half: DoubleDouble,
    /// -(1 + 1/(2n)).
    newest: DoubleDouble,
    /// -1/((n+1)(n+2)), and what it leaves out.
    twice: (f64, f64),
}

/// The recurrence of what is between two bodies.
#[derive(Debug)]
pub(super) struct Between {
    numbers: &'static [Numbers; ORDERS],
    softening2: f64,
}

/// They take a division each, so a short run does not make them anew.
static NUMBERS: LazyLock<[Numbers; ORDERS]> = LazyLock::new(|| {
    let one = DoubleDouble::from(1.0);
    core::array::from_fn(|n| {
        let half = DoubleDouble::from(-0.5) / DoubleDouble::from(n.max(1) as f64);
        let twice = one / DoubleDouble::from(((n + 1) * (n + 2)) as f64);
        Numbers { half, newest: half - one, twice: (-twice.high(), -twice.low()) }
    })
});

/// What is between them at the start, in units of time of the series.
struct Start<V, const C: usize> {
    places: [V; C],
    speeds: [V; C],
    /// The unit of time.
    unit: V,
    /// `m_0 + m_1`.
    strength: V,
}

/// Coefficients of `d`, then those of `s/s_0` and n times those, then zeros to the full `W` numbers.
type Rows<V, const W: usize> = [[V; W]; ORDERS];

/// What is known of the orders below one.
struct Known<V, const W: usize> {
    rows: Rows<V, W>,
    /// Coefficients of `p`.
    powers: [V; ORDERS],
    /// Twice `d_0`, `-3/2 p_0/s_0`, and `d_0` times that.
    twice: [V; W],
    factor: V,
    turned: [V; W],
    inverse: V,
    strength: V,
}

impl Between {
    pub(super) fn new(softening2: f64) -> Self {
        Self { numbers: &NUMBERS, softening2 }
    }

    /// Order 0.
    #[inline(always)]
    fn begin<V: InverseCube, const C: usize, const W: usize>(&self, start: &Start<V, C>) -> Known<V, W> {
        let Start { places, speeds, unit, strength } = *start;
        let mut square = V::splat(self.softening2);
        let mut rows = [[V::zero(); W]; ORDERS];
        let mut twice = [V::zero(); W];
        for c in 0..C {
            square = places[c].multiply_add(places[c], square);
            twice[c] = places[c] + places[c];
            (rows[0][c], rows[1][c]) = (places[c], speeds[c]);
        }
        let inverse = V::one() / square;
        let mut powers = [V::zero(); ORDERS];
        powers[0] = unit * unit * square.inverse_cube();
        let factor = V::splat(-1.5) * powers[0] * inverse;
        let mut turned = [V::zero(); W];
        for c in 0..C {
            turned[c] = places[c] * factor;
        }
        Known { rows, powers, twice, factor, turned, inverse, strength }
    }

    /// The coefficient of order `n` of the pull.
    #[inline(always)]
    fn pull<V: InverseCube, const C: usize, const W: usize>(
        &self,
        n: usize,
        known: &mut Known<V, W>,
    ) -> [V; C] {
        let Known { rows, powers, twice, factor, turned, inverse, strength } = known;
        let Numbers { half, newest, twice: inverses } = self.numbers[n];
        let mut pull = [V::zero(); C];
        if n > 0 {
            let mut square = older_squares::<V, C, W>(rows, n);
            for c in 0..C {
                square = twice[c].multiply_add(rows[n][c], square);
            }
            let sums = older_products(rows, powers, n);
            let mut power = V::from_double_double(half).multiply_add(sums[C + 1], -sums[C]);
            if n > 1 {
                power = (V::from_double_double(newest) * rows[1][C]).multiply_add(powers[n - 1], power);
            }
            powers[n] = factor.multiply_add(square, power);
            rows[n][C] = square * *inverse;
            rows[n][C + 1] = V::splat(n as f64) * rows[n][C];
            for c in 0..C {
                let older = if n > 1 { rows[1][c].multiply_add(powers[n - 1], sums[c]) } else { sums[c] };
                let older = rows[0][c].multiply_add(power, rows[n][c].multiply_add(powers[0], older));
                // Not from the new power: the next orders wait for this.
                pull[c] = turned[c].multiply_add(square, older);
            }
        } else {
            for c in 0..C {
                pull[c] = rows[0][c] * powers[0];
            }
        }
        // What both pull, over (n+1)(n+2), and what that leaves out.
        let high = *strength * V::splat(inverses.0);
        let low =
            strength.multiply_add(V::splat(inverses.1), strength.multiply_add(V::splat(inverses.0), -high));
        for c in 0..C {
            rows[n + 2][c] = pull[c].multiply_add(high, pull[c] * low);
        }
        pull
    }
}

/// `Σ d_k·d_(n-k)` over k from 1 to n - 1, each pair of orders once.
#[inline(always)]
fn older_squares<V: Real, const C: usize, const W: usize>(rows: &Rows<V, W>, n: usize) -> V {
    let mut sums = [V::zero(); C];
    let mut low = (n - 1) / 2;
    while low > 0 {
        for c in 0..C {
            sums[c] = rows[low][c].multiply_add(rows[n - low][c], sums[c]);
        }
        low -= 1;
    }
    let mut sum = sums[0];
    for c in 1..C {
        sum += sums[c];
    }
    sum = sum + sum;
    if n.is_multiple_of(2) {
        for c in 0..C {
            sum = rows[n / 2][c].multiply_add(rows[n / 2][c], sum);
        }
    }
    sum
}

/// `Σ row_k p_(n-k)` over k from 2 to n - 1, of even k and of odd k.
#[inline(always)]
fn older_products<V: Real, const W: usize>(rows: &Rows<V, W>, powers: &[V; ORDERS], n: usize) -> [V; W] {
    let mut sums = [[V::zero(); W]; 2];
    for chain in 0..2 {
        let mut k = 2 + chain;
        while k < n {
            for w in 0..W {
                sums[chain][w] = rows[k][w].multiply_add(powers[n - k], sums[chain][w]);
            }
            k += 2;
        }
    }
    let mut sum = [V::zero(); W];
    for w in 0..W {
        sum[w] = sums[0][w] + sums[1][w];
    }
    sum
}

/// Two bodies in two elements of each row, as many trajectories as an element has.
pub(super) struct Beside<'a, S> {
    pub(super) between: &'a Between,
    pub(super) strength: &'a [S],
    pub(super) jet: &'a mut Jet<S>,
}

impl<S: Element> Pass<S> for Beside<'_, S> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<S>>(self) {
        // Numbers of a row: components, and two of the squares.
        match self.jet.len {
            4 => self.run_in::<V, 2, 4>(),
            _ => self.run_in::<V, 3, 5>(),
        }
    }
}

impl<S: Element> Beside<'_, S> {
    #[inline(always)]
    fn run_in<V: View<S>, const C: usize, const W: usize>(self) {
        let Self { between, strength, jet } = self;
        let Jet { order, len, ref mut q, ref mut v, ref rests, unit, ref inverse, .. } = *jet;
        let (q, v, rest) = (V::view_mut(q), V::view_mut(v), V::view(&rests[0]));
        let strength = V::view(strength);
        let (mut places, mut speeds) = ([V::zero(); C], [V::zero(); C]);
        for c in 0..C {
            places[c] = (q[2 * c + 1] - q[2 * c]) + (rest[2 * c + 1] - rest[2 * c]);
            speeds[c] = q[len + 2 * c + 1] - q[len + 2 * c];
        }
        let start = Start { places, speeds, unit: V::load(unit), strength: strength[0] + strength[1] };
        let mut known = between.begin::<V, C, W>(&start);
        for n in 0..order {
            let pull = between.pull::<V, C, W>(n, &mut known);
            let mut a = [[V::zero(); 2]; C];
            for c in 0..C {
                a[c] = [strength[1] * pull[c], -(strength[0] * pull[c])];
            }
            let (of_v, of_q) = (V::scaled(&inverse[n + 1]), V::scaled(&inverse[n + 2]));
            let (v, q) = (&mut v[(n + 1) * len..][..len], &mut q[(n + 2) * len..][..len]);
            raise(a.as_flattened(), of_v, of_q, v, q);
        }
    }
}

/// Two bodies of one trajectory in the lanes of each row: the seven others would be idle, so what is between them is
/// computed a number at a time, and its pulls are given to both.
pub(super) struct Along {
    between: Between,
    /// `m_0 + m_1`.
    strength: f64,
    /// What a pull does to them.
    weights: Lanes,
    pulls: [[f64; 3]; ORDERS],
}

impl Along {
    pub(super) fn new(strength: [f64; 2], softening2: f64) -> Self {
        let [first, second] = strength;
        let weights = Lanes([second, -first, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let between = Between::new(softening2);
        Self { between, strength: first + second, weights, pulls: [[0.0; 3]; ORDERS] }
    }

    /// As [`Series::expand`](crate::forces::series::Series::expand).
    pub(super) fn expand(&mut self, jet: &mut Jet<Lanes>) {
        match jet.len {
            2 => {
                f64::pass(Pulls::<2> { along: self, jet });
                Lanes::pass(Spread::<2> { along: self, jet });
            }
            _ => {
                f64::pass(Pulls::<3> { along: self, jet });
                Lanes::pass(Spread::<3> { along: self, jet });
            }
        }
    }
}

struct Pulls<'a, const C: usize> {
    along: &'a mut Along,
    jet: &'a Jet<Lanes>,
}

impl<const C: usize> Pass<f64> for Pulls<'_, C> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<f64>>(self) {
        // Rows as wide as registers.
        if C == 2 { self.run_in::<V, 4>() } else { self.run_in::<V, 8>() }
    }
}

impl<const C: usize> Pulls<'_, C> {
    #[inline(always)]
    fn run_in<V: View<f64>, const W: usize>(self) {
        let Self { along, jet } = self;
        let Along { between, strength, pulls, .. } = along;
        let (q, rest) = (&jet.q, &jet.rests[0]);
        let (mut places, mut speeds) = ([V::zero(); C], [V::zero(); C]);
        for c in 0..C {
            let [place, rest, speed] = [q[c].0, rest[c].0, q[C + c].0];
            places[c] = V::load((place[1] - place[0]) + (rest[1] - rest[0]));
            speeds[c] = V::load(speed[1] - speed[0]);
        }
        let start = Start { places, speeds, unit: V::load(jet.unit.0[0]), strength: V::load(*strength) };
        let mut known = between.begin::<V, C, W>(&start);
        // Each order as it stands: no loop ends where a processor does not expect it.
        macro_rules! orders {
            ($($n:literal)+) => {$(
                if $n == jet.order {
                    return;
                }
                let pull = between.pull::<V, C, W>($n, &mut known);
                for c in 0..C {
                    pulls[$n][c] = pull[c].store();
                }
            )+};
        }
        orders!(0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21);
    }
}

struct Spread<'a, const C: usize> {
    along: &'a Along,
    jet: &'a mut Jet<Lanes>,
}

impl<const C: usize> Pass<Lanes> for Spread<'_, C> {
    type Output = ();
    #[inline(always)]
    fn run<V: View<Lanes>>(self) {
        let Self { along, jet } = self;
        let (order, weights) = (jet.order, V::load(along.weights));
        let (q, _) = V::view_mut(&mut jet.q).as_chunks_mut::<C>();
        let (v, _) = V::view_mut(&mut jet.v).as_chunks_mut::<C>();
        let (q, v, inverse) = (&mut q[2..order + 2], &mut v[1..=order], &jet.inverse[1..order + 2]);
        for (n, pull) in along.pulls[..order].iter().enumerate() {
            let mut a = [V::zero(); C];
            for c in 0..C {
                a[c] = V::splat(pull[c]) * weights;
            }
            raise(&a, V::scaled(&inverse[n]), V::scaled(&inverse[n + 1]), &mut v[n], &mut q[n]);
        }
    }
}

#[cfg(test)]
mod tests;
