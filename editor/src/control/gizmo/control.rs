//! The gizmo as a control of the scene: it is where its handles are, and everywhere while it drags.

use super::{Gizmo, GizmoAnswer};
use crate::control::base::{BaseControl, ControlId, Mouse, Pass};
use crate::control::framework::ControlFramework;
use crate::control::key::{Key, Modifiers};
use crate::control::viewport::{Button, CLICK};
use dragonfly_picture::gizmo::{Handle, Tool};
use glam::Vec2;

/// Registered over the whole picture, inside of its control, so that what misses a handle goes to the picture.
#[derive(Clone, Debug)]
pub struct GizmoControl {
    /// The gizmo itself.
    pub gizmo: Gizmo,
    /// Top left of the picture, points from that of the window.
    pub corner: Vec2,
    /// May poses be changed? If not, a press on a handle is only noted, see [`Self::take_refused`].
    pub editable: bool,
    /// Was the drag begun by a key, so that no button is held?
    by_key: bool,
    answer: Option<GizmoAnswer>,
    /// Where a handle was pressed, as long as the pointer has not moved: such a press is a click on what lies behind.
    pressed: Option<Pressed>,
    clicked: Option<Mouse>,
    refused: bool,
}

/// A press that may still be a click.
#[derive(Clone, Copy, Debug)]
struct Pressed {
    /// Where, and with which keys.
    mouse: Mouse,
    /// Points that the pointer may go from there.
    slack: f32,
    /// Does nothing move before?
    waits: bool,
}

/// Points: a hand that holds a ring or an arrow may mean the least of turns.
const STEADY: f32 = 1.5;

impl Default for GizmoControl {
    fn default() -> Self {
        Self {
            gizmo: Gizmo::default(),
            corner: Vec2::ZERO,
            editable: true,
            by_key: false,
            answer: None,
            pressed: None,
            clicked: None,
            refused: false,
        }
    }
}

impl GizmoControl {
    /// Begins a drag by a key, with the pointer at `at` in the window; the gizmo, whose name is `own`, has mouse and keyboard
    /// until it ends. `false` where there is nothing to drag.
    pub fn begin_by_key(&mut self, own: ControlId, at: Vec2, framework: &mut ControlFramework) -> bool {
        let begins = self.gizmo.begin(None, at - self.corner);
        if begins {
            self.by_key = true;
            self.pressed = None;
            framework.grab(own);
            self.answer = Some(GizmoAnswer::Changed);
        }
        begins
    }

    /// What became of the drag since this was asked last: changed, confirmed or cancelled. [`Gizmo::drag`] has the poses.
    pub fn take_answer(&mut self) -> Option<GizmoAnswer> {
        self.answer.take()
    }

    /// Was the drag that goes on begun by a key, so that no button is held?
    pub fn is_modal(&self) -> bool {
        self.by_key
    }

    /// A click on what lies behind a handle, since this was asked last.
    pub fn take_click(&mut self) -> Option<Mouse> {
        self.clicked.take()
    }

    /// Was a handle pressed while nothing may be changed, since this was asked last?
    pub fn take_refused(&mut self) -> bool {
        std::mem::take(&mut self.refused)
    }

    /// Ends a drag as Escape does, whoever has the mouse.
    pub fn cancel(&mut self, framework: &mut ControlFramework) {
        let answer = self.gizmo.cancel();
        self.note(answer, framework);
    }

    /// Notes an answer; tells whether the input was for the gizmo.
    fn note(&mut self, answer: GizmoAnswer, framework: &mut ControlFramework) -> Pass {
        if answer == GizmoAnswer::Ignored {
            return Pass::ToParent;
        }
        self.answer = Some(answer);
        if answer != GizmoAnswer::Changed {
            self.pressed = None;
            if std::mem::take(&mut self.by_key) {
                framework.release();
            }
        }
        Pass::Stop
    }
}

impl BaseControl for GizmoControl {
    fn is_pos_on(&self, point: Vec2) -> bool {
        self.gizmo.is_dragging() || self.gizmo.handle_at(point - self.corner).is_some()
    }

    fn mouse_move(&mut self, mouse: Mouse, framework: &mut ControlFramework) -> Pass {
        let at = mouse.at - self.corner;
        if self.gizmo.is_dragging() {
            self.pressed =
                self.pressed.filter(|pressed| pressed.mouse.at.distance(mouse.at) <= pressed.slack);
            if self.pressed.is_some_and(|pressed| pressed.waits) {
                return Pass::Stop;
            }
            let answer = self.gizmo.pointer(at, mouse.modifiers);
            return self.note(answer, framework);
        }
        self.gizmo.hover(Some(at));
        Pass::ToParent
    }

    fn mouse_leave(&mut self, _framework: &mut ControlFramework) {
        self.gizmo.hover(None);
    }

    fn mouse_down(&mut self, button: Button, mouse: Mouse, framework: &mut ControlFramework) -> Pass {
        let at = mouse.at - self.corner;
        let answer = match button {
            Button::Left if self.gizmo.is_dragging() => self.gizmo.confirm(),
            // With Alt the mouse turns the camera, whatever is under it.
            Button::Left if !mouse.modifiers.alt => {
                let handle = self.gizmo.handle_at(at);
                if handle.is_some() && !self.editable {
                    self.refused = true;
                    return Pass::Stop;
                }
                // The ball is large: it hides more bones than it turns.
                let ball = handle == Some(Handle::Center) && self.gizmo.tool == Tool::Rotate;
                let slack = if ball { CLICK } else { STEADY };
                self.pressed = handle.is_some().then_some(Pressed { mouse, slack, waits: ball });
                let begins = handle.is_some() && self.gizmo.begin(handle, at);
                if begins { GizmoAnswer::Changed } else { GizmoAnswer::Ignored }
            }
            Button::Right => self.gizmo.cancel(),
            Button::Left | Button::Middle => GizmoAnswer::Ignored,
        };
        self.note(answer, framework)
    }

    fn mouse_up(&mut self, button: Button, _mouse: Mouse, framework: &mut ControlFramework) -> Pass {
        if button != Button::Left || self.by_key {
            return Pass::ToParent;
        }
        self.clicked = self.pressed.take().map(|pressed| pressed.mouse);
        let answer = if self.clicked.is_some() { self.gizmo.cancel() } else { self.gizmo.confirm() };
        self.note(answer, framework)
    }

    fn key_down(
        &mut self,
        key: Key,
        modifiers: Modifiers,
        _repeat: bool,
        framework: &mut ControlFramework,
    ) -> Pass {
        let answer = self.gizmo.key_down(key, modifiers);
        self.note(answer, framework)
    }

    /// The drag is taken back: its end would never be heard of.
    fn input_lost(&mut self, framework: &mut ControlFramework) {
        let answer = self.gizmo.cancel();
        self.note(answer, framework);
    }
}
