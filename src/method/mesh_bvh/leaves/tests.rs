use super::*;
use crate::bvh::check::synthetic_terrain;
use crate::bvh::{BvhChild32, BvhError};
use crate::format::{BvhChild, ChildRef};
use crate::mesh::Hierarchy;
use crate::method::mesh_bvh::{FullBvh, FullNodes, FullOptions, NodeBoxes};
use std::collections::BTreeSet;

const LAYOUTS: [LeafLayout; 4] = [LeafLayout::Indexed, LeafLayout::Packed, LeafLayout::Line, LeafLayout::Block];

#[test]
fn every_layout_gives_every_triangle_once() {
    for levels in [0, 1, 4] {
        let h = synthetic_terrain(3, levels);
        for max_leaf in [1, 2, 4] {
            for layout in LAYOUTS {
                let leaves = FullBvh::build(&h, &FullOptions::new(max_leaf, NodeBoxes::Codes, layout)).unwrap().leaves;
                assert_eq!(leaves.layout(), layout);
                let mut seen = BTreeSet::new();
                for slot in 0..leaves.len() {
                    let (corners, id) = leaves.triangle(slot);
                    let (tree, i) = (id >> (2 * levels), id & ((1 << (2 * levels)) - 1));
                    let want = lattice::node(levels, levels, i).map(|c| h.tree(tree as usize)[lattice::index(levels, c)]);
                    assert_eq!(corners, want);
                    assert!(seen.insert(id));
                }
                assert_eq!(seen.len() as u64, h.finest_triangles());
            }
        }
    }
}

#[test]
fn indexed_vertices_are_shared_and_in_order_of_first_use() {
    let (quads, levels) = (3, 3);
    let h = synthetic_terrain(quads, levels);
    let full = FullBvh::build(&h, &FullOptions::new(2, NodeBoxes::Codes, LeafLayout::Indexed)).unwrap();
    let side = (quads as usize) << levels;
    assert_eq!(full.leaves.vertices(), (side + 1) * (side + 1));
    let Storage::Indexed { triples, vertices } = &full.leaves.storage else { panic!("wrong layout") };
    let mut next = 0;
    for &v in triples.iter().flatten() {
        assert!(v <= next);
        next = next.max(v + 1);
    }
    assert_eq!(next as usize, vertices.len());
}

#[test]
fn lines_are_those_of_the_records() {
    let h = synthetic_terrain(2, 3);
    for layout in [LeafLayout::Indexed, LeafLayout::Packed, LeafLayout::Line] {
        let leaves = FullBvh::build(&h, &FullOptions::new(4, NodeBoxes::Codes, layout)).unwrap().leaves;
        for slots in (0..leaves.len()).map(|first| first..leaves.len().min(first + 1 + first % 4)) {
            let mut lines = Vec::new();
            let mut bytes = BTreeSet::new();
            let mut record = |from: u64, len: u64| bytes.extend((from..from + len).map(|b| b / 32 * 32));
            leaves.lines(&leaves.leaf(slots.start, slots.len()), |l| lines.push(l));
            for slot in slots {
                match &leaves.storage {
                    Storage::Indexed { triples, .. } => {
                        record(12 * slot as u64, 12);
                        let first = (12 * triples.len() as u64).div_ceil(32) * 32;
                        triples[slot].iter().for_each(|v| record(first + 12 * u64::from(*v), 12));
                    }
                    Storage::Packed(_) => record(36 * slot as u64, 36),
                    Storage::Line(_) => record(32 * slot as u64, 32),
                    Storage::Block { .. } | Storage::Dgf { .. } => panic!("no records"),
                }
            }
            assert_eq!(lines.len(), bytes.len());
            assert_eq!(lines.into_iter().collect::<BTreeSet<_>>(), bytes);
            assert!(bytes.iter().all(|l| *l < leaves.bytes()));
        }
    }
}

#[test]
fn blocks_lie_one_behind_the_other_and_have_their_triangles() {
    let h = synthetic_terrain(2, 3);
    let (mut blocks, mut triangles) = (0, 0);
    for most in [1, 2, 4, 8, 16] {
        let leaves = FullBvh::build(&h, &FullOptions::new(most, NodeBoxes::Codes, LeafLayout::Block)).unwrap().leaves;
        let Storage::Block { lines, starts } = &leaves.storage else { panic!("wrong layout") };
        let mut next = 0;
        for own in starts.chunk_by(|a, b| a == b) {
            let leaf = leaves.leaf(next, own.len());
            assert_eq!((leaf.slots.start, leaf.slots.len() <= most as usize), (own[0] as usize, true));
            let mut given = Vec::new();
            leaves.triangles(&leaf, |corners, id| given.push((corners, id)));
            assert_eq!(given, leaf.slots.clone().map(|slot| leaves.triangle(slot)).collect::<Vec<_>>());
            let corners: Vec<_> = given.iter().map(|(corners, _)| *corners).collect();
            assert_eq!(block::lines(&corners), Some(own.len() as u32));
            let mut read = Vec::new();
            leaves.lines(&leaf, |address| read.push(address as usize / 32));
            assert_eq!(read, (next..next + own.len()).collect::<Vec<_>>());
            next += own.len();
            (blocks, triangles) = (blocks + 1, triangles + given.len());
        }
        assert_eq!(next, lines.len());
    }
    assert_eq!(triangles as u64, 5 * h.finest_triangles());
    assert!(blocks < 2000, "{blocks} blocks of {triangles} triangles");
}

/// A terrain whose coordinates have 16 bits, so that any triangle fits a dense block.
fn coarse_terrain(quads: u32, levels: u32) -> Hierarchy {
    let mut h = synthetic_terrain(quads, levels);
    h.points.iter_mut().flatten().for_each(|c| *c &= !0xffff);
    h
}

#[test]
fn dense_blocks_have_the_triangles_of_their_leaves() {
    let h = coarse_terrain(3, 4);
    let mesh = Corners::new(&h).unwrap();
    for (boxes, most) in [(NodeBoxes::Six, 4), (NodeBoxes::Oriented, 3), (NodeBoxes::Local, 2), (NodeBoxes::Wide, 1)] {
        let bvh = FullBvh::build(&h, &FullOptions::new(most, boxes, LeafLayout::Dgf)).unwrap();
        let Storage::Dgf { blocks, turns } = &bvh.leaves.storage else { panic!("wrong layout") };
        assert_eq!(
            (bvh.leaves.layout(), turns.len() as u64, bvh.leaves.bytes()),
            (LeafLayout::Dgf, h.finest_triangles(), 128 * blocks.len() as u64)
        );
        assert!(blocks.len() * 16 < turns.len() && turns.iter().any(|&turn| turn > 0), "{} blocks of {}", blocks.len(), turns.len());
        let (mut seen, mut from_the_end) = (BTreeSet::new(), 0);
        for at in 0..bvh.nodes.len() {
            for child in bvh.nodes.children(at).into_iter().filter(|child| child.kind.get() == ChildRef::LEAF) {
                let (index, count) = (child.index.get() as usize, child.count.get() as usize + 1);
                let leaf = bvh.leaves.leaf(index, count);
                from_the_end += usize::from(index % 128 >= 64);
                assert_eq!((leaf.slots.len(), leaf.block.clone()), (count, index / 128 * 4..index / 128 * 4 + 4));
                let mut slot = leaf.slots.start;
                bvh.leaves.triangles(&leaf, |corners, id| {
                    assert_eq!(corners, mesh.triangle(id));
                    assert_eq!(bvh.leaves.triangle(slot), (corners, id));
                    slot += 1;
                    assert!(seen.insert(id));
                });
                assert_eq!(slot, leaf.slots.end);
            }
        }
        assert_eq!(seen.len() as u64, h.finest_triangles());
        assert!(from_the_end > 20, "{from_the_end} leaves named from the end");
    }
}

/// Corners far apart on a fine grid: few triangles fit a block, so leaves of a node need nodes of their own.
#[test]
fn leaves_that_share_no_block_go_a_node_lower() {
    let mut h = coarse_terrain(3, 2);
    for (k, point) in h.points.iter_mut().enumerate() {
        *point = [1, 7, 49].map(|factor| (k as i32 * factor * 7919 % 65_000 - 32_500) << 16);
    }
    let nodes = |layout| FullBvh::build(&h, &FullOptions::new(4, NodeBoxes::Six, layout)).unwrap();
    let (lines, dense) = (nodes(LeafLayout::Line), nodes(LeafLayout::Dgf));
    assert!(dense.nodes.len() > lines.nodes.len());
    let all = |bvh: &FullBvh| {
        (0..bvh.leaves.len()).map(|slot| bvh.leaves.triangle(slot)).map(|(corners, id)| (id, corners)).collect::<BTreeSet<_>>()
    };
    assert_eq!(all(&dense), all(&lines));
}

#[test]
fn both_box_widths_refer_to_the_same_and_16_bits_contain_32() {
    let h = synthetic_terrain(4, 4);
    let nodes = |wide| {
        FullBvh::build(&h, &FullOptions::new(4, if wide { NodeBoxes::Wide } else { NodeBoxes::Codes }, LeafLayout::Line)).unwrap().nodes
    };
    let (narrow, wide) = (nodes(false), nodes(true));
    let FullNodes::Boxes16(narrow) = narrow.as_ref() else { panic!("16") };
    let FullNodes::Boxes32(wide) = wide.as_ref() else { panic!("32") };
    assert_eq!(narrow.len(), wide.len());
    let mut children = 0;
    for (n, w) in narrow.iter().zip(wide) {
        for k in 0..4 {
            let n = BvhChild::from_words(&n[2 * k..]);
            let w = BvhChild32::from_words(&w[4 * k..]);
            assert_eq!(n.child, w.child);
            if n.child.kind.get() == ChildRef::EMPTY {
                assert_eq!((n, w), Default::default());
                continue;
            }
            children += 1;
            let (lo, hi, wide_lo, wide_hi) = (n.bounds.lo.get(), n.bounds.hi.get(), w.lo.get(), w.hi.get());
            for a in 0..3 {
                assert!(lo[a] << 16 <= wide_lo[a] && wide_lo[a] - (lo[a] << 16) < 65_536);
                assert!(hi[a] << 16 >= wide_hi[a] && (hi[a] << 16) - wide_hi[a] < 65_536);
            }
        }
    }
    assert!(children > 2000, "only {children} children");
}

#[test]
fn hierarchies_that_do_not_add_up_are_refused() {
    let good = synthetic_terrain(2, 2);
    let o = FullOptions::new(4, NodeBoxes::Codes, LeafLayout::Line);
    let mut h = good.clone();
    h.points.pop();
    assert!(matches!(FullBvh::build(&h, &o), Err(BvhError::Points { .. })));
    let mut h = good.clone();
    (h.triangles, h.points) = (vec![], vec![]);
    assert_eq!(FullBvh::build(&h, &o), Err(BvhError::Empty));
    let mut h = good.clone();
    h.levels = 11;
    assert_eq!(FullBvh::build(&h, &o), Err(BvhError::Levels(11)));
    let mut h = good.clone();
    h.points[20][1] = i32::MIN;
    assert_eq!(FullBvh::build(&h, &o), Err(BvhError::IllegalBox(1)));
}
