//! Adds noise to keys.

use super::hold::{self, HeldFeet};
use super::kind::{EditKind, LayerUse};
use super::map_references::map_references;
use super::{Arbitrary, BoneRef, EditedBones, Example, KeySet, Property, TakeRef, cost};
use crate::adapter::kind::{ChannelKind, RotationChannel, TranslationChannel};
use crate::adapter::op::ChannelAddress;
use crate::adapter::plan::Transaction;
use crate::adapter::plan::values::{ValueTool, change_values};
use crate::adapter::{EditError, ModelAdapter};
use dragonfly_anim::data::{MorphTrack, Skeleton};
use dragonfly_anim::inbetween::noise_at;
use dragonfly_anim::trig::rotation_of_vector;
use glam::DVec3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Adds smooth random numbers to the values of keys: the same ones for the same seed. Translations are moved, rotations turned in
/// parent space, scales multiplied, weights of morph targets added to. An amplitude of 0 changes nothing.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NoiseKeys {
    /// The take.
    pub take: TakeRef,
    /// The keys of bones.
    pub keys: Vec<KeySet>,
    /// Stretches of time, start and end in seconds, in which keys of morph targets get noise.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<[f32; 2]>,
    /// Largest distance per axis, meters.
    #[serde(default)]
    pub translation: f32,
    /// Largest angle per axis, degrees, at most 180.
    #[serde(default)]
    pub rotation: f32,
    /// Largest part of a scale, and largest weight, that is added or taken away.
    #[serde(default)]
    pub scale: f32,
    /// Number of new random values per second, Hz.
    pub frequency: f32,
    /// Number that determines the random values.
    #[serde(default)]
    pub seed: u32,
    /// Feet that are held where they were, in the contacts stored with the take, if the edit moves them there. Keys are added at
    /// every frame of these contacts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub hold: Vec<BoneRef>,
}

map_references!(NoiseKeys { take, shapes, translation, rotation, scale, frequency, seed, hold }, |edit, map| {
    keys: map.any(&edit.keys, !edit.shapes.is_empty())?,
});

impl EditKind for NoiseKeys {
    const EXAMPLE: Example = Example {
        json: r#"{"edit":"noise_keys","take":"Walk","keys":[{"bones":["Head"],"properties":["rotation"]}],"rotation":2,"frequency":4,"seed":1}"#,
        description: "Makes the head tremble by up to 2° about each axis.",
    };

    const LAYERS: LayerUse = LayerUse::Any;

    fn label(&self) -> &'static str {
        "Add noise to keys"
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
        let columns = cost::of_columns(adapter, &self.take, &self.bones(adapter.skeleton()))?;
        // A rotation is computed in about the time of two keys that are moved.
        Some(columns + 3 * cost::of_keys(adapter, &self.take, &self.keys))
    }

    fn plan(&self, work: &mut Transaction) -> Result<(), EditError> {
        let number = |what, value: f32, largest: f32| {
            if (0.0..=largest).contains(&value) { Ok(()) } else { Err(EditError::Number { what, value }) }
        };
        number("the translation", self.translation, 1e6)?;
        number("the rotation", self.rotation, 180.0)?;
        number("the scale", self.scale, 1e3)?;
        number("the frequency", self.frequency, 1e4)?;
        let take = work.take(&self.take)?;
        let held = HeldFeet::before(work, &self.take, &self.hold)?;
        change_values(work, take, &self.keys, &self.shapes, self)?;
        held.map_or(Ok(()), |held| held.hold(work))
    }

    fn arbitrary(from: &mut Arbitrary<'_>) -> Self {
        let (take, keys, shapes) = (from.take(), from.keys(), from.shapes());
        let [translation, rotation, scale] = [1.0, 90.0, 0.5].map(|most| from.choice([0.0, most]));
        let (frequency, seed) = (from.between(0.0, 20.0), from.below(1000) as u32);
        Self { take, keys, shapes, translation, rotation, scale, frequency, seed, hold: from.feet() }
    }
}

impl NoiseKeys {
    /// Returns the noise of one number of a bone or a shape at a time.
    fn noise(&self, of: u64, time: f32) -> f64 {
        let seed = (u64::from(self.seed) << 32) ^ of;
        noise_at(seed, f64::from(time) * f64::from(self.frequency))
    }
}

impl ValueTool for NoiseKeys {
    fn bone_values<K: ChannelKind>(
        &self,
        work: &Transaction,
        address: ChannelAddress,
        values: &[K::Value],
        chosen: &[u32],
    ) -> Result<Option<Vec<K::Value>>, EditError> {
        let times = work.slot(address.take).times(address.bone, address.property);
        let amplitude = match address.property {
            Property::Translation => f64::from(self.translation),
            Property::Rotation => f64::from(self.rotation).to_radians(),
            Property::Scale => f64::from(self.scale),
        };
        if amplitude == 0.0 {
            return Ok(None);
        }
        let channel = u64::from(address.bone) * 16 + address.property as u64 * 4;
        let offset =
            |time: f32| DVec3::from_array([0, 1, 2].map(|axis| self.noise(channel + axis, time) * amplitude));
        let on_top = |offset: DVec3| match address.property {
            Property::Translation => TranslationChannel::numbers(offset.as_vec3()),
            Property::Rotation => RotationChannel::numbers(rotation_of_vector(offset).as_quat()),
            Property::Scale => TranslationChannel::numbers((DVec3::ONE + offset).as_vec3()),
        };
        let changed = |&key: &u32| {
            let offset = offset(times[key as usize]);
            let value = values[key as usize];
            if offset == DVec3::ZERO { value } else { K::offset(value, K::value(on_top(offset))) }
        };
        Ok(Some(chosen.iter().map(changed).collect()))
    }

    fn shape_weights(
        &self,
        _work: &Transaction,
        track: &MorphTrack,
        target: usize,
        weights: &[f32],
        chosen: &[u32],
    ) -> Result<Option<Vec<f32>>, EditError> {
        if self.scale == 0.0 {
            return Ok(None);
        }
        let of = (1 << 31) + u64::from(track.instance) * 4096 + target as u64;
        let changed = |&key: &u32| {
            let noise = self.noise(of, track.times[key as usize]) * f64::from(self.scale);
            weights[key as usize] + noise as f32
        };
        Ok(Some(chosen.iter().map(changed).collect()))
    }
}
