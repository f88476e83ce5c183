//! The state of the window in the log: for tests and tools that cannot read pixels.

use crate::panels::PanelContext;
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::Change;
use dragonfly_document::protocol::ProtocolCommand;
use dragonfly_picture::camera::Camera;
use glam::{Quat, Vec3};
use tracing::{debug, enabled};

/// Target of the lines about the state.
const TARGET: &str = "dragonfly::shown";

/// Target of the lines about changes that were sent to the document.
const ASKED: &str = "dragonfly::asked";

/// Logs a change that is sent to the document, as a line that `dragonfly --stdio` accepts
/// (`DRAGONFLY_LOG=dragonfly::asked=debug`).
pub(super) fn asked(change: &Change) {
    if !enabled!(target: ASKED, tracing::Level::DEBUG) {
        return;
    }
    let line = ProtocolCommand::of(change).and_then(|command| serde_json::to_string(&command).ok());
    if let Some(line) = line {
        debug!(target: ASKED, "{line}");
    }
}

/// The state that was logged last. A state is logged only if it differs from this one.
#[derive(Debug, Default, PartialEq)]
pub(super) struct StateTrace(Option<StateRecord>);

#[derive(Clone, Copy, Debug, PartialEq)]
struct StateRecord {
    viewport: egui::Rect,
    bones: usize,
    bone: Option<BoneIndex>,
    take: Option<usize>,
    camera: Camera,
    time: f32,
    playing: bool,
    steps: [usize; 2],
    pose: Option<(Vec3, Quat, Vec3)>,
}

impl StateTrace {
    /// Logs the state if it has changed and playback is paused
    /// (`DRAGONFLY_LOG=dragonfly::shown=debug`).
    pub(super) fn tell(&mut self, state: &PanelContext<'_>) {
        if !enabled!(target: TARGET, tracing::Level::DEBUG) || state.playback.playing {
            return;
        }
        let bone = state.selected();
        let animation = bone.and(state.posed.animation());
        let pose = animation.zip(bone).and_then(|(animation, bone)| animation.poses().get(bone as usize));
        let history = state.view.map(|view| [view.history.done, view.history.steps.len()]);
        let record = StateRecord {
            viewport: state.viewport,
            bones: state.selection.bones().len(),
            bone,
            take: state.playback.take,
            camera: state.camera,
            time: state.time(),
            playing: state.playback.playing,
            steps: history.unwrap_or_default(),
            pose: pose.map(|pose| (pose.translation, pose.rotation, pose.scale)),
        };
        if self.0.replace(record) == Some(record) {
            return;
        }
        let name = bone.map_or(String::new(), |bone| state.bone_name(bone));
        let take = state.shown_take().map_or("", |take| &take.name);
        let Camera { target, distance, yaw, pitch, .. } = record.camera;
        let rect = record.viewport;
        let (translation, rotation, scale) = record.pose.unwrap_or_default();
        debug!(
            target: TARGET,
            viewport = ?[rect.left(), rect.top(), rect.width(), rect.height()],
            bones = record.bones,
            bone = name,
            take,
            camera = ?[target.x, target.y, target.z, distance, yaw, pitch],
            time = record.time,
            done = record.steps[0],
            steps = record.steps[1],
            translation = ?translation.to_array(),
            rotation = ?rotation.to_array(),
            scale = ?scale.to_array(),
            "shown"
        );
    }
}
