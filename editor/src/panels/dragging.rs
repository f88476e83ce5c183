//! The drag in progress, whichever panel or tool it belongs to: the gizmo, a number, keys, a curve.
//!
//! A drag that has not ended is not yet an undo step. It is not saved, undo waits for it, and the program does not quit during it.
//! So keyboard shortcuts are off during a drag, as in other animation programs, and any other request that concerns
//! the document, such as the close button of the window or a screen reader, first cancels the drag. The panel
//! may still send edits of that drag afterwards: they are dropped.
//!
//! The end of a drag may never arrive: a mouse is unplugged, or another window takes the focus. Then the drag is cancelled, too,
//! and the panels receive events that release the buttons.

use super::echo::Echo;
use dragonfly_document::Change;
use dragonfly_document::View;
use dragonfly_document::edit::{Edit, KeySet, OffsetKeys, OffsetScope, SetPending};
use dragonfly_document::history::Gesture;
use egui::{Context, Event, Key, Modifiers, PointerButton, RawInput, pos2};
use std::cell::Cell;
use std::collections::VecDeque;

/// Every button that can be held.
const BUTTONS: [PointerButton; 5] = [
    PointerButton::Primary,
    PointerButton::Secondary,
    PointerButton::Middle,
    PointerButton::Extra1,
    PointerButton::Extra2,
];

/// The drag in progress, and the events that end it in the panels.
#[derive(Clone, Debug, Default)]
pub struct Dragging {
    /// The drag that changed something and has not ended.
    open: Option<Gesture>,
    /// Gestures up to this number are over; later edits of them are dropped.
    over: u64,
    /// Assigns numbers to changes, and applies them to what is shown before the document answers.
    pub echo: Echo,
    /// Whether the panels must end their drags.
    drops: bool,
    /// Events for the panels in the next frames, one list for each frame.
    events: VecDeque<Vec<Event>>,
    /// Number of gestures begun so far.
    gestures: Cell<u64>,
    offset: Option<DraggedOffset>,
}

/// The drag of an offset of many keys.
#[derive(Clone, Debug)]
struct DraggedOffset {
    gesture: Gesture,
    /// The newest edit, which is sent at the end of the drag; `None` where each edit is sent at once, because it is quick.
    held: Option<OffsetKeys>,
}

/// The treatment of a change that is requested while a drag may be in progress.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Admission {
    /// The change belongs to a drag that is over.
    Drop,
    /// The change goes to the document.
    Pass,
    /// The drag is cancelled, then the change goes to the document.
    CancelDragFirst,
}

impl Dragging {
    /// Returns whether a drag is in progress that has changed something.
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Returns the gesture of the drag that is in progress and has changed something.
    pub fn open(&self) -> Option<Gesture> {
        self.open
    }

    /// Begins a gesture: a drag, or a slider that is held, whose edits are one step.
    pub fn new_gesture(&self) -> Gesture {
        self.gestures.set(self.gestures.get() + 1);
        Gesture(self.gestures.get())
    }

    /// Inserts the events that end a drag before those of `input`, and lets egui drop what it drags. Returns whether more
    /// events follow in the next frame.
    pub(super) fn prepend_events(&mut self, context: &Context, input: &mut RawInput) -> bool {
        if std::mem::take(&mut self.drops) {
            context.stop_dragging();
        }
        if let Some(events) = self.events.pop_front() {
            input.events.splice(0..0, events);
        }
        !self.events.is_empty()
    }

    /// Notes a change that was asked for, and returns what to do with it.
    pub(super) fn admit(&mut self, change: &Change) -> Admission {
        match change {
            Change::Edit(_, Some(gesture)) if gesture.0 <= self.over => return Admission::Drop,
            Change::Edit(_, Some(gesture)) => self.open = Some(*gesture),
            Change::Release(gesture) | Change::Cancel(gesture) => {
                self.open.take_if(|open| open == gesture);
            }
            Change::Edit(_, None) | Change::Undo | Change::Redo | Change::GoTo(_) => {
                return Admission::CancelDragFirst;
            }
        }
        Admission::Pass
    }

    /// Returns the edit to send now in place of an offset of many keys that is being dragged. A quick one is sent as it is. One that would
    /// take longer than a frame is held back until the drag ends: only what it does at the playhead is sent, so that no move of
    /// the mouse costs more in a longer take. `around` are the last key before the time of the offset and the first one after it.
    pub(super) fn preview(
        &mut self,
        edit: OffsetKeys,
        gesture: Gesture,
        view: Option<&View>,
        around: impl FnOnce(f32) -> [f32; 2],
    ) -> Edit {
        let known = self.offset.as_ref().filter(|offset| offset.gesture == gesture);
        let edit = Edit::OffsetKeys(edit);
        // Decided once for a drag: the cost depends on the keys, which stay the same.
        let quick = match known {
            Some(offset) => offset.held.is_none(),
            None => self.echo.is_quick(&edit, view),
        };
        let Edit::OffsetKeys(edit) = edit else { return edit };
        if quick {
            self.offset = Some(DraggedOffset { gesture, held: None });
            return Edit::OffsetKeys(edit);
        }
        let preview = preview_of(&edit, around);
        self.offset = Some(DraggedOffset { gesture, held: Some(edit) });
        preview
    }

    /// Returns the offset that was held back during a drag that ends now.
    pub(super) fn take_offset(&mut self, gesture: Gesture) -> Option<Edit> {
        self.offset.take_if(|offset| offset.gesture == gesture)?.held.map(Edit::OffsetKeys)
    }

    /// Ends the drag as cancelled. Returns its gesture.
    pub(super) fn cancel(&mut self) -> Option<Gesture> {
        let gesture = self.open.take()?;
        self.over = self.over.max(gesture.0);
        self.drops = true;
        Some(gesture)
    }

    /// Ends the drag and keeps its edits. Returns its gesture.
    pub(super) fn release(&mut self) -> Option<Gesture> {
        self.open.take()
    }

    /// Prepares events that release all buttons that are held, far from everything so that they press nothing; with
    /// `escape` the Escape key first.
    pub(super) fn release_buttons(&mut self, context: &Context, escape: bool) {
        let held: Vec<PointerButton> = context
            .input(|input| BUTTONS.into_iter().filter(|button| input.pointer.button_down(*button)).collect());
        if held.is_empty() {
            return;
        }
        let modifiers = Modifiers::NONE;
        let key =
            |pressed| Event::Key { key: Key::Escape, physical_key: None, pressed, repeat: false, modifiers };
        let far = pos2(-1e4, -1e4);
        let up = |button| Event::PointerButton { pos: far, button, pressed: false, modifiers };
        self.events.clear();
        self.events.push_back(escape.then(|| key(true)).into_iter().collect());
        let mut rest = vec![key(false), Event::PointerMoved(far)];
        rest.extend(held.into_iter().map(up));
        rest.push(Event::PointerGone);
        self.events.push_back(rest);
    }
}

/// Returns an edit that shows at the time of an offset what the offset does there.
fn preview_of(edit: &OffsetKeys, around: impl FnOnce(f32) -> [f32; 2]) -> Edit {
    let (take, poses, time) = (edit.take.clone(), edit.poses.clone(), edit.at.unwrap_or_default());
    let OffsetScope::Keys(sets) = &edit.over else {
        // The pose at that time is the wanted one.
        return Edit::SetPending(SetPending { take, time, poses });
    };
    // Of selected keys, only those next to that time shape the pose there.
    let reach = edit.falloff.map_or(0.0, |falloff| falloff.seconds);
    let [from, to] = around(time);
    let (from, to) = (from - reach, to + reach);
    let near = |set: &KeySet| KeySet {
        from: Some(set.from.map_or(from, |own| own.max(from))),
        to: Some(set.to.map_or(to, |own| own.min(to))),
        ..set.clone()
    };
    Edit::OffsetKeys(OffsetKeys { over: OffsetScope::Keys(sets.iter().map(near).collect()), ..edit.clone() })
}
