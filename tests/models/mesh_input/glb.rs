//! glTF and GLB files in the making.

use super::files::Files;
use base64::Engine;
use lodray::mesh::TriangleMesh;
use serde_json::{Value, json};

pub const U8: u32 = 5121;
pub const U16: u32 = 5123;
pub const U32: u32 = 5125;
pub const F32: u32 = 5126;

/// A file in the making: its JSON and the one buffer.
#[derive(Clone)]
pub struct Glb {
    pub json: Value,
    pub bin: Vec<u8>,
}

impl Glb {
    pub fn new() -> Glb {
        let json = json!({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {}}]}], "accessors": [], "bufferViews": [], "buffers": [{"byteLength": 0}],
        });
        Glb { json, bin: Vec::new() }
    }

    /// One mesh of one primitive with 32-bit indices.
    pub fn triangles(positions: &[[f32; 3]], normals: Option<&[[f32; 3]]>, triangles: &[[u32; 3]]) -> Glb {
        let mut glb = Glb::new();
        glb.vectors("POSITION", positions);
        if let Some(normals) = normals {
            glb.vectors("NORMAL", normals);
        }
        glb.indices(U32, triangles.as_flattened());
        glb
    }

    pub fn primitive(&mut self) -> &mut Value {
        &mut self.json["meshes"][0]["primitives"][0]
    }

    pub fn vectors(&mut self, name: &str, values: &[[f32; 3]]) {
        let bytes: Vec<u8> = values.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let accessor = self.accessor(&bytes, F32, "VEC3", values.len());
        self.primitive()["attributes"][name] = json!(accessor);
    }

    pub fn indices(&mut self, kind: u32, values: &[u32]) {
        let size = [(U8, 1), (U16, 2), (U32, 4)].iter().find(|(k, _)| *k == kind).unwrap().1;
        let bytes: Vec<u8> = values.iter().flat_map(|v| v.to_le_bytes()[..size].to_vec()).collect();
        let accessor = self.accessor(&bytes, kind, "SCALAR", values.len());
        self.primitive()["indices"] = json!(accessor);
    }

    pub fn accessor(&mut self, bytes: &[u8], component: u32, kind: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let accessors = self.json["accessors"].as_array_mut().unwrap();
        accessors.push(json!({"bufferView": view, "componentType": component, "type": kind, "count": count}));
        accessors.len() - 1
    }

    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        let number = views.len();
        views.push(json!({"buffer": 0, "byteOffset": self.bin.len(), "byteLength": bytes.len()}));
        self.bin.extend(bytes);
        self.bin.resize(self.bin.len().next_multiple_of(4), 0);
        self.json["buffers"][0]["byteLength"] = json!(self.bin.len());
        number
    }

    /// As a GLB file.
    pub fn bytes(&self) -> Vec<u8> {
        let mut json = self.json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut bytes = b"glTF".to_vec();
        let length = 12 + 8 + json.len() + 8 + self.bin.len();
        bytes.extend([2, length as u32, json.len() as u32].iter().flat_map(|v| v.to_le_bytes()));
        bytes.extend(b"JSON");
        bytes.extend(json);
        bytes.extend((self.bin.len() as u32).to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(&self.bin);
        bytes
    }

    /// As JSON with the buffer at this URI.
    pub fn with_uri(&self, uri: &str) -> String {
        let mut json = self.json.clone();
        json["buffers"][0]["uri"] = json!(uri);
        json.to_string()
    }

    /// As JSON alone.
    pub fn embedded(&self) -> String {
        self.with_uri(&format!("data:application/octet-stream;base64,{}", base64::prelude::BASE64_STANDARD.encode(&self.bin)))
    }

    pub fn mesh(&self) -> TriangleMesh {
        Files::new().read("a.glb", self.bytes())
    }

    pub fn set(&self, pointer: &str, value: Value) -> Glb {
        let mut changed = self.clone();
        let (parent, key) = pointer.rsplit_once('/').unwrap();
        let parent = changed.json.pointer_mut(parent).unwrap();
        match parent {
            Value::Array(items) => items[key.parse::<usize>().unwrap()] = value,
            _ => parent[key] = value,
        }
        changed
    }

    pub fn refuses(&self, pointer: &str, value: Value, parts: &[&str]) {
        Files::new().refuses("a.glb", self.set(pointer, value).bytes(), parts);
    }
}

pub const SQUARE: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
pub const UP: [[f32; 3]; 4] = [[0.0, 0.0, 2.0]; 4];

pub fn square() -> Glb {
    Glb::triangles(&SQUARE, Some(&UP), &[[0, 1, 2], [0, 2, 3]])
}
