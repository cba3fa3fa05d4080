//! `room`: a box 2 wide, 1.4 high and 2 deep centred at the origin, open towards +z, around a [`super::cloth`]; all walls face inwards.
//!
//! Materials: 0 white (floor, ceiling, back), 1 red (left, x = -1), 2 green (right, x = 1), 3 blue (cloth).

use super::base::{Base, NoMemory, Parameter, Shape, append, reserved};
use super::cloth;
use crate::mesh::Surface;
use std::collections::HashMap;

const COLOURS: [[f32; 3]; 4] = [[0.75, 0.74, 0.70], [0.60, 0.06, 0.05], [0.12, 0.45, 0.09], [0.12, 0.22, 0.55]];
/// Half sizes of the box.
const HALF: [f64; 3] = [1.0, 0.7, 1.0];
/// Centre and scale of the cloth: its corners just miss the floor.
const CLOTH: ([f64; 3], f64) = ([0.0, -0.48, -0.1], 0.8);
/// A wall of the box, in the directions of the axes.
struct Side {
    origin: [i32; 3],
    along: [i32; 3],
    /// `along` x `across` points into the room.
    across: [i32; 3],
    material: u16,
}

const SIDES: [Side; 5] = [
    // Floor, ceiling, back, left, right.
    Side { origin: [0, 0, 0], along: [0, 0, 1], across: [1, 0, 0], material: 0 },
    Side { origin: [0, 1, 0], along: [1, 0, 0], across: [0, 0, 1], material: 0 },
    Side { origin: [0, 0, 0], along: [1, 0, 0], across: [0, 1, 0], material: 0 },
    Side { origin: [0, 0, 0], along: [0, 1, 0], across: [0, 0, 1], material: 1 },
    Side { origin: [1, 0, 0], along: [0, 0, 1], across: [0, 1, 0], material: 2 },
];

/// Quads along a wall for a cloth of `g` quads across.
pub(super) const fn wall_quads(g: u32) -> u32 {
    if g < 4 { 1 } else { g / 4 }
}

/// One wall: parameters (x, y, z) on the box's grid, normal the same everywhere.
struct Wall {
    steps: i32,
    normal: [f32; 3],
}

impl Shape for Wall {
    fn point(&self, p: Parameter) -> ([f64; 3], [f32; 3]) {
        let place = p.map(|c| f64::from(2 * c - self.steps) / f64::from(self.steps));
        (std::array::from_fn(|k| HALF[k] * place[k]), self.normal)
    }
}

/// A room of `walls` quads along each wall around a cloth of `g` by `g` quads.
pub(super) fn generate(g: u32, walls: u32, levels: u32, seed: u64, detail: f64) -> Result<Surface, NoMemory> {
    let mut room = cloth::placed(g, levels, seed, detail, CLOTH.0, CLOTH.1)?;
    let w = walls as i32; // below 2^12 (`Options::check`)
    let trees = room.triangles.len() + SIDES.len() * 2 * (w * w) as usize;
    room.materials = reserved(trees)?;
    room.materials.resize(room.triangles.len(), 3);
    room.colours = COLOURS.to_vec();

    // Walls share the vertices of the box's edges.
    let mut vertices = HashMap::new();
    for Side { origin, along, across, material } in SIDES {
        let normal = [0, 1, 2].map(|k| (along[(k + 1) % 3] * across[(k + 2) % 3] - along[(k + 2) % 3] * across[(k + 1) % 3]) as f32);
        let corner = |a: i32, b: i32| -> Parameter { std::array::from_fn(|k| origin[k] * w + along[k] * a + across[k] * b) };
        let mut base = Base { parameters: Vec::new(), triangles: Vec::new() };
        let mut indices = Vec::new();
        for b in 0..=w {
            for a in 0..=w {
                base.parameters.push(corner(a, b));
                let next = room.base_vertices + vertices.len() as u32;
                indices.push(*vertices.entry(corner(a, b)).or_insert(next));
            }
        }
        for b in 0..w {
            for a in 0..w {
                let v = (b * (w + 1) + a) as u32;
                let [p, q, r, s] = [v, v + 1, v + 1 + w as u32, v + 2 + w as u32];
                base.triangles.extend(if (a + b) % 2 == 0 { [[p, q, r], [s, r, q]] } else { [[q, s, p], [r, p, s]] });
            }
        }
        let wall = base.tessellate(levels, &Wall { steps: w << levels, normal })?;
        room.triangles.extend(wall.triangles.iter().map(|t| t.map(|v| indices[v as usize])));
        append(&mut room.positions, &wall.positions)?;
        append(&mut room.normals, &wall.normals)?;
        room.materials.resize(room.triangles.len(), material);
    }
    room.base_vertices += vertices.len() as u32;
    Ok(room)
}
