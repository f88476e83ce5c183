//! Keeps the graphics thread in step with the panels: only what differs is sent.

use super::interface::Interface;
use crate::panels::PanelContext;
use crate::panels::theme::{Theme, linear};
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::HiddenBones;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::gizmo::GizmoShape;
use dragonfly_picture::playback::Playback;
use dragonfly_picture::{Appearance, GizmoLook, GraphicsHandle, IkLook, Look, PathLook};
use std::sync::Arc;

/// What was sent to the graphics thread last.
#[derive(Default)]
pub(super) struct GraphicsSync {
    playback: Option<Playback>,
    camera: Option<Camera>,
    look: Option<Look>,
    hidden: Arc<HiddenBones>,
    gizmo: Option<GizmoLook>,
    /// Whether a gizmo is shown that is dragged.
    drags: bool,
    /// Revision of the viewport tools that was sent last.
    revision: u64,
    /// Version of the flags of bones.
    flags: u64,
    path: Option<Arc<PathLook>>,
    path_hovered: Option<f32>,
    ghosts: Vec<(f32, i32)>,
    spare_times: Vec<(f32, i32)>,
    ghost_skins: bool,
    ik: Option<IkLook>,
    /// Memory for the list of selected bones.
    spare: Vec<BoneIndex>,
}

impl GraphicsSync {
    /// Sends what differs from what was sent last. The takes and bones that it refers to are in the view, which the document
    /// sent to the graphics thread before.
    pub(super) fn update(&mut self, graphics: &GraphicsHandle, interface: &Interface) {
        let state = &interface.state.read();
        if self.playback != Some(state.playback) {
            self.playback = Some(state.playback);
            graphics.play(state.playback);
        }
        if self.camera != Some(state.camera) {
            self.camera = Some(state.camera);
            graphics.set_camera(state.camera);
        }
        let flags = state.keys.flags();
        if self.flags != flags.version() {
            self.flags = flags.version();
            let bones = state.loaded().map_or(0, |loaded| loaded.model.animation.skeleton.len());
            graphics.hold_still(flags.still(bones));
        }
        let mut selected = std::mem::take(&mut self.spare);
        selected.clear();
        selected.extend_from_slice(state.selection.bones());
        if *self.hidden != *state.hidden {
            self.hidden = Arc::new(state.hidden.clone());
        }
        let hidden = Arc::clone(&self.hidden);
        let look = look(state, selected, hidden, interface.pixels_per_point(), interface.is_dark());
        if self.look.as_ref() == Some(&look) {
            self.spare = look.selected;
        } else {
            graphics.set_look(look.clone());
            self.look = Some(look);
        }
        self.controls(graphics, state);
    }

    /// Sends how the gizmo, the motion path, ghosts and IK look.
    fn controls(&mut self, graphics: &GraphicsHandle, state: &PanelContext<'_>) {
        let gizmo = &state.tools.controls().gizmo().gizmo;
        let look = state.settings.tools.tool.map(|tool| GizmoLook {
            tool,
            settings: gizmo.settings,
            hovered: gizmo.hovered(),
        });
        if self.gizmo != look {
            self.gizmo = look;
            graphics.show_control(Appearance::Gizmo(look));
        }
        let revision = state.tools.controls().revision();
        if gizmo.is_dragging() {
            if !self.drags || self.revision != revision {
                let mut shape = GizmoShape::default();
                gizmo.present(&mut shape);
                graphics.show_control(Appearance::Drag(Some(shape)));
            }
        } else if self.drags {
            graphics.show_control(Appearance::Drag(None));
        }
        let (path, hovered) = (state.tools.path().look(), state.tools.controls().path().hovered());
        let same = match (path, &self.path) {
            (Some(path), Some(sent)) => Arc::ptr_eq(path, sent),
            (path, sent) => path.is_none() && sent.is_none(),
        };
        if !same || self.path_hovered != hovered {
            self.path = path.cloned();
            self.path_hovered = hovered;
            graphics.show_control(Appearance::Path(self.path.clone(), hovered));
        }
        if self.ghost_skins != state.settings.tools.ghosts.skin {
            self.ghost_skins = state.settings.tools.ghosts.skin;
            graphics.show_control(Appearance::GhostSkins(self.ghost_skins));
        }
        state.ghost_times(&mut self.spare_times);
        if self.ghosts != self.spare_times {
            self.ghosts.clone_from(&self.spare_times);
            graphics.show_control(Appearance::Ghosts(self.ghosts.clone()));
        }
        if !state.shows_ik(self.ik.as_ref()) {
            self.ik = state.ik_look();
            graphics.show_control(Appearance::Ik(self.ik.clone()));
        }
        (self.drags, self.revision) = (gizmo.is_dragging(), revision);
    }
}

/// Returns how the graphics thread is to draw the viewport.
fn look(
    state: &PanelContext<'_>,
    selected: Vec<BoneIndex>,
    hidden: Arc<HiddenBones>,
    pixels_per_point: f32,
    dark: bool,
) -> Look {
    let theme = Theme::get(dark);
    let settings = &state.settings.look;
    let pixels = |points: f32| (points * pixels_per_point).round().max(0.0) as u32;
    let rect = state.viewport;
    let (left, top) = (pixels(rect.left()), pixels(rect.top()));
    Look {
        viewport: [
            left,
            top,
            pixels(rect.right()).saturating_sub(left),
            pixels(rect.bottom()).saturating_sub(top),
        ],
        pixels_per_point,
        background: theme.sky.map(linear),
        grid: settings.grid,
        grid_color: linear(theme.grid),
        skeleton: state.shows_skeleton(),
        bone_look: settings.bone_look,
        bones_in_front: settings.bones_in_front,
        selected,
        hovered: state.highlighted(),
        shading: settings.shading,
        surface: settings.surface,
        bone_color: linear(theme.bone),
        accent: linear(theme.accent),
        hidden,
        handles: theme.handles().map(linear),
    }
}
