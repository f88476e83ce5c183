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

mod hear;
mod settle;

use super::base::{Area, ControlId, Controls};
use super::input::{InputEvent, PlaceError};
use super::key::{HeldKeys, Modifiers};
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
}
