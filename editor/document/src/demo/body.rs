//! The left half of the trunk: thorax and abdomen, each a tube whose outline is drawn by a few
//! measured sections.

use super::chart;
use super::legs::{Limb, add_limb};
use super::mesh::{Bind, DemoMesh, MeshPatch, even};
use super::num::{bump, cos, curve, sin, smooth};
use super::skeleton::{
    ABDOMEN, ABDOMEN_LENGTH, HEAD, NECK, RINGS, THORAX, abdomen_axis, abdomen_joints, wing,
};
use super::wing_plan::HINGES;
use glam::Vec3;
use std::f32::consts::PI;

/// Front of the neck and back of the thorax, along Z.
const THORAX_Z: (f32, f32) = (0.326, 0.084);

/// The top of the thorax, its bottom and its half width, from front (0) to back (1).
const TOP: [(f32, f32); 10] = [
    (0.0, 0.190),
    (0.08, 0.194),
    (0.14, 0.207),
    (0.20, 0.208),
    (0.30, 0.226),
    (0.42, 0.246),
    (0.55, 0.253),
    (0.72, 0.248),
    (0.87, 0.226),
    (1.0, 0.204),
];
const BOTTOM: [(f32, f32); 8] = [
    (0.0, 0.164),
    (0.08, 0.158),
    (0.16, 0.134),
    (0.30, 0.117),
    (0.50, 0.111),
    (0.68, 0.118),
    (0.86, 0.138),
    (1.0, 0.152),
];
const WIDTH: [(f32, f32); 10] = [
    (0.0, 0.013),
    (0.08, 0.016),
    (0.14, 0.027),
    (0.20, 0.030),
    (0.32, 0.046),
    (0.46, 0.055),
    (0.62, 0.057),
    (0.78, 0.050),
    (0.90, 0.037),
    (1.0, 0.027),
];

fn thorax(u: f32, v: f32) -> Vec3 {
    let (top, bottom) = (curve(&TOP, u), curve(&BOTTOM, u));
    let (s, c) = (sin(v * PI), cos(v * PI));
    // A little squarer than an ellipse: flanks are flat, the back is a ridge between the wings.
    let square = 1.0 + 0.34 * s.abs() * c.abs();
    let (mid, half) = ((top + bottom) * 0.5, (top - bottom) * 0.5);
    let ridge = 0.006 * bump(0.0, 0.22, v) * bump(0.45, 0.35, u);
    // The whole thorax is tilted back: the legs are close together in front, the wings at the back.
    let y = mid + half * c * square + ridge;
    let lean = 0.16 * smooth(0.0, 0.3, u) * (1.0 - smooth(0.8, 1.0, u)) * (y - 0.18);
    Vec3::new(curve(&WIDTH, u) * s * square, y, THORAX_Z.0 + (THORAX_Z.1 - THORAX_Z.0) * u - lean)
}

/// Radius of the abdomen at positions along it: swollen at the base, waisted, then a long
/// taper to a slight club.
const GIRTH: [(f32, f32); 12] = [
    (0.0, 0.0265),
    (0.03, 0.031),
    (0.065, 0.0315),
    (0.105, 0.0225),
    (0.15, 0.0185),
    (0.22, 0.0195),
    (0.36, 0.0215),
    (0.48, 0.0235),
    (0.56, 0.0245),
    (0.615, 0.0225),
    (0.655, 0.0175),
    (0.682, 0.0105),
];

/// Returns the ring at `along`, and the fraction of it, 0 to 1.
pub(super) fn ring_at(along: f32) -> (usize, f32) {
    let mut start = 0.0;
    for (i, length) in RINGS.iter().enumerate() {
        if along < start + length || i == RINGS.len() - 1 {
            return (i, ((along - start) / length).clamp(0.0, 1.0));
        }
        start += length;
    }
    (0, 0.0)
}

fn abdomen(u: f32, v: f32) -> Vec3 {
    let along = u * ABDOMEN_LENGTH;
    let (ring, part) = ring_at(along);
    // Each ring fits into the one before: narrow in front, a rim at its end.
    let step =
        if ring < 9 { 0.055 * smooth(0.75, 0.95, part) - 0.05 * (1.0 - smooth(0.0, 0.1, part)) } else { 0.0 };
    let rim = 1.0 + step - 0.06 * smooth(0.97, 1.0, part) * f32::from(ring < 9);
    // Round the very end off.
    let end = (1.0 - smooth(0.985, 1.0, u) * 0.9).max(0.02);
    let r = curve(&GIRTH, along) * rim * end;
    let (s, c) = (sin(v * PI), cos(v * PI));
    // Broader than high towards the club, with a flat belly.
    let broad = 1.0 + 0.16 * smooth(0.3, 0.55, along);
    let high = if c < 0.0 { 0.82 } else { 1.0 };
    abdomen_axis(along) + Vec3::new(r * s * broad, r * c * high, 0.0)
}

/// Adds the left half of thorax and abdomen, the wing sockets and the tail's clasper.
pub(super) fn add(mesh: &mut DemoMesh) {
    let joints = abdomen_joints();
    let thorax_bind = |_: f32, p: Vec3| {
        Bind::chain(
            &[(HEAD, -1.0, 0.1), (NECK, -0.316, 0.012), (THORAX, -0.296, 0.016), (ABDOMEN, -0.094, 0.022)],
            -p.z,
        )
    };
    let chart = chart::THORAX;
    let patch = MeshPatch { surface: &thorax, us: &even(25), vs: &even(13), chart, flip: true };
    mesh.grid(&patch, &thorax_bind);

    let mut rows = Vec::new();
    let mut start = 0.0;
    for (i, length) in RINGS.iter().enumerate() {
        let parts: &[f32] = match i {
            0 | 8 => &[0.0, 0.3, 0.75, 0.95],
            9 => &[0.0, 0.3, 0.6, 0.8, 0.93, 1.0],
            _ => &[0.0, 0.1, 0.4, 0.72, 0.86, 0.96],
        };
        rows.extend(parts.iter().map(|p| (start + p * length) / ABDOMEN_LENGTH));
        start += length;
    }
    let abdomen_bind = |u: f32, _: Vec3| {
        let mut chain = vec![(THORAX, -1.0, 0.0), (ABDOMEN, joints[0], 0.022)];
        chain.extend(joints.iter().enumerate().skip(1).map(|(i, &at)| {
            // Rings bend where they meet, over about a third of a ring either side.
            let reach = 0.34 * RINGS[i.min(9)].min(RINGS[(i + 1).min(9)]).max(0.05);
            (ABDOMEN + i, at, reach)
        }));
        Bind::chain(&chain, u * ABDOMEN_LENGTH)
    };
    let patch = MeshPatch { surface: &abdomen, us: &rows, vs: &even(10), chart: chart::ABDOMEN, flip: true };
    mesh.grid(&patch, &abdomen_bind);

    for (pair, hinge) in HINGES.into_iter().enumerate() {
        let socket = Limb {
            from: hinge + Vec3::new(-0.016, -0.004, 0.0),
            to: hinge + Vec3::new(0.016, 0.0005, if pair == 0 { 0.0 } else { -0.004 }),
            radius: &[(0.0, 0.0105), (0.5, 0.0085), (1.0, 0.0040)],
            flat: 0.62,
            cap: 0.35,
            bow: Vec3::ZERO,
            rows: 7,
            sides: 8,
            chart: chart::SOCKET,
        };
        add_limb(mesh, &socket, &|u, _| {
            let grip = smooth(0.2, 0.8, u);
            Bind::of(&[(THORAX, 1.0 - grip), (wing(0, pair, 0), grip)])
        });
    }
    let tip = abdomen_axis(ABDOMEN_LENGTH);
    let clasper = Limb {
        from: tip + Vec3::new(0.006, 0.003, 0.006),
        to: tip + Vec3::new(0.012, 0.003, -0.040),
        radius: &[(0.0, 0.0030), (0.6, 0.0052), (1.0, 0.0022)],
        flat: 0.45,
        cap: 0.2,
        bow: Vec3::new(0.004, 0.003, 0.0),
        rows: 8,
        sides: 6,
        chart: chart::DARK,
    };
    add_limb(mesh, &clasper, &|_, _| Bind::to(ABDOMEN + 7));
}
