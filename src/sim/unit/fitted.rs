//! Blocks that hardware for rays from a surface has in another form: one for exact starts and for other rays that decide, which has more operands.

use super::register::{BlockCounts, Pipeline};
use crate::block::hit_divide::{self, HitDivide};
use crate::block::lod_test::{self, LodTest};
use crate::block::lod_test_by::{self, LodTestBy};
use crate::block::ray_setup::{self, RaySetup};
use crate::block::start_divide::{self, StartDivide};
use crate::block::start_setup::{self, StartSetup};
use crate::block::start_test::{self, Below, StartTest};
use crate::block::tri_test::{self, TriTest};
use crate::block::{Block, tree_deciders::Decider};
use crate::hardware::Hardware;

/// A block for rays from a surface.
pub trait ForSecondary: Block {
    /// The block for primary rays alone.
    type Primary: Block;
    /// Its operands, of a primary ray.
    fn of_primary(input: &Self::In) -> <Self::Primary as Block>::In;
    /// What its result is here.
    fn widened(out: <Self::Primary as Block>::Out) -> Self::Out;
}

impl ForSecondary for StartSetup {
    type Primary = RaySetup;
    fn of_primary(input: &start_setup::In) -> ray_setup::In {
        ray_setup::In { origin: input.start.point, direction: input.direction }
    }
    fn widened(out: ray_setup::Out) -> ray_setup::Out {
        out
    }
}

impl ForSecondary for LodTestBy {
    type Primary = LodTest;
    fn of_primary(input: &lod_test_by::In) -> lod_test::In {
        let &lod_test_by::In { ray, by, p0, p1, p2, e0, e1, e2, scale, .. } = input;
        debug_assert_eq!(by, [Decider::ZERO; 3]);
        lod_test::In { ray, p0, p1, p2, e0, e1, e2, scale }
    }
    fn widened(out: lod_test::Out) -> lod_test::Out {
        out
    }
}

impl ForSecondary for StartTest {
    type Primary = TriTest;
    fn of_primary(input: &start_test::In) -> tri_test::In {
        let &start_test::In { start, direction, p0, p1, p2 } = input;
        tri_test::In { origin: start.point, direction, p0, p1, p2 }
    }
    fn widened(test: tri_test::Out) -> start_test::Out {
        start_test::Out { test, below: Below::default() }
    }
}

impl ForSecondary for StartDivide {
    type Primary = HitDivide;
    fn of_primary(input: &start_divide::In) -> hit_divide::In {
        hit_divide::In { numerator: input.numerator, denominator: input.denominator }
    }
    fn widened(out: hit_divide::Out) -> hit_divide::Out {
        out
    }
}

/// The pipeline of such a block, or of the one for primary rays.
pub enum Fitted<B: ForSecondary> {
    Primary(Pipeline<B::Primary>),
    Secondary(Pipeline<B>),
}

impl<B: ForSecondary> Fitted<B>
where
    B::Out: Copy,
    <B::Primary as Block>::Out: Copy,
{
    /// An empty pipeline, of the block that this hardware has or of so many copies, with the registers of its way from the contexts and back.
    pub fn linked(hardware: &Hardware, copies: u32) -> Self {
        if hardware.secondary {
            Self::Secondary(Pipeline::in_turns(hardware, copies))
        } else {
            Self::Primary(Pipeline::in_turns(hardware, copies))
        }
    }

    /// Whether it would take an input in this cycle; its consumer is always ready.
    pub fn ready(&self) -> bool {
        match self {
            Self::Primary(of) => of.ready(true),
            Self::Secondary(of) => of.ready(true),
        }
    }

    /// The result offered, with its tag.
    pub fn offered(&self) -> Option<(B::Out, u16)> {
        match self {
            Self::Primary(of) => of.offered().map(|(out, tag)| (B::widened(out), tag)),
            Self::Secondary(of) => of.offered(),
        }
    }

    /// The block's name, and what it did so far.
    pub fn counts(&self) -> (&'static str, BlockCounts) {
        match self {
            Self::Primary(of) => (B::Primary::NAME, of.counts()),
            Self::Secondary(of) => (B::NAME, of.counts()),
        }
    }

    /// The end of a cycle; `input` is taken if the pipeline is ready.
    pub fn tick(&mut self, input: Option<(&B::In, u16)>) {
        match self {
            Self::Primary(of) => match input {
                Some((input, tag)) => of.tick(Some((&B::of_primary(input), tag)), true),
                None => of.tick(None, true),
            },
            Self::Secondary(of) => of.tick(input, true),
        }
    }
}
