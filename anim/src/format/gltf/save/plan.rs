//! From takes to the bytes that change.

use super::super::target_path::TargetPath;
use super::animation::{Draft, SamplerNumbers};
use super::buffer::TargetBuffer;
use super::changes::{ChangedChannel, Changes, ChannelChange, TakeChange, WrittenAccessor};
use super::channels::{Action, ChannelEdit, edits, placeholder};
use super::columns::shape_width;
use super::document::{FileAnimation, SourceDocument};
use super::draw::Draw;
use super::error::SaveError;
use super::extras::are_closed;
use super::json::style::Fresh;
use super::json::token::number;
use super::mark::MARK;
use super::needs::{Need, Needs};
use super::nodes::without_matrix;
use super::order::write_animations;
use super::planned::{Plan, TakeDraft};
use super::reuse::{Granted, RoomRequest, SavedSlot, grant, slots};
use super::roots::{RootNodes, with_roots};
use super::source::SourceFile;
use crate::data::{Bone, ModelData, Skeleton, TakeExtras};
use crate::format::EditedTake;
use std::collections::{HashMap, HashSet};

/// Plans a save after which `source` contains the takes `now`, in this order.
///
/// `opened` is the model as it was read from the same bytes. Errors: the model is not from these bytes, or glTF cannot
/// represent the keys; see [`SaveError`]. Time and memory are proportional to the length of the JSON text and to the
/// channels that changed.
pub fn plan<'a>(
    source: &'a SourceFile,
    opened: &ModelData,
    now: &[EditedTake],
) -> Result<Plan<'a>, SaveError> {
    plan_with_skeleton(source, opened, &opened.animation.skeleton, now)
}

/// Plans a save as [`plan`](fn@plan) does, of takes for the bones of `skeleton`: that of `opened`, with other root bones
/// above the same bones.
pub fn plan_with_skeleton<'a>(
    source: &'a SourceFile,
    opened: &ModelData,
    skeleton: &Skeleton,
    now: &[EditedTake],
) -> Result<Plan<'a>, SaveError> {
    let document = SourceDocument::of(source);
    check_same_file(&document, opened)?;
    let (opened, roots) = with_roots(&document, opened, skeleton)?;
    let opened = &*opened;
    let target = TargetBuffer::choose(&document);
    let slots = slots(&document, target.index, target.present);
    let ours: HashSet<usize> = slots.iter().map(|slot| slot.accessor).collect();
    let mut needs = Needs::default();
    let mut met = HashSet::new();
    let mut takes = Vec::with_capacity(now.len());
    for take in now {
        let is_copy = take.origin.is_some_and(|origin| !met.insert(origin));
        takes.push(take_draft(&document, opened, &roots, (take, is_copy), &ours, &mut needs)?);
    }
    let mut draw = Draw::new(&document);
    let accessors = write_numbers(&mut draw, target, slots, &takes, needs)?;
    let animated = takes.iter().flat_map(|take| take.draft.new_targets().map(|target| (target, &*take.name)));
    let animated = animated.filter(|(target, _)| target.1 != TargetPath::Weights);
    let animated = animated.map(|(target, take)| (target.0, take));
    without_matrix(&mut draw, opened, animated)?;
    write_animations(&mut draw, &takes, &accessors)?;
    roots.write(&mut draw)?;
    describe(&mut draw.changes, &document, &takes);
    draw.changes.bones_lost = bones_lost(&document, opened, &takes);
    draw.finish()
}

/// Checks that the animations of the file are the takes that were opened.
fn check_same_file(document: &SourceDocument<'_>, opened: &ModelData) -> Result<(), SaveError> {
    let mismatch = |place: &str, reason: String| Err(SaveError::Mismatch { place: place.to_owned(), reason });
    let (takes, animations) = (opened.animation.takes.len(), document.animations.len());
    if takes != animations {
        return mismatch("/animations", format!("{animations} in the file, {takes} takes were opened"));
    }
    let nodes = document.nodes.len();
    let bones = opened.animation.skeleton.bones.iter().map(|bone| bone.node);
    let instances = opened.instances.iter().map(|instance| instance.node);
    if let Some(node) = bones.chain(instances).flatten().find(|&node| node as usize >= nodes) {
        return mismatch("/nodes", format!("{nodes} in the file, node {node} was opened"));
    }
    for (index, animation) in document.animations.iter().enumerate() {
        let count = animation.samplers.len();
        if animation.channels.iter().any(|channel| channel.sampler.is_none_or(|sampler| sampler >= count)) {
            return mismatch(&format!("/animations/{index}/channels"), "a channel has no sampler".to_owned());
        }
    }
    Ok(())
}

fn take_draft(
    document: &SourceDocument<'_>,
    opened: &ModelData,
    roots: &RootNodes,
    (now, is_copy): (&EditedTake, bool),
    ours: &HashSet<usize>,
    needs: &mut Needs,
) -> Result<TakeDraft, SaveError> {
    let base = match now.origin {
        Some(origin) => {
            let pair = opened.animation.takes.get(origin).zip(document.animations.get(origin));
            let (take, animation) = pair.ok_or_else(|| SaveError::Mismatch {
                place: format!("take \"{}\"", now.take.name),
                reason: format!("the file has no animation {origin}"),
            })?;
            Some((take.as_ref(), animation))
        }
        None => None,
    };
    let take = now.take.as_ref();
    let mut edits = edits(opened, base, take)?;
    edits.extend(base.map(|(_, animation)| roots.lost_channels(animation)).unwrap_or_default());
    if (!edits.is_empty() || base.is_none()) && !moves(base.map(|base| base.1), &edits) {
        let still = placeholder(opened, base.map(|base| base.0), take)?;
        let kept = bone_at_rest(opened);
        edits.retain(|edit| Some(edit.target.0) != kept || edit.target.1 != TargetPath::Translation);
        edits.extend(still);
    }
    let name = match base {
        Some((before, _)) => (before.name != take.name).then(|| take.name.clone()),
        None => Some(take.name.clone()),
    };
    let animation = base.map(|base| base.1);
    let mut draft = Draft::of(document, animation, &edits, name, &|accessor| ours.contains(&accessor), needs);
    let before = base.map(|base| &base.0.extras);
    draft.extras = (before.unwrap_or(&TakeExtras::default()) != &take.extras).then(|| take.extras.clone());
    Ok(TakeDraft { base: now.origin, is_copy, name: take.name.clone(), edits, draft })
}

/// Returns the node that is used where nothing is animated.
fn bone_at_rest(opened: &ModelData) -> Option<u32> {
    let mut bones = opened.animation.skeleton.bones.iter();
    bones.find(|bone| bone.node.is_some() && bone.rest_matrix.is_none())?.node
}

/// Returns whether the animation will have a channel.
fn moves(animation: Option<&FileAnimation>, edits: &[ChannelEdit]) -> bool {
    let removed: HashSet<_> =
        edits.iter().filter(|edit| matches!(edit.action, Action::Remove)).map(|edit| edit.target).collect();
    let stays = |animation: &FileAnimation| {
        let stays = |target: Option<_>| target.is_none_or(|target| !removed.contains(&target));
        animation.channels.iter().any(|channel| stays(channel.target))
    };
    edits.iter().any(|edit| matches!(edit.action, Action::Set(_))) || animation.is_some_and(stays)
}

/// Finds room for what the takes need and writes accessors, views and bytes; returns the accessor of each need.
fn write_numbers(
    draw: &mut Draw<'_, '_>,
    target: TargetBuffer,
    slots: Vec<SavedSlot>,
    takes: &[TakeDraft],
    needs: Needs,
) -> Result<Vec<usize>, SaveError> {
    let document = draw.document;
    let pinned = pinned(document, takes);
    let (held, free): (Vec<SavedSlot>, Vec<SavedSlot>) =
        slots.into_iter().partition(|slot| pinned.contains(&slot.accessor));
    let bytes = target.bytes(document);
    let inputs: HashMap<&[u8], usize> =
        held.iter().filter_map(|slot| Some((input_bytes(document, slot, bytes)?, slot.accessor))).collect();
    let known = |need: &Need| need.bounds.and_then(|_| inputs.get(need.bytes.as_slice()).copied());
    let mut accessors: Vec<Option<usize>> = needs.list.iter().map(known).collect();
    let open: Vec<usize> = (0..accessors.len()).filter(|&need| accessors[need].is_none()).collect();
    let request =
        |&need: &usize| RoomRequest { size: needs.list[need].bytes.len(), before: needs.list[need].before };
    let requests: Vec<RoomRequest> = open.iter().map(request).collect();
    if requests.is_empty() {
        return Ok(accessors.into_iter().flatten().collect());
    }
    let mut end = target.present.next_multiple_of(4);
    let granted = grant(&requests, free, &mut end);
    let (mut added, mut writes) = (Vec::new(), Vec::new());
    for (need, granted) in open.into_iter().zip(granted) {
        let (accessor, view) = match granted.slot {
            Some(slot) => (slot.accessor, slot.view),
            None => {
                let number = added.len();
                added.push((need, granted));
                (document.accessors.len() + number, document.views.len() + number)
            }
        };
        accessors[need] = Some(accessor);
        let need = &needs.list[need];
        if let Some(slot) = granted.slot {
            draw.replace(document.accessors[accessor], "accessors", accessor, &fresh_accessor(need, view));
            if slot.room != granted.room {
                draw.replace(document.views[view], "bufferViews", view, &fresh_view(target.index, &granted));
            }
        }
        // Content that is already there, byte for byte, is not written again.
        if bytes.get(granted.offset..granted.offset + need.bytes.len()) != Some(&need.bytes) {
            writes.push((granted.offset, need.bytes.clone()));
        }
        draw.changes.accessors.push(WrittenAccessor {
            accessor,
            view,
            shape: need.shape,
            count: need.count,
            bytes: need.bytes.len(),
            is_reused: granted.slot.is_some(),
        });
    }
    let accessor =
        |number: usize| fresh_accessor(&needs.list[added[number].0], document.views.len() + number);
    draw.append("accessors", added.len(), accessor)?;
    draw.append("bufferViews", added.len(), |number| fresh_view(target.index, &added[number].1))?;
    let end = if end == target.present.next_multiple_of(4) { target.present } else { end };
    draw.buffer(target, &writes, end)?;
    Ok(accessors.into_iter().flatten().collect())
}

/// Returns the accessors that animations will still refer to although this save does not write them.
fn pinned(document: &SourceDocument<'_>, takes: &[TakeDraft]) -> HashSet<usize> {
    let mut pinned = HashSet::new();
    for take in takes {
        let Some(animation) = take.base.and_then(|base| document.animations.get(base)) else { continue };
        let rewritten = take.draft.rewritten();
        for (number, &sampler) in animation.samplers.iter().enumerate() {
            if !rewritten.contains(&number) {
                pinned.extend(document.json.index_member(sampler, "input"));
                pinned.extend(document.json.index_member(sampler, "output"));
            }
        }
        let numbers = take.draft.samplers.iter().flat_map(|sampler| [sampler.input, sampler.output]);
        pinned.extend(numbers.filter_map(|numbers| match numbers {
            SamplerNumbers::Kept(accessor) => Some(accessor),
            SamplerNumbers::Needed(_) => None,
        }));
    }
    pinned
}

/// Returns the key times in a slot, if it contains key times.
fn input_bytes<'b>(document: &SourceDocument<'_>, slot: &SavedSlot, bytes: &'b [u8]) -> Option<&'b [u8]> {
    let (json, id) = (document.json, document.accessors[slot.accessor]);
    let size = json.index_member(id, "count")?.checked_mul(4).filter(|&size| size <= slot.room)?;
    let is_input = json.string_member(id, "type")? == "SCALAR" && json.member(id, "min").is_some();
    bytes.get(slot.offset..slot.offset + size).filter(|_| is_input)
}

pub(super) fn fresh_accessor<'f>(need: &Need, view: usize) -> Fresh<'f> {
    debug_assert_eq!(need.bytes.len(), need.count * shape_width(need.shape) * 4);
    let mut members = vec![
        ("name", Fresh::string(MARK)),
        ("bufferView", Fresh::whole(view)),
        ("componentType", Fresh::whole(5126)),
        ("count", Fresh::whole(need.count)),
        ("type", Fresh::string(need.shape)),
    ];
    if let Some((least, greatest)) = need.bounds {
        members.push(("min", Fresh::Array(vec![Fresh::Raw(number(least))])));
        members.push(("max", Fresh::Array(vec![Fresh::Raw(number(greatest))])));
    }
    Fresh::Object(members)
}

pub(super) fn fresh_view<'f>(buffer: usize, granted: &Granted) -> Fresh<'f> {
    Fresh::Object(vec![
        ("name", Fresh::string(MARK)),
        ("buffer", Fresh::whole(buffer)),
        ("byteOffset", Fresh::whole(granted.offset)),
        ("byteLength", Fresh::whole(granted.room)),
    ])
}

/// Returns the bones that exist only because an animation of the file animates them or a descendant, and that will not
/// be animated any more.
fn bones_lost(document: &SourceDocument<'_>, opened: &ModelData, takes: &[TakeDraft]) -> Vec<(u32, String)> {
    let channels = |animation: &FileAnimation| -> Vec<_> {
        animation.channels.iter().filter_map(|channel| channel.target).collect()
    };
    let before: HashSet<u32> =
        document.animations.iter().flat_map(channels).map(|(node, _): (u32, TargetPath)| node).collect();
    let mut after: HashSet<u32> = HashSet::new();
    for take in takes {
        let base = take.base.and_then(|base| document.animations.get(base));
        let mut targets: HashSet<(u32, TargetPath)> = base.into_iter().flat_map(channels).collect();
        for edit in &take.edits {
            match edit.action {
                Action::Remove => targets.remove(&edit.target),
                Action::Set(_) => targets.insert(edit.target),
            };
        }
        after.extend(targets.into_iter().map(|(node, _)| node));
    }
    let (before, after) = (are_bones(opened, &before), are_bones(opened, &after));
    // The importer makes bones of all nodes that a VRM names.
    let is_named = |bone: &Bone| {
        let named = opened.avatar.bones.iter().map(|human| human.bone);
        let weights = opened.avatar.expressions.iter().filter_map(|expression| expression.weight_bone);
        let mut named =
            named.chain(weights).filter_map(|index| opened.animation.skeleton.bones.get(index as usize));
        named.any(|named| named.node == bone.node)
    };
    let bones = opened.animation.skeleton.bones.iter().zip(before.into_iter().zip(after));
    bones
        .filter(|(_, (before, after))| *before && !after)
        .filter(|(bone, _)| !is_named(bone))
        .filter_map(|(bone, _)| Some((bone.node?, bone.name.clone())))
        .collect()
}

/// Returns for each bone whether it would still be one if only these nodes were animated: joints, animated nodes, and
/// all their ancestors.
fn are_bones(opened: &ModelData, moved: &HashSet<u32>) -> Vec<bool> {
    let bones = &opened.animation.skeleton.bones;
    let mut are: Vec<bool> =
        bones.iter().map(|bone| bone.node.is_none_or(|node| moved.contains(&node))).collect();
    for &joint in opened.skins.iter().flat_map(|skin| &skin.bones) {
        if let Some(is) = are.get_mut(joint as usize) {
            *is = true;
        }
    }
    // In reverse, because parents come before their children.
    for bone in (0..bones.len()).rev() {
        if let Some(parent) = bones[bone].parent.filter(|_| are[bone])
            && let Some(is) = are.get_mut(parent as usize)
        {
            *is = true;
        }
    }
    are
}

/// Describes the changes of takes and channels.
fn describe(changes: &mut Changes, document: &SourceDocument<'_>, takes: &[TakeDraft]) {
    let names: HashMap<usize, String> = document
        .animations
        .iter()
        .enumerate()
        .map(|(index, animation)| {
            (index, document.json.string_member(animation.id, "name").unwrap_or_default().into_owned())
        })
        .collect();
    let stay: Vec<usize> = takes.iter().filter(|take| !take.is_copy).filter_map(|take| take.base).collect();
    let mut in_order = stay.clone();
    in_order.sort_unstable();
    for (index, name) in (0..document.animations.len()).filter_map(|index| Some((index, names.get(&index)?)))
    {
        if in_order.binary_search(&index).is_err() {
            changes.takes.push((name.clone(), TakeChange::Deleted));
        }
    }
    let mut place = 0;
    for take in takes {
        let base = take.base.filter(|_| !take.is_copy);
        match base {
            None => changes.takes.push((take.name.clone(), TakeChange::Added)),
            Some(base) => {
                if take.draft.name.is_some() {
                    changes.takes.push((take.name.clone(), TakeChange::Renamed));
                }
                if in_order[place] != base {
                    changes.takes.push((take.name.clone(), TakeChange::Moved));
                }
                place += 1;
            }
        }
        let animation = take.base.and_then(|base| document.animations.get(base));
        if take.draft.extras.is_some() && base.is_some() {
            let closed = animation.is_some_and(|animation| are_closed(document.json, animation.id));
            match closed {
                true => changes.extras_lost.push(take.name.clone()),
                false => changes.takes.push((take.name.clone(), TakeChange::Extras)),
            }
        }
        for edit in &take.edits {
            let was_there = animation.is_some_and(|animation| animation.channel(edit.target).is_some());
            let change = match (&edit.action, was_there) {
                (Action::Remove, _) => ChannelChange::Removed,
                (Action::Set(_), true) => ChannelChange::Changed,
                (Action::Set(_), false) => ChannelChange::Added,
            };
            let (take, bone) = (take.name.clone(), edit.label.clone());
            let (node, path) = (edit.target.0, edit.target.1.name());
            changes.channels.push(ChangedChannel { take, node, bone, path, change });
        }
    }
}
