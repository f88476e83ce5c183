//! Where the gizmo stands: at the selected bones, in the pose that is shown.

use super::follow::Following;
use crate::panels::state::State;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::history::Gesture;
use dragonfly_picture::gizmo::{GizmoSettings, Tool};

/// What the hands hold on to between two inputs.
#[derive(Debug, Default)]
pub struct Hold {
    /// The drag that goes on, once it changed something.
    gesture: Option<Gesture>,
    /// What follows the bones that it moves.
    pub(super) following: Following,
    /// For what the gizmo was placed last.
    placed: Option<Placed>,
    /// The same, while it is compared: keeps its memory.
    spare: Vec<BoneIndex>,
}

/// Everything that the place of a gizmo follows from.
#[derive(Clone, Debug, PartialEq)]
struct Placed {
    generation: u64,
    take: Option<usize>,
    time: f32,
    tool: Option<Tool>,
    settings: GizmoSettings,
    selected: Vec<BoneIndex>,
    /// It may be one that is not moved.
    active: Option<BoneIndex>,
    /// Version of the marks of bones: some are seen at rest.
    flags: u64,
}

impl Hold {
    /// The drag that goes on, once it changed something.
    pub fn gesture(&self) -> Option<Gesture> {
        self.gesture
    }

    pub(super) fn begin(&mut self, gesture: Gesture) {
        self.gesture = Some(gesture);
    }

    pub(super) fn end(&mut self) -> Option<Gesture> {
        self.following = Following::Undecided;
        self.gesture.take()
    }
}

impl State {
    /// Puts the gizmo where the selected bones are now. Does nothing where nothing changed; a drag keeps its place.
    pub(in crate::panels) fn grasp(&mut self) {
        self.hands.look(&self.camera);
        let Some(view) = &self.view else { return };
        let hand = &self.settings.hand;
        let settings = GizmoSettings {
            space: hand.space,
            pivot: hand.pivot,
            curl: hand.curl,
            ..self.hands.gizmo().gizmo.settings
        };
        let mut selected = std::mem::take(&mut self.hold.spare);
        selected.clear();
        selected.extend(self.bones_to_pose());
        let (take, time) = (self.playback.take, self.playback.time_at(self.now));
        let (generation, flags) = (view.generation, self.keys.flags.version());
        let active = self.selection.active();
        let now = Placed { generation, take, time, tool: hand.tool, settings, selected, active, flags };
        if self.hold.placed.as_ref() == Some(&now) || self.hands.edits() {
            self.hold.spare = now.selected;
            return;
        }
        let editable = take.is_some() && !self.selection_is_locked();
        let free = active.is_none_or(|bone| !self.keys.flags.locked(bone));
        let control = self.hands.gizmo_mut();
        control.editable = editable;
        control.gizmo.settings = settings;
        control.gizmo.tool = now.tool.unwrap_or_default();
        // Who only selects has no handles.
        let bones = if now.tool.is_some() { &now.selected[..] } else { &[] };
        if bones.is_empty() {
            control.gizmo.select(&view.loaded.model.animation.skeleton, &[], &[], &[], None);
        } else {
            let animation = self.posed.update(view, take, time);
            let skeleton = &view.loaded.model.animation.skeleton;
            control.gizmo.select(skeleton, animation.poses(), animation.to_root(), bones, None);
        }
        let pivot = self.hands.gizmo().gizmo.pivot();
        let path = self.hands.path_mut();
        (path.editable, path.gizmo) = (take.is_some() && free, pivot);
        self.hold.spare = self.hold.placed.replace(now).map(|placed| placed.selected).unwrap_or_default();
        self.hands.update();
    }

    /// Ends what is being dragged without a trace here: the model is another.
    pub(in crate::panels) fn drop_hold(&mut self) {
        self.hands.cancel();
        self.hands.gizmo_mut().take_answer();
        self.hands.path_mut().take_answer();
        self.hold = Hold::default();
    }
}
