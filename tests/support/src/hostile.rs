//! Surroundings that do a unit wrong: memory that answers with anything, late, or never; flushes, resets, and other scenes, at random moments. Whatever they
//! do, the unit gives one hit for each ray that it took, in bounded time, and the right one for each ray that nothing was done to.

use crate::hardware::{form_for, most_levels, ray_for, scene_for};
use crate::models::{Rng, any_rays, ball, coarsened, terrain, with_vertices, with_zeros};
use crate::plain::plain;
use lodray::format::{BvhNode, ChildRef, Scene};
use lodray::golden::ExactHit;
use lodray::golden::exact::Exact;
use lodray::hardware::ports::{AnswerLimit, Behind, HitOut, MemoryAnswer, MemoryRequest, RayIn, SceneConfig, SecondaryIn};
use lodray::hardware::{Hardware, RayError};
use lodray::mesh::most_zeros;
use lodray::method::Hit;
use lodray::method::lod::LodImage;
use lodray::num::{Ray, U, Vec3, VertexForm, Wire};
use lodray::sim::unit::environment::UnitPort;
use lodray::sim::unit::{Inputs, Outputs, SceneMemory, TraversalUnit};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// A unit, or two side by side, of which everything at the ports can be moved.
pub trait Exposed: UnitPort {
    /// The end of a cycle with `rst_ni` low.
    fn reset(&mut self);
    /// The scene from this cycle on.
    fn set_scene(&mut self, scene: &SceneConfig);
    /// Its model.
    fn model(&self) -> &TraversalUnit;
}

impl Exposed for TraversalUnit {
    fn reset(&mut self) {
        Self::reset(self);
    }
    fn set_scene(&mut self, scene: &SceneConfig) {
        Self::set_scene(self, *scene);
    }
    fn model(&self) -> &TraversalUnit {
        self
    }
}

/// A scene with rays and their hits.
pub struct Stage {
    pub scene: Scene,
    pub rays: Vec<Ray>,
    pub hits: Vec<Option<ExactHit>>,
}

impl Stage {
    /// A random one for this hardware.
    pub fn random(config: &Hardware, rng: &mut Rng) -> Self {
        let seed = rng.draw();
        let levels = rng.below(u64::from(most_levels(config).min(4) + 1)) as u32;
        let h = if rng.below(2) == 0 { ball(levels, 0.4, seed) } else { terrain(2, levels, 0.4, seed) };
        let zeros = config.coordinate_zeros.min(most_zeros(levels));
        let h = with_vertices(form_for(config, VertexForm::ALL[rng.below(3) as usize]), with_zeros(zeros, h));
        let rays = any_rays(&h, 40, seed);
        let as_taken = |(k, ray)| ray_for(config, &coarsened(ray, [zeros, config.direction_zeros]), k);
        let rays: Vec<Ray> = rays.iter().enumerate().map(as_taken).collect();
        let scene = scene_for(config, &h);
        let h = scene.decode();
        let golden = Exact::new(&h);
        let hits = rays.iter().map(|ray| golden.trace(ray)).collect();
        Self { scene, rays, hits }
    }
}

/// What is done to the unit: how many of 1024 answers, and of 65536 cycles.
#[derive(Clone, Copy, Debug, Default)]
pub struct Mischief {
    /// Answers of random bits, with a bit or a few turned, of nodes that lead nowhere else, with an error, never given, and given late.
    pub noise: u64,
    pub flips: u64,
    pub loops: u64,
    pub errors: u64,
    pub lost: u64,
    pub late: u64,
    /// With another tag or epoch, and given twice: what no memory may do.
    pub wrong_tags: u64,
    pub flushes: u64,
    pub resets: u64,
}

impl Mischief {
    /// Any, or none; only what memory may do if it is `lawful`.
    fn random(rng: &mut Rng, lawful: bool) -> Self {
        let mut some = |most: u64| if rng.below(4) == 0 { 1 + rng.below(most) } else { 0 };
        match some(1) {
            1 => Self::default(),
            _ => Self {
                noise: some(500),
                flips: some(500),
                loops: [0, 0, 0, 100, 500, 1024][some(6) as usize % 6],
                errors: some(100),
                lost: some(100),
                late: some(300),
                wrong_tags: if lawful { 0 } else { some(300) },
                flushes: some(1000),
                resets: some(300),
            },
        }
    }
}

/// What the unit did.
#[derive(Clone, Debug, Default)]
pub struct Tally {
    pub cycles: u64,
    pub rays: u64,
    /// Rays to which nothing was done, all with the right hit; and those that met something.
    pub clean: u64,
    pub met: u64,
    /// Hits with each error, by code; of code 0 those of rays that something was done to, and that gave a hit or a miss nevertheless.
    pub errors: [u64; 8],
    pub flushes: u64,
    pub resets: u64,
    pub scenes: u64,
    pub forgotten: u64,
    /// Lines that came for rays that had ended.
    pub stray: u64,
    /// Most cycles from ray to hit.
    pub longest: u64,
}

struct UnderWay {
    /// Which one, and when it was taken.
    ray: usize,
    since: u64,
    /// Something was done to it: its hit can be anything.
    spoiled: bool,
}

/// The surroundings.
pub struct Hostile<'a> {
    config: Hardware,
    stages: &'a [Stage],
    memories: Vec<SceneMemory<'a>>,
    rng: Rng,
    lawful: bool,
    mischief: Mischief,
    /// Cycles until there is other mischief.
    left: u64,
    stage: usize,
    scene: SceneConfig,
    /// The scene is what its stage says.
    is_true: bool,
    /// No ray comes until there is another scene.
    waits: bool,
    under_way: BTreeMap<u64, UnderWay>,
    offered: Option<(RayIn, usize)>,
    next_tag: u64,
    /// Answers by the cycle they are due in, and by number; whether they are wrong by their tag.
    due: BinaryHeap<Reverse<(u64, u64)>>,
    answers: BTreeMap<u64, (MemoryAnswer, bool)>,
    number: u64,
    held: Outputs,
    pub tally: Tally,
}

/// Cycles after which a line may be late in these surroundings, less one.
const LIMIT: u64 = 399;

/// A node whose children hold all of space and are the nodes, or trees, from `index` on.
pub fn everywhere(kind: u64, children: usize, index: u64) -> [U<64>; 4] {
    let mut node = BvhNode { origin: Vec3::new(-32_767, -32_767, -32_767), exponents: [U::new(12); 3], ..BvhNode::default() };
    (node.first_node, node.first_leaf) = (U::new(index), U::new(index));
    for k in 0..children {
        node.kinds[k] = U::new(kind);
        node.planes[6 * k + 3..6 * k + 6].fill(U::MAX);
    }
    let mut words = [0; 4];
    node.to_words(&mut words);
    words.map(U::new)
}

impl<'a> Hostile<'a> {
    pub fn new(config: Hardware, stages: &'a [Stage], lawful: bool, seed: u64) -> Self {
        let memories: Vec<SceneMemory<'_>> =
            (0..).zip(stages).map(|(k, stage)| SceneMemory::new(LodImage::of(&stage.scene), k << 20)).collect();
        let scene = Self::bounded(memories[0].config());
        Self {
            config,
            stages,
            memories,
            rng: Rng(seed),
            lawful,
            mischief: Mischief::default(),
            left: 0,
            stage: 0,
            scene,
            is_true: true,
            waits: false,
            under_way: BTreeMap::new(),
            offered: None,
            next_tag: 0,
            due: BinaryHeap::new(),
            answers: BTreeMap::new(),
            number: 0,
            held: Outputs::default(),
            tally: Tally::default(),
        }
    }

    fn bounded(scene: SceneConfig) -> SceneConfig {
        SceneConfig { answer_limit: AnswerLimit::new(LIMIT), ..scene }
    }

    /// The scene that a unit starts with.
    pub fn scene(&self) -> SceneConfig {
        self.scene
    }

    /// As many cycles of mischief, then memory falls silent and every ray must end; at last rays to which nothing is done.
    pub fn run(&mut self, unit: &mut impl Exposed, cycles: u64) {
        while self.tally.cycles < cycles {
            if self.left == 0 {
                self.left = 200 + self.rng.below(4000);
                self.mischief = Mischief::random(&mut self.rng, self.lawful);
            }
            self.left -= 1;
            self.cycle(unit, true, true);
        }
        self.mischief = Mischief { lost: 1024, ..Mischief::default() };
        // A line is late within two limits; contexts that are owed lines rest for two ages.
        let rest = 2 * (1 << Behind::WIDTH) * (LIMIT + 1);
        self.drain(unit, rest + 2 * (LIMIT + 1) + 1000 * self.config.contexts as u64);
        self.mischief = Mischief::default();
        self.waits = false;
        self.change(unit, 0, self.memories[0].config(), true);
        for _ in 0..20_000 {
            self.cycle(unit, true, false);
        }
        self.drain(unit, 1_000_000);
    }

    /// No more rays; the unit must be idle after as many cycles.
    fn drain(&mut self, unit: &mut impl Exposed, most: u64) {
        let until = self.tally.cycles + most;
        if self.mischief.lost > 0 {
            self.answers.clear();
            self.due.clear();
            self.under_way.values_mut().for_each(|ray| ray.spoiled = true);
        }
        while unit.outputs().busy || self.offered.is_some() {
            assert!(self.tally.cycles < until, "the unit does not end its rays: {}", unit.describe());
            self.cycle(unit, false, false);
        }
        assert!(self.under_way.is_empty(), "idle, but a ray has no hit");
    }

    fn change(&mut self, unit: &mut impl Exposed, stage: usize, scene: SceneConfig, is_true: bool) {
        (self.stage, self.scene, self.is_true) = (stage, Self::bounded(scene), is_true);
        unit.set_scene(&self.scene);
        self.tally.scenes += 1;
    }

    /// Another scene, or one that nobody has.
    fn another_scene(&mut self, unit: &mut impl Exposed) {
        let stage = self.rng.below(self.stages.len() as u64) as usize;
        let scene = self.memories[stage].config();
        let wrong = match self.rng.below(20) {
            0 => SceneConfig { levels: U::new(self.rng.below(16)), ..scene },
            1 => SceneConfig { zeros: U::new(self.rng.below(32)), ..scene },
            2 => SceneConfig { compact: !scene.compact, ..scene },
            3 => SceneConfig { visits: U::new(self.rng.below(20)), ..scene },
            4 => SceneConfig { scale: lodray::num::BoundScale { offset: U::new(self.rng.below(512)) }, ..scene },
            5 => SceneConfig { nodes: U::new(self.rng.below(1 << 36)), splits: U::MAX, ..scene },
            6 => SceneConfig { visits: U::MAX, ..scene },
            _ => return self.change(unit, stage, scene, true),
        };
        self.change(unit, stage, wrong, false);
    }

    fn chance(&mut self, of: u64, share: u64) -> bool {
        share > 0 && self.rng.below(of) < share
    }

    fn cycle(&mut self, unit: &mut impl Exposed, rays: bool, stalls: bool) {
        let outputs = unit.outputs();
        let now = self.tally.cycles;
        assert!(self.held.mem.is_none() || outputs.mem == self.held.mem, "cycle {now}: a request was not held");
        assert!(self.held.hit.is_none() || outputs.hit == self.held.hit, "cycle {now}: a hit was not held");
        self.tally.cycles += 1;
        if self.chance(1 << 16, self.mischief.resets) {
            return self.reset(unit);
        }
        // Soon, if the rays of this one mean nothing.
        let soon = if self.is_true { 2000 } else { 200 };
        self.waits |= rays && stalls && self.rng.below(soon) == 0;
        if self.waits && !outputs.busy && self.offered.is_none() {
            self.another_scene(unit);
            self.waits = false;
        }
        let flush = self.chance(1 << 16, self.mischief.flushes);
        if self.offered.is_none() && rays && !self.waits && self.rng.below(4) > 0 {
            let ray = self.rng.below(self.stages[self.stage].rays.len() as u64) as usize;
            self.offered = Some((RayIn { tag: U::new(self.next_tag), ray: self.stages[self.stage].rays[ray] }, ray));
            self.next_tag += 1;
        }
        let (hit_ready, mem_ready) = (!stalls || self.rng.below(4) > 0, !stalls || self.rng.below(4) > 0);
        let (ray, answer) = (self.offered.map(|(ray, _)| ray), self.answer(unit));
        let inputs = Inputs { ray, hit_ready, mem_ready, answer, flush, secondary: SecondaryIn::primary() };

        if let Some(hit) = outputs.hit.filter(|_| hit_ready) {
            self.finish(&hit);
        }
        if let Some((ray, number)) = self.offered.filter(|_| outputs.ready) {
            self.under_way.insert(ray.tag.get(), UnderWay { ray: number, since: now, spoiled: !self.is_true });
            self.offered = None;
            self.tally.rays += 1;
        }
        if let Some(request) = outputs.mem.filter(|_| mem_ready) {
            self.request(unit.model().owner(&request), &request);
        }
        if flush {
            self.tally.flushes += 1;
            self.under_way.values_mut().for_each(|ray| ray.spoiled = true);
        }
        self.held = Outputs { hit: outputs.hit.filter(|_| !hit_ready), mem: outputs.mem.filter(|_| !mem_ready), ..Outputs::default() };
        unit.tick(&inputs);
    }

    /// The unit and its memory forget everything.
    fn reset(&mut self, unit: &mut impl Exposed) {
        unit.reset();
        self.tally.resets += 1;
        self.tally.forgotten += self.under_way.len() as u64;
        self.under_way.clear();
        self.answers.clear();
        self.due.clear();
        (self.offered, self.held) = (None, Outputs::default());
    }

    /// The answer of this cycle.
    fn answer(&mut self, unit: &impl Exposed) -> Option<MemoryAnswer> {
        let &Reverse((due, number)) = self.due.peek()?;
        if due > self.tally.cycles {
            return None;
        }
        self.due.pop();
        let (answer, wrong) = self.answers.remove(&number)?;
        let request = MemoryRequest { tag: answer.tag, epoch: answer.epoch, ..MemoryRequest::default() };
        self.tally.stray += u64::from(unit.model().owner(&request).is_none());
        if wrong {
            self.under_way.values_mut().for_each(|ray| ray.spoiled = true);
        }
        Some(answer)
    }

    fn request(&mut self, owner: Option<u64>, request: &MemoryRequest) {
        let MemoryRequest { tag, epoch, address } = *request;
        let line = self.memories[self.stage].line(address);
        let Mischief { noise, flips, loops, errors, lost, late, wrong_tags, .. } = self.mischief;
        let mut answer = MemoryAnswer { tag, epoch, error: line.is_none(), line: line.unwrap_or_default() };
        let spoiled = owner.and_then(|tag| self.under_way.get(&tag)).is_none_or(|ray| ray.spoiled);
        assert!(spoiled || line.is_some(), "a line outside of the model: {request:?}");
        let mut done = false;
        if self.chance(1024, noise) {
            answer.line = [(); 4].map(|()| U::new(self.rng.draw()));
            done = true;
        }
        if self.chance(1024, flips) {
            for _ in 0..=self.rng.below(3) {
                let bit = self.rng.below(256);
                let word = &mut answer.line[(bit / 64) as usize];
                *word = U::new(word.get() ^ 1 << (bit % 64));
            }
            done = true;
        }
        if self.chance(1024, loops) {
            let kind = if self.rng.below(20) > 0 { ChildRef::INNER } else { ChildRef::LEAF };
            answer.line = everywhere(kind, 1 + self.rng.below(4) as usize, self.rng.below(8));
            done = true;
        }
        if self.chance(1024, errors) {
            answer.error = true;
            done = true;
        }
        let longest = 1 << self.rng.below(8);
        let mut wait = 1 + self.rng.below(longest);
        if self.chance(1024, late) {
            wait = LIMIT / 2 + self.rng.below(8 * LIMIT);
            done = true;
        }
        let (is_lost, mut wrong) = (self.chance(1024, lost), false);
        if self.chance(1024, wrong_tags) {
            match self.rng.below(4) {
                0 => (answer.tag, answer.epoch) = (U::new(self.rng.below(256)), U::new(self.rng.below(256))),
                1 => answer.tag = U::new(tag.get() ^ 1 << self.rng.below(8)),
                2 => answer.epoch = U::new(epoch.get() ^ 1 << self.rng.below(8)),
                _ => self.give(self.tally.cycles + 1 + self.rng.0 % 500, answer, true),
            }
            (wrong, done) = (true, true);
        }
        if !is_lost {
            self.give(self.tally.cycles + wait, answer, wrong);
        }
        if let Some(ray) = owner.and_then(|tag| self.under_way.get_mut(&tag)) {
            ray.spoiled |= done || is_lost;
        }
    }

    fn give(&mut self, when: u64, answer: MemoryAnswer, wrong: bool) {
        self.due.push(Reverse((when, self.number)));
        self.answers.insert(self.number, (answer, wrong));
        self.number += 1;
    }

    fn finish(&mut self, hit: &HitOut) {
        let now = self.tally.cycles;
        let ray = self.under_way.remove(&hit.tag.get()).unwrap_or_else(|| panic!("cycle {now}: a hit of no ray under way: {hit:?}"));
        let (stage, error) = (&self.stages[self.stage], hit.error());
        self.tally.longest = self.tally.longest.max(now - ray.since);
        assert!(hit.found || hit.hit == Hit::default(), "cycle {now}: a miss with a hit: {hit:?}");
        assert!(error.is_none() || !hit.found, "cycle {now}: an error with a hit: {hit:?}");
        if !self.config.takes(&self.scene) {
            assert!(matches!(error, Some(RayError::Scene | RayError::Aborted)), "cycle {now}: not of this scene: {hit:?}");
        }
        if ray.spoiled {
            self.tally.errors[RayError::code(error).get() as usize] += 1;
            return;
        }
        assert_eq!(error, None, "cycle {now}: nothing was done to this ray: {hit:?}");
        assert_eq!(hit.found.then(|| plain(&hit.hit)), stage.hits[ray.ray], "cycle {now}: {:?}", stage.rays[ray.ray]);
        self.tally.clean += 1;
        self.tally.met += u64::from(hit.found);
    }
}
