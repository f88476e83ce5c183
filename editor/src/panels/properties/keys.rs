//! Whether the channels of the selected bones have a key at the time shown, and the button that adds or deletes it.

use super::super::context::PanelContext;
use super::super::icons::Icon;
use super::super::request::Request;
use super::super::theme::Theme;
use super::super::widgets;
use super::drag;
use super::parts::PosePart;
use dragonfly_anim::data::BoneIndex;
use dragonfly_anim::sample::rest_pose;
use dragonfly_document::Change;
use dragonfly_document::edit::{
    AddKeys, DeleteKeys, Edit, KeyPending, KeySet, NewKey, Property, ResetPose, ResetTo,
};
use egui::Ui;

/// Keys of a channel relative to the time shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keyed {
    /// A key at that time.
    Here,
    /// Keys before or after it.
    Elsewhere,
    /// No key at all: the rest value.
    Never,
    /// A pending pose, which is not keyed yet.
    Pending,
}

/// Returns the state of all selected bones: a key only if all of them have one.
pub(super) fn at_time(context: &PanelContext<'_>, property: Property) -> Keyed {
    let bones = context.selection.bones();
    if bones.iter().any(|&bone| is_pending(context, bone, property)) {
        return Keyed::Pending;
    }
    let (mut here, mut any) = (true, false);
    for &bone in bones {
        match of(context, bone, property) {
            Keyed::Here => any = true,
            Keyed::Elsewhere => (here, any) = (false, true),
            Keyed::Never | Keyed::Pending => here = false,
        }
        if !here && any {
            return Keyed::Elsewhere;
        }
    }
    if any { Keyed::Here } else { Keyed::Never }
}

fn is_pending(context: &PanelContext<'_>, bone: BoneIndex, property: Property) -> bool {
    context.pending_here().and_then(|at| at.of(bone)).is_some_and(|pose| pose.get(property).is_some())
}

fn of(context: &PanelContext<'_>, bone: BoneIndex, property: Property) -> Keyed {
    let slot = context.view.zip(context.playback.take).and_then(|(view, take)| view.slots.get(take));
    let Some(slot) = slot else { return Keyed::Never };
    let Some(track) = slot.original.tracks.get(bone as usize) else { return Keyed::Never };
    let keys = match property {
        Property::Translation => track.translation.times.len(),
        Property::Rotation => track.rotation.times.len(),
        Property::Scale => track.scale.times.len(),
    };
    match slot.key_at(bone, property, context.time()) {
        Some(_) => Keyed::Here,
        None if keys > 0 => Keyed::Elsewhere,
        None => Keyed::Never,
    }
}

/// Draws the button that shows whether there is a key, and adds or deletes it.
pub(super) fn button(
    ui: &mut Ui,
    context: &PanelContext<'_>,
    property: Property,
    locked: Option<&str>,
    requests: &mut Vec<Request>,
) {
    let keyed = at_time(context, property);
    let (icon, now, action) = match keyed {
        Keyed::Here => (Icon::KeyHere, "a key at this time", "Delete it"),
        Keyed::Elsewhere => (Icon::KeyElsewhere, "no key at this time", "Add one"),
        Keyed::Never => (Icon::KeyNever, "no keys", "Add one"),
        Keyed::Pending => (Icon::KeyElsewhere, "a pose that is not keyed", "Key the pose of the bone"),
    };
    let name = property.name();
    let label = match keyed {
        Keyed::Here => format!("Delete the {name} key"),
        Keyed::Pending => format!("Key the pending {name}"),
        _ => format!("Add a {name} key"),
    };
    let response = ui
        .add_enabled_ui(locked.is_none(), |ui| widgets::icon_button(ui, icon, &label, keyed == Keyed::Here))
        .inner
        .on_hover_ui(|ui| {
            ui.label(format!("The {name} has {now}"));
            ui.colored_label(Theme::of(ui).weak, action);
        });
    if response.clicked()
        && let Some(edit) = toggled(context, property, keyed)
    {
        requests.push(Request::Change(Change::Edit(edit, None)));
    }
}

fn toggled(context: &PanelContext<'_>, property: Property, keyed: Keyed) -> Option<Edit> {
    let (take, time, bones) = (context.take_ref()?, context.time(), context.selected_refs());
    let properties = vec![property];
    Some(match keyed {
        Keyed::Here => {
            let keys = vec![KeySet { bones, properties, at: Some(vec![time]), ..KeySet::default() }];
            Edit::DeleteKeys(DeleteKeys { take, keys, shapes: Vec::new() })
        }
        Keyed::Pending => {
            Edit::KeyPending(KeyPending { take, time: Some(time), bones, shapes: false, unstep: true })
        }
        _ => {
            let value = NewKey::Current;
            Edit::AddKeys(AddKeys { take, time, bones, properties, value, keyed_only: false })
        }
    })
}

/// Resets a channel of all selected bones to the original or to the rest pose.
pub(super) fn reset(
    context: &PanelContext<'_>,
    property: Property,
    to: ResetTo,
    has_key: bool,
    requests: &mut Vec<Request>,
) {
    let Some(take) = context.take_ref() else { return };
    if has_key {
        let (time, bones, properties) = (context.time(), context.selected_refs(), vec![property]);
        let edit = Edit::ResetPose(ResetPose { take, time, bones, properties, to });
        requests.push(Request::Change(Change::Edit(edit, None)));
        return;
    }
    // Without a key there is no change to remove; the pose is set instead.
    let Some(loaded) = context.loaded() else { return };
    let bones = &loaded.model.animation.skeleton.bones;
    let part = |pair: &super::parts::Pair, bone: BoneIndex| match to {
        ResetTo::Original => Some(PosePart::of(&pair.original, property)),
        ResetTo::Rest => Some(PosePart::of(&rest_pose(bones.get(bone as usize)?), property)),
    };
    requests.extend(drag::set(context, property, part));
}
