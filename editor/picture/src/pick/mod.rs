//! Picking the bone under the pointer (thesis §2.2.2.3): intersects the line of sight with the bones as they are
//! drawn in the present pose; a pointer that just misses picks the nearest bone.

use crate::body::{placed, triangles};
use crate::camera::CameraRay;
use crate::scene::Scene;
use crate::shape::{Body, BoneInstance, SkeletonShape};
use dragonfly_anim::data::BoneIndex;
use dragonfly_document::bones::HiddenBones;
use glam::{Mat4, Vec2, Vec3, Vec4Swizzles};
use std::collections::HashSet;

mod click;
mod cycle;
pub(crate) mod region;
pub(crate) mod surface;
mod things;

pub use cycle::ClickCycle;
pub use region::{Lasso, OwnedRegion, Region, bones_in_region};
pub use surface::{SkinHit, pick_skin};

/// Distance at which the pointer still picks a bone, points, so that it looks equally large on every screen.
const REACH: f32 = 10.0;

/// Returns the bone at a pixel of the window, in the pose that `scene` prepared last.
///
/// Bones that are not drawn are picked too: a click on a leg means the bone inside it.
pub fn pick(scene: &Scene, position: [f32; 2]) -> Option<BoneIndex> {
    let (ray, pixel) = scene.ray(position)?;
    let shape = scene.model_in_view()?.shape();
    hit(shape, &ray).or_else(|| nearest(scene, shape, pixel))
}

/// Writes all bones at a pixel of the window, each once: those that the line of sight intersects, nearest first; if there
/// are none, those that it just misses, nearest on the screen first. Hidden bones are left out. For clicks that cycle
/// through overlapping bones ([`ClickCycle`]).
pub fn pick_all(scene: &Scene, position: [f32; 2], hidden: &HiddenBones, out: &mut Vec<BoneIndex>) {
    out.clear();
    let Some(((ray, pixel), model)) = scene.ray(position).zip(scene.model_in_view()) else { return };
    let mut hits: Vec<(f32, BoneIndex)> = Vec::new();
    for_each_hit(model.shape(), &ray, |distance, bone| hits.push((distance, bone)));
    hits.retain(|hit| !hidden.is_hidden(hit.1));
    if hits.is_empty() {
        for_each_near(scene, model.shape(), pixel, |distance, bone| hits.push((distance, bone)));
        hits.retain(|hit| !hidden.is_hidden(hit.1));
    }
    in_order(hits, out);
}

/// Returns the bones of [`pick_all`] that the line of sight intersects.
pub fn pick_met(scene: &Scene, position: [f32; 2], hidden: &HiddenBones, out: &mut Vec<BoneIndex>) {
    out.clear();
    let Some(((ray, _), model)) = scene.ray(position).zip(scene.model_in_view()) else { return };
    let mut hits: Vec<(f32, BoneIndex)> = Vec::new();
    for_each_hit(model.shape(), &ray, |distance, bone| hits.push((distance, bone)));
    hits.retain(|hit| !hidden.is_hidden(hit.1));
    in_order(hits, out);
}

/// Writes each bone once, nearest first.
fn in_order(mut hits: Vec<(f32, BoneIndex)>, out: &mut Vec<BoneIndex>) {
    // The sort is stable: of two equally near hits the first found comes first, as in `pick`.
    hits.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut seen = HashSet::with_capacity(hits.len());
    out.extend(hits.into_iter().map(|(_, bone)| bone).filter(|&bone| seen.insert(bone)));
}

/// Writes the bones in a region of the viewport, given in points from its top left, in the order of the skeleton.
/// Hidden bones are left out. See [`bones_in_region`] for the meaning of inside.
pub fn pick_region(scene: &Scene, region: &Region<'_>, hidden: &HiddenBones, out: &mut Vec<BoneIndex>) {
    out.clear();
    let Some(model) = scene.model_in_view() else { return };
    let clip_from_world = scene.clip_from_world(&scene.bounds().sphere);
    let points = scene.size() / scene.look.pixels_per_point;
    let shape = model.shape();
    // The ball at a joint is not a shape of its own if the bone has another.
    let shapes = Body::ALL.into_iter().flat_map(|body| {
        let ends = move |instance: &BoneInstance| match body {
            Body::Ball => [instance.head; 2],
            _ => [instance.head, instance.tail],
        };
        let instances = shape.instances(body).iter().map(ends);
        instances.zip(shape.owners(body)).map(|([head, tail], &bone)| (bone, head, tail))
    });
    bones_in_region(region, shapes, |place| on_screen(&clip_from_world, place, points), out);
    hidden.retain_shown(out);
}

/// Returns the first bone that the ray intersects.
fn hit(shape: &SkeletonShape, ray: &CameraRay) -> Option<BoneIndex> {
    let mut first: Option<(f32, BoneIndex)> = None;
    for_each_hit(shape, ray, |distance, bone| {
        if first.is_none_or(|(nearest, _)| distance < nearest) {
            first = Some((distance, bone));
        }
    });
    first.map(|(_, bone)| bone)
}

/// Calls `found` with every triangle of a bone that the ray intersects, and its distance.
fn for_each_hit(shape: &SkeletonShape, ray: &CameraRay, mut found: impl FnMut(f32, BoneIndex)) {
    for body in Body::ALL {
        let corners = triangles(body);
        for (instance, &bone) in shape.instances(body).iter().zip(shape.owners(body)) {
            if !passes_near(ray, instance) {
                continue;
            }
            for face in corners.chunks_exact(3) {
                let face = [0, 1, 2].map(|corner| placed(&face[corner], instance));
                if let Some(distance) = meets(ray, face) {
                    found(distance, bone);
                }
            }
        }
    }
}

/// Returns whether the ray intersects the bounding sphere of a bone.
fn passes_near(ray: &CameraRay, bone: &BoneInstance) -> bool {
    let center = (bone.head + bone.tail) / 2.0;
    let radius = bone.head.distance(bone.tail) / 2.0 + bone.radius * 1.5;
    let towards = center - ray.origin;
    let aside = towards - ray.direction * towards.dot(ray.direction);
    aside.length_squared() <= radius * radius
}

/// Distance along the ray at which it intersects a triangle, from either side.
fn meets(ray: &CameraRay, [a, b, c]: [Vec3; 3]) -> Option<f32> {
    let (ab, ac) = (b - a, c - a);
    let across = ray.direction.cross(ac);
    let determinant = ab.dot(across);
    // Edge-on, or a triangle of zero area.
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

/// Returns the bone whose line on the screen is nearest to the pixel, if it is near enough.
fn nearest(scene: &Scene, shape: &SkeletonShape, pixel: Vec2) -> Option<BoneIndex> {
    let mut best: Option<(f32, BoneIndex)> = None;
    for_each_near(scene, shape, pixel, |distance, bone| {
        if best.is_none_or(|(nearest, _)| distance < nearest) {
            best = Some((distance, bone));
        }
    });
    best.map(|(_, bone)| bone)
}

/// Calls `found` with every bone whose line on the screen is near enough to the pixel, and its distance.
fn for_each_near(scene: &Scene, shape: &SkeletonShape, pixel: Vec2, mut found: impl FnMut(f32, BoneIndex)) {
    let clip_from_world = scene.clip_from_world(&scene.bounds().sphere);
    let size = scene.size();
    let reach = REACH * scene.look.pixels_per_point;
    for body in Body::ALL {
        for (instance, &bone) in shape.instances(body).iter().zip(shape.owners(body)) {
            let ends = [instance.head, instance.tail].map(|end| on_screen(&clip_from_world, end, size));
            let [Some(head), Some(tail)] = ends else { continue };
            let distance = to_segment(pixel, head, tail);
            if distance <= reach {
                found(distance, bone);
            }
        }
    }
}

/// Position in the viewport, pixels from its top left; `None` behind the camera.
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
