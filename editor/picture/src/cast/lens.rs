//! Cameras of a script as cameras of a viewport.

use crate::camera::{Camera, Projection};
use dragonfly_anim::bounds::Sphere;
use dragonfly_anim::stage::StageCamera;
use glam::Vec3;

/// Half the width of the image of a camera in millimeters, to which its focal length refers.
const HALF_IMAGE: f32 = 18.0;

/// Returns the camera of a viewport that shows what `seen` sees in an image with the ratio `image` of width to height. A viewport with
/// another ratio shows all of that, and more above and below or at the sides. `bounds` are those of the scene.
pub fn camera(seen: &StageCamera, image: f32, viewport: f32, bounds: &Sphere) -> Camera {
    let [right, back] = [Vec3::X, Vec3::Z].map(|axis| seen.rotation * axis);
    let pitch = back.y.clamp(-1.0, 1.0).asin();
    let level = Vec3::new(back.x, 0.0, back.z);
    // For a camera that looks straight up or down, the yaw follows from the direction to the right.
    let yaw = if level.length_squared() > 1e-12 { back.x.atan2(back.z) } else { (-right.z).atan2(right.x) };
    let half_height = HALF_IMAGE / seen.lens.max(0.1) / viewport.min(image).max(1e-3);
    let away = (seen.position - bounds.center).dot(back);
    let distance = if away.is_finite() { away.clamp(1.0, 1e6) } else { 1.0 };
    let mut camera = Camera {
        target: seen.position - back * distance,
        distance,
        yaw,
        pitch,
        roll: 0.0,
        field_of_view: 2.0 * half_height.atan(),
        projection: Projection::Perspective,
    };
    let (level, up) = (camera.right(), camera.up());
    camera.roll = right.dot(up).atan2(right.dot(level));
    camera
}
