//! Machines: their keys are attributes.

use crate::errors::{raised, refused};
use crate::values::{from_python, option, to_python};
use lodray::machine::{Machine, MachineError};
use lodray::report::result::MachineFacts;
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::path::{PathBuf, absolute};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// A machine that frames are simulated on: cores, caches, traversal units, memory.
///
/// `Machine("haydel2023")` is one that comes with the package (`lodray.machines()` names them), `Machine("own.toml")` a
/// description of your own, `Machine({...})` the same as a dictionary (`Machine.to_dict`). The keys of the description are
/// attributes: `machine.l1.bytes` is read and set, and `dir(machine.l1)` lists what there is. docs/simulator.md says what each is.
/// Machines with the same title and description are equal. One that is pickled keeps its changes; that of a file needs the file to be read again.
///
/// Raises LodrayError: there is none of that name, a key is missing or unknown, or a value cannot be; LodrayFileError: a file that cannot be read.
#[pyclass(name = "Machine", frozen, module = "lodray")]
pub struct PyMachine(Mutex<Changed>);

/// A machine, and what it was before anything of it was changed.
#[derive(Clone, Serialize, Deserialize)]
struct Changed {
    facts: MachineFacts,
    /// The description then.
    before: Value,
    /// The file that it was in, beside which others lie that it names.
    file: Option<PathBuf>,
}

impl Changed {
    fn new(label: String, description: Machine, file: Option<PathBuf>) -> PyResult<Self> {
        let before = serde_json::to_value(&description).map_err(raised)?;
        Ok(Self { facts: MachineFacts { label, set: Vec::new(), description }, before, file })
    }

    /// The machine of a name, of a file, of a dictionary, or of another.
    fn of(of: &Bound<'_, PyAny>) -> PyResult<Self> {
        match of.cast::<PyMachine>() {
            Ok(machine) => Ok(machine.get().lock().clone()),
            Err(_) => read(of),
        }
    }
}

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
fn read(of: &Bound<'_, PyAny>) -> PyResult<Changed> {
    if of.is_instance_of::<PyDict>() {
        let mut description: Machine = serde_json::from_value(from_python("machine", of)?).map_err(raised)?;
        // Changing nothing checks all of it.
        description.set_all(&[]).map_err(in_one_line)?;
        return Changed::new(description.name.clone(), description, None);
    }
    let path: PathBuf = of.extract().map_err(|_| refused("machine: neither a name, nor a path, nor a dictionary"))?;
    let name = path.to_string_lossy().into_owned();
    let is_file = path.components().count() > 1 || path.extension().is_some_and(|ending| ending == "toml");
    let description = if is_file { Machine::load(&path) } else { Machine::shipped(&name) }.map_err(in_one_line)?;
    let label = if is_file { path.file_stem().unwrap_or_default().to_string_lossy().into_owned() } else { name };
    Changed::new(label, description, if is_file { Some(absolute(path)?) } else { None })
}

/// A machine, or what makes one.
pub fn machine(of: &Bound<'_, PyAny>) -> PyResult<MachineFacts> {
    Ok(Changed::of(of)?.facts)
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
    fn lock(&self) -> MutexGuard<'_, Changed> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// What it is now.
    fn facts(&self) -> MachineFacts {
        self.lock().facts.clone()
    }

    fn change(&self, changes: &[(String, String)]) -> PyResult<()> {
        let mut changed = self.lock();
        let Changed { facts, before, .. } = &mut *changed;
        let pairs: Vec<_> = changes.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
        facts.description.set_all(&pairs).map_err(in_one_line)?;
        let now = serde_json::to_value(&facts.description).map_err(raised)?;
        // Of each key the last change, if it is one.
        for (key, value) in changes {
            facts.set.retain(|change| change.split_once('=').is_none_or(|(other, _)| other != key));
            if at(&now, key) != at(before, key) {
                facts.set.push(format!("{key}={value}"));
            }
        }
        Ok(())
    }

    fn value(&self) -> PyResult<Value> {
        serde_json::to_value(self.facts().description).map_err(raised)
    }
}

/// What a dotted path names in a description.
fn at<'a>(description: &'a Value, path: &str) -> Option<&'a Value> {
    path.split('.').filter(|key| !key.is_empty()).try_fold(description, |value, key| value.get(key))
}

/// What a dotted path names, or a part of the machine if that is a table.
fn look<'py>(machine: &Bound<'py, PyMachine>, path: &str) -> PyResult<Bound<'py, PyAny>> {
    let py = machine.py();
    let all = machine.get().value()?;
    match at(&all, path) {
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
    let table = at(value, path);
    let own = table.and_then(Value::as_object).into_iter().flat_map(|table| table.keys().cloned());
    own.chain(methods.iter().map(|&name| name.to_owned())).collect()
}

#[pymethods]
impl PyMachine {
    #[new]
    fn new(description: &Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self(Mutex::new(Changed::of(description)?)))
    }

    /// What results call it: its name, and key=value of each key that has another value than at first.
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
        Self(Mutex::new(self.lock().clone()))
    }

    /// All of its description.
    fn to_dict<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        to_python(py, &self.value()?)
    }

    fn __copy__(&self) -> Self {
        self.copy()
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        self.copy()
    }

    /// Machines are the same that have the same title and description.
    fn __eq__(&self, other: &Self) -> PyResult<bool> {
        Ok(self.title() == other.title() && self.value()? == other.value()?)
    }

    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, (String,))> {
        let state = serde_json::to_string(&*self.lock()).map_err(raised)?;
        Ok((py.import("lodray._lodray")?.getattr("_machine")?, (state,)))
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
        to_python(py, at(&all, &self.path).unwrap_or(&Value::Null))
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

/// The machine that was pickled as this. One of a file needs the file: others that it names lie beside it.
#[pyfunction]
pub fn _machine(state: &str) -> PyResult<PyMachine> {
    let mut own: Changed = serde_json::from_str(state).map_err(raised)?;
    if let Some(file) = &own.file {
        let mut description = Machine::load(file).map_err(in_one_line)?;
        let mut changes = Vec::new();
        let wanted = serde_json::to_value(&own.facts.description).map_err(raised)?;
        leaves("", &wanted, &mut changes);
        let pairs: Vec<_> = changes.iter().map(|(key, value)| (key.as_str(), value.as_str())).collect();
        description.set_all(&pairs).map_err(in_one_line)?;
        if serde_json::to_value(&description).map_err(raised)? != wanted {
            return Err(refused(format!("machine: {} has other keys than when the machine was pickled", file.display())));
        }
        own.facts.description = description;
    }
    Ok(PyMachine(Mutex::new(own)))
}

/// All keys of a description that are no tables, with their values as text.
fn leaves(path: &str, of: &Value, all: &mut Vec<(String, String)>) {
    match of {
        Value::Object(table) => table.iter().for_each(|(key, value)| {
            leaves(&if path.is_empty() { key.clone() } else { format!("{path}.{key}") }, value, all);
        }),
        Value::String(text) => all.push((path.to_owned(), text.clone())),
        Value::Null => (),
        value => all.push((path.to_owned(), value.to_string())),
    }
}

/// Names of the machines that come with the package.
#[pyfunction(name = "machines")]
pub fn machines_shipped() -> Vec<&'static str> {
    Machine::all_shipped()
}
