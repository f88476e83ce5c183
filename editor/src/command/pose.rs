//! `dragonfly pose FILE --time S`: prints the pose of every bone and vertex at a time.

use super::Failure;
use super::choice::{File, TakeChoice, clamp_time};
use super::info::named;
use super::output::{print, print_json};
use super::run_command::RunCommand;
use super::scene::{self, RolePoses, ScriptChoice};
use super::table::{Side, Table};
use super::time_argument::TimeArgument;
use dragonfly_anim::data::{ModelData, Transform};
use dragonfly_anim::evaluator::Evaluator;
use dragonfly_anim::joint::EulerOrder;
use glam::{Mat4, Vec3};
use serde::Serialize;
use std::io::{self, Write};
use std::sync::Arc;

/// Print poses: bone matrices, skinning matrices and skinned vertex positions at given times
#[derive(Clone, Debug, clap::Args)]
#[command(after_help = "\
Matrices are column-major, for column vectors. `to_root` is bone space to scene space, `final` bind space to\n\
scene space. The text shows positions, rotations and scales; --json contains everything in full precision.\n\n\
Examples:\n  dragonfly pose Fox.glb --take Run --time 0.35\n  \
dragonfly pose Fox.glb --time 0 --time 0.5 --time 1 --vertices 8 --json\n  \
dragonfly pose duel.xml --role anna --time 2.5 --json")]
pub(super) struct PoseArguments {
    #[command(flatten)]
    file: File,
    #[command(flatten)]
    take: TakeChoice,
    /// Time in seconds, clamped to the take; of a scene exactly as its script writes times, such as 36f; repeat for more poses
    #[arg(long, value_name = "S", required = true, allow_hyphen_values = true)]
    time: Vec<TimeArgument>,
    /// Role, prop or another thing of a scene, by its id; FILE is a scene (.xml) or a project (.meproj)
    #[arg(long, value_name = "ID", conflicts_with_all = ["take", "vertices"])]
    role: Option<String>,
    #[command(flatten)]
    script: ScriptChoice,
    /// Number of vertex positions per primitive [default: all in JSON, none in text]
    #[arg(long, value_name = "N")]
    vertices: Option<usize>,
    /// Print one JSON document instead of text
    #[arg(long)]
    json: bool,
}

impl RunCommand for PoseArguments {
    fn run(self) -> Result<(), Failure> {
        if let Some(role) = &self.role {
            return self.role(role);
        }
        let loaded = self.file.load()?;
        let take = self.take.index(&loaded.title, &loaded.model)?;
        let model = Arc::new(loaded.model);
        let vertices = self.vertices.unwrap_or(if self.json { usize::MAX } else { 0 });
        let mut evaluator = Evaluator::new(Arc::clone(&model));
        let positions = positions(&evaluator, vertices).saturating_mul(self.time.len());
        if positions > MOST_POSITIONS {
            let reason = format_args!(
                "{positions} vertex positions are more than {MOST_POSITIONS}; print fewer with --vertices"
            );
            return Err(Failure::input(&loaded.title, reason));
        }
        let mut poses = Vec::with_capacity(self.time.len());
        for time in &self.time {
            let time = clamp_time(&model, take, time.of_take()?);
            evaluator.pose(take, time);
            let pose = PoseRow::of(&evaluator, time, vertices);
            // JSON cannot represent infinity or NaN.
            if !pose.is_finite() {
                let reason =
                    format_args!("the pose at {time} s exceeds the range of single-precision numbers");
                return Err(Failure::input(&loaded.title, reason));
            }
            poses.push(pose);
        }
        let take = take.map(|index| TakeName { index, name: model.animation.takes[index].name.clone() });
        let poses = Poses { file: loaded.title, take, poses };
        if self.json { print_json(&poses) } else { print(|out| poses.write(&model, out)) }
    }
}

impl PoseArguments {
    /// Prints the poses of a thing of a scene.
    fn role(&self, role: &str) -> Result<(), Failure> {
        let Some(script) = self.file.scene(&self.take)? else {
            return Err(Failure::input("--role", "FILE has to be a scene (.xml) or a project (.meproj)"));
        };
        let poses = RolePoses::of(&scene::load(script, &self.script)?, role, &self.time)?;
        if self.json { print_json(&poses) } else { print(|out| poses.write(out)) }
    }
}

/// Largest number of vertex positions of one command.
const MOST_POSITIONS: usize = 20_000_000;

/// Returns the number of positions in a pose with at most `vertices` per primitive.
fn positions(evaluator: &Evaluator, vertices: usize) -> usize {
    let of_instance = |index| {
        let primitives = evaluator.primitives(index).iter();
        primitives.map(|primitive| primitive.vertices.len().min(vertices)).sum::<usize>()
    };
    (0..evaluator.model().instances.len()).map(of_instance).sum()
}

#[derive(Serialize)]
struct Poses {
    file: String,
    take: Option<TakeName>,
    poses: Vec<PoseRow>,
}

#[derive(Serialize)]
struct TakeName {
    index: usize,
    name: String,
}

#[derive(Serialize)]
struct PoseRow {
    time: f32,
    bones: Vec<BonePoseRow>,
    skins: Vec<SkinPoseRow>,
    meshes: Vec<MeshPoseRow>,
}

#[derive(Serialize)]
struct BonePoseRow {
    name: String,
    node: Option<u32>,
    to_root: [f32; 16],
}

#[derive(Serialize)]
struct SkinPoseRow {
    index: usize,
    r#final: Vec<[f32; 16]>,
}

#[derive(Serialize)]
struct MeshPoseRow {
    node: Option<u32>,
    primitive: usize,
    positions: Vec<[f32; 3]>,
}

impl PoseRow {
    /// Returns the current pose of `evaluator`, with at most `vertices` positions per primitive.
    fn of(evaluator: &Evaluator, time: f32, vertices: usize) -> Self {
        let model = evaluator.model();
        let bones = model.animation.skeleton.bones.iter().zip(evaluator.to_root());
        let bones = bones.map(|(bone, to_root)| BonePoseRow {
            name: bone.name.clone(),
            node: bone.node,
            to_root: to_root.to_cols_array(),
        });
        let skins = (0..model.skins.len()).map(|index| SkinPoseRow {
            index,
            r#final: evaluator.final_poses(index).iter().map(Mat4::to_cols_array).collect(),
        });
        let meshes = model.instances.iter().enumerate().flat_map(|(index, instance)| {
            evaluator.primitives(index).iter().enumerate().map(move |(primitive, data)| {
                let mut positions = vec![Vec3::ZERO; data.vertices.len().min(vertices)];
                evaluator.positions(index, primitive, &mut positions);
                let positions = positions.iter().map(|position| position.to_array()).collect();
                MeshPoseRow { node: instance.node, primitive, positions }
            })
        });
        Self { time, bones: bones.collect(), skins: skins.collect(), meshes: meshes.collect() }
    }

    fn is_finite(&self) -> bool {
        let finite = |numbers: &[f32]| numbers.iter().all(|number| number.is_finite());
        self.bones.iter().all(|bone| finite(&bone.to_root))
            && self.skins.iter().flat_map(|skin| &skin.r#final).all(|matrix| finite(matrix))
            && self.meshes.iter().flat_map(|mesh| &mesh.positions).all(|position| finite(position))
    }
}

impl Poses {
    fn write(&self, model: &ModelData, out: &mut dyn Write) -> io::Result<()> {
        let take = self.take.as_ref().map_or_else(
            || "no takes: the rest pose".to_owned(),
            |take| format!("take {} {}", take.index, named(&take.name)),
        );
        writeln!(out, "{}, {take}", super::choice::plain(&self.file))?;
        for pose in &self.poses {
            writeln!(out, "\n{} s", pose.time)?;
            pose.write_bones(out)?;
            for mesh in pose.meshes.iter().filter(|mesh| !mesh.positions.is_empty()) {
                mesh.write(model, out)?;
            }
        }
        Ok(())
    }
}

impl PoseRow {
    fn write_bones(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut table = Table::new(&[
            ("bone", Side::Left),
            ("x", Side::Right),
            ("y", Side::Right),
            ("z", Side::Right),
            ("rotation x", Side::Right),
            ("y", Side::Right),
            ("z", Side::Right),
            ("scale x", Side::Right),
            ("y", Side::Right),
            ("z", Side::Right),
        ]);
        for bone in &self.bones {
            let pose = Transform::from_matrix(Mat4::from_cols_array(&bone.to_root));
            let numbers = pose.translation.to_array().map(|length| fixed(length, 4));
            let angles = EulerOrder::Xyz
                .angles(pose.rotation.as_dquat())
                .map(|angle| fixed(angle.to_degrees() as f32, 2) + "°");
            let scales = pose.scale.to_array().map(|factor| fixed(factor, 3));
            table.row(std::iter::once(named(&bone.name)).chain(numbers).chain(angles).chain(scales));
        }
        table.write(out)
    }
}

impl MeshPoseRow {
    fn write(&self, model: &ModelData, out: &mut dyn Write) -> io::Result<()> {
        let instance = model.instances.iter().find(|instance| instance.node == self.node);
        let mesh = instance.and_then(|instance| model.meshes.get(instance.mesh as usize));
        let name = mesh.map_or_else(|| named(""), |mesh| named(&mesh.name));
        writeln!(out, "  {name}, primitive {}", self.primitive)?;
        let mut table = Table::new(&[
            ("vertex", Side::Right),
            ("x", Side::Right),
            ("y", Side::Right),
            ("z", Side::Right),
        ]);
        for (index, position) in self.positions.iter().enumerate() {
            let numbers = position.map(|number| fixed(number, 4));
            table.row(std::iter::once(index.to_string()).chain(numbers));
        }
        table.write(out)
    }
}

/// Formats a number with `digits` decimals; zero has no sign.
fn fixed(number: f32, digits: usize) -> String {
    let text = format!("{number:.digits$}");
    let zero = text.bytes().all(|byte| matches!(byte, b'-' | b'0' | b'.'));
    if zero { text.trim_start_matches('-').to_owned() } else { text }
}
