//! The scene on the processor: model, camera, look, time and pose.
//!
//! Everything a frame needs is computed into memory allocated when the model is shown, so playing allocates nothing.

use super::accumulation::{LensShift, SubFrame, moved_image};
use super::appearance::Appearances;
use super::around::PosedAround;
use super::batch::DrawBatch;
use super::cast::{PosedScene, ThroughCamera, made_model};
use super::contact::{ShadowedGround, add_spots};
use super::control::{ControlFrame, SceneControls};
use super::draw_set::DrawSet;
use super::frustum::ViewFrustum;
use super::message::{Look, SecondView, Shading};
use super::posed::PosedModel;
use super::shadow::{SceneShadows, ShadowedFrame, sun_side};
use super::skin::SkinPicker;
use super::thumbnail::ThumbnailOrder;
use super::uniform::{FrameUniform, LIGHTS, LightUniform, SPOTS};
use crate::camera::{Camera, CameraRay, Projection};
use crate::playback::PlaybackClock;
use dragonfly_anim::bounds::{AxisBox, Bounds, Sphere};
use dragonfly_anim::data::{BoneIndex, ModelData};
use dragonfly_document::{LoadedModel, SceneView, View};
use glam::{Mat4, Vec2, Vec3, Vec4};
use std::sync::Arc;
use std::time::Instant;

/// Number of spots of the contact shadow of a model.
const MODEL_SPOTS: usize = 16;

/// The scene.
pub struct Scene {
    /// The free camera, which shows the scene unless it is seen through one of its own.
    pub camera: Camera,
    /// The look of the viewport.
    pub look: Look,
    /// Take and time.
    pub playback: PlaybackClock,
    /// Alpha of the background; less than one only in images for other programs.
    pub background_alpha: f32,
    /// The data set for controls and passes.
    pub appearances: Appearances,
    /// The controls of the scene.
    pub controls: SceneControls,
    /// Side of each map of the shadows of a sun, texels.
    pub shadow_side: u32,
    model: Option<PosedModel>,
    /// The things of a script, which are shown in place of the model.
    cast: Option<PosedScene>,
    /// The scene around a model that is edited in it.
    around: Option<PosedAround>,
    /// The camera of the frame prepared last.
    seen: Camera,
    skin: Option<SkinPicker>,
    /// The view that is shown.
    shown: Option<View>,
    /// Bones that are shown at rest.
    still: Vec<BoneIndex>,
    shadows: SceneShadows,
    uniform: FrameUniform,
    /// Whether handles, lines and helpers are left out of the frame that is prepared.
    is_plain: bool,
    /// The sub-frame that is prepared, where a frame is the mean of several.
    sub_frame: Option<SubFrame>,
    /// Its point of the lens.
    lens: Option<LensShift>,
}

impl Scene {
    /// An empty scene.
    pub fn new(now: Instant) -> Self {
        Self {
            camera: Camera::default(),
            look: Look::default(),
            playback: PlaybackClock::rest(now),
            background_alpha: 1.0,
            appearances: Appearances::default(),
            controls: SceneControls::default(),
            shadow_side: sun_side(false),
            model: None,
            cast: None,
            around: None,
            seen: Camera::default(),
            skin: None,
            shown: None,
            still: Vec::new(),
            shadows: SceneShadows::default(),
            uniform: bytemuck::Zeroable::zeroed(),
            is_plain: false,
            sub_frame: None,
            lens: None,
        }
    }

    /// Shows `view` from now on. If the model is the same, only the takes are replaced. The scene of a script is shown in place of the
    /// model, as long as it has a plan.
    pub fn show(&mut self, view: &View) {
        let before = self.cast.take();
        let hidden = &self.look.hidden_things;
        self.cast = view.scene.as_deref().and_then(|scene| PosedScene::new(scene, hidden, before));
        match &mut self.model {
            Some(model) if Arc::ptr_eq(model.loaded(), &view.loaded) => model.show_takes(view, &self.still),
            _ => {
                let mut model = PosedModel::new(Arc::clone(&view.loaded));
                self.skin = None;
                model.show_takes(view, &self.still);
                self.model = Some(model);
            }
        }
        self.shown = Some(view.clone());
    }

    /// Sets the look of the viewport.
    pub fn set_look(&mut self, look: Look) {
        let hides_others = look.hidden_things != self.look.hidden_things;
        if look.around != self.look.around {
            let before = self.around.take();
            self.around = look.around.as_ref().and_then(|around| PosedAround::new(around, before));
        }
        self.look = look;
        if hides_others && let Some(view) = self.shown.take() {
            self.show(&view);
        }
    }

    /// Shows these bones at rest, and all others animated.
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

    /// Shows a scene of a script as it is.
    pub fn show_scene(&mut self, scene: &Arc<SceneView>) {
        let nothing = Arc::new(made_model("scene", ModelData::default()));
        self.show(&View { scene: Some(Arc::clone(scene)), ..View::opened(0, nothing) });
    }

    /// The model in the pose prepared last.
    pub fn model(&self) -> Option<&PosedModel> {
        self.model.as_ref()
    }

    /// The model, unless the scene of a script is shown in its place.
    pub fn model_in_view(&self) -> Option<&PosedModel> {
        self.model.as_ref().filter(|_| self.cast.is_none())
    }

    /// The things of a script at the time prepared last; `None` where a model is shown.
    pub fn cast(&self) -> Option<&PosedScene> {
        self.cast.as_ref()
    }

    pub(crate) fn cast_mut(&mut self) -> Option<&mut PosedScene> {
        self.cast.as_mut()
    }

    /// The camera of the frame prepared last: the free one, or that of the scene through which the look asks to see.
    pub fn seen(&self) -> &Camera {
        &self.seen
    }

    /// The sub-frame that was prepared last; `None` where a frame is drawn once.
    pub fn sub_frame(&self) -> Option<&SubFrame> {
        self.sub_frame.as_ref()
    }

    /// Sets the sub-frame that is prepared next.
    pub fn set_sub_frame(&mut self, sub_frame: Option<SubFrame>) {
        self.sub_frame = sub_frame;
    }

    /// Returns what is drawn: the model, or the models of the things of a script.
    pub fn draw_sets(&self) -> impl Iterator<Item = &DrawSet> + Clone {
        let model = self.model_in_view().map(PosedModel::draws);
        let scenes = self.cast.iter().chain(self.around_in_view());
        model.into_iter().chain(scenes.flat_map(PosedScene::draw_sets))
    }

    /// The draw calls of blended surfaces, farthest first.
    pub(crate) fn blended_runs(&self) -> impl Iterator<Item = (&DrawSet, &[DrawBatch])> {
        let of_model = self.model_in_view().map(|model| (model.draws(), model.batches().blended()));
        // Most of the scene is farther away than the model.
        let of_scenes = self.around_in_view().into_iter().chain(&self.cast);
        of_scenes.flat_map(PosedScene::blended_runs).chain(of_model)
    }

    /// The scene around the model that is shown.
    fn around_in_view(&self) -> Option<&PosedScene> {
        self.around.as_ref().filter(|_| self.cast.is_none()).map(PosedAround::scene)
    }

    /// Returns whether the scene changes by itself after `now`.
    pub fn moves(&self, now: Instant) -> bool {
        self.playback.moves(now) && (self.model.is_some() || self.cast.is_some())
    }

    /// The view that is shown.
    pub fn view(&self) -> Option<&View> {
        self.shown.as_ref()
    }

    /// Bones that are shown at rest.
    pub fn still(&self) -> &[BoneIndex] {
        &self.still
    }

    /// The shadows of the frame prepared last; `None` without any.
    pub fn shadows(&self) -> Option<&SceneShadows> {
        Some(&self.shadows).filter(|shadows| !shadows.is_empty())
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

    /// Computes everything for a frame at `now`. Allocates nothing.
    pub fn prepare(&mut self, now: Instant) {
        let time = self.playback.time_at(now);
        if let Some(cast) = &mut self.cast {
            cast.pose(self.playback.seconds_at(now));
        } else if let Some(around) = &mut self.around {
            around.pose(self.playback.take, self.playback.seconds_at(now));
        }
        let size = self.size();
        let through =
            self.cast.as_ref().and_then(|cast| cast.camera(&self.look.through, size.x / size.y.max(1.0)));
        self.seen = through.unwrap_or(self.camera);
        self.lens = self.lens_shift();
        let (eye, back) = (self.seen.eye(), self.seen.back());
        if let Some(model) = &mut self.model {
            if self.cast.is_none() {
                model.pose(self.playback.take, time, !self.playback.moves(now));
                model.sort(eye, back);
                model.place_bones(&self.look);
            }
            let (camera, look, appearances) = (&self.seen, &self.look, &self.appearances);
            let cast = self.cast.as_ref();
            if self.is_plain {
                self.controls.clear();
            } else {
                self.controls.present(&ControlFrame { model, cast, camera, look, appearances });
            }
        }
        self.shadows = self.frame_shadows();
        self.uniform = self.frame_uniform();
        let frustum = self.frustum();
        match (&mut self.cast, &mut self.model) {
            (Some(cast), _) => cast.batch(eye, back, &frustum),
            (None, Some(model)) => {
                model.batch(&frustum);
                if let Some(around) = &mut self.around {
                    around.scene_mut().batch(eye, back, &frustum);
                }
            }
            (None, None) => {}
        }
        self.batch_casters();
    }

    /// Collects the draw calls of what casts shadows.
    fn batch_casters(&mut self) {
        if self.shadows.is_empty() {
            return;
        }
        match (&mut self.cast, &mut self.model) {
            (Some(cast), _) => cast.batch_casters(self.shadows.frusta()),
            (None, Some(model)) => {
                model.batch_casters(self.shadows.frusta());
                if let Some(around) = &mut self.around {
                    around.scene_mut().batch_casters(self.shadows.frusta());
                }
            }
            (None, None) => {}
        }
    }

    /// Computes everything for the second view at `now`. Returns the look of the viewport, to be set again after it was drawn; `None`
    /// without a second view.
    pub(crate) fn prepare_second(&mut self, now: Instant) -> Option<Look> {
        let second = self.look.second.clone().filter(|_| self.cast.is_some())?;
        // Lines and helpers of the free camera stay while the pointer is in the other view.
        let shows = second.through == ThroughCamera::Free;
        Some(self.prepare_beside(second, shows, now))
    }

    /// Computes everything for a small picture. Returns the look and the playback of the viewport, to be set again after it was drawn.
    pub(crate) fn prepare_thumbnail(
        &mut self,
        order: &ThumbnailOrder,
        now: Instant,
    ) -> (Look, PlaybackClock) {
        let still = PlaybackClock { anchor_time: order.time, ..PlaybackClock::rest(now) };
        let playback = std::mem::replace(&mut self.playback, still);
        let [width, height] = order.size;
        let through = ThroughCamera::Of(Arc::clone(&order.camera));
        let view = SecondView { viewport: [0, 0, width, height], through, camera: self.camera };
        (self.prepare_beside(view, false, now), playback)
    }

    /// Computes everything for a view apart from the viewport; handles, lines and helpers where it `shows` them. Returns the look of the viewport.
    fn prepare_beside(&mut self, view: SecondView, shows: bool, now: Instant) -> Look {
        let own = Look {
            viewport: view.viewport,
            through: view.through,
            helpers: self.look.helpers && shows,
            skeleton: self.look.skeleton && shows,
            second: None,
            ..self.look.clone()
        };
        let look = std::mem::replace(&mut self.look, own);
        let camera = std::mem::replace(&mut self.camera, view.camera);
        self.is_plain = !shows;
        self.prepare(now);
        self.is_plain = false;
        self.camera = camera;
        look
    }

    /// The part of the scene that this frame shows, as prepared last.
    pub fn frustum(&self) -> ViewFrustum {
        ViewFrustum::new(&self.uniform.clip_from_world)
    }

    /// Transforms scene space to clip space for the present camera and viewport.
    pub fn clip_from_world(&self, bounds: &Sphere) -> Mat4 {
        let size = self.size();
        self.seen.clip_from_view(size.x / size.y.max(1.0), bounds) * self.seen.view_from_world()
    }

    /// Returns the point of the lens of the sub-frame; `None` for a camera that has everything in focus.
    fn lens_shift(&self) -> Option<LensShift> {
        let point = self.sub_frame?.lens;
        let camera = self.cast.as_ref()?.stage_camera(&self.look.through)?;
        LensShift::new(&camera, point)
    }

    /// Transforms scene space to clip space as the frame is drawn, or the sub-frame.
    fn drawn_clip_from_world(&self, bounds: &Sphere) -> Mat4 {
        let Some(sub_frame) = self.sub_frame else { return self.clip_from_world(bounds) };
        let size = self.size();
        let clip_from_view = self.seen.clip_from_view(size.x / size.y.max(1.0), bounds);
        let shear = self.lens.map_or(Mat4::IDENTITY, |lens| lens.shear());
        moved_image(sub_frame.pixel, size) * clip_from_view * shear * self.seen.view_from_world()
    }

    /// The line of sight through a pixel of the window, and that pixel within the viewport; `None` outside of it.
    pub fn ray(&self, position: [f32; 2]) -> Option<(CameraRay, Vec2)> {
        let [x, y, ..] = self.look.viewport;
        let size = self.size();
        let pixel = Vec2::from(position) - Vec2::new(x as f32, y as f32);
        let inside = pixel.cmpge(Vec2::ZERO).all() && pixel.cmplt(size).all();
        inside.then(|| (self.seen.ray(pixel, size), pixel))
    }

    /// Returns the model and the picker of its skin, which is created when it is first needed; `None` where none is shown.
    pub(crate) fn skin_picker(&mut self) -> Option<(&PosedModel, &mut SkinPicker)> {
        let model = self.model.as_ref().filter(|_| self.cast.is_none())?;
        Some((model, self.skin.get_or_insert_with(|| SkinPicker::new(model))))
    }

    fn frame_uniform(&self) -> FrameUniform {
        let (camera, look) = (&self.seen, &self.look);
        let bounds = self.drawn_bounds();
        let size = self.size().max(Vec2::ONE);
        let eye = match camera.projection {
            Projection::Perspective => {
                let middle = camera.eye();
                self.lens.map_or(middle, |lens| middle + lens.in_scene(camera)).extend(1.0)
            }
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
        // A high camera sees far; the ground must not end below it.
        let ground = self.cast.as_ref().map_or(0.0, |cast| cast.ground());
        let radius = camera.distance.max((camera.eye().y - ground).abs()) * 5.0;
        let (contact, spot_count) = self.contact(self.bounds().sphere.radius);
        let mut lights = [LightUniform::default(); LIGHTS];
        let light_count = self.cast.as_ref().map_or(0, |cast| cast.write_lights(&mut lights));
        self.shadows.mark(&mut lights);
        let sampling =
            self.sub_frame.map_or(Vec4::ZERO, |sub_frame| Vec4::new(1.0, sub_frame.threshold, 0.0, 0.0));
        // A sun fills the shadows less than the lamps of a studio do.
        let ambient = if light_count > 0 { 0.5 } else { 1.0 };
        FrameUniform {
            clip_from_world: self.drawn_clip_from_world(&bounds),
            view_from_world: camera.view_from_world(),
            eye,
            size: Vec4::new(size.x, size.y, 1.0 / size.x, 1.0 / size.y),
            studio: Vec4::new(cos, sin, shading, f32::from(u8::from(look.grid))),
            background_top: top,
            background_bottom: bottom,
            grid_color: Vec3::from(look.grid_color).extend(appeared),
            grid: Vec4::new(camera.target.x, camera.target.z, radius, spacing),
            bone_color: Vec3::from(look.bone_color).extend(1.0),
            accent: Vec3::from(look.accent).extend(1.0),
            sampling,
            contact,
            counts: Vec4::new(light_count as f32, ambient, spot_count as f32, ground),
            lights,
        }
    }

    /// Returns the spots of the contact shadow, and how many may be used.
    fn contact(&self, radius: f32) -> ([Vec4; SPOTS], usize) {
        let mut spots = [Vec4::ZERO; SPOTS];
        if !(self.look.contact_shadow && self.look.surface) {
            return (spots, 0);
        }
        if let Some(cast) = &self.cast {
            return (*cast.spots(), SPOTS);
        }
        if let Some(model) = &self.model {
            let ground = ShadowedGround { radius, height: 0.0 };
            add_spots(&mut spots[..MODEL_SPOTS], model.part_boxes(), model.palettes(), ground);
        }
        (spots, MODEL_SPOTS)
    }

    /// Returns the shadows of a frame: those of the lights of a scene, or of the studio, as the look asks for them.
    fn frame_shadows(&self) -> SceneShadows {
        let (look, effects) = (&self.look, self.look.effects);
        let may_be = effects.studio_shadows || effects.shadows && self.cast.is_some();
        if !may_be || !look.surface || look.shading == Shading::Unlit {
            return SceneShadows::default();
        }
        let size = self.size();
        SceneShadows::of(&ShadowedFrame {
            effects,
            camera: &self.seen,
            aspect: size.x / size.y.max(1.0),
            drawn: self.drawn_bounds(),
            casters: self.posed_bounds(),
            lights: self.cast.as_ref().map_or(&[][..], PosedScene::lights),
            light_point: self.sub_frame.map_or(Vec2::ZERO, |sub_frame| sub_frame.light),
            side: self.shadow_side,
        })
    }

    /// Returns a sphere around everything that is drawn, as it is posed.
    fn posed_bounds(&self) -> Sphere {
        let model = || self.model.as_ref().map_or(AxisBox::EMPTY, |model| model.draws().box_of(0));
        let own = match &self.cast {
            Some(cast) => cast.bounds().sphere,
            None => around_box(&model()),
        };
        self.with_around(own)
    }

    /// Returns a sphere around everything that is drawn.
    fn drawn_bounds(&self) -> Sphere {
        self.with_around(self.bounds().sphere)
    }

    /// Returns a sphere around `own` and the scene around the model.
    fn with_around(&self, own: Sphere) -> Sphere {
        let Some(around) = self.around_in_view().map(|around| around.bounds().sphere) else { return own };
        let radius = own.radius.max(own.center.distance(around.center) + around.radius);
        Sphere { radius, ..own }
    }

    /// Bounds of the model at rest, or of the things of a script at the time prepared last; empty, at the origin, without either.
    pub fn bounds(&self) -> Bounds {
        if let Some(cast) = &self.cast {
            return *cast.bounds();
        }
        self.model.as_ref().map_or_else(Bounds::default, |model| *model.bounds())
    }
}

/// Returns a sphere around a box; one without size where that is empty.
fn around_box(around: &AxisBox) -> Sphere {
    if around.is_empty() {
        return Sphere::default();
    }
    Sphere { center: around.center(), radius: around.half().length() }
}

/// Distance between the fine lines of the ground, a power of ten, and their fade-in, 0..1.
fn grid_spacing(distance: f32) -> (f32, f32) {
    let level = (distance * 0.5).max(1e-6).log10();
    (10f32.powf(level.floor() - 1.0), 1.0 - (level - level.floor()))
}
