//! The sections of a file, in their order.

use super::bones::{BONE_BYTES, M3dBone, bones};
use super::check as code;
use super::clips::{M3dClip, clips};
use super::dialect::{M3dDialect, is_other_format};
use super::geometry::{
    M3dTriangles, M3dVertices, TRIANGLE_BYTES, VERTEX_BYTES, subsets, triangles, vertices,
};
use super::material::{M3dMaterial, dx10, materials};
use super::scan::{M3dScanner, is_number};
use crate::format::{Conversion, Found, Handedness, ImportContext, ImportError, Place};
use crate::limits::JOINTS_PER_SKIN;
use glam::Vec3;
use std::ops::Range;

/// Bytes of the shortest material.
const MATERIAL_BYTES: usize = 12;

/// A parsed file.
pub(super) struct M3dText {
    pub(super) materials: Vec<M3dMaterial>,
    /// Range of triangles of each material; empty for the dialect without a table.
    pub(super) subsets: Vec<Range<u32>>,
    pub(super) vertices: M3dVertices,
    pub(super) triangles: M3dTriangles,
    pub(super) bones: Vec<M3dBone>,
    pub(super) clips: Vec<M3dClip>,
    /// Place of the number of clips; `None` for a file without bones.
    pub(super) clip_count: Option<Range<usize>>,
    /// End of the banner before the clips, and whether there is one.
    pub(super) clips_at: (usize, bool),
    pub(super) conversion: Conversion,
    /// Whether most triangles face the other way than their vertices.
    pub(super) opposes_normals: bool,
}

impl M3dText {
    pub(super) fn parse(bytes: &[u8], context: &ImportContext<'_>) -> Result<Self, ImportError> {
        refuse_other_format(bytes)?;
        let mut scanner = M3dScanner::new(bytes);
        scanner.label("the header")?;
        let (material_count, _) = scanner.count("the number of materials", MATERIAL_BYTES)?;
        let (vertex_count, _) = scanner.count("the number of vertices", VERTEX_BYTES)?;
        let (triangle_count, _) = scanner.count("the number of triangles", TRIANGLE_BYTES)?;
        let (mut bone_count, mut clip_count, mut clip_token) = (0, 0, None);
        let has_bones = follows_count(&mut scanner);
        if has_bones {
            let (bones, token) = scanner.count("the number of bones", BONE_BYTES)?;
            if bones > JOINTS_PER_SKIN {
                let (place, size, limit) = (scanner.place(token.at), bones as u64, JOINTS_PER_SKIN as u64);
                return Err(ImportError::TooLarge { place, what: "bones", size, limit });
            }
            let (clips, token) = scanner.count("the number of clips", 1)?;
            (bone_count, clip_count) = (bones, clips);
            clip_token = (bones > 0).then_some(token.at..token.at + token.text.len());
        }
        let (dialect, materials, subsets) = if has_bones {
            let (dialect, materials) = materials(&mut scanner, material_count, context)?;
            (dialect, materials, subsets(&mut scanner, [material_count, triangle_count], context)?)
        } else {
            (M3dDialect::Dx10, dx10(&mut scanner, material_count, context)?, Vec::new())
        };
        context.progress(0.1)?;
        let vertices = vertices(&mut scanner, vertex_count, bone_count, dialect, context)?;
        context.progress(0.4)?;
        let counts = [triangle_count, vertex_count, material_count];
        let triangles = triangles(&mut scanner, counts, dialect, context)?;
        let mut text = Self {
            materials,
            subsets,
            vertices,
            triangles,
            bones: Vec::new(),
            clips: Vec::new(),
            clip_count: clip_token,
            clips_at: (scanner.at(), false),
            conversion: Conversion::default(),
            opposes_normals: false,
        };
        if bone_count > 0 {
            text.bones = bones(&mut scanner, bone_count, context)?;
            text.clips_at.0 = scanner.at();
            if clip_count > 0 || scanner.peek().is_some() {
                text.clips = clips(&mut scanner, clip_count, bone_count, context)?;
                text.clips_at = (clips_start(bytes, text.clips_at.0), true);
            }
        } else if clip_count > 0 {
            let reason = format!("{clip_count} clips without bones are not possible");
            return Err(scanner.invalid(scanner.at(), code::INDEX_OUT_OF_RANGE, reason));
        }
        if let Some(token) = scanner.peek() {
            let text = format!("{} and the text after it are ignored: the model has ended", token.shown());
            context.warn(scanner.place(token.at), code::TEXT_IGNORED, text);
        }
        context.work(text.triangles.indices.len())?;
        text.opposes_normals = text.opposes_normals();
        let side = if text.opposes_normals { Handedness::Right } else { Handedness::Left };
        text.conversion = Conversion {
            meters_per_unit: Found::guessed(1.0),
            handedness: Found::guessed(side),
            ..Conversion::default()
        }
        .with(context.conventions());
        Ok(text)
    }

    /// Returns whether the order of the corners of every triangle has to be reversed, so that in the model they are
    /// counter-clockwise seen from where the normals point to.
    pub(super) fn reverses(&self) -> bool {
        self.conversion.axes().mirrors() != self.opposes_normals
    }

    /// Returns whether more triangles oppose the normals of their vertices than agree with them.
    fn opposes_normals(&self) -> bool {
        let M3dVertices { positions, normals, .. } = &self.vertices;
        let (mut agree, mut oppose) = (0_usize, 0_usize);
        for corners in &self.triangles.indices {
            let [a, b, c] = corners.map(|corner| positions[corner as usize]);
            let normal: Vec3 = corners.iter().map(|&corner| normals[corner as usize]).sum();
            let side = (b - a).cross(c - a).dot(normal);
            agree += usize::from(side > 0.0);
            oppose += usize::from(side < 0.0);
        }
        oppose > agree
    }
}

/// Returns the end of the banner of the clips, which is the first token from `at` on.
fn clips_start(bytes: &[u8], at: usize) -> usize {
    let mut scanner = M3dScanner::new(bytes);
    scanner.go_to(at);
    scanner.word("a banner").map_or(at, |token| token.at + token.text.len())
}

/// Returns whether a label and a number follow, and not a banner and a name.
fn follows_count(scanner: &mut M3dScanner<'_>) -> bool {
    let at = scanner.at();
    let is_label = scanner.label("a label").is_ok();
    let follows = is_label && scanner.word("a count").is_ok_and(is_number);
    scanner.go_to(at);
    follows
}

/// Refuses the other format whose files are named `.m3d`.
fn refuse_other_format(bytes: &[u8]) -> Result<(), ImportError> {
    if is_other_format(bytes) {
        let feature = "the other format called .m3d, Model 3D (3DMO)".to_owned();
        return Err(ImportError::Unsupported { place: Place::Byte(0), feature });
    }
    Ok(())
}
