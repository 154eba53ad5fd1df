//! The loops over a state that integrators are made of, each written once ([`Pass`](crate::numerics::element::Pass)).

pub mod errors;
pub mod extension;
pub mod multistep;
pub mod rates;
pub mod series;
pub mod series_errors;
pub mod stages;
pub mod step_by_series;
pub mod transformed;
pub mod updates;
