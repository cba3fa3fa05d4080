//! The coarsest base mesh that the original can be split from: as few vertices as [`Decimator`] leaves, and more where the result falls short.
//!
//! What is judged is the result itself: none of its triangles may face away from the original, and neither surface may be further from the
//! other than the limit. Where one is, the base mesh keeps the vertex that was missed and those that were removed last around it, the next
//! time twice as many. In the end it is the original there, which splits without any fault.

use super::super::distance::{Target, Vec3};
use super::super::farthest::{Farthest, Vertices, farthest};
use super::decimate::{Decimated, Decimator, Goal};
use super::error::{MAX_TRIANGLES, RemeshError, Works};
use super::folds::{folded, folds_of, new_folds};
use super::options::DEFAULT_MAX_ERROR;
use super::report::Folds;
use super::shading::{finest_corners, finest_origins};
use super::source::Source;
use super::split::{Forest, split};
use super::topology::Topology;
use crate::num::MAX_LEVELS;
use rayon::prelude::*;

/// How far removal goes by itself: a little beyond where it goes well, as what goes wrong is mended.
const FREE: Goal = Goal { triangles: 0, facing: 0.3, distance: 0.5 };
/// How far it goes if a number of triangles is wanted, whatever becomes of the original.
const FORCED: Goal = Goal { triangles: 0, facing: -1.0, distance: f64::INFINITY };

/// Results of more levels than this are judged by their first so many, and in whole only when those have no fault.
const TRIAL_LEVELS: u32 = 4;
/// Times that a base mesh is mended, at most, ...
const ROUNDS: u32 = 24;
/// ... and by results of more than the trial's levels.
const LAST_ROUNDS: u32 = 12;

/// Largest distances are narrowed down to this part of the limit, or of what it is by default if that is less.
const NARROW: f64 = 0.4;

/// Vertices that the base mesh keeps for a tree at fault the first time, ...
const FIRST_KEPT: usize = 3;
/// ... and at most; each time twice as many.
const MOST_KEPT: usize = 24;
/// So many times only those that were not removed early.
const PATIENCE: u32 = 2;
/// Rings of trees around one at fault in which they are looked for, at most.
const RINGS: u32 = 4;

/// What is wanted of a base mesh.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub levels: u32,
    /// Base triangles, at least.
    pub base: usize,
    /// Largest distance between original and result, in units of the box.
    pub limit: f64,
}

/// A base mesh and what was split from it.
pub(super) struct Fitted {
    pub topology: Topology,
    pub forest: Forest,
    /// The finest triangles.
    pub target: Target,
    /// How far the result is from the original at most, and the original from the result, if that was looked for.
    pub farthest: Option<[Farthest; 2]>,
    /// Nothing was found to be wrong with it; false if nobody looked.
    pub is_mended: bool,
}

/// Levels that make `base` triangles at least as many as the original's.
pub(super) fn levels_for(base: u64, original: u64) -> u32 {
    (0..MAX_LEVELS).find(|levels| base << (2 * levels) >= original).unwrap_or(MAX_LEVELS)
}

/// What a tree costs beside its finest triangles, in bytes of so many of these: scenes of one original with 1 to 4 levels have 60 to 75 bytes for a tree and 9 for a finest triangle.
const TREE: u64 = 8;

fn cost(base: u64, levels: u32) -> u64 {
    (base << (2 * levels)) + TREE * base
}

/// The levels, and the base mesh for them, that need the fewest bytes of those whose finest triangles are as many as the original's or more; one level at least where the
/// original has any triangles to spare. `limit` gives the largest distance for so many levels, in units of the box.
///
/// Levels are tried from the most that removal as far as it goes well leaves enough triangles for. With fewer levels, removal stops at enough triangles, and the largest error may need more
/// or fewer: a level less is tried as long as that can be better.
///
/// # Errors
/// As [`fit`], or of `limit`.
pub(super) fn fit_by_need(
    source: &Source,
    limit: &dyn Fn(u32) -> Result<f64, RemeshError>,
    progress: &dyn Fn(&str, u64, u64),
) -> Result<(u32, Fitted), RemeshError> {
    let mut decimator = Decimator::new(source);
    let original = source.wedges.len() as u64;
    let free = decimator.run(&[FREE], &vec![false; source.positions.len()]).wedges.len();
    let mut levels = levels_for(free as u64, original);
    let mut best: Option<((bool, u64), (u32, Fitted))> = None;
    // As many as the original at most.
    let enough = |levels: u32| original.div_ceil(1 << (2 * levels)) as usize;
    loop {
        let base = enough(levels);
        let fitted = limit(levels).and_then(|limit| fit(source, &mut decimator, &Wanted { levels, base, limit }, progress));
        let (cost_of, fitted) = match (fitted, best.take()) {
            (Err(_), Some((_, best))) => return Ok(best),
            (fitted, before) => {
                let fitted = fitted?;
                let cost_of = (!fitted.is_mended, cost(fitted.topology.triangles.len() as u64, levels));
                match before {
                    Some((least, best)) if least <= cost_of => return Ok(best),
                    _ => (cost_of, (levels, fitted)),
                }
            }
        };
        levels = levels.saturating_sub(1);
        let (is_faulty, least) = cost_of;
        if levels == 0 || !is_faulty && cost(enough(levels) as u64, levels) >= least {
            return Ok(fitted);
        }
        best = Some((cost_of, fitted));
    }
}

/// The base mesh with as few triangles as will do.
///
/// # Errors
/// If with these levels it would make more than [`MAX_TRIANGLES`].
pub(super) fn fit(
    source: &Source,
    decimator: &mut Decimator,
    wanted: &Wanted,
    progress: &dyn Fn(&str, u64, u64),
) -> Result<Fitted, RemeshError> {
    // The last removal takes two triangles at once.
    let goal = Goal { triangles: wanted.base + usize::from(wanted.base > 0), ..FREE };
    let mut keep = vec![false; source.positions.len()];
    // How often each triangle of the original was at fault.
    let mut strikes = vec![0u32; source.wedges.len()];
    let (mut at, mut left, mut rounds) = (wanted.levels.min(TRIAL_LEVELS), ROUNDS, 0);
    loop {
        rounds += 1;
        progress("base mesh", rounds.min(ROUNDS - 1).into(), ROUNDS.into());
        let base = decimator.run(&[goal], &keep);
        let count = base.wedges.len() as u64;
        if count > most_base(wanted.levels) {
            // The first base mesh has as few as there can be without a loss of shape, whatever the largest error.
            let works = Works { error: rounds > 1, ..works(source, count, wanted.levels) };
            return Err(RemeshError::NeedsBase { base: count, levels: wanted.levels, works });
        }
        let topology = Topology::new(source, base.wedges.clone(), &base.slots);
        let mut fitted = split_and_look(source, topology, at, &|_, _, _| ());
        // Each level comes closer by a factor of about four.
        let limit = if at < wanted.levels { 2.0 * wanted.limit } else { wanted.limit };
        let faults = judge(source, &mut fitted, limit, at == wanted.levels);
        let faultless = faults.iter().all(Option::is_none);
        // The same base mesh would have the same faults: what cannot be mended is left.
        let mut mend = || (0..PATIENCE + RINGS + 1).any(|_| mend(source, &fitted.topology, &base, &faults, &mut keep, &mut strikes));
        if !faultless && left > 0 && mend() {
            left -= 1;
            continue;
        }
        if at == wanted.levels {
            progress("base mesh", ROUNDS.into(), ROUNDS.into());
            fitted.is_mended = faultless;
            return Ok(fitted);
        }
        (at, left) = (wanted.levels, LAST_ROUNDS);
        strikes.fill(0);
    }
}

/// The base mesh with so many triangles, or a few more if the surface's connections allow no less.
pub(super) fn force(source: &Source, triangles: usize, levels: u32, progress: &dyn Fn(&str, u64, u64)) -> Result<Fitted, RemeshError> {
    progress("base mesh", 0, 1);
    let base = forced(source, triangles);
    let count = base.wedges.len() as u64;
    if count > most_base(levels) {
        return Err(RemeshError::TooMany { base: count, levels, triangles: count << (2 * levels), works: works(source, count, levels) });
    }
    progress("base mesh", 1, 1);
    Ok(split_and_look(source, Topology::new(source, base.wedges, &base.slots), levels, progress))
}

/// Removes vertices down to so many triangles, or as far as the surface's connections allow.
fn forced(source: &Source, triangles: usize) -> Decimated {
    let goals = [FREE, FORCED].map(|goal| Goal { triangles, ..goal });
    Decimator::new(source).run(&goals, &vec![false; source.positions.len()])
}

/// Base triangles that there may be with so many splits.
pub(super) const fn most_base(levels: u32) -> u64 {
    MAX_TRIANGLES >> (2 * levels)
}

/// What would do where `base` triangles are too many for `levels` splits; a number of base triangles is tried before it is advised.
fn works(source: &Source, base: u64, levels: u32) -> Works {
    let most = most_base(levels);
    let reached = forced(source, most as usize).wedges.len() as u64;
    Works { levels: (0..levels).rev().find(|&levels| base <= most_base(levels)), base: (reached <= most).then_some(most), error: false }
}

fn split_and_look(source: &Source, topology: Topology, levels: u32, progress: &dyn Fn(&str, u64, u64)) -> Fitted {
    let forest = split(source, &topology, levels, progress);
    let target = Target::grouped(finest_corners(&forest), 1 << (2 * levels.min(2)));
    Fitted { topology, forest, target, farthest: None, is_mended: false }
}

/// What a result turns away from the original, and where.
#[derive(Default)]
pub(super) struct Turned {
    pub flips: u64,
    pub folds: Folds,
    /// The middle of a flipped triangle, ...
    pub flip: Option<Vec3>,
    /// ... and that of an edge that folds anew.
    pub fold: Option<Vec3>,
}

/// Looks for flips and folds in all of a result.
pub(super) fn turned(source: &Source, fitted: &Fitted, limit: f64) -> Turned {
    let Fitted { topology, forest, .. } = fitted;
    let of_tree = |t: usize| {
        let folds = folded(topology, forest, t);
        (new_folds(source, &folds, limit), folds.len() as u64)
    };
    let trees: Vec<(Vec<Vec3>, u64)> = (0..topology.triangles.len()).into_par_iter().map(of_tree).collect();
    let mut all = Turned { folds: Folds { original: folds_of(source), ..Folds::default() }, ..Turned::default() };
    for (flips, (new, edges)) in forest.flipped.iter().zip(trees) {
        all.flips += flips.len() as u64;
        all.folds.edges += edges;
        all.folds.new += new.len() as u64;
        all.flip = all.flip.or(flips.first().copied());
        all.fold = all.fold.or(new.first().copied());
    }
    all
}

/// How far the result is from the original at most, and the original from the result.
pub(super) fn measure(source: &Source, fitted: &Fitted, limit: f64) -> [Farthest; 2] {
    fitted.farthest.clone().unwrap_or_else(|| narrow(source, fitted, limit, f64::INFINITY))
}

fn narrow(source: &Source, fitted: &Fitted, limit: f64, most: f64) -> [Farthest; 2] {
    let vertices = Vertices { positions: &source.positions, triangles: source.triangles() };
    let least = NARROW * limit.min(source.diagonal * DEFAULT_MAX_ERROR / 100.0);
    let from_original = farthest(&source.target, &fitted.target, &[], Some(&vertices), [least, most]);
    // What is less than the other way round matters to nobody.
    let least = least.max(from_original.found.min(most));
    [farthest(&fitted.target, &source.target, &finest_origins(&fitted.topology, &fitted.forest), None, [least, most]), from_original]
}

/// For each tree the vertices of the original that are to be kept for it, if something is wrong with it.
type Faults = Vec<Option<Vec<u32>>>;

fn judge(source: &Source, fitted: &mut Fitted, limit: f64, whole: bool) -> Faults {
    let Fitted { topology, forest, target, .. } = &*fitted;
    let per_tree = 1usize << (2 * forest.levels);
    let trees = topology.triangles.len();
    let too_far = |p: Vec3| source.target.closest(p, limit, |_| true).is_none();
    let is_bad = |t: usize| {
        !forest.flipped[t].is_empty() || forest.strays(t).any(too_far) || !new_folds(source, &folded(topology, forest, t), limit).is_empty()
    };
    let mut faults: Faults = (0..trees).into_par_iter().map(|t| is_bad(t).then(Vec::new)).collect();

    // The tree that is closest to a vertex that is missed is to blame.
    let blame = |p: Vec3| target.near(p, f64::INFINITY).map(|hit| hit.triangle as usize / per_tree);
    let missed: Vec<(usize, u32)> = (0..source.positions.len() as u32)
        .into_par_iter()
        .filter_map(|v| {
            let p = source.positions[v as usize];
            if target.closest(p, limit, |_| true).is_some() { None } else { Some((blame(p)?, v)) }
        })
        .collect();
    for (tree, v) in missed {
        faults[tree].get_or_insert_default().push(v);
    }
    // Points between the vertices, where nothing else is wrong.
    if whole && faults.iter().all(Option::is_none) {
        let [to, from] = narrow(source, fitted, limit, limit);
        // Where too much was found; if no point was, but the bound is too large, where most was found.
        let places = |far: &Farthest| {
            let worst = (far.found.max(far.bound) > limit).then_some((far.triangle, far.at));
            if far.beyond.is_empty() { Vec::from_iter(worst) } else { far.beyond.clone() }
        };
        for (triangle, _) in places(&to) {
            faults[triangle as usize / per_tree].get_or_insert_default();
        }
        for tree in places(&from).into_iter().filter_map(|(_, at)| blame(at)) {
            faults[tree].get_or_insert_default();
        }
        if faults.iter().all(Option::is_none) {
            fitted.farthest = Some([to, from]);
        }
    }
    faults
}

/// Adds to `keep` what the trees at fault need; whether there was anything.
fn mend(source: &Source, topology: &Topology, base: &Decimated, faults: &Faults, keep: &mut [bool], strikes: &mut [u32]) -> bool {
    let mut mended = false;
    for (tree, missed) in faults.iter().enumerate().filter_map(|(t, fault)| Some((t, fault.as_ref()?))) {
        let over = || base.over(tree);
        let strike = over().map(|t| strikes[t as usize]).max().unwrap_or(0);
        let most = (FIRST_KEPT << strike.min(16)).min(MOST_KEPT);
        // First over the tree itself, then further around each time; what was removed early is dear to keep, and comes last.
        let mut trees = (0..strike.min(RINGS)).fold(vec![tree], |trees, _| topology.with_neighbours(&trees));
        let mut vertices = removed_over(source, base, &trees, strike < PATIENCE);
        for _ in 0..RINGS {
            vertices.retain(|&v| !keep[v as usize]);
            if !vertices.is_empty() {
                break;
            }
            trees = topology.with_neighbours(&trees);
            vertices = removed_over(source, base, &trees, strike < PATIENCE);
        }
        // What was removed last matters most; but if a vertex is missed, or that did not help, what is nearest does.
        let position = |v: u32| source.positions[v as usize];
        let middle = || topology.triangles[tree].map(|v| position(topology.vertices[v as usize])).iter().sum::<Vec3>() / 3.0;
        let centre = missed.iter().max_by_key(|&&v| base.removed[v as usize]).map(|&v| position(v)).or_else(|| (strike > 0).then(middle));
        if let Some(centre) = centre {
            vertices.sort_by(|&a, &b| (position(a) - centre).length_squared().total_cmp(&(position(b) - centre).length_squared()));
        }
        vertices.iter().take(most).for_each(|&v| keep[v as usize] = true);
        mended |= !vertices.is_empty();
        over().for_each(|t| strikes[t as usize] = strike + 1);
    }
    mended
}

/// Vertices that were removed from the part of the original over some trees, the last removed first.
fn removed_over(source: &Source, base: &Decimated, trees: &[usize], late: bool) -> Vec<u32> {
    let over = trees.iter().flat_map(|&t| base.over(t)).flat_map(|t| source.wedges[t as usize]);
    let least = if late { base.half_way } else { 0 };
    let mut vertices: Vec<(u32, u32)> = over
        .map(|w| source.wedge_vertex[w as usize])
        .map(|v| (base.removed[v as usize], v))
        .filter(|&(removed, _)| removed > least)
        .collect();
    vertices.sort_unstable();
    vertices.dedup();
    vertices.into_iter().rev().map(|(_, v)| v).collect()
}
