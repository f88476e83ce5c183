//! Everything about keys that the timeline and the curves share: what is selected, what is dragged, which part of time
//! is shown, markers, marks of bones, the range that plays. Nothing here draws.

pub mod channel;
pub mod clipboard;
pub mod columns;
mod commands;
pub mod drag;
pub mod flags;
pub mod intervals;
pub mod markers;
mod range;
mod request;
pub mod selection;
pub mod shift;
mod shown;
mod step;
pub mod window;

pub use channel::ChannelId;
pub use drag::KeyDragOp;
pub use flags::{BoneFlag, BoneFlags};
pub use markers::{Marker, MarkerDeed, Markers};
pub use request::KeysRequest;
pub use selection::KeySelection;
pub use shift::Shift;
pub use shown::bones as shown_bones;
pub use window::{TimeScale, TimeWindow};

use super::change_summary;
use super::settings::TimelineSettings;
use super::state::State;
use drag::KeyDrag;
use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_document::View;
use std::sync::Arc;

/// See the module.
#[derive(Clone, Debug)]
pub struct Keys {
    /// Which keys are selected.
    pub selection: KeySelection,
    /// Do moved keys go to whole frames?
    pub snap: bool,
    /// Are only the selected bones listed, where any are selected?
    pub only_selected: bool,
    /// Bones that were listed when one of their rows was clicked, and what was selected by it: the others stay listed as long
    /// as that is selected.
    kept: Option<(Vec<BoneIndex>, Vec<BoneIndex>)>,
    /// Part of the names of the bones that are listed; empty for all.
    pub filter: String,
    /// Marks of bones.
    pub flags: BoneFlags,
    /// Markers of all takes.
    pub markers: Markers,
    /// The part of time that is shown; none for the whole take.
    window: Option<TimeWindow>,
    /// Begin and end of the take when nothing was dragged last, seconds.
    seen: Option<[f32; 2]>,
    /// The part that plays, seconds; none for the whole take.
    range: Option<[f32; 2]>,
    drag: Option<KeyDrag>,
    /// Was the timeline, or were the curves, touched last? Then what is copied are keys.
    pub has_hand: bool,
    /// Keys that were pasted and are selected once they are there.
    awaited: Option<clipboard::Awaited>,
}

impl Default for Keys {
    fn default() -> Self {
        Self {
            selection: KeySelection::default(),
            snap: true,
            only_selected: true,
            kept: None,
            filter: String::new(),
            flags: BoneFlags::default(),
            markers: Markers::default(),
            window: None,
            seen: None,
            range: None,
            drag: None,
            has_hand: false,
            awaited: None,
        }
    }
}

/// The keys as they are to be drawn now.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The take: as it is, or as it was when a drag began.
    pub take: Arc<Take>,
    /// The selected keys, of that take.
    pub selection: KeySelection,
    /// Where they are drawn.
    pub shift: Shift,
    /// Are they drawn at their old places too?
    pub copies: bool,
}

impl Keys {
    /// Nothing selected, as the settings say.
    pub fn of(settings: TimelineSettings) -> Self {
        let TimelineSettings { snap, only_selected } = settings;
        Self { snap, only_selected, ..Self::default() }
    }

    /// Lets go of a drag whose hand is still on it, as if it had never begun.
    pub(in crate::panels) fn drop_held(&mut self) {
        self.drag.take_if(|drag| drag.held());
    }

    /// The drag under way.
    pub fn drag(&self) -> Option<&KeyDrag> {
        self.drag.as_ref()
    }

    /// The part that plays, seconds.
    pub fn range(&self) -> Option<[f32; 2]> {
        self.range
    }

    /// The part of time that is shown of a take.
    pub fn window(&self, take: &Take) -> TimeWindow {
        self.window.unwrap_or_else(|| TimeWindow::whole(take.start, take.length))
    }

    /// Another model is open, or none.
    fn forget(&mut self) {
        let (snap, only_selected, flags) = (self.snap, self.only_selected, self.flags.emptied());
        *self = Self { snap, only_selected, flags, ..Self::default() };
    }
}

impl State {
    /// The take that is shown, as it is shared.
    pub fn shared_take(&self) -> Option<&Arc<Take>> {
        self.view.as_ref()?.takes.get(self.playback.take?)
    }

    /// The keys as they are to be drawn now; none where no take is shown.
    pub fn drawn_keys(&self) -> Option<Drawn> {
        match &self.keys.drag {
            Some(drag) if !matches!(drag.op, KeyDragOp::Edit(_)) => Some(Drawn {
                take: Arc::clone(&drag.base),
                selection: drag.moving.clone(),
                shift: drag.op.shift(),
                copies: matches!(drag.op, KeyDragOp::Duplicate(_)),
            }),
            _ => Some(Drawn {
                take: Arc::clone(self.shared_take()?),
                selection: self.keys.selection.clone(),
                shift: Shift::NONE,
                copies: false,
            }),
        }
    }

    /// Markers of the take that is shown.
    pub fn markers(&self) -> &[Marker] {
        self.slot().map_or(&[], |slot| self.keys.markers.of(slot.id))
    }

    /// The file in the program's own folder that holds the markers of the model that is open; said once.
    pub fn wanted_markers(&mut self) -> Option<String> {
        self.keys.markers.wanted()
    }

    /// Takes its text.
    pub fn read_markers(&mut self, text: &str) {
        if let Some(view) = &self.view {
            self.keys.markers.read(text, &view.slots);
        }
    }

    /// The file and what it is to hold, when the markers changed since the last call.
    pub fn unsaved_markers(&mut self) -> Option<(String, String)> {
        let view = self.view.as_ref()?;
        self.keys.markers.unsaved(&view.slots)
    }

    /// Another model is shown.
    pub(super) fn open_keys(&mut self) {
        self.keys.forget();
        if let Some(view) = &self.view {
            self.keys.markers = Markers::open(view.file.key());
        }
    }

    /// A newer view of the same model is shown, which may be saved elsewhere now and have other takes.
    pub(super) fn keep_markers(&mut self, before: Option<&View>) {
        let Some(view) = &self.view else { return };
        if before.is_none_or(|before| before.file != view.file) {
            self.keys.markers.rename(view.file.key());
        }
        if let Some(before) = before.filter(|before| before.slots.len() < view.slots.len()) {
            self.keys.markers.take_along(&before.slots, &view.slots);
        }
    }

    /// Another take is shown.
    pub(super) fn leave_take(&mut self) {
        self.keys.selection = KeySelection::default();
        (self.keys.window, self.keys.range, self.keys.drag) = (None, None, None);
        self.keys.seen = None;
        self.keys.awaited = None;
    }

    /// A newer view is there, or time has passed: ends a drag that was let go and is done.
    pub(super) fn settle_keys(&mut self) {
        let Some(view) = &self.view else { return };
        self.select_pasted(view.generation);
        let echo = &self.dragging.echo;
        if let Some(drag) = self.keys.drag.take_if(|drag| drag.is_settled(echo)) {
            self.keys.selection = match (self.shared_take(), &drag.op) {
                (
                    Some(take),
                    KeyDragOp::Move(_)
                    | KeyDragOp::Scale { .. }
                    | KeyDragOp::Duplicate(_)
                    | KeyDragOp::Snap(_),
                ) => drag.moved(take),
                (Some(take), KeyDragOp::Ripple { from, by }) => self.keys.selection.rippled(take, *from, *by),
                _ => self.keys.selection.clone(),
            };
            if let Some(brought) = drag.brings() {
                self.tell_replaced(drag.base.keys(), brought);
            }
        }
    }

    /// Says how many keys of the take gave way to others.
    fn tell_replaced(&mut self, before: usize, brought: usize) {
        let now = self.take().map_or(0, Take::keys);
        let told =
            self.view.as_ref().and_then(|view| change_summary::describe_replaced(view, before, brought, now));
        if let Some(text) = told {
            self.status.remark(text);
        }
    }

    /// An edit was refused.
    pub fn keys_refused(&mut self) {
        self.keys.awaited = None;
        if let Some(drag) = &mut self.keys.drag {
            drag.refused();
        }
        self.settle_keys();
    }
}
