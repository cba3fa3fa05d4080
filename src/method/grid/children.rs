//! The children of a node of a primitive's tree against a ray, by whatever bounds them.

use super::asked::{Lines, ask, is_heard};
use super::bounds::Bounds;
use super::mesh::GridMesh;
use super::sphere::{SphereRay, Spheres};
use super::tuple::Tuple;
use super::works::{INDEX, SORT, SPHERE};
use crate::block::child_boxes::Corners;
use crate::block::{child_test, ray_setup};
use crate::method::HitSink;
use crate::method::children::{Split, bvh_children, prism_children};
use crate::num::prism::child;
use crate::num::{Point, Ray, Start};
use crate::step::{Act, NodeShape, Step, StepSink};

/// A ray as all tests take it.
pub struct Shot<'a> {
    /// As it came.
    pub ray: &'a Ray,
    /// Where it starts exactly, if it leaves a surface.
    pub start: Start,
    /// For boxes and prisms.
    pub setup: ray_setup::Out,
    /// For spheres.
    pub spheres: SphereRay,
}

/// Children of a node that are met, nearest first, as (near, child), and how many.
pub type Found = ([(f64, usize); 4], usize);

/// Tests the bounds of a node's children.
#[inline(always)]
pub fn children<S: StepSink, H: HitSink>(
    mesh: &GridMesh,
    shot: &Shot<'_>,
    primitive: usize,
    tuple: &Tuple,
    node: usize,
    steps: &mut S,
    sink: &H,
) -> Found {
    let group = mesh.group(primitive, node);
    if let Bounds::Boxes(lines) = &mesh.bounds {
        let tests = bvh_children(&shot.setup, sink.t_max(), &lines[group]);
        steps.step(Step::on(mesh.group_fetch(group), Act::Children { shape: NodeShape::Local, met: tests.met() }).visiting());
        return of_tests(&tests);
    }
    let own = mesh.pattern.node(node);
    if is_heard::<S>() {
        let mut lines = Lines::new();
        let bounds = mesh.group_fetch(group);
        (bounds.line..bounds.line + bounds.lines).for_each(|line| lines.add(bounds.section, line));
        own.iter().for_each(|&vertex| ask(mesh, primitive, tuple, vertex, &mut lines));
        steps.step(Step::of(Act::Work { work: INDEX, count: 6 }));
        lines.state(true, steps);
    }
    let points = own.map(|vertex| mesh.vertex(primitive, tuple, vertex));
    match &mesh.bounds {
        Bounds::Spheres(radii) => {
            steps.step(Step::of(Act::Work { work: SPHERE, count: 4 }));
            steps.step(Step::of(Act::Work { work: SORT, count: 1 }));
            spheres(shot, sink, &points, radii[group])
        }
        Bounds::Prisms(prisms) => {
            let [p0, p1, p2, q0, q1, q2] = points.map(Point::from_i32);
            let corners = Corners::of([p0, p1, p2], [q0, q1, q2]);
            let tests = prism_children(&shot.setup, sink.t_max(), &prisms[group], &Split { full: corners, morphed: corners });
            steps.step(Step::of(Act::Children { shape: NodeShape::Prisms, met: tests.met() }));
            of_tests(&tests)
        }
        Bounds::Boxes(_) => unreachable!("tested above"),
    }
}

/// What tests by blocks say.
#[inline(always)]
fn of_tests(tests: &child_test::Out) -> Found {
    let at = |place: usize| {
        let k = tests.order[place].get() as usize;
        // In steps of 2^-14 of t: exact.
        (tests.t_near[k].get() as f64 * 2f64.powi(-14), k)
    };
    ([0, 1, 2, 3].map(at), tests.count.get() as usize)
}

/// Tests spheres.
#[inline(always)]
fn spheres<H: HitSink>(shot: &Shot<'_>, sink: &H, points: &[[i32; 3]; 6], radii: [f32; 4]) -> Found {
    let points = points.map(|p| p.map(f64::from));
    let mut tested = Spheres { radii, ..Spheres::default() };
    for k in 0..4 {
        let [a, b, c] = child(&points, k);
        for axis in 0..3 {
            // Exact: below 2^33.
            tested.sums[axis][k] = a[axis] + b[axis] + c[axis];
        }
    }
    let met = shot.spheres.test(sink.t_max(), &tested);
    let (mut sorted, mut count) = ([(0.0, 0); 4], 0);
    for k in (0..4).filter(|&k| met.hit[k]) {
        let mut at = count;
        while at > 0 && sorted[at - 1].0 > met.near[k] {
            sorted[at] = sorted[at - 1];
            at -= 1;
        }
        sorted[at] = (met.near[k], k);
        count += 1;
    }
    (sorted, count)
}
