//! Deflections against published digits and closed forms.
use super::*;
