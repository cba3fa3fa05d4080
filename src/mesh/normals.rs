//! Shading normals at the corners of a mesh's triangles: the mesh's own, else smooth ones that creases split.

use super::clean::TriangleMesh;
use super::sets::Sets;
use glam::DVec3;

/// Where a mesh has no normals of its own, edges that bend by more than this (degrees) are shaded as creases: a prism of six sides has edges,
/// one of eight is round.
pub const DEFAULT_CREASE_ANGLE: f64 = 50.0;

/// A unit normal for each corner of each triangle: the mesh's own where there is one, else the mean of the faces around the vertex, weighed by
/// their angles there, that edges of two triangles bending by at most `crease_angle` (degrees) connect.
pub fn corner_normals(mesh: &TriangleMesh, crease_angle: f64) -> Vec<[[f32; 3]; 3]> {
    let own = |t: usize, k: usize| mesh.normals.get(t).map(|n| n[k]).filter(|n| n.iter().any(|&v| v != 0.0));
    let smooth =
        if (0..mesh.triangles.len()).all(|t| (0..3).all(|k| own(t, k).is_some())) { Vec::new() } else { smooth(mesh, crease_angle) };
    (0..mesh.triangles.len())
        .map(|t| std::array::from_fn(|k| own(t, k).unwrap_or_else(|| smooth[3 * t + k].to_array().map(|v| v as f32))))
        .collect()
}

/// One for each corner, three to a triangle.
fn smooth(mesh: &TriangleMesh, crease_angle: f64) -> Vec<DVec3> {
    // Edges and areas of very small and very large meshes stay within the range of numbers.
    let size = mesh.positions.iter().flatten().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    let at = |v: u32| DVec3::from_array(mesh.positions[v as usize]) / size;
    let face: Vec<DVec3> = (mesh.triangles.iter())
        .map(|t| {
            let [a, b, c] = t.map(at);
            (b - a).normalize_or_zero().cross((c - a).normalize_or_zero()).normalize_or_zero()
        })
        .collect();

    let mut uses = Vec::with_capacity(3 * mesh.triangles.len());
    for (tri, t) in mesh.triangles.iter().zip(0u32..) {
        for k in 0..3u32 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (a, b) = (tri[i as usize], tri[j as usize]);
            // Corners at the smaller and at the larger end.
            let corners = if a < b { [3 * t + i, 3 * t + j] } else { [3 * t + j, 3 * t + i] };
            uses.push((a.min(b), a.max(b), a < b, corners));
        }
    }
    uses.sort_unstable();
    let least = crease_angle.to_radians().cos();
    let mut sets = Sets::new(3 * mesh.triangles.len());
    for run in uses.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let [s, t] = run else { continue };
        let [f, g] = [s, t].map(|u| face[u.3[0] as usize / 3]);
        // A hair below, so that an angle met exactly does not depend on rounding.
        if s.2 != t.2 && f.dot(g) >= least - 1e-9 {
            (0..2).for_each(|end| sets.join(s.3[end], t.3[end]));
        }
    }
    let (number, count) = sets.numbers();
    let mut sums = vec![DVec3::ZERO; count];
    for (t, tri) in mesh.triangles.iter().enumerate() {
        for k in 0..3 {
            let [p, q, r] = [0, 1, 2].map(|d| at(tri[(k + d) % 3]));
            let angle = (q - p).normalize_or_zero().dot((r - p).normalize_or_zero()).clamp(-1.0, 1.0).acos();
            sums[number[3 * t + k] as usize] += face[t] * angle;
        }
    }
    (0..number.len()).map(|c| sums[number[c] as usize].try_normalize().or(face[c / 3].try_normalize()).unwrap_or(DVec3::Z)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A roof of two squares that bends by `angle` degrees along the x axis.
    fn roof(angle: f64) -> TriangleMesh {
        let (s, c) = angle.to_radians().sin_cos();
        let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [0.0, -c, -s], [1.0, -c, -s]];
        TriangleMesh::from_parts(&positions, &[[0, 1, 3], [0, 3, 2], [0, 4, 5], [0, 5, 1]], &[], vec![]).unwrap()
    }

    #[test]
    fn a_bend_is_smooth_up_to_the_angle_and_sharp_beyond() {
        let differ = |angle, crease| {
            let normals = corner_normals(&roof(angle), crease);
            (0..3).any(|k| (normals[0][0][k] - normals[2][0][k]).abs() > 1e-6)
        };
        assert!(!differ(40.0, 40.0) && differ(40.1, 40.0) && !differ(90.0, 180.0) && differ(5.0, 0.0));
        for n in corner_normals(&roof(30.0), 50.0).iter().flatten() {
            assert!((n.iter().map(|v| v * v).sum::<f32>() - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn the_meshs_own_normals_are_kept_corner_by_corner() {
        let mut mesh = roof(30.0);
        mesh.normals = vec![[[1.0, 0.0, 0.0]; 3]; 4];
        mesh.normals[2][1] = [0.0; 3];
        let normals = corner_normals(&mesh, 50.0);
        assert_eq!(normals[0], [[1.0, 0.0, 0.0]; 3]);
        assert!(normals[2][0] == [1.0, 0.0, 0.0] && normals[2][1][0].abs() < 1e-6 && normals[2][1][2] > 0.8, "{:?}", normals[2]);
    }
}
