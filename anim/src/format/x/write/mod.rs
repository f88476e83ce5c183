//! Writes a text of any model: frames with their meshes, materials, skin weights, and animation sets.

mod mesh;
mod surfaces;

use super::check as code;
use super::key_text::{KeyText, decimal};
use super::names::possible;
use super::save::take_name;
use crate::data::{ModelData, Skeleton, Track};
use crate::format::losses::Losses;
use crate::format::names::UniqueNames;
use crate::format::{AxisMap, ExportError, Handedness, UpAxis, WholeFile};
use crate::sample::rest_pose;
use glam::Mat4;
use mesh::MeshWriter;
use std::fmt::Write;

/// Ticks per second of a written file.
const TICKS: u16 = 4800;

/// The header, and the templates that not every program knows.
const HEAD: &str = "xof 0303txt 0032

template XSkinMeshHeader {
 <3cf169ce-ff7c-44ab-93c0-f78f62d172e2>
 WORD nMaxSkinWeightsPerVertex;
 WORD nMaxSkinWeightsPerFace;
 WORD nBones;
}

template SkinWeights {
 <6f0d123b-bad2-4167-a0d0-80224f25fabb>
 STRING transformNodeName;
 DWORD nWeights;
 array DWORD vertexIndices[nWeights];
 array FLOAT weights[nWeights];
 Matrix4x4 matrixOffset;
}

template AnimTicksPerSecond {
 <9e415a43-7ba6-4a73-8743-b73d47e88476>
 DWORD AnimTicksPerSecond;
}

";

/// Writes a model as a DirectX text.
///
/// The data is left-handed, times are in 4800 ticks per second, and every bone is a frame; what the format has no room for is
/// listed.
pub fn write(model: &ModelData) -> Result<WholeFile, ExportError> {
    let mut losses = Losses::default();
    let to_file = AxisMap::new(UpAxis::Y, Handedness::Left, 1.0).inverse();
    let frames = frame_names(&model.animation.skeleton, &mut losses);
    let mut text = HEAD.to_owned();
    let materials = surfaces::write(model, &mut losses, &mut text);
    let meshes = MeshWriter { model, to_file, frames: &frames, materials: &materials };
    write_frames(&meshes, &mut losses, &mut text);
    for index in 0..model.instances.len() {
        if meshes.bone_of(index).is_none() {
            meshes.write(index, 0, &mut losses, &mut text);
        }
    }
    if !model.animation.takes.is_empty() {
        let _ = write!(text, "AnimTicksPerSecond {{\n {TICKS};\n}}\n\n");
    }
    write_takes(model, &frames, to_file, &mut losses, &mut text);
    Ok(WholeFile { bytes: text.into_bytes(), lost: losses.into_list_of(model) })
}

/// Returns the name of the frame of each bone.
fn frame_names(skeleton: &Skeleton, losses: &mut Losses) -> Vec<String> {
    let mut names = UniqueNames::default();
    let mut frames = Vec::with_capacity(skeleton.len());
    for (index, bone) in skeleton.bones.iter().enumerate() {
        let wanted = if bone.name.is_empty() { "frame".to_owned() } else { possible(&bone.name) };
        let (name, _) = names.make(wanted);
        if name != bone.name {
            let text = format!("the bone \"{}\" is called \"{name}\"", bone.name);
            losses.add(format!("/animation/skeleton/bones/{index}/name"), code::NAME_NOT_STORED, text);
        }
        frames.push(name);
    }
    frames
}

/// Writes all frames, with the meshes that bones carry.
fn write_frames(meshes: &MeshWriter<'_>, losses: &mut Losses, text: &mut String) {
    let skeleton = &meshes.model.animation.skeleton;
    let mut children = vec![Vec::new(); skeleton.len()];
    let mut carried = vec![Vec::new(); skeleton.len()];
    let mut pending = Vec::new();
    for (index, bone) in skeleton.bones.iter().enumerate().rev() {
        match bone.parent {
            Some(parent) => children[parent as usize].push(index),
            None => pending.push((index, 0)),
        }
    }
    for index in 0..meshes.model.instances.len() {
        if let Some(bone) = meshes.bone_of(index) {
            carried[bone as usize].push(index);
        }
    }
    let mut open = 0;
    while let Some((bone, depth)) = pending.pop() {
        close(text, &mut open, depth);
        let own = &skeleton.bones[bone];
        let local = own.rest_matrix.unwrap_or_else(|| rest_pose(own).to_matrix());
        open_frame(&meshes.frames[bone], meshes.to_file.matrix(local), depth, text);
        open = depth + 1;
        for &instance in &carried[bone] {
            meshes.write(instance, depth + 1, losses, text);
        }
        pending.extend(children[bone].iter().map(|&child| (child, depth + 1)));
    }
    close(text, &mut open, 0);
    *text += "\n";
}

/// Writes the start of a frame, and its transform.
fn open_frame(name: &str, matrix: Mat4, depth: usize, text: &mut String) {
    let indent = " ".repeat(depth);
    let numbers = list(&matrix.to_cols_array());
    let _ = writeln!(
        text,
        "{indent}Frame {name} {{\n{indent} FrameTransformMatrix {{\n{indent}  {numbers};;\n{indent} }}"
    );
}

fn close(text: &mut String, open: &mut usize, depth: usize) {
    while *open > depth {
        *open -= 1;
        let _ = writeln!(text, "{}}}", " ".repeat(*open));
    }
}

fn write_takes(
    model: &ModelData,
    frames: &[String],
    to_file: AxisMap,
    losses: &mut Losses,
    text: &mut String,
) {
    let keys = KeyText { to_file, ticks_per_second: f64::from(TICKS), line_end: "\n" };
    let nothing = Track::default();
    for (index, take) in model.animation.takes.iter().enumerate() {
        let name = take_name(take, None, index, losses);
        let _ = writeln!(text, "AnimationSet {name} {{");
        for (track, (bone, frame)) in
            take.tracks.iter().zip(model.animation.skeleton.bones.iter().zip(frames))
        {
            if !track.is_empty() {
                keys.list_losses(track, &nothing, index, losses);
                let lists = keys.lists(track, rest_pose(bone));
                let _ = writeln!(text, " {}", keys.animation(frame, &lists, " "));
            }
        }
        *text += "}\n\n";
    }
}

/// Returns numbers with commas between them.
fn list(numbers: &[f32]) -> String {
    numbers.iter().map(|&number| decimal(number)).collect::<Vec<_>>().join(",")
}
