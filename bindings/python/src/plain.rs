//! Checks whether a value consists only of the types that the codecs for plain values document. The libraries encode
//! more, for example sets as tags of CBOR, which programs in other languages do not read.

use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};

/// Maximum depth of nesting; deeper values are checked in Python, which limits its recursion.
const DEPTH: usize = 64;

/// Returns true if a value is certainly plain; after false, the caller must look closer. With `text_keys`, keys must be
/// text, as in JSON.
#[pyfunction]
pub(crate) fn is_plain(value: &Bound<'_, PyAny>, text_keys: bool) -> PyResult<bool> {
    is_plain_within(value, text_keys, DEPTH)
}

fn is_plain_within(value: &Bound<'_, PyAny>, text_keys: bool, depth: usize) -> PyResult<bool> {
    if value.is_none() || value.is_instance_of::<PyString>() || value.is_instance_of::<PyFloat>() {
        return Ok(true);
    }
    if value.is_instance_of::<PyInt>() {
        return Ok(value.extract::<i64>().is_ok() || value.extract::<u64>().is_ok());
    }
    if value.is_instance_of::<PyBytes>() || value.is_instance_of::<PyByteArray>() {
        return Ok(true);
    }
    let Some(depth) = depth.checked_sub(1) else { return Ok(false) };
    if let Ok(list) = value.cast_exact::<PyList>() {
        return all(list.iter(), text_keys, depth);
    }
    if let Ok(tuple) = value.cast_exact::<PyTuple>() {
        return all(tuple.iter(), text_keys, depth);
    }
    if let Ok(dict) = value.cast::<PyDict>() {
        for (key, value) in dict.iter() {
            let is_key = key.is_instance_of::<PyString>() || !text_keys && is_plain_within(&key, text_keys, depth)?;
            if !is_key || !is_plain_within(&value, text_keys, depth)? {
                return Ok(false);
            }
        }
        return Ok(true);
    }
    let Ok(fields) = value.get_type().getattr("__dataclass_fields__") else { return Ok(false) };
    let Ok(fields) = fields.cast_into::<PyDict>() else { return Ok(false) };
    for name in fields.keys() {
        if !is_plain_within(&value.getattr(name.cast::<PyString>()?)?, text_keys, depth)? {
            return Ok(false);
        }
    }
    Ok(true)
}

fn all<'py>(mut values: impl Iterator<Item = Bound<'py, PyAny>>, text_keys: bool, depth: usize) -> PyResult<bool> {
    values.try_fold(true, |plain, value| Ok(plain && is_plain_within(&value, text_keys, depth)?))
}
