//! Which clusters are seen in a frame.
//!
//! From the groups that nothing stands for downwards: a cluster is taken if it is of the mesh itself, or if the group whose simplification it is a part of serves. Measures grow
//! from a group to all that hold its simplification, so a group below one that serves serves too, and what is taken covers the model once.

use super::graph::{Graph, Group};
use crate::rays::Eye;

/// When a simplification serves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rule {
    /// Its error is no more than so many pixels where the group is nearest to an eye, if that is asked.
    pub error: Option<f64>,
    /// The diagonal of the group's box is no more than so many pixels there, if that is asked.
    pub size: Option<f64>,
    /// Both allow so many times as much of groups that no eye's view meets.
    pub outside: f64,
}

/// The clusters that are taken, and what was looked at for that.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Cut {
    /// The clusters, ascending.
    pub clusters: Vec<u32>,
    /// The groups that were asked whether they serve, and those without a simplification: in the order in which that was.
    pub asked: Vec<u32>,
}

impl Rule {
    /// Whether the simplification of a group serves all of these eyes, in its units.
    pub fn serves(&self, group: &Group, eyes: &[Eye]) -> bool {
        !group.is_last() && eyes.iter().all(|eye| self.serves_one(group, eye))
    }

    fn serves_one(&self, group: &Group, eye: &Eye) -> bool {
        let sphere = &group.sphere;
        let apart: [f64; 3] = std::array::from_fn(|k| (eye.lo[k] - sphere.centre[k]).max(sphere.centre[k] - eye.hi[k]).max(0.0));
        let distance = (apart.iter().map(|d| d * d).sum::<f64>().sqrt() - sphere.radius).max(0.0);
        let is_outside = eye.view.is_some_and(|view| view.misses(eye.lo, sphere.centre, sphere.radius));
        let factor = if is_outside { self.outside } else { 1.0 };
        // A cone has half a pixel's width as its radius.
        let error = |pixels: f64| group.error <= pixels * factor * 2.0 * (eye.radius + eye.tan_theta * distance);
        let size = |pixels: f64| {
            let [lo, hi] = [group.bounds.lo, group.bounds.hi].map(|corner| corner.map(f64::from));
            let diagonal = (0..3).map(|k| (hi[k] - lo[k]).powi(2)).sum::<f64>().sqrt();
            diagonal <= pixels * factor * 2.0 * eye.least_radius(lo, hi)
        };
        self.error.is_none_or(error) && self.size.is_none_or(size)
    }
}

impl Cut {
    /// What these eyes see of a graph.
    pub fn new(graph: &Graph, rule: &Rule, eyes: &[Eye]) -> Self {
        let (mut cut, mut waiting) = (Self::default(), graph.last().collect::<Vec<_>>());
        let mut is_known = vec![false; graph.groups.len()];
        while let Some(group) = waiting.pop() {
            // Only such as do not serve wait.
            cut.asked.push(group);
            for cluster in graph.groups[group as usize].clusters() {
                if let Some(below) = graph.clusters[cluster].refined {
                    // Several groups may hold parts of its simplification: it is asked once.
                    let is_new = !std::mem::replace(&mut is_known[below as usize], true);
                    if !rule.serves(&graph.groups[below as usize], eyes) {
                        waiting.extend(is_new.then_some(below));
                        continue;
                    }
                    cut.asked.extend(is_new.then_some(below));
                }
                cut.clusters.push(cluster as u32);
            }
        }
        cut.clusters.sort_unstable();
        cut
    }
}
