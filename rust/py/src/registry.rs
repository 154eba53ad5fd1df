//! What the registry offers: methods, potentials and forces, as Python's tables and classes are made from them.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::compute;
use numpy::{PyArray1, PyArrayDyn, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use std::sync::Arc;
use visviva_core::Error;
use visviva_core::forces::ForceTerm;
use visviva_core::forces::remaining::{OfRemaining, Remaining};
use visviva_core::forces::term::Coupling;
use visviva_core::memory::reserved;
use visviva_core::numerics::double_double::DoubleDouble;
use visviva_core::ode::Scheme;
use visviva_core::potentials::parameters::{Declaration, Dimensions, Kind, Parameter, Sign, Value};
use visviva_core::potentials::prepared::prepared;
use visviva_core::potentials::{Potential, screening};
use visviva_core::registry;
use visviva_core::scene::plan::steps_bodies;
use visviva_core::words::unknown;

/// What every integration method declares about itself, or every one that steps rigid bodies.
#[pyfunction]
#[pyo3(signature = (rigid=false))]
pub(crate) fn methods(py: Python<'_>, rigid: bool) -> PyResult<Vec<Bound<'_, PyDict>>> {
    let row = |method: &'static visviva_core::ode::Method| {
        let dict = PyDict::new(py);
        dict.set_item("name", method.name)?;
        dict.set_item("summary", method.summary)?;
        dict.set_item("order", method.order)?;
        dict.set_item("stages", method.stages)?;
        dict.set_item("symplectic", method.symplectic)?;
        dict.set_item("reversible", method.reversible)?;
        dict.set_item("adaptive", method.adaptive())?;
        dict.set_item("time_transformation", method.transforms())?;
        dict.set_item("dense_order", method.dense_order)?;
        dict.set_item("reference", method.reference)?;
        let numbers = |row: &[DoubleDouble]| row.iter().map(|x| x.to_f64()).collect::<Vec<_>>();
        let coefficients = PyDict::new(py);
        for (name, rows) in method.scheme.tables() {
            coefficients.set_item(name, rows.into_iter().map(numbers).collect::<Vec<_>>())?;
        }
        dict.set_item("coefficients", coefficients)?;
        // What it asks of equations in generalized coordinates, by the name of what is found about them.
        let asks = match method.scheme {
            Scheme::Splitting(_) => Some("separable"),
            Scheme::NystromSplitting(_) => Some("nystrom"),
            Scheme::Boris(_) | Scheme::Multistep(_) => Some("second_order"),
            Scheme::RungeKutta(_) | Scheme::Embedded(_) | Scheme::Taylor(_) => None,
        };
        dict.set_item("asks", asks)?;
        Ok(dict)
    };
    let own = registry::BODY_METHODS.iter().map(|(method, _)| *method);
    let all = registry::METHODS.iter().copied().filter(|method| !rigid || steps_bodies(method));
    all.chain(own.filter(|_| rigid)).map(row).collect()
}

/// What every potential declares about itself.
#[pyfunction]
pub(crate) fn potentials(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    registry::POTENTIALS.iter().map(|declaration| row(py, declaration)).collect()
}

/// What every force declares about itself.
#[pyfunction]
pub(crate) fn forces(py: Python<'_>) -> PyResult<Vec<Bound<'_, PyDict>>> {
    registry::FORCES.iter().map(|declaration| row(py, declaration)).collect()
}

fn row<'py, T: ?Sized>(py: Python<'py>, declaration: &Declaration<T>) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    for (key, text) in [
        ("name", declaration.name),
        ("class_name", declaration.class_name),
        ("summary", declaration.summary),
        ("formula", declaration.formula),
        ("notes", declaration.notes),
        ("source", declaration.source),
        ("example", declaration.example),
        ("at_rest", declaration.at_rest),
        ("one_way", declaration.one_way),
    ] {
        dict.set_item(key, text)?;
    }
    let parameters = declaration.parameters.iter().map(|parameter| {
        let dict = PyDict::new(py);
        let (kind, sign) = match parameter.kind {
            Kind::Number(sign) => ("number", sign),
            Kind::Numbers(sign) => ("numbers", sign),
            Kind::Indices => ("indices", Sign::Any),
            Kind::Vector => ("vector", Sign::Any),
            Kind::AxialVector => ("axial_vector", Sign::Any),
            Kind::Direction => ("direction", Sign::Any),
            Kind::Point => ("point", Sign::Any),
            Kind::Potential => ("potential", Sign::Any),
            Kind::Choice(_) => ("choice", Sign::Any),
            Kind::Table(sign) => ("table", sign),
        };
        let sign = match sign {
            Sign::Any => "any",
            Sign::NotNegative => "not_negative",
            Sign::Positive => "positive",
        };
        dict.set_item("name", parameter.name)?;
        dict.set_item("description", parameter.description)?;
        dict.set_item("kind", kind)?;
        dict.set_item("sign", sign)?;
        dict.set_item("choices", if let Kind::Choice(words) = parameter.kind { words } else { &[] })?;
        dict.set_item("default", parameter.default)?;
        dict.set_item(
            "dimension",
            match parameter.dimensions {
                Dimensions::Fixed(dimension) => Some((dimension[0], dimension[1], dimension[2])),
                Dimensions::Of(_) => None,
            },
        )?;
        Ok(dict)
    });
    dict.set_item("parameters", parameters.collect::<PyResult<Vec<_>>>()?)?;
    Ok(dict)
}

/// The exponents of length, mass and time of each parameter of a potential or a force.
#[pyfunction]
pub(crate) fn dimensions<'py>(
    py: Python<'py>,
    description: &Bound<'py, PyDict>,
) -> PyResult<Vec<(f64, f64, f64)>> {
    let kind: String = get(description, "kind")?;
    let exponents = match (registry::force(&kind), registry::potential(&kind)) {
        (Some(force), _) => force.exponents(&values(force, description)?),
        (_, Some(potential)) => potential.exponents(&values(potential, description)?),
        _ => return Err(raised(py, Error::invalid("kind", format!("unknown: '{kind}'")))),
    };
    Ok(exponents.into_iter().map(|[length, mass, time]| (length, mass, time)).collect())
}

/// Whether a force acts between bodies, and not on each for itself.
#[pyfunction]
pub(crate) fn acts_between(description: &Bound<'_, PyDict>) -> PyResult<bool> {
    Ok(force(description)?.coupling() != Coupling::None)
}

/// What a force is of the bodies that remain when each is a part of a host, or by itself; nothing, if it acts no more.
#[pyfunction]
pub(crate) fn force_of_remaining<'py>(
    py: Python<'py>,
    description: &Bound<'py, PyDict>,
    hosts: PyReadonlyArrayDyn<'py, i64>,
) -> PyResult<Option<Bound<'py, PyDict>>> {
    let hosts = bodies_at("hosts", &hosts)?;
    let force = force(description)?;
    let values = match force.of_remaining(&Remaining::of(&hosts)) {
        OfRemaining::Same | OfRemaining::Unknown => return Ok(Some(description.clone())),
        OfRemaining::Nothing => return Ok(None),
        OfRemaining::Values(values) => values,
    };
    let changed = description.copy()?;
    for (parameter, value) in force.declaration().parameters.iter().zip(values) {
        match value {
            Value::Number(number) => changed.set_item(parameter.name, number)?,
            Value::Numbers(numbers) => changed.set_item(parameter.name, PyArray1::from_vec(py, numbers))?,
            Value::Vector(vector) => changed.set_item(parameter.name, PyArray1::from_slice(py, &vector))?,
            Value::Indices(indices) => {
                let indices = indices.into_iter().map(|index| index as i64).collect();
                changed.set_item(parameter.name, PyArray1::from_vec(py, indices))?;
            }
            // None of these is about bodies.
            Value::Potential(_) | Value::Word(_) | Value::Table(_) => {}
        }
    }
    Ok(Some(changed))
}

/// The force of a description.
///
/// # Errors
/// `InvalidInput` for an unknown kind or parameters that cannot be.
pub(crate) fn force(description: &Bound<'_, PyDict>) -> PyResult<Arc<dyn ForceTerm>> {
    let kind: String = get(description, "kind")?;
    let names = registry::FORCES.iter().map(|declaration| declaration.name);
    let declaration = registry::force(&kind).ok_or_else(|| unknown("forces", &kind, names));
    let py = description.py();
    let declaration = declaration.map_err(|error| raised(py, error))?;
    declaration.build(&values(declaration, description)?).map_err(|error| raised(py, error))
}

/// The potential of a description.
///
/// # Errors
/// As [`force`].
pub(crate) fn described_potential(description: &Bound<'_, PyDict>) -> PyResult<Arc<dyn Potential>> {
    let kind: String = get(description, "kind")?;
    let names = registry::POTENTIALS.iter().map(|declaration| declaration.name);
    let declaration = registry::potential(&kind).ok_or_else(|| unknown("potential", &kind, names));
    let py = description.py();
    let declaration = declaration.map_err(|error| raised(py, error))?;
    prepared(declaration, &values(declaration, description)?).map_err(|error| raised(py, error))
}

/// The parameters of a description, by their names.
fn values<T: ?Sized>(declaration: &Declaration<T>, description: &Bound<'_, PyDict>) -> PyResult<Vec<Value>> {
    declaration.parameters.iter().map(|parameter| value(parameter, description)).collect()
}

fn value(parameter: &Parameter, description: &Bound<'_, PyDict>) -> PyResult<Value> {
    let (name, py) = (parameter.name, description.py());
    Ok(match parameter.kind {
        Kind::Number(_) => Value::Number(get(description, name)?),
        Kind::Numbers(_) => Value::Numbers(copied(name, &get::<Column<'_>>(description, name)?, [None])?.0),
        Kind::Indices => Value::Indices(bodies_at(name, &get(description, name)?)?),
        Kind::Vector | Kind::AxialVector | Kind::Direction | Kind::Point => {
            let (values, _) = copied(name, &get::<Column<'_>>(description, name)?, [Some(3)])?;
            let vector = <[f64; 3]>::try_from(&values[..]);
            Value::Vector(vector.map_err(|_| raised(py, Error::invalid(name, "expected three numbers")))?)
        }
        Kind::Potential => {
            Value::Potential(described_potential(&get::<Bound<'_, PyDict>>(description, name)?)?)
        }
        Kind::Choice(_) => Value::Word(get(description, name)?),
        Kind::Table(_) => {
            Value::Table(copied(name, &get::<Column<'_>>(description, name)?, [None])?.0.into())
        }
    })
}

/// Indices of bodies.
fn bodies_at(name: &str, indices: &PyReadonlyArrayDyn<'_, i64>) -> PyResult<Vec<usize>> {
    let (copy, _) = copied(name, indices, [None])?;
    let all: Result<Vec<usize>, _> = copy.iter().map(|i| usize::try_from(*i)).collect();
    let negative = |_| raised(indices.py(), Error::invalid(name, "expected indices of bodies, from 0 on"));
    all.map_err(negative)
}

/// An entry of a description.
fn get<'py, T: for<'a> FromPyObject<'a, 'py, Error: Into<PyErr>>>(
    description: &Bound<'py, PyDict>,
    key: &str,
) -> PyResult<T> {
    let value = description.get_item(key)?.ok_or_else(|| {
        raised(description.py(), Error::invalid("forces", format!("a description lacks '{key}'")))
    })?;
    value.extract().map_err(Into::into)
}

type Column<'py> = PyReadonlyArrayDyn<'py, f64>;
type Values<'py> = Bound<'py, PyArrayDyn<f64>>;

/// Distances between two looks at whether somebody asks to stop.
const AT_A_TIME: usize = 1024;

/// The screening length between two nuclei, in Bohr radii.
#[pyfunction]
pub(crate) fn screening_length(py: Python<'_>, name: &str, first: f64, second: f64) -> PyResult<f64> {
    screening::screening_length(name, [first, second]).map_err(|error| raised(py, error))
}

/// Refuses what no potential can be made of; gives the distances between which it is known, if not everywhere, and
/// whether it jumps.
#[pyfunction]
pub(crate) fn check_potential(description: &Bound<'_, PyDict>) -> PyResult<(Option<(f64, f64)>, bool)> {
    let potential = described_potential(description)?;
    Ok((potential.domain(), potential.jumps()))
}

/// V(r), −dV/dr and d²V/dr² of a potential at each distance.
#[pyfunction]
pub(crate) fn potential<'py>(
    py: Python<'py>,
    description: &Bound<'py, PyDict>,
    r: Column<'py>,
) -> PyResult<(Values<'py>, Values<'py>, Values<'py>)> {
    let potential = described_potential(description)?;
    let (r, shape) = copied("r", &r, [None])?;
    let [value, force, curvature] = compute(py, 0, None, |ticker| {
        let mut all: [Vec<f64>; 3] =
            reserved("r", "three numbers at each of these distances", Some(r.len()))?;
        for some in r.chunks(AT_A_TIME) {
            ticker.tick()?;
            for (all, part) in all.iter_mut().zip(potential.evaluate(some)) {
                all.extend(part);
            }
        }
        Ok(all)
    })?
    .whole(py)?;
    Ok((moved(py, value, &shape)?, moved(py, force, &shape)?, moved(py, curvature, &shape)?))
}
