//! The errors of the core: what was asked, what came, what to do.

use crate::words::number;
use core::fmt;

/// Why a computation did not give a result.
#[derive(Clone, Debug, PartialEq)]
pub enum Error {
    /// An argument was refused before anything ran.
    InvalidInput {
        /// The name of the argument.
        argument: String,
        /// What was expected, what came, and what to do.
        message: String,
    },
    /// An iteration or a step-size control gave up.
    Convergence {
        /// What gave up and why.
        message: String,
        /// The time it had reached.
        time: f64,
    },
    /// Two bodies came so close that the step fell to zero.
    CloseEncounter {
        /// The time of the encounter.
        time: f64,
        /// The two bodies, by index; equal when one body meets a fixed centre.
        bodies: (usize, usize),
        /// Their distance.
        distance: f64,
    },
    /// The caller asked to stop.
    Interrupted,
    /// A broken promise of the library itself.
    Internal(String),
}

impl Error {
    /// An argument was refused.
    pub fn invalid(argument: &str, message: impl Into<String>) -> Self {
        Self::InvalidInput { argument: argument.to_owned(), message: message.into() }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::InvalidInput { argument, message } => write!(formatter, "{argument}: {message}"),
            Self::Convergence { message, time } => write!(formatter, "{message} (at t = {})", number(*time)),
            Self::CloseEncounter { time, bodies: (i, j), distance } => write!(
                formatter,
                "the step size fell to zero at t = {}: bodies {i} and {j} are {} apart; \
                 soften the force, or end the run before it",
                number(*time),
                number(*distance)
            ),
            Self::Interrupted => write!(formatter, "interrupted"),
            Self::Internal(message) => write!(formatter, "internal error: {message}"),
        }
    }
}

impl std::error::Error for Error {}

/// The result of anything that can fail.
pub type Result<T> = core::result::Result<T, Error>;
