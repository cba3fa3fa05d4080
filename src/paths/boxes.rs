//! Which models a ray may meet: a tree over their boxes, four children a node.

use glam::DVec3;

/// A box around a model, in the scene.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub lo: DVec3,
    pub hi: DVec3,
}

impl Bounds {
    /// The smallest box around points, and a little more: as much as sums of their sizes and places are rounded by, many times over. Its planes are floats of 32 bits, as nodes have them.
    pub fn around(points: impl IntoIterator<Item = DVec3>) -> Self {
        let start = Self { lo: DVec3::INFINITY, hi: DVec3::NEG_INFINITY };
        let all = points.into_iter().fold(start, |all, p| Self { lo: all.lo.min(p), hi: all.hi.max(p) });
        let more = 1e-9 * (all.lo.abs().max(all.hi.abs()) + (all.hi - all.lo)).max_element();
        Self { lo: floor32(all.lo - more), hi: -floor32(-(all.hi + more)) }
    }

    fn with(self, other: Self) -> Self {
        Self { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// Where a ray enters it, if that is not beyond `t_max`.
    fn entered(&self, origin: DVec3, inverse: DVec3, t_max: f64) -> Option<f64> {
        let (mut near, mut far) = (0.0f64, t_max);
        for k in 0..3 {
            if inverse[k].is_infinite() {
                if origin[k] < self.lo[k] || origin[k] > self.hi[k] {
                    return None;
                }
                continue;
            }
            let (a, b) = ((self.lo[k] - origin[k]) * inverse[k], (self.hi[k] - origin[k]) * inverse[k]);
            near = near.max(a.min(b));
            far = far.min(a.max(b));
        }
        // Both are rounded.
        (near <= far * (1.0 + 1e-12)).then_some(near)
    }
}

/// Rounded down to floats of 32 bits.
fn floor32(p: DVec3) -> DVec3 {
    DVec3::from_array(p.to_array().map(|v| {
        let near = v as f32;
        f64::from(if f64::from(near) > v { near.next_down() } else { near })
    }))
}

/// What stands below a node.
#[derive(Clone, Copy, Debug)]
enum Below {
    Model(usize),
    Node(usize),
}

/// What a ray does in the tree.
#[derive(Clone, Copy, Debug)]
pub(super) enum Walk {
    /// It tests the children of a node, and enters so many of their boxes.
    Node { node: usize, met: u32 },
    /// It takes what waits; `dropped` if that lies behind what it has met.
    Pop { dropped: bool },
    /// It comes to a model.
    Model(usize),
}

/// Children of a node.
const WIDTH: usize = 4;

/// The tree; its root is node 0.
#[derive(Clone, Debug)]
pub(super) struct BoxTree {
    nodes: Vec<Vec<(Bounds, Below)>>,
}

impl BoxTree {
    /// Over some boxes, at least one.
    pub fn new(boxes: &[Bounds]) -> Self {
        let mut tree = Self { nodes: Vec::new() };
        let mut order: Vec<usize> = (0..boxes.len()).collect();
        tree.node(boxes, &mut order);
        tree
    }

    /// How many nodes it has.
    pub fn nodes(&self) -> usize {
        self.nodes.len()
    }

    /// A node over these boxes, and all below it.
    fn node(&mut self, boxes: &[Bounds], order: &mut [usize]) -> usize {
        let own = self.nodes.len();
        self.nodes.push(Vec::with_capacity(WIDTH));
        let (lower, upper) = halve(boxes, order);
        for half in [lower, upper] {
            let (lower, upper) = halve(boxes, half);
            for part in [lower, upper] {
                let Some(bounds) = part.iter().map(|&model| boxes[model]).reduce(Bounds::with) else { continue };
                let below = if let [model] = *part { Below::Model(model) } else { Below::Node(self.node(boxes, part)) };
                self.nodes[own].push((bounds, below));
            }
        }
        own
    }

    /// Tells `on` what the ray does, nearest first; it answers a model with the distance beyond which nothing is wanted any more: none at all, if that is minus infinity.
    pub fn each(&self, origin: DVec3, direction: DVec3, mut t_max: f64, mut on: impl FnMut(Walk) -> Option<f64>) {
        let inverse = direction.recip();
        let mut waiting: Vec<(f64, Below)> = Vec::new();
        let mut next = Some(Below::Node(0));
        while t_max > f64::NEG_INFINITY {
            match next.take() {
                Some(Below::Model(model)) => t_max = on(Walk::Model(model)).unwrap_or(t_max),
                Some(Below::Node(node)) => {
                    let entered = |&(bounds, below): &(Bounds, Below)| Some((bounds.entered(origin, inverse, t_max)?, below));
                    let first = waiting.len();
                    waiting.extend(self.nodes[node].iter().filter_map(entered));
                    on(Walk::Node { node, met: (waiting.len() - first) as u32 }); // at most four
                    waiting[first..].sort_by(|a, b| b.0.total_cmp(&a.0));
                    // The nearest goes on at once.
                    next = if waiting.len() > first { waiting.pop().map(|(_, below)| below) } else { None };
                }
                None => {
                    let Some((near, below)) = waiting.pop() else { break };
                    on(Walk::Pop { dropped: near > t_max });
                    next = (near <= t_max).then_some(below);
                }
            }
        }
    }
}

/// Halves at the middle of the longest side of the box of all centres; of one, or none, there is no other half.
fn halve<'a>(boxes: &[Bounds], order: &'a mut [usize]) -> (&'a mut [usize], &'a mut [usize]) {
    let centre = |model: usize| boxes[model].lo + boxes[model].hi;
    let of_centres = order.iter().map(|&model| Bounds { lo: centre(model), hi: centre(model) }).reduce(Bounds::with);
    let sides = of_centres.map_or(DVec3::ZERO, |all| all.hi - all.lo);
    let axis = (0..3).rev().max_by(|&a, &b| sides[a].total_cmp(&sides[b])).unwrap_or(0);
    let half = order.len().div_ceil(2);
    if half < order.len() {
        order.select_nth_unstable_by(half, |&a, &b| centre(a)[axis].total_cmp(&centre(b)[axis]).then(a.cmp(&b)));
    }
    order.split_at_mut(half)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers from 0 to 1, the same every time.
    fn numbers(mut state: u64) -> impl FnMut() -> f64 {
        move || {
            state = state.wrapping_mul(0x5851_F42D_4C95_7F2D).wrapping_add(0x1405_7B7E_F767_814F);
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    #[test]
    fn every_box_that_a_ray_enters_is_visited_once_and_no_other() {
        let mut next = numbers(1);
        for count in [1, 2, 3, 16, 200] {
            let mut point = |of: f64| DVec3::new(next() - 0.5, next() - 0.5, next() - 0.5) * of;
            let boxes: Vec<_> = (0..count).map(|_| point(10.0)).map(|at| Bounds::around([at, at + DVec3::splat(0.7)])).collect();
            let tree = BoxTree::new(&boxes);
            let (mut visits, mut early) = (0, 0);
            for ray in 0..500 {
                let (origin, mut direction) = (point(12.0), point(1.0));
                direction[ray % 4 % 3] *= f64::from(u8::from(ray % 4 != 3));
                let t_max = if ray % 2 == 0 { f64::INFINITY } else { 8.0 };
                let mut seen = Vec::new();
                tree.each(origin, direction, t_max, |walk| {
                    let Walk::Model(model) = walk else { return None };
                    seen.push(model);
                    Some(t_max)
                });
                let near = |model: usize| boxes[model].entered(origin, direction.recip(), t_max);
                visits += seen.len();
                // By points along the ray, with all of the axes that it does not leave.
                let inside = |model: usize, t: f64| {
                    let p = origin + direction * t;
                    (boxes[model].lo.cmple(p) & p.cmple(boxes[model].hi)).all()
                };
                for model in 0..count {
                    let met = (0..800).any(|step| inside(model, f64::from(step) * 0.05) && f64::from(step) * 0.05 <= t_max);
                    assert!(!met || seen.contains(&model), "{model} of {count} is left out");
                }
                let mut ordered = seen.clone();
                ordered.sort_unstable();
                ordered.dedup();
                assert_eq!(ordered.len(), seen.len());
                // If nothing is wanted behind the nearest that was found, the nearest of all is found.
                let (mut fewer, mut nearest) = (0, f64::INFINITY);
                tree.each(origin, direction, t_max, |walk| {
                    let Walk::Model(model) = walk else { return None };
                    fewer += 1;
                    nearest = nearest.min(near(model).unwrap_or(0.0));
                    Some(nearest)
                });
                assert_eq!(nearest, seen.iter().filter_map(|&model| near(model)).fold(f64::INFINITY, f64::min));
                early += usize::from(fewer < seen.len());
            }
            assert!(visits > 0 || count < 16, "{count}: {visits}");
            assert!(early > 0 || count < 16, "{count}: {early}");
        }
    }
}
