//! `lines` counts many layouts at once: each must be what a frame through it alone gives.

use serde_json::Value;
use std::path::Path;

fn json(folder: &Path, args: &str) -> Value {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("lodray");
    let output = command.current_dir(folder).args(args.split_whitespace()).env("LODRAY_CACHE", "none").output().unwrap();
    assert!(output.status.success(), "{args}: {}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

const LAYOUTS: [&str; 4] = ["Indexed", "Packed", "Line", "Block"];

#[test]
fn every_layout_has_the_lines_of_its_own_frame() {
    let folder = tempfile::tempdir().unwrap();
    json(folder.path(), "generate terrain --levels 3 --base 128 --json -o a.lod");
    let report = json(folder.path(), "lines a.lod --distances 1.5,5 --size 45x37 --all --json");
    let rows = report["rows"].as_array().unwrap();
    assert_eq!(rows.len(), 2 + 36 + 12);
    // Without `--all`, the three of these that need least.
    let few = json(folder.path(), "lines a.lod --distances 1.5,5 --size 45x37 --json");
    let few = few["rows"].as_array().unwrap();
    assert_eq!(few.len(), 2 + 3);
    assert!(few.iter().all(|row| rows.contains(row)));
    for (method, bits) in
        [("bvh --node-boxes local", "BVH 5"), ("bvh6", "BVH6 8"), ("bvh --node-boxes codes", "BVH 16"), ("bvh32", "BVH 32")]
    {
        for (size, layouts) in [(1, &LAYOUTS[..3]), (2, &LAYOUTS[..3]), (4, &LAYOUTS), (8, &LAYOUTS[3..]), (16, &LAYOUTS[3..])] {
            for layout in layouts {
                let name = format!("{bits}-bit, {layout}, {size} a leaf");
                let row = rows.iter().find(|row| row["structure"] == name.as_str()).unwrap_or_else(|| panic!("no {name}"));
                for (k, distance) in ["1.5", "5"].iter().enumerate() {
                    let layout = layout.to_lowercase();
                    let shot = format!("--leaf-layout {layout} --leaf-size {size} --distance {distance} --size 45x37 -o out --json");
                    let frame = json(folder.path(), &format!("render a.lod --method {method} {shot}"));
                    let kinds = frame["stats"]["lines"].as_array().unwrap();
                    let distinct: u64 = kinds.iter().map(|kind| kind["distinct"].as_u64().unwrap()).sum();
                    assert_eq!(row["distinct_lines"][k], distinct, "{name} from {distance}");
                }
            }
        }
    }
}
