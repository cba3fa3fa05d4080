//! The Python package `lodray`: the library's calls with arrays of NumPy's in place of slices, and dictionaries in place of reports.
//!
//! Nothing is traced, built or simulated here: whatever a call does, it does as the program does.

mod arrays;
mod camera;
mod error_time;
mod errors;
mod machine;
mod method;
mod paths;
mod plan;
mod scene;
mod simulate;
mod told;
mod values;

use lodray::method::METHODS;
use pyo3::prelude::*;
use serde_json::json;

/// The ways to find hits: a list of dictionaries of name, help, and knobs (name, help, default, and values if they are words).
#[pyfunction]
fn methods(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
    let methods = METHODS.iter().map(|method| {
        let knobs = method.knobs.iter().map(|knob| {
            let values: Vec<_> = knob.words.iter().map(|(word, _)| word).collect();
            json!({ "name": knob.name.replace('-', "_"), "help": errors::of_arguments(knob.help), "default": knob.default, "values": values })
        });
        json!({ "name": method.name, "help": method.help, "knobs": knobs.collect::<Vec<_>>() })
    });
    values::document(py, &methods.collect::<Vec<_>>())
}

/// The compiled part of lodray.
#[pymodule]
fn _lodray(module: &Bound<'_, PyModule>) -> PyResult<()> {
    let py = module.py();
    module.add("LodrayError", py.get_type::<errors::LodrayError>())?;
    module.add("HIT", arrays::hit_dtype(py)?)?;
    module.add("RAY", arrays::ray_dtype(py)?)?;
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<scene::PyScene>()?;
    module.add_class::<method::PySceneMethod>()?;
    module.add_class::<camera::PyCamera>()?;
    module.add_class::<machine::PyMachine>()?;
    module.add_class::<machine::PyMachinePart>()?;
    module.add_function(wrap_pyfunction!(methods, module)?)?;
    module.add_function(wrap_pyfunction!(machine::machines_shipped, module)?)?;
    // What pickles are read by: none of them is exported.
    module.setattr("_machine", wrap_pyfunction!(machine::_machine, module)?)?;
    module.setattr("_camera", wrap_pyfunction!(camera::_camera, module)?)?;
    module.add_function(wrap_pyfunction!(paths::paths, module)?)
}
