//! Parts of a mesh that hang together.

use super::sets::Sets;

/// The part of each triangle, counted in order of their first triangles, and how many parts there are: triangles are of one part if vertices that they share
/// lead from one to the other.
pub fn parts(triangles: &[[u32; 3]]) -> (Vec<u32>, usize) {
    let vertices = triangles.iter().flatten().max().map_or(0, |&last| last as usize + 1);
    // Each vertex by the first triangle that has it.
    let mut first = vec![None; vertices];
    let mut sets = Sets::new(triangles.len());
    for (triangle, of) in (0..).zip(triangles) {
        for &vertex in of {
            let first = *first[vertex as usize].get_or_insert(triangle);
            sets.join(first, triangle);
        }
    }
    sets.numbers()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn triangles_that_share_a_vertex_are_of_one_part() {
        let triangles = [[5, 6, 7], [0, 1, 2], [7, 8, 9], [3, 4, 10], [2, 1, 11]];
        assert_eq!(parts(&triangles), (vec![0, 1, 0, 2, 1], 3));
        assert_eq!(parts(&[]), (Vec::new(), 0));
    }
}
