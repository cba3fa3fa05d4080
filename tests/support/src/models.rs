//! Small models and rays for tests.

use lodray::{
    bvh::over_trees,
    format::{self, Scene, SceneInfo},
    golden::{naive_bounds, naive_compact},
    mesh::{BoundKind, EdgeCodes, Hierarchy, Placement, Surface, lattice},
    method::bvh::{FullBvh, FullOptions, LeafLayout, NodeBoxes, NodeOrder},
    num::{Cone, Direction, Point, Ray, U, Vec3, VertexForm, random, snap},
};

/// A plain 64-bit generator (splitmix64): the same numbers everywhere.
#[derive(Clone)]
pub struct Rng(pub u64);

impl Rng {
    pub fn draw(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(random::STEP);
        random::mix(self.0)
    }

    /// Uniform in 0..1.
    pub fn unit(&mut self) -> f64 {
        (self.draw() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform in -1..1.
    pub fn signed(&mut self) -> f64 {
        2.0 * self.unit() - 1.0
    }

    pub fn below(&mut self, n: u64) -> u64 {
        self.draw() % n
    }
}

/// Three numbers in -1..1 that depend on an integer point only.
fn noise(p: [i64; 3], seed: u64) -> [f64; 3] {
    let key = p.iter().fold(seed, |h, &v| random::mix(h ^ v.cast_unsigned()));
    let mut rng = Rng(key);
    [rng.signed(), rng.signed(), rng.signed()]
}

/// A hierarchy over base vertices with small integer coordinates; `place` maps M times the interpolated base position and the
/// vertex's level to a position in units, so vertices that trees share get one position. Its bounds are the paper's, its vertices exact.
pub fn model(levels: u32, base: &[[i64; 3]], triangles: Vec<[u32; 3]>, place: impl Fn([i64; 3], u32) -> [f64; 3]) -> Hierarchy {
    let m = 1i64 << levels;
    let mut points = Vec::new();
    for t in &triangles {
        let [a, b, c] = t.map(|v| base[v as usize]);
        for j in 0..=m {
            for i in 0..=m - j {
                let p = std::array::from_fn(|k| (m - i - j) * a[k] + i * b[k] + j * c[k]);
                let level = lattice::level_of(levels, (i as u32, j as u32));
                points.push(place(p, level).map(|v| snap(v, levels - level)));
            }
        }
    }
    let mut h = Hierarchy {
        levels,
        placement: Placement { offset: [0.0; 3], scale: 1.0 },
        base_vertices: base.len() as u32,
        triangles,
        points,
        bounds: EdgeCodes { kind: BoundKind::Largest, ..EdgeCodes::default() },
        vertices: VertexForm::Exact,
        zeros: 0,
    };
    naive_bounds(&mut h);
    h
}

/// The same model on coarser grids, the finest of which has `zeros` zero bits, and with the bounds of that.
pub fn with_zeros(zeros: u32, mut h: Hierarchy) -> Hierarchy {
    if zeros > h.zeros {
        h.zeros = zeros;
        let form = h.vertices;
        regrid(form, &mut h);
    }
    h
}

/// Puts the points of a model on the grids of this form, and bounds them.
fn regrid(form: VertexForm, h: &mut Hierarchy) {
    let m = 1u32 << h.levels;
    let places = (0..=m).flat_map(|j| (0..=m - j).map(move |i| (i, j)));
    let bits: Vec<u32> = places.map(|place| form.zero_bits(h.levels, lattice::level_of(h.levels, place), h.zeros)).collect();
    for (point, &bits) in h.points.iter_mut().zip(bits.iter().cycle()) {
        *point = point.map(|v| snap(f64::from(v), bits));
    }
    naive_bounds(h);
}

/// A ray with so many zero bits at the bottom of its origin and of its direction.
pub fn coarsened(ray: &Ray, zeros: [u32; 2]) -> Ray {
    // Towards zero: nothing gets too long.
    let cut = |v: [i64; 3], zeros: u32| v.map(|v| v.signum() * (v.abs() >> zeros << zeros));
    let ([x, y, z], [dx, dy, dz]) = (cut(ray.origin.get(), zeros[0]), cut(ray.direction.get(), zeros[1]));
    Ray { origin: Point::new(x, y, z), direction: Direction::new(dx, dy, dz), ..*ray }
}

/// The same model with vertices of this form: to have them compact its points go to the coarser grids of that form, and bounds are those of that.
pub fn with_vertices(form: VertexForm, mut h: Hierarchy) -> Hierarchy {
    if form.is_compact() {
        regrid(form, &mut h);
        naive_compact(form, &mut h);
    }
    h
}

/// Corner positions of an octahedron and its outward triangles.
pub fn octahedron() -> (Vec<[i64; 3]>, Vec<[u32; 3]>) {
    let base = vec![[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]];
    let mut triangles = Vec::new();
    for (x, y, z) in (0..8u32).map(|o| (o & 1, 2 + (o >> 1 & 1), 4 + (o >> 2 & 1))) {
        // An odd number of negative axes mirrors the triangle.
        triangles.push(if (x + y + z) % 2 == 0 { [x, y, z] } else { [y, x, z] });
    }
    (base, triangles)
}

/// A closed bumpy ball of radius 2^28; `roughness` 1 gives spikes and folds, 0 a sphere.
pub fn ball(levels: u32, roughness: f64, seed: u64) -> Hierarchy {
    let (base, triangles) = octahedron();
    model(levels, &base, triangles, |p, level| {
        let length = p.iter().map(|&v| (v * v) as f64).sum::<f64>().sqrt();
        let n = noise(p, seed);
        let bump = roughness / f64::from(1u32 << level);
        std::array::from_fn(|k| (p[k] as f64 / length + bump * n[k]) * f64::from(1 << 28))
    })
}

/// An open terrain of side * side quads that fills most of the integer space, z up.
pub fn terrain(side: u32, levels: u32, roughness: f64, seed: u64) -> Hierarchy {
    let w = side + 1;
    let base: Vec<[i64; 3]> = (0..w * w).map(|v| [i64::from(v % w), i64::from(v / w), 0]).collect();
    let mut triangles = Vec::new();
    for v in (0..side * side).map(|q| q / side * w + q % side) {
        triangles.extend([[v, v + 1, v + w], [v + 1, v + w + 1, v + w]]);
    }
    let full = f64::from(side << levels);
    model(levels, &base, triangles, |p, level| {
        let n = noise(p, seed);
        let step = 1.9 * f64::from(1 << 30) / f64::from(side << level);
        let xy = |k: usize| (2.0 * p[k] as f64 / full - 1.0) * 1.9 * f64::from(1 << 30);
        let hill = (xy(0) / 3e8).sin() * (xy(1) / 4e8).cos() * 2e8;
        [xy(0) + 0.2 * roughness * step * n[0], xy(1) + 0.2 * roughness * step * n[1], hill + roughness * step * n[2]]
    })
}

/// A cone that tolerates `at_origin` units at the origin and `per_unit` more for each unit of distance.
pub fn cone(at_origin: f64, per_unit: f64) -> Cone {
    const SHIFT: u32 = 18;
    let one = f64::from(1u32 << SHIFT);
    Cone { offset: U::saturating((at_origin * one) as u64), slope: U::saturating((per_unit * one) as u64), shift: U::new(u64::from(SHIFT)) }
}

/// A cone of any width, from full detail to the base mesh of a ball.
pub fn any_cone(rng: &mut Rng) -> Cone {
    match rng.below(8) {
        0 => Cone::default(),
        1 => cone(1e10, 0.0),
        2 | 3 => cone(2f64.powf(4.0 + 25.0 * rng.unit()), 0.0),
        _ => cone(2f64.powf(28.0 * rng.unit()), 2f64.powf(-17.0 + 16.0 * rng.unit())),
    }
}

/// A random direction of length 2^30 - 1, rounded.
pub fn direction(rng: &mut Rng) -> [i64; 3] {
    loop {
        let d = [rng.signed(), rng.signed(), rng.signed()];
        let length = d.iter().map(|v| v * v).sum::<f64>().sqrt();
        if length > 0.1 && length <= 1.0 {
            return d.map(|v| (v / length * f64::from((1 << 30) - 1)).round() as i64);
        }
    }
}

/// The ray with this origin and direction; both must fit their formats.
pub fn ray(origin: [i64; 3], d: [i64; 3], cone: Cone) -> Ray {
    Ray { origin: Vec3::new(origin[0], origin[1], origin[2]), direction: Vec3::new(d[0], d[1], d[2]), cone }
}

/// The ray along `d` that passes exactly through `p` at parameter 1.
pub fn ray_through(p: [i64; 3], d: [i64; 3], cone: Cone) -> Ray {
    ray(std::array::from_fn(|k| p[k] - d[k]), d, cone)
}

/// Rays through a model's points and past them, from all sides, with cones of all widths.
pub fn any_rays(h: &Hierarchy, count: usize, seed: u64) -> Vec<Ray> {
    let mut rng = Rng(seed);
    let mut random = || {
        let at = h.points[rng.below(h.points.len() as u64) as usize].map(i64::from);
        let spread = 1u64 << rng.below(28);
        let near = at.map(|v| v + (rng.signed() * spread as f64) as i64);
        let d = direction(&mut rng);
        let cone = any_cone(&mut rng);
        let start: [i64; 3] = std::array::from_fn(|k| near[k] - d[k]);
        if start.iter().all(|v| v.abs() < 1 << 31) {
            ray_through(near, d, cone)
        } else {
            ray(near.map(|v| v.clamp(-(1 << 30), 1 << 30)), d, cone)
        }
    };
    (0..count).map(|_| random()).collect()
}

/// The scene of a surface, with the paper's bounds and exact vertices.
pub fn build(surface: &Surface) -> Scene {
    build_with(surface, VertexForm::Exact)
}

/// The scene of a surface, with the paper's bounds.
pub fn build_with(surface: &Surface, vertices: VertexForm) -> Scene {
    format::build(surface, SceneInfo { bounds: BoundKind::Largest, vertices, ..SceneInfo::default() }, over_trees).expect("a valid surface")
}

/// The scene of a hierarchy, all normals up. Its trees have the order of its quad-BVH's leaves, so its `decode` has other numbers for them.
pub fn scene_of(h: &Hierarchy) -> Scene {
    let surface = Surface {
        levels: h.levels,
        base_vertices: h.base_vertices,
        triangles: h.triangles.clone(),
        normals: vec![[0.0, 0.0, 1.0]; h.points.len()],
        ..Surface::default()
    };
    let bvh = over_trees(&format::tree_boxes(h)).expect("at least one tree");
    format::encode(h, &surface, SceneInfo::default(), &bvh).expect("a valid model")
}

/// BVHs of every kind of nodes and leaves over the full resolution.
pub fn full_bvhs(h: &Hierarchy) -> Vec<FullBvh> {
    let variants = [
        (NodeBoxes::Local, LeafLayout::Line, 4, NodeOrder::Depth),
        (NodeBoxes::Codes, LeafLayout::Indexed, 2, NodeOrder::Treelets),
        (NodeBoxes::Wide, LeafLayout::Packed, 1, NodeOrder::Levels),
        (NodeBoxes::Local, LeafLayout::Block, 16, NodeOrder::Treelets),
        (NodeBoxes::Wide, LeafLayout::Block, 8, NodeOrder::VanEmdeBoas),
        (NodeBoxes::Six, LeafLayout::Block, 16, NodeOrder::Treelets),
        (NodeBoxes::Six, LeafLayout::Indexed, 1, NodeOrder::Depth),
        (NodeBoxes::Oriented, LeafLayout::Block, 16, NodeOrder::Levels),
        (NodeBoxes::Oriented, LeafLayout::Line, 1, NodeOrder::Depth),
    ];
    let build = |(boxes, layout, size, order)| {
        let options = FullOptions { order, ..FullOptions::new(size, boxes, layout) };
        FullBvh::build(h, &options).expect("a valid model")
    };
    variants.map(build).into()
}
