//! Parts of a unit that never keep anybody waiting: a cause turned off, to see what it costs. No hardware is so, and `rtl/` has nothing of it.

use super::resource::Resource;
use serde::{Deserialize, Serialize};

/// Parts that take any number of items in a cycle, each after the same latency; as text their names, joined by `+`.
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

impl Eased {
    /// All that there are, each alone and then all together, by name.
    pub fn each() -> impl Iterator<Item = (String, Self)> {
        let alone = PARTS.iter().map(|&(name, resource)| (name.to_owned(), Self(1 << resource as u16)));
        alone.chain([("all".to_owned(), Self::all())])
    }

    fn all() -> Self {
        Self(PARTS.iter().fold(0, |all, &(_, resource)| all | 1 << resource as u16))
    }

    /// None.
    pub fn is_none(&self) -> bool {
        self.0 == 0
    }

    /// This part is one of them.
    pub(crate) fn has(self, resource: Resource) -> bool {
        self.0 >> resource as u16 & 1 == 1
    }
}

/// Names that are none.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("`{0}` is no part of a unit that can be eased: there are {names}, and all; several are joined by +", names = PARTS.map(|part| part.0).join(", "))]
pub struct EasedError(String);

impl TryFrom<String> for Eased {
    type Error = EasedError;

    fn try_from(text: String) -> Result<Self, EasedError> {
        let part = |name: &str| match PARTS.iter().find(|part| part.0 == name) {
            Some(&(_, resource)) => Ok(1 << resource as u16),
            None if name == "all" => Ok(Self::all().0),
            None => Err(EasedError(name.to_owned())),
        };
        text.split('+').map(|name| part(name.trim())).try_fold(Self(0), |all, part| Ok(Self(all.0 | part?)))
    }
}

impl From<Eased> for String {
    fn from(eased: Eased) -> Self {
        let names: Vec<_> = PARTS.iter().filter(|part| eased.has(part.1)).map(|part| part.0).collect();
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
        assert!(Eased::try_from(String::new()).is_err());
    }
}
