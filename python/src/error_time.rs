//! What an error costs.

use crate::errors::{of_file, raised, raised_by, refused};
use crate::machine::machines;
use crate::method::MOST_SAMPLES;
use crate::told::beside;
use crate::values::{document as to_document, named, option, within};
use lodray::format::{Scene, Staging};
use lodray::machine::Machine;
use lodray::method::{METHODS, find};
use lodray::rays::MAX_SIDE;
use lodray::report::result::MachineFacts;
use lodray::run::{self, Compute};
use lodray::scene::{MethodError, Target};
use lodray::study::{
    Cache, Chosen, ErrorTimePlan, JobLines, Jobs, Means, Measure, Measured, Origin, SceneJobs, ViewJob, document, error_time as measure,
    one_line,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use std::collections::BTreeMap;
use std::error::Error;
use std::io;
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_64;

/// Views that are done, as the program calls their file.
const LINES: &str = "views.jsonl";

/// What is to be measured.
pub struct Study<'a, 'py> {
    pub distances: Vec<f64>,
    pub size: [u32; 2],
    pub methods: Vec<String>,
    pub compute: &'a str,
    pub values: Option<&'a Bound<'py, PyDict>>,
    pub samples: i128,
    pub error_size: i128,
    pub most_samples: i128,
    pub out: Option<PathBuf>,
}

/// Samples along a side of a pixel, of so many in all.
fn side(of: &str, samples: i128, least: u32) -> PyResult<u32> {
    let samples = within(of, samples, least..=MOST_SAMPLES)?;
    let side = samples.isqrt();
    if side * side == samples { Ok(side) } else { Err(refused(format!("{of}: {samples} is no square"))) }
}

/// The values of error knobs, checked.
fn values(given: Option<&Bound<'_, PyDict>>) -> PyResult<BTreeMap<String, Vec<String>>> {
    let knobs: BTreeMap<_, _> = METHODS.iter().filter_map(|method| method.error).map(|error| (error.knob.name, error.knob)).collect();
    let mut all = BTreeMap::new();
    for (name, of) in given.into_iter().flatten() {
        let name = name.extract::<String>().map_err(|_| refused(format!("values: {name} is no name of a knob")))?.replace('_', "-");
        let knob = knobs.get(name.as_str()).ok_or_else(|| {
            let names = knobs.keys().map(|name| name.replace('-', "_")).collect::<Vec<_>>().join(", ");
            refused(format!("values: no method trades error by '{name}'; there are: {names}"))
        })?;
        // A text would be taken letter by letter.
        let list = if of.is_instance_of::<PyString>() { None } else { of.try_iter().ok() };
        let list = list.ok_or_else(|| refused(format!("values: {name} has {of}, and no list of values")))?;
        let list = list.map(|value| option(&value?)).collect::<PyResult<Vec<_>>>()?;
        if list.is_empty() {
            return Err(refused(format!("values: {name} has none")));
        }
        list.iter().try_for_each(|value| knob.check(value)).map_err(|error| refused(format!("values: {}", one_line(&error))))?;
        all.insert(name, list);
    }
    Ok(all)
}

impl Study<'_, '_> {
    fn plan(&self, scene: &Scene, machine: Option<&Bound<'_, PyAny>>) -> PyResult<ErrorTimePlan> {
        let compute: Compute = named("compute", self.compute)?;
        let usual = || -> Result<_, lodray::machine::MachineError> {
            let label = "haydel2023";
            Ok(vec![MachineFacts { label: label.to_owned(), set: Vec::new(), description: Machine::shipped(label)? }])
        };
        let on = machine.map_or_else(|| usual().map_err(raised), machines)?;
        on.iter().try_for_each(|machine| run::check(&machine.description, compute)).map_err(raised)?;
        let targets = on.into_iter().map(|machine| Target { machine, compute, window: None }).collect();
        let method = |name: &String| {
            let method = find(name).ok_or_else(|| raised(MethodError::Unknown(name.clone())))?;
            if method.name == "reference" {
                return Err(refused("methods: reference is what the others are compared with"));
            }
            if method.of_input() && scene.input().is_none() {
                return Err(refused(format!("methods: {name} is over the mesh, which the scene has only with keep_mesh")));
            }
            Ok(Chosen::plain(method))
        };
        for (of, count) in [("methods", self.methods.len()), ("distances", self.distances.len())] {
            if count == 0 {
                return Err(refused(format!("{of}: there is none")));
            }
        }
        let methods = self.methods.iter().map(method).collect::<PyResult<Vec<_>>>()?;
        let name = if scene.meta().name.is_empty() { "scene" } else { &scene.meta().name };
        let views: Vec<_> = self.distances.iter().map(|&distance| ViewJob::at(self.size, distance)).collect();
        let space = lodray::rays::ModelSpace::of(scene);
        views.iter().try_for_each(|view| view.camera(&space).map(drop)).map_err(raised)?;
        let origin = Origin::File(PathBuf::from(format!("{name}.lod")));
        let jobs = SceneJobs { content: xxh3_64(scene.bytes()), views, ..SceneJobs::new(name, origin) };
        let most = side("most_samples", self.most_samples, 0)?;
        let plan = ErrorTimePlan {
            values: values(self.values)?,
            sides: vec![side("samples", self.samples, 1)?],
            measure: Measure { host_rays: 0, ..Measure::of(within("error_size", self.error_size, 1..=MAX_SIDE)?, most) },
            ..ErrorTimePlan::new(Jobs::new(vec![jobs], methods, targets))
        };
        plan.check().map_err(raised)?;
        Ok(plan)
    }
}

/// The error of a folder of which the system refuses something.
fn failed(what: &str, folder: &Path) -> impl FnOnce(io::Error) -> PyErr {
    let what = format!("out: {what} {}", folder.display());
    move |error| of_file(format!("{what}: {error}"), &error)
}

/// Measures, and gives the document.
pub fn error_time<'py>(
    py: Python<'py>,
    scene: &Scene,
    study: Study<'_, 'py>,
    machine: Option<&Bound<'py, PyAny>>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyAny>> {
    let plan = study.plan(scene, machine)?;
    let removed = tempfile::tempdir().map_err(failed("cannot make a folder in", &std::env::temp_dir()))?;
    let folder: &Path = study.out.as_deref().unwrap_or(removed.path());
    std::fs::create_dir_all(folder).map_err(failed("cannot make folder", folder))?;
    // As long as it lives no other run writes to the folder, be it of the program or of Python.
    let staging = Staging::open(folder).map_err(failed("cannot write to", folder))?;
    let _staging = staging.ok_or_else(|| refused(format!("out: {}: another run is writing to this folder", folder.display())))?;
    let made = beside(py, progress, |told| -> Result<_, Box<dyn Error + Send + Sync>> {
        let mut rows = JobLines::open(&folder.join(LINES), told)?;
        let open = |_: &SceneJobs| Ok(scene.clone());
        let means = Means { cache: &Cache::NONE, open: &open, progress: told };
        let keys = measure(&plan, &mut rows, folder, &|_| scene.input().is_some(), &means)?;
        if let Some(why) = rows.of(&keys).find_map(|row| row.error.clone()) {
            return Err(why.into());
        }
        let measured: Vec<&Measured> = rows.of(&keys).filter_map(|row| row.measured.as_ref()).collect();
        Ok(document(&plan, &measured))
    })?;
    to_document(py, &made.map_err(|error| raised_by(&*error))?)
}
