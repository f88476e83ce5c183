//! The scene in the viewport: what is under the pointer, its things at the time shown, and a drag of them.

use super::{SceneBase, ThingPoses};
use crate::control::path_point::PathPoint;
use dragonfly_anim::stage::splice::TextSplices;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{StagePlan, StageScene};
use dragonfly_document::SceneView;
use dragonfly_document::history::Gesture;
use egui::Pos2;
use glam::DVec3;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Distance between two clicks at the same place, points.
const SAME: f32 = 4.0;

/// Time without a movement after which the next turn of the wheel is another step.
const PAUSE: Duration = Duration::from_millis(400);

/// Number of places of a point that texts tell apart, per meter.
const PER_METER: f64 = 1e4;

/// The state of the viewport of a scene; it contains nothing of the document.
#[derive(Debug, Default)]
pub struct SceneViewport {
    /// Whether the scene was framed with all its models.
    is_framed: bool,
    /// The thing under the pointer.
    hovered: Option<Arc<str>>,
    /// Place and result of the last click.
    last: Option<(Pos2, Arc<str>)>,
    shown: Option<ShownThings>,
    /// The script at the start of the drag in progress, its things, and what the drag has changed last.
    base: Option<SceneBase>,
    base_shown: Option<ShownThings>,
    written: Option<TextSplices>,
    /// The scene at the start of the drag of a point of a line.
    line_base: Option<Arc<SceneView>>,
    /// The place of the dragged point in the text that was sent last, and whether it was moved alone.
    point: Option<(DVec3, bool)>,
    /// The heights at which things that are moved are on the ground, at the start of the drag.
    heights: Option<Arc<BTreeMap<usize, f32>>>,
    /// The gesture that moves a camera, which is one step.
    camera_drag: Option<Gesture>,
    /// When the wheel or a panel moved the camera last; `None` while the viewport is dragged.
    turned: Option<Instant>,
    /// The camera whose focus the next click sets.
    focused: Option<Box<str>>,
    /// The bone or thing on which the line in progress began, by its name in scripts.
    pressed_on: Option<String>,
    /// The places at which the gizmo is.
    poses: ThingPoses,
}

/// The things of a plan at one time.
#[derive(Debug)]
struct ShownThings {
    plan: Arc<StagePlan>,
    time: StageTime,
    scene: StageScene,
}

impl SceneViewport {
    /// Returns the places at which the gizmo was, to be set and kept again.
    pub(in crate::panels) fn take_poses(&mut self) -> ThingPoses {
        std::mem::take(&mut self.poses)
    }

    /// Keeps the memory of the places at which the gizmo is.
    pub(in crate::panels) fn keep_poses(&mut self, poses: ThingPoses) {
        self.poses = poses;
    }

    /// Returns the thing under the pointer.
    pub fn hovered(&self) -> Option<&Arc<str>> {
        self.hovered.as_ref()
    }

    /// Sets the thing under the pointer. Returns whether it changed.
    pub(in crate::panels) fn hover(&mut self, thing: Option<Arc<str>>) -> bool {
        std::mem::replace(&mut self.hovered, thing.clone()) != thing
    }

    /// Returns whether to frame the scene now, and notes that it was: once, when all its models were read.
    pub(in crate::panels) fn frames_now(&mut self, is_complete: bool) -> bool {
        let frames = is_complete && !self.is_framed;
        self.is_framed |= frames;
        frames
    }

    /// Returns whether the scene was framed with all its models.
    pub(in crate::panels) fn is_framed(&self) -> bool {
        self.is_framed
    }

    /// Notes that the scene is seen as it was before.
    pub(in crate::panels) fn set_framed(&mut self) {
        self.is_framed = true;
    }

    /// Returns the thing that a click at `at` selects, of the things there, nearest first. Another click at the same place selects the
    /// next one in that order.
    pub(in crate::panels) fn clicked(&mut self, at: Pos2, things: &[Arc<str>]) -> Option<Arc<str>> {
        let before = self.last.as_ref().filter(|(place, _)| place.distance(at) <= SAME);
        let behind = before.and_then(|(_, last)| {
            let position = things.iter().position(|thing| thing == last)?;
            things.get((position + 1) % things.len())
        });
        let thing = behind.or(things.first()).cloned();
        let place = before.map_or(at, |(place, _)| *place);
        self.last = thing.clone().map(|thing| (place, thing));
        thing
    }

    /// Forgets the last click: the selection has changed in another way.
    pub(in crate::panels) fn forget_click(&mut self) {
        self.last = None;
    }

    /// Returns the things of `plan` at `time`.
    pub(in crate::panels) fn things_at(&mut self, plan: &Arc<StagePlan>, time: StageTime) -> &StageScene {
        things_at(&mut self.shown, plan, time)
    }

    /// Returns the things of the plan with which the drag in progress began.
    pub(in crate::panels) fn base_things(&mut self, plan: &Arc<StagePlan>, time: StageTime) -> &StageScene {
        things_at(&mut self.base_shown, plan, time)
    }

    /// Returns whether the drag in progress has not made these changes last, and notes them.
    pub(in crate::panels) fn is_new(&mut self, splices: &TextSplices) -> bool {
        let is_new = self.written.as_ref() != Some(splices);
        if is_new {
            self.written = Some(splices.clone());
        }
        is_new
    }

    /// Returns whether the drag in progress has not put a point there last in the same way, as far as texts tell places apart, and notes the place.
    pub(in crate::panels) fn is_new_place(&mut self, point: &PathPoint) -> bool {
        let place = ((point.place * PER_METER).round(), point.alone);
        self.point.replace(place) != Some(place)
    }

    /// Returns the camera whose focus the next click sets.
    pub fn focused_camera(&self) -> Option<&str> {
        self.focused.as_deref()
    }

    /// Lets the next click set the focus of a camera, or select as usual.
    pub(in crate::panels) fn focus(&mut self, camera: Option<Box<str>>) {
        self.focused = camera;
    }

    /// Returns the bone or thing on which the line in progress began, by its name in scripts.
    pub(in crate::panels) fn pressed_on(&self) -> Option<&str> {
        self.pressed_on.as_deref()
    }

    /// Notes the bone or thing on which a line begins.
    pub(in crate::panels) fn press_on(&mut self, name: Option<String>) {
        self.pressed_on = name;
    }

    /// Returns the id of the camera of the shot at the time computed last.
    pub fn shown_camera(&self) -> Option<&str> {
        let shown = self.shown.as_ref()?;
        // Positions are those in the cast of this plan, and a newer one may have another.
        let camera = shown.plan.things().get(shown.scene.camera?.thing)?;
        Some(&camera.id)
    }

    /// Returns the script at the start of the drag in progress.
    pub(in crate::panels) fn base(&self) -> Option<&SceneBase> {
        self.base.as_ref()
    }

    /// Sets the script at the start of a drag; `None` at its end.
    pub(in crate::panels) fn set_base(&mut self, base: Option<SceneBase>) {
        (self.base, self.base_shown, self.written) = (base, None, None);
    }

    /// Returns the scene at the start of the drag of a point of a line.
    pub(in crate::panels) fn line_base(&self) -> Option<&Arc<SceneView>> {
        self.line_base.as_ref()
    }

    /// Sets the scene at the start of the drag of a point of a line.
    pub(in crate::panels) fn set_line_base(&mut self, scene: Arc<SceneView>) {
        self.line_base = Some(scene);
    }

    /// Returns the heights at which things are on the ground, meters, as they were at the start of the drag in progress.
    pub(in crate::panels) fn heights(&self) -> Option<&Arc<BTreeMap<usize, f32>>> {
        self.heights.as_ref()
    }

    /// Sets the heights at which things are on the ground.
    pub(in crate::panels) fn set_heights(&mut self, heights: Arc<BTreeMap<usize, f32>>) {
        self.heights = Some(heights);
    }

    /// Forgets everything of the drag in progress.
    pub(in crate::panels) fn end_drag(&mut self) {
        self.set_base(None);
        (self.line_base, self.heights, self.point) = (None, None, None);
    }

    /// Returns the gesture that moves a camera.
    pub(in crate::panels) fn camera_drag(&self) -> Option<Gesture> {
        self.camera_drag
    }

    /// Begins or continues the gesture that moves a camera. `turned` is the time of a movement by the wheel or a panel, whose end no one
    /// reports; `None` for a drag of the viewport.
    pub(in crate::panels) fn move_camera(
        &mut self,
        gesture: Gesture,
        base: SceneBase,
        turned: Option<Instant>,
    ) {
        if self.camera_drag.replace(gesture) != Some(gesture) {
            self.set_base(Some(base));
        }
        self.turned = turned;
    }

    /// Ends the gesture that moves a camera.
    pub(in crate::panels) fn end_camera(&mut self) {
        if self.camera_drag.take().is_some() {
            self.turned = None;
            self.set_base(None);
        }
    }

    /// Returns whether a gesture is a camera moved by the wheel or a panel: it has no end that could be cancelled.
    pub fn is_turning(&self, gesture: Option<Gesture>) -> bool {
        self.turned.is_some() && gesture.is_some() && self.camera_drag == gesture
    }

    /// Returns the time until a camera that the wheel or a panel moved counts as released; `None` where there is none.
    pub(in crate::panels) fn turn_left(&self, now: Instant) -> Option<Duration> {
        Some(PAUSE.saturating_sub(now.saturating_duration_since(self.turned?)))
    }

    /// Forgets everything: another document is shown.
    pub(in crate::panels) fn reset(&mut self) {
        *self = Self::default();
    }
}

/// Returns the things of `plan` at `time`, which are computed where `shown` has others.
fn things_at<'a>(
    shown: &'a mut Option<ShownThings>,
    plan: &Arc<StagePlan>,
    time: StageTime,
) -> &'a StageScene {
    let is_same = |shown: &ShownThings| Arc::ptr_eq(&shown.plan, plan);
    let mut now = match shown.take().filter(is_same) {
        Some(now) if now.time == time => return &shown.insert(now).scene,
        Some(now) => now,
        None => ShownThings { plan: Arc::clone(plan), time, scene: plan.new_scene() },
    };
    plan.scene_at(time, &mut now.scene);
    now.time = time;
    &shown.insert(now).scene
}
