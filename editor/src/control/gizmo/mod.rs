//! Gizmos: handles at the selected bones that move, rotate and scale them.
//!
//! Everything here is geometry and state: no window, no device. The owner sets the selection ([`Gizmo::select`]) and the view
//! ([`Gizmo::look`]), passes on pointer and keys, and reads the new poses ([`Gizmo::drag`]) and what to draw
//! ([`GizmoShape`]).
//!
//! A drag computes every pose from the one before it and one delta ([`GizmoDelta`]), so errors do not accumulate: cancelling
//! restores the old poses bit for bit, and so does moving the pointer back, up to rounding.
//!
//! During a drag, X, Y and Z lock to an axis, with Shift to the plane across it; the same key again changes between local and
//! world axes, and a third time unlocks. Digits type a number. Shift is precise, Ctrl snaps. Enter confirms, Escape cancels.

mod control;
mod delta;
mod drag;
mod measure;
mod typed;

pub use control::GizmoControl;
pub use drag::{BoneDrag, GizmoDrag};

use super::key::{Key, Modifiers};
use drag::ActiveDrag;
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use dragonfly_picture::gizmo::{
    GizmoDelta, GizmoLayout, GizmoPlacement, GizmoSettings, GizmoShape, GizmoSpace, GizmoTarget, GizmoView,
    Handle, PosedSkeleton, Tool,
};
use glam::{Mat4, Vec2};
use typed::TypedNumbers;

/// The effect of a key or a button on the gizmo.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GizmoAnswer {
    /// The key or button has no meaning for the gizmo.
    Ignored,
    /// The drag continues, with another result.
    Changed,
    /// The drag has ended; [`Gizmo::drag`] returns its result until the next one.
    Confirmed,
    /// The drag has ended; [`Gizmo::drag`] returns the old poses, bit for bit.
    Cancelled,
}

/// The state of a drag, for the text next to the pointer. Lengths and angles are along the axes of [`Self::space`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoReadout<'a> {
    /// Tool of the drag.
    pub tool: Tool,
    /// Handle that the drag is locked to.
    pub handle: Handle,
    /// Space whose axes the drag follows.
    pub space: GizmoSpace,
    /// Present amount.
    pub delta: GizmoDelta,
    /// Typed text of each number; empty if nothing is typed.
    pub typed: [&'a str; 3],
    /// How many numbers can be typed.
    pub fields: usize,
    /// Index of the number that is typed into.
    pub field: usize,
    /// Whether the text in that field is a number. If not, the last valid number is used.
    pub is_number: bool,
}

/// The gizmo of the selected bones.
#[derive(Clone, Debug, Default)]
pub struct Gizmo {
    /// Settings; a drag keeps those that it began with.
    pub settings: GizmoSettings,
    /// Present tool.
    pub tool: Tool,
    view: Option<GizmoView>,
    placement: GizmoPlacement,
    hovered: Option<Handle>,
    going: Option<ActiveDrag>,
    /// The dragged bones as they were before the drag.
    before: Vec<GizmoTarget>,
    made: GizmoDrag,
    delta: Option<GizmoDelta>,
    typed: TypedNumbers,
}

impl Gizmo {
    /// Returns a gizmo with this tool, without a selection and a view.
    pub fn new(tool: Tool) -> Self {
        Self { tool, ..Self::default() }
    }

    /// Sets the selection and its pose: `poses` relative to the parents, `to_root` of all bones. `active` is the bone
    /// whose axes count; without it the last selected one. A drag in progress keeps what it began with. Allocates only
    /// when the skeleton grows.
    pub fn select(
        &mut self,
        skeleton: &Skeleton,
        poses: &[Transform],
        to_root: &[Mat4],
        selected: &[BoneIndex],
        active: Option<BoneIndex>,
    ) {
        let pose = PosedSkeleton { skeleton, poses, to_root };
        self.placement.select(&self.settings, self.tool, &pose, selected, active);
    }

    /// Sets the view.
    pub fn look(&mut self, view: GizmoView) {
        self.view = Some(view);
        if let Some(drag) = &mut self.going {
            drag.look(view);
        }
    }

    /// Returns the pivot, scene space; `None` without a selection.
    pub fn pivot(&self) -> Option<glam::DVec3> {
        self.placement.anchor().map(|anchor| anchor.pivot)
    }

    /// Returns the handle at a position, points from the top left of the viewport; none during a drag.
    pub fn handle_at(&self, pointer: Vec2) -> Option<Handle> {
        let free = pointer.is_finite() && self.going.is_none();
        free.then(|| self.layout()?.hit(self.tool, pointer.as_dvec2())).flatten()
    }

    /// Notes and returns the handle under the pointer.
    pub fn hover(&mut self, pointer: Option<Vec2>) -> Option<Handle> {
        self.hovered = pointer.and_then(|pointer| self.handle_at(pointer));
        self.hovered
    }

    /// Returns the handle that was under the pointer last.
    pub fn hovered(&self) -> Option<Handle> {
        self.hovered
    }

    /// Begins a drag of `handle`, or, without one, a drag in the view plane as by a key. Returns false without a
    /// selection, or if it is behind the camera.
    pub fn begin(&mut self, handle: Option<Handle>, pointer: Vec2) -> bool {
        let (Some(view), Some(anchor)) = (self.view, self.placement.anchor()) else { return false };
        if !pointer.is_finite() || self.going.is_some() {
            return false;
        }
        self.going = ActiveDrag::begin(self.tool, handle, self.settings, anchor, view, pointer.as_dvec2());
        if self.going.is_none() {
            return false;
        }
        self.hovered = None;
        self.before.clear();
        self.before.extend_from_slice(self.placement.targets());
        self.typed.clear();
        self.change();
        true
    }

    /// Sets pointer and modifier keys. `Ignored` without a drag, and for a position that is on no screen.
    pub fn pointer(&mut self, pointer: Vec2, modifiers: Modifiers) -> GizmoAnswer {
        let sound = pointer.is_finite() && pointer.abs().max_element() < 1e5;
        let Some(drag) = self.going.as_mut().filter(|_| sound) else { return GizmoAnswer::Ignored };
        drag.pointer(pointer.as_dvec2(), modifiers);
        self.change();
        GizmoAnswer::Changed
    }

    /// Handles a key during a drag.
    pub fn key_down(&mut self, key: Key, modifiers: Modifiers) -> GizmoAnswer {
        let Some(drag) = &mut self.going else { return GizmoAnswer::Ignored };
        match key {
            Key::Enter => self.confirm(),
            Key::Escape => self.cancel(),
            key if drag.key(key, modifiers, &mut self.typed) => {
                self.change();
                GizmoAnswer::Changed
            }
            _ => GizmoAnswer::Ignored,
        }
    }

    /// Confirms the drag: the left button went up, or Enter.
    pub fn confirm(&mut self) -> GizmoAnswer {
        if self.going.take().is_some() { GizmoAnswer::Confirmed } else { GizmoAnswer::Ignored }
    }

    /// Cancels the drag: Escape, the right button, or lost input.
    pub fn cancel(&mut self) -> GizmoAnswer {
        if self.going.take().is_none() {
            return GizmoAnswer::Ignored;
        }
        let before = |target: &GizmoTarget| BoneDrag { bone: target.bone, to_parent: target.to_parent };
        self.made.bones.clear();
        self.made.bones.extend(self.before.iter().map(before));
        GizmoAnswer::Cancelled
    }

    /// Whether a drag is in progress.
    pub fn is_dragging(&self) -> bool {
        self.going.is_some()
    }

    /// Returns the result of the drag so far, or of the last one.
    pub fn drag(&self) -> &GizmoDrag {
        &self.made
    }

    /// Returns the bones of [`Self::drag`] as they were before it.
    pub fn before(&self) -> &[GizmoTarget] {
        &self.before
    }

    /// Whether the present or the last drag changes nothing.
    pub fn is_identity(&self) -> bool {
        self.delta.is_none_or(|delta| delta.is_identity())
    }

    /// Returns what to show next to the pointer during a drag.
    pub fn readout(&self) -> Option<GizmoReadout<'_>> {
        let drag = self.going.as_ref()?;
        let field = self.typed.current();
        Some(GizmoReadout {
            tool: drag.tool,
            handle: drag.handle(),
            space: drag.space(),
            delta: self.delta?,
            typed: [0, 1, 2].map(|field| self.typed.text(field).0),
            fields: drag.fields(),
            field,
            is_number: self.typed.text(field).0.is_empty() || self.typed.text(field).1,
        })
    }

    /// Writes what to draw into `shape`, in scene space; nothing if nothing is visible. Allocates only as `shape`
    /// grows.
    pub fn present(&self, shape: &mut GizmoShape) {
        shape.clear();
        self.present_into(shape);
    }

    /// Does the same as [`Self::present`], but appends to what `shape` already contains.
    pub fn present_into(&self, shape: &mut GizmoShape) {
        match &self.going {
            Some(drag) => {
                let Some(mut layout) = drag.layout() else { return };
                if let Some(GizmoDelta::Move(by)) = self.delta {
                    // The gizmo moves with the bones.
                    layout.pivot += layout.axes.axes * by;
                }
                shape.dragging(&layout, drag.tool, drag.handle(), self.delta, drag.start());
            }
            None => {
                let Some(layout) = self.layout() else { return };
                shape.waiting(&layout, self.tool, self.hovered);
            }
        }
    }

    fn layout(&self) -> Option<GizmoLayout> {
        self.placement.layout(self.settings.space, self.view?)
    }

    fn change(&mut self) {
        let Some(drag) = &mut self.going else { return };
        let delta = drag.delta(&self.typed);
        drag.apply(&self.before, &delta, &mut self.made.bones);
        self.delta = Some(delta);
    }
}
