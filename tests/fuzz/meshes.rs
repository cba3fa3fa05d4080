//! Mesh files: OBJ with its material library, PLY, STL, glTF and GLB; what is read becomes a scene.

use super::damage::File;
use super::round::{Limit, round};
use base64::Engine;
use lodray::format::Scene;
use lodray::mesh::{HeightMap, MeshFormat, MovingMesh, read_bytes, read_placed_bytes};
use lodray::scene::BuildOptions;
use serde_json::{Value, json};
use std::path::Path;

/// The corpus' folder, where the material library is.
const CORPUS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fuzz/corpus");

/// Meshes of more triangles are read, but not built.
const BUILT: usize = 20_000;

fn reads(bytes: &[u8], format: MeshFormat) -> bool {
    match read_bytes(bytes, format, Path::new("damaged"), &Path::new(CORPUS).join(format.name())) {
        Ok(mesh) => {
            assert!(!mesh.triangles.is_empty() && mesh.triangles.iter().flatten().all(|&v| (v as usize) < mesh.positions.len()));
            assert!(mesh.positions.iter().flatten().all(|c| c.is_finite()));
            if mesh.triangles.len() <= BUILT {
                // Its triangles may be too thin for the grid: that is an error.
                let made = Scene::of_mesh(&mesh, &BuildOptions::own_triangles(), &|_, _, _| ());
                made.map_or_else(|why| assert!(!why.to_string().is_empty()), |scene| assert!(scene.trees() <= mesh.triangles.len()));
            }
            true
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("damaged: ") && !message.contains(char::is_control) && message.len() < 500, "{message:?}");
            false
        }
    }
}

/// A scene of nodes too, whose meshes are those of the whole, and its animations.
fn reads_places(bytes: &[u8], format: MeshFormat) -> bool {
    let is_mesh = reads(bytes, format);
    match read_placed_bytes(bytes, Path::new("damaged"), &Path::new(CORPUS).join(format.name())) {
        Ok(placed) => {
            assert!(!placed.places.is_empty() && placed.places.iter().all(|place| place.mesh < placed.meshes.len()));
            assert!(placed.meshes.iter().all(|(_, mesh)| !mesh.triangles.is_empty()));
        }
        Err(error) => assert!(error.to_string().starts_with("damaged: ") && error.to_string().len() < 600, "{error}"),
    }
    match MovingMesh::from_bytes(bytes, Path::new("damaged"), &Path::new(CORPUS).join(format.name())) {
        Ok(mesh) => {
            for (clip, time) in (0..mesh.clips().count().min(4)).flat_map(|clip| [-1.0, 0.3, 1.7, 1e9].map(|time| (clip, time))) {
                assert_eq!(mesh.at(clip, time).len(), mesh.rest().len());
            }
        }
        Err(error) => assert!(error.to_string().starts_with("damaged: ") && error.to_string().len() < 600, "{error}"),
    }
    is_mesh
}

fn fuzzed(format: MeshFormat, corpus: impl FnOnce() -> Vec<File>) {
    // A scene of own triangles takes some hundred bytes each, and a line of text has few bytes for each.
    let limit = Limit { bytes: 1 << 20, each: 1000 };
    let has_nodes = matches!(format, MeshFormat::Gltf | MeshFormat::Glb);
    round(format.name(), corpus, limit, |bytes| if has_nodes { reads_places(bytes, format) } else { reads(bytes, format) });
}

#[test]
fn obj() {
    fuzzed(MeshFormat::Obj, || File::all("obj", "obj"));
}

#[test]
fn ply() {
    let texts = File::all("ply", "ply");
    let binary = [false, true].map(|big| File::new("binary", binary_ply(big)));
    fuzzed(MeshFormat::Ply, || [texts, binary.to_vec()].concat());
}

#[test]
fn stl() {
    let texts = File::all("stl", "stl");
    let mut binary = b"solid but binary".to_vec();
    binary.resize(80, b' ');
    binary.extend(4u32.to_le_bytes());
    for [a, b, c] in [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
        binary.extend([0; 12]);
        binary.extend([a, b, c].iter().flat_map(|&v: &usize| CORNERS[v]).flat_map(f32::to_le_bytes));
        binary.extend([0; 2]);
    }
    fuzzed(MeshFormat::Stl, || [texts, vec![File::new("binary", binary)]].concat());
}

#[test]
fn gltf() {
    let (json, bin) = gltf_parts();
    let mut inside = json.clone();
    let data = base64::prelude::BASE64_STANDARD.encode(&bin);
    inside["buffers"][0]["uri"] = json!(format!("data:application/octet-stream;base64,{data}"));
    let more = File::all("gltf", "gltf");
    fuzzed(MeshFormat::Gltf, || [more, vec![File::new("embedded", serde_json::to_vec_pretty(&inside).unwrap())]].concat());
}

#[test]
fn glb() {
    let (json, bin) = gltf_parts();
    fuzzed(MeshFormat::Glb, || vec![File::new("binary", glb_bytes(&json, &bin))]);
}

/// Displacement maps: 8 and 16 bits of grey, and floats.
#[test]
fn maps() {
    let corpus = || {
        let png = |picture: image::DynamicImage| {
            let mut bytes = std::io::Cursor::new(Vec::new());
            picture.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
            bytes.into_inner()
        };
        let grey = image::DynamicImage::ImageLuma8(image::ImageBuffer::from_fn(9, 7, |x, y| image::Luma([(x * 20 + y) as u8])));
        let fine = image::DynamicImage::ImageLuma16(image::ImageBuffer::from_fn(9, 7, |x, y| image::Luma([(x * 7000 + y) as u16])));
        let mut floats = std::io::Cursor::new(Vec::new());
        let channels = exr::prelude::SpecificChannels::rgb(|at: exr::math::Vec2<usize>| (at.x() as f32, at.y() as f32, 0.5f32));
        exr::prelude::WritableImage::write(&exr::prelude::Image::from_channels((9, 7), channels)).to_buffered(&mut floats).unwrap();
        vec![File::new("grey", png(grey)), File::new("fine", png(fine)), File::new("floats", floats.into_inner())]
    };
    round("map", corpus, Limit { bytes: 1 << 21, each: 20_000 }, |bytes| match HeightMap::of_bytes(bytes) {
        Ok(map) => {
            assert!(map.texels() > 0 && [[0.0, 0.0], [0.3, -7.9], [1e9, 1.0]].into_iter().all(|uv| map.at(uv).is_finite()));
            true
        }
        Err(error) => {
            assert!(!error.to_string().is_empty());
            false
        }
    });
}

const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.25, 0.25, 1.0]];

/// A tetrahedron, with a list besides that nobody needs.
pub fn binary_ply(big: bool) -> Vec<u8> {
    let kind = if big { "big" } else { "little" };
    let header = "element vertex 4\nproperty float x\nproperty float y\nproperty double z\nproperty list uchar short other\nelement face 4\nproperty list int uint vertex_indices\nend_header\n";
    let mut bytes = format!("ply\nformat binary_{kind}_endian 1.0\n{header}").into_bytes();
    let mut put = |le: &[u8]| if big { bytes.extend(le.iter().rev()) } else { bytes.extend(le) };
    for [x, y, z] in CORNERS {
        put(&x.to_le_bytes());
        put(&y.to_le_bytes());
        put(&f64::from(z).to_le_bytes());
        put(&[1]);
        put(&7i16.to_le_bytes());
    }
    for face in [[0u32, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]] {
        put(&3i32.to_le_bytes());
        face.iter().for_each(|v| put(&v.to_le_bytes()));
    }
    bytes
}

/// Everything of glTF that is read: nodes below nodes, normals, indices, strips, a morph target of sparse places, materials.
fn gltf_parts() -> (Value, Vec<u8>) {
    let mut bin: Vec<u8> = CORNERS.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    bin.extend([[0.0f32, 0.0, 1.0]; 4].iter().flatten().flat_map(|v| v.to_le_bytes()));
    bin.extend([0u16, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3].iter().flat_map(|v| v.to_le_bytes()));
    bin.extend([1u8, 3, 0, 0]);
    bin.extend([[0.0f32, 0.0, 0.5]; 2].iter().flatten().flat_map(|v| v.to_le_bytes()));
    let view = |from: usize, length: usize| json!({"buffer": 0, "byteOffset": from, "byteLength": length});
    let json = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [
            {"mesh": 0, "children": [1, 2], "translation": [1.0, 0.0, 0.0], "rotation": [0.0, 0.0, 0.0, 1.0], "scale": [1.0, 2.0, 1.0]},
            {"mesh": 0, "matrix": [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 3.0, 0.0, 0.0, 1.0]},
            {"mesh": 1, "weights": [0.5]},
        ],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0, "targets": [{"POSITION": 3}]}], "weights": [0.25]},
            {"primitives": [{"attributes": {"POSITION": 0}, "mode": 5}, {"attributes": {"POSITION": 0}, "mode": 6}]},
        ],
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.25, 1.0, 1.0]}}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4, "min": [0.0, 0.0, 0.0], "max": [1.0, 1.0, 1.0]},
            {"bufferView": 1, "componentType": 5126, "type": "VEC3", "count": 4},
            {"bufferView": 2, "componentType": 5123, "type": "SCALAR", "count": 12},
            {"componentType": 5126, "type": "VEC3", "count": 4, "sparse": {"count": 2,
                "indices": {"bufferView": 3, "componentType": 5121}, "values": {"bufferView": 4}}},
        ],
        "bufferViews": [view(0, 48), view(48, 48), view(96, 24), view(120, 2), view(124, 24)],
        "buffers": [{"byteLength": bin.len()}],
    });
    (json, bin)
}

fn glb_bytes(json: &Value, bin: &[u8]) -> Vec<u8> {
    let mut json = json.to_string().into_bytes();
    json.resize(json.len().next_multiple_of(4), b' ');
    let length = 12 + 8 + json.len() + 8 + bin.len();
    let word = |value: usize| (value as u32).to_le_bytes();
    let mut bytes = [&b"glTF"[..], &word(2), &word(length), &word(json.len()), b"JSON"].concat();
    bytes.extend(json);
    bytes.extend(word(bin.len()));
    bytes.extend(b"BIN\0");
    bytes.extend(bin);
    bytes
}
