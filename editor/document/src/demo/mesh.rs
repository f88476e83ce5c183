//! Vertices, and the one way every surface of the model is made: a smooth function of two
//! parameters, sampled on a grid, with its normal and tangent taken from the function itself.

use super::chart::Chart;
use super::num::smooth;
use super::skeleton::mirrored;
use glam::{Vec2, Vec3, Vec4};

/// Bones and weights of a vertex, in 255ths that sum to 255.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Bind {
    pub(super) joints: [u8; 4],
    pub(super) weights: [u8; 4],
}

impl Bind {
    /// A vertex carried by one bone alone.
    pub(super) fn to(bone: usize) -> Self {
        Self::of(&[(bone, 1.0)])
    }

    /// The four strongest of `parts` (bone, weight), rounded so that the sum stays exact.
    pub(super) fn of(parts: &[(usize, f32)]) -> Self {
        let mut parts: Vec<(usize, f32)> = parts.to_vec();
        parts.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        parts.truncate(4);
        let sum: f32 = parts.iter().map(|p| p.1).sum();
        let (mut joints, mut weights, mut left) = ([0; 4], [0; 4], 255);
        for (i, (bone, weight)) in parts.iter().enumerate().skip(1) {
            let w = (weight / sum * 255.0 + 0.5) as u8;
            // Some readers refuse a joint with a weight of zero.
            if w > 0 {
                (joints[i], weights[i]) = (*bone as u8, w);
                left -= w;
            }
        }
        (joints[0], weights[0]) = (parts[0].0 as u8, left);
        Self { joints, weights }
    }

    /// The bones of a vertex at `x` along a chain. Each of `joints` is (bone, its start along the chain,
    /// half the width of the transition from the bone before).
    pub(super) fn chain(joints: &[(usize, f32, f32)], x: f32) -> Self {
        let grip = |k: usize| match joints.get(k) {
            Some(_) if k == 0 => 1.0,
            Some(&(_, start, half)) => smooth(start - half, start + half, x),
            None => 0.0,
        };
        let parts: Vec<_> = (0..joints.len()).map(|k| (joints[k].0, grip(k) * (1.0 - grip(k + 1)))).collect();
        Self::of(&parts)
    }
}

/// One vertex as it goes into the file.
#[derive(Clone, Copy)]
pub(super) struct DemoVertex {
    pub(super) position: Vec3,
    pub(super) normal: Vec3,
    /// Direction of increasing U; `w` is the sign of the bitangent.
    pub(super) tangent: Vec4,
    pub(super) uv: Vec2,
    pub(super) bind: Bind,
}

/// Triangles that share one material.
#[derive(Default)]
pub(super) struct DemoMesh {
    pub(super) vertices: Vec<DemoVertex>,
    pub(super) indices: Vec<u16>,
}

/// A surface to sample: `surface(u, v)` over the rows `us` and columns `vs`.
pub(super) struct MeshPatch<'a> {
    pub(super) surface: &'a dyn Fn(f32, f32) -> Vec3,
    pub(super) us: &'a [f32],
    pub(super) vs: &'a [f32],
    pub(super) chart: Chart,
    /// Turns the surface inside out: set where `du x dv` points inwards.
    pub(super) flip: bool,
}

impl DemoMesh {
    /// Samples a patch; `bind` gives a vertex's bones from its `u` and position.
    pub(super) fn grid(&mut self, patch: &MeshPatch, bind: &dyn Fn(f32, Vec3) -> Bind) {
        let base = self.vertices.len();
        for &u in patch.us {
            for &v in patch.vs {
                let (normal, tangent) = frame(patch, u, v);
                let position = (patch.surface)(u, v);
                self.vertices.push(DemoVertex {
                    position,
                    normal,
                    tangent,
                    uv: patch.chart.uv(u, v),
                    bind: bind(u, position),
                });
            }
        }
        let columns = patch.vs.len();
        for i in 0..patch.us.len() - 1 {
            for j in 0..columns - 1 {
                let a = base + i * columns + j;
                let (b, c, d) = (a + columns, a + columns + 1, a + 1);
                self.triangle(a, b, c, patch.flip);
                self.triangle(a, c, d, patch.flip);
            }
        }
    }

    /// Adds a triangle unless it has no area, as at a pole where a row is one point.
    pub(super) fn triangle(&mut self, a: usize, b: usize, c: usize, flip: bool) {
        let [p, q, r] = [a, b, c].map(|i| self.vertices[i].position);
        if (q - p).cross(r - p).length_squared() < 1e-18 {
            return;
        }
        let order = if flip { [a, c, b] } else { [a, b, c] };
        let narrow = |i| u16::try_from(i).expect("the model has far fewer than 65536 vertices");
        self.indices.extend(order.map(narrow));
    }

    /// Adds the mirror image across the middle plane, bound to the bones of the other side.
    pub(super) fn mirror(&mut self) {
        let count = self.vertices.len();
        for i in 0..count {
            let vertex = &mut self.vertices[i];
            if vertex.position.x.abs() < 1e-5 {
                // Both halves must agree along the middle line, or a crease would show.
                vertex.position.x = 0.0;
                vertex.normal.x = 0.0;
                vertex.normal = vertex.normal.normalize();
                let t = vertex.tangent.truncate();
                let t = (t - vertex.normal * t.dot(vertex.normal)).normalize();
                vertex.tangent = t.extend(vertex.tangent.w);
            }
            let mut twin = *vertex;
            twin.position.x = -twin.position.x;
            twin.normal.x = -twin.normal.x;
            twin.tangent.x = -twin.tangent.x;
            twin.tangent.w = -twin.tangent.w;
            for (joint, weight) in twin.bind.joints.iter_mut().zip(twin.bind.weights) {
                if weight > 0 {
                    *joint = mirrored(usize::from(*joint)) as u8;
                }
            }
            self.vertices.push(twin);
        }
        let triangles: Vec<u16> = self.indices.clone();
        for t in triangles.chunks_exact(3) {
            let shift = |i: u16| i + count as u16;
            self.indices.extend([shift(t[0]), shift(t[2]), shift(t[1])]);
        }
    }

    /// Adds a thin spine: a three-sided cone from `foot` to `tip`.
    pub(super) fn spine(&mut self, foot: Vec3, tip: Vec3, radius: f32, uv: Vec2, bind: Bind) {
        let along = (tip - foot).normalize();
        let side = along.any_orthonormal_vector();
        let other = along.cross(side);
        let base = self.vertices.len();
        let tangent = along.extend(1.0);
        for k in [0.0, 1.0, 2.0_f32] {
            let angle = k * std::f32::consts::TAU / 3.0;
            let normal = side * super::num::cos(angle) + other * super::num::sin(angle);
            let position = foot + normal * radius;
            self.vertices.push(DemoVertex { position, normal, tangent, uv, bind });
        }
        // The tip has the normal of one of the sides: it is far smaller than a pixel.
        self.vertices.push(DemoVertex { position: tip, normal: side, tangent, uv, bind });
        for k in 0..3 {
            self.triangle(base + k, base + (k + 1) % 3, base + 3, false);
        }
    }
}

/// The unit normal and the tangent of a patch at (`u`, `v`).
fn frame(patch: &MeshPatch, u: f32, v: f32) -> (Vec3, Vec4) {
    const STEP: f32 = 2e-3;
    let f = patch.surface;
    let slopes = |u: f32, v: f32| (f(u + STEP, v) - f(u - STEP, v), f(u, v + STEP) - f(u, v - STEP));
    let (mut du, mut dv) = slopes(u, v);
    if du.cross(dv).length_squared() < 1e-16 {
        // At a pole a whole row is one point, so the surface is evaluated a little away from it.
        let inward = |x: f32| x + (0.5 - x) * 0.02;
        (du, dv) = slopes(inward(u), inward(v));
    }
    let mut normal = du.cross(dv).normalize();
    if patch.flip {
        normal = -normal;
    }
    let tangent = (du - normal * du.dot(normal)).normalize();
    // Green points up the image while V runs down it, so the bitangent opposes `dv`.
    let w = if normal.cross(tangent).dot(dv) < 0.0 { 1.0 } else { -1.0 };
    (normal, tangent.extend(w))
}

/// `n` evenly spaced numbers from 0 to 1.
pub(super) fn even(n: usize) -> Vec<f32> {
    (0..n).map(|i| i as f32 / (n - 1) as f32).collect()
}
