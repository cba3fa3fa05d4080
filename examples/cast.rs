//! Casts a ray at a scene file, which `lodray build` or `lodray generate` made: `cargo run --release --example cast -- bunny.lod`.

use lodray::format::Scene;
use lodray::rays::{ModelSpace, Query, RayFile};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let path = std::env::args().nth(1).ok_or("name a scene file")?;
    let scene = Scene::open(path.as_ref())?;
    let method = scene.method_with("lod", &[("delta", "1")])?;
    // From twice the bounding radius towards the centre, with the cone of a pixel.
    let space = ModelSpace::of(&scene);
    let [x, y, z] = space.centre();
    let rays = RayFile::new(vec![Query::new([x, y, z + 2.0 * space.radius()], [0.0, 0.0, -1.0]).with_cone(0.0, 0.000_35)]);
    for hit in method.cast(&rays) {
        println!("{hit:#?}");
    }
    Ok(())
}
