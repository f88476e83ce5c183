//! Takes with a key at every frame, and bones without scale.

use super::super::bones::{LocalPose, bone_matrices};
use super::super::losses::FbxLosses;
use super::super::sample::{rotation, vector};
use dragonfly_anim::data::{
    AnimationData, Channel, Interpolation, ModelData, MorphTrack, Skeleton, Take, Track, Transform,
};
use dragonfly_anim::format::ExportError;
use dragonfly_anim::frames::{MOST_POSES, frame_rate, frames_over};
use dragonfly_anim::sample::sample_morph_weights;
use glam::{DMat4, DQuat, DVec3, Mat4, Quat, Vec3};
use std::sync::Arc;

/// Lowest frame rate of keys at every frame.
const LEAST_RATE: f32 = 24.0;

/// Difference of a scale from 1 that counts.
const SCALED: f32 = 1e-5;

/// Returns the model with keys at every frame; with `no_scale`, the scale of bones at rest moves to the bones and meshes that they
/// carry.
///
/// # Errors
///
/// A take of too many poses.
pub(in super::super) fn at_frames(
    model: &ModelData,
    no_scale: bool,
    losses: &mut FbxLosses,
) -> Result<ModelData, ExportError> {
    let skeleton = &model.animation.skeleton;
    let is_scaled = no_scale && has_scale(model, losses);
    let rest: Vec<LocalPose> = skeleton.bones.iter().map(|bone| LocalPose::of(&bone.rest)).collect();
    let (resting, globals) = if is_scaled { unscaled(skeleton, &rest) } else { (rest.clone(), Vec::new()) };
    let mut framed = model.clone();
    let mut takes = Vec::with_capacity(model.animation.takes.len());
    for (index, take) in model.animation.takes.iter().enumerate() {
        let rate = fluent(frame_rate(take));
        losses.add(
            format!("/animation/takes/{index}"),
            format!(
                "the take \"{}\" has keys at every frame, {rate} per second, instead of its own",
                take.name
            ),
        );
        takes.push(Arc::new(framed_take(take, skeleton, rate, &resting, is_scaled)?));
    }
    if is_scaled {
        // Meshes and skins get the scale that their bones lose.
        let scaled = bone_matrices(skeleton, &rest);
        let lost = |bone: u32| {
            let (now, before) = (globals.get(bone as usize)?, scaled.get(bone as usize)?);
            Some(now.inverse() * *before)
        };
        let keep = |matrix: &mut Mat4, lost: Option<DMat4>| {
            let kept = lost.map_or(*matrix, |lost| (lost * matrix.as_dmat4()).as_mat4());
            *matrix = if kept.is_finite() { kept } else { *matrix };
        };
        for instance in framed.instances.iter_mut().filter(|instance| instance.skin.is_none()) {
            keep(&mut instance.to_bone, instance.bone.and_then(lost));
        }
        for skin in &mut framed.skins {
            skin.offsets.iter_mut().zip(&skin.bones).for_each(|(offset, &bone)| keep(offset, lost(bone)));
        }
        framed.animation.skeleton = Arc::new(without_scale(skeleton, &resting));
    }
    framed.animation = AnimationData { takes, ..framed.animation };
    Ok(framed)
}

/// Returns a rate that is not too low for lines between frames: twice that of takes with few keys.
fn fluent(rate: f32) -> f32 {
    if rate < LEAST_RATE { 2.0 * rate } else { rate }
}

/// Returns whether a bone has a scale, and lists a loss for a scale that changes.
fn has_scale(model: &ModelData, losses: &mut FbxLosses) -> bool {
    let is_scale = |scale: Vec3| (scale - Vec3::ONE).abs().max_element() > SCALED;
    let mut found = model.animation.skeleton.bones.iter().any(|bone| is_scale(bone.rest.scale));
    for (index, take) in model.animation.takes.iter().enumerate() {
        for track in &take.tracks {
            let rest = model.animation.skeleton.bones.get(track.bone as usize);
            let rest = rest.map_or(Vec3::ONE, |bone| bone.rest.scale);
            let values = (0..track.scale.len()).filter_map(|key| track.scale.value(key));
            let mut changing = values.filter(|value| (*value - rest).abs().max_element() > SCALED);
            if changing.next().is_some() {
                found = true;
                let text = "bones have no scale; only the positions of the bones below follow it";
                losses.add(format!("/animation/takes/{index}/tracks"), text);
                break;
            }
        }
    }
    found
}

/// Returns poses without scale whose bones have the same origins and directions, and their matrices in the scene.
fn unscaled(skeleton: &Skeleton, poses: &[LocalPose]) -> (Vec<LocalPose>, Vec<DMat4>) {
    let mut globals: Vec<DMat4> = Vec::with_capacity(poses.len());
    let mut rotations: Vec<DQuat> = Vec::with_capacity(poses.len());
    let mut locals = Vec::with_capacity(poses.len());
    let scaled = bone_matrices(skeleton, poses);
    for ((bone, pose), matrix) in skeleton.bones.iter().zip(poses).zip(&scaled) {
        let parent = bone.parent.map(|parent| parent as usize).filter(|&parent| parent < globals.len());
        // Of a mirrored or sheared bone, the directions are those of its own rotations.
        let above = parent.map_or(DQuat::IDENTITY, |parent| rotations[parent]);
        let rotation = (above * pose.rotation).normalize();
        let origin = matrix.w_axis.truncate();
        let parent = parent.map_or(DMat4::IDENTITY, |parent| globals[parent]);
        let local = parent.inverse().transform_point3(origin);
        locals.push(LocalPose { translation: local, rotation: pose.rotation, scale: DVec3::ONE });
        rotations.push(rotation);
        globals.push(DMat4::from_rotation_translation(rotation, origin));
    }
    (locals, globals)
}

fn without_scale(skeleton: &Skeleton, resting: &[LocalPose]) -> Skeleton {
    let mut bones = skeleton.bones.clone();
    for (bone, pose) in bones.iter_mut().zip(resting) {
        let (translation, rotation) = (pose.translation.as_vec3(), pose.rotation.as_quat());
        bone.rest = Transform { translation, rotation, scale: Vec3::ONE };
        bone.rest_matrix = None;
    }
    Skeleton { bones }
}

fn framed_take(
    take: &Take,
    skeleton: &Skeleton,
    rate: f32,
    resting: &[LocalPose],
    is_scaled: bool,
) -> Result<Take, ExportError> {
    let bones = skeleton.len();
    let frames = frames_over(f64::from(take.length.max(0.0)), f64::from(rate));
    let poses = frames.saturating_mul(bones.max(1));
    if poses > MOST_POSES {
        return Err(ExportError::new(format!(
            "take \"{}\": {frames} frames of {bones} bones are more than {MOST_POSES} poses",
            take.name
        )));
    }
    let at = |frame: usize| f64::from(take.start) + frame as f64 / f64::from(rate);
    // In single precision, as the times of keys: a step at a frame happens at that frame.
    let times: Arc<[f32]> = (0..frames).map(|frame| at(frame) as f32).collect();
    let mut columns: Vec<Vec<LocalPose>> = vec![Vec::with_capacity(frames); bones];
    for time in times.iter().map(|&time| f64::from(time)) {
        let mut row: Vec<LocalPose> = Vec::with_capacity(bones);
        for (index, bone) in skeleton.bones.iter().enumerate() {
            let nothing = Track::default();
            let track = take.tracks.get(index).unwrap_or(&nothing);
            row.push(LocalPose {
                translation: vector(&track.translation, bone.rest.translation, time),
                rotation: rotation(&track.rotation, bone.rest.rotation, time),
                scale: vector(&track.scale, bone.rest.scale, time),
            });
        }
        let row = if is_scaled { unscaled(skeleton, &row).0 } else { row };
        columns.iter_mut().zip(row).for_each(|(column, pose)| column.push(pose));
    }
    let tracks = columns.iter().zip(resting).enumerate();
    let tracks =
        tracks.map(|(bone, (column, rest))| framed_track(bone as u32, column, rest, &times)).collect();
    let morphs = take.morphs.iter().map(|morph| framed_weights(take, morph, &times)).collect();
    let length = at(frames - 1) as f32 - take.start;
    let mut framed = Take { tracks, morphs, length, ..take.clone() };
    // A take that only holds the rest pose keeps its length.
    if framed.range_of_keys().is_none_or(|(start, end)| end - start < length)
        && let Some(track) = framed.tracks.first_mut()
        && let Some(column) = columns.first()
        && take.range_of_keys().is_some()
    {
        let values: Vec<Quat> = column.iter().map(|pose| pose.rotation.as_quat()).collect();
        track.rotation = Channel::new(times, values, Interpolation::Linear);
    }
    Ok(framed)
}

/// Returns the keys of a bone; none of what stays at rest.
fn framed_track(bone: u32, column: &[LocalPose], rest: &LocalPose, times: &Arc<[f32]>) -> Track {
    let mut track = Track { bone, ..Track::default() };
    let moves = |value: fn(&LocalPose) -> DVec3| {
        column.iter().any(|pose| (value(pose) - value(rest)).abs().max_element() > 1e-7)
    };
    let vectors = |value: fn(&LocalPose) -> DVec3| {
        let values: Vec<Vec3> = column.iter().map(|pose| value(pose).as_vec3()).collect();
        Channel::new(Arc::clone(times), values, Interpolation::Linear)
    };
    if moves(|pose| pose.translation) {
        track.translation = vectors(|pose| pose.translation);
    }
    if moves(|pose| pose.scale) {
        track.scale = vectors(|pose| pose.scale);
    }
    if column.iter().any(|pose| pose.rotation.dot(rest.rotation).abs() < 1.0 - 1e-13) {
        let values: Vec<Quat> = column.iter().map(|pose| pose.rotation.as_quat()).collect();
        track.rotation = Channel::new(Arc::clone(times), values, Interpolation::Linear);
    }
    track
}

fn framed_weights(take: &Take, morph: &MorphTrack, times: &Arc<[f32]>) -> MorphTrack {
    let mut weights = Vec::new();
    for &time in times.iter() {
        let mut row = vec![0.0; morph.targets as usize];
        sample_morph_weights(Some(take), morph.instance, &[], time, &mut row);
        weights.extend(row);
    }
    let (times, weights) = (Arc::clone(times), weights.into());
    MorphTrack { times, weights, interpolation: Interpolation::Linear, ..morph.clone() }
}
