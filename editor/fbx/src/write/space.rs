//! Units and axes of a written file.

use dragonfly_anim::format::UpAxis;
use glam::{DMat3, DMat4, DQuat, DVec3};

/// Converts numbers of the model, in meters with Y up, to those of the file.
#[derive(Clone, Copy, Debug)]
pub(super) struct FileSpace {
    /// The axes of the model in the file.
    axes: DMat3,
    /// Units of the file per meter.
    units: f64,
}

impl FileSpace {
    /// Returns the space of right-handed files with this axis up.
    pub(super) fn new(up: UpAxis, meters_per_unit: f64) -> Self {
        let axes = match up {
            UpAxis::X => DMat3::from_cols(DVec3::NEG_Y, DVec3::X, DVec3::Z),
            UpAxis::Y => DMat3::IDENTITY,
            UpAxis::Z => DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y),
        };
        Self { axes, units: 1.0 / meters_per_unit }
    }

    /// Returns the number of units per meter.
    pub(super) fn units(&self) -> f64 {
        self.units
    }

    /// Converts a position, a difference of two, or its derivative.
    pub(super) fn position(&self, position: DVec3) -> DVec3 {
        self.axes * position * self.units
    }

    /// Converts a direction.
    pub(super) fn direction(&self, direction: DVec3) -> DVec3 {
        self.axes * direction
    }

    /// Converts a rotation.
    pub(super) fn rotation(&self, rotation: DQuat) -> DQuat {
        let axis = self.axes * DVec3::new(rotation.x, rotation.y, rotation.z);
        DQuat::from_xyzw(axis.x, axis.y, axis.z, rotation.w)
    }

    /// Converts factors along the axes, or their derivative.
    pub(super) fn factors(&self, factors: DVec3) -> DVec3 {
        let absolute =
            DMat3::from_cols(self.axes.x_axis.abs(), self.axes.y_axis.abs(), self.axes.z_axis.abs());
        absolute * factors
    }

    /// Converts a matrix between two spaces of the model.
    pub(super) fn matrix(&self, matrix: DMat4) -> DMat4 {
        let axes = DMat4::from_mat3(self.axes);
        let mut converted = axes * matrix * axes.transpose();
        converted.w_axis = (converted.w_axis.truncate() * self.units).extend(converted.w_axis.w);
        converted
    }
}
