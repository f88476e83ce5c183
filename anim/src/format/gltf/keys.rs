//! Keys of a sampler: increasing times, and finite values in the same order.

use super::accessor::{ElementFormat, GltfDocument, invalid};
use super::check as code;
use super::node::{ROTATION_TOLERANCE, unit};
use crate::data::Interpolation;
use crate::format::{ImportContext, ImportError, Place};
use crate::limits::{CLIP_SECONDS, HUGE, KEYS_PER_CHANNEL};
use glam::Quat;
use gltf::json;
use gltf::json::accessor::{Accessor, ComponentType, Type};
use gltf::json::validation::Checked;
use std::sync::Arc;

const TIME: &[ElementFormat] = &[(ComponentType::F32, Type::Scalar, false)];

/// The key times of a sampler.
#[derive(Clone)]
pub(super) struct SamplerTimes {
    /// Seconds, strictly ascending.
    pub(super) times: Arc<[f32]>,
    /// Number of keys in the file; larger than the length of `times` if some were left out.
    pub(super) count: usize,
    /// Number of the file's key for each time; `None` if they are the same.
    order: Option<Arc<[u32]>>,
}

impl SamplerTimes {
    /// Reads and sorts the key times; of several keys at the same time the last one is used.
    pub(super) fn read(
        document: &GltfDocument<'_>,
        input: json::Index<Accessor>,
        path: &str,
    ) -> Result<Self, ImportError> {
        let context = document.context;
        let from = format!("{path}/input");
        let wrong = code::ANIMATION_SAMPLER_INPUT_ACCESSOR_INVALID_FORMAT;
        let source = document.source(input, &from, TIME, wrong)?;
        let too_large = |what, size: u64, limit: u64| ImportError::TooLarge {
            place: source.place.clone(),
            what,
            size,
            limit,
        };
        if source.count > KEYS_PER_CHANNEL {
            return Err(too_large("keys", source.count as u64, KEYS_PER_CHANNEL as u64));
        }
        if source.count == 0 {
            context.warn(
                source.place.clone(),
                code::EMPTY_ENTITY,
                "the channel has no key and animates nothing",
            );
        }
        // Adding 0 turns -0 into 0, since -0 would sort before 0 and yet be equal to it.
        let times: Vec<f32> = source.finite::<1>()?.into_iter().map(|[time]| time + 0.0).collect();
        context.work(times.len())?;
        context.charge(&source.place, times.len() as u64 * 8)?;
        if let Some(far) = times.iter().find(|time| time.abs() > CLIP_SECONDS) {
            return Err(too_large("seconds", far.abs() as u64, CLIP_SECONDS as u64));
        }
        if times.iter().any(|&time| time < 0.0) {
            let text = "key times below zero are kept";
            context.warn(source.place.clone(), code::ACCESSOR_ANIMATION_INPUT_NEGATIVE, text);
        }
        // Compared so that NaN counts as not increasing.
        let increasing = times.windows(2).all(|pair| pair[1] > pair[0]);
        if !increasing {
            return Self::sorted(&times, &source.place, context);
        }
        Ok(Self { count: times.len(), times: times.into(), order: None })
    }

    fn sorted(times: &[f32], place: &Place, context: &ImportContext<'_>) -> Result<Self, ImportError> {
        let text = "key times do not increase; they were sorted, and of equal ones the last was kept";
        context.warn(place.clone(), code::ACCESSOR_ANIMATION_INPUT_NON_INCREASING, text);
        let mut order: Vec<u32> = context.vec(place, times.len())?;
        order.extend(0..times.len() as u32);
        order.sort_by(|&a, &b| times[a as usize].total_cmp(&times[b as usize]));
        context.work(times.len())?;
        let is_last = |&(position, &key): &(usize, &u32)| {
            order.get(position + 1).is_none_or(|&next| times[next as usize] != times[key as usize])
        };
        let kept: Arc<[u32]> = order.iter().enumerate().filter(is_last).map(|(_, &key)| key).collect();
        let sorted = kept.iter().map(|&key| times[key as usize]).collect();
        Ok(Self { times: sorted, count: times.len(), order: Some(kept) })
    }
}

/// Values of a sampler as in the file.
pub(super) struct SamplerValues<const N: usize> {
    pub(super) values: Vec<[f32; N]>,
    pub(super) interpolation: Interpolation,
    /// Number of values that belong together: 1, or the number of morph targets.
    pub(super) width: usize,
}

impl<const N: usize> SamplerValues<N> {
    /// Returns the number of values per key, tangents included.
    fn per_key(&self) -> usize {
        self.width * if self.interpolation == Interpolation::CubicSpline { 3 } else { 1 }
    }

    /// Returns whether the value at `index` is a tangent.
    fn is_tangent(&self, index: usize) -> bool {
        self.interpolation == Interpolation::CubicSpline && index / self.width % 3 != 1
    }

    /// Refuses values that are not finite, and sets tangents that are not finite to zero.
    pub(super) fn check(&mut self, place: &Place, context: &ImportContext<'_>) -> Result<(), ImportError> {
        let (mut fixed, mut huge) = (0, false);
        context.work(self.values.len())?;
        for index in 0..self.values.len() {
            if self.values[index].iter().all(|number| number.is_finite()) {
                huge |= self.values[index].iter().any(|number| number.abs() > HUGE);
            } else if self.is_tangent(index) {
                self.values[index] = [0.0; N];
                fixed += 1;
            } else {
                let reason = format!("element {index} is not finite");
                return Err(invalid(place.clone(), code::ACCESSOR_INVALID_FLOAT, reason));
            }
        }
        if fixed > 0 {
            let text = format!("{fixed} tangents are not finite; they were set to zero");
            context.warn(place.clone(), code::ANIMATION_TANGENT_NOT_FINITE, text);
        }
        if huge {
            context.warn(place.clone(), code::HUGE_TRANSLATION, "a key is too large for single precision");
        }
        Ok(())
    }

    /// Sorts the values into the order of `keys`.
    pub(super) fn sort(
        &mut self,
        keys: &SamplerTimes,
        context: &ImportContext<'_>,
    ) -> Result<(), ImportError> {
        let Some(order) = &keys.order else { return Ok(()) };
        let per_key = self.per_key();
        context.work(self.values.len())?;
        context.charge(&Place::File, (self.values.len() * size_of::<[f32; N]>()) as u64)?;
        let old = std::mem::take(&mut self.values);
        self.values =
            order.iter().flat_map(|&key| &old[key as usize * per_key..][..per_key]).copied().collect();
        Ok(())
    }
}

/// Normalizes the rotations of all keys.
///
/// If keys are interpolated linearly, neighbors are brought into one hemisphere: q and -q are the same rotation, and
/// the interpolation should take the shorter way. A spline keeps its signs, because its tangents determine the way.
pub(super) fn make_unit(column: &mut SamplerValues<4>, place: &str, context: &ImportContext<'_>) {
    let (mut zero, mut off) = (0, 0);
    let mut last: Option<Quat> = None;
    for index in 0..column.values.len() {
        if column.is_tangent(index) {
            continue;
        }
        let mut rotation = match unit(Quat::from_array(column.values[index])) {
            Some((rotation, error)) => {
                off += usize::from(error > ROTATION_TOLERANCE);
                rotation
            }
            None => {
                zero += 1;
                Quat::IDENTITY
            }
        };
        if column.interpolation != Interpolation::CubicSpline {
            if last.is_some_and(|last| last.dot(rotation) < 0.0) {
                rotation = -rotation;
            }
            last = Some(rotation);
        }
        column.values[index] = rotation.to_array();
    }
    let code = code::ACCESSOR_ANIMATION_SAMPLER_OUTPUT_NON_NORMALIZED_QUATERNION;
    let warn = |count: usize, what: &str| {
        if count > 0 {
            context.warn(Place::Pointer(place.to_owned()), code, format!("{count} rotations {what}"));
        }
    };
    warn(zero, "have no length; the identity is used instead");
    warn(off, "are not of unit length; they were normalized");
}

/// Returns the interpolation; linear if the file has an unknown one.
pub(super) fn interpolation(
    sampler: &json::animation::Sampler,
    path: &str,
    context: &ImportContext<'_>,
) -> Interpolation {
    match sampler.interpolation {
        Checked::Valid(json::animation::Interpolation::Step) => Interpolation::Step,
        Checked::Valid(json::animation::Interpolation::CubicSpline) => Interpolation::CubicSpline,
        Checked::Valid(json::animation::Interpolation::Linear) => Interpolation::Linear,
        Checked::Invalid => {
            let place = Place::Pointer(format!("{path}/interpolation"));
            context.warn(
                place,
                code::VALUE_NOT_IN_LIST,
                "the interpolation is unknown; linear is used instead",
            );
            Interpolation::Linear
        }
    }
}
