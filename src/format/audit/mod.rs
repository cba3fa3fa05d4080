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

use super::{L0Record, Scene};
use crate::mesh::{BoundKind, edges_of_level, edges_of_tree, lattice};
use crate::num::Wire;
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
    let per_tree = lattices.trees(len).zip(scene.records()).enumerate();
    let found = per_tree.map(|(t, (lattice, record))| tree::read(scene, t, record, lattice)).reduce(Tallies::default, Tallies::join);
    (lattices, found)
}

/// Checks a scene that has been opened or built. (How far compact vertices lie from where they were, META's `moved`, cannot be told from them.)
pub fn audit(scene: &Scene) -> AuditReport {
    let levels = scene.levels();
    let (mut lattices, mut found) = read(scene);
    let (lo, hi) = (scene.meta().lo, scene.meta().hi);
    for k in 0..3 {
        for (which, stored, truth) in [("lo", lo[k], found.span.lo[k]), ("hi", hi[k], found.span.hi[k])] {
            found.check(CheckKind::ModelBox, stored == truth, || format!("META {which}[{k}] is {stored}, the vertices give {truth}"));
        }
    }

    let edges = Edges::new(scene.triangles(), levels);
    let corners = edges.check_corners(scene.triangles(), &lattices, &mut found);
    edges.check_shared(&lattices, &mut found);
    lattices.cover(scene.meta().bounds, levels, |level, displacements| edges.raise_shared(level, displacements));
    found = found.join(lattices.check_codes(levels, &allowed(scene)));
    let spans: Vec<Span> = lattices.points.par_chunks(lattice::len(levels)).map(|points| Span::around(points.iter().copied())).collect();
    bvh::check(scene, &spans, &mut found);
    bvh::check_sources(scene, &mut found);
    found = found.join(check_shading(scene));

    let expected = expected(scene, &edges, corners);
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
    let per_tree = scene.normals().par_chunks(len).zip(scene.records()).enumerate();
    let checked = per_tree.map(|(t, (normals, record))| {
        let mut found = Tallies::default();
        for (point, &code) in normals.iter().enumerate() {
            let ok = (code & 0xFFFF) != 0x8000 && (code >> 16) != 0x8000;
            found.check(CheckKind::Normals, ok, || format!("tree {t}: normal {point} is {code:#010x}"));
        }
        let material = L0Record::from_words(&record[4..]).material.get();
        found.check(CheckKind::Materials, material < colours, || format!("tree {t}: material {material} of {colours}"));
        found
    });
    checked.reduce(Tallies::default, Tallies::join)
}

/// How many things each check must look at, from the counts alone.
fn expected(scene: &Scene, edges: &Edges, shared_corners: u64) -> [(CheckKind, u64); CHECKS.len()] {
    let (n, form) = (scene.levels(), scene.meta().vertices);
    let trees = scene.trees() as u64;
    let [len, edge_count] = [lattice::len(n), edges_of_tree(n)].map(|c| c as u64);
    // Nodes of levels 0 to N-1, each with three inserted vertices; those below the root by fours in groups of nine codes, the root with three.
    let inner = ((1u64 << (2 * n)) - 1) / 3;
    let grouped = inner.saturating_sub(1);
    let codes = if n == 0 { 0 } else { 3 + 9 * (grouped / 4) };
    // What is stored, tree by tree. Of compact ones the root's vertices stand in its L0 record.
    let [stored_groups, stored_vertices] = (0..scene.trees()).fold([0; 2], |[groups, vertices], tree| {
        let own = tree::Stored::of(form, scene.record(tree).depth.get() as u32); // 4 bits
        [groups + own.groups, vertices + own.vertices]
    });
    // Six edges meet at an inserted vertex, four on the tree's border, for all levels but the last that has codes.
    let meeting: u64 = (0..n.saturating_sub(1)).map(|level| 6 * edges_of_level(level) as u64 - 6 * (1 << level)).sum();
    let nodes = scene.nodes().len() as u64;
    [
        (CheckKind::Reserved, 2 * trees + stored_groups + stored_vertices + 5 * nodes),
        (CheckKind::Limit, trees * 3 * (1 + inner)),
        (CheckKind::LowBits, trees * 3 * (1 + inner)),
        (CheckKind::VerticesInTree, trees * (3 * inner - (len - 3))),
        (CheckKind::VerticesAcross, edges.extra_uses * ((1 << n) - 1) + shared_corners),
        (CheckKind::CodesInTree, trees * (codes - edge_count)),
        (CheckKind::CodesAcross, edges.extra_uses * ((1 << n) - 1)),
        (CheckKind::Bounds, trees * edge_count),
        (CheckKind::Monotone, trees * meeting),
        (CheckKind::Boxes, 4 * stored_groups),
        (CheckKind::ModelBox, 6),
        (CheckKind::BaseTriangles, trees),
        (CheckKind::Sources, trees),
        (CheckKind::BvhNodes, nodes),
        (CheckKind::BvhTrees, trees),
        (CheckKind::BvhLeafBoxes, trees),
        (CheckKind::BvhInnerBoxes, nodes - 1),
        (CheckKind::Normals, trees * len),
        (CheckKind::Materials, trees),
    ]
}
