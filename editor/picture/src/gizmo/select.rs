//! The position of a selection's gizmo, and the bones that a drag of it changes.

use super::{GizmoAxes, GizmoLayout, GizmoSettings, GizmoSpace, GizmoTarget, GizmoView, Pivot, Tool};
use dragonfly_anim::data::{BoneIndex, Skeleton, Transform};
use glam::{DVec3, Mat4};

/// A skeleton in a pose: `poses` relative to the parents, `to_root` of all bones.
#[derive(Clone, Copy, Debug)]
pub struct PosedSkeleton<'a> {
    /// The bones, parents first.
    pub skeleton: &'a Skeleton,
    /// The pose of each bone, parent space.
    pub poses: &'a [Transform],
    /// The matrix of each bone, bone space → root space.
    pub to_root: &'a [Mat4],
}

impl PosedSkeleton<'_> {
    fn target(&self, bone: BoneIndex) -> Option<GizmoTarget> {
        GizmoTarget::of(self.skeleton, self.poses, self.to_root, bone)
    }
}

/// The position of a gizmo and the bone whose axes it uses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GizmoAnchor {
    /// The active bone.
    pub active: GizmoTarget,
    /// The origin of the gizmo, scene space.
    pub pivot: DVec3,
}

impl GizmoAnchor {
    /// The axes of the gizmo in `space`, as seen from `view`.
    pub fn axes(&self, space: GizmoSpace, view: &GizmoView) -> GizmoAxes {
        self.active.frame(space, view)
    }
}

/// The gizmo of a selection: its anchor and the bones that it changes. Reuses its memory from call to call.
#[derive(Clone, Debug, Default)]
pub struct GizmoPlacement {
    anchor: Option<GizmoAnchor>,
    targets: Vec<GizmoTarget>,
    chosen: Vec<bool>,
}

impl GizmoPlacement {
    /// Places the gizmo of `tool` at `selected`. `active` is the bone that gives the axes; by default the last
    /// selected bone. Allocates only when the skeleton grows.
    pub fn select(
        &mut self,
        settings: &GizmoSettings,
        tool: Tool,
        pose: &PosedSkeleton<'_>,
        selected: &[BoneIndex],
        active: Option<BoneIndex>,
    ) {
        let each = settings.curl && settings.pivot == Pivot::Individual && tool != Tool::Move;
        self.find_targets(pose, selected, each);
        let active = active.or(selected.last().copied()).and_then(|bone| pose.target(bone));
        self.anchor =
            active.or(self.targets.last().copied()).filter(|_| !self.targets.is_empty()).map(|active| {
                let pivot = match settings.pivot {
                    Pivot::Median => median(pose, selected).unwrap_or(active.origin()),
                    Pivot::Individual | Pivot::Active => active.origin(),
                };
                GizmoAnchor { active, pivot }
            });
    }

    /// The position of the gizmo; `None` where nothing is selected.
    pub fn anchor(&self) -> Option<GizmoAnchor> {
        self.anchor
    }

    /// The bones that a drag changes, in the order of the skeleton.
    pub fn targets(&self) -> &[GizmoTarget] {
        &self.targets
    }

    /// The gizmo as laid out in `view`; `None` where nothing is selected or the pivot is behind the camera.
    pub fn layout(&self, space: GizmoSpace, view: GizmoView) -> Option<GizmoLayout> {
        let anchor = self.anchor?;
        GizmoLayout::new(view, anchor.pivot, anchor.axes(space, &view))
    }

    /// Finds the selected bones in the order of the skeleton; without `each`, leaves out those with a selected ancestor,
    /// which follow it anyway.
    fn find_targets(&mut self, pose: &PosedSkeleton<'_>, selected: &[BoneIndex], each: bool) {
        let Self { chosen, targets, .. } = self;
        let bones = &pose.skeleton.bones;
        chosen.clear();
        chosen.resize(bones.len(), false);
        for &bone in selected {
            if let Some(chosen) = chosen.get_mut(bone as usize) {
                *chosen = true;
            }
        }
        targets.clear();
        // Parents come before children, so one pass propagates "selected or below a selected bone".
        for index in 0..bones.len() {
            let below = bones[index].parent.is_some_and(|parent| chosen.get(parent as usize) == Some(&true));
            if chosen[index] && (each || !below) {
                targets.extend(pose.target(index as BoneIndex));
            }
            chosen[index] |= below && !each;
        }
    }
}

/// The mean of the joints of the selected bones, scene space.
fn median(pose: &PosedSkeleton<'_>, selected: &[BoneIndex]) -> Option<DVec3> {
    let (mut sum, mut count) = (DVec3::ZERO, 0.0);
    for origin in selected.iter().filter_map(|&bone| pose.target(bone)).map(|target| target.origin()) {
        sum += origin;
        count += 1.0;
    }
    (count > 0.0).then(|| sum / count)
}
