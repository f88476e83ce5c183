//! Limbs: slender rounded pieces between two points, and the left legs made of them.

use super::chart::{self, Chart};
use super::mesh::{Bind, DemoMesh, MeshPatch, even};
use super::num::{cos, curve, sin};
use super::skeleton::{LEG_JOINTS, THORAX, leg};
use glam::Vec3;
use std::f32::consts::TAU;

/// One rounded, slightly bowed piece.
pub(super) struct Limb {
    pub(super) from: Vec3,
    pub(super) to: Vec3,
    /// Radius at fractions of the length.
    pub(super) radius: &'static [(f32, f32)],
    /// Height over width of its section.
    pub(super) flat: f32,
    /// Fraction of the length, at either end, over which the ends are rounded.
    pub(super) cap: f32,
    /// Distance of its middle from the straight line.
    pub(super) bow: Vec3,
    pub(super) rows: usize,
    pub(super) sides: usize,
    pub(super) chart: Chart,
}

/// Adds a limb; `bind` returns the bones of a vertex from its fraction of the length and its position.
pub(super) fn add_limb(mesh: &mut DemoMesh, limb: &Limb, bind: &dyn Fn(f32, Vec3) -> Bind) {
    let along = (limb.to - limb.from).normalize();
    let up = (Vec3::Y - along * along.y).normalize();
    let side = along.cross(up);
    let surface = |u: f32, v: f32| {
        let off = ((u - 0.5).abs() - (0.5 - limb.cap)).max(0.0) / limb.cap;
        let round = (1.0 - off * off).max(0.0).sqrt();
        let r = curve(limb.radius, u) * round;
        let angle = (v + 0.5) * TAU;
        limb.from.lerp(limb.to, u)
            + limb.bow * (4.0 * u * (1.0 - u))
            + (up * cos(angle) * limb.flat + side * sin(angle)) * r
    };
    // Rows close up towards the ends, where the caps curve.
    let rows: Vec<f32> = even(limb.rows)
        .into_iter()
        .map(|t| 0.35 * t + 0.65 * 0.5 * (1.0 - cos(t * std::f32::consts::PI)))
        .collect();
    let patch =
        MeshPatch { surface: &surface, us: &rows, vs: &even(limb.sides + 1), chart: limb.chart, flip: true };
    mesh.grid(&patch, bind);
}

const COXA: &[(f32, f32)] = &[(0.0, 0.0115), (0.5, 0.0105), (1.0, 0.0072)];
const FEMUR: &[(f32, f32)] =
    &[(0.0, 0.0062), (0.15, 0.0072), (0.45, 0.0066), (0.85, 0.0046), (0.95, 0.0056), (1.0, 0.0056)];
const TIBIA: &[(f32, f32)] = &[(0.0, 0.0050), (0.06, 0.0046), (0.15, 0.0036), (0.8, 0.0032), (1.0, 0.0036)];
const TARSUS: &[(f32, f32)] =
    &[(0.0, 0.0032), (0.3, 0.0026), (0.34, 0.0030), (0.6, 0.0024), (0.64, 0.0029), (1.0, 0.0020)];

/// Adds the three left legs, with the rows of spines that make them a catching basket.
pub(super) fn add(mesh: &mut DemoMesh) {
    for (pair, joints) in LEG_JOINTS.iter().enumerate() {
        for part in 0..4 {
            let (from, to) = (joints[part], joints[part + 1]);
            let along = (to - from).normalize();
            let (radius, chart, rows, sides) = match part {
                0 => (COXA, chart::COXA, 6, 7),
                1 => (FEMUR, chart::FEMUR, 9, 7),
                2 => (TIBIA, chart::TIBIA, 8, 6),
                _ => (TARSUS, chart::TARSUS, 8, 5),
            };
            // Pieces overlap as balls in sockets, so a joint may fold without a gap.
            let overlap = [0.010, 0.005, 0.004, 0.0025][part];
            let length = (to - from).length() + 2.0 * overlap;
            let limb = Limb {
                from: from - along * overlap,
                to: to + along * if part == 3 { 0.0 } else { overlap },
                radius,
                flat: 1.0,
                cap: (1.2 * radius[0].1 / length).min(0.45),
                bow: if part == 1 { Vec3::Y * 0.006 } else { Vec3::ZERO },
                rows,
                sides,
                chart,
            };
            let bone = leg(0, pair, part);
            let before = if part == 0 { THORAX } else { leg(0, pair, part - 1) };
            add_limb(mesh, &limb, &|u, _| {
                // The first ring of each piece is bound in part to the bone of the piece before.
                Bind::chain(&[(before, -1.0, 0.0), (bone, 0.04, 0.06)], u)
            });
            if part == 1 || part == 2 {
                spines(mesh, pair, part);
            }
            if part == 3 {
                claws(mesh, to, along, Bind::to(bone));
            }
        }
    }
}

/// Spines along the underside of a femur or tibia, in two rows.
fn spines(mesh: &mut DemoMesh, pair: usize, part: usize) {
    let joints = &LEG_JOINTS[pair];
    let (from, to) = (joints[part], joints[part + 1]);
    let along = (to - from).normalize();
    let bend = (joints[2] - joints[1]).cross(joints[3] - joints[2]).normalize();
    // Inside of the fold: where femur and tibia close on each other.
    let inner = bend.cross(along);
    let count = if part == 1 { 4 } else { 6 };
    let radius = if part == 1 { 0.0055 } else { 0.0030 };
    let bow = if part == 1 { 0.006 } else { 0.0 };
    for k in 0..count {
        for row in [-1.0, 1.0_f32] {
            let t = 0.2 + 0.72 * (k as f32 + 0.25 * (row + 1.0)) / count as f32;
            let out = (inner * 0.8 + bend * row * 0.6).normalize();
            let foot = from.lerp(to, t) + Vec3::Y * bow * 4.0 * t * (1.0 - t) + out * radius * 0.7;
            let length = if part == 1 { 0.010 } else { 0.017 };
            let tip = foot + (out + along * 0.7).normalize() * length;
            let uv = chart::DARK.uv(0.5, 0.5);
            mesh.spine(foot, tip, 0.0010, uv, Bind::to(leg(0, pair, part)));
        }
    }
}

/// The pair of claws at a toe's end.
fn claws(mesh: &mut DemoMesh, toe: Vec3, along: Vec3, bind: Bind) {
    let side = along.cross(Vec3::Y).normalize();
    for row in [-1.0, 1.0_f32] {
        let tip = toe + along * 0.007 + side * row * 0.005 - Vec3::Y * 0.001;
        mesh.spine(toe - along * 0.002, tip, 0.0014, chart::DARK.uv(0.5, 0.5), bind);
    }
}
