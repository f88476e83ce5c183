//! Editing of keys, as the timeline and the curves share it: the selected keys, the drag, the part of time that is
//! shown, markers, flags of bones, and the play range. No function here draws.

pub mod aim;
mod buttonless;
pub mod channel;
pub mod clipboard;
pub mod columns;
pub mod drag;
pub mod flags;
pub mod intervals;
pub mod markers;
pub mod op;
pub mod request;
pub mod selection;
pub mod shift;
mod units;
pub mod window;

pub use aim::KeyAim;
pub use buttonless::{ButtonlessDrag, ButtonlessKind, ButtonlessStart, ButtonlessStep, KeyAxis, KeyPanel};
pub use channel::ChannelId;
pub use flags::{BoneFlag, BoneFlags};
pub use markers::{Marker, MarkerAction, Markers};
pub use op::KeyDragOp;
pub use request::KeysRequest;
pub use selection::KeySelection;
pub use shift::Shift;
pub use window::{TimeScale, TimeWindow};

use super::settings::TimelineSettings;
use clipboard::Pasted;
use drag::KeyDrag;
use dragonfly_anim::data::{BoneIndex, Take};
use dragonfly_anim::root_bone::BoneShift;
use dragonfly_document::adapter::TakeVersions;
use dragonfly_document::bones::{BoneSelection, Choice};
use dragonfly_document::edit::SAME_TIME;
use dragonfly_picture::between;
use std::collections::HashSet;
use std::sync::Arc;

/// Margin beyond the playhead when it is brought into sight, as a part of the window.
const MARGIN: f64 = 0.1;

/// The state of key editing.
#[derive(Clone, Debug)]
pub struct KeyEditing {
    selection: KeySelection,
    /// Whether moved keys go to whole frames.
    snap: bool,
    /// Whether only the selected bones are listed, if any are selected.
    only_selected: bool,
    /// Whether only bones are listed whose keys are not those of the file.
    only_changed: bool,
    /// Whether the ruler has seconds instead of frames.
    seconds: bool,
    /// Whether smoothing holds feet in the contacts of the take.
    hold_feet: bool,
    /// Bones that were listed when one of their rows was clicked, and the selection that this made: the other bones stay
    /// listed as long as that is selected.
    kept: Option<(HashSet<BoneIndex>, Vec<BoneIndex>)>,
    /// Part of the names of the bones that are listed; empty for all.
    filter: String,
    flags: BoneFlags,
    markers: Markers,
    /// The part of time that is shown; `None` for the whole take.
    window: Option<TimeWindow>,
    /// Start and end of the take when it was last shown without a drag, seconds.
    seen: Option<[f32; 2]>,
    /// The play range, seconds; `None` for the whole take.
    range: Option<[f32; 2]>,
    drag: Option<KeyDrag>,
    /// The drag that follows the pointer without a button.
    buttonless: Option<ButtonlessDrag>,
    /// Action of the next press over keys, if a command prepared one.
    aim: Option<KeyAim>,
    /// Whether the timeline or the curves were used last. Then the copy command copies keys.
    has_focus: bool,
    /// Keys that were pasted and are selected once the document has them.
    pasted: Option<Pasted>,
}

impl Default for KeyEditing {
    fn default() -> Self {
        Self {
            selection: KeySelection::default(),
            snap: true,
            only_selected: true,
            only_changed: false,
            seconds: false,
            hold_feet: true,
            kept: None,
            filter: String::new(),
            flags: BoneFlags::default(),
            markers: Markers::default(),
            window: None,
            seen: None,
            range: None,
            drag: None,
            buttonless: None,
            aim: None,
            has_focus: false,
            pasted: None,
        }
    }
}

/// The keys as they are to be drawn now.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// The take as it is shown.
    pub take: Arc<Take>,
    /// The selected keys of that take.
    pub selection: KeySelection,
}

/// A drag of keys that ended, and the keys that the take had before.
#[derive(Clone, Copy, Debug)]
pub(super) struct EndedDrag {
    /// Number of keys before the drag.
    pub(super) before: usize,
    /// Number of keys that the drag was to add.
    pub(super) added: usize,
}

impl KeyEditing {
    /// Returns the initial state with these settings.
    pub fn of(settings: TimelineSettings) -> Self {
        let TimelineSettings { snap, only_selected, seconds, hold_feet } = settings;
        Self { snap, only_selected, seconds, hold_feet, ..Self::default() }
    }

    /// Returns the settings that are remembered between runs.
    pub(super) fn settings(&self) -> TimelineSettings {
        let Self { snap, only_selected, seconds, hold_feet, .. } = *self;
        TimelineSettings { snap, only_selected, seconds, hold_feet }
    }

    /// Returns the selected keys.
    pub fn selection(&self) -> &KeySelection {
        &self.selection
    }

    /// Returns whether moved keys go to whole frames.
    pub fn snap(&self) -> bool {
        self.snap
    }

    /// Sets whether moved keys go to whole frames.
    pub fn set_snap(&mut self, snap: bool) {
        self.snap = snap;
    }

    /// Returns whether smoothing holds feet in the contacts of the take.
    pub fn holds_feet(&self) -> bool {
        self.hold_feet
    }

    /// Lets smoothing hold feet, or no longer.
    pub(super) fn toggle_hold_feet(&mut self) {
        self.hold_feet = !self.hold_feet;
    }

    /// Returns whether only bones are listed whose keys are not those of the file.
    pub fn only_changed(&self) -> bool {
        self.only_changed
    }

    /// Lists only bones whose keys are not those of the file, or all again.
    pub(super) fn toggle_only_changed(&mut self) {
        self.only_changed = !self.only_changed;
    }

    /// Returns whether only the selected bones are listed, if any are selected.
    pub fn only_selected(&self) -> bool {
        self.only_selected
    }

    /// Sets whether only the selected bones are listed.
    pub(super) fn set_only_selected(&mut self, only: bool) {
        self.only_selected = only;
    }

    /// Returns the part of the names of the bones that are listed; empty for all.
    pub fn filter(&self) -> &str {
        &self.filter
    }

    /// Sets the part of the names of the bones that are listed.
    pub(super) fn set_filter(&mut self, filter: String) {
        self.filter = filter;
    }

    /// Returns the flags of bones: muted, soloed, locked.
    pub fn flags(&self) -> &BoneFlags {
        &self.flags
    }

    /// Sets a flag of a bone. Keys of locked bones are deselected.
    pub(super) fn set_flag(&mut self, flag: BoneFlag, bone: BoneIndex, on: bool) {
        self.flags.set(flag, bone, on);
        let flags = &self.flags;
        self.selection.drop_bones(|bone| flags.locked(bone));
    }

    /// Returns the markers of all takes.
    pub fn markers(&self) -> &Markers {
        &self.markers
    }

    /// Returns the markers of all takes, to change, read or store them.
    pub(super) fn markers_mut(&mut self) -> &mut Markers {
        &mut self.markers
    }

    /// Returns the play range, seconds; `None` for the whole take.
    pub fn range(&self) -> Option<[f32; 2]> {
        self.range
    }

    /// Sets the part of `take` that plays, its ends in any order; a range without length is none.
    pub(super) fn set_range(&mut self, range: Option<[f32; 2]>, (start, length): (f32, f32)) {
        let inside = |time: f32| between(time, start, start + length);
        let ordered = range
            .filter(|ends| ends.iter().all(|time| time.is_finite()))
            .map(|[a, b]| [inside(a.min(b)), inside(a.max(b))]);
        self.range = ordered.filter(|[from, to]| to - from > SAME_TIME);
    }

    /// Returns the part of time that is shown of a take.
    pub fn window(&self, take: &Take) -> TimeWindow {
        let take = self.timed(take);
        self.window.unwrap_or_else(|| TimeWindow::whole(take.start, take.length))
    }

    /// Shows this part of time of `take`, or the whole take. A part of the take and the playhead at `time` stay in sight.
    pub(super) fn show_window(&mut self, window: Option<TimeWindow>, take: &Take, time: f32) {
        let (first, last) = (f64::from(take.start), f64::from(take.end().max(time)));
        self.window = window.map(|window| window.sanitized().near(first, last));
    }

    /// Shows exactly this part of time.
    pub(super) fn fit_window(&mut self, window: Option<TimeWindow>) {
        self.window = window.map(TimeWindow::sanitized);
    }

    /// Shows a margin after a take that became longer while its end was in sight, so that an animator who appends keys
    /// finds everything where it was.
    pub(super) fn reserve_margin(&mut self, take: &Take, time: f32) {
        if self.drag.is_some() {
            return;
        }
        let (start, end) = (take.start, take.end());
        let Some([first, last]) = self.seen.replace([start, end]).filter(|[_, last]| end > *last) else {
            return;
        };
        let window = self.window.unwrap_or_else(|| TimeWindow::whole(first, last - first));
        if (window.start..=window.start + window.length).contains(&f64::from(last)) {
            let to = f64::from(end) + f64::from(end - start) * MARGIN;
            let length = window.length.max(to - window.start);
            self.show_window(Some(TimeWindow { length, ..window }), take, time);
        }
    }

    /// Shows the part of time with the playhead at `time`, if it is out of sight.
    pub(super) fn bring_into_sight(&mut self, take: &Take, time: f32) {
        let (at, window) = (f64::from(time), self.window(take));
        // The length of the window stays.
        let Some(moved) = window.showing(at) else { return };
        let end = window.start + window.length;
        let whole = window.start <= f64::from(take.start) && end >= f64::from(take.end());
        let shown = if whole {
            let (first, last) = (window.start.min(at), end.max(at));
            TimeWindow { start: first, length: (last - first) * (1.0 + MARGIN) }
        } else {
            moved
        };
        self.show_window(Some(shown), take, time);
    }

    /// Returns whether the timeline or the curves were used last.
    pub(super) fn has_focus(&self) -> bool {
        self.has_focus
    }

    /// Notes that the timeline or the curves were used last.
    pub(super) fn gain_focus(&mut self) {
        self.has_focus = true;
    }

    /// Notes that something else was used last.
    pub(super) fn lose_focus(&mut self) {
        self.has_focus = false;
    }

    /// Returns a function that returns whether a bone is listed where only the selected bones are, or those whose rows were
    /// there when one of them was clicked.
    pub(super) fn lists<'a>(&'a self, selected: &'a BoneSelection) -> impl Fn(BoneIndex) -> bool + 'a {
        let kept = self.kept.as_ref().filter(|(_, by)| by == selected.bones());
        move |bone| match kept {
            Some((listed, _)) => listed.contains(&bone),
            None => selected.contains(bone),
        }
    }

    /// Keeps the rows that are listed as long as `selected` is the selection.
    pub(super) fn keep_rows(&mut self, listed: Vec<BoneIndex>, selected: &[BoneIndex]) {
        self.kept = Some((listed.into_iter().collect(), selected.to_vec()));
    }

    /// Deselects the keys of bones that are not listed any more: only visible keys are deleted or moved. `selected` are
    /// the selected bones.
    pub(super) fn deselect_unlisted(&mut self, selected: &BoneSelection) {
        if self.drag.is_none() && self.only_selected && selected.active().is_some() {
            let mut keys = std::mem::take(&mut self.selection);
            let lists = self.lists(selected);
            keys.drop_bones(|bone| !lists(bone));
            drop(lists);
            self.selection = keys;
        }
    }

    /// Deselects the keys of all bones but these.
    pub(super) fn deselect_all_but(&mut self, bones: &[BoneIndex]) {
        let kept: HashSet<BoneIndex> = bones.iter().copied().collect();
        self.selection.drop_bones(|bone| !kept.contains(&bone));
        self.selection.drop_shapes();
    }

    /// Selects the keys that were selected before, unless keys are being dragged.
    pub(super) fn restore(&mut self, selection: &KeySelection) {
        if self.drag.is_none() {
            self.selection = selection.clone();
        }
    }

    /// Deselects all keys.
    pub(super) fn deselect(&mut self) {
        self.selection = KeySelection::default();
    }

    /// Selects the keys of channels between two times. Returns a locked bone if all channels belong to locked bones.
    pub(super) fn select(
        &mut self,
        take: &Take,
        channels: &[ChannelId],
        shapes: bool,
        stretch: [f32; 2],
        choice: Choice,
    ) -> Option<BoneIndex> {
        self.has_focus = true;
        // While a drag waits for its answer, nothing is selected: its keys are selected when the answer arrives.
        if self.drag.is_some() {
            return None;
        }
        let free: Vec<ChannelId> =
            channels.iter().copied().filter(|&(bone, _)| !self.flags.locked(bone)).collect();
        self.selection.choose(take, &free, stretch, choice);
        if shapes {
            self.selection.choose_shapes(take, stretch, choice);
        }
        channels.first().filter(|_| free.is_empty()).map(|&(bone, _)| bone)
    }

    /// Selects stretches of time of several channels and of shape keys.
    pub(super) fn select_parts(
        &mut self,
        take: Option<&Take>,
        parts: &[(ChannelId, Vec<[f32; 2]>)],
        shapes: &[[f32; 2]],
        choice: Choice,
    ) {
        self.has_focus = true;
        if choice == Choice::Replace {
            self.deselect();
        }
        let choice = if choice == Choice::Toggle { Choice::Toggle } else { Choice::Add };
        let Some(take) = take else { return };
        for (channel, stretches) in parts.iter().filter(|((bone, _), _)| !self.flags.locked(*bone)) {
            self.selection.choose_parts(take, *channel, stretches, choice);
        }
        if !shapes.is_empty() {
            self.selection.choose_shape_parts(take, shapes, choice);
        }
    }

    /// Notes that an edit was refused, so that pasted keys and the drag do not wait for it any more.
    pub(super) fn refused(&mut self) {
        self.pasted = None;
        self.drag_refused();
    }

    /// Selects pasted keys once the document has them.
    pub(super) fn await_pasted(&mut self, pasted: Pasted) {
        self.pasted = Some(pasted);
    }

    /// Selects keys that were pasted, where `slot` has them now.
    pub(super) fn select_pasted(
        &mut self,
        slot: &TakeVersions,
        take: Option<&Take>,
        generation: u64,
    ) -> Option<EndedDrag> {
        let pasted = self.pasted.take_if(|pasted| pasted.is_in(slot, generation))?;
        self.select_parts(take, pasted.parts(), pasted.shapes(), Choice::Replace);
        Some(EndedDrag { before: pasted.before(), added: pasted.count() })
    }

    /// Forgets everything about the take: another one is shown.
    pub(super) fn before_take_change(&mut self) {
        self.deselect();
        (self.window, self.range, self.drag, self.buttonless) = (None, None, None, None);
        self.seen = None;
        self.pasted = None;
    }

    /// Follows the bones to another skeleton. A drag ends.
    pub(super) fn shift(&mut self, shift: BoneShift) {
        self.selection = self.selection.renumbered(shift);
        self.flags = self.flags.shifted(shift);
        (self.drag, self.buttonless, self.pasted) = (None, None, None);
        self.kept = self.kept.take().map(|(listed, by)| {
            (listed.into_iter().filter_map(|bone| shift.bone(bone)).collect(), shift.bones(&by))
        });
    }

    /// Forgets everything about the model: another one is open, whose markers are stored under `path`.
    pub(super) fn open(&mut self, path: String) {
        let flags = self.flags.emptied();
        *self = Self { flags, markers: Markers::open(path), ..Self::of(self.settings()) };
    }
}
