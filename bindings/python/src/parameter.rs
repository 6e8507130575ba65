//! The values of parameters as Python objects.

use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use scl::plan::ParameterValue;
use std::time::Duration;

/// Returns a value as `bool`, `int`, `float`, `str`, `timedelta`, or a list of them.
///
/// A `timedelta` has no nanoseconds. Durations are rounded up, so that none becomes 0.
pub(crate) fn object(py: Python<'_>, value: &ParameterValue) -> PyResult<Py<PyAny>> {
    match value {
        ParameterValue::Bool(value) => value.into_py_any(py),
        ParameterValue::Integer(value) => value.into_py_any(py),
        ParameterValue::Float(value) => value.into_py_any(py),
        ParameterValue::Text(value) => value.into_py_any(py),
        ParameterValue::Duration(value) => micros(*value).into_py_any(py),
        ParameterValue::List(values) => {
            values.iter().map(|value| object(py, value)).collect::<PyResult<Vec<_>>>()?.into_py_any(py)
        }
    }
}

/// A duration in whole microseconds.
fn micros(duration: Duration) -> Duration {
    let nanos = duration.subsec_nanos();
    let rounded = Duration::from_micros(nanos.div_ceil(1000).into());
    Duration::from_secs(duration.as_secs()).saturating_add(rounded)
}
