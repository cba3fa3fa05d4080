//! Polygons to triangles: a fan where it is right, ears where the polygon is not convex.

/// Most corners of a polygon that a fan does not fit: the time to cut its ears grows with their number cubed, at worst.
pub(super) const MAX_EARS: usize = 4096;

/// Twice the area that a triangle of so large a polygon's fan may be turned over by: as much as six digits of a round cap's corners leave next to its first one.
const SLIVER: f64 = -1e-8;

/// Gives the triangles of the polygon with these vertices, three or more, one by one to `out`: as places in `corners`.
///
/// # Errors
/// It is not convex and has more than [`MAX_EARS`] corners.
pub(super) fn triangulate(positions: &[[f64; 3]], corners: &[u32], mut out: impl FnMut([usize; 3])) -> Result<(), String> {
    if corners.len() <= 3 {
        out([0, 1, 2]);
        return Ok(());
    }
    let flat = project(positions, corners);
    let least = if corners.len() > MAX_EARS { SLIVER } else { 0.0 };
    if (1..corners.len() - 1).all(|k| area(flat[0], flat[k], flat[k + 1]) > least) {
        (1..corners.len() - 1).for_each(|k| out([0, k, k + 1]));
        return Ok(());
    }
    if corners.len() > MAX_EARS {
        return Err(format!("a face of {} corners that is not convex cannot be cut into triangles: one of {MAX_EARS} can", corners.len()));
    }
    let mut left: Vec<usize> = (0..corners.len()).collect();
    while left.len() > 3 {
        // A polygon that crosses itself may have no ear: then any corner goes.
        let ear = (0..left.len()).find(|&k| is_ear(&flat, &left, k)).unwrap_or(1);
        out(neighbours(&left, ear));
        left.remove(ear);
    }
    out([left[0], left[1], left[2]]);
    Ok(())
}

fn neighbours(left: &[usize], k: usize) -> [usize; 3] {
    let n = left.len();
    [left[(k + n - 1) % n], left[k], left[(k + 1) % n]]
}

fn is_ear(flat: &[[f64; 2]], left: &[usize], k: usize) -> bool {
    let tri = neighbours(left, k);
    let [a, b, c] = tri.map(|i| flat[i]);
    area(a, b, c) > 0.0
        && left.iter().filter(|i| !tri.contains(i)).all(|&i| {
            let p = flat[i];
            area(a, b, p) < 0.0 || area(b, c, p) < 0.0 || area(c, a, p) < 0.0
        })
}

/// Twice the signed area.
fn area(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Corners in the coordinate plane that the polygon faces most, scaled to about 1, counter-clockwise.
fn project(positions: &[[f64; 3]], corners: &[u32]) -> Vec<[f64; 2]> {
    let origin = positions[corners[0] as usize];
    let mut local: Vec<[f64; 3]> = corners.iter().map(|&c| std::array::from_fn(|k| positions[c as usize][k] - origin[k])).collect();
    let size = local.iter().flatten().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    local.iter_mut().flatten().for_each(|v| *v /= size);
    // Newell's normal: the polygon's areas in the three coordinate planes.
    let mut normal = [0.0f64; 3];
    for (i, p) in local.iter().enumerate() {
        let q = local[(i + 1) % local.len()];
        for (k, sum) in normal.iter_mut().enumerate() {
            let (u, v) = ((k + 1) % 3, (k + 2) % 3);
            *sum += p[u] * q[v] - p[v] * q[u];
        }
    }
    let axis = (0..3).fold(0, |best, k| if normal[k].abs() > normal[best].abs() { k } else { best });
    let (u, v) = if normal[axis] >= 0.0 { ((axis + 1) % 3, (axis + 2) % 3) } else { ((axis + 2) % 3, (axis + 1) % 3) };
    local.iter().map(|p| [p[u], p[v]]).collect()
}
