//! The maps of a sun: slices of the view in depth, each with a map of its own.
//!
//! Slices are cut at distances that are partly logarithmic, partly even ("practical split", Zhang et al. 2006). A map covers the sphere around its
//! slice, so that its size does not depend on where the camera looks, and its place is a whole number of texels: the shadows of things at rest
//! then stay the same while the camera moves (Valient 2007). For the same reason the distances change in steps.

use super::frame::{BORDER, CASCADES, ShadowMap, ShadowedFrame};
use crate::camera::Projection;
use dragonfly_anim::bounds::Sphere;
use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};

/// Weight of the logarithmic split against the even one.
const LOGARITHMIC: f32 = 0.7;

/// Distances in front of the center of what casts shadows, and after it, within which shadows are drawn; in radii of the casters. Shadows are
/// longer than what casts them.
const REACH: [f32; 2] = [2.0, 3.0];

/// Half the depth of a map around the center of what casts shadows, radii.
const DEPTH: f32 = 2.0;

/// Number of steps in which a distance doubles.
const STEPS: f32 = 4.0;

/// Returns the maps of a sun in the direction `towards`, and how many there are: one for an orthographic view, in which everything is equally
/// large.
pub(super) fn maps(frame: &ShadowedFrame<'_>, towards: Vec3) -> ([ShadowMap; CASCADES], usize) {
    let (right, up) = towards.any_orthonormal_pair();
    let axes = Mat3::from_cols(right, up, towards);
    let view = SlicedView::of(frame);
    let mut maps = [ShadowMap::default(); CASCADES];
    let count = view.slices(&mut maps, |sphere| map(&sphere, &axes, &frame.casters, frame.side));
    (maps, count)
}

/// The view of a camera, to be cut into slices.
struct SlicedView {
    eye: Vec3,
    forward: Vec3,
    /// Half the size of the view: at a distance of 1 in a perspective view, everywhere in an orthographic one.
    half: Vec2,
    projection: Projection,
    /// Distance of the center of what casts shadows along the view, and its radius.
    depth: f32,
    radius: f32,
    /// Distances of the near and the far plane of the camera.
    planes: (f32, f32),
}

impl SlicedView {
    fn of(frame: &ShadowedFrame<'_>) -> Self {
        let camera = frame.camera;
        let clip = camera.clip_from_view(frame.aspect, &frame.drawn);
        let (eye, forward) = (camera.eye(), -camera.back());
        Self {
            eye,
            forward,
            half: Vec2::new(1.0 / clip.x_axis.x, 1.0 / clip.y_axis.y),
            projection: camera.projection,
            depth: (frame.casters.center - eye).dot(forward),
            radius: frame.casters.radius,
            planes: camera.depth_range(&frame.drawn),
        }
    }

    /// Writes a map for each slice, made from the sphere around it. Returns the number of slices.
    fn slices(&self, out: &mut [ShadowMap; CASCADES], map: impl Fn(Sphere) -> ShadowMap) -> usize {
        match self.projection {
            Projection::Perspective => {
                let (near, far) = self.distances();
                for (index, out) in out.iter_mut().enumerate() {
                    let [from, to] = [index, index + 1].map(|index| split(near, far, index));
                    *out = map(self.sphere(from, to));
                }
                CASCADES
            }
            Projection::Orthographic => {
                let [before, after] = REACH;
                let middle = self.depth + (after - before) / 2.0 * self.radius;
                let depth = (before + after) / 2.0 * self.radius;
                let center = self.eye + self.forward * middle;
                out[0] = map(Sphere { center, radius: step_up(self.half.extend(depth).length()) });
                1
            }
        }
    }

    /// Returns the distances between which shadows are drawn.
    fn distances(&self) -> (f32, f32) {
        let [before, after] = REACH.map(|radii| radii * self.radius);
        let near = step_down((self.depth - before).max(self.planes.0));
        let far = step_up((self.depth + after).min(self.planes.1));
        (near, far.max(2.0 * near))
    }

    /// Returns the smallest sphere with its center on the axis of the view around the slice between two distances of a perspective view.
    fn sphere(&self, near: f32, far: f32) -> Sphere {
        let slope = self.half.length_squared();
        let (sum, difference) = (far + near, far - near);
        // A wide slice fits into the sphere around its far end.
        let (middle, radius) = if slope * sum >= difference {
            (far, far * slope.sqrt())
        } else {
            let middle = 0.5 * sum * (1.0 + slope);
            (middle, Vec2::new(far - middle, far * slope.sqrt()).length())
        };
        Sphere { center: self.eye + self.forward * middle, radius }
    }
}

/// Returns the distance at which slice number `index` begins.
fn split(near: f32, far: f32, index: usize) -> f32 {
    let share = index as f32 / CASCADES as f32;
    let (logarithmic, even) = (near * (far / near).powf(share), near + (far - near) * share);
    even + (logarithmic - even) * LOGARITHMIC
}

/// Returns the least step that is not smaller than a positive size.
fn step_up(size: f32) -> f32 {
    ((size.log2() * STEPS).ceil() / STEPS).exp2()
}

/// Returns the greatest step that is not larger than a positive size.
fn step_down(size: f32) -> f32 {
    ((size.log2() * STEPS).floor() / STEPS).exp2()
}

/// Returns the map of what is inside a sphere. `axes` are right and up in the map, and the direction towards the sun.
fn map(inside: &Sphere, axes: &Mat3, casters: &Sphere, side: u32) -> ShadowMap {
    let half = inside.radius / (1.0 - 2.0 * BORDER / side as f32);
    let texel = 2.0 * half / side as f32;
    let center = axes.transpose() * inside.center;
    let whole = |along: f32| (along / texel).floor() * texel;
    // The depth is that of what casts shadows: places in front of it are in the light, and those after it get the shadow of what is nearest.
    let depth = 2.0 * DEPTH * casters.radius;
    let lowest = axes.z_axis.dot(casters.center) - DEPTH * casters.radius;
    let rows = Mat4::from_cols(
        (axes.x_axis / half).extend(-whole(center.x) / half),
        (axes.y_axis / half).extend(-whole(center.y) / half),
        // Reversed: 1 is nearest to the sun.
        (axes.z_axis / depth).extend(-lowest / depth),
        Vec4::W,
    );
    ShadowMap { clip_from_world: rows.transpose(), texel }
}
