//! Animations become takes: one track per bone, one channel per property.

use super::accessor::{ElementFormat, GltfDocument, invalid, unresolved};
use super::check as code;
use super::extras;
use super::keys::{self, SamplerTimes, SamplerValues};
use super::scene::SceneLayout;
use super::target_path::NO_NODE;
use crate::data::{Channel, MorphTrack, Take, Track};
use crate::format::{ImportError, Place, one_line};
use crate::limits::KEYS;
use glam::{Quat, Vec3};
use gltf::json;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::animation::Property;
use gltf::json::validation::Checked;
use std::collections::{HashMap, HashSet};

const VEC3: &[ElementFormat] = &[(ComponentType::F32, Type::Vec3, false)];
const QUATERNION: &[ElementFormat] = &[
    (ComponentType::F32, Type::Vec4, false),
    (ComponentType::I8, Type::Vec4, true),
    (ComponentType::U8, Type::Vec4, true),
    (ComponentType::I16, Type::Vec4, true),
    (ComponentType::U16, Type::Vec4, true),
];
const WEIGHT: &[ElementFormat] = &[
    (ComponentType::F32, Type::Scalar, false),
    (ComponentType::I8, Type::Scalar, true),
    (ComponentType::U8, Type::Scalar, true),
    (ComponentType::I16, Type::Scalar, true),
    (ComponentType::U16, Type::Scalar, true),
];
const WRONG: &str = code::ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_FORMAT;

/// Sets `is_bone` for every node that a channel animates.
pub(super) fn mark_animated(document: &GltfDocument<'_>, is_bone: &mut [bool]) -> Result<(), ImportError> {
    for (index, animation) in document.root.animations.iter().enumerate() {
        for (number, channel) in animation.channels.iter().enumerate() {
            document.context.work(1)?;
            let node = channel.target.node.value();
            if node == NO_NODE || channel.target.path == Checked::Invalid {
                continue;
            }
            let from = || format!("/animations/{index}/channels/{number}/target/node");
            *is_bone.get_mut(node).ok_or_else(|| unresolved(&from(), node))? = true;
        }
    }
    Ok(())
}

/// Returns all animations as takes with one track for each bone of `stage`.
pub(super) fn takes(document: &GltfDocument<'_>, stage: &SceneLayout) -> Result<Vec<Take>, ImportError> {
    let context = document.context;
    let count = document.root.animations.len();
    let mut takes = context.vec(&Place::Pointer("/animations".to_owned()), count)?;
    let mut reader = TakeReader { document, stage, times: HashMap::new(), keys: 0 };
    for (index, animation) in document.root.animations.iter().enumerate() {
        takes.push(reader.take(animation, index)?);
        context.progress(0.7 + 0.3 * (index + 1) as f32 / count as f32)?;
    }
    Ok(takes)
}

/// State shared between takes: key times that several channels use are stored once.
struct TakeReader<'a> {
    document: &'a GltfDocument<'a>,
    stage: &'a SceneLayout,
    times: HashMap<usize, SamplerTimes>,
    keys: usize,
}

impl TakeReader<'_> {
    fn take(&mut self, animation: &json::Animation, index: usize) -> Result<Take, ImportError> {
        let path = format!("/animations/{index}");
        let place = Place::Pointer(path.clone());
        let bones = self.stage.skeleton.len();
        let mut tracks: Vec<Track> = self.document.context.vec(&place, bones)?;
        self.document.context.work(bones)?;
        tracks.extend((0..bones as u32).map(|bone| Track { bone, ..Track::default() }));
        let mut take = Take { name: animation.name.clone().unwrap_or_default(), tracks, ..Take::default() };
        if animation.channels.is_empty() {
            self.document.context.warn(place, code::EMPTY_ENTITY, "the animation has no channel");
        }
        let mut moved = HashSet::new();
        for (number, channel) in animation.channels.iter().enumerate() {
            self.channel(animation, channel, (index, number), &mut moved, &mut take)?;
        }
        let (start, end) = take.range_of_keys().unwrap_or((0.0, 0.0));
        (take.start, take.length) = (start, end - start);
        if let Some(text) = &animation.extras {
            take.extras =
                extras::read(self.document.context, &Place::Pointer(format!("{path}/extras")), text.get())?;
        }
        Ok(take)
    }

    fn channel(
        &mut self,
        animation: &json::Animation,
        channel: &json::animation::Channel,
        (index, channel_number): (usize, usize),
        moved: &mut HashSet<(usize, u8)>,
        take: &mut Take,
    ) -> Result<(), ImportError> {
        let context = self.document.context;
        let path = format!("/animations/{index}/channels/{channel_number}");
        let number = channel.sampler.value();
        let sampler =
            animation.samplers.get(number).ok_or_else(|| unresolved(&format!("{path}/sampler"), number))?;
        let node = channel.target.node.value();
        let target = || Place::Pointer(format!("{path}/target"));
        let property = match channel.target.path {
            Checked::Valid(property) if node != NO_NODE => property,
            _ => {
                let text = match self.document.pointers.get(&(index, channel_number)) {
                    Some(pointer) => {
                        format!("the channel animates {}, which is not shown", one_line(pointer))
                    }
                    None => "the channel animates something that is not shown".to_owned(),
                };
                context.warn(target(), code::ANIMATION_CHANNEL_TARGET_UNKNOWN, text);
                return Ok(());
            }
        };
        if !moved.insert((node, property as u8)) {
            context.warn(
                target(),
                code::ANIMATION_DUPLICATE_TARGETS,
                "an earlier channel animates the same property; this one is left out",
            );
            return Ok(());
        }
        if self.document.root.nodes[node].matrix.is_some() && property != Property::MorphTargetWeights {
            let text = "the node has a matrix; the animated part of it is replaced";
            context.warn(target(), code::ANIMATION_CHANNEL_TARGET_NODE_MATRIX, text);
        }
        let sampler_path = format!("/animations/{index}/samplers/{number}");
        let bone = self.stage.bones[node].expect("every animated node was marked as a bone") as usize;
        match property {
            Property::Translation => {
                let (keys, column) = self.column::<3>(sampler, VEC3, 1, &sampler_path)?;
                take.tracks[bone].translation = channel_of(keys, column, Vec3::from_array);
            }
            Property::Scale => {
                let (keys, column) = self.column::<3>(sampler, VEC3, 1, &sampler_path)?;
                take.tracks[bone].scale = channel_of(keys, column, Vec3::from_array);
            }
            Property::Rotation => {
                let (keys, mut column) = self.column::<4>(sampler, QUATERNION, 1, &sampler_path)?;
                keys::make_unit(&mut column, &format!("{sampler_path}/output"), context);
                take.tracks[bone].rotation = channel_of(keys, column, Quat::from_array);
            }
            Property::MorphTargetWeights => self.weights(sampler, node, &path, &sampler_path, take)?,
        }
        Ok(())
    }

    fn weights(
        &mut self,
        sampler: &json::animation::Sampler,
        node: usize,
        path: &str,
        sampler_path: &str,
        take: &mut Take,
    ) -> Result<(), ImportError> {
        let context = self.document.context;
        let place = || Place::Pointer(format!("{path}/target"));
        let targets = self.stage.morph_targets_of(self.document, node);
        if targets == 0 {
            let text = "the node has no mesh with morph targets; the channel is left out";
            context.warn(place(), code::ANIMATION_CHANNEL_TARGET_NODE_WEIGHTS_NO_MORPHS, text);
            return Ok(());
        }
        let (keys, column) = self.column::<1>(sampler, WEIGHT, targets, sampler_path)?;
        let Some(instance) = self.stage.instance_of(node) else { return Ok(()) };
        if !keys.times.is_empty() {
            take.morphs.push(MorphTrack {
                instance,
                targets: targets as u32,
                times: keys.times,
                weights: column.values.into_iter().map(|[weight]| weight).collect(),
                interpolation: column.interpolation,
            });
        }
        Ok(())
    }

    /// Returns the key times and values of a sampler, `width` values per key, sorted and finite.
    fn column<const N: usize>(
        &mut self,
        sampler: &json::animation::Sampler,
        allowed: &[ElementFormat],
        width: usize,
        path: &str,
    ) -> Result<(SamplerTimes, SamplerValues<N>), ImportError> {
        let input = sampler.input.value();
        let keys = match self.times.get(&input) {
            Some(keys) => keys.clone(),
            None => {
                let keys = SamplerTimes::read(self.document, sampler.input, path)?;
                self.times.insert(input, keys.clone());
                keys
            }
        };
        self.keys = self.keys.saturating_add(keys.count);
        if self.keys > KEYS {
            let (size, limit) = (self.keys as u64, KEYS as u64);
            let place = Place::Pointer(path.to_owned());
            return Err(ImportError::TooLarge { place, what: "keys in all", size, limit });
        }
        let output = format!("{path}/output");
        let source = self.document.source(sampler.output, &output, allowed, WRONG)?;
        let interpolation = keys::interpolation(sampler, path, self.document.context);
        let per_key = width * if interpolation == crate::data::Interpolation::CubicSpline { 3 } else { 1 };
        if keys.count.checked_mul(per_key) != Some(source.count) {
            let reason = format!("{} values for {} keys of {per_key}", source.count, keys.count);
            let code = code::ANIMATION_SAMPLER_OUTPUT_ACCESSOR_INVALID_COUNT;
            return Err(invalid(Place::Pointer(output), code, reason));
        }
        // Charged twice: as numbers, and as what the channel shares.
        self.document
            .context
            .charge(&source.place, (source.count as u64).saturating_mul(2 * 4 * N as u64))?;
        let mut column = SamplerValues { values: source.floats()?, interpolation, width };
        column.check(&source.place, self.document.context)?;
        column.sort(&keys, self.document.context)?;
        Ok((keys, column))
    }
}

fn channel_of<T: Copy, const N: usize>(
    keys: SamplerTimes,
    column: SamplerValues<N>,
    value: fn([f32; N]) -> T,
) -> Channel<T> {
    if keys.times.is_empty() {
        return Channel {
            times: Default::default(),
            values: Vec::new().into(),
            interpolation: column.interpolation,
        };
    }
    Channel {
        times: keys.times,
        values: column.values.into_iter().map(value).collect(),
        interpolation: column.interpolation,
    }
}
