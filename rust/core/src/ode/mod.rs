//! Integrators of ordinary differential equations: a method is a table; the loops that run tables are written once.
//!
//! The one idea: problem ([`system`]), method ([`Method`]), state ([`state`]) and the loop over steps ([`fixed`], [`run`],
//! and whoever drives a [`trial`]) know each other only by what they declare. Nothing here knows particles.
//!
//! To add a method, write one file in `methods` that defines `METHOD` and add its line to
//! [`registry::METHODS`](crate::registry::METHODS). The property suite (order conditions, measured
//! order, symplecticity, reversal, momentum) is driven by what the method declares about itself.

mod ahead;
pub mod boris;
pub mod embedded;
pub mod equal_steps;
pub mod events;
pub mod extension;
pub mod fixed;
pub mod initial_value;
pub mod looks;
pub mod methods;
pub mod multistep;
pub mod norm;
pub mod nystrom;
#[cfg(test)]
mod order_conditions;
pub mod passes;
pub mod run;
pub mod runge_kutta;
pub mod separated;
pub mod series;
pub mod splitting;
pub mod state;
pub mod step_control;
pub mod stepper;
pub mod system;
pub mod table;
pub mod taylor;
pub mod transformation;
pub mod transformed;
pub mod trial;

use crate::numerics::double_double::DoubleDouble;
use looks::Looks;
use system::{Form, Needs};

/// An integration method: what it declares about itself, and its table.
#[derive(Debug)]
pub struct Method {
    /// Its name in the Python interface.
    pub name: &'static str,
    /// One line on what it is for.
    pub summary: &'static str,
    /// Classical order.
    pub order: u32,
    /// Force evaluations per step.
    pub stages: u32,
    /// Whether the map is symplectic for a separable Hamiltonian.
    pub symplectic: bool,
    /// Whether a step of `-h` undoes a step of `h`.
    pub reversible: bool,
    /// Order of the states between nodes.
    pub dense_order: u32,
    /// Where it was published.
    pub reference: &'static str,
    /// Its coefficients.
    pub scheme: Scheme,
}

/// The kinds of table.
#[derive(Debug)]
pub enum Scheme {
    /// Alternating kicks and drifts.
    Splitting(Splitting),
    /// The same, with an order that holds for `q'' = a(t, q)` alone: where kicks do not change what they depend on and
    /// drifts are by velocities, `[B, [B, [B, A]]] = 0`, and conditions on such words are spared (Runge–Kutta–Nyström).
    NystromSplitting(Splitting),
    /// Kicks and drifts, with velocities turned exactly in the middle of every kick.
    Boris(Splitting),
    /// Explicit Runge–Kutta with a fixed step.
    RungeKutta(Tableau),
    /// Explicit Runge–Kutta with an error estimate and a continuous extension.
    Embedded(Embedded),
    /// Störmer's multistep method, with what starts it.
    Multistep(Multistep),
    /// Taylor series of the motion itself.
    Taylor(Taylor),
}

/// The orders of a method of Taylor series; the tolerance says which.
#[derive(Clone, Copy, Debug)]
pub struct Taylor {
    /// The lowest.
    pub lowest: usize,
    /// The highest.
    pub highest: usize,
}

/// `kick[0] drift[0] kick[1] drift[1] … drift[s-1] kick[s]`, coefficients in units of the step.
#[derive(Debug)]
pub struct Splitting {
    /// One more than `drifts`; the first or the last may be zero.
    pub kicks: &'static [DoubleDouble],
    /// Coefficients of the drifts.
    pub drifts: &'static [DoubleDouble],
}

/// The Butcher tableau of an explicit method.
#[derive(Debug)]
pub struct Tableau {
    /// Row `i` has `i` entries.
    pub a: &'static [&'static [DoubleDouble]],
    /// Weights.
    pub b: &'static [DoubleDouble],
    /// Nodes, the row sums of `a`.
    pub c: &'static [DoubleDouble],
}

/// An explicit method with error estimates and a continuous extension.
#[derive(Debug)]
pub struct Embedded {
    /// The method itself.
    pub tableau: Tableau,
    /// Weights of the error estimate `E = h Σ error[i] k[i]`.
    pub error: &'static [DoubleDouble],
    /// Weights of a second, cruder estimate `E3`: the error is then `E² / sqrt(E² + 0.01 E3²)`
    /// (Hairer, Nørsett & Wanner, *Solving ODE I*, II.10).
    pub second_error: Option<&'static [DoubleDouble]>,
    /// The step control raises the scaled error to `-1 / error_exponent`.
    pub error_exponent: u32,
    /// Rows of `a` of the stages that only the continuous extension uses. Stage `s` (the first after
    /// the method's own `s` stages) is the derivative at the end of the step and has no row here.
    pub dense_a: &'static [&'static [DoubleDouble]],
    /// Their nodes.
    pub dense_c: &'static [DoubleDouble],
    /// `dense[i]` holds the weight of stage `i` at `y(t + θh) = y + h Σ w_i(θ) k_i` in the nested basis
    /// `w = θ(f0 + (1-θ)(f1 + θ(f2 + (1-θ)(f3 + …))))`, which loses no digits at either end.
    pub dense: &'static [&'static [DoubleDouble]],
}

/// `q[n+1] - 2 q[n] + q[n-1] = h² (a[n] + Σ second_differences[j] ∇²a[n-j])`, with what it takes to start it and to
/// read it. For forces that depend on positions alone.
#[derive(Debug)]
pub struct Multistep {
    /// Weights of the second differences of the accelerations, from the latest on.
    pub second_differences: &'static [DoubleDouble],
    /// `v[n] = (q[n] - q[n-1])/h + h (velocity[0] a[n] + velocity[1] ∇a[n] + Σ velocity[2+j] ∇²a[n-j])`.
    pub velocity: &'static [DoubleDouble],
    /// The one-step method of the first steps, and of the steps to times between nodes.
    pub start: &'static Tableau,
    /// Steps in a period of an oscillator, below which its amplitude grows from step to step.
    pub fewest_steps: f64,
}

impl Embedded {
    /// Where its stages look: what has no weight, neither in a step nor in an estimate of its error, counts for nothing.
    pub fn looks(&self) -> Looks {
        let Tableau { b, c, .. } = &self.tableau;
        let weighs =
            |weights: &[DoubleDouble], k: usize| weights.get(k).is_some_and(|weight| weight.high() != 0.0);
        let counts = |k: usize| {
            weighs(b, k) || weighs(self.error, k) || self.second_error.is_some_and(|second| weighs(second, k))
        };
        let places = || c.iter().map(|c| c.high()).enumerate();
        let uncounted = places().filter(|&(k, _)| !counts(k)).map(|(_, place)| place);
        Looks::with_ends(places().map(|(_, place)| place)).but_uncounted(uncounted)
    }
}

impl Splitting {
    /// Where a step kicks: at its ends as well, unless it begins with a drift.
    pub fn looks(&self) -> Looks {
        let drifted = self.drifts.iter().scan(0.0, |place, drift| {
            *place += drift.high();
            Some(*place)
        });
        let (first, others) = self.kicks.split_first().unzip();
        let kicks = others.into_iter().flatten().zip(drifted).filter(|(kick, _)| kick.high() != 0.0);
        let places = kicks.map(|(_, place)| place);
        if first.is_some_and(|kick: &DoubleDouble| kick.high() != 0.0) {
            Looks::with_ends(places)
        } else {
            Looks::at(places)
        }
    }
}

/// Steps in a period below which a one-step method tells nothing of an oscillator: leapfrog is unstable below π.
pub const FEWEST_STEPS: f64 = 6.0;

impl Method {
    /// How many equal steps a period must have for the method to tell anything of it.
    pub fn fewest_steps(&self) -> f64 {
        match &self.scheme {
            Scheme::Multistep(table) => table.fewest_steps,
            _ => FEWEST_STEPS,
        }
    }
}

/// A coefficient, as the generated tables write it.
const fn dd(high: f64, low: f64) -> DoubleDouble {
    DoubleDouble::new(high, low)
}

/// An absent coefficient.
const ZERO: DoubleDouble = dd(0.0, 0.0);

/// A named table of coefficients, row by row.
pub type NamedTable = (&'static str, Vec<&'static [DoubleDouble]>);

impl Scheme {
    /// The tables that a step is made of, by the names that they have in this file.
    pub fn tables(&self) -> Vec<NamedTable> {
        let of = |Tableau { a, b, c }: &Tableau| vec![("a", a.to_vec()), ("b", vec![*b]), ("c", vec![*c])];
        match self {
            Self::Splitting(table) | Self::NystromSplitting(table) | Self::Boris(table) => {
                vec![("kicks", vec![table.kicks]), ("drifts", vec![table.drifts])]
            }
            Self::RungeKutta(table) => of(table),
            Self::Embedded(table) => {
                let mut tables = of(&table.tableau);
                tables.push(("error", vec![table.error]));
                tables.extend(table.second_error.map(|second| ("second_error", vec![second])));
                tables
            }
            Self::Multistep(table) => vec![
                ("second_differences", vec![table.second_differences]),
                ("velocity", vec![table.velocity]),
            ],
            Self::Taylor(_) => Vec::new(),
        }
    }
}

impl Method {
    /// Whether the method chooses its own steps.
    pub const fn adaptive(&self) -> bool {
        matches!(self.scheme, Scheme::Embedded(_) | Scheme::Taylor(_))
    }

    /// Whether it is a table of coefficients; a series has those of the motion, and the order that the tolerance asks for.
    pub const fn has_table(&self) -> bool {
        !matches!(self.scheme, Scheme::Taylor(_))
    }

    /// Where an equal step of it looks at forces.
    pub fn looks(&self) -> Looks {
        match &self.scheme {
            Scheme::Splitting(table) | Scheme::NystromSplitting(table) | Scheme::Boris(table) => {
                table.looks()
            }
            Scheme::RungeKutta(table) => Looks::with_ends(table.c.iter().map(|c| c.high())),
            Scheme::Multistep(_) | Scheme::Embedded(_) | Scheme::Taylor(_) => Looks::AT_ENDS,
        }
    }

    /// The most blocks, each of as many numbers as an evaluation gives, that its steps hold at a node besides the state
    /// ([`Stepper::memory`](stepper::Stepper::memory)).
    pub const fn held(&self) -> usize {
        match self.scheme {
            Scheme::RungeKutta(_) | Scheme::Embedded(_) | Scheme::Boris(_) | Scheme::Taylor(_) => 0,
            // The acceleration of the last kick.
            Scheme::Splitting(_) | Scheme::NystromSplitting(_) => 1,
            // Beside second differences: three blocks of accelerations, a compensated difference of coordinates, and
            // compensated coordinates of a kernel's own.
            Scheme::Multistep(Multistep { second_differences, .. }) => second_differences.len() + 7,
        }
    }

    /// Whether the method can take systems of this form that look at these things.
    pub const fn serves(&self, form: Form, needs: Needs) -> bool {
        match self.scheme {
            Scheme::RungeKutta(_) | Scheme::Embedded(_) => true,
            // Between two kicks, and at the nodes of a multistep method, there is no velocity of the same time.
            Scheme::Splitting(_) | Scheme::NystromSplitting(_) | Scheme::Multistep(_) => {
                matches!(form, Form::SecondOrder(_)) && !needs.velocities()
            }
            Scheme::Boris(_) => matches!(form, Form::SecondOrder(_)) && !needs.velocity,
            Scheme::Taylor(_) => matches!(form, Form::SecondOrder(_)),
        }
    }
}
