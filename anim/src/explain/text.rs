//! Text of an explanation as a worked example: each step with its formula, its numbers, and the thesis's section.

use super::{
    BoneStep, ChannelStep, Explanation, InfluenceStep, KeysStep, MovementStep, Subject, VertexResult,
};
use crate::data::{BoneIndex, Interpolation};
use glam::{Mat4, Quat, Vec3};
use std::fmt::{Display, Formatter, Result};

impl Display for Explanation {
    fn fmt(&self, out: &mut Formatter<'_>) -> Result {
        title(self, out)?;
        for (number, step) in self.bones.iter().enumerate() {
            writeln!(out, "\nBone {} {:?}{}", step.bone, step.name, parent_text(step, number))?;
            keys(step, out)?;
            matrices(self, step, out)?;
        }
        match &self.subject {
            Subject::Bone(result) => {
                writeln!(out, "\nFinal pose, bind space to scene space (§2.1.5.1)")?;
                writeln!(out, "  final = to_root of bone {} * offset", result.bone)?;
                side_by_side(out, "offset", result.offset, "final", result.final_pose)
            }
            Subject::Vertex(result) => vertex(self, result, out),
        }
    }
}

fn title(explanation: &Explanation, out: &mut Formatter<'_>) -> Result {
    match &explanation.subject {
        Subject::Bone(result) => {
            let name = explanation.bone(result.bone).map_or("", |step| &step.name);
            write!(out, "Bone {} {name:?}", result.bone)?;
        }
        Subject::Vertex(vertex) => write!(
            out,
            "Vertex {} of mesh {:?}, instance {}, primitive {}",
            vertex.vertex, vertex.mesh, vertex.instance, vertex.primitive
        )?,
    }
    match &explanation.take {
        None => writeln!(out, ", rest pose")?,
        Some(take) => {
            let (name, time) = (&take.name, explanation.time);
            writeln!(
                out,
                ", take {} {name:?} ({} s to {} s), at {time} s",
                take.index, take.start, take.end
            )?;
        }
    }
    writeln!(out)?;
    writeln!(out, "  mix       = (time - before) / (after - before)         §2.1.5.2")?;
    writeln!(out, "  to_parent = translation * rotation * scale             §2.1.5.1")?;
    writeln!(out, "  to_root   = to_root of the parent * to_parent          §2.1.5.1")?;
    writeln!(out, "  final     = to_root * offset                           §2.1.5.1")?;
    if matches!(explanation.subject, Subject::Vertex(_)) {
        writeln!(out, "  position  = sum of final_i * stored position * weight_i  §2.1.4")?;
    }
    writeln!(
        out,
        "Matrices multiply column vectors; the thesis uses row vectors and the opposite order of factors."
    )
}

fn parent_text(step: &BoneStep, number: usize) -> String {
    match step.parent {
        Some(parent) => format!(", child of bone {parent}"),
        None if number == 0 => ", the root".to_owned(),
        None => ", a root".to_owned(),
    }
}

fn keys(step: &BoneStep, out: &mut Formatter<'_>) -> Result {
    writeln!(out, "  Keys around the time, and the temporary key-frame (§2.1.5.2)")?;
    channel("translation", &step.translation, vector, out)?;
    channel("rotation", &step.rotation, rotation, out)?;
    channel("scale", &step.scale, vector, out)
}

fn channel<T: Copy>(
    name: &str,
    step: &ChannelStep<T>,
    show: impl Fn(T) -> String,
    out: &mut Formatter<'_>,
) -> Result {
    let value = show(step.value);
    let Some(keys) = &step.keys else {
        return writeln!(out, "    {name:<12}no keys: as in the rest pose  {value}");
    };
    writeln!(out, "    {name:<12}{}", method(keys))?;
    let mut line = |what: &str, key: &super::KeyStep<T>| -> Result {
        let (time, index) = (number(key.time), key.index);
        writeln!(out, "      {what:<7}key {index:>5} at {time} s        {}", show(key.value))?;
        match key.tangent {
            Some(tangent) => writeln!(out, "{:>37}tangent  {}", "", show(tangent)),
            None => Ok(()),
        }
    };
    line("before", &keys.before)?;
    if keys.after.index != keys.before.index {
        line("after", &keys.after)?;
    }
    writeln!(out, "      {:<7}{:<26}gives  {value}", "mix", keys.mix)
}

fn method<T>(keys: &KeysStep<T>) -> String {
    let method = match keys.interpolation {
        Interpolation::Step => "step (the last, preceding key)",
        Interpolation::Linear => "linear",
        Interpolation::CubicSpline => "cubic spline",
        Interpolation::Closest => "the closest key",
    };
    format!("{} keys, {method}", keys.count)
}

fn matrices(explanation: &Explanation, step: &BoneStep, out: &mut Formatter<'_>) -> Result {
    match step.parent {
        Some(parent) => {
            let name = explanation.bone(parent).map_or("", |parent| &parent.name);
            writeln!(out, "  To-root (§2.1.5.1) = to_root of bone {parent} {name:?} * to_parent")?;
        }
        None => writeln!(out, "  To-root (§2.1.5.1) = to_parent, because a root has no parent")?,
    }
    side_by_side(out, "to_parent", step.to_parent, "to_root", step.to_root)
}

fn vertex(explanation: &Explanation, vertex: &VertexResult, out: &mut Formatter<'_>) -> Result {
    writeln!(out, "\nThe vertex as stored (§2.1.2.1)")?;
    writeln!(out, "  position    {}", vector(vertex.position))?;
    if let Some(normal) = vertex.normal {
        writeln!(out, "  normal      {}", vector(normal))?;
    }
    morphs(vertex, out)?;
    match &vertex.movement {
        MovementStep::Skin { skin, influences } => {
            for influence in influences {
                final_of(explanation, influence, out)?;
            }
            writeln!(out, "\nSkin {skin}: contribution of each bone (§2.1.4)")?;
            for influence in influences {
                contribution(explanation, influence, out)?;
            }
            writeln!(out, "  {:<30}sum     {}", "", vector(vertex.final_position))?;
        }
        MovementStep::Rigid { bone, to_bone } => {
            let name = bone.map_or_else(|| "nothing (static)".to_owned(), |bone| named(explanation, bone));
            writeln!(out, "\nCarried by {name}: matrix = to_root * to_bone")?;
            side_by_side(out, "to_bone", *to_bone, "matrix", vertex.matrix)?;
        }
    }
    writeln!(out, "\nResult, scene space")?;
    writeln!(out, "  position    {}", vector(vertex.final_position))?;
    match vertex.final_normal {
        Some(normal) => writeln!(out, "  normal      {}", vector(normal)),
        None => Ok(()),
    }
}

fn morphs(vertex: &VertexResult, out: &mut Formatter<'_>) -> Result {
    if vertex.morphs.is_empty() {
        return Ok(());
    }
    writeln!(out, "\nMorph targets: weight * difference is added first")?;
    if let Some(keys) = vertex.morph_keys {
        let ((before, from), (after, to)) = (keys.before, keys.after);
        let mix = keys.mix;
        writeln!(out, "  weights between key {before} at {from} s and key {after} at {to} s, mix {mix}")?;
    }
    for morph in &vertex.morphs {
        let name = format!("{} {:?}", morph.target, morph.name);
        let adds = vector(morph.contribution);
        writeln!(out, "  {name:<20}{} *{}  = {adds}", number(morph.weight), vector(morph.difference))?;
    }
    writeln!(out, "  morphed position    {}", vector(vertex.morphed_position))
}

fn final_of(explanation: &Explanation, influence: &InfluenceStep, out: &mut Formatter<'_>) -> Result {
    let name = influence.bone.map_or_else(|| "no bone".to_owned(), |bone| named(explanation, bone));
    writeln!(out, "\nFinal pose of joint {}, {name} (§2.1.5.1) = to_root * offset", influence.joint)?;
    side_by_side(out, "offset", influence.offset, "final", influence.final_pose)
}

fn contribution(explanation: &Explanation, influence: &InfluenceStep, out: &mut Formatter<'_>) -> Result {
    let name = influence.bone.map_or_else(|| "no bone".to_owned(), |bone| named(explanation, bone));
    writeln!(out, "  joint {}, {name}", influence.joint)?;
    writeln!(out, "  {:<30}moved   {}", "  final * position", vector(influence.moved))?;
    let weight = format!("  * weight {}", number(influence.weight));
    writeln!(out, "  {weight:<30}adds    {}", vector(influence.contribution))
}

fn named(explanation: &Explanation, bone: BoneIndex) -> String {
    let name = explanation.bone(bone).map_or("", |step| &step.name);
    format!("bone {bone} {name:?}")
}

/// Writes two matrices with their names, row by row.
fn side_by_side(out: &mut Formatter<'_>, left: &str, a: Mat4, right: &str, b: Mat4) -> Result {
    writeln!(out, "    {left:<47}{right}")?;
    for row in 0..4 {
        let numbers = |matrix: Mat4| matrix.row(row).to_array().map(number).join("");
        writeln!(out, "    [{} ]    [{} ]", numbers(a), numbers(b))?;
    }
    Ok(())
}

fn vector(vector: Vec3) -> String {
    format!("({} )", vector.to_array().map(number).join(""))
}

/// Formats as `xyzw`.
fn rotation(rotation: Quat) -> String {
    format!("({} )", rotation.to_array().map(number).join(""))
}

/// Formats in ten characters, with the decimals that fit, and an exponent where none would.
fn number(number: f32) -> String {
    let size = number.abs();
    if number == 0.0 {
        format!("{:>10}", "0")
    } else if (0.001..1000.0).contains(&size) {
        format!("{number:>10.5}")
    } else if (1000.0..100_000.0).contains(&size) {
        format!("{number:>10.2}")
    } else {
        format!("{number:>10.2e}")
    }
}
