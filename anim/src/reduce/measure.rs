//! The error of a reduced take: on every frame, at every bone, for every point of its shell.
//!
//! Let `A` and `B` be a bone's to-root in the original and in the reduced take. A point of its shell is `shell * u`,
//! `u` of unit length, and it moves by
//!
//! ```text
//! e(u) = d + shell * M u        d = difference of the origins, M = difference of the linear parts of A and B
//!
//! |e(u)|² = |d|² + 2 shell (Mᵀd)·u + shell² |M u|²  <=  |d|² + 2 shell |Mᵀd| + shell² σ²
//! ```
//!
//! `σ` is the largest singular value of `M`. The right side is the largest error of *all* points of the sphere, not of
//! a few selected ones: exactly, where the bone turns and shifts without stretching, and an upper bound otherwise.

use super::settings::Lengths;
use super::{Deviation, ReduceError, ReduceSettings, frames};
use crate::animation::to_root;
use crate::data::{Skeleton, Take, Transform};
use crate::sample::sample_take;
use glam::{DMat3, DVec3, Mat4};

/// Error of a reduced take compared with the original.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// Number of times measured: every key time of the original, and the frames between.
    pub frames: usize,
    /// The largest error anywhere; `None` for a skeleton without bones.
    pub largest: Option<Deviation>,
    /// The error that is the largest share of its tolerance.
    pub tightest: Option<Deviation>,
}

impl Measurement {
    /// Returns whether every bone is within its tolerance on every frame.
    pub fn holds(&self) -> bool {
        self.tightest.is_none_or(|tightest| tightest.millimeters <= tightest.tolerance)
    }

    pub(super) fn note(&mut self, found: Deviation) {
        if self.largest.is_none_or(|largest| found.millimeters > largest.millimeters) {
            self.largest = Some(found);
        }
        // Shares are compared without a division, because a tolerance may be zero.
        let tighter = |than: Deviation| match (found.holds(), than.holds()) {
            (true, true) => found.millimeters * than.tolerance > than.millimeters * found.tolerance,
            (true, false) => false,
            (false, true) => true,
            (false, false) => found.millimeters - found.tolerance > than.millimeters - than.tolerance,
        };
        if self.tightest.is_none_or(tighter) {
            self.tightest = Some(found);
        }
    }
}

/// Compares `reduced` with `original` on every frame of the original, using only the two takes.
///
/// Tolerances and contacts are those that [`super::reduce()`] would use for `original`. As there, too many frames are
/// an error.
pub fn measure(
    original: &Take,
    reduced: &Take,
    skeleton: &Skeleton,
    settings: &ReduceSettings,
) -> Result<Measurement, ReduceError> {
    let source = frames::SampledTake::new(original, skeleton, settings)?;
    Ok(measure_against(&source, reduced, skeleton, settings))
}

pub(super) fn measure_against(
    source: &frames::SampledTake,
    reduced: &Take,
    skeleton: &Skeleton,
    settings: &ReduceSettings,
) -> Measurement {
    let lengths = Lengths::of(settings);
    let bones = skeleton.len();
    let mut poses = vec![Transform::IDENTITY; bones];
    let mut matrices = vec![Mat4::IDENTITY; bones];
    let mut found = Measurement { frames: source.times.len(), largest: None, tightest: None };
    for (frame, &time) in source.times.iter().enumerate() {
        sample_take(Some(reduced), skeleton, time, &mut poses);
        to_root(skeleton, &poses, &mut matrices);
        for (bone, &matrix) in matrices.iter().enumerate() {
            let at = frame * bones + bone;
            let error = deviation(source.to_root[at], matrix, lengths.shell);
            found.note(Deviation {
                bone: bone as u32,
                time,
                millimeters: error * lengths.millimeters_per_unit,
                tolerance: source.tolerance(at, lengths) * lengths.millimeters_per_unit,
            });
        }
    }
    found
}

/// Returns the largest distance between `a * point` and `b * point` over all points `shell` away from the origin, or a
/// little more; see the formula above. In the unit of the matrices.
pub(super) fn deviation(a: Mat4, b: Mat4, shell: f64) -> f64 {
    deviation_above(a, b, shell, -1.0)
}

/// As [`deviation`], for callers to which only an error above `known` matters: an error that is certainly below may be
/// overestimated, but never to more than `known`.
pub(super) fn deviation_above(a: Mat4, b: Mat4, shell: f64, known: f64) -> f64 {
    if a == b {
        return 0.0;
    }
    let column =
        |column: usize| -> DVec3 { (a.col(column).as_dvec4() - b.col(column).as_dvec4()).truncate() };
    let moved = column(3);
    let turned = DMat3::from_cols(column(0), column(1), column(2));
    let along = (turned.transpose() * moved).length();
    let without_stretch = moved.length_squared() + 2.0 * shell * along;
    let squares = turned.transpose() * turned;
    // The sum of the eigenvalues needs no further computation and is no less than the largest of them.
    let sum = squares.x_axis.x + squares.y_axis.y + squares.z_axis.z;
    let bound = (without_stretch + shell * shell * sum).sqrt();
    if bound <= known {
        bound
    } else {
        (without_stretch + shell * shell * largest_eigenvalue(squares)).sqrt()
    }
}

/// Returns the largest eigenvalue of a symmetric matrix without negative eigenvalues, by the trigonometric solution of
/// its cubic (O. K. Smith, "Eigenvalues of a symmetric 3 × 3 matrix", Communications of the ACM 4, 1961).
fn largest_eigenvalue(matrix: DMat3) -> f64 {
    let mean = (matrix.x_axis.x + matrix.y_axis.y + matrix.z_axis.z) / 3.0;
    let centered = matrix - DMat3::from_diagonal(DVec3::splat(mean));
    let squares = centered.to_cols_array().into_iter().map(|number| number * number).sum::<f64>();
    let spread = (squares / 6.0).sqrt();
    if spread <= 0.0 {
        return mean.max(0.0);
    }
    let third = libm::acos(((centered * (1.0 / spread)).determinant() / 2.0).clamp(-1.0, 1.0)) / 3.0;
    mean + 2.0 * spread * libm::cos(third)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{Quat, Vec3};

    /// Returns points spread evenly over the unit sphere.
    fn sphere(count: u32) -> impl Iterator<Item = DVec3> {
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        (0..count).map(move |k| {
            let z = 1.0 - 2.0 * (f64::from(k) + 0.5) / f64::from(count);
            let (sin, cos) = (golden * f64::from(k)).sin_cos();
            DVec3::new(cos * (1.0 - z * z).sqrt(), sin * (1.0 - z * z).sqrt(), z)
        })
    }

    fn largest_of_points(a: Mat4, b: Mat4, shell: f64) -> f64 {
        let (a, b) = (a.as_dmat4(), b.as_dmat4());
        let error = |u: DVec3| a.transform_point3(u * shell).distance(b.transform_point3(u * shell));
        sphere(4_000).map(error).fold(0.0, f64::max)
    }

    #[test]
    fn the_error_of_a_turn_and_a_shift_is_that_of_the_worst_point() {
        let turn = Quat::from_xyzw(0.3, -0.5, 0.2, 0.7).normalize();
        let a = Mat4::from_scale_rotation_translation(Vec3::ONE, turn, Vec3::new(1.0, 2.0, 3.0));
        for (axis, angle, shift) in [
            (Vec3::X, 0.001, Vec3::ZERO),
            (Vec3::ONE, 0.5, Vec3::new(0.01, 0.0, 0.03)),
            (Vec3::Y, 3.0, Vec3::new(0.5, -0.25, 0.0)),
        ] {
            let other = turn * Quat::from_axis_angle(axis.normalize(), angle);
            let b = Mat4::from_rotation_translation(other, Vec3::new(1.0, 2.0, 3.0) + shift);
            let (bound, points) = (deviation(a, b, 0.3), largest_of_points(a, b, 0.3));
            assert!(points <= bound * (1.0 + 1e-9), "{points} exceeds {bound}");
            assert!(bound < points * 1.002, "{bound} is far above {points}");
        }
    }

    #[test]
    fn the_error_of_a_stretch_is_never_less_than_that_of_any_point() {
        let mut state = 1_u32;
        let mut next = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / 8_388_608.0 - 1.0
        };
        for _ in 0..200 {
            let mut matrix = || Mat4::from_cols_array(&[(); 16].map(|()| next()));
            let mut affine = || {
                let mut matrix = matrix();
                (matrix.x_axis.w, matrix.y_axis.w, matrix.z_axis.w, matrix.w_axis.w) = (0.0, 0.0, 0.0, 1.0);
                matrix
            };
            let (a, b) = (affine(), affine());
            let (bound, points) = (deviation(a, b, 0.5), largest_of_points(a, b, 0.5));
            assert!(points <= bound * (1.0 + 1e-9), "{points} exceeds {bound}");
            assert!(bound < points * 1.5, "{bound} is far above {points}");
        }
    }
}
