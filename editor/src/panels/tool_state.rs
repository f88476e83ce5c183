//! The viewport tools and what they hold between two inputs: the drag of the gizmo, the motion path, IK.

use super::motion_path::MotionPath;
use super::posed::PoseCache;
use super::tool_drag::ToolDrag;
use crate::control::{Area, InputEvent, ToolScene, ViewportTools};
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::View;
use dragonfly_document::edit::BonePose;
use dragonfly_document::posing::{IkMode, LONGEST_CHAIN};
use dragonfly_picture::between;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::gizmo::{GizmoSettings, PosedSkeleton, Tool};
use std::time::Instant;

/// Everything that the placement of the gizmo is computed from.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PlacedGizmo {
    pub(super) generation: u64,
    pub(super) take: Option<usize>,
    pub(super) time: f32,
    pub(super) tool: Option<Tool>,
    pub(super) settings: GizmoSettings,
    /// The bones that the gizmo moves.
    pub(super) bones: Vec<BoneIndex>,
    /// The active bone, which may be one that is not moved.
    pub(super) active: Option<BoneIndex>,
    /// Version of the flags of bones: some are shown at rest.
    pub(super) flags: u64,
    /// Whether the scope of edits has nothing to edit.
    pub(super) refused: bool,
}

/// The viewport tools, their drag, the motion path and IK.
#[derive(Debug, Default)]
pub struct ToolState {
    controls: ViewportTools,
    drag: ToolDrag,
    path: MotionPath,
    ik: IkMode,
    placement: Option<PlacedGizmo>,
    /// An empty list that the next placement reuses, to avoid an allocation.
    spare: Vec<BoneIndex>,
    /// When a drag that a key tried to begin was refused: the keys typed for it run no commands.
    refused_drag: Option<Instant>,
    /// Whether the last click hit a handle of the gizmo. Then it does not count as a click on no bone, which would
    /// deselect all.
    on_handle: bool,
}

impl ToolState {
    /// Returns tools with these IK settings and no pole.
    pub(super) fn new(on: bool, length: u32) -> Self {
        Self { ik: IkMode { on, length, pole: None }, ..Self::default() }
    }

    /// Returns the tools of the viewport.
    pub fn controls(&self) -> &ViewportTools {
        &self.controls
    }

    /// Returns the tools of the viewport, to give them an input or take an answer.
    pub(super) fn controls_mut(&mut self) -> &mut ViewportTools {
        &mut self.controls
    }

    /// Sets the rectangle of the viewport and those over it.
    pub(super) fn place(
        &mut self,
        viewport: Area,
        shields: impl Iterator<Item = Area> + Clone,
        camera: &Camera,
    ) {
        self.controls.place(viewport, shields);
        self.controls.look(camera);
    }

    /// Gives an input to the tools. Returns whether a tool took it.
    pub(super) fn input(&mut self, event: InputEvent, camera: &Camera) -> bool {
        self.controls.look(camera);
        self.controls.input(event)
    }

    /// Returns the camera after the last input.
    pub(super) fn camera(&self) -> Camera {
        self.controls.picture().camera
    }

    /// Returns the drag of the gizmo or the motion path.
    pub fn drag(&self) -> &ToolDrag {
        &self.drag
    }

    /// Returns the drag of the gizmo or the motion path, to begin or end it.
    pub(super) fn drag_mut(&mut self) -> &mut ToolDrag {
        &mut self.drag
    }

    /// Returns the poses that the drag of the gizmo makes now.
    pub(super) fn dragged_poses(&mut self) -> Vec<BonePose> {
        let gizmo = &self.controls.gizmo().gizmo;
        self.drag.poses(gizmo.tool, gizmo.drag().bones.iter().zip(gizmo.before()))
    }

    /// Cancels the drag without an answer: the model is another, or the drag was undone elsewhere.
    pub(super) fn drop_drag(&mut self) {
        self.controls.cancel();
        while self.controls.take_outcome().is_some() {}
        self.drag = ToolDrag::default();
        self.placement = None;
    }

    /// Returns an empty list for the bones of the next placement.
    pub(super) fn spare_list(&mut self) -> Vec<BoneIndex> {
        let mut list = std::mem::take(&mut self.spare);
        list.clear();
        list
    }

    /// Places the gizmo at the bones of `now`. Does nothing if nothing changed; a drag keeps its place. With `editable`
    /// the gizmo can be dragged, with `path_editable` the keys of the motion path.
    pub(super) fn sync_gizmo(
        &mut self,
        view: &View,
        posed: &mut PoseCache,
        now: PlacedGizmo,
        editable: bool,
        path_editable: bool,
    ) {
        if !self.is_placed_elsewhere(&now) {
            return self.reuse(now);
        }
        // The tool that only selects has no handles.
        let bones = if now.tool.is_some() { &now.bones[..] } else { &[] };
        let skeleton = &view.loaded.model.animation.skeleton;
        let pose = if bones.is_empty() {
            PosedSkeleton { skeleton, poses: &[], to_root: &[] }
        } else {
            let animation = posed.update(view, now.take, now.time);
            PosedSkeleton { skeleton, poses: animation.poses(), to_root: animation.to_root() }
        };
        let scene = ToolScene {
            pose,
            bones,
            take: now.take,
            time: now.time,
            editable,
            tool: now.tool,
            settings: now.settings,
        };
        self.controls.show(&scene);
        self.note_placement(now, path_editable);
    }

    /// Returns whether the gizmo has to be placed again. A drag keeps its place.
    pub(super) fn is_placed_elsewhere(&self, now: &PlacedGizmo) -> bool {
        self.placement.as_ref() != Some(now) && !self.controls.edits()
    }

    /// Takes back the memory of a placement that is not needed.
    pub(super) fn reuse(&mut self, placement: PlacedGizmo) {
        self.spare = placement.bones;
    }

    /// Places the gizmo at `now` in a pose that is no pose of the model.
    pub(super) fn place_gizmo(&mut self, pose: PosedSkeleton<'_>, now: PlacedGizmo, editable: bool) {
        let bones = if now.tool.is_some() { &now.bones[..] } else { &[] };
        let (take, time, tool, settings) = (now.take, now.time, now.tool, now.settings);
        self.controls.show(&ToolScene { pose, bones, take, time, editable, tool, settings });
        self.note_placement(now, false);
    }

    fn note_placement(&mut self, now: PlacedGizmo, path_editable: bool) {
        let pivot = self.controls.gizmo().gizmo.pivot();
        let path = self.controls.path_mut();
        path.set_editable(path_editable, pivot);
        self.spare = self.placement.replace(now).map(|placement| placement.bones).unwrap_or_default();
        self.controls.update();
    }

    /// Returns the motion path.
    pub fn path(&self) -> &MotionPath {
        &self.path
    }

    /// Returns the motion path, to update it.
    pub(super) fn path_mut(&mut self) -> &mut MotionPath {
        &mut self.path
    }

    /// Gives the keys of the motion path to the control that drags them.
    pub(super) fn show_path_keys(&mut self) {
        self.controls.path_mut().show_keys(self.path.keys());
    }

    /// Returns how bones follow one that is moved.
    pub fn ik(&self) -> IkMode {
        self.ik
    }

    /// Turns IK on or off.
    pub(super) fn toggle_ik(&mut self) {
        self.ik.on = !self.ik.on;
    }

    /// Changes the number of bones that follow.
    pub(super) fn lengthen_ik(&mut self, by: i64) {
        self.ik.length =
            between(i64::from(self.ik.length).saturating_add(by), 1, i64::from(LONGEST_CHAIN)) as u32;
    }

    /// Sets the bone towards which elbows and knees bend.
    pub(super) fn set_pole(&mut self, pole: Option<BoneIndex>) {
        self.ik.pole = pole;
    }

    /// Notes that a drag that a key tried to begin was refused at this moment.
    pub(super) fn refuse_drag(&mut self, at: Instant) {
        self.refused_drag = Some(at);
    }

    /// Returns when a drag that a key tried to begin was refused, and forgets it.
    pub(super) fn take_refused_drag(&mut self) -> Option<Instant> {
        self.refused_drag.take()
    }

    /// Returns whether the last click hit a handle of the gizmo.
    pub(super) fn clicked_handle(&self) -> bool {
        self.on_handle
    }

    /// Notes whether the last click hit a handle of the gizmo.
    pub(super) fn set_clicked_handle(&mut self, on_handle: bool) {
        self.on_handle = on_handle;
    }
}
