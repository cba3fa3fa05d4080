//! Documents as the program writes them, as dictionaries and lists, and back.

use crate::errors::{raised, refused};
use pyo3::IntoPyObjectExt;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde::Serialize;
use serde_json::{Map, Number, Value};

/// What the program would write as JSON, as Python has it.
pub fn document<'py>(py: Python<'py>, of: &impl Serialize) -> PyResult<Bound<'py, PyAny>> {
    to_python(py, &serde_json::to_value(of).map_err(raised)?)
}

/// A value as Python has it.
pub fn to_python<'py>(py: Python<'py>, value: &Value) -> PyResult<Bound<'py, PyAny>> {
    match value {
        Value::Null => Ok(py.None().into_bound(py)),
        Value::Bool(is) => is.into_bound_py_any(py),
        Value::Number(number) => match (number.as_u64(), number.as_i64()) {
            (Some(whole), _) => whole.into_bound_py_any(py),
            (_, Some(whole)) => whole.into_bound_py_any(py),
            _ => number.as_f64().into_bound_py_any(py),
        },
        Value::String(text) => text.into_bound_py_any(py),
        Value::Array(all) => {
            let list = PyList::empty(py);
            all.iter().try_for_each(|value| list.append(to_python(py, value)?))?;
            Ok(list.into_any())
        }
        Value::Object(all) => {
            let dict = PyDict::new(py);
            all.iter().try_for_each(|(key, value)| dict.set_item(key, to_python(py, value)?))?;
            Ok(dict.into_any())
        }
    }
}

/// A value of Python's; `of` names it in errors. What is `None` in a dictionary is not there.
pub fn from_python(of: &str, value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if value.is_none() {
        return Ok(Value::Null);
    }
    if value.is_instance_of::<PyBool>() {
        return Ok(Value::Bool(value.extract()?));
    }
    if value.is_instance_of::<PyString>() {
        return Ok(Value::String(value.extract()?));
    }
    if value.is_instance_of::<PyInt>() {
        let whole = value.extract::<u64>().map(Number::from).or_else(|_| value.extract::<i64>().map(Number::from));
        return whole.map(Value::Number).map_err(|_| refused(format!("{of}: {value} has more than 64 bits")));
    }
    if value.is_instance_of::<PyFloat>() {
        let number: f64 = value.extract()?;
        return Number::from_f64(number).map(Value::Number).ok_or_else(|| refused(format!("{of}: {number} is no finite number")));
    }
    if let Ok(dict) = value.cast::<PyDict>() {
        let mut all = Map::new();
        for (key, value) in dict {
            let key: String = key.extract().map_err(|_| refused(format!("{of}: the key {key} is no text")))?;
            if !value.is_none() {
                let value = from_python(&format!("{of}.{key}"), &value)?;
                all.insert(key, value);
            }
        }
        return Ok(Value::Object(all));
    }
    if value.is_instance_of::<PyList>() || value.is_instance_of::<PyTuple>() {
        let all = value.try_iter()?.enumerate().map(|(k, value)| from_python(&format!("{of}[{k}]"), &value?));
        return Ok(Value::Array(all.collect::<PyResult<_>>()?));
    }
    // Scalars of NumPy's are neither.
    match value.call_method0("item") {
        Ok(item) if !item.is(value) => from_python(of, &item),
        _ => Err(refused(format!("{of}: a {} is none of text, number, list and dictionary", value.get_type().name()?))),
    }
}

/// One of the values that a type has names for, by its name; `of` names it in errors.
pub fn named<T: serde::de::DeserializeOwned>(of: &str, name: &str) -> PyResult<T> {
    serde_json::from_value(Value::String(name.to_owned())).map_err(|error| refused(format!("{of}: {error}")))
}

/// What an option of the program would be given for a value: names and values of knobs and keys are the program's.
pub fn option(value: &Bound<'_, PyAny>) -> PyResult<String> {
    if value.is_instance_of::<PyBool>() {
        return Ok(value.extract::<bool>()?.to_string());
    }
    Ok(value.str()?.to_string())
}
