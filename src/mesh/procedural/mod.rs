//! Procedural scenes, seeded and reproducible: the same options give the same bytes on any number of threads.
//!
//! | scene | base triangles | default | what it is |
//! |---|---|---|---|
//! | `terrain` | 2 g^2 | 512, N = 7 | fractal heightfield |
//! | `cloth` | 2 g^2 | 2,048, N = 5 | flat parts, a few folds and a fine weave |
//! | `sphere` | 8 k^2 | 512, N = 5 | displaced sphere, closed |
//! | `spikes` | 8 k^2 | 128, N = 4 | sphere with needles, closed |
//! | `room` | 2 g^2 + 10 max(1, g/4)^2 | 2,688, N = 5 | a box with an open side around the cloth |
//! | `wall` | 1,456 k^2 | 36,400, N = 4 | 182 displaced spheres side by side |
//! | `street` | 512 k^2 | 4,608, N = 5 | 64 displaced spheres in two rows, near to far |
//! | `pot` | 8 (k^2 + h^2 + 2 q (q + h + k)), h = k/2 and q = k/4 rounded up | 1,088, N = 5 | hammered teapot of four closed bodies |
//! | `drape` | 2 g^2 | 2,048, N = 5 | a cloth over the pot, with folds and a fine weave |
//!
//! g and k are whole numbers from 1; of the possible counts the least at or above the wanted one is taken.

mod base;
mod cloth;
mod copies;
mod drape;
mod noise;
mod pot;
mod room;
mod sphere;
mod spikes;
mod spline;
mod street;
mod terrain;
mod wall;

pub use base::NoMemory;

use super::Surface;
use crate::num::MAX_LEVELS;
use serde::{Deserialize, Serialize};

/// Most base triangles of a scene.
pub const MAX_TREES: u64 = 1 << 27;
/// Most full-resolution triangles of a scene.
pub const MAX_TRIANGLES: u64 = 1 << 32;

/// A procedural scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Scene {
    /// Fractal heightfield.
    Terrain,
    /// Draped sheet with folds, flat parts and a fine weave.
    Cloth,
    /// Displaced sphere, closed.
    Sphere,
    /// Sphere with needles far longer than its edges, closed.
    Spikes,
    /// Box with an open side around the cloth.
    Room,
    /// 182 displaced spheres side by side.
    Wall,
    /// 64 displaced spheres in two rows, near to far.
    Street,
    /// Hammered teapot: four closed bodies that reach into each other.
    Pot,
    /// Cloth over the pot, in the same coordinates.
    Drape,
}

impl Scene {
    /// All scenes.
    pub const ALL: [Self; 9] =
        [Self::Terrain, Self::Cloth, Self::Sphere, Self::Spikes, Self::Room, Self::Wall, Self::Street, Self::Pot, Self::Drape];

    /// Its name in options and files.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Terrain => "terrain",
            Self::Cloth => "cloth",
            Self::Sphere => "sphere",
            Self::Spikes => "spikes",
            Self::Room => "room",
            Self::Wall => "wall",
            Self::Street => "street",
            Self::Pot => "pot",
            Self::Drape => "drape",
        }
    }

    /// Splits if none are asked for.
    pub const fn default_levels(self) -> u32 {
        match self {
            Self::Terrain => 7,
            Self::Cloth | Self::Sphere | Self::Room | Self::Street | Self::Pot | Self::Drape => 5,
            Self::Spikes | Self::Wall => 4,
        }
    }

    /// Base triangles if none are asked for.
    pub const fn default_base(self) -> u32 {
        match self {
            Self::Terrain | Self::Sphere => 512,
            Self::Cloth | Self::Drape => 2_048,
            Self::Spikes => 128,
            Self::Room => 2_688,
            Self::Wall => 36_400,
            Self::Street => 4_608,
            Self::Pot => 1_088,
        }
    }

    /// Roughness if none is asked for.
    pub const fn default_roughness(self) -> f64 {
        match self {
            Self::Terrain => 0.55,
            Self::Sphere | Self::Wall | Self::Street => 0.45,
            Self::Cloth | Self::Spikes | Self::Room | Self::Pot | Self::Drape => 0.5,
        }
    }

    /// Base triangles with grid size `n` (g or k of the table in the module's head), and of a room with so many quads along a wall, if they are said.
    fn trees(self, n: u32, walls: Option<u32>) -> u64 {
        let square = n as u64 * n as u64;
        match self {
            Self::Terrain | Self::Cloth | Self::Drape => 2 * square,
            Self::Sphere | Self::Spikes => 8 * square,
            Self::Wall => 8 * wall::MODELS as u64 * square,
            Self::Street => 8 * street::MODELS as u64 * square,
            Self::Pot => pot::trees(n),
            Self::Room => {
                let wall = u64::from(walls.unwrap_or(room::wall_quads(n)));
                2 * square + 10 * wall * wall
            }
        }
    }

    /// The least grid size with at least `base` base triangles.
    fn grid(self, base: u32) -> u32 {
        // All scenes have at least 2 n^2 triangles, so 2^15.5 suffices for any `base`; counts rise with n.
        let (mut low, mut high) = (1, 1 << 16);
        while low < high {
            let middle = (low + high) / 2;
            if self.trees(middle, None) >= u64::from(base) {
                high = middle;
            } else {
                low = middle + 1;
            }
        }
        low
    }
}

/// What to generate.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Options {
    /// Which scene.
    pub scene: Scene,
    /// Splits N, 0 to [`MAX_LEVELS`]; the scene's default if none.
    pub levels: Option<u32>,
    /// Wanted base triangles, 1 to [`MAX_TREES`]; the scene's default if none. The least possible count at or above is taken.
    pub base: Option<u32>,
    /// Any number; another seed gives another scene of the kind.
    pub seed: u64,
    /// Between 0 and 1, both excluded. `terrain`, `sphere`, `wall` and `street`: amplitude of an octave of noise relative to the one before. `cloth`,
    /// `room` and `drape`: height of the weave, `spikes`: length of the needles, `pot`: depth of the dimples, all relative to the default's 0.5.
    pub roughness: Option<f64>,
    /// `room` alone: quads along each wall, 1 to [`MAX_WALLS`]; a quarter of those across the cloth if none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub walls: Option<u32>,
    /// `terrain` alone: world units across, [`WIDTHS`]; 2 if none. Heights stay, so that a wider one is flatter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub width: Option<f64>,
}

/// Most quads along a wall of a room.
pub const MAX_WALLS: u32 = 1 << 10;
/// Widths of a terrain.
pub const WIDTHS: std::ops::RangeInclusive<f64> = 0.5..=1024.0;

impl Options {
    /// The scene at its default size, seed 0.
    pub const fn new(scene: Scene) -> Self {
        Self { scene, levels: None, base: None, seed: 0, roughness: None, walls: None, width: None }
    }

    /// What these options come to.
    ///
    /// # Errors
    /// A value is out of its range, or the scene would be too large.
    pub fn check(&self) -> Result<Shape, GenerateError> {
        let scene = self.scene;
        let levels = self.levels.unwrap_or(scene.default_levels());
        if levels > MAX_LEVELS {
            return Err(GenerateError::Levels(levels));
        }
        let wanted = self.base.unwrap_or(scene.default_base());
        if wanted == 0 || u64::from(wanted) > MAX_TREES {
            return Err(GenerateError::Base(wanted.into()));
        }
        let roughness = self.roughness.unwrap_or(scene.default_roughness());
        if !(roughness > 0.0 && roughness < 1.0) {
            return Err(GenerateError::Roughness(roughness));
        }
        if let Some(walls) = self.walls
            && (scene != Scene::Room || walls == 0 || walls > MAX_WALLS)
        {
            return Err(GenerateError::Walls { scene, walls });
        }
        if let Some(width) = self.width
            && (scene != Scene::Terrain || !WIDTHS.contains(&width))
        {
            return Err(GenerateError::Width { scene, width });
        }
        let n = scene.grid(wanted);
        let trees = scene.trees(n, self.walls);
        if trees > MAX_TREES {
            return Err(GenerateError::Base(trees));
        }
        if trees << (2 * levels) > MAX_TRIANGLES {
            return Err(GenerateError::Triangles { trees, levels });
        }
        Ok(Shape { n, levels, roughness, walls: self.walls.unwrap_or(room::wall_quads(n)) })
    }
}

/// A scene's numbers, defaults filled in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Shape {
    /// g or k of the module's table.
    n: u32,
    /// Splits N.
    levels: u32,
    /// Between 0 and 1.
    roughness: f64,
    /// Quads along a wall of a room.
    walls: u32,
}

/// Why a scene cannot be generated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum GenerateError {
    /// Too many splits.
    #[error("{0} levels are too many: 0 to {MAX_LEVELS} are possible")]
    Levels(u32),
    /// No such number of base triangles.
    #[error("{0} base triangles: 1 to {MAX_TREES} are possible")]
    Base(u64),
    /// Roughness out of range.
    #[error("roughness {0} is not between 0 and 1")]
    Roughness(f64),
    /// Walls of a scene that has none, or no such number.
    #[error("{walls} quads along a wall of {}: 1 to {MAX_WALLS} are possible, of room", .scene.name())]
    Walls {
        /// The scene.
        scene: Scene,
        /// What was asked for.
        walls: u32,
    },
    /// Width of a scene that has its own, or no such width.
    #[error("a {} {width} wide: {} to {} are possible, of terrain", .scene.name(), WIDTHS.start(), WIDTHS.end())]
    Width {
        /// The scene.
        scene: Scene,
        /// What was asked for.
        width: f64,
    },
    /// The scene would be too large.
    #[error("{trees} base triangles with {levels} levels are more than {MAX_TRIANGLES} triangles")]
    Triangles {
        /// Base triangles that the scene would have.
        trees: u64,
        /// Splits.
        levels: u32,
    },
    /// The machine has too little memory.
    #[error(transparent)]
    Memory(#[from] NoMemory),
}

/// Makes a scene.
///
/// # Errors
/// As [`Options::check`], or the machine has too little memory.
pub fn generate(options: &Options) -> Result<Surface, GenerateError> {
    let Shape { n, levels, roughness, walls } = options.check()?;
    let scene = options.scene;
    let seed = options.seed;
    let surface = match scene {
        Scene::Terrain => terrain::generate(n, levels, seed, roughness, options.width.unwrap_or(terrain::WIDTH)),
        Scene::Cloth => cloth::generate(n, levels, seed, 2.0 * roughness),
        Scene::Sphere => sphere::generate(n, levels, seed, roughness),
        Scene::Spikes => spikes::generate(n, levels, seed, 2.0 * roughness),
        Scene::Room => room::generate(n, walls, levels, seed, 2.0 * roughness),
        Scene::Wall => wall::generate(n, levels, seed, roughness),
        Scene::Street => street::generate(n, levels, seed, roughness),
        Scene::Pot => pot::generate(n, levels, seed, 2.0 * roughness),
        Scene::Drape => drape::generate(n, levels, seed, 2.0 * roughness),
    };
    Ok(surface?)
}

#[cfg(test)]
mod tests;
