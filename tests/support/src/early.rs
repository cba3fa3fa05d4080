//! Rays that end early, one way each, and what comes behind them: on the cycle model alone, or with its RTL beside it.

use crate::hardware::{FULL_DETAIL, ray_for, scene_for};
use crate::hostile::{Exposed, everywhere};
use crate::models::{any_rays, ball, terrain, with_vertices};
use crate::plain::plain;
use lodray::format::{BvhNode, ChildRef, L0Record, Scene, SplitRecord, VertexData};
use lodray::golden::exact::Exact;
use lodray::hardware::ports::{AnswerLimit, Behind, HitOut, MemoryAnswer, MemoryRequest, RayIn, SceneConfig, SecondaryIn};
use lodray::hardware::{Hardware, RayError};
use lodray::mesh::Hierarchy;
use lodray::method::lod::LodImage;
use lodray::num::{BoundScale, COORD_LIMIT, Cone, Ray, S, U, Vec3, VertexForm, Wire};
use lodray::sim::unit::{Inputs, SceneMemory};

type Line = [U<64>; 4];

/// Cycles from a request to its answer: so many that a line of a ray that ended early comes when the next one waits for its own.
const LATENCY: u64 = 60;
/// Cycles after which a line may be late, less one.
const LIMIT: u64 = 300;

/// A scene, and rays that meet it.
struct Desk {
    config: Hardware,
    scene: Scene,
    rays: Vec<Ray>,
}

impl Desk {
    fn of(config: Hardware, h: Hierarchy) -> Self {
        let scene = scene_for(&config, &h);
        let rays = any_rays(&h, 60, 1).iter().enumerate().map(|(k, ray)| ray_for(&config, ray, k)).collect();
        let mut desk = Self { config, scene, rays };
        let decoded = desk.scene.decode();
        let golden = Exact::new(&decoded);
        desk.rays.retain(|ray| golden.trace(ray).is_some_and(|hit| hit.level > 1));
        assert!(desk.rays.len() > 3, "only {} rays go down", desk.rays.len());
        // Those of full detail first.
        desk.rays.sort_by_key(|ray| ray.cone != Cone::default());
        desk
    }

    fn memory(&self) -> SceneMemory<'_> {
        SceneMemory::new(LodImage::of(&self.scene), 77)
    }

    fn scene(&self) -> SceneConfig {
        SceneConfig { answer_limit: AnswerLimit::new(LIMIT), ..self.memory().config() }
    }
}

/// Lines on their way, with the cycles from which on they come, and how long one takes.
struct Due {
    now: u64,
    latency: u64,
    lines: Vec<(u64, MemoryAnswer)>,
}

impl Default for Due {
    fn default() -> Self {
        Self { now: 0, latency: LATENCY, lines: Vec::new() }
    }
}

/// One cycle of a memory that makes of a line what `of` says: the hit that is taken, and whether the ray was.
fn cycle<E: Exposed>(
    unit: &mut E,
    ray: Option<RayIn>,
    flush: bool,
    due: &mut Due,
    of: &mut impl FnMut(&MemoryRequest) -> Option<(Line, bool)>,
) -> (Option<HitOut>, bool) {
    let outputs = unit.outputs();
    let at = due.lines.iter().position(|(when, _)| *when <= due.now);
    let answer = at.map(|at| due.lines.remove(at).1);
    if let Some(request) = outputs.mem
        && let Some((line, error)) = of(&request)
    {
        due.lines.push((due.now + due.latency, MemoryAnswer { tag: request.tag, epoch: request.epoch, error, line }));
    }
    unit.tick(&Inputs { ray, hit_ready: true, mem_ready: true, answer, flush, secondary: SecondaryIn::primary() });
    due.now += 1;
    (outputs.hit, outputs.ready && ray.is_some())
}

/// Traces a ray; its hit, and the cycles to it. `flush` is the cycle in which the unit is flushed.
fn trace<E: Exposed>(
    unit: &mut E,
    ray: &Ray,
    due: &mut Due,
    flush: Option<u64>,
    mut of: impl FnMut(&MemoryRequest) -> Option<(Line, bool)>,
) -> (HitOut, u64) {
    let mut offered = Some(RayIn { tag: U::new(5), ray: *ray });
    for now in 0..100_000 {
        let (hit, taken) = cycle(unit, offered, flush == Some(now), due, &mut of);
        if taken {
            offered = None;
        }
        if let Some(hit) = hit {
            assert_eq!(hit.tag.get(), 5);
            return (hit, now);
        }
    }
    panic!("the ray has no end: {}", unit.describe());
}

/// The ray's hit with the memory as it is, which must be the golden one.
fn right<E: Exposed>(unit: &mut E, desk: &Desk, ray: &Ray, due: &mut Due) -> u64 {
    let memory = desk.memory();
    let decoded = desk.scene.decode();
    let (hit, cycles) = trace(unit, ray, due, None, |request| memory.line(request.address).map(|line| (line, false)));
    assert_eq!(hit.error(), None, "{hit:?}");
    assert_eq!(hit.found.then(|| plain(&hit.hit)), Exact::new(&decoded).trace(ray));
    cycles
}

/// A ray of which some line of a section is another: it ends with `wanted`, and the next one as it should.
fn wrong<E: Exposed>(
    make: &mut impl FnMut(Hardware, &SceneConfig) -> E,
    desk: &Desk,
    scene: &SceneConfig,
    wanted: RayError,
    mut of: impl FnMut(&str, u64, Line) -> Option<(Line, bool)>,
) -> u64 {
    let memory = desk.memory();
    let mut unit = make(desk.config, scene);
    let mut due = Due::default();
    let (hit, cycles) = trace(&mut unit, &desk.rays[0], &mut due, None, |request| {
        let (section, line) = memory.locate(request.address).unwrap_or_default();
        of(memory.name(section), line, memory.line(request.address).unwrap_or_default())
    });
    assert_eq!(hit, HitOut { tag: U::new(5), error: RayError::code(Some(wanted)), ..HitOut::default() });
    settle(&mut unit, &mut due);
    unit.set_scene(&desk.scene());
    for ray in &desk.rays[..3] {
        right(&mut unit, desk, ray, &mut due);
    }
    cycles
}

/// Waits until nothing is under way; answers may still be.
fn settle<E: Exposed>(unit: &mut E, due: &mut Due) {
    for now in 0.. {
        if !unit.outputs().busy {
            break;
        }
        assert!(now < 10, "busy without a ray");
        let (hit, _) = cycle(unit, None, false, due, &mut |_| None);
        assert_eq!(hit, None);
    }
}

fn plain_line(words: [u64; 4]) -> Option<(Line, bool)> {
    Some((words.map(U::new), false))
}

/// The line with what it holds changed.
fn changed<T: Wire>(line: Line, change: impl Fn(&mut T)) -> Option<(Line, bool)> {
    let mut words = line.map(U::get);
    let mut record = T::from_words(&words);
    change(&mut record);
    record.to_words(&mut words);
    plain_line(words)
}

fn corner(line: Line, x: i64) -> Option<(Line, bool)> {
    changed(line, |corners: &mut VertexData| corners.v1.x = S::new(x))
}

/// The corner p1 of an L0 record, `x` in 16 units.
fn base_corner(form: VertexForm, at: u64, line: Line, x: i64) -> Option<(Line, bool)> {
    match form {
        VertexForm::Compact | VertexForm::Short => changed(line, |record: &mut L0Record| record.p1.x = S::new(x >> 6)),
        VertexForm::Exact if at & 1 == 1 => corner(line, x),
        VertexForm::Exact => Some((line, false)),
    }
}

/// Every error, by each way that leads to it.
pub fn each_error<E: Exposed>(mut make: impl FnMut(Hardware, &SceneConfig) -> E) {
    let make = &mut make;
    for form in VertexForm::ALL {
        let desk = Desk::of(Hardware::one_context(), with_vertices(form, ball(3, 0.4, 1)));
        let scene = desk.scene();
        let same = |line| Some((line, false));

        for section in ["bvh_node", "l0_record", "split", "vertex_data"] {
            wrong(make, &desk, &scene, RayError::Memory, |of, _, line| Some((line, of == section)));
            let cycles = wrong(make, &desk, &scene, RayError::Late, |of, _, line| (of != section).then_some((line, false)));
            assert!((LIMIT + 1..2 * LIMIT + 2000).contains(&cycles), "{section}: late after {cycles} cycles");
        }

        let image = RayError::Image;
        type Change = fn(&mut BvhNode);
        for change in [(|node| node.kinds[2] = U::new(3)) as Change, |node| node.origin = Vec3::new(0, -32_768, 0)] {
            wrong(make, &desk, &scene, image, |of, _, line| if of == "bvh_node" { changed(line, change) } else { same(line) });
        }
        let deep = |record: &mut L0Record| record.depth = U::new(4);
        wrong(make, &desk, &scene, image, |of, at, line| {
            if of == "l0_record" && (form.is_compact() || at & 1 == 0) { changed(line, deep) } else { same(line) }
        });
        // Beyond the largest coordinate, and off the grid of corners.
        for x in [i32::MAX >> 4, i32::MIN >> 4] {
            let x = i64::from(x);
            wrong(make, &desk, &scene, image, |of, at, line| if of == "l0_record" { base_corner(form, at, line, x) } else { same(line) });
        }
        let coarse = SceneConfig { zeros: U::new(8), ..scene };
        wrong(make, &desk, &coarse, image, |of, at, line| if of == "l0_record" { base_corner(form, at, line, 1 << 6) } else { same(line) });
        match form {
            VertexForm::Exact => {
                wrong(make, &desk, &scene, image, |of, _, line| if of == "vertex_data" { corner(line, -(1 << 27)) } else { same(line) });
            }
            VertexForm::Compact | VertexForm::Short => {
                // Corners where no coordinate can be larger, and steps from there.
                let far = |record: &mut L0Record| {
                    let x = S::new(i64::from(COORD_LIMIT >> 10));
                    (record.e0, record.e1, record.e2) = (U::new(1), U::new(1), U::new(1));
                    (record.p0.x, record.p1.x, record.p2.x) = (x, x, x);
                };
                wrong(make, &desk, &scene, image, |of, _, line| match of {
                    "l0_record" => changed(line, far),
                    "split" => changed(line, |split: &mut SplitRecord| split.v0.x = S::new(1000)),
                    _ => same(line),
                });
            }
        }

        // A node that is its own child, and one of four such, of which three wait each time.
        let own = |children| {
            move |of: &str, _: u64, line| Some((if of == "bvh_node" { everywhere(ChildRef::INNER, children, 0) } else { line }, false))
        };
        wrong(make, &desk, &scene, RayError::Visits, own(1));
        wrong(make, &desk, &SceneConfig { visits: U::MAX, ..scene }, RayError::Stack, own(4));

        for scene in [
            SceneConfig { levels: U::new(11), ..scene },
            SceneConfig { zeros: U::new(14), ..scene },
            SceneConfig { scale: BoundScale { offset: U::new(lodray::num::MAX_BOUND_OFFSET + 1) }, ..scene },
        ] {
            wrong(make, &desk, &scene, RayError::Scene, |_, _, line| same(line));
        }
    }

    // Hardware that keeps fewer bits of indices and lines, and has one form of vertices.
    let desk = Desk::of(FULL_DETAIL, with_vertices(VertexForm::Compact, ball(3, 0.4, 1)));
    let scene = desk.scene();
    let same = |line| Some((line, false));
    let far = 1 << FULL_DETAIL.index_bits;
    wrong(make, &desk, &scene, RayError::Image, |of, _, line| {
        if of == "bvh_node" { Some((everywhere(ChildRef::LEAF, 2, far), false)) } else { same(line) }
    });
    let far = |record: &mut L0Record| record.place = U::new(1 << FULL_DETAIL.index_bits);
    wrong(make, &desk, &scene, RayError::Image, |of, _, line| if of == "l0_record" { changed(line, far) } else { same(line) });
    wrong(make, &desk, &SceneConfig { compact: false, ..scene }, RayError::Scene, |_, _, line| same(line));
}

/// A flush, and a reset, in every `step`-th cycle of a ray's way: then comes another ray.
pub fn each_moment<E: Exposed>(mut make: impl FnMut(Hardware, &SceneConfig) -> E, step: usize) {
    let desk = Desk::of(Hardware::one_context(), with_vertices(VertexForm::Compact, terrain(2, 3, 0.4, 1)));
    let memory = desk.memory();
    let mut unit = make(desk.config, &desk.scene());
    let (mut due, [first, second, ..]) = (Due::default(), &desk.rays[..]) else { panic!("rays") };
    let cycles = right(&mut unit, &desk, first, &mut due);
    let (mut aborted, mut ended) = (0, 0);
    for at in (0..cycles).step_by(step) {
        let (hit, _) = trace(&mut unit, first, &mut due, Some(at), |request| memory.line(request.address).map(|line| (line, false)));
        match hit.error() {
            // Its hit was already there.
            None => ended += 1,
            error => {
                assert_eq!(error, Some(RayError::Aborted), "flushed in cycle {at}");
                aborted += 1;
            }
        }
        // Lines of the old ray come while the new one is under way.
        right(&mut unit, &desk, second, &mut due);
    }
    assert!(aborted > 10 && ended <= 3, "{aborted} rays aborted, {ended} not");
    for at in (0..cycles).step_by(step) {
        let mut offered = Some(RayIn { tag: U::new(9), ray: *first });
        for _ in 0..at {
            let (hit, taken) =
                cycle(&mut unit, offered, false, &mut due, &mut |request| memory.line(request.address).map(|line| (line, false)));
            assert!(hit.is_none());
            offered = offered.filter(|_| !taken);
        }
        unit.reset();
        // The memory too.
        due.lines.clear();
        assert!(!unit.outputs().busy, "busy behind a reset");
        right(&mut unit, &desk, second, &mut due);
        settle(&mut unit, &mut due);
    }
}

/// A line that comes very late, or never: its context takes some other rays meanwhile, and then none.
pub fn each_rest<E: Exposed>(mut make: impl FnMut(Hardware, &SceneConfig) -> E) {
    const MOST: u64 = 1 << Behind::WIDTH;
    const SHORT_LIMIT: u64 = 15;
    let desk = Desk::of(Hardware::one_context(), with_vertices(VertexForm::Compact, ball(2, 0.4, 1)));
    // One that meets nothing is soon done.
    let [x, y, z] = desk.rays[0].direction.get().map(|c| S::new(-c));
    let away = Ray { direction: Vec3 { x, y, z }, ..desk.rays[0] };
    let age = MOST * (SHORT_LIMIT + 1);
    for comes in [true, false] {
        let mut unit = make(desk.config, &SceneConfig { answer_limit: AnswerLimit::new(SHORT_LIMIT), ..desk.scene() });
        let (mut due, mut withheld) = (Due { latency: 2, ..Due::default() }, None);
        let (hit, _) = trace(&mut unit, &desk.rays[0], &mut due, None, |request| {
            withheld = Some(*request);
            None
        });
        assert_eq!(hit.error(), Some(RayError::Late));
        let MemoryRequest { tag, epoch, .. } = withheld.expect("a request");
        let mut rays = 0;
        while unit.outputs().ready {
            right(&mut unit, &desk, &away, &mut due);
            settle(&mut unit, &mut due);
            rays += 1;
        }
        assert_eq!(rays, MOST - 1);
        let from = due.now;
        if comes {
            due.lines.push((from + 100, MemoryAnswer { tag, epoch, error: false, line: [U::MAX; 4] }));
        }
        while !unit.outputs().ready {
            cycle(&mut unit, None, false, &mut due, &mut |_| None);
            assert!(due.now - from <= 2 * age, "it takes no ray again");
        }
        let rested = due.now - from;
        println!("a line that {}: {rays} rays, then {rested} cycles of rest", if comes { "comes" } else { "never comes" });
        assert!(if comes { rested == 101 } else { (age..2 * age).contains(&rested) });
        for ray in &desk.rays[..3] {
            right(&mut unit, &desk, ray, &mut due);
        }
    }
}
