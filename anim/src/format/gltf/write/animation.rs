//! Takes of a written file.

use super::bytes::{AccessorShape, Components};
use super::{GltfWriter, named};
use crate::data::{Channel, Interpolation, Take};
use crate::format::ExportError;
use crate::format::gltf::extras::EXTRAS_MEMBER;
use crate::format::gltf::save::{EncodedKeys, KeyColumns, KeysOwner, encode_keys};
use crate::format::gltf::target_path::TargetPath;
use glam::Vec3;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Channels and samplers of an animation that is being written.
#[derive(Default)]
struct WrittenAnimation {
    channels: Vec<Value>,
    samplers: Vec<Value>,
}

impl GltfWriter<'_> {
    /// Writes all takes. `instances` contains the node of each mesh instance.
    pub(super) fn animations(&mut self, instances: &[Option<usize>]) -> Result<Vec<Value>, ExportError> {
        let model = self.model;
        let mut animations = Vec::with_capacity(model.animation.takes.len());
        for (index, take) in model.animation.takes.iter().enumerate() {
            animations.extend(self.animation(index, take, instances)?);
        }
        Ok(animations)
    }

    fn animation(
        &mut self,
        index: usize,
        take: &Take,
        instances: &[Option<usize>],
    ) -> Result<Option<Value>, ExportError> {
        let bones = &self.model.animation.skeleton.bones;
        let mut written = WrittenAnimation::default();
        for track in &take.tracks {
            let bone = bones.get(track.bone as usize).map_or("", |bone| bone.name.as_str());
            let columns = [
                (TargetPath::Translation, KeyColumns::Vector(&track.translation)),
                (TargetPath::Rotation, KeyColumns::Rotation(&track.rotation)),
                (TargetPath::Scale, KeyColumns::Vector(&track.scale)),
            ];
            for (path, column) in columns {
                if !column.times().is_empty() {
                    let keys = encode_keys(column, KeysOwner { take: &take.name, bone, path })?;
                    self.channel(&mut written, track.bone as usize, path, &keys);
                }
            }
        }
        for morph in &take.morphs {
            let Some(node) = instances.get(morph.instance as usize).copied().flatten() else {
                let text =
                    format!("shape weights of mesh instance {}, which is not in the file", morph.instance);
                self.lose(format!("/animation/takes/{index}/morphs"), text);
                continue;
            };
            let (path, mesh) = (TargetPath::Weights, morph.instance.to_string());
            let keys =
                encode_keys(KeyColumns::Weights(morph), KeysOwner { take: &take.name, bone: &mesh, path })?;
            self.channel(&mut written, node, path, &keys);
        }
        if written.channels.is_empty() {
            // An animation must have a channel: one key that keeps the first bone at rest.
            let Some(first) = bones.first() else {
                self.lose(format!("/animation/takes/{index}"), "a take that moves nothing is left out");
                return Ok(None);
            };
            let rest: Channel<Vec3> =
                Channel::new([take.start], [first.rest.translation], Interpolation::Linear);
            let owner = KeysOwner { take: &take.name, bone: &first.name, path: TargetPath::Translation };
            let keys = encode_keys(KeyColumns::Vector(&rest), owner)?;
            self.channel(&mut written, 0, TargetPath::Translation, &keys);
        }
        let mut value = Map::new();
        named(&mut value, &take.name);
        value.insert("channels".to_owned(), Value::Array(written.channels));
        value.insert("samplers".to_owned(), Value::Array(written.samplers));
        if !take.extras.is_empty() {
            let texts: BTreeMap<&str, Value> = take
                .extras
                .iter()
                .filter_map(|(name, text)| Some((name, serde_json::from_str(text).ok()?)))
                .collect();
            value.insert("extras".to_owned(), json!({EXTRAS_MEMBER: texts}));
        }
        Ok(Some(Value::Object(value)))
    }

    fn channel(&mut self, written: &mut WrittenAnimation, node: usize, path: TargetPath, keys: &EncodedKeys) {
        let input = self.binary.times(keys.times());
        let shape = match keys.shape() {
            "VEC3" => AccessorShape::VEC3,
            "VEC4" => AccessorShape::VEC4,
            _ => AccessorShape::SCALAR,
        };
        let output = self.binary.accessor(Components::Floats(keys.values()), &shape);
        let sampler = written.samplers.len();
        written.channels.push(json!({"sampler": sampler, "target": {"node": node, "path": path.name()}}));
        written
            .samplers
            .push(json!({"input": input, "interpolation": keys.interpolation(), "output": output}));
    }
}
