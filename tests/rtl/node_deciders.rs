//! Which ray decides about the edges of a node.

use crate::draw::Draw;
use crate::suite::{Category, Suite};
use lodray::block::node_deciders::{In, NodeDeciders};
use lodray::block::tree_deciders;
use lodray::num::U;

fn of(draw: &mut Draw, level: u64, node: u64) -> In {
    let decider = |draw: &mut Draw| U::new(draw.below(4));
    let tree = tree_deciders::Out { inner: decider(draw), edges: [0; 3].map(|_| decider(draw)) };
    In { tree, level: U::new(level), node: U::new(node) }
}

fn random(draw: &mut Draw) -> In {
    let level = draw.below(11);
    let node = draw.below(1 << (2 * level));
    of(draw, level, node)
}

/// Children of one or two numbers: along a base edge, or at a corner.
fn along(draw: &mut Draw) -> In {
    let level = draw.below(11);
    let two = [draw.below(4), draw.below(4)];
    let node = (0..level).fold(0, |node, _| 4 * node + draw.one_of(&two));
    of(draw, level, node)
}

/// All along but for one digit.
fn but_one(draw: &mut Draw) -> In {
    let input = along(draw);
    let (level, at) = (input.level.get(), 2 * draw.below(10));
    let node = input.node.get() & !(3 << at) | draw.below(4) << at;
    of(draw, level, node & ((1 << (2 * level)) - 1))
}

type Is = Category<NodeDeciders>;

pub fn suite() -> Suite<NodeDeciders> {
    Suite::new(
        |i| i.level.get() <= 10 && i.node.get() < 1 << (2 * i.level.get()),
        vec![Is::any("random", random), Is::any("along a base edge", along), Is::any("but for one digit", but_one)],
        vec![
            ("one edge of a deep node on a base edge", |i, o| {
                let tree = i.tree;
                i.level.get() == 10
                    && tree.edges.iter().all(|&by| by != tree.inner)
                    && o.by.iter().filter(|&&by| by != tree.inner).count() == 1
            }),
            ("two edges of a deep node", |i, o| {
                let tree = i.tree;
                i.level.get() == 10
                    && tree.edges.iter().all(|&by| by != tree.inner)
                    && o.by.iter().filter(|&&by| by != tree.inner).count() == 2
            }),
        ],
        vec![("level", 0..=10, |i, _| i.level.get()), ("who decides", 0..=63, |_, o| o.by.iter().fold(0, |code, by| 4 * code + by.get()))],
    )
}

crate::suite::modes!(suite());
