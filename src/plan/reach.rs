//! How deep the rays of a job can go down each tree.

use super::rays::refines;
use super::region::{Tolerance, UnitBox};
use crate::block::Block;
use crate::block::bound_decode::{self, BoundDecode};
use crate::block::ray_setup::{self, RaySetup};
use crate::format::{BvhNode, ChildRef, Job, JobRegion, Scene, SceneError};
use crate::method::{bvh_boxes, bvh_children};
use crate::num::{BOX_SHIFT, BoundCode, Box16, MAX_LEVELS, Ray, RayT};
use crate::rays::{ModelSpace, RaySource};
use rayon::prelude::*;
use std::sync::atomic::{AtomicU32, Ordering};

/// A scene, and how deep rays have been found to go down its trees.
pub struct Reach<'a> {
    scene: &'a Scene,
    trees: Vec<Tree>,
}

/// What bounds the way of rays down a tree.
struct Tree {
    /// Box of all its vertices: all its triangles, morphed or not, lie in it.
    lo: [i32; 3],
    hi: [i32; 3],
    /// Largest code of each level. None is above those of the level before.
    codes: [u8; MAX_LEVELS as usize],
    /// Levels that are stored.
    depth: u32,
    /// The deepest level that a ray can go down to.
    reached: AtomicU32,
}

impl Tree {
    fn of(scene: &Scene, tree: usize) -> Self {
        let (depth, corners) = (scene.tree_lines(tree).depth, scene.corners(tree));
        let [mut lo, mut hi] = [corners[0]; 2];
        let mut codes = [0; MAX_LEVELS as usize];
        let mut vertex = |p: [i32; 3]| {
            for k in 0..3 {
                (lo[k], hi[k]) = (lo[k].min(p[k]), hi[k].max(p[k]));
            }
        };
        corners.into_iter().for_each(&mut vertex);
        scene.each_node(tree, depth, &mut |(level, node), _, q| {
            q.into_iter().for_each(&mut vertex);
            let most = scene.node_codes(tree, level, node).into_iter().max().unwrap_or(0);
            codes[level as usize] = codes[level as usize].max(most);
        });
        Self { lo, hi, codes, depth, reached: AtomicU32::new(0) }
    }
}

impl<'a> Reach<'a> {
    /// A scene that no ray was sent at.
    pub fn of(scene: &'a Scene) -> Self {
        Self { scene, trees: (0..scene.trees()).into_par_iter().map(|tree| Tree::of(scene, tree)).collect() }
    }

    /// The rays of `source` at quality `delta`: each goes to every tree whose box it meets, whatever is hit before.
    pub fn add(&self, source: &dyn RaySource, delta: f64) {
        let space = ModelSpace::of(self.scene);
        (0..source.batches()).into_par_iter().for_each(|batch| {
            source.batch(batch, &mut |_, query| {
                if let Some(entered) = space.enter(query, delta) {
                    self.ray(&entered.ray);
                }
            });
        });
    }

    /// All rays of a region: each, too, goes to every tree whose box it meets. Those of a region that is none ([`JobRegion::wrong`]) go all the way down.
    pub fn add_region(&self, region: &JobRegion) {
        let tolerance = Tolerance::of(&ModelSpace::of(self.scene), region);
        let scale = self.scene.meta().bound_scale();
        let units = |code: u8| BoundDecode::eval(&bound_decode::In { code: BoundCode::new(code.into()), scale }).h.get() as f64; // 33 bits
        self.scene.nodes().par_iter().for_each(|line| {
            for (slot, bounds) in bvh_boxes(line).into_iter().enumerate() {
                let child = BvhNode::line_child(line, slot);
                if child.kind.get() != ChildRef::INNER && child.kind.get() != ChildRef::EMPTY {
                    let tree = &self.trees[child.index.get() as usize]; // 28 bits
                    let own = [tree.lo, tree.hi].map(|corner| corner.map(f64::from));
                    let tolerated = tolerance.as_ref().map_or(0.0, |tolerance| tolerance.at(own, in_units(bounds)));
                    tree.reached.fetch_max(
                        tree.codes[..tree.depth as usize].iter().take_while(|&&code| units(code) > tolerated).count() as u32,
                        Ordering::Relaxed,
                    ); // at most 10
                }
            }
        });
    }

    /// The deepest level of all trees that any of the rays can go down to.
    pub fn deepest(&self) -> u32 {
        self.depths().into_iter().max().unwrap_or(0)
    }

    /// For each tree the deepest level that any of the rays can go down to.
    pub fn depths(&self) -> Vec<u32> {
        self.trees.iter().map(|tree| tree.reached.load(Ordering::Relaxed)).collect()
    }

    /// The scene without what none of the rays goes down to, which are those of `job`. As it is, it serves any ray.
    ///
    /// # Errors
    /// Memory cannot be had.
    pub fn pruned(&self, job: Job) -> Result<Scene, SceneError> {
        let depths = self.depths();
        let unshaded = job.unshaded;
        let job = if depths == self.scene.depths() { Job { unshaded, ..Job::default() } } else { job };
        self.scene.pruned(&depths, job)
    }

    fn ray(&self, ray: &Ray) {
        let setup = RaySetup::eval(&ray_setup::In { origin: ray.origin, direction: ray.direction });
        let nodes = self.scene.nodes();
        let mut open = vec![0];
        while let Some(node) = open.pop() {
            let line = &nodes[node];
            let tests = bvh_children(&setup, RayT::MAX, line);
            for slot in &tests.order[..tests.count.get() as usize] {
                let child = BvhNode::line_child(line, slot.get() as usize); // two bits
                let index = child.index.get() as usize; // 28 bits
                if child.kind.get() == ChildRef::INNER { open.push(index) } else { self.tree(&self.trees[index], ray) }
            }
        }
    }

    /// A ray in the box of a tree. Where it refines some level's largest code it refines those of the levels above, which are no smaller.
    fn tree(&self, tree: &Tree, ray: &Ray) {
        let scale = self.scene.meta().bound_scale();
        let mut level = tree.reached.load(Ordering::Relaxed);
        while level < tree.depth && refines(ray, [tree.lo, tree.hi], scale, tree.codes[level as usize]) {
            level += 1;
        }
        tree.reached.fetch_max(level, Ordering::Relaxed);
    }
}

/// A box of codes in units.
fn in_units(bounds: Box16) -> UnitBox {
    let units = f64::from(1u32 << BOX_SHIFT);
    [bounds.lo.get(), bounds.hi.get()].map(|corner| corner.map(|code| code as f64 * units)) // 16 bits
}
