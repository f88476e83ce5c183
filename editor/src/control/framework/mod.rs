//! Routes inputs to controls (thesis §3.2.9.1).
//!
//! The registered areas form a tree: the parent of a control is the smallest one that contains it, of several equal
//! ones the last registered. A mouse input goes to the smallest control under the pointer, of several equal ones the
//! last registered; if controls do not overlap, as they should not, that is the deepest one. So both rules have an
//! answer for any rectangles. (If some controls overlap in part, and one of them is unregistered while a button or key
//! is held, the controls inside it may get a new parent that did not get the press; a control that did get the press
//! may then never get the release.)
//!
//! An input allocates nothing. Ids of unregistered controls are recognized, so a control may be unregistered while an input is
//! processed, by itself or by another.

mod resolve;
mod route;
mod settle;

use super::area::{Area, ControlId};
use super::input::PlaceError;
use super::key::{HeldKeys, Modifiers};
use super::places::ControlTree;
use glam::Vec2;

/// The control that has the mouse while buttons are held.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Capture {
    #[default]
    Free,
    /// This control. `topmost` is the last of its ancestors that the press was passed on to.
    By { control: ControlId, topmost: ControlId },
    /// None: the control that had it was unregistered, or the press was lost. Ends when all buttons are up.
    Gone,
}

/// Maximum number of rounds of notifications after an input, so that two controls that take focus or mouse from each
/// other cannot loop forever.
const ROUNDS: usize = 8;

/// The tree of controls, and the state that routes an input through it.
#[derive(Clone, Debug)]
pub struct ControlFramework {
    places: ControlTree,
    /// Last position of the mouse.
    mouse: Option<Vec2>,
    /// Whether the mouse has left the window since it was at that position.
    mouse_gone: bool,
    modifiers: Modifiers,
    held: [bool; 3],
    capture: Capture,
    /// The control that has the mouse although no button is held.
    grabbed: Option<ControlId>,
    /// The control that was notified that the mouse is in it.
    entered: Option<ControlId>,
    focus: Option<ControlId>,
    /// The control that was notified that it has the focus.
    focus_told: Option<ControlId>,
    keys: HeldKeys,
}

impl ControlFramework {
    /// Returns a framework with the root control alone, as large as the window, in points.
    pub fn new(window: Vec2) -> Self {
        Self {
            places: ControlTree::new(Area::new(Vec2::ZERO, window)),
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

    /// Sets the size of the window, in points.
    pub fn resize(&mut self, window: Vec2) {
        self.places.move_to(ControlId::ROOT, Area::new(Vec2::ZERO, window));
    }

    /// Registers a control. The part of its area outside the window gets no input.
    pub fn register_control(&mut self, area: Area) -> ControlId {
        self.places.insert(area)
    }

    /// Registers a control that must be inside `parent`.
    pub fn register_inside(&mut self, parent: ControlId, area: Area) -> Result<ControlId, PlaceError> {
        let outer = self.places.area(parent).ok_or(PlaceError::NoParent)?;
        if outer.contains(&area) { Ok(self.places.insert(area)) } else { Err(PlaceError::NotInside) }
    }

    /// Unregisters a control, without notifying it; those inside it get its parent. Returns whether it existed; the
    /// root stays.
    pub fn unregister_control(&mut self, id: ControlId) -> bool {
        if let Capture::By { control, topmost } = self.capture {
            self.capture = match (control == id, topmost == id) {
                (true, true) => Capture::Gone,
                // The press was passed on to the parent, so the parent gets the release.
                (true, false) => match self.places.parent(id) {
                    Some(control) => Capture::By { control, topmost },
                    None => self.capture,
                },
                (false, true) => Capture::By { control, topmost: self.places.below(id, control) },
                (false, false) => self.capture,
            };
        }
        let parent = self.places.parent(id);
        if !self.places.remove(id) {
            return false;
        }
        self.keys.pass_on(id, parent);
        let forget = |known: &mut Option<ControlId>| *known = known.filter(|&known| known != id);
        forget(&mut self.entered);
        forget(&mut self.grabbed);
        forget(&mut self.focus);
        forget(&mut self.focus_told);
        true
    }

    /// Moves a control; it keeps what it has captured. Returns whether it exists.
    pub fn move_control(&mut self, id: ControlId, area: Area) -> bool {
        id != ControlId::ROOT && self.places.move_to(id, area)
    }

    /// Returns the area of a control.
    pub fn area(&self, id: ControlId) -> Option<Area> {
        self.places.area(id)
    }

    /// Returns the parent of a control; `None` for the root.
    pub fn parent(&self, id: ControlId) -> Option<ControlId> {
        self.places.parent(id)
    }

    /// Whether `outer` is an ancestor of `inner`.
    pub fn is_inside(&self, inner: ControlId, outer: ControlId) -> bool {
        self.places.is_inside(inner, outer)
    }

    /// Focuses a control. The controls concerned are notified before the next input, or at the end of the present one.
    pub fn set_focus(&mut self, id: ControlId) {
        if self.places.area(id).is_some() {
            self.focus = Some(id);
        }
    }

    /// Removes the focus, so that keys go to the control under the mouse.
    pub fn null_focus(&mut self) {
        self.focus = None;
    }

    /// Gives mouse and keyboard to a control although no button is held, until [`Self::release`] or until the input is
    /// lost: for drags that a key begins.
    pub fn grab(&mut self, id: ControlId) {
        if self.places.area(id).is_some() {
            self.grabbed = Some(id);
        }
    }

    /// Ends [`Self::grab`].
    pub fn release(&mut self) {
        self.grabbed = None;
    }

    /// Returns the control that has the focus.
    pub fn focus(&self) -> Option<ControlId> {
        self.focus
    }

    /// Returns the control that has captured or grabbed the mouse.
    pub fn captured(&self) -> Option<ControlId> {
        match self.capture {
            Capture::By { control, .. } => Some(control),
            _ => self.grabbed,
        }
    }

    /// Returns the control that was notified that the mouse is in it.
    pub fn hovered(&self) -> Option<ControlId> {
        self.entered
    }
}
