//! Nodes that begin to move: glTF animates no matrices.

use super::draw::Draw;
use super::error::SaveError;
use super::json::list::{ListEdit, edit};
use super::json::style::Fresh;
use super::json::token::number;
use crate::data::{Bone, ModelData};
use std::collections::BTreeSet;

/// Writes the matrix of each of the `nodes` that has one as translation, rotation and scale: those that importing
/// took it apart into, so that the pose stays the same.
pub(super) fn without_matrix(
    draw: &mut Draw<'_, '_>,
    opened: &ModelData,
    nodes: impl Iterator<Item = u32>,
) -> Result<(), SaveError> {
    let nodes: BTreeSet<u32> = nodes.collect();
    for bone in &opened.animation.skeleton.bones {
        let Some(node) = bone.node.filter(|node| nodes.contains(node)) else { continue };
        let json = draw.document.json;
        let Some(&id) = draw.document.nodes.get(node as usize) else { continue };
        let Some(matrix) = json.member(id, "matrix") else { continue };
        let refuse = |reason| SaveError::Node { take: String::new(), bone: bone.name.clone(), reason };
        if bone.rest_matrix.is_some() {
            return Err(refuse("has a sheared matrix, which glTF cannot animate"));
        }
        if ["translation", "rotation", "scale"].iter().any(|name| json.member(id, name).is_some()) {
            return Err(refuse("has a matrix and other transforms, which glTF cannot animate"));
        }
        let spot = draw.style.spot(json, Some(id), 3);
        let inserted = parts(bone)
            .into_iter()
            .map(|(name, numbers)| (Some(matrix), draw.style.member(name, &numbers, &spot)))
            .collect();
        // The new members stand where the matrix stood.
        let added = ListEdit { removed: Vec::new(), inserted };
        let pointer = format!("/nodes/{node}");
        let mut patches = edit(json, id, &added, &draw.style, &spot, &pointer);
        let mut text: String = patches.drain(..).map(|patch| patch.text).collect();
        // The first comes without the comma and space that it would have after the matrix.
        let first = text.find('"').unwrap_or(0);
        text.drain(..first);
        let span = json.item_span(matrix);
        draw.patches.push(super::json::patch::Patch::new(span, text, format!("{pointer}/matrix")));
        draw.changes.nodes.push(node);
    }
    Ok(())
}

fn parts(bone: &Bone) -> [(&'static str, Fresh); 3] {
    let array =
        |numbers: &[f32]| Fresh::Array(numbers.iter().map(|&value| Fresh::Raw(number(value))).collect());
    [
        ("translation", array(&bone.rest.translation.to_array())),
        ("rotation", array(&bone.rest.rotation.to_array())),
        ("scale", array(&bone.rest.scale.to_array())),
    ]
}
