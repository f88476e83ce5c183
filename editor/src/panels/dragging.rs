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
