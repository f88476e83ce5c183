//! The canvas of the curves, and what is under the pointer on it: a key, or the handle of a tangent.

use super::curve::Curve;
use super::id::CurveId;
use super::scales::CurveScales;
use super::tangents::{TangentHandle, Tangents};
use crate::panels::context::PanelContext;
use crate::panels::keys::intervals::keys_between;
use crate::panels::keys::{Drawn, TimeScale};
use egui::{Pos2, pos2};
use std::sync::Arc;

/// Target under the pointer.
#[derive(Clone, Debug)]
pub(super) enum CurveTarget {
    Nothing,
    Key(CurveKey),
    Handle(TangentHandle),
}

/// A key under the pointer, on the curve of one component.
#[derive(Clone, Debug)]
pub(super) struct CurveKey {
    pub(super) curve: Arc<Curve>,
    pub(super) key: usize,
    pub(super) component: usize,
    pub(super) selected: bool,
}

/// A point of the curve of one component.
#[derive(Clone, Debug)]
pub(super) struct CurvePoint {
    pub(super) curve: Arc<Curve>,
    pub(super) component: usize,
    /// Value of the curve there.
    pub(super) number: f32,
}

/// Distance within which something is under the pointer, points.
const REACH: f32 = 8.0;
impl CurveKey {
    /// Returns its time, seconds.
    pub(super) fn time(&self) -> f32 {
        self.curve.times().get(self.key).copied().unwrap_or_default()
    }
}

/// Everything that a drag on the curves reads in one frame.
pub(super) struct CurveCanvas<'a> {
    pub(super) curves: &'a [Arc<Curve>],
    pub(super) drawn: &'a Drawn,
    pub(super) time: &'a TimeScale,
    pub(super) scales: &'a CurveScales,
    /// A bit for each component that is shown.
    pub(super) components: u8,
    pub(super) tangents: &'a Tangents,
    pub(super) context: &'a PanelContext<'a>,
}

impl CurveCanvas<'_> {
    /// Returns the components of a curve that are shown.
    pub(super) fn components(&self, curve: &Curve) -> impl Iterator<Item = usize> + use<> {
        curve.shown(self.components)
    }

    /// Returns what is under the pointer.
    pub(super) fn target_at(&self, pointer: Pos2) -> CurveTarget {
        if self.context.keys.draws_box() {
            return CurveTarget::Nothing;
        }
        if let Some(handle) = self.tangents.under(pointer, REACH) {
            return CurveTarget::Handle(handle);
        }
        let mut best: Option<(f32, CurveKey)> = None;
        let stretch = [self.time.time_at(pointer.x - REACH), self.time.time_at(pointer.x + REACH)];
        for curve in self.curves {
            let keys = keys_between(curve.times(), stretch);
            // Keys this dense have no dots, and cannot be pressed on.
            if keys.len() > 8 {
                continue;
            }
            let scales = self.scales.all(curve.id);
            for key in keys {
                let (x, numbers) = (self.time.x_of(curve.times()[key]), curve.key(key));
                for component in self.components(curve) {
                    let distance = pos2(x, scales[component].y_of(numbers[component])).distance(pointer);
                    if distance <= REACH && best.as_ref().is_none_or(|(least, _)| distance < *least) {
                        let selected = curve.is_chosen(key, curve.id.selected(&self.drawn.selection));
                        best =
                            Some((distance, CurveKey { curve: Arc::clone(curve), key, component, selected }));
                    }
                }
            }
        }
        best.map_or(CurveTarget::Nothing, |(_, on)| CurveTarget::Key(on))
    }

    /// Returns the curve nearest to the pointer, if it is near enough, with its component and its value there.
    pub(super) fn curve_at(&self, pointer: Pos2) -> Option<CurvePoint> {
        let time = self.time.time_at(pointer.x);
        let mut best: Option<(f32, CurvePoint)> = None;
        for curve in self.curves {
            let (numbers, scales) = (curve.drawn_at(time), self.scales.all(curve.id));
            for component in self.components(curve) {
                let distance = (scales[component].y_of(numbers[component]) - pointer.y).abs();
                if distance <= REACH && best.as_ref().is_none_or(|(least, _)| distance < *least) {
                    let (curve, number) = (Arc::clone(curve), numbers[component]);
                    best = Some((distance, CurvePoint { curve, component, number }));
                }
            }
        }
        best.map(|(_, found)| found)
    }

    /// Returns bone, channel, value and time of a key as text.
    pub(super) fn description(&self, on: &CurveKey) -> String {
        let number = on.curve.key(on.key)[on.component];
        self.description_at(&on.curve, on.component, number, on.time())
    }

    /// Returns bone, channel, value and time of a point of a curve as text.
    pub(super) fn description_at(&self, curve: &Curve, component: usize, number: f32, time: f32) -> String {
        let name = match curve.id {
            CurveId::Bone(bone, property) => {
                let (bone, axis) = (self.context.bone_name(bone), component_name(component));
                format!("{bone} {} {axis}", property.name())
            }
            CurveId::Shape { instance, shape } => self.context.shape_name(instance, shape).to_owned(),
        };
        format!("{name}  {number:.3}  at {time:.3} s")
    }
}

/// Returns the text for a change of a component of a curve by the pointer.
pub(super) fn change_text(id: CurveId, component: usize, by: f32) -> String {
    if id.is_shape() { format!("{by:+.3}") } else { format!("{} {by:+.3}", component_name(component)) }
}

/// Returns the letter of a component: X, Y, Z, W.
pub(super) fn component_name(component: usize) -> &'static str {
    ["X", "Y", "Z", "W"].get(component).copied().unwrap_or("?")
}
