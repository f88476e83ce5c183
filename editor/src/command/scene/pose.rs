//! Poses of a thing of a scene at given times: `dragonfly pose SCENE.xml --role ID --time S`.

use crate::command::Failure;
use crate::command::time_argument::TimeArgument;
use dragonfly_anim::fast::matrix::mat4;
use dragonfly_anim::stage::{StageModel, ThingPose};
use dragonfly_document::{LoadedScene, ModelShapes, ShapeMesh};
use serde::Serialize;
use std::io::{self, Write};

/// Poses of one thing.
#[derive(Serialize)]
pub(in crate::command) struct RolePoses {
    file: String,
    role: String,
    kind: &'static str,
    poses: Vec<RolePoseRow>,
}

/// A thing at one time.
#[derive(Serialize)]
struct RolePoseRow {
    /// Seconds.
    time: f64,
    /// Meters.
    translation: [f32; 3],
    /// Quaternion x y z w.
    rotation: [f32; 4],
    scale: [f32; 3],
    bones: Vec<SceneBoneRow>,
    /// Empty without shape keys.
    shapes: Vec<SceneShapeRow>,
}

/// A bone in the scene.
#[derive(Serialize)]
struct SceneBoneRow {
    name: String,
    /// Bone space → the scene, column-major.
    to_scene: [f32; 16],
}

/// The weight of a shape key.
#[derive(Serialize)]
struct SceneShapeRow {
    mesh: String,
    shape: String,
    weight: f32,
}

impl SceneShapeRow {
    /// Returns the weights of all shape keys of a model in a pose.
    fn all_of(model: &StageModel, pose: &ThingPose) -> Vec<Self> {
        let shapes = ModelShapes::of(model.data());
        let of_mesh = |mesh: &ShapeMesh| {
            let weights = pose.shapes.get(model.shapes().range_of(mesh.instance())).unwrap_or(&[]);
            let row = |(shape, &weight): (&String, &f32)| Self {
                mesh: mesh.name().to_owned(),
                shape: shape.clone(),
                weight,
            };
            mesh.shapes().iter().zip(weights).map(row).collect::<Vec<_>>()
        };
        shapes.meshes().iter().flat_map(of_mesh).collect()
    }
}

impl RolePoses {
    /// Computes the poses of the thing called `role` at `times`.
    ///
    /// # Errors
    ///
    /// The scene has no such thing.
    pub(in crate::command) fn of(
        scene: &LoadedScene,
        role: &str,
        times: &[TimeArgument],
    ) -> Result<Self, Failure> {
        let plan = &scene.plan;
        let Some(thing) = plan.thing_called(role) else {
            let names: Vec<&str> = plan.things().iter().map(|thing| &*thing.id).collect();
            let reason = format_args!("--role: nothing is called \"{role}\"; there is {}", names.join(", "));
            return Err(Failure::input(&scene.title, reason));
        };
        let mut shown = plan.new_scene();
        let poses = times.iter().map(|time| {
            plan.scene_at(time.of_scene(plan.rate()), &mut shown);
            let state = &shown.things[thing];
            let to_scene = state.transform.to_matrix();
            let model = plan.things()[thing].model.as_ref();
            let posed = model.zip(state.pose.as_ref());
            let bones = posed.map_or(Vec::new(), |(model, pose)| {
                let bones = model.skeleton().bones.iter().zip(pose.to_root.matrices());
                let row = |name: &str, to_root| SceneBoneRow {
                    name: name.to_owned(),
                    to_scene: (to_scene * mat4(to_root)).to_cols_array(),
                };
                bones.map(|(bone, to_root)| row(&bone.name, to_root)).collect()
            });
            RolePoseRow {
                time: shown.time.seconds(),
                translation: state.transform.translation.to_array(),
                rotation: state.transform.rotation.to_array(),
                scale: state.transform.scale.to_array(),
                bones,
                shapes: posed.map_or(Vec::new(), |(model, pose)| SceneShapeRow::all_of(model, pose)),
            }
        });
        Ok(Self {
            file: scene.title.clone(),
            role: role.to_owned(),
            kind: plan.things()[thing].kind,
            poses: poses.collect(),
        })
    }

    /// Writes position and rotation of the thing, the positions of its bones, and the weights of its shape keys.
    pub(in crate::command) fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "{}, {} {}", self.file, self.kind, self.role)?;
        for pose in &self.poses {
            let [x, y, z] = pose.translation;
            let [a, b, c, d] = pose.rotation;
            writeln!(out, "\n{} s at {x:.4} {y:.4} {z:.4}, rotation {a:.4} {b:.4} {c:.4} {d:.4}", pose.time)?;
            for bone in &pose.bones {
                let [x, y, z] = [bone.to_scene[12], bone.to_scene[13], bone.to_scene[14]];
                writeln!(out, "  {} {x:.4} {y:.4} {z:.4}", crate::command::choice::plain(&bone.name))?;
            }
            for SceneShapeRow { mesh, shape, weight } in &pose.shapes {
                let [mesh, shape] = [mesh, shape].map(|name| crate::command::choice::plain(name));
                writeln!(out, "  {mesh}, shape key {shape}: {weight:.4}")?;
            }
        }
        Ok(())
    }
}
