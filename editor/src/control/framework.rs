//! Who gets an input (thesis §3.2.9.1).
//!
//! The registered areas form a tree: the parent of a control is the smallest one that it lies wholly inside of, of several
//! as small the one registered last. An input of the mouse goes to the smallest control under the pointer, of several as
//! small the one registered last; where controls do not overlap, as they should not, that is the deepest one. So both rules
//! have an answer for any rectangles. (Where some do overlap in part, those inside of one that is taken out while a button
//! or key is held may get a parent that did not hear of the press, and then one that did hears nothing of the release.)
//!
//! Nothing here is allocated for an input. Names of controls that are gone are noticed, so a control may be taken out while
//! an input is on its way, by itself or by another.

use super::Button;
use super::base::{Area, BaseControl, ControlId, Controls, Mouse, Pass};
use super::input::{InputEvent, PlaceError};
use super::key::{HELD_KEYS, HeldKeys, Key, Modifiers};
use super::places::Places;
use glam::Vec2;

/// Who has the mouse while buttons are held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Capture {
    #[default]
    Free,
    /// This control. `heard` is the last of its ancestors that the press was passed on to.
    By { control: ControlId, heard: ControlId },
    /// Nobody: the control that had it is gone, or the press was lost. Ends when all buttons are up.
    Gone,
}

/// Rounds of telling who has focus and mouse, after which two controls that take it from each other have to stop.
const ROUNDS: usize = 8;

/// The tree of controls and the way of an input through it.
#[derive(Clone, Debug)]
pub struct ControlFramework {
    places: Places,
    /// Where it was last.
    mouse: Option<Vec2>,
    /// Did it leave the window since?
    mouse_gone: bool,
    modifiers: Modifiers,
    held: [bool; 3],
    capture: Capture,
    /// Who has the mouse without a button being held.
    grabbed: Option<ControlId>,
    /// Which control was told that the mouse is over it.
    entered: Option<ControlId>,
    focus: Option<ControlId>,
    /// Which control was told that it has the focus.
    focus_told: Option<ControlId>,
    keys: HeldKeys,
}

impl ControlFramework {
    /// With the root control alone, as large as the window, in points.
    pub fn new(window: Vec2) -> Self {
        Self {
            places: Places::new(Area::new(Vec2::ZERO, window)),
            mouse: None,
            mouse_gone: false,
            modifiers: Modifiers::default(),
            held: [false; 3],
            capture: Capture::Free,
            grabbed: None,
            entered: None,
            focus: None,
            focus_told: None,
            keys: HeldKeys::default(),
        }
    }

    /// The window has another size, in points.
    pub fn resize(&mut self, window: Vec2) {
        self.places.move_to(ControlId::ROOT, Area::new(Vec2::ZERO, window));
    }

    /// Takes a control in. What lies outside of the window is never met.
    pub fn register_control(&mut self, area: Area) -> ControlId {
        self.places.insert(area)
    }

    /// Takes a control in that must lie inside of `parent`.
    pub fn register_inside(&mut self, parent: ControlId, area: Area) -> Result<ControlId, PlaceError> {
        let outer = self.places.area(parent).ok_or(PlaceError::NoParent)?;
        if outer.contains(&area) { Ok(self.places.insert(area)) } else { Err(PlaceError::NotInside) }
    }

    /// Forgets a control, which is told nothing any more; those inside it get its parent. Tells whether there was one; the
    /// root stays.
    pub fn unregister_control(&mut self, id: ControlId) -> bool {
        if let Capture::By { control, heard } = self.capture {
            self.capture = match (control == id, heard == id) {
                (true, true) => Capture::Gone,
                // Those that the press was passed on to hear how it ends.
                (true, false) => match self.places.parent(id) {
                    Some(control) => Capture::By { control, heard },
                    None => self.capture,
                },
                (false, true) => Capture::By { control, heard: self.places.below(id, control) },
                (false, false) => self.capture,
            };
        }
        let parent = self.places.parent(id);
        if !self.places.remove(id) {
            return false;
        }
        self.keys.hand_on(id, parent);
        let forget = |known: &mut Option<ControlId>| *known = known.filter(|&known| known != id);
        forget(&mut self.entered);
        forget(&mut self.grabbed);
        forget(&mut self.focus);
        forget(&mut self.focus_told);
        true
    }

    /// Puts a control elsewhere; what it has captured it keeps. Tells whether there is one.
    pub fn move_control(&mut self, id: ControlId, area: Area) -> bool {
        id != ControlId::ROOT && self.places.move_to(id, area)
    }

    /// Where a control is.
    pub fn area(&self, id: ControlId) -> Option<Area> {
        self.places.area(id)
    }

    /// The control that `id` lies in; `None` for the root.
    pub fn parent(&self, id: ControlId) -> Option<ControlId> {
        self.places.parent(id)
    }

    /// Does `inner` lie in `outer`, or in one that lies in it?
    pub fn is_inside(&self, inner: ControlId, outer: ControlId) -> bool {
        self.places.is_inside(inner, outer)
    }

    /// Gives the keyboard to a control; the ones concerned are told before the next input, or when the present one is done.
    pub fn set_focus(&mut self, id: ControlId) {
        if self.places.area(id).is_some() {
            self.focus = Some(id);
        }
    }

    /// Gives the keyboard to whatever is under the mouse.
    pub fn null_focus(&mut self) {
        self.focus = None;
    }

    /// Gives mouse and keyboard to a control wherever they are, though no button is held, until [`Self::release`] or until
    /// input is lost: for what is begun by a key.
    pub fn grab(&mut self, id: ControlId) {
        if self.places.area(id).is_some() {
            self.grabbed = Some(id);
        }
    }

    /// Ends [`Self::grab`].
    pub fn release(&mut self) {
        self.grabbed = None;
    }

    /// Who has the keyboard.
    pub fn focus(&self) -> Option<ControlId> {
        self.focus
    }

    /// Who has the mouse while a button is held, or because it grabbed it.
    pub fn captured(&self) -> Option<ControlId> {
        match self.capture {
            Capture::By { control, .. } => Some(control),
            _ => self.grabbed,
        }
    }

    /// The control that the mouse is over, as far as it was told.
    pub fn hovered(&self) -> Option<ControlId> {
        self.entered
    }

    /// Finds the control that an input is for and calls it, then its parents as far as it is passed on. Tells which control
    /// stopped it; `None` where it was passed on to the root.
    pub fn resolve_input(&mut self, event: InputEvent, controls: &mut dyn Controls) -> Option<ControlId> {
        self.settle(controls);
        let stopped = match event {
            InputEvent::MouseMove(at) => self.mouse_move(at, controls),
            InputEvent::MouseGone => {
                self.mouse_gone = true;
                None
            }
            InputEvent::MouseDown(button) => self.mouse_down(button, controls),
            InputEvent::MouseUp(button) => self.mouse_up(button, controls),
            InputEvent::Wheel(by) => self.wheel(by, controls),
            InputEvent::KeyDown(key) => self.key_down(key, controls),
            InputEvent::KeyUp(key) => self.key_up(key, controls),
            InputEvent::Modifiers(modifiers) => {
                self.modifiers = modifiers;
                // A drag may mean something else now, though the mouse rests.
                self.pointer().and_then(|at| self.mouse_move(at, controls))
            }
            InputEvent::Lost => {
                self.lost(controls);
                None
            }
        };
        self.settle(controls);
        stopped
    }

    /// Tells who has the focus and who the mouse, as it changed without an input: controls were moved, say. Once a turn.
    pub fn update(&mut self, controls: &mut dyn Controls) {
        self.settle(controls);
    }

    fn mouse_move(&mut self, at: Vec2, controls: &mut dyn Controls) -> Option<ControlId> {
        // No screen is so large: a place reported there is a mistake of the driver.
        if !(at.is_finite() && at.abs().max_element() < 1e5) {
            return None;
        }
        self.mouse = Some(at);
        self.mouse_gone = false;
        self.settle(controls);
        self.tell_mouse(controls, |control, mouse, framework| control.mouse_move(mouse, framework))
    }

    fn wheel(&mut self, by: Vec2, controls: &mut dyn Controls) -> Option<ControlId> {
        if !by.is_finite() {
            return None;
        }
        self.tell_mouse(controls, |control, mouse, framework| control.mouse_wheel(by, mouse, framework))
    }

    fn mouse_down(&mut self, button: Button, controls: &mut dyn Controls) -> Option<ControlId> {
        if self.held[button as usize] {
            // Its release was never heard of: what it began is over.
            self.lost_mouse(controls);
        }
        let begins = !self.held.contains(&true);
        self.held[button as usize] = true;
        if begins {
            let under = self.grabbed.or_else(|| self.under(self.pointer()?, controls));
            self.capture = under.map_or(Capture::Gone, |control| Capture::By { control, heard: control });
        }
        let mouse = Mouse { at: self.mouse?, modifiers: self.modifiers };
        let Capture::By { control, .. } = self.capture else { return None };
        let mut next = Some(control);
        while let Some(id) = next {
            next = self.places.parent(id);
            if !begins || id == control || self.is_on(id, mouse.at, controls) {
                let Some(control) = self.there(id, controls) else { continue };
                match &mut self.capture {
                    // As far up as any press was passed on.
                    Capture::By { heard, .. } if self.places.is_inside(*heard, id) => *heard = id,
                    Capture::By { .. } => {}
                    // The one that was pressed took itself out and passed the press on.
                    _ => self.capture = Capture::By { control: id, heard: id },
                }
                if control.mouse_down(button, mouse, self) == Pass::Stop {
                    return Some(id);
                }
                // It may have taken itself out; its parent was noted before.
            }
        }
        None
    }

    fn mouse_up(&mut self, button: Button, controls: &mut dyn Controls) -> Option<ControlId> {
        if !std::mem::take(&mut self.held[button as usize]) {
            return None;
        }
        let stopped = match self.capture {
            Capture::By { .. } => self
                .tell_mouse(controls, |control, mouse, framework| control.mouse_up(button, mouse, framework)),
            _ => None,
        };
        if !self.held.contains(&true) {
            self.capture = Capture::Free;
        }
        stopped
    }

    /// To the control that has the mouse, else to the one under it, and to those that it is passed on to.
    fn tell_mouse(
        &mut self,
        controls: &mut dyn Controls,
        mut tell: impl FnMut(&mut dyn BaseControl, Mouse, &mut Self) -> Pass,
    ) -> Option<ControlId> {
        let (first, is_captured) = match self.capture {
            Capture::By { control, .. } => (Some(control), true),
            Capture::Free if self.grabbed.is_some() => (self.grabbed, true),
            Capture::Free => (self.under(self.pointer()?, controls), false),
            Capture::Gone => (None, false),
        };
        let mouse = Mouse { at: self.mouse?, modifiers: self.modifiers };
        let mut next = first;
        while let Some(id) = next {
            next = self.places.parent(id);
            // A captured mouse may be anywhere; those who saw the press see what follows.
            if is_captured || Some(id) == first || self.is_on(id, mouse.at, controls) {
                let Some(control) = self.there(id, controls) else { continue };
                if tell(control, mouse, self) == Pass::Stop {
                    return Some(id);
                }
            }
        }
        None
    }

    fn key_down(&mut self, key: Key, controls: &mut dyn Controls) -> Option<ControlId> {
        let held = self.keys.find(key);
        let target = match held {
            Some(control) => control,
            None => {
                // While something is dragged keys are for that: Escape, an axis, a number.
                let known = self.captured().or(self.focus);
                let control = match known {
                    Some(control) => control,
                    None => self.under(self.pointer()?, controls)?,
                };
                if let Some(oldest) = self.keys.full() {
                    self.key_up(oldest, controls);
                }
                self.keys.put(key, control);
                control
            }
        };
        let modifiers = self.modifiers;
        self.tell(target, controls, |control, framework| {
            control.key_down(key, modifiers, held.is_some(), framework)
        })
    }

    fn key_up(&mut self, key: Key, controls: &mut dyn Controls) -> Option<ControlId> {
        let control = self.keys.take(key)?;
        let modifiers = self.modifiers;
        self.tell(control, controls, |control, framework| control.key_up(key, modifiers, framework))
    }

    /// To a control and to those that it is passed on to.
    fn tell(
        &mut self,
        first: ControlId,
        controls: &mut dyn Controls,
        mut tell: impl FnMut(&mut dyn BaseControl, &mut Self) -> Pass,
    ) -> Option<ControlId> {
        let mut next = Some(first);
        while let Some(id) = next {
            next = self.places.parent(id);
            let Some(control) = self.there(id, controls) else { continue };
            if tell(control, self) == Pass::Stop {
                return Some(id);
            }
        }
        None
    }

    /// Releases will not be heard of: what was begun with the mouse is taken back, keys are let go.
    fn lost(&mut self, controls: &mut dyn Controls) {
        let captured = match self.capture {
            Capture::By { control, .. } => Some(control),
            _ => None,
        };
        let grabbed = self.grabbed.take().filter(|&grabbed| Some(grabbed) != captured);
        self.lost_mouse(controls);
        if let Some(control) = grabbed.and_then(|id| self.there(id, controls)) {
            control.input_lost(self);
        }
        self.mouse = None;
        self.modifiers = Modifiers::default();
        for _ in 0..HELD_KEYS {
            let Some(key) = self.keys.first() else { return };
            self.key_up(key, controls);
        }
    }

    fn lost_mouse(&mut self, controls: &mut dyn Controls) {
        self.held = [false; 3];
        let Capture::By { control, heard } = std::mem::take(&mut self.capture) else { return };
        let mut next = Some(control);
        while let Some(id) = next {
            next = self.places.parent(id).filter(|_| id != heard);
            if let Some(control) = self.there(id, controls) {
                control.input_lost(self);
            }
        }
    }

    /// Tells the controls who has focus and mouse, until all know.
    fn settle(&mut self, controls: &mut dyn Controls) {
        for _ in 0..ROUNDS {
            let over = match self.capture {
                // Who has the mouse keeps it.
                Capture::By { .. } | Capture::Gone => self.entered,
                Capture::Free => self.grabbed.or_else(|| self.under(self.pointer()?, controls)),
            };
            if over == self.entered && self.focus == self.focus_told {
                return;
            }
            if over != self.entered {
                if let Some(control) = self.entered.take().and_then(|id| controls.control(id)) {
                    control.mouse_leave(self);
                }
                // The one that was left may have taken the other out.
                if let Some(id) = over.filter(|&id| self.places.area(id).is_some()) {
                    self.entered = Some(id);
                    if let Some(control) = controls.control(id) {
                        control.mouse_enter(self);
                    }
                }
            }
            if self.focus != self.focus_told {
                let now = self.focus;
                if let Some(control) = self.focus_told.take().and_then(|id| controls.control(id)) {
                    control.null_focus(self);
                }
                if let Some(id) = now.filter(|_| self.focus == now) {
                    self.focus_told = now;
                    if let Some(control) = controls.control(id) {
                        control.set_focus(self);
                    }
                }
            }
        }
        // Two controls that take it from each other: it stays with who was told last.
        self.focus = self.focus_told;
    }

    /// Where the mouse is; `None` outside of the window.
    fn pointer(&self) -> Option<Vec2> {
        self.mouse.filter(|_| !self.mouse_gone)
    }

    /// The control under a point; not the root, which has no function.
    fn under(&self, point: Vec2, controls: &mut dyn Controls) -> Option<ControlId> {
        let window = self.places.area(ControlId::ROOT)?;
        if !window.holds(point) {
            return None;
        }
        self.places.smallest(|id, area| {
            area.holds(point) && controls.control(id).is_some_and(|control| control.is_pos_on(point))
        })
    }

    /// The control of a name that is still registered: one called before may have taken it out.
    fn there<'a>(&self, id: ControlId, controls: &'a mut dyn Controls) -> Option<&'a mut dyn BaseControl> {
        self.places.area(id)?;
        controls.control(id)
    }

    fn is_on(&self, id: ControlId, point: Vec2, controls: &mut dyn Controls) -> bool {
        let holds = self.places.area(id).is_some_and(|area| area.holds(point));
        holds && controls.control(id).is_some_and(|control| control.is_pos_on(point))
    }
}
