//! How near pictures with level of detail come to the converged one, by shading: a table in Markdown (`docs/appearance.md` has one).
//!
//! `cargo run --release --example appearance -- largest` (or `total`, the default bounds): terrains of roughness 0.45 and 0.60 and of 8.4 M triangles from 2 and 8 radii, 256x256, delta 1. Converged is the
//! full resolution with 144 samples in each pixel; figures are mean and RMSE of the cosine that headlight shading sees, in linear light, over pixels that are
//! wholly surface. `LODRAY_TERRAIN_LEVELS` makes the scenes smaller for a quick look.

use lodray::bvh::over_trees;
use lodray::format::{self, Scene, SceneInfo};
use lodray::mesh::BoundKind;
use lodray::mesh::procedural::{self, Options};
use lodray::method::bvh::NoStore;
use lodray::method::{Knobs, lod};
use lodray::picture::{Light, Sampled, Shader, Shading, sampled};
use lodray::rays::{Camera, ModelSpace, View};
use std::error::Error;

/// Columns and rows.
const SIDE: u32 = 256;
/// Sides of the grids of samples.
const CONVERGED: u32 = 12;
const GRIDS: [u32; 3] = [1, 2, 4];

fn main() -> Result<(), Box<dyn Error>> {
    let bounds = match std::env::args().nth(1).as_deref() {
        None => BoundKind::default(),
        Some(name) => *BoundKind::ALL.iter().find(|kind| kind.name() == name).ok_or("bounds are 'largest' or 'total'")?,
    };
    println!("| roughness, radii, samples | converged | {} |", header().join(" | "));
    println!("|---|---:|{}", "---:|".repeat(header().len()));
    let levels = std::env::var("LODRAY_TERRAIN_LEVELS").ok().and_then(|v| v.parse().ok());
    for roughness in [0.45, 0.60] {
        let surface = procedural::generate(&Options { levels, roughness: Some(roughness), ..Options::new(procedural::Scene::Terrain) })?;
        let scene = format::build(&surface, SceneInfo { bounds, ..SceneInfo::default() }, over_trees)?;
        for distance in [2.0, 8.0] {
            rows(&scene, &format!("{roughness}, {distance}"), distance)?;
        }
    }
    Ok(())
}

fn header() -> Vec<String> {
    let full = ["full resolution", "the same moved by half a pixel"].map(str::to_owned);
    full.into_iter().chain(Shading::ALL.map(|shading| format!("LOD, {}", shading.name()))).collect()
}

fn rows(scene: &Scene, name: &str, distance: f64) -> Result<(), Box<dyn Error>> {
    let space = ModelSpace::of(scene);
    let method = (lod::METHOD.make)(scene, &Knobs::default(), &NoStore)?;
    let camera = Camera::new(&View { distance: Some(distance), ..View::default() }, &space, SIDE, SIDE)?;
    let shot = |camera: &Camera, delta, shading| sampled(&*method, &Shader::new(scene, &space, shading), &space, camera, delta, &|| ());
    let converged = shot(&camera.with_samples(CONVERGED)?, f64::INFINITY, Shading::Full);
    for grid in GRIDS {
        let camera = camera.with_samples(grid)?;
        let mut all = vec![shot(&camera, f64::INFINITY, Shading::Full), shot(&camera.shifted([0.5; 2]), f64::INFINITY, Shading::Full)];
        all.extend(Shading::ALL.map(|shading| shot(&camera, 1.0, shading)));
        // Wholly surface in all of them.
        let whole = |at: usize| [&converged].into_iter().chain(&all).all(|picture| picture.pixels[at].coverage() >= 1.0);
        let pixels: Vec<usize> = (0..converged.pixels.len()).filter(|&at| whole(at)).collect();
        let mean = |picture: &Sampled| pixels.iter().map(|&at| cosine(&picture.pixels[at])).sum::<f64>() / pixels.len() as f64;
        let truth = mean(&converged);
        let cells = all.iter().map(|picture| {
            let off = |&at: &usize| (cosine(&picture.pixels[at]) - cosine(&converged.pixels[at])).powi(2);
            let rmse = (pixels.iter().map(off).sum::<f64>() / pixels.len() as f64).sqrt();
            format!("{:+.1} %, {rmse:.4}", 100.0 * (mean(picture) / truth - 1.0))
        });
        println!("| {name}, {} | {truth:.3} | {} |", grid * grid, cells.collect::<Vec<_>>().join(" | "));
    }
    Ok(())
}

/// The cosine that gives this light on the grey of a scene without materials.
fn cosine(light: &Light) -> f64 {
    (f64::from(light.mean().y) / 0.8 - 0.06) / 0.94
}
