//! Deflections against published digits and closed forms.
