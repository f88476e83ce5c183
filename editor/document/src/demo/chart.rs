//! The textures' areas: where each part of the model is painted.

use glam::Vec2;

/// A rectangle of a texture, in texels of that texture.
#[derive(Clone, Copy)]
pub(super) struct Chart {
    pub(super) x: f32,
    pub(super) y: f32,
    pub(super) w: f32,
    pub(super) h: f32,
    /// Width and height of the whole texture.
    pub(super) size: (f32, f32),
}

impl Chart {
    /// Texture coordinates of the point (`a`, `b`) of the chart, each 0..1. A small margin is
    /// left at the rim so that filtering does not reach the neighboring chart.
    pub(super) fn uv(&self, a: f32, b: f32) -> Vec2 {
        const MARGIN: f32 = 2.0;
        Vec2::new(
            (self.x + MARGIN + a * (self.w - 2.0 * MARGIN)) / self.size.0,
            (self.y + MARGIN + b * (self.h - 2.0 * MARGIN)) / self.size.1,
        )
    }
}

pub(super) const SKIN: (f32, f32) = (1024.0, 512.0);
pub(super) const EYES: (f32, f32) = (512.0, 512.0);
pub(super) const WINGS: (f32, f32) = (1024.0, 512.0);

const fn chart(x: f32, y: f32, w: f32, h: f32, size: (f32, f32)) -> Chart {
    Chart { x, y, w, h, size }
}

// U runs along a part, front to back or root to tip; V runs round it from its upper side.
pub(super) const ABDOMEN: Chart = chart(0.0, 0.0, 1024.0, 176.0, SKIN);
pub(super) const THORAX: Chart = chart(0.0, 176.0, 336.0, 336.0, SKIN);
pub(super) const HEAD: Chart = chart(336.0, 176.0, 272.0, 272.0, SKIN);
pub(super) const FEMUR: Chart = chart(608.0, 176.0, 416.0, 80.0, SKIN);
pub(super) const TIBIA: Chart = chart(608.0, 256.0, 416.0, 64.0, SKIN);
pub(super) const TARSUS: Chart = chart(608.0, 320.0, 416.0, 48.0, SKIN);
pub(super) const COXA: Chart = chart(608.0, 368.0, 208.0, 80.0, SKIN);
pub(super) const SOCKET: Chart = chart(816.0, 368.0, 208.0, 80.0, SKIN);
pub(super) const DARK: Chart = chart(336.0, 448.0, 688.0, 64.0, SKIN);
pub(super) const EYE: Chart = chart(0.0, 0.0, 512.0, 512.0, EYES);
pub(super) const FORE_WING: Chart = chart(4.0, 4.0, 960.0, 204.0, WINGS);
pub(super) const HIND_WING: Chart = chart(4.0, 216.0, 920.0, 292.0, WINGS);
/// Texels of the wing texture per unit of the model.
pub(super) const WING_SCALE: f32 = 1410.0;
