//! The only place that knows Python: no mathematics here, and nothing but plain data handed down.
//!
//! Arrays come in through [`arrays`], every computation goes through [`gate`], errors leave through
//! [`errors`]. One file per room of the core holds its functions; one `use` line below exports them.

// Here lengths come from users: what may not be there is asked for.
#![deny(clippy::indexing_slicing)]

mod arrays;
mod central;
mod diagnostic;
mod drag;
mod errors;
mod fitted;
mod gate;
mod generalized;
mod heavy_top;
mod info;
mod mass;
mod orbits;
mod registry;
mod rigid;
mod scattering;
mod scene;
mod solve_ivp;
mod words;

use pyo3::prelude::*;

/// The compiled core of visviva.
#[pymodule]
mod _core {
    use super::{PyModule, PyResult, errors};
    use pyo3::prelude::*;

    #[pymodule_export]
    use crate::central::orbit::{central_inverse_cube, central_places, central_state};
    #[pymodule_export]
    use crate::central::{
        central_circles, central_circular_radii, central_effective, central_motion, central_passage,
        central_ranges,
    };
    #[pymodule_export]
    use crate::diagnostic::{_busy, _echo};
    #[pymodule_export]
    use crate::drag::{drag_crossover_speed, drag_quadratic, drag_reynolds_number, drag_stokes, drag_throw};
    #[pymodule_export]
    use crate::fitted::{fitted, tabulated_drag};
    #[pymodule_export]
    use crate::generalized::{GeneralizedModel, eigenmodes};
    #[pymodule_export]
    use crate::heavy_top::{
        top_least_spin, top_motion, top_nutation, top_sleeping_threshold, top_steady_precession,
    };
    #[pymodule_export]
    use crate::info::info;
    #[pymodule_export]
    use crate::mass::{
        bodies_together, mesh_enclosed, particles_tensor, principal_axes, solid_tensor, tensor_about,
        tensor_rotated,
    };
    #[pymodule_export]
    use crate::orbits::{
        conic_from_constants, conic_from_state, orbit_anomaly, orbit_elements, orbit_free_fall_time,
        orbit_period, orbit_propagate, orbit_semi_major_axis, orbit_state, orbit_state_again,
    };
    #[pymodule_export]
    use crate::registry::{
        acts_between, check_potential, dimensions, force_of_remaining, forces, methods, potential,
        potentials, screening_length,
    };
    #[pymodule_export]
    use crate::rigid::{
        free_rotation, polhode, rigid_screw, rigid_velocity, rotated, rotation_euler, rotation_form,
        rotation_product, rotation_rates,
    };
    #[pymodule_export]
    use crate::scattering::closed_forms::{rutherford_half_distance, scattering_function, solid_angles};
    #[pymodule_export]
    use crate::scattering::collisions::{
        collided, contact_time, line_of_centers, reduced_mass, relative_split,
    };
    #[pymodule_export]
    use crate::scattering::cross_sections::{
        beyond_angle, collision_integrals, differential_cross_section, scattering_branches,
        scattering_orbits, scattering_range, scattering_structure, transport_cross_sections,
    };
    #[pymodule_export]
    use crate::scattering::deflection::deflections;
    #[pymodule_export]
    use crate::scattering::foil::{check_foil, foil_history, foil_run, foil_stopping};
    #[pymodule_export]
    use crate::scattering::kinematics::{kinematics, moderation, special_energy};
    #[pymodule_export]
    use crate::scattering::monte_carlo::{
        monte_carlo, monte_carlo_expected, scattering_events, strata_edges, strata_weights,
    };
    #[pymodule_export]
    use crate::scene::rigid::check_load;
    #[pymodule_export]
    use crate::scene::{
        Planned, acceleration, columns, conserved, conserves, differences, neighbors, plan, run,
    };
    #[pymodule_export]
    use crate::solve_ivp::{interpolate, solve_ivp};
    #[pymodule_export]
    use crate::words::nearest;

    /// A wrong `VISVIVA_SIMD` is refused here, before anything runs on another tier than was asked for.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        let _tier =
            visviva_core::numerics::simd::resolve().map_err(|error| errors::raised(module.py(), error))?;
        Ok(())
    }
}
