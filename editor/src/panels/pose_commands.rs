//! What commands do to the pose at the time shown: key, drop, copy, paste, reset.

use super::keys;
use super::state::{Effect, State};
use super::status::Level;
use dragonfly_anim::data::{BoneIndex, Take, Transform};
use dragonfly_anim::sample::{rest_pose, sample_track};
use dragonfly_document::Change;
use dragonfly_document::adapter::PendingAt;
use dragonfly_document::bones::MirrorPairs;
use dragonfly_document::edit::{
    AddKeys, BonePose, BoneRef, DropPending, Edit, KeyPending, NewKey, PastePose, Property, ResetPose,
    ResetTo,
};
use dragonfly_document::posing::clipboard;
use std::sync::Arc;

impl State {
    /// Turns auto-key on or off, and says what that means.
    pub(super) fn toggle_auto_key(&mut self) {
        self.settings.auto_key = !self.settings.auto_key;
        self.status.say(
            Level::Info,
            if self.settings.auto_key {
                "Auto-key is on: a changed pose becomes a key"
            } else {
                "Auto-key is off: a changed pose is pending until it is keyed"
            },
        );
    }

    /// Keys what is pending at the time shown; where nothing is, adds keys there that keep the motion, of the selected
    /// bones or of all.
    pub(super) fn key_here(&mut self) -> Option<Effect> {
        let (take, time) = (self.take_ref()?, self.time());
        Some(done(if self.pending_here().is_some() {
            Edit::KeyPending(KeyPending {
                take,
                time: Some(time),
                bones: self.pending_free(Some(time))?,
                unstep: true,
            })
        } else {
            self.added_keys()?
        }))
    }

    /// Keys at the time shown that leave the motion as it is: of the selected bones; with none selected in all channels that
    /// have keys, but those of locked bones.
    pub(super) fn added_keys(&self) -> Option<Edit> {
        let all = self.selection.bones().is_empty();
        let bones = if all && self.keys.flags.any_locked() { self.free_refs() } else { self.selected_refs() };
        let (properties, value) = (Vec::new(), NewKey::Current);
        let (take, time) = (self.take_ref()?, self.time());
        let keyed_only = all && !bones.is_empty();
        Some(Edit::AddKeys(AddKeys { take, time, bones, properties, value, keyed_only }))
    }

    /// Keys what is pending anywhere in the take.
    pub(super) fn key_pending(&mut self) -> Option<Effect> {
        let bones = self.pending_free(None)?;
        Some(done(Edit::KeyPending(KeyPending { take: self.take_ref()?, time: None, bones, unstep: true })))
    }

    /// Gives up what is pending in the take.
    pub(super) fn drop_pending(&mut self) -> Option<Effect> {
        let bones = self.pending_free(None)?;
        Some(done(Edit::DropPending(DropPending { take: self.take_ref()?, time: None, bones })))
    }

    /// The bones whose pending poses are keyed or dropped, at one time or at all, as edits name them: all where none is
    /// locked, else those that are free. None where all of them are locked, which is said.
    fn pending_free(&mut self, time: Option<f32>) -> Option<Vec<BoneRef>> {
        if !self.keys.flags.any_locked() {
            return Some(Vec::new());
        }
        let slot = self.slot()?;
        let at: Vec<&PendingAt> = match time {
            Some(time) => slot.pending_at(time).map(|at| &**at).into_iter().collect(),
            None => slot.pending().iter().map(|at| &**at).collect(),
        };
        let mut bones: Vec<BoneIndex> =
            at.into_iter().flat_map(|at| &at.poses).map(|pose| pose.bone).collect();
        bones.sort_unstable();
        bones.dedup();
        // The document refuses this with the message that nothing is pending.
        if bones.is_empty() {
            return Some(self.free_refs());
        }
        if !self.spare_locked(&mut bones, |bone| *bone) {
            return None;
        }
        Some(bones.into_iter().map(BoneRef::Index).collect())
    }

    /// The poses of the selected bones, or of all, as text for the clipboard.
    pub(super) fn copy_pose(&mut self) -> Option<Effect> {
        let view = self.view.clone()?;
        let bones = self.selected_or_all();
        let (take, time) = (self.playback.take, self.time());
        let poses = self.posed.update(&view, take, time).poses();
        let names = &view.loaded.model.animation.skeleton;
        let copied: Vec<BonePose> = bones
            .iter()
            .filter_map(|&bone| {
                let pose = poses.get(bone as usize)?;
                Some(BonePose { bone: named(names, bone), ..whole(bone, pose) })
            })
            .collect();
        let bones = super::widgets::count(copied.len(), "bone", "bones");
        self.status.say(Level::Info, format!("Copied the pose of {bones}"));
        Some(Effect::Copy(clipboard::to_text(&copied)))
    }

    /// The edit that puts on the pose, or in the keys, that the clipboard holds; anything else is refused quietly.
    pub(super) fn paste_pose(&mut self, text: &str, mirrored: bool) -> Option<Effect> {
        let Some(poses) = clipboard::from_text(text) else {
            match keys::clipboard::from_text(text) {
                Some(channels) if !mirrored => return self.paste_keys(channels),
                Some(_) => {
                    let text = "The clipboard holds keys, and only poses are pasted mirrored";
                    self.status.say(Level::Info, text);
                }
                None => self.status.say(Level::Info, "There is no pose in the clipboard, and no keys"),
            }
            return None;
        };
        let Some(take) = self.take_ref() else {
            self.status.say(Level::Info, "The rest pose is not edited; show a take first");
            return None;
        };
        let (time, pending) = (self.time(), !self.settings.auto_key);
        let mut poses = poses;
        if self.keys.flags.any_locked() {
            let skeleton = Arc::clone(&self.loaded()?.model.animation.skeleton);
            let mirror = mirrored.then(|| MirrorPairs::of(&skeleton));
            let target = |pose: &BonePose| {
                let bone = match &pose.bone {
                    BoneRef::Index(bone) => Some(*bone),
                    BoneRef::Name(name) => skeleton.find(name),
                };
                let on = |bone| mirror.as_ref().map_or(Some(bone), |pairs| pairs.mirror_of(bone));
                bone.and_then(on).unwrap_or(BoneIndex::MAX)
            };
            if !self.spare_locked(&mut poses, target) {
                return None;
            }
        }
        Some(done(Edit::PastePose(PastePose { take, time, poses, mirrored, pending, unstep: true })))
    }

    /// Takes the selected bones back to the pose that was read, or to the rest pose; these channels of them.
    pub(super) fn reset_pose(&mut self, properties: &[Property], to: ResetTo) -> Option<Effect> {
        let (take, time) = (self.take_ref()?, self.time());
        let slot = self.slot()?;
        let bones: Vec<BoneIndex> = self.bones_to_pose().collect();
        let keyed =
            |bone: BoneIndex| properties.iter().any(|&property| slot.key_at(bone, property, time).is_some());
        // On keys, to the bit and with its tangents.
        if to == ResetTo::Original && self.settings.auto_key && bones.iter().any(|&bone| keyed(bone)) {
            let (bones, properties) = (self.selected_refs(), properties.to_vec());
            return Some(done(Edit::ResetPose(ResetPose { take, time, bones, properties, to })));
        }
        let rules = &self.loaded()?.model.animation.skeleton.bones;
        let original = &slot.original;
        let poses = bones
            .iter()
            .filter_map(|&bone| {
                let rest = rules.get(bone as usize)?;
                let pose = match to {
                    ResetTo::Rest => rest_pose(rest),
                    ResetTo::Original => sampled(original, bone, rest, time),
                };
                Some(only(whole(bone, &pose), properties))
            })
            .collect();
        self.pose_edit(poses).map(done)
    }
}

/// The edit as something done by itself.
fn done(edit: Edit) -> Effect {
    Effect::Change(Change::Edit(edit, None))
}

fn sampled(take: &Take, bone: BoneIndex, rules: &dragonfly_anim::data::Bone, time: f32) -> Transform {
    take.tracks.get(bone as usize).map_or(rest_pose(rules), |track| sample_track(track, rules, time))
}

/// All three channels of a pose.
fn whole(bone: BoneIndex, pose: &Transform) -> BonePose {
    BonePose {
        bone: BoneRef::Index(bone),
        translation: Some(pose.translation.to_array()),
        rotation: Some(pose.rotation.to_array()),
        scale: Some(pose.scale.to_array()),
    }
}

fn only(pose: BonePose, properties: &[Property]) -> BonePose {
    let has = |property| properties.contains(&property);
    BonePose {
        translation: pose.translation.filter(|_| has(Property::Translation)),
        rotation: pose.rotation.filter(|_| has(Property::Rotation)),
        scale: pose.scale.filter(|_| has(Property::Scale)),
        ..pose
    }
}

/// By its name, so that the text means the same in another model; by its number where it shares its name.
pub(super) fn named(skeleton: &dragonfly_anim::data::Skeleton, bone: BoneIndex) -> BoneRef {
    match skeleton.bones.get(bone as usize) {
        Some(rules) if !rules.name.is_empty() && skeleton.find(&rules.name) == Some(bone) => {
            BoneRef::Name(rules.name.clone())
        }
        _ => BoneRef::Index(bone),
    }
}
