//! Pictures without a window: the same scene, passes and frames.

use super::device::{DeviceParameters, GraphicsError};
use super::message::{Look, Shading};
use super::stage::{Opened, Stage};
use crate::camera::Camera;
use crate::playback::Playback;
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_document::LoadedModel;
use image::RgbaImage;
use std::sync::Arc;
use std::time::Instant;

/// What a picture shows.
#[derive(Clone, Debug)]
pub struct PictureSettings {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Position in the model's takes; `None` shows the rest pose.
    pub take: Option<usize>,
    /// Seconds, clamped to the take.
    pub time: f32,
    /// Radians; 0 from the front.
    pub yaw: f32,
    /// Radians; positive from above.
    pub pitch: f32,
    /// From where instead, for several pictures that belong together; yaw and pitch then say nothing.
    pub camera: Option<Camera>,
    /// sRGB and alpha instead of the gradient.
    pub background: Option<[u8; 4]>,
    /// Bones over the surface.
    pub skeleton: bool,
    /// Ground grid.
    pub grid: bool,
    /// Everything else about the look; its viewport, background, skeleton and grid are not used.
    pub look: Look,
}

impl Default for PictureSettings {
    /// The first moment of the first take, from the front, a little right and above.
    fn default() -> Self {
        let camera = Camera::default();
        Self {
            size: [1024, 768],
            take: Some(0),
            time: 0.0,
            yaw: camera.yaw,
            pitch: camera.pitch,
            camera: None,
            background: None,
            skeleton: false,
            grid: true,
            look: Look { shading: Shading::Material, ..Look::default() },
        }
    }
}

/// One picture of `loaded`.
pub fn render_picture(
    loaded: &Arc<LoadedModel>,
    settings: &PictureSettings,
) -> Result<RgbaImage, GraphicsError> {
    Studio::new()?.render(loaded, settings)
}

/// Makes pictures one after the other with one device.
pub struct Studio {
    stage: Stage,
    shown: Option<Arc<LoadedModel>>,
}

impl Studio {
    /// On the machine's best adapter.
    pub fn new() -> Result<Self, GraphicsError> {
        Self::with(DeviceParameters::default())
    }

    /// On what `parameters` say.
    pub fn with(parameters: DeviceParameters) -> Result<Self, GraphicsError> {
        Ok(Self { stage: Stage::new(parameters, Instant::now())?, shown: None })
    }

    /// The stage, for tests that do things to it.
    pub fn stage(&mut self) -> &mut Stage {
        &mut self.stage
    }

    /// A camera that sees all of `loaded` at rest.
    pub fn camera(&mut self, loaded: &Arc<LoadedModel>, settings: &PictureSettings) -> Camera {
        self.show(loaded);
        self.framing(settings, false)
    }

    /// A picture of `loaded`. A device lost meanwhile is made anew and the picture tried again.
    pub fn render(
        &mut self,
        loaded: &Arc<LoadedModel>,
        settings: &PictureSettings,
    ) -> Result<RgbaImage, GraphicsError> {
        let [width, height] = settings.size;
        let limit = self.stage.device().gpu().max_side;
        if width == 0 || height == 0 || width.max(height) > limit {
            return Err(GraphicsError::PictureSize { width, height, limit });
        }
        self.show(loaded);
        let now = Instant::now();
        self.arrange(settings, now);
        let errors = self.stage.device().errors();
        let mut trouble = String::new();
        for _ in 0..3 {
            self.stage.touch_scene();
            match self.stage.whole_frame(now) {
                Opened::Frame => match self.stage.read_scene() {
                    Ok(picture) => {
                        let new = self.stage.device().errors() - errors;
                        return if new == 0 { Ok(finish(picture)) } else { Err(GraphicsError::Refused(new)) };
                    }
                    Err(error) => trouble = error,
                },
                Opened::Nothing => trouble = "nothing could be drawn".to_owned(),
                Opened::Gone(error) => return Err(error),
            }
        }
        Err(GraphicsError::Lost(trouble))
    }

    fn show(&mut self, loaded: &Arc<LoadedModel>) {
        if self.shown.as_ref().is_none_or(|shown| !Arc::ptr_eq(shown, loaded)) {
            self.stage.scene.show_model(Arc::clone(loaded));
            self.shown = Some(Arc::clone(loaded));
        }
    }

    fn arrange(&mut self, settings: &PictureSettings, now: Instant) {
        let [width, height] = settings.size;
        self.stage.resize(settings.size);
        let scene = &mut self.stage.scene;
        scene.look = Look {
            viewport: [0, 0, width, height],
            skeleton: settings.skeleton,
            grid: settings.grid,
            ..settings.look.clone()
        };
        scene.background_alpha = 1.0;
        if let Some([red, green, blue, alpha]) = settings.background {
            let color = [red, green, blue].map(|value| linear(f32::from(value) / 255.0));
            scene.look.background = [color; 2];
            scene.background_alpha = f32::from(alpha) / 255.0;
        }
        let mut playback = Playback { take: settings.take, ..Playback::rest(now) };
        let takes = self.shown.as_ref().map_or(&[][..], |shown| &shown.model.animation.takes);
        if let Some(take) = settings.take.and_then(|take| takes.get(take)) {
            (playback.start, playback.length) = (take.start, take.length);
        }
        scene.playback = playback.seek(settings.time, now);
        scene.prepare(now);
        let camera = settings.camera.unwrap_or_else(|| self.framing(settings, true));
        self.stage.scene.camera = camera;
    }

    /// Frames the model in its present pose, or at rest.
    fn framing(&self, settings: &PictureSettings, posed: bool) -> Camera {
        let mut camera = Camera { yaw: settings.yaw, pitch: settings.pitch, ..Camera::default() };
        let [width, height] = settings.size.map(|side| side.max(1) as f32);
        if let Some(model) = self.stage.scene.model() {
            let mut evaluator = Evaluator::new(Arc::clone(&model.loaded().model));
            let playback = &self.stage.scene.playback;
            if posed {
                evaluator.pose(playback.take, playback.time_at(playback.anchor));
            }
            let mut points = evaluator.all_positions();
            if points.is_empty() {
                points.extend(evaluator.to_root().iter().map(|to_root| to_root.w_axis.truncate()));
            }
            camera.frame_points(&points, width / height);
            // Air around, so that nothing touches the edge of the picture.
            camera.dolly(1.12);
        }
        camera
    }
}

/// Colours in the scene are multiplied by alpha in linear light; a picture file wants them as they are.
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

/// sRGB's curve, undone.
fn linear(value: f32) -> f32 {
    if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
}

/// sRGB's curve.
fn encoded(light: f32) -> f32 {
    if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}
