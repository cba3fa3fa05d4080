//! What is to be measured: scenes, views, methods with the values of their knobs, machines, samples.

use crate::method::{ErrorKnob, Method};
use crate::picture::{PIXELS_PER_DEGREE, Shading};
use crate::rays::{MAX_PIXELS, MAX_SIDE, Sight};
use crate::report::result::{MachineFacts, MethodFacts};
use crate::study::{Chosen, Jobs, SceneJobs, StudyError, Turning, ViewJob};
use std::collections::{BTreeMap, HashSet};
use xxhash_rust::xxh3::xxh3_64;

/// Everything that is asked for.
pub struct ErrorTimePlan {
    /// Scenes, views and machines; each method once, with the knobs that are not swept.
    pub jobs: Jobs,
    /// Values of error knobs, by name of the knob; others have the method's own.
    pub values: BTreeMap<String, Vec<String>>,
    /// Samples along a side of a pixel.
    pub sides: Vec<u32>,
    /// How errors are measured.
    pub measure: Measure,
    /// Frames after one another, if warm ones are wanted.
    pub turning: Option<Turning>,
    /// What may be left out of scenes and units: whatever moves nothing by more than so many pixels.
    pub within: Vec<f64>,
}

/// Rays whose steps a page has, of all views and methods together.
const MOST_TRACES: usize = 16_384;

/// How errors are measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Measure {
    /// How pictures are shaded.
    pub shading: Shading,
    /// Of the display that FLIP assumes.
    pub pixels_per_degree: f64,
    /// Most columns and rows of the frame of which errors and pictures are.
    pub error_size: u32,
    /// One ray in this many is compared with the nearest point of the surface.
    pub stride: u32,
    /// Most samples along a side of a converged picture's pixel; 0 for no such picture.
    pub most_samples: u32,
    /// Rays whose time on the host is taken; 0 for none.
    pub host_rays: u32,
}

impl Default for Measure {
    /// As the program has it.
    fn default() -> Self {
        Self::of(384, 32)
    }
}

impl Measure {
    /// Errors of so many columns and rows at most, and so many samples along a side of a converged picture's pixel; all else as by default.
    pub fn of(error_size: u32, most_samples: u32) -> Self {
        Self {
            shading: Shading::default(),
            pixels_per_degree: PIXELS_PER_DEGREE,
            error_size,
            // About 65,536 rays at most.
            stride: error_size.div_ceil(256),
            most_samples,
            host_rays: 16_384,
        }
    }

    /// Errors and pictures use every k-th column and row of a frame of this size.
    pub fn every(&self, size: [u32; 2]) -> u32 {
        size[0].max(size[1]).div_ceil(self.error_size).max(1)
    }
}

/// Samples along a side of a converged picture's pixel, at least, beside pictures with these: twice the most, and never below 4.
pub fn least_converged(sides: &[u32]) -> u32 {
    2 * sides.iter().copied().max().unwrap_or(1).max(2)
}

/// A method with one value of its knob.
pub(super) struct Setting {
    pub chosen: Chosen,
    /// The method with it, if another than the one that was made for the scene.
    pub method: Option<Box<dyn Method>>,
    /// In words.
    pub words: String,
    /// It is what the method does if nothing is chosen.
    pub is_default: bool,
}

impl Setting {
    fn new(chosen: Chosen, method: &dyn Method, sight: &impl Fn(f64) -> Sight) -> Self {
        let again = method.again(&chosen.knobs);
        let choices = again.as_deref().unwrap_or(method).choices(&sight(chosen.delta()));
        let facts = MethodFacts::new(chosen.method, &chosen.knobs, &choices, 0);
        let chose: Vec<_> = choices.iter().map(|(name, value)| format!("{name} {value}")).collect();
        let words = match chosen.method.error.filter(|_| chose.is_empty()) {
            Some(ErrorKnob { knob, .. }) => format!("{} {}", knob.name, facts.knobs.get(knob.name).map_or("", String::as_str)),
            None if chose.is_empty() => "full resolution".to_owned(),
            None => chose.join(", "),
        };
        Self { chosen, method: again, words, is_default: false }
    }

    /// What a method does if nothing is chosen.
    pub fn usual(base: &Chosen, method: &dyn Method, sight: impl Fn(f64) -> Sight) -> Self {
        let knobs = base.method.error.map_or_else(|| base.knobs.clone(), |error| base.knobs.clone().without(error.knob));
        Self { is_default: true, ..Self::new(Chosen { method: base.method, knobs }, method, &sight) }
    }

    /// It is the usual one of a method with levels: without a knob every triangle is of the finest.
    pub fn has_levels(&self) -> bool {
        self.is_default && self.chosen.method.error.is_some()
    }
}

impl ErrorTimePlan {
    /// These jobs, measured as the program does it: with one and four samples a pixel, and every method's own values of its knob.
    pub fn new(mut jobs: Jobs) -> Self {
        jobs.each_method_once();
        Self { jobs, values: BTreeMap::new(), sides: vec![1, 2], measure: Measure::default(), turning: None, within: Vec::new() }
    }

    /// The settings of a method for a view, from coarse to fine; those that choose the same for the frame once.
    pub(super) fn settings(&self, base: &Chosen, method: &dyn Method, sight: impl Fn(f64) -> Sight) -> Result<Vec<Setting>, StudyError> {
        let of = |chosen: Chosen| Setting::new(chosen, method, &sight);
        let default = Setting::usual(base, method, &sight).words;
        let all = match base.method.error {
            None => vec![of(base.clone())],
            Some(ErrorKnob { knob, .. }) => {
                let with = |value: &String| Ok(of(Chosen { method: base.method, knobs: base.knobs.clone().with(knob, value)? }));
                self.values(base).iter().map(with).collect::<Result<Vec<_>, StudyError>>()?
            }
        };
        let mut seen = HashSet::new();
        let new =
            |setting: Setting| seen.insert(setting.words.clone()).then(|| Setting { is_default: setting.words == default, ..setting });
        Ok(all.into_iter().filter_map(new).collect())
    }

    /// Samples along a side of a converged picture's pixel, at least: more than pictures have that are held against it.
    pub fn least_converged(&self) -> u32 {
        least_converged(&self.sides)
    }

    /// Refuses more samples than there can be, and fewer than say anything, before anything is traced.
    ///
    /// # Errors
    /// There are.
    pub fn check(&self) -> Result<(), StudyError> {
        let (most_samples, least) = (self.measure.most_samples, self.least_converged());
        if (1..least).contains(&most_samples) {
            return Err(StudyError::Converged { samples: u64::from(most_samples).pow(2), least: u64::from(least).pow(2) });
        }
        let most = u64::from(self.sides.iter().copied().max().unwrap_or(1));
        for view in self.jobs.scenes.iter().flat_map(|scene| &scene.views) {
            let [width, height] = view.size.map(|n| u64::from(n) * most);
            if width.max(height) > u64::from(MAX_SIDE) || width * height > MAX_PIXELS {
                return Err(StudyError::Samples { samples: most * most, size: view.size });
            }
        }
        Ok(())
    }

    /// How many views there are.
    pub fn views(&self) -> usize {
        self.jobs.scenes.iter().map(|scene| scene.views.len()).sum()
    }

    /// Columns and rows of the grid of rays whose steps a page has: fewer where there are many views.
    pub(super) fn trace_grid(&self) -> u32 {
        let each = MOST_TRACES / (self.views() * self.jobs.methods.len()).max(1);
        u32::try_from(each.isqrt()).unwrap_or(u32::MAX).clamp(4, 16)
    }

    /// The machines, each once.
    pub fn machines(&self) -> Vec<MachineFacts> {
        let mut machines: Vec<MachineFacts> = Vec::new();
        for target in &self.jobs.targets {
            if !machines.contains(&target.machine) {
                machines.push(target.machine.clone());
            }
        }
        machines
    }

    /// The number of a target's machine among `machines`.
    pub(super) fn machine_of(&self, target: usize, machines: &[MachineFacts]) -> usize {
        let machine = self.jobs.targets.get(target).map(|target| &target.machine);
        machines.iter().position(|of| Some(of) == machine).unwrap_or(0)
    }

    /// The values of a method's error knob.
    fn values(&self, base: &Chosen) -> Vec<String> {
        let Some(error) = base.method.error else { return Vec::new() };
        let own = || (error.values)().iter().map(ToString::to_string).collect();
        self.values.get(error.knob.name).cloned().unwrap_or_else(own)
    }

    /// The name of a view's job, which changes with everything that its figures depend on, the program's own version at its end: also with whether errors are
    /// against the mesh that the scene was built from.
    pub(super) fn key(&self, scene: &SceneJobs, view: &ViewJob, sizes: bool, against_mesh: bool) -> Result<String, StudyError> {
        let mut inputs = String::new();
        let mut name = String::new();
        for chosen in &self.jobs.methods {
            for target in &self.jobs.targets {
                name = self.jobs.key(scene, view, chosen, target)?;
                inputs += &name;
            }
            inputs += &format!("{:?}", self.values(chosen));
        }
        inputs += &format!("{:?} {:?} {} {sizes}", self.sides, self.measure, self.trace_grid());
        inputs += &self.turning.map_or_else(String::new, |turning| format!(" {turning:?}"));
        inputs += &self.within.iter().map(|pixels| format!(" within {pixels}")).collect::<String>();
        inputs += if against_mesh { " against the mesh" } else { "" };
        // As in a sweep: scene, place and size, and the version at the end.
        let place: Vec<_> = name.split(", ").take(3).collect();
        let version = name.rsplit(' ').next().unwrap_or_default();
        Ok(format!("{} #{:016x} {version}", place.join(", "), xxh3_64(inputs.as_bytes())))
    }
}
