//! `dragonfly explain FILE --time S --bone NAME`: every value on the way from keys to a bone or a vertex.

use super::choice::{File, TakeChoice, clamp_time, finite, plain};
use super::output::{print, print_json};
use super::{Command, Failure};
use dragonfly_anim::data::{BoneIndex, Interpolation, ModelData};
use dragonfly_anim::explain::{
    BoneStep, ChannelStep, Explanation, MovementStep, Subject, VertexResult, What, explain,
};
use glam::{Mat4, Quat, Vec3};
use serde::Serialize;

/// Every value on the way from keys to a bone or a vertex, with the formula of each step
#[derive(Clone, Debug, clap::Args)]
#[command(
    group = clap::ArgGroup::new("what").required(true),
    after_help = "\
The keys that were chosen and how they were mixed, the pose relative to the parent, the way up to the root, the\n\
final pose; for a vertex, what each bone adds. Matrices are for column vectors; --json has them column-major.\n\n\
Examples:\n  dragonfly explain Fox.glb --take Run --time 0.35 --bone b_Head_05\n  \
dragonfly explain demo: --time 0.4 --vertex 12"
)]
pub(super) struct Arguments {
    #[command(flatten)]
    file: File,
    #[command(flatten)]
    take: TakeChoice,
    /// Seconds, clamped to the take
    #[arg(long, value_name = "S", value_parser = finite, allow_negative_numbers = true)]
    time: f32,
    /// Which bone, by name or by number from 0; a name wins over a number
    #[arg(long, value_name = "BONE", group = "what", allow_hyphen_values = true)]
    bone: Option<String>,
    /// Which vertex of the primitive, by number from 0
    #[arg(long, value_name = "N", group = "what")]
    vertex: Option<u32>,
    /// Which placed mesh, by number from 0
    #[arg(long, value_name = "I", default_value_t = 0, conflicts_with = "bone")]
    instance: u32,
    /// Which primitive of the mesh, by number from 0
    #[arg(long, value_name = "P", default_value_t = 0, conflicts_with = "bone")]
    primitive: u32,
    /// One JSON document instead of text
    #[arg(long)]
    json: bool,
}

impl Command for Arguments {
    fn run(self) -> Result<(), Failure> {
        let loaded = self.file.load()?;
        let take = self.take.index(&loaded.title, &loaded.model)?;
        let what = self.what(&loaded.title, &loaded.model)?;
        let time = clamp_time(&loaded.model, take, self.time);
        let explanation =
            explain(&loaded.model, take, time, what).map_err(|error| Failure::input(&loaded.title, error))?;
        if self.json {
            print_json(&Document::of(&loaded.title, &explanation))
        } else {
            print(|out| write!(out, "{}\n{explanation}", plain(&loaded.title)))
        }
    }
}

impl Arguments {
    fn what(&self, title: &str, model: &ModelData) -> Result<What, Failure> {
        let Some(wanted) = &self.bone else {
            let vertex = self.vertex.unwrap_or_default();
            return Ok(What::Vertex { instance: self.instance, primitive: self.primitive, vertex });
        };
        let skeleton = &model.animation.skeleton;
        let by_number = || wanted.parse().ok().filter(|&bone: &BoneIndex| (bone as usize) < skeleton.len());
        skeleton.find(wanted).or_else(by_number).map(What::Bone).ok_or_else(|| {
            let reason = format!(
                "--bone: no bone is called \"{}\"; there are {} (`dragonfly info` lists them)",
                plain(wanted),
                skeleton.len()
            );
            Failure::input(title, reason)
        })
    }
}

#[derive(Serialize)]
struct Document {
    file: String,
    take: Option<Take>,
    time: f32,
    bones: Vec<Bone>,
    #[serde(skip_serializing_if = "Option::is_none")]
    bone: Option<BoneEnd>,
    #[serde(skip_serializing_if = "Option::is_none")]
    vertex: Option<Vertex>,
}

#[derive(Serialize)]
struct Take {
    index: usize,
    name: String,
}

#[derive(Serialize)]
struct Bone {
    index: u32,
    name: String,
    parent: Option<u32>,
    translation: Channel,
    rotation: Channel,
    scale: Channel,
    to_parent: [f32; 16],
    to_root: [f32; 16],
}

#[derive(Serialize)]
struct Channel {
    rest: Vec<f32>,
    keys: Option<Keys>,
    value: Vec<f32>,
}

#[derive(Serialize)]
struct Keys {
    count: usize,
    interpolation: &'static str,
    before: Key,
    after: Key,
    mix: f32,
}

#[derive(Serialize)]
struct Key {
    index: usize,
    time: f32,
    value: Vec<f32>,
    tangent: Option<Vec<f32>>,
}

#[derive(Serialize)]
struct BoneEnd {
    index: u32,
    offset: [f32; 16],
    r#final: [f32; 16],
}

#[derive(Serialize)]
struct Vertex {
    instance: u32,
    primitive: u32,
    index: u32,
    position: [f32; 3],
    normal: Option<[f32; 3]>,
    morphs: Vec<Morph>,
    morphed_position: [f32; 3],
    skin: Option<u32>,
    influences: Vec<Influence>,
    carrier: Option<u32>,
    to_bone: Option<[f32; 16]>,
    matrix: [f32; 16],
    final_position: [f32; 3],
    final_normal: Option<[f32; 3]>,
}

#[derive(Serialize)]
struct Morph {
    target: usize,
    name: String,
    weight: f32,
    difference: [f32; 3],
    contribution: [f32; 3],
}

#[derive(Serialize)]
struct Influence {
    joint: u16,
    bone: Option<u32>,
    weight: f32,
    offset: [f32; 16],
    r#final: [f32; 16],
    moved: [f32; 3],
    contribution: [f32; 3],
}

impl Document {
    fn of(title: &str, explanation: &Explanation) -> Self {
        let (bone, vertex) = match &explanation.subject {
            Subject::Bone(bone) => {
                let (index, offset) = (bone.bone, bone.offset.to_cols_array());
                (Some(BoneEnd { index, offset, r#final: bone.final_pose.to_cols_array() }), None)
            }
            Subject::Vertex(vertex) => (None, Some(Vertex::of(vertex))),
        };
        let take = explanation.take.as_ref();
        Self {
            file: title.to_owned(),
            take: take.map(|take| Take { index: take.index, name: take.name.clone() }),
            time: explanation.time,
            bones: explanation.bones.iter().map(Bone::of).collect(),
            bone,
            vertex,
        }
    }
}

impl Bone {
    fn of(step: &BoneStep) -> Self {
        Self {
            index: step.bone,
            name: step.name.clone(),
            parent: step.parent,
            translation: channel(&step.translation, |value: Vec3| value.to_array().to_vec()),
            rotation: channel(&step.rotation, |value: Quat| value.to_array().to_vec()),
            scale: channel(&step.scale, |value: Vec3| value.to_array().to_vec()),
            to_parent: step.to_parent.to_cols_array(),
            to_root: step.to_root.to_cols_array(),
        }
    }
}

fn channel<T: Copy>(step: &ChannelStep<T>, numbers: impl Fn(T) -> Vec<f32>) -> Channel {
    let key = |key: &dragonfly_anim::explain::KeyStep<T>| Key {
        index: key.index,
        time: key.time,
        value: numbers(key.value),
        tangent: key.tangent.map(&numbers),
    };
    let keys = step.keys.as_ref().map(|keys| Keys {
        count: keys.count,
        interpolation: match keys.interpolation {
            Interpolation::Step => "step",
            Interpolation::Linear => "linear",
            Interpolation::CubicSpline => "cubic spline",
            Interpolation::Closest => "closest",
        },
        before: key(&keys.before),
        after: key(&keys.after),
        mix: keys.mix,
    });
    Channel { rest: numbers(step.rest), keys, value: numbers(step.value) }
}

impl Vertex {
    fn of(vertex: &VertexResult) -> Self {
        let (skin, influences, carrier, to_bone) = match &vertex.movement {
            MovementStep::Skin { skin, influences } => (Some(*skin), &influences[..], None, None),
            MovementStep::Rigid { bone, to_bone } => (None, &[][..], *bone, Some(to_bone)),
        };
        let array = |vector: Vec3| vector.to_array();
        Self {
            instance: vertex.instance,
            primitive: vertex.primitive,
            index: vertex.vertex,
            position: array(vertex.position),
            normal: vertex.normal.map(array),
            morphs: vertex.morphs.iter().map(Morph::of).collect(),
            morphed_position: array(vertex.morphed_position),
            skin,
            influences: influences.iter().map(Influence::of).collect(),
            carrier,
            to_bone: to_bone.map(Mat4::to_cols_array),
            matrix: vertex.matrix.to_cols_array(),
            final_position: array(vertex.final_position),
            final_normal: vertex.final_normal.map(array),
        }
    }
}

impl Morph {
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

impl Influence {
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
