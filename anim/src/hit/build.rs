//! Construction of the tree: the triangles of each leaf, and the leaves of each node.

use super::tree::{HitLeaf, HitNode, HitTreeParts, is_valid};
use crate::data::{MAX_INFLUENCES, MeshInstance, ModelData, Primitive};
use crate::evaluator::Evaluator;
use crate::skin::skin_position;
use glam::Vec3;
use std::ops::Range;
use std::sync::Arc;

/// Largest number of triangles of a leaf. Small, because reaching a leaf means skinning it.
const MOST: usize = 8;

/// Key of triangles that no bone moves; sorts after every bone.
const NO_BONE: u32 = u32::MAX;

/// A triangle to be inserted.
#[derive(Clone, Copy)]
struct Item {
    /// Bone, instance and primitive: triangles with equal keys form a subtree of their own.
    key: (u32, u32, u32),
    triangle: u32,
    /// Center of the corners in the rest pose.
    center: Vec3,
}

/// Returns the lists of a tree over every valid triangle of every instance.
///
/// Triangles are grouped by the bone that moves them most; a group is halved along the longest extent of its centers,
/// in the rest pose, until few are left; above the groups the same is done with the groups.
pub(super) fn parts(model: &ModelData) -> HitTreeParts {
    let mut items = items(model);
    items.sort_unstable_by_key(|item| (item.key, item.triangle));
    let mut groups: Vec<(Vec3, Range<usize>)> = Vec::new();
    let mut start = 0;
    for group in items.chunk_by(|a, b| a.key == b.key) {
        let share = 1.0 / group.len() as f32;
        let center = group.iter().map(|item| item.center * share).sum();
        groups.push((center, start..start + group.len()));
        start += group.len();
    }
    let mut parts = HitTreeParts::default();
    if !groups.is_empty() {
        over_groups(&mut groups, &mut items, &mut parts);
    }
    parts
}

/// Returns every valid triangle, with its key and its center.
fn items(model: &ModelData) -> Vec<Item> {
    let evaluator = Evaluator::new(Arc::new(model.clone()));
    let (mut items, mut positions) = (Vec::new(), Vec::new());
    for (instance, of) in model.instances.iter().enumerate() {
        for (index, primitive) in evaluator.primitives(instance).iter().enumerate() {
            // A mesh of many vertices and few triangles may be placed very often: only its corners are posed.
            let is_sparse = primitive.indices.len() < primitive.vertices.len();
            let movement = evaluator.movement(instance, index);
            let weights = evaluator.morph_weights(instance);
            if !is_sparse {
                positions.resize(primitive.vertices.len(), Vec3::ZERO);
                evaluator.positions(instance, index, &mut positions);
            }
            let position = |&corner: &u32| match movement {
                Some(movement) if is_sparse => {
                    skin_position(primitive, movement, weights, corner as usize).unwrap_or_default()
                }
                _ => positions[corner as usize],
            };
            for triangle in (0..primitive.indices.len() / 3).filter(|&triangle| is_valid(primitive, triangle))
            {
                let corners = &primitive.indices[triangle * 3..triangle * 3 + 3];
                let center = corners.iter().map(|corner| position(corner) / 3.0).sum();
                let bone = greatest_bone(model, of, primitive, corners);
                items.push(Item {
                    key: (bone, instance as u32, index as u32),
                    triangle: triangle as u32,
                    center,
                });
            }
        }
    }
    items
}

/// Returns the bone with the greatest sum of weights over the corners.
fn greatest_bone(model: &ModelData, instance: &MeshInstance, primitive: &Primitive, corners: &[u32]) -> u32 {
    let Some(skin) = instance.skin else { return instance.bone.unwrap_or(NO_BONE) };
    let of_corner =
        |&corner: &u32| primitive.vertices.influences_of(corner as usize).iter().take(MAX_INFLUENCES);
    let influences = || corners.iter().flat_map(of_corner);
    let mut greatest = (NO_BONE, 0.0);
    for joint in influences().map(|influence| influence.joint) {
        let own = influences().filter(|influence| influence.joint == joint);
        let sum: f32 = own.map(|influence| influence.weight).sum();
        if sum > greatest.1 {
            let bone = model.skins.get(skin as usize).and_then(|skin| skin.bones.get(usize::from(joint)));
            greatest = (bone.copied().unwrap_or(NO_BONE), sum);
        }
    }
    greatest.0
}

/// Adds the nodes of `groups`, which is not empty, and those above them; returns the position of the highest.
fn over_groups(groups: &mut [(Vec3, Range<usize>)], items: &mut [Item], parts: &mut HitTreeParts) -> u32 {
    if let [(_, range)] = groups {
        return over_items(&mut items[range.clone()], parts);
    }
    let axis = longest(groups.iter().map(|group| group.0));
    let middle = groups.len() / 2;
    groups.select_nth_unstable_by(middle, |a, b| {
        a.0[axis].total_cmp(&b.0[axis]).then(a.1.start.cmp(&b.1.start))
    });
    let (left, right) = groups.split_at_mut(middle);
    let node = placeholder(parts);
    let children = [over_groups(left, items, parts), over_groups(right, items, parts)];
    parts.nodes[node] = HitNode::Inner(children);
    node as u32
}

/// Adds the nodes of `items`, which is not empty and has one key; returns the position of the highest.
fn over_items(items: &mut [Item], parts: &mut HitTreeParts) -> u32 {
    let node = placeholder(parts);
    if items.len() <= MOST {
        let (_, instance, primitive) = items[0].key;
        let (first, count) = (parts.triangles.len() as u32, items.len() as u32);
        parts.nodes[node] = HitNode::Leaf(parts.leaves.len() as u32);
        parts.leaves.push(HitLeaf { instance, primitive, first, count });
        parts.triangles.extend(items.iter().map(|item| item.triangle));
        return node as u32;
    }
    let axis = longest(items.iter().map(|item| item.center));
    let middle = items.len() / 2;
    items.select_nth_unstable_by(middle, |a, b| {
        a.center[axis].total_cmp(&b.center[axis]).then(a.triangle.cmp(&b.triangle))
    });
    let (left, right) = items.split_at_mut(middle);
    let children = [over_items(left, parts), over_items(right, parts)];
    parts.nodes[node] = HitNode::Inner(children);
    node as u32
}

/// Adds a node to be filled in when its children are known.
fn placeholder(parts: &mut HitTreeParts) -> usize {
    parts.nodes.push(HitNode::Leaf(0));
    parts.nodes.len() - 1
}

/// Returns the axis along which `points` spread most.
fn longest(points: impl Iterator<Item = Vec3>) -> usize {
    let (min, max) =
        points.fold((Vec3::MAX, Vec3::MIN), |(min, max), point| (min.min(point), max.max(point)));
    let size = max * 0.5 - min * 0.5;
    if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    }
}
