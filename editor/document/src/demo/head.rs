//! The left half of the head: its capsule and face, the feeler, and the great compound eye.

use super::chart;
use super::legs::{Limb, add_limb};
use super::mesh::{Bind, DemoMesh, MeshPatch, even};
use super::num::{cos, curve, sin};
use super::skeleton::{ANTENNA, ANTENNA_ENDS, HEAD};
use glam::Vec3;
use std::f32::consts::FRAC_PI_2;

/// The middle of the capsule.
const CENTRE: Vec3 = Vec3::new(0.0, 0.174, 0.350);
/// Half the width of the capsule between the eyes.
const HALF_WIDTH: f32 = 0.043;

/// Height and depth of the face's outline on the middle line: from the back of the skull over
/// the top, down the face, and back under the chin.
const OUTLINE: [(f32, f32, f32); 14] = [
    (0.00, 0.176, 0.320),
    (0.08, 0.196, 0.328),
    (0.17, 0.210, 0.352),
    (0.25, 0.212, 0.374),
    (0.32, 0.211, 0.391),
    (0.38, 0.204, 0.404),
    (0.45, 0.193, 0.408),
    (0.51, 0.185, 0.4045),
    (0.58, 0.176, 0.4065),
    (0.66, 0.163, 0.404),
    (0.73, 0.150, 0.396),
    (0.82, 0.1385, 0.377),
    (0.91, 0.1395, 0.342),
    (1.00, 0.176, 0.320),
];

fn capsule(u: f32, v: f32) -> Vec3 {
    let y = curve(&OUTLINE.map(|p| (p.0, p.1)), u);
    let z = curve(&OUTLINE.map(|p| (p.0, p.2)), u);
    let (s, c) = (sin(v * FRAC_PI_2), cos(v * FRAC_PI_2));
    // Fuller than an ellipse: the face is a broad shield.
    let full = 0.4 * c + 0.6 * c.max(0.0).sqrt();
    Vec3::new(HALF_WIDTH * s, CENTRE.y + (y - CENTRE.y) * full, CENTRE.z + (z - CENTRE.z) * full)
}

/// Adds the left half of all parts of the head that use the body's texture.
pub(super) fn add(mesh: &mut DemoMesh) {
    let patch = MeshPatch {
        surface: &capsule,
        us: &even(29),
        vs: &[0.0, 0.09, 0.2, 0.32, 0.45, 0.6, 0.78, 0.98],
        chart: chart::HEAD,
        flip: false,
    };
    mesh.grid(&patch, &|_, _| Bind::to(HEAD));
    let [from, to] = ANTENNA_ENDS;
    let feeler = Limb {
        from,
        to,
        radius: &[(0.0, 0.0028), (0.2, 0.0024), (0.26, 0.0011), (1.0, 0.0004)],
        flat: 1.0,
        cap: 0.06,
        bow: Vec3::new(0.0, 0.004, 0.002),
        rows: 9,
        sides: 5,
        chart: chart::DARK,
    };
    add_limb(mesh, &feeler, &|_, _| Bind::to(ANTENNA));
}

/// Angle from its center to its rim that the chart of the eye covers, in radians.
const REACH: f32 = 1.95;

/// The direction from the eye's center that the point (`u`, `v`) of its chart shows. The chart
/// is centered on the way the eye looks, and keeps distances from there true, so that the facets
/// stay even.
pub(super) fn eye_direction(u: f32, v: f32) -> Vec3 {
    let out = Vec3::new(0.78, 0.42, 0.46).normalize();
    let fore = (Vec3::Z - out * out.z).normalize();
    let down = out.cross(fore);
    let (p, q) = ((u * 2.0 - 1.0) * REACH, (v * 2.0 - 1.0) * REACH);
    let r = (p * p + q * q).sqrt();
    let pull = if r < 1e-4 { 1.0 } else { sin(r) / r };
    fore * (p * pull) + down * (q * pull) + out * cos(r)
}

/// Adds the left eye.
pub(super) fn add_eye(mesh: &mut DemoMesh) {
    const MIDDLE: Vec3 = Vec3::new(0.0285, 0.1935, 0.3455);
    const RADII: Vec3 = Vec3::new(0.0465, 0.0485, 0.0510);
    let surface = |u: f32, v: f32| {
        let d = eye_direction(u, v);
        let mut at = MIDDLE + d * RADII;
        // Below, it draws in towards the jaw and back, as a helmet's cheek does.
        let low = (-d.y).max(0.0);
        at.x -= 0.012 * low * low * d.x.max(0.0);
        at.z -= 0.008 * low * low;
        at.y += 0.005 * low * low;
        // The two eyes meet in a flat seam on top of the head and never cross it.
        let k = 0.0035;
        at.x = 0.5 * (at.x + (at.x * at.x + k * k).sqrt());
        at
    };
    let (us, vs) = (even(19), even(19));
    let patch = MeshPatch { surface: &surface, us: &us, vs: &vs, chart: chart::EYE, flip: false };
    mesh.grid(&patch, &|_, _| Bind::to(HEAD));
}
