//! Prisms of the nodes of a hierarchy: the least codes that hold every full-resolution vertex below.

use super::Scene;
use crate::mesh::lattice::{self, LatticePoint};
use crate::num::prism::{HEIGHT, MOST_HEIGHT, MOST_PLANE, OPEN, Prisms, area, child, local_corners, normal};
use rayon::prelude::*;

/// The prisms of the children of all splits of a scene, in their order.
pub fn scene_prisms(scene: &Scene) -> Vec<Prisms> {
    let (hierarchy, starts) = (scene.decode(), scene.level_starts());
    let mut all = vec![Prisms::default(); starts.splits()];
    let levels = scene.levels();
    // One tree after the other in parallel, each with the places of its splits.
    let groups: Vec<Vec<(usize, Prisms)>> = (0..scene.trees())
        .into_par_iter()
        .map(|tree| {
            let (lines, points) = (scene.tree_lines(tree), hierarchy.tree(tree));
            let at = |p| points[lattice::index(levels, p)];
            let nodes = (0..lines.depth.saturating_sub(1)).flat_map(|level| (0..1u32 << (2 * level)).map(move |node| (level, node)));
            nodes
                .map(|(level, node)| {
                    let p = lattice::node(levels, level, node);
                    (starts.split(lines, level, node as usize), node_prisms(p, levels - level - 1, &at))
                })
                .collect()
        })
        .collect();
    groups.into_iter().flatten().for_each(|(at, prisms)| all[at] = prisms);
    all
}

/// The five numbers of a child as fractions with one denominator: reach beyond each edge, height below and above.
struct Extents {
    most: [i64; 5],
    /// Of reaches; not above 0 for a triangle that has no normal.
    whole: i64,
}

fn dot(a: [i64; 3], b: [i64; 3]) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [i64; 3], b: [i64; 3]) -> [i64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Prisms of the children of the node with corners `p`, below each of which are `below` levels; `at` gives full-resolution vertices.
pub(crate) fn node_prisms(p: [LatticePoint; 3], below: u32, at: &impl Fn(LatticePoint) -> [i32; 3]) -> Prisms {
    let q = lattice::midpoints(p);
    let corners = [p[0], p[1], p[2], q[0], q[1], q[2]].map(at);
    let (local, shift) = local_corners(&corners);
    let extents: [Extents; 4] = std::array::from_fn(|k| {
        let l = child(&local, k);
        extents(l, corners[0], shift, lattice::child(p, k as u32), below, at) // k < 4
    });
    // Up to 2^53 times 2^16.
    let fits = |numbers: std::ops::Range<usize>, unit: i64, exponent: u32| {
        extents.iter().all(|e| numbers.clone().all(|j| code(e.most[j], e.whole * unit, shift, exponent) <= MOST_PLANE.into()))
    };
    let closed = extents.iter().all(|e| e.whole > 0);
    let reach = (0..OPEN).rev().find(|&exponent| closed && fits(0..3, 1, exponent + 1));
    let height = (0..=MOST_HEIGHT).rev().find(|&exponent| closed && fits(3..5, HEIGHT.into(), exponent));
    let (Some(reach), Some(height)) = (reach, height) else { return Prisms { reach: OPEN as u8, ..Prisms::default() } };
    let planes = std::array::from_fn(|k| {
        let e = &extents[k];
        let plane = |j: usize| match j {
            0..3 => code(e.most[j], e.whole, shift, reach + 1),
            _ => code(e.most[j], e.whole * i64::from(HEIGHT), shift, height),
        };
        std::array::from_fn(|j| plane(j) as u8) // at most 7
    });
    Prisms { planes, reach: reach as u8, height: height as u8 } // 3 and 4 bits
}

/// The least code for `most` / (`whole` 2^`shift`) in steps of 2^-`exponent`.
fn code(most: i64, whole: i64, shift: u32, exponent: u32) -> i128 {
    let whole = i128::from(whole) << shift;
    ((i128::from(most) << exponent) + whole - 1).div_euclid(whole.max(1))
}

/// What the vertices below a child with local corners `l`, places `p` and so many levels reach beyond it.
fn extents(
    l: [[i32; 3]; 3],
    origin: [i32; 3],
    shift: u32,
    p: [LatticePoint; 3],
    below: u32,
    at: &impl Fn(LatticePoint) -> [i32; 3],
) -> Extents {
    let wide = |v: [i32; 3]| v.map(i64::from);
    let (area, n) = (wide(area(l)), wide(normal(area(l))));
    let [e, f] = [l[1], l[2]].map(|c| [0, 1, 2].map(|k| i64::from(c[k] - l[0][k])));
    // The place of x is L0 + b1 e + b2 f + h n with b1 = x.(f x n) / whole, b2 = x.(n x e) / whole, h = x.(e x f) / whole.
    let (first, second, whole) = (cross(f, n), cross(n, e), dot(area, n));
    let from: [i64; 3] = std::array::from_fn(|c| i64::from(origin[c]) + (i64::from(l[0][c]) << shift));
    let mut most = [0; 5];
    for_each_below(p, below, |place| {
        let v = at(place);
        let x: [i64; 3] = std::array::from_fn(|c| i64::from(v[c]) - from[c]);
        let (b1, b2, height) = (dot(x, first), dot(x, second), dot(x, area));
        for (most, of) in most.iter_mut().zip([b1 + b2 - (whole << shift), -b1, -b2, -height, height]) {
            *most = of.max(*most);
        }
    });
    Extents { most, whole }
}

/// Calls `visit` with the place of every vertex of a triangle's subtree of so many levels.
fn for_each_below(p: [LatticePoint; 3], levels: u32, mut visit: impl FnMut(LatticePoint)) {
    let step = |to: LatticePoint| [(to.0, p[0].0), (to.1, p[0].1)].map(|(to, from)| (i64::from(to) - i64::from(from)) >> levels);
    let (along, across, many) = (step(p[1]), step(p[2]), 1i64 << levels);
    let place = |k: usize, from: u32, i: i64, j: i64| (i64::from(from) + i * along[k] + j * across[k]) as u32; // within the lattice
    for (i, j) in (0..=many).flat_map(|j| (0..=many - j).map(move |i| (i, j))) {
        visit((place(0, p[0].0, i, j), place(1, p[0].1, i, j)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Whether a vertex is in a child's prism with these codes, by a system of equations solved in whole numbers, with other determinants than fitting has.
    fn holds(l: [[i32; 3]; 3], origin: [i32; 3], shift: u32, v: [i32; 3], codes: [i128; 5], reach: u32, height: u32) -> bool {
        let [a, b, c] = l.map(|p| p.map(i128::from));
        let minus = |p: [i128; 3], q: [i128; 3]| [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
        let det = |p: [i128; 3], q: [i128; 3], r: [i128; 3]| {
            p[0] * (q[1] * r[2] - q[2] * r[1]) - p[1] * (q[0] * r[2] - q[2] * r[0]) + p[2] * (q[0] * r[1] - q[1] * r[0])
        };
        let n = normal(area(l)).map(|c| i128::from(HEIGHT) * i128::from(c));
        let (e, f) = (minus(b, a), minus(c, a));
        // x = b1 e + b2 f + h n, times 2^shift.
        let x: [i128; 3] = std::array::from_fn(|k| i128::from(v[k]) - i128::from(origin[k]) - (a[k] << shift));
        let whole = det(e, f, n);
        let [b1, b2, h] = [det(x, f, n), det(e, x, n), det(e, f, x)];
        let unit = whole << shift;
        let within = |number: i128, code: i128, exponent: u32| (number << exponent) <= code * unit;
        whole > 0
            && within(b1 + b2 - unit, codes[0], reach)
            && within(-b1, codes[1], reach)
            && within(-b2, codes[2], reach)
            && within(-h, codes[3], height)
            && within(h, codes[4], height)
    }

    proptest! {
        #[test]
        fn every_vertex_below_is_in_the_prism_and_no_code_can_be_less(
            corners in prop::array::uniform3(prop::array::uniform3(-1_000_000i32..1_000_000)),
            noise in prop::collection::vec(prop::array::uniform3(-1_000_000i32..1_000_000), 153),
            by in 0u32..18, levels in 2u32..5, flat in any::<bool>(),
        ) {
            let m = 1i64 << levels;
            let points: Vec<[i32; 3]> = {
                let mut points = vec![[0; 3]; lattice::len(levels)];
                for j in 0..=m {
                    for i in 0..=m - j {
                        let at = lattice::index(levels, (i as u32, j as u32));
                        points[at] = std::array::from_fn(|c| {
                            let even = ((m - i - j) * i64::from(corners[0][c]) + i * i64::from(corners[1][c]) + j * i64::from(corners[2][c])) / m;
                            if flat && c == 2 { 0 } else { even as i32 + (noise[at][c] >> by) }
                        });
                    }
                }
                points
            };
            let at = |place| points[lattice::index(levels, place)];
            let p = lattice::root(levels);
            let prisms = node_prisms(p, levels - 1, &at);
            let q = lattice::midpoints(p);
            let (local, shift) = local_corners(&[p[0], p[1], p[2], q[0], q[1], q[2]].map(at));
            prop_assume!(u32::from(prisms.reach) != OPEN);
            let (reach, height) = (u32::from(prisms.reach) + 1, u32::from(prisms.height));
            for k in 0..4 {
                let (l, codes) = (child(&local, k), prisms.planes[k].map(i128::from));
                let all = |codes: [i128; 5]| {
                    let mut all = true;
                    for_each_below(lattice::child(p, k as u32), levels - 1, |place| all &= holds(l, at(p[0]), shift, at(place), codes, reach, height));
                    all
                };
                prop_assert!(all(codes), "child {}: {:?}", k, prisms);
                for j in 0..5 {
                    let mut less = codes;
                    less[j] -= 1;
                    prop_assert!(codes[j] == 0 || !all(less), "child {}, plane {}: {:?}", k, j, prisms);
                }
            }
        }
    }
}
