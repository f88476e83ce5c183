//! One row per number of a key.

use super::{TableCurve, file, mesh_of, number};
use crate::data::ModelData;
use crate::format::{ExportError, WholeFile};
use std::fmt::Write;

/// The first row.
const HEAD: &str =
    "take,object,index,name,property,component,time,value,interpolation,in_tangent,out_tangent\r\n";

/// Writes the curves of all takes as comma-separated values (RFC 4180).
pub(super) fn write(model: &ModelData) -> Result<WholeFile, ExportError> {
    let mut text = HEAD.to_owned();
    for take in &model.animation.takes {
        let name = quoted(&take.name);
        for (index, bone) in model.animation.skeleton.bones.iter().enumerate() {
            let object = format!("{name},bone,{index},{}", quoted(&bone.name));
            for curve in TableCurve::of_bone(take, index) {
                let components = ["x", "y", "z", "w"].map(str::to_owned);
                rows(&object, &curve, &components, &mut text);
            }
        }
        for track in &take.morphs {
            let (mesh, names) = mesh_of(model, track.instance);
            let object = format!("{name},mesh,{},{}", track.instance, quoted(mesh));
            let shape = |index: usize| match names.get(index) {
                Some(name) if !name.is_empty() => quoted(name),
                _ => index.to_string(),
            };
            let components: Vec<String> = (0..track.targets as usize).map(shape).collect();
            rows(&object, &TableCurve::of_morphs(track), &components, &mut text);
        }
    }
    file(model, text)
}

fn rows(object: &str, curve: &TableCurve<'_>, components: &[String], text: &mut String) {
    for key in curve.keys() {
        for ((at, value), component) in key.value.iter().enumerate().zip(components) {
            let tangent = |tangents: &[f32]| tangents.get(at).map_or_else(String::new, |&it| number(it));
            let _ = write!(
                text,
                "{object},{},{component},{},{},{},{},{}\r\n",
                curve.property,
                number(key.time),
                number(*value),
                curve.interpolation(),
                tangent(key.in_tangent),
                tangent(key.out_tangent)
            );
        }
    }
}

/// Returns a field, in quotes where it has characters that divide fields or rows.
fn quoted(field: &str) -> String {
    if field.contains(['"', ',', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\""))
    } else {
        field.to_owned()
    }
}
