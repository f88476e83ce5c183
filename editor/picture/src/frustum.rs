//! The part of the scene that the camera sees, for leaving out what is outside of it.

use dragonfly_anim::bounds::AxisBox;
use glam::{Mat4, Vec4};

/// Largest rounding error of a plane test, relative to the sizes of its terms.
const ROUNDING: f32 = 32.0 * f32::EPSILON;

/// Six planes around the visible part of the scene, with the inside where the plane's value is positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewFrustum {
    planes: [Vec4; 6],
}

impl ViewFrustum {
    /// Creates the frustum of a matrix scene space → clip space.
    pub fn new(clip_from_world: &Mat4) -> Self {
        let [x, y, z, w] = [0, 1, 2, 3].map(|index| clip_from_world.row(index));
        Self { planes: [w + x, w - x, w + y, w - y, z, w - z] }
    }

    /// Returns whether some of `around` may be visible. A box that is entirely outside of one plane is not; a box near
    /// a corner may be reported though it is outside.
    pub fn may_show(&self, around: &AxisBox) -> bool {
        let (center, half) = (around.center(), around.half());
        let outside = |plane: &Vec4| {
            let normal = plane.truncate();
            let sizes = normal.abs().dot(center.abs() + half) + plane.w.abs();
            let farthest = normal.dot(center) + plane.w + normal.abs().dot(half);
            // A result that is not a number leaves nothing out.
            farthest < -sizes * ROUNDING
        };
        !self.planes.iter().any(outside)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::Camera;
    use dragonfly_anim::bounds::Sphere;
    use glam::Vec3;

    fn cube(center: Vec3) -> AxisBox {
        AxisBox { min: center - 0.5, max: center + 0.5 }
    }

    #[test]
    fn a_box_outside_one_plane_is_not_shown_and_one_across_it_is() {
        // The cube from -1 to 1 in x and y and from 0 to 1 in z.
        let frustum = ViewFrustum::new(&Mat4::IDENTITY);
        for axis in [Vec3::X, Vec3::Y] {
            for side in [axis, -axis] {
                assert!(frustum.may_show(&cube(side * 1.4)), "{side}");
                assert!(!frustum.may_show(&cube(side * 1.6)), "{side}");
            }
        }
        assert!(frustum.may_show(&cube(Vec3::Z * 1.4)) && !frustum.may_show(&cube(Vec3::Z * 1.6)));
        assert!(frustum.may_show(&cube(Vec3::Z * -0.4)) && !frustum.may_show(&cube(Vec3::Z * -0.6)));
    }

    #[test]
    fn a_box_that_fills_the_range_of_numbers_is_always_shown() {
        let frustum = ViewFrustum::new(&Camera::default().clip_from_view(1.0, &Sphere::default()));
        assert!(frustum.may_show(&AxisBox::WHOLE));
    }
}
