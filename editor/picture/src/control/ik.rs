//! Drawing inverse kinematics: a small frame around a pinned joint, and a line along the chain of bones that rotate when
//! its end is moved, with a dot at its fixed root.

use super::component::{ControlFrame, GraphicComponent};
use crate::appearance::Appearance;
use crate::gizmo::{GizmoRole, GizmoShape, GizmoView};
use dragonfly_anim::data::BoneIndex;
use glam::{Vec2, Vec3};

/// Half the size of the frame of a pin, of the dot in it, and of the dot at the root of a chain; points.
const PIN: f32 = 7.0;
const DOT: f32 = 2.2;
const ROOT: f32 = 3.6;

/// Pins and a chain of inverse kinematics.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IkLook {
    /// Pinned bones.
    pub pins: Vec<BoneIndex>,
    /// The end of the chain, which is moved, and the number of bones above it that follow.
    pub chain: Option<(BoneIndex, u32)>,
    /// The bone that the chain bends towards.
    pub pole: Option<BoneIndex>,
}

/// The pins and the chain that are shown; `None` for neither.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IkAppearance(pub Option<IkLook>);

impl Appearance for IkAppearance {}

/// Draws pins and a chain.
#[derive(Default)]
pub(super) struct IkGraphic;

impl GraphicComponent for IkGraphic {
    fn present(&mut self, frame: &ControlFrame<'_>, shape: &mut GizmoShape) {
        let Some(IkAppearance(Some(look))) = frame.appearances.get() else { return };
        let [_, _, width, height] = frame.look.viewport;
        let pixels = Vec2::new(width as f32, height as f32);
        let view = GizmoView::of_pixels(frame.camera, pixels, frame.look.pixels_per_point);
        let (right, up) = (frame.camera.right(), frame.camera.up());
        let unit = |at: Vec3| Some(view.units_per_point(at.as_dvec3())? as f32);
        let joint = |bone: BoneIndex| {
            let at = frame.model.to_root().get(bone as usize)?.w_axis.truncate();
            (at.is_finite() && !frame.look.hidden.is_hidden(bone)).then_some(at)
        };
        if let Some((end, length)) = look.chain {
            let skeleton = &frame.model.loaded().model.animation.skeleton;
            let mut below = joint(end);
            let mut middle = None;
            for bone in skeleton.ancestors(end).take(length as usize) {
                let at = joint(bone);
                if let (Some(from), Some(to)) = (at, below) {
                    shape.add_line(from, to, GizmoRole::View, 0.9);
                }
                middle = middle.or(at);
                below = at;
            }
            if let (Some(root), Some(_)) = (below.filter(|_| skeleton.parent(end).is_some()), middle)
                && let Some(unit) = unit(root)
            {
                shape.add_diamond(root, right * ROOT * unit, up * ROOT * unit, GizmoRole::View, 0.9);
            }
            if let (Some(middle), Some(pole)) = (middle, look.pole.and_then(joint)) {
                shape.add_line(middle, pole, GizmoRole::View, 0.35);
            }
        }
        for at in look.pins.iter().filter_map(|&bone| joint(bone)) {
            let Some(unit) = unit(at) else { continue };
            let (across, high) = (right * PIN * unit, up * PIN * unit);
            let corners = [at - across - high, at + across - high, at + across + high, at - across + high];
            for (index, &corner) in corners.iter().enumerate() {
                shape.add_line(corner, corners[(index + 1) % 4], GizmoRole::Hover, 0.9);
            }
            shape.add_diamond(at, right * DOT * unit, up * DOT * unit, GizmoRole::Hover, 0.9);
        }
    }
}
