//! The ground props of a scene.

use super::column::{GroundColumn, GroundSurface, TOUCH};
use super::mesh::GroundMesh;
use glam::swizzles::Vec3Swizzles;
use glam::{DQuat, DVec3};
use std::sync::Arc;

/// A ground prop at its place.
#[derive(Clone, Debug)]
pub(in crate::stage) struct PlacedGround {
    pub(in crate::stage) mesh: Arc<GroundMesh>,
    /// Its place in the scene, meters.
    pub(in crate::stage) position: DVec3,
    /// About the vertical.
    pub(in crate::stage) rotation: DQuat,
    /// Meters in one length of its model.
    pub(in crate::stage) scale: f64,
}

/// All ground of a scene.
#[derive(Clone, Debug, Default)]
pub(in crate::stage) struct SceneGround {
    pub(in crate::stage) props: Vec<PlacedGround>,
    /// The height of the plane, which is ground where there are no props, meters.
    pub(in crate::stage) plane: f64,
}

impl SceneGround {
    /// Returns the ground under or over `point` that is nearest to its height; `None` where there is none. Allocates nothing.
    pub(in crate::stage) fn nearest(&self, point: DVec3) -> Option<GroundSurface> {
        let column = self.column(point);
        let far = |surface: &GroundSurface| (surface.height - point.y).abs();
        // The first of equals is the highest.
        column.ground().min_by(|a, b| far(a).total_cmp(&far(b))).copied()
    }

    /// Returns the highest ground under `point`, on which it falls; `None` where there is none. Allocates nothing.
    pub(in crate::stage) fn below(&self, point: DVec3) -> Option<GroundSurface> {
        self.column(point).ground().find(|surface| surface.height <= point.y + TOUCH).copied()
    }

    fn column(&self, point: DVec3) -> GroundColumn {
        let mut column = GroundColumn::new();
        for PlacedGround { mesh, position, rotation, scale } in &self.props {
            let own = rotation.inverse() * (point - position) / *scale;
            mesh.at(own.xz(), |height, faces_up, normal| {
                column.add(GroundSurface {
                    height: position.y + height * scale,
                    normal: *rotation * normal,
                    faces_up,
                });
            });
        }
        column
    }
}
