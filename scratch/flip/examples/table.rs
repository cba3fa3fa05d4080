//! Figures of all pairs, and the largest difference of a pixel from the maps that make.py leaves in lod/: `cargo run --release --example table`.

fn main() {
    let mut names: Vec<String> = std::fs::read_dir("pairs")
        .unwrap()
        .filter_map(|e| e.unwrap().file_name().to_str()?.strip_suffix("_a.png").map(str::to_owned))
        .collect();
    names.sort();
    for name in names {
        let [a, b] = ["a", "b"].map(|side| image::open(format!("pairs/{name}_{side}.png")).unwrap().to_rgb8());
        let map = flip::flip(&a, &b, flip::PIXELS_PER_DEGREE);
        let at_30 = flip::FlipError::of(&flip::flip(&a, &b, 30.0)).mean;
        let off = |suffix: &str| {
            let bytes = std::fs::read(format!("lod/{name}{suffix}.f4")).unwrap();
            assert_eq!(bytes.len(), 4 * map.len());
            bytes.as_chunks::<4>().0.iter().zip(&map).map(|(v, m)| (f32::from_le_bytes(*v) - m).abs()).fold(0.0, f32::max)
        };
        let e = flip::FlipError::of(&map);
        println!(
            "{name} {}x{} {:.9} {at_30:.9} {:.9} {:.9} {:.9} {:?} pixel off reference {:.1e}, definition {:.1e}",
            a.width(),
            a.height(),
            e.mean,
            e.median,
            e.percentile_99,
            e.maximum,
            flip::structural_similarity(&a, &b),
            off(""),
            off(".definition")
        );
    }
}
