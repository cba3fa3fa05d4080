//! Damaged and random files: a mesh, or one line that says why not; never a panic.

use super::{glb, obj, ply, stl};
use lodray::mesh::{MeshFormat, read_bytes};
use proptest::prelude::*;
use proptest::sample::Index;
use serde_json::{Value, json};
use std::path::Path;

/// Good files to damage.
fn originals() -> Vec<(MeshFormat, Vec<u8>)> {
    let square = glb::square();
    vec![
        (MeshFormat::Obj, format!("mtllib a.mtl\nvt 0 1\nvn 0 0 1\n{}usemtl x\nf 1/1/1 2//1 -1/-1 -2\n", obj::TETRAHEDRON).into_bytes()),
        (MeshFormat::Ply, ply::ascii(ply::FACES, &format!("{}3 0 1 2\n4 0 2 3 1\n", ply::CORNERS)).into_bytes()),
        (MeshFormat::Ply, ply::binary(true)),
        (MeshFormat::Stl, stl::ASCII.into()),
        (MeshFormat::Stl, stl::binary("solid", &stl::TRIANGLES)),
        (MeshFormat::Gltf, square.embedded().into_bytes()),
        (MeshFormat::Glb, square.bytes()),
    ]
}

/// True for a mesh.
fn is_read_or_refused(bytes: &[u8], format: MeshFormat) -> bool {
    match read_bytes(bytes, format, Path::new("damaged"), Path::new("no such folder")) {
        Ok(mesh) => {
            assert!(!mesh.triangles.is_empty());
            assert!(mesh.normals.is_empty() || mesh.normals.len() == mesh.triangles.len());
            assert!(mesh.materials.is_empty() || mesh.materials.len() == mesh.triangles.len());
            true
        }
        Err(error) => {
            let message = error.to_string();
            assert!(message.starts_with("damaged: ") && !message.contains(char::is_control) && message.len() < 400, "{message:?}");
            false
        }
    }
}

#[test]
fn the_originals_are_good() {
    for (format, bytes) in originals() {
        assert!(is_read_or_refused(&bytes, format), "{format:?}");
    }
}

/// What is done to a byte.
fn edit() -> impl Strategy<Value = (Index, u8, u8)> {
    let typed = proptest::sample::select(b"0123456789-./ \nvfe\"[],{}".to_vec());
    (any::<Index>(), 0..4u8, prop_oneof![any::<u8>(), typed])
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(3000) })]

    #[test]
    fn damaged_files_never_panic(which in any::<Index>(), edits in prop::collection::vec(edit(), 1..6)) {
        let originals = originals();
        let (format, mut bytes) = which.get(&originals).clone();
        for (at, what, byte) in edits {
            let at = at.index(bytes.len());
            match what {
                0 => _ = bytes.remove(at),
                1 => bytes.insert(at, byte),
                2 => bytes[at] = byte,
                _ => bytes[at] ^= 1 << (byte % 8),
            }
        }
        is_read_or_refused(&bytes, format);
    }

    #[test]
    fn random_files_never_panic(format in 0..5usize, head in 0..8usize, tail in prop::collection::vec(any::<u8>(), 0..400)) {
        let head: &[u8] = [&b""[..], b"ply\nformat binary_little_endian 1.0\n", b"solid \n", b"glTF", b"v ", b"{\"asset\":{\"version\":\"2.0\"},", b"f 1 2 3\n", b"\xef\xbb\xbf"][head];
        let format = [MeshFormat::Obj, MeshFormat::Ply, MeshFormat::Stl, MeshFormat::Gltf, MeshFormat::Glb][format];
        is_read_or_refused(&[head, &tail].concat(), format);
    }

    /// Another value at any place of a glTF file's JSON.
    #[test]
    fn wrong_values_in_json_never_panic(edits in prop::collection::vec((any::<Index>(), value()), 1..4)) {
        let mut glb = glb::square();
        for (at, value) in edits {
            let mut places = Vec::new();
            leaves(&mut glb.json, &mut places);
            *places.swap_remove(at.index(places.len())) = value;
        }
        is_read_or_refused(&glb.bytes(), MeshFormat::Glb);
    }
}

fn value() -> impl Strategy<Value = Value> {
    prop_oneof![
        (0..8u64).prop_map(|v| json!(v)),
        any::<u64>().prop_map(|v| json!(v)),
        any::<i64>().prop_map(|v| json!(v)),
        any::<f64>().prop_map(|v| json!(v)),
        proptest::sample::select(vec![
            json!(5120),
            json!(5126),
            json!("VEC2"),
            json!(""),
            Value::Null,
            json!([0]),
            json!([0, 0]),
            json!({}),
            json!(u64::MAX)
        ]),
    ]
}

/// Every number, string and null.
fn leaves<'a>(value: &'a mut Value, found: &mut Vec<&'a mut Value>) {
    match value {
        Value::Array(items) => items.iter_mut().for_each(|v| leaves(v, found)),
        Value::Object(fields) => fields.values_mut().for_each(|v| leaves(v, found)),
        leaf => found.push(leaf),
    }
}

#[test]
fn some_damage_is_harmless_and_most_is_not() {
    let (mut good, mut bad) = (0, 0);
    for (format, original) in originals() {
        for at in 0..original.len() {
            let mut bytes = original.clone();
            bytes[at] ^= 4;
            *(if is_read_or_refused(&bytes, format) { &mut good } else { &mut bad }) += 1;
        }
    }
    assert!(good > 100 && bad > 100, "{good} {bad}");
}
