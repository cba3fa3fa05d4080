//! All methods.

use super::{Registered, binary16, bvh, chunked, cluster, discrete, grid, lod, reference, rlod, stochastic};

/// Every method, in the order in which help names them.
pub const METHODS: &[&Registered] = &[
    &lod::METHOD,
    &bvh::METHOD,
    &bvh::METHOD_SIX,
    &bvh::METHOD_WIDE,
    &binary16::METHOD,
    &discrete::METHOD,
    &stochastic::METHOD,
    &chunked::METHOD,
    &grid::METHOD,
    &cluster::METHOD,
    &cluster::METHOD_PAPER,
    &rlod::METHOD,
    &bvh::METHOD_INPUT,
    &bvh::METHOD_INPUT_SIX,
    &bvh::METHOD_INPUT_WIDE,
    &reference::METHOD,
];

/// The method of this name.
pub fn find(name: &str) -> Option<&'static Registered> {
    METHODS.iter().copied().find(|method| method.name == name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::{BTreeMap, HashSet};

    #[test]
    fn names_are_told_apart_and_knobs_of_one_name_are_one() {
        let mut names = HashSet::new();
        let mut knobs = BTreeMap::new();
        for method in METHODS {
            assert!(names.insert(method.name) && std::ptr::eq(find(method.name).unwrap(), *method));
            for knob in method.knobs {
                let first: &&crate::method::Knob = knobs.entry(knob.name).or_insert(*knob);
                assert!(std::ptr::eq(*first, *knob), "{}: two knobs of one name", knob.name);
                assert!(knob.default.is_none_or(|default| knob.check(default).is_ok()), "{}: its default", knob.name);
            }
        }
        assert!(find("none").is_none());
    }
}
