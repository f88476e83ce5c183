//! The numbers that the selected keys share.

use super::curve::{Curve, CurveNumbers};
use super::id::CurveId;
use super::values::ValueKey;
use crate::panels::keys::Drawn;
use dragonfly_anim::data::Interpolation;
use std::sync::Arc;

/// The selected keys of the shown curves that have the property of the first one. A number is `None` where keys differ.
#[derive(Clone, Copy, Debug)]
pub(super) struct KeyNumbers {
    /// The first of them.
    pub(super) first: ValueKey,
    /// Number of keys.
    pub(super) count: usize,
    /// Time, seconds.
    pub(super) time: Option<f32>,
    /// Value of each component.
    pub(super) values: [Option<f32>; 4],
    /// Whether keys of splines are among them.
    pub(super) splines: bool,
}

/// The slopes that the selected keys of splines share: before and after the key, by component.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct KeySlopes {
    pub(super) slopes: [[Option<f32>; 4]; 2],
    /// Difference below which two slopes are the same: the slope of an angle is a quotient of small differences.
    tolerance: f32,
}

/// Part of the greatest slope of a key below which slopes are the same.
const GRAIN: f32 = 1e-3;

/// Largest number of keys whose slopes are compared and edited at once.
pub(super) const MOST_SLOPES: usize = 2000;

impl KeyNumbers {
    /// Returns the numbers of the selected keys; `None` without any.
    pub(super) fn of(curves: &[Arc<Curve>], drawn: &Drawn) -> Option<Self> {
        let mut found: Option<Self> = None;
        for (curve, key) in selected(curves, drawn) {
            let Some(next) = ValueKey::of(curve, key) else { continue };
            let numbers = found.get_or_insert_with(|| Self {
                first: next,
                count: 0,
                time: Some(next.time),
                values: next.numbers.map(Some),
                splines: false,
            });
            numbers.count += 1;
            numbers.splines |= curve.interpolation() == Interpolation::CubicSpline;
            numbers.time = numbers.time.filter(|&time| time == next.time);
            for (value, number) in numbers.values.iter_mut().zip(next.numbers) {
                *value = value.filter(|&value| value == number);
            }
        }
        found
    }
}

impl KeySlopes {
    /// Returns the slopes of the selected keys of splines; `None` without any.
    pub(super) fn of(curves: &[Arc<Curve>], drawn: &Drawn) -> Option<Self> {
        let mut found: Option<Self> = None;
        for (curve, key) in selected(curves, drawn).take(MOST_SLOPES) {
            let Some(slopes) = curve.slopes(key) else { continue };
            let next = [slopes.arrive, slopes.leave];
            let tolerance =
                1e-6 + GRAIN * next.as_flattened().iter().fold(0.0, |most, slope| slope.abs().max(most));
            let shared = found.get_or_insert(Self { slopes: next.map(|side| side.map(Some)), tolerance });
            shared.tolerance = tolerance.max(shared.tolerance);
            for (shared, next) in shared.slopes.as_flattened_mut().iter_mut().zip(next.as_flattened()) {
                *shared = shared.filter(|&one| (one - next).abs() <= tolerance);
            }
        }
        found
    }

    /// Returns the slope of a component that keys have on both sides.
    pub(super) fn both(&self, component: usize) -> Option<f32> {
        let [arrive, leave] = self.slopes.map(|side| side[component]);
        arrive.filter(|&arrive| leave.is_some_and(|leave| (arrive - leave).abs() <= self.tolerance))
    }
}

/// Returns the curves whose keys numbers and drags without a button are for. All shape keys share the selection of their keys, so only
/// one of them is among these: that of the key that was pressed on last, or the first.
pub(super) fn focused(curves: &[Arc<Curve>], drawn: &Drawn, pressed: Option<CurveId>) -> Vec<Arc<Curve>> {
    let has_keys =
        |curve: &&Arc<Curve>| curve.id.selected(&drawn.selection).keys(curve.times()).next().is_some();
    let shapes = || curves.iter().filter(|curve| curve.id.is_shape()).filter(has_keys).map(|curve| curve.id);
    let one = shapes().find(|&id| Some(id) == pressed).or_else(|| shapes().next());
    curves.iter().filter(|curve| !curve.id.is_shape() || Some(curve.id) == one).cloned().collect()
}

/// Returns the selected keys of curves with the property of the first curve that has any.
pub(super) fn selected<'a>(
    curves: &'a [Arc<Curve>],
    drawn: &'a Drawn,
) -> impl Iterator<Item = (&'a Arc<Curve>, usize)> {
    let first =
        curves.iter().find(|curve| curve.id.selected(&drawn.selection).keys(curve.times()).next().is_some());
    let same = move |curve: &&'a Arc<Curve>| first.is_some_and(|first| first.id.bit() == curve.id.bit());
    curves.iter().filter(same).flat_map(|curve| {
        curve.id.selected(&drawn.selection).keys(curve.times()).flatten().map(move |key| (curve, key))
    })
}

/// Returns the selected keys, at most `most`.
pub(super) fn selected_keys(curves: &[Arc<Curve>], drawn: &Drawn, most: usize) -> Vec<ValueKey> {
    selected(curves, drawn).filter_map(|(curve, key)| ValueKey::of(curve, key)).take(most).collect()
}

/// Returns numbers with one of them changed.
pub(super) fn with(mut numbers: CurveNumbers, component: usize, number: f32) -> CurveNumbers {
    if let Some(one) = numbers.get_mut(component) {
        *one = number;
    }
    numbers
}
