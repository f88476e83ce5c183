//! The take with which the one shown is compared, and the second skeleton in the viewport.

use super::PanelContext;
use crate::panels::compared::CompareWith;
use crate::panels::dialog_preview::DialogPreview;
use crate::panels::overlay::Overlay;
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_picture::{OtherSkeleton, SecondSkeleton};
use std::sync::Arc;

impl<'a> PanelContext<'a> {
    /// Returns the take with which the one shown is compared; `None` where there is no comparison, or that take is gone or was not
    /// in the file.
    pub fn compared_take(&self) -> Option<&'a Arc<Take>> {
        let (view, slot) = (self.view?, self.slot()?);
        match self.compared {
            CompareWith::Nothing => None,
            CompareWith::Opened => view.loaded.model.animation.takes.get(slot.origin?),
            CompareWith::Take(id) => {
                view.slots.iter().find(|other| other.id == id).map(|other| other.shown())
            }
            CompareWith::File(take) => self.compared_file.file()?.model.animation.takes.get(take),
        }
    }

    /// Returns the skeleton that the compared take moves; `None` for that of the open model.
    pub fn compared_skeleton(&self) -> Option<&'a Arc<Skeleton>> {
        match self.compared {
            CompareWith::File(_) => Some(&self.compared_file.file()?.model.animation.skeleton),
            CompareWith::Nothing | CompareWith::Opened | CompareWith::Take(_) => None,
        }
    }

    /// Returns the second skeleton in the viewport: that of the dialog that is open, or else the compared take.
    pub fn second_skeleton(&self) -> Option<SecondSkeleton> {
        match (self.overlay, self.preview) {
            (Some(Overlay::Loop), DialogPreview::LoopEnd { offset }) => {
                let take = Arc::clone(self.shown_take()?);
                let times = Some([take.end(), take.start]);
                Some(SecondSkeleton { times, offset, ..SecondSkeleton::of(take) })
            }
            (Some(Overlay::Retarget), DialogPreview::Source { take, scale, offset, marked }) => {
                let animation = &self.retarget.source()?.model.animation;
                let take = Arc::clone(animation.takes.get(take)?);
                let other = OtherSkeleton {
                    skeleton: Arc::clone(&animation.skeleton),
                    first_of: Arc::clone(self.retarget.unpaired()),
                    marked,
                };
                Some(SecondSkeleton { other: Some(other), scale, offset, ..SecondSkeleton::of(take) })
            }
            _ => {
                let take = Arc::clone(self.compared_take()?);
                let other = self.compared_skeleton().map(|skeleton| OtherSkeleton {
                    skeleton: Arc::clone(skeleton),
                    first_of: Arc::clone(self.compared_file.first_of()),
                    marked: None,
                });
                Some(SecondSkeleton { other, ..SecondSkeleton::of(take) })
            }
        }
    }
}
