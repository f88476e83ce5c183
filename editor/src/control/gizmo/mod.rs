//! Gizmos: handles at the selected bones that move, rotate and scale them.
//!
//! Everything here is geometry and state: no window, no device. The owner says what is selected ([`Gizmo::select`]) and from
//! where it is seen ([`Gizmo::look`]), passes on pointer and keys, and reads the new poses ([`Gizmo::drag`]) and what to draw
//! ([`GizmoShape`]).
//!
//! A drag computes every pose from the one before it and one delta ([`GizmoDelta`]), so nothing adds up: cancelling gives
//! the old poses bit for bit, and coming back with the pointer does too, but for rounding.
//!
//! While dragging: X, Y, Z bind to an axis, with Shift to the plane across it; the same again changes between own and world
//! axes; the same a third time sets free. Digits type a number. Shift is precise, Ctrl snaps. Enter confirms, Escape
//! cancels.

mod control;
mod delta;
mod drag;
mod measure;
mod typed;

pub use control::GizmoControl;
pub use drag::{BoneDrag, GizmoDrag};

use super::key::{Key, Modifiers};
use drag::Drag;
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use dragonfly_picture::gizmo::{
    GizmoDelta, GizmoLayout, GizmoPlacement, GizmoSettings, GizmoShape, GizmoSpace, GizmoTarget, GizmoView,
    Handle, PosedSkeleton, Tool,
};
use glam::{Mat4, Vec2};
use typed::Typed;

/// What became of a key or a button.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GizmoAnswer {
    /// It means nothing to the gizmo.
    Ignored,
    /// The drag goes on, changed.
    Changed,
    /// The drag is over; [`Gizmo::drag`] is what it made, until the next.
    Confirmed,
    /// The drag is over; [`Gizmo::drag`] has the poses as they were before, bit for bit.
    Cancelled,
}

/// What a drag can tell beside the pointer. Lengths and angles along the axes of [`Self::space`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoReadout<'a> {
    /// What is done.
    pub tool: Tool,
    /// How it is bound.
    pub handle: Handle,
    /// Whose axes it follows.
    pub space: GizmoSpace,
    /// How much.
    pub delta: GizmoDelta,
    /// What is typed, for each of the numbers that can be; empty where nothing is.
    pub typed: [&'a str; 3],
    /// How many numbers can be typed.
    pub fields: usize,
    /// Which of them is typed into.
    pub field: usize,
    /// Is what is typed there a number? If not, the last one that was counts.
    pub is_number: bool,
}

/// See the module.
#[derive(Clone, Debug, Default)]
pub struct Gizmo {
    /// How it works; a drag keeps what it began with.
    pub settings: GizmoSettings,
    /// What it does.
    pub tool: Tool,
    view: Option<GizmoView>,
    placement: GizmoPlacement,
    hovered: Option<Handle>,
    going: Option<Drag>,
    /// The bones of the drag as they were before it.
    before: Vec<GizmoTarget>,
    made: GizmoDrag,
    delta: Option<GizmoDelta>,
    typed: Typed,
}

impl Gizmo {
    /// One that does this, with nothing selected and not yet seen.
    pub fn new(tool: Tool) -> Self {
        Self { tool, ..Self::default() }
    }

    /// What is selected, in a pose: `poses` relative to the parents, `to_root` of all bones. `active` is the one whose axes
    /// count; without, the last selected. A drag that goes on keeps what it began with. Allocates only when the skeleton
    /// grows.
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

    /// From where it is seen.
    pub fn look(&mut self, view: GizmoView) {
        self.view = Some(view);
        if let Some(drag) = &mut self.going {
            drag.look(view);
        }
    }

    /// What it stands at, scene space; `None` where nothing is selected.
    pub fn pivot(&self) -> Option<glam::DVec3> {
        self.placement.anchor().map(|anchor| anchor.pivot)
    }

    /// The handle at a place, points from the top left of the picture; none while dragging.
    pub fn handle_at(&self, pointer: Vec2) -> Option<Handle> {
        let free = pointer.is_finite() && self.going.is_none();
        free.then(|| self.layout()?.hit(self.tool, pointer.as_dvec2())).flatten()
    }

    /// Notes and tells the handle under the pointer.
    pub fn hover(&mut self, pointer: Option<Vec2>) -> Option<Handle> {
        self.hovered = pointer.and_then(|pointer| self.handle_at(pointer));
        self.hovered
    }

    /// The handle that was under the pointer last.
    pub fn hovered(&self) -> Option<Handle> {
        self.hovered
    }

    /// Begins a drag: of `handle`, or without one as by a key, then in the plane of the picture. `false` where nothing is
    /// selected or it lies behind the eye.
    pub fn begin(&mut self, handle: Option<Handle>, pointer: Vec2) -> bool {
        let (Some(view), Some(anchor)) = (self.view, self.placement.anchor()) else { return false };
        if !pointer.is_finite() || self.going.is_some() {
            return false;
        }
        self.going = Drag::begin(self.tool, handle, self.settings, anchor, view, pointer.as_dvec2());
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

    /// The pointer moved, or the keys held besides changed. `Ignored` when nothing is dragged, or for no place of a screen.
    pub fn pointer(&mut self, pointer: Vec2, modifiers: Modifiers) -> GizmoAnswer {
        let sound = pointer.is_finite() && pointer.abs().max_element() < 1e5;
        let Some(drag) = self.going.as_mut().filter(|_| sound) else { return GizmoAnswer::Ignored };
        drag.pointer(pointer.as_dvec2(), modifiers);
        self.change();
        GizmoAnswer::Changed
    }

    /// A key went down while dragging.
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

    /// Ends the drag with what it made: the left button came up, Enter.
    pub fn confirm(&mut self) -> GizmoAnswer {
        if self.going.take().is_some() { GizmoAnswer::Confirmed } else { GizmoAnswer::Ignored }
    }

    /// Ends the drag as if it had not been: Escape, the right button, input lost.
    pub fn cancel(&mut self) -> GizmoAnswer {
        if self.going.take().is_none() {
            return GizmoAnswer::Ignored;
        }
        let before = |target: &GizmoTarget| BoneDrag { bone: target.bone, to_parent: target.to_parent };
        self.made.bones.clear();
        self.made.bones.extend(self.before.iter().map(before));
        GizmoAnswer::Cancelled
    }

    /// Is a drag going on?
    pub fn is_dragging(&self) -> bool {
        self.going.is_some()
    }

    /// What the drag has made so far, or the last one made.
    pub fn drag(&self) -> &GizmoDrag {
        &self.made
    }

    /// Bone by bone what [`Self::drag`] has, as it was before.
    pub fn before(&self) -> &[GizmoTarget] {
        &self.before
    }

    /// Does the drag that goes on, or did the last one, change nothing?
    pub fn is_identity(&self) -> bool {
        self.delta.is_none_or(|delta| delta.is_identity())
    }

    /// What to write beside the pointer while dragging.
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

    /// Writes what to draw into `shape`, in scene space; nothing where there is nothing to see. Allocates only as `shape`
    /// grows.
    pub fn present(&self, shape: &mut GizmoShape) {
        shape.clear();
        self.present_into(shape);
    }

    /// The same as [`Self::present`], behind what `shape` has already.
    pub fn present_into(&self, shape: &mut GizmoShape) {
        match &self.going {
            Some(drag) => {
                let Some(mut layout) = drag.layout() else { return };
                if let Some(GizmoDelta::Move(by)) = self.delta {
                    // It goes where the bones go.
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
