//! Meshes that move: the animations of glTF.

use super::gltf::{MovingParts, parse_moving};
use super::{Fault, MeshFormat, ReadError, bytes_of};
use std::path::Path;

/// The mesh of a glTF or GLB file with its animations: nodes, joints (skins) and weights of morph targets move it.
///
/// Vertices and triangles are those of the whole scene, in the file's order; nothing is welded and nothing left out.
#[derive(Clone, Debug)]
pub struct MovingMesh(MovingParts);

impl MovingMesh {
    /// Reads a file with at least one animation.
    ///
    /// # Errors
    /// One error that names the file and the element: see [`ReadError`].
    pub fn read(path: &Path) -> Result<Self, ReadError> {
        if !matches!(MeshFormat::of(path), Some(MeshFormat::Gltf | MeshFormat::Glb)) {
            return Err(ReadError::Content {
                path: path.into(),
                place: "name".into(),
                what: "animations are read from .gltf or .glb".into(),
            });
        }
        Self::from_bytes(&bytes_of(path)?, path, path.parent().unwrap_or(Path::new("")))
    }

    /// The same for the bytes of a file. `name` is what errors begin with; buffers that the file names are looked for in `folder`.
    ///
    /// # Errors
    /// As for [`Self::read`].
    pub fn from_bytes(bytes: &[u8], name: &Path, folder: &Path) -> Result<Self, ReadError> {
        let content = |Fault { place, what }| ReadError::Content { path: name.into(), place, what };
        let parts = parse_moving(bytes, folder).map_err(content)?;
        if parts.clips.is_empty() {
            return Err(content(Fault { place: "animations".into(), what: "it has none".into() }));
        }
        Ok(Self(parts))
    }

    /// Where the vertices are at rest: as a scene is built from the file.
    pub fn rest(&self) -> &[[f64; 3]] {
        &self.0.rest
    }

    /// Vertices of each triangle.
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.0.triangles
    }

    /// Names of the animations and their durations in seconds; one without a name has its number, from 0.
    pub fn clips(&self) -> impl Iterator<Item = (&str, f64)> {
        self.0.clips.iter().map(|clip| (clip.name.as_str(), clip.duration))
    }

    /// Where the vertices are at a time of an animation, in seconds; before its first key as at that, behind its last likewise.
    ///
    /// # Panics
    /// There is no animation of this number.
    pub fn at(&self, clip: usize, time: f64) -> Vec<[f64; 3]> {
        self.0.at(&self.0.clips[clip], time)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use base64::Engine;
    use base64::engine::general_purpose::STANDARD;
    use serde_json::{Value, json};

    /// A file's buffer, and accessors to it.
    #[derive(Default)]
    struct Data {
        bytes: Vec<u8>,
        views: Vec<Value>,
        accessors: Vec<Value>,
    }

    impl Data {
        fn add(&mut self, bytes: &[u8], kind: &str, component: u32, count: usize) -> usize {
            self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
            self.bytes.extend(bytes);
            self.accessors.push(json!({ "bufferView": self.views.len() - 1, "componentType": component, "count": count, "type": kind }));
            self.accessors.len() - 1
        }

        fn floats(&mut self, kind: &str, width: usize, values: &[f32]) -> usize {
            let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()).collect();
            self.add(&bytes, kind, 5126, values.len() / width)
        }
    }

    /// A triangle on two joints, one of which turns and both of which jump; and one whose corner rises by a morph target, on a node of twice its size.
    fn file(change: impl FnOnce(&mut Value)) -> Vec<u8> {
        let mut data = Data::default();
        let arm = data.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 2.0, 0.0]);
        let joints = data.add(&[0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0], "VEC4", 5121, 3);
        let weights = data.floats("VEC4", 4, &[1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]);
        let one = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let bind: Vec<f32> = [one.as_slice(), &[0.0, 0.0, 0.0, 1.0], &one, &[0.0, -1.0, 0.0, 1.0]].concat();
        let bind = data.floats("MAT4", 16, &bind);
        let two = data.floats("SCALAR", 1, &[0.0, 2.0]);
        let quarter = std::f32::consts::FRAC_1_SQRT_2;
        let turns = data.floats("VEC4", 4, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, quarter, quarter]);
        let late = data.floats("SCALAR", 1, &[0.0, 1.5]);
        let jumps = data.floats("VEC3", 3, &[0.0, 0.0, 0.0, 0.0, 0.0, 5.0]);
        let face = data.floats("VEC3", 3, &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let rise = data.floats("VEC3", 3, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        let unit = data.floats("SCALAR", 1, &[0.0, 1.0]);
        // Slope in, value and slope out of each key.
        let spline = data.floats("SCALAR", 1, &[0.0, 0.0, 0.0, 0.0, 1.0, 0.0]);
        let Data { bytes, views, accessors } = data;
        let mut root = json!({
            "asset": { "version": "2.0" },
            "buffers": [{ "byteLength": bytes.len(), "uri": format!("data:application/octet-stream;base64,{}", STANDARD.encode(&bytes)) }],
            "bufferViews": views, "accessors": accessors,
            "meshes": [
                { "primitives": [{ "attributes": { "POSITION": arm, "JOINTS_0": joints, "WEIGHTS_0": weights } }] },
                { "primitives": [{ "attributes": { "POSITION": face }, "targets": [{ "POSITION": rise }] }] },
            ],
            "skins": [{ "joints": [1, 2], "inverseBindMatrices": bind }],
            "nodes": [
                { "mesh": 0, "skin": 0, "translation": [9.0, 9.0, 9.0] },
                { "children": [2] },
                { "translation": [0.0, 1.0, 0.0] },
                { "children": [4], "scale": [2.0, 2.0, 2.0] },
                { "mesh": 1 },
            ],
            "scenes": [{ "nodes": [0, 1, 3] }], "scene": 0,
            "animations": [
                {
                    "name": "wave",
                    "samplers": [
                        { "input": two, "output": turns },
                        { "input": late, "output": jumps, "interpolation": "STEP" },
                    ],
                    "channels": [
                        { "sampler": 0, "target": { "node": 2, "path": "rotation" } },
                        { "sampler": 1, "target": { "node": 1, "path": "translation" } },
                    ],
                },
                {
                    "samplers": [{ "input": unit, "output": spline, "interpolation": "CUBICSPLINE" }],
                    "channels": [{ "sampler": 0, "target": { "node": 4, "path": "weights" } }],
                },
            ],
        });
        change(&mut root);
        root.to_string().into_bytes()
    }

    /// The file with the second mesh one of 65,535 vertices that all stand at the origin and take no bytes, and with these morph targets; the first animation alone.
    fn large(targets: Vec<Value>) -> Vec<u8> {
        file(|root| {
            let sparse = json!({ "count": 1, "indices": { "bufferView": 1, "componentType": 5121 }, "values": { "bufferView": 0 } });
            root["accessors"][8] = json!({ "componentType": 5126, "type": "VEC3", "count": 65_535, "sparse": sparse });
            root["meshes"][1]["primitives"][0]["targets"] = Value::Array(targets);
            root["animations"].as_array_mut().unwrap().truncate(1);
        })
    }

    fn read(bytes: &[u8]) -> Result<MovingMesh, ReadError> {
        MovingMesh::from_bytes(bytes, Path::new("m.gltf"), Path::new(""))
    }

    fn near(a: &[[f64; 3]], b: &[[f64; 3]]) {
        let far = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(a.len() == b.len() && far < 1e-6, "{a:?}, {b:?}");
    }

    #[test]
    fn joints_targets_and_nodes_move_vertices() {
        let mesh = read(&file(|_| ())).unwrap();
        assert_eq!(mesh.clips().collect::<Vec<_>>(), [("wave", 2.0), ("1", 1.0)]);
        assert_eq!(mesh.triangles(), [[0, 1, 2], [3, 4, 5]]);
        // At rest nodes stand where they are, without joints.
        near(&mesh.rest()[..3], &[[9.0, 9.0, 9.0], [10.0, 9.0, 9.0], [9.0, 11.0, 9.0]]);
        let face = [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]];
        near(&mesh.rest()[3..], &face);
        // Joints alone say where their vertices are.
        let half = std::f64::consts::FRAC_1_SQRT_2;
        for (time, tip, z) in [
            (-1.0, [0.0, 2.0], 0.0),
            (0.0, [0.0, 2.0], 0.0),
            (1.0, [-half, 1.0 + half], 0.0),
            (1.5, [-(135f64 / 2.0).to_radians().sin(), 1.0 + (135f64 / 2.0).to_radians().cos()], 5.0),
            (2.0, [-1.0, 1.0], 5.0),
            (99.0, [-1.0, 1.0], 5.0),
        ] {
            let at = mesh.at(0, time);
            near(&at[..3], &[[0.0, 0.0, z], [1.0, 0.0, z], [tip[0], tip[1], z]]);
            near(&at[3..], &face);
        }
        // A cubic spline of slopes 0, on a node of twice the size.
        for (time, weight) in [(0.0, 0.0), (0.25, 0.15625), (0.5, 0.5), (1.0, 1.0), (7.0, 1.0)] {
            near(&mesh.at(1, time)[3..], &[[0.0, 0.0, 2.0 * weight], face[1], face[2]]);
        }
    }

    #[test]
    fn morph_targets_take_the_memory_that_they_need() {
        // Each of these would be 1.5 MB of zeros.
        let at = read(&large(vec![json!({}); 300_000])).unwrap().at(0, 1.0);
        assert!(at.len() == 65_538 && at[3..].iter().all(|p| *p == [0.0; 3]));
        let error = read(&large(vec![json!({ "POSITION": 8 }); 2_000])).unwrap_err().to_string();
        assert_eq!(error, "m.gltf: mesh 1, primitive 0: with it there are more than 268435456 numbers that move vertices");
        // Few of them are fine.
        assert_eq!(read(&large(vec![json!({ "POSITION": 8 }), json!({})])).unwrap().rest().len(), 65_538);
    }

    #[test]
    fn what_is_wrong_is_named() {
        let refused = |change: &dyn Fn(&mut Value), words: &str| {
            let error = read(&file(|root| change(root))).expect_err(words).to_string();
            assert!(error.starts_with("m.gltf: ") && error.contains(words), "{error}");
        };
        refused(&|root| root["animations"] = json!([]), "animations: it has none");
        refused(&|root| root["animations"][0]["channels"][0]["sampler"] = json!(7), "animation 0, channel 0: sampler 7 is not there");
        refused(
            &|root| root["animations"][0]["samplers"][0]["output"] = json!(0),
            "animation 0, channel 0, output: accessor 0: it is not of type VEC4",
        );
        refused(&|root| root["animations"][1]["samplers"][0]["interpolation"] = json!("LINEAR"), "2 times need 1 numbers each, it has 6");
        refused(&|root| root["skins"][0]["joints"] = json!([1]), "vertex 2: joint 1 is out of range, skin 0 has 1");
        // Joints are whole numbers: no other is cut to one.
        let joints = |which: usize| format!("JOINTS_0: accessor {which}: it must be VEC4, of 8, 16 or 32 bits without a sign");
        refused(&|root| root["accessors"][1]["componentType"] = json!(5120), &joints(1));
        refused(&|root| root["accessors"][1]["normalized"] = json!(true), &joints(1));
        refused(&|root| root["accessors"][1]["type"] = json!("SCALAR"), &joints(1));
        refused(&|root| root["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = json!(2), &joints(2));
        refused(&|root| root["skins"][0]["joints"] = json!([1, 77]), "skin 0: its joint, node 77, is not in the scene");
        refused(&|root| root["nodes"][0]["skin"] = json!(3), "skin 3: it is not there");
        refused(
            &|root| root["nodes"][2] = json!({ "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 1] }),
            "node 2 has a matrix, which cannot be animated",
        );
        assert!(MovingMesh::read(Path::new("m.obj")).unwrap_err().to_string().contains("animations are read from .gltf or .glb"));
        // An animation of what the scene does not have moves nothing.
        let apart = read(&file(|root| root["animations"][0]["channels"][0]["target"]["node"] = json!(99))).unwrap();
        assert_eq!(apart.at(0, 1.0)[2], [0.0, 2.0, 0.0]);
    }
}
