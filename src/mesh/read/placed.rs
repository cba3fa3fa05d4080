//! Files that place meshes, read as meshes and places: the nodes of glTF.

use super::camera::MeshCamera;
use super::gltf::parse_placed;
use super::{Fault, MeshFormat, ReadError, shown};
use crate::mesh::clean::{Attributes, TriangleMesh};
use std::path::Path;

/// Meshes, each in its own space, and where they stand.
#[derive(Clone, Debug)]
pub struct PlacedMeshes {
    /// Name and triangles of each.
    pub meshes: Vec<(String, TriangleMesh)>,
    /// Where they stand.
    pub places: Vec<MeshPlace>,
    /// Cameras, with perspective.
    pub cameras: Vec<MeshCamera>,
    /// What of the file was lost, a line each; what of a mesh was is in its own [`TriangleMesh::warnings`].
    pub warnings: Vec<String>,
}

/// A mesh at a place.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshPlace {
    /// Which mesh, from 0.
    pub mesh: usize,
    /// Name of its node.
    pub name: String,
    /// Rows of the matrix that takes it there, the last column being where its origin goes.
    pub matrix: [[f64; 4]; 3],
}

/// Reads the meshes of a glTF or GLB file's default scene, each once, and where its nodes place them. What is read of a mesh is what [`read`](super::read) reads of it.
///
/// # Errors
/// One error that names the file and the element: see [`ReadError`].
pub fn read_placed(path: &Path) -> Result<PlacedMeshes, ReadError> {
    if !matches!(MeshFormat::of(path), Some(MeshFormat::Gltf | MeshFormat::Glb)) {
        return Err(ReadError::NotPlaced { path: path.into() });
    }
    read_placed_bytes(&super::bytes_of(path)?, path, path.parent().unwrap_or(Path::new("")))
}

/// The same for the bytes of a file. `name` is what errors begin with; buffers that the file names are looked for in `folder`.
///
/// # Errors
/// As for [`read_placed`].
pub fn read_placed_bytes(bytes: &[u8], name: &Path, folder: &Path) -> Result<PlacedMeshes, ReadError> {
    let content = |Fault { place, what }| ReadError::Content { path: name.into(), place, what };
    if bytes.is_empty() {
        return Err(content(Fault { place: "line 1".into(), what: "the file is empty".into() }));
    }
    let parts = parse_placed(bytes, folder).map_err(content)?;
    let mut meshes = Vec::new();
    for (own, parts) in parts.meshes {
        let attributes = Attributes { normals: &parts.normals, texture: &parts.texture, polygons: &parts.polygons };
        let mut mesh = TriangleMesh::with_attributes(&parts.positions, &parts.triangles, attributes, &parts.materials, parts.colours)
            .map_err(|source| ReadError::Content { path: name.into(), place: shown(&own), what: source.to_string() })?;
        mesh.warnings = parts.warnings;
        mesh.warnings.extend(mesh.report.flat().into_iter().chain(mesh.report.repeated()));
        mesh.orient();
        meshes.push((own, mesh));
    }
    let places = parts.places.into_iter().map(|(mesh, name, matrix)| MeshPlace { mesh, name, matrix }).collect();
    Ok(PlacedMeshes { meshes, places, cameras: parts.cameras, warnings: parts.warnings })
}
