//! The audit of a scene: everything that traversal relies on, recomputed from the stored vertices.
//!
//! Apart from the record formats nothing here is shared with the code that builds scenes: trees are read by their own recursion, displacements stay
//! squared (no root is rounded), and truths are kept at the inserted vertices and not by edge. Each check has the number of things that it must
//! look at; looking at fewer is a failure, so no check passes by doing nothing.

mod boxes;
mod bvh;
mod edges;
mod tally;
mod tree;

use super::Scene;
use crate::mesh::{BoundKind, edges_of_level, edges_of_tree, lattice};
use boxes::Span;
use edges::Edges;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;
use tally::{CHECKS, CheckKind, Tallies};

/// What one check found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Check {
    /// What must hold.
    pub name: String,
    /// How many things were looked at.
    pub checked: u64,
    /// How many had to be.
    pub expected: u64,
    /// How many do not hold.
    pub breaches: u64,
    /// The first of them, by tree.
    pub first: Option<String>,
}

impl Check {
    /// Nothing is wrong and nothing was left out.
    pub fn passed(&self) -> bool {
        self.breaches == 0 && self.checked == self.expected
    }
}

/// What an audit found.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct AuditReport {
    /// What the scene says its displacement bounds cover: that is what they were held to.
    #[serde(default = "BoundKind::unnamed")]
    pub bounds: BoundKind,
    /// All checks.
    pub checks: Vec<Check>,
}

impl AuditReport {
    /// All checks passed.
    pub fn passed(&self) -> bool {
        self.checks.iter().all(Check::passed)
    }

    /// The check of this name.
    pub fn check(&self, name: &str) -> Option<&Check> {
        self.checks.iter().find(|c| c.name == name)
    }
}

impl fmt::Display for AuditReport {
    /// The kind of bounds, then a line per check: verdict, count, name, and the first breach.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "displacement bounds: {}", self.bounds.name())?;
        for c in &self.checks {
            let verdict = if c.passed() { "ok" } else { "FAILED" };
            writeln!(f, "{verdict:>6} {:>12} checked: {}", c.checked, c.name)?;
            if c.checked != c.expected {
                writeln!(f, "{:>19} had to be checked", c.expected)?;
            }
            if let Some(first) = &c.first {
                writeln!(f, "{:>19} breaches, the first: {first}", c.breaches)?;
            }
        }
        Ok(())
    }
}

/// What the images say, as the audit reads them.
pub struct Reading {
    /// Positions in units, tree by tree in lattice order.
    pub points: Vec<[i32; 3]>,
    /// For each of these points the bound code of the edge that it splits; none for base vertices.
    pub codes: Vec<Option<u8>>,
}

/// Points and codes of a scene that has been opened or built, read by the audit's own recursion.
pub fn reading(scene: &Scene) -> Reading {
    let (lattices, _) = read(scene);
    Reading { points: lattices.points, codes: lattices.codes.into_iter().map(|code| u8::try_from(code).ok()).collect() }
}

/// Reads all trees, and checks what can be checked on the way.
fn read(scene: &Scene) -> (tree::Lattices, Tallies) {
    let len = lattice::len(scene.levels());
    let mut lattices = tree::Lattices::new(scene.trees() * len);
    let per_tree = lattices.trees(len).enumerate();
    let (known, begins) = (known(scene), tree::Begins::of(scene));
    let found = per_tree.map(|(t, lattice)| tree::read(scene, &begins, t, known[t], lattice)).reduce(Tallies::default, Tallies::join);
    (lattices, found)
}

/// The level of each tree down to which its vertices and codes are known: below what is stored they are middles and 0, but in a scene that was pruned for a job.
fn known(scene: &Scene) -> Vec<u32> {
    if scene.meta().is_whole() { vec![scene.levels(); scene.trees()] } else { scene.depths() }
}

/// Checks a scene that has been opened or built. (How far compact vertices lie from where they were, META's `moved`, cannot be told from them.)
pub fn audit(scene: &Scene) -> AuditReport {
    let levels = scene.levels();
    let (mut lattices, mut found) = read(scene);
    let (lo, hi) = (scene.meta().lo, scene.meta().hi);
    let whole = scene.meta().is_whole();
    for k in 0..3 {
        let (least, most) = (found.span.lo[k], found.span.hi[k]);
        for (which, stored, truth, holds) in [("lo", lo[k], least, lo[k] <= least), ("hi", hi[k], most, hi[k] >= most)] {
            // Of a pruned scene not all vertices are known.
            found.check(CheckKind::ModelBox, stored == truth || !whole && holds, || {
                format!("META {which}[{k}] is {stored}, the vertices give {truth}")
            });
        }
    }

    let edges = Edges::new(scene.triangles(), levels);
    let corners = edges.check_corners(scene.triangles(), &lattices, &mut found);
    let known = known(scene);
    edges.check_shared(&lattices, &known, &mut found);
    lattices.cover(scene.meta().bounds, levels, |level, displacements| edges.raise_shared(level, displacements));
    found = found.join(lattices.check_codes(levels, &known, &allowed(scene)));
    let spans: Vec<Span> = lattices.points.par_chunks(lattice::len(levels)).map(|points| Span::around(points.iter().copied())).collect();
    bvh::check(scene, &spans, &mut found);
    bvh::check_sources(scene, &mut found);
    found = found.join(check_shading(scene));

    let expected = expected(scene, &known, &edges, corners);
    let checks = CHECKS.iter().zip(found.tallies).zip(expected).map(|((&(kind, name), tally), (for_kind, expected))| {
        debug_assert_eq!(kind, for_kind);
        Check { name: name.into(), checked: tally.checked, expected, breaches: tally.breaches, first: tally.first }
    });
    AuditReport { bounds: scene.meta().bounds, checks: checks.collect() }
}

/// For each code the length in units that it covers.
fn allowed(scene: &Scene) -> Vec<u64> {
    let covered = |code: u64| {
        let k = code + u64::from(scene.meta().bound_offset);
        // Only 2^0 is whole, and it is exact; all others are far enough from whole numbers for any `powf`.
        let root = (256.0 * 2f64.powf((k % 16) as f64 / 16.0)).ceil() as u64; // 256 to 491
        if code == 0 { 0 } else { root * 2u64.pow((k / 16) as u32) / 256 } // at most 47, so 56 bits
    };
    (0..256).map(covered).collect()
}

/// Normals and materials.
fn check_shading(scene: &Scene) -> Tallies {
    let len = lattice::len(scene.levels());
    let colours = scene.colours().len().max(1) as u64; // without colours all are material 0
    let checked = (0..scene.trees()).into_par_iter().map(|t| {
        let mut found = Tallies::default();
        let normals = if scene.meta().without_normals { &[] } else { &scene.normals()[t * len..][..len] };
        for (point, &code) in normals.iter().enumerate() {
            let ok = (code & 0xFFFF) != 0x8000 && (code >> 16) != 0x8000;
            found.check(CheckKind::Normals, ok, || format!("tree {t}: normal {point} is {code:#010x}"));
        }
        let material = scene.material(t);
        found.check(CheckKind::Materials, u64::from(material) < colours, || format!("tree {t}: material {material} of {colours}"));
        found
    });
    checked.reduce(Tallies::default, Tallies::join)
}

/// How many things each check must look at, from the counts alone.
fn expected(scene: &Scene, known: &[u32], edges: &Edges, shared_corners: u64) -> [(CheckKind, u64); CHECKS.len()] {
    let form = scene.meta().vertices;
    let trees = scene.trees() as u64;
    // What is stored, tree by tree.
    let [groups, splits, vertices] = (0..scene.trees()).fold([0; 3], |[groups, splits, vertices], tree| {
        let own = tree::Stored::of(form, scene.record(tree).depth.get() as u32); // 4 bits
        [groups + own.groups, splits + own.splits, vertices + own.vertices]
    });
    let lines_of_records = if scene.meta().vertices.is_compact() { trees } else { 2 * trees };
    let sum = |of: fn(u32) -> u64| known.iter().map(|&levels| of(levels)).sum::<u64>();
    let shared = edges.places(known);
    let nodes = scene.nodes().len() as u64;
    [
        (CheckKind::Reserved, lines_of_records + splits + vertices + 5 * nodes),
        (CheckKind::Limit, sum(|n| 3 * (1 + inner(n)))),
        (CheckKind::LowBits, sum(|n| 3 * (1 + inner(n)))),
        (CheckKind::VerticesInTree, sum(|n| 3 * inner(n) - (lattice::len(n) as u64 - 3))),
        (CheckKind::VerticesAcross, shared + shared_corners),
        // Nodes below the root stand by fours in groups of nine codes, the root with three.
        (CheckKind::CodesInTree, sum(|n| if n == 0 { 0 } else { 3 + 9 * ((inner(n) - 1) / 4) - edges_of_tree(n) as u64 })),
        (CheckKind::CodesAcross, shared),
        (CheckKind::Bounds, sum(|n| edges_of_tree(n) as u64)),
        // Six edges meet at an inserted vertex, four on the tree's border, for all levels but the last that has codes.
        (CheckKind::Monotone, sum(|n| (0..n.saturating_sub(1)).map(|level| 6 * edges_of_level(level) as u64 - 6 * (1 << level)).sum())),
        (CheckKind::Boxes, 4 * groups),
        (CheckKind::ModelBox, 6),
        (CheckKind::BaseTriangles, trees),
        (CheckKind::Sources, trees),
        (CheckKind::BvhNodes, nodes),
        (CheckKind::BvhTrees, trees),
        (CheckKind::BvhLeafBoxes, trees),
        (CheckKind::BvhInnerBoxes, nodes - 1),
        (CheckKind::Normals, scene.normals().len() as u64),
        (CheckKind::Materials, trees),
    ]
}

/// Nodes of levels 0 to `levels` - 1, each with three inserted vertices.
fn inner(levels: u32) -> u64 {
    ((1 << (2 * levels)) - 1) / 3
}
