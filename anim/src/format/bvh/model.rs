//! Joints and rows become a skeleton and one take.

use super::hierarchy::Joint;
use super::motion;
use super::parsed::BvhText;
use crate::data::{AnimationData, Bone, BoneIndex, Channel, Interpolation, ModelData, Skeleton, Take, Track};
use crate::data::{TakeExtras, Transform};
use crate::format::{AxisMap, ImportContext, ImportError, Place};
use crate::limits::HUGE;
use glam::{DVec3, Mat4, Quat, Vec3};
use std::sync::Arc;

/// Name of the take: that of the section in the file, which has no name of its own.
pub(super) const TAKE_NAME: &str = "motion";

/// Returns the model.
pub(super) fn model(text: &BvhText, context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    let axes = text.conversion.axes();
    let skeleton = Arc::new(skeleton(&text.hierarchy.joints, &axes, context)?);
    context.progress(0.6)?;
    let takes = match text.rows.frames {
        0 => Vec::new(),
        _ => vec![Arc::new(take(text, &axes, context)?)],
    };
    Ok(ModelData { animation: AnimationData { skeleton, takes }, ..ModelData::default() })
}

/// Returns the bones. In the rest pose every channel is zero: only the offsets remain.
fn skeleton(joints: &[Joint], axes: &AxisMap, context: &ImportContext<'_>) -> Result<Skeleton, ImportError> {
    let mut bones = context.vec(&Place::File, joints.len())?;
    let mut origins: Vec<DVec3> = context.vec(&Place::File, joints.len())?;
    context.work(joints.len())?;
    for joint in joints {
        let origin = joint.parent.map_or(DVec3::ZERO, |parent| origins[parent]) + joint.offset;
        origins.push(origin);
        bones.push(Bone {
            name: joint.name.clone(),
            parent: joint.parent.map(|parent| parent as BoneIndex),
            rest: Transform { translation: position(axes, joint.offset, joint)?, ..Transform::IDENTITY },
            rest_matrix: None,
            offset: Mat4::from_translation(-position(axes, origin, joint)?),
            node: None,
        });
    }
    Ok(Skeleton { bones })
}

fn take(text: &BvhText, axes: &AxisMap, context: &ImportContext<'_>) -> Result<Take, ImportError> {
    let frames = text.rows.frames;
    let times = motion::times(frames, text.seconds(), &Place::File, context)?;
    let joints = &text.hierarchy.joints;
    let mut tracks = context.vec(&Place::File, joints.len())?;
    for (index, joint) in joints.iter().enumerate() {
        let mut track = Track { bone: index as BoneIndex, ..Track::default() };
        if joint.channels.has_positions() {
            track.translation = channel(&times, translations(text, joint, axes, context)?);
        }
        if joint.channels.has_rotations() {
            track.rotation = channel(&times, rotations(text, joint, axes, context)?);
        }
        tracks.push(track);
        context.progress(0.6 + 0.4 * (index + 1) as f32 / joints.len() as f32)?;
    }
    let length = times.last().copied().unwrap_or_default();
    let (name, extras) = (TAKE_NAME.to_owned(), TakeExtras::default());
    Ok(Take { name, start: 0.0, length, tracks, morphs: Vec::new(), extras })
}

fn channel<T>(times: &Arc<[f32]>, values: Arc<[T]>) -> Channel<T> {
    Channel { times: Arc::clone(times), values, interpolation: Interpolation::Linear }
}

fn translations(
    text: &BvhText,
    joint: &Joint,
    axes: &AxisMap,
    context: &ImportContext<'_>,
) -> Result<Arc<[Vec3]>, ImportError> {
    let bytes = text.rows.frames * size_of::<Vec3>();
    context.charge(&Place::File, bytes as u64)?;
    context.work(text.rows.frames)?;
    let mut fault = None;
    let values = (0..text.rows.frames).map(|frame| {
        let translation = joint.channels.translation(joint.offset, text.row(frame, joint));
        position(axes, translation, joint).unwrap_or_else(|error| {
            fault.get_or_insert(error);
            Vec3::ZERO
        })
    });
    let values = values.collect();
    fault.map_or(Ok(values), Err)
}

fn rotations(
    text: &BvhText,
    joint: &Joint,
    axes: &AxisMap,
    context: &ImportContext<'_>,
) -> Result<Arc<[Quat]>, ImportError> {
    let bytes = text.rows.frames * size_of::<Quat>();
    context.charge(&Place::File, bytes as u64)?;
    context.work(text.rows.frames)?;
    let mut last = Quat::IDENTITY;
    let values = (0..text.rows.frames).map(|frame| {
        let rotation = joint.channels.rotation(text.row(frame, joint)).normalize().as_quat();
        let rotation = axes.rotation(rotation);
        // The first one has a positive w, and each next one is in the hemisphere of the one before.
        last = if last.dot(rotation) < 0.0 { -rotation } else { rotation };
        last
    });
    Ok(values.collect())
}

/// Converts a position of the file; one that is too large for the sums of a pose is an error.
fn position(axes: &AxisMap, position: DVec3, joint: &Joint) -> Result<Vec3, ImportError> {
    let converted = axes.position(position.as_vec3());
    if converted.abs().max_element() <= HUGE {
        return Ok(converted);
    }
    let reason = format!("a position of the joint \"{}\" is too large for single precision", joint.name);
    Err(ImportError::Invalid { place: Place::File, code: super::check::HUGE_POSITION, reason })
}
