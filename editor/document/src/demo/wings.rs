//! The four wings: thin pleated sheets.

use super::chart::WING_SCALE;
use super::mesh::{Bind, DemoMesh, MeshPatch};
use super::num::{curve, smooth};
use super::skeleton::{WING_JOINTS, wing};
use super::wing_plan::{PICTURE, PLANS};
use glam::Vec3;

/// Adds both left wings.
pub(super) fn add(mesh: &mut DemoMesh) {
    // Close rows where the outline turns: at the hinge and round the tip.
    const SPANS: [f32; 25] = [
        0.0, 0.014, 0.024, 0.034, 0.05, 0.08, 0.12, 0.17, 0.22, 0.28, 0.34, 0.40, 0.46, 0.52, 0.58, 0.64,
        0.70, 0.76, 0.82, 0.87, 0.91, 0.945, 0.97, 0.988, 1.0,
    ];
    // Rows of the pleats: costa, subcosta and radius at the leading edge, then the field.
    const CHORDS: [f32; 9] = [0.0, 0.06, 0.12, 0.20, 0.30, 0.42, 0.58, 0.78, 1.0];
    const PLEATS: [(f32, f32); 9] = [
        (0.0, 0.0004),
        (0.06, -0.0022),
        (0.12, 0.0016),
        (0.20, -0.0016),
        (0.30, 0.0014),
        (0.42, -0.0006),
        (0.58, 0.0012),
        (0.78, 0.0002),
        (1.0, -0.0016),
    ];
    /// The sheet reaches this far past the painted outline, which is what the eye sees.
    const RIM: f32 = 0.003;
    for (pair, plan) in PLANS.iter().enumerate() {
        let flat = |u: f32, v: f32| {
            let span = PICTURE.0 + 0.004 + (plan.length + RIM - PICTURE.0 - 0.004) * u;
            let (lead, trail) = (plan.lead(span) + RIM, plan.trail(span) - RIM);
            (span, lead + (trail - lead) * v)
        };
        let surface = |u: f32, v: f32| {
            let (span, chord) = flat(u, v);
            let fade = smooth(0.0, 0.06, span) * (1.0 - smooth(0.5, 1.0, span / plan.length));
            plan.place(span, chord, curve(&PLEATS, v) * fade)
        };
        let bind = |u: f32, _: Vec3| {
            Bind::chain(
                &[
                    (wing(0, pair, 0), 0.0, 0.1),
                    (wing(0, pair, 1), WING_JOINTS[0], 0.20),
                    (wing(0, pair, 2), WING_JOINTS[1], 0.20),
                ],
                u,
            )
        };
        let first = mesh.vertices.len();
        let patch = MeshPatch { surface: &surface, us: &SPANS, vs: &CHORDS, chart: plan.chart, flip: false };
        mesh.grid(&patch, &bind);
        // The picture is a flat map of the wing, not of the grid.
        for (i, vertex) in mesh.vertices[first..].iter_mut().enumerate() {
            let (u, v) = (SPANS[i / CHORDS.len()], CHORDS[i % CHORDS.len()]);
            let (span, chord) = flat(u, v);
            let texel = WING_SCALE;
            vertex.uv = glam::Vec2::new(
                (plan.chart.x + (span - PICTURE.0) * texel) / plan.chart.size.0,
                (plan.chart.y + (PICTURE.1 - chord) * texel) / plan.chart.size.1,
            );
        }
    }
}
