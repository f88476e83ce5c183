//! An explanation as JSON. Bones, takes and nodes are identified by the indices that `dragonfly
//! info --json` lists.

use dragonfly_anim::data::{Interpolation, ModelData};
use dragonfly_anim::explain::{BoneStep, ChannelStep, Explanation, MovementStep, Subject, VertexResult};
use dragonfly_document::LoadedModel;
use glam::{Mat4, Quat, Vec3};
use serde::Serialize;

#[derive(Serialize)]
pub(super) struct ExplainedDocument {
    file: String,
    take: Option<ExplainedTake>,
    time: f32,
    bones: Vec<ExplainedBone>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bone: Option<ExplainedBoneEnd>,
    #[serde(skip_serializing_if = "Option::is_none")]
    vertex: Option<ExplainedVertex>,
}

#[derive(Serialize)]
struct ExplainedTake {
    index: usize,
    name: String,
    start: f32,
    end: f32,
}

#[derive(Serialize)]
struct ExplainedBone {
    index: u32,
    name: String,
    node: Option<u32>,
    parent: Option<u32>,
    translation: ExplainedChannel,
    rotation: ExplainedChannel,
    scale: ExplainedChannel,
    to_parent: [f32; 16],
    to_root: [f32; 16],
}

#[derive(Serialize)]
struct ExplainedChannel {
    rest: Vec<f32>,
    keys: Option<ExplainedKeys>,
    value: Vec<f32>,
}

#[derive(Serialize)]
struct ExplainedKeys {
    count: usize,
    interpolation: &'static str,
    before: ExplainedKey,
    after: ExplainedKey,
    mix: f32,
}

#[derive(Serialize)]
struct ExplainedKey {
    index: usize,
    time: f32,
    value: Vec<f32>,
    tangent: Option<Vec<f32>>,
}

#[derive(Serialize)]
struct ExplainedBoneEnd {
    index: u32,
    offset: [f32; 16],
    r#final: [f32; 16],
}

#[derive(Serialize)]
struct ExplainedVertex {
    instance: u32,
    node: Option<u32>,
    mesh: String,
    primitive: u32,
    index: u32,
    position: [f32; 3],
    normal: Option<[f32; 3]>,
    morph_keys: Option<ExplainedMorphKeys>,
    morphs: Vec<ExplainedMorph>,
    morphed_position: [f32; 3],
    morphed_normal: Option<[f32; 3]>,
    skin: Option<u32>,
    influences: Vec<ExplainedInfluence>,
    carrier: Option<u32>,
    to_bone: Option<[f32; 16]>,
    matrix: [f32; 16],
    normal_matrix: [f32; 9],
    final_position: [f32; 3],
    final_normal: Option<[f32; 3]>,
}

#[derive(Serialize)]
struct ExplainedMorphKeys {
    count: usize,
    interpolation: &'static str,
    before: ExplainedMorphKey,
    after: ExplainedMorphKey,
    mix: f32,
}

#[derive(Serialize)]
struct ExplainedMorphKey {
    index: usize,
    time: f32,
}

#[derive(Serialize)]
struct ExplainedMorph {
    target: usize,
    name: String,
    weight: f32,
    difference: [f32; 3],
    contribution: [f32; 3],
}

#[derive(Serialize)]
struct ExplainedInfluence {
    joint: u16,
    bone: Option<u32>,
    weight: f32,
    offset: [f32; 16],
    r#final: [f32; 16],
    moved: [f32; 3],
    contribution: [f32; 3],
}

impl ExplainedDocument {
    pub(super) fn of(loaded: &LoadedModel, explanation: &Explanation) -> Self {
        let model = &loaded.model;
        let (bone, vertex) = match &explanation.subject {
            Subject::Bone(bone) => {
                let (index, offset) = (bone.bone, bone.offset.to_cols_array());
                (Some(ExplainedBoneEnd { index, offset, r#final: bone.final_pose.to_cols_array() }), None)
            }
            Subject::Vertex(vertex) => (None, Some(ExplainedVertex::of(model, vertex))),
        };
        let take = explanation.take.as_ref().map(|take| ExplainedTake {
            index: take.index,
            name: take.name.clone(),
            start: take.start,
            end: take.end,
        });
        Self {
            file: loaded.title.clone(),
            take,
            time: explanation.time,
            bones: explanation.bones.iter().map(|step| ExplainedBone::of(model, step)).collect(),
            bone,
            vertex,
        }
    }

    pub(super) fn is_finite(&self) -> bool {
        self.bones.iter().all(ExplainedBone::is_finite)
            && self.bone.as_ref().is_none_or(|bone| finite_all(&bone.offset) && finite_all(&bone.r#final))
            && self.vertex.as_ref().is_none_or(ExplainedVertex::is_finite)
    }
}

impl ExplainedBone {
    fn of(model: &ModelData, step: &BoneStep) -> Self {
        let bone = model.animation.skeleton.bones.get(step.bone as usize);
        Self {
            index: step.bone,
            name: step.name.clone(),
            node: bone.and_then(|bone| bone.node),
            parent: step.parent,
            translation: channel(&step.translation, |value: Vec3| value.to_array().to_vec()),
            rotation: channel(&step.rotation, |value: Quat| value.to_array().to_vec()),
            scale: channel(&step.scale, |value: Vec3| value.to_array().to_vec()),
            to_parent: step.to_parent.to_cols_array(),
            to_root: step.to_root.to_cols_array(),
        }
    }

    fn is_finite(&self) -> bool {
        let channels = [&self.translation, &self.rotation, &self.scale];
        channels.into_iter().all(ExplainedChannel::is_finite)
            && finite_all(&self.to_parent)
            && finite_all(&self.to_root)
    }
}

impl ExplainedChannel {
    fn is_finite(&self) -> bool {
        let key = |key: &ExplainedKey| {
            key.time.is_finite() && finite_all(&key.value) && key.tangent.as_deref().is_none_or(finite_all)
        };
        finite_all(&self.rest)
            && finite_all(&self.value)
            && self.keys.as_ref().is_none_or(|keys| key(&keys.before) && key(&keys.after))
    }
}

fn finite_all(numbers: &[f32]) -> bool {
    numbers.iter().all(|number| number.is_finite())
}

fn method(interpolation: Interpolation) -> &'static str {
    match interpolation {
        Interpolation::Step => "step",
        Interpolation::Linear => "linear",
        Interpolation::CubicSpline => "cubic spline",
        Interpolation::Closest => "closest",
    }
}

fn channel<T: Copy>(step: &ChannelStep<T>, numbers: impl Fn(T) -> Vec<f32>) -> ExplainedChannel {
    let key = |key: &dragonfly_anim::explain::KeyStep<T>| ExplainedKey {
        index: key.index,
        time: key.time,
        value: numbers(key.value),
        tangent: key.tangent.map(&numbers),
    };
    let keys = step.keys.as_ref().map(|keys| ExplainedKeys {
        count: keys.count,
        interpolation: method(keys.interpolation),
        before: key(&keys.before),
        after: key(&keys.after),
        mix: keys.mix,
    });
    ExplainedChannel { rest: numbers(step.rest), keys, value: numbers(step.value) }
}

impl ExplainedVertex {
    fn of(model: &ModelData, vertex: &VertexResult) -> Self {
        let (skin, influences, carrier, to_bone) = match &vertex.movement {
            MovementStep::Skin { skin, influences } => (Some(*skin), &influences[..], None, None),
            MovementStep::Rigid { bone, to_bone } => (None, &[][..], *bone, Some(to_bone)),
        };
        let array = |vector: Vec3| vector.to_array();
        let instance = model.instances.get(vertex.instance as usize);
        Self {
            instance: vertex.instance,
            node: instance.and_then(|instance| instance.node),
            mesh: vertex.mesh.clone(),
            primitive: vertex.primitive,
            index: vertex.vertex,
            position: array(vertex.position),
            normal: vertex.normal.map(array),
            morph_keys: vertex.morph_keys.map(ExplainedMorphKeys::of),
            morphs: vertex.morphs.iter().map(ExplainedMorph::of).collect(),
            morphed_position: array(vertex.morphed_position),
            morphed_normal: vertex.morphed_normal.map(array),
            skin,
            influences: influences.iter().map(ExplainedInfluence::of).collect(),
            carrier,
            to_bone: to_bone.map(Mat4::to_cols_array),
            matrix: vertex.matrix.to_cols_array(),
            normal_matrix: vertex.normal_matrix.to_cols_array(),
            final_position: array(vertex.final_position),
            final_normal: vertex.final_normal.map(array),
        }
    }
}

impl ExplainedVertex {
    fn is_finite(&self) -> bool {
        let vectors = [Some(self.position), self.normal, Some(self.morphed_position), self.morphed_normal];
        let results = [Some(self.final_position), self.final_normal];
        let morph = |morph: &ExplainedMorph| {
            morph.weight.is_finite() && finite_all(&morph.difference) && finite_all(&morph.contribution)
        };
        let influence = |influence: &ExplainedInfluence| {
            influence.weight.is_finite()
                && finite_all(&influence.offset)
                && finite_all(&influence.r#final)
                && finite_all(&influence.moved)
                && finite_all(&influence.contribution)
        };
        vectors.iter().chain(&results).flatten().all(|vector| finite_all(vector))
            && self.morphs.iter().all(morph)
            && self.influences.iter().all(influence)
            && self.to_bone.as_ref().is_none_or(|matrix| finite_all(matrix))
            && finite_all(&self.matrix)
            && finite_all(&self.normal_matrix)
    }
}

impl ExplainedMorphKeys {
    fn of(keys: dragonfly_anim::explain::MorphKeys) -> Self {
        let key = |(index, time): (usize, f32)| ExplainedMorphKey { index, time };
        Self {
            count: keys.count,
            interpolation: method(keys.interpolation),
            before: key(keys.before),
            after: key(keys.after),
            mix: keys.mix,
        }
    }
}

impl ExplainedMorph {
    fn of(step: &dragonfly_anim::explain::MorphStep) -> Self {
        Self {
            target: step.target,
            name: step.name.clone(),
            weight: step.weight,
            difference: step.difference.to_array(),
            contribution: step.contribution.to_array(),
        }
    }
}

impl ExplainedInfluence {
    fn of(step: &dragonfly_anim::explain::InfluenceStep) -> Self {
        Self {
            joint: step.joint,
            bone: step.bone,
            weight: step.weight,
            offset: step.offset.to_cols_array(),
            r#final: step.final_pose.to_cols_array(),
            moved: step.moved.to_array(),
            contribution: step.contribution.to_array(),
        }
    }
}
