//! Machines: their keys are attributes.

use crate::errors::{raised, refused};
use crate::values::{from_python, option, to_python};
use lodray::machine::{Machine, MachineError};
use lodray::report::result::MachineFacts;
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// A machine that frames are simulated on: cores, caches, traversal units, memory.
///
/// `Machine("haydel2023")` is one that comes with the package (`lodray.machines()` names them), `Machine("own.toml")` a
/// description of your own, `Machine({...})` the same as a dictionary (`Machine.to_dict`). The keys of the description are
/// attributes: `machine.l1.bytes` is read and set, and `dir(machine.l1)` lists what there is. docs/simulator.md says what each is.
///
/// Raises LodrayError: there is none of that name, a key is missing or unknown, or a value cannot be.
#[pyclass(name = "Machine", frozen, module = "lodray")]
pub struct PyMachine(Mutex<MachineFacts>);

/// A part of a machine: a table of its description.
#[pyclass(name = "MachinePart", frozen, module = "lodray")]
pub struct PyMachinePart {
    machine: Py<PyMachine>,
    /// Its dotted name, with a dot behind it.
    path: String,
}

/// What is wrong with a machine, in one line.
fn in_one_line(error: MachineError) -> PyErr {
    match error {
        MachineError::Toml { file, source } => {
            let picture = source.to_string();
            refused(format!("{file}: {}: {}", picture.lines().next().unwrap_or_default(), source.message()))
        }
        other => raised(other),
    }
}

/// The machine of a name, of a file, or of a dictionary.
fn read(of: &Bound<'_, PyAny>) -> PyResult<MachineFacts> {
    if of.is_instance_of::<PyDict>() {
        let mut description: Machine = serde_json::from_value(from_python("machine", of)?).map_err(raised)?;
        // Changing nothing checks all of it.
        description.set_all(&[]).map_err(in_one_line)?;
        return Ok(MachineFacts { label: description.name.clone(), set: Vec::new(), description });
    }
    let path: PathBuf = of.extract().map_err(|_| refused("machine: neither a name, nor a path, nor a dictionary"))?;
    let name = path.to_string_lossy().into_owned();
    let is_file = path.components().count() > 1 || path.extension().is_some_and(|ending| ending == "toml");
    let description = if is_file { Machine::load(&path) } else { Machine::shipped(&name) }.map_err(in_one_line)?;
    let label = if is_file { path.file_stem().unwrap_or_default().to_string_lossy().into_owned() } else { name };
    Ok(MachineFacts { label, set: Vec::new(), description })
}

/// A machine, or what makes one.
pub fn machine(of: &Bound<'_, PyAny>) -> PyResult<MachineFacts> {
    match of.cast::<PyMachine>() {
        Ok(machine) => Ok(machine.get().facts()),
        Err(_) => read(of),
    }
}

/// One of them, or several in a list.
pub fn machines(of: &Bound<'_, PyAny>) -> PyResult<Vec<MachineFacts>> {
    use pyo3::types::{PyList, PyTuple};
    if of.is_instance_of::<PyList>() || of.is_instance_of::<PyTuple>() {
        return of.try_iter()?.map(|one| machine(&one?)).collect();
    }
    Ok(vec![machine(of)?])
}

impl PyMachine {
    /// What it is now.
    pub fn facts(&self) -> MachineFacts {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn change(&self, changes: &[(String, String)]) -> PyResult<()> {
        let mut facts = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let pairs: Vec<_> = changes.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
        facts.description.set_all(&pairs).map_err(in_one_line)?;
        facts.set.extend(changes.iter().map(|(key, value)| format!("{key}={value}")));
        Ok(())
    }

    fn value(&self) -> PyResult<Value> {
        serde_json::to_value(self.facts().description).map_err(raised)
    }
}

/// What a dotted path names, or a part of the machine if that is a table.
fn look<'py>(machine: &Bound<'py, PyMachine>, path: &str) -> PyResult<Bound<'py, PyAny>> {
    let py = machine.py();
    let all = machine.get().value()?;
    match path.split('.').try_fold(&all, |value, key| value.get(key)) {
        Some(Value::Object(_)) => {
            let part = PyMachinePart { machine: machine.clone().unbind(), path: format!("{path}.") };
            Ok(Bound::new(py, part)?.into_any())
        }
        Some(value) => to_python(py, value),
        None => Err(PyAttributeError::new_err(format!("a machine has no key '{path}'"))),
    }
}

/// The keys of the table that a dotted path names, and besides, what every object has.
fn keys(value: &Value, path: &str, methods: &[&str]) -> Vec<String> {
    let table = path.split('.').filter(|key| !key.is_empty()).try_fold(value, |value, key| value.get(key));
    let own = table.and_then(Value::as_object).into_iter().flat_map(|table| table.keys().cloned());
    own.chain(methods.iter().map(|&name| name.to_owned())).collect()
}

#[pymethods]
impl PyMachine {
    #[new]
    fn new(description: &Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self(Mutex::new(machine(description)?)))
    }

    /// What results call it, changes included.
    #[getter]
    fn title(&self) -> String {
        self.facts().title()
    }

    /// Changes the values of several keys at once, such as {"l1.bytes": 32768}: only together need they be possible.
    ///
    /// Raises LodrayError: no such key, or a value that cannot be. The machine stays as it was then.
    fn set(&self, changes: &Bound<'_, PyDict>) -> PyResult<()> {
        let changes = changes.iter().map(|(key, value)| Ok((key.extract()?, option(&value)?))).collect::<PyResult<Vec<_>>>()?;
        self.change(&changes)
    }

    /// The same machine once more, which can be changed by itself.
    fn copy(&self) -> Self {
        Self(Mutex::new(self.facts()))
    }

    /// All of its description.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.value()?)
    }

    fn __getattr__<'py>(slf: &Bound<'py, Self>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        look(slf, name)
    }

    fn __setattr__(&self, name: String, value: &Bound<'_, PyAny>) -> PyResult<()> {
        self.change(&[(name, option(value)?)])
    }

    fn __dir__(&self) -> PyResult<Vec<String>> {
        Ok(keys(&self.value()?, "", &["title", "set", "copy", "to_dict"]))
    }

    fn __repr__(&self) -> String {
        format!("Machine('{}')", self.facts().title())
    }
}

#[pymethods]
impl PyMachinePart {
    /// All of its keys and values.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let all = self.machine.get().value()?;
        let table = self.path.split('.').filter(|key| !key.is_empty()).try_fold(&all, |value, key| value.get(key));
        to_python(py, table.unwrap_or(&Value::Null))
    }

    fn __getattr__<'py>(&self, py: Python<'py>, name: &str) -> PyResult<Bound<'py, PyAny>> {
        look(self.machine.bind(py), &format!("{}{name}", self.path))
    }

    fn __setattr__(&self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        self.machine.get().change(&[(format!("{}{name}", self.path), option(value)?)])
    }

    fn __dir__(&self) -> PyResult<Vec<String>> {
        Ok(keys(&self.machine.get().value()?, &self.path, &["to_dict"]))
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        Ok(format!("MachinePart({})", self.to_dict(py)?))
    }
}

/// Names of the machines that come with the package.
#[pyfunction(name = "machines")]
pub fn machines_shipped() -> Vec<&'static str> {
    Machine::all_shipped()
}
