//! Root bones that edits put above the bones of the file: nodes that a save appends, and removes again.
//!
//! A new root bone is one more node at the end of the list, with the former root nodes as children; it takes their place
//! in every scene that lists one of them. Where the bone is gone again, so is its node, if it is still the last one;
//! otherwise the number of every node after it would change, so it stays, without children and in no scene.

use super::super::target_path::TargetPath;
use super::channels::{Action, ChannelEdit};
use super::document::{FileAnimation, SourceDocument};
use super::draw::Draw;
use super::error::SaveError;
use super::json::list::{ListEdit, edit};
use super::json::style::Fresh;
use crate::data::{AnimationData, Bone, ModelData, Skeleton};
use crate::limits::{NODE_DEPTH, NODES};
use crate::root_bone::BoneShift;
use std::borrow::Cow;
use std::collections::HashMap;
use std::sync::Arc;

/// The nodes of the root bones that a save adds and removes.
#[derive(Debug, Default)]
pub(super) struct RootNodes {
    /// Numbers and names of the new nodes, from the topmost one.
    added: Vec<(u32, String)>,
    /// Numbers and names of the nodes whose bones are gone, from the topmost one.
    removed: Vec<(u32, String)>,
    /// Nodes of the topmost bones that stay.
    below: Vec<u32>,
    /// Number of nodes of the file that stay in the list.
    kept: usize,
}

/// Returns the model as it was opened, with the bones of `skeleton`, as far as a save reads it; and the nodes that come
/// and go with them.
pub(super) fn with_roots<'m>(
    document: &SourceDocument<'_>,
    opened: &'m ModelData,
    skeleton: &Skeleton,
) -> Result<(Cow<'m, ModelData>, RootNodes), SaveError> {
    let old = resolved(document, &opened.animation.skeleton);
    let mismatch =
        |reason: &str| SaveError::Mismatch { place: "bones".to_owned(), reason: reason.to_owned() };
    let shift = BoneShift::between(&old, skeleton)
        .ok_or_else(|| mismatch("they differ in more than root bones from those that were opened"))?;
    if shift.is_identity() && matches!(old, Cow::Borrowed(_)) {
        return Ok((Cow::Borrowed(opened), RootNodes::default()));
    }
    let no_node = |bone: &Bone| mismatch(&format!("\"{}\" is not a node of the file", bone.name));
    let node = |bone: &Bone| bone.node.ok_or_else(|| no_node(bone));
    let named = |bone: &Bone| Ok((node(bone)?, bone.name.clone()));
    let (gone, stay) = old.bones.split_at(shift.removed());
    let removed = gone.iter().map(named).collect::<Result<Vec<_>, SaveError>>()?;
    let is_top = |bone: &&Bone| bone.parent.is_none_or(|parent| (parent as usize) < shift.removed());
    let below = match shift.is_identity() {
        true => Vec::new(),
        false => stay.iter().filter(is_top).map(node).collect::<Result<Vec<_>, SaveError>>()?,
    };
    let nodes = document.nodes.len();
    let is_gone = |number: usize| removed.iter().any(|(node, _)| *node as usize == number);
    let kept = (0..nodes).rev().find(|&number| !is_gone(number)).map_or(0, |last| last + 1);
    let new = skeleton.bones.iter().take(shift.added()).enumerate();
    let added: Vec<_> = new.map(|(index, bone)| ((kept + index) as u32, bone.name.clone())).collect();
    check_limits(document, &below, added.len(), kept)?;
    let of_new = added.iter().map(|(node, _)| Some(*node));
    let numbers = of_new.chain(stay.iter().map(|bone| bone.node));
    let bones = skeleton.bones.iter().zip(numbers).map(|(bone, node)| Bone { node, ..bone.clone() });
    let skeleton = Arc::new(Skeleton { bones: bones.collect() });
    let in_use = || mismatch("a mesh needs a bone that is gone");
    let takes = opened.animation.takes.iter().map(|take| Arc::new(shift.take(take))).collect();
    let model = ModelData {
        skins: opened.skins.iter().map(|skin| shift.skin(skin)).collect::<Option<_>>().ok_or_else(in_use)?,
        instances: opened
            .instances
            .iter()
            .map(|instance| shift.instance(instance))
            .collect::<Option<_>>()
            .ok_or_else(in_use)?,
        animation: AnimationData { skeleton, takes },
        ..ModelData::default()
    };
    Ok((Cow::Owned(model), RootNodes { added, removed, below, kept }))
}

/// Returns the skeleton with the nodes of topmost bones that an earlier save added: the parents of the nodes of their children.
fn resolved<'s>(document: &SourceDocument<'_>, skeleton: &'s Skeleton) -> Cow<'s, Skeleton> {
    let unknown = skeleton.bones.iter().take_while(|bone| bone.node.is_none()).count();
    if unknown == 0 {
        return Cow::Borrowed(skeleton);
    }
    let mut parents = HashMap::new();
    for (number, &id) in document.nodes.iter().enumerate() {
        parents.extend(children(document, id).map(|child| (child, number as u32)));
    }
    let mut found = skeleton.clone();
    let mut child_of: Vec<Option<u32>> = vec![None; skeleton.len()];
    // In reverse, because parents come before their children.
    for index in (0..found.bones.len()).rev() {
        let above = || parents.get(&child_of[index]?).copied();
        let node = found.bones[index].node.or_else(|| above().filter(|_| index < unknown));
        found.bones[index].node = node;
        if let Some(parent) = found.bones[index].parent.and_then(|parent| child_of.get_mut(parent as usize)) {
            *parent = node.or(*parent);
        }
    }
    Cow::Owned(found)
}

/// Returns the numbers of the children of a node.
fn children<'d>(document: &SourceDocument<'d>, node: usize) -> impl Iterator<Item = u32> + 'd {
    let json = document.json;
    let list = json.list(node, "children").into_iter();
    list.filter_map(move |child| u32::try_from(json.whole(child)?).ok())
}

/// Checks that the file can be opened again: that it has not too many nodes and levels of nodes.
fn check_limits(
    document: &SourceDocument<'_>,
    below: &[u32],
    added: usize,
    kept: usize,
) -> Result<(), SaveError> {
    let refuse = |reason: String| Err(SaveError::File { place: "/nodes".to_owned(), reason });
    if added == 0 {
        return Ok(());
    }
    if kept + added > NODES {
        return refuse(format!("a file has at most {NODES} nodes, so no root bone can be added"));
    }
    let mut level: Vec<u32> = below.to_vec();
    let mut is_seen = vec![false; document.nodes.len()];
    let mut levels = added;
    while !level.is_empty() {
        levels += 1;
        if levels > NODE_DEPTH {
            return refuse(format!(
                "a file has at most {NODE_DEPTH} levels of nodes, so no root bone can be added"
            ));
        }
        let mut next = Vec::new();
        for node in level {
            let Some(seen @ false) = is_seen.get_mut(node as usize) else { continue };
            *seen = true;
            next.extend(children(document, document.nodes[node as usize]));
        }
        level = next;
    }
    Ok(())
}

impl RootNodes {
    /// Returns the edits that remove the channels of bones that are gone from an animation.
    pub(super) fn lost_channels(&self, animation: &FileAnimation) -> Vec<ChannelEdit> {
        let paths = [TargetPath::Translation, TargetPath::Rotation, TargetPath::Scale, TargetPath::Weights];
        let targets = self.removed.iter().flat_map(|(node, name)| paths.map(|path| ((*node, path), name)));
        let found = targets.filter(|(target, _)| animation.channel(*target).is_some());
        let edit = |(target, name): (_, &String)| ChannelEdit {
            target,
            label: name.clone(),
            action: Action::Remove,
            values_of: None,
        };
        found.map(edit).collect()
    }

    /// Writes the nodes and the scenes.
    pub(super) fn write(&self, draw: &mut Draw<'_, '_>) -> Result<(), SaveError> {
        if self.added.is_empty() && self.removed.is_empty() {
            return Ok(());
        }
        self.write_nodes(draw)?;
        self.write_scenes(draw);
        draw.changes.bones_added.extend_from_slice(&self.added);
        draw.changes.bones_removed.extend_from_slice(&self.removed);
        Ok(())
    }

    fn write_nodes(&self, draw: &mut Draw<'_, '_>) -> Result<(), SaveError> {
        let json = draw.document.json;
        let Some(list) = draw.list("nodes")? else { return Ok(()) };
        let (stay, gone) = draw.document.nodes.split_at(self.kept);
        let spot = draw.style.spot(json, Some(list), 2);
        let children = |index: usize| match self.added.get(index + 1) {
            Some((next, _)) => vec![*next],
            None => self.below.clone(),
        };
        let fresh = |(index, (_, name)): (usize, &(u32, String))| {
            let children = children(index).into_iter().map(|child| Fresh::whole(child as usize)).collect();
            Fresh::Object(vec![("name", Fresh::string(name)), ("children", Fresh::Array(children))])
        };
        let new = self.added.iter().enumerate().map(fresh);
        let inserted = new.map(|fresh| (stay.last().copied(), draw.style.write(&fresh, &spot))).collect();
        let change = ListEdit { removed: gone.to_vec(), inserted };
        draw.patches.extend(edit(json, list, &change, &draw.style, &spot, "/nodes"));
        for (node, _) in &self.removed {
            let Some(&id) = stay.get(*node as usize) else { continue };
            let spot = draw.style.spot(json, Some(id), 3);
            let removed = json.member(id, "children").into_iter().collect();
            let change = ListEdit { removed, inserted: Vec::new() };
            draw.patches.extend(edit(json, id, &change, &draw.style, &spot, &format!("/nodes/{node}")));
            draw.changes.nodes_left.push(*node);
        }
        Ok(())
    }

    fn write_scenes(&self, draw: &mut Draw<'_, '_>) {
        let json = draw.document.json;
        let before: Vec<u32> = self.removed.first().map_or(self.below.clone(), |(top, _)| vec![*top]);
        let after: Vec<u32> = self.added.first().map_or(self.below.clone(), |(top, _)| vec![*top]);
        for (number, scene) in json.list(0, "scenes").into_iter().enumerate() {
            let Some(list) = json.member(scene, "nodes") else { continue };
            let items: Vec<_> = json.items(list).collect();
            let is_top = |item: usize| {
                json.whole(item)
                    .and_then(|node| u32::try_from(node).ok())
                    .is_some_and(|node| before.contains(&node))
            };
            let Some(first) = items.iter().position(|&item| is_top(item)) else { continue };
            let removed: Vec<_> = items.iter().copied().filter(|&item| is_top(item)).collect();
            if before == after && removed.len() == before.len() {
                continue;
            }
            let place = first.checked_sub(1).map(|place| items[place]);
            let inserted = after.iter().map(|node| (place, node.to_string())).collect();
            let spot = draw.style.spot(json, Some(list), 4);
            let change = ListEdit { removed, inserted };
            let pointer = format!("/scenes/{number}/nodes");
            draw.patches.extend(edit(json, list, &change, &draw.style, &spot, &pointer));
        }
    }
}
