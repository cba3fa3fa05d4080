//! The steps of a coarse grid of rays, for a report in which one clicks on a picture and sees what its ray did.
//!
//! A ray's steps are words with a space between; each is an act, and behind `@` the lines that it asks for (section, number of the first line, how many).
//! `*` before a word: a node's visit begins. `+` before the lines: asked for together with those of the step before; `=`: written.
//!
//! | word | act |
//! |---|---|
//! | `f` | lines alone |
//! | `k0:5` | five operations of the method's own, of its number 0 |
//! | `c2`, `p2`, `l2`, `w2` | four children tested, 2 of them met: boxes of levels of detail, stored boxes of 16 bits, the same in steps from their node's corner, stored boxes of 32 bits |
//! | `g2` | four children of a tree's node tested by their prisms, 2 of them met |
//! | `b2` | six children tested, 2 of them met |
//! | `y` | which ray decides in the tree that is entered |
//! | `r2.17:0.128.256` | LOD test of level 2 node 17 with these edge states of 256: refine |
//! | `s2.17` | the same: its triangle serves |
//! | `t` | the inserted vertices are morphed |
//! | `x4:5` | four triangles tested, bits 5 of them met |
//! | `o`, `d` | a node is taken from the stack, and visited, or dropped behind the closest hit |
//! | `h`, `m`, `n` | the end: a hit; a hit that is mapped to full resolution; nothing |
//!
//! Level, node and edge states are left out where the traversal unit does not know them.

use super::error_time::{TraceGrid, TracedHit, TracedRay};
use crate::format::Scene;
use crate::hardware::Hardware;
use crate::method::lod::{self, LodImage};
use crate::method::{Method, Registered, Tracer};
use crate::num::Ray;
use crate::rays::{Camera, ModelSpace, Query, Sight};
use crate::sim::unit::ray_trace::{RayTrace, TraceEvent};
use crate::sim::unit::wave::one_ray;
use crate::sim::unit::{SceneMemory, TraversalUnit};
use crate::step::{Act, Fetch, Step, StepSink};
use rayon::prelude::*;
use std::fmt::Write;

/// Cycles to a memory line; the steps do not depend on it.
const LATENCY: u32 = 1;

/// What a grid of rays is of.
pub struct Subject<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its file, as commands name it.
    pub file: &'a str,
    /// The method.
    pub registered: &'a Registered,
    /// The same as it was made for the scene.
    pub method: &'a dyn Method,
    /// Quality of its level of detail.
    pub delta: f64,
    /// The camera.
    pub camera: &'a Camera,
}

/// What an LOD test was of, and its edge states.
struct Edges {
    level: u64,
    node: u64,
    states: [u64; 3],
}

/// Steps as words.
struct Words<'a> {
    text: String,
    edges: std::slice::Iter<'a, Edges>,
}

impl StepSink for Words<'_> {
    fn step(&mut self, step: Step) {
        let edges = matches!(step.act, Act::LodTest { .. }).then(|| self.edges.next()).flatten();
        let text = &mut self.text;
        if !text.is_empty() {
            text.push(' ');
        }
        if step.visits {
            text.push('*');
        }
        // Text takes all that is written to it.
        let _ = act(text, step.act, edges).and_then(|()| step.fetch.map_or(Ok(()), |fetch| lines(text, &fetch)));
    }
}

fn act(text: &mut String, act: Act, edges: Option<&Edges>) -> std::fmt::Result {
    match act {
        Act::Fetch => write!(text, "f"),
        Act::Children { shape, met } => write!(text, "{}{met}", shape.facts().letter),
        Act::Work { work, count } => write!(text, "k{work}:{count}"),
        Act::Decide => write!(text, "y"),
        Act::LodTest { refine } => {
            text.push(if refine { 'r' } else { 's' });
            let Some(Edges { level, node, states: [s0, s1, s2] }) = edges else { return Ok(()) };
            write!(text, "{level}.{node}")?;
            if refine { write!(text, ":{s0}.{s1}.{s2}") } else { Ok(()) }
        }
        Act::Tessellate => write!(text, "t"),
        Act::Triangles { count, hits } => write!(text, "x{count}:{hits}"),
        Act::Pop { dropped } => write!(text, "{}", if dropped { 'd' } else { 'o' }),
        Act::End { found: 0, .. } => write!(text, "n"),
        Act::End { mapped, .. } => write!(text, "{}", if mapped { 'm' } else { 'h' }),
    }
}

fn lines(text: &mut String, fetch: &Fetch) -> std::fmt::Result {
    let Fetch { section, line, lines, joins, stores, .. } = *fetch;
    write!(text, "@{}{}{}.{line}.{lines}", if joins { "+" } else { "" }, if stores { "=" } else { "" }, section.place())
}

/// The steps of rays in the middles of `grid` cells of the picture, columns and rows; at most one for each pixel. The caller fills in `view` and `setting`.
pub fn rays(subject: &Subject<'_>, grid: [u32; 2]) -> TraceGrid {
    let Subject { scene, registered, method, camera, .. } = *subject;
    let size = [camera.width, camera.height];
    let grid: [u32; 2] = std::array::from_fn(|k| grid[k].clamp(1, size[k]));
    let space = ModelSpace::of(scene);
    let sight = Sight::new(camera, &space, subject.delta);
    let map = method.map(&sight);
    let memory = (registered.name == lod::METHOD.name).then(|| SceneMemory::new(LodImage::of(scene), 0));
    // The middle of a cell, in pixels: below the picture's size.
    let middle = |cell: u32, k: usize| (u64::from(2 * cell + 1) * u64::from(size[k]) / (2 * u64::from(grid[k]))) as u32;
    let pixels: Vec<[u32; 2]> = (0..grid[1]).flat_map(|row| (0..grid[0]).map(move |column| [middle(column, 0), middle(row, 1)])).collect();
    let one = |tracer: &mut Box<dyn Tracer + '_>, pixel: &[u32; 2]| {
        let query = camera.ray(pixel[0], pixel[1]);
        let edges = memory.as_ref().map_or_else(Vec::new, |memory| edges(memory, &space, &query, subject.delta));
        let mut words = Words { text: String::new(), edges: edges.iter() };
        let hit = tracer.heard(&query, &mut words);
        let hit = hit.map(|hit| TracedHit { tree: hit.tree, level: u32::from(hit.level), node: hit.node, distance: hit.distance });
        TracedRay { pixel: *pixel, hit, steps: words.text }
    };
    let rays = pixels.par_iter().map_init(|| method.tracer(&sight), one).collect();
    TraceGrid {
        view: 0,
        method: registered.name.to_owned(),
        setting: String::new(),
        size,
        grid,
        sections: map.sections().map(|(_, section)| section.name.to_owned()).collect(),
        command: memory.is_some().then(|| command(subject)),
        rays,
    }
}

/// The LOD tests of a ray, in their order, from the cycle model.
fn edges(memory: &SceneMemory<'_>, space: &ModelSpace, query: &Query, delta: f64) -> Vec<Edges> {
    let Some(entered) = space.enter(query, delta) else { return Vec::new() };
    let ray: Ray = entered.ray;
    let mut trace = RayTrace::new(TraversalUnit::new(Hardware::one_context(), memory.config()), memory);
    // A unit that cannot go on has told its edges so far.
    let _ = one_ray(&mut trace, memory, LATENCY, &ray);
    let edges = |event: &TraceEvent| match *event {
        TraceEvent::Edges { level, node, s, .. } => Some(Edges { level, node, states: s }),
        _ => None,
    };
    trace.events().iter().filter_map(|(_, event)| edges(event)).collect()
}

/// The command that follows a ray of the camera, but for its pixel.
fn command(subject: &Subject<'_>) -> String {
    let Camera { eye, target, up, fov, width, height, .. } = *subject.camera;
    let vector = |v: [f64; 3]| v.map(|c| c.to_string()).join(",");
    let [eye, target, up] = [eye, target, up].map(|v| vector(v.to_array()));
    let (file, delta) = (quoted(subject.file), subject.delta);
    format!(
        "lodray trace {file} --delta {delta} --size {width}x{height} --eye {eye} --target {target} --up {up} --fov {fov} --text --pixel"
    )
}

/// A word of a shell.
fn quoted(word: &str) -> String {
    let is_plain = !word.is_empty() && word.chars().all(|c| c.is_ascii_alphanumeric() || "._-/+=:,@".contains(c));
    if is_plain { word.to_owned() } else { format!("'{}'", word.replace('\'', "'\\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::step::{NodeShape, SectionId};

    #[test]
    fn steps_are_written_as_the_table_says() {
        let edges = [Edges { level: 2, node: 17, states: [0, 128, 256] }, Edges { level: 3, node: 4, states: [0; 3] }];
        let mut words = Words { text: String::new(), edges: edges.iter() };
        let fetch = Fetch::new(SectionId::new(1), 40, 2);
        let steps = [
            Step::on(fetch, Act::Children { shape: NodeShape::Tree, met: 2 }).visiting(),
            Step::on(fetch.joining(), Act::Fetch),
            Step::of(Act::LodTest { refine: true }),
            Step::of(Act::Tessellate),
            Step::of(Act::LodTest { refine: false }),
            Step::of(Act::LodTest { refine: false }),
            Step::of(Act::Triangles { count: 4, hits: 5 }),
            Step::of(Act::Pop { dropped: false }),
            Step::of(Act::Pop { dropped: true }),
            Step::on(fetch, Act::Fetch),
            Step::of(Act::Children { shape: NodeShape::Plain, met: 0 }),
            Step::of(Act::Children { shape: NodeShape::Local, met: 1 }),
            Step::of(Act::Children { shape: NodeShape::Wide, met: 4 }),
            Step::of(Act::Children { shape: NodeShape::Pair, met: 2 }),
            Step::of(Act::Children { shape: NodeShape::Prisms, met: 3 }),
            Step::of(Act::Children { shape: NodeShape::Six, met: 6 }),
            Step::of(Act::Children { shape: NodeShape::Turned, met: 5 }),
            Step::on(fetch.storing(), Act::Fetch),
            Step::of(Act::Work { work: 0, count: 5 }),
            Step::end(true, true),
            Step::end(true, false),
            Step::end(false, true),
        ];
        steps.into_iter().for_each(|step| words.step(step));
        assert_eq!(words.text, "*c2@1.40.2 f@+1.40.2 r2.17:0.128.256 t s3.4 s x4:5 o d f@1.40.2 p0 l1 w4 z2 g3 b6 e5 f@=1.40.2 k0:5 m h n");
    }

    #[test]
    fn files_are_words_of_a_shell() {
        assert_eq!([quoted("a/b-1.lod"), quoted("a b.lod"), quoted("it's")], ["a/b-1.lod", "'a b.lod'", "'it'\\''s'"]);
    }
}
