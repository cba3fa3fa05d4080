//! Positions for `refit`: arrays, OBJ, PLY; a scene with as many vertices goes where they say, and is audited.

use super::damage::File;
use super::meshes::binary_ply;
use super::rays::array;
use super::round::{Limit, folder, round};
use lodray::format::audit::audit;
use lodray::format::{Grid, Refit, RefitOptions, Scene, Shading};
use lodray::mesh::read_positions;
use lodray_test_support::surfaces::{octahedron, scene};
use npyz::Order;
use std::cell::RefCell;
use std::fs;

/// Frames of a sequence that a scene goes through.
const FRAMES: usize = 3;

/// The scene that moves.
fn rests() -> Scene {
    scene(&octahedron(1))
}

/// Where its vertices are.
fn places() -> Vec<[f64; 3]> {
    rests().refitting().unwrap().positions()
}

/// Reads positions, and moves the scene to each of the first frames, if they have as many as it.
fn fuzzed(ending: &str, corpus: impl FnOnce() -> Vec<File>) {
    let path = folder().join(format!("positions.{ending}"));
    let moving: RefCell<Refit> = RefCell::new(rests().refitting().unwrap());
    round(&format!("positions-{ending}"), corpus, Limit { bytes: 1 << 20, each: 300 }, |bytes| {
        fs::write(&path, bytes).unwrap();
        let read = match read_positions(&path) {
            Ok(read) => read,
            Err(error) => {
                let message = error.to_string();
                let starts = message.starts_with(&path.display().to_string());
                assert!(starts && !message.contains(char::is_control) && message.len() < 1000, "{message:?}");
                return false;
            }
        };
        let (all, each) = (read.positions.len(), read.vertices);
        assert!(if read.is_sequence { each == 0 || all.is_multiple_of(each) } else { all == each });
        let mut moving = moving.borrow_mut();
        if each == moving.vertices() {
            for (frame, positions) in read.positions.chunks(each).take(FRAMES).enumerate() {
                let options = RefitOptions { shading: Shading::ALL[frame % 2], grid: Grid::ALL[(all / each + frame) % 2] };
                match moving.move_to(positions, options) {
                    Ok(scene) => assert!(audit(scene).passed(), "{options:?}, {positions:?}"),
                    Err(error) => assert!((10..500).contains(&error.to_string().len()), "{error}"),
                }
            }
        }
        true
    });
}

#[test]
fn arrays() {
    fuzzed("npy", || {
        let at = places();
        let flat: Vec<f64> = at.as_flattened().to_vec();
        let narrow: Vec<f32> = flat.iter().map(|&c| c as f32).collect();
        let moved = flat.iter().map(|c| 3.0 - 2.0 * c);
        let frames: Vec<f64> = flat.iter().copied().chain(moved).collect();
        vec![
            File::new("wide", array(&[at.len() as u64, 3], Order::C, &flat)),
            File::new("narrow", array(&[at.len() as u64, 3], Order::C, &narrow)),
            File::new("frames", array(&[2, at.len() as u64, 3], Order::C, &frames)),
        ]
    });
}

#[test]
fn obj() {
    fuzzed("obj", || {
        let line = |[x, y, z]: &[f64; 3]| format!("v {x} {y} {z}\n");
        let text: String = places().iter().map(line).collect();
        [vec![File::new("vertices", format!("# at rest\no a\n{text}vn 0 0 1\nf 1 2 3\n"))], File::all("obj", "obj")].concat()
    });
}

#[test]
fn ply() {
    fuzzed("ply", || {
        let at = places();
        let header = |kind: &str| {
            let count = at.len();
            format!(
                "ply\nformat {kind} 1.0\nelement vertex {count}\nproperty double x\nproperty double y\nproperty double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
            )
        };
        let line = |[x, y, z]: &[f64; 3]| format!("{x} {y} {z}\n");
        let text = header("ascii") + &at.iter().map(line).collect::<String>() + "3 0 1 2\n";
        let mut little = header("binary_little_endian").into_bytes();
        little.extend(at.as_flattened().iter().flat_map(|c| c.to_le_bytes()));
        little.push(3);
        little.extend([0i32, 1, 2].iter().flat_map(|v| v.to_le_bytes()));
        let files = vec![File::new("text", text), File::new("little", little), File::new("big", binary_ply(true))];
        [files, File::all("ply", "ply")].concat()
    });
}
