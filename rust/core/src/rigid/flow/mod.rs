//! How a rigid body goes on from any state, one step at a time.

pub mod moser_veselov;
