//! Curves of takes as tables, for spreadsheets, plots and scripts: written, never read.
//!
//! A file has every key of every take: per bone translation (meters), rotation (unit quaternion x, y, z, w) and scale, each
//! relative to the parent bone, and per mesh the weights of its shape keys. Times are in seconds. Numbers are the shortest texts that
//! are read as the same 32-bit float. `FORMATS.md` describes the columns.

mod csv;
mod json;

use super::losses::Losses;
use super::{ExportError, ExportModel, Format, ImportContext, ImportError, WholeFile, WriteSupport};
use crate::data::{Channel, Interpolation, ModelData, MorphTrack, Take};
use glam::{Quat, Vec3};

/// Curves as a table with one row per number, `.csv`.
pub const CURVES_CSV: Format =
    table("csv", "Curves, table (CSV)", &["csv"], |model, name| Ok(csv::write(model)?.named(name)));

/// Curves as a tree, `.json`.
pub const CURVES_JSON: Format =
    table("json", "Curves, JSON", &["json"], |model, name| Ok(json::write(model)?.named(name)));

/// Content that a table of curves does not contain.
const NOT_A_CURVE: &str = "NOT_A_CURVE";

/// Returns a format that is written and never read: no content and no name of a file is taken for it.
const fn table(
    name: &'static str,
    title: &'static str,
    extensions: &'static [&'static str],
    export: ExportModel,
) -> Format {
    let write = WriteSupport::None;
    Format { name, title, extensions, sniff: |_| false, read: not_read, write, export: Some(export) }
}

fn not_read(_bytes: &[u8], _context: &ImportContext<'_>) -> Result<ModelData, ImportError> {
    Err(ImportError::UnknownFormat { name: "table of curves".to_owned() })
}

/// The keys of one property of a bone or a mesh.
struct TableCurve<'a> {
    /// `translation`, `rotation`, `scale` or `weights`.
    property: &'static str,
    interpolation: Interpolation,
    times: &'a [f32],
    /// Numbers of a value.
    width: usize,
    /// Numbers of all keys; of a cubic spline the in-tangent, the value and the out-tangent of each.
    numbers: Vec<f32>,
}

/// The numbers of one key; tangents are empty where the curve has none.
struct TableKey<'c> {
    time: f32,
    value: &'c [f32],
    in_tangent: &'c [f32],
    out_tangent: &'c [f32],
}

impl<'a> TableCurve<'a> {
    /// Returns the curves of a bone that have keys.
    fn of_bone(take: &'a Take, bone: usize) -> Vec<Self> {
        let Some(track) = take.tracks.get(bone) else { return Vec::new() };
        let vectors = |property, channel: &'a Channel<Vec3>| {
            Self::of(property, channel, 3, channel.values.iter().flat_map(|value| value.to_array()).collect())
        };
        let turns = |channel: &'a Channel<Quat>| {
            let numbers = channel.values.iter().flat_map(|value| value.to_array()).collect();
            Self::of("rotation", channel, 4, numbers)
        };
        let all = [
            vectors("translation", &track.translation),
            turns(&track.rotation),
            vectors("scale", &track.scale),
        ];
        all.into_iter().filter(|curve| !curve.times.is_empty()).collect()
    }

    fn of<T>(property: &'static str, channel: &'a Channel<T>, width: usize, numbers: Vec<f32>) -> Self {
        Self { property, interpolation: channel.interpolation, times: &channel.times, width, numbers }
    }

    /// Returns the curve of the shape keys of a mesh.
    fn of_morphs(track: &'a MorphTrack) -> Self {
        let (times, width, numbers) = (&track.times, track.targets as usize, track.weights.to_vec());
        Self { property: "weights", interpolation: track.interpolation, times, width, numbers }
    }

    /// Returns the keys in the order of their times.
    fn keys(&self) -> impl Iterator<Item = TableKey<'_>> {
        let is_spline = self.interpolation == Interpolation::CubicSpline;
        let of_key = if is_spline { 3 * self.width } else { self.width };
        self.times.iter().zip(self.numbers.chunks_exact(of_key.max(1))).map(move |(&time, numbers)| {
            let (in_tangent, rest) = numbers.split_at(if is_spline { self.width } else { 0 });
            let (value, out_tangent) = rest.split_at(self.width);
            TableKey { time, value, in_tangent, out_tangent }
        })
    }

    /// Returns the word for the interpolation.
    fn interpolation(&self) -> &'static str {
        match self.interpolation {
            Interpolation::Step => "step",
            Interpolation::Linear => "linear",
            Interpolation::CubicSpline => "cubic",
            Interpolation::Closest => "closest",
        }
    }
}

/// Returns the name of the mesh of an instance, and the names of its shape keys.
fn mesh_of(model: &ModelData, instance: u32) -> (&str, Vec<&str>) {
    let instance = model.instances.get(instance as usize);
    let Some(mesh) = instance.and_then(|instance| model.meshes.get(instance.mesh as usize)) else {
        return ("", Vec::new());
    };
    let targets = mesh.primitives.iter().map(|primitive| &primitive.morph_targets);
    let targets = targets.max_by_key(|targets| targets.len()).map_or(&[][..], Vec::as_slice);
    (&mesh.name, targets.iter().map(|target| target.name.as_str()).collect())
}

/// Returns the shortest text that is read as the same 32-bit float.
fn number(number: f32) -> String {
    format!("{number:?}")
}

/// Returns the file, with what it does not contain.
///
/// # Errors
///
/// The model has no take.
fn file(model: &ModelData, text: String) -> Result<WholeFile, ExportError> {
    if model.animation.takes.is_empty() {
        return Err(ExportError::new("the model has no take, and the file consists of the curves of takes"));
    }
    let mut losses = Losses::default();
    let text_of_model = "only curves are stored: no rest poses, meshes, skins, materials and images";
    losses.add("/".to_owned(), NOT_A_CURVE, text_of_model);
    for (index, take) in model.animation.takes.iter().enumerate() {
        if !take.extras.is_empty() {
            let path = format!("/animation/takes/{index}/extras");
            losses.add(path, NOT_A_CURVE, "layers, contacts and events are not stored");
        }
    }
    Ok(WholeFile { bytes: text.into_bytes(), lost: losses.into_list_of(model) })
}
