//! The camera: an orbit around a target.
//!
//! Depth is reversed (1 at the near plane, 0 at the far one): with floating-point depth this keeps its precision at
//! any distance, so the planes can be far apart.

use dragonfly_anim::bounds::Sphere;
use glam::{Mat3, Mat4, Vec2, Vec3, Vec4};
use std::f32::consts::{FRAC_PI_2, PI};

/// Projection of a camera.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub enum Projection {
    /// Distant objects appear smaller.
    #[default]
    Perspective,
    /// Parallel lines stay parallel.
    Orthographic,
}

/// A standard view direction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ViewSide {
    /// From +Z.
    Front,
    /// From -Z.
    Back,
    /// From +X.
    Right,
    /// From -X.
    Left,
    /// From +Y, +X to the right.
    Top,
    /// From -Y.
    Bottom,
}

/// A half-line, scene space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraRay {
    /// Start of the ray.
    pub origin: Vec3,
    /// Direction, unit length.
    pub direction: Vec3,
}

/// A camera that looks at `target` from `distance`; scene space, Y up, +Z towards the viewer at yaw 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Point that the camera orbits, scene space.
    pub target: Vec3,
    /// Distance from the target, scene units, positive.
    pub distance: f32,
    /// Rotation about Y, radians; 0 looks along -Z (front view), positive moves the camera to the right.
    pub yaw: f32,
    /// Elevation, radians; positive looks from above.
    pub pitch: f32,
    /// Rotation about the line of sight, radians; positive turns the image clockwise. Only cameras of a script are rotated so.
    pub roll: f32,
    /// Vertical field of view, radians.
    pub field_of_view: f32,
    /// Perspective or orthographic.
    pub projection: Projection,
}

/// Range of the distance from the target, scene units: the matrices of these sizes fit into f32.
const DISTANCE: std::ops::RangeInclusive<f32> = 1e-5..=1e9;
/// Margin around a framed object, as a factor.
const FRAME_MARGIN: f32 = 1.08;

impl Default for Camera {
    /// Looks from the front, slightly from the right and above, at a view two units high.
    fn default() -> Self {
        Self {
            target: Vec3::Y * 0.5,
            distance: 3.0,
            yaw: 0.5,
            pitch: 0.26,
            roll: 0.0,
            field_of_view: 35.0_f32.to_radians(),
            projection: Projection::Perspective,
        }
    }
}

impl Camera {
    /// Unit vector to the right of the image; horizontal without roll, so it is defined even when looking straight down.
    pub fn right(&self) -> Vec3 {
        let (sin, cos) = self.yaw.sin_cos();
        let level = Vec3::new(cos, 0.0, -sin);
        if self.roll == 0.0 {
            return level;
        }
        let (sin, cos) = self.roll.sin_cos();
        level * cos + self.back().cross(level) * sin
    }

    /// Unit vector from the target to the camera.
    pub fn back(&self) -> Vec3 {
        let (sin_yaw, cos_yaw) = self.yaw.sin_cos();
        let (sin_pitch, cos_pitch) = self.pitch.sin_cos();
        Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch)
    }

    /// Unit vector to the top of the image.
    pub fn up(&self) -> Vec3 {
        self.back().cross(self.right())
    }

    /// Position of the camera, scene space.
    pub fn eye(&self) -> Vec3 {
        self.target + self.back() * self.distance
    }

    /// Height of the view at the target, scene units; the same for both projections.
    pub fn height_at_target(&self) -> f32 {
        2.0 * self.distance * self.half_angle().tan()
    }

    /// Number of scene units that one pixel covers at the target, in a viewport `height` pixels high.
    pub fn units_per_pixel(&self, height: f32) -> f32 {
        self.height_at_target() / height.max(1.0)
    }

    /// Transforms scene space to view space (right, up, towards the viewer).
    pub fn view_from_world(&self) -> Mat4 {
        let (right, up, back, eye) = (self.right(), self.up(), self.back(), self.eye());
        Mat4::from_cols(
            Vec3::new(right.x, up.x, back.x).extend(0.0),
            Vec3::new(right.y, up.y, back.y).extend(0.0),
            Vec3::new(right.z, up.z, back.z).extend(0.0),
            Vec3::new(-right.dot(eye), -up.dot(eye), -back.dot(eye)).extend(1.0),
        )
    }

    /// Transforms view space to clip space, for a viewport with this ratio of width to height: depth 1 at `near` to 0
    /// at `far`.
    pub fn clip_from_view(&self, aspect: f32, bounds: &Sphere) -> Mat4 {
        let aspect = aspect.max(1e-3);
        let (near, far) = self.depth_range(bounds);
        match self.projection {
            Projection::Perspective => {
                let y = 1.0 / self.half_angle().tan();
                let depth = near / (far - near);
                Mat4::from_cols(
                    Vec4::new(y / aspect, 0.0, 0.0, 0.0),
                    Vec4::new(0.0, y, 0.0, 0.0),
                    Vec4::new(0.0, 0.0, depth, -1.0),
                    Vec4::new(0.0, 0.0, depth * far, 0.0),
                )
            }
            Projection::Orthographic => {
                let y = 2.0 / self.height_at_target();
                let depth = 1.0 / (far - near);
                Mat4::from_cols(
                    Vec4::new(y / aspect, 0.0, 0.0, 0.0),
                    Vec4::new(0.0, y, 0.0, 0.0),
                    Vec4::new(0.0, 0.0, depth, 0.0),
                    Vec4::new(0.0, 0.0, depth * far, 1.0),
                )
            }
        }
    }

    /// Distances of the near and the far plane from the camera that enclose a scene of these bounds and the ground
    /// around the target. An orthographic view also includes what is behind the camera, so its near plane may be
    /// negative.
    pub fn depth_range(&self, bounds: &Sphere) -> (f32, f32) {
        let reach = self.eye().distance(bounds.center) + bounds.radius + self.distance * 8.0;
        match self.projection {
            Projection::Perspective => (self.distance * 0.01, reach * 2.0),
            Projection::Orthographic => (-reach, reach * 2.0),
        }
    }

    /// Rotates the camera about the target, radians; the pitch is clamped to straight above and below.
    pub fn orbit(&mut self, yaw: f32, pitch: f32) {
        self.yaw = (self.yaw + yaw + PI).rem_euclid(2.0 * PI) - PI;
        self.pitch = (self.pitch + pitch).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// Moves the camera in the image plane so that a point at the target's depth follows the pointer exactly, which
    /// moved by `pixels` (y down) in a viewport `height` pixels high.
    pub fn pan(&mut self, pixels: Vec2, height: f32) {
        let unit = self.units_per_pixel(height);
        self.target += (self.up() * pixels.y - self.right() * pixels.x) * unit;
    }

    /// Multiplies the distance by `factor`; the target stays in the center.
    pub fn dolly(&mut self, factor: f32) {
        self.distance = (self.distance * factor).clamp(*DISTANCE.start(), *DISTANCE.end());
    }

    /// Multiplies the distance by `factor` so that the point under `cursor` at the target's depth stays there.
    /// `cursor` is in pixels from the top left of a viewport of `size` pixels.
    pub fn zoom_to(&mut self, cursor: Vec2, size: Vec2, factor: f32) {
        let from_middle = cursor - size / 2.0;
        let unit = self.units_per_pixel(size.y);
        let under_cursor = (self.right() * from_middle.x - self.up() * from_middle.y) * unit;
        let before = self.distance;
        self.dolly(factor);
        self.target += under_cursor * (1.0 - self.distance / before);
    }

    /// Frames `sphere` as large as it fits a viewport with this ratio of width to height. An empty sphere is framed
    /// as one unit.
    pub fn frame(&mut self, sphere: &Sphere, aspect: f32) {
        let vertical = self.half_angle();
        let horizontal = (vertical.tan() * aspect.max(1e-3)).atan();
        let angle = vertical.min(horizontal);
        let radius = if sphere.radius > 0.0 { sphere.radius } else { 0.5 };
        let reach = match self.projection {
            Projection::Perspective => angle.sin(),
            Projection::Orthographic => angle.tan(),
        };
        self.target = sphere.center;
        self.distance = (radius * FRAME_MARGIN / reach).clamp(*DISTANCE.start(), *DISTANCE.end());
    }

    /// Frames a box as large as it fits from this direction: closer than [`Self::frame`] for long, slim objects.
    pub fn frame_box(&mut self, min: Vec3, max: Vec3, aspect: f32) {
        let pick =
            |index: usize, bit: usize, low: f32, high: f32| if index >> bit & 1 == 0 { low } else { high };
        let corners: [Vec3; 8] = std::array::from_fn(|index| {
            Vec3::new(
                pick(index, 0, min.x, max.x),
                pick(index, 1, min.y, max.y),
                pick(index, 2, min.z, max.z),
            )
        });
        self.frame_points(&corners, aspect);
    }

    /// Frames the finite ones of `points` as large as they fit from this direction. Points without extent are framed
    /// as one unit; without any finite point, nothing changes.
    pub fn frame_points(&mut self, points: &[Vec3], aspect: f32) {
        let axes = Mat3::from_cols(self.right(), self.up(), self.back());
        let to_view = axes.transpose();
        let seen = points.iter().filter(|point| point.is_finite()).map(|&point| to_view * point);
        let around = |(low, high): (Vec3, Vec3), point: Vec3| (low.min(point), high.max(point));
        let (low, high) = seen.clone().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), around);
        if !low.is_finite() {
            return;
        }
        let center = (low + high) / 2.0;
        let vertical = self.half_angle().tan();
        let horizontal = vertical * aspect.max(1e-3);
        let reach = |point: Vec3| {
            let point = point - center;
            let across = (point.x.abs() / horizontal).max(point.y.abs() / vertical);
            let towards = if self.projection == Projection::Perspective { point.z } else { 0.0 };
            across * FRAME_MARGIN + towards
        };
        let reach = seen.map(reach).fold(0.0, f32::max);
        self.target = axes * center;
        self.distance = if reach > 0.0 { reach } else { 1.0 }.clamp(*DISTANCE.start(), *DISTANCE.end());
    }

    /// Returns those of `points` that decide how [`Self::frame_points`] frames them, at most ten: what many poses have in common is framed as all of their
    /// points would be. Points that are not finite are left out.
    pub fn outermost(&self, points: &[Vec3], aspect: f32) -> Vec<Vec3> {
        let (right, up, back) = (self.right(), self.up(), self.back());
        let vertical = self.half_angle().tan();
        let towards = if self.projection == Projection::Perspective { back } else { Vec3::ZERO };
        let across = [right / (vertical * aspect.max(1e-3)), up / vertical].map(|axis| axis * FRAME_MARGIN);
        let sides = [across[0], -across[0], across[1], -across[1]].map(|side| side + towards);
        let directions = [right, -right, up, -up, back, -back].into_iter().chain(sides);
        let points = || points.iter().copied().filter(|point| point.is_finite());
        let farthest = |direction: Vec3| {
            let far = |point: &Vec3| direction.dot(*point);
            points().max_by(|a, b| far(a).total_cmp(&far(b)))
        };
        directions.filter_map(farthest).collect()
    }

    /// Looks from `side` at the same target from the same distance.
    pub fn look_from(&mut self, side: ViewSide) {
        (self.yaw, self.pitch) = match side {
            ViewSide::Front => (0.0, 0.0),
            ViewSide::Back => (PI, 0.0),
            ViewSide::Right => (FRAC_PI_2, 0.0),
            ViewSide::Left => (-FRAC_PI_2, 0.0),
            ViewSide::Top => (0.0, FRAC_PI_2),
            ViewSide::Bottom => (0.0, -FRAC_PI_2),
        };
    }

    /// Switches to the other projection, keeping the size of objects at the target.
    pub fn toggle_projection(&mut self) {
        self.projection = match self.projection {
            Projection::Perspective => Projection::Orthographic,
            Projection::Orthographic => Projection::Perspective,
        };
    }

    /// Returns the line of sight through a pixel (thesis §2.2.2.3), counted from the top left of a viewport of `size`
    /// pixels.
    pub fn ray(&self, pixel: Vec2, size: Vec2) -> CameraRay {
        let from_middle = pixel - size / 2.0;
        let unit = self.units_per_pixel(size.y);
        let at_target = (self.right() * from_middle.x - self.up() * from_middle.y) * unit;
        match self.projection {
            Projection::Perspective => {
                let origin = self.eye();
                let direction = (self.target + at_target - origin).normalize_or(-self.back());
                CameraRay { origin, direction }
            }
            // Starts far enough behind the camera to include everything between camera and target.
            Projection::Orthographic => CameraRay {
                origin: self.target + at_target + self.back() * self.distance * 100.0,
                direction: -self.back(),
            },
        }
    }

    /// Half the vertical field of view, clamped so that its tangent stays finite.
    fn half_angle(&self) -> f32 {
        (self.field_of_view / 2.0).clamp(0.01, 1.5)
    }
}
