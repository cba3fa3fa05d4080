//! What `build` makes of meshes with thin parts, and how long it takes: a table in Markdown, best of three runs.
//!
//! `LODRAY_MESHES=FOLDER` adds the mesh files of a folder.

use lodray::mesh::{RemeshOptions, TriangleMesh, read, remesh};
use lodray_test_support::thin;
use std::path::Path;
use std::time::{Duration, Instant};

fn main() {
    println!(
        "| mesh | triangles | base | finest | to the original, mean / largest % | from the original | flips | folds, new, of the original | seconds |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for (name, mesh) in thin::shapes() {
        row(name, &mesh);
    }
    let Some(folder) = std::env::var_os("LODRAY_MESHES") else { return };
    let mut files: Vec<_> = std::fs::read_dir(folder).expect("the folder of LODRAY_MESHES").flatten().map(|entry| entry.path()).collect();
    files.sort();
    for file in files {
        let name = file.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        // What is not a mesh is passed over.
        if let Ok(mesh) = read(Path::new(&file)) {
            row(&name, &mesh);
        }
    }
}

fn row(name: &str, mesh: &TriangleMesh) {
    let options = RemeshOptions { levels: Some(5), ..RemeshOptions::default() };
    let mut best = Duration::MAX;
    let mut report = None;
    for _ in 0..3 {
        let begun = Instant::now();
        let made = remesh(mesh, &options, &|_, _, _| ()).expect("a base within the limits");
        best = best.min(begun.elapsed());
        report = Some(made.1);
    }
    let Some(r) = report else { return };
    let distance = |d: lodray::mesh::Distance| format!("{:.5} / {:.3}", d.mean, d.max);
    println!(
        "| {name} | {} | {} | {} | {} | {} | {} | {}, {}, {} | {:.2} |",
        mesh.triangles.len(),
        r.base_triangles,
        r.finest_triangles,
        distance(r.distance.to_original),
        distance(r.distance.from_original),
        r.flipped_triangles,
        r.folds.edges,
        r.folds.new,
        r.folds.original,
        best.as_secs_f64()
    );
    if let Some(warning) = r.warning {
        println!("  {warning}");
    }
}
