//! Mesh files in: OBJ, PLY, glTF and STL, checked so that a bad file gives one error that names the place.

mod beside;
mod camera;
mod fault;
mod gltf;
mod header;
mod moving;
mod obj;
mod parts;
mod placed;
mod ply;
mod polygon;
mod positions;
mod stl;

use super::clean::{Attributes, MeshError, TriangleMesh};
pub use camera::MeshCamera;
use fault::{Fault, fault, shown};
pub use header::{ArrayError, floats, open_array, shape_and_type};
pub use moving::MovingMesh;
use parts::Parts;
pub use placed::{MeshPlace, PlacedMeshes, read_placed, read_placed_bytes};
pub use positions::{PositionFrames, read_positions};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// Kinds of mesh files.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum MeshFormat {
    /// Wavefront OBJ.
    Obj,
    /// Stanford PLY, ASCII or binary.
    Ply,
    /// glTF 2.0, JSON.
    Gltf,
    /// glTF 2.0, binary.
    Glb,
    /// STL, ASCII or binary.
    Stl,
}

/// The endings of the names of mesh files, for messages.
pub const MESH_ENDINGS: &str = ".obj, .ply, .gltf, .glb or .stl";

impl MeshFormat {
    /// All kinds.
    pub const ALL: [Self; 5] = [Self::Obj, Self::Ply, Self::Gltf, Self::Glb, Self::Stl];

    /// Its name, which is the ending of its files' names.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Obj => "obj",
            Self::Ply => "ply",
            Self::Gltf => "gltf",
            Self::Glb => "glb",
            Self::Stl => "stl",
        }
    }

    /// By the ending of the file's name, in upper or lower case.
    pub fn of(path: &Path) -> Option<MeshFormat> {
        let ending = path.extension()?.to_string_lossy().to_lowercase();
        Self::ALL.into_iter().find(|format| format.name() == ending)
    }
}

/// Why a mesh file was not read. Every message begins with the file's name.
#[derive(Debug, thiserror::Error)]
pub enum ReadError {
    /// The file could not be opened or read.
    #[error("{}: {source}", path.display())]
    Io {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The name does not end like that of a mesh file.
    #[error("{}: unknown kind of mesh file, the name must end in {MESH_ENDINGS}", path.display())]
    Extension {
        /// The file.
        path: PathBuf,
    },
    /// It is of a kind that places no meshes.
    #[error("{}: only .gltf and .glb place meshes", path.display())]
    NotPlaced {
        /// The file.
        path: PathBuf,
    },
    /// What the file holds is not a mesh.
    #[error("{}: {place}: {what}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// Line, element or field.
        place: String,
        /// What is wrong there.
        what: String,
    },
    /// The vertices and triangles of the file do not make a mesh.
    #[error("{}: {source}", path.display())]
    Mesh {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: MeshError,
    },
}

/// The files beside a mesh file that are read with it, as far as they are there: material libraries of OBJ, buffers of glTF. None of a file
/// that is no mesh, or a damaged one: to read it says what is wrong with it.
pub fn named_files(path: &Path) -> Vec<PathBuf> {
    let named = match MeshFormat::of(path) {
        Some(MeshFormat::Obj) => obj::libraries,
        Some(MeshFormat::Gltf | MeshFormat::Glb) => gltf::files,
        _ => return Vec::new(),
    };
    let names = std::fs::read(path).map_or_else(|_| Vec::new(), |bytes| named(&bytes));
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut files: Vec<PathBuf> = names.into_iter().map(|name| beside::place(folder, &name)).filter(|file| file.is_file()).collect();
    files.sort();
    files.dedup();
    files
}

/// Reads and cleans a triangle mesh from a file, in the file's own units; its ending says which format it has: see [`MeshFormat`].
///
/// OBJ: polygons are cut into triangles; diffuse colours are taken from the material library if it can be read. PLY: faces or triangle
/// strips. glTF: all triangles of the default scene, as its nodes place them; morph targets with their default weights, meshes with skins in
/// their rest pose; base colour factors. STL: vertices at the same place become one. Normals at corners are kept where the format has them (not STL: its normals
/// are those of the flat facets), and so are texture coordinates (the first set of glTF; at vertices of PLY); textures and vertex colours are not. Triangles that run the other way around than most of those around them are turned.
/// What is lost, and what was turned, is in [`TriangleMesh::warnings`]. Devices are refused, pipes are taken; files that the mesh names must be
/// regular files.
///
/// # Errors
/// One error that names the file and the line, element or field: see [`ReadError`].
pub fn read(path: &Path) -> Result<TriangleMesh, ReadError> {
    // Whatever a folder is called: its name is not what is wrong with it.
    let format = MeshFormat::of(path).or(path.is_dir().then_some(MeshFormat::Obj));
    read_as(path, format.ok_or_else(|| ReadError::Extension { path: path.into() })?)
}

/// The same for a file of a known format, whatever its name.
///
/// # Errors
/// As for [`read`].
pub fn read_as(path: &Path, format: MeshFormat) -> Result<TriangleMesh, ReadError> {
    read_bytes(&bytes_of(path)?, format, path, path.parent().unwrap_or(Path::new("")))
}

/// What a file holds that has an end.
fn bytes_of(path: &Path) -> Result<Vec<u8>, ReadError> {
    let io = |source| ReadError::Io { path: path.into(), source };
    if path.is_dir() {
        return Err(io(std::io::ErrorKind::IsADirectory.into()));
    }
    if is_device(path) { Err(std::io::Error::other("it is a device, not a file")) } else { std::fs::read(path) }.map_err(io)
}

/// The same for the bytes of a file. `name` is what errors begin with; material libraries and buffers that the file names are looked for in
/// `folder`.
///
/// # Errors
/// As for [`read`].
pub fn read_bytes(bytes: &[u8], format: MeshFormat, name: &Path, folder: &Path) -> Result<TriangleMesh, ReadError> {
    let content = |Fault { place, what }| ReadError::Content { path: name.into(), place, what };
    if bytes.is_empty() {
        return Err(content(Fault { place: "line 1".into(), what: "the file is empty".into() }));
    }
    let parse = match format {
        MeshFormat::Obj => obj::parse,
        MeshFormat::Ply => ply::parse,
        MeshFormat::Gltf => gltf::parse,
        MeshFormat::Glb => gltf::parse_binary,
        MeshFormat::Stl => stl::parse,
    };
    let parts = parse(bytes, folder).map_err(content)?;
    let attributes = Attributes { normals: &parts.normals, texture: &parts.texture, polygons: &parts.polygons };
    let mut mesh = TriangleMesh::with_attributes(&parts.positions, &parts.triangles, attributes, &parts.materials, parts.colours)
        .map_err(|source| ReadError::Mesh { path: name.into(), source })?;
    mesh.warnings = parts.warnings;
    mesh.warnings.extend(mesh.report.flat().into_iter().chain(mesh.report.repeated()));
    mesh.orient();
    Ok(mesh)
}

/// True for what may have no end.
fn is_device(path: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        std::fs::metadata(path).is_ok_and(|about| about.file_type().is_char_device() || about.file_type().is_block_device())
    }
    #[cfg(not(unix))]
    {
        _ = path;
        false
    }
}
