//! Which bone is under the pointer (thesis §2.2.2.3): the line of sight against the bones as they are drawn, in the pose they
//! have; a pointer that just misses gets the nearest bone.

use super::body::{placed, triangles};
use super::scene::Scene;
use super::shape::{Body, BoneInstance, SkeletonShape};
use crate::camera::Ray;
use dragonfly_anim::data::BoneIndex;
use glam::{Mat4, Vec2, Vec3, Vec4Swizzles};

/// A pointer may miss by so many points, which look equally large on every screen.
const REACH: f32 = 10.0;

/// The bone at a pixel of the window, in the pose that `scene` prepared last.
///
/// Bones that are not drawn are met all the same: a click on a leg means the bone inside it.
pub fn pick(scene: &Scene, position: [f32; 2]) -> Option<BoneIndex> {
    let (ray, pixel) = scene.ray(position)?;
    let shape = scene.model()?.shape();
    hit(shape, &ray).or_else(|| nearest(scene, shape, pixel))
}

/// The bone that the ray meets first.
fn hit(shape: &SkeletonShape, ray: &Ray) -> Option<BoneIndex> {
    let mut first: Option<(f32, BoneIndex)> = None;
    for body in Body::ALL {
        let corners = triangles(body);
        for (instance, &bone) in shape.instances(body).iter().zip(shape.owners(body)) {
            if !passes_near(ray, instance) {
                continue;
            }
            for face in corners.chunks_exact(3) {
                let face = [0, 1, 2].map(|corner| placed(&face[corner], instance));
                if let Some(distance) = meets(ray, face)
                    && first.is_none_or(|(nearest, _)| distance < nearest)
                {
                    first = Some((distance, bone));
                }
            }
        }
    }
    first.map(|(_, bone)| bone)
}

/// Does the ray come into the sphere around a bone?
fn passes_near(ray: &Ray, bone: &BoneInstance) -> bool {
    let center = (bone.head + bone.tail) / 2.0;
    let radius = bone.head.distance(bone.tail) / 2.0 + bone.radius * 1.5;
    let towards = center - ray.origin;
    let aside = towards - ray.direction * towards.dot(ray.direction);
    aside.length_squared() <= radius * radius
}

/// Distance along the ray at which it meets a triangle, from either side.
fn meets(ray: &Ray, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (ab, ac) = (b - a, c - a);
    let across = ray.direction.cross(ac);
    let determinant = ab.dot(across);
    // Seen edge on, or a triangle without area.
    if determinant.is_nan() || determinant.abs() <= f32::MIN_POSITIVE {
        return None;
    }
    let from_a = ray.origin - a;
    let u = from_a.dot(across) / determinant;
    let around = from_a.cross(ab);
    let v = ray.direction.dot(around) / determinant;
    let distance = ac.dot(around) / determinant;
    let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0;
    inside.then_some(distance)
}

/// The bone whose line on the screen comes closest to the pixel, if close enough.
fn nearest(scene: &Scene, shape: &SkeletonShape, pixel: Vec2) -> Option<BoneIndex> {
    let clip_from_world = scene.clip_from_world(&scene.bounds().sphere);
    let size = scene.size();
    let reach = REACH * scene.look.pixels_per_point;
    let mut best: Option<(f32, BoneIndex)> = None;
    for body in Body::ALL {
        for (instance, &bone) in shape.instances(body).iter().zip(shape.owners(body)) {
            let ends = [instance.head, instance.tail].map(|end| on_screen(&clip_from_world, end, size));
            let [Some(head), Some(tail)] = ends else { continue };
            let distance = to_segment(pixel, head, tail);
            if distance <= reach && best.is_none_or(|(nearest, _)| distance < nearest) {
                best = Some((distance, bone));
            }
        }
    }
    best.map(|(_, bone)| bone)
}

/// Pixels from the top left of the viewport; `None` behind the eye.
fn on_screen(clip_from_world: &Mat4, point: Vec3, size: Vec2) -> Option<Vec2> {
    let clip = *clip_from_world * point.extend(1.0);
    (clip.w > 0.0).then(|| {
        let place = clip.xy() / clip.w;
        Vec2::new(place.x * 0.5 + 0.5, 0.5 - place.y * 0.5) * size
    })
}

fn to_segment(point: Vec2, a: Vec2, b: Vec2) -> f32 {
    let along = b - a;
    let length_squared = along.length_squared();
    let share =
        if length_squared > 0.0 { ((point - a).dot(along) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    point.distance(a + along * share)
}
