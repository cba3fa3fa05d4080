//! What contexts of a unit share.

/// What contexts share, one arbiter each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Resource {
    Setup,
    Fetch,
    Child,
    Decide,
    Lod,
    Morph,
    Tri,
    Divide,
    Map,
    Hit,
}

impl Resource {
    /// All, by number.
    pub const ALL: [Self; Self::COUNT] =
        [Self::Setup, Self::Fetch, Self::Child, Self::Decide, Self::Lod, Self::Morph, Self::Tri, Self::Divide, Self::Map, Self::Hit];
    /// How many there are.
    pub const COUNT: usize = Self::Hit as usize + 1;
}
