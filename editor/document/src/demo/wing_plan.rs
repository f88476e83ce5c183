//! The outline of the wings, which sheets, veins and bones share.

use super::chart::{Chart, FORE_WING, HIND_WING};
use super::num::{cos, curve, sin};
use glam::Vec3;

/// The left wings' hinges, fore and hind.
pub(super) const HINGES: [Vec3; 2] = [Vec3::new(0.040, 0.243, 0.214), Vec3::new(0.041, 0.238, 0.146)];

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
        chart: FORE_WING,
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
        chart: HIND_WING,
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
    pub(super) fn place(&self, span: f32, chord: f32, lift: f32) -> Vec3 {
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
