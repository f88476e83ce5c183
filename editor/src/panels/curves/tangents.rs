//! Tangents of selected keys: two handles that can be dragged, in line with each other unless Alt breaks them.

use super::axis::ValueScale;
use super::curve::{Curve, Slopes};
use super::hues::CurveHues;
use super::id::CurveId;
use super::scales::CurveScales;
use crate::panels::keys::intervals::keys_between;
use crate::panels::keys::{Drawn, TimeScale};
use crate::panels::theme::Theme;
use dragonfly_document::edit::{
    BoneRef, Edit, MeshRef, SetShapeKeys, SetTangents, ShapeKeyAt, ShapeRef, TakeRef,
};
use egui::{Painter, Pos2, Rect, Stroke, Vec2, vec2};
use std::sync::Arc;

/// One handle of a tangent.
#[derive(Clone, Copy, Debug)]
pub(super) struct TangentHandle {
    pub(super) id: CurveId,
    pub(super) key: usize,
    pub(super) component: usize,
    /// Whether it is the incoming tangent, before the key.
    pub(super) arrive: bool,
    /// Position of the key, points.
    center: Pos2,
    /// Position of the handle, points.
    end: Pos2,
    slopes: Slopes,
}

/// The visible handles.
#[derive(Debug, Default)]
pub(super) struct Tangents {
    handles: Vec<TangentHandle>,
}

/// Distance from a key to its handles, points.
const LENGTH: f32 = 44.0;
/// Largest number of keys with handles: more are no help.
const MOST: usize = 48;

impl Tangents {
    /// Finds the handles of the selected keys.
    pub(super) fn update(
        &mut self,
        curves: &[Arc<Curve>],
        drawn: &Drawn,
        time: &TimeScale,
        scales: &CurveScales,
        components: u8,
    ) {
        let value = &scales.view;
        self.handles.clear();
        let mut keys = 0;
        for curve in curves {
            let in_sight = keys_between(
                curve.times(),
                [time.time_at(value.rect.left()), time.time_at(value.rect.right())],
            );
            let chosen = curve.id.selected(&drawn.selection);
            if chosen.is_empty() || curve.interpolation() != dragonfly_anim::data::Interpolation::CubicSpline
            {
                continue;
            }
            let scales = scales.all(curve.id);
            for key in in_sight.take(4096).filter(|&key| curve.is_chosen(key, chosen)) {
                let Some(slopes) = curve.slopes(key) else { continue };
                keys += 1;
                if keys > MOST {
                    return self.handles.clear();
                }
                for component in curve.shown(components) {
                    let center = egui::pos2(
                        time.x_of(curve.times()[key]),
                        scales[component].y_of(curve.key(key)[component]),
                    );
                    for arrive in [true, false] {
                        let slope = if arrive { slopes.arrive } else { slopes.leave }[component];
                        let way = direction(slope, time, &scales[component])
                            * if arrive { -LENGTH } else { LENGTH };
                        let end = center + way;
                        self.handles.push(TangentHandle {
                            id: curve.id,
                            key,
                            component,
                            arrive,
                            center,
                            end,
                            slopes,
                        });
                    }
                }
            }
        }
    }

    pub(super) fn paint(&self, painter: &Painter, hues: &CurveHues, theme: &Theme) {
        for handle in &self.handles {
            let color = hues.color(theme, handle.id, handle.component);
            painter.line_segment([handle.center, handle.end], Stroke::new(1.0, color.gamma_multiply(0.7)));
            painter.circle(handle.end, 3.5, theme.sunken, Stroke::new(1.4, color));
        }
    }

    /// Returns the handle under the pointer.
    pub(super) fn under(&self, pointer: Pos2, reach: f32) -> Option<TangentHandle> {
        let near = self.handles.iter().filter(|handle| handle.end.distance(pointer) <= reach);
        near.min_by(|a, b| a.end.distance(pointer).total_cmp(&b.end.distance(pointer))).copied()
    }

    /// Returns the rectangle of all handles.
    pub(super) fn bounds(&self) -> Option<Rect> {
        self.handles
            .iter()
            .map(|handle| Rect::from_two_pos(handle.center, handle.end))
            .reduce(|a, b| a.union(b))
    }
}

/// Returns the direction of a curve of this slope on the screen, one point long.
fn direction(slope: f32, time: &TimeScale, value: &ValueScale) -> Vec2 {
    let way = vec2(time.per_second() as f32, -(f64::from(slope) * value.per_unit()) as f32);
    let length = way.length();
    if length.is_finite() && length > 0.0 { way / length } else { vec2(0.0, -slope.signum()) }
}

impl TangentHandle {
    /// Returns the slope that brings the handle under the pointer, units per second.
    pub(super) fn slope_at(&self, pointer: Pos2, time: &TimeScale, value: &ValueScale) -> f32 {
        let way = if self.arrive { self.center - pointer } else { pointer - self.center };
        // A handle stays on its side of the key.
        let seconds = f64::from(way.x.max(1.0)) / time.per_second();
        let units = f64::from(-way.y) / value.per_unit();
        (units / seconds).clamp(-1e6, 1e6) as f32
    }

    /// Returns the edit that gives this component the slope, on both sides or, if `broken`, on one.
    pub(super) fn edit(&self, take: TakeRef, curve: &Curve, slope: f32, broken: bool) -> Option<Edit> {
        let with = |mut slopes: [f32; 4]| {
            slopes[self.component] = slope;
            slopes
        };
        let (here, there) = (self.arrive, !self.arrive);
        if let CurveId::Shape { instance, shape } = self.id {
            let (arrive, leave) = match (broken, here) {
                (false, _) => (Some(slope), Some(slope)),
                (true, true) => (Some(slope), None),
                (true, false) => (None, Some(slope)),
            };
            let time = *curve.times().get(self.key)?;
            let (mesh, shape) = (Some(MeshRef::Index(instance)), ShapeRef::Index(shape));
            let key = ShapeKeyAt { time, mesh, shape, weight: None, arrive, leave };
            return Some(Edit::SetShapeKeys(SetShapeKeys { take, keys: vec![key] }));
        }
        let own = if here { self.slopes.arrive } else { self.slopes.leave };
        let other = if here { self.slopes.leave } else { self.slopes.arrive };
        let own = curve.tangent(self.key, here, with(own))?;
        let other = if broken { None } else { Some(curve.tangent(self.key, there, with(other))?) };
        let (arrive, leave) = if here { (Some(own), other) } else { (other, Some(own)) };
        let (bone, property) = self.id.channel()?;
        let time = *curve.times().get(self.key)?;
        Some(Edit::SetTangents(SetTangents {
            take,
            time,
            bone: BoneRef::Index(bone),
            property,
            arrive,
            leave,
        }))
    }
}
