//! Invariants of every imported model, whatever the file contains: indices in range, columns of one length, finite
//! numbers.

use dragonfly_anim::data::{Channel, Interpolation, ModelData, Primitive, Take, Vertices};
use dragonfly_anim::evaluator::Evaluator;
use glam::Mat4;
use std::sync::Arc;

/// Returns everything that is wrong with `model`; empty if it is sound.
pub(crate) fn faults(model: &ModelData) -> Vec<String> {
    let mut faults = Vec::new();
    let mut check = |holds: bool, what: &str| {
        if !holds && faults.len() < 20 {
            faults.push(what.to_owned());
        }
    };
    let bones = &model.animation.skeleton.bones;
    for (index, bone) in bones.iter().enumerate() {
        check(bone.parent.is_none_or(|parent| (parent as usize) < index), "a parent comes before its child");
        check(bone.rest.is_finite() && bone.offset.is_finite(), "a bone is finite");
        check((bone.rest.rotation.length() - 1.0).abs() < 1e-5, "a rest rotation is normalized");
        check(bone.rest_matrix.is_none_or(|matrix| matrix.is_finite()), "a rest matrix is finite");
    }
    let is_bone = |bone: u32| (bone as usize) < bones.len();
    check(model.avatar.bones.iter().all(|human| is_bone(human.bone)), "a part of the body is a bone");
    for expression in &model.avatar.expressions {
        check(expression.weight_bone.is_none_or(is_bone), "the weight of an expression is that of a bone");
        for bind in &expression.binds {
            let instance = model.instances.get(bind.instance as usize);
            let targets = instance.map_or(0, |instance| instance.morph_weights.len());
            check(
                (bind.target as usize) < targets && bind.weight.is_finite(),
                "an expression sets a morph target",
            );
        }
    }
    for skin in &model.skins {
        check(skin.bones.len() == skin.offsets.len() && !skin.bones.is_empty(), "a joint has an offset");
        check(skin.bones.iter().all(|&bone| (bone as usize) < bones.len()), "a joint is a bone");
        check(skin.offsets.iter().all(Mat4::is_finite), "an offset is finite");
    }
    for material in &model.materials {
        let textures = [
            material.base_color_texture,
            material.metallic_roughness_texture,
            material.normal_texture,
            material.occlusion_texture,
            material.emissive_texture,
        ];
        for texture in textures.into_iter().flatten() {
            check(
                (texture.image as usize) < model.images.len() && texture.set < 2,
                "a texture has an existing image",
            );
            check(texture.transform.to_matrix().is_finite(), "a texture transform is finite");
        }
        let numbers = [
            material.base_color.is_finite(),
            material.emissive.is_finite(),
            material.phong.specular_power.is_finite(),
            material.phong.diffuse.is_finite(),
            material.normal_scale.is_finite(),
        ];
        check(numbers.iter().all(|&finite| finite), "a material is finite");
    }
    for mesh in &model.meshes {
        for primitive in &mesh.primitives {
            check_primitive(primitive, mesh.morph_weights.len(), model.materials.len(), &mut check);
        }
    }
    for instance in &model.instances {
        let mesh = model.meshes.get(instance.mesh as usize);
        check(mesh.is_some(), "an instance has an existing mesh");
        check(
            instance.bone.is_none_or(|bone| (bone as usize) < bones.len()),
            "an instance has an existing bone",
        );
        check(instance.to_bone.is_finite(), "an instance is finite");
        check(instance.morph_weights.iter().all(|weight| weight.is_finite()), "a weight is finite");
        let Some(mesh) = mesh else { continue };
        check(instance.morph_weights.len() == mesh.morph_weights.len(), "as many weights as targets");
        let Some(skin) = instance.skin else { continue };
        let Some(skin) = model.skins.get(skin as usize) else {
            check(false, "an instance has an existing skin");
            continue;
        };
        let influences = mesh.primitives.iter().flat_map(|primitive| &primitive.vertices.influences);
        check(
            influences.into_iter().all(|i| usize::from(i.joint) < skin.bones.len()),
            "an influence has an existing joint",
        );
    }
    for take in &model.animation.takes {
        check_take(take, model, &mut check);
    }
    faults
}

fn check_primitive(
    primitive: &Primitive,
    targets: usize,
    materials: usize,
    check: &mut impl FnMut(bool, &str),
) {
    let Vertices {
        positions,
        normals,
        tangents,
        texture_coordinates,
        colors,
        influences,
        influences_per_vertex,
    } = &primitive.vertices;
    let count = positions.len();
    let fits = |length: usize| length == 0 || length == count;
    check(normals.len() == count, "every vertex has a normal");
    check(fits(tangents.len()) && fits(colors.len()), "columns have one length");
    check(texture_coordinates.iter().all(|set| fits(set.len())), "columns have one length");
    check(influences.len() == count * influences_per_vertex, "influences have one length");
    check(matches!(influences_per_vertex, 0 | 4 | 8), "4 or 8 influences");
    check(positions.iter().all(|p| p.is_finite()), "a position is finite");
    check(normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-4), "a normal is normalized");
    check(tangents.iter().all(|t| t.is_finite() && t.w.abs() == 1.0), "a tangent is finite");
    check(colors.iter().all(|c| c.is_finite()), "a color is finite");
    for vertex in 0..if influences.is_empty() { 0 } else { count } {
        let of = primitive.vertices.influences_of(vertex);
        let sum: f32 = of.iter().map(|influence| influence.weight).sum();
        check((sum - 1.0).abs() < 1e-5, "weights add up to one");
        check(
            of.windows(2).all(|pair| pair[0].weight >= pair[1].weight),
            "the strongest influence comes first",
        );
    }
    check(primitive.indices.len().is_multiple_of(3), "whole triangles");
    check(primitive.indices.iter().all(|&index| (index as usize) < count), "an index is that of a vertex");
    check(primitive.material.is_none_or(|material| (material as usize) < materials), "a material exists");
    check(primitive.morph_targets.len() == targets, "as many targets as the mesh has");
    for target in &primitive.morph_targets {
        for column in [&target.positions, &target.normals, &target.tangents] {
            check(fits(column.len()) && column.iter().all(|d| d.is_finite()), "a morph target fits");
        }
    }
}

fn check_take(take: &Take, model: &ModelData, check: &mut impl FnMut(bool, &str)) {
    check(take.tracks.len() == model.animation.skeleton.len(), "one track per bone");
    check(take.start.is_finite() && take.length.is_finite() && take.length >= 0.0, "a take has a length");
    for (index, track) in take.tracks.iter().enumerate() {
        check(track.bone as usize == index, "tracks are in bone order");
        check_channel(&track.translation, |value| value.is_finite(), check);
        check_channel(&track.rotation, |value| value.is_finite(), check);
        check_channel(&track.scale, |value| value.is_finite(), check);
        let rotations = (0..track.rotation.len()).filter_map(|key| track.rotation.value(key));
        check(
            rotations.into_iter().all(|key| (key.length() - 1.0).abs() < 1e-5),
            "a rotation key is normalized",
        );
    }
    for morph in &take.morphs {
        let per_key = if morph.interpolation == Interpolation::CubicSpline { 3 } else { 1 };
        check(
            morph.weights.len() == morph.times.len() * per_key * morph.targets as usize,
            "weights for each key",
        );
        check(morph.weights.iter().all(|weight| weight.is_finite()), "a weight is finite");
        check(morph.times.windows(2).all(|pair| pair[0] < pair[1]), "key times increase");
        let instance = model.instances.get(morph.instance as usize);
        check(
            instance.is_some_and(|i| i.morph_weights.len() == morph.targets as usize),
            "a morph track fits",
        );
    }
}

fn check_channel<T: Copy>(
    channel: &Channel<T>,
    finite: impl Fn(&T) -> bool,
    check: &mut impl FnMut(bool, &str),
) {
    check(channel.times.len() * channel.values_per_key() == channel.values.len(), "values for each key");
    check(channel.times.windows(2).all(|pair| pair[0] < pair[1]), "key times increase");
    check(
        channel.times.iter().all(|time| time.is_finite()) && channel.values.iter().all(finite),
        "keys are finite",
    );
}

/// Evaluates the rest pose and the start, middle and end of the first take; returns what is wrong with the poses.
pub(crate) fn faults_of_poses(model: ModelData) -> Vec<String> {
    let times =
        model.animation.takes.first().map(|take| [take.start, take.start + take.length / 2.0, take.end()]);
    let mut evaluator = Evaluator::new(Arc::new(model));
    let mut faults = Vec::new();
    let poses = times.into_iter().flatten().map(|time| (Some(0), time)).chain([(None, 0.0)]);
    for (take, time) in poses {
        evaluator.pose(take, time);
        let skins = 0..evaluator.model().skins.len();
        let finite = evaluator.to_root().iter().all(Mat4::is_finite)
            && skins.into_iter().all(|skin| evaluator.final_poses(skin).iter().all(Mat4::is_finite))
            && evaluator.all_positions().iter().all(|position| position.is_finite());
        if !finite {
            faults.push(format!("the pose of {take:?} at {time} is not finite"));
        }
    }
    faults
}
