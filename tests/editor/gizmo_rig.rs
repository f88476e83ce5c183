//! Fixture of the gizmo tests: a small skeleton, cameras, and screen positions computed independently, with the matrices
//! that draw the image.

use dragonfly::control::gizmo::Gizmo;
use dragonfly_anim::animation::to_root;
use dragonfly_anim::bounds::Sphere;
use dragonfly_anim::data::{Bone, BoneIndex, Skeleton, Transform};
use dragonfly_picture::camera::{Camera, Projection};
use dragonfly_picture::gizmo::{GizmoAxis, GizmoSpace, GizmoView};
use glam::{Mat3, Mat4, Quat, Vec2, Vec3};

/// A skeleton in a pose.
pub(crate) struct Rig {
    pub(crate) skeleton: Skeleton,
    pub(crate) poses: Vec<Transform>,
}

impl Rig {
    /// Bone 0 is the root, 1 and 3 are its children, 2 is a child of 1. All are rotated, none is scaled.
    pub(crate) fn new() -> Self {
        let turn = |x: f32, y: f32, z: f32| Quat::from_xyzw(x, y, z, 1.0).normalize();
        let at = |x: f32, y: f32, z: f32, rotation: Quat| Transform {
            translation: Vec3::new(x, y, z),
            rotation,
            scale: Vec3::ONE,
        };
        Self::of(
            &[None, Some(0), Some(1), Some(0)],
            vec![
                at(0.1, 0.2, -0.1, turn(0.1, 0.3, -0.2)),
                at(0.0, 0.5, 0.1, turn(-0.4, 0.2, 0.3)),
                at(0.2, 0.4, 0.0, turn(0.3, 0.1, 0.5)),
                at(-0.4, 0.3, 0.2, turn(0.2, -0.6, 0.1)),
            ],
        )
    }

    pub(crate) fn of(parents: &[Option<BoneIndex>], poses: Vec<Transform>) -> Self {
        let bone = |(parent, rest): (&Option<BoneIndex>, &Transform)| Bone {
            name: String::new(),
            parent: *parent,
            rest: *rest,
            rest_matrix: None,
            offset: Mat4::IDENTITY,
            node: None,
        };
        let bones = parents.iter().zip(&poses).map(bone).collect();
        Self { skeleton: Skeleton { bones }, poses }
    }

    pub(crate) fn to_root(&self) -> Vec<Mat4> {
        self.to_root_of(&self.poses)
    }

    pub(crate) fn to_root_of(&self, poses: &[Transform]) -> Vec<Mat4> {
        let mut matrices = vec![Mat4::IDENTITY; poses.len()];
        to_root(&self.skeleton, poses, &mut matrices);
        matrices
    }

    pub(crate) fn joint(&self, bone: usize) -> Vec3 {
        self.to_root()[bone].w_axis.truncate()
    }

    /// Returns the poses after a drag.
    pub(crate) fn after(&self, gizmo: &Gizmo) -> Vec<Transform> {
        let mut poses = self.poses.clone();
        for change in &gizmo.drag().bones {
            poses[change.bone as usize] = change.to_parent;
        }
        poses
    }

    /// Selects bones, the last one active.
    pub(crate) fn select(&self, gizmo: &mut Gizmo, bones: &[BoneIndex]) {
        gizmo.select(&self.skeleton, &self.poses, &self.to_root(), bones, None);
    }

    /// Returns the axes of a bone in a space, for a rig without scale.
    pub(crate) fn axes(&self, bone: usize, space: GizmoSpace, camera: &Camera) -> Mat3 {
        let parent = self.skeleton.bones[bone].parent;
        let to_root = self.to_root();
        match space {
            GizmoSpace::Local => Mat3::from_mat4(to_root[bone]),
            GizmoSpace::Parent => {
                parent.map_or(Mat3::IDENTITY, |parent| Mat3::from_mat4(to_root[parent as usize]))
            }
            GizmoSpace::World => Mat3::IDENTITY,
            GizmoSpace::View => Mat3::from_cols(camera.right(), camera.up(), camera.back()),
        }
    }
}

/// A viewport: the camera, the size in points, and the scale of the screen.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Screen {
    pub(crate) camera: Camera,
    pub(crate) size: Vec2,
    pub(crate) pixels_per_point: f32,
}

impl Screen {
    pub(crate) fn plain() -> Self {
        let camera = Camera { target: Vec3::new(0.1, 0.6, 0.0), ..Camera::default() };
        Self { camera, size: Vec2::new(800.0, 600.0), pixels_per_point: 1.0 }
    }

    /// Returns views from near and far, from several sides, with and without perspective, of many sizes and scales.
    pub(crate) fn all() -> Vec<Self> {
        let mut screens = Vec::new();
        let sides = [(0.5, 0.26), (-2.2, -0.6), (0.0, 0.0), (1.2, 1.3)];
        for (index, (yaw, pitch)) in sides.into_iter().enumerate() {
            for projection in [Projection::Perspective, Projection::Orthographic] {
                for distance in [2.0, 3.0, 30.0] {
                    let size = [Vec2::new(800.0, 600.0), Vec2::new(1500.0, 420.0), Vec2::new(500.0, 900.0)];
                    let target = Vec3::new(0.1, 0.6, 0.0);
                    let camera = Camera { target, distance, yaw, pitch, projection, ..Camera::default() };
                    let pixels_per_point = [1.0, 1.5, 2.0, 0.75][index];
                    screens.push(Self { camera, size: size[index % 3], pixels_per_point });
                }
            }
        }
        screens
    }

    /// Returns the view as the program creates it, from pixels.
    pub(crate) fn view(&self) -> GizmoView {
        GizmoView::of_pixels(&self.camera, self.size * self.pixels_per_point, self.pixels_per_point)
    }

    /// Projects a world position to the screen, in points, with the matrices that draw the image.
    pub(crate) fn at(&self, place: Vec3) -> Vec2 {
        let bounds = Sphere { center: Vec3::ZERO, radius: 3.0 };
        let clip_from_view = self.camera.clip_from_view(self.size.x / self.size.y, &bounds);
        let clip = clip_from_view * self.camera.view_from_world() * place.extend(1.0);
        let place = clip.truncate() / clip.w;
        Vec2::new(place.x * 0.5 + 0.5, 0.5 - place.y * 0.5) * self.size
    }

    /// Returns the number of scene units that one point of the screen covers at a place.
    pub(crate) fn unit(&self, place: Vec3) -> f32 {
        let depth = match self.camera.projection {
            Projection::Perspective => (self.camera.eye() - place).dot(self.camera.back()),
            Projection::Orthographic => self.camera.distance,
        };
        2.0 * (self.camera.field_of_view / 2.0).tan() * depth / self.size.y
    }

    /// Returns the unit vector from a place to the viewer.
    pub(crate) fn towards(&self, place: Vec3) -> Vec3 {
        match self.camera.projection {
            Projection::Perspective => (self.camera.eye() - place).normalize(),
            Projection::Orthographic => self.camera.back(),
        }
    }
}

/// Returns the world position at an offset from a joint, in screen points along the given axes.
pub(crate) fn along(screen: &Screen, joint: Vec3, axes: Mat3, points: Vec3) -> Vec3 {
    joint + axes * points * screen.unit(joint)
}

/// Returns the angle between two rotations in radians.
pub(crate) fn between(a: Quat, b: Quat) -> f32 {
    let (a, b) = (a.as_dquat().normalize(), b.as_dquat().normalize());
    let difference = a.conjugate() * b;
    (2.0 * difference.xyz().length().atan2(difference.w.abs())) as f32
}

pub(crate) const SPACES: [GizmoSpace; 4] =
    [GizmoSpace::Local, GizmoSpace::Parent, GizmoSpace::World, GizmoSpace::View];

pub(crate) fn unit(axis: GizmoAxis) -> Vec3 {
    Vec3::AXES[axis as usize]
}
