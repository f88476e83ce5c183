//! Rotations as readable numbers: angles in degrees in some order, or the four numbers of the quaternion.

use crate::panels::properties::turn;
use dragonfly_anim::joint::EulerOrder;
use glam::{DQuat, Quat};

/// The form in which rotations are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::panels) enum RotationForm {
    /// Three angles, degrees, applied in this order.
    Euler(EulerOrder),
    /// x, y, z, w.
    Quaternion,
}

impl Default for RotationForm {
    fn default() -> Self {
        Self::Euler(EulerOrder::Xyz)
    }
}

impl RotationForm {
    /// Returns all forms, in the order in which they are offered.
    pub(super) fn all() -> impl Iterator<Item = Self> {
        EulerOrder::ALL.into_iter().map(Self::Euler).chain([Self::Quaternion])
    }

    /// Returns the name of the form.
    pub(super) fn name(self) -> String {
        match self {
            Self::Euler(order) => format!("Euler {}", turn::name(order)),
            Self::Quaternion => "Quaternion".to_owned(),
        }
    }

    /// Returns the order and the axis of each of its angles; `None` for quaternions.
    fn order(self) -> Option<(EulerOrder, [usize; 3])> {
        match self {
            Self::Euler(order) => Some((order, order.axes())),
            Self::Quaternion => None,
        }
    }

    /// Returns how many numbers a rotation has in this form.
    pub(super) fn numbers(self) -> usize {
        if self == Self::Quaternion { 4 } else { 3 }
    }

    /// Returns the numbers of a rotation, by axis. Of all equivalent angles, those nearest to `near`.
    pub(super) fn of(self, rotation: Quat, near: [f32; 4]) -> [f32; 4] {
        let Self::Euler(order) = self else { return rotation.to_array() };
        let unit = rotation.as_dquat().normalize();
        if !unit.is_finite() {
            return near;
        }
        let [x, y, z, _] = near.map(f64::from);
        let [x, y, z] = turn::nearest(order, unit, [x, y, z]);
        [x as f32, y as f32, z as f32, 0.0]
    }

    /// Returns the rotation with these numbers.
    pub(super) fn rotation(self, numbers: [f32; 4]) -> Quat {
        self.exact(numbers.map(f64::from)).as_quat()
    }

    fn exact(self, numbers: [f64; 4]) -> DQuat {
        match self.order() {
            Some((order, axes)) => order.rotation(axes.map(|axis| numbers[axis].to_radians())),
            None => {
                let raw = DQuat::from_array(numbers);
                if raw.length_squared() > 1e-12 { raw.normalize() } else { DQuat::IDENTITY }
            }
        }
    }

    /// Returns the rate of change of the numbers, per second, where the quaternion changes by `rate` per second.
    pub(super) fn slopes(self, rotation: Quat, rate: Quat, numbers: [f32; 4]) -> [f32; 4] {
        if self == Self::Quaternion {
            return rate.to_array();
        }
        let speed = f64::from(rate.length());
        if !(speed > 1e-9 && speed.is_finite()) {
            return [0.0; 4];
        }
        let step = 1e-3 / speed;
        let moved = |sign: f64| {
            let moved = rotation.as_dquat() + rate.as_dquat() * (step * sign);
            self.of(moved.normalize().as_quat(), numbers).map(f64::from)
        };
        let (before, after) = (moved(-1.0), moved(1.0));
        std::array::from_fn(|axis| ((after[axis] - before[axis]) / (2.0 * step)) as f32)
    }

    /// Returns the rate of the quaternion at which `numbers` change by `slopes` per second. The component of `rate`
    /// along the quaternion itself, which rotates nothing, stays.
    pub(super) fn rate(self, rotation: Quat, rate: Quat, numbers: [f32; 4], slopes: [f32; 4]) -> Quat {
        if self == Self::Quaternion {
            return Quat::from_array(slopes);
        }
        let speed: f64 = slopes.iter().map(|slope| f64::from(slope.abs())).sum();
        let along = rotation * rotation.dot(rate);
        if !(speed > 1e-9 && speed.is_finite()) {
            return along;
        }
        let step = 0.05 / speed;
        let moved = |sign: f64| {
            let at =
                std::array::from_fn(|axis| f64::from(numbers[axis]) + f64::from(slopes[axis]) * step * sign);
            let turned = self.exact(at);
            if turned.dot(rotation.as_dquat()) < 0.0 { -turned } else { turned }
        };
        let turning = (moved(1.0) - moved(-1.0)) * (0.5 / step);
        turning.as_quat() + along
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use dragonfly_kit::random::{Random, seed};

    #[test]
    fn the_numbers_of_a_rotation_give_it_back_in_every_form() {
        let seed = seed(3);
        let mut random = Random::new(seed);
        for _ in 0..500 {
            let near = [(); 4].map(|()| random.between(-400.0, 400.0));
            let quaternion = Quat::from_array([(); 4].map(|()| random.between(-1.0, 1.0))).normalize();
            for form in RotationForm::all() {
                let back = form.rotation(form.of(quaternion, near));
                assert!(back.dot(quaternion).abs() > 0.999_99, "seed {seed} {form:?} {quaternion}");
            }
        }
    }

    #[test]
    fn angles_continue_beyond_half_a_turn() {
        let mut near = [0.0; 4];
        for step in 0..=36 {
            let angle = step as f32 * 20.0;
            near = RotationForm::default().of(Quat::from_rotation_z(angle.to_radians()), near);
            assert!((near[2] - angle).abs() < 0.01, "{near:?}");
        }
    }

    #[test]
    fn slopes_converted_to_a_rate_and_back_stay_the_same() {
        let seed = seed(5);
        let mut random = Random::new(seed);
        for _ in 0..200 {
            let numbers =
                [random.between(-70.0, 70.0), random.between(-70.0, 70.0), random.between(-70.0, 70.0), 0.0];
            let slopes =
                [random.between(-90.0, 90.0), random.between(-90.0, 90.0), random.between(-90.0, 90.0), 0.0];
            for form in [EulerOrder::Xyz, EulerOrder::Zyx, EulerOrder::Yxz].map(RotationForm::Euler) {
                let rotation = form.rotation(numbers);
                let rate = form.rate(rotation, Quat::from_array([0.0; 4]), numbers, slopes);
                let back = form.slopes(rotation, rate, numbers);
                for axis in 0..3 {
                    assert!(
                        (back[axis] - slopes[axis]).abs() < 1.5,
                        "seed {seed} {form:?} {back:?} {slopes:?}"
                    );
                }
            }
        }
    }
}
