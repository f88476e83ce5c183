//! A blend towards a pose, from the poses when the drag began.

use crate::panels::actions::pose_library::for_bones;
use crate::panels::context::PanelContext;
use dragonfly_anim::data::{BoneIndex, Transform};
use dragonfly_document::PoseFile;
use dragonfly_document::edit::{BonePose, BoneRef, Edit};
use dragonfly_document::posing::blended_pose;

/// A blend towards a pose.
#[derive(Clone, Debug)]
pub(super) struct PoseBlend {
    file: String,
    amount: f32,
    /// The bones that it changes, with their poses when it began, and those of the library.
    bones: Vec<(Transform, BonePose)>,
}

impl PoseBlend {
    /// Begins a blend of the selected bones, or of all that the pose has.
    pub(super) fn begin(context: &PanelContext<'_>, file: &PoseFile) -> Option<Self> {
        let now = context.posed.animation()?.poses();
        let place = |pose: BonePose| {
            let bone: BoneIndex = match pose.bone {
                BoneRef::Index(bone) => bone,
                BoneRef::Name(_) => return None,
            };
            Some((*now.get(bone as usize)?, pose))
        };
        let poses = for_bones(context, &file.pose.poses, false);
        let free = |pose: &BonePose| match pose.bone {
            BoneRef::Index(bone) => !context.keys.flags().locked(bone),
            BoneRef::Name(_) => false,
        };
        let bones: Vec<_> = poses.into_iter().filter(free).filter_map(place).collect();
        (!bones.is_empty()).then(|| Self { file: file.file.clone(), amount: 0.0, bones })
    }

    pub(super) fn file(&self) -> &str {
        &self.file
    }

    pub(super) fn amount(&self) -> f32 {
        self.amount
    }

    /// Returns the edit that blends by an amount, 0 to 1.
    pub(super) fn edit(&mut self, context: &PanelContext<'_>, amount: f32) -> Option<Edit> {
        self.amount = amount;
        let poses = self.bones.iter().map(|(from, to)| blended_pose(from, to, amount));
        context.pose_edit(poses.collect())
    }
}
