//! Builds a scene from a mesh file (or a procedural one) and casts a ray at it: `cargo run --release --example cast -- [MESH]`.

use lodray::bvh::over_trees;
use lodray::format::{self, SceneInfo};
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{DEFAULT_CREASE_ANGLE, Surface, corner_normals, read};
use lodray::method::bvh::NoStore;
use lodray::method::{Knobs, lod};
use lodray::rays::{ModelSpace, Query, RayFile, Sight};
use lodray::run::cast;
use std::error::Error;
use std::path::Path;

fn main() -> Result<(), Box<dyn Error>> {
    let surface = match std::env::args().nth(1) {
        Some(path) => {
            let mesh = read(Path::new(&path))?;
            Surface::of_mesh(&mesh, &corner_normals(&mesh, DEFAULT_CREASE_ANGLE))
        }
        None => procedural::generate(&Options { levels: Some(4), ..Options::new(procedural::Scene::Sphere) })?,
    };
    let scene = format::build(&surface, SceneInfo::default(), over_trees)?;
    let method = (lod::METHOD.make)(&scene, &Knobs::default(), &NoStore)?;

    // From twice the bounding radius towards the centre, with the cone of a pixel.
    let space = ModelSpace::of(&scene);
    let (centre, radius) = (space.centre(), space.radius());
    let origin = [centre[0], centre[1], centre[2] + 2.0 * radius];
    let rays = RayFile::new(vec![Query::new(origin, [0.0, 0.0, -1.0]).with_cone(0.0, 0.000_35)]);
    let sight = Sight::new(&rays, &space, 1.0);
    for hit in cast(&*method, &scene, &rays, &sight, &|_| ()) {
        println!("{hit:#?}");
    }
    Ok(())
}
