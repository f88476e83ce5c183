//! The scene on the processor's side: what is shown, from where, how, and in which pose.
//!
//! Everything that a frame needs is computed into memory that was made when the model came, so playing allocates nothing.

use super::control::Controls;
use super::ghosts::GhostSkins;
use super::message::{BoneLook, Look, Shading};
use super::pick::{pick_all, pick_met};
use super::posed::PosedModel;
use super::skin::SkinPicker;
use super::uniform::FrameUniform;
use crate::camera::{Camera, Projection, Ray};
use crate::gizmo::GizmoRole;
use crate::playback::Playback;
use dragonfly_anim::bounds::{Bounds, Sphere};
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::{LoadedModel, View};
use glam::{Mat4, Vec2, Vec3, Vec4};
use std::sync::Arc;
use std::time::Instant;

/// See the module.
pub struct Scene {
    /// From where.
    pub camera: Camera,
    /// How.
    pub look: Look,
    /// Which time of which take.
    pub playback: Playback,
    /// Alpha of the background; less than one only in pictures for other programs.
    pub background_alpha: f32,
    /// What the controls of the scene look like.
    pub controls: Controls,
    model: Option<PosedModel>,
    skin: Option<SkinPicker>,
    ghosts: GhostSkins,
    /// What is shown.
    shown: Option<View>,
    /// Bones that are seen at rest.
    still: Vec<BoneIndex>,
    uniform: FrameUniform,
}

impl Scene {
    /// Nothing to see yet.
    pub fn new(now: Instant) -> Self {
        Self {
            camera: Camera::default(),
            look: Look::default(),
            playback: Playback::rest(now),
            background_alpha: 1.0,
            controls: Controls::default(),
            model: None,
            skin: None,
            ghosts: GhostSkins::default(),
            shown: None,
            still: Vec::new(),
            uniform: bytemuck::Zeroable::zeroed(),
        }
    }

    /// Shows `view` instead of what is shown. Of the model that is shown already only the takes are exchanged.
    pub fn show(&mut self, view: &View) {
        match &mut self.model {
            Some(model) if Arc::ptr_eq(model.loaded(), &view.loaded) => model.show_takes(view, &self.still),
            _ => {
                let mut model = PosedModel::new(Arc::clone(&view.loaded));
                self.skin = None;
                self.ghosts = GhostSkins::default();
                model.show_takes(view, &self.still);
                self.model = Some(model);
            }
        }
        self.shown = Some(view.clone());
    }

    /// Shows these bones at rest, and all others as they move.
    pub fn set_still(&mut self, still: Vec<BoneIndex>) {
        self.still = still;
        if let Some(view) = self.shown.take() {
            self.show(&view);
        }
    }

    /// Shows `loaded` as it was opened.
    pub fn show_model(&mut self, loaded: Arc<LoadedModel>) {
        self.show(&View::opened(0, loaded));
    }

    /// The model in the pose prepared last.
    pub fn model(&self) -> Option<&PosedModel> {
        self.model.as_ref()
    }

    /// The model at other times, as prepared last.
    pub fn ghosts(&self) -> &GhostSkins {
        &self.ghosts
    }

    fn pose_ghosts(&mut self) {
        let times = self.controls.ghost_skins();
        let Some(view) = self.shown.as_ref().filter(|_| !times.is_empty()) else {
            return self.ghosts.clear();
        };
        let colors = [GizmoRole::Past, GizmoRole::Future].map(|role| self.look.handles[role as usize]);
        self.ghosts.pose(view, &self.still, self.playback.take, times, colors);
    }

    /// This frame's uniform, as prepared last.
    pub fn uniform(&self) -> &FrameUniform {
        &self.uniform
    }

    /// Size of the viewport, pixels.
    pub fn size(&self) -> Vec2 {
        let [_, _, width, height] = self.look.viewport;
        Vec2::new(width as f32, height as f32)
    }

    /// Computes everything for a picture at `now`. Allocates nothing.
    pub fn prepare(&mut self, now: Instant) {
        let time = self.playback.time_at(now);
        let eye = self.camera.eye();
        let bounds = self.model.as_ref().map_or(Sphere::default(), |model| model.bounds().sphere);
        if let Some(model) = &mut self.model {
            model.pose(self.playback.take, time, !self.playback.moves(now));
            model.sort(eye, self.camera.back());
            model.place_bones(&self.look);
            self.controls.present(model, &self.camera, &self.look);
            self.pose_ghosts();
        }
        self.uniform = self.frame_uniform(&bounds);
    }

    /// Scene → clip space for the present camera and viewport.
    pub fn clip_from_world(&self, bounds: &Sphere) -> Mat4 {
        let size = self.size();
        self.camera.clip_from_view(size.x / size.y.max(1.0), bounds) * self.camera.view_from_world()
    }

    /// The line of sight through a pixel of the window, and that pixel within the viewport; `None` outside of it.
    pub fn ray(&self, position: [f32; 2]) -> Option<(Ray, Vec2)> {
        let [x, y, ..] = self.look.viewport;
        let size = self.size();
        let pixel = Vec2::from(position) - Vec2::new(x as f32, y as f32);
        let inside = pixel.cmpge(Vec2::ZERO).all() && pixel.cmplt(size).all();
        inside.then(|| (self.camera.ray(pixel, size), pixel))
    }

    /// The bones at a pixel of the window in the pose prepared last, the nearest first: those that are drawn there; where
    /// none is, or bones are not shown, those that move the skin there most; and then those that it just misses.
    pub fn pick_all(&mut self, position: [f32; 2]) -> Vec<BoneIndex> {
        let mut bones = Vec::new();
        let hidden = Arc::clone(&self.look.hidden);
        // Lines are met by coming near.
        match (self.look.skeleton, self.look.bone_look) {
            (true, BoneLook::Lines) => pick_all(self, position, &hidden, &mut bones),
            (true, _) => pick_met(self, position, &hidden, &mut bones),
            (false, _) => {}
        }
        if bones.is_empty()
            && self.look.surface
            && let Some((ray, _)) = self.ray(position)
            && let Some(model) = &self.model
        {
            let skin = self.skin.get_or_insert_with(|| SkinPicker::new(model));
            skin.pick(model, &ray, &hidden, &mut bones);
        }
        if bones.is_empty() {
            pick_all(self, position, &hidden, &mut bones);
        }
        bones
    }

    fn frame_uniform(&self, bounds: &Sphere) -> FrameUniform {
        let (camera, look) = (&self.camera, &self.look);
        let size = self.size().max(Vec2::ONE);
        let eye = match camera.projection {
            Projection::Perspective => camera.eye().extend(1.0),
            Projection::Orthographic => camera.back().extend(0.0),
        };
        let (sin, cos) = camera.yaw.sin_cos();
        let shading = match look.shading {
            Shading::Material => 0.0,
            Shading::Clay => 1.0,
            Shading::Unlit => 2.0,
        };
        let [top, bottom] = look
            .background
            .map(|color| (Vec3::from(color) * self.background_alpha).extend(self.background_alpha));
        let (spacing, appeared) = grid_spacing(camera.distance);
        // A high eye sees far; the ground should not end under it.
        let radius = camera.distance.max(camera.eye().y.abs()) * 5.0;
        FrameUniform {
            clip_from_world: self.clip_from_world(bounds),
            view_from_world: camera.view_from_world(),
            eye,
            size: Vec4::new(size.x, size.y, 1.0 / size.x, 1.0 / size.y),
            studio: Vec4::new(cos, sin, shading, 0.0),
            background_top: top,
            background_bottom: bottom,
            grid_color: Vec3::from(look.grid_color).extend(appeared),
            grid: Vec4::new(camera.target.x, camera.target.z, radius, spacing),
            bone_color: Vec3::from(look.bone_color).extend(1.0),
            accent: Vec3::from(look.accent).extend(1.0),
        }
    }

    /// Bounds of the model at rest; nothing, in the origin, without one.
    pub fn bounds(&self) -> Bounds {
        self.model.as_ref().map_or_else(Bounds::default, |model| *model.bounds())
    }
}

/// Distance between the fine lines of the ground, a power of ten, and how far they have appeared, 0..1.
fn grid_spacing(distance: f32) -> (f32, f32) {
    let level = (distance * 0.5).max(1e-6).log10();
    (10f32.powf(level.floor() - 1.0), 1.0 - (level - level.floor()))
}
