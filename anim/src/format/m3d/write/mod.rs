//! Writes a file of any model: one list of vertices, one range of triangles for each material, all bones and takes.

mod bind;
mod numbers;
mod surfaces;
mod vertices;

use super::check as code;
use super::dialect::M3dDialect;
use super::save::ClipWriter;
use crate::data::{ModelData, Skeleton};
use crate::format::losses::Losses;
use crate::format::{AxisMap, ExportError, Handedness, UpAxis, WholeFile};
use bind::FileSkeleton;
use numbers::row;
use std::fmt::Write;
use vertices::FileVertices;

/// Largest number of vertices that indices of 16 bits reach.
const VERTICES_16_BIT: usize = 65_536;

/// Writes a model as an `.m3d` file, in the dialect of 2012 or of 2016.
///
/// The data is left-handed, as Direct3D expects, and meshes in the scene and on bones are in one space: those on bones follow their
/// bone with every vertex. What the format has no room for is listed.
///
/// Errors: the dialect is that of 2008, which has no bones; or a name of the file cannot be written.
pub fn write(model: &ModelData, dialect: M3dDialect) -> Result<WholeFile, ExportError> {
    if dialect == M3dDialect::Dx10 {
        return Err(ExportError::new("files of the dialect of 2008 have no bones; use that of 2012 or 2016"));
    }
    let mut losses = Losses::default();
    let to_file = AxisMap::new(UpAxis::Y, Handedness::Left, 1.0).inverse();
    let bones = FileSkeleton::of(model, &mut losses);
    let vertices = FileVertices::of(model, &bones, &to_file, &mut losses);
    if vertices.len() > VERTICES_16_BIT {
        let text = format!(
            "{} vertices: programs with indices of 16 bits read at most {VERTICES_16_BIT}",
            vertices.len()
        );
        losses.add("/meshes".to_owned(), code::INDICES_TOO_LARGE, text);
    }
    let mut text = String::from("***************m3d-File-Header***************\n");
    let takes = if bones.skeleton.is_empty() { 0 } else { model.animation.takes.len() };
    for (label, count) in [
        ("Materials", vertices.parts.len()),
        ("Vertices", vertices.len()),
        ("Triangles", vertices.triangles()),
        ("Bones", bones.skeleton.len()),
        ("AnimationClips", takes),
    ] {
        let _ = writeln!(text, "#{label} {count}");
    }
    text += "\n***************Materials*********************\n";
    for part in &vertices.parts {
        surfaces::write(model, part.material, dialect, &mut losses, &mut text);
    }
    vertices.write(&mut text);
    if !bones.skeleton.is_empty() {
        write_bones(&bones.skeleton, &to_file, &mut text);
        write_takes(model, &bones.skeleton, to_file, &mut losses, &mut text);
    } else if !model.animation.takes.is_empty() {
        let reason = "a file without bones has no takes";
        losses.add("/animation/takes".to_owned(), code::TAKE_NOT_STORED, reason);
    }
    Ok(WholeFile { bytes: text.into_bytes(), lost: losses.into_list_of(model) })
}

fn write_bones(skeleton: &Skeleton, to_file: &AxisMap, text: &mut String) {
    *text += "***************BoneOffsets*******************\n";
    for (index, bone) in skeleton.bones.iter().enumerate() {
        let numbers = to_file.matrix(bone.offset).to_cols_array();
        let _ = writeln!(text, "BoneOffset{index} {}", row(&numbers));
    }
    *text += "\n***************BoneHierarchy*****************\n";
    for (index, bone) in skeleton.bones.iter().enumerate() {
        let parent = bone.parent.map_or("-1".to_owned(), |parent| parent.to_string());
        let _ = writeln!(text, "ParentIndexOfBone{index}: {parent}");
    }
    *text += "\n***************AnimationClips****************\n";
}

fn write_takes(
    model: &ModelData,
    skeleton: &Skeleton,
    to_file: AxisMap,
    losses: &mut Losses,
    text: &mut String,
) {
    let writer = ClipWriter::plain(skeleton, to_file);
    for (index, take) in model.animation.takes.iter().enumerate() {
        let name = writer.name(take, None, index, losses);
        *text += &writer.made(take, &name, index, losses);
        *text += "\n\n";
    }
}
