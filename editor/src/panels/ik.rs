//! Pins, rows of bones that follow, and bones that look: what commands do to them, and what a drag begins with.

use super::state::{Effect, State};
use super::status::Level;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::Change;
use dragonfly_document::posing::{LONGEST_CHAIN, PoseDragState, look_at};
use dragonfly_picture::IkLook;
use dragonfly_picture::gizmo::Tool;
use std::sync::Arc;

impl State {
    /// What a drag at the time shown begins with: the poses as they are seen, the pins, whether rows of bones follow.
    pub fn hold(&mut self) -> Option<PoseDragState> {
        let (view, fixed) = (self.view.clone()?, self.fixed_bones());
        let (take, time) = (self.playback.take, self.time());
        let poses = self.posed.update(&view, take, time).poses();
        let skeleton = Arc::clone(&view.loaded.model.animation.skeleton);
        Some(PoseDragState::new(skeleton, poses, &self.pins, self.ik, None).with_fixed(&fixed))
    }

    /// The same with the poses that were computed last, for numbers that are typed; none where no bone is pinned.
    pub(super) fn hold_of_pins(&self) -> Option<PoseDragState> {
        let animation = self.posed.animation().filter(|_| !self.pins.is_empty())?;
        let skeleton = Arc::clone(&self.loaded()?.model.animation.skeleton);
        let hold = PoseDragState::new(skeleton, animation.poses(), &self.pins, self.ik, None);
        Some(hold.with_fixed(&self.fixed_bones()))
    }

    /// Bones that nothing turns which they follow: locked ones, which are not edited, and those that are seen at rest, of
    /// which nobody would see that they turn.
    pub(super) fn fixed_bones(&self) -> Vec<BoneIndex> {
        let bones = self.loaded().map_or(0, |loaded| loaded.model.animation.skeleton.len());
        self.keys.flags.fixed(bones)
    }

    /// Is this bone held where it is while others move?
    pub fn is_pinned(&self, bone: BoneIndex) -> bool {
        self.pins.contains(&bone)
    }

    /// Pins, and the row of bones that follows the active one, as they are drawn; none where there is nothing of it.
    pub fn ik_look(&self) -> Option<IkLook> {
        let (pins, chain) = (self.pins.clone(), self.ik_chain());
        let pole = self.ik.pole.filter(|_| chain.is_some());
        (chain.is_some() || !pins.is_empty()).then_some(IkLook { pins, chain, pole })
    }

    /// Is this what [`Self::ik_look`] says? Asked every frame: nothing is copied for it.
    pub fn shows_ik(&self, look: Option<&IkLook>) -> bool {
        let chain = self.ik_chain();
        match look {
            None => chain.is_none() && self.pins.is_empty(),
            Some(look) => {
                let pole = self.ik.pole.filter(|_| chain.is_some());
                let some = chain.is_some() || !self.pins.is_empty();
                some && look.pins == self.pins && (look.chain, look.pole) == (chain, pole)
            }
        }
    }

    /// The active bone and how many above it follow, where it is moved with IK.
    fn ik_chain(&self) -> Option<(BoneIndex, u32)> {
        let moves = self.ik.on && self.settings.hand.tool == Some(Tool::Move);
        let bone = self.selected().filter(|_| moves && self.playback.take.is_some())?;
        Some((bone, self.ik.length))
    }

    /// Pins the selected bones, or frees them where all of them are pinned.
    pub(super) fn toggle_pins(&mut self) {
        let bones = self.selection.bones().to_vec();
        let all = bones.iter().all(|&bone| self.is_pinned(bone));
        self.pins.retain(|pin| !bones.contains(pin));
        if !all {
            self.pins.extend(&bones);
        }
        let (what, stay) = match *bones {
            [bone] => (self.bone_name(bone), "it stays"),
            _ => (super::widgets::count(bones.len(), "bone", "bones"), "they stay"),
        };
        let text =
            if all { format!("Freed {what}") } else { format!("Pinned {what}: {stay} while others move") };
        self.status.say(Level::Info, text);
    }

    /// Frees all bones.
    pub(super) fn free_pins(&mut self) {
        self.pins.clear();
        self.status.say(Level::Info, "No bone is pinned any more");
    }

    /// Lets the bones above follow a bone that is moved, or not.
    pub(super) fn toggle_ik(&mut self) {
        self.ik.on = !self.ik.on;
        self.say_ik();
    }

    /// Lets so many bones more follow.
    pub(super) fn lengthen_ik(&mut self, by: i64) {
        self.ik.length = (i64::from(self.ik.length) + by).clamp(1, i64::from(LONGEST_CHAIN)) as u32;
        self.say_ik();
    }

    fn say_ik(&mut self) {
        let count = super::widgets::count(self.ik.length as usize, "bone", "bones");
        self.status.say(
            Level::Info,
            if self.ik.on {
                format!("IK is on: {count} above follow a bone that is moved")
            } else {
                format!("IK is off: a bone is moved alone ({count} with it on)")
            },
        );
    }

    /// Makes the active bone the one towards which elbows and knees bend, or none where it was it.
    pub(super) fn toggle_pole(&mut self) {
        let Some(active) = self.selected() else { return };
        self.ik.pole = Some(active).filter(|_| self.ik.pole != Some(active));
        let name = self.bone_name(active);
        let text = match self.ik.pole {
            Some(_) => format!("Elbows and knees bend towards {name}"),
            None => "Elbows and knees bend as they are".to_owned(),
        };
        self.status.say(Level::Info, text);
    }

    /// Aims the selected bones at the active one.
    pub(super) fn look(&mut self) -> Option<Effect> {
        let view = self.view.clone()?;
        let (take, time) = (self.playback.take, self.time());
        let active = self.selected()?;
        let others: Vec<BoneIndex> = self.bones_to_pose().filter(|&bone| bone != active).collect();
        if others.is_empty() {
            match self.selection.bones().iter().copied().find(|&bone| bone != active) {
                Some(locked) => self.say_locked(locked),
                None => {
                    let text = "Select the bones that shall look, and last the one they shall look at";
                    self.status.say(Level::Info, text);
                }
            }
            return None;
        }
        let animation = self.posed.update(&view, take, time);
        let skeleton = &view.loaded.model.animation.skeleton;
        let target = animation.to_root().get(active as usize)?.w_axis.truncate();
        let poses = look_at(skeleton, animation.poses(), &others, target);
        if poses.is_empty() {
            self.status.say(Level::Info, "There is nothing to turn to");
        }
        self.pose_edit(poses).map(|edit| Effect::Change(Change::Edit(edit, None)))
    }

    /// Another model has other bones.
    pub(super) fn forget_pins(&mut self) {
        self.pins.clear();
        self.ik.pole = None;
    }
}
