//! From the list to jobs. Everything is looked at before the first job runs, so that a mistake in the last line does not cost the hours before it:
//! values and their ranges, scene files, machines with their tables, and cameras.

use super::list::{List, ListText, MachineEntry, Maybe, RegionEntry, SceneEntry, Spanned};
use crate::cli::args::{CameraArgs, Change, Size, radii};
use crate::cli::form::FormArgs;
use crate::cli::generate;
use crate::cli::machines::{is_path, machine, machine_files};
use crate::cli::method::{Listed, machine_methods};
use crate::cli::output::{open_any, read_text};
use clap::Args as _;
use lodray::format::Scene;
use lodray::mesh::{BoundKind, Placement, procedural};
use lodray::method::bvh::{LEAF_LAYOUT, LEAF_SIZE};
use lodray::method::knob::DELTA;
use lodray::method::packet::takes_packets;
use lodray::method::{Knob, KnobError, Knobs};
use lodray::num::VertexForm;
use lodray::rays::{Camera, DEFAULT_VIEW_ANGLE_DEGREES, MOST_IN_TURN, ModelSpace, may_be_in_turn};
use lodray::run::{self, Compute};
use lodray::scene::Target;
use lodray::study::{Chosen, Generated, Jobs, Origin, RegionJob, SceneJobs, ViewError, ViewJob, one_line};
use std::collections::{BTreeSet, HashSet};
use std::error::Error as _;
use std::ops::Range;
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_64;

/// Most jobs of a list, all of whose names are in memory at once.
const MOST_JOBS: usize = 1 << 20;
/// Most machines that one entry stands for, and of a list: each is read and checked.
const MOST_VARIANTS: usize = 1 << 12;
const MOST_MACHINES: usize = 1 << 14;

/// Reads and checks a list; every error names the file.
pub fn read_jobs(path: &Path) -> anyhow::Result<Jobs> {
    let text = read_text(path)?;
    jobs(&ListText { path, text: &text })
}

/// Reads and checks a list of pictures: regions have none.
pub fn read_views(path: &Path) -> anyhow::Result<Jobs> {
    let jobs = read_jobs(path)?;
    match jobs.scenes.iter().find(|scene| !scene.regions.is_empty()) {
        Some(scene) => {
            anyhow::bail!("{}: scene {}: regions are for lodray plan; pictures need distances or eyes", path.display(), scene.name)
        }
        None => Ok(jobs),
    }
}

/// Opens or generates a scene; says what is done, and what can be done about what fails.
pub fn open_scene(scene: &SceneJobs) -> anyhow::Result<Scene> {
    match &scene.origin {
        Origin::File(file) => open_any(file),
        Origin::Generate(made) => {
            generate::make(&made.options, FormArgs { bounds: made.bounds, vertices: made.vertices, ..FormArgs::default() })
        }
    }
}

/// The jobs of a list.
fn jobs(source: &ListText<'_>) -> anyhow::Result<Jobs> {
    let list: List = source.parse()?;
    // Before the first table, where the list's own keys stand.
    let top = || 0..0;
    let methods = needed(source, list.methods.as_ref(), "methods", top())?;
    let (place, methods) = (methods.span(), filled(source, methods, "methods")?);
    each_once(source, place, "methods", methods.iter().map(|method| method.0.name))?;
    let knobs = knobs(source, &list)?;
    let mut chosen = Vec::new();
    for &Listed(method) in methods {
        chosen.extend(qualities(source, &list, &Chosen { method, knobs: knobs.clone() })?);
    }
    let methods = chosen;
    if let Some(deltas) = &list.deltas {
        filled(source, deltas, "deltas")?;
        each_once(source, deltas.span(), "deltas", deltas.get_ref().iter().map(ToString::to_string))?;
    }
    let compute = match &list.compute {
        Some(compute) => {
            each_once(source, compute.span(), "compute", compute.get_ref().iter().map(|compute| compute.name()))?;
            filled(source, compute, "compute")?.clone()
        }
        None => vec![Compute::Free],
    };
    for (key, is_there) in [("[[scene]]", !list.scene.is_empty()), ("[[machine]]", !list.machine.is_empty())] {
        anyhow::ensure!(is_there, "{}: {key} is missing: at least one is needed", source.path.display());
    }
    let folder = source.path.parent().unwrap_or(Path::new(""));
    let (mut targets, mut files) = (Vec::new(), BTreeSet::new());
    for entry in &list.machine {
        let (variants, read) = machines(source, entry, folder, &compute)?;
        targets.extend(variants);
        let why = || format!("{}: more than {MOST_MACHINES} machines: share them among several lists", source.path.display());
        anyhow::ensure!(targets.len() <= MOST_MACHINES, why());
        files.extend(read);
    }
    let (mut scenes, mut views) = (Vec::<SceneJobs>::new(), 0usize);
    for entry in &list.scene {
        let jobs = scene(source, &list, entry, folder)?;
        if scenes.iter().any(|before| before.name == jobs.name) {
            let why = format!("scene: there is another of the name {:?}; give them names of their own", jobs.name);
            return Err(source.wrong(entry.span(), why));
        }
        if jobs.views.iter().any(|view| view.tiles_in_turn > 1) && methods.iter().any(|chosen| takes_packets(&chosen.knobs)) {
            return Err(source.wrong(entry.span(), "tiles_in_turn: packets take the rays of one tile"));
        }
        if let Origin::File(file) = &jobs.origin {
            files.insert(file.clone());
        }
        // Before the next scene's are made.
        views += jobs.views.len();
        let all = views.checked_mul(methods.len()).and_then(|all| all.checked_mul(targets.len())).filter(|all| *all <= MOST_JOBS);
        anyhow::ensure!(all.is_some(), "{}: {}", source.path.display(), too_many_jobs());
        scenes.push(jobs);
    }
    let deltas = list.deltas.as_ref().map_or_else(Vec::new, |deltas| deltas.get_ref().iter().map(ToString::to_string).collect());
    let jobs = Jobs { scenes, methods, targets, deltas, error: list.error, intervals: list.intervals, files };
    let mut seen = HashSet::new();
    for key in jobs.keys()? {
        anyhow::ensure!(seen.insert(key.clone()), "{}: a job is there twice: {key}", source.path.display());
    }
    Ok(jobs)
}

fn too_many_jobs() -> String {
    format!("more than {MOST_JOBS} jobs: share them among several lists")
}

/// The knobs that are the same for all methods: leaves, and those of the list's table.
fn knobs(source: &ListText<'_>, list: &List) -> anyhow::Result<Knobs> {
    let mut knobs = Knobs::default();
    if let Some(layout) = &list.leaf_layout {
        let why = |why: KnobError| source.wrong(layout.span(), format!("leaf_layout: {}", why.why));
        knobs.set(&LEAF_LAYOUT, layout.get_ref()).map_err(why)?;
    }
    if let Some(size) = &list.leaf_size {
        let why = |_| source.wrong(size.span(), format!("leaf_size must be 1, 2, 4, 8 or 16, but is {}", size.get_ref()));
        knobs.set(&LEAF_SIZE, &size.get_ref().to_string()).map_err(why)?;
    }
    for (name, value) in &list.knobs {
        let own: Vec<&Knob> =
            machine_methods().flat_map(|method| method.knobs.iter().copied()).filter(|knob| list_key(knob).is_none()).collect();
        let names = || own.iter().map(|knob| knob.name).collect::<BTreeSet<_>>().into_iter().collect::<Vec<_>>().join(", ");
        let wrong = |what: String| source.wrong(value.span(), format!("knobs: {what}"));
        let knob = own.iter().find(|knob| knob.name == name).ok_or_else(|| wrong(format!("there is no {name}; there are: {}", names())))?;
        knobs.set(knob, &value.get_ref().to_string()).map_err(|why| wrong(why.to_string()))?;
    }
    Ok(knobs)
}

/// The key of the list that stands for a knob, if it is not one of its table.
fn list_key(knob: &Knob) -> Option<&'static str> {
    [(&DELTA, "deltas"), (&LEAF_LAYOUT, "leaf_layout"), (&LEAF_SIZE, "leaf_size")]
        .into_iter()
        .find(|(own, _)| own.name == knob.name)
        .map(|(_, key)| key)
}

/// A method with each of its qualities.
fn qualities(source: &ListText<'_>, list: &List, chosen: &Chosen) -> anyhow::Result<Vec<Chosen>> {
    let Some(deltas) = list.deltas.as_ref().filter(|_| chosen.method.has(DELTA.name)) else { return Ok(vec![chosen.clone()]) };
    let with = |delta: &super::list::Value| {
        let wrong = |why: KnobError| source.wrong(deltas.span(), format!("deltas: {}", why.why));
        Ok(Chosen { method: chosen.method, knobs: chosen.knobs.clone().with(&DELTA, &delta.to_string()).map_err(wrong)? })
    };
    deltas.get_ref().iter().map(with).collect()
}

/// A value that must be there; `place` is where it is missed.
fn needed<'a, T>(source: &ListText<'_>, value: Option<&'a Spanned<T>>, key: &str, place: Range<usize>) -> anyhow::Result<&'a Spanned<T>> {
    value.ok_or_else(|| source.wrong(place, format!("{key} is missing")))
}

/// A list that must not be empty.
fn filled<'a, T>(source: &ListText<'_>, values: &'a Spanned<Vec<T>>, key: &str) -> anyhow::Result<&'a Vec<T>> {
    if values.get_ref().is_empty() {
        return Err(source.wrong(values.span(), format!("{key} must not be empty")));
    }
    Ok(values.get_ref())
}

/// Refuses what is in a list twice.
fn each_once(source: &ListText<'_>, place: Range<usize>, key: &str, values: impl Iterator<Item = impl ToString>) -> anyhow::Result<()> {
    let mut seen = HashSet::new();
    for value in values.map(|value| value.to_string()) {
        if seen.contains(&value) {
            return Err(source.wrong(place, format!("{key}: {value} is there twice")));
        }
        seen.insert(value);
    }
    Ok(())
}

/// Every variant of a machine, with each way to compute, and the files that they were read from.
fn machines(
    source: &ListText<'_>,
    entry: &Spanned<MachineEntry>,
    folder: &Path,
    compute: &[Compute],
) -> anyhow::Result<(Vec<Target>, BTreeSet<PathBuf>)> {
    let MachineEntry { name, set } = entry.get_ref();
    let name = needed(source, name.as_ref(), "machine: name", entry.span())?;
    // A file is relative to the list.
    let path = if is_path(name.get_ref()) { folder.join(name.get_ref()).display().to_string() } else { name.get_ref().clone() };
    machine(&path, &[], "set").map_err(|why| source.wrong(name.span(), format!("machine {}: {}", name.get_ref(), one_line(&*why))))?;
    let all =
        set.values().try_fold(1usize, |all, values| all.checked_mul(values.get_ref().all().len()).filter(|all| *all <= MOST_VARIANTS));
    if let (None, Some(values)) = (all, set.values().next()) {
        let why = format!("machine {}: set: more than {MOST_VARIANTS} combinations of values", name.get_ref());
        return Err(source.wrong(values.span(), why));
    }
    // Every combination of the values, the last key's changing fastest.
    let mut variants = vec![Vec::new()];
    for (key, values) in set {
        if values.get_ref().all().is_empty() {
            return Err(source.wrong(values.span(), format!("machine {}: set: {key} has no value", name.get_ref())));
        }
        let with = |variant: &Vec<Change>| -> Vec<Vec<Change>> {
            let change = |value: &super::list::Value| Change { key: key.clone(), value: value.to_string() };
            values.get_ref().all().iter().map(|value| variant.iter().cloned().chain([change(value)]).collect()).collect()
        };
        variants = variants.iter().flat_map(with).collect();
    }
    let place = set.values().next().map_or_else(|| name.span(), Spanned::span);
    let (mut targets, mut files) = (Vec::new(), BTreeSet::new());
    for variant in &variants {
        let wrong = |why: anyhow::Error| source.wrong(place.clone(), format!("machine {}: {}", name.get_ref(), one_line(&*why)));
        let machine = machine(&path, variant, "set").map_err(wrong)?;
        for &compute in compute {
            run::check(&machine.description, compute).map_err(|why| wrong(why.into()))?;
            targets.push(Target { machine: machine.clone(), compute, window: None });
        }
        files.extend(machine_files(&path, &machine).map_err(|why| wrong(why.into()))?);
    }
    Ok((targets, files))
}

/// A scene and what to see of it.
fn scene(source: &ListText<'_>, list: &List, spanned: &Spanned<SceneEntry>, folder: &Path) -> anyhow::Result<SceneJobs> {
    let entry = spanned.get_ref();
    let (origin, name, content, space) = match (&entry.file, &entry.generate) {
        (Some(file), None) => {
            let place = |value: Option<Range<usize>>, key: &'static str| value.map(|place| (key, place));
            let own = [
                place(entry.levels.as_ref().map(Spanned::span), "levels"),
                place(entry.base.as_ref().map(Spanned::span), "base"),
                place(entry.seed.as_ref().map(Spanned::span), "seed"),
                place(entry.roughness.as_ref().map(Spanned::span), "roughness"),
                place(entry.width.as_ref().map(Spanned::span), "width"),
                place(entry.bounds.as_ref().map(Spanned::span), "bounds"),
                place(entry.vertices.as_ref().map(Spanned::span), "vertices"),
            ];
            if let Some((key, place)) = own.into_iter().flatten().next() {
                return Err(source.wrong(place, format!("scene: {key} goes with generate, not with file")));
            }
            let path = folder.join(file.get_ref());
            let scene = open_any(&path).map_err(|why| source.wrong(file.span(), format!("scene: {}", one_line(&*why))))?;
            let name = file.get_ref().file_stem().unwrap_or_default().to_string_lossy().into_owned();
            (Origin::File(path), name, xxh3_64(scene.bytes()), ModelSpace::of(&scene))
        }
        (None, Some(kind)) => {
            let value = |value: &Maybe<u32>| value.as_ref().map(|value| *value.get_ref());
            let options = procedural::Options {
                scene: *kind.get_ref(),
                levels: value(&entry.levels),
                base: value(&entry.base),
                seed: entry.seed.as_ref().map_or(0, |seed| *seed.get_ref()),
                roughness: entry.roughness.as_ref().map(|roughness| *roughness.get_ref()),
                walls: None,
                width: entry.width.as_ref().map(|width| *width.get_ref()),
            };
            generate::check(&options).map_err(|why| source.wrong(spanned.span(), format!("scene: {}", one_line(&*why))))?;
            let bounds = entry.bounds.as_ref().or(list.bounds.as_ref()).map_or_else(BoundKind::default, |bounds| *bounds.get_ref());
            let vertices = entry.vertices.as_ref().or(list.vertices.as_ref()).map_or_else(VertexForm::default, |form| *form.get_ref());
            (Origin::Generate(Generated { options, bounds, vertices }), format!("{:?}", kind.get_ref()).to_lowercase(), 0, stand_in())
        }
        (Some(file), Some(_)) => return Err(source.wrong(file.span(), "scene: has both file and generate")),
        (None, None) => return Err(source.wrong(spanned.span(), "scene: needs either file or generate")),
    };
    let name = entry.name.as_ref().map_or(name, |name| name.get_ref().clone());
    let views = views(source, list, spanned)?;
    let regions = regions(source, list, spanned)?;
    for view in &views {
        let wrong = |why: ViewError| source.wrong(spanned.span(), format!("scene {name}: {}", one_line(&why)));
        view.camera(&space).map_err(wrong)?;
    }
    Ok(SceneJobs { name, origin, content, has_mesh: false, views, regions })
}

/// A place for a model that is not there yet. Its centre is nowhere in particular, so that a camera that is impossible here is so for every model.
fn stand_in() -> ModelSpace {
    let placement = Placement { offset: [0.312, 0.417, 0.523], scale: 2f64.powi(-31) };
    ModelSpace { placement, lo: [-1 << 30; 3], hi: [1 << 30; 3], zeros: [0; 2] }
}

/// Columns and rows of a scene's pictures.
fn size(source: &ListText<'_>, list: &List, entry: &SceneEntry) -> anyhow::Result<[u32; 2]> {
    let size = needed(source, entry.size.as_ref().or(list.size.as_ref()), "size", 0..0)?;
    let Size(width, height) = size.get_ref().parse().map_err(|why| source.wrong(size.span(), format!("size: {why}")))?;
    Ok([width, height])
}

/// Boxes that cameras stay in; none for most scenes.
fn regions(source: &ListText<'_>, list: &List, spanned: &Spanned<SceneEntry>) -> anyhow::Result<Vec<RegionJob>> {
    let entry = spanned.get_ref();
    let Some(regions) = &entry.regions else { return Ok(Vec::new()) };
    let cone = Camera::cone(entry.fov.unwrap_or(DEFAULT_VIEW_ANGLE_DEGREES), size(source, list, entry)?[1]);
    let is_finite = |of: &RegionEntry| of.from.iter().chain(&of.to).all(|coordinate| coordinate.is_finite());
    if !filled(source, regions, "regions")?.iter().all(is_finite) {
        return Err(source.wrong(regions.span(), "regions: from and to must be finite".to_owned()));
    }
    let region = |of: &RegionEntry| {
        let corner = |by: fn(f64, f64) -> f64| std::array::from_fn(|k| by(of.from[k], of.to[k]));
        RegionJob { lo: corner(f64::min), hi: corner(f64::max), cone }
    };
    let all: Vec<RegionJob> = filled(source, regions, "regions")?.iter().map(region).collect();
    match all.iter().find_map(|region| region.at(1.0).wrong()) {
        Some((field, must)) => Err(source.wrong(regions.span(), format!("regions: {field} must be {must}"))),
        None => Ok(all),
    }
}

/// Tiles whose rays are handed out in turn.
fn tiles_in_turn(source: &ListText<'_>, list: &List, entry: &SceneEntry) -> anyhow::Result<u32> {
    match entry.tiles_in_turn.as_ref().or(list.tiles_in_turn.as_ref()) {
        Some(tiles) if !may_be_in_turn(*tiles.get_ref()) => {
            Err(source.wrong(tiles.span(), format!("tiles_in_turn: must be a power of two from 1 to {MOST_IN_TURN}")))
        }
        tiles => Ok(tiles.map_or(1, |tiles| *tiles.get_ref())),
    }
}

fn views(source: &ListText<'_>, list: &List, spanned: &Spanned<SceneEntry>) -> anyhow::Result<Vec<ViewJob>> {
    let entry = spanned.get_ref();
    // In place of the list's views; beside the scene's own.
    if entry.regions.is_some() && entry.distances.is_none() && entry.eyes.is_none() {
        return Ok(Vec::new());
    }
    let [width, height] = size(source, list, entry)?;
    let triple = |value: &Maybe<[f64; 3]>, key: &str| match value {
        Some(value) => option(source, value.span(), key, key, value.get_ref()).map(|()| Some(*value.get_ref())),
        None => Ok(None),
    };
    let (target, up, fov) = (triple(&entry.target, "target")?, triple(&entry.up, "up")?, entry.fov.unwrap_or(DEFAULT_VIEW_ANGLE_DEGREES));
    let tiles_in_turn = tiles_in_turn(source, list, entry)?;
    let base = ViewJob { size: [width, height], distance: None, direction: None, eye: None, target, up, fov, tiles_in_turn };
    if let Some(eyes) = &entry.eyes {
        if let Some(other) = entry.distances.as_ref().map(Spanned::span).or(entry.directions.as_ref().map(Spanned::span)) {
            return Err(source.wrong(other, "scene: eyes are in place of distances and directions"));
        }
        filled(source, eyes, "eyes")?.iter().try_for_each(|eye| option(source, eyes.span(), "eyes", "eye", eye))?;
        return Ok(eyes.get_ref().iter().map(|&eye| ViewJob { eye: Some(eye), ..base.clone() }).collect());
    }
    let distances = needed(source, entry.distances.as_ref().or(list.distances.as_ref()), "scene: distances or eyes", spanned.span())?;
    let place = distances.span();
    let distances = filled(source, distances, "distances")?;
    for distance in distances {
        radii(&distance.to_string()).map_err(|why| source.wrong(place.clone(), format!("distances: {why}")))?;
    }
    let directions = match &entry.directions {
        Some(directions) => {
            filled(source, directions, "directions")?.iter().try_for_each(|d| option(source, directions.span(), "directions", "eye", d))?;
            directions.get_ref().iter().copied().map(Some).collect()
        }
        None => vec![None],
    };
    // Few words can name many.
    if directions.len().checked_mul(distances.len()).is_none_or(|views| views > MOST_JOBS) {
        return Err(source.wrong(place, format!("scene: {}", too_many_jobs())));
    }
    let view = |direction, &distance: &f64| ViewJob { distance: Some(distance), direction, ..base.clone() };
    Ok(directions.iter().flat_map(|&direction| distances.iter().map(move |d| view(direction, d)).collect::<Vec<_>>()).collect())
}

/// Refuses three numbers that the command line's `option` refuses, in its words.
fn option(source: &ListText<'_>, place: Range<usize>, key: &str, option: &str, value: &[f64; 3]) -> anyhow::Result<()> {
    let word = format!("--{option}={}", value.map(|v| v.to_string()).join(","));
    let command = CameraArgs::augment_args(clap::Command::new("list").no_binary_name(true));
    command.try_get_matches_from([word]).map(drop).map_err(|error| {
        let why = error.source().map_or_else(|| error.to_string(), ToString::to_string);
        source.wrong(place, format!("{key}: {why}"))
    })
}
