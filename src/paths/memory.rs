//! The memory of several models on a machine, and the steps of rays that go from one to the next.

use super::boxes::Walk;
use super::rebuild::Rebuild;
use crate::block::INSTANCE;
use crate::method::{Before, Method};
use crate::rays::Sight;
use crate::step::{Act, Batch, Fetch, MapError, MemoryMap, Moved, NodeShape, Section, SectionId, Step, StepSink, joined};

/// Lines of a node of the tree over the models: four boxes of six floats of 32 bits, and what each holds.
const NODE_LINES: u32 = 4;
/// Lines of a model's place: the twelve floats of its transform, scale, and where the model's own memory begins.
const INSTANCE_LINES: u32 = 2;

/// Where the lines of all models of a scene lie. A model that stands in several places lies there once; a scene of one model has its memory and nothing else.
#[derive(Clone, Debug)]
pub struct WorldMemory {
    map: MemoryMap,
    /// By instance.
    moved: Vec<Moved>,
    /// The sections of the tree's nodes and of the models' places, if there is more than one place.
    tree: Option<[SectionId; 2]>,
}

impl WorldMemory {
    /// The memory of instances by their methods and what is seen of them; over them there is a tree of so many nodes.
    ///
    /// # Errors
    /// They have more lines than can be numbered.
    pub(super) fn new(instances: &[(&dyn Method, &Sight)], nodes: usize) -> Result<Self, MapError> {
        if let [(method, sight)] = instances {
            return Ok(Self { map: method.map(sight), moved: vec![Moved::default()], tree: None });
        }
        let (mut models, mut maps, mut model_of) = (Vec::<&dyn Method>::new(), Vec::new(), Vec::new());
        for &(method, sight) in instances {
            let known = models.iter().position(|&other| std::ptr::addr_eq(other, method));
            model_of.push(known.unwrap_or(models.len()));
            if known.is_none() {
                models.push(method);
                maps.push(method.map(sight));
            }
        }
        let own = maps.first().map_or(0, |map| map.sections().count());
        let section = |name, count: usize, lines: u32| Section { name, lines: count as u64 * u64::from(lines), base: true };
        let more = [section("scene_node", nodes, NODE_LINES), section("instance", instances.len(), INSTANCE_LINES)];
        let tree = [own, own + 1].map(SectionId::new);
        let (map, moved) = joined(&maps, &more, (tree[0], NODE_LINES))?;
        Ok(Self { map, moved: model_of.into_iter().map(|model| moved[model]).collect(), tree: Some(tree) })
    }

    /// The map of it all.
    pub fn map(&self) -> &MemoryMap {
        &self.map
    }

    /// Says what a ray does in the tree.
    pub(super) fn walk(&self, walk: Walk, steps: &mut impl StepSink) {
        let Some([nodes, instances]) = self.tree else { return };
        let fetch = |section, place: usize, lines: u32| Fetch::new(section, self.map.line(section, place as u64 * u64::from(lines)), lines);
        match walk {
            Walk::Node { node, met } => {
                steps.step(Step::on(fetch(nodes, node, NODE_LINES), Act::Children { shape: NodeShape::Wide, met }).visiting());
            }
            Walk::Pop { dropped } => steps.step(Step::of(Act::Pop { dropped })),
            Walk::Model(k) => {
                steps.step(Step::on(fetch(instances, k, INSTANCE_LINES), Act::Children { shape: NodeShape::Instance, met: 1 }).visiting());
                steps.step(Step::of(Act::Work { work: INSTANCE, count: 1 }));
            }
        }
    }

    /// Hears the steps of a ray in an instance, on the lines of its model.
    pub(super) fn steps_of<'a, S: StepSink>(&'a self, instance: usize, steps: &'a mut S) -> ModelSteps<'a, S> {
        ModelSteps { moved: &self.moved[instance], steps }
    }

    /// The work of building the tree over the models anew, of so many nodes, where some of them `moved`, by instance; none where there is no tree, or nothing moved.
    pub(super) fn rebuild(&self, nodes: usize, moved: Vec<bool>) -> Option<Rebuild> {
        let [node, place] = self.tree.filter(|_| moved.contains(&true))?;
        Some(Rebuild { map: self.map, nodes: (node, NODE_LINES), places: (place, INSTANCE_LINES), count: nodes, moved })
    }

    /// The work of an instance's model before a frame, on the model's lines.
    pub(super) fn before<'a>(&self, instance: usize, own: Box<dyn Before + 'a>) -> Box<dyn Before + 'a> {
        Box::new(MovedBefore { own, moved: self.moved[instance] })
    }
}

/// Steps in a model as those of a ray through the scene.
pub(super) struct ModelSteps<'a, S> {
    moved: &'a Moved,
    steps: &'a mut S,
}

impl<S: StepSink> StepSink for ModelSteps<'_, S> {
    fn step(&mut self, step: Step) {
        self.steps.step(self.moved.step(step));
    }
}

/// Work before a frame on lines that lie elsewhere.
struct MovedBefore<'a> {
    own: Box<dyn Before + 'a>,
    moved: Moved,
}

impl Before for MovedBefore<'_> {
    fn batches(&self) -> usize {
        self.own.batches()
    }

    fn batch(&self, batch: usize) -> Batch {
        self.own.batch(batch).moved(&self.moved)
    }
}

/// Work of several models before a frame, one model after the other.
pub(super) struct AllBefore<'a>(pub Vec<Box<dyn Before + 'a>>);

impl Before for AllBefore<'_> {
    fn batches(&self) -> usize {
        self.0.iter().map(|own| own.batches()).sum()
    }

    fn batch(&self, mut batch: usize) -> Batch {
        for own in &self.0 {
            match batch.checked_sub(own.batches()) {
                Some(rest) => batch = rest,
                None => return own.batch(batch),
            }
        }
        panic!("no such batch")
    }
}
