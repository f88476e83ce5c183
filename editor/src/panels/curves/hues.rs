//! The colors of curves: of their axes where one bone is shown, otherwise of their bones and shape keys.

use super::id::CurveId;
use super::shown::ShownCurves;
use crate::panels::theme::Theme;
use egui::Color32;

/// A curve of each bone and each shape key that is shown, if there are several.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct CurveHues(Vec<CurveId>);

impl CurveHues {
    /// Returns the colors of all curves; none if they are of one bone.
    pub(super) fn of(shown: &ShownCurves) -> Self {
        let mut owners: Vec<CurveId> = shown.curves().map(|curve| curve.id).collect();
        owners.dedup_by(|next, kept| kept.shares_color(*next));
        Self(if owners.len() > 1 { owners } else { Vec::new() })
    }

    /// Returns the color of a component of a curve.
    pub(super) fn color(&self, theme: &Theme, id: CurveId, component: usize) -> Color32 {
        match self.0.iter().position(|other| other.shares_color(id)) {
            Some(at) => theme.bone_hue(at, component),
            None if id.is_shape() => theme.key,
            None => super::paint::color(theme, component),
        }
    }
}
