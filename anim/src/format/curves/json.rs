//! A tree of takes, objects, curves and keys.

use super::{TableCurve, file, mesh_of, number};
use crate::data::{Interpolation, ModelData, MorphTrack, Take};
use crate::format::losses::json_text;
use crate::format::{ExportError, WholeFile};
use std::fmt::Write;

/// Writes the curves of all takes as JSON.
pub(super) fn write(model: &ModelData) -> Result<WholeFile, ExportError> {
    let mut text = String::from("{\n\"dragonfly_curves\": 1,\n\"takes\": [");
    separated(&mut text, &model.animation.takes, |text, take| one_take(model, take, text));
    text.push_str("\n]\n}\n");
    file(model, text)
}

fn one_take(model: &ModelData, take: &Take, text: &mut String) {
    let _ = write!(
        text,
        "\n{{\"name\": {}, \"start\": {}, \"length\": {},\n \"bones\": [",
        json_text(&take.name),
        number(take.start),
        number(take.length)
    );
    let bones = model.animation.skeleton.bones.iter().enumerate();
    let moved = bones.map(|(index, bone)| (index, bone, TableCurve::of_bone(take, index)));
    separated(text, moved.filter(|(.., curves)| !curves.is_empty()), |text, (index, bone, curves)| {
        let _ = write!(text, "\n  {{\"index\": {index}, \"name\": {}", json_text(&bone.name));
        for curve in &curves {
            let _ = write!(text, ",\n   \"{}\": {{", curve.property);
            one_curve(curve, text);
            text.push('}');
        }
        text.push('}');
    });
    text.push_str("],\n \"meshes\": [");
    separated(text, &take.morphs, |text, track| one_mesh(model, track, text));
    text.push_str("]}");
}

fn one_mesh(model: &ModelData, track: &MorphTrack, text: &mut String) {
    let (mesh, names) = mesh_of(model, track.instance);
    let _ =
        write!(text, "\n  {{\"index\": {}, \"name\": {}, \"shape_keys\": [", track.instance, json_text(mesh));
    separated(text, names, |text, name| text.push_str(&json_text(name)));
    text.push_str("],\n   \"weights\": {");
    one_curve(&TableCurve::of_morphs(track), text);
    text.push_str("}}");
}

fn one_curve(curve: &TableCurve<'_>, text: &mut String) {
    let _ = write!(text, "\"interpolation\": \"{}\", \"times\": ", curve.interpolation());
    list(text, curve.times);
    let lists = |text: &mut String, name: &str, of: fn(&super::TableKey<'_>) -> Vec<f32>| {
        let _ = write!(text, ",\n    \"{name}\": [");
        separated(text, curve.keys(), |text, key| list(text, &of(&key)));
        text.push(']');
    };
    lists(text, "values", |key| key.value.to_vec());
    if curve.interpolation == Interpolation::CubicSpline {
        lists(text, "in_tangents", |key| key.in_tangent.to_vec());
        lists(text, "out_tangents", |key| key.out_tangent.to_vec());
    }
}

fn list(text: &mut String, numbers: &[f32]) {
    text.push('[');
    separated(text, numbers, |text, &value| text.push_str(&number(value)));
    text.push(']');
}

/// Writes the items of a list with commas between them.
fn separated<T>(
    text: &mut String,
    items: impl IntoIterator<Item = T>,
    mut write: impl FnMut(&mut String, T),
) {
    for (index, item) in items.into_iter().enumerate() {
        if index > 0 {
            text.push_str(", ");
        }
        write(text, item);
    }
}
