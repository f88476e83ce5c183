//! A drag of the gizmo: its axis lock, its measurement, snapping, and typed numbers.

use super::delta::apply;
use super::measure::Measure;
use super::typed::TypedNumbers;
use crate::control::expression::Quantity;
use crate::control::key::{Key, Modifiers};
use dragonfly_anim::data::{BoneIndex, Transform};
use dragonfly_picture::gizmo::{
    GizmoAnchor, GizmoAxes, GizmoAxis, GizmoDelta, GizmoLayout, GizmoSettings, GizmoSpace, GizmoTarget,
    GizmoView, Handle, Pivot, Tool,
};
use glam::{DVec2, DVec3};

/// A bone and its new pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoneDrag {
    /// The bone.
    pub bone: BoneIndex,
    /// New pose relative to its parent.
    pub to_parent: Transform,
}

/// The result of a drag so far: the new pose of each dragged bone, in the order of the skeleton.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GizmoDrag {
    /// The bones, each with its whole new pose.
    pub bones: Vec<BoneDrag>,
}

/// An axis lock: the axis or the plane across it, and how often its key was pressed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct AxisLock {
    handle: Handle,
    presses: u8,
}

/// A drag in progress.
#[derive(Clone, Debug)]
pub(super) struct ActiveDrag {
    pub(super) tool: Tool,
    /// Handle that was pressed.
    grabbed: Handle,
    /// Whether the drag began with a press on a handle; otherwise a key began it.
    by_handle: bool,
    lock: Option<AxisLock>,
    settings: GizmoSettings,
    placement: GizmoAnchor,
    /// The current view, and the view at the start of the drag, which determines the axes.
    view: GizmoView,
    first: GizmoView,
    start: DVec2,
    pointer: DVec2,
    modifiers: Modifiers,
    measure: Measure,
    /// The amount at the last change of speed or view, and the raw measurement at that moment.
    settled: DVec3,
    anchor: DVec3,
}

impl ActiveDrag {
    /// Begins a drag; `None` if the layout of the gizmo cannot be computed, for example because the camera looks
    /// away from it.
    pub(super) fn begin(
        tool: Tool,
        handle: Option<Handle>,
        settings: GizmoSettings,
        placement: GizmoAnchor,
        view: GizmoView,
        pointer: DVec2,
    ) -> Option<Self> {
        let by_key = if tool == Tool::Rotate { Handle::Ring } else { Handle::Center };
        let grabbed = handle.unwrap_or(by_key);
        let layout = GizmoLayout::new(view, placement.pivot, placement.axes(settings.space, &view))?;
        let measure = Measure::new(tool, grabbed, layout, pointer, handle.is_some());
        Some(Self {
            tool,
            grabbed,
            by_handle: handle.is_some(),
            lock: None,
            settings,
            placement,
            view,
            first: view,
            start: pointer,
            pointer,
            modifiers: Modifiers::default(),
            measure,
            settled: DVec3::ZERO,
            anchor: DVec3::ZERO,
        })
    }

    /// Returns the handle that the drag is locked to now.
    pub(super) fn handle(&self) -> Handle {
        self.lock.map_or(self.grabbed, |lock| lock.handle)
    }

    /// Returns the space whose axes the drag follows now.
    pub(super) fn space(&self) -> GizmoSpace {
        match self.lock {
            Some(AxisLock { presses: 2, .. }) => self.settings.space.other(),
            _ => self.settings.space,
        }
    }

    /// Returns the layout of the gizmo where the drag began.
    pub(super) fn layout(&self) -> Option<GizmoLayout> {
        GizmoLayout::new(self.view, self.placement.pivot, self.placement.axes(self.space(), &self.first))
    }

    pub(super) fn start(&self) -> DVec2 {
        self.start
    }

    /// Sets pointer and modifier keys. Shift slows the drag down from where it was pressed, without a jump.
    pub(super) fn pointer(&mut self, pointer: DVec2, modifiers: Modifiers) {
        if modifiers.shift != self.modifiers.shift {
            self.settle();
        }
        self.modifiers = modifiers;
        self.pointer = pointer;
    }

    /// Follows the camera and the size of the window. The drag continues from its present amount.
    pub(super) fn look(&mut self, view: GizmoView) {
        if view == self.view {
            return;
        }
        self.settle();
        self.view = view;
        if let Some(layout) = self.layout() {
            self.measure = Measure::new(
                self.tool,
                self.handle(),
                layout,
                self.pointer,
                self.by_handle && self.lock.is_none(),
            );
            self.anchor = DVec3::ZERO;
        }
    }

    /// Handles a key: an axis, or a character of a number. Returns false for others.
    pub(super) fn key(&mut self, key: Key, modifiers: Modifiers, typed: &mut TypedNumbers) -> bool {
        let axis = match key {
            Key::Letter('x') => Some(GizmoAxis::X),
            Key::Letter('y') => Some(GizmoAxis::Y),
            Key::Letter('z') => Some(GizmoAxis::Z),
            _ => None,
        };
        match axis {
            Some(axis) => {
                self.press(axis, modifiers.shift);
                typed.limit(self.fields());
                true
            }
            None => typed.key(key, self.fields(), self.quantity()),
        }
    }

    /// Locks to an axis or to the plane across it; the second press changes the space, the third one unlocks.
    fn press(&mut self, axis: GizmoAxis, plane: bool) {
        let plane = plane && self.tool != Tool::Rotate;
        let handle = if plane { Handle::Plane(axis) } else { Handle::Axis(axis) };
        self.lock = match self.lock {
            Some(lock) if lock.handle == handle => {
                (lock.presses < 2).then_some(AxisLock { handle, presses: lock.presses + 1 })
            }
            _ => Some(AxisLock { handle, presses: 1 }),
        };
        // Measured from where the drag began, as if it had been locked from the start.
        if let Some(layout) = self.layout() {
            let grabbed = self.by_handle && self.lock.is_none();
            self.measure = Measure::new(self.tool, self.handle(), layout, self.start, grabbed);
            (self.settled, self.anchor) = (DVec3::ZERO, DVec3::ZERO);
        }
    }

    fn pace(&self) -> f64 {
        if self.modifiers.shift { self.settings.precise } else { 1.0 }
    }

    fn settle(&mut self) {
        let raw = self.measure.at(self.pointer);
        self.settled += (raw - self.anchor) * self.pace();
        self.anchor = raw;
    }

    /// Returns how many numbers can be typed.
    pub(super) fn fields(&self) -> usize {
        match (self.tool, self.handle()) {
            (Tool::Move, Handle::Center | Handle::Ring) => 3,
            (Tool::Move, Handle::Plane(_)) | (Tool::Rotate, Handle::Center) => 2,
            _ => 1,
        }
    }

    pub(super) fn quantity(&self) -> Quantity {
        match self.tool {
            Tool::Move => Quantity::Length,
            Tool::Rotate => Quantity::Angle,
            Tool::Scale => Quantity::Number,
        }
    }

    /// Returns the present delta.
    pub(super) fn delta(&mut self, typed: &TypedNumbers) -> GizmoDelta {
        let raw = self.measure.at(self.pointer);
        let mut amount = self.settled + (raw - self.anchor) * self.pace();
        if self.modifiers.ctrl {
            let step = self.settings.step(self.tool) * self.pace();
            let snapped = (amount / step).round() * step;
            amount = if snapped.is_finite() { snapped } else { amount };
        }
        let count = self.fields();
        if typed.is_used(count) {
            let values = typed.values(count);
            amount = match self.tool {
                Tool::Move => self.bound(DVec3::from_array(values.map(|value| value.unwrap_or(0.0)))),
                Tool::Rotate => DVec3::from_array(values.map(|value| value.unwrap_or(0.0).to_radians())),
                Tool::Scale => DVec3::X * (values[0].unwrap_or(1.0) - 1.0),
            };
        } else if self.tool == Tool::Move {
            amount = self.along(amount);
        }
        self.delta_of(amount)
    }

    /// Assigns typed numbers, in their order, to the axes that the drag is locked to.
    fn bound(&self, typed: DVec3) -> DVec3 {
        match self.handle() {
            Handle::Axis(axis) => axis.unit() * typed.x,
            Handle::Plane(normal) => {
                // The axes in alphabetical order, in which the fields are shown.
                let mut axes = normal.others();
                axes.sort_by_key(|axis| *axis as usize);
                axes[0].unit() * typed.x + axes[1].unit() * typed.y
            }
            Handle::Center | Handle::Ring => typed,
        }
    }

    /// Assigns a measured distance to the axes. A distance along a single axis is measured as x.
    fn along(&self, amount: DVec3) -> DVec3 {
        match self.handle() {
            Handle::Axis(axis) => axis.unit() * amount.x,
            Handle::Plane(normal) => amount * (DVec3::ONE - normal.unit()),
            Handle::Center | Handle::Ring => amount,
        }
    }

    fn delta_of(&self, amount: DVec3) -> GizmoDelta {
        match self.tool {
            Tool::Move => GizmoDelta::Move(amount),
            Tool::Rotate => self.turn(amount),
            Tool::Scale => {
                let factor = 1.0 + amount.x;
                GizmoDelta::Scale(match self.handle() {
                    Handle::Axis(axis) => DVec3::ONE + axis.unit() * amount.x,
                    Handle::Plane(normal) => {
                        DVec3::splat(factor) * (DVec3::ONE - normal.unit()) + normal.unit()
                    }
                    Handle::Center | Handle::Ring => DVec3::splat(factor),
                })
            }
        }
    }

    fn turn(&self, amount: DVec3) -> GizmoDelta {
        let frame = self.placement.axes(self.space(), &self.first);
        // Seen from the world, a rotation in mirrored axes has the opposite direction.
        let inside = |axis: DVec3| frame.axes.transpose() * axis * frame.sign;
        match self.handle() {
            Handle::Axis(axis) | Handle::Plane(axis) => {
                GizmoDelta::Rotate { axis: axis.unit(), angle: amount.x }
            }
            Handle::Ring => GizmoDelta::Rotate { axis: inside(self.first.back), angle: amount.x },
            Handle::Center => {
                let about = self.first.up * amount.x + self.first.right * amount.y;
                let angle = about.length();
                let axis = inside(about / angle);
                let axis = if axis.is_finite() { axis } else { DVec3::Y };
                GizmoDelta::Rotate { axis, angle }
            }
        }
    }

    /// Writes the new pose of every target.
    pub(super) fn apply(&self, targets: &[GizmoTarget], delta: &GizmoDelta, out: &mut Vec<BoneDrag>) {
        out.clear();
        let common = self.placement.axes(self.space(), &self.first);
        for target in targets {
            let (frame, pivot) = match self.settings.pivot {
                Pivot::Individual => (self.own_frame(target, common), None),
                Pivot::Median | Pivot::Active => (common, Some(self.placement.pivot)),
            };
            let to_parent = apply(target, &frame, pivot, delta);
            out.push(BoneDrag { bone: target.bone, to_parent });
        }
    }

    /// Returns the axes for one bone: its own ones, except for a drag in the view plane or about the line of sight,
    /// which is the same for all.
    fn own_frame(&self, target: &GizmoTarget, common: GizmoAxes) -> GizmoAxes {
        let in_view = matches!((self.tool, self.handle()), (Tool::Move, Handle::Center))
            || (self.tool == Tool::Rotate && matches!(self.handle(), Handle::Center | Handle::Ring));
        if in_view { common } else { target.frame(self.space(), &self.first) }
    }
}
