//! The scene in the viewport: what is under the pointer, its things at the time shown, and a drag of them.

use super::SceneBase;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_anim::stage::{StagePlan, StageScene};
use dragonfly_document::SceneView;
use dragonfly_document::history::Gesture;
use egui::Pos2;
use std::sync::Arc;

/// Distance between two clicks at the same place, points.
const SAME: f32 = 4.0;

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
    /// The script at the start of the drag in progress.
    base: Option<SceneBase>,
    /// The scene at the start of the drag of a point of a line.
    line_base: Option<Arc<SceneView>>,
    /// The heights at which things are on the ground, at the start of a drag.
    heights: Option<Vec<Option<f32>>>,
    /// The gesture that moves a camera, which is one step.
    camera_drag: Option<Gesture>,
}

/// The things of a plan at one time.
#[derive(Debug)]
struct ShownThings {
    plan: Arc<StagePlan>,
    time: StageTime,
    scene: StageScene,
}

impl SceneViewport {
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
        let is_same = |shown: &ShownThings| Arc::ptr_eq(&shown.plan, plan);
        let mut shown = match self.shown.take().filter(is_same) {
            Some(shown) if shown.time == time => return &self.shown.insert(shown).scene,
            Some(shown) => shown,
            None => ShownThings { plan: Arc::clone(plan), time, scene: plan.new_scene() },
        };
        plan.scene_at(time, &mut shown.scene);
        shown.time = time;
        &self.shown.insert(shown).scene
    }

    /// Returns the camera of the shot at the time computed last, as a position in the cast.
    pub fn shown_camera(&self) -> Option<usize> {
        self.shown.as_ref()?.scene.camera.map(|camera| camera.thing)
    }

    /// Returns the script at the start of the drag in progress.
    pub(in crate::panels) fn base(&self) -> Option<&SceneBase> {
        self.base.as_ref()
    }

    /// Sets the script at the start of a drag; `None` at its end.
    pub(in crate::panels) fn set_base(&mut self, base: Option<SceneBase>) {
        self.base = base;
    }

    /// Returns the scene at the start of the drag of a point of a line.
    pub(in crate::panels) fn line_base(&self) -> Option<&Arc<SceneView>> {
        self.line_base.as_ref()
    }

    /// Sets the scene at the start of the drag of a point of a line; `None` at its end.
    pub(in crate::panels) fn set_line_base(&mut self, scene: Option<Arc<SceneView>>) {
        self.line_base = scene;
    }

    /// Returns the heights at which things are on the ground, meters, as they were at the start of the drag in progress.
    pub(in crate::panels) fn heights(&self) -> Option<&[Option<f32>]> {
        self.heights.as_deref()
    }

    /// Sets the heights at which things are on the ground; `None` at the end of a drag.
    pub(in crate::panels) fn set_heights(&mut self, heights: Option<Vec<Option<f32>>>) {
        self.heights = heights;
    }

    /// Returns the gesture that moves a camera.
    pub(in crate::panels) fn camera_drag(&self) -> Option<Gesture> {
        self.camera_drag
    }

    pub(in crate::panels) fn set_camera_drag(&mut self, gesture: Option<Gesture>) {
        self.camera_drag = gesture;
    }

    /// Forgets everything: another document is shown.
    pub(in crate::panels) fn reset(&mut self) {
        *self = Self::default();
    }
}
