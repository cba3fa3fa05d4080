//! The original surface, in the unit box, cut along its feature lines.

use super::super::clean::TriangleMesh;
use super::super::distance::{Hit, Target, Vec3};
use super::super::sets::Sets;

/// The original, ready to be simplified and projected on.
///
/// A **wedge** is the part of a vertex's neighbourhood between two feature lines; a **patch** is a part of the surface that feature lines
/// bound. Away from feature lines a vertex has one wedge.
pub(super) struct Source {
    pub positions: Vec<Vec3>,
    /// Wedges of each triangle's corners.
    pub wedges: Vec<[u32; 3]>,
    /// Vertex of each wedge.
    pub wedge_vertex: Vec<u32>,
    /// Unit normal of each wedge (zero if its triangles cancel out).
    pub wedge_normal: Vec<Vec3>,
    /// Patch of each triangle.
    pub patch: Vec<u32>,
    /// Unit normal of each triangle.
    pub face_normal: Vec<Vec3>,
    /// Neighbours of each vertex along feature lines, in order.
    pub feature: Vec<Vec<u32>>,
    pub target: Target,
    /// Length of the diagonal of the bounding box, in units of the box.
    pub diagonal: f64,
    centre: Vec3,
    scale: f64,
}

/// A crease bends this many times as much as the edges beside it: a rough or coarse surface that bends everywhere has none, ...
const CONTRAST: f64 = 2.5;
/// ... except where it bends by more than this (radians).
const ALWAYS: f64 = 1.4;

/// Creases shorter than this, in units of the box, are bumps.
const SHORTEST: f64 = 0.1;

/// An edge's end points in order, its triangle, and whether the triangle runs from the first to the second.
type EdgeUse = (u32, u32, u32, bool);

impl Source {
    /// Finds creases where the surface bends by more than `crease` (radians).
    pub fn new(mesh: &TriangleMesh, crease: f64) -> Source {
        let (centre, scale) = placement(mesh);
        let positions: Vec<Vec3> = mesh.positions.iter().map(|&p| (Vec3::from(p) - centre) / scale).collect();
        let corners: Vec<[Vec3; 3]> = mesh.triangles.iter().map(|t| t.map(|v| positions[v as usize])).collect();
        let face_normal: Vec<Vec3> = corners.iter().map(|&[a, b, c]| (b - a).cross(c - a).normalize_or_zero()).collect();

        let mut uses: Vec<EdgeUse> = Vec::with_capacity(3 * mesh.triangles.len());
        for (&[a, b, c], t) in mesh.triangles.iter().zip(0u32..) {
            uses.extend([(a, b), (b, c), (c, a)].map(|(a, b)| (a.min(b), a.max(b), t, a < b)));
        }
        uses.sort_unstable();

        let creases = find_creases(&uses, &positions, &face_normal, &mesh.materials, crease);
        let mut feature = vec![Vec::new(); positions.len()];
        let mut corner_sets = Sets::new(3 * mesh.triangles.len());
        let mut patch_sets = Sets::new(mesh.triangles.len());
        for (run, is_crease) in uses.chunk_by(same_edge).zip(creases) {
            let (a, b, s, t) = (run[0].0, run[0].1, run[0].2, run[run.len() - 1].2);
            if is_crease {
                feature[a as usize].push(b);
                feature[b as usize].push(a);
                continue;
            }
            patch_sets.join(s, t);
            for v in [a, b] {
                let corner = |t: u32| 3 * t + mesh.triangles[t as usize].iter().position(|&w| w == v).unwrap_or(0) as u32;
                corner_sets.join(corner(s), corner(t));
            }
        }

        let (corner_wedge, wedge_count) = corner_sets.numbers();
        let wedges: Vec<[u32; 3]> = corner_wedge.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        let mut wedge_vertex = vec![0; wedge_count];
        let mut wedge_normal = vec![Vec3::ZERO; wedge_count];
        for (t, (tri, wedge)) in mesh.triangles.iter().zip(&wedges).enumerate() {
            for k in 0..3 {
                let [p, q, r] = [0, 1, 2].map(|d| corners[t][(k + d) % 3]);
                let angle = (q - p).normalize_or_zero().dot((r - p).normalize_or_zero()).clamp(-1.0, 1.0).acos();
                wedge_vertex[wedge[k] as usize] = tri[k];
                wedge_normal[wedge[k] as usize] += face_normal[t] * angle;
            }
        }
        wedge_normal.iter_mut().for_each(|n| *n = n.normalize_or_zero());

        let (low, high) = bounds(&positions);
        Source {
            wedges,
            wedge_vertex,
            wedge_normal,
            patch: patch_sets.numbers().0,
            face_normal,
            feature,
            target: Target::new(corners),
            diagonal: (high - low).length(),
            centre,
            scale,
            positions,
        }
    }

    /// Vertices of all triangles.
    pub fn triangles(&self) -> Vec<[u32; 3]> {
        self.wedges.iter().map(|t| t.map(|w| self.wedge_vertex[w as usize])).collect()
    }

    /// A point in the user's units.
    pub fn to_world(&self, p: Vec3) -> [f64; 3] {
        (self.centre + p * self.scale).to_array()
    }

    /// The smooth unit normal at a point of the surface.
    pub fn normal(&self, hit: &Hit) -> Vec3 {
        self.normal_at(hit.triangle, hit.barycentrics)
    }

    /// The same for a triangle and barycentrics on it.
    pub fn normal_at(&self, triangle: u32, barycentrics: [f64; 3]) -> Vec3 {
        let t = triangle as usize;
        let sum: Vec3 = (0..3).map(|k| self.wedge_normal[self.wedges[t][k] as usize] * barycentrics[k]).sum();
        sum.try_normalize().unwrap_or(self.face_normal[t])
    }
}

fn same_edge(a: &EdgeUse, b: &EdgeUse) -> bool {
    (a.0, a.1) == (b.0, b.1)
}

fn bounds(positions: &[Vec3]) -> (Vec3, Vec3) {
    positions.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)))
}

/// Centre of the box and a power of two no smaller than its half width, so that scaling is exact.
fn placement(mesh: &TriangleMesh) -> (Vec3, f64) {
    let positions: Vec<Vec3> = mesh.positions.iter().map(|&p| p.into()).collect();
    let (low, high) = bounds(&positions);
    let half = ((high - low) / 2.0).max_element();
    let scale = if half > 0.0 { half.log2().ceil().exp2() } else { 1.0 };
    ((low + high) / 2.0, if scale.is_normal() { scale } else { 1.0 })
}

/// For each edge in order: whether it is on a feature line: a border, an edge that is not manifold, one between two materials, or a crease.
fn find_creases(uses: &[EdgeUse], positions: &[Vec3], normals: &[Vec3], materials: &[u16], crease: f64) -> Vec<bool> {
    let runs: Vec<&[EdgeUse]> = uses.chunk_by(same_edge).collect();
    // The angle by which the surface bends at each edge; none at borders and where it cannot be told.
    let bend: Vec<Option<f64>> = (runs.iter())
        .map(|run| match run {
            [s, t] if s.3 != t.3 => Some(normals[s.2 as usize].dot(normals[t.2 as usize]).clamp(-1.0, 1.0).acos()),
            _ => None,
        })
        .collect();
    let mut sides = vec![Vec::with_capacity(3); normals.len()];
    for (run, e) in runs.iter().zip(0usize..) {
        run.iter().for_each(|u| sides[u.2 as usize].push(e));
    }
    // Of the four other edges of its two triangles, one or two may be creases that meet this one.
    let second_around = |e: usize| {
        let mut around: Vec<f64> =
            (runs[e].iter().flat_map(|u| &sides[u.2 as usize])).filter(|&&f| f != e).filter_map(|&f| bend[f]).collect();
        around.sort_unstable_by(f64::total_cmp);
        around.get(1).or(around.first()).copied().unwrap_or(0.0)
    };
    let material = |u: &EdgeUse| materials.get(u.2 as usize);
    let hard = |e: usize| bend[e].is_none() || runs[e].iter().any(|u| material(u) != material(&runs[e][0]));
    let sharp = |e: usize| bend[e].is_some_and(|b| b > crease && (b > ALWAYS.max(crease) || b > CONTRAST * second_around(e)));
    let marked: Vec<bool> = (0..runs.len()).map(|e| hard(e) || sharp(e)).collect();

    // Bends in a row are measured together.
    let mut lines = Sets::new(positions.len());
    let ends = |e: usize| (runs[e][0].0, runs[e][0].1);
    (0..runs.len()).filter(|&e| marked[e]).for_each(|e| lines.join(ends(e).0, ends(e).1));
    let (line, count) = lines.numbers();
    let mut length = vec![0.0; count];
    for (a, b) in (0..runs.len()).filter(|&e| marked[e]).map(ends) {
        length[line[a as usize] as usize] += (positions[b as usize] - positions[a as usize]).length();
    }
    (0..runs.len()).map(|e| hard(e) || (marked[e] && length[line[ends(e).0 as usize] as usize] >= SHORTEST)).collect()
}
