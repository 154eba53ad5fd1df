//! The rigid bodies of a scene, and what acts on them, as Python describes them.

use super::input::{Array, points};
use crate::arrays::copied;
use crate::errors::raised;
use core::ffi::c_double;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::sync::Arc;
use visviva_core::Error;
use visviva_core::forces::ForceTerm;
use visviva_core::rigid::motion::bodies::RigidBodies;
use visviva_core::rigid::motion::conserved::Scenery;
use visviva_core::rigid::motion::formula::Formula;
use visviva_core::rigid::motion::loads::{End, Load, OwnLoads, TorqueFunction};

/// The rigid bodies of each copy, the last of its bodies.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Described<'py> {
    moments: Array<'py>,
    axes: Array<'py>,
    center: Array<'py>,
    pivoted: Vec<bool>,
    orientation: Array<'py>,
    angular_velocity: Array<'py>,
    loads: Bound<'py, PyList>,
    own_loads: Option<(Vec<Bound<'py, PyList>>, Vec<usize>)>,
}

impl Described<'_> {
    /// Of so many copies.
    ///
    /// # Errors
    /// `InvalidInput` for arrays whose shapes do not agree, and for a load that is not known.
    pub(super) fn prepared(self, copies: usize) -> PyResult<RigidBodies> {
        let (moments, [_, count, _]) = copied("moments", &self.moments, [Some(copies), None, Some(3)])?;
        let three = [Some(copies), Some(count), Some(3)];
        let four = [Some(copies), Some(count), Some(4)];
        let quaternions = |values: Vec<f64>| values.as_chunks::<4>().0.to_vec();
        Ok(RigidBodies {
            count,
            moments: points(&moments),
            axes: quaternions(copied("axes", &self.axes, four)?.0),
            center: points(&copied("center", &self.center, three)?.0),
            pivoted: self.pivoted.repeat(copies),
            orientation: quaternions(copied("orientation", &self.orientation, four)?.0),
            angular_velocity: points(&copied("angular_velocity", &self.angular_velocity, three)?.0),
            loads: loads(&self.loads)?,
            own_loads: self
                .own_loads
                .map(|(sets, of_copy)| {
                    Ok::<_, PyErr>(OwnLoads {
                        sets: sets.iter().map(loads).collect::<PyResult<_>>()?,
                        of_copy,
                    })
                })
                .transpose()?,
        })
    }
}

/// Recorded orientations and angular velocities of the rigid bodies of a scene.
pub(super) struct Turning {
    bodies: RigidBodies,
    orientation: Vec<[f64; 4]>,
    angular_velocity: Vec<[f64; 3]>,
    constant: f64,
}

impl Turning {
    /// Of so many times, under these forces on points.
    ///
    /// # Errors
    /// As [`Described::prepared`].
    pub(super) fn prepared(
        (described, orientation, angular_velocity): (Described<'_>, Array<'_>, Array<'_>),
        times: usize,
        forces: &[Arc<dyn ForceTerm>],
    ) -> PyResult<Self> {
        let bodies = described.prepared(1)?;
        let shape = |width| [Some(times), Some(bodies.count), Some(width)];
        let orientation = copied("orientation", &orientation, shape(4))?.0;
        let angular_velocity = points(&copied("angular_velocity", &angular_velocity, shape(3))?.0);
        let constants = forces.iter().filter_map(|force| force.as_newtonian());
        let constant = constants.map(|(constant, _)| constant).sum();
        Ok(Self { bodies, orientation: orientation.as_chunks::<4>().0.to_vec(), angular_velocity, constant })
    }

    /// What they add to a column at a time.
    pub(super) fn share(&self, column: &str, time: usize, mass: &[f64], place: &[[f64; 3]]) -> [f64; 3] {
        let own = time * self.bodies.count..(time + 1) * self.bodies.count;
        Scenery {
            bodies: &self.bodies,
            copy: 0,
            mass,
            place,
            orientation: self.orientation.get(own.clone()).unwrap_or_default(),
            angular_velocity: self.angular_velocity.get(own).unwrap_or_default(),
            constant: self.constant,
        }
        .share(column)
    }
}

/// All loads of a copy.
fn loads(described_loads: &Bound<'_, PyList>) -> PyResult<Vec<Load>> {
    described_loads.iter().map(|load| described(load.cast::<PyDict>()?)).collect()
}

/// Refuses what the core makes no load of.
///
/// # Errors
/// By name.
#[pyfunction]
pub(crate) fn check_load(description: &Bound<'_, PyDict>) -> PyResult<()> {
    described(description).map(drop)
}

/// A load by its kind and values.
fn described(load: &Bound<'_, PyDict>) -> PyResult<Load> {
    let py = load.py();
    let missing = |name: &str| raised(py, Error::invalid("forces", format!("a load has no {name}")));
    let value = |name: &str| load.get_item(name)?.ok_or_else(|| missing(name));
    let number = |name: &str| value(name)?.extract::<f64>();
    let body = |name: &str| value(name)?.extract::<Option<usize>>();
    let point = |name: &str| value(name)?.extract::<Option<[f64; 3]>>();
    match value("kind")?.extract::<String>()?.as_str() {
        "applied_torque" => Ok(Load::Torque {
            body: body("body")?,
            torque: point("torque")?.unwrap_or_default(),
            in_body: value("frame")?.extract::<String>()? == "body",
        }),
        "rotational_drag" => Ok(Load::Drag { body: body("body")?, coefficient: number("coefficient")? }),
        "compiled_torque" => Ok(Load::Function {
            body: body("body")?,
            function: called(value("address")?.extract::<usize>()?),
        }),
        "expression_torque" => {
            let parameters = value("parameters")?.extract::<Vec<(String, f64)>>()?;
            let parameters: Vec<f64> = parameters.into_iter().map(|(_, value)| value).collect();
            let nodes = copied("function", &value("function")?.extract()?, [None])?.0;
            let units = [number("length")?, number("mass")?, number("time")?];
            let formula = Formula::read(&nodes, parameters.len(), value("axes")?.extract()?, units);
            Ok(Load::Formula {
                body: body("body")?,
                formula: Arc::new(formula.map_err(|error| raised(py, error))?),
                parameters,
                in_body: value("frame")?.extract::<String>()? == "body",
            })
        }
        "attached_spring" => {
            let own = End::Body(value("body")?.extract()?, point("point")?.unwrap_or_default());
            let other = match (body("to")?, body("particle")?, point("anchor")?) {
                (Some(to), ..) => End::Body(to, point("to_point")?.unwrap_or_default()),
                (_, Some(particle), _) => End::Particle(particle),
                (.., anchor) => End::Anchor(anchor.unwrap_or_default()),
            };
            Ok(Load::Spring {
                ends: [own, other],
                stiffness: number("stiffness")?,
                length: number("length")?,
                damping: number("damping")?,
            })
        }
        other => {
            Err(raised(py, Error::invalid("forces", format!("a load of the kind {other} is not known"))))
        }
    }
}

/// A compiled function at its address.
fn called(address: usize) -> TorqueFunction {
    type Plain = unsafe extern "C" fn(c_double, *const c_double, *const c_double, *mut c_double);
    Arc::new(move |t, orientation: &[f64; 4], spin: &[f64; 3]| {
        let mut torque = [0.0; 3];
        let address = core::ptr::with_exposed_provenance::<()>(address);
        // SAFETY: the caller says that a function of this signature is at the address, and keeps it there.
        let function = unsafe { core::mem::transmute::<*const (), Plain>(address) };
        // SAFETY: it reads four and three numbers, and writes three.
        unsafe { function(t, orientation.as_ptr(), spin.as_ptr(), torque.as_mut_ptr()) };
        torque
    })
}
