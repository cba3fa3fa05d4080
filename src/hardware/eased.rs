//! What a ray waits for in a unit, turned off to see what it costs. No hardware is so, and `rtl/` has nothing of it.
//!
//! | name | what is eased |
//! |---|---|
//! | a block's | it takes any number of items in a cycle, each after the same latency |
//! | `all` | all blocks are so |
//! | `latency` | every block has its result a cycle later, and takes items as seldom as it does |
//! | `split_lines` | the lines of a split are asked for with the LOD test, as if its answer were known: none is read in vain |

use super::resource::Resource;
use serde::{Deserialize, Serialize};

/// What is eased; as text the names, joined by `+`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Eased(u16);

/// By name. Units for rays from a surface have the same parts under the names of blocks for exact starts.
const PARTS: [(&str, Resource); 9] = [
    ("ray_setup", Resource::Setup),
    ("node_address", Resource::Fetch),
    ("child_test", Resource::Child),
    ("tree_deciders", Resource::Decide),
    ("lod_test", Resource::Lod),
    ("tessellate", Resource::Morph),
    ("tri_test", Resource::Tri),
    ("hit_divide", Resource::Divide),
    ("bary_map", Resource::Map),
];

/// What is no block, by name; bits above those of resources.
const OTHERS: [(&str, u16); 2] = [("latency", LATENCY), ("split_lines", SPLIT_LINES)];
const LATENCY: u16 = 1 << 14;
const SPLIT_LINES: u16 = 1 << 15;
const _: () = assert!(Resource::COUNT <= 14);

impl Eased {
    /// All that there are by name: each block alone, what is no block, and all blocks together.
    pub fn each() -> impl Iterator<Item = (String, Self)> {
        Self::alone().map(|(name, bits)| (name.to_owned(), Self(bits))).chain([("all".to_owned(), Self::all())])
    }

    fn names() -> Vec<&'static str> {
        Self::alone().map(|part| part.0).collect()
    }

    /// Those but `all`, as bits.
    fn alone() -> impl Iterator<Item = (&'static str, u16)> {
        PARTS.iter().map(|&(name, resource)| (name, 1 << resource as u16)).chain(OTHERS)
    }

    fn all() -> Self {
        Self(PARTS.iter().fold(0, |all, &(_, resource)| all | 1 << resource as u16))
    }

    /// None.
    pub fn is_none(&self) -> bool {
        self.0 == 0
    }

    /// This block takes any number of items in a cycle.
    pub(crate) fn has(self, resource: Resource) -> bool {
        self.0 >> resource as u16 & 1 == 1
    }

    /// Every block has its result a cycle later.
    pub(crate) fn has_latency(self) -> bool {
        self.0 & LATENCY != 0
    }

    /// Lines of a split are asked for with the LOD test.
    pub(crate) fn has_split_lines(self) -> bool {
        self.0 & SPLIT_LINES != 0
    }
}

/// Names that are none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no part of a unit that can be eased: there are {names}, and all; several are joined by +", names = Eased::names().join(", "))]
pub struct EasedError(String);

impl TryFrom<String> for Eased {
    type Error = EasedError;

    fn try_from(text: String) -> Result<Self, EasedError> {
        let part = |name: &str| match Self::alone().find(|part| part.0 == name) {
            Some((_, bits)) => Ok(bits),
            None if name == "all" => Ok(Self::all().0),
            None => Err(EasedError(name.to_owned())),
        };
        text.split('+').map(|name| part(name.trim())).try_fold(Self(0), |all, part| Ok(Self(all.0 | part?)))
    }
}

impl From<Eased> for String {
    fn from(eased: Eased) -> Self {
        let names: Vec<&str> = Eased::alone().filter(|part| eased.0 & part.1 != 0).map(|part| part.0).collect();
        names.join("+")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_read_as_they_are_written() {
        for (name, eased) in Eased::each() {
            assert_eq!(Eased::try_from(name), Ok(eased));
            assert_eq!(Eased::try_from(String::from(eased)), Ok(eased));
            assert!(!eased.is_none());
        }
        let two = Eased::try_from("lod_test + ray_setup".to_owned()).unwrap();
        assert_eq!(String::from(two), "ray_setup+lod_test");
        assert!(two.has(Resource::Lod) && !two.has(Resource::Tri) && !two.has(Resource::Hit));
        let wrong = Eased::try_from("ray_setup+cache".to_owned()).unwrap_err().to_string();
        assert!(wrong.starts_with("`cache` is no part of a unit that can be eased: there are ray_setup, node_address,"), "{wrong}");
        assert!(wrong.contains("bary_map, latency, split_lines, and all;"), "{wrong}");
        // All blocks are: what is no block stays as it is.
        assert!(!Eased::all().has_latency() && !Eased::all().has_split_lines());
        assert!(Eased::try_from(String::new()).is_err());
    }
}
