//! What shards of a run would do, told before any is run.

use super::ShardArgs;
use lodray::study::shards::{Pieces, shares};
use std::path::{Path, PathBuf};

/// What shards of a run would do.
pub struct Planned {
    /// Folder of its results.
    pub out: PathBuf,
    /// Files that it reads.
    pub inputs: Vec<PathBuf>,
    /// Its command line names a shard itself.
    pub is_shard: bool,
    /// Where costs were measured, if they were.
    pub costs: Option<PathBuf>,
    pieces: Pieces,
    costs_of: Vec<u64>,
    openings: Vec<u64>,
}

impl Planned {
    pub fn new(args: &ShardArgs, out: &Path, inputs: Vec<PathBuf>, pieces: Pieces) -> anyhow::Result<Self> {
        let (costs_of, openings) = args.costs(&pieces)?;
        Ok(Self { out: out.to_owned(), inputs, is_shard: args.shard.is_some(), costs: args.costs.clone(), pieces, costs_of, openings })
    }

    /// How many jobs there are.
    pub fn jobs(&self) -> usize {
        self.pieces.all.iter().map(|piece| piece.keys.len()).sum()
    }

    /// How many parts there can be at most.
    pub fn pieces(&self) -> usize {
        self.pieces.all.len()
    }

    /// The longest shard over the mean of all. Opening scenes counts.
    pub fn longest(&self, shards: usize) -> f64 {
        let loads = shares(&self.pieces.all, &self.costs_of, &self.openings, shards).loads;
        let (most, all) = (loads.iter().copied().max().unwrap_or(0), loads.iter().map(|&load| load as f64).sum::<f64>());
        if all > 0.0 { most as f64 * shards as f64 / all } else { 1.0 }
    }
}
