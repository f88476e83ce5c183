//! What an edit is about, and what the history calls it.

use super::{BonePose, Edit, ResetTo, TakeRef};

impl Edit {
    /// The take it is about; `None` where it makes one.
    pub fn take(&self) -> Option<&TakeRef> {
        match self {
            Self::CreateTake { .. } => None,
            Self::Set { take, .. }
            | Self::SetMany { take, .. }
            | Self::Offset { take, .. }
            | Self::Reset { take, .. }
            | Self::Pend { take, .. }
            | Self::Paste { take, .. }
            | Self::KeyPending { take, .. }
            | Self::DropPending { take, .. }
            | Self::AddKeys { take, .. }
            | Self::DeleteKeys { take, .. }
            | Self::MoveKeys { take, .. }
            | Self::ScaleKeys { take, .. }
            | Self::DuplicateKeys { take, .. }
            | Self::PasteKeys { take, .. }
            | Self::Ripple { take, .. }
            | Self::SnapKeys { take, .. }
            | Self::SetInterpolation { take, .. }
            | Self::SetTangents { take, .. }
            | Self::DeleteTake { take }
            | Self::RenameTake { take, .. }
            | Self::MoveTake { take, .. }
            | Self::SplitTake { take, .. }
            | Self::TrimTake { take, .. }
            | Self::ReverseTake { take }
            | Self::RetimeTake { take, .. } => Some(take),
        }
    }

    /// For the history and the undo command: what was done, in a few words.
    pub fn label(&self) -> &'static str {
        match self {
            Self::Set { poses, .. } | Self::Offset { poses, .. } => pose_label(poses),
            Self::SetMany { at, .. } => at.first().map_or("Pose", |at| pose_label(&at.poses)),
            Self::Reset { to: ResetTo::Original, .. } => "Reset to original",
            Self::Reset { to: ResetTo::Rest, .. } => "Reset to rest pose",
            Self::Pend { poses, .. } => pending_label(poses),
            Self::Paste { mirrored: false, .. } => "Paste pose",
            Self::Paste { mirrored: true, .. } => "Paste pose mirrored",
            Self::KeyPending { .. } => "Key pending poses",
            Self::DropPending { .. } => "Drop pending poses",
            Self::AddKeys { .. } => "Add keys",
            Self::DeleteKeys { .. } => "Delete keys",
            Self::MoveKeys { .. } => "Move keys",
            Self::ScaleKeys { .. } => "Scale keys",
            Self::DuplicateKeys { .. } => "Duplicate keys",
            Self::PasteKeys { .. } => "Paste keys",
            Self::Ripple { .. } => "Ripple",
            Self::SnapKeys { .. } => "Snap keys to frames",
            Self::SetInterpolation { .. } => "Set interpolation",
            Self::SetTangents { .. } => "Set tangents",
            Self::CreateTake { copy: None, .. } => "Create take",
            Self::CreateTake { copy: Some(_), .. } => "Duplicate take",
            Self::DeleteTake { .. } => "Delete take",
            Self::RenameTake { .. } => "Rename take",
            Self::MoveTake { .. } => "Move take",
            Self::SplitTake { .. } => "Split take",
            Self::TrimTake { .. } => "Trim take",
            Self::ReverseTake { .. } => "Reverse take",
            Self::RetimeTake { .. } => "Retime take",
        }
    }
}

/// The same for poses that wait to be keyed.
fn pending_label(poses: &[BonePose]) -> &'static str {
    match pose_label(poses) {
        "Move" => "Move (pending)",
        "Rotate" => "Rotate (pending)",
        "Scale" => "Scale (pending)",
        _ => "Pose (pending)",
    }
}

/// Moved, turned, scaled, or several of these.
fn pose_label(poses: &[BonePose]) -> &'static str {
    let any = |has: fn(&BonePose) -> bool| poses.iter().any(has);
    let parts = (
        any(|pose| pose.translation.is_some()),
        any(|pose| pose.rotation.is_some()),
        any(|pose| pose.scale.is_some()),
    );
    match parts {
        (true, false, false) => "Move",
        (false, true, false) => "Rotate",
        (false, false, true) => "Scale",
        _ => "Pose",
    }
}
