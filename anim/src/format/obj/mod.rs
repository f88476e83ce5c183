//! Wavefront OBJ: static models as text, with materials in an `.mtl` file next to it.
//!
//! # What is read
//!
//! Polygons of any size, divided in their plane , with texture coordinates, normals and the colors of positions that
//! many programs append. One mesh for each object and group, one primitive for each material. Where a polygon has no normals they are
//! computed: smooth within a smoothing group, flat without one. Materials have Phong values (`Ka Kd Ks Ns Ke d Tr`) or physically based
//! ones (`Pr Pm`), and textures for color, emission and normals. Points, lines, curves and surfaces are not shown.
//!
//! The format has no units and no axes; meters, Y up and right-handed are assumed unless the user chooses others.
//!
//! [`write`](fn@write) makes the files of one pose of any model, [`write_sequence`] those of every frame of a take. An OBJ file cannot hold an
//! animation, so a model is never saved as one by itself.

pub mod check;
mod faces;
mod lines;
mod materials;
mod meshes;
mod quick;
mod sequence;
mod vertices;
mod write;

pub use sequence::write_sequence;
pub use write::write;

use super::decimal::parse_number;
use super::image::NeighborImages;
use super::losses::avatar_lost;
use super::{
    Conversion, ExportError, Format, Found, Handedness, ImportContext, ImportError, Place, SavePlan, UpAxis,
    Warning, WriteSupport,
};
use crate::data::{MeshInstance, ModelData};
use crate::evaluator::Evaluator;
use glam::Mat4;
use std::sync::Arc;

/// Wavefront OBJ, `.obj`.
pub const OBJ: Format = Format {
    name: "obj",
    title: "Wavefront OBJ",
    extensions: &["obj"],
    sniff: looks_like_obj,
    read,
    write: WriteSupport::None,
    export: Some(export),
};

/// Writes the pose at the start of the first take; the rest pose of a model without takes.
fn export(model: &ModelData, name: &str) -> Result<SavePlan, ExportError> {
    let mut evaluator = Evaluator::new(Arc::new(model.clone()));
    let take = model.animation.takes.first();
    evaluator.pose(take.map(|_| 0), take.map_or(0.0, |take| take.start));
    let stem = name.rsplit_once('.').map_or(name, |(stem, _)| stem);
    let mut plan = write(&evaluator, stem);
    if take.is_some() {
        let text = "the takes are not written; the pose at the start of the first one is";
        let place = Place::Pointer("/animation/takes".to_owned());
        plan.lost.push(Warning { place, code: "ANIMATION_NOT_WRITTEN", text: text.to_owned() });
    }
    plan.lost.extend(avatar_lost(model));
    Ok(plan)
}

/// Number of bytes in which a file is recognized.
const SNIFFED: usize = 4096;

/// Returns whether the first lines are statements of an OBJ file, and one of them a position.
fn looks_like_obj(bytes: &[u8]) -> bool {
    let (start, is_cut) = bytes.get(..SNIFFED).map_or((bytes, false), |start| (start, true));
    let text = lines::in_utf_8(start);
    let text = text.strip_prefix(b"\xef\xbb\xbf").unwrap_or(&text);
    let end = if text.contains(&b'\n') { b'\n' } else { b'\r' };
    let mut lines: Vec<&[u8]> = text.split(|byte| *byte == end).map(<[u8]>::trim_ascii_end).collect();
    if is_cut {
        lines.pop();
    }
    let (mut has_position, mut continues) = (false, false);
    for line in lines {
        if std::mem::replace(&mut continues, line.ends_with(b"\\")) {
            continue;
        }
        let mut words = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
        match words.next() {
            None => {}
            Some(word) if word.starts_with(b"#") => {}
            Some(b"v") => {
                let numbers = words.take_while(|word| parse_number(word).is_some()).count();
                if numbers < 3 && !continues {
                    return false;
                }
                has_position = true;
            }
            Some(b"vt" | b"vn" | b"f" | b"o" | b"g" | b"s" | b"usemtl" | b"mtllib" | b"l" | b"p") => {}
            Some(_) => return false,
        }
    }
    has_position
}

fn read(bytes: &[u8], context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    let conversion = Conversion {
        meters_per_unit: Found::guessed(1.0),
        up: Found::guessed(UpAxis::Y),
        handedness: Found::guessed(Handedness::Right),
        frame_rate: None,
    };
    let conversion = conversion.with(context.conventions());
    context.converted(conversion);
    let axes = conversion.axes();
    let bytes = lines::decoded(bytes, context)?;
    let text = faces::parse(&bytes, &axes, context)?;
    context.progress(0.5)?;
    let mut images = NeighborImages::new(context);
    let materials = materials::materials(&bytes, &text, &mut images, context)?;
    context.progress(0.6)?;
    let meshes = meshes::meshes(&bytes, &text, &axes, context)?;
    let mut instances = context.vec(&super::Place::File, meshes.len())?;
    instances.extend((0..meshes.len() as u32).map(|mesh| MeshInstance {
        mesh,
        node: None,
        skin: None,
        bone: None,
        to_bone: Mat4::IDENTITY,
        morph_weights: Vec::new(),
    }));
    Ok(ModelData { meshes, instances, materials, images: images.into_images(), ..ModelData::default() })
}
