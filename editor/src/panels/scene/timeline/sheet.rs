//! The timeline of a scene in one frame.

use super::lane_layout::SceneLaneLayout;
use crate::panels::context::PanelContext;
use crate::panels::keys::TimeScale;
use crate::panels::theme::Theme;
use dragonfly_anim::stage::lanes::SceneLanes;
use dragonfly_document::SceneView;
use egui::Rect;

/// The timeline in one frame, as its parts read it.
#[derive(Clone, Copy)]
pub(super) struct SceneSheet<'a> {
    pub(super) scene: &'a SceneView,
    pub(super) lanes: &'a SceneLanes,
    pub(super) layout: &'a SceneLaneLayout,
    pub(super) scale: &'a TimeScale,
    pub(super) context: &'a PanelContext<'a>,
    pub(super) theme: &'a Theme,
    /// The lanes.
    pub(super) canvas: Rect,
    /// The ruler.
    pub(super) head: Rect,
    /// The names of the lanes.
    pub(super) names: Rect,
    /// Number of points by which the lanes are scrolled up.
    pub(super) scroll: f32,
}
