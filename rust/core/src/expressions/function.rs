//! The functions of one argument that expressions know: names, values, symmetry.

use crate::numerics::{angles, elementary};

/// A function of one real argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[repr(u8)]
pub enum Function {
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Tangent.
    Tan,
    /// Exponential.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Square root.
    Sqrt,
    /// Hyperbolic sine.
    Sinh,
    /// Hyperbolic cosine.
    Cosh,
    /// Hyperbolic tangent.
    Tanh,
    /// Inverse sine.
    Asin,
    /// Inverse cosine.
    Acos,
    /// Inverse tangent.
    Atan,
    /// Inverse hyperbolic sine.
    Asinh,
    /// Inverse hyperbolic cosine.
    Acosh,
    /// Inverse hyperbolic tangent.
    Atanh,
    /// The square of the hyperbolic secant, the derivative of tanh: 1 − tanh² keeps no digit of it where tanh is near 1.
    SechSquared,
}

/// What a change of the argument's sign does to a function.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parity {
    /// Nothing.
    Even,
    /// It changes the sign.
    Odd,
    /// Something else.
    Neither,
}

impl Function {
    /// All of them, in the order of their numbers.
    pub const ALL: [Self; 16] = [
        Self::Sin,
        Self::Cos,
        Self::Tan,
        Self::Exp,
        Self::Ln,
        Self::Sqrt,
        Self::Sinh,
        Self::Cosh,
        Self::Tanh,
        Self::Asin,
        Self::Acos,
        Self::Atan,
        Self::Asinh,
        Self::Acosh,
        Self::Atanh,
        Self::SechSquared,
    ];

    /// Its name, as the Python side says it.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Sin => "sin",
            Self::Cos => "cos",
            Self::Tan => "tan",
            Self::Exp => "exp",
            Self::Ln => "log",
            Self::Sqrt => "sqrt",
            Self::Sinh => "sinh",
            Self::Cosh => "cosh",
            Self::Tanh => "tanh",
            Self::Asin => "asin",
            Self::Acos => "acos",
            Self::Atan => "atan",
            Self::Asinh => "asinh",
            Self::Acosh => "acosh",
            Self::Atanh => "atanh",
            Self::SechSquared => "sech_squared",
        }
    }

    /// The function of that name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|function| function.name() == name)
    }

    /// Its symmetry.
    pub const fn parity(self) -> Parity {
        match self {
            Self::Cos | Self::Cosh | Self::SechSquared => Parity::Even,
            Self::Sin
            | Self::Tan
            | Self::Sinh
            | Self::Tanh
            | Self::Asin
            | Self::Atan
            | Self::Asinh
            | Self::Atanh => Parity::Odd,
            Self::Exp | Self::Ln | Self::Sqrt | Self::Acos | Self::Acosh => Parity::Neither,
        }
    }

    /// Its value at a constant, where that is exact or as good as a program's; a program finds the others.
    pub fn of_constant(self, x: f64) -> Option<f64> {
        match self {
            Self::Sin => Some(angles::sin(x)),
            Self::Cos => Some(angles::cos(x)),
            Self::Atan => Some(angles::atan(x)),
            Self::Exp => Some(elementary::Exponential::exp(x)),
            Self::Ln if x > 0.0 => Some(elementary::ln(x)),
            Self::Sqrt if x >= 0.0 => Some(x.sqrt()),
            _ => None,
        }
    }
}
