//! Hits of the blocks in the words of the golden traverser.

use lodray::golden::exact::ExactHit;
use lodray::method::Hit;

/// The fields of a hit as the golden traverser names them.
pub fn plain(hit: &Hit) -> ExactHit {
    let [b0, b1, b2, f0, f1, f2] = [hit.b0, hit.b1, hit.b2, hit.full_b0, hit.full_b1, hit.full_b2].map(|b| b.get() as u32);
    ExactHit {
        t: hit.t.get(),
        tree: hit.tree.get() as u32,
        level: hit.level.get() as u32,
        node: hit.node.get() as u32,
        bary: [b0, b1, b2],
        full_node: hit.full_node.get() as u32,
        full_bary: [f0, f1, f2],
        front: hit.front,
    }
}
