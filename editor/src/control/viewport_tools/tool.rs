//! The interface of a tool: what it is given, and what it asks for.

use crate::control::base::{BaseControl, Mouse};
use crate::control::line::LineAnswer;
use crate::control::path_point::{PathKey, PathPoint};
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::edit::Edit;
use dragonfly_picture::gizmo::{GizmoSettings, GizmoView, PosedSkeleton, Tool};
use glam::Vec2;

/// The pose, the selection and the settings that tools work on.
pub struct ToolScene<'a> {
    /// The skeleton in the pose that is shown; without poses where `bones` is empty.
    pub pose: PosedSkeleton<'a>,
    /// The bones that a drag moves; none while the user only selects.
    pub bones: &'a [BoneIndex],
    /// Index of the take that is shown; `None` for the rest pose.
    pub take: Option<usize>,
    /// Time that is shown, seconds.
    pub time: f32,
    /// Whether these bones can be posed: a take is shown, and none of them is locked.
    pub editable: bool,
    /// The transformation that the user chose for the gizmo.
    pub tool: Option<Tool>,
    /// The axes, pivot and snapping that the user chose.
    pub settings: GizmoSettings,
}

/// A request of a tool after an input. All changes that a tool requests during one drag become one step of the history.
#[derive(Clone, Debug, PartialEq)]
pub enum ToolOutcome {
    /// Select the bone under the pointer, after a click on a handle that covers it.
    Click(Mouse),
    /// Report that nothing can be changed, after a press on a handle.
    Refused,
    /// Apply the poses of the gizmo.
    Poses,
    /// Move the joint of the active bone to this position at this key.
    MoveKey(PathKey),
    /// Select a point of a path or a line of the scene.
    SelectPoint(PathPoint),
    /// Move a point of a path or a line of the scene to this position.
    MovePoint(PathPoint),
    /// Apply an edit. It replaces the edit that the same drag asked for before.
    Edit(Edit),
    /// Change the lines of the scene.
    Line(LineAnswer),
    /// End the drag.
    Done,
    /// End the drag and undo what it changed.
    Cancelled,
}

/// A tool in the viewport that a press can begin to drag.
pub trait ViewportTool: BaseControl {
    /// Sets the top left of the viewport, points from that of the window.
    fn place(&mut self, corner: Vec2);

    /// Sets the view.
    fn look(&mut self, view: GizmoView);

    /// Sets what the tool works on: called after a change of the pose, the selection or the settings, but not during a drag.
    fn show(&mut self, scene: &ToolScene<'_>) {
        let _ = scene;
    }

    /// Returns the next request since the last call. The owner asks after each input until there is none.
    fn take_outcome(&mut self) -> Option<ToolOutcome>;

    /// Whether a drag of the tool changes the document.
    fn is_dragging(&self) -> bool;

    /// Whether the tool has mouse and keyboard although no button is held.
    fn is_modal(&self) -> bool {
        false
    }
}
