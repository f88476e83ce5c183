//! Nodes that become animated: glTF animates no matrices.

use super::draw::Draw;
use super::error::SaveError;
use super::json::list::{ListEdit, edit};
use super::json::patch::TextPatch;
use super::json::style::Fresh;
use super::json::token::number;
use crate::data::{Bone, ModelData};
use std::collections::BTreeMap;

/// Replaces the matrix of each of the `nodes` that has one by the translation, rotation and scale that the importer
/// decomposed it into, so that the pose stays the same. Each node comes with the name of a take that animates it.
pub(super) fn without_matrix<'t>(
    draw: &mut Draw<'_, '_>,
    opened: &ModelData,
    nodes: impl Iterator<Item = (u32, &'t str)>,
) -> Result<(), SaveError> {
    let nodes: BTreeMap<u32, &str> = nodes.collect();
    for bone in &opened.animation.skeleton.bones {
        let Some((node, take)) = bone.node.and_then(|node| Some((node, *nodes.get(&node)?))) else {
            continue;
        };
        let json = draw.document.json;
        let Some(&id) = draw.document.nodes.get(node as usize) else { continue };
        let Some(matrix) = json.member(id, "matrix") else { continue };
        let refuse = |reason| SaveError::Node { take: take.to_owned(), bone: bone.name.clone(), reason };
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
        // The new members replace the matrix.
        let added = ListEdit { removed: Vec::new(), inserted };
        let pointer = format!("/nodes/{node}");
        let mut patches = edit(json, id, &added, &draw.style, &spot, &pointer);
        let mut text: String = patches.drain(..).map(|patch| patch.text).collect();
        // The first member goes without the comma and space that would follow the matrix.
        let first = text.find('"').unwrap_or(0);
        text.drain(..first);
        let span = json.item_span(matrix);
        draw.patches.push(TextPatch::new(span, text, format!("{pointer}/matrix")));
        draw.changes.nodes.push(node);
    }
    Ok(())
}

fn parts(bone: &Bone) -> [(&'static str, Fresh<'static>); 3] {
    let array =
        |numbers: &[f32]| Fresh::Array(numbers.iter().map(|&value| Fresh::Raw(number(value))).collect());
    [
        ("translation", array(&bone.rest.translation.to_array())),
        ("rotation", array(&bone.rest.rotation.to_array())),
        ("scale", array(&bone.rest.scale.to_array())),
    ]
}
