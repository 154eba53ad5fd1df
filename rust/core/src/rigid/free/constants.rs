//! The constants of a free rotation: which axes, amplitudes, modulus, rates.
//!
//! With x, y, z for the axes of the other extreme moment, of the middle one and of the one that L goes round, and with
//! p = |1/I_x − 1/I_y|, q = |1/I_y − 1/I_z|, r = p + q, Euler's equations keep
//! X² = Lx² + (q/r) Ly², Y² = Ly² + (r/q) Lx², Z² = Lz² + (p/r) Ly² and D = q Lz² − p Lx² ≥ 0, and
//! L = (X cn, ±Y sn, Z dn) of λt + u₀ with λ² = q r Z², k² = p X²/(q Z²), k'² = D/(q Z²).

use super::theta::{Hyperbolic, Trigonometric};
use super::{FreeRotation, Kind, Polhode, Series};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elementary::Exponential;
use crate::numerics::elliptic::{complete_first_kind, incomplete_first_kind};
use crate::numerics::power_of_two::{exponent, scale};
use crate::numerics::real::Real;
use crate::numerics::rotation::Rotation;
use crate::numerics::scaled::Scaled;
use crate::rigid::moments::Frame;
use crate::rigid::quaternion::{IDENTITY, length};

/// The nome up to which its own series is taken.
const LARGEST_NOME: f64 = 0.15;

fn of(value: f64) -> DoubleDouble {
    DoubleDouble::from(value)
}

fn less(a: Scaled, b: Scaled) -> Scaled {
    a.minus(b)
}

fn square(a: Scaled) -> Scaled {
    a.by(a)
}

/// The unit vector along a vector; zero of zero.
pub(super) fn direction(v: [f64; 3]) -> [f64; 3] {
    let largest = v.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
    if largest == 0.0 {
        return v;
    }
    let size = exponent(largest);
    let near = v.map(|part| scale(part, -size));
    let long = length(near);
    near.map(|part| part / long)
}

/// What the series need.
#[derive(Clone, Copy, Debug)]
pub(super) struct Elliptic {
    /// q/r and p/r, and X/M, Z/M as roots of squares.
    over: [DoubleDouble; 2],
    along: [DoubleDouble; 2],
    complement: DoubleDouble,
    modulus: DoubleDouble,
    /// Y/(M + Z k'), the tangent of half the angle between L and the axis at a quarter period.
    tangent: DoubleDouble,
}

/// The motion, but for the orientation.
pub(super) fn found(moments: [f64; 3], angular_velocity: [f64; 3]) -> FreeRotation {
    let most = |v: [f64; 3]| v.iter().fold(0.0, |most: f64, part| most.max(part.abs()));
    let (moment_exponent, rate_exponent) = (exponent(most(moments)), exponent(most(angular_velocity)));
    let near = moments.map(|moment| scale(moment, -moment_exponent));
    let spin = angular_velocity.map(|rate| scale(rate, -rate_exponent));
    let momentum: [Scaled; 3] = core::array::from_fn(|at| Scaled::from(near[at]).times(spin[at]));
    let in_units = |value: Scaled| {
        Scaled::new(value.value(), value.exponent() + moment_exponent + rate_exponent).to_f64()
    };

    let mut order = [0, 1, 2];
    order.sort_by(|a, b| near[*a].total_cmp(&near[*b]));
    let turned =
        |a: usize, b: usize| momentum[a].to_f64() != 0.0 && momentum[b].to_f64() != 0.0 && near[a] != near[b];
    let rod = near[order[0]] == 0.0;
    if rod || !(turned(0, 1) || turned(1, 2) || turned(2, 0)) {
        return steady(angular_velocity, momentum.map(in_units), rate_exponent);
    }

    let inverse = |a: usize, b: usize| {
        let apart = Scaled::new(DoubleDouble::sum(near[b], -near[a]), 0);
        apart.over(Scaled::from(near[a]).by(Scaled::from(near[b])))
    };
    let [small, middle, large] = order;
    let (below, above) = (inverse(small, middle), inverse(middle, large));
    let side = less(above.by(square(momentum[large])), below.by(square(momentum[small])));
    let about_largest = side.to_f64() > 0.0 || (side.value().high() >= 0.0 && above.value().high() > 0.0);
    let (axes, p, q, sense) = if about_largest {
        ([small, middle, large], below, above, 1.0)
    } else {
        ([large, middle, small], above, below, -1.0)
    };
    let r = p.plus(q);
    let d = if about_largest { side } else { side.negative() };
    let sign = |at: usize| if momentum[at].to_f64() < 0.0 { -1.0 } else { 1.0 };
    let frame = Frame::new(axes, sign(axes[0]), sign(axes[2]));
    let l: [Scaled; 3] = core::array::from_fn(|at| momentum[axes[at]].times(frame.signs[at]));

    let squares = l.map(square);
    let x2 = squares[0].plus(q.over(r).by(squares[1]));
    let y2 = squares[1].plus(r.over(q).by(squares[0]));
    let z2 = squares[2].plus(p.over(r).by(squares[1]));
    let whole = squares[0].plus(squares[1]).plus(squares[2]).sqrt();
    let (x, y, z) = (x2.sqrt(), y2.sqrt().times(sense), z2.sqrt());
    let root = |value: Scaled| value.sqrt().to_double_double();
    let rate = q.by(r).sqrt().by(z);
    let modulus = root(p.by(x2).over(q.by(z2)));
    let complement = root(d.over(q.by(z2)));
    let ratio = |a: Scaled, b: Scaled| a.over(b).to_double_double();
    let [sine, cosine, delta] = [ratio(l[1], y), ratio(l[0], x), ratio(l[2], z)];
    let below_axis = whole.plus(z.by(Scaled::new(complement, 0)));
    let elliptic = Elliptic {
        over: [root(q.over(r)), root(p.over(r))],
        along: [ratio(x, whole), ratio(z, whole)],
        complement,
        modulus,
        tangent: ratio(y2.sqrt(), below_axis),
    };
    let start = incomplete_first_kind(sine, cosine, delta);
    let quarter = complete_first_kind(complement);
    let unscaled = |value: Scaled, more: i32| Scaled::new(value.value(), value.exponent() + more);

    let made = elliptic.series(quarter, sense);
    // The rate of the angle about L at a quarter period, M/I_y, tells that of the common phase.
    let middle_rate = whole.over(Scaled::from(near[axes[1]]));
    let [along_rate, precession] = [made.phase, made.precession]
        .map(|part| middle_rate.plus(rate.by(Scaled::new(part, 0)).times(sense)));
    let two_pi = DoubleDouble::PI.scale(2.0);
    let turns = along_rate.times(0.5).to_double_double() / two_pi;
    let (half_periods, start, period) = if matches!(made.series, Series::Separatrix(_)) {
        (rate.to_double_double(), start, f64::INFINITY)
    } else {
        let twice = quarter.scale(2.0);
        let rate = rate.to_double_double();
        (rate / twice, start / twice, (twice.scale(2.0) / rate).to_f64())
    };

    let velocity =
        |value: Scaled, at: usize| unscaled(value.over(Scaled::from(near[axes[at]])), rate_exponent).to_f64();
    let amplitudes = [x, y, z];
    let largest = frame.in_body(amplitudes.map(in_units));
    let symmetric = p.value().high() == 0.0;
    let kind = match (symmetric, &made.series, about_largest) {
        (true, _, _) => Kind::Symmetric,
        (_, Series::Separatrix(_), _) => Kind::Separatrix,
        (_, _, true) => Kind::AboutLargest,
        _ => Kind::AboutSmallest,
    };
    FreeRotation {
        kind,
        frame,
        series: made.series,
        angular_velocity: core::array::from_fn(|at| velocity(amplitudes[at], at)),
        angular_momentum: amplitudes.map(in_units),
        steady: [0.0; 3],
        time_exponent: rate_exponent,
        half_periods,
        start,
        turns,
        turns_per_half_period: made.turns_per_half_period,
        sense,
        before: IDENTITY,
        after: IDENTITY,
        polhode: Polhode {
            axes,
            rate: unscaled(rate, rate_exponent).to_f64(),
            modulus: modulus.to_f64(),
            complement: complement.to_f64(),
            period: scale(period, -rate_exponent),
            precession: unscaled(precession, rate_exponent).to_f64(),
            largest,
        },
    }
}

/// A body whose angular velocity stays what it is.
fn steady(angular_velocity: [f64; 3], momentum: [f64; 3], rate_exponent: i32) -> FreeRotation {
    let near = angular_velocity.map(|rate| Scaled::new(of(rate), -rate_exponent));
    let rate = near.iter().fold(Scaled::ZERO, |sum, part| sum.plus(square(*part))).sqrt().to_double_double();
    let size = scale(rate.to_f64(), rate_exponent);
    FreeRotation {
        kind: Kind::Steady,
        frame: Frame::new([0, 1, 2], 1.0, 1.0),
        series: Series::Steady,
        angular_velocity,
        angular_momentum: momentum,
        steady: angular_velocity,
        time_exponent: rate_exponent,
        half_periods: rate / DoubleDouble::PI.scale(2.0),
        start: of(0.0),
        turns: of(0.0),
        turns_per_half_period: of(0.0),
        sense: 1.0,
        before: IDENTITY,
        after: IDENTITY,
        polhode: Polhode {
            axes: [0, 1, 2],
            rate: 0.0,
            modulus: 0.0,
            complement: 1.0,
            period: f64::INFINITY,
            precession: size,
            largest: momentum,
        },
    }
}

/// A series and what goes with it: the rates of phases in units of the rate of the argument, beside M/I_y.
struct Made {
    series: Series,
    phase: DoubleDouble,
    precession: DoubleDouble,
    turns_per_half_period: DoubleDouble,
}

fn power(base: DoubleDouble, exponent: usize) -> DoubleDouble {
    (0..exponent).fold(of(1.0), |product, _| product * base)
}

impl Elliptic {
    fn series(&self, quarter: DoubleDouble, sense: f64) -> Made {
        let other = complete_first_kind(self.modulus);
        let half_pi = DoubleDouble::PI.scale(0.5);
        if self.complement.high() == 0.0 {
            return self.hyperbolic(of(0.0), half_pi, quarter, sense);
        }
        let exponent = if self.modulus.high() == 0.0 {
            of(f64::NEG_INFINITY)
        } else {
            -(DoubleDouble::PI * other / quarter)
        };
        let nome = if exponent.is_finite() { exponent.exp() } else { of(0.0) };
        if nome.high() <= LARGEST_NOME {
            return self.trigonometric(nome, quarter);
        }
        // √ of the complementary nome.
        let s = (-(half_pi * quarter / other)).exp();
        self.hyperbolic(s, other, quarter, sense)
    }

    fn trigonometric(&self, nome: DoubleDouble, quarter: DoubleDouble) -> Made {
        let [x, z] = self.along;
        let [q, p] = self.over;
        // From the pole η of dn² = (M/Z)² to the end of the strip, and to its middle.
        let to_end = incomplete_first_kind(z, x, x / q);
        let g = (-(DoubleDouble::PI * to_end / quarter)).exp();
        let h = if p.high() == 0.0 || nome.high() == 0.0 {
            of(0.0)
        } else {
            let to_middle = incomplete_first_kind(q, p, p / z);
            (-(DoubleDouble::PI * to_middle / quarter)).exp()
        };
        let mut series = Trigonometric::default();
        // At a quarter, where all terms have one sign: values and derivatives over i.
        let (mut fourth, mut fourth_rate, mut first, mut first_rate) = (of(1.0), of(0.0), of(0.0), of(0.0));
        let mut odd = [[of(0.0); 2]; 4];
        for n in 0..4 {
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            let falling = power(nome, 2 * n * n + n) * power(g, n);
            let rising = power(nome, 2 * n * n + 2 * n) * power(h, n + 1);
            odd[n] = [(falling - rising).scale(sign), -(falling + rising).scale(sign)];
            first += falling + rising;
            first_rate += (falling - rising) * of((2 * n + 1) as f64);
            series.odd[n] = power(nome, n * (n + 1)).to_f64();
            let m = n + 1;
            series.squares[n] = 2.0 * power(nome, m * m).to_f64();
            if n < 3 {
                let rising = power(nome, 2 * m * m) * power(h, m);
                let falling = power(nome, 2 * m * m - m) * power(g, m);
                series.even_terms[n] =
                    [(-(rising + falling).scale(sign)).to_f64(), (-(rising - falling).scale(sign)).to_f64()];
                fourth += rising + falling;
                fourth_rate += (rising - falling) * of((2 * m) as f64);
            }
        }
        let ratio = self.tangent * fourth / first;
        series.odd_terms = odd.map(|term| term.map(|part| (part * ratio).to_f64()));
        series.scale = [1.0; 3];
        let ([_, cn, dn], _, _) = series.at(0.0, 1.0);
        let ([sn, _, _], _, _) = series.at(1.0, 0.0);
        series.scale = [1.0 / sn, 1.0 / cn, 1.0 / dn];
        let per_argument = DoubleDouble::PI.scale(0.5) / quarter;
        let phase = (fourth_rate / fourth - first_rate / first) * per_argument;
        Made {
            series: Series::Trigonometric(series),
            phase,
            precession: phase + per_argument,
            turns_per_half_period: of(0.0),
        }
    }

    fn hyperbolic(&self, s: DoubleDouble, other: DoubleDouble, quarter: DoubleDouble, sense: f64) -> Made {
        let [q, p] = self.over;
        let [_, z] = self.along;
        let pole = DoubleDouble::PI.scale(0.25) * incomplete_first_kind(q, p, p / z) / other;
        let mut series = Hyperbolic::default();
        // At a quarter: values and derivatives.
        let zero = [of(0.0); 2];
        let (mut second, mut second_rate, mut first, mut first_rate) = (zero, zero, zero, zero);
        for n in 0..4 {
            let sign = if n % 2 == 0 { 1.0 } else { -1.0 };
            let odd = of((2 * n + 1) as f64);
            let turn = Rotation::new(Scaled::new(pole * odd, 0));
            let (cosine, sine) = (turn.cosine.to_double_double(), turn.sine.to_double_double());
            let (up, down) = (power(s, n * n), power(s, (n + 1) * (n + 1)));
            let (both, apart) = (up + down, up - down);
            series.squares[n] = up.to_f64();
            series.products[n] = power(s, n * n + n).to_f64();
            series.angles[n] = [cosine.to_f64(), sine.to_f64()];
            series.double_squares[n] = power(s, 2 * n * n).to_f64();
            series.double_products[n] = power(s, 2 * n * (n + 1)).to_f64();
            series.before[n] = power(s, 2 * n * n - if n == 0 { 0 } else { 2 * n }).to_f64();
            let add = |sum: &mut [DoubleDouble; 2], real: DoubleDouble, imaginary: DoubleDouble| {
                sum[0] += real;
                sum[1] += imaginary;
            };
            add(&mut second, cosine * both, sine * apart);
            add(&mut second_rate, cosine * apart * odd, sine * both * odd);
            add(&mut first, (sine * both).scale(sign), -(cosine * apart).scale(sign));
            add(&mut first_rate, (sine * apart * odd).scale(sign), -(cosine * both * odd).scale(sign));
        }
        let size = |v: [DoubleDouble; 2]| v[0] * v[0] + v[1] * v[1];
        series.ratio = (self.tangent * (size(second) / size(first)).sqrt()).to_f64();
        // Of the derivative over the value, the imaginary part.
        let turning = |rate: [DoubleDouble; 2], value: [DoubleDouble; 2]| {
            (rate[1] * value[0] - rate[0] * value[1]) / size(value)
        };
        series.scale = [1.0; 3];
        let (ahead, half) = if s.high() == 0.0 {
            (f64::NEG_INFINITY, f64::INFINITY)
        } else {
            let half = DoubleDouble::PI.scale(0.5) * quarter / other;
            (-half.to_f64(), half.to_f64())
        };
        let ([_, cn, dn], _, _) = series.at(0.0, ahead);
        let ([sn, _, _], _, _) = series.at(ahead, 0.0);
        series.scale = [1.0 / sn, 1.0 / cn, 1.0 / dn];
        if s.high() == 0.0 {
            return Made {
                series: Series::Separatrix(series),
                phase: of(0.0),
                precession: of(0.0),
                turns_per_half_period: of(0.0),
            };
        }
        let per_argument = DoubleDouble::PI.scale(0.25) / other;
        let phase = (turning(second_rate, second) + turning(first_rate, first)) * per_argument;
        Made {
            series: Series::Hyperbolic { series, half_period: half },
            phase,
            precession: phase - (pole.scale(4.0) - DoubleDouble::PI) / quarter.scale(2.0),
            turns_per_half_period: -(pole / DoubleDouble::PI).scale(sense),
        }
    }
}
