//! Rigid bodies: orientation, and the motions that are known at every time.

pub mod conventions;
pub mod free;
pub mod moments;
pub mod quaternion;
