//! The drag that goes on, whoever holds it: the gizmo, a number, keys, a curve.
//!
//! What is half done is no step. It is not saved, nothing is undone under it, and nobody leaves with it. So while a drag
//! goes on keys give no commands, as in other programs of this kind; and whatever asks for something of the document all
//! the same, the window's cross or a screen reader, first has the drag taken back. The hand may still hold on to it
//! afterwards: what it says then is about nothing, and is not heard.
//!
//! The end of a drag may never come: a mouse is unplugged, another window takes the keyboard. Then it is taken back, too,
//! and the panels are told that the button is up.

use super::echo::Echo;
use super::saving::Deed;
use super::state::{Effect, State};
use dragonfly_document::Change;
use dragonfly_document::history::Gesture;
use egui::{Context, Event, Key, Modifiers, PointerButton, Popup, RawInput, pos2};
use std::collections::VecDeque;

/// Every button that can be held.
const BUTTONS: [PointerButton; 5] = [
    PointerButton::Primary,
    PointerButton::Secondary,
    PointerButton::Middle,
    PointerButton::Extra1,
    PointerButton::Extra2,
];

/// See the module.
#[derive(Clone, Debug, Default)]
pub struct Dragging {
    /// The drag that changed something and has not ended.
    open: Option<Gesture>,
    /// Gestures up to this one are over, whatever is still said of them.
    over: u64,
    /// Numbers of changes, and what is shown before the document answers them.
    pub echo: Echo,
    /// Are the panels to let go of what they drag?
    drops: bool,
    /// What the panels are to hear in their next drawings, a list each.
    told: VecDeque<Vec<Event>>,
}

impl Dragging {
    /// Does a drag go on that changed something?
    pub fn is_open(&self) -> bool {
        self.open.is_some()
    }

    /// Gives the panels what they are to hear before `input`, and lets them drop what they drag; more follows in the next
    /// drawing where `true` comes back.
    pub fn tell(&mut self, context: &Context, input: &mut RawInput) -> bool {
        if std::mem::take(&mut self.drops) {
            context.stop_dragging();
        }
        if let Some(events) = self.told.pop_front() {
            input.events.splice(0..0, events);
        }
        !self.told.is_empty()
    }
}

impl State {
    /// Gives `pass` what may go on to the document and further of an effect, and before it what takes a drag back that it
    /// would cut in two.
    pub fn let_through(&mut self, effect: Effect, pass: &mut impl FnMut(Effect)) {
        match effect {
            Effect::Change(change) => {
                if let Some(change) = self.heard(change, pass) {
                    self.send(change, pass);
                }
            }
            Effect::Changes(changes) => {
                for change in changes {
                    if let Some(change) = self.heard(change, pass) {
                        self.send(change, pass);
                    }
                }
            }
            Effect::Cut(text, change) => {
                pass(Effect::Copy(text));
                self.let_through(Effect::Change(change), pass);
            }
            Effect::TakeBack => self.take_back(pass),
            Effect::HandsOff => self.hands_are_off(pass),
            // These only look.
            effect @ Effect::Deed(Deed::LookAtFile | Deed::Search) => pass(effect),
            effect @ (Effect::Open(_) | Effect::Quit | Effect::Deed(_)) => {
                self.take_back(pass);
                pass(effect);
            }
            effect => pass(effect),
        }
    }

    /// Numbers a change, shows it before the document answers where that is possible, and passes it on.
    fn send(&mut self, change: Change, pass: &mut impl FnMut(Effect)) {
        let number = self.dragging.echo.send(&change, &mut self.view);
        if let Change::Edit(_, Some(gesture)) | Change::Cancel(gesture) = change {
            self.keys.sent(gesture, number);
        }
        pass(Effect::Send(number, change));
    }

    /// The change, unless it is of a drag that is over.
    fn heard(&mut self, change: Change, pass: &mut impl FnMut(Effect)) -> Option<Change> {
        let own = &mut self.dragging;
        match &change {
            Change::Edit(_, Some(gesture)) if gesture.0 <= own.over => {
                self.keys.forget_drag(*gesture);
                return None;
            }
            Change::Edit(_, Some(gesture)) => own.open = Some(*gesture),
            Change::Release(gesture) | Change::Cancel(gesture) => {
                own.open.take_if(|open| open == gesture);
            }
            Change::Edit(_, None) | Change::Undo | Change::Redo | Change::GoTo(_) => self.take_back(pass),
        }
        Some(change)
    }

    /// Takes back what is dragged, as if it had never begun, whoever holds it.
    pub fn take_back(&mut self, pass: &mut impl FnMut(Effect)) {
        if self.hands.edits() {
            self.drop_hold();
        }
        self.keys.drop_held();
        if let Some(gesture) = self.dragging.open.take() {
            self.dragging.over = self.dragging.over.max(gesture.0);
            self.dragging.drops = true;
            self.send(Change::Cancel(gesture), pass);
        }
    }

    /// Nobody holds anything any more, so a drag that did not say that it ended has.
    pub fn hands_are_off(&mut self, pass: &mut impl FnMut(Effect)) {
        if let Some(gesture) = self.dragging.open.filter(|_| !self.hands.is_busy()) {
            self.dragging.open = None;
            self.send(Change::Release(gesture), pass);
        }
    }

    /// The window lost the keyboard: whatever is held, its end may not be told here. What is dragged is taken back, and the
    /// panels hear of Escape and then of buttons that are up, far from everything so that none of them is pressed by it.
    pub(super) fn lose_input(&mut self, context: &Context, effects: &mut Vec<Effect>) {
        effects.push(Effect::TakeBack);
        let held: Vec<PointerButton> = context
            .input(|input| BUTTONS.into_iter().filter(|button| input.pointer.button_down(*button)).collect());
        if held.is_empty() {
            return;
        }
        let modifiers = Modifiers::NONE;
        let escape =
            |pressed| Event::Key { key: Key::Escape, physical_key: None, pressed, repeat: false, modifiers };
        let far = pos2(-1e4, -1e4);
        let up = |button| Event::PointerButton { pos: far, button, pressed: false, modifiers };
        // A text that is being typed, and a question, are not what is dragged.
        let escapes =
            !context.text_edit_focused() && self.question().is_none() && !Popup::is_any_open(context);
        self.dragging.told.clear();
        self.dragging.told.push_back(escapes.then(|| escape(true)).into_iter().collect());
        let mut rest = vec![escape(false), Event::PointerMoved(far)];
        rest.extend(held.into_iter().map(up));
        rest.push(Event::PointerGone);
        self.dragging.told.push_back(rest);
    }
}
