//! Pins and rows of bones that follow, as they are drawn: a small frame around a joint that stays, a line along the bones
//! that turn when its end is moved, with a dot where it is fixed.

use super::{Frame, GraphicComponent};
use crate::gizmo::{GizmoRole, GizmoShape, GizmoView};
use crate::message::{Appearance, IkLook};
use dragonfly_anim::data::BoneIndex;
use glam::{Vec2, Vec3};

/// Half of the frame of a pin, of the dot in it, and of the dot at the root of a row; points.
const PIN: f32 = 7.0;
const DOT: f32 = 2.2;
const ROOT: f32 = 3.6;

/// See the module.
#[derive(Default)]
pub(super) struct IkGraphic {
    look: Option<IkLook>,
}

impl GraphicComponent for IkGraphic {
    fn receive(&mut self, appearance: &Appearance) -> bool {
        let Appearance::Ik(look) = appearance else { return false };
        self.look.clone_from(look);
        true
    }

    fn present(&mut self, frame: &Frame<'_>, shape: &mut GizmoShape) {
        let Some(look) = &self.look else { return };
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
            let bones = &frame.model.loaded().model.animation.skeleton.bones;
            // A parent that does not come before its child counts as none, so there is an end.
            let parent = |bone: &BoneIndex| bones.get(*bone as usize)?.parent.filter(|parent| parent < bone);
            let mut below = joint(end);
            let mut middle = None;
            for bone in std::iter::successors(parent(&end), parent).take(length as usize) {
                let at = joint(bone);
                if let (Some(from), Some(to)) = (at, below) {
                    shape.add_line(from, to, GizmoRole::View, 0.9);
                }
                middle = middle.or(at);
                below = at;
            }
            if let (Some(root), Some(_)) = (below.filter(|_| parent(&end).is_some()), middle)
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
