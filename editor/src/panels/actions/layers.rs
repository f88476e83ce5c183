//! Commands for layers: edits of the layers of the take that is shown.

use super::edit;
use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_document::View;
use dragonfly_document::adapter::{TakeId, TakeVersions};
use dragonfly_document::edit::{
    AddLayer, BoneRef, DeleteLayer, Edit, KeyLayerWeight, LayerKind, LayerRef, MergeLayers, MoveLayer,
    SetLayer, TakeRef,
};

/// Adds a layer above the active one and makes it active.
pub(in crate::panels) fn add(workspace: &mut Workspace, kind: LayerKind) -> Option<Effect> {
    let panels = workspace.read();
    let (take, at) = (panels.shown_take_ref()?, panels.layer().map(|layer| layer + 1));
    let name = unused_name(workspace, if kind == LayerKind::Additive { "Layer" } else { "Override" }, 1);
    workspace.layers.choose_next_new();
    Some(edit(Edit::AddLayer(AddLayer { at, ..AddLayer::new(take, name, kind) })))
}

/// Adds a copy of the active layer above it and makes it active.
pub(in crate::panels) fn duplicate(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    let (take, layer) = (panels.shown_take_ref()?, panels.layer()?);
    let settings = &panels.layers().get(layer)?.settings;
    let (kind, name) = (settings.mode.into(), format!("{} copy", settings.name));
    let name = unused_name(workspace, &name, 1);
    workspace.layers.choose_next_new();
    let (at, copy) = (Some(layer + 1), Some(LayerRef::Index(layer)));
    Some(edit(Edit::AddLayer(AddLayer { at, copy, ..AddLayer::new(take, name, kind) })))
}

/// Adds a layer of poses with the keys of another take above the active one and makes it active.
pub(super) fn add_from(workspace: &mut Workspace, take: usize) -> Option<Effect> {
    let panels = workspace.read();
    let (over, at) = (panels.shown_take_ref()?, panels.layer().map(|layer| layer + 1));
    let name = unused_name(workspace, &panels.digest.takes.get(take)?.name, 1);
    workspace.layers.choose_next_new();
    let keys_of = Some(TakeRef::Index(take));
    Some(edit(Edit::AddLayer(AddLayer { at, keys_of, ..AddLayer::new(over, name, LayerKind::Override) })))
}

/// Deletes the active layer.
pub(in crate::panels) fn delete(workspace: &mut Workspace) -> Option<Effect> {
    let take = active(workspace)?;
    Some(edit(Edit::DeleteLayer(DeleteLayer { take })))
}

/// Moves the active layer up or down.
pub(in crate::panels) fn move_by(workspace: &mut Workspace, by: isize) -> Option<Effect> {
    let layer = workspace.read().layer()?;
    let (take, to) = (active(workspace)?, layer.saturating_add_signed(by));
    Some(edit(Edit::MoveLayer(MoveLayer { take, to, to_take: None })))
}

/// Merges the active layer with the one below it, or with the take.
pub(in crate::panels) fn merge_down(workspace: &mut Workspace) -> Option<Effect> {
    let take = active(workspace)?;
    let below = workspace.read().layer()?.checked_sub(1);
    let below = below.and_then(|below| Some(workspace.read().layers().get(below)?.keys.id));
    // Merged into the take, the layer stays chosen, so that it is active again after an undo.
    if below.is_some() {
        workspace.layers.choose(below);
        workspace.layers.choose_next_new();
    }
    Some(edit(Edit::MergeLayers(MergeLayers { take, rate: rate(workspace) })))
}

/// Makes all layers keys of the take.
pub(in crate::panels) fn merge_all(workspace: &mut Workspace) -> Option<Effect> {
    let take = workspace.read().shown_take_ref()?;
    Some(edit(Edit::MergeLayers(MergeLayers { take, rate: rate(workspace) })))
}

/// Returns the frames per second on which keys are added.
fn rate(workspace: &Workspace) -> Option<f32> {
    Some(workspace.frame_rate.get() as f32)
}

/// Mutes the active layer, or unmutes it.
pub(in crate::panels) fn toggle_mute(workspace: &mut Workspace) -> Option<Effect> {
    let (take, muted) = (active(workspace)?, Some(!settings(workspace, |settings| settings.is_muted)?));
    Some(edit(Edit::SetLayer(SetLayer { muted, ..unchanged(take) })))
}

/// Plays the active layer without those that are not solo, or ends that.
pub(in crate::panels) fn toggle_solo(workspace: &mut Workspace) -> Option<Effect> {
    let (take, solo) = (active(workspace)?, Some(!settings(workspace, |settings| settings.is_solo)?));
    Some(edit(Edit::SetLayer(SetLayer { solo, ..unchanged(take) })))
}

/// Restricts the active layer to the selected bones; to all bones where `all` is set.
pub(in crate::panels) fn mask(workspace: &mut Workspace, all: bool) -> Option<Effect> {
    let take = active(workspace)?;
    let selected = workspace.bones.bones().iter().filter(|_| !all).map(|&bone| BoneRef::Index(bone));
    let bones = Some(selected.collect());
    Some(edit(Edit::SetLayer(SetLayer { bones, ..unchanged(take) })))
}

/// Sets a key of the weight of the active layer at the time shown, with the weight that it has there.
pub(in crate::panels) fn key_weight(workspace: &mut Workspace) -> Option<Effect> {
    let (take, time) = (active(workspace)?, workspace.player.time());
    let weight = Some(settings(workspace, |settings| settings.weight_at(time))?);
    Some(edit(Edit::KeyLayerWeight(KeyLayerWeight { take, time, weight })))
}

/// Makes a new layer active that a command has added.
pub(super) fn follow_layers(workspace: &mut Workspace, before: Option<&View>) {
    let ids =
        |slot: &TakeVersions| -> Vec<TakeId> { slot.layers().iter().map(|layer| layer.keys.id).collect() };
    let Some(slot) = workspace.read().slot() else { return };
    let old = before.and_then(|view| view.slots.iter().find(|old| old.id == slot.id));
    let (old, new) = (old.map_or(Vec::new(), |old| ids(old)), ids(slot));
    if workspace.layers.update(&old, &new) {
        workspace.keys.deselect();
    }
}

/// Makes the layer above or below the active one active; below the lowest is the take itself.
pub(in crate::panels) fn step(workspace: &mut Workspace, by: isize) {
    let panels = workspace.read();
    let (count, now) = (panels.layers().len() as isize, panels.layer().map_or(-1, |layer| layer as isize));
    let next = (now + by + 1).rem_euclid(count + 1) - 1;
    let layer = usize::try_from(next).ok().and_then(|next| panels.layers().get(next));
    let text = match layer {
        Some(layer) => format!("Layer {}", layer.settings.name),
        None => "The take itself".to_owned(),
    };
    let id = layer.map(|layer| layer.keys.id);
    choose(workspace, id);
    workspace.say(MessageSeverity::Info, text);
}

/// Makes a layer active, or the take itself. Keys that were selected belong to another layer, so none is selected then.
pub(super) fn choose(workspace: &mut Workspace, layer: Option<TakeId>) {
    if workspace.layers.chosen() != layer {
        workspace.keys.deselect();
        workspace.layers.choose(layer);
    }
}

/// Returns an edit that changes no setting of a layer.
pub(in crate::panels) fn unchanged(take: TakeRef) -> SetLayer {
    let (name, kind, weight, muted, solo, color, bones) = (None, None, None, None, None, None, None);
    SetLayer { take, name, kind, weight, muted, solo, color, bones }
}

fn active(workspace: &Workspace) -> Option<TakeRef> {
    let panels = workspace.read();
    panels.layer_ref(panels.layer()?)
}

fn settings<T>(
    workspace: &Workspace,
    read: impl FnOnce(&dragonfly_anim::layers::LayerSettings) -> T,
) -> Option<T> {
    let panels = workspace.read();
    Some(read(&panels.layers().get(panels.layer()?)?.settings))
}

/// Returns `base`, with the first number from `first` on that makes it a name that no layer of the take has; 1 is not written.
fn unused_name(workspace: &Workspace, base: &str, first: usize) -> String {
    let panels = workspace.read();
    let numbered = |number| if number == 1 { base.to_owned() } else { format!("{base} {number}") };
    let unused = |name: &String| !panels.layers().iter().any(|layer| layer.settings.name == *name);
    let last = first + panels.layers().len();
    (first..=last).map(numbered).find(unused).unwrap_or_else(|| base.to_owned())
}
