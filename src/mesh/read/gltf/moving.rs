//! Vertices of a glTF file in motion: animated nodes, joints (skins) and weights of morph targets, sampled at a time.

use super::accessor::{MAX_ZEROS, Reader};
use super::nodes::{placed, standing};
use super::{Builder, MAGIC, in_binary, is_triangles, root};
use crate::mesh::read::{Fault, fault};
use ::gltf::json::accessor::Accessor;
use ::gltf::json::animation::{Interpolation, Property, Sampler};
use ::gltf::json::mesh::{Primitive, Semantic};
use ::gltf::json::validation::Checked;
use ::gltf::json::{Index, Node, Root, Skin};
use glam::{DMat4, DQuat, DVec3, DVec4};
use std::path::Path;

/// Most numbers of all that moves a file's vertices: keys of its animations, morph targets, joints. Many may come from the same few bytes.
const MAX_NUMBERS: usize = 1 << 28;

/// Numbers of a joint: where it is in `nodes`, and its inverse bind matrix.
const JOINT: usize = 17;

/// How many numbers that move its vertices a file may still have.
struct Budget(usize);

impl Budget {
    /// Counts numbers, best before there is memory for them.
    fn take(&mut self, numbers: usize, place: &str) -> Result<(), Fault> {
        let Some(left) = self.0.checked_sub(numbers) else {
            return fault(place, format_args!("with it there are more than {MAX_NUMBERS} numbers that move vertices"));
        };
        self.0 = left;
        Ok(())
    }
}

/// What is needed of a file to say where its vertices are at a time.
#[derive(Clone, Debug)]
pub(in crate::mesh::read) struct MovingParts {
    /// Where they are at rest, as [`parse`](super::parse) reads them.
    pub rest: Vec<[f64; 3]>,
    pub triangles: Vec<[u32; 3]>,
    pub clips: Vec<Clip>,
    /// Parents before children.
    nodes: Vec<Moving>,
    pieces: Vec<Piece>,
}

/// An animation.
#[derive(Clone, Debug)]
pub(in crate::mesh::read) struct Clip {
    pub name: String,
    /// The last key's time, in seconds.
    pub duration: f64,
    channels: Vec<Channel>,
}

/// A node's transform within its parent's, and what its animations may change.
#[derive(Clone, Debug)]
struct Moving {
    number: usize,
    parent: Option<usize>,
    matrix: Option<DMat4>,
    translation: DVec3,
    rotation: DQuat,
    scale: DVec3,
    weights: Option<Vec<f64>>,
}

/// The vertices of a primitive of a node's mesh.
#[derive(Clone, Debug)]
struct Piece {
    /// Place in `nodes`.
    node: usize,
    positions: Vec<DVec3>,
    /// Weights of the targets at rest, and how each moves the vertices, if it does.
    weights: Vec<f64>,
    targets: Vec<Option<Vec<DVec3>>>,
    /// Joints as places in `nodes`, each with its inverse bind matrix; of each vertex which of them, and their weights.
    joints: Vec<(usize, DMat4)>,
    skin: Vec<Vec<(usize, f64)>>,
}

/// One property of one node over time.
#[derive(Clone, Debug)]
struct Channel {
    node: usize,
    property: Property,
    interpolation: Interpolation,
    /// In seconds, each above the one before.
    times: Vec<f64>,
    /// Numbers of a key, and of all keys; of a cubic spline each key has two slopes around its value.
    width: usize,
    values: Vec<f64>,
}

/// What a file of either form has.
pub(in crate::mesh::read) fn parse_moving(bytes: &[u8], folder: &Path) -> Result<MovingParts, Fault> {
    if bytes.starts_with(MAGIC) { in_binary(bytes, |json, bin| build(json, bin, folder)) } else { build(bytes, None, folder) }
}

fn build(json: &[u8], bin: Option<&[u8]>, folder: &Path) -> Result<MovingParts, Fault> {
    let root = root(json)?;
    let reader = Reader::new(&root, bin, folder);
    let nodes = nodes(&root)?;
    let place_of = |number: usize| nodes.iter().position(|node| node.number == number);
    let mut builder = Builder::new(&root, &reader);
    let mut budget = Budget(MAX_NUMBERS);
    let mut pieces = Vec::new();
    for placed in placed(&root)? {
        builder.mesh(&placed)?;
        let (Some(mesh), Some(node)) = (root.meshes.get(placed.mesh), place_of(placed.node)) else { continue };
        let weights = placed.weights.as_deref().or(mesh.weights.as_deref()).unwrap_or_default();
        for (i, primitive) in mesh.primitives.iter().enumerate().filter(|(_, primitive)| is_triangles(primitive)) {
            let place = format!("mesh {}, primitive {i}", placed.mesh);
            let mut piece = piece(&reader, primitive, weights, node, &mut budget, &place)?;
            if let Some(number) = root.nodes[placed.node].skin.map(|skin| skin.value()) {
                let Some(skin) = root.skins.get(number) else { return fault(format_args!("skin {number}"), "it is not there") };
                let vertices = piece.positions.len();
                (piece.joints, piece.skin) = skin_of(&reader, (number, skin), primitive, vertices, &mut budget, &place, place_of)?;
            }
            pieces.push(piece);
        }
    }
    let parts = builder.finish();
    if parts.triangles.is_empty() {
        return fault("scene", "there are no triangles in it");
    }
    let clips = clips(&root, &reader, &pieces, &nodes, &mut budget, place_of)?;
    Ok(MovingParts { rest: parts.positions, triangles: parts.triangles, clips, nodes, pieces })
}

fn nodes(root: &Root) -> Result<Vec<Moving>, Fault> {
    let standing = standing(root)?;
    let mut nodes: Vec<Moving> = Vec::with_capacity(standing.len());
    let mut parents = vec![None; root.nodes.len()];
    for (place, stands) in standing.iter().enumerate() {
        let node: &Node = stands.node;
        for child in node.children.iter().flatten() {
            if let Some(parent) = parents.get_mut(child.value()) {
                *parent = Some(place);
            }
        }
        let vector = |v: Option<[f32; 3]>, default| v.map_or(default, |v| DVec3::from_array(v.map(f64::from)));
        nodes.push(Moving {
            number: stands.number,
            parent: parents[stands.number],
            matrix: node.matrix.map(|matrix| DMat4::from_cols_array(&matrix.map(f64::from))),
            translation: vector(node.translation, DVec3::ZERO),
            // That it is none of zeros was seen.
            rotation: node.rotation.map_or(DQuat::IDENTITY, |q| DQuat::from_array(q.0.map(f64::from)).normalize()),
            scale: vector(node.scale, DVec3::ONE),
            weights: node.weights.as_ref().map(|weights| weights.iter().copied().map(f64::from).collect()),
        });
    }
    Ok(nodes)
}

fn piece(reader: &Reader, primitive: &Primitive, weights: &[f32], node: usize, budget: &mut Budget, place: &str) -> Result<Piece, Fault> {
    let Some(&positions) = primitive.attributes.get(&Checked::Valid(Semantic::Positions)) else {
        return fault(place, "it has no attribute POSITION");
    };
    let points = |index, zeros, place: &str| -> Result<Vec<DVec3>, Fault> {
        Ok(reader.vectors(index, zeros, place)?.into_iter().map(DVec3::from_array).collect())
    };
    let positions = points(positions, MAX_ZEROS, &format!("{place}, POSITION"))?;
    let all = primitive.targets.as_deref().unwrap_or_default();
    let moving = all.iter().filter(|target| target.positions.is_some()).count();
    budget.take((3 * positions.len()).saturating_mul(moving).saturating_add(all.len() + weights.len()), place)?;
    let mut targets = Vec::with_capacity(all.len());
    for (i, target) in all.iter().enumerate() {
        let Some(index) = target.positions else {
            targets.push(None);
            continue;
        };
        let place = format!("{place}, target {i}, POSITION");
        let by = points(index, positions.len(), &place)?;
        if by.len() != positions.len() {
            return fault(place, format_args!("it has {} items for {} vertices", by.len(), positions.len()));
        }
        targets.push(Some(by));
    }
    Ok(Piece { node, positions, weights: weights.iter().copied().map(f64::from).collect(), targets, joints: Vec::new(), skin: Vec::new() })
}

/// Joints with their inverse bind matrices, and those of each vertex with their weights, which sum to 1.
type Skinned = (Vec<(usize, DMat4)>, Vec<Vec<(usize, f64)>>);

fn skin_of(
    reader: &Reader,
    (number, skin): (usize, &Skin),
    primitive: &Primitive,
    vertices: usize,
    budget: &mut Budget,
    place: &str,
    place_of: impl Fn(usize) -> Option<usize>,
) -> Result<Skinned, Fault> {
    let own = format!("skin {number}");
    budget.take(JOINT * skin.joints.len(), place)?;
    let bind = match skin.inverse_bind_matrices {
        Some(index) => reader.matrices(index, skin.joints.len(), &own)?,
        None => vec![DMat4::IDENTITY.to_cols_array(); skin.joints.len()],
    };
    if bind.len() < skin.joints.len() {
        return fault(own, format_args!("it has {} joints and {} inverse bind matrices", skin.joints.len(), bind.len()));
    }
    let mut joints = Vec::with_capacity(skin.joints.len());
    for (joint, bind) in skin.joints.iter().zip(&bind) {
        let Some(node) = place_of(joint.value()) else {
            return fault(own, format_args!("its joint, node {}, is not in the scene", joint.value()));
        };
        joints.push((node, DMat4::from_cols_array(bind)));
    }
    let mut of_vertices = vec![Vec::new(); vertices];
    for set in 0.. {
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let (Some(which), Some(weights)) = (attribute(Semantic::Joints(set)), attribute(Semantic::Weights(set))) else { break };
        // Four joints with their weights for each vertex.
        budget.take(8 * vertices, place)?;
        let which = reader.joints(which, vertices, &format!("{place}, JOINTS_{set}"))?;
        let weights = reader.fours(weights, vertices, &format!("{place}, WEIGHTS_{set}"))?;
        if which.len() != vertices || weights.len() != vertices {
            return fault(place, format_args!("it has {vertices} positions, {} joints and {} weights", which.len(), weights.len()));
        }
        for (vertex, (which, weights)) in which.iter().zip(&weights).enumerate() {
            for (&joint, &weight) in which.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
                if joint as usize >= joints.len() {
                    return fault(place, format_args!("vertex {vertex}: joint {joint} is out of range, {own} has {}", joints.len()));
                }
                of_vertices[vertex].push((joint as usize, weight));
            }
        }
    }
    for (vertex, of) in of_vertices.iter_mut().enumerate() {
        let sum: f64 = of.iter().map(|joint| joint.1).sum();
        if !(sum > 0.0 && sum.is_finite()) {
            return fault(place, format_args!("vertex {vertex}: its weights of joints sum to {sum}"));
        }
        of.iter_mut().for_each(|joint| joint.1 /= sum);
    }
    Ok((joints, of_vertices))
}

fn clips(
    root: &Root,
    reader: &Reader,
    pieces: &[Piece],
    nodes: &[Moving],
    budget: &mut Budget,
    place_of: impl Fn(usize) -> Option<usize>,
) -> Result<Vec<Clip>, Fault> {
    let mut clips = Vec::with_capacity(root.animations.len());
    for (number, animation) in root.animations.iter().enumerate() {
        let place = format!("animation {number}");
        let mut channels = Vec::new();
        for (i, channel) in animation.channels.iter().enumerate() {
            let place = format!("{place}, channel {i}");
            let Checked::Valid(property) = channel.target.path else { return fault(place, "what it moves is not known") };
            let Some(sampler) = animation.samplers.get(channel.sampler.value()) else {
                return fault(place, format_args!("sampler {} is not there", channel.sampler.value()));
            };
            // What is not in the scene moves nothing in it.
            let Some(node) = place_of(channel.target.node.value()) else { continue };
            if nodes[node].matrix.is_some() && property != Property::MorphTargetWeights {
                return fault(place, format_args!("node {} has a matrix, which cannot be animated", channel.target.node.value()));
            }
            let width = match property {
                Property::Translation | Property::Scale => 3,
                Property::Rotation => 4,
                // A node without a mesh that has targets has nothing to move.
                Property::MorphTargetWeights => match pieces.iter().find(|piece| piece.node == node) {
                    Some(piece) if !piece.targets.is_empty() => piece.targets.len(),
                    _ => continue,
                },
            };
            channels.push(sampled(reader, sampler, node, property, width, budget, &place)?);
        }
        let duration = channels.iter().filter_map(|channel| channel.times.last()).fold(0.0, |most: f64, &time| most.max(time));
        clips.push(Clip { name: animation.name.clone().unwrap_or_else(|| number.to_string()), duration, channels });
    }
    Ok(clips)
}

fn sampled(
    reader: &Reader,
    sampler: &Sampler,
    node: usize,
    property: Property,
    width: usize,
    budget: &mut Budget,
    place: &str,
) -> Result<Channel, Fault> {
    let Checked::Valid(interpolation) = sampler.interpolation else { return fault(place, "its interpolation is not known") };
    let numbers = |index: Index<Accessor>, name: &str| -> Result<Vec<f64>, Fault> {
        let place = format!("{place}, {name}");
        Ok(match (name, property) {
            ("output", Property::Rotation) => reader.fours(index, MAX_ZEROS, &place)?.into_flattened(),
            ("output", Property::Translation | Property::Scale) => reader.vectors(index, MAX_ZEROS, &place)?.into_flattened(),
            _ => reader.scalars(index, MAX_ZEROS, &place)?,
        })
    };
    let (times, values) = (numbers(sampler.input, "input")?, numbers(sampler.output, "output")?);
    if !times.iter().chain(&values).all(|v| v.is_finite()) {
        return fault(place, "a time or a value is not finite");
    }
    if !times.windows(2).all(|two| two[0] < two[1]) {
        return fault(place, "its times do not ascend");
    }
    let each = if interpolation == Interpolation::CubicSpline { 3 * width } else { width };
    if Some(values.len()) != times.len().checked_mul(each) {
        return fault(place, format_args!("{} times need {each} numbers each, it has {}", times.len(), values.len()));
    }
    budget.take(times.len() + values.len(), place)?;
    Ok(Channel { node, property, interpolation, times, width, values })
}

impl Channel {
    /// The property's numbers at a time: before the first key and behind the last those keys'.
    fn at(&self, time: f64) -> Vec<f64> {
        let cubic = self.interpolation == Interpolation::CubicSpline;
        let (each, skip) = if cubic { (3 * self.width, self.width) } else { (self.width, 0) };
        // The part of a key: slope in, value and slope out of a cubic spline.
        let part = |key: usize, from: usize| &self.values[key * each + from..][..self.width];
        let value = |key| part(key, skip);
        let after = self.times.partition_point(|&key| key <= time);
        let (before, next) = match after {
            0 => return value(0).to_vec(),
            _ if after == self.times.len() => return value(after - 1).to_vec(),
            _ => (after - 1, after),
        };
        let length = self.times[next] - self.times[before];
        let u = (time - self.times[before]) / length;
        match self.interpolation {
            Interpolation::Step => value(before).to_vec(),
            Interpolation::Linear if self.property == Property::Rotation => {
                let quaternion = |key| DQuat::from_slice(value(key)).normalize();
                quaternion(before).slerp(quaternion(next), u).to_array().to_vec()
            }
            Interpolation::Linear => value(before).iter().zip(value(next)).map(|(a, b)| a + u * (b - a)).collect(),
            Interpolation::CubicSpline => {
                let (u2, u3) = (u * u, u * u * u);
                let [p0, m0, p1, m1] = [2.0 * u3 - 3.0 * u2 + 1.0, u3 - 2.0 * u2 + u, 3.0 * u2 - 2.0 * u3, u3 - u2];
                let (out, into) = (part(before, 2 * self.width), part(next, 0));
                (0..self.width)
                    .map(|k| p0 * value(before)[k] + m0 * length * out[k] + p1 * value(next)[k] + m1 * length * into[k])
                    .collect()
            }
        }
    }
}

impl MovingParts {
    /// Where the vertices are at a time of a clip, in seconds.
    pub fn at(&self, clip: &Clip, time: f64) -> Vec<[f64; 3]> {
        let mut nodes = self.nodes.clone();
        let mut weights: Vec<Option<Vec<f64>>> = nodes.iter().map(|node| node.weights.clone()).collect();
        for channel in &clip.channels {
            let (value, node) = (channel.at(time), &mut nodes[channel.node]);
            match channel.property {
                Property::Translation => node.translation = DVec3::from_slice(&value),
                Property::Scale => node.scale = DVec3::from_slice(&value),
                Property::Rotation => {
                    let length = DVec4::from_slice(&value).length();
                    if length > 0.0 {
                        node.rotation = DQuat::from_vec4(DVec4::from_slice(&value) / length);
                    }
                }
                Property::MorphTargetWeights => weights[channel.node] = Some(value),
            }
        }
        let mut whole: Vec<DMat4> = Vec::with_capacity(nodes.len());
        for node in &nodes {
            let own = node.matrix.unwrap_or_else(|| DMat4::from_scale_rotation_translation(node.scale, node.rotation, node.translation));
            whole.push(node.parent.map_or(own, |parent| whole[parent] * own));
        }
        self.pieces.iter().flat_map(|piece| piece.moved(&whole, weights[piece.node].as_deref())).collect()
    }
}

impl Piece {
    fn moved(&self, whole: &[DMat4], weights: Option<&[f64]>) -> Vec<[f64; 3]> {
        let joints: Vec<DMat4> = self.joints.iter().map(|(node, bind)| whole[*node] * *bind).collect();
        let weighted = self.targets.iter().zip(weights.unwrap_or(&self.weights));
        let targets: Vec<(&[DVec3], f64)> =
            weighted.filter(|(_, weight)| **weight != 0.0).filter_map(|(target, &weight)| Some((target.as_deref()?, weight))).collect();
        let vertex = |v: usize| {
            let moved: DVec3 = targets.iter().map(|(target, weight)| target[v] * *weight).sum();
            let p = self.positions[v] + moved;
            // Joints take a vertex to the scene: where its node is does not matter then.
            match self.skin.get(v) {
                Some(of) => of.iter().map(|&(joint, weight)| joints[joint].transform_point3(p) * weight).sum::<DVec3>(),
                None => whole[self.node].transform_point3(p),
            }
        };
        (0..self.positions.len()).map(|v| vertex(v).to_array()).collect()
    }
}
