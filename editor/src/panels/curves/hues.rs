//! The colors of curves: of their axes where one bone is shown, otherwise of their bones.

use super::shown::ShownCurves;
use crate::panels::theme::Theme;
use dragonfly_anim::data::BoneIndex;
use egui::Color32;

/// The bones whose curves are shown, if there are several.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct CurveHues(Vec<BoneIndex>);

impl CurveHues {
    /// Returns the bones of all curves; none if they are of one bone.
    pub(super) fn of(shown: &ShownCurves) -> Self {
        let mut bones: Vec<BoneIndex> = shown.curves().map(|curve| curve.id.0).collect();
        bones.dedup();
        Self(if bones.len() > 1 { bones } else { Vec::new() })
    }

    /// Returns the color of a component of a bone's curve.
    pub(super) fn color(&self, theme: &Theme, bone: BoneIndex, component: usize) -> Color32 {
        match self.0.iter().position(|&other| other == bone) {
            Some(at) => theme.bone_hue(at, component),
            None => super::paint::color(theme, component),
        }
    }
}
