//! Small pictures of shots: what is asked for, and the answer.

use dragonfly_anim::stage::StagePlan;
use image::RgbaImage;
use std::sync::Arc;

/// A small picture of the scene of a script through one of its cameras.
#[derive(Clone, Debug, PartialEq)]
pub struct ThumbnailOrder {
    /// Id of the camera.
    pub camera: Arc<str>,
    /// Time in the scene, seconds.
    pub time: f64,
    /// Width and height, pixels.
    pub size: [u32; 2],
}

/// A small picture that was drawn, and the plan that it shows.
#[derive(Clone, Debug)]
pub struct Thumbnail {
    /// The order.
    pub order: ThumbnailOrder,
    /// The plan of the scene that was shown, which may be another one than the sender knew; `None` where no scene was shown.
    pub plan: Option<Arc<StagePlan>>,
    /// The picture, opaque; `None` where it could not be drawn.
    pub picture: Option<RgbaImage>,
}
