//! The gizmo as a control of the scene: its area is that of its handles, and the whole viewport during a drag.

use super::{Gizmo, GizmoAnswer};
use crate::control::area::ControlId;
use crate::control::base::{BaseControl, InputFlow, Mouse};
use crate::control::drag::{DragEvent, DragMachine, THRESHOLD};
use crate::control::framework::ControlFramework;
use crate::control::input::Button;
use crate::control::key::{Key, Modifiers};
use crate::control::viewport_tools::tool::{ToolOutcome, ToolScene, ViewportTool};
use dragonfly_picture::gizmo::{GizmoView, Handle, PosedSkeleton, Tool};
use glam::Vec2;

/// The control of the gizmo, registered over the whole viewport inside its control, so that a press that misses the handles
/// reaches the viewport.
#[derive(Clone, Debug)]
pub struct GizmoControl {
    /// The gizmo itself.
    pub gizmo: Gizmo,
    /// Top left of the viewport, points from that of the window.
    pub corner: Vec2,
    /// Whether poses can be changed. If not, a press on a handle is only noted, see [`Self::take_refused`].
    pub editable: bool,
    /// The press or drag of a handle. A press that is released at the same position is a click on what the handle covers.
    machine: DragMachine<HandlePress, DragOrigin>,
    answer: Option<GizmoAnswer>,
    clicked: Option<Mouse>,
    refused: bool,
    /// Whether the pointer is over a handle that cannot be dragged.
    refuses: bool,
}

/// A press that may still be a click.
#[derive(Clone, Copy, Debug)]
struct HandlePress {
    /// Position and modifier keys.
    mouse: Mouse,
    /// Whether the drag waits until the press can no longer be a click.
    waits: bool,
}

/// How a drag began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum DragOrigin {
    /// By the left button, which is held.
    Button,
    /// By a key: no button is held.
    Key,
}

/// Distance within which a press on a ring or an arrow is still a click, points. It is short, because even a very small
/// drag of them may be intended.
const STEADY: f32 = 1.5;

impl Default for GizmoControl {
    fn default() -> Self {
        Self {
            gizmo: Gizmo::default(),
            corner: Vec2::ZERO,
            editable: true,
            machine: DragMachine::default(),
            answer: None,
            clicked: None,
            refused: false,
            refuses: false,
        }
    }
}

impl GizmoControl {
    /// Returns whether the pointer is over a handle that cannot be dragged now.
    pub fn refuses(&self) -> bool {
        self.refuses && !self.editable
    }

    /// Begins a drag by a key, with the pointer at `at` in the window. The gizmo, whose id is `own`, has mouse and
    /// keyboard until the drag ends. Returns false if there is nothing to drag.
    pub fn begin_by_key(&mut self, own: ControlId, at: Vec2, framework: &mut ControlFramework) -> bool {
        let begins = self.gizmo.begin(None, at - self.corner);
        if begins {
            self.machine.begin(DragOrigin::Key);
            framework.grab(own);
            self.answer = Some(GizmoAnswer::Changed);
        }
        begins
    }

    /// Returns the outcome of the drag since the last call: changed, confirmed or cancelled. [`Gizmo::drag`] has the
    /// poses.
    pub fn take_answer(&mut self) -> Option<GizmoAnswer> {
        self.answer.take()
    }

    /// Returns and clears the last click on a handle, which is meant for the object that the handle covers.
    pub fn take_click(&mut self) -> Option<Mouse> {
        self.clicked.take()
    }

    /// Whether a handle was pressed since the last call although nothing can be changed.
    pub fn take_refused(&mut self) -> bool {
        std::mem::take(&mut self.refused)
    }

    /// Cancels a drag as Escape does, whichever control has the mouse.
    pub fn cancel(&mut self, framework: &mut ControlFramework) {
        let answer = self.gizmo.cancel();
        self.note(answer, framework);
    }

    /// Notes an outcome. Returns whether the input is passed on.
    fn note(&mut self, answer: GizmoAnswer, framework: &mut ControlFramework) -> InputFlow {
        if answer == GizmoAnswer::Ignored {
            return InputFlow::ToParent;
        }
        self.answer = Some(answer);
        if answer != GizmoAnswer::Changed {
            if self.is_modal() {
                framework.release();
            }
            self.machine.cancelled();
        }
        InputFlow::Stop
    }
}

impl ViewportTool for GizmoControl {
    fn place(&mut self, corner: Vec2) {
        self.corner = corner;
    }

    fn look(&mut self, view: GizmoView) {
        self.gizmo.look(view);
    }

    fn show(&mut self, scene: &ToolScene<'_>) {
        self.editable = scene.editable;
        self.gizmo.settings = scene.settings;
        self.gizmo.tool = scene.tool.unwrap_or_default();
        let PosedSkeleton { skeleton, poses, to_root } = scene.pose;
        self.gizmo.select(skeleton, poses, to_root, scene.bones, None);
    }

    fn take_outcome(&mut self) -> Option<ToolOutcome> {
        if let Some(mouse) = self.take_click() {
            return Some(ToolOutcome::Click(mouse));
        }
        if self.take_refused() {
            return Some(ToolOutcome::Refused);
        }
        match self.take_answer()? {
            GizmoAnswer::Ignored => None,
            GizmoAnswer::Changed => Some(ToolOutcome::Poses),
            // A drag that ends where it began changes nothing.
            GizmoAnswer::Confirmed if !self.gizmo.is_identity() => Some(ToolOutcome::Done),
            GizmoAnswer::Confirmed | GizmoAnswer::Cancelled => Some(ToolOutcome::Cancelled),
        }
    }

    fn is_dragging(&self) -> bool {
        self.gizmo.is_dragging()
    }

    fn is_modal(&self) -> bool {
        self.machine.drag() == Some(&DragOrigin::Key)
    }
}

impl BaseControl for GizmoControl {
    fn is_pos_on(&self, point: Vec2) -> bool {
        self.gizmo.is_dragging() || self.gizmo.handle_at(point - self.corner).is_some()
    }

    fn mouse_move(&mut self, mouse: Mouse, framework: &mut ControlFramework) -> InputFlow {
        let at = mouse.at - self.corner;
        if self.gizmo.is_dragging() {
            if let DragEvent::Started(_) = self.machine.moved(mouse.at) {
                self.machine.begin(DragOrigin::Button);
            }
            if self.machine.pressed().is_some_and(|press| press.waits) {
                return InputFlow::Stop;
            }
            let answer = self.gizmo.pointer(at, mouse.modifiers);
            return self.note(answer, framework);
        }
        // A handle that cannot be dragged does not light up.
        self.gizmo.hover(Some(at).filter(|_| self.editable));
        self.refuses = !self.editable && self.gizmo.handle_at(at).is_some();
        InputFlow::ToParent
    }

    fn mouse_leave(&mut self, _framework: &mut ControlFramework) {
        self.gizmo.hover(None);
        self.refuses = false;
    }

    fn mouse_down(&mut self, button: Button, mouse: Mouse, framework: &mut ControlFramework) -> InputFlow {
        let at = mouse.at - self.corner;
        let answer = match button {
            Button::Left if self.gizmo.is_dragging() => self.gizmo.confirm(),
            // With Alt the mouse orbits the camera, whatever is under it.
            Button::Left if !mouse.modifiers.alt => {
                let handle = self.gizmo.handle_at(at);
                if handle.is_some() && !self.editable {
                    self.refused = true;
                    return InputFlow::Stop;
                }
                // The ball is large, and the press may be meant for a bone that it covers.
                let ball = handle == Some(Handle::Center) && self.gizmo.tool == Tool::Rotate;
                let slack = if ball { THRESHOLD } else { STEADY };
                let begins = handle.is_some() && self.gizmo.begin(handle, at);
                if begins {
                    self.machine.press_within(mouse.at, HandlePress { mouse, waits: ball }, slack);
                    GizmoAnswer::Changed
                } else {
                    GizmoAnswer::Ignored
                }
            }
            Button::Right => self.gizmo.cancel(),
            Button::Left | Button::Middle => GizmoAnswer::Ignored,
        };
        self.note(answer, framework)
    }

    fn mouse_up(&mut self, button: Button, _mouse: Mouse, framework: &mut ControlFramework) -> InputFlow {
        if button != Button::Left || self.is_modal() {
            return InputFlow::ToParent;
        }
        let answer = match self.machine.released() {
            DragEvent::Clicked(press) => {
                self.clicked = Some(press.mouse);
                self.gizmo.cancel()
            }
            DragEvent::Dropped(_) => self.gizmo.confirm(),
            DragEvent::Nothing
            | DragEvent::Pressed
            | DragEvent::Started(_)
            | DragEvent::Moved(_)
            | DragEvent::Cancelled(_) => GizmoAnswer::Ignored,
        };
        self.note(answer, framework)
    }

    fn key_down(
        &mut self,
        key: Key,
        modifiers: Modifiers,
        _repeat: bool,
        framework: &mut ControlFramework,
    ) -> InputFlow {
        let answer = self.gizmo.key_down(key, modifiers);
        self.note(answer, framework)
    }

    /// The drag is cancelled: its release would never arrive.
    fn input_lost(&mut self, framework: &mut ControlFramework) {
        let answer = self.gizmo.cancel();
        self.note(answer, framework);
    }
}
