//! `solve_ivp`: functions of Python and compiled ones as right-hand sides, events, and the solution as a dictionary.
//!
//! A function of Python is called on the caller's thread, which keeps the GIL; a compiled one runs without it, and takes it
//! only for events of Python. An exception of any of them ends the run and is raised again, the same object.

use crate::arrays::{copied, moved};
use crate::errors::raised;
use crate::gate::{attached, compute, compute_attached, is_ctrl_c};
use core::ffi::c_void;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyReadonlyArrayDyn};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyTuple};
use std::sync::{Mutex, PoisonError};
use visviva_core::memory::check;
use visviva_core::ode::events::{Condition, Events, Zeros};
use visviva_core::ode::extension::View;
use visviva_core::ode::initial_value::{Request, Solution, solve};
use visviva_core::ode::run::Ending;
use visviva_core::registry::solver;
use visviva_core::{Error, Result};

type Array<'py> = PyReadonlyArrayDyn<'py, f64>;

/// The exception of a function of Python that ended a run.
#[derive(Default)]
pub(crate) struct Raised(Mutex<Option<PyErr>>);

impl Raised {
    /// The value, or the first exception kept and the run ended.
    pub(crate) fn kept<T>(&self, outcome: PyResult<T>) -> Result<T> {
        outcome.map_err(|exception| {
            let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            let _ = kept.get_or_insert(exception);
            Error::Interrupted
        })
    }
    /// What was kept.
    pub(crate) fn exception(self) -> Option<PyErr> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A function of Python of time, state and further arguments.
struct Callable {
    function: Py<PyAny>,
    further: Vec<Py<PyAny>>,
    /// Whether it takes states as columns.
    columns: bool,
}

impl Callable {
    fn call<'py>(&self, py: Python<'py>, t: f64, y: &[f64]) -> PyResult<Bound<'py, PyAny>> {
        // A new array each time: the function may keep it.
        let state = PyArray1::from_slice(py, y);
        let state = if self.columns { state.reshape([y.len(), 1])?.into_any() } else { state.into_any() };
        if self.further.is_empty() {
            return self.function.bind(py).call1((t, state));
        }
        let time = t.into_pyobject(py)?.into_any();
        let further = self.further.iter().map(|argument| argument.bind(py).clone());
        let arguments: Vec<Bound<'py, PyAny>> = [time, state].into_iter().chain(further).collect();
        self.function.bind(py).call1(PyTuple::new(py, arguments)?)
    }

    /// As a right-hand side.
    fn rate(&self, py: Python<'_>, t: f64, y: &[f64], rate: &mut [f64]) -> PyResult<()> {
        let value = self.call(py, t, y)?;
        if let Ok(array) = value.cast::<PyArray1<f64>>() {
            // SAFETY: the GIL is held, and nothing else runs until the numbers are copied.
            if let Ok(numbers) = unsafe { array.as_slice() }
                && numbers.len() == rate.len()
            {
                rate.copy_from_slice(numbers);
                return Ok(());
            }
        } else if let Ok(list) = value.cast::<PyList>()
            && list.len() == rate.len()
        {
            if list.iter().zip(&mut *rate).all(|(item, rate)| item.extract().map(|x| *rate = x).is_ok()) {
                return Ok(());
            }
        } else if let Ok(tuple) = value.cast::<PyTuple>()
            && tuple.len() == rate.len()
            && tuple.iter().zip(&mut *rate).all(|(item, rate)| item.extract().map(|x| *rate = x).is_ok())
        {
            return Ok(());
        }
        converted(&value, rate)
    }
}

/// The numbers of anything that NumPy makes an array of.
fn converted(value: &Bound<'_, PyAny>, rate: &mut [f64]) -> PyResult<()> {
    let py = value.py();
    let refused = |got: String| {
        raised(py, Error::invalid("fun", format!("expected {} real numbers as in y0, got {got}", rate.len())))
    };
    let array = py.import("numpy")?.call_method1("asarray", (value,))?;
    let kind: String = array.getattr("dtype")?.getattr("kind")?.extract()?;
    let size: usize = array.getattr("size")?.extract()?;
    match kind.as_str() {
        "f" | "i" | "u" | "b" if size == rate.len() => {}
        "f" | "i" | "u" | "b" => return Err(refused(format!("{size}"))),
        "c" => return Err(refused("complex ones".to_owned())),
        // Objects may be numbers, as those of SymPy; NumPy takes nothing for one, too.
        "O" if size == rate.len() && !array.call_method0("ravel")?.try_iter()?.any(is_nothing) => {}
        _ => return Err(refused(value.get_type().name()?.to_string())),
    }
    let numbers = array.call_method1("astype", ("float64",));
    let numbers = numbers.or_else(|_| Err(refused(value.get_type().name()?.to_string())))?;
    let flat = numbers.call_method0("ravel")?;
    let flat = flat.cast::<PyArray1<f64>>()?.readonly();
    rate.copy_from_slice(flat.as_slice()?);
    Ok(())
}

/// Whether an item is None.
fn is_nothing(item: PyResult<Bound<'_, PyAny>>) -> bool {
    item.is_ok_and(|item| item.is_none())
}

/// The number that an event gives, be it in an array of one.
fn single(value: &Bound<'_, PyAny>) -> PyResult<f64> {
    let number = value.extract().or_else(|_| value.call_method0("item")?.extract());
    number.or_else(|_: PyErr| {
        let got = value.get_type().name()?;
        Err(raised(
            value.py(),
            Error::invalid("events", format!("expected one real number from an event, got {got}")),
        ))
    })
}

struct PythonEvents<'a> {
    functions: Vec<Callable>,
    raised: &'a Raised,
}

impl Events for PythonEvents<'_> {
    fn value(&mut self, which: usize, t: f64, y: &[f64]) -> Result<f64> {
        let Some(function) = self.functions.get(which) else {
            return Err(Error::Internal(format!("no event {which}")));
        };
        self.raised.kept(attached(|py| single(&function.call(py, t, y)?)))
    }
}

/// A compiled function `void f(double t, const double *y, double *rate)`, or with a pointer to data besides.
#[derive(Clone, Copy)]
struct Compiled {
    address: usize,
    data: Option<usize>,
}

impl Compiled {
    /// # Safety
    /// There must be such a function at the address, which writes as many rates as `y` has numbers.
    unsafe fn call(self, t: f64, y: &[f64], rate: &mut [f64]) {
        type Plain = unsafe extern "C" fn(f64, *const f64, *mut f64);
        type WithData = unsafe extern "C" fn(f64, *const f64, *mut f64, *mut c_void);
        let address = self.address as *const ();
        match self.data {
            None => {
                // SAFETY: the caller says that the function is there.
                let function = unsafe { core::mem::transmute::<*const (), Plain>(address) };
                // SAFETY: as above; both slices have the length that it expects.
                unsafe { function(t, y.as_ptr(), rate.as_mut_ptr()) }
            }
            Some(data) => {
                // SAFETY: the caller says that the function is there.
                let function = unsafe { core::mem::transmute::<*const (), WithData>(address) };
                // SAFETY: as above.
                unsafe { function(t, y.as_ptr(), rate.as_mut_ptr(), data as *mut c_void) }
            }
        }
    }
}

/// What is asked, as `visviva.solve_ivp` prepares it.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked<'py> {
    method: String,
    span: (f64, f64),
    y0: Array<'py>,
    rtol: Option<Vec<f64>>,
    atol: Option<Vec<f64>>,
    first_step: Option<f64>,
    max_step: Option<f64>,
    dt: Option<f64>,
    t_eval: Option<Array<'py>>,
    dense_output: bool,
    /// Functions, directions, and the numbers of the zeros that end the run.
    events: Vec<(Py<PyAny>, f64, Option<u64>)>,
    args: Vec<Py<PyAny>>,
    vectorized: bool,
    /// The address of a compiled function, and of its data.
    compiled: Option<(usize, Option<usize>)>,
}

impl Asked<'_> {
    fn request(&self, py: Python<'_>) -> PyResult<Request> {
        let outputs = self.t_eval.as_ref().map(|t| PyResult::Ok(copied("t_eval", t, [None])?.0));
        let y0 = copied("y0", &self.y0, [None])?.0;
        if let Some(times) = &outputs {
            let times = times.as_ref().map_or(0, Vec::len);
            let bytes = times.checked_mul(y0.len()).and_then(|n| n.checked_mul(size_of::<f64>()));
            let what = format!("states of {} numbers at {times} times", y0.len());
            check("t_eval", &what, bytes, "ask for fewer times").map_err(|error| raised(py, error))?;
        }
        Ok(Request {
            method: solver(&self.method).map_err(|error| raised(py, error))?,
            span: self.span,
            y0,
            rtol: self.rtol.clone(),
            atol: self.atol.clone(),
            first_step: self.first_step,
            max_step: self.max_step,
            dt: self.dt,
            outputs: outputs.transpose()?,
            dense: self.dense_output,
            conditions: self
                .events
                .iter()
                .map(|&(_, direction, last)| Condition { direction, last })
                .collect(),
        })
    }
}

/// Solves an initial value problem.
#[pyfunction]
pub(crate) fn solve_ivp<'py>(
    py: Python<'py>,
    fun: Py<PyAny>,
    asked: Asked<'py>,
) -> PyResult<Bound<'py, PyDict>> {
    let request = asked.request(py)?;
    let numbers = request.y0.len();
    let further = |own: bool| -> Vec<Py<PyAny>> {
        if own { asked.args.iter().map(|argument| argument.clone_ref(py)).collect() } else { vec![] }
    };
    let exception = Raised::default();
    let functions = asked.events.iter().map(|(function, ..)| Callable {
        function: function.clone_ref(py),
        further: further(asked.compiled.is_none()),
        columns: false,
    });
    let mut events = PythonEvents { functions: functions.collect(), raised: &exception };
    let watched = !events.functions.is_empty();
    let events = watched.then_some(&mut events as &mut (dyn Events + Send));
    let outcome = match asked.compiled {
        Some((address, data)) => {
            let function = Compiled { address, data };
            // SAFETY: whoever passes a compiled function says that it is one of this signature.
            let mut rate = |t: f64, y: &[f64], rate: &mut [f64]| {
                unsafe { function.call(t, y, rate) };
                Ok(())
            };
            compute(py, 0, None, |ticker| {
                solve(&request, &mut rate, events.map(|events| events as &mut dyn Events), ticker)
            })?
        }
        None => {
            let function = Callable { function: fun, further: further(true), columns: asked.vectorized };
            let mut rate = |t: f64, y: &[f64], rate: &mut [f64]| {
                exception.kept(attached(|py| function.rate(py, t, y, rate)))
            };
            compute_attached(py, |ticker| {
                solve(&request, &mut rate, events.map(|events| events as &mut dyn Events), ticker)
            })?
        }
    };
    let (solution, _) = outcome.partial(py)?;
    let cause = match exception.exception() {
        // Ctrl-C that came while a function of Python ran: what there is, is kept.
        Some(exception) if is_ctrl_c(py, &exception) => Some(exception),
        Some(exception) => return Err(exception),
        None => None,
    };
    dictionary(py, solution, numbers, cause)
}

fn dictionary<'py>(
    py: Python<'py>,
    solution: Solution,
    numbers: usize,
    cause: Option<PyErr>,
) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let times = solution.t.len();
    dict.set_item("t", moved(py, solution.t, &[times])?)?;
    dict.set_item("y", moved(py, solution.y, &[times, numbers])?)?;
    let parts = solution.extension.map(|extension| {
        let steps = extension.lengths.len();
        let terms = extension.terms.len().checked_div(extension.starts.len()).unwrap_or(0);
        let parts = [
            moved(py, extension.nodes, &[steps + 1])?,
            moved(py, extension.lengths, &[steps])?,
            moved(py, extension.starts, &[steps, numbers])?,
            moved(py, extension.terms, &[steps, terms, numbers])?,
        ];
        PyTuple::new(py, parts)
    });
    dict.set_item("extension", parts.transpose()?)?;
    let zeros = solution.zeros.into_iter().map(|Zeros { t, y }| {
        let times = t.len();
        Ok((moved(py, t, &[times])?, moved(py, y, &[times, numbers])?))
    });
    dict.set_item("zeros", zeros.collect::<PyResult<Vec<_>>>()?)?;
    dict.set_item("nfev", solution.evaluations)?;
    let (status, message) = match solution.ending {
        Ending::Finished => (0, "The solver successfully reached the end of the integration interval."),
        Ending::Stopped => (1, "A termination event occurred."),
        Ending::StepTooSmall => (-1, "Required step size is less than spacing between numbers."),
        Ending::NotFinite => (-1, "A number of the state is infinite or not a number."),
        Ending::TooManySteps => (-1, "Too many steps were taken."),
        Ending::Interrupted => (-1, "The run was interrupted."),
    };
    dict.set_item("status", status)?;
    dict.set_item("message", message)?;
    dict.set_item("interrupted", solution.ending == Ending::Interrupted)?;
    dict.set_item("cause", cause.map(|cause| cause.into_value(py)))?;
    Ok(dict)
}

/// The states at times between the nodes of a solution, one after another.
#[pyfunction]
pub(crate) fn interpolate<'py>(
    py: Python<'py>,
    extension: (Array<'py>, Array<'py>, Array<'py>, Array<'py>),
    t: Array<'py>,
) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let (nodes, lengths, starts, terms) = &extension;
    let numbers = starts.as_array().shape().last().copied().unwrap_or(0);
    let view = View {
        nodes: nodes.as_slice()?,
        lengths: lengths.as_slice()?,
        starts: starts.as_slice()?,
        terms: terms.as_slice()?,
    };
    let (times, [count]) = copied("t", &t, [None])?;
    let states = compute(py, 0, None, |_| view.at(&times))?.whole(py)?;
    moved(py, states, &[count, numbers])
}
