//! What a context asks for in a cycle, and with which operands.

use super::context::Context;
use super::wires::{DIVIDE_FOR_V, DIVIDE_FOR_W};
use crate::block::tessellate::child_triangle;
use crate::block::{
    bary_map, child_test, hit_select, lod_test, lod_test_by, node_address, start_divide, start_setup, start_test, tessellate, tree_deciders,
};
use crate::format::{SplitRecord, VertexData, last_displacements};
use crate::hardware::ports::{Corners, HitOut, SceneConfig, SecondaryIn};
use crate::hardware::{Fetch, RayError, Resource, State};
use crate::num::{LineAddress, PADDING_BITS, Point, RayT, Start, U, VertexForm, Wire};

/// Zero bits at the bottom of every stored coordinate.
const PADDING: u64 = PADDING_BITS as u64;

impl Context {
    /// Tells `ask` every resource that the context asks for in this cycle.
    pub fn requests(&self, mut ask: impl FnMut(Resource)) {
        match self.state {
            State::Setup => ask(Resource::Setup),
            State::Fetch if self.want != 0 && self.error.is_none() => ask(Resource::Fetch),
            State::Child if self.waiting & 0b01 == 0 && self.error.is_none() => ask(Resource::Child),
            State::Decide => ask(Resource::Decide),
            State::Lod if self.chooses_levels => ask(Resource::Lod),
            State::Morph => ask(Resource::Morph),
            State::Tri if self.left.get().get() != 0 => ask(Resource::Tri),
            State::DivideV | State::DivideW => ask(Resource::Divide),
            State::Map => ask(Resource::Map),
            State::Done => ask(Resource::Hit),
            _ => (),
        }
    }

    /// Place of the line to send for next among those wanted: of a split the inserted vertices first.
    pub fn place_of(&self, want: u8) -> u16 {
        u16::from(want & 0b10 != 0 && (self.fetch.get() == Fetch::Split || want & 0b01 == 0))
    }

    /// Where the ray starts.
    fn start(&self) -> Start {
        Start { point: self.ray.origin, fraction: self.secondary.fraction }
    }

    /// Operands of `ray_setup` or `start_setup`.
    pub fn setup_in(&self) -> start_setup::In {
        start_setup::In { start: self.start(), direction: self.ray.direction }
    }

    /// Operands of `node_address`.
    pub fn fetch_in(&self, scene: &SceneConfig) -> node_address::In {
        let second = self.place_of(self.want) == 1;
        let record = |base: LineAddress, scale: u64| node_address::In {
            base,
            index: self.entry.get().index,
            scale: U::new(scale),
            low: U::new(u64::from(second)),
            ..node_address::In::default()
        };
        let of_tree = |base: LineAddress, start: U<28>, level: u64, node: u64| node_address::In {
            base,
            start,
            place: self.place,
            level: U::new(level),
            index: U::new(node),
            ..node_address::In::default()
        };
        let (level, node) = (self.level.get().get(), self.node.get().get());
        match self.fetch.get() {
            Fetch::Node => record(scene.nodes, 0),
            Fetch::Record => record(scene.records, u64::from(!scene.compact)),
            // Four siblings' compact vertices have two lines, short ones one, which lie as their parents' splits do. Only nodes below a root have such.
            Fetch::Split if second && scene.compact => node_address::In {
                scale: U::new(u64::from(!scene.short_splits)),
                low: U::new(if scene.short_splits { 0 } else { node / 2 % 2 }),
                ..of_tree(scene.vertices, scene.vertex_start(level), level.wrapping_sub(1) & 15, node / 4)
            },
            Fetch::Split if second => of_tree(scene.vertices, scene.vertex_start(level), level, node),
            Fetch::Split => of_tree(scene.splits, scene.split_start(level), level, node),
        }
    }

    /// Operands of `child_test`.
    pub fn child_in(&self) -> child_test::In {
        self.children_in()
    }

    /// Operands of `tree_deciders`.
    pub fn decide_in(&self) -> tree_deciders::In {
        let SecondaryIn { last, a0, a1, a2, by_second, .. } = self.secondary;
        let ([p0, p1, p2], tree) = (self.f.get(), self.tree.get());
        tree_deciders::In { last, a0, a1, a2, second: by_second, tree, p0, p1, p2 }
    }

    /// Operands of `lod_test` or `lod_test_by`.
    pub fn lod_in(&self, scene: &SceneConfig) -> lod_test_by::In {
        let ([p0, p1, p2], [e0, e1, e2]) = (self.p.get(), self.e);
        let SecondaryIn { first, second, .. } = self.secondary;
        lod_test_by::In { ray: self.ray, first, second, by: self.by, p0, p1, p2, e0, e1, e2, scale: scene.scale }
    }

    /// Operands of `tessellate`.
    pub fn morph_in(&self, scene: &SceneConfig) -> tessellate::In {
        let lod_test::Out { s0, s1, s2, .. } = self.lod.get();
        let ([f0, f1, f2], [p0, p1, p2], [e0, e1, e2]) = (self.f.get(), self.p.get(), self.e);
        let [v0, v1, v2] = self.inserted(scene);
        let zeros = scene.zeros.get();
        let (grid, padding) = (U::new(scene.levels.get() - self.level.get().get() - 1 + zeros), U::new(PADDING.saturating_sub(zeros)));
        let (compact, scale) = (scene.compact, scene.scale);
        tessellate::In { compact, grid, padding, scale, e0, e1, e2, s0, s1, s2, f0, f1, f2, p0, p1, p2, v0, v1, v2 }
    }

    /// What the line buffers hold of the node's inserted vertices: themselves, or of a compact model their displacements.
    fn inserted(&self, scene: &SceneConfig) -> [Point; 3] {
        if self.split_has_vertices(scene) {
            SplitRecord::line_displacements(&self.lines[0])
        } else if scene.compact {
            last_displacements(
                if scene.short_splits { VertexForm::Short } else { VertexForm::Compact },
                &self.lines[1],
                self.node.get().get() as usize,
            )
        } else {
            VertexData::from_words(&self.lines[1]).points().map(|point| self.kept(point))
        }
    }

    /// Corners of triangle `number`: of this node, or of its child of that number.
    pub fn triangle(&self, number: usize) -> [Point; 3] {
        let p = self.p.get();
        if self.four.get() { child_triangle(p, self.q.get(), number) } else { p }
    }

    /// Operands of `tri_test` or `start_test`.
    pub fn tri_in(&self) -> start_test::In {
        let [p0, p1, p2] = self.triangle(self.next.get().get() as usize); // two bits
        start_test::In { start: self.start(), direction: self.ray.direction, p0, p1, p2 }
    }

    /// What the context divides, and the operands of `hit_divide` or `start_divide`.
    pub fn divide_in(&self) -> (u16, start_divide::In) {
        let v = self.state == State::DivideV;
        (if v { DIVIDE_FOR_V } else { DIVIDE_FOR_W }, self.closest.divide_in(v))
    }

    /// Operands of `hit_select` for triangle `number`, whose front or back face was met at `t`.
    pub fn select_in(&self, scene: &SceneConfig, number: u16, t: RayT, front: bool) -> hit_select::In {
        let [tree, level, node] = self.triangle_id(number);
        let closest = &self.closest;
        hit_select::In {
            levels: scene.levels,
            known: closest.known.get(),
            best_t: closest.t_max.get(),
            best_front: closest.front.get(),
            best_id: closest.id.get(),
            t,
            front,
            tree: U::new(tree),
            level: U::new(level),
            node: U::new(node),
        }
    }

    /// Operands of `bary_map`.
    pub fn map_in(&self, scene: &SceneConfig) -> bary_map::In {
        self.closest.map_in(scene.levels)
    }

    /// The ray's hit, once it is done, and where rays can start there the corners of its triangle.
    pub fn hit_out(&self) -> (HitOut, Corners) {
        let error = RayError::code(self.error);
        match self.closest.hit().filter(|_| self.error.is_none()) {
            Some(hit) => (HitOut { tag: self.tag, error, found: true, hit }, self.closest.corners),
            None => (HitOut { tag: self.tag, error, ..HitOut::default() }, Corners::default()),
        }
    }
}
