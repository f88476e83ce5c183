//! Numeric functions that all parts of the model use.
//!
//! The model is built twice and compared byte for byte, so nothing here asks the platform's
//! mathematics library: only `+ - * /`, `sqrt` and `floor`, which IEEE 754 fixes exactly.

use glam::{Quat, Vec3};
use std::f64::consts::TAU;

/// Sine of an angle in radians, the same bits everywhere.
pub(super) fn sin(radians: f32) -> f32 {
    let turns = f64::from(radians) / TAU;
    let mut t = turns - turns.floor();
    // Fold into -1/4..1/4 of a turn, where the short series is exact to single precision.
    if t > 0.75 {
        t -= 1.0;
    } else if t > 0.25 {
        t = 0.5 - t;
    }
    let x = t * TAU;
    let x2 = x * x;
    let tail = 1.0 - x2 / 110.0 * (1.0 - x2 / 156.0 * (1.0 - x2 / 210.0));
    let body = 1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0 * tail));
    (x * (1.0 - x2 / 6.0 * body)) as f32
}

/// Cosine of an angle in radians, the same bits everywhere.
pub(super) fn cos(radians: f32) -> f32 {
    sin(radians + std::f32::consts::FRAC_PI_2)
}

/// `a` at `t = 0`, `b` at `t = 1`.
pub(super) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// 0 below `from`, 1 above `to`, with a smooth rise between.
pub(super) fn smooth(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A soft hump: 1 at `center`, 0 from `half` away on.
pub(super) fn bump(center: f32, half: f32, x: f32) -> f32 {
    1.0 - smooth(0.0, half, (x - center).abs())
}

/// A smooth curve through `points` (x ascending) that never overshoots them.
pub(super) fn curve(points: &[(f32, f32)], x: f32) -> f32 {
    let last = points.len() - 1;
    if x <= points[0].0 {
        return points[0].1;
    }
    if x >= points[last].0 {
        return points[last].1;
    }
    let i = (0..last).rfind(|&i| points[i].0 <= x).unwrap_or(0);
    let secant = |k: usize| (points[k + 1].1 - points[k].1) / (points[k + 1].0 - points[k].0);
    // The harmonic mean of neighboring secants keeps each piece monotone.
    let slope = |k: usize| {
        if k == 0 {
            return secant(0);
        }
        if k == last {
            return secant(last - 1);
        }
        let (a, b) = (secant(k - 1), secant(k));
        if a * b <= 0.0 { 0.0 } else { 2.0 * a * b / (a + b) }
    };
    let (x0, y0) = points[i];
    let (x1, y1) = points[i + 1];
    let h = x1 - x0;
    let t = (x - x0) / h;
    let (t2, t3) = (t * t, t * t * t);
    y0 * (2.0 * t3 - 3.0 * t2 + 1.0)
        + slope(i) * h * (t3 - 2.0 * t2 + t)
        + y1 * (3.0 * t2 - 2.0 * t3)
        + slope(i + 1) * h * (t3 - t2)
}

/// A well-mixed number in 0..1 for a lattice point.
pub(super) fn hash(x: i32, y: i32, seed: u32) -> f32 {
    let mut h = (x as u32).wrapping_mul(0x9E37_79B1) ^ (y as u32).wrapping_mul(0x85EB_CA77);
    h ^= seed.wrapping_mul(0xC2B2_AE3D);
    h = (h ^ (h >> 15)).wrapping_mul(0x2C1B_3C6D);
    h = (h ^ (h >> 12)).wrapping_mul(0x297A_2D39);
    h ^= h >> 15;
    (h >> 8) as f32 / 16_777_216.0
}

/// Smooth noise in 0..1 with features about one unit across.
pub(super) fn noise(x: f32, y: f32, seed: u32) -> f32 {
    let (fx, fy) = (x.floor(), y.floor());
    let (ix, iy) = (fx as i32, fy as i32);
    let (tx, ty) = (smooth(0.0, 1.0, x - fx), smooth(0.0, 1.0, y - fy));
    let top = mix(hash(ix, iy, seed), hash(ix + 1, iy, seed), tx);
    let low = mix(hash(ix, iy + 1, seed), hash(ix + 1, iy + 1, seed), tx);
    mix(top, low, ty)
}

/// Three octaves of [`noise`], in 0..1.
pub(super) fn fractal(x: f32, y: f32, seed: u32) -> f32 {
    (noise(x, y, seed) * 4.0
        + noise(x * 2.03, y * 2.03, seed + 1) * 2.0
        + noise(x * 4.11, y * 4.11, seed + 2))
        / 7.0
}

/// The rotation by `degrees` about a unit `axis`.
pub(super) fn turn(axis: Vec3, degrees: f32) -> Quat {
    let half = degrees.to_radians() * 0.5;
    let v = axis * sin(half);
    Quat::from_xyzw(v.x, v.y, v.z, cos(half))
}

/// Yaw about Y, then roll about Z, then pitch about X, each in degrees, as one rotation.
pub(super) fn yzx(y: f32, z: f32, x: f32) -> Quat {
    turn(Vec3::Y, y) * turn(Vec3::Z, z) * turn(Vec3::X, x)
}

/// The shorter way from `a` to `b` at `t` in 0..1.
pub(super) fn blend(a: Quat, b: Quat, t: f32) -> Quat {
    let b = if a.dot(b) < 0.0 { -b } else { b };
    (a * (1.0 - t) + b * t).normalize()
}
