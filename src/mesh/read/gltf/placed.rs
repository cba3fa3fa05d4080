//! The meshes of a glTF scene apart from where its nodes place them.

use super::nodes::{Placed, Stands, placed, standing};
use super::{Builder, MAGIC, Reader, in_binary, root, skinned};
use crate::mesh::read::camera::MeshCamera;
use crate::mesh::read::{Fault, Parts, fault};
use ::gltf::json::Root;
use glam::{DMat4, DVec3};
use std::collections::HashMap;
use std::path::Path;

/// Most places of meshes.
const MOST_PLACES: usize = 1 << 20;

/// Meshes, places and cameras of a file.
pub(in crate::mesh::read) struct PlacedParts {
    /// Name and contents of each mesh, in its own space.
    pub meshes: Vec<(String, Parts)>,
    /// The mesh of each place, the name of its node, and rows of what takes the mesh there.
    pub places: Vec<(usize, String, [[f64; 4]; 3])>,
    /// Cameras with perspective.
    pub cameras: Vec<MeshCamera>,
    /// What is not kept, a line each.
    pub warnings: Vec<String>,
}

/// What a file of either form has.
pub(in crate::mesh::read) fn parse_placed(bytes: &[u8], folder: &Path) -> Result<PlacedParts, Fault> {
    if bytes.starts_with(MAGIC) { in_binary(bytes, |json, bin| build(json, bin, folder)) } else { build(bytes, None, folder) }
}

fn build(json: &[u8], bin: Option<&[u8]>, folder: &Path) -> Result<PlacedParts, Fault> {
    let root = root(json)?;
    let reader = Reader::new(&root, bin, folder);
    meshes_and_places(&mut Builder::new(&root, &reader))
}

/// The same with a builder that has built nothing yet.
fn meshes_and_places(builder: &mut Builder) -> Result<PlacedParts, Fault> {
    let root = builder.root;
    let found = placed(root)?;
    if found.len() > MOST_PLACES {
        return fault("nodes", format_args!("{} with meshes are more than {MOST_PLACES}", found.len()));
    }
    let mut all = PlacedParts { meshes: Vec::new(), places: Vec::new(), cameras: cameras(root)?, warnings: Vec::new() };
    all.warnings.extend(skinned(found.iter().filter(|placed| placed.has_skin).count()));
    // A mesh with other weights of its morph targets is another one.
    let mut known: HashMap<(usize, Option<Vec<u32>>), Option<usize>> = HashMap::new();
    for placed in found {
        let key = (placed.mesh, placed.weights.as_ref().map(|weights| weights.iter().map(|w| w.to_bits()).collect()));
        let (node, transform) = (placed.node, placed.transform);
        let own = match known.get(&key) {
            Some(own) => *own,
            None => {
                let own = mesh(builder, placed, &mut all)?;
                *known.entry(key).or_insert(own)
            }
        };
        let Some(mesh) = own else { continue };
        let name = root.nodes[node].name.clone().unwrap_or_else(|| format!("node {node}"));
        let [x, y, z, w] = transform.to_cols_array_2d();
        all.places.push((mesh, name, [0, 1, 2].map(|row: usize| [x[row], y[row], z[row], w[row]])));
    }
    if all.places.is_empty() {
        return fault("scene", "there are no triangles in it");
    }
    Ok(all)
}

/// The number of a mesh that is met for the first time, none if it has no triangles.
fn mesh(builder: &mut Builder, placed: Placed, all: &mut PlacedParts) -> Result<Option<usize>, Fault> {
    let number = placed.mesh;
    builder.mesh(&Placed { transform: DMat4::IDENTITY, ..placed })?;
    let parts = builder.finish();
    builder.take([0, 0, parts.colours.len()], &format!("mesh {number}"))?;
    let name = builder.root.meshes[number].name.clone().unwrap_or_else(|| format!("mesh {number}"));
    if parts.triangles.is_empty() {
        all.warnings.push(format!("mesh {number} has no triangles, and is left out"));
        return Ok(None);
    }
    all.meshes.push((name, parts));
    Ok(Some(all.meshes.len() - 1))
}

/// Cameras with perspective, where nodes place them: along -z, y upwards.
fn cameras(root: &Root) -> Result<Vec<MeshCamera>, Fault> {
    let mut cameras = Vec::new();
    for Stands { number, node, transform } in standing(root)? {
        let Some(index) = node.camera else { continue };
        let Some(camera) = root.cameras.get(index.value()) else {
            return fault(format_args!("node {number}"), format_args!("camera {} is not there", index.value()));
        };
        let Some(perspective) = &camera.perspective else { continue };
        let name = node.name.clone().or(camera.name.clone()).unwrap_or_else(|| format!("camera {number}"));
        let eye = transform.transform_point3(DVec3::ZERO);
        let [target, up] = [DVec3::NEG_Z, DVec3::Y].map(|way| transform.transform_vector3(way).normalize_or_zero());
        let fov = f64::from(perspective.yfov).to_degrees();
        cameras.push(MeshCamera { name, eye: eye.to_array(), target: (eye + target).to_array(), up: up.to_array(), fov });
    }
    Ok(cameras)
}

#[cfg(test)]
mod tests {
    use super::*;
    use base64::Engine;
    use base64::engine::general_purpose::STANDARD;
    use serde_json::json;

    #[test]
    fn meshes_of_a_file_are_counted_together() {
        let corners: Vec<u8> = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        // A triangle with other weights of its morph target at each node: three meshes.
        let file = json!({
            "asset": { "version": "2.0" },
            "buffers": [{ "byteLength": 36, "uri": format!("data:;base64,{}", STANDARD.encode(&corners)) }],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
            "accessors": [{ "bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3 }],
            "materials": [{}, {}],
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "targets": [{ "POSITION": 0 }] }] }],
            "nodes": [{ "mesh": 0 }, { "mesh": 0, "weights": [1.0] }, { "mesh": 0, "weights": [2.0] }],
            "scenes": [{ "nodes": [0, 1, 2] }],
        });
        let root = root(file.to_string().as_bytes()).unwrap();
        let reader = Reader::new(&root, None, Path::new(""));
        let meshes = |left| {
            let mut builder = Builder { left, ..Builder::new(&root, &reader) };
            meshes_and_places(&mut builder).map(|all| all.meshes.len()).map_err(|Fault { place, what }| format!("{place}: {what}"))
        };
        assert_eq!(meshes([9, 3, 9]), Ok(3));
        for left in [[8, 3, 9], [9, 2, 9], [9, 3, 8]] {
            let said = meshes(left).unwrap_err();
            assert!(said.starts_with("mesh 0") && said.contains("more than 268435456 vertices, triangles or colours"), "{said}");
        }
    }
}
