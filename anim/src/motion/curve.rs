//! Root motion as a curve over time.

use super::Axis;
use crate::data::{BoneIndex, Channel, Transform};
use crate::sample::{PlayMode, clamp_time, sample_channel};
use glam::{DQuat, DVec3, Quat, Vec3};

/// Movement of a figure through the scene, relative to its position at the start of the take.
#[derive(Clone, Debug, Default, PartialEq)]
#[doc(alias = "root motion")]
pub struct RootMotion {
    /// The bone that it was extracted from, and is restored to.
    pub bone: BoneIndex,
    /// The axis of [`Self::rotation`].
    pub up: Axis,
    /// Point of the axis of rotation, to-root space: below the bone at the start of the take.
    pub pivot: Vec3,
    /// To-root space, zero at the start. Empty: no translation.
    pub translation: Channel<Vec3>,
    /// Rotation about `up` through `pivot`, before the translation; the identity at the start. Empty: none.
    pub rotation: Channel<Quat>,
    /// Start of the take in seconds.
    pub start: f32,
    /// Length of the take in seconds.
    pub length: f32,
}

impl RootMotion {
    /// Returns `M(t)`: from the scene in which the take is in place to that in which it moves, at `time` seconds; scale
    /// 1.
    ///
    /// The time is clamped to the keys. The result is the identity at the start of the take, unless the keys have been
    /// edited, and also where it would exceed the range of f32.
    pub fn at(&self, time: f32) -> Transform {
        self.rigid(time).to_transform()
    }

    /// Returns the movement of the figure between two times of a clock: `M(from)⁻¹ · M(to)`.
    ///
    /// The figure's matrix `W` at `from` becomes `W · delta` at `to`. With [`PlayMode::Loop`] the clock may run past
    /// the end: each repetition of the take adds its whole movement, `C = M(end) · M(start)⁻¹`:
    ///
    /// ```text
    /// delta = M(t_from)⁻¹ · C^(n_to - n_from) · M(t_to)        t, n: time within the take, number of repetitions
    /// ```
    ///
    /// Either time may be the larger, or before the start. A take without length has no motion; a time that is not
    /// finite counts as the start. Allocates nothing.
    pub fn delta(&self, from: f32, to: f32, mode: PlayMode) -> Transform {
        let ((loops_from, from), (loops_to, to)) = (self.wrap(from, mode), self.wrap(to, mode));
        let end = self.rigid(clamp_time(f32::INFINITY, self.start, self.length));
        let once = end.then_inside(self.rigid(self.start).inverse());
        let between = once.repeated(loops_to.saturating_sub(loops_from));
        let delta = self.rigid(from).inverse().then_inside(between).then_inside(self.rigid(to));
        delta.to_transform()
    }

    /// Returns the number of completed repetitions of the take at `time` of a clock, and the time within it.
    fn wrap(&self, time: f32, mode: PlayMode) -> (i64, f32) {
        let (start, length) = (f64::from(self.start), f64::from(self.length));
        let inside = f64::from(time) - start;
        let endless = mode == PlayMode::Loop && length > 0.0 && inside.is_finite();
        if !endless {
            let time = if time.is_nan() { self.start } else { time };
            let time = if mode == PlayMode::Loop && !time.is_finite() { self.start } else { time };
            return (0, clamp_time(time, self.start, self.length));
        }
        let loops = (inside / length).floor();
        (loops as i64, (start + (inside - loops * length)) as f32)
    }

    fn rigid(&self, time: f32) -> Rigid {
        let rotation = sample_channel(&self.rotation, Quat::IDENTITY, time).as_dquat().normalize();
        let translation = sample_channel(&self.translation, Vec3::ZERO, time).as_dvec3();
        let pivot = self.pivot.as_dvec3();
        Rigid { rotation, translation: pivot + translation - rotation * pivot }
    }
}

/// A rotation and then a translation, in f64.
#[derive(Clone, Copy, Debug)]
struct Rigid {
    rotation: DQuat,
    translation: DVec3,
}

impl Rigid {
    const IDENTITY: Self = Self { rotation: DQuat::IDENTITY, translation: DVec3::ZERO };

    /// Returns the product `self · inner`: `inner` is applied first.
    fn then_inside(self, inner: Self) -> Self {
        Self {
            rotation: (self.rotation * inner.rotation).normalize(),
            translation: self.translation + self.rotation * inner.translation,
        }
    }

    fn inverse(self) -> Self {
        let rotation = self.rotation.conjugate();
        Self { rotation, translation: -(rotation * self.translation) }
    }

    /// Returns `self` to the power of `times`, by squaring; a negative power is a power of the inverse.
    fn repeated(self, times: i64) -> Self {
        let mut square = if times < 0 { self.inverse() } else { self };
        let (mut left, mut product) = (times.unsigned_abs(), Self::IDENTITY);
        while left > 0 {
            if left & 1 == 1 {
                product = product.then_inside(square);
            }
            square = square.then_inside(square);
            left >>= 1;
        }
        product
    }

    fn to_transform(self) -> Transform {
        let rotation = self.rotation.as_quat().normalize();
        let transform = Transform { translation: self.translation.as_vec3(), rotation, scale: Vec3::ONE };
        if transform.is_finite() { transform } else { Transform::IDENTITY }
    }
}
