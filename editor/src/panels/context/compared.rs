//! The take with which the one shown is compared.

use super::PanelContext;
use crate::panels::compared::CompareWith;
use dragonfly_anim::data::Take;
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
        }
    }
}
