//! Rigid bodies: orientation, and the motions that are known at every time.

pub mod conventions;
pub mod flow;
pub mod free;
pub mod heavy_top;
pub mod mesh;
pub mod moments;
pub mod motion;
pub mod quaternion;
pub mod solids;
pub mod tensor;
pub mod velocity;
