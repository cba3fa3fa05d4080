//! Vertices that move along with another mesh.

use super::distance::{Target, Vec3};
use rayon::prelude::*;

/// A bound vertex is at most this part of the smaller diagonal from the mesh: the mesh's own, or that of all vertices.
const FARTHEST: f64 = 0.1;

/// Vertices bound to a mesh, each to the triangle that it is nearest to at rest: it keeps its place on it, and beside it.
#[derive(Clone, Debug)]
pub struct Binding {
    vertices: Vec<Bound>,
    farthest: f64,
}

#[derive(Clone, Copy, Debug)]
struct Bound {
    /// Vertices of the triangle.
    corners: [u32; 3],
    /// The nearest point on it.
    barycentrics: [f64; 3],
    /// From there, in the triangle's [`frame`].
    beside: [f64; 3],
}

/// A vertex that does not belong to a mesh.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "vertex {vertex} is {distance:.3} away from the mesh at rest, more than a tenth of a diagonal of {diagonal:.3}: it was made from another mesh, or stands elsewhere"
)]
pub struct BindingError {
    vertex: usize,
    distance: f64,
    diagonal: f64,
}

impl Binding {
    /// Binds vertices, such as those of a scene that was built from a mesh, to that mesh: its positions, and the vertices of each triangle.
    ///
    /// # Errors
    /// A vertex is farther from it than a tenth of the mesh's diagonal, or of that of all vertices.
    ///
    /// # Panics
    /// A triangle names a vertex that is not there.
    pub fn new(positions: &[[f64; 3]], triangles: &[[u32; 3]], vertices: &[[f64; 3]]) -> Result<Self, BindingError> {
        let target = Target::new(triangles.iter().map(|triangle| corners(positions, triangle)).collect());
        let own = diagonal(target.corners.iter().flatten().copied());
        let diagonal = own.min(diagonal(vertices.iter().copied().map(Vec3::from)));
        let bind = |&vertex: &[f64; 3]| {
            let p = Vec3::from(vertex);
            // Flat triangles have no frame.
            let has_frame = |triangle: u32| frame(target.corners[triangle as usize]).is_some();
            let hit = target.closest(p, f64::MAX.sqrt(), has_frame)?;
            let axes = frame(target.corners[hit.triangle as usize])?;
            let beside = axes.map(|axis| axis.dot(p - hit.point));
            Some(Bound { corners: triangles[hit.triangle as usize], barycentrics: hit.barycentrics, beside })
        };
        let bound: Option<Vec<Bound>> = vertices.par_iter().map(bind).collect();
        // Without a triangle that has an area there is nothing to be near to.
        let bound = bound.ok_or(BindingError { vertex: 0, distance: f64::INFINITY, diagonal })?;
        let distances = bound.iter().map(|of| Vec3::from(of.beside).length());
        let (vertex, farthest) = distances.enumerate().fold((0, 0.0), |most, one| if one.1 > most.1 { one } else { most });
        if farthest > FARTHEST * diagonal {
            return Err(BindingError { vertex, distance: farthest, diagonal });
        }
        Ok(Self { vertices: bound, farthest })
    }

    /// How far the farthest vertex is from the mesh at rest.
    pub fn farthest(&self) -> f64 {
        self.farthest
    }

    /// Where the vertices are when those of the mesh are at `positions`.
    ///
    /// # Panics
    /// There are fewer than the mesh had.
    pub fn moved(&self, positions: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let moved = |of: &Bound| {
            let triangle = corners(positions, &of.corners);
            // A triangle that has become flat has no sides.
            let axes = frame(triangle).unwrap_or([Vec3::ZERO; 3]);
            let sum = |by: [f64; 3], of: [Vec3; 3]| of[0] * by[0] + of[1] * by[1] + of[2] * by[2];
            (sum(of.barycentrics, triangle) + sum(of.beside, axes)).into()
        };
        self.vertices.par_iter().map(moved).collect()
    }
}

/// The diagonal of the box of these points.
fn diagonal(points: impl Iterator<Item = Vec3> + Clone) -> f64 {
    (points.clone().fold(Vec3::NEG_INFINITY, Vec3::max) - points.fold(Vec3::INFINITY, Vec3::min)).length()
}

fn corners(positions: &[[f64; 3]], triangle: &[u32; 3]) -> [Vec3; 3] {
    triangle.map(|vertex| Vec3::from(positions[vertex as usize]))
}

/// A triangle's own axes: along its first edge, across it in its plane, and its normal; none if it has no area beyond what rounding leaves.
fn frame([a, b, c]: [Vec3; 3]) -> Option<[Vec3; 3]> {
    let (along, normal) = (b - a, (b - a).cross(c - a));
    let (length, area) = (along.length(), normal.length());
    // A comparison with what is no number is false.
    let has_area = area > 1e-12 * along.length_squared().max((c - a).length_squared());
    let (x, z) = (along / length, normal / area);
    has_area.then(|| [x, z.cross(x), z])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of two triangles.
    const SHEET: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [2.0, 2.0, 0.0], [0.0, 2.0, 0.0]];
    const TRIANGLES: [[u32; 3]; 2] = [[0, 1, 2], [0, 2, 3]];

    fn near(a: &[[f64; 3]], b: &[[f64; 3]]) {
        let far = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(a.len() == b.len() && far < 1e-12, "{a:?}, {b:?}");
    }

    #[test]
    fn vertices_keep_their_places_on_and_beside_the_mesh() {
        let vertices = [[0.5, 1.5, 0.0], [1.0, 0.5, 0.1], [2.1, 1.0, 0.0], [0.0, 0.0, 0.0]];
        let binding = Binding::new(&SHEET, &TRIANGLES, &vertices).unwrap();
        assert!((binding.farthest() - 0.1).abs() < 1e-12);
        near(&binding.moved(&SHEET), &vertices);
        // Turned about z, and moved: so is everything.
        let turned = |p: &[f64; 3]| [3.0 - p[1], 4.0 + p[0], 5.0 + p[2]];
        near(&binding.moved(&SHEET.map(|p| turned(&p))), &vertices.map(|p| turned(&p)));
        // Twice as large: places are, distances from the surface are not.
        near(&binding.moved(&SHEET.map(|p| p.map(|v| 2.0 * v)))[..2], &[[1.0, 3.0, 0.0], [2.0, 1.0, 0.1]]);
        // One triangle becomes a line: its vertices come to lie on it.
        let flat = [SHEET[0], SHEET[1], SHEET[2], [1.0, 1.0, 0.0]];
        near(&binding.moved(&flat)[..1], &[[1.0, 1.0, 0.0]]);
    }

    #[test]
    fn what_belongs_to_no_mesh_is_refused() {
        let refused = |vertices: &[[f64; 3]]| Binding::new(&SHEET, &TRIANGLES, vertices).unwrap_err().to_string();
        assert_eq!(
            refused(&[[0.0; 3], [0.0, 0.0, 9.0]]),
            "vertex 1 is 9.000 away from the mesh at rest, more than a tenth of a diagonal of 2.828: it was made from another mesh, or stands elsewhere"
        );
        // Small beside the mesh, but not on it.
        assert!(
            refused(&[[1.0, 1.0, 0.1], [1.1, 1.0, 0.1]])
                .contains("vertex 0 is 0.100 away from the mesh at rest, more than a tenth of a diagonal of 0.100")
        );
        assert!(Binding::new(&SHEET, &[[0, 1, 1]], &[[0.0; 3]]).is_err());
    }
}
