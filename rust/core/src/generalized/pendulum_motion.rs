//! The plane pendulum, θ″ = −a sin θ + b cos θ, however it is written: solved by Jacobi's elliptic functions, exact at any time.
//!
//! The one idea: half of the angle from the lowest point has the sine k sn, the cosine dn, and the rate k cn, so that the addition
//! theorem leads from any start to any time (NIST DLMF 22.8), and nothing is inverted. Whole periods are taken out in
//! double-double: the phase after many of them is as good as after none. Beyond the highest point, where k > 1, Jacobi's real
//! transformation leads to a modulus of 1/k (DLMF 22.17).

use super::exact::{ExactMotion, Flow};
use super::model::{Kind, Model};
use crate::error::{Error, Result};
use crate::expressions::graph::Dependence;
use crate::expressions::precise::Precise;
use crate::expressions::program::Output;
use crate::expressions::{Graph, Id};
use crate::numerics::angles::{self, atan2};
use crate::numerics::double_double::DoubleDouble;
use crate::numerics::elliptic::complete_first_kind;
use crate::numerics::functions::precise::sin_cos;
use crate::numerics::jacobi_elliptic::jacobi;
use crate::numerics::real::Real;
use core::f64::consts::{FRAC_PI_2, TAU};
use rustc_hash::FxHashMap;

/// Equations of motion of a pendulum.
#[derive(Clone, Debug)]
pub struct PendulumMotion {
    /// At an angle of zero: the torque, its slope, and what it is divided by, or multiplied with if that is what makes a rate of a
    /// momentum.
    at_zero: Precise,
    /// Whether the second number is a momentum.
    is_momentum: bool,
}

impl PendulumMotion {
    /// That of a model, if its equation is that of a pendulum: a torque whose second derivative is its negative.
    pub fn of(model: &Model) -> Option<Self> {
        let source = &model.source;
        let constrained = !source.holonomic.is_empty() || !source.nonholonomic.is_empty();
        if constrained || source.coordinates != 1 || model.numbers() != 2 || model.needs().time {
            return None;
        }
        let mut graph = source.graph.clone();
        let is_momentum = source.kind == Kind::Hamiltonian;
        let (torque, factor) = if is_momentum {
            let rates: Vec<Id> = model.rates.iter().map(Output::node).collect::<Option<_>>()?;
            let &[speed, torque] = rates.as_slice() else { return None };
            (torque, rate_of_momentum(&mut graph, speed)?)
        } else {
            let &[torque] = model.right.as_slice() else { return None };
            (torque, *model.mass.first()?.first()?)
        };
        let slope = derivative(&mut graph, torque, 0);
        let curvature = derivative(&mut graph, slope, 0);
        let own = derivative(&mut graph, torque, 1);
        let sum = graph.add(torque, curvature);
        let vanishes = |graph: &Graph, id: Id| graph.as_constant(id) == Some(0.0);
        let turns = vanishes(&graph, sum) && vanishes(&graph, own) && graph.as_constant(slope).is_none();
        if !turns || graph.dependence(factor) > Dependence::Parameters {
            return None;
        }
        Some(Self { at_zero: Precise::new(&graph, &[torque, slope, factor]), is_momentum })
    }
}

/// The derivative of an expression by a number of the state.
fn derivative(graph: &mut Graph, of: Id, number: u32) -> Id {
    let (by, one) = (graph.variable(number), graph.constant(1.0));
    graph.tangent(&[of], &FxHashMap::from_iter([(by, one)]))[0]
}

/// What a momentum is multiplied with to give the rate, if that is all there is.
fn rate_of_momentum(graph: &mut Graph, speed: Id) -> Option<Id> {
    let factor = derivative(graph, speed, 1);
    let momentum = graph.variable(1);
    let product = graph.multiply(factor, momentum);
    let rest = graph.subtract(speed, product);
    (graph.as_constant(rest) == Some(0.0)).then_some(factor)
}

impl ExactMotion for PendulumMotion {
    fn flow(&self, (y0, parameters): (&[f64], &[f64]), _: (f64, f64)) -> Result<Box<dyn Flow>> {
        let zeros = [DoubleDouble::zero(); 2];
        let values = self.at_zero.at(0.0, &zeros, parameters);
        let (&[torque, slope, factor], &[angle, second]) = (values.as_slice(), y0) else {
            return Err(Error::Internal("a pendulum has two numbers".to_owned()));
        };
        if !self.is_momentum && factor.high() == 0.0 {
            return Err(Error::invalid("parameters", "the mass matrix is singular for these"));
        }
        let to_rate = |x: DoubleDouble| if self.is_momentum { x * factor } else { x / factor };
        let second_as_rate = DoubleDouble::from(second);
        let rate = if self.is_momentum { to_rate(second_as_rate) } else { second_as_rate };
        let restoring = [-to_rate(slope), to_rate(torque)];
        let scale = if self.is_momentum { factor.to_f64() } else { 1.0 };
        let mut flow = PendulumFlow::new([angle, second], rate, restoring, scale);
        if self.is_momentum && factor.high() == 0.0 {
            let (sine, cosine) = angles::sin_cos(angle);
            flow.push = torque.to_f64().mul_add(cosine, slope.to_f64() * sine);
        }
        Ok(Box::new(flow))
    }
}

/// How far it goes.
#[derive(Clone, Copy, Debug)]
enum Course {
    /// Nothing pulls, or nothing moves.
    Uniform,
    /// To and fro, in this time.
    Swinging(DoubleDouble),
    /// Ever nearer to the highest point.
    Asymptotic,
    /// Around, in this time.
    Turning(DoubleDouble),
}

/// A pendulum on its way. Its numbers at the start are of half of the angle from the lowest point.
#[derive(Clone, Copy, Debug)]
struct PendulumFlow {
    start: [f64; 2],
    rate: f64,
    /// By what the second number grows where it moves nothing: a momentum that no velocity belongs to.
    push: f64,
    sine: f64,
    cosine: f64,
    /// The rate of half of the angle, over the frequency.
    pace: f64,
    frequency: DoubleDouble,
    /// What elapsed times are multiplied with to be arguments, and the complement of the parameter.
    argument: DoubleDouble,
    complement: f64,
    modulus: f64,
    course: Course,
    /// What the second number is multiplied with to be the rate.
    scale: f64,
}

/// Half of the angle whose cosine and sine are as these.
fn half_of(cosine: DoubleDouble, sine: DoubleDouble, size: DoubleDouble) -> [DoubleDouble; 2] {
    let two = |x: DoubleDouble| x + x;
    let root = ((size + cosine.abs()) / two(size)).sqrt();
    let other = sine.abs() / two(size * root);
    let [c, s] = if cosine.high() >= 0.0 { [root, other] } else { [other, root] };
    [c, if sine.high() < 0.0 { -s } else { s }]
}

/// Of an angle, which may have so many turns that no more digits are known than a number has.
fn sine_and_cosine(angle: f64) -> (DoubleDouble, DoubleDouble) {
    let (sine, cosine) = sin_cos(DoubleDouble::from(angle));
    if sine.is_finite() {
        return (sine, cosine);
    }
    let (sine, cosine) = angles::sin_cos(angle);
    (DoubleDouble::from(sine), DoubleDouble::from(cosine))
}

impl PendulumFlow {
    /// From an angle and a rate, where these multiples of sine and cosine restore.
    fn new(start: [f64; 2], rate: DoubleDouble, [a, b]: [DoubleDouble; 2], scale: f64) -> Self {
        let (large, small) = if a.abs() < b.abs() { (b.abs(), a.abs()) } else { (a.abs(), b.abs()) };
        let one = DoubleDouble::one();
        let strength = if small.high() == 0.0 {
            large
        } else {
            large * ((small / large) * (small / large) + one).sqrt()
        };
        let frequency = strength.sqrt();
        let mut flow = Self {
            start,
            rate: rate.to_f64(),
            push: 0.0,
            sine: 0.0,
            cosine: 1.0,
            pace: 0.0,
            frequency,
            argument: frequency,
            complement: 1.0,
            modulus: 0.0,
            course: Course::Uniform,
            scale,
        };
        if strength.high() == 0.0 {
            return flow;
        }
        let (own_sine, own_cosine) = sine_and_cosine(0.5 * start[0]);
        let [cosine, sine] = half_of(a, b, strength);
        let (sine, cosine) = (own_sine * cosine - own_cosine * sine, own_cosine * cosine + own_sine * sine);
        // Half a turn further is the same pendulum: below the highest point the cosine is dn, and positive.
        let (sine, cosine) = if cosine.high() < 0.0 { (-sine, -cosine) } else { (sine, cosine) };
        let pace = rate / (frequency + frequency);
        (flow.sine, flow.cosine, flow.pace) = (sine.to_f64(), cosine.to_f64(), pace.to_f64());
        // 1 − k², without what cancels.
        let complement = (cosine - pace.abs()) * (cosine + pace.abs());
        let square = sine * sine + pace * pace;
        // At rest, at the lowest point or at the highest.
        if pace.high() == 0.0 && (sine.high() == 0.0 || complement.high() == 0.0) {
            return flow;
        }
        if complement.high() > 0.0 {
            let period = complete_first_kind(complement.sqrt()).scale(4.0) / frequency;
            (flow.complement, flow.course) = (complement.to_f64(), Course::Swinging(period));
        } else if complement.high() == 0.0 {
            (flow.complement, flow.course) = (0.0, Course::Asymptotic);
        } else {
            let (modulus, complement) = (square.sqrt(), -complement / square);
            flow.argument = modulus * frequency;
            let around = complete_first_kind(complement.sqrt()).scale(2.0) / flow.argument;
            (flow.complement, flow.modulus) = (complement.to_f64(), modulus.to_f64());
            flow.course = Course::Turning(around);
        }
        flow
    }
}

/// So many whole periods, and what is left.
fn reduced(elapsed: DoubleDouble, period: DoubleDouble, whole: fn(f64) -> f64) -> (f64, DoubleDouble) {
    let periods = whole((elapsed / period).to_f64());
    (periods, elapsed - period * DoubleDouble::from(periods))
}

impl Flow for PendulumFlow {
    fn look(&self) -> f64 {
        // A radian of the fastest.
        let fastest = Real::max(self.argument.to_f64(), self.rate.abs());
        if fastest > 0.0 { 1.0 / fastest } else { f64::INFINITY }
    }

    fn after(&mut self, (high, low): (f64, f64)) -> Vec<f64> {
        let elapsed = DoubleDouble::sum(high, low);
        let [angle, second] = self.start;
        let mut turns = 0.0;
        let left = match self.course {
            Course::Uniform => return vec![self.rate.mul_add(high, angle), self.push.mul_add(high, second)],
            Course::Asymptotic => elapsed,
            Course::Swinging(period) => reduced(elapsed, period, f64::round).1,
            Course::Turning(around) => {
                let (whole, left) = reduced(elapsed, around, f64::floor);
                turns = whole.copysign(whole * self.pace);
                left
            }
        };
        let [sn, cn, dn] = jacobi((self.argument * left).to_f64(), self.complement);
        let [s, c, d] =
            if let Course::Turning(_) = self.course { [sn / self.modulus, dn, cn] } else { [sn, cn, dn] };
        let Self { sine, cosine, pace, .. } = *self;
        let over = 1.0 / (cosine * cosine + sine * sine * c * c);
        let now_sine = (sine * c * d + s * pace * cosine) * over;
        let now_cosine = (cosine * d - sine * pace * s * c) * over;
        let now_pace = (pace * c - sine * cosine * s * d) * over;
        let mut half = atan2(now_sine * cosine - now_cosine * sine, now_cosine * cosine + now_sine * sine);
        if let Course::Turning(_) = self.course {
            // Of less than a turn, half is to one side, but for rounding.
            if half * pace.signum() < -FRAC_PI_2 {
                half += TAU.copysign(pace);
            }
        }
        let way = TAU.mul_add(turns, 2.0 * half);
        let rate = 2.0 * self.frequency.to_f64() * now_pace;
        vec![angle + way, rate / self.scale]
    }
}
