//! The reference picture at the time shown.

use super::PanelContext;
use crate::panels::reference::{ReferenceTiming, ReferenceView};
use dragonfly_picture::{ReferenceAppearance, ReferencePlace};

impl PanelContext<'_> {
    /// Returns the frame rate of the reference: the chosen one, its own, or that of the timeline.
    pub(in crate::panels) fn reference_rate(&self) -> f64 {
        let chosen = Some(self.reference.settings().rate).filter(|&rate| rate > 0.0);
        let own = || self.reference.info().and_then(|info| info.rate);
        chosen.or_else(own).map_or(f64::from(self.frame_rate), f64::from)
    }

    /// Returns the index of the frame of the reference at the time shown; `None` if it is not shown.
    pub fn reference_frame(&self) -> Option<usize> {
        let settings = self.reference.settings();
        let info = self.reference.info().filter(|_| settings.shown)?;
        let start = f64::from(settings.first) / f64::from(self.frame_rate.max(1));
        let (rate, frames, repeats) = (self.reference_rate(), info.frames, settings.repeats);
        Some(ReferenceTiming { start, rate, frames, repeats }.frame_at(self.time()))
    }

    /// Fills in what the viewport draws of the reference.
    pub fn fill_reference(&self, look: &mut ReferenceAppearance) {
        let settings = self.reference.settings();
        let picture = self.reference.picture().filter(|_| settings.shown);
        if look.picture.as_ref() != picture {
            look.picture = picture.cloned();
        }
        look.opacity = settings.opacity;
        let [x, y] = settings.offset;
        let (distance, height) = (settings.distance, settings.height);
        let up = y + height / 2.0;
        let plane = |center, right| ReferencePlace::Plane { center, right, height };
        look.place = match settings.view {
            ReferenceView::Camera => {
                ReferencePlace::Camera { scale: settings.scale, offset: settings.offset }
            }
            ReferenceView::Front => plane([x, up, -distance], [1.0, 0.0, 0.0]),
            // From the left side of a figure that looks along z, its front is at the left.
            ReferenceView::Side => plane([-distance, up, -x], [0.0, 0.0, -1.0]),
            ReferenceView::Back => plane([-x, up, distance], [-1.0, 0.0, 0.0]),
        };
    }
}
