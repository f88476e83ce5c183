//! The curves that are shown. Their numbers are computed when a channel changes, over several frames if it is long.

use super::curve::{Curve, Extent};
use super::form::RotationForm;
use super::given::GivenAngles;
use super::id::{CurveId, SHAPES, bit};
use super::shape_curves::ShapeCurveList;
use crate::panels::context::PanelContext;
use crate::panels::keys::{ChannelId, Drawn, channel};
use dragonfly_anim::data::Take;
use dragonfly_document::edit::Property;
use std::sync::Arc;

/// Largest number of channels: more cannot be distinguished. The label counts the bones that are shown.
pub(in crate::panels) const MOST: usize = 64;
/// Number of keys that are computed per frame.
const BUDGET: usize = 24_000;

/// The curves that are shown.
#[derive(Debug, Default)]
pub(in crate::panels) struct ShownCurves {
    entries: Vec<CurveSlot>,
    /// Counts the changes of curves.
    version: u64,
}

#[derive(Debug)]
struct CurveSlot {
    id: CurveId,
    /// The curve as it is drawn.
    curve: Option<Arc<Curve>>,
    /// The next curve, until all of it is computed.
    next: Option<Box<Curve>>,
}

impl ShownCurves {
    /// Updates the curves of `ids` to `take`, with the angles that keys were given. Returns whether more is to do in the
    /// next frame.
    pub(in crate::panels) fn update(
        &mut self,
        take: &Take,
        ids: &[CurveId],
        form: RotationForm,
        angles: &GivenAngles,
    ) -> bool {
        if self.entries.len() != ids.len() || self.entries.iter().zip(ids).any(|(entry, &id)| entry.id != id)
        {
            let mut old = std::mem::take(&mut self.entries);
            self.entries = ids
                .iter()
                .map(|&id| match old.iter().position(|entry| entry.id == id) {
                    Some(at) => old.swap_remove(at),
                    None => CurveSlot { id, curve: None, next: None },
                })
                .collect();
            self.version += 1;
        }
        let (mut budget, mut more) = (BUDGET, false);
        for entry in &mut self.entries {
            let (number, given) = entry.id.channel().and_then(|id| angles.of(id, form)).unzip();
            let number = number.unwrap_or_default();
            if entry.curve.as_ref().is_some_and(|curve| curve.is_of(take, form, number)) {
                entry.next = None;
                continue;
            }
            // A curve that is being computed is finished although the take changed since: during a drag of many keys the take
            // changes faster than a long curve is computed.
            if entry.next.as_ref().is_none_or(|next| next.form() != form) {
                entry.next = Curve::new(take, entry.id, form, number).map(Box::new);
                if entry.next.is_none() && entry.curve.take().is_some() {
                    self.version += 1;
                }
            }
            if let Some(next) = &mut entry.next {
                next.compute(&mut budget, given);
                // Numbers in another form are never shown instead of the requested ones.
                if next.is_whole() || entry.curve.as_ref().is_some_and(|curve| curve.form() != form) {
                    entry.curve = entry.next.take_if(|next| next.is_whole()).map(|next| Arc::from(*next));
                    self.version += 1;
                }
            }
            more |= entry.next.is_some()
                || entry.curve.as_ref().is_some_and(|curve| !curve.is_of(take, form, number));
        }
        more
    }

    /// Returns a number that grows with every change of a curve.
    pub(super) fn version(&self) -> u64 {
        self.version
    }

    /// Returns the curve of a channel, if it is computed.
    pub(in crate::panels) fn of(&self, id: ChannelId) -> Option<&Arc<Curve>> {
        let id = CurveId::from(id);
        self.entries.iter().find(|entry| entry.id == id)?.curve.as_ref()
    }

    /// Returns the curves that can be drawn.
    pub(super) fn curves(&self) -> impl Iterator<Item = &Arc<Curve>> {
        self.entries.iter().filter_map(|entry| entry.curve.as_ref())
    }

    /// Returns the least and the greatest number of the shown components, at keys and between them.
    pub(super) fn extent(&self, components: u8) -> Option<[f32; 2]> {
        /// Number of keys, of all curves, above which only keys are looked at.
        const LOOKED_AT: usize = 1000;
        let mut all = [f32::INFINITY, f32::NEG_INFINITY];
        let keys: usize = self.curves().map(|curve| curve.times().len()).sum();
        for curve in self.curves() {
            let mut extent = curve.extent(0..curve.times().len());
            if keys <= LOOKED_AT {
                extent = extent.with(&curve.extent_between_keys());
            }
            let Extent { low, high } = extent;
            for at in curve.shown(components) {
                all = [all[0].min(low[at]), all[1].max(high[at])];
            }
        }
        (all[0] <= all[1]).then_some(all)
    }
}

/// Returns the curves that are wanted: channels of the selected bones, or those with selected keys, and shape keys where they are chosen or
/// no bone is selected.
///
/// If the bones have no keys in the wanted properties, returns the channels that have keys, because an empty panel
/// would explain nothing.
pub(super) fn wanted(
    context: &PanelContext<'_>,
    drawn: &Drawn,
    properties: u8,
    shapes: &mut ShapeCurveList,
) -> Vec<CurveId> {
    let shapes = shapes.update(&drawn.take, MOST, context.keys.is_dragging());
    let of_bones: Vec<ChannelId> = context
        .selection
        .bones()
        .iter()
        .rev()
        .flat_map(|&bone| channel::channels(&drawn.take, bone))
        .take(3 * MOST)
        .collect();
    let all = if context.selection.bones().is_empty() {
        drawn.selection.channels().map(|(id, _)| id).take(3 * MOST).collect()
    } else {
        of_bones
    };
    let fits = |id: &&ChannelId| properties & bit(id.1) != 0;
    let mut ids: Vec<ChannelId> = all.iter().filter(fits).take(MOST).copied().collect();
    let wants_shapes = properties & SHAPES != 0 || all.is_empty() && context.selection.bones().is_empty();
    let shapes = if wants_shapes { shapes } else { &[] };
    if ids.is_empty()
        && shapes.is_empty()
        && let Some(&(_, first)) = all.iter().max_by_key(|(_, property)| *property == Property::Rotation)
    {
        ids = all.into_iter().filter(|(_, property)| *property == first).take(MOST).collect();
    }
    ids.into_iter().map(CurveId::from).chain(shapes.iter().copied()).take(MOST).collect()
}
