//! Contacts of bones with the ground: commands for the take that is shown.

use super::edit;
use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::contact::{Contact, limb_of};
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::edit::{BoneRef, ContactSpan, DetectContacts, Edit, LockContacts, SetContacts};

/// Number of frames over which the correction of a locked foot fades.
const EASE: u32 = 4;

fn refs(bones: &[BoneIndex]) -> Vec<BoneRef> {
    bones.iter().map(|&bone| BoneRef::Index(bone)).collect()
}

fn span(contact: &Contact) -> ContactSpan {
    ContactSpan { bone: BoneRef::Index(contact.bone), from: contact.from, to: contact.to }
}

/// Finds the contacts of the selected bones that are ends of limbs, or of the bones called feet if none is.
pub(in crate::panels) fn detect(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    let (take, rate) = (panels.shown_take_ref()?, Some(panels.frame_rate as f32));
    let skeleton = &panels.loaded()?.model.animation.skeleton;
    let named = dragonfly_anim::contact::feet_by_name(skeleton);
    let selected: Vec<BoneIndex> = panels.selection.bones().to_vec();
    // A selected bone that is no foot is selected for another reason, unless no bone is called a foot.
    let chosen: Vec<BoneIndex> =
        selected.into_iter().filter(|bone| named.is_empty() || named.contains(bone)).collect();
    Some(edit(Edit::DetectContacts(DetectContacts {
        take,
        bones: refs(&chosen),
        meters_per_unit: Some(panels.unit.meters().into()),
        rate,
    })))
}

/// Adds a contact of each selected bone over the play range.
pub(in crate::panels) fn add(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    let take = panels.shown_take_ref()?;
    let Some([from, to]) = panels.keys.range() else {
        workspace.say(MessageSeverity::Info, "Set a play range first: the contact is as long as it is");
        return None;
    };
    let bones = panels.selection.bones();
    let track = panels.contacts.track();
    let before = bones.iter().flat_map(|&bone| track.of_bone(bone));
    let added = bones.iter().map(|&bone| ContactSpan { bone: BoneRef::Index(bone), from, to });
    let contacts = before.map(span).chain(added).collect();
    Some(edit(Edit::SetContacts(SetContacts { take, bones: refs(bones), contacts })))
}

/// Deletes the contacts of the selected bones, or all if none of these has any.
pub(in crate::panels) fn delete(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    let take = panels.shown_take_ref()?;
    let track = panels.contacts.track();
    let has_some = |bone: &BoneIndex| !track.of_bone(*bone).is_empty();
    let chosen: Vec<BoneIndex> = panels.selection.bones().iter().copied().filter(has_some).collect();
    Some(edit(Edit::SetContacts(SetContacts { take, bones: refs(&chosen), contacts: Vec::new() })))
}

/// Locks bones in their contacts with the ground; where the take has none, feet in those that are found.
pub(in crate::panels) fn lock(workspace: &mut Workspace) -> Option<Effect> {
    let panels = workspace.read();
    let (take, rate) = (panels.shown_take_ref()?, Some(panels.frame_rate as f32));
    let skeleton = &panels.loaded()?.model.animation.skeleton;
    let meters_per_unit = Some(panels.unit.meters().into());
    let stored = panels.contacts.track().contacts();
    let has_limb = |contact: &&Contact| limb_of(skeleton, contact.bone).is_some();
    let contacts: Vec<ContactSpan> = stored.iter().filter(has_limb).map(span).collect();
    if contacts.is_empty() && !stored.is_empty() {
        let text = "A bone is locked together with the two bones above it; the bones in contact have fewer";
        workspace.say(MessageSeverity::Info, text);
        return None;
    }
    Some(edit(Edit::LockContacts(LockContacts { take, contacts, ease: EASE, rate, meters_per_unit })))
}
