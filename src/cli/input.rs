//! The mesh file that a scene was built from: recorded by `build`, found again by name and hash.

use super::output::{busy, remark, warn};
use anyhow::Context;
use lodray::format::{Meta, Scene};
use lodray::mesh::{MeshFormat, named_files, read_as};
use lodray::method::Over;
use lodray::scene::BuildOptions;
use lodray::study::Chosen;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::{Xxh3Default, xxh3_64};

/// What `build` records of its mesh file.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct InputFile {
    /// Its name, without folders.
    name: String,
    /// Of its bytes.
    xxh3: String,
    /// Of the bytes of the files that are read with it, one after the other; none of a mesh without any, or of a scene by an older program.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    with: Option<String>,
    /// Its format, whatever its name ends in.
    format: MeshFormat,
    /// Vertices at open edges that are at most this far apart were made one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    weld: Option<f64>,
}

#[derive(clap::Args)]
pub struct InputArgs {
    /// Mesh file that a scene was built from, for methods over it (default: the file of that name beside the scene, or in the current folder); it must be the same file; may be repeated
    #[arg(long, value_name = "FILE")]
    pub mesh: Vec<PathBuf>,
}

impl InputFile {
    /// That of a mesh file of this format which was welded so.
    pub fn of(path: &Path, format: MeshFormat, weld: Option<f64>) -> anyhow::Result<Self> {
        let bytes = std::fs::read(path).with_context(|| path.display().to_string())?;
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        Ok(Self { name, xxh3: hash(&bytes), with: hash_with(path)?, format, weld })
    }

    /// The first of the files that it is; those that were named, else the ones of its name beside the scene and here.
    fn find(&self, scene: &Path, named: &[PathBuf]) -> Option<PathBuf> {
        let beside = [scene.parent().unwrap_or(Path::new("")).join(&self.name), PathBuf::from(&self.name)];
        let candidates = if named.is_empty() { &beside[..] } else { named };
        let is_same = |path: &&PathBuf| {
            let same = path.is_file() && std::fs::read(path).is_ok_and(|bytes| hash(&bytes) == self.xxh3);
            same && (self.with.is_none() || hash_with(path).is_ok_and(|with| with == self.with))
        };
        candidates.iter().find(is_same).cloned()
    }

    /// The mesh as a scene of its own triangles, vertices exact.
    fn scene(&self, path: &Path) -> anyhow::Result<Scene> {
        let mesh = busy("reading the input mesh", || read_as(path, self.format))?;
        let mesh = match self.weld {
            Some(distance) => mesh.welded(distance).with_context(|| path.display().to_string())?,
            None => mesh,
        };
        let options = BuildOptions { name: self.name.clone(), ..BuildOptions::own_triangles() };
        busy("encoding", || Scene::of_mesh(&mesh, &options, &|_, _, _| ())).with_context(|| path.display().to_string())
    }
}

/// Of the files that are read with a mesh, if there are any.
fn hash_with(path: &Path) -> anyhow::Result<Option<String>> {
    let files = named_files(path);
    let mut hash = Xxh3Default::new();
    for file in &files {
        std::fs::File::open(file).and_then(|mut file| std::io::copy(&mut file, &mut hash)).with_context(|| file.display().to_string())?;
    }
    Ok((!files.is_empty()).then(|| format!("{:016x}", hash.digest())))
}

fn hash(bytes: &[u8]) -> String {
    format!("{:016x}", xxh3_64(bytes))
}

/// Whether the mesh that a scene file was built from is at hand.
pub fn is_found(scene: &Path, args: &InputArgs) -> bool {
    let record = Scene::open(scene).ok().and_then(|scene| InputFile::deserialize(&scene.meta().origin[Meta::FILE]).ok());
    record.is_some_and(|file| file.find(scene, &args.mesh).is_some())
}

/// The scene with the mesh that it was built from at hand, if one of the methods needs it, or takes it where it is found.
///
/// # Errors
/// The scene does not say which mesh that is, or it is not where it is looked for.
pub fn with_input<'a>(scene: Scene, path: &Path, args: &InputArgs, methods: impl IntoIterator<Item = &'a Chosen>) -> anyhow::Result<Scene> {
    let mut takes = false;
    match methods.into_iter().inspect(|chosen| takes |= chosen.method.over == Over::Either).find(|chosen| chosen.method.of_input()) {
        Some(chosen) => match mesh_of(&scene, path, args) {
            Ok(input) => Ok(scene.with_input(input)),
            Err(why) => Err(why.context(format!("--method {}", chosen.method.name))),
        },
        None if takes => with_input_if_found(scene, path, args, "clusters and R-LODs are of the finest level"),
        None => {
            if !args.mesh.is_empty() {
                warn("note: --mesh is not used: no method here takes the mesh");
            }
            Ok(scene)
        }
    }
}

/// The scene with the mesh that it was built from at hand, where that can be found; where it cannot, a line says what is `without` it.
pub fn with_input_if_found(scene: Scene, path: &Path, args: &InputArgs, without: &str) -> anyhow::Result<Scene> {
    match mesh_of(&scene, path, args) {
        Ok(input) => return Ok(scene.with_input(input)),
        // A scene that was made from no mesh is its own full resolution.
        Err(_) if [Meta::FILE, Meta::FILE_AT_REST].iter().all(|&file| scene.meta().origin[file].is_null()) => {}
        Err(why) => remark(&format!("note: {without}: {why:#}"))?,
    }
    Ok(scene)
}

/// The mesh that a scene was built from.
///
/// # Errors
/// As [`with_input`].
pub fn mesh_of(scene: &Scene, path: &Path, args: &InputArgs) -> anyhow::Result<Scene> {
    let record = &scene.meta().origin[Meta::FILE];
    if let Some(at_rest) = scene.meta().origin[Meta::FILE_AT_REST]["name"].as_str() {
        anyhow::bail!("{}: its vertices were moved (refit), and {at_rest}, which it was built from, shows them at rest", path.display());
    }
    anyhow::ensure!(!record.is_null(), "{}: was not built from a mesh file, or by an older lodray", path.display());
    let file = InputFile::deserialize(record).with_context(|| format!("{}: origin", path.display()))?;
    if let Some(missing) = args.mesh.iter().find(|mesh| !mesh.is_file()) {
        anyhow::bail!("--mesh {}: there is no such file", missing.display());
    }
    let found = file.find(path, &args.mesh).with_context(|| {
        let place =
            if args.mesh.is_empty() { "neither beside it nor in the current folder; name it with --mesh" } else { "none of --mesh" };
        let with = if file.with.is_some() { ", with the files that belong to it," } else { "" };
        format!("{} was built from {}, and that very file{with} is {place}", path.display(), file.name)
    })?;
    file.scene(&found)
}
