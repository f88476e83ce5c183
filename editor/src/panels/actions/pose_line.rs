//! The pose line: a stroke in the view becomes the pose of the selected chain of bones.

use super::{locks, playback};
use crate::control::line::{DrawnStroke, LineUse};
use crate::panels::request::Effect;
use crate::panels::status::MessageSeverity;
use crate::panels::workspace::Workspace;
use dragonfly_anim::data::{BoneIndex, Skeleton};
use dragonfly_anim::ik::{ActionLine, line_of_action};
use dragonfly_anim::stage::line::LineSamples;
use dragonfly_document::Change;
use dragonfly_document::edit::{BonePose, BoneRef};
use glam::{Quat, Vec3};

/// Bones that turn, from the first one to the one above the last joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct BoneChain {
    pub(super) root: BoneIndex,
    pub(super) end: BoneIndex,
}

/// Begins to draw the line of action of the selected bones; a second time ends it.
pub(in crate::panels) fn choose(workspace: &mut Workspace) {
    let is_on = workspace.tools.controls().line().use_of() == Some(LineUse::Pose);
    if is_on {
        return workspace.tools.controls_mut().line_mut().choose(None);
    }
    let Some(chain) = chain(workspace) else { return };
    begin(
        workspace,
        chain.root,
        LineUse::Pose,
        "Draw the line along which the selected bones lie, or with Alt the path of their end over time; click corners and end with Enter, or press Esc to stop",
    );
}

/// Chooses the tool that draws for a bone, at the depth of the bone, and shows a hint. Playback stops.
pub(super) fn begin(workspace: &mut Workspace, bone: BoneIndex, use_of: LineUse, hint: &str) {
    let Some(view) = workspace.model.view() else { return };
    let (take, time) = (workspace.player.take(), workspace.player.time());
    let to_root = workspace.posed.update(view, take, time).to_root();
    let pivot = to_root.get(bone as usize).map(|matrix| matrix.w_axis.truncate().as_dvec3());
    playback::stop_at(workspace, time);
    let line = workspace.tools.controls_mut().line_mut();
    line.set_pivot(pivot.unwrap_or_default());
    line.choose(Some(use_of));
    workspace.say(MessageSeverity::Info, hint);
}

/// Lays the selected bones along a stroke.
pub(super) fn pose(workspace: &mut Workspace, stroke: &DrawnStroke) -> Option<Effect> {
    let chain = chain(workspace)?;
    if let Some(reason) = workspace.read().scope_refusal() {
        workspace.say(MessageSeverity::Warning, reason);
        return None;
    }
    let fixed = workspace.read().fixed_bones();
    let back = workspace.camera.camera().back();
    let samples = LineSamples::new(&stroke.control, false);
    let points: Vec<Vec3> = samples.points().iter().map(|point| point.as_vec3()).collect();
    let view = workspace.model.view()?;
    let skeleton = &view.loaded.model.animation.skeleton;
    let posed = workspace.posed.update(view, workspace.player.take(), workspace.player.time());
    let (before, to_root) = (posed.poses().to_vec(), posed.to_root());
    let mut poses = before.clone();
    // A bone that is locked keeps its rotation; those below it follow the stroke again.
    let mut keep = |bone: BoneIndex, rotation: Quat| match fixed.contains(&bone) {
        true => before.get(bone as usize).map_or(rotation, |pose| pose.rotation),
        false => rotation,
    };
    let line = ActionLine { root: chain.root, end: chain.end, stroke: &points, back };
    if let Err(error) = line_of_action(skeleton, to_root, &line, Some(&mut keep), &mut poses) {
        workspace.say(MessageSeverity::Warning, format!("The bones cannot lie along this line: {error}"));
        return None;
    }
    let turned =
        poses.iter().zip(&before).enumerate().filter(|(bone, (now, was))| {
            now.rotation != was.rotation && !fixed.contains(&(*bone as BoneIndex))
        });
    let turned = turned.map(|(bone, (now, _))| BonePose {
        bone: BoneRef::Index(bone as BoneIndex),
        translation: None,
        rotation: Some(now.rotation.to_array()),
        scale: None,
    });
    let turned: Vec<BonePose> = turned.collect();
    let edit = workspace.read().pose_edit(turned)?;
    locks::unlocked(workspace, Effect::Change(Change::Edit(edit, None)))
}

/// Returns the chain that is selected; reports why there is none.
fn chain(workspace: &mut Workspace) -> Option<BoneChain> {
    let view = workspace.model.view()?;
    let selected = workspace.bones.selection().bones();
    match chain_of(&view.loaded.model.animation.skeleton, selected) {
        Ok(chain) => Some(chain),
        Err(reason) => {
            workspace.say(MessageSeverity::Info, reason);
            None
        }
    }
}

/// Returns the chain of selected bones: from the first one to the joint below the last one, if it has one joint below, and to the last one otherwise.
pub(super) fn chain_of(skeleton: &Skeleton, selected: &[BoneIndex]) -> Result<BoneChain, &'static str> {
    let parent = |bone: &BoneIndex| skeleton.bones.get(*bone as usize).and_then(|own| own.parent);
    // A parent comes before its children.
    let (Some(&root), Some(&last)) = (selected.iter().min(), selected.iter().max()) else {
        return Err("Select a chain of bones first: an arm, a spine, a tail");
    };
    let path: Vec<BoneIndex> =
        std::iter::successors(Some(last), parent).take_while(|&bone| bone >= root).collect();
    if path.last() != Some(&root) || !selected.iter().all(|bone| path.contains(bone)) {
        return Err("The selected bones are no chain: each has to be below the one before");
    }
    let mut below = skeleton.children(Some(last));
    match (below.next(), below.next()) {
        (Some(end), None) => Ok(BoneChain { root, end }),
        _ if root != last => Ok(BoneChain { root, end: last }),
        _ => Err("Select two bones at least: the line goes from the first one to the last one"),
    }
}
