//! What panels ask for about keys.

use super::drag::{KeyDrag, KeyDragOp};
use super::flags::BoneFlag;
use super::intervals::WHOLE;
use super::markers::MarkerDeed;
use super::selection::KeySelection;
use super::window::TimeWindow;
use super::{ChannelId, channel};
use crate::panels::state::{Effect, State};
use crate::panels::status::Level;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::Change;
use dragonfly_document::bones::Choice;
use std::sync::Arc;

/// See the module.
#[derive(Clone, Debug, PartialEq)]
pub enum KeysRequest {
    /// Selects the keys of channels between two times, ends included.
    Select {
        /// Of which channels.
        channels: Arc<[ChannelId]>,
        /// Seconds.
        stretch: [f32; 2],
        /// How.
        choice: Choice,
    },
    /// Selects single keys of channels: stretches of time for each.
    SelectKeys {
        /// Which.
        parts: Vec<(ChannelId, Vec<[f32; 2]>)>,
        /// How.
        choice: Choice,
    },
    /// Selects a bone by its row, and keeps the rows that are listed.
    SelectRow(BoneIndex, Choice),
    /// Selects no key.
    Deselect,
    /// Shows this part of time, or the whole take.
    Window(Option<TimeWindow>),
    /// A drag goes on like this, or begins.
    Drag(KeyDragOp),
    /// The hand is off: the drag counts.
    Release,
    /// As if the drag had never been.
    Cancel,
    /// Gives a bone a mark, or takes it.
    Flag(BoneFlag, BoneIndex, bool),
    /// Do moved keys go to whole frames?
    Snap(bool),
    /// Are only the selected bones listed?
    OnlySelected(bool),
    /// Part of the names of the bones that are listed.
    Filter(String),
    /// To the markers of the take.
    Marker(MarkerDeed),
    /// This part plays, or the whole take.
    Range(Option<[f32; 2]>),
}

/// Part of the window that is left beside the playhead when that is brought into sight.
const ROOM: f64 = 0.1;

impl State {
    /// Does what a panel asked for.
    pub(in crate::panels) fn keys_request(&mut self, request: KeysRequest) -> Option<Effect> {
        match request {
            KeysRequest::Select { channels, stretch, choice } => self.select_keys(&channels, stretch, choice),
            KeysRequest::SelectKeys { parts, choice } => self.select_parts(&parts, choice),
            KeysRequest::SelectRow(bone, choice) => {
                let listed = super::shown_bones(self);
                self.selection.choose(&[bone], choice);
                self.keys.kept = Some((listed, self.selection.bones().to_vec()));
            }
            KeysRequest::Deselect => self.keys.selection = KeySelection::default(),
            KeysRequest::Window(window) => self.show_window(window),
            KeysRequest::Drag(op) => return self.drag_keys(op),
            KeysRequest::Release => return self.release_keys(),
            KeysRequest::Cancel => return self.cancel_keys(),
            KeysRequest::Flag(flag, bone, on) => self.flag(flag, bone, on),
            KeysRequest::Snap(on) => self.keys.snap = on,
            KeysRequest::OnlySelected(on) => self.keys.only_selected = on,
            KeysRequest::Filter(text) => {
                self.keys.filter = text;
                let listed = super::shown_bones(self);
                self.keys.selection.drop_bones(|bone| !listed.contains(&bone));
            }
            KeysRequest::Marker(deed) => {
                if let Some(id) = self.slot().map(|slot| slot.id) {
                    self.keys.markers.change(id, deed);
                }
            }
            KeysRequest::Range(range) => self.set_range(range),
        }
        None
    }

    pub(in crate::panels) fn select_keys(
        &mut self,
        channels: &[ChannelId],
        stretch: [f32; 2],
        choice: Choice,
    ) {
        self.keys.has_hand = true;
        // What a drag that waits for its answer moved is selected when that is there.
        if self.keys.drag.is_some() {
            return;
        }
        let Some(take) = self.shared_take().cloned() else { return };
        let free: Vec<ChannelId> =
            channels.iter().copied().filter(|&(bone, _)| !self.keys.flags.locked(bone)).collect();
        if free.is_empty()
            && let Some(&(bone, _)) = channels.first()
        {
            self.say_locked(bone);
        }
        self.keys.selection.choose(&take, &free, stretch, choice);
    }

    pub(super) fn select_parts(&mut self, parts: &[(ChannelId, Vec<[f32; 2]>)], choice: Choice) {
        self.keys.has_hand = true;
        if choice == Choice::Replace {
            self.keys.selection = KeySelection::default();
        }
        let choice = if choice == Choice::Toggle { Choice::Toggle } else { Choice::Add };
        let Some(take) = self.shared_take().cloned() else { return };
        for (channel, stretches) in parts.iter().filter(|((bone, _), _)| !self.keys.flags.locked(*bone)) {
            self.keys.selection.choose_parts(&take, *channel, stretches, choice);
        }
    }

    /// Selects everything that is listed and not locked.
    pub(in crate::panels) fn select_all_keys(&mut self) {
        let Some(take) = self.shared_take().cloned() else { return };
        let bones = super::shown_bones(self);
        let channels: Vec<ChannelId> =
            bones.iter().flat_map(|&bone| channel::channels(&take, bone)).collect();
        self.select_keys(&channels, WHOLE, Choice::Replace);
    }

    fn show_window(&mut self, window: Option<TimeWindow>) {
        let Some(take) = self.take() else { return };
        let (first, last) = (f64::from(take.start), f64::from(take.end().max(self.time())));
        self.keys.window = window.map(|window| window.mended().near(first, last));
    }

    /// Leaves room behind a take that has become longer where its end is seen: who makes it grow goes on there, and finds
    /// everything where it was.
    pub(in crate::panels) fn keep_room(&mut self) {
        let Some(take) = self.take().filter(|_| self.keys.drag.is_none()) else { return };
        let (start, end) = (take.start, take.end());
        let Some([first, last]) = self.keys.seen.replace([start, end]).filter(|[_, last]| end > *last) else {
            return;
        };
        let window = self.keys.window.unwrap_or_else(|| TimeWindow::whole(first, last - first));
        if (window.start..=window.start + window.length).contains(&f64::from(last)) {
            let to = f64::from(end) + f64::from(end - start) * ROOM;
            let length = window.length.max(to - window.start);
            self.show_window(Some(TimeWindow { length, ..window }));
        }
    }

    /// Shows the part of time with the playhead, where that stands and is out of sight.
    pub(in crate::panels) fn bring_into_sight(&mut self) {
        let Some(take) = self.take().filter(|_| !self.playback.playing) else { return };
        let (time, window) = (f64::from(self.time()), self.keys.window(take));
        let end = window.start + window.length;
        // What single precision puts beside it is in sight.
        let slack = window.length * 1e-3;
        if (window.start - slack..=end + slack).contains(&time) {
            return;
        }
        let whole = window.start <= f64::from(take.start) && end >= f64::from(take.end());
        self.show_window(Some(if whole {
            let (first, last) = (window.start.min(time), end.max(time));
            TimeWindow { start: first, length: (last - first) * (1.0 + ROOM) }
        } else if time > end {
            // Who looks at a part goes on looking at as much.
            window.panned(time - end + window.length * ROOM)
        } else {
            window.panned(time - window.start - window.length * ROOM)
        }));
    }

    /// A drag begins or goes on.
    pub(super) fn drag_keys(&mut self, op: KeyDragOp) -> Option<Effect> {
        self.keys.has_hand = true;
        // One that was let go still waits: the next begins when it is done.
        if self.keys.drag.as_ref().is_some_and(|drag| !drag.held()) {
            return None;
        }
        if let Some(drag) = &mut self.keys.drag {
            drag.op = op;
        } else {
            let (take, base) = (self.take_ref()?, Arc::clone(self.shared_take()?));
            let moving = match op {
                KeyDragOp::Ripple { from, .. } => {
                    let bones = base.tracks.iter().map(|track| track.bone);
                    let all: Vec<ChannelId> = bones.flat_map(|bone| channel::channels(&base, bone)).collect();
                    let mut late = KeySelection::default();
                    late.choose(&base, &all, [from, f32::INFINITY], Choice::Replace);
                    late
                }
                _ => self.keys.selection.clone(),
            };
            if moving.is_empty() && !matches!(op, KeyDragOp::Edit(_)) {
                return None;
            }
            let gesture = self.new_gesture();
            self.keys.drag = Some(KeyDrag::begin(gesture, take, base, moving, op));
        }
        self.keys.drag.as_mut()?.send(&self.dragging.echo, false).map(Effect::Change)
    }

    pub(super) fn release_keys(&mut self) -> Option<Effect> {
        let drag = self.keys.drag.as_mut().filter(|drag| drag.held())?;
        let change = drag.send(&self.dragging.echo, true);
        drag.release();
        let over = drag.has_sent().then_some(Change::Release(drag.gesture));
        self.settle_keys();
        let changes: Vec<Change> = change.into_iter().chain(over).collect();
        (!changes.is_empty()).then_some(Effect::Changes(changes))
    }

    /// As if the drag had never been; nothing where there is none.
    pub(in crate::panels) fn cancel_keys(&mut self) -> Option<Effect> {
        let drag = self.keys.drag.take_if(|drag| drag.held())?;
        drag.has_sent().then_some(Effect::Change(Change::Cancel(drag.gesture)))
    }

    /// The effect, unless it edits a bone that is locked: then a drag ends, and the person is told.
    pub(in crate::panels) fn unlocked(&mut self, effect: Effect) -> Option<Effect> {
        if !self.keys.flags.any_locked() {
            return Some(effect);
        }
        let skeleton = Arc::clone(&self.loaded()?.model.animation.skeleton);
        let changes = match &effect {
            Effect::Change(change) => std::slice::from_ref(change),
            Effect::Changes(changes) => changes,
            Effect::Cut(_, change) => std::slice::from_ref(change),
            _ => &[],
        };
        let locked = changes.iter().find_map(|change| self.keys.flags.locked_bone_in(change, &skeleton));
        let Some(bone) = locked else { return Some(effect) };
        self.say_locked(bone);
        self.keys.drag = None;
        None
    }

    /// Takes out of a list what is of locked bones, and says so. Tells whether anything is left.
    pub(in crate::panels) fn spare_locked<T>(
        &mut self,
        list: &mut Vec<T>,
        bone_of: impl Fn(&T) -> BoneIndex,
    ) -> bool {
        let flags = &self.keys.flags;
        let mut spared: Vec<BoneIndex> =
            list.iter().map(&bone_of).filter(|&bone| flags.locked(bone)).collect();
        list.retain(|item| !flags.locked(bone_of(item)));
        spared.sort_unstable();
        spared.dedup();
        match spared[..] {
            [] => {}
            [bone, ..] if list.is_empty() => self.say_locked(bone),
            [bone] => {
                let text = format!("{} is locked and stays as it is", self.bone_name(bone));
                self.status.say(Level::Info, text);
            }
            _ => {
                let text = format!("{} bones are locked and stay as they are", spared.len());
                self.status.say(Level::Info, text);
            }
        }
        !list.is_empty()
    }

    pub(in crate::panels) fn say_locked(&mut self, bone: BoneIndex) {
        let text = format!("{} is locked: its keys are not edited", self.bone_name(bone));
        self.status.say(Level::Warning, text);
    }

    fn flag(&mut self, flag: BoneFlag, bone: BoneIndex, on: bool) {
        self.keys.flags.set(flag, bone, on);
        let flags = self.keys.flags.clone();
        self.keys.selection.drop_bones(|bone| flags.locked(bone));
    }
}
