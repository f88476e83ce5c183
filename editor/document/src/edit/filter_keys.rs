//! Smooths the curves of keys, and removes peaks.

use super::hold::{self, HeldFeet};
use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, KeySet, TakeRef, cost};
use crate::adapter::kind::ChannelKind;
use crate::adapter::op::ChannelAddress;
use crate::adapter::plan::values::{ValueTool, change_values};
use crate::adapter::plan::{Transaction, rest};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::{MorphTrack, Skeleton, Take};
use dragonfly_anim::inbetween::{self, Butterworth, KeyFilter, KeyValue, UniformTimes};
use dragonfly_anim::sample::{sample_channel, sample_morph_weights};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Filters the curves of keys. A channel is sampled at even times from its first key to its last and filtered as a whole, and the
/// selected keys get the filtered values at their times. No key is added or moved, and a tangent changes as the slope from the key
/// before to the key after does.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FilterKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys of bones.
    pub keys: Vec<KeySet>,
    /// Stretches of time, start and end in seconds, in which keys of morph targets are filtered.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<[f32; 2]>,
    /// The filter.
    pub filter: CurveFilter,
    /// Samples per second, 1 to 1000. Without it the samples of a channel are as far apart as its keys, in the median.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<f32>,
    /// Feet that are held where they were, in the contacts stored with the take, if the edit moves them there. Keys are added at
    /// every frame of these contacts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hold: Vec<BoneRef>,
}

/// A filter of curves.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum CurveFilter {
    /// Smooths by a Gaussian of this standard deviation in seconds, 0 to 10; 0 changes nothing.
    Gaussian(f32),
    /// Removes movements faster than a cutoff, forwards and backwards, so that nothing is delayed.
    Butterworth {
        /// Frequency in Hz; at half of the sample rate or more nothing changes.
        cutoff: f32,
        /// Order, 1 to 8: how steep the filter is.
        order: u32,
    },
    /// Replaces peaks by the median of the keys around them, whatever their times.
    Peaks {
        /// Number of keys that are looked at, 3 to 99.
        window: u32,
        /// Number of standard deviations from which on a key is a peak; with 0 each key becomes the median.
        threshold: f32,
    },
}

map_references!(FilterKeys { take, shapes, filter, rate, hold }, |edit, map| {
    keys: map.any(&edit.keys, !edit.shapes.is_empty())?,
});

impl EditKind for FilterKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"filter_keys","take":"Walk","keys":[{"bones":["Head"]}],"filter":{"butterworth":{"cutoff":6,"order":2}}}"#,
        description: "Removes tremble above 6 Hz from the head.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        match self.filter {
            CurveFilter::Gaussian(_) | CurveFilter::Butterworth { .. } => "Smooth keys",
            CurveFilter::Peaks { .. } => "Remove peaks",
        }
    }

    fn take(&self) -> Option<&TakeRef> {
        Some(&self.take)
    }

    fn bones(&self, skeleton: &Skeleton) -> EditedBones {
        hold::with_limbs(EditedBones::of_keys(&self.keys, skeleton), &self.hold, skeleton)
    }

    fn keys(&self) -> &[KeySet] {
        &self.keys
    }

    fn cost(&self, adapter: &ModelAdapter) -> Option<usize> {
        if !self.hold.is_empty() {
            // It takes as long as the take has frames.
            return None;
        }
        let bones = self.bones(adapter.skeleton());
        // In sixteenths of the time of a key that is moved.
        let work = match self.filter {
            CurveFilter::Gaussian(sigma) => 16 + (sigma.clamp(0.0, 10.0) * 480.0) as usize,
            CurveFilter::Butterworth { .. } => 24,
            CurveFilter::Peaks { window, .. } => 8 * window.min(99) as usize,
        };
        let read = cost::of_reading(adapter, &self.take, &bones, work)?;
        Some(read + cost::of_keys(adapter, &self.take, &self.keys))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        self.check()?;
        let take = work.take(&self.take)?;
        let held = HeldFeet::before(work, &self.take, &self.hold)?;
        change_values(work, take, &self.keys, &self.shapes, self)?;
        held.map_or(Ok(()), |held| held.hold(work))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let (take, keys, shapes) = (from.take(), from.keys(), from.shapes());
        let filter = match from.below(3) {
            0 => CurveFilter::Gaussian(from.choice([0.0, 0.1, 1.0])),
            1 => {
                CurveFilter::Butterworth { cutoff: from.between(0.1, 3.0), order: from.choice([1, 2, 3, 8]) }
            }
            _ => CurveFilter::Peaks { window: from.choice([3, 5]), threshold: from.choice([0.0, 1.0]) },
        };
        let rate = from.optional(|from| from.choice([5.0, 30.0]));
        Self { take, keys, shapes, filter, rate, hold: from.feet() }
    }
}

impl FilterKeys {
    fn check(&self) -> Result<(), EditError> {
        let number = |what, value: f32, fits: bool| {
            if fits { Ok(()) } else { Err(EditError::Number { what, value }) }
        };
        if let Some(rate) = self.rate {
            number("the sample rate", rate, (1.0..=1000.0).contains(&rate))?;
        }
        match self.filter {
            CurveFilter::Gaussian(sigma) => number("the width", sigma, (0.0..=10.0).contains(&sigma)),
            CurveFilter::Butterworth { cutoff, order } => {
                number("the cutoff", cutoff, (1e-3..=1e6).contains(&cutoff))?;
                let fits = (1..=Butterworth::LARGEST_ORDER).contains(&(order as usize));
                number("the order", order as f32, fits)
            }
            CurveFilter::Peaks { window, threshold } => {
                number("the number of keys", window as f32, (3..=99).contains(&window))?;
                number("the threshold", threshold, (0.0..=1e6).contains(&threshold))
            }
        }
    }

    /// Returns the new values of the chosen keys; `None` where nothing changes.
    fn filtered<T: KeyValue>(
        &self,
        times: &[f32],
        values: &[T],
        chosen: &[u32],
        sample: impl Fn(f32) -> T,
    ) -> Result<Option<Vec<T>>, EditError> {
        let filter = match self.filter {
            CurveFilter::Gaussian(sigma) => KeyFilter::Gaussian { sigma: f64::from(sigma) },
            CurveFilter::Butterworth { cutoff, order } => {
                KeyFilter::Butterworth { cutoff: f64::from(cutoff), order: order as usize }
            }
            CurveFilter::Peaks { window, threshold } => {
                KeyFilter::Peaks { window: window as usize, threshold: f64::from(threshold) }
            }
        };
        let uniform = UniformTimes::over(times, self.rate.map(f64::from));
        let needs_samples = !matches!(self.filter, CurveFilter::Peaks { .. });
        if needs_samples && uniform.is_none() && times.len() > 1 {
            return Err(EditError::TooManySamples);
        }
        let all = inbetween::filter_keys(times, values, filter, uniform, sample);
        Ok(all.map(|all| chosen.iter().map(|&key| all[key as usize]).collect()))
    }
}

impl ValueTool for FilterKeys {
    fn bone_values<K: ChannelKind>(
        &self,
        work: &Transaction,
        address: ChannelAddress,
        values: &[K::Value],
        chosen: &[u32],
    ) -> Result<Option<Vec<K::Value>>, EditError> {
        let slot = work.slot(address.take);
        let rest = rest::<K>(work, address);
        let Some(track) = slot.result.tracks.get(address.bone as usize) else { return Ok(None) };
        let sample = |time: f32| sample_channel(K::channel(track), rest, time);
        self.filtered(slot.times(address.bone, address.property), values, chosen, sample)
    }

    fn shape_weights(
        &self,
        _work: &Transaction,
        track: &MorphTrack,
        target: usize,
        weights: &[f32],
        chosen: &[u32],
    ) -> Result<Option<Vec<f32>>, EditError> {
        let own = Take { morphs: vec![track.clone()], ..Take::default() };
        let sample = |time: f32| {
            let mut all = vec![0.0; track.targets as usize];
            sample_morph_weights(Some(&own), track.instance, &[], time, &mut all);
            all[target]
        };
        self.filtered(&track.times, weights, chosen, sample)
    }
}
