//! What a file's parser hands to cleaning.

/// What a file's parser hands to cleaning.
#[derive(Default)]
pub(super) struct Parts {
    pub positions: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    /// For each triangle; empty if there are none.
    pub normals: Vec<[[f32; 3]; 3]>,
    pub materials: Vec<u16>,
    pub colours: Vec<[f32; 3]>,
    /// What of the file is not kept, a line each.
    pub warnings: Vec<String>,
}
