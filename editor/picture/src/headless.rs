//! Rendering images without a window, with the same scene, passes and frames.

use super::accumulation::{FrameSampling, SampledFrame};
use super::control::{LineAppearance, LineLook};
use super::device::DeviceParameters;
use super::error::GraphicsError;
use super::message::{Look, Shading};
use super::stage::{FrameOpening, RenderStage};
use super::titles::TitleDrawer;
use crate::camera::Camera;
use crate::cast::ThroughCamera;
use crate::playback::PlaybackClock;
use dragonfly_anim::bounds::AxisBox;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::stage::time::StageTime;
use dragonfly_document::{LoadedModel, SceneView};
use image::{Rgba32FImage, RgbaImage};
use std::sync::Arc;
use std::time::Instant;

/// Settings of an image.
#[derive(Clone, Debug)]
pub struct PictureSettings {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Index of the take; `None` shows the rest pose.
    pub take: Option<usize>,
    /// Time in the take, seconds, clamped to the take; of a scene, any time.
    pub time: f32,
    /// Exact time of a scene, in place of [`Self::time`].
    pub moment: Option<StageTime>,
    /// Yaw of the camera, radians; 0 from the front.
    pub yaw: f32,
    /// Pitch of the camera, radians; positive from above.
    pub pitch: f32,
    /// Camera to use instead of yaw and pitch, for several images that belong together.
    pub camera: Option<Camera>,
    /// Background, sRGB and alpha, instead of the gradient.
    pub background: Option<[u8; 4]>,
    /// Whether bones are drawn over the surface.
    pub skeleton: bool,
    /// Whether the ground grid is drawn.
    pub grid: bool,
    /// Sub-frames of which the image is the mean.
    pub sampling: FrameSampling,
    /// Everything else about the look; its viewport, background, skeleton and grid are ignored.
    pub look: Look,
}

impl Default for PictureSettings {
    /// The first time of the first take, from the front, slightly from the right and above.
    fn default() -> Self {
        let camera = Camera::default();
        Self {
            size: [1024, 768],
            take: Some(0),
            time: 0.0,
            moment: None,
            yaw: camera.yaw,
            pitch: camera.pitch,
            camera: None,
            background: None,
            skeleton: false,
            grid: true,
            sampling: FrameSampling::default(),
            look: Look { shading: Shading::Material, ..Look::default() },
        }
    }
}

/// Renders one image of `loaded`.
pub fn render_picture(
    loaded: &Arc<LoadedModel>,
    settings: &PictureSettings,
) -> Result<RgbaImage, GraphicsError> {
    Studio::new()?.render(loaded, settings)
}

/// What an image is of.
enum StudioSubject {
    Model(Arc<LoadedModel>),
    Scene(Arc<SceneView>),
}

/// Renders images one after another with one device.
pub struct Studio {
    stage: RenderStage,
    shown: Option<StudioSubject>,
    titles: TitleDrawer,
}

impl Studio {
    /// Creates a device on the computer's best adapter.
    pub fn new() -> Result<Self, GraphicsError> {
        Self::with(DeviceParameters::default())
    }

    /// Creates a device with `parameters`.
    pub fn with(parameters: DeviceParameters) -> Result<Self, GraphicsError> {
        let mut stage = RenderStage::new(parameters, Instant::now())?;
        stage.load_at_once(true);
        Ok(Self { stage, shown: None, titles: TitleDrawer::default() })
    }

    /// Returns whether the edges of surfaces are smooth; not on an adapter without multisampling.
    pub fn is_smooth(&mut self) -> bool {
        self.stage.device().gpu().samples > 1
    }

    /// Returns the warnings about images of the models rendered since the last call.
    pub fn take_warnings(&mut self) -> Vec<String> {
        self.stage.take_warnings()
    }

    /// The stage, for tests that manipulate it.
    pub fn stage(&mut self) -> &mut RenderStage {
        &mut self.stage
    }

    /// Returns a camera that frames all of `loaded` at rest.
    pub fn camera(&mut self, loaded: &Arc<LoadedModel>, settings: &PictureSettings) -> Camera {
        self.show(loaded);
        self.framing(settings, false)
    }

    /// Renders an image of `loaded`. If the device is lost, it is created again and the image is rendered again.
    pub fn render(
        &mut self,
        loaded: &Arc<LoadedModel>,
        settings: &PictureSettings,
    ) -> Result<RgbaImage, GraphicsError> {
        self.check_size(settings)?;
        self.show(loaded);
        self.draw(settings)
    }

    /// Renders the light of an image before the tone map: linear and multiplied by alpha, as OpenEXR files contain it. Otherwise as by
    /// [`Self::render`].
    pub fn render_linear(
        &mut self,
        loaded: &Arc<LoadedModel>,
        settings: &PictureSettings,
    ) -> Result<Rgba32FImage, GraphicsError> {
        self.check_size(settings)?;
        self.show(loaded);
        self.draw_linear(settings)
    }

    /// Renders an image of the scene of a script, with its titles, otherwise as by [`Self::render`]. The take is ignored. A scene without
    /// a plan is empty.
    pub fn render_scene(
        &mut self,
        scene: &Arc<SceneView>,
        settings: &PictureSettings,
    ) -> Result<RgbaImage, GraphicsError> {
        self.check_size(settings)?;
        self.show_scene(scene);
        let mut picture = self.draw(settings)?;
        if let Some(cast) = self.stage.scene.cast() {
            self.titles.draw(cast, &mut picture);
        }
        Ok(picture)
    }

    /// Renders the light of the scene of a script as by [`Self::render_linear`], with its titles.
    pub fn render_scene_linear(
        &mut self,
        scene: &Arc<SceneView>,
        settings: &PictureSettings,
    ) -> Result<Rgba32FImage, GraphicsError> {
        self.check_size(settings)?;
        self.show_scene(scene);
        let mut picture = self.draw_linear(settings)?;
        if let Some(cast) = self.stage.scene.cast().filter(|cast| !cast.state().titles.is_empty()) {
            let mut titles = RgbaImage::new(picture.width(), picture.height());
            self.titles.draw(cast, &mut titles);
            put_over(&titles, &mut picture);
        }
        Ok(picture)
    }

    fn show_scene(&mut self, scene: &Arc<SceneView>) {
        let same = |shown: &StudioSubject| match shown {
            StudioSubject::Scene(shown) => Arc::ptr_eq(shown, scene),
            StudioSubject::Model(_) => false,
        };
        if !self.shown.as_ref().is_some_and(same) {
            self.stage.scene.show_scene(scene);
            self.shown = Some(StudioSubject::Scene(Arc::clone(scene)));
            let lines = scene.lines.iter().flat_map(|lines| lines.list()).filter(|line| line.is_in_movie);
            let lines = lines.map(|line| LineLook::of_line(line, 0.0)).collect();
            self.stage.scene.appearances.set(LineAppearance { lines, ..LineAppearance::default() });
        }
    }

    fn check_size(&mut self, settings: &PictureSettings) -> Result<(), GraphicsError> {
        let [width, height] = settings.size;
        let limit = self.stage.device().gpu().max_side;
        let is_possible = width > 0 && height > 0 && width.max(height) <= limit;
        if is_possible { Ok(()) } else { Err(GraphicsError::PictureSize { width, height, limit }) }
    }

    fn draw(&mut self, settings: &PictureSettings) -> Result<RgbaImage, GraphicsError> {
        let now = Instant::now();
        self.arrange(settings, now);
        if settings.sampling.count() > 1 {
            let frame = self.sampled_frame(settings)?;
            return self.attempt(|stage| stage.accumulate(&frame, now), RenderStage::read_accumulated);
        }
        let draw = |stage: &mut RenderStage| {
            stage.touch_scene();
            stage.whole_frame(now)
        };
        self.attempt(draw, |stage| stage.read_scene().map(finish))
    }

    fn draw_linear(&mut self, settings: &PictureSettings) -> Result<Rgba32FImage, GraphicsError> {
        let now = Instant::now();
        self.arrange(settings, now);
        let frame = self.sampled_frame(settings)?;
        self.attempt(|stage| stage.accumulate(&frame, now), RenderStage::read_accumulated_light)
    }

    /// Returns the frame of the scene as it was arranged.
    fn sampled_frame(&mut self, settings: &PictureSettings) -> Result<SampledFrame, GraphicsError> {
        let device = self.stage.device();
        if !device.gpu().has_linear_encoding() {
            let lack =
                "draw into floating-point textures, which several samples of a frame and OpenEXR files need";
            return Err(GraphicsError::Unsuitable { adapter: device.adapter_name(), lack });
        }
        let scene = &self.stage.scene;
        let time = StageTime::from_seconds(scene.playback.anchor_time);
        let Some(cast) = scene.cast() else { return Ok(SampledFrame::new(settings.sampling, time)) };
        // A time of single precision means the frame that it is nearest to.
        let time = settings.moment.unwrap_or_else(|| cast.plan().rate().time_of(time.seconds()));
        let frame = SampledFrame::new(settings.sampling, time);
        Ok(match scene.look.through {
            ThroughCamera::Shot => frame.within(cast.plan().uncut_span(time)),
            ThroughCamera::Free | ThroughCamera::Of(_) => frame,
        })
    }

    /// Draws until the device is not lost on the way, and reads what was drawn.
    fn attempt<T>(
        &mut self,
        draw: impl Fn(&mut RenderStage) -> FrameOpening,
        read: impl Fn(&mut RenderStage) -> Result<T, String>,
    ) -> Result<T, GraphicsError> {
        let errors = self.stage.device().errors();
        let mut trouble = String::new();
        for _ in 0..3 {
            match draw(&mut self.stage) {
                FrameOpening::Frame => match read(&mut self.stage) {
                    Ok(picture) => {
                        let new = self.stage.device().errors() - errors;
                        return if new == 0 { Ok(picture) } else { Err(GraphicsError::Refused(new)) };
                    }
                    Err(error) => trouble = error,
                },
                FrameOpening::Nothing => trouble = "nothing could be drawn".to_owned(),
                FrameOpening::Gone(error) => return Err(error),
            }
        }
        Err(GraphicsError::Lost(trouble))
    }

    fn show(&mut self, loaded: &Arc<LoadedModel>) {
        let same = |shown: &StudioSubject| match shown {
            StudioSubject::Model(shown) => Arc::ptr_eq(shown, loaded),
            StudioSubject::Scene(_) => false,
        };
        if !self.shown.as_ref().is_some_and(same) {
            self.stage.scene.show_model(Arc::clone(loaded));
            self.shown = Some(StudioSubject::Model(Arc::clone(loaded)));
        }
    }

    fn arrange(&mut self, settings: &PictureSettings, now: Instant) {
        let [width, height] = settings.size;
        self.stage.resize(settings.size);
        let scene = &mut self.stage.scene;
        scene.set_look(Look {
            viewport: [0, 0, width, height],
            skeleton: settings.skeleton,
            grid: settings.grid,
            contact_shadow: settings.grid && settings.look.contact_shadow,
            ..settings.look.clone()
        });
        scene.background_alpha = 1.0;
        if let Some([red, green, blue, alpha]) = settings.background {
            let color = [red, green, blue].map(|value| linear(f32::from(value) / 255.0));
            scene.look.background = [color; 2];
            scene.background_alpha = f32::from(alpha) / 255.0;
        }
        let mut playback = PlaybackClock { take: settings.take, ..PlaybackClock::rest(now) };
        match &self.shown {
            Some(StudioSubject::Model(shown)) => {
                let takes = &shown.model.animation.takes;
                if let Some(take) = settings.take.and_then(|take| takes.get(take)) {
                    (playback.start, playback.length) = (take.start, take.length);
                }
            }
            Some(StudioSubject::Scene(scene)) => {
                let length = scene.plan.as_ref().map_or(0.0, |plan| plan.length().seconds());
                playback = PlaybackClock::of_scene(length, now);
            }
            None => {}
        }
        scene.playback = playback.seek(settings.time, now);
        if let (Some(StudioSubject::Scene(_)), Some(moment)) = (&self.shown, settings.moment) {
            scene.playback.anchor_time = moment.seconds();
        }
        scene.prepare(now);
        let camera = settings.camera.unwrap_or_else(|| self.framing(settings, true));
        self.stage.scene.camera = camera;
    }

    /// Frames the model in its present pose, or at rest.
    fn framing(&self, settings: &PictureSettings, posed: bool) -> Camera {
        let mut camera = Camera { yaw: settings.yaw, pitch: settings.pitch, ..Camera::default() };
        let [width, height] = settings.size.map(|side| side.max(1) as f32);
        if let Some(cast) = self.stage.scene.cast() {
            let boxes: Vec<_> = (0..cast.plan().things().len()).map(|thing| cast.box_of(thing)).collect();
            let corners: Vec<_> = boxes.iter().flat_map(AxisBox::corners).collect();
            camera.frame_points(&corners, width / height);
            camera.dolly(1.12);
        } else if let Some(model) = self.stage.scene.model() {
            let mut evaluator = Evaluator::new(Arc::clone(&model.loaded().model));
            let playback = &self.stage.scene.playback;
            if posed {
                evaluator.pose(playback.take, playback.time_at(playback.anchor));
            }
            camera.frame_points(&evaluator.outline(), width / height);
            // Leaves a margin, so that nothing touches the edge of the image.
            camera.dolly(1.12);
        }
        camera
    }
}

/// Converts colors that the scene multiplied by alpha in linear light to the straight alpha of image files.
fn finish(mut picture: RgbaImage) -> RgbaImage {
    for pixel in picture.pixels_mut() {
        let alpha = pixel.0[3];
        if alpha == 0 {
            pixel.0 = [0; 4];
        } else if alpha < 255 {
            let factor = 255.0 / f32::from(alpha);
            for value in &mut pixel.0[..3] {
                let light = linear(f32::from(*value) / 255.0) * factor;
                *value = (encoded(light.min(1.0)) * 255.0).round() as u8;
            }
        }
    }
    picture
}

/// Puts an image with straight alpha over light that is multiplied by alpha.
fn put_over(image: &RgbaImage, light: &mut Rgba32FImage) {
    for (over, pixel) in image.pixels().zip(light.pixels_mut()).filter(|(over, _)| over.0[3] > 0) {
        let alpha = f32::from(over.0[3]) / 255.0;
        let [red, green, blue, _] = over.0.map(|value| linear(f32::from(value) / 255.0) * alpha);
        for (value, new) in pixel.0.iter_mut().zip([red, green, blue, alpha]) {
            *value = new + *value * (1.0 - alpha);
        }
    }
}

/// Decodes a value from the sRGB curve.
fn linear(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// Encodes a value with the sRGB curve.
fn encoded(light: f32) -> f32 {
    if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}
