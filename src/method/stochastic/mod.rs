//! Stochastic level of detail (Lloyd, Klehm and Stich 2020; paper section 6.2): the quad-BVHs of [discrete levels](super::discrete), which share nothing, of which a frame has two
//! neighbours: in a transition between them each ray draws one.
//!
//! The level of a frame is a number with a fraction. It is chosen, as the paper does, which takes the mean level of its own method's hits; or it follows from the object's
//! distance: between level l, whose largest displacement bound h_l is not tolerated where the model is nearest, and l + 1, whose is, it lies where the tolerance lies between the
//! two bounds, on a logarithmic scale. Within `--transition` around the middle between two levels rays draw; beyond, all have the nearer level.
//!
//! A ray draws by what it is, its origin and direction, and by `--draw-seed`; so it has the same level in every run, whatever goes with it. A ray that starts on a surface would
//! draw another one than that it leaves: paths are not served.

use super::bvh::{BvhTracer, LEAF_LAYOUT, LEAF_SIZE, NODE_BOXES, NODE_ORDER, TreeStore};
use super::discrete::{Levels, METHOD as DISCRETE};
use super::knob::{DELTA, ErrorKnob};
use super::packet::{self, PACKET};
use super::{Departure, Knob, Knobs, Landing, Method, Over, Registered, SurfaceHit, Trace, Tracer};
use crate::bvh::BvhError;
use crate::format::Scene;
use crate::num::{MAX_LEVELS, Random};
use crate::rays::{ModelSpace, Query, Sight};
use crate::step::{MemoryMap, StepSink};
use std::sync::Arc;

/// The level of a frame.
pub static MEAN_LEVEL: Knob = Knob {
    name: "mean-level",
    value_name: "LEVEL",
    help: "Level of the stochastic method, with a fraction: 2.5 lies between levels 2 and 3 (default: chosen for the frame by --delta)",
    default: None,
    words: &[],
    of_frame: false,
    allows: |value| match value.parse::<f64>() {
        Ok(level) if (0.0..=f64::from(MAX_LEVELS)).contains(&level) => Ok(()),
        _ => Err(format!("'{value}' is not a level from 0 to {MAX_LEVELS}")),
    },
};

/// How far apart a transition begins and ends.
pub static TRANSITION: Knob = Knob {
    name: "transition",
    value_name: "LEVELS",
    help: "Length of the transition between two levels in which each ray draws one: 1 is all the way, 0 none (default 0.25)",
    default: Some("0.25"),
    words: &[],
    of_frame: false,
    allows: |value| match value.parse::<f64>() {
        Ok(length) if (0.0..=1.0).contains(&length) => Ok(()),
        _ => Err(format!("'{value}' is not a part of a level from 0 to 1")),
    },
};

/// Another draw for each ray.
pub static DRAW_SEED: Knob = Knob {
    name: "draw-seed",
    value_name: "SEED",
    help: "Seed by which rays of the stochastic method draw their levels (default 0)",
    default: Some("0"),
    words: &[],
    of_frame: false,
    allows: |value| value.parse::<u64>().map(drop).map_err(|_| format!("'{value}' is not a seed: a whole number from 0")),
};

/// The method.
pub static METHOD: Registered = Registered {
    name: "stochastic",
    help: "Stochastic level of detail: quad-BVHs of two neighbouring levels, of which each ray draws one in a transition",
    knobs: &[&DELTA, &MEAN_LEVEL, &TRANSITION, &DRAW_SEED, &NODE_BOXES, &NODE_ORDER, &LEAF_LAYOUT, &LEAF_SIZE, &PACKET],
    error: Some(ErrorKnob { knob: &MEAN_LEVEL, values: || (0..=4 * MAX_LEVELS).map(|k| f64::from(k) / 4.0).collect(), in_steps: false }),
    over: Over::Scene,
    unit: DISCRETE.unit,
    works: &[],
    make: |scene, knobs, store| Stochastic::of(scene, knobs, store),
};

/// The method on a scene.
struct Stochastic {
    levels: Arc<Levels>,
    space: ModelSpace,
    chosen: Choices,
}

/// What was chosen.
#[derive(Clone, Copy)]
struct Choices {
    mean: Option<f64>,
    transition: f64,
    seed: u64,
    /// Rays that are traced together.
    lanes: usize,
}

impl Choices {
    fn of(knobs: &Knobs) -> Self {
        // Checked when they were chosen.
        let number = |knob| knobs.get(knob).and_then(|value| value.parse::<f64>().ok());
        let seed = knobs.get(&DRAW_SEED).and_then(|seed| seed.parse().ok()).unwrap_or(0);
        Self { mean: number(&MEAN_LEVEL), transition: number(&TRANSITION).unwrap_or(0.25), seed, lanes: packet::chosen(knobs) }
    }
}

/// Levels of a frame: the coarser, and of how many of 2^32 rays the next one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Drawn {
    coarser: usize,
    finer_of: u64,
}

impl Drawn {
    /// Rays of this mean level, of a finest one, with a transition of this length.
    fn new(mean: f64, finest: usize, transition: f64) -> Self {
        let mean = mean.clamp(0.0, finest as f64);
        let coarser = (mean.floor() as usize).min(finest.saturating_sub(1));
        let part = mean - coarser as f64;
        let drawn = if transition > 0.0 { (0.5 + (part - 0.5) / transition).clamp(0.0, 1.0) } else { f64::from(u8::from(part >= 0.5)) };
        // Exact: 33 bits at most.
        let finer_of = (drawn * 2f64.powi(32)).round() as u64;
        if finer_of == 1 << 32 { Self { coarser: (coarser + 1).min(finest), finer_of: 0 } } else { Self { coarser, finer_of } }
    }

    /// The ray of `query` has the finer one.
    fn is_finer(&self, query: &Query, seed: u64) -> bool {
        let mix = |all: u64, value: f64| Random::of(all, value.to_bits()).next();
        let own = query.origin.iter().chain(&query.direction).fold(seed, |all, &value| mix(all, value));
        own >> 32 < self.finer_of
    }
}

impl Stochastic {
    fn of(scene: &Scene, knobs: &Knobs, store: &dyn TreeStore) -> Result<Box<dyn Method>, BvhError> {
        let levels = Arc::new(Levels::of(scene, knobs, store)?);
        Ok(Box::new(Self { levels, space: ModelSpace::of(scene), chosen: Choices::of(knobs) }))
    }

    /// The frame's level.
    fn mean(&self, sight: &Sight) -> f64 {
        self.chosen.mean.unwrap_or_else(|| between(&self.levels.bounds, self.levels.tolerance(sight)))
    }

    fn drawn(&self, sight: &Sight) -> Drawn {
        Drawn::new(self.mean(sight), self.levels.finest(), self.chosen.transition)
    }
}

/// Where a tolerance lies among the bounds of levels, coarsest first: a level, or between two of them.
fn between(bounds: &[u64], tolerance: f64) -> f64 {
    let Some(serves) = bounds.iter().position(|&bound| bound as f64 <= tolerance) else { return bounds.len() as f64 - 1.0 };
    if serves == 0 {
        return 0.0;
    }
    // Logarithms of at least a unit: the finest has a bound of 0.
    let [coarser, finer] = [bounds[serves - 1], bounds[serves]].map(|bound| bound.max(1) as f64);
    if coarser <= finer {
        return serves as f64;
    }
    serves as f64 - 1.0 + ((coarser / tolerance.max(1.0)).ln() / (coarser / finer).ln()).clamp(0.0, 1.0)
}

impl Method for Stochastic {
    fn map(&self, sight: &Sight) -> MemoryMap {
        self.levels.map(self.drawn(sight).coarser)
    }

    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        let drawn = self.drawn(sight);
        let tracer = |level: usize| self.levels.tracer(level.min(self.levels.finest()), self.space);
        let (seed, lanes) = (self.chosen.seed, self.chosen.lanes);
        Box::new(StochasticTracer { coarser: tracer(drawn.coarser), finer: tracer(drawn.coarser + 1), drawn, seed, lanes })
    }

    fn leaves(&self) -> bool {
        false
    }

    fn again(&self, knobs: &Knobs) -> Option<Box<dyn Method>> {
        Some(Box::new(Self { levels: Arc::clone(&self.levels), space: self.space, chosen: Choices::of(knobs) }))
    }

    fn choices(&self, sight: &Sight) -> Vec<(&'static str, String)> {
        let Drawn { coarser, finer_of } = self.drawn(sight);
        let drawn = coarser as f64 + finer_of as f64 / 2f64.powi(32);
        vec![("mean level", format!("{:.3}", self.mean(sight))), ("drawn", format!("{drawn:.3}"))]
    }
}

/// Rays through one of two BVHs.
struct StochasticTracer {
    coarser: BvhTracer,
    finer: BvhTracer,
    drawn: Drawn,
    seed: u64,
    lanes: usize,
}

impl StochasticTracer {
    fn of(&mut self, query: &Query) -> &mut BvhTracer {
        if self.drawn.is_finer(query, self.seed) { &mut self.finer } else { &mut self.coarser }
    }
}

impl Trace for StochasticTracer {
    fn trace<S: StepSink>(&mut self, query: &Query, steps: &mut S) -> Option<SurfaceHit> {
        self.of(query).trace(query, steps)
    }

    fn follow<S: StepSink>(&mut self, query: &Query, from: Option<&Departure>, steps: &mut S) -> Option<Landing> {
        if from.is_some() {
            return None;
        }
        Trace::follow(self.of(query), query, None, steps)
    }

    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool {
        Trace::all(self.of(query), query, hits)
    }

    fn is_mapped(&self) -> bool {
        true
    }

    fn lanes(&self) -> usize {
        self.lanes
    }

    /// In a transition a packet is split in two, one for each level.
    fn packet<S: StepSink>(&mut self, queries: &[Query], hits: &mut Vec<Option<SurfaceHit>>, steps: &mut S) {
        let is_finer: Vec<bool> = queries.iter().map(|query| self.drawn.is_finer(query, self.seed)).collect();
        let mut found = [Vec::new(), Vec::new()].map(Vec::into_iter);
        for (finer, found) in [false, true].into_iter().zip(&mut found) {
            let own: Vec<Query> = queries.iter().zip(&is_finer).filter(|&(_, &is)| is == finer).map(|(query, _)| *query).collect();
            if !own.is_empty() {
                let mut hits = Vec::new();
                let tracer = if finer { &mut self.finer } else { &mut self.coarser };
                Trace::packet(tracer, &own, &mut hits, steps);
                *found = hits.into_iter();
            }
        }
        let [mut coarser, mut finer] = found;
        hits.extend(is_finer.iter().map(|&is| if is { finer.next() } else { coarser.next() }.flatten()));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_draw_within_the_transition_alone() {
        let of = |mean, transition| {
            let Drawn { coarser, finer_of } = Drawn::new(mean, 4, transition);
            coarser as f64 + finer_of as f64 / 2f64.powi(32)
        };
        for k in 0..=40 {
            let mean = f64::from(k) / 10.0;
            assert!((of(mean, 1.0) - mean).abs() < 1e-9, "{mean}");
            let nearest = if mean.fract() == 0.5 { mean.ceil() } else { mean.round() };
            assert_eq!(of(mean, 0.0), nearest);
            assert!((of(mean, 0.25) - nearest).abs() <= 0.5);
        }
        assert_eq!([of(2.37, 0.25), of(2.63, 0.25), of(7.0, 0.25), of(-1.0, 0.25)], [2.0, 3.0, 4.0, 0.0]);
        assert!((of(2.45, 0.25) - 2.3).abs() < 1e-6);
    }

    #[test]
    fn levels_follow_the_tolerance() {
        let bounds = [1600, 400, 100, 25, 0];
        assert_eq!(between(&bounds, f64::INFINITY), 0.0);
        assert_eq!([1600.0, 400.0, 100.0].map(|t| between(&bounds, t)), [0.0, 1.0, 2.0]);
        assert!((between(&bounds, 200.0) - 1.5).abs() < 1e-9);
        assert_eq!(between(&bounds, 0.0), 4.0);
        // Finer never for more.
        let levels: Vec<f64> = (0..200).map(|k| between(&bounds, f64::from(k) * 10.0)).collect();
        assert!(levels.windows(2).all(|two| two[0] >= two[1]));
        assert_eq!([between(&[0], 0.0), between(&[7, 7, 7], 3.0), between(&[7, 7, 0], 7.0)], [0.0, 2.0, 0.0]);
    }

    #[test]
    fn draws_are_the_rays_own_and_as_many_as_they_should_be() {
        let drawn = Drawn { coarser: 1, finer_of: 3 << 30 };
        let query = |k: u32| Query::new([f64::from(k), 0.5, 2.0], [0.1, -1.0, f64::from(k % 7)]);
        let finer = |seed| (0..10_000).filter(|&k| drawn.is_finer(&query(k), seed)).collect::<Vec<_>>();
        assert_eq!(finer(0), finer(0));
        let [a, b] = [finer(0), finer(1)];
        assert!(a != b && [a, b].iter().all(|own| (7_300..7_700).contains(&own.len())));
    }
}
