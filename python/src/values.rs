//! Documents as the program writes them, as dictionaries and lists, and back.

use crate::errors::{raised, refused};
use lodray::rays::{MAX_PIXELS, MAX_SIDE};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyOverflowError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyString, PyTuple};
use serde::Serialize;
use serde_json::{Map, Number, Value};
use std::fmt::Display;
use std::ops::RangeInclusive;

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

/// A whole number of any size, as arguments are taken whose range [`within`] checks, where their name is known. Beyond 128 bits it is the last number of 128.
pub fn whole(of: &Bound<'_, PyAny>) -> PyResult<i128> {
    match of.extract::<i128>() {
        Err(error) if error.is_instance_of::<PyOverflowError>(of.py()) => Ok(if of.lt(0)? { i128::MIN } else { i128::MAX }),
        number => number,
    }
}

/// The same, or nothing.
pub fn whole_or_none(of: &Bound<'_, PyAny>) -> PyResult<Option<i128>> {
    if of.is_none() { Ok(None) } else { whole(of).map(Some) }
}

/// A whole number within a range; `of` names it in errors.
pub fn within<T: TryFrom<i128> + PartialOrd + Display>(of: &str, number: i128, range: RangeInclusive<T>) -> PyResult<T> {
    let fits = T::try_from(number).ok().filter(|number| range.contains(number));
    fits.ok_or_else(|| refused(format!("{of}: {number} is not from {} to {}", range.start(), range.end())))
}

/// Columns and rows of pixels, of a tuple, a list or an array: every argument that is one is called `size`.
#[derive(Clone, Copy)]
pub struct Size(pub [u32; 2]);

impl<'py> FromPyObject<'_, 'py> for Size {
    type Error = PyErr;

    fn extract(of: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let sides: Vec<Bound<'py, PyAny>> = of.extract()?;
        let sides = sides.iter().map(whole).collect::<PyResult<Vec<_>>>()?;
        let side = |number: i128| u32::try_from(number).ok().filter(|side| (1..=MAX_SIDE).contains(side));
        let both = match *sides {
            [width, height] => side(width).zip(side(height)),
            _ => None,
        };
        let both = both.filter(|&(width, height)| u64::from(width) * u64::from(height) <= MAX_PIXELS);
        let both = both.ok_or_else(|| {
            refused(format!("size: {sides:?} is no width and height in pixels, each from 1 to {MAX_SIDE}, and {MAX_PIXELS} pixels at most"))
        });
        both.map(|(width, height)| Self([width, height]))
    }
}

/// Three numbers; `of` names them in errors.
pub fn triple(of: &str, numbers: Option<Vec<f64>>) -> PyResult<Option<[f64; 3]>> {
    let three = |numbers: Vec<f64>| numbers.try_into().map_err(|numbers| refused(format!("{of}: {numbers:?} is not (x, y, z)")));
    numbers.map(three).transpose()
}
