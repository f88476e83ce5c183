//! The contacts stored with the take that is shown, and how fast the worst of them slides.

use dragonfly_anim::contact::{ContactTrack, SlideMeter, SlideSpeed};
use dragonfly_anim::data::{Skeleton, Take};
use dragonfly_anim::motion::Axis;
use dragonfly_document::View;
use dragonfly_document::adapter::{CONTACTS, stored_contacts};
use std::sync::Arc;

/// Samples of the take in one frame of the window: about 2 ms.
const SAMPLES: usize = 2000;

/// The contacts of the take that is shown. They are read when they change, and their slide is measured when the take changes, a part in
/// each frame.
#[derive(Debug, Default)]
pub struct FootContacts {
    /// The text from which the contacts were read.
    text: Option<Arc<str>>,
    skeleton: Option<Arc<Skeleton>>,
    track: ContactTrack,
    measured: Option<MeasuredTake>,
    worst: Option<SlideSpeed>,
}

/// The take whose slide is measured.
#[derive(Debug)]
struct MeasuredTake {
    take: Arc<Take>,
    rate: u32,
    /// Meters in one unit of length.
    unit: f32,
    /// `None` when everything is measured.
    meter: Option<SlideMeter>,
}

impl FootContacts {
    /// Returns the contacts of the take that is shown.
    pub fn track(&self) -> &ContactTrack {
        &self.track
    }

    /// Returns the contact that slides fastest; of the take before its last change while it is being measured.
    pub fn worst(&self) -> Option<SlideSpeed> {
        self.worst
    }

    /// Returns whether a part of the take is still to be measured.
    pub(super) fn is_measuring(&self) -> bool {
        self.measured.as_ref().is_some_and(|measured| measured.meter.is_some())
    }

    /// Reads the contacts of a take and measures a part of it; `unit` is the number of meters in one unit of the model.
    pub(super) fn update(&mut self, view: Option<&View>, take: Option<usize>, rate: u32, unit: f32) {
        let shown = view.zip(take).and_then(|(view, take)| {
            let extras = &view.slots.get(take)?.original.extras;
            Some((view, extras, extras.get(CONTACTS)?, view.takes.get(take)?))
        });
        let Some((view, extras, text, take)) = shown else {
            if self.text.is_some() {
                *self = Self::default();
            }
            return;
        };
        let skeleton = &view.loaded.model.animation.skeleton;
        let is_read = self.text.as_ref().is_some_and(|read| Arc::ptr_eq(read, text))
            && self.skeleton.as_ref().is_some_and(|read| Arc::ptr_eq(read, skeleton));
        if !is_read {
            self.track = stored_contacts(extras, skeleton);
            (self.text, self.skeleton) = (Some(Arc::clone(text)), Some(Arc::clone(skeleton)));
            self.measured = None;
        }
        self.measure(take, skeleton, rate, unit);
    }

    fn measure(&mut self, take: &Arc<Take>, skeleton: &Skeleton, rate: u32, unit: f32) {
        let contacts = self.track.contacts();
        let same = |measured: &&mut MeasuredTake| {
            Arc::ptr_eq(&measured.take, take) && (measured.rate, measured.unit) == (rate, unit)
        };
        if self.measured.as_mut().filter(same).is_none() {
            let meter = Some(SlideMeter::new(contacts, rate as f32, Axis::Y, unit));
            self.measured = Some(MeasuredTake { take: Arc::clone(take), rate, unit, meter });
        }
        let Some(measured) = &mut self.measured else { return };
        if let Some(meter) = &mut measured.meter
            && meter.step(take, skeleton, SAMPLES)
        {
            self.worst = meter.worst();
            measured.meter = None;
        }
    }
}
