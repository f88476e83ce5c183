//! Pins and IK: which bones stay where they are, and which follow one that is moved.

use super::PanelContext;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::posing::PoseDragState;
use dragonfly_picture::IkLook;
use dragonfly_picture::gizmo::Tool;
use std::sync::Arc;

impl PanelContext<'_> {
    /// Returns the last computed poses with the pins, for edits by typed numbers; `None` if no bone is pinned.
    pub(in crate::panels) fn hold_of_pins(&self) -> Option<PoseDragState> {
        let animation = self.posed.animation().filter(|_| !self.pins.is_empty())?;
        let skeleton = Arc::clone(&self.loaded()?.model.animation.skeleton);
        let hold = PoseDragState::new(skeleton, animation.poses(), self.pins, self.ik, None);
        Some(hold.with_fixed(&self.fixed_bones()))
    }

    /// Returns the bones that no chain rotates: locked ones, which are not edited, and muted ones, which are shown at
    /// rest, so that the rotation would not be visible.
    pub(in crate::panels) fn fixed_bones(&self) -> Vec<BoneIndex> {
        self.keys.flags().fixed(self.bone_count())
    }

    /// Returns whether any bone can follow another one that is moved.
    pub fn bones_follow(&self) -> bool {
        self.ik.on || !self.pins.is_empty()
    }

    /// Returns whether this bone stays where it is while others move.
    pub fn is_pinned(&self, bone: BoneIndex) -> bool {
        self.pins.contains(&bone)
    }

    /// Returns the pins and the chain of bones that follows the active one, as they are drawn; `None` if there are neither.
    pub fn ik_look(&self) -> Option<IkLook> {
        let (pins, chain) = (self.pins.to_vec(), self.ik_chain());
        let pole = self.ik.pole.filter(|_| chain.is_some());
        (chain.is_some() || !pins.is_empty()).then_some(IkLook { pins, chain, pole })
    }

    /// Returns whether `look` is what [`Self::ik_look`] returns. Called every frame, so it copies nothing.
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

    /// Returns the active bone and the number of bones above it that follow, if it is moved with IK.
    fn ik_chain(&self) -> Option<(BoneIndex, u32)> {
        let moves = self.ik.on && self.settings.tools.tool == Some(Tool::Move);
        let bone = self.selected().filter(|_| moves && self.playback.take.is_some())?;
        Some((bone, self.ik.length))
    }
}
