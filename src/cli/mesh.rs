//! Mesh files as commands take them: read, welded, and told what was lost.

use super::names::named;
use super::output::{busy, warn};
use anyhow::Context;
use lodray::mesh::{MeshFormat, TriangleMesh, read, read_as, read_bytes};
use std::io::Read;
use std::path::Path;

/// What stands for standard input.
const STDIN: &str = "-";

/// How the mesh of a command is read, whose argument is called `mesh`.
#[derive(clap::Args)]
pub struct MeshArgs {
    /// Format of the mesh, whatever the file's ending; files that it names are looked for beside it, for standard input in the current folder
    #[arg(long, value_parser = named::<MeshFormat>(), required_if_eq("mesh", STDIN), requires = "mesh")]
    format: Option<MeshFormat>,
    /// Make one vertex of those at open edges that are at most this far apart, in the mesh's own units
    #[arg(long, value_name = "DISTANCE", value_parser = distance, allow_negative_numbers = true, requires = "mesh")]
    weld: Option<f64>,
}

/// Where a mesh is read from.
pub struct Source<'a> {
    /// The file; for standard input a name for messages.
    pub path: &'a Path,
    is_stdin: bool,
}

impl<'a> Source<'a> {
    /// That of an argument: a file, or - for standard input.
    pub fn new(mesh: &'a Path) -> Self {
        let is_stdin = mesh.as_os_str() == STDIN;
        Self { path: if is_stdin { Path::new("stdin") } else { mesh }, is_stdin }
    }

    /// The files that an output may not replace.
    pub fn files(&self) -> &[&'a Path] {
        if self.is_stdin { &[] } else { std::slice::from_ref(&self.path) }
    }

    /// Its name without folders and ending.
    pub fn name(&self) -> String {
        self.path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned())
    }

    /// One line for what is lost of it; an error if `strict`.
    pub fn lost(&self, what: &str, strict: bool) -> anyhow::Result<()> {
        anyhow::ensure!(!strict, "{}: {what}", self.path.display());
        warn(&format!("warning: {}: {what}", self.path.display()));
        Ok(())
    }
}

impl MeshArgs {
    /// The mesh. One line for each thing that was lost or changed when it was read, and one for seams that could be closed; the first is an error if `strict`, but for triangles without area.
    pub fn read(&self, source: &Source, strict: bool) -> anyhow::Result<TriangleMesh> {
        let mesh = busy("reading", || match self.format {
            Some(format) if source.is_stdin => read_stdin(format, source.path),
            Some(format) => Ok(read_as(source.path, format)?),
            None => Ok(read(source.path)?),
        })?;
        let mesh = match self.weld {
            Some(distance) => mesh.welded(distance).with_context(|| source.path.display().to_string())?,
            None => mesh,
        };
        let seams = mesh
            .seams()
            .map(|seams| format!("{} of its {} open edges are seams: --weld {:e} closes them", seams.closed, seams.open, seams.distance));
        let flat = mesh.report.flat();
        for lost in mesh.warnings.iter().chain(&seams) {
            source.lost(lost, strict && flat.as_ref() != Some(lost))?;
        }
        Ok(mesh)
    }

    /// The format of a file that can be found again, and the distance that it is welded by: a pipe cannot be read twice.
    pub fn found_again(&self, source: &Source) -> Option<(MeshFormat, Option<f64>)> {
        let format = self.format.or_else(|| MeshFormat::of(source.path)).filter(|_| !source.is_stdin && source.path.is_file());
        Some((format?, self.weld))
    }
}

/// A distance in the mesh's units.
fn distance(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if v > 0.0 && v.is_finite() => Ok(v),
        _ => Err(format!("'{s}' is not a distance above 0")),
    }
}

fn read_stdin(format: MeshFormat, name: &Path) -> anyhow::Result<TriangleMesh> {
    let mut bytes = Vec::new();
    std::io::stdin().lock().read_to_end(&mut bytes).context("cannot read standard input")?;
    Ok(read_bytes(&bytes, format, name, Path::new(""))?)
}
