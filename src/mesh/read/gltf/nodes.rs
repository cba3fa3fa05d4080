//! The nodes of a glTF scene: which mesh is placed where.

use super::super::{Fault, fault};
use ::gltf::json::{Index, Node, Root};
use glam::{DMat4, DQuat, DVec3};

/// A mesh at a place.
pub(super) struct Placed {
    pub(super) node: usize,
    /// Its index; not checked.
    pub(super) mesh: usize,
    pub(super) transform: DMat4,
    /// Weights of its morph targets, in place of the mesh's.
    pub(super) weights: Option<Vec<f32>>,
    pub(super) has_skin: bool,
}

/// A node, and where it is.
pub(super) struct Stands<'a> {
    pub(super) number: usize,
    pub(super) node: &'a Node,
    pub(super) transform: DMat4,
}

/// All meshes of the nodes that [`standing`] finds, in their order.
pub(super) fn placed(root: &Root) -> Result<Vec<Placed>, Fault> {
    let mesh = |stands: &Stands| {
        let node = stands.node;
        let (mesh, weights, has_skin) = (node.mesh?.value(), node.weights.clone(), node.skin.is_some());
        Some(Placed { node: stands.number, mesh, transform: stands.transform, weights, has_skin })
    };
    Ok(standing(root)?.iter().filter_map(mesh).collect())
}

/// All nodes of the default scene, or the first if none is the default, or all nodes if there is no scene; parents before children.
pub(super) fn standing(root: &Root) -> Result<Vec<Stands<'_>>, Fault> {
    let first = root.scene.map_or(0, |s| s.value());
    let mut todo: Vec<(usize, DMat4)> = match root.scenes.get(first) {
        Some(scene) => scene.nodes.iter().rev().map(|n| (n.value(), DMat4::IDENTITY)).collect(),
        None if root.scene.is_some() => return fault("scene", format_args!("scene {first} is not there")),
        None => parentless(root).into_iter().rev().map(|n| (n, DMat4::IDENTITY)).collect(),
    };
    let mut seen = vec![false; root.nodes.len()];
    let mut found = Vec::new();
    while let Some((number, parent)) = todo.pop() {
        let place = format!("node {number}");
        let Some(node) = root.nodes.get(number) else { return fault(place, "it is not there") };
        if std::mem::replace(&mut seen[number], true) {
            return fault(place, "it has two parents, or is a child of itself");
        }
        let transform = parent * local(node).or_else(|what| fault(&place, what))?;
        if !transform.is_finite() {
            return fault(place, "its transform is not finite");
        }
        found.push(Stands { number, node, transform });
        todo.extend(children(node).iter().rev().map(|n| (n.value(), transform)));
    }
    if root.scenes.is_empty()
        && let Some(number) = seen.iter().position(|seen| !seen)
    {
        return fault(format_args!("node {number}"), "it is a child of itself");
    }
    Ok(found)
}

fn children(node: &Node) -> &[Index<Node>] {
    node.children.as_deref().unwrap_or_default()
}

fn parentless(root: &Root) -> Vec<usize> {
    let mut is_child = vec![false; root.nodes.len()];
    for child in root.nodes.iter().flat_map(children) {
        if let Some(flag) = is_child.get_mut(child.value()) {
            *flag = true;
        }
    }
    (0..is_child.len()).filter(|&n| !is_child[n]).collect()
}

fn local(node: &Node) -> Result<DMat4, String> {
    if let Some(matrix) = node.matrix {
        return Ok(DMat4::from_cols_array(&matrix.map(f64::from)));
    }
    let vector = |v: Option<[f32; 3]>, default| v.map_or(default, |v| DVec3::from_array(v.map(f64::from)));
    let rotation = node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)));
    let length = rotation.length();
    if !(length > 0.0 && length.is_finite()) {
        return Err("its rotation is not a unit quaternion".into());
    }
    Ok(DMat4::from_scale_rotation_translation(vector(node.scale, DVec3::ONE), rotation / length, vector(node.translation, DVec3::ZERO)))
}
