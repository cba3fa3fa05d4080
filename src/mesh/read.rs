//! Mesh files in: OBJ and PLY, checked so that a bad file gives one error that names the place.

mod obj;
mod ply;
mod polygon;

use super::clean::{MeshError, TriangleMesh};
use std::fmt::Display;
use std::path::{Path, PathBuf};

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
    /// The name does not end in `.obj` or `.ply`.
    #[error("{}: unknown kind of mesh file, the name must end in .obj or .ply", path.display())]
    Extension {
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

/// What a file's parser hands to cleaning.
#[derive(Default)]
struct Parts {
    positions: Vec<[f64; 3]>,
    triangles: Vec<[u32; 3]>,
    materials: Vec<u16>,
    colours: Vec<[f32; 3]>,
}

/// What is wrong and where, before the file's name is put in front.
#[derive(Debug)]
struct Fault {
    place: String,
    what: String,
}

fn fault<T>(place: impl Display, what: impl Display) -> Result<T, Fault> {
    Err(Fault { place: place.to_string(), what: what.to_string() })
}

/// Reads and cleans a triangle mesh from an `.obj` or `.ply` file, in the file's own units.
///
/// OBJ: polygons are cut into triangles; diffuse colours are taken from the material library if it can be read. PLY: ASCII or binary,
/// faces or triangle strips.
///
/// # Errors
/// One error that names the file and the line, element or field: see [`ReadError`].
pub fn read(path: &Path) -> Result<TriangleMesh, ReadError> {
    if path.is_dir() {
        // Whatever it is called: its name is not what is wrong with it.
        return Err(ReadError::Io { path: path.into(), source: std::io::ErrorKind::IsADirectory.into() });
    }
    let extension = path.extension().map(|e| e.to_string_lossy().to_lowercase());
    let parse = match extension.as_deref() {
        Some("obj") => obj::parse,
        Some("ply") => ply::parse,
        _ => return Err(ReadError::Extension { path: path.into() }),
    };
    let bytes = std::fs::read(path).map_err(|source| ReadError::Io { path: path.into(), source })?;
    let content = |Fault { place, what }| ReadError::Content { path: path.into(), place, what };
    if bytes.is_empty() {
        return Err(content(Fault { place: "line 1".into(), what: "the file is empty".into() }));
    }
    let parts = parse(&bytes, path.parent().unwrap_or(Path::new(""))).map_err(content)?;
    TriangleMesh::from_parts(&parts.positions, &parts.triangles, &parts.materials, parts.colours)
        .map_err(|source| ReadError::Mesh { path: path.into(), source })
}
