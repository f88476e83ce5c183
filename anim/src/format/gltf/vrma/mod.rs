//! Animations for persons: `.vrma`, a binary glTF with the extension `VRMC_vrm_animation` 1.0.
//!
//! It is read as any glTF: its nodes become bones, and its parts of the body and expressions an
//! [`Avatar`](crate::data::Avatar). Written is a figure of its own, without meshes: the humanoid bones of the model in a
//! T-pose that looks along +Z, without rotations at rest, to which the takes are retargeted. Only the hips have
//! translations, and nothing is scaled, as the specification demands.

mod expressions;
mod figure;
mod names;

use super::avatar::VRM_ANIMATION;
use super::write::{container, document};
use crate::data::{AnimationData, Bone, HumanBone, ModelData, Skeleton, Take, Track};
use crate::format::{ExportError, Place, Warning, WholeFile};
use crate::retarget::{RetargetOptions, SkeletonBinding, retarget};
use expressions::{ExpressionTracks, PRESETS};
use figure::VrmaFigure;
use serde_json::{Map, Value, json};
use std::sync::Arc;

/// Code of the warnings about content that a VRM animation cannot represent.
const NOT_IN_VRMA: &str = "NOT_IN_VRMA";

/// Number of bytes at both ends of the JSON text that are searched for the name of the extension.
const SEARCHED: usize = 1 << 16;

/// Returns whether the JSON text of a binary container names the extension near its start or its end, where exporters
/// list extensions.
pub(super) fn names_extension(bytes: &[u8]) -> bool {
    let Some((header, rest)) = bytes.split_at_checked(20) else { return false };
    let length = <[u8; 4]>::try_from(&header[12..16]).map_or(0, u32::from_le_bytes) as usize;
    let text = &rest[..length.min(rest.len())];
    let name = VRM_ANIMATION.as_bytes();
    let holds = |text: &[u8]| text.windows(name.len()).any(|window| window == name);
    let end = text.len().saturating_sub(SEARCHED);
    holds(&text[..text.len().min(SEARCHED)]) || holds(&text[end..])
}

/// Writes the takes of a model whose bones are known as parts of the body: by its file (VRM), otherwise by their names.
///
/// # Errors
///
/// No bone is known as the hips; keys that no reader would accept.
pub(super) fn write(model: &ModelData) -> Result<WholeFile, ExportError> {
    let humans = names::human_bones(model);
    if !humans.iter().any(|human| human.name == "hips") {
        let text = "a VRM animation needs a figure, and no bone of the model is known as its hips";
        return Err(ExportError::new(text));
    }
    let mut lost = losses(model, &humans);
    let figure = VrmaFigure::of(&model.animation.skeleton, &humans);
    let expressions = ExpressionTracks::of(model);
    let mut bones = figure.skeleton.bones.clone();
    // The translation of the bone of an expression is its weight.
    bones.extend(expressions.names().map(Bone::root));
    let mut takes = Vec::with_capacity(model.animation.takes.len());
    for (index, take) in model.animation.takes.iter().enumerate() {
        let mut moved = moved(&figure, take);
        let first = figure.skeleton.len() as u32;
        let tracks = expressions.tracks(take);
        moved.tracks.extend((first..).zip(tracks).map(|(bone, translation)| Track {
            bone,
            translation,
            ..Track::default()
        }));
        lost.extend(expressions.lost(take, index));
        takes.push(Arc::new(moved));
    }
    let animation = AnimationData { skeleton: Arc::new(Skeleton { bones }), takes };
    let written = ModelData { name: model.name.clone(), animation, ..ModelData::default() };
    let (mut root, binary, more) = document(&written)?;
    lost.extend(more);
    root["extensionsUsed"] = json!([VRM_ANIMATION]);
    root["extensions"] = json!({VRM_ANIMATION: extension(&figure, &expressions)});
    Ok(WholeFile { bytes: container(&root, binary)?, lost })
}

/// Returns a take for the figure: rotations, and the translation of the hips.
fn moved(figure: &VrmaFigure, take: &Take) -> Take {
    let (source, take) = figure.turned(take);
    let pairs: Vec<(u32, u32)> = figure.humans.iter().map(|human| human.bone).zip(0..).collect();
    let Ok(binding) = SkeletonBinding::from_map(&source, &figure.skeleton, &pairs) else {
        return Take { name: take.name.clone(), ..Take::default() };
    };
    let hips = figure.humans.iter().position(|human| human.name == "hips").unwrap_or(0) as u32;
    let options = RetargetOptions { trunk: Some(vec![hips]), ratio: Some(1.0), ..RetargetOptions::default() };
    let mut moved = retarget(&take, &source, &figure.skeleton, &binding, &options);
    for track in &mut moved.tracks {
        if track.bone != hips {
            track.translation = Default::default();
        }
        track.scale = Default::default();
    }
    moved
}

/// Returns the object of the extension; bones and nodes have the same numbers.
fn extension(figure: &VrmaFigure, expressions: &ExpressionTracks<'_>) -> Value {
    let bones = figure.humans.iter().enumerate();
    let bones: Map<String, Value> =
        bones.map(|(node, human)| (human.name.clone(), json!({"node": node}))).collect();
    let (mut preset, mut custom) = (Map::new(), Map::new());
    for (node, name) in (figure.skeleton.len()..).zip(expressions.names()) {
        let group = if PRESETS.contains(&name) { &mut preset } else { &mut custom };
        group.insert(name.to_owned(), json!({"node": node}));
    }
    let mut object = json!({"specVersion": "1.0", "humanoid": {"humanBones": bones}});
    for (name, group) in [("preset", preset), ("custom", custom)] {
        if !group.is_empty() {
            object["expressions"][name] = Value::Object(group);
        }
    }
    object
}

/// Returns what the file does not contain, except for morph weights.
fn losses(model: &ModelData, humans: &[HumanBone]) -> Vec<Warning> {
    let mut lost = Vec::new();
    let mut lose = |pointer: String, text: String| {
        lost.push(Warning { place: Place::Pointer(pointer), code: NOT_IN_VRMA, text });
    };
    if !model.meshes.is_empty() {
        lose("/meshes".to_owned(), "a VRM animation has no meshes, materials and images".to_owned());
    }
    let missing: Vec<&str> = names::REQUIRED
        .iter()
        .copied()
        .filter(|name| !humans.iter().any(|human| human.name == *name))
        .collect();
    if !missing.is_empty() {
        let text = format!("VRM requires bones that the model lacks: {}", missing.join(", "));
        lose("/animation/skeleton".to_owned(), text);
    }
    for (index, take) in model.animation.takes.iter().enumerate() {
        let is_human = |track: &Track| humans.iter().any(|human| human.bone == track.bone);
        let weights: Vec<u32> = model.avatar.expressions.iter().filter_map(|it| it.weight_bone).collect();
        let others = take
            .tracks
            .iter()
            .filter(|track| !track.is_empty() && !is_human(track) && !weights.contains(&track.bone));
        let others = others.count();
        if others > 0 {
            let text =
                format!("{others} tracks of bones that are no parts of the body only move those below them");
            lose(format!("/animation/takes/{index}/tracks"), text);
        }
        let scaled = take.tracks.iter().filter(|track| is_human(track) && !track.scale.is_empty()).count();
        if scaled > 0 {
            lose(format!("/animation/takes/{index}/scale"), format!("{scaled} bones are not scaled"));
        }
        if !take.extras.is_empty() {
            let text = "layers, contacts and events are not written".to_owned();
            lose(format!("/animation/takes/{index}/extras"), text);
        }
    }
    lost
}
