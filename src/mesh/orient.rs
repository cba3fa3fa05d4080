//! Triangles that run different ways around, brought to one way where the surface has two sides.

use super::TriangleMesh;
use super::clean::count_edges;

impl TriangleMesh {
    /// Turns triangles so that the two at every edge of two run along it in opposite directions, in every connected piece that has two sides.
    ///
    /// The way that most triangles of a piece have stays; where both have as many, a closed piece faces outwards, and an open one is as its first triangle
    /// is. A piece of one side (a Moebius strip) stays as it is. A line in [`TriangleMesh::warnings`] says what was turned, or what cannot be.
    pub fn orient(&mut self) {
        if self.report.inconsistent_edges == 0 {
            return;
        }
        let neighbours = self.neighbours();
        let mut sides: Vec<Option<bool>> = vec![None; self.triangles.len()];
        let mut one_sided = 0;
        let mut turned = 0;
        for first in 0..self.triangles.len() {
            if sides[first].is_some() {
                continue;
            }
            let (piece, is_two_sided) = walk(first, &neighbours, &mut sides);
            if !is_two_sided {
                one_sided += 1;
                continue;
            }
            let other = piece.iter().filter(|&&t| sides[t] == Some(true)).count();
            let turn = match (2 * other).cmp(&piece.len()) {
                std::cmp::Ordering::Less => true,
                std::cmp::Ordering::Greater => false,
                std::cmp::Ordering::Equal => {
                    let is_closed = piece.iter().all(|&t| neighbours[t].iter().all(Option::is_some));
                    !is_closed || self.volume(&piece, &sides) >= 0.0
                }
            };
            for &t in piece.iter().filter(|&&t| sides[t] == Some(turn)) {
                self.triangles[t].swap(1, 2);
                if let Some(normals) = self.normals.get_mut(t) {
                    normals.swap(1, 2);
                }
                if let Some(texture) = self.texture.get_mut(t) {
                    texture.swap(1, 2);
                }
                turned += 1;
            }
        }
        count_edges(&self.triangles, &mut self.report);
        self.report.turned_triangles += turned;
        let all = self.triangles.len();
        if turned > 0 {
            self.warnings.push(format!("{turned} of {all} triangles ran the other way around than most beside them, and were turned"));
        }
        let left = self.report.inconsistent_edges;
        if left > 0 {
            let pieces = if one_sided == 1 { "a connected piece of it" } else { "some connected pieces of it" };
            self.warnings.push(format!(
                "{pieces} cannot be oriented, like a Moebius strip: sharp edges between triangles that face different ways: {left}"
            ));
        }
    }

    /// For each triangle and edge (from its corner k on) the triangle on the other side and whether it runs the same way along it; none at borders and
    /// edges of three or more.
    fn neighbours(&self) -> Vec<[Option<(usize, bool)>; 3]> {
        let mut edges: Vec<(u32, u32, bool, usize, usize)> = Vec::with_capacity(3 * self.triangles.len());
        for (t, tri) in self.triangles.iter().enumerate() {
            for k in 0..3 {
                let (a, b) = (tri[k], tri[(k + 1) % 3]);
                edges.push((a.min(b), a.max(b), a < b, t, k));
            }
        }
        edges.sort_unstable();
        let mut neighbours = vec![[None; 3]; self.triangles.len()];
        for run in edges.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            if let [a, b] = run {
                let same = a.2 == b.2;
                neighbours[a.3][a.4] = Some((b.3, same));
                neighbours[b.3][b.4] = Some((a.3, same));
            }
        }
        neighbours
    }

    /// Six times the volume within a closed piece as it is once those on the other side are turned.
    fn volume(&self, piece: &[usize], sides: &[Option<bool>]) -> f64 {
        let centre = self.positions[self.triangles[piece[0]][0] as usize];
        let term = |&t: &usize| {
            let [a, b, c] = self.triangles[t].map(|v| -> [f64; 3] { std::array::from_fn(|d| self.positions[v as usize][d] - centre[d]) });
            let cross = [b[1] * c[2] - b[2] * c[1], b[2] * c[0] - b[0] * c[2], b[0] * c[1] - b[1] * c[0]];
            let volume = a[0] * cross[0] + a[1] * cross[1] + a[2] * cross[2];
            if sides[t] == Some(true) { -volume } else { volume }
        };
        piece.iter().map(term).sum()
    }
}

/// Marks the piece of `first` with which triangles run the other way than it does; and whether there is an answer.
fn walk(first: usize, neighbours: &[[Option<(usize, bool)>; 3]], sides: &mut [Option<bool>]) -> (Vec<usize>, bool) {
    sides[first] = Some(false);
    let (mut piece, mut at, mut is_two_sided) = (vec![first], 0, true);
    while let Some(&t) = piece.get(at) {
        at += 1;
        for (next, same) in neighbours[t].into_iter().flatten() {
            let side = sides[t].map(|side| side ^ same);
            if sides[next].is_none() {
                sides[next] = side;
                piece.push(next);
            }
            is_two_sided &= sides[next] == side;
        }
    }
    (piece, is_two_sided)
}
