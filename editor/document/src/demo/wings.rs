//! The four wings: their outline, which the vein texture shares, and their thin pleated sheets.

use super::mesh::{Bind, Chart, DemoMesh, MeshPatch};
use super::num::{cos, curve, sin, smooth};
use super::skeleton::{HINGES, WING_JOINTS, wing};
use super::texture;
use glam::Vec3;

/// The shape of a left wing in its own plane: `span` runs from the hinge to the tip, `chord`
/// from the trailing edge (negative) to the leading one.
pub(super) struct WingPlan {
    /// Hinge to tip, in units.
    pub(super) length: f32,
    hinge: Vec3,
    /// Angle by which the wing is tilted forward, in degrees from a right angle to the body.
    sweep: f32,
    /// Angle by which its tip is raised, in degrees.
    dihedral: f32,
    lead: &'static [(f32, f32)],
    trail: &'static [(f32, f32)],
    /// Area of the wing in the wing texture.
    pub(super) chart: Chart,
}

/// Fore wing, then hind wing.
pub(super) static PLANS: [WingPlan; 2] = [
    WingPlan {
        length: 0.66,
        hinge: HINGES[0],
        sweep: 9.0,
        dihedral: 4.0,
        lead: &[
            (-0.010, 0.005),
            (0.0, 0.006),
            (0.05, 0.013),
            (0.20, 0.018),
            (0.33, 0.0195),
            (0.48, 0.018),
            (0.56, 0.012),
            (0.61, 0.001),
            (0.64, -0.013),
            (0.654, -0.026),
            (0.660, -0.042),
        ],
        trail: &[
            (-0.010, -0.010),
            (0.0, -0.012),
            (0.02, -0.022),
            (0.05, -0.045),
            (0.10, -0.072),
            (0.17, -0.092),
            (0.27, -0.108),
            (0.38, -0.115),
            (0.47, -0.112),
            (0.55, -0.101),
            (0.61, -0.085),
            (0.645, -0.066),
            (0.656, -0.055),
            (0.660, -0.042),
        ],
        chart: texture::FORE_WING,
    },
    WingPlan {
        length: 0.63,
        hinge: HINGES[1],
        sweep: -7.0,
        dihedral: 2.0,
        lead: &[
            (-0.010, 0.005),
            (0.0, 0.006),
            (0.05, 0.013),
            (0.20, 0.018),
            (0.30, 0.018),
            (0.44, 0.014),
            (0.53, 0.005),
            (0.58, -0.008),
            (0.61, -0.024),
            (0.624, -0.039),
            (0.630, -0.055),
        ],
        trail: &[
            (-0.010, -0.014),
            (0.0, -0.020),
            (0.006, -0.060),
            (0.016, -0.094),
            (0.04, -0.128),
            (0.08, -0.150),
            (0.14, -0.163),
            (0.22, -0.167),
            (0.31, -0.163),
            (0.40, -0.152),
            (0.49, -0.134),
            (0.56, -0.111),
            (0.60, -0.090),
            (0.624, -0.069),
            (0.630, -0.055),
        ],
        chart: texture::HIND_WING,
    },
];

/// Start of the texture of either wing along its span, and its upper edge along its chord.
pub(super) const PICTURE: (f32, f32) = (-0.012, 0.024);

impl WingPlan {
    /// The chord of the leading edge at a place of the span.
    pub(super) fn lead(&self, span: f32) -> f32 {
        curve(self.lead, span)
    }

    /// The chord of the trailing edge at a place of the span.
    pub(super) fn trail(&self, span: f32) -> f32 {
        curve(self.trail, span)
    }

    /// The point of model space at (`span`, `chord`), `lift` above the wing's plane.
    fn place(&self, span: f32, chord: f32, lift: f32) -> Vec3 {
        let (sweep, rise) = (self.sweep.to_radians(), self.dihedral.to_radians());
        let out = Vec3::new(cos(sweep) * cos(rise), sin(rise), sin(sweep) * cos(rise));
        let fore = Vec3::new(-sin(sweep), 0.0, cos(sweep));
        self.hinge + out * span + fore * chord + fore.cross(out) * lift
    }

    /// The point of the axis the wing turns about lengthways; `along` is a part of the span.
    pub(super) fn axis(&self, along: f32) -> Vec3 {
        self.place(self.length * along, 0.0, 0.0)
    }
}

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
            let texel = texture::WING_SCALE;
            vertex.uv = glam::Vec2::new(
                (plan.chart.x + (span - PICTURE.0) * texel) / plan.chart.size.0,
                (plan.chart.y + (PICTURE.1 - chord) * texel) / plan.chart.size.1,
            );
        }
    }
}
