//! Values of the library's that options take by name: the library has the names, and what `--help` says of each stands here.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use lodray::format::{Grid, Shading};
use lodray::mesh::procedural::Scene;
use lodray::mesh::{BoundKind, MeshFormat, Motion};
use lodray::num::VertexForm;
use lodray::run::Compute;

/// A value with a name.
pub trait Named: Copy + Send + Sync + 'static {
    /// All of them, in the order of `--help`.
    const ALL: &'static [Self];
    /// What it is called.
    fn name(self) -> &'static str;
    /// What `--help` says of it.
    fn about(self) -> &'static str;
}

/// Reads a value's name.
pub fn named<T: Named>() -> impl TypedValueParser<Value = T> {
    let values = T::ALL.iter().map(|value| PossibleValue::new(value.name()).help(value.about()));
    PossibleValuesParser::new(values)
        .try_map(|name| T::ALL.iter().copied().find(|value| value.name() == name).ok_or("there is no such value"))
}

impl Named for Compute {
    const ALL: &'static [Self] = &Self::ALL;

    fn name(self) -> &'static str {
        self.name()
    }

    fn about(self) -> &'static str {
        match self {
            Self::Free => "It takes no time, as in the paper",
            Self::Units => "Traversal units, cycle by cycle",
        }
    }
}

impl Named for MeshFormat {
    const ALL: &'static [Self] = &Self::ALL;

    fn name(self) -> &'static str {
        self.name()
    }

    fn about(self) -> &'static str {
        match self {
            Self::Obj => "Wavefront OBJ",
            Self::Ply => "Stanford PLY, ASCII or binary",
            Self::Gltf => "glTF 2.0, JSON",
            Self::Glb => "glTF 2.0, binary",
            Self::Stl => "STL, ASCII or binary",
        }
    }
}

impl Named for BoundKind {
    const ALL: &'static [Self] = &Self::ALL;

    fn name(self) -> &'static str {
        self.name()
    }

    fn about(self) -> &'static str {
        match self {
            Self::Largest => "The largest displacement of one split at or below an edge, as in the paper",
            Self::Total => {
                "The displacements of all splits at and below it, one upon the other: --delta is then a promise (1.6 keeps what is seen within a pixel of its place on the surface)"
            }
        }
    }
}

impl Named for VertexForm {
    const ALL: &'static [Self] = &Self::ALL;

    fn name(self) -> &'static str {
        self.name()
    }

    fn about(self) -> &'static str {
        match self {
            Self::Exact => "28 bits a coordinate: a line of 32 bytes for the three vertices of a split",
            Self::Compact => {
                "13 bits of the displacement from the edge's midpoint: half a line, and each vertex moved by up to 1/2048 of its edge's bound"
            }
            Self::Short => {
                "As compact, but 7 bits in last splits: a quarter of a line, and each vertex there moved by up to 1/32 of its edge's bound"
            }
        }
    }
}

impl Named for Motion {
    const ALL: &'static [Self] = &Self::ALL;

    fn name(self) -> &'static str {
        self.name()
    }

    fn about(self) -> &'static str {
        match self {
            Self::Wave => "Two waves run along the longest side of the box",
            Self::Twist => "The ends of the longest side turn around it",
            Self::Breathe => "All grows and shrinks around the middle",
        }
    }
}

impl Named for Shading {
    const ALL: &'static [Self] = &Self::ALL;

    fn name(self) -> &'static str {
        self.name()
    }

    fn about(self) -> &'static str {
        match self {
            Self::Smooth => "Anew from the facets around each vertex; sharp between trees where they were sharp",
            Self::Keep => "As they were",
        }
    }
}

impl Named for Grid {
    const ALL: &'static [Self] = &Self::ALL;

    fn name(self) -> &'static str {
        self.name()
    }

    fn about(self) -> &'static str {
        match self {
            Self::New => "Where a scene built from these positions has it: their box fills the range of coordinates",
            Self::Keep => "Where it was, so that what does not move keeps its coordinates; new if a position is outside",
        }
    }
}

impl Named for Scene {
    const ALL: &'static [Self] = &Self::ALL;

    fn name(self) -> &'static str {
        self.name()
    }

    fn about(self) -> &'static str {
        match self {
            Self::Terrain => "Fractal heightfield",
            Self::Cloth => "Draped sheet with folds, flat parts and a fine weave",
            Self::Sphere => "Displaced sphere, closed",
            Self::Spikes => "Sphere with needles far longer than its edges, closed",
            Self::Room => "Box with an open side around the cloth",
            Self::Wall => "182 displaced spheres side by side",
            Self::Street => "64 displaced spheres in two rows along z, seen from an end near to far, closed",
            Self::Pot => "Hammered teapot, closed",
            Self::Drape => "Cloth over the pot, with folds and a fine weave",
        }
    }
}
