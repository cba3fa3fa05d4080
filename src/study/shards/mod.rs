//! Shards: the jobs of a study in several parts, for as many computers that share a folder, and all parts together again.
//!
//! [`shares`] says which shard does which [`Piece`], by what pieces cost, so that shards take about as long; every computer comes to the same. A shard does its [`Part`]
//! with a [`Shard`], whose lines nobody else writes, and [`gathered`] puts the lines of all together: those that one run alone would have written.

mod costs;
mod folder;
mod gather;
mod part;
mod piece;
mod split;
mod took;

pub use costs::{Costs, CostsError};
pub use folder::{FOLDER, Shard, Share};
pub use gather::{Gathered, NotDone, gathered};
pub use part::{Part, Spent};
pub use piece::{Opening, Piece, Pieces};
pub(super) use piece::{opening, rays};
pub use split::{Shares, shares};
