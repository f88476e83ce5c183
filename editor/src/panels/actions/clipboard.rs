//! Keys and poses through the clipboard.

use super::{edit, keys, locks, pose};
use crate::panels::count_text::{count, grouped};
use crate::panels::keys::clipboard::{self, CopiedKeys, CopiedValues, MOST, Pasted};
use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_anim::layers::LayerMode;
use dragonfly_document::edit::{BoneRef, CopiedChannel, CopiedShapes, Edit, PasteKeys, ShapeRef};
use dragonfly_document::posing;
use std::sync::Arc;

/// Copies the selected keys where the timeline was used last, otherwise the pose.
pub(in crate::panels) fn copy(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    if panels.keys.has_focus() && panels.take().is_some() && !panels.keys.selection().is_empty() {
        return copy_keys(workspace);
    }
    pose::copy(workspace)
}

/// Copies the selected keys.
pub(in crate::panels) fn copy_keys(workspace: &mut Workspace) -> Option<Effect> {
    Some(Effect::Copy(keys_text(workspace, "Copied")?))
}

/// Copies the selected keys and deletes them.
pub(in crate::panels) fn cut_keys(workspace: &mut Workspace) -> Option<Effect> {
    let text = keys_text(workspace, "Cut")?;
    if let Effect::Change(change) = keys::delete(workspace)? { Some(Effect::Cut(text, change)) } else { None }
}

fn keys_text(workspace: &mut Workspace, verb: &str) -> Option<String> {
    let take = Arc::clone(workspace.read().shared_take()?);
    let number = workspace.keys.selection().count(&take);
    if number > MOST {
        let text = format!("{} keys are selected; at most {} are copied", grouped(number), grouped(MOST));
        workspace.say(MessageSeverity::Warning, text);
        return None;
    }
    let skeleton = &workspace.model.loaded()?.model.animation.skeleton;
    let selection = workspace.keys.selection();
    let channels = clipboard::copied(&take, selection, skeleton);
    let shapes = &workspace.model.view()?.shapes;
    let shapes = clipboard::copied_shapes(&take, selection, shapes);
    if channels.is_empty() && shapes.is_empty() {
        workspace.say(MessageSeverity::Info, "No key is selected");
        return None;
    }
    workspace.say(MessageSeverity::Info, format!("{verb} {}", count(number, "key", "keys")));
    let values = values_of_keys(workspace);
    Some(clipboard::to_text(CopiedKeys { channels, values, shapes }))
}

/// Returns what the values of the keys are that are shown and edited.
fn values_of_keys(workspace: &Workspace) -> CopiedValues {
    let panels = workspace.read();
    let layer = panels.layer().and_then(|layer| panels.layers().get(layer));
    match layer.map(|layer| layer.settings.mode) {
        Some(LayerMode::Additive) => CopiedValues::Offsets,
        Some(LayerMode::Override) | None => CopiedValues::Poses,
    }
}

/// Pastes the pose, or the keys, in a text of the clipboard; any other text is refused with a message.
pub(super) fn paste(workspace: &mut Workspace, text: &str, mirrored: bool) -> Option<Effect> {
    if workspace.read().scene().is_some() {
        return super::scene_clipboard::paste(workspace, text);
    }
    if let Some(poses) = posing::clipboard::from_text(text) {
        return pose::paste(workspace, poses, mirrored);
    }
    match clipboard::from_text(text) {
        Some(CopiedKeys { channels, values, shapes })
            if !mirrored && (channels.is_empty() || values == values_of_keys(workspace)) =>
        {
            return paste_keys(workspace, channels, shapes);
        }
        Some(CopiedKeys { values, .. }) if !mirrored => {
            let text = match values {
                CopiedValues::Offsets => {
                    "The copied keys are offsets of an additive layer: paste them into an additive layer"
                }
                CopiedValues::Poses => {
                    "The copied keys are poses, and the active layer adds offsets: paste them into the take or an override layer"
                }
            };
            workspace.say(MessageSeverity::Warning, text);
        }
        Some(_) => {
            let text = "The clipboard contains keys; only poses can be pasted mirrored";
            workspace.say(MessageSeverity::Info, text);
        }
        None => workspace.say(MessageSeverity::Info, "The clipboard contains no pose and no keys"),
    }
    None
}

/// Inserts copied keys at the time shown: on the bones they are of, or, if the same number of other bones is selected, on
/// these in their order. Locked bones stay as they are.
fn paste_keys(
    workspace: &mut Workspace,
    mut channels: Vec<CopiedChannel>,
    mut shapes: Vec<CopiedShapes>,
) -> Option<Effect> {
    let Some(take) = workspace.read().take_ref() else {
        workspace.say(MessageSeverity::Info, "The rest pose cannot be edited: show a take first");
        return None;
    };
    let skeleton = &workspace.model.loaded()?.model.animation.skeleton;
    clipboard::retarget(&mut channels, workspace.bones.bones(), skeleton);
    let had_shapes = !shapes.is_empty();
    if had_shapes {
        let known = &workspace.model.view()?.shapes;
        let is_known = |shape: &ShapeRef| known.find(None, shape).is_some();
        shapes.retain(|mesh| mesh.shapes.iter().any(is_known));
    }
    if had_shapes && workspace.read().layer().is_some() {
        shapes.clear();
        let text = "Shape keys have keys in the take, not in layers: choose the take to paste them";
        workspace.say(MessageSeverity::Warning, text);
        if channels.is_empty() {
            return None;
        }
    }
    if channels.is_empty() && shapes.is_empty() {
        let text = if had_shapes {
            "The keys in the clipboard belong to bones and shape keys that this model does not have"
        } else {
            "The keys in the clipboard belong to bones that this model does not have"
        };
        workspace.say(MessageSeverity::Info, text);
        return None;
    }
    if !channels.is_empty()
        && !locks::remove_locked(workspace, &mut channels, |channel| match channel.bone {
            BoneRef::Index(bone) => bone,
            BoneRef::Name(_) => BoneIndex::MAX,
        })
        && shapes.is_empty()
    {
        return None;
    }
    let panels = workspace.read();
    let (generation, time) = (panels.view?.generation, panels.time());
    let pasted = Pasted::new(generation, panels.take().map_or(0, Take::keys), (&channels, &shapes), time);
    workspace.keys.await_pasted(pasted);
    Some(edit(Edit::PasteKeys(PasteKeys { take, time, channels, shapes })))
}
