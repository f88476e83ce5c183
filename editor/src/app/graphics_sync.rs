//! Keeping the graphics thread up to date: sends the state that it needs when that has changed.

use crate::panels::PanelContext;
use crate::panels::theme::{Theme, linear};
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::HiddenBones;
use dragonfly_picture::camera::Camera;
use dragonfly_picture::gizmo::RoleColors;
use dragonfly_picture::playback::PlaybackClock;
use dragonfly_picture::{
    AppearanceSender, ComparedAppearance, GhostAppearance, GizmoAppearance, GizmoDragAppearance, GizmoLook,
    GraphicsHandle, IkAppearance, LineAppearance, Look, PathAppearance, ReferenceAppearance, SecondView,
    ThingAppearance,
};
use std::sync::Arc;

/// The values that were sent last.
#[derive(Default)]
pub struct GraphicsSync {
    playback: Option<PlaybackClock>,
    camera: Option<Camera>,
    look: Option<Look>,
    hidden: Arc<HiddenBones>,
    hidden_things: Arc<[Arc<str>]>,
    /// Version of the flags of bones.
    flags: u64,
    appearances: AppearanceSender,
    /// Memory for the list of selected bones.
    spare: Vec<BoneIndex>,
}

impl GraphicsSync {
    /// Sends the values that differ from those sent last. The document itself has already sent the view that these
    /// times and bones refer to.
    pub fn update(
        &mut self,
        graphics: &GraphicsHandle,
        state: &PanelContext<'_>,
        pixels_per_point: f32,
        dark: bool,
    ) {
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
        if !self.hidden_things.iter().map(|id| &**id).eq(state.scene_editing.hidden()) {
            self.hidden_things = state.scene_editing.hidden().map(Arc::from).collect();
        }
        let hidden_things = Arc::clone(&self.hidden_things);
        let look = look(state, selected, (hidden, hidden_things), pixels_per_point, dark);
        if self.look.as_ref() == Some(&look) {
            self.spare = look.selected;
        } else {
            graphics.set_look(look.clone());
            self.look = Some(look);
        }
        self.send_appearances(graphics, state);
    }

    /// Sends the data of controls and passes that has changed: one call per type.
    fn send_appearances(&mut self, graphics: &GraphicsHandle, state: &PanelContext<'_>) {
        let gizmo = &state.tools.controls().gizmo().gizmo;
        let sender = &mut self.appearances;
        sender.update(graphics, |GizmoAppearance(look)| {
            *look = state.settings.tools.tool.map(|tool| GizmoLook {
                tool,
                settings: gizmo.settings,
                hovered: gizmo.hovered(),
            });
        });
        sender.update(graphics, |GizmoDragAppearance(drag)| {
            // The things of a scene are no bones of the model that is drawn.
            if gizmo.is_dragging() || state.scene().is_some() && state.settings.tools.tool.is_some() {
                let shape = drag.get_or_insert_default();
                shape.clear();
                gizmo.present(shape);
            } else {
                *drag = None;
            }
        });
        sender.update(graphics, |things: &mut ThingAppearance| {
            let selected = state.scene_editing.things();
            if !things.selected.iter().map(|id| &**id).eq(selected.iter().map(|id| &**id)) {
                things.selected = selected.iter().map(|id| Arc::from(&**id)).collect();
            }
            things.hovered = state.stage.hovered().cloned();
        });
        sender.update(graphics, |path: &mut PathAppearance| {
            path.path = state.tools.path().look().cloned();
            path.hovered = state.tools.controls().path().hovered();
        });
        sender.update(graphics, |lines: &mut LineAppearance| {
            let looks = state.scene_editing.lines().looks();
            lines.lines = if state.settings.look.lines { Arc::clone(looks) } else { Arc::default() };
            state.line_draft(&mut lines.draft);
            state.line_handles(&mut lines.handles);
        });
        sender.update(graphics, |ghosts: &mut GhostAppearance| {
            ghosts.skins = state.settings.tools.ghosts.skin;
            state.ghost_times(&mut ghosts.times);
        });
        sender.update(graphics, |compared: &mut ComparedAppearance| {
            compared.second = state.second_skeleton();
        });
        sender.update(graphics, |reference: &mut ReferenceAppearance| state.fill_reference(reference));
        sender.update(graphics, |IkAppearance(ik)| {
            if !state.shows_ik(ik.as_ref()) {
                *ik = state.ik_look();
            }
        });
    }
}

/// Returns the look of the viewport in this state.
fn look(
    state: &PanelContext<'_>,
    selected: Vec<BoneIndex>,
    (hidden, hidden_things): (Arc<HiddenBones>, Arc<[Arc<str>]>),
    pixels_per_point: f32,
    dark: bool,
) -> Look {
    let theme = Theme::get(dark);
    let settings = &state.settings.look;
    let pixels = |points: f32| (points * pixels_per_point).round().max(0.0) as u32;
    let place = |rect: egui::Rect| {
        let (left, top) = (pixels(rect.left()), pixels(rect.top()));
        [left, top, pixels(rect.right()).saturating_sub(left), pixels(rect.bottom()).saturating_sub(top)]
    };
    Look {
        viewport: place(state.viewport),
        pixels_per_point,
        background: theme.sky.map(linear),
        grid: settings.grid,
        contact_shadow: settings.contact_shadow,
        grid_color: linear(theme.grid),
        skeleton: state.shows_skeleton(),
        bone_look: settings.bone_look,
        bones_in_front: settings.bones_in_front,
        selected,
        hovered: state.highlighted(),
        shading: settings.shading,
        surface: settings.surface,
        effects: settings.effects,
        bone_color: linear(theme.bone),
        accent: linear(theme.accent),
        hidden,
        handles: RoleColors::new(|role| linear(theme.role(role))),
        through: state.through.clone(),
        helpers: state.scene().is_some() && settings.helpers,
        hidden_things,
        around: state.around.cloned(),
        second: state.second_view.filter(|_| state.scene().is_some()).map(|rect| SecondView {
            viewport: place(rect),
            through: state.other_through.clone(),
            camera: state.other_camera,
        }),
    }
}
