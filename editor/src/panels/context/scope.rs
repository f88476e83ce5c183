//! The edits of poses in the scope that is set: at the playhead alone, or as an offset of many keys.

use super::PanelContext;
use crate::panels::edit_scope::EditScope;
use crate::panels::keys::intervals::Intervals;
use dragonfly_anim::offset::Falloff;
use dragonfly_document::edit::{
    BonePose, Edit, FadeShape, OffsetFalloff, OffsetKeys, OffsetRange, OffsetScope, SAME_TIME, ShapeScope,
    TakeRef,
};
use dragonfly_picture::between;

impl PanelContext<'_> {
    /// Returns the reason why edits cannot be made in the scope that is set; `None` if they can.
    pub(in crate::panels) fn scope_refusal(&self) -> Option<&'static str> {
        match self.over.scope {
            EditScope::Frame | EditScope::Take => None,
            EditScope::Keys => {
                let bones = self.selection.bones();
                let has_keys = self.keys.selection().channels().any(|((bone, _), _)| bones.contains(&bone));
                (!has_keys).then_some(NO_KEYS)
            }
            EditScope::Range => {
                let time = self.time();
                let outside = |[from, to]: [f32; 2]| time < from - SAME_TIME || time > to + SAME_TIME;
                self.keys.range().is_some_and(outside).then_some(OUTSIDE)
            }
        }
    }

    /// Returns the keys that edits are for, as edits name them; `None` for the pose at the playhead.
    pub(in crate::panels) fn offset_scope(&self) -> Option<OffsetScope> {
        match (self.over.scope, self.keys.range()) {
            (EditScope::Frame, _) => None,
            (EditScope::Keys, _) => {
                let sets = self.take().map(|take| self.keys.selection().key_sets(take));
                Some(OffsetScope::Keys(sets.unwrap_or_default()))
            }
            (EditScope::Range, Some([from, to])) => Some(OffsetScope::Range(OffsetRange { from, to })),
            (EditScope::Range, None) | (EditScope::Take, _) => Some(OffsetScope::Take),
        }
    }

    /// Returns the reason why weights of shape keys cannot be edited in the scope that is set; `None` if they can.
    pub(in crate::panels) fn shape_scope_refusal(&self) -> Option<&'static str> {
        match self.over.scope {
            EditScope::Frame | EditScope::Take | EditScope::Range => self.scope_refusal(),
            EditScope::Keys => self.keys.selection().shapes().is_empty().then_some(NO_SHAPE_KEYS),
        }
    }

    /// Returns the keys of shape keys that edits are for; `None` for the weights at the playhead.
    pub(in crate::panels) fn shape_scope(&self) -> Option<ShapeScope> {
        match (self.over.scope, self.keys.range()) {
            (EditScope::Frame, _) => None,
            (EditScope::Keys, _) => {
                let shapes = self.take().map(|take| self.keys.selection().finite_shapes(take));
                Some(ShapeScope::Keys(shapes.unwrap_or_default()))
            }
            (EditScope::Range, Some([from, to])) => Some(ShapeScope::Range(OffsetRange { from, to })),
            (EditScope::Range, None) | (EditScope::Take, _) => Some(ShapeScope::Take),
        }
    }

    /// Returns how edits fade out around their keys. Around a play range they always do, within a frame if the falloff is off: the
    /// motion before and after it stays.
    pub(in crate::panels) fn offset_falloff(&self) -> Option<OffsetFalloff> {
        let fades = self.over.fades().then(|| OffsetFalloff {
            seconds: self.frame_seconds() * self.settings.falloff.frames as f32,
            shape: self.settings.falloff.shape,
        });
        let one_frame = OffsetFalloff { seconds: self.frame_seconds(), shape: FadeShape::Linear };
        fades.or((self.over.scope == EditScope::Range && self.keys.range().is_some()).then_some(one_frame))
    }

    /// Returns the parts of time that get all of an edit, and the falloff around them, where one is on that applies to the scope: the
    /// selected keys of the selected bones, or the play range.
    pub(in crate::panels) fn shown_falloff(&self) -> Option<(Intervals, Falloff)> {
        let falloff = self.offset_falloff().filter(|_| self.over.fades())?;
        let (start, length) = self.take_bounds();
        let inside = |time: f32| between(time, start, start + length);
        let inside = |[from, to]: [f32; 2]| [inside(from), inside(to)];
        let parts = match (self.over.scope, self.keys.range()) {
            (EditScope::Frame | EditScope::Take, _) | (EditScope::Range, None) => return None,
            (EditScope::Range, Some(range)) => Intervals::one(inside(range)),
            (EditScope::Keys, _) => {
                let of_bones =
                    self.keys.selection().channels().filter(|((bone, _), _)| self.selection.contains(*bone));
                Intervals::of(of_bones.flat_map(|(_, keys)| keys.stretches().iter().copied().map(inside)))
            }
        };
        Some((parts, falloff.into()))
    }

    /// Returns the edit that sets these poses (parent space) at a time, and offsets the other keys of the scope by as much.
    pub(super) fn offset_edit(
        &self,
        take: TakeRef,
        time: f32,
        poses: Vec<BonePose>,
    ) -> Result<Edit, Vec<BonePose>> {
        let Some(over) = self.offset_scope() else { return Err(poses) };
        let falloff = self.offset_falloff();
        Ok(Edit::OffsetKeys(OffsetKeys { take, poses, at: Some(time), over, falloff }))
    }
}

/// The reason why selected keys cannot be edited.
const NO_KEYS: &str = "Edits apply to the selected keys, but no key of the selected bones is selected";
/// The reason why selected keys of shape keys cannot be edited.
const NO_SHAPE_KEYS: &str = "Edits apply to the selected keys, but no key of shape keys is selected";
/// The reason why the play range cannot be edited.
const OUTSIDE: &str = "Edits apply to the play range, and the playhead is outside of it";
