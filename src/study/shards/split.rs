//! Which shard does which piece.

use super::piece::Piece;
use std::cmp::Reverse;

/// Who does what.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Shares {
    /// The shard, from 0, of each piece.
    pub of: Vec<usize>,
    /// What each shard takes, openings of scenes included.
    pub loads: Vec<u64>,
}

/// Shares out pieces among so many shards. The longest piece goes first, each to the shard that is done with it soonest: one that does not have the
/// piece's scene yet has to open it, which takes `openings` by scene. Of pieces or shards alike the first is taken, so that all who ask get the same answer.
pub fn shares(pieces: &[Piece], costs: &[u64], openings: &[u64], shards: usize) -> Shares {
    let shards = shards.max(1);
    let mut order: Vec<usize> = (0..pieces.len()).collect();
    order.sort_by_key(|&at| (Reverse(costs[at]), at));
    let mut loads = vec![0u64; shards];
    let mut opened = vec![false; shards * openings.len()];
    let mut of = vec![0; pieces.len()];
    for at in order {
        let scene = pieces[at].scene;
        let after = |shard: usize| {
            let opening = if opened[shard * openings.len() + scene] { 0 } else { openings[scene] };
            loads[shard].saturating_add(opening).saturating_add(costs[at])
        };
        let (load, shard) = (0..shards).map(|shard| (after(shard), shard)).min().unwrap_or_default();
        (loads[shard], opened[shard * openings.len() + scene], of[at]) = (load, true, shard);
    }
    Shares { of, loads }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(scenes: &[usize]) -> Vec<Piece> {
        scenes.iter().map(|&scene| Piece { scene, keys: Vec::new(), estimate: 0 }).collect()
    }

    fn of(scenes: &[usize], costs: &[u64], openings: &[u64], shards: usize) -> Vec<usize> {
        shares(&pieces(scenes), costs, openings, shards).of
    }

    #[test]
    fn the_longest_goes_first_and_ties_go_by_number() {
        assert_eq!(of(&[0; 5], &[1, 9, 4, 4, 1], &[0], 2), [1, 0, 1, 1, 0]);
        assert_eq!(of(&[0; 4], &[1; 4], &[0], 3), [0, 1, 2, 0]);
        assert_eq!(of(&[0; 2], &[1; 2], &[0], 5), [0, 1]);
        assert!(of(&[], &[], &[], 3).is_empty());
    }

    #[test]
    fn a_scene_that_takes_long_to_open_stays_with_few() {
        // Either scene would be opened by both shards otherwise.
        assert_eq!(of(&[0, 0, 1, 1], &[3, 2, 3, 2], &[10, 10], 2), [0, 0, 1, 1]);
        // A shard more is worth it where a scene has much to do.
        assert_eq!(of(&[0, 0], &[30, 30], &[10], 2), [0, 1]);
    }

    #[test]
    fn shards_take_about_as_long() {
        let costs: Vec<u64> = (0..1000u64).map(|k| 1 + k * k % 97).collect();
        let Shares { of, loads } = shares(&pieces(&[0; 1000]), &costs, &[5], 16);
        let mut sums = [5; 16];
        of.iter().zip(&costs).for_each(|(&shard, cost)| sums[shard] += cost);
        assert_eq!(loads, sums);
        assert!(loads.iter().max().unwrap() - loads.iter().min().unwrap() <= 2, "{loads:?}");
    }
}
