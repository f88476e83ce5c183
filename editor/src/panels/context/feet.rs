//! Feet that edits hold in the contacts of the take that is shown, and the units of what is shown.

use super::PanelContext;
use crate::panels::difference_text::ShownScale;
use dragonfly_anim::contact::limb_of;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::edit::BoneRef;

impl PanelContext<'_> {
    /// Returns the units in which times and distances are shown.
    pub(in crate::panels) fn scale(&self) -> ShownScale {
        ShownScale { frame_rate: self.frame_rate, millimeters: self.unit.millimeters() }
    }

    /// Returns whether smoothing can hold feet: the take that is shown has contacts and no layers.
    pub fn can_hold_feet(&self) -> bool {
        !self.contacts.track().is_empty() && self.layers().is_empty()
    }

    /// Returns the feet that smoothing holds: those with contacts and a limb of which no bone is locked.
    pub fn held_feet(&self) -> Vec<BoneRef> {
        if !(self.keys.holds_feet() && self.can_hold_feet()) {
            return Vec::new();
        }
        let Some(loaded) = self.loaded() else { return Vec::new() };
        let skeleton = &loaded.model.animation.skeleton;
        let flags = self.keys.flags();
        let is_free = |&bone: &BoneIndex| {
            limb_of(skeleton, bone).is_some_and(|limb| {
                ![limb.root, limb.middle, limb.end].iter().any(|&bone| flags.locked(bone))
            })
        };
        let mut feet: Vec<BoneIndex> =
            self.contacts.track().contacts().iter().map(|contact| contact.bone).collect();
        feet.dedup();
        feet.into_iter().filter(is_free).map(BoneRef::Index).collect()
    }
}
