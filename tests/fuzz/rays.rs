//! Files of rays; what is read is cast.

use super::damage::File;
use super::round::{Limit, folder, round};
use lodray::format::Scene;
use lodray::rays::RayFile;
use lodray_test_support::models::{scene_of, terrain};
use npyz::WriterBuilder;
use std::fs;

/// An array of NumPy's.
pub fn array<T: npyz::AutoSerialize + Clone>(shape: &[u64], order: npyz::Order, values: &[T]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut writer = npyz::WriteOptions::new().default_dtype().order(order).shape(shape).writer(&mut bytes).begin_nd().unwrap();
    writer.extend(values.to_vec()).unwrap();
    writer.finish().unwrap();
    bytes
}

/// Good arrays of all widths.
fn corpus() -> Vec<File> {
    let row = |k: f64| [k * 0.1, 2.0, 0.3, 0.0, -1.0, 0.1 * k, 0.01, 0.001, 0.0, f64::INFINITY, 0.0, -1.0];
    let rows = |columns: usize| (0..5).flat_map(|k| row(f64::from(k))[..columns].to_vec()).collect::<Vec<_>>();
    let mut following = rows(12);
    following[23] = 0.0;
    // Column by column.
    let narrow: Vec<f32> = (0..8).flat_map(|column| rows(8).into_iter().skip(column).step_by(8)).map(|v| v as f32).collect();
    let mut files: Vec<File> =
        [6, 8, 10, 11, 12].map(|columns| File::new("wide", array(&[5, columns as u64], npyz::Order::C, &rows(columns)))).to_vec();
    files.push(File::new("following", array(&[5, 12], npyz::Order::C, &following)));
    files.push(File::new("narrow", array(&[5, 8], npyz::Order::Fortran, &narrow)));
    files
}

#[test]
fn rays() {
    let scene: Scene = scene_of(&terrain(2, 2, 0.6, 5));
    let methods = ["lod", "bvh"].map(|name| scene.method(name).unwrap());
    let path = folder().join("rays.npy");
    round("rays", corpus, Limit { bytes: 2 << 20, each: 600 }, |bytes| {
        fs::write(&path, bytes).unwrap();
        match RayFile::read(&path) {
            Ok(rays) => {
                assert!(methods.iter().all(|method| method.cast(&rays).len() == rays.queries().len()));
                true
            }
            Err(error) => {
                let message = error.to_string();
                assert!(message.starts_with(&path.display().to_string()) && message.len() < 1000, "{message:?}");
                false
            }
        }
    });
}
