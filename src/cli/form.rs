//! How scenes are stored, as options.

use super::args::whole;
use super::names::named;
use lodray::mesh::BoundKind;
use lodray::num::{BOX_SHIFT, MOST_DIRECTION_ZEROS, VertexForm};
use lodray::scene::BuildOptions;

/// How a scene is stored.
#[derive(clap::Args, Clone, Copy, Default)]
pub struct FormArgs {
    /// What displacement bounds cover
    #[arg(long, value_name = "KIND", value_parser = named::<BoundKind>(), default_value = BoundKind::default().name())]
    pub bounds: BoundKind,
    /// How inserted vertices are stored
    #[arg(long, value_name = "FORM", value_parser = named::<VertexForm>(), default_value = VertexForm::default().name())]
    pub vertices: VertexForm,
    /// Zero bits at the bottom of all coordinates, of vertices, morphed triangles and origins of rays: 0 to 16 less the splits. A hardware can leave them out
    #[arg(long, value_name = "BITS", default_value_t = 0, value_parser = whole::<u32>(0..=u64::from(BOX_SHIFT)), allow_negative_numbers = true)]
    pub coordinate_zeros: u32,
    /// Zero bits at the bottom of the directions of rays, 0 to 14
    #[arg(long, value_name = "BITS", default_value_t = 0, value_parser = whole::<u32>(0..=u64::from(MOST_DIRECTION_ZEROS)), allow_negative_numbers = true)]
    pub direction_zeros: u32,
}

impl FormArgs {
    /// What a scene of its own triangles is built with.
    pub fn options(self) -> BuildOptions {
        let Self { bounds, vertices, coordinate_zeros, direction_zeros } = self;
        BuildOptions { bounds, vertices, coordinate_zeros, direction_zeros, ..BuildOptions::own_triangles() }
    }
}
