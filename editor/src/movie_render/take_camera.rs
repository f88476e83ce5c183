//! A camera that shows all of a take.

use dragonfly_anim::evaluator::Evaluator;
use dragonfly_document::LoadedModel;
use dragonfly_picture::PictureSettings;
use dragonfly_picture::camera::Camera;
use std::sync::Arc;

/// Largest number of poses that are looked at: enough for a minute, and those of longer takes are spread over them.
const MOST_POSES: usize = 1_500;

/// Number of poses that are looked at however many vertices there are.
const LEAST_POSES: usize = 100;

/// Largest number of vertices that are looked at in further poses: about a second.
const MOST_VERTICES: usize = 20_000_000;

/// Distance of the camera, as in images of one pose, so that nothing touches the edge.
const MARGIN: f32 = 1.12;

/// Returns a camera with the angles of `settings` that has the model in view during a whole take; `frames` is the number of its frames.
pub fn take_camera(loaded: &LoadedModel, take: usize, frames: u64, settings: &PictureSettings) -> Camera {
    let mut camera = Camera { yaw: settings.yaw, pitch: settings.pitch, ..Camera::default() };
    let Some(played) = loaded.model.animation.takes.get(take) else { return camera };
    let [width, height] = settings.size.map(|side| side.max(1) as f32);
    let mut evaluator = Evaluator::new(Arc::clone(&loaded.model));
    let affordable = (MOST_VERTICES / evaluator.outline().len().max(1)).max(LEAST_POSES);
    let poses = usize::try_from(frames).unwrap_or(MOST_POSES).min(MOST_POSES).min(affordable);
    let last = poses.saturating_sub(1).max(1) as f32;
    let mut outermost = Vec::new();
    for pose in 0..poses {
        evaluator.pose(Some(take), played.start + played.length * (pose as f32 / last));
        outermost.extend(evaluator.outline());
        outermost = camera.outermost(&outermost, width / height);
    }
    camera.frame_points(&outermost, width / height);
    camera.dolly(MARGIN);
    camera
}
